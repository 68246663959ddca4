extends TestCase
## A real ragdoll: bodies of the physics engine take the skeleton over from the walk, and the walk takes it back where they came to lie.

const DT := 1.0 / 60.0
## Joint → the joint where its body ends, or none, and the body's radius in metres.
const LIMBS := {
	"Hips": ["Chest", 0.12], "Chest": ["Neck", 0.13], "Head": ["", 0.1],
	"LeftUpperLeg": ["LeftLowerLeg", 0.07], "LeftLowerLeg": ["LeftFoot", 0.05],
	"RightUpperLeg": ["RightLowerLeg", 0.07], "RightLowerLeg": ["RightFoot", 0.05],
	"LeftUpperArm": ["LeftLowerArm", 0.045], "LeftLowerArm": ["LeftHand", 0.04],
	"RightUpperArm": ["RightLowerArm", 0.045], "RightLowerArm": ["RightHand", 0.04],
}


func _floor() -> void:
	var ground := StaticBody3D.new()
	var shape := CollisionShape3D.new()
	shape.shape = WorldBoundaryShape3D.new()
	ground.add_child(shape)
	add_child(ground)


## A walker whom physics moves as it would in a game, with a ragdoll above the generator.
func _walker() -> Walker:
	var walker := Walker.new()
	add_child(walker.build())
	walker.skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_PHYSICS
	var ragdoll := PhysicalBoneSimulator3D.new()
	ragdoll.name = "Ragdoll"
	walker.skeleton.add_child(ragdoll)
	walker.skeleton.move_child(ragdoll, 0)
	for joint: String in LIMBS:
		ragdoll.add_child(_limb(joint))
	return walker


func _limb(joint: String) -> PhysicalBone3D:
	var limb := PhysicalBone3D.new()
	limb.name = joint
	limb.bone_name = joint
	limb.joint_type = PhysicalBone3D.JOINT_TYPE_CONE
	limb.linear_damp = 0.5
	limb.angular_damp = 4.0
	var begin: Vector3 = Walker.BODY[joint][1]
	var end := begin + Vector3.UP * 0.15
	if LIMBS[joint][0]:
		end = Walker.BODY[LIMBS[joint][0]][1]
	var capsule := CapsuleShape3D.new()
	capsule.radius = LIMBS[joint][1]
	capsule.height = maxf(begin.distance_to(end), 2.0 * capsule.radius)
	var shape := CollisionShape3D.new()
	shape.shape = capsule
	shape.position = 0.5 * (end - begin)
	shape.quaternion = Quaternion(Vector3.UP, (end - begin).normalized())
	limb.add_child(shape)
	return limb


func _frames(count: int, each := Callable()) -> void:
	for frame: int in count:
		await get_tree().physics_frame
		if each.is_valid():
			each.call()


func _level(place: Vector3) -> Vector2:
	return Vector2(place.x, place.z)


func test_a_ragdoll_falls_and_the_walk_gets_up_where_it_lies() -> void:
	_floor()
	var walker := _walker()
	var ragdoll: PhysicalBoneSimulator3D = walker.skeleton.get_node(^"Ragdoll")
	await _frames(60)
	check(walker.position.z > 0.5, "it walks before: %s" % walker.position)
	check_near(walker.joint("Hips").y, 0.97, 0.1, "upright")

	walker.gait.hand_over(0.0)
	ragdoll.physical_bones_start_simulation()
	check(ragdoll.is_simulating_physics(), "physics has the body")
	(ragdoll.get_node(^"Chest") as PhysicalBone3D).apply_central_impulse(Vector3(6.0, 0.0, 4.0))
	var from := walker.position
	await _frames(120)
	check(walker.gait.is_handed_over(), "the walk has left it alone")
	check_equal(walker.position, from, "nobody travels meanwhile")
	check_below(walker.joint("Hips").y, 0.5, "it lies")
	var lies := walker.joint("Hips")
	check(_level(lies - from).length() > 0.3, "away from where it stood: %s" % (lies - from))

	ragdoll.physical_bones_stop_simulation()
	check(not ragdoll.is_simulating_physics(), "physics has let go")
	var taken := [0]
	walker.gait.taken_over.connect(func() -> void: taken[0] += 1)
	walker.gait.take_over(0.8)
	# By reference, as lambdas copy what they take.
	var seen := {last = walker.joint("Hips"), moved = 0.0, slip = 0.0}
	var watch := func() -> void:
		seen.moved = maxf(seen.moved, seen.last.distance_to(walker.joint("Hips")))
		seen.last = walker.joint("Hips")
		seen.slip = maxf(seen.slip, minf(walker.slip(&"left"), walker.slip(&"right")))
	await _frames(90, watch)
	check_equal(taken[0], 1, "it tells once that it is done")
	check_below(seen.moved, 0.08, "the hips do not jump, metres a frame")
	check_near(walker.joint("Hips").y, 0.97, 0.1, "it is up again")
	check_below(_level(walker.joint("Hips") - walker.position).length(), 0.2, "the character is where the body is")
	var up_at := walker.position
	check_below(_level(up_at - lies).length(), 2.5, "and got up where it lay")
	seen.slip = 0.0
	await _frames(60, watch)
	check_below(seen.slip, 0.1, "feet stand, m/s")
	check_near(_level(walker.position - up_at).length(), walker.gait.speed, 0.35, "and it walks on")


func test_a_ragdoll_that_is_caught_in_the_fall_walks_on() -> void:
	_floor()
	var walker := _walker()
	var ragdoll: PhysicalBoneSimulator3D = walker.skeleton.get_node(^"Ragdoll")
	await _frames(45)
	for fall: int in [3, 12, 30]:
		walker.gait.hand_over(0.0)
		ragdoll.physical_bones_start_simulation()
		await _frames(fall)
		ragdoll.physical_bones_stop_simulation()
		walker.gait.take_over(0.4)
		var seen := {last = walker.joint("Hips"), moved = 0.0}
		await _frames(90, func() -> void:
			seen.moved = maxf(seen.moved, seen.last.distance_to(walker.joint("Hips")))
			seen.last = walker.joint("Hips"))
		check(not walker.gait.is_handed_over(), "taken over after %d frames" % fall)
		check_below(seen.moved, 0.08, "the hips do not jump after %d frames, metres a frame" % fall)
		check_near(walker.joint("Hips").y, 0.97, 0.1, "it walks upright after %d frames" % fall)
