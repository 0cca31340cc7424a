#!/usr/bin/env python3
"""Checks the messages about one netlist, word by word.

usage: expect_messages.py PROGRAM NAME.cir [--update]

NAME.err beside the netlist holds what stderr must be, empty for no message. The exit status must be
3 when an error is among the messages, else 0. With --update, NAME.err is written instead: read it
before you keep it.
"""

import difflib
import pathlib
import re
import subprocess
import sys


def main():
    program, netlist = pathlib.Path(sys.argv[1]).absolute(), pathlib.Path(sys.argv[2])
    expected_file = netlist.with_suffix(".err")
    # In the netlist's folder, so that the names in the messages and of included files are short.
    done = subprocess.run([program, netlist.name], capture_output=True, timeout=60, check=False,
                          cwd=netlist.absolute().parent)
    said = done.stderr.decode("utf-8")
    if sys.argv[3:] == ["--update"]:
        expected_file.write_text(said, encoding="utf-8")
        return 0
    expected = expected_file.read_text(encoding="utf-8")
    status = 3 if re.search(r"^\S.*: error: ", expected, re.MULTILINE) else 0
    if done.returncode != status:
        print(f"exit status {done.returncode}, expected {status}")
    if said != expected:
        sys.stdout.writelines(difflib.unified_diff(expected.splitlines(True),
                                                   said.splitlines(True), "expected", "said"))
    return 0 if said == expected and done.returncode == status else 1


if __name__ == "__main__":
    sys.exit(main())
