extends TestCase
## Fate of a walk whose character is paused, hidden, moved, taken out of the tree or saved: the table in the add-on's README.

const RATE := 60.0
## A save as a game would have it.
const SAVE := "extends Resource\n@export var walk := PackedByteArray()\n@export var place := Transform3D.IDENTITY\n"


func _walker(by_itself := false) -> Walker:
	var walker := Walker.new()
	add_child(walker.build())
	if by_itself:
		walker.skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_IDLE
	return walker


func _frames(count: int) -> void:
	for frame: int in count:
		await get_tree().process_frame


## Places of the bones, seen from the character.
func _pose(walker: Walker) -> Dictionary:
	var pose := {}
	for joint: String in walker.bones:
		pose[joint] = walker.global_transform.affine_inverse() * walker.joint(joint)
	return pose


func _apart(a: Dictionary, b: Dictionary) -> float:
	var farthest := 0.0
	for joint: String in a:
		farthest = maxf(farthest, (a[joint] - b[joint]).length())
	return farthest


func test_paused_it_holds_and_goes_on() -> void:
	var walker := _walker(true)
	await _frames(10)
	process_mode = Node.PROCESS_MODE_ALWAYS
	walker.process_mode = Node.PROCESS_MODE_PAUSABLE
	get_tree().paused = true
	await _frames(2)
	var time := walker.gait.get_time()
	var place := walker.global_transform
	var steps := walker.footsteps.size()
	await _frames(30)
	check_equal(walker.gait.get_time(), time, "time stands still")
	check_equal(walker.global_transform, place, "it stays")
	check_equal(walker.footsteps.size(), steps, "no footsteps")
	get_tree().paused = false
	await _frames(5)
	check(walker.gait.get_time() > time, "it goes on")
	check_below(walker.gait.get_time() - time, 0.5, "without making up for the pause")


func test_disabled_it_holds_whichever_node_is() -> void:
	for which: int in 3:
		var walker := _walker(true)
		var node: Node = [walker, walker.skeleton, walker.gait][which]
		await _frames(10)
		node.process_mode = Node.PROCESS_MODE_DISABLED
		await _frames(2)
		var time := walker.gait.get_time()
		var place := walker.global_transform
		await _frames(20)
		check_equal(walker.gait.get_time(), time, "%s disabled: time stands still" % node.get_class())
		check_equal(walker.global_transform, place, "%s disabled: it stays" % node.get_class())
		node.process_mode = Node.PROCESS_MODE_INHERIT
		await _frames(5)
		check(walker.gait.get_time() > time, "%s disabled: it goes on" % node.get_class())
		walker.free()


func test_inactive_it_leaves_the_skeleton_alone() -> void:
	var walker := _walker()
	walker.walk(30)
	var time := walker.gait.get_time()
	var place := walker.global_transform
	walker.gait.active = false
	walker.walk(30)
	check_equal(walker.gait.get_time(), time, "time stands still")
	check_equal(walker.global_transform, place, "it stays")
	walker.gait.active = true
	walker.walk(1)
	check_near(walker.gait.get_time(), time + 1.0 / RATE, 1e-4, "it goes on where it was")


func test_hidden_it_walks_on() -> void:
	var hidden := _walker()
	var shown := _walker()
	hidden.visible = false
	hidden.walk(120)
	shown.walk(120)
	check_equal(hidden.global_transform, shown.global_transform, "the same way")
	check_equal(hidden.footsteps.size(), shown.footsteps.size(), "the same steps")


func test_teleported_it_walks_on_from_there() -> void:
	var walker := _walker()
	var other := _walker()
	walker.walk(60)
	other.walk(60)
	var there := Transform3D(Basis(Vector3.UP, 2.0), Vector3(500, 30, -200))
	walker.global_transform = there * walker.global_transform
	walker.footsteps.clear()
	other.footsteps.clear()
	walker.walk(120)
	other.walk(120)
	check_below(_apart(_pose(walker), _pose(other)), 1e-3, "the same poses")
	check_below(walker.global_position.distance_to(there * other.global_position), 2e-3, "the same way from there")
	for index: int in other.footsteps.size():
		var told: Vector3 = there * other.footsteps[index][1]
		check_below(told.distance_to(walker.footsteps[index][1]), 2e-3, "footsteps are told there")


func test_out_of_the_tree_it_holds_and_goes_on() -> void:
	var walker := _walker()
	var other := _walker()
	walker.walk(77)
	other.walk(77)
	var state := walker.gait.get_state()
	remove_child(walker)
	check_equal(walker.gait.get_state(), state, "the state outside")
	check_near(walker.gait.get_time(), 77.0 / RATE, 1e-3, "the time outside")
	await _frames(2)
	add_child(walker)
	walker.walk(60)
	other.walk(60)
	check_equal(walker.bones, other.bones, "as if it had not been away")
	check_equal(walker.gait.get_time(), other.gait.get_time(), "time")


func test_reparented_it_goes_on() -> void:
	var other := _walker()
	other.walk(137)
	var viewport := SubViewport.new()
	viewport.own_world_3d = true
	add_child(viewport)
	var platform := Node3D.new()
	platform.position = Vector3(3, 1, 2)
	viewport.add_child(platform)
	for where: Node in [platform, viewport]:
		var walker := _walker()
		walker.walk(77)
		walker.reparent(where)
		walker.walk(60)
		check_below(_apart(_pose(walker), _pose(other)), 1e-3, "the same poses below %s" % where.get_class())
		check_below(walker.global_position.distance_to(other.global_position), 1e-3, "the same place")
		walker.free()


