#!/usr/bin/env python3
"""if() of signals: what it chooses between and what it asks may be anything, also chosen.

usage: choices.py PROGRAM

Each circuit has rows of what is chosen, of the signals that it is chosen from and of those that are asked. Beside the
instants at which a condition changes, where a row may have either, the first must be what the others say.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

# V(a) and V(b) are of sources, V(c) and V(d) of RC sections behind them.
CIRCUIT = """{title}
v1 a 0 sin(0 {va} {f})
v2 b 0 sin({offset} {vb} {fb})
r1 a c {r}
c1 c 0 {c}
r2 b d {r}
c2 d 0 {c}
B1 o 0 V={formula}
r3 o 0 {r}
.save v(a) v(b) v(c) v(d) v(o)
.tran {step} {stop}
{dialect}
.end
"""

# formula, what it is of a, b, c and d, dialect: LTspice takes what is above 0.5 for true, ngspice a comparison.
LTSPICE = ".backanno"


def pick(condition, first, second):
    return first if condition else second


def chain(n):
    """n choices, each in the last branch of the one before, as of a trapezoidal waveform of an angle."""
    formula = "v(d)"
    for k in reversed(range(n)):
        formula = f"if(v(c)<{k / n - 0.5:g}, {k + 1}*v(a)+v(d), {formula})"
    return formula


def of_chain(n):
    def value(a, b, c, d):
        out = d
        for k in reversed(range(n)):
            out = pick(c < k / n - 0.5, (k + 1) * a + d, out)
        return out
    return value


CHOICES = (
    ("if(V(a),V(c),V(d))", lambda a, b, c, d: pick(a > 0.5, c, d), LTSPICE),
    ("if(V(c),V(a),V(d))", lambda a, b, c, d: pick(c > 0.5, a, d), LTSPICE),
    ("if(V(c)-V(d),V(a),V(b))", lambda a, b, c, d: pick(c - d > 0.5, a, b), LTSPICE),
    ("if(2*V(c),V(d),0)", lambda a, b, c, d: pick(2 * c > 0.5, d, 0), LTSPICE),
    ("if(!V(c),V(d),V(b))", lambda a, b, c, d: pick(c > 0.5, b, d), LTSPICE),
    ("if(V(c)&V(d),V(a),V(b))", lambda a, b, c, d: pick(c > 0.5 and d > 0.5, a, b), LTSPICE),
    ("if(V(c)|V(d),V(a),V(b))", lambda a, b, c, d: pick(c > 0.5 or d > 0.5, a, b), LTSPICE),
    ("1+if(V(c),2*V(d),-V(d))", lambda a, b, c, d: 1 + pick(c > 0.5, 2 * d, -d), LTSPICE),
    ("if(V(c),V(a)*V(d),V(d))", lambda a, b, c, d: pick(c > 0.5, a * d, d), LTSPICE),
    ("if(V(c),if(V(d),V(a),V(b)),V(d))",
     lambda a, b, c, d: pick(c > 0.5, pick(d > 0.5, a, b), d), LTSPICE),
    ("v(c) > v(d) ? v(a) : v(b)", lambda a, b, c, d: pick(c > d, a, b), ""),
    (chain(3), of_chain(3), LTSPICE),
    (chain(7), of_chain(7), LTSPICE),
    (chain(12), of_chain(12), ""),
)

# V, V, Hz, Hz, V, ohm, F: from 0.5 V and 50 Hz to 20 V and 1 MHz
SCALES = (dict(va=2, vb=5, f=50, fb=120, offset=0, r="1k", c="1u"),
          dict(va=20, vb=11, f=1e6, fb=3.3e6, offset=0.3, r="10", c="10n"))


def check(checker, program, formula, value, dialect, scale):
    name = f"{formula[:60]} at {scale['f']:g} Hz"
    stop = 1 / scale["f"]
    result = run(program, CIRCUIT.format(title=name, formula=formula, dialect=dialect,
                                         step=stop / 400, stop=stop, **scale), method=None)
    if not checker.check(result.status == 0, f"{name}: {result.status}\n{result.stderr}"):
        return
    time, out = result.time, result.column("v(o)")
    signals = zip(*(result.column(f"v({node})") for node in "abcd"))
    size = max(map(abs, out))
    worst = max(abs(o - value(*row)) for k, (o, row) in enumerate(zip(out, signals))
                if time[k] not in (time[k - 1], time[(k + 1) % len(time)]))
    checker.check(worst < 1e-9 * size, f"{name}: off by {worst / size:.2g} of its range")
    checker.check(len(set(time)) < len(time), f"{name}: nothing is chosen")


def main():
    program = sys.argv[1]
    checker = Checker("choices")
    for formula, value, dialect in CHOICES:
        for scale in SCALES:
            check(checker, program, formula, value, dialect, scale)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
