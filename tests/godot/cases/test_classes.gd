extends TestCase
## Classes that the add-on registers with the engine.


func test_no_member_hides_one_of_the_engine() -> void:
	var classes := 0
	for name: String in ClassDB.get_class_list():
		if ClassDB.class_get_api_type(name) != ClassDB.API_EXTENSION:
			continue
		classes += 1
		var base := ClassDB.get_parent_class(name)
		for method: Dictionary in ClassDB.class_get_method_list(name, true):
			# Virtual methods are there to be overridden.
			if not String(method.name).begins_with("_"):
				check(not ClassDB.class_has_method(base, method.name), "%s.%s() hides that of %s" % [name, method.name, base])
		for signal_of_it: Dictionary in ClassDB.class_get_signal_list(name, true):
			check(not ClassDB.class_has_signal(base, signal_of_it.name), "signal %s.%s hides that of %s" % [name, signal_of_it.name, base])
	check(classes > 10, "%d classes" % classes)
