//! `footfall evaluate contacts --sensors`, on foot sensors with reference events, and on the bodies that they drive.

use crate::common::footfall;
use crate::imu::reconstruct;
use footfall_motion::retarget::RetargetOptions;
use footfall_tests::data::recordings;
use serde_json::json;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Force and rate of one sensor, and when its foot landed and left, in samples.
struct Recorded {
    name: String,
    foot: &'static str,
    rate_hz: f64,
    /// Numbers of the samples that arrived: some were lost on the way.
    numbers: Vec<f64>,
    samples: Vec<[f64; 6]>,
    landings: Vec<f64>,
    departures: Vec<f64>,
}

/// Writes recordings in the product's formats, and their index.
fn write(folder: &Path, category: &str, recordings: &[Recorded]) {
    let mut index = "path,category,style,subject,events\n".to_owned();
    for Recorded {
        name,
        foot,
        rate_hz,
        numbers,
        samples,
        landings,
        departures,
    } in recordings
    {
        let mut text = "time_s,ax,ay,az,gx,gy,gz\n".to_owned();
        for (number, [ax, ay, az, gx, gy, gz]) in numbers.iter().zip(samples) {
            let time = number / rate_hz;
            writeln!(text, "{time:.6},{ax},{ay},{az},{gx},{gy},{gz}").expect("a string");
        }
        fs::write(folder.join(format!("{name}.csv")), text).expect("a file");
        let event = |kind: &'static str| move |sample: &f64| json!({"time_s": sample / rate_hz, "foot": foot, "kind": kind});
        let events: Vec<_> = landings
            .iter()
            .map(event("initial_contact"))
            .chain(departures.iter().map(event("terminal_contact")))
            .collect();
        let events = json!({ "events": events }).to_string();
        fs::write(folder.join(format!("{name}.json")), events).expect("a file");
        writeln!(index, "{name}.csv,{category},walk,someone,{name}.json").expect("a string");
    }
    fs::write(folder.join("sensors.csv"), index).expect("a file");
}

fn numbers(line: &str, separator: char) -> Vec<f64> {
    let fields = line
        .split(separator)
        .filter(|field| !field.trim().is_empty());
    fields
        .filter_map(|field| field.trim().parse().ok())
        .collect()
}

/// Two feet of eight people who walk, turn round and walk back.
fn ipol(data: &Path) -> Vec<Recorded> {
    let folder = data.join("imu/ipol_voisard/GaitData");
    let entries = fs::read_dir(folder).expect("a folder").flatten();
    let mut files: Vec<_> = entries.map(|entry| entry.path()).collect();
    files.retain(|path| {
        path.extension()
            .is_some_and(|extension| extension == "json")
    });
    files.sort();
    let mut recorded = Vec::new();
    for path in files {
        let text = fs::read_to_string(&path).expect("a file");
        // What is not known of a person is NaN there, which JSON has not.
        let facts: serde_json::Value =
            serde_json::from_str(&text.replace("NaN", "null")).expect("JSON");
        let stem = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        for (foot, key) in [("left", "LeftFootEvents"), ("right", "RightFootEvents")] {
            let name = format!("{stem}_{}f", &foot[..1]);
            let text =
                fs::read_to_string(path.with_file_name(format!("{name}.txt"))).expect("a file");
            let rows = text.lines().skip(2).map(|line| numbers(line, '\t'));
            let rows: Vec<Vec<f64>> = rows.filter(|row| row.len() >= 7).collect();
            let swings = facts[key].as_array().expect("events");
            let of = |end: usize| swings.iter().filter_map(move |swing| swing[end].as_f64());
            recorded.push(Recorded {
                name,
                foot,
                rate_hz: 100.0,
                numbers: rows.iter().map(|row| row[0]).collect(),
                samples: rows
                    .iter()
                    .map(|row| core::array::from_fn(|channel| row[1 + channel]))
                    .collect(),
                landings: of(1).collect(),
                departures: of(0).collect(),
            });
        }
    }
    recorded
}

/// Two feet of one walk.
fn gaitmap(data: &Path) -> Vec<Recorded> {
    let folder = data.join("imu/gaitmap_example");
    let text = fs::read_to_string(folder.join("imu_sample.csv")).expect("a file");
    let events = fs::read_to_string(folder.join("stride_events_sample.csv")).expect("a file");
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(2)
        .map(|line| numbers(line, ','))
        .collect();
    let feet = ["left", "right"].into_iter().enumerate();
    feet.map(|(foot, name)| {
        // Columns: index, then acc x of both feet, acc y of both feet, …; rates in degrees.
        let sample = |row: &Vec<f64>| {
            core::array::from_fn(|channel| {
                let value = row[1 + 2 * channel + foot];
                if channel < 3 {
                    value
                } else {
                    value.to_radians()
                }
            })
        };
        let strides: Vec<Vec<&str>> = events
            .lines()
            .skip(1)
            .map(|line| line.split(',').collect())
            .filter(|stride: &Vec<&str>| stride.get(1) == Some(&name))
            .collect();
        let of = |column: usize| {
            strides
                .iter()
                .filter_map(move |stride| stride[column].parse().ok())
        };
        Recorded {
            name: name.to_owned(),
            foot: name,
            rate_hz: 204.8,
            numbers: (0..rows.len()).map(|n| n as f64).collect(),
            samples: rows
                .iter()
                .filter(|row| row.len() >= 13)
                .map(sample)
                .collect(),
            landings: of(4).collect(),
            departures: of(5).collect(),
        }
    })
    .collect()
}

