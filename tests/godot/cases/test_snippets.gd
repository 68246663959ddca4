extends TestCase
## Every GDScript snippet of the pages that users read runs as it stands, without an error or a warning.
##
## A comment before the snippet names the scene that it runs in, a method of this file: `<!-- runs in: walker -->`. A snippet
## without `extends` is the script of that scene's root.

const PAGES: PackedStringArray = ["README.md", "addons/footfall/README.md", "addons/footfall/SENSORS.md"]
const FRAMES := 90


## Notes errors and warnings of everybody while it is there.
class Complaints:
	extends Logger
	var texts := PackedStringArray()

	func _log_error(_function: String, file: String, line: int, code: String, rationale: String, _editor: bool, _type: int, _traces: Array[ScriptBacktrace]) -> void:
		texts.append("%s (%s:%d)" % [rationale if rationale else code, file, line])


func test_every_snippet_runs_without_an_error() -> void:
	var root := ProjectSettings.globalize_path("res://").path_join("../..").simplify_path()
	var run := 0
	for page: String in PAGES:
		for snippet: Dictionary in _snippets(FileAccess.get_file_as_string(root.path_join(page))):
			var place := "%s:%d" % [page, snippet.line]
			check(has_method("_" + snippet.scene), "%s: `<!-- runs in: … -->` before it names a scene, not \"%s\"" % [place, snippet.scene])
			if has_method("_" + snippet.scene):
				await _run(place, snippet.source, call("_" + snippet.scene))
				run += 1
	check(run >= 2, "snippets were found: %d" % run)


func _run(place: String, source: String, scene: Node) -> void:
	var complaints := Complaints.new()
	OS.add_logger(complaints)
	var script := GDScript.new()
	script.source_code = source if source.contains("extends ") else "extends %s\n%s" % [scene.get_class(), source]
	var error := script.reload()
	check_equal(error, OK, "%s compiles" % place)
	if error == OK:
		scene.set_script(script)
		add_child(scene)
		for frame: int in FRAMES:
			await get_tree().physics_frame
	OS.remove_logger(complaints)
	check_equal(complaints.texts, PackedStringArray(), "%s complains of nothing" % place)
	scene.queue_free()
	# A snippet may have opened a port.
	multiplayer.multiplayer_peer = OfflineMultiplayerPeer.new()
	await get_tree().process_frame


## The fenced GDScript blocks of a page: line, source and scene.
func _snippets(text: String) -> Array[Dictionary]:
	var found: Array[Dictionary] = []
	var lines := text.split("\n")
	var comment := RegEx.create_from_string("^<!-- runs in: (\\w+) -->$")
	for index: int in lines.size():
		if lines[index].strip_edges() != "```gdscript":
			continue
		var above := comment.search(lines[index - 1].strip_edges())
		var source := PackedStringArray()
		var end := index + 1
		while end < lines.size() and lines[end].strip_edges() != "```":
			source.append(lines[end])
			end += 1
		found.append({ line = index + 1, source = "\n".join(source) + "\n", scene = above.get_string(1) if above else "" })
	return found


## A level with a floor and, as `Character`, an imported character with a `GaitGenerator3D` under its skeleton.
func _level() -> Node3D:
	var level := Node3D.new()
	level.add_child(_floor())
	level.add_child(_character())
	return level


## A `CharacterBody3D` on a floor with a capsule and, as `Character`, an imported character with its generator.
## A level with a `MultiplayerSpawner` that spawns into it.
func _spawner() -> Node3D:
	var level := Node3D.new()
	var spawner := MultiplayerSpawner.new()
	spawner.name = "MultiplayerSpawner"
	spawner.spawn_path = ^".."
	level.add_child(spawner)
	level.add_child(_floor())
	return level


func _body() -> CharacterBody3D:
	var body := CharacterBody3D.new()
	var shape := CollisionShape3D.new()
	shape.shape = CapsuleShape3D.new()
	shape.position.y = 1.0
	body.add_child(shape)
	body.add_child(_character())
	var ground := _floor()
	ground.top_level = true
	body.add_child(ground)
	return body


## A level in which an `AnimationPlayer` has the clips `wave` and `idle`, and an `AnimationTree` the states `idle` and `gait`.
func _animated() -> Node3D:
	var level := _level()
	var player := AnimationPlayer.new()
	player.name = "AnimationPlayer"
	var library := AnimationLibrary.new()
	for clip: StringName in [&"wave", &"idle"]:
		library.add_animation(clip, Animation.new())
	player.add_animation_library(&"", library)
	level.add_child(player)
	var states := AnimationNodeStateMachine.new()
	for state: StringName in [&"idle", &"gait"]:
		var clip := AnimationNodeAnimation.new()
		clip.animation = &"idle"
		states.add_node(state, clip)
	states.add_transition(&"Start", &"gait", AnimationNodeStateMachineTransition.new())
	var tree := AnimationTree.new()
	tree.name = "AnimationTree"
	tree.tree_root = states
	tree.anim_player = NodePath("../AnimationPlayer")
	level.add_child(tree)
	return level


## A level with a floor and the controller, whose character came with a clip in which it waves.
func _player() -> Node3D:
	var root: Node3D = Skinned.scene().instantiate()
	var skeleton: Skeleton3D = root.find_children("*", "Skeleton3D", true, false)[0]
	skeleton.name = "Skeleton3D"
	var library := AnimationLibrary.new()
	library.add_animation(&"wave", Rigs.wave(skeleton, "RightUpperArm", "RightLowerArm"))
	var clips := AnimationPlayer.new()
	clips.name = "AnimationPlayer"
	clips.add_animation_library(&"", library)
	root.add_child(clips)
	clips.owner = root
	var scene := PackedScene.new()
	scene.pack(root)
	root.free()
	var player: GaitCharacter3D = preload("res://addons/footfall/controller/gait_character_3d.tscn").instantiate()
	player.character_scene = scene
	var level := Node3D.new()
	level.add_child(_floor())
	level.add_child(player)
	return level


func _character() -> Node3D:
	var character: Node3D = Skinned.scene().instantiate()
	character.name = "Character"
	var skeleton: Skeleton3D = character.find_children("*", "Skeleton3D", true, false)[0]
	skeleton.name = "Skeleton3D"
	var gait := GaitGenerator3D.new()
	gait.name = "GaitGenerator3D"
	gait.model = load(Walker.MODEL)
	skeleton.add_child(gait)
	return character


func _floor() -> StaticBody3D:
	var ground := StaticBody3D.new()
	var shape := CollisionShape3D.new()
	shape.shape = WorldBoundaryShape3D.new()
	ground.add_child(shape)
	return ground
