#!/usr/bin/env python3
"""The orders of Radau IIA and Lobatto IIIC with s stages, measured with fixed steps against closed forms.

usage: order.py PROGRAM index1|index2|rectifier|relaxation radau|lobatto

What theory says, and what is fitted over a ladder of steps (Hairer, Lubich and Roche, The numerical
solution of differential-algebraic systems by Runge-Kutta methods, 1989):
  ends    states at the ends of steps: order 2s - 1, of Lobatto 2s - 2
  dense   anywhere between: s + 1, of Lobatto s, and no more than at the ends
  events  times of events, and all values after them: as dense, since they are located there
  fluxes  the current through a source that a capacitor lies across (index 2): order s, of Lobatto s - 1
The steps are chosen so that errors lie between 3e-14, above rounding, and 3e-2, of Lobatto 7e-3, where
the order is not yet seen; an error outside leaves its step out of the fit. A slope may be lower than the order
by 0.5, which is what such a ladder of a correct method shows; higher is not wrong, but for the ends
of index1, where the leading term of the error is large, by more than 0.7.
"""

import cmath
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

STAGES = {"radau": (1, 3, 5, 7, 9), "lobatto": (3, 5, 7, 9)}
BELOW, ABOVE = 0.7, 0.7
FINER = {"index1": (1, 2), "index2": (1, 2, 4), "rectifier": (1,), "relaxation": (1,)}  # of Lobatto: than
# the steps below, which are for Radau; with one node less its order shows later
SMALLEST, LARGEST = 3e-14, {"radau": 3e-2, "lobatto": 7e-3}
NEIGHBOURS = 4  # runs for a rung of a circuit with events: its error depends on where they fall
SAMPLED = 400  # steps, of a run that has many
BETWEEN = [(k + 0.5) / 10 for k in range(10)]  # of a step


def bisect(function, low, high):
    """The root between two times; the function changes sign there once."""
    rising = function(high) > function(low)
    while True:
        middle = (low + high) / 2
        if middle in (low, high):
            return middle
        if (function(middle) > 0) == rising:
            high = middle
        else:
            low = middle


class Index1:
    """A series RLC on a sine: two states, one node that is algebraic."""

    NETLIST = """A series RLC on a sine
V1 in 0 SIN(0 10 3k)
R1 in a 20
L1 a b 1m IC=10m
C1 b 0 1u IC=2
.tran 1u 1m uic
.end
"""
    stop = 1e-3
    steps = {1: (800, 1600, 3200, 6400), 3: (40, 56, 80, 112, 160), 5: (14, 18, 24, 32, 40),
             7: (9, 11, 13, 15, 18), 9: (6, 7, 8, 9, 11)}
    scale = {"v(b)": 10, "i(l1)": 0.3, "v(a)": 10}
    ends = ["v(b)", "i(l1)", "v(a)"]
    dense = ["v(b)", "i(l1)"]
    fluxes = []

    def __init__(self):
        r, l, c, self.w = 20, 1e-3, 1e-6, 2 * math.pi * 3e3
        root = cmath.sqrt((r / l) ** 2 - 4 / (l * c))
        self.rate = (-r / l + root) / 2, (-r / l - root) / 2
        self.i = 10 / (r + 1j * self.w * l + 1 / (1j * self.w * c))
        self.v = self.i / (1j * self.w * c)
        # What is left at t = 0 of 2 V and 10 mA belongs to the two free oscillations.
        dv, di = 2 - self.v.imag, 0.01 - self.i.imag
        second = (di / c - self.rate[0] * dv) / (self.rate[1] - self.rate[0])
        self.free = dv - second, second
        self.c, self.r = c, r

    def exact(self, t):
        turn = cmath.exp(1j * self.w * t)
        free = [a * cmath.exp(l * t) for a, l in zip(self.free, self.rate)]
        v = (self.v * turn).imag + sum(free).real
        i = (self.i * turn).imag + self.c * sum(l * a for a, l in zip(free, self.rate)).real
        return {"v(b)": v, "i(l1)": i, "v(a)": 10 * math.sin(self.w * t) - self.r * i}

    def events(self):
        return []


