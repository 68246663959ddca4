extends Node3D
## A small town in the evening: the player walks among its people, up its stair and its ramp, round its fountain.

const TOWN: Shader = preload("res://scenes/town/town.gdshader")
const MENU := "res://scenes/menu/menu.tscn"
const COLOURS: PackedColorArray = [
	Color("d5886d"), Color("78a4c0"), Color("dbb566"), Color("88b59d"), Color("a393c0"), Color("c57b88"), Color("848890"),
]
const PEOPLE := 84
const RUNNERS := 5
## Frames of a check: time to walk from the square onto the terrace.
const FRAMES_OF_CHECK := 900
## The player stands there at first.
const START := Vector3(0, 0, 14.5)
const VIEW := Vector3(deg_to_rad(-9.0), 0.0, 0.0)
## Start of a check, and the place to which the player walks without input.
const FOOT_OF_STAIR := Vector3(0.8, 0, -7.0)
const TERRACE := Vector3(1.5, TownPlan.RISE, -15.5)
## Start of a character that a sensor steers, with a free way ahead.
const BESIDE_START := Vector3(-17.0, 0, -9.0)
## Greatest depth of a walker in a wall, metres: half a body's width.
const MOST_DEPTH := 0.25
const TOUR_SECS := TownTour.SECS

var _checks := false
var _starts := PackedVector3Array()
var _deepest := 0.0
var _deepest_at := Vector3.ZERO
var _tour := TownTour.new()
var _pocket: TownPocketCheck

@onready var _player: GaitCharacter3D = %Player
@onready var _crowd: GaitCrowd3D = %Crowd
@onready var _guide: NavigationAgent3D = %Guide
@onready var _people: Townspeople = %People


func _ready() -> void:
	var paint := ShaderMaterial.new()
	paint.shader = TOWN
	%Square.build(paint)
	%Furniture.build(paint)
	%Ways.bake()
	_crowd.colours = COLOURS
	%Menu.pressed.connect(_open_menu)
	($World as NetworkWorld).came.connect(_become)
	%Doors.closed.connect(func() -> void: get_tree().reload_current_scene())
	%Doors.take(_player)
	_player.teleport(Transform3D(Basis(Vector3.UP, PI), START))
	(_player.get_node(^"Camera") as SpringArm3D).rotation = VIEW
	_bring_people()


## Nobody finds a way before the map is there.
func _bring_people() -> void:
	while not %Ways.is_on_map():
		await get_tree().physics_frame
	_people.come(PEOPLE, RUNNERS)
	if not OS.get_cmdline_user_args().is_empty():
		send_player(TERRACE)


func _unhandled_input(event: InputEvent) -> void:
	if event.is_action_pressed(&"ui_cancel") and not event is InputEventJoypadButton:
		_open_menu()
	var button := event as InputEventJoypadButton
	if button and button.pressed and button.button_index == JOY_BUTTON_START:
		_open_menu()


func _physics_process(_delta: float) -> void:
	if not _checks:
		return
	for place: Vector3 in _crowd.get_positions():
		var depth := TownPlan.depth_in_solids(place)
		if depth > _deepest:
			_deepest = depth
			_deepest_at = place


## Sends the player somewhere, around what is in the way.
func send_player(place: Vector3) -> void:
	_player.navigation = _guide
	_guide.target_position = place


func tour(seconds: float) -> void:
	_tour.play(seconds, self, _player, $Stage/Camera)


func close_ups() -> Dictionary[String, Array]:
	($Stage/Camera as Camera3D).make_current()
	return {
		"square": [Vector3(0, 2.5, -4), 22.0, 22.0, 26.0],
		"terrace": [Vector3(0, 1.0, 2.0), 165.0, 11.0, 18.0],
		"player": [_player.global_position + Vector3.UP * 0.9, 60.0, 8.0, 4.5],
	}


func is_getting_ready() -> bool:
	return _people.people.is_empty() or _crowd.is_making()


func begin_check() -> void:
	_player.teleport(Transform3D(Basis(Vector3.UP, PI), FOOT_OF_STAIR))
	# Straight on, even against others: an agent returns to places of its path that others kept it from.
	_player.autopilot = Vector3.FORWARD
	_starts = _crowd.get_positions()
	_checks = true
	_pocket = TownPocketCheck.new()
	_pocket.position = BESIDE_START
	add_child(_pocket)


func problems(frames: int) -> PackedStringArray:
	var found := PackedStringArray()
	var went := 0
	var places := _crowd.get_positions()
	for index: int in _starts.size():
		went += int(places[index].distance_to(_starts[index]) > 2.0)
	if went < 0.4 * _starts.size() or _starts.size() != PEOPLE:
		found.append("%d of %d people went anywhere in %d frames" % [went, _starts.size(), frames])
	if _deepest > MOST_DEPTH:
		found.append("a walker was %.2f m deep in a wall, at %s" % [_deepest, _deepest_at])
	found.append_array(_pocket.problems())
	if _player.global_position.y < TownPlan.RISE - 0.1:
		found.append("the player did not get up the stair: it is at %s" % _player.global_position)
	return found


## Goes on as the character that a game with others has made.
func _become(player: GaitCharacter3D) -> void:
	# A phone lets go of the character before it is freed.
	%Doors.take(player)
	$Bodies.queue_free()
	_player.queue_free()
	_player = player
	var camera: SpringArm3D = player.get_node(^"Camera")
	camera.rotation = VIEW
	camera.set(&"mouse_look", 1)


func _open_menu() -> void:
	get_tree().change_scene_to_file(MENU)
