#!/usr/bin/env python3
"""Unstable circuits grow until numbers end: then the run fails and says so, and no row holds what is no number.

usage: unstable.py PROGRAM
"""

import math
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker  # noqa: E402

LIMIT = math.log(1e240)
# name, netlist, element, when its logarithm has grown to LIMIT (s)
CASES = [
    ("capacitor", "C1 a 0 1u ic=1\nR1 a 0 -1\n.tran 0.1u 2m uic", "c1", LIMIT * 1e-6),
    ("coil", "L1 a 0 1m ic=1\nR1 a 0 -1k\n.tran 0.1u 2m uic", "l1", LIMIT * 1e-6),
    ("beside a diode", "C1 a 0 1u ic=1\nR1 a 0 -1\nD1 a b\nR2 b 0 1\nR3 a 0 -1\n.tran 0.1u 2m uic",
     "c1", LIMIT * 1e-6),
    ("by a controlled source", "C1 a 0 1u ic=1\nG1 0 a a 0 1\n.tran 0.1u 2m uic", "c1", LIMIT * 1e-6),
    ("ringing", "C1 a 0 1n ic=1\nL1 a 0 1u\nR1 a 0 -1k\n.tran 0.1u 5m uic", None, 2 * LIMIT * 1e-6),
]
OK, FAILED = 0, 1


def run(program, folder, netlist, *options):
    (folder / "a.cir").write_text(f"unstable\n{netlist}\n.end\n")
    return subprocess.run([program, "run", "a.cir", "-o", "a.csv", *options], cwd=folder, timeout=60,
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)


def rows_of(path):
    return [[float(word) for word in line.split(",")] for line in path.read_text().splitlines()[1:]]


def check(checker, program, folder, case, options):
    name, netlist, element, wanted = case
    name = f"{name} {options}"
    done = run(program, folder, netlist, *options)
    found = re.search(r"at t = (\S+) s the circuit is unstable: the (?:voltage|current) of "
                      r"'(\w+)' has grown to more than 1e240 [VA]\n", done.stderr)
    if not checker.check(done.returncode == FAILED and found, f"{name}: {done.stderr}"):
        return
    checker.check(element in (None, found.group(2)), f"{name}: names {found.group(2)}")
    # Radau reports growth at the end of a step, and the growth of euler is another one.
    checker.close(float(found.group(1)), wanted, 0.1 * wanted, f"{name}: time")
    checker.check(all(math.isfinite(value) for row in rows_of(folder / "a.partial.csv") for value in row),
                  f"{name}: a row holds what is no number")


def main():
    program, checker = str(pathlib.Path(sys.argv[1]).resolve()), Checker("unstable circuits")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for case in CASES:
            check(checker, program, folder, case, [])
        check(checker, program, folder, CASES[0], ["--method", "euler"])
        for times, status in (0.5, OK), (2.0, FAILED):
            stop = (LIMIT + math.log(times)) * 1e-6
            done = run(program, folder, f"C1 a 0 1u ic=1\nR1 a 0 -1\n.tran 1u {stop!r} uic")
            checker.check(done.returncode == status, f"{times} times what a state may grow to: {done.stderr}")
        done = run(program, folder, "C1 a 0 1u ic=1\nR1 a 0 -1\n.tran 1u 0.3m uic")
        checker.check(done.returncode == OK, f"it has not grown so far yet: {done.stderr}")
        last = rows_of(folder / "a.csv")[-1]
        checker.close(math.log(last[1]), 300.0, 1e-6, "what has grown")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
