//! Text to [`BvhFile`].

mod cursor;

use super::{BvhError, BvhFile, BvhJoint, Channel};
use cursor::Cursor;
use glam::Vec3;
use std::path::Path;

/// Reads a BVH file. Bytes that are not UTF-8 (joint names in an old encoding) become replacement characters.
///
/// # Errors
/// [`BvhError::Io`] when the file cannot be read; [`BvhError::InFile`] with line and column when it is not a valid BVH file.
pub fn read(path: impl AsRef<Path>) -> Result<BvhFile, BvhError> {
    let path = path.as_ref();
    let bytes = std::fs::read(path).map_err(|source| BvhError::Io {
        path: path.to_owned(),
        source,
    })?;
    parse(&String::from_utf8_lossy(&bytes)).map_err(|error| BvhError::InFile {
        path: path.to_owned(),
        error: Box::new(error),
    })
}

/// Parses the text of a BVH file.
///
/// # Errors
/// [`BvhError::Syntax`] names line, column and what was expected there: for text that is not BVH, is cut off, has a number
/// that is not finite, no frames, a frame time that is not above zero, or a frame with too few or too many values.
///
/// ```
/// let text = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n\
///             MOTION\nFrames: 2\nFrame Time: 0.1\n0\n45\n";
/// let file = footfall_motion::bvh::parse(text)?;
/// assert_eq!(file.frame(1), [45.0]);
/// # Ok::<(), footfall_motion::bvh::BvhError>(())
/// ```
pub fn parse(text: &str) -> Result<BvhFile, BvhError> {
    let mut cursor = Cursor {
        text: text.strip_prefix('\u{feff}').unwrap_or(text),
        at: 0,
    };
    cursor.keyword("HIERARCHY")?;
    let joints = hierarchy(&mut cursor)?;
    motion(&mut cursor, joints)
}

/// Owner of an open brace.
enum Open {
    Joint { index: usize, has_offset: bool },
    EndSite { joint: usize, offset: Option<Vec3> },
}

/// Everything from after `HIERARCHY` up to and including `MOTION`.
fn hierarchy(cursor: &mut Cursor<'_>) -> Result<Vec<BvhJoint>, BvhError> {
    let mut joints: Vec<BvhJoint> = Vec::new();
    // A stack of our own: nesting is as deep as the file says, the call stack is not.
    let mut open: Vec<Open> = Vec::new();
    loop {
        cursor.skip_space();
        let word = cursor.peek_word();
        let is = |keyword: &str| word.eq_ignore_ascii_case(keyword);
        match open.last_mut() {
            None if is("ROOT") => {
                cursor.at += word.len();
                open.push(begin_joint(cursor, &mut joints, None)?);
            }
            None if is("MOTION") && !joints.is_empty() => {
                cursor.at += word.len();
                return Ok(joints);
            }
            None if joints.is_empty() => return Err(cursor.error("\"ROOT\"")),
            None => return Err(cursor.error("\"MOTION\" or another \"ROOT\"")),
            Some(Open::Joint { index, has_offset }) => {
                let index = *index;
                if is("OFFSET") && !*has_offset {
                    cursor.at += word.len();
                    joints[index].offset = cursor.vector()?;
                    *has_offset = true;
                } else if is("CHANNELS") && joints[index].channels.is_empty() {
                    cursor.at += word.len();
                    joints[index].channels = channels(cursor)?;
                } else if *has_offset && is("JOINT") {
                    cursor.at += word.len();
                    open.push(begin_joint(cursor, &mut joints, Some(index))?);
                } else if *has_offset && (is("End") || is("EndSite")) {
                    cursor.at += word.len();
                    cursor.rest_of_line();
                    cursor.keyword("{")?;
                    open.push(Open::EndSite {
                        joint: index,
                        offset: None,
                    });
                } else if word == "}" && *has_offset {
                    cursor.at += 1;
                    open.pop();
                } else if *has_offset {
                    let name = &joints[index].name;
                    return Err(cursor.error(format!(
                        "CHANNELS, JOINT, \"End Site\" or \"}}\" of joint {name}"
                    )));
                } else {
                    return Err(cursor.error(format!("OFFSET of joint {}", joints[index].name)));
                }
            }
            Some(Open::EndSite { joint, offset }) => {
                let joint = *joint;
                match *offset {
                    None if is("OFFSET") => {
                        cursor.at += word.len();
                        *offset = Some(cursor.vector()?);
                    }
                    None => {
                        let name = &joints[joint].name;
                        return Err(cursor.error(format!("OFFSET of the End Site of {name}")));
                    }
                    Some(_) if is("CHANNELS") => {
                        cursor.at += word.len();
                        if !channels(cursor)?.is_empty() {
                            return Err(cursor.error("no channels in an End Site"));
                        }
                    }
                    Some(offset) if word == "}" => {
                        cursor.at += 1;
                        joints[joint].end_sites.push(offset);
                        open.pop();
                    }
                    Some(_) => {
                        let name = &joints[joint].name;
                        return Err(cursor.error(format!("\"}}\" of the End Site of {name}")));
                    }
                }
            }
        }
    }
}

