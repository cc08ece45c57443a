-- SPDX-License-Identifier: MIT
-- What all classes share: errors, handles and their owners, descs, arrays.
--
--     Instance (a Lua table) ---> handle (a C pointer with a finalizer) <--- array
--                                   |
--                                   +---> what the library reads from: bytes, handles of other objects
--
-- An arrow keeps alive. An array of a closed object is empty.
local ffi = require("ffi")
local api = require("mien.api")
local lib = require("mien.library").lib

local object = {}

-- ---- errors -----------------------------------------------------------------------------------------

-- Errors are tables with status (mien.Status), name, message and, if it is known, byte_offset.
local Error = {}
Error.__index = Error
function Error:__tostring() return self.name .. ": " .. self.message end

local function throw(status, message, byte_offset)
  local name = ffi.string(lib.mien_status_name(status))
  error(setmetatable({ status = status, name = name, message = message, byte_offset = byte_offset }, Error), 0)
end
object.throw = throw

function object.invalid(message, ...) throw(api.Status.INVALID_ARGUMENT, message:format(...)) end

-- A call that gives no message failed.
function object.check(status, what)
  if status ~= 0 then throw(status, what) end
end

local error_detail = ffi.new("MienError")
object.error_detail = error_detail
error_detail.struct_size = ffi.sizeof("MienError")

-- A call that was given error_detail failed.
function object.check_detail(status, what)
  if status == 0 then return end
  local offset = error_detail.byte_offset
  local message = error_detail.status == status and ffi.string(error_detail.message) or ""
  throw(status, message ~= "" and message or what,
    offset ~= api.NO_OFFSET and error_detail.status == status and tonumber(offset) or nil)
end

-- ---- handles ----------------------------------------------------------------------------------------

-- Handle or array -> what has to live as long. Keys are never reachable from their values.
local keeps = setmetatable({}, { __mode = "k" })

function object.keep(key, value) keeps[key] = value end

-- Takes over the handle in out[0].
function object.new(class, out, kept, library)
  local self = setmetatable({ handle = false, _arrays = {} }, class)
  local destroy = (library or lib)[api.destroy[class.handle_type]]
  self.handle, self._destroy = ffi.gc(out[0], destroy), destroy
  if kept then keeps[self.handle] = kept end
  return self
end

-- A class of objects with a handle of this type.
function object.class(name, handle_type)
  local class = { class_name = name, handle_type = handle_type }
  class.__index = class
  function class:__tostring()
    return ("mien.%s%s"):format(name, self.handle and "" or ", closed")
  end
  -- Releases the memory. May be called twice; any other use of the object is an error from then on.
  function class:close()
    if not self.handle then return end
    for _, array in pairs(self._arrays) do array.data, array.count = nil, 0 end
    local handle = self.handle
    self.handle = false
    if self._pinned then return end -- a mixer plays it: the garbage collector releases it
    ffi.gc(handle, nil)
    self._destroy(handle)
    keeps[handle] = nil
  end
  return class
end

-- The handle of an open object of a class.
function object.open(self, class)
  if getmetatable(self) ~= class then
    object.invalid("expected a mien.%s, not %s (methods are called with a colon)", class.class_name, tostring(self))
  end
  return self.handle or throw(api.Status.HANDLE, "this mien." .. class.class_name .. " is closed")
end

-- ---- descs ------------------------------------------------------------------------------------------

-- A struct with the fields of a table, or nil for nil. An unknown field is an error.
function object.desc(type_name, fields)
  if fields == nil then return nil end
  local struct = ffi.new(type_name)
  struct.struct_size = ffi.sizeof(type_name)
  return object.fill(struct, fields)
end

function object.fill(struct, fields)
  for name, value in pairs(fields) do
    if type(value) == "boolean" then value = value and 1 or 0 end
    struct[name] = value
  end
  return struct
end

-- An info struct to be filled by a function.
function object.info(type_name)
  local struct = ffi.new(type_name)
  struct.struct_size = ffi.sizeof(type_name)
  return struct
end

function object.text(view) return view.count > 0 and ffi.string(view.data, view.count) or "" end

-- A list of strings as an array of MienStringView. The strings have to live as long.
function object.names(list)
  local views = ffi.new("MienStringView[?]", math.max(#list, 1))
  for i, name in ipairs(list) do views[i - 1].data, views[i - 1].count = name, #name end
  return views
end

-- Numbers of a list or of one of the library's arrays, as a C array, and how many there are.
function object.numbers(type_name, list)
  local count = #list
  local array = ffi.new(type_name .. "[?]", math.max(count, 1))
  local first = type(list) == "table" and 1 or 0
  for i = 0, count - 1 do array[i] = list[i + first] end
  return array, count
end

-- The bytes that a function writes into a buffer. call(buffer, capacity, out_size) returns a status.
function object.written(call, what)
  local size = ffi.new("size_t[1]")
  object.check_detail(call(nil, 0, size), what)
  local capacity = tonumber(size[0])
  local buffer = ffi.new("uint8_t[?]", math.max(capacity, 1))
  object.check_detail(call(buffer, capacity, size), what)
  return ffi.string(buffer, tonumber(size[0]))
end

-- ---- arrays -----------------------------------------------------------------------------------------

-- Arrays are the library's memory, from 0: array[i], #array. `data` is the bare pointer, for inner loops.
local array_methods = {}

-- The elements as a Lua list, from 1.
function array_methods:list()
  local list = {}
  for i = 0, #self - 1 do list[i + 1] = self.data[i] end
  return list
end

local function outside(array, index)
  if type(index) == "number" then
    throw(api.Status.INDEX, ("index %s of %d elements"):format(index, tonumber(array.count)))
  end
  object.invalid("arrays have no %s", tostring(index))
end

local array_type = {}
function array_type:__len() return tonumber(self.count) end
function array_type:__index(index)
  if type(index) == "number" and index >= 0 and index < self.count then return self.data[index] end
  return array_methods[index] or outside(self, index)
end
function array_type:__newindex(index, value)
  if type(index) ~= "number" or not (index >= 0 and index < self.count) then outside(self, index) end
  self.data[index] = value
end
for _, name in ipairs { "MienFloatView", "MienMutableFloatView", "MienIndex16View", "MienIndex32View" } do
  ffi.metatype(name, array_type)
end

-- The array `key` of an object, whose memory it keeps alive. fill(view) returns the status of the call.
function object.view(self, key, type_name, fill)
  local view = self._arrays[key] or ffi.new(type_name)
  object.check(fill(view), key)
  if not self._arrays[key] then
    self._arrays[key] = view
    keeps[view] = self.handle
  end
  return view
end

return object
