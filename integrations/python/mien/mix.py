# SPDX-License-Identifier: MIT
"""Mixes: layers of clips, poses, streams and generators, reactions and guards, for one rig."""
from __future__ import annotations

import ctypes
from operator import index
from typing import (Any, Dict, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Tuple,
                    Union)

from . import _api
from ._api import (BlendMode, Generator, Kind, LayerGroup, LayerSource, MienError, MixInfo,
                   Retrigger, Status)
from ._library import lib
from ._memory import (Closable, GazeHandle, MixHandle, floats_of, new_array, terminated,
                      uint32)
from .clip import TICKS_PER_SECOND
from .deformer import Deformer
from .errors import ArgumentError, OutOfRangeError, UnknownNameError, fail, raises
from .instance import Instance
from .rig import Rig

_byref = ctypes.byref

#: A raw control or pose variable: its name, or its number among the lanes.
Lane = Union[str, int]
#: Values of the lanes that a pose moves: {"mouthSmileLeft": 0.8}.
Pose = Mapping[Lane, float]


def ticks(seconds: float) -> int:
    """Seconds in the unit of all times."""
    return round(seconds * TICKS_PER_SECOND)


class MixLayer(NamedTuple):
    """A layer of a mix. Make it with `clip`, `poses`, `stream` or `generator`.

    mask: weights of lanes, 0 to 1: {"jawOpen": 0.5} or names alone for 1, others are 0; or an array
          with one weight per lane. None: 1 for all
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
    lanes: Sequence[Lane] = ()
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
    def stream(cls, channels: Iterable[Lane], group: int = LayerGroup.BASE,
               mode: int = BlendMode.OVERRIDE, weight: float = 1.0, mask: Any = None,
               after_guards: bool = False, delay: int = 0, frames: int = 0) -> MixLayer:
        """Rows that arrive from outside, one value for each of these lanes: `Mixer.push`.

        delay:  ticks by which rows are played later than their times, which hides jitter
        frames: most rows that can be queued; 0 means 64
        """
        return cls(LayerSource.STREAM, group, mode, weight, mask, after_guards,
                   lanes=tuple(channels), delay=delay, frames=frames)

    @classmethod
    def generator(cls, kind: int, lanes: Mapping[Lane, float], period: int,
                  group: int = LayerGroup.LIFE, mode: int = BlendMode.ADD, weight: float = 1.0,
                  mask: Any = None, after_guards: bool = False) -> MixLayer:
        """Blinks, breath or noise (`Generator`) for lanes with amounts; `period` in ticks."""
        return cls(LayerSource.GENERATOR, group, mode, weight, mask, after_guards,
                   lanes=tuple(lanes), amounts=tuple(lanes.values()), kind=kind, period=period)

    @classmethod
    def gaze(cls, target: Sequence[Lane], head: Mapping[Lane, float] = {},
             jitter: Tuple[float, float] = (0.0, 0.0), period: int = TICKS_PER_SECOND // 4,
             group: int = LayerGroup.LIFE, weight: float = 1.0) -> MixLayer:
        """Turns the eyes to a place, by the `gaze` of the mix.

        target: three lanes, usually pose variables: millimeters to the left, up and to the front
        head:   two lanes with factors, which get what is left for the head
        jitter: degrees of fixation across and up; `period` is its time
        """
        return cls(LayerSource.GENERATOR, group, BlendMode.OVERRIDE, weight,
                   lanes=(*target, *head), amounts=(*jitter, 0.0, *head.values()),
                   kind=Generator.GAZE, period=period)


class Stroke(NamedTuple):
    """A part of a reaction: moves lanes to a pose and back. Times are in ticks.

    is_held: holds as long as the stimulus lasts, instead of for `hold`
    is_lag:  moves exponentially; attack and release are time constants
    """

    pose: Pose
    mode: int = BlendMode.OVERRIDE
    delay: int = 0
    attack: int = 0
    hold: int = 0
    release: int = 0
    is_held: bool = False
    is_lag: bool = False


class Reaction(NamedTuple):
    """What a face does in response to a stimulus: `Mixer.trigger`.

    cooldown: ticks; shortest time between two starts of strokes that are not held
    adapted:  share of the strength that remains while the stimulus lasts
    adapt_ticks, recover_ticks: time constants of that and of recovering
    """

    strokes: Sequence[Stroke]
    retrigger: int = Retrigger.EXTEND
    cooldown: int = 0
    adapted: float = 1.0
    adapt_ticks: int = 0
    recover_ticks: int = 0
    after_guards: bool = False


class Antagonists(NamedTuple):
    """Two lanes that move the face in opposite directions."""

    first: int
    second: int
    stiffness: float = 1.0


#: No raw control: what a `CustomGuard` measures touches at rest.
NO_CONTROL: int = _api.MIEN_NO_CONTROL


class Landmark(NamedTuple):
    """A place of a face: the middle of some positions of a mesh that LOD 0 shows, or of some joints
    (mesh None)."""

    points: Sequence[int]
    mesh: Optional[int] = None


class CustomGuard(NamedTuple):
    """A guard for landmarks of yours: the distance of `upper` above `lower` must not be opened.

    closed_by: raw control that makes both touch at 1; NO_CONTROL: they do at rest
    tolerance: millimeters by which later layers may open
    f_on:      acts where base and speech open by less millimeters
    """

    upper: Landmark
    lower: Landmark
    closed_by: Lane = NO_CONTROL
    needs_speech: bool = False
    tolerance: float = 0.3
    f_on: float = 12.0


class GuardInfo(NamedTuple):
    """A guard as it was measured: millimeters = rest + sum of gain * lane + pairs of lanes.

    fit_error: millimeters, root mean square over rows that were tried
    """

    lanes: List[int]
    gains: List[float]
    pair_count: int
    rest: float
    needs_speech: bool
    tolerance: float
    f_on: float
    fit_error: float


@raises("mien_mix_glare")
def glare(poses: Sequence[Pose]) -> Reaction:
    """A response to a light in the eyes. Its five poses: lids closed; squint and lowered brows; gaze
    turned away; narrow pupils; head turned away. An empty one leaves its part out."""
    if len(poses) != 5:
        raise ArgumentError(f"{len(poses)} poses: a glare takes 5")
    strokes, reaction = (_api.MienMixStroke * 5)(), _api.MienMixReaction()
    status = lib.mien_mix_glare(0, strokes, len(strokes), _byref(reaction))
    if status:
        fail(status, "no glare")
    return Reaction(
        [Stroke(poses[s.pose], s.mode, s.delay, s.attack, s.hold, s.release, bool(s.is_held),
                bool(s.is_lag)) for s in strokes],
        reaction.retrigger, reaction.cooldown, reaction.adapted, reaction.adapt_ticks,
        reaction.recover_ticks, bool(reaction.after_guards))


class _Lists:
    """A description as C takes it. Everything lives as long as this."""

    def __init__(self, rig: Rig, variables: Sequence[str]) -> None:
        self._rig = rig
        self._raw_count = rig.count(Kind.RAW_CONTROL)
        self._variables = {name: self._raw_count + i for i, name in enumerate(variables)}
        self.lane_count = self._raw_count + len(variables)
        self._held: List[Any] = []
        self.poses: List[Any] = []

    def lane(self, lane: Lane) -> int:
        if isinstance(lane, str):
            found = self._variables.get(lane)
            return self._rig.raw_control(lane) if found is None else found
        number = index(lane)
        if not 0 <= number < self.lane_count:
            raise OutOfRangeError(f"lane {number} of {self.lane_count}", Status.INDEX)
        return number

    def floats(self, values: Any, what: str) -> Tuple[Optional[int], int]:
        held, count, address = floats_of(values, what)
        self._held.append(held)
        return address, count

    def lanes(self, lanes: Iterable[Lane]) -> Any:
        numbers = [self.lane(lane) for lane in lanes]
        list_of_lanes = (ctypes.c_uint16 * len(numbers))(*numbers)
        self._held.append(list_of_lanes)
        return ctypes.cast(list_of_lanes, ctypes.c_void_p)

    def add_pose(self, pose: Pose) -> int:
        values, count = self.floats([float(v) for v in pose.values()], "a pose")
        self.poses.append(_api.MienMixPose(lanes=self.lanes(pose), values=values, count=count))
        return len(self.poses) - 1

    def mask(self, mask: Any) -> Tuple[Optional[int], int]:
        if mask is None:
            return None, 0
        if isinstance(mask, (str, bytes)):
            raise TypeError("a mask is a mapping, a list of names or an array, not a string")
        names = isinstance(mask, Mapping) or any(isinstance(lane, str) for lane in mask)
        if not names:
            return self.floats(mask, "mask")
        weights = [0.0] * self.lane_count
        for lane in mask:
            weights[self.lane(lane)] = float(mask[lane]) if isinstance(mask, Mapping) else 1.0
        return self.floats(weights, "mask")

    def limit(self, limit: Any) -> Optional[int]:
        values = limit if hasattr(limit, "__len__") else [limit] * self.lane_count
        return self.floats(_full(values, self.lane_count, "a limit"), "a limit")[0]

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
        if from_.lanes:
            to.lanes, to.lane_count = self.lanes(from_.lanes), len(from_.lanes)
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
        closed_by = from_.closed_by if from_.closed_by == NO_CONTROL else self.lane(from_.closed_by)
        return _api.MienMixGuard(
            upper=self.landmark(from_.upper), lower=self.landmark(from_.lower),
            closed_by=closed_by, needs_speech=bool(from_.needs_speech),
            tolerance=from_.tolerance, f_on=from_.f_on)

    def reaction(self, from_: Reaction) -> Any:
        strokes = self.array(_api.MienMixStroke, [_api.MienMixStroke(
            delay=index(s.delay), attack=index(s.attack), hold=index(s.hold),
            release=index(s.release), pose=self.add_pose(s.pose), mode=uint32(s.mode, "mode"),
            is_held=bool(s.is_held), is_lag=bool(s.is_lag)) for s in from_.strokes])
        return _api.MienMixReaction(
            cooldown=index(from_.cooldown), adapt_ticks=index(from_.adapt_ticks),
            recover_ticks=index(from_.recover_ticks), strokes=strokes,
            stroke_count=len(from_.strokes), retrigger=uint32(from_.retrigger, "retrigger"),
            after_guards=bool(from_.after_guards), adapted=from_.adapted)

    def array(self, kind: Any, items: Sequence[Any]) -> Any:
        array = (kind * len(items))(*items)
        self._held.append(array)
        return ctypes.cast(array, ctypes.POINTER(kind))


class Mix(Closable):
    """What is mixed for one rig, and how. Immutable: any number of threads may use it.

        mix = mien.Mix(rig, [
            mien.MixLayer.clip(mien.LayerGroup.SPEECH),
            mien.MixLayer.poses([{"mouthSmileLeft": 0.9, "mouthSmileRight": 0.9}]),
        ], guards=mien.Guard.LIPS, deformer=deformer)
        mixer = mix.mixer()                       # one character
        mixer.play(0, clip, clip.bind(rig))
        mixer.set_pose_weight(1, 0, 0.7, mien.ticks(0.4))
        mixer.step(mien.ticks(1 / 60), face)      # then face.evaluate()

    variables:   names of pose variables, lanes behind the raw controls
    antagonists: such as `Mix.find_antagonists(rig)`
    mirror:      per lane its counterpart, such as of `Mix.find_mirror(deformer)`; None: nothing can
                 be played mirrored
    limits:      (lower, upper), one number for all lanes or one for each; None: none
    guards:      `Guard` bits; measured on `deformer`, which takes time
    custom_guards: more of them, for landmarks of yours
    gaze:        for a layer of `MixLayer.gaze`
    """

    __slots__ = ("info", "variables")

    @raises("mien_mix_create")
    def __init__(self, rig: Rig, layers: Iterable[MixLayer], reactions: Iterable[Reaction] = (),
                 guards: int = 0, deformer: Optional[Deformer] = None,
                 custom_guards: Iterable[CustomGuard] = (), gaze: Optional[Gaze] = None,
                 variables: Sequence[str] = (), antagonists: Iterable[Antagonists] = (),
                 mirror: Optional[Sequence[int]] = None,
                 limits: Optional[Tuple[Any, Any]] = None, players: int = 0,
                 max_channels: int = 0, max_changing_channels: int = 0, max_events: int = 0,
                 reverse: bool = False) -> None:
        lists = _Lists(rig, variables)
        layer_list = [lists.layer(layer) for layer in layers]
        reaction_list = [lists.reaction(reaction) for reaction in reactions]
        pairs = [_api.MienMixAntagonists(first=lists.lane(a), second=lists.lane(b),
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
            desc.mirror = lists.lanes(_full(list(mirror), lists.lane_count, "mirror"))
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

    def _take(self, handle: MixHandle, variables: Sequence[str]) -> None:
        self._handle = handle
        found = _api.MienMixInfo()
        status = lib.mien_mix_info(handle, _byref(found))
        if status:
            fail(status, "no info")
        self.info: MixInfo = MixInfo._of(found)
        self.variables: Dict[str, int] = {name: i for i, name in enumerate(variables)}

    @raises("mien_mix_guard")
    def guard(self, guard: int) -> GuardInfo:
        """A guard, by its number from 0 on."""
        g = _api.MienMixGuardInfo()
        handle = self._open()
        status = lib.mien_mix_guard(handle, uint32(guard, "guard"), _byref(g))
        if status:
            fail(status, f"guard {guard} of {self.info.guard_count}")
        count = g.lanes.count
        lanes = list((ctypes.c_uint16 * count).from_address(g.lanes.data)) if count else []
        gains = list((ctypes.c_float * count).from_address(g.gains.data)) if count else []
        return GuardInfo(lanes, gains, g.pair_count, g.rest,
                         bool(g.needs_speech), g.tolerance, g.f_on, g.fit_error)

    def variable(self, variable: Lane) -> int:
        """Number of a pose variable."""
        if not isinstance(variable, str):
            return uint32(variable, "variable")
        if variable not in self.variables:
            raise UnknownNameError(f"there is no pose variable {variable!r}", Status.NAME)
        return self.variables[variable]

    def mixer(self, seed: int = 0, stages: bool = False) -> Any:
        """A new character, as a `Mixer`. seed: of generators; stages: for `Mixer.stage`."""
        from .mixer import Mixer
        return Mixer(self, seed, stages)

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
    def find_mirror(deformer: Deformer, lane_count: int) -> List[int]:
        """For each lane its counterpart in the other half of the face, or itself."""
        lanes, error = (ctypes.c_uint16 * index(lane_count))(), MienError()
        status = lib.mien_mix_mirror(deformer._open(), lanes, len(lanes), _byref(error))
        if status:
            fail(status, "no mirror map", error)
        return list(lanes)

    @staticmethod
    @raises("mien_mix_mask")
    def find_mask(rig: Rig, groups: Iterable[int], lane_count: int, otherwise: float = 0.0) -> Any:
        """For each raw control the share of its joint motion that is of some joint groups, float32;
        `otherwise` for those that move no joint, and for pose variables."""
        numbers = [uint32(group, "group") for group in groups]
        list_of_groups = (ctypes.c_uint32 * len(numbers))(*numbers)
        values, address = new_array("f", index(lane_count))
        error = MienError()
        status = lib.mien_mix_mask(rig._open(), list_of_groups, len(numbers), otherwise, address,
                                   index(lane_count), _byref(error))
        if status:
            fail(status, "no mask", error)
        return values


def _full(values: Any, count: int, what: str) -> Any:
    if len(values) != count:
        raise ArgumentError(f"{what} takes one value for each of {count} lanes, not {len(values)}")
    return values


class Gaze(Closable):
    """Which raw controls turn the eyes of a rig, and how far. Immutable: any number of threads may
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

    @raises("mien_gaze_look_at")
    def look_at(self, target: Tuple[float, float, float],
                instance: Instance) -> Tuple[float, float]:
        """Sets the raw controls of an `Instance` so that both eyes look at a place: millimeters to
        the left, up and to the front, in the model space of the rig before its head moves. Returns
        what is beyond the reach of the eyes, for the head to turn: tangents of angles to the left and up."""
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
