extends Camera3D
## Looks at `target_position` and follows it. Drag to look around, turn the wheel to come closer.

@export var distance_m := 9.5
@export var heading := deg_to_rad(32.0)
@export var height := deg_to_rad(13.0)

## Point that it looks at, to be set in every frame.
var target_position := Vector3.ZERO

var _seen := Vector3.INF


func _unhandled_input(event: InputEvent) -> void:
	if event is InputEventMouseMotion and event.button_mask & MOUSE_BUTTON_MASK_LEFT:
		heading -= event.relative.x * 0.006
		height = clampf(height + event.relative.y * 0.005, 0.02, 1.4)
	elif event is InputEventMouseButton and event.pressed:
		if event.button_index == MOUSE_BUTTON_WHEEL_UP:
			distance_m = maxf(distance_m * 0.9, 1.5)
		elif event.button_index == MOUSE_BUTTON_WHEEL_DOWN:
			distance_m = minf(distance_m / 0.9, 40.0)


func _process(delta: float) -> void:
	if not _seen.is_finite():
		_seen = target_position
	_seen = _seen.lerp(target_position, 1.0 - exp(-6.0 * delta))
	look_from(_seen)


## Takes its place around a point at once.
func look_from(point: Vector3) -> void:
	var back := Vector3(sin(heading) * cos(height), sin(height), cos(heading) * cos(height))
	look_at_from_position(point + back * distance_m, point)
