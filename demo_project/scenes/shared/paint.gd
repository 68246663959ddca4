class_name Paint
## Colours a character, and names it.


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


## Writes a name above its head.
static func label(walker: Node3D, title: String) -> void:
	var text := Label3D.new()
	text.text = title
	text.position.y = 1.95
	text.billboard = BaseMaterial3D.BILLBOARD_ENABLED
	text.font_size = 64
	text.pixel_size = 0.0035
	text.outline_size = 20
	walker.add_child(text)
