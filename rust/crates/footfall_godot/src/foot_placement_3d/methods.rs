//! Methods of the node that scripts call.

use super::FootPlacement3D;
use crate::convert;
use crate::modifier::BodyModifier as _;
use footfall_core::Side;
use footfall_ik::placement::PlacedFoot;
use godot::prelude::*;

#[godot_api(secondary)]
impl FootPlacement3D {
    /// Returns `true` if the foot, `left` or `right`, is locked to the ground.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn is_foot_planted(&self, foot: StringName) -> bool {
        self.foot(&foot).is_some_and(|placed| placed.locked)
    }

    /// Returns the transform of a foot's sole (`left` or `right`) in global space: its origin is on the ground under the ankle of the flat foot,
    /// +Y is the ground's normal and +Z points to the toes. For a swinging foot, it is the ground below it.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn get_foot_transform(&self, foot: StringName) -> Transform3D {
        self.foot(&foot).map_or(Transform3D::IDENTITY, |placed| {
            convert::frame_transform(&placed.sole)
        })
    }

    /// Returns the body that the foot, `left` or `right`, is locked to, or `null`.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn get_foot_support(&self, foot: StringName) -> Option<Gd<Node3D>> {
        let support = self.foot(&foot)?.support?;
        let id = InstanceId::try_from_i64(support.cast_signed())?;
        Gd::try_from_instance_id(id).ok()
    }

    /// Returns the offset of the pelvis from the animation, in metres upwards.
    #[func]
    fn get_pelvis_offset(&self) -> f64 {
        let session = self.session.as_ref();
        session.map_or(0.0, |session| f64::from(session.placer.pelvis_offset_m()))
    }

    /// Returns the grade of the ground under the feet: rise over run, positive uphill.
    #[func]
    fn get_grade(&self) -> f64 {
        let session = self.session.as_ref();
        session.map_or(0.0, |session| f64::from(session.placer.grade()))
    }

    /// Discards the places of the feet, for example after a teleport of the character. Also measures the skeleton again.
    #[func]
    pub(super) fn reset(&mut self) {
        self.forget();
        self.base_mut().update_configuration_warnings();
    }

    /// Returns the problems that keep the feet from being placed, each with what to do next; empty if there are none.
    ///
    /// The editor shows the same texts as configuration warnings.
    #[func]
    fn get_problems(&self) -> PackedStringArray {
        self.problems()
    }
}

impl FootPlacement3D {
    fn foot(&self, foot: &StringName) -> Option<&PlacedFoot> {
        let side = Side::BOTH.into_iter().find(|side| *foot == side.name())?;
        let session = self.session.as_ref()?;
        Some(&session.placer.feet()[side.index()])
    }
}
