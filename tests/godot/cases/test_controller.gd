extends TestCase
## The add-on's `GaitCharacter3D` as a game has it: physics, input, stairs, platforms, jumps.

const CONTROLLER: PackedScene = preload("res://addons/footfall/controller/gait_character_3d.tscn")


func _ready() -> void:
	begin_haste()


func _exit_tree() -> void:
	end_haste()


func _character(at := Vector3.ZERO, scene: PackedScene = Skinned.scene()) -> GaitCharacter3D:
	var character: GaitCharacter3D = CONTROLLER.instantiate()
	character.character_scene = scene
	character.position = at
	character.player_controlled = false
	add_child(character)
	return character


## Height of the hips in the last frame, in a list of its own: it can be seen only while the skeleton is posed.
func _hips(character: GaitCharacter3D) -> Array[float]:
	var height: Array[float] = [0.0]
	var skeleton := character.gait.get_skeleton()
	var bone := skeleton.find_bone("Hips")
	character.placement.modification_processed.connect(func() -> void:
		height[0] = (skeleton.global_transform * skeleton.get_bone_global_pose(bone).origin).y)
	return height


func _box(middle: Vector3, size: Vector3, body: PhysicsBody3D = StaticBody3D.new()) -> PhysicsBody3D:
	var shape := CollisionShape3D.new()
	shape.shape = BoxShape3D.new()
	shape.shape.size = size
	body.add_child(shape)
	body.position = middle
	add_child(body)
	return body


func _floor() -> void:
	_box(Vector3(0, -0.5, 0), Vector3(60, 1, 60))


## Steps up along +Z from z = 1, a landing, and as many down again.
func _stairs(count: int, rise: float, run: float) -> void:
	for step: int in count:
		var depth := 2.0 * run * (count - step) - run + 1.2
		var height := rise * (step + 1)
		_box(Vector3(0, 0.5 * height, 1.0 + run * count + 0.6), Vector3(2.4, height, depth))


func _frames(count: int, each := Callable()) -> void:
	for frame: int in count:
		await get_tree().physics_frame
		if each.is_valid():
			each.call()


func test_nobody_walks_before_a_key_is_pressed() -> void:
	_floor()
	var character := _character()
	await _frames(90)
	check(Vector2(character.position.x, character.position.z).length() < 0.01, "it stands where it was: %s" % character.position)
	check_near(character.position.y, 0.0, 0.01, "on the floor")
	check_equal(character.gait.speed, 0.0, "its speed")
	check_equal(character.gait.get_problems(), PackedStringArray(), "problems")


func test_stairs_throw_neither_the_figure_nor_the_camera() -> void:
	_floor()
	_stairs(6, 0.17, 0.29)
	var character := _character(Vector3(0, 0.02, -1.0))
	character.autopilot = Vector3.BACK
	await _frames(30)
	var figure: Node3D = character.get_node(^"Figure")
	var camera: Node3D = character.get_node(^"Camera")
	var lens: Node3D = character.get_node(^"Camera/Lens")
	var before := [character.global_position.y, figure.global_position.y, camera.global_position.y]
	var most := [0.0, 0.0, 0.0]
	var top := [0.0]
	var away := [0.0]
	await _frames(900, func() -> void:
		var now := [character.global_position.y, figure.global_position.y, camera.global_position.y]
		for index: int in 3:
			most[index] = maxf(most[index], absf(now[index] - before[index]))
			before[index] = now[index]
		away[0] = maxf(away[0], absf(figure.position.y))
		top[0] = maxf(top[0], now[0]))
	print("a frame's rise: capsule %.1f mm, figure %.1f mm, camera %.1f mm; figure off by %.0f mm" % [1e3 * most[0], 1e3 * most[1], 1e3 * most[2], 1e3 * away[0]])
	check_near(top[0], 1.02, 0.02, "it reached the top")
	check(character.position.z > 6.5, "and the floor behind: %s" % character.position)
	check_near(character.position.y, 0.0, 0.02, "down again")
	check(most[0] > 0.05, "the capsule steps at once: %.3f m" % most[0])
	check_below(most[1], 0.02, "the figure rises smoothly, metres a frame")
	# The camera moves with drawn frames, of which one may last several of physics here.
	check_below(most[2] / HASTE, 0.02, "the camera, too")
	check_below(away[0], 0.2, "the figure stays near its capsule")
	check(lens.global_position.distance_to(character.global_position) < 6.0, "the camera came along")


