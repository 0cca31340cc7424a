#!/usr/bin/env python3
"""Power circuits drawn at random, each run once with the whole waveform audited.

usage: power_runs.py PROGRAM FIRST-LAST[,...] [WORD]

The seeds are those of random_power.py; WORD: only titles that hold it. A run must end, find nothing in its audit, take
no steps of implicit Euler but for one known circuit, and no more than 100 steps for each event and edge. `check` must
not say that no solution exists.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import random_power  # noqa: E402
from circuits import write  # noqa: E402
from dalcs_program import Checker, run, some_of  # noqa: E402

LIMIT = 120  # s
STEPS_OF_EACH = 100
# A coil of 70 uH that 100 Mohm cut off: its current is too small to be told from what interpolation left of it, and too
# large to be let be. The step ends the doubt, and the waveform is right.
EULER_STEPS = {"phase_controlled 0": 1}


def edges(circuit):
    """Of pulses, and eight a period of each sine."""
    n = 0.0
    for e in circuit.of("vi"):
        kind, numbers = e.function or ("", [])
        n += 4 * (circuit.stop / numbers[6] + 1) if kind == "pulse" else 0.0
        n += 8 * (circuit.stop * numbers[2] + 1) if kind == "sin" else 0.0
    return n


def answers(program, text):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "circuit.cir"
        path.write_text(text)
        done = subprocess.run([program, "check", str(path), "--json"], capture_output=True, text=True, check=False,
                              timeout=LIMIT)
    return {part["verdicts"]["exists"]["answer"] for part in json.loads(done.stdout)["parts"]}


def look(program, checker, circuit):
    text = write(circuit)
    outcome = run(program, text, method=None, options=["--audit", "full"], environment={"LC_ALL": "C"})
    if checker.check(outcome.status == 0, f"{circuit.title}: {outcome.stderr}"):
        work, n_events = outcome.report["work"], len(outcome.report["events"])
        checker.check(work["euler_steps"] <= EULER_STEPS.get(circuit.title, 0),
                      f"{circuit.title}: {work['euler_steps']} steps of implicit Euler")
        allowed = STEPS_OF_EACH * (n_events + edges(circuit) + 10)
        checker.check(work["steps"] <= allowed, f"{circuit.title}: {work['steps']} steps for {n_events} events")
        checker.check("no" not in answers(program, text), f"{circuit.title}: check says that no solution exists")


def main():
    program, seeds = sys.argv[1:3]
    word = sys.argv[3] if len(sys.argv) > 3 else ""
    checker = Checker("power_runs")
    for part in seeds.split(","):
        first, _, last = part.partition("-")
        for seed in some_of(range(int(first), int(last or first) + 1), 4):
            circuit = random_power.draw(seed)
            if word in circuit.title:
                look(program, checker, circuit)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
