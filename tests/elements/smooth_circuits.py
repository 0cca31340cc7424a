#!/usr/bin/env python3
"""Circuits drawn at random of resistors, coils, capacitors, sources, ideal diodes and switches, and of one to three smooth
elements whose current rises with their voltage. Such a circuit has one answer: it is the least of a convex function at each
step of implicit Euler, which Newton's method finds here with a search along each step. Two such runs, one of half the step,
say how far the reference may be off.

usage: smooth_circuits.py PROGRAM FIRST-LAST [FOLDER]

A run must end, with its audit in full, agree with the reference and take no absurd number of steps. With FOLDER what fails
is left there.
"""

import math
import pathlib
import random
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SECTIONS = 40  # of a run: sources have their corners between two, rows are in their middles
STEPS = 12  # of the coarse run, in each section
MOST_STEPS = 4000  # of the program: no circuit has dynamics faster than a thousandth of its run


def with_sign(f):
    return lambda x: math.copysign(f(abs(x)), x)


def bounded_exp(x):
    return math.exp(min(x, 600.0))


# A function that rises, how it may be written, and by how much what it is of may differ from 1.
LAWS = {
    "cube": (lambda x: x**3, ["{x}**3", "{x}*{x}*{x}", "pow({x},3)", "pwrs({x},3)", "{x}*{x}**2"]),
    "cube and line": (lambda x: x + x**3, ["{x}+{x}**3", "{x}*(1+{x}**2)", "{x}*(1+{x}*{x})"]),
    "fifth": (lambda x: x**5, ["{x}**5", "{x}**2*{x}**3", "pwrs({x},5)"]),
    "root": (with_sign(math.sqrt), ["sgn({x})*sqrt(abs({x}))", "pwrs({x},0.5)", "{x}>0?sqrt({x}):-sqrt(-{x})",
                                    "sqrt(max({x},0))-sqrt(max(-{x},0))", "sgn({x})*abs({x})**0.5"]),
    "low power": (with_sign(lambda x: x**0.3), ["pwrs({x},0.3)", "sgn({x})*pwr({x},0.3)", "sgn({x})*pow(abs({x}),0.3)"]),
    "cube root": (with_sign(lambda x: x**(1 / 3)), ["cbrt({x})"]),
    "high power": (with_sign(lambda x: x**1.5), ["abs({x})**1.5*sgn({x})", "{x}*sqrt(abs({x}))", "pwrs({x},1.5)",
                                                 "{x}*abs({x})**0.5"]),
    "square": (with_sign(lambda x: x * x), ["{x}*abs({x})", "sgn({x})*{x}**2", "pwrs({x},2)", "{x}>0?{x}**2:-({x}**2)",
                                            "sgn({x})*{x}*{x}"]),
    "log": (with_sign(math.log1p), ["sgn({x})*ln(1+abs({x}))", "{x}>0?ln(1+{x}):-ln(1-{x})", "ln(1+abs({x}))*sgn({x})",
                                    "if({x}>=0,ln(1+{x}),-ln(1-{x}))", "ln(1+max({x},0))-ln(1+max(-{x},0))",
                                    "{x}<0?-ln(1-{x}):ln(1+{x})"]),
    "saturating exp": (with_sign(lambda x: -math.expm1(-x)), ["sgn({x})*(1-exp(-abs({x})))",
                                                             "{x}>0?1-exp(-{x}):exp({x})-1",
                                                             "sgn({x})-sgn({x})*exp(-abs({x}))"]),
    "quotient": (lambda x: x / (0.1 + abs(x)), ["{x}/(0.1+abs({x}))", "{x}>0?{x}/(0.1+{x}):{x}/(0.1-{x})",
                                                "{x}/(abs({x})+0.1)"]),
    "hyperbola": (lambda x: x / math.hypot(1, x), ["{x}/sqrt(1+{x}*{x})", "{x}/sqrt(1+{x}**2)", "{x}/hypot(1,{x})",
                                                   "{x}*(1+{x}**2)**(-0.5)"]),
    "tanh": (math.tanh, ["tanh({x})", "(exp({x})-exp(-{x}))/(exp({x})+exp(-{x}))", "1-2/(exp(2*{x})+1)"]),
    "atan": (math.atan, ["atan({x})", "atan2({x},1)"]),
    "asinh": (math.asinh, ["asinh({x})", "ln({x}+sqrt({x}**2+1))", "sgn({x})*ln(abs({x})+sqrt({x}**2+1))"]),
    "sinh": (lambda x: math.sinh(max(-600.0, min(600.0, x))), ["sinh({x})", "0.5*(exp({x})-exp(-{x}))"]),
    "exp": (lambda x: bounded_exp(x) - 1, ["exp({x})-1", "exp({x})*1-1"]),
    "junction": (lambda x: 1e-6 * (bounded_exp(20 * x) - 1), ["1e-6*(exp({x}/0.05)-1)", "1e-6*(exp(20*{x})-1)"]),
    "limit": (lambda x: max(-1.0, min(1.0, x)) + 0.01 * x, ["limit({x},-1,1)+0.01*{x}", "max(-1,min(1,{x}))+0.01*{x}"]),
    "cube on one side": (lambda x: x**3 + x if x > 0 else x, ["{x}>0?{x}**3+{x}:{x}", "{x}+max({x},0)**3",
                                                              "{x}+u({x})*{x}**3", "if({x}>0,{x}*(1+{x}**2),{x})"]),
    "exp on one side": (lambda x: bounded_exp(x) - 1 if x > 0 else x, ["{x}>0?exp({x})-1:{x}", "exp(max({x},0))-1+min({x},0)"]),
    "log on one side": (lambda x: math.log1p(x) if x > 0 else x, ["{x}>0?ln(1+{x}):{x}", "ln(1+max({x},0))+min({x},0)"]),
    "square and line": (lambda x: x + x * abs(x), ["{x}+{x}*abs({x})", "{x}*(1+abs({x}))"]),
    "with ripples": (lambda x: x + 0.9 * math.sin(x), ["{x}+0.9*sin({x})"]),
    "softplus": (lambda x: math.log1p(math.exp(min(x, 600.0))) if x < 600 else x, ["ln(1+exp({x}))"]),
}


