#!/usr/bin/env python3
"""Switches with hysteresis that read the circuit, where a source jumps: as on a flank that is steep.

usage: leaps.py PROGRAM

A jump of a source is the limit of flanks: where a switch opens on the flank before anything flows through it, it is open
behind the jump, and no state has jumped; where it closes, what its closing does is a jump behind it. Each circuit is run
with flanks of no time and with flanks of 1e-9 of the period, and with a full audit."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

PERIOD = 1.0


def pulse(low, high, edge):
    return f"pulse({low} {high} {0.1 * PERIOD!r} {edge!r} {edge!r} {0.5 * PERIOD - edge!r} {PERIOD!r})"


# %s: the pulse; signals to compare
CIRCUITS = {
    "opens before a capacitor is charged": (
        "v1 a x %s\nr2 x 0 1\ns1 a 0 a 0 m\nez z 0 x 0 1\nd1 z c\nc1 c 0 1\n.model m sw(ron=2 vt=1m vh=0.5m)",
        -30, 30, ("v(c)", "v(x)")),
    "of millivolts": (
        "v1 a x %s\nr2 x 0 1k\ns1 a 0 a 0 m\nez z 0 x 0 2\nd1 z c\nc1 c 0 1u\nr3 c 0 10meg\n"
        ".model m sw(ron=2k vt=1u vh=0.5u)", -5e-3, 5e-3, ("v(c)", "v(x)")),
    "of kilovolts": (
        "v1 a x %s\nr2 x 0 10\ns1 a 0 a 0 m\nez z 0 x 0 1\nd1 z c\nc1 c 0 1m\nr3 c 0 1k\n"
        ".model m sw(ron=20 vt=1 vh=0.5)", -3e3, 3e3, ("v(c)", "v(x)")),
    "closes and shares a charge": (
        "v1 a 0 %s\nr1 a b 1k\nr2 b 0 1k\ns1 c d b 0 m\nc1 c 0 1u\nc2 d 0 2u\nr3 c a 100k\nr4 d 0 100k\n"
        ".model m sw(vt=2 vh=1)", 0, 10, ("v(c)", "v(d)")),
    "opens and leaves a charge": (
        "v1 a 0 %s\nr1 a b 1k\nr2 b 0 1k\ns1 c d b 0 m\nc1 c 0 1u\nc2 d 0 2u\nr3 c a 100k\nr4 d 0 100k\n"
        ".model m sw(vt=2 vh=1)", 10, 0, ("v(c)", "v(d)")),
    "a chain of two": (
        "v1 a 0 %s\nr1 a b 1k\nr2 b 0 1k\ns1 a e b 0 m\nr5 e 0 1k\ns2 c 0 e 0 m\nr3 c f 1k\nvf f 0 3\nc1 c 0 10u\n"
        ".model m sw(ron=1 vt=2 vh=1)", 0, 10, ("v(c)", "v(e)")),
    "two rails": (
        "v1 a 0 %s\nr1 a b 1k\nr2 b 0 3k\ns1 p q b 0 m\ns2 n q 0 b m\nvp p 0 5\nvn n 0 -5\nr3 q c 1k\nc1 c 0 10u\n"
        ".model m sw(ron=1 roff=1meg vt=0.5 vh=0.2)", -8, 8,
        ("v(c)", "v(q)")),
    "a coil beside it": (
        "v1 a x %s\nr2 x 0 1\ns1 a 0 a 0 m\nez z 0 x 0 1\nl1 z y 10m\nr3 y 0 1\nd1 z c\nc1 c 0 1m\nr4 c 0 1k\n"
        ".model m sw(ron=2 vt=1m vh=0.5m)", -30, 30, ("v(c)", "i(l1)")),
    "by a current": (
        "v1 a x %s\nr2 x 0 1\nw1 a 0 vs m\nrs a s 1k\nvs s 0 0\nez z 0 x 0 1\nd1 z c\nc1 c 0 1m\nr4 c 0 1k\n"
        ".model m csw(ron=2 it=1n ih=0.5n)", -30, 30, ("v(c)", "v(x)")),
    "two capacitors and a bridge": (
        "v1 a x %s\nr2 x 0 1\ns1 a 0 a 0 m\nez z w x 0 1\nrw w 0 1meg\nd1 z p\nd2 n z\nd3 w p\nd4 n w\nc1 p n 1m\nr4 p n 1k\n"
        ".model m sw(ron=2 vt=1m vh=0.5m)", -20, 20, ("v(p,n)", "v(x)")),
}
ARGUMENTS = [("1e-6", None), ("1e-9", None), ("1e-6", 5), ("1e-4", 3)]


def main():
    program = sys.argv[1]
    checker = Checker("leaps")
    times = [0.01 + 0.02 * k for k in range(100)]
    for name, tolerance, stages in some_of([(n, *a) for n in CIRCUITS for a in ARGUMENTS]):
        cards, low, high, signals = CIRCUITS[name]
        case = f"{name}, tolerance {tolerance}, {stages} stages"
        results = []
        for edge in (0.0, 1e-9 * PERIOD):
            text = f"{name}\n{cards % pulse(low, high, edge)}\n.save {' '.join(signals)}\n.tran 10m 2 uic\n.end\n"
            results.append(run(program, text, at=times, method="radau" if stages else None, tolerance=tolerance,
                               stages=stages, options=["--audit", "full"]))
        if not checker.check(all(r.status == 0 for r in results), f"{case}: {[r.stderr for r in results]}"):
            continue
        for signal in signals:
            pair = [r.column(signal) for r in results]
            scale = max(map(abs, pair[1])) or 1.0
            # The flank moves what is charged on it by its part of the period, and each run keeps its tolerance.
            worst = max(abs(x - y) for x, y in zip(*pair)) / scale
            checker.check(worst <= 2 * float(tolerance) + 1e-6, f"{case}: {signal} differs by {worst:.1e}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
