//! The material that a crowd's meshes are drawn with.

use godot::classes::base_material_3d::TextureParam;
use godot::classes::{BaseMaterial3D, Material, Shader, ShaderMaterial};
use godot::init::is_main_thread;
use godot::prelude::*;
use std::cell::RefCell;

const SHADER: &str = "res://addons/footfall/shaders/crowd.gdshader";

thread_local! {
    /// The shader, once a crowd was drawn. Loading it takes a third of a frame, so it stays for crowds that come after the last one has gone.
    static LOADED: RefCell<Option<Gd<Shader>>> = const { RefCell::new(None) };
}

/// Returns the crowd's shader; `None` where it was left out of the export.
fn shader() -> Option<Gd<Shader>> {
    // Nodes may be processed on the engine's other threads, which end after the library is unloaded.
    if !is_main_thread() {
        return try_load(SHADER).ok();
    }
    LOADED.with_borrow_mut(|loaded| {
        if loaded.is_none() {
            *loaded = try_load(SHADER).ok();
        }
        loaded.clone()
    })
}

/// Lets the shader go, before the engine unloads the library.
pub(crate) fn release_shader() {
    LOADED.take();
}

/// The crowd's shader with what a character's own material says.
pub(super) fn crowd_material(own: Option<Gd<Material>>) -> Option<Gd<ShaderMaterial>> {
    let mut material = ShaderMaterial::new_gd();
    material.set_shader(&shader()?);
    if let Some(own) = own.and_then(|own| own.try_cast::<BaseMaterial3D>().ok()) {
        material.set_shader_parameter("albedo", &own.get_albedo().to_variant());
        material.set_shader_parameter("roughness", &own.get_roughness().to_variant());
        material.set_shader_parameter("metallic", &own.get_metallic().to_variant());
        if let Some(texture) = own.get_texture(TextureParam::ALBEDO) {
            material.set_shader_parameter("albedo_texture", &texture.to_variant());
        }
    }
    Some(material)
}
