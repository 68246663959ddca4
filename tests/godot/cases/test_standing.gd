extends TestCase
## Standing that lives: by property, on planted feet, for one character and for a crowd.

const RATE := 60.0
## A model that learned how people stand.
const ALIVE := "../model_versions/v4.footfall"


func _model() -> GaitModel:
	var path := ProjectSettings.globalize_path("res://").path_join(ALIVE)
	var model := GaitModel.from_bytes(FileAccess.get_file_as_bytes(path))
	check_equal(model.get_error(), "", "the model loads")
	return model


func _walker(motion: float, seed_number := 3) -> Walker:
	var walker := Walker.new()
	walker.gait.seed = seed_number
	walker.gait.speed = 0.0
	walker.gait.standing_motion = motion
	add_child(walker.build(false))
	walker.gait.model = _model()
	walker.step(0.0)
	return walker


## Distance of the head from where it was, metres.
func _head_way(walker: Walker, frames: int) -> float:
	walker.walk(1)
	var first := walker.joint("Head")
	var farthest := [0.0]
	walker.walk(frames, func() -> void: farthest[0] = maxf(farthest[0], first.distance_to(walker.joint("Head"))))
	return farthest[0]


func test_by_itself_it_lives_and_at_0_it_is_still() -> void:
	var untold := GaitGenerator3D.new()
	check_near(untold.standing_motion, 1.0, 0.0, "it lives unless told otherwise")
	untold.free()
	check(_head_way(_walker(1.0), 600) > 0.004, "the head sways")
	check_below(_head_way(_walker(0.0), 600), 1e-4, "a still pose")


func test_feet_stay_while_it_sways() -> void:
	var walker := _walker(2.0)
	walker.walk(2)
	var fastest := [0.0]
	walker.walk(900, func() -> void:
		for foot: StringName in Walker.FEET:
			fastest[0] = maxf(fastest[0], walker.slip(foot)))
	check_below(fastest[0], 0.005, "feet, metres per second")
	check(walker.footsteps.is_empty(), "it makes no steps")


func test_seeds_stand_differently_and_alike() -> void:
	var heads := PackedVector3Array()
	for seed_number: int in [3, 3, 4]:
		var walker := _walker(1.0, seed_number)
		walker.walk(400)
		heads.append(walker.joint("Head"))
	check_equal(heads[0], heads[1], "equal seeds")
	check(heads[0].distance_to(heads[2]) > 0.003, "other seeds")


func test_a_state_goes_on_with_the_same_sway() -> void:
	var walker := _walker(1.0)
	walker.walk(500)
	var other := _walker(1.0, 9)
	other.gait.set_state(walker.gait.get_state())
	for frame: int in 120:
		walker.walk(1)
		other.walk(1)
		check_below(walker.joint("Head").distance_to(other.joint("Head")), 1e-5, "frame %d" % frame)


func test_it_starts_and_stops_without_a_jump() -> void:
	var walker := _walker(1.0)
	walker.walk(200)
	for speed: float in [1.2, 0.0]:
		walker.gait.speed = speed
		walker.walk(240, func() -> void:
			var way := walker.joint("Head").distance_to(walker.bones_before["Head"].origin)
			check_below(way * RATE, 2.0, "the head, metres per second"))
	check_below(_head_way(walker, 1), 0.02, "it stands again")


func test_a_baked_idle_lives_and_closes() -> void:
	var walker := _walker(1.0)
	walker.skeleton.owner = walker
	var library := walker.gait.bake(6.0, ["neutral"], [])
	var idle := library.get_animation(&"idle_neutral")
	var moved := 0.0
	for track: int in idle.get_track_count():
		if idle.track_get_type(track) != Animation.TYPE_ROTATION_3D:
			continue
		var first := idle.rotation_track_interpolate(track, 0.0)
		var last := idle.rotation_track_interpolate(track, idle.length)
		check_below(first.angle_to(last), 2e-3, "track %s ends as it begins" % idle.track_get_path(track))
		moved = maxf(moved, first.angle_to(idle.rotation_track_interpolate(track, 3.0)))
	check(moved > 0.004, "something moves in between: %.4f" % moved)
