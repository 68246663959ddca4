@tool
extends EditorPlugin
## Footfall's entry in Project Settings → Plugins, which must name a script.
##
## There is nothing to enable: the library registers its nodes and file types as soon as the folder is in the project. Enabled, the plugin reports a library that is
## missing, which nothing else of the add-on can do then.

const NODE := &"GaitGenerator3D"
const EXTENSION := "footfall.gdextension"


func _enter_tree() -> void:
	if not ClassDB.class_exists(NODE):
		push_error(_what_is_missing((get_script() as Script).resource_path.get_base_dir()))


## Returns why there are no nodes, and what to do.
func _what_is_missing(folder: String) -> String:
	var extension := ConfigFile.new()
	if extension.load(folder.path_join(EXTENSION)) != OK:
		return "Footfall: %s is missing in %s. Unzip the add-on again." % [EXTENSION, folder]
	for name: String in extension.get_section_keys("libraries"):
		# As the engine chooses: by features, of which games have other ones than the editor.
		if Array(name.split(".")).all(func(feature: String) -> bool: return OS.has_feature(feature)):
			var library := folder.path_join(extension.get_value("libraries", name))
			if FileAccess.file_exists(library):
				return "Footfall: the engine has not loaded %s; the log's first errors say why. Restart the editor, or unzip the add-on again." % library
			return "Footfall: %s is missing. Unzip the add-on again, or build the library with `cargo xtask library`." % library
	return "Footfall has no library for this platform (%s, %s). Those that there are stand in %s; build yours with `cargo xtask library`." % [OS.get_name(), Engine.get_architecture_name(), EXTENSION]
