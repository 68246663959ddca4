//! The page's text: template, program and data in one file.

use super::clip::{Excerpt, HEAD_TOP, POINTS, RATE_HZ};
use anyhow::{Context as _, Result, ensure};
use footfall_core::hash::fnv1a;
use footfall_core::{Joint, Side};
use serde::Serialize;
use std::collections::BTreeSet;

const TEMPLATE: &str = include_str!("page.html");
const STYLE_SHEET: &str = include_str!("page.css");
const FIGURE: &str = include_str!("figure.js");
const TESTS: &str = include_str!("study.js");

/// Size of the study.
#[derive(Clone, Debug)]
pub(crate) struct StudyOptions {
    /// Heading of the page.
    pub(crate) title: String,
    /// Most walks or pairs in each test.
    pub(crate) trials: usize,
    /// Most pairs of each style.
    pub(crate) pairs_per_style: usize,
}

/// The page and what it holds.
pub(crate) struct Study {
    pub(crate) html: String,
    pub(crate) styles: Vec<String>,
    pub(crate) pairs: usize,
    /// Styles of which only one kind of recording was given.
    pub(crate) left_out: Vec<String>,
}

#[derive(Serialize)]
struct Data<'a> {
    /// Answers to another study are kept apart.
    id: String,
    fps: f64,
    points: usize,
    trials: usize,
    styles: &'a [String],
    /// From and to point, thickness in metres, limb.
    parts: Vec<(usize, usize, f32, &'static str)>,
    head: [usize; 2],
    clips: Vec<ClipData<'a>>,
    /// Real and synthesised clip of the same style.
    pairs: Vec<[usize; 2]>,
}

#[derive(Serialize)]
struct ClipData<'a> {
    name: &'a str,
    style: &'a str,
    /// `real` or `synthesised`.
    source: &'static str,
    frames: usize,
    /// Little-endian 16-bit millimetres, frames × points × 3, in base64.
    data: String,
}

/// Makes the page of a study. The two walks of a pair have equally many steps, so that length is no clue.
pub(crate) fn page(
    real: &[Excerpt<'_>],
    synthesised: &[Excerpt<'_>],
    options: &StudyOptions,
) -> Result<Study> {
    let all: BTreeSet<&str> = real
        .iter()
        .chain(synthesised)
        .map(|one| one.style)
        .collect();
    let of = |excerpts: &'_ [Excerpt<'_>], style: &str| -> Vec<usize> {
        (0..excerpts.len())
            .filter(|index| excerpts[*index].style == style)
            .collect()
    };
    let (mut clips, mut pairs) = (Vec::new(), Vec::new());
    let (mut styles, mut left_out) = (Vec::new(), Vec::new());
    for style in all {
        let (ours, theirs) = (of(real, style), of(synthesised, style));
        if ours.is_empty() || theirs.is_empty() {
            left_out.push(style.to_owned());
            continue;
        }
        styles.push(style.to_owned());
        for (ours, theirs) in ours.into_iter().zip(theirs).take(options.pairs_per_style) {
            let (real, synthesised) = (&real[ours], &synthesised[theirs]);
            let steps = real.steps().min(synthesised.steps());
            pairs.push([clips.len(), clips.len() + 1]);
            clips.push(clip_data(real, "real", steps));
            clips.push(clip_data(synthesised, "synthesised", steps));
        }
    }
    ensure!(
        !pairs.is_empty(),
        "no style has both a real and a synthesised walk of three steps or more; give both tables the same names of styles"
    );
    let data = Data {
        id: fingerprint(&clips),
        fps: RATE_HZ,
        points: POINTS,
        trials: options.trials,
        styles: &styles,
        parts: parts(),
        head: [Joint::Head.index(), HEAD_TOP],
        pairs,
        clips,
    };
    let pairs = data.pairs.len();
    // In JSON, < stands only within strings: escaped, no name can end the script.
    let json = serde_json::to_string(&data)
        .context("the clips")?
        .replace('<', "\\u003c");
    Ok(Study {
        html: fill(&[
            ("{{title}}", &escaped(&options.title)),
            ("{{css}}", STYLE_SHEET),
            ("{{figure_js}}", FIGURE),
            ("{{study_js}}", TESTS),
            ("{{data}}", &json),
        ]),
        styles,
        pairs,
        left_out,
    })
}

fn clip_data<'a>(excerpt: &'a Excerpt<'_>, source: &'static str, steps: usize) -> ClipData<'a> {
    let values = excerpt.millimetres(steps);
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    ClipData {
        name: &excerpt.name,
        style: excerpt.style,
        source,
        frames: values.len() / (3 * POINTS),
        data: base64(&bytes),
    }
}