class Index2:
    """A source across two capacitors in series: v1 + v2 = V(t) is a constraint between states, and
    the current of the source is of index 2."""

    NETLIST = """A sine across two capacitors
V1 in 0 SIN(0 10 8k)
C1 in a 1u
C2 a 0 2u
R1 a 0 100
.tran 1u 1m uic
.end
"""
    stop = 1e-3
    steps = {1: (800, 1600, 3200, 6400), 3: (24, 32, 40, 56, 80), 5: (12, 16, 20, 24, 30),
             7: (10, 12, 14, 16), 9: (7, 9, 10, 12, 14)}
    scale = {"v(a)": 5, "i(v1)": 0.4}
    ends = ["v(a)"]
    dense = ["v(a)"]
    fluxes = ["i(v1)"]

    def __init__(self):
        self.w, self.c1, c2, r = 2 * math.pi * 8e3, 1e-6, 2e-6, 100
        self.v = 1j * self.w * self.c1 * 10 / (1 / r + 1j * self.w * (self.c1 + c2))
        self.tau = r * (self.c1 + c2)

    def exact(self, t):
        turn, decay = self.v * cmath.exp(1j * self.w * t), self.v.imag * math.exp(-t / self.tau)
        rate = (1j * self.w * turn).imag + decay / self.tau
        return {"v(a)": turn.imag - decay,
                "i(v1)": -self.c1 * (10 * self.w * math.cos(self.w * t) - rate)}

    def events(self):
        return []


class Rectifier:
    """A half-wave rectifier with source resistance: exponentials and a sine between events."""

    NETLIST = """A half-wave rectifier with source resistance
V1 in 0 SIN(0 10 50)
R0 in a 50
D1 a out
C1 out 0 100u
R1 out 0 100
.tran 20u 60m uic
.end
"""
    stop = 60e-3
    steps = {1: (2000, 4000, 8000, 16000), 3: (120, 170, 240, 340, 480), 5: (40, 56, 80, 112, 160),
             7: (20, 26, 34, 44, 56), 9: (12, 14, 16, 18, 22)}
    scale = {"v(out)": 10}
    ends = []
    dense = ["v(out)"]
    fluxes = []

    def __init__(self):
        c, r0, r = 100e-6, 50, 100
        self.w = 2 * math.pi * 50
        on, self.tau = c / (1 / r0 + 1 / r), r * c
        forced = 10 / (r0 * c) / (1 / on + 1j * self.w)
        self.piece = []  # (start, value at time, state that begins there)
        t, v, state = 0.0, 0.0, "on"
        while t < self.stop:
            if state == "on":
                rest = v - (forced * cmath.exp(1j * self.w * t)).imag
                value = (lambda s, t=t, rest=rest: (forced * cmath.exp(1j * self.w * s)).imag
                         + rest * math.exp(-(s - t) / on))
            else:
                value = lambda s, t=t, v=v: v * math.exp(-(s - t) / self.tau)  # noqa: E731
            self.piece.append((t, value, state))
            gap = lambda s, value=value: 10 * math.sin(self.w * s) - value(s)  # noqa: E731
            # The source passes v(out) once before its peak of this period, and once after.
            period = math.floor(t / 20e-3 + 1e-9)
            if state == "on":
                t = bisect(gap, (period + 0.25) * 20e-3, (period + 0.5) * 20e-3)
            else:
                t = bisect(gap, (period + 1) * 20e-3, (period + 1.25) * 20e-3)
            v, state = value(t), "off" if state == "on" else "on"

    def exact(self, t):
        return {"v(out)": [value for start, value, _ in self.piece if start <= t][-1](t)}

    def events(self):
        return [(start, "d1", state) for start, _, state in self.piece[1:]]


class Relaxation:
    """A capacitor between two thresholds of a switch: a late event moves all that follows."""

    NETLIST = """A relaxation oscillator
V1 in 0 10
R1 in a 10k
C1 a 0 100n
S1 a d a 0 sm
R2 d 0 1k
.model sm SW(Ron=0 Vt=5 Vh=2)
.tran 10u 5m uic
.end
"""
    stop = 5e-3
    steps = {1: (4000, 8000, 16000, 32000), 3: (100, 140, 200, 280, 400),
             5: (50, 70, 100, 140, 200), 7: (32, 44, 60, 84, 120),
             9: (20, 28, 40, 56, 80)}
    scale = {"v(a)": 7}
    ends = []
    dense = ["v(a)"]
    fluxes = []

    def __init__(self):
        limit, tau = {"off": 10, "on": 10 / 11}, {"off": 1e-3, "on": 1e-3 / 11}
        self.piece = []
        t, v, state = 0.0, 0.0, "off"
        while t < self.stop:
            self.piece.append((t, lambda s, t=t, v=v, limit=limit[state], tau=tau[state]:
                               limit + (v - limit) * math.exp(-(s - t) / tau), state))
            threshold = {"off": 7, "on": 3}[state]
            t += tau[state] * math.log((v - limit[state]) / (threshold - limit[state]))
            v, state = threshold, "on" if state == "off" else "off"

    def exact(self, t):
        return {"v(a)": [value for start, value, _ in self.piece if start <= t][-1](t)}

    def events(self):
        return [(start, "s1", state) for start, _, state in self.piece[1:]]


