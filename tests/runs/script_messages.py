#!/usr/bin/env python3
"""Checks the messages of a run, most of them about a .control block, word by word.

usage: script_messages.py PROGRAM NAME.cir [--update]

NAME.err is what stderr must be for a netlist of messages/. Most have a mistake in their block: where
there is an error, the exit status is 3, and no file is written under its name.
"""

import difflib
import pathlib
import subprocess
import sys
import tempfile


def main():
    program, netlist = pathlib.Path(sys.argv[1]).absolute(), pathlib.Path(sys.argv[2])
    expected_file = netlist.with_suffix(".err")
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "out.csv"
        done = subprocess.run([program, "run", netlist.name, "-o", output],
                              capture_output=True, timeout=60, check=False,
                              cwd=netlist.absolute().parent)
        left = output.exists()
        said = done.stderr.decode("utf-8").replace(folder, "FOLDER")
    if sys.argv[3:] == ["--update"]:
        expected_file.write_text(said, encoding="utf-8")
        return 0
    expected = expected_file.read_text(encoding="utf-8")
    sys.stdout.writelines(difflib.unified_diff(expected.splitlines(True), said.splitlines(True),
                                               "expected", "said"))
    fails = ": error:" in expected
    ended = done.returncode == (3 if fails else 0) and left != fails
    return 0 if said == expected and ended else 1


if __name__ == "__main__":
    sys.exit(main())
