#!/usr/bin/env python3
"""Formulas of one quantity that jump between smooth sides, upwards: at the jump the element carries whatever the circuit
chooses between both sides. Beside one resistor and a source the answer is where a line meets the graph, found here by
bisection; of a mass that sticks and slips it is an integration from event to event.

usage: smooth_jumps.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import rising_element  # noqa: E402
from dalcs_program import Checker, run, some_of  # noqa: E402


def odd(f):
    return lambda x: math.copysign(f(abs(x)), x)


def above(x, at, value):
    return value if x > at else 0.0


LAWS = {
    "sgn(X)*(2-exp(-abs(X)))": odd(lambda x: 2 - math.exp(-x)),
    "sgn(X)*(1+0.5*tanh(abs(X)))": odd(lambda x: 1 + 0.5 * math.tanh(x)),
    "sgn(X)+sgn(X)*X**2": odd(lambda x: 1 + x * x),
    "sgn(X)*sqrt(1+X**2)": odd(lambda x: math.hypot(1, x)),
    "2/(1+exp(-X))-1+0.5*sgn(X)": lambda x: math.tanh(x / 2) + math.copysign(0.5, x),
    "sgn(X-0.4)*(0.3+atan(abs(X-0.4)))":
        lambda x: math.copysign(0.3 + math.atan(abs(x - 0.4)), x - 0.4),
    "u(X)*(1+X**2)": lambda x: above(x, 0, 1 + x * x),
    "u(X-0.5)*exp(X)": lambda x: above(x, 0.5, math.exp(x)),
    "X+u(X)*(0.2+X**3)": lambda x: x + above(x, 0, 0.2 + x**3),
    "X>0?1+ln(1+X):-2+X": lambda x: 1 + math.log1p(x) if x > 0 else x - 2,
    "X>=0?exp(X):-exp(-X)": odd(lambda x: math.exp(min(x, 50))),
    "X<0?-0.5-sinh(-X):0.5+X": lambda x: -0.5 - math.sinh(min(-x, 50)) if x < 0 else 0.5 + x,
    "u(X-0.5)*(1+sqrt(X))+u(X+0.7)*(0.3+0.1*exp(X))":
        lambda x: above(x, 0.5, 1 + math.sqrt(max(x, 0))) + above(x, -0.7, 0.3 + 0.1 * math.exp(x)),
}
CASES = [1e-6, 1e-3, 1.0, 1e4]  # of the argument


def stick_and_slip(at, belt, step=1e-3):
    """The velocity of a mass of 1 on a belt, at a spring of 1, at those times: friction of 1 + 0.5 exp(-|slip|/0.1)."""
    t, w, force, sticks = 0.0, 0.0, 0.0, False
    found = []

    def rates(w, force):
        slip = w - belt
        return (-force - math.copysign(1 + 0.5 * math.exp(-abs(slip) / 0.1), slip if slip else -force), w)

    def advance(w, force, h):
        if sticks:
            return belt, force + belt * h
        a = rates(w, force)
        b = rates(w + 0.5 * h * a[0], force + 0.5 * h * a[1])
        c = rates(w + 0.5 * h * b[0], force + 0.5 * h * b[1])
        d = rates(w + h * c[0], force + h * c[1])
        return tuple(x + h / 6 * (p + 2 * (q + r) + s) for x, p, q, r, s in zip((w, force), a, b, c, d))

    for until in at:
        while t < until:
            h = min(step, until - t)
            new = advance(w, force, h)
            if sticks and new[1] > 1.5:  # it breaks away
                h = (1.5 - force) / belt
                new = advance(w, force, h)
            elif not sticks and (w - belt) * (new[0] - belt) < 0:
                low, high = 0.0, h
                for _ in range(60):
                    h = 0.5 * (low + high)
                    low, high = (h, high) if (w - belt) * (advance(w, force, h)[0] - belt) > 0 else (low, h)
                new = (belt, advance(w, force, h)[1])
            was = sticks
            sticks = (new[1] < 1.5 - 1e-12) if was else new[0] == belt and abs(new[1]) < 1.5
            t, (w, force) = t + h, new
            if was and not sticks:  # off the belt the mass is the slower one
                w = math.nextafter(belt, 0)
        found.append(w)
    return found


def check_friction(checker, program, belt, ohms):
    """Velocities are voltages: 1/ohms amperes are a force of 1."""
    at = [k / 2 for k in range(1, 60)]
    slip = f"(v(w)-{belt!r})"
    netlist = f"""a mass on a belt, {belt:g} V, {ohms:g} ohm
C1 w 0 {1 / ohms!r}
L1 w 0 {ohms!r}
B1 w 0 I=sgn({slip})*(1+0.5*exp(-abs({slip})/0.1))/{ohms!r}
.tran 0.5 30 uic
"""
    title = netlist.splitlines()[0]
    result = run(program, netlist, method=None, at=at, options=["--audit", "full"])
    if checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        for t, found, value in zip(at, result.column("v(w)"), stick_and_slip(at, belt)):
            checker.close(found, value, 1e-4, f"{title} at {t:g} s")


def main():
    program = sys.argv[1]
    checker = Checker("smooth_jumps")
    rising_element.check_scales(checker, program, LAWS, CASES, (0.1, 2), 2e-5)
    for ohms in some_of([1.0, 1e-3, 1e5]):
        check_friction(checker, program, 0.2, ohms)
    check_friction(checker, program, 0.05, 1.0)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
