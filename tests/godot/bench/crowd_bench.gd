extends Node
## Measures crowds and skeletons in one run and prints a line of JSON after `BENCH `.
##
## After `--`: how many instances, and how many whole skeletons.

const MODEL := preload("res://addons/footfall/models/locomotion.footfall")
const DT := 1.0 / 60.0
const FRAMES := 240
## Frames after which every walker has taken steps of all its lengths, so that nothing grows any more.
const WARM_UP := 240

var _instances := 10_000
var _skeletons := 3000
## Of the crowd that was measured last: the longest frame but for two, a frame's time of all processors, and the memory that it holds.
var _longest_ms := 0.0
var _processor_ms := 0.0
var _bytes := 0


func _ready() -> void:
	var arguments := OS.get_cmdline_user_args()
	if arguments.size() >= 2:
		_instances = arguments[0].to_int()
		_skeletons = arguments[1].to_int()
	var camera := Camera3D.new()
	add_child(camera)
	camera.look_at_from_position(Vector3(0, 6, -60), Vector3.ZERO)
	camera.make_current()
	var figures := {"instances": _instances, "skeletons": _skeletons, "threads": OS.get_processor_count()}
	var tiers := await _crowd(func(crowd: GaitCrowd3D) -> void: crowd.full_count = 0)
	figures["tiers_ms"] = tiers
	figures["tiers_us_per_walker"] = 1000.0 * tiers / _instances
	figures["tiers_processor_ms"] = _processor_ms
	figures["tiers_longest_ms"] = _longest_ms
	# Before there was anybody whose memory could be used again.
	figures["tiers_bytes_per_walker"] = _bytes / _instances
	# Ten times as many on a square metre, some of whom run.
	figures["dense_ms"] = await _crowd(func(crowd: GaitCrowd3D) -> void:
		crowd.full_count = 0
		crowd.area *= sqrt(0.1)
		crowd.speed_range = Vector2(0.9, 3.2))
	figures["dense_processor_ms"] = _processor_ms
	var fresh := await _crowd(func(crowd: GaitCrowd3D) -> void:
		crowd.full_count = 0
		crowd.near_count = _instances
		crowd.near_distance = 1e6
		crowd.culling = false)
	figures["all_fresh_ms"] = fresh
	figures["all_fresh_us_per_walker"] = 1000.0 * fresh / _instances
	await _skeleton_tier(figures)
	await _making(figures)
	print("BENCH ", JSON.stringify(figures))
	get_tree().quit()


## Milliseconds of a frame of a crowd, all its work on all threads.
func _crowd(configure: Callable) -> float:
	var before := _held_bytes()
	var crowd := GaitCrowd3D.new()
	crowd.model = MODEL
	crowd.character = Skinned.scene()
	crowd.count = _instances
	crowd.area = Vector2(150, 150) * sqrt(_instances / 10_000.0)
	crowd.playing = false
	configure.call(crowd)
	add_child(crowd)
	for frame: int in WARM_UP:
		crowd.advance(DT)
	var times := PackedFloat32Array()
	var worked := _worked_ms()
	for frame: int in FRAMES:
		var begin := Time.get_ticks_usec()
		crowd.advance(DT)
		times.append((Time.get_ticks_usec() - begin) / 1000.0)
	_processor_ms = (_worked_ms() - worked) / FRAMES
	_bytes = _held_bytes() - before
	crowd.queue_free()
	await get_tree().process_frame
	times.sort()
	_longest_ms = times[times.size() - 3]
	# The mean of what is not among the tenth that something else slowed down.
	var sum := 0.0
	var counted := int(times.size() * 0.9)
	for index: int in counted:
		sum += times[index]
	return sum / counted


## Time that all threads of this process have worked, where the system tells.
func _worked_ms() -> float:
	var status := FileAccess.open("/proc/self/stat", FileAccess.READ)
	var fields := status.get_line().get_slice(") ", 1).split(" ") if status else PackedStringArray()
	# Hundredths of a second, in the program and in the system.
	return 10.0 * (fields[11].to_int() + fields[12].to_int()) if fields.size() > 12 else 0.0


## Bytes of memory that this process has, where the system tells.
func _held_bytes() -> int:
	var status := FileAccess.open("/proc/self/statm", FileAccess.READ)
	return status.get_line().get_slice(" ", 1).to_int() * 4096 if status else 0


