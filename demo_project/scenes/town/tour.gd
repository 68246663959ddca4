class_name TownTour
extends RefCounted
## The film of the town: what the player does when, and from where it is seen. Views stand still, so that a film of them stays small.

## Seconds at which a view begins → the camera's place, and what it looks at.
const VIEWS: Array[Array] = [
	[0.0, Vector3(-4.6, 1.9, 15.0), Vector3(2.2, 1.0, 3.0)],
	[5.0, Vector3(8.6, 1.4, 2.6), Vector3(2.0, 1.1, -3.4)],
	[8.0, Vector3(7.0, 3.6, -4.4), Vector3(-0.6, 1.4, -11.0)],
]
## Seconds → what the player does then: where it goes, at which speed, and true for a leap.
const ORDERS: Array[Array] = [
	[0.0, Vector3(3.9, 0, 4.0), 1.4, false],
	[2.4, Vector3(3.9, 0, 2.0), 3.2, false],
	[5.0, Vector3(0.8, 0, -6.0), 3.2, false],
	[5.9, Vector3(0.8, 0, -6.0), 3.2, true],
	[7.4, Vector3(0.4, 1.5, -14.0), 1.3, false],
]
const SECS := 12.0

var _begun := -1
var _seen := -1


## Does what is due by then.
func play(seconds: float, town: Node3D, player: GaitCharacter3D, camera: Camera3D) -> void:
	while _seen + 1 < VIEWS.size() and seconds >= VIEWS[_seen + 1][0]:
		_seen += 1
		camera.set_process(false)
		camera.make_current()
		camera.look_at_from_position(VIEWS[_seen][1], VIEWS[_seen][2])
	while _begun + 1 < ORDERS.size() and seconds >= ORDERS[_begun + 1][0]:
		_begun += 1
		town.send_player(ORDERS[_begun][1])
		player.walk_speed = ORDERS[_begun][2]
		if ORDERS[_begun][3]:
			player.jump()