func test_slopes_are_walked_up_and_stood_on() -> void:
	_floor()
	var slope := deg_to_rad(25.0)
	var ramp := _box(Vector3.ZERO, Vector3(4, 0.4, 12))
	ramp.transform = Transform3D(Basis(Vector3.RIGHT, -slope), Vector3(0, 6.0 * sin(slope) - 0.2, 1.0 + 6.0 * cos(slope)))
	var character := _character()
	character.autopilot = Vector3.BACK
	await _frames(360)
	var height := character.position.y
	check(height > 1.0, "it got up: %s" % character.position)
	check_below(character.get_node(^"Figure").position.length(), 0.15, "the figure is where its capsule is")
	character.autopilot = Vector3.ZERO
	# Uphill the last two steps take longer.
	await _frames(150)
	var place := character.position
	await _frames(60)
	check_below(character.position.distance_to(place), 0.02, "and stands there")


func test_an_agent_leads_it_around_what_is_in_the_way() -> void:
	_floor()
	_box(Vector3(0, 0.5, 3), Vector3(4, 1, 0.4))
	var ground := NavigationMesh.new()
	ground.vertices = PackedVector3Array([
		Vector3(-6, 0, -2), Vector3(6, 0, -2), Vector3(6, 0, 2), Vector3(-6, 0, 2),
		Vector3(3, 0, 2), Vector3(3, 0, 8), Vector3(6, 0, 8), Vector3(-6, 0, 8), Vector3(3, 0, 4), Vector3(-6, 0, 4),
	])
	for corners: Array in [[0, 1, 2, 4, 3], [4, 2, 6, 5, 8], [8, 5, 7, 9]]:
		ground.add_polygon(PackedInt32Array(corners))
	var region := NavigationRegion3D.new()
	region.navigation_mesh = ground
	add_child(region)
	var character := _character()
	var agent := NavigationAgent3D.new()
	agent.target_desired_distance = 0.6
	character.add_child(agent)
	character.navigation = agent
	await _frames(20)
	check_equal(character.gait.speed, 0.0, "without a goal it stands")
	agent.target_position = Vector3(0, 0, 6)
	await _frames(1200)
	check(agent.is_navigation_finished(), "it arrived: %s" % character.position)
	check_below(character.position.distance_to(agent.target_position), 1.0, "there")
	await _frames(60)
	check_equal(character.gait.speed, 0.0, "and stands")


func test_walls_and_high_edges_stop_it() -> void:
	_floor()
	_box(Vector3(0, 0.15, 2.0), Vector3(4, 0.3, 1))
	var character := _character()
	character.autopilot = Vector3.BACK
	await _frames(240)
	check_near(character.position.y, 0.0, 0.02, "it stays below")
	check_below(character.position.z, 1.5, "and before the edge")


func test_a_fall_is_in_the_air_and_lands_once() -> void:
	_floor()
	_box(Vector3(0, 0.5, 0), Vector3(4, 1, 3))
	var character := _character(Vector3(0, 1.02, 0))
	var falls: Array[float] = []
	character.landed.connect(func(speed: float) -> void: falls.append(speed))
	character.autopilot = Vector3.BACK
	var flew := [0]
	await _frames(240, func() -> void: flew[0] += int(character.placement.in_air))
	check_near(character.position.y, 0.0, 0.02, "it fell to the floor")
	check_equal(falls.size(), 1, "landed once")
	check_near(falls[0], sqrt(2.0 * 9.8), 0.6, "at the speed of such a fall")
	check(flew[0] > 8 and flew[0] < 40, "feet were left to the animation meanwhile: %d frames" % flew[0])
	check(character.position.z > 3.0, "and it walks on: %s" % character.position)


func test_a_jump_is_as_high_as_it_is_told() -> void:
	_floor()
	var character := _character()
	var hips := _hips(character)
	await _frames(60)
	var leaps := [0]
	character.jumped.connect(func() -> void: leaps[0] += 1)
	var falls := [0]
	character.landed.connect(func(_speed: float) -> void: falls[0] += 1)
	var begin := hips[0]
	character.jump()
	var top := [0.0]
	await _frames(120, func() -> void: top[0] = maxf(top[0], hips[0]))
	check_near(top[0] - begin, character.jump_height, 0.05, "rise of the hips")
	check_equal([leaps[0], falls[0]], [1, 1], "jumped and landed")
	check_near(character.position.y, 0.0, 0.02, "on the floor again")
	check_equal(character.placement.in_air, false, "feet stand again")
	character.jump_height = 0.0
	character.jump()
	await _frames(2)
	check_equal(leaps[0], 1, "who does not jump stays")


