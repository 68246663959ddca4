class_name GaitCrowdSynchronizer
extends Node
## Replicates a crowd to all peers of a multiplayer game: drop `crowd_synchronizer.tscn` below a [GaitCrowd3D].
##
## The peer with this node's multiplayer authority, by default the server, walks the crowd; the crowds of the others follow it and ignore their [code]count[/code]. It works with
## any [MultiplayerPeer]. The crowd must have the same path, model and styles on all peers.

## Emitted when a message of a peer without the authority is refused.
signal stranger_refused(peer: int)

## Time after which a crowd that has received no walkers asks again, seconds.
const ASK_SECS := 2.0
## Shortest time between two reports of refused messages, seconds.
const QUIET_SECS := 5.0

## Limit of the data that is sent to each peer. 100 bytes per second and walker repeat every step as often as a lossy network needs; with less, steps of walkers that go
## straight on are sent less often, and later steps walk off the error.
@export_range(1000, 1000000, 1000, "or_greater", "suffix:B/s") var bytes_per_second := 131072

var _crowd: GaitCrowd3D
var _asks_in := 0.0
var _quiet := 0.0
## This peer, and the peer that it follows.
var _known := Vector2i.ZERO


func _ready() -> void:
	_crowd = get_parent() as GaitCrowd3D
	set_process(_crowd != null)
	if _crowd == null:
		push_warning("%s: put it below a GaitCrowd3D." % get_path())
	elif OS.has_feature("dedicated_server"):
		# Without a viewer: no poses, no skeletons.
		_crowd.visible = false
	multiplayer.peer_disconnected.connect(_leave)


func _process(delta: float) -> void:
	_quiet -= delta
	var peer := multiplayer.multiplayer_peer
	if peer == null or peer.get_connection_status() != MultiplayerPeer.CONNECTION_CONNECTED:
		_known = Vector2i.ZERO
		return
	var known := Vector2i(multiplayer.get_unique_id(), get_multiplayer_authority())
	if known != _known:
		_known = known
		_asks_in = 0.0
		for follower in _crowd.get_told_peers():
			_crowd.forget_peer(follower)
		_crowd.follows = not is_multiplayer_authority()
	if _crowd.follows:
		_ask(delta)
	else:
		_send()


func _ask(delta: float) -> void:
	_asks_in -= delta
	if _asks_in <= 0.0 and _known.y in multiplayer.get_peers():
		_asks_in = ASK_SECS
		_join.rpc_id(_known.y)
	elif _crowd.is_introduced():
		_asks_in = ASK_SECS


func _send() -> void:
	for message in _crowd.take_messages(bytes_per_second):
		var peers: PackedInt32Array = [message.peer] if message.peer else _crowd.get_told_peers()
		for peer in peers:
			if message.reliable:
				_introduce.rpc_id(peer, message.bytes)
			else:
				_step.rpc_id(peer, message.bytes)


func _leave(peer: int) -> void:
	if _crowd != null:
		_crowd.forget_peer(peer)


## Called by a peer that begins to follow the crowd.
@rpc("any_peer", "call_remote", "reliable")
func _join() -> void:
	if _crowd != null and is_multiplayer_authority():
		_crowd.tell_peer(multiplayer.get_remote_sender_id())


# An empty message arrives without an argument.
@rpc("any_peer", "call_remote", "reliable")
func _introduce(message := PackedByteArray()) -> void:
	_hear(message)


@rpc("any_peer", "call_remote", "unreliable")
func _step(message := PackedByteArray()) -> void:
	_hear(message)


func _hear(message: PackedByteArray) -> void:
	var sender := multiplayer.get_remote_sender_id()
	if _crowd != null and sender == get_multiplayer_authority():
		_crowd.hear_message(message)
	elif _quiet <= 0.0:
		_quiet = QUIET_SECS
		push_warning("%s: a message of peer %d about the crowd was refused. Only the peer with the multiplayer authority of this node may send the crowd." % [get_path(), sender])
		stranger_refused.emit(sender)
