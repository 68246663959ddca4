extends NewcomerCheck
## Drops the controller into a level with stairs, gives it a character from elsewhere, and has it wave as it climbs.

const CONTROLLER := "res://addons/footfall/controller/gait_character_3d.tscn"
const STRANGER := "res://stranger.glb"
const RISE_M := 0.17
const TREAD_M := 0.29
const STEPS := 6
const FRAMES := 1080


func run() -> void:
	_box(Vector3(0, -0.5, 0), Vector3(40, 1, 40))
	for step: int in STEPS:
		var depth := 2.0 * TREAD_M * (STEPS - step) - TREAD_M + 1.2
		_box(Vector3(0, 0.5 * RISE_M * (step + 1), 4), Vector3(2.4, RISE_M * (step + 1), depth))
	var player: GaitCharacter3D = (load(CONTROLLER) as PackedScene).instantiate()
	player.character_scene = load(STRANGER)
	add_child(player)
	var problems := player.gait.get_problems()
	expect(problems.is_empty(), "the stranger has problems: " + "; ".join(problems))
	await _frames(60)
	expect(player.position.length() < 0.05, "it walks before a key is pressed: it is at %s" % player.position)
	_wave(player)
	Input.action_press(&"footfall_move_forward")
	var skeleton := player.gait.get_skeleton()
	var head := _bone(skeleton, "Head")
	var hand := _bone(skeleton, "RightHand")
	var raised := [0]
	player.placement.modification_processed.connect(func() -> void:
		raised[0] += int(skeleton.get_bone_global_pose(hand).origin.y > skeleton.get_bone_global_pose(head).origin.y))
	var top := 0.0
	for frame: int in FRAMES:
		await get_tree().physics_frame
		top = maxf(top, player.position.y)
	Input.action_release(&"footfall_move_forward")
	expect(absf(top - STEPS * RISE_M) < 0.03, "it did not get up the stairs: its top is %.2f m" % top)
	expect(player.position.z > 6.5 and absf(player.position.y) < 0.03, "it did not come down behind them: it is at %s" % player.position)
	expect(raised[0] > 0.9 * FRAMES, "it waved for %d frames of %d" % [raised[0], FRAMES])


func _wave(player: GaitCharacter3D) -> void:
	var clips: AnimationPlayer = player.find_children("*", "AnimationPlayer", true, false)[0]
	clips.play(&"wave")
	player.gait.right_arm_weight = 0.0


func _bone(skeleton: Skeleton3D, end: String) -> int:
	for bone: int in skeleton.get_bone_count():
		if skeleton.get_bone_name(bone).ends_with(end):
			return bone
	return -1


func _frames(count: int) -> void:
	for frame: int in count:
		await get_tree().physics_frame


func _box(middle: Vector3, size: Vector3) -> void:
	var body := StaticBody3D.new()
	var shape := CollisionShape3D.new()
	var box := BoxShape3D.new()
	box.size = size
	shape.shape = box
	body.add_child(shape)
	body.position = middle
	add_child(body)
