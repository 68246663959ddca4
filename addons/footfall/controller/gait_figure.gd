@tool
extends Node3D
## Visible part of a character: your scene, with the nodes that walk it, above a capsule that it follows smoothly.

const MODEL := "res://addons/footfall/models/locomotion.footfall"
## Factor from the highest bone, a head's joint or its end, to the body's height.
const HEIGHT_PER_BONE := 1.08
## Factor from the distance of the upper arms' joints to the body's width.
const WIDTH_PER_SHOULDERS := 1.4
## Width of a body without shoulder joints.
const WIDTH_PER_HEIGHT := 0.3
const MOST_WIDTH_PER_HEIGHT := 0.6

## The generator that walks the character and the foot placement below it; [code]null[/code] without a skeleton.
var gait: GaitGenerator3D
var placement: FootPlacement3D
## Distance from its place, upwards, metres, and its rate of change.
var _off := 0.0
var _off_speed := 0.0


## Takes on a character: an instance of its scene, with the nodes that it lacks.
func wear(scene: PackedScene, bone_map: BoneMap) -> void:
	for old: Node in get_children():
		remove_child(old)
		old.queue_free()
	gait = null
	placement = null
	if scene == null:
		return
	add_child(scene.instantiate())
	var skeleton := _skeleton()
	if skeleton == null:
		return
	# Body and steps move in the same frame, and it is physics' frame.
	skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_PHYSICS
	gait = _modifier(skeleton, &"GaitGenerator3D", 0)
	placement = _modifier(skeleton, &"FootPlacement3D", gait.get_index() + 1)
	if gait.model == null:
		gait.model = load(MODEL)
	if bone_map:
		gait.bone_map = bone_map
	gait.character = gait.get_path_to(self)
	gait.root_motion = false
	gait.speed = 0.0
	placement.follow_ground = false


## Height and width of the body in the T-pose, metres; zero without a skeleton.
func measure() -> Vector2:
	if gait == null:
		return Vector2.ZERO
	var skeleton := gait.get_skeleton()
	var from_skeleton := global_transform.affine_inverse() * skeleton.global_transform
	var top := 0.0
	for bone: int in skeleton.get_bone_count():
		top = maxf(top, (from_skeleton * skeleton.get_bone_global_rest(bone).origin).y)
	var height := HEIGHT_PER_BONE * top
	var width := WIDTH_PER_HEIGHT * height
	var left := skeleton.find_bone(_bone_name(&"LeftUpperArm"))
	var right := skeleton.find_bone(_bone_name(&"RightUpperArm"))
	if left >= 0 and right >= 0:
		var across := skeleton.get_bone_global_rest(left).origin - skeleton.get_bone_global_rest(right).origin
		width = minf(WIDTH_PER_SHOULDERS * (from_skeleton.basis * across).length(), MOST_WIDTH_PER_HEIGHT * height)
	return Vector2(height, width)


## The capsule was lifted by an edge: the figure stays, and follows from the next frames on.
func stay_below(rise: float) -> void:
	_off -= rise


## Follows the capsule for a frame: a critically damped spring, which neither jumps nor swings.
func follow(half_life: float, delta: float) -> void:
	# Half of the way is left after 1.68 of its time constants.
	var rate := 1.68 / maxf(half_life, 1e-3)
	var pull := (_off_speed + rate * _off) * delta
	var left := exp(-rate * delta)
	_off_speed = (_off_speed - rate * pull) * left
	_off = (_off + pull) * left
	position.y = _off


## Moves to the capsule's place at once.
func catch_up() -> void:
	_off = 0.0
	_off_speed = 0.0
	position.y = 0.0
	reset_physics_interpolation()
	if placement:
		placement.reset()


## The skeleton of the body: clothes may bring smaller ones.
func _skeleton() -> Skeleton3D:
	var found: Skeleton3D = null
	for skeleton: Skeleton3D in find_children("*", "Skeleton3D", true, false):
		if found == null or skeleton.get_bone_count() > found.get_bone_count():
			found = skeleton
	return found


## The skeleton's modifier of a class, or a new one at a place among its children.
func _modifier(skeleton: Skeleton3D, type: StringName, place: int) -> SkeletonModifier3D:
	var found := skeleton.find_children("*", type, false, false)
	if not found.is_empty():
		return found[0]
	var made: SkeletonModifier3D = ClassDB.instantiate(type)
	made.name = type
	skeleton.add_child(made)
	skeleton.move_child(made, place)
	return made


func _bone_name(joint: StringName) -> StringName:
	var mapped := gait.bone_map.get_skeleton_bone_name(joint) if gait.bone_map else &""
	return joint if mapped.is_empty() else mapped
