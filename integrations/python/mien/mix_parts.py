# SPDX-License-Identifier: MIT
"""What a mix is made of: layers, poses, reactions, guards of the caller."""
from __future__ import annotations

import ctypes
from operator import index
from typing import Any, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

from . import _api
from ._api import BlendMode, Generator, Kind, LayerGroup, LayerSource, Retrigger, Status
from ._library import lib
from ._memory import floats_of, uint32
from .clip import TICKS_PER_SECOND
from .errors import ArgumentError, OutOfRangeError, fail
from .rig import Rig

_byref = ctypes.byref

#: A raw control or pose variable: its name, or its number among the curves.
Curve = Union[str, int]
#: Values of the curves that a pose moves: {"mouthSmileLeft": 0.8}.
Pose = Mapping[Curve, float]


def ticks(seconds: float) -> int:
    """Seconds in the unit of all times."""
    return round(seconds * TICKS_PER_SECOND)


class MixLayer(NamedTuple):
    """A layer of a mix. Make it with `clip`, `poses`, `stream` or `generator`.

    mask: weights of curves, 0 to 1: {"jawOpen": 0.5} or names alone for 1, others are 0; or an array
          with one weight per curve. None: 1 for all
    weight: initial weight, 0 to 1; with `BlendMode.ADD` -1 to 1
    after_guards: acts after the guards; not for base and speech
    """

    source: int
    group: int = LayerGroup.BASE
    mode: int = BlendMode.OVERRIDE
    weight: float = 1.0
    mask: Any = None
    after_guards: bool = False
    bank: Sequence[Pose] = ()
    curves: Sequence[Curve] = ()
    amounts: Sequence[float] = ()
    kind: int = Generator.BLINK
    period: int = 0
    delay: int = 0
    frames: int = 0

    @classmethod
    def clip(cls, group: int = LayerGroup.BASE, mode: int = BlendMode.OVERRIDE,
             weight: float = 1.0, mask: Any = None, after_guards: bool = False) -> MixLayer:
        """Plays clips: `Mixer.play`."""
        return cls(LayerSource.CLIP, group, mode, weight, mask, after_guards)

    @classmethod
    def poses(cls, bank: Iterable[Pose], group: int = LayerGroup.EMOTION,
              mode: int = BlendMode.SCREEN, weight: float = 1.0, mask: Any = None,
              after_guards: bool = False) -> MixLayer:
        """A weighted sum of poses: `Mixer.set_pose_weight`."""
        return cls(LayerSource.POSES, group, mode, weight, mask, after_guards, tuple(bank))

    @classmethod
    def stream(cls, channels: Iterable[Curve], group: int = LayerGroup.BASE,
               mode: int = BlendMode.OVERRIDE, weight: float = 1.0, mask: Any = None,
               after_guards: bool = False, delay: int = 0, frames: int = 0) -> MixLayer:
        """Rows that arrive from outside, one value for each of these curves: `Mixer.push`.

        delay:  ticks by which rows are played later than their times, which hides jitter
        frames: most rows that can be queued; 0 means 64
        """
        return cls(LayerSource.STREAM, group, mode, weight, mask, after_guards,
                   curves=tuple(channels), delay=delay, frames=frames)

    @classmethod
    def generator(cls, kind: int, curves: Mapping[Curve, float], period: int,
                  group: int = LayerGroup.LIFE, mode: int = BlendMode.ADD, weight: float = 1.0,
                  mask: Any = None, after_guards: bool = False) -> MixLayer:
        """Blinks, breath or noise (`Generator`) for curves with amounts; `period` in ticks."""
        return cls(LayerSource.GENERATOR, group, mode, weight, mask, after_guards,
                   curves=tuple(curves), amounts=tuple(curves.values()), kind=kind, period=period)

    @classmethod
    def gaze(cls, target: Sequence[Curve], head: Mapping[Curve, float] = {},
             jitter: Tuple[float, float] = (0.0, 0.0), period: int = TICKS_PER_SECOND // 4,
             group: int = LayerGroup.LIFE, weight: float = 1.0) -> MixLayer:
        """Turns the eyes to a target, by the `gaze` of the mix.

        target: three curves, usually pose variables: millimeters to the left, up and to the front
        head:   two curves with factors, which get what is left for the head
        jitter: degrees of fixation across and up; `period` is its time
        """
        return cls(LayerSource.GENERATOR, group, BlendMode.OVERRIDE, weight,
                   curves=(*target, *head), amounts=(*jitter, 0.0, *head.values()),
                   kind=Generator.GAZE, period=period)


