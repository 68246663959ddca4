class_name SavedGame
extends Resource
## Saved state of a game's walkers: the place of each, and the step that it is in.

@export var places: Array[Transform3D]
@export var walks: Array[PackedByteArray]
