extends TestCase
## The walk takes the body over from other animation and gives it back, without a jump and with feet that stand still.

const DT := 1.0 / 60.0


func _pose(walker: Walker, joint: String, turn: Quaternion) -> void:
	walker.skeleton.set_bone_pose_rotation(walker.skeleton.find_bone(joint), turn)


## A body that stands: arms hang, knees are a little bent.
func _idle(walker: Walker, arms := 1.3) -> void:
	_pose(walker, "LeftUpperArm", Quaternion(Vector3.BACK, -arms))
	_pose(walker, "RightUpperArm", Quaternion(Vector3.BACK, arms))
	for side: String in ["Left", "Right"]:
		_pose(walker, side + "UpperLeg", Quaternion(Vector3.RIGHT, -0.2))
		_pose(walker, side + "LowerLeg", Quaternion(Vector3.RIGHT, 0.4))
		_pose(walker, side + "Foot", Quaternion(Vector3.RIGHT, -0.2))
	var hips := walker.skeleton.find_bone("Hips")
	walker.skeleton.set_bone_pose_position(hips, Vector3(0, 0.985 - 0.84 * (1.0 - cos(0.2)), 0))


## Lets frames pass and returns the highest acceleration of any joint over the ground, m/s², and the fastest that the slower foot went, m/s.
func _watch(walker: Walker, frames: int, each := Callable()) -> Dictionary:
	var seen: Array[Dictionary] = []
	var most := 0.0
	var worst := ""
	var slip := 0.0
	for frame: int in frames:
		if each.is_valid():
			each.call(frame)
		walker.step(DT)
		var joints := {}
		for joint: String in walker.bones:
			joints[joint] = walker.joint(joint)
		seen.append(joints)
		if frame > 1:
			for joint: String in joints:
				var acceleration: float = (joints[joint] - 2.0 * seen[frame - 1][joint] + seen[frame - 2][joint]).length() / (DT * DT)
				if acceleration > most:
					most = acceleration
					worst = "%s in frame %d" % [joint, frame]
			slip = maxf(slip, minf(walker.slip(&"left"), walker.slip(&"right")))
	return {"acceleration": most, "worst": worst, "slip": slip}


func test_a_walk_begins_from_a_stand_and_feet_stay() -> void:
	var walker := add_walker()
	walker.gait.hand_over(0.0)
	walker.walk(5, func() -> void: _idle(walker))
	check(walker.gait.is_handed_over(), "the animation has the body")
	check_equal(walker.position, Vector3.ZERO, "nobody travels")
	var feet := [walker.joint("LeftFoot"), walker.joint("RightFoot")]
	var taken := [0]
	walker.gait.taken_over.connect(func() -> void: taken[0] += 1)
	walker.gait.take_over(0.4)
	var seen := _watch(walker, 120, func(_frame: int) -> void: _idle(walker))
	# A foot that is lifted off flat for the first step is the hardest.
	check_below(seen.acceleration, 110.0, "acceleration (%s)" % seen.worst)
	check_below(seen.slip, 0.05, "the foot that stands stays")
	check_equal(taken[0], 1, "it tells once that it is done")
	check(not walker.gait.is_handed_over(), "the walk has it")
	check(walker.position.z > 1.0, "it walks: %s" % walker.position)
	check(feet[0].distance_to(walker.joint("LeftFoot")) > 0.5, "feet went along")


