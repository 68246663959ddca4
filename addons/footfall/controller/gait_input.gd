## Input actions of the controller.
##
## An action of the project's Input Map with one of the names below is used as it is. If there is none, an action of the same
## name with the prefix `footfall_` is added to the running game: the Input Map of the project does not change.

## Actions of the controller → the project's actions that do it, best first.
const NAMES: Dictionary[StringName, Array] = {
	&"forward": [&"move_forward", &"move_forwards", &"walk_forward"],
	&"back": [&"move_back", &"move_backward", &"move_backwards", &"walk_back"],
	&"left": [&"move_left", &"walk_left"],
	&"right": [&"move_right", &"walk_right"],
	&"look_up": [&"look_up"],
	&"look_down": [&"look_down"],
	&"look_left": [&"look_left"],
	&"look_right": [&"look_right"],
	&"hurry": [&"hurry", &"sprint", &"run"],
	&"aim": [&"aim"],
	&"jump": [&"jump"],
	&"crouch": [&"crouch"],
}
## Keys of actions that the project lacks.
const KEYS: Dictionary[StringName, Array] = {
	&"forward": [KEY_W, KEY_UP],
	&"back": [KEY_S, KEY_DOWN],
	&"left": [KEY_A, KEY_LEFT],
	&"right": [KEY_D, KEY_RIGHT],
	&"hurry": [KEY_SHIFT],
	&"aim": [KEY_CTRL],
	&"jump": [KEY_SPACE],
	&"crouch": [KEY_C],
}
## Sticks and triggers of a gamepad: axis and direction.
const AXES: Dictionary[StringName, Array] = {
	&"forward": [JOY_AXIS_LEFT_Y, -1.0],
	&"back": [JOY_AXIS_LEFT_Y, 1.0],
	&"left": [JOY_AXIS_LEFT_X, -1.0],
	&"right": [JOY_AXIS_LEFT_X, 1.0],
	&"look_up": [JOY_AXIS_RIGHT_Y, -1.0],
	&"look_down": [JOY_AXIS_RIGHT_Y, 1.0],
	&"look_left": [JOY_AXIS_RIGHT_X, -1.0],
	&"look_right": [JOY_AXIS_RIGHT_X, 1.0],
	&"hurry": [JOY_AXIS_TRIGGER_RIGHT, 1.0],
	&"aim": [JOY_AXIS_TRIGGER_LEFT, 1.0],
}
const BUTTONS: Dictionary[StringName, JoyButton] = {
	&"jump": JOY_BUTTON_A,
	&"crouch": JOY_BUTTON_B,
}
const PREFIX := "footfall_"
const DEADZONE := 0.2


## Returns the action of the Input Map for a name; adds it if there is none.
static func action(wish: StringName) -> StringName:
	for known: StringName in NAMES[wish]:
		if InputMap.has_action(known):
			return known
	var own := StringName(PREFIX + String(NAMES[wish][0]))
	if not InputMap.has_action(own):
		_make(wish, own)
	return own


static func is_pressed(wish: StringName) -> bool:
	return Input.is_action_pressed(action(wish))


static func is_just_pressed(wish: StringName) -> bool:
	return Input.is_action_just_pressed(action(wish))


## Direction of the left stick or the keys: x to the right, y backwards, at most 1 long.
static func move() -> Vector2:
	return Input.get_vector(action(&"left"), action(&"right"), action(&"forward"), action(&"back"))


## Direction of the right stick.
static func look() -> Vector2:
	return Input.get_vector(action(&"look_left"), action(&"look_right"), action(&"look_up"), action(&"look_down"))


static func _make(wish: StringName, own: StringName) -> void:
	InputMap.add_action(own, DEADZONE)
	for key: Key in KEYS.get(wish, []):
		var event := InputEventKey.new()
		event.physical_keycode = key
		InputMap.action_add_event(own, event)
	if wish in AXES:
		var event := InputEventJoypadMotion.new()
		event.axis = AXES[wish][0]
		event.axis_value = AXES[wish][1]
		InputMap.action_add_event(own, event)
	if wish in BUTTONS:
		var event := InputEventJoypadButton.new()
		event.button_index = BUTTONS[wish]
		InputMap.action_add_event(own, event)
