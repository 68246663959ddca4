extends PanelContainer
## Sliders for what all walkers share.

signal speed_changed(metres_per_second: float)
signal turn_changed(radians_per_second: float)
signal seed_changed(first_seed: int)

const SPEED := 1.3
const TURN := 0.0
const FIRST_SEED := 1

## Title above the panel's sliders.
@export var title := ""
## The slowest speed to ask for: at 0 a trained model stands.
@export_range(0.0, 1.0, 0.1, "suffix:m/s") var slowest := 0.4
## The fastest speed to ask for: from about 2 m/s on a trained model runs.
@export_range(0.5, 6.0, 0.1, "suffix:m/s") var fastest := 2.0
## Label of the button to another scene, and that scene.
@export var other_title := ""
@export_file("*.tscn") var other_scene := ""

@onready var _speed: HSlider = %Speed
@onready var _turn: HSlider = %Turn
@onready var _seed: SpinBox = %Seed


func _ready() -> void:
	_speed.min_value = slowest
	_speed.max_value = fastest
	_speed.value_changed.connect(func(value: float) -> void:
		%SpeedValue.text = "%.2f m/s" % value
		speed_changed.emit(value))
	_turn.value_changed.connect(func(value: float) -> void:
		%TurnValue.text = "%.0f °/s" % value
		turn_changed.emit(deg_to_rad(value)))
	_seed.value_changed.connect(func(value: float) -> void: seed_changed.emit(int(value)))
	%Title.text = title
	%Other.text = other_title
	%Other.pressed.connect(func() -> void: get_tree().change_scene_to_file(other_scene))
	%Reset.pressed.connect(reset)
	reset()


## Sets everything to what the scene begins with.
func reset() -> void:
	_speed.value = SPEED
	_turn.value = TURN
	_seed.value = FIRST_SEED


func _unhandled_key_input(event: InputEvent) -> void:
	if event.is_pressed() and event.is_action(&"ui_cancel"):
		visible = not visible
