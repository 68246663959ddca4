extends TestCase
## Problems and calibration of a sensor, as scripts and players are told.

const MODEL := "res://addons/footfall/models/right_foot.footimu"
const DELTA := 1.0 / 60.0
const FILE := "user://player.footcal"
## Worn anyhow.
const WORN := Vector3(0.6, 0.48, 0.64)


func _reconstructor(body: Walker) -> ImuReconstructor3D:
	return body.skeleton.get_node(^"Reconstructor")


## Measurements of a sensor on the foot of a walker who stands for three seconds and then walks, turned so: [time, force, rate].
func _measured(frames: int, turn := Quaternion.IDENTITY) -> Array[Array]:
	var walker := Walker.new()
	walker.gait.speed = 0.0
	add_child(walker.build())
	var samples := WornSensor.measure(walker, 180)
	walker.gait.speed = 1.2
	var later := WornSensor.measure(walker, frames)
	var offset: float = samples[-1][0] + DELTA - later[0][0]
	for sample: Array in later:
		samples.append([sample[0] + offset, sample[1], sample[2]])
	for sample: Array in samples:
		sample[1] = turn * sample[1]
		sample[2] = turn * sample[2]
	walker.free()
	return samples


func _push(node: ImuReconstructor3D, body: Walker, sample: Array) -> void:
	node.push_sample(0, sample[0], sample[1], sample[2])
	body.step(DELTA)


func test_a_stuck_axis_is_told_and_the_body_stands() -> void:
	var body := WornSensor.driven(self, MODEL)
	var node := _reconstructor(body)
	var told: Array[Array] = []
	node.sensor_problem_changed.connect(func(sensor: int, problem: StringName, message: String) -> void: told.append([sensor, String(problem), message]))
	body.step(0.0)
	var samples := _measured(900)
	for sample: Array in samples.slice(0, 500):
		_push(node, body, sample)
	check_equal(told, [], "a sound sensor has no problem")
	check_equal(String(node.get_sensor_problem()), "", "nor when asked")
	for sample: Array in samples.slice(500, 800):
		sample[2].x = 0.25
		_push(node, body, sample)
	check_equal(told.size(), 1, "told once: %s" % [told])
	check_equal(told[0].slice(0, 2), [0, "stuck_axis"], "the problem")
	check_contains(told[0][2], "gx", "the axis")
	check_contains(told[0][2], "restart the sensor", "the next thing to do")
	check_equal(node.get_sensor_message(0), told[0][2], "the message when asked")
	check_contains("\n".join(node.get_problems()), "gx", "among the problems")
	check_equal(String(node.get_behaviour()), "stand", "the body stands")
	for sample: Array in samples.slice(800, 1000):
		_push(node, body, sample)
	check_equal(told.size(), 2, "its end is told: %s" % [told])
	check_equal(told[1], [0, "", ""], "nothing is wrong any more")
	for frame: int in 90:
		body.step(DELTA)
	check_equal(String(node.get_sensor_problem()), "silent", "then silence")
	check_equal(String(node.get_sensor_problem(5)), "", "no such sensor")
	body.free()


func test_a_guided_calibration_is_kept_for_the_next_session() -> void:
	var turn := Quaternion(WORN, 2.0)
	var samples := _measured(900, turn)
	var body := WornSensor.driven(self, MODEL)
	var node := _reconstructor(body)
	node.mounting = ImuReconstructor3D.AUTO
	node.start_calibration()
	var asked: Array[String] = []
	node.calibration_changed.connect(func(step: StringName, message: String) -> void:
		asked.append(String(step))
		check(message.length() > 10, "%s is asked" % step))
	body.step(0.0)
	check_contains(node.save_calibration(FILE), "Calibrate first", "nothing is known yet")
	var done_secs := 0.0
	for n: int in samples.size():
		_push(node, body, samples[n])
		if node.get_calibration_progress() >= 1.0 and node.get_calibration_step() != &"done":
			# A thread looks for the mounting.
			OS.delay_msec(20)
		if node.get_calibration_step() == &"done" and done_secs == 0.0:
			done_secs = n * DELTA
	check_equal(asked, ["connect", "stand", "walk", "done"], "the steps")
	check(done_secs > 4.0 and done_secs < 9.0, "calibrated after %.1f s" % done_secs)
	check(node.get_mounting_certainty(0) > 0.8, "certainty %.2f" % node.get_mounting_certainty(0))
	check_equal(node.save_calibration(FILE), "", "saved")
	check_equal(node.save_calibration(FILE), "", "saved once more, in its place")
	check(not FileAccess.file_exists(FILE + ".new"), "nothing is left beside it")
	check(node.get_step_scale() > 0.69 and node.get_step_scale() < 1.41, "steps: %.2f" % node.get_step_scale())
	body.free()

	# The next session walks at once.
	body = WornSensor.driven(self, MODEL)
	node = _reconstructor(body)
	node.mounting = ImuReconstructor3D.AUTO
	check_contains(node.load_calibration(FILE), "after the first frame", "too soon")
	body.step(0.0)
	check_contains(node.load_calibration("user://none.footcal"), "There is no file", "no file")
	check_equal(node.load_calibration(FILE), "", "loaded")
	for sample: Array in samples.slice(180, 420):
		_push(node, body, sample)
	check(body.global_position.length() > 2.0, "it walks at once: %s" % body.global_position)
	body.free()

	# Another model is refused, and so is what is no calibration.
	body = WornSensor.driven(self, "res://addons/footfall/models/right_thigh.footimu")
	node = _reconstructor(body)
	body.step(0.0)
	check_contains(node.load_calibration(FILE), "for right_foot, the model for right_thigh", "another site")
	check_contains(node.load_calibration(MODEL), "not a sensor calibration", "a model")
	node.set_step_scale(1.2)
	check_near(node.get_step_scale(), 1.2, 1e-6, "a pocket's steps are set")
	body.free()
	DirAccess.remove_absolute(FILE)
