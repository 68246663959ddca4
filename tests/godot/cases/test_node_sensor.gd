extends TestCase
## Nodes of the game for sensors: trackers, a headset, and paths that lead nowhere.

const MODEL := "res://addons/footfall/models/right_foot.footimu"
const DELTA := 1.0 / 60.0
## Place of a tracker on a foot, metres from the ankle.
const ON_THE_FOOT := Vector3(0.0, -0.01, 0.07)


func _source(node: Node) -> NodeImuSource:
	var source := NodeImuSource.new()
	source.node = node.get_path()
	return source


func _reconstructor(body: Walker) -> ImuReconstructor3D:
	return body.skeleton.get_node(^"Reconstructor")


func test_a_tracker_on_a_foot_drives_a_body() -> void:
	var wearer := Walker.new()
	wearer.gait.speed = 1.2
	add_child(wearer.build())
	var tracker := Node3D.new()
	add_child(tracker)
	var body := WornSensor.driven(self, MODEL, _source(tracker))
	var rest := wearer.rest("RightFoot")
	# Its -Z points ahead.
	var worn := Transform3D(Basis(Vector3.UP, PI), rest.origin + ON_THE_FOOT)
	var steps := [0]
	_reconstructor(body).footstep.connect(func(_foot: StringName, _place: Vector3) -> void: steps[0] += 1)
	for frame: int in 480:
		wearer.step(DELTA)
		tracker.global_transform = wearer.bones["RightFoot"] * rest.affine_inverse() * worn
		body.step(DELTA)
	check_equal(String(_reconstructor(body).get_behaviour()), "walk", "the behaviour")
	var way := wearer.global_position.length()
	check_near(body.global_position.length(), way, 0.1 * way, "the way")
	check_near(steps[0], wearer.footsteps.size(), 3, "the steps")
	for node: Node in [body, tracker, wearer]:
		node.free()


func test_a_headset_in_a_vehicle_stands() -> void:
	var vehicle := XROrigin3D.new()
	var headset := XRCamera3D.new()
	headset.position = Vector3(0.0, 1.7, 0.0)
	vehicle.add_child(headset)
	add_child(vehicle)
	var body := WornSensor.driven(self, MODEL, _source(headset))
	for frame: int in 300:
		vehicle.position += Vector3(0.1, 0.05, 0.0)
		vehicle.rotate_y(0.02)
		body.step(DELTA)
	check_equal(String(_reconstructor(body).get_behaviour()), "stand", "the behaviour")
	check_below(body.global_position.length(), 0.05, "the way")
	body.free()
	vehicle.free()


func test_a_path_that_leads_nowhere_is_told() -> void:
	var source := NodeImuSource.new()
	begin_expected_errors()
	var body := WornSensor.driven(self, MODEL, source)
	var node := _reconstructor(body)
	check_contains("\n".join(node.get_problems()), "Set its Node", "no node")
	source.node = ^"../Nowhere"
	check_contains("\n".join(node.get_problems()), "../Nowhere", "a wrong path")
	body.step(DELTA)
	check(body.joint("Head").is_finite(), "the body stands")
	end_expected_errors()
	source.node = node.get_path_to(body.skeleton)
	check_equal(node.get_problems().size(), 0, "warnings once it is set")
	body.free()
