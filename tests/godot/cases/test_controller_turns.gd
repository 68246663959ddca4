extends TestCase
## Turns of a running `GaitCharacter3D`, asked for at different moments of its stride.

const CONTROLLER: PackedScene = preload("res://addons/footfall/controller/gait_character_3d.tscn")
const SPEED := 3.2


func _ready() -> void:
	begin_haste()


func _exit_tree() -> void:
	end_haste()


func _frames(count: int) -> void:
	for frame: int in count:
		await get_tree().physics_frame


## Runs, turns by an angle, and returns the time until the character has four fifths of its speed there, and how far beyond the angle it turned.
func _turn(angle: float, frames_before: int) -> Array[float]:
	var character: GaitCharacter3D = CONTROLLER.instantiate()
	character.character_scene = Skinned.scene()
	character.player_controlled = false
	character.walk_speed = SPEED
	add_child(character)
	character.autopilot = Vector3.BACK
	await _frames(frames_before)
	character.autopilot = Vector3.BACK.rotated(Vector3.UP, angle)
	var found: Array[float] = [INF, 0.0]
	for frame: int in 120:
		await get_tree().physics_frame
		var beyond := wrapf(character.global_rotation.y - angle, -PI, PI) * signf(angle)
		if absf(beyond) < 0.5 * PI:
			found[1] = maxf(found[1], beyond)
		if found[0] == INF and character.velocity.dot(character.autopilot) > 0.8 * SPEED:
			found[0] = float(frame) / PHYSICS_HZ
	character.free()
	return found


func test_a_runner_turns_at_once_and_no_farther_than_asked() -> void:
	var ground := CollisionShape3D.new()
	ground.shape = BoxShape3D.new()
	ground.shape.size = Vector3(60, 1, 60)
	var body := StaticBody3D.new()
	body.add_child(ground)
	body.position.y = -0.5
	add_child(body)
	for turn: Vector2 in [Vector2(0.5 * PI, 0.7), Vector2(-0.5 * PI, 0.7), Vector2(0.95 * PI, 1.25)]:
		for moment: int in 5:
			var found := await _turn(turn.x, 200 + 4 * moment)
			var asked := "%.0f° after %d frames" % [rad_to_deg(turn.x), 200 + 4 * moment]
			check_below(found[0], turn.y, "%s, seconds" % asked)
			check_below(found[1], 0.07, "%s, radians too far" % asked)
