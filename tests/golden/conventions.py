#!/usr/bin/env python3
"""What SPICE does at a start, and what a number or a model means: values by closed form, or by ngspice 39.

usage: conventions.py PROGRAM"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

RC = "R1 a b 1k\nC1 b 0 1u\n.tran 10u 1m"
DEAD = 1 - math.exp(-1)

# title: netlist, {signal: (first value, last value, relative tolerance)}; None: not asked
CASES = {
    "a step at t = 0": (f"V1 a 0 PULSE(0 1)\n{RC}", {"v(b)": (0, DEAD, 1e-6)}),
    "two points of a PWL at t = 0": (f"V1 a 0 PWL(0 0 0 1)\n{RC}", {"v(b)": (0, DEAD, 1e-6)}),
    "an EXP without a time constant": (f"V1 a 0 EXP(0 1 0 0)\n{RC}", {"v(b)": (0, DEAD, 1e-6)}),
    "a step down": (f"V1 a 0 PULSE(1 0)\n{RC}", {"v(b)": (1, 1 - DEAD, 1e-6)}),
    "a step into a coil": ("V1 a 0 PULSE(0 10 0 0 0 10m 20m)\nR1 a b 10\nL1 b 0 10m\n.tran 10u 1m",
                           {"i(l1)": (0, DEAD, 1e-6)}),
    "a switch that closes at t = 0 across a capacitor": (
        "V1 a 0 3\nR1 a b 1k\nC1 b 0 1u\nS1 b 0 g 0 sw\nV2 g 0 PULSE(0 1)\n.model sw SW(Vt=0.5)\n.tran 10u 1m",
        {"v(b)": (3, 0, 1e-9)}),
    "a hysteresis that goes on from before t = 0": (
        "V1 a 0 1\nS1 a b g 0 sw\nR1 b 0 1\nV2 g 0 PULSE(5 3)\n.model sw SW(Vt=3 Vh=1)\n.tran 10u 1m",
        {"v(b)": (1, 1, 1e-12)}),
    "with uic there is nothing before": (
        "V1 a 0 PULSE(0 1)\nR1 a b 1k\nC1 b 0 1u ic=1\n.tran 10u 1m uic", {"v(b)": (1, 1, 1e-9)}),
    "a capacitor behind a threshold": (
        "V1 a 0 SIN(0 10 50)\nD1 a o dr\nC1 o 0 10u\n.model dr D(Vfwd=0.7 Ron=0.1)\n.tran 100u 20m",
        {"v(o)": (0, 9.3, 1e-3)}),
    "a capacitor behind a threshold and 10 V": (
        "V1 a 0 10\nD1 a o dr\nC1 o 0 10u\n.model dr D(Vfwd=0.7 Vrev=100)\n.tran 100u 1m",
        {"v(o)": (10, 10, 1e-6)}),
    "a capacitor that a breakdown charges": (
        "V1 a 0 SIN(0 50 50)\nD1 o a dr\nC1 o 0 1u\n.model dr D(Vrev=20)\n.tran 100u 20m",
        {"v(o)": (0, -20, 1e-6)}),
    "a clamper with a breakdown": (
        "V1 a 0 SIN(0 5 50)\nC1 a o 1n\nD1 0 o dr\n.model dr D(Vfwd=0.5 Vrev=100)\n.tran 100u 20m",
        {"v(o)": (0, 4.5, 1e-6)}),
    "a coil across a held node": (
        "V1 b 0 5\nR1 b t 100\nL1 t 0 0.5\nC1 t 0 10u\n.ic v(t)=0\n.tran 100u 1m",
        {"i(l1)": (0, None, 0), "v(t)": (0, None, 0)}),
    "two coils, one with a held node at its end": (
        "V1 b 0 5\nR1 b s 100\nL1 s t 1m\nL2 t 0 1m\nC1 t 0 1u\n.ic v(t)=0\n.tran 1u 1u",
        {"i(l1)": (0.05, None, 1e-9), "i(l2)": (0, None, 0)}),
    "amperes": ("I1 0 a 2A\nR1 a 0 10\nI2 0 b 3Amp\nR2 b 0 1\n.tran 1u 1u",
                {"v(a)": (20, 20, 1e-12), "v(b)": (3, 3, 1e-12)}),
    "a gate of 0 and 1 at 0 V": (
        "V1 a 0 1\nV2 r 0 PULSE(1 0 0.5m)\nB1 g 0 V=v(r) > 0.5 ? 1 : 0\nS1 a b g 0 sw\nR1 b 0 1\n"
        ".model sw SW\n.tran 10u 1m", {"v(b)": (1, 0, 1e-12)}),
    "the same by way of an E source, turned around": (
        "V1 a 0 1\nV2 r 0 PULSE(1 0 0.5m)\nB1 0 g V=v(r) > 0.5 ? 1 : 0\nE1 h 0 0 g 5\nS1 a b h 0 sw\nR1 b 0 1\n"
        ".model sw SW\n.tran 10u 1m", {"v(b)": (1, 0, 1e-12)}),
}

# words of a message, in notes and warnings
MESSAGES = {
    "V1 t 0 PULSE(0 1 0 50u 50u 0 100u)\nR1 t 0 1k\n.tran 1u 1m": "mean of this pulse is 0.5",
    "V1 t 0 PULSE(0 1 0 50u 50u 0 100u)\nR1 t 0 1k\n.tran 1u 2m": "which makes 0.75",
    "V1 a 0 1\nD1 a b dd\nR1 b 0 1\n.model dd D()\n.tran 1u 1m": "would drop 0.8338 V at 1 A",
    "V1 a 0 SIN(0 5 2g)\nR1 a 0 1k\n.tran 4n 4u": "rows are 4e-09 s apart there",
}


def check_case(checker, program, title, netlist, wanted, method):
    signals = " ".join(wanted)
    done = run(program, f"{title}\n.save {signals}\n{netlist}\n.end\n", method=method)
    what = f"{title}, {method or 'default'}: "
    if not checker.check(done.status == 0, what + done.stderr):
        return
    for signal, (first, last, tolerance) in wanted.items():
        column = done.column(signal)
        size = max(abs(first), abs(last or 0), 1e-3)
        tolerance = max(tolerance, 1e-9) if method is None else 0.02  # euler: steps of a hundredth
        checker.close(column[0], first, tolerance * size, what + f"first {signal}")
        if last is not None:
            checker.close(column[-1], last, tolerance * size, what + f"last {signal}")


def main():
    program = sys.argv[1]
    checker = Checker("conventions")
    for title, (netlist, wanted) in CASES.items():
        for method in (None, "euler"):
            check_case(checker, program, title, netlist, wanted, method)
    for netlist, words in MESSAGES.items():
        done = run(program, f"a message\n{netlist}\n.end\n", method=None, quiet=False)
        checker.check(words in done.stderr, f"nothing says '{words}': {done.stderr}")
    twins = "".join(f"S{k} a x{k} g 0 sw\nD{k} x{k} a\nR{k} x{k} 0 1\n" for k in range(6))
    done = run(program, f"six MOSFETs\nV1 a 0 1\nV2 g 0 PULSE(0 1 1u 0 0 1u 4u)\n{twins}.model sw SW(Vt=0.5)\n"
               ".tran 1u 10u\n.end\n", method=None, quiet=False)
    checker.check("warning" not in done.stderr and done.stderr.count("not determined") <= 2, done.stderr)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
