extends TestCase
## Effects of keyboard, touch and the project's own actions on the add-on's `GaitCharacter3D`.

const CONTROLLER: PackedScene = preload("res://addons/footfall/controller/gait_character_3d.tscn")
const GaitInput := preload("res://addons/footfall/controller/gait_input.gd")


func _exit_tree() -> void:
	for action: StringName in InputMap.get_actions():
		if action.begins_with("footfall_") or action in [&"move_forward", &"jump"]:
			InputMap.erase_action(action)


func _key(key: Key, pressed: bool) -> void:
	var event := InputEventKey.new()
	event.physical_keycode = key
	event.keycode = key
	event.pressed = pressed
	Input.parse_input_event(event)
	Input.flush_buffered_events()


func _finger(at: Vector2, pressed: bool) -> InputEventScreenTouch:
	var event := InputEventScreenTouch.new()
	event.position = at
	event.pressed = pressed
	return event


func test_actions_of_the_project_are_used_and_none_is_changed() -> void:
	InputMap.add_action(&"jump")
	var own := InputEventKey.new()
	own.physical_keycode = KEY_J
	InputMap.action_add_event(&"jump", own)
	check_equal(GaitInput.action(&"jump"), &"jump", "the project's action")
	check_equal(InputMap.action_get_events(&"jump"), [own] as Array[InputEvent], "which stays as it is")
	check(not InputMap.has_action(&"footfall_jump"), "and needs no other")
	check_equal(GaitInput.action(&"forward"), &"footfall_move_forward", "an action of the controller's own")
	check(not InputMap.has_action(&"move_forward"), "beside the project's")
	check_equal(GaitInput.action(&"forward"), &"footfall_move_forward", "made once")
	check_equal(InputMap.action_get_events(&"footfall_move_forward").size(), 3, "two keys and a stick")
	InputMap.add_action(&"move_forward")
	check_equal(GaitInput.action(&"forward"), &"move_forward", "the project's, as soon as there is one")


func test_keys_walk_it_away_from_the_camera() -> void:
	var ground := StaticBody3D.new()
	var plane := CollisionShape3D.new()
	plane.shape = WorldBoundaryShape3D.new()
	ground.add_child(plane)
	add_child(ground)
	var character: GaitCharacter3D = CONTROLLER.instantiate()
	character.character_scene = Skinned.scene()
	add_child(character)
	for frame: int in 10:
		await get_tree().physics_frame
	check_equal(character.gait.speed, 0.0, "it stands before")
	_key(KEY_W, true)
	for frame: int in 60:
		await get_tree().physics_frame
	check_near(character.gait.speed, character.walk_speed, 0.01, "it walks")
	check(character.position.z > 0.2, "away from the camera: %s" % character.position)
	_key(KEY_SHIFT, true)
	await get_tree().physics_frame
	await get_tree().physics_frame
	check_near(character.gait.speed, character.hurry_speed, 0.01, "and hurries")
	_key(KEY_SHIFT, false)
	_key(KEY_W, false)
	await get_tree().physics_frame
	await get_tree().physics_frame
	check_equal(character.gait.speed, 0.0, "and stops")


func test_a_finger_on_the_left_half_is_a_stick() -> void:
	var character: GaitCharacter3D = CONTROLLER.instantiate()
	add_child(character)
	var stick: Control = character.get_node(^"TouchStick")
	var size := stick.get_viewport_rect().size
	var at := size * Vector2(0.2, 0.7)
	stick._unhandled_input(_finger(at, true))
	var drag := InputEventScreenDrag.new()
	drag.position = at + Vector2(0, -200)
	stick._unhandled_input(drag)
	check_near(GaitInput.move().y, -1.0, 0.01, "pushed forwards")
	drag.position = at + Vector2(45, 0)
	stick._unhandled_input(drag)
	check(GaitInput.move().x > 0.3 and absf(GaitInput.move().y) < 0.01, "pushed to the right: %s" % GaitInput.move())
	stick._unhandled_input(_finger(at, false))
	check_equal(GaitInput.move(), Vector2.ZERO, "let go")
	stick._unhandled_input(_finger(size * Vector2(0.8, 0.5), true))
	drag.position = size * Vector2(0.8, 0.2)
	stick._unhandled_input(drag)
	check_equal(GaitInput.move(), Vector2.ZERO, "fingers elsewhere are others'")
