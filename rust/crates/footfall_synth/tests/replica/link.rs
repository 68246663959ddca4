//! Walkers on two machines and the network between them.

use footfall_core::{Joint, ModelPose, Pose, Side, Skeleton, forward_kinematics};
use footfall_model::GaitModel;
use footfall_synth::replica::{Followed, UPDATE_BYTES, WalkFollower, WalkIdentity, WalkSender};
use footfall_synth::{Controls, GaitGenerator, GeneratorConfig, GroundTransform, StyleSpace};
use glam::{Quat, Vec3};
use std::collections::VecDeque;
use std::sync::{Arc, OnceLock};

pub(crate) const DT: f32 = 1.0 / 60.0;

pub(crate) fn space() -> Arc<StyleSpace> {
    static SPACE: OnceLock<Arc<StyleSpace>> = OnceLock::new();
    let load = || {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../../addons/footfall/models/locomotion.footfall"
        );
        let model = Arc::new(GaitModel::from_bytes(&std::fs::read(path).unwrap()).unwrap());
        Arc::new(StyleSpace::new(&model, &[]).unwrap())
    };
    Arc::clone(SPACE.get_or_init(load))
}

pub(crate) fn generator(config: &GeneratorConfig) -> GaitGenerator {
    GaitGenerator::new(&space(), &[], &Skeleton::standard(), config).unwrap()
}

pub(crate) fn walking(speed_mps: f32) -> Controls {
    Controls {
        speed_mps,
        ..Controls::STAND
    }
}

/// A footstep in the shared space, and when it was made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Print {
    pub(crate) secs: f32,
    pub(crate) side: Side,
    pub(crate) place: Vec3,
}

/// A frame in the shared space.
pub(crate) struct Frame {
    pub(crate) model: ModelPose,
    pub(crate) contact: [bool; 2],
    /// True where the walk began anew.
    pub(crate) anew: bool,
}

/// A walker in the shared space, with what it has shown.
pub(crate) struct Body {
    pub(crate) generator: GaitGenerator,
    pub(crate) shared_from_start: GroundTransform,
    pub(crate) pose: Pose,
    pub(crate) frames: Vec<Frame>,
    pub(crate) prints: Vec<Print>,
}

impl Body {
    pub(crate) fn new(config: &GeneratorConfig, shared_from_start: GroundTransform) -> Self {
        Self {
            generator: generator(config),
            shared_from_start,
            pose: Pose::default(),
            frames: vec![],
            prints: vec![],
        }
    }

    pub(crate) fn place(&self) -> GroundTransform {
        self.shared_from_start
            .global(&self.generator.start_from_character())
    }

    pub(crate) fn show(&mut self, secs: f32, anew: bool) {
        let place = self.place();
        let level = Quat::from_rotation_y(place.heading);
        let mut pose = self.pose.clone();
        pose.root_position = place.position + level * pose.root_position;
        pose.rotations[0] = level * pose.rotations[0];
        let mut model = ModelPose::default();
        forward_kinematics(&Skeleton::standard(), &pose, &mut model);
        self.frames.push(Frame {
            model,
            contact: self.generator.feet_in_contact(),
            anew,
        });
        for footstep in self.generator.footsteps() {
            let seen = GroundTransform {
                position: footstep.position,
                heading: footstep.heading,
            };
            let place = self.shared_from_start.global(&seen).position;
            self.prints.push(Print {
                secs,
                side: footstep.side,
                place,
            });
        }
    }
}

/// A sender, a follower, and updates on their way between them.
pub(crate) struct Link {
    pub(crate) sender: WalkSender,
    pub(crate) here: Body,
    pub(crate) there: Body,
    pub(crate) follower: WalkFollower,
    pub(crate) identity: WalkIdentity,
    under_way: VecDeque<(f32, [u8; UPDATE_BYTES])>,
    pub(crate) delay_secs: f32,
    pub(crate) loss: f32,
    pub(crate) interval_secs: f32,
    /// Frames of the follower, seconds: machines differ.
    pub(crate) their_dt: f32,
    pub(crate) secs: f32,
    their_secs: f32,
    sent_secs: f32,
    chance: u32,
    pub(crate) joined: bool,
    /// Machines that stand still, as while they load: here, there.
    pub(crate) pauses: [bool; 2],
    pub(crate) refused: usize,
}

impl Link {
    pub(crate) fn new(seed: u64) -> Self {
        let config = GeneratorConfig {
            seed,
            phase: 0.0,
            variation: 1.0,
        };
        let start = GroundTransform {
            position: Vec3::new(3.0, 0.0, -4.0),
            heading: 0.7,
        };
        let here = Body::new(&config, start);
        let sender = WalkSender::new();
        let identity = sender.identity(&here.generator).unwrap();
        Self {
            follower: WalkFollower::new(&identity),
            there: Body::new(&identity.config(), GroundTransform::default()),
            sender,
            here,
            identity,
            under_way: VecDeque::new(),
            delay_secs: 0.2,
            loss: 0.05,
            interval_secs: 0.05,
            their_dt: DT,
            secs: 0.0,
            their_secs: 0.0,
            sent_secs: 0.0,
            chance: seed as u32 * 2 + 1,
            joined: true,
            pauses: [false; 2],
            refused: 0,
        }
    }

    fn chance(&mut self) -> f32 {
        self.chance = self
            .chance
            .wrapping_mul(1_664_525)
            .wrapping_add(1_013_904_223);
        (self.chance >> 8) as f32 / (1 << 24) as f32
    }

