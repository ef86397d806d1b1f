"""What a depth camera sees that walks through a room made of boxes."""
import numpy as np

WIDTH, HEIGHT, FOCAL_PX, UNIT_M = 160, 120, 115.0, 0.001
FRAMES, STEP_M, TURN_RAD = 30, 0.02, 0.008
BOXES = np.array([[[0, 0, 0], [6, 5, 2.7]], [[4.2, 3.1, 0], [4.9, 3.7, 1.1]], [[5.3, 2.0, 0], [6.0, 2.6, 1.8]],
                  [[3.0, 4.5, 0], [4.0, 5.0, 0.8]]])


def stamp_ns(frame):
    return 1_700_000_000_000_000_000 + frame * 66_666_667


def T_map_sensor(frame):
    """Looks at a corner, a little downwards; one step along x per frame."""
    yaw, pitch = 0.6 + frame * TURN_RAD, 0.25
    ahead = np.array([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), -np.sin(pitch)])
    right = np.array([np.sin(yaw), -np.cos(yaw), 0])
    T = np.eye(4)
    T[:3, :3] = np.column_stack([right, np.cross(ahead, right), ahead])
    T[:3, 3] = [1.8 + frame * STEP_M, 1.6, 1.2]
    return T


def render(frame):
    """uint16, HEIGHT x WIDTH."""
    T = T_map_sensor(frame)
    v, u = np.mgrid[0:HEIGHT, 0:WIDTH]
    along = np.dstack([(u - (WIDTH - 1) / 2) / FOCAL_PX, (v - (HEIGHT - 1) / 2) / FOCAL_PX, np.ones(u.shape)])
    along = along @ T[:3, :3].T
    hits = (BOXES[:, :, None, None, :] - T[:3, 3]) / np.where(np.abs(along) < 1e-12, 1e-12, along)
    enter, leave = hits.min(axis=1).max(axis=-1), hits.max(axis=1).min(axis=-1)
    depth = np.where((enter > leave) | (leave < 0), np.inf, np.where(enter > 0, enter, leave)).min(axis=0)
    return np.round(depth / UNIT_M).astype(np.uint16)
