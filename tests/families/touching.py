#!/usr/bin/env python3
"""Diodes whose voltage comes up to 0 at each peak of a sine, and no farther; switches whose control does.

usage: touching.py PROGRAM

Without a load a capacitor is charged once, and from then on each peak touches what it was charged to. Whether an
error leaves it a little above or below, nothing happens: the diode has opened once.

A reference passes 0 where the top of its carrier touches 0. By rounding the switch between them would open and close at
one time, and be open for none.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

CIRCUITS = {
    "peak detector": ("V1 in 0 SIN(0 10 50)\nD1 in out\nC1 out 0 10u\n", 5e-3, 1.0),
    "clamp": ("V1 in 0 SIN(0 10 50)\nC1 in out 10u\nD1 out 0\n", 5e-3, 1.0),
    "divider": ("V1 in 0 SIN(0 3.1 100k)\nC1 in m 2.786n\nC2 m 0 2.857n\nD1 m 0\n", 2.5e-6, 2e-3),
}
PWM = """a carrier of {n} periods below a sine
V1 r 0 SIN(0 0.9 {f!r} 0 0 {phase})
V2 t 0 PULSE(-1 0 0 {half!r} {half!r} 0 {period!r})
V3 in 0 10
S1 in x r t sw
L1 x y {l!r} ic=4
R1 y 0 1
R2 x 0 1e6
.model sw SW(vt=0)
.tran {period!r} {stop!r} uic
.end
"""
CARRIERS = [(n, phase, period) for n, phase in ((9, -120), (13, 0), (21, -120), (45, -120))
            for period in (3.4183119535117871e-06, 1e-5, 1.37e-4)]
TOLERANCES = [f"1e-{k}" for k in range(3, 11)]


def check_commands(program, checker):
    for n, phase, period in CARRIERS:
        netlist = PWM.format(n=n, phase=phase, period=period, f=1 / (n * period), half=period / 2, l=5 * period,
                             stop=n * period)
        result = run(program, netlist, method=None)
        case = f"a carrier of {n} periods of {period} s"
        if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
            continue
        times = [e["time"] for e in result.report["events"] if e["element"] == "s1"]
        apart = min(later - earlier for earlier, later in zip(times, times[1:]))
        checker.check(apart > 1e-3 * period, f"{case}: events {apart} s apart")


def main():
    program = sys.argv[1]
    checker = Checker("touching")
    for name, (circuit, opens, stop) in CIRCUITS.items():
        for tolerance in some_of(TOLERANCES):
            result = run(program, f"{name}\n{circuit}.tran {stop / 1e3} {stop} uic\n.end\n", method=None,
                         tolerance=tolerance)
            case = f"{name}, {tolerance}"
            if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
                continue
            events = result.report["events"]
            checker.check(len(events) == 1, f"{case}: {len(events)} events")
            checker.check(abs(events[0]["time"] - opens) <= 1e-6 * stop, f"{case}: at {events[0]['time']}")
            checker.check(result.report["work"]["euler_steps"] == 0, f"{case}: steps of Euler")
    check_commands(program, checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
