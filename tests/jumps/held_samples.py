#!/usr/bin/env python3
"""Capacitors hold samples of what a source makes of the output, while a coil in the converter carries nothing but rounding.

usage: held_samples.py PROGRAM

Euler's micro-steps look at all states when a sample is taken. What rounding leaves of a coil's current may be twice as far
in a step half as long: that is no derivative of an impulse, and no reason to refuse the circuit. Averages are those of the
exact method within the error of Euler's first order.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

SAMPLES = 3


def coil(kind, inductance, capacitance):
    return {
        "buck": ["s1 in sw g 0 sh", "d1 0 sw", f"l1 sw out {inductance}"],
        "boost": [f"l1 in sw {inductance}", "s1 sw 0 g 0 sh", "d1 sw out"],
        "inverting": ["s1 in sw g 0 sh", f"l1 sw 0 {inductance}", "d1 out sw"],
        "sepic": [f"l1 in sw {inductance}", "s1 sw 0 g 0 sh", f"cs sw m {capacitance / 10}", f"l2 m 0 {inductance}",
                  "d1 m out"],
    }[kind]


def circuit(kind, volts, amperes, period):
    ohms = volts / amperes
    farads = 1e-4 * period / 1e-5 / ohms
    lines = [kind, f"v1 in 0 {12 * volts}", f"vg g 0 pulse(0 1 0 0 0 {0.1 * period} {period})", ".model sh sw(vt=0.5)",
             f"be e 0 v={12 * volts}-v(out)+0.1*v(h0)"]
    lines += coil(kind, 2.2e-5 * ohms * period / 1e-5, farads)
    lines += [f"c1 out 0 {farads}", f"r1 out 0 {40 * ohms}"]
    for k in range(SAMPLES):
        at = period * (0.3 + 0.6 * k / SAMPLES)
        lines += [f"sh{k} e h{k} k{k} 0 sh", f"ch{k} h{k} 0 {1e-9 / ohms}",
                  f"vk{k} k{k} 0 pulse(0 1 {at} 0 0 {1e-7 * period} {period})"]
    return "\n".join(lines + [f".tran {period / 50} {30 * period} uic", ".end", ""])


def average(outcome, name):
    """Over the last third, by trapezoids."""
    time, value = outcome.time, outcome.column(name)
    first = next(k for k, t in enumerate(time) if t >= time[-1] * 2.0 / 3.0)
    area = sum((time[k + 1] - time[k]) * (value[k + 1] + value[k]) / 2.0 for k in range(first, len(time) - 1))
    return area / (time[-1] - time[first])


def main():
    program = sys.argv[1]
    checker = Checker("held_samples")
    for kind in ("buck", "boost", "inverting", "sepic"):
        for scales in ((1.0, 1.0, 1e-5), (1e-3, 1e3, 1e-2), (1e3, 1e-3, 1e-5), (100.0, 10.0, 1e-3)):
            text = circuit(kind, *scales)
            exact = run(program, text, method=None)
            euler = run(program, text)
            for outcome in (exact, euler):
                checker.check(outcome.status == 0, f"{kind} {scales}: {outcome.stderr[:200]}")
            if exact.status == 0 and euler.status == 0:
                for name in ("v(out)", "v(h1)"):
                    wanted = average(exact, name)
                    checker.close(average(euler, name), wanted, 0.05 * abs(wanted), f"{kind} {scales}: {name}")
    sampled = run(program, HERE.parent / "field" / "sampled_pi_buck.cir")
    checker.check(sampled.status == 0, f"a sampled controller: {sampled.stderr[:200]}")
    return checker.finish()


sys.exit(main())
