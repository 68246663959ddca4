extends Node3D
## Somebody of the town, who dissolves in front of the camera instead of filling the view.

## Distances from the camera at which a body is gone, and whole, metres.
const GONE_M := 0.6
const WHOLE_M := 1.4

## Materials that dissolve, by the mannequin's own.
static var _dissolving: Dictionary[Material, BaseMaterial3D] = {}


func _ready() -> void:
	for mesh: MeshInstance3D in find_children("*", "MeshInstance3D"):
		for surface: int in mesh.get_surface_override_material_count():
			var own := mesh.get_active_material(surface)
			if own not in _dissolving:
				var material: BaseMaterial3D = own.duplicate()
				material.distance_fade_mode = BaseMaterial3D.DISTANCE_FADE_PIXEL_DITHER
				material.distance_fade_min_distance = GONE_M
				material.distance_fade_max_distance = WHOLE_M
				_dissolving[own] = material
			mesh.set_surface_override_material(surface, _dissolving[own])
