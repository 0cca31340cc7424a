#!/usr/bin/env python3
"""The bridge on the LC tank is the linear RLC circuit, step by step.

usage: tank_recursion.py PROGRAM

With ideal diodes the bridge and its resistor look like the bare resistor to the tank, so the states
must follow implicit Euler of  C v' = -i - v/R,  L i' = v  to rounding, through every commutation.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import NETLISTS, Checker, run  # noqa: E402

C, L, R, STOP = 1e-6, 10e-3, 1e3, 5e-3
TOLERANCE = 1e-11  # of 10 V and 0.1 A


def recursion(step, count):
    v, i = 10.0, 0.0
    for _ in range(count):
        v = (C / step * v - i) / (C / step + 1 / R + step / L)
        i += step / L * v
        yield v, i


def main():
    checker = Checker("tank_recursion")
    for count in (5000, 12345, 50000):
        step = STOP / count
        result = run(sys.argv[1], NETLISTS / "tanks" / "lc_bridge.cir", step=step,
                     at=[STOP * (k + 1) / count for k in range(count)])
        if not checker.check(result.status == 0 and len(result.rows) == count,
                             f"exit {result.status}, {len(result.rows)} rows: {result.stderr}"):
            continue
        signals = zip(result.column("v(1)"), result.column("i(l1)"), result.column("v(2,3)"))
        worst = [0.0, 0.0, 0.0]
        for (v, i), (tank, current, load) in zip(recursion(step, count), signals):
            worst = [max(worst[0], abs(tank - v) / 10), max(worst[1], abs(current - i) / 0.1),
                     max(worst[2], abs(load - abs(v)) / 10)]
        for name, error in zip(("v(1)", "i(l1)", "v(2,3)"), worst):
            checker.check(error <= TOLERANCE, f"{name} differs by {error:.2e} at step {step:g}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
