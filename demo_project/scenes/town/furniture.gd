class_name TownFurniture
extends Node3D
## Fountain, lamps, benches, trees and a stall. What there is more than one of is one `MultiMesh` of a kind.

const WATER: Shader = preload("res://scenes/town/water.gdshader")
const STONE := Color("d8d0bf")
const IRON := Color("64686a")
const GLASS := Color(1.0, 0.86, 0.64, 0.0)
const WOOD := Color("a07b5b")
const BARK := Color("776454")
const LEAVES: PackedColorArray = [Color("94a065"), Color("a8aa69"), Color("85935f"), Color("b9ae6c")]
const CLOTH: PackedColorArray = [Color("ba6356"), Color("f3ebda")]
const LAMP_HEIGHT := 3.3

var _material: Material


func build(material: Material) -> void:
	_material = material
	_fountain()
	_stall()
	_repeat("Lamps", _lamp(), _places(TownPlan.LAMPS), Vector3(0.3, 3.0, 0.3))
	var benches: Array[Transform3D] = []
	for bench: Array in TownPlan.BENCHES:
		benches.append(Transform3D(Basis(Vector3.UP, deg_to_rad(bench[1])), bench[0]))
	_repeat("Benches", _bench(), benches, Vector3(1.8, 0.9, 0.6))
	var trees: Array[Transform3D] = []
	for tree: Array in TownPlan.TREES:
		trees.append(Transform3D(Basis(Vector3.UP, 2.4 * trees.size()).scaled(Vector3.ONE * tree[1]), tree[0]))
	_repeat("Trees", _tree(), trees, Vector3(0.5, 3.0, 0.5))
	for lamp: Vector3 in TownPlan.LAMPS:
		_light(lamp + Vector3.UP * (LAMP_HEIGHT - 0.1))


func _places(points: PackedVector3Array) -> Array[Transform3D]:
	var places: Array[Transform3D] = []
	for point: Vector3 in points:
		places.append(Transform3D(Basis.IDENTITY, point))
	return places


func _repeat(title: String, mason: TownMason, places: Array[Transform3D], size: Vector3) -> void:
	var many := MultiMesh.new()
	many.transform_format = MultiMesh.TRANSFORM_3D
	many.mesh = mason.mesh(_material)
	many.instance_count = places.size()
	var stops := TownMason.new()
	for index: int in places.size():
		many.set_instance_transform(index, places[index])
		var upright := places[index].orthonormalized()
		stops.stop_box(upright.translated(Vector3.UP * 0.5 * size.y), size)
	var shown := MultiMeshInstance3D.new()
	shown.name = title
	shown.multimesh = many
	add_child(shown)
	stops.finish(self, title + "Body", _material)


func _light(at: Vector3) -> void:
	var light := OmniLight3D.new()
	light.position = at
	light.light_color = Color(1.0, 0.76, 0.46)
	light.light_energy = 1.6
	light.omni_range = 7.0
	light.omni_attenuation = 1.3
	light.distance_fade_enabled = true
	light.distance_fade_begin = 45.0
	add_child(light)


func _fountain() -> void:
	var mason := TownMason.new()
	mason.frame = Transform3D(Basis.IDENTITY, TownPlan.FOUNTAIN)
	var radius := TownPlan.FOUNTAIN_RADIUS
	mason.drum(Vector3.ZERO, radius + 0.35, radius + 0.35, 0.12, 16, STONE.darkened(0.1))
	mason.ring(Vector3.UP * 0.12, radius - 0.32, radius, 0.42, 16, STONE)
	mason.ring(Vector3.UP * 0.5, radius - 0.38, radius + 0.08, 0.1, 16, STONE.lightened(0.1))
	mason.drum(Vector3.ZERO, 0.55, 0.4, 0.7, 8, STONE)
	mason.drum(Vector3.UP * 0.7, 0.22, 0.16, 0.8, 8, STONE.darkened(0.06))
	mason.drum(Vector3.UP * 1.4, 0.2, 1.0, 0.28, 12, STONE)
	mason.ring(Vector3.UP * 1.68, 0.86, 1.0, 0.08, 12, STONE.lightened(0.1))
	mason.drum(Vector3.UP * 1.5, 0.14, 0.1, 0.7, 8, STONE.darkened(0.06))
	mason.drum(Vector3.UP * 2.2, 0.06, 0.2, 0.14, 8, STONE)
	var basin := CylinderShape3D.new()
	basin.radius = radius
	basin.height = 1.2
	mason.stop(Transform3D(Basis.IDENTITY, Vector3.UP * 0.6), basin)
	mason.finish(self, "Fountain", _material)
	_water(radius - 0.35)


func _water(radius: float) -> void:
	var wet := ShaderMaterial.new()
	wet.shader = WATER
	var mason := TownMason.new()
	var still := Color.WHITE
	for level: Array in [[0.4, radius], [1.72, 0.86]]:
		var disc := PackedVector3Array()
		for corner: int in 16:
			disc.append(Vector3.BACK.rotated(Vector3.UP, TAU * corner / 16) * level[1] + Vector3.UP * level[0])
		mason.face(disc, still)
	# Jets over the bowl's rim and from the top, as strips that fall in parabolas.
	for jet: int in 8:
		_jet(mason, TAU * jet / 8, Vector2(0.98, 1.74), Vector2(1.55, 0.4), 0.1, 0.3)
	for jet: int in 6:
		_jet(mason, TAU * (jet + 0.5) / 6, Vector2(0.05, 2.34), Vector2(0.6, 1.72), 0.22, 0.1)
	var shown := MeshInstance3D.new()
	shown.name = "Water"
	shown.mesh = mason.mesh(wet)
	shown.position = TownPlan.FOUNTAIN
	shown.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	add_child(shown)


