#!/usr/bin/env python3
"""Training: what it learns with is what LiLoc runs, and an interrupted run ends where an undisturbed one does.

training_test.py FORWARD TRAIN   FORWARD: the program that runs a network on voxels; exit 77: no PyTorch, skipped
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

try:
    import numpy
    import torch
    from PIL import Image

    import convert_fcgf
    from training import recordings, sparse_network
except ImportError:
    print("training_test: skipped: there is no PyTorch or Pillow; run deploy/install --torch")
    sys.exit(77)

FORWARD, TRAIN = sys.argv[1:3]
ROOM_M = numpy.array([4.0, 3.0, 2.6])
SIDE_M = 0.7  # of a box in it
CAMERA = {"width": 48, "height": 36, "fx": 30, "fy": 30, "cx": 24, "cy": 18, "depth_scale": 0.001}
# Looking level along x, with the image's y down; and straight down.
LEVEL, DOWN = (-0.5, 0.5, -0.5, 0.5), (1, 0, 0, 0)


def depth_image(T_map_sensor):
    """Of a room with a box in a corner: where rays leave the one or enter the other."""
    camera = recordings.Camera(CAMERA)
    rays, at = camera.rays @ T_map_sensor[:3, :3].T, T_map_sensor[:3, 3]
    with numpy.errstate(divide="ignore", invalid="ignore"):
        leaves = numpy.maximum(-at / rays, (ROOM_M - at) / rays).min(-1)
        near, far = (0.0 - at) / rays, (SIDE_M - at) / rays
        enters = numpy.minimum(near, far).max(-1)
        hit = (enters < numpy.maximum(near, far).min(-1)) & (enters > 0)
    depth_m = numpy.where(hit, numpy.minimum(enters, leaves), leaves)
    return numpy.round(depth_m * 1000).astype(numpy.uint16)


def write_recording(root):
    stamps_ns = [10**9 + i * 10**8 for i in range(4)]
    lidars, poses = [], {}
    for i, at in enumerate(((1.0, 1.0, 2.5), (3.0, 2.0, 2.5))):
        lidars.append({"id": f"ceiling{i}", **CAMERA, "T_map_sensor": {"translation": at, "rotation_xyzw": DOWN}})
        poses[root / "global" / f"ceiling{i}"] = [(at, DOWN)] * len(stamps_ns)
    track = [((1.0 + 0.3 * i, 1.5, 1.2), LEVEL) for i in range(len(stamps_ns))]
    poses[root / "devices" / "device0"] = track
    for folder, track_of in poses.items():
        (folder / "depth").mkdir(parents=True)
        for stamp_ns, (at, turn) in zip(stamps_ns, track_of):
            Image.fromarray(depth_image(recordings.pose_of(at, turn))).save(folder / "depth" / f"{stamp_ns}.png")
    (root / "site.json").write_text(json.dumps({"world_frame": "map", "global_lidars": lidars}))
    device = root / "devices" / "device0"
    (device / "device.json").write_text(json.dumps(CAMERA))
    (device / "groundtruth.tum").write_text("# stamp\n" + "".join(
        f"{stamp / 1e9:.6f} " + " ".join(str(value) for value in (*at, *turn)) + "\n"
        for stamp, (at, turn) in zip(stamps_ns, track)))


class Training(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        write_recording(self.folder / "room")

    def train(self, out, *options):
        return subprocess.run(
            [sys.executable, "-B", TRAIN, self.folder / out, "--train", self.folder / "room", "--test",
             self.folder / "room", "--down", "2-4", "--up", "4-2", "--first-width", "3", "--dimensions", "4",
             "--steps", "3", "--every", "2", "--test-pairs", "1", "--threads", "1", *options],
            capture_output=True, text=True)

    def test_pairs_lie_on_each_other(self):
        recording = recordings.Recording(self.folder / "room")
        self.assertEqual(len(recording.moments), 4)
        pair = recording.pair(1)
        seen = recordings.moved(pair.T_ceiling_device, pair.device)
        for cloud in (seen, pair.ceiling):
            self.assertGreater(len(cloud), 1000)
            off = numpy.minimum(numpy.abs(cloud), numpy.abs(cloud - ROOM_M)).min(1)
            box = (numpy.abs(cloud - SIDE_M).min(1) < 0.01) & (cloud < SIDE_M + 0.01).all(1)
            self.assertTrue(((off < 0.01) | box).all(), "a point is on no surface")
        self.assertTrue(numpy.allclose(pair.T_ceiling_device[2, :3], (0, 0, 1)), "the device's cloud stands upright")

    def test_what_learns_is_what_runs(self):
        torch.manual_seed(5)
        network = sparse_network.Network((4, 8), (6, 4), 5, 7)
        voxels, _ = sparse_network.voxels_of(numpy.random.default_rng(5).uniform(-1, 1, (800, 3)), 0.1)
        for _ in range(3):
            network(network.maps(voxels))  # so that its norms have seen something
        network.eval()
        with torch.no_grad():
            expected = network(network.maps(voxels)).numpy()
        arrays = {name: (list(value.shape), value.numpy().astype("<f4").tobytes())
                  for name, value in network.state_dict().items() if name.endswith(convert_fcgf.USED)}
        convert_fcgf.write_safetensors(self.folder / "w", arrays, {"voxel_size_m": "0.1"})
        (self.folder / "voxels").write_bytes(voxels.astype("<i4").tobytes())
        subprocess.run([FORWARD, self.folder / "w", self.folder / "voxels", self.folder / "rows"], check=True)
        data = (self.folder / "rows").read_bytes()
        self.assertEqual(struct.unpack_from("<i", data), (7,))
        rows = numpy.frombuffer(data, "<f4", offset=4).reshape(-1, 7)
        self.assertLess(numpy.abs(rows - expected).max(), 1e-5)

    def test_an_interrupted_run_ends_at_the_same_weights(self):
        whole = self.train("whole")
        self.assertEqual(whole.returncode, 0, whole.stderr)
        codes = [self.train("parts", "--minutes", "0").returncode for _ in range(3)]
        self.assertEqual(codes, [1, 1, 0])
        for out in ("whole", "parts"):
            self.assertTrue((self.folder / out / "log.csv").read_text().startswith("step,loss"))
        self.assertEqual((self.folder / "whole" / "weights.safetensors").read_bytes(),
                         (self.folder / "parts" / "weights.safetensors").read_bytes())

    def test_other_options_do_not_go_on(self):
        self.assertEqual(self.train("out", "--steps", "1").returncode, 0)
        other = self.train("out", "--seed", "2")
        self.assertEqual(other.returncode, 2)
        self.assertIn("other options", other.stderr)

    def test_what_is_no_recording_is_refused(self):
        (self.folder / "room" / "site.json").unlink()
        done = self.train("out")
        self.assertEqual(done.returncode, 2)
        self.assertIn("site.json", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
