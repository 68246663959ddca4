class_name SensorWalk
extends Node
## Steers a [GaitCharacter3D] by a sensor: the body that the sensor reconstructs is out of sight, and the character goes as fast, turns as far, and jumps when it jumps.
##
## Unlike a body that is reconstructed in view, the character meets walls, stairs and others as with any other input.

const GaitInput := preload("res://addons/footfall/controller/gait_input.gd")
const FIGURE: PackedScene = preload("res://scenes/shared/walker.tscn")
const OUT_OF_SIGHT := Vector3(0, -50, 0)
## Turning speed by a stick or the arrow keys, radians a second.
const TURN_SPEED := 1.8
## Time over which the body's speed is taken: a step, in which it rises and falls.
const STEP_SECS := 0.5
## Slower bodies stand.
const LEAST_MPS := 0.25

var player: GaitCharacter3D
## Body that the sensor reconstructs.
var driven := ImuReconstructor3D.new()

var _speed := 0.0
var _heading := 0.0
var _walk_speed := 0.0


## Worn on a part of the body that the model knows, by a player who faces where the character does.
func _init(model: ImuModel, character: GaitCharacter3D) -> void:
	driven.model = model
	driven.root_motion = false
	player = character


func _ready() -> void:
	var figure: Node3D = FIGURE.instantiate()
	figure.visible = false
	figure.position = OUT_OF_SIGHT
	var gait: GaitGenerator3D = figure.get_node(^"%GaitGenerator3D")
	gait.get_parent().add_child(driven)
	gait.free()
	add_child(figure)
	_heading = player.rotation.y
	_walk_speed = player.walk_speed
	driven.behaviour_changed.connect(func(behaviour: StringName) -> void:
		if behaviour == &"jump" or behaviour == &"hop":
			player.jump())


func _exit_tree() -> void:
	player.autopilot = Vector3.ZERO
	player.walk_speed = _walk_speed


func _physics_process(delta: float) -> void:
	var travel := driven.get_root_motion_delta()
	var fast := Vector2(travel.origin.x, travel.origin.z).length() / delta
	_speed = lerpf(fast, _speed, exp(-delta / STEP_SECS))
	_heading += travel.basis.get_euler().y
	if player.player_controlled:
		_heading -= GaitInput.move().x * TURN_SPEED * delta
	if _speed < LEAST_MPS:
		player.autopilot = Vector3.ZERO
		player.walk_speed = _walk_speed
		return
	player.autopilot = Vector3.BACK.rotated(Vector3.UP, _heading)
	player.walk_speed = _speed


## Turn of the path, radians about +Y.
func look(heading: float) -> void:
	_heading = heading
