"""Threads: every call is safe from any thread, and those that wait do so without the GIL. Callbacks run on the
client's own threads with the GIL: on_pose on the registration thread for every processed frame (a slow one delays
the next frame), on_reply on the network thread. What a callback raises goes to sys.unraisablehook."""
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import ClassVar, Literal, Optional, Union

import numpy as np
import numpy.typing as npt

__all__ = ["Camera", "Client", "Error", "PoseUpdate", "Reply", "State", "Stats", "__version__", "set_log"]
__version__: str

class Error(RuntimeError):
    """The network, the file system, or a client that was stopped; the text says how to mend it."""

class Camera:
    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    depth_scale_m: float  # metres per unit of a depth image
    def __init__(
        self, width: int, height: int, fx: float, fy: float, cx: float, cy: float, depth_scale_m: float = 0.001
    ) -> None: ...

class State:
    """SEARCHING: never located. TRACKING: located, the server answers. COASTING: located once, and carried on by
    the device alone. LOST: located once, but the pose's standard deviation exceeds lost_sd_m or lost_sd_deg."""

    SEARCHING: ClassVar[State]
    TRACKING: ClassVar[State]
    COASTING: ClassVar[State]
    LOST: ClassVar[State]
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class PoseUpdate:
    @property
    def stamp_ns(self) -> int:
        """Of the frame; 0 before the first."""
    @property
    def T_map_sensor(self) -> Optional[npt.NDArray[np.float64]]:
        """4x4; None until an answer was verified."""
    @property
    def T_odom_sensor(self) -> npt.NDArray[np.float64]:
        """4x4; smooth; corrections do not move it."""
    @property
    def odom_segment(self) -> int:
        """Rises when the odometry broke."""
    @property
    def informative(self) -> bool:
        """The frame showed enough to be matched."""
    @property
    def converged(self) -> bool:
        """Its pose was measured, not guessed."""
    @property
    def state(self) -> State: ...
    @property
    def server_connected(self) -> bool: ...
    @property
    def observed(self) -> npt.NDArray[np.float64]:
        """6: share of a motion along each axis of the sensor that the frame showed, [rotation; translation], 0..1.
        Near 0 along a bare wall, where the pose follows the prediction; all 0 for a guess, and with
        local="external"."""
    @property
    def covariance(self) -> npt.NDArray[np.float64]:
        """6x6, of T_map_sensor, sensor frame, [rad; m]: that of the last verified answer, carried on by what the
        odometry may have erred since. All 0 where there is no T_map_sensor."""

class Reply:
    @property
    def stamp_ns(self) -> int:
        """Of the frame that was asked about."""
    @property
    def verified(self) -> bool: ...
    @property
    def status(self) -> str: ...
    @property
    def reason(self) -> str: ...
    @property
    def text(self) -> str:
        """For people."""
    @property
    def T_map_sensor(self) -> Optional[npt.NDArray[np.float64]]:
        """4x4; the server's own best answer for that frame."""
    @property
    def covariance(self) -> npt.NDArray[np.float64]:
        """6x6 of T_map_sensor, sensor frame, [rad; m]."""
    @property
    def latency_ms(self) -> float:
        """On the server."""
    @property
    def confidence(self) -> float:
        """Probability that T_map_sensor is within 10 degrees and 0.3 m of the truth."""
    @property
    def advice(self) -> str:
        """What would help where it is not verified: wait, turn_around, move_on, more_coverage, twin, clear_view."""

class Stats:
    @property
    def frames(self) -> int:
        """Processed."""
    @property
    def frames_dropped(self) -> int:
        """The queue was full."""
    @property
    def frames_refused(self) -> int:
        """Unusable: wrong size, or a stamp that was not newer, far off or in another unit."""
    @property
    def frames_uninformative(self) -> int: ...
    @property
    def imu_refused(self) -> int: ...
    @property
    def requests(self) -> int: ...
    @property
    def requests_unsent(self) -> int: ...
    @property
    def requests_unanswered(self) -> int: ...
    @property
    def replies(self) -> int: ...
    @property
    def replies_verified(self) -> int: ...
    @property
    def replies_refused(self) -> int: ...
    @property
    def frame_ms_median(self) -> float:
        """Over the last 512 frames."""
    @property
    def frame_ms_p99(self) -> float: ...
    @property
    def frames_skipped(self) -> int:
        """Left out because the computer, or its share, is too small."""
    @property
    def odometry_refused(self) -> int: ...
    @property
    def cpu_s(self) -> float:
        """CPU time of the registration so far."""
    @property
    def clock_offset_ms(self) -> float:
        """How far the device's clock runs ahead of the ceiling's, by the frames' stamps and the exchanges with the
        server."""
    @property
    def clock_round_trip_ms(self) -> float: ...
    @property
    def clock_good(self) -> bool:
        """Known well enough to be used where it matters."""
    @property
    def clock_jumps(self) -> int:
        """A clock was set; what was learned of it is forgotten."""
    @property
    def problem(self) -> str:
        """What is wrong with the input now, for people; empty: nothing was noticed."""
    @property
    def localized_s(self) -> float:
        """Of the device's time, with a global pose; cpu_s over it is what a second costs."""

