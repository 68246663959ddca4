extends Node3D
## The player walks the plaza: a phone in the pocket or a sensor on the foot drives the character.

const GaitInput := preload("res://addons/footfall/controller/gait_input.gd")
const WALKER: PackedScene = preload("res://scenes/shared/walker.tscn")
const MODELS: Array[ImuModel] = [
	preload("res://addons/footfall/models/right_foot.footimu"),
	preload("res://addons/footfall/models/right_thigh.footimu"),
]
const COLOURS: PackedColorArray = [
	Color("d9d4c7"), Color("5f8fb0"), Color("d1a24c"), Color("6fa287"), Color("8d7bb0"), Color("6b7078"),
]
## Turning speed of the character by a stick or the arrow keys, radians a second.
const TURN_SPEED := 1.8
## Before, it is not known how the sensor is worn, and the player stands.
const FRAMES_BEFORE_PICTURES := 480

var _character: Node3D
var _driven: ImuReconstructor3D
var _stand_in: StandIn
var _without_user := not OS.get_cmdline_user_args().is_empty()
var _start := Vector3.ZERO
var _footsteps := 0

@onready var _camera: Camera3D = $Stage/Camera
@onready var _footprints: MultiMeshInstance3D = $Stage/Footprints
@onready var _panel: ConnectPanel = %Panel


func _ready() -> void:
	_camera.distance_m = 6.0
	_camera.heading = PI + 0.4
	_camera.height = deg_to_rad(16.0)
	%Crowd.colours = COLOURS
	_add_character()
	_panel.source_chosen.connect(_take_source)
	_panel.place_chosen.connect(func(place: int) -> void:
		_driven.model = MODELS[place]
		_calibrate())
	_panel.calibrate_pressed.connect(_calibrate)
	_panel.ahead_pressed.connect(_look_ahead)
	_panel.menu_pressed.connect(func() -> void: get_tree().change_scene_to_file("res://scenes/menu/menu.tscn"))
	_panel.choose(ConnectPanel.Kind.STAND_IN if _without_user else ConnectPanel.Kind.PHONE)


func _process(delta: float) -> void:
	if _without_user:
		# Ports are outside of the game, and have the world's time: frames are held to it.
		OS.delay_msec(int(1000.0 * delta))
	var steering := -GaitInput.move().x
	if steering != 0.0:
		_driven.turn(steering * TURN_SPEED * delta)
	_camera.heading -= GaitInput.look().x * 2.5 * delta
	_camera.target_position = _character.global_position + Vector3.UP * 0.9
	_panel.show_state(_driven)


func _add_character() -> void:
	_character = WALKER.instantiate()
	_character.name = "Player"
	Paint.apply(_character, Color("c96f53"))
	Paint.label(_character, "you")
	var gait: GaitGenerator3D = _character.get_node(^"%GaitGenerator3D")
	_driven = ImuReconstructor3D.new()
	_driven.model = MODELS[0]
	_driven.footstep.connect(func(foot: StringName, at: Vector3) -> void:
		_footsteps += 1
		_footprints.mark(foot, at, _character))
	gait.get_parent().add_child(_driven)
	gait.free()
	add_child(_character)


func _take_source(source: Resource, kind: ConnectPanel.Kind) -> void:
	_driven.source = source
	if _stand_in != null:
		_stand_in.free()
	if kind == ConnectPanel.Kind.STAND_IN:
		_stand_in = StandIn.new()
		_stand_in.port = source.port
		add_child(_stand_in)
	_calibrate()


## Finds out anew how the sensor is worn.
func _calibrate() -> void:
	_driven.start_calibration()


## The player looks at the screen: that is where the character goes, away from the camera.
func _look_ahead() -> void:
	var ahead := -_camera.global_basis.z
	var heading := atan2(ahead.x, ahead.z)
	_driven.turn(wrapf(heading - _character.global_rotation.y, -PI, PI))


func close_ups() -> Dictionary[String, Array]:
	var at := _character.global_position + Vector3.UP * 0.9
	return {
		"side": [at, 90.0, 5.0, 3.4],
		"front": [at, 3.0, 6.0, 3.4],
		"plaza": [at, 30.0, 18.0, 12.0],
	}


func begin_check() -> void:
	_start = _character.global_position


## Checks that a walker heard over the network walks the player once its mounting is known, after five seconds.
func problems(frames: int) -> PackedStringArray:
	var found := PackedStringArray()
	var sensor := _panel.sensor()
	if sensor.is_empty() or sensor.samples < 0.8 * (frames - 30) or sensor.lost > 0:
		found.append("of %d frames was heard: %s %s" % [frames, sensor, _panel.connection_text()])
	var walked_secs := frames / 60.0 - 6.0
	var went := _character.global_position.distance_to(_start)
	if went < 0.7 * walked_secs:
		found.append("the player went %.2f m in %d frames" % [went, frames])
	if _footsteps < walked_secs:
		found.append("%d footsteps in %d frames" % [_footsteps, frames])
	return found
