extends TestCase
## Feet on real ground: slopes, stairs, platforms, and what a developer may get wrong.

const RATE := 60.0


## A walker with a `FootPlacement3D` below its generator.
func _walker(configure := Callable()) -> Walker:
	var walker := Walker.new()
	walker.build().add_placement().modification_processed.connect(walker._read_bones)
	if configure.is_valid():
		configure.call(walker)
	add_child(walker)
	return walker


func _placement(walker: Walker) -> FootPlacement3D:
	return walker.skeleton.get_node("FootPlacement3D")


## A box of ground with its upper side through the origin of `place`.
func _ground(place: Transform3D, size := Vector3(40, 1, 40), body: PhysicsBody3D = StaticBody3D.new()) -> PhysicsBody3D:
	var shape := CollisionShape3D.new()
	var box := BoxShape3D.new()
	box.size = size
	shape.shape = box
	shape.position.y = -0.5 * size.y
	body.add_child(shape)
	body.transform = place
	add_child(body)
	return body


func _slope(degrees: float) -> Transform3D:
	return Transform3D(Basis(Vector3.RIGHT, -deg_to_rad(degrees)), Vector3.ZERO)


## Walks and checks every standing foot against a plane through the origin.
func _check_on_plane(walker: Walker, plane: Plane, frames: int) -> void:
	var placement := _placement(walker)
	var standing := [0]
	await get_tree().physics_frame
	walker.walk(30)
	walker.walk(frames, func() -> void:
		for foot: StringName in Walker.FEET:
			var sole := walker.sole(foot)
			for point: Vector3 in sole:
				check(plane.distance_to(point) > -0.02, "no sole sinks: %.3f" % plane.distance_to(point))
			if placement.is_foot_planted(foot):
				standing[0] += 1
				check_below(absf(plane.distance_to(placement.get_foot_transform(foot).origin)), 0.005, "the lock is on the ground")
				check_below(placement.get_foot_transform(foot).basis.y.angle_to(plane.normal), deg_to_rad(3), "and in its plane")
				var nearest := INF
				for point: Vector3 in sole:
					nearest = minf(nearest, absf(plane.distance_to(point)))
				check_below(nearest, 0.01, "a standing foot touches the ground"))
	check(standing[0] > frames, "feet stand: %d" % standing[0])


func test_feet_stand_on_a_slope_uphill_and_downhill() -> void:
	for degrees: float in [20.0, -20.0]:
		var slope := _slope(degrees)
		var ground := _ground(slope)
		var walker := _walker()
		await _check_on_plane(walker, Plane(slope.basis.y, 0.0), 240)
		check(absf(walker.global_position.y - walker.global_position.z * tan(deg_to_rad(degrees))) < 0.15, "the character follows the ground")
		check_near(_placement(walker).get_grade(), tan(deg_to_rad(degrees)), 0.05, "grade")
		walker.queue_free()
		ground.queue_free()
		await get_tree().process_frame


func test_runners_run_over_hills_and_walk_where_it_is_steep() -> void:
	for degrees: float in [6.0, -8.0, 20.0, -20.0]:
		var ground := _ground(_slope(degrees), Vector3(200, 1, 200))
		var walker := _walker(func(runner: Walker) -> void: runner.gait.speed = 3.5)
		var placement := _placement(walker)
		await get_tree().physics_frame
		walker.walk(120)
		var flying := [0]
		walker.walk(180, func() -> void: flying[0] += int(not placement.is_foot_planted(&"left") and not placement.is_foot_planted(&"right")))
		var runs := absf(degrees) < 15.0
		check_equal(walker.gait.get_current_gait(), &"run" if runs else &"walk", "gait at %.0f°" % degrees)
		check(flying[0] > 30 if runs else flying[0] == 0, "frames in the air at %.0f°: %d" % [degrees, flying[0]])
		walker.free()
		ground.free()


func test_a_jump_leaves_the_ground_and_comes_back_to_it() -> void:
	for degrees: float in [0.0, 10.0]:
		var ground := _ground(_slope(degrees))
		var walker := _walker(func(jumper: Walker) -> void: jumper.gait.speed = 0.0)
		await get_tree().physics_frame
		walker.walk(60)
		var standing := walker.joint("Hips").y
		var place := walker.global_position
		check(walker.gait.jump(0.3), "it will jump")
		var heights: Array[float] = []
		var lowest := [INF]
		walker.walk(120, func() -> void:
			heights.append(walker.joint("Hips").y)
			lowest[0] = minf(lowest[0], walker.global_position.y - place.y))
		check_near(heights.max() - standing, 0.3, 0.06, "rise of the hips at %.0f°" % degrees)
		check(lowest[0] > -0.03, "the character stays above the ground: %.3f" % lowest[0])
		check_near(walker.joint("Hips").y, standing, 0.03, "it stands as before")
		check(_placement(walker).is_foot_planted(&"left") and _placement(walker).is_foot_planted(&"right"), "on both feet")
		walker.free()
		ground.free()


