#!/usr/bin/env python3
"""A transient that is very much faster than the run is no jump, where sources that read the circuit make it.

usage: fast_transients.py PROGRAM

Time constants from a thousandth of the run to 1e-12 of it (of a product 1e-8), at the start and at an edge of a source. A jump in the report
would be one that no impulse makes: bounded currents charge these capacitors.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

STOP = 6000.0


def feedback(fast):
    """x' = (u - x) / fast, of a current source that reads its own capacitor."""
    return f"B1 0 x I=1m*(v(u)-v(x))\nC1 x 0 {1e-3 * fast!r} ic=0", {"x": (1.0, fast)}


def inverted(fast):
    """The same behind an inverting E, and a resistor to the output of another."""
    return (f"E1 y 0 u 0 -1\nE2 z 0 y 0 -3\nR1 z x 2\nB1 x 0 I=0.5*v(x)\nC1 x 0 {fast!r} ic=0",
            {"x": (1.5, fast)})


def by_currents(fast):
    """By an H and an F."""
    return (f"Vs u s 0\nRs s 0 1k\nF1 0 x Vs 2\nR1 x 0 500\nH1 h 0 Vs 1k\nRh h x 1meg\nC1 x 0 {fast / 500!r} ic=0",
            {"x": (1.0, fast)})


def chain(fast):
    """A slow state that is fed through two fast ones."""
    return (f"B1 0 p I=1m*(v(u)-v(p))\nC1 p 0 {1e-3 * fast!r} ic=0\nB2 0 q I=1m*(v(p)-v(q))\n"
            f"C2 q 0 {2e-3 * fast!r} ic=0\nB3 0 x I=1m*(v(q)-v(x))\nC3 x 0 {1e-3 * STOP / 5!r} ic=0",
            {"p": (1.0, fast), "x": (1.0, STOP / 5)})


def smooth(fast):
    """A cube instead of a line."""
    return f"B1 0 x I=1m*(v(u)**3-v(x)**3)\nC1 x 0 {1e-3 * fast!r} ic=0", {"x": (1.0, fast)}


def beside_a_diode(fast):
    """With a diode that never conducts."""
    return (f"B1 0 x I=1m*(v(u)-v(x))\nC1 x 0 {1e-3 * fast!r} ic=0\nD1 x d dd\nVd d 0 5\n.model dd d(ron=0)",
            {"x": (1.0, fast)})


def check(checker, program, circuit, fast, edge):
    cards, wanted = circuit(fast)
    source = f"Vu u 0 {'PULSE(0 1 1500 0 0 1e9)' if edge else '1'}"
    title = f"{circuit.__name__}, {fast / STOP:.0e} of the run, {'at an edge' if edge else 'at the start'}"
    at = [STOP * k / 16 for k in range(1, 17)]
    result = run(program, f"fast\n{source}\n{cards}\n.tran 100 {STOP!r} uic\n", method=None, at=at,
                 options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        return
    checker.check(not result.report["jumps"], f"{title}: {result.report['jumps'][:1]}")
    begin = 1500.0 if edge else 0.0
    for node, (final, constant) in wanted.items():
        for t, found in zip(at, result.column(f"v({node})")):
            if abs(t - begin) < 1.0:
                continue
            exact = final * (1 - math.exp(-max(t - begin, 0.0) / constant))
            slack = 20 * fast / STOP + 1e-8  # lags of what stands before a slow state
            checker.close(found, exact, slack * final, f"{title}: v({node}) at {t:g}")


def main():
    program = sys.argv[1]
    checker = Checker("fast_transients")
    cases = [(circuit, STOP * 10.0 ** -k, edge)
             for circuit in (feedback, inverted, by_currents, chain, smooth, beside_a_diode)
             for k in range(3, 9 if circuit is smooth else 13) for edge in (False, True)]
    for case in some_of(cases):
        check(checker, program, *case)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
