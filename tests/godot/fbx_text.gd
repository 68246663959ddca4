class_name FbxText
## Writes a skeleton and its animations as FBX in text, which Godot reads and does not write. Lengths are centimetres, as usual in FBX.

## Units of FBX time in a second.
const TICKS := 46186158000
const HEADER := """; FBX 7.4.0 project file
FBXHeaderExtension: {
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}
GlobalSettings: {
	Version: 1000
	Properties70: {
		P: "UpAxis", "int", "Integer", "",1
		P: "UpAxisSign", "int", "Integer", "",1
		P: "FrontAxis", "int", "Integer", "",2
		P: "FrontAxisSign", "int", "Integer", "",1
		P: "CoordAxis", "int", "Integer", "",0
		P: "CoordAxisSign", "int", "Integer", "",1
		P: "UnitScaleFactor", "double", "Number", "",1
		P: "TimeMode", "enum", "", "",6
	}
}
"""

var _objects := PackedStringArray()
var _links := PackedStringArray()
var _next := 1000


## The file's text. Tracks of the animations name the skeleton's bones.
static func of(skeleton: Skeleton3D, animations: Dictionary) -> String:
	var text := FbxText.new()
	var models: Array[int] = []
	for bone: int in skeleton.get_bone_count():
		models.append(text._model(skeleton, bone, models))
	for name: String in animations:
		text._stack(name, animations[name], skeleton, models)
	return "%sObjects: {\n%s\n}\nConnections: {\n%s\n}\n" % [HEADER, "\n".join(text._objects), "\n".join(text._links)]


func _object(kind: String, name: String, sub_class: String, content: String) -> int:
	_next += 1
	_objects.append("\t%s: %d, \"%s\", \"%s\" {\n%s\n\t}" % [kind, _next, name, sub_class, content])
	return _next


func _link(child: int, parent: int, property := "") -> void:
	if property:
		_links.append("\tC: \"OP\",%d,%d, \"%s\"" % [child, parent, property])
	else:
		_links.append("\tC: \"OO\",%d,%d" % [child, parent])


func _model(skeleton: Skeleton3D, bone: int, models: Array[int]) -> int:
	var rest := skeleton.get_bone_rest(bone)
	var properties := ""
	for property: Array in [["Lcl Translation", rest.origin], ["Lcl Rotation", _degrees(rest.basis)]]:
		properties += "\t\t\tP: \"%s\", \"%s\", \"\", \"A\",%f,%f,%f\n" % [property[0], property[0], property[1].x, property[1].y, property[1].z]
	var content := "\t\tVersion: 232\n\t\tProperties70: {\n%s\t\t}" % properties
	var model := _object("Model", "Model::" + skeleton.get_bone_name(bone), "LimbNode", content)
	_link(_object("NodeAttribute", "NodeAttribute::", "LimbNode", "\t\tTypeFlags: \"Skeleton\""), model)
	var parent := skeleton.get_bone_parent(bone)
	_link(model, models[parent] if parent >= 0 else 0)
	return model


func _stack(name: String, animation: Animation, skeleton: Skeleton3D, models: Array[int]) -> void:
	var span := ""
	for end: Array in [["LocalStart", 0], ["LocalStop", int(animation.length * TICKS)]]:
		span += "\t\t\tP: \"%s\", \"KTime\", \"Time\", \"\",%d\n" % end
	var content := "\t\tProperties70: {\n%s\t\t}" % span
	var stack := _object("AnimationStack", "AnimStack::" + name, "", content)
	var layer := _object("AnimationLayer", "AnimLayer::Base", "", "")
	_link(layer, stack)
	for track: int in animation.get_track_count():
		var bone := skeleton.find_bone(animation.track_get_path(track).get_concatenated_subnames())
		var turns := animation.track_get_type(track) == Animation.TYPE_ROTATION_3D
		var times := PackedStringArray()
		var values: Array[Vector3] = []
		for key: int in animation.track_get_key_count(track):
			times.append(str(int(animation.track_get_key_time(track, key) * TICKS)))
			var value: Variant = animation.track_get_key_value(track, key)
			values.append(_near(_degrees(Basis(value)), values) if turns else value)
		_curves(layer, models[bone], "Lcl Rotation" if turns else "Lcl Translation", times, values)


func _curves(layer: int, model: int, property: String, times: PackedStringArray, values: Array[Vector3]) -> void:
	var node := _object("AnimationCurveNode", "AnimCurveNode::" + property.substr(4, 1), "", "")
	_link(node, layer)
	_link(node, model, property)
	for axis: int in 3:
		var numbers := PackedStringArray(values.map(func(value: Vector3) -> String: return "%f" % value[axis]))
		var count := times.size()
		var content := "\t\tKeyVer: 4008\n\t\tKeyTime: *%d {\n\t\t\ta: %s\n\t\t}\n\t\tKeyValueFloat: *%d {\n\t\t\ta: %s\n\t\t}\n" % [count, ",".join(times), count, ",".join(numbers)]
		content += "\t\tKeyAttrFlags: *1 {\n\t\t\ta: 4\n\t\t}\n\t\tKeyAttrDataFloat: *4 {\n\t\t\ta: 0,0,0,0\n\t\t}\n\t\tKeyAttrRefCount: *1 {\n\t\t\ta: %d\n\t\t}" % count
		_link(_object("AnimationCurve", "AnimCurve::", "", content), node, "d|" + "XYZ"[axis])


## Angles about X, then Y, then Z.
func _degrees(basis: Basis) -> Vector3:
	return basis.get_euler(EULER_ORDER_ZYX) * 180.0 / PI


## The same turn by the angles that are nearest to the last of these.
func _near(degrees: Vector3, before: Array[Vector3]) -> Vector3:
	if before.is_empty():
		return degrees
	var last := before[-1]
	return degrees + 360.0 * ((last - degrees) / 360.0).round()