CIRCUITS = {"index1": Index1, "index2": Index2, "rectifier": Rectifier, "relaxation": Relaxation}


def errors(checker, program, circuit, stages, count):
    """The largest errors of one run with `count` steps, over the scale, by what they measure."""
    step = circuit.stop / count
    sampled = range(0, count, max(1, count // SAMPLED))
    grid = [min((k + 1) * step, circuit.stop) for k in sampled]
    inner = [t for k in sampled for t in ((k + part) * step for part in BETWEEN)]
    times = sorted(set(grid + inner))
    result = run(program, circuit.NETLIST, step=step, at=times, method=circuit.method, stages=stages)
    label = f"{stages} stages, {count} steps"
    if not checker.check(result.status == 0 and len(result.rows) == len(times),
                         f"{label}: exit {result.status}, {len(result.rows)} rows: "
                         f"{result.stderr}"):
        raise SystemExit(checker.finish())
    exact, at_end = [circuit.exact(t) for t in times], set(grid)
    worst = {}

    def note(kind, signals, wanted):
        for signal in signals:
            error = max((abs(found - exact[k][signal]) for k, found in
                         enumerate(result.column(signal)) if wanted(times[k])), default=0.0)
            worst[kind] = max(worst.get(kind, 0.0), error / circuit.scale[signal])

    note("ends", circuit.ends, lambda t: t in at_end)
    note("dense", circuit.dense, lambda t: t not in at_end)
    note("fluxes", circuit.fluxes, lambda t: t in at_end)
    wanted = circuit.events()
    if wanted:
        found = [(e["time"], e["element"], e["state"]) for e in result.report["events"]
                 if e["time"] > 1e-9 * circuit.stop]
        if checker.check([e[1:] for e in found] == [e[1:] for e in wanted],
                         f"{label}: events {found}, not {wanted}"):
            worst["events"] = max(abs(a[0] - b[0]) for a, b in zip(found, wanted)) / circuit.stop
    return step, worst


def rung(checker, program, circuit, stages, count):
    """The step, and the largest errors of one run or of a few with almost that step."""
    near = range(count, count + (NEIGHBOURS if circuit.events() else 1))
    runs = [errors(checker, program, circuit, stages, each)[1] for each in near]
    return circuit.stop / count, {kind: max(run[kind] for run in runs if kind in run)
                                  for kind in runs[0]}


def fitted_slope(points):
    x, y = [math.log(h) for h, _ in points], [math.log(e) for _, e in points]
    x_mean, y_mean = sum(x) / len(x), sum(y) / len(y)
    return (sum((a - x_mean) * (b - y_mean) for a, b in zip(x, y))
            / sum((a - x_mean) ** 2 for a in x))


def main():
    program, name, method = sys.argv[1:]
    circuit, checker = CIRCUITS[name](), Checker(name)
    circuit.method = method
    for stages in STAGES[method]:
        if (name, method, stages) == ("relaxation", "lobatto", 9):
            continue  # events add up its rounding before its order shows
        ends, nodes = (2 * stages - 2, stages - 1) if method == "lobatto" else (2 * stages - 1, stages)
        order = {"ends": ends, "dense": min(nodes + 1, ends), "fluxes": nodes}
        order["events"] = order["dense"]
        ladder = [rung(checker, program, circuit, stages, count)
                  for count in sorted(round(f * n) for f in (FINER[name] if method == "lobatto" else (1,))
                                       for n in circuit.steps[stages])]
        for kind in ladder[0][1]:
            measured = [(step, worst.get(kind, 0.0)) for step, worst in ladder]
            points = [(step, error) for step, error in measured if SMALLEST <= error <= LARGEST[method]]
            print(f"{stages} stages, {kind}: " + " ".join(f"{error:.1e}" for _, error in measured))
            if not checker.check(len(points) >= 3, f"{stages} stages, {kind}: only {len(points)} "
                                 "errors are between rounding and nonsense"):
                continue
            slope = fitted_slope(points)
            print(f"{stages} stages, {kind}: slope {slope:.2f}, order {order[kind]}")
            checker.check(slope >= order[kind] - BELOW,
                          f"{stages} stages, {kind}: slope {slope:.2f}, not {order[kind]}")
            if kind == "ends" and name == "index1":
                checker.check(slope <= order[kind] + ABOVE,
                              f"{stages} stages, {kind}: slope {slope:.2f}, above {order[kind]}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
