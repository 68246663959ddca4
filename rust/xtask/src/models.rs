//! `cargo xtask models`: makes the models and styles that the project ships from the motion data.

mod styles;

use crate::{paths, process};
use anyhow::{Context as _, Result, bail};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Models that the add-on ships.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Which {
    /// Walking, running, standing, jumping and crouching
    Locomotion,
    /// The two linear systems of a walk
    Dynamics,
    /// The sensor models
    Sensors,
    /// Designed and acted styles
    Styles,
}

/// Folder of the data when `FOOTFALL_DATA` names none, from the repository's root.
const DATA: &str = "../shared/data";
const WALK: &str = "addons/footfall/models/locomotion.footfall";

const DYNAMICS: &str = "addons/footfall/models/walk.footdyn";

/// Sensor models: a sensor on a foot, and a phone in the pocket of the trousers.
const SENSORS: [&str; 2] = ["right_foot", "right_thigh"];

/// A tenth of what there is, most of which is one actor's and people's who stand.
const SENSOR_FRAMES: &str = "6000";

/// Recordings that sensor models learn from: everything that is free for commercial use but the dancer's manner of subject 131, a take whose floor is not at 0
/// (its contacts read as flights), and one of crouching, which a sensor cannot distinguish from standing upright.
const SENSOR_RECORDINGS: [&str; 8] = [
    "--where",
    "path!=bandai/*",
    "--where",
    "subject!=cmu131",
    "--where",
    "path!=o3de/Jumps1.bvh",
    "--where",
    "path!=o3de/Crouching1.bvh",
];

/// Walks of one person, who has the most of them: two linear systems hold one way of walking.
const WALKS_OF_ONE: [&str; 4] = [
    "--where",
    "category=neutral_walk",
    "--where",
    "subject=cmu35",
];

/// The recordings that are free for commercial use: neutral walks.
const NEUTRAL_WALKS: [&str; 4] = ["--where", "category=neutral_walk", "--where", "path=cmu/*"];

/// Runs at an even speed on the straight, of all people whose recordings are free for commercial use: one actor's, and two people's of a few steps.
const RUNNING: [&str; 8] = [
    "--running",
    "license!=CC*",
    "--running",
    "path!=*Acceleration*",
    "--running",
    "path!=*ump*",
    "--running",
    "category!=hopping",
];

/// Takes of jumps off both feet, and of one actor's crouch: other crouches are none that is held.
const MOVES: [&str; 4] = [
    "--jumping",
    "path=cmu/*jump*",
    "--crouching",
    "path=o3de/Crouching1.bvh",
];

/// These, and how walks begin and end, but for the dancer's manner of subject 131.
const WALKS_WITH_ENDS: [&str; 6] = [
    "--where",
    "category=*walk*",
    "--where",
    "path=cmu/*",
    "--where",
    "subject!=cmu131",
];

/// People who stand: idles of eight people and what one actor stands between walks.
const STANDING: [&str; 2] = ["--standing", "license=*MIT*"];

/// Trains shipped models and styles anew: these, or all.
///
/// # Errors
/// When the data are not there or training fails.
pub(crate) fn command(which: &[Which]) -> Result<()> {
    let root = paths::repository_root();
    let data = Data {
        index: data_folder(&root)?.join("index.csv"),
        commit: current_commit(&root),
        root,
    };
    fs::create_dir_all(data.root.join("addons/footfall/models"))
        .context("cannot create the folder for models")?;
    let makes = |asked: Which| which.is_empty() || which.contains(&asked);
    let mut made = Vec::new();
    if makes(Which::Locomotion) {
        train_locomotion(&data)?;
        made.push(WALK.to_owned());
    }
    if makes(Which::Dynamics) {
        fit_dynamics(&data)?;
        made.push(DYNAMICS.to_owned());
    }
    if makes(Which::Sensors) {
        for site in SENSORS {
            train_sensor(&data, site)?;
        }
        made.push(format!("{} sensor models", SENSORS.len()));
    }
    if makes(Which::Styles) {
        made.push(format!("{} styles", styles::make(&data)?));
    }
    eprintln!(
        "made from the data: {}; the tests check them, then commit them",
        made.join(", ")
    );
    Ok(())
}

