class_name NetWalker
extends Walker
## A character of a multiplayer game: steered by the peer whose it is, and the same steps on all others.

## Seconds between changes of what is asked, and what is: speed, turning.
const COURSE: Array[Vector2] = [
	Vector2(1.3, 0.0), Vector2(1.3, 0.5), Vector2(0.0, 0.0), Vector2(3.2, 0.0), Vector2(3.2, -0.4), Vector2(1.0, 0.0), Vector2(0.0, 0.0),
]
const EACH_SECS := 2.5
const SYNCHRONIZER: PackedScene = preload("res://addons/footfall/controller/gait_synchronizer.tscn")

var title := ""
var lies := false
## Set before its peer leaves, so that others do not show steps that were never finished.
var rests := false
## Time since it came and was heard of, and the greatest speed of its hips since it first was where it should be, and distance from where it came.
var secs := 0.0
var fastest := 0.0
var farthest := 0.0
## Progress as it goes over the network. A liar's is not what the character does.
var replica_state: PackedByteArray:
	get:
		return _spoilt(gait.replica_state) if lies and is_multiplayer_authority() else gait.replica_state
	set(state):
		gait.replica_state = state
var replica_identity: PackedByteArray:
	get:
		return gait.replica_identity
	set(identity):
		gait.replica_identity = identity

var _came := Vector3.ZERO
var _hips := Vector3.INF


func make(interval: float) -> void:
	build()
	gait.seed = 0
	# Until it is heard of elsewhere, it stands there.
	gait.speed = 0.0
	skeleton.modifier_callback_mode_process = Skeleton3D.MODIFIER_CALLBACK_MODE_PROCESS_IDLE
	gait.footstep.connect(_tell)
	gait.modification_processed.connect(_measure)
	gait.replica_refused.connect(func(reason: String) -> void: print("REFUSED %s %s" % [title, reason]))
	var synchronizer: MultiplayerSynchronizer = SYNCHRONIZER.instantiate()
	synchronizer.replication_interval = interval
	add_child(synchronizer)
	_came = position


func _process(delta: float) -> void:
	farthest = maxf(farthest, global_position.distance_to(_came))
	if is_multiplayer_authority() or gait.is_replica():
		secs += delta
	if is_multiplayer_authority():
		var asked := COURSE[int(secs / EACH_SECS) % COURSE.size()]
		# A stick is never still.
		gait.speed = asked.x + (0.15 * sin(9.0 * secs) if asked.x > 0.0 else 0.0)
		if rests:
			gait.speed = 0.0
			gait.turn_rate = 0.0
			return
		gait.turn_rate = asked.y + (0.3 * sin(2.0 * secs) if asked.x > 0.0 else 0.0)


func _tell(foot: StringName, place: Vector3) -> void:
	var made := "MADE" if is_multiplayer_authority() else "SHOWN"
	print("%s %s %s %.4f %.4f %.3f" % [made, title, foot, place.x, place.z, secs])


func _measure() -> void:
	var delta := get_process_delta_time()
	if bones.is_empty() or delta <= 0.0:
		return
	var hips := joint("Hips")
	if secs > 2.0 and _hips.is_finite():
		fastest = maxf(fastest, hips.distance_to(_hips) / delta)
	_hips = hips


## Lies of every kind, one a second after three honest ones.
func _spoilt(state: PackedByteArray) -> PackedByteArray:
	if state.size() < 24 or secs < 3.0:
		return state
	match int(secs) % 6:
		0:
			# Four kilometres off.
			state[16] = 0x40
		1:
			for at: int in state.size():
				state[at] = randi() % 256
		2:
			state.resize(randi() % 40)
		3:
			# Another version's.
			state[0] = 0x70
		4:
			# A little farther in every update.
			state.encode_u16(14, (state.decode_u16(14) + int(secs * 20000.0)) % 65536)
	return state
