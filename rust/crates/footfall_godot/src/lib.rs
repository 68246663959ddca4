//! The Godot nodes.
