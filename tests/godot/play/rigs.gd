class_name Rigs
## Characters of three rigs, as importers leave them, and a clip for them.

const WAVE_SECS := 1.2
const WAVE_KEYS := 8


static func adult() -> PackedScene:
	return Skinned.scene()


static func child() -> PackedScene:
	return _scaled(Skinned.scene(["Chest", "UpperChest", "LeftToes", "RightToes"]), 0.65)


## Bones are in centimetres, under a node that makes metres of them.
static func in_centimetres() -> PackedScene:
	var walker := Walker.new()
	for joint: String in Walker.BODY:
		walker.rest_places[joint] = Walker.BODY[joint][1] * 100.0
	return _scaled(Skinned.packed(walker), 0.01)


## A clip on a skeleton named `Skeleton3D` below the player's root: the right arm is up, the forearm goes to and fro.
static func wave(skeleton: Skeleton3D, upper: String, lower: String) -> Animation:
	var wave := Animation.new()
	wave.length = WAVE_SECS
	wave.loop_mode = Animation.LOOP_LINEAR
	for part: Array in [[upper, Vector3(0, 0, -1.1), Vector3.ZERO], [lower, Vector3(0, 0, -0.6), Vector3(0, 0, 0.5)]]:
		var bone := skeleton.find_bone(part[0])
		var track := wave.add_track(Animation.TYPE_ROTATION_3D)
		wave.track_set_path(track, NodePath("Skeleton3D:" + part[0]))
		var rest := skeleton.get_bone_rest(bone).basis.get_rotation_quaternion()
		var above := skeleton.get_bone_global_rest(skeleton.get_bone_parent(bone)).basis.get_rotation_quaternion()
		for key: int in WAVE_KEYS + 1:
			var share := float(key) / WAVE_KEYS
			var turn := Quaternion.from_euler(part[1] + part[2] * sin(TAU * share))
			wave.rotation_track_insert_key(track, WAVE_SECS * share, above.inverse() * turn * above * rest)
	return wave


static func _scaled(scene: PackedScene, size: float) -> PackedScene:
	var root: Node3D = scene.instantiate()
	var skeleton: Node3D = root.get_child(0)
	skeleton.scale = Vector3.ONE * size
	var scaled := PackedScene.new()
	scaled.pack(root)
	root.free()
	return scaled
