extends TestCase
## Walkers of a crowd as single ones: they come and go, are named, found, saved, and made without holding a frame.

const MODEL := preload("res://addons/footfall/models/locomotion.footfall")
const PROUD := preload("res://addons/footfall/models/proud.footstyle")
const SAD := preload("res://addons/footfall/models/sad.footstyle")
const DT := 1.0 / 60.0
const MANY := 10_000
## Walkers that begin in one frame at most: a crowd's own limit.
const MOST_A_FRAME := 256


func _advance(crowd: GaitCrowd3D, frames: int) -> void:
	for frame: int in frames:
		crowd.advance(DT)


func _grid(count: int) -> PackedVector3Array:
	var places := PackedVector3Array()
	for index: int in count:
		places.append(Vector3(index % 100, 0, index / 100))
	return places


func test_ids_last_while_others_come_and_go() -> void:
	var crowd := add_crowd(10)
	check_equal(crowd.get_agents(), PackedInt32Array(range(10)), "ids of a fresh crowd count up")
	var more: PackedInt32Array = crowd.add_agents([Vector3(50, 0, 0), Vector3(NAN, 0, 0), Vector3(60, 0, 0)], [])
	check_equal(more, PackedInt32Array([10, 11]), "who is nowhere gets none")
	_advance(crowd, 60)
	var before := crowd.get_positions()
	crowd.remove_agents([3, 10, 3, 77, -1])
	check_equal(crowd.get_agents(), PackedInt32Array([0, 1, 2, 4, 5, 6, 7, 8, 9, 11]), "the others keep theirs")
	check(not crowd.has_agent(3) and crowd.has_agent(11), "who is there")
	check_equal(crowd.get_positions([11, 4]), PackedVector3Array([before[11], before[4]]), "they stay where they are")
	check(not crowd.get_positions([3])[0].is_finite(), "nobody is nowhere")
	var fresh: PackedInt32Array = crowd.add_agents([Vector3(70, 0, 0)], [1.0])
	check(fresh[0] != 3 and fresh[0] != 10, "an id is not given again: %s" % fresh)
	check_equal(crowd.get_positions(fresh)[0], Vector3(70, 0, 0), "places can be read at once")
	check_near(crowd.get_headings(fresh)[0], 1.0, 1e-6, "headings too")
	check_equal(crowd.get_agents()[-1], fresh[0], "the last to come is the last in order")
	_advance(crowd, 120)
	check_equal(crowd.get_agent_count(), 11, "walkers")
	check(crowd.get_positions(fresh)[0].distance_to(Vector3(70, 0, 0)) > 0.5, "who came late walks")
	crowd.clear_agents()
	check_equal(crowd.get_agents(), PackedInt32Array(), "nobody is left")
	check_equal(crowd.add_agents([Vector3.ZERO], []).size(), 1, "somebody comes again")
	check(not crowd.has_agent(0), "and is somebody else")


func test_batches_reach_those_who_are_named() -> void:
	var crowd := add_crowd(0, func(made: GaitCrowd3D) -> void: made.behaviour = GaitCrowd3D.SCRIPTED)
	var ids: PackedInt32Array = crowd.add_agents([Vector3.ZERO, Vector3(5, 0, 0), Vector3(10, 0, 0)], [0.0, 0.0, 0.0])
	crowd.remove_agents([ids[0]])
	crowd.set_speeds([0.0, 1.2])
	crowd.set_speeds([1.5, 9.0], [ids[2], ids[0]])
	_advance(crowd, 240)
	var way := crowd.get_positions()
	check_below(way[0].distance_to(Vector3(5, 0, 0)), 1.5, "who was told to stand stops")
	check(way[1].z > 3.5, "who was named walks: %s" % way[1])
	check_equal(crowd.get_tiers([ids[0], ids[1]]).size(), 2, "a tier for each id")


func test_a_change_of_count_leaves_the_others_alone() -> void:
	var crowd := add_crowd(20)
	var other := add_crowd(20)
	_advance(crowd, 100)
	_advance(other, 100)
	var added: PackedInt32Array = crowd.add_agents([Vector3(100, 0, 100)], [])
	crowd.count = 25
	check_equal(crowd.get_agent_count(), 26, "five more")
	crowd.count = 18
	check_equal(crowd.get_agent_count(), 19, "seven fewer")
	check(crowd.has_agent(added[0]), "whom a script added stays")
	check_equal(crowd.get_agents().slice(0, 18), PackedInt32Array(range(18)), "the first stay")
	check_equal(crowd.get_positions().slice(0, 18), other.get_positions().slice(0, 18), "and nobody begins anew")
	crowd.count = 0
	check_equal(crowd.get_agents(), added, "only those of a script are left")


