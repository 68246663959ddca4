extends TestCase
## Every kind of humanoid skeleton walks the same walk.

const OPTIONAL: PackedStringArray = [
	"Chest", "UpperChest", "Neck", "LeftShoulder", "RightShoulder", "LeftToes", "RightToes",
]


## Walks both and compares the directions of the limbs and the places of the joints, frame by frame.
func _compare(walker: Walker, joints: Array, tolerance: float, frames := 90) -> void:
	var reference := add_walker()
	for frame: int in frames:
		reference.step(1.0 / 60.0)
		walker.step(1.0 / 60.0)
		for joint: String in joints:
			var apart := walker.joint(joint).distance_to(reference.joint(joint))
			check_below(apart, tolerance, "distance of %s in frame %d" % [joint, frame])
			if apart > tolerance:
				return
	check(walker.global_position.z > 0.5, "it walked")


func test_profile_axes_walk_the_same() -> void:
	var profile := SkeletonProfileHumanoid.new()
	var walker := add_walker(func(made: Walker) -> void:
		for joint: String in Walker.BODY:
			made.rest_rotations[joint] = _profile_rotation(profile, joint))
	check(walker.rest("LeftUpperArm").basis.y.dot(Vector3.RIGHT) > 0.99, "the profile's +Y points to the child")
	_compare(walker, Walker.BODY.keys(), 2e-4)


func test_arbitrary_axes_walk_the_same() -> void:
	var random := RandomNumberGenerator.new()
	random.seed = 3
	var walker := add_walker(func(made: Walker) -> void:
		for joint: String in Walker.BODY:
			made.rest_rotations[joint] = Quaternion.from_euler(
				Vector3(random.randf_range(-3, 3), random.randf_range(-3, 3), random.randf_range(-3, 3))))
	_compare(walker, Walker.BODY.keys(), 2e-4)


func test_bones_turn_as_the_joints_do_whatever_their_axes() -> void:
	var walker := add_walker(func(made: Walker) -> void:
		for joint: String in Walker.BODY:
			made.rest_rotations[joint] = Quaternion.from_euler(Vector3(0.4, -1.0, 2.0)))
	var reference := add_walker()
	for frame: int in 60:
		walker.step(1.0 / 60.0)
		reference.step(1.0 / 60.0)
	for joint: String in Walker.BODY:
		check_below(walker.turn_of(joint).angle_to(reference.turn_of(joint)), 2e-3, "turn of %s" % joint)


func test_unmapped_bones_between_are_no_obstacle() -> void:
	var walker := add_walker(func(made: Walker) -> void:
		made.between = {"Hips": "Root", "Spine": "Pelvis", "LeftLowerLeg": "LeftThighTwist"})
	_compare(walker, Walker.BODY.keys(), 2e-4)


func test_an_a_pose_rest_walks_the_same() -> void:
	var walker := add_walker(func(made: Walker) -> void:
		for side: float in [1.0, -1.0]:
			var name_of_side := "Left" if side > 0 else "Right"
			var shoulder: Vector3 = Walker.BODY[name_of_side + "UpperArm"][1]
			var lowered := Quaternion(Vector3.BACK, -0.8 * side)
			for part: String in ["LowerArm", "Hand"]:
				var joint := name_of_side + part
				made.rest_places[joint] = shoulder + lowered * (Walker.BODY[joint][1] - shoulder))
	_compare(walker, Walker.BODY.keys(), 1e-3)


func test_a_bone_map_names_foreign_bones() -> void:
	var walker := Walker.new().build()
	var map := BoneMap.new()
	map.profile = SkeletonProfileHumanoid.new()
	for joint: String in Walker.BODY:
		# Names that nobody recognises.
		walker.names[joint] = "part_%d" % walker.names.size()
		walker.skeleton.set_bone_name(walker.skeleton.find_bone(joint), walker.names[joint])
		map.set_skeleton_bone_name(joint, walker.names[joint])
	add_child(walker)
	check(not walker.gait.get_problems().is_empty(), "without the map there is a problem")
	walker.gait.bone_map = map
	check_equal(walker.gait.get_problems(), PackedStringArray(), "with the map there is none")
	_compare(walker, Walker.BODY.keys(), 1e-6)


