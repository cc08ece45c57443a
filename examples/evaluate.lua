-- SPDX-License-Identifier: MIT
-- evaluate.lua [FILE.dna [CONTROL]]: turns a control up and tells which joint moves or turns most.
local mien = require("mien")

local file, control = arg[1], arg[2] or "CTRL_expressions.jawOpen"
local dna = file and mien.open_dna(file) or mien.generate(mien.Preset.LARGE)
local rig = mien.rig(dna)
dna:close()
local face = rig:instance()
if not rig:find(mien.Kind.RAW_CONTROL, control) then -- some rigs leave the prefix out
  control = control:match("[^.]*$")
end
face:set(control, 1) -- or face.raw_controls[i] = 1
face:evaluate(0)
local joints, most = face.joints, 0 -- per joint tx ty tz rx ry rz sx sy sz
for i = 0, #joints - 1 do
  if i % 9 < 6 and math.abs(joints[i]) > math.abs(joints[most]) then most = i end
end
local joint = math.floor(most / 9)
local d = joints.data + 9 * joint
print(("%s moves %s most: by %.3f %.3f %.3f, turning it by %.3f %.3f %.3f"):format(control,
  rig:name(mien.Kind.JOINT, joint), d[0], d[1], d[2], d[3], d[4], d[5]))
