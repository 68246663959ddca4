extends TestCase
## GaitModel, its file and its importer.


func test_the_shipped_model_is_imported() -> void:
	var model: GaitModel = load(Walker.MODEL)
	check(model != null, "a .footfall file loads as a GaitModel")
	check_equal(model.get_error(), "", "and is whole")
	var speeds := model.get_speed_range()
	check(speeds.x > 0.2 and speeds.x < speeds.y and speeds.y < 3.5, "people's walking speeds: %s" % speeds)
	check_contains(model.description, "m/s", "it describes itself")


func test_loading_on_a_thread() -> void:
	check_equal(ResourceLoader.load_threaded_request(Walker.MODEL, "GaitModel", true, ResourceLoader.CACHE_MODE_IGNORE), OK, "request")
	while ResourceLoader.load_threaded_get_status(Walker.MODEL) == ResourceLoader.THREAD_LOAD_IN_PROGRESS:
		await get_tree().process_frame
	check_equal(ResourceLoader.load_threaded_get_status(Walker.MODEL), ResourceLoader.THREAD_LOAD_LOADED, "status")
	var model: GaitModel = ResourceLoader.load_threaded_get(Walker.MODEL)
	check_equal(model.get_error(), "", "the model is whole")


func test_a_character_is_loaded_on_a_thread_and_walks() -> void:
	var packed := PackedScene.new()
	var walker := Walker.new().build()
	walker.skeleton.owner = walker
	walker.gait.owner = walker
	check_equal(packed.pack(walker), OK, "pack")
	walker.free()
	var path := "user://walker.scn"
	check_equal(ResourceSaver.save(packed, path), OK, "save")
	ResourceLoader.load_threaded_request(path, "", true, ResourceLoader.CACHE_MODE_IGNORE)
	while ResourceLoader.load_threaded_get_status(path) == ResourceLoader.THREAD_LOAD_IN_PROGRESS:
		await get_tree().process_frame
	var scene: PackedScene = ResourceLoader.load_threaded_get(path)
	var loaded: Walker = scene.instantiate()
	# What the script makes besides what the scene holds.
	loaded.skeleton.free()
	loaded.gait.free()
	add_child(loaded)
	var skeleton: Skeleton3D = loaded.find_children("*", "Skeleton3D", true, false)[0]
	for frame: int in 30:
		skeleton.advance(1.0 / 60.0)
		skeleton.notification(Skeleton3D.NOTIFICATION_UPDATE_SKELETON)
	check(loaded.global_position.z > 0.2, "it walks")
	DirAccess.remove_absolute(ProjectSettings.globalize_path(path))


func test_properties_survive_saving() -> void:
	var walker := Walker.new().build()
	walker.gait.speed = 0.75
	walker.gait.turn_rate = 0.25
	walker.gait.direction = -1.5
	walker.gait.seed = 77
	walker.gait.phase = 0.3
	walker.gait.variation = 0.5
	walker.gait.root_motion = false
	walker.gait.playing = false
	walker.gait.owner = walker.skeleton
	var packed := PackedScene.new()
	packed.pack(walker.skeleton)
	var copy: GaitGenerator3D = packed.instantiate().get_child(0)
	for property: String in ["speed", "turn_rate", "direction", "seed", "phase", "variation", "root_motion", "playing", "model"]:
		check_equal(copy.get(property), walker.gait.get(property), property)
	copy.get_parent().free()
	walker.free()


func test_bytes_that_are_no_model_say_so() -> void:
	var good := (load(Walker.MODEL) as GaitModel).data
	var damaged := good.duplicate()
	damaged[damaged.size() >> 1] ^= 0x55
	var newer := good.duplicate()
	for name_of_bytes: Array in [
		["nothing", PackedByteArray()],
		["text", "BVH HIERARCHY".to_utf8_buffer()],
		["cut short", good.slice(0, good.size() >> 1)],
		["damaged", damaged],
	]:
		var model := GaitModel.from_bytes(name_of_bytes[1])
		check(not model.get_error().is_empty(), "%s: there is an error" % name_of_bytes[0])
		check_equal(model.get_speed_range(), Vector2.ZERO, "%s: no speeds" % name_of_bytes[0])
	check_equal(GaitModel.from_bytes(newer).get_error(), "", "the same bytes are a model")


