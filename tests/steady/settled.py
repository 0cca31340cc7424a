#!/usr/bin/env python3
"""Every circuit of a kind: its steady state against a run that is long enough to be in it.

usage: settled.py PROGRAM KIND

How long is long enough follows from the largest multiplier; where that is wrong, the two differ.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
import kinds  # pylint: disable=import-error

MOST_STEPS = 10  # of Newton's method
MOST_PERIODS = 20000  # that a run may settle
NEAR = 1e-9


def run(program, folder, netlist, verb, *options):
    (folder / "c.cir").write_text(netlist)
    done = subprocess.run([program, verb, "c.cir", "-q", "-o", "c.csv", "--report", "c.json",
                           *options], cwd=folder, capture_output=True, text=True, check=False)
    report = json.loads((folder / "c.json").read_text()) if (folder / "c.json").exists() else None
    return done, report


def off(steady, final):
    """The largest difference of states, over the largest rms value of their unit."""
    worst = 0.0
    for kind, unit in (("c", "v("), ("l", "i(")):
        scale = max(signal["rms"] or 0.0 for name, signal in steady["signals"].items()
                    if name.startswith(unit))
        worst = max([worst] + [abs(steady["states"][name] - final[name]) / scale
                               for name in final if name[0] == kind])
    return worst


def look_at(program, folder, checker, name, body):
    head = f"* {name}\n{body}"
    done, report = run(program, folder, head + ".pss uic\n.end\n", "steady")
    if not checker.check(done.returncode == 0, f"{name}: {done.stderr}"):
        return
    steady = report["steady"]
    checker.check(steady["newton"] <= MOST_STEPS, f"{name}: {steady['newton']} Newton steps")
    largest = max([math.hypot(m["re"], m["im"]) for m in steady["multipliers"]], default=0.0)
    if not checker.check(steady["stable"] and largest < 1.0, f"{name}: {steady['verdict']}"):
        return
    # A multiplier mu leaves mu^n of what is off at first, and in defective cases n mu^n.
    periods = 20 if largest < 0.1 else math.ceil(1.3 * math.log(1e-12) / math.log(largest)) + 20
    if periods > MOST_PERIODS:
        return
    stop = periods * steady["period"]
    card = f".tran {stop!r} {stop!r} {stop * (1 - 1e-9)!r} uic\n.end\n"
    done, settled = run(program, folder, head + card, "run", "--tol", "1e-11", "--fill", "none")
    if not checker.check(done.returncode == 0, f"{name}, settled: {done.stderr}"):
        return
    worst = off(steady, settled["final"])
    checker.check(worst <= NEAR, f"{name}: off by {worst:.2g} after {periods} periods; "
                                 f"{steady['verdict']}, {steady['multipliers']}")


def main():
    program, kind = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    checker = dalcs_program.Checker(kind)
    with tempfile.TemporaryDirectory() as folder:
        for name, body in dalcs_program.some_of(kinds.KINDS[kind]()):
            look_at(program, pathlib.Path(folder), checker, name, body)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
