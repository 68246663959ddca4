//! `footfall evaluate imu`: bodies from sensors against the recorded ones.

mod figures;
mod transitions;

use crate::commands::imu::{KeptArgs, imu_clip, parse_site};
use crate::motion_input::KneesArgs;
use crate::output;
use anyhow::{Context as _, Result};
use figures::{Figures, summarise};
use footfall_core::Site;
use footfall_model::ImuModel;
use footfall_motion::corpus::Where;
use footfall_recon::Published;
use footfall_train::imu::evaluate::{
    Conditions, Device, HeldOut, evaluate_imu, evaluate_imu_model, evaluate_transitions,
};
use footfall_train::imu::{ImuClip, ImuTrainConfig};
use footfall_train::read_model_file;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Sites of figure 10 of the paper, each alone, and the pair of table 3.
const SENSORS: [&[Site]; 6] = [
    &[Site::RightFoot],
    &[Site::RightFoot, Site::RightHand],
    &[Site::RightKnee],
    &[Site::RightHand],
    &[Site::RightForearm],
    &[Site::Root],
];

/// Bodies from one or two sensors against the recorded ones
///
/// Every recording is reconstructed by models that have not seen it: one trained on all other recordings, one on those of other
/// subjects. Mean distance of the joints, hips and heading brought together, over the frames in which the body moves: live, as a game
/// shows it, and whole, with what comes later in the recording. Beside them are trivial answers: one pose for all (constant), the average course of the phase
/// that the body truly is in (average), and the nearest of the model's poses (nearest), which a perfect tracker would show; and r, the mean
/// correlation, live, of the joints' coordinates that vary by more than a centimetre. Categories are the index's.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall evaluate imu --corpus index.csv --where 'path=cmu/*'\n  \
    footfall evaluate imu --corpus index.csv --where 'path=cmu/*' --site right_thigh --json\n  \
    footfall evaluate imu --corpus index.csv --where 'path=bandai/*' --model right_foot.footimu")]
pub(crate) struct ImuArgs {
    /// Table of the recordings
    #[arg(long, value_name = "INDEX.csv")]
    corpus: PathBuf,
    /// Condition on a column, for example `category=running`; may repeat
    #[arg(long = "where", value_name = "COLUMN=VALUE")]
    conditions: Vec<Where>,
    #[command(flatten)]
    knees: KneesArgs,
    /// Site of the sensor, twice for two sensors; the foot, foot and hand, and the sites of the paper's figure 10 one by one when absent
    #[arg(long = "site", value_parser = parse_site)]
    sites: Vec<Site>,
    #[command(flatten)]
    kept: KeptArgs,
    /// Judge this model on the recordings instead of training any; choose recordings of people that it has not seen
    #[arg(long, value_name = "BODY.footimu", conflicts_with_all = ["sites", "strangers", "transitions", "no_mirror", "frames", "learn_strapped"])]
    model: Option<PathBuf>,
    /// Condition on the recordings that are judged; models are trained on the others, too; may repeat
    #[arg(long = "judge", value_name = "COLUMN=VALUE")]
    judged: Vec<Where>,
    /// Leave out whole people only: no model that has seen other recordings of the same one
    #[arg(long)]
    strangers: bool,
    /// Simulated sensor that bodies are reconstructed from
    #[arg(long, value_enum, default_value_t)]
    device: DeviceArg,
    /// Part of the method as published, for comparison; comma-separated, may repeat
    #[arg(long, value_enum, value_delimiter = ',', value_name = "PART")]
    as_published: Vec<PartArg>,
    /// Show how suddenly bodies move where one motion gives way to another, instead of how close they come: eight changes of each kind, of people left out
    #[arg(long)]
    transitions: bool,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Simulated sensors.
#[derive(Clone, Copy, Debug, Default, clap::ValueEnum)]
enum DeviceArg {
    /// 100 samples a second, with the noise and the biases of hobby boards
    #[default]
    Board,
    /// A phone's browser: 60 samples a second, rounded to 0.1 m/s² and 0.1 °/s
    Phone,
    /// A board that nobody calibrated, on a strap that gives, up to 5 cm off the site: scales off by 2 %, one sample in fifty lost, axes that end at 4 g and 1000 °/s
    Strapped,
}

/// Parts of the published method (Mousas 2017).
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum PartArg {
    /// All of them
    All,
    /// Equal transitions: frames are kept, followed or skipped, phases left at any time
    Transitions,
    /// A Gaussian for each phase, refined by its segments, with every frame in full
    Gaussians,
    /// Five segments of the most probable phase
    Interpolation,
    /// Regression of the body on the sensor
    Regression,
    /// Velocity-based blending
    Blending,
}

impl PartArg {
    fn parts(self) -> &'static [Published] {
        match self {
            Self::All => &Published::ALL,
            Self::Transitions => &[Published::Transitions],
            Self::Gaussians => &[Published::Gaussians],
            Self::Interpolation => &[Published::Interpolation],
            Self::Regression => &[Published::Regression],
            Self::Blending => &[Published::Blending],
        }
    }
}

#[derive(Serialize)]
pub(super) struct Report {
    /// Parts of the method that are as published.
    as_published: Vec<&'static str>,
    sensors: Vec<SensorReport>,
}

