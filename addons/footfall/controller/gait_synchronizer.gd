class_name GaitSynchronizer
extends MultiplayerSynchronizer
## Replicates a walker to all peers of a multiplayer game: drop `gait_synchronizer.tscn` below a [GaitGenerator3D] or a [GaitCharacter3D].
##
## The peer with the multiplayer authority of the node that travels walks it; on all others it makes the same steps. It works with any [MultiplayerPeer].

## If [code]true[/code], ENet sends all unreliable messages of this machine, those of the game included. Otherwise it drops them while replies are late, and walkers lose their way.
@export var sends_all := true


func _ready() -> void:
	multiplayer.peer_connected.connect(_meet)
	for peer in multiplayer.get_peers():
		_meet(peer)


func _meet(peer: int) -> void:
	if sends_all:
		GaitEnet.send_all(multiplayer, peer)
