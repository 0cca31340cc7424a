"""Circuits between whose events an ordinary differential equation holds, from event to event: the independent answer.

A Circuit is written by hand for each converter, from its equations. What is here knows nothing of netlists, elements or
complementarity: it extrapolates the modified midpoint rule of Gragg and Bulirsch (Hairer, Norsett and Wanner I,
II.9) with seven columns, which has order 14, and finds the zeros of guards by steps of it that end there.
"""

import math

COLUMNS = 7
NEAR = 1e-13
WEIGHTS = [[1.0 / (((k + 1.0) / (k + 1.0 - j)) ** 2 - 1.0) for j in range(1, k + 1)] for k in range(COLUMNS)]


class Circuit:
    """What a converter says about itself. States are a list x, a mode is whatever its functions make of it."""

    step = None  # seconds, the largest step
    scales = None  # what each state is to be right against, besides its own largest value

    def derivative(self, t, x, mode):
        raise NotImplementedError

    def guards(self, t, x, mode):
        """Quantities that are not above 0 in a mode; one that rises above ends it."""
        return []

    def ends(self, t, x, mode, which):
        """(mode, x) behind the end of a mode by guard `which`."""
        raise NotImplementedError

    def next_edge(self, t, mode):
        """The first time after t at which a clock changes something or the right side is not smooth."""
        return math.inf

    def edge(self, t, x, mode):
        """(mode, x) behind that."""
        return mode, x


def midpoint(f, t, x, h, n, first):
    """Of n steps of the modified midpoint rule."""
    s = h / n
    before, now = x, [a + s * d for a, d in zip(x, first)]
    for k in range(1, n):
        rate = f(t + k * s, now)
        before, now = now, [a + 2 * s * d for a, d in zip(before, rate)]
    rate = f(t + h, now)
    return [0.5 * (a + b + s * d) for a, b, d in zip(before, now, rate)]


def advance(circuit, t, x, mode, h):
    """(x after h in one mode, the same of an order less)"""
    def f(time, state):
        return circuit.derivative(time, state, mode)
    first = f(t, x)
    row = []
    for k in range(COLUMNS):
        new = [midpoint(f, t, x, h, 2 * (k + 1), first)]
        for j in range(k):
            weight = WEIGHTS[k][j]
            new.append([a + (a - b) * weight for a, b in zip(new[j], row[j])])
        row = new
    return row[-1], row[-2]


def zero_of(value, width, at_low, at_high):
    """Just behind where value passes 0 between 0 and width, by the method of Illinois; at_low <= 0 < at_high. What it
    finds is above 0, so that a mode does not end twice; aiming a little too far brings it there."""
    low, high, side = 0.0, width, 0
    if at_low >= 0.0:  # it begins on 0: does it go below first?
        low = next((width * 0.5 ** k for k in range(1, 20) if value(width * 0.5 ** k) < 0.0), 0.0)
        if low == 0.0:
            return 0.0
        at_low = value(low)
    weights = [at_low, at_high]
    least = 1e-15 * (at_high - at_low)
    for _ in range(100):
        middle = high - weights[1] * (high - low) / (weights[1] - weights[0]) + 2e-16 * width
        if not low < middle < high:
            break
        found = value(middle)
        above = found > 0.0
        if above:
            high, weights[1] = middle, found
        else:
            low, weights[0] = middle, found
        if above and found <= least:
            break
        if side == (1 if above else -1):
            weights[0 if above else 1] *= 0.5
        side = 1 if above else -1
    return high


