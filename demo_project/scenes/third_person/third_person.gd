extends Node3D
## A `CharacterBody3D` that the player walks over the course.

const LOOK_SPEED := 2.5

var _start := Vector3.ZERO
var _planted := 0

@onready var _camera: Camera3D = $Stage/Camera
@onready var _player: GaitCharacter = %Player


func _ready() -> void:
	_camera.distance_m = 4.5
	_camera.heading = PI
	_camera.height = deg_to_rad(16.0)
	_player.position.x = ($Course as Course).lane_x(1)
	_player.placement.foot_planted.connect(func(_foot: StringName, _at: Vector3, _normal: Vector3) -> void: _planted += 1)
	%Menu.pressed.connect(func() -> void: get_tree().change_scene_to_file("res://scenes/menu/menu.tscn"))
	if not OS.get_cmdline_user_args().is_empty():
		_player.autopilot = Vector3.BACK


func _process(delta: float) -> void:
	var look := Input.get_vector(&"look_left", &"look_right", &"look_up", &"look_down")
	_camera.heading -= look.x * LOOK_SPEED * delta
	_camera.height = clampf(_camera.height + look.y * LOOK_SPEED * delta, 0.02, 1.4)
	_camera.target_position = _player.global_position + Vector3.UP * 1.1
	_player.view_heading = _camera.heading
	%Figures.text = "%.1f m/s, grade %.0f %%" % [_player.get_real_velocity().length(), 100.0 * _player.placement.get_grade()]


func close_ups() -> Dictionary[String, Array]:
	var at := _player.global_position + Vector3.UP * 0.9
	return {
		"side": [at, 90.0, 6.0, 3.4],
		"behind": [at, 195.0, 16.0, 3.6],
	}


func begin_check() -> void:
	_start = _player.global_position


func problems(frames: int) -> PackedStringArray:
	var found := PackedStringArray()
	var walked := _player.global_position.distance_to(_start)
	if walked < 0.4 * maxf(frames / 60.0 - 1.5, 0.0):
		found.append("the player walked %.2f m in %d frames" % [walked, frames])
	if _planted < frames / 60.0:
		found.append("%d feet were planted in %d frames" % [_planted, frames])
	return found
