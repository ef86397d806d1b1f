#!/usr/bin/env python3
"""What of the converter needs no PyTorch: which files it refuses before anything reads them, and how it writes.

convert_test.py
"""
import pathlib
import sys
import tempfile
import unittest
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

import convert_fcgf


class Converter(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def refusal(self, path):
        with self.assertRaises(convert_fcgf.BadInput) as refused:
            convert_fcgf.read_checkpoint(path)
        return str(refused.exception)

    def zipped(self, *names):
        """As torch.save and torch.jit.save lay it out: all of it in a folder of the archive's name."""
        path = self.folder / "model.pth"
        with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
            for name in names:
                archive.writestr(name, b"3\n" if name.endswith("version") else b"\x80\x02}q\x00.")
        return path

    def test_a_program_of_torchscript_is_refused_unread(self):
        path = self.zipped("model/data.pkl", "model/code/__torch__.py", "model/constants.pkl", "model/version")
        told = self.refusal(path)
        self.assertIn(str(path), told)
        self.assertIn("TorchScript", told)
        self.assertIn("state_dict()", told)
        self.assertNotIn("torch", sys.modules, "nothing of PyTorch has seen it")

    def test_a_plain_checkpoint_is_no_program(self):
        self.assertFalse(convert_fcgf.is_script(self.zipped("model/data.pkl", "model/data/0", "model/version")))
        plain = self.folder / "old.pth"
        plain.write_bytes(b"\x80\x02}q\x00.")
        self.assertFalse(convert_fcgf.is_script(plain))

    def test_what_is_not_there_is_named(self):
        self.assertIn("no such file", self.refusal(self.folder / "none.pth"))

    def test_weights_appear_whole_or_not_at_all(self):
        path = self.folder / "model.safetensors"
        convert_fcgf.write_safetensors(path, {"a": ([2], b"\0" * 8)}, {"network": "x"})
        whole = path.read_bytes()
        self.assertTrue(whole.endswith(b"\0" * 8))
        with self.assertRaises(TypeError):
            convert_fcgf.write_safetensors(path, {"a": ([2], b"\1" * 8), "b": ([2], "no bytes")}, {"network": "x"})
        self.assertEqual(path.read_bytes(), whole, "what stood there stays")
        self.assertEqual([file.name for file in self.folder.iterdir()], [path.name])


if __name__ == "__main__":
    unittest.main(verbosity=2)
