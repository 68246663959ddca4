@tool
extends EditorPlugin
## Unzips the archive that the command line names, as a user does beside a running editor, and checks whether the add-on works.
##
## Names none of the add-on's classes: there are none when this is compiled. Goes by what the project holds, for the engine compiles scripts
## anew when an extension comes, and what they were waiting for is lost.

const MODEL := "res://addons/footfall/models/locomotion.footfall"
const PATIENCE_MSECS := 60_000


func _process(_delta: float) -> void:
	var files := EditorInterface.get_resource_filesystem()
	if files.is_scanning():
		return
	if not FileAccess.file_exists(MODEL):
		var problem := _unzip(OS.get_cmdline_user_args()[0])
		if not problem.is_empty():
			_end(problem)
		# What the editor does when its window is looked at again.
		files.scan_sources()
	elif files.get_file_type(MODEL) == "GaitModel" or Time.get_ticks_msec() > PATIENCE_MSECS:
		_end(_problem(files))


func _end(problem: String) -> void:
	if problem.is_empty():
		print("RUNNING EDITOR OK")
	else:
		printerr("FAILED ", problem)
	set_process(false)
	get_tree().quit(0 if problem.is_empty() else 1)


func _unzip(path: String) -> String:
	var archive := ZIPReader.new()
	if archive.open(path) != OK:
		return path + " cannot be opened"
	for name: String in archive.get_files():
		if name.ends_with("/"):
			continue
		DirAccess.make_dir_recursive_absolute("res://".path_join(name.get_base_dir()))
		var file := FileAccess.open("res://".path_join(name), FileAccess.WRITE)
		file.store_buffer(archive.read_file(name))
		file.close()
	return ""


func _problem(files: EditorFileSystem) -> String:
	for type: String in ["GaitGenerator3D", "GaitCrowd3D", "ImuReconstructor3D", "FootPlacement3D"]:
		if not ClassDB.can_instantiate(type):
			return "there is no " + type
	if files.get_file_type(MODEL) != "GaitModel":
		return "the editor takes the model for \"%s\"" % files.get_file_type(MODEL)
	var model := load(MODEL)
	if model == null or model.get_class() != "GaitModel":
		return "the model does not load"
	var gait: Node = ClassDB.instantiate("GaitGenerator3D")
	gait.set(&"model", model)
	var lacks: PackedStringArray = gait.call(&"get_problems")
	gait.free()
	if not (lacks.size() == 1 and lacks[0].contains("Skeleton3D")):
		return "the node says " + "; ".join(lacks)
	return ""
