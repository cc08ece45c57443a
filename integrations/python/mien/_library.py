# SPDX-License-Identifier: MIT
"""Finds libmien and loads it, once, when the package is imported."""
from __future__ import annotations

import ctypes
import ctypes.util
import os
import sys
from pathlib import Path
from typing import Iterator

from . import _api

_NAMES = {"win32": ("mien.dll",), "darwin": ("libmien.0.dylib", "libmien.dylib")}.get(
    sys.platform, ("libmien.so.0", "libmien.so"))


def _candidates() -> Iterator[str]:
    """Where the library may be, best first: as told, in the package, in the system."""
    told = os.environ.get("MIEN_LIBRARY")
    if told:
        yield told
        return
    for name in _NAMES:
        beside = Path(__file__).resolve().parent / name
        if beside.exists():
            yield str(beside)
    yield from _NAMES
    found = ctypes.util.find_library("mien")
    if found:
        yield found


def _load() -> ctypes.CDLL:
    failures = []
    for candidate in _candidates():
        try:
            return ctypes.CDLL(candidate)
        except OSError as error:
            failures.append(str(error))
    raise ImportError("libmien was not found. Install the wheel, which holds it, or the library "
                      "itself, or name the file in MIEN_LIBRARY. Tried:\n  "
                      + "\n  ".join(failures))


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


_loaded = _load()
lib = _bind(_loaded)
path = _loaded._name


def version() -> str:
    """Version of the library in use, such as "0.1.0"."""
    number = lib.mien_version()
    return f"{number >> 24}.{number >> 16 & 255}.{number & 0xFFFF}"
