class_name SavedGame
extends Resource
## What a game keeps of its walkers: where each is, and the step that it is in.

@export var places: Array[Transform3D]
@export var walks: Array[PackedByteArray]
