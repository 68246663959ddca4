class_name StandIn
extends Node3D
## A walker out of sight, with a virtual sensor on the right foot that sends lines of numbers to this machine's own UDP port: for those who have no sensor.

## Worn anyhow: nobody ties a sensor on straight.
const WORN := Quaternion(0.2, 0.6, 0.3, 0.714143)

var port := 0

var _socket := PacketPeerUDP.new()
var _imu := VirtualImu.new()
var _skeleton: Skeleton3D
var _foot := -1
var _delta := 0.0


func _ready() -> void:
	_socket.connect_to_host("127.0.0.1", port)
	var walker: Node3D = preload("res://scenes/shared/walker.tscn").instantiate()
	walker.position.y = -50.0
	walker.visible = false
	add_child(walker)
	var gait: GaitGenerator3D = walker.get_node(^"%GaitGenerator3D")
	gait.speed = 1.3
	_skeleton = gait.get_skeleton()
	_foot = _skeleton.find_bone("RightFoot")
	gait.modification_processed.connect(_measure)


func _process(delta: float) -> void:
	_delta = delta


func _measure() -> void:
	var sample := _imu.move_with_foot(_skeleton, _foot, _delta, WORN.normalized())
	if sample.is_empty():
		return
	var force: Vector3 = sample[1]
	var rate: Vector3 = sample[2]
	var line := "%.3f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f" % [sample[0] * 1000.0, force.x, force.y, force.z, rate.x, rate.y, rate.z]
	_socket.put_packet(line.to_utf8_buffer())
