#!/usr/bin/env python3
"""Writes the type stubs of cloud2csg._native from a template and the option classes, which know their fields, types and
meanings. The line `# @OPTION_CLASSES@` becomes the classes; `**SampleOptions` among a function's parameters becomes a keyword
for each field of that class.

make_stubs.py TEMPLATE OUTPUT    with the built package in PYTHONPATH
"""
import pathlib
import re
import sys

from cloud2csg import _native

MARK = "# @OPTION_CLASSES@\n"


def option_classes():
    """In the order in which they are defined: those within others come first."""
    return [value for value in vars(_native).values() if isinstance(value, type) and "__annotations__" in vars(value)]


def keywords_of(kind):
    return ", ".join(f"{name}: {type_} = ..." for name, type_ in kind.__annotations__.items())


def docstring_of(function):
    """Without the signature, which pybind11 puts first."""
    return function.__doc__.split("\n\n", 1)[1].strip()


def stub_of(kind):
    name, keywords = kind.__name__, keywords_of(kind)
    lines = [f"class {name}:", f'    """{kind.__doc__.splitlines()[0]}"""']
    for field, type_ in kind.__annotations__.items():
        lines += [f"    {field}: {type_}", f'    """{vars(kind)[field].__doc__}"""']
    lines += [f"    def __init__(self, *, {keywords}) -> None: ...",
              f"    def replace(self, *, {keywords}) -> {name}:", f'        """{docstring_of(kind.replace)}"""',
              f"    def __copy__(self) -> {name}: ...",
              f"    def __deepcopy__(self, memo: dict[int, object]) -> {name}: ...",
              "    def __eq__(self, other: object) -> bool: ..."]
    for maker, first in (("paper", ["    @staticmethod", f"    def paper() -> {name}:"]),
                         ("without_defects", [f"    def without_defects(self) -> {name}:"])):
        if hasattr(kind, maker):
            lines += [*first, f'        """{docstring_of(getattr(kind, maker))}"""']
    return "\n".join(lines) + "\n"


def main(template, output):
    text = pathlib.Path(template).read_text(encoding="utf-8")
    text = re.sub(r"\*\*(\w+Options)", lambda match: keywords_of(getattr(_native, match[1])), text)
    text = text.replace(MARK, "\n".join(stub_of(kind) for kind in option_classes()))
    pathlib.Path(output).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
