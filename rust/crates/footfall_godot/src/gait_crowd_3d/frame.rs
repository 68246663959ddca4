//! One frame of a crowd: walkers move and are drawn, and signals are emitted.

use super::behaviour::MOST_AGENTS;
use super::navigation::Navigation;
use super::scene::{CrowdScene, DrawSettings};
use super::{GaitCrowd3D, ground};
use crate::convert;
use footfall_rig::crowd::{Crowd, Limits};
use godot::classes::{Engine, Node3D};
use godot::prelude::*;

impl GaitCrowd3D {
    /// Advances the crowd; `waits` for pending walkers, or leaves them for a later frame.
    pub(super) fn advance_by(&mut self, dt_secs: f32, waits: bool) {
        let is_new = self.walkers.is_none();
        // Reading the character takes its share of a new crowd's frame, and nobody can walk before other threads have prepared the styles.
        if !self.make() || (is_new && !waits) || !self.begin_walkers(waits) {
            return;
        }
        let limits = self.limits();
        let (avoidance, repeat_far, mask) = (self.avoidance, self.repeat_far, self.ground_mask);
        let standing_motion = self.standing_motion as f32;
        let look = DrawSettings {
            character: self.character.clone(),
            material: self.material.clone(),
            culls: self.culling,
            stand_in_px: convert::finite_or(self.stand_in_pixels, 0.0) as f32,
            most_made: if waits { usize::MAX } else { 1 },
        };
        let host = self.to_gd().upcast::<Node3D>();
        let (Some(mut walkers), scene) = (self.walkers.take(), self.scene.take()) else {
            return;
        };
        let leads = !walkers.is_following();
        // Shared steps cannot be sent.
        walkers.repeats = repeat_far && leads && !self.replica.is_told();
        self.replica.pass(dt_secs);
        walkers.standing_motion = standing_motion;
        let is_navigated = walkers.routing().is_navigated();
        if leads
            && (is_navigated || self.sends)
            && let Some(mut navigation) = Navigation::of(&host, self.navigation_layers)
        {
            if is_navigated {
                navigation.wander(&mut walkers);
            }
            self.kept = navigation.keep(&mut walkers, self.kept);
        }
        if avoidance && leads {
            self.others
                .watch(&mut walkers, &host, &self.avoided_group, dt_secs);
        }
        walkers.advance(dt_secs, avoidance);
        if leads {
            ground::find(&mut walkers, &host, mask);
        }
        let is_seen = self.base().is_visible_in_tree();
        let scene = scene.or_else(|| {
            let mesh = self.mesh.clone().filter(|_| is_seen)?;
            let _released = self.base_mut();
            CrowdScene::new(&host, mesh, &look)
        });
        let drawn = scene.map(|mut scene| {
            let _released = self.base_mut();
            if is_seen {
                scene.draw(&mut walkers, &host, &limits, &look);
            }
            scene
        });
        let landed = self.landed(&walkers);
        let began: PackedInt32Array = walkers.began().iter().copied().collect();
        // A script that was called in between may have created the crowd again.
        if self.walkers.is_none() && self.base().is_inside_tree() {
            self.walkers = Some(walkers);
            self.scene = drawn;
        } else if let Some(scene) = drawn {
            scene.free();
        }
        if !began.is_empty() {
            self.signals().agents_ready().emit(&began);
        }
        if let Some((agents, feet, positions)) = landed {
            self.signals().footsteps().emit(&agents, &feet, &positions);
        }
    }

    /// Starts walkers that were made meanwhile; returns whether there still is a crowd.
    fn begin_walkers(&mut self, waits: bool) -> bool {
        let Some(walkers) = &mut self.walkers else {
            return false;
        };
        let came = if waits {
            walkers.begin_all()
        } else {
            walkers.begin_some()
        };
        match came {
            Ok(space) => {
                if let Some(space) = space
                    && let Ok(mut model) = self.used_model()
                {
                    model.bind_mut().share(&space);
                }
                true
            }
            Err(error) => {
                self.fail(&format!("The walk cannot start: {error}"));
                false
            }
        }
    }

    fn limits(&self) -> Limits {
        let metres = |value: f64| {
            if value.is_finite() {
                value.max(0.0) as f32
            } else {
                0.0
            }
        };
        Limits {
            counts: [self.full_count, self.near_count]
                .map(|count| count.clamp(0, MOST_AGENTS) as usize),
            distances_m: [metres(self.full_distance), metres(self.near_distance)],
        }
    }

    /// Arguments of the signal `footsteps`; `None` if no foot landed, in the editor, and without a connection.
    fn landed(
        &self,
        walkers: &Crowd,
    ) -> Option<(PackedInt32Array, PackedByteArray, PackedVector3Array)> {
        walkers.landed().next()?;
        let is_heard = self.base().has_connections("footsteps");
        if !is_heard || Engine::singleton().is_editor_hint() {
            return None;
        }
        let world = self.base().get_global_transform();
        let agents = walkers
            .landed()
            .map(|(place, ..)| walkers.roster().name(place));
        let feet = walkers.landed().map(|(_, side, _)| side.index() as u8);
        let places = walkers
            .landed()
            .map(|(.., place)| world * convert::vector3(place));
        Some((agents.collect(), feet.collect(), places.collect()))
    }
}
