extends TestCase
## Parts of the body that other animation poses while the legs walk.

const ARM: PackedStringArray = ["Shoulder", "UpperArm", "LowerArm", "Hand"]
const SPINE: PackedStringArray = ["Spine", "Chest", "UpperChest"]
const LEGS: PackedStringArray = ["Hips", "LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "LeftToes", "RightUpperLeg", "RightLowerLeg", "RightFoot", "RightToes"]


## Sets a bone's own rotation as an animation would, before the modifiers.
func _pose(walker: Walker, joint: String, turn: Quaternion) -> void:
	walker.skeleton.set_bone_pose_rotation(walker.skeleton.find_bone(joint), turn)


func _turn(walker: Walker, joint: String) -> Quaternion:
	return walker.bone_poses[walker.skeleton.find_bone(joint)].basis.get_rotation_quaternion()


func _about(axis: Vector3, angle: float) -> Quaternion:
	return Quaternion(axis, angle)


## A wave at a moment: the upper arm is raised, the lower arm swings.
func _wave(walker: Walker, time: float) -> void:
	_pose(walker, "RightShoulder", _about(Vector3.BACK, -0.2))
	_pose(walker, "RightUpperArm", _about(Vector3.BACK, -1.0) * _about(Vector3.RIGHT, 0.3))
	_pose(walker, "RightLowerArm", _about(Vector3.BACK, -0.6 + 0.5 * sin(8.0 * time)))
	_pose(walker, "RightHand", _about(Vector3.BACK, 0.3 * sin(8.0 * time)))


## Aims a rifle: the trunk is turned and bent, both arms are before the body.
func _aim(walker: Walker, time: float) -> void:
	_pose(walker, "Hips", _about(Vector3.UP, 0.3))
	_pose(walker, "Spine", _about(Vector3.UP, -0.6) * _about(Vector3.RIGHT, 0.1 + 0.02 * sin(time)))
	_pose(walker, "Chest", _about(Vector3.RIGHT, 0.1))
	_pose(walker, "UpperChest", _about(Vector3.RIGHT, 0.05))
	_pose(walker, "Neck", _about(Vector3.UP, 0.3))
	for side: String in ["Left", "Right"]:
		var sign := 1.0 if side == "Left" else -1.0
		_pose(walker, side + "UpperArm", _about(Vector3.UP, -1.2 * sign))
		_pose(walker, side + "LowerArm", _about(Vector3.UP, -0.5 * sign))


func test_at_zero_an_arm_is_the_animations_and_at_one_the_gaits() -> void:
	var plain := add_walker()
	var waving := add_walker()
	waving.gait.right_arm_weight = 0.0
	for frame: int in 240:
		var time := frame / 60.0
		_wave(waving, time)
		plain.step(1.0 / 60.0)
		waving.step(1.0 / 60.0)
		for bone: int in waving.skeleton.get_bone_count():
			var joint := waving.skeleton.get_bone_name(bone)
			if joint.begins_with("Right") and joint.trim_prefix("Right") in ARM:
				check_below(_turn(waving, joint).angle_to(waving.skeleton.get_bone_pose_rotation(bone)), 1e-3, joint + " is posed by the animation")
			else:
				check_below(_turn(waving, joint).angle_to(_turn(plain, joint)), 1e-3, joint + " walks")
	check_near(waving.position.distance_to(plain.position), 0.0, 1e-6, "it goes as far")
	waving.gait.right_arm_weight = 1.0
	for frame: int in 30:
		_wave(waving, frame / 60.0)
		plain.step(1.0 / 60.0)
		waving.step(1.0 / 60.0)
		check_equal(waving.bone_poses, plain.bone_poses, "at 1 all is the gait's")


func test_the_arm_sits_on_the_walking_chest() -> void:
	var waving := add_walker(func(made: Walker) -> void: made.gait.speed = 1.6)
	waving.gait.right_arm_weight = 0.0
	waving.walk(200, func() -> void:
		_wave(waving, 0.0)
		var chest := waving.bones["UpperChest"]
		var shoulder := chest.affine_inverse() * waving.bones["RightUpperArm"]
		var rest := waving.rest("UpperChest").affine_inverse() * waving.rest("RightShoulder")
		check_near(shoulder.origin.distance_to(rest.origin), 0.14, 0.002, "the shoulder's place on the chest"))


func test_both_arms_carry() -> void:
	var carrying := add_walker(func(made: Walker) -> void: made.gait.turn_rate = 0.5)
	carrying.gait.left_arm_weight = 0.0
	carrying.gait.right_arm_weight = 0.0
	var hands := [INF, -INF]
	for frame: int in 240:
		for side: String in ["Left", "Right"]:
			var sign := 1.0 if side == "Left" else -1.0
			_pose(carrying, side + "UpperArm", _about(Vector3.BACK, -1.3 * sign))
			_pose(carrying, side + "LowerArm", _about(Vector3.UP, -1.3 * sign))
		carrying.step(1.0 / 60.0)
		var apart := carrying.joint("LeftHand").distance_to(carrying.joint("RightHand"))
		hands = [minf(hands[0], apart), maxf(hands[1], apart)]
	check_below(hands[1] - hands[0], 0.002, "what both hands carry stays in them")


func test_an_aimed_rifle_points_where_the_animation_points_it() -> void:
	var aiming := add_walker(func(made: Walker) -> void:
		made.gait.turn_rate = 0.4
		made.gait.speed = 1.6)
	for weight: String in ["spine_weight", "head_weight", "left_arm_weight", "right_arm_weight"]:
		aiming.gait.set(weight, 0.0)
	var wanted := _about(Vector3.UP, 0.3) * _about(Vector3.UP, -0.6) * _about(Vector3.RIGHT, 0.1) * _about(Vector3.RIGHT, 0.1) * _about(Vector3.RIGHT, 0.05)
	var hips := [0.0]
	for frame: int in 300:
		_aim(aiming, 0.0)
		aiming.step(1.0 / 60.0)
		check_below(aiming.turn_of("UpperChest").angle_to(wanted), 0.002, "the chest points as in the animation")
		check_below(aiming.turn_of("LeftHand").angle_to(wanted * _about(Vector3.UP, -1.7)), 0.002, "and the hands")
		check_below(aiming.turn_of("Head").angle_to(wanted * _about(Vector3.UP, 0.3)), 0.002, "and the head")
		hips[0] = maxf(hips[0], aiming.turn_of("Hips").angle_to(Quaternion.IDENTITY))
	check(hips[0] > 0.05, "while the hips sway: %.3f" % hips[0])


func test_legs_and_planted_feet_know_nothing_of_layers() -> void:
	var plain := add_walker(func(made: Walker) -> void: made.gait.turn_rate = 0.5)
	var attacking := add_walker(func(made: Walker) -> void: made.gait.turn_rate = 0.5)
	for weight: String in ["spine_weight", "head_weight", "left_arm_weight", "right_arm_weight"]:
		attacking.gait.set(weight, 0.0)
	for frame: int in 300:
		var time := frame / 60.0
		# An attack from the shoulder: the trunk winds up and strikes.
		_pose(attacking, "Spine", _about(Vector3.UP, 0.7 * sin(4.0 * time)))
		_pose(attacking, "RightUpperArm", _about(Vector3.BACK, -1.0 + sin(4.0 * time)))
		attacking.gait.spine_weight = 0.5 + 0.5 * sin(time)
		plain.step(1.0 / 60.0)
		attacking.step(1.0 / 60.0)
		for joint: String in LEGS:
			check_below(attacking.bones[joint].origin.distance_to(plain.bones[joint].origin), 1e-4, joint)
			check_below(_turn(attacking, joint).angle_to(_turn(plain, joint)), 1e-3, joint)


func test_a_layer_is_faded_without_a_pop() -> void:
	for keyed: float in [0.2, 0.1]:
		var walker := add_walker()
		walker.walk(30)
		var before := {}
		var most := {}
		var frames := int(keyed * 60.0)
		for frame: int in 6 * frames:
			_wave(walker, 0.3)
			_aim(walker, 0.0)
			_pose(walker, "RightUpperArm", _about(Vector3.BACK, -1.5))
			var share := clampf(float(frame) / frames - 1.0, 0.0, 1.0) - clampf(float(frame) / frames - 4.0, 0.0, 1.0)
			for weight: String in ["spine_weight", "head_weight", "left_arm_weight", "right_arm_weight"]:
				walker.gait.set(weight, 1.0 - share)
			walker.step(1.0 / 60.0)
			for joint: String in Walker.BODY:
				var now := _turn(walker, joint)
				if before.has(joint):
					most[joint] = maxf(most.get(joint, 0.0), now.angle_to(before[joint]))
				before[joint] = now
		for joint: String in most:
			if not joint in LEGS:
				# Half a turn within the fade, and what the walk does besides.
				check_below(most[joint], PI / frames + 0.08, joint + " in one frame of a fade of %.1f s" % keyed)


func test_weights_that_make_no_sense_are_harmless() -> void:
	var walker := add_walker()
	for weight: float in [NAN, INF, -3.0, 7.0]:
		walker.gait.spine_weight = weight
		walker.gait.left_arm_weight = weight
		walker.walk(5)
		for pose: Transform3D in walker.bone_poses:
			check(pose.is_finite(), "poses stay finite")


func test_bodies_without_some_joints_have_layers_too() -> void:
	var walker := add_walker(func(made: Walker) -> void:
		made.missing = ["UpperChest", "Neck", "LeftShoulder", "RightShoulder"]
		made.between = {"RightLowerArm": "Twist"})
	for weight: String in ["spine_weight", "head_weight", "left_arm_weight", "right_arm_weight"]:
		walker.gait.set(weight, 0.0)
	for frame: int in 60:
		_pose(walker, "RightUpperArm", _about(Vector3.BACK, -1.0))
		_pose(walker, "Spine", _about(Vector3.UP, 0.5))
		walker.step(1.0 / 60.0)
		check_below(_turn(walker, "RightUpperArm").angle_to(_about(Vector3.BACK, -1.0)), 1e-3, "the arm is the animation's")
		check_below(walker.turn_of("Chest").angle_to(_about(Vector3.UP, 0.5)), 0.002, "and the trunk")


func test_an_animation_player_waves_and_a_look_at_looks() -> void:
	var walker := add_walker()
	walker.skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_IDLE
	walker.skeleton.name = "Skeleton"
	walker.gait.right_arm_weight = 0.0
	walker.gait.speed = 0.0
	var player := AnimationPlayer.new()
	walker.add_child(player)
	var wave := Animation.new()
	var track := wave.add_track(Animation.TYPE_ROTATION_3D)
	wave.track_set_path(track, "Skeleton:RightUpperArm")
	wave.rotation_track_insert_key(track, 0.0, _about(Vector3.BACK, -1.2))
	wave.rotation_track_insert_key(track, 1.0, _about(Vector3.BACK, -1.2))
	wave.loop_mode = Animation.LOOP_LINEAR
	var library := AnimationLibrary.new()
	library.add_animation("wave", wave)
	player.add_animation_library("", library)
	player.play("wave")
	var target := Node3D.new()
	target.position = Vector3(5, 1.6, 5)
	add_child(target)
	var look := LookAtModifier3D.new()
	look.bone_name = "Head"
	look.forward_axis = SkeletonModifier3D.BONE_AXIS_PLUS_Z
	look.target_node = target.get_path()
	walker.skeleton.add_child(look)
	look.modification_processed.connect(walker._read_bones)
	for frame: int in 10:
		await get_tree().process_frame
	check_below(_turn(walker, "RightUpperArm").angle_to(_about(Vector3.BACK, -1.2)), 0.01, "the clip's arm")
	var looks := walker.bones["Head"].basis.z.normalized()
	var wanted := (target.position - walker.joint("Head")).normalized()
	check_below(looks.angle_to(wanted), 0.1, "the look-at on top still looks")
