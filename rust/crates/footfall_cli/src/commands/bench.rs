//! `footfall bench`: each kernel beside its peer, in one process.

mod dynamics;
mod imu;
mod inference;
mod mlpg;
mod runtime;

use crate::output;
use anyhow::{Context as _, Result};
use footfall_model::GaitModel;
use footfall_train::read_model_file;
use serde::Serialize;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A small model that the project's own generator and trainer made: speed does not depend on what a model learned.
const BUILT_IN_MODEL: &[u8] = include_bytes!("../../../../../tests/model_versions/v1.footfall");

/// Time the kernels, each beside its peer
///
/// Best of several repetitions, taken in turns, so that a busy moment hits all alike. Times in microseconds.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall bench\n  \
    footfall bench --json --repetitions 50\n  \
    footfall bench --model walk.footfall")]
pub(crate) struct BenchArgs {
    /// Model for the walker; a small built-in one when absent
    #[arg(long, value_name = "WALK.footfall")]
    model: Option<PathBuf>,
    /// Number of times that each kernel is timed; the best counts
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u16).range(1..=1000))]
    repetitions: u16,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Times in microseconds.
#[derive(Serialize)]
struct Report {
    /// Frames and static dimensions of the trajectory problem.
    mlpg_frames: usize,
    mlpg_dimensions: usize,
    /// f32, one thread, the paper's windows: what the walkers run.
    mlpg_us_per_frame: f64,
    /// The same in f64, as whole walks run it: the same arithmetic as the peer's, for `ratio`.
    mlpg_f64_us_per_frame: f64,
    mlpg_compact_us_per_frame: f64,
    /// jbonsai 0.4.2, `MlpgAdjust`, the same data.
    jbonsai_us_per_frame: f64,
    /// jbonsai's time over ours.
    ratio: f64,
    /// Largest difference from jbonsai's trajectory.
    jbonsai_max_difference: f64,
    /// Largest difference from a dense solve of the normal equations.
    dense_max_difference: f64,
    hsmm_frames: usize,
    hsmm_segments: usize,
    /// Explicit-duration forward-backward.
    hsmm_us_per_frame: f64,
    /// One `GaitGenerator::step` at the model's rate, planning included: mean over 100 steps.
    walker_us_per_frame: f64,
    /// The longest call of those, in the best repetition.
    walker_worst_us: f64,
    /// The same at 3 m/s; none of a model that only walks.
    runner_us_per_frame: Option<f64>,
    /// One `GaitGenerator::state`, and one `restore` of it by the same walker.
    walker_state_us: f64,
    walker_restore_us: f64,
    forward_kinematics_us: f64,
    /// Ten segments of a switching model: identified in closed form, windows and initial states tried; and with refinement.
    dynamics_fit_ms: f64,
    dynamics_refined_fit_ms: f64,
    /// The same identification by dense singular value decompositions.
    dynamics_fit_dense_ms: f64,
    /// Switches of a clip of 400 frames, angles and all; and the projection residual of four channels alone.
    switches_400_frames_ms: f64,
    projection_400_frames_ms: f64,
    /// The same residual by a dense pseudo-inverse, and the largest difference between both.
    projection_dense_ms: f64,
    projection_max_difference: f64,
    /// Features of a frame of a switching model; and the same from dense f64 matrices.
    switching_us_per_frame: f64,
    switching_dense_us_per_frame: f64,
    /// One `GaitGenerator::step` of a switching model.
    switching_walker_us_per_frame: f64,
    /// A body that one sensor at 100 Hz drives: samples, tracking, pose and feet, by a model of 10,000 frames; tracking is linear in them.
    imu_us_per_frame_10k: f64,
    imu_us_per_frame_100k: f64,
    /// The same for models of many sizes, beside the paper's latency.
    imu_sizes: Vec<imu::SizeReport>,
    /// From a sample sent over UDP to its pose, by a game that looks every millisecond: median, and the longest of 99 in a hundred.
    imu_sample_to_pose_ms: f64,
    imu_sample_to_pose_p99_ms: f64,
    repetitions: u16,
}

/// Place of the model of 10,000 frames among [`imu::SIZES`]; that of 100,000 follows.
const TEN_THOUSAND: usize = 5;

