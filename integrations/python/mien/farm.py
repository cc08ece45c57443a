# SPDX-License-Identifier: MIT
"""Many frames on many machines, as arrays and delayed pieces of Dask.

    from mien import farm

    joints = farm.evaluate("head.rig", "line.clip")             # dask array (frames, joints, 9)
    faces = farm.deform("head.rig", "line.clip", "face")        # dask array (frames, positions, 3)
    faces.to_zarr("faces.zarr")                                 # or dask.array.to_npy_stack()
    dask.compute(farm.bake("head.dna", "head.rig"), *farm.render("job.json", pieces=64))

Only paths and frame numbers travel to the workers, so all machines need the same paths. A worker maps a baked rig once
and shares its pages with the other workers of its machine. Results do not depend on `chunk` or on the cluster, as far
as all machines have instruction sets of one family (docs/numbers.md). Needs Dask and NumPy.
"""
from __future__ import annotations

import functools
import subprocess
from typing import Any, Iterator, List, Tuple

import numpy
from dask.array import core as _core, wrap as _wrap
from dask.delayed import delayed

from . import _api
from .baked import Baked
from .clip import Clip
from .deformer import Deformer
from .dna import Dna
from .errors import ArgumentError
from .rig import Rig

__all__ = ["bake", "deform", "evaluate", "render"]

_arrays: Any = _core  # Dask has no types
_zeros: Any = _wrap.zeros

_BLOCK = 64  # characters of a batch: their memory stays small, and the matrix is fetched once for all


@functools.lru_cache(maxsize=4)
def _opened(path: str) -> Tuple[Baked, Rig]:
    baked = Baked.open(path, _api.FileAccess.MAP)
    return baked, baked.rig()


def _rig(path: str) -> Rig:
    return _opened(path)[1]


@functools.lru_cache(maxsize=4)
def _deformer(path: str) -> Deformer:
    baked, rig = _opened(path)
    return baked.deformer(rig)


def _frame_count(take: str) -> int:
    if take.endswith(".npy"):
        return int(numpy.load(take, mmap_mode="r").shape[0])
    with Clip.open(take, _api.FileAccess.MAP) as clip:
        return int(clip.info.frame_count)


def _blocks(rig: str, take: str, first: int, count: int, lod: int) -> Iterator[Tuple[int, int, Any]]:
    """Evaluated frames: the place of the first in the chunk, how many, and their batch."""
    batch = _rig(rig).batch(min(_BLOCK, count))
    clip = None if take.endswith(".npy") else Clip.open(take, _api.FileAccess.MAP)
    binding = clip.bind(batch.rig) if clip else None
    values = clip.read(first, count) if clip else numpy.load(take, mmap_mode="r")[first:first + count]
    for begin in range(0, count, _BLOCK):
        size = min(_BLOCK, count - begin)
        batch.reset()
        if binding:
            for i in range(size):
                binding.apply(values[begin + i], batch[i])
        else:
            batch.raw_controls[:size] = values[begin:begin + size]
        batch.evaluate(lod)
        yield begin, size, batch


def _joints(rig: str, take: str, first: int, count: int, lod: int) -> Any:
    opened = _rig(rig)
    out = numpy.empty((count, opened.count(_api.Kind.JOINT), opened.joint_width), numpy.float32)
    for begin, size, batch in _blocks(rig, take, first, count, lod):
        out[begin:begin + size] = batch.joints[:size]
    return out


def _positions(rig: str, take: str, first: int, count: int, mesh: int, lod: int) -> Any:
    pose = _deformer(rig).instance([lod])
    out = numpy.empty((count, _deformer(rig).mesh(mesh).positions.shape[0], 3), numpy.float32)
    for begin, size, batch in _blocks(rig, take, first, count, lod):
        for i in range(size):
            pose.update(batch[i])
            pose.deform(mesh, _api.Normals.NONE)
            out[begin + i] = pose.positions(mesh)
    return out


def _chunked(call: Any, rig: str, take: str, shape: Tuple[int, ...], chunk: int, *more: int) -> Any:
    if chunk < 1:
        raise ArgumentError(f"chunks of {chunk} frames; give one at least")
    frames = _frame_count(take)
    parts = []
    for first in range(0, frames, chunk):
        count = min(chunk, frames - first)
        piece = delayed(call, pure=True)(rig, take, first, count, *more)
        parts.append(_arrays.from_delayed(piece, (count, *shape), numpy.float32))
    return _arrays.concatenate(parts) if parts else _zeros((0, *shape), numpy.float32)


def evaluate(rig: str, take: str, lod: int = 0, chunk: int = 1024) -> Any:
    """Joint values of each frame: a dask array (frames, joints, 9), 10 for quaternions.

    rig:   path of a baked file
    take:  path of a clip, whose channels are bound by their names, or of an NPY file (frames, raw controls)
    chunk: frames of a piece
    """
    opened = _rig(rig)
    shape = (opened.count(_api.Kind.JOINT), opened.joint_width)
    return _chunked(_joints, rig, take, shape, chunk, lod)


def deform(rig: str, take: str, mesh: Any, lod: int = 0, chunk: int = 256) -> Any:
    """Positions of a mesh in each frame: a dask array (frames, positions, 3) in the unit of the rig.

    mesh: its name or number; the baked file must have geometry. Others are as at `evaluate`.
    """
    found = _deformer(rig).mesh(mesh)
    return _chunked(_positions, rig, take, (found.positions.shape[0], 3), chunk, found.index, lod)


def _bake(dna: str, path: str) -> str:
    with Dna.open(dna) as opened:
        rig = Rig(opened)
        rig.bake(path, Deformer(opened, rig))
    return path


def bake(dna: str, path: str) -> Any:
    """Bakes a DNA file with its geometry, delayed; computes to `path`."""
    return delayed(_bake, pure=False)(dna, path)


def _piece(program: str, job: str, piece: int, pieces: int) -> Tuple[int, int, str]:
    command = [program, "farm", job, "--piece", f"{piece}/{pieces}", "--resume", "--quiet"]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False)
    return piece, done.returncode, done.stderr.decode(errors="replace")


def render(job: str, pieces: int, program: str = "mien") -> List[Any]:
    """The pieces of a job of `mien farm` (docs/farms.md), delayed: images and GLB files come from the program.

    Each computes to its number, the exit code and the errors as text. A piece that fails does not raise, so that the
    others finish.
    """
    if pieces < 1:
        raise ArgumentError(f"{pieces} pieces; give one at least")
    return [delayed(_piece, pure=False)(program, job, piece, pieces) for piece in range(1, pieces + 1)]
