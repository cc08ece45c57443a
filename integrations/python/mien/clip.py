# SPDX-License-Identifier: MIT
"""Clips: control curves at a constant rate; playing them, and which controls they drive."""
from __future__ import annotations

import ctypes
from fractions import Fraction
from operator import index
from typing import Any, Iterable, List, NamedTuple, Optional, Sequence, Tuple

from . import _api
from ._api import (ClipChannel, ClipInfo, ClipPlayerInfo, FileAccess, Interpolation, Looping,
                   MienError, Status, text)
from ._library import lib
from ._memory import (ClipBindingHandle, ClipHandle, ClipPlayerHandle, Closable, FileStream,
                      array_over, as_bytes, as_path, floats_of, new_array, shaped, uint32)
from .errors import ArgumentError, OutOfRangeError, fail, raises

_byref = ctypes.byref

#: The unit of all times of clips.
TICKS_PER_SECOND: int = _api.MIEN_TICKS_PER_SECOND


class ClipEvent(NamedTuple):
    """A named moment of a clip: a phoneme, a footstep."""

    tick: int
    name: str
    value: float


def _encoded(name: str) -> bytes:
    return name.encode("utf-8", "surrogateescape")


def _views(names: Sequence[bytes]) -> Any:
    """Names as C takes them. They have to outlive the call."""
    views = (_api.MienStringView * len(names))()
    for view, name in zip(views, names):
        view.data, view.count = ctypes.cast(ctypes.c_char_p(name), ctypes.c_void_p).value, len(name)
    return views


def _int(value: Any, bits: int, what: str) -> int:
    number = index(value)
    if not -(1 << bits - 1) <= number < 1 << bits - 1:
        raise OutOfRangeError(f"{what} {number}: not in -2**{bits - 1} ... 2**{bits - 1} - 1",
                              Status.INDEX)
    return number


