#!/usr/bin/env python3
"""Diodes that are idle on one side of an event: without current and voltage, or in series with one that blocks.

usage: idle.py PROGRAM KIND

series: two diodes stop conducting together, behind two in parallel that stay tied. The node between them is open and
stays in the middle of what both block, at every tolerance, and both are off from then on.
rest: diodes on capacitors without a charge. What takes them forward begins at an event as a power of time, far below
what the largest voltage rounds to; they conduct from that event on.
bridge: a coil's current goes on through all four diodes of a bridge, milliamperes beside 12 V, or begins to from rest: each
has its part of it until something takes that away, which is an event.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SERIES = """v1 in 0 sin(0 7.8 1k 0 68)
d1 in out mideal
d2 in out mideal
d3 0 out mideal
d4 out o2 mideal
d5 o2 o3 mideal
r1 o3 0 770
c1 o3 0 1.221u
.model mideal d(ron=0 vfwd=0)
.tran 3.37u 3.37m uic
"""
BEHIND_A_LEAK = """v1 in 0 pwl(0m -4.2 1.912m 6 3.873m 8.7 5.816m -3.3 6.618m -2.7 7.448m -4.4 9.011m -1.9)
r1 in a 18
d1 b a mfull
r2 b c 840
r3 c 0 1.9k
c1 c 0 300n
d2 0 a mideal
c2 b 0 300n
l1 a e 5.7m
r4 e 0 9.5k
d3 c h mideal
c3 h 0 120n
r5 h 0 59k
.model mfull d(ron=18m roff=6.7meg vfwd=0.7 vrev=35)
.model mideal d(ron=0 vfwd=0)
.tran 6u 6m
"""
BEHIND_A_COIL = """v1 in 0 pwl(0m -5.2 1.867m -4.8 3.194m -7.8 3.723m 0.36 5.254m -2.7 5.827m 3.9 7.085m 3.9)
r1 in a 190
d1 a b mideal
l1 b c 81m
r2 c 0 270
c1 c 0 460n
d2 0 a mideal
i1 0 a -4.374m
d3 c h mideal
c2 h 0 66n
r3 h 0 1.1k
.model mideal d(ron=0 vfwd=0)
.tran 6u 6m
"""
BRIDGE = """vin in 0 12
vg g 0 pulse(0 1 0 20n 20n 2.08u 10u)
vh h 0 pulse(0 1 5u 20n 20n 2.08u 10u)
s1 in a g 0 sm
s2 b 0 g 0 sm
s3 in b h 0 sm
s4 a 0 h 0 sm
d1 a in mideal
d2 0 a mideal
d3 b in mideal
d4 0 b mideal
l1 a a1 786.3u
l2 a1 b 157.2m
l3 s t 6.29m
k1 l2 l3 1
d5 s x mideal
d6 t x mideal
d7 0 s mideal
d8 0 t mideal
l4 x o 629u
c1 o 0 29.41u
r1 o 0 17
.model sm sw(ron=3.8m vt=0.5 vh=0)
.model mideal d(ron=0 vfwd=0)
.tran 90n 18u uic
"""
AT_REST = """v1 a q am(33 1 3.03k 10k 0)
r1 q s1 450m
l1 s1 b 9.36u
d1 a p mideal
d2 b p mideal
d3 0 a mideal
d4 0 b mideal
r2 p x2 11
l2 x2 x3 3.85m
ve x3 0 -8.089
.model mideal d(ron=0 vfwd=0)
.tran 224n 224u uic
"""
SHARED = [(1e-8, "on"), (5.099561253e-6, "off"), (7.11e-6, "on"), (1.528494827e-5, "off"), (1.711e-5, "on")]
FED = [(1.8969762025344732e-08, "off"), (4.994243326256234e-05, "on"), (0.00010301662594061053, "off"),
       (0.0001497745422246926, "on"), (0.00020939689117161012, "off")]
STOPS = [(0.0002750118272297618 + period * 1e-3, "off") for period in range(4)]
STARTS = [(0.0000735727120890018 + period * 1e-3, "on") for period in range(1, 4)]
CONDUCTION = sorted(STOPS + STARTS)
# The events of some diodes, by an exact solution.
KINDS = {
    "series": {SERIES: (3.37e-3, {"d4": CONDUCTION, "d5": CONDUCTION})},
    "bridge": {
        BRIDGE: (18e-6, {"d5": SHARED, "d8": SHARED}),
        AT_REST: (224e-6, {"d2": FED, "d3": FED}),
    },
    "rest": {
        BEHIND_A_LEAK: (6e-3, {"d2": [(0.0007872941176470588, "off"), (0.005281673866044745, "on")],
                               "d3": [(0.0007872941176470588, "on"), (0.004601269527493529, "off")]}),
        BEHIND_A_COIL: (6e-3, {"d1": [(0.005560560209, "on")], "d2": [(0.005560560209, "off")],
                               "d3": [(0.005560560209, "on")]}),
    },
}
TOLERANCES = 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9


def check_events(checker, case, result, stop, diodes, tolerance):
    for diode, wanted in diodes.items():
        found = [(event["time"], event["state"]) for event in result.report["events"] if event["element"] == diode]
        same = [state for _, state in found] == [state for _, state in wanted]
        if checker.check(same, f"{case}: {diode} has {found}"):
            late = max(abs(a[0] - b[0]) for a, b in zip(found, wanted))
            checker.check(late <= max(10 * tolerance, 1e-9) * stop, f"{case}: {diode} is off by {late:.1e} s")


def check_middle(checker, case, result):
    """Between the first event and the one at 0.5 ms, where the source passes 0."""
    columns = [result.column(name) for name in ("time", "v(out)", "v(o2)", "v(o3)")]
    off = max(abs(o2 - (out + o3) / 2) for time, out, o2, o3 in zip(*columns) if 0.28e-3 < time < 0.49e-3)
    checker.check(off < 1e-3, f"{case}: v(o2) is off the middle by {off:.1e} V")


def main():
    program, kind = sys.argv[1:]
    checker = Checker(f"idle, {kind}")
    for circuit, (stop, diodes) in KINDS[kind].items():
        for tolerance in some_of(TOLERANCES):
            case = f"{circuit.split()[-2]}, {tolerance}"
            result = run(program, f"{kind}\n{circuit}.end\n", method=None, tolerance=tolerance)
            if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
                continue
            check_events(checker, case, result, stop, diodes, tolerance)
            if kind == "series":
                check_middle(checker, case, result)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
