extends TestCase
## A crowd: who walks, where, how they are drawn, and what a developer may get wrong.

const MODEL := preload("res://addons/footfall/models/locomotion.footfall")
const PROUD := preload("res://addons/footfall/models/proud.footstyle")
const DT := 1.0 / 60.0


func _advance(crowd: GaitCrowd3D, frames: int, each := Callable()) -> void:
	for frame: int in frames:
		crowd.advance(DT)
		if each.is_valid():
			each.call()


func _mean_resultant(phases: PackedFloat32Array) -> float:
	var sum := Vector2.ZERO
	for phase: float in phases:
		sum += Vector2.from_angle(TAU * phase)
	return sum.length() / phases.size()


func test_everybody_walks_and_nobody_marches_in_step() -> void:
	var crowd := add_crowd(100)
	var starts := crowd.get_positions()
	check_equal(starts.size(), 100, "walkers")
	var footsteps := [0]
	crowd.footsteps.connect(func(agents: PackedInt32Array, feet: PackedByteArray, places: PackedVector3Array) -> void:
		check(agents.size() == feet.size() and feet.size() == places.size(), "arrays of one size")
		footsteps[0] += agents.size())
	var agreement := [0.0]
	_advance(crowd, 300, func() -> void: agreement[0] += _mean_resultant(crowd.get_phases()) / 300.0)
	var now := crowd.get_positions()
	var walked := 0
	for index: int in 100:
		walked += int(now[index].distance_to(starts[index]) > 1.0)
		check(absf(now[index].y) < 0.01, "everybody stays on the ground")
	check(walked > 90, "nearly everybody gets somewhere in five seconds: %d" % walked)
	check_near(footsteps[0], 100 * 5 * 1.8, 200, "footsteps")
	# By chance it is 1 / sqrt(100), give or take.
	check_below(agreement[0], 0.2, "phases agree no more than by chance")


func test_speeds_sizes_and_turns_are_what_a_script_asks() -> void:
	var crowd := add_crowd(0, func(made: GaitCrowd3D) -> void:
		made.behaviour = GaitCrowd3D.SCRIPTED
		made.size_range = Vector2.ONE)
	crowd.add_agents([Vector3.ZERO, Vector3(5, 0, 0), Vector3(10, 0, 0), Vector3(15, 0, 0)], [0.0, 0.0, PI, 0.0])
	crowd.set_speeds([0.8, 1.4, 1.2, 0.0])
	crowd.set_turn_rates([0.0, 0.0, 0.0, 0.0])
	_advance(crowd, 120)
	var before := crowd.get_positions()
	_advance(crowd, 300)
	var after := crowd.get_positions()
	check_near((after[0] - before[0]).z / 5.0, 0.8, 0.1, "a slow walker's speed")
	check_near((after[1] - before[1]).z / 5.0, 1.4, 0.15, "a fast walker's speed")
	check_near((after[2] - before[2]).z / 5.0, -1.2, 0.15, "who faces back walks back")
	check_below(after[3].distance_to(before[3]), 0.05, "who is asked to stand stands")
	crowd.set_turn_rates([0.5, 0.0, 0.0, 0.0])
	_advance(crowd, 60)
	var heading := crowd.get_headings()[0]
	_advance(crowd, 60)
	check_near(wrapf(crowd.get_headings()[0] - heading, -PI, PI), 0.5, 0.2, "it turns to its left")


func test_walkers_go_where_they_are_sent_and_keep_apart() -> void:
	# They steer with their next step and hardly stop: in 12 of 168 crowds somebody is brushed. A sample of 28 depends on chance.
	var apart: Array[float] = []
	for seed_of_crowd: int in 168:
		apart.append(_two_rows(seed_of_crowd))
	apart.sort()
	check(apart[18] > 0.4, "nobody walks through anybody: %s m" % [apart.slice(0, 40)])
	check(apart[36] > 0.5, "most keep apart: %s m" % [apart.slice(0, 40)])


