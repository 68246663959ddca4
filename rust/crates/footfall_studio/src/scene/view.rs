//! The widget.

use super::camera::Orbit;
use super::floor;
use super::solid::Solids;
use crate::palette;
use eframe::egui::{Color32, PointerButton, Response, Sense, Stroke, Ui, Vec2};
use footfall_core::{ModelPose, Pose, Side, Skeleton, forward_kinematics};
use footfall_motion::figure::{Part, limbs};
use glam::{Quat, Vec3};

/// A body to show.
pub(crate) struct Body<'a> {
    pub(crate) skeleton: &'a Skeleton,
    pub(crate) pose: Pose,
    pub(crate) look: BodyPaint,
}

/// Styles of painting a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BodyPaint {
    Solid,
    /// Pale, and can be seen through.
    Ghost,
}

/// A foot on the ground.
pub(crate) struct Footprint {
    pub(crate) side: Side,
    /// Heel, ball and toe tip.
    pub(crate) sole: [Vec3; 3],
    /// True when the foot stands there now.
    pub(crate) stands: bool,
}

/// A sensor as a box with its axes.
pub(crate) struct SensorBox {
    pub(crate) place: Vec3,
    /// World from sensor.
    pub(crate) rotation: Quat,
}

/// Content of a scene.
#[derive(Default)]
pub(crate) struct Scene<'a> {
    pub(crate) bodies: Vec<Body<'a>>,
    pub(crate) footprints: Vec<Footprint>,
    pub(crate) sensors: Vec<SensorBox>,
}

/// A camera that is kept from frame to frame.
#[derive(Clone, Debug)]
pub(crate) struct SceneView {
    pub(crate) orbit: Orbit,
    /// True when the camera goes along with the first body.
    pub(crate) follows: bool,
}

impl Default for SceneView {
    fn default() -> Self {
        Self {
            orbit: Orbit::default(),
            follows: true,
        }
    }
}

impl SceneView {
    /// Fills `size` with the scene. Dragging orbits, the wheel zooms, a double click looks from the side.
    pub(crate) fn show(&mut self, ui: &mut Ui, size: Vec2, scene: &Scene<'_>) -> Response {
        let (response, painter) = ui.allocate_painter(size, Sense::click_and_drag());
        if response.dragged_by(PointerButton::Primary) {
            let delta = response.drag_delta();
            self.orbit.turn(delta.x, delta.y);
        }
        if response.hovered() {
            let scroll = ui.input(|input| input.smooth_scroll_delta().y);
            let pinch = ui.input(eframe::egui::InputState::zoom_delta);
            self.orbit.zoom(pinch * (0.002 * scroll).exp());
        }
        if response.double_clicked() {
            self.orbit = Orbit {
                target: self.orbit.target,
                ..Orbit::default()
            };
        }
        if let Some(body) = scene.bodies.first().filter(|_| self.follows) {
            self.orbit.target = body.pose.root_position.with_y(0.9);
        }
        let rect = response.rect;
        let dark = ui.visuals().dark_mode;
        let projection = self.orbit.projection(rect);
        floor::grid(
            &painter,
            &projection,
            self.orbit.target,
            palette::grid(dark),
        );
        for body in &scene.bodies {
            let strength = match body.look {
                BodyPaint::Solid => 1.0,
                BodyPaint::Ghost => 0.3,
            };
            floor::shadow(&painter, &projection, body.pose.root_position, strength);
        }
        for print in &scene.footprints {
            floor::footprint(&painter, &projection, print);
        }
        let mut solids = Solids::default();
        let mut model = ModelPose::default();
        for body in &scene.bodies {
            forward_kinematics(body.skeleton, &body.pose, &mut model);
            for limb in limbs(body.skeleton, &model) {
                let color = limb_color(limb.part, body.look, dark);
                // The pelvis lies inside the hips, the shoulders inside the arms.
                let nearer_m = match limb.part {
                    Part::Trunk => 0.0,
                    Part::Arm(_) | Part::Leg(_) => 0.03,
                };
                solids.capsule(&projection, &limb, color, nearer_m);
            }
        }
        for sensor in &scene.sensors {
            solids.cuboid(
                &projection,
                sensor.place,
                sensor.rotation,
                Vec3::new(0.22, 0.04, 0.14),
                palette::AXES.map(|color| color.gamma_multiply(0.9)),
            );
        }
        painter.add(solids.into_shape());
        for sensor in &scene.sensors {
            for (axis, color) in palette::AXES.into_iter().enumerate() {
                let mut ahead = Vec3::ZERO;
                ahead[axis] = 0.45;
                let ends = [sensor.place, sensor.place + sensor.rotation * ahead];
                if let Some(line) = projection.line(ends) {
                    painter.line_segment(line, Stroke::new(2.5, color));
                }
            }
        }
        response
    }
}

fn limb_color(part: Part, look: BodyPaint, dark: bool) -> Color32 {
    let color = match part {
        Part::Trunk => palette::trunk(dark),
        Part::Arm(side) => palette::side(side).lerp_to_gamma(Color32::WHITE, 0.25),
        Part::Leg(side) => palette::side(side),
    };
    if look == BodyPaint::Ghost {
        let pale = if dark {
            Color32::GRAY
        } else {
            Color32::LIGHT_GRAY
        };
        return color.lerp_to_gamma(pale, 0.6).gamma_multiply(0.45);
    }
    color
}

/// Returns the soles of a body in a pose.
pub(crate) fn soles(skeleton: &Skeleton, pose: &Pose) -> [[Vec3; 3]; 2] {
    let model = ModelPose::of(skeleton, pose);
    Side::BOTH.map(|side| footfall_motion::figure::sole_points(skeleton, &model, side))
}
