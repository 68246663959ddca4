extends TestCase
## Walkers of a crowd who are only some pixels high: who is drawn as a stand-in, and as what.

const MODEL := preload("res://addons/footfall/models/locomotion.footfall")
const DT := 1.0 / 60.0
const SIZE := Vector2i(1280, 720)
const FOV := 60.0
## Height of the test figure, metres.
const HEIGHT := 1.735

var _viewport: SubViewport
var _camera: Camera3D
var _crowd: GaitCrowd3D


## A crowd of walkers in a row away from a camera of known lens, at these distances.
func _row(distances: PackedFloat32Array, configure := Callable(), texture: Texture2D = null) -> void:
	_viewport = SubViewport.new()
	_viewport.size = SIZE
	add_child(_viewport)
	_camera = Camera3D.new()
	_camera.fov = FOV
	_viewport.add_child(_camera)
	_camera.look_at_from_position(Vector3(0, 0.9, 0), Vector3(0, 0.9, 1))
	_camera.make_current()
	_crowd = GaitCrowd3D.new()
	_crowd.model = MODEL
	_crowd.character = _figure(texture)
	_crowd.count = 0
	_crowd.behaviour = GaitCrowd3D.SCRIPTED
	_crowd.size_range = Vector2.ONE
	_crowd.full_count = 0
	_crowd.near_distance = 10.0
	_crowd.playing = false
	_crowd.colours = [Color.WHITE, Color.INDIAN_RED, Color.STEEL_BLUE]
	if configure.is_valid():
		configure.call(_crowd)
	_viewport.add_child(_crowd)
	var places := PackedVector3Array()
	var turns := PackedFloat32Array()
	for far: float in distances:
		places.append(Vector3(0, 0, far))
		turns.append(0.0)
	_crowd.add_agents(places, turns)
	_crowd.set_turn_rates(turns)
	_crowd.set_speeds(turns)
	for frame: int in 12:
		_crowd.advance(DT)


## The canonical body with a ball around each bone, red on the left, of which a texture is the other colour.
func _figure(texture: Texture2D) -> PackedScene:
	return Skinned.packed(Walker.new(), func(skeleton: Skeleton3D) -> MeshInstance3D:
		var mesh := MeshInstance3D.new()
		mesh.mesh = _balls(skeleton)
		skeleton.add_child(mesh)
		mesh.skin = skeleton.create_skin_from_rest_transforms()
		mesh.skeleton = ^".."
		var material := StandardMaterial3D.new()
		material.albedo_color = Color(0.5, 0.5, 0.5)
		material.albedo_texture = texture
		mesh.mesh.surface_set_material(0, material)
		return mesh)


func _balls(skeleton: Skeleton3D) -> ArrayMesh:
	var ball := SphereMesh.new()
	ball.radius = 0.12
	ball.height = 0.3
	ball.radial_segments = 24
	ball.rings = 12
	var tool := SurfaceTool.new()
	tool.begin(Mesh.PRIMITIVE_TRIANGLES)
	var arrays := ball.get_mesh_arrays()
	var vertices: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var first := 0
	for bone: int in skeleton.get_bone_count():
		var is_left := skeleton.get_bone_name(bone).begins_with("Left")
		for index: int in vertices.size():
			tool.set_normal(arrays[Mesh.ARRAY_NORMAL][index])
			tool.set_uv(Vector2(0.75 if is_left else 0.25, 0.5))
			tool.set_color(Color.WHITE)
			tool.set_bones([bone, 0, 0, 0])
			tool.set_weights([1.0, 0.0, 0.0, 0.0])
			tool.add_vertex(skeleton.get_bone_global_rest(bone).origin + vertices[index])
		for index: int in arrays[Mesh.ARRAY_INDEX]:
			tool.add_index(first + index)
		first += vertices.size()
	return tool.commit()


## Nodes with instances: drawn with the character's mesh (0) and with its stand-in (1).
func _drawn() -> Array[Array]:
	var found: Array[Array] = [[], []]
	for child: Node in _crowd.get_children(true):
		var shown := child as MultiMeshInstance3D
		if shown and shown.visible and shown.multimesh.visible_instance_count > 0:
			found[int(_triangles(shown) < 500)].append(shown)
	return found


func _triangles(shown: MultiMeshInstance3D) -> int:
	return shown.multimesh.mesh.get_faces().size() / 3


func _counts() -> Array[int]:
	var counts: Array[int] = [0, 0]
	var drawn := _drawn()
	for kind: int in 2:
		for shown: MultiMeshInstance3D in drawn[kind]:
			counts[kind] += shown.multimesh.visible_instance_count
	return counts


## The distance at which a walker is so many pixels high.
func _far(pixels: float) -> float:
	return HEIGHT * 0.5 * SIZE.y / tan(deg_to_rad(0.5 * FOV)) / pixels


func _after_each() -> void:
	_viewport.free()


