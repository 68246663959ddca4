extends TestCase
## Styles made of animations that a game has.

const SPEED := 1.05
const RATE := 30.0


## A character that walks on the spot, and what its bones did, as an animation has it.
func _recorded(walker: Walker) -> Animation:
	walker.gait.root_motion = false
	walker.gait.variation = 0.0
	walker.gait.speed = SPEED
	add_child(walker)
	walker.walk(60)
	var animation := Animation.new()
	animation.step = 1.0 / RATE
	animation.length = 180.0 / RATE
	var hips := walker.skeleton.find_bone("Hips")
	for bone: int in walker.skeleton.get_bone_count():
		var track := animation.add_track(Animation.TYPE_ROTATION_3D)
		animation.track_set_path(track, NodePath("Skeleton3D:" + walker.skeleton.get_bone_name(bone)))
	var way := animation.add_track(Animation.TYPE_POSITION_3D)
	animation.track_set_path(way, NodePath("Skeleton3D:Hips"))
	for frame: int in 181:
		walker.step(1.0 / RATE)
		for bone: int in walker.skeleton.get_bone_count():
			animation.rotation_track_insert_key(bone, frame / RATE, walker.bone_poses[bone].basis.get_rotation_quaternion())
		animation.position_track_insert_key(way, frame / RATE, walker.bone_poses[hips].origin)
	return animation


func test_an_animation_in_place_becomes_a_style_of_its_speed() -> void:
	var walker := Walker.new().build()
	var animation := _recorded(walker)
	var maker := GaitStyleMaker.new()
	check(maker.make_style(walker.gait.model, [animation], "alone") == null, "an animation alone is not enough")
	check_contains(maker.get_message(), "skeleton", "and the message says so")
	maker.skeleton = walker.skeleton
	var style: GaitStyle = maker.make_style(walker.gait.model, [animation], "mine")
	check(style != null, "a style is made: " + maker.get_message())
	if style:
		check_equal(style.get_style_name(), "mine", "name")
		check_below(absf(style.get_usual_speed() / SPEED - 1.0), 0.05, "speed %.3f" % style.get_usual_speed())
	check_equal(maker.get_message(), "", "six seconds are no thin style")


func test_a_scene_with_animations_becomes_a_style() -> void:
	var walker := Walker.new().build()
	var animation := _recorded(walker)
	var root := Node3D.new()
	# A rig in centimetres under a small node.
	var armature := Node3D.new()
	armature.scale = Vector3.ONE * 0.01
	root.add_child(armature)
	armature.owner = root
	var skeleton := Skeleton3D.new()
	skeleton.name = "Skeleton3D"
	for bone: int in walker.skeleton.get_bone_count():
		skeleton.add_bone(walker.skeleton.get_bone_name(bone))
		skeleton.set_bone_parent(bone, walker.skeleton.get_bone_parent(bone))
		var rest := walker.skeleton.get_bone_rest(bone)
		skeleton.set_bone_rest(bone, Transform3D(rest.basis, 100.0 * rest.origin))
	armature.add_child(skeleton)
	skeleton.owner = root
	var way := animation.get_track_count() - 1
	for key: int in animation.track_get_key_count(way):
		animation.track_set_key_value(way, key, 100.0 * (animation.track_get_key_value(way, key) as Vector3))
	var library := AnimationLibrary.new()
	library.add_animation("walk", animation)
	var player := AnimationPlayer.new()
	player.add_animation_library("", library)
	root.add_child(player)
	player.owner = root
	var scene := PackedScene.new()
	scene.pack(root)
	root.free()
	var maker := GaitStyleMaker.new()
	var style: GaitStyle = maker.make_style(walker.gait.model, [scene], "scene")
	check(style != null, "a style is made: " + maker.get_message())
	if style:
		check_below(absf(style.get_usual_speed() / SPEED - 1.0), 0.05, "speed %.3f" % style.get_usual_speed())


func test_what_is_no_clip_is_refused_by_name() -> void:
	var model: GaitModel = load(Walker.MODEL)
	var maker := GaitStyleMaker.new()
	begin_expected_errors()
	for clips: Array in [[], [7], ["res://nothing.glb"], [PackedScene.new()]]:
		check(maker.make_style(model, clips, "none") == null, "no style of %s" % [clips])
		check(not maker.get_message().is_empty(), "a message for %s" % [clips])
	end_expected_errors()
