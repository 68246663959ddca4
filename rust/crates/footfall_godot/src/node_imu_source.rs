//! `NodeImuSource`: an object of the game for a sensor, such as a headset or a tracker.

use crate::convert;
use glam::{Quat, Vec3};
use godot::classes::{IResource, Node3D, Resource, XrCamera3D, XrNode3D};
use godot::prelude::*;

/// Uses a node as a sensor: an `XRController3D` or `XRNode3D` of a tracker on the belt or a foot, an `XRCamera3D`, or any `Node3D` that moves like a part of a body.
///
/// The source computes the measurements of a sensor on the node from its motion; the body follows 34 ms later. Keep 60 frames per second or more. The sensor's axes are
/// those of the node seen along its -Z: with the mounting `Aligned`, the node's -Z axis points ahead and its y axis up while the person stands.
///
/// XR nodes are read relative to their `XROrigin3D`: a vehicle, a thumbstick or a teleport that moves the origin does not move the body. Other nodes are read
/// in world space; a teleport restarts the source.
#[derive(GodotClass)]
#[class(tool, init, base = Resource)]
pub(crate) struct NodeImuSource {
    /// Path to the node from the `ImuReconstructor3D`; an absolute path works as well.
    #[export(node_path = ("Node3D"))]
    #[var(set = set_node)]
    node: NodePath,

    base: Base<Resource>,
}

#[godot_api]
impl IResource for NodeImuSource {}

#[godot_api]
impl NodeImuSource {
    #[func]
    fn set_node(&mut self, node: NodePath) {
        self.node = node;
        self.base_mut().emit_changed();
    }
}

impl NodeImuSource {
    /// Position and orientation of the node, with the axes of a sensor: x left, y up, z ahead. `None` without a node.
    pub(crate) fn pose(&self, listener: &Gd<Node>) -> Option<(Vec3, Quat)> {
        let node = self.find(listener).ok()?;
        let in_room = node.is_class(&XrCamera3D::class_id().to_gstring())
            || node.is_class(&XrNode3D::class_id().to_gstring());
        let transform = if in_room {
            node.get_transform()
        } else {
            node.get_global_transform()
        };
        if convert::is_flat(transform) {
            return None;
        }
        let turn = convert::quat(transform.basis.orthonormalized().get_quaternion());
        Some((
            convert::vec3(transform.origin),
            turn * Quat::from_rotation_y(core::f32::consts::PI),
        ))
    }

    /// Problem with the node, for the user of the source.
    pub(crate) fn problem(&self, listener: &Gd<Node>) -> Option<String> {
        listener
            .is_inside_tree()
            .then(|| self.find(listener).err())
            .flatten()
    }

    fn find(&self, listener: &Gd<Node>) -> Result<Gd<Node3D>, String> {
        if self.node.is_empty() {
            return Err("the NodeImuSource has no node. Set its Node".to_owned());
        }
        listener
            .try_get_node_as::<Node3D>(&self.node)
            .ok_or_else(|| {
                format!(
                    "the NodeImuSource finds no Node3D at \"{}\" from {}. Set its Node",
                    self.node,
                    listener.get_name()
                )
            })
    }
}
