extends TestCase
## Choice of the node that travels.


func _skeleton() -> Walker:
	var walker := Walker.new().build()
	return walker


func test_a_character_body_travels_with_what_it_holds() -> void:
	var body := CharacterBody3D.new()
	var model := Node3D.new()
	var walker := _skeleton()
	body.add_child(model)
	model.add_child(walker)
	add_child(body)
	walker.walk(60)
	check(body.global_position.z > 0.3, "the body travels")
	check_equal(model.transform, Transform3D.IDENTITY, "what it holds stays where it is in it")


func test_a_character_in_the_middle_of_its_capsule() -> void:
	var body := CharacterBody3D.new()
	var walker := _skeleton()
	walker.position.y = -0.9
	body.position.y = 0.9
	body.add_child(walker)
	add_child(body)
	walker.walk(200)
	check_near(body.global_position.y, 0.9, 1e-4, "keeps its height")
	for footstep: Array in walker.footsteps:
		check_near(footstep[1].y, 0.0, 1e-3, "footsteps on the ground")


func test_the_top_of_the_imported_scene_travels() -> void:
	var top := Node3D.new()
	var armature := Node3D.new()
	var walker := _skeleton()
	top.add_child(armature)
	armature.add_child(walker)
	for node: Node in [armature, walker, walker.skeleton]:
		node.owner = top
	add_child(top)
	walker.walk(60)
	check(top.global_position.z > 0.3, "the top travels")
	check_equal(armature.transform, Transform3D.IDENTITY, "the armature stays where it is in it")


func test_a_chosen_character_travels() -> void:
	var chosen := Node3D.new()
	var walker := _skeleton()
	chosen.add_child(walker)
	add_child(chosen)
	walker.gait.character = walker.gait.get_path_to(chosen)
	walker.walk(60)
	check(chosen.global_position.z > 0.3, "the chosen node travels")
	check_equal(walker.transform, Transform3D.IDENTITY, "the node below it does not")


func test_a_wrong_character_is_a_problem() -> void:
	var walker := _skeleton()
	add_child(walker)
	var beside := Node3D.new()
	add_child(beside)
	walker.gait.character = ^"nothing/there"
	check_contains("\n".join(walker.gait.get_problems()), "nothing/there", "names the path")
	walker.gait.character = walker.gait.get_path_to(beside)
	check_contains("\n".join(walker.gait.get_problems()), "does not contain", "says why")


func test_the_game_may_move_the_character_at_any_time() -> void:
	var walker := _skeleton()
	add_child(walker)
	walker.walk(100)
	walker.global_position = Vector3(50, 3, 50)
	walker.footsteps.clear()
	walker.walk(100)
	check_near(walker.global_position.y, 3.0, 1e-4, "it walks on from there")
	check(walker.global_position.z > 51.0 and walker.global_position.z < 54.0, "at its pace")
	for footstep: Array in walker.footsteps:
		check_below(footstep[1].distance_to(walker.global_position), 3.0, "footsteps are where it is now")
