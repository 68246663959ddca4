extends Node3D
## Walkers of a switching model, two linear systems that take turns, beside walkers of the trained walk.

const WALKER: PackedScene = preload("res://scenes/shared/walker.tscn")
## Each column's model, its name and its colour.
const COLUMNS: Array[Array] = [
	[preload("res://addons/footfall/models/walk.footdyn"), "two linear systems", Color("5f8fb0")],
	[preload("res://addons/footfall/models/walk.footfall"), "trained walk", Color("c96f53")],
]
const ROWS := 3
const BETWEEN_COLUMNS_M := 2.4
const BETWEEN_ROWS_M := 1.7

## How many footsteps were signalled.
var footsteps := 0
var walkers: Array[Node3D] = []

@onready var _camera: Camera3D = $Stage/Camera
@onready var _footprints: MultiMeshInstance3D = $Stage/Footprints


func _ready() -> void:
	_camera.distance_m = 9.0
	_camera.heading = deg_to_rad(10.0)
	_camera.height = deg_to_rad(14.0)
	for row: int in ROWS:
		for column: int in COLUMNS.size():
			_add_walker(row, column)
	%Panel.speed_changed.connect(func(speed: float) -> void: _set_all(&"speed", speed))
	%Panel.turn_changed.connect(func(turn_rate: float) -> void: _set_all(&"turn_rate", turn_rate))
	%Panel.seed_changed.connect(func(first: int) -> void:
		for index: int in walkers.size():
			gait_of(walkers[index]).seed = first + index)
	_set_all(&"speed", %Panel.SPEED)


func _process(_delta: float) -> void:
	var sum := Vector3.ZERO
	for walker: Node3D in walkers:
		sum += walker.global_position
	_camera.target_position = sum / walkers.size() + Vector3.UP * 0.85


func gait_of(walker: Node3D) -> GaitGenerator3D:
	return walker.get_node(^"%GaitGenerator3D")


func _add_walker(row: int, column: int) -> void:
	var walker: Node3D = WALKER.instantiate()
	walker.name = "%s %d" % [COLUMNS[column][1].capitalize(), row + 1]
	walker.position = Vector3((0.5 - column) * BETWEEN_COLUMNS_M, 0.0, -row * BETWEEN_ROWS_M)
	Paint.apply(walker, COLUMNS[column][2])
	var gait := gait_of(walker)
	gait.model = COLUMNS[column][0]
	gait.seed = 1 + walkers.size()
	gait.phase = fposmod(walkers.size() * 0.618034, 1.0)
	add_child(walker)
	if row == 0:
		Paint.label(walker, COLUMNS[column][1])
	gait.footstep.connect(func(foot: StringName, at: Vector3) -> void:
		footsteps += 1
		_footprints.mark(foot, at, walker))
	walkers.append(walker)


func _set_all(property: StringName, value: Variant) -> void:
	for walker: Node3D in walkers:
		gait_of(walker).set(property, value)
