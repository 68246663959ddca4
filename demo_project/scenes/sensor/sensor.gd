extends WalkingScene
## A walker wears a sensor on the right foot; all that the second one knows is what this sensor measures.

const MODEL: ImuModel = preload("res://addons/footfall/models/right_foot.footimu")
## Place of the sensor on the instep, metres from the ankle.
const ON_THE_FOOT := Vector3(0.0, -0.01, 0.07)

var _leader: GaitGenerator3D
var _driven: ImuReconstructor3D


func _ready() -> void:
	_camera.distance_m = 6.5
	_camera.heading = deg_to_rad(24.0)
	_camera.height = deg_to_rad(12.0)
	_leader = add_walker("Leader", Vector3(1.1, 0.0, 0.0), Color("c96f53"))
	Paint.label(walkers[0], "sensor")
	_add_driven()
	var source := NodeImuSource.new()
	source.node = _add_sensor(_leader.get_skeleton()).get_path()
	_driven.source = source
	follow(%Panel)


func _process(_delta: float) -> void:
	_camera.target_position = middle() + Vector3.UP * 0.85
	%Behaviour.text = "the sensor says: %s" % _driven.get_behaviour()


## A character with a reconstructor in place of the generator.
func _add_driven() -> void:
	var character: Node3D = WALKER.instantiate()
	character.name = "Driven"
	character.position = Vector3(-1.1, 0.0, 0.0)
	Paint.apply(character, Color("5f8fb0"))
	Paint.label(character, "driven")
	var gait := gait_of(character)
	_driven = ImuReconstructor3D.new()
	_driven.model = MODEL
	_driven.mounting = ImuReconstructor3D.ALIGNED
	_driven.footstep.connect(func(foot: StringName, at: Vector3) -> void:
		footsteps += 1
		_footprints.mark(foot, at, character))
	gait.get_parent().add_child(_driven)
	gait.free()
	add_child(character)
	walkers.append(character)


## Straps a node to the right foot that looks ahead while the walker stands.
func _add_sensor(skeleton: Skeleton3D) -> Node3D:
	var strap := BoneAttachment3D.new()
	strap.bone_name = "RightFoot"
	var rest := skeleton.get_bone_global_rest(skeleton.find_bone(strap.bone_name))
	var sensor := Node3D.new()
	sensor.transform = rest.affine_inverse() * Transform3D(Basis(Vector3.UP, PI), rest.origin + ON_THE_FOOT)
	strap.add_child(sensor)
	skeleton.add_child(strap)
	return sensor


func gait_of(walker: Node3D) -> GaitGenerator3D:
	return walker.get_node_or_null(^"%GaitGenerator3D")


func set_all(property: StringName, value: Variant) -> void:
	_leader.set(property, value)


func close_ups() -> Dictionary[String, Array]:
	var at := func(index: int) -> Vector3: return walkers[index].global_position + Vector3.UP * 0.9
	return {
		"side": [at.call(1), 90.0, 5.0, 3.4],
		"front": [at.call(1), 3.0, 6.0, 3.4],
		"three_quarter": [at.call(1), 38.0, 12.0, 3.9],
	}


## Walkers that did not keep up.
func problems(frames: int) -> PackedStringArray:
	var found := PackedStringArray()
	var ways: Array[float] = []
	for index: int in walkers.size():
		ways.append(walkers[index].global_position.distance_to(_starts[index]))
	if ways[1] < 0.7 * ways[0] or ways[1] > 1.3 * ways[0]:
		found.append("the sensor's wearer went %.2f m and who is driven by it %.2f" % ways)
	if frames > 120 and _driven.get_behaviour() != &"walk":
		found.append("the walk is taken for a %s" % _driven.get_behaviour())
	return found
