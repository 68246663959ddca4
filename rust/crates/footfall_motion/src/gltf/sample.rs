//! One animation of a glTF file, posed at any time.

use glam::{Affine3A, Quat, Vec3};
use gltf::animation::util::ReadOutputs;
use gltf::animation::{Channel, Interpolation};

/// A node's own transform in parts, as animations change it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local {
    pub(super) place: Vec3,
    pub(super) turn: Quat,
    pub(super) scale: Vec3,
}

impl Local {
    pub(super) fn of(node: &gltf::Node<'_>) -> Self {
        let (place, turn, scale) = node.transform().decomposed();
        Self {
            place: place.into(),
            turn: Quat::from_array(turn).normalize(),
            scale: scale.into(),
        }
    }

    pub(super) fn affine(&self) -> Affine3A {
        Affine3A::from_scale_rotation_translation(self.scale, self.turn, self.place)
    }
}

/// One property of one node over time.
pub(super) struct Track {
    pub(super) node: usize,
    pub(super) times: Vec<f32>,
    values: Values,
    interpolation: Interpolation,
}

enum Values {
    Places(Vec<Vec3>),
    Turns(Vec<Quat>),
    Scales(Vec<Vec3>),
}

impl Track {
    /// Reads a channel; `None` for weights of morph targets and for channels without keys.
    pub(super) fn read(channel: &Channel<'_>, buffers: &[Vec<u8>]) -> Option<Self> {
        let reader = channel.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
        let times: Vec<f32> = reader.read_inputs()?.collect();
        let values = match reader.read_outputs()? {
            ReadOutputs::Translations(places) => Values::Places(places.map(Vec3::from).collect()),
            ReadOutputs::Rotations(turns) => {
                Values::Turns(turns.into_f32().map(Quat::from_array).collect())
            }
            ReadOutputs::Scales(scales) => Values::Scales(scales.map(Vec3::from).collect()),
            ReadOutputs::MorphTargetWeights(_) => return None,
        };
        let interpolation = channel.sampler().interpolation();
        let keys = match &values {
            Values::Places(list) | Values::Scales(list) => list.len(),
            Values::Turns(list) => list.len(),
        };
        let each = match interpolation {
            Interpolation::CubicSpline => 3,
            _ => 1,
        };
        let is_whole = !times.is_empty() && keys == each * times.len();
        is_whole.then_some(Self {
            node: channel.target().node().index(),
            times,
            values,
            interpolation,
        })
    }

    /// Returns true when it turns the node.
    pub(super) const fn is_rotation(&self) -> bool {
        matches!(self.values, Values::Turns(_))
    }

    /// Puts the property's value at a time into a node's transform.
    pub(super) fn pose(&self, time: f32, local: &mut Local) {
        let key = self.times.partition_point(|&at| at <= time).max(1) - 1;
        let next = (key + 1).min(self.times.len() - 1);
        let span = self.times[next] - self.times[key];
        let share = if span > 0.0 {
            ((time - self.times[key]) / span).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let at = Moment {
            key,
            next,
            share,
            span,
            interpolation: self.interpolation,
        };
        match &self.values {
            Values::Places(places) => local.place = at.value(places, Vec3::lerp),
            Values::Scales(scales) => local.scale = at.value(scales, Vec3::lerp),
            Values::Turns(turns) => local.turn = at.value(turns, Quat::slerp).normalize(),
        }
    }
}

/// A time between keys.
struct Moment {
    key: usize,
    next: usize,
    share: f32,
    span: f32,
    interpolation: Interpolation,
}

impl Moment {
    fn value<T>(&self, values: &[T], between: impl Fn(T, T, f32) -> T) -> T
    where
        T: Copy + core::ops::Mul<f32, Output = T> + core::ops::Add<Output = T>,
    {
        match self.interpolation {
            Interpolation::Step => values[self.key],
            Interpolation::Linear => between(values[self.key], values[self.next], self.share),
            // Every key is a tangent in, a value and a tangent out.
            Interpolation::CubicSpline => {
                let (t, tt, ttt) = (self.share, self.share.powi(2), self.share.powi(3));
                values[3 * self.key + 1] * (2.0 * ttt - 3.0 * tt + 1.0)
                    + values[3 * self.key + 2] * (self.span * (ttt - 2.0 * tt + t))
                    + values[3 * self.next + 1] * (3.0 * tt - 2.0 * ttt)
                    + values[3 * self.next] * (self.span * (ttt - tt))
            }
        }
    }
}
