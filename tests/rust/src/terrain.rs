//! Ground from formulas, and a walker on it.

use footfall_core::rotation::from_heading;
use footfall_core::{Joint, ModelPose, Pose, Side, Skeleton, forward_kinematics};
use footfall_ik::RockerFoot;
use footfall_ik::placement::{
    FootPlacer, Frame, Ground, PlacementConfig, PlacementInput, SupportId, Terrain,
};
use footfall_synth::{Controls, GaitChoice, GaitGenerator};
use glam::{Quat, Vec3};

/// Ground whose height is a function of the place, on a support that may move.
pub struct Relief {
    /// Height at x and z of the support, metres.
    pub height: Box<dyn Fn(f32, f32) -> f32>,
    /// Place of the support in the world.
    pub support: Frame,
}

impl Relief {
    /// Ground that does not move.
    pub fn still(height: impl Fn(f32, f32) -> f32 + 'static) -> Self {
        Self {
            height: Box::new(height),
            support: Frame::IDENTITY,
        }
    }

    /// The ground above or below a place of the world.
    pub fn at(&self, place: Vec3) -> Ground {
        let local = self.support.local_point(place);
        let height = |x: f32, z: f32| (self.height)(x, z);
        let (x, z) = (local.x, local.z);
        let step = 1e-3;
        let slope = |dx: f32, dz: f32| {
            let ahead = height(x + dx, z + dz) - height(x, z);
            // An edge is not a slope: the ground before it is level.
            if ahead.abs() > 5.0 * step {
                0.0
            } else {
                ahead / step
            }
        };
        let normal = Vec3::new(-slope(step, 0.0), 1.0, -slope(0.0, step)).normalize();
        Ground {
            position: self.support.point(Vec3::new(x, height(x, z), z)),
            normal: self.support.rotation * normal,
            support: 1,
        }
    }
}

impl Terrain for Relief {
    fn cast(&mut self, from: Vec3, way: Vec3) -> Option<Ground> {
        let ground = self.at(from);
        let below = from.y - ground.position.y;
        (below >= 0.0 && below <= -way.y).then_some(ground)
    }

    fn support(&mut self, _support: SupportId) -> Option<Frame> {
        Some(self.support)
    }
}

/// Ways of carrying a character's origin over the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The ground under its feet, as `follow_ground` has it.
    Follows,
    /// The highest ground under a capsule, at once, as physics has it.
    Capsule,
}

/// Radius of a capsule on which an adult stands, metres: what edges it is lifted over.
const CAPSULE_M: f32 = 0.2;
/// Time constant with which a character rises and falls with the ground under its feet, seconds.
const RISE_SECS: f32 = 0.12;

/// A generated walk on uneven ground; the character's origin follows the ground as a game's would.
pub struct PlacedWalker {
    /// The walk.
    pub generator: GaitGenerator,
    /// Placer that puts it on the ground.
    pub placer: FootPlacer,
    /// The body that walks.
    pub skeleton: Skeleton,
    /// Place where the character began: `world_from_start`.
    pub world_from_start: Frame,
    /// The animation's floor in the last frame.
    pub world_from_floor: Frame,
    /// The pose before it was placed, over the floor.
    pub animated: Pose,
    /// The pose after it was placed, over the floor.
    pub pose: Pose,
    /// Every joint in the world.
    pub world: ModelPose,
    /// Carrier of its origin over the ground.
    pub carrier: Origin,
    height: f32,
}

impl PlacedWalker {
    /// At the origin of the world.
    pub fn new(generator: GaitGenerator, config: &PlacementConfig) -> Self {
        Self::of(generator, &Skeleton::standard(), config)
    }

    /// At the origin of the world, with this body.
    pub fn of(generator: GaitGenerator, skeleton: &Skeleton, config: &PlacementConfig) -> Self {
        Self {
            generator,
            placer: FootPlacer::new(skeleton, config),
            skeleton: skeleton.clone(),
            world_from_start: Frame::IDENTITY,
            world_from_floor: Frame::IDENTITY,
            animated: Pose::default(),
            pose: Pose::default(),
            world: ModelPose::default(),
            carrier: Origin::Follows,
            height: f32::NAN,
        }
    }

