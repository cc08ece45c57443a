# SPDX-License-Identifier: MIT
"""Controls from joints, vertices and landmarks, by libmien-solve. Needs NumPy."""
from __future__ import annotations

import ctypes
from _thread import allocate_lock
from contextlib import contextmanager
from typing import Any, Callable, Iterator, List, NamedTuple, Optional, Sequence

from . import _api
from ._api import FitStatus, Kind, MienError, Status
from ._library import solver
from ._memory import Closable, FitHandle, FitSurfaceHandle, Floats, numpy, uint32
from .deformer import Deformer
from .errors import ArgumentError, BusyError, fail, raises
from .rig import Rig

_byref = ctypes.byref
_canceled_type: Any = dict(_api.MienFitFrame._fields_)["canceled"]


class FitCamera(NamedTuple):
    """A pinhole camera: image x = focal[0] * x / z + center[0] of a point in the space of the camera, where
    z grows away from it. `rotation`: 3 x 3, and `translation` lead there from the space of the rig."""

    focal: Sequence[float]
    center: Sequence[float]
    rotation: Any = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    translation: Sequence[float] = (0, 0, 0)


class FitConstraint(NamedTuple):
    """What a joint or a point is drawn to besides the other targets; places and directions in model space.

    kind:      `FitConstraintKind`
    joint:     index of a joint; axis: in its axes
    points:    places in the points of the fit
    target:    a place or a direction; NaN: missing
    distances: the smallest and the largest distance of two points that cost nothing
    """

    kind: int
    joint: int = 0
    points: Sequence[int] = (0, 0)
    axis: Sequence[float] = (1, 0, 0)
    target: Sequence[float] = (0, 0, 0)
    distances: Sequence[float] = (0, 0)
    weight: float = 1


class FitResult(NamedTuple):
    """The controls of a frame, and how well they explain it.

    controls:       float32 (raw controls,)
    status:         `FitStatus`
    joint_residual: weighted root mean square of the differences of joint values
    point_residual: the same of the distances of points; without these, of images; without both, of the surface
    joint_worst, point_worst: the largest ones
    rotation, translation: points of the target = rotation @ model + translation, if rigid; those of the camera
                    with images
    focal:          of the camera
    constraint_residual, constraint_worst: of constraints
    jumped:         joints or points moved farther from `start` than their targets are
    image_residual, image_worst: of images, in their unit
    surface_residual, surface_worst: of the distances from the surface
    """

    controls: Any
    status: int
    iterations: int
    cost: float
    joint_residual: float
    point_residual: float
    joint_worst: float
    point_worst: float
    missing_points: int
    rotation: Any
    translation: Any
    focal: Any
    constraint_residual: float
    constraint_worst: float
    jumped: bool
    image_residual: float
    image_worst: float
    surface_residual: float
    surface_worst: float


class FitSurface(Closable):
    """A surface without correspondences, as a target of `Fit.solve()`: a scan, or a mesh of another topology.

    positions: (positions, 3) in the unit and axes of the rig; those in the same place are one
    triangles: (triangles, 3) indices of positions, all wound the same way
    """

    __slots__ = ()

    @raises("mien_fit_surface_create")
    def __init__(self, positions: Any, triangles: Any) -> None:
        if numpy is None:
            raise ImportError("solving needs NumPy")
        points = numpy.ascontiguousarray(positions, "f")
        corners = numpy.asarray(triangles)
        if points.ndim != 2 or points.shape[1] != 3 or corners.ndim != 2 or corners.shape[1] != 3:
            raise ArgumentError("a surface has positions (positions, 3) and triangles (triangles, 3)")
        if corners.dtype.kind not in "iu" or (corners.size and corners.min() < 0):
            raise ArgumentError("a triangle has three indices of positions")
        if corners.size and corners.max() > 0xFFFFFFFF:
            raise ArgumentError("a position is not an index")
        corners = numpy.ascontiguousarray(corners, "uint32")
        desc = _api.MienFitSurfaceDesc(
            positions=points.ctypes.data, triangles=corners.ctypes.data, position_count=len(points),
            triangle_count=len(corners))
        handle, error = FitSurfaceHandle(), MienError()
        status = solver().mien_fit_surface_create(_byref(desc), _byref(handle), _byref(error))
        if status:
            fail(status, "cannot make a surface", error)
        self._handle = handle


