class_name Townspeople
extends Node
## The people of the town: each goes to a place, turns to what is there, stays for a while and goes on; some run their rounds.

enum Doing { GOES, ARRIVES, STAYS, SETS_OUT, RUNS }

const STYLES: Array[GaitStyle] = [
	preload("res://addons/footfall/models/afraid.footstyle"),
	preload("res://addons/footfall/models/cool.footstyle"),
	preload("res://addons/footfall/models/decided.footstyle"),
	preload("res://addons/footfall/models/drunk.footstyle"),
	preload("res://addons/footfall/models/heavy.footstyle"),
	preload("res://addons/footfall/models/in_a_hurry.footstyle"),
	preload("res://addons/footfall/models/manly.footstyle"),
	preload("res://addons/footfall/models/proud.footstyle"),
	preload("res://addons/footfall/models/sad.footstyle"),
	preload("res://addons/footfall/models/tiptoeing.footstyle"),
	preload("res://addons/footfall/models/topmodel.footstyle"),
]
## The style of those who walk fast, and how fast.
const HURRIED := 5
const HURRIED_MPS := 1.9
const RUN_MPS := Vector2(2.5, 3.1)
## Share of people who stay somewhere at the beginning.
const STAYING := 0.4
## In each frame every so-manyth person thinks.
const THINKS_EVERY := 8
## Distance within which a walker has arrived, metres, and angles within which it faces its sight, or its next place, radians.
const THERE_M := 0.8
const FACING := 0.2
const SETTING_OUT := 1.0
const TURNING := 1.2
## Time without progress after which a walker gets another place, seconds.
const PATIENCE := 5.0
## Runners look so far ahead on their round, metres.
const AHEAD_M := 3.5


## A person of the crowd.
class Person:
	var id: int
	var doing := Doing.GOES
	var speed: float
	var spot: TownSpots.Spot
	## Direction that it turns to, radians; not a number for none.
	var faces := NAN
	var left_secs := 0.0
	var nearest := INF


var people: Array[Person] = []

var _spots := TownSpots.new()
var _chance := RandomNumberGenerator.new()
var _round := Curve3D.new()
var _frame := 0

@onready var _crowd: GaitCrowd3D = get_parent()


## Brings people to the town, whose navigation map has to be there.
func come(count: int, runners: int) -> void:
	_chance.seed = 11
	for corner: int in 25:
		var angle := TAU * corner / 24
		_round.add_point(Vector3(12.4 * sin(angle), 0, 3.0 + 6.4 * cos(angle)))
	var places := PackedVector3Array()
	var headings := PackedFloat32Array()
	for index: int in count:
		var person := Person.new()
		people.append(person)
		if index < runners:
			person.doing = Doing.RUNS
			var at := _round.get_baked_length() * index / runners
			places.append(_round.sample_baked(at))
			var way := _round.sample_baked(at + 1.0) - places[-1]
			headings.append(atan2(way.x, way.z))
		else:
			_begin(person, places, headings)
	_crowd.styles = STYLES
	var ids := _crowd.add_agents(places, headings)
	for index: int in people.size():
		var person := people[index]
		person.id = ids[index]
		var style := index % (STYLES.size() + 1) - 1
		var weights := PackedFloat32Array()
		weights.resize(STYLES.size())
		if style >= 0 and person.doing != Doing.RUNS:
			weights[style] = 1.0
		_crowd.set_agent_style(person.id, weights)
		person.speed = _chance.randf_range(RUN_MPS.x, RUN_MPS.y) if person.doing == Doing.RUNS else (HURRIED_MPS if style == HURRIED else _chance.randf_range(1.0, 1.5))
		_crowd.set_speeds([0.0 if person.doing == Doing.STAYS else person.speed], [person.id])
		if person.doing == Doing.GOES:
			_crowd.set_destinations([person.spot.place], [person.id])