func test_without_a_model_that_jumps_the_capsule_does() -> void:
	_floor()
	var character := _character()
	character.gait.model = load("res://addons/footfall/models/walk.footdyn")
	await _frames(60)
	character.jump()
	var top := [0.0]
	await _frames(90, func() -> void: top[0] = maxf(top[0], character.position.y))
	check_near(top[0], character.jump_height, 0.06, "height")
	check_near(character.position.y, 0.0, 0.02, "on the floor again")


func test_it_leaps_while_it_runs_and_goes_on() -> void:
	_floor()
	var character := _character()
	character.walk_speed = 3.0
	character.autopilot = Vector3.BACK
	var hips := _hips(character)
	await _frames(150)
	var begin := character.position.z
	var upright := hips[0]
	character.jump()
	var top := [0.0]
	await _frames(90, func() -> void: top[0] = maxf(top[0], hips[0]))
	check_near(top[0] - upright, character.jump_height, 0.12, "rise of the hips")
	check(character.position.z - begin > 3.0, "it runs on: %.1f m" % (character.position.z - begin))
	check_equal(character.gait.playing, true, "and lives on")


func test_it_leaps_to_a_place_while_it_runs() -> void:
	_floor()
	var character := _character()
	character.walk_speed = 3.0
	character.autopilot = Vector3.BACK
	await _frames(150)
	var flew := [false]
	var landings: Array[Vector3] = []
	character.gait.took_off.connect(func() -> void: flew[0] = true)
	character.gait.footstep.connect(func(_foot: StringName, at: Vector3) -> void:
		if flew[0] and landings.is_empty():
			landings.append(at))
	var place := character.global_position + Vector3(0.2, 0.0, 5.5)
	character.jump_to(place)
	var slowest := [INF]
	await _frames(150, func() -> void: slowest[0] = minf(slowest[0], character.velocity.z))
	check_equal(landings.size(), 1, "it leapt")
	check_near(landings[0].z, place.z, 0.05, "it lands at the place")
	check_below(absf(landings[0].x - place.x), 0.25, "with one foot beside its middle")
	check(slowest[0] > 1.5, "without a stop: %.1f m/s" % slowest[0])


func test_it_jumps_onto_a_wall_and_down() -> void:
	_floor()
	_box(Vector3(0, 0.2, 2.0), Vector3(4, 0.4, 2.0))
	var character := _character(Vector3(0, 0, 0.5))
	await _frames(60)
	character.jump()
	await _frames(120)
	check_near(character.position.y, 0.4, 0.03, "it stands on the wall: %s" % character.position)
	check(character.position.z > 1.0, "beyond its edge: %s" % character.position)
	check(character.is_on_floor(), "on its feet")
	var place := character.global_position + Vector3(0.4, 0.0, 0.2)
	character.jump_to(place)
	await _frames(120)
	check_below(character.position.distance_to(place), 0.03, "it lands where it was sent")


func test_it_crouches_under_a_low_ceiling_and_stays_down_there() -> void:
	_floor()
	_box(Vector3(0, 1.9, 2.0), Vector3(4, 1.0, 2.0))
	var character := _character()
	var hips := _hips(character)
	await _frames(60)
	var upright := hips[0]
	character.crouches = true
	character.autopilot = Vector3.BACK
	await _frames(60)
	check(hips[0] < upright - 0.1, "it keeps low: %.2f of %.2f m" % [hips[0], upright])
	await _frames(90)
	character.autopilot = Vector3.ZERO
	character.crouches = false
	await _frames(60)
	check(character.gait.crouch > 0.8, "there is no room to stand up at %s" % character.position)


