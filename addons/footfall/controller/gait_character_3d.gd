@tool
class_name GaitCharacter3D
extends CharacterBody3D
## Character for keyboard, gamepad and touch that moves by its own steps: root motion moves the body, physics stops it.
##
## Put `gait_character_3d.tscn` into a scene with a floor and set your character as [member character_scene]. It faces +Z, as
## imported characters do. The capsule steps onto edges at once; the character in it and the camera follow smoothly.

## Emitted when the character leaves the ground in a jump.
signal jumped
## Emitted when the character lands after a jump or a fall, at this fall speed in m/s.
signal landed(fall_speed: float)

const GaitInput := preload("gait_input.gd")
const GaitFigure := preload("gait_figure.gd")
## Time without a floor after which the character is in the air, seconds; shorter is a gap between two steps.
const FALL_SECS := 0.12
## Time in which the rest of a turn is turned, seconds, and time by which the steps go on turning after a request.
const TURN_SECS := 0.3
const TURN_LAG_SECS := 0.2
## Angles of a turn from which on the character slows down, and at which it has slowed down to the share below to turn on a planted foot, radians.
const SLOW_FROM := 1.75
const SLOWEST_FROM := 2.6
const SLOWEST_SHARE := 0.3
## Angle below which a standing character does not take a step, radians.
const LEAST_TURN := 0.15
## Distance ahead at which an edge is looked for, metres.
const EDGE_REACH := 0.08
## Ground that is lower by less is level, metres.
const EDGE_SLACK := 0.001
## Share of its height that a crouching character's capsule has, and the time until then, seconds.
const CROUCHED_HEIGHT := 0.65
const CROUCH_SECS := 0.3
## Distance within which a jump goes onto a wall, metres.
const WALL_REACH := 0.7
## Time within which a character that a wall has held back in a jump returns to the jump's path, seconds.
const CATCH_UP_SECS := 0.1
## Height of the camera's target above the ground, as a share of the character's height.
const EYE_HEIGHT := 0.8

## Your character: an imported glTF or FBX file, or a scene made from one. It may contain a [GaitGenerator3D] and a [FootPlacement3D];
## missing ones are added.
@export var character_scene: PackedScene:
	set(value):
		character_scene = value
		_wear()
## Assignment of bones, for rigs that [GaitGenerator3D] does not recognise.
@export var bone_map: BoneMap:
	set(value):
		bone_map = value
		_wear()
## If [code]true[/code], the capsule is sized to the character's skeleton.
@export var measure_capsule := true

@export_group("Walking")
## Walking speed. Stay within the model's range: [method GaitModel.get_speed_range].
@export_range(0.0, 3.0, 0.05, "or_greater", "suffix:m/s") var walk_speed := 1.3
## Speed while the action `hurry` is pressed.
@export_range(0.0, 5.0, 0.05, "or_greater", "suffix:m/s") var hurry_speed := 3.2
## Maximum turn rate towards the requested direction.
@export_range(0.0, 360.0, 1.0, "or_greater", "radians_as_degrees", "suffix:°/s") var max_turn_rate := 3.5
## Height of the highest edge that is a step; higher edges are walls.
@export_range(0.0, 0.5, 0.01, "or_greater", "suffix:m") var step_height := 0.22
## Half-life of the character's distance from its capsule after an edge, which the capsule steps onto at once.
@export_range(0.0, 0.5, 0.01, "suffix:s") var step_half_life := 0.15

@export_group("Air")
## Rise of the hips in a jump, and height of the highest wall that it jumps onto; 0 turns jumps off.
@export_range(0.0, 2.0, 0.01, "or_greater", "suffix:m") var jump_height := 0.45
## Acceleration by steering in the air.
@export_range(0.0, 20.0, 0.1, "suffix:m/s²") var air_acceleration := 3.0

@export_group("Steering")
## If [code]true[/code], keyboard, gamepad and touch steer the character. Turn it off for characters that only scripts or `navigation` steer.
@export var player_controlled := true
## If [code]true[/code], the character faces where the camera looks, in whatever direction it goes; the action `aim` does the same.
@export var aims := false
## Navigation agent that the character follows, around obstacles, while nothing else steers it.
@export var navigation: NavigationAgent3D

