//! Feet on real ground: any animation of a walk over a flat floor, adapted to slopes, stairs and moving platforms.
//!
//! The animation moves over its own flat floor. [`FootPlacer`] looks for the ground under each foot, locks a foot that stands to it,
//! carries a swinging foot from one foothold to the next, moves the pelvis so that both legs reach, and solves the legs. Whatever
//! supports a foot may move: its foothold moves along.
//!
//! Modules in suggested reading order: `config`, `frame`, `terrain`, `correction`, `lie`, `foothold`, `profile`, `aim`, `landings`,
//! `contact`, `foot`, `wall`, `guard`, `way`, `swing`, `pelvis`, `arrival`, `carry`.

mod aim;
mod arrival;
mod carry;
mod config;
mod contact;
mod correction;
mod effort;
mod foot;
mod foothold;
mod frame;
mod guard;
mod landings;
mod lie;
mod pelvis;
mod profile;
mod swing;
mod terrain;
mod wall;
mod way;

use crate::leg::{FootTarget, Leg};
use crate::rocker::{RockerFoot, foot_attitude, settled_pitch};
use carry::Moment;
pub use config::{PlacementConfig, PlacementInput};
pub use contact::ContactThresholds;
use foot::{Animated, Foot, MAX_PITCH, Mode};
use footfall_core::rotation::from_heading;
use footfall_core::{Joint, Pose, Side, Skeleton};
pub use frame::Frame;
use glam::{Quat, Vec3};
pub use landings::Landing;
use pelvis::Ride;
pub use terrain::{Ground, SupportId, Terrain};

/// Motion of a character in a frame beyond which it was teleported, metres.
const TELEPORT_M: f32 = 1.0;

/// State of a foot after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedFoot {
    /// True when it is locked to the ground.
    pub locked: bool,
    /// `world_from_sole`: the ground under the ankle of the flat foot, +Y the ground's normal, +Z to the toes. For a swinging
    /// foot, the ground below it.
    pub sole: Frame,
    /// Support that it is locked to.
    pub support: Option<SupportId>,
    /// True if it was locked in this frame.
    pub landed: bool,
    /// True if it was released in this frame.
    pub left: bool,
}

/// Places the feet of one character. Does not allocate after its creation.
#[derive(Clone, Debug)]
pub struct FootPlacer {
    config: PlacementConfig,
    hips_from_hip: [Vec3; 2],
    leg_lengths: [f32; 2],
    legs: [Leg; 2],
    rockers: [RockerFoot; 2],
    /// Heights of the ankles of standing feet with their heels as high as they go.
    highest_ankles_m: [f32; 2],
    feet: [Foot; 2],
    placed: [PlacedFoot; 2],
    /// Height in the world of the ground under the pelvis.
    pelvis: Ride,
    ground_m: f32,
    grade: f32,
    /// Grade of the ground to which the step under way leads, and the foot that takes it.
    grade_ahead: f32,
    aimed: Option<usize>,
    /// Sole that stood last, in the world.
    stood_at: Option<Vec3>,
    memory: Option<Memory>,
}

/// Places in the frame before.
#[derive(Clone, Copy, Debug)]
struct Memory {
    world_from_floor: Frame,
    /// The soles' points of the animation, in the world.
    points: [[Vec3; 3]; 2],
    stood: [bool; 2],
    soles: [Frame; 2],
}

