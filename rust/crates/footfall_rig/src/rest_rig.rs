//! Bones of a character in the rest pose.

use footfall_core::Rig;
use glam::Affine3A;

/// Bones of a character: names, parents, and rest poses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RestRig {
    rig: Rig,
    /// Rest pose of each bone in the space of the rig.
    rests: Vec<Affine3A>,
    /// The same, relative to the parent bone.
    own_rests: Vec<Affine3A>,
}

impl RestRig {
    /// Creates a rig from bones in any order: name, parent, and rest pose relative to the parent. A parent that does not exist, or would close a
    /// cycle, counts as none.
    pub fn new(bones: impl IntoIterator<Item = (String, Option<usize>, Affine3A)>) -> Self {
        let (named, own_rests): (Vec<_>, Vec<_>) = bones
            .into_iter()
            .map(|(name, parent, rest)| ((name, parent), rest))
            .unzip();
        let rig = Rig::new(named);
        let mut rests: Vec<Option<Affine3A>> = vec![None; own_rests.len()];
        for bone in 0..rig.len() {
            let mut chain = vec![bone];
            chain.extend(rig.above(bone).take_while(|above| rests[*above].is_none()));
            for bone in chain.into_iter().rev() {
                let own = own_rests[bone];
                let above = rig.parent(bone).and_then(|above| rests[above]);
                rests[bone] = Some(above.map_or(own, |above| above * own));
            }
        }
        Self {
            rig,
            rests: rests.into_iter().flatten().collect(),
            own_rests,
        }
    }

    /// Returns the names and parents of the bones.
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// Returns the rest pose of a bone in the space of the rig.
    pub fn rest(&self, bone: usize) -> Affine3A {
        self.rests.get(bone).copied().unwrap_or_default()
    }

    /// Returns the rest pose of a bone relative to its parent.
    pub fn own_rest(&self, bone: usize) -> Affine3A {
        self.own_rests.get(bone).copied().unwrap_or_default()
    }

    /// Returns the first child of a bone.
    pub(crate) fn first_below(&self, bone: usize) -> Option<usize> {
        (0..self.rig.len()).find(|below| self.rig.parent(*below) == Some(bone))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::FRAC_PI_2;
    use glam::{Quat, Vec3};

    fn placed(turn: f32, place: Vec3) -> Affine3A {
        Affine3A::from_rotation_translation(Quat::from_rotation_y(turn), place)
    }

    #[test]
    fn rest_poses_add_up_in_any_order_of_bones() {
        let bone = |name: &str, parent: Option<usize>, rest: Affine3A| (name.into(), parent, rest);
        let rig = RestRig::new([
            bone("hand", Some(2), placed(0.0, Vec3::X)),
            bone("root", None, placed(FRAC_PI_2, Vec3::Y)),
            bone("arm", Some(1), placed(FRAC_PI_2, Vec3::Z)),
        ]);
        // +Z of the root points along +X; after the second quarter turn +X points along -X.
        let hand = Vec3::from(rig.rest(0).translation);
        assert!(hand.distance(Vec3::Y) < 1e-6, "{hand}");
        let arm = Vec3::from(rig.rest(2).translation);
        assert!(arm.distance(Vec3::new(1.0, 1.0, 0.0)) < 1e-6, "{arm}");
        assert_eq!(rig.own_rest(0), placed(0.0, Vec3::X));
        assert_eq!(rig.first_below(2), Some(0));
        assert_eq!(rig.first_below(0), None);
    }

    #[test]
    fn a_circle_of_bones_is_cut() {
        let bone = |parent: usize| ("bone".to_owned(), Some(parent), placed(0.0, Vec3::Y));
        let rig = RestRig::new([bone(1), bone(0)]);
        let places = [0, 1].map(|bone| Vec3::from(rig.rest(bone).translation));
        assert_eq!(places, [Vec3::Y, 2.0 * Vec3::Y]);
    }
}
