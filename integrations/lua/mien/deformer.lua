-- SPDX-License-Identifier: MIT
-- Deformers: meshes of a rig, and the deformed meshes of characters.
local ffi = require("ffi")
local object = require("mien.object")
local rigs = require("mien.rig")
local lib = require("mien.library").lib
local open, check, check_detail, detail = object.open, object.check, object.check_detail, object.error_detail

local deformers = {}
local Deformer = object.class("Deformer", "MienDeformer")
local DeformerInstance = object.class("DeformerInstance", "MienDeformerInstance")
deformers.Deformer, deformers.DeformerInstance, rigs.Deformer = Deformer, DeformerInstance, Deformer

-- The meshes of a DNA for a rig made from it. The DNA may be closed afterwards. options: fields of MienDeformerDesc.
function deformers.deformer(dna, rig, options)
  local out, rig_handle = ffi.new("MienDeformer*[1]"), open(rig, rigs.Rig)
  check_detail(lib.mien_deformer_create(open(dna, rigs.Dna), rig_handle, object.desc("MienDeformerDesc", options),
    out, detail), "cannot create the deformer")
  return object.new(Deformer, out, rig_handle)
end

-- The deformer of a baked file, for its rig. options: fields of MienBakedDeformerDesc.
function rigs.Baked:deformer(rig, options)
  local handle, rig_handle, out = open(self, rigs.Baked), open(rig, rigs.Rig), ffi.new("MienDeformer*[1]")
  check_detail(lib.mien_deformer_from_baked(handle, rig_handle, object.desc("MienBakedDeformerDesc", options), out,
    detail), "cannot create the deformer")
  return object.new(Deformer, out, { handle, rig_handle })
end

-- A MienDeformerInfo.
function Deformer:info()
  local info = object.info("MienDeformerInfo")
  check(lib.mien_deformer_info(open(self, Deformer), info), "info")
  return info
end

-- A neutral mesh as a table: counts, and arrays `positions`, `normals`, `tangents`, `texture_coordinates`,
-- `vertex_position_indices`, `triangles` and `target_channels`, described at MienMesh.
function Deformer:mesh(mesh)
  local handle, found = open(self, Deformer), object.info("MienMesh")
  check(lib.mien_deformer_mesh(handle, mesh, found), "no mesh " .. tostring(mesh))
  local result = {}
  for _, name in ipairs { "position_count", "vertex_count", "triangle_count", "max_influences", "target_count",
    "delta_count", "lods" } do
    result[name] = tonumber(found[name])
  end
  for name, type_name in pairs {
    positions = "MienFloatView", normals = "MienFloatView", tangents = "MienFloatView",
    texture_coordinates = "MienFloatView", vertex_position_indices = "MienIndex32View",
    triangles = "MienIndex32View", target_channels = "MienIndex16View",
  } do
    result[name] = object.view(self, name .. " of mesh " .. mesh, type_name, function(view)
      view.data, view.count = found[name].data, found[name].count
      return 0
    end)
  end
  return result
end

-- The triangles of a mesh, three vertices each, as a C array, and its length; with any storage.
function Deformer:triangles(mesh)
  local handle, found = open(self, Deformer), object.info("MienMesh")
  check(lib.mien_deformer_mesh(handle, mesh, found), "no mesh " .. tostring(mesh))
  local count = 3 * tonumber(found.triangle_count)
  local result = ffi.new("uint32_t[?]", math.max(count, 1))
  check(lib.mien_deformer_triangles(handle, mesh, result, count), "triangles")
  return result, count
end

-- u v of each vertex of a mesh, as a C array, and its length; with any storage.
function Deformer:texture_coordinates(mesh)
  local handle, found = open(self, Deformer), object.info("MienMesh")
  check(lib.mien_deformer_mesh(handle, mesh, found), "no mesh " .. tostring(mesh))
  local count = 2 * tonumber(found.vertex_count)
  local result = ffi.new("float[?]", math.max(count, 1))
  check(lib.mien_deformer_texture_coordinates(handle, mesh, result, count), "texture coordinates")
  return result, count
end

-- A new character in the neutral pose. options: fields of MienDeformerInstanceDesc.
function Deformer:instance(options)
  local handle, out = open(self, Deformer), ffi.new("MienDeformerInstance*[1]")
  check_detail(lib.mien_deformer_instance_create(handle, object.desc("MienDeformerInstanceDesc", options), out, detail),
    "cannot create a deformer instance")
  local new = object.new(DeformerInstance, out, handle)
  new.deformer, new._positions, new._normals = self, {}, {}
  -- 16 numbers per joint, column by column.
  new.joint_matrices = object.view(new, "joint matrices", "MienFloatView", function(view)
    return lib.mien_deformer_instance_joint_matrices(new.handle, view)
  end)
  new.skin_matrices = object.view(new, "skin matrices", "MienFloatView", function(view)
    return lib.mien_deformer_instance_skin_matrices(new.handle, view)
  end)
  return new
end

-- Takes over the last evaluation of an instance and computes all matrices; then `deform` deforms meshes.
function DeformerInstance:update(instance)
  check(lib.mien_deformer_instance_update(open(self, DeformerInstance), open(instance, rigs.Instance)),
    "the instance is of another rig")
end

-- The same from C arrays of floats: joint values like those of Instance.joints, and a weight per blend shape channel.
-- Without values there are no deltas, without weights all are 0.
function DeformerInstance:update_from_values(joint_values, joint_value_count, channel_weights, channel_weight_count)
  check(lib.mien_deformer_instance_update_from_values(open(self, DeformerInstance), joint_values,
    joint_value_count or 0, channel_weights, channel_weight_count or 0), "the rig has another number of values")
end

-- Computes positions and normals of a mesh. normals: mien.Normals, those of the deformer without it.
function DeformerInstance:deform(mesh, normals)
  check(lib.mien_deformer_instance_deform(open(self, DeformerInstance), mesh, normals or 0, nil), "cannot deform")
end

-- 3 numbers per position, of the last deform of this mesh.
function DeformerInstance:positions(mesh)
  local handle, found = open(self, DeformerInstance), self._positions[mesh]
  if found then return found end
  found = object.view(self, "positions of mesh " .. tostring(mesh), "MienFloatView", function(view)
    return lib.mien_deformer_instance_positions(handle, mesh, view)
  end)
  self._positions[mesh] = found
  return found
end

-- 3 numbers per vertex, of the last deform of this mesh that computed normals.
function DeformerInstance:normals(mesh)
  local handle, found = open(self, DeformerInstance), self._normals[mesh]
  if found then return found end
  found = object.view(self, "normals of mesh " .. tostring(mesh), "MienFloatView", function(view)
    return lib.mien_deformer_instance_normals(handle, mesh, view)
  end)
  self._normals[mesh] = found
  return found
end

-- Deforms a mesh and writes its vertices to memory of yours, as a MienVertexOutput describes it (ffi.new).
function DeformerInstance:write_vertices(mesh, output, normals)
  output.struct_size = ffi.sizeof("MienVertexOutput")
  check(lib.mien_deformer_instance_write_vertices(open(self, DeformerInstance), mesh, normals or 0, output, nil),
    "cannot write the vertices")
end

return deformers
