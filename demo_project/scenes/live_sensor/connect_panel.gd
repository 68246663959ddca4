class_name ConnectPanel
extends PanelContainer
## Panel in which the player connects a sensor: its kind, where it is worn, what arrives, and what to do next.

signal source_chosen(source: Resource, kind: Kind)
signal place_chosen(place: int)
signal calibrate_pressed
signal ahead_pressed
signal menu_pressed

enum Kind { PHONE, SERIAL, APPS, SENSOR_LOGGER, SENSOR_SERVER, THIS_DEVICE, STAND_IN }

const NAMES: Dictionary[Kind, String] = {
	Kind.PHONE: "A phone's browser: scan the code",
	Kind.SERIAL: "A sensor on a serial port (USB, Bluetooth)",
	Kind.APPS: "owoTrack, SlimeVR, ZIG SIM, GyrOSC … over UDP",
	Kind.SENSOR_LOGGER: "The app Sensor Logger over HTTP",
	Kind.SENSOR_SERVER: "The app SensorServer at an address",
	Kind.THIS_DEVICE: "This device's own sensors",
	Kind.STAND_IN: "None: a walker out of sight wears one",
}
const STAND_IN_PORT := 47100
## Below this confidence the body stands.
const UNEXPLAINED := 0.1

var _source: Resource
var _kind := Kind.PHONE


func _ready() -> void:
	for kind: Kind in NAMES:
		%Kind.add_item(NAMES[kind], kind)
	%Kind.item_selected.connect(func(index: int) -> void: choose(%Kind.get_item_id(index) as Kind))
	%Worn.item_selected.connect(func(index: int) -> void: place_chosen.emit(index))
	%Ports.item_selected.connect(func(index: int) -> void: _source.port = %Ports.get_item_text(index))
	%Address.text_submitted.connect(func(address: String) -> void:
		_source.address = address
		_source.start())
	%Calibrate.pressed.connect(func() -> void: calibrate_pressed.emit())
	%Ahead.pressed.connect(func() -> void: ahead_pressed.emit())
	%Menu.pressed.connect(func() -> void: menu_pressed.emit())


## Connects to another kind of sensor.
func choose(kind: Kind) -> void:
	_kind = kind
	%Kind.select(%Kind.get_item_index(kind))
	if _source != null and _source.has_method(&"stop"):
		_source.stop()
	_source = _make(kind)
	%Signal.clear()
	%Code.clear()
	%Code.visible = kind == Kind.PHONE
	%Ports.visible = kind == Kind.SERIAL
	%Address.visible = kind == Kind.SENSOR_SERVER
	if kind == Kind.SERIAL:
		%Ports.clear()
		for port: String in SerialImuSource.list_ports():
			%Ports.add_item(port)
	if _source.has_method(&"start") and kind != Kind.SENSOR_SERVER:
		_source.start()
	source_chosen.emit(_source, kind)


func _make(kind: Kind) -> Resource:
	match kind:
		Kind.PHONE:
			return PhoneImuSource.new()
		Kind.SERIAL:
			return SerialImuSource.new()
		Kind.THIS_DEVICE:
			return DeviceImuSource.new()
	var source := NetworkImuSource.new()
	match kind:
		Kind.SENSOR_LOGGER:
			source.transport = NetworkImuSource.HTTP
			source.port = 8080
		Kind.SENSOR_SERVER:
			source.transport = NetworkImuSource.WEB_SOCKET
		Kind.STAND_IN:
			source.port = STAND_IN_PORT
	return source


## State of the sensor; empty before it is heard.
func sensor() -> Dictionary:
	if _source is DeviceImuSource:
		var force := -Input.get_accelerometer()
		var heard := int(DeviceImuSource.is_available())
		return {"samples": heard, "silent": 0.0, "rate": Engine.get_frames_per_second(), "lost": 0, "force": force, "rotation": Input.get_gyroscope(), "name": "this device"}
	return _source.get_sensor_status()


## Message about the connection.
func connection_text() -> String:
	if _source is DeviceImuSource:
		return "" if DeviceImuSource.is_available() else "This device delivers no motion: it has no sensors, or the project settings turn them off."
	return sentence(_source.get_message())


## A message as a sentence of its own.
static func sentence(message: String) -> String:
	return message.left(1).to_upper() + message.substr(1)


## Shows what arrives, what is wrong with it, and what the player is to do next.
func show_state(driven: ImuReconstructor3D) -> void:
	var known := sensor()
	var heard: bool = not known.is_empty() and known.samples > 0
	if heard:
		%Signal.push(known.force, known.rotation)
		%Figures.text = "%s: %.0f samples a second, %d lost" % [known.name, known.rate, known.lost]
	else:
		%Figures.text = "nothing is heard yet"
	var connection := connection_text()
	%Message.text = connection if connection != "" or not heard else sentence(driven.get_sensor_message())
	%Message.visible = %Message.text != ""
	var step := driven.get_calibration_step()
	%Step.text = driven.get_calibration_message()
	%Progress.value = driven.get_calibration_progress()
	%Behaviour.text = _doing(driven) if step == &"done" else ""
	if _kind == Kind.PHONE and not heard:
		%Code.show_page(_source)
	elif heard:
		%Code.hide()


## The person's behaviour, and how well the model explains it.
func _doing(driven: ImuReconstructor3D) -> String:
	var confidence := driven.get_confidence()
	if confidence < UNEXPLAINED:
		return "the model does not know this: walk, or calibrate again"
	return "you %s (confidence %d %%)" % [driven.get_behaviour(), roundi(100.0 * confidence)]


func _unhandled_key_input(event: InputEvent) -> void:
	if event.is_pressed() and event.is_action(&"ui_cancel"):
		visible = not visible
