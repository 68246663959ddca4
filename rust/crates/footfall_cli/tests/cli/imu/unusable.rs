//! Sensors, models and settings that cannot be used.

use super::prepare;
use crate::common::footfall;
use std::fs;

#[test]
fn what_cannot_be_used_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let walk = prepare(folder, "right_thigh");
    let text = |change: fn(f64, f64) -> (f64, f64)| {
        let simulate = [
            "imu",
            "simulate",
            &walk,
            "--site",
            "right_thigh",
            "-o",
            "imu.csv",
        ];
        assert_eq!(footfall(folder, &simulate).code, 0);
        let text = fs::read_to_string(folder.join("imu.csv")).expect("a recording");
        let lines = text.lines().enumerate().map(|(n, line)| {
            if n == 0 {
                return line.to_owned();
            }
            let row: Vec<f64> = line
                .split(',')
                .map(|f| f.parse().expect("a number"))
                .collect();
            let changed = (1..7).map(|c| {
                let (force, rate) = change(row[c], row[c]);
                if c < 4 { force } else { rate }.to_string()
            });
            format!("{},{}", row[0], changed.collect::<Vec<_>>().join(","))
        });
        lines.collect::<Vec<_>>().join("\n")
    };
    let reconstruct = |imu: &str| {
        footfall(
            folder,
            &[
                "imu",
                "reconstruct",
                "--model",
                "body.footimu",
                "--imu",
                imu,
                "-o",
                "out.bvh",
            ],
        )
    };
    fs::write(
        folder.join("g.csv"),
        text(|force, rate| (force / 9.806_65, rate)),
    )
    .unwrap();
    reconstruct("g.csv").fails_with(&["g.csv", "unit is g", "9.80665"]);
    fs::write(
        folder.join("degrees.csv"),
        text(|force, rate| (force, rate.to_degrees())),
    )
    .unwrap();
    reconstruct("degrees.csv").fails_with(&["degrees.csv", "degrees", "0.0174533"]);
    fs::write(folder.join("nan.csv"), text(|force, _| (force, f64::NAN))).unwrap();
    reconstruct("nan.csv").fails_with(&["nan.csv", "line 2", "NaN"]);
    fs::write(folder.join("empty.csv"), "").unwrap();
    reconstruct("empty.csv").fails_with(&["empty.csv"]);
    let short: Vec<String> = text(|force, rate| (force, rate))
        .lines()
        .take(60)
        .map(str::to_owned)
        .collect();
    fs::write(folder.join("short.csv"), short.join("\n")).unwrap();
    reconstruct("short.csv").fails_with(&["short.csv", "--mounting aligned"]);
    reconstruct("none.csv").fails_with(&["none.csv"]);
    assert!(
        !folder.join("out.bvh").exists(),
        "nothing is written when it fails"
    );

    let events = ["imu", "events", "imu.csv", "--site", "right_thigh"];
    footfall(folder, &events).fails_with(&["right_thigh", "right_foot or left_foot"]);
    let no_site = footfall(folder, &["imu", "events", "imu.csv", "--site", "tail"]);
    assert_eq!(no_site.code, 2);
    assert!(
        no_site.stderr.contains("left_forearm"),
        "{}",
        no_site.stderr
    );
    let other = [
        "imu",
        "reconstruct",
        "--model",
        "index.csv",
        "--imu",
        "imu.csv",
        "-o",
        "out.bvh",
    ];
    footfall(folder, &other).fails_with(&["index.csv", "not a Footfall model"]);
    let onto = [
        "imu", "simulate", &walk, "--site", "root", "--rate", "0", "-o", "x.csv",
    ];
    footfall(folder, &onto).fails_with(&["--rate"]);
    let loose = [
        "imu", "simulate", &walk, "--site", "root", "--strap", "11", "-o", "x.csv",
    ];
    footfall(folder, &loose).fails_with(&["--strap 11", "0 to 10"]);
}
