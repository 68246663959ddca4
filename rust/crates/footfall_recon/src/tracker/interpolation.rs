//! The most probable segments, and the body that they make together (Mousas 2017, section 5.3).

use super::{Measurement, Tracker};
use crate::body::Course;
use crate::kernels::add;
use footfall_core::Behaviour;
use footfall_model::imu_model::{BODY_COUNT, MAX_PHASES, MAX_WIDTH};

/// Frames with less probability are left out of means.
const LEAST_WEIGHT: f32 = 1e-6;

impl Tracker {
    /// Sums up behaviours, and chooses the segments to interpolate.
    pub(super) fn weigh_segments(&mut self) {
        let prepared = &*self.prepared;
        self.behaviours = [0.0; Behaviour::ALL.len()];
        self.chosen.clear();
        let most = self.config.interpolated.max(1);
        let mut phases = [0.0_f32; MAX_PHASES];
        self.masses.clear();
        for &n in &self.active {
            let phase = usize::from(prepared.model.segments[n as usize].phase);
            let mass: f32 = self.probability[prepared.frames_of(n as usize)]
                .iter()
                .sum();
            self.masses.push(mass);
            phases[phase] += mass;
            let behaviour = prepared.model.phases[phase].behaviour;
            self.behaviours[behaviour.index()] += mass;
        }
        let only = (0..prepared.model.phases.len())
            .max_by(|a, b| phases[*a].total_cmp(&phases[*b]))
            .filter(|_| self.config.one_phase);
        for (&n, &mass) in self.active.iter().zip(&self.masses) {
            let phase = usize::from(prepared.model.segments[n as usize].phase);
            if only.is_some_and(|only| only != phase) {
                continue;
            }
            let full = self.chosen.len() == most;
            if full && self.chosen.last().is_some_and(|(_, least)| *least >= mass) {
                continue;
            }
            if full {
                self.chosen.pop();
            }
            let place = self.chosen.partition_point(|(_, other)| *other >= mass);
            self.chosen.insert(place, (n, mass));
        }
    }

    /// The body of the most probable segments, interpolated (equations 11 and 13), and how it changes from frame to frame.
    ///
    /// `sensor` as given to the last [`step`](Self::step).
    pub fn body(&self, sensor: Option<&Measurement>) -> Course {
        let prepared = &*self.prepared;
        let model = &*prepared.model;
        let mut course = Course::REST;
        let sum: f32 = self.chosen.iter().map(|(_, mass)| mass).sum();
        let norm = 1.0 / sum.max(1e-30);
        let width = model.sensor_width();
        let bodies = prepared.bodies(self.strangeness.share());
        for &(n, mass) in &self.chosen {
            let segment = n as usize;
            let frames = prepared.frames_of(segment);
            for frame in frames.clone() {
                let weight = self.probability[frame] * norm;
                if weight < LEAST_WEIGHT {
                    continue;
                }
                let (begins, ends) = (
                    prepared.begins_chain(frame),
                    prepared.begins_chain(frame + 1),
                );
                for (rows, share) in bodies.iter().filter(|(_, share)| *share > 0.0) {
                    let row = |frame: usize| &rows[frame * BODY_COUNT..(frame + 1) * BODY_COUNT];
                    let weight = weight * share;
                    add(weight, row(frame), &mut course.body);
                    if !begins {
                        add(weight, row(frame), &mut course.arrival);
                        add(-weight, row(frame - 1), &mut course.arrival);
                    }
                    if !ends {
                        add(weight, row(frame + 1), &mut course.velocity);
                        add(-weight, row(frame), &mut course.velocity);
                    }
                }
            }
            let regression = &model.regressions[usize::from(model.segments[segment].phase)];
            if let Some(sensor) = sensor
                && !regression.is_empty()
                && self.config.regression > 0.0
            {
                let mut expected = [0.0_f32; MAX_WIDTH];
                for frame in frames {
                    let row = &model.sensor[frame * width..][..width];
                    add(self.probability[frame] * norm, row, &mut expected);
                }
                let weight = mass * norm;
                for (body, row) in course.body.iter_mut().zip(regression.chunks_exact(width)) {
                    let terms = row.iter().zip(&sensor.values).zip(&expected);
                    let change: f32 = terms.map(|((r, y), e)| r * (weight * y - e)).sum();
                    *body += self.config.regression * change;
                }
            }
        }
        course
    }

    /// Mean of what was measured in the probable frames of the chosen segments: what the sensor should have measured.
    pub(crate) fn expected_sensor(&self, out: &mut [f32]) {
        let width = self.prepared.model.sensor_width();
        out.fill(0.0);
        let sum: f32 = self.chosen.iter().map(|(_, mass)| mass).sum();
        let norm = 1.0 / sum.max(1e-30);
        for &(n, _) in &self.chosen {
            for frame in self.prepared.frames_of(n as usize) {
                let weight = self.probability[frame] * norm;
                if weight > LEAST_WEIGHT {
                    let row = &self.prepared.model.sensor[frame * width..][..width];
                    add(weight, row, out);
                }
            }
        }
    }
}