func test_walkers_are_found_by_ray_and_by_place() -> void:
	var crowd := add_crowd(0, func(made: GaitCrowd3D) -> void: made.size_range = Vector2.ONE)
	crowd.position = Vector3(100, 5, 0)
	crowd.rotation.y = 0.5 * PI
	var ids: PackedInt32Array = crowd.add_agents([Vector3(0, 0, 4), Vector3(0, 0, 8), Vector3(3, 0, 4)], [])
	# In global space the first two stand at x = 104 and 108.
	check_equal(crowd.pick(Vector3(100, 6, 0), Vector3(120, 6, 0)), ids[0], "the first on the way")
	check_equal(crowd.pick(Vector3(120, 6, 0), Vector3(100, 6, 0)), ids[1], "from the other side the other")
	check_equal(crowd.pick(Vector3(100, 6, 0), Vector3(103, 6, 0)), -1, "too short")
	check_equal(crowd.pick(Vector3(100, 7.5, 0), Vector3(120, 7.5, 0)), -1, "above their heads")
	check_equal(crowd.pick(Vector3(NAN, 0, 0), Vector3.ZERO), -1, "nowhere")
	check_equal(crowd.find_nearest(Vector3(104, 5, -2.5)), ids[2], "the nearest")
	check_equal(crowd.find_nearest(Vector3(104, 5, 50), 10.0), -1, "nobody that near")
	crowd.remove_agents([ids[0]])
	check_equal(crowd.pick(Vector3(100, 6, 0), Vector3(120, 6, 0)), ids[1], "who is gone is not met")


func test_a_scene_tells_whom_it_shows() -> void:
	var camera := Camera3D.new()
	add_child(camera)
	camera.make_current()
	var crowd := add_crowd(5, func(made: GaitCrowd3D) -> void:
		made.full_distance = 1000.0
		made.full_count = 3
		made.area = Vector2(10, 10))
	_advance(crowd, 20)
	var shown := 0
	for id: int in crowd.get_agents():
		var node: Node3D = crowd.get_agent_node(id)
		if node == null:
			continue
		shown += 1
		check_equal(crowd.get_agent_of(node), id, "the scene's walker")
		check_equal(crowd.get_agent_of(node.find_children("*", "Skeleton3D", true, false)[0]), id, "and of what is in it")
		check_below(node.position.distance_to(crowd.get_positions([id])[0]), 1e-4, "it stands where its walker does")
	check_equal(shown, 3, "whole scenes")
	check_equal(crowd.get_agent_of(self), -1, "another node")
	check_equal(crowd.get_agent_of(null), -1, "no node")
	var gone: PackedInt32Array = []
	for id: int in crowd.get_agents():
		if crowd.get_agent_node(id) != null:
			gone.append(id)
	crowd.remove_agents(gone)
	check_equal(crowd.get_agent_node(gone[0]), null, "nobody is shown who is gone")
	_advance(crowd, 20)
	check_equal(crowd.get_agents().size(), 2, "walkers that are left")
	camera.queue_free()


func test_a_saved_crowd_keeps_its_ids() -> void:
	var crowd := add_crowd(12)
	crowd.remove_agents([2, 5])
	var late: PackedInt32Array = crowd.add_agents([Vector3(30, 0, 0)], [])
	_advance(crowd, 60)
	var state := crowd.get_state()
	var other := add_crowd(3)
	_advance(other, 5)
	other.set_state(state)
	check_equal(other.get_agents(), crowd.get_agents(), "ids")
	check_equal(other.get_positions(), crowd.get_positions(), "places")
	check_equal(other.get_sizes(late), crowd.get_sizes(late), "sizes")
	check_equal(other.add_agents([Vector3.ZERO], []), crowd.add_agents([Vector3.ZERO], []), "who comes next has the same id in both")
	_advance(other, 60)
	check_equal(other.get_agent_count(), 12, "they walk on")
	other.count = 4
	check_equal(other.get_agent_count(), 6, "it knows who is of its count: %s" % other.get_agents())


func test_a_rig_that_is_no_use_is_a_problem() -> void:
	var crowd := GaitCrowd3D.new()
	crowd.model = MODEL
	begin_expected_errors()
	crowd.character = Skinned.scene(["LeftFoot", "LeftToes"])
	add_child(crowd)
	check_contains(str(crowd.get_problems()), "LeftFoot", "the bone that is missing")
	check_contains(str(crowd.get_problems()), "BoneMap", "and what to do")
	check_equal(crowd.add_agents([Vector3.ZERO], []), PackedInt32Array(), "nobody can be added")
	end_expected_errors()
	crowd.character = Skinned.scene()
	check_equal(crowd.get_problems(), PackedStringArray(), "another rig mends it")
	crowd.free()


