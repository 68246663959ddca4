extends TestCase
## Baked clips: played by an AnimationPlayer on a skeleton without any node of the add-on.

const RATE := 60.0
const SAD := "res://addons/footfall/models/sad.footstyle"


## A scene's root with a skeleton under it, and its generator in `walker.gait`.
func _character(configure := Callable()) -> Walker:
	var walker := Walker.new()
	if configure.is_valid():
		configure.call(walker)
	add_child(walker.build())
	walker.skeleton.name = "Skeleton3D"
	walker.skeleton.owner = walker
	return walker


func _baked(walker: Walker, seconds: float, styles: PackedStringArray, speeds: PackedFloat32Array) -> AnimationLibrary:
	var library := walker.gait.bake(seconds, styles, speeds)
	check(library != null, "a library")
	return library


## Takes the add-on away and lets a player play.
func _player(walker: Walker, library: AnimationLibrary, clip: StringName) -> AnimationPlayer:
	if walker.gait != null:
		walker.gait.free()
		walker.gait = null
	walker.skeleton.reset_bone_poses()
	var player := AnimationPlayer.new()
	walker.add_child(player)
	player.add_animation_library(&"", library)
	player.root_motion_track = library.get_meta(&"root_motion_track")
	player.callback_mode_process = AnimationMixer.ANIMATION_CALLBACK_MODE_PROCESS_MANUAL
	player.play(clip)
	return player


## One frame: poses, and the way that the root went.
func _advance(walker: Walker, player: AnimationPlayer, delta := 1.0 / RATE) -> Vector3:
	player.advance(delta)
	var travel := player.get_root_motion_position()
	walker.translate_object_local(travel)
	walker.bones_before = walker.bones.duplicate()
	for joint: String in Walker.BODY:
		var bone := walker.skeleton.find_bone(walker.prefix + joint)
		walker.bones[joint] = walker.skeleton.global_transform * walker.skeleton.get_bone_global_pose(bone)
	return travel


func test_clips_are_named_and_loop() -> void:
	var walker := _character(func(made: Walker) -> void: made.gait.styles = [load(SAD)])
	var library := _baked(walker, 4.0, [], [0.9, 1.3])
	var names := Array(library.get_animation_list()).map(func(name: StringName) -> String: return name)
	names.sort()
	check_equal(names, ["idle_neutral", "idle_sad", "walk_neutral_0.9", "walk_neutral_1.3", "walk_sad_0.9", "walk_sad_1.3"], "clips")
	for name: String in names:
		var clip := library.get_animation(name)
		check_equal(clip.loop_mode, Animation.LOOP_LINEAR, "%s loops" % name)
		check_near(clip.length, 4.0, 0.8, "length of %s" % name)
	var only := _baked(walker, 2.0, ["sad"], [1.0])
	check_equal(Array(only.get_animation_list()), [&"idle_sad", &"walk_sad_1"], "only what was asked for")


func test_root_motion_is_the_speed_and_feet_stand() -> void:
	for speed: float in [0.8, 1.3, 1.6]:
		var walker := _character()
		var library := _baked(walker, 6.0, ["neutral"], [speed])
		var player := _player(walker, library, "walk_neutral_%s" % speed)
		_advance(walker, player)
		var start := walker.global_position
		var slips := PackedFloat32Array()
		var lowest := INF
		for frame: int in 900:
			_advance(walker, player)
			# One foot stands in every frame of a walk: the slower one.
			slips.append(minf(walker.slip(&"left"), walker.slip(&"right")))
			for foot: StringName in Walker.FEET:
				for point: Vector3 in walker.sole(foot):
					lowest = minf(lowest, point.y)
		var way := walker.global_position - start
		check_near(way.z, speed * 15.0, 0.02 * speed * 15.0, "way in 15 s at %s m/s" % speed)
		check_near(way.x, 0.0, 0.02, "straight ahead")
		slips.sort()
		check_below(slips[450], 0.015, "median speed of the standing foot at %s m/s" % speed)
		check_below(slips[855], 0.05, "95th percentile of it")
		check(lowest > -0.015, "soles stay above the floor: %.4f" % lowest)


