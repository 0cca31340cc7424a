#!/usr/bin/env python3
"""Responses around orbits on which products and functions act, against the variational equation by Runge and Kutta.

usage: smooth.py PROGRAM
"""

import cmath
import math
import pathlib
import sys
import tempfile

from cases import response

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

STEPS = 2000  # in a period, of the fourth order


class Case:
    """dx/dt = f(t, x, on) with derivative g(t, x, on) by x, for which rate(t, x, on) is what a small signal of 1 adds;
    on: whether the diode conducts, for a voltage across it that is not negative."""

    def __init__(self, name, text, period, f, g, rate, diode=lambda t, x: 1.0):
        self.name, self.text, self.period = name, text, period
        self.f, self.g, self.rate, self.diode = f, g, rate, diode


def sine(t):
    return 10 * math.sin(2e3 * math.pi * t)


def pulse(t):
    return 5.0 if t % 1e-5 < 4e-6 else 0.0


CASES = [
    Case("a cubic conductance", """Cubic
Vin in 0 SIN(0 10 1k) AC 1
R1 in x 1k
C1 x 0 100n
B1 x 0 I=1e-4*v(x)*v(x)*v(x)
""", 1e-3, lambda t, x, on: ((sine(t) - x) / 1e3 - 1e-4 * x ** 3) / 1e-7,
         lambda t, x, on: (-1e-3 - 3e-4 * x * x) / 1e-7, lambda t, x, on: 1e-3 / 1e-7),
    Case("a diode before an exponential", """Diode
Vin in 0 SIN(0 10 1k) AC 1
D1 in a
R1 a x 100
C1 x 0 1u
B1 x 0 I=1m*(exp(v(x)/4)-1)
""", 1e-3, lambda t, x, on: (on * (sine(t) - x) / 100 - 1e-3 * (math.exp(x / 4) - 1)) / 1e-6,
         lambda t, x, on: (-0.01 * on - 0.25e-3 * math.exp(x / 4)) / 1e-6,
         lambda t, x, on: 0.01 * on / 1e-6, lambda t, x: sine(t) - x),
    Case("a multiplier", """Multiplier
Vm m 0 SIN(0 1 1k)
Vin in 0 3 AC 1
R1 in x 1k
C1 x 0 100n
B1 x 0 I=0.5m*v(x)*v(m)*v(m)
""", 1e-3, lambda t, x, on: ((3 - x) * 1e-3 - 0.5e-3 * x * (sine(t) / 10) ** 2) / 1e-7,
         lambda t, x, on: (-1e-3 - 0.5e-3 * (sine(t) / 10) ** 2) / 1e-7, lambda t, x, on: 1e-3 / 1e-7),
    Case("a small signal on a factor", """Gain control
Vm m 0 1 AC 1
Vin in 0 SIN(4 10 1k)
R1 in x 1k
C1 x 0 100n
B1 x 0 I=0.5m*v(x)*v(m)
""", 1e-3, lambda t, x, on: ((4 + sine(t) - x) * 1e-3 - 0.5e-3 * x) / 1e-7,
         lambda t, x, on: -1.5e-3 / 1e-7, lambda t, x, on: -0.5e-3 * x / 1e-7),
    Case("a pulse into a square", """Square
Vin in 0 PULSE(0 5 0 0 0 4u 10u) AC 1
R1 in x 100
C1 x 0 50n
B1 x 0 I=5m*v(x)*v(x)
""", 1e-5, lambda t, x, on: ((pulse(t) - x) / 100 - 5e-3 * x * x) / 5e-8,
         lambda t, x, on: (-0.01 - 1e-2 * x) / 5e-8, lambda t, x, on: 0.01 / 5e-8),
]


def sections(case):
    """Times between which f has derivatives, as far as they are known before."""
    return [0.0, 0.4 * case.period, case.period] if "PULSE" in case.text else [0.0, case.period]


def passed(case, x, h, t, end, on):
    """One step of the classic method, at a section's end from the left."""
    inside = min(t + h, end - 1e-9 * case.period) if t + h >= end else t + h
    k1 = case.f(t, x, on)
    k2 = case.f(t + h / 2, x + h / 2 * k1, on)
    k3 = case.f(t + h / 2, x + h / 2 * k2, on)
    k4 = case.f(inside, x + h * k3, on)
    return x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def pieces(case, x, t, h, end):
    """The step, cut where the diode turns."""
    on = case.diode(t + 1e-6 * h, x) > 0
    low, high = 0.0, h
    if (case.diode(t + h, passed(case, x, h, t, end, on)) > 0) == on:
        return [(t, h, on)]
    for _ in range(60):
        middle = (low + high) / 2
        turned = (case.diode(t + middle, passed(case, x, middle, t, end, on)) > 0) != on
        low, high = (low, middle) if turned else (middle, high)
    return [(t, high, on), (t + high, h - high, not on)]


