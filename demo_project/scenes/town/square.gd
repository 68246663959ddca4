class_name TownSquare
extends Node3D
## The town's stone: paving, terrace, stair, ramp and houses, built in code from `TownPlan`. One mesh for each side of the square, so that what is behind the camera is not drawn.

const PAVING: Shader = preload("res://scenes/town/paving.gdshader")
const STONE := Color("d1c6b0")
const COPING := Color("dfd6c2")
const HILL := Color("a4a093")

## Material of everything in the town.
var material: Material


func build(paint: Material) -> void:
	material = paint
	_floor()
	_terrace()
	_bed()
	_houses()
	_hills()


func _floor() -> void:
	var paving := ShaderMaterial.new()
	paving.shader = PAVING
	var mason := TownMason.new()
	mason.stop_box(Transform3D(Basis.IDENTITY, Vector3(0, -0.5, 0)), Vector3(90, 1, 90))
	mason.face([Vector3(-400, 0, 400), Vector3(400, 0, 400), Vector3(400, 0, -400), Vector3(-400, 0, -400)], STONE)
	var high := Vector3.UP * (TownPlan.RISE + 0.004)
	var corner := Vector3(TownPlan.HALF_WIDTH, 0, 0)
	var front := Vector3(0, 0, TownPlan.TERRACE_FRONT - 0.3)
	var back := Vector3(0, 0, TownPlan.TERRACE_BACK)
	mason.face([high + front - corner, high + front + corner, high + back + corner, high + back - corner], STONE)
	mason.finish(self, "Floor", paving, TownMason.GROUND | TownMason.SOLID)


## The terrace with its stair and its ramp: what people walk on. Balustrades are separate, because they are not walked on.
func _terrace() -> void:
	var half := TownPlan.HALF_WIDTH
	var front := TownPlan.TERRACE_FRONT
	var mason := TownMason.new()
	mason.block(Vector3(-half, -0.2, TownPlan.TERRACE_BACK), Vector3(half, TownPlan.RISE, front), STONE)
	for step: int in TownPlan.STEPS:
		var reach := front + TownPlan.STEP.x * (TownPlan.STEPS - 1 - step)
		var top := TownPlan.STEP.y * (step + 1)
		if reach > front:
			mason.block(Vector3(-TownPlan.STAIR_HALF, TownPlan.STEP.y * step, front), Vector3(TownPlan.STAIR_HALF, top, reach), STONE.darkened(0.25))
		# Slabs over darker risers, so that steps are told apart in the shade.
		mason.slab(Vector3(-TownPlan.STAIR_HALF, top - 0.035, reach - TownPlan.STEP.x), Vector3(TownPlan.STAIR_HALF, top + 0.002, reach + 0.012), STONE.lightened(0.08))
	var far := front + TownPlan.RAMP_WIDTH
	mason.bar([Vector2(TownPlan.RAMP_FOOT, 0), Vector2(TownPlan.RAMP_HEAD, 0), Vector2(TownPlan.RAMP_HEAD, TownPlan.RISE)], front, far, STONE)
	mason.block(Vector3(TownPlan.RAMP_HEAD, 0, front), Vector3(half, TownPlan.RISE, far), STONE)
	var run := Vector2(TownPlan.RAMP_HEAD - TownPlan.RAMP_FOOT, TownPlan.RISE)
	var slope := Basis(Vector3.BACK, run.angle())
	var middle := Vector3(0.5 * (TownPlan.RAMP_HEAD + TownPlan.RAMP_FOOT), 0.5 * TownPlan.RISE, 0.5 * (front + far))
	mason.stop_box(Transform3D(slope, middle - slope.y * 0.25), Vector3(run.length(), 0.5, TownPlan.RAMP_WIDTH))
	mason.finish(self, "Terrace", material, TownMason.GROUND | TownMason.SOLID)
	_balustrades(front, far)


