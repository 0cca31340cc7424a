#!/usr/bin/env python3
"""Switches that V sources control, of every two or three kinds of sources, against the roots of their formulas.

usage: direct_controls.py PROGRAM

Each control is a sum of sources, in series or between the switch's two nodes. The times at which it crosses the
thresholds are found here by sampling the formulas between their edges and halving the intervals. Each netlist runs with
its switches alone; in a part of many unknowns; through E sources; and with the control taken through a formula, a
subcircuit, or an E source that reads itself, where the program does not know the times beforehand.
"""

import itertools
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SAMPLES = 4000       # between two edges, or in the whole run
DIRECT = 1e-12       # of the stop time: a time that is computed from the sources
LOCATED = 1e-10      # one that is found on a step's polynomials
IN_LARGE = 1e-9      # the same in a part of more than 64 unknowns, which is held to 1e-6
CABLE = 40           # sections of a cable that makes a part large


# ---- Sources: a card, a formula with a side, and edges ---------------------------------------------------------

class Sine:
    def __init__(self, offset, amplitude, frequency, delay=0.0, damping=0.0, phase=0.0):
        self.values = (offset, amplitude, frequency, delay, damping, phase)
        self.card = "SIN(%r %r %r %r %r %r)" % self.values
        self.edges = [delay]

    def at(self, t, _):
        offset, amplitude, frequency, delay, damping, phase = self.values
        since = max(t - delay, 0.0)
        return offset + amplitude * math.exp(-damping * since) * math.sin(
            2 * math.pi * frequency * since + math.radians(phase))


class Lines:
    """Points (t, v) in ascending order; equal times are a jump."""

    def __init__(self, card, points):
        self.card, self.points = card, points
        self.edges = sorted({t for t, _ in points})

    def at(self, t, side):
        before = [p for p in self.points if p[0] < t or (side > 0 and p[0] == t)]
        after = [p for p in self.points if p[0] > t or (side < 0 and p[0] == t)]
        if not before:
            return after[0][1]
        if not after:
            return before[-1][1]
        (t0, v0), (t1, v1) = before[-1], after[0]
        return v0 if t1 == t0 else v0 + (v1 - v0) * ((t - t0) / (t1 - t0))


def pulse(low, high, delay, rise, fall, width, period, stop):
    points = [(-1.0, low)]
    for n in range(int(stop / period) + 2):
        start = delay + n * period
        points += [(start, low), (start + rise, high), (start + rise + width, high),
                   (start + rise + width + fall, low)]
    return Lines(f"PULSE({low!r} {high!r} {delay!r} {rise!r} {fall!r} {width!r} {period!r})", points)


def pwl(*points):
    return Lines("PWL(" + " ".join(f"{t!r} {v!r}" for t, v in points) + ")", list(points))


class Exponential:
    def __init__(self, low, high, td1, tau1, td2, tau2):
        self.values = (low, high, td1, tau1, td2, tau2)
        self.card = "EXP(%r %r %r %r %r %r)" % self.values
        self.edges = [td1, td2]

    def at(self, t, _):
        low, high, td1, tau1, td2, tau2 = self.values
        rise = -math.expm1(-(t - td1) / tau1) if t > td1 else 0.0
        fall = -math.expm1(-(t - td2) / tau2) if t > td2 else 0.0
        return low + (high - low) * (rise - fall)


class FrequencyModulated:
    def __init__(self, offset, amplitude, carrier, index, signal):
        self.values = (offset, amplitude, carrier, index, signal)
        self.card = "SFFM(%r %r %r %r %r)" % self.values
        self.edges = []

    def at(self, t, _):
        offset, amplitude, carrier, index, signal = self.values
        return offset + amplitude * math.sin(2 * math.pi * carrier * t +
                                             index * math.sin(2 * math.pi * signal * t))


class AmplitudeModulated:
    def __init__(self, amplitude, offset, modulating, carrier):
        self.values = (amplitude, offset, modulating, carrier)
        self.card = "AM(%r %r %r %r)" % self.values
        self.edges = []

    def at(self, t, _):
        amplitude, offset, modulating, carrier = self.values
        return amplitude * (offset + math.sin(2 * math.pi * modulating * t)) * math.sin(
            2 * math.pi * carrier * t)


