#!/usr/bin/env python3
"""A robot's program in Python, with the installed module: locates itself by odometry, and uses everything wrongly."""
import gc
import os
import subprocess
import sys
import threading
import time
import unittest
import weakref

import numpy as np

import box_frames as box
import liloc

DOMAIN, ANSWERED_DOMAIN = 175, 178  # of this test alone
CAMERA = liloc.Camera(box.WIDTH, box.HEIGHT, box.FOCAL_PX, box.FOCAL_PX, (box.WIDTH - 1) / 2, (box.HEIGHT - 1) / 2)
IMAGE = np.full((box.HEIGHT, box.WIDTH), 2000, np.uint16)


def client(name="consumer-py", **options):
    return liloc.Client(name, CAMERA, domain=DOMAIN, **options)


class Walk(unittest.TestCase):
    def test_odometry_measures_the_walk(self):
        poses, main_thread = [], threading.get_ident()
        threads = set()

        def on_pose(update):
            poses.append(update)
            threads.add(threading.get_ident())

        with client(queue_frames=box.FRAMES, on_pose=on_pose) as robot:
            for frame in range(box.FRAMES):
                robot.push_depth(box.render(frame), box.stamp_ns(frame))
            newest = robot.wait(newer_than_ns=box.stamp_ns(box.FRAMES - 2), timeout_s=20)
        self.assertIsNotNone(newest)
        self.assertEqual([p.stamp_ns for p in poses], [box.stamp_ns(i) for i in range(box.FRAMES)])
        self.assertNotIn(main_thread, threads)
        self.assertEqual(robot.stats().frames, box.FRAMES)
        self.assertIsNone(newest.T_map_sensor)
        self.assertEqual(newest.state, liloc.State.SEARCHING)
        self.assertTrue(newest.converged and newest.informative and not newest.server_connected)
        self.assertEqual((newest.observed.dtype, newest.observed.shape), (np.float64, (6,)))
        self.assertGreater(newest.observed.min(), 0.9)
        self.assertEqual((newest.covariance.dtype, newest.covariance.shape), (np.float64, (6, 6)))
        measured = np.linalg.inv(poses[0].T_odom_sensor) @ poses[-1].T_odom_sensor
        true = np.linalg.inv(box.T_map_sensor(0)) @ box.T_map_sensor(box.FRAMES - 1)
        print(f"position off by {1e3 * np.linalg.norm(measured[:3, 3] - true[:3, 3]):.1f} mm")
        np.testing.assert_allclose(measured, true, atol=0.03)
        self.assertEqual((measured.dtype, measured.shape), (np.float64, (4, 4)))

    def test_strided_frames_are_taken(self):
        doubled = np.repeat(np.repeat(box.render(0), 2, axis=0), 2, axis=1)
        with client() as robot:
            robot.push_depth(doubled[::2, ::2], 1)
            self.assertIsNotNone(robot.wait(timeout_s=20))

    def test_waiting_lets_other_threads_run(self):
        with client() as robot:
            waiting = threading.Thread(target=robot.wait, kwargs={"timeout_s": 0.5})
            start = time.monotonic()
            waiting.start()
            self.assertLess(time.monotonic() - start, 0.4)
            waiting.join()
            self.assertGreaterEqual(time.monotonic() - start, 0.5)
            self.assertIsNone(robot.wait(timeout_s=0))


    def test_a_clock_that_is_set_back_wakes_who_waits(self):
        with client() as robot:
            for frame in range(5):
                robot.push_depth(box.render(frame), box.stamp_ns(frame))
            last = robot.wait(newer_than_ns=box.stamp_ns(3), timeout_s=20)
            for frame in range(5, 10):
                robot.push_depth(box.render(frame), box.stamp_ns(frame) - 100_000_000_000)
            newest = robot.wait(newer_than_ns=last.stamp_ns, timeout_s=20)
            self.assertIsNotNone(newest)
            self.assertLess(newest.stamp_ns, last.stamp_ns)
            self.assertIsNone(robot.wait(newer_than_ns=box.stamp_ns(9) - 100_000_000_000, timeout_s=0.2))


class Answered(unittest.TestCase):
    def test_replies_locate_the_client(self):
        replies = []
        image = box.render(0)
        server = subprocess.Popen([os.environ["ANSWERING_SERVER"], str(ANSWERED_DOMAIN)], stdin=subprocess.PIPE)
        self.addCleanup(server.wait, 20)
        with server.stdin, liloc.Client("answered", CAMERA, domain=ANSWERED_DOMAIN, interval_ms=100,
                                        on_reply=replies.append) as robot:
            for frame in range(1000):
                robot.push_depth(image, box.stamp_ns(frame))
                pose = robot.wait(newer_than_ns=box.stamp_ns(frame) - 1, timeout_s=20)
                if pose.T_map_sensor is not None:
                    break
                time.sleep(0.01)
        np.testing.assert_allclose(pose.T_map_sensor[:3, 3] - pose.T_odom_sensor[:3, 3], [1, 2, 3], atol=1e-6)
        self.assertEqual((pose.state, pose.server_connected), (liloc.State.TRACKING, True))
        self.assertTrue(replies and replies[-1].verified)
        self.assertEqual((replies[-1].status, replies[-1].reason, replies[-1].text),
                         ("verified", "confirmed", "by heart"))
        np.testing.assert_allclose(replies[-1].covariance, 1e-4 * np.eye(6), atol=1e-9)
        self.assertEqual(replies[-1].T_map_sensor.shape, (4, 4))
        self.assertGreaterEqual(robot.stats().replies_verified, 1)


