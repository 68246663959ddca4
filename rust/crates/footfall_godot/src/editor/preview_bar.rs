//! Play, pause and scrub of a walk, at the top of its node's inspector.

use crate::gait_generator_3d::GaitGenerator3D;
use godot::classes::{
    Button, Control, EditorInspectorPlugin, HBoxContainer, HSlider, IEditorInspectorPlugin,
    IHBoxContainer, Label, Object, control,
};
use godot::prelude::*;

/// Length of the walk that the slider covers, seconds.
const SHOWN_SECS: f64 = 20.0;

/// Adds the bar to the inspector of a `GaitGenerator3D`.
#[derive(GodotClass)]
#[class(tool, init, internal, base = EditorInspectorPlugin)]
pub(crate) struct FootfallPreviewInspector {
    base: Base<EditorInspectorPlugin>,
}

#[godot_api]
impl IEditorInspectorPlugin for FootfallPreviewInspector {
    fn can_handle(&self, object: Option<Gd<Object>>) -> bool {
        object.is_some_and(|object| object.try_cast::<GaitGenerator3D>().is_ok())
    }

    fn parse_begin(&mut self, object: Option<Gd<Object>>) {
        let walker = object.and_then(|object| object.try_cast::<GaitGenerator3D>().ok());
        if let Some(walker) = walker {
            let bar = FootfallPreviewBar::of(&walker);
            self.base_mut().add_custom_control(&bar);
        }
    }
}

/// Plays and scrubs one walk. What it does is not saved with the scene.
#[derive(GodotClass)]
#[class(tool, init, internal, base = HBoxContainer)]
pub(crate) struct FootfallPreviewBar {
    walker: Option<Gd<GaitGenerator3D>>,
    play: Option<Gd<Button>>,
    time: Option<Gd<HSlider>>,
    time_label: Option<Gd<Label>>,
    base: Base<HBoxContainer>,
}

impl FootfallPreviewBar {
    fn of(walker: &Gd<GaitGenerator3D>) -> Gd<Self> {
        let mut bar = Self::new_alloc();
        let mut play = Button::new_alloc();
        play.set_tooltip_text("Play or pause this walk in the editor");
        // By name: typed connections are cut, with a warning, when the library is reloaded.
        play.connect("pressed", &bar.callable("toggle"));
        let mut time = HSlider::new_alloc();
        time.set_max(SHOWN_SECS);
        time.set_step(0.01);
        time.set_h_size_flags(control::SizeFlags::EXPAND_FILL);
        time.set_v_size_flags(control::SizeFlags::SHRINK_CENTER);
        time.set_tooltip_text("Go to a time of the walk, computed with the settings below");
        time.connect("value_changed", &bar.callable("scrub"));
        let time_label = Label::new_alloc();
        for child in [
            play.clone().upcast::<Control>(),
            time.clone().upcast(),
            time_label.clone().upcast(),
        ] {
            bar.add_child(&child);
        }
        {
            let mut bar = bar.bind_mut();
            bar.walker = Some(walker.clone());
            bar.play = Some(play);
            bar.time = Some(time);
            bar.time_label = Some(time_label);
        }
        bar
    }

    fn walker(&self) -> Option<Gd<GaitGenerator3D>> {
        self.walker.clone().filter(Gd::is_instance_valid)
    }
}

#[godot_api]
impl FootfallPreviewBar {
    #[func]
    fn toggle(&mut self) {
        if let Some(mut walker) = self.walker() {
            let mut walker = walker.bind_mut();
            let paused = walker.is_preview_paused();
            walker.pause_preview(!paused);
        }
    }

    #[func]
    fn scrub(&mut self, secs: f64) {
        if let Some(mut walker) = self.walker() {
            let mut walker = walker.bind_mut();
            walker.pause_preview(true);
            walker.seek(secs);
        }
    }
}

#[godot_api]
impl IHBoxContainer for FootfallPreviewBar {
    fn process(&mut self, _delta: f64) {
        let Some(walker) = self.walker() else { return };
        let (paused, secs) = {
            let walker = walker.bind();
            (walker.is_preview_paused(), walker.get_time())
        };
        if let Some(play) = &mut self.play {
            let word = if paused { "Play" } else { "Pause" };
            if play.get_text() != word {
                play.set_text(word);
            }
        }
        if let Some(time) = &mut self.time
            && !paused
        {
            time.set_value_no_signal(secs % SHOWN_SECS);
        }
        if let Some(time_label) = &mut self.time_label {
            time_label.set_text(&format!("{secs:.2} s"));
        }
    }
}
