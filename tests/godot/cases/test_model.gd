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


func test_with_an_empty_model_it_rests_and_says_what_to_load() -> void:
	var walker := Walker.new().build(false)
	add_child(walker)
	walker.gait.model = GaitModel.new()
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


func test_files_load_as_they_are() -> void:
	var folder := DirAccess.create_temp("footfall_files")
	var bytes := (load(Walker.MODEL) as GaitModel).data
	_write(folder.get_current_dir() + "/good.footfall", bytes)
	_write(folder.get_current_dir() + "/damaged.footfall", bytes.slice(0, bytes.size() - 9))
	_write(folder.get_current_dir() + "/other.footstyle", "something else".to_utf8_buffer())
	var good: GaitModel = load(folder.get_current_dir() + "/good.footfall")
	check_equal(good.data, bytes, "a whole file is what it holds")
	check_equal(good.get_error(), "", "and has no error")
	begin_expected_errors()
	var damaged: GaitModel = load(folder.get_current_dir() + "/damaged.footfall")
	var other: GaitStyle = load(folder.get_current_dir() + "/other.footstyle")
	var missing := load(folder.get_current_dir() + "/missing.footimu")
	end_expected_errors()
	check(not damaged.get_error().is_empty(), "a scene with a damaged file opens, and the model says what it is")
	check_contains(other.get_error(), "not a Footfall", "a file that is no style says so")
	check(missing == null, "no file is no model")


func test_a_file_that_changes_is_taken_up() -> void:
	var folder := DirAccess.create_temp("footfall_files")
	var path := folder.get_current_dir() + "/walk.footfall"
	_write(path, (load(Walker.MODEL) as GaitModel).data)
	var model: GaitModel = load(path)
	_write(path, FileAccess.get_file_as_bytes("res://addons/footfall/models/walk.footdyn"))
	check(not model.is_switching(), "the first is a trained walk")
	ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_REPLACE)
	check(model.is_switching(), "the resource that everybody has holds the new file")


func _write(path: String, bytes: PackedByteArray) -> void:
	var file := FileAccess.open(path, FileAccess.WRITE)
	file.store_buffer(bytes)
	file.close()
