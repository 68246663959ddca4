class_name Wearer
extends Node3D
## A walker out of sight who wears a virtual sensor: for those who have none, and for checks.

## The sensor has measured: time in seconds, specific force in m/s², and angular rate in rad/s.
signal measured(time: float, force: Vector3, rate: Vector3)

const OUT_OF_SIGHT := Vector3(0, -60, 0)
## Arbitrary mounting: a sensor is never strapped on straight.
const WORN := Quaternion(0.2, 0.6, 0.3, 0.714143)
## Places of a sensor on a part of the body, metres from the joint in the T-pose: on a foot, and in a trousers' pocket.
const PLACES: Dictionary[String, Vector3] = {
	"RightFoot": Vector3(0.0, -0.01, 0.07),
	"RightUpperLeg": Vector3(-0.05, -0.2, 0.06),
}

var gait: GaitGenerator3D

var _imu := VirtualImu.new()
var _part: String
var _skeleton: Skeleton3D
var _bone := -1
var _delta := 0.0


## With the sensor on one of [constant PLACES].
func _init(part: String) -> void:
	_part = part


func _ready() -> void:
	var walker: Node3D = preload("res://scenes/shared/walker.tscn").instantiate()
	walker.position = OUT_OF_SIGHT
	walker.visible = false
	add_child(walker)
	gait = walker.get_node(^"%GaitGenerator3D")
	_skeleton = gait.get_skeleton()
	_bone = _skeleton.find_bone(_part)
	gait.modification_processed.connect(_measure)


func _process(delta: float) -> void:
	_delta = delta


func _measure() -> void:
	var sample := _imu.move_with(_skeleton, _bone, PLACES[_part], WORN.normalized(), _delta)
	if not sample.is_empty():
		measured.emit(sample[0], sample[1], sample[2])