## Falling water between two points, each away from the axis and up.
func _jet(mason: TownMason, angle: float, from: Vector2, to: Vector2, rise: float, breadth: float) -> void:
	mason.frame = Transform3D(Basis(Vector3.UP, angle), Vector3.ZERO)
	var before := from
	for part: int in 6:
		var share := (part + 1) / 6.0
		var now := Vector2(lerpf(from.x, to.x, share), lerpf(from.y, to.y, share * share) + rise * 4.0 * share * (1.0 - share))
		mason.face([Vector3(-0.5 * breadth, now.y, now.x), Vector3(0.5 * breadth, now.y, now.x), Vector3(0.5 * breadth, before.y, before.x), Vector3(-0.5 * breadth, before.y, before.x)], Color(1, 1, 1, 0))
		before = now
	mason.frame = Transform3D.IDENTITY


## A table under striped cloth, with fruit on it.
func _stall() -> void:
	var mason := TownMason.new()
	mason.frame = Transform3D(Basis(Vector3.UP, deg_to_rad(90)), TownPlan.STALL)
	mason.slab(Vector3(-1.5, 0.82, -0.55), Vector3(1.5, 0.9, 0.55), WOOD)
	mason.slab(Vector3(-1.45, 0.1, -0.5), Vector3(1.45, 0.82, 0.5), WOOD.darkened(0.25))
	for x: float in [-1.5, 1.42]:
		for z: float in [-0.6, 0.52]:
			mason.slab(Vector3(x, 0, z), Vector3(x + 0.08, 2.3 - 0.3 * signf(z), z + 0.08), WOOD.darkened(0.1))
	mason.awning(8, 0.425, Vector2(0.95, 2.05), Vector2(-0.7, 2.62), 0.22, CLOTH)
	for crate: int in 4:
		var x := -1.35 + 0.7 * crate
		mason.slab(Vector3(x, 0.9, -0.3), Vector3(x + 0.58, 1.0, 0.4), WOOD.lightened(0.15))
		var fruit: Color = [Color("d48253"), Color("c5b558"), Color("aa5958"), Color("96ae65")][crate]
		for heap: int in 6:
			mason.drum(Vector3(x + 0.12 + 0.17 * (heap % 3), 0.98, -0.12 + 0.3 * (heap / 3)), 0.09, 0.05, 0.1, 6, fruit)
	mason.stop_box(Transform3D(Basis.IDENTITY, Vector3.UP * 0.6), Vector3(3.0, 1.2, 1.2))
	mason.finish(self, "Stall", _material)


func _lamp() -> TownMason:
	var mason := TownMason.new()
	mason.drum(Vector3.ZERO, 0.18, 0.13, 0.35, 8, IRON)
	mason.drum(Vector3.UP * 0.35, 0.06, 0.045, LAMP_HEIGHT - 0.75, 6, IRON)
	mason.drum(Vector3.UP * (LAMP_HEIGHT - 0.4), 0.05, 0.14, 0.08, 6, IRON)
	mason.drum(Vector3.UP * (LAMP_HEIGHT - 0.32), 0.12, 0.19, 0.38, 6, GLASS)
	mason.drum(Vector3.UP * (LAMP_HEIGHT + 0.06), 0.26, 0.05, 0.2, 6, IRON)
	return mason


func _bench() -> TownMason:
	var mason := TownMason.new()
	for x: float in [-0.75, 0.67]:
		mason.slab(Vector3(x, 0, -0.25), Vector3(x + 0.08, 0.42, 0.25), IRON)
		mason.slab(Vector3(x, 0.42, -0.28), Vector3(x + 0.08, 0.88, -0.22), IRON)
	for plank: int in 4:
		mason.slab(Vector3(-0.9, 0.42, -0.22 + 0.125 * plank), Vector3(0.9, 0.46, -0.12 + 0.125 * plank), WOOD)
	for plank: int in 2:
		mason.slab(Vector3(-0.9, 0.56 + 0.16 * plank, -0.22), Vector3(0.9, 0.68 + 0.16 * plank, -0.18), WOOD)
	return mason


## A trunk, and crowns of flat sides.
func _tree() -> TownMason:
	var mason := TownMason.new()
	mason.drum(Vector3.ZERO, 0.2, 0.12, 2.3, 7, BARK)
	var crowns: Array[Vector4] = [Vector4(0, 3.3, 0, 1.35), Vector4(0.9, 2.9, 0.3, 0.9), Vector4(-0.75, 2.8, 0.55, 0.85), Vector4(-0.2, 2.75, -0.9, 0.95), Vector4(0.15, 4.2, 0.1, 0.9)]
	for index: int in crowns.size():
		var crown := crowns[index]
		mason.ball(Vector3(crown.x, crown.y, crown.z), crown.w, LEAVES[index % LEAVES.size()])
	return mason
