extends Node3D
## Several characters walk side by side, each from its own seed and phase.

const WALKER: PackedScene = preload("res://scenes/shared/walker.tscn")
## Where the walkers begin, metres: far enough from each other for their ways never to cross.
const PLACES: Array[Vector2] = [
	Vector2(0.0, 0.6), Vector2(-1.5, -0.5), Vector2(1.5, -0.2), Vector2(-3.0, 0.9), Vector2(3.0, 0.7),
	Vector2(-0.8, -2.1), Vector2(0.9, -2.4),
]
const COLOURS: Array[Color] = [
	Color("d9d4c7"), Color("c96f53"), Color("5f8fb0"), Color("d1a24c"), Color("6fa287"), Color("8d7bb0"), Color("b5626f"),
]

## How many footsteps were signalled.
var footsteps := 0
var walkers: Array[Node3D] = []


@onready var _camera: Camera3D = $Stage/Camera
@onready var _footprints: MultiMeshInstance3D = $Stage/Footprints


func _ready() -> void:
	for index: int in PLACES.size():
		_add_walker(index)
	%Panel.speed_changed.connect(func(speed: float) -> void: _set_all(&"speed", speed))
	%Panel.turn_changed.connect(func(turn_rate: float) -> void: _set_all(&"turn_rate", turn_rate))
	%Panel.seed_changed.connect(func(first: int) -> void:
		for index: int in walkers.size():
			gait_of(walkers[index]).seed = first + index)
	_set_all(&"speed", %Panel.SPEED)


func _process(_delta: float) -> void:
	_camera.target_position = middle() + Vector3.UP * 0.85


## The middle of all walkers, on the ground.
func middle() -> Vector3:
	var sum := Vector3.ZERO
	for walker: Node3D in walkers:
		sum += walker.global_position
	return sum / walkers.size()


func gait_of(walker: Node3D) -> GaitGenerator3D:
	return walker.get_node(^"%GaitGenerator3D")


func _add_walker(index: int) -> void:
	var walker: Node3D = WALKER.instantiate()
	walker.name = "Walker%d" % (index + 1)
	walker.position = Vector3(PLACES[index].x, 0.0, PLACES[index].y)
	Paint.apply(walker, COLOURS[index])
	add_child(walker)
	walkers.append(walker)
	var gait := gait_of(walker)
	gait.seed = 1 + index
	# The golden ratio spreads phases evenly, however many there are.
	gait.phase = fposmod(index * 0.618034, 1.0)
	gait.footstep.connect(func(foot: StringName, place: Vector3) -> void:
		footsteps += 1
		_footprints.mark(foot, place, walker))


func _set_all(property: StringName, value: Variant) -> void:
	for walker: Node3D in walkers:
		gait_of(walker).set(property, value)
