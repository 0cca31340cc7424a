#!/usr/bin/env python3
"""What programs send to libngspice.so.0, and what they get.

usage: sequences.py CLIENT LIBRARY SEQUENCE [--write]

Runs the calls of the file with client.c. Behind them, from a line `----` on, is what it prints: numbers agree to 1e-9,
all else to the letter. With --write the file gets what is printed now.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

NUMBER = re.compile(r"-?\d+\.?\d*(?:e[-+]?\d+)?")
PARTS = "* parts of the sheet\n.model rect d(n=0.01)\n"
BREAK = "----\n"


def agrees(line, wanted):
    if NUMBER.sub("#", line) != NUMBER.sub("#", wanted):
        return False
    if "elapsed" in line or "Last run" in line:
        return True
    return all(abs(float(a) - float(b)) <= 1e-9 * max(abs(float(b)), 1e-6)
               for a, b in zip(NUMBER.findall(line), NUMBER.findall(wanted)))


def answers(client, library, calls, *words):
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "here").mkdir()
        (pathlib.Path(folder) / "here" / "parts.lib").write_text(PARTS, encoding="utf-8")
        done = subprocess.run([client, library, "talk", *words], input=calls, text=True, check=False,
                              capture_output=True, cwd=folder, timeout=100)
    assert done.returncode == 0, f"{done.returncode}: {done.stdout[-2000:]}{done.stderr}"
    assert done.stderr == "", done.stderr
    return done.stdout


def main():
    client, library, path = [pathlib.Path(name).resolve() for name in sys.argv[1:4]]
    calls, _, wanted = path.read_text(encoding="utf-8").partition(BREAK)
    words = ["nodata"] if path.stem in ("fritzing", "kicad") else []
    printed = answers(client, library, calls, *words)
    if "--write" in sys.argv:
        path.write_text(calls + BREAK + printed, encoding="utf-8")
        return 0
    lines, expected = printed.splitlines(), wanted.splitlines()
    for k, (line, want) in enumerate(zip(lines, expected)):
        assert agrees(line, want), f"{path.name}, answer {k + 1}:\n  {line}\nnot\n  {want}"
    assert len(lines) == len(expected), f"{len(lines)} lines, not {len(expected)}: {lines[len(expected):]}"
    print(f"{len(lines)} lines as expected")
    return 0


if __name__ == "__main__":
    sys.exit(main())
