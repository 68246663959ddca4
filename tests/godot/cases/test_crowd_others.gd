extends TestCase
## A crowd among what is not of it: somebody else, and walls beside which walkers step aside.

const DT := 1.0 / 60.0
const GROUP := &"avoided"


func _crowd(configure: Callable) -> GaitCrowd3D:
	return add_crowd(0, func(crowd: GaitCrowd3D) -> void:
		crowd.behaviour = GaitCrowd3D.SCRIPTED
		configure.call(crowd))


## The least distance of a walker on its way from a node that goes at this velocity.
func _nearest(group: StringName, other: Node3D, velocity: Vector3) -> float:
	var crowd := _crowd(func(made: GaitCrowd3D) -> void:
		made.avoided_group = group
		# The crowd's space is not the world's.
		made.transform = Transform3D(Basis(Vector3.UP, 1.0), Vector3(3, 0, -2)))
	crowd.add_agents([Vector3.ZERO], [0.0])
	crowd.set_targets([Vector3(0, 0, 12)])
	other.global_position = crowd.to_global(Vector3(0.05, 0, 6) - 3.0 * velocity)
	var nearest := INF
	for frame: int in 720:
		other.global_position += crowd.basis * velocity * DT
		crowd.advance(DT)
		nearest = minf(nearest, crowd.get_positions()[0].distance_to(crowd.to_local(other.global_position)))
	check_below(crowd.get_positions()[0].distance_to(Vector3(0, 0, 12)), 1.5, "it arrives")
	crowd.free()
	return nearest


func test_nodes_of_the_group_are_walked_around() -> void:
	var other := Node3D.new()
	other.add_to_group(GROUP)
	add_child(other)
	check_below(_nearest(&"", other, Vector3.ZERO), 0.25, "nobody said that it is there")
	check(_nearest(GROUP, other, Vector3.ZERO) > 0.45, "one who stands")
	check(_nearest(GROUP, other, Vector3(0, 0, -1.0)) > 0.45, "one who comes the other way")
	other.free()


func test_a_crowd_in_the_group_counts_with_everybody_in_it() -> void:
	var standing := _crowd(func(made: GaitCrowd3D) -> void: made.add_to_group(GROUP))
	standing.add_agents([Vector3(0, 0, 5)], [0.0])
	standing.set_speeds([0.0])
	standing.advance(DT)
	var crowd := _crowd(func(made: GaitCrowd3D) -> void:
		made.avoided_group = GROUP
		made.add_to_group(GROUP))
	crowd.add_agents([Vector3(0.05, 0, 0)], [0.0])
	crowd.set_targets([Vector3(0, 0, 10)])
	var nearest := INF
	for frame: int in 600:
		standing.advance(DT)
		crowd.advance(DT)
		nearest = minf(nearest, crowd.get_positions()[0].distance_to(standing.get_positions()[0]))
	check(nearest > 0.4, "they keep apart: %f m" % nearest)


## Two rows meet in a lane, beside so many in a field who have to be looked at, too; returns how far beside the lane somebody gets. Destinations can be set once, or in every frame.
func _lane(destinations: bool, in_field := 0, renewed := false) -> float:
	var mesh := NavigationMesh.new()
	mesh.vertices = PackedVector3Array([
		Vector3(-0.6, 0, -12), Vector3(0.6, 0, -12), Vector3(0.6, 0, 12), Vector3(-0.6, 0, 12),
		Vector3(100, 0, -40), Vector3(400, 0, -40), Vector3(400, 0, 40), Vector3(100, 0, 40),
	])
	mesh.add_polygon([0, 1, 2, 3])
	mesh.add_polygon([4, 5, 6, 7])
	var region := NavigationRegion3D.new()
	region.navigation_mesh = mesh
	add_child(region)
	var crowd := _crowd(func(_made: GaitCrowd3D) -> void: pass)
	var places := PackedVector3Array()
	var targets := PackedVector3Array()
	var headings := PackedFloat32Array()
	for index: int in 8:
		var side := 1.0 if index < 4 else -1.0
		var row := Vector3(0.4 * (index % 2) - 0.2, 0, side * (-5.0 - 1.2 * (index % 4)))
		places.append(row)
		targets.append(Vector3(row.x, 0, side * 10.0))
		headings.append(0.0 if index < 4 else PI)
	for index: int in in_field:
		places.append(Vector3(110 + 2 * index, 0, -38))
		targets.append(Vector3(110 + 2 * index, 0, 38))
		headings.append(0.0)
	crowd.add_agents(places, headings)
	check(await until(func() -> bool: return crowd.set_destinations(targets)), "there are ways")
	if not destinations:
		crowd.set_targets(targets)
	var astray := 0.0
	for frame: int in 1500:
		if renewed:
			crowd.set_destinations(targets.slice(0, 8), range(8))
		crowd.advance(DT)
		for place: Vector3 in crowd.get_positions().slice(0, 8):
			astray = maxf(astray, absf(place.x) - 0.6)
	var left := 0.0
	for index: int in 8:
		left = maxf(left, crowd.get_positions()[index].distance_to(targets[index]))
	check_below(left, 2.0, "everybody gets through")
	crowd.free()
	region.free()
	return astray


func test_walkers_who_step_aside_stay_on_the_navigation_map() -> void:
	var astray := await _lane(true)
	check_below(astray, 0.15, "beside the lane")
	var free := await _lane(false)
	check(free > 1.0, "without a map they go farther aside: %f m" % free)


func test_destinations_that_are_set_again_and_again_keep_walkers_on_the_navigation_map() -> void:
	var astray := await _lane(true, 120, true)
	check_below(astray, 0.3, "beside the lane")
