//! `footfall evaluate`: the papers' tables on the user's own data.

mod contacts;
mod dynamics;
mod imu;
mod judged;
mod naturalness;
mod orientation;
mod response;
mod standing;
mod style;
mod style_report;
mod training;

use anyhow::{Context as _, Result};
use clap::{Parser, Subcommand};
use footfall_studio::{EvaluateKind, EvaluateRequest};
use serde::Serialize;
use serde_json::Value;
use std::ffi::OsString;

/// Judge walks by measures: the papers' tables on your own data
#[derive(Debug, clap::Args)]
pub(crate) struct EvaluateArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    Contacts(contacts::ContactsArgs),
    Dynamics(dynamics::DynamicsArgs),
    Imu(imu::ImuArgs),
    Naturalness(naturalness::NaturalnessArgs),
    Orientation(orientation::OrientationArgs),
    Response(response::ResponseArgs),
    Standing(standing::StandingArgs),
    Style(style::StyleArgs),
    Training(training::TrainingArgs),
}

pub(crate) fn run(args: &EvaluateArgs) -> Result<()> {
    match &args.what {
        What::Contacts(args) => contacts::run(args),
        What::Dynamics(args) => dynamics::run(args),
        What::Imu(args) => imu::run(args),
        What::Naturalness(args) => naturalness::run(args),
        What::Orientation(args) => orientation::run(args),
        What::Response(args) => response::run(args),
        What::Standing(args) => standing::run(args),
        What::Style(args) => style::run(args),
        What::Training(args) => training::run(args),
    }
}

/// The arguments of `footfall evaluate` alone.
#[derive(Parser)]
struct Alone {
    #[command(subcommand)]
    what: What,
}

/// The report of a command that the studio asks for, as `--json` prints it.
pub(crate) fn report(request: &EvaluateRequest) -> Result<Value> {
    let mut words: Vec<OsString> = vec!["evaluate".into(), request.kind.command().into()];
    let index = match request.kind {
        EvaluateKind::Style => "--real",
        _ => "--corpus",
    };
    words.extend([index.into(), request.index.clone().into()]);
    let conditions = || {
        let conditions = request.conditions.iter();
        conditions.flat_map(|condition| [OsString::from("--where"), condition.into()])
    };
    words.extend(conditions());
    if let (EvaluateKind::Style, Some(made)) = (request.kind, &request.synthesised) {
        words.extend(["--synthesised".into(), made.clone().into()]);
    }
    match Alone::try_parse_from(words)?.what {
        What::Contacts(args) => value(&contacts::evaluate(&args)?),
        What::Dynamics(args) => value(&dynamics::evaluate(&args)?),
        What::Imu(args) => value(&imu::evaluate(&args)?),
        What::Naturalness(args) => value(&naturalness::evaluate(&args)?),
        What::Orientation(args) => value(&orientation::evaluate(&args)?),
        What::Response(args) => value(&response::evaluate(&args)?),
        What::Standing(args) => value(&standing::evaluate(&args)?),
        What::Style(args) => value(&style::evaluate(&args)?),
        What::Training(args) => value(&training::evaluate(&args)?),
    }
}

fn value(report: &impl Serialize) -> Result<Value> {
    serde_json::to_value(report).context("the result does not fit JSON")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn request(kind: EvaluateKind, conditions: &[&str]) -> EvaluateRequest {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../tests/data");
        EvaluateRequest {
            kind,
            index: data.join("index.csv"),
            conditions: conditions.iter().map(ToString::to_string).collect(),
            synthesised: None,
        }
    }

    #[test]
    fn the_studio_gets_what_the_command_prints() {
        let value = report(&request(EvaluateKind::Contacts, &["subject=walker_1"])).unwrap();
        let categories = value["categories"].as_object().unwrap();
        let (_, agreement) = categories.iter().next().unwrap();
        assert_eq!(agreement["recordings"], 2, "{value}");
        assert!(agreement["f1"].as_f64().unwrap() > 0.9, "{value}");
    }

    #[test]
    fn a_condition_that_nothing_meets_is_one_line_with_what_there_is() {
        let error = report(&request(EvaluateKind::Dynamics, &["subject=nobody"])).unwrap_err();
        let said = format!("{error:#}");
        assert!(
            said.contains("nobody") && said.contains("walker_1"),
            "{said}"
        );
    }
}
