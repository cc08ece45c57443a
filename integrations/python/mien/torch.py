# SPDX-License-Identifier: MIT
"""Rigs as layers of PyTorch, on the CPU: networks can be trained through them. Needs PyTorch and NumPy.

    import mien, mien.torch

    layer = mien.torch.RigLayer(rig)                    # raw controls -> joint values
    joints = layer(controls)                            # (batch, controls) -> (batch, joint values)
    (joints - target).square().mean().backward()        # gradients of the controls
"""
from __future__ import annotations

from _thread import allocate_lock
from typing import Any, Optional

import numpy
import torch

from ._api import Kind, Normals, Point
from .deformer import Deformer
from .derivatives import Derivatives
from .errors import ArgumentError
from .rig import Rig

_WIDTHS = {Point.CONTROLS: "controls", Point.JOINTS: "joints", Point.CHANNELS: "blend_shapes",
           Point.MAPS: "animated_maps"}


class _Evaluate(torch.autograd.Function):  # type: ignore[misc]
    """Each row of controls is evaluated; backward, its gradient goes through the rig in reverse."""

    @staticmethod
    def forward(ctx: Any, *args: Any, **kwargs: Any) -> Any:
        controls, layer = args
        ctx.layer = layer
        ctx.save_for_backward(controls)
        return torch.from_numpy(layer._evaluate(controls.detach().numpy()))

    @staticmethod
    def backward(ctx: Any, *grad_outputs: Any) -> Any:
        controls, = ctx.saved_tensors
        rows = ctx.layer._reverse(controls.detach().numpy(), grad_outputs[0].detach().numpy())
        return torch.from_numpy(rows), None


class RigLayer(torch.nn.Module):  # type: ignore[misc]
    """Raw controls to the numbers at a point of the rig (`Point`): JOINTS, CONTROLS, CHANNELS, MAPS, or
    POSITIONS of a mesh, which needs a deformer. Has no parameters.

    The derivatives are those of docs/derivatives.md: at bounds and kinks, one-sided ones. Calls of several
    threads run one after the other; use a layer for each.
    """

    def __init__(self, rig: Rig, deformer: Optional[Deformer] = None, to: int = Point.JOINTS, mesh: int = 0,
                 lod: int = 0) -> None:
        super().__init__()
        if to not in _WIDTHS and to != Point.POSITIONS:
            raise ArgumentError("a layer leads to CONTROLS, JOINTS, CHANNELS, MAPS or POSITIONS")
        if to == Point.POSITIONS and deformer is None:
            raise ArgumentError("positions need the deformer of the rig")
        self._to, self._mesh, self._lod = Point(to), mesh, lod
        self._instance = rig.instance()
        self._pose = deformer.instance() if deformer is not None and to == Point.POSITIONS else None
        self._derivatives = Derivatives(rig, deformer if self._pose is not None else None)
        self._lock = allocate_lock()
        self.in_features = rig.count(Kind.RAW_CONTROL)
        self.out_features = self._derivatives.size(self._to, mesh)

    def forward(self, controls: Any) -> Any:
        """(..., in_features) of torch.float32 on the CPU -> (..., out_features)."""
        if controls.dtype != torch.float32 or controls.device.type != "cpu":
            raise ArgumentError(f"controls are {controls.dtype} on {controls.device}: torch.float32 on the CPU "
                                "is needed")
        if controls.ndim == 0 or controls.shape[-1] != self.in_features:
            raise ArgumentError(f"controls have the shape {tuple(controls.shape)}: (..., {self.in_features}) is "
                                "needed")
        rows = _Evaluate.apply(controls.reshape(-1, self.in_features), self)
        return rows.reshape(*controls.shape[:-1], self.out_features)

    def _set(self, row: Any) -> None:
        self._instance.reset()
        self._instance.raw_controls = row
        self._instance.evaluate(self._lod)

    def _evaluate(self, controls: Any) -> Any:
        out = numpy.empty((len(controls), self.out_features), "f")
        with self._lock:
            for row, result in zip(controls, out):
                self._set(row)
                if self._pose is None:
                    result[:] = getattr(self._instance, _WIDTHS[self._to]).reshape(-1)
                    continue
                self._pose.update(self._instance)
                self._pose.deform(self._mesh, Normals.NONE)
                result[:] = self._pose.positions(self._mesh).reshape(-1)
        return out

    def _reverse(self, controls: Any, gradients: Any) -> Any:
        out = numpy.empty_like(controls)
        with self._lock:
            for row, gradient, result in zip(controls, gradients, out):
                self._set(row)
                self._derivatives.linearize(self._instance)
                result[:] = self._derivatives.vjp(gradient, to=self._to, mesh=self._mesh)
        return out
