class_name TownSpots
extends RefCounted
## Places that people go to, and for how long they stay.

## One place for one person.
class Spot:
	var place: Vector3
	## Direction in which one looks there, radians about +Y from +Z; not a number where it does not matter.
	var heading: float
	## The shortest and the longest stay, seconds.
	var stay: Vector2
	var is_taken := false


var all: Array[Spot] = []


func _init() -> void:
	_round_the_fountain()
	_at_the_parapet()
	_at_the_stall()
	_in_company()
	_at_doors()
	_out_of_sight()


## A free spot at some distance.
func draw(chance: RandomNumberGenerator, from: Vector3) -> Spot:
	for attempt: int in 40:
		var spot := all[chance.randi() % all.size()]
		if not spot.is_taken and spot.place.distance_to(from) > 7.0:
			return spot
	return null


func _add(place: Vector3, heading := NAN, stay := Vector2(4, 14)) -> void:
	var spot := Spot.new()
	spot.place = place
	spot.heading = heading
	spot.stay = stay
	all.append(spot)


func _round_the_fountain() -> void:
	for index: int in 7:
		var out := Vector3.BACK.rotated(Vector3.UP, TAU * (index + 0.3) / 7)
		_add(TownPlan.FOUNTAIN + out * (TownPlan.FOUNTAIN_RADIUS + 1.2), atan2(-out.x, -out.z), Vector2(6, 20))


func _at_the_parapet() -> void:
	for x: float in [-14.5, -11.8, -8.2, -5.6, 5.2, 8.0, 11.5, 13.8]:
		_add(Vector3(x, TownPlan.RISE, TownPlan.TERRACE_FRONT - 1.4), 0.0, Vector2(8, 25))


func _at_the_stall() -> void:
	for z: float in [-1.1, 0.0, 1.1]:
		_add(TownPlan.STALL + Vector3(1.45, 0, z), -0.5 * PI, Vector2(8, 20))


## Rings of people who talk.
func _in_company() -> void:
	for ring: Array in [[Vector3(10.8, 0, -5.4), 3], [Vector3(-6.0, 0, 10.6), 2], [Vector3(10.5, 0, 11.5), 3], [Vector3(-3.5, TownPlan.RISE, -17.0), 3], [Vector3(-15.4, 0, 1.4), 2]]:
		for index: int in ring[1]:
			var out := Vector3.BACK.rotated(Vector3.UP, TAU * index / ring[1] + ring[0].x)
			_add(ring[0] + out * 0.65, atan2(-out.x, -out.z), Vector2(15, 50))


## In front of houses, where some look at what is in a shop's window.
func _at_doors() -> void:
	for index: int in TownPlan.HOUSES.size() - 2:
		var row := TownPlan.HOUSES[index]
		if index == 3:
			# The ramp's head is before it.
			continue
		var heading := deg_to_rad(row[1])
		for aside: float in [-0.22, 0.25]:
			var off := Vector3(aside * row[2], 0, 1.5).rotated(Vector3.UP, heading)
			_add(row[0] + off, wrapf(heading + PI, -PI, PI), Vector2(2, 8))


## The lane behind the houses, from where people come back.
func _out_of_sight() -> void:
	for place: Vector3 in [Vector3(-28.2, 0, -14), Vector3(-28.2, 0, 20), Vector3(-20, 0, 26.2), Vector3(-12, 0, 26.2), Vector3(12, 0, 26.2), Vector3(20, 0, 26.2), Vector3(28.2, 0, 22), Vector3(28.2, 0, -12), Vector3(28.2, 0, -4), Vector3(-28.2, 0, -1)]:
		for place_beside: float in [-0.9, 0.9]:
			_add(place + Vector3(place_beside, 0, place_beside), NAN, Vector2(1, 4))
