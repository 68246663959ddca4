//! The main views as pictures. After a change that is wanted, `UPDATE_SNAPSHOTS=1` writes them anew: look at them then.

use crate::world::{Window, World, begin_with, click, settle, shipped};
use eframe::egui::accesskit::Role;
use egui_kittest::SnapshotOptions;
use egui_kittest::kittest::Queryable as _;

/// Compares with the picture of this name. Poses may differ by roundings from machine to machine, which moves edges.
fn look(window: &mut Window, name: &str) {
    let options = SnapshotOptions::new()
        .output_path(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/snapshots"))
        .threshold(2.0)
        .failed_pixel_count_threshold(1500);
    window.snapshot_options(name, &options);
}

fn opened(world: &World) -> Window {
    let paths = [world.clips(), world.clip("anna/anna_2.bvh")];
    let mut window = world.window(&paths);
    window.state_mut().seek(1.0);
    window.run_steps(2);
    window
}

#[test]
fn nothing_is_open() {
    let world = World::new();
    look(&mut world.window(&[]), "empty");
}

#[test]
fn a_clip_in_space_and_as_curves() {
    let world = World::new();
    look(&mut opened(&world), "clips");
}

#[test]
fn contacts_on_a_timeline() {
    let world = World::new();
    let mut window = opened(&world);
    click(&mut window, "Labels");
    look(&mut window, "labels");
}

#[test]
fn a_style_as_curves_with_bands() {
    let world = World::new();
    let mut window = opened(&world);
    click(&mut window, "Train");
    click(&mut window, "Make the style");
    settle(&mut window);
    click(&mut window, "Curves");
    look(&mut window, "train_curves");
    click(&mut window, "Regression classes");
    look(&mut window, "train_classes");
}

#[test]
fn a_tree_of_contexts() {
    let world = World::new();
    let mut window = opened(&world);
    click(&mut window, "Train");
    click(&mut window, "Train a model");
    settle(&mut window);
    click(&mut window, "Decision trees");
    click(&mut window, "durations");
    look(&mut window, "train_trees");
}

#[test]
fn a_sensor_and_the_body_that_it_moves() {
    let world = World::new();
    let mut window = world.sensor_window();
    window.run_steps(200);
    look(&mut window, "sensor");
}

#[test]
fn a_sheet_on_a_walk() {
    let world = World::new();
    let mut window = opened(&world);
    click(&mut window, "Design");
    settle(&mut window);
    click(&mut window, "⏸");
    click(&mut window, "⏮");
    begin_with(&mut window, "sad");
    look(&mut window, "design_sheet");
}

#[test]
fn styles_on_the_mixing_pad() {
    let world = World::new();
    let styles = ["proud", "sad", "drunk"].map(|style| shipped(&format!("{style}.footstyle")));
    let mut window = world.window(&styles);
    window.run_steps(60);
    look(&mut window, "design_mix");
}

#[test]
fn tables_and_charts_of_an_evaluation() {
    let world = World::new();
    let mut window = world.evaluation_window(2);
    let conditions = window.get_by_role(Role::TextInput);
    conditions.focus();
    conditions.type_text("category=styled_walk");
    window.run_steps(2);
    click(&mut window, "Run the evaluation");
    settle(&mut window);
    look(&mut window, "evaluate_chart");
    click(&mut window, "Confusion, real");
    look(&mut window, "evaluate_confusion");
    click(&mut window, "Recognition");
    for (label, name, said) in [
        ("Export CSV…", "table.csv", "real,"),
        ("Export SVG…", "chart.svg", "<svg"),
    ] {
        click(&mut window, label);
        let path = world.folder.path().join(name);
        assert!(window.state_mut().answer_dialog(path.clone()));
        window.run_steps(2);
        let text = std::fs::read_to_string(path).unwrap();
        assert!(text.contains(said), "{text}");
    }
}
