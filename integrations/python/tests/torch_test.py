# SPDX-License-Identifier: MIT
"""Rigs as layers of PyTorch: values are those of instances, gradients agree with differences, fits converge."""
import sys
import unittest

import mien
from support import dna_of, numpy, pattern, rig_of

try:
    import torch
    import mien.torch
except ImportError:
    print("NOT TESTED: mien.torch; this interpreter has no PyTorch (python3-torch)", file=sys.stderr)
    torch = None


@unittest.skipIf(torch is None, "NOT TESTED: mien.torch; this interpreter has no PyTorch")
class Layers(unittest.TestCase):
    def setUp(self):
        self.deformer = mien.Deformer(dna_of(), rig_of())
        self.layers = [mien.torch.RigLayer(rig_of()),
                       mien.torch.RigLayer(rig_of(), to=mien.Point.CHANNELS),
                       mien.torch.RigLayer(rig_of(), to=mien.Point.CONTROLS),
                       mien.torch.RigLayer(rig_of(), self.deformer, mien.Point.POSITIONS)]
        self.count = self.layers[0].in_features
        self.rows = torch.tensor([[0.1 + 0.7 * value for value in pattern(self.count, phase)] for phase in range(3)])

    def test_values(self):
        face, pose = rig_of().instance(), self.deformer.instance()
        found = [layer(self.rows) for layer in self.layers]
        for r, row in enumerate(self.rows):
            face.raw_controls = row.numpy()
            face.evaluate()
            pose.update(face)
            pose.deform(0)
            wanted = face.joints, face.blend_shapes, face.controls, pose.positions(0)
            for values, expected in zip(found, wanted):
                numpy.testing.assert_array_equal(values[r].numpy(), expected.reshape(-1))
        shaped = self.layers[0](self.rows.reshape(1, 3, self.count))
        self.assertEqual(shaped.shape, (1, 3, self.layers[0].out_features))
        self.assertTrue(torch.equal(shaped[0], found[0]))
        self.assertEqual(self.layers[0](self.rows[:0]).shape, (0, self.layers[0].out_features))

    def test_gradients_agree_with_differences(self):
        generator = torch.Generator().manual_seed(3)
        for layer in self.layers:
            rows = self.rows.clone().requires_grad_()
            weights = torch.randn(3, layer.out_features, generator=generator)
            (layer(rows) * weights).sum().backward()
            direction, step = torch.randn(self.rows.shape, generator=generator), 1e-3
            with torch.no_grad():
                ends = [layer(self.rows + sign * step * direction) for sign in (1, -1)]
            wanted = (((ends[0] - ends[1]).double() / (2 * step)) * weights).sum(1)
            found = (rows.grad * direction).sum(1).double()
            scale = ((ends[0] - ends[1]).norm(dim=1) / (2 * step) * weights.norm(dim=1)).double()
            self.assertTrue(((found - wanted).abs() < 5e-3 * scale).all(), (layer._to, found, wanted, scale))

    def test_a_fit(self):
        layer = self.layers[0]
        with torch.no_grad():
            target = layer(self.rows)
        rows = torch.full_like(self.rows, 0.5, requires_grad=True)
        optimizer = torch.optim.Adam([rows], lr=0.05)
        losses = []
        for _ in range(60):
            optimizer.zero_grad()
            loss = (layer(rows) - target).square().mean()
            loss.backward()
            optimizer.step()
            losses.append(loss.item())
        self.assertLess(losses[-1], 0.05 * losses[0])

    def test_wrong_arguments(self):
        layer = self.layers[0]
        for wrong in (torch.zeros(self.count + 1), torch.zeros(self.count, dtype=torch.float64), torch.tensor(1.0)):
            with self.assertRaises(mien.ArgumentError):
                layer(wrong)
        for wrong in (dict(to=mien.Point.GUI), dict(to=mien.Point.POSITIONS)):
            with self.assertRaises(mien.ArgumentError):
                mien.torch.RigLayer(rig_of(), **wrong)


if __name__ == "__main__":
    unittest.main()
