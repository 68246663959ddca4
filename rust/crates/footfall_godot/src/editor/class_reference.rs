//! The class reference that the editor shows, for tools that make other things of it.

use godot::prelude::*;

/// Class reference of the add-on, as the editor loads it.
#[derive(GodotClass)]
#[class(no_init, internal, base = Object)]
struct FootfallClassReference {}

#[godot_api]
impl FootfallClassReference {
    /// One XML document for every class, in the format of Godot's class reference, but with types as they are named in Rust.
    #[func]
    fn documents() -> PackedStringArray {
        let mut documents: Vec<String> = godot::docs::__gather_xml_docs().collect();
        documents.sort_unstable();
        documents.iter().map(GString::from).collect()
    }
}
