//! Bodies on a floor, seen through a camera that orbits.
//!
//! Everything becomes triangles and lines of egui, projected, shaded and sorted here: a body is a few thousand triangles, which any
//! graphics driver, and one in software, paints at once. Modules in the order in which data flows: [`camera`], [`solid`], [`floor`], [`view`].

pub(crate) mod camera;
mod floor;
mod solid;
mod view;

pub(crate) use view::{Body, BodyPaint, Footprint, Scene, SceneView, SensorBox, soles};
