#!/usr/bin/env python3
"""Makes the weights file of `--features learned --weights FILE` of an FCGF checkpoint (ResUNetBN2, any letter).

convert_fcgf.py CHECKPOINT.pth WEIGHTS.safetensors [--voxel METRES]
Needs PyTorch (deploy/install --torch), and not MinkowskiEngine. The checkpoint is read without running anything that
it may hold. Arrays keep their names and order: batch norms are folded when the file is loaded. Exit codes: 0 done,
1 failed, 2 bad usage or input.
"""
import argparse
import collections
import json
import os
import pathlib
import pickle
import struct
import sys
import types
import zipfile

USED = (".kernel", ".bias", ".bn.weight", ".bn.bias", ".bn.running_mean", ".bn.running_var")


class BadInput(Exception):
    """What is wrong with the checkpoint, in one line."""


class Settings(dict):
    """Stands for any class that a checkpoint names: keeps its fields and runs nothing."""

    def __init__(self, *_, **__):
        super().__init__()

    def __setstate__(self, state):
        for part in state if isinstance(state, tuple) else (state,):
            if isinstance(part, dict):
                self.update(part)


class Unpickler(pickle.Unpickler):
    """Makes tensors, plain values and Settings, and calls nothing else."""

    def find_class(self, module, name):
        import torch
        if module == "collections" and name == "OrderedDict":
            return collections.OrderedDict
        if module == "torch._utils" and name in ("_rebuild_tensor_v2", "_rebuild_tensor", "_rebuild_parameter"):
            return getattr(torch._utils, name)
        if module == "torch" and (name.endswith("Storage") or name == "Size"):
            return getattr(torch, name)
        return Settings


def safe_pickle():
    """The module pickle, as torch.load takes it, with the Unpickler above."""
    module = types.ModuleType("safe_pickle")
    vars(module).update({name: value for name, value in vars(pickle).items() if not name.startswith("__")})
    module.Unpickler = Unpickler
    module.load = lambda file, **options: Unpickler(file, **options).load()
    return module


def refuse_script(path):
    """TorchScript is code: torch.load hands it to torch.jit.load, and no unpickler of ours is asked."""
    raise BadInput(f"{path}: is a TorchScript program, which could run anything; save its state_dict() by torch.save")


def is_script(path):
    """Whether torch.load would take the file for one: a zip with constants.pkl."""
    if not zipfile.is_zipfile(path):
        return False
    with zipfile.ZipFile(path) as archive:
        return any(pathlib.PurePosixPath(name).name == "constants.pkl" for name in archive.namelist())


def load(path):
    if is_script(path):
        refuse_script(path)
    import torch.jit
    import torch.serialization
    safe, usual, usual_jit = safe_pickle(), torch.serialization.pickle, torch.jit.load
    torch.serialization.pickle = safe  # PyTorch 1.13 overlooks pickle_module
    torch.jit.load = lambda *_, **__: refuse_script(path)  # for a zip that PyTorch reads otherwise than Python
    try:
        return torch.load(str(path), map_location="cpu", pickle_module=safe, weights_only=False)
    finally:
        torch.serialization.pickle, torch.jit.load = usual, usual_jit


def read_checkpoint(path):
    """Its arrays by name, and the settings that it was trained with."""
    if not path.is_file():
        raise BadInput(f"{path}: no such file")
    try:
        checkpoint = load(path)
    except BadInput:
        raise
    except Exception as error:  # pickle, zip and torch have dozens of their own
        raise BadInput(f"{path}: is no checkpoint of PyTorch: {str(error).splitlines()[0] if str(error) else error!r}")
    if not isinstance(checkpoint, dict):
        raise BadInput(f"{path}: holds no dictionary")
    state = checkpoint.get("state_dict", checkpoint)
    if not isinstance(state, dict):
        raise BadInput(f"{path}: its state_dict is no dictionary")
    config = checkpoint.get("config")
    return state, config if isinstance(config, dict) else {}


def used_arrays(path, state):
    """Name, shape and bytes of each array of the network."""
    import torch
    arrays = {}
    for name, value in state.items():
        name = str(name).removeprefix("module.")  # of a network that several GPUs trained
        if isinstance(value, torch.Tensor) and name.endswith(USED):
            value = value.detach().to(torch.float32).contiguous()
            if not torch.isfinite(value).all():
                raise BadInput(f"{path}: {name} has values that are no numbers")
            arrays[name] = (list(value.shape), value.numpy().astype("<f4").tobytes())
    if "conv1.kernel" not in arrays or "final.kernel" not in arrays:
        raise BadInput(f"{path}: has no conv1.kernel and final.kernel; this converts ResUNetBN2 of FCGF")
    if "norm1.bn.running_mean" not in arrays or "block1.norm1.bn.running_mean" not in arrays:
        raise BadInput(f"{path}: its layers have no batch norms; ResUNetIN2 and others are not supported")
    return arrays


def write_safetensors(path, arrays, about):
    """Appears whole or not at all: what stood there stays until all is written."""
    header, begin = {"__metadata__": about}, 0
    for name, (shape, data) in arrays.items():
        header[name] = {"dtype": "F32", "shape": shape, "data_offsets": [begin, begin + len(data)]}
        begin += len(data)
    text = json.dumps(header, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 8)
    part = path.with_name(f".{path.name}.part")
    try:
        with open(part, "wb") as file:
            file.write(struct.pack("<Q", len(text)) + text)
            for _, data in arrays.values():
                file.write(data)
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


def convert(checkpoint, weights, voxel_m):
    state, config = read_checkpoint(checkpoint)
    arrays = used_arrays(checkpoint, state)
    voxel_m = config.get("voxel_size") if voxel_m is None else voxel_m
    if not isinstance(voxel_m, float) or not 0.005 <= voxel_m <= 1:
        raise BadInput(f"{checkpoint}: does not say its voxel size; add --voxel with 0.005 to 1 m")
    normalize = config.get("normalize_feature", True) is not False
    about = {"voxel_size_m": repr(voxel_m), "normalize": "true" if normalize else "false",
             "network": str(config.get("model", "ResUNetBN2"))}
    write_safetensors(weights, arrays, about)
    width = round(arrays["conv1.kernel"][0][0] ** (1 / 3))
    count = sum(len(data) // 4 for _, data in arrays.values())
    print(f"{weights}: {about['network']}, {arrays['final.kernel'][0][-1]} dimensions, first kernel {width} wide, "
          f"voxels of {voxel_m} m, {count} numbers")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("checkpoint", type=pathlib.Path, help="what FCGF's training or its authors saved (.pth)")
    parser.add_argument("weights", type=pathlib.Path, help="the file to write (.safetensors)")
    parser.add_argument("--voxel", type=float, help="voxel size that it was trained at, in metres; else as it says")
    arguments = parser.parse_args()
    try:
        import torch  # noqa: F401
    except ImportError:
        print("convert_fcgf: PyTorch is not installed; run deploy/install --torch", file=sys.stderr)
        return 1
    try:
        convert(arguments.checkpoint, arguments.weights, arguments.voxel)
    except BadInput as error:
        print(f"convert_fcgf: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"convert_fcgf: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
