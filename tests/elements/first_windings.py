#!/usr/bin/env python3
"""Nodes that first windings of ideal transformers alone lead to ground: what their other windings are tied to decides.

star: of three loaded transformers the star point is the mean of the phases, each with its conductance (Millman).
delta: their second windings in a ring add up to 0, so that it is the mean of the phases.
chain: two in series divide a voltage as the resistors behind them do.
open: behind one that carries nothing, a node has the whole voltage, with a diode beside it or a coil.

usage: first_windings.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

HEIGHTS = (0.9, 1.0, 1.1)  # of the phases


def phases(v, f):
    cards = [f"v{k} {n} 0 sin(0 {h * v!r} {f} 0 0 {-120 * k})" for k, (n, h) in enumerate(zip("abc", HEIGHTS))]
    return cards, lambda t: [h * v * math.sin(2 * math.pi * (f * t - k / 3)) for k, h in enumerate(HEIGHTS)]


def star(v, f, r, ratio):
    cards, at = phases(v, f)
    ohms = [r, 2 * r, 5 * r]
    cards += [f"a{k} {n} s x{k} y{k} tr\nr{k} x{k} y{k} {ohm!r}\ng{k} y{k} 0 y{k} 0 {1e-3 / r!r}"
              for k, (n, ohm) in enumerate(zip("abc", ohms))]
    return cards, lambda t: sum(e / ohm for e, ohm in zip(at(t), ohms)) / sum(1 / ohm for ohm in ohms)


def delta(v, f, r, ratio):
    cards, at = phases(v, f)
    cards += [f"a{k} {n} s {p} {q} tr" for k, (n, p, q) in enumerate(zip("abc", "xyz", "yzx"))]
    cards += [f"r1 x y {r!r}", f"r2 y z {2 * r!r}", f"r3 x 0 {r!r}"]
    return cards, lambda t: sum(at(t)) / 3


def chain(v, f, r, ratio):
    cards = [f"v1 a 0 sin(0 {v!r} {f})", "a1 a s x 0 tr", f"r1 x 0 {r!r}", "a2 s 0 p q tr", f"r2 p q {3 * r!r}"]
    return cards, lambda t: 0.75 * v * math.sin(2 * math.pi * f * t)


def open_end(v, f, r, ratio, beside):
    cards = [f"v1 a 0 sin(0 {v!r} {f})", "a1 a s x 0 tr", *beside, "a2 s 0 p q tr", f"r2 q 0 {r!r}"]
    return cards, lambda t: v * math.sin(2 * math.pi * f * t)


def beside_a_diode(v, f, r, ratio):
    return open_end(v, f, r, ratio, ["d1 x y di", f"r1 y 0 {r!r}", ".model di d(ron=0)"])


def beside_a_coil(v, f, r, ratio):
    return open_end(v, f, r, ratio, [f"l1 x 0 {r / f!r}"])


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("first windings")
    circuits = [(kind, *values) for kind in (star, delta, chain, beside_a_diode, beside_a_coil)
                for values in ((10, 50, 10, 2), (2e4, 60, 1e3, 0.05), (0.1, 1e5, 50, 1))]
    for kind, v, f, r, ratio in some_of(circuits):
        cards, wanted = kind(v, f, r, ratio)
        times = [part / f for part in (0.13, 0.4, 0.61, 0.9, 1.7)]
        done = run(program, "\n".join([kind.__name__, *cards, f".model tr transformer(turns=[1 {ratio}])",
                                       f".tran {0.01 / f!r} {2 / f!r}",
                                       *(f".meas tran m{k} find v(s) at={t!r}" for k, t in enumerate(times)), ".end", ""]),
                   method=None)
        what = f"{kind.__name__} of {v} V, {ratio}"
        if checker.check(done.status == 0, f"{what}: {done.stderr}"):
            for m, t in zip(done.report["measurements"], times):
                checker.close(m["value"], wanted(t), 1e-8 * v, f"{what}: at {t} s")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
