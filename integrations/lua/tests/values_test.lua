-- SPDX-License-Identifier: MIT
-- What the classes give is what the library computes, by every way to it; frames allocate nothing.
local ffi = require("ffi")
local api = require("mien.api")
local mien = require("mien")
local support = require("support")
local test, equal, arrays_equal = support.test, support.equal, support.arrays_equal

test("structs have the sizes of the header", function()
  local count = 0
  for name, size in pairs(api.sizes) do
    equal(ffi.sizeof(name), size, name)
    count = count + 1
  end
  assert(count > 50)
end)

test("batch, stages and baked files give the bits of evaluate", function()
  local rig, deformer = support.small()
  local baked = mien.open_baked_bytes(rig:bake_bytes(deformer))
  local same_rig = baked:rig()
  local batch, faces, again = rig:batch(4), {}, {}
  for i = 1, 3 do
    faces[i], again[i] = rig:instance(), rig:instance()
    support.pose(faces[i], i)
    support.pose(again[i], i)
  end
  batch:evaluate(faces)
  local other = same_rig:instance()
  local moved = 0
  for i = 1, 3 do
    again[i]:evaluate(0)
    arrays_equal(faces[i].joints, again[i].joints, "joints of batch")
    arrays_equal(faces[i].blend_shapes, again[i].blend_shapes, "blend shapes of batch")
    support.pose(other, i)
    other:evaluate(0)
    arrays_equal(other.joints, again[i].joints, "joints of the baked rig")
    for j = 0, #other.joints - 1 do moved = moved + math.abs(other.joints[j]) end
  end
  assert(moved > 1)
  for j = 0, #faces[1].joints - 1 do
    if faces[1].joints[j] ~= faces[2].joints[j] then return end
  end
  error("different controls gave the same joints")
end)

test("a DNA file survives memory and disk", function()
  local dna = mien.generate(mien.Preset.SMALL, { seed = 5 })
  local bytes, path = dna:bytes(), os.tmpname()
  equal(dna:info().raw_control_count, mien.rig(dna):count(mien.Kind.RAW_CONTROL), "raw controls")
  dna:save(path)
  local again = mien.open_dna(path, { file_access = mien.FileAccess.READ })
  equal(again:bytes(), bytes, "bytes")
  equal(mien.open_dna_bytes(bytes):bytes(), bytes, "bytes")
  local meters = mien.open_dna(path, { system = "unity" })
  equal(meters:info().translation_unit, mien.TranslationUnit.METERS, "unit")
  os.remove(path)
end)

