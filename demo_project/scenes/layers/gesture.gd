class_name Gesture
extends RefCounted
## Makes clips of what arms and trunk do: turns of joints against the T-pose, in the axes of the character, at moments.

var _animation := Animation.new()
var _skeleton: Skeleton3D
var _path: NodePath
## Joint → its track.
var _tracks: Dictionary[String, int] = {}


## For the skeleton as the player's root node finds it.
func _init(skeleton: Skeleton3D, path: NodePath, seconds: float) -> void:
	_skeleton = skeleton
	_path = path
	_animation.length = seconds
	_animation.loop_mode = Animation.LOOP_LINEAR


## Keys a joint's turn, in degrees about X (to its left), Y (up) and Z (ahead), applied in the order Z, Y, X.
func key(time: float, joint: String, degrees: Vector3) -> Gesture:
	if not _tracks.has(joint):
		var track := _animation.add_track(Animation.TYPE_ROTATION_3D)
		_animation.track_set_path(track, NodePath("%s:%s" % [_path, joint]))
		_animation.track_set_interpolation_type(track, Animation.INTERPOLATION_CUBIC)
		_tracks[joint] = track
	var bone := _skeleton.find_bone(joint)
	var rest := _skeleton.get_bone_rest(bone).basis.get_rotation_quaternion()
	var global_rest := _skeleton.get_bone_global_rest(bone).basis.get_rotation_quaternion()
	var turn := Quaternion(Basis.from_euler(degrees * PI / 180.0, EULER_ORDER_XYZ))
	_animation.rotation_track_insert_key(_tracks[joint], time, rest * (global_rest.inverse() * turn * global_rest))
	return self


## Has a player play it from now on.
func play_on(player: AnimationPlayer) -> void:
	var library := AnimationLibrary.new()
	library.add_animation(&"gesture", _animation)
	player.add_animation_library(&"", library)
	player.play(&"gesture")
