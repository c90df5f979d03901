#!/usr/bin/env python3
"""clang-tidy over sources, on all cores.

Most of its time goes into the headers that sources share. So its checks see our own code only (own_code.cpp, a plugin), and the
sources of a folder are looked at together, as one that includes them all; those that cannot be compiled together (names
without linkage that meet) are taken apart. What passed is not looked at again until something that it is made of
changes: any file that its compilation reads, its flags, the checks or clang-tidy itself. ~/.cache/cloud2csg-tidy (or that folder
under XDG_CACHE_HOME) has an empty file for each unit that passed.

tidy.py [--each] BUILD_FOLDER SOURCE...    exit status 1 when anything was found
  --each   every source by itself, with the checks that follow paths through functions (clang-analyzer-*), which look at
           nothing but main files: about thirty times slower
"""
import argparse
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import sys
import time

MOST_SOURCES = 16
KEPT_SECONDS = 60 * 24 * 3600

Unit = collections.namedtuple("Unit", ["sources", "flags", "directory"])


def run(command, **options):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False, **options)


def build_plugin(folder):
    """own_code.cpp, compiled against the headers of clang-tidy."""
    source, plugin = pathlib.Path(__file__).with_name("own_code.cpp"), folder / "own_code.so"
    if not plugin.exists() or plugin.stat().st_mtime < source.stat().st_mtime:
        headers = run(["llvm-config", "--includedir"]).stdout.decode().strip()
        built = run(["c++", "-std=c++17", "-O1", "-fPIC", "-shared", "-fno-rtti", "-isystem", headers, source, "-o", plugin])
        if built.returncode != 0:
            sys.exit(f"tidy: {source} does not compile:\n{built.stderr.decode()}")
    return plugin


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


class Lint:
    """What is the same for all sources of a run."""

    def __init__(self, build, each):
        self.root = os.getcwd()
        self.units = pathlib.Path(build, "tidy").resolve()
        self.units.mkdir(exist_ok=True)
        self.plugin = build_plugin(self.units)
        self.checks = [] if each else ["-checks=-clang-analyzer-*,-bugprone-suspicious-include,-bugprone-exception-escape"]
        self.most_sources = 1 if each else MOST_SOURCES
        self.passed = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache", "cloud2csg-tidy")
        self.passed.mkdir(parents=True, exist_ok=True)
        for old in self.passed.iterdir():
            if time.time() - old.stat().st_mtime > KEPT_SECONDS:
                old.unlink()
        version = run(["clang-tidy", "--version"]).stdout
        self.common = hashlib.sha256(version + pathlib.Path(".clang-tidy").read_bytes() + str(self.checks).encode())

    def units_of(self, entries):
        """Sources of one folder with the same flags, together."""
        together = {}
        for entry in entries:
            flags = tuple(flags_of(entry["command"]))
            alone = "HWY_TARGET_INCLUDE" in pathlib.Path(entry["file"]).read_text()
            key = entry["file"] if alone else os.path.dirname(entry["file"])
            together.setdefault((key, flags, entry["directory"]), []).append(entry["file"])
        units = []
        for (_, flags, directory), sources in together.items():
            parts = -(-len(sources) // self.most_sources)
            units += [Unit(sorted(sources)[part::parts], list(flags), directory) for part in range(parts)]
        return units

    def main_source(self, unit):
        """The one source of a unit, or a new one that includes all."""
        if len(unit.sources) == 1:
            return unit.sources[0]
        text = "".join(f'#include "{source}"\n' for source in unit.sources)
        path = self.units / f"{hashlib.sha256(text.encode()).hexdigest()[:16]}.cpp"
        if not path.exists():
            path.write_text(text)
        return str(path)

    def key_of(self, unit, main):
        """A hash of all that the findings depend on; None when the preprocessor fails: clang-tidy says why."""
        rule = run(["clang++", *unit.flags, "-w", "-M", main], cwd=unit.directory)
        if rule.returncode != 0:
            return None
        key = self.common.copy()
        key.update("\0".join(unit.flags).replace(self.root, "").encode())
        names = set(rule.stdout.decode().split(":", 1)[1].replace("\\\n", " ").split())
        for name in sorted(names - {main} if len(unit.sources) > 1 else names):
            key.update(name.replace(self.root, "").encode())
            key.update(pathlib.Path(unit.directory, name).read_bytes())
        return key.hexdigest()

    def tidy(self, unit, main):
        """Runs clang-tidy: (its exit status, its words)."""
        flags = [*unit.flags, "-Wno-unknown-warning-option"]
        # What sources that are looked at together hide of each other, none of them hides alone; the compiler tells that.
        if len(unit.sources) > 1:
            flags += ["-Wno-shadow", "-ferror-limit=0"]
        config = f"--config-file={self.root}/.clang-tidy"
        result = run(["clang-tidy", "-quiet", config, f"--load={self.plugin}", *self.checks, main, "--", *flags],
                     cwd=unit.directory)
        return result.returncode, (result.stdout + result.stderr).decode()

    def check(self, unit):
        """What clang-tidy finds in a unit: (1 if anything, number of sources that were known to pass, its words)."""
        main = self.main_source(unit)
        key = self.key_of(unit, main)
        if key and (self.passed / key).exists():
            (self.passed / key).touch()
            return 0, len(unit.sources), ""
        status, words = self.tidy(unit, main)
        if status == 0 and key:
            (self.passed / key).touch()
        parts = parts_of(unit, status, words)
        if len(parts) > 1:
            return tuple(first + second for first, second in zip(*map(self.check, parts)))
        return int(status != 0), 0, words


def parts_of(unit, status, words):
    """The unit alone when it could be compiled; else what met something in a source before it, and the others. A negative
    status is that of a crash, which code that does not compile may cause."""
    places = {line.split(":", 1)[0] for line in words.splitlines() if line.endswith("[clang-diagnostic-error]")}
    if len(unit.sources) == 1 or (not places and status >= 0):
        return [unit]
    second = [source for source in unit.sources if source in places]
    if not second or len(second) == len(unit.sources):
        second = unit.sources[1::2]
    first = [source for source in unit.sources if source not in second]
    return [unit._replace(sources=first), unit._replace(sources=second)]


def main(build, sources, each):
    wanted = {str(pathlib.Path(source).resolve()) for source in sources}
    commands = json.loads(pathlib.Path(build, "compile_commands.json").read_text())
    entries = {entry["file"]: entry for entry in commands if entry["file"] in wanted}
    missing = sorted(wanted - entries.keys())
    for source in missing:
        print(f"tidy: {source} is not compiled in {build}", file=sys.stderr)
    lint = Lint(build, each)
    known, failed = 0, len(missing)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for with_findings, were_known, words in pool.map(lint.check, lint.units_of(entries.values())):
            known += were_known
            failed += with_findings
            if with_findings:
                print(words, flush=True)
    print(f"tidy: {len(entries)} sources, {known} of them known to pass, {failed} groups with findings")
    return 1 if failed else 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--each", action="store_true", help="see above")
    parser.add_argument("build")
    parser.add_argument("sources", nargs="+")
    arguments = parser.parse_args()
    sys.exit(main(arguments.build, arguments.sources, arguments.each))
