//! Mixtures of styles on a pad, walked as they change.

mod pad;

use crate::palette;
use crate::scene::{Body, BodyPaint, Scene, SceneView};
use crate::shell::{Purpose, Shell};
use eframe::egui::{Align2, Color32, FontId, Panel, Pos2, Sense, Slider, Stroke, Ui, Vec2, vec2};
use footfall_core::rotation::from_heading;
use footfall_core::{Joint, Pose, Skeleton};
use footfall_model::{GaitModel, GaitStyle};
use footfall_synth::{
    Controls, GaitGenerator, GeneratorConfig, StyleSpace, WalkConfig, synthesize,
};
use footfall_train::read_model_file;
use pad::{pad_weights, places, puck_of, within_reach};
use std::path::Path;
use std::sync::Arc;

/// Range of weights on their sliders.
const WEIGHTS: core::ops::RangeInclusive<f32> = -0.5..=1.5;

/// Steps of a walk that is exported.
const EXPORTED_STEPS: usize = 20;

pub(super) struct MixPage {
    styles: Vec<Arc<GaitStyle>>,
    weights: Vec<f32>,
    /// Position of the puck, in units of the pad's radius.
    puck: Vec2,
    speed_mps: f32,
    turn_degps: f32,
    seed: u64,
    walker: Option<GaitGenerator>,
    base: Option<Arc<GaitModel>>,
    pose: Pose,
    scene: SceneView,
    problem: Option<String>,
}

impl Default for MixPage {
    fn default() -> Self {
        Self {
            styles: Vec::new(),
            weights: Vec::new(),
            puck: Vec2::ZERO,
            speed_mps: 0.0,
            turn_degps: 12.0,
            seed: 1,
            walker: None,
            base: None,
            pose: Pose::rest(&Skeleton::standard()),
            scene: SceneView::default(),
            problem: None,
        }
    }
}

impl MixPage {
    pub(super) fn add_file(&mut self, shell: &mut Shell, path: &Path) {
        match read_model_file(path, GaitStyle::from_bytes).map_err(|error| error.to_string()) {
            Ok(style) => self.add(shell, style),
            Err(error) => shell.complain(error),
        }
    }

    pub(super) fn add(&mut self, shell: &mut Shell, style: GaitStyle) {
        let Some(base) = shell.base() else {
            shell.complain(
                "choose the model that the style was made for in Train first, such as addons/footfall/models/locomotion.footfall".to_owned(),
            );
            return;
        };
        self.styles.push(Arc::new(style));
        self.weights
            .push(if self.styles.len() == 1 { 1.0 } else { 0.0 });
        self.puck = puck_of(&self.weights);
        match StyleSpace::new(&base, &self.styles) {
            Ok(_) => self.rebuild(&base),
            Err(error) => {
                self.styles.pop();
                self.weights.pop();
                shell.complain(error.to_string());
            }
        }
    }

    pub(super) fn poll(&mut self, shell: &mut Shell) {
        if let Some(path) = shell.picked(Purpose::MixStyle) {
            self.add_file(shell, &path);
        }
        if self.styles.is_empty() {
            return;
        }
        if let Some(path) = shell.picked(Purpose::SaveMix) {
            self.export(shell, &path);
        }
    }

    fn rebuild(&mut self, base: &Arc<GaitModel>) {
        let config = GeneratorConfig {
            seed: self.seed,
            phase: 0.0,
            variation: 1.0,
        };
        let made = StyleSpace::new(base, &self.styles).and_then(|space| {
            GaitGenerator::new(&Arc::new(space), &self.weights, &base.skeleton, &config)
        });
        self.base = Some(Arc::clone(base));
        match made {
            Ok(walker) => {
                if self.speed_mps == 0.0 {
                    self.speed_mps = walker.usual_speed_mps();
                }
                self.walker = Some(walker);
                self.problem = None;
            }
            Err(error) => self.problem = Some(error.to_string()),
        }
    }

