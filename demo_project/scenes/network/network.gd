extends Node3D
## Two machines, one crowd: host a game or join one, and everybody makes the same steps everywhere.
##
## Without a user the scene is both: a host who walks in circles, and beside it a guest's machine that shows the same.

const PORT_OF_CHECK := 24_681
## The guest's machine shows the host's character so far behind at most, metres: as far as it walks until that is heard of.
const BEHIND := 0.6

var _guest: NetworkWorld
var _shown := 0

@onready var _world: NetworkWorld = $World
@onready var _camera: Camera3D = $Stage/Camera


func _ready() -> void:
	_world.told.connect(func(text: String) -> void: %Told.text = text)
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


func _physics_process(_delta: float) -> void:
	if _guest == null or _world.own_player() == null:
		return
	var player := _world.own_player()
	player.autopilot = player.global_basis.z.rotated(Vector3.UP, 0.2)
	_camera.target_position = player.global_position + Vector3(2.0, 0.8, 0.0)


func close_ups() -> Dictionary[String, Array]:
	var at := _world.own_player().global_position + Vector3.UP * 0.9
	return {
		"both": [at + Vector3.RIGHT * 2.0, 10.0, 14.0, 6.0],
		"side": [at, 90.0, 6.0, 3.4],
	}


func begin_check() -> void:
	pass


func problems(frames: int) -> PackedStringArray:
	var found := PackedStringArray()
	var here := _world.player_of(1)
	var there := _guest.player_of(1)
	if here == null or there == null:
		return ["the guest's machine has no character of the host's"]
	var behind := here.position.distance_to(there.position)
	if behind > BEHIND:
		found.append("the host's character is %.2f m from where the guest's machine shows it" % behind)
	if _shown < frames / 60.0 - 2.0:
		found.append("the guest's machine has shown %d of its footsteps in %d frames" % [_shown, frames])
	return found


func is_getting_ready() -> bool:
	return _guest != null and _guest.player_of(1) == null


## A host and a guest beside it, neither with a player.
func _be_both() -> void:
	_guest = (load("res://scenes/network/world.tscn") as PackedScene).instantiate()
	_guest.name = "Guest"
	_guest.position.x = 4.0
	_guest.played = false
	_world.played = false
	add_child(_guest)
	($Guest/Players as Node).child_entered_tree.connect(func(player: Node) -> void:
		player.ready.connect(func() -> void:
			if player.name == "1":
				(player as GaitCharacter3D).gait.footstep.connect(func(_foot: StringName, _at: Vector3) -> void: _shown += 1)))
	_camera.make_current()
	if _world.host(PORT_OF_CHECK) and _guest.join("127.0.0.1", PORT_OF_CHECK):
		_offer(false)


func _offer(free: bool) -> void:
	%Host.visible = free
	%Join.visible = free
	%Address.visible = free
	%Leave.visible = not free
