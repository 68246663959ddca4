class_name BoneGuess
## Guesses which bones of a character are which joints, by the names that common tools give them, and makes a `BoneMap` of it.
##
## The importer does this better (*Advanced Import Settings, Skeleton3D, Retarget*); this is for characters that a game loads while it runs.

## Joint of the humanoid profile → what its bone may be called, without prefix, case, spaces, dots and underscores. `*` is the side.
const NAMES: Dictionary[String, Array] = {
	"Hips": ["hips", "pelvis", "hip"],
	"Spine": ["spine", "spine01", "abdomen", "spine1"],
	"Chest": ["spine1", "spine02", "chest", "spine2"],
	"UpperChest": ["spine2", "spine03", "upperchest", "spine3"],
	"Neck": ["neck", "neck01", "neck1"],
	"Head": ["head"],
	"LeftShoulder": ["*shoulder", "clavicle*", "*collar"],
	"LeftUpperArm": ["*arm", "upperarm*", "*upperarm"],
	"LeftLowerArm": ["*forearm", "lowerarm*", "*lowerarm"],
	"LeftHand": ["*hand", "hand*"],
	"LeftUpperLeg": ["*upleg", "thigh*", "*thigh", "*upperleg"],
	"LeftLowerLeg": ["*leg", "calf*", "shin*", "*shin", "*lowerleg"],
	"LeftFoot": ["*foot", "foot*"],
	"LeftToes": ["*toebase", "ball*", "toe*", "*toes", "*toe"],
}
const SIDES: Dictionary[String, Array] = {"Left": ["left", "l"], "Right": ["right", "r"]}


## The map for a skeleton. Joints that were not found are left out; a `GaitGenerator3D` says which it misses.
static func map(skeleton: Skeleton3D) -> BoneMap:
	var bones: Dictionary[String, String] = {}
	for bone: int in skeleton.get_bone_count():
		bones[_plain(skeleton.get_bone_name(bone))] = skeleton.get_bone_name(bone)
	var found := BoneMap.new()
	found.profile = SkeletonProfileHumanoid.new()
	var taken: Dictionary[String, bool] = {}
	for joint: String in NAMES:
		var sides: Array = ["Left", "Right"] if joint.begins_with("Left") else ["Left"]
		for side: String in sides:
			var own := joint.replace("Left", side)
			for name: String in _candidates(own, joint, side):
				if name in bones and not taken.has(bones[name]):
					found.set_skeleton_bone_name(own, bones[name])
					taken[bones[name]] = true
					break
	return found


static func _candidates(own: String, joint: String, side: String) -> PackedStringArray:
	var names := PackedStringArray([own.to_lower()])
	for pattern: String in NAMES[joint]:
		if not pattern.contains("*"):
			names.append(pattern)
			continue
		for word: String in SIDES[side]:
			names.append(pattern.replace("*", word))
	return names


## A name without prefixes such as `mixamorig:` and `Bip01 `, in small letters and digits.
static func _plain(name: String) -> String:
	var text := name.to_lower()
	for prefix: String in ["mixamorig", "bip01", "bip001", "character1", "def-", "j_bip_c_", "j_bip_"]:
		if text.begins_with(prefix):
			text = text.trim_prefix(prefix)
	var letters := ""
	for letter: String in text:
		if letter.is_valid_identifier() and letter != "_" or letter.is_valid_int():
			letters += letter
	return letters
