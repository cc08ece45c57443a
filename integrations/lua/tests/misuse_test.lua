-- SPDX-License-Identifier: MIT
-- Wrong use raises an error that says what is wrong, and leaves the objects usable.
local mien = require("mien")
local support = require("support")
local test, equal, fails, raises = support.test, support.equal, support.fails, support.raises
local Status = mien.Status

local rig, deformer = support.small()
local other_rig = mien.rig(mien.generate(mien.Preset.MEDIUM))
local name = rig:name(mien.Kind.RAW_CONTROL, 0)
local clip = mien.build_clip { names = { name }, values = { 0, 1 } }

test("files that are none", function()
  local e = fails(Status.FILE_OPEN, "/nowhere/head.dna", mien.open_dna, "/nowhere/head.dna")
  equal(tostring(e), "FILE_OPEN: " .. e.message, "text")
  fails(Status.DNA_SIGNATURE, "", mien.open_dna_bytes, "This is not a DNA file, but long enough for one.")
  local bytes = mien.generate(mien.Preset.SMALL):bytes()
  local status = { [Status.DNA_TRUNCATED] = true, [Status.DNA_STRUCTURE] = true }
  for _, length in ipairs { 0, 1, 20, 1000, #bytes - 1 } do
    local passed, cut = pcall(mien.open_dna_bytes, bytes:sub(1, length))
    assert(not passed and (status[cut.status] or length < 20), tostring(cut))
  end
  local passed, offset = pcall(mien.open_dna_bytes, bytes:sub(1, 1000))
  assert(not passed and type(offset.byte_offset) == "number", "no byte offset")
  for _, open in ipairs { mien.open_baked_bytes, mien.open_clip_bytes } do
    assert(not pcall(open, "This is neither a baked rig nor a clip, whatever its length may be."))
  end
  assert(not pcall(mien.open_mix_bytes, "Nor is it a mix, in bytes or in text.", rig))
end)

test("closed objects", function()
  local dna = mien.generate(mien.Preset.SMALL)
  local own = mien.rig(dna)
  local meshes = mien.deformer(dna, own)
  local face, body, batch = own:instance(), meshes:instance(), own:batch(1)
  local own_clip = mien.build_clip { names = { name }, values = { 0, 1 } }
  local player, mix = own_clip:player(), own:mix { layers = { { source = mien.LayerSource.CLIP } } }
  local mixer, binding = mix:mixer(), own_clip:bind(own)
  local joints, positions = face.joints, body:positions(0)
  assert(#joints > 0 and #positions > 0)
  local objects = { dna, own, meshes, face, body, batch, own_clip, player, binding, mix, mixer }
  for _, object in ipairs(objects) do
    object:close()
    object:close()
    assert(tostring(object):find("closed"))
  end
  for text, call in pairs {
    ["mien.Dna"] = function() mien.rig(dna) end, ["mien.Rig"] = function() own:instance() end,
    ["mien.Deformer"] = function() meshes:instance() end, ["mien.Instance"] = function() face:evaluate(0) end,
    ["mien.DeformerInstance"] = function() body:deform(0) end, ["mien.Batch"] = function() batch:evaluate({}) end,
    ["mien.Clip"] = function() own_clip:read() end, ["mien.ClipPlayer"] = function() player:sample() end,
    ["mien.ClipBinding"] = function() binding:apply(player.values, rig:instance()) end,
    ["mien.Mix"] = function() mix:mixer() end, ["mien.Mixer"] = function() mixer:step(1) end,
  } do
    fails(Status.HANDLE, "this " .. text .. " is closed", call)
  end
  equal(#joints, 0, "elements of a closed instance")
  fails(Status.INDEX, "index 0 of 0", function() return joints[0] end)
  fails(Status.INDEX, "index 0 of 0", function() return face.raw_controls[0] end)
  fails(Status.INDEX, "index 0 of 0", function() face.raw_controls[0] = 1 end)
  fails(Status.INDEX, "index 0 of 0", function() return positions[0] end)
  equal(#player.values + #mixer.row + #body.skin_matrices, 0, "elements of closed objects")
end)

test("an instance of a closed rig", function()
  local own = support.small()
  local face = own:instance()
  own:close()
  fails(Status.HANDLE, "this mien.Rig is closed", face.evaluate, face, 0)
  equal(#face.joints > 0, true, "joints are still there")
end)

test("objects of another type", function()
  local face = rig:instance()
  fails(Status.INVALID_ARGUMENT, "expected a mien.Dna", mien.rig, rig)
  fails(Status.INVALID_ARGUMENT, "expected a mien.Instance", face.evaluate, 0)
  fails(Status.INVALID_ARGUMENT, "expected a mien.Instance", face.evaluate, nil)
  fails(Status.INVALID_ARGUMENT, "expected a mien.Rig", clip.bind, clip, face)
  fails(Status.INVALID_ARGUMENT, "expected a mien.Instance", function() rig:batch(1):evaluate({ rig }) end)
  fails(Status.INVALID_ARGUMENT, "expected a mien.Deformer",
    function() rig:mix { layers = {}, deformer = rig } end)
  raises("cannot convert", face.evaluate, face, "low")
  raises("cannot convert", rig.count, rig, {})
end)

test("objects of another rig", function()
  local face, stranger = rig:instance(), other_rig:instance()
  fails(Status.MISMATCH, "another rig", function() deformer:instance():update(stranger) end)
  fails(Status.MISMATCH, "", function() rig:batch(2):evaluate({ face, stranger }) end)
  local mixer = rig:mix { layers = { { source = mien.LayerSource.CLIP } } }:mixer()
  fails(Status.MISMATCH, "", mixer.play, mixer, 0, clip, clip:bind(other_rig))
  fails(Status.MISMATCH, "", mixer.step, mixer, 1, stranger)
  fails(Status.INVALID_ARGUMENT, "", function() clip:bind(rig):apply(face.joints, face) end)
end)

test("indices, LODs and sizes", function()
  local face = rig:instance()
  local count = #face.raw_controls
  for _, index in ipairs { -1, count, 1e9, 0 / 0 } do
    fails(Status.INDEX, "of " .. count .. " elements", function() return face.raw_controls[index] end)
    fails(Status.INDEX, "of " .. count .. " elements", function() face.raw_controls[index] = 1 end)
  end
  fails(Status.INVALID_ARGUMENT, "arrays have no jaw", function() return face.joints.jaw end)
  raises("constant", function() face.joints[0] = 1 end)
  fails(Status.LOD, "", face.evaluate, face, 99)
  fails(Status.LOD, "", face.evaluate, face, -1)
  fails(Status.INDEX, "", rig.name, rig, mien.Kind.JOINT, 1e6)
  fails(Status.NAME, "nobody", face.set, face, "nobody", 1)
  fails(Status.INDEX, "no mesh 99", deformer.mesh, deformer, 99)
  fails(Status.INDEX, "", function() deformer:instance():deform(99) end)
  local batch = rig:batch(1)
  fails(Status.INVALID_ARGUMENT, "2 instances in a batch for 1", batch.evaluate, batch, { face, rig:instance() })
  fails(Status.INVALID_ARGUMENT, "1 instances and 2 LODs", batch.evaluate, batch, { face }, { 0, 0 })
  fails(Status.INVALID_ARGUMENT, "", function() rig:batch(2):evaluate({ face, face }) end)
  fails(Status.INVALID_ARGUMENT, "3 values are no rows of 2", mien.build_clip,
    { names = { "a", "b" }, values = { 1, 2, 3 } })
  fails(Status.INVALID_ARGUMENT, "frames 1 to 3 of 2", clip.read, clip, 1, 2)
  local mixer = rig:mix { layers = { { source = mien.LayerSource.STREAM, curves = { name } } } }:mixer()
  fails(Status.INVALID_ARGUMENT, "out of range", function() clip:player():set_speed(1, 0) end)
  fails(Status.INVALID_ARGUMENT, "number of values", function() deformer:instance():update_from_values(nil, 1) end)
  fails(Status.NAME, "nothing", function() mien.generate(mien.Preset.SMALL):read("defn.nothing") end)
  fails(Status.INVALID_ARGUMENT, "", mixer.stage, mixer, 0)
  fails(Status.INDEX, "no guard 0", mixer.guard, mixer, 0)
  fails(Status.NAME, "", function() deformer:gaze { left_eye = "nobody" } end)
  fails(Status.MISMATCH, "", mixer.push, mixer, 0, 1, { 1, 2 })
  fails(Status.INDEX, "", mixer.set_weight, mixer, 1, 1)
  face:evaluate(0)
end)

test("names of fields and enums", function()
  local dna = mien.generate(mien.Preset.SMALL)
  raises("no member named 'ias'", mien.rig, dna, { ias = 1 })
  raises("no member named 'wieght'", function() rig:mix { layers = { { source = 0, wieght = 1 } } } end)
  fails(Status.NAME, "no raw control or variable nobody",
    function() rig:mix { layers = { { source = mien.LayerSource.POSES, poses = { { nobody = 1 } } } } } end)
  fails(Status.INDEX, "curve -1", function() rig:mix { layers = { { source = 0, mask = { [-1] = 1 } } } } end)
  raises("mien.Kind has no JIONT", function() return mien.Kind.JIONT end)
  raises("does not change", function() mien.Kind.JIONT = 1 end)
  fails(Status.NAME, "nowhere", mien.open_dna, "head.dna", { system = "nowhere" })
  fails(Status.INVALID_ARGUMENT, "isa is 999", mien.rig, dna, { isa = 999 })
end)

support.finish()