func test_a_walk_takes_over_what_moves() -> void:
	# A dash by the game: the character travels at 1.5 m/s while another walk poses it, as a clip would. Nothing is jerked more than in
	# walks that go on at that speed.
	var own := 0.0
	for seed_of_walk: int in range(1, 5):
		var walk := add_walker()
		walk.gait.speed = 1.5
		walk.gait.seed = seed_of_walk
		own = maxf(own, _watch(walk, 240).acceleration)
	check_below(own, 110.0, "a walk that goes on")
	for begin: int in [60, 67, 74, 81, 88]:
		var clip := add_walker()
		clip.gait.speed = 1.5
		clip.gait.seed = 7
		var walker := add_walker()
		walker.gait.hand_over(0.0)
		var copy := func() -> void:
			clip.step(DT)
			walker.global_transform = clip.global_transform
			for bone: int in clip.bone_poses.size():
				walker.skeleton.set_bone_pose_rotation(bone, clip.bone_poses[bone].basis.get_rotation_quaternion())
				walker.skeleton.set_bone_pose_position(bone, clip.bone_poses[bone].origin)
		for frame: int in begin:
			copy.call()
			walker.step(DT)
		var before := [walker.bones.duplicate(), walker.bones_before.duplicate()]
		walker.gait.take_over(0.3)
		var first: Vector3 = before[0]["Hips"].origin - before[1]["Hips"].origin
		check(first.length() / DT > 0.8, "the clip moved: %.2f m/s" % (first.length() / DT))
		# A foot in the air lands within the time of the hand-over; until then the other one may have left.
		var seen := _watch(walker, 18)
		check_below(seen.acceleration, 1.1 * own, "acceleration (%s) from frame %d" % [seen.worst, begin])
		check_below(seen.slip, 0.8, "the slower foot, from frame %d" % begin)
		seen = _watch(walker, 72)
		check_below(seen.acceleration, 1.02 * own, "later acceleration (%s) from frame %d" % [seen.worst, begin])
		check_below(seen.slip, 0.3, "the foot that stands stays, from frame %d" % begin)


func test_a_walk_ends_in_an_animation() -> void:
	for begin: int in [60, 75, 90, 105]:
		var walker := add_walker()
		walker.walk(begin)
		var handed := [0]
		walker.gait.handed_over.connect(func() -> void: handed[0] += 1)
		walker.gait.hand_over(0.4)
		var seen := _watch(walker, 120, func(_frame: int) -> void: _idle(walker))
		check_equal(handed[0], 1, "it tells once that it is done")
		check(walker.gait.is_handed_over(), "the animation has the body")
		check_below(seen.acceleration, 110.0, "acceleration (%s) from frame %d" % [seen.worst, begin])
		check_below(seen.slip, 0.35, "one foot stands, from frame %d" % begin)
		for bone: int in walker.skeleton.get_bone_count():
			check_below(walker.bone_poses[bone].basis.get_rotation_quaternion().angle_to(walker.skeleton.get_bone_pose_rotation(bone)), 1e-3, "the pose is the animation's")
		var place := walker.position
		walker.walk(30)
		check_equal(walker.position, place, "nobody travels any more")
		check_equal(walker.gait.get_root_motion_delta(), Transform3D.IDENTITY, "nor is travel told")


func test_there_and_back_and_there_again() -> void:
	var walker := add_walker()
	walker.walk(60)
	for round: int in 3:
		walker.gait.hand_over(0.2)
		walker.walk(60, func() -> void: _idle(walker))
		check(walker.gait.is_handed_over(), "handed over")
		walker.gait.take_over(0.2)
		walker.walk(90, func() -> void: _idle(walker))
		check(not walker.gait.is_handed_over(), "taken over")
	# Changed in the middle.
	walker.gait.hand_over(0.5)
	walker.walk(12)
	walker.gait.take_over(0.5)
	var seen := _watch(walker, 60)
	check_below(seen.acceleration, 110.0, "acceleration (%s) when it changes its mind" % seen.worst)
	walker.gait.hand_over(NAN)
	walker.walk(2)
	walker.gait.take_over(-3.0)
	walker.walk(20)
	check(not walker.gait.is_handed_over(), "nonsense is no time at all")


func test_a_body_that_fell_elsewhere_walks_from_there() -> void:
	var walker := add_walker()
	walker.gait.hand_over(0.0)
	walker.walk(5)
	var lie := func() -> void:
		# As a ragdoll lies, three metres away.
		var hips := walker.skeleton.find_bone("Hips")
		walker.skeleton.set_bone_pose_position(hips, Vector3(2, 0.15, -2))
		walker.skeleton.set_bone_pose_rotation(hips, Quaternion(Vector3.RIGHT, -1.5))
	walker.walk(10, lie)
	walker.gait.take_over(0.8)
	var last := walker.joint("Hips")
	var most := 0.0
	for frame: int in 90:
		walker.step(DT)
		most = maxf(most, last.distance_to(walker.joint("Hips")))
		last = walker.joint("Hips")
	check_below(most, 0.06, "the hips do not jump, metres a frame")
	check_below(Vector2(walker.joint("Hips").x - walker.position.x, walker.joint("Hips").z - walker.position.z).length(), 0.15, "the character is where the body is")
	# From there it walks along +Z.
	check_near(walker.position.x, 2.0, 0.2, "where it fell: %s" % walker.position)
