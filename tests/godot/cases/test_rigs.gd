extends TestCase
## Rigs of common tools walk as they are: no bone map, no import settings.

## One bone a line below its parent, one blank deeper; `= Joint` behind those that are joints. Also read by the Rust tests.
const LISTS := "res://../data/rigs"


## A walker whose skeleton has the bones of a list, its joints where the standard body has them.
func _walker_of(list: String) -> Walker:
	var walker := Walker.new()
	var above: Array[int] = []
	var rests: Array[Transform3D] = []
	for line: String in FileAccess.get_file_as_string(_folder().path_join(list)).split("\n", false):
		var name_and_joint := line.strip_edges().split(" = ")
		var depth := line.length() - line.strip_edges(true, false).length()
		above.resize(depth)
		# As the importer of glTF names them.
		var bone := walker.skeleton.add_bone(name_and_joint[0].replace(":", "_").replace(".", "_"))
		var parent: int = above[-1] if depth > 0 else -1
		var parent_rest := rests[parent] if parent >= 0 else Transform3D.IDENTITY
		walker.skeleton.set_bone_parent(bone, parent)
		var place := parent_rest.origin
		if name_and_joint.size() > 1:
			place = Walker.BODY[name_and_joint[1]][1]
			walker.names[name_and_joint[1]] = walker.skeleton.get_bone_name(bone)
		elif parent >= 0 and walker.skeleton.get_bone_name(parent) == walker.names.get("LeftToes"):
			place = Vector3(0.09, 0.0, 0.2106)
		elif parent >= 0 and walker.skeleton.get_bone_name(parent) == walker.names.get("RightToes"):
			place = Vector3(-0.09, 0.0, 0.2106)
		var turned := Basis.from_euler(Vector3(0.3 * bone, 0.5, 0.1 * bone))
		rests.append(Transform3D(turned, place))
		walker.skeleton.set_bone_rest(bone, parent_rest.affine_inverse() * rests[bone])
		above.append(bone)
	add_child(walker.build())
	return walker


func _folder() -> String:
	return ProjectSettings.globalize_path(LISTS).simplify_path()


func test_rigs_of_common_tools_walk_without_a_bone_map() -> void:
	var reference := Walker.new().build()
	add_child(reference)
	reference.walk(60)
	var lists := DirAccess.get_files_at(_folder())
	check(lists.size() >= 20, "there are lists: %d" % lists.size())
	for list: String in lists:
		var walker := _walker_of(list)
		check_equal(walker.gait.get_problems(), PackedStringArray(), "problems of " + list)
		walker.walk(60)
		check(walker.global_position.z > 0.5, "%s walked %.2f m" % [list, walker.global_position.z])
		# Bodies that lack joints make other steps; the others walk as the reference does.
		if walker.names.size() == Walker.BODY.size():
			for joint: String in ["Head", "LeftHand", "RightHand", "LeftFoot", "RightFoot", "LeftLowerLeg", "RightLowerArm"]:
				var apart := walker.joint(joint).distance_to(reference.joint(joint))
				check_below(apart, 0.02, "%s: distance of %s" % [list, joint])
		walker.queue_free()


func test_a_bone_map_comes_before_what_is_recognised() -> void:
	var walker := _walker_of("mixamo.txt")
	var map := BoneMap.new()
	map.profile = SkeletonProfileHumanoid.new()
	map.set_skeleton_bone_name("LeftFoot", "mixamorig_LeftToe_End")
	walker.gait.bone_map = map
	check_equal(walker.gait.get_problems().size(), 1, "the map's foot is no foot")
	check_contains("\n".join(walker.gait.get_problems()), "LeftToe", "the problem names a bone of the left foot")
	map.set_skeleton_bone_name("LeftFoot", "mixamorig_LeftFoot")
	walker.gait.bone_map = map
	check_equal(walker.gait.get_problems(), PackedStringArray(), "the others are recognised")


func test_missing_joints_of_a_known_rig_are_named() -> void:
	var walker := _walker_of("unreal_5.txt")
	walker.skeleton.set_bone_name(walker.skeleton.find_bone("foot_l"), "mystery")
	walker.gait.restart()
	var problems := "\n".join(walker.gait.get_problems())
	check_contains(problems, "LeftFoot", "names the joint")
	check_contains(problems, "Unreal", "names the family")
	check_contains(problems, "New BoneMap", "says what to do")
	check(not problems.contains("RightFoot"), "and only what is missing")


func test_a_node_beside_the_skeleton_is_told_where_to_go() -> void:
	var character := Node3D.new()
	character.name = "Character"
	var armature := Node3D.new()
	armature.name = "Armature"
	var skeleton := Skeleton3D.new()
	skeleton.name = "GeneralSkeleton"
	armature.add_child(skeleton)
	character.add_child(armature)
	var gait := GaitGenerator3D.new()
	character.add_child(gait)
	gait.owner = character
	add_child(character)
	var problems := "\n".join(gait.get_problems())
	check_contains(problems, "Armature/GeneralSkeleton", "names the skeleton of the scene")
	skeleton.free()
	problems = "\n".join(gait.get_problems())
	check_contains(problems, "This scene has none", "says that there is none")
