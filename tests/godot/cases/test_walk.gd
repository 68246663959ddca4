extends TestCase
## The node walks: poses, planted feet, footsteps, travel.

const RATE := 60.0


func test_pose_changes_and_hips_stay_at_a_human_height() -> void:
	var walker := add_walker()
	walker.step(1.0 / RATE)
	var knee := walker.turn_of("LeftLowerLeg")
	var most_turned := [0.0]
	var heights := PackedFloat32Array()
	walker.walk(180, func() -> void:
		most_turned[0] = maxf(most_turned[0], knee.angle_to(walker.turn_of("LeftLowerLeg")))
		heights.append(walker.joint("Hips").y))
	check(most_turned[0] > 0.4, "the knee bends by more than 0.4 rad: %.2f" % most_turned[0])
	for height: float in heights:
		check_near(height, 0.93, 0.1, "hips above the floor")


func test_arms_hang_and_the_head_stays_up() -> void:
	var walker := add_walker()
	walker.walk(60, func() -> void:
		for side: String in ["Left", "Right"]:
			check(walker.joint(side + "Hand").y < walker.joint(side + "UpperArm").y - 0.3, "hands hang")
		check_near((walker.joint("Head") - walker.joint("Hips")).normalized().y, 1.0, 0.05, "the trunk is upright"))


func test_without_speed_it_stands_and_with_speed_it_walks_off() -> void:
	var walker := add_walker(func(made: Walker) -> void:
		made.gait.speed = 0.0
		made.gait.standing_motion = 0.0)
	walker.walk(2)
	var hand := walker.joint("LeftHand")
	walker.walk(60)
	check(hand.distance_to(walker.joint("LeftHand")) < 1e-4, "it stands still")
	check(walker.footsteps.is_empty(), "it makes no steps")
	check_near(walker.joint("LeftFoot").z, walker.joint("RightFoot").z, 0.1, "feet side by side")
	walker.gait.speed = 1.2
	walker.walk(240)
	check(walker.global_position.z > 2.0, "it walks off: %s" % walker.global_position)
	walker.gait.speed = 0.0
	walker.footsteps.clear()
	walker.walk(120)
	check(walker.footsteps.size() <= 2, "it stops within two steps: %d" % walker.footsteps.size())
	var place := walker.joint("Head")
	walker.walk(60)
	check(place.distance_to(walker.joint("Head")) < 1e-4, "it stands again")


func test_left_is_left_and_forward_is_forward() -> void:
	var walker := add_walker()
	walker.walk(120, func() -> void:
		check(walker.joint("LeftUpperLeg").x > walker.joint("RightUpperLeg").x, "left hip joint at +X"))
	check(walker.global_position.z > 1.0, "it walks along +Z: %s" % walker.global_position)
	check_near(walker.global_position.x, 0.0, 0.3, "it does not drift sideways")


func test_standing_feet_do_not_move() -> void:
	var walker := add_walker()
	walker.gait.seed = 5
	walker.gait.turn_rate = 0.3
	walker.walk(2)
	var slips: Dictionary[StringName, Array] = {&"left": [], &"right": []}
	var stood: Dictionary[StringName, bool] = {&"left": false, &"right": false}
	var lowest := [INF]
	walker.walk(600, func() -> void:
		for foot: StringName in Walker.FEET:
			for point: Vector3 in walker.sole(foot):
				lowest[0] = minf(lowest[0], point.y)
			var stands := walker.gait.is_foot_on_ground(foot)
			if stands and stood[foot]:
				slips[foot].append(walker.slip(foot))
			stood[foot] = stands)
	for foot: StringName in Walker.FEET:
		slips[foot].sort()
		var count: int = slips[foot].size()
		check(count > 200, "the %s foot stands about half of the time: %d of 600 frames" % [foot, count])
		check_below(slips[foot][int(count * 0.5)], 0.005, "median speed of the standing %s foot" % foot)
		check_below(slips[foot][int(count * 0.95)], 0.03, "95th percentile of it")
	check(lowest[0] > -0.01, "soles stay above the floor: %.4f" % lowest[0])


func test_one_footstep_for_every_contact_feet_alternate() -> void:
	var walker := add_walker()
	walker.walk(1)
	walker.footsteps.clear()
	var contacts := [0]
	var stood := [walker.gait.is_foot_on_ground(&"left"), walker.gait.is_foot_on_ground(&"right")]
	walker.walk(600, func() -> void:
		for side: int in 2:
			var stands := walker.gait.is_foot_on_ground(Walker.FEET[side])
			if stands and not stood[side]:
				contacts[0] += 1
			stood[side] = stands)
	check(walker.footsteps.size() >= 12, "ten seconds have a dozen steps at least: %d" % walker.footsteps.size())
	check_near(walker.footsteps.size(), contacts[0], 1.0, "as many signals as contacts")
	for index: int in range(1, walker.footsteps.size()):
		check(walker.footsteps[index][0] != walker.footsteps[index - 1][0], "feet alternate")


