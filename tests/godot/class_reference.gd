extends SceneTree
## Writes what the add-on's library registers, and its class reference, as JSON to the file that is named after `--`.
##
## `cargo xtask csharp` makes typed wrappers of it.

const REFERENCE := &"FootfallClassReference"
const HEADINGS := PROPERTY_USAGE_GROUP | PROPERTY_USAGE_CATEGORY | PROPERTY_USAGE_SUBGROUP


func _initialize() -> void:
	var classes: Array[Dictionary] = []
	var names := Array(ClassDB.get_class_list())
	names.sort()
	for name: String in names:
		if ClassDB.class_get_api_type(name) == ClassDB.API_EXTENSION:
			classes.append(_described(name))
	var reference := {"classes": classes, "documents": ClassDB.class_call_static(REFERENCE, &"documents")}
	var file := FileAccess.open(OS.get_cmdline_user_args()[0], FileAccess.WRITE)
	file.store_string(JSON.stringify(reference, "\t"))
	file.close()
	quit()


func _described(name: String) -> Dictionary:
	var properties: Array[Dictionary] = []
	var accessors: Array[String] = []
	for property: Dictionary in ClassDB.class_get_property_list(name, true):
		if property.usage & HEADINGS:
			continue
		var setter := String(ClassDB.class_get_property_setter(name, property.name))
		accessors.append_array([setter, String(ClassDB.class_get_property_getter(name, property.name))])
		property["writable"] = not setter.is_empty()
		properties.append(property)
	var methods: Array[Dictionary] = []
	for method: Dictionary in ClassDB.class_get_method_list(name, true):
		if method.name not in accessors:
			method["defaults"] = method.default_args.map(var_to_str)
			methods.append(method)
	return {
		"name": name,
		"base": ClassDB.get_parent_class(name),
		"can_be_made": ClassDB.can_instantiate(name),
		"properties": properties,
		"methods": methods,
		"signals": ClassDB.class_get_signal_list(name, true),
	}