## Direction on the ground, of length 0 to 1, for walking without a player.
var autopilot := Vector3.ZERO
## If [code]true[/code], the character crouches without a player.
var crouches := false
## The generator that walks the character; [code]null[/code] without a character.
var gait: GaitGenerator3D:
	get:
		return _figure.gait if _figure else null
## The foot placement that keeps the feet on the ground; [code]null[/code] without a character.
var placement: FootPlacement3D:
	get:
		return _figure.placement if _figure else null

## Identity of the walk for the other peers of a multiplayer game; see [member GaitGenerator3D.replica_identity].
## Add [code]gait_synchronizer.tscn[/code] below the character.
var replica_identity: PackedByteArray:
	get:
		return gait.replica_identity if gait else PackedByteArray()
	set(identity):
		if gait:
			gait.replica_identity = identity
## Progress of the walk for the other peers; see [member GaitGenerator3D.replica_state].
var replica_state: PackedByteArray:
	get:
		return gait.replica_state if gait else PackedByteArray()
	set(state):
		if gait:
			gait.replica_state = state

var _standing_height := 0.0
## True while the body still has to move in this frame, and the steps that it moves by.
var _due := false
var _steps := Transform3D.IDENTITY
## Turn rate of the steps in the last frame, radians per second.
var _turning := 0.0
var _wish := Vector3.ZERO
var _leaps := false
## True while the generator's jump has the body in the air, and the distance by which a wall has held it back from that.
var _soars := false
var _behind := Vector3.ZERO
var _air_secs := 0.0

@onready var _figure: GaitFigure = $Figure
@onready var _shape: CollisionShape3D = $Shape
@onready var _camera: Node = get_node_or_null(^"Camera")


func _enter_tree() -> void:
	if Engine.is_editor_hint() or is_multiplayer_authority():
		return
	# Another peer's character is not steered here and needs no camera. Its camera in the tree would take over the view.
	player_controlled = false
	for path: NodePath in [^"Camera", ^"TouchStick"]:
		if has_node(path):
			get_node(path).free()


func _ready() -> void:
	_wear()


func _get_configuration_warnings() -> PackedStringArray:
	if character_scene == null:
		return ["Set Character Scene: drag your character's file from the FileSystem dock onto it."]
	if gait == null:
		return ["%s has no Skeleton3D. Set Character Scene to a character with a humanoid skeleton." % character_scene.resource_path]
	return gait.get_problems()


func _physics_process(delta: float) -> void:
	if Engine.is_editor_hint():
		return
	if _due:
		# The generator has not walked since the last frame: there is no character, or no model.
		_travel()
	_due = true
	_wish = _wished()
	if gait and not gait.is_replica():
		_steer()
		_crouch(delta)
	if player_controlled and GaitInput.is_just_pressed(&"jump"):
		jump()
	if _camera and _camera.has_method(&"follow"):
		_camera.call(&"follow", _figure.global_position + Vector3.UP * EYE_HEIGHT * _standing_height)


## Jumps, if the character is on the ground: onto a wall in front of it, else up, or over what is ahead while it walks or runs.
func jump() -> void:
	if not is_on_floor() or jump_height <= 0.0:
		return
	var top := _wall_ahead() if gait else Vector3.INF
	# It bends its knees first, and emits a signal when it leaves the ground.
	if gait and (gait.jump_to(top) if top.is_finite() else gait.jump(jump_height)):
		return
	_take_off()


## Jumps to a nearby place in global space, such as the other side of a gap; see [method GaitGenerator3D.jump_to].
func jump_to(place: Vector3) -> void:
	if is_on_floor() and gait:
		gait.jump_to(place)


## Teleports the character and lets it stand, without a transition.
func teleport(place: Transform3D) -> void:
	global_transform = place.orthonormalized()
	velocity = Vector3.ZERO
	reset_physics_interpolation()
	_figure.catch_up()


