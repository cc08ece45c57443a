# SPDX-License-Identifier: MIT
"""Baked files by their handles: opening them, what they give, writing them."""
from __future__ import annotations

import ctypes
from typing import Any, Optional

from . import _api
from ._api import (BakedCheck, BakedInfo, FileAccess, Isa, MienError, Normals, Reuse)
from ._library import lib
from ._memory import (BakedHandle, Closable, DeformerHandle, FileStream, RigHandle, as_bytes,
                      as_path, uint32)
from .errors import fail

_byref = ctypes.byref


def open_file(path: Any, access: int = FileAccess.READ, check: int = BakedCheck.SAFE) -> BakedHandle:
    """The handle of a file."""
    desc = _api.MienBakedDesc(file_access=uint32(access, "access"), check=uint32(check, "check"))
    handle, error = BakedHandle(), MienError()
    status = lib.mien_baked_open_file(as_path(path), _byref(desc), _byref(handle), _byref(error))
    if status:
        fail(status, f"cannot open {path}", error, path)
    return handle


def open_bytes(data: Any, check: int = BakedCheck.SAFE) -> BakedHandle:
    """The handle of a file in memory, which it keeps alive."""
    data = as_bytes(data)
    desc = _api.MienBakedDesc(check=uint32(check, "check"))
    handle, error = BakedHandle(), MienError()
    status = lib.mien_baked_open_memory(data, len(data), _byref(desc), _byref(handle),
                                        _byref(error))
    if status:
        fail(status, "cannot open the bytes", error)
    handle.keeps = data
    return handle


def open_stream(file: Any, check: int = BakedCheck.SAFE) -> BakedHandle:
    """The handle of what a file object holds."""
    stream = FileStream(file)
    desc = _api.MienBakedDesc(check=uint32(check, "check"))
    handle, error = BakedHandle(), MienError()
    status = lib.mien_baked_open_stream(_byref(stream.stream), _byref(desc), _byref(handle),
                                        _byref(error))
    stream.check()
    if status:
        fail(status, "cannot open the stream", error)
    return handle


def rig_of(baked: BakedHandle, isa: int = Isa.BEST, reuse: int = Reuse.UNCHANGED) -> RigHandle:
    """The handle of the rig of a baked file."""
    desc = _api.MienBakedRigDesc(isa=uint32(isa, "isa"), reuse=uint32(reuse, "reuse"))
    handle, error = RigHandle(), MienError()
    status = lib.mien_rig_from_baked(baked, _byref(desc), _byref(handle), _byref(error))
    if status:
        fail(status, "cannot make a rig", error)
    handle.baked = baked  # and with it the bytes
    return handle


def deformer_of(baked: BakedHandle, rig: Any, isa: int = Isa.BEST,
                normals: int = Normals.DEFAULT) -> DeformerHandle:
    """The handle of the deformer of a baked file."""
    desc = _api.MienBakedDeformerDesc(isa=uint32(isa, "isa"), normals=uint32(normals, "normals"))
    handle, error = DeformerHandle(), MienError()
    status = lib.mien_deformer_from_baked(baked, rig, _byref(desc), _byref(handle), _byref(error))
    if status:
        fail(status, "cannot make a deformer", error)
    handle.baked = baked
    return handle


def info_of(baked: BakedHandle) -> BakedInfo:
    """Sizes, and what is in it."""
    found = _api.MienBakedInfo()
    status = lib.mien_baked_info(baked, _byref(found))
    if status:
        fail(status, "no info")
    return BakedInfo._of(found)


def bake(path: Any, rig: Any, deformer: Optional[Any]) -> None:
    """Writes a baked file of open handles."""
    error = MienError()
    status = lib.mien_bake_file(rig, deformer, as_path(path), _byref(error))
    if status:
        fail(status, f"cannot write {path}", error, path)


def baked_bytes(rig: Any, deformer: Optional[Any]) -> bytes:
    """The same to memory."""
    size, error = ctypes.c_size_t(), MienError()
    status = lib.mien_bake_memory(rig, deformer, None, 0, _byref(size), _byref(error))
    if not status:
        buffer = ctypes.create_string_buffer(size.value)
        status = lib.mien_bake_memory(rig, deformer, buffer, size.value, _byref(size),
                                      _byref(error))
    if status:
        fail(status, "cannot bake", error)
    return buffer.raw
