class_name SignalView
extends Control
## The last seconds of a sensor: acceleration and angular rate, by their lengths.

const MOST := 240
const FORCE_COLOUR := Color("2d9cdb")
const RATE_COLOUR := Color("f2c94c")
## Values at the top of the view: m/s² and rad/s.
const MOST_FORCE := 40.0
const MOST_RATE := 12.0

var _forces := PackedFloat32Array()
var _rates := PackedFloat32Array()


func push(force: Vector3, rate: Vector3) -> void:
	_forces.append(force.length() / MOST_FORCE)
	_rates.append(rate.length() / MOST_RATE)
	if _forces.size() > MOST:
		_forces.remove_at(0)
		_rates.remove_at(0)
	queue_redraw()


func clear() -> void:
	_forces.clear()
	_rates.clear()
	queue_redraw()


func _draw() -> void:
	draw_rect(Rect2(Vector2.ZERO, size), Color(0, 0, 0, 0.35))
	_curve(_forces, FORCE_COLOUR)
	_curve(_rates, RATE_COLOUR)
	var font := get_theme_default_font()
	draw_string(font, Vector2(8, 15), "acceleration", HORIZONTAL_ALIGNMENT_LEFT, -1, 12, FORCE_COLOUR)
	draw_string(font, Vector2(96, 15), "turning", HORIZONTAL_ALIGNMENT_LEFT, -1, 12, RATE_COLOUR)


func _curve(values: PackedFloat32Array, colour: Color) -> void:
	if values.size() < 2:
		return
	var points := PackedVector2Array()
	for index: int in values.size():
		points.append(Vector2(index * size.x / MOST, size.y - 4.0 - minf(values[index], 1.0) * (size.y - 24.0)))
	draw_polyline(points, colour, 2.0, true)
