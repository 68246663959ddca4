extends TestCase
## Styles made of animations that a game has.

const SPEED := 1.05


func _check_style(maker: GaitStyleMaker, style: GaitStyle, animation: Animation, what: String) -> void:
	check(style != null, "a style is made of %s: %s" % [what, maker.get_message()])
	if style:
		var speed: float = animation.get_meta("speed")
		check_below(absf(style.get_usual_speed() / speed - 1.0), 0.05, "%s: speed %.3f" % [what, style.get_usual_speed()])
		check_contains(maker.get_message(), "only 2 steps", "%s is told to be thin" % what)


func test_a_loop_of_a_scene_becomes_a_style_that_walks_as_fast() -> void:
	var model: GaitModel = load(Walker.MODEL)
	for speed: float in [0.8, 1.3]:
		var animation := GameClip.loop(self, speed)
		var maker := GaitStyleMaker.new()
		var style: GaitStyle = maker.make_style(model, [GameClip.scene({walk = animation})], "scene")
		_check_style(maker, style, animation, "a scene")
		if not style:
			return
		check_equal(style.get_style_name(), "scene", "name")
		var walker := Walker.new()
		walker.gait.styles = [style]
		walker.gait.style_weights = [1.0]
		walker.gait.speed = animation.get_meta("speed")
		add_child(walker.build())
		walker.walk(240)
		var begin := walker.global_position
		var stepped := walker.footsteps.size()
		walker.walk(600)
		var speed_now := walker.global_position.distance_to(begin) / 10.0
		check_below(absf(speed_now / walker.gait.speed - 1.0), 0.05, "it walks at %.3f m/s" % speed_now)
		var steps := (walker.footsteps.size() - stepped) / 10.0
		check_below(absf(steps * animation.length / 2.0 - 1.0), 0.08, "with %.2f steps a second" % steps)


func test_animations_alone_need_their_skeleton() -> void:
	var model: GaitModel = load(Walker.MODEL)
	var animation := GameClip.loop(self, SPEED)
	var library := AnimationLibrary.new()
	library.add_animation("walk", animation)
	var maker := GaitStyleMaker.new()
	for clip: Resource in [animation, library]:
		check(maker.make_style(model, [clip], "alone") == null, "%s alone is not enough" % clip.get_class())
		check_contains(maker.get_message(), "skeleton", "and the message says so")
	# Wherever it stands and faces.
	var character := GameClip.character()
	character.transform = Transform3D(Basis(Vector3.UP, 2.0), Vector3(40.0, 3.0, -7.0))
	add_child(character)
	maker.skeleton = character.get_node(GameClip.SKELETON)
	for clip: Resource in [animation, library]:
		var style: GaitStyle = maker.make_style(model, [clip], "mine")
		_check_style(maker, style, animation, clip.get_class())
	var other := Skeleton3D.new()
	other.add_bone("Lid")
	add_child(other)
	maker.skeleton = other
	check(maker.make_style(model, [animation], "box") == null, "a box does not walk")
	check_contains(maker.get_message(), "rotates no bone", "and the message says so")


func test_files_and_single_animations_are_taken() -> void:
	var model: GaitModel = load(Walker.MODEL)
	var animation := GameClip.loop(self, SPEED)
	var folder := "res://scratch_clips"
	DirAccess.make_dir_absolute(folder)
	var file := folder + "/hero.tscn"
	ResourceSaver.save(GameClip.scene({Walk = animation, Idle = GameClip.still(animation)}), file)
	var maker := GaitStyleMaker.new()
	var style: GaitStyle = maker.make_style(model, [file + "#Walk"], "one")
	_check_style(maker, style, animation, "one of two")
	check(not maker.get_message().contains("Idle"), "the other was left alone: " + maker.get_message())
	_check_style(maker, maker.make_style(model, [file], "all"), animation, "a file")
	check_contains(maker.get_message(), "hero.tscn#Idle", "nothing is learned from standing")
	check(maker.make_style(model, [file + "#Run"], "none") == null, "no such animation")
	check_contains(maker.get_message(), "Idle, Walk", "those that there are")
	var saved := folder + "/one.footstyle"
	FileAccess.open(saved, FileAccess.WRITE).store_buffer(style.data)
	var loaded: GaitStyle = load(saved)
	check_equal(loaded.get_style_name(), "one", "its data are a file")
	DirAccess.remove_absolute(file)
	DirAccess.remove_absolute(saved)
	DirAccess.remove_absolute(folder)


## Every one says what is wrong with which clip, and what to do.
func test_what_makes_no_style_is_named_with_what_to_do() -> void:
	var model: GaitModel = load(Walker.MODEL)
	var walk := GameClip.loop(self, SPEED)
	var short: Animation = walk.duplicate()
	short.length = 0.5
	var strange := GameClip.character()
	var skeleton: Skeleton3D = strange.get_node(GameClip.SKELETON)
	skeleton.set_bone_name(skeleton.find_bone("mixamorig_LeftFoot"), "flap")
	var library := AnimationLibrary.new()
	library.add_animation("walk", walk)
	var player := AnimationPlayer.new()
	player.add_animation_library("", library)
	strange.add_child(player)
	var no_skeleton := Node3D.new()
	no_skeleton.add_child(MeshInstance3D.new())
	var maker := GaitStyleMaker.new()
	for case: Array in [
		[[], ["Give at least one clip"]],
		[[7], ["7", "Give scenes"]],
		[["res://nothing.glb"], ["nothing.glb"]],
		[["res://nothing.fbx"], ["nothing.fbx does not exist", "Choose"]],
		[["/elsewhere/hero.fbx"], ["hero.fbx", "into the project"]],
		[[PackedScene.new()], ["empty scene", "Choose the scene of a character"]],
		[[GameClip.packed(no_skeleton)], ["no Skeleton3D", "Choose"]],
		[[GameClip.packed(GameClip.character())], ["no AnimationPlayer", "Choose"]],
		[[load(Walker.MODEL)], ["locomotion.footfall is a GaitModel", "Choose"]],
		[[GameClip.scene({still = GameClip.still(walk)})], ["#still", "no two consecutive steps", "Choose walking clips"]],
		[[GameClip.scene({short = short})], ["#short (0.5 s)", "no two consecutive steps"]],
		[[GameClip.packed(strange)], ["#walk", "LeftFoot", "BoneMap"]],
	]:
		check(maker.make_style(model, case[0], "none") == null, "no style of %s" % [case[0]])
		for words: String in case[1]:
			check_contains(maker.get_message().to_lower(), words.to_lower(), "message for %s" % [case[0]])