## Two rows that have to pass through each other; returns how near two of them come.
func _two_rows(seed_of_crowd: int) -> float:
	var crowd := add_crowd(0, func(made: GaitCrowd3D) -> void:
		made.behaviour = GaitCrowd3D.SCRIPTED
		made.seed = seed_of_crowd)
	var places := PackedVector3Array()
	var targets := PackedVector3Array()
	var headings := PackedFloat32Array()
	for index: int in 8:
		var x := 1.2 * (index % 4)
		var side := 1.0 if index < 4 else -1.0
		places.append(Vector3(x, 0, -6.0 * side))
		targets.append(Vector3(x, 0, 8.0 * side))
		headings.append(0.0 if index < 4 else PI)
	crowd.add_agents(places, headings)
	crowd.set_targets(targets)
	var nearest := [INF]
	_advance(crowd, 1200, func() -> void:
		var now := crowd.get_positions()
		for a: int in now.size():
			for b: int in a:
				nearest[0] = minf(nearest[0], now[a].distance_to(now[b])))
	var arrived := 0
	var now := crowd.get_positions()
	for index: int in 8:
		arrived += int(now[index].distance_to(targets[index]) < 1.5)
	check(arrived >= 7, "they arrive: %d of 8, %s" % [arrived, now])
	crowd.free()
	return nearest[0]


func _rooms() -> NavigationRegion3D:
	var mesh := NavigationMesh.new()
	mesh.vertices = PackedVector3Array([
		Vector3(-10, 0, -5), Vector3(-1, 0, -5), Vector3(-1, 0, -1), Vector3(-1, 0, 1), Vector3(-1, 0, 5), Vector3(-10, 0, 5),
		Vector3(1, 0, -5), Vector3(10, 0, -5), Vector3(10, 0, 5), Vector3(1, 0, 5), Vector3(1, 0, 1), Vector3(1, 0, -1),
	])
	mesh.add_polygon([0, 1, 2, 3, 4, 5])
	mesh.add_polygon([2, 11, 10, 3])
	mesh.add_polygon([6, 7, 8, 9, 10, 11])
	var region := NavigationRegion3D.new()
	region.navigation_mesh = mesh
	return region


func test_walkers_find_their_way_over_the_navigation_map() -> void:
	var region := _rooms()
	add_child(region)
	var crowd := add_crowd(0, func(made: GaitCrowd3D) -> void: made.behaviour = GaitCrowd3D.SCRIPTED)
	crowd.add_agents([Vector3(-6, 0, -4), Vector3(7, 0, 4)], [0.0, 0.0])
	check(not crowd.set_destinations([Vector3(6, 0, -4), Vector3(NAN, 0, 0)]), "there is no map yet")
	_advance(crowd, 120)
	var waits := crowd.get_positions()[0]
	_advance(crowd, 60)
	check_below(crowd.get_positions()[0].distance_to(waits), 0.05, "it stands until there is one")
	check_below(waits.distance_to(Vector3(-6, 0, -4)), 1.5, "it stands where it was")
	var map := region.get_navigation_map()
	var there := func() -> bool:
		return NavigationServer3D.map_get_iteration_id(map) > 0 and NavigationServer3D.map_get_closest_point_owner(map, Vector3.ZERO) == region.get_rid()
	check(await until(there), "the map is there")
	var widest := [0.0]
	_advance(crowd, 1800, func() -> void:
		var place := crowd.get_positions()[0]
		if absf(place.x) < 0.8:
			widest[0] = maxf(widest[0], absf(place.z)))
	check_below(crowd.get_positions()[0].distance_to(Vector3(6, 0, -4)), 1.5, "it arrives")
	check(crowd.set_destinations([Vector3(6, 0, -4), Vector3(NAN, 0, 0)]), "there is a way")
	check_below(widest[0], 1.6, "it goes through the door")

	var wanderers := add_crowd(20, func(made: GaitCrowd3D) -> void:
		made.behaviour = GaitCrowd3D.NAVIGATE
		made.area = Vector2(4, 4))
	var left := {}
	_advance(wanderers, 1500, func() -> void:
		for index: int in 20:
			var place := wanderers.get_positions()[index]
			check(absf(place.x) < 11.5 and absf(place.z) < 6.5, "nobody leaves the map: %s" % place)
			if absf(place.x) > 4.0:
				left[index] = true)
	check(left.size() > 12, "they go about: %d of 20" % left.size())
	region.free()


func test_a_path_is_followed() -> void:
	var path := Path3D.new()
	path.curve = Curve3D.new()
	for corner: Vector3 in [Vector3(-6, 0, -6), Vector3(6, 0, -6), Vector3(6, 0, 6), Vector3(-6, 0, 6), Vector3(-6, 0, -6)]:
		path.curve.add_point(corner)
	path.name = "Round"
	add_child(path)
	var crowd := add_crowd(20, func(made: GaitCrowd3D) -> void:
		made.behaviour = GaitCrowd3D.PATH
		made.path = ^"../Round"
		made.path_width = 2.0)
	_advance(crowd, 900)
	for place: Vector3 in crowd.get_positions():
		var off := path.curve.get_closest_point(place).distance_to(place)
		check_below(off, 2.6, "beside the path")