    /// Lets time pass for a character that a game carries over the ground and that slows down on slopes and does not run on stairs.
    pub fn climb(
        &mut self,
        dt_secs: f32,
        controls: Controls,
        terrain: &mut Relief,
        announced: bool,
    ) {
        let slowed = Controls {
            speed_mps: controls.speed_mps * self.placer.pace(),
            gait: if self.placer.is_steep() {
                GaitChoice::Walk
            } else {
                controls.gait
            },
            ..controls
        };
        self.generator.set_grade(self.placer.way_grade());
        let origin = self.origin(dt_secs, slowed).position;
        let ground = terrain.at(origin).position.y;
        if self.height.is_nan() {
            self.height = ground;
        }
        match self.carrier {
            Origin::Follows => {
                let share = 1.0 - (-dt_secs / RISE_SECS).exp();
                self.height += share * self.placer.ground_offset_m();
            }
            Origin::Capsule => {
                let around = [Vec3::ZERO, Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z];
                let under = around.map(|way| terrain.at(origin + CAPSULE_M * way).position.y);
                self.height = under.into_iter().fold(ground, f32::max);
            }
        }
        self.put(dt_secs, terrain, announced);
    }

    /// Feet that the animation has on the ground.
    pub fn contacts(&self) -> [bool; 2] {
        self.generator.feet_in_contact()
    }

    /// Lets time pass. Without `announced` the placer finds contacts by itself and knows no footholds.
    pub fn step(
        &mut self,
        dt_secs: f32,
        controls: Controls,
        terrain: &mut Relief,
        announced: bool,
    ) {
        let ground = terrain.at(self.origin(dt_secs, controls).position);
        self.place(dt_secs, terrain, announced, ground.position.y);
    }

    /// As [`step`](Self::step), with the character's origin at this height.
    pub fn step_at(
        &mut self,
        dt_secs: f32,
        controls: Controls,
        terrain: &mut Relief,
        announced: bool,
        height: f32,
    ) {
        self.origin(dt_secs, controls);
        self.place(dt_secs, terrain, announced, height);
    }

    /// Place of the character after another frame of its walk, at the height where it began.
    fn origin(&mut self, dt_secs: f32, controls: Controls) -> Frame {
        self.generator.step(dt_secs, &controls, &mut self.animated);
        let place = self.generator.start_from_character();
        self.world_from_floor = self.world_from_start.child(&Frame {
            position: place.position,
            rotation: from_heading(place.heading),
        });
        self.world_from_floor
    }

    fn place(&mut self, dt_secs: f32, terrain: &mut Relief, announced: bool, ground: f32) {
        if self.height.is_nan() {
            self.height = ground;
        }
        self.height += (ground - self.height) * (1.0 - (-dt_secs / 0.15).exp());
        self.put(dt_secs, terrain, announced);
    }

    fn put(&mut self, dt_secs: f32, terrain: &mut Relief, announced: bool) {
        let mut floor = self.world_from_floor;
        floor.position.y = self.height;
        let mut input = PlacementInput {
            world_from_floor: floor,
            contacts: announced.then(|| self.generator.feet_in_contact()),
            landings: [None; 2],
            airborne: false,
        };
        if announced {
            if self.placer.pace() < 1.0 {
                // As `FootPlacement3D` does on a grade.
                self.generator.keep_step();
            }
            input.landings = self.generator.landings();
            if let Some(share) = self.placer.step_share(&input, terrain) {
                self.generator.stretch_step(share);
                input.landings = self.generator.landings();
            }
        }
        self.pose = self.animated.clone();
        self.placer.step(dt_secs, &input, terrain, &mut self.pose);
        self.world_from_floor = floor;
        forward_kinematics(&self.skeleton, &self.pose, &mut self.world);
        for position in &mut self.world.positions {
            *position = floor.point(*position);
        }
        for rotation in &mut self.world.rotations {
            *rotation = floor.rotation * *rotation;
        }
    }

    /// Heel, ball and toe tip of a foot in the world.
    pub fn sole(&self, side: Side) -> [Vec3; 3] {
        let shape = self.skeleton.foot(side);
        [
            self.world.point(side.foot(), shape.heel),
            self.world.point(side.toes(), shape.ball),
            self.world.point(side.toes(), shape.toe_tip),
        ]
    }

    /// The rim of a foot's sole in the world: left and right of heel, ball and toe tip.
    pub fn rim(&self, side: Side) -> [[Vec3; 2]; 3] {
        let shape = self.skeleton.foot(side);
        let [heel, ball, tip] = RockerFoot::new(&self.skeleton, side).half_breadths();
        [
            (side.foot(), shape.heel, heel),
            (side.toes(), shape.ball, ball),
            (side.toes(), shape.toe_tip, tip),
        ]
        .map(|(joint, point, half)| {
            [Vec3::X, Vec3::NEG_X].map(|way| self.world.point(joint, point + half * way))
        })
    }

    /// Flexion of a knee, radians.
    pub fn knee(&self, side: Side) -> f32 {
        self.pose
            .rotation(side.lower_leg())
            .angle_between(Quat::IDENTITY)
    }

    /// Position of the hips in the world.
    pub fn hips(&self) -> Vec3 {
        self.world.position(Joint::Hips)
    }
}
