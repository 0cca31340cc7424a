#!/usr/bin/env python3
"""uplim and dnlim, of numbers and of voltages, against their definition.

usage: soft_limits.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402


def up(x, y, z):
    return x if x < y - z else y - z * math.exp((y - z - x) / z)


def down(x, y, z):
    return -up(-x, -y, z)


def main():
    checker = Checker("soft_limits")
    for y, z, volts in ((2.0, 0.5, 5.0), (-1.0, 3.0, 4.0), (100.0, 10.0, 400.0), (1e-3, 1e-4, 5e-3), (0.3, 0.3, 2.0)):
        text = (f"limits\n.param top={{uplim({volts!r},{y!r},{z!r})}} low={{dnlim({-volts!r},{y!r},{z!r})}}\n"
                f"v1 a 0 sin({0.1 * volts!r} {volts!r} 1k)\nv2 t 0 {{top}}\nv3 l 0 {{low}}\nr2 t 0 1\nr3 l 0 1\n"
                f"b1 u 0 v=uplim(v(a),{y!r},{z!r})\nb2 d 0 v=dnlim(v(a),{y!r},{z!r})\nr1 u d 1k\n"
                ".save v(a) v(u) v(d) v(t) v(l)\n.tran 10u 1m\n.end\n")
        result = run(sys.argv[1], text, at=[k * 7.3e-6 for k in range(1, 130)], method=None)
        if not checker.check(result.status == 0, f"{y}, {z}: {result.status}: {result.stderr}"):
            continue
        checker.close(result.column("v(t)")[0], up(volts, y, z), 1e-12 * volts, "of numbers: uplim")
        checker.close(result.column("v(l)")[0], down(-volts, y, z), 1e-12 * volts, "of numbers: dnlim")
        for a, u, d in zip(result.column("v(a)"), result.column("v(u)"), result.column("v(d)")):
            checker.close(u, up(a, y, z), 1e-8 * volts, f"uplim({a}, {y}, {z})")
            checker.close(d, down(a, y, z), 1e-8 * volts, f"dnlim({a}, {y}, {z})")
    own = run(sys.argv[1], "own\n.func uplim(x,y,z) {x+y+z}\nv1 a 0 {uplim(1,2,3)}\nr1 a 0 1\n.save v(a)\n.tran 1 1\n.end\n",
              method=None)
    checker.close(own.column("v(a)")[0], 6.0, 1e-12, "a function of the netlist of this name")
    return checker.finish()



sys.exit(main())
