# SPDX-License-Identifier: MIT
"""What a mix tells about itself."""
from __future__ import annotations

import ctypes
from typing import Dict, List, NamedTuple, Sequence

from . import _api
from ._api import MixInfo, Status
from ._library import lib
from ._memory import Closable, MixHandle, uint32
from .errors import UnknownNameError, fail, raises
from .mix_parts import Curve

_byref = ctypes.byref


class GuardInfo(NamedTuple):
    """A guard as it was measured: millimeters = rest + sum of gain * curve + pairs of curves.

    fit_error: millimeters, root mean square over the measured rows
    """

    curves: List[int]
    gains: List[float]
    pair_count: int
    rest: float
    needs_speech: bool
    tolerance: float
    f_on: float
    fit_error: float


@raises("mien_mix_glare")
class MixView(Closable):
    """The properties of a mix. `Mix` adds how mixes are made. Immutable: any number of threads may
    use it.
    """

    __slots__ = ("info", "variables")

    def _take(self, handle: MixHandle, variables: Sequence[str]) -> None:
        self._handle = handle
        found = _api.MienMixInfo()
        status = lib.mien_mix_info(handle, _byref(found))
        if status:
            fail(status, "no info")
        self.info: MixInfo = MixInfo._of(found)
        self.variables: Dict[str, int] = {name: i for i, name in enumerate(variables)}

    @raises("mien_mix_guard")
    def guard(self, guard: int) -> GuardInfo:
        """A guard, by its number from 0 on."""
        g = _api.MienMixGuardInfo()
        handle = self._open()
        status = lib.mien_mix_guard(handle, uint32(guard, "guard"), _byref(g))
        if status:
            fail(status, f"guard {guard} of {self.info.guard_count}")
        count = g.curves.count
        curves = list((ctypes.c_uint16 * count).from_address(g.curves.data)) if count else []
        gains = list((ctypes.c_float * count).from_address(g.gains.data)) if count else []
        return GuardInfo(curves, gains, g.pair_count, g.rest,
                         bool(g.needs_speech), g.tolerance, g.f_on, g.fit_error)

    def variable(self, variable: Curve) -> int:
        """Index of a pose variable."""
        if not isinstance(variable, str):
            return uint32(variable, "variable")
        if variable not in self.variables:
            raise UnknownNameError(f"there is no pose variable {variable!r}", Status.NAME)
        return self.variables[variable]
