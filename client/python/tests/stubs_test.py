#!/usr/bin/env python3
"""The type stubs name what the installed module has: every class, member, argument and default."""
import ast
import os
import pathlib
import re
import unittest

import liloc

STUB = ast.parse((pathlib.Path(liloc.__file__).parent / "__init__.pyi").read_text())
CLASSES = {node.name: node for node in STUB.body if isinstance(node, ast.ClassDef)}
INHERITED = set(dir(object)) | set(dir(RuntimeError)) | {"__weakref__", "__module__", "__members__", "__entries"}
ENUM_CALLS = {"__eq__", "__hash__", "__index__", "__int__", "__ne__", "__getstate__", "__setstate__", "__repr__"}


def stub_members(node):
    return {item.name for item in node.body if isinstance(item, ast.FunctionDef)} | {
        item.target.id for item in node.body if isinstance(item, ast.AnnAssign)}


def stub_arguments(call):
    """[(name, default as text or None)], without self."""
    plain = [a.arg for a in call.args.args]
    defaults = [None] * (len(plain) - len(call.args.defaults)) + [ast.unparse(d) for d in call.args.defaults]
    keyword = [(a.arg, d and ast.unparse(d)) for a, d in zip(call.args.kwonlyargs, call.args.kw_defaults)]
    return [pair for pair in zip(plain, defaults) if pair[0] != "self"] + keyword


def module_arguments(call):
    """The same, from the signature that pybind11 puts into the text."""
    inside = call.__doc__[call.__doc__.index("(") + 1:call.__doc__.rindex(") ->")]
    found = re.findall(r"(\w+): [^ =,\[]+(?:\[[^]]*\])?(?: = ([^,]*))?", inside)
    return [(name, default or None) for name, default in found if name != "self"]


def header_fields(struct):
    """Names of the fields of a struct in the installed liloc/client.hpp."""
    header = pathlib.Path(os.environ["LILOC_INCLUDE"], "liloc", "client.hpp").read_text()
    body = re.search(rf"^struct {struct} {{\n(.*?)^}};", header, re.DOTALL | re.MULTILINE).group(1)
    body = re.sub(r"//.*|\{[^}]*\}", "", body)
    declared = [re.sub(r"<[^;]*>", "", line) for line in body.split(";") if line.strip()]
    return {re.sub(r"=.*", "", name).split()[-1] for line in declared for name in line.split(",")}


def same_default(stub, module):
    if stub is None or module is None or stub == "...":
        return (stub is None) == (module is None)
    return ast.literal_eval(stub) == ast.literal_eval(module)


class Stubs(unittest.TestCase):
    def test_names_of_the_module(self):
        functions = {node.name for node in STUB.body if isinstance(node, ast.FunctionDef)}
        self.assertEqual(set(liloc.__all__), set(CLASSES) | functions | {"__version__"})
        self.assertTrue((pathlib.Path(liloc.__file__).parent / "py.typed").exists())

    def test_members_of_every_class(self):
        for name, node in CLASSES.items():
            found = {member for member in vars(getattr(liloc, name)) if member not in INHERITED}
            if name == "State":
                found -= ENUM_CALLS
            self.assertEqual(found, stub_members(node) - {"__init__"}, name)

    def test_fields_of_the_library(self):
        for name in ("Camera", "PoseUpdate", "Reply", "Stats"):
            self.assertEqual(header_fields(name), stub_members(CLASSES[name]) - {"__init__"}, name)
        made = next(c for c in CLASSES["Client"].body if isinstance(c, ast.FunctionDef) and c.name == "__init__")
        arguments = {name for name, _ in stub_arguments(made)}
        # Frames of a Python program come by its calls, from no topic.
        self.assertEqual(header_fields("Options") - {"frames_from"} | {"on_pose", "on_reply"}, arguments)

    def test_arguments_and_defaults(self):
        for class_name in ("Camera", "Client"):
            for call in CLASSES[class_name].body:
                if not isinstance(call, ast.FunctionDef) or call.name in ("__enter__", "__exit__"):
                    continue
                stub = stub_arguments(call)
                module = module_arguments(getattr(getattr(liloc, class_name), call.name))
                where = f"{class_name}.{call.name}"
                self.assertEqual([name for name, _ in stub], [name for name, _ in module], where)
                for (argument, wanted), (_, default) in zip(stub, module):
                    self.assertTrue(same_default(wanted, default), f"{where}: {argument} = {wanted}, is {default}")

    def test_classes_say_where_they_live(self):
        for name in CLASSES:
            self.assertEqual(getattr(liloc, name).__module__, "liloc")


if __name__ == "__main__":
    unittest.main()
