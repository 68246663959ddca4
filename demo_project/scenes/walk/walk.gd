extends WalkingScene
## Several characters walk side by side, each from its own seed and phase.

## Places at which the walkers begin, metres: far enough from each other for their ways never to cross.
const PLACES: Array[Vector2] = [
	Vector2(0.0, 0.6), Vector2(-1.5, -0.5), Vector2(1.5, -0.2), Vector2(-3.0, 0.9), Vector2(3.0, 0.7),
	Vector2(-0.8, -2.1), Vector2(0.9, -2.4),
]
const COLOURS: Array[Color] = [
	Color("d9d4c7"), Color("c96f53"), Color("5f8fb0"), Color("d1a24c"), Color("6fa287"), Color("8d7bb0"), Color("b5626f"),
]


func _ready() -> void:
	for index: int in PLACES.size():
		add_walker("Walker%d" % (index + 1), Vector3(PLACES[index].x, 0.0, PLACES[index].y), COLOURS[index])
	follow(%Panel)


func _process(_delta: float) -> void:
	_camera.target_position = middle() + Vector3.UP * 0.85
