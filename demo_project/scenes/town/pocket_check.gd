class_name TownPocketCheck
extends Node3D
## Check of a character that a sensor in a pocket steers: it stands until its wearer has walked enough to know how the sensor is worn, and then goes as the wearer goes.

const CHARACTER: PackedScene = preload("res://addons/footfall/controller/gait_character_3d.tscn")
const MANNEQUIN: PackedScene = preload("res://characters/mannequin.glb")
const STANDS_SECS := 2.0
const SPEED_MPS := 1.3
## Walking time until the mounting is known at the latest.
const KNOWN_SECS := 7.0
## Share of the wearer's way that the character goes at least, and at most.
const WAY := Vector2(0.8, 1.2)

var _wearer := Wearer.new("RightUpperLeg")
var _character: GaitCharacter3D = CHARACTER.instantiate()
var _secs := 0.0
var _went := 0.0
var _wearer_went := 0.0


func _ready() -> void:
	_character.character_scene = MANNEQUIN
	_character.player_controlled = false
	for part: NodePath in [^"Camera", ^"TouchStick"]:
		_character.get_node(part).free()
	add_child(_character)
	add_child(_wearer)
	var walk := SensorWalk.new(TownDoors.THIGH, _character)
	add_child(walk)
	walk.driven.start_calibration()
	_wearer.measured.connect(func(time: float, force: Vector3, rate: Vector3) -> void: walk.driven.push_sample(0, time, force, rate))


func _physics_process(delta: float) -> void:
	_secs += delta
	_wearer.gait.speed = 0.0 if _secs < STANDS_SECS else SPEED_MPS
	if _secs > STANDS_SECS + KNOWN_SECS:
		_went += Vector2(_character.velocity.x, _character.velocity.z).length() * delta
		_wearer_went += SPEED_MPS * delta


func problems() -> PackedStringArray:
	if _wearer_went > 0.0 and _went >= WAY.x * _wearer_went and _went <= WAY.y * _wearer_went:
		return []
	return ["the sensor's wearer went %.1f m, and the character %.1f m" % [_wearer_went, _went]]
