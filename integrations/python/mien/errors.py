# SPDX-License-Identifier: MIT
"""What the calls of this package raise.

Everything that the library refuses is an `Error`, and also the exception that Python users expect
for such a thing: an index past the end is an IndexError, a file that cannot be read an OSError.
"""
from __future__ import annotations

import errno
import inspect
import os
from typing import Any, Callable, Dict, List, NoReturn, Optional, Tuple, Type, TypeVar

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
    """A file could not be opened, read or written. `filename` and, if known, `errno` are set. A
    missing file is also a FileNotFoundError, one without permission a PermissionError."""

    def __init__(self, message: str, status: int = Status.FILE_OPEN,
                 byte_offset: Optional[int] = None, filename: Optional[str] = None) -> None:
        super().__init__(message, status, byte_offset)
        self.filename = filename
        self.errno = _errno_of(filename)  # type: ignore[assignment]

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self), (self.message, self.status, self.byte_offset, self.filename)


class MissingFileError(FileError, FileNotFoundError):
    """There is no such file."""


class ForbiddenFileError(FileError, PermissionError):
    """The file may not be read or written by this process."""


def _errno_of(filename: Optional[str]) -> Optional[int]:
    """Why the system refuses to read a file, as errno; None if it does not, or is not asked."""
    if filename is None:
        return None
    try:
        os.close(os.open(filename, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0)))
    except OSError as error:
        return error.errno
    return None


_FILE_KINDS: Dict[Optional[int], Type[FileError]] = {
    errno.ENOENT: MissingFileError, errno.EACCES: ForbiddenFileError,
    errno.EPERM: ForbiddenFileError,
}


class DnaError(Error, ValueError):
    """A DNA file or a baked rig is damaged, of another kind, or lacks something. `byte_offset`
    tells where."""


class AuthorError(Error, ValueError):
    """A mesh cannot be rigged, its arrays contradict each other, or `progress` canceled."""


class ClipError(Error, ValueError):
    """A clip is damaged or of another kind, or cannot be built of these curves."""


class MixError(Error, ValueError):
    """A mix is damaged, truncated, of another version or of another kind."""


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
    if 60 <= status <= 69:
        return ClipError
    if 70 <= status <= 79:
        return MixError
    if 80 <= status <= 89:
        return AuthorError
    return Error


_F = TypeVar("_F", bound=Callable[..., Any])


def raises(*functions: str, but: Tuple[Status, ...] = ()) -> Callable[[_F], _F]:
    """Adds to the documentation of a method why it can fail: the statuses of the C functions that it
    calls, but those that it rules out."""
    def add(method: _F) -> _F:
        told: Dict[Tuple[str, str], List[str]] = {}
        for name in functions:
            for status, why in _api.STATUSES[name]:
                if status not in but:
                    told.setdefault((kind_of(status).__name__, why), []).append(status.name)
        lines = [f"    {kind} ({', '.join(dict.fromkeys(names))}): {why}"
                 for (kind, why), names in told.items()]
        above = inspect.cleandoc(method.__doc__ or "")
        method.__doc__ = "\n".join([above, "", "Raises:"] + lines).lstrip("\n")
        return method
    return add


def fail(status: int, what: str, detail: Optional[_api.MienError] = None,
         filename: Any = None) -> NoReturn:
    """Raises the exception for a status that is not OK. `what` is the message if the library gives
    none; `filename` is the file that the call was about."""
    offset = None
    if detail is not None and detail.status:
        what = detail.message.decode("utf-8", "replace")
        if detail.byte_offset != _api.MIEN_NO_OFFSET:
            offset = detail.byte_offset
    else:
        what = f"{what}: {lib.mien_status_name(status).decode()}"
    kind = kind_of(status)
    if kind is FileError:
        name = None if filename is None else os.fsdecode(filename)
        raise _FILE_KINDS.get(_errno_of(name), FileError)(what, status, offset, name)
    raise kind(what, status, offset)