func test_standing_feet_do_not_slip_on_a_slope() -> void:
	var ground := _ground(_slope(15))
	var walker := _walker()
	var placement := _placement(walker)
	await get_tree().physics_frame
	walker.walk(60)
	var before := [false, false]
	walker.walk(240, func() -> void:
		for index: int in 2:
			var foot := Walker.FEET[index]
			var planted := placement.is_foot_planted(foot)
			if planted and before[index]:
				check_below(walker.slip(foot), 0.005, "slip of the %s foot" % foot)
			before[index] = planted)
	ground.queue_free()


func test_on_flat_ground_the_walk_is_as_it_was() -> void:
	var ground := _ground(Transform3D.IDENTITY)
	var walker := _walker()
	var plain := Walker.new()
	add_child(plain.build())
	await get_tree().physics_frame
	for frame: int in 240:
		walker.step(1.0 / RATE)
		plain.step(1.0 / RATE)
		for joint: String in ["Hips", "LeftFoot", "RightFoot", "LeftLowerLeg", "Head"]:
			check(walker.joint(joint).distance_to(plain.joint(joint)) < 0.012, "%s is where it was" % joint)
	ground.queue_free()


func test_signals_come_once_for_each_contact() -> void:
	var ground := _ground(_slope(8))
	var walker := _walker()
	var placement := _placement(walker)
	var planted: Array[StringName] = []
	var lifted: Array[StringName] = []
	placement.foot_planted.connect(func(foot: StringName, _place: Vector3, normal: Vector3) -> void:
		check_near(normal.length(), 1.0, 1e-4, "the normal is a unit vector")
		planted.append(foot))
	placement.foot_lifted.connect(func(foot: StringName) -> void: lifted.append(foot))
	await get_tree().physics_frame
	walker.walk(30)
	planted.clear()
	walker.footsteps.clear()
	walker.walk(300)
	check_near(planted.size(), walker.footsteps.size(), 1, "one lock for each footstep")
	for index: int in planted.size() - 1:
		check(planted[index] != planted[index + 1], "left and right take turns")
	check_near(lifted.size(), planted.size(), 1, "as many are lifted as planted")
	ground.queue_free()


func test_feet_ride_on_a_platform() -> void:
	var platform := _ground(Transform3D.IDENTITY, Vector3(8, 0.5, 8), AnimatableBody3D.new())
	(platform as AnimatableBody3D).sync_to_physics = false
	var walker := _walker(func(made: Walker) -> void: made.gait.speed = 0.0)
	var placement := _placement(walker)
	await get_tree().physics_frame
	walker.walk(10)
	var before := walker.sole(&"left")
	check_equal(placement.get_foot_support(&"left"), platform, "what it stands on")
	for frame: int in 60:
		platform.position += Vector3(0.004, 0.005, 0.0)
		platform.rotate_y(0.002)
		platform.force_update_transform()
		walker.global_position += Vector3(0.004, 0.0, 0.0)
		walker.step(1.0 / RATE)
	var moved := platform.transform * before[1]
	check(walker.sole(&"left")[1].distance_to(moved) < 0.02, "the foot rode along: %s, expected %s" % [walker.sole(&"left")[1], moved])
	check_near(walker.global_position.y, 0.3, 0.05, "the character rose with it")
	platform.queue_free()


func test_who_hangs_from_a_platform_stands_on_it() -> void:
	var platform := _ground(Transform3D(Basis.IDENTITY, Vector3(0, 0.35, 0)), Vector3(8, 0.16, 8), AnimatableBody3D.new())
	var below := _ground(Transform3D.IDENTITY)
	var walker := _walker(func(made: Walker) -> void: made.gait.speed = 0.0)
	remove_child(walker)
	platform.add_child(walker)
	await get_tree().physics_frame
	walker.walk(30)
	for foot: StringName in Walker.FEET:
		check_equal(_placement(walker).get_foot_support(foot), platform, "what it stands on")
		check_near(walker.sole(foot)[1].y, 0.35, 0.01, "its soles are on the platform")
	platform.queue_free()
	below.queue_free()


