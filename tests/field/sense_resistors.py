#!/usr/bin/env python3
"""Currents that formulas read in resistors of nanoohms and less, as people write an ammeter.

usage: sense_resistors.py PROGRAM

Two voltages of 300 V that differ by 1e-15 V say nothing of a current. It is an unknown of its own, and what formulas read
of it is right to the last digits. So the audit has to find the waveform right to 1e-11, and it is that of a closed form.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SAME = 1e-9
HELD = 1e-11  # where the current was a difference of voltages, the audit found 4e-10 to 0.5
OHMS = ["1n", "1p", "1f"]

W = 2 * math.pi * 50
LAG = math.atan(W * 10e-3 / 5)
PEAK = 100 / math.hypot(5, W * 10e-3)


def coil(t):
    """A sine of 100 V, switched on at its zero, into 10 mH and 5 ohm."""
    return PEAK * (math.sin(W * t - LAG) + math.sin(LAG) * math.exp(-500 * t))


# what is about it, the cards with OHMS in the place of the resistance, the signals with their values at the end
CIRCUITS = {
    "a mirror": (["v1 a 0 sin(2 1 1k)", "r1 a m OHMS", "r2 m 0 100k", "b1 0 o i=i(r1)*36", "r3 o 0 1k", ".tran 10u 1.25m"],
                 {"v(o)": 36e3 * 3 / 100e3}),
    "a comparator": (["v1 a 0 sin(0 100 50)", "r1 a m OHMS", "l1 m n 10m ic=0", "r2 n 0 5", "b1 q 0 v=i(r1)>3 ? 1 : 0",
                      "b2 p 0 v=2*i(r1)", "r3 q 0 1k", "r4 p 0 1k", ".tran 0.1m 27m uic"],
                     {"v(q)": float(coil(27e-3) > 3), "v(p)": 2 * coil(27e-3)}),
    "a square": (["v1 a 0 sin(0 325 50)", "r1 a m OHMS", "d1 m p", "r2 p 0 100", "b1 0 o i=i(r1)*i(r1)", "r3 o 0 1",
                  ".tran 0.1m 25m"], {"v(o)": 3.25 ** 2}),
    "a charge": (["v1 a 0 pulse(0 10 0 0 0 1)", "r1 a m OHMS", "r2 m o 1k", "c1 o 0 1u ic=0", "b1 z 0 v=idt(i(r1))",
                  "r3 z 0 1k", ".tran 10u 1m uic"], {"v(z)": 10e-6 * (1 - math.exp(-1))}),
    "a ramp that ends": (["v1 a 0 pwl(0 0 1m 400)", "r1 a m OHMS", "r2 m 0 10", "b1 0 o i=limit(i(r1),0,25)", "r3 o 0 2",
                          ".tran 10u 1m"], {"v(o)": 50.0}),
    "a switch": (["v1 a 0 sin(0 10 100)", "r1 a m OHMS", "r2 m 0 10", "s1 a o sm control={i(r1)}", "r3 o 0 100",
                  ".model sm switch(on=0.5 off=0.1)", ".tran 0.1m 22.5m"], {"v(o)": 10.0}),
    "edges of 1 ns": (["v1 a 0 pulse(0 400 1u 1n 1n 4u 10u)", "r1 a m OHMS", "r2 m 0 10", "c2 m 0 100p", "b1 0 o i=i(r1)",
                       "r3 o 0 1", ".tran 0.1u 24u"], {"v(o)": 40.0}),
    "three lines": (["va a 0 sin(0 325 50)", "vb b 0 sin(0 325 50 0 0 -120)", "vc c 0 sin(0 325 50 0 0 120)",
                     "ra a d OHMS", "rb b e OHMS", "rc c f OHMS", "rd d n 10", "re e n 10", "rf f n 10",
                     f"b1 o 0 v=2/3*(i(ra)*cos({W}*time)+i(rb)*cos({W}*time-{2 * math.pi / 3})"
                     f"+i(rc)*cos({W}*time+{2 * math.pi / 3}))",
                     f"b2 q 0 v=2/3*(i(ra)*sin({W}*time)+i(rb)*sin({W}*time-{2 * math.pi / 3})"
                     f"+i(rc)*sin({W}*time+{2 * math.pi / 3}))", "r1 o 0 1k", "r2 q 0 1k", ".tran 0.1m 33m"],
                    {"v(o)": 0.0, "v(q)": 32.5}),
}


def check(checker, name, ohms):
    cards, ends = CIRCUITS[name]
    text = "\n".join([name, *(card.replace("OHMS", ohms) for card in cards), ".end", ""])
    outcome = run(sys.argv[1], text, method=None)
    what = f"{name}, {ohms}ohm"
    if not checker.check(outcome.status == 0, f"{what}: {outcome.stderr[:300]}"):
        return
    worst = outcome.report["audit"]["worst"]
    checker.check(worst <= HELD, f"{what}: the audit finds a defect of {worst:.2g}, more than {HELD}")
    for signal, value in ends.items():
        checker.close(outcome.column(signal)[-1], value, SAME * max(abs(value), 1.0), f"{what}: {signal}")


def main():
    checker = Checker("sense_resistors")
    for name, ohms in some_of([(name, ohms) for name in CIRCUITS for ohms in OHMS]):
        check(checker, name, ohms)
    return checker.finish()


sys.exit(main())
