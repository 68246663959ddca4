//! The comparison as JSON and as a table.

use super::pace::Pace;
use footfall_train::evaluate::told_apart::bouts::Gait;
use footfall_train::evaluate::told_apart::detail::PartDetail;
use footfall_train::evaluate::told_apart::folds::{Accuracy, Verdict};
use footfall_train::evaluate::told_apart::posture::Posture;
use footfall_train::evaluate::told_apart::root::RootHarmonics;
use footfall_train::evaluate::told_apart::{Comparison, features::View};
use serde::Serialize;
use std::fmt::Write as _;

/// Generated walks beside captured ones.
#[derive(Serialize)]
pub(crate) struct Report {
    gait: &'static str,
    people: usize,
    captured_strides: usize,
    seeds: usize,
    generated_strides: usize,
    told_apart: Vec<ToldApart>,
    /// Speed, cadence, flight and slip.
    pace: Pace,
    detail: Vec<Detail>,
    captured: Measures,
    generated: Measures,
    pub(super) skipped: Vec<String>,
}

/// Balanced accuracies with one set of features; chance is 0.5.
#[derive(Serialize)]
struct ToldApart {
    features: &'static str,
    logistic: f64,
    trees: f64,
    /// People in the generator's place: mean, least and greatest over divisions.
    people_logistic: Option<[f64; 3]>,
    people_trees: Option<[f64; 3]>,
}

/// Motion of 3 to 6 Hz of one part.
#[derive(Serialize)]
struct Detail {
    part: &'static str,
    captured_deg: f64,
    captured_repeats: f64,
    generated_deg: f64,
    generated_repeats: f64,
}

/// Hips, knees and feet.
#[derive(Serialize)]
struct Measures {
    hips_limp_mps: f64,
    hips_step_mps: f64,
    hips_surge_mps: f64,
    hips_limp_cm: f64,
    hips_bob_cm: f64,
    hips_jolt_cm: f64,
    knee_tenth_deg: f64,
    knee_at_contact_deg: f64,
    knee_swing_deg: f64,
    foot_pitch_deg: f64,
}

/// A line of the table and its measure.
type MeasureRow = (&'static str, fn(&Measures) -> f64);

impl Measures {
    fn new(root: &RootHarmonics, posture: &Posture) -> Self {
        let [limp, step, surge] = root.speed_mps;
        let [height_limp, bob, jolt] = root.height_m.map(|height| 100.0 * height);
        Self {
            hips_limp_mps: limp,
            hips_step_mps: step,
            hips_surge_mps: surge,
            hips_limp_cm: height_limp,
            hips_bob_cm: bob,
            hips_jolt_cm: jolt,
            knee_tenth_deg: posture.knee_tenth.to_degrees(),
            knee_at_contact_deg: posture.knee_at_contact.to_degrees(),
            knee_swing_deg: posture.knee_swing.to_degrees(),
            foot_pitch_deg: posture.foot_pitch.to_degrees(),
        }
    }
}

impl Report {
    /// The report of a comparison, with the scores of people in the generator's place.
    pub(super) fn new(
        gait: Gait,
        comparison: &Comparison,
        people: &[Option<Verdict>],
        skipped: Vec<String>,
    ) -> Self {
        let told_apart = |((view, verdict), people): (&(View, Verdict), &Option<Verdict>)| {
            let of_people = |classifier: usize| {
                let people = people.as_ref()?;
                let Accuracy {
                    mean,
                    least,
                    greatest,
                } = people.accuracies[classifier];
                Some([mean, least, greatest])
            };
            ToldApart {
                features: view.name(),
                logistic: verdict.accuracies[0].mean,
                trees: verdict.accuracies[1].mean,
                people_logistic: of_people(0),
                people_trees: of_people(1),
            }
        };
        let detail = |(part, [captured, generated]): &(&'static str, [PartDetail; 2])| Detail {
            part,
            captured_deg: captured.rms.to_degrees(),
            captured_repeats: captured.repeats,
            generated_deg: generated.rms.to_degrees(),
            generated_repeats: generated.repeats,
        };
        let [captured, generated] =
            [0, 1].map(|side| Measures::new(&comparison.root[side], &comparison.posture[side]));
        Self {
            gait: gait.name(),
            people: comparison.walkers[0],
            captured_strides: comparison.strides[0],
            seeds: comparison.walkers[1],
            generated_strides: comparison.strides[1],
            told_apart: comparison
                .told_apart
                .iter()
                .zip(people)
                .map(told_apart)
                .collect(),
            pace: Pace::new(&comparison.gait),
            detail: comparison.detail.iter().map(detail).collect(),
            captured,
            generated,
            skipped,
        }
    }

    /// Text for a terminal.
    pub(super) fn table(&self) -> String {
        let mut text = format!(
            "{}: {} strides of {} people, {} strides of {} seeds\n\nTold apart (balanced accuracy on people and seeds not learned from; chance 0.50)\n{:<12} {:>9} {:>6}   {:>28}\n",
            self.gait,
            self.captured_strides,
            self.people,
            self.generated_strides,
            self.seeds,
            "features",
            "logistic",
            "trees",
            "people in its place"
        );
        // Writing to a string does not fail.
        for row in &self.told_apart {
            let people = |values: Option<[f64; 3]>| {
                values.map_or_else(
                    || "too few people".to_owned(),
                    |[mean, least, greatest]| format!("{mean:.2} ({least:.2} to {greatest:.2})"),
                )
            };
            let _written = writeln!(
                text,
                "{:<12} {:>9.2} {:>6.2}   {}; {}",
                row.features,
                row.logistic,
                row.trees,
                people(row.people_logistic),
                people(row.people_trees)
            );
        }
        text.push_str(&self.pace.table());
        text.push_str(
            "\nDetail of 3 to 6 Hz (degrees, share that repeats)     captured      generated\n",
        );
        for row in &self.detail {
            let _written = writeln!(
                text,
                "{:<48} {:>5.2} {:>5.2}   {:>5.2} {:>5.2}",
                row.part,
                row.captured_deg,
                row.captured_repeats,
                row.generated_deg,
                row.generated_repeats
            );
        }
        text.push_str("\nHips, knees and feet                               captured  generated\n");
        let rows: [MeasureRow; 10] = [
            ("speed, stride's frequency (limp), m/s", |m| m.hips_limp_mps),
            ("speed, step's frequency, m/s", |m| m.hips_step_mps),
            ("speed, harmonics 3 to 8 (surge), m/s", |m| m.hips_surge_mps),
            ("height, stride's frequency, cm", |m| m.hips_limp_cm),
            ("height, step's frequency (bob), cm", |m| m.hips_bob_cm),
            ("height, harmonics 3 to 8, cm", |m| m.hips_jolt_cm),
            ("knee, 10th percentile, degrees", |m| m.knee_tenth_deg),
            ("knee at initial contact, degrees", |m| {
                m.knee_at_contact_deg
            }),
            ("knee, most in a stride, degrees", |m| m.knee_swing_deg),
            ("pitch of the feet, toes down, degrees", |m| {
                m.foot_pitch_deg
            }),
        ];
        for (name, of) in rows {
            let (captured, generated) = (of(&self.captured), of(&self.generated));
            let _written = writeln!(text, "{name:<48} {captured:>10.3} {generated:>10.3}");
        }
        text
    }
}
