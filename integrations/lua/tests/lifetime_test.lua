-- SPDX-License-Identifier: MIT
-- What is reachable stays, what is not is released, in any order.
local ffi = require("ffi")
local mien = require("mien")
local object = require("mien.object")
local support = require("support")
local test, equal = support.test, support.equal

-- An entry of a weak table goes a cycle after its key, and owners form chains.
local function collect()
  for _ = 1, 8 do collectgarbage() end
end

-- Which handles are still there.
local function watched(...) return setmetatable({ ... }, { __mode = "v" }) end

local function check_kept(make, what)
  local handles, holder = make()
  collect()
  for _, name in ipairs(what) do assert(handles[name], name .. " was released too early") end
  assert(holder) -- lives until here
  holder = nil
  collect()
  for _, name in ipairs(what) do assert(not handles[name], name .. " was not released") end
end

local function handles_of(objects)
  local handles = watched()
  for name, made in pairs(objects) do handles[name] = made.handle end
  return handles
end

test("handles are kept by arrays and by what is made of them, and no longer", function()
  check_kept(function()
    local rig = support.small()
    local face = rig:instance()
    return handles_of { rig = rig, face = face }, face.joints
  end, { "rig", "face" })
  check_kept(function()
    local rig, deformer = support.small()
    local body = deformer:instance()
    body:deform(0)
    return handles_of { deformer = deformer, body = body }, body:positions(0)
  end, { "deformer", "body" })
  check_kept(function()
    local rig, deformer = support.small()
    local baked = mien.open_baked_bytes(rig:bake_bytes(deformer))
    local same = baked:rig()
    local handles = handles_of { baked = baked, rig = same }
    baked:close()
    return handles, same:instance()
  end, { "baked", "rig" })
  check_kept(function()
    local clip = mien.open_clip_bytes(mien.build_clip({ names = { "a" }, values = { 1 } }):bytes())
    return handles_of { clip = clip }, clip:player().values
  end, { "clip" })
  check_kept(function()
    local rig = support.small()
    local clip = mien.build_clip { names = { rig:name(mien.Kind.RAW_CONTROL, 0) }, values = { 1, 1 } }
    local mixer, binding = rig:mix { layers = { { source = mien.LayerSource.CLIP } } }:mixer(), clip:bind(rig)
    mixer:play(0, clip, binding)
    return handles_of { clip = clip, binding = binding, mixer = mixer }, mixer.row
  end, { "clip", "binding", "mixer" })
end)

test("an array keeps its memory when the instance is gone", function()
  local function joints_of_a_pose()
    local rig = support.small()
    local face = rig:instance()
    support.pose(face, 3)
    face:evaluate(0)
    return face.joints, face.joints:list()
  end
  local joints, values = joints_of_a_pose()
  collect()
  for _ = 1, 50 do support.small():instance():evaluate(0) end
  for i, value in ipairs(values) do equal(joints[i - 1], value, "joint value") end
end)

test("children keep bytes and parents", function()
  local function clip_player()
    local clip = mien.build_clip { names = { "a" }, values = { 0.25, 0.5 } }
    return mien.open_clip_bytes(clip:bytes()):player()
  end
  local function baked_face()
    local rig, deformer = support.small()
    local baked = mien.open_baked_bytes(rig:bake_bytes(deformer))
    local same = baked:rig()
    local body = baked:deformer(same):instance()
    baked:close()
    return same:instance(), body
  end
  local player = clip_player()
  local face, body = baked_face()
  collect()
  local waste = {}
  for i = 1, 200 do waste[i] = ("x"):rep(100000 + i) end
  support.pose(face, 2)
  face:evaluate(0)
  body:update(face)
  body:deform(0)
  equal(player:sample()[0], 0.25, "value")
  local rig = support.small()
  local expected = rig:instance()
  support.pose(expected, 2)
  expected:evaluate(0)
  support.arrays_equal(face.joints, expected.joints, "joints")
end)

test("a mixer keeps its clip, closed or collected", function()
  local rig = support.small()
  local name = rig:name(mien.Kind.RAW_CONTROL, 0)
  local mixer = rig:mix { layers = { { source = mien.LayerSource.CLIP }, { source = mien.LayerSource.CLIP } } }:mixer()
  local function play(layer, value, close)
    local clip = mien.build_clip { names = { name }, values = { value, value }, looping = mien.Looping.CLAMP }
    local again = mien.open_clip_bytes(clip:bytes())
    local binding = again:bind(rig)
    mixer:play(layer, again, binding, { transition = mien.Transition.CUT })
    if close then
      again._destroy = function() error("the clip is released while it plays") end
      binding._destroy = again._destroy
      again:close()
      binding:close()
    end
  end
  play(0, 0.75, true)
  play(1, 0.5, false)
  collect()
  for i = 1, 50 do mien.build_clip { names = { "b" }, values = { i, i, i } } end
  mixer:step(mien.TICKS_PER_SECOND / 60)
  equal(mixer.row[0], 0.5, "the upper layer")
  mixer:set_weight(1, 0)
  mixer:step(mien.TICKS_PER_SECOND / 60)
  equal(mixer.row[0], 0.75, "the lower layer")
end)

test("objects that nothing refers to are released", function()
  -- Counts the calls of a destructor through a handle of the same kind.
  local released = 0
  local class = object.class("Counted", "MienRig")
  local stub = { mien_rig_destroy = function() released = released + 1 end }
  local out = ffi.new("MienRig*[1]")
  for i = 1, 100 do
    out[0] = ffi.cast("MienRig*", i * 64)
    local counted = object.new(class, out, nil, stub)
    if i <= 40 then
      counted:close()
      counted:close()
      equal(released, i, "closed objects")
    end
  end
  collect()
  equal(released, 100, "released objects")
end)

-- Resident memory of the process in MiB, or nil where /proc is missing.
local function resident()
  local file = io.open("/proc/self/statm")
  if not file then return nil end
  local pages = tonumber(file:read("*a"):match("^%d+ (%d+)"))
  file:close()
  return pages * 4096 / 2 ^ 20
end

test("hundreds of rigs, closed or not, take the memory of a few", function()
  if not resident() then return print("NOT TESTED: memory of released objects; there is no /proc") end
  local bytes = mien.generate(mien.Preset.MEDIUM):bytes()
  local function make(close)
    local dna = mien.open_dna_bytes(bytes)
    local rig = mien.rig(dna)
    local face = rig:instance()
    face:evaluate(0)
    if close then
      for _, made in ipairs { dna, face, rig } do made:close() end
    end
    return tonumber(rig.handle and rig:info().rig_bytes)
  end
  local size = make(false)
  for i = 1, 20 do make(i % 2 == 0) end
  collect()
  local before = resident()
  for i = 1, 200 do
    make(i % 2 == 0)
    if i % 10 == 0 then collect() end
  end
  collect()
  local grown, of_all = resident() - before, 200 * size / 2 ^ 20
  assert(grown < of_all / 4, ("memory grew by %.1f MiB; the rigs had %.1f"):format(grown, of_all))
end)

test("objects that are open when the state ends", function()
  -- Released by lua_close(), which support.finish() calls.
  local rig, deformer = support.small()
  _G.left_open = { rig:instance(), deformer:instance(), rig:batch(2) }
end)

support.finish()
