#!/usr/bin/env python3
"""check_includes.py finds what it must find, and lets pass what the rule allows."""
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))
import check_includes  # noqa: E402


class OneWayRule(unittest.TestCase):
    def problems(self, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for path, text in files.items():
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(text)
            return check_includes.check(root)[0]

    def test_needs_have_no_circle(self):
        for room in check_includes.NEEDS:
            if room == "proto-tests":
                continue
            for need in check_includes.NEEDS[room]:
                self.assertNotIn(room, check_includes.reach(need), f"{room} <-> {need}")

    def test_a_lower_room_may_be_included_through_others(self):
        self.assertEqual([], self.problems({
            "server/service/queue.cpp": '#include "common/base/result.hpp"\n#include <vector>\n'}))

    def test_a_higher_room_is_caught_with_its_line(self):
        found = self.problems({"common/geometry/pose.cpp": '#include <vector>\n#include "common/wire/dds/qos.hpp"\n'})
        self.assertEqual(1, len(found))
        self.assertIn("common/geometry/pose.cpp:2: common/geometry includes common/wire", found[0])

    def test_server_and_client_meet_only_in_common(self):
        self.assertEqual(1, len(self.problems({"client/session/a.cpp": '#include "server/service/b.hpp"\n'})))
        self.assertEqual(1, len(self.problems({"server/app/a.cpp": '#include "client/engine/engine.hpp"\n'})))

    def test_only_tests_use_the_testing_room(self):
        line = '#include "common/testing/scene.hpp"\n'
        self.assertEqual([], self.problems({"common/registration/scan/tests/icp_test.cpp": line}))
        self.assertEqual(1, len(self.problems({"common/registration/scan/icp.cpp": line})))

    def test_the_transport_stays_in_its_room(self):
        self.assertEqual([], self.problems({"common/wire/reader.cpp": "#include <dds/dds.h>\n"}))
        self.assertEqual(1, len(self.problems({"server/service/s.cpp": "#include <dds/dds.h>\n"})))

    def test_a_file_outside_every_room_is_caught(self):
        self.assertEqual(1, len(self.problems({"misc/a.cpp": "#include <vector>\n"})))


if __name__ == "__main__":
    unittest.main()
