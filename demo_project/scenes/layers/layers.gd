extends WalkingScene
## Walkers whose arms and trunks an `AnimationPlayer` poses while they walk: a wave, a load, a rifle, an attack.

const BETWEEN_M := 1.7
const WEIGHTS: Array[StringName] = [&"spine_weight", &"head_weight", &"left_arm_weight", &"right_arm_weight"]
## Title, colour and the weights that the clip takes to 0.
const GESTURES: Array[Array] = [
	["wave", Color("c96f53"), [&"right_arm_weight"]],
	["carry", Color("5f8fb0"), [&"left_arm_weight", &"right_arm_weight"]],
	["aim", Color("6f9a5c"), [&"spine_weight", &"head_weight", &"left_arm_weight", &"right_arm_weight"]],
	["attack", Color("b58a3c"), [&"spine_weight", &"right_arm_weight"]],
]
## Time in which a layer comes or goes, seconds.
const FADE_SECS := 0.2

var _layers_on := true


func _ready() -> void:
	_camera.distance_m = 7.5
	_camera.heading = deg_to_rad(24.0)
	_camera.height = deg_to_rad(12.0)
	for index: int in GESTURES.size():
		var place := Vector3((0.5 * (GESTURES.size() - 1) - index) * BETWEEN_M, 0.0, 0.0)
		var title: String = GESTURES[index][0]
		add_walker(title.capitalize(), place, GESTURES[index][1])
		Paint.label(walkers[-1], title)
		_give_clip(walkers[-1], title)
	follow(%Panel)
	_fade(0.0)


func _process(_delta: float) -> void:
	_camera.target_position = middle() + Vector3.UP * 0.9


func _unhandled_key_input(event: InputEvent) -> void:
	if event.is_action_pressed(&"ui_accept"):
		_layers_on = not _layers_on
		_fade(FADE_SECS)


## Gives arms and trunks to the clips, or back to the walk.
func _fade(seconds: float) -> void:
	for index: int in walkers.size():
		var gait := gait_of(walkers[index])
		for weight: StringName in GESTURES[index][2]:
			var to := 0.0 if _layers_on else 1.0
			if seconds > 0.0:
				create_tween().tween_property(gait, NodePath(weight), to, seconds)
			else:
				gait.set(weight, to)


func _give_clip(walker: Node3D, title: String) -> void:
	var skeleton: Skeleton3D = gait_of(walker).get_parent()
	var player := AnimationPlayer.new()
	walker.add_child(player)
	var path := walker.get_path_to(skeleton)
	match title:
		"wave":
			_wave(Gesture.new(skeleton, path, 0.9)).play_on(player)
		"carry":
			_carry(Gesture.new(skeleton, path, 1.0)).play_on(player)
			_hold(skeleton, Vector3(0.46, 0.28, 0.28), Transform3D(Basis.IDENTITY, Vector3(0.0, 1.17, 0.4)), Color("8a6a4a"))
		"aim":
			_aim(Gesture.new(skeleton, path, 1.0)).play_on(player)
			# The trunk is turned and bent; what it aims is not.
			var ahead := Basis.from_euler(Vector3(-10, 25, 0) * PI / 180.0)
			_hold(skeleton, Vector3(0.05, 0.08, 0.75), Transform3D(ahead, Vector3(0.08, 1.34, 0.42)), Color("3a3f44"))
		"attack":
			_attack(Gesture.new(skeleton, path, 1.4)).play_on(player)


func _wave(clip: Gesture) -> Gesture:
	for half: int in 3:
		var side := 1.0 if half == 1 else -1.0
		clip.key(0.45 * half, "RightShoulder", Vector3(0, 0, -8))
		clip.key(0.45 * half, "RightUpperArm", Vector3(0, 20, -18))
		clip.key(0.45 * half, "RightLowerArm", Vector3(0, 20, -75 + 22 * side))
		clip.key(0.45 * half, "RightHand", Vector3(0, 0, 12 * side))
	return clip


