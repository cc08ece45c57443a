# SPDX-License-Identifier: MIT
"""Performances from files: CSV of the Live Link Face app or with a column of times, clips, frames of `mien eval` and `mien
play` as JSON, and scenes, which the program `mien` plays."""
import csv
import json
import math
import os
import shutil
import subprocess
import tempfile
from dataclasses import dataclass

import numpy as np

from .binding import mien

TIMECODE_RATE = 60  # frames of a timecode in a second, whatever the app's rate
DAY = 24 * 3600


@dataclass
class Take:
    names: list  # of channels
    seconds: np.ndarray  # float64 (frames,), from 0
    rows: np.ndarray  # float32 (frames, channels)


def read(path):
    """A Take from a file. Raises ValueError or OSError, with a message for the user."""
    end = os.path.splitext(path)[1].lower()
    if end == ".clip":
        return _of_clip(mien.Clip.open(path))
    if end == ".csv":
        with open(path, encoding="utf-8-sig", newline="") as file:
            return _of_csv(file, path)
    with open(path, encoding="utf-8") as file:
        try:
            data = json.load(file)
        except ValueError as error:
            raise ValueError(f"{path}: is neither CSV, nor a clip, nor JSON: {error}") from None
    return _of_json(data, path)


def is_scene(path):
    """Whether a JSON file is a scene of `mien play`."""
    if not path.lower().endswith(".json"):
        return False
    try:
        with open(path, encoding="utf-8") as file:
            data = json.load(file)
    except (OSError, ValueError):
        return False
    return isinstance(data, dict) and "layers" in data


def play_scene(scene, rig, program=""):
    """The Take of a scene on a rig file, which the program `mien` plays."""
    found = program or shutil.which("mien")
    if not found:
        raise ValueError("scenes are played by the program mien, which was not found: name it in the preferences of the "
                         "add-on, or run 'mien play SCENE RIG -o take.csv' and import take.csv")
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "take.csv")
        try:
            result = subprocess.run([found, "play", scene, rig, "--quiet", "-o", out], capture_output=True, text=True)
        except OSError as error:
            raise ValueError(f"cannot start {found}: {error}") from None
        if result.returncode != 0:
            raise ValueError(result.stderr.strip() or f"{found} play ended with {result.returncode}")
        return read(out)


def _of_clip(clip):
    info = clip.info
    rate = info.rate_numerator / info.rate_denominator
    return Take(clip.channels, np.arange(info.frame_count) / rate, np.asarray(clip.read()))


def _timecode(text):
    parts = text.replace(";", ":").split(":")
    hours, minutes, seconds, frames = (float(part) for part in parts)
    return (hours * 60 + minutes) * 60 + seconds + frames / TIMECODE_RATE


def _of_csv(file, path):
    rows = [row for row in csv.reader(file) if row]
    if len(rows) < 2:
        raise ValueError(f"{path}: has no frames: give a header and a row per frame")
    header = [name.strip() for name in rows[0]]
    is_live_link = [name.lower() for name in header[:2]] == ["timecode", "blendshapecount"]
    if not is_live_link and header[0].lower() != "time":
        raise ValueError(f"{path}, row 1: the first column is {header[0][:40]!r}, not \"time\" or \"Timecode\"")
    first = 2 if is_live_link else 1
    seconds, values = [], []
    for number, row in enumerate(rows[1:], 2):
        if is_live_link and len(row) == 2 and row[1].strip() == "0":
            continue  # no face was seen
        if len(row) != len(header):
            raise ValueError(f"{path}, row {number}: has {len(row)} columns, the header has {len(header)}")
        try:
            time = _timecode(row[0]) if is_live_link else float(row[0])
            numbers = [float(cell) for cell in row[first:]]
        except ValueError as error:
            raise ValueError(f"{path}, row {number}: {error}") from None
        if not all(map(math.isfinite, [time, *numbers])):
            raise ValueError(f"{path}, row {number}: holds a number that is not finite")
        if seconds and is_live_link and time < seconds[-1] - DAY / 2:
            time += DAY  # past midnight
        if seconds and time <= seconds[-1]:
            raise ValueError(f"{path}, row {number}: {row[0]} is not later than the row before")
        seconds.append(time)
        values.append(numbers)
    if not seconds:
        raise ValueError(f"{path}: no row has values")
    seconds = np.array(seconds)
    return Take(header[first:], seconds - seconds[0], np.array(values, np.float32))


def _of_json(data, path):
    frames = data.get("frames") if isinstance(data, dict) else None
    if not isinstance(frames, list) or not frames or not all(isinstance(f, dict) and "raw" in f for f in frames):
        raise ValueError(f"{path}: has no \"frames\" with \"raw\" values, as 'mien play' writes them")
    rate = float(data.get("rate", 60))
    seconds = np.array([float(frame.get("time", i / rate)) for i, frame in enumerate(frames)])
    raw = [frame["raw"] for frame in frames]
    if all(isinstance(row, dict) for row in raw):
        names = list(dict.fromkeys(name for row in raw for name in row))
        rows = [[float(row.get(name, 0)) for name in names] for row in raw]
    else:
        names = data.get("controls")
        if not isinstance(names, list) or any(len(row) != len(names) for row in raw):
            raise ValueError(f"{path}: frames without names need a list \"controls\" of the same length")
        rows = raw
    return Take(names, seconds - seconds[0], np.array(rows, np.float32))


def raw_rows(take, rig_file):
    """Raw controls of each frame, which of them are driven, and the names of channels that drive nothing.

    Channels are bound by the names of controls, without regard to case, or by ARKit's names on rigs that name controls in
    MetaHuman's way: mien.Clip.bind with mien.arkit_matrix.
    """
    clip = mien.Clip.build(take.names, take.rows)
    binding = clip.bind(rig_file.rig, mien.arkit_matrix())
    face = rig_file.rig.instance()
    rows = np.zeros((len(take.rows), len(rig_file.controls)), np.float32)
    for row, values in zip(rows, take.rows):
        binding.apply(values, face)
        row[:] = face.raw_controls
    return rows, list(binding.controls), [take.names[i] for i in binding.missing_channels]
