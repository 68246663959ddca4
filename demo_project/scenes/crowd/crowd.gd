extends Node3D
## Thousands of walkers from one `GaitCrowd3D`.

const COLOURS: PackedColorArray = [
	Color("d9d4c7"), Color("c96f53"), Color("5f8fb0"), Color("d1a24c"), Color("6fa287"), Color("8d7bb0"), Color("b5626f"), Color("6b7078"),
]
const STYLES: Array[GaitStyle] = [
	preload("res://addons/footfall/models/proud.footstyle"),
	preload("res://addons/footfall/models/sad.footstyle"),
	preload("res://addons/footfall/models/cool.footstyle"),
	preload("res://addons/footfall/models/topmodel.footstyle"),
]
## Number of walkers where pictures are drawn in software.
const FEW := 260

var _starts := PackedVector3Array()
var _footsteps := 0

@onready var _camera: Camera3D = $Stage/Camera
@onready var _crowd: GaitCrowd3D = %Crowd


func _ready() -> void:
	_camera.distance_m = 22.0
	_camera.height = deg_to_rad(17.0)
	_camera.target_position = Vector3(0, 0.9, 0)
	_crowd.colours = COLOURS
	_crowd.styles = STYLES
	_crowd.count = %Count.value if OS.get_cmdline_user_args().is_empty() else float(FEW)
	_crowd.footsteps.connect(func(agents: PackedInt32Array, _feet: PackedByteArray, _places: PackedVector3Array) -> void:
		_footsteps += agents.size())
	_bind(%Count, %CountValue, func(value: float) -> void: _crowd.count = int(value))
	_bind(%Near, %NearValue, func(value: float) -> void: _crowd.near_count = int(value))
	_bind(%Full, %FullValue, func(value: float) -> void: _crowd.full_count = int(value))
	%Menu.pressed.connect(func() -> void: get_tree().change_scene_to_file("res://scenes/menu/menu.tscn"))


func _process(_delta: float) -> void:
	var tiers := _crowd.get_tiers()
	%Figures.text = "%d whole, %d near, %d far\n%d frames a second" % [tiers.count(0), tiers.count(1), tiers.count(2), Engine.get_frames_per_second()]


func _bind(slider: HSlider, number: Label, changed: Callable) -> void:
	number.text = str(int(slider.value))
	slider.value_changed.connect(func(value: float) -> void:
		number.text = str(int(value))
		changed.call(value))


func close_ups() -> Dictionary[String, Array]:
	return {
		"among": [Vector3(0, 1.1, 0), 20.0, 7.0, 7.0],
		"above": [Vector3(0, 0, 0), 30.0, 30.0, 20.0],
	}


func is_getting_ready() -> bool:
	return _crowd.get_positions().is_empty() or _crowd.is_making()


func begin_check() -> void:
	_starts = _crowd.get_positions()


func problems(frames: int) -> PackedStringArray:
	var found := PackedStringArray()
	var walked := 0
	var places := _crowd.get_positions()
	for index: int in mini(_starts.size(), places.size()):
		walked += int(places[index].distance_to(_starts[index]) > 0.3 * maxf(frames / 60.0 - 1.0, 0.0))
	if _starts.is_empty() or walked < 0.8 * _starts.size():
		found.append("%d of %d walked" % [walked, _starts.size()])
	if _footsteps < _starts.size() * (frames / 60.0 - 1.0):
		found.append("%d footsteps in %d frames" % [_footsteps, frames])
	return found