func test_below_a_new_body_that_one_travels() -> void:
	var walker := _walker()
	walker.walk(77)
	var pose := _pose(walker)
	var body := CharacterBody3D.new()
	add_child(body)
	body.global_transform = walker.global_transform
	walker.reparent(body)
	var start := body.global_position
	walker.step(1.0 / RATE)
	check_below(_apart(_pose(walker), pose), 0.1, "the step goes on")
	check_near(walker.gait.get_time(), 78.0 / RATE, 1e-3, "the time goes on")
	walker.walk(60)
	check(body.global_position.distance_to(start) > 0.5, "the body travels: %s" % body.global_position)
	check_below(walker.position.length(), 1e-3, "and what it carries does not")


func test_on_another_skeleton_it_begins_anew() -> void:
	var walker := _walker()
	walker.walk(77)
	var other := _walker()
	other.gait.free()
	walker.gait.modification_processed.disconnect(walker._read_bones)
	walker.gait.reparent(other.skeleton)
	other.walk(30)
	check_near(walker.gait.get_time(), 30.0 / RATE, 0.02, "a walk of its own")
	check(other.global_position.z > 0.2, "the other character walks")


func test_taken_away_in_the_middle_of_its_own_signal() -> void:
	for what: String in ["removed", "reparented", "owner freed", "restarted"]:
		var walker := _walker()
		walker.gait.modification_processed.disconnect(walker._read_bones)
		var done := [0]
		var elsewhere := Node3D.new()
		add_child(elsewhere)
		walker.gait.footstep.connect(func(_foot: StringName, _place: Vector3) -> void:
			done[0] += 1
			if what == "removed" and walker.get_parent() == self:
				remove_child(walker)
			elif what == "reparented":
				walker.reparent(elsewhere if walker.get_parent() == self else self)
			elif what == "owner freed":
				walker.queue_free()
			elif what == "restarted":
				walker.gait.restart())
		for frame: int in 120:
			if walker.is_inside_tree():
				walker.step(1.0 / RATE)
		check(done[0] > 0, "%s: the handler ran" % what)
		if what == "removed":
			add_child(walker)
			walker.walk(60)
			check(walker.gait.get_time() > 1.0, "it goes on")
		await _frames(2)
		check_equal(is_instance_valid(walker), what != "owner freed", "%s: who is there" % what)
		if is_instance_valid(walker):
			walker.free()


func test_the_same_way_at_any_rate() -> void:
	var ways: Array[float] = []
	for rate: int in [30, 60, 144]:
		var walker := _walker()
		walker.walk(rate * 20, Callable(), 1.0 / rate)
		ways.append(walker.global_position.length())
	for way: float in ways:
		check_near(way, ways[1], 0.01 * ways[1], "way in 20 s at 30, 60 and 144 fps")


func test_in_slow_motion_the_same_way_in_more_time() -> void:
	var walker := _walker(true)
	Engine.time_scale = 0.25
	await _frames(2)
	var begin := Time.get_ticks_usec()
	var time_before := walker.gait.get_time()
	while Time.get_ticks_usec() - begin < 3_000_000:
		await get_tree().process_frame
	var real := (Time.get_ticks_usec() - begin) * 1e-6
	Engine.time_scale = 1.0
	var time := walker.gait.get_time()
	check_near(time - time_before, 0.25 * real, 0.05, "a quarter of the time passed")
	walker.skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_MANUAL
	var other := _walker()
	other.walk(roundi(time * 600.0), Callable(), 1.0 / 600.0)
	check_near(walker.global_position.z, other.global_position.z, 0.01 * other.global_position.z, "the way of that time")


func test_in_physics_frames_too() -> void:
	var walker := _walker()
	walker.skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_PHYSICS
	for frame: int in 61:
		await get_tree().physics_frame
	check_near(walker.gait.get_time(), 1.0, 0.05, "time")


func test_a_save_in_a_resource_goes_on_bit_for_bit() -> void:
	var script := GDScript.new()
	script.source_code = SAVE
	var script_file := "user://gait_save.gd"
	var file := "user://gait_save.tres"
	check_equal(ResourceSaver.save(script, script_file), OK, "the save's script")
	var save: Resource = (load(script_file) as GDScript).new()
	var walker := _walker()
	walker.gait.turn_rate = 0.3
	walker.walk(133)
	save.set(&"walk", walker.gait.get_state())
	save.set(&"place", walker.global_transform)
	check_equal(ResourceSaver.save(save, file), OK, "saved")
	var loaded: Resource = ResourceLoader.load(file, "", ResourceLoader.CACHE_MODE_IGNORE)
	var other := _walker()
	other.gait.turn_rate = 0.3
	other.gait.set_state(loaded.get(&"walk"))
	other.global_transform = loaded.get(&"place")
	check_equal(other.global_transform, walker.global_transform, "the place")
	# The frame that takes a state up shows it.
	other.step(0.0)
	for frame: int in 240:
		walker.step(1.0 / RATE)
		other.step(1.0 / RATE)
		check_equal(other.bones, walker.bones, "poses and places")
	DirAccess.remove_absolute(file)
	DirAccess.remove_absolute(script_file)
