extends Node
## Measures crowds and skeletons in one run and prints a line of JSON after `BENCH `.
##
## After `--`: how many instances, and how many whole skeletons.

const MODEL := preload("res://addons/footfall/models/walk.footfall")
const DT := 1.0 / 60.0
const FRAMES := 240
## Frames after which every walker has taken steps of all its lengths, so that nothing grows any more.
const WARM_UP := 240

var _instances := 10_000
var _skeletons := 3000


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
	var fresh := await _crowd(func(crowd: GaitCrowd3D) -> void:
		crowd.full_count = 0
		crowd.near_count = _instances
		crowd.near_distance = 1e6
		crowd.culling = false)
	figures["all_fresh_ms"] = fresh
	figures["all_fresh_us_per_walker"] = 1000.0 * fresh / _instances
	var tiers := await _crowd(func(crowd: GaitCrowd3D) -> void: crowd.full_count = 0)
	figures["tiers_ms"] = tiers
	figures["tiers_us_per_walker"] = 1000.0 * tiers / _instances
	await _skeleton_tier(figures)
	print("BENCH ", JSON.stringify(figures))
	get_tree().quit()


## Milliseconds of a frame of a crowd, all its work on all threads.
func _crowd(configure: Callable) -> float:
	var crowd := GaitCrowd3D.new()
	crowd.model = MODEL
	crowd.character = Skinned.scene()
	crowd.count = _instances
	crowd.area = Vector2(150, 150)
	crowd.playing = false
	configure.call(crowd)
	add_child(crowd)
	for frame: int in WARM_UP:
		crowd.advance(DT)
	var times := PackedFloat32Array()
	for frame: int in FRAMES:
		var begin := Time.get_ticks_usec()
		crowd.advance(DT)
		times.append((Time.get_ticks_usec() - begin) / 1000.0)
	crowd.queue_free()
	await get_tree().process_frame
	times.sort()
	# The mean of what is not among the tenth that something else slowed down.
	var sum := 0.0
	var counted := int(times.size() * 0.9)
	for index: int in counted:
		sum += times[index]
	return sum / counted


## Whole skeletons of a crowd: the engine's frame with them idle, and with all of them walking.
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
	add_child(crowd)
	await _frames(20)
	crowd.playing = false
	crowd.process_mode = Node.PROCESS_MODE_DISABLED
	var idle := await _frame_ms()
	crowd.playing = true
	crowd.process_mode = Node.PROCESS_MODE_INHERIT
	var walking := await _frame_ms()
	figures["skeletons_idle_ms"] = idle
	figures["skeletons_walking_ms"] = walking
	figures["skeleton_us_per_walker"] = 1000.0 * (walking - idle) / _skeletons


func _frame_ms() -> float:
	await _frames(10)
	var begin := Time.get_ticks_usec()
	await _frames(FRAMES)
	return (Time.get_ticks_usec() - begin) / 1000.0 / FRAMES


func _frames(count: int) -> void:
	for frame: int in count:
		await get_tree().process_frame
