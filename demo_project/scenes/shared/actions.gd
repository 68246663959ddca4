class_name Actions
## What keys, sticks and buttons do. Registered in code, so that scripts that need them can be copied into other projects.

const KEYS: Dictionary[StringName, Array] = {
	&"walk_forward": [KEY_W, KEY_UP],
	&"walk_back": [KEY_S, KEY_DOWN],
	&"walk_left": [KEY_A, KEY_LEFT],
	&"walk_right": [KEY_D, KEY_RIGHT],
	&"hurry": [KEY_SHIFT],
	&"aim": [KEY_CTRL],
}
## Action → axis and direction.
const AXES: Dictionary[StringName, Array] = {
	&"walk_forward": [JOY_AXIS_LEFT_Y, -1.0],
	&"walk_back": [JOY_AXIS_LEFT_Y, 1.0],
	&"walk_left": [JOY_AXIS_LEFT_X, -1.0],
	&"walk_right": [JOY_AXIS_LEFT_X, 1.0],
	&"look_up": [JOY_AXIS_RIGHT_Y, -1.0],
	&"look_down": [JOY_AXIS_RIGHT_Y, 1.0],
	&"look_left": [JOY_AXIS_RIGHT_X, -1.0],
	&"look_right": [JOY_AXIS_RIGHT_X, 1.0],
	&"hurry": [JOY_AXIS_TRIGGER_RIGHT, 1.0],
	&"aim": [JOY_AXIS_TRIGGER_LEFT, 1.0],
}


static func register() -> void:
	for action: StringName in KEYS:
		_add(action)
		for key: Key in KEYS[action]:
			var event := InputEventKey.new()
			event.physical_keycode = key
			InputMap.action_add_event(action, event)
	for action: StringName in AXES:
		_add(action)
		var event := InputEventJoypadMotion.new()
		event.axis = AXES[action][0]
		event.axis_value = AXES[action][1]
		InputMap.action_add_event(action, event)


static func _add(action: StringName) -> void:
	if InputMap.has_action(action):
		return
	InputMap.add_action(action, 0.2)