# ---- Times at which a control moves a switch --------------------------------------------------------------------

class Control:
    """A sum of sources with signs; thresholds of the switch."""

    def __init__(self, name, terms, vt=0.0, vh=0.0, stop=4e-3):
        self.name, self.terms, self.vt, self.vh, self.stop = name, terms, vt, vh, stop

    def at(self, t, side=1):
        return sum(sign * source.at(t, side) for sign, source in self.terms)

    def moves(self):
        """[time] from the position at 0 on."""
        edges = {e for _, source in self.terms for e in source.edges if 0.0 < e < self.stop}
        grid = sorted(edges | {self.stop * k / SAMPLES for k in range(SAMPLES + 1)})
        is_on, found = self.at(0.0) > self.vt + self.vh, []
        for a, b in itertools.pairwise(grid):
            for t, side in ((a, 1), (b, -1)):
                above = self.at(t, side) - (self.vt - self.vh if is_on else self.vt + self.vh)
                if (above < 0.0) == is_on and above != 0.0:
                    found.append(self.root(a, b, is_on) if t == b else t)
                    is_on = not is_on
        return found

    def root(self, a, b, is_on):
        level = self.vt - self.vh if is_on else self.vt + self.vh
        low, high = a, b
        for _ in range(200):
            middle = 0.5 * (low + high)
            side = 1 if middle == low else -1
            if (self.at(middle, side) - level < 0.0) == is_on:
                high = middle
            else:
                low = middle
        return high


def controls():
    def triangle(period, delay=0.0, low=-1.0, high=1.0, top=1e-9, stop=4e-3):
        return pulse(low, high, delay, period / 2, period / 2 - 2 * top, top, period, stop)

    def saw(period, fall, stop=4e-3):
        return pulse(-1.0, 1.0, 0.0, period - 2 * fall - 1e-9, fall, 1e-9, period, stop)

    sine = Sine(0.0, 0.8, 50.0)
    yield Control("sine, triangle", [(1, sine), (-1, triangle(500e-6))])
    yield Control("triangle, sine", [(1, triangle(500e-6)), (-1, sine)])
    yield Control("sine, saw", [(1, Sine(0.1, 0.7, 250.0)), (-1, saw(400e-6, 1e-9))])
    yield Control("sine, steep saw", [(1, Sine(0.1, 0.7, 250.0)), (-1, saw(400e-6, 1e-12))])
    yield Control("sine, square",
                  [(1, Sine(0.0, 0.8, 700.0)), (1, pulse(0.0, 0.5, 1e-4, 0, 0, 2e-4, 5e-4, 4e-3))], vt=0.6)
    yield Control("sine, level", [(1, Sine(0.0, 1.0, 1e3)), (-1, pwl((0.0, 0.25)))])
    yield Control("sine above itself", [(1, Sine(0.0, 1.0, 1e3))], vt=0.999999)
    yield Control("sine, PWL", [(1, sine), (-1, pwl((0.0, 1.0), (1e-3, -1.0), (2e-3, 1.0), (2e-3, 0.0), (4e-3, 0.7)))])
    yield Control("EXP, PULSE", [(1, Exponential(0.0, 1.0, 2e-4, 1e-3, 3e-3, 3e-4)), (-1, triangle(500e-6, low=0.0))])
    yield Control("EXP", [(1, Exponential(0.0, 1.0, 2e-4, 1e-3, 3e-3, 3e-4))], vt=0.5)
    yield Control("SFFM, PULSE", [(1, FrequencyModulated(0.0, 0.9, 1e3, 2.0, 250.0)), (-1, triangle(300e-6))])
    yield Control("AM, PULSE", [(1, AmplitudeModulated(0.4, 1.0, 200.0, 1.5e3)), (-1, triangle(450e-6))])
    yield Control("two sines", [(1, Sine(0.0, 1.0, 1e3)), (-1, Sine(0.0, 0.7, 1.3e3, 0, 0, 40.0))])
    yield Control("damped, PULSE", [(1, Sine(0.0, 1.0, 2e3, 1e-4, 500.0)), (-1, triangle(900e-6))])
    yield Control("growing", [(1, Sine(0.0, 0.1, 2e3, 1e-4, -700.0)), (-1, triangle(900e-6))])
    yield Control("three, stacked", [(1, Sine(0.0, 0.4, 500.0)), (1, Sine(0.0, 0.3, 1500.0)), (-1, triangle(350e-6))])
    yield Control("hysteresis", [(1, Sine(0.0, 0.8, 500.0)), (-1, triangle(410e-6))], vt=0.05, vh=0.3)
    yield Control("offset", [(1, Sine(5.0, 0.8, 500.0)), (-1, triangle(410e-6, low=4.0, high=6.0))])
    yield Control("offset at the switch", [(1, Sine(5.0, 0.8, 500.0)), (-1, triangle(410e-6))], vt=5.0)
    yield Control("delayed", [(1, Sine(0.2, 0.8, 500.0, 1.1e-3, 0.0, 30.0)), (-1, triangle(410e-6, delay=0.7e-3))])
    yield Control("kilovolts", [(1, Sine(0.0, 8e3, 500.0)), (-1, triangle(410e-6, low=-1e4, high=1e4))])
    yield Control("millivolts", [(1, Sine(0.0, 8e-3, 500.0)), (-1, triangle(410e-6, low=-1e-2, high=1e-2))])
    yield Control("fast carrier", [(1, Sine(0.0, 0.8, 5e3)), (-1, triangle(10e-6, stop=4e-4))], stop=4e-4)


