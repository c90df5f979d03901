#!/usr/bin/env python3
"""Writes the type stubs of cloud2csg._native: those of a template, and, at its mark, the option classes, which know
their fields, types and meanings.

make_stubs.py TEMPLATE OUTPUT    with the built package in PYTHONPATH
"""
import pathlib
import sys

from cloud2csg import _native

MARK = "# @OPTION_CLASSES@\n"


def option_classes():
    """In the order in which they are defined: those within others come first."""
    return [value for value in vars(_native).values() if isinstance(value, type) and "__annotations__" in vars(value)]


def stub_of(kind):
    fields = {name: (type_, vars(kind)[name].__doc__) for name, type_ in kind.__annotations__.items()}
    keywords = "".join(f", {name}: {type_} = ..." for name, (type_, _) in fields.items())
    lines = [f"class {kind.__name__}:", f'    """{kind.__doc__.splitlines()[0]}"""']
    for name, (type_, doc) in fields.items():
        lines += [f"    {name}: {type_}", f'    """{doc}"""']
    lines += [f"    def __init__(self, *{keywords}) -> None: ...",
              f"    def replace(self, *{keywords}) -> {kind.__name__}:",
              f'        """{kind.replace.__doc__.split(chr(10) * 2, 1)[1].strip()}"""',
              f"    def __copy__(self) -> {kind.__name__}: ...",
              f"    def __deepcopy__(self, memo: dict[int, object]) -> {kind.__name__}: ...",
              "    def __eq__(self, other: object) -> bool: ..."]
    if hasattr(kind, "paper"):
        lines += ["    @staticmethod", f"    def paper() -> {kind.__name__}:",
                  '        """As in the paper: its weights, its genetic algorithm, no polish."""']
    if hasattr(kind, "without_defects"):
        lines += [f"    def without_defects(self) -> {kind.__name__}:",
                  '        """The same scanner without noise, missing returns, outliers and views out of place."""']
    return "\n".join(lines) + "\n"


def main(template, output):
    before, after = pathlib.Path(template).read_text(encoding="utf-8").split(MARK)
    stubs = "\n".join(stub_of(kind) for kind in option_classes())
    pathlib.Path(output).write_text(before + stubs + after, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