func test_footsteps_are_told_where_the_foot_is() -> void:
	var walker := add_walker()
	walker.position = Vector3(7, 2, -3)
	walker.rotation.y = 2.0
	walker.gait.turn_rate = -0.4
	var told := [0]
	for frame: int in 400:
		walker.step(1.0 / RATE)
		for footstep: Array in walker.footsteps:
			if footstep.size() == 2:
				footstep.append(frame)
				check_near(footstep[1].y, 2.0, 1e-3, "on the ground")
			# A quarter of a second later the foot is flat, and its ankle is above the place that was told.
			if frame == footstep[2] + 15:
				told[0] += 1
				var ankle := walker.joint("LeftFoot" if footstep[0] == &"left" else "RightFoot")
				var apart := Vector2(ankle.x - footstep[1].x, ankle.z - footstep[1].z).length()
				check_below(apart, 0.012, "distance of the signal from the standing foot's ankle")
	check(told[0] >= 6, "footsteps came")


func test_time_zero_changes_and_tells_nothing() -> void:
	var walker := add_walker()
	walker.walk(200)
	var place := walker.global_transform
	var pose := walker.bones.duplicate()
	var told := walker.footsteps.size()
	walker.walk(50, Callable(), 0.0)
	check_equal(walker.global_transform, place, "it stays")
	check_equal(walker.bones, pose, "the pose stays")
	check_equal(walker.footsteps.size(), told, "no footsteps")
	check_equal(walker.gait.get_root_motion_delta(), Transform3D.IDENTITY, "no travel")


func test_footsteps_are_not_doubled_by_a_second_update_in_a_frame() -> void:
	var once := add_walker()
	var twice := add_walker()
	once.walk(300)
	twice.walk(300, func() -> void: twice.skeleton.notification(Skeleton3D.NOTIFICATION_UPDATE_SKELETON))
	check_equal(twice.footsteps, once.footsteps, "the same footsteps")


func test_not_playing_holds_the_pose() -> void:
	var walker := add_walker()
	walker.walk(100)
	var pose := walker.bones.duplicate()
	var told := walker.footsteps.size()
	walker.gait.playing = false
	walker.walk(100)
	check_equal(walker.bones, pose, "the pose stays")
	check_equal(walker.footsteps.size(), told, "no footsteps")
	walker.gait.playing = true
	walker.walk(20)
	check(walker.bones != pose, "it goes on")


func test_root_motion_by_the_node_and_by_the_game_agree() -> void:
	var moved := add_walker()
	var told := add_walker()
	var start := Transform3D(Basis(Vector3.UP, 0.8).scaled(Vector3.ONE * 1.25), Vector3(3, 1, -2))
	for walker: Walker in [moved, told]:
		walker.global_transform = start
		walker.gait.turn_rate = 0.5
		walker.gait.seed = 9
	told.gait.root_motion = false
	told.gait.modification_processed.connect(func() -> void:
		told.global_transform *= told.gait.get_root_motion_delta())
	for frame: int in 300:
		moved.step(1.0 / RATE)
		told.step(1.0 / RATE)
		check_below(moved.global_position.distance_to(told.global_position), 1e-3, "the same place")
		check_below(moved.quaternion.angle_to(told.quaternion), 2e-3, "the same heading")
	check(moved.global_position.distance_to(start.origin) > 2.0, "they went somewhere")
	check_equal(moved.footsteps.size(), told.footsteps.size(), "as many footsteps")
	for index: int in moved.footsteps.size():
		check_below(moved.footsteps[index][1].distance_to(told.footsteps[index][1]), 2e-3, "footsteps in the same place")


func test_without_root_motion_it_walks_in_place() -> void:
	var walker := add_walker()
	walker.gait.root_motion = false
	var travelled := [0.0]
	walker.walk(300, func() -> void:
		travelled[0] += walker.gait.get_root_motion_delta().origin.z
		check_below(Vector2(walker.joint("Hips").x, walker.joint("Hips").z).length(), 0.15, "hips near the origin"))
	check_equal(walker.global_transform, Transform3D.IDENTITY, "the character stays")
	check(travelled[0] > 4.0, "the delta tells the travel: %.2f m" % travelled[0])


