extends TestCase
## Opens a game with the properties and methods of an earlier add-on: nothing complains, no value is lost, and everybody walks.

const GAME := "res://old_game/game.tscn"
const SENSORS: PackedStringArray = ["phone_imu", "serial_imu", "network_imu", "replay_imu"]
const MODELS := "../model_versions/v%d.footfall"


## Errors and warnings since it was made.
class Complaints:
	extends Logger
	var texts := PackedStringArray()

	func _log_error(_function: String, file: String, line: int, code: String, rationale: String, _editor: bool, _type: int, _traces: Array[ScriptBacktrace]) -> void:
		texts.append("%s (%s:%d)" % [rationale if rationale else code, file, line])


var _complaints := Complaints.new()


func _ready() -> void:
	OS.add_logger(_complaints)


func _exit_tree() -> void:
	OS.remove_logger(_complaints)


func test_an_old_game_keeps_its_values_and_walks() -> void:
	var game: Node3D = (ResourceLoader.load(GAME, "", ResourceLoader.CACHE_MODE_IGNORE) as PackedScene).instantiate()
	check(_count_values(GAME, game) > 60, "the scene holds values")
	add_child(game)
	while game.crowd.is_making():
		await get_tree().physics_frame
	var begins: Array[Vector3] = [game.get_node(^"Hero").position, game.player.position]
	var people: PackedVector3Array = game.crowd.get_positions()
	for frame: int in 240:
		await get_tree().physics_frame
	check(game.get_node(^"Hero").position.distance_to(begins[0]) > 1.5, "the hero walks")
	check(game.player.position.distance_to(begins[1]) > 1.5, "the player walks")
	check_equal(game.get_node(^"Distant").position, Vector3(8, 0, 0), "a paused walker stands")
	var walked := 0
	for index: int in people.size():
		walked += int(game.crowd.get_positions()[index].distance_to(people[index]) > 1.0)
	# A walker that turns round at the end of its path may end near its start.
	check(walked >= 10, "%d of %d walk in the crowd" % [walked, people.size()])
	check(&"left" in game.footsteps and &"right" in game.footsteps, "its script hears of both feet")
	check(game.planned > 3 and game.planted > 3 and game.steps_of_crowd > people.size(), "and of what else happens")
	game.save_and_load()
	for frame: int in 120:
		await get_tree().physics_frame
	check_equal(game.landings, 1, "landings of the player, who has jumped")
	check_equal(_complaints.texts, PackedStringArray(), "nothing complains")


func test_sensors_of_an_old_game_keep_their_values() -> void:
	for sensor: String in SENSORS:
		var path := "res://old_game/%s.tres" % sensor
		var source: Resource = load(path)
		check(_count_values(path, source) >= 2, "%s holds values" % sensor)
	check_equal(_complaints.texts, PackedStringArray(), "nothing complains")


func test_models_of_an_old_game_walk() -> void:
	for version: int in range(1, 7):
		var walker := Walker.new()
		add_child(walker)
		walker.build()
		walker.gait.model = load(MODELS % version)
		walker.walk(120)
		check(walker.position.length() > 1.0, "a model of file format %d walks" % version)
		walker.queue_free()
	check_equal(_complaints.texts, PackedStringArray(), "nothing complains")


## Compares what a text file says of nodes, or of a resource, with what they have; returns how many values there were.
func _count_values(path: String, root: Object) -> int:
	var object: Object = null
	var count := 0
	for line: String in FileAccess.get_file_as_string(path).split("\n"):
		if line.begins_with("["):
			object = root if line == "[resource]" else _node(line, root)
		var parts := line.split(" = ", true, 1)
		if object == null or parts.size() < 2 or line.begins_with("["):
			continue
		count += 1
		var found: Variant = object.get(parts[0])
		if parts[1].contains("Resource("):
			check(found != null and str(found) != "[]", "%s of %s is there" % [parts[0], object])
		else:
			check_equal(found, str_to_var(parts[1]), "%s of %s" % [parts[0], object])
	return count


## The node that a heading of a scene begins; null for other headings.
func _node(heading: String, root: Object) -> Node:
	var found := RegEx.create_from_string("^\\[node name=\"([^\"]+)\".* parent=\"([^\"]+)\"").search(heading)
	return (root as Node).get_node(found.get_string(2).path_join(found.get_string(1))) if found else null
