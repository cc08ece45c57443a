# SPDX-License-Identifier: MIT
"""Finds libmien and loads it, once, when the package is imported; libmien-author, which makes
files, and libmien-solve, which finds controls, when they are needed."""
from __future__ import annotations

import ctypes
import ctypes.util
import os
import sys
from pathlib import Path
from typing import Iterable, Iterator, Optional

from . import _api


def _names(stem: str) -> Iterable[str]:
    """What the file of a library is called here."""
    if sys.platform == "win32":
        return (f"{stem}.dll",)
    if sys.platform == "darwin":
        return (f"lib{stem}.0.dylib", f"lib{stem}.dylib")
    return (f"lib{stem}.so.0", f"lib{stem}.so")


def _in(directory: Path, stem: str) -> Iterator[str]:
    return (str(directory / name) for name in _names(stem) if (directory / name).exists())


def _in_system(stem: str) -> Iterator[str]:
    yield from _names(stem)
    found = ctypes.util.find_library(stem)
    if found:
        yield found


def _candidates() -> Iterator[str]:
    """Where libmien may be, best first: as told, in the package, in the system."""
    told = os.environ.get("MIEN_LIBRARY")
    if told:
        yield told
        return
    yield from _in(Path(__file__).resolve().parent, "mien")
    yield from _in_system("mien")


def _load(candidates: Iterable[str], message: str) -> ctypes.CDLL:
    failures = []
    for candidate in candidates:
        try:
            return ctypes.CDLL(candidate)
        except OSError as error:
            failures.append(str(error))
    raise ImportError(message + " Tried:\n  " + "\n  ".join(failures))


def _bind(loaded: ctypes.CDLL) -> _api.Library:
    try:
        library = _api.Library(loaded)
    except AttributeError as error:
        raise ImportError(f"libmien is older than this package ({_api.VERSION}): {error}") from None
    number = library.mien_version()
    major, minor, patch = number >> 24, number >> 16 & 255, number & 0xFFFF
    ours = tuple(int(part) for part in _api.VERSION.split("."))
    # Until 1.0 a minor release may change the interface.
    if major != ours[0] or (major == 0 and minor != ours[1]):
        raise ImportError(f"libmien is of version {major}.{minor}.{patch}, this package is for "
                          f"{_api.VERSION}: {loaded._name}")
    return library


_loaded = _load(_candidates(), "libmien was not found. Install the wheel, which holds it, or the "
                "library itself, or name the file in MIEN_LIBRARY.")
lib = _bind(_loaded)
path = _loaded._name
_author: Optional[_api.AuthorLibrary] = None
_solver: Optional[_api.SolveLibrary] = None


def _beside(stem: str, what: str) -> ctypes.CDLL:
    """A library that lies beside libmien."""
    folder = os.path.dirname(path)
    return _load(_in(Path(folder), stem) if folder else _in_system(stem),
                 f"lib{stem}, which {what}, was not found beside libmien ({path}). Install the wheel, "
                 "which holds all of them.")


def author() -> _api.AuthorLibrary:
    """libmien-author, which lies beside libmien."""
    global _author
    if _author is None:
        _author = _api.AuthorLibrary(_beside("mien-author", "makes DNA files"))
    return _author


def solver() -> _api.SolveLibrary:
    """libmien-solve, which lies beside libmien."""
    global _solver
    if _solver is None:
        _solver = _api.SolveLibrary(_beside("mien-solve", "finds controls"))
    return _solver


def version() -> str:
    """Version of the library in use, such as "0.1.0"."""
    number = lib.mien_version()
    return f"{number >> 24}.{number >> 16 & 255}.{number & 0xFFFF}"
