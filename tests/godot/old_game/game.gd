extends Node3D
## Script of a game that was made with the add-on as it was on 25 November 2026, before it replicated walks and crowds.

var footsteps: Array[StringName] = []
var planned := 0
var planted := 0
var steps_of_crowd := 0
var landings := 0

@onready var gait: GaitGenerator3D = $Hero/Skeleton/Gait
@onready var placement: FootPlacement3D = $Hero/Skeleton/Placement
@onready var crowd: GaitCrowd3D = $Crowd
@onready var player: GaitCharacter3D = $Player


func _ready() -> void:
	player.autopilot = Vector3.BACK
	var more: PackedInt32Array = crowd.add_agents([Vector3(0, 0, 8), Vector3(2, 0, 8)], [0.0, 0.5])
	crowd.set_agent_style(more[0], [1.0])
	crowd.set_speeds([1.2], [more[1]])
	crowd.set_tints([Color.RED], more)
	crowd.remove_agents([more[0]])


func _process(_delta: float) -> void:
	var travelled: Transform3D = gait.get_root_motion_delta()
	if travelled.origin.length() > 1.0:
		push_error("the hero is thrown")


## Everything else that the game asks of the add-on.
func save_and_load() -> void:
	var state: PackedByteArray = gait.get_state()
	gait.set_state(state)
	var people: PackedByteArray = crowd.get_state()
	crowd.set_state(people)
	var nearest: int = crowd.find_nearest(Vector3.ZERO)
	var there: bool = crowd.has_agent(nearest) and crowd.get_agent_count() == crowd.get_positions().size()
	var sizes: PackedFloat32Array = crowd.get_sizes([nearest])
	if not there or sizes.size() != 1 or crowd.get_headings().is_empty() or crowd.get_tiers().is_empty():
		push_error("the crowd does not know its people")
	player.jump()
	gait.push(Vector3(10, 0, 0))
	if not gait.jump(0.2):
		push_error("the hero does not jump")
	var grade: float = placement.get_grade()
	var foot: Transform3D = placement.get_foot_transform(&"left")
	if not is_finite(grade) or not foot.is_finite() or gait.get_problems().size() + placement.get_problems().size() > 0:
		push_error("the hero has problems: %s %s" % [gait.get_problems(), placement.get_problems()])


func _on_footstep(foot: StringName, _place: Vector3) -> void:
	footsteps.append(foot)


func _on_foothold_planned(_foot: StringName, _place: Vector3, _secs: float) -> void:
	planned += 1


func _on_foot_planted(_foot: StringName, _place: Vector3, _normal: Vector3) -> void:
	planted += 1


func _on_footsteps(agents: PackedInt32Array, _feet: PackedByteArray, _places: PackedVector3Array) -> void:
	steps_of_crowd += agents.size()


func _on_landed(_fall_speed: float) -> void:
	landings += 1