impl FootPlacer {
    /// Creates a placer for a body with these proportions.
    pub fn new(skeleton: &Skeleton, config: &PlacementConfig) -> Self {
        let placed = PlacedFoot {
            locked: false,
            sole: Frame::IDENTITY,
            support: None,
            landed: false,
            left: false,
        };
        let rockers = Side::BOTH.map(|side| RockerFoot::new(skeleton, side));
        let highest_ankles_m = [0, 1].map(|index| {
            let rocker: &RockerFoot = &rockers[index];
            rocker.ankle_height() + rocker.roll(MAX_PITCH).y
        });
        Self {
            config: *config,
            hips_from_hip: Side::BOTH.map(|side| skeleton.offset(side.upper_leg())),
            leg_lengths: Side::BOTH.map(|side| skeleton.leg_length(side)),
            legs: Side::BOTH.map(|side| Leg::new(skeleton, side)),
            rockers,
            highest_ankles_m,
            feet: [Foot::default(); 2],
            placed: [placed; 2],
            pelvis: Ride::default(),
            ground_m: 0.0,
            grade: 0.0,
            grade_ahead: 0.0,
            aimed: None,
            stood_at: None,
            memory: None,
        }
    }

    /// Changes the settings.
    pub fn set_config(&mut self, config: &PlacementConfig) {
        self.config = *config;
    }

    /// Forgets the places of the feet.
    pub fn reset(&mut self) {
        self.memory = None;
        self.feet = [Foot::default(); 2];
        self.ground_m = 0.0;
        self.grade = 0.0;
        self.grade_ahead = 0.0;
        self.aimed = None;
        self.stood_at = None;
    }

    /// The feet after the last step, left and right.
    pub fn feet(&self) -> &[PlacedFoot; 2] {
        &self.placed
    }

    /// Height of the ground under the pelvis above the animation's floor, metres: how far the last step moved the pelvis.
    pub fn pelvis_offset_m(&self) -> f32 {
        self.memory.map_or(0.0, |memory| {
            let floor = memory.world_from_floor;
            self.pelvis.value - floor.position.dot(floor.up())
        })
    }

    /// Height of the ground under the body above the animation's floor, metres: how far a character that is to stay on the ground
    /// has to rise. 0 where there is no ground.
    pub fn ground_offset_m(&self) -> f32 {
        self.ground_m
    }

    /// Grade from one foothold to the other in the direction that the character faces: rise by run, positive uphill.
    pub fn grade(&self) -> f32 {
        self.grade
    }

    /// Puts hips and legs of a pose, given over the animation's floor, on the ground; the rest of the pose stays.
    ///
    /// With `dt_secs` 0 no time passes, and the given pose is placed.
    pub fn step(
        &mut self,
        dt_secs: f32,
        input: &PlacementInput,
        terrain: &mut impl Terrain,
        pose: &mut Pose,
    ) {
        let floor = input.world_from_floor;
        let teleported = |memory: &Memory| {
            memory.world_from_floor.position.distance(floor.position) > TELEPORT_M
        };
        if self.memory.as_ref().is_some_and(teleported) {
            self.reset();
        }
        let mut animated = self.animated(dt_secs, input, pose, terrain);
        let config = self.config;
        let mut scene = self.scene(dt_secs, input, terrain, &config);
        self.let_go(&mut scene, &mut animated, pose);
        if !input.airborne {
            let mut feet = self.feet;
            for (index, foot) in feet.iter_mut().enumerate() {
                let landing = input.landings[index].filter(|landing| !landing.is_now());
                if foot.mode == Mode::Locked && landing.is_none() {
                    // What was announced was its contact.
                    foot.plan = None;
                } else if let Some(step) = self.next_step(&mut scene, input, index, false) {
                    foot.plan(&mut scene, &step);
                }
            }
            self.feet = feet;
        }
        let mut targets = [FootTarget {
            ankle: Vec3::ZERO,
            foot: Quat::IDENTITY,
            toes: Quat::IDENTITY,
        }; 2];
        for index in 0..2 {
            let (foot, rocker) = (&mut self.feet[index], &self.rockers[index]);
            targets[index] = foot.step(&mut scene, rocker, &animated[index], input.airborne);
        }
        let soles = [0, 1].map(|index| floor.child(&self.feet[index].sole));
        for (foot, sole) in self.feet.iter().zip(&soles) {
            if foot.mode == Mode::Locked {
                self.stood_at = Some(sole.position);
            }
        }
        self.measure_grade(dt_secs);
        let moment = Moment {
            dt_secs,
            input,
            animated: &animated,
        };
        let terrain = scene.terrain;
        self.carry_pelvis(&moment, &soles, terrain, pose, &mut targets);
        let hips_rotation = pose.rotations[Joint::Hips.index()];
        for (leg, target) in self.legs.iter().zip(&targets) {
            leg.solve(pose.root_position, hips_rotation, target, pose);
        }
        for (index, sole) in soles.into_iter().enumerate() {
            let foot = &self.feet[index];
            let before = self.placed[index].locked;
            let locked = foot.mode == Mode::Locked;
            self.placed[index] = PlacedFoot {
                locked,
                sole,
                support: foot.hold.map(|hold| hold.support()),
                landed: locked && !before,
                left: before && !locked,
            };
        }
        self.memory = Some(Memory {
            world_from_floor: floor,
            points: [0, 1].map(|index| {
                let points = self.rockers[index].points(&animated[index].foot);
                points.map(|point| floor.point(point))
            }),
            stood: [0, 1].map(|index| animated[index].contact),
            soles,
        });
    }

