#!/usr/bin/env python3
"""check_tests.py finds headers without tests and entries that are stale, and lets pass what the rule allows."""
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))
import check_tests  # noqa: E402


class ATestPerHeader(unittest.TestCase):
    def problems(self, files, covered=None):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for path in files:
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text("")
            return check_tests.check(root, covered or {})[0]

    def test_a_header_with_its_test_is_right(self):
        self.assertEqual([], self.problems(["common/a/x.hpp", "common/a/x.cpp", "common/a/tests/x_test.cpp"]))

    def test_one_without_is_named_with_the_file_that_it_lacks(self):
        found = self.problems(["client/a/x.hpp", "client/a/x.cpp", "common/a/tests/x_test.cpp"])
        self.assertEqual(1, len(found))
        self.assertIn("client/a/x.hpp: has no client/a/tests/x_test.cpp", found[0])

    def test_headers_without_a_body_elsewhere_and_those_of_tests_need_none(self):
        self.assertEqual([], self.problems(["server/a/x.hpp", "server/a/tests/y.hpp", "server/a/tests/y.cpp",
                                            "proto-tests/a/z.hpp", "proto-tests/a/z.cpp"]))

    def test_what_covers_it_must_be_there(self):
        files, covered = ["common/a/x.hpp", "common/a/x.cpp"], {"common/a/x.hpp": ("common/b/tests/b_test.cpp", "why")}
        self.assertIn("which is not there", self.problems(files, covered)[0])
        self.assertEqual([], self.problems(files + ["common/b/tests/b_test.cpp"], covered))

    def test_entries_that_are_not_needed_any_more_are_stale(self):
        files = ["common/a/x.hpp", "common/a/x.cpp", "common/a/tests/x_test.cpp"]
        entry = ("common/a/tests/x_test.cpp", "why")
        self.assertIn("by now", self.problems(files, {"common/a/x.hpp": entry})[0])
        self.assertIn("no header", self.problems(files, {"common/a/gone.hpp": entry})[0])

    def test_each_entry_says_why(self):
        for header, (test, why) in check_tests.COVERED.items():
            self.assertTrue(test.endswith((".cpp", ".py", ".sh")), header)
            self.assertGreater(len(why), 10, header)


if __name__ == "__main__":
    unittest.main()
