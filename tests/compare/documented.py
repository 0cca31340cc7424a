#!/usr/bin/env python3
"""Runs the commands of a page: lines that are indented by four blanks and begin with dalcs.

usage: documented.py PROGRAM PAGE
"""

import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import NETLISTS, Checker  # noqa: E402


def main():
    program, page = map(pathlib.Path, sys.argv[1:])
    checker = Checker("compare_documented")
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(NETLISTS, pathlib.Path(folder) / "netlists")
        for line in page.read_text().splitlines():
            if line.startswith("    dalcs "):
                words = shlex.split(line, comments=True)
                done = subprocess.run([program.resolve(), *words[1:]], cwd=folder,
                                      stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                      check=False)
                checker.check(done.returncode == 0,
                              f"{line.strip()}: status {done.returncode}\n{done.stderr}")
                for k, word in enumerate(words[:-1]):
                    if word == "-o":
                        checker.check((pathlib.Path(folder) / words[k + 1]).stat().st_size > 0,
                                      f"{line.strip()}: wrote nothing")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