class Stroke(NamedTuple):
    """A part of a reaction: moves curves to a pose and back. Times are in ticks.

    is_held: holds as long as the stimulus lasts, instead of for `hold`
    is_lag:  moves exponentially; attack and release are time constants
    is_scaled: scaled by the level of the reaction, which is 1 if it was triggered
    """

    pose: Pose
    mode: int = BlendMode.OVERRIDE
    delay: int = 0
    attack: int = 0
    hold: int = 0
    release: int = 0
    is_held: bool = False
    is_lag: bool = False
    is_scaled: bool = False


class Reaction(NamedTuple):
    """What a face does in response to a stimulus: `Mixer.trigger`.

    cooldown: ticks; shortest time between two starts of strokes that are not held
    adapted:  share of the strength that remains while the stimulus lasts
    adapt_ticks, recover_ticks: time constants of that and of recovering
    level_on: `Mixer.set_level` with this or more is a stimulus; 0: none is
    level_off: it ends below this, which is at most level_on
    """

    strokes: Sequence[Stroke]
    retrigger: int = Retrigger.EXTEND
    cooldown: int = 0
    adapted: float = 1.0
    adapt_ticks: int = 0
    recover_ticks: int = 0
    after_guards: bool = False
    level_on: float = 0.0
    level_off: float = 0.0


class Antagonists(NamedTuple):
    """Two curves that move the face in opposite directions."""

    first: int
    second: int
    stiffness: float = 1.0


#: No raw control: what a `CustomGuard` measures touches at rest.
NO_CONTROL: int = _api.MIEN_NO_CONTROL


class Landmark(NamedTuple):
    """A point of the face: the mean of some positions of a mesh that LOD 0 shows, or of some joints
    (mesh None)."""

    points: Sequence[int]
    mesh: Optional[int] = None


class CustomGuard(NamedTuple):
    """A guard with your landmarks: keeps the gap of `upper` above `lower` from being opened.

    closed_by: raw control that makes both touch at 1; NO_CONTROL: they do at rest
    tolerance: millimeters by which later layers may open
    f_on:      acts where base and speech open by less millimeters
    """

    upper: Landmark
    lower: Landmark
    closed_by: Curve = NO_CONTROL
    needs_speech: bool = False
    tolerance: float = 0.3
    f_on: float = 12.0


def glare(poses: Sequence[Pose]) -> Reaction:
    """A ready-made reaction to a light in the eyes. Its five poses: lids closed; squint and lowered
    brows; gaze turned away; narrow pupils; head turned away. An empty pose leaves its part out."""
    if len(poses) != 5:
        raise ArgumentError(f"{len(poses)} poses: a glare takes 5")
    strokes, reaction = (_api.MienMixStroke * 5)(), _api.MienMixReaction()
    status = lib.mien_mix_glare(0, strokes, len(strokes), _byref(reaction))
    if status:
        fail(status, "no glare")
    return Reaction(
        [Stroke(poses[s.pose], s.mode, s.delay, s.attack, s.hold, s.release, bool(s.is_held),
                bool(s.is_lag), bool(s.is_scaled)) for s in strokes],
        reaction.retrigger, reaction.cooldown, reaction.adapted, reaction.adapt_ticks,
        reaction.recover_ticks, bool(reaction.after_guards), reaction.level_on,
        reaction.level_off)


