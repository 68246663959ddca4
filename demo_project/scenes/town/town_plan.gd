class_name TownPlan
extends RefCounted
## The town's plan: the square is 36 m wide and 28 m deep about the origin, north is -Z, and a lane runs behind its houses.
##
## The square's floor is at y = 0; its north end is a terrace, and the stair to it has steps of 15 by 30 cm.

const HALF_WIDTH := 18.0
const SOUTH := 16.0
## The terrace's front and back, and its height.
const TERRACE_FRONT := -12.0
const TERRACE_BACK := -21.0
const STEP := Vector2(0.30, 0.15)
const STEPS := 10
const RISE := STEPS * 0.15
const STAIR_HALF := 3.5
## The ramp's foot and head along x, and its width.
const RAMP_FOOT := 4.6
const RAMP_HEAD := 15.4
const RAMP_WIDTH := 2.9
const FOUNTAIN := Vector3(0, 0, 3.0)
const FOUNTAIN_RADIUS := 2.6
## The bed with the wall to jump onto: its middle, half its sides, and height.
const BED := Vector3(-10.5, 0, -6.4)
const BED_HALF := Vector2(3.0, 2.2)
const BED_HEIGHT := 0.42
const STALL := Vector3(-11.5, 0, 9.5)
## The outer lane: its inner edge, and the fronts of the houses behind it.
const LANE_INNER := 26.0
const LANE_OUTER := 30.5
const LANE_SOUTH := 24.0
const LAMPS: PackedVector3Array = [
	Vector3(-5.6, 0, -7.4), Vector3(4.1, 0, -7.4), Vector3(-14, 0, 3.5), Vector3(14, 0, 3.5), Vector3(-6.5, 0, 13.0), Vector3(6.5, 0, 13.0),
	Vector3(-9.0, RISE, -16.5), Vector3(9.0, RISE, -16.5),
]
## Benches: place, and the heading of who sits there, degrees.
const BENCHES: Array[Array] = [
	[Vector3(-5.2, 0, 6.0), 120.0], [Vector3(5.2, 0, 6.0), -120.0], [Vector3(-5.2, 0, 0.2), 60.0], [Vector3(5.2, 0, 0.2), -60.0],
	[Vector3(14.8, 0, -1.0), -90.0], [Vector3(-13.0, RISE, -19.6), 0.0], [Vector3(13.0, RISE, -19.6), 0.0],
]
## Trees: place and size.
const TREES: Array[Array] = [
	[BED + Vector3.UP * 0.3, 1.2], [Vector3(13.6, 0, 8.6), 1.05], [Vector3(-14.8, 0, 13.2), 0.95],
	[Vector3(14.6, RISE, -15.2), 0.85], [Vector3(-14.6, RISE, -15.2), 0.9], [Vector3(28.2, 0, 15.5), 0.8], [Vector3(-28.2, 0, -6.0), 0.8],
]

const CREAM := Color("ecdec3")
const OCHRE := Color("dfc49a")
const ROSE := Color("dabaac")
const SAGE := Color("c5c9ac")
const CHALK := Color("f0e9dd")
const BRICK := Color("be9687")
const MIST := Color("c4cdd1")
const TILE := Color("b08371")
const RUST := Color("967468")
const SLATE := Color("7a818b")
const TEAL := Color("759697")
const MOSS := Color("8ca085")
const WINE := Color("9b6c64")
const NAVY := Color("74889f")

