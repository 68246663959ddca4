//! Work in the studio: from recordings to files that the other tools read.

use crate::world::{Window, World, base, begin_with, click, saved_style, settle, shipped};
use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, ViewportEvent};
use egui_kittest::kittest::Queryable as _;
use footfall_motion::bvh;
use footfall_motion::contact_file::ContactFile;
use footfall_motion::recording::Recording;
use footfall_motion::retarget::RetargetOptions;

#[test]
fn a_broken_file_is_listed_with_its_error_and_does_not_stop_the_rest() {
    let world = World::new();
    let mut window = world.window(&[world.clips()]);
    assert!(window.query_by_label("1 broken").is_some());
    click(&mut window, "broken.bvh");
    settle(&mut window);
    let message = window.state().message().unwrap().to_owned();
    assert!(
        message.contains("broken.bvh") && message.contains("line"),
        "{message}"
    );
    click(&mut window, "ben_1.bvh");
    settle(&mut window);
    assert!(window.query_by_label_contains("Export glTF").is_some());
}

#[test]
fn the_list_is_searched_by_words() {
    let world = World::new();
    let mut window = world.window(&[world.clips()]);
    let search = window.get_by_role(Role::TextInput);
    search.focus();
    search.type_text("anna 2");
    window.run_steps(3);
    assert!(window.query_by_label("anna_2.bvh").is_some());
    assert!(window.query_by_label("anna_1.bvh").is_none());
    assert!(window.query_by_label("1 of 5").is_some());
}

#[test]
fn a_motion_is_exported_for_other_programs() {
    let world = World::new();
    let mut window = world.window(&[world.clip("anna/anna_2.bvh")]);
    for (label, name) in [("Export BVH…", "out.bvh"), ("Export glTF…", "out.glb")] {
        click(&mut window, label);
        assert!(window.state_mut().answer_dialog(world.clip(name)));
        window.run_steps(2);
    }
    let [own, out] =
        ["anna/anna_2.bvh", "out.bvh"].map(|name| bvh::read(world.clip(name)).unwrap());
    assert_eq!(own.frame_count, out.frame_count);
    assert_eq!(&std::fs::read(world.clip("out.glb")).unwrap()[..4], b"glTF");
}

#[test]
fn corrected_contacts_are_saved_beside_the_clip_and_taken_by_training() {
    let world = World::new();
    let path = world.clip("anna/anna_2.bvh");
    let before = Recording::read(&path, &RetargetOptions::default()).unwrap();
    let mut window = world.window(std::slice::from_ref(&path));
    click(&mut window, "Labels");
    // Drags the end of the first stance of the left foot to the right.
    let (from, to) = (Pos2::new(448.5, 466.0), Pos2::new(470.0, 466.0));
    window.hover_at(from);
    window.run_steps(2);
    window.drag_at(from);
    window.run_steps(2);
    window.hover_at(to);
    window.run_steps(2);
    window.drop_at(to);
    window.run_steps(3);
    assert!(
        window.query_by_label("• unsaved labels").is_some(),
        "nothing was dragged"
    );
    click(&mut window, "Save");
    assert!(window.query_by_label("• unsaved labels").is_none());
    assert!(ContactFile::beside(&path).is_file());
    let after = Recording::read(&path, &RetargetOptions::default()).unwrap();
    assert!(after.is_corrected);
    let [old, new] = [&before, &after].map(|r| r.contacts.feet[0].stances[0].last);
    assert!(new > old + 4, "{old} {new}");
    assert_eq!(
        before.contacts.feet[1].stances,
        after.contacts.feet[1].stances
    );
}

/// Adds a stance where the right foot swings.
fn correct(window: &mut Window) {
    click(window, "Labels");
    window.state_mut().seek(0.48);
    window.run_steps(2);
    click(window, "Add right stance");
}

#[test]
fn an_edit_is_taken_back_and_made_again() {
    let world = World::new();
    let mut window = world.window(&[world.clip("anna/anna_2.bvh")]);
    correct(&mut window);
    assert!(window.query_by_label("• unsaved labels").is_some());
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_steps(3);
    assert!(window.query_by_label("• unsaved labels").is_none());
    click(&mut window, "Redo");
    assert!(window.query_by_label("• unsaved labels").is_some());
    click(&mut window, "As detected");
    assert!(window.query_by_label("• unsaved labels").is_none());
}