class Fit(Closable):
    """Finds the raw controls of frames (docs/solving.md). For one thread at a time.

        fit = mien.Fit(rig, deformer, mesh=0)
        result = fit.solve(points=positions)          # float32 (positions, 3)
        result = fit.solve(points=next_positions, start=result.controls)

    deformer:      needed for points
    controls:      raw controls that may move, ascending; None: all
    lower, upper:  bounds, one number or one for each of these controls; None: 0 and 1. Rotations, whose
                   four parts are named .qx .qy .qz .qw or .x .y .z .w, have none
    symmetric:     pairs (left, right) of raw controls kept similar
    mesh:          the mesh of all points, or, with `positions`, (points,): that of each
    positions:     (points,) indices of positions, or (points, 3) with `weights`; None: every position if
                   there is a deformer
    weights:       (points, 3) weights of these positions
    joint_weights: per joint value; None: 1 each, or 0 if there are points
    """

    __slots__ = ("_lock", "_raw_count", "_joint_count", "_point_count")

    @raises("mien_fit_create")
    def __init__(self, rig: Rig, deformer: Optional[Deformer] = None, controls: Any = None,
                 lower: Any = None, upper: Any = None, symmetric: Any = None, mesh: Any = 0,
                 positions: Any = None, weights: Any = None, joint_weights: Any = None,
                 lod: int = 0) -> None:
        if numpy is None:
            raise ImportError("solving needs NumPy")
        self._raw_count = rig.count(Kind.RAW_CONTROL)
        self._joint_count = rig.info.joint_value_count
        given = None if controls is None else numpy.ascontiguousarray(controls, "uint32").reshape(-1)
        moving = self._raw_count if given is None else given.size
        bounds = [None if bound is None else
                  numpy.ascontiguousarray(numpy.broadcast_to(numpy.asarray(bound, "f"), (moving,)))
                  for bound in (lower, upper)]
        pairs = numpy.ascontiguousarray([] if symmetric is None else symmetric, "uint32").reshape(-1)
        points = self._points(deformer, mesh, positions, weights)
        factors = None
        if joint_weights is not None:
            factors = numpy.ascontiguousarray(joint_weights, "f").reshape(-1)
            if factors.size != self._joint_count:
                raise ArgumentError(f"{factors.size} joint weights, {self._joint_count} joint values")

        def address(values: Any) -> Any:
            return None if values is None else values.ctypes.data
        desc = _api.MienFitDesc(
            deformer=deformer and deformer._open(), controls=address(given), lower=address(bounds[0]),
            upper=address(bounds[1]), symmetric=address(pairs), points=points,
            joint_weights=address(factors), control_count=0 if given is None else given.size,
            symmetric_count=pairs.size, point_count=len(points), lod=uint32(lod, "lod"))
        handle, error = FitHandle(), MienError()
        status = solver().mien_fit_create(rig._open(), _byref(desc), _byref(handle), _byref(error))
        if status:
            fail(status, "cannot make a fit", error)
        handle.kept = rig._open(), deformer and deformer._open()
        self._handle = handle
        self._point_count = len(points)
        self._lock = allocate_lock()

    @staticmethod
    def _points(deformer: Optional[Deformer], mesh: Any, positions: Any, weights: Any) -> Any:
        if positions is None and deformer is None:
            return (_api.MienSolvePoint * 0)()
        if deformer is None:
            raise ArgumentError("points need the deformer of the rig")
        chosen = numpy.arange(deformer.mesh(mesh).position_count) if positions is None else \
            numpy.asarray(positions)
        if chosen.ndim == 1 and weights is None:
            chosen = numpy.repeat(chosen[:, None], 3, 1)
            weights = numpy.tile(numpy.array([1, 0, 0], "f"), (len(chosen), 1))
        shares = numpy.asarray(weights, "f")
        if chosen.shape[1:] != (3,) or shares.shape != chosen.shape or chosen.dtype.kind not in "iu":
            raise ArgumentError("points are whole numbers (points,), or (points, 3) with weights (points, 3)")
        if chosen.size and (chosen.min() < 0 or chosen.max() > 0xFFFFFFFF):
            raise ArgumentError("a position is not an index")
        meshes = numpy.asarray(mesh)
        if meshes.shape not in ((), chosen.shape[:1]) or meshes.dtype.kind not in "iu":
            raise ArgumentError("a mesh is an index, or one for each point")
        if meshes.size and (meshes.min() < 0 or meshes.max() > 0xFFFFFFFF):
            raise ArgumentError("a mesh is not an index")
        # The layout of MienSolvePoint.
        rows = numpy.zeros(len(chosen), [("mesh", "u4"), ("positions", "u4", 3), ("weights", "f4", 3)])
        rows["mesh"], rows["positions"], rows["weights"] = meshes, chosen, shares
        return (_api.MienSolvePoint * len(chosen)).from_buffer_copy(rows.tobytes())

    @contextmanager
    def _alone(self) -> Iterator[Any]:
        """The handle, for this thread."""
        if not self._lock.acquire(False):
            raise BusyError("another thread is working with this fit", Status.HANDLE)
        try:
            yield self._open()
        finally:
            self._lock.release()

    @raises("mien_fit_solve")
    def solve(self, joints: Any = None, points: Any = None, images: Any = None,
              camera: Optional[FitCamera] = None, point_weights: Any = None, start: Any = None,
              prior: Any = None, prior_weight: float = 0, smooth_weight: float = 0,
              sparse_weight: float = 0, symmetric_weight: float = 0, robust_scale: float = 0,
              joint_weight: float = 0, rigid: bool = False, max_iterations: int = 0,
              max_seconds: float = 0, canceled: Any = None, surface: Optional[FitSurface] = None,
              surface_reach: float = 0, focal: bool = False,
              constraints: Sequence[FitConstraint] = (), stages: Any = None,
              point_offsets: Any = None, surface_weights: Any = None, image_weight: float = 0,
              image_robust_scale: float = 0) -> FitResult:
        """The controls of a frame. Targets of NaN are missing. Targets of several kinds may be given together.

        joints:   as `Instance.joints`
        points:   (points, 3); images: (points, 2), seen by `camera`
        start:    raw controls to start from, those of the frame before; None: the initial ones
        prior:    raw controls that the result is drawn to with `prior_weight`
        canceled: function called before each iteration; the solve stops if it returns true
        surface:  each point is drawn to its nearest place; points farther than `surface_reach` have no target.
                  `surface_weights`: how much each point is; None: `point_weights`, which are those of points and
                  images
        rigid:    points and surface move as a whole; with images, these stay where they are, the camera is found,
                  and with `focal` its focal length too. A camera with a rotation of zeros is unknown.
        joint_weight, image_weight: weight of joints, and of images, relative to the points; 0: 1
        robust_scale: points farther off than this, or from the surface, count less. `image_robust_scale`: the same
                  of images; 0: `robust_scale`, or, if there are points or a surface too, all count fully
        constraints: up to 64 `FitConstraint`, added to the other targets
        stages:   0 to 15 for each raw control: those of 0 move first, alone, then those of 1 too, and so on
        point_offsets: (points, 3): how far the points of the face in the targets are from those of the rig at
                  rest, where it is another person's
        """
        terms = dict(locals())
        del terms["self"]
        return self._run(1, lambda handle, frame, out, results: solver().mien_fit_solve(
            handle, frame, out.ctypes.data, results), **terms)[0]

    @raises("mien_fit_solve_frames")
    def solve_frames(self, count: int, **terms: Any) -> List[FitResult]:
        """The controls of `count` frames of a motion, each from the result of the one before.

        terms: as `solve()` has them; joints, points, images, point_weights and surface_weights have a row for each
               frame. start and stages are for the first frame, and so is the camera, if it may move. Where joints are
               the only targets, this is faster than calls of `solve()`, and differs from them by rounding.
        """
        rows = uint32(count, "count")
        return self._run(rows, lambda handle, frame, out, results: solver().mien_fit_solve_frames(
            handle, frame, rows, out.ctypes.data, results), **terms)

    def _run(self, count: int, call: Callable[[Any, Any, Any, Any], int], joints: Any = None,
             points: Any = None, images: Any = None, camera: Optional[FitCamera] = None,
             point_weights: Any = None, start: Any = None, prior: Any = None,
             prior_weight: float = 0, smooth_weight: float = 0, sparse_weight: float = 0,
             symmetric_weight: float = 0, robust_scale: float = 0, joint_weight: float = 0, rigid: bool = False,
             max_iterations: int = 0, max_seconds: float = 0, canceled: Any = None,
             surface: Optional[FitSurface] = None, surface_reach: float = 0, focal: bool = False,
             constraints: Sequence[FitConstraint] = (), stages: Any = None,
             point_offsets: Any = None, surface_weights: Any = None, image_weight: float = 0,
             image_robust_scale: float = 0) -> List[FitResult]:
        kept: List[Any] = []

        def rows(values: Any, size: int, what: str) -> Any:
            if values is None:
                return None
            found = numpy.ascontiguousarray(values, "f")
            if found.size != size:
                raise ArgumentError(f"{what} has the shape {found.shape}: {size} numbers are needed")
            kept.append(found)
            return found.ctypes.data
        frame = _api.MienFitFrame(
            joints=rows(joints, count * self._joint_count, "joints"),
            points=rows(points, count * 3 * self._point_count, "points"),
            images=rows(images, count * 2 * self._point_count, "images"),
            point_weights=rows(point_weights, count * self._point_count, "point_weights"),
            point_offsets=rows(point_offsets, 3 * self._point_count, "point_offsets"),
            surface_weights=rows(surface_weights, count * self._point_count, "surface_weights"),
            image_weight=image_weight, image_robust_scale=image_robust_scale,
            start=rows(start, self._raw_count, "start"), prior=rows(prior, self._raw_count, "prior"),
            prior_weight=prior_weight, smooth_weight=smooth_weight, sparse_weight=sparse_weight,
            symmetric_weight=symmetric_weight, robust_scale=robust_scale, joint_weight=joint_weight,
            rigid=bool(rigid), max_iterations=uint32(max_iterations, "max_iterations"),
            max_seconds=max_seconds, canceled=_canceled_type(),
            surface=surface and surface._open(), surface_reach=surface_reach, focal=bool(focal))
        if constraints:
            listed = (_api.MienFitConstraint * len(constraints))()
            for to, given in zip(listed, constraints):
                to.kind, to.joint, to.weight = uint32(given.kind, "kind"), uint32(given.joint, "joint"), given.weight
                to.points[:] = [uint32(point, "point") for point in given.points]
                to.axis[:], to.target[:], to.distances[:] = given.axis, given.target, given.distances
            kept.append(listed)
            frame.constraints = listed
            frame.constraint_count = len(constraints)
        if stages is not None:
            numbers = numpy.ascontiguousarray(stages, "uint32").reshape(-1)
            if numbers.size != self._raw_count:
                raise ArgumentError(f"{numbers.size} stages, {self._raw_count} raw controls")
            kept.append(numbers)
            frame.stages = numbers.ctypes.data
        if camera is not None:
            seen = _api.MienFitCamera()
            for name, values in camera._asdict().items():
                numbers = numpy.asarray(values, "f").reshape(-1)
                getattr(seen, name)[:] = numbers.tolist()
            kept.append(seen)
            frame.camera = ctypes.pointer(seen)
        raised: List[BaseException] = []
        if canceled is not None:
            def ask(_user: Any) -> int:
                if raised:
                    return 1
                try:
                    return bool(canceled())
                except BaseException as error:  # comes out of solve()
                    raised.append(error)
                    return 1
            frame.canceled = _canceled_type(ask)
        out, results = numpy.empty((count, self._raw_count), "f"), (_api.MienFitResult * count)()
        for result in results:
            result.struct_size = ctypes.sizeof(result)
        with self._alone() as handle:
            status = call(handle, _byref(frame), out, results)
        if raised:
            raise raised[0]
        if status:
            fail(status, "cannot solve: points need a fit with points, images a camera, weights are finite and "
                 "not negative")
        return [FitResult(
            row, _api._enum(FitStatus, result.status), result.iterations, result.cost, result.joint_residual,
            result.point_residual, result.joint_worst, result.point_worst, result.missing_points,
            numpy.array(result.rotation, "f").reshape(3, 3), numpy.array(result.translation, "f"),
            numpy.array(result.focal, "f"), result.constraint_residual, result.constraint_worst,
            bool(result.jumped), result.image_residual, result.image_worst, result.surface_residual,
            result.surface_worst) for row, result in zip(out, results)]

    @property
    @raises("mien_fit_observability", but=(Status.INVALID_ARGUMENT,))
    def observability(self) -> Floats:
        """float32 (raw controls,): how well the data determines each control at the initial pose, 0 to 1."""
        out = numpy.empty(self._raw_count, "f")
        status = solver().mien_fit_observability(self._open(), out.ctypes.data, out.size)
        if status:
            fail(status, "observability")
        return out

    def __repr__(self) -> str:
        if self.closed:
            return "<mien.Fit, closed>"
        return f"<mien.Fit: {self._point_count} points, {self._joint_count} joint values>"


