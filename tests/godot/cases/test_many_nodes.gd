extends TestCase
## Many single walkers: what one node more costs.

const NODES := 200
## Bytes that one more GaitGenerator3D may cost beside its skeleton.
const MOST_BYTES := 60_000.0


## Bytes of memory that the process has, where the system tells.
func _resident() -> int:
	var status := FileAccess.open("/proc/self/status", FileAccess.READ)
	if status == null:
		return -1
	while not status.eof_reached():
		var line := status.get_line()
		if line.begins_with("VmRSS:"):
			return line.trim_prefix("VmRSS:").strip_edges().get_slice(" ", 0).to_int() * 1024
	return -1


func _walkers(first_seed: int) -> Array[Walker]:
	var walkers: Array[Walker] = []
	for index: int in NODES:
		var walker := Walker.new().build(false)
		walker.gait.seed = first_seed + index
		add_child(walker)
		walkers.append(walker)
	return walkers


## Starts the walks of skeletons that are there; returns milliseconds a node.
func _start(walkers: Array[Walker]) -> float:
	var begin := Time.get_ticks_usec()
	for walker: Walker in walkers:
		walker.gait.model = load(Walker.MODEL)
		walker.step(1.0 / 60.0)
	return (Time.get_ticks_usec() - begin) / 1000.0 / walkers.size()


func test_one_node_more_costs_little_memory() -> void:
	if _resident() < 0:
		check(true, "this system does not tell")
		return
	# Those that come first bring what all share, and fill the holes that other tests have left.
	var others := _walkers(1)
	_start(others)
	var walkers := _walkers(1001)
	var before := _resident()
	var milliseconds := _start(walkers)
	var bytes := float(_resident() - before) / NODES
	print("one GaitGenerator3D more: %.0f bytes, %.2f ms" % [bytes, milliseconds])
	check_below(bytes, MOST_BYTES, "bytes a node")
	for walker: Walker in others + walkers:
		walker.free()
