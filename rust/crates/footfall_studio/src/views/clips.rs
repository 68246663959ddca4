//! Motion in space and as curves.

use crate::curves::CurvePanel;
use crate::motion::Motion;
use crate::playback::Playback;
use crate::scene::{Body, BodyPaint, Footprint, Scene, SceneView, soles};
use crate::shell::{Purpose, Shell};
use eframe::egui::{Panel, Ui, vec2};
use footfall_core::Side;

/// Time around the playhead for which footprints are shown, seconds.
const PRINTS_SECS: f64 = 4.0;

#[derive(Default)]
pub(crate) struct ClipsView {
    pub(crate) playback: Playback,
    pub(crate) scene: SceneView,
    curves: CurvePanel,
    opened: u64,
}

impl ClipsView {
    /// A new motion begins where it moves; a chosen name gets the motion written.
    pub(crate) fn poll(&mut self, shell: &mut Shell) {
        if self.opened != shell.opened {
            self.opened = shell.opened;
            self.playback.secs = shell.current.as_ref().map_or(0.0, Motion::start_secs);
        }
        if let Some(path) = shell.picked(Purpose::SaveMotion)
            && let Some(motion) = shell.current.take()
        {
            shell.write_motion(&path, motion.clip(), &motion.name);
            shell.current = Some(motion);
        }
    }

    pub(crate) fn show(&mut self, ui: &mut Ui, shell: &mut Shell) {
        let Some(motion) = &shell.current else {
            ui.centered_and_justified(|ui| {
                ui.weak("Choose a recording in the list, or drop one here.");
            });
            return;
        };
        let clip = motion.clip();
        let (start, end) = (motion.start_secs(), motion.duration_secs());
        self.playback.advance(ui, start, end);
        self.playback.keys(ui, start, 1.0 / clip.frame_rate_hz);
        let mut asked = None;
        ui.horizontal(|ui| {
            ui.strong(&motion.name);
            ui.weak(format!(
                "{:.1} s, {} fps, {} steps, {}",
                end,
                clip.frame_rate_hz,
                motion.recording.step_count(),
                motion.recording.retargeted.report.map
            ))
            .on_hover_text(motion.fit().to_string());
            if ui
                .small_button("Export BVH…")
                .on_hover_text("On the canonical body")
                .clicked()
            {
                asked = Some("motion.bvh");
            }
            if ui
                .small_button("Export glTF…")
                .on_hover_text("Skeleton and animation, for any engine")
                .clicked()
            {
                asked = Some("motion.glb");
            }
        });
        let mut forgets_ghost = false;
        if let Some(ghost) = &shell.ghost {
            ui.horizontal(|ui| {
                ui.weak(format!("ghost: {}", ghost.name));
                forgets_ghost = ui.small_button("✖").on_hover_text("No ghost").clicked();
            });
        }
        Panel::bottom("curves")
            .resizable(true)
            .default_size(230.0)
            .show(ui, |ui| {
                ui.add_space(4.0);
                self.playback.controls(ui, start, end, clip.frame_rate_hz);
                self.curves.choose(ui);
                let ghost = shell.ghost.as_ref();
                self.curves
                    .plot(ui, shell.opened, motion, ghost, &mut self.playback);
            });
        let size = vec2(ui.available_width(), ui.available_height());
        let scene = scene_at(motion, shell.ghost.as_ref(), self.playback.secs);
        self.scene.show(ui, size, &scene);
        if forgets_ghost {
            shell.ghost = None;
        }
        if let Some(name) = asked {
            shell.ask(Purpose::SaveMotion, name);
        }
    }
}

/// A motion and a ghost at a time. The ghost starts where the motion does and goes its own way from there.
pub(crate) fn scene_at<'a>(motion: &'a Motion, ghost: Option<&'a Motion>, secs: f64) -> Scene<'a> {
    let mut scene = Scene::default();
    let clip = motion.clip();
    let Some(pose) = clip.pose_at(secs) else {
        return scene;
    };
    scene.bodies.push(Body {
        skeleton: &clip.skeleton,
        pose,
        look: BodyPaint::Solid,
    });
    if let Some(ghost) = ghost {
        let clip = ghost.clip();
        let own = secs - motion.start_secs() + ghost.start_secs();
        let length = (ghost.duration_secs() - ghost.start_secs()).max(1e-3);
        // A ghost that is shorter begins anew.
        let own = ghost.start_secs() + (own - ghost.start_secs()).rem_euclid(length);
        if let Some(pose) = clip.pose_at(own) {
            scene.bodies.push(Body {
                skeleton: &clip.skeleton,
                pose,
                look: BodyPaint::Ghost,
            });
        }
    }
    scene.footprints = footprints(motion, secs);
    scene
}

fn footprints(motion: &Motion, secs: f64) -> Vec<Footprint> {
    let clip = motion.clip();
    let frames = |secs: f64| (secs * clip.frame_rate_hz).max(0.0) as usize;
    let (from, to) = (frames(secs - PRINTS_SECS), frames(secs + PRINTS_SECS));
    let mut prints = Vec::new();
    for side in Side::BOTH {
        for stance in &motion.recording.contacts.foot(side).stances {
            if stance.last < from || stance.first > to {
                continue;
            }
            let middle = usize::midpoint(stance.first, stance.last);
            let sole = soles(&clip.skeleton, &clip.poses[middle])[side.index()];
            prints.push(Footprint {
                side,
                sole,
                stands: stance.contains(motion.frame_at(secs)),
            });
        }
    }
    prints
}
