class_name WornSensor
## A sensor on a walker's right foot, and the body that it drives.

const DELTA := 1.0 / 60.0
const GRAVITY_MPS2 := 9.80665


## Measurements of the sensor, frame by frame: [time, force, rate].
static func measure(walker: Walker, frames: int) -> Array[Array]:
	var places: Array[Vector3] = []
	var turns: Array[Quaternion] = []
	walker.walk(frames, func() -> void:
		var foot: Transform3D = walker.bones["RightFoot"] * walker.rest("RightFoot").affine_inverse()
		turns.append(foot.basis.get_rotation_quaternion())
		places.append(foot * (walker.rest("RightFoot").origin + Vector3(0.0, -0.01, 0.07))))
	var samples: Array[Array] = []
	for n: int in range(1, places.size() - 1):
		var acceleration := (places[n + 1] - 2.0 * places[n] + places[n - 1]) / (DELTA * DELTA)
		var turned := turns[n - 1].inverse() * turns[n + 1]
		if turned.w < 0.0:
			turned = -turned
		var rate := turned.get_axis() * turned.get_angle() / (2.0 * DELTA) if turned.get_angle() > 1e-6 else Vector3.ZERO
		samples.append([n * DELTA, turns[n].inverse() * (acceleration + Vector3.UP * GRAVITY_MPS2), rate])
	return samples


## A body that no generator walks, with a reconstructor of this model file and source.
static func driven(parent: Node, model: String, source: Resource = null) -> Walker:
	var body := Walker.new()
	body.build(false)
	var node := ImuReconstructor3D.new()
	node.name = "Reconstructor"
	node.mounting = ImuReconstructor3D.ALIGNED
	if model:
		node.model = load(model)
	node.source = source
	node.modification_processed.connect(body._read_bones)
	body.skeleton.add_child(node)
	body.gait.free()
	parent.add_child(body)
	return body