func _balustrades(front: float, far: float) -> void:
	var half := TownPlan.HALF_WIDTH
	var high := TownPlan.RISE
	var mason := TownMason.new()
	_balustrade(mason, Vector3(-half, high, front - 0.15), Vector3(-TownPlan.STAIR_HALF, high, front - 0.15))
	_balustrade(mason, Vector3(TownPlan.STAIR_HALF, high, front - 0.15), Vector3(TownPlan.RAMP_HEAD, high, front - 0.15))
	_balustrade(mason, Vector3(TownPlan.RAMP_HEAD, high, far - 0.15), Vector3(half, high, far - 0.15))
	# Cheeks of the stair, and the low wall along the ramp.
	var foot := front + TownPlan.STEP.x * (TownPlan.STEPS - 1)
	for side: float in [-1.0, 1.0]:
		var x := side * (TownPlan.STAIR_HALF + 0.2)
		mason.frame = Transform3D(Basis(Vector3.UP, -0.5 * PI), Vector3(x, 0, 0))
		mason.bar([Vector2(front, 0), Vector2(foot + 0.25, 0), Vector2(foot + 0.25, 0.5), Vector2(front, high + 0.5)], -0.2, 0.2, STONE)
		mason.frame = Transform3D.IDENTITY
		mason.stop_box(Transform3D(Basis.IDENTITY, Vector3(x, 0.5 * high, 0.5 * (front + foot))), Vector3(0.4, high + 1.0, foot - front + 0.4))
		for z: float in [front, foot + 0.25]:
			_pillar(mason, Vector3(x, 0.0 if z > front else high, z), 1.0)
	mason.bar([Vector2(TownPlan.RAMP_FOOT + 0.4, 0), Vector2(TownPlan.RAMP_HEAD, 0), Vector2(TownPlan.RAMP_HEAD, high + 0.5), Vector2(TownPlan.RAMP_FOOT + 0.4, 0.5)], far, far + 0.3, STONE)
	mason.stop_box(Transform3D(Basis.IDENTITY, Vector3(0.5 * (TownPlan.RAMP_FOOT + TownPlan.RAMP_HEAD) + 0.2, 1.0, far + 0.15)), Vector3(TownPlan.RAMP_HEAD - TownPlan.RAMP_FOOT - 0.4, 2.0, 0.3))
	mason.slab(Vector3(TownPlan.RAMP_HEAD, 0, far), Vector3(half, high, far + 0.3), STONE)
	mason.finish(self, "Balustrades", material)


## A parapet of short pillars under a coping, along x.
func _balustrade(mason: TownMason, from: Vector3, to: Vector3) -> void:
	mason.slab(from + Vector3(0, 0, -0.15), to + Vector3(0, 0.14, 0.15), STONE)
	mason.slab(from + Vector3(0, 0.78, -0.17), to + Vector3(0, 0.92, 0.17), COPING)
	mason.stop_box(Transform3D(Basis.IDENTITY, 0.5 * (from + to) + Vector3.UP * 0.46), Vector3(to.x - from.x, 0.92, 0.34))
	var count := int((to.x - from.x) / 0.36)
	for post: int in count:
		var at := from.lerp(to, (post + 0.5) / count)
		mason.drum(at + Vector3.UP * 0.14, 0.09, 0.06, 0.64, 6, COPING)
	for end: Vector3 in [from, to]:
		_pillar(mason, end, 1.02)


func _pillar(mason: TownMason, foot: Vector3, height: float) -> void:
	mason.block(foot + Vector3(-0.26, 0, -0.26), foot + Vector3(0.26, height, 0.26), STONE)
	mason.slab(foot + Vector3(-0.32, height, -0.32), foot + Vector3(0.32, height + 0.1, 0.32), COPING)


## A bed of earth in a wall as low as a bench and as broad as a path.
func _bed() -> void:
	var mason := TownMason.new()
	mason.frame = Transform3D(Basis.IDENTITY, TownPlan.BED)
	var half := Vector3(TownPlan.BED_HALF.x, 0, TownPlan.BED_HALF.y)
	var up := Vector3.UP * TownPlan.BED_HEIGHT
	mason.slab(-half, half + up - Vector3.UP * 0.08, STONE)
	mason.slab(-half - Vector3(0.06, -TownPlan.BED_HEIGHT + 0.08, 0.06), half + up + Vector3(0.06, 0, 0.06), COPING)
	mason.slab(Vector3(-1.2, 0.2, -0.9), Vector3(1.2, TownPlan.BED_HEIGHT + 0.06, 0.9), Color("766653"))
	mason.stop_box(Transform3D(Basis.IDENTITY, 0.5 * up), 2.0 * half + up)
	mason.stop_box(Transform3D(Basis.IDENTITY, Vector3.UP * 1.5), Vector3(0.5, 3, 0.5))
	mason.finish(self, "Bed", material)


