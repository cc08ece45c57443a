# SPDX-License-Identifier: MIT
# Makes a MienRig of a .dna or .uasset file, baked with its geometry in the axes and units of Godot, or of a baked file.
tool
extends EditorImportPlugin

const Face = preload("mien_face.gdns")
const Rig = preload("mien_rig.gd")

func get_importer_name():
	return "mien.rig"

func get_visible_name():
	return "Mien rig"

func get_recognized_extensions():
	return ["dna", "uasset", "rig"]

func get_save_extension():
	return "res"

func get_resource_type():
	return "Resource"

func get_preset_count():
	return 1

func get_preset_name(_preset):
	return "Default"

func get_import_options(_preset):
	return []

func get_option_visibility(_option, _options):
	return true

func import(source_file, save_path, _options, _platform_variants, _gen_files):
	var face = Face.new()
	var rig = Rig.new()
	rig.bytes = face.bake(ProjectSettings.globalize_path(source_file))
	face.free()
	if rig.bytes.size() == 0:
		return ERR_FILE_CORRUPT  # the reason was printed
	return ResourceSaver.save("%s.%s" % [save_path, get_save_extension()], rig)
