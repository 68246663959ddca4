//! Binary glTF files as they are written: numbers, their layout, and the container around them and the document.

use glam::Vec3;
use gltf::binary::{Glb, Header};
pub use gltf::json::accessor::{ComponentType, Type};
pub use gltf::json::buffer::Target;
use serde_json::{Value, json};
use std::borrow::Cow;

/// Layout of an accessor's elements.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Type of a number.
    pub component: ComponentType,
    /// Shape of an element.
    pub shape: Type,
    /// True when whole numbers stand for 0 to 1.
    pub normalized: bool,
    /// Use by a graphics card.
    pub target: Option<Target>,
}

impl Layout {
    /// Elements of floats for no graphics card.
    pub const fn floats(shape: Type) -> Self {
        Self {
            component: ComponentType::F32,
            shape,
            normalized: false,
            target: None,
        }
    }
}

/// The numbers of a file that grows.
#[derive(Debug, Default)]
pub struct GlbBuffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl GlbBuffer {
    /// Appends this many elements as bytes; returns their accessor.
    pub fn push(&mut self, data: &[u8], count: usize, layout: Layout) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view =
            json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": data.len()});
        if let Some(target) = layout.target {
            view["target"] = json!(target);
        }
        self.bytes.extend_from_slice(data);
        self.views.push(view);
        let mut accessor = json!({
            "bufferView": self.views.len() - 1, "componentType": layout.component.as_gl_enum(), "count": count, "type": layout.shape,
        });
        if layout.normalized {
            accessor["normalized"] = true.into();
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Appends elements of floats; returns their accessor.
    pub fn push_floats(&mut self, values: &[f32], layout: Layout) -> usize {
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        self.push(&bytes, values.len() / layout.shape.multiplicity(), layout)
    }

    /// Appends vectors; returns their accessor.
    pub fn push_vectors(&mut self, vectors: &[Vec3], target: Option<Target>) -> usize {
        let values: Vec<f32> = vectors.iter().flat_map(Vec3::to_array).collect();
        let layout = Layout {
            target,
            ..Layout::floats(Type::Vec3)
        };
        self.push_floats(&values, layout)
    }

    /// States the least and the greatest element of an accessor.
    pub fn bound(&mut self, accessor: usize, least: &[f32], greatest: &[f32]) {
        self.accessors[accessor]["min"] = json!(least);
        self.accessors[accessor]["max"] = json!(greatest);
    }

    /// The bytes of a `.glb` file: a document, to which the buffer is added.
    pub fn into_file(self, mut document: Value) -> Vec<u8> {
        document["accessors"] = self.accessors.into();
        document["bufferViews"] = self.views.into();
        document["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        let json = document.to_string().into_bytes();
        let file = Glb {
            header: Header {
                magic: *b"glTF",
                version: 2,
                length: 0,
            },
            json: Cow::Owned(json),
            bin: Some(Cow::Owned(self.bytes)),
        };
        // Writing to memory does not fail, and lengths are counted anew.
        file.to_vec().unwrap_or_default()
    }
}
