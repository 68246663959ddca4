@tool
extends EditorPlugin
## Tests of the add-on's half in the editor: `cargo xtask open tests/godot -- --headless --editor -- --editor-tests`.

const SCRATCH := "res://scratch"
const CONTROLLER := "res://addons/footfall/controller/gait_character_3d.tscn"
const SCENE := SCRATCH + "/walker.tscn"
const RECORDING := "res://../data/walker_1_fast.bvh"
const STYLE := "res://styles/dock_test.footstyle"
const HERO := SCRATCH + "/hero.tscn"
const HERO_FILES: Array[String] = [SCRATCH + "/hero_file.glb", SCRATCH + "/hero_file.fbx"]
const LONE_ANIMATION := SCRATCH + "/walk.res"
const PATIENCE_SECS := 60.0

var _failed := 0
var _passed := 0


func _enter_tree() -> void:
	if "--editor-tests" in OS.get_cmdline_user_args():
		_run.call_deferred()


func _run() -> void:
	# The first scan imports what there is.
	await _until(func() -> bool: return not EditorInterface.get_resource_filesystem().is_scanning(), "the first scan")
	await get_tree().create_timer(0.5).timeout
	var dock := _only("FootfallStyleDock", EditorInterface.get_base_control())
	if dock:
		await _test_dock(dock)
		await _test_dock_takes_animations(dock)
		for file: String in HERO_FILES:
			await _test_dock_takes_an_imported_file(dock, file)
		await _test_scene(dock)
		await _test_controller()
		await _test_hot_reload()
	DirAccess.remove_absolute(ProjectSettings.globalize_path(STYLE))
	DirAccess.remove_absolute(ProjectSettings.globalize_path(STYLE + ".uid"))
	DirAccess.remove_absolute(ProjectSettings.globalize_path(STYLE.get_base_dir()))
	for file: String in HERO_FILES:
		DirAccess.remove_absolute(ProjectSettings.globalize_path(file))
		DirAccess.remove_absolute(ProjectSettings.globalize_path(file + ".import"))
	for file: String in [SCENE, HERO, LONE_ANIMATION]:
		DirAccess.remove_absolute(ProjectSettings.globalize_path(file))
	DirAccess.remove_absolute(ProjectSettings.globalize_path(SCRATCH))
	print("%d passed, %d failed" % [_passed, _failed])
	get_tree().quit(1 if _failed > 0 or _passed == 0 else 0)


## The controller shows its character in the editor, and a scene that holds it keeps nothing of that.
func _test_controller() -> void:
	var level := Node3D.new()
	var player: Node3D = (load(CONTROLLER) as PackedScene).instantiate()
	level.add_child(player)
	player.owner = level
	add_child(level)
	_check("\n".join(player.call(&"_get_configuration_warnings")).contains("Character Scene"), "the controller says what it lacks")
	player.set(&"character_scene", Skinned.scene())
	await get_tree().process_frame
	_check(player.call(&"_get_configuration_warnings").is_empty(), "with a character it lacks nothing")
	_check(player.get_node(^"Figure").get_child_count() == 1, "the character is seen")
	var packed := PackedScene.new()
	packed.pack(level)
	_check(packed.get_state().get_node_count() == 2, "nothing of it is saved: %d nodes" % packed.get_state().get_node_count())
	level.queue_free()


func _test_dock(dock: Node) -> void:
	_check(dock.default_slot == EditorDock.DOCK_SLOT_BOTTOM, "the dock leaves the inspector alone")
	_check((dock as Control).get_combined_minimum_size().y < 120.0, "and needs little height")
	dock.call(&"make")
	_check(dock.call(&"get_message").contains("Add recordings"), "nothing is made of nothing")
	dock.call(&"add_recordings", PackedStringArray([RECORDING, RECORDING]))
	dock.call(&"make")
	_check(dock.call(&"get_message").contains("name"), "a style has a name")
	dock.call(&"set_style_name", "Dock Test")

	dock.call(&"make")
	_check(dock.call(&"is_working"), "it works in the background")
	dock.call(&"cancel")
	await _until(func() -> bool: return not dock.call(&"is_working"), "cancelling")
	_check(dock.call(&"get_message").contains("stopped"), "it says that it was cancelled: " + dock.call(&"get_message"))
	_check(not FileAccess.file_exists(STYLE), "nothing was written")

	dock.call(&"make")
	await _until(func() -> bool: return not dock.call(&"is_working"), "making a style")
	_check(dock.call(&"get_message").contains("steps at"), "the style is told of: " + dock.call(&"get_message"))
	_check(FileAccess.file_exists(STYLE), "the style was written")
	await _until(func() -> bool: return ResourceLoader.exists(STYLE), "the style's file")
	_check(load(STYLE) is GaitStyle, "the project has it")
	var stage := _only("FootfallWalkerView", dock)
	_check(stage and stage.is_visible_in_tree() == dock.is_visible_in_tree(), "someone walks in it")
	dock.call(&"remove_selected")
	dock.call(&"make")
	_check(dock.call(&"get_message").contains("Add recordings"), "a recording can be removed")


