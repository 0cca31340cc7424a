#!/usr/bin/env python3
"""Diodes that are in one state at the start of a run and in the other one picoseconds later.

usage: brief_starts.py PROGRAM

A diode with a leak blocks until what a coil drives through the leak is its forward voltage; one of three phases conducts
until the others have charged a stray of the load. That is an event like any other: it is at its time, above 0, and there
are as many events as with a far smaller tolerance. The boost converter's is known: L di/dt = vin - roff i up to
roff i = vfwd.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

BOOST = """vin in 0 24
vg g 0 pulse(0 1 0 10n 10n 3.39u 20u)
l1 in sw 6.204u
s1 sw 0 g 0 sm
d1 sw out mfull
c1 out 0 6.383u
r1 out 0 4.7
.model sm sw(ron=0 vt=0.5 vh=0)
.model mfull d(ron=390m roff=990k vfwd=0.7 vrev=48)
.tran 360n 36u uic
"""
BRIDGE = """v1 a q pulse(-60 120 1u 10n 10n 4u 10u)
r1 q s1 120m
l1 s1 b 364n
d1 a p mfull
d2 b p mfull
d3 0 a mfull
d4 0 b mfull
c1 p 0 15.07n
r2 p 0 153.3k
.model mfull d(ron=330m roff=740k vfwd=0.7 vrev=26)
.tran 35.7n 35.7u uic
"""
PHASES = """va na 0 sin(0 300 400 0 0 0)
r1 na qa 190m
l1 qa aa 192.5u
vb nb 0 sin(0 300 400 0 0 -120)
r2 nb qb 190m
l2 qb ab 192.5u
vc nc 0 sin(0 300 400 0 0 120)
r3 nc qc 190m
l3 qc ac 192.5u
d1 aa p mideal
d2 m aa mideal
d3 ab p mideal
d4 m ab mideal
d5 ac p mideal
d6 m ac mideal
r4 p m 9k
r5 p 0 6.1k
.model mideal d(ron=0 vfwd=0)
.tran 5.8u 5.8m uic
"""
LOADED = """va na 0 sin(0 25 60 0 0 30)
r1 na qa 24m
vb nb 0 sin(0 25 60 0 0 -90)
r2 nb qb 24m
vc nc 0 sin(0 25 60 0 0 -210)
r3 nc qc 24m
d1 qa p mideal
d2 m qa mideal
d3 qb p mideal
d4 m qb mideal
d5 qc p mideal
d6 m qc mideal
r4 p x1 1.7
l1 x1 x2 4.533m
c1 x2 m 558.8u
r5 x2 m 17
r6 p 0 97k
.model mideal d(ron=0 vfwd=0)
.tran 33.83u 33.83m uic
"""
# The diode, its state behind the first event, the time of it: from the formula above, else from an exact solution.
CIRCUITS = {
    "boost": (BOOST, "d1", "on", -6.204e-6 / 990e3 * math.log1p(-0.7 / 24)),
    "bridge": (BRIDGE, "d2", "on", 1.1613501498954757e-14),
    "three phases": (PHASES, "d1", "off", 5.8777364142810304e-12),
    "three phases, a load": (LOADED, "d5", "off", 1.9179276888402427e-10),
}
TOLERANCES = [f"1e-{k}" for k in range(3, 10)]


def events(result):
    """By element and side, in order: diodes may change sides in the same moment."""
    return sorted((event["element"], event["state"], event["time"]) for event in result.report["events"])


def main():
    program = sys.argv[1]
    checker = Checker("brief starts")
    for name, (circuit, diode, state, time) in CIRCUITS.items():
        netlist = f"{name}\n{circuit}.end\n"
        exact = events(run(program, netlist, method=None, tolerance="1e-10"))
        for tolerance in some_of(TOLERANCES):
            case = f"{name}, {tolerance}"
            result = run(program, netlist, method=None, tolerance=tolerance)
            if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
                continue
            found = events(result)
            checker.check([event[:2] for event in found] == [event[:2] for event in exact],
                          f"{case}: {len(found)} events, not {len(exact)}")
            first = min((event[2] for event in found if event[:2] == (diode, state)), default=math.inf)
            checker.check(abs(first - time) <= 1e-3 * time, f"{case}: {diode} is {state} at {first}, not {time}")
            checker.check(result.report["work"]["euler_steps"] == 0, f"{case}: steps of Euler")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
