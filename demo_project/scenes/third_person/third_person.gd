extends Node3D
## The player walks the add-on's `GaitCharacter3D` over the course.

var _start := Vector3.ZERO
var _planted := 0

@onready var _player: GaitCharacter3D = %Player


func _ready() -> void:
	_player.position.x = ($Course as Course).lane_x(1)
	_player.placement.foot_planted.connect(func(_foot: StringName, _at: Vector3, _normal: Vector3) -> void: _planted += 1)
	%Menu.pressed.connect(func() -> void: get_tree().change_scene_to_file("res://scenes/menu/menu.tscn"))
	if not OS.get_cmdline_user_args().is_empty():
		_player.autopilot = Vector3.BACK


func _process(_delta: float) -> void:
	var speed := Vector2(_player.velocity.x, _player.velocity.z).length()
	%Figures.text = "%.1f m/s, grade %.0f %%" % [speed, 100.0 * _player.placement.get_grade()]


func close_ups() -> Dictionary[String, Array]:
	($Stage/Camera as Camera3D).make_current()
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
