extends WalkingScene
## Any humanoid walks: drop a .glb or .gltf file onto the window, or choose one.

const PLACED: PackedScene = preload("res://characters/mannequin.glb")
const MODEL: GaitModel = preload("res://addons/footfall/models/locomotion.footfall")
## The names of the mannequin's bones here, as in characters from Mixamo, so that there is something to recognise.
const OTHER_NAMES: Dictionary[String, String] = {
	"Hips": "mixamorig:Hips", "Spine": "mixamorig:Spine", "Chest": "mixamorig:Spine1", "UpperChest": "mixamorig:Spine2",
	"Neck": "mixamorig:Neck", "Head": "mixamorig:Head",
	"LeftShoulder": "mixamorig:LeftShoulder", "LeftUpperArm": "mixamorig:LeftArm", "LeftLowerArm": "mixamorig:LeftForeArm",
	"LeftHand": "mixamorig:LeftHand", "LeftUpperLeg": "mixamorig:LeftUpLeg", "LeftLowerLeg": "mixamorig:LeftLeg",
	"LeftFoot": "mixamorig:LeftFoot", "LeftToes": "mixamorig:LeftToeBase",
}


func _ready() -> void:
	_camera.distance_m = 5.0
	_camera.height = deg_to_rad(10.0)
	get_window().files_dropped.connect(func(files: PackedStringArray) -> void: load_file(files[0]))
	%Open.pressed.connect(func() -> void: %Files.popup_centered_ratio(0.7))
	%Files.file_selected.connect(load_file)
	%Menu.pressed.connect(func() -> void: get_tree().change_scene_to_file("res://scenes/menu/menu.tscn"))
	var stranger: Node3D = PLACED.instantiate()
	_rename_bones(stranger)
	_walk(stranger)


## Gives the bones of the mannequin, and the binds of its skins, names that are not the humanoid profile's.
func _rename_bones(character: Node3D) -> void:
	var names: Dictionary[StringName, StringName] = {}
	for joint: String in OTHER_NAMES:
		for side: String in ["Left", "Right"]:
			names[joint.replace("Left", side)] = OTHER_NAMES[joint].replace("Left", side)
	var skeleton: Skeleton3D = character.get_node(^"%GeneralSkeleton")
	for bone: int in skeleton.get_bone_count():
		var own: StringName = skeleton.get_bone_name(bone)
		skeleton.set_bone_name(bone, names.get(own, own))
	for mesh: MeshInstance3D in skeleton.find_children("*", "MeshInstance3D"):
		mesh.skin = mesh.skin.duplicate()
		for bind: int in mesh.skin.get_bind_count():
			var own: StringName = mesh.skin.get_bind_name(bind)
			mesh.skin.set_bind_name(bind, names.get(own, own))


## Reads a character from a file and lets it walk; says so when it cannot.
func load_file(path: String) -> void:
	var document := GLTFDocument.new()
	var state := GLTFState.new()
	if document.append_from_file(path, state) != OK:
		%Problem.text = "%s is no glTF file that can be read." % path.get_file()
		return
	var scene := document.generate_scene(state)
	if not scene is Node3D:
		%Problem.text = "%s has no character." % path.get_file()
		return
	_walk(scene)


func _walk(character: Node3D) -> void:
	var skeletons := character.find_children("*", "Skeleton3D", true, false)
	if skeletons.is_empty():
		%Problem.text = "The file has no skeleton."
		character.free()
		return
	for walker: Node3D in walkers:
		walker.queue_free()
	walkers.clear()
	var gait := GaitGenerator3D.new()
	gait.name = "GaitGenerator3D"
	gait.model = MODEL
	gait.footstep.connect(func(foot: StringName, at: Vector3) -> void:
		footsteps += 1
		_footprints.mark(foot, at, character))
	add_child(character)
	skeletons[0].add_child(gait)
	gait.owner = character
	gait.unique_name_in_owner = true
	walkers.append(character)
	%Problem.text = "\n".join(gait.get_problems())


func _process(_delta: float) -> void:
	_camera.target_position = middle() + Vector3.UP * 0.9


func close_ups() -> Dictionary[String, Array]:
	return {"side": [walkers[0].global_position + Vector3.UP * 0.9, 70.0, 6.0, 3.4]}