class Clip(Closable):
    """Control curves at a constant rate, compressed. Immutable: any number of threads may use it.

        clip = mien.Clip.build(["jawOpen", "mouthClose"], rows, rate=60)
        clip.save("take.clip")
        with mien.Clip.open("take.clip") as clip:
            rows = clip.read()                       # float32 (frames, channels), the same bits
            player, binding = clip.player(), clip.bind(rig)
        player.advance(mien.TICKS_PER_SECOND // 60)
        binding.apply(player.sample(), face)         # then face.evaluate()
    """

    __slots__ = ("info",)

    def __init__(self, handle: ClipHandle) -> None:
        self._handle = handle
        found = _api.MienClipInfo()
        status = lib.mien_clip_info(handle, _byref(found))
        if status:
            fail(status, "no info")
        self.info: ClipInfo = ClipInfo._of(found)

    @classmethod
    @raises("mien_clip_build")
    def build(cls, names: Sequence[str], values: Any, rate: Any = 60, snap: Any = 0,
              looping: int = Looping.DEFAULT, events: Iterable[ClipEvent] = (),
              is_delta: bool = False) -> Clip:
        """A clip of rows of values, one row per frame, one value per name.

        rate: frames per second, a number or a `fractions.Fraction`
        snap: 0 keeps every bit; a step of 2**-9 ... 2**-16, for all channels or one for each, rounds
              values to it
        """
        encoded = [_encoded(name) for name in names]
        held, count, address = floats_of(values, "values", (None, len(encoded)))
        frames, rest = divmod(count, len(encoded)) if encoded else (1, count)
        if rest:
            raise ArgumentError(f"{count} values are no rows of {len(encoded)}")
        given = [ClipEvent(*event) for event in events]
        event_names = [_encoded(event.name) for event in given]
        list_of_events = (_api.MienClipEvent * len(given))()
        for c, event, view in zip(list_of_events, given, _views(event_names)):
            c.tick, c.name, c.value = _int(event.tick, 64, "tick"), view, event.value
        fps = Fraction(rate).limit_denominator(1 << 20)
        if fps <= 0:
            raise ArgumentError(f"rate {rate}: not above 0")
        desc = _api.MienClipDesc(
            rate_numerator=uint32(fps.numerator, "rate"), rate_denominator=fps.denominator,
            frame_count=uint32(frames, "frames"), channel_count=uint32(len(encoded), "channels"),
            values=address, looping=uint32(looping, "looping"), is_delta=bool(is_delta),
            event_count=len(given))
        views = _views(encoded)
        desc.names = ctypes.cast(views, type(desc.names))
        desc.events = ctypes.cast(list_of_events, type(desc.events))
        steps = None
        if hasattr(snap, "__len__"):
            steps, step_count, desc.snaps = floats_of(snap, "snap")
            if step_count != len(encoded):
                raise ArgumentError(f"snap takes one step or {len(encoded)}, not {step_count}")
        else:
            desc.snap = snap
        handle, error = ClipHandle(), MienError()
        status = lib.mien_clip_build(_byref(desc), _byref(handle), _byref(error))
        del held, steps, views
        if status:
            fail(status, "cannot build a clip", error)
        return cls(handle)

    @classmethod
    @raises("mien_clip_open_file")
    def open(cls, path: Any, access: int = FileAccess.READ) -> Clip:
        """Opens a file. `FileAccess.MAP` reads only what is needed, but a mapped file that is
        truncated crashes the process, so the default reads all of it."""
        desc = _api.MienClipOpenDesc(file_access=uint32(access, "access"))
        handle, error = ClipHandle(), MienError()
        status = lib.mien_clip_open_file(as_path(path), _byref(desc), _byref(handle),
                                         _byref(error))
        if status:
            fail(status, f"cannot open {path}", error, path)
        return cls(handle)

    @classmethod
    @raises("mien_clip_open_memory")
    def from_bytes(cls, data: Any) -> Clip:
        """The same from memory, which is kept alive."""
        data = as_bytes(data)
        handle, error = ClipHandle(), MienError()
        status = lib.mien_clip_open_memory(data, len(data), None, _byref(handle), _byref(error))
        if status:
            fail(status, "cannot open the bytes", error)
        handle.keeps = data
        return cls(handle)

    @classmethod
    @raises("mien_clip_open_stream")
    def from_stream(cls, file: Any) -> Clip:
        """The same from a binary file object that can seek: reads it to its end, from where it
        stands."""
        stream = FileStream(file)
        handle, error = ClipHandle(), MienError()
        status = lib.mien_clip_open_stream(_byref(stream.stream), None, _byref(handle),
                                           _byref(error))
        stream.check()
        if status:
            fail(status, "cannot open the stream", error)
        return cls(handle)

    @raises("mien_clip_write_file")
    def save(self, path: Any) -> None:
        """Writes the file. A failure leaves `path` as it was."""
        error = MienError()
        status = lib.mien_clip_write_file(self._open(), as_path(path), _byref(error))
        if status:
            fail(status, f"cannot write {path}", error, path)

    @raises("mien_clip_write_memory")
    def to_bytes(self) -> bytes:
        """The bytes of the file."""
        size, error = ctypes.c_size_t(), MienError()
        status = lib.mien_clip_write_memory(self._open(), None, 0, _byref(size), _byref(error))
        if not status:
            buffer = ctypes.create_string_buffer(size.value)
            status = lib.mien_clip_write_memory(self._open(), buffer, size.value, _byref(size),
                                                _byref(error))
        if status:
            fail(status, "cannot write the clip", error)
        return buffer.raw

    @raises("mien_clip_channel")
    def channel(self, number: int) -> ClipChannel:
        """A channel: its name, and how its curve is stored."""
        found = _api.MienClipChannel()
        status = lib.mien_clip_channel(self._open(), uint32(number, "channel"), _byref(found))
        if status:
            fail(status, f"channel {number} of {self.info.channel_count}")
        return ClipChannel._of(found)

    @property
    def channels(self) -> List[str]:
        """Names of the channels, in their order."""
        return [self.channel(c).name for c in range(self.info.channel_count)]

    @raises("mien_clip_find_channel_n")
    def find(self, name: str) -> int:
        """Index of the channel with a name."""
        encoded, found = _encoded(name), ctypes.c_uint32()
        status = lib.mien_clip_find_channel_n(self._open(), encoded, len(encoded), _byref(found))
        if status:
            fail(status, f"channel {name!r}")
        return found.value

    @property
    def events(self) -> List[ClipEvent]:
        """All events, by their ticks."""
        found, event = [], _api.MienClipEvent()
        for e in range(self.info.event_count):
            status = lib.mien_clip_event(self._open(), e, _byref(event))
            if status:
                fail(status, f"event {e}")
            found.append(ClipEvent(event.tick, text(event.name), event.value))
        return found

    @raises("mien_clip_verify")
    def verify(self) -> None:
        """Raises `ClipError` if the clip has changed since it was written."""
        error = MienError()
        status = lib.mien_clip_verify(self._open(), _byref(error))
        if status:
            fail(status, "the clip is damaged", error)

    @raises("mien_clip_read")
    def read(self, first: int = 0, count: Optional[int] = None) -> Any:
        """Frames: float32 (count, channels); without NumPy, one after the other in an array."""
        first = uint32(first, "first")
        if count is None:
            count = max(self.info.frame_count - first, 0)
        if first + index(count) > self.info.frame_count or count < 0:
            raise OutOfRangeError(f"{count} frames from frame {first} on: the clip has "
                                  f"{self.info.frame_count}", Status.INDEX)
        values, address = new_array("f", count * self.info.channel_count)
        error = MienError()
        status = lib.mien_clip_read(self._open(), first, count, address, 0, _byref(error))
        if status:
            fail(status, "cannot read the frames", error)
        return shaped(values, (count, self.info.channel_count))

    def player(self, speed: Any = 1, looping: int = Looping.DEFAULT,
               interpolation: int = Interpolation.LINEAR, start: int = 0,
               reverse: bool = False) -> ClipPlayer:
        """A player. speed: a number or a `fractions.Fraction`; negative is backward. start: a tick.
        reverse: with memory for playing backward as fast as forward."""
        return ClipPlayer(self, speed, looping, interpolation, start, reverse)

    def bind(self, rig: Any, matrix: Iterable[Tuple[str, str, float]] = ()) -> ClipBinding:
        """Maps channels to raw controls of a `Rig`, by name; `matrix` has entries (channel,
        control, weight) for channels with other names."""
        return ClipBinding(self, rig, matrix)


