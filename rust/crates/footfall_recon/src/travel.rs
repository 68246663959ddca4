//! Steps as long as the wearer's: a foot sensor measures its strides, and the body's are lengthened or shortened to match.
//!
//! For every stride, the measured travel of the foot is compared with the shown travel; the factor on the recordings'
//! steps follows the quotient. Standing feet stay in place: [`ground`](crate::ground) swings the legs further and does not slide the body.

use crate::half_life::follow_share;
use footfall_core::{Side, Site};
use footfall_imu::stride_meter::Rest;
use footfall_imu::{ImuSample, StrideMeter};
use glam::Vec3;

/// Shortest stride from which the length of steps is estimated, metres.
const LEAST_STRIDE_M: f32 = 0.4;

/// A stride of which the shown one differs by more is another one.
const MOST_APART: f32 = 1.8;

/// Share of the quotient of a stride that the factor follows, on a logarithmic scale.
const FOLLOWED: f32 = 0.4;

/// Bounds of the factor.
const FACTORS: [f32; 2] = [0.7, 1.4];

/// Half-life with which what is shown follows the factor, seconds: legs do not jump.
const HALF_LIFE_SECS: f32 = 0.15;

/// Length of the wearer's steps beside those of the recordings.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Travel {
    /// The sensor that sits on a foot, and the foot.
    foot: Option<(usize, Side)>,
    meter: StrideMeter,
    /// A rest that was measured and not yet compared.
    rested: Option<Rest>,
    /// Place at which the foot was shown at the rest before.
    anchor: Option<Vec3>,
    factor: f32,
    shown: f32,
}

impl Travel {
    /// Creates it for sensors at these sites, on a wearer with this expected step length relative to the recordings.
    pub(crate) fn new(sites: &[Site], stride: f32) -> Self {
        let mut feet = sites.iter().enumerate();
        let mut travel = Self {
            foot: feet.find_map(|(n, site)| Some((n, site.side().filter(|_| site.is_foot())?))),
            meter: StrideMeter::default(),
            rested: None,
            anchor: None,
            factor: 1.0,
            shown: 1.0,
        };
        travel.set_stride(stride);
        travel
    }

    /// Forgets the samples, and keeps how long the wearer's steps are.
    pub(crate) fn forget_samples(&mut self) {
        self.meter = StrideMeter::default();
        (self.rested, self.anchor) = (None, None);
    }

    /// Length of the wearer's steps beside those of the recordings, as far as it is known.
    pub(crate) const fn stride(&self) -> f32 {
        self.factor
    }

    /// Sets it: from an earlier session, or where no foot measures strides.
    pub(crate) const fn set_stride(&mut self, factor: f32) {
        self.factor = factor.clamp(FACTORS[0], FACTORS[1]);
        self.shown = self.factor;
    }

    /// The foot that wears a sensor.
    pub(crate) const fn side(&self) -> Option<Side> {
        match self.foot {
            Some((_, side)) => Some(side),
            None => None,
        }
    }

    /// Number of the sensor that measures strides.
    pub(crate) const fn sensor(&self) -> Option<usize> {
        match self.foot {
            Some((sensor, _)) => Some(sensor),
            None => None,
        }
    }

    /// Takes a sample of a sensor.
    pub(crate) fn push(&mut self, sensor: usize, sample: ImuSample) {
        if self.sensor() == Some(sensor)
            && let Some(rest) = self.meter.push(sample)
        {
            self.rested = Some(rest);
        }
    }

    /// Goes on in time; the factor on the recordings' steps from now on.
    pub(crate) fn step(&mut self, dt_secs: f32) -> f32 {
        self.shown += follow_share(HALF_LIFE_SECS, dt_secs) * (self.factor - self.shown);
        self.shown
    }

    /// Compares a stride that was measured with the way of the foot that was shown. `scale` is metres of the shown body for one of the model's.
    pub(crate) fn compare(&mut self, ankle: Vec3, scale: f32) {
        let Some(rest) = self.rested.take() else {
            return;
        };
        let before = self.anchor.replace(ankle);
        let (Some(stride), Some(before)) = (rest.stride, before) else {
            return;
        };
        let measured = stride.length_m as f32;
        let shown = (ankle - before).with_y(0.0).length() / scale;
        if measured < LEAST_STRIDE_M {
            return;
        }
        if (measured / MOST_APART..measured * MOST_APART).contains(&shown) {
            let factor = self.factor * (measured / shown).powf(FOLLOWED);
            self.factor = factor.clamp(FACTORS[0], FACTORS[1]);
        }
    }
}
