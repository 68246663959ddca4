extends SpringArm3D
## Camera behind a character: follows smoothly, looks around by mouse, right stick and touch, and moves closer if a wall is in between.
##
## Its height follows more softly than the rest, so stairs look like a slope.

const GaitInput := preload("gait_input.gd")
## Distance from the target beyond which the camera jumps to it, metres: the character was teleported.
const FAR := 4.0
const LOWEST := deg_to_rad(-75.0)
const HIGHEST := deg_to_rad(50.0)

enum MouseLook {
	## A click captures the mouse, Escape releases it.
	CAPTURED,
	## The view turns while the left button is held.
	HELD,
	## The mouse has no effect.
	NONE,
}

## Use of the mouse for looking around.
@export var mouse_look := MouseLook.CAPTURED
## Angle by which the view turns for each pixel of mouse motion.
@export_range(0.0, 1.0, 0.01, "radians_as_degrees", "suffix:°/px") var mouse_speed := 0.005
## Speed at which the right stick turns the view.
@export_range(0.0, 360.0, 1.0, "radians_as_degrees", "suffix:°/s") var stick_speed := 2.5
## Half-life of the camera's distance from its place, along the ground.
@export_range(0.0, 1.0, 0.01, "suffix:s") var follow_half_life := 0.05
## Half-life of the camera's distance from its place, up and down.
@export_range(0.0, 1.0, 0.01, "suffix:s") var height_half_life := 0.15
## Closest and farthest distance by mouse wheel.
@export var distance_range := Vector2(1.2, 12.0)

## Point that the camera looks at, in global space; set by the character.
var _target := Vector3.INF
var _climb := 0.0


func _ready() -> void:
	top_level = true
	physics_interpolation_mode = Node.PHYSICS_INTERPOLATION_MODE_OFF
	var body := get_parent() as CollisionObject3D
	if body:
		add_excluded_object(body.get_rid())


## Moves the point that the camera looks at.
func follow(point: Vector3) -> void:
	if not _target.is_finite() or global_position.distance_to(point) > FAR:
		global_position = point
		_climb = 0.0
	_target = point


func _process(delta: float) -> void:
	turn(GaitInput.look() * stick_speed * delta)
	if not _target.is_finite():
		return
	var place := global_position.lerp(_target, 1.0 - _left(follow_half_life, delta))
	place.y = _height(delta)
	global_position = place


func _unhandled_input(event: InputEvent) -> void:
	if event.device == InputEvent.DEVICE_ID_EMULATION:
		return
	var motion := event as InputEventMouseMotion
	if motion and _looks(motion):
		turn(motion.screen_relative * mouse_speed)
	var drag := event as InputEventScreenDrag
	if drag:
		turn(drag.screen_relative * mouse_speed)
	var button := event as InputEventMouseButton
	if button and button.pressed:
		_press(button.button_index)
	if mouse_look == MouseLook.CAPTURED and event.is_action_pressed(&"ui_cancel"):
		Input.mouse_mode = Input.MOUSE_MODE_VISIBLE


## Turns the view: x to the right, y down, radians.
func turn(by: Vector2) -> void:
	rotation.y = wrapf(rotation.y - by.x, -PI, PI)
	rotation.x = clampf(rotation.x - by.y, LOWEST, HIGHEST)


func _looks(motion: InputEventMouseMotion) -> bool:
	match mouse_look:
		MouseLook.CAPTURED:
			return Input.mouse_mode == Input.MOUSE_MODE_CAPTURED
		MouseLook.HELD:
			return motion.button_mask & MOUSE_BUTTON_MASK_LEFT != 0
	return false


func _press(button: MouseButton) -> void:
	match button:
		MOUSE_BUTTON_WHEEL_UP:
			spring_length = maxf(spring_length * 0.9, distance_range.x)
		MOUSE_BUTTON_WHEEL_DOWN:
			spring_length = minf(spring_length / 0.9, distance_range.y)
		MOUSE_BUTTON_LEFT when mouse_look == MouseLook.CAPTURED:
			Input.mouse_mode = Input.MOUSE_MODE_CAPTURED


## The next height: a critically damped spring, which neither jumps nor swings.
func _height(delta: float) -> float:
	# Half of the way is left after 1.68 of its time constants.
	var rate := 1.68 / maxf(height_half_life, 1e-3)
	var off := global_position.y - _target.y
	var pull := (_climb + rate * off) * delta
	var left := exp(-rate * delta)
	_climb = (_climb - rate * pull) * left
	return _target.y + (off + pull) * left


func _left(half_life: float, delta: float) -> float:
	return pow(0.5, delta / half_life) if half_life > 0.0 else 0.0