func test_equal_seeds_give_equal_crowds() -> void:
	var crowds := [add_crowd(40), add_crowd(40), add_crowd(40, func(made: GaitCrowd3D) -> void: made.seed = 5)]
	for crowd: GaitCrowd3D in crowds:
		_advance(crowd, 240)
	check_equal(crowds[0].get_positions(), crowds[1].get_positions(), "equal seeds")
	check(crowds[0].get_positions() != crowds[2].get_positions(), "another seed")


func test_a_saved_crowd_goes_on() -> void:
	var crowd := add_crowd(30)
	_advance(crowd, 200)
	var state: PackedByteArray = crowd.get_state()
	var places := crowd.get_positions()
	var phases := crowd.get_phases()
	_advance(crowd, 100)
	var other := add_crowd(0)
	other.set_state(state)
	check_equal(other.get_agent_count(), 30, "walkers")
	for index: int in 30:
		check_below(other.get_positions()[index].distance_to(places[index]), 0.01, "places")
		check_below(absf(wrapf(other.get_phases()[index] - phases[index], -0.5, 0.5)), 0.01, "phases")
	begin_expected_errors()
	other.set_state(PackedByteArray([1, 2, 3]))
	end_expected_errors()
	check_equal(other.get_agent_count(), 30, "damaged bytes change nothing")
	_advance(other, 60)
	check(other.get_positions() != places, "they walk on")


func test_tiers_follow_the_camera() -> void:
	var camera := Camera3D.new()
	add_child(camera)
	camera.look_at_from_position(Vector3(0, 1.7, -25), Vector3(0, 1, 0))
	camera.make_current()
	var crowd := add_crowd(150, func(made: GaitCrowd3D) -> void:
		made.full_count = 5
		made.full_distance = 15.0
		made.near_count = 30
		made.near_distance = 25.0)
	_advance(crowd, 30)
	var tiers := crowd.get_tiers()
	check_equal(tiers.count(0) <= 5, true, "whole scenes")
	check(tiers.count(1) > 5 and tiers.count(1) <= 30, "near: %d" % tiers.count(1))
	check(tiers.count(2) > 50, "far: %d" % tiers.count(2))
	check_equal(crowd.get_child_count(), 0, "what it draws with is hidden from the scene")
	for index: int in tiers.size():
		var far := crowd.get_positions()[index].distance_to(camera.global_position)
		if tiers[index] == 0:
			check_below(far, 17.0, "whole scenes are near")
	camera.queue_free()


func test_walkers_far_away_find_the_ground() -> void:
	var slope := StaticBody3D.new()
	var shape := CollisionShape3D.new()
	shape.shape = BoxShape3D.new()
	shape.shape.size = Vector3(40, 1, 80)
	slope.add_child(shape)
	add_child(slope)
	slope.transform = Transform3D(Basis(Vector3.RIGHT, -0.1), Vector3.ZERO).translated_local(Vector3(0, -0.5, 0))
	var camera := Camera3D.new()
	add_child(camera)
	camera.look_at_from_position(Vector3(0, 2, -60), Vector3(0, 1, 0))
	camera.make_current()
	var crowd := add_crowd(0, func(made: GaitCrowd3D) -> void:
		made.behaviour = GaitCrowd3D.SCRIPTED
		made.ground_mask = 1
		made.full_count = 0
		made.near_count = 0)
	crowd.add_agents([Vector3.ZERO], [0.0])
	crowd.set_turn_rates([0.0])
	for frame: int in 3:
		await get_tree().physics_frame
	var landings := [0]
	crowd.footsteps.connect(func(agents: PackedInt32Array, _feet: PackedByteArray, _places: PackedVector3Array) -> void:
		landings[0] += agents.size())
	_advance(crowd, 480)
	check_equal(crowd.get_tiers()[0], 2, "it is far away")
	var place := crowd.get_positions()[0]
	check(place.z > 6.0, "it walks: %s" % place)
	check_near(place.y, place.z * tan(0.1), 0.15, "it rises with the ground")
	check_near(landings[0], 8 * 1.9, 4, "footsteps")
	camera.free()
	slope.free()


