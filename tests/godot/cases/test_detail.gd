extends TestCase
## Detail of a walk: chosen, and by size on screen.

const FULL := 0
const HALF := 1
const QUARTER := 2
const AUTO := 3
## Height of a standing body over that of its hips.
const BODY_OVER_HIPS := 1.8


var screen := _screen()


## A viewport of a known size, of which headless windows have none.
func _screen() -> SubViewport:
	var viewport := SubViewport.new()
	viewport.size = Vector2i(1152, 648)
	add_child(viewport)
	return viewport


func _walker() -> Walker:
	var walker := Walker.new()
	walker.gait.speed = 1.0
	screen.add_child(walker.build())
	return walker


func _camera() -> Camera3D:
	var camera := Camera3D.new()
	screen.add_child(camera)
	camera.make_current()
	return camera


func test_less_detail_is_the_same_walk() -> void:
	var way := []
	for detail: int in [0, 1, 2]:
		var walker := _walker()
		check_equal(walker.gait.detail, 0, "full detail is the default")
		walker.gait.detail = detail
		walker.walk(300, func() -> void:
			check_near(walker.joint("Hips").y, 0.92, 0.12, "hips at detail %d" % detail))
		way.append(walker.global_position.z)
		walker.free()
	check_near(way[1], way[0], 0.06 * way[0], "half detail goes as far")
	check_near(way[2], way[0], 0.06 * way[0], "quarter detail goes as far")


func test_auto_chooses_by_the_height_on_screen() -> void:
	var walker := _walker()
	var camera := _camera()
	walker.gait.detail = AUTO
	var seen := {}
	for view: int in [Camera3D.PROJECTION_PERSPECTIVE, Camera3D.PROJECTION_ORTHOGONAL]:
		camera.projection = view
		for distance: float in [2.0, 4.0, 8.0, 16.0, 32.0, 64.0]:
			var feet := walker.global_position
			camera.size = distance
			camera.global_position = feet + Vector3(0, 0, distance)
			var head := feet + Vector3.UP * BODY_OVER_HIPS * Walker.BODY["Hips"][1].y
			var pixels := camera.unproject_position(feet).distance_to(camera.unproject_position(head))
			# It may keep more detail between 0.8 of a height and that height.
			if absf(pixels / 135.0 - 1.0) < 0.12 or absf(pixels / 36.0 - 1.0) < 0.12:
				continue
			walker.walk(30)
			var expected := FULL if pixels > 150.0 else HALF if pixels > 40.0 else QUARTER
			check_equal(walker.gait.get_current_detail(), expected, "a body of %.0f pixels" % pixels)
			seen[expected] = true
	check_equal(seen.size(), 3, "details seen")


func test_auto_walks_the_same_way_far_away() -> void:
	var way := []
	for distance: float in [2.0, 500.0]:
		var camera := _camera()
		var walker := _walker()
		walker.gait.detail = AUTO
		for second in 5:
			camera.global_position = walker.global_position + Vector3(0, 1, distance)
			walker.walk(60)
		check_equal(walker.gait.get_current_detail(), FULL if distance < 10.0 else QUARTER, "at %.0f m" % distance)
		way.append(walker.global_position.z)
		camera.free()
		walker.free()
	check_near(way[1], way[0], 0.06 * way[0], "the way far away")
	check(way[0] != way[1], "fewer frames are computed far away")


func test_auto_has_full_detail_without_a_camera() -> void:
	var walker := _walker()
	walker.gait.detail = AUTO
	walker.walk(60)
	check_equal(walker.gait.get_current_detail(), FULL, "without a camera")
	walker.gait.detail = HALF
	check_equal(walker.gait.get_current_detail(), HALF, "as it is set")
