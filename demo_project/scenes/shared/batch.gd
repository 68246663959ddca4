extends Node
## Runs the scene without a user, as asked after `--` on the command line:
##
## `--pictures FOLDER` saves what the scene shows, a picture every quarter of a second, then three close-ups, and quits.
## `--film FOLDER` saves twenty pictures a second of the scene's tour, and quits.
## `--frames N` runs N frames, checks what the scene promises, prints `DEMO OK` and quits; the exit code is 1 when it did not keep it.
## `--speed MPS`, with one of these, asks all walkers of a scene of walkers for another speed.
## `--every-scene N` goes to the menu, which looks into all of them.
##
## The scene defines what is shown and checked: `close_ups()`, name → [place, heading and height in degrees, distance in metres] of
## the camera; `FRAMES_BEFORE_PICTURES`, when half a second is too early; `begin_check()`; and `problems(frames)`, what is wrong after so many of them;
## `FRAMES_OF_CHECK`, when what is checked takes longer than it is asked to run.
## A scene with `is_getting_ready()` is waited for. One with a tour has `TOUR_SECS` and `tour(seconds)`, which does what is due by then.
##
## Start Godot with `--fixed-fps 60`, so that time runs by frames. The check of a scene with a network takes real time, `--max-fps 30`.

const PICTURES := 16
const FRAMES_BETWEEN := 15
const FRAMES_OF_FILM := 3
@onready var _scene := get_parent()


func _ready() -> void:
	var arguments := OS.get_cmdline_user_args()
	for index: int in arguments.size() - 1:
		if arguments[index] == "--pictures":
			_take_pictures(arguments[index + 1])
		elif arguments[index] == "--film":
			_film(arguments[index + 1])
		elif arguments[index] == "--speed":
			_scene.set_all.call_deferred(&"speed", arguments[index + 1].to_float())
		elif arguments[index] == "--frames":
			_run_frames(arguments[index + 1].to_int())
		elif arguments[index] == "--every-scene":
			get_tree().change_scene_to_file.call_deferred("res://scenes/menu/menu.tscn")


func _take_pictures(folder: String) -> void:
	DirAccess.make_dir_recursive_absolute(folder)
	# Drawn in software a frame takes a second: only what is saved is drawn.
	RenderingServer.render_loop_enabled = false
	await _until_ready()
	await _frames(_scene.FRAMES_BEFORE_PICTURES if &"FRAMES_BEFORE_PICTURES" in _scene else 30)
	for picture: int in PICTURES:
		await _save(folder.path_join("frame_%04d.png" % picture))
		await _frames(FRAMES_BETWEEN)
	var camera: Camera3D = _scene.get_node(^"Stage/Camera")
	camera.set_process(false)
	_scene.get_node(^"Interface").hide()
	for view: String in _scene.close_ups():
		await _frames(8)
		var close_up: Array = _scene.close_ups()[view]
		camera.heading = deg_to_rad(close_up[1])
		camera.height = deg_to_rad(close_up[2])
		camera.distance_m = close_up[3]
		camera.look_from(close_up[0])
		await _save(folder.path_join("hero_%s.png" % view))
	print("DEMO OK")
	get_tree().quit()


func _film(folder: String) -> void:
	DirAccess.make_dir_recursive_absolute(folder)
	RenderingServer.render_loop_enabled = false
	await _until_ready()
	_scene.get_node(^"Interface").hide()
	for picture: int in roundi(_scene.TOUR_SECS * 60.0 / FRAMES_OF_FILM):
		for frame: int in FRAMES_OF_FILM:
			_scene.tour((picture * FRAMES_OF_FILM + frame) / 60.0)
			await _frames(1)
		await _save(folder.path_join("frame_%04d.png" % picture))
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


func _run_frames(asked: int) -> void:
	await _until_ready()
	var count := maxi(asked, _scene.FRAMES_OF_CHECK if &"FRAMES_OF_CHECK" in _scene else 0)
	_scene.begin_check()
	await _frames(count)
	var problems: PackedStringArray = _scene.problems(count)
	for problem: String in problems:
		printerr("DEMO FAILED: ", problem)
	if problems.is_empty():
		print("DEMO OK")
	get_tree().quit(0 if problems.is_empty() else 1)


## Time that runs by frames does not wait for what is made on other threads.
func _until_ready() -> void:
	# The scene is ready after the nodes in it.
	await _frames(1)
	while _scene.has_method(&"is_getting_ready") and _scene.is_getting_ready():
		await _frames(1)


func _frames(count: int) -> void:
	for frame: int in count:
		await get_tree().process_frame