func test_a_platform_carries_it() -> void:
	_floor()
	var platform: AnimatableBody3D = _box(Vector3(0, 0.4, 0), Vector3(4, 0.2, 4), AnimatableBody3D.new())
	platform.sync_to_physics = false
	var character := _character(Vector3(0, 0.52, 0))
	var figure: Node3D = character.get_node(^"Figure")
	await _frames(30)
	var begin := character.global_position - platform.global_position
	var heading := character.rotation.y
	var away := [0.0]
	for frame: int in 180:
		await get_tree().physics_frame
		platform.position += Vector3(0.01, 0.006 * sin(frame / 20.0), 0.0)
		platform.rotate_y(0.004)
		away[0] = maxf(away[0], absf(figure.position.y))
	var now := platform.global_basis.inverse() * (character.global_position - platform.global_position)
	check_below(now.distance_to(begin), 0.1, "it stands where it stood on the platform")
	check_near(wrapf(character.rotation.y - heading, -PI, PI), 180 * 0.004, 0.1, "turned with it")
	check_below(away[0], 0.02, "and rose with it")


func test_it_faces_its_way_and_where_the_camera_looks_while_aiming() -> void:
	_floor()
	var character := _character()
	character.autopilot = Vector3.RIGHT
	await _frames(180)
	check_near(wrapf(character.rotation.y - PI / 2, -PI, PI), 0.0, 0.1, "it faces its way")
	var camera: Node3D = character.get_node(^"Camera")
	camera.rotation.y = PI
	character.aims = true
	await _frames(240)
	check_near(wrapf(character.rotation.y, -PI, PI), 0.0, 0.15, "it faces where the camera looks")
	var begin := character.global_position
	await _frames(120)
	var way := character.global_position - begin
	check(way.x > 0.5 and absf(way.z) < 0.2 * way.x, "and goes sideways: %s" % way)


func test_directions_are_global_below_a_turned_node() -> void:
	_floor()
	var character := _character()
	character.reparent(_turned(2.0), false)
	character.autopilot = Vector3.RIGHT
	await _frames(180)
	var went := character.global_position
	check(went.x > 1.5, "it goes to +X: it is at %s" % went)
	check_below(absf(went.z), 0.5 * went.x, "the way aside")
	check(character.global_basis.z.x > 0.95, "it faces its way")


func _turned(angle: float) -> Node3D:
	var node := Node3D.new()
	node.rotation.y = angle
	add_child(node)
	return node


func test_who_comes_from_another_peer_leaves_the_view_to_the_player() -> void:
	# The level's own, as before anybody plays.
	add_child(Camera3D.new())
	var camera := _character().get_node(^"Camera/Lens")
	check_equal(get_viewport().get_camera_3d(), camera, "the player's own camera shows the game")
	var other: GaitCharacter3D = CONTROLLER.instantiate()
	other.character_scene = Skinned.scene()
	other.set_multiplayer_authority(2)
	add_child(other)
	check_equal(get_viewport().get_camera_3d(), camera, "and does so when somebody has joined")
	check(not other.player_controlled, "whom nobody steers here")


func test_capsules_fit_their_bodies() -> void:
	var bodies: Array[GaitCharacter3D] = []
	var capsules: Array[float] = []
	for size: float in [0.5, 1.0, 1.6]:
		var root := Skinned.scene().instantiate()
		root.scale = Vector3.ONE * size
		var scene := PackedScene.new()
		scene.pack(root)
		root.free()
		var character := _character(Vector3.ZERO, scene)
		var capsule: CapsuleShape3D = (character.get_node(^"Shape") as CollisionShape3D).shape
		check_near(capsule.height, 1.72 * size, 0.08 * size, "height of a body of %.1f" % size)
		check_near(capsule.radius, 0.24 * size, 0.04 * size, "radius of a body of %.1f" % size)
		capsules.append(capsule.height)
		bodies.append(character)
	for index: int in bodies.size():
		var kept: CapsuleShape3D = (bodies[index].get_node(^"Shape") as CollisionShape3D).shape
		check_equal(kept.height, capsules[index], "another body leaves it as it is")


func test_without_a_character_it_says_so_and_falls() -> void:
	_floor()
	var character := _character(Vector3(0, 0.5, 0), null)
	await _frames(60)
	check_near(character.position.y, 0.0, 0.02, "it falls to the floor")
	check_contains(character._get_configuration_warnings()[0], "Character Scene", "what to do")


func test_a_character_may_be_changed_while_it_walks() -> void:
	_floor()
	var character := _character()
	character.autopilot = Vector3.BACK
	await _frames(60)
	character.character_scene = Skinned.scene(["Chest", "UpperChest"])
	await _frames(2)
	var begin := character.position.z
	await _frames(90)
	check(character.position.z > begin + 0.5, "the new one walks: %s" % character.position)
	check_equal(character.get_node(^"Figure").get_child_count(), 1, "characters in it")
