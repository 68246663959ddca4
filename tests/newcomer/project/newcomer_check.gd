@abstract
class_name NewcomerCheck
extends Node3D
## Something that a newcomer does with the add-on, and what must come of it.

## Failures so far.
var failures := PackedStringArray()


## Does it.
@abstract func run() -> void


func expect(holds: bool, what: String) -> void:
	if not holds:
		failures.append(what)
