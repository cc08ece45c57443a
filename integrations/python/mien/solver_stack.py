# SPDX-License-Identifier: MIT
"""Solvers, which move joints after the rig has posed them."""
from __future__ import annotations

import ctypes
from _thread import allocate_lock
from contextlib import ExitStack, contextmanager
from operator import index
from threading import local
from typing import Any, Callable, Iterable, Iterator, List, NamedTuple, Optional, Sequence, Tuple, Union

from . import _api
from ._api import MienError, SolverStackInfo, Status, text
from ._library import lib
from ._memory import (Closable, Floats, SolverStackHandle, SolverStateHandle, array_over, floats_of,
                      lod_bits, terminated, uint32)
from .clip import _int
from .deformer import Deformer, DeformerInstance
from .errors import ArgumentError, BusyError, fail, raises

_byref = ctypes.byref
Vector = Tuple[float, float, float]

#: No joint: model space, or a target at curves of the row.
NO_JOINT: int = _api.MIEN_NO_JOINT
_ZERO: Vector = (0.0, 0.0, 0.0)


class AimSolver(NamedTuple):
    """Turns a joint so that one of its axes points at a joint, or at three curves of the row.

    up_axis, up:  of the joint, and where to turn it in model space as far as possible
    cone_degrees: largest angle from the neutral direction; 0 is no limit
    lods:         at which it runs; None: at all
    """

    joint: int
    axis: Vector
    target_joint: int = NO_JOINT
    target_curve: int = 0
    up_axis: Vector = _ZERO
    up: Vector = _ZERO
    cone_degrees: float = 0.0
    weight: float = 1.0
    lods: Optional[Sequence[int]] = None


class SpaceSolver(NamedTuple):
    """Space switch: moves a joint as if its parent were attached to one of some joints, selected by a
    curve of the row."""

    joint: int
    spaces: Sequence[int]
    curve: int
    ease_ticks: int = 0
    lods: Optional[Sequence[int]] = None


class SpringSolver(NamedTuple):
    """Lets the position of a joint swing about its position in the pose. Output 0 is its speed.

    damping:  damping ratio; 1 is critical damping
    stretch:  largest distance from the rest position; 0 is no limit
    teleport: if the rest position jumps farther in a step, the joint jumps with it; 0 is never
    """

    joint: int
    frequency: float
    damping: float
    rest_offset: Vector = _ZERO
    stretch: float = 0.0
    teleport: float = 0.0
    lods: Optional[Sequence[int]] = None


class TwistSolver(NamedTuple):
    """Gives joints a share of the twist of another joint. Output 0 is the sine of half the angle."""

    source: int
    axis: Vector
    joints: Sequence[int]
    shares: Sequence[float]
    lods: Optional[Sequence[int]] = None


class CopySolver(NamedTuple):
    """Gives a joint the motion of another joint, or the mirrored motion."""

    source: int
    joint: int
    is_mirrored: bool = False
    mirror_axis: Vector = _ZERO
    weight: float = 1.0
    lods: Optional[Sequence[int]] = None


class SolverPose(NamedTuple):
    """The data of one character for a custom solver; arrays of its own memory.

    locals:   float32 (joints, 10), writable: tx ty tz qx qy qz qw sx sy sz
    models:   float32 (joints, 16): columns of the model matrices
    previous: float32 (previous joints, 16), after the last step
    row:      float32 (curves,)
    outputs:  float32 (outputs,), writable
    state:    float32 (state floats,), writable; zeros at first
    """

    locals: Any
    models: Any
    previous: Any
    row: Any
    outputs: Any
    state: Any
    lod: int
    is_reset: bool


class CustomSolver(NamedTuple):
    """Your own function: solve(poses, ticks) changes `locals` of the joints that it `writes`.
    Exceptions are raised by the step."""

    solve: Callable[[List[SolverPose], int], None]
    writes: Sequence[int]
    reads: Sequence[int] = ()
    previous_joints: Sequence[int] = ()
    state_floats: int = 0
    output_count: int = 0
    name: str = "custom"
    lods: Optional[Sequence[int]] = None