## Ten thousand walkers that come at once, with a few whole scenes: the longest time that the crowd takes of a frame meanwhile.
func _making(figures: Dictionary) -> void:
	var clock: Array[int] = [0]
	var times := PackedFloat32Array()
	var crowd := GaitCrowd3D.new()
	crowd.model = MODEL
	crowd.character = Skinned.scene()
	crowd.count = 10
	crowd.area = Vector2(100, 100)
	var before := _at_process(func() -> void: clock[0] = Time.get_ticks_usec())
	add_child(crowd)
	var after := _at_process(func() -> void: times.append((Time.get_ticks_usec() - clock[0]) / 1000.0))
	for frame: int in 200:
		await get_tree().process_frame
	figures["start_longest_ms"] = _longest(times)
	times.clear()
	var places := PackedVector3Array()
	for index: int in _instances:
		places.append(Vector3(index % 100 - 50, 0, index / 100 - 50))
	var begin := Time.get_ticks_usec()
	var added: PackedInt32Array = crowd.add_agents(places, [])
	figures["add_agents_ms"] = (Time.get_ticks_usec() - begin) / 1000.0
	var usual := times.size()
	while crowd.is_making():
		await get_tree().process_frame
	figures["making_frames"] = times.size() - usual
	figures["making_longest_ms"] = _longest(times)
	times.clear()
	for frame: int in 120:
		await get_tree().process_frame
	figures["made_longest_ms"] = _longest(times)
	begin = Time.get_ticks_usec()
	crowd.remove_agents(added)
	figures["remove_agents_ms"] = (Time.get_ticks_usec() - begin) / 1000.0
	for node: Node in [before, crowd, after]:
		node.queue_free()


func _longest(times: PackedFloat32Array) -> float:
	var sorted := times.duplicate()
	sorted.sort()
	return sorted[-1]


## A node that does this in every frame, in its place among those that are added.
func _at_process(what: Callable) -> Node:
	var node := Ticker.new()
	node.what = what
	add_child(node)
	return node


class Ticker:
	extends Node
	var what: Callable

	func _process(_delta: float) -> void:
		what.call()


## Whole skeletons of a crowd: what the crowd takes of a frame with all of them, less what the engine takes to be told of the same bones. Each frame is drawn
## in between, so that the engine has posed everything: that is its own cost, and the same for whoever sets bones.
func _skeleton_tier(figures: Dictionary) -> void:
	var camera := get_viewport().get_camera_3d()
	camera.position = Vector3(0, 2, 0)
	var crowd := GaitCrowd3D.new()
	crowd.model = MODEL
	crowd.character = Skinned.scene()
	crowd.count = _skeletons
	crowd.area = Vector2(20, 20)
	crowd.full_count = _skeletons
	crowd.full_distance = 1e6
	crowd.near_distance = 1e6
	crowd.playing = false
	add_child(crowd)
	for frame: int in 20:
		crowd.advance(DT)
	crowd.process_mode = Node.PROCESS_MODE_DISABLED
	var characters: Array[Node3D] = []
	var skeletons: Array[Skeleton3D] = []
	for character: Node in crowd.get_children(true):
		var found := character.find_children("*", "Skeleton3D", true, false)
		if not found.is_empty():
			characters.append(character)
			skeletons.append(found[0])
	var walking := await _least_us(func() -> void: crowd.advance(DT))
	var bones := range(skeletons[0].get_bone_count())
	var turns: Array[Quaternion] = []
	for bone: int in bones:
		turns.append(skeletons[0].get_bone_pose_rotation(bone))
	var hips := skeletons[0].get_bone_pose_position(0)
	var places: Array[Transform3D] = []
	for character: Node3D in characters:
		places.append(character.transform)
	# A script that does the same calls, less a script that asks as often for what costs nothing.
	var setting := await _least_us(func() -> void:
		for index: int in skeletons.size():
			var skeleton := skeletons[index]
			characters[index].set_transform(places[index])
			skeleton.set_bone_pose_position(0, hips)
			for bone: int in bones:
				skeleton.set_bone_pose_rotation(bone, turns[bone]))
	var calling := await _least_us(func() -> void:
		for index: int in skeletons.size():
			var skeleton := skeletons[index]
			skeleton.is_bone_enabled(0)
			skeleton.is_bone_enabled(0)
			for bone: int in bones:
				skeleton.is_bone_enabled(bone))
	var own := maxf(setting - calling, 0.0)
	figures["skeleton_frame_us_per_walker"] = walking / skeletons.size()
	figures["skeleton_engine_us_per_walker"] = own / skeletons.size()
	figures["skeleton_us_per_walker"] = (walking - own) / skeletons.size()
	crowd.queue_free()


## Microseconds of a call, once a frame: the least of many, which nothing else slowed down.
func _least_us(what: Callable) -> float:
	var least := INF
	for frame: int in 200:
		await get_tree().process_frame
		var begin := Time.get_ticks_usec()
		what.call()
		least = minf(least, Time.get_ticks_usec() - begin)
	return least
