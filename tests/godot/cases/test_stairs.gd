extends TestCase
## Six steps of 17 by 29 cm from many distances: nobody walks through them, sinks in, or lifts a foot to the hips.

const CONTROLLER: PackedScene = preload("res://addons/footfall/controller/gait_character_3d.tscn")
const RATE := 60.0
const STEPS := 6
const RISE := 0.17
const RUN := 0.29
## A point of a sole may be so far in a step, as people see it.
const DEPTH := 0.03
## An ankle, 8 cm above its sole, is at least so high above the tread below it.
const ANKLE := 0.035


func _exit_tree() -> void:
	end_haste()


func _box(middle: Vector3, size: Vector3) -> void:
	var body := StaticBody3D.new()
	var shape := CollisionShape3D.new()
	shape.shape = BoxShape3D.new()
	shape.shape.size = size
	body.add_child(shape)
	body.position = middle
	add_child(body)


## A floor and steps up along +Z from z = 0 to a landing: boxes of 20 cm, as treads are built, with air below.
func _stairs() -> void:
	_box(Vector3(0, -0.5, 0), Vector3(60, 1, 60))
	for step: int in STEPS:
		var depth := RUN if step < STEPS - 1 else 6.0
		_box(Vector3(0, RISE * (step + 1) - 0.1, RUN * step + 0.5 * depth), Vector3(60, 0.2, depth))


## Height of what was built so far along.
func _height(z: float) -> float:
	return clampf(floorf(z / RUN) + 1.0, 0.0, STEPS) * RISE


## Depth of a point in a step, up or to the front or back.
func _depth(point: Vector3) -> float:
	var out := minf(point.z - floorf(point.z / RUN) * RUN, ceilf(point.z / RUN) * RUN - point.z)
	return minf(_height(point.z) - point.y, maxf(out, 0.0)) if point.z > 0.0 else 0.0


func _check_body(what: String, soles: Array[PackedVector3Array], ankles: PackedVector3Array, hips: Vector3) -> void:
	for foot: int in 2:
		check_below(ankles[foot].y, hips.y, "%s: a foot is below the hips" % what)
		for point: Vector3 in soles[foot]:
			check_below(_depth(point), DEPTH, "%s: no sole is in a step, at %s" % [what, point])
	check(hips.y > _height(hips.z) + 0.5, "%s: the body is above the steps, at %s" % [what, hips])


func test_who_follows_the_ground_climbs_from_every_distance() -> void:
	_stairs()
	await get_tree().physics_frame
	for index: int in 13:
		var walker := Walker.new()
		walker.build()
		walker.gait.seed = index
		var placement := FootPlacement3D.new()
		placement.follow_ground = true
		walker.skeleton.add_child(placement)
		walker.gait.modification_processed.disconnect(walker._read_bones)
		placement.modification_processed.connect(walker._read_bones)
		walker.position.z = -1.5 - 0.06 * index
		add_child(walker)
		var what := "from %.2f m" % -walker.position.z
		walker.gait.speed = 1.3 if index % 2 == 0 else 1.8
		walker.walk(20)
		for frame: int in 720:
			walker.step(1.0 / RATE)
			var soles: Array[PackedVector3Array] = [PackedVector3Array(walker.sole(&"left")), PackedVector3Array(walker.sole(&"right"))]
			_check_body(what, soles, [walker.joint("LeftFoot"), walker.joint("RightFoot")], walker.joint("Hips"))
			if walker.global_position.z > STEPS * RUN + 1.0:
				break
		check_near(walker.global_position.y, STEPS * RISE, 0.06, "%s: it is on top" % what)
		walker.queue_free()
		await get_tree().process_frame


func test_the_controller_climbs_from_every_distance() -> void:
	_stairs()
	begin_haste()
	for index: int in 7:
		var character: GaitCharacter3D = CONTROLLER.instantiate()
		character.character_scene = Skinned.scene()
		character.position = Vector3(0, 0.02, -1.6 - 0.1 * index)
		character.player_controlled = false
		character.walk_speed = 1.8
		add_child(character)
		character.autopilot = Vector3.BACK
		var what := "from %.2f m" % -character.position.z
		var skeleton := character.gait.get_skeleton()
		var seen := [0]
		var watch := func() -> void:
			var place := func(bone: String) -> Vector3:
				return skeleton.global_transform * skeleton.get_bone_global_pose(skeleton.find_bone(bone)).origin
			var hips: Vector3 = place.call("Hips")
			check(hips.y > _height(hips.z) + 0.5, "%s: the body is above the steps, at %s" % [what, hips])
			for bone: String in ["LeftFoot", "RightFoot"]:
				var ankle: Vector3 = place.call(bone)
				check_below(ankle.y, hips.y, "%s: a foot is below the hips" % what)
				check(ankle.y > _height(ankle.z) + ANKLE, "%s: an ankle is above its tread, at %s" % [what, ankle])
			seen[0] += 1
		character.placement.modification_processed.connect(watch)
		for frame: int in 720:
			await get_tree().physics_frame
			if character.position.z > STEPS * RUN + 0.6:
				break
		check(seen[0] > 100, "%s: it was watched" % what)
		check_near(character.position.y, STEPS * RISE, 0.06, "%s: it is on top" % what)
		character.queue_free()
		await get_tree().process_frame
