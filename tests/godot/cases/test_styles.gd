extends TestCase
## GaitStyle, styles of a walker, and states.

const RATE := 60.0
const MODELS := "res://addons/footfall/models"


func _style(style_name: String) -> GaitStyle:
	return load("%s/%s.footstyle" % [MODELS, style_name])


func _walker(styles: Array[GaitStyle], weights: Array, seed := 1) -> Walker:
	var walker := Walker.new()
	walker.gait.styles = styles
	walker.gait.style_weights = PackedFloat32Array(weights)
	walker.gait.seed = seed
	walker.gait.speed = 1.0
	add_child(walker.build())
	return walker


## Mean lean of the head ahead of the hips, metres.
func _lean(walker: Walker, frames: int) -> float:
	var sum := [0.0]
	walker.walk(frames, func() -> void: sum[0] += walker.joint("Head").z - walker.joint("Hips").z)
	return sum[0] / frames


func test_every_shipped_style_fits_the_shipped_model_and_walks() -> void:
	var names := PackedStringArray()
	for file: String in DirAccess.get_files_at(MODELS):
		if file.get_extension() == "footstyle":
			names.append(file.get_basename())
	check_equal(names.size(), 11, "styles shipped")
	for style_name: String in names:
		var style := _style(style_name)
		check(style != null, "%s is a GaitStyle" % style_name)
		check_equal(style.get_error(), "", "%s is whole" % style_name)
		check_equal(style.get_style_name(), style_name, "it knows its name")
		check(style.get_usual_speed() > 0.3 and style.get_usual_speed() < 2.5, "its speed: %.2f" % style.get_usual_speed())
		check_contains(style.description, "CMU", "it says what it was made from")
		var walker := _walker([style], [1.0])
		check_equal(walker.gait.get_problems(), PackedStringArray(), "%s fits the model" % style_name)
		var slips := PackedFloat32Array()
		walker.walk(240, func() -> void:
			check_near(walker.joint("Hips").y, 0.9, 0.16, "hips of %s" % style_name)
			for foot: StringName in Walker.FEET:
				if walker.gait.is_foot_on_ground(foot):
					slips.append(walker.slip(foot)))
		slips.sort()
		check_below(slips[slips.size() / 2], 0.005, "median slip of %s, m/s" % style_name)
		check(walker.global_position.z > 2.0, "%s walks: %s" % [style_name, walker.global_position])
		walker.free()


func test_weights_change_the_walk_within_a_step_and_without_a_pop() -> void:
	var walker := _walker([_style("sad"), _style("proud")], [0.0, 0.0])
	walker.walk(60)
	var plain := _lean(walker, 120)
	walker.gait.style_weights = PackedFloat32Array([1.0, 0.0])
	var hand := [walker.joint("LeftHand"), walker.joint("LeftHand")]
	walker.walk(70, func() -> void:
		var now := walker.joint("LeftHand")
		# 120 m/s² at 60 fps.
		check_below((now - 2.0 * hand[1] + hand[0]).length(), 0.034, "jump of a hand, m") if hand[0] != hand[1] else null
		hand = [hand[1], now])
	var sad := _lean(walker, 120)
	walker.gait.style_weights = PackedFloat32Array([0.0, 1.0])
	walker.walk(70)
	var proud := _lean(walker, 120)
	check(sad > plain + 0.05, "sad leans more, %.3f m, than the plain walk, %.3f m" % [sad, plain])
	check(proud < sad - 0.05, "proud leans less, %.3f m" % proud)


func test_weights_in_the_walk_from_its_first_frame() -> void:
	var plain := _walker([_style("sad")], [0.0])
	var sad := _walker([_style("sad")], [1.0])
	check(_lean(sad, 20) > _lean(plain, 20) + 0.04, "it begins in its style")


func test_problems_name_the_next_step() -> void:
	var walker := _walker([_style("sad"), null], [1.0, 1.0])
	check_contains("\n".join(walker.gait.get_problems()), ".footstyle", "an empty place in the list")
	walker.gait.styles = [_style("sad")]
	check_contains("\n".join(walker.gait.get_problems()), "Style Weights", "more weights than styles")
	walker.gait.style_weights = PackedFloat32Array([1.0])
	check_equal(walker.gait.get_problems(), PackedStringArray(), "then all is well")
	walker.gait.styles = [GaitStyle.from_bytes("no style".to_utf8_buffer())]
	check_contains("\n".join(walker.gait.get_problems()), "not a Footfall model", "a damaged style")


func test_senseless_weights_are_bounded() -> void:
	var walker := _walker([_style("sad"), _style("proud")], [NAN, INF])
	for weights: Array in [[NAN, INF], [1e20, -1e20], [], [1.0, 1.0, 1.0, 1.0]]:
		walker.gait.style_weights = PackedFloat32Array(weights)
		walker.walk(90, func() -> void: check_near(walker.joint("Hips").y, 0.9, 0.3, "hips with %s" % [weights]))


func test_a_state_goes_on_with_the_same_poses() -> void:
	var styles: Array[GaitStyle] = [_style("cool"), _style("heavy")]
	var one := _walker(styles, [0.5, 0.2], 5)
	one.walk(137)
	one.gait.style_weights = PackedFloat32Array([0.1, 0.9])
	one.walk(9)
	var state := one.gait.get_state()
	check(state.size() > 100 and state.size() < 2000, "%d bytes" % state.size())
	var other := _walker(styles, [0.1, 0.9], 6)
	other.walk(20)
	other.gait.set_state(state)
	other.walk(1, Callable(), 0.0)
	check_equal(other.gait.get_state(), state, "the state again")
	var place := other.global_transform.affine_inverse() * one.global_transform
	for frame: int in 200:
		one.step(1.0 / RATE)
		other.step(1.0 / RATE)
		for bone: int in one.skeleton.get_bone_count():
			if one.skeleton.get_bone_pose(bone) != other.skeleton.get_bone_pose(bone):
				check(false, "bone %d differs in frame %d" % [bone, frame])
				return
	var after := other.global_transform.affine_inverse() * one.global_transform
	check(after.origin.distance_to(place.origin) < 1e-3, "they travel alike")


func test_a_state_that_is_none_is_refused_and_the_walk_goes_on() -> void:
	var walker := _walker([], [])
	walker.walk(30)
	begin_expected_errors()
	walker.gait.set_state("nonsense".to_utf8_buffer())
	walker.walk(1)
	end_expected_errors()
	var from := walker.global_position
	walker.walk(60)
	check(walker.global_position.distance_to(from) > 0.5, "it walks on")
