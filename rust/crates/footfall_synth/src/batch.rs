//! Whole walks: solved at once, or recorded from the streaming generator, as clips and as loops.

mod looped;
mod solved;
mod streamed;
mod walk;

pub use looped::LoopedWalk;
pub use solved::synthesize;
pub use streamed::{
    Move, StandConfig, SwitchingWalkConfig, synthesize_moves, synthesize_standing,
    synthesize_switching,
};
pub use walk::{SynthesizedWalk, WalkConfig};
