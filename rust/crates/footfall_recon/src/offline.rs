//! Reconstruction of a whole recording: later samples improve earlier frames.

use crate::blend::{Blend, Blending};
use crate::body::BodyFrame;
use crate::confidence::Confidence;
use crate::ground::{Ground, GroundInput};
use crate::measure::{SensorFrame, SensorFrames, measure, sensor_heading};
use crate::prepared::{Prepared, WornFoot};
use crate::reconstructor::ReconConfig;
use crate::sensor::Frames;
use crate::shown_behaviour::{LEAST_SHOWN_SECS, ShownBehaviour, drop_short_runs};
use crate::stride_phase::StrideClock;
use crate::tracker::{Measurement, Tracker};
use crate::travel::Travel;
use footfall_core::{Behaviour, Clip, Pose, Skeleton, SkeletonError};
use footfall_imu::events::{Swing, detect_swings};
use footfall_imu::{ImuRecording, ImuSample, SensorContact};
use footfall_model::imu_model::MAX_SENSORS;
use std::sync::Arc;

/// Frames that are looked back from at once; as many more are looked ahead at.
const BLOCK_FRAMES: usize = 64;

/// A body reconstructed from a recording.
#[derive(Clone, Debug)]
pub struct Reconstructed {
    /// The motion at the model's rate.
    pub clip: Clip,
    /// Time of the first frame on the recording's clock, seconds.
    pub start_secs: f64,
    /// The most probable behaviour of each frame.
    pub behaviours: Vec<Behaviour>,
    /// Confidence in the model at each frame and those shortly before it, 0 to 1.
    pub confidences: Vec<f32>,
    /// Length of the wearer's steps relative to the people in the model, as known at the end.
    pub stride: f32,
}

/// Reconstructs the body of recordings, one for each site of the model, already in the sites' axes.
///
/// With `live`, each frame is what a [`Reconstructor`](crate::Reconstructor) shows when it is measured; otherwise the two to four seconds
/// after it are used as well (forward-backward).
///
/// # Errors
/// [`SkeletonError`] names a leg or foot without length.
pub fn reconstruct_recording(
    prepared: &Arc<Prepared>,
    recordings: &[ImuRecording],
    skeleton: &Skeleton,
    config: &ReconConfig,
    live: bool,
) -> Result<Reconstructed, SkeletonError> {
    skeleton.check()?;
    let mut frames = frames_of(prepared, recordings);
    if !live {
        tell_swings(prepared, recordings, &mut frames);
    }
    let rate = prepared.model.frame_rate_hz;
    let travel = Travel::new(&prepared.model.sites, config.stride);
    let strides = travel.sensor().and_then(|n| recordings.get(n));
    let mut shown = Shown {
        samples: strides.map_or(&[][..], |recording| &recording.samples),
        travel,
        prepared,
        confidence: Confidence::new(config.stands_unexplained),
        live: live.then_some((ShownBehaviour::new(), config.behaviour_probability)),
        out: Reconstructed {
            clip: Clip {
                skeleton: skeleton.clone(),
                frame_rate_hz: rate,
                poses: Vec::with_capacity(frames.len()),
            },
            start_secs: shared_start_secs(recordings)
                .unwrap_or_else(|| recordings.first().map_or(0.0, ImuRecording::start_secs)),
            behaviours: Vec::with_capacity(frames.len()),
            confidences: Vec::with_capacity(frames.len()),
            stride: config.stride,
        },
        // With later frames the result is smooth already.
        blend: Blend::new(
            if live { config.blending } else { Blending::Off },
            rate as f32,
        ),
        ground: Ground::new(skeleton, &prepared.model.skeleton),
        frame_secs: 1.0 / rate as f32,
    };
    let measured = frames.iter().map(|frames| measure(&prepared.model, frames));
    let mut measured: Vec<Option<Measurement>> = measured.collect();
    let mut tracker = Tracker::new(prepared, config.tracker);
    if live {
        let mut clock = StrideClock::new(prepared);
        let mut losses = losses_of_sight(recordings).peekable();
        for (frame, measured) in frames.iter().zip(&mut measured) {
            let ends = frame.iter().flatten().map(|heard| heard.frame.time_secs);
            let end_secs = ends.fold(f64::MIN, f64::max);
            while losses.next_if(|loss| *loss <= end_secs).is_some() {
                tracker.stand();
            }
            let stride = clock.step(frame);
            if let Some(measured) = measured {
                measured.stride = stride;
            }
            tracker.step_striding(measured.as_mut(), shown.confidence);
            shown.add(&tracker, measured.as_ref(), frame, tracker.log_density());
        }
        return Ok(shown.done());
    }
    // Later frames locate the other leg in its stride better than the time since a landing does.
    let mut back = Tracker::new(prepared, config.tracker);
    let mut filtered: Vec<Vec<f32>> = Vec::new();
    let mut log_densities = Vec::with_capacity(frames.len());
    let mut later = vec![1.0_f32; prepared.frames];
    for first in (0..frames.len()).step_by(BLOCK_FRAMES) {
        let end = (first + BLOCK_FRAMES).min(frames.len());
        let ahead = (end + BLOCK_FRAMES).min(frames.len());
        for measured in &measured[first + filtered.len()..ahead] {
            tracker.step(measured.as_ref());
            filtered.push(tracker.probabilities().to_vec());
            log_densities.push(tracker.log_density());
        }
        later.fill(1.0);
        for frame in (first..ahead).rev() {
            if frame < end {
                weigh(&mut filtered[frame - first], &later);
            }
            if frame > first {
                back.step_back(measured[frame].as_ref(), &mut later);
            }
        }
        back.take_strangeness(&tracker);
        for frame in first..end {
            back.set_probabilities(&filtered[frame - first]);
            let log_density = log_densities[frame];
            shown.add(&back, measured[frame].as_ref(), &frames[frame], log_density);
        }
        filtered.drain(..end - first);
    }
    let least = (f64::from(LEAST_SHOWN_SECS) * rate).ceil() as usize;
    drop_short_runs(&mut shown.out.behaviours, least);
    Ok(shown.done())
}