pub(crate) fn run(args: &BenchArgs) -> Result<()> {
    let model = match &args.model {
        Some(path) => read_model_file(path, GaitModel::from_bytes)?,
        None => GaitModel::from_bytes(BUILT_IN_MODEL).context("the built-in model")?,
    };
    let mut ours = mlpg::Ours::new()?;
    let peer = mlpg::Peer::new();
    let peer_solve = peer.solver();
    let mut hsmm = inference::ForwardBackward::new()?;
    let gait = Arc::new(model.clone());
    let bodies = imu::SIZES.iter();
    let mut bodies: Vec<imu::ReconstructorBench> = bodies
        .map(|(frames, _)| imu::ReconstructorBench::new(&gait, *frames))
        .collect::<Result<_>>()?;
    let mut runner = runtime::WalkerBench::running(&model)?;
    let mut walker = runtime::WalkerBench::new(model)?;
    let dynamics = dynamics::DynamicsBench::new()?;
    let mut switching = dynamics.switching()?;
    let mut switching_walker = runtime::WalkerBench::switching(dynamics.model())?;
    let projection_max_difference = dynamics.max_difference_from_dense()?;
    let jbonsai_max_difference = ours.max_difference(&peer.trajectory());
    let dense_max_difference = ours.max_difference_from_dense()?;

    let progress = output::Progress::new();
    progress.stage("timing", u64::from(args.repetitions));
    let mut best = Best::default();
    for repetition in 0..args.repetitions {
        progress.reach(u64::from(repetition));
        best.ours.take(time(|| ours.solve())?);
        best.jbonsai.take(time(&peer_solve)?);
        best.single.take(time(|| ours.solve_single())?);
        best.compact.take(time(|| ours.solve_compact())?);
        best.hsmm.take(time(|| hsmm.run())?);
        let walked = walker.walk();
        best.walker.take(walked.mean);
        best.walker_worst.take(walked.worst);
        if let Some(runner) = &mut runner {
            best.runner.take(runner.walk().mean);
        }
        let saved = walker.save()?;
        best.walker_state.take(saved.state);
        best.walker_restore.take(saved.restore);
        best.kinematics.take(walker.forward_kinematics());
        best.fit.take(time(|| dynamics.fit(0))?);
        best.refined_fit.take(time(|| dynamics.fit_refined())?);
        best.dense_fit.take(time(|| dynamics.fit_dense())?);
        best.switches.take(time(|| dynamics.detect())?);
        best.projection.take(time(|| dynamics.project())?);
        best.dense_projection
            .take(time(|| dynamics.project_dense())?);
        best.switching.take(switching.run());
        best.dense_switching.take(dynamics.simulate_dense());
        best.switching_walker.take(switching_walker.walk().mean);
        for (best, body) in best.bodies.iter_mut().zip(&mut bodies) {
            best.take(body.run());
        }
    }
    progress.finish();
    let sizes = bodies.iter().zip(&best.bodies).zip(imu::SIZES);
    let imu_sizes: Vec<imu::SizeReport> = sizes
        .map(|((body, best), (_, paper_ms))| imu::SizeReport {
            frames: body.size().0,
            segments: body.size().1,
            us_per_frame: best.0,
            paper_ms,
        })
        .collect();
    let live = bodies[TEN_THOUSAND].live()?;

    let mlpg_frames = ours.frames() as f64;
    let report = Report {
        mlpg_frames: ours.frames(),
        mlpg_dimensions: ours.dimensions(),
        mlpg_us_per_frame: best.single.0 / mlpg_frames,
        mlpg_f64_us_per_frame: best.ours.0 / mlpg_frames,
        mlpg_compact_us_per_frame: best.compact.0 / mlpg_frames,
        jbonsai_us_per_frame: best.jbonsai.0 / mlpg_frames,
        ratio: best.jbonsai.0 / best.ours.0,
        jbonsai_max_difference,
        dense_max_difference,
        hsmm_frames: hsmm.frames(),
        hsmm_segments: hsmm.segments(),
        hsmm_us_per_frame: best.hsmm.0 / hsmm.frames() as f64,
        walker_us_per_frame: best.walker.0,
        walker_worst_us: best.walker_worst.0,
        runner_us_per_frame: runner.map(|_| best.runner.0),
        walker_state_us: best.walker_state.0,
        walker_restore_us: best.walker_restore.0,
        forward_kinematics_us: best.kinematics.0,
        dynamics_fit_ms: 1e-3 * best.fit.0,
        dynamics_refined_fit_ms: 1e-3 * best.refined_fit.0,
        dynamics_fit_dense_ms: 1e-3 * best.dense_fit.0,
        switches_400_frames_ms: 1e-3 * best.switches.0,
        projection_400_frames_ms: 1e-3 * best.projection.0,
        projection_dense_ms: 1e-3 * best.dense_projection.0,
        projection_max_difference,
        switching_us_per_frame: best.switching.0,
        switching_dense_us_per_frame: best.dense_switching.0,
        switching_walker_us_per_frame: best.switching_walker.0,
        imu_us_per_frame_10k: best.bodies[TEN_THOUSAND].0,
        imu_us_per_frame_100k: best.bodies[TEN_THOUSAND + 1].0,
        imu_sizes,
        imu_sample_to_pose_ms: live.0,
        imu_sample_to_pose_p99_ms: live.1,
        repetitions: args.repetitions,
    };
    output::print_report(args.json, &report, |report| report.lines().join("\n"))
}

