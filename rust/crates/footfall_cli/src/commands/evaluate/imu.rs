//! `footfall evaluate imu`: bodies from sensors against the recorded ones.

mod table;

use crate::commands::imu::{KeptArgs, parse_site};
use crate::commands::train::TrainingProgress;
use crate::motion_input::SkeletonArgs;
use crate::output;
use anyhow::{Context as _, Result};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use footfall_core::Site;
use footfall_model::ImuModel;
use footfall_motion::corpus::Where;
use footfall_recon::Published;
use footfall_train::evaluate::imu::{
    ImuModels, ImuReport, ImuRequest, PAPER_SENSORS, evaluate_sensors,
};
use footfall_train::imu::evaluate::Device;
use footfall_train::imu::level_trunks;
use footfall_train::read_model_file;
use std::path::PathBuf;
use std::sync::Arc;

/// Compare bodies reconstructed from one or two sensors with the recorded ones
///
/// Every recording is reconstructed by models that have not seen it: one trained on all other recordings, one on those of other
/// subjects. Distances are means over the joints with hips and heading aligned, over the frames in which the body moves: live, as in a
/// game, and whole, with later samples. For comparison there are trivial answers: one pose for all frames (constant), the average of the true phase
/// (average), and the nearest of the model's poses (nearest), which a perfect tracker would show. r is the mean
/// live correlation of the joints' coordinates that vary by more than a centimetre. Categories are those of the index.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall evaluate imu --corpus index.csv --where 'path=cmu/*'\n  \
    footfall evaluate imu --corpus index.csv --where 'path=cmu/*' --site right_thigh --json\n  \
    footfall evaluate imu --corpus index.csv --where 'path=bandai/*' --model right_foot.footimu")]
pub(crate) struct ImuArgs {
    /// Index of the recordings
    #[arg(long, value_name = "INDEX.csv")]
    corpus: PathBuf,
    /// Condition on a column, for example `category=running`; repeatable
    #[arg(long = "where", value_name = "COLUMN=VALUE")]
    conditions: Vec<Where>,
    #[command(flatten)]
    fit: SkeletonArgs,
    /// Site of the sensor; twice for two sensors [default: the foot, foot and hand, and each site of the paper's figure 10]
    #[arg(long = "site", value_parser = parse_site)]
    sites: Vec<Site>,
    #[command(flatten)]
    kept: KeptArgs,
    /// Evaluate this model instead of training any; select recordings of people that it has not seen
    #[arg(long, value_name = "BODY.footimu", conflicts_with_all = ["sites", "strangers", "transitions", "no_mirror", "frames", "learn_strapped"])]
    model: Option<PathBuf>,
    /// Condition on the recordings to evaluate; models train on the others, too; repeatable
    #[arg(long = "judge", value_name = "COLUMN=VALUE")]
    judged: Vec<Where>,
    /// Leave out whole people only: skip models that have seen other recordings of the same person
    #[arg(long)]
    strangers: bool,
    /// Simulated sensor
    #[arg(long, value_enum, default_value_t)]
    device: DeviceArg,
    /// Part of the method to use as published, for comparison; comma-separated, repeatable
    #[arg(long, value_parser = published_parts(), value_delimiter = ',', value_name = "PART")]
    as_published: Vec<&'static [Published]>,
    /// Show the accelerations at transitions between motions instead of distances: eight transitions of each kind, of people left out
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
    /// An uncalibrated board on a loose strap, up to 5 cm off the site: scales off by 2 %, 2 % of samples lost, axes that end at 4 g and 1000 °/s
    Strapped,
}

impl DeviceArg {
    const fn device(self) -> Device {
        match self {
            Self::Board => Device::Board,
            Self::Phone => Device::Phone,
            Self::Strapped => Device::Strapped,
        }
    }
}

/// Parser of a part of the published method (Mousas 2017), or of `all`.
fn published_parts() -> impl TypedValueParser<Value = &'static [Published]> {
    let all = PossibleValue::new("all").help("All of them");
    let each = Published::ALL.map(|part| PossibleValue::new(part.name()).help(part.summary()));
    PossibleValuesParser::new([all].into_iter().chain(each)).map(|name| {
        let index = Published::ALL.iter().position(|part| part.name() == name);
        index.map_or(&Published::ALL[..], |index| &Published::ALL[index..=index])
    })
}

/// Evaluates, and returns the report that is printed as JSON.
fn evaluate(args: &ImuArgs) -> Result<ImuReport> {
    let request = args.request()?;
    request.check()?;
    let mut corpus = args.fit.read_corpus(&args.corpus, &args.conditions)?;
    let bent = args.fit.bent_trunks(&corpus.clips);
    level_trunks(&mut corpus.clips, &bent);
    let mut progress = TrainingProgress(output::Progress::new());
    let report = evaluate_sensors(&corpus.clips, &request, &mut progress)
        .with_context(|| args.corpus.display().to_string())?;
    progress.0.finish();
    Ok(report)
}

impl ImuArgs {
    /// The request that the arguments make; reads the model if there is one.
    fn request(&self) -> Result<ImuRequest> {
        let asked = match &self.sites[..] {
            [] => PAPER_SENSORS.to_vec(),
            sites => vec![sites],
        };
        let asked = asked.into_iter().map(|sites| self.kept.config(sites));
        let models = match &self.model {
            Some(path) => {
                let model = read_model_file(path, ImuModel::from_bytes)?;
                ImuModels::Given(Arc::new(model))
            }
            None if self.transitions => ImuModels::Transitions(asked.collect()),
            None if self.strangers => ImuModels::TrainedOnStrangers(asked.collect()),
            None => ImuModels::Trained(asked.collect()),
        };
        Ok(ImuRequest {
            models,
            judged: self.judged.clone(),
            device: self.device.device(),
            published: self.as_published.concat(),
        })
    }
}

pub(crate) fn run(args: &ImuArgs) -> Result<()> {
    output::print_report(args.json, &evaluate(args)?, table::table)
}