    pub(super) fn show(&mut self, ui: &mut Ui, shell: &mut Shell) {
        let base = shell.base();
        if let Some(base) = &base {
            let is_other = self.base.as_ref().is_none_or(|own| !Arc::ptr_eq(own, base));
            if is_other {
                self.rebuild(base);
            }
        }
        Panel::left("mix")
            .default_size(300.0)
            .resizable(true)
            .show(ui, |ui| self.settings(ui, shell, base.as_ref()));
        if let Some(problem) = &self.problem {
            ui.colored_label(palette::BAD, problem);
        }
        let Some(walker) = &mut self.walker else {
            ui.centered_and_justified(|ui| {
                ui.weak("Choose a base model in Train to see it walk.");
            });
            return;
        };
        let controls = Controls {
            speed_mps: self.speed_mps,
            turn_rate_radps: self.turn_degps.to_radians(),
            ..Controls::STAND
        };
        walker.set_style_weights(&self.weights);
        let dt = ui.input(|input| input.stable_dt).min(0.1);
        walker.step(dt, &controls, &mut self.pose);
        ui.ctx().request_repaint();
        let place = walker.start_from_character();
        let mut pose = self.pose.clone();
        let turn = from_heading(place.heading);
        pose.root_position = place.position + turn * pose.root_position;
        let hips = Joint::Hips.index();
        pose.rotations[hips] = turn * pose.rotations[hips];
        let skeleton = base.map_or_else(Skeleton::standard, |base| base.skeleton.clone());
        let scene = Scene {
            bodies: vec![Body {
                skeleton: &skeleton,
                pose,
                look: BodyPaint::Solid,
            }],
            ..Scene::default()
        };
        let size = vec2(ui.available_width(), ui.available_height());
        self.scene.show(ui, size, &scene);
    }