func test_stairs_take_whole_soles() -> void:
	var steps: Array[Node] = []
	for index: int in 12:
		steps.append(_ground(Transform3D(Basis.IDENTITY, Vector3(0, 0.15 * index, 0.4 * index + 1.0)), Vector3(4, 2, 0.4)))
	steps.append(_ground(Transform3D(Basis.IDENTITY, Vector3(0, 0, -9.2)), Vector3(4, 1, 20)))
	var walker := _walker()
	var placement := _placement(walker)
	await get_tree().physics_frame
	walker.walk(400, func() -> void:
		for foot: StringName in Walker.FEET:
			if placement.is_foot_planted(foot):
				var sole := placement.get_foot_transform(foot)
				var height := sole.origin.y / 0.15
				check_near(height, roundf(height), 0.05, "a locked sole is on a tread"))
	check(walker.global_position.y > 0.9, "it climbed: %s" % walker.global_position)
	for step: Node in steps:
		step.queue_free()


func test_spheres_find_the_same_ground() -> void:
	var ground := _ground(_slope(12))
	var walker := _walker(func(made: Walker) -> void: _placement(made).cast_radius = 0.03)
	await _check_on_plane(walker, Plane(_slope(12).basis.y, 0.0), 120)
	ground.queue_free()


func test_without_ground_or_in_the_air_the_walk_goes_on() -> void:
	var walker := _walker()
	walker.walk(120)
	check(walker.global_position.z > 1.0, "it walks over nothing")
	check(not _placement(walker).is_foot_planted(&"left"), "no foot is locked")
	var ground := _ground(Transform3D.IDENTITY)
	await get_tree().physics_frame
	walker.walk(60)
	_placement(walker).in_air = true
	walker.walk(30)
	for foot: StringName in Walker.FEET:
		check(not _placement(walker).is_foot_planted(foot), "in the air no foot is locked")
	ground.queue_free()


func test_any_other_animation_is_placed_too() -> void:
	var slope := _slope(10)
	var ground := _ground(slope)
	# The walk is an animation to the placement when it is not a sibling: here its poses are copied by hand.
	var copy := Walker.new()
	copy.build(false)
	copy.gait.active = false
	var placement := FootPlacement3D.new()
	placement.follow_ground = true
	copy.skeleton.add_child(placement)
	placement.modification_processed.connect(copy._read_bones)
	add_child(copy)
	var plain := Walker.new()
	add_child(plain.build())
	await get_tree().physics_frame
	var planted := 0
	for frame: int in 300:
		plain.step(1.0 / RATE)
		var height := copy.global_position.y
		copy.global_transform = plain.global_transform
		copy.global_position.y = height
		for bone: int in copy.skeleton.get_bone_count():
			copy.skeleton.set_bone_pose(bone, plain.bone_poses[bone])
		copy.step(1.0 / RATE)
		for foot: StringName in Walker.FEET:
			planted += int(placement.is_foot_planted(foot))
			for point: Vector3 in copy.sole(foot):
				var above := Plane(slope.basis.y, 0.0).distance_to(point)
				check(frame < 30 or above > -0.02, "no sole sinks: %.3f" % above)
	check(planted > 300, "feet are found standing: %d" % planted)
	ground.queue_free()


func test_warnings_say_what_to_do() -> void:
	var placement := FootPlacement3D.new()
	add_child(placement)
	check_contains(str(placement.get_problems()), "under a Skeleton3D", "no skeleton")
	placement.queue_free()
	var walker := _walker(func(made: Walker) -> void: _placement(made).collision_mask = 0)
	check_contains(str(_placement(walker).get_problems()), "Collision Mask", "no layers")
	walker.skeleton.move_child(_placement(walker), 0)
	check_contains(str(_placement(walker).get_problems()), "below the GaitGenerator3D", "wrong order")
	var bare := Walker.new()
	bare.missing = ["LeftFoot", "LeftToes"]
	bare.build()
	var on_bare := FootPlacement3D.new()
	bare.skeleton.add_child(on_bare)
	add_child(bare)
	check_contains(str(on_bare.get_problems()), "LeftFoot", "a missing bone")


func test_nonsense_is_survived() -> void:
	var ground := _ground(_slope(10))
	var walker := _walker()
	var placement := _placement(walker)
	await get_tree().physics_frame
	walker.walk(20)
	placement.max_step = NAN
	placement.max_tilt = -3.0
	placement.pelvis_half_life = 0.0
	placement.cast_radius = INF
	walker.walk(20)
	walker.step(0.0)
	walker.step(1e6)
	walker.global_position += Vector3(100, 0, 0)
	walker.walk(10)
	walker.global_position = Vector3.ZERO
	placement.reset()
	walker.walk(60)
	check(walker.joint("Hips").is_finite() and walker.joint("LeftFoot").is_finite(), "poses stay finite")
	ground.free()
	walker.walk(5)
	check(walker.joint("LeftFoot").is_finite(), "the ground went away and nothing broke")
	walker.gait.free()
	walker.walk(5)
	check(placement.is_inside_tree(), "so did the generator")
