//! Behaviours of a crowd's walkers, and their limits.

use godot::prelude::*;

/// More walkers than this are refused.
pub(super) const MOST_AGENTS: i64 = footfall_rig::crowd::MOST_AGENTS as i64;

/// Highest speed of a walker, m/s.
pub(super) const FASTEST_MPS: f32 = 6.0;

/// Behaviours of walkers by themselves.
#[derive(GodotConvert, Var, Export, Default, Clone, Copy, Debug, PartialEq)]
#[godot(via = i64)]
pub(crate) enum CrowdBehaviour {
    #[default]
    Wander = 0,
    Path = 1,
    Scripted = 2,
    Navigate = 3,
}
