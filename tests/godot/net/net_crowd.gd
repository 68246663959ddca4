class_name NetCrowd
extends Node
## A crowd of a multiplayer game: the host walks it, all others show the same.

const SYNCHRONIZER: PackedScene = preload("res://addons/footfall/controller/crowd_synchronizer.tscn")
## Walkers of the host. Guests would have more of their own.
const WALKERS := 12
## Time between two looks at how far they have come, seconds: who is far away moves once in four frames.
const EACH_SECS := 0.25

var lies := false
## Time since the crowd is known, seconds, and the fastest that anybody went, m/s.
var secs := 0.0
var fastest := 0.0

var _crowd := GaitCrowd3D.new()
var _synchronizer: Node
var _before: Dictionary[int, Vector3] = {}
var _since := 0.0


func make(hosts: bool) -> void:
	_crowd.model = load(Walker.MODEL)
	_crowd.character = Skinned.scene()
	_crowd.count = WALKERS if hosts else 3 * WALKERS
	_crowd.area = Vector2(24, 24)
	_crowd.position = Vector3(-30, 0, 10)
	_crowd.footsteps.connect(_tell)
	_crowd.message_refused.connect(func(reason: String) -> void: print("REFUSED crowd %s" % reason))
	_synchronizer = SYNCHRONIZER.instantiate()
	_crowd.add_child(_synchronizer)
	_crowd.name = "Walkers"
	add_child(_crowd)
	_synchronizer.stranger_refused.connect(func(peer: int) -> void: print("STRANGER %d" % peer))


func _process(delta: float) -> void:
	if not _crowd.follows or _crowd.is_introduced():
		secs += delta
	_measure(delta)
	if lies and secs > 1.0:
		var noise := PackedByteArray()
		for at: int in randi() % 60:
			noise.append(randi() % 256)
		for peer: int in multiplayer.get_peers():
			# The server passes it on to those who are not its own neighbours.
			_synchronizer._step.rpc_id(peer, noise)


func _tell(agents: PackedInt32Array, feet: PackedByteArray, places: PackedVector3Array) -> void:
	var made := "SHOWN" if _crowd.follows else "MADE"
	for index: int in agents.size():
		var foot := Walker.FEET[feet[index]]
		var place := places[index]
		print("%s crowd_%d %s %.4f %.4f %.3f" % [made, agents[index], foot, place.x, place.z, secs])


func _measure(delta: float) -> void:
	_since += delta
	if _since < EACH_SECS:
		return
	var now: Dictionary[int, Vector3] = {}
	var agents := _crowd.get_agents()
	var places := _crowd.get_positions()
	for index: int in agents.size():
		now[agents[index]] = places[index]
	if secs > 2.0:
		for agent: int in now:
			if _before.has(agent):
				fastest = maxf(fastest, now[agent].distance_to(_before[agent]) / _since)
	_before = now
	_since = 0.0
