class_name GaitCharacter
extends CharacterBody3D
## A character for keyboard and gamepad that walks by its own steps: root motion moves the body, physics stops it.
##
## Needs a character below it with a `GaitGenerator3D` (`root_motion` off, unique name) and, for uneven ground, a `FootPlacement3D`.
## Copy it into your game.

## How fast the character walks and hurries, metres per second. Keep to what the model knows: `GaitModel.get_speed_range()`.
@export var walk_speed := 1.3
@export var hurry_speed := 2.0
## How fast it turns towards where it is asked to go: radians per second for each radian, and at most.
@export var turn_gain := 3.0
@export var max_turn_rate := 2.0
## Higher edges than this are walls, metres.
@export var step_height := 0.22

## Where the camera looks, radians about +Y; what "forwards" on the stick means.
var view_heading := PI
## Walks where this agent is sent, around what is in the way, while nobody steers.
@export var navigation: NavigationAgent3D
## Set to walk without a player: a direction on the ground, of length 0 to 1.
var autopilot := Vector3.ZERO
## Whether it faces where the camera looks, whatever way it goes; the player's `aim` does the same.
var aims := false

@onready var gait: GaitGenerator3D = $Body.get_node(^"%GaitGenerator3D")
@onready var placement: FootPlacement3D = $Body.get_node(^"%FootPlacement3D")


func _ready() -> void:
	Actions.register()
	gait.root_motion = false
	gait.speed = 0.0
	placement.follow_ground = false
	var skeleton := gait.get_skeleton()
	# Body and steps move in the same frame, and it is physics' frame.
	skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_PHYSICS
	gait.modification_processed.connect(_follow_steps)


func _physics_process(_delta: float) -> void:
	var wish := _wish()
	var way := wrapf(atan2(wish.x, wish.z) - rotation.y, -PI, PI)
	var walks := wish.length() >= 0.1
	var top := hurry_speed if Input.is_action_pressed(&"hurry") else walk_speed
	gait.speed = minf(wish.length(), 1.0) * top if walks else 0.0
	gait.direction = 0.0
	if aims or Input.is_action_pressed(&"aim"):
		# It faces where the camera looks, and goes sideways and backwards.
		gait.direction = way if walks else 0.0
		_turn_by(wrapf(view_heading + PI - rotation.y, -PI, PI))
	elif walks:
		_turn_by(way)
		# Who has to turn far slows down, or turns on the spot.
		gait.speed *= clampf(1.3 - absf(way), 0.0, 1.0)
	else:
		gait.turn_rate = 0.0


func _turn_by(angle: float) -> void:
	# Too little to take a step for.
	var asked := 0.0 if gait.speed == 0.0 and absf(angle) < 0.15 else turn_gain * angle
	gait.turn_rate = clampf(asked, -max_turn_rate, max_turn_rate)


func _wish() -> Vector3:
	if autopilot != Vector3.ZERO:
		return autopilot
	var stick := Input.get_vector(&"walk_left", &"walk_right", &"walk_forward", &"walk_back")
	if stick == Vector2.ZERO and navigation and not navigation.is_navigation_finished():
		var way := navigation.get_next_path_position() - global_position
		return Vector3(way.x, 0.0, way.z).limit_length(1.0)
	return Vector3(stick.x, 0.0, stick.y).rotated(Vector3.UP, view_heading)


## Moves the body by what the last steps travelled. Called by the generator in every physics frame, before the feet are placed.
func _follow_steps() -> void:
	var delta := get_physics_process_delta_time()
	var motion := gait.get_root_motion_delta()
	var fall := velocity.y - 9.8 * delta if not is_on_floor() else 0.0
	velocity = global_basis * motion.origin / delta + Vector3.UP * fall
	_step_up(delta)
	move_and_slide()
	rotation.y += motion.basis.get_euler().y
	placement.in_air = not is_on_floor() and fall < -2.0


## Climbs an edge that is low enough: a capsule alone would stop at it.
func _step_up(delta: float) -> void:
	var ahead := Vector3(velocity.x, 0.0, velocity.z) * delta
	if ahead.length() < 1e-4 or not is_on_floor():
		return
	var reach := ahead.normalized() * 0.08 + ahead
	if not test_move(global_transform, reach):
		return
	var raised := global_transform.translated(Vector3.UP * step_height)
	if test_move(raised, reach):
		return
	var down := KinematicCollision3D.new()
	if test_move(raised.translated(reach), Vector3.DOWN * step_height, down):
		global_position.y += step_height + down.get_travel().y
