//! The shipped styles: designed ones, free like the recordings that they are made of, and acted ones, which are not.

use super::{Data, NEUTRAL_WALKS, WALK};
use crate::{paths, process};
use anyhow::{Context as _, Result};
use std::fs;
use std::path::Path;

/// The styles of Tilmanne et al. 2012, as sheets that `footfall design` knows.
const DESIGNED: [&str; 11] = [
    "proud",
    "decided",
    "sad",
    "topmodel",
    "drunk",
    "cool",
    "afraid",
    "tiptoeing",
    "heavy",
    "in_a_hurry",
    "manly",
];
const DESIGNED_FOLDER: &str = "addons/footfall/models";

/// Acted styles of the Bandai Namco Research motion dataset: the first set's, and what the second adds.
const ACTED: [(&str, &[&str]); 2] = [
    (
        "bn1",
        &[
            "active",
            "angry",
            "childish",
            "chimpira",
            "feminine",
            "giant",
            "happy",
            "masculinity",
            "musical",
            "not-confident",
            "old",
            "proud",
            "sad",
            "tired",
        ],
    ),
    ("bn2", &["elderly", "exhausted", "masculine", "youthful"]),
];
const ACTED_FOLDER: &str = "demo_project/styles_noncommercial";

/// Steps that an acted style is learned from.
const STEPS: &str = "12";

/// Makes every style; returns how many.
pub(super) fn make(data: &Data) -> Result<usize> {
    for name in DESIGNED {
        design(data, name)?;
    }
    fs::create_dir_all(data.root.join(ACTED_FOLDER))
        .with_context(|| format!("cannot create {ACTED_FOLDER}"))?;
    let mut made = DESIGNED.len();
    for (set, names) in ACTED {
        for name in names {
            let file = format!("{ACTED_FOLDER}/{}.footstyle", name.replace('-', "_"));
            let path = format!("path=bandai/styled_walk/{set}_walk_{name}_*");
            let mut adapt = adapt(data, name, &data.index, &file);
            adapt.args(["--where", &path, "--steps", STEPS]).args([
                "--describe",
                "Bandai Namco Research motion dataset, acted walks",
            ]);
            process::run(&mut adapt)?;
        }
        made += names.len();
    }
    Ok(made)
}

/// Designs walks from the neutral ones and adapts the style to them.
fn design(data: &Data, name: &str) -> Result<()> {
    let folder = paths::target_folder().join("designed").join(name);
    let mut design = data.footfall("design");
    design
        .args(["--sheet", name, "--corpus"])
        .arg(&data.index)
        .args(NEUTRAL_WALKS)
        .arg("-o")
        .arg(&folder);
    process::run(&mut design)?;
    let file = format!("{DESIGNED_FOLDER}/{name}.footstyle");
    let words = format!("CMU neutral walks turned into '{name}' by its style sheet");
    let mut adapt = adapt(data, name, &folder.join("index.csv"), &file);
    process::run(adapt.args(["--describe", &words]))
}

fn adapt(data: &Data, name: &str, index: &Path, file: &str) -> std::process::Command {
    let mut adapt = data.footfall("adapt");
    adapt
        .args(["--base", WALK, "--name", name, "-o", file, "--corpus"])
        .arg(index);
    adapt
}
