-- SPDX-License-Identifier: MIT
-- mix.lua: a head speaks, is glad, and closes its eyes when a flashlight hits them.
local mien = require("mien")
local ticks = mien.ticks

local dna = mien.generate(mien.Preset.HEAD)
local rig = mien.rig(dna)
local deformer = mien.deformer(dna, rig)
dna:close()
local face = rig:instance()

-- Speech: the jaw at 60 frames a second, closed for every m of "mama mama".
local jaw = {}
for i = 0, 179 do
  local phase = i % 30
  jaw[#jaw + 1] = phase < 8 and 0 or (phase - 8) * (29 - phase) / 220
end
local speech = mien.build_clip { names = { "jawOpen" }, values = jaw, rate_numerator = 60 }

-- Joy over it, held back where it would part the lips; the flashlight acts last.
local joy = {
  jawOpen = 0.2, mouthSmileLeft = 0.9, mouthSmileRight = 0.9, cheekSquintLeft = 0.6, cheekSquintRight = 0.6,
}
local flashlight = {
  strokes = {
    { pose = { eyeBlinkLeft = 1, eyeBlinkRight = 1 }, mode = mien.BlendMode.MAX, delay = ticks(0.06),
      attack = ticks(0.07), hold = ticks(0.06), release = ticks(0.22) },
    { pose = { eyeSquintLeft = 0.8, eyeSquintRight = 0.8 }, mode = mien.BlendMode.SCREEN, delay = ticks(0.09),
      attack = ticks(0.15), release = ticks(0.4), is_held = true },
  },
  cooldown = ticks(0.25), adapted = 0.6, adapt_ticks = ticks(1.5), recover_ticks = ticks(1.5),
}
local mix = rig:mix {
  layers = {
    { source = mien.LayerSource.CLIP, group = mien.LayerGroup.SPEECH },
    { source = mien.LayerSource.POSES, group = mien.LayerGroup.EMOTION, mode = mien.BlendMode.SCREEN, poses = { joy } },
  },
  reactions = { flashlight }, guards = mien.Guard.LIPS, deformer = deformer,
}

local mixer = mix:mixer()
mixer:play(0, speech, speech:bind(rig), { transition_ticks = ticks(0.1) })
mixer:set_pose_weight(1, 0, 0.8, ticks(0.5))
for i = 1, 150 do
  if i == 90 then mixer:trigger(0, 1, ticks(0.6)) end
  mixer:step(mien.TICKS_PER_SECOND / 60, face) -- writes the raw controls of the face
  face:evaluate(0)
  if i % 10 == 0 then
    local most = -math.huge
    for j = 0, #face.joints - 1 do most = math.max(most, face.joints[j]) end
    print(("%3d  jaw %.4f  smile %.4f  lids %.4f  squint %.4f  joints up to %.3f"):format(i, face:get("jawOpen"),
      face:get("mouthSmileLeft"), face:get("eyeBlinkLeft"), face:get("eyeSquintLeft"), most))
  end
end
