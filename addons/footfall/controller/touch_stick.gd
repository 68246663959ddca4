extends Control
## Stick for the left thumb, on touchscreens only: it appears where a finger touches the left half of the screen.
##
## It presses the controller's movement actions, so a game need not know of it. Other fingers are ignored.

const GaitInput := preload("gait_input.gd")
const RADIUS := 90.0
const RING := Color(1, 1, 1, 0.35)
const KNOB := Color(1, 1, 1, 0.55)

var _finger := -1
var _begin := Vector2.ZERO
var _push := Vector2.ZERO


func _ready() -> void:
	set_process_unhandled_input(DisplayServer.is_touchscreen_available())


func _unhandled_input(event: InputEvent) -> void:
	var touch := event as InputEventScreenTouch
	if touch and touch.pressed and _finger < 0 and touch.position.x < 0.5 * get_viewport_rect().size.x:
		_finger = touch.index
		_begin = touch.position
		_steer(Vector2.ZERO)
		get_viewport().set_input_as_handled()
	elif touch and not touch.pressed and touch.index == _finger:
		_finger = -1
		_steer(Vector2.ZERO)
		get_viewport().set_input_as_handled()
	var drag := event as InputEventScreenDrag
	if drag and drag.index == _finger:
		_steer(((drag.position - _begin) / RADIUS).limit_length(1.0))
		get_viewport().set_input_as_handled()


func _exit_tree() -> void:
	if _finger >= 0:
		_finger = -1
		_steer(Vector2.ZERO)


func _draw() -> void:
	if _finger < 0:
		return
	draw_arc(_begin, RADIUS, 0.0, TAU, 48, RING, 3.0, true)
	draw_circle(_begin + _push * RADIUS, 0.4 * RADIUS, KNOB)


func _steer(push: Vector2) -> void:
	_push = push
	for way: Array in [[&"right", push.x], [&"left", -push.x], [&"back", push.y], [&"forward", -push.y]]:
		var action := GaitInput.action(way[0])
		if way[1] > 0.0:
			Input.action_press(action, way[1])
		else:
			Input.action_release(action)
	queue_redraw()
