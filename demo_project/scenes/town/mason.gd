class_name TownMason
extends RefCounted
## Builder of masonry: slabs, roofs and drums with coloured corners go into one mesh, and what stops walkers into one body.
##
## One mesh is one call to draw, however many houses are in it. Lengths are metres; the alpha of a colour is 1 for stone, 0 for what shines by itself.

## Ground that people walk on, and everything that stops the player: layers of physics.
const GROUND := 2
const SOLID := 1

## The frame that everything is built in.
var frame := Transform3D.IDENTITY

var _vertices := PackedVector3Array()
var _normals := PackedVector3Array()
var _colours := PackedColorArray()
var _indices := PackedInt32Array()
var _shapes: Array[CollisionShape3D] = []


## A flat piece: corners of a convex polygon, counter-clockwise for who looks at it.
func face(corners: PackedVector3Array, colour: Color) -> void:
	var first := _vertices.size()
	var normal := (frame.basis * (corners[1] - corners[0]).cross(corners[2] - corners[0])).normalized()
	for corner: Vector3 in corners:
		_vertices.append(frame * corner)
		_normals.append(normal)
		_colours.append(colour)
	for corner: int in range(2, corners.size()):
		_indices.append_array([first, first + corner, first + corner - 1])


## A profile (x to the right, y up, counter-clockwise) drawn out along z.
func bar(profile: PackedVector2Array, from_z: float, to_z: float, colour: Color) -> void:
	var front := PackedVector3Array()
	var back := PackedVector3Array()
	for index: int in profile.size():
		var at := profile[index]
		var next := profile[(index + 1) % profile.size()]
		front.append(Vector3(at.x, at.y, to_z))
		back.insert(0, Vector3(at.x, at.y, from_z))
		face([Vector3(at.x, at.y, from_z), Vector3(next.x, next.y, from_z), Vector3(next.x, next.y, to_z), Vector3(at.x, at.y, to_z)], colour)
	face(front, colour)
	face(back, colour)


## A block between two opposite corners.
func slab(from: Vector3, to: Vector3, colour: Color) -> void:
	bar([Vector2(from.x, from.y), Vector2(to.x, from.y), Vector2(to.x, to.y), Vector2(from.x, to.y)], from.z, to.z, colour)


## A slab that blocks walkers.
func block(from: Vector3, to: Vector3, colour: Color) -> void:
	slab(from, to, colour)
	stop_box(Transform3D(Basis.IDENTITY, 0.5 * (from + to)), to - from)


## A round piece about an upright axis with a given number of sides, narrower or wider at the top.
func drum(foot: Vector3, low_radius: float, high_radius: float, height: float, sides: int, colour: Color) -> void:
	var top := PackedVector3Array()
	for side: int in sides:
		var here := Vector3.BACK.rotated(Vector3.UP, TAU * side / sides)
		var next := Vector3.BACK.rotated(Vector3.UP, TAU * (side + 1) / sides)
		var up := Vector3.UP * height
		face([foot + here * low_radius, foot + next * low_radius, foot + up + next * high_radius, foot + up + here * high_radius], colour)
		top.append(foot + up + here * high_radius)
	face(top, colour)


## A ring with a flat top, as of a basin.
func ring(foot: Vector3, inner_radius: float, outer_radius: float, height: float, sides: int, colour: Color) -> void:
	for side: int in sides:
		var here := Vector3.BACK.rotated(Vector3.UP, TAU * side / sides)
		var next := Vector3.BACK.rotated(Vector3.UP, TAU * (side + 1) / sides)
		var up := foot + Vector3.UP * height
		face([foot + here * outer_radius, foot + next * outer_radius, up + next * outer_radius, up + here * outer_radius], colour)
		face([up + here * outer_radius, up + next * outer_radius, up + next * inner_radius, up + here * inner_radius], colour)
		face([foot + next * inner_radius, foot + here * inner_radius, up + here * inner_radius, up + next * inner_radius], colour)


## Cloth in stripes of two colours in turn, centred in x: from its front edge (z, y), over which a hem hangs, to its back edge.
func awning(stripes: int, breadth: float, front: Vector2, back: Vector2, hem: float, colours: PackedColorArray) -> void:
	for stripe: int in stripes:
		var left := Vector3((stripe - 0.5 * stripes) * breadth, 0, 0)
		var right := left + Vector3.RIGHT * breadth
		var cloth := colours[stripe % 2]
		var edge := Vector3(0, front.y, front.x)
		var far := Vector3(0, back.y, back.x)
		var low := edge + Vector3.DOWN * hem
		# The underside lies just below.
		var under := Vector3(0, -0.01, 0)
		var behind := Vector3(0, 0, -0.01)
		face([left + edge, right + edge, right + far, left + far], cloth)
		face([left + low, right + low, right + edge, left + edge], cloth.darkened(0.1))
		face([left + far + under, right + far + under, right + low + behind, left + low + behind], cloth.darkened(0.3))


## A ball of flat sides.
func ball(middle: Vector3, radius: float, colour: Color) -> void:
	const ROUND := 9
	const ROWS := 6
	for row: int in ROWS:
		for side: int in ROUND:
			var corners := PackedVector3Array()
			for corner: Vector2i in [Vector2i(0, 0), Vector2i(1, 0), Vector2i(1, 1), Vector2i(0, 1)]:
				var up := PI * (float(row + corner.y) / ROWS - 0.5)
				var around := TAU * (side + corner.x + 0.5 * (row + corner.y)) / ROUND
				var at := middle + Vector3(sin(around) * cos(up), sin(up), cos(around) * cos(up)) * radius
				if corners.is_empty() or not at.is_equal_approx(corners[-1]):
					corners.append(at)
			if corners[0].is_equal_approx(corners[-1]):
				corners.remove_at(corners.size() - 1)
			# Leaves above have more of the sky.
			face(corners, colour.lightened(0.08 * (row - 2)) if row > 2 else colour.darkened(0.1 * (2 - row)))


## A box that stops walkers and is not seen.
func stop_box(middle: Transform3D, size: Vector3) -> void:
	var box := BoxShape3D.new()
	box.size = size
	stop(middle, box)


## A shape that stops walkers and is not seen.
func stop(place: Transform3D, shape: Shape3D) -> void:
	var node := CollisionShape3D.new()
	node.shape = shape
	node.transform = frame * place
	_shapes.append(node)


## Puts what was built into the scene.
func finish(parent: Node3D, title: String, material: Material, layers := SOLID) -> void:
	if not _shapes.is_empty():
		var body := StaticBody3D.new()
		body.name = title
		body.collision_layer = layers
		parent.add_child(body)
		for shape: CollisionShape3D in _shapes:
			body.add_child(shape)
	if not _vertices.is_empty():
		var seen := MeshInstance3D.new()
		seen.name = title + "Mesh"
		seen.mesh = mesh(material)
		parent.add_child(seen)


## Everything that was built as one mesh.
func mesh(material: Material) -> ArrayMesh:
	var arrays := []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = _vertices
	arrays[Mesh.ARRAY_NORMAL] = _normals
	arrays[Mesh.ARRAY_COLOR] = _colours
	arrays[Mesh.ARRAY_INDEX] = _indices
	var made := ArrayMesh.new()
	made.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	made.surface_set_material(0, material)
	return made
