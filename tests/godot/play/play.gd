extends Node
## A test that is a game: laps of play, each with scenes changed, crowds that come and go, saving and loading. Every lap plays the same.
##
## It prints a line a lap and exits with 1 when errors were logged, memory or objects grew from lap to lap, or a frame took too long.
## After `--`, `--minutes N` plays so long; start Godot with `--fixed-fps 60`, so that time runs by frames and as fast as they come.

const TOWN: PackedScene = preload("res://play/town.tscn")
const SAVED := "user://play_saved.tres"
const FRAMES_PER_SECOND := 60
const USUAL_MINUTES := 1.5
## Frames of a lap, and when in it things happen.
const LAP := 1200
const CROWDS: Array[Vector2i] = [Vector2i(120, 480), Vector2i(720, 1140)]
const SAVES := 560
## Longest time that a frame of everything here may last, milliseconds: a game's frame at 60 a second.
const FRAME_MS := 16.0
## Usual frame of a machine as fast as that limit is meant for, milliseconds. The limit grows in proportion on slower ones.
const USUAL_MS := 6.0
const SLOW_SHOWN := 5
## Most further laps that are played when a frame was slow in every lap: crowds think on all processors, and other programs on a busy machine may
## have had one of them in each of a few laps.
const LAPS_TO_CONFIRM := 10
## Laps until caches are full and every allocation has been made once.
const WARM_UP := 2
## Greatest growth from the warm-up to the end: bytes for logs and fragments, nothing else.
const GROWTH: Dictionary[StringName, int] = {
	&"static_bytes": 256 * 1024,
	&"resident_bytes": 6 * 1024 * 1024,
	&"objects": 0,
	&"orphan_nodes": 0,
}


## Counts what anybody complains of.
class Complaints:
	extends Logger
	var texts := PackedStringArray()

	func _log_error(_function: String, file: String, line: int, code: String, rationale: String, _editor: bool, _type: int, _traces: Array[ScriptBacktrace]) -> void:
		texts.append("%s (%s:%d)" % [rationale if rationale else code, file, line])


var _complaints := Complaints.new()
var _problems := PackedStringArray()
## For every frame of a lap, how long it took in the lap in which it was fastest, microseconds: of half an hour's frames all would be
## memory that grows.
var _least := PackedInt64Array()
var _frame_began := 0


func _ready() -> void:
	OS.add_logger(_complaints)
	var arguments := OS.get_cmdline_user_args()
	var flag := arguments.find("--minutes")
	var minutes := arguments[flag + 1].to_float() if flag >= 0 else USUAL_MINUTES
	var laps := maxi(ceili(minutes * 60.0 * FRAMES_PER_SECOND / LAP), WARM_UP + 3)
	_least.resize(LAP)
	_least.fill(1 << 62)
	var early: Dictionary[StringName, int] = {}
	var late: Dictionary[StringName, int] = {}
	for lap: int in laps:
		await _lap()
		late = _ledger()
		if lap == WARM_UP:
			early = late
		print("lap %d of %d: %s" % [lap + 1, laps, late])
	for lap: int in LAPS_TO_CONFIRM:
		var ranked := _ranked()
		var slowest_ms := ranked[-1].x / 1000.0
		if slowest_ms <= _longest_ms(ranked):
			break
		print("a frame was slow in every lap, %.1f ms at its fastest: another lap" % slowest_ms)
		await _lap()
		late = _ledger()
	_judge_growth(early, late)
	_judge_frames()
	OS.remove_logger(_complaints)
	for text: String in _complaints.texts.slice(0, 10):
		_problems.append("logged: " + text)
	for problem: String in _problems:
		printerr("PLAY FAILED: ", problem)
	if _problems.is_empty():
		print("PLAY OK: %.1f minutes" % (laps * LAP / 60.0 / FRAMES_PER_SECOND))
	get_tree().quit(mini(_problems.size(), 1))