func _styled_crowd() -> GaitCrowd3D:
	return add_crowd(0, func(made: GaitCrowd3D) -> void:
		made.playing = true
		made.styles = [PROUD, SAD] as Array[GaitStyle])


## The time that frames take is measured by `cargo xtask bench-crowd`.
func test_ten_thousand_are_made_in_the_background() -> void:
	var crowd := _styled_crowd()
	var came := PackedInt32Array()
	var most := [0]
	crowd.agents_ready.connect(func(agents: PackedInt32Array) -> void:
		came.append_array(agents)
		most[0] = maxi(most[0], agents.size()))
	for frame: int in 5:
		await get_tree().process_frame
	var ids: PackedInt32Array = crowd.add_agents(_grid(MANY), [])
	check_equal(ids, PackedInt32Array(range(MANY)), "ids come at once")
	check_equal(crowd.get_agent_count(), MANY, "and count at once")
	check(crowd.has_agent(ids[-1]), "the last is there")
	check(crowd.is_making(), "they are being made")
	var frames := 0
	while crowd.is_making() and frames < 6000:
		await get_tree().process_frame
		frames += 1
	check_below(most[0], MOST_A_FRAME + 1, "walkers that begin in a frame")
	came.sort()
	check_equal(came, ids, "everybody was told of, once")
	for frame: int in 60:
		await get_tree().process_frame
	var moved := 0
	var now := crowd.get_positions()
	for index: int in MANY:
		moved += int(now[index] != Vector3(index % 100, 0, index / 100))
	check(moved > 0.95 * MANY, "they walk: %d" % moved)
	crowd.remove_agents(ids)
	check_equal(crowd.get_agent_count(), 0, "nobody is left")
	crowd.free()


func test_whoever_was_added_can_be_told_at_once() -> void:
	var crowd := add_crowd(0, func(made: GaitCrowd3D) -> void: made.behaviour = GaitCrowd3D.SCRIPTED)
	var ids: PackedInt32Array = crowd.add_agents(_grid(3000), [])
	check_equal(crowd.get_positions(), _grid(3000), "places")
	check_equal(crowd.add_agents([Vector3(500, 0, 0)], []).size(), 1, "one more")
	crowd.remove_agents(ids.slice(0, 2999))
	check_equal(crowd.get_positions(), PackedVector3Array([Vector3(99, 0, 29), Vector3(500, 0, 0)]), "who stays")
	ids = crowd.add_agents(_grid(3000), [])
	crowd.clear_agents()
	check_equal(crowd.get_agents(), PackedInt32Array(), "nobody is left who was only coming")
	crowd.add_agents(_grid(3000), [])
	crowd.count = 2
	check_equal(crowd.get_agent_count(), 3002, "the node's own come after them")
	check_equal(crowd.get_positions()[0], Vector3.ZERO, "in the order in which they came")


func test_who_they_are_does_not_depend_on_when_they_are_made() -> void:
	var configure := func(made: GaitCrowd3D) -> void:
		made.styles = [PROUD, SAD] as Array[GaitStyle]
		made.full_count = 0
	var waits := add_crowd(300, configure)
	var lets_come := add_crowd(300, configure)
	waits.advance(0.0)
	check(not waits.is_making(), "it waits")
	while lets_come.get_agent_count() == 0 or lets_come.is_making():
		await get_tree().process_frame
	# Tiers are chosen in every eighth frame.
	for frame: int in 10:
		await get_tree().process_frame
	_advance(waits, 200)
	_advance(lets_come, 200)
	check_equal(waits.get_positions(), lets_come.get_positions(), "the same ways")
	check_equal(waits.get_phases(), lets_come.get_phases(), "the same steps")


func test_changes_while_walkers_are_made_are_survived() -> void:
	var crowd := add_crowd(2000, func(made: GaitCrowd3D) -> void: made.playing = true)
	await get_tree().process_frame
	crowd.remove_agents(range(0, 2000, 2))
	check_equal(crowd.get_agent_count(), 1000, "half of them left before they were made")
	crowd.count = 1500
	crowd.set_agent_style(1, [1.0])
	await get_tree().process_frame
	var state := crowd.get_state()
	crowd.clear_agents()
	crowd.set_state(state)
	check_equal(crowd.get_agent_count(), 1500, "a state in between")
	crowd.count = 100
	crowd.advance(DT)
	check(not crowd.is_making(), "time that a script passes waits for all")
	check_equal(crowd.get_agent_count(), 100, "walkers")
	crowd.count = 3000
	await get_tree().process_frame
	crowd.restart()
	await get_tree().process_frame
	remove_child(crowd)
	add_child(crowd)
	await get_tree().process_frame
	crowd.free()
	check(true, "freed while they are made")
