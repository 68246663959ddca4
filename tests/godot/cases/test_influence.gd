extends TestCase
## `influence` of every node, keyed from 0 to 1 and back: what the skeleton shows in the end goes no faster than legs do.

const DT := 1.0 / 60.0
## Faster than any foot of a walk, m/s.
const FASTEST_MPS := 7.0


## A walker with a `FootPlacement3D`, of which the pose is read that the skeleton shows, after the engine has blended it.
func _walker() -> Walker:
	var walker := Walker.new()
	walker.gait.seed = 1
	walker.build().add_placement()
	walker.skeleton.skeleton_updated.connect(walker._read_bones)
	add_child(walker)
	return walker


## Steps of 15 by 30 cm up and down again, from two metres ahead.
func _stairs() -> void:
	_box(Vector3(0, -0.5, 0), Vector3(40, 1, 40))
	for step: int in 8:
		var height := 0.15 * mini(step + 1, 8 - step)
		_box(Vector3(0, 0.5 * height, 2.15 + 0.3 * step), Vector3(4, height, 0.3))


func _box(place: Vector3, size: Vector3) -> void:
	var body := StaticBody3D.new()
	var shape := CollisionShape3D.new()
	var box := BoxShape3D.new()
	box.size = size
	shape.shape = box
	body.add_child(shape)
	body.position = place
	add_child(body)


## Walks over the stairs while `influence` of a node goes as `keyed` says; returns the fastest that any foot went, m/s.
func _fastest(walker: Walker, node: Node, keyed: Callable) -> float:
	var fastest := 0.0
	for frame: int in 360:
		node.set(&"influence", keyed.call(frame * DT))
		walker.step(DT)
		if frame > 1:
			for joint: String in ["LeftFoot", "RightFoot", "LeftToes", "RightToes"]:
				var way := walker.bones[joint].origin.distance_to(walker.bones_before[joint].origin)
				fastest = maxf(fastest, way / DT)
	return fastest


func test_placement_in_between_never_jumps() -> void:
	_stairs()
	await get_tree().physics_frame
	await get_tree().physics_frame
	for influence: float in [0.0, 0.25, 0.5, 0.75, 0.999]:
		var walker := _walker()
		var fastest := _fastest(walker, walker.skeleton.get_node(^"FootPlacement3D"), func(_time: float) -> float: return influence)
		check_below(fastest, FASTEST_MPS, "fastest foot at %.3f, m/s" % influence)
		walker.free()


func test_placement_is_keyed_from_nothing_to_all_and_back() -> void:
	_stairs()
	await get_tree().physics_frame
	await get_tree().physics_frame
	var walker := _walker()
	var keyed := func(time: float) -> float: return 0.5 - 0.5 * cos(2.0 * time)
	var fastest := _fastest(walker, walker.skeleton.get_node(^"FootPlacement3D"), keyed)
	check_below(fastest, FASTEST_MPS, "fastest foot, m/s")


func test_placement_is_half_way_at_a_half() -> void:
	# A ramp across: one foot has to go up and the other down.
	_box(Vector3.ZERO, Vector3(0.01, 0.01, 0.01))
	var body := StaticBody3D.new()
	var shape := CollisionShape3D.new()
	shape.shape = WorldBoundaryShape3D.new()
	body.add_child(shape)
	body.rotation.z = 0.2
	add_child(body)
	await get_tree().physics_frame
	await get_tree().physics_frame
	var heights := {}
	for influence: float in [0.0, 0.5, 1.0]:
		var walker := _walker()
		walker.gait.speed = 0.0
		var placement: FootPlacement3D = walker.skeleton.get_node(^"FootPlacement3D")
		placement.influence = influence
		placement.follow_ground = false
		walker.walk(60)
		heights[influence] = walker.joint("LeftFoot").y - walker.joint("RightFoot").y
		walker.free()
	check(absf(heights[1.0] - heights[0.0]) > 0.02, "placement moves feet: %s" % heights)
	check_near((heights[0.5] - heights[0.0]) / (heights[1.0] - heights[0.0]), 0.5, 0.15, "half of the way, but for a leg that comes to its end")


func test_a_generator_is_keyed_over_other_animation() -> void:
	var walker := Walker.new()
	walker.gait.seed = 1
	add_child(walker.build())
	walker.skeleton.skeleton_updated.connect(walker._read_bones)
	walker.gait.modification_processed.disconnect(walker._read_bones)
	var keyed := func(time: float) -> float: return 0.5 - 0.5 * cos(2.0 * time)
	check_below(_fastest(walker, walker.gait, keyed), FASTEST_MPS, "fastest foot, m/s")


func test_placement_in_between_never_jumps_in_frames_of_the_engine() -> void:
	_stairs()
	await get_tree().physics_frame
	await get_tree().physics_frame
	var walker := _walker()
	walker.skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_IDLE
	var placement: FootPlacement3D = walker.skeleton.get_node(^"FootPlacement3D")
	placement.influence = 0.5
	var farthest := [0.0, 0]
	walker.skeleton.skeleton_updated.connect(func() -> void:
		farthest[1] += 1
		if farthest[1] > 2:
			for joint: String in ["LeftFoot", "RightFoot"]:
				farthest[0] = maxf(farthest[0], walker.bones[joint].origin.distance_to(walker.bones_before[joint].origin)))
	var start := Time.get_ticks_msec()
	while Time.get_ticks_msec() - start < 3000:
		await get_tree().process_frame
	check(farthest[1] > 60, "the engine went on")
	check_below(farthest[0], 0.5, "how far a foot went in a frame at most, metres")
