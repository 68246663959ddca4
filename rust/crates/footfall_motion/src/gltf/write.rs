//! A clip as glTF, for whatever reads that: the skeleton as nodes with a skin, and its animation.
//!
//! glTF has our axes and units: metres, Y up, a character faces +Z. There is no mesh.

use super::glb::{GlbBuffer, Layout};
use footfall_core::{Clip, JOINT_COUNT, Joint};
use glam::Vec3;
use gltf::json::accessor::Type;
use serde_json::{Value, json};

/// The bytes of a `.glb` file with one animation of this name.
pub fn clip_to_glb(clip: &Clip, name: &str) -> Vec<u8> {
    let mut buffer = GlbBuffer::default();
    let times: Vec<f32> = (0..clip.poses.len())
        .map(|frame| (frame as f64 / clip.frame_rate_hz) as f32)
        .collect();
    let last = times.last().copied().unwrap_or(0.0);
    let input = buffer.push_floats(&times, Layout::floats(Type::Scalar));
    buffer.bound(input, &[0.0], &[last]);
    let mut samplers = Vec::new();
    let mut channels = Vec::new();
    let mut animate = |output: usize, joint: Joint, path: &str| {
        channels.push(json!({
            "sampler": samplers.len(), "target": {"node": joint.index(), "path": path},
        }));
        samplers.push(json!({"input": input, "output": output}));
    };
    let way: Vec<Vec3> = clip.poses.iter().map(|pose| pose.root_position).collect();
    animate(buffer.push_vectors(&way, None), Joint::Hips, "translation");
    for joint in Joint::ALL {
        let turns: Vec<f32> = clip
            .poses
            .iter()
            .flat_map(|pose| pose.rotation(joint).normalize().to_array())
            .collect();
        let turns = buffer.push_floats(&turns, Layout::floats(Type::Vec4));
        animate(turns, joint, "rotation");
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
    let bind = buffer.push_floats(&bind, Layout::floats(Type::Mat4));
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
    });
    buffer.into_file(document)
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
        let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(&glb).unwrap();
        let chunk = blob.unwrap();
        let animation = document.animations().next().unwrap();
        assert_eq!(animation.name(), Some("walk"));
        assert_eq!(document.nodes().count(), JOINT_COUNT);
        let mut seen = 0;
        for channel in animation.channels() {
            let reader = channel.reader(|_| Some(&chunk));
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
