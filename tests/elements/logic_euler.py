#!/usr/bin/env python3
"""Gates, latches and samples in steps of implicit Euler, against runs with events: an error that goes with the step.

usage: logic_euler.py PROGRAM
"""

import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "steady"))
import gate_circuits  # pylint: disable=wrong-import-position,import-error

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker  # pylint: disable=wrong-import-position,import-error

STEPS = (1000, 4000)  # of a clock


def final(program, folder, text, *options):
    (folder / "c.cir").write_text(text)
    done = subprocess.run([program, "run", "c.cir", "-q", "-o", "none", "--report", "c.json", *options], cwd=folder,
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    return json.loads((folder / "c.json").read_text())["final"]


def look_at(checker, program, folder, circuit):
    name, netlist, level, _, clock, _ = circuit
    stop = 7.37 * clock
    text = netlist.replace("{S}", repr(level)) + f".tran {clock / 100!r} {stop!r} uic\n"
    exact = final(program, folder, text, "--tol", "1e-9")
    scale = {kind: max(abs(v) for s, v in exact.items() if s[0] == kind) for kind in {s[0] for s in exact}}
    off = []
    for n in STEPS:
        found = final(program, folder, text, "--method", "euler", "--step", repr(clock / n))
        off.append(max(abs(found[s] - exact[s]) / scale[s[0]] for s in exact))
    checker.check(off[0] <= 0.05, f"{name}: off by {off[0]:.2g} with {STEPS[0]} steps in a clock")
    checker.check(off[1] <= 0.5 * off[0] + 1e-9, f"{name}: off by {off}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("logic_euler")
    with tempfile.TemporaryDirectory() as name:
        for circuit in gate_circuits.CIRCUITS:
            try:
                look_at(checker, program, pathlib.Path(name), circuit)
            except RuntimeError as error:
                checker.check(False, f"{circuit[0]}: {error}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