# ---- Netlists ---------------------------------------------------------------------------------------------------

def sources(terms, tag=""):
    """Cards with the sum between g<tag> and 0: positive ones stacked on g, negative ones below it."""
    node, lines = "0", []
    for k, (sign, source) in enumerate(terms):
        above = f"g{tag}" if k == len(terms) - 1 else f"m{tag}x{k}"
        plus, minus = (above, node) if sign > 0 else (node, above)
        lines.append(f"v{tag}x{k} {plus} {minus} {source.card}")
        node = above
    return lines


def two_sided(terms):
    """The positive ones on h, the negative ones on k."""
    lines = []
    for name, sign in (("h", 1), ("k", -1)):
        chosen = [(1, source) for s, source in terms if s == sign]
        lines += sources(chosen, name) if chosen else [f"v{name}0 g{name} 0 0"]
    return lines


CABLE_CARDS = ["rc0 p c0 1k"] + [line for k in range(CABLE) for line in (
    f"rc{k + 1} c{k} c{k + 1} 1k", f"cc{k} c{k} 0 1n")]


def doubled(n):
    """E sources from g to f, each a mean of two that read the one before: the number of terms doubles n times."""
    return [line for k in range(n) for line in (
        f"em{k} m{k} 0 0 d{k} 1", f"ed{k} d{k + 1} 0 d{k} m{k} 0.5")] + [f"ef f 0 d{n} 0 1", "e0 d0 0 g 0 1"]


WAYS = {  # name: (cards, control nodes, how well times are known)
    "stacked": (lambda c: sources(c.terms), "g 0", DIRECT),
    "two-sided": (lambda c: two_sided(c.terms), "gh gk", DIRECT),
    "stacked, cable": (lambda c: sources(c.terms) + CABLE_CARDS, "g 0", DIRECT),
    "E": (lambda c: two_sided(c.terms) + ["e1 f 0 gh gk 1"], "f 0", DIRECT),
    "E by E": (lambda c: two_sided(c.terms) + ["e3 f 0 m x 0.5", "e1 m 0 gh 0 2", "e2 0 x gk 0 -2"], "f 0", DIRECT),
    "E on V": (lambda c: sources(c.terms) + ["v9 n9 0 3", "e1 f n9 g n9 1"], "f 0", DIRECT),
    "E by itself": (lambda c: sources(c.terms) + ["e1 f 0 g f 1", "e2 h f f 0 1"], "h 0", LOCATED),
    "E, 8-fold": (lambda c: sources(c.terms) + doubled(3), "f 0", DIRECT),
    "E, 512-fold": (lambda c: sources(c.terms) + doubled(9), "f 0", LOCATED),
    "B": (lambda c: two_sided(c.terms) + ["b1 f 0 V=v(gh)-v(gk)"], "f 0", LOCATED),
    "B, cable": (lambda c: two_sided(c.terms) + CABLE_CARDS + ["b1 f 0 V=v(gh)-v(gk)"], "f 0", IN_LARGE),
    "R": (lambda c: sources(c.terms) + ["rg g f 1k", "rf f 0 1meg"], "f 0", LOCATED),
    "subcircuit": (lambda c: two_sided(c.terms) + [".subckt gain a b f", "e1 f 0 a b 1", ".ends", "x1 gh gk f gain"],
                   "f 0", LOCATED),
}


