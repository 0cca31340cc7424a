#!/usr/bin/env python3
"""Coils that meet at kilohms, in a circuit too large for a dense map: amperes that differ by microamperes.

usage: meeting.py PROGRAM

Five pulses feed one load through two coils in a row each, and a resistor at the node in between makes a voltage of
what their currents differ by. Behind each edge that voltage follows its source within nanoseconds, and the
currents, far within their tolerance, do not tell whether it has yet.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

CELLS = 5
CASES = ("2k", "30u"), ("10k", "100u"), ("20k", "300u")  # resistance, inductance
TIMES = [100e-6 * (k + 0.618) / 500.5 for k in range(500)]
TOLERANCE = 1e-6
REFERENCE = 1e-11
MOST_STEPS = 1500


def netlist(resistance, inductance):
    cards = [f"""v{k} in{k} 0 pulse(0 10 {1 + k / 10}u 0 0 {4 + k}u 10u)
r{k} in{k} a{k} 0.1
la{k} a{k} y{k} {inductance}
ry{k} y{k} 0 {resistance}
lb{k} y{k} out {inductance}""" for k in range(CELLS)]
    return "\n".join(["meeting", *cards, "cl out 0 100u ic=5", "rl out 0 1", ".tran 1u 100u uic", ".end\n"])


def main():
    program = sys.argv[1]
    checker = Checker("meeting")
    for resistance, inductance in CASES:
        text = netlist(resistance, inductance)
        exact = run(program, text, at=TIMES, method="radau", tolerance=REFERENCE, stages=5)
        result = run(program, text, at=TIMES, method=None, tolerance=TOLERANCE)
        case = f"{resistance}, {inductance}"
        if not checker.check(exact.status == 0 and result.status == 0, f"{case}: {exact.stderr}{result.stderr}"):
            continue
        steps = result.report["work"]["steps"]
        checker.check(steps <= MOST_STEPS, f"{case}: {steps} steps")
        for name in exact.names[1:]:
            scale = max(map(abs, exact.column(name)))
            error = max(abs(a - b) for a, b in zip(result.column(name), exact.column(name)))
            checker.check(error <= TOLERANCE * scale, f"{case}: {name} is off by {error / scale:.1e}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
