//! A game's character as a body, and poses on its bones.
//!
//! A [`RestRig`] holds the bones in the rest pose: names, parents and transforms, in any units and axes. [`joint_bones`] finds the joints among them. A [`RigBinding`] holds the
//! measurements: the [`Skeleton`](crate::body::Skeleton) for the walker, the conversion from a pose to bone rotations, and the transform from the ground under the body to the object that carries
//! the rig. Rest poses may be A-poses, and bones may be missing.
//!
//! ```
//! use footfall::body::{JOINT_COUNT, Joint, Pose, Skeleton};
//! use footfall::gait::{Controls, GaitGenerator, GeneratorConfig, StyleSpace};
//! use footfall::glam::{Affine3A, Quat, Vec3};
//! use footfall::ground::Frame;
//! use footfall::model::GaitModel;
//! use footfall::rig::{Bones, RestRig, RigBinding, joint_bones};
//! use std::sync::Arc;
//!
//! /// Bones of a character in a game: a transform each, relative to the bone above.
//! struct Character(Vec<Affine3A>);
//!
//! impl Bones for Character {
//!     fn transform(&self, bone: usize) -> Affine3A {
//!         self.0[bone]
//!     }
//!     fn set_rotation(&mut self, bone: usize, rotation: Quat) {
//!         self.0[bone] = Affine3A::from_rotation_translation(rotation, self.position(bone));
//!     }
//!     fn set_position(&mut self, bone: usize, position: Vec3) {
//!         self.0[bone].translation = position.into();
//!     }
//! }
//!
//! // A character of a game: here the joints themselves, in centimetres.
//! let standard = Skeleton::standard();
//! let bones = Joint::ALL.map(|joint| {
//!     let rest = Affine3A::from_translation(100.0 * standard.offset(joint));
//!     (joint.name().to_owned(), joint.parent().map(Joint::index), rest)
//! });
//! let mut character = Character(bones.iter().map(|(.., rest)| *rest).collect());
//! let rig = RestRig::new(bones);
//!
//! let metres = Affine3A::from_scale(Vec3::splat(0.01));
//! let mapped = [None; JOINT_COUNT]; // Nothing is mapped by hand.
//! let bones = joint_bones(rig.rig(), &mapped)?;
//! let mut binding = RigBinding::new(&rig, &bones, &metres)?;
//! assert!((binding.body.offset(Joint::Hips).y - standard.offset(Joint::Hips).y).abs() < 1e-3);
//!
//! // A walker with the character's proportions, and the frames of a game.
//! # std::env::set_current_dir("../../..")?;
//! let bytes = std::fs::read("addons/footfall/models/locomotion.footfall")?;
//! let styles = Arc::new(StyleSpace::new(&Arc::new(GaitModel::from_bytes(&bytes)?), &[])?);
//! let config = GeneratorConfig { seed: 1, phase: 0.0, variation: 1.0 };
//! let mut walker = GaitGenerator::new(&styles, &[], &binding.body, &config)?;
//! let controls = Controls { speed_mps: 1.3, ..Controls::STAND };
//! let mut pose = Pose::rest(&binding.body);
//! let mut place = Frame::IDENTITY;
//! for _ in 0..120 {
//!     walker.step(1.0 / 60.0, &controls, &mut pose);
//!     // The object that carries the rig goes here, wherever the rig stands in it and faces.
//!     place = binding.world_from_character(&Frame::from(walker.start_from_character()));
//!     binding.write(&mut character, &pose);
//! }
//! assert!((1.5..3.0).contains(&place.position.z), "{place:?}");
//!
//! // The other way: the pose that the bones have, from whatever animation.
//! let mut seen = Pose::default();
//! binding.read(&character, &mut seen);
//! let leg = Joint::LeftUpperLeg;
//! assert!(seen.rotation(leg).angle_between(pose.rotation(leg)) < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`RigBinding::write_layered`] leaves arms, spine or head to other animation by [`LayerWeights`]. [`BindingError`] names a wrong bone, [`MissingJoints`] the joints that a rig
//! lacks: fill in [`MappedBones`] by hand then. [`relative_size`] returns the scale of a character since it was measured.
//!
//! ```
//! use footfall::glam::{Affine3A, Vec3};
//! use footfall::rig::relative_size;
//!
//! let measured = Affine3A::from_translation(Vec3::Y);
//! let now = Affine3A::from_scale(Vec3::splat(1.5)) * measured;
//! assert!(relative_size(&measured, &now).is_some_and(|size| (size - 1.5).abs() < 1e-5));
//! ```

pub use footfall_rig::{
    BindingError, Bones, LayerWeights, MappedBones, MissingJoints, RestRig, RigBinding,
    joint_bones, relative_size,
};
