#!/usr/bin/env python3
"""Bridges whose gates are formulas with conditions.

usage: gates_by_conditions.py PROGRAM

The gates of one half bridge follow the polarity of the line, those of the other what a condition on that polarity makes
of a clock. Beside it stands the same circuit with both in pulses: it ends at the same state. No step is one of implicit
Euler. `v(x)>a ? b : c` becomes two products of a quantity and a switch, of which one node's current is another's.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

# line in V and Hz, clock in Hz, coil in H, output in F and ohm, on-resistances of switches and of diodes
CASES = [(192.0, 73.0, 2919.0, 43e-3, 0.54e-3, 250.0, 0.0, 0.0), (325.0, 50.0, 20e3, 1e-3, 1e-3, 50.0, 0.0, 0.0),
         (12.0, 400.0, 40e3, 50e-6, 220e-6, 10.0, 1e-3, 0.0), (5e3, 16.7, 1e3, 0.2, 50e-6, 2e3, 0.0, 1e-3),
         (1.0, 1e4, 3e5, 1e-6, 1e-6, 30.0, 1e-2, 1e-2), (48.0, 60.0, 7e3, 2e-3, 4.7e-3, 5.0, 0.1, 1e-3)]
BY_CONDITIONS = ["b1 pol 0 v=v(s,n)>0 ? 1 : 0", "b2 npol 0 v=1-v(pol)", "b3 hi 0 v=v(pol)>.5 ? 1-v(g) : v(g)",
                 "b4 lo 0 v=v(pol)>.5 ? v(g) : 1-v(g)"]


def netlist(case, by_conditions):
    volts, line, clock, henry, farad, ohms, ron, of_diode = case
    half = 0.5 / line
    cards = [f"v1 s n sin(0 {volts!r} {line!r})", f"l1 s a {henry!r}", "s1 p a hi 0 sw", "d1 a p d", "s2 a 0 lo 0 sw", "d2 0 a d",
             "s3 p n npol 0 sw", "d3 n p d", "s4 n 0 pol 0 sw", "d4 0 n d", f"c1 p 0 {farad!r} ic={2 * volts!r}",
             f"r1 p 0 {ohms!r}", f"vg g 0 pulse(0 1 0 0 0 {0.5 / clock!r} {1 / clock!r})"]
    if by_conditions:
        cards += BY_CONDITIONS
    else:  # the clock turned round at each half of the line, by sources alone
        cards += [f"vp pol 0 pulse(0 1 0 0 0 {half!r} {2 * half!r})", "b2 npol 0 v=1-v(pol)",
                  "b3 hi 0 v=v(pol)+v(g)-2*min(v(pol),v(g))", "b4 lo 0 v=1-v(hi)"]
    return "\n".join(["totem pole", *cards, f".model sw sw(vt=0.5 ron={ron!r})", f".model d d(ron={of_diode!r})",
                      f".tran {0.1 / clock!r} {0.9 / line!r} uic", ".end", ""])


def main():
    checker = Checker("gates_by_conditions")
    for case in some_of(CASES, 1):
        ours, other = (run(sys.argv[1], netlist(case, way), method=None, options=["--audit", "full", "--fill", "none"])
                       for way in (True, False))
        if not checker.check(ours.status == other.status == 0, f"{case}: {ours.stderr[:300]} {other.stderr[:300]}"):
            continue
        n_euler = ours.report["work"]["euler_steps"]
        checker.check(n_euler == 0, f"{case}: {n_euler} steps of implicit Euler")
        for signal in ("v(p)", "i(l1)"):
            wanted = other.column(signal)
            checker.close(ours.column(signal)[-1], wanted[-1], 1e-8 * max(map(abs, wanted)), f"{case}: {signal}")
    return checker.finish()


sys.exit(main())
