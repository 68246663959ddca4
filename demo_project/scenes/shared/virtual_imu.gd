class_name VirtualImu
extends RefCounted
## A simulated inertial sensor in the game's world, from its position and orientation in each frame.

const GRAVITY_MPS2 := 9.80665

var _places: Array[Vector3] = []
var _turns: Array[Quaternion] = []
var _time := 0.0


## Takes a frame of a bone that wears the sensor at a place, metres from the joint in the T-pose, turned so against it, and gives what `move` gives.
func move_with(skeleton: Skeleton3D, bone: int, place: Vector3, worn: Quaternion, delta: float) -> Array:
	var now := skeleton.global_transform * skeleton.get_bone_global_pose(bone)
	# Turned as in the T-pose, the sensor's axes are the body's.
	var turn := (now.basis * skeleton.get_bone_global_rest(bone).basis.inverse()).get_rotation_quaternion()
	return move(now.origin + turn * place, turn * worn, delta)


## Takes where the sensor is now, and gives what it measured a frame ago, [time, specific force, angular rate], or nothing at first.
func move(place: Vector3, turn: Quaternion, delta: float) -> Array:
	_time += delta
	_places.append(place)
	_turns.append(turn)
	if _places.size() > 3:
		_places.remove_at(0)
		_turns.remove_at(0)
	if _places.size() < 3 or delta <= 0.0:
		return []
	var acceleration := (_places[2] - 2.0 * _places[1] + _places[0]) / (delta * delta)
	var force := _turns[1].inverse() * (acceleration + Vector3.UP * GRAVITY_MPS2)
	var turned := _turns[0].inverse() * _turns[2]
	if turned.w < 0.0:
		turned = -turned
	var rate := turned.get_axis() * turned.get_angle() / (2.0 * delta) if turned.get_angle() > 1e-6 else Vector3.ZERO
	return [_time - delta, force, rate]
