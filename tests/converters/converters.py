#!/usr/bin/env python3
"""Converters as people draw them, with their control, against their equations, integrated from event to event.

usage: converters.py PROGRAM KIND [--drawn FROM-TO]    those of its list, or others with values drawn by these numbers
       converters.py show KIND NUMBER [--drawn FROM-TO]    the netlist of one

Each signal is compared at 97 times and must be within 1e-9 of its largest value there. The last converter of each kind
is run once more with a coil or capacitor that is larger by a millionth, which has to be noticed.
"""

import importlib
import pathlib
import random
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import drawn  # pylint: disable=wrong-import-position
import events  # pylint: disable=wrong-import-position
from dalcs_program import Checker, run, some_of  # pylint: disable=wrong-import-position,import-error

KINDS = {"six_pulse": "thyristors", "ac_controller": "thyristors", "gto_inverter": "thyristors",
         "peak_current": "choppers", "power_factor": "choppers", "charger": "choppers", "forward": "choppers",
         "llc": "resonant", "svpwm": "drives", "active_rectifier": "drives", "machine": "drives",
         "half_controlled": "others", "series_machine": "others", "constant_power": "others", "saturating_flyback": "others",
         "dead_time": "others"}
POINTS = 97
NEAR = 1e-9


def cases_of(kind, options):
    rows = None
    if options and options[0] == "--drawn":
        first, last = map(int, options[1].split("-"))
        rows = [getattr(drawn, kind)(random.Random(f"{kind} {seed}")) for seed in range(first, last + 1)]
    return getattr(importlib.import_module(KINDS[kind]), kind)(rows)


def text_of(case):
    names = " ".join(case.signals)
    return f"{case.name}\n{case.netlist}.save {names}\n.tran {case.stop / 1000!r} {case.stop!r} uic\n.end\n"


def spoilt(text):
    """The first coil, else capacitor, a millionth larger."""
    def larger(match):
        return match[1] + repr(float(match[2]) * (1 + 1e-6))
    for letter in "lc":
        found, n = re.subn(rf"(?m)^({letter}\S* \S+ \S+ )([0-9][0-9.e+-]*)", larger, text, count=1)
        if n:
            return found
    raise ValueError("no coil and no capacitor")


class Comparison:
    """A case, and what its equations give."""

    def __init__(self, case):
        self.case = case
        self.times = [case.stop * (k + 0.618034) / (POINTS + 0.5) for k in range(POINTS)]
        self.states, self.ends = events.values(case.circuit, case.states, case.mode, self.times)

    def run(self, program, text):
        return run(program, text, at=self.times, method=None, tolerance=self.case.tolerance)

    def off(self, done):
        """{signal: (by how much of its largest value, when)}"""
        result = {}
        for name, value in self.case.signals.items():
            wanted = [value(x) for x in self.states]
            scale = max(map(abs, wanted)) or 1.0
            result[name] = max((abs(f - w) / scale, t) for f, w, t in zip(done.column(name), wanted, self.times))
        return result


def look_at(program, checker, case):
    """The comparison, where the program has an answer."""
    comparison = Comparison(case)
    done = comparison.run(program, text_of(case))
    if not checker.check(done.status == 0, f"{case.name}: {done.stderr}"):
        return None
    work = done.report["work"]
    checker.check(work["euler_steps"] == 0, f"{case.name}: {work['euler_steps']} steps of implicit Euler")
    off = comparison.off(done)
    for name, (error, time) in off.items():
        checker.check(error <= NEAR, f"{case.name}: {name} is off by {error:.2g}, at {time:.9g} s")
    worst = max(error for error, _ in off.values())
    print(f"{case.name}: {worst:.1e}, {comparison.ends} modes, {work['steps']} steps", flush=True)
    return comparison


def main():
    if sys.argv[1] == "show":
        print(text_of(list(cases_of(sys.argv[2], sys.argv[4:]))[int(sys.argv[3])]), end="")
        return 0
    program, checker, last = pathlib.Path(sys.argv[1]).resolve(), Checker(sys.argv[2]), None
    for case in some_of(cases_of(sys.argv[2], sys.argv[3:])):
        last = look_at(program, checker, case) or last
    if last:
        done = last.run(program, spoilt(text_of(last.case)))
        worst = max(error for error, _ in last.off(done).values())
        checker.check(worst > 10 * NEAR, f"{last.case.name}: a millionth more makes {worst:.2g}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
