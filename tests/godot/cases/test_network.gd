extends TestCase
## Messages between machines: ENet, which drops unreliable ones while replies are late, sends all those of walkers.

const PORT := 24_683
const CROWD_SYNCHRONIZER := "res://addons/footfall/controller/crowd_synchronizer.tscn"
const SYNCHRONIZER := "res://addons/footfall/controller/gait_synchronizer.tscn"


func test_enet_sends_all_messages_of_a_crowd() -> void:
	await _check_connections(func(sends_all: bool) -> Node:
		var crowd := GaitCrowd3D.new()
		crowd.name = "Crowd"
		crowd.model = preload("res://addons/footfall/models/locomotion.footfall")
		crowd.character = Skinned.scene()
		crowd.count = 1
		crowd.add_child(_synchronizer(CROWD_SYNCHRONIZER, sends_all))
		return crowd, false)


func test_enet_sends_all_messages_of_a_walker() -> void:
	await _check_connections(func(sends_all: bool) -> Node:
		var generator := GaitGenerator3D.new()
		generator.name = "Generator"
		generator.add_child(_synchronizer(SYNCHRONIZER, sends_all))
		return generator, true)


func test_other_networks_are_left_alone() -> void:
	var api := MultiplayerAPI.create_default_interface()
	GaitEnet.send_all(api, 1)
	var web := WebSocketMultiplayerPeer.new()
	check_equal(web.create_server(PORT), OK, "a server")
	api.multiplayer_peer = web
	GaitEnet.send_all(api, 1)
	check_equal(web.get_connection_status(), MultiplayerPeer.CONNECTION_CONNECTED, "the network")
	web.close()


## The host gets its walkers before the guest comes, or later.
func _check_connections(made: Callable, later: bool) -> void:
	for sends_all: bool in [true, false]:
		var host := _machine("Host")
		var server := ENetMultiplayerPeer.new()
		check_equal(server.create_server(PORT), OK, "a server")
		host.multiplayer.multiplayer_peer = server
		var guest := _machine("Guest")
		var walkers: Array[Node] = [made.call(sends_all), made.call(sends_all)]
		guest.add_child(walkers[0])
		if not later:
			host.add_child(walkers[1])
		var client := ENetMultiplayerPeer.new()
		client.create_client("127.0.0.1", PORT)
		guest.multiplayer.multiplayer_peer = client
		check(await until(func() -> bool: return not guest.multiplayer.get_peers().is_empty() and not host.multiplayer.get_peers().is_empty()), "nobody came")
		if later:
			host.add_child(walkers[1])
		var of_host := server.get_peer(guest.multiplayer.get_unique_id())
		var of_guest := client.get_peer(1)
		if sends_all:
			check_equal(_drop(of_host), 0, "messages that the host leaves out")
			check_equal(_drop(of_guest), 0, "messages that the guest leaves out")
		else:
			check(_drop(of_host) > 0 and _drop(of_guest) > 0, "ENet was set up, although it was not to be")
		for machine: Node in [host, guest]:
			machine.multiplayer.multiplayer_peer.close()
			var path := machine.get_path()
			machine.free()
			get_tree().set_multiplayer(null, path)


## Rate at which a connection lowers the share of unreliable messages that it sends.
func _drop(connection: ENetPacketPeer) -> int:
	return int(connection.get_statistic(ENetPacketPeer.PEER_PACKET_THROTTLE_DECELERATION))


func _machine(title: String) -> Node:
	var machine := Node.new()
	machine.name = title
	add_child(machine)
	get_tree().set_multiplayer(MultiplayerAPI.create_default_interface(), machine.get_path())
	return machine


func _synchronizer(path: String, sends_all: bool) -> Node:
	var synchronizer: Node = (load(path) as PackedScene).instantiate()
	synchronizer.get_node(^"Enet").set(&"sends_all", sends_all)
	return synchronizer
