#!/usr/bin/env python3
"""The check of the IDL's version is red where it must be, and PROTOCOL.md names every code."""
import pathlib
import re
import unittest

import check_version as check

IDL = "struct A { long x; };  // metres\n"
HEADER = (check.ROOT / "common/protocol/spot.hpp").read_text()
STATUS = (check.ROOT / "common/wire/spots/status.hpp").read_text()
PROTOCOL = (check.IDL / "PROTOCOL.md").read_text()


class Digest(unittest.TestCase):
    def test_comments_and_blanks_mean_nothing(self):
        self.assertEqual(check.digest(IDL), check.digest("/* a\n b */ struct A {\n\tlong x;\n};"))

    def test_a_field_a_type_and_an_order_mean_something(self):
        for other in ("struct A { long x; long y; };", "struct A { short x; };", "struct A { long longx; };"):
            self.assertNotEqual(check.digest(IDL), check.digest(other))


class Problem(unittest.TestCase):
    def test_the_same_meaning_is_no_problem(self):
        self.assertIsNone(check.problem(IDL, 2, {2: (check.digest(IDL), "0.1.0")}))

    def test_a_change_within_a_released_version_asks_for_another(self):
        kept = {2: ("0" * 64, "0.1.0")}
        self.assertIn("raise kProtocolVersion", check.problem(IDL, 2, kept))
        with self.assertRaises(ValueError):
            check.renewed(f"2 {'0' * 64} 0.1.0\n", IDL, 2)

    def test_a_change_before_the_release_names_the_command(self):
        self.assertIn("--renew", check.problem(IDL, 2, {2: ("0" * 64, "unreleased")}))
        text = check.renewed(f"# kept\n1 {'1' * 64} 0.1.0\n2 {'0' * 64} unreleased\n", IDL, 2)
        self.assertEqual(text, f"# kept\n1 {'1' * 64} 0.1.0\n2 {check.digest(IDL)} unreleased\n")

    def test_a_new_version_is_kept_beside_the_old(self):
        text = check.renewed(f"1 {'1' * 64} 0.1.0\n", IDL, 2)
        self.assertIsNone(check.problem(IDL, 2, check.read_versions(text)))
        self.assertIn(1, check.read_versions(text))


class Document(unittest.TestCase):
    def test_it_tells_every_code_with_its_number(self):
        for enum in ("SpotStatus", "Reason", "Advice", "CloudCodec", "LidarState"):
            body = re.search(rf"enum class {enum} : std::uint8_t \{{(.*?)\}};", HEADER + STATUS, re.S).group(1)
            codes = re.findall(r"(\w+) = (\d+)", body)
            self.assertTrue(codes)
            for name, number in codes:
                self.assertRegex(PROTOCOL, rf"\| {number} \| `?{name}`? \|", f"{enum} {name} is not in PROTOCOL.md")

    def test_it_tells_the_present_version(self):
        self.assertIn(f"version is {check.present_version(HEADER)}", PROTOCOL)

    def test_it_names_every_topic(self):
        topics = (check.ROOT / "common/wire/dds/topics.hpp").read_text()
        for name in re.findall(r'Topic = "([^"]+)"', topics) + re.findall(r'return "rt/" \+ id \+ "([^"]+)"', topics):
            self.assertIn(name, PROTOCOL)


if __name__ == "__main__":
    unittest.main()