    /// Lets a frame pass on both machines.
    pub(crate) fn frame(&mut self, controls: &Controls) {
        self.secs += DT;
        let [here, there] = self.pauses;
        if !here {
            self.frame_here(controls);
        }
        if !there {
            self.frames_there();
        }
        if there || !self.joined {
            self.their_secs = self.secs;
        }
    }

    fn frame_here(&mut self, controls: &Controls) {
        self.here.generator.step(DT, controls, &mut self.here.pose);
        self.here.show(self.secs, false);
        self.sender.step(DT);
        self.sent_secs += DT;
        if self.sent_secs >= self.interval_secs {
            self.sent_secs -= self.interval_secs;
            let start = self.here.shared_from_start;
            let update = self.sender.update(&self.here.generator, &start).unwrap();
            // Late by up to 10 ms more, so that they come unevenly.
            let late = 0.01 * self.chance();
            if self.chance() >= self.loss && self.joined {
                self.under_way
                    .push_back((self.secs + self.delay_secs + late, update));
            }
        }
    }

    fn frames_there(&mut self) {
        while self.their_secs + self.their_dt <= self.secs && self.joined {
            self.their_secs += self.their_dt;
            while let Some((at, update)) = self.under_way.front().copied() {
                if at > self.their_secs {
                    break;
                }
                self.under_way.pop_front();
                if self.follower.hear(&update, &self.there.generator).is_err() {
                    self.refused += 1;
                }
            }
            let start = self.there.shared_from_start;
            let followed = self.follower.step(
                self.their_dt,
                &mut self.there.generator,
                &start,
                &mut self.there.pose,
            );
            if let Followed::Anew(start) = followed {
                self.there.shared_from_start = start;
            }
            self.there
                .show(self.their_secs, matches!(followed, Followed::Anew(_)));
        }
    }

    pub(crate) fn walk(&mut self, controls: &Controls, secs: f32) {
        for _ in 0..(secs / DT).round() as usize {
            self.frame(controls);
        }
    }
}

/// Distances between the steps that the follower made from a time on and those of the sender; a step that the sender did not make is far away.
pub(crate) fn differences(link: &Link, from_secs: f32) -> Vec<f32> {
    link.there
        .prints
        .iter()
        .filter(|print| print.secs >= from_secs)
        .map(|print| {
            let near = link.here.prints.iter().filter(|other| {
                let late = print.secs - other.secs;
                other.side == print.side && (-0.1..1.5).contains(&late)
            });
            near.map(|other| other.place.distance(print.place))
                .fold(f32::INFINITY, f32::min)
        })
        .collect()
}

/// The farthest that a joint goes in a frame, metres, where the walk was not begun anew.
pub(crate) fn farthest(frames: &[Frame], joint: Joint) -> f32 {
    frames
        .windows(2)
        .filter(|pair| !pair[1].anew)
        .map(|pair| {
            pair[0]
                .model
                .position(joint)
                .distance(pair[1].model.position(joint))
        })
        .fold(0.0, f32::max)
}

/// Way of the slowest of heel, ball and toe tip from one frame to another, metres.
fn slide(then: &Frame, now: &Frame, side: Side) -> f32 {
    let skeleton = Skeleton::standard();
    let foot = skeleton.foot(side);
    let sole = |frame: &Frame| {
        [
            frame.model.point(side.foot(), foot.heel),
            frame.model.point(side.toes(), foot.ball),
            frame.model.point(side.toes(), foot.toe_tip),
        ]
    };
    let [then, now] = [then, now].map(sole);
    let ways = then.iter().zip(&now).map(|(then, now)| then.distance(*now));
    ways.fold(f32::INFINITY, f32::min)
}

/// Distance that a foot slides, metres: from where the walk begins here, to the end of the stance in which it does; and in the whole stance after that in which it slides
/// farthest. Of the first there may be no more than a few frames in which the foot rolls off: [`slip`] says little of them.
pub(crate) fn slid_at_join(frames: &[Frame]) -> [f32; 2] {
    let begun = frames.iter().position(|frame| frame.anew).unwrap();
    let slides = Side::BOTH.map(|side| {
        let stands = |pair: &[Frame]| pair.iter().all(|frame| frame.contact[side.index()]);
        let pairs: Vec<&[Frame]> = frames[begun..].windows(2).collect();
        let stretches = pairs.chunk_by(|one, other| stands(one) == stands(other));
        let mut slides = stretches.map(|stretch| {
            let stance = stretch.iter().filter(|pair| stands(pair));
            stance.map(|pair| slide(&pair[0], &pair[1], side)).sum()
        });
        [slides.next().unwrap(), slides.fold(0.0, f32::max)]
    });
    [0, 1].map(|when| slides[0][when].max(slides[1][when]))
}

/// The fastest that a foot moves in the mean of one stance, m/s: in every frame the slower of heel, ball and toe tip. Single frames say less where machines do not keep
/// the model's rate: between two of its frames a foot that rolls from the heel to the ball moves by up to a millimetre, with or without a network.
pub(crate) fn slip(frames: &[Frame], dt_secs: f32) -> f32 {
    let mut most: f32 = 0.0;
    for side in Side::BOTH {
        let stands =
            |pair: &[Frame]| !pair[1].anew && pair.iter().all(|frame| frame.contact[side.index()]);
        let pairs: Vec<&[Frame]> = frames.windows(2).collect();
        for stance in pairs.chunk_by(|one, other| stands(one) == stands(other)) {
            if !stands(stance[0]) || stance.len() < 6 {
                continue;
            }
            let moved = stance.iter().map(|pair| slide(&pair[0], &pair[1], side));
            most = most.max(moved.sum::<f32>() / (stance.len() as f32 * dt_secs));
        }
    }
    most
}
