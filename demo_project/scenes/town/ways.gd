class_name TownWays
extends NavigationRegion3D
## The ground that people can walk to: baked from the town's bodies when it starts, without islands such as the floors inside houses.

## A place from which everything that people walk on can be reached.
const HERE := Vector3(0, 0, 10)


func bake() -> void:
	NavigationServer3D.map_set_cell_height(get_world_3d().navigation_map, navigation_mesh.cell_height)
	bake_navigation_mesh(false)
	_keep_what_is_connected()


## Returns true once the server, which makes maps on a thread of its own, has this ground on its map: the map's first iteration may be empty.
func is_on_map() -> bool:
	var map := get_world_3d().navigation_map
	return NavigationServer3D.map_get_iteration_id(map) > 0 and NavigationServer3D.map_get_closest_point_owner(map, HERE) == get_rid()


func _keep_what_is_connected() -> void:
	var mesh := navigation_mesh
	var corners := mesh.get_vertices()
	var polygons: Array[PackedInt32Array] = []
	var users: Dictionary[int, PackedInt32Array] = {}
	var nearest := 0
	for index: int in mesh.get_polygon_count():
		polygons.append(mesh.get_polygon(index))
		for corner: int in polygons[index]:
			users.get_or_add(corner, PackedInt32Array()).append(index)
			if corners[corner].distance_squared_to(HERE) < corners[nearest].distance_squared_to(HERE):
				nearest = corner
	var reached: Dictionary[int, bool] = {}
	var waiting := Array(users.get(nearest, PackedInt32Array()))
	while not waiting.is_empty():
		var index: int = waiting.pop_back()
		if index in reached:
			continue
		reached[index] = true
		for corner: int in polygons[index]:
			waiting.append_array(users[corner])
	mesh.clear_polygons()
	for index: int in reached:
		mesh.add_polygon(polygons[index])