class Run:
    """Where a circuit is; `events` counts the ends of modes, `largest` has the largest value of each state."""

    def __init__(self, circuit, x, mode):
        self.circuit, self.t, self.x, self.mode, self.events = circuit, 0.0, list(x), mode, 0
        self.largest = [abs(v) for v in circuit.scales or x]
        self.settle()

    def settle(self):
        """Modes that end at once, one after the other."""
        for _ in range(50):
            above = [k for k, g in enumerate(self.circuit.guards(self.t, self.x, self.mode)) if g > 0.0]
            if not above:
                return
            self.change(above[0])
        raise RuntimeError(f"modes go on changing at {self.t!r} s: {self.mode}")

    def change(self, which):
        self.mode, self.x = self.circuit.ends(self.t, self.x, self.mode, which)
        self.x = list(self.x)
        self.events += 1

    def piece(self, h):
        """(x after a step, the step): h, or a half, a quarter of it that is right to NEAR of each state."""
        while True:
            there, other = advance(self.circuit, self.t, self.x, self.mode, h)
            self.largest = [max(a, abs(b)) for a, b in zip(self.largest, there)]
            if all(abs(a - b) <= NEAR * size for a, b, size in zip(there, other, self.largest)):
                return there, h
            h *= 0.5

    def above(self, there, h, before, after, value):
        """(guard, where it is above 0): at the end, or only at a peak between, which a parabola shows. Its third point is
        of the cubic through both ends, which is near enough to look for a peak."""
        middle = None
        for k, (first, last) in enumerate(zip(before, after)):
            if last > 0.0:
                yield k, h
            elif first != last:
                middle = middle or self.middle(there, h)
                m, slope, bend = middle[k], last - first, first - 2 * middle[k] + last
                if abs(slope) < -2 * bend and m - slope * slope / (8 * bend) > 0.25 * bend:
                    peak = max((0.5 * h, h * (0.5 - 0.25 * slope / bend)), key=lambda s, k=k: value(s)[k])
                    if value(peak)[k] > 0.0:
                        yield k, peak

    def middle(self, there, h):
        circuit, t, x, mode = self.circuit, self.t, self.x, self.mode
        rates = zip(circuit.derivative(t, x, mode), circuit.derivative(t + h, there, mode))
        half = [0.5 * (a + b) + 0.125 * h * (f - g) for a, b, (f, g) in zip(x, there, rates)]
        return circuit.guards(t + 0.5 * h, half, mode)

    def step(self, end):
        """To `end`, or to the first guard before it."""
        circuit, t, x, mode = self.circuit, self.t, self.x, self.mode
        there, h = self.piece(end - t)
        end = end if h == end - t else t + h
        before, after = circuit.guards(t, x, mode), circuit.guards(end, there, mode)

        def value(s):
            return circuit.guards(t + s, advance(circuit, t, x, mode, s)[0], mode)
        best, which = math.inf, None
        for k, s in self.above(there, h, before, after, value):
            s = zero_of(lambda at, k=k: value(at)[k], s, before[k], after[k] if s == h else value(s)[k])
            if s < best:
                best, which = s, k
        if which is None:
            self.t, self.x = end, there
            return
        self.t, self.x = t + best, advance(circuit, t, x, mode, best)[0] if best > 0.0 else x
        self.change(which)
        self.settle()

    def pass_edge(self):
        self.mode, self.x = self.circuit.edge(self.t, self.x, self.mode)
        self.x = list(self.x)
        self.settle()

    def to(self, stop):
        while self.t < stop:
            edge = self.circuit.next_edge(self.t, self.mode)
            end = min(edge, stop)
            if end - self.t > self.circuit.step:
                pieces = math.ceil((end - self.t) / self.circuit.step)
                self.step(self.t + (end - self.t) / pieces)
            else:
                self.step(end)
            if self.t == edge:
                self.pass_edge()
        return self.x


def values(circuit, x, mode, times):
    """(the states at the times, how many modes have ended)"""
    run = Run(circuit, x, mode)
    return [list(run.to(t)) for t in times], run.events


class Clock:
    """Edges at offset + k period, k = 0, 1, ...: a number that k multiplies, no sum of periods."""

    def __init__(self, period, offsets):
        self.period, self.offsets = period, list(offsets)

    def after(self, t):
        """The first edge after t by more than rounding."""
        best = math.inf
        for offset in self.offsets:
            k = max(0, math.floor((t - offset) / self.period + 1e-9) + 1)
            best = min(best, offset + k * self.period)
        return best

    def at(self, t):
        """The places of the offsets with an edge at t."""
        turns = [(t - offset) / self.period for offset in self.offsets]
        return [n for n, turn in enumerate(turns) if turn > -1e-9 and abs(turn - round(turn)) < 1e-9]
