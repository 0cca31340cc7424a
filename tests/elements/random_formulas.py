#!/usr/bin/env python3
"""Random formulas of kinks, jumps, tables and limits, nested in each other, against what Python makes of them.

usage: random_formulas.py PROGRAM [SEED COUNT]

A B source reads two filtered sines of 1 mV to 1 kV. Numbers in the formula have any size from 1e-6 to 1e4, and some limits
are far away. In each row v(z) lies between the least and the largest value of the formula where its arguments are off by
the tolerance, because a formula may be steep or jump."""

import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

ARGUMENT_ERROR = 1e-8  # of the amplitude: ten times the tolerance
SPREAD = [0.0, *(sign * part for sign in (-1, 1) for part in (1e-4, 1e-2, 0.1, 0.25, 0.5, 1))]


def table(x, *points):
    at, value = points[::2], points[1::2]
    if x <= at[0]:
        return value[0]
    for k in range(1, len(at)):
        if x <= at[k]:
            return value[k - 1] + (value[k] - value[k - 1]) * (x - at[k - 1]) / (at[k] - at[k - 1])
    return value[-1]


FUNCTIONS = {"limit": lambda x, low, high: min(max(x, low), high), "uramp": lambda x: max(x, 0.0),
             "u": lambda x: 1.0 if x > 0 else 0.0, "sgn": lambda x: (x > 0) - (x < 0),
             "choose": lambda condition, a, b: a if condition else b, "table": table, "min": min, "max": max, "abs": abs}


def number(draw):
    return float(f"{draw.choice([draw.uniform(-2, 2), draw.choice([-1, 1]) * 10 ** draw.uniform(-6, 4)]):.6g}")


def numbers(draw, n):
    return sorted({number(draw) for _ in range(n)})


def formula(draw, depth):
    """Text that both dalcs and, with `choose` for `if`, Python read."""
    if depth == 0 or draw.random() < 0.15:
        return draw.choice([f"({number(draw)!r})", "v(n)", "v(m)"])
    a = formula(draw, depth - 1)
    kind = draw.choice(["sum", "factor", "extreme", "limit", "far limit", "abs", "uramp", "u", "sgn", "choose", "table"])
    if kind == "sum":
        return f"({a}{draw.choice('+-')}{formula(draw, depth - 1)})"
    if kind == "factor":
        return f"({number(draw) or 1.5!r}*{a})"
    if kind == "extreme":
        return f"{draw.choice(['min', 'max'])}({a},{formula(draw, depth - 1)})"
    if kind == "limit":
        return f"limit({a},{min(pair := [number(draw), number(draw)])!r},{max(pair)!r})"
    if kind == "far limit":
        far = 10.0 ** draw.randint(4, 12)
        return f"limit({a},{-far!r},{far!r})"
    if kind == "choose":
        return f"if({a}>{number(draw)!r},{number(draw)!r},{number(draw)!r})"
    if kind == "table":
        at = numbers(draw, draw.randint(2, 4))
        at = at if len(at) > 1 else [-1.0, 1.0]
        return f"table({a},{','.join(f'{x!r},{number(draw)!r}' for x in at)})"
    if kind in ("u", "sgn"):  # elsewhere than where a limit may rest
        return f"{kind}({a}-({number(draw)!r}))"
    return f"{kind}({a})"


def bounds(text, n, m, error_n, error_m):
    code = compile(text.replace("if(", "choose("), "formula", "eval")
    found = [eval(code, {**FUNCTIONS, "v": lambda x: x, "n": n + i * error_n, "m": m + k * error_m})
             for i in SPREAD for k in SPREAD]
    return min(found), max(found)


def check(checker, program, seed):
    draw = random.Random(seed)
    a, b = (float(f"{10 ** draw.uniform(-3, 3):.3g}") for _ in range(2))
    text = formula(draw, draw.randint(1, 4))
    ran = run(program, f"random formula\nv1 a 0 sin(0 {a!r} 1k)\nr1 a n 1k\nc1 n 0 10n\n"
                       f"v2 b 0 sin({b / 3!r} {b!r} 1.7k)\nr2 b m 1k\nc2 m 0 20n\nb1 z 0 v={text}\nrz z 0 1k\n"
                       ".tran 40u 2m\n.end\n", method=None, options=["--audit", "full", "--fill", "40u"])
    if not checker.check(ran.status == 0, f"seed {seed}: {text}: {ran.stderr[-300:]}"):
        return
    n, m, z = (ran.column(f"v({node})") for node in "nmz")
    size = max(max(map(abs, z)), 1e-3 * max(a, b))  # small signals are held to the scale of large ones
    events = {event["time"] for event in ran.report["events"]}  # steep pieces pass while the time does not
    off = 0.0
    for k, value in enumerate(z):
        if ran.time[k] in events:
            continue
        low, high = bounds(text, n[k], m[k], ARGUMENT_ERROR * a, ARGUMENT_ERROR * b)
        off = max(off, low - value, value - high)
    checker.check(off <= 1e-8 * size, f"seed {seed}: {text} is off by {off / size:.1e}")


def main():
    first, count = (int(x) for x in sys.argv[2:4]) if len(sys.argv) > 2 else (0, 80)
    checker = Checker("random formulas")
    for seed in some_of(range(first, first + count), 1):
        check(checker, sys.argv[1], seed)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
