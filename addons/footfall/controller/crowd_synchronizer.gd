class_name GaitCrowdSynchronizer
extends Node
## A crowd that one peer of a multiplayer game walks is shown by all others: drop `crowd_synchronizer.tscn` below a [GaitCrowd3D].
##
## The peer with this node's multiplayer authority, the server if you set none, walks the crowd; the others' follows it, whatever their [code]count[/code] says. It works with
## any [MultiplayerPeer]. The crowd has to have the same path, model and styles on all peers.

## A peer without the authority has told of the crowd, and is not believed.
signal stranger_refused(peer: int)

## Time after which a crowd that has heard of nobody asks again, seconds.
const ASK_SECS := 2.0
## Strangers are told of no more often, seconds.
const QUIET_SECS := 5.0

## The bytes that are sent to each peer in a second at most. 100 a walker tell every step as often as a lossy network needs; with fewer, walkers who go straight on
## are told of less often, and what is off is walked off.
@export_range(1000, 1000000, 1000, "or_greater", "suffix:B/s") var bytes_per_second := 131072

var _crowd: GaitCrowd3D
var _asks_in := 0.0
var _quiet := 0.0
## The peer that this one is, and whom it follows.
var _known := Vector2i.ZERO


func _ready() -> void:
	_crowd = get_parent() as GaitCrowd3D
	set_process(_crowd != null)
	if _crowd == null:
		push_warning("%s: put it below a GaitCrowd3D." % get_path())
	elif OS.has_feature("dedicated_server"):
		# Nobody looks: no poses, no skeletons.
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
		for told in _crowd.get_told_peers():
			_crowd.forget_peer(told)
		_crowd.follows = not is_multiplayer_authority()
	if _crowd.follows:
		_ask(delta)
	else:
		_tell()


func _ask(delta: float) -> void:
	_asks_in -= delta
	if _asks_in <= 0.0 and _known.y in multiplayer.get_peers():
		_asks_in = ASK_SECS
		_join.rpc_id(_known.y)
	elif _crowd.is_introduced():
		_asks_in = ASK_SECS


func _tell() -> void:
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


## A peer shows the crowd from now on.
@rpc("any_peer", "call_remote", "reliable")
func _join() -> void:
	if _crowd != null and is_multiplayer_authority():
		_crowd.tell_peer(multiplayer.get_remote_sender_id())


# A message of no bytes comes without an argument.
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
		push_warning("%s: peer %d tells of a crowd that is not its own; only the peer with the multiplayer authority of this node does." % [get_path(), sender])
		stranger_refused.emit(sender)
