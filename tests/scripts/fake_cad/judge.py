"""Runs a script (.py or .FCMacro) against the modules beside this file: which of the points are in its `part`?

judge.py SCRIPT POINTS: POINTS has a point a line; prints 1 or 0 for each, then the labels of a macro's objects.
"""

import json
import sys

script, points = sys.argv[1:]
with open(script, encoding="utf-8") as file:
    names = {"__name__": "__main__"}
    exec(compile(file.read(), script, "exec"), names)
with open(points) as file:
    print("".join("1" if names["part"].inside(tuple(map(float, line.split()))) else "0" for line in file))
document = names.get("document")
print(json.dumps([thing.Label for thing in document.Objects] if document else []))