## A character of the project with its loops on the spot, and a loop without a character.
func _test_dock_takes_animations(dock: Node) -> void:
	var walk := GameClip.loop(self, 1.05)
	DirAccess.make_dir_recursive_absolute(ProjectSettings.globalize_path(SCRATCH))
	ResourceSaver.save(GameClip.scene({Walk = walk, Idle = GameClip.still(walk)}), HERO)
	ResourceSaver.save(walk, LONE_ANIMATION)
	var list: ItemList = dock.find_children("*", "ItemList", true, false)[0]
	dock.call(&"add_recordings", PackedStringArray([LONE_ANIMATION]))
	_check(dock.call(&"get_message").contains("Open the scene of its character"), "a lone animation: " + dock.call(&"get_message"))
	_check(list.item_count == 0, "it is not taken without a skeleton")
	EditorInterface.open_scene_from_path(HERO)
	await _until(_is_open.bind(HERO), "the hero's scene")
	dock.call(&"add_recordings", PackedStringArray([LONE_ANIMATION, HERO]))
	_check(dock.call(&"get_message").is_empty(), "both are taken: " + dock.call(&"get_message"))
	var items := range(list.item_count).map(func(item: int) -> String: return list.get_item_text(item))
	_check(items == ["walk.res", "hero.tscn#Idle", "hero.tscn#Walk"], "every animation is listed: %s" % [items])
	dock.call(&"make")
	await _until(func() -> bool: return not dock.call(&"is_working"), "making a style of animations")
	var message: String = dock.call(&"get_message")
	_check(message.contains("4 steps at 1.0"), "the style has the loops' speed: " + message)
	_check(message.contains("A thin style") and message.contains("hero.tscn#Idle"), "it is told to be thin: " + message)
	dock.call(&"remove_selected")


## A character in a file, as it is bought or downloaded: the editor imports it, and the dock takes what became of it.
func _test_dock_takes_an_imported_file(dock: Node, file: String) -> void:
	var walk := GameClip.loop(self, 1.05)
	var error := GameClip.write_file(self, {Walk = walk, Idle = GameClip.still(walk)}, file)
	_check(error == OK, "%s is written: %s" % [file, error_string(error)])
	var files := EditorInterface.get_resource_filesystem()
	files.scan()
	await _until(func() -> bool: return not files.is_scanning() and files.get_filesystem_path(SCRATCH) != null, "the scan that finds the folder")
	if not ResourceLoader.exists(file):
		files.update_file(file)
		files.reimport_files([file])
	_check(ResourceLoader.exists(file) and load(file) is PackedScene, "the editor imports " + file)
	var list: ItemList = dock.find_children("*", "ItemList", true, false)[0]
	dock.call(&"add_recordings", PackedStringArray([file]))
	_check(dock.call(&"get_message").is_empty(), "it is taken: " + dock.call(&"get_message"))
	var items := range(list.item_count).map(func(item: int) -> String: return list.get_item_text(item))
	var shown := file.get_file()
	_check(items == [shown + "#Idle", shown + "#Walk"], "its animations are listed: %s" % [items])
	dock.call(&"make")
	await _until(func() -> bool: return not dock.call(&"is_working"), "making a style of an imported file")
	var message: String = dock.call(&"get_message")
	_check(message.contains("2 steps at 1.0"), "the style has the loop's speed: " + message)
	_check(message.contains("A thin style") and message.contains(shown + "#Idle"), "it is told to be thin, and who only stands is named: " + message)
	dock.call(&"remove_selected")


