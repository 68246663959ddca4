//! The editor's half of the add-on: importers, the dock that makes styles of recordings, gizmos and the preview bar. Exported games are built
//! without it.

mod class_reference;
mod import_plugin;
mod plugin;
mod preview_bar;
mod style_dock;
mod style_maker;
mod walk_gizmo;
mod walker_view;
