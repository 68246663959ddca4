extends TestCase
## A switching model (.footdyn) in place of a trained walk.

const MODEL := "res://addons/footfall/models/walk.footdyn"
const RATE := 60.0


func _walker(seed := 1) -> Walker:
	var walker := Walker.new()
	walker.gait.model = load(MODEL)
	walker.gait.seed = seed
	walker.gait.speed = 1.1
	add_child(walker.build(false))
	return walker


func test_the_shipped_switching_model_is_there() -> void:
	var model: GaitModel = load(MODEL)
	check(model != null, "a .footdyn file loads as a GaitModel")
	check_equal(model.get_error(), "", "and is whole")
	check(model.is_switching(), "it knows its kind")
	check(not (load(Walker.MODEL) as GaitModel).is_switching(), "the trained walk knows its own")
	var speeds := model.get_speed_range()
	check(speeds.x > 0.8 and speeds.x < 1.5, "a walking speed: %s" % speeds)
	check_contains(model.description, "Two linear systems", "it describes itself")


func test_it_walks_with_planted_feet_and_tells_its_footsteps() -> void:
	var walker := _walker()
	var footsteps: Array[StringName] = []
	walker.gait.footstep.connect(func(foot: StringName, _place: Vector3) -> void: footsteps.append(foot))
	check_equal(walker.gait.get_problems(), PackedStringArray(), "nothing is wrong")
	var slips := PackedFloat32Array()
	walker.walk(600, func() -> void:
		check_near(walker.joint("Hips").y, 0.92, 0.1, "hips")
		for foot: StringName in Walker.FEET:
			if walker.gait.is_foot_on_ground(foot):
				slips.append(walker.slip(foot)))
	slips.sort()
	check_below(slips[slips.size() / 2], 0.005, "median slip, m/s")
	check_near(walker.global_position.z, 11.0, 0.6, "ten seconds of walking")
	check(footsteps.size() >= 15 and footsteps.size() <= 22, "%d footsteps" % footsteps.size())
	for index: int in footsteps.size() - 1:
		check(footsteps[index] != footsteps[index + 1], "feet take turns")


func test_it_stops_and_its_state_goes_on_bit_for_bit() -> void:
	var walker := _walker(3)
	walker.walk(100)
	var state := walker.gait.get_state()
	check(state.size() > 50 and state.size() < 400, "%d bytes" % state.size())
	var other := _walker(4)
	other.gait.set_state(state)
	other.walk(1)
	walker.walk(1)
	walker.walk(90)
	other.walk(90)
	check_equal(other.gait.get_state(), walker.gait.get_state(), "the same walk")
	var apart := (other.joint("LeftHand") - other.global_position).distance_to(walker.joint("LeftHand") - walker.global_position)
	check_below(apart, 1e-5, "the same pose, metres apart")
	walker.gait.speed = 0.0
	walker.walk(150)
	var stands := walker.global_position
	walker.walk(60)
	check_equal(walker.global_position, stands, "it stands")


func test_styles_are_passed_over_with_what_to_do() -> void:
	var walker := _walker()
	walker.gait.styles = [load("res://addons/footfall/models/sad.footstyle")]
	walker.gait.style_weights = PackedFloat32Array([1.0])
	check_contains("\n".join(walker.gait.get_problems()), "Clear Styles", "what to do")
	walker.gait.styles = []
	walker.gait.style_weights = PackedFloat32Array()
	check_equal(walker.gait.get_problems(), PackedStringArray(), "and then it is done")


func test_the_model_may_change_while_it_walks() -> void:
	var walker := _walker()
	walker.walk(100)
	walker.gait.model = load(Walker.MODEL)
	walker.walk(100)
	walker.gait.model = load(MODEL)
	walker.walk(100)
	check(walker.global_position.z > 4.0, "it walks on: %s" % walker.global_position)


func test_damaged_bytes_are_told() -> void:
	var bytes := FileAccess.get_file_as_bytes(MODEL)
	bytes[bytes.size() / 2] ^= 0xFF
	check_contains(GaitModel.from_bytes(bytes).get_error(), "damaged", "what is wrong")
	check_contains(GaitModel.from_bytes(bytes.slice(0, 100)).get_error(), "cut short", "what is wrong")
