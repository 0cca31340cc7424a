#!/usr/bin/env python3
"""The same calls to dalcs's library and to ngspice's own: names, types and answers are the same, values nearly so.

usage: compare.py CLIENT OURS THEIRS SEQUENCE...

The circuits have linear parts only. ngspice's values are off by its tolerance; how far from ours they may be is
said at TOLERANCE.
"""

import re
import subprocess
import sys

# of 10 V or 0.1 A at most: trapezoidal steps of 1 us in waves of 1 ms, (2 pi h/T)^2 / 12 = 3e-6, and reltol 1e-6
# of each step; straight lines between rows add (2 pi h/T)^2 / 8 = 5e-6
TOLERANCE = 2e-5
VALUE = re.compile(r"^(.*) = (-?[\d.]+(?:e[-+]?\d+)?)$")


def answers(client, library, calls):
    done = subprocess.run([client, library], input=calls, text=True, check=False, capture_output=True,
                          timeout=100)
    assert done.returncode == 0, f"{library}: {done.returncode}\n{done.stdout}{done.stderr}"
    # ngspice misses its start files, which is an error to it
    return [re.sub(r"errors \d", "errors", line) for line in done.stdout.splitlines()]


def compare(ours, theirs):
    values = 0
    for our, their in zip(ours, theirs):
        mine, other = VALUE.match(our), VALUE.match(their)
        if mine and other:
            assert mine[1] == other[1], f"{our}\n{their}"
            a, b = float(mine[2]), float(other[2])
            scale = 0.1 if "branch" in mine[1] else 10.0
            assert abs(a - b) <= TOLERANCE * scale, f"{our}, ngspice: {b}"
            values += 1
        else:
            assert our == their, f"ours: {our}\ntheirs: {their}"
    assert len(ours) == len(theirs)
    return values


def main():
    client, ours, theirs = sys.argv[1:4]
    for name in sys.argv[4:]:
        with open(name, encoding="utf-8") as file:
            calls = file.read()
        mine = answers(client, ours, calls)
        values = compare(mine, answers(client, theirs, calls))
        assert values > 5 and len(mine) > 30, f"{name}: too little was compared"
        print(f"{name}: {len(mine)} answers, {values} values")
    return 0


if __name__ == "__main__":
    sys.exit(main())
