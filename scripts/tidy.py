#!/usr/bin/env python3
"""clang-tidy over sources, on all cores. A source that passed is not looked at again until something that it is made of
changes: any file that its compilation reads, its flags, the checks or clang-tidy itself. What passed is kept in
~/.cache/cloud2csg-tidy (or under XDG_CACHE_HOME), a file of size zero each.

tidy.py BUILD_FOLDER SOURCE...    exit status 1 when anything was found
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import sys
import time

TIDY = ["clang-tidy", "-quiet", "-extra-arg=-Wno-unknown-warning-option"]
KEPT_SECONDS = 60 * 24 * 3600


def run(command, **options):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False, **options)


def flags_of(command):
    """The compiler's arguments without the compiler (or ccache before it), the input and the output."""
    words = shlex.split(command)
    words = words[next(i for i, word in enumerate(words) if word.startswith("-")):]
    kept, skip = [], False
    for word in words:
        if skip or word in ("-o", "-c"):
            skip = not skip
        else:
            kept.append(word)
    return kept


def key_of(common, root, entry):
    """A hash of all that the findings depend on; None when the preprocessor fails: clang-tidy says why."""
    flags = flags_of(entry["command"])
    rule = run(["clang++", *flags, "-Wno-unknown-warning-option", "-M", entry["file"]], cwd=entry["directory"])
    if rule.returncode != 0:
        return None
    key = common.copy()
    key.update("\0".join(flags).replace(root, "").encode())
    for name in rule.stdout.decode().split(":", 1)[1].replace("\\\n", " ").split():
        key.update(name.replace(root, "").encode())
        key.update(pathlib.Path(entry["directory"], name).read_bytes())
    return key.hexdigest()


def check(build, passed, common, root, entry):
    """What clang-tidy finds in one source: (whether it passed, whether that was known, its words)."""
    key = key_of(common, root, entry)
    if key and (passed / key).exists():
        (passed / key).touch()
        return True, True, ""
    result = run([*TIDY, "-p", build, entry["file"]])
    if result.returncode == 0 and key:
        (passed / key).touch()
    return result.returncode == 0, False, (result.stdout + result.stderr).decode()


def main(build, sources):
    root = os.getcwd()
    passed = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache", "cloud2csg-tidy")
    passed.mkdir(parents=True, exist_ok=True)
    for old in passed.iterdir():
        if time.time() - old.stat().st_mtime > KEPT_SECONDS:
            old.unlink()
    common = hashlib.sha256(run(["clang-tidy", "--version"]).stdout + pathlib.Path(".clang-tidy").read_bytes())
    wanted = {str(pathlib.Path(source).resolve()) for source in sources}
    commands = json.loads(pathlib.Path(build, "compile_commands.json").read_text())
    entries = {entry["file"]: entry for entry in commands if entry["file"] in wanted}
    for missing in sorted(wanted - entries.keys()):
        print(f"tidy: {missing} is not compiled in {build}", file=sys.stderr)
    known, failed = 0, len(wanted - entries.keys())
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for right, was_known, words in pool.map(
                lambda entry: check(build, passed, common, root, entry), entries.values()):
            known += was_known
            if not right:
                failed += 1
                print(words, flush=True)
    print(f"tidy: {len(entries)} sources, {known} of them known to pass, {failed} with findings")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
