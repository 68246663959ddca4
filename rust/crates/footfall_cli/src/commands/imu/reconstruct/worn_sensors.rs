//! Sensors as they are worn, calibrated or found out, and their problems.

use super::{MountingArg, ReconstructArgs, read_calibration};
use crate::output;
use anyhow::{Context as _, Result};
use footfall_core::Site;
use footfall_imu::{ImuRecording, find_rest};
use footfall_model::{CalibratedSensor, SensorCalibration};
use footfall_recon::{Examination, Prepared, ReconConfig, SensorProblem, examine, find_exchange};
use glam::Quat;
use serde::Serialize;
use std::path::Path;
use std::sync::Arc;

/// A mounting that is less certain is warned of.
const CERTAIN: f32 = 0.9;

/// A problem in the report.
#[derive(Serialize)]
pub(super) struct ProblemReport {
    site: &'static str,
    problem: &'static str,
    message: String,
    start_s: f64,
    end_s: f64,
}

/// Sensors of one wearer.
pub(super) struct WornSensors {
    pub(super) calibration: SensorCalibration,
    /// Their recordings in the sites' axes.
    pub(super) recordings: Vec<ImuRecording>,
    pub(super) problems: Vec<ProblemReport>,
}

impl WornSensors {
    /// Takes over a calibration, or finds out how the sensors are worn, and warns of what is wrong.
    pub(super) fn find(
        args: &ReconstructArgs,
        prepared: &Arc<Prepared>,
        recordings: &[ImuRecording],
        config: &ReconConfig,
    ) -> Result<Self> {
        let sites = &prepared.model().sites;
        let known = match &args.calibration {
            Some(path) => {
                let known = read_calibration(path)?;
                let fits = known.check_sites(sites);
                fits.with_context(|| path.display().to_string())?;
                Some(known)
            }
            None => None,
        };
        let mut worn = Self {
            calibration: SensorCalibration {
                sensors: Vec::new(),
                stride: known.as_ref().map_or(config.stride, |known| known.stride),
            },
            recordings: Vec::new(),
            problems: Vec::new(),
        };
        for (n, recording) in recordings.iter().enumerate() {
            let path = &args.recordings[n];
            let known = known.as_ref().map(|known| known.sensors[n].clone());
            let known = known.or_else(|| {
                let aligned = args.mounting == MountingArg::Aligned;
                aligned.then(|| CalibratedSensor::mounted(sites[n], Quat::IDENTITY))
            });
            let (calibrated, finding) = calibrate(prepared, n, recording, known, config)
                .with_context(|| path.display().to_string())?;
            if calibrated.certainty < CERTAIN {
                output::note(&format!(
                    "warning: {}: the mounting is only {:.0} % certain; record more steps, or pass --mounting aligned",
                    path.display(),
                    100.0 * calibrated.certainty
                ));
            }
            let heard = prepared.wear(n, recording, &calibrated, args.rate);
            let times = (recording.start_secs(), recording.duration_secs());
            if let Some(finding) = finding {
                worn.warn(path, sites[n], &finding, times.0, times.0 + times.1);
            }
            for span in heard.problems {
                let (start, end) = (span.start_secs, span.end_secs);
                worn.warn(path, sites[n], &span.problem, start, end);
            }
            worn.recordings.push(heard.recording);
            worn.calibration.sensors.push(calibrated);
        }
        worn.compare(args, prepared, recordings, config);
        Ok(worn)
    }

    /// Warns when two sensors are exchanged.
    fn compare(
        &mut self,
        args: &ReconstructArgs,
        prepared: &Arc<Prepared>,
        recordings: &[ImuRecording],
        config: &ReconConfig,
    ) {
        if let [first, second] = recordings
            && let Ok(Some(problem)) = find_exchange(prepared, [first, second], &config.tracker)
        {
            let end = first.start_secs() + first.duration_secs();
            let site = prepared.model().sites[0];
            self.warn(&args.recordings[0], site, &problem, first.start_secs(), end);
        }
    }

    fn warn(&mut self, path: &Path, site: Site, problem: &SensorProblem, start_s: f64, end_s: f64) {
        output::note(&format!(
            "warning: {}: from {start_s:.1} to {end_s:.1} s: {problem}",
            path.display()
        ));
        self.problems.push(ProblemReport {
            site: site.name(),
            problem: problem.name(),
            message: problem.to_string(),
            start_s,
            end_s,
        });
    }
}

/// Calibration of one sensor, known or found out, and the problem with how it is worn.
fn calibrate(
    prepared: &Arc<Prepared>,
    sensor: usize,
    recording: &ImuRecording,
    known: Option<CalibratedSensor>,
    config: &ReconConfig,
) -> Result<(CalibratedSensor, Option<SensorProblem>)> {
    if let Some(known) = known {
        let believed = Some(known.site_from_sensor);
        // Too little motion to examine what is known is no fault.
        let examined = examine(prepared, sensor, recording, believed, &config.tracker);
        return Ok((known, examined.ok().and_then(|examined| examined.finding)));
    }
    let Examination { mounting, finding } =
        examine(prepared, sensor, recording, None, &config.tracker)?;
    let site = prepared.model().sites[sensor];
    let mut found = CalibratedSensor::mounted(site, mounting.site_from_sensor);
    found.certainty = mounting.certainty;
    if let Some(rest) = find_rest(recording) {
        found = found.resting(rest.rate_bias, rest.force.length());
    }
    Ok((found, finding))
}
