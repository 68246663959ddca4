class_name Skinned
## Scenes with the canonical body and a mesh that hangs from all its bones.


static func scene(without: PackedStringArray = []) -> PackedScene:
	var walker := Walker.new()
	walker.missing = without
	return packed(walker)


## A scene with the body of a walker that is not built yet. `dress` makes the mesh on a skeleton.
static func packed(walker: Walker, dress := clothe.bind(0.03)) -> PackedScene:
	walker.build(false)
	var root := Node3D.new()
	var skeleton := walker.skeleton
	walker.remove_child(skeleton)
	skeleton.remove_child(walker.gait)
	walker.gait.free()
	root.add_child(skeleton)
	skeleton.owner = root
	skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_IDLE
	(dress.call(skeleton) as Node).owner = root
	var scene := PackedScene.new()
	scene.pack(root)
	root.free()
	walker.free()
	return scene


## Hangs a mesh from all bones of a skeleton: a triangle of this size, in the skeleton's own units, at every one.
static func clothe(skeleton: Skeleton3D, size: float) -> MeshInstance3D:
	var mesh := MeshInstance3D.new()
	mesh.mesh = _triangles(skeleton, size)
	skeleton.add_child(mesh)
	mesh.skin = skeleton.create_skin_from_rest_transforms()
	mesh.skeleton = ^".."
	return mesh


static func _triangles(skeleton: Skeleton3D, size: float) -> ArrayMesh:
	var vertices := PackedVector3Array()
	var normals := PackedVector3Array()
	var bones := PackedInt32Array()
	var weights := PackedFloat32Array()
	for bone: int in skeleton.get_bone_count():
		var place := Vector3.ZERO
		var above := bone
		while above >= 0:
			place = skeleton.get_bone_rest(above) * place
			above = skeleton.get_bone_parent(above)
		for corner: Vector3 in [Vector3.ZERO, size * Vector3.RIGHT, size * Vector3.UP]:
			vertices.append(place + corner)
			normals.append(Vector3.BACK)
			bones.append_array([bone, 0, 0, 0])
			weights.append_array([1.0, 0.0, 0.0, 0.0])
	var arrays := []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = vertices
	arrays[Mesh.ARRAY_NORMAL] = normals
	arrays[Mesh.ARRAY_BONES] = bones
	arrays[Mesh.ARRAY_WEIGHTS] = weights
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	return mesh
