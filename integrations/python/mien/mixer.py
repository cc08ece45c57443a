# SPDX-License-Identifier: MIT
"""Mixers: one character each in a mix."""
from __future__ import annotations

import ctypes
from _thread import allocate_lock
from contextlib import ExitStack, contextmanager
from operator import index
from typing import Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from . import _api
from ._api import (Guard, Interpolation, Looping, MienError, MixerInfo, Status, Transition, text)
from ._library import lib
from ._memory import Closable, Floats, MixerHandle, array_over, as_bytes, floats_of, uint32
from .clip import TICKS_PER_SECOND, Clip, ClipBinding, _fraction, _int
from .errors import ArgumentError, BusyError, fail, raises
from .instance import Instance
from .mix_parts import Curve
from .mix_view import MixView

_byref = ctypes.byref


class MixEvent(NamedTuple):
    """An event of a clip that a step passed."""

    layer: int
    tick: int
    name: str
    value: float


class GuardState(NamedTuple):
    """What a guard did in the last step. Distances are in millimeters."""

    name: str
    kind: Guard
    controls: Tuple[int, ...]
    activation: float
    protected_distance: float
    wanted: float
    limit: float
    distance: float


class Mixer(Closable):
    """One character in a mix, which it keeps, with the clips that it plays. For one thread at a
    time: a second one gets a BusyError. `push` may be called by another one. Times are in ticks.
    """

    __slots__ = ("mix", "_lock", "_push_lock", "_playing", "_restored")

    @raises("mien_mixer_create")
    def __init__(self, mix: MixView, seed: int = 0, stages: bool = False) -> None:
        number = index(seed)
        if not 0 <= number < 1 << 64:
            raise ArgumentError(f"seed {number}: not in 0 ... 2**64 - 1")
        desc = _api.MienMixerDesc(seed=number, stages=bool(stages))
        handle, error = MixerHandle(), MienError()
        status = lib.mien_mixer_create(mix._open(), _byref(desc), _byref(handle), _byref(error))
        if status:
            fail(status, "cannot make a mixer", error)
        self._handle = handle
        self.mix = mix
        self._lock, self._push_lock = allocate_lock(), allocate_lock()
        # What the library may read in a step. A layer plays two clips at most: the last two.
        self._playing: Dict[int, List[Tuple[Any, Any]]] = {}
        self._restored: List[Tuple[Any, Any]] = []

    @contextmanager
    def _alone(self) -> Iterator[Any]:
        """The handle, for this thread."""
        if not self._lock.acquire(False):
            raise BusyError("another thread is working with this mixer, or it is named twice",
                            Status.HANDLE)
        try:
            yield self._open()
        finally:
            self._lock.release()

    def _call(self, function: Any, what: str, *arguments: Any) -> None:
        with self._alone() as handle:
            status = function(handle, *arguments)
            if status:
                fail(status, what)

    # ---- what happens --------------------------------------------------------------------------

    @raises("mien_mixer_play")
    def play(self, layer: int, clip: Clip, binding: ClipBinding, clip_id: int = 0, start: int = 0,
             transition: int = Transition.INERTIAL, duration: int = TICKS_PER_SECOND // 4,
             looping: int = Looping.DEFAULT, interpolation: int = Interpolation.LINEAR,
             speed: Any = 1, mirrored: bool = False) -> None:
        """Plays a clip in a layer, from the next step on. Clip and binding may be closed afterwards.

        clip_id:  a number of yours, by which `restore` finds the clip
        start:    a tick of the clip
        duration: of the transition from what the layer plays
        mirrored: needs `mirror` of the mix
        """
        number = index(clip_id)
        if not 0 <= number < 1 << 64:
            raise ArgumentError(f"clip_id {number}: not in 0 ... 2**64 - 1")
        numerator, denominator = _fraction(speed)
        desc = _api.MienPlayDesc(
            clip_id=number, start_tick=_int(start, 64, "start"),
            transition_ticks=_int(duration, 64, "duration"),
            transition=uint32(transition, "transition"), looping=uint32(looping, "looping"),
            interpolation=uint32(interpolation, "interpolation"), speed_numerator=numerator,
            speed_denominator=denominator, mirrored=bool(mirrored))
        kept, error = (clip._open(), binding._open()), MienError()
        with self._alone() as handle:
            status = lib.mien_mixer_play(handle, uint32(layer, "layer"), kept[0], kept[1],
                                         _byref(desc), _byref(error))
            if status:
                fail(status, f"layer {layer} cannot play the clip", error)
            self._playing.setdefault(layer, []).append(kept)

    @raises("mien_mixer_stop")
    def stop(self, layer: int, fade: int = 0) -> None:
        """Fades out the clip of a layer and stops it."""
        self._call(lib.mien_mixer_stop, f"layer {layer}, fade {fade}", uint32(layer, "layer"),
                   _int(fade, 64, "fade"))

    @raises("mien_mixer_set_weight")
    def set_weight(self, layer: int, weight: float, fade: int = 0) -> None:
        """Fades the weight of a layer."""
        self._call(lib.mien_mixer_set_weight, f"layer {layer}, weight {weight}, fade {fade}",
                   uint32(layer, "layer"), weight, _int(fade, 64, "fade"))

    @raises("mien_mixer_set_pose_weight")
    def set_pose_weight(self, layer: int, pose: int, weight: float, fade: int = 0) -> None:
        """Fades the weight of a pose; `pose` counts from the first one of the layer."""
        self._call(lib.mien_mixer_set_pose_weight,
                   f"layer {layer}, pose {pose}, weight {weight}, fade {fade}",
                   uint32(layer, "layer"), uint32(pose, "pose"), weight, _int(fade, 64, "fade"))

    @raises("mien_mixer_set_variable")
    def set_variable(self, variable: Curve, value: float) -> None:
        """The value that a pose variable, by name or number, has at the start of each step."""
        self._call(lib.mien_mixer_set_variable, f"variable {variable}, {value}",
                   self.mix.variable(variable), value)

    @raises("mien_mixer_set_guard")
    def set_guard(self, guard: int, activation: float) -> None:
        """Sets how much a guard acts, 0 to 1; negative: automatic."""
        self._call(lib.mien_mixer_set_guard, f"guard {guard}, {activation}",
                   uint32(guard, "guard"), activation)

    @raises("mien_mixer_trigger")
    def trigger(self, reaction: int, strength: float = 1.0, hold: int = 0) -> None:
        """Starts a reaction to a stimulus that lasts `hold`; if negative, until `release`."""
        self._call(lib.mien_mixer_trigger, f"reaction {reaction}, {strength}, {hold}",
                   uint32(reaction, "reaction"), strength, _int(hold, 64, "hold"))

    @raises("mien_mixer_release")
    def release(self, reaction: int) -> None:
        """Ends the stimulus of a reaction."""
        self._call(lib.mien_mixer_release, f"reaction {reaction}", uint32(reaction, "reaction"))

    @raises("mien_mixer_set_level")
    def set_level(self, reaction: int, level: float) -> None:
        """Sets the level, 0 to 1, of what a reaction responds to. `Reaction.level_on` or more is a
        stimulus, which ends once the level has been below `level_off` for 50 ms."""
        self._call(lib.mien_mixer_set_level, f"reaction {reaction}, level {level}",
                   uint32(reaction, "reaction"), level)

    @raises("mien_mixer_push")
    def push(self, layer: int, tick: int, values: Any) -> bool:
        """Queues a row for a stream layer, for a time of the mixer. Any thread may call this. False
        for a row that is dropped: it is not newer than the last one, or the queue is full."""
        held, count, address = floats_of(values, "values")
        accepted = ctypes.c_uint32()
        with self._push_lock:  # the library lets one thread push
            status = lib.mien_mixer_push(self._open(), uint32(layer, "layer"),
                                         _int(tick, 64, "tick"), address, count,
                                         _byref(accepted))
        del held
        if status:
            fail(status, f"layer {layer}, tick {tick}, {count} values")
        return bool(accepted.value)

    # ---- stepping ------------------------------------------------------------------------------

    @raises("mien_mixer_step")
    def step(self, ticks: int, instance: Optional[Instance] = None) -> List[MixEvent]:
        """Advances and mixes; raw controls go to the `Instance`. Returns the events of clips that
        it passed."""
        with ExitStack() as stack:
            handle = stack.enter_context(self._alone())
            to = stack.enter_context(instance._alone()) if instance is not None else None
            status = lib.mien_mixer_step(handle, _int(ticks, 64, "ticks"), to)
            if status:
                fail(status, f"cannot step by {ticks} ticks")
            events = self._stepped(handle)
        return events

    def _stepped(self, handle: Any) -> List[MixEvent]:
        for layer, played in self._playing.items():
            del played[:-2]
        found: List[MixEvent] = []
        event, layer_of = _api.MienClipEvent(), ctypes.c_uint32()
        while not lib.mien_mixer_event(handle, len(found), _byref(event), _byref(layer_of)):
            found.append(MixEvent(layer_of.value, event.tick, text(event.name), event.value))
        return found

    @property
    def row(self) -> Floats:
        """float32 (curves,), read-only, no copy: what the last step gave, raw controls and then pose
        variables. Each step changes it."""
        handle, view = self._open(), _api.MienFloatView()
        status = lib.mien_mixer_row(handle, _byref(view))
        if status:
            fail(status, "no row")
        return array_over(handle, view.data, view.count, "f", False)

    @raises("mien_mixer_stage")
    def stage(self, stage: int) -> Floats:
        """The row after a stage of the last step: the layers, reactions, guards, antagonists,
        limits. Read-only, no copy."""
        handle, view = self._open(), _api.MienFloatView()
        status = lib.mien_mixer_stage(handle, uint32(stage, "stage"), _byref(view))
        if status:
            fail(status, f"stage {stage} of {self.mix.info.stage_count}")
        return array_over(handle, view.data, view.count, "f", False)

    @raises("mien_mixer_guard")
    def guard(self, guard: int) -> GuardState:
        """What a guard did in the last step: the distance that later layers wanted, the limit, and
        what is left. Guards are numbered as in `set_guard`."""
        state = _api.MienGuardState()
        handle = self._open()
        status = lib.mien_mixer_guard(handle, uint32(guard, "guard"), _byref(state))
        if status:
            fail(status, f"guard {guard} of {self.mix.info.guard_count}")
        view = state.controls
        controls = tuple(array_over(handle, view.data, view.count, "H", False).tolist())
        return GuardState(text(state.name), Guard(state.kind), controls, state.activation,
                          state.protected_distance, state.wanted, state.limit, state.distance)

    @property
    def info(self) -> MixerInfo:
        """The state of the mixer."""
        found = _api.MienMixerInfo()
        status = lib.mien_mixer_info(self._open(), _byref(found))
        if status:
            fail(status, "no info")
        return MixerInfo._of(found)

    # ---- snapshots -----------------------------------------------------------------------------

    @raises("mien_mixer_snapshot")
    def snapshot(self) -> bytes:
        """All that later steps depend on, except queued rows of streams."""
        with self._alone() as handle:
            size, error = ctypes.c_size_t(), MienError()
            buffer = ctypes.create_string_buffer(self.mix.info.snapshot_bytes)
            status = lib.mien_mixer_snapshot(handle, buffer, len(buffer), _byref(size),
                                             _byref(error))
            if status:
                fail(status, "no snapshot", error)
            return buffer.raw[:size.value]

    @raises("mien_mixer_restore")
    def restore(self, data: Any, clips: Mapping[int, Tuple[Clip, ClipBinding]] = {}) -> None:
        """Restores a snapshot of a mixer of the same mix; later steps give the same bits. The bytes are
        checked.

        clips: those that may be playing, by the `clip_id` of `play`
        """
        data = as_bytes(data)
        kept = [(clip._open(), binding._open()) for clip, binding in clips.values()]
        given = (_api.MienMixerClip * len(kept))()
        for c, clip_id, (clip, binding) in zip(given, clips, kept):
            c.clip_id, c.clip, c.clip_binding = clip_id, clip, binding
        error = MienError()
        with self._alone() as handle:
            status = lib.mien_mixer_restore(handle, data, len(data), given, len(given),
                                            _byref(error))
            if status:
                fail(status, "cannot restore the snapshot", error)
            self._playing, self._restored = {}, kept


@raises("mien_mixer_step_batch")
def step_mixers(mixers: Sequence[Mixer], ticks: int,
                instances: Optional[Sequence[Instance]] = None) -> List[List[MixEvent]]:
    """Steps several mixers, with an instance for each or none: the results of single calls."""
    if instances is not None and len(instances) != len(mixers):
        raise ArgumentError(f"{len(instances)} instances for {len(mixers)} mixers")
    with ExitStack() as stack:
        handles = [stack.enter_context(mixer._alone()) for mixer in mixers]
        faces = [stack.enter_context(instance._alone()) for instance in instances or ()]
        given = (_api.MienMixer * len(handles))(*(handle.value for handle in handles))
        to = (_api.MienInstance * len(faces))(*(face.value for face in faces)) if faces else None
        status = lib.mien_mixer_step_batch(given, to, len(handles), _int(ticks, 64, "ticks"))
        if status:
            fail(status, f"cannot step {len(handles)} mixers by {ticks} ticks")
        events = [mixer._stepped(handle) for mixer, handle in zip(mixers, handles)]
    return events