@raises("mien_arkit_matrix")
def arkit_matrix() -> List[Tuple[str, str, float]]:
    """For `Clip.bind`: entries (expression, raw control, weight) that bind clips with ARKit names to
    rigs with the other common naming of controls, eyeBlinkL for eyeBlinkLeft."""
    count = ctypes.c_size_t()
    status = lib.mien_arkit_matrix(None, 0, _byref(count))
    entries = (_api.MienMatrixEntry * count.value)()
    if not status:
        status = lib.mien_arkit_matrix(entries, count.value, _byref(count))
    if status:
        fail(status, "no table")
    return [(text(e.channel), text(e.control), e.weight) for e in entries]


def _fraction(speed: Any) -> Tuple[int, int]:
    found = Fraction(speed).limit_denominator(1 << 20)
    return _int(found.numerator, 32, "speed"), found.denominator


class ClipPlayer(Closable):
    """Plays one clip for one character, and keeps the clip alive. For one thread at a time."""

    __slots__ = ()

    def __init__(self, clip: Clip, speed: Any = 1, looping: int = Looping.DEFAULT,
                 interpolation: int = Interpolation.LINEAR, start: int = 0,
                 reverse: bool = False) -> None:
        numerator, denominator = _fraction(speed)
        desc = _api.MienClipPlayerDesc(
            looping=uint32(looping, "looping"), start_tick=_int(start, 64, "start"),
            interpolation=uint32(interpolation, "interpolation"), speed_numerator=numerator,
            speed_denominator=denominator, reverse=bool(reverse))
        handle, error = ClipPlayerHandle(), MienError()
        status = lib.mien_clip_player_create(clip._open(), _byref(desc), _byref(handle),
                                             _byref(error))
        if status:
            fail(status, "cannot play the clip", error)
        handle.clip = clip._open()
        self._handle = handle

    @property
    def info(self) -> ClipPlayerInfo:
        """The state of playback."""
        found = _api.MienClipPlayerInfo()
        status = lib.mien_clip_player_info(self._open(), _byref(found))
        if status:
            fail(status, "no info")
        return ClipPlayerInfo._of(found)

    def seek(self, tick: int) -> None:
        """Moves to a tick, without passing events."""
        status = lib.mien_clip_player_seek(self._open(), _int(tick, 64, "tick"))
        if status:
            fail(status, f"cannot seek {tick}")

    @raises("mien_clip_player_set_speed")
    def set_speed(self, speed: Any) -> None:
        """Sets the speed for later steps."""
        status = lib.mien_clip_player_set_speed(self._open(), *_fraction(speed))
        if status:
            fail(status, f"speed {speed}")

    @raises("mien_clip_player_advance")
    def advance(self, ticks: int) -> List[ClipEvent]:
        """Moves by ticks times the speed. Returns the events that were passed, in order."""
        handle = self._open()
        status = lib.mien_clip_player_advance(handle, _int(ticks, 64, "ticks"))
        if status:
            fail(status, f"cannot advance by {ticks} ticks")
        passed, event, found = [], _api.MienClipEvent(), ctypes.c_uint32()
        while not lib.mien_clip_player_next_event(handle, _byref(event), _byref(found)) \
                and found.value:
            passed.append(ClipEvent(event.tick, text(event.name), event.value))
        return passed

    def sample(self) -> Any:
        """Values of all channels at the current position: float32, read-only, no copy; overwritten by
        the next call."""
        handle, view = self._open(), _api.MienFloatView()
        status = lib.mien_clip_player_sample(handle, _byref(view))
        if status:
            fail(status, "cannot sample")
        return array_over(handle, view.data, view.count, "f", False)