func _wear() -> void:
	if _figure == null:
		return
	_figure.wear(character_scene, bone_map)
	var capsule := _shape.shape as CapsuleShape3D
	var size := _figure.measure()
	if measure_capsule and capsule and size.x > 0.0:
		capsule.height = size.x
		capsule.radius = 0.5 * size.y
		_shape.position.y = 0.5 * size.x
	_standing_height = capsule.height if capsule else size.x
	if gait and not Engine.is_editor_hint():
		gait.modification_processed.connect(_follow_steps)
		gait.took_off.connect(_rise)
		gait.landed.connect(_come_down)
	update_configuration_warnings()


## Returns the wished direction on the ground, of length 0 to 1.
func _wished() -> Vector3:
	if autopilot != Vector3.ZERO:
		return Vector3(autopilot.x, 0.0, autopilot.z).limit_length(1.0)
	var stick := GaitInput.move() if player_controlled else Vector2.ZERO
	if stick == Vector2.ZERO and navigation and not navigation.is_navigation_finished():
		var way := navigation.get_next_path_position() - global_position
		return Vector3(way.x, 0.0, way.z).limit_length(1.0)
	return Vector3(stick.x, 0.0, stick.y).rotated(Vector3.UP, _view_heading())


## Returns the camera's heading as seen from its target, radians about +Y.
func _view_heading() -> float:
	var camera := get_viewport().get_camera_3d()
	if camera == null:
		return global_rotation.y + PI
	return atan2(camera.global_basis.z.x, camera.global_basis.z.z)


func _steer() -> void:
	var walks := _wish.length() >= 0.1
	var way := wrapf(atan2(_wish.x, _wish.z) - global_rotation.y, -PI, PI)
	var hurries := player_controlled and GaitInput.is_pressed(&"hurry")
	gait.speed = _wish.length() * (hurry_speed if hurries else walk_speed) if walks else 0.0
	gait.direction = 0.0
	if aims or (player_controlled and GaitInput.is_pressed(&"aim")):
		# It faces where the camera looks, and goes sideways and backwards.
		gait.direction = way if walks else 0.0
		_turn_by(_view_heading() + PI - global_rotation.y)
	elif walks:
		_turn_by(way)
		gait.speed *= clampf(remap(absf(way), SLOW_FROM, SLOWEST_FROM, 1.0, SLOWEST_SHARE), SLOWEST_SHARE, 1.0)
	else:
		gait.turn_rate = 0.0


## Turns towards the requested direction. The current step also turns while its foot is in the air.
func _turn_by(angle: float) -> void:
	var left := wrapf(angle - TURN_LAG_SECS * _turning, -PI, PI)
	var idle := gait.speed == 0.0 and absf(left) < LEAST_TURN
	gait.turn_rate = 0.0 if idle else clampf(left / TURN_SECS, -max_turn_rate, max_turn_rate)


## Crouches; under a low ceiling it stays down.
func _crouch(delta: float) -> void:
	var down := gait.crouch
	var wanted := 1.0 if crouches or (player_controlled and GaitInput.is_pressed(&"crouch")) else 0.0
	if wanted < down and test_move(global_transform, Vector3.UP * (_standing_height * (1.0 - CROUCHED_HEIGHT) * down)):
		wanted = down
	down = move_toward(down, wanted, delta / CROUCH_SECS)
	gait.crouch = down
	var capsule := _shape.shape as CapsuleShape3D
	if capsule:
		capsule.height = _standing_height * lerpf(1.0, CROUCHED_HEIGHT, down)
		_shape.position.y = 0.5 * capsule.height


## Called by the generator, before the feet are placed.
func _follow_steps() -> void:
	if _due:
		_steps = gait.get_root_motion_delta()
		_travel()