class Client:
    """Runs from its making to stop(), the end of its `with` block, or the end of the program."""

    def __init__(
        self,
        id: str,
        camera: Camera,
        *,
        domain: int = 0,
        network_interface: str = "lo",
        peers: Sequence[str] = ...,
        min_range_m: float = 0.25,
        max_range_m: float = 8.5,
        voxel_size_m: float = 0.05,
        interval_ms: int = 800,
        reply_timeout_ms: int = 4000,
        local: Literal["cloud", "inertial", "dead_reckoning", "external"] = "cloud",
        T_imu_sensor: Optional[npt.ArrayLike] = None,
        still_seconds: float = 0.0,
        cold: bool = False,
        seed: int = 1,
        queue_frames: int = 4,
        trace_folder: str = "",
        T_base_sensor: Optional[npt.ArrayLike] = None,
        cpu_share: float = 1.0,
        submap: bool = True,
        request_bytes: int = 15000,
        searching_interval_ms: int = 0,
        lost_sd_m: float = 0.3,
        lost_sd_deg: float = 10,
        codec: Literal["draco", "voxel", "octree"] = "draco",
        credentials: str = "",
        on_pose: Optional[Callable[[PoseUpdate], object]] = None,
        on_reply: Optional[Callable[[Reply], object]] = None,
    ) -> None:
        """Options as in liloc/client.hpp; T_imu_sensor is 4x4, and there is an IMU exactly where it is given.
        Raises ValueError for an option out of its range, Error when the network says no. A server that is not there
        is no error: the client waits for it."""
    def push_depth(self, depth: npt.NDArray[np.uint16], stamp_ns: int) -> None:
        """z-depth, height x width, 0 = no return; copied. A full queue drops its oldest frame. Raises TypeError for
        another dtype, ValueError for another size than the camera's, Error after stop."""
    def push_imu(self, stamps_ns: Union[int, npt.NDArray[np.int64]], samples: npt.ArrayLike) -> None:
        """One stamp and six values, or N stamps and N x 6: wx wy wz (rad/s), ax ay az (m/s^2), IMU axes; at rest the
        latter read +g upwards. Raises ValueError for wrong shapes, without T_imu_sensor, or when one is not finite: the others are
        taken."""
    def push_points(self, points: npt.ArrayLike, stamp_ns: int) -> None:
        """N x 3 in the sensor's frame, in place of a depth image. Those within the camera are used: give it the
        sensor's field of view and about as many pixels as it has points there."""
    def push_odometry(
        self, stamp_ns: int, T_odom_base: npt.ArrayLike, covariance: Optional[npt.ArrayLike] = None
    ) -> None:
        """With local="external": where the odometry has the base, 4x4, in its own frame; often, and in order. A gap
        over a second or a discontinuity starts a new odom_segment. covariance: 6x6 of the pose, [rad; m];
        NaN or a negative variance: unknown."""
    def newest(self) -> PoseUpdate:
        """Of the newest processed frame."""
    def wait(self, newer_than_ns: int = 0, timeout_s: float = 1.0) -> Optional[PoseUpdate]:
        """The newest pose once its stamp is newer than that; None when the time is over. Of a device whose clock was set
        back, what comes after is newer than the stamps of the last 64 poses before."""
    def stats(self) -> Stats: ...
    def stop(self) -> None:
        """Takes no more frames, finishes those that wait, writes the trace. A second stop does nothing. Raises Error
        for the trace's error, and inside a callback."""
    def __enter__(self) -> Client: ...
    def __exit__(
        self,
        kind: Optional[type[BaseException]],
        error: Optional[BaseException],
        traceback: Optional[TracebackType],
    ) -> None: ...

def set_log(callback: Optional[Callable[[int, str], object]]) -> None:
    """Called for every line of the log, on any thread, which may ask for a client's stats; level 0 debug, 1 info, 2 warning, 3 error. None: nowhere, as at
    the start. Process-wide."""
