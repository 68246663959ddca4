extends TestCase
## Travel is told in full, by any clock and at any frame rate; one node for each skeleton; sizes that change; influence.


## Adds up what it is told in each frame of its clocks.
class Asker:
	extends Node
	var gait: GaitGenerator3D
	var by_physics := Transform3D.IDENTITY
	var by_process := Transform3D.IDENTITY
	var by_skeleton := Transform3D.IDENTITY
	var differ := 0

	func _physics_process(_delta: float) -> void:
		var delta := gait.get_root_motion_delta()
		by_physics *= delta
		if gait.get_root_motion_delta() != delta:
			differ += 1

	func _process(_delta: float) -> void:
		var delta := gait.get_root_motion_delta()
		by_process *= delta
		if gait.get_root_motion_delta() != delta:
			differ += 1

	func _on_modified() -> void:
		by_skeleton *= gait.get_root_motion_delta()


func _asked(mode: Skeleton3D.ModifierCallbackModeProcess, seconds: float) -> Asker:
	var walker := add_walker(func(made: Walker) -> void:
		made.gait.root_motion = false
		made.gait.turn_rate = 0.6)
	walker.skeleton.modifier_callback_mode_process = mode
	var asker := Asker.new()
	asker.gait = walker.gait
	add_child(asker)
	walker.gait.modification_processed.connect(asker._on_modified)
	var start := Time.get_ticks_msec()
	while Time.get_ticks_msec() - start < seconds * 1000.0:
		await get_tree().process_frame
	asker.set_process(false)
	asker.set_physics_process(false)
	walker.gait.modification_processed.disconnect(asker._on_modified)
	walker.gait.playing = false
	return asker


func _check_clocks(mode: Skeleton3D.ModifierCallbackModeProcess, what: String) -> void:
	var asker: Asker = await _asked(mode, 0.7)
	check(asker.by_skeleton.origin.length() > 0.1, "%s: it went somewhere: %.2f m" % [what, asker.by_skeleton.origin.length()])
	for told: Transform3D in [asker.by_physics, asker.by_process]:
		# One frame may be told in the frame to come.
		check_below(told.origin.distance_to(asker.by_skeleton.origin), 0.12, what + ": the same way")
		var apart := told.basis.get_rotation_quaternion().angle_to(asker.by_skeleton.basis.get_rotation_quaternion())
		check_below(apart, 0.06, what + ": the same heading")
	check_equal(asker.differ, 0, what + ": asked twice in a frame it says the same")


func test_every_clock_is_told_the_same_way_at_any_rate() -> void:
	var physics := Engine.physics_ticks_per_second
	var drawn := Engine.max_fps
	for rates: Array in [[60, 30], [60, 60], [60, 120], [30, 60], [120, 60]]:
		Engine.physics_ticks_per_second = rates[0]
		Engine.max_fps = rates[1]
		await _check_clocks(Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_IDLE, "idle at %s" % [rates])
		await _check_clocks(Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_PHYSICS, "physics at %s" % [rates])
	Engine.physics_ticks_per_second = physics
	Engine.max_fps = drawn


func test_slow_motion_shortens_the_way_by_as_much() -> void:
	Engine.time_scale = 0.25
	Engine.max_fps = 60
	await _check_clocks(Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_IDLE, "in slow motion")
	Engine.time_scale = 1.0
	Engine.max_fps = 0


func test_by_hand_it_is_the_last_advance() -> void:
	var walker := add_walker(func(made: Walker) -> void: made.gait.root_motion = false)
	var told := Transform3D.IDENTITY
	var ways := [Transform3D.IDENTITY]
	walker.gait.modification_processed.connect(func() -> void: ways[0] *= walker.gait.get_root_motion_delta())
	for frame: int in 120:
		walker.step(1.0 / 60.0)
		told *= walker.gait.get_root_motion_delta()
	check(told.origin.z > 1.5, "it went on: %s" % told.origin)
	check_equal(ways[0], told, "in the signal and after it")


func test_without_influence_nothing_travels() -> void:
	var walker := add_walker()
	walker.gait.influence = 0.0
	walker.walk(60, func() -> void:
		check_equal(walker.gait.get_root_motion_delta(), Transform3D.IDENTITY, "no delta"))
	check_equal(walker.position, Vector3.ZERO, "the character stays")
	walker.gait.influence = 0.5
	walker.walk(120)
	var half := walker.position.length()
	walker.gait.influence = 1.0
	walker.walk(120)
	var whole := walker.position.length() - half
	check_near(half / whole, 0.5, 0.06, "half of the way at half influence")


func test_the_first_of_two_generators_walks() -> void:
	var alone := add_walker()
	var both := add_walker()
	var second := GaitGenerator3D.new()
	second.name = "Second"
	second.model = both.gait.model
	begin_expected_errors()
	both.skeleton.add_child(second)
	both.walk(120)
	end_expected_errors()
	alone.walk(120)
	check_equal(both.position, alone.position, "as far as with one")
	check_equal(both.bones, alone.bones, "in the same pose")
	check_contains(second.get_problems()[0], "already walks the same Skeleton3D", "the second one's problem")
	check_contains(second.get_problems()[0], "Remove one of the two", "what to do")
	check_equal(both.gait.get_problems(), PackedStringArray(), "the first one has none")
	both.gait.active = false
	var place := both.position
	both.walk(60)
	check(both.position.distance_to(place) > 0.3, "the second walks when the first does not")


