class_name TownHouse
extends RefCounted
## A house: its front is at z = 0 and looks along +Z, its foot at y = 0. Doors are 2.1 m high, storeys 3.

enum Roof { EAVES, GABLE, HIP }
enum Ground { DOOR, SHOP, ARCADE }

const STOREY := 3.0
const DEPTH := 8.0
const DOOR := Vector2(1.0, 2.1)
const PANE := Vector2(0.95, 1.45)
const SILL := 0.95
## Distance from window to window, at least.
const BAY := 2.1
const EAVES := 0.45
const STONE := Color("d5cbb6")
const TRIM := Color("eee7d8")
const WOOD := Color("84644d")
const DARK_PANE := Color("6f7b85")
## Warm light behind a pane; alpha 0 shines.
const LIT_PANES: PackedColorArray = [Color(1.0, 0.76, 0.5, 0.0), Color(1.0, 0.84, 0.62, 0.0), Color(0.97, 0.69, 0.44, 0.0)]

var width := 8.0
var storeys := 2
var roof := Roof.EAVES
var ground := Ground.DOOR
var plaster := Color("e9dcbf")
var tiles := Color("b06d59")
var shutters := Color("588386")
## Number of the house, of which its details follow.
var number := 0
## Sides that can be seen: 0 the front, 1 to the left of who looks out of it, 2 the back, 3 the right.
var sides: Array[int] = [0]
## Depth below its foot to which its walls go down.
var cellar := 0.0

var _chance := RandomNumberGenerator.new()
var _mason: TownMason


func build(mason: TownMason) -> void:
	_mason = mason
	_chance.seed = number
	var half := 0.5 * width
	var top := storeys * STOREY + 0.3
	mason.block(Vector3(-half, -cellar, -DEPTH), Vector3(half, top, 0), plaster)
	mason.slab(Vector3(-half - 0.06, -cellar, -DEPTH - 0.06), Vector3(half + 0.06, 0.55, 0.06), STONE.darkened(0.12))
	var own := mason.frame
	for side: int in sides:
		var span := width if side % 2 == 0 else DEPTH
		var out := 0.0 if side == 0 else (DEPTH if side == 2 else half)
		var middle := Vector3(0, 0, 0 if side == 0 else (-DEPTH if side == 2 else -0.5 * DEPTH))
		if side % 2 == 1:
			middle.x = half if side == 1 else -half
		mason.frame = own * Transform3D(Basis(Vector3.UP, side * 0.5 * PI), middle)
		_front(span, top, side == 0)
	mason.frame = own
	_cover(half, top)
	if roof != Roof.HIP:
		var chimney := Vector3(half * 0.5 * (1 if number % 2 == 0 else -1), top, -DEPTH * 0.62)
		mason.slab(chimney, chimney + Vector3(0.7, 3.4, 0.55), plaster.darkened(0.25))
		mason.slab(chimney + Vector3(-0.07, 3.4, -0.07), chimney + Vector3(0.77, 3.55, 0.62), STONE)


## One side: windows, a belt between storeys, and to the street a door.
func _front(span: float, top: float, to_street: bool) -> void:
	var half := 0.5 * span
	_mason.slab(Vector3(-half, STOREY + 0.1, 0), Vector3(half, STOREY + 0.28, 0.08), TRIM)
	_mason.slab(Vector3(-half, top - 0.28, 0), Vector3(half, top, 0.16), TRIM)
	for edge: float in [-half, half - 0.32]:
		_mason.slab(Vector3(edge, 0.55, 0), Vector3(edge + 0.32, top - 0.28, 0.05), TRIM.darkened(0.06))
	var bays := maxi(1, int((span - 0.9) / BAY))
	var door_bay := _chance.randi_range(0, bays - 1)
	for storey: int in storeys:
		for bay: int in bays:
			var x := span * ((bay + 0.5) / bays - 0.5)
			if storey > 0 or not to_street:
				if to_street or _chance.randf() < 0.55:
					_window(Vector3(x, storey * STOREY + SILL + 0.2, 0), PANE, to_street)
			elif ground == Ground.DOOR and bay != door_bay:
				_window(Vector3(x, SILL + 0.2, 0), PANE, to_street)
			elif ground == Ground.DOOR or bay == door_bay:
				_door(x)
			elif ground == Ground.SHOP:
				_window(Vector3(x, 0.65, 0), Vector2(minf(span / bays - 0.5, 2.2), 1.75), false)
			else:
				_window(Vector3(x, 0.6, 0), Vector2(1.25, 2.0), false)
	if to_street and ground == Ground.SHOP:
		_awning(span)


func _window(foot: Vector3, size: Vector2, shuttered: bool) -> void:
	var lit := _chance.randf() < 0.5
	var pane := LIT_PANES[_chance.randi() % LIT_PANES.size()] if lit else DARK_PANE
	var half := 0.5 * size.x
	var top := foot.y + size.y
	_mason.face([Vector3(foot.x - half, foot.y, 0.02), Vector3(foot.x + half, foot.y, 0.02), Vector3(foot.x + half, top, 0.02), Vector3(foot.x - half, top, 0.02)], pane)
	for side: float in [-1.0, 1.0]:
		var edge := foot.x + side * half
		_mason.slab(Vector3(edge - 0.05, foot.y, 0), Vector3(edge + 0.05, top, 0.1), TRIM)
		if shuttered:
			var out := edge + side * 0.31
			_mason.slab(Vector3(out - 0.23, foot.y, 0), Vector3(out + 0.23, top, 0.05), shutters)
	_mason.slab(Vector3(foot.x - half - 0.05, top, 0), Vector3(foot.x + half + 0.05, top + 0.12, 0.13), TRIM)
	_mason.slab(Vector3(foot.x - half - 0.12, foot.y - 0.09, 0), Vector3(foot.x + half + 0.12, foot.y, 0.17), TRIM)
	_mason.slab(Vector3(foot.x - 0.025, foot.y, 0), Vector3(foot.x + 0.025, top, 0.06), TRIM.darkened(0.1))
	var bar := foot.y + 0.62 * size.y
	_mason.slab(Vector3(foot.x - half, bar, 0), Vector3(foot.x + half, bar + 0.05, 0.06), TRIM.darkened(0.1))