    /// The feet as the animation has them.
    fn animated(
        &self,
        dt_secs: f32,
        input: &PlacementInput,
        pose: &Pose,
        terrain: &mut impl Terrain,
    ) -> [Animated; 2] {
        Side::BOTH.map(|side| {
            let index = side.index();
            let rocker = &self.rockers[index];
            let foot = self.foot_of(side, pose);
            let (heading, mut pitch) = foot_attitude(foot.foot);
            let plant = rocker.plant_under(foot.ankle, heading, pitch);
            let contact = if let Some(contacts) = input.contacts {
                contacts[index]
            } else {
                pitch = settled_pitch(pitch);
                self.stands(dt_secs, input, index, &foot, terrain)
            };
            Animated {
                foot,
                flat: Frame {
                    position: RockerFoot::footprint(&plant),
                    rotation: from_heading(heading),
                },
                pitch,
                contact,
                landing: input.landings[index],
            }
        })
    }

    fn foot_of(&self, side: Side, pose: &Pose) -> FootTarget {
        let hips = pose.rotations[Joint::Hips.index()];
        let thigh = hips * pose.rotation(side.upper_leg());
        let shank = thigh * pose.rotation(side.lower_leg());
        let foot = (shank * pose.rotation(side.foot())).normalize();
        FootTarget {
            ankle: pose.root_position
                + hips * self.hips_from_hip[side.index()]
                + self.legs[side.index()].ankle_from_hip(thigh, shank),
            foot,
            toes: (foot * pose.rotation(side.toes())).normalize(),
        }
    }

    /// Returns true when a foot stands, in an animation without known contacts.
    fn stands(
        &self,
        dt_secs: f32,
        input: &PlacementInput,
        index: usize,
        foot: &FootTarget,
        terrain: &mut impl Terrain,
    ) -> bool {
        let points = self.rockers[index].points(foot);
        let height = points.iter().map(|point| point.y).fold(f32::MAX, f32::min);
        let Some(memory) = &self.memory else {
            return self.config.contact.stands(false, 0.0, height);
        };
        if dt_secs <= 0.0 {
            return memory.stood[index];
        }
        // On something that moves, a foot that moves along stands.
        let carried = self.feet[index].hold.and_then(|hold| {
            let sole = hold.world_from_sole(terrain)?;
            Some(sole.position - memory.soles[index].position)
        });
        let carried = carried.unwrap_or_default();
        let speed = points
            .iter()
            .zip(&memory.points[index])
            .map(|(now, then)| {
                let moved = input.world_from_floor.point(*now) - (*then + carried);
                // That the floor goes up or down a slope is no motion of the foot over it.
                moved
                    .reject_from_normalized(input.world_from_floor.up())
                    .length()
            })
            .fold(f32::MAX, f32::min)
            / dt_secs;
        self.config
            .contact
            .stands(memory.stood[index], speed, height)
    }
}