func _test_scene(dock: Node) -> void:
	_save_scene()
	EditorInterface.open_scene_from_path(SCENE)
	await _until(_is_open.bind(SCENE), "the scene")
	var character: Node3D = EditorInterface.get_edited_scene_root()
	var gait: GaitGenerator3D = character.find_children("*", "GaitGenerator3D")[0]

	var own := gait.model
	gait.model = GaitModel.new()
	_check(gait.model.resource_path.ends_with("locomotion.footfall"), "a new model is the shipped one: " + gait.model.resource_path)
	gait.model = own

	EditorInterface.get_selection().clear()
	dock.call(&"give_to_selected")
	_check(dock.call(&"get_message").contains("Select"), "it says what to select")
	EditorInterface.get_selection().add_node(gait)
	dock.call(&"give_to_selected")
	_check(gait.styles.size() == 1 and gait.style_weights == PackedFloat32Array([1.0]), "the walker wears the style")
	var undo := EditorInterface.get_editor_undo_redo()
	undo.get_history_undo_redo(undo.get_object_history_id(gait)).undo()
	_check(gait.styles.is_empty() and gait.style_weights.is_empty(), "and takes it off again")

	EditorInterface.edit_node(gait)
	await get_tree().create_timer(0.5).timeout
	var bar := _only("FootfallPreviewBar", EditorInterface.get_base_control())
	if bar:
		var slider: HSlider = bar.find_children("*", "HSlider", true, false)[0]
		var play: Button = bar.find_children("*", "Button", true, false)[0]
		slider.value = 5.0
		await get_tree().create_timer(0.3).timeout
		_check(absf(gait.call(&"get_time") - 5.0) < 1e-3, "the slider goes to a time: %f" % gait.call(&"get_time"))
		_check(character.position == Vector3.ZERO, "nobody travels in the editor")
		_check(gait.playing, "the preview leaves the property alone")
		play.pressed.emit()
		await get_tree().create_timer(0.5).timeout
		_check(gait.call(&"get_time") > 5.05, "it plays on")
	_check(not gait.get_gizmos().is_empty(), "there is a gizmo")
	var packed := PackedScene.new()
	packed.pack(character)
	ResourceSaver.save(packed, SCENE)
	_check(not FileAccess.get_file_as_string(SCENE).contains("preview"), "nothing of the preview is saved")


## Rebuilds the library while the editor is open, as a developer of the add-on does.
func _test_hot_reload() -> void:
	var character: Node3D = EditorInterface.get_edited_scene_root()
	var gait: GaitGenerator3D = character.find_children("*", "GaitGenerator3D")[0]
	var model := gait.model
	var speed := gait.speed
	GDExtensionManager.reload_extension("res://addons/footfall/footfall.gdextension")
	await get_tree().create_timer(1.0).timeout
	_check(is_instance_valid(gait) and gait.speed == speed and gait.model == model, "properties outlive a hot reload")
	_check(ResourceLoader.load(STYLE, "", ResourceLoader.CACHE_MODE_IGNORE) is GaitStyle, "files load after a hot reload")
	var before: float = gait.call(&"get_time")
	await get_tree().create_timer(0.5).timeout
	_check(gait.call(&"get_time") > before, "it walks on after a hot reload")
	var dock := _only("FootfallStyleDock", EditorInterface.get_base_control())
	if dock:
		dock.call(&"make")
		_check(dock.call(&"get_message").contains("Add recordings"), "the dock works after a hot reload")


## A character built as the tests build theirs, as a scene.
func _save_scene() -> void:
	DirAccess.make_dir_recursive_absolute(ProjectSettings.globalize_path(SCRATCH))
	var walker := Walker.new().build()
	var root := Node3D.new()
	root.name = "Character"
	walker.skeleton.reparent(root, false)
	walker.skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_IDLE
	for signal_name: StringName in [&"footstep", &"modification_processed"]:
		for connection: Dictionary in walker.gait.get_signal_connection_list(signal_name):
			walker.gait.disconnect(signal_name, connection["callable"])
	walker.skeleton.owner = root
	walker.gait.owner = root
	var packed := PackedScene.new()
	packed.pack(root)
	ResourceSaver.save(packed, SCENE)
	root.free()
	walker.free()


func _is_open(scene: String) -> bool:
	var root := EditorInterface.get_edited_scene_root()
	return root != null and root.scene_file_path == scene


func _only(type: String, under: Node) -> Node:
	var found := under.find_children("*", type, true, false)
	_check(found.size() == 1, "there is one %s" % type)
	return found[0] if found else null


func _until(done: Callable, what: String) -> void:
	var waited := 0.0
	while not done.call():
		await get_tree().process_frame
		waited += get_process_delta_time()
		if waited > PATIENCE_SECS:
			_check(false, "in vain: " + what)
			return


func _check(holds: bool, what: String) -> void:
	if holds:
		_passed += 1
		print("ok     ", what)
	else:
		_failed += 1
		print("FAILED ", what)