func test_a_seed_of_zero_is_a_seed_of_ones_own() -> void:
	var scene := Node3D.new()
	scene.name = "Crossing"
	add_child(scene)
	var first := _march(scene, 50)
	check_equal(first.seeds.size(), 50, "fifty seeds")
	for seed_of_one: int in first.seeds:
		check(seed_of_one != 0, "no seed is 0")
	# In lockstep all first steps would come in the same frame.
	check(first.frames.size() > 8, "first steps come in many frames: %d" % first.frames.size())
	check(first.most < 15, "and few in the same one: %d" % first.most)
	scene.free()
	scene = Node3D.new()
	scene.name = "Crossing"
	add_child(scene)
	check_equal(_march(scene, 50).seeds, first.seeds, "run again, the same walks")


## Lets duplicates walk for a second and tells their seeds, and how many first steps each frame had.
func _march(scene: Node3D, count: int) -> Dictionary:
	var walkers: Array[Walker] = []
	for index: int in count:
		var walker := Walker.new()
		walker.name = "Walker%d" % index
		scene.add_child(walker.build())
		walker.gait.seed = 0
		walkers.append(walker)
	var seeds := {}
	var frames := {}
	for walker: Walker in walkers:
		for frame: int in 60:
			walker.step(1.0 / 60.0)
			if walker.footsteps.size() == 1:
				frames[frame] = frames.get(frame, 0) + 1
				break
		seeds[walker.gait.get_effective_seed()] = true
	return {"seeds": seeds, "frames": frames, "most": frames.values().max()}


func test_a_saved_walk_keeps_its_seed_elsewhere() -> void:
	var walker := add_walker()
	walker.gait.seed = 0
	walker.walk(100)
	var other := add_walker()
	other.gait.seed = 0
	check(walker.gait.get_effective_seed() != other.gait.get_effective_seed(), "two walks")
	other.gait.set_state(walker.gait.get_state())
	other.walk(1, Callable(), 0.0)
	check_equal(other.gait.get_effective_seed(), walker.gait.get_effective_seed(), "the seed comes with the state")
	for frame: int in 300:
		walker.step(1.0 / 60.0)
		other.step(1.0 / 60.0)
		check_equal(other.bone_poses, walker.bone_poses, "and the walk goes on alike")
	walker.gait.seed = 12
	check_equal(walker.gait.get_effective_seed(), 12, "a seed that was given")


func test_a_size_that_is_animated_is_walked_through() -> void:
	var walker := add_walker()
	var placement := FootPlacement3D.new()
	walker.skeleton.add_child(placement)
	walker.walk(60)
	# A second each: 1 to 0 to 2 to 0 to 1.
	var sizes := [1.0, 0.0, 2.0, 0.0, 1.0]
	for part: int in 4:
		for frame: int in 61:
			walker.scale = Vector3.ONE * lerpf(sizes[part], sizes[part + 1], frame / 60.0)
			walker.step(1.0 / 60.0)
			check(walker.global_position.is_finite(), "its place stays finite")
			for pose: Transform3D in walker.bone_poses:
				check(pose.is_finite(), "poses stay finite")
	walker.scale = Vector3.ONE
	walker.walk(30)
	walker.footsteps.clear()
	var start := walker.global_position
	walker.walk(300)
	check_near(walker.global_position.distance_to(start) / 5.0, 1.3, 0.2, "then it walks as before")
	check(walker.footsteps.size() > 5, "with footsteps")
	walker.scale = Vector3.ZERO
	walker.walk(30)
	walker.scale = Vector3(1.0, 0.0, 1.0)
	walker.walk(30)


func test_a_character_that_is_born_with_no_size_walks_once_it_has_one() -> void:
	var walker := add_walker(func(made: Walker) -> void: made.scale = Vector3.ZERO)
	walker.walk(10)
	for frame: int in 30:
		walker.scale = Vector3.ONE * (frame + 1) / 30.0
		walker.step(1.0 / 60.0)
	walker.walk(120)
	var start := walker.global_position
	walker.walk(300)
	check_near(walker.global_position.distance_to(start) / 5.0, 1.3, 0.2, "as fast as others")


func test_growing_does_not_pop() -> void:
	var walker := add_walker()
	walker.walk(60)
	var knee := walker.bone_poses[walker.skeleton.find_bone("LeftLowerLeg")].basis.get_rotation_quaternion()
	for frame: int in 120:
		walker.scale = Vector3.ONE * minf(1.0 + frame / 60.0, 1.5)
		walker.step(1.0 / 60.0)
		var now := walker.bone_poses[walker.skeleton.find_bone("LeftLowerLeg")].basis.get_rotation_quaternion()
		check_below(knee.angle_to(now), 0.25, "the knee's turn in a frame")
		knee = now
