"""Pairs of clouds out of recordings: what the ceiling sees of a room, and what a device sees at the same moment."""
import collections
import json
import pathlib

import numpy
from PIL import Image

NO_RETURN = 65535          # besides 0, as common/geometry has it
MOST_APART_NS = 100_000_000  # of frames of one moment, as the server has it

# The clouds stand upright and in metres; T_ceiling_device maps one into the other, to which no turn about z was given.
Pair = collections.namedtuple("Pair", "ceiling device T_ceiling_device")


class Camera:
    def __init__(self, fields):
        self.width, self.height = fields["width"], fields["height"]
        self.scale_m = fields["depth_scale"]
        u, v = numpy.meshgrid(numpy.arange(self.width), numpy.arange(self.height))
        self.rays = numpy.stack(((u - fields["cx"]) / fields["fx"], (v - fields["cy"]) / fields["fy"],
                                 numpy.ones(u.shape)), axis=-1)

    def cloud(self, file, farthest_m=9.0):
        """The points of a depth image, sensor frame."""
        units = numpy.asarray(Image.open(file)).astype(numpy.int64)
        if units.shape != (self.height, self.width):
            raise ValueError(f"{file}: is {units.shape[1]}x{units.shape[0]}, not {self.width}x{self.height}")
        depth_m = units * self.scale_m
        seen = (units > 0) & (units != NO_RETURN) & (depth_m < farthest_m)
        return self.rays[seen] * depth_m[seen][:, None]


def pose_of(translation, rotation_xyzw):
    x, y, z, w = numpy.asarray(rotation_xyzw) / numpy.linalg.norm(rotation_xyzw)
    T = numpy.eye(4)
    T[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                 [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    T[:3, 3] = translation
    return T


def moved(T_to_from, points):
    return points @ T_to_from[:3, :3].T + T_to_from[:3, 3]


def frames_of(folder):
    """Depth images by stamp."""
    return {int(file.stem): file for file in sorted((folder / "depth").glob("*.png"))}


class Recording:
    """A folder of `liloc sim`, or of any recording with ground truth."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        site = json.loads((self.root / "site.json").read_text())
        self.ceiling = [(Camera(lidar), pose_of(**lidar["T_map_sensor"]), frames_of(self.root / "global" / lidar["id"]))
                        for lidar in site["global_lidars"]]
        self.moments = []  # camera, image, stamp and T_map_sensor of every device frame
        for folder in sorted((self.root / "devices").iterdir()):
            camera, images = Camera(json.loads((folder / "device.json").read_text())), frames_of(folder)
            for stamp_ns, T_map_sensor in self.truth(folder / "groundtruth.tum"):
                nearest = min(images, key=lambda stamp: abs(stamp - stamp_ns), default=None)
                if nearest is not None and abs(nearest - stamp_ns) < 1_000_000:
                    self.moments.append((camera, images[nearest], nearest, T_map_sensor))

    @staticmethod
    def truth(file):
        for line in file.read_text().splitlines():
            if line and not line.startswith("#"):
                stamp, *values = line.split()
                seconds, _, part = stamp.partition(".")
                values = [float(value) for value in values]
                yield int(seconds) * 10**9 + int((part + "0" * 9)[:9]), pose_of(values[:3], values[3:])

    def ceiling_cloud(self, stamp_ns):
        """Map frame."""
        clouds = [numpy.empty((0, 3))]
        for camera, T_map_sensor, frames in self.ceiling:
            nearest = min(frames, key=lambda stamp: abs(stamp - stamp_ns), default=None)
            if nearest is not None and abs(nearest - stamp_ns) <= MOST_APART_NS:
                clouds.append(moved(T_map_sensor, camera.cloud(frames[nearest])))
        return numpy.concatenate(clouds)

    def pair(self, moment):
        camera, image, stamp_ns, T_map_sensor = self.moments[moment]
        # Gravity is known, the heading is not: a frame that stands upright, at the device.
        forward = T_map_sensor[:3, 2]
        yaw = numpy.arctan2(forward[1], forward[0])
        T_map_upright = pose_of(T_map_sensor[:3, 3], (0, 0, numpy.sin(yaw / 2), numpy.cos(yaw / 2)))
        device = moved(numpy.linalg.inv(T_map_upright) @ T_map_sensor, camera.cloud(image, 6.0))
        return Pair(self.ceiling_cloud(stamp_ns), device, T_map_upright)
