class_name Walker
extends Node3D
## A character for tests: the canonical body on a Skeleton3D built in code, walked by a GaitGenerator3D, with time under control.

## Joint → parent and place in the T-pose, metres: the standard body, parents first.
const BODY := {
	"Hips": ["", Vector3(0, 0.985, 0)],
	"Spine": ["Hips", Vector3(0, 1.075, 0)],
	"Chest": ["Spine", Vector3(0, 1.195, 0)],
	"UpperChest": ["Chest", Vector3(0, 1.315, 0)],
	"Neck": ["UpperChest", Vector3(0, 1.485, 0)],
	"Head": ["Neck", Vector3(0, 1.585, 0)],
	"LeftShoulder": ["UpperChest", Vector3(0.03, 1.435, 0)],
	"LeftUpperArm": ["LeftShoulder", Vector3(0.17, 1.435, 0)],
	"LeftLowerArm": ["LeftUpperArm", Vector3(0.45, 1.435, 0)],
	"LeftHand": ["LeftLowerArm", Vector3(0.7, 1.435, 0)],
	"RightShoulder": ["UpperChest", Vector3(-0.03, 1.435, 0)],
	"RightUpperArm": ["RightShoulder", Vector3(-0.17, 1.435, 0)],
	"RightLowerArm": ["RightUpperArm", Vector3(-0.45, 1.435, 0)],
	"RightHand": ["RightLowerArm", Vector3(-0.7, 1.435, 0)],
	"LeftUpperLeg": ["Hips", Vector3(0.09, 0.925, 0)],
	"LeftLowerLeg": ["LeftUpperLeg", Vector3(0.09, 0.505, 0)],
	"LeftFoot": ["LeftLowerLeg", Vector3(0.09, 0.085, 0)],
	"LeftToes": ["LeftFoot", Vector3(0.09, 0.02, 0.135)],
	"RightUpperLeg": ["Hips", Vector3(-0.09, 0.925, 0)],
	"RightLowerLeg": ["RightUpperLeg", Vector3(-0.09, 0.505, 0)],
	"RightFoot": ["RightLowerLeg", Vector3(-0.09, 0.085, 0)],
	"RightToes": ["RightFoot", Vector3(-0.09, 0.02, 0.135)],
}
const FEET: Array[StringName] = [&"left", &"right"]
const MODEL := "res://addons/footfall/models/locomotion.footfall"

## Parts of the body that are left out. Set before `build()`.
var missing: PackedStringArray = []
## Joint → global rest rotation of its bone. Bones without an entry rest parallel to the model.
var rest_rotations: Dictionary[String, Quaternion] = {}
## Joint → place in the rest pose, where it is not the standard body's.
var rest_places: Dictionary[String, Vector3] = {}
## Prefix of all bone names, so that they are not the profile's.
var prefix := ""
## Joint → name of its bone, where it is neither the profile's nor that with the prefix.
var names: Dictionary[String, String] = {}
## Joint → name of a bone put between it and its parent.
var between: Dictionary[String, String] = {}

var skeleton := Skeleton3D.new()
var gait := GaitGenerator3D.new()
## Every footstep so far: [foot, global position].
var footsteps: Array[Array] = []
## Joint → global transform of its bone after the modifier, and the same of the frame before.
var bones: Dictionary[String, Transform3D] = {}
var bones_before: Dictionary[String, Transform3D] = {}
## Every bone's own pose after the modifier.
var bone_poses: Array[Transform3D] = []


## Makes the skeleton, unless it has bones already. Without `with_model` the node stays without a model.
func build(with_model := true) -> Walker:
	if skeleton.get_bone_count() == 0:
		_add_bones()
	skeleton.reset_bone_poses()
	add_child(skeleton)
	if with_model:
		gait.model = load(MODEL)
	if gait.seed == 0:
		# A walk of the test's and not of the node's own place in the tree.
		gait.seed = 1
	gait.footstep.connect(func(foot: StringName, place: Vector3) -> void: footsteps.append([foot, place]))
	gait.modification_processed.connect(_read_bones)
	skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_MANUAL
	skeleton.add_child(gait)
	return self


