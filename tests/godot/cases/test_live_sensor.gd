extends TestCase
## Live sensors over real ports of this machine: datagrams, the page for phones, the engine's own sensors, and what is recorded of them.

const MODEL := "res://addons/footfall/models/right_foot.footimu"
const DELTA := 1.0 / 60.0
const UDP_PORT := 47116
const PHONE_PORT := 47117
## Makes a pseudo-terminal, tells the name of its port, and passes on what it is told.
const TERMINAL := """
import os, pty, sys, tty
device, port = pty.openpty()
tty.setraw(port)
print(os.ttyname(port), flush=True)
for line in sys.stdin.buffer:
    os.write(device, line)
"""


## Measurements of a sensor on a walker's foot: [time, force, rate].
func _measured(frames: int) -> Array[Array]:
	var walker := Walker.new()
	walker.gait.speed = 1.2
	add_child(walker.build())
	var samples := WornSensor.measure(walker, frames)
	walker.free()
	return samples


func _driven(source: Resource) -> Walker:
	return WornSensor.driven(self, MODEL, source)


func _reconstructor(body: Walker) -> ImuReconstructor3D:
	return body.skeleton.get_node(^"Reconstructor")


## A line as a hobby board prints it, in milliseconds.
func _line(sample: Array) -> PackedByteArray:
	var force: Vector3 = sample[1]
	var rate: Vector3 = sample[2]
	return ("%.3f,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f" % [sample[0] * 1000.0, force.x, force.y, force.z, rate.x, rate.y, rate.z]).to_utf8_buffer()


## A message of the page for phones.
func _message(sample: Array) -> PackedByteArray:
	var bytes := PackedByteArray()
	bytes.resize(33)
	bytes[0] = 1
	bytes.encode_double(1, sample[0])
	for axis: int in 3:
		bytes.encode_float(9 + 4 * axis, sample[1][axis])
		bytes.encode_float(21 + 4 * axis, sample[2][axis])
	return bytes


## Waits until something holds, for at most ten seconds.
func _wait(holds: Callable, what: String) -> void:
	for n: int in 1000:
		if holds.call():
			return
		OS.delay_msec(10)
	check(false, "in vain: %s" % what)


## Sends a walk through `send`, sample by sample, while the body is driven; then it has walked.
func _check_walks(body: Walker, samples: Array[Array], send: Callable) -> void:
	var node := _reconstructor(body)
	var found := [0]
	node.sensor_found.connect(func() -> void: found[0] += 1)
	for sample: Array in samples:
		send.call(sample)
		OS.delay_msec(2)
		body.step(DELTA)
		check(body.joint("Head").is_finite(), "the pose is finite")
	check_equal(String(node.get_behaviour()), "walk", "the behaviour")
	check_equal(found[0], 1, "found once")
	check_near(body.global_position.length(), 1.2 * samples.size() * DELTA, 2.5, "the way")


func test_a_board_on_the_network_drives_a_body_and_is_recorded() -> void:
	var samples := _measured(600)
	var source := NetworkImuSource.new()
	source.port = UDP_PORT
	check_equal(String(source.get_state()), "closed", "before it is used")
	var body := _driven(source)
	body.step(DELTA)
	_wait(func() -> bool: return source.get_state() == &"listening", "the port is open")
	check_contains(source.get_message(), str(UDP_PORT), "what is awaited")
	# Until they are understood, lines of numbers are only counted.
	var board := PacketPeerUDP.new()
	board.connect_to_host("127.0.0.1", UDP_PORT)
	for sample: Array in samples.slice(0, 30):
		board.put_packet(_line(sample))
	_wait(func() -> bool: return source.get_state() == &"receiving", "the board is heard")
	body.step(DELTA)
	var node := _reconstructor(body)
	check(node.start_recording("user://live.imu"), "a recording begins")
	_check_walks(body, samples.slice(30), func(sample: Array) -> void: board.put_packet(_line(sample)))
	check(node.stop_recording(), "the recording ends")
	var status := source.get_sensor_status()
	check_equal(status.format, "text", "its form")
	check_equal([status.lost, status.rejected], [0, 0], "lost and rejected")
	check_near(status.rate, 60.0, 1.0, "its rate")
	var replay := ReplayImuSource.new()
	replay.file = "user://live.imu"
	check_equal(replay.get_error(), "", "what was recorded plays")
	check_near(replay.get_length(), 569 * DELTA, 0.1, "its length")
	_wait(func() -> bool: return source.get_state() == &"silent", "silence is told")
	check_contains(source.get_message(), "no samples from", "what is told")
	source.stop()
	check_equal(String(source.get_state()), "closed", "after it was stopped")
	body.free()


