# SPDX-License-Identifier: MIT
"""Instances: one character each, its controls and what its last evaluation gave."""
from __future__ import annotations

import ctypes
from _thread import allocate_lock
from contextlib import contextmanager
from operator import index
from typing import Any, Callable, Dict, Iterator, List, Mapping, NoReturn, Optional

from . import _api
from ._api import InstanceStatistics, Kind, MienError, Stage, Status
from ._library import lib
from ._memory import Closable, Floats, InstanceHandle, array_over, assign, uint32
from .errors import BusyError, OutOfRangeError, UnknownNameError, fail, raises
from .rig_view import RigView

_byref = ctypes.byref
_evaluate = lib.mien_rig_evaluate
_evaluate_stages = lib.mien_rig_evaluate_stages


class Instance(Closable):
    """One character of a rig. For one thread at a time: a second one gets a BusyError.

        face["CTRL_expressions.jawOpen"] = 1.0
        face.evaluate()
        face.joints[3, :3]     # translation of joint 3, as a change of the neutral pose

    Inputs and outputs are NumPy arrays of float32 over the character's own memory: nothing is
    copied, each array stays the same object, and evaluation changes what it shows. Inputs are
    written in place, or as a whole by assigning; outputs cannot be written. An array keeps the
    memory alive: after `close()` it shows the last values, while everything else here raises
    ClosedError. Without NumPy they are flat memoryviews.
    """

    __slots__ = ("rig", "_lod_count", "_views", "_lock")

    @raises("mien_instance_create")
    def __init__(self, rig: RigView, _slab: Any = None, _lock: Any = None) -> None:
        handle, error = InstanceHandle(), MienError()
        handle.slab = _slab
        desc = _api.MienInstanceDesc()
        if _slab is not None:
            desc.allocator = ctypes.pointer(_slab.allocator)
        made_for = rig._open()
        handle.baked = made_for.baked
        status = lib.mien_instance_create(made_for, _byref(desc), _byref(handle), _byref(error))
        if status:
            fail(status, "cannot make an instance", error)
        self._handle = handle
        self.rig = rig
        self._lod_count = rig.lod_count
        self._views: Dict[str, Any] = {}
        self._lock = _lock or allocate_lock()

    def close(self) -> None:
        """Gives up the memory as soon as no array looks into it any more. May be called twice."""
        self._handle = None
        self._views = {}

    # ---- inputs --------------------------------------------------------------------------------

    def _view(self, call: Any, writable: bool = False, width: int = 0) -> Any:
        found = self._views.get(call.__name__)
        if found is not None:
            return found
        handle = self._open()
        view = _api.MienMutableFloatView() if writable else _api.MienFloatView()
        status = call(handle, _byref(view))
        if status:
            fail(status, call.__name__)
        shape = (view.count // width, width) if width else None
        found = array_over(handle, view.data, view.count, "f", writable, shape)
        self._views[call.__name__] = found
        return found

    @property
    def gui_controls(self) -> Floats:
        """float32 (GUI controls,), writable: what animators move; read by `map_gui_to_raw`."""
        return self._view(lib.mien_instance_gui_controls, True)

    @gui_controls.setter
    def gui_controls(self, values: Any) -> None:
        assign(self.gui_controls, values, "gui_controls")

    @property
    def raw_controls(self) -> Floats:
        """float32 (raw controls,), writable: usually in 0 ... 1, but not clamped."""
        return self._view(lib.mien_instance_raw_controls, True)

    @raw_controls.setter
    def raw_controls(self, values: Any) -> None:
        assign(self.raw_controls, values, "raw_controls")

    @property
    def ml_masks(self) -> Floats:
        """float32 (regions,), writable: 0 ... 1 blends or switches what was learned: `MlMasks`."""
        return self._view(lib.mien_instance_ml_masks, True)

    @ml_masks.setter
    def ml_masks(self, values: Any) -> None:
        assign(self.ml_masks, values, "ml_masks")

    # The raw controls by name, as a mapping: face["jawOpen"], "jawOpen" in face, dict(face).

    def __getitem__(self, name: str) -> float:
        """Value of the raw control of this name."""
        return float(self.raw_controls[self.rig.raw_control(name)])

    def __setitem__(self, name: str, value: float) -> None:
        if value is None or isinstance(value, str):
            raise TypeError(f"{name} takes a number, not {value!r}")
        self.raw_controls[self.rig.raw_control(name)] = value

    def __contains__(self, name: object) -> bool:
        if not isinstance(name, str):
            return False
        try:
            self.rig.raw_control(name)
        except UnknownNameError:
            return False
        return True

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __len__(self) -> int:
        return len(self.raw_controls)

    def keys(self) -> List[str]:
        """Names of the raw controls, by index."""
        return self.rig.names(Kind.RAW_CONTROL)

    def update(self, values: Mapping[str, float]) -> None:
        """Sets several raw controls by name; all or, if a name or value is wrong, none."""
        numbers = [(self.rig.raw_control(name), float(value)) for name, value in values.items()]
        controls = self.raw_controls
        for i, number in numbers:
            controls[i] = number

    # ---- outputs -------------------------------------------------------------------------------

    @property
    def controls(self) -> Floats:
        """float32 (controls,): the whole control vector: raw, PSD, ML, RBF."""
        return self._view(lib.mien_instance_controls)

    @property
    def psd_controls(self) -> Floats:
        """float32 (correctives,)."""
        return self._view(lib.mien_instance_psd_controls)

    @property
    def ml_controls(self) -> Floats:
        """float32 (ML controls,): what the neural networks gave."""
        return self._view(lib.mien_instance_ml_controls)

    @property
    def rbf_controls(self) -> Floats:
        """float32 (RBF controls,): weights of the poses of the RBF solvers."""
        return self._view(lib.mien_instance_rbf_controls)

    @property
    def joints(self) -> Floats:
        """float32 (joints, 9): tx ty tz rx ry rz sx sy sz, or (joints, 10) with qx qy qz qw.

        Changes of the neutral pose (`Rig.neutral_joint_values`), in the units that `Rig.info`
        tells. Translation, angles and scale are added to it; a quaternion is its right factor:
        neutral * delta, so that the delta turns first.
        """
        return self._view(lib.mien_instance_joints, width=self.rig.joint_width)

    @property
    def blend_shapes(self) -> Floats:
        """float32 (channels,): one weight per blend shape channel."""
        return self._view(lib.mien_instance_blend_shapes)

    @property
    def animated_maps(self) -> Floats:
        """float32 (maps,): one weight per animated map, 0 ... 1."""
        return self._view(lib.mien_instance_animated_maps)

    def statistics(self) -> InstanceStatistics:
        """What the joint stage reads for the current controls."""
        found = _api.MienInstanceStatistics()
        status = lib.mien_instance_statistics(self._open(), _byref(found))
        if status:
            fail(status, "statistics")
        return InstanceStatistics._of(found)

    # ---- evaluation ----------------------------------------------------------------------------

    @raises("mien_rig_evaluate_stages", but=(Status.MISMATCH,))
    def evaluate(self, lod: int = 0, stages: int = Stage.ALL) -> None:
        """Computes the outputs at a LOD; outputs that the LOD does not reach are 0.

        `stages` limits it to some `Stage`s; the others keep the results of the last evaluation at
        the same LOD. Other Python threads run meanwhile.
        """
        if not self._lock.acquire(False):
            self._busy()
        try:
            # Numbers outside the range are refused here, since ctypes would cut them to 32 bits.
            if type(lod) is not int or not 0 <= lod < self._lod_count:
                lod = self._lod(lod)
            if stages is _ALL:
                status = _evaluate(self.rig._handle, self._handle, lod)
            else:
                status = _evaluate_stages(self.rig._handle, self._handle, lod,
                                          uint32(stages, "stages"))
            if status:
                self._fail(status, f"evaluate(lod={lod}, stages={stages!r})")
        finally:
            self._lock.release()

    def map_gui_to_raw(self) -> None:
        """Raw controls from GUI controls, clamped to 0 ... 1; those that no GUI control drives
        keep what they hold."""
        self._call(lib.mien_rig_map_gui_to_raw)

    def map_raw_to_gui(self) -> None:
        """Each GUI control's value whose mapping gives the raw controls; 0 where there is none."""
        self._call(lib.mien_rig_map_raw_to_gui)

    @raises("mien_rig_evaluate_joint_group", but=(Status.MISMATCH,))
    def evaluate_joint_group(self, group: int, lod: int = 0) -> None:
        """Only the joint values of one joint group (`Kind.JOINT_GROUP`)."""
        self._call(lib.mien_rig_evaluate_joint_group, self._lod(lod), uint32(group, "group"))

    @raises("mien_rig_evaluate_rbf_solver", but=(Status.MISMATCH,))
    def evaluate_rbf_solver(self, solver: int, lod: int = 0) -> None:
        """Only the pose controls of one RBF solver, whether the LOD lists it or not."""
        self._call(lib.mien_rig_evaluate_rbf_solver, self._lod(lod), uint32(solver, "solver"))

    @raises("mien_rig_evaluate_twist_swing", but=(Status.MISMATCH,))
    def evaluate_twist_swing(self, setup: int, lod: int = 0) -> None:
        """Only the joints of one twist and swing set-up (`Kind.TWIST_SWING`)."""
        self._call(lib.mien_rig_evaluate_twist_swing, self._lod(lod), uint32(setup, "setup"))

    def reset(self) -> None:
        """Resets everything to the initial state."""
        if not self._lock.acquire(False):
            self._busy()
        try:
            status = lib.mien_instance_reset(self._handle)
            if status:
                self._fail(status, "reset()")
        finally:
            self._lock.release()

    @contextmanager
    def _alone(self) -> Iterator[Any]:
        """The handle, for this thread."""
        if not self._lock.acquire(False):
            self._busy()
        try:
            yield self._open()
        finally:
            self._lock.release()

    def _call(self, function: Callable[..., int], *arguments: int) -> None:
        if not self._lock.acquire(False):
            self._busy()
        try:
            status = function(self.rig._handle, self._handle, *arguments)
            if status:
                self._fail(status, f"{function.__name__}{arguments}")
        finally:
            self._lock.release()

    def _lod(self, lod: Any) -> int:
        number = index(lod)
        if not 0 <= number < self._lod_count:
            raise OutOfRangeError(f"LOD {number} of a rig with {self._lod_count}", Status.LOD)
        return number

    def _busy(self) -> NoReturn:
        raise BusyError("another thread is working with this instance; each thread needs its own",
                        Status.HANDLE)

    def _fail(self, status: int, what: str) -> NoReturn:
        self._open()
        self.rig._open()
        fail(status, what)

    def __repr__(self) -> str:
        return f"<mien.Instance{', closed' if self.closed else ''} of {self.rig!r}>"


_ALL = Stage.ALL