func test_without_a_model_it_rests_and_says_what_to_load() -> void:
	var walker := Walker.new().build(false)
	add_child(walker)
	check_contains("\n".join(walker.gait.get_problems()), ".footfall", "says what to load")
	begin_expected_errors()
	walker.walk(10)
	end_expected_errors()
	check_equal(walker.global_transform, Transform3D.IDENTITY, "it stays")
	for joint: String in Walker.BODY:
		check(walker.bones[joint].is_equal_approx(walker.rest(joint)), "%s rests" % joint)
	walker.gait.model = load(Walker.MODEL)
	check_equal(walker.gait.get_problems(), PackedStringArray(), "no problem any more")
	walker.walk(60)
	check(walker.global_position.z > 0.3, "with a model it walks")


func test_with_a_damaged_model_it_rests_and_says_why() -> void:
	var walker := Walker.new().build(false)
	add_child(walker)
	walker.gait.model = GaitModel.from_bytes("no model at all".to_utf8_buffer())
	check_contains("\n".join(walker.gait.get_problems()), "cannot be used", "says so")
	begin_expected_errors()
	walker.walk(10)
	end_expected_errors()
	check_equal(walker.global_transform, Transform3D.IDENTITY, "it stays")


func test_a_model_that_is_replaced_in_place_is_taken_up() -> void:
	var bytes := (load(Walker.MODEL) as GaitModel).data
	var model := GaitModel.from_bytes(bytes)
	var walker := Walker.new().build(false)
	add_child(walker)
	walker.gait.model = model
	walker.walk(60)
	var changed := [0]
	model.changed.connect(func() -> void: changed[0] += 1)
	model.data = bytes
	walker.walk(60)
	check_equal(changed[0], 1, "the resource tells that it changed")
	check(walker.global_position.z > 1.0, "it walks on")


func test_importing_in_a_fresh_project() -> void:
	var folder := DirAccess.create_temp("footfall_import").get_current_dir()
	# The folder above is removed with its DirAccess: work beside it.
	folder += "_project"
	DirAccess.make_dir_recursive_absolute(folder)
	var project := FileAccess.open(folder + "/project.godot", FileAccess.WRITE)
	project.store_string("config_version=5\n[application]\nconfig/name=\"Import\"\n")
	project.close()
	var here := DirAccess.open(folder)
	here.create_link(ProjectSettings.globalize_path("res://addons"), folder + "/addons")
	var bytes := (load(Walker.MODEL) as GaitModel).data
	_write(folder + "/good.footfall", bytes)
	_write(folder + "/damaged.footfall", bytes.slice(0, bytes.size() - 9))
	_write(folder + "/other.footfall", "something else".to_utf8_buffer())
	var said := ""
	for run: int in 2:
		said = _godot(["--headless", "--path", folder, "--import"])
	var imported := "\n".join(DirAccess.get_files_at(folder + "/.godot/imported"))
	check_contains(imported, "good.footfall", "a whole file is imported\n" + said)
	check(not imported.contains("damaged.footfall-") or not imported.contains("damaged.footfall.res"), "a damaged one is not")
	check_contains(said, "damaged.footfall: ", "the log names the damaged file")
	check_contains(said, "other.footfall: ", "and the one that is no model")
	check(not said.contains("panicked"), "no panic")
	OS.move_to_trash(folder) if OS.get_name() == "Windows" else OS.execute("rm", ["-rf", folder])


func _write(path: String, bytes: PackedByteArray) -> void:
	var file := FileAccess.open(path, FileAccess.WRITE)
	file.store_buffer(bytes)
	file.close()


## Runs another Godot like this one, which may itself have been started through a loader or wrapper, and returns what it said.
func _godot(arguments: PackedStringArray) -> String:
	var command: PackedStringArray = [OS.get_executable_path()]
	if FileAccess.file_exists("/proc/self/cmdline"):
		var started_as := FileAccess.get_file_as_bytes("/proc/self/cmdline").get_string_from_utf8()
		var file := FileAccess.open("/proc/self/cmdline", FileAccess.READ)
		var bytes := file.get_buffer(65536)
		command = []
		for part: PackedByteArray in _split(bytes):
			started_as = part.get_string_from_utf8()
			if started_as in ["--headless", "--path", "--audio-driver"]:
				break
			command.append(started_as)
	var said: Array = []
	OS.execute(command[0], command.slice(1) + arguments, said, true)
	return said[0]


func _split(bytes: PackedByteArray) -> Array[PackedByteArray]:
	var parts: Array[PackedByteArray] = []
	var start := 0
	while start < bytes.size():
		var end := bytes.find(0, start)
		if end < 0:
			end = bytes.size()
		parts.append(bytes.slice(start, end))
		start = end + 1
	return parts
