class_name Course
extends Node3D
## Lanes of uneven ground, side by side along +Z: a ramp, stairs, rubble, a slope across, hills, and a platform that moves.
##
## Built in code, so that sizes can be read: every body but the hills is a box.

const LANE_M := 2.6
const LENGTH_M := 20.0
const LANES: PackedStringArray = ["20° up and down", "stairs of 15 by 40 cm", "rubble", "15° across", "hills of 13 %", "a platform that moves"]
const GREY := Color("8d8f92")
const TREAD := Color("a39a86")
const STONE := Color("7d8a83")
const METAL := Color("c9a24a")
const GRASS := Color("7c9a6b")
## Height and length of a hill, metres.
const HILL_M := 0.3
const HILL_LENGTH_M := 7.0

## The platform, an `AnimatableBody3D`.
var platform: AnimatableBody3D

var _secs := 0.0


func _ready() -> void:
	_floor()
	_ramp(lane_x(0))
	_stairs(lane_x(1))
	_rubble(lane_x(2))
	_cross_slope(lane_x(3))
	_hills(lane_x(4), 2)
	_platform(lane_x(5))


func _physics_process(delta: float) -> void:
	_secs += delta
	platform.position.y = 0.35 + 0.25 * sin(0.8 * _secs)
	platform.rotation.y = 0.5 * sin(0.45 * _secs)


## The middle of a lane.
func lane_x(lane: int) -> float:
	return (0.5 * (LANES.size() - 1) - lane) * LANE_M


func _floor() -> void:
	var body := StaticBody3D.new()
	var shape := CollisionShape3D.new()
	shape.shape = WorldBoundaryShape3D.new()
	body.add_child(shape)
	add_child(body)


func _ramp(x: float) -> void:
	var slope := deg_to_rad(20.0)
	var rise := 1.6
	var run := rise / tan(slope)
	var length := rise / sin(slope)
	for side: float in [-1.0, 1.0]:
		var middle := Vector3(x, 0.5 * rise, -side * (0.5 * run + 1.0))
		var turned := Basis(Vector3.RIGHT, -side * slope)
		_box(Transform3D(turned, middle - turned.y * 0.1), Vector3(2.2, 0.2, length), GREY)
	_box(Transform3D(Basis.IDENTITY, Vector3(x, rise - 0.1, 0)), Vector3(2.2, 0.2, 2.02), GREY)


func _stairs(x: float) -> void:
	var rise := 0.15
	var run := 0.4
	var count := 9
	for step: int in count:
		var height := rise * (step + 1)
		var depth := 2.0 * run * (count - step) - run
		_box(Transform3D(Basis.IDENTITY, Vector3(x, 0.5 * height, 0)), Vector3(2.2, height, depth + 1.2), TREAD)


func _rubble(x: float) -> void:
	var chance := RandomNumberGenerator.new()
	chance.seed = 7
	for row: int in 16:
		for column: int in 4:
			var tilt := Basis.from_euler(Vector3(chance.randf_range(-0.16, 0.16), chance.randf() * TAU, chance.randf_range(-0.16, 0.16)))
			var place := Vector3(x + (column - 1.5) * 0.55, chance.randf_range(-0.06, 0.06), (row - 7.5) * 0.55)
			_box(Transform3D(tilt, place), Vector3(0.75, 0.2, 0.75), STONE.darkened(chance.randf() * 0.25))


func _cross_slope(x: float) -> void:
	var turned := Basis(Vector3.BACK, deg_to_rad(15.0))
	_box(Transform3D(turned, Vector3(x, 0.26, 0) - turned.y * 0.1), Vector3(2.2, 0.2, 12.0), GREY)


## Rounded hills, one behind the other, that begin and end level.
func _hills(x: float, count: int) -> void:
	const PIECES := 28
	# Corners of a slice across: to the side, metres, and up, in heights of the hill there.
	const CORNERS: PackedVector2Array = [Vector2(-1.1, 0), Vector2(-1.1, 1), Vector2(1.1, 1), Vector2(1.1, 0)]
	var half := 0.5 * count * HILL_LENGTH_M
	var surface := SurfaceTool.new()
	surface.begin(Mesh.PRIMITIVE_TRIANGLES)
	for side: int in 3:
		for slice: int in count * PIECES + 1:
			var turn := TAU * slice / PIECES
			var height := 0.5 * HILL_M * (1.0 - cos(turn)) + 0.005
			var slope := 0.5 * HILL_M * TAU / HILL_LENGTH_M * sin(turn)
			var normals: PackedVector3Array = [Vector3.LEFT, Vector3(0, 1, -slope).normalized(), Vector3.RIGHT]
			for corner: Vector2 in [CORNERS[side], CORNERS[side + 1]]:
				surface.set_normal(normals[side])
				surface.add_vertex(Vector3(x + corner.x, height * corner.y, slice * HILL_LENGTH_M / PIECES - half))
		for slice: int in count * PIECES:
			var first := 2 * (side * (count * PIECES + 1) + slice)
			for vertex: int in [0, 1, 2, 1, 3, 2]:
				surface.add_index(first + vertex)
	var mesh := MeshInstance3D.new()
	mesh.mesh = surface.commit()
	mesh.mesh.surface_set_material(0, _material(GRASS))
	var shape := CollisionShape3D.new()
	shape.shape = mesh.mesh.create_trimesh_shape()
	var body := StaticBody3D.new()
	body.add_child(shape)
	body.add_child(mesh)
	add_child(body)


func _platform(x: float) -> void:
	platform = AnimatableBody3D.new()
	platform.sync_to_physics = false
	platform.position = Vector3(x, 0.35, 0)
	add_child(platform)
	_fill(platform, Vector3(2.4, 0.16, 3.2), METAL, Vector3.DOWN * 0.08)


func _box(place: Transform3D, size: Vector3, colour: Color) -> void:
	var body := StaticBody3D.new()
	body.transform = place
	add_child(body)
	_fill(body, size, colour)


func _fill(body: CollisionObject3D, size: Vector3, colour: Color, offset := Vector3.ZERO) -> void:
	var shape := CollisionShape3D.new()
	var box := BoxShape3D.new()
	box.size = size
	shape.shape = box
	shape.position = offset
	body.add_child(shape)
	var mesh := MeshInstance3D.new()
	mesh.mesh = BoxMesh.new()
	mesh.mesh.size = size
	mesh.position = offset
	mesh.mesh.material = _material(colour)
	body.add_child(mesh)


func _material(colour: Color) -> StandardMaterial3D:
	var material := StandardMaterial3D.new()
	material.albedo_color = colour
	material.roughness = 0.85
	return material
