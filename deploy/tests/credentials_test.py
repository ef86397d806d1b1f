#!/usr/bin/env python3
"""What deploy/credentials makes, and what it refuses.   credentials_test.py ROOT"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
PARTY = ["cert.pem", "crl.pem", "governance.p7s", "identity_ca.cert.pem", "key.pem", "permissions.p7s",
         "permissions_ca.cert.pem"]


def openssl(*words):
    return subprocess.run(["openssl", *map(str, words)], capture_output=True, text=True, check=False)


class Credentials(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.store = pathlib.Path(self.temporary.name) / "store"
        self.authority = self.store / "authority"
        self.environment = None  # this program's own
        self.made("init")

    def break_openssl(self, command):
        """From here on it fails in one of its commands."""
        folder = pathlib.Path(self.temporary.name) / "bin"
        folder.mkdir()
        (folder / "openssl").write_text(f'#!/bin/sh\n[ "$1" != {command} ] || {{ echo no luck >&2; exit 1; }}\n'
                                        f'PATH={os.environ["PATH"]} exec openssl "$@"\n')
        (folder / "openssl").chmod(0o755)
        self.environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}

    def run_it(self, *words):
        return subprocess.run([ROOT / "deploy/credentials", "--keystore", self.store, *words], capture_output=True,
                              text=True, check=False, env=self.environment)

    def made(self, *words):
        done = self.run_it(*words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def refused(self, code, text, *words):
        done = self.run_it(*words)
        self.assertEqual(done.returncode, code, done.stdout)
        self.assertIn(text, done.stderr)
        self.assertNotIn("Traceback", done.stderr)

    def signed(self, name):
        done = openssl("smime", "-verify", "-text", "-in", self.store / "parties" / name / "permissions.p7s",
                       "-CAfile", self.authority / "permissions_ca.cert.pem")
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_a_party_has_exactly_what_it_needs_and_keys_are_private(self):
        self.made("device", "robot1")
        folder = self.store / "parties/robot1"
        self.assertEqual(sorted(file.name for file in folder.iterdir()), PARTY)
        keys = [folder / "key.pem", *self.authority.glob("*.key")]
        self.assertEqual([oct(key.stat().st_mode & 0o777) for key in keys], ["0o600"] * 3)
        for each in (self.store, self.authority, folder):
            self.assertEqual(oct(each.stat().st_mode & 0o777), "0o700")
        for file in folder.iterdir():
            for key in self.authority.glob("*.key"):
                self.assertNotIn(key.read_text(), file.read_text())

    def test_the_permissions_authority_issues_nothing(self):
        self.made("device", "robot1")
        self.assertNotEqual((self.authority / "identity_ca.cert.pem").read_text(),
                            (self.authority / "permissions_ca.cert.pem").read_text())
        self.assertIn("CA:FALSE", openssl("x509", "-in", self.authority / "permissions_ca.cert.pem", "-noout", "-ext",
                                          "basicConstraints").stdout)
        verify = openssl("verify", "-CAfile", self.authority / "permissions_ca.cert.pem",
                         self.store / "parties/robot1/cert.pem")
        self.assertNotEqual(verify.returncode, 0)

    def test_a_device_gets_its_own_partition_and_topics(self):
        self.made("device", "robot1", "--reads", "/camera/depth", "--writes", "robot1_map")
        text = self.signed("robot1")
        self.assertEqual(text.count("<partition>robots/robot1</partition>"), 2)
        self.assertEqual(text.count("<partition>"), 5)
        self.assertIn("<topic>rt/robot1/*</topic><topic>rt/camera/depth</topic>", text)
        self.assertIn("<topic>rt/robot1_map</topic>", text)
        self.assertIn("<default>DENY</default>", text)

    def test_a_lidar_only_writes_its_own_topics(self):
        self.made("lidar", "ceiling0")
        text = self.signed("ceiling0")
        self.assertEqual(text.count("<topic>"), 1)
        self.assertIn("<publish><topics><topic>rt/ceiling0/*</topic></topics>", text)
        self.assertNotIn("<subscribe>", text)

    def test_renewed_permissions_are_as_before(self):
        self.made("device", "robot1", "--reads", "/camera/depth")
        key = (self.store / "parties/robot1/key.pem").read_text()
        self.made("renew", "robot1", "--days", "3")
        self.assertIn("rt/camera/depth", self.signed("robot1"))
        self.assertNotEqual((self.store / "parties/robot1/key.pem").read_text(), key)
        self.assertRegex(self.made("list"), r"robot1 +device +valid +2\n")
        self.made("renew", "robot1")
        self.assertRegex(self.made("list"), r"robot1 +device +valid +2\n", "as long as last time")

    def test_a_renewal_says_what_is_to_be_copied_and_when_it_counts(self):
        for words in (("server", "edge"), ("device", "robot1")):
            self.made(*words)
        told = self.made("renew", "robot1")
        self.assertIn("parties/robot1: copy the whole folder to the device again; start its program again.", told)
        self.assertIn("stays valid until its end", told)
        self.assertIn("a server that runs takes it within ten seconds", self.made("renew", "edge"))

    def test_a_revocation_reaches_every_folder_and_all_certificates_of_the_name(self):
        for words in (("server", "edge"), ("device", "robot1"), ("renew", "robot1"), ("revoke", "robot1")):
            self.made(*words)
        lists = {(self.store / "parties" / name / "crl.pem").read_text() for name in ("edge", "robot1")}
        self.assertEqual(len(lists), 1)
        text = openssl("crl", "-in", self.authority / "crl.pem", "-noout", "-text").stdout
        self.assertEqual(text.count("Serial Number"), 2)
        self.assertRegex(self.made("list"), r"robot1 +device +revoked")
        self.made("renew", "robot1")
        self.assertRegex(self.made("list"), r"robot1 +device +valid")

    def test_a_stray_file_among_the_folders_keeps_no_revocation_back(self):
        for words in (("device", "a"), ("device", "z")):
            self.made(*words)
        (self.store / "parties" / "m.tgz").write_text("packed for transport")
        self.made("revoke", "a")
        text = openssl("crl", "-in", self.store / "parties/z/crl.pem", "-noout", "-text").stdout
        self.assertEqual(text.count("Serial Number"), 1)

    def test_a_keystore_may_stand_anywhere_and_move(self):
        for odd in ("a b", "$HOME", "$(dir)x", 'one " two \' three', "back\\slash", "#x;y=z", "[ca]", "%s{dir}"):
            self.store = pathlib.Path(self.temporary.name) / odd
            for words in (("init",), ("device", "robot1"), ("revoke", "robot1"), ("renew", "robot1")):
                self.made(*words)
            self.assertRegex(self.made("list"), r"robot1 +device +valid")
            self.store = self.store.rename(self.store.parent / "moved")
            self.made("device", "robot2")
            shutil.rmtree(self.store)

    def test_an_init_that_fails_leaves_nothing_behind_but_what_was_there(self):
        self.break_openssl("smime")
        there = pathlib.Path(self.temporary.name) / "there"
        there.mkdir(mode=0o755)
        self.store = there / "deep/site"
        self.refused(1, "openssl smime: no luck", "init")
        self.assertEqual(list(there.iterdir()), [])
        self.store = there
        self.refused(1, "openssl smime: no luck", "init")
        self.assertEqual((list(there.iterdir()), oct(there.stat().st_mode & 0o777)), ([], "0o755"))
        self.environment = None
        self.made("init")
        self.made("device", "robot1")

    def test_an_init_that_was_killed_is_told(self):
        (self.authority / "crl.pem").unlink()
        self.refused(1, "was left unfinished by an init that was killed; remove it", "init")
        self.refused(1, "is no keystore; make one", "device", "robot1")

    def test_what_makes_no_sense_is_refused(self):
        self.made("server", "edge")
        self.refused(1, "is never overwritten", "init")
        self.refused(1, "edge has credentials", "device", "edge")
        self.refused(1, "nobody is not in", "revoke", "nobody")
        for name in ("../x", "a b", "", "x" * 64, "a,O=b", "*"):
            self.refused(2, "a name is 1 to 63", "device", name)
        self.refused(2, "without wildcards", "device", "robot1", "--reads", "/*")
        self.refused(2, "must lie ahead", "device", "robot1", "--expires", "2020-01-01T00:00:00")
        self.refused(2, "must be 1..3650", "device", "robot1", "--days", "0")
        self.refused(2, "COMMAND")
        self.store = self.store / "elsewhere"
        self.refused(1, "is no keystore; make one", "list")

    def test_names_that_are_one_in_topics_are_refused(self):
        self.made("device", "robot-1")
        self.refused(1, "robot-1 has the same topics as robot_1", "device", "robot_1")
        self.refused(1, "robot-1 has the same topics as robot_1", "lidar", "robot_1")
        self.made("server", "robot_1")  # a server has none

    def test_help_says_what_it_does(self):
        self.assertIn("credentials revoke robot1", self.made("--help"))


class Attacks(unittest.TestCase):
    def test_each_row_names_a_test_that_exists(self):
        tests = "".join(file.read_text() for folder in ("common", "server") for file in (ROOT / folder).rglob("*_test.cpp"))
        rows = [row for row in (ROOT / "deploy/SECURITY.md").read_text().splitlines() if row.startswith("| ")]
        attacks = [row for row in rows if row.count("|") == 4 and not row.startswith("| attack ")]
        self.assertGreater(len(attacks), 12)
        for row in attacks:
            for name in re.findall(r"`([A-Z]\w+)`", row.split("|")[3]):
                self.assertRegex(tests, rf"TEST(_F)?\(\w+, {name}\)", row)
            self.assertRegex(row.split("|")[3], r"`[A-Z]\w{10,}`|`deploy/fuzz`")


if __name__ == "__main__":
    unittest.main()
