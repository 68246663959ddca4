//! The editor's half of the add-on: the dock that makes styles of recordings, gizmos and the preview bar. Exported games are built
//! without it.

mod class_reference;
mod clip_source;
mod gait_style_maker;
pub(crate) mod headless;
mod installation;
mod leftovers;
mod plugin;
mod preview_bar;
mod style_dock;
mod style_maker;
mod walk_gizmo;
mod walker_view;
