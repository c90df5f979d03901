#!/usr/bin/env python3
"""Prints the reference of the Python package as Markdown: what its sources or stubs say of themselves.

python_reference.py FILE.py[i]...
"""
import ast
import pathlib
import sys


def signature(function, is_method):
    # Without self, which no caller writes.
    arguments = ast.unparse(function.args)
    if is_method:
        arguments = arguments.removeprefix("self").removeprefix(", ").removeprefix("/").removeprefix(", ")
    result = f" -> {ast.unparse(function.returns)}" if function.returns else ""
    return f"{function.name}({arguments}){result}"


def is_public(name):
    return not name.startswith("_")


def describe_function(function, level, is_method=False):
    print(f"{'#' * level} `{function.name}`\n\n```python\n{signature(function, is_method)}\n```\n")
    if text := ast.get_docstring(function):
        print(text + "\n")


def describe_fields(body):
    """Fields with the string that follows them."""
    rows = []
    for field, after in zip(body, body[1:] + [None]):
        if not isinstance(field, ast.AnnAssign) or not is_public(ast.unparse(field.target)):
            continue
        is_text = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
        text = " ".join(str(after.value.value).split()) if is_text else ""
        kind = ast.unparse(field.annotation).replace("|", r"\|")
        rows.append(f"| `{ast.unparse(field.target)}` | `{kind}` | {text} |")
    if rows:
        print("\n".join(["| field | type | |", "|---|---|---|", *rows]) + "\n")


def describe_class(kind):
    print(f"## `{kind.name}`\n")
    if text := ast.get_docstring(kind):
        print(text + "\n")
    describe_fields(kind.body)
    for part in kind.body:
        if isinstance(part, ast.FunctionDef) and is_public(part.name):
            describe_function(part, 3, is_method=True)


def main(files):
    print("# The Python package cloud2csg\n")
    for file in files:
        for part in ast.parse(pathlib.Path(file).read_text(encoding="utf-8")).body:
            if isinstance(part, ast.ClassDef) and is_public(part.name):
                describe_class(part)
            elif isinstance(part, ast.FunctionDef) and is_public(part.name):
                describe_function(part, 2)


if __name__ == "__main__":
    main(sys.argv[1:])