def netlist(control, way):
    cards, nodes, _ = WAYS[way]
    scale = 1e6 / (1e6 + 1e3) if way == "R" else 1.0
    return "\n".join([control.name, *cards(control), "vp p 0 1", f"s1 p out {nodes} sm", "rout out 0 1",
                      f".model sm sw(vt={control.vt * scale!r} vh={control.vh * scale!r})",
                      f".tran {control.stop / 100!r} {control.stop!r}", ".end", ""])


def compare(checker, what, outcome, element, wanted, allowed):
    if not checker.check(outcome.status == 0, f"{what}: {outcome.stderr[:300]}"):
        return
    found = [e["time"] for e in outcome.report["events"] if e["element"] == element]
    if checker.check(len(found) == len(wanted), f"{what}: {len(found)} moves, not {len(wanted)}"):
        worst = max((abs(a - b) for a, b in zip(found, wanted)), default=0.0)
        checker.check(worst <= allowed, f"{what}: a time is off by {worst:.2e} s, {allowed:.2e} s allowed")


def three_phases(program, checker):
    """Six switches between three sines and one triangle, in pairs with opposite signs."""
    stop, carrier = 4e-3, pulse(-1.0, 1.0, 0.0, 125e-6, 125e-6, 0.0, 250e-6, 4e-3)
    lines, wanted = ["three phases", f"vt t 0 {carrier.card}", "vp p 0 300", ".model sm sw(vt=0 vh=0)"], {}
    for k, phase in enumerate((0.0, -120.0, 120.0)):
        sine = Sine(0.0, 0.8, 250.0, 0.0, 0.0, phase)
        lines += [f"vr{k} r{k} 0 {sine.card}", f"s{k}h p o{k} r{k} t sm", f"s{k}l o{k} 0 t r{k} sm",
                  f"r{k} o{k} y 10", f"l{k} y z{k} 10m", f"rz{k} z{k} 0 1"]
        wanted[f"s{k}h"] = Control("", [(1, sine), (-1, carrier)], stop=stop).moves()
        wanted[f"s{k}l"] = Control("", [(-1, sine), (1, carrier)], stop=stop).moves()
    for name, more in (("three phases", []), ("three phases, cable", CABLE_CARDS)):
        outcome = run(program, "\n".join(lines + more + [f".tran 1u {stop!r}", ".end", ""]), method=None)
        for element, times in wanted.items():
            compare(checker, f"{name}, {element}", outcome, element, times, DIRECT * stop)


def by_current(program, checker):
    """A W switch by the current of a V source that two sources drive through a resistor."""
    control = Control("current", [(1, Sine(0.0, 0.8, 500.0)), (-1, pulse(-1.0, 1.0, 0.0, 2e-4, 2e-4, 0.0, 4e-4, 4e-3))])
    text = "\n".join(["current", *sources(control.terms), "rs g s 2", "vs s 0 0", "vp p 0 1", "w1 p out vs wm",
                      "rout out 0 1", ".model wm csw(it=0 ih=0)", f".tran 1u {control.stop!r}", ".end", ""])
    compare(checker, "by current", run(program, text, method=None), "w1", control.moves(), LOCATED * control.stop)


def main():
    checker = Checker("direct_controls")
    program = sys.argv[1]
    for control in some_of(controls()):
        wanted = control.moves()
        checker.check(len(wanted) > 0, f"{control.name}: nothing moves")
        for way, (_, _, allowed) in WAYS.items():
            outcome = run(program, netlist(control, way), method=None)
            compare(checker, f"{control.name}, {way}", outcome, "s1", wanted, allowed * control.stop)
    three_phases(program, checker)
    by_current(program, checker)
    return checker.finish()


sys.exit(main())
