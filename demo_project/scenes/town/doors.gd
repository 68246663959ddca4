class_name TownDoors
extends VBoxContainer
## Ways into the town other than keyboard and gamepad: a phone's code, and a game with others.

## The town is to be built anew: a game with others has ended.
signal closed

const THIGH: ImuModel = preload("res://addons/footfall/models/right_thigh.footimu")

## News for the town that is built anew.
static var _news := ""

@export var world: NetworkWorld

var _player: GaitCharacter3D
var _phone: PhoneImuSource
var _walk: SensorWalk


func _ready() -> void:
	%Phone.toggled.connect(_use_phone)
	%Ahead.pressed.connect(_look_ahead)
	%Host.pressed.connect(func() -> void: _offer(not world.host()))
	%Join.pressed.connect(func() -> void: _offer(not world.join(%Address.text.strip_edges())))
	%Leave.pressed.connect(_close.bind("You have left."))
	world.status_changed.connect(_show_status)
	world.ended.connect(func() -> void: _close(%News.text))
	_offer(true)
	_show_status(_news)
	_news = ""


## Takes the character that a phone steers from now on.
func take(player: GaitCharacter3D) -> void:
	_player = player
	if _phone != null:
		_use_phone(false)
		_use_phone(true)


func _process(_delta: float) -> void:
	if _phone == null:
		return
	var sensor := _phone.get_sensor_status()
	var heard: bool = not sensor.is_empty() and sensor.samples > 0
	%Code.visible = not heard
	%Ahead.visible = heard
	%Code.show_page(_phone)
	_show_status(_next_step(heard))


## Returns what is wrong with the phone, or what its owner does next.
func _next_step(heard: bool) -> String:
	if _phone.get_message() != "":
		return ConnectPanel.sentence(_phone.get_message())
	if not heard:
		return "Scan the code with the phone that you walk with."
	if _walk.driven.get_calibration_step() != &"done":
		return _walk.driven.get_calibration_message()
	var problem := _walk.driven.get_sensor_message()
	return ConnectPanel.sentence(problem) if problem != "" else "Walk on the spot or about the room. Arrow keys turn."


func _use_phone(on: bool) -> void:
	if not on:
		_walk.queue_free()
		_phone.stop()
		_phone = null
		%Code.hide()
		%Ahead.hide()
		_show_status("")
		return
	_phone = PhoneImuSource.new()
	_walk = SensorWalk.new(THIGH, _player)
	_walk.driven.source = _phone
	%Code.clear()
	add_child(_walk)
	_walk.driven.start_calibration()
	_phone.start()


## The phone's owner faces the screen: that is where the character goes.
func _look_ahead() -> void:
	var back := get_viewport().get_camera_3d().global_basis.z
	_walk.look(atan2(-back.x, -back.z))


func _close(news: String) -> void:
	_news = news
	world.leave()
	closed.emit()


func _show_status(text: String) -> void:
	%News.text = text
	%News.visible = text != ""


## Offers a game with others, or the way out of it.
func _offer(free: bool) -> void:
	%Host.visible = free
	%Others.visible = free
	%Leave.visible = not free