func _carry(clip: Gesture) -> Gesture:
	for side: float in [1.0, -1.0]:
		var name_of_side := "Left" if side > 0.0 else "Right"
		clip.key(0.0, name_of_side + "UpperArm", Vector3(-12, 0, -76 * side))
		clip.key(0.0, name_of_side + "LowerArm", Vector3(0, -95 * side, 0))
	return clip


func _aim(clip: Gesture) -> Gesture:
	clip.key(0.0, "Spine", Vector3(4, -12, 0)).key(0.0, "Chest", Vector3(3, -8, 0)).key(0.0, "UpperChest", Vector3(3, -5, 0))
	clip.key(0.0, "Neck", Vector3(6, 18, 0)).key(0.0, "Head", Vector3(4, 7, -6))
	clip.key(0.0, "LeftUpperArm", Vector3(0, -62, -14)).key(0.0, "LeftLowerArm", Vector3(0, -38, 0))
	clip.key(0.0, "RightUpperArm", Vector3(0, 38, 42)).key(0.0, "RightLowerArm", Vector3(0, 112, 0))
	return clip


func _attack(clip: Gesture) -> Gesture:
	var moments := [0.0, 0.55, 0.75, 1.4]
	var trunk := [0.0, -32.0, 30.0, 0.0]
	var arm := [Vector3(0, 15, 60), Vector3(0, -25, -55), Vector3(0, 75, 25), Vector3(0, 15, 60)]
	var elbow := [60.0, 95.0, 12.0, 60.0]
	for index: int in moments.size():
		clip.key(moments[index], "Spine", Vector3(0.15 * absf(trunk[index]), trunk[index], 0))
		clip.key(moments[index], "Chest", Vector3(0, 0.4 * trunk[index], 0))
		clip.key(moments[index], "UpperChest", Vector3.ZERO)
		clip.key(moments[index], "RightShoulder", Vector3.ZERO)
		clip.key(moments[index], "RightUpperArm", arm[index])
		clip.key(moments[index], "RightLowerArm", Vector3(0, elbow[index], 0))
		clip.key(moments[index], "RightHand", Vector3.ZERO)
	return clip


## Puts a box where both hands hold it, in the character's axes in the T-pose.
func _hold(skeleton: Skeleton3D, size: Vector3, place: Transform3D, colour: Color) -> void:
	var attachment := BoneAttachment3D.new()
	attachment.bone_name = "UpperChest"
	skeleton.add_child(attachment)
	var mesh := BoxMesh.new()
	mesh.size = size
	var material := StandardMaterial3D.new()
	material.albedo_color = colour
	mesh.material = material
	var box := MeshInstance3D.new()
	box.mesh = mesh
	var rest := skeleton.get_bone_global_rest(skeleton.find_bone("UpperChest"))
	box.transform = rest.affine_inverse() * place
	attachment.add_child(box)


func close_ups() -> Dictionary[String, Array]:
	var at := func(index: int) -> Vector3: return walkers[index].global_position + Vector3.UP * 0.95
	return {
		"aim": [at.call(2), 60.0, 6.0, 3.2],
		"front": [middle() + Vector3.UP * 0.9, 3.0, 6.0, 6.0],
		"attack": [at.call(3), -55.0, 8.0, 3.4],
	}


## Checks that a clip's bones are as the clip has them, and that all characters walk.
func problems(frames: int) -> PackedStringArray:
	var found := super(frames)
	var skeleton: Skeleton3D = gait_of(walkers[1]).get_parent()
	for bone_name: String in ["LeftLowerArm", "RightLowerArm"]:
		var bone := skeleton.find_bone(bone_name)
		if skeleton.get_bone_pose_rotation(bone).angle_to(skeleton.get_bone_rest(bone).basis.get_rotation_quaternion()) < 1.0:
			found.append("%s does not carry" % bone_name)
	return found
