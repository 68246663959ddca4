extends Node3D
## Runs every script of `checks/`, each on a fresh node, says what fails, and quits: with 0 when nothing does.

const CHECKS := "res://checks"

## Referred to by its UID alone, for the path in the scene is wrong.
@export var model: GaitModel


func _ready() -> void:
	var failures := PackedStringArray()
	if model == null or not model.get_error().is_empty():
		failures.append("the scene's model is not found by its UID")
	for file: String in ResourceLoader.list_directory(CHECKS):
		var check: NewcomerCheck = (load(CHECKS.path_join(file)) as GDScript).new()
		add_child(check)
		await check.run()
		for failure: String in check.failures:
			failures.append("%s: %s" % [file, failure])
		check.queue_free()
	for failure: String in failures:
		printerr("FAILED ", failure)
	if failures.is_empty():
		print("NEWCOMER OK")
	get_tree().quit(0 if failures.is_empty() else 1)