func test_loops_do_not_pop() -> void:
	var walker := _character()
	walker.gait.seed = 7
	var library := _baked(walker, 3.0, ["neutral"], [1.2])
	var clip := library.get_animation(&"walk_neutral_1.2")
	var player := _player(walker, library, &"walk_neutral_1.2")
	_advance(walker, player)
	var at_seam := 0.0
	var elsewhere := 0.0
	var before := {}
	var loops := 0
	for frame: int in int(3.0 * clip.length * RATE):
		var time := player.current_animation_position
		_advance(walker, player)
		var wrapped := player.current_animation_position < time
		loops += 1 if wrapped else 0
		for joint: String in walker.bones:
			# How the velocity changes from one frame to the next shows a pop.
			var velocity := (walker.bones[joint].origin - walker.bones_before[joint].origin) * RATE
			var change: float = (velocity - before.get(joint, velocity)).length()
			before[joint] = velocity
			if wrapped:
				at_seam = maxf(at_seam, change)
			elif frame > 2:
				elsewhere = maxf(elsewhere, change)
	check(loops >= 2, "it looped: %d" % loops)
	check_below(at_seam, elsewhere * 1.2, "change of a joint's velocity at the seam, against the greatest elsewhere")


func test_saved_and_loaded_it_is_the_same() -> void:
	var walker := _character()
	var library := _baked(walker, 1.0, ["neutral"], [1.2])
	for extension: String in ["res", "tres"]:
		var file := "user://baked.%s" % extension
		check_equal(ResourceSaver.save(library, file), OK, "saved as %s" % file)
		var loaded: AnimationLibrary = ResourceLoader.load(file, "", ResourceLoader.CACHE_MODE_IGNORE)
		check_equal(loaded.get_meta(&"root_motion_track"), library.get_meta(&"root_motion_track"), "the root's track")
		var clip := library.get_animation(&"walk_neutral_1.2")
		var again := loaded.get_animation(&"walk_neutral_1.2")
		check_equal(again.get_track_count(), clip.get_track_count(), "tracks")
		check_near(again.length, clip.length, 1e-5, "length")
		for track: int in clip.get_track_count():
			check_equal(again.track_get_path(track), clip.track_get_path(track), "path")
			check_equal(again.track_get_key_count(track), clip.track_get_key_count(track), "keys")
		DirAccess.remove_absolute(file)


func test_rigs_with_a_root_bone_and_scaled_ones() -> void:
	var walker := _character(func(made: Walker) -> void: made.between = {"Hips": "Root"})
	var library := _baked(walker, 2.0, ["neutral"], [1.2])
	check_equal(library.get_meta(&"root_motion_track"), NodePath("Skeleton3D:Root"), "the topmost bone travels")
	var player := _player(walker, library, &"walk_neutral_1.2")
	var way := Vector3.ZERO
	for frame: int in 600:
		way += _advance(walker, player)
	check_near(way.length(), 12.0, 0.24, "way of the root bone")
	var small := _character(func(made: Walker) -> void: made.skeleton.scale = Vector3.ONE * 0.5)
	library = _baked(small, 2.0, ["neutral"], [0.6])
	player = _player(small, library, &"walk_neutral_0.6")
	way = Vector3.ZERO
	for frame: int in 600:
		way += _advance(small, player)
	check_near(way.z, 6.0, 0.12, "a scaled skeleton's way is in metres")


func test_baking_changes_nothing() -> void:
	var walker := _character()
	var other := _character()
	walker.walk(30)
	other.walk(30)
	_baked(walker, 1.0, [], [1.0])
	walker.walk(30)
	other.walk(30)
	check_equal(walker.bones, other.bones, "the walk goes on as it would have")


func test_what_cannot_be_baked_is_said() -> void:
	var walker := _character()
	begin_expected_errors()
	check(walker.gait.bake(4.0, ["angry"], [1.0]) == null, "an unknown style")
	check(walker.gait.bake(-1.0, [], [1.0]) == null, "no length")
	check(walker.gait.bake(NAN, [], [1.0]) == null, "no number")
	check(walker.gait.bake(4.0, [], [0.0]) == null, "no speed")
	var alone := GaitGenerator3D.new()
	check(alone.bake(4.0, [], [1.0]) == null, "no skeleton")
	alone.free()
	end_expected_errors()
