#!/usr/bin/env python3
"""Circuits at rest whose diode begins to conduct as a power of time, the second to the fifth.

usage: rest.py PROGRAM

A source moves, by way of coils and capacitors, a diode without current and voltage. It conducts from the very
start and for the whole run, so nothing happens after t = 0, and all waveforms are those of the same circuit
with a short in its place. A guess that it blocks at first is right to every digit for a while: the event is
no later for that.

And an inverter of converters.py, where the voltage of a diode that blocks rises from rest likewise: the
polynomials of its first steps swing around 0, and each swing was taken for an event, 16 ps after the last.
"""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import converter_netlists  # noqa: E402
from dalcs_program import Checker, run, some_of  # noqa: E402

TOLERANCES = 1e-3, 1e-6, 1e-9
STOP, ROWS = 1e-3, 200
RAMP, BOW = "pwl(0 0 1m 1)", "sin(1 1 100 0 0 -90)"
LOAD = "r2 out 0 50\nc2 out 0 10u\n.tran 1u 1m\n.end\n"
STEPS = {"one pole": "r1 s a 10\nc1 a 0 1u\n", "two poles": "l1 s a 1m\nr1 s a 100\nc1 a 0 1u\n",
         "three poles": "r1 s b 10\nl1 b a 100u\nc1 a 0 1u\n",
         "four poles": "r1 s b 10\nc1 b 0 1u\nl1 b a 100u\nc3 a 0 1u\n"}

INVERTER, INVERTER_STOP = 34, 1.3e-4
MOST_RESTARTS = 200  # thirty thousand when it chattered, sixty now


def check_inverter(program, checker):
    netlist = re.sub(r"(?m)^\.tran .*$", f".tran 2u {INVERTER_STOP} uic",
                     converter_netlists.netlist(INVERTER))
    for tolerance in 1e-6, 1e-8, 1e-9:
        result = run(program, netlist, method=None, tolerance=tolerance)
        if checker.check(result.status == 0, f"inverter, {tolerance}: {result.stderr}"):
            restarts = result.report["work"]["restarts"]
            checker.check(restarts <= MOST_RESTARTS, f"inverter, {tolerance}: asked {restarts} times")


def main():
    program = sys.argv[1]
    checker = Checker("rest")
    check_inverter(program, checker)
    at = [STOP * (k + 0.37) / ROWS for k in range(ROWS)]
    for source in RAMP, BOW:
        for name, step in STEPS.items():
            netlist = f"from rest\nv1 s 0 {source}\n{step}d1 a out\n{LOAD}"
            linear = run(program, netlist.replace("d1 a out", "rd a out 0"), at=at, method=None, tolerance=1e-11)
            for tolerance in some_of(TOLERANCES):
                case = f"{source}, {name}, {tolerance}"
                result = run(program, netlist, at=at, method=None, tolerance=tolerance)
                if not checker.check(result.status == 0 == linear.status, f"{case}: {result.stderr}"):
                    continue
                late = [event for event in result.report["events"] if event["time"] > 0]
                checker.check(not late, f"{case}: {len(late)} events, the first at {late[:1]}")
                for signal in "v(a)", "v(out)":
                    ours, exact = result.column(signal), linear.column(signal)
                    error = max(abs(a - b) for a, b in zip(ours, exact)) / max(map(abs, exact))
                    checker.check(error <= tolerance, f"{case}: {signal} is off by {error:.1e}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
