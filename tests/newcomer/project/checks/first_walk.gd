extends NewcomerCheck
## Puts a generator under a skeleton, and nothing else.


func run() -> void:
	var skeleton := humanoid()
	var character := Node3D.new()
	add_child(character)
	character.add_child(skeleton)
	var gait := GaitGenerator3D.new()
	gait.character = NodePath("../..")
	skeleton.add_child(gait)
	var steps: Array[StringName] = []
	gait.footstep.connect(func(foot: StringName, _position: Vector3) -> void: steps.append(foot))
	for frame: int in 240:
		await get_tree().process_frame
	expect(gait.get_problems().is_empty(), "it has problems: " + "; ".join(gait.get_problems()))
	expect(character.position.length() > 1.0, "it does not walk: it is at %s" % character.position)
	expect(steps.size() > 2, "it makes %d steps" % steps.size())


## The skeleton that a retargeted character has.
func humanoid() -> Skeleton3D:
	var profile := SkeletonProfileHumanoid.new()
	var skeleton := Skeleton3D.new()
	for index: int in profile.bone_size:
		var bone := skeleton.add_bone(profile.get_bone_name(index))
		skeleton.set_bone_parent(bone, skeleton.find_bone(profile.get_bone_parent(index)))
		skeleton.set_bone_rest(bone, profile.get_reference_pose(index))
	skeleton.reset_bone_poses()
	return skeleton