func test_equal_seeds_walk_alike_and_others_do_not() -> void:
	var walkers: Array[Walker] = []
	for index: int in 3:
		var walker := add_walker()
		walker.gait.seed = [4, 4, 5][index]
		walkers.append(walker)
	var apart := [0.0]
	for frame: int in 240:
		for walker: Walker in walkers:
			walker.step(1.0 / RATE)
		check_equal(walkers[0].bones, walkers[1].bones, "equal seeds, equal poses")
		apart[0] = maxf(apart[0], walkers[0].joint("LeftFoot").distance_to(walkers[2].joint("LeftFoot")))
	check(apart[0] > 0.05, "another seed walks otherwise: %.3f m apart" % apart[0])


func test_phase_shifts_the_walk() -> void:
	var left_first := add_walker()
	var right_first := add_walker()
	right_first.gait.phase = 0.5
	left_first.walk(2)
	right_first.walk(2)
	left_first.footsteps.clear()
	right_first.footsteps.clear()
	left_first.walk(90)
	right_first.walk(90)
	check(left_first.footsteps[0][0] != right_first.footsteps[0][0], "half a stride apart, the other foot is next")


func test_speed_is_realised() -> void:
	for speed: float in [0.8, 1.3, 1.7]:
		var walker := add_walker()
		walker.gait.speed = speed
		walker.walk(120)
		var start := walker.global_position
		walker.walk(900)
		check_near(walker.global_position.distance_to(start) / 15.0, speed, 0.12 * speed, "speed")


func test_turning_is_realised_and_positive_is_left() -> void:
	for turn_rate: float in [0.5, -0.3]:
		var walker := add_walker()
		walker.gait.turn_rate = turn_rate
		walker.walk(120)
		var turned := [0.0]
		var heading := [walker.rotation.y]
		walker.walk(600, func() -> void:
			turned[0] += wrapf(walker.rotation.y - heading[0], -PI, PI)
			heading[0] = walker.rotation.y)
		check_near(turned[0] / 10.0, turn_rate, 0.2 * absf(turn_rate), "turn rate")


func test_it_goes_one_way_and_faces_another() -> void:
	for direction: float in [PI / 2.0, -PI / 2.0, PI]:
		var walker := add_walker()
		walker.gait.speed = 0.6
		walker.gait.direction = direction
		walker.walk(240)
		var start := walker.global_position
		walker.walk(600)
		var travel := walker.global_position - start
		check_near(wrapf(atan2(travel.x, travel.z) - direction, -PI, PI), 0.0, 0.12, "way")
		check_near(travel.length() / 10.0, 0.6, 0.12, "speed")
		check_near(walker.rotation.y, 0.0, 0.05, "it does not turn")


func test_seeking_goes_where_walking_gets() -> void:
	var walked := add_walker()
	walked.walk(180)
	var sought := add_walker()
	var place := sought.global_position
	sought.gait.seek(3.0)
	check_equal(sought.gait.get_time(), 0.0, "it is gone to in the next frame")
	sought.walk(1, Callable(), 0.0)
	check_near(sought.gait.get_time(), 3.0, 1e-3, "time")
	check_equal(sought.global_position, place, "nobody travels by it")
	for bone: String in walked.bones:
		var off := walked.global_transform.affine_inverse() * walked.joint(bone) - sought.global_transform.affine_inverse() * sought.joint(bone)
		check_near(off.length(), 0.0, 0.005, bone)
	for nonsense: float in [NAN, -5.0, 1e30]:
		sought.gait.seek(nonsense)
		sought.walk(1)


func test_a_long_turning_walk_keeps_the_scale() -> void:
	var walker := add_walker()
	walker.scale = Vector3.ONE * 1.5
	walker.gait.turn_rate = 1.0
	walker.walk(3000)
	check_near(walker.scale.x, 1.5, 1e-4, "scale")
	check_near(walker.global_basis.y.dot(Vector3.UP), 1.5, 1e-4, "upright")


func test_bad_settings_are_harmless() -> void:
	var walker := add_walker()
	for value: float in [NAN, INF, -INF]:
		walker.gait.speed = value
		walker.gait.turn_rate = value
		walker.gait.direction = value
		walker.gait.phase = value
		walker.gait.variation = value
	walker.gait.speed = -3.0
	check_equal(walker.gait.speed, 0.0, "negative speed")
	walker.gait.phase = -7.3
	walker.gait.variation = 1e9
	walker.gait.seed = -1
	walker.walk(30)
	walker.walk(1, Callable(), 1e6)
	walker.walk(1, Callable(), -5.0)
	walker.walk(30)
	for bone: Transform3D in walker.bones.values():
		check(bone.is_finite(), "poses stay finite")