func test_who_stands_from_the_beginning_stands_on_the_ground() -> void:
	var floor_body := StaticBody3D.new()
	var shape := CollisionShape3D.new()
	var box := BoxShape3D.new()
	box.size = Vector3(20, 1, 20)
	shape.shape = box
	shape.position.y = -0.7
	floor_body.add_child(shape)
	add_child(floor_body)
	var crowd := add_crowd(0, func(made: GaitCrowd3D) -> void:
		made.behaviour = GaitCrowd3D.SCRIPTED
		made.ground_mask = 1)
	# A navigation map is above the ground.
	var ids: PackedInt32Array = crowd.add_agents([Vector3(1, 0, 1)], [0.0])
	crowd.set_speeds([0.0], ids)
	await get_tree().physics_frame
	await get_tree().physics_frame
	_advance(crowd, 4)
	check_near(crowd.get_positions(ids)[0].y, -0.2, 1e-3, "height of a walker that has taken no step")
	floor_body.free()


func test_full_skeletons_walk_as_their_walkers_do() -> void:
	var camera := Camera3D.new()
	add_child(camera)
	camera.make_current()
	var crowd := add_crowd(1, func(made: GaitCrowd3D) -> void:
		made.full_distance = 1000.0
		made.area = Vector2.ZERO)
	_advance(crowd, 60)
	var actors: Array[Node] = []
	for child: Node in crowd.get_children(true):
		if child is Node3D and not child is MultiMeshInstance3D:
			actors.append(child)
	check_equal(actors.size(), 1, "one scene")
	var actor: Node3D = actors[0]
	var skeleton: Skeleton3D = actor.find_children("*", "Skeleton3D", true, false)[0]
	var lowest := INF
	var bends := 0.0
	for frame: int in 60:
		crowd.advance(DT)
		check_below(actor.position.distance_to(crowd.get_positions()[0]), 1e-4, "it is where its walker is")
		bends = maxf(bends, skeleton.get_bone_pose_rotation(skeleton.find_bone("LeftLowerLeg")).get_angle())
		for bone: String in ["LeftFoot", "RightFoot"]:
			lowest = minf(lowest, (actor.transform * skeleton.get_bone_global_pose(skeleton.find_bone(bone))).origin.y)
	check(bends > 0.4, "knees bend: %.2f" % bends)
	check_near(lowest, 0.085 * crowd.get_sizes()[0], 0.03, "feet touch the ground")
	camera.queue_free()


func test_styles_are_worn() -> void:
	var crowd := add_crowd(20, func(made: GaitCrowd3D) -> void: made.styles = [PROUD] as Array[GaitStyle])
	crowd.set_agent_style(0, [1.0])
	crowd.set_agent_style(99, [1.0])
	_advance(crowd, 120)
	check_equal(crowd.get_agent_count(), 20, "walkers")
	for place: Vector3 in crowd.get_positions():
		check(place.is_finite(), "finite places")


func test_warnings_say_what_to_do() -> void:
	var crowd := GaitCrowd3D.new()
	add_child(crowd)
	check_contains(str(crowd.get_problems()), "Character", "no character")
	crowd.model = MODEL
	begin_expected_errors()
	crowd.character = Skinned.scene(["LeftFoot", "LeftToes"])
	check_equal(crowd.get_agent_count(), 0, "a body without a foot does not walk")
	crowd.behaviour = GaitCrowd3D.PATH
	end_expected_errors()
	check_contains(str(crowd.get_problems()), "Path3D", "no path")


func test_nonsense_is_survived() -> void:
	begin_expected_errors()
	var crowd := add_crowd(0)
	_advance(crowd, 5)
	check_equal(crowd.get_agent_count(), 0, "nobody")
	crowd.count = 1_000_000
	check_equal(crowd.count, 100_000, "a million is cut")
	crowd.count = -5
	check_equal(crowd.count, 0, "less than nobody is nobody")
	crowd.add_agents([Vector3(NAN, 0, 0), Vector3.ZERO], [INF])
	check_equal(crowd.get_agent_count(), 1, "who is nowhere is left out")
	crowd.set_speeds([NAN])
	crowd.set_targets([Vector3(INF, 0, 0)])
	crowd.set_turn_rates(PackedFloat32Array())
	crowd.advance(NAN)
	crowd.advance(0.0)
	crowd.advance(-1.0)
	crowd.advance(1e9)
	crowd.speed_range = Vector2(NAN, 1)
	crowd.full_count = -3
	crowd.near_distance = NAN
	_advance(crowd, 10)
	end_expected_errors()
	crowd.footsteps.connect(func(_agents: PackedInt32Array, _feet: PackedByteArray, _places: PackedVector3Array) -> void:
		crowd.restart())
	crowd.count = 10
	_advance(crowd, 120)
	check(crowd.get_agent_count() == 10, "restarted from its own signal")
	remove_child(crowd)
	crowd.advance(DT)
	add_child(crowd)
	_advance(crowd, 5)
	check_equal(crowd.get_agent_count(), 10, "taken out and put back")
	crowd.free()
