class_name StandIn
extends Node3D
## A walker out of sight whose sensor on the right foot sends lines of numbers to this machine's own UDP port: for those who have no sensor.

var port := 0

var _socket := PacketPeerUDP.new()
var _wearer := Wearer.new("RightFoot")


func _ready() -> void:
	_socket.connect_to_host("127.0.0.1", port)
	add_child(_wearer)
	_wearer.gait.speed = 1.3
	_wearer.measured.connect(_send)


func _send(time: float, force: Vector3, rate: Vector3) -> void:
	var line := "%.3f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f" % [time * 1000.0, force.x, force.y, force.z, rate.x, rate.y, rate.z]
	_socket.put_packet(line.to_utf8_buffer())
