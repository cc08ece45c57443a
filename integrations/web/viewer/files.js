// SPDX-License-Identifier: MIT
// Performances and poses as text: CSV of the Live Link Face app, JSON of this page, `mien eval` and `mien play`.

/** {names, values, rate} of a CSV file: a heading of names, then a row per frame. */
export function readCsv(text) {
  const lines = text.split(/\r?\n/).filter((line) => line.trim() !== "");
  if (lines.length < 2) throw new Error("the CSV file has no frames");
  const heading = lines[0].split(",").map((name) => name.trim());
  // Recordings begin with a timecode and a count, which are no channels.
  const columns = heading.map((name, i) => [name, i])
    .filter(([name]) => name && !/^(timecode|blendshapecount|frame|time)$/i.test(name));
  if (columns.length === 0) throw new Error("the CSV file has no channels");
  const values = new Float32Array(columns.length * (lines.length - 1));
  lines.slice(1).forEach((line, row) => {
    const cells = line.split(",");
    columns.forEach(([name, i], column) => {
      const value = Number(cells[i]);
      if (cells[i] === undefined || cells[i].trim() === "" || !Number.isFinite(value)) {
        throw new Error(`line ${row + 2}, ${name}: "${cells[i] ?? ""}" is not a number`);
      }
      values[row * columns.length + column] = value;
    });
  });
  // ARKit names begin small; Live Link Face writes them with a capital.
  const names = columns.map(([name]) => name[0].toLowerCase() + name.slice(1));
  return { names, values, rate: rateOf(heading, lines) };
}

/** Frames per second by the timecodes, hours:minutes:seconds:frames: one more than the largest frame number. */
function rateOf(heading, lines) {
  const column = heading.findIndex((name) => /^timecode$/i.test(name));
  if (column < 0) return 60;
  const frames = lines.slice(1).map((line) => Number(/^\d+:\d+:\d+[:;](\d+)/.exec(line.split(",")[column])?.[1] ?? -1));
  const most = frames.reduce((a, b) => Math.max(a, b), -1);
  return [24, 25, 30, 50, 60].find((rate) => most < rate) ?? 60;
}

/** Whether a JSON value is phonemes, as `mien speak` and the Montreal Forced Aligner write them. */
export const isPhonemes = (value) => Array.isArray(value?.phonemes) || Boolean(value?.tiers?.phones);

/** Values by name: of an object, or of a list in the order of `names`. */
function named(values, names, what) {
  if (Array.isArray(values) && Array.isArray(names)) {
    if (values.length !== names.length) throw new Error(`${what}: ${values.length} values for ${names.length} names`);
    return Object.fromEntries(values.map((value, i) => [names[i], value]));
  }
  if (!values || typeof values !== "object" || Array.isArray(values)) throw new Error(`${what} is no object of controls by name`);
  return values;
}

/** A pose {raw: {name: value}}, frames of them, or frames of `mien play`, with lists of values; {names, values, rate} for
 * frames, {pose} for one pose. */
export function readFrames(value) {
  const frames = !Array.isArray(value?.frames) ? [value?.raw ?? value] : value.frames.map((frame, i) => {
    const variables = frame?.variables ? named(frame.variables, value.variables, `frame ${i}, variables`) : {};
    return { ...named(frame?.raw ?? frame, value.controls, `frame ${i}`), ...variables };
  });
  for (const [i, frame] of frames.entries()) {
    for (const [name, number] of Object.entries(named(frame, null, `frame ${i}`))) {
      if (typeof number !== "number" || !Number.isFinite(number)) throw new Error(`frame ${i}, ${name}: no number`);
    }
  }
  if (frames.length === 0) throw new Error("there are no frames");
  if (frames.length === 1) return { pose: frames[0] };
  const names = [...new Set(frames.flatMap((frame) => Object.keys(frame)))];
  const values = Float32Array.from(frames.flatMap((frame) => names.map((name) => frame[name] ?? 0)));
  return { names, values, rate: Number(value.rate) > 0 ? Math.round(value.rate) : 60 };
}