class ClipBinding(Closable):
    """Maps channels of a clip to raw controls of a rig. Immutable: any number of threads may use it.
    Clip and rig may be closed."""

    __slots__ = ("channel_count", "controls", "missing_channels", "extra_controls",
                 "missing_entries")

    @raises("mien_clip_binding_create")
    def __init__(self, clip: Clip, rig: Any, matrix: Iterable[Tuple[str, str, float]] = ()) -> None:
        entries = [(_encoded(channel), _encoded(control), float(weight))
                   for channel, control, weight in matrix]
        given = (_api.MienMatrixEntry * len(entries))()
        for c, channel, control, entry in zip(given, _views([e[0] for e in entries]),
                                              _views([e[1] for e in entries]), entries):
            c.channel, c.control, c.weight = channel, control, entry[2]
        desc = _api.MienClipBindingDesc(matrix_count=len(entries))
        desc.matrix = ctypes.cast(given, type(desc.matrix))
        handle, error = ClipBindingHandle(), MienError()
        status = lib.mien_clip_binding_create(clip._open(), rig._open(), _byref(desc),
                                              _byref(handle), _byref(error))
        if status:
            fail(status, "cannot bind the clip", error)
        self._handle = handle
        info = _api.MienClipBindingInfo()
        status = lib.mien_clip_binding_info(handle, _byref(info))
        if status:
            fail(status, "no info")
        #: Channels of the clip.
        self.channel_count: int = info.channel_count
        #: Raw controls that are driven.
        self.controls: List[int] = _numbers(info.controls)
        #: Channels that drive nothing.
        self.missing_channels: List[int] = _numbers(info.missing_channels)
        #: Raw controls that nothing drives.
        self.extra_controls: List[int] = _numbers(info.extra_controls)
        #: Entries of the matrix with a channel or a control that is not there.
        self.missing_entries: int = info.missing_entry_count

    @raises("mien_clip_binding_apply")
    def apply(self, values: Any, instance: Any) -> None:
        """Writes the raw controls of an `Instance` that are driven; `values` as from
        `ClipPlayer.sample`."""
        held, count, address = floats_of(values, "values")
        raw, view = instance._open(), _api.MienMutableFloatView()
        status = lib.mien_instance_raw_controls(raw, _byref(view))
        if not status:
            status = lib.mien_clip_binding_apply(self._open(), address, count, view.data,
                                                 view.count)
        del held
        if status:
            fail(status, f"cannot apply {count} values")

    @raises("mien_clip_binding_snaps")
    def find_snaps(self, deformer: Any, tolerance: float = 0.02) -> List[float]:
        """For `snaps` of `Clip.build`: for each channel the coarsest step of which half moves no vertex
        of a `Deformer` by more than `tolerance` millimeters. Slow: deforms the rig at least 10 times
        per channel."""
        steps = (ctypes.c_float * self.channel_count)()
        error = MienError()
        status = lib.mien_clip_binding_snaps(self._open(), deformer._open(), float(tolerance), steps,
                                             self.channel_count, _byref(error))
        if status:
            fail(status, "no steps", error)
        return list(steps)


def _numbers(view: Any) -> List[int]:
    return list((ctypes.c_uint16 * view.count).from_address(view.data)) if view.count else []
