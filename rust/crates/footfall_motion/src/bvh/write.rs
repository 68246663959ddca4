//! [`BvhFile`] to text.

use super::{BvhError, BvhFile};
use crate::files;
use std::fmt::Write as _;
use std::path::Path;

/// The text of a file. [`super::parse`] gives the same file back, bit for bit.
///
/// Joints must stand depth first (as [`super::parse`] gives them), for the format knows no other order.
pub fn write(file: &BvhFile) -> String {
    let mut text = String::with_capacity(1024 + file.values.len() * 10);
    text.push_str("HIERARCHY\n");
    let mut open: Vec<usize> = Vec::new();
    for (index, joint) in file.joints.iter().enumerate() {
        while open.last().copied() != joint.parent && !open.is_empty() {
            close_joint(&mut text, file, &mut open);
        }
        let depth = open.len();
        let keyword = if depth == 0 { "ROOT" } else { "JOINT" };
        indent(&mut text, depth);
        line(&mut text, format_args!("{keyword} {}", joint.name));
        indent(&mut text, depth);
        text.push_str("{\n");
        indent(&mut text, depth + 1);
        line(
            &mut text,
            format_args!(
                "OFFSET {} {} {}",
                joint.offset.x, joint.offset.y, joint.offset.z
            ),
        );
        indent(&mut text, depth + 1);
        let names: Vec<&str> = joint
            .channels
            .iter()
            .map(|channel| channel.name())
            .collect();
        line(
            &mut text,
            format_args!("CHANNELS {} {}", names.len(), names.join(" ")),
        );
        open.push(index);
    }
    while !open.is_empty() {
        close_joint(&mut text, file, &mut open);
    }
    text.push_str("MOTION\n");
    line(&mut text, format_args!("Frames: {}", file.frame_count));
    line(
        &mut text,
        format_args!("Frame Time: {}", file.frame_time_secs),
    );
    for row in file.values.chunks(file.channel_count().max(1)) {
        for (n, value) in row.iter().enumerate() {
            if n > 0 {
                text.push(' ');
            }
            push(&mut text, format_args!("{value}"));
        }
        text.push('\n');
    }
    text
}

/// Writes a file: first beside it under another name, then renamed, so that a reader never sees half of it.
///
/// # Errors
/// [`BvhError::Io`] names the file.
pub fn write_file(file: &BvhFile, path: impl AsRef<Path>) -> Result<(), BvhError> {
    let path = path.as_ref();
    files::write_atomic(path, write(file).as_bytes()).map_err(|source| BvhError::Io {
        path: path.to_owned(),
        source,
    })
}

/// Ends the innermost open joint. End Sites go last so that joints keep their order.
fn close_joint(text: &mut String, file: &BvhFile, open: &mut Vec<usize>) {
    let Some(index) = open.pop() else { return };
    let depth = open.len();
    for end in &file.joints[index].end_sites {
        indent(text, depth + 1);
        text.push_str("End Site\n");
        indent(text, depth + 1);
        text.push_str("{\n");
        indent(text, depth + 2);
        line(text, format_args!("OFFSET {} {} {}", end.x, end.y, end.z));
        indent(text, depth + 1);
        text.push_str("}\n");
    }
    indent(text, depth);
    text.push_str("}\n");
}

fn indent(text: &mut String, depth: usize) {
    // Capped: a chain of ten thousand joints would otherwise take a file of a hundred megabytes.
    text.extend(std::iter::repeat_n('\t', depth.min(40)));
}

fn push(text: &mut String, arguments: std::fmt::Arguments<'_>) {
    let written = text.write_fmt(arguments);
    debug_assert!(written.is_ok(), "a String takes all that is written to it");
}

fn line(text: &mut String, arguments: std::fmt::Arguments<'_>) {
    push(text, arguments);
    text.push('\n');
}