/// Walking, with its ends, standing, running, jumping and crouching.
fn train_locomotion(data: &Data) -> Result<()> {
    let mut train = data.footfall("train");
    train
        .arg("--corpus")
        .arg(&data.index)
        .args(WALKS_WITH_ENDS)
        .args(STANDING)
        .args(RUNNING)
        .args(MOVES)
        .args([
            "--describe",
            "CMU Graphics Lab Motion Capture Database (mocap.cs.cmu.edu), walks and how they begin and end, runs and jumps; standing from ReActIdle (github.com/Enekoassets/ReActIdle) and the O3DE Motion Matching gem, running and crouching from the latter",
            "-o",
            WALK,
        ]);
    process::run(&mut train)
}

/// Two linear systems of one person's walk.
fn fit_dynamics(data: &Data) -> Result<()> {
    let mut fit = data.footfall("dynamics");
    fit.args(["fit", "--corpus"])
        .arg(&data.index)
        .args(WALKS_OF_ONE)
        .args([
            "--describe",
            "CMU Graphics Lab Motion Capture Database (mocap.cs.cmu.edu), neutral walks of subject 35",
            "-o",
            DYNAMICS,
        ]);
    process::run(&mut fit)
}

/// The model of a sensor at one site.
fn train_sensor(data: &Data, site: &str) -> Result<()> {
    let mut train = data.footfall("imu");
    train
        .args(["train", "--corpus"])
        .arg(&data.index)
        .args(SENSOR_RECORDINGS)
        .args(["--site", site, "--no-mirror", "--frames", SENSOR_FRAMES])
        .args([
            "--describe",
            "CMU Graphics Lab Motion Capture Database (mocap.cs.cmu.edu): walks, runs, jumps, hops, turns, a sidestep; the O3DE Motion Matching gem: walks, runs, stops, turns; ReActIdle (github.com/Enekoassets/ReActIdle): standing",
            "-o",
        ])
        .arg(format!("addons/footfall/models/{site}.footimu"));
    process::run(&mut train)
}

/// The motion data and how models are made from them.
struct Data {
    root: PathBuf,
    index: PathBuf,
    commit: Option<String>,
}

impl Data {
    /// A command of `footfall`, run from the root with relative paths: models record the command, which should read the same
    /// everywhere.
    fn footfall(&self, subcommand: &str) -> Command {
        let mut cargo = process::cargo();
        cargo
            .current_dir(&self.root)
            .args(["run", "--quiet", "--locked", "--release"])
            .args(["--manifest-path", "rust/Cargo.toml"])
            .args(["--package", "footfall_cli", "--", subcommand]);
        if let Some(commit) = &self.commit {
            cargo.env("FOOTFALL_COMMIT", commit);
        }
        cargo
    }
}

/// The commit that the models are made with, as their provenance records it; `None` outside a checkout.
fn current_commit(root: &Path) -> Option<String> {
    let output = Command::new("git")
        .current_dir(root)
        .args(["rev-parse", "--short=12", "HEAD"])
        .output()
        .ok()?;
    let commit = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| commit.trim().to_owned())
}

fn data_folder(root: &Path) -> Result<PathBuf> {
    let named = env::var_os("FOOTFALL_DATA")
        .filter(|value| !value.is_empty())
        .map(PathBuf::from);
    let folder = named.unwrap_or_else(|| PathBuf::from(DATA));
    if !root.join(&folder).join("index.csv").is_file() {
        bail!(
            "{} has no index.csv; set FOOTFALL_DATA to the folder with the motion data",
            folder.display()
        );
    }
    Ok(folder)
}
