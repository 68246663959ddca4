//! Motion as glTF 2.0: [writing](clip_to_glb) of clips and of [any file](glb), [reading](read) of animations that other programs made.

mod buffers;
pub mod glb;
mod read;
mod sample;
mod write;

pub use buffers::BufferError;
pub use read::{GltfError, animation_names, is_gltf, read};
pub use write::clip_to_glb;
