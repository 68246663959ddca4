//! A clip as glTF, for whatever reads that: the skeleton as nodes with a skin, and its animation.
//!
//! glTF has our axes and units: metres, Y up, a character faces +Z. There is no mesh.

use footfall_core::{Clip, JOINT_COUNT, Joint};
use glam::Vec3;
use serde_json::{Value, json};

/// Component type `FLOAT`.
const FLOAT: u32 = 5126;

/// Binary data and how it is cut up.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Appends vectors of equal length and returns their accessor.
    fn push(
        &mut self,
        kind: &str,
        width: usize,
        values: &[f32],
        bounds: Option<[f32; 2]>,
    ) -> usize {
        let first = self.bytes.len();
        self.bytes
            .extend(values.iter().flat_map(|value| value.to_le_bytes()));
        self.views.push(json!({
            "buffer": 0, "byteOffset": first, "byteLength": self.bytes.len() - first,
        }));
        let mut accessor = json!({
            "bufferView": self.views.len() - 1, "componentType": FLOAT,
            "count": values.len() / width, "type": kind,
        });
        if let Some([least, greatest]) = bounds {
            accessor["min"] = json!([least]);
            accessor["max"] = json!([greatest]);
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

/// The bytes of a `.glb` file with one animation of this name.
pub fn clip_to_glb(clip: &Clip, name: &str) -> Vec<u8> {
    let mut buffer = Buffer::default();
    let times: Vec<f32> = (0..clip.poses.len())
        .map(|frame| (frame as f64 / clip.frame_rate_hz) as f32)
        .collect();
    let last = times.last().copied().unwrap_or(0.0);
    let input = buffer.push("SCALAR", 1, &times, Some([0.0, last]));
    let mut samplers = Vec::new();
    let mut channels = Vec::new();
    let mut animate = |output: usize, joint: Joint, path: &str| {
        channels.push(json!({
            "sampler": samplers.len(), "target": {"node": joint.index(), "path": path},
        }));
        samplers.push(json!({"input": input, "output": output}));
    };
    let way: Vec<f32> = clip
        .poses
        .iter()
        .flat_map(|pose| pose.root_position.to_array())
        .collect();
    animate(
        buffer.push("VEC3", 3, &way, None),
        Joint::Hips,
        "translation",
    );
    for joint in Joint::ALL {
        let turns: Vec<f32> = clip
            .poses
            .iter()
            .flat_map(|pose| pose.rotation(joint).normalize().to_array())
            .collect();
        animate(buffer.push("VEC4", 4, &turns, None), joint, "rotation");
    }
    // Axes are parallel in the T-pose: the joints' places are all there is to undo.
    let mut places = [Vec3::ZERO; JOINT_COUNT];
    let mut bind = Vec::with_capacity(16 * JOINT_COUNT);
    for joint in Joint::ALL {
        let parent = joint
            .parent()
            .map_or(Vec3::ZERO, |parent| places[parent.index()]);
        places[joint.index()] = parent + clip.skeleton.offset(joint);
        let to_joint = glam::Mat4::from_translation(-places[joint.index()]);
        bind.extend(to_joint.to_cols_array());
    }
    let bind = buffer.push("MAT4", 16, &bind, None);
    let nodes: Vec<Value> = Joint::ALL
        .into_iter()
        .map(|joint| node(clip, joint))
        .collect();
    let joints: Vec<usize> = (0..JOINT_COUNT).collect();
    let document = json!({
        "asset": {"version": "2.0", "generator": concat!("Footfall ", env!("CARGO_PKG_VERSION"))},
        "scene": 0,
        "scenes": [{"nodes": [Joint::Hips.index()]}],
        "nodes": nodes,
        "skins": [{"name": "Body", "joints": joints, "skeleton": 0, "inverseBindMatrices": bind}],
        "animations": [{"name": name, "samplers": samplers, "channels": channels}],
        "buffers": [{"byteLength": buffer.bytes.len()}],
        "bufferViews": buffer.views,
        "accessors": buffer.accessors,
    });
    container(document.to_string().into_bytes(), buffer.bytes)
}

fn node(clip: &Clip, joint: Joint) -> Value {
    let children: Vec<usize> = Joint::ALL
        .into_iter()
        .filter(|child| child.parent() == Some(joint))
        .map(Joint::index)
        .collect();
    let offset = clip.skeleton.offset(joint).to_array();
    let mut node = json!({"name": joint.name(), "translation": offset});
    if !children.is_empty() {
        node["children"] = children.into();
    }
    node
}

/// Header, JSON chunk padded with spaces, binary chunk padded with zeros.
fn container(mut json: Vec<u8>, mut binary: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let mut bytes = b"glTF".to_vec();
    let word = |bytes: &mut Vec<u8>, value: usize| {
        bytes.extend((value as u32).to_le_bytes());
    };
    word(&mut bytes, 2);
    word(&mut bytes, 12 + 8 + json.len() + 8 + binary.len());
    word(&mut bytes, json.len());
    bytes.extend(b"JSON");
    bytes.extend(json);
    word(&mut bytes, binary.len());
    bytes.extend(b"BIN\0");
    bytes.extend(binary);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{Pose, Skeleton};
    use glam::Quat;

    #[test]
    fn an_independent_reader_finds_the_same_motion() {
        let skeleton = Skeleton::standard();
        let poses: Vec<Pose> = (0..5)
            .map(|frame| {
                let mut pose = Pose::rest(&skeleton);
                pose.root_position.z = 0.1 * frame as f32;
                pose.rotations[Joint::LeftLowerLeg.index()] =
                    Quat::from_rotation_x(0.2 * frame as f32);
                pose
            })
            .collect();
        let clip = Clip {
            skeleton,
            frame_rate_hz: 30.0,
            poses,
        };
        let glb = clip_to_glb(&clip, "walk");
        let (document, buffers, _) = gltf::import_slice(&glb).unwrap();
        let animation = document.animations().next().unwrap();
        assert_eq!(animation.name(), Some("walk"));
        assert_eq!(document.nodes().count(), JOINT_COUNT);
        let mut seen = 0;
        for channel in animation.channels() {
            let reader = channel.reader(|buffer| Some(&buffers[buffer.index()]));
            let times: Vec<f32> = reader.read_inputs().unwrap().collect();
            assert!((times[4] - 4.0 / 30.0).abs() < 1e-6);
            let name = channel.target().node().name().unwrap_or_default();
            match reader.read_outputs().unwrap() {
                gltf::animation::util::ReadOutputs::Translations(way) => {
                    assert_eq!(name, "Hips");
                    assert!((way.last().unwrap()[2] - 0.4).abs() < 1e-6);
                    seen += 1;
                }
                gltf::animation::util::ReadOutputs::Rotations(turns) if name == "LeftLowerLeg" => {
                    let last = turns.into_f32().last().unwrap();
                    assert!(
                        Quat::from_array(last).angle_between(Quat::from_rotation_x(0.8)) < 1e-3
                    );
                    seen += 1;
                }
                _ => {}
            }
        }
        assert_eq!(seen, 2);
    }
}
