#!/usr/bin/env python3
"""Bridges of switches that their own voltage commands, without hysteresis, beside diodes that need more of it.

usage: bridges_that_slide.py PROGRAM

A switch closes above the threshold U, where it would take the voltage below: so it stays at U, and the bridge is a source
V - 2 U behind R1. The two that block leak through Roff. Behind it are a coil L, and C beside R:

    v(p) = (V - 2 U - R1 (i + 2 U / Roff)) / (1 + 2 R1 / Roff),  L i' = v(p) - v(o),  C v(o)' = i - v(o) / R,

which a series of powers of time solves. In each segment of such a slide step sizes are those of the one before: they are
factored once.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

BRIDGES = [  # V, R1, U, Ron, Roff, L, C, R, V at the start, s
    (400.0, 0.26, 0.2, 0.01, 1e6, 0.77e-3, 3.4e-6, 106.0, 200.0, 10e-6),
    (24.0, 1.0, 0.05, 1e-3, 1e5, 10e-6, 1e-6, 5.0, 12.0, 5e-6),
    (1000.0, 0.3, 0.3, 1e-3, 1e7, 1e-3, 1e-4, 20.0, 0.0, 50e-6),
    (5.0, 10.0, 0.01, 0.01, 1e6, 1e-3, 1e-7, 1e3, 1.0, 20e-6),
    (60.0, 0.5, 0.4, 0.02, 1e6, 0.1, 1e-3, 10.0, 30.0, 10e-3),
    (325.0, 2.0, 0.1, 5e-3, 1e6, 5e-3, 1e-4, 200.0, 300.0, 1e-3),
]


def netlist_of(name, volts, ohm, threshold, ron, roff, henry, farad, load, first, stop):
    lines = [name, f"v1 in x {volts!r}", f"r1 in a {ohm!r}"]
    for k, ends in enumerate(("a p", "x p", "0 a", "0 x")):
        lines += [f"s{k} {ends} {ends} sw", f"d{k} {ends} di"]
    return "\n".join([*lines, f"l1 p o {henry!r}", f"c1 o 0 {farad!r} ic={first!r}", f"r2 o 0 {load!r}",
                      f".model sw sw(vt={threshold!r} vh=0 ron={ron!r} roff={roff!r})",
                      f".model di d(vfwd={5 * threshold!r} ron={ron!r})", ".save v(p) v(o) i(l1)",
                      f".tran {stop / 20!r} {stop!r} uic", ".end", ""])


def solution(values, t):
    """v(p), v(o), i(l1)."""
    volts, ohm, threshold, _, roff, henry, farad, load, first, _ = values
    leak = 1.0 + 2.0 * ohm / roff
    source = (volts - 2.0 * threshold - 2.0 * threshold * ohm / roff) / leak
    i, v = 0.0, first
    parts = 64
    for _ in range(parts):  # Taylor's series of an affine system, in parts of the time
        h = t / parts
        di, dv = i, v
        rate = [(source - ohm / leak * i - v) / henry, (i - v / load) / farad]
        for k in range(1, 30):
            di, dv = rate[0] * h / k, rate[1] * h / k
            i, v = i + di, v + dv
            rate = [(-ohm / leak * di - dv) / henry, (di - dv / load) / farad]
    return source - ohm / leak * i, v, i


def check_bridge(checker, program, values, options):
    name = f"bridge of {values} {options}"
    result = dalcs_program.run(program, netlist_of(name, *values), method=None,
                               options=["--audit", "full", *options])
    if not checker.check(result.status == 0, f"{name}: {result.stderr}"):
        return
    work = result.report["work"]
    checker.check(work["euler_steps"] == 0, f"{name}: {work['euler_steps']} steps of implicit Euler")
    checker.check(3 * work["factorizations"] <= work["osnsp"] + 30000,
                  f"{name}: {work['factorizations']} factorisations for {work['osnsp']} problems")
    columns = [result.column(signal) for signal in ("v(p)", "v(o)", "i(l1)")]
    for k, t in list(enumerate(result.time))[1:]:
        for signal, column, wanted in zip(("v(p)", "v(o)", "i(l1)"), columns, solution(values, t)):
            scale = max(map(abs, column))
            if not checker.check(abs(column[k] - wanted) <= 1e-9 * scale,
                                 f"{name}: {signal} = {column[k]!r}, not {wanted!r}, at {t!r}"):
                return


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    checker = dalcs_program.Checker("bridges that slide")
    ways = [], ["--tol", "1e-10"], ["--method", "lobatto"]
    for values, options in dalcs_program.kinds_of((values, options) for values in BRIDGES for options in ways):
        check_bridge(checker, program, values, options)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