    fn settings(&mut self, ui: &mut Ui, shell: &mut Shell, base: Option<&Arc<GaitModel>>) {
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            if ui.button("Add style…").clicked() {
                shell.ask(Purpose::MixStyle, "");
            }
            if ui
                .button("Export walk…")
                .on_hover_text("As .bvh or .glb")
                .clicked()
            {
                shell.ask(Purpose::SaveMix, "mixture.bvh");
            }
        });
        self.pad(ui);
        if let (Some(place), Some(base)) = (self.sliders(ui), base) {
            self.styles.remove(place);
            self.weights.remove(place);
            self.puck = puck_of(&self.weights);
            self.rebuild(base);
        }
        ui.separator();
        let range = base.map_or([0.0, 2.0], |base| base.speed_range());
        ui.add(
            Slider::new(&mut self.speed_mps, 0.0..=range[1].max(2.0) as f32)
                .max_decimals(2)
                .suffix(" m/s")
                .text("speed"),
        );
        ui.add(
            Slider::new(&mut self.turn_degps, -90.0..=90.0)
                .suffix(" °/s")
                .text("turning"),
        );
        ui.horizontal(|ui| {
            ui.label("Walker");
            let seed = ui.add(eframe::egui::DragValue::new(&mut self.seed));
            if let (true, Some(base)) = (seed.changed(), base) {
                self.rebuild(base);
            }
        });
    }

    /// A slider for each style, which the puck follows. Returns the style that is to be left out, if one is.
    fn sliders(&mut self, ui: &mut Ui) -> Option<usize> {
        let (mut left_out, mut has_slid) = (None, false);
        for (place, (style, weight)) in self.styles.iter().zip(&mut self.weights).enumerate() {
            ui.horizontal(|ui| {
                let color = palette::SERIES[place % palette::SERIES.len()];
                ui.colored_label(color, "•");
                ui.spacing_mut().slider_width = 110.0;
                let slider = Slider::new(weight, WEIGHTS).text(&style.name);
                has_slid |= ui.add(slider.max_decimals(2)).changed();
                if ui.small_button("✖").on_hover_text("Leave out").clicked() {
                    left_out = Some(place);
                }
            });
        }
        if has_slid {
            self.puck = puck_of(&self.weights);
        }
        left_out
    }

    /// The pad: styles around the plain walk. The nearer the puck is to a style, the more of it; beyond it exaggerates.
    fn pad(&mut self, ui: &mut Ui) {
        let side = ui.available_width().min(260.0);
        let (response, painter) = ui.allocate_painter(vec2(side, side), Sense::click_and_drag());
        let centre = response.rect.center();
        let radius = 0.36 * side;
        let to_screen = |at: Vec2| -> Pos2 { centre + at * radius };
        painter.rect_filled(
            response.rect,
            4.0,
            palette::backdrop(ui.visuals().dark_mode),
        );
        let rim: Vec<Pos2> = places(self.styles.len())
            .into_iter()
            .map(to_screen)
            .collect();
        let faint = Stroke::new(1.0, ui.visuals().weak_text_color().gamma_multiply(0.5));
        painter.circle_stroke(centre, radius, faint);
        painter.circle_filled(centre, 3.0, ui.visuals().weak_text_color());
        painter.text(
            centre + vec2(0.0, 8.0),
            Align2::CENTER_TOP,
            "plain",
            FontId::proportional(10.0),
            ui.visuals().weak_text_color(),
        );
        for (place, (at, style)) in rim.iter().zip(&self.styles).enumerate() {
            painter.line_segment([centre, *at], faint);
            let color = palette::SERIES[place % palette::SERIES.len()];
            painter.circle_filled(*at, 6.0, color);
            painter.text(
                *at + (*at - centre).normalized() * 14.0,
                Align2::CENTER_CENTER,
                &style.name,
                FontId::proportional(12.0),
                color,
            );
        }
        if let Some(pointer) = response.interact_pointer_pos().filter(|_| !rim.is_empty()) {
            let puck = (pointer - centre) / radius;
            self.puck = within_reach(puck);
            self.weights = pad_weights(self.puck, self.styles.len());
        }
        let puck = to_screen(self.puck);
        painter.circle_stroke(puck, 9.0, Stroke::new(2.5, palette::PLAYHEAD));
        painter.circle_filled(puck, 3.0, Color32::WHITE);
    }

    fn export(&mut self, shell: &mut Shell, path: &Path) {
        let Some(base) = shell.base() else { return };
        let weighted: Vec<(&GaitStyle, f64)> = self
            .styles
            .iter()
            .zip(&self.weights)
            .map(|(style, weight)| (style.as_ref(), f64::from(*weight)))
            .collect();
        let config = WalkConfig {
            steps: EXPORTED_STEPS,
            seed: self.seed,
            variation: 1.0,
            speed_mps: Some(self.speed_mps.max(0.2)),
            turn_rate_radps: self.turn_degps.to_radians(),
            direction_rad: 0.0,
            frame_rate_hz: None,
            from_standing: false,
            gait: footfall_synth::GaitChoice::Auto,
        };
        let walk = base
            .styled(&weighted)
            .map_err(|error| error.to_string())
            .and_then(|model| {
                let skeleton = model.skeleton.clone();
                synthesize(&Arc::new(model), &skeleton, &config).map_err(|error| error.to_string())
            });
        match walk {
            Ok(walk) => shell.write_motion(path, &walk.clip, "mixture"),
            Err(error) => shell.complain(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::Key;
    use eframe::egui::accesskit::Role;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn the_puck_follows_a_slider() {
        let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../addons/footfall/models");
        let style = |name: &str| {
            let read = read_model_file(&models.join(name), GaitStyle::from_bytes);
            Arc::new(read.unwrap())
        };
        let page = MixPage {
            styles: vec![style("sad.footstyle"), style("proud.footstyle")],
            weights: vec![0.0, 0.0],
            ..MixPage::default()
        };
        let sliders = |ui: &mut Ui, page: &mut MixPage| assert_eq!(page.sliders(ui), None);
        let mut window = Harness::new_ui_state(sliders, page);
        window.get_all_by_role(Role::Slider).next().unwrap().focus();
        window.run();
        window.key_press(Key::ArrowRight);
        window.run();
        let page = window.state();
        assert!(page.weights[0] > 0.0 && page.weights[1].abs() < 1e-6);
        // The first style is on top of the pad.
        assert!(
            page.puck.y < 0.0 && page.puck.x.abs() < 1e-6,
            "{:?}",
            page.puck
        );
    }
}
