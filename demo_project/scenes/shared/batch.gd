extends Node
## Runs the scene without a user, as asked after `--` on the command line:
##
## `--pictures FOLDER` saves what the scene shows, a picture every quarter of a second, then three close-ups, and quits.
## `--frames N` runs N frames, checks that everybody walked, prints `DEMO OK` and quits; the exit code is 1 when somebody did not.
##
## Start Godot with `--fixed-fps 60` for both, so that time runs by frames.

const PICTURES := 16
const FRAMES_BETWEEN := 15
## Name → a walker whom nobody hides, and heading and height in degrees and distance in metres of the camera around it.
const CLOSE_UPS := {
	"side": [4, 90.0, 5.0, 3.4],
	"front": [4, 3.0, 6.0, 3.4],
	"three_quarter": [0, 38.0, 12.0, 3.9],
}

@onready var _scene := get_parent()


func _ready() -> void:
	var arguments := OS.get_cmdline_user_args()
	for index: int in arguments.size() - 1:
		if arguments[index] == "--pictures":
			_take_pictures(arguments[index + 1])
		elif arguments[index] == "--frames":
			_run_frames(arguments[index + 1].to_int())


func _take_pictures(folder: String) -> void:
	DirAccess.make_dir_recursive_absolute(folder)
	# Drawn in software a frame takes a second: only what is saved is drawn.
	RenderingServer.render_loop_enabled = false
	await _frames(30)
	for picture: int in PICTURES:
		await _save(folder.path_join("frame_%04d.png" % picture))
		await _frames(FRAMES_BETWEEN)
	var camera: Camera3D = _scene.get_node(^"Stage/Camera")
	camera.set_process(false)
	_scene.get_node(^"Interface").hide()
	for view: String in CLOSE_UPS:
		var close_up: Array = CLOSE_UPS[view]
		camera.heading = deg_to_rad(close_up[1])
		camera.height = deg_to_rad(close_up[2])
		camera.distance_m = close_up[3]
		await _frames(8)
		camera.look_from(_scene.walkers[close_up[0]].global_position + Vector3.UP * 0.9)
		await _save(folder.path_join("hero_%s.png" % view))
	print("DEMO OK")
	get_tree().quit()


func _save(path: String) -> void:
	RenderingServer.render_loop_enabled = true
	await RenderingServer.frame_post_draw
	RenderingServer.render_loop_enabled = false
	var error := get_viewport().get_texture().get_image().save_png(path)
	if error != OK:
		printerr("cannot write %s: %s" % [path, error_string(error)])
		get_tree().quit(1)


func _run_frames(count: int) -> void:
	# The scene is ready after the nodes in it.
	await _frames(1)
	var starts: Array[Vector3] = []
	for walker: Node3D in _scene.walkers:
		starts.append(walker.global_position)
	await _frames(count)
	var problems := PackedStringArray()
	if starts.is_empty():
		problems.append("nobody is there")
	for index: int in starts.size():
		var walker: Node3D = _scene.walkers[index]
		var walked := walker.global_position.distance_to(starts[index])
		# Half of what the speed promises, after a second to get going.
		var expected: float = 0.5 * _scene.gait_of(walker).speed * maxf(count / 60.0 - 1.0, 0.0)
		if not walked > expected:
			problems.append("%s walked %.2f m instead of more than %.2f" % [walker.name, walked, expected])
	var least := starts.size() * (count / 60.0 - 1.0)
	if _scene.footsteps < least:
		problems.append("%d footsteps in %d frames, less than %d" % [_scene.footsteps, count, least])
	for problem: String in problems:
		printerr("DEMO FAILED: ", problem)
	if problems.is_empty():
		print("DEMO OK: %d walkers, %d footsteps" % [starts.size(), _scene.footsteps])
	get_tree().quit(0 if problems.is_empty() else 1)


func _frames(count: int) -> void:
	for frame: int in count:
		await get_tree().process_frame
