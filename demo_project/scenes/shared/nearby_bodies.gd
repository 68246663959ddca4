class_name NearbyBodies
extends Node3D
## Bodies for the people next to the player: a crowd's walkers have none, and the player shall not walk through them.

## Their layer of physics; feet do not stand on it.
const LAYER := 4
const MOST := 8
const REACH_M := 3.0
const HEIGHT_M := 1.75
const RADIUS_M := 0.2
const AWAY := Vector3(0, -50, 0)

@export var crowd: GaitCrowd3D
@export var player: GaitCharacter3D

var _bodies: Array[AnimatableBody3D] = []


func _ready() -> void:
	var shape := CapsuleShape3D.new()
	shape.height = HEIGHT_M
	shape.radius = RADIUS_M
	for index: int in MOST:
		var body := AnimatableBody3D.new()
		body.top_level = true
		body.sync_to_physics = false
		body.collision_layer = LAYER
		body.collision_mask = 0
		var collision := CollisionShape3D.new()
		collision.shape = shape
		body.add_child(collision)
		body.position = AWAY
		add_child(body)
		_bodies.append(body)
	player.collision_mask |= LAYER


func _physics_process(_delta: float) -> void:
	# Nobody pushes the player: who comes so near by itself that bodies touch has none.
	var touching := RADIUS_M + (player.get_node(^"Shape").shape as CapsuleShape3D).radius
	var used := 0
	for place: Vector3 in crowd.get_positions():
		var far := place.distance_to(player.global_position)
		if used < MOST and far < REACH_M and far > touching:
			_bodies[used].position = place + Vector3.UP * 0.5 * HEIGHT_M
			used += 1
	for index: int in range(used, MOST):
		_bodies[index].position = AWAY
