#!/usr/bin/env python3
"""Holds the sparse network, and the converter of checkpoints, to dense convolutions of PyTorch.

torch_test.py FORWARD CONVERTER   FORWARD: the program that runs a network on voxels; exit 77: no PyTorch, skipped
"""
import argparse
import collections
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy
    import torch
    import torch.nn.functional as functional
except ImportError:
    print("torch_test: skipped: there is no PyTorch; run deploy/install --torch")
    sys.exit(77)

FORWARD, CONVERTER = sys.argv[1:3]
SIDE = 16  # of the dense grid; its corner is at -8, which all strides divide
PAPER = ((32, 64, 128, 256), (64, 64, 64, 128))
SMALL = ((4, 8, 12), (8, 4, 8))


def random_state(seed, down, up, first_width, dimensions):
    """As FCGF names and shapes them."""
    generator = torch.Generator().manual_seed(seed)
    state = collections.OrderedDict()

    def kernel(name, volume, inputs, outputs):
        shape = (inputs, outputs) if volume == 1 else (volume, inputs, outputs)
        state[name + ".kernel"] = torch.randn(shape, generator=generator) / (min(volume, 8) * inputs) ** 0.5

    def norm(name, channels):
        state[name + ".bn.weight"] = 1 + 0.2 * torch.randn(channels, generator=generator)
        state[name + ".bn.bias"] = 0.2 * torch.randn(channels, generator=generator)
        state[name + ".bn.running_mean"] = 0.2 * torch.randn(channels, generator=generator)
        state[name + ".bn.running_var"] = 0.5 + torch.rand(channels, generator=generator)
        state[name + ".bn.num_batches_tracked"] = torch.tensor(7)

    def block(name, channels):
        for i in "12":
            kernel(f"{name}.conv{i}", 27, channels, channels)
            norm(f"{name}.norm{i}", channels)

    inputs = 1
    for i, channels in enumerate(down, 1):
        kernel(f"conv{i}", first_width ** 3 if i == 1 else 27, inputs, channels)
        norm(f"norm{i}", channels)
        block(f"block{i}", channels)
        inputs = channels
    for i in range(len(down), 1, -1):
        kernel(f"conv{i}_tr", 27, inputs, up[i - 1])
        norm(f"norm{i}_tr", up[i - 1])
        block(f"block{i}_tr", up[i - 1])
        inputs = up[i - 1] + down[i - 2]
    kernel("conv1_tr", 1, inputs, up[0])
    kernel("final", 1, up[0], dimensions)
    state["final.bias"] = 0.1 * torch.randn((1, dimensions), generator=generator)
    return state


