class_name WalkingScene
extends Node3D
## Base of scenes of walkers: walkers of their own seeds and phases, their footprints, and a panel for all of them.

const WALKER: PackedScene = preload("res://scenes/shared/walker.tscn")

## Number of footsteps signalled.
var footsteps := 0
var walkers: Array[Node3D] = []

var _starts: Array[Vector3] = []

@onready var _camera: Camera3D = $Stage/Camera
@onready var _footprints: MultiMeshInstance3D = $Stage/Footprints


func gait_of(walker: Node3D) -> GaitGenerator3D:
	return walker.get_node(^"%GaitGenerator3D")


## The middle of all walkers, on the ground.
func middle() -> Vector3:
	var sum := Vector3.ZERO
	for walker: Node3D in walkers:
		sum += walker.global_position
	return sum / walkers.size()


func add_walker(title: String, place: Vector3, colour: Color) -> GaitGenerator3D:
	var walker: Node3D = WALKER.instantiate()
	walker.name = title
	walker.position = place
	Paint.apply(walker, colour)
	add_child(walker)
	var gait := gait_of(walker)
	gait.seed = 1 + walkers.size()
	# The golden ratio spreads phases evenly, however many there are.
	gait.phase = fposmod(walkers.size() * 0.618034, 1.0)
	gait.footstep.connect(func(foot: StringName, at: Vector3) -> void:
		footsteps += 1
		_footprints.mark(foot, at, walker))
	walkers.append(walker)
	return gait


func set_all(property: StringName, value: Variant) -> void:
	for walker: Node3D in walkers:
		gait_of(walker).set(property, value)


## Lets a panel (`walk_panel.tscn`) set the speed, the turn rate and the seeds of all walkers.
func follow(panel: Control) -> void:
	panel.speed_changed.connect(func(speed: float) -> void: set_all(&"speed", speed))
	panel.turn_changed.connect(func(turn_rate: float) -> void: set_all(&"turn_rate", turn_rate))
	panel.seed_changed.connect(func(first: int) -> void:
		for index: int in walkers.size():
			gait_of(walkers[index]).seed = first + index)
	set_all(&"speed", panel.SPEED)


## Close-up views for pictures: walkers that are not hidden by others.
func close_ups() -> Dictionary[String, Array]:
	var at := func(index: int) -> Vector3: return walkers[index].global_position + Vector3.UP * 0.9
	return {
		"side": [at.call(4), 90.0, 5.0, 3.4],
		"front": [at.call(4), 3.0, 6.0, 3.4],
		"three_quarter": [at.call(0), 38.0, 12.0, 3.9],
	}


func begin_check() -> void:
	for walker: Node3D in walkers:
		_starts.append(walker.global_position)


## Walkers that did not walk as far as their speed promises in so many frames.
func problems(frames: int) -> PackedStringArray:
	var found := PackedStringArray()
	if _starts.is_empty():
		found.append("there are no walkers")
	for index: int in _starts.size():
		var walked := walkers[index].global_position.distance_to(_starts[index])
		# Half of what the speed promises, after a second to get going.
		var expected := 0.5 * gait_of(walkers[index]).speed * maxf(frames / 60.0 - 1.0, 0.0)
		if not walked > expected:
			found.append("%s walked %.2f m instead of more than %.2f" % [walkers[index].name, walked, expected])
	var least := _starts.size() * (frames / 60.0 - 1.0)
	if footsteps < least:
		found.append("%d footsteps in %d frames, less than %d" % [footsteps, frames, least])
	return found
