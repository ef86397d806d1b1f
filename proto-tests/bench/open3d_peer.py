#!/usr/bin/env python3
"""Open3D's FPFH and RANSAC on pairs of clouds, for liloc_spot_bench.

open3d_peer.py FOLDER   for each i: reads i.source and i.target (float32 x, y, z, nx, ny, nz), writes answers.txt:
a line of the 4x4 that maps source into target, the milliseconds it took and those of the target's features.
Threads are those of OMP_NUM_THREADS. Exit code 3: there is no Open3D.
"""
import pathlib
import sys
import time

try:
    import numpy as np
    import open3d as o3d
except ImportError as missing:
    print(f"open3d_peer.py: {missing}; deploy/install --peers brings it", file=sys.stderr)
    sys.exit(3)

VOXEL = 0.05
REGISTRATION = o3d.pipelines.registration


def cloud(path):
    values = np.fromfile(path, np.float32).reshape(-1, 6).astype(float)
    points = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(values[:, :3]))
    points.normals = o3d.utility.Vector3dVector(values[:, 3:])
    return points


def features(points):
    return REGISTRATION.compute_fpfh_feature(points, o3d.geometry.KDTreeSearchParamHybrid(5 * VOXEL, 100))


def align(source, source_features, target, target_features):
    found = REGISTRATION.registration_ransac_based_on_feature_matching(
        source, target, source_features, target_features, True, 1.5 * VOXEL,
        REGISTRATION.TransformationEstimationPointToPoint(False), 3,
        [REGISTRATION.CorrespondenceCheckerBasedOnEdgeLength(0.9),
         REGISTRATION.CorrespondenceCheckerBasedOnDistance(1.5 * VOXEL)],
        REGISTRATION.RANSACConvergenceCriteria(1_000_000, 0.999))
    return REGISTRATION.registration_icp(source, target, 1.5 * VOXEL, found.transformation,
                                         REGISTRATION.TransformationEstimationPointToPlane()).transformation


def main(folder):
    o3d.utility.random.seed(1)
    with open(folder / "answers.txt", "w") as answers:
        for i in range(len(list(folder.glob("*.source")))):
            source, target = cloud(folder / f"{i}.source"), cloud(folder / f"{i}.target")
            start = time.perf_counter()
            target_features = features(target)
            described = time.perf_counter()
            T = align(source, features(source), target, target_features)
            done = time.perf_counter()
            numbers = [*np.asarray(T).ravel(), 1e3 * (done - described), 1e3 * (described - start)]
            print(*(f"{x:.9g}" for x in numbers), file=answers)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    main(pathlib.Path(sys.argv[1]))