impl Report {
    fn lines(&self) -> Vec<String> {
        let mut lines = vec![
            format!(
                "MLPG, {} frames x {} dimensions, f64       {:9.4} µs a frame",
                self.mlpg_frames, self.mlpg_dimensions, self.mlpg_f64_us_per_frame
            ),
            format!(
                "  jbonsai 0.4.2, the same data             {:9.4} µs a frame: {:.1} times ours, at most {:.1e} apart",
                self.jbonsai_us_per_frame, self.ratio, self.jbonsai_max_difference
            ),
            format!(
                "  dense solve                              at most {:.1e} apart",
                self.dense_max_difference
            ),
            format!(
                "  f32, as walkers run it                   {:9.4} µs a frame",
                self.mlpg_us_per_frame
            ),
            format!(
                "  f64, compact windows                     {:9.4} µs a frame",
                self.mlpg_compact_us_per_frame
            ),
            format!(
                "HSMM forward-backward, {} frames, {} segments {:6.4} µs a frame",
                self.hsmm_frames, self.hsmm_segments, self.hsmm_us_per_frame
            ),
            format!(
                "one walker                                 {:9.4} µs a frame, {:.1} µs at worst",
                self.walker_us_per_frame, self.walker_worst_us
            ),
            self.runner_us_per_frame.map_or_else(
                || "one runner                                 the model only walks".to_owned(),
                |us| format!("one runner                                 {us:9.4} µs a frame"),
            ),
            format!(
                "a walker's state, saved and restored        {:9.4} µs, {:.1} µs",
                self.walker_state_us, self.walker_restore_us
            ),
            format!(
                "forward kinematics, 22 joints              {:9.4} µs",
                self.forward_kinematics_us
            ),
            format!(
                "switching model, fit of ten segments       {:9.4} ms, {:.1} ms refined",
                self.dynamics_fit_ms, self.dynamics_refined_fit_ms
            ),
            format!(
                "  dense singular value decompositions      {:9.4} ms",
                self.dynamics_fit_dense_ms
            ),
            format!(
                "switches of 400 frames                     {:9.4} ms",
                self.switches_400_frames_ms
            ),
            format!(
                "  projection residual alone                {:9.4} ms",
                self.projection_400_frames_ms
            ),
            format!(
                "  dense pseudo-inverse                     {:9.4} ms, at most {:.1e} apart",
                self.projection_dense_ms, self.projection_max_difference
            ),
            format!(
                "switching model, features                  {:9.4} µs a frame",
                self.switching_us_per_frame
            ),
            format!(
                "  dense matrices, f64                      {:9.4} µs a frame",
                self.switching_dense_us_per_frame
            ),
            format!(
                "  one walker                               {:9.4} µs a frame",
                self.switching_walker_us_per_frame
            ),
            format!(
                "a body from one sensor, 10,000 frames      {:9.4} µs a frame, {:.1} µs with 100,000",
                self.imu_us_per_frame_10k, self.imu_us_per_frame_100k
            ),
            format!(
                "  from a sample over UDP to its pose       {:9.4} ms, {:.1} ms for one in a hundred",
                self.imu_sample_to_pose_ms, self.imu_sample_to_pose_p99_ms
            ),
        ];
        lines.extend(self.imu_sizes.iter().map(|size| {
            let paper = size
                .paper_ms
                .map_or_else(String::new, |ms| format!("; the paper's {ms:.0} ms"));
            format!(
                "  by a model of {:6} frames, {:5} segments  {:9.4} µs a frame{paper}",
                size.frames, size.segments, size.us_per_frame
            )
        }));
        lines
    }
}

/// The least of all times that it was given, microseconds.
struct Least(f64);

impl Default for Least {
    fn default() -> Self {
        Self(f64::INFINITY)
    }
}

impl Least {
    fn take(&mut self, us: f64) {
        self.0 = self.0.min(us);
    }
}

#[derive(Default)]
struct Best {
    ours: Least,
    single: Least,
    compact: Least,
    jbonsai: Least,
    hsmm: Least,
    walker: Least,
    walker_worst: Least,
    runner: Least,
    walker_state: Least,
    walker_restore: Least,
    kinematics: Least,
    fit: Least,
    refined_fit: Least,
    dense_fit: Least,
    switches: Least,
    projection: Least,
    dense_projection: Least,
    switching: Least,
    dense_switching: Least,
    switching_walker: Least,
    bodies: [Least; imu::SIZES.len()],
}

/// Duration of one run, microseconds.
fn time(run: impl FnOnce() -> Result<()>) -> Result<f64> {
    let begun = now();
    run()?;
    Ok(microseconds(begun.elapsed()))
}

#[expect(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
fn now() -> Instant {
    Instant::now()
}

fn microseconds(duration: Duration) -> f64 {
    1e6 * duration.as_secs_f64()
}
