extends MultiMeshInstance3D
## Marks that walkers leave on the ground and that fade. The oldest is used again when there is no more room.

const MOST := 512
const LENGTH_M := 0.26
const WIDTH_M := 0.1

var _next := 0
var _now_secs := 0.0


func _ready() -> void:
	var quad := QuadMesh.new()
	quad.orientation = PlaneMesh.FACE_Y
	quad.size = Vector2(WIDTH_M, LENGTH_M)
	multimesh = MultiMesh.new()
	multimesh.transform_format = MultiMesh.TRANSFORM_3D
	multimesh.use_custom_data = true
	multimesh.mesh = quad
	multimesh.instance_count = MOST
	multimesh.visible_instance_count = 0
	custom_aabb = AABB(Vector3.ONE * -1e4, Vector3.ONE * 2e4)


func _process(delta: float) -> void:
	_now_secs += delta
	(material_override as ShaderMaterial).set_shader_parameter(&"now_secs", _now_secs)


## Marks where a foot of a character touched down. The quad's upper end points where the character faces.
func mark(foot: StringName, place: Vector3, character: Node3D) -> void:
	var forward := character.global_basis.z.normalized()
	var turned := Basis(character.global_basis.x.normalized(), Vector3.UP, forward) * Basis(Vector3.UP, PI)
	# The contact is given under the ankle; the sole reaches further to the front than to the back.
	var middle := place + forward * 0.055 + Vector3.UP * 0.004
	multimesh.set_instance_transform(_next, Transform3D(turned, middle))
	multimesh.set_instance_custom_data(_next, Color(_now_secs, 1.0 if foot == &"left" else -1.0, 0.0))
	_next = (_next + 1) % MOST
	multimesh.visible_instance_count = maxi(multimesh.visible_instance_count, _next)
