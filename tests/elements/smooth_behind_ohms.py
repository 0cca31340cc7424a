#!/usr/bin/env python3
"""Smooth capacitors and coils beside ordinary ones, with a small resistance between, that begin at rest with them.

usage: smooth_behind_ohms.py PROGRAM

A value of 3 V that Newton's method knows to 2e-13 is a current of a nanoampere in a milliohm, and no shorter step mends
that: such runs took millions of steps. What is stored and what has flowed away are in balance, whatever the steps.
"""

import itertools
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

# law of x over its unit, and the same in Python
LAWS = (("x+0.2*x*x*x", lambda x: x + 0.2 * x ** 3), ("2*tanh(0.5*x)+0.05*x", lambda x: 2 * math.tanh(0.5 * x) + 0.05 * x),
        ("1.4*(sqrt(1+x/0.7)-1)", lambda x: 1.4 * (math.sqrt(1 + x / 0.7) - 1)), ("0.1*sinh(x)+x", lambda x: 0.1 * math.sinh(x) + x))
SIZES = ((100e-9, 1e-9, 20e-3, 10.0), (100e-9, 10e-9, 20e-3, 10.0), (100e-9, 1e-9, 1e-3, 1e3), (1e-6, 1e-6, 1e-4, 1.0),
         (1e-12, 1e-13, 1e-2, 1e4), (1e-3, 1e-4, 1e-5, 1e2))
START = 3.0


def capacitor(law, size):
    unit, beside, small, load = size
    return (f"smooth capacitor\nR1 b 0 {load!r}\nC0 b 0 {beside!r} IC={START}\nR2 b i {small!r}\n"
            f"C1 i 0 Q={unit!r}*({law}) IC={START}\n.save v(b) v(i)\n.tran {unit * load / 50!r} {unit * load!r} uic\n"
            f".meas tran gone integ v(b)/{load!r}\n.meas tran own find v(b) at={unit * load!r}\n"
            f".meas tran bent find v(i) at={unit * load!r}\n.end\n")


def coil(law, size):
    """The dual: a coil and a resistor in series, and a large resistor across both."""
    unit, beside, small, load = size
    return (f"smooth coil\nL0 0 a {beside!r} IC={START}\nR1 a b {1 / load!r}\nR2 b 0 {1 / small!r}\n"
            f"L1 b 0 Flux={unit!r}*({law}) IC={START}\n.save i(l0) i(l1)\n.tran {unit * load / 50!r} {unit * load!r} uic\n"
            f".meas tran gone integ i(l0)/{load!r}\n.meas tran own find i(l0) at={unit * load!r}\n"
            f".meas tran bent find i(l1) at={unit * load!r}\n.end\n")


def main():
    ohms = Checker("smooth_behind_ohms")
    for (law, function), size, netlist in some_of(list(itertools.product(LAWS, SIZES, (capacitor, coil)))):
        unit, beside = size[:2]
        done = run(sys.argv[1], netlist(law, size), method=None)
        name = f"{netlist.__name__} {law} of {unit} beside {beside}, {size[2]} and {size[3]} ohm"
        if not ohms.check(done.status == 0, f"{name}: {done.stderr}"):
            continue
        gone, own, bent = (m["value"] for m in done.report["measurements"])
        at_first = unit * function(START) + beside * START
        off = at_first - gone - unit * function(bent) - beside * own
        ohms.check(abs(off) < 1e-8 * at_first, f"{name}: {off} of {at_first} are lost")
        ohms.check(done.report["work"]["steps"] < 1000, f"{name}: {done.report['work']['steps']} steps")
    return ohms.finish()


if __name__ == "__main__":
    sys.exit(main())
