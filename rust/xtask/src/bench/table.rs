//! The table of measurements.

use super::machine::Machine;

/// Peer or limit of a line.
enum Beside {
    /// Another program or a slower way, measured in the same process: its name and its figure.
    Peer(&'static str, &'static str),
    /// Number in the line's unit that the project asks of itself or others report, and its source.
    Limit(f64, &'static str),
}

use Beside::{Limit, Peer};

/// A line: what is measured, its unit, the figure, and what stands beside it.
pub(super) struct Line(&'static str, &'static str, &'static str, Beside);

pub(super) const LINES: [Line; 15] = [
    Line(
        "MLPG trajectory of 1,000 frames, f64, per frame",
        "µs",
        "kernels.mlpg_f64_us_per_frame",
        Peer("jbonsai", "kernels.jbonsai_us_per_frame"),
    ),
    Line(
        "One walker, per frame",
        "µs",
        "kernels.walker_us_per_frame",
        Limit(0.5, "goal"),
    ),
    Line(
        "One runner at 3 m/s, per frame",
        "µs",
        "kernels.runner_us_per_frame",
        Limit(0.6, "goal"),
    ),
    Line(
        "State of one walker, saved",
        "µs",
        "kernels.walker_state_us",
        Limit(20.0, "goal"),
    ),
    Line(
        "State of one walker, restored",
        "µs",
        "kernels.walker_restore_us",
        Limit(20.0, "goal"),
    ),
    Line(
        "Switching model, fit of ten segments",
        "ms",
        "kernels.dynamics_fit_ms",
        Peer("dense SVD", "kernels.dynamics_fit_dense_ms"),
    ),
    Line(
        "Projection residual of 400 frames",
        "ms",
        "kernels.projection_400_frames_ms",
        Peer("dense pseudo-inverse", "kernels.projection_dense_ms"),
    ),
    Line(
        "Switching model, features per frame",
        "µs",
        "kernels.switching_us_per_frame",
        Peer("dense matrices", "kernels.switching_dense_us_per_frame"),
    ),
    Line(
        "Body from one sensor, model of 10,000 frames, per frame",
        "µs",
        "kernels.imu_us_per_frame_10k",
        Limit(40.0, "goal; the paper has 758,000"),
    ),
    Line(
        "Delay from a UDP sample to its pose, 99th percentile",
        "ms",
        "kernels.imu_sample_to_pose_p99_ms",
        Limit(16.7, "a frame at 60 Hz"),
    ),
    Line(
        "Crowd of 10,000, all new poses, per frame",
        "ms",
        "crowds.all_fresh_ms",
        Limit(6.0, "goal"),
    ),
    Line(
        "Crowd of 10,000 in tiers, per frame",
        "ms",
        "crowds.tiers_ms",
        Limit(16.7, "a frame at 60 Hz"),
    ),
    Line(
        "Whole skeleton of a crowd beyond the engine's own cost, per frame",
        "µs",
        "crowds.skeleton_us_per_walker",
        Limit(2.5, "goal"),
    ),
    Line(
        "Call that adds 10,000 walkers",
        "ms",
        "crowds.add_agents_ms",
        Limit(16.7, "a frame at 60 Hz"),
    ),
    Line(
        "Longest part of a frame while they are created",
        "ms",
        "crowds.making_longest_ms",
        Limit(16.7, "a frame at 60 Hz"),
    ),
];

/// A line as one machine has it.
pub(super) struct Reading {
    unit: &'static str,
    own: f64,
    /// Name of what stands beside it.
    label: &'static str,
    other: f64,
}

impl Line {
    pub(super) fn title(&self) -> &'static str {
        self.0
    }

    /// The figure and what stands beside it, if both were measured.
    pub(super) fn reading(&self, machine: &Machine) -> Option<Reading> {
        let Self(_, unit, name, beside) = self;
        let (label, other) = match beside {
            Peer(label, name) => (*label, machine.figure(name)?),
            Limit(limit, label) => (*label, *limit),
        };
        let own = machine.figure(name)?;
        Some(Reading {
            unit,
            own,
            label,
            other,
        })
    }

    /// The figure, and what stands beside it with the factor between both.
    fn cells(&self, machine: &Machine) -> [String; 2] {
        self.reading(machine).map_or_else(
            || ["-", "-"].map(str::to_owned),
            |reading| {
                let Reading {
                    unit,
                    own,
                    label,
                    other,
                } = &reading;
                let factor = reading.factor();
                [
                    format!("{} {unit}", rounded(*own)),
                    format!("{} {unit} ({label}), {factor:.1} times", rounded(*other)),
                ]
            },
        )
    }
}

impl Reading {
    /// Number of times that the measurement goes into what stands beside it: above 1 it is better.
    pub(super) fn factor(&self) -> f64 {
        self.other / self.own
    }

