#!/usr/bin/env python3
"""Runs every command of a page of doc/ in a folder of its own: each line "$ ..." of its code blocks.

usage: documented.py PAGE DALCS
The files that the page names must be there afterwards, and where output follows a command in its
block, it must be what the command prints.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77


def commands(page):
    """(command, the lines of output that follow it) of all code blocks."""
    for block in re.findall(r"^```\n(.*?)^```", page.read_text(), re.S | re.M):
        found = []
        for line in block.splitlines():
            if line.startswith("$ "):
                found.append((line[2:], []))
            elif found:
                found[-1][1].append(line)
        yield from found


def main(page, program):
    if not shutil.which("gnuplot"):
        print("gnuplot is not installed")
        return SKIPPED
    failed = n = 0
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(ROOT / "netlists", pathlib.Path(folder, "netlists"))
        os.symlink(program.resolve(), pathlib.Path(folder, "dalcs"))
        environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "COLUMNS": "72",
                       "LC_ALL": "C.UTF-8"}
        for command, expected in commands(page):
            n += 1
            done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment,
                                  capture_output=True, text=True, check=False)
            if "without the library" in done.stderr:
                continue
            printed = done.stdout.rstrip("\n").split("\n")
            wrong = done.returncode != 0 or (expected and [line.rstrip() for line in printed]
                                             != [line.rstrip() for line in expected])
            missing = [name for name in re.findall(r"-o (\S+)", command)
                       if not pathlib.Path(folder, name).exists()]
            if wrong or missing:
                failed += 1
                print(f"FAIL: {command}\n{done.stdout}{done.stderr}missing: {missing}")
    print(f"{page.name}: {n} commands, {failed} failed")
    return 0 if n > 0 and failed == 0 else 1


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
