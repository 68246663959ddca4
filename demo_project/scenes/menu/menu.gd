extends Control
## The demo's scenes by topic.

## Scene → title and what it shows.
const SCENES: Array[Array] = [
	["res://scenes/town/town.tscn", "Town", "A square in the evening, and people in all styles to walk among"],
	["res://scenes/walk/walk.tscn", "Walk", "Seven walks from one model, none in step"],
	["res://scenes/styles/styles.tscn", "Styles", "Eleven styles, and one walker in any mixture of them"],
	["res://scenes/layers/layers.tscn", "Layers", "Clips wave, carry, aim and strike while the legs walk"],
	["res://scenes/uneven/uneven.tscn", "Uneven ground", "Slopes, stairs, rubble and a platform that moves"],
	["res://scenes/crowd/crowd.tscn", "Crowd", "Thousands on a plaza, each in its own way"],
	["res://scenes/third_person/third_person.tscn", "Third person", "Walk the course with keyboard, gamepad or touch"],
	["res://scenes/network/network.tscn", "Multiplayer", "Host a game or join one: the same steps on every machine"],
	["res://scenes/own_character/own_character.tscn", "Your own character", "Any humanoid from a .glb file walks"],
	["res://scenes/sensor/sensor.tscn", "One sensor", "A whole body from a sensor on one foot"],
	["res://scenes/live_sensor/live_sensor.tscn", "You", "A phone or a sensor that you wear drives the character"],
	["res://scenes/switching/switching.tscn", "Two linear systems", "Walkers of a model of ten kilobytes"],
]

@onready var _list: GridContainer = %List


func _ready() -> void:
	for entry: Array in SCENES:
		var button := Button.new()
		button.text = "%s\n%s" % [entry[1], entry[2]]
		button.alignment = HORIZONTAL_ALIGNMENT_LEFT
		button.custom_minimum_size = Vector2(460, 58)
		button.pressed.connect(func() -> void: get_tree().change_scene_to_file(entry[0]))
		_list.add_child(button)
	(_list.get_child(0) as Button).grab_focus()
	%Quality.item_selected.connect(_set_quality)
	%Quality.select(get_viewport().msaa_3d)
	%Quit.pressed.connect(func() -> void: get_tree().quit())
	_run_without_a_user()


func _set_quality(level: int) -> void:
	get_viewport().msaa_3d = level as Viewport.MSAA
	RenderingServer.directional_soft_shadow_filter_set_quality(level as RenderingServer.ShadowQuality)


## `--every-scene N` after `--` on the command line looks into every scene for so many frames and quits.
func _run_without_a_user() -> void:
	var arguments := OS.get_cmdline_user_args()
	if arguments.size() < 2 or arguments[0] != "--every-scene":
		return
	var missing := 0
	for entry: Array in SCENES:
		var scene: PackedScene = load(entry[0])
		var made := scene.instantiate() if scene != null else null
		if made == null:
			printerr("DEMO FAILED: %s does not load" % entry[0])
			missing += 1
			continue
		made.get_node(^"Batch").free()
		add_child(made)
		for frame: int in arguments[1].to_int():
			await get_tree().process_frame
		made.free()
	if missing == 0:
		print("DEMO OK")
	get_tree().quit(mini(missing, 1))
