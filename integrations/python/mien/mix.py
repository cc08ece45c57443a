# SPDX-License-Identifier: MIT
"""Mixes: layers of clips, poses, streams and generators, reactions and guards, for one rig."""
from __future__ import annotations

import ctypes
from operator import index
from typing import Any, Iterable, List, Optional, Sequence, Tuple

from . import _api
from ._api import MienError
from ._library import lib
from ._memory import (Closable, GazeHandle, MixHandle, as_bytes, as_path, new_array, terminated,
                      uint32)
from .deformer import Deformer
from .errors import fail, raises
from .instance import Instance
from .mix_parts import Antagonists, CustomGuard, Lists, MixLayer, Reaction, full
from .mix_view import MixView
from .mixer import Mixer
from .rig import Rig

_byref = ctypes.byref


class Mix(MixView):
    """What is mixed for one rig, and how. Immutable: any number of threads may use it.

        mix = mien.Mix(rig, [
            mien.MixLayer.clip(mien.LayerGroup.SPEECH),
            mien.MixLayer.poses([{"mouthSmileLeft": 0.9, "mouthSmileRight": 0.9}]),
        ], guards=mien.Guard.LIPS, deformer=deformer)
        mixer = mix.mixer()                       # one character
        mixer.play(0, clip, clip.bind(rig))
        mixer.set_pose_weight(1, 0, 0.7, mien.ticks(0.4))
        mixer.step(mien.ticks(1 / 60), face)      # then face.evaluate()

    variables:   names of pose variables, curves behind the raw controls
    antagonists: such as `Mix.find_antagonists(rig)`
    mirror:      per curve its counterpart, such as of `Mix.find_mirror(deformer)`; None: nothing can
                 be played mirrored
    limits:      (lower, upper), one number for all curves or one for each; None: none
    guards:      `Guard` bits; measured on `deformer`, which takes time
    custom_guards: more of them, for landmarks of yours
    gaze:        for a layer of `MixLayer.gaze`
    """

    __slots__ = ()

    @raises("mien_mix_create")
    def __init__(self, rig: Rig, layers: Iterable[MixLayer], reactions: Iterable[Reaction] = (),
                 guards: int = 0, deformer: Optional[Deformer] = None,
                 custom_guards: Iterable[CustomGuard] = (), gaze: Optional[Gaze] = None,
                 variables: Sequence[str] = (), antagonists: Iterable[Antagonists] = (),
                 mirror: Optional[Sequence[int]] = None,
                 limits: Optional[Tuple[Any, Any]] = None, players: int = 0,
                 max_channels: int = 0, max_changing_channels: int = 0, max_events: int = 0,
                 reverse: bool = False) -> None:
        lists = Lists(rig, variables)
        layer_list = [lists.layer(layer) for layer in layers]
        reaction_list = [lists.reaction(reaction) for reaction in reactions]
        pairs = [_api.MienMixAntagonists(first=lists.curve(a), second=lists.curve(b),
                                         stiffness=stiffness) for a, b, stiffness in antagonists]
        guard_list = [lists.guard(guard) for guard in custom_guards]
        desc = _api.MienMixDesc(
            custom_guards=lists.array(_api.MienMixGuard, guard_list),
            custom_guard_count=len(guard_list), gaze=gaze and gaze._open(),
            layers=lists.array(_api.MienMixLayer, layer_list), layer_count=len(layer_list),
            poses=lists.array(_api.MienMixPose, lists.poses), pose_count=len(lists.poses),
            reactions=lists.array(_api.MienMixReaction, reaction_list),
            reaction_count=len(reaction_list),
            antagonists=lists.array(_api.MienMixAntagonists, pairs), antagonist_count=len(pairs),
            deformer=deformer and deformer._open(), guards=uint32(guards, "guards"),
            variable_count=len(variables), player_count=uint32(players, "players"),
            max_channels=uint32(max_channels, "max_channels"),
            max_changing_channels=uint32(max_changing_channels, "max_changing_channels"),
            max_events=uint32(max_events, "max_events"), reverse=bool(reverse))
        if mirror is not None:
            desc.mirror = lists.curves(full(list(mirror), lists.curve_count, "mirror"))
        if limits is not None:
            lower, upper = limits
            desc.lower = lists.limit(lower)
            desc.upper = lists.limit(upper)
        handle, error = MixHandle(), MienError()
        status = lib.mien_mix_create(rig._open(), _byref(desc), _byref(handle), _byref(error))
        del lists
        if status:
            fail(status, "cannot make a mix", error)
        self._take(handle, variables)

    def mixer(self, seed: int = 0, stages: bool = False) -> Mixer:
        """A new character. seed: of generators; stages: for `Mixer.stage`."""
        return Mixer(self, seed, stages)

    # ---- files ---------------------------------------------------------------------------------

    @classmethod
    @raises("mien_mix_open_file")
    def open(cls, path: Any, rig: Optional[Rig], variables: Sequence[str] = ()) -> Mix:
        """Opens a file for a rig that has the controls of the mix. None: without a rig, for
        `to_text`. variables: names for the pose variables, which the file does not have."""
        handle, error = MixHandle(), MienError()
        status = lib.mien_mix_open_file(as_path(path), rig and rig._open(), None, _byref(handle),
                                        _byref(error))
        if status:
            fail(status, f"cannot open {path}", error, path)
        return cls._of(handle, variables)

    @classmethod
    @raises("mien_mix_open_memory")
    def from_bytes(cls, data: Any, rig: Optional[Rig], variables: Sequence[str] = ()) -> Mix:
        """The same from memory, which is not needed afterwards."""
        data = as_bytes(data)
        handle, error = MixHandle(), MienError()
        status = lib.mien_mix_open_memory(data, len(data), rig and rig._open(), None,
                                          _byref(handle), _byref(error))
        if status:
            fail(status, "cannot open the bytes", error)
        return cls._of(handle, variables)

    @classmethod
    def _of(cls, handle: MixHandle, variables: Sequence[str]) -> Mix:
        mix = cls.__new__(cls)
        mix._take(handle, variables)
        return mix

    @raises("mien_mix_write_file")
    def save(self, path: Any) -> None:
        """Writes a file. A failure leaves `path` as it was."""
        error = MienError()
        status = lib.mien_mix_write_file(self._open(), as_path(path), _byref(error))
        if status:
            fail(status, f"cannot write {path}", error, path)

    @raises("mien_mix_write_memory")
    def to_bytes(self) -> bytes:
        """The bytes of the file."""
        return self._written(lib.mien_mix_write_memory)

    @raises("mien_mix_write_text")
    def to_text(self) -> str:
        """The mix as text, for reading and version control: one line for each number."""
        return self._written(lib.mien_mix_write_text).decode("utf-8", "surrogateescape")

    def _written(self, write: Any) -> bytes:
        size, error = ctypes.c_size_t(), MienError()
        status = write(self._open(), None, 0, _byref(size), _byref(error))
        if not status:
            buffer = ctypes.create_string_buffer(size.value)
            status = write(self._open(), buffer, size.value, _byref(size), _byref(error))
        if status:
            fail(status, "cannot write the mix", error)
        return buffer.raw

    # ---- tables measured on a rig --------------------------------------------------------------

    @staticmethod
    @raises("mien_mix_antagonists")
    def find_antagonists(rig: Rig) -> List[Antagonists]:
        """Pairs of raw controls that the two halves of one GUI control drive."""
        count = ctypes.c_size_t()
        status = lib.mien_mix_antagonists(rig._open(), None, 0, _byref(count))
        pairs = (_api.MienMixAntagonists * count.value)()
        if not status:
            status = lib.mien_mix_antagonists(rig._open(), pairs, count.value, _byref(count))
        if status:
            fail(status, "no antagonists")
        return [Antagonists(p.first, p.second, p.stiffness) for p in pairs]

    @staticmethod
    @raises("mien_mix_mirror")
    def find_mirror(deformer: Deformer, curve_count: int) -> List[int]:
        """For each curve its counterpart in the other half of the face, or itself."""
        curves, error = (ctypes.c_uint16 * index(curve_count))(), MienError()
        status = lib.mien_mix_mirror(deformer._open(), curves, len(curves), _byref(error))
        if status:
            fail(status, "no mirror map", error)
        return list(curves)

    @staticmethod
    @raises("mien_mix_mask")
    def find_mask(rig: Rig, groups: Iterable[int], curve_count: int, otherwise: float = 0.0) -> Any:
        """For each raw control the share of its joint motion that belongs to some joint groups,
        float32; `otherwise` for those that move no joint, and for pose variables."""
        numbers = [uint32(group, "group") for group in groups]
        list_of_groups = (ctypes.c_uint32 * len(numbers))(*numbers)
        values, address = new_array("f", index(curve_count))
        error = MienError()
        status = lib.mien_mix_mask(rig._open(), list_of_groups, len(numbers), otherwise, address,
                                   index(curve_count), _byref(error))
        if status:
            fail(status, "no mask", error)
        return values