func test_freeing_while_running() -> void:
	var walker := add_walker()
	walker.gait.footstep.connect(func(_foot: StringName, _place: Vector3) -> void: walker.gait.queue_free())
	walker.walk(120)
	check(walker.gait.is_queued_for_deletion(), "freed by its own signal")
	await get_tree().process_frame
	await get_tree().process_frame
	check(not is_instance_valid(walker.gait), "gone")
	walker.skeleton.advance(0.1)
	await get_tree().process_frame
	var other := add_walker()
	other.skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_IDLE
	await get_tree().process_frame
	other.free()
	await get_tree().process_frame
	check(not is_instance_valid(other), "the character is gone in the middle of its walk")


func test_scripts_may_change_the_node_from_its_own_signal() -> void:
	var walker := add_walker()
	walker.gait.footstep.connect(func(_foot: StringName, _place: Vector3) -> void:
		walker.gait.speed = 0.9
		walker.gait.seed += 1
		walker.gait.get_root_motion_delta()
		walker.gait.get_problems())
	walker.walk(200)
	check(walker.gait.seed > 0, "the handler ran")


func test_time_zero_before_ready() -> void:
	var walker := Walker.new().build()
	walker.skeleton.notification(Skeleton3D.NOTIFICATION_UPDATE_SKELETON)
	walker.gait.process_mode = Node.PROCESS_MODE_ALWAYS
	check_equal(walker.gait.get_root_motion_delta(), Transform3D.IDENTITY, "nothing outside the tree")
	add_child(walker)
	walker.step(0.0)
	walker.walk(60)
	check(walker.global_position.z > 0.3, "it walks once in the tree")


func test_it_runs_by_itself_every_frame() -> void:
	var walker := add_walker()
	walker.skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_IDLE
	var start := Time.get_ticks_msec()
	while Time.get_ticks_msec() - start < 600:
		await get_tree().process_frame
	check(walker.global_position.z > 0.2, "it walked: %s" % walker.global_position)


func test_moving_to_another_skeleton() -> void:
	var walker := add_walker()
	walker.walk(30)
	var other := add_walker(func(made: Walker) -> void: made.position = Vector3(5, 0, 0))
	other.gait.free()
	walker.gait.modification_processed.disconnect(walker._read_bones)
	walker.gait.reparent(other.skeleton)
	var before := other.global_position
	other.walk(60)
	check(other.global_position.z > before.z + 0.3, "the other character walks")


func test_it_jumps_when_it_is_asked_to_and_tells() -> void:
	var walker := add_walker(func(made: Walker) -> void: made.gait.speed = 0.0)
	walker.walk(30)
	var told: Array[StringName] = []
	walker.gait.took_off.connect(func() -> void: told.append(&"up"))
	walker.gait.landed.connect(func(foot: StringName) -> void: told.append(foot))
	var begin := walker.joint("Hips").y
	check(walker.gait.jump(0.3), "it will jump")
	var top := [0.0]
	walker.walk(120, func() -> void: top[0] = maxf(top[0], walker.joint("Hips").y))
	check_near(top[0] - begin, 0.3, 0.03, "rise of the hips")
	check_equal(told, [&"up", &"left", &"right"] as Array[StringName], "told")
	check_near(walker.global_position.y, 0.0, 1e-3, "on the ground again")
	check(not walker.gait.jump(0.0) and not walker.gait.jump(NAN), "no jump is none")
	check(walker.gait.jump_to(walker.global_position + Vector3(0, 0.3, 0.6)), "it jumps to a place")
	walker.walk(120)
	check_near(walker.global_position.y, 0.3, 0.01, "and is there")
	check_near(walker.global_position.z, 0.6, 0.02, "and is there")


func test_it_crouches_and_gives_way_to_pushes() -> void:
	var walker := add_walker(func(made: Walker) -> void: made.gait.speed = 0.0)
	walker.walk(30)
	var upright := walker.joint("Hips").y
	walker.gait.crouch = 1.0
	walker.walk(60)
	check_near(upright - walker.joint("Hips").y, 0.2, 0.08, "it keeps low")
	walker.gait.crouch = 0.0
	walker.walk(60)
	walker.footsteps.clear()
	walker.gait.push(Vector3(0, 0, 10))
	walker.walk(90)
	check(walker.footsteps.is_empty(), "a soft push is stood")
	walker.gait.push(Vector3(0, 0, 70))
	walker.walk(240)
	check(not walker.footsteps.is_empty(), "a hard one is stepped off")
	check(walker.global_position.z > 0.1, "its way: %s" % walker.global_position)
