extends Node3D
## One machine of a multiplayer game: hosts or joins, walks a character of its own, and shows those of the others.
##
## After `--`: `--host PORT` or `--join PORT`, `--name NAME`, `--secs SECONDS`, and `--lies` for a peer who does. It prints every footstep: `MADE` for its own
## character, `SHOWN` for those of others, with the character's name, the foot, its place and the seconds since the character came. The host also walks a crowd,
## whose members are called `crowd_` and their id. Frames in which the machine stood still are printed as `PAUSED` and their length in seconds.

## Before it leaves, a peer's character comes to rest.
const REST_SECS := 2.5
## Shortest pause of the machine, and the time of the crowd before which it still loads, seconds. The engine's own delta is limited and shows no pause.
const PAUSE_SECS := 0.25
const LOADS_SECS := 1.0

var _arguments := OS.get_cmdline_user_args()
var _name := ""
var _left := 0.0
var _count := 0
var _frame_msecs := 0

@onready var _spawner := MultiplayerSpawner.new()
@onready var _walkers := Node3D.new()
@onready var _crowd := NetCrowd.new()


func _ready() -> void:
	_name = _value("--name")
	_left = _value("--secs").to_float()
	# Liars flood as well: their frames come as fast as they can.
	Engine.max_fps = 0 if _lies() else 60
	_walkers.name = "Walkers"
	add_child(_walkers)
	_spawner.name = "Spawner"
	_spawner.spawn_function = _make
	add_child(_spawner)
	_spawner.spawn_path = ^"../Walkers"
	_crowd.name = "Crowd"
	_crowd.lies = _lies()
	_crowd.make(_arguments.has("--host"))
	add_child(_crowd)
	var peer := ENetMultiplayerPeer.new()
	if _arguments.has("--host"):
		var failed := peer.create_server(_value("--host").to_int())
		if failed:
			print("NO HOST %s" % error_string(failed))
			get_tree().quit(3)
			return
		multiplayer.multiplayer_peer = peer
		multiplayer.peer_connected.connect(func(_id: int) -> void: print("PEER"))
		multiplayer.peer_disconnected.connect(_leave)
		_come(_name)
	else:
		peer.create_client("127.0.0.1", _value("--join").to_int())
		multiplayer.multiplayer_peer = peer
		multiplayer.connected_to_server.connect(func() -> void: _come.rpc_id(1, _name))
		multiplayer.server_disconnected.connect(func() -> void: print("HOST LEFT"))


func _process(delta: float) -> void:
	_notice_pause()
	_left -= delta
	for walker: NetWalker in _walkers.get_children():
		walker.rests = _left < REST_SECS
	if _left <= 0.0:
		for walker: NetWalker in _walkers.get_children():
			print("END %s hips %.2f far %.2f secs %.2f" % [walker.title, walker.fastest, walker.farthest, walker.secs])
		print("END crowd hips %.2f far 0 secs %.2f" % [_crowd.fastest, _crowd.secs])
		_crowd.process_mode = Node.PROCESS_MODE_DISABLED
		_walkers.process_mode = Node.PROCESS_MODE_DISABLED
		multiplayer.multiplayer_peer.close()
		get_tree().quit()
		set_process(false)


func _notice_pause() -> void:
	var now_msecs := Time.get_ticks_msec()
	var passed_secs := 0.001 * (now_msecs - _frame_msecs)
	_frame_msecs = now_msecs
	if _crowd.secs > LOADS_SECS and passed_secs > PAUSE_SECS:
		print("PAUSED %.3f" % passed_secs)


## A peer has joined and gets a character.
@rpc("any_peer", "call_remote", "reliable")
func _come(title: String) -> void:
	var id := multiplayer.get_remote_sender_id()
	_spawner.spawn({"title": title, "peer": id if id else 1, "index": _count})
	_count += 1


func _leave(id: int) -> void:
	for walker: NetWalker in _walkers.get_children():
		if walker.get_multiplayer_authority() == id:
			walker.queue_free()


func _make(data: Dictionary) -> Node:
	var walker := NetWalker.new()
	walker.name = data.title
	walker.title = data.title
	walker.lies = _lies()
	walker.position = Vector3(3.0 * int(data.index), 0.0, 0.0)
	walker.make(0.0 if walker.lies else 1.0 / 30.0)
	walker.set_multiplayer_authority(data.peer)
	return walker


func _lies() -> bool:
	return _arguments.has("--lies")


func _value(flag: String) -> String:
	var at := _arguments.find(flag)
	return _arguments[at + 1] if at >= 0 else ""
