extends NewcomerCheck
## Loads all that the add-on ships.

const MODELS := "res://addons/footfall/models"
const CLASSES := {"footfall": "GaitModel", "footdyn": "GaitModel", "footstyle": "GaitStyle", "footimu": "ImuModel"}


func run() -> void:
	var seen := {}
	for file: String in ResourceLoader.list_directory(MODELS):
		var path := MODELS.path_join(file)
		var type: String = CLASSES.get(file.get_extension(), "")
		expect(not type.is_empty(), file + " is of an unknown kind")
		seen[file.get_extension()] = true
		ResourceLoader.load_threaded_request(path)
		var resource := ResourceLoader.load_threaded_get(path)
		expect(resource != null and resource.get_class() == type, file + " is no " + type)
		if resource != null:
			var problem: String = resource.call(&"get_error")
			expect(problem.is_empty(), file + ": " + problem)
	expect(seen.size() == CLASSES.size(), "only %s are there" % ", ".join(seen.keys()))