class Gaze(Closable):
    """Which raw controls turn the eyes of a rig, and by how much. Immutable: any number of threads may
    use it. Needs no deformer once it is made.

    left_eye, right_eye: names of joints; None: those that heads usually have
    """

    __slots__ = ()

    @raises("mien_gaze_create")
    def __init__(self, deformer: Deformer, left_eye: Optional[str] = None,
                 right_eye: Optional[str] = None) -> None:
        names: List[Any] = [
            name if name is None else ctypes.create_string_buffer(
                terminated(name.encode("utf-8", "surrogateescape"), "a name"))
            for name in (left_eye, right_eye)]
        left, right = (ctypes.cast(name, ctypes.c_void_p) for name in names)
        desc = _api.MienGazeDesc(left_eye=left, right_eye=right)
        handle, error = GazeHandle(), MienError()
        status = lib.mien_gaze_create(deformer._open(), _byref(desc), _byref(handle),
                                      _byref(error))
        if status:
            fail(status, "cannot make a gaze", error)
        self._handle = handle

    @property
    @raises("mien_gaze_info")
    def eyes(self) -> Tuple[Tuple[float, float, float], Tuple[float, float, float]]:
        """The centers of the left and the right eye, in the coordinates of `look_at`."""
        info = _api.MienGazeInfo()
        status = lib.mien_gaze_info(self._open(), _byref(info))
        if status:
            fail(status, "no info")
        left, right = info.left_eye, info.right_eye
        return (left.left, left.up, left.front), (right.left, right.up, right.front)

    @raises("mien_gaze_look_at")
    def look_at(self, target: Tuple[float, float, float],
                instance: Instance) -> Tuple[float, float]:
        """Sets the raw controls of an `Instance` so that both eyes look at a point: millimeters to the
        left, up and to the front, in the model space of the rig with its head in the neutral pose.
        Returns the part that the eyes cannot reach, for the head to turn: tangents of angles to the
        left and up."""
        left, up, front = (float(value) for value in target)
        to = _api.MienGazeTarget(left=left, up=up, front=front)
        rest, view = _api.MienGazeRest(), _api.MienMutableFloatView()
        with instance._alone() as handle:
            status = lib.mien_instance_raw_controls(handle, _byref(view))
            if not status:
                status = lib.mien_gaze_look_at(self._open(), _byref(to), view.data, view.count,
                                               _byref(rest))
        if status:
            fail(status, f"cannot look at {target}")
        return rest.left, rest.up