def find_orbit(case):
    """[(t, h, on, x before, x in the middle, x behind)] of a period: all kinds here forget within some of them."""
    x = 0.0
    for last in (False,) * 40 + (True,):
        found = []
        for begin, end in zip(sections(case), sections(case)[1:]):
            n = max(2, round((STEPS if last else STEPS // 4) * (end - begin) / case.period))
            h_all = (end - begin) / n
            for k in range(n):
                for t, h, on in pieces(case, x, begin + k * h_all, h_all, end):
                    middle = passed(case, x, h / 2, t, end, on)
                    after = passed(case, middle, h / 2, t + h / 2, end, on)
                    found.append((t, h, on, x, middle, after))
                    x = after
    return found


def exact(case, orbit, frequency):
    """By the same method of the perturbation d, from 0 and from 1 at the start; the mean by Simpson's rule."""
    w = 2j * math.pi * frequency

    def go(d, forced):
        mean = 0j
        for t, h, on, x, middle, after in orbit:
            edge = t + h - 1e-9 * case.period  # from the left
            a, b, c = case.g(t, x, on), case.g(t + h / 2, middle, on), case.g(edge, after, on)
            drive = [forced * case.rate(at, at_x, on) * cmath.exp(w * at)
                     for at, at_x in ((t, x), (t + h / 2, middle), (edge, after))]
            k1 = a * d + drive[0]
            k2 = b * (d + h / 2 * k1) + drive[1]
            k3 = b * (d + h / 2 * k2) + drive[1]
            k4 = c * (d + h * k3) + drive[2]
            behind = d + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            half = (d + behind) / 2 + h / 8 * (k1 - c * behind - drive[2])
            mean += h / 6 * (d * cmath.exp(-w * t) + 4 * half * cmath.exp(-w * (t + h / 2))
                             + behind * cmath.exp(-w * (t + h)))
            d = behind
        return d, mean / case.period

    (own, own_mean), (driven, driven_mean) = go(1.0, 0.0), go(0.0, 1.0)
    start = driven / (cmath.exp(w * case.period) - own)
    return driven_mean + start * own_mean


def look_at(checker, program, folder, case):
    orbit = find_orbit(case)
    asked = [x / case.period for x in (0.01, 0.13, 0.37, 0.71, 1.3, 2.7)]
    card = f".pss\n.save v(x)\n.ac list {' '.join(map(repr, asked))}\n"
    done, _, rows = response(program, folder, case.text + card)
    if not checker.check(done.returncode == 0 and done.stderr == "", f"{case.name}: {done.stderr}"):
        return
    largest = max(abs(values["v(x)"]) for _, values in rows)
    for frequency, values in rows:
        own = exact(case, orbit, frequency)
        off = abs(values["v(x)"] - own) / largest
        checker.check(off < 3e-8, f"{case.name}: {values['v(x)']:.9g} for {own:.9g} at {frequency}: {off:.2g}")


CONVERTERS = {
    "closed loop": """Vin in 0 12 AC 1
E1 cmp 0 ctl tri 1
S1 in sw cmp 0 sm
D1 0 sw
L1 sw out 47u
C1 out esr 100u
Resr esr 0 0.1
Vref ref 0 5
G1 0 ctl ref out 1m
Rz ctl z 1.3k
Cz z 0 82n
Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
.model sm SW(Ron=0 Vt=0)
""",
    "discontinuous": """Vin in 0 12
Vg g 0 PULSE(0 1 0 0 0 3u 10u)
L1 in sw 10u
S1 sw 0 g 0 sm
D1 sw out
C1 out 0 10u
Iac 0 out 0 AC 1
.model sm SW(Ron=0 Vt=0.5)
"""}


def check_same(checker, program, folder):
    """A load that is a function on paper only, the logarithm of an exponential. Events move on these orbits."""
    for name, text in CONVERTERS.items():
        card = ".pss uic\n.save v(out) i(l1)\n.ac dec 7 100 130k\n"
        found = []
        for load in ("R1 out 0 20\n", "B1 out 0 I=ln(exp(v(out)/10))/2\n"):
            done, _, rows = response(program, folder, f"{name}\n{text}{load}{card}")
            checker.check(done.returncode == 0 and done.stderr == "", f"{name} {load}: {done.stderr}")
            found.append(rows)
        for (frequency, own), (_, other) in zip(*found):
            for signal, value in own.items():
                off = abs(other[signal] - value) / abs(value)
                checker.check(off < 1e-7, f"{name}: {signal} at {frequency} is off by {off:.2g}")
        checker.check(len(found[0]) > 20 and len(found[1]) == len(found[0]), f"{name}: rows")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("smooth")
    with tempfile.TemporaryDirectory() as name:
        for case in CASES:
            look_at(checker, program, pathlib.Path(name), case)
        check_same(checker, program, pathlib.Path(name))
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