/// The figure's limbs; the first word of a limb's name is its colour.
fn parts() -> Vec<(usize, usize, f32, &'static str)> {
    use Joint::{Chest, Head, Hips, Neck, Spine, UpperChest};
    let mut parts = Vec::new();
    let trunk = [
        (Hips, Spine, 0.17),
        (Spine, Chest, 0.16),
        (Chest, UpperChest, 0.17),
        (UpperChest, Neck, 0.14),
        (Neck, Head, 0.08),
    ];
    parts.extend(trunk.map(|(from, to, thickness)| (from.index(), to.index(), thickness, "trunk")));
    for side in Side::BOTH {
        let [arm, leg] = match side {
            Side::Left => ["left arm", "left leg"],
            Side::Right => ["right arm", "right leg"],
        };
        let shoulder = match side {
            Side::Left => Joint::LeftShoulder,
            Side::Right => Joint::RightShoulder,
        }
        .index();
        let (thigh, shank) = (side.upper_leg().index(), side.lower_leg().index());
        let (foot, toes) = (side.foot().index(), side.toes().index());
        let (heel, tip) = (
            HEAD_TOP + 1 + 2 * side.index(),
            HEAD_TOP + 2 + 2 * side.index(),
        );
        parts.extend([
            (UpperChest.index(), shoulder + 1, 0.1, "trunk"),
            (shoulder + 1, shoulder + 2, 0.085, arm),
            (shoulder + 2, shoulder + 3, 0.07, arm),
            (Hips.index(), thigh, 0.14, "trunk"),
            (thigh, shank, 0.125, leg),
            (shank, foot, 0.09, leg),
            (foot, heel, 0.06, leg),
            (heel, toes, 0.05, leg),
            (foot, toes, 0.06, leg),
            (toes, tip, 0.05, leg),
        ]);
    }
    parts
}

/// Replaces each mark once, in the order of the template; what was put in is not looked at again.
fn fill(marks: &[(&str, &str)]) -> String {
    let mut rest = TEMPLATE;
    let mut html = String::new();
    while let Some((at, mark, text)) = marks
        .iter()
        .filter_map(|(mark, text)| Some((rest.find(mark)?, *mark, *text)))
        .min_by_key(|found| found.0)
    {
        html.push_str(&rest[..at]);
        html.push_str(text.trim_end());
        rest = &rest[at + mark.len()..];
    }
    html.push_str(rest);
    html
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

/// FNV-1a of the clips, 64 bits in hexadecimal.
fn fingerprint(clips: &[ClipData<'_>]) -> String {
    let bytes = clips
        .iter()
        .flat_map(|clip| clip.style.bytes().chain(clip.data.bytes()));
    format!("{:016x}", fnv1a(bytes))
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let at = |index: usize| u32::from(group.get(index).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for place in 0..4 {
            if place <= group.len() {
                text.push(char::from(
                    LETTERS[(bits >> (18 - 6 * place) & 63) as usize],
                ));
            } else {
                text.push('=');
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_the_standard_s() {
        for (plain, coded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
        assert_eq!(base64(&[255, 239, 190]), "/+++");
    }

    #[test]
    fn what_is_put_in_is_not_replaced_again() {
        let html = fill(&[
            ("{{title}}", "{{css}}"),
            ("{{css}}", "x"),
            ("{{data}}", "{{title}}"),
        ]);
        assert_eq!(
            html.matches("{{css}}").count(),
            2,
            "the title stands in two places"
        );
        assert!(html.contains("<script type=\"application/json\" id=\"study\">{{title}}</script>"));
    }

    #[test]
    fn the_page_needs_nothing_from_elsewhere() {
        for text in [TEMPLATE, STYLE_SHEET, FIGURE, TESTS] {
            for outside in ["http:", "https:", "src=", "@import", "url("] {
                assert!(!text.contains(outside), "{outside}");
            }
        }
    }
}
