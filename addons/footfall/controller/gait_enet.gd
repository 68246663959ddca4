class_name GaitEnet
extends Node
## ENet's part in the replication of walkers, below both synchronizers.
##
## ENet drops unreliable messages on purpose while replies take longer than usual. Long frames at either end look the same to it: while a game loads, or runs at 30
## frames a second, it may drop nearly all updates of walkers for ten seconds.

## Time between two measurements of the usual delay, milliseconds: ENet's default.
const INTERVAL_MSECS := 5000
## The most by which ENet raises the share of messages that it sends, 32 being all of them.
const RAISE := 32

## If [code]true[/code], ENet sends all unreliable messages of this machine, those of the game included. Otherwise it drops them while replies are late, and walkers lose their way.
@export var sends_all := true


func _ready() -> void:
	multiplayer.peer_connected.connect(_meet)
	for peer in multiplayer.get_peers():
		_meet(peer)


func _meet(peer: int) -> void:
	if sends_all:
		send_all(multiplayer, peer)


## Has a connection of this machine send all unreliable messages. Does nothing without ENet, and for a peer that is reached through the server.
static func send_all(api: MultiplayerAPI, peer: int) -> void:
	var network := api.multiplayer_peer
	# Engines that are built without ENet do not know the class.
	if network == null or not network.is_class("ENetMultiplayerPeer"):
		return
	if network.is_server_relay_supported() and not api.is_server() and peer != MultiplayerPeer.TARGET_PEER_SERVER:
		return
	var connection: PacketPeer = network.call(&"get_peer", peer)
	if connection != null:
		connection.call(&"throttle_configure", INTERVAL_MSECS, RAISE, 0)