class External(unittest.TestCase):
    def test_odometry_of_others_carries_the_pose(self):
        lifted = np.eye(4)
        lifted[2, 3] = 0.4
        points = np.stack(np.meshgrid(np.arange(-1.6, 1.6, 0.04), np.arange(-1.6, 1.6, 0.04), [2.5]), -1).reshape(-1, 3)
        with client(local="external", T_base_sensor=lifted) as robot:
            for frame in range(20):
                T = np.eye(4)
                T[0, 3] = 0.01 * frame
                robot.push_odometry(box.stamp_ns(frame), T, covariance=1e-6 * (frame + 1) * np.eye(6))
                robot.push_points(points if frame % 2 else points.astype(np.float32), box.stamp_ns(frame))
                pose = robot.wait(newer_than_ns=box.stamp_ns(frame) - 1, timeout_s=20)
                self.assertIsNotNone(pose, f"frame {frame}")
            np.testing.assert_allclose(pose.T_odom_sensor[:3, 3], [0.19, 0, 0.4], atol=1e-6)
            for wrong in (2 * np.eye(4), np.eye(3)):
                with self.assertRaisesRegex(ValueError, "T_odom_base"):
                    robot.push_odometry(box.stamp_ns(20), wrong)
            with self.assertRaisesRegex(ValueError, "6x6"):
                robot.push_odometry(box.stamp_ns(20), np.eye(4), np.eye(5))
            with self.assertRaisesRegex(ValueError, "N x 3"):
                robot.push_points(np.zeros((3, 4)), box.stamp_ns(20))


class Imu(unittest.TestCase):
    MOUNTING = np.array([[0, 0, 1, 0.01], [-1, 0, 0, 0], [0, -1, 0, 0.005], [0, 0, 0, 1.0]])

    def test_samples_come_singly_or_many_at_once(self):
        stamps = box.stamp_ns(0) + np.arange(100) * 5_000_000
        samples = np.tile([0, 0, 0, 0, 0, 9.81], (100, 1))
        with client(T_imu_sensor=self.MOUNTING, local="inertial", still_seconds=0.2) as robot:
            robot.push_imu(int(stamps[0]), samples[0])
            robot.push_imu(stamps[1:], samples[1:])
            robot.push_imu(int(stamps[-1]) + 5_000_000, [0, 0, 0, 0, 0, 9.81])
            robot.push_depth(box.render(0), int(stamps[-1]))
            self.assertIsNotNone(robot.wait(timeout_s=20))
            self.assertEqual(robot.stats().imu_refused, 0)

    def test_wrong_samples(self):
        with client(T_imu_sensor=self.MOUNTING) as robot:
            for stamps, samples in ((1, np.zeros(5)), (np.arange(3), np.zeros((2, 6))), ([1, 2], np.zeros(6)),
                                    (1, np.zeros((1, 6)))):
                with self.assertRaisesRegex(ValueError, "must be one stamp"):
                    robot.push_imu(stamps, samples)
            with self.assertRaisesRegex(TypeError, "integers"):
                robot.push_imu(1.5, np.zeros(6))
            with self.assertRaisesRegex(TypeError, "numbers"):
                robot.push_imu(1, "six")
        with client() as robot, self.assertRaisesRegex(ValueError, "T_imu_sensor"):
            robot.push_imu(1, np.zeros(6))

    def test_a_mounting_is_a_rotation_and_a_translation(self):
        mirrored = np.diag([1.0, 1, -1, 1])
        for wrong, text in ((np.eye(3), "4x4"), (2 * np.eye(4), "rotation"), (mirrored, "rotation"),
                            (np.full((4, 4), np.nan), "rotation")):
            with self.assertRaisesRegex(ValueError, text):
                client(T_imu_sensor=wrong)
        with self.assertRaises(TypeError):
            client(T_imu_sensor="level")


