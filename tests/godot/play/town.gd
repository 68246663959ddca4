extends Node3D
## Fifty characters of three rigs on a floor with stairs, rubble and a platform; a crowd comes and goes.
##
## Characters arrive one a frame, as games spawn them.

const CONTROLLER: PackedScene = preload("res://addons/footfall/controller/gait_character_3d.tscn")
const MODEL: GaitModel = preload("res://addons/footfall/models/locomotion.footfall")
const STYLES: Array[GaitStyle] = [
	preload("res://addons/footfall/models/proud.footstyle"),
	preload("res://addons/footfall/models/sad.footstyle"),
]
const COUNT := 50
## So many of them are bodies of the controller, the others walkers without physics.
const BODIES := 10
const CROWD := 2000
## Of so many one waves.
const WAVES_EACH := 4
## Radius of the ring on which walkers without physics go: they keep out of the town's middle.
const RING_M := 14.0

## Set before it enters the tree: they go on from there.
var saved_game: SavedGame

var _rigs: Array[PackedScene] = [Rigs.adult(), Rigs.in_centimetres(), Rigs.child()]
var _crowd: GaitCrowd3D
var _platform: AnimatableBody3D
var _walkers: Array[Node3D] = []
var _secs := 0.0


func _ready() -> void:
	_ground(Vector3(0, -0.5, 0), Vector3(80, 1, 80))
	for step: int in 6:
		_ground(Vector3(0, 0.085 * (step + 1), 6), Vector3(3, 0.17 * (step + 1), 2.0 * 0.29 * (6 - step) + 0.9))
	for stone: int in 40:
		var at := Vector3.FORWARD.rotated(Vector3.UP, stone * 2.4) * (10.0 + stone % 5 * 2.0)
		_ground(at, Vector3(0.45, 0.02 * (1 + stone % 5), 0.45))
	_platform = AnimatableBody3D.new()
	_platform.sync_to_physics = false
	_ground(Vector3(-6, 0.2, 0), Vector3(3, 0.2, 3), _platform)
	if saved_game:
		for index: int in saved_game.places.size():
			_spawn(index)


func _physics_process(delta: float) -> void:
	_secs += delta
	_platform.position.y = 0.2 + 0.15 * sin(_secs)
	_platform.rotation.y = 0.3 * sin(0.5 * _secs)
	if _walkers.size() < COUNT:
		_spawn(_walkers.size())
	for index: int in mini(BODIES, _walkers.size()):
		# Over the stairs and back, each on a way of its own.
		var body: GaitCharacter3D = _walkers[index]
		var goal := Vector3(0.2 * (index - 5), 0.0, 12.0 if fmod(_secs + index, 40.0) < 20.0 else 0.0)
		var way := goal - body.position
		body.autopilot = Vector3(way.x, 0.0, way.z).limit_length(1.0) if way.length() > 0.5 else Vector3.ZERO
		if index == 1 and fmod(_secs, 5.0) < delta:
			body.jump()


func bring_crowd() -> void:
	_crowd = GaitCrowd3D.new()
	_crowd.model = MODEL
	_crowd.character = _rigs[0]
	_crowd.styles = STYLES
	_crowd.count = CROWD
	_crowd.area = Vector2(70, 70)
	add_child(_crowd)


func send_crowd_away() -> void:
	if _crowd:
		_crowd.queue_free()
	_crowd = null


func saved() -> SavedGame:
	var game := SavedGame.new()
	for walker: Node3D in _walkers:
		game.places.append(walker.global_transform)
		game.walks.append(_gait(walker).get_state())
	return game


func places() -> PackedVector3Array:
	var found := PackedVector3Array()
	for walker: Node3D in _walkers:
		found.append(walker.global_position)
	return found


func problems() -> PackedStringArray:
	var found := PackedStringArray()
	if _walkers.size() != COUNT:
		found.append("%d characters came, of %d" % [_walkers.size(), COUNT])
	for walker: Node3D in _walkers:
		if not walker.global_position.is_finite() or absf(walker.global_position.y) > 2.5:
			found.append("%s is at %s" % [walker.name, walker.global_position])
		found.append_array(_gait(walker).get_problems())
	return found


func _spawn(index: int) -> void:
	var rig := _rigs[index % _rigs.size()]
	var walker: Node3D
	if index < BODIES:
		var body: GaitCharacter3D = CONTROLLER.instantiate()
		body.character_scene = rig
		body.player_controlled = false
		walker = body
	else:
		walker = rig.instantiate()
		var skeleton: Skeleton3D = walker.find_children("*", "Skeleton3D", true, false)[0]
		var gait := GaitGenerator3D.new()
		gait.model = MODEL
		gait.turn_rate = 1.1 / RING_M
		skeleton.add_child(gait)
		var placement := FootPlacement3D.new()
		placement.follow_ground = true
		skeleton.add_child(placement)
	walker.name = "Walker%d" % index
	var around := index * 2.4
	walker.position = Vector3(0.8 * (index % 5) - 1.6, 0.02, -3.0 - index / 5) if index < BODIES else Vector3(sin(around), 0, cos(around)) * (RING_M + index % 7)
	walker.rotation.y = 0.0 if index < BODIES else around + PI / 2
	_walkers.append(walker)
	add_child(walker)
	var gait := _gait(walker)
	gait.seed = index + 1
	if index % WAVES_EACH == 0:
		_wave(walker, gait)
	if saved_game:
		walker.global_transform = saved_game.places[index]
		gait.set_state(saved_game.walks[index])


## Has a clip play on the right arm of somebody who walks.
func _wave(walker: Node3D, gait: GaitGenerator3D) -> void:
	var skeleton := gait.get_skeleton()
	skeleton.name = "Skeleton3D"
	var library := AnimationLibrary.new()
	library.add_animation(&"wave", Rigs.wave(skeleton, "RightUpperArm", "RightLowerArm"))
	var player := AnimationPlayer.new()
	player.add_animation_library(&"", library)
	skeleton.get_parent().add_child(player)
	player.play(&"wave")
	gait.right_arm_weight = 0.0


func _gait(walker: Node3D) -> GaitGenerator3D:
	return walker.find_children("*", "GaitGenerator3D", true, false)[0]


func _ground(middle: Vector3, size: Vector3, body: PhysicsBody3D = StaticBody3D.new()) -> void:
	var shape := CollisionShape3D.new()
	shape.shape = BoxShape3D.new()
	shape.shape.size = size
	body.add_child(shape)
	body.position = middle
	add_child(body)
