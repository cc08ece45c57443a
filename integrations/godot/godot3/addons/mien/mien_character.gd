# SPDX-License-Identifier: MIT
# A character of an imported rig: sets the bones of a skeleton and the blend shapes of a mesh, also in the editor, where
# changes of `controls` in the inspector show at once.
tool
extends Spatial

const Face = preload("mien_face.gdns")

export(Resource) var rig setget set_rig  # an imported .dna or .rig file
export(Dictionary) var controls = {}  # values by the names of raw controls
export(int) var lod = 0
export(NodePath) var skeleton
export(NodePath) var mesh

var face = Face.new()

func set_rig(value):
	rig = value
	if rig != null:
		face.open_bytes(rig.bytes)

func show_controls():
	for name in controls:
		face.set_control(name, controls[name])
	if not face.evaluate(lod):
		return false
	if has_node(skeleton):
		face.drive_skeleton(get_node(skeleton))
	if has_node(mesh):
		face.drive_mesh(get_node(mesh))
	return true

func _process(_delta):
	show_controls()

func _notification(what):
	if what == NOTIFICATION_PREDELETE:
		face.free()
