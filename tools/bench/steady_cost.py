#!/usr/bin/env python3
"""What a steady state costs, against a run that settles: instructions, by valgrind.

usage: steady_cost.py PROGRAM [NETLIST ...]

Without netlists the reference circuits of tests/steady/cases are taken. The run is at --tol 1e-11, of as many periods as
the largest multiplier takes to leave 1e-9 of a difference, and has no rows. What starting up costs, a run of a millionth of
a period, is taken off all. Prints a line of Markdown for each, in millions of instructions.
"""

import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

CASES = pathlib.Path(__file__).resolve().parents[2] / "tests" / "steady" / "cases"
LEFT = 1e-9


def count(folder, *command):
    """Millions of instructions."""
    done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *command], cwd=folder,
                          capture_output=True, text=True, check=False)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if found is None:
        raise RuntimeError(done.stderr)
    return int(found.group(1)) / 1e6


def measure(program, folder, path):
    netlist = re.sub(r"^\.(tran|pss|end).*\n?", "", path.read_text(), flags=re.M | re.I) + "\n"
    (folder / "steady.cir").write_text(netlist + ".pss uic\n")
    done = subprocess.run([program, "steady", "steady.cir", "-q", "-o", "none", "--report", "steady.json"], cwd=folder,
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return f"| {path.stem} | refused: {done.stderr.splitlines()[-1]} |"
    steady = json.loads((folder / "steady.json").read_text())["steady"]
    factors = [math.hypot(m["re"], m["im"]) for m in steady["multipliers"]]
    slowest = max((f for f in factors if abs(f - 1.0) > 1e-9), default=0.0)
    if slowest >= 1.0:
        return f"| {path.stem} | no run stays there |"
    periods = math.ceil(math.log(LEFT) / math.log(slowest)) if slowest > LEFT else 1
    for name, stop in (("run", periods * steady["period"]), ("start", 1e-6 * steady["period"])):
        (folder / f"{name}.cir").write_text(netlist + f".tran {stop!r} {stop!r} {stop * (1 - 1e-9)!r} uic\n")
    start = count(folder, program, "run", "start.cir", "-q", "-o", "none", "--audit", "off")
    run = count(folder, program, "run", "run.cir", "-q", "-o", "none", "--audit", "off", "--tol", "1e-11", "--fill", "none")
    search = count(folder, program, "steady", "steady.cir", "-q", "-o", "none", "--audit", "off")
    whole = count(folder, program, "steady", "steady.cir", "-q", "-o", "none")
    run, search, whole = run - start, search - start, whole - start
    return (f"| {path.stem} | {steady['newton']} | {steady['periods']} | {periods} | {run:.3g} | {search:.3g} | {whole:.3g} | "
            f"{run / whole:.2g} |")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    paths = [pathlib.Path(name).resolve() for name in sys.argv[2:]] or sorted(CASES.glob("*.cir"))
    print("| circuit | Newton steps | periods of the search | periods of the run | the run | the search | all, audited | gain |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        for path in paths:
            print(measure(program, pathlib.Path(name), path), flush=True)


if __name__ == "__main__":
    main()