class DenseNetwork:
    """The network over [1, channels, x, y, z], masked to the voxels after every layer."""

    def __init__(self, state, occupied):
        self.state = state
        self.levels = sum(f"conv{i}.kernel" in state for i in range(1, 9))
        self.masks = [occupied[None, None].float()]
        while len(self.masks) < self.levels:
            self.masks.append(functional.max_pool3d(self.masks[-1], 2))

    def weight(self, name):
        """[offset, in, out], x fastest, as [out, in, x, y, z]."""
        kernel = self.state[name + ".kernel"].double()
        kernel = kernel if kernel.dim() == 3 else kernel[None]
        width = round(kernel.shape[0] ** (1 / 3))
        return kernel.reshape(width, width, width, *kernel.shape[1:]).permute(4, 3, 2, 1, 0), width

    def layer(self, name, norm, x, level, stride=1, transposed=False):
        weight, width = self.weight(name)
        if transposed:
            x = functional.conv_transpose3d(x, weight.transpose(0, 1), stride=2, padding=1, output_padding=1)
        else:
            x = functional.conv3d(x, weight, stride=stride, padding=width // 2)
        if name + ".bias" in self.state:
            x = x + self.state[name + ".bias"].double().reshape(1, -1, 1, 1, 1)
        if norm:
            field = {key: self.state[f"{norm}.bn.{key}"].double()
                     for key in ("running_mean", "running_var", "weight", "bias")}
            x = functional.batch_norm(x, field["running_mean"], field["running_var"], field["weight"], field["bias"])
        return x * self.masks[level]

    def block(self, name, x, level):
        middle = torch.relu(self.layer(name + ".conv1", name + ".norm1", x, level))
        return torch.relu(self.layer(name + ".conv2", name + ".norm2", middle, level) + x)

    def __call__(self):
        x, seen = self.masks[0].double(), []
        for i in range(self.levels):
            x = self.layer(f"conv{i + 1}", f"norm{i + 1}", x, i, stride=1 if i == 0 else 2)
            x = self.block(f"block{i + 1}", x, i)
            seen.append(x)
        for i in range(self.levels - 1, 0, -1):
            x = self.layer(f"conv{i + 1}_tr", f"norm{i + 1}_tr", x, i - 1, transposed=True)
            x = torch.cat((self.block(f"block{i + 1}_tr", x, i - 1), seen[i - 1]), dim=1)
        x = torch.relu(self.layer("conv1_tr", "", x, 0))
        return functional.normalize(self.layer("final", "", x, 0), dim=1)


def random_room(seed):
    """Occupancy of a grid: three planes and clutter."""
    generator = torch.Generator().manual_seed(seed)
    occupied = torch.rand((SIDE, SIDE, SIDE), generator=generator) < 0.01
    plane = torch.rand((3, SIDE, SIDE), generator=generator) < 0.7
    occupied[5] |= plane[0]
    occupied[:, 9] |= plane[1]
    occupied[:, :, 14] |= plane[2]
    return occupied


class Converted(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.checkpoint, self.weights = self.folder / "model.pth", self.folder / "model.safetensors"

    def convert(self, *options):
        return subprocess.run([sys.executable, CONVERTER, self.checkpoint, self.weights, *options],
                              capture_output=True, text=True)

    def forward(self, voxels):
        (self.folder / "voxels").write_bytes(voxels.astype("<i4").tobytes())
        subprocess.run([FORWARD, self.weights, self.folder / "voxels", self.folder / "rows"], check=True)
        data = (self.folder / "rows").read_bytes()
        dimensions, = struct.unpack_from("<i", data)
        return numpy.frombuffer(data, "<f4", offset=4).reshape(len(voxels), dimensions)

    def save(self, state, config, **options):
        torch.save({"state_dict": state, "config": config, "epoch": 3}, self.checkpoint, **options)

    def check(self, shape, first_width, dimensions, seed, **options):
        state = random_state(seed, *shape, first_width, dimensions)
        config = argparse.Namespace(voxel_size=0.025, model="ResUNetBN2C", normalize_feature=True)
        self.save(state, config, **options)
        done = self.convert()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"ResUNetBN2C, {dimensions} dimensions, first kernel {first_width} wide", done.stdout)
        occupied = random_room(seed)
        voxels = occupied.nonzero().numpy()
        dense = DenseNetwork(state, occupied)()[0][:, occupied].T.numpy()
        difference = numpy.abs(self.forward(voxels - SIDE // 2) - dense).max()
        print(f"{len(voxels)} voxels, {dimensions} dimensions, first kernel {first_width}: off by {difference:.1e}")
        self.assertLess(difference, 1e-5)

    def test_small_is_the_dense_one(self):
        for seed in range(3):
            self.check(SMALL, 3, 8, seed)

    def test_the_papers_are_the_dense_ones(self):
        self.check(PAPER, 7, 32, 1)
        self.check(PAPER, 5, 16, 2)

    def test_old_files_of_torch_are_read(self):
        self.check(SMALL, 5, 16, 4, _use_new_zipfile_serialization=False)

    def test_voxel_size_is_asked_for(self):
        self.save(random_state(1, *SMALL, 3, 8), None)
        done = self.convert()
        self.assertEqual(done.returncode, 2)
        self.assertIn("--voxel", done.stderr)
        self.assertEqual(self.convert("--voxel", "0.05").returncode, 0)
        self.assertIn(b'"voxel_size_m":"0.05"', self.weights.read_bytes())

    def test_other_networks_are_refused(self):
        state = random_state(1, *SMALL, 3, 8)
        for gone, told in (("conv1.kernel", "conv1.kernel"), ("block1.norm1.bn.running_mean", "batch norms")):
            self.save({name: value for name, value in state.items() if name != gone}, {"voxel_size": 0.025})
            done = self.convert()
            self.assertEqual(done.returncode, 2)
            self.assertIn(told, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertFalse(self.weights.exists())

    def test_what_is_no_checkpoint_is_refused(self):
        for data in (b"", b"PK\3\4", b"\x80\x02}q\0."):
            self.checkpoint.write_bytes(data)
            done = self.convert("--voxel", "0.025")
            self.assertEqual(done.returncode, 2)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)

    def test_a_program_of_torchscript_is_refused(self):
        class Doubling(torch.nn.Module):
            def forward(self, x):
                return 2 * x

        torch.jit.save(torch.jit.script(Doubling()), str(self.checkpoint))
        done = self.convert("--voxel", "0.025")
        self.assertEqual(done.returncode, 2)
        self.assertIn("TorchScript", done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)

    def test_nothing_of_a_checkpoint_is_run(self):
        proof = self.folder / "proof"

        class Harm:
            def __reduce__(self):
                return pathlib.Path.touch, (proof,)

        self.save(random_state(1, *SMALL, 3, 8), Harm())
        self.convert("--voxel", "0.025")
        self.assertFalse(proof.exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
