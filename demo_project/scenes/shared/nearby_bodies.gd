class_name NearbyBodies
extends Node3D
## Bodies for the people next to the player: a crowd's walkers have none, and the player shall not walk through them.

## Their layer of physics; feet do not stand on it.
const LAYER := 4
const MOST := 8
const REACH_M := 3.0
const HEIGHT_M := 1.75
const RADIUS_M := 0.2
## Distance within which a walker on a collision course with the player has no body, metres: more than its travel in a frame.
const GAP_M := 0.1
const AWAY := Vector3(0, -50, 0)

@export var crowd: GaitCrowd3D
@export var player: GaitCharacter3D

var _free: Array[AnimatableBody3D] = []
## Nearby walker → its body, which stays the same: a reassigned body would hit the player on its way.
var _bodies: Dictionary[int, AnimatableBody3D] = {}


func _ready() -> void:
	var shape := CapsuleShape3D.new()
	shape.height = HEIGHT_M
	shape.radius = RADIUS_M
	for index: int in MOST:
		var body := AnimatableBody3D.new()
		body.top_level = true
		body.sync_to_physics = false
		body.collision_layer = 0
		body.collision_mask = 0
		var collision := CollisionShape3D.new()
		collision.shape = shape
		body.add_child(collision)
		body.position = AWAY
		add_child(body)
		_free.append(body)
	player.collision_mask |= LAYER


func _physics_process(_delta: float) -> void:
	var touching := RADIUS_M + (player.get_node(^"Shape").shape as CapsuleShape3D).radius
	var people := crowd.get_agents()
	var places := crowd.get_positions()
	var nearby: Dictionary[int, AnimatableBody3D] = {}
	for index: int in people.size():
		var far := places[index].distance_to(player.global_position)
		if far > REACH_M:
			continue
		var body: AnimatableBody3D = _bodies.get(people[index])
		if body == null:
			if _free.is_empty():
				continue
			body = _free.pop_back()
		else:
			# It has come here from where it was in the frame before.
			body.collision_layer = LAYER if far > touching + (0.0 if _walks_to(places[index]) else GAP_M) else 0
			_bodies.erase(people[index])
		body.position = places[index] + Vector3.UP * 0.5 * HEIGHT_M
		nearby[people[index]] = body
	for person: int in _bodies:
		var body := _bodies[person]
		body.collision_layer = 0
		_free.append(body)
	_bodies = nearby


## Returns whether the player walks towards a walker. A walker that comes to a standing player passes through without a push.
func _walks_to(place: Vector3) -> bool:
	return player.velocity.dot(place - player.global_position) > 0.0
