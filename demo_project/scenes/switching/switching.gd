extends WalkingScene
## Walkers of a switching model, two linear systems that take turns, beside walkers of the trained walk.

## Each column's model, its name and its colour.
const COLUMNS: Array[Array] = [
	[preload("res://addons/footfall/models/walk.footdyn"), "two linear systems", Color("5f8fb0")],
	[preload("res://addons/footfall/models/locomotion.footfall"), "trained walk", Color("c96f53")],
]
const ROWS := 3
const BETWEEN_COLUMNS_M := 2.4
const BETWEEN_ROWS_M := 1.7


func _ready() -> void:
	_camera.distance_m = 9.0
	_camera.heading = deg_to_rad(10.0)
	_camera.height = deg_to_rad(14.0)
	for row: int in ROWS:
		for column: int in COLUMNS.size():
			_add_walker(row, column)
	follow(%Panel)


func _process(_delta: float) -> void:
	_camera.target_position = middle() + Vector3.UP * 0.85


## Close-up views for pictures; the one from three quarters shows both columns with their names side by side.
func close_ups() -> Dictionary[String, Array]:
	var views := super()
	views["three_quarter"] = [middle() + Vector3.UP * 0.9, 12.0, 9.0, 6.5]
	return views


func _add_walker(row: int, column: int) -> void:
	var kind: String = COLUMNS[column][1]
	var place := Vector3((0.5 - column) * BETWEEN_COLUMNS_M, 0.0, -row * BETWEEN_ROWS_M)
	var gait := add_walker("%s %d" % [kind.capitalize(), row + 1], place, COLUMNS[column][2])
	gait.model = COLUMNS[column][0]
	if row == 0:
		Paint.label(walkers[-1], kind)
