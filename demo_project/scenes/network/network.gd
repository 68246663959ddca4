extends Node3D
## Two machines, one crowd: host a game or join one; all characters take the same steps on both.
##
## Without a user the scene is both: a host who walks in circles, and beside it a guest's machine that shows the same people. Networks do not wait for frames: check it in real time.

const PORT_OF_CHECK := 24_681
## The guest's machine shows the host's character where it was so long ago at most, seconds, within so much, metres.
const BEHIND_SECS := 0.5
const OFF_ITS_WAY := 0.1
## Longest travel of the player in a frame, metres, even in a collision.
const IN_A_FRAME := 0.1
## Place of the guest's machine beside the host's.
const BESIDE := Vector3(26, 0, 0)
## Footsteps of the crowd are at the same place on both machines within this, metres, from so long after the guest has come, seconds.
const SAME_PLACE := 0.05
const JOINED_SECS := 2.0
## One of this many footsteps may be elsewhere: walkers whose steps come late are corrected.
const CORRECTED_OF := 20

var _guest: NetworkWorld
var _shown := 0
var _checked_secs := 0.0
var _before := Vector3.INF
## Places of the host's character in the last frames.
var _way := PackedVector3Array()
var _thrown := 0.0
## Footsteps of the host's crowd: walker and foot → places.
var _made: Dictionary[Vector2i, PackedVector3Array] = {}
## Footsteps that the guest's machine has shown of it, and how many of them the host's crowd has not made.
var _shown_of_crowd := 0
var _made_up := 0

@onready var _world: NetworkWorld = $World
@onready var _camera: Camera3D = $Stage/Camera


func _ready() -> void:
	_world.status_changed.connect(func(text: String) -> void: %Status.text = text)
	%Host.pressed.connect(func() -> void: _offer(not _world.host()))
	%Join.pressed.connect(func() -> void: _offer(not _world.join(%Address.text.strip_edges())))
	%Leave.pressed.connect(func() -> void:
		_world.leave()
		_camera.make_current()
		_offer(true))
	%Menu.pressed.connect(func() -> void: get_tree().change_scene_to_file("res://scenes/menu/menu.tscn"))
	_offer(true)
	if not OS.get_cmdline_user_args().is_empty() and has_node(^"Batch"):
		_be_both()


func _physics_process(delta: float) -> void:
	_checked_secs += delta
	if _guest == null or _world.own_player() == null:
		return
	var player := _world.own_player()
	if _before.is_finite():
		_thrown = maxf(_thrown, player.global_position.distance_to(_before))
	_before = player.global_position
	_way.append(player.position)
	if _way.size() > BEHIND_SECS / delta:
		_way.remove_at(0)
	player.autopilot = player.global_basis.z.rotated(Vector3.UP, 0.2)
	_camera.target_position = player.global_position + Vector3.UP * 0.8


func close_ups() -> Dictionary[String, Array]:
	var at := _world.own_player().global_position + Vector3.UP * 0.9
	return {
		"both": [0.5 * BESIDE, 0.0, 32.0, 40.0],
		"host": [at, 10.0, 14.0, 9.0],
		"guest": [at + BESIDE, 10.0, 14.0, 9.0],
	}


func begin_check() -> void:
	_checked_secs = 0.0


func problems(_frames: int) -> PackedStringArray:
	var found := PackedStringArray()
	var here := _world.player_of(1)
	var there := _guest.player_of(1)
	if here == null or there == null:
		return ["the guest's machine has no character of the host's"]
	var off := INF
	for place: Vector3 in _way:
		off = minf(off, place.distance_to(there.position))
	if off > OFF_ITS_WAY:
		found.append("the guest's machine shows the host's character %.2f m from where it was in the last %.1f s" % [off, BEHIND_SECS])
	if _shown < _checked_secs - 2.0:
		found.append("the guest's machine has shown %d of its footsteps in %.1f s" % [_shown, _checked_secs])
	if _thrown > IN_A_FRAME:
		found.append("the host's character was thrown by %.2f m" % _thrown)
	var people := _people_of(_world)
	if people.is_empty() or people != _people_of(_guest):
		found.append("the guest's machine has other people than the host: %s, not %s" % [_people_of(_guest), people])
	if _made_up * CORRECTED_OF > _shown_of_crowd or _shown_of_crowd < people.size() * (_checked_secs - JOINED_SECS - 1.0):
		found.append("of %d footsteps that the guest's machine has shown of %d people, %d were never made" % [_shown_of_crowd, people.size(), _made_up])
	return found


func is_getting_ready() -> bool:
	if _guest == null:
		return false
	var making := _world.crowd.is_making() or _guest.crowd.is_making()
	return making or _guest.player_of(1) == null or _guest.crowd.get_agents().size() < _world.crowd.count


## A host and a guest beside it, neither with a player.
func _be_both() -> void:
	_guest = (load("res://scenes/network/world.tscn") as PackedScene).instantiate()
	_guest.name = "Guest"
	_guest.position = BESIDE
	_guest.played = false
	_world.played = false
	add_child(_guest)
	($Guest/Players as Node).child_entered_tree.connect(func(player: Node) -> void:
		player.ready.connect(func() -> void:
			if player.name == "1":
				(player as GaitCharacter3D).gait.footstep.connect(func(_foot: StringName, _at: Vector3) -> void: _shown += 1)))
	_world.crowd.footsteps.connect(_keep)
	_guest.crowd.footsteps.connect(_compare)
	_camera.make_current()
	if _world.host(PORT_OF_CHECK) and _guest.join("127.0.0.1", PORT_OF_CHECK):
		_offer(false)


## Ids of a machine's people, in order.
func _people_of(machine: NetworkWorld) -> PackedInt32Array:
	var people := machine.crowd.get_agents()
	people.sort()
	return people


func _keep(people: PackedInt32Array, feet: PackedByteArray, places: PackedVector3Array) -> void:
	for index: int in people.size():
		var key := Vector2i(people[index], feet[index])
		var before: PackedVector3Array = _made.get_or_add(key, PackedVector3Array())
		before.append(places[index])
		_made[key] = before


func _compare(people: PackedInt32Array, feet: PackedByteArray, places: PackedVector3Array) -> void:
	if _checked_secs < JOINED_SECS:
		return
	for index: int in people.size():
		_shown_of_crowd += 1
		var place := places[index] - BESIDE
		var made: PackedVector3Array = _made.get(Vector2i(people[index], feet[index]), PackedVector3Array())
		_made_up += int(not Array(made).any(func(other: Vector3) -> bool: return other.distance_to(place) < SAME_PLACE))


func _offer(free: bool) -> void:
	%Host.visible = free
	%Join.visible = free
	%Address.visible = free
	%Leave.visible = not free