func test_a_phones_page_drives_a_body_and_vibrates() -> void:
	var samples := _measured(400)
	var source := PhoneImuSource.new()
	source.port = PHONE_PORT
	check_equal(source.get_url(), "", "no address before it is open")
	check_equal(source.get_qr_code(), null, "no code before it is open")
	source.start()
	_wait(func() -> bool: return source.get_url() != "", "the page is served")
	var code := source.get_qr_code()
	check(code.get_width() > 29 and code.get_width() == code.get_height(), "a code of %s" % code.get_size())
	check(code.get_pixel(0, 0).r > 0.9 and code.get_pixel(4, 4).r < 0.1, "dark on light, with a margin")
	var other := PhoneImuSource.new()
	other.port = PHONE_PORT
	other.player = 1
	other.start()
	check(other.get_url() != source.get_url(), "players have codes of their own")
	# The address is that of this machine in its network; a phone that knows it is as good on this machine itself.
	var path := source.get_url().substr(source.get_url().find("/p/"))
	var page := WebSocketPeer.new()
	page.connect_to_url("wss://127.0.0.1:%d%s/live/test" % [PHONE_PORT, path], TLSOptions.client_unsafe())
	_wait(func() -> bool:
		page.poll()
		return page.get_ready_state() == WebSocketPeer.STATE_OPEN, "the page is connected")
	var body := _driven(source)
	body.step(DELTA)
	_check_walks(body, samples, func(sample: Array) -> void:
		page.put_packet(_message(sample))
		page.poll())
	var told := PackedStringArray()
	_wait(func() -> bool:
		page.poll()
		while page.get_available_packet_count() > 0:
			told.append(page.get_packet().get_string_from_utf8())
		return told.size() >= 2, "the page is told")
	check_contains("".join(told), "vibrate", "footsteps are felt")
	check_equal(source.get_sensor_status().format, "browser", "its form")
	check_equal(String(other.get_state()), "listening", "the other player's phone is awaited")
	page.close()
	body.free()


func test_a_board_on_a_serial_port_drives_a_body() -> void:
	if OS.get_name() != "Linux" or OS.execute("python3", ["--version"]) != 0:
		print("skipped: a pseudo-terminal is made with Python on Linux")
		return
	var samples := _measured(500)
	var terminal := OS.execute_with_pipe("python3", ["-c", TERMINAL])
	var pipe: FileAccess = terminal.stdio
	var source := SerialImuSource.new()
	source.port = pipe.get_line()
	source.baud_rate = 115200
	source.columns = "time,ax,ay,az,gx,gy,gz"
	source.force_unit = SerialImuSource.METRES_PER_SECOND_SQUARED
	source.rate_unit = SerialImuSource.RADIANS_PER_SECOND
	source.time_unit = SerialImuSource.MILLISECONDS
	var body := _driven(source)
	body.step(DELTA)
	# What speaks is found out by listening: somebody has to speak.
	var before := 0.0
	for n: int in 2000:
		before += DELTA
		pipe.store_buffer(_line([before - 1000.0, Vector3.UP * 9.81, Vector3.ZERO]))
		pipe.store_line("")
		pipe.flush()
		if source.get_state() == &"receiving":
			break
		OS.delay_msec(5)
	check_equal(source.get_message(), "", "the board is heard")
	body.step(DELTA)
	_check_walks(body, samples, func(sample: Array) -> void:
		pipe.store_buffer(_line(sample))
		pipe.store_line("")
		pipe.flush())
	var status := source.get_sensor_status()
	check_equal(status.format, "text", "its form")
	check_equal(status.name, source.port, "its name")
	# It is pulled out.
	OS.kill(terminal.pid)
	_wait(func() -> bool: return source.get_state() == &"failed", "the loss is told")
	source.stop()
	body.free()


func test_sensor_loggers_posts_drive_a_body() -> void:
	var samples := _measured(500)
	var source := NetworkImuSource.new()
	source.transport = NetworkImuSource.HTTP
	source.port = UDP_PORT + 1
	source.start()
	_wait(func() -> bool: return source.get_state() == &"listening", "the port is open")
	var stream := StreamPeerTCP.new()
	stream.connect_to_host("127.0.0.1", UDP_PORT + 1)
	_wait(func() -> bool:
		stream.poll()
		return stream.get_status() == StreamPeerTCP.STATUS_CONNECTED, "the app is connected")
	var entries := PackedStringArray()
	var body := _driven(source)
	_check_walks(body, samples, func(sample: Array) -> void:
		for reading: Array in [["totalacceleration", sample[1]], ["gyroscope", sample[2]]]:
			var nanos := 1_700_000_000_000_000_000 + int(sample[0] * 1e9)
			entries.append('{"name":"%s","time":%d,"values":{"x":%f,"y":%f,"z":%f}}' % [reading[0], nanos, reading[1].x, reading[1].y, reading[1].z])
		if entries.size() < 12:
			return
		# A tenth of a second in a batch.
		var text := '{"deviceId":"test","payload":[%s]}' % ",".join(entries)
		entries.clear()
		stream.put_data(("POST /data HTTP/1.1\r\nHost: game\r\nContent-Length: %d\r\n\r\n%s" % [text.length(), text]).to_utf8_buffer())
		stream.poll()
		stream.get_data(stream.get_available_bytes()))
	check_equal(source.get_sensor_status().format, "sensor_logger", "its form")
	check_equal(source.get_sensor_status().lost, 0, "lost")
	body.free()