fn begin_joint(
    cursor: &mut Cursor<'_>,
    joints: &mut Vec<BvhJoint>,
    parent: Option<usize>,
) -> Result<Open, BvhError> {
    cursor.skip_blanks();
    let start = cursor.at;
    let name = cursor.rest_of_line();
    if name.is_empty() {
        return Err(cursor.error_at(start, "the joint's name"));
    }
    cursor.keyword("{")?;
    joints.push(BvhJoint {
        name: name.to_owned(),
        parent,
        offset: Vec3::ZERO,
        channels: Vec::new(),
        end_sites: Vec::new(),
    });
    Ok(Open::Joint {
        index: joints.len() - 1,
        has_offset: false,
    })
}

fn channels(cursor: &mut Cursor<'_>) -> Result<Vec<Channel>, BvhError> {
    cursor.skip_space();
    let word = cursor.peek_word();
    let count = match word.parse::<usize>() {
        Ok(count) if count <= Channel::ALL.len() => count,
        _ => return Err(cursor.error("the number of channels, 0 to 6")),
    };
    cursor.at += word.len();
    let mut channels = Vec::with_capacity(count);
    for n in 0..count {
        cursor.skip_space();
        let word = cursor.peek_word();
        let channel = Channel::ALL
            .into_iter()
            .find(|channel| channel.name().eq_ignore_ascii_case(word))
            .filter(|channel| !channels.contains(channel));
        match channel {
            Some(channel) => channels.push(channel),
            None => {
                return Err(cursor.error(format!(
                    "channel {} of {count}: one of Xposition, Yposition, Zposition, Xrotation, Yrotation, Zrotation, each once",
                    n + 1
                )));
            }
        }
        cursor.at += word.len();
    }
    Ok(channels)
}

/// Everything after `MOTION`.
fn motion(cursor: &mut Cursor<'_>, joints: Vec<BvhJoint>) -> Result<BvhFile, BvhError> {
    cursor.keyword("Frames")?;
    if !cursor.take_keyword(":") {
        return Err(cursor.error("\":\" after Frames"));
    }
    cursor.skip_space();
    let word = cursor.peek_word();
    let frame_count = match word.parse::<usize>() {
        Ok(count) if count > 0 => count,
        _ => return Err(cursor.error("the number of frames, at least 1")),
    };
    cursor.at += word.len();
    if !cursor.take_keyword("FrameTime") {
        cursor.keyword("Frame")?;
        cursor.keyword("Time")?;
    }
    if !cursor.take_keyword(":") {
        return Err(cursor.error("\":\" after Frame Time"));
    }
    cursor.skip_space();
    let start = cursor.at;
    let frame_time_secs = cursor.finite("the seconds from one frame to the next")?;
    if frame_time_secs <= 0.0 {
        return Err(cursor.error_at(start, "a frame time above zero"));
    }
    let channel_count: usize = joints.iter().map(|joint| joint.channels.len()).sum();
    if channel_count == 0 {
        return Err(cursor.error("a hierarchy with at least one channel"));
    }
    let values = frames(cursor, frame_count, channel_count)?;
    Ok(BvhFile {
        joints,
        frame_time_secs,
        frame_count,
        values,
    })
}

/// The rows of numbers: one frame a line.
fn frames(
    cursor: &mut Cursor<'_>,
    frame_count: usize,
    channel_count: usize,
) -> Result<Vec<f32>, BvhError> {
    // The header is not to be trusted with an allocation: each value takes two characters at least.
    let room = cursor.rest().len() / 2 + 1;
    let mut values = Vec::with_capacity(frame_count.saturating_mul(channel_count).min(room));
    for frame in 0..frame_count {
        cursor.skip_space();
        if cursor.rest().is_empty() {
            return Err(cursor.error(format!(
                "frame {frame}: the header promises {frame_count} frames"
            )));
        }
        let rest = cursor.rest();
        let end = rest.find(['\n', '\r']).unwrap_or(rest.len());
        let row_start = values.len();
        for word in rest[..end].split_ascii_whitespace() {
            let column_at = word.as_ptr() as usize - cursor.text.as_ptr() as usize;
            if values.len() - row_start == channel_count {
                return Err(cursor.error_at(
                    column_at,
                    format!("the end of frame {frame} after {channel_count} values"),
                ));
            }
            match word.parse::<f32>() {
                Ok(value) if value.is_finite() => values.push(value),
                _ => {
                    return Err(
                        cursor.error_at(column_at, format!("a finite number in frame {frame}"))
                    );
                }
            }
        }
        let found = values.len() - row_start;
        cursor.at += end;
        if found < channel_count {
            return Err(cursor.error(format!(
                "{channel_count} values in frame {frame} and not {found}"
            )));
        }
    }
    cursor.skip_space();
    if cursor.rest().is_empty() {
        Ok(values)
    } else {
        Err(cursor.error(format!(
            "the end of the file after the {frame_count} frames of the header"
        )))
    }
}
