@tool
extends EditorScenePostImport
## Prepares the imported mannequin: its skeleton is `%GeneralSkeleton`, as Godot names every retargeted humanoid, and its
## levels of detail replace each other with the distance to the camera.

## Distances in metres at which the next coarser mesh takes over.
const LEVEL_ENDS_M := [9.0, 24.0]


func _post_import(scene: Node) -> Object:
	for skeleton: Skeleton3D in scene.find_children("*", "Skeleton3D"):
		skeleton.name = "GeneralSkeleton"
		skeleton.unique_name_in_owner = true
		# Retargeted animations move the hips in units of their height.
		skeleton.motion_scale = skeleton.get_bone_global_rest(skeleton.find_bone("Hips")).origin.y
	for mesh: GeometryInstance3D in scene.find_children("Body*", "MeshInstance3D"):
		var level := mesh.name.trim_prefix("Body").trim_prefix("_LOD").to_int()
		if level > 0:
			mesh.visibility_range_begin = LEVEL_ENDS_M[level - 1]
			mesh.visibility_range_begin_margin = 0.3
		if level < LEVEL_ENDS_M.size():
			mesh.visibility_range_end = LEVEL_ENDS_M[level]
			mesh.visibility_range_end_margin = 0.3
	return scene