class Misuse(unittest.TestCase):
    def test_wrong_options_are_named(self):
        for options, text in (({"voxel_size_m": 7}, "voxel_size_m"), ({"local": "lidar"}, "local is 'lidar'"),
                              ({"local": "inertial"}, "T_imu_sensor"), ({"interval_ms": 1}, "interval_ms"),
                              ({"request_bytes": 1}, "request_bytes"),
                              ({"searching_interval_ms": -1}, "searching_interval_ms"),
                              ({"lost_sd_m": 0}, "lost_sd_m"), ({"codec": "zip"}, "codec is 'zip'"),
                              ({"name": "no blanks"}, "options.id")):
            with self.assertRaisesRegex(ValueError, text):
                client(**options)
        with self.assertRaises(TypeError):
            client(on_pose=3)
        with self.assertRaises(TypeError):
            client(no_such_option=1)

    def test_the_networks_error_is_its_own(self):
        with self.assertRaisesRegex(liloc.Error, "nosuchcard0"):
            client(network_interface="nosuchcard0")
        with self.assertRaisesRegex(liloc.Error, "credentials: /nowhere is no folder"):
            client(credentials="/nowhere")

    def test_wrong_frames(self):
        with client() as robot:
            for wrong in (IMAGE.astype(np.float32) * 0.001, IMAGE.astype(np.int16), IMAGE.tolist(), None):
                with self.assertRaisesRegex(TypeError, "uint16"):
                    robot.push_depth(wrong, 1)
            with self.assertRaisesRegex(ValueError, "height x width"):
                robot.push_depth(IMAGE[..., None], 1)
            with self.assertRaisesRegex(ValueError, "120x160"):
                robot.push_depth(np.ascontiguousarray(IMAGE.T), 1)
            with self.assertRaises(ValueError):
                robot.wait(timeout_s=float("nan"))

    def test_a_stopped_client_says_so(self):
        robot = client()
        robot.stop()
        robot.stop()
        with self.assertRaisesRegex(liloc.Error, "stopped"):
            robot.push_depth(IMAGE, 1)
        self.assertEqual(robot.newest().stamp_ns, 0)


class Callbacks(unittest.TestCase):
    def test_what_a_callback_raises_is_reported_and_harmless(self):
        seen, before = [], sys.unraisablehook
        sys.unraisablehook = lambda unraisable: seen.append(str(unraisable.exc_value))
        self.addCleanup(setattr, sys, "unraisablehook", before)

        def on_pose(update):
            raise KeyError(f"frame {update.stamp_ns}")

        with client(on_pose=on_pose) as robot:
            robot.push_depth(IMAGE, 1)
            robot.push_depth(IMAGE, 2)
            self.assertIsNotNone(robot.wait(newer_than_ns=1, timeout_s=20))
        self.assertEqual(seen, ["'frame 1'", "'frame 2'"])

    def test_a_callback_cannot_stop_its_client(self):
        raised = []

        def on_pose(_):
            try:
                robot.stop()
            except liloc.Error as error:
                raised.append(str(error))

        robot = client(on_pose=on_pose)
        robot.push_depth(IMAGE, 1)
        robot.wait(timeout_s=20)
        robot.stop()
        self.assertEqual(len(raised), 1)
        self.assertIn("another thread", raised[0])

    def test_a_callback_may_drop_the_last_reference(self):
        dropped = threading.Event()
        holder = []

        def on_pose(_):
            holder.clear()
            dropped.set()

        holder.append(client(on_pose=on_pose))
        holder[0].push_depth(IMAGE, 1)
        self.assertTrue(dropped.wait(20))

    def test_stop_lets_a_callbacks_objects_go(self):
        class Robot:
            def __init__(self):
                self.client = client(on_pose=self.on_pose)

            def on_pose(self, update):
                pass

        robot = Robot()
        known = weakref.ref(robot)
        robot.client.stop()
        del robot
        gc.collect()
        self.assertIsNone(known())

    def test_the_log_comes_as_text(self):
        lines = []
        liloc.set_log(lambda level, line: lines.append((level, line)))
        with client() as robot:
            robot.push_depth(IMAGE, 5)
            robot.push_depth(IMAGE, 4)
            robot.wait(timeout_s=20)
        liloc.set_log(None)
        self.assertTrue(any(level == 2 and "consumer-py" in line for level, line in lines), lines)
        with self.assertRaises(TypeError):
            liloc.set_log("stderr")


class End(unittest.TestCase):
    def test_a_program_may_end_with_a_running_client(self):
        program = (f"import sys; sys.path[:0] = {sys.path!r}\n"
                   "import liloc, box_frames as box\n"
                   "camera = liloc.Camera(box.WIDTH, box.HEIGHT, 115, 115, 79.5, 59.5)\n"
                   f"robot = liloc.Client('ends', camera, domain={DOMAIN}, queue_frames=100,\n"
                   "                     on_pose=lambda update: print(update.stamp_ns, flush=True))\n"
                   "liloc.set_log(print)\n"
                   "for i in range(20): robot.push_depth(box.render(0), box.stamp_ns(i))\n")
        ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=30)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        self.assertIn(str(box.stamp_ns(19)), ended.stdout.split())


if __name__ == "__main__":
    unittest.main()
