//! Feet on real ground, and legs that reach.
//!
//! A [`FootPlacer`] takes poses over a flat floor, from a [`GaitGenerator`](crate::gait::GaitGenerator) or any other animation, and places their feet on a game's [`Terrain`]: its
//! [`Ground`] at a point, on a support with a [`SupportId`] that may move. A [`PlacementConfig`] holds limits, with [`ContactThresholds`] for animations without
//! contacts. A [`PlacementInput`] holds the floor's place in the world as a [`Frame`], and optional knowledge of the animation: contacts, and
//! each foot's next [`Landing`]. A [`PlacedFoot`] is the result for a foot. The [game loop](crate#a-game-loop) uses all of this; the following animation has no contacts:
//!
//! ```
//! use footfall::body::{Pose, Skeleton};
//! use footfall::glam::{Quat, Vec3};
//! use footfall::ground::{
//!     ContactThresholds, FootPlacer, Frame, Ground, Landing, PlacedFoot, PlacementConfig, PlacementInput,
//! };
//!
//! const RISE: f32 = 0.176; // A slope of ten degrees, uphill to +Z.
//! let mut slope = |from: Vec3, way: Vec3| {
//!     let height = RISE * from.z;
//!     let met = (height..=height - way.y).contains(&from.y);
//!     let normal = Vec3::new(0.0, 1.0, -RISE).normalize();
//!     met.then(|| Ground { position: from.with_y(height), normal, support: 0 })
//! };
//!
//! let config = PlacementConfig { contact: ContactThresholds::default(), ..PlacementConfig::default() };
//! let body = Skeleton::standard();
//! let mut placer = FootPlacer::new(&body, &config);
//! let unknown: [Option<Landing>; 2] = [None; 2];
//! let input = PlacementInput {
//!     world_from_floor: Frame { position: Vec3::ZERO, rotation: Quat::IDENTITY },
//!     contacts: None,
//!     landings: unknown,
//!     airborne: false,
//! };
//! let mut pose = Pose::rest(&body);
//! for _ in 0..60 {
//!     pose = Pose::rest(&body); // The next frame of an animation: here, of a standing person.
//!     placer.step(1.0 / 60.0, &input, &mut slope, &mut pose);
//! }
//! let feet: &[PlacedFoot; 2] = placer.feet();
//! for foot in feet {
//!     assert!(foot.locked && foot.sole.up().angle_between(Vec3::Y) > 0.17);
//! }
//! ```
//!
//! A closure is ground on which nothing moves. An implementation of [`Terrain`] also returns the current place of each support.
//!
//! ```
//! use footfall::glam::Vec3;
//! use footfall::ground::{Frame, Ground, SupportId, Terrain};
//!
//! /// A lift as wide as the world.
//! struct Lift {
//!     world_from_lift: Frame,
//! }
//!
//! impl Terrain for Lift {
//!     fn cast(&mut self, from: Vec3, way: Vec3) -> Option<Ground> {
//!         let height = self.world_from_lift.position.y;
//!         let met = (height..=height - way.y).contains(&from.y);
//!         met.then(|| Ground { position: from.with_y(height), normal: Vec3::Y, support: 7 })
//!     }
//!
//!     fn support(&mut self, support: SupportId) -> Option<Frame> {
//!         (support == 7).then_some(self.world_from_lift)
//!     }
//! }
//!
//! let mut lift = Lift { world_from_lift: Frame::IDENTITY };
//! lift.world_from_lift.position.y = 2.0;
//! let ground = lift.cast(Vec3::Y * 2.5, Vec3::NEG_Y).expect("the floor of the lift");
//! assert_eq!(ground.position.y, 2.0);
//! ```
//!
//! A [`Leg`] can be solved alone if the game knows the place of the foot: a [`FootTarget`] holds the ankle and the rotations of foot and toes, a [`LegSolution`] the
//! result for the leg.
//!
//! ```
//! use footfall::body::{Joint, Pose, Side, Skeleton};
//! use footfall::glam::{Quat, Vec3};
//! use footfall::ground::{FootTarget, Leg, LegSolution};
//!
//! let body = Skeleton::standard();
//! let mut pose = Pose::rest(&body);
//! let ankle = Vec3::new(0.1, 0.45, 0.3); // On a chair.
//! let target = FootTarget { ankle, foot: Quat::IDENTITY, toes: Quat::IDENTITY };
//! let hips = pose.root_position;
//! let solution: LegSolution = Leg::new(&body, Side::Left).solve(hips, Quat::IDENTITY, &target, &mut pose);
//! assert!(solution.ankle.distance(ankle) < 1e-3);
//! assert!(pose.rotation(Joint::LeftLowerLeg).angle_between(Quat::IDENTITY) > 1.0);
//! ```
//!
//! A [`RockerFoot`] holds the points of a sole, as the foot stands on a [`Plant`] and rolls over heel, ball and toes.
//!
//! ```
//! use footfall::body::{Side, Skeleton};
//! use footfall::glam::Vec3;
//! use footfall::ground::{Plant, RockerFoot};
//!
//! let foot = RockerFoot::new(&Skeleton::standard(), Side::Left);
//! let plant = Plant { flat_ankle: Vec3::Y * foot.ankle_height(), heading: 0.0 };
//! let [flat, heel_up] = [0.0, 0.4].map(|pitch| foot.stand(&plant, pitch));
//! assert!(heel_up.ankle.y > flat.ankle.y + 0.03);
//! assert!(foot.lowest_point(&heel_up).abs() < 1e-4, "the toes still bear");
//! ```

pub use footfall_ik::placement::{
    ContactThresholds, FootPlacer, Frame, Ground, Landing, PlacedFoot, PlacementConfig,
    PlacementInput, SupportId, Terrain,
};
pub use footfall_ik::{FootTarget, Leg, LegSolution, Plant, RockerFoot};
