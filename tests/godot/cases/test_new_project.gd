extends TestCase
## Encounters of a new user: nodes that were given no model, files of a project that no editor has opened, Godot that starts itself.

const SWITCHING := "res://addons/footfall/models/walk.footdyn"
const STYLE := "res://addons/footfall/models/proud.footstyle"
const PATIENCE_MSECS := 20_000


func test_a_generator_without_a_model_walks_with_the_shipped_one() -> void:
	var plain := Walker.new().build(false)
	var given := Walker.new().build()
	for walker: Walker in [plain, given]:
		add_child(walker)
		walker.walk(120)
	check(plain.gait.model == null, "the property stays as it was set")
	check_equal(plain.gait.get_problems(), PackedStringArray(), "it has no problem")
	check(plain.global_position.z > 1.0, "it walks")
	check_equal(plain.bone_poses, given.bone_poses, "as with the shipped model")


func test_a_crowd_without_a_model_uses_the_shipped_one() -> void:
	var crowd := GaitCrowd3D.new()
	check_equal(crowd.get_problems().size(), 1, "a crowd lacks one thing")
	check_contains(crowd.get_problems()[0], "character", "which is no model")
	crowd.free()


func test_nodes_that_the_editor_adds_are_given_a_model() -> void:
	for type: StringName in [&"GaitGenerator3D", &"GaitCrowd3D", &"ImuReconstructor3D"]:
		var model := ClassDB.class_get_property_list(type).filter(
			func(property: Dictionary) -> bool: return property.name == "model"
		)
		check(model[0].usage & PROPERTY_USAGE_EDITOR_INSTANTIATE_OBJECT != 0, type + " asks the editor for one")


func test_a_switching_model_passes_over_styles_and_walks() -> void:
	var plain := Walker.new().build(false)
	var styled := Walker.new().build(false)
	for walker: Walker in [plain, styled]:
		add_child(walker)
		walker.gait.model = load(SWITCHING)
	styled.gait.styles = [load(STYLE), null]
	styled.gait.style_weights = PackedFloat32Array([1.0, 1.0])
	check_contains("; ".join(styled.gait.get_problems()), "has no styles", "a warning")
	for walker: Walker in [plain, styled]:
		walker.walk(120)
	check(styled.global_position.z > 0.5, "it walks")
	check_equal(styled.bone_poses, plain.bone_poses, "plainly")


func test_files_load_on_threads() -> void:
	var paths := PackedStringArray()
	for file: String in ResourceLoader.list_directory("res://addons/footfall/models"):
		paths.append("res://addons/footfall/models".path_join(file))
	for path: String in paths:
		ResourceLoader.load_threaded_request(path, "", true, ResourceLoader.CACHE_MODE_IGNORE)
	for path: String in paths:
		check(ResourceLoader.load_threaded_get(path) != null, path)


func test_godot_starts_itself_as_play_does() -> void:
	var said: Array = []
	OS.execute(OS.get_executable_path(), ["--version"], said)
	check_contains(said[0], Engine.get_version_info().string.split(" ")[0].split("-")[0], "its executable is Godot")
	var started := OS.create_instance(["--headless", "--version"])
	check(started > 0, "another Godot starts")
	var begin := Time.get_ticks_msec()
	while OS.is_process_running(started) and Time.get_ticks_msec() - begin < PATIENCE_MSECS:
		await get_tree().process_frame
	check_equal(OS.get_process_exit_code(started), 0, "and ends well")