## Houses round the square: middle of the front, heading in degrees, width, storeys, roof, ground floor, plaster, tiles, shutters,
## depth of the cellar, and the sides that can be seen (see `TownHouse`).
const HOUSES: Array[Array] = [
	[Vector3(-18, 0, -8), 90, 8.0, 2, TownHouse.Roof.EAVES, TownHouse.Ground.SHOP, OCHRE, TILE, MOSS, 0.0, [0, 2]],
	[Vector3(-18, 0, -0.5), 90, 7.0, 3, TownHouse.Roof.GABLE, TownHouse.Ground.DOOR, ROSE, RUST, TEAL, 0.0, [0, 1, 2, 3]],
	[Vector3(-18, 0, 12), 90, 8.0, 2, TownHouse.Roof.EAVES, TownHouse.Ground.ARCADE, CHALK, TILE, NAVY, 0.0, [0, 1, 2]],
	[Vector3(18, 0, -8.5), -90, 7.0, 2, TownHouse.Roof.EAVES, TownHouse.Ground.DOOR, SAGE, TILE, WINE, 0.0, [0, 2]],
	[Vector3(18, 0, -1.5), -90, 7.0, 3, TownHouse.Roof.GABLE, TownHouse.Ground.SHOP, CREAM, SLATE, WINE, 0.0, [0, 1, 2, 3]],
	[Vector3(18, 0, 4.5), -90, 5.0, 3, TownHouse.Roof.EAVES, TownHouse.Ground.DOOR, BRICK, RUST, NAVY, 0.0, [0, 1, 2]],
	[Vector3(18, 0, 13.5), -90, 5.0, 2, TownHouse.Roof.EAVES, TownHouse.Ground.DOOR, OCHRE, SLATE, TEAL, 0.0, [0, 2, 3]],
	[Vector3(-13.5, 0, 16), 180, 9.0, 2, TownHouse.Roof.EAVES, TownHouse.Ground.DOOR, MIST, RUST, NAVY, 0.0, [0, 2]],
	[Vector3(-6, 0, 16), 180, 6.0, 3, TownHouse.Roof.GABLE, TownHouse.Ground.SHOP, OCHRE, TILE, TEAL, 0.0, [0, 1, 2, 3]],
	[Vector3(6.5, 0, 16), 180, 7.0, 2, TownHouse.Roof.EAVES, TownHouse.Ground.SHOP, ROSE, TILE, MOSS, 0.0, [0, 1, 2]],
	[Vector3(14, 0, 16), 180, 8.0, 3, TownHouse.Roof.GABLE, TownHouse.Ground.DOOR, CHALK, SLATE, MOSS, 0.0, [0, 1, 2]],
	[Vector3(-18, RISE, -16.5), 90, 9.0, 2, TownHouse.Roof.EAVES, TownHouse.Ground.DOOR, SAGE, SLATE, WINE, RISE, [0, 2]],
	[Vector3(18, RISE, -16.5), -90, 9.0, 2, TownHouse.Roof.GABLE, TownHouse.Ground.ARCADE, ROSE, RUST, NAVY, RISE, [0, 2]],
	[Vector3(-12.5, RISE, -21), 0, 11.0, 2, TownHouse.Roof.EAVES, TownHouse.Ground.ARCADE, CREAM, TILE, TEAL, RISE, [0, 2]],
	[Vector3(0, RISE, -21), 0, 14.0, 3, TownHouse.Roof.HIP, TownHouse.Ground.ARCADE, CHALK, SLATE, NAVY, RISE, [0, 1, 2, 3]],
	[Vector3(12.5, RISE, -21), 0, 11.0, 2, TownHouse.Roof.EAVES, TownHouse.Ground.DOOR, OCHRE, RUST, MOSS, RISE, [0, 2]],
	# The corners behind.
	[Vector3(-22, 0, 24), 0, 8.0, 2, TownHouse.Roof.HIP, TownHouse.Ground.DOOR, BRICK, RUST, TEAL, 0.0, [0, 3]],
	[Vector3(22, 0, 24), 0, 8.0, 2, TownHouse.Roof.HIP, TownHouse.Ground.DOOR, CREAM, TILE, WINE, 0.0, [0, 1]],
]
## Houses across the lane, of which little is seen: plasters and tiles in turn.
const PLASTERS: PackedColorArray = [CREAM, BRICK, SAGE, CHALK, OCHRE, MIST, ROSE]
const ROOFS: PackedColorArray = [TILE, RUST, SLATE, TILE]


## Depth of a point inside the house, the fountain, the bed or the stall that it is in, metres over the ground; 0 outside.
static func depth_in_solids(point: Vector3) -> float:
	var depth := 0.0
	for row: Array in HOUSES:
		var inside: Vector3 = (point - row[0]).rotated(Vector3.UP, -deg_to_rad(row[1]))
		depth = maxf(depth, minf(0.5 * row[2] - absf(inside.x), minf(-inside.z, inside.z + TownHouse.DEPTH)))
	depth = maxf(depth, FOUNTAIN_RADIUS - Vector2(point.x - FOUNTAIN.x, point.z - FOUNTAIN.z).length())
	for bed: Array in [[BED, BED_HALF], [STALL, Vector2(0.6, 1.5)]]:
		var off: Vector3 = (point - bed[0]).abs()
		depth = maxf(depth, minf(bed[1].x - off.x, bed[1].y - off.z))
	return depth