func test_optional_bones_are_folded_in() -> void:
	var walker := add_walker(func(made: Walker) -> void: made.missing = OPTIONAL)
	check_equal(walker.gait.get_problems(), PackedStringArray(), "no problem")
	# Feet without toes make other steps: the reference has none either.
	var reference := add_walker(func(made: Walker) -> void: made.missing = ["LeftToes", "RightToes"])
	var trunk_bends := 0.0
	for frame: int in 240:
		walker.step(1.0 / 60.0)
		reference.step(1.0 / 60.0)
		# The one trunk bone has the whole trunk's rotation, the arms and the head their own.
		for pair: Array in [["Spine", "UpperChest"], ["Head", "Head"], ["LeftUpperArm", "LeftUpperArm"], ["LeftHand", "LeftHand"]]:
			check_below(walker.turn_of(pair[0]).angle_to(reference.turn_of(pair[1])), 1e-3, "turn of %s" % pair[0])
		trunk_bends = maxf(trunk_bends, reference.turn_of("Spine").angle_to(reference.turn_of("UpperChest")))
		for point: Vector3 in walker.sole(&"left"):
			check(point.y > -0.015, "a foot without toes stays above the floor: %.4f" % point.y)
	check(trunk_bends > 0.06, "the comparison tells the trunk's bones apart: %s" % trunk_bends)
	check(walker.global_position.z > 3.0, "it walked")


func test_each_optional_bone_may_be_missing_alone() -> void:
	for bone: String in OPTIONAL:
		var walker := add_walker(func(made: Walker) -> void: made.missing = [bone])
		check_equal(walker.gait.get_problems(), PackedStringArray(), "no problem without " + bone)
		walker.walk(60)
		check(walker.global_position.z > 0.5, "it walks without " + bone)


func test_required_bones_are_named_when_missing() -> void:
	var walker := Walker.new()
	walker.missing = ["LeftFoot", "LeftToes", "Head"]
	add_child(walker.build())
	var problems := "\n".join(walker.gait.get_problems())
	check_contains(problems, "LeftFoot", "names the bone")
	check_contains(problems, "Head", "names the other bone")
	check(not problems.contains("LeftToes"), "an optional bone is not asked for")
	check_contains(problems, "BoneMap", "says what to do")
	begin_expected_errors()
	walker.walk(5)
	end_expected_errors()
	check_equal(walker.global_transform, Transform3D.IDENTITY, "it stays")
	check(walker.turn_of("RightLowerLeg").get_angle() < 1e-4, "in its rest pose")


func test_a_bone_in_the_wrong_place_is_named() -> void:
	var walker := Walker.new().build()
	walker.skeleton.set_bone_parent(walker.skeleton.find_bone("LeftUpperLeg"), -1)
	add_child(walker)
	check_contains("\n".join(walker.gait.get_problems()), "LeftUpperLeg", "names the bone")
	begin_expected_errors()
	walker.walk(2)
	end_expected_errors()
	check_equal(walker.global_transform, Transform3D.IDENTITY, "it stays")


func test_a_leg_without_length_is_named() -> void:
	var walker := Walker.new()
	walker.rest_places = {"LeftFoot": Walker.BODY["LeftLowerLeg"][1]}
	add_child(walker.build())
	check_contains("\n".join(walker.gait.get_problems()), "LeftFoot", "names the joint")
	begin_expected_errors()
	walker.walk(2)
	end_expected_errors()


func test_a_lying_rest_pose_is_refused() -> void:
	var walker := Walker.new().build()
	walker.skeleton.rotation.z = PI / 2
	add_child(walker)
	check_contains("\n".join(walker.gait.get_problems()), "upright", "says that it does not stand")
	begin_expected_errors()
	walker.walk(2)
	end_expected_errors()