func _process(delta: float) -> void:
	_frame += 1
	# The host of a game with others walks the people of all.
	if people.is_empty() or _crowd.follows:
		return
	var places := _crowd.get_positions()
	var headings := _crowd.get_headings()
	for index: int in range(_frame % THINKS_EVERY, people.size(), THINKS_EVERY):
		_think(people[index], places[index], headings[index], THINKS_EVERY * delta)


## Puts a walker at its place, or on the way there.
func _begin(person: Person, places: PackedVector3Array, headings: PackedFloat32Array) -> void:
	person.spot = _spots.draw(_chance, Vector3.INF)
	person.spot.is_taken = true
	if _chance.randf() < STAYING and is_finite(person.spot.heading):
		person.doing = Doing.STAYS
		person.left_secs = _chance.randf_range(0.0, person.spot.stay.y)
		places.append(person.spot.place)
		headings.append(person.spot.heading)
		return
	var from := _spots.all[_chance.randi() % _spots.all.size()].place
	var path := NavigationServer3D.map_get_path(_crowd.get_world_3d().navigation_map, from, person.spot.place, true)
	var leg := _chance.randi_range(0, maxi(path.size() - 2, 0))
	var way := path[leg + 1] - path[leg] if path.size() > 1 else Vector3.ZERO
	places.append((path[leg] if path.size() > 0 else from) + way * _chance.randf())
	headings.append(atan2(way.x, way.z))


func _think(person: Person, place: Vector3, heading: float, secs: float) -> void:
	match person.doing:
		Doing.RUNS:
			var ahead := fposmod(_round.get_closest_offset(place) + AHEAD_M, _round.get_baked_length())
			_crowd.set_destinations([_round.sample_baked(ahead)], [person.id])
		Doing.GOES:
			_go(person, place, secs)
		Doing.ARRIVES:
			if _has_turned(person, heading, FACING, secs):
				person.doing = Doing.STAYS
				person.left_secs = _chance.randf_range(person.spot.stay.x, person.spot.stay.y)
		Doing.SETS_OUT:
			if _has_turned(person, heading, SETTING_OUT, secs):
				person.doing = Doing.GOES
				person.nearest = INF
				_crowd.set_speeds([person.speed], [person.id])
				_crowd.set_destinations([person.spot.place], [person.id])
		Doing.STAYS:
			person.left_secs -= secs
			if person.left_secs < 0.0:
				_leave(person, place)


func _go(person: Person, place: Vector3, secs: float) -> void:
	var far := place.distance_to(person.spot.place)
	if far < THERE_M:
		_turn(person, Doing.ARRIVES, person.spot.heading)
		return
	person.left_secs += secs
	if far < person.nearest - 0.4 or far > person.nearest + 2.0:
		person.nearest = far
		person.left_secs = 0.0
	elif person.left_secs > PATIENCE:
		_leave(person, place)


## Sends a walker to another place.
func _leave(person: Person, place: Vector3) -> void:
	var next := _spots.draw(_chance, place)
	if next == null:
		return
	person.spot.is_taken = false
	next.is_taken = true
	person.spot = next
	var path := NavigationServer3D.map_get_path(_crowd.get_world_3d().navigation_map, place, next.place, true)
	var way := path[1] - place if path.size() > 1 else next.place - place
	_turn(person, Doing.SETS_OUT, atan2(way.x, way.z))


## Turns on the spot: a walker that faces a wall would walk into it while turning.
func _turn(person: Person, doing: Doing, heading: float) -> void:
	person.doing = doing
	person.faces = heading
	person.left_secs = PATIENCE
	_crowd.set_speeds([0.0], [person.id])


func _has_turned(person: Person, heading: float, enough: float, secs: float) -> bool:
	person.left_secs -= secs
	var off := wrapf(person.faces - heading, -PI, PI)
	var turns := absf(off) > enough and person.left_secs > 0.0
	_crowd.set_turn_rates([clampf(2.0 * off, -TURNING, TURNING) if turns else 0.0], [person.id])
	return not turns
