#!/usr/bin/env python3
"""Holds docs/faq.md against the sources: each message that it quotes is one of the program's, and each warning of the
stages that work on a cloud is quoted there.

check_faq.py    in any folder of the repository
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).parent.parent
LITERAL = r'"(?:[^"\\\n]|\\.)*"'
CALLS = r"(?:warnings\.(?:push_back|emplace_back)\(|\bGrade::\w+,)(.*?);\n"  # warnings, and doubts of the verdict
FOLDERS = ("raw", "cells", "paper", "pipeline", "io")


def literals(code):
    """Strings, those beside each other joined."""
    return ["".join(part[1:-1] for part in re.findall(LITERAL, run)).replace('\\"', '"')
            for run in re.findall(rf"{LITERAL}(?:\s*{LITERAL})*", code)]


def pieces(message, hole):
    """What is said between the numbers and names."""
    return [piece for piece in (part.strip(" .,:;'()") for part in re.split(hole, message)) if len(piece) > 3]


def main():
    sources = [file.read_text(encoding="utf-8") for folder in ("src", "apps") for file in ROOT.glob(f"{folder}/**/*.cpp")]
    said = "\n".join(text for code in sources for text in literals(code))
    faq = " ".join((ROOT / "docs/faq.md").read_text(encoding="utf-8").split())
    faults = []
    quoted = re.findall(r"\*\*`([^`]+)`\*\*", faq)
    for message in quoted:
        faults += [f"no message of the program has '{piece}'" for piece in pieces(message, r"\.\.\.|--[a-z-]+") if piece not in said]
    warnings = 0
    for folder in FOLDERS:
        for file in sorted(ROOT.glob(f"src/{folder}/**/*.cpp")):
            for call in re.findall(CALLS, file.read_text("utf-8"), re.DOTALL):
                for message in literals(call):
                    warnings += 1
                    longest = max(pieces(message, r"\{[^}]*\}"), key=len, default="")
                    if longest and longest not in faq:
                        faults.append(f"{file.relative_to(ROOT)}: docs/faq.md does not have '{longest}'")
    for fault in faults:
        print(fault)
    print(f"{len(quoted)} messages quoted, {warnings} warnings looked for, {len(faults)} faults")
    return 1 if faults or not quoted or not warnings else 0


if __name__ == "__main__":
    sys.exit(main())
