-- SPDX-License-Identifier: MIT
-- Finds and loads libmien, and libmien-author when a function of it is first called.
local ffi = require("ffi")
local api = require("mien.api")

local library = {}

local function load(candidates, missing)
  local failures = {}
  for _, name in ipairs(candidates) do
    local loaded, result = pcall(ffi.load, name)
    if loaded then return result, name end
    failures[#failures + 1] = result
  end
  error(missing .. " Tried:\n  " .. table.concat(failures, "\n  "), 0)
end

-- What the file of a library is called on this system.
local function names(stem)
  if ffi.os == "Windows" then return { stem .. ".dll" } end
  if ffi.os == "OSX" then return { "lib" .. stem .. ".0.dylib", "lib" .. stem .. ".dylib" } end
  return { "lib" .. stem .. ".so.0", "lib" .. stem .. ".so" }
end

local told = os.getenv("MIEN_LIBRARY")
library.lib, library.path = load(told and { told } or names("mien"),
  "libmien was not found. Install it, or name its file in MIEN_LIBRARY.")

local number = library.lib.mien_version()
local major, minor, patch = math.floor(number / 2 ^ 24), math.floor(number / 2 ^ 16) % 256, number % 65536
library.version = ("%d.%d.%d"):format(major, minor, patch)
-- Until 1.0 a minor release may change the interface.
local our_major, our_minor = api.VERSION:match("(%d+)%.(%d+)")
if major ~= tonumber(our_major) or (major == 0 and minor ~= tonumber(our_minor)) then
  error(("libmien is of version %s, these modules are for %s: %s"):format(library.version, api.VERSION,
    library.path), 0)
end

local author
-- libmien-author, which lies beside libmien.
function library.author()
  if not author then
    local directory, candidates = library.path:match("^(.*[/\\])"), names("mien-author")
    if directory then
      for i, name in ipairs(candidates) do candidates[i] = directory .. name end
    end
    author = load(candidates, "libmien-author was not found beside libmien, " .. library.path .. ".")
  end
  return author
end

return library
