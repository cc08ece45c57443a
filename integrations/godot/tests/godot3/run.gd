# SPDX-License-Identifier: MIT
# Prints what the class does to a skeleton and a mesh, and whether it refuses what is wrong.
extends SceneTree

const Character = preload("res://addons/mien/mien_character.gd")

func expect(truth, what):
	print(("PASS " if truth else "FAIL ") + what)

func read_json(path):
	var file = File.new()
	file.open(path, File.READ)
	var content = JSON.parse(file.get_as_text()).result
	file.close()
	return content

func make_skeleton(names):
	var skeleton = Skeleton.new()
	for name in names:
		skeleton.add_bone(name)
	return skeleton

func make_mesh(names):
	var mesh = ArrayMesh.new()
	for name in names:
		mesh.add_blend_shape(name)
	var arrays = []
	arrays.resize(ArrayMesh.ARRAY_MAX)
	arrays[ArrayMesh.ARRAY_VERTEX] = PoolVector3Array([Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)])
	var shape = []
	shape.resize(ArrayMesh.ARRAY_MAX)
	shape[ArrayMesh.ARRAY_VERTEX] = arrays[ArrayMesh.ARRAY_VERTEX]
	var shapes = []
	for _name in names:
		shapes.append(shape)
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays, shapes)
	var instance = MeshInstance.new()
	instance.mesh = mesh
	return instance

func numbers_of(skeleton):
	var numbers = []
	for bone in skeleton.get_bone_count():
		var pose = skeleton.get_bone_pose(bone)
		numbers.append([pose.origin.x, pose.origin.y, pose.origin.z] +
				[pose.basis.x.x, pose.basis.x.y, pose.basis.x.z, pose.basis.y.x, pose.basis.y.y, pose.basis.y.z])
	return numbers

func _init():
	var wanted = read_json("res://wanted.json")
	var character = Character.new()
	var skeleton = make_skeleton(wanted.joints)
	var mesh = make_mesh(wanted.channels)
	character.add_child(skeleton)
	character.add_child(mesh)
	character.skeleton = character.get_path_to(skeleton)
	character.mesh = character.get_path_to(mesh)
	expect(not character.show_controls(), "a character without a rig shows nothing")

	character.rig = load("res://head.dna")
	expect(character.rig != null and character.rig.bytes.size() > 0, "a DNA file is imported")
	character.controls = wanted.controls
	expect(character.show_controls(), "controls are shown")
	var values = {"dna": numbers_of(skeleton), "weights": []}
	for name in wanted.channels:
		values.weights.append(mesh.get("blend_shapes/" + name))

	var bytes = character.face.positions(wanted.mesh)
	var stream = StreamPeerBuffer.new()
	stream.data_array = bytes
	values.positions = []
	for _i in range(bytes.size() / 4):
		values.positions.append(stream.get_float())
	expect(character.face.positions("no such mesh").size() == 0, "a mesh that is not there has no positions")

	character.rig = load("res://baked.rig")
	character.show_controls()
	values.baked = numbers_of(skeleton)
	var asset = load("res://asset.uasset")
	expect(asset != null and asset.bytes == load("res://head.dna").bytes, "the DNA in an asset is imported")
	expect(load("res://broken.dna") == null, "a broken file is not imported")

	var face = character.face
	expect(face.open(ProjectSettings.globalize_path("res://head.dna")) == 0, "a file is opened by its path")
	expect(face.set_control(wanted.controls.keys()[0], 1), "a control is set")
	expect(not face.set_control("no such control", 1), "a control that is not there is refused")
	expect(not face.evaluate(99), "a LOD that is not there is refused")
	expect(not face.drive_skeleton(null), "no skeleton is refused")
	expect(face.open("no such file.rig") != 0, "a file that is not there is an error")
	expect(not face.evaluate(0), "after that the face is closed")
	expect(face.open_bytes(PoolByteArray([1, 2, 3])) != 0, "bytes that are no baked file are an error")
	expect(face.bake("no such file.dna").size() == 0, "nothing is baked from a file that is not there")

	var file = File.new()
	file.open("res://values.json", File.WRITE)
	file.store_string(JSON.print(values))
	file.close()
	character.free()
	print("DONE")
	quit()
