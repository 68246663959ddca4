class_name NetworkWorld
extends Node3D
## One machine's part of a multiplayer game: it hosts or joins, and has a character for each player, and a crowd that is the same everywhere.
##
## It has a multiplayer interface of its own, so that a scene may hold several: a host and its guests on one screen.

## News of hosting, joining and the others, for the player.
signal status_changed(text: String)
## This machine's own character has come.
signal came(player: GaitCharacter3D)
## The host has left, and the game has ended.
signal ended

const DEFAULT_PORT := 24_680
const PLAYER: PackedScene = preload("res://addons/footfall/controller/gait_character_3d.tscn")
const SYNCHRONIZER: PackedScene = preload("res://addons/footfall/controller/gait_synchronizer.tscn")
const MANNEQUIN: PackedScene = preload("res://characters/mannequin.glb")
const COLOURS: PackedColorArray = [Color(0.85, 0.36, 0.26), Color(0.24, 0.5, 0.76), Color(0.9, 0.7, 0.25), Color(0.36, 0.62, 0.4), Color(0.6, 0.42, 0.7)]
## Distance of the places at which players come.
const APART := 1.6
const MOST_GUESTS := 16

## If [code]true[/code], the own character has a camera and listens to the keyboard.
@export var played := true

var _count := 0

@onready var crowd: GaitCrowd3D = $Crowd
@onready var _players: Node3D = $Players
@onready var _spawner: MultiplayerSpawner = $Spawner


func _enter_tree() -> void:
	get_tree().set_multiplayer(MultiplayerAPI.create_default_interface(), get_path())


func _exit_tree() -> void:
	leave()
	get_tree().set_multiplayer(null, get_path())


func _ready() -> void:
	_spawner.spawn_function = _make
	multiplayer.peer_connected.connect(_come)
	multiplayer.peer_disconnected.connect(_go)
	multiplayer.connected_to_server.connect(func() -> void: status_changed.emit("Joined. WASD walks."))
	multiplayer.connection_failed.connect(func() -> void: status_changed.emit("No answer. Check that Host is pressed there and that UDP port %d is open." % DEFAULT_PORT))
	multiplayer.server_disconnected.connect(func() -> void:
		leave()
		status_changed.emit("The host has left. Host a game yourself, or join another.")
		# Its listeners may free this node, whose network is in the middle of a message.
		ended.emit.call_deferred())


## Opens a game for others to join. Returns whether it could.
func host(port := DEFAULT_PORT) -> bool:
	var peer := ENetMultiplayerPeer.new()
	if peer.create_server(port, MOST_GUESTS) != OK:
		status_changed.emit("Port %d is taken: this machine already hosts a game. Join 127.0.0.1." % port)
		return false
	multiplayer.multiplayer_peer = peer
	_come(1)
	status_changed.emit("Hosting. Others join %s." % _own_address())
	return true


## Joins a hosted game. Returns whether the connection was started.
func join(address: String, port := DEFAULT_PORT) -> bool:
	var peer := ENetMultiplayerPeer.new()
	if peer.create_client(address, port) != OK:
		status_changed.emit("\"%s\" is no address: write the host's, such as 192.168.0.7." % address)
		return false
	multiplayer.multiplayer_peer = peer
	status_changed.emit("Joining %s …" % address)
	return true


## Leaves the game. Characters go with it.
func leave() -> void:
	if multiplayer.multiplayer_peer is OfflineMultiplayerPeer:
		return
	multiplayer.multiplayer_peer.close()
	multiplayer.multiplayer_peer = OfflineMultiplayerPeer.new()
	for player: Node in _players.get_children():
		player.queue_free()


## The character of a peer; null while it is not there.
func player_of(peer: int) -> GaitCharacter3D:
	return _players.get_node_or_null(str(peer))


## This machine's own character; null while it is not there.
func own_player() -> GaitCharacter3D:
	return player_of(multiplayer.get_unique_id())


func _come(peer: int) -> void:
	if not multiplayer.is_server():
		return
	_spawner.spawn({"peer": peer, "place": Vector3(APART * (_count % 5), 0.05, -APART * (_count / 5)), "colour": COLOURS[_count % COLOURS.size()]})
	_count += 1
	if peer != 1:
		status_changed.emit("A guest has come.")


func _go(peer: int) -> void:
	var player := player_of(peer)
	if multiplayer.is_server() and player:
		player.queue_free()
		status_changed.emit("A guest has left.")


## Makes a character, on every machine alike. Whose it is walks it; on all others it makes the same steps.
func _make(data: Dictionary) -> Node:
	var player: GaitCharacter3D = PLAYER.instantiate()
	player.name = str(data.peer)
	player.position = data.place
	player.character_scene = MANNEQUIN
	# The crowd's people walk round it.
	player.add_to_group(crowd.avoided_group)
	player.add_child(SYNCHRONIZER.instantiate())
	# Of the character and all that is in it by now.
	player.set_multiplayer_authority(data.peer)
	player.player_controlled = played
	if data.peer == multiplayer.get_unique_id():
		var bodies := NearbyBodies.new()
		bodies.crowd = crowd
		bodies.player = player
		player.add_child(bodies)
	if not played:
		player.get_node(^"Camera").free()
		player.get_node(^"TouchStick").free()
	player.ready.connect(func() -> void:
		Paint.apply(player.gait.get_skeleton(), data.colour)
		player.gait.replica_refused.connect(func(reason: String) -> void: status_changed.emit(reason))
		if player == own_player():
			came.emit(player))
	return player


func _own_address() -> String:
	for address: String in IP.get_local_addresses():
		if address.begins_with("192.168.") or address.begins_with("10."):
			return address
	return "127.0.0.1"