func test_a_scaled_skeleton_walks_in_metres() -> void:
	# A rig in centimetres under a node that scales it back.
	var walker := Walker.new()
	for joint: String in Walker.BODY:
		walker.rest_places[joint] = Walker.BODY[joint][1] * 100.0
	walker.build()
	walker.skeleton.scale = Vector3.ONE * 0.01
	add_child(walker)
	_compare(walker, Walker.BODY.keys(), 1e-3)


func test_a_rig_with_its_z_axis_up_walks_the_same() -> void:
	var to_z_up := Quaternion(Vector3.RIGHT, PI / 2)
	var walker := Walker.new()
	for joint: String in Walker.BODY:
		walker.rest_places[joint] = to_z_up * (Walker.BODY[joint][1] as Vector3)
	walker.build()
	walker.skeleton.quaternion = to_z_up.inverse()
	add_child(walker)
	_compare(walker, Walker.BODY.keys(), 2e-4)


func test_a_child_takes_shorter_steps_at_the_same_speed() -> void:
	var adult := add_walker()
	var child := add_walker(func(made: Walker) -> void: made.scale = Vector3.ONE * 0.6)
	for walker: Walker in [adult, child]:
		walker.walk(900)
		check_near(walker.global_position.z / 15.0, 1.3, 0.2, "speed in metres of the world")
	check(child.footsteps.size() > adult.footsteps.size(), "the child takes more steps: %d, %d" % [child.footsteps.size(), adult.footsteps.size()])


func test_a_character_that_faces_elsewhere_walks_where_it_faces() -> void:
	var walker := Walker.new().build()
	walker.skeleton.rotation.y = PI
	add_child(walker)
	walker.walk(120)
	check(walker.global_position.z < -1.0, "it walks along its own -Z: %s" % walker.global_position)
	check_near(walker.rotation.y, 0.0, 0.1, "and does not turn round")


func test_an_origin_at_the_hips_keeps_the_feet_on_the_floor() -> void:
	var walker := Walker.new()
	for joint: String in Walker.BODY:
		walker.rest_places[joint] = Walker.BODY[joint][1] - Vector3(0, 0.985, 0)
	walker.build()
	walker.position.y = 0.985
	add_child(walker)
	walker.walk(200)
	for footstep: Array in walker.footsteps:
		check_near(footstep[1].y, 0.0, 0.01, "footsteps on the floor")
	check(walker.footsteps.size() > 2, "it walked")


func test_fingers_and_other_bones_keep_their_pose() -> void:
	var walker := Walker.new().build()
	var finger := walker.skeleton.add_bone("LeftIndexProximal")
	walker.skeleton.set_bone_parent(finger, walker.skeleton.find_bone("LeftHand"))
	walker.skeleton.set_bone_rest(finger, Transform3D(Basis.IDENTITY, Vector3(0.1, 0, 0)))
	var bent := Quaternion(Vector3.BACK, -0.7)
	walker.skeleton.set_bone_pose_rotation(finger, bent)
	add_child(walker)
	walker.walk(30)
	check_below(walker.skeleton.get_bone_pose_rotation(finger).angle_to(bent), 1e-4, "the finger stays bent")


func test_the_pose_of_the_scene_is_left_alone() -> void:
	# Modifiers pose for the frame only: nothing is left that a scene would save.
	var walker := add_walker()
	var before: Array[Transform3D] = []
	for bone: int in walker.skeleton.get_bone_count():
		before.append(walker.skeleton.get_bone_pose(bone))
	walker.walk(30)
	for bone: int in walker.skeleton.get_bone_count():
		check(before[bone].is_equal_approx(walker.skeleton.get_bone_pose(bone)), "bone %d is as before" % bone)


static func _profile_rotation(profile: SkeletonProfileHumanoid, joint: String) -> Quaternion:
	var turned := Basis.IDENTITY
	var bone := profile.find_bone(joint)
	while bone >= 0:
		turned = profile.get_reference_pose(bone).basis * turned
		bone = profile.find_bone(profile.get_bone_parent(bone))
	return turned.get_rotation_quaternion()
