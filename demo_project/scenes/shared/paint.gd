class_name Paint
## Colours a character.


static func apply(walker: Node3D, colour: Color) -> void:
	var paint: StandardMaterial3D
	for mesh: MeshInstance3D in walker.find_children("*", "MeshInstance3D"):
		if paint == null:
			paint = mesh.mesh.surface_get_material(0).duplicate()
			paint.albedo_color = colour
			paint.roughness = 0.62
			paint.rim_enabled = true
			paint.rim = 0.2
		mesh.set_surface_override_material(0, paint)
