#!/usr/bin/env python3
"""Diodes that carry a load at rest and that a source opens as soon as it moves.

usage: knees_at_rest.py PROGRAM

The audit asked of rest by the modes just after the start, where such a diode carries nothing: an alarm without a fault.
Values are closed forms.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

ALLOWED = 1e-9
W = 2e6 * math.pi  # rad/s


def falling(t):
    """A supply falls by 12 V/ms, a capacitor behind a diode of 0.4 V by itself, down to the other supply."""
    return max(11.6 * math.exp(-t / 1e-3), 9.6)


def clamped(t):
    """C v' + v/R = C s', from 5 V on, where the source s is 5 V sin(w t); before the diode closes again."""
    a = W * 1e-6
    course = 5 * a / (1 + a * a) * (a * math.sin(W * t) + math.cos(W * t))
    return course + (5 - 5 * a / (1 + a * a)) * math.exp(-t / 1e-6)


def rectified(t):
    """A sine at 120 degrees falls faster than the capacitor behind the bridge does."""
    return 325 * math.sin(2 * math.pi / 3) * math.exp(-t / 10e-3)


# cards, times in s, signal, its closed form
CASES = {
    "two supplies": (["v1 a 0 pulse(12 0 0 1m 1m 5m 20m)", "v2 b 0 10", "d1 a o m", "d2 b o m", "c1 o 0 10u", "r1 o 0 100",
                      ".model m d(ron=0 vfwd=0.4)"], [0.0, 5e-5, 1e-4, 1.5e-4, 3e-4], "v(o)", falling),
    "clamp": (["v1 in 0 5", "d1 in o", "r1 o 0 1k", "c1 o k 1n", "v2 k 0 sin(0 5 1meg)"],
              [0.0, 1e-8, 1e-7, 2e-7, 2.5e-7], "v(o)", clamped),
    "chain": (["v1 in 0 5", "d1 in x", "d2 x o", "r1 o 0 1k", "c1 o k 0.5n", "c2 x k 0.5n", "v2 k 0 sin(0 5 1meg)"],
              [0.0, 1e-8, 1e-7], "v(x)", clamped),
    "bridge": (["v1 a b sin(0 325 50 0 0 120)", "d1 a p", "d2 b p", "d3 n a", "d4 n b", "c1 p n 100u", "r1 p n 100",
                "r2 n 0 1meg"], [0.0, 1e-4, 1e-3, 2e-3], "v(p,n)", rectified),
    "avalanche": (["v1 in 0 sin(20 -15 1k)", "r1 in o 1k", "d1 0 o m", "c1 in o 1u", ".model m d(ron=0 vrev=5 rrev=0)"],
                  [0.0], "v(o)", lambda t: 5.0),
}


def main():
    checker = Checker("knees_at_rest")
    for name, (cards, times, signal, form) in CASES.items():
        text = "\n".join([name, *cards, f".save {signal}", f".tran {max(times[-1], 1e-5) / 10!r} {max(times[-1], 1e-5)!r}",
                          ".end", ""])
        for audit in ("sample", "full"):
            out = run(sys.argv[1], text, method=None, at=times, options=["--audit", audit])
            if checker.check(out.status == 0, f"{name}, {audit}: {out.stderr[:300]}"):
                off = max(abs(got - form(t)) / abs(form(t)) for got, t in zip(out.column(signal), times))
                checker.check(off <= ALLOWED, f"{name}: off by {off:.2g}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
