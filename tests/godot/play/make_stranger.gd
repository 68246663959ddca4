extends SceneTree
## Makes `tests/newcomer/project/stranger.glb`: a character as a game has it, with bones named as Godot names those of Mixamo, and turned as they are, and a clip in which it waves.
##
## godot --headless --path tests/godot --script res://play/make_stranger.gd

const OUT := "res://../newcomer/project/stranger.glb"
const NAMES: Dictionary[String, String] = {
	"Hips": "Hips", "Spine": "Spine", "Chest": "Spine1", "UpperChest": "Spine2", "Neck": "Neck", "Head": "Head",
	"LeftShoulder": "LeftShoulder", "LeftUpperArm": "LeftArm", "LeftLowerArm": "LeftForeArm", "LeftHand": "LeftHand",
	"RightShoulder": "RightShoulder", "RightUpperArm": "RightArm", "RightLowerArm": "RightForeArm", "RightHand": "RightHand",
	"LeftUpperLeg": "LeftUpLeg", "LeftLowerLeg": "LeftLeg", "LeftFoot": "LeftFoot", "LeftToes": "LeftToeBase",
	"RightUpperLeg": "RightUpLeg", "RightLowerLeg": "RightLeg", "RightFoot": "RightFoot", "RightToes": "RightToeBase",
}


func _init() -> void:
	var walker := Walker.new()
	for joint: String in Walker.BODY:
		walker.rest_rotations[joint] = _along(joint)
	var root: Node3D = Skinned.packed(walker).instantiate()
	root.name = "Stranger"
	var skeleton: Skeleton3D = root.find_children("*", "Skeleton3D", true, false)[0]
	skeleton.name = "Skeleton3D"
	for joint: String in NAMES:
		skeleton.set_bone_name(skeleton.find_bone(joint), "mixamorig_" + NAMES[joint])
	var player := AnimationPlayer.new()
	player.name = "AnimationPlayer"
	root.add_child(player)
	player.owner = root
	var library := AnimationLibrary.new()
	library.add_animation(&"wave", Rigs.wave(skeleton, "mixamorig_RightArm", "mixamorig_RightForeArm"))
	player.add_animation_library(&"", library)
	get_root().add_child(root)
	var document := GLTFDocument.new()
	var state := GLTFState.new()
	var error := document.append_from_scene(root, state)
	if error == OK:
		error = document.write_to_filesystem(state, ProjectSettings.globalize_path(OUT))
	root.free()
	quit(error)


## Global rest of a bone whose Y axis points to the joint that follows.
func _along(joint: String) -> Quaternion:
	for child: String in Walker.BODY:
		if Walker.BODY[child][0] == joint and not child.ends_with("Shoulder") and not child.ends_with("UpperLeg"):
			return Quaternion(Vector3.UP, (Walker.BODY[child][1] - Walker.BODY[joint][1]).normalized())
	return _along(Walker.BODY[joint][0])