func test_who_is_a_few_pixels_high_is_drawn_as_a_stand_in() -> void:
	_row([5.0, 0.9 * _far(24), 1.1 * _far(24), 2.0 * _far(24), 4.0 * _far(24)])
	check_equal(_counts(), [2, 3] as Array[int], "by default 24 pixels are the border")
	var drawn := _drawn()
	for shown: MultiMeshInstance3D in drawn[1]:
		check_below(_triangles(shown), 161, "triangles of a stand-in")
	for shown: MultiMeshInstance3D in drawn[0]:
		check(_triangles(shown) > 5000, "triangles of the mesh: %d" % _triangles(shown))
	_crowd.stand_in_pixels = 0.0
	_crowd.advance(DT)
	check_equal(_counts(), [5, 0] as Array[int], "0 turns them off")
	_crowd.stand_in_pixels = 48.0
	_crowd.advance(DT)
	check_equal(_counts(), [1, 4] as Array[int], "twice the pixels")
	for nonsense: float in [NAN, INF, -5.0]:
		_crowd.stand_in_pixels = nonsense
		_crowd.advance(DT)
		check_equal(_counts(), [5, 0] as Array[int], "%s pixels turn them off" % nonsense)
	_after_each()


func test_lens_and_window_make_walkers_small() -> void:
	_row([0.9 * _far(24), 1.3 * _far(24)])
	check_equal(_counts(), [1, 1] as Array[int], "between them is the border")
	_camera.fov = 0.5 * FOV
	_crowd.advance(DT)
	check_equal(_counts(), [2, 0] as Array[int], "a long lens brings them near")
	_camera.fov = FOV
	_viewport.size = SIZE / 2
	_crowd.advance(DT)
	check_equal(_counts(), [0, 2] as Array[int], "a small window has few pixels")
	_viewport.size = SIZE
	_camera.set_orthogonal(20.0, 0.05, 4000.0)
	_crowd.advance(DT)
	check_equal(_counts(), [2, 0] as Array[int], "a parallel view of 20 m")
	_camera.size = 200.0
	_crowd.advance(DT)
	check_equal(_counts(), [0, 2] as Array[int], "a parallel view of 200 m")
	_after_each()


func test_who_is_at_the_border_does_not_flicker() -> void:
	_row([_far(24)])
	var changes := 0
	var before := _counts()
	for frame: int in 60:
		_camera.position.z = 1.5 * sin(0.7 * frame)
		_crowd.advance(DT)
		changes += int(_counts() != before)
		before = _counts()
	check_below(changes, 2, "changes")
	_after_each()


func test_a_stand_in_is_where_its_walker_is_in_the_same_pose_and_tint() -> void:
	for repeats: bool in [true, false]:
		_row([30.0, 31.0, 32.0], func(crowd: GaitCrowd3D) -> void: crowd.repeat_far = repeats)
		var found: Array[Array] = []
		for pixels: float in [0.0, 1e6]:
			_crowd.stand_in_pixels = pixels
			_crowd.advance(0.0)
			var drawn: Array = _drawn()[int(pixels > 0.0)]
			check(not drawn.is_empty(), "somebody is drawn")
			var rows: Array[PackedFloat32Array] = []
			for shown: MultiMeshInstance3D in drawn:
				var numbers := RenderingServer.multimesh_get_buffer(shown.multimesh.get_rid())
				for index: int in shown.multimesh.visible_instance_count:
					rows.append(numbers.slice(20 * index, 20 * (index + 1)))
				check(shown.custom_aabb.has_point(Vector3(0, 1, 31)), "bounds")
			found.append(rows)
		check_equal(found[1].size(), 3, "walkers")
		check_equal(found[1], found[0], "places, tints and slots of poses")
		_after_each()


func test_a_stand_in_has_the_height_and_the_colours_of_its_character() -> void:
	var image := Image.create(256, 256, false, Image.FORMAT_RGB8)
	image.fill(Color.BLUE)
	image.fill_rect(Rect2i(128, 0, 128, 256), Color.RED)
	_row([20.0, 90.0], Callable(), ImageTexture.create_from_image(image))
	var drawn := _drawn()
	var whole: ArrayMesh = drawn[0][0].multimesh.mesh
	var stand_in: ArrayMesh = drawn[1][0].multimesh.mesh
	var bounds := stand_in.get_aabb()
	check_near(bounds.end.y, whole.get_aabb().end.y, 0.01, "height")
	check_near(bounds.size.x, whole.get_aabb().size.x, 0.1, "span of the arms")
	var material: ShaderMaterial = stand_in.surface_get_material(0)
	var brightest: Color = material.get_shader_parameter("albedo")
	var arrays := stand_in.surface_get_arrays(0)
	var half := Color(0.5, 0.5, 0.5).srgb_to_linear().r
	for index: int in arrays[Mesh.ARRAY_VERTEX].size():
		var colour: Color = arrays[Mesh.ARRAY_COLOR][index] * brightest.srgb_to_linear()
		var x: float = arrays[Mesh.ARRAY_VERTEX][index].x
		if absf(x) > 0.3:
			check_near(colour.r, half if x > 0.0 else 0.0, 0.01, "red at %.2f m" % x)
			check_near(colour.b, half if x < 0.0 else 0.0, 0.01, "blue at %.2f m" % x)
	_after_each()


func test_a_material_of_your_own_keeps_the_mesh() -> void:
	var material := ShaderMaterial.new()
	material.shader = load("res://addons/footfall/shaders/crowd.gdshader")
	_row([20.0, 200.0], func(crowd: GaitCrowd3D) -> void: crowd.material = material)
	check_equal(_counts(), [2, 0] as Array[int], "both have the mesh")
	_after_each()
