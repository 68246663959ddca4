class_name Calibration
extends RefCounted
## Leads the player through what a sensor needs to be understood: stand still, then walk a few steps.

enum Step { CONNECT, STAND, WALK, DONE }

## Below this angular rate, in radians a second, a sensor is still; so long it has to be, in seconds.
const STILL_RADPS := 0.25
const STILL_SECS := 1.5
## A mounting is trusted when it is as certain as this.
const CERTAIN := 0.8
## Longest wait for somebody to stand, seconds: a player who walks on is not held up.
const PATIENCE_SECS := 6.0

const TOLD: Dictionary[Step, String] = {
	Step.CONNECT: "Connect a sensor",
	Step.STAND: "Stand still",
	Step.WALK: "Walk: a few steps, until it is known how the sensor is worn",
	Step.DONE: "You drive the character. Turn with the body, a stick or the arrow keys",
}

var now := Step.CONNECT
## Progress of this step, 0 to 1.
var progress := 0.0

var _still_secs := 0.0
var _waited_secs := 0.0


func begin() -> void:
	now = Step.CONNECT
	progress = 0.0


## Takes what is known of the sensor, as `get_sensor_status()` gives it.
func step(sensor: Dictionary, driven: ImuReconstructor3D, delta: float) -> void:
	var heard: bool = not sensor.is_empty() and sensor.samples > 0 and sensor.silent < 0.5
	match now:
		Step.CONNECT:
			if heard:
				_enter(Step.STAND)
		Step.STAND:
			_waited_secs += delta
			var still: bool = heard and sensor.rotation.length() < STILL_RADPS
			_still_secs = _still_secs + delta if still else 0.0
			progress = _still_secs / STILL_SECS
			if _still_secs > STILL_SECS or _waited_secs > PATIENCE_SECS:
				_enter(Step.WALK)
		Step.WALK:
			var certainty := driven.get_mounting_certainty(0)
			progress = maxf(progress, certainty / CERTAIN)
			if certainty > CERTAIN:
				_enter(Step.DONE)
		Step.DONE:
			progress = 1.0


func _enter(step: Step) -> void:
	now = step
	progress = 0.0
	_still_secs = 0.0
	_waited_secs = 0.0