class Element:
    """Between two nodes, its current from v: value, slope."""

    def __init__(self, a, b):
        self.a, self.b = a, b
        self.memory = 0.0


class Drawn:
    def __init__(self, seed):
        self.seed, self.random = seed, random.Random(f"smooth circuits {seed}")
        pick = self.random
        self.volt, self.amp = 10.0 ** pick.randint(-3, 3), 10.0 ** pick.randint(-3, 3)
        self.stop = 10.0 ** pick.randint(-5, 0)
        self.n = pick.choice([1, 1, 2, 2, 3, 4, 5, 6, 8, 12])
        self.lines, self.parts, self.linear, self.cards = [], [], [], set()
        self.names = 0
        self.uic = pick.random() < 0.5
        self.inner = self.n  # nodes behind sources that have a resistor
        for node in range(1, self.n + 1):
            self.resistor(node, 0, self.ohm(1, 3))
        for node in range(2, self.n + 1):
            self.branch(node, pick.randrange(1, node))
        for _ in range(pick.randint(0, self.n)):
            self.branch(*self.pair())
        for _ in range(pick.randint(1, 2)):
            self.source(pick.randint(1, self.n), pick.choice([0, 0, pick.randint(0, self.n)]))
        self.laws = []
        for _ in range(pick.choice([1, 1, 2, 3])):
            self.smooth(*self.pair())

    def pair(self):
        a = self.random.randint(1, self.n)
        b = self.random.choice([k for k in range(self.n + 1) if k != a])
        return (a, b) if self.random.random() < 0.5 else (b, a)

    def ohm(self, low, high):
        return float(f"{self.volt / self.amp * 10 ** self.random.uniform(low, high):.4g}")

    def name(self, letter):
        self.names += 1
        return f"{letter}{self.names}"

    def resistor(self, a, b, r):
        self.lines.append(f"{self.name('r')} {a} {b} {r!r}")
        self.linear.append(("r", a, b, r))

    def branch(self, a, b):
        kind = self.random.choice("rrclcdsx" if a and b else "rclcdsx")
        if kind == "r":
            self.resistor(a, b, self.ohm(-1, 1))
        elif kind == "c":
            self.capacitor(a, b)
        elif kind == "l":
            x = float(f"{self.stop * self.volt / self.amp * 10 ** self.random.uniform(-1.5, 0.3):.4g}")
            self.lines.append(f"{self.name('l')} {a} {b} {x!r}")
            self.linear.append(("l", a, b, x))
        elif kind == "d":
            r = self.ohm(-3, -1)
            name = self.name("d")
            self.lines.append(f"{name} {a} {b} m{name}\n.model m{name} D(Ron={r!r})")
            self.parts.append(("d", a, b, r))
        elif kind == "s":
            self.switch(a, b)
        else:
            self.capacitor(a, 0)
            self.resistor(a, b, self.ohm(-1, 1))

    def capacitor(self, a, b):
        x = float(f"{self.stop * self.amp / self.volt * 10 ** self.random.uniform(-1.5, 0.3):.4g}")
        self.lines.append(f"{self.name('c')} {a} {b} {x!r}")
        self.linear.append(("c", a, b, x))

    def switch(self, a, b):
        on, off = self.ohm(-2, 0), self.ohm(1, 3)
        name = self.name("s")
        period = self.random.choice([8, 10, 20])
        part = self.stop / SECTIONS
        self.lines.append(f"v{name} g{name} 0 PULSE(0 1 {2 * part!r} 0 0 {period // 2 * part!r} {period * part!r})\n"
                          f"{name} {a} {b} g{name} 0 m{name}\n.model m{name} SW(Ron={on!r} Roff={off!r} Vt=0.5)")
        is_on = lambda s, p=period: s > 2 and (s - 2) % p < p // 2  # noqa: E731
        self.linear.append(("s", a, b, (is_on, on, off)))

    def wave(self, scale):
        """Text, and the value at a time in sections."""
        pick, part = self.random, self.stop / SECTIONS
        a, b = (float(f"{scale * pick.choice([-1, 1]) * 10 ** pick.uniform(-1, 0.7):.3g}") for _ in range(2))
        kind = pick.choice(["dc", "sin", "sin", "pulse", "pwl", "rise"])
        if kind == "dc":
            return f"DC {a!r}", lambda s: a
        if kind == "sin":
            offset = pick.choice([0.0, b])
            cycles = pick.choice([1, 2, 3])
            return (f"SIN({offset!r} {a!r} {cycles / self.stop!r})",
                    lambda s: offset + a * math.sin(2 * math.pi * cycles * s / SECTIONS))
        if kind == "pulse":
            period = pick.choice([10, 20, 40])
            low = pick.choice([0.0, b])
            return (f"PULSE({low!r} {a!r} {4 * part!r} 0 0 {period // 2 * part!r} {period * part!r})",
                    lambda s: a if s > 4 and (s - 4) % period < period // 2 else low)
        points = [(0, 0.0), (5, a), (18, b), (20, -a), (40, 0.0)] if kind == "pwl" else [(0, 0.0), (40, a)]
        return ("PWL(" + " ".join(f"{s * part!r} {v!r}" for s, v in points) + ")",
                lambda s: float(numpy.interp(s, *zip(*points))))

    def source(self, a, b):
        b = 0 if a == b else b
        if self.random.random() < 0.6:
            text, value = self.wave(self.volt)
            self.inner += 1
            r = self.ohm(-1, 1)
            self.lines.append(f"{self.name('v')} {self.inner} {b} {text}")
            self.lines.append(f"{self.name('r')} {self.inner} {a} {r!r}")
            self.linear.append(("v", a, b, (r, value)))
        else:
            text, value = self.wave(self.amp)
            self.lines.append(f"{self.name('i')} {b} {a} {text}")
            self.linear.append(("i", a, b, value))

    def smooth(self, a, b):
        pick = self.random
        law = pick.choice(list(LAWS))
        function, texts = LAWS[law]
        y_scale = 10 ** pick.uniform(-1.5, 1)
        x_scale = 10 ** pick.uniform(-1, 0.7)
        is_current = pick.random() < 0.65
        text = pick.choice(texts)
        x_unit, y_unit = (self.volt, self.amp) if is_current else (self.amp, self.volt)
        xs, ys = (float(f"{s:.3g}") for s in (x_scale * x_unit, y_scale * y_unit))
        name = self.name("b")
        if is_current:
            of = pick.choice([f"v({a},{b})", f"(v({a})-v({b}))"]) if a and b else f"v({a})" if a else f"(-v({b}))"
        else:
            of = pick.choice([f"i({name})", f"i(vs{name})"])
        x = pick.choice([f"({of}/{xs!r})", f"({1 / xs!r}*{of})"])
        out = text.format(x=x)
        out = pick.choice([f"{ys!r}*({out})", f"({out})*{ys!r}", f"({out})/{1 / ys!r}"])
        self.laws.append(f"{law}: {'i' if is_current else 'v'} = {text}, {xs:g}, {ys:g}")
        if is_current:
            form = pick.choice(["b", "b", "g"])
            self.lines.append(f"{name} {a} {b} I={out}" if form == "b" else f"g{name} {a} {b} VALUE={{{out}}}")
        elif f"i(vs{name})" in of:
            self.inner += 1
            form = pick.choice(["b", "e"])
            self.lines.append(f"vs{name} {a} {self.inner} 0")
            self.lines.append(f"{name} {self.inner} {b} V={out}" if form == "b"
                              else f"e{name} {self.inner} {b} VALUE={{{out}}}")
        else:
            self.lines.append(f"{name} {a} {b} V={out}")
        self.parts.append(("g" if is_current else "h", a, b, (function, xs, ys)))

    def text(self):
        title = f"smooth {self.seed}: " + "; ".join(self.laws)
        tran = f".tran {self.stop / SECTIONS!r} {self.stop!r}" + (" uic" if self.uic else "")
        return "\n".join([title, *self.lines, tran, ".end", ""])


def solve_increasing(f, y, x):
    """x with f(x) = y, f rising; from near x."""
    size = 1e-3 + abs(x)
    low, high = x - size, x + size
    for _ in range(400):
        if f(low) <= y:
            break
        size *= 2
        low -= size
    for _ in range(400):
        if f(high) >= y:
            break
        size *= 2
        high += size
    for _ in range(200):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        if f(middle) < y:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


class Reference:
    def __init__(self, drawn):
        self.drawn, self.n = drawn, drawn.n
        self.state = {}

    def current(self, part, v):
        """Of a part that is not linear, and its slope."""
        kind, _, _, what = part
        if kind == "d":
            return (v / what, 1 / what) if v > 0 else (0.0, 0.0)
        function, xs, ys = what
        if kind == "g":
            x = v / xs
            d = 1e-6 * (abs(x) + 1e-6)
            i = ys * function(x)
            return i, ys * (function(x + d) - function(x - d)) / (2 * d) / xs
        key = id(part)
        x = solve_increasing(function, v / ys, self.state.get(key, 0.0))
        self.state[key] = x
        d = 1e-6 * (abs(x) + 1e-6)
        slope = (function(x + d) - function(x - d)) / (2 * d) * ys / xs
        return x * xs, 1 / max(slope, 1e-12 * ys / xs)

    def matrix(self, s, h):
        n = self.n
        g, right = numpy.zeros((n + 1, n + 1)), numpy.zeros(n + 1)
        for k, (kind, a, b, what) in enumerate(self.drawn.linear):
            memory = self.memory[k]
            if kind == "r":
                y, source = 1 / what, 0.0
            elif kind == "c":
                y = what / h if not self.at_rest else 0.0
                source = y * memory
            elif kind == "l":
                y = h / what
                source = -memory
            elif kind == "s":
                y, source = 1 / (what[1] if what[0](s) else what[2]), 0.0
            elif kind == "v":
                y = 1 / what[0]
                source = what[1](s) / what[0]
            else:
                y, source = 0.0, what(s)
            g[a, a] += y
            g[b, b] += y
            g[a, b] -= y
            g[b, a] -= y
            right[a] += source
            right[b] -= source
        return g, right

    def residual(self, g, right, v, slopes=None):
        f = g @ v - right
        for part in self.drawn.parts:
            _, a, b, _ = part
            i, slope = self.current(part, v[a] - v[b])
            f[a] += i
            f[b] -= i
            if slopes is not None:
                slopes[a, a] += slope
                slopes[b, b] += slope
                slopes[a, b] -= slope
                slopes[b, a] -= slope
        return f

    def newton(self, s, h, v):
        g, right = self.matrix(s, h)
        polished = 0
        for _ in range(200):
            slopes = g.copy()
            f = self.residual(g, right, v, slopes)
            d = numpy.zeros_like(v)
            d[1:] = -numpy.linalg.solve(slopes[1:, 1:], f[1:])
            if not numpy.all(numpy.abs(d) <= 1e-10 * self.drawn.volt + 1e-9 * numpy.max(numpy.abs(v))):
                along = lambda t: float(self.residual(g, right, v + t * d)[1:] @ d[1:])  # noqa: E731
                low, high = 0.0, 1.0
                if along(1.0) > 0:
                    for _ in range(60):
                        middle = 0.5 * (low + high)
                        value = along(middle)
                        low, high = (low, middle) if value > 0 else (middle, high)
                        if high - low < 1e-3 * high:
                            break
                v = v + high * d
                continue
            # at rest the current of a coil is its voltage times 1e7 stops
            v, polished = v + d, polished + 1
            if not self.at_rest or polished == 4:
                return v
        raise ArithmeticError("the reference does not converge")

    def advance(self, v, h):
        for k, (kind, a, b, what) in enumerate(self.drawn.linear):
            if kind == "c":
                self.memory[k] = v[a] - v[b]
            elif kind == "l":
                self.memory[k] += h / what * (v[a] - v[b])

    def run(self, steps):
        """The voltages in the middles of sections, with so many steps in each half section."""
        self.memory = [0.0] * len(self.drawn.linear)
        v = numpy.zeros(self.n + 1)
        self.at_rest = False
        if not self.drawn.uic:
            h = 1e7 * self.drawn.stop
            self.at_rest = True
            v = self.newton(0.0, h, v)
            self.advance(v, h)
            self.at_rest = False
        h = self.drawn.stop / SECTIONS / (2 * steps)
        rows = []
        for section in range(SECTIONS):
            for k in range(2 * steps):
                # the sources just before the end of the step
                s = section + (k + 1) / (2 * steps) - 1e-9
                v = self.newton(s, h, v)
                self.advance(v, h)
                if k + 1 == steps:
                    rows.append(v[1:].copy())
        return numpy.array(rows)


def look(program, checker, seed, folder):
    drawn = Drawn(seed)
    text = drawn.text()
    at = [(k + 0.5) * drawn.stop / SECTIONS for k in range(SECTIONS)]
    before = checker.failures
    outcome = run(program, text, method=None, at=at, options=["--audit", "full"], environment={"LC_ALL": "C"})
    if checker.check(outcome.status == 0, f"{seed} {drawn.laws}: exit {outcome.status}: {outcome.stderr}"):
        work = outcome.report["work"]
        events = len(outcome.report["events"])
        checker.check(work["steps"] <= MOST_STEPS + 60 * events, f"{seed} {drawn.laws}: {work['steps']} steps, {events} events")
        found = numpy.array([outcome.column(f"v({node})") for node in range(1, drawn.n + 1)]).T
        try:
            coarse, fine = Reference(drawn).run(STEPS), Reference(drawn).run(2 * STEPS)
        except (ArithmeticError, OverflowError, numpy.linalg.LinAlgError) as error:
            print(f"note: {seed}: no reference: {error}")
            return
        wanted = 2 * fine - coarse
        scale = max(numpy.max(numpy.abs(fine)), 1e-12 * drawn.volt)
        allowed = 2 * numpy.max(numpy.abs(fine - coarse)) + 1e-4 * scale
        off = numpy.max(numpy.abs(found - wanted))
        checker.check(off <= allowed, f"{seed} {drawn.laws}: off by {off:.3g} of {scale:.3g}, allowed {allowed:.3g}")
    if folder and checker.failures > before:
        pathlib.Path(folder, f"s{seed}.cir").write_text(text)


def main():
    program, seeds = sys.argv[1:3]
    folder = sys.argv[3] if len(sys.argv) > 3 else None
    checker = Checker("smooth_circuits")
    for part in seeds.split(","):
        first, _, last = part.partition("-")
        for seed in some_of(range(int(first), int(last or first) + 1), 3):
            look(program, checker, seed, folder)
            sys.stdout.flush()
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
