class_name GameClip
## Clips as games have them: a loop of two steps on the spot, 30 frames a second, on a rig with Mixamo's names, in centimetres, whose bones
## rest turned.

const RATE := 30.0
const CENTIMETRES := 100.0
const SKELETON := "Armature/Skeleton3D"
const NAMES: Dictionary[String, String] = {
	"Chest": "Spine1", "UpperChest": "Spine2", "UpperArm": "Arm", "LowerArm": "ForeArm",
	"UpperLeg": "UpLeg", "LowerLeg": "Leg", "Toes": "ToeBase",
}


## A loop of one stride; its metadata `speed` is how fast it would travel. Something of it is baked below `host`, which is in the tree.
static func loop(host: Node, speed: float) -> Animation:
	var walker := _walker()
	host.add_child(walker.build())
	walker.gait.variation = 0.0
	var baked := walker.gait.bake(0.9, ["neutral"], [speed]).get_animation("walk_neutral_%s" % speed)
	var frames := roundi(baked.length * RATE)
	var animation := Animation.new()
	animation.step = 1.0 / RATE
	animation.length = frames / RATE
	animation.loop_mode = Animation.LOOP_LINEAR
	animation.set_meta("speed", speed * baked.length / animation.length)
	for track: int in baked.get_track_count():
		var joint := String(baked.track_get_path(track).get_concatenated_subnames())
		var kind := baked.track_get_type(track)
		if joint.is_empty() or kind == Animation.TYPE_SCALE_3D:
			continue
		var copy := animation.add_track(kind)
		animation.track_set_path(copy, NodePath(SKELETON + ":" + bone(joint)))
		for frame: int in frames:
			var time := baked.length * frame / frames
			if kind == Animation.TYPE_ROTATION_3D:
				animation.rotation_track_insert_key(copy, frame / RATE, baked.rotation_track_interpolate(track, time))
			else:
				animation.position_track_insert_key(copy, frame / RATE, CENTIMETRES * baked.position_track_interpolate(track, time))
	walker.free()
	return animation


## A loop in which nobody moves.
static func still(animation: Animation) -> Animation:
	var copy: Animation = animation.duplicate()
	for track: int in copy.get_track_count():
		while copy.track_get_key_count(track) > 1:
			copy.track_remove_key(track, 1)
	return copy


## The character alone: its bones under an armature of 0.01, without an owner.
static func character() -> Node3D:
	var walker := _walker().build(false)
	var root := Node3D.new()
	root.name = "Hero"
	var armature := Node3D.new()
	armature.name = "Armature"
	armature.scale = Vector3.ONE / CENTIMETRES
	root.add_child(armature)
	var skeleton := Skeleton3D.new()
	skeleton.name = "Skeleton3D"
	for index: int in walker.skeleton.get_bone_count():
		skeleton.add_bone(bone(walker.skeleton.get_bone_name(index)))
		skeleton.set_bone_parent(index, walker.skeleton.get_bone_parent(index))
		var rest := walker.skeleton.get_bone_rest(index)
		skeleton.set_bone_rest(index, Transform3D(rest.basis, CENTIMETRES * rest.origin))
	skeleton.reset_bone_poses()
	armature.add_child(skeleton)
	walker.free()
	return root


## A character that comes with animations, as an importer makes it.
static func scene(animations: Dictionary) -> PackedScene:
	var root := character()
	var library := AnimationLibrary.new()
	for name: String in animations:
		library.add_animation(name, animations[name])
	var player := AnimationPlayer.new()
	player.add_animation_library("", library)
	root.add_child(player)
	return packed(root)


## Writes a character with its animations as glTF, with a mesh, or as FBX in text, as the file is named. Something of it is below `host`
## meanwhile, which is in the tree.
static func write_file(host: Node, animations: Dictionary, file: String) -> Error:
	var root := scene(animations).instantiate()
	host.add_child(root)
	var skeleton: Skeleton3D = root.get_node(SKELETON)
	var error := OK
	if file.ends_with(".fbx"):
		var written := FileAccess.open(file, FileAccess.WRITE)
		error = FileAccess.get_open_error()
		if written:
			written.store_string(FbxText.of(skeleton, animations))
			written.close()
	else:
		Skinned.clothe(skeleton, 0.03 * CENTIMETRES).owner = root
		var document := GLTFDocument.new()
		var state := GLTFState.new()
		error = document.append_from_scene(root, state)
		if error == OK:
			error = document.write_to_filesystem(state, ProjectSettings.globalize_path(file))
	root.free()
	return error


## Packs a scene and frees its root.
static func packed(root: Node) -> PackedScene:
	for node: Node in root.find_children("*", "", true, false):
		node.owner = root
	var made := PackedScene.new()
	made.pack(root)
	root.free()
	return made


## The name of a joint's bone.
static func bone(joint: String) -> String:
	for part: String in NAMES:
		if joint.ends_with(part) and joint in [part, "Left" + part, "Right" + part]:
			return "mixamorig_" + joint.trim_suffix(part) + NAMES[part]
	return "mixamorig_" + joint


static func _walker() -> Walker:
	var walker := Walker.new()
	var turn := 0.0
	for joint: String in Walker.BODY:
		walker.rest_rotations[joint] = Quaternion.from_euler(Vector3(0.3 * turn, -0.2 * turn, 1.0))
		turn += 1.0
	return walker