class Lists:
    """A description as C takes it. Everything lives as long as this."""

    def __init__(self, rig: Rig, variables: Sequence[str]) -> None:
        self._rig = rig
        self._raw_count = rig.count(Kind.RAW_CONTROL)
        self._variables = {name: self._raw_count + i for i, name in enumerate(variables)}
        self.curve_count = self._raw_count + len(variables)
        self._held: List[Any] = []
        self.poses: List[Any] = []

    def curve(self, curve: Curve) -> int:
        if isinstance(curve, str):
            found = self._variables.get(curve)
            return self._rig.raw_control(curve) if found is None else found
        number = index(curve)
        if not 0 <= number < self.curve_count:
            raise OutOfRangeError(f"curve {number} of {self.curve_count}", Status.INDEX)
        return number

    def floats(self, values: Any, what: str) -> Tuple[Optional[int], int]:
        held, count, address = floats_of(values, what)
        self._held.append(held)
        return address, count

    def curves(self, curves: Iterable[Curve]) -> Any:
        numbers = [self.curve(curve) for curve in curves]
        list_of_curves = (ctypes.c_uint16 * len(numbers))(*numbers)
        self._held.append(list_of_curves)
        return ctypes.cast(list_of_curves, ctypes.c_void_p)

    def add_pose(self, pose: Pose) -> int:
        values, count = self.floats([float(v) for v in pose.values()], "a pose")
        self.poses.append(_api.MienMixPose(curves=self.curves(pose), values=values, count=count))
        return len(self.poses) - 1

    def mask(self, mask: Any) -> Tuple[Optional[int], int]:
        if mask is None:
            return None, 0
        if isinstance(mask, (str, bytes)):
            raise TypeError("a mask is a mapping, a list of names or an array, not a string")
        names = isinstance(mask, Mapping) or any(isinstance(curve, str) for curve in mask)
        if not names:
            return self.floats(mask, "mask")
        weights = [0.0] * self.curve_count
        for curve in mask:
            weights[self.curve(curve)] = float(mask[curve]) if isinstance(mask, Mapping) else 1.0
        return self.floats(weights, "mask")

    def limit(self, limit: Any) -> Optional[int]:
        values = limit if hasattr(limit, "__len__") else [limit] * self.curve_count
        return self.floats(full(values, self.curve_count, "a limit"), "a limit")[0]

    def layer(self, from_: MixLayer) -> Any:
        mask, mask_count = self.mask(from_.mask)
        to = _api.MienMixLayer(
            period=index(from_.period), delay=index(from_.delay), mask=mask,
            mask_count=mask_count, group=uint32(from_.group, "group"),
            mode=uint32(from_.mode, "mode"), source=uint32(from_.source, "source"),
            after_guards=bool(from_.after_guards), weight=from_.weight,
            first_pose=len(self.poses), pose_count=len(from_.bank),
            generator=uint32(from_.kind, "kind"), stream_frames=uint32(from_.frames, "frames"))
        for pose in from_.bank:
            self.add_pose(pose)
        if from_.curves:
            to.curves, to.curve_count = self.curves(from_.curves), len(from_.curves)
        if from_.amounts:
            to.amounts = self.floats([float(a) for a in from_.amounts], "amounts")[0]
        return to

    def landmark(self, from_: Landmark) -> Any:
        points = (ctypes.c_uint32 * len(from_.points))(
            *(uint32(point, "point") for point in from_.points))
        self._held.append(points)
        return _api.MienLandmark(
            points=ctypes.cast(points, ctypes.c_void_p), point_count=len(points),
            mesh=_api.MIEN_NO_MESH if from_.mesh is None else uint32(from_.mesh, "mesh"))

    def guard(self, from_: CustomGuard) -> Any:
        closed_by = from_.closed_by if from_.closed_by == NO_CONTROL else self.curve(from_.closed_by)
        return _api.MienMixGuard(
            upper=self.landmark(from_.upper), lower=self.landmark(from_.lower),
            closed_by=closed_by, needs_speech=bool(from_.needs_speech),
            tolerance=from_.tolerance, f_on=from_.f_on)

    def reaction(self, from_: Reaction) -> Any:
        strokes = self.array(_api.MienMixStroke, [_api.MienMixStroke(
            delay=index(s.delay), attack=index(s.attack), hold=index(s.hold),
            release=index(s.release), pose=self.add_pose(s.pose), mode=uint32(s.mode, "mode"),
            is_held=bool(s.is_held), is_lag=bool(s.is_lag),
            is_scaled=bool(s.is_scaled)) for s in from_.strokes])
        return _api.MienMixReaction(
            cooldown=index(from_.cooldown), adapt_ticks=index(from_.adapt_ticks),
            recover_ticks=index(from_.recover_ticks), strokes=strokes,
            stroke_count=len(from_.strokes), retrigger=uint32(from_.retrigger, "retrigger"),
            after_guards=bool(from_.after_guards), adapted=from_.adapted,
            level_on=from_.level_on, level_off=from_.level_off)

    def array(self, kind: Any, items: Sequence[Any]) -> Any:
        array = (kind * len(items))(*items)
        self._held.append(array)
        return ctypes.cast(array, ctypes.POINTER(kind))


def full(values: Any, count: int, what: str) -> Any:
    if len(values) != count:
        raise ArgumentError(f"{what} takes one value for each of {count} curves, not {len(values)}")
    return values
