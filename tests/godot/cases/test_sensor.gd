extends TestCase
## ImuModel, ReplayImuSource and ImuReconstructor3D: a walker wears a sensor, and another body is driven by it.

const MODEL := "res://addons/footfall/models/right_foot.footimu"
const DELTA := 1.0 / 60.0


func _walker() -> Walker:
	var walker := Walker.new()
	walker.gait.speed = 1.2
	add_child(walker.build())
	return walker


func _driven(model := MODEL) -> Walker:
	return WornSensor.driven(self, model)


func _reconstructor(body: Walker) -> ImuReconstructor3D:
	return body.skeleton.get_node(^"Reconstructor")


## Writes a recording where a game may write.
func _write(samples: Array[Array], turn := Quaternion.IDENTITY) -> String:
	var path := "user://walk.imu"
	var file := FileAccess.open(path, FileAccess.WRITE)
	file.store_line("time_s,ax,ay,az,gx,gy,gz")
	for sample: Array in samples:
		var force: Vector3 = turn * sample[1]
		var rate: Vector3 = turn * sample[2]
		file.store_line("%f,%f,%f,%f,%f,%f,%f" % [sample[0], force.x, force.y, force.z, rate.x, rate.y, rate.z])
	file.close()
	return path


func test_shipped_models_are_imported_and_tell_their_site() -> void:
	for site: String in ["right_foot", "right_thigh"]:
		var model: ImuModel = load("res://addons/footfall/models/%s.footimu" % site)
		check_equal(model.get_error(), "", "%s is whole" % site)
		check_equal(model.get_sites(), PackedStringArray([site]), "it knows its site")
		check_contains(model.description, "CMU", "it says what it was made from")
	check_contains(ImuModel.from_bytes(PackedByteArray([1, 2, 3])).get_error(), "not a Footfall model", "three bytes")


func test_a_sensor_on_a_walkers_foot_drives_another_body() -> void:
	var walker := _walker()
	var samples := WornSensor.measure(walker, 600)
	var body := _driven()
	var steps: Array[Array] = []
	var node := _reconstructor(body)
	node.footstep.connect(func(foot: StringName, place: Vector3) -> void: steps.append([foot, place]))
	var behaviours: Array[StringName] = []
	node.behaviour_changed.connect(func(behaviour: StringName) -> void: behaviours.append(behaviour))
	var found := [0, 0]
	node.sensor_found.connect(func() -> void: found[0] += 1)
	node.sensor_lost.connect(func() -> void: found[1] += 1)
	body.step(0.0)
	var slips := PackedFloat32Array()
	var before := body.joint("RightFoot")
	for sample: Array in samples:
		node.push_sample(0, sample[0], sample[1], sample[2])
		body.step(DELTA)
		check_near(body.joint("Hips").y, 0.92, 0.12, "hips")
		check(body.joint("RightFoot").is_finite(), "the pose is finite")
	check_equal(String(node.get_behaviour()), "walk", "the behaviour at the end")
	check(node.get_confidence() > 0.5, "the walk is explained: %.2f" % node.get_confidence())
	check(&"walk" in behaviours, "the walk is told: %s" % [behaviours])
	check_near(body.global_position.z / walker.global_position.z, 1.0, 0.2, "way over the walker's")
	check_near(steps.size(), walker.footsteps.size(), 3, "footsteps")
	check_equal(found, [1, 0], "found once")
	# Silence: the sensor is lost once, and the body stays whole.
	for frame: int in 120:
		body.step(DELTA)
		check(body.joint("Head").is_finite(), "the pose without a sensor")
	check_equal(found, [1, 1], "lost once")
	check_equal(node.get_confidence(), 0.0, "nothing is heard, nothing is explained")
	node.reset_heading()
	body.free()
	walker.free()


func test_a_replay_in_any_mounting_is_found_out() -> void:
	var walker := _walker()
	var path := _write(WornSensor.measure(walker, 900), Quaternion(Vector3(0.6, 0.48, 0.64), 2.0))
	var source := ReplayImuSource.new()
	source.file = path
	check_equal(source.get_error(), "", "the recording is whole")
	check_near(source.get_length(), 15.0, 0.1, "its length")
	var body := _driven()
	var node := _reconstructor(body)
	node.mounting = ImuReconstructor3D.AUTO
	node.source = source
	for frame: int in 1200:
		body.step(DELTA)
		if frame > 270 and node.get_mounting_certainty(0) == 0.0:
			OS.delay_msec(20)
	check(node.get_mounting_certainty(0) > 0.9, "certain of the mounting: %.2f" % node.get_mounting_certainty(0))
	check_equal(String(node.get_behaviour()), "walk", "the behaviour")
	check(body.global_position.length() > 5.0, "it walks: %s" % body.global_position)
	# In a physics body this travels, and the sensor stays as it is worn.
	var carrier := CharacterBody3D.new()
	add_child(carrier)
	body.reparent(carrier)
	for frame: int in 120:
		body.step(DELTA)
	check(node.get_mounting_certainty(0) > 0.9, "the mounting is kept: %.2f" % node.get_mounting_certainty(0))
	check(carrier.position.length() > 0.5, "the physics body travels: %s" % carrier.position)
	carrier.free()
	walker.free()


func test_broken_sources_and_missing_parts_rest() -> void:
	begin_expected_errors()
	var body := _driven("")
	body.step(DELTA)
	check_near(body.skeleton.get_bone_global_pose(0).origin.y, 0.985, 1e-3, "hips without a model")
	var source := ReplayImuSource.new()
	check_contains(source.get_error(), "File", "no file")
	source.file = "user://none.imu"
	check_contains(source.get_error(), "there is no file", "a file that is not there")
	var still: Array[Array] = []
	for n: int in 100:
		still.append([n * 0.01, Vector3(0.0, 1.0, 0.0), Vector3(0.0, 0.01 * n, 0.0)])
	source.file = _write(still)
	check_contains(source.get_error(), "unit is g", "the wrong unit")
	var node := _reconstructor(body)
	node.source = source
	node.model = load(MODEL)
	for bad: Array in [[NAN, Vector3.ZERO, Vector3.ZERO], [0.0, Vector3.INF, Vector3.ZERO], [0.0, Vector3.UP, Vector3.UP]]:
		body.step(DELTA)
		node.push_sample(0, bad[0], bad[1], bad[2])
		node.push_sample(7, bad[0], bad[1], bad[2])
		node.push_sample(-1, bad[0], bad[1], bad[2])
		body.step(0.0)
		check(body.joint("Head").is_finite(), "the pose after %s" % [bad])
	body.free()
	end_expected_errors()