/// Multiplies probabilities with what came later, and brings their sum to one.
fn weigh(probabilities: &mut [f32], later: &[f32]) {
    let sum: f64 = probabilities
        .iter()
        .zip(later)
        .map(|(p, l)| f64::from(*p) * f64::from(*l))
        .sum();
    if sum < 1e-30 {
        return;
    }
    let norm = 1.0 / sum;
    for (probability, later) in probabilities.iter_mut().zip(later) {
        *probability = (f64::from(*probability) * f64::from(*later) * norm) as f32;
    }
}

/// When the first of some recordings begins, on the clock that they share; `None` when they do not overlap, so that each must have its own.
fn shared_start_secs(recordings: &[ImuRecording]) -> Option<f64> {
    let starts = recordings.iter().map(ImuRecording::start_secs);
    let ends = recordings
        .iter()
        .map(|recording| recording.start_secs() + recording.duration_secs());
    let overlap = starts.clone().fold(f64::MIN, f64::max) < ends.fold(f64::MAX, f64::min);
    overlap.then(|| starts.fold(f64::MAX, f64::min))
}

/// Frames of all sensors, side by side: by their times on a clock that they share, else from their first ones on.
fn frames_of(prepared: &Prepared, recordings: &[ImuRecording]) -> Vec<SensorFrames> {
    let rate_hz = prepared.model.frame_rate_hz;
    let start_secs = shared_start_secs(recordings);
    let sensors: Vec<(usize, Vec<SensorFrame>)> = recordings
        .iter()
        .zip(&prepared.model.sites)
        .map(|(recording, site)| {
            let later_secs = start_secs.map_or(0.0, |start| recording.start_secs() - start);
            let later = (later_secs * rate_hz).round() as usize;
            (later, Frames::of(recording, rate_hz, site.is_foot()))
        })
        .collect();
    let ends = sensors.iter().map(|(later, frames)| later + frames.len());
    (0..ends.max().unwrap_or(0))
        .map(|frame| {
            core::array::from_fn(|n| {
                let (later, frames) = sensors.get(n)?;
                frames.get(frame.checked_sub(*later)?).copied()
            })
        })
        .collect()
}

/// Times at which the samples of the only sensor become unusable.
fn losses_of_sight(recordings: &[ImuRecording]) -> impl Iterator<Item = f64> {
    let samples = recordings.iter().flat_map(|recording| &recording.samples);
    let mut was_lost = false;
    samples.filter_map(move |sample| {
        let is_lost = sample.is_stand_in();
        let begins = is_lost && !was_lost;
        was_lost = is_lost;
        begins.then_some(sample.time_secs)
    })
}

/// Sets the contacts of feet with sensors from their recordings as wholes.
fn tell_swings(prepared: &Prepared, recordings: &[ImuRecording], frames: &mut [SensorFrames]) {
    for WornFoot { sensor, .. } in &prepared.worn_feet {
        let Some(recording) = recordings.get(*sensor) else {
            continue;
        };
        let swings = detect_swings(recording);
        let heard = frames.iter_mut().filter_map(|f| f[*sensor].as_mut());
        for heard in heard {
            let time_secs = heard.frame.time_secs;
            heard.contact = Some(contact_at(&swings, time_secs));
        }
    }
}

