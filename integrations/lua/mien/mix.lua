-- SPDX-License-Identifier: MIT
-- Mixes, and mixers that play them. Times are in ticks: mien.ticks(seconds).
local ffi = require("ffi")
local api = require("mien.api")
local object = require("mien.object")
local rigs = require("mien.rig")
local clips = require("mien.clip")
local lib = require("mien.library").lib
local open, check, check_detail, detail = object.open, object.check, object.check_detail, object.error_detail

local mixes = {}
local Mix = object.class("Mix", "MienMix")
local Mixer = object.class("Mixer", "MienMixer")
local Gaze = object.class("Gaze", "MienGaze")
mixes.Mix, mixes.Mixer, mixes.Gaze = Mix, Mixer, Gaze

-- ---- descriptions -----------------------------------------------------------------------------------

-- Makes C arrays of a description and keeps them alive.
local Lists = {}
Lists.__index = Lists

function Lists:held(array)
  self[#self + 1] = array
  return array
end

-- The index of a curve: a raw control or a pose variable by its name, or the index itself.
function Lists:curve(curve)
  if type(curve) == "number" then return curve end
  local found = self.variables[curve] or self.rig:find(api.Kind.RAW_CONTROL, curve)
  return found or object.throw(api.Status.NAME, "no raw control or variable " .. tostring(curve))
end

function Lists:curves(list)
  local indices = {}
  for i, curve in ipairs(list) do indices[i] = self:curve(curve) end
  return self:held(object.numbers("uint16_t", indices))
end

-- { name = value, ... } as curves, in ascending order, and their values.
function Lists:pose(pose)
  local curves, values, sorted = {}, {}, {}
  for name, value in pairs(pose) do
    local curve = self:curve(name)
    curves[#curves + 1], sorted[curve] = curve, value
  end
  table.sort(curves)
  for i, curve in ipairs(curves) do values[i] = sorted[curve] end
  local to = { curves = self:held(object.numbers("uint16_t", curves)), count = #curves }
  to.values = self:held(object.numbers("float", values))
  self.poses[#self.poses + 1] = to
  return #self.poses - 1
end

-- { name = weight, ... }: other curves have 0.
function Lists:mask(mask)
  local weights = self:held(ffi.new("float[?]", self.curve_count))
  for name, weight in pairs(mask) do
    local curve = self:curve(name)
    if curve < 0 or curve >= self.curve_count then object.throw(api.Status.INDEX, "curve " .. curve) end
    weights[curve] = weight
  end
  return weights
end

function Lists:array(type_name, list)
  local array = self:held(ffi.new(type_name .. "[?]", math.max(#list, 1)))
  for i, fields in ipairs(list) do object.fill(array[i - 1], fields) end
  return array
end

local function copy(table, without)
  local result = {}
  for key, value in pairs(table) do
    if not without[key] then result[key] = value end
  end
  return result
end

local layer_keys = { poses = true, curves = true, amounts = true, mask = true }
function Lists:layer(from)
  local to = copy(from, layer_keys)
  if from.weight == nil then to.weight = 1 end
  if from.mask then to.mask, to.mask_count = self:mask(from.mask), self.curve_count end
  if from.curves then to.curves, to.curve_count = self:curves(from.curves), #from.curves end
  if from.amounts then to.amounts = self:held(object.numbers("float", from.amounts)) end
  to.first_pose, to.pose_count = #self.poses, from.poses and #from.poses or 0
  for _, pose in ipairs(from.poses or {}) do self:pose(pose) end
  return to
end

local stroke_keys, reaction_keys = { pose = true }, { strokes = true }
function Lists:reaction(from)
  local strokes = {}
  for i, stroke in ipairs(from.strokes) do
    strokes[i] = copy(stroke, stroke_keys)
    strokes[i].pose = self:pose(stroke.pose)
  end
  local to = copy(from, reaction_keys)
  if from.adapted == nil then to.adapted = 1 end
  to.strokes, to.stroke_count = self:array("MienMixStroke", strokes), #strokes
  return to
end

-- Creates a mix for a rig. Fields:
-- layers:    list of tables with the fields of MienMixLayer; `source` is a mien.LayerSource. `poses` is a list of
--            { name = value, ... }, `mask` is { name = weight, ... }, `curves` a list of names, `amounts` of numbers
-- reactions: list of tables with the fields of MienMixReaction; `strokes` is a list of tables with the fields of
--            MienMixStroke, whose `pose` is { name = value, ... }
-- variables: list of names of pose variables, curves behind the raw controls
-- antagonists: list of { first =, second =, stiffness = }, curves by name
-- mirror:    such as Deformer.mirror, so that clips can be played mirrored
-- deformer:  a mien.Deformer, with which guards are measured
-- gaze:      a mien.Gaze, for layers of mien.Generator.GAZE
-- and guards (mien.Guard), player_count, max_channels, max_changing_channels, max_events, reverse as in MienMixDesc
function rigs.Rig:mix(fields)
  local rig, variables = open(self, rigs.Rig), fields.variables or {}
  local out = ffi.new("MienMix*[1]")
  local raw_count = self:count(api.Kind.RAW_CONTROL)
  local lists = setmetatable({ rig = self, variables = {}, poses = {}, curve_count = raw_count + #variables }, Lists)
  for i, name in ipairs(variables) do lists.variables[name] = raw_count + i - 1 end
  local layers, reactions, pairs_list = {}, {}, {}
  for i, layer in ipairs(fields.layers) do layers[i] = lists:layer(layer) end
  for i, reaction in ipairs(fields.reactions or {}) do reactions[i] = lists:reaction(reaction) end
  for i, pair in ipairs(fields.antagonists or {}) do
    pairs_list[i] = { first = lists:curve(pair.first), second = lists:curve(pair.second),
      stiffness = pair.stiffness or 1 }
  end
  local given = copy(fields, { layers = true, reactions = true, variables = true, antagonists = true, deformer = true,
    gaze = true })
  given.deformer = fields.deformer and open(fields.deformer, rigs.Deformer)
  given.gaze = fields.gaze and open(fields.gaze, Gaze)
  given.variable_count = #variables
  given.layers, given.layer_count = lists:array("MienMixLayer", layers), #layers
  given.poses, given.pose_count = lists:array("MienMixPose", lists.poses), #lists.poses
  given.reactions, given.reaction_count = lists:array("MienMixReaction", reactions), #reactions
  given.antagonists, given.antagonist_count = lists:array("MienMixAntagonists", pairs_list), #pairs_list
  local desc = lists:held(object.desc("MienMixDesc", given))
  check_detail(lib.mien_mix_create(rig, desc, out, detail), "cannot create the mix")
  return object.new(Mix, out)
end

-- Pairs of raw controls that move the face in opposite directions, for Rig.mix.
function rigs.Rig:antagonists()
  local handle, count = open(self, rigs.Rig), ffi.new("size_t[1]")
  check(lib.mien_mix_antagonists(handle, nil, 0, count), "antagonists")
  local pairs_found = ffi.new("MienMixAntagonists[?]", math.max(tonumber(count[0]), 1))
  check(lib.mien_mix_antagonists(handle, pairs_found, count[0], count), "antagonists")
  local list = {}
  for i = 1, tonumber(count[0]) do
    local pair = pairs_found[i - 1]
    list[i] = { first = pair.first, second = pair.second, stiffness = pair.stiffness }
  end
  return list
end

-- A C array with the counterpart of each curve in the other half of the face: raw controls, then `variable_count` pose
-- variables. Measures the rig, which takes time.
function rigs.Deformer:mirror(raw_control_count, variable_count)
  local count = raw_control_count + (variable_count or 0)
  local curves = ffi.new("uint16_t[?]", math.max(count, 1))
  check_detail(lib.mien_mix_mirror(open(self, rigs.Deformer), curves, count, detail), "cannot find counterparts")
  return curves
end

-- Measures how raw controls turn the eyes. options: left_eye and right_eye, names of joints.
function rigs.Deformer:gaze(options)
  local handle, out, given = open(self, rigs.Deformer), ffi.new("MienGaze*[1]"), options or {}
  local desc = object.desc("MienGazeDesc", given)
  check_detail(lib.mien_gaze_create(handle, desc, out, detail), "cannot create a gaze")
  return object.new(Gaze, out)
end

-- A MienGazeInfo.
function Gaze:info()
  local info = object.info("MienGazeInfo")
  check(lib.mien_gaze_info(open(self, Gaze), info), "info")
  return info
end

local target, rest = ffi.new("MienGazeTarget"), ffi.new("MienGazeRest")

-- Sets the raw controls of an instance so that both eyes look at a point: millimeters to the left, up and to the front,
-- in the model space of the rig with its head in the neutral pose. Returns what the eyes cannot reach, for the head to
-- turn: tangents of the angles to the left and up.
function Gaze:look_at(left, up, front, instance)
  local controls = open(instance, rigs.Instance) and instance.raw_controls
  target.left, target.up, target.front = left, up, front
  check(lib.mien_gaze_look_at(open(self, Gaze), target, controls.data, controls.count, rest),
    "the target is not finite, or the instance is of another rig")
  return rest.left, rest.up
end

-- Opens a mix, a file or its bytes, for a rig that has its controls.
function mixes.open_mix(path, rig)
  local out = ffi.new("MienMix*[1]")
  check_detail(lib.mien_mix_open_file(path, open(rig, rigs.Rig), nil, out, detail), path)
  return object.new(Mix, out)
end

function mixes.open_mix_bytes(bytes, rig)
  local out = ffi.new("MienMix*[1]")
  check_detail(lib.mien_mix_open_memory(bytes, #bytes, open(rig, rigs.Rig), nil, out, detail), "cannot open the bytes")
  return object.new(Mix, out)
end

function Mix:save(path) check_detail(lib.mien_mix_write_file(open(self, Mix), path, detail), path) end

local function written(self, call)
  local handle = open(self, Mix)
  return object.written(function(buffer, capacity, size) return call(handle, buffer, capacity, size, detail) end,
    "cannot write")
end

-- The bytes of the file, or its text, as a string.
function Mix:bytes() return written(self, lib.mien_mix_write_memory) end
function Mix:text() return written(self, lib.mien_mix_write_text) end

-- A MienMixInfo.
function Mix:info()
  local info = object.info("MienMixInfo")
  check(lib.mien_mix_info(open(self, Mix), info), "info")
  return info
end

-- ---- mixers -----------------------------------------------------------------------------------------

-- A new character. options: fields of MienMixerDesc.
function Mix:mixer(options)
  local handle, out = open(self, Mix), ffi.new("MienMixer*[1]")
  check_detail(lib.mien_mixer_create(handle, object.desc("MienMixerDesc", options), out, detail),
    "cannot create a mixer")
  local new = object.new(Mixer, out)
  new._playing = {}
  object.keep(new.handle, new._playing)
  new.row = object.view(new, "row", "MienFloatView", function(view) return lib.mien_mixer_row(new.handle, view) end)
  return new
end

-- Plays a clip in a layer. options: fields of MienPlayDesc. The mixer keeps the clip and the binding from then on:
-- close() of these takes effect when the mixer is released.
function Mixer:play(layer, clip, binding, options)
  local handle = open(self, Mixer)
  local clip_handle, binding_handle = open(clip, clips.Clip), open(binding, clips.ClipBinding)
  check_detail(lib.mien_mixer_play(handle, layer, clip_handle, binding_handle,
    object.desc("MienPlayDesc", options), detail), "cannot play the clip")
  clip._pinned, binding._pinned = true, true
  local playing = self._playing
  for i = 1, #playing, 2 do
    if playing[i] == clip_handle and playing[i + 1] == binding_handle then return end
  end
  playing[#playing + 1], playing[#playing + 2] = clip_handle, binding_handle
end

-- Fades take `fade` ticks; 0 without it.
function Mixer:stop(layer, fade)
  check(lib.mien_mixer_stop(open(self, Mixer), layer, fade or 0), "no clips play in this layer, or a wrong fade")
end
function Mixer:set_weight(layer, weight, fade)
  check(lib.mien_mixer_set_weight(open(self, Mixer), layer, weight, fade or 0), "no such layer, weight or fade")
end
function Mixer:set_pose_weight(layer, pose, weight, fade)
  check(lib.mien_mixer_set_pose_weight(open(self, Mixer), layer, pose, weight, fade or 0),
    "no such layer, pose, weight or fade")
end
function Mixer:set_variable(variable, value)
  check(lib.mien_mixer_set_variable(open(self, Mixer), variable, value), "no such variable or value")
end
function Mixer:set_guard(guard, activation)
  check(lib.mien_mixer_set_guard(open(self, Mixer), guard, activation), "no such guard or activation")
end

-- Starts a reaction. hold: how long the stimulus lasts, in ticks.
function Mixer:trigger(reaction, strength, hold)
  check(lib.mien_mixer_trigger(open(self, Mixer), reaction, strength or 1, hold or 0),
    "no such reaction, strength or hold")
end
function Mixer:release(reaction) check(lib.mien_mixer_release(open(self, Mixer), reaction), "no such reaction") end
function Mixer:set_level(reaction, level)
  check(lib.mien_mixer_set_level(open(self, Mixer), reaction, level), "no such reaction or level")
end

local accepted = ffi.new("uint32_t[1]")

-- Queues a row for a stream layer: a list, or a C array and its count. Whether it was taken: false if it is not
-- newer than the last one or the queue is full.
function Mixer:push(layer, tick, values, count)
  if not count then values, count = object.numbers("float", values) end
  check(lib.mien_mixer_push(open(self, Mixer), layer, tick, values, count, accepted),
    "no such stream, or a wrong number of values, or one that is not finite")
  return accepted[0] ~= 0
end

-- Advances the time and writes the raw controls of an instance, if there is one; then evaluate it.
-- The field `row` has all curves: raw controls, then pose variables.
function Mixer:step(ticks, instance)
  check(lib.mien_mixer_step(open(self, Mixer), ticks, instance and open(instance, rigs.Instance)),
    "ticks are out of range, or the instance is of another rig")
end

-- A MienMixerInfo: its time, and how many events of clips the last step passed.
function Mixer:info()
  local info = object.info("MienMixerInfo")
  check(lib.mien_mixer_info(open(self, Mixer), info), "info")
  return info
end

-- Event `index` of the last step, from 0: { tick =, name =, value =, layer = }.
function Mixer:event(index)
  local event = ffi.new("MienClipEvent")
  local layer = ffi.new("uint32_t[1]")
  check(lib.mien_mixer_event(open(self, Mixer), index, event, layer), "no event " .. tostring(index))
  return { tick = tonumber(event.tick), name = object.text(event.name), value = event.value, layer = layer[0] }
end

-- The row after a stage of the last step, for a mixer with the option `stages`.
function Mixer:stage(stage)
  local handle = open(self, Mixer)
  return object.view(self, "stage " .. tostring(stage), "MienFloatView", function(view)
    return lib.mien_mixer_stage(handle, stage, view)
  end)
end

-- What a guard did in the last step: the fields of MienGuardState as a table.
function Mixer:guard(guard)
  local state = object.info("MienGuardState")
  check(lib.mien_mixer_guard(open(self, Mixer), guard, state), "no guard " .. tostring(guard))
  local result = { name = object.text(state.name), controls = state.controls:list(), kind = state.kind }
  for _, name in ipairs { "activation", "protected_distance", "wanted", "limit", "distance" } do
    result[name] = state[name]
  end
  return result
end

-- The state as a string. `restore` takes one of a mixer of the same mix.
function Mixer:snapshot()
  local handle = open(self, Mixer)
  return object.written(function(buffer, capacity, size)
    return lib.mien_mixer_snapshot(handle, buffer, capacity, size, detail)
  end, "cannot write")
end

-- playing: list of { clip_id =, clip =, binding = }, those that may have been playing.
function Mixer:restore(bytes, playing)
  local handle, list = open(self, Mixer), playing or {}
  local array = ffi.new("MienMixerClip[?]", math.max(#list, 1))
  for i, from in ipairs(list) do
    array[i - 1].clip_id = from.clip_id
    array[i - 1].clip, array[i - 1].clip_binding = open(from.clip, clips.Clip), open(from.binding, clips.ClipBinding)
  end
  check_detail(lib.mien_mixer_restore(handle, bytes, #bytes, array, #list, detail), "cannot restore")
  for _, from in ipairs(list) do
    from.clip._pinned, from.binding._pinned = true, true
    self._playing[#self._playing + 1] = from.clip.handle
    self._playing[#self._playing + 1] = from.binding.handle
  end
end

return mixes
