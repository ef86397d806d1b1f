"""The network of common/learned in PyTorch, to be trained: the same offsets, strides and names."""
import numpy
import torch
from torch import nn

REACH = 1 << 20  # coordinates lie within it, either way


def codes_of(voxels):
    x, y, z = (voxels.astype(numpy.int64) + REACH).T
    return x | y << 21 | z << 42


def voxels_of(points, voxel_m):
    """The occupied voxels, sorted by code, and the mean of the points in each."""
    voxels = numpy.floor(points / voxel_m).astype(numpy.int64)
    _, first, of = numpy.unique(codes_of(voxels), return_index=True, return_inverse=True)
    count = numpy.bincount(of)[:, None]
    means = numpy.stack([numpy.bincount(of, points[:, axis]) for axis in range(3)], axis=1) / count
    return voxels[first], means


def halved(voxels):
    half = numpy.floor_divide(voxels, 2)
    _, first = numpy.unique(codes_of(half), return_index=True)
    return half[first]


def kernel_map(inputs, outputs, stride, width):
    """Per offset the rows of inputs and outputs that it joins. Both sets are sorted by code."""
    codes, pairs, reach = codes_of(inputs), [], width // 2
    for z in range(-reach, reach + 1):
        for y in range(-reach, reach + 1):
            for x in range(-reach, reach + 1):
                wanted = codes_of(outputs * stride + (x, y, z))
                row = numpy.searchsorted(codes, wanted).clip(max=len(codes) - 1)
                found = numpy.nonzero(codes[row] == wanted)[0]
                pairs.append((torch.from_numpy(row[found]), torch.from_numpy(found)))
    return pairs, len(outputs)


def transposed(of_map, outputs):
    pairs, _ = of_map
    return [(there, here) for here, there in pairs], outputs


class Maps:
    """Of one cloud, for all layers."""

    def __init__(self, voxels, levels, first_width):
        sets = [voxels]
        while len(sets) < levels:
            sets.append(halved(sets[-1]))
        self.first = kernel_map(voxels, voxels, 1, first_width)
        self.point = kernel_map(voxels, voxels, 1, 1)
        self.blocks = [kernel_map(level, level, 1, 3) for level in sets]
        self.down = [kernel_map(fine, coarse, 2, 3) for fine, coarse in zip(sets, sets[1:])]
        self.up = [transposed(down, len(fine)) for down, fine in zip(self.down, sets)]


class Convolution(nn.Module):
    def __init__(self, width, inputs, outputs, bias=False):
        super().__init__()
        volume = width ** 3
        deviation = (2 / (inputs * min(volume, 9))) ** 0.5  # a surface fills about nine of a kernel's 27 voxels
        shape = (inputs, outputs) if volume == 1 else (volume, inputs, outputs)
        self.kernel = nn.Parameter(deviation * torch.randn(shape))
        self.bias = nn.Parameter(torch.zeros(1, outputs)) if bias else None

    def forward(self, x, of_map):
        pairs, count = of_map
        kernel = self.kernel if self.kernel.dim() == 3 else self.kernel[None]
        out = x.new_zeros((count, kernel.shape[2]))
        for (row, to), matrix in zip(pairs, kernel):
            if len(row):
                out = out.index_add(0, to, x[row] @ matrix)
        return out if self.bias is None else out + self.bias


class Norm(nn.Module):
    def __init__(self, channels):
        super().__init__()
        self.bn = nn.BatchNorm1d(channels, momentum=0.05)

    def forward(self, x):
        return self.bn(x)


class Block(nn.Module):
    def __init__(self, channels):
        super().__init__()
        self.conv1, self.norm1 = Convolution(3, channels, channels), Norm(channels)
        self.conv2, self.norm2 = Convolution(3, channels, channels), Norm(channels)

    def forward(self, x, of_map):
        middle = torch.relu(self.norm1(self.conv1(x, of_map)))
        return torch.relu(self.norm2(self.conv2(middle, of_map)) + x)


class Network(nn.Module):
    """A U-net over occupancy: `down` and `up` are channels by level, finest first."""

    def __init__(self, down, up, first_width, dimensions):
        super().__init__()
        self.levels, self.first_width = len(down), first_width
        inputs = 1
        for i, channels in enumerate(down, 1):
            self.add_module(f"conv{i}", Convolution(first_width if i == 1 else 3, inputs, channels))
            self.add_module(f"norm{i}", Norm(channels))
            self.add_module(f"block{i}", Block(channels))
            inputs = channels
        for i in range(len(down), 1, -1):
            self.add_module(f"conv{i}_tr", Convolution(3, inputs, up[i - 1]))
            self.add_module(f"norm{i}_tr", Norm(up[i - 1]))
            self.add_module(f"block{i}_tr", Block(up[i - 1]))
            inputs = up[i - 1] + down[i - 2]
        self.conv1_tr = Convolution(1, inputs, up[0])
        self.final = Convolution(1, up[0], dimensions, bias=True)

    def maps(self, voxels):
        return Maps(voxels, self.levels, self.first_width)

    def forward(self, maps):
        part = self._modules
        x, seen = torch.ones((maps.first[1], 1)), []
        for i in range(self.levels):
            x = part[f"conv{i + 1}"](x, maps.first if i == 0 else maps.down[i - 1])
            x = part[f"block{i + 1}"](part[f"norm{i + 1}"](x), maps.blocks[i])
            seen.append(x)
        for i in range(self.levels - 1, 0, -1):
            x = part[f"norm{i + 1}_tr"](part[f"conv{i + 1}_tr"](x, maps.up[i - 1]))
            x = torch.cat((part[f"block{i + 1}_tr"](x, maps.blocks[i - 1]), seen[i - 1]), dim=1)
        x = self.final(torch.relu(self.conv1_tr(x, maps.point)), maps.point)
        return nn.functional.normalize(x, dim=1)
