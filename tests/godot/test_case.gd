class_name TestCase
extends Node
## Base of test files: checks that note a failure and go on.

## Factor by which time passes faster than the clock after [method begin_haste].
const HASTE := 10
## Frames of physics in a second of a game.
const PHYSICS_HZ := 60

## Failures, each with the line of its check.
var failures := PackedStringArray()
## Number of checks made.
var checks := 0


func check(condition: bool, what: String) -> void:
	checks += 1
	if not condition:
		_fail(what)


func check_equal(found: Variant, expected: Variant, what: String) -> void:
	checks += 1
	if found != expected:
		_fail("%s: found %s, expected %s" % [what, found, expected])


func check_near(found: float, expected: float, tolerance: float, what: String) -> void:
	checks += 1
	if not absf(found - expected) <= tolerance:
		_fail("%s: found %s, expected %s ± %s" % [what, found, expected, tolerance])


## Checks that `found` is below a limit; not a number counts as above.
func check_below(found: float, limit: float, what: String) -> void:
	checks += 1
	if not found < limit:
		_fail("%s: found %s, expected less than %s" % [what, found, limit])


func check_contains(text: String, part: String, what: String) -> void:
	checks += 1
	if not text.contains(part):
		_fail("%s: \"%s\" is not in \"%s\"" % [what, part, text])


## Lets frames of physics last as long as in a game, and come sooner, until [method end_haste].
func begin_haste() -> void:
	Engine.physics_ticks_per_second = PHYSICS_HZ * HASTE
	Engine.max_physics_steps_per_frame = HASTE
	Engine.time_scale = HASTE


func end_haste() -> void:
	Engine.physics_ticks_per_second = PHYSICS_HZ
	Engine.max_physics_steps_per_frame = 8
	Engine.time_scale = 1.0


## Errors and warnings between this and `end_expected_errors()` are provoked by the test.
func begin_expected_errors() -> void:
	print("expected errors: begin")


func end_expected_errors() -> void:
	print("expected errors: end")


func _fail(what: String) -> void:
	var line := ""
	for frame: Dictionary in get_stack():
		if frame.source != get_script().resource_path and frame.source.contains("test_case.gd"):
			continue
		line = "line %d: " % frame.line
		break
	failures.append(line + what)


## Lets physics frames pass until something holds, for three seconds at most: what other threads make takes its own time, however fast frames go. Returns whether it does.
func until(holds: Callable) -> bool:
	for frame: int in 600:
		await get_tree().physics_frame
		if holds.call():
			return true
		OS.delay_msec(5)
	return false


## Adds a character on flat ground; `configure` gets it before its skeleton is made.
func add_walker(configure := Callable()) -> Walker:
	var walker := Walker.new()
	if configure.is_valid():
		configure.call(walker)
	add_child(walker.build())
	return walker


## Adds a crowd of skinned bodies that only `advance()` moves; `configure` gets it before it enters the tree.
func add_crowd(count: int, configure := Callable()) -> GaitCrowd3D:
	var crowd := GaitCrowd3D.new()
	crowd.model = load(Walker.MODEL)
	crowd.character = Skinned.scene()
	crowd.count = count
	crowd.playing = false
	if configure.is_valid():
		configure.call(crowd)
	add_child(crowd)
	return crowd