test("names and indices are inverse", function()
  local rig = support.small()
  for _, kind in ipairs { mien.Kind.RAW_CONTROL, mien.Kind.JOINT } do
    assert(rig:count(kind) > 2)
    for i = 0, rig:count(kind) - 1 do equal(rig:find(kind, rig:name(kind, i)), i, "index") end
  end
  equal(rig:find(mien.Kind.JOINT, "nobody"), nil, "index of an unknown name")
  equal(#rig:joint_parents(), rig:count(mien.Kind.JOINT), "parents")
  local face, name = rig:instance(), rig:name(mien.Kind.RAW_CONTROL, 2)
  face:set(name, 0.25)
  equal(face.raw_controls[2], 0.25, name)
  equal(face:get(name), 0.25, name)
end)

test("the deformer moves what joints move, and writes the same vertices", function()
  local rig, deformer = support.small()
  local face, body = rig:instance(), deformer:instance()
  local mesh = deformer:mesh(0)
  local triangles, corners = deformer:triangles(0)
  local coordinates, numbers = deformer:texture_coordinates(0)
  equal(corners, 3 * mesh.triangle_count, "corners")
  equal(numbers, 2 * mesh.vertex_count, "coordinates")
  for i = 0, corners - 1 do equal(triangles[i], mesh.triangles[i], "corner") end
  for i = 0, numbers - 1 do equal(coordinates[i], mesh.texture_coordinates[i], "coordinate") end
  body:update(face)
  body:deform(0, mien.Normals.RECOMPUTED)
  equal(#body:positions(0), 3 * mesh.position_count, "numbers")
  local neutral = body:positions(0):list()
  for i, value in ipairs(neutral) do assert(math.abs(value - mesh.positions[i - 1]) < 1e-3) end
  support.pose(face, 1)
  face:evaluate(0)
  body:update(face)
  body:deform(0, mien.Normals.RECOMPUTED)
  local farthest = 0
  for i, value in ipairs(neutral) do farthest = math.max(farthest, math.abs(body:positions(0)[i - 1] - value)) end
  assert(farthest > 0.01)
  equal(#body.skin_matrices, 16 * rig:count(mien.Kind.JOINT), "matrices")

  local vertices, output = ffi.new("float[?]", 3 * mesh.vertex_count), ffi.new("MienVertexOutput")
  output.vertex_capacity = mesh.vertex_count
  output.positions = { data = vertices, stride = 12, format = mien.VertexFormat.FLOAT32X3 }
  body:write_vertices(0, output)
  for i = 0, mesh.vertex_count - 1 do
    local position = mesh.vertex_position_indices[i]
    for k = 0, 2 do equal(vertices[3 * i + k], body:positions(0)[3 * position + k], "vertex") end
  end
end)

test("clips keep every bit, play, and drive the controls they name", function()
  local rig = support.small()
  local names, values = { rig:name(mien.Kind.RAW_CONTROL, 1), "nobody" }, {}
  for i = 0, 199 do values[i + 1] = ffi.new("float[1]", i / 300)[0] end
  local clip = mien.build_clip { names = names, values = values, rate_numerator = 30,
    events = { { tick = mien.ticks(0.5), name = "step", value = 2 } } }
  local read, path = clip:read(), os.tmpname()
  for i, value in ipairs(values) do equal(read[i - 1], value, "value") end
  clip:save(path)
  local opened = mien.open_clip(path)
  equal(opened:bytes(), clip:bytes(), "bytes")
  os.remove(path)
  equal(clip:info().frame_count, 100, "frames")
  local player, face = mien.open_clip_bytes(clip:bytes()):player(), rig:instance()
  player:advance(mien.ticks(1))
  equal(player:sample()[0], values[61], "frame 30")
  clip:bind(rig):apply(player.values, face)
  equal(face.raw_controls[1], values[61], "control")
  equal(face.raw_controls[2], 0, "another control")
end)

test("a mix opens again, its mixer restores, events arrive", function()
  local rig = support.small()
  local name, other = rig:name(mien.Kind.RAW_CONTROL, 0), rig:name(mien.Kind.RAW_CONTROL, 1)
  local mix = rig:mix {
    variables = { "surprise" },
    layers = {
      { source = mien.LayerSource.CLIP, mask = { [name] = 1, [other] = 0.5, surprise = 1 } },
      { source = mien.LayerSource.POSES, group = mien.LayerGroup.EMOTION, mode = mien.BlendMode.ADD,
        poses = { { [other] = 0.25 } } },
      { source = mien.LayerSource.STREAM, group = mien.LayerGroup.EMOTION, mode = mien.BlendMode.ADD,
        curves = { "surprise" } },
    },
  }
  equal(mien.open_mix_bytes(mix:bytes(), rig):bytes(), mix:bytes(), "bytes")
  assert(mix:text():find(name, 1, true))
  equal(mix:info().layer_count, 3, "layers")
  local clip = mien.build_clip { names = { name, other }, values = { 0.5, 0.5, 0.5, 0.5 }, looping = mien.Looping.CLAMP,
    events = { { tick = 100, name = "now", value = 3 } } }
  local binding = clip:bind(rig)
  local mixer, face, frame = mix:mixer(), rig:instance(), mien.TICKS_PER_SECOND / 60
  mixer:play(0, clip, binding, { clip_id = 7, transition = mien.Transition.CUT })
  mixer:set_pose_weight(1, 0, 1)
  equal(mixer:push(2, 1, { 0.75 }), true, "first row")
  equal(mixer:push(2, 1, { 0.75 }), false, "a row that is not newer")
  mixer:step(frame, face)
  equal(face.raw_controls[0], 0.5, name)
  equal(face.raw_controls[1], 0.5, other)
  equal(mixer:info().event_count, 1, "events")
  local event = mixer:event(0)
  equal(event.name .. event.tick .. event.value .. event.layer, "now10030", "event")
  for i = 1, 60 do -- the stream fades in
    mixer:push(2, (i + 1) * frame, { 0.75 })
    mixer:step(frame)
  end
  equal(mixer.row[#face.raw_controls], 0.75, "surprise")

  local state, twin = mixer:snapshot(), mix:mixer()
  twin:restore(state, { { clip_id = 7, clip = clip, binding = binding } })
  mixer:set_pose_weight(1, 0, 0, 5 * frame)
  twin:set_pose_weight(1, 0, 0, 5 * frame)
  for _ = 1, 4 do
    mixer:step(frame)
    twin:step(frame)
    for i = 0, #face.raw_controls - 1 do equal(twin.row[i], mixer.row[i], "row") end
  end
end)

test("fields of DNA files are numbers, strings and arrays", function()
  local dna = mien.generate(mien.Preset.SMALL, { seed = 5 })
  local rig = mien.rig(dna)
  equal(dna:read("defn.jointNames[2]"), rig:name(mien.Kind.JOINT, 2), "name")
  local xs, count = dna:read("defn.neutralJointTranslations.xs")
  equal(count, rig:count(mien.Kind.JOINT), "joints")
  for i = 0, count - 1 do equal(xs[i], rig:neutral_joint_values()[9 * i], "x") end
  equal(type(dna:read("desc.lodCount")), "number", "type of a number")
  local parents, parent_count = dna:read("defn.jointHierarchy")
  for i = 0, tonumber(parent_count) - 1 do equal(tonumber(parents[i]), rig:joint_parents()[i], "parent") end
end)

test("players change speed and give events; bindings tell what they drive", function()
  local rig = support.small()
  local name = rig:name(mien.Kind.RAW_CONTROL, 3)
  local clip = mien.build_clip { names = { name, "nobody" }, values = { 0, 0, 1, 0, 0, 0, 1, 0 }, rate_numerator = 1,
    events = { { tick = mien.ticks(1), name = "one" }, { tick = mien.ticks(2), name = "two", value = 2 } } }
  local player, found = clip:player(), clip:bind(rig):info()
  equal(table.concat(found.controls, " "), "3", "controls")
  equal(table.concat(found.missing_channels, " "), "1", "channels")
  equal(#found.extra_controls, rig:count(mien.Kind.RAW_CONTROL) - 1, "other controls")
  player:set_speed(2)
  player:advance(mien.ticks(1))
  equal(tonumber(player:info().tick), mien.ticks(2), "tick")
  equal(player:next_event().name .. player:next_event().value, "one2", "events")
  equal(player:next_event(), nil, "a third event")
  equal(mien.build_clip({ names = { "eyeBlinkLeft" }, values = { 1 } }):bind(rig, mien.arkit_matrix()):info() ~= nil, true,
    "a binding by the matrix")
  assert(#mien.arkit_matrix() >= 52)
end)

test("tables measured on the generated head: names, antagonists, mirror, gaze, guards", function()
  local dna = mien.generate(mien.Preset.HEAD)
  local rig = mien.rig(dna)
  local deformer, face = mien.deformer(dna, rig), rig:instance()
  local left, right = rig:find(mien.Kind.RAW_CONTROL, "eyeBlinkLeft"), rig:find(mien.Kind.RAW_CONTROL, "eyeBlinkRight")
  local shares, match = rig:match("eyeBlink_L")
  equal(shares[1].control, left, "control")
  equal(match, mien.NameMatch.SPELLING, "match")
  equal(rig:match("no such expression"), nil, "shares")
  local mirror = deformer:mirror(#face.raw_controls)
  equal(mirror[left], right, "counterpart")
  local gaze = deformer:gaze()
  gaze:look_at(300, 0, 1000, face)
  local to_left = face.raw_controls:list()
  local rest = gaze:look_at(5000, 0, 1000, face)
  assert(rest > 0, "the eyes reach a target far to the side")
  local changed = 0
  for i, value in ipairs(to_left) do changed = changed + math.abs(value - face.raw_controls[i - 1]) end
  assert(changed > 0.1)
  assert(gaze:info().left_eye.left > gaze:info().right_eye.left)

  local clip = mien.build_clip { names = { "eyeBlinkLeft" }, values = { 0.5, 0.5 }, looping = mien.Looping.CLAMP }
  local mixer = rig:mix({
    layers = { { source = mien.LayerSource.CLIP, group = mien.LayerGroup.SPEECH } }, mirror = mirror, gaze = gaze,
    antagonists = rig:antagonists(), guards = mien.Guard.LIPS, deformer = deformer,
  }):mixer { stages = 1 }
  mixer:play(0, clip, clip:bind(rig), { transition = mien.Transition.CUT, mirrored = true })
  mixer:step(1)
  equal(mixer.row[right], 0.5, "the other eye")
  equal(mixer:stage(0)[right], 0.5, "the first stage")
  equal(mixer.row[left], 0, "the eye of the clip")
  local guard = mixer:guard(0)
  equal(guard.kind, mien.Guard.LIPS, "kind")
  assert(#guard.name > 0 and #guard.controls > 0)

  local body, same = deformer:instance(), deformer:instance()
  face:evaluate(0)
  body:update(face)
  same:update_from_values(face.joints.data, #face.joints, face.blend_shapes.data, #face.blend_shapes)
  arrays_equal(same.joint_matrices, body.joint_matrices, "joint matrices")
end)

-- Bytes that frames of a mixer, an instance, a batch and a deformer leave to the garbage collector.
local function garbage_of_frames(frames)
  local rig, deformer = support.small()
  local face, body, batch = rig:instance(), deformer:instance(), rig:batch(2)
  local faces = { rig:instance(), rig:instance() }
  local mix = rig:mix { layers = { { source = mien.LayerSource.POSES, poses = { { [0] = 1 } } } } }
  local mixer, frame = mix:mixer(), mien.TICKS_PER_SECOND / 60
  mixer:set_pose_weight(0, 0, 1, 100 * frame)
  local function run(count)
    for _ = 1, count do
      mixer:step(frame, face)
      face:evaluate(0)
      batch:evaluate(faces)
      body:update(face)
      body:deform(0)
    end
  end
  run(200)
  collectgarbage()
  collectgarbage("stop")
  local before = collectgarbage("count")
  run(frames)
  local bytes = (collectgarbage("count") - before) * 1024
  collectgarbage("restart")
  return bytes
end

test("frames allocate nothing, interpreted", function()
  jit.off()
  local bytes = garbage_of_frames(1000)
  jit.on()
  equal(bytes, 0, "bytes")
end)

test("frames allocate nothing, compiled", function()
  -- The compiler itself may still record a trace during these frames, which is not garbage of each of them.
  local bytes = garbage_of_frames(5000)
  assert(bytes < 5000, bytes)
end)

support.finish()
