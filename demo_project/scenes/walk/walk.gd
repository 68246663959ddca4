extends WalkingScene
## Several characters walk side by side, each from its own seed and phase. A click on one of them pushes it.

## Places at which the walkers begin, metres: far enough from each other for their ways never to cross.
const PLACES: Array[Vector2] = [
	Vector2(0.0, 0.6), Vector2(-1.5, -0.5), Vector2(1.5, -0.2), Vector2(-3.0, 0.9), Vector2(3.0, 0.7),
	Vector2(-0.8, -2.1), Vector2(0.9, -2.4),
]
const COLOURS: Array[Color] = [
	Color("d9d4c7"), Color("c96f53"), Color("5f8fb0"), Color("d1a24c"), Color("6fa287"), Color("8d7bb0"), Color("b5626f"),
]
## Impulse of a push, newton seconds: enough for a step or two to the side.
const PUSH_NS := 60.0
## Distance from a walker's axis within which a click is on it, metres, and the height of the axis.
const CLICK_REACH_M := 0.35
const CLICK_HEIGHT_M := 1.75
## Motion of the mouse above which a press is a drag, pixels.
const DRAG_PX := 6.0

var _pressed_at := Vector2.INF


func _ready() -> void:
	for index: int in PLACES.size():
		add_walker("Walker%d" % (index + 1), Vector3(PLACES[index].x, 0.0, PLACES[index].y), COLOURS[index])
	follow(%Panel)


func _process(_delta: float) -> void:
	_camera.target_position = middle() + Vector3.UP * 0.85


func _unhandled_input(event: InputEvent) -> void:
	var button := event as InputEventMouseButton
	if button == null or button.button_index != MOUSE_BUTTON_LEFT:
		return
	if button.pressed:
		_pressed_at = button.position
	elif button.position.distance_to(_pressed_at) < DRAG_PX:
		push_at(button.position)


## Pushes the walker at a point of the window away from the camera; returns false where there is none.
func push_at(point: Vector2) -> bool:
	var eye := _camera.project_ray_origin(point)
	var look := _camera.project_ray_normal(point)
	var nearest: Node3D = null
	var nearest_m := CLICK_REACH_M
	for walker: Node3D in walkers:
		var feet := walker.global_position
		var between := Geometry3D.get_closest_points_between_segments(eye, eye + look * _camera.far, feet, feet + Vector3.UP * CLICK_HEIGHT_M)
		var far := between[0].distance_to(between[1])
		if far < nearest_m:
			nearest = walker
			nearest_m = far
	if nearest == null:
		return false
	gait_of(nearest).push(Vector3(look.x, 0.0, look.z).normalized() * PUSH_NS)
	return true


func problems(frames: int) -> PackedStringArray:
	var found := super(frames)
	if not push_at(_camera.unproject_position(walkers[0].global_position + Vector3.UP)):
		found.append("a click on %s pushed nobody" % walkers[0].name)
	return found
