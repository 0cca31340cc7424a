#!/usr/bin/env python3
"""Waves of diodes that change sides, down long multipliers and lines: the circuit's own, whatever the tolerance.

usage: waves.py PROGRAM

A Cockcroft-Walton multiplier whose diodes have resistance is a line: from rest its first nanoseconds send waves up and
down it, on which diodes close and open hundreds of times with currents a millionth of the largest, or less. That
looks like rounding, and is none: the same diodes change sides in the same order at tolerances of 1e-6 and of 1e-10.
With a source that steps, currents of the far diodes are held to a scale of their own, a hundredth of the largest
current there is; a band of doubt around 0 that is a part of the latter would let them be negative by more than the
tolerance, which the audit of all devices finds.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SINE = "v1 ac 0 sin(0 100 1k)"
STEPS = "v1 ac 0 pulse(-100 100 0 1u 1u 0.5m 1m)"


def multiplier(stages, diode, source, stop, *besides):
    lines = [f"multiplier of {stages} stages", f".model dm d({diode})", source, *besides]
    a, b = "ac", "0"
    for k in range(1, stages + 1):
        lines += [f"ca{k} {a} a{k} 1u", f"da{k} {b} a{k} dm", f"cb{k} {b} b{k} 1u", f"db{k} a{k} b{k} dm"]
        a, b = f"a{k}", f"b{k}"
    return "\n".join([*lines, f"rl {b} 0 10meg", f".tran 10u {stop} uic", ".save v(a1) v(b1)", ".end", ""])


def clamped_line(sections):
    """Of coils and capacitors, with two diodes that clamp each section."""
    lines = [f"line of {sections} clamped sections", ".model dm d(ron=1)", "v1 s 0 sin(0 10 100k)",
             "rs s n0 30", "vr rail 0 5"]
    for k in range(1, sections + 1):
        lines += [f"l{k} n{k - 1} n{k} 1u", f"c{k} n{k} 0 1n", f"d{k} n{k} rail dm", f"dl{k} 0 n{k} dm"]
    return "\n".join([*lines, f"rt n{sections} 0 30", ".tran 100n 20u uic", ".save v(n1) v(n2)", ".end", ""])


SAME_ORDER = {
    "a multiplier with 1 ohm": (multiplier(20, "ron=1", SINE, "0.4m"), 200),
    "a multiplier with 100 ohm": (multiplier(20, "ron=100", SINE, "0.4m"), 200),
    "a multiplier with thresholds": (multiplier(20, "ron=1 vfwd=0.7", SINE, "2m"), 100),
    "a clamped line": (clamped_line(40), 500),
}
AUDITED = {
    "a step beside 10 kA": multiplier(30, "ron=1", STEPS, "2m", "rb ac 0 10m"),
    "a step into many stages": multiplier(100, "ron=1", STEPS, "2m"),
}


def turns(program, netlist, tolerance):
    result = run(program, netlist, method=None, tolerance=tolerance)
    events = result.report["events"] if result.status == 0 else []
    return [(event["element"], event["state"]) for event in events]


def main():
    program = sys.argv[1]
    checker = Checker("waves")
    for name, (netlist, least) in some_of(SAME_ORDER.items()):
        coarse = turns(program, netlist, 1e-6)
        checker.check(len(coarse) >= least, f"{name}: {len(coarse)} events")
        checker.check(coarse == turns(program, netlist, 1e-10), f"{name}: another order at 1e-10")
    for name, netlist in some_of(AUDITED.items()):
        result = run(program, netlist, method=None, options=["--audit", "full"])
        checker.check(result.status == 0, f"{name}: status {result.status}, {result.stderr[:200]}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
