class_name TownTour
extends RefCounted
## The film of the town: what the player does when, and from where it is seen. Views stand still, so that a film of them stays small.

## Seconds at which a view begins → the camera's place, what it looks at, and where the player is then, with its heading in degrees, if it is elsewhere.
const VIEWS: Array[Array] = [
	[0.0, Vector3(7.6, 2.0, 13.9), Vector3(6.6, 1.0, 7.2), Vector3(5.7, 0, 11.4), 155.0],
	[3.7, Vector3(6.7, 1.45, -4.3), Vector3(9.3, 1.05, -0.9)],
	[6.3, Vector3(-1.9, 1.9, -8.6), Vector3(2.2, 1.2, -10.6), Vector3(2.7, 0, -8.1), 180.0],
	[12.0, Vector3(-7.7, 1.75, -6.2), Vector3(-10.7, 0.75, -3.3), Vector3(-10.5, 0, -0.6), 180.0],
]
## Seconds → what the player does then: where it goes (infinite: straight north), at which speed, and true for a jump.
const ORDERS: Array[Array] = [
	[0.0, Vector3(9.0, 0, 3.0), 1.4, false],
	[1.6, Vector3(9.4, 0, -3.2), 3.4, false],
	[4.7, Vector3(9.4, 0, -3.2), 3.4, true],
	[6.3, Vector3(2.2, TownPlan.RISE, -13.4), 1.4, false],
	[12.0, Vector3.INF, 1.4, false],
	[14.65, Vector3.INF, 1.4, true],
	[15.8, Vector3.INF, 0.0, false],
]
const SECS := 17.0

var _begun := -1
var _seen := -1


## Does what is due by then.
func play(seconds: float, town: Node3D, player: GaitCharacter3D, camera: Camera3D) -> void:
	while _seen + 1 < VIEWS.size() and seconds >= VIEWS[_seen + 1][0]:
		_seen += 1
		var view := VIEWS[_seen]
		camera.set_process(false)
		camera.make_current()
		camera.look_at_from_position(view[1], view[2])
		if view.size() > 3:
			player.teleport(Transform3D(Basis(Vector3.UP, deg_to_rad(view[4])), view[3]))
	while _begun + 1 < ORDERS.size() and seconds >= ORDERS[_begun + 1][0]:
		_begun += 1
		var goal: Vector3 = ORDERS[_begun][1]
		if goal.is_finite():
			town.send_player(goal)
		else:
			player.navigation = null
			player.autopilot = Vector3.FORWARD
		player.walk_speed = ORDERS[_begun][2]
		if ORDERS[_begun][3]:
			player.jump()