/// Contact of a foot with these swings, in order.
fn contact_at(swings: &[Swing], time_secs: f64) -> SensorContact {
    let begun = swings.partition_point(|swing| swing.terminal_secs <= time_secs);
    let last = begun.checked_sub(1).map(|n| swings[n]);
    let swings = last.filter(|swing| time_secs < swing.initial_secs);
    let since = swings.map(|swing| swing.terminal_secs);
    let since = since.or(last.map(|swing| swing.initial_secs));
    SensorContact {
        stands: swings.is_none(),
        for_secs: since.map_or(f32::INFINITY, |since| (time_secs - since) as f32),
    }
}

/// Writer of the frames that are shown.
struct Shown<'a> {
    /// Swings of the sensor that measures strides that were not used yet.
    samples: &'a [ImuSample],
    travel: Travel,
    prepared: &'a Prepared,
    confidence: Confidence,
    /// The behaviour that a game shows, and how probable it must be.
    live: Option<(ShownBehaviour, f32)>,
    out: Reconstructed,
    blend: Blend,
    ground: Ground,
    frame_secs: f32,
}

impl Shown<'_> {
    fn done(mut self) -> Reconstructed {
        self.out.stride = self.travel.stride();
        self.out
    }

    fn add(
        &mut self,
        tracker: &Tracker,
        measured: Option<&Measurement>,
        frames: &SensorFrames,
        log_density: f64,
    ) {
        if measured.is_some() {
            self.confidence.step(log_density as f32, self.frame_secs);
        }
        let mut course = tracker.body(measured);
        let standing = self.prepared.standing.as_ref();
        self.confidence.calm(standing, &mut course);
        self.blend.step(&course);
        if self.out.clip.poses.is_empty() {
            // A frame ends when it is measured; the recording begins one frame earlier.
            self.pose(
                &self.blend.body_after(-1.0),
                tracker,
                [None; MAX_SENSORS],
                0.0,
            );
        }
        self.pose(&self.blend.body_after(0.0), tracker, *frames, 1.0);
    }

    fn pose(&mut self, body: &BodyFrame, tracker: &Tracker, sensors: SensorFrames, frames: f32) {
        self.hear(&sensors);
        let heading = sensor_heading(&sensors, body).filter(|_| self.confidence.is_trusted());
        if !self.confidence.is_trusted() {
            self.ground.forget_sensor_heading();
        }
        let input = GroundInput {
            heading,
            frames,
            dt_secs: self.frame_secs,
            stride: self.travel.step(self.frame_secs),
            contacts: self.sensor_contacts(&sensors),
        };
        let mut pose = Pose::default();
        self.ground.step(body, &input, &mut pose);
        self.out.clip.poses.push(pose);
        self.out.confidences.push(self.confidence.value());
        if let Some(side) = self.travel.side() {
            self.travel
                .compare(self.ground.shown_ankle(side), self.ground.scale());
        }
        let behaviours = &self.confidence.behaviours(tracker.behaviours());
        let shown = match &mut self.live {
            Some((shown, needed)) => shown.step(behaviours, *needed, self.frame_secs),
            None => Behaviour::ALL
                .into_iter()
                .max_by(|a, b| behaviours[a.index()].total_cmp(&behaviours[b.index()]))
                .unwrap_or(Behaviour::Stand),
        };
        self.out.behaviours.push(shown);
    }

    /// Contacts of the feet, as far as sensors on them report them.
    fn sensor_contacts(&self, sensors: &SensorFrames) -> [Option<SensorContact>; 2] {
        let heard = self.confidence.is_trusted();
        let contact_of = |sensor: usize| sensors[sensor]?.contact.filter(|_| heard);
        self.prepared.sensor_contacts(contact_of)
    }

    /// Measures strides up to the end of a frame.
    fn hear(&mut self, sensors: &SensorFrames) {
        let sensor = self.travel.sensor();
        if let Some((sensor, frame)) = sensor.and_then(|n| Some((n, sensors[n]?.frame))) {
            let heard = self
                .samples
                .partition_point(|sample| sample.time_secs <= frame.time_secs);
            let (now, later) = self.samples.split_at(heard);
            for sample in now {
                self.travel.push(sensor, *sample);
            }
            self.samples = later;
        }
    }
}
