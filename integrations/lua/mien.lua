-- SPDX-License-Identifier: MIT
-- Mien for LuaJIT: local mien = require("mien"). README.md explains it; mien/api.lua has the comments of the headers.
local api = require("mien.api")
local library = require("mien.library")

local mien = {
  version = library.version,
  TICKS_PER_SECOND = api.TICKS_PER_SECOND,
  NO_CONTROL = api.NO_CONTROL, NO_JOINT = api.NO_JOINT,
}

-- Enums: mien.Kind.JOINT. A wrong name is an error.
for name, values in pairs(api) do
  if type(values) == "table" and name ~= "sizes" and name ~= "destroy" then
    mien[name] = setmetatable(values, {
      __index = function(_, value) error(("mien.%s has no %s"):format(name, tostring(value)), 2) end,
      __newindex = function() error(("mien.%s does not change"):format(name), 2) end,
    })
  end
end

for _, module in ipairs { "mien.rig", "mien.deformer", "mien.clip", "mien.mix" } do
  for name, value in pairs(require(module)) do mien[name] = value end
end

return mien
