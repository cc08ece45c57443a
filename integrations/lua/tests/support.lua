-- SPDX-License-Identifier: MIT
-- Named tests: each is run, and the program fails if one of them did.
local mien = require("mien")
local support = { failures = 0, count = 0 }

function support.test(name, body)
  support.count = support.count + 1
  local passed, message = xpcall(body, function(e) return debug.traceback(tostring(e), 2) end)
  if not passed then
    support.failures = support.failures + 1
    print("FAILED " .. name .. "\n" .. message)
  end
end

function support.equal(got, expected, what)
  if got ~= expected then
    error(("%s is %s, not %s"):format(what or "value", tostring(got), tostring(expected)), 2)
  end
end

function support.arrays_equal(a, b, what)
  support.equal(#a, #b, "length of " .. what)
  for i = 0, #a - 1 do support.equal(a[i], b[i], ("%s[%d]"):format(what, i)) end
end

-- The call fails with this status, and its message has this text.
function support.fails(status, text, call, ...)
  local passed, e = pcall(call, ...)
  if passed then error("the call did not fail", 2) end
  if type(e) ~= "table" then error("not an error of the library: " .. tostring(e), 2) end
  if e.status ~= status or not e.message:find(text, 1, true) then
    error(("failed with %s, not with status %d and %q"):format(tostring(e), status, text), 2)
  end
  return e
end

-- The call fails with an error of LuaJIT or of a table, whose message has this text.
function support.raises(text, call, ...)
  local passed, e = pcall(call, ...)
  if passed then error("the call did not fail", 2) end
  if not tostring(e):find(text, 1, true) then error(("failed with %q, not %q"):format(tostring(e), text), 2) end
end

-- Objects of a small rig, with a deformer.
function support.small(options)
  local dna = mien.generate(mien.Preset.SMALL, { seed = 5 })
  local rig = mien.rig(dna, options)
  local deformer = mien.deformer(dna, rig)
  dna:close()
  return rig, deformer
end

-- Different values for the raw controls, from `seed`.
function support.pose(face, seed)
  for i = 0, #face.raw_controls - 1 do face.raw_controls[i] = (i * 7 + seed * 5) % 11 / 10 end
end

function support.finish()
  print(("%d tests, %d failed"):format(support.count, support.failures))
  os.exit(support.failures == 0 and 0 or 1, true)
end

return support
