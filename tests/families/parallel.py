#!/usr/bin/env python3
"""Diodes in parallel, with a capacitor across them, in a circuit of any size, against a closed form.

usage: parallel.py PROGRAM small|large

A sine drives them through a resistor. While they conduct the capacitor is shorted, the source's current
is theirs alone, and ends where the sine is 0. Then C v' = (v_s - v)/R - v/R_2 until v is 0 again. Between
them nothing tells how they share: equally, as the least norm has it. Large: with a line of 100 sections
that listens, so that steps are solved on sparse factors; what a step leaves open is then found by
elimination, and no C/h, however short the step, makes a current of an error in it.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, some_of  # noqa: E402
from faint import EVENT, TOLERANCES, check_signal, start  # noqa: E402

R, R2, OMEGA, STOP = 50.0, 200.0, 2e3 * math.pi, 4e-3
CAPACITANCES = 1e-6, 10e-6, 100e-9


def blocked(capacitance):
    """v of the time since the sine went through 0 downwards."""
    g, c = 1 / R + 1 / R2, capacitance
    a = 10 / R / (g * g + (OMEGA * c) ** 2)  # C v' + g v = -10/R sin(w t)
    return lambda t: a * (OMEGA * c * (math.cos(OMEGA * t) - math.exp(-g * t / c)) - g * math.sin(OMEGA * t))


def time_of_return(v):
    low, high = math.pi / OMEGA / 2, 2 * math.pi / OMEGA
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if v(middle) < 0 else (low, middle)
    return low


def main():
    program, size = sys.argv[1:]
    checker = Checker(f"parallel {size}")
    line = "".join(f"rm{k} m{k} m{k + 1} 1k\ncm{k} m{k + 1} 0 1n\n" for k in range(100))
    more = "em m0 0 b 0 1\n" + line if size == "large" else ""
    half, period = math.pi / OMEGA, 2 * math.pi / OMEGA
    for capacitance in some_of(CAPACITANCES):
        v = blocked(capacitance)
        back = time_of_return(v)

        def exact(t):
            """v and the current of all."""
            since = (t - half) % period
            if t < half or since > back:
                return 0.0, 10 * math.sin(OMEGA * t) / R
            return v(since), 0.0

        ends = [half + k * period + since for k in range(4) for since in (0, back)]
        at = [t for t in (STOP * (k + 0.37) / 500 for k in range(500)) if min(abs(t - e) for e in ends) > 1e-9]
        for n in 1, 2, 3:
            diodes = "".join(f"d{k} b 0 di\n" for k in range(1, n + 1))
            netlist = (f"parallel diodes\nv1 s 0 sin(0 10 1k)\nr1 s b {R}\nr2 b 0 {R2}\nc1 b 0 {capacitance} ic=0\n"
                       f"{diodes}{more}.model di d\n.tran 1u {STOP} uic\n.end\n")
            for tolerance in some_of(TOLERANCES):
                case = f"{n} diodes and {capacitance} F, {tolerance}"
                result = start(program, checker, case, netlist, at, tolerance)
                if result is None:
                    continue
                times = sorted({e["time"] for e in result.report["events"]})
                if checker.check(len(times) == len(ends) - 1, f"{case}: events at {times}"):
                    off = max(abs(a - b) for a, b in zip(times, ends))
                    checker.check(off <= max(EVENT, tolerance) * STOP, f"{case}: an event is {off:.1e} s off")
                wanted = [exact(t) for t in at]
                check_signal(checker, case, result, "v(b)", [w[0] for w in wanted], tolerance)
                for k in range(1, n + 1):
                    check_signal(checker, case, result, f"i(d{k})", [w[1] / n for w in wanted], tolerance)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