func test_a_sensorserver_on_a_phone_drives_a_body() -> void:
	var samples := _measured(400)
	var server := TCPServer.new()
	server.listen(UDP_PORT + 2, "127.0.0.1")
	var source := NetworkImuSource.new()
	source.transport = NetworkImuSource.WEB_SOCKET
	source.address = "127.0.0.1:%d" % (UDP_PORT + 2)
	source.start()
	_wait(func() -> bool: return server.is_connection_available(), "the game asks")
	var phone := WebSocketPeer.new()
	phone.accept_stream(server.take_connection())
	_wait(func() -> bool:
		phone.poll()
		return phone.get_ready_state() == WebSocketPeer.STATE_OPEN, "it is answered")
	var body := _driven(source)
	_check_walks(body, samples, func(sample: Array) -> void:
		for reading: Array in [["accelerometer", sample[1]], ["gyroscope", sample[2]]]:
			phone.send_text('{"timestamp":%d,"type":"android.sensor.%s","values":[%f,%f,%f]}' % [int(sample[0] * 1e9), reading[0], reading[1].x, reading[1].y, reading[1].z])
		phone.poll())
	check_equal(source.get_sensor_status().format, "sensorserver", "its form")
	body.free()
	phone.close()
	server.stop()


func test_the_devices_own_sensors_are_made_alike() -> void:
	check(not DeviceImuSource.is_available(), "this machine has none")
	var source := DeviceImuSource.new()
	var body := _driven(source)
	body.step(DELTA)
	# Godot tells acceleration the way gravity pulls: here in units of gravity, as iOS does.
	for frame: int in 300:
		Input.set_gravity(Vector3(0.0, -1.0, 0.0))
		Input.set_accelerometer(Vector3(0.0, -1.0, 0.0))
		Input.set_gyroscope(Vector3.ZERO)
		OS.delay_msec(5)
		body.step(DELTA)
	check(DeviceImuSource.is_available(), "now it has")
	var node := _reconstructor(body)
	check_below(node.get_latency(), 0.1, "latency")
	check_equal(String(node.get_behaviour()), "stand", "the behaviour")
	check(node.start_recording("user://device.imu"), "a recording begins")
	for frame: int in 30:
		OS.delay_msec(5)
		body.step(DELTA)
	check(node.stop_recording(), "the recording ends")
	var text := FileAccess.get_file_as_string("user://device.imu")
	check_near(text.split("\n")[5].split(",")[2].to_float(), 9.8, 1.0, "gravity in m/s²")
	Input.set_accelerometer(Vector3.ZERO)
	body.free()


func test_what_cannot_be_opened_is_told() -> void:
	var serial := SerialImuSource.new()
	check(SerialImuSource.list_ports() is PackedStringArray, "ports are listed")
	serial.port = "/nowhere/tty"
	serial.start()
	_wait(func() -> bool: return serial.get_state() == &"failed", "a port that is not there")
	check_contains(serial.get_message(), "there is no port", "what is told")
	serial.columns = "time,ax"
	serial.start()
	check_contains(serial.get_message(), "six axes", "columns that are not whole")
	var network := NetworkImuSource.new()
	network.port = 0
	network.start()
	check_equal(String(network.get_state()), "failed", "port 0")
	check_contains(network.get_message(), "Port", "what is told")
	network.transport = NetworkImuSource.WEB_SOCKET
	network.start()
	check_contains(network.get_message(), "Address", "no address")
	# A port that another program holds.
	var taken := PacketPeerUDP.new()
	taken.bind(UDP_PORT + 10, "0.0.0.0")
	network.transport = NetworkImuSource.UDP
	network.port = UDP_PORT + 10
	network.start()
	_wait(func() -> bool: return network.get_state() == &"failed", "a port that is taken")
	check_contains(network.get_message(), "taken", "what is told")
	taken.close()
	# A resource of another kind is no source: the node warns, and the character stands.
	begin_expected_errors()
	var body := _driven(Gradient.new())
	body.step(DELTA)
	check_near(body.joint("Hips").y, 0.92, 0.12, "hips")
	body.free()
	end_expected_errors()