## Moves the body for a frame, by what the steps travelled or as it flies.
func _travel() -> void:
	var delta := get_physics_process_delta_time()
	var begin := global_position.y
	var carried := get_platform_velocity().y * delta
	var flies := _flies()
	var fall := velocity.y + get_gravity().y * delta
	if flies:
		velocity = _flight(delta)
	else:
		velocity = _figure.global_basis * _steps.origin / delta
		if _soars:
			fall = velocity.y
			velocity += _behind / CATCH_UP_SECS
		else:
			var climbs := _air_secs == 0.0 and _step_up(delta)
			if climbs or is_on_floor():
				fall = 0.0
	velocity.y = fall
	var wanted := velocity * delta - _behind * (delta / CATCH_UP_SECS) + _behind
	var from := global_position
	move_and_slide()
	_behind = (wanted - global_position + from) * Vector3(1, 0, 1) if _soars else Vector3.ZERO
	var turned := _steps.basis.get_euler().y
	_turning = turned / delta
	rotation.y += turned + get_platform_angular_velocity().y * delta
	_steps = Transform3D.IDENTITY
	_due = false
	if not flies and not _soars:
		_figure.stay_below(global_position.y - begin - carried)
	_figure.follow(step_half_life, delta)
	_stay_or_land(-fall, delta)


## Velocity along the ground in the air.
func _flight(delta: float) -> Vector3:
	var level := Vector3(velocity.x, 0.0, velocity.z)
	return level.move_toward(_wish * walk_speed, air_acceleration * delta) if _wish != Vector3.ZERO else level


func _take_off() -> void:
	velocity.y = sqrt(2.0 * get_gravity().length() * jump_height)
	_leaps = true
	jumped.emit()


## The generator's jump leaves the ground.
func _rise() -> void:
	_soars = true
	jumped.emit()


## Called when a foot of the generator's jump reaches its landing. Without ground there, the character falls on.
func _come_down(_foot: StringName) -> void:
	if _soars and (is_on_floor() or test_move(global_transform, Vector3.DOWN * step_height)):
		landed.emit(-velocity.y)
	_soars = false


## The top of a wall ahead that is neither too high nor too narrow to stand on; infinite without one.
func _wall_ahead() -> Vector3:
	var capsule := _shape.shape as CapsuleShape3D
	var radius := capsule.radius if capsule else 0.3
	var ahead := _figure.global_basis.z.normalized()
	if not test_move(global_transform.translated(Vector3.UP * step_height), ahead * WALL_REACH):
		return Vector3.INF
	# The space above it must be free, and there must be ground to stand on.
	var over := global_transform.translated(Vector3.UP * (jump_height + step_height))
	var onto := ahead * (WALL_REACH + radius)
	var down := KinematicCollision3D.new()
	if test_move(over, onto) or not test_move(over.translated(onto), Vector3.DOWN * jump_height, down):
		return Vector3.INF
	return over.origin + onto + down.get_travel()


func _flies() -> bool:
	return _leaps or _air_secs > FALL_SECS


## In the air, feet are left to the animation, which waits for the ground.
func _stay_or_land(fall: float, delta: float) -> void:
	if is_on_floor():
		if _flies():
			landed.emit(fall)
		_leaps = false
		_air_secs = 0.0
	elif _soars:
		_air_secs = 0.0
	elif _air_secs > 0.0 or not test_move(global_transform, Vector3.DOWN * step_height):
		# Above ground that is near, the capsule slides off an edge.
		_air_secs += delta
	var airborne := _flies() or _soars
	if placement and placement.in_air != airborne:
		placement.in_air = airborne
	if gait:
		# The generator has jumps, but no falls.
		gait.playing = not _flies()


## Climbs an edge that is low enough: a capsule alone would stop at it, and a slow one slide back off it. Returns whether there is
## such an edge.
func _step_up(delta: float) -> bool:
	var ahead := velocity * delta
	if ahead.length() < 1e-4:
		return false
	var reach := ahead.normalized() * EDGE_REACH + ahead
	var over := global_transform
	if test_move(over, reach):
		over = over.translated(Vector3.UP * step_height)
		if test_move(over, reach):
			return false
	elif is_on_floor():
		return false
	var down := KinematicCollision3D.new()
	if not test_move(over.translated(reach), Vector3.DOWN * step_height, down):
		return false
	var height := over.origin.y + down.get_travel().y
	if height < global_position.y - EDGE_SLACK:
		# The ground ahead is lower.
		return false
	global_position.y = maxf(global_position.y, height)
	return true