Solver = Union[AimSolver, SpaceSolver, SpringSolver, TwistSolver, CopySolver, CustomSolver]


class _Function:
    """A custom solver as the library calls it."""

    def __init__(self, solver: CustomSolver, curve_count: int) -> None:
        # As numbers: the lists of the description may change, the memory of the states does not.
        self._solve, self._curve_count = solver.solve, curve_count
        self._previous_count = len(solver.previous_joints)
        self._output_count = uint32(solver.output_count, "output_count")
        self._state_floats = uint32(solver.state_floats, "state_floats")
        kind: Any = dict(_api.MienUserSolver._fields_)["solve"]
        self.c = kind(self._call)

    def _call(self, user: Any, call: Any) -> None:
        steps = _current.steps
        try:
            c = call.contents
            poses = [self._pose(c.poses[i], c.joint_count, steps[-1]) for i in range(c.pose_count)]
            self._solve(poses, c.ticks)
        except BaseException as raised:  # must not cross the library
            steps[-1].raised = steps[-1].raised or raised

    def _pose(self, pose: Any, joints: int, owner: Any) -> SolverPose:
        def over(field: Any, count: int, writable: bool, width: int = 0) -> Any:
            address = ctypes.cast(field, ctypes.c_void_p).value
            shape = (count // width, width) if width else None
            return array_over(owner, address, count if address else 0, "f", writable, shape)

        return SolverPose(over(pose.locals, joints * 10, True, 10),
                          over(pose.models, joints * 16, False, 16),
                          over(pose.previous, self._previous_count * 16, False, 16),
                          over(pose.row, self._curve_count, False),
                          over(pose.outputs, self._output_count, True),
                          over(pose.state, self._state_floats, True), pose.lod, bool(pose.is_reset))


class _Step:
    """One step: what its arrays look into, and what a solver raised."""

    def __init__(self, owners: Any) -> None:
        self.owners = owners
        self.raised: Optional[BaseException] = None


class _Current(local):
    """Steps that are under way on this thread."""

    def __init__(self) -> None:
        self.steps: List[_Step] = []


_current = _Current()


class _Lists:
    """Solvers as C takes them. Everything lives as long as this."""

    def __init__(self, curve_count: int) -> None:
        self._curve_count = curve_count
        self._held: List[Any] = []
        self.functions: List[_Function] = []

    def _joints(self, joints: Sequence[int]) -> Any:
        for joint in joints:
            if not 0 <= joint <= 0xFFFF:
                raise ArgumentError(f"joint {joint}: not in 0 ... 65535")
        found = (ctypes.c_uint16 * len(joints))(*joints)
        self._held.append(found)
        return ctypes.cast(found, ctypes.c_void_p) if joints else None

    def _floats(self, values: Sequence[float]) -> Any:
        held, _, address = floats_of([float(value) for value in values], "shares")
        self._held.append(held)
        return address

    def solver(self, s: Solver) -> Any:
        if not isinstance(s, (AimSolver, SpaceSolver, SpringSolver, TwistSolver, CopySolver,
                              CustomSolver)):
            raise TypeError(f"{type(s).__name__} is no solver")
        to = _api.MienSolver(lods=lod_bits(s.lods))

        def point(field: str, struct: Any) -> None:
            self._held.append(struct)
            setattr(to, field, ctypes.pointer(struct))

        if isinstance(s, AimSolver):
            point("aim", _api.MienAimSolver(
                joint=uint32(s.joint, "joint"), target_joint=uint32(s.target_joint, "joint"),
                target_curve=uint32(s.target_curve, "target_curve"), axis=tuple(s.axis),
                up_axis=tuple(s.up_axis), up=tuple(s.up), cone_degrees=s.cone_degrees,
                weight=s.weight))
        elif isinstance(s, SpaceSolver):
            point("space", _api.MienSpaceSolver(
                ease_ticks=_int(s.ease_ticks, 64, "ease_ticks"), spaces=self._joints(s.spaces),
                space_count=len(s.spaces), curve=uint32(s.curve, "curve"),
                joint=uint32(s.joint, "joint")))
        elif isinstance(s, SpringSolver):
            point("spring", _api.MienSpringSolver(
                joint=uint32(s.joint, "joint"), frequency=s.frequency, damping=s.damping,
                rest_offset=tuple(s.rest_offset), stretch=s.stretch, teleport=s.teleport))
        elif isinstance(s, TwistSolver):
            if len(s.shares) != len(s.joints):
                raise ArgumentError(f"{len(s.shares)} shares for {len(s.joints)} joints")
            point("twist", _api.MienTwistSolver(
                joints=self._joints(s.joints), shares=self._floats(s.shares),
                joint_count=len(s.joints), source=uint32(s.source, "source"),
                axis=tuple(s.axis)))
        elif isinstance(s, CopySolver):
            point("copy", _api.MienCopySolver(
                source=uint32(s.source, "source"), joint=uint32(s.joint, "joint"),
                is_mirrored=bool(s.is_mirrored), mirror_axis=tuple(s.mirror_axis),
                weight=s.weight))
        else:
            function = _Function(s, self._curve_count)
            self.functions.append(function)
            name = ctypes.create_string_buffer(
                terminated(s.name.encode("utf-8", "surrogateescape"), "a name"))
            self._held.append(name)
            to.name = ctypes.cast(name, ctypes.c_void_p)
            point("custom", _api.MienUserSolver(
                solve=function.c, reads=self._joints(s.reads), writes=self._joints(s.writes),
                previous_joints=self._joints(s.previous_joints), read_count=len(s.reads),
                write_count=len(s.writes), previous_joint_count=len(s.previous_joints),
                state_bytes=uint32(4 * index(s.state_floats), "state_floats"),
                output_count=uint32(s.output_count, "output_count")))
        return to


class SolverStack(Closable):
    """Solvers of one deformer, in the order in which they run. Immutable: any number of threads may
    use it. The deformer may be closed afterwards.

        stack = mien.SolverStack(deformer, [mien.SpringSolver(joint, frequency=3, damping=0.3)])
        state = stack.state()                     # one character
        face.evaluate()
        pose.update(face)
        state.step(pose, ticks)                   # then pose.deform(mesh)

    curve_count:   of the rows that steps get, at least
    check_writes: compares all joints before and after each solver, for `SolverState.undeclared`
    """

    __slots__ = ("info",)

    @raises("mien_solver_stack_create")
    def __init__(self, deformer: Deformer, solvers: Iterable[Solver], curve_count: int = 0,
                 check_writes: bool = False) -> None:
        lists = _Lists(uint32(curve_count, "curve_count"))
        given = [lists.solver(solver) for solver in solvers]
        array = (_api.MienSolver * len(given))(*given)
        desc = _api.MienSolverStackDesc(
            solvers=ctypes.cast(array, ctypes.POINTER(_api.MienSolver)), solver_count=len(given),
            curve_count=curve_count, check_writes=bool(check_writes))
        made_for = deformer._open()
        handle, error = SolverStackHandle(), MienError()
        handle.baked, handle.functions = made_for.baked, lists.functions
        status = lib.mien_solver_stack_create(made_for, _byref(desc), _byref(handle),
                                              _byref(error))
        del array, given
        if status:
            fail(status, "cannot make a solver stack", error)
        self._handle = handle
        found = _api.MienSolverStackInfo()
        status = lib.mien_solver_stack_info(handle, _byref(found))
        if status:
            fail(status, "no info")
        self.info: SolverStackInfo = SolverStackInfo._of(found)

    def state(self) -> SolverState:
        """A new character."""
        return SolverState(self)


class SolverState(Closable):
    """The state of the solvers of one character. For one thread at a time: a second one gets a
    BusyError."""

    __slots__ = ("_lock",)

    @raises("mien_solver_state_create")
    def __init__(self, stack: SolverStack) -> None:
        desc = _api.MienSolverStateDesc()
        handle, error = SolverStateHandle(), MienError()
        handle.stack = stack._open()
        status = lib.mien_solver_state_create(stack._open(), _byref(desc), _byref(handle),
                                              _byref(error))
        if status:
            fail(status, "cannot make a solver state", error)
        self._handle = handle
        self._lock = allocate_lock()

    @contextmanager
    def _alone(self) -> Iterator[Any]:
        """The handle, for this thread."""
        if not self._lock.acquire(False):
            raise BusyError("another thread is working with this state, or it is named twice",
                            Status.HANDLE)
        try:
            yield self._open()
        finally:
            self._lock.release()

    @raises("mien_solver_state_step")
    def step(self, pose: DeformerInstance, ticks: int, row: Any = None, lod: int = 0,
             is_reset: bool = False) -> None:
        """Runs the solvers on a pose, which `update` has to set before every step.

        row:      such as `Mixer.row`
        is_reset: the character was teleported: springs come to rest
        """
        step_states([self], [pose], ticks, None if row is None else [row], lod, is_reset)

    @raises("mien_solver_state_outputs")
    def outputs(self, solver: int) -> Floats:
        """float32 (outputs,): what a solver has published. Read-only, no copy."""
        handle, view = self._open(), _api.MienFloatView()
        status = lib.mien_solver_state_outputs(handle, uint32(solver, "solver"), _byref(view))
        if status:
            fail(status, f"solver {solver}")
        return array_over(handle, view.data, view.count, "f", False)

    @property
    def transforms(self) -> Floats:
        """float32 (joints, 10) after the last step, relative to the parents: tx ty tz qx qy qz qw sx
        sy sz. Read-only, no copy."""
        handle, view = self._open(), _api.MienFloatView()
        status = lib.mien_solver_state_transforms(handle, _byref(view))
        if status:
            fail(status, "no transforms")
        return array_over(handle, view.data, view.count, "f", False, (view.count // 10, 10))

    @property
    @raises("mien_solver_state_undeclared")
    def undeclared(self) -> str:
        """With `check_writes`: the solver that changed a joint not in its `writes` in the last step, or
        an empty string."""
        handle, name = self._open(), _api.MienStringView()
        status = lib.mien_solver_state_undeclared(handle, _byref(name))
        if status:
            fail(status, "the stack was made without check_writes")
        return text(name)


@raises("mien_solver_state_step_batch")
def step_states(states: Sequence[SolverState], poses: Sequence[DeformerInstance], ticks: int,
                rows: Optional[Sequence[Any]] = None, lod: int = 0,
                is_reset: bool = False) -> None:
    """Steps states of one stack, each with its pose and row: the results of single calls."""
    if len(poses) != len(states) or (rows is not None and len(rows) != len(states)):
        raise ArgumentError(f"{len(poses)} poses and {len(rows or ())} rows for {len(states)} "
                            "states")
    held: List[Any] = []
    inputs = (_api.MienSolverInput * len(states))()
    for i, c in enumerate(inputs):
        if rows is not None:
            values, c.row_count, c.row = floats_of(rows[i], "row")
            held.append(values)
        c.lod, c.is_reset = uint32(lod, "lod"), bool(is_reset)
    with ExitStack() as stack:
        handles = [stack.enter_context(state._alone()) for state in states]
        bodies = [stack.enter_context(pose._alone()) for pose in poses]
        given = (_api.MienSolverState * len(handles))(*(handle.value for handle in handles))
        to = (_api.MienDeformerInstance * len(bodies))(*(body.value for body in bodies))
        step = _Step((handles, bodies, held))
        _current.steps.append(step)
        try:
            if len(handles) == 1:
                status = lib.mien_solver_state_step(handles[0], bodies[0], inputs,
                                                    _int(ticks, 64, "ticks"))
            else:
                status = lib.mien_solver_state_step_batch(given, to, inputs, len(handles),
                                                          _int(ticks, 64, "ticks"))
        finally:
            _current.steps.pop()
        if status:
            fail(status, f"cannot step {len(handles)} states by {ticks} ticks")
        if step.raised is not None:
            raise step.raised
