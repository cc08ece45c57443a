-- SPDX-License-Identifier: MIT
-- DNA files, rigs, instances, batches and baked files.
local ffi = require("ffi")
local api = require("mien.api")
local library = require("mien.library")
local object = require("mien.object")
local lib, open, check, check_detail = library.lib, object.open, object.check, object.check_detail
local detail = object.error_detail

local rigs = {}
local Dna = object.class("Dna", "MienDna")
local Rig = object.class("Rig", "MienRig")
local Instance = object.class("Instance", "MienInstance")
local Batch = object.class("Batch", "MienBatch")
local Baked = object.class("Baked", "MienBaked")
rigs.Dna, rigs.Rig, rigs.Instance, rigs.Batch, rigs.Baked = Dna, Rig, Instance, Batch, Baked

-- ---- DNA files --------------------------------------------------------------------------------------

-- Fields of MienDnaDesc; `system` may be a name, such as "unity".
local function dna_desc(options)
  if not options then return nil end
  local fields, system = {}, nil
  for name, value in pairs(options) do fields[name] = value end
  if type(fields.system) == "string" then
    system = object.info("MienCoordinateSystem")
    check(lib.mien_coordinate_system_find_n(fields.system, #fields.system, system), fields.system)
    fields.system = system
  end
  return object.desc("MienDnaDesc", fields), system
end

-- Opens a file. options: fields of MienDnaDesc.
function rigs.open_dna(path, options)
  local out, desc, system = ffi.new("MienDna*[1]"), dna_desc(options)
  check_detail(lib.mien_dna_open_file(path, desc, out, detail), path)
  return object.new(Dna, out, system)
end

-- Opens the bytes of a file, a string.
function rigs.open_dna_bytes(bytes, options)
  local out, desc, system = ffi.new("MienDna*[1]"), dna_desc(options)
  check_detail(lib.mien_dna_open_memory(bytes, #bytes, desc, out, detail), "cannot open the bytes")
  return object.new(Dna, out, { bytes, system })
end

-- Generates a rig; needs libmien-author. preset: mien.Preset; options: other fields of MienGenerateDesc.
function rigs.generate(preset, options)
  local author = library.author()
  local out, desc = ffi.new("MienDna*[1]"), object.desc("MienGenerateDesc", options or {})
  desc.preset = preset
  check_detail(author.mien_dna_generate(desc, out, detail), "cannot generate a rig")
  return object.new(Dna, out)
end

-- A MienDnaInfo.
function Dna:info()
  local info = object.info("MienDnaInfo")
  check(lib.mien_dna_info(open(self, Dna), info), "info")
  return info
end

-- Writes a file. options: fields of MienWriteDesc.
function Dna:save(path, options)
  check_detail(lib.mien_dna_write_file(open(self, Dna), path, object.desc("MienWriteDesc", options), detail), path)
end

-- The bytes of the file, a string.
function Dna:bytes(options)
  local handle, desc = open(self, Dna), object.desc("MienWriteDesc", options)
  return object.written(function(buffer, capacity, size)
    return lib.mien_dna_write_memory(handle, desc, buffer, capacity, size, detail)
  end, "cannot write")
end

-- A field of a loaded layer, by its path ("desc.name", "defn.jointNames[3]"): a string, a number, or a C array of
-- floats or int64_t and its count. docs/dna-format.md lists the fields.
function Dna:read(path)
  local handle, field = open(self, Dna), object.info("MienDnaField")
  check_detail(lib.mien_dna_field_n(handle, path, #path, field, detail), path)
  local count = tonumber(field.count)
  if field.type == api.FieldType.STRING and field.is_array == 0 then
    local view = ffi.new("MienStringView")
    check_detail(lib.mien_dna_read_string_n(handle, path, #path, view, detail), path)
    return object.text(view)
  end
  local floats = field.type == api.FieldType.F32
  local values = ffi.new(floats and "float[?]" or "int64_t[?]", math.max(count, 1))
  local read = floats and lib.mien_dna_read_floats_n or lib.mien_dna_read_integers_n
  check_detail(read(handle, path, #path, 0, count, values, detail), path)
  if field.is_array == 0 then return tonumber(values[0]) end
  return values, count
end

-- ---- rigs -------------------------------------------------------------------------------------------

-- Compiles a rig. The DNA may be closed afterwards. options: fields of MienRigDesc.
function rigs.rig(dna, options)
  local out = ffi.new("MienRig*[1]")
  check_detail(lib.mien_rig_create(open(dna, Dna), object.desc("MienRigDesc", options), out, detail),
    "cannot create the rig")
  return object.new(Rig, out)
end

-- A MienRigInfo.
function Rig:info()
  local info = object.info("MienRigInfo")
  check(lib.mien_rig_info(open(self, Rig), info), "info")
  return info
end

local out_number = ffi.new("uint32_t[1]")

-- How many there are of a mien.Kind.
function Rig:count(kind)
  check(lib.mien_rig_count(open(self, Rig), kind, out_number), "kind " .. tostring(kind))
  return out_number[0]
end

function Rig:name(kind, index)
  local view = ffi.new("MienStringView")
  check(lib.mien_rig_name(open(self, Rig), kind, index, view), ("index %s of kind %s"):format(index, kind))
  return object.text(view)
end

-- The index of a name, or nil.
function Rig:find(kind, name)
  local status = lib.mien_rig_find_n(open(self, Rig), kind, name, #name, out_number)
  if status == api.Status.NAME then return nil end
  check(status, name)
  return out_number[0]
end

-- The raw controls that a name of ARKit, VRM, FACS and others stands for: a list of { control = index, weight = }, and
-- how it was found, a mien.NameMatch. Nil if there is none.
function Rig:match(name)
  local shares, count = ffi.new("MienControlShare[?]", api.MOST_SHARES), ffi.new("size_t[1]")
  local status = lib.mien_rig_match(open(self, Rig), name, #name, shares, api.MOST_SHARES, count, out_number)
  if status == api.Status.NAME then return nil end
  check(status, name)
  local list = {}
  for i = 1, tonumber(count[0]) do list[i] = { control = shares[i - 1].control, weight = shares[i - 1].weight } end
  return list, out_number[0]
end

-- The parent of each joint; that of a root is itself.
function Rig:joint_parents()
  local handle = open(self, Rig)
  return object.view(self, "joint parents", "MienIndex16View", function(view)
    return lib.mien_rig_joint_parents(handle, view)
  end)
end

-- Translation, rotation and scale of each joint in the neutral pose: 9 or 10 numbers, as of Instance.joints.
function Rig:neutral_joint_values()
  local handle = open(self, Rig)
  return object.view(self, "neutral joint values", "MienFloatView", function(view)
    return lib.mien_rig_neutral_joint_values(handle, view)
  end)
end

-- Indices of a kind that a LOD computes.
function Rig:lod_indices(kind, lod)
  local handle = open(self, Rig)
  return object.view(self, ("kind %s of LOD %s"):format(kind, lod), "MienIndex16View", function(view)
    return lib.mien_rig_lod_indices(handle, kind, lod, view)
  end)
end

-- ---- instances --------------------------------------------------------------------------------------

local function array_of(self, name, type_name, call)
  self[name] = object.view(self, name, type_name, function(view) return call(self.handle, view) end)
end

-- A new character in its initial state. Its fields are arrays of its memory:
-- gui_controls, raw_controls, ml_masks: written by you
-- controls, joints, blend_shapes, animated_maps: results of the last evaluation
function Rig:instance()
  local handle, out = open(self, Rig), ffi.new("MienInstance*[1]")
  check_detail(lib.mien_instance_create(handle, nil, out, detail), "cannot create an instance")
  local new = object.new(Instance, out, handle)
  new.rig = self
  array_of(new, "gui_controls", "MienMutableFloatView", lib.mien_instance_gui_controls)
  array_of(new, "raw_controls", "MienMutableFloatView", lib.mien_instance_raw_controls)
  array_of(new, "ml_masks", "MienMutableFloatView", lib.mien_instance_ml_masks)
  array_of(new, "controls", "MienFloatView", lib.mien_instance_controls)
  array_of(new, "joints", "MienFloatView", lib.mien_instance_joints)
  array_of(new, "blend_shapes", "MienFloatView", lib.mien_instance_blend_shapes)
  array_of(new, "animated_maps", "MienFloatView", lib.mien_instance_animated_maps)
  return new
end

local function raw_control(self, name)
  local index = open(self, Instance) and self.rig:find(api.Kind.RAW_CONTROL, name)
  return index or object.throw(api.Status.NAME, "no raw control " .. name)
end

-- The value of a raw control, by its name. In loops, find its index once and use raw_controls[index].
function Instance:get(name) return self.raw_controls[raw_control(self, name)] end
function Instance:set(name, value) self.raw_controls[raw_control(self, name)] = value end

function Instance:reset() check(lib.mien_instance_reset(open(self, Instance)), "reset") end

-- Computes the raw controls from the GUI controls, or the reverse.
function Instance:map_gui_to_raw()
  check(lib.mien_rig_map_gui_to_raw(open(self.rig, Rig), open(self, Instance)), "GUI controls")
end
function Instance:map_raw_to_gui()
  check(lib.mien_rig_map_raw_to_gui(open(self.rig, Rig), open(self, Instance)), "raw controls")
end

-- Computes the results from the raw controls. lod: 0 without it; stages: mien.Stage, all without it.
function Instance:evaluate(lod, stages)
  local handle, rig = open(self, Instance), open(self.rig, Rig)
  local status
  if stages then
    status = lib.mien_rig_evaluate_stages(rig, handle, lod or 0, stages)
  else
    status = lib.mien_rig_evaluate(rig, handle, lod or 0)
  end
  check(status, "cannot evaluate: there is no such LOD or stage")
end

-- ---- batches ----------------------------------------------------------------------------------------

-- Evaluates up to `capacity` instances of the rig in one call.
function Rig:batch(capacity)
  local handle, out = open(self, Rig), ffi.new("MienBatch*[1]")
  check_detail(lib.mien_batch_create(handle, object.desc("MienBatchDesc", { capacity = capacity }), out, detail),
    "cannot create a batch")
  local new = object.new(Batch, out, handle)
  new.rig, new.capacity = self, capacity
  new._handles, new._lods = ffi.new("MienInstance*[?]", capacity), ffi.new("uint32_t[?]", capacity)
  return new
end

-- Evaluates a list of instances. lods: a list with one for each, one number for all, or nothing for 0.
-- The results are the bits of Instance.evaluate.
function Batch:evaluate(instances, lods, stages)
  local handle, count = open(self, Batch), #instances
  if count > self.capacity then
    object.invalid("%d instances in a batch for %d", count, self.capacity)
  end
  if type(lods) == "table" and #lods ~= count then object.invalid("%d instances and %d LODs", count, #lods) end
  for i = 1, count do
    self._handles[i - 1] = open(instances[i], Instance)
    self._lods[i - 1] = type(lods) == "table" and lods[i] or type(lods) == "number" and lods or 0
  end
  check(lib.mien_rig_evaluate_batch(open(self.rig, Rig), handle, self._handles, self._lods, count,
    stages or api.Stage.ALL, nil),
    "cannot evaluate: LODs exist, and instances are different ones of the batch's rig")
end

-- ---- baked files ------------------------------------------------------------------------------------

-- Writes the rig, and its deformer if there is one, to a file that is used as it is.
function Rig:bake(path, deformer)
  check_detail(lib.mien_bake_file(open(self, Rig), deformer and open(deformer, rigs.Deformer), path, detail), path)
end

-- The same as a string.
function Rig:bake_bytes(deformer)
  local handle, meshes = open(self, Rig), deformer and open(deformer, rigs.Deformer)
  return object.written(function(buffer, capacity, size)
    return lib.mien_bake_memory(handle, meshes, buffer, capacity, size, detail)
  end, "cannot bake")
end

-- Opens a baked file. options: fields of MienBakedDesc. A file that is mapped must not change while it is used.
function rigs.open_baked(path, options)
  local out = ffi.new("MienBaked*[1]")
  check_detail(lib.mien_baked_open_file(path, object.desc("MienBakedDesc", options), out, detail), path)
  return object.new(Baked, out)
end

function rigs.open_baked_bytes(bytes, options)
  local out = ffi.new("MienBaked*[1]")
  check_detail(lib.mien_baked_open_memory(bytes, #bytes, object.desc("MienBakedDesc", options), out, detail),
    "cannot open the bytes")
  return object.new(Baked, out, bytes)
end

-- A MienBakedInfo.
function Baked:info()
  local info = object.info("MienBakedInfo")
  check(lib.mien_baked_info(open(self, Baked), info), "info")
  return info
end

-- Its rig. The baked file may be closed afterwards. options: fields of MienBakedRigDesc.
function Baked:rig(options)
  local handle, out = open(self, Baked), ffi.new("MienRig*[1]")
  check_detail(lib.mien_rig_from_baked(handle, object.desc("MienBakedRigDesc", options), out, detail),
    "cannot create the rig")
  return object.new(Rig, out, handle)
end

return rigs
