extends WalkingScene
## Eleven styles side by side, and in front of them a walker in the mixture that the sliders say.

const STYLES: Array[GaitStyle] = [
	preload("res://addons/footfall/models/proud.footstyle"),
	preload("res://addons/footfall/models/decided.footstyle"),
	preload("res://addons/footfall/models/sad.footstyle"),
	preload("res://addons/footfall/models/topmodel.footstyle"),
	preload("res://addons/footfall/models/drunk.footstyle"),
	preload("res://addons/footfall/models/cool.footstyle"),
	preload("res://addons/footfall/models/afraid.footstyle"),
	preload("res://addons/footfall/models/tiptoeing.footstyle"),
	preload("res://addons/footfall/models/heavy.footstyle"),
	preload("res://addons/footfall/models/in_a_hurry.footstyle"),
	preload("res://addons/footfall/models/manly.footstyle"),
]
const MIXER_COLOUR := Color("e0a13a")
const SPACING_M := 1.15
## The mixer walks this far ahead of the row, metres.
const AHEAD_M := 2.2
## All walk at one speed, or the row would fall apart.
const SPEED := 1.0


func _ready() -> void:
	_camera.distance_m = 13.0
	_camera.heading = deg_to_rad(8.0)
	_camera.height = deg_to_rad(17.0)
	var mixer := _add_walker("Mixer", Vector3(0.0, 0.0, AHEAD_M), MIXER_COLOUR)
	mixer.styles = STYLES
	mixer.style_weights = PackedFloat32Array([0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0])
	for index: int in STYLES.size():
		var style := STYLES[index]
		var x := (index - 0.5 * (STYLES.size() - 1)) * SPACING_M
		var colour := Color.from_hsv(float(index) / STYLES.size(), 0.3, 0.85)
		var gait := _add_walker(style.get_style_name(), Vector3(x, 0.0, 0.0), colour)
		gait.styles = [style]
		gait.style_weights = PackedFloat32Array([1.0])
	%Panel.build(STYLES)
	%Panel.weights_changed.connect(func(weights: PackedFloat32Array) -> void: mixer.style_weights = weights)
	%Panel.speed_changed.connect(func(speed: float) -> void: set_all(&"speed", speed))
	%Panel.reset()


func _process(_delta: float) -> void:
	_camera.target_position = walkers[0].global_position + Vector3(-1.7, 0.85, -0.5 * AHEAD_M)


func close_ups() -> Dictionary[String, Array]:
	var views := super()
	# From beside the row's last walker: the others stand in each other's way.
	views["side"][0] = walkers[-1].global_position + Vector3.UP * 0.9
	return views


func _add_walker(title: String, place: Vector3, colour: Color) -> GaitGenerator3D:
	var gait := add_walker(title, place, colour)
	gait.speed = SPEED
	Paint.label(walkers[-1], title.replace("_", " "))
	return gait
