extends TestCase
## Walkers far from the camera, who repeat their steps.

const MODEL := preload("res://addons/footfall/models/locomotion.footfall")
const DT := 1.0 / 60.0


func _crowd(configure: Callable) -> GaitCrowd3D:
	var crowd := GaitCrowd3D.new()
	crowd.model = MODEL
	crowd.character = Skinned.scene()
	crowd.count = 0
	crowd.behaviour = GaitCrowd3D.SCRIPTED
	crowd.playing = false
	configure.call(crowd)
	add_child(crowd)
	return crowd


func test_walkers_far_away_find_the_ground() -> void:
	var slope := StaticBody3D.new()
	var shape := CollisionShape3D.new()
	shape.shape = BoxShape3D.new()
	shape.shape.size = Vector3(40, 1, 80)
	slope.add_child(shape)
	add_child(slope)
	slope.transform = Transform3D(Basis(Vector3.RIGHT, -0.1), Vector3.ZERO).translated_local(Vector3(0, -0.5, 0))
	var camera := Camera3D.new()
	add_child(camera)
	camera.look_at_from_position(Vector3(0, 2, -60), Vector3(0, 1, 0))
	camera.make_current()
	var crowd := _crowd(func(made: GaitCrowd3D) -> void:
		made.ground_mask = 1
		made.full_count = 0
		made.near_count = 0)
	crowd.add_agents([Vector3.ZERO], [0.0])
	crowd.set_turn_rates([0.0])
	for frame: int in 3:
		await get_tree().physics_frame
	var landings := [0]
	crowd.footsteps.connect(func(agents: PackedInt32Array, _feet: PackedByteArray, _places: PackedVector3Array) -> void:
		landings[0] += agents.size())
	for frame: int in 480:
		crowd.advance(DT)
	check_equal(crowd.get_tiers()[0], 2, "it is far away")
	var place := crowd.get_positions()[0]
	check(place.z > 6.0, "it walks: %s" % place)
	check_near(place.y, place.z * tan(0.1), 0.15, "it rises with the ground")
	check_near(landings[0], 8 * 1.9, 4, "footsteps")
	camera.free()
	slope.free()