def solve(rig: Rig, deformer: Optional[Deformer] = None, *, joints: Any = None, points: Any = None,
          mesh: Any = 0, positions: Any = None, weights: Any = None, controls: Any = None,
          smooth_weight: float = 0, **terms: Any) -> Any:
    """The raw controls of a take, float32 (frames, raw controls): each frame starts from the one before.

    joints: (frames, joints, 9) as `Instance.joints`
    points: (frames, points, 3) of `mesh`: all positions, or those chosen by `positions` and `weights`
    terms:  as `Fit.solve` has them

        controls = mien.solve(rig, deformer, points=positions)
    """
    frames = joints if joints is not None else points
    if frames is None:
        raise ArgumentError("give joints or points")
    with Fit(rig, deformer if points is not None else None, controls, mesh=mesh, positions=positions,
             weights=weights) as fit:
        found = numpy.empty((len(frames), fit._raw_count), "f")
        start = None
        for f in range(len(frames)):
            found[f] = fit.solve(joints=None if joints is None else joints[f],
                                 points=None if points is None else points[f], start=start,
                                 smooth_weight=smooth_weight if f else 0, **terms).controls
            start = found[f]
    return found


@raises("mien_fit_keys")
def reduce_keys(values: Any, tolerance: float) -> Any:
    """uint32 frame numbers of the keys of a curve: straight lines between them are within `tolerance` of all
    values. The first and the last frame are keys."""
    curve = numpy.ascontiguousarray(values, "f").reshape(-1)
    keys, count = numpy.empty(curve.size, "uint32"), ctypes.c_size_t()
    status = solver().mien_fit_keys(curve.ctypes.data, curve.size, tolerance, keys.ctypes.data,
                                    _byref(count))
    if status:
        fail(status, "cannot reduce keys")
    return keys[:count.value].copy()
