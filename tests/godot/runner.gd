extends Node
## Runs every `test_*` method of every `res://cases/test_*.gd`, each on a fresh node, and exits with 0 when all pass.
##
## After `--`, a word narrows the run to tests whose `file:method` contains it.

const CASES := "res://cases"
## Failed checks shown for each test.
const MOST_SHOWN := 5


func _ready() -> void:
	var wanted := OS.get_cmdline_user_args()
	var passed := 0
	var failed := 0
	for file: String in DirAccess.get_files_at(CASES):
		if not (file.begins_with("test_") and file.ends_with(".gd")):
			continue
		var script: GDScript = load(CASES.path_join(file))
		if script == null or not script.can_instantiate():
			printerr("FAILED %s: the script does not compile" % file)
			failed += 1
			continue
		for method: Dictionary in script.get_script_method_list():
			var test: String = method.name
			var name_of_test := "%s:%s" % [file.get_basename(), test]
			if not test.begins_with("test_"):
				continue
			if not wanted.is_empty() and not name_of_test.contains(wanted[0]):
				continue
			var failures := await _run(script, test)
			if failures.is_empty():
				passed += 1
				print("ok     ", name_of_test)
			else:
				failed += 1
				for failure: String in failures.slice(0, MOST_SHOWN):
					printerr("FAILED %s: %s" % [name_of_test, failure])
				if failures.size() > MOST_SHOWN:
					printerr("FAILED %s: and %d checks more" % [name_of_test, failures.size() - MOST_SHOWN])
	print("%d passed, %d failed" % [passed, failed])
	get_tree().quit(0 if failed == 0 and passed > 0 else 1)


func _run(script: GDScript, test: String) -> PackedStringArray:
	var case: TestCase = script.new()
	add_child(case)
	await case.call(test)
	var failures := case.failures
	if case.checks == 0 and failures.is_empty():
		failures.append("ended without a single check: a script error, or an empty test")
	case.queue_free()
	await get_tree().process_frame
	return failures
