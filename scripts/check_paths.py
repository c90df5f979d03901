#!/usr/bin/env python3
"""Holds the paths that texts name against the files that there are.

Every path of this repository in the documents, and in comments of sources and scripts, must exist: one that begins with a
folder of ours, or, in a document, a stage with a file of it (`paper/merge`), a header (`cloud2csg/mesh.hpp`) or a link.
A file may be named without its ending. What the build makes (build/, out/) is not looked for.

check_paths.py    in any folder of the repository
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = "apps|bench|cmake|data|docs|examples|include|python|scripts|src|tests|viewer"
OURS = re.compile(rf"(?<![\w./$}}-])(?:\.\./)*((?:{FOLDERS})/[\w./*{{}},+-]+)")
STAGE_OR_HEADER = re.compile(r"`((?:core|paper|cells|raw|pipeline|shape|io|view|cloud2csg)/[\w./*]*\w)`")
LINK = re.compile(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)")
TEXTS = {".md", ".cpp", ".hpp", ".txt", ".cmake", ".sh", ".py", ".json", ".ts", ".mjs", ".toml", ""}


def exists(folder, path):
    """Whether a file matches a path, which may lack its ending, and whose * may stand for folders, as in git."""
    path = path.rstrip(".,")
    return any(any(folder.glob(words)) for words in (path, path + ".*", path.replace("/*", "/**/*")))


def alternatives(path):
    """a.{b,c} as a.b and a.c; {name} may be anything."""
    found = re.search(r"\{([^}]*)\}", path)
    if not found:
        return [path]
    return [whole for part in (found[1].split(",") if "," in found[1] else "*")
            for whole in alternatives(path[:found.start()] + part + path[found.end():])]


def paths_of(name, text):
    """(folders that a path may be meant from, path) of each path that a line of a text names."""
    for path in OURS.findall(text):
        yield [ROOT, ROOT / "viewer", (ROOT / name).parent, (ROOT / name).parent.parent], path
    if name.suffix == ".md":
        for path in STAGE_OR_HEADER.findall(text):
            yield [ROOT / ("include" if path.startswith("cloud2csg/") else "src")], path
        for path in LINK.findall(text):
            yield [(ROOT / name).parent], path


def main():
    names = [pathlib.Path(name) for name in
             subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines()]
    looked_for, faults = 0, []
    for name in names:
        if name.suffix not in TEXTS or name.parts[0] == "data" or not (ROOT / name).is_file():
            continue
        for number, line in enumerate((ROOT / name).read_text(encoding="utf-8", errors="replace").splitlines(), 1):
            for folders, named in paths_of(name, line):
                for path in alternatives(named):
                    looked_for += 1
                    if not any(exists(folder, path) for folder in folders):
                        faults.append(f"{name}:{number}: there is no {path}")
    for fault in faults:
        print(fault)
    print(f"{looked_for} paths, {len(faults)} of them nowhere")
    return 1 if faults or not looked_for else 0


if __name__ == "__main__":
    sys.exit(main())