    /// Both figures in a few words.
    pub(super) fn short(&self) -> String {
        let Self {
            unit,
            own,
            label,
            other,
        } = self;
        let label = label.split(';').next().unwrap_or_default();
        let [own, other] = [own, other].map(|value| rounded(*value));
        format!("{own} {unit}; {label} {other} {unit}")
    }
}

/// Three digits that count.
fn rounded(value: f64) -> String {
    let before = value.abs().log10().floor().max(-9.0) as i32 + 1;
    format!("{value:.*}", (3 - before).clamp(0, 6) as usize)
}

/// The table of one machine for the terminal.
pub(super) fn text(machine: &Machine) -> String {
    let head = format!("{}, {}\n", machine.title(), machine.platform);
    let lines = LINES.iter().map(|line| {
        let [own, beside] = line.cells(machine);
        format!("{:64} {own:>12}   {beside}\n", line.0)
    });
    head + &lines.collect::<String>()
}

/// The page with all machines that were kept.
pub(super) fn page(machines: &[Machine]) -> String {
    let head = "# Benchmarks\n\n\
        Each line compares a measurement with a peer in the same process, or with a limit. \"Times\" is the ratio of the reference to the measurement: below 1, the limit is missed.\n\
        `cargo xtask bench` prints the table for your machine; `cargo xtask bench --keep` adds your machine to this page.\n\
        On machines with other load, trust ratios more than times.\n";
    let tables = machines.iter().map(|machine| {
        let title = machine.title();
        let lines = LINES.iter().map(|line| {
            let [own, beside] = line.cells(machine);
            format!("| {} | {own} | {beside} |\n", line.0)
        });
        format!(
            "\n## {title}\n\n{}, Footfall {}.\n\n![{title}: factors between measurements and references]({}/{})\n\n| | measured | reference |\n| --- | --- | --- |\n{}",
            machine.platform,
            machine.version,
            super::FOLDER,
            machine.file_name("svg"),
            lines.collect::<String>()
        )
    });
    head.to_owned() + &tables.collect::<String>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn machine() -> Machine {
        let kernels = json!({"mlpg_f64_us_per_frame": 0.25, "jbonsai_us_per_frame": 9.0, "walker_us_per_frame": 1.0});
        let mut machine = Machine::here(kernels, json!({"all_fresh_ms": 5.5}));
        machine.processor = "Test(R) CPU @ 2.0GHz".to_owned();
        machine.threads = 2;
        machine
    }

    #[test]
    fn a_line_says_how_often_it_goes_into_its_peer_or_limit() {
        let mut machine = machine();
        assert_eq!(
            machine.file_name("json"),
            "test_r_cpu_2_0ghz_2_threads.json"
        );
        assert_eq!(
            LINES[0].cells(&machine),
            ["0.250 µs", "9.00 µs (jbonsai), 36.0 times"]
        );
        assert_eq!(
            LINES[1].cells(&machine),
            ["1.00 µs", "0.500 µs (goal), 0.5 times"]
        );
        assert_eq!(LINES[2].cells(&machine), ["-", "-"]);
        machine.crowds = json!({"all_fresh_ms": 5.5, "skeleton_us_per_walker": -0.01});
        assert_eq!(LINES[9].cells(&machine), ["-", "-"]);
        let page = page(&[machine]);
        assert!(page.contains(
            "| Crowd of 10,000, all new poses, per frame | 5.50 ms | 6.00 ms (goal), 1.1 times |"
        ));
    }

    #[test]
    fn three_digits_count() {
        let shown = [0.012_345, 1.0, 12.345, 1234.5, 0.0].map(rounded);
        assert_eq!(shown, ["0.0123", "1.00", "12.3", "1234", "0.000000"]);
    }
}
