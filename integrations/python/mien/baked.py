# SPDX-License-Identifier: MIT
"""Baked files: a rig, and its deformer if it has one, as they are in memory."""
from __future__ import annotations

from typing import Any

from . import _baked
from ._api import BakedCheck, BakedInfo, FileAccess, Isa, Normals, Reuse
from ._memory import BakedHandle, Closable
from .deformer import Deformer
from .errors import raises
from .rig import Rig


class Baked(Closable):
    """A file that `Rig.bake` or `mien bake` wrote. Immutable: any number of threads may use it.

        with mien.Baked.open("head.rig") as baked:
            rig = baked.rig()
            deformer = baked.deformer(rig)

    What is made of it keeps its bytes, so it may be closed at once.
    """

    __slots__ = ("info",)

    def __init__(self, handle: BakedHandle) -> None:
        self._handle = handle
        self.info: BakedInfo = _baked.info_of(handle)

    @classmethod
    @raises("mien_baked_open_file")
    def open(cls, path: Any, access: int = FileAccess.READ, check: int = BakedCheck.SAFE) -> Baked:
        """Opens a file.

        access: `FileAccess.MAP` shares the file's pages with other processes and reads what is
                needed. If a mapped file is truncated, the process crashes; so the default is to
                read it all
        check:  `BakedCheck.FULL` also finds changed numbers
        """
        return cls(_baked.open_file(path, access, check))

    @classmethod
    @raises("mien_baked_open_memory")
    def from_bytes(cls, data: Any, check: int = BakedCheck.SAFE) -> Baked:
        """The same from memory, which is kept alive."""
        return cls(_baked.open_bytes(data, check))

    @classmethod
    @raises("mien_baked_open_stream")
    def from_stream(cls, file: Any, check: int = BakedCheck.SAFE) -> Baked:
        """The same from a binary file object that can seek: reads it to its end, from where it
        stands."""
        return cls(_baked.open_stream(file, check))

    @raises("mien_rig_from_baked")
    def rig(self, isa: int = Isa.BEST, reuse: int = Reuse.UNCHANGED) -> Rig:
        """The rig. Other choices were made when it was baked."""
        return Rig._of(_baked.rig_of(self._open(), isa, reuse))

    @raises("mien_deformer_from_baked")
    def deformer(self, rig: Rig, isa: int = Isa.BEST, normals: int = Normals.DEFAULT) -> Deformer:
        """The deformer of a rig that this made. `Isa.BEST` is that of the rig, `Normals.DEFAULT`
        the choice that was baked."""
        return Deformer._of(_baked.deformer_of(self._open(), rig._open(), isa, normals), rig)
