extends WalkingScene
## Feet on uneven ground: a walker on each lane of the course, with a `FootPlacement3D` below its generator.

const PLACED: PackedScene = preload("res://scenes/shared/placed_walker.tscn")
const COLOURS: Array[Color] = [
	Color("c96f53"), Color("5f8fb0"), Color("d1a24c"), Color("6fa287"), Color("b06a8e"), Color("8d7bb0"),
]
## Walkers begin and end so far from the middle of the course, metres.
const END_M := 8.0
const SPEED := 1.1
## Over the hills somebody runs.
const HILLS_LANE := 4
const RUN_SPEED := 3.4
## On the platform they go round.
const PLATFORM_SPEED := 0.7
const PLATFORM_TURN := 0.8

## Fastest that a locked sole moved over what it stands on, m/s.
var _slip := 0.0
var _soles: Array[Dictionary] = []

@onready var _course: Course = $Course


func _ready() -> void:
	_camera.distance_m = 15.0
	_camera.heading = deg_to_rad(42.0)
	_camera.height = deg_to_rad(20.0)
	for lane: int in Course.LANES.size():
		_add(lane)
	%Debug.toggled.connect(func(on: bool) -> void:
		for walker: Node3D in walkers:
			placement_of(walker).debug_draw = on)
	%Placement.toggled.connect(func(on: bool) -> void:
		for walker: Node3D in walkers:
			placement_of(walker).active = on)
	%Menu.pressed.connect(func() -> void: get_tree().change_scene_to_file("res://scenes/menu/menu.tscn"))


func placement_of(walker: Node3D) -> FootPlacement3D:
	return walker.get_node(^"%FootPlacement3D")


func _process(_delta: float) -> void:
	for lane: int in walkers.size():
		var walker := walkers[lane]
		if walker.position.z > END_M and walker.get_parent() == self:
			walker.position = Vector3(_course.lane_x(lane), 0.0, -END_M)
			walker.rotation = Vector3.ZERO
			_soles[lane].clear()
	_camera.target_position = Vector3(0, 0.9, 0)


func _add(lane: int) -> void:
	var walker: Node3D = PLACED.instantiate()
	walker.name = "Lane%d" % (lane + 1)
	Paint.apply(walker, COLOURS[lane])
	var gait := gait_of(walker)
	gait.seed = lane + 1
	gait.phase = fposmod(lane * 0.618034, 1.0)
	gait.speed = RUN_SPEED if lane == HILLS_LANE else SPEED
	if lane == Course.LANES.size() - 1:
		walker.position = Vector3(-0.75, 0.0, 0.0)
		_course.platform.add_child(walker)
		gait.speed = PLATFORM_SPEED
		gait.turn_rate = PLATFORM_TURN
	else:
		walker.position = Vector3(_course.lane_x(lane), 0.0, -END_M + 0.9 * lane)
		add_child(walker)
	placement_of(walker).foot_planted.connect(func(_foot: StringName, _at: Vector3, _normal: Vector3) -> void: footsteps += 1)
	walkers.append(walker)
	_soles.append({})
	# Soles are judged as they are drawn: the platform moves before them.
	gait.get_skeleton().skeleton_updated.connect(_watch.bind(lane))


## Notes how far locked soles moved over what supports them.
func _watch(lane: int) -> void:
	var placement := placement_of(walkers[lane])
	for foot: StringName in [&"left", &"right"]:
		var support := placement.get_foot_support(foot)
		if support == null or not placement.is_foot_planted(foot):
			_soles[lane].erase(foot)
			continue
		var place := support.global_transform.affine_inverse() * placement.get_foot_transform(foot).origin
		if foot in _soles[lane] and _soles[lane][foot][0] == support:
			_slip = maxf(_slip, _soles[lane][foot][1].distance_to(place) * 60.0)
		_soles[lane][foot] = [support, place]


func close_ups() -> Dictionary[String, Array]:
	var at := func(lane: int) -> Vector3: return walkers[lane].global_position + Vector3.UP * 0.75
	return {
		"ramp": [at.call(0), 90.0, 4.0, 3.6],
		"stairs": [at.call(1), 80.0, 8.0, 3.6],
		"rubble": [at.call(2), 325.0, 16.0, 3.4],
		"across": [at.call(3), 5.0, 8.0, 3.4],
		"platform": [at.call(5), 320.0, 14.0, 4.2],
		"hills": [at.call(HILLS_LANE), 66.0, 9.0, 4.4],
	}


func problems(frames: int) -> PackedStringArray:
	var found := PackedStringArray()
	if footsteps < walkers.size() * (frames / 60.0 - 1.5):
		found.append("%d footsteps in %d frames" % [footsteps, frames])
	if _slip > 0.02:
		found.append("a locked foot moved at %.3f m/s" % _slip)
	return found
