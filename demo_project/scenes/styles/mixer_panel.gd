extends PanelContainer
## A slider for the weight of every style, and one for the speed of all walkers.

signal weights_changed(weights: PackedFloat32Array)
signal speed_changed(metres_per_second: float)

const SPEED := 1.0
## Below 0 a style is turned into its opposite, beyond 1 it is exaggerated.
const LEAST := -0.5
const MOST := 1.5

var _sliders: Array[HSlider] = []
var _speed: HSlider


## Makes a row for every style.
func build(styles: Array[GaitStyle]) -> void:
	for style: GaitStyle in styles:
		_sliders.append(_add_row(style.get_style_name().replace("_", " "), LEAST, MOST, "%.2f", func(_value: float) -> void:
			weights_changed.emit(weights())))
	_speed = _add_row("Speed, m/s", 0.0, 2.2, "%.2f", func(value: float) -> void: speed_changed.emit(value))
	%Reset.pressed.connect(reset)
	%Random.pressed.connect(randomise)
	%Other.pressed.connect(func() -> void: get_tree().change_scene_to_file("res://scenes/menu/menu.tscn"))


func weights() -> PackedFloat32Array:
	var weights := PackedFloat32Array()
	for slider: HSlider in _sliders:
		weights.append(slider.value)
	return weights


## Sets everything to what the scene begins with.
func reset() -> void:
	for slider: HSlider in _sliders:
		slider.value = 0.0
	_speed.value = SPEED


## Two styles by chance, each in part.
func randomise() -> void:
	for slider: HSlider in _sliders:
		slider.value = 0.0
	for count: int in 2:
		var chosen: HSlider = _sliders.pick_random()
		chosen.value = randf_range(0.4, 1.0)


func _unhandled_key_input(event: InputEvent) -> void:
	if event.is_pressed() and event.is_action(&"ui_cancel"):
		visible = not visible


func _add_row(title: String, least: float, most: float, form: String, changed: Callable) -> HSlider:
	var label := Label.new()
	label.text = title
	%Grid.add_child(label)
	var slider := HSlider.new()
	slider.min_value = least
	slider.max_value = most
	slider.step = 0.05
	slider.custom_minimum_size.x = 140.0
	slider.size_flags_vertical = Control.SIZE_SHRINK_CENTER
	%Grid.add_child(slider)
	var number := Label.new()
	number.custom_minimum_size.x = 48.0
	number.horizontal_alignment = HORIZONTAL_ALIGNMENT_RIGHT
	number.text = form % slider.value
	%Grid.add_child(number)
	slider.value_changed.connect(func(value: float) -> void:
		number.text = form % value
		changed.call(value))
	return slider
