# SPDX-License-Identifier: MIT
"""What the calls of this package raise.

Everything that the library refuses is an `Error`, and also the exception that Python users expect
for such a thing: an index past the end is an IndexError, a file that cannot be read an OSError.
"""
from __future__ import annotations

from typing import Any, NoReturn, Optional, Tuple, Type

from . import _api
from ._api import Status
from ._library import lib


class Error(Exception):
    """A call failed.

    status:      a `Status`
    message:     what happened, where, and what to do
    byte_offset: where in the file, or None
    """

    def __init__(self, message: str, status: int = Status.INVALID_ARGUMENT,
                 byte_offset: Optional[int] = None) -> None:
        super().__init__(message)
        self.status = _api._enum(Status, status)
        self.message = message
        self.byte_offset = byte_offset

    def __str__(self) -> str:
        return self.message

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self), (self.message, self.status, self.byte_offset)


class ArgumentError(Error, ValueError):
    """A value, shape or combination that the call does not take."""


class ClosedError(ArgumentError):
    """The DNA, rig or instance was closed."""


class BusyError(Error, RuntimeError):
    """Another thread is working with this instance. An instance is for one thread at a time."""


class OutOfRangeError(Error, IndexError):
    """An index past the end, or a LOD that the rig does not have."""


class UnknownNameError(Error, KeyError):
    """No such control, joint or other thing; or no such path in a DNA file."""


class OutOfMemoryError(Error, MemoryError):
    """There was not enough memory."""


class FileError(Error, OSError):
    """A file could not be opened, read or written."""


class DnaError(Error, ValueError):
    """A DNA file or a baked rig is damaged, of another kind, or lacks something. `byte_offset`
    tells where."""


_KINDS = {
    Status.INDEX: OutOfRangeError, Status.LOD: OutOfRangeError, Status.NAME: UnknownNameError,
    Status.MEMORY: OutOfMemoryError,
}


def kind_of(status: int) -> Type[Error]:
    """The exception for a status; families are numbered as mien.h says."""
    if status in _KINDS:
        return _KINDS[Status(status)]
    if 1 <= status <= 9:
        return ArgumentError
    if 20 <= status <= 29:
        return FileError
    if 30 <= status <= 59:
        return DnaError
    return Error


def fail(status: int, what: str, detail: Optional[_api.MienError] = None) -> NoReturn:
    """Raises the exception for a status that is not OK; `what` serves where the library says
    nothing more."""
    offset = None
    if detail is not None and detail.status:
        what = detail.message.decode("utf-8", "replace")
        if detail.byte_offset != _api.MIEN_NO_OFFSET:
            offset = detail.byte_offset
    else:
        what = f"{what}: {lib.mien_status_name(status).decode()}"
    raise kind_of(status)(what, status, offset)
