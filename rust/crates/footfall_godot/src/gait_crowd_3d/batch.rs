//! Questions and requests of scripts to walkers: many at once, in packed arrays.

use super::GaitCrowd3D;
use super::behaviour::FASTEST_MPS;
use super::navigation::Navigation;
use crate::convert;
use footfall_rig::crowd::Agent;
use glam::Vec2;
use godot::classes::Node3D;
use godot::prelude::*;

#[godot_api(secondary)]
impl GaitCrowd3D {
    /// Returns the positions of walkers on the ground, in this node's space: one for each id in `agents`, or for all walkers in the order of
    /// `get_agents()`. Unknown ids give positions that are not finite.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn get_positions(
        &mut self,
        #[opt(default = &PackedInt32Array::new())] agents: PackedInt32Array,
    ) -> PackedVector3Array {
        let nowhere = Vector3::splat(f32::NAN);
        self.each(&agents, nowhere, |agent| convert::vector3(agent.place))
    }

    /// Returns the headings of walkers, radians about +Y from +Z. Shapes and ids as of `get_positions()`.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn get_headings(
        &mut self,
        #[opt(default = &PackedInt32Array::new())] agents: PackedInt32Array,
    ) -> PackedFloat32Array {
        self.each(&agents, f32::NAN, |agent| agent.heading)
    }

    /// Returns the phase of each walker's stride: 0 at the left initial contact, 0.5 at the right. Shapes and ids as of
    /// `get_positions()`.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn get_phases(
        &mut self,
        #[opt(default = &PackedInt32Array::new())] agents: PackedInt32Array,
    ) -> PackedFloat32Array {
        self.each(&agents, f32::NAN, Agent::phase)
    }

    /// Returns the sizes of walkers, relative to the character. Shapes and ids as of `get_positions()`.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn get_sizes(
        &mut self,
        #[opt(default = &PackedInt32Array::new())] agents: PackedInt32Array,
    ) -> PackedFloat32Array {
        self.each(&agents, f32::NAN, |agent| agent.size)
    }

    /// Returns the tiers of walkers: 0 for a full scene, 1 for a new pose in every frame, 2 for a distant walker, or one that is not created yet.
    /// Shapes and ids as of `get_positions()`; 2 for an unknown id.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn get_tiers(
        &mut self,
        #[opt(default = &PackedInt32Array::new())] agents: PackedInt32Array,
    ) -> PackedByteArray {
        self.make_whole();
        let tier = |place: Option<usize>| {
            let walkers = self.walkers.as_ref();
            let tier = walkers.and_then(|walkers| walkers.tiers().get(place?));
            tier.copied().unwrap_or_default() as u8
        };
        self.places(&agents).into_iter().map(tier).collect()
    }

    /// Sets the requested speeds of walkers, in metres per second: one for each id in `agents`, or for all walkers in the order of
    /// `get_agents()`. Missing and non-finite speeds change nothing.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_speeds(
        &mut self,
        speeds: PackedFloat32Array,
        #[opt(default = &PackedInt32Array::new())] agents: PackedInt32Array,
    ) {
        self.set_each(speeds.as_slice(), &agents, |agent, speed| {
            if speed.is_finite() {
                agent.speed_mps = speed.clamp(0.0, FASTEST_MPS);
            }
        });
    }

    /// Sets the turn rates of walkers, in radians per second, positive to their left, and clears their goals. For `behaviour` scripted. Shapes
    /// and ids as of `set_speeds()`.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_turn_rates(
        &mut self,
        turn_rates: PackedFloat32Array,
        #[opt(default = &PackedInt32Array::new())] agents: PackedInt32Array,
    ) {
        self.set_each(turn_rates.as_slice(), &agents, |agent, rate| {
            if rate.is_finite() {
                agent.turn(*rate);
            }
        });
    }

    /// Sends walkers straight to positions in this node's space, where they stop. For `behaviour` scripted. A non-finite position keeps the goal. Shapes and
    /// ids as of `set_speeds()`.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_targets(
        &mut self,
        targets: PackedVector3Array,
        #[opt(default = &PackedInt32Array::new())] agents: PackedInt32Array,
    ) {
        self.set_each(targets.as_slice(), &agents, |agent, target| {
            if target.is_finite() {
                agent.go_to(Vec2::new(target.x, target.z));
            }
        });
    }

    /// Sends walkers to positions in this node's space, around obstacles on the world's navigation map. They stop there. For
    /// `behaviour` scripted. A non-finite position keeps the goal. Each path takes some tens of microseconds to find, once: send a thousand walkers over
    /// several frames. Shapes and ids as of `set_speeds()`.
    ///
    /// Returns `true` if there was a path for every walker; a walker without one keeps its goal. In the first frames of a scene there is no map yet: it
    /// returns `false`, and the walkers stand until there is one, and go.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_destinations(
        &mut self,
        destinations: PackedVector3Array,
        #[opt(default = &PackedInt32Array::new())] agents: PackedInt32Array,
    ) -> bool {
        let host = self.to_gd().upcast::<Node3D>();
        let mut navigation = Navigation::of(&host, self.navigation_layers);
        self.sends = true;
        let mut all = true;
        self.set_each(destinations.as_slice(), &agents, |agent, place| {
            if !place.is_finite() {
                return;
            }
            if let Some(navigation) = &mut navigation {
                all &= navigation.send(agent, *place);
            } else {
                agent.await_route(convert::vec3(*place));
                all = false;
            }
        });
        all
    }

    /// Sets the tints of walkers. Shapes and ids as of `set_speeds()`.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_tints(
        &mut self,
        colours: PackedColorArray,
        #[opt(default = &PackedInt32Array::new())] agents: PackedInt32Array,
    ) {
        self.set_each(colours.as_slice(), &agents, |agent, colour| {
            agent.tint = convert::linear(*colour);
        });
    }

    /// Sets the style weights of one walker, in the order of `styles`, from its next step on. They are rounded to eighths, so that a
    /// crowd needs few mixtures.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_agent_style(&mut self, agent: i32, weights: PackedFloat32Array) {
        self.make_whole();
        if let Some(walkers) = &mut self.walkers
            && let Some(place) = walkers.roster().place(agent)
        {
            walkers.wear(place, weights.as_slice());
        }
    }
}

