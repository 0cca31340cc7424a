#!/usr/bin/env python3
"""Functions that read each other in a ring: a thermistor between a source and a capacitor. Its voltage is its current times
a function of its temperature, and its current squared times that function heats it. What polynomials of functions miss
between nodes grew from function to function then, and no step was short enough. The reference is the method of Runge and
Kutta in small steps.

usage: smooth_rings.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, kinds_of, run, some_of  # noqa: E402

AT = [k / 1000 for k in range(11)]  # s
STEPS = 400  # of the reference between two of these
KELVIN = 298.0

# the resistance over that at KELVIN
LAWS = {
    "exp(3000*(1/v(T)-1/298))": lambda kelvin: math.exp(3000 * (1 / kelvin - 1 / KELVIN)),
    "(298/v(T))**10": lambda kelvin: (KELVIN / kelvin) ** 10,
    "1/(1+0.1*(v(T)-298))": lambda kelvin: 1 / (1 + 0.1 * (kelvin - KELVIN)),
}
SCALES = [(300.0, 10.0), (5.0, 1e3), (1e4, 0.1)]  # V, ohm
WAYS = {
    "formula": "Bn a b V=i(Bn)*{0}*{1}\nBt 0 T I=i(Bn)**2*{0}*{1}",
    "resistance": "Rn a b R={{{0}*{1}}}\nBt 0 T I=i(Rn)**2*{0}*{1}",
}


def reference(law, volts, ohms, series, farads, heat):
    """The capacitor's voltage and the temperature at AT."""

    def rates(state):
        current = (volts - state[0]) / (series + ohms * law(state[1]))
        return current / farads, current**2 * ohms * law(state[1]) / heat

    def ahead(state, rate, h):
        return state[0] + h * rate[0], state[1] + h * rate[1]

    state, h, found = (0.0, KELVIN), AT[1] / STEPS, [(0.0, KELVIN)]
    for _ in AT[1:]:
        for _ in range(STEPS):
            a = rates(state)
            b = rates(ahead(state, a, h / 2))
            c = rates(ahead(state, b, h / 2))
            d = rates(ahead(state, c, h))
            state = tuple(state[k] + h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]) for k in range(2))
        found.append(state)
    return found


def check(checker, program, text, way, scale):
    volts, ohms = scale
    series, farads, heat = ohms / 20, 4.7e-3 / ohms, 0.8 * (volts / 300) ** 2 * 10 / ohms
    title = f"{text} as a {way}, {volts:g} V, {ohms:g} ohm"
    netlist = "\n".join([
        title, f"V1 in 0 {volts!r}", f"Rs in a {series!r}", WAYS[way].format(repr(ohms), text), f"C1 b 0 {farads!r}",
        f"CT T 0 {heat!r} ic={KELVIN!r}", ".tran 1m 10m uic", ""])
    result = run(program, netlist, method=None, at=AT, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        return
    steps = result.report["work"]["steps"]
    checker.check(steps < 300, f"{title}: {steps} steps")
    wanted = reference(LAWS[text], volts, ohms, series, farads, heat)
    for t, volt, kelvin, (is_volt, is_kelvin) in zip(AT, result.column("v(b)"), result.column("v(t)"), wanted):
        checker.close(volt, is_volt, 1e-7 * volts, f"{title}: v(b) at {t:g} s")
        checker.close(kelvin, is_kelvin, 1e-7 * KELVIN, f"{title}: v(T) at {t:g} s")


def main():
    program = sys.argv[1]
    checker = Checker("smooth_rings")
    for text in kinds_of(LAWS):
        for scale in some_of(SCALES, 2):
            for way in WAYS:
                check(checker, program, text, way, scale)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