func _door(x: float) -> void:
	var half := 0.5 * DOOR.x
	_mason.slab(Vector3(x - half, 0, 0), Vector3(x + half, DOOR.y, 0.07), shutters.lerp(WOOD, 0.5))
	_mason.slab(Vector3(x - half, DOOR.y, 0), Vector3(x + half, DOOR.y + 0.36, 0.04), LIT_PANES[0])
	for side: float in [-1.0, 1.0]:
		var edge := x + side * (half + 0.08)
		_mason.slab(Vector3(edge - 0.1, 0, 0), Vector3(edge + 0.1, DOOR.y + 0.36, 0.16), TRIM)
		_mason.slab(Vector3(x + side * 0.22 - 0.13, 1.15, 0), Vector3(x + side * 0.22 + 0.13, 1.85, 0.09), shutters.lerp(WOOD, 0.5).darkened(0.2))
	_mason.slab(Vector3(x - half - 0.25, DOOR.y + 0.36, 0), Vector3(x + half + 0.25, DOOR.y + 0.54, 0.28), TRIM)
	_mason.slab(Vector3(x - half - 0.15, 0, 0), Vector3(x + half + 0.15, 0.07, 0.4), STONE)


## Striped cloth over a shop's windows.
func _awning(span: float) -> void:
	var stripes := int(span / 0.5)
	_mason.awning(stripes, 0.5, Vector2(1.3, 2.45), Vector2(0.09, 2.95), 0.25, [shutters, TRIM])


func _cover(half: float, top: float) -> void:
	match roof:
		Roof.EAVES:
			# Its ridge runs along the street.
			var own := _mason.frame
			_mason.frame = own * Transform3D(Basis(Vector3.UP, 0.5 * PI), Vector3(0, 0, -0.5 * DEPTH))
			_saddle(0.5 * DEPTH, top, -half, half)
			_mason.frame = own
			for dormer: int in int(width / 4.0):
				_dormer((dormer + 0.5) / int(width / 4.0) * width - half, top)
		Roof.GABLE:
			_saddle(half, top, -DEPTH, 0.0)
			_window(Vector3(0, top + 0.6, 0), Vector2(0.8, 1.1), false)
		Roof.HIP:
			_hip(half, top)


## Two slopes and the gables under them, in the plane of x and y.
func _saddle(half: float, top: float, from_z: float, to_z: float) -> void:
	var rise := half * 0.95
	_mason.bar([Vector2(-half, top), Vector2(half, top), Vector2(0, top + rise)], from_z, to_z, plaster)
	var low := Vector2(half + EAVES, top - EAVES * 0.95)
	var up := Vector2(0, 0.22)
	_mason.bar([low, low + up, Vector2(0, top + rise) + up, Vector2(0, top + rise)], from_z - 0.3, to_z + 0.3, tiles)
	var left := Vector2(-low.x, low.y)
	_mason.bar([left, Vector2(0, top + rise), Vector2(0, top + rise) + up, left + up], from_z - 0.3, to_z + 0.3, tiles)
	_mason.slab(Vector3(-0.14, top + rise + 0.1, from_z - 0.3), Vector3(0.14, top + rise + 0.3, to_z + 0.3), tiles.darkened(0.15))


func _hip(half: float, top: float) -> void:
	var rise := 0.36 * DEPTH
	var out := EAVES
	var foot := [Vector3(-half - out, top, out), Vector3(half + out, top, out), Vector3(half + out, top, -DEPTH - out), Vector3(-half - out, top, -DEPTH - out)]
	var ends := [Vector3(-maxf(half - 0.5 * DEPTH, 0.0), top + rise, -0.5 * DEPTH), Vector3(maxf(half - 0.5 * DEPTH, 0.0), top + rise, -0.5 * DEPTH)]
	_mason.face([foot[0], foot[1], ends[1], ends[0]], tiles)
	_mason.face([foot[1], foot[2], ends[1]], tiles)
	_mason.face([foot[2], foot[3], ends[0], ends[1]], tiles)
	_mason.face([foot[3], foot[0], ends[0]], tiles)
	_mason.face([foot[3], foot[2], foot[1], foot[0]], TRIM.darkened(0.2))


func _dormer(x: float, top: float) -> void:
	var foot := top + 0.75
	_mason.slab(Vector3(x - 0.65, foot - 0.3, -3.0), Vector3(x + 0.65, foot + 1.25, -0.75), plaster)
	var own := _mason.frame
	_mason.frame = own * Transform3D(Basis.IDENTITY, Vector3(x, 0, -0.75))
	_window(Vector3(0, foot + 0.05, 0), Vector2(0.75, 1.0), false)
	_mason.bar([Vector2(-0.65, foot + 1.25), Vector2(0.65, foot + 1.25), Vector2(0, foot + 1.8)], -2.6, 0.0, plaster)
	for side: float in [-1.0, 1.0]:
		var slope := PackedVector2Array([Vector2(side * 0.85, foot + 1.08), Vector2(side * 0.85, foot + 1.2), Vector2(0, foot + 1.95), Vector2(0, foot + 1.82)])
		if side < 0.0:
			slope.reverse()
		_mason.bar(slope, -2.8, 0.2, tiles)
	_mason.frame = own