#[test]
fn contacts_of_real_foot_sensors_are_found() {
    let Some(data) = recordings("sensors") else {
        return;
    };
    // Of the initial and of the terminal contacts, by switches, by swings, and of bodies, live and whole.
    let model = format!(
        "{}/../../../addons/footfall/models/right_foot.footimu",
        env!("CARGO_MANIFEST_DIR")
    );
    for (category, recorded, least, bodies) in [
        (
            "ipol",
            ipol(&data),
            [[0.65, 0.65], [0.90, 0.96]],
            [[0.86, 0.86], [0.90, 0.91]],
        ),
        (
            "gaitmap",
            gaitmap(&data),
            [[0.75, 0.9], [0.95, 0.98]],
            [[0.84, 0.95], [0.94, 0.96]],
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), category, &recorded);
        let arguments = ["evaluate", "contacts", "--sensors", "sensors.csv"];
        let report = footfall(folder.path(), &[&arguments[..], &["--json"]].concat()).json();
        let driven = [
            &arguments[..],
            &["--model", &model, "--tolerance", "50", "--json"],
        ];
        let driven = footfall(folder.path(), &driven.concat()).json();
        for (body, least) in ["body live", "body whole"].into_iter().zip(bodies) {
            for (kind, least) in ["initial contact", "terminal contact"]
                .into_iter()
                .zip(least)
            {
                let agreement = &driven["sensors"][format!("{category}, {kind}, {body}")];
                assert!(
                    agreement["f1"].as_f64().unwrap() >= least,
                    "{body}: {agreement}"
                );
            }
        }
        for (detector, least) in ["switches", "swings"].into_iter().zip(least) {
            for (kind, least) in ["initial contact", "terminal contact"]
                .into_iter()
                .zip(least)
            {
                let agreement = &report["sensors"][format!("{category}, {kind}, {detector}")];
                assert_eq!(agreement["recordings"], recorded.len(), "{report}");
                assert!(agreement["f1"].as_f64().unwrap() >= least, "{agreement}");
                let [known, found] = ["known", "found"].map(|key| agreement[key].as_f64().unwrap());
                assert!((found / known - 1.0).abs() < 0.1, "{agreement}");
                assert!(
                    agreement["bias_ms"].as_f64().unwrap().abs() < 25.0,
                    "{agreement}"
                );
            }
        }
    }
}

#[test]
fn sensors_without_events_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let evaluate = || {
        footfall(
            folder,
            &["evaluate", "contacts", "--sensors", "sensors.csv"],
        )
    };
    let still = Recorded {
        name: "still".to_owned(),
        foot: "left",
        rate_hz: 100.0,
        numbers: (0..300).map(f64::from).collect(),
        samples: vec![[0.0, 9.81, 0.0, 0.0, 0.0, 0.0]; 300],
        landings: vec![100.0],
        departures: vec![150.0],
    };
    write(folder, "still", &[still]);
    // Nothing switches: nothing is found, which is no error.
    let run = evaluate();
    assert_eq!(run.code, 0, "{}", run.stderr);
    fs::write(folder.join("still.json"), "{\"events\": []}").unwrap();
    evaluate().fails_with(&["still.json", "no events"]);
    fs::write(folder.join("still.json"), "none").unwrap();
    evaluate().fails_with(&["still.json", "imu events"]);
    fs::write(folder.join("still.csv"), "time_s,ax\n").unwrap();
    fs::write(
        folder.join("still.json"),
        "{\"events\": [{\"time_s\": 1, \"kind\": \"initial_contact\"}]}",
    )
    .unwrap();
    evaluate().fails_with(&["still.csv", "line 1", "time_s,ax,ay,az,gx,gy,gz"]);
    fs::write(
        folder.join("sensors.csv"),
        "path,category,style,subject\nstill.csv,a,b,c\n",
    )
    .unwrap();
    evaluate().fails_with(&["sensors.csv", "line 2", "events"]);
}

#[test]
fn a_real_sensor_worn_anyhow_walks_its_loop() {
    let Some(data) = recordings("sensors") else {
        return;
    };
    let model =
        footfall_tests::data::repository().join("addons/footfall/models/right_foot.footimu");
    let model = model.to_str().expect("a path in UTF-8");
    // Who wore it walked about 25 m and 60 m and ended where it began. The body walks 21.3 m and 56.4 m.
    for (name, least_m, most_m) in [("short_walk", 19.0, 25.0), ("long_walk", 52.0, 62.0)] {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let recording = data.join(format!("imu/xio_gait_tracking/{name}.csv"));
        fs::copy(recording, folder.join("imu.csv")).unwrap();
        let report = reconstruct(folder, model, "imu.csv", &["--live"]).json();
        assert!(
            report["mountings"][0]["certainty"].as_f64().unwrap() > 0.9,
            "{report}"
        );
        let walked = report["behaviours"]
            .as_array()
            .unwrap()
            .iter()
            .find(|span| span[0] == "walk");
        assert!(
            walked.expect("a walk")[1].as_f64().unwrap() > 15.0,
            "{report}"
        );
        let file = footfall_motion::bvh::read(folder.join("out.bvh")).unwrap();
        let clip = footfall_motion::retarget::retarget(&file, &RetargetOptions::default())
            .unwrap()
            .clip;
        let places: Vec<_> = clip.poses.iter().map(|pose| pose.root_position).collect();
        let way: f32 = places
            .iter()
            .step_by(15)
            .zip(places.iter().skip(15).step_by(15))
            .map(|(a, b)| a.distance(*b))
            .sum();
        let open = places[0].distance(places[places.len() - 1]);
        eprintln!("{name}: {way:.1} m, {open:.2} m from where it began");
        assert!((least_m..most_m).contains(&way), "{name}: {way} m");
        assert!(
            open < 0.05 * way,
            "{name}: ends {open} m from where it began, after {way} m"
        );
    }
}