func _houses() -> void:
	var sides: Dictionary[float, TownMason] = {}
	for index: int in TownPlan.HOUSES.size():
		var row := TownPlan.HOUSES[index]
		var house := TownHouse.new()
		house.number = index + 1
		house.width = row[2]
		house.storeys = row[3]
		house.roof = row[4]
		house.ground = row[5]
		house.plaster = row[6]
		house.tiles = row[7]
		house.shutters = row[8]
		house.cellar = row[9]
		house.sides.assign(row[10])
		_place(house, row[0], row[1], sides)
	_lane(sides)
	_turret(sides[0.0])
	for heading: float in sides:
		sides[heading].finish(self, "Houses%d" % heading, material)


func _place(house: TownHouse, at: Vector3, heading: float, sides: Dictionary[float, TownMason]) -> void:
	var mason: TownMason = sides.get_or_add(heading, TownMason.new())
	mason.frame = Transform3D(Basis(Vector3.UP, deg_to_rad(heading)), at)
	house.build(mason)


## A clock above the hall on the terrace.
func _turret(mason: TownMason) -> void:
	mason.frame = Transform3D(Basis.IDENTITY, Vector3(0, TownPlan.RISE + 3.0 * TownHouse.STOREY, TownPlan.TERRACE_BACK - 0.5 * TownHouse.DEPTH))
	mason.slab(Vector3(-1.4, 1.2, -1.4), Vector3(1.4, 5.6, 1.4), TownPlan.CHALK)
	mason.slab(Vector3(-1.6, 5.3, -1.6), Vector3(1.6, 5.6, 1.6), COPING)
	for side: int in 4:
		var own := mason.frame
		mason.frame = own * Transform3D(Basis(Vector3.UP, 0.5 * PI * side), Vector3.ZERO)
		var dial := PackedVector3Array()
		for corner: int in 16:
			dial.append(Vector3(0.85 * sin(-TAU * corner / 16), 4.1 + 0.85 * cos(TAU * corner / 16), 1.43))
		mason.face(dial, TownFurniture.GLASS)
		mason.slab(Vector3(-0.04, 4.1, 1.43), Vector3(0.04, 4.75, 1.46), TownFurniture.IRON)
		mason.slab(Vector3(-0.45, 4.06, 1.43), Vector3(0, 4.14, 1.46), TownFurniture.IRON)
		mason.face([Vector3(-1.7, 5.6, 1.7), Vector3(1.7, 5.6, 1.7), Vector3(0, 8.6, 0)], TownPlan.SLATE)
		mason.frame = own
	mason.drum(Vector3(0, 8.4, 0), 0.05, 0.02, 1.3, 6, TownFurniture.IRON)


## Houses on the other side of the lane.
func _lane(sides: Dictionary[float, TownMason]) -> void:
	var number := 0
	for heading: float in [90.0, -90.0, 180.0]:
		for place: int in 7:
			number += 1
			var along := -20.0 + 8.0 * place
			var out := TownPlan.LANE_OUTER
			var at := Vector3(-signf(heading) * out, 0, along) if absf(heading) == 90.0 else Vector3(along - 4.0, 0, TownPlan.LANE_SOUTH + 4.5)
			_place(_plain(number), at, heading, sides)
	# Ends of the lane.
	for x: float in [-28.0, 28.0]:
		_place(_plain(number + 3), Vector3(x, 0, -20.0), 0.0, sides)


func _plain(number: int) -> TownHouse:
	var house := TownHouse.new()
	house.number = 40 + number
	house.storeys = 2 + int(number % 3 == 0)
	house.plaster = TownPlan.PLASTERS[number % TownPlan.PLASTERS.size()]
	house.tiles = TownPlan.ROOFS[number % TownPlan.ROOFS.size()]
	house.roof = TownHouse.Roof.GABLE if number % 4 == 0 else TownHouse.Roof.EAVES
	house.sides = [0]
	return house


## Hills around, so that the world does not end behind the last house.
func _hills() -> void:
	var mason := TownMason.new()
	var count := 48
	for part: int in count:
		var here := _hill(part, count)
		var next := _hill(part + 1, count)
		var ground := Vector3(1, 0, 1)
		mason.face([next * ground * 0.6, here * ground * 0.6, here, next], HILL)
	mason.finish(self, "Hills", material)


func _hill(part: int, count: int) -> Vector3:
	var angle := TAU * part / count
	return Vector3(sin(angle), 0, cos(angle)) * 170.0 + Vector3.UP * (13.0 + 6.0 * sin(3.0 * angle + 1.0) + 4.0 * sin(7.0 * angle))