#[test]
fn unsaved_labels_survive_a_crash() {
    let world = World::new();
    let paths = [world.clip("anna/anna_2.bvh")];
    {
        let mut window = world.window(&paths);
        correct(&mut window);
        // The window goes away without a word.
    }
    let mut window = world.window(&paths);
    click(&mut window, "Labels");
    click(&mut window, "Recover");
    assert!(window.query_by_label("• unsaved labels").is_some());
    click(&mut window, "Save");
    drop(window);
    let mut window = world.window(&paths);
    click(&mut window, "Labels");
    assert!(
        window.query_by_label("Recover").is_none(),
        "saved labels need no recovery"
    );
}

#[test]
fn closing_with_unsaved_labels_asks() {
    let world = World::new();
    let mut window = world.window(&[world.clip("anna/anna_2.bvh")]);
    correct(&mut window);
    let ask_to_close = |window: &mut Window| {
        let input = window.input_mut();
        let id = input.viewport_id;
        let viewport = input.viewports.entry(id).or_default();
        viewport.events.push(ViewportEvent::Close);
        window.step();
        window
            .input_mut()
            .viewports
            .get_mut(&id)
            .unwrap()
            .events
            .clear();
        window.run_steps(2);
    };
    ask_to_close(&mut window);
    assert!(window.query_by_label("Labels are not saved").is_some());
    click(&mut window, "Stay");
    assert!(window.query_by_label("Labels are not saved").is_none());
    ask_to_close(&mut window);
    click(&mut window, "Save and close");
    assert!(ContactFile::beside(&world.clip("anna/anna_2.bvh")).is_file());
}

#[test]
fn a_style_is_made_from_recordings_and_saved() {
    let world = World::new();
    let mut window = world.window(&[world.clips()]);
    click(&mut window, "Train");
    click(&mut window, "Make the style");
    settle(&mut window);
    let style = saved_style(&mut window, "Save the style…", world.clip("mine.footstyle"));
    assert_eq!((style.name.as_str(), style.provenance.steps), ("mine", 12));
    base().styled(&[(&style, 1.0)]).unwrap();
}

#[cfg(unix)]
#[test]
fn work_that_is_cancelled_says_so_and_shows_nothing() {
    let world = World::new();
    let mut window = world.evaluation_window(2);
    // It is not done before the click, however busy the machine is.
    let held = world.hold("proud_1.bvh");
    click(&mut window, "Run the evaluation");
    click(&mut window, "Cancel");
    held.let_go();
    settle(&mut window);
    let message = window.state().message().unwrap();
    assert!(message.contains("stopped"), "{message}");
    assert!(window.query_by_label("Export CSV…").is_none());
}

#[test]
fn a_style_is_designed_without_a_recording_of_it() {
    let world = World::new();
    let mut window = world.window(&[world.clips(), world.clip("ben/ben_2.bvh")]);
    click(&mut window, "Design");
    begin_with(&mut window, "proud");
    click(&mut window, "Make the style");
    settle(&mut window);
    let style = saved_style(&mut window, "Save style…", world.clip("proud.footstyle"));
    assert_eq!(style.name, "proud");
    click(&mut window, "On the mixing pad");
    window.run_steps(30);
    assert!(window.query_by_label("Add style…").is_some());
    assert!(
        window
            .state()
            .message()
            .is_some_and(|said| said.contains("written"))
    );
}

#[test]
fn a_recorded_sensor_moves_a_body() {
    let world = World::new();
    let mut window = world.sensor_window();
    window.run_steps(300);
    let walk = window.get_by_label_contains("Worn at").rect();
    assert!(walk.is_positive());
    assert!(
        window.state().behaviours()[1] > 0.8,
        "{:?}",
        window.state().behaviours()
    );
}

#[test]
fn a_style_for_another_model_is_refused_with_its_reason() {
    let world = World::new();
    let mut window = world.window(&[shipped("sad.footstyle")]);
    assert!(window.state().message().is_none());
    let path = world.clip("half.footstyle");
    let bytes = std::fs::read(shipped("sad.footstyle")).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let context = window.ctx.clone();
    window.state_mut().open(&context, &path);
    window.run_steps(2);
    let message = window.state().message().unwrap();
    assert!(message.contains("half.footstyle"), "{message}");
}

/// Presses or releases the main button of the mouse.
fn press(window: &Window, pos: Pos2, pressed: bool) {
    window.event(Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    });
}

#[test]
fn the_plot_moves_the_playhead() {
    let world = World::new();
    let mut window = world.window(&[world.clip("anna/anna_2.bvh")]);
    let at = Pos2::new(900.0, 680.0);
    window.hover_at(at);
    window.run_steps(2);
    press(&window, at, true);
    window.run_steps(2);
    press(&window, at, false);
    window.run_steps(2);
    let secs = window.state().playhead_secs();
    assert!((4.0..5.5).contains(&secs), "{secs}");
}
