"""LiLoc for a robot in Python: push depth frames and IMU samples, read the pose.

    import liloc
    camera = liloc.Camera(640, 480, fx=460, fy=460, cx=319.5, cy=239.5, depth_scale_m=0.00025)
    with liloc.Client("robot1", camera) as client:
        client.push_depth(depth, stamp_ns)        # uint16, height x width; returns at once
        pose = client.wait(newer_than_ns=0)       # None after a second without a frame
        if pose and pose.T_map_sensor is not None:
            drive(pose.T_map_sensor)              # 4x4 float64

Metres and radians; stamps are integer nanoseconds of the device's clock. Optical frame: x right, y down, z forward.
Poses are 4x4 matrices, p_to = T_to_from @ p_from. __init__.pyi documents every call.
"""
from ._liloc import Camera, Client, Error, PoseUpdate, Reply, State, Stats, __version__, set_log

__all__ = ["Camera", "Client", "Error", "PoseUpdate", "Reply", "State", "Stats", "__version__", "set_log"]
for _name in ("Camera", "Client", "PoseUpdate", "Reply", "State", "Stats"):
    globals()[_name].__module__ = __name__
del _name