## Adds a foot placement below the generator. Connect `_read_bones` to the signal after which bones are to be read.
func add_placement() -> FootPlacement3D:
	var placement := FootPlacement3D.new()
	placement.name = "FootPlacement3D"
	placement.follow_ground = true
	skeleton.add_child(placement)
	gait.modification_processed.disconnect(_read_bones)
	return placement


func _add_bones() -> void:
	# Asking the skeleton for global rests would freeze its poses until they are set in the tree, so they are kept here.
	var global_rests: Array[Transform3D] = []
	for joint: String in BODY:
		if joint in missing:
			continue
		var parent := _present_parent(joint)
		var parent_bone := skeleton.find_bone(prefix + parent) if parent else -1
		if joint in between:
			var middle := skeleton.add_bone(between[joint])
			skeleton.set_bone_parent(middle, parent_bone)
			var turned := Basis.from_euler(Vector3(0.3, 0.5, -0.4))
			var middle_rest := Transform3D(turned, Vector3(0.01, 0.02, 0.0))
			skeleton.set_bone_rest(middle, middle_rest)
			global_rests.append(global_rests[parent_bone] * middle_rest if parent_bone >= 0 else middle_rest)
			parent_bone = middle
		var bone := skeleton.add_bone(prefix + joint)
		skeleton.set_bone_parent(bone, parent_bone)
		var above := global_rests[parent_bone] if parent_bone >= 0 else Transform3D.IDENTITY
		global_rests.append(rest(joint))
		skeleton.set_bone_rest(bone, above.affine_inverse() * rest(joint))


## Global rest of a joint's bone, in the skeleton's space.
func rest(joint: String) -> Transform3D:
	var place: Vector3 = rest_places.get(joint, BODY[joint][1])
	var turn: Quaternion = rest_rotations.get(joint, Quaternion.IDENTITY)
	return Transform3D(Basis(turn), place)


## Lets time pass in the modifier, at once.
func step(delta: float) -> void:
	skeleton.advance(delta)
	skeleton.notification(Skeleton3D.NOTIFICATION_UPDATE_SKELETON)


## Lets time pass in `count` frames and calls `each` after every one.
func walk(count: int, each := Callable(), delta := 1.0 / 60.0) -> void:
	for frame: int in count:
		step(delta)
		if each.is_valid():
			each.call()


## Global position of a joint after the last step.
func joint(joint_name: String) -> Vector3:
	return bones[joint_name].origin


## Turn of a joint's bone against its rest, in the axes of the skeleton's node.
func turn_of(joint_name: String) -> Quaternion:
	var world := skeleton.global_basis.orthonormalized()
	var turned := world.inverse() * bones[joint_name].basis.orthonormalized()
	return (turned * rest(joint_name).basis.inverse()).get_rotation_quaternion()


## Points under a foot that can bear it, global, from the bones of the last step: heel, ball, toe tip.
func sole(foot: StringName, of_bones: Dictionary[String, Transform3D] = bones) -> PackedVector3Array:
	var side := String(foot).capitalize()
	var x := 0.09 if foot == &"left" else -0.09
	var ankle := of_bones[side + "Foot"] * rest(side + "Foot").affine_inverse()
	var toes := ankle
	if side + "Toes" in of_bones:
		toes = of_bones[side + "Toes"] * rest(side + "Toes").affine_inverse()
	return [ankle * Vector3(x, 0, -0.0504), toes * Vector3(x, 0, 0.135), toes * Vector3(x, 0, 0.2106)]


## Speed of the stillest point under a foot during the last step, metres per second.
func slip(foot: StringName, delta := 1.0 / 60.0) -> float:
	var now := sole(foot)
	var before := sole(foot, bones_before)
	var least := INF
	for point: int in now.size():
		least = minf(least, now[point].distance_to(before[point]) / delta)
	return least


func _present_parent(joint: String) -> String:
	var parent: String = BODY[joint][0]
	while parent in missing:
		parent = BODY[parent][0]
	return parent


func _read_bones() -> void:
	bones_before = bones.duplicate()
	bone_poses.clear()
	for bone: int in skeleton.get_bone_count():
		bone_poses.append(skeleton.get_bone_pose(bone))
	for joint_name: String in BODY:
		var bone := skeleton.find_bone(names.get(joint_name, prefix + joint_name))
		if bone >= 0:
			bones[joint_name] = skeleton.global_transform * skeleton.get_bone_global_pose(bone)