#[derive(Serialize)]
struct SensorReport {
    sites: Vec<&'static str>,
    /// Changes from one motion to another; empty without --transitions, and then the only figures.
    transitions: Vec<transitions::Figures>,
    /// The model of --model; otherwise empty.
    given_model: BTreeMap<String, Figures>,
    /// Models that have seen all other recordings; empty with --strangers.
    other_recordings: BTreeMap<String, Figures>,
    /// Models that have seen other subjects only; empty when there is but one.
    other_subjects: BTreeMap<String, Figures>,
}

/// Evaluates, and returns the report that is printed as JSON.
pub(super) fn evaluate(args: &ImuArgs) -> Result<Report> {
    let read = |path: &Path| read_model_file(path, ImuModel::from_bytes);
    let model = args.model.as_deref().map(read).transpose()?;
    let model = model.map(Arc::new);
    let asked = match (&model, &args.sites[..]) {
        (Some(model), _) => vec![&model.sites[..]],
        (None, []) => SENSORS.to_vec(),
        (None, sites) => vec![sites],
    };
    let asked: Vec<ImuTrainConfig> = asked
        .into_iter()
        .map(|sites| args.kept.config(sites))
        .collect();
    for config in &asked {
        config.check()?;
    }
    let corpus = args.knees.read_corpus(&args.corpus, &args.conditions)?;
    let clips: Vec<ImuClip<'_>> = corpus.clips.iter().map(imu_clip).collect();
    let categories: Vec<&str> = corpus
        .clips
        .iter()
        .map(|clip| clip.row.category())
        .collect();
    let judged = |clip: usize| {
        let row = &corpus.clips[clip].row;
        let holds = |c: &Where| row.column(&c.column).is_some_and(|v| c.matches(v));
        args.judged.iter().all(holds)
    };
    let several = clips.iter().any(|clip| clip.subject != clips[0].subject);
    let device = match args.device {
        DeviceArg::Board => Device::Board,
        DeviceArg::Phone => Device::Phone,
        DeviceArg::Strapped => Device::Strapped,
    };
    let parts = args.as_published.iter().flat_map(|part| part.parts());
    let published: Vec<Published> = parts.copied().collect();
    let mut sensors = Vec::new();
    for config in &asked {
        let names: Vec<&'static str> = config.sites.iter().map(|site| site.name()).collect();
        output::note(&format!("reconstructing from {}", names.join(" and ")));
        let conditions = |held_out: HeldOut| Conditions {
            held_out,
            device,
            published: published.clone(),
        };
        if let Some(model) = &model {
            let trials = evaluate_imu_model(&clips, model, &conditions(HeldOut::Subject), &judged)?;
            sensors.push(SensorReport {
                given_model: summarise(&trials, &categories),
                ..SensorReport::of(names)
            });
            continue;
        }
        if args.transitions {
            let conditions = conditions(HeldOut::Subject);
            let trials = evaluate_transitions(&clips, config, &conditions, &judged)?;
            sensors.push(SensorReport {
                transitions: transitions::figures(&trials),
                ..SensorReport::of(names)
            });
            continue;
        }
        let figures = |held_out: HeldOut| -> Result<BTreeMap<String, Figures>> {
            let conditions = conditions(held_out);
            let trials = evaluate_imu(&clips, config, &conditions, &judged)
                .with_context(|| args.corpus.display().to_string())?;
            Ok(summarise(&trials, &categories))
        };
        sensors.push(SensorReport {
            other_recordings: if args.strangers {
                BTreeMap::new()
            } else {
                figures(HeldOut::Recording)?
            },
            other_subjects: if several {
                figures(HeldOut::Subject)?
            } else {
                BTreeMap::new()
            },
            ..SensorReport::of(names)
        });
    }
    Ok(Report {
        as_published: published.iter().map(|part| part.name()).collect(),
        sensors,
    })
}

pub(crate) fn run(args: &ImuArgs) -> Result<()> {
    let report = evaluate(args)?;
    if args.json {
        return output::print_json(&report);
    }
    let mut lines = Vec::new();
    for sensor in &report.sensors {
        lines.extend(transitions::lines(
            &sensor.sites.join(" and "),
            &sensor.transitions,
        ));
        for (seen, figures) in [
            ("given model", &sensor.given_model),
            ("trained on other recordings", &sensor.other_recordings),
            ("trained on other subjects", &sensor.other_subjects),
        ] {
            if figures.is_empty() {
                continue;
            }
            lines.push(format!(
                "{}, {seen}; cm over moving frames",
                sensor.sites.join(" and ")
            ));
            lines.push(Figures::title());
            lines.extend(
                figures
                    .iter()
                    .map(|(category, figures)| figures.line(category)),
            );
            if let Some(total) = figures.get("total") {
                lines.extend(total.confusion_lines());
            }
            lines.push(String::new());
        }
    }
    output::print_text(lines.join("\n").trim_end())
}

impl SensorReport {
    /// Nothing yet of sensors at these sites.
    const fn of(sites: Vec<&'static str>) -> Self {
        Self {
            sites,
            transitions: Vec::new(),
            given_model: BTreeMap::new(),
            other_recordings: BTreeMap::new(),
            other_subjects: BTreeMap::new(),
        }
    }
}
