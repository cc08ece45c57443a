-- SPDX-License-Identifier: MIT
-- Clips, players, and bindings of clips to rigs. Times are in ticks.
local ffi = require("ffi")
local api = require("mien.api")
local object = require("mien.object")
local rigs = require("mien.rig")
local lib = require("mien.library").lib
local open, check, check_detail, detail = object.open, object.check, object.check_detail, object.error_detail

local clips = {}
local Clip = object.class("Clip", "MienClip")
local ClipPlayer = object.class("ClipPlayer", "MienClipPlayer")
local ClipBinding = object.class("ClipBinding", "MienClipBinding")
clips.Clip, clips.ClipPlayer, clips.ClipBinding = Clip, ClipPlayer, ClipBinding

-- Seconds as ticks.
function clips.ticks(seconds) return math.floor(seconds * api.TICKS_PER_SECOND + 0.5) end

-- Compresses curves. Fields: names, a list; values, a list of rows of one value per name, one row after the other;
-- rate_numerator and rate_denominator (60 and 1 without them); events, a list of { tick =, name =, value = };
-- snap, looping and is_delta as in MienClipDesc.
function clips.build_clip(fields)
  local out = ffi.new("MienClip*[1]")
  local names = object.names(fields.names)
  local values, value_count = object.numbers("float", fields.values)
  local channels = #fields.names
  if value_count == 0 or value_count % channels ~= 0 then
    object.invalid("%d values are no rows of %d", value_count, channels)
  end
  local given = fields.events or {}
  local events = ffi.new("MienClipEvent[?]", math.max(#given, 1))
  for i, event in ipairs(given) do
    local to = events[i - 1]
    to.tick, to.value = event.tick, event.value or 0
    to.name.data, to.name.count = event.name, #event.name
  end
  local desc = object.desc("MienClipDesc", {
    rate_numerator = fields.rate_numerator or 60, rate_denominator = fields.rate_denominator or 1,
    frame_count = value_count / channels, channel_count = channels, names = names, values = values,
    snap = fields.snap or 0, looping = fields.looping or 0, is_delta = fields.is_delta or false,
    event_count = #given, events = events,
  })
  check_detail(lib.mien_clip_build(desc, out, detail), "cannot build the clip")
  return object.new(Clip, out)
end

-- Opens a clip. options: fields of MienClipOpenDesc. A file that is mapped must not change while it is used.
function clips.open_clip(path, options)
  local out = ffi.new("MienClip*[1]")
  check_detail(lib.mien_clip_open_file(path, object.desc("MienClipOpenDesc", options), out, detail), path)
  return object.new(Clip, out)
end

function clips.open_clip_bytes(bytes, options)
  local out = ffi.new("MienClip*[1]")
  check_detail(lib.mien_clip_open_memory(bytes, #bytes, object.desc("MienClipOpenDesc", options), out, detail),
    "cannot open the bytes")
  return object.new(Clip, out, bytes)
end

function Clip:save(path) check_detail(lib.mien_clip_write_file(open(self, Clip), path, detail), path) end

-- The bytes of the file, a string.
function Clip:bytes()
  local handle = open(self, Clip)
  return object.written(function(buffer, capacity, size)
    return lib.mien_clip_write_memory(handle, buffer, capacity, size, detail)
  end, "cannot write")
end

-- A MienClipInfo.
function Clip:info()
  local info = object.info("MienClipInfo")
  check(lib.mien_clip_info(open(self, Clip), info), "info")
  return info
end

-- Frames from `first` on, as a C array of floats: channels side by side, one frame after the other.
function Clip:read(first, count)
  local handle, info = open(self, Clip), self:info()
  first = first or 0
  count = count or info.frame_count - first
  if count < 0 or first < 0 or first + count > info.frame_count then
    object.invalid("frames %s to %s of %d", first, first + count, info.frame_count)
  end
  local values = ffi.new("float[?]", math.max(count * info.channel_count, 1))
  check_detail(lib.mien_clip_read(handle, first, count, values, 0, detail), "cannot read the frames")
  return values
end

-- options: fields of MienClipPlayerDesc.
function Clip:player(options)
  local handle, out = open(self, Clip), ffi.new("MienClipPlayer*[1]")
  check_detail(lib.mien_clip_player_create(handle, object.desc("MienClipPlayerDesc", options), out, detail),
    "cannot create a player")
  local new = object.new(ClipPlayer, out, handle)
  new.values = object.view(new, "values", "MienFloatView", function(view)
    return lib.mien_clip_player_sample(new.handle, view)
  end)
  return new
end

function ClipPlayer:seek(tick)
  check(lib.mien_clip_player_seek(open(self, ClipPlayer), tick), "tick " .. tostring(tick))
end

function ClipPlayer:advance(ticks)
  check(lib.mien_clip_player_advance(open(self, ClipPlayer), ticks), "the player cannot advance as far")
end

-- The speed is a fraction; `denominator` is 1 without it.
function ClipPlayer:set_speed(numerator, denominator)
  check(lib.mien_clip_player_set_speed(open(self, ClipPlayer), numerator, denominator or 1), "the speed is out of range")
end

-- A MienClipPlayerInfo.
function ClipPlayer:info()
  local info = object.info("MienClipPlayerInfo")
  check(lib.mien_clip_player_info(open(self, ClipPlayer), info), "info")
  return info
end

-- The next event that the last advance passed, { tick =, name =, value = }, or nil.
function ClipPlayer:next_event()
  local event, found = ffi.new("MienClipEvent"), ffi.new("uint32_t[1]")
  check(lib.mien_clip_player_next_event(open(self, ClipPlayer), event, found), "events")
  if found[0] == 0 then return nil end
  return { tick = tonumber(event.tick), name = object.text(event.name), value = event.value }
end

-- Decodes the values at the current position: one per channel, also in the field `values`.
function ClipPlayer:sample()
  check(lib.mien_clip_player_sample(open(self, ClipPlayer), self.values), "cannot sample")
  return self.values
end

-- Which controls of a rig the channels drive, found by names.
-- matrix: entries of { channel =, control =, weight = } for names that the rig lacks
function Clip:bind(rig, matrix)
  local handle, rig_handle, entries = open(self, Clip), open(rig, rigs.Rig), nil
  if matrix then
    entries = ffi.new("MienMatrixEntry[?]", math.max(#matrix, 1))
    for i, from in ipairs(matrix) do
      local to = entries[i - 1]
      to.channel.data, to.channel.count, to.weight = from.channel, #from.channel, from.weight
      to.control.data, to.control.count = from.control, #from.control
    end
  end
  local out = ffi.new("MienClipBinding*[1]")
  check_detail(lib.mien_clip_binding_create(handle, rig_handle,
    object.desc("MienClipBindingDesc", { matrix = entries, matrix_count = matrix and #matrix or 0 }), out, detail),
    "cannot bind the clip")
  return object.new(ClipBinding, out)
end

-- The entries for Clip.bind that suit clips with the names of ARKit.
function clips.arkit_matrix()
  local count = ffi.new("size_t[1]")
  check(lib.mien_arkit_matrix(nil, 0, count), "matrix")
  local entries = ffi.new("MienMatrixEntry[?]", count[0])
  check(lib.mien_arkit_matrix(entries, count[0], count), "matrix")
  local list = {}
  for i = 1, tonumber(count[0]) do
    local entry = entries[i - 1]
    list[i] = { channel = object.text(entry.channel), control = object.text(entry.control), weight = entry.weight }
  end
  return list
end

-- What was found, as lists: `controls` and `extra_controls`, raw controls that are driven and that are not, and
-- `missing_channels`, which drive nothing.
function ClipBinding:info()
  local info, result = object.info("MienClipBindingInfo"), {}
  check(lib.mien_clip_binding_info(open(self, ClipBinding), info), "info")
  for _, name in ipairs { "controls", "extra_controls", "missing_channels" } do result[name] = info[name]:list() end
  return result
end

-- Sets the raw controls of an instance from values of the clip, such as of ClipPlayer.sample.
function ClipBinding:apply(values, instance)
  local controls = open(instance, rigs.Instance) and instance.raw_controls
  check(lib.mien_clip_binding_apply(open(self, ClipBinding), values.data, values.count, controls.data,
    controls.count), "the values are of another clip, or the instance of another rig")
end

return clips