impl GaitCrowd3D {
    /// Rows of the named walkers, or of all if none is named.
    pub(super) fn places(&self, agents: &PackedInt32Array) -> Vec<Option<usize>> {
        let Some(walkers) = &self.walkers else {
            return vec![None; agents.len()];
        };
        let roster = walkers.roster();
        if agents.is_empty() {
            return roster
                .order()
                .iter()
                .map(|place| Some(*place as usize))
                .collect();
        }
        let names = agents.as_slice().iter();
        names.map(|name| roster.place(*name)).collect()
    }

    fn each<T: Clone, C: FromIterator<T>>(
        &mut self,
        agents: &PackedInt32Array,
        nobody: T,
        of: impl Fn(&Agent) -> T,
    ) -> C {
        self.make_whole();
        let places = self.places(agents);
        let agent = |place: Option<usize>| self.walkers.as_ref()?.agents().get(place?);
        places
            .into_iter()
            .map(|place| agent(place).map_or_else(|| nobody.clone(), &of))
            .collect()
    }

    fn set_each<T>(
        &mut self,
        values: &[T],
        agents: &PackedInt32Array,
        mut set: impl FnMut(&mut Agent, &T),
    ) {
        self.make_whole();
        let places = self.places(agents);
        let Some(walkers) = &mut self.walkers else {
            return;
        };
        for (place, value) in places.into_iter().zip(values) {
            if let Some(agent) = place.and_then(|place| walkers.agents_mut().get_mut(place)) {
                set(agent, value);
            }
        }
    }
}