func _lap() -> void:
	var town: Node3D = TOWN.instantiate()
	add_child(town)
	# Scenes change between two frames of play.
	await _settle()
	_frame_began = _clock()
	for frame: int in LAP:
		for crowd: Vector2i in CROWDS:
			if frame == crowd.x:
				town.bring_crowd()
			elif frame == crowd.y:
				town.send_crowd_away()
		if frame == SAVES:
			town = await _save_and_load(town)
		await get_tree().process_frame
		_note(frame)
	_problems.append_array(town.problems())
	town.queue_free()
	await _settle()


## The scene changes; who walked in it walks on where it was, in the middle of a step.
func _save_and_load(town: Node3D) -> Node3D:
	ResourceSaver.save(town.saved(), SAVED)
	var before: PackedVector3Array = town.places()
	town.queue_free()
	await _settle()
	var loaded: Node3D = TOWN.instantiate()
	loaded.saved_game = ResourceLoader.load(SAVED, "", ResourceLoader.CACHE_MODE_IGNORE)
	add_child(loaded)
	await get_tree().process_frame
	var after: PackedVector3Array = loaded.places()
	for index: int in before.size():
		if before[index].distance_to(after[index]) > 0.2:
			_problems.append("walker %d was saved at %s and loaded at %s" % [index, before[index], after[index]])
	_frame_began = _clock()
	return loaded


## Until what was freed is gone.
func _settle() -> void:
	for frame: int in 3:
		await get_tree().process_frame


func _note(frame: int) -> void:
	var now := _clock()
	_least[frame] = mini(_least[frame], now - _frame_began)
	_frame_began = now


## Microseconds, without those in which other programs had the processor; Linux tells how long the main thread waited for one.
func _clock() -> int:
	var schedule := FileAccess.open("/proc/self/schedstat", FileAccess.READ)
	var waited := schedule.get_line().get_slice(" ", 1).to_int() / 1000 if schedule else 0
	return Time.get_ticks_usec() - waited


## Returns the memory and the objects in use at the end of a lap.
func _ledger() -> Dictionary[StringName, int]:
	# A file without a length: it has to be read by lines. Other systems do not tell.
	var process := FileAccess.open("/proc/self/statm", FileAccess.READ)
	return {
		&"static_bytes": OS.get_static_memory_usage(),
		&"resident_bytes": process.get_line().get_slice(" ", 1).to_int() * 4096 if process else 0,
		&"objects": int(Performance.get_monitor(Performance.OBJECT_COUNT)),
		&"orphan_nodes": int(Performance.get_monitor(Performance.OBJECT_ORPHAN_NODE_COUNT)),
	}


func _judge_growth(early: Dictionary, late: Dictionary) -> void:
	for kind: StringName in GROWTH:
		if late[kind] > early[kind] + GROWTH[kind]:
			_problems.append("%s grew from %d to %d" % [kind, early[kind], late[kind]])


## Frames of a lap from the fastest to the slowest, each as in the lap in which it was fastest: microseconds and number.
func _ranked() -> Array[Vector2i]:
	var ranked: Array[Vector2i] = []
	for frame: int in LAP:
		ranked.append(Vector2i(_least[frame], frame))
	ranked.sort()
	return ranked


## Longest time that a frame may last on this machine, milliseconds.
static func _longest_ms(ranked: Array[Vector2i]) -> float:
	return FRAME_MS * maxf(1.0, ranked[LAP / 2].x / 1000.0 / USUAL_MS)


## Laps are alike: what is slow in the same frame of all of them is ours, the rest is the machine's.
func _judge_frames() -> void:
	var ranked := _ranked()
	var longest_ms := _longest_ms(ranked)
	print("the usual frame: %.1f ms; none may last longer than %.1f ms" % [ranked[LAP / 2].x / 1000.0, longest_ms])
	for slow: Vector2i in ranked.slice(-SLOW_SHOWN):
		print("frame %d of a lap: %.1f ms" % [slow.y, slow.x / 1000.0])
		if slow.x > longest_ms * 1000.0:
			_problems.append("frame %d of a lap takes %.1f ms" % [slow.y, slow.x / 1000.0])
