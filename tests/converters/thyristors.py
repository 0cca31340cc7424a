"""Converters with thyristors, triacs and GTOs: their netlists and, by hand, their equations."""

import math

from cases import Case, card_pulse
from events import Circuit, Clock


class Gates:
    """Pulses (delay, width) of one period, one for each valve."""

    def __init__(self, period, pulses):
        self.pulses = pulses
        self.clock = Clock(period, [d for d, _ in pulses] + [d + w for d, w in pulses])

    def start(self):
        return tuple(d == 0.0 for d, _ in self.pulses)

    def after(self, t, gates):
        """The gates behind an edge at t: what ends there first, for another may begin there."""
        gates, n = list(gates), len(self.pulses)
        for place in sorted(self.clock.at(t), reverse=True):
            gates[place % n] = place < n
        return tuple(gates)


# ---- Six-pulse bridge with line inductance ---------------------------------------------------------------

class SixPulse(Circuit):
    """Currents of the three upper and the three lower thyristors. Where n conduct above and m below, with the sums s
    and r of their sources,  n p = s - Ls d,  m q = r + Ls d,  p - q = Ld d + R i + E,  d the derivative of i."""

    def __init__(self, volts, hertz, line, coil, ohms, battery, gates):
        self.volts, self.omega, self.line, self.coil, self.ohms, self.battery = \
            volts, 2 * math.pi * hertz, line, coil, ohms, battery
        self.gates, self.step = gates, 1 / hertz / 24

    def sources(self, t):
        return [self.volts * math.sin(self.omega * t - 2 * math.pi * k / 3) for k in range(3)]

    def rails(self, t, x, mode):
        """(sources, p, q, d)"""
        upper, lower, _ = mode
        e = self.sources(t)
        n, m = len(upper), len(lower)
        s, r = sum(e[k] for k in upper), sum(e[k] for k in lower)
        current = sum(x[:3])
        d = (s / n - r / m - self.ohms * current - self.battery) / (self.coil + self.line * (1 / n + 1 / m))
        return e, (s - self.line * d) / n, (r + self.line * d) / m, d

    def derivative(self, t, x, mode):
        rates = [0.0] * 6
        if mode[0]:
            e, p, q, _ = self.rails(t, x, mode)
            for k in mode[0]:
                rates[k] = (e[k] - p) / self.line
            for k in mode[1]:
                rates[3 + k] = (q - e[k]) / self.line
        return rates

    def named(self, t, x, mode):
        upper, lower, gates = mode
        if not upper:
            e = self.sources(t)
            return [(("pair", k, l), e[k] - e[l] - self.battery) for k in range(3) for l in range(3)
                    if k != l and gates[k] and gates[3 + l]]
        e, p, q, _ = self.rails(t, x, mode)
        found = [(("off", k), -x[k]) for k in upper] + [(("off", 3 + k), -x[3 + k]) for k in lower]
        found += [(("on", k), (q if k in lower else e[k]) - p) for k in range(3) if k not in upper and gates[k]]
        return found + [(("on", 3 + k), q - (p if k in upper else e[k])) for k in range(3)
                        if k not in lower and gates[3 + k]]

    def guards(self, t, x, mode):
        return [value for _, value in self.named(t, x, mode)]

    def ends(self, t, x, mode, which):
        (why, *valves), _ = self.named(t, x, mode)[which]
        upper, lower, gates = set(mode[0]), set(mode[1]), mode[2]
        x = list(x)
        if why == "pair":
            upper, lower = {valves[0]}, {valves[1]}
        elif why == "on":
            (upper if valves[0] < 3 else lower).add(valves[0] % 3)
        else:
            (upper if valves[0] < 3 else lower).discard(valves[0] % 3)
            x[valves[0]] = 0.0
            if not upper or not lower:
                upper, lower, x = set(), set(), [0.0] * 6
        return (frozenset(upper), frozenset(lower), gates), x

    def next_edge(self, t, mode):
        return self.gates.clock.after(t)

    def edge(self, t, x, mode):
        return (mode[0], mode[1], self.gates.after(t, mode[2])), x


def six_pulse(rows=None):
    for k, (volts, hertz, alpha, line, coil, ohms, battery, width, periods) in enumerate(rows or [
            (325, 50, 30, 2e-3, 20e-3, 5, 0, 100, 3), (8e3, 60, 15, 1e-3, 30e-3, 20, 0, 110, 3),
            (170, 400, 70, 5e-6, 100e-6, 0.5, 20, 100, 4), (325, 50, 120, 1e-3, 50e-3, 1, -450, 90, 5),
            (325, 50, 60, 1e-3, 2e-3, 10, 120, 100, 3), (48, 1e3, 45, 10e-6, 1e-3, 3, 0, 61, 6)]):
        period = 1 / hertz
        pulses = [((30 + alpha + 120 * n) % 360 / 360 * period, width / 360 * period) for n in range(3)]
        pulses += [((210 + alpha + 120 * n) % 360 / 360 * period, width / 360 * period) for n in range(3)]
        text = "".join(f"v{n} e{n} 0 sin(0 {volts!r} {hertz!r} 0 0 {-120 * n})\nl{n} e{n} {p} {line!r}\n"
                       f"a{n} {p} p g{n} 0 th\na{n + 3} q {p} g{n + 3} 0 th\n" for n, p in enumerate("abc"))
        text += "".join(card_pulse(f"vg{n}", f"g{n} 0", d, w, period) for n, (d, w) in enumerate(pulses))
        text += f"ld p o {coil!r}\nrd o w {ohms!r}\nvd w q {battery!r}\n.model th thyristor\n"
        gates = Gates(period, pulses)
        yield Case(f"six_pulse_{k}", text, SixPulse(volts, hertz, line, coil, ohms, battery, gates), [0.0] * 6,
                   (frozenset(), frozenset(), gates.start()), periods * period,
                   {f"i(l{n})": (lambda x, n=n: x[n] - x[3 + n]) for n in range(3)} |
                   {"i(ld)": lambda x: sum(x[:3])} | {f"i(a{n})": (lambda x, n=n: x[n]) for n in range(6)}, 1e-9)


# ---- Single-phase AC controller --------------------------------------------------------------------------

class AcController(Circuit):
    """A triac in series with a coil and a resistor; the mode is the sign of the current, 0 without, and the gate."""

    def __init__(self, volts, hertz, coil, ohms, gates):
        self.volts, self.omega, self.coil, self.ohms, self.gates = volts, 2 * math.pi * hertz, coil, ohms, gates
        self.step = min(1 / hertz / 24, coil / ohms)

    def derivative(self, t, x, mode):
        return [(self.volts * math.sin(self.omega * t) - self.ohms * x[0]) / self.coil if mode[0] else 0.0]

    def guards(self, t, x, mode):
        sign, gate = mode
        e = self.volts * math.sin(self.omega * t)
        return [-sign * x[0]] if sign else [e, -e] if gate[0] else []

    def ends(self, t, x, mode, which):
        sign, gate = mode
        if not sign:
            return (-1 if which else 1, gate), x
        return (-sign if gate[0] else 0, gate), [0.0]

    def next_edge(self, t, mode):
        return self.gates.clock.after(t)

    def edge(self, t, x, mode):
        return (mode[0], self.gates.after(t, mode[1])), x


def ac_controller(rows=None):
    for k, (volts, hertz, alpha, coil, ohms, width, periods) in enumerate(rows or [
            (325, 50, 90, 20e-3, 10, 20, 4), (325, 50, 130, 0.1, 5, 10, 4), (10, 1e3, 75, 1e-4, 1, 30, 5),
            (8e3, 16.7, 100, 0.3, 10, 5, 3), (325, 60, 45, 50e-3, 10, 100, 6), (170, 60, 150, 1e-3, 100, 3, 3)]):
        period = 1 / hertz
        pulses = [(alpha / 360 * period, width / 360 * period)]
        text = f"v1 in 0 sin(0 {volts!r} {hertz!r})\n" + card_pulse("vg", "g 0", *pulses[0], period / 2) + \
            f"a1 in x g 0 tr\nl1 x y {coil!r}\nr1 y 0 {ohms!r}\n.model tr triac\n"
        gates = Gates(period / 2, pulses)
        yield Case(f"ac_controller_{k}", text, AcController(volts, hertz, coil, ohms, gates), [0.0],
                   (0, gates.start()), periods * period, {"i(l1)": lambda x: x[0], "i(a1)": lambda x: x[0]})


# ---- GTO inverter ----------------------------------------------------------------------------------------

class GtoInverter(Circuit):
    """Two legs of GTOs with diodes across them, at a coil, a capacitor and a resistor in series. A leg's output is the
    rail whose GTO has its gate, else that whose diode takes the current, which may come to an end: mode (sign of the
    current or 0, gates)."""

    def __init__(self, volts, hertz, coil, store, ohms, gates):
        self.volts, self.coil, self.store, self.ohms, self.gates = volts, coil, store, ohms, gates
        self.step = 1 / hertz / 24

    def bridge(self, mode, sign):
        """The voltage of the bridge with a current of this sign out of the first leg."""
        gates = mode[1]
        first = 1 if gates[0] else 0 if gates[1] else sign < 0
        second = 1 if gates[2] else 0 if gates[3] else sign > 0
        return self.volts * (first - second)

    def derivative(self, t, x, mode):
        if not mode[0]:
            return [0.0, 0.0]
        return [(self.bridge(mode, mode[0]) - x[1] - self.ohms * x[0]) / self.coil, x[0] / self.store]

    def guards(self, t, x, mode):
        if mode[0]:
            return [-mode[0] * x[0]]
        return [self.bridge(mode, 1) - x[1], x[1] - self.bridge(mode, -1)]

    def ends(self, t, x, mode, which):
        if not mode[0]:
            return (-1 if which else 1, mode[1]), x
        sign = -mode[0]
        on = sign * (self.bridge(mode, sign) - x[1]) > 0
        return (sign if on else 0, mode[1]), [0.0, x[1]]

    def next_edge(self, t, mode):
        return self.gates.clock.after(t)

    def edge(self, t, x, mode):
        return (mode[0], self.gates.after(t, mode[1])), x


def gto_inverter(rows=None):
    for k, (volts, hertz, shift, dead, coil, store, ohms, periods) in enumerate(rows or [
            (600, 50, 120, 2, 10e-3, 1, 5, 4), (600, 50, 180, 5, 30e-3, 400e-6, 2, 5),
            (1500, 400, 90, 10, 1e-3, 100e-6, 10, 5), (24, 2e3, 150, 1, 100e-6, 1, 4, 6),
            (3e3, 150, 60, 4, 5e-3, 300e-6, 1, 6)]):
        period = 1 / hertz
        half, gap, lag = period / 2, dead / 360 * period, shift / 360 * period
        pulses = [(gap, half - gap), (half + gap, half - gap),
                  ((gap + lag) % period, half - gap), ((half + gap + lag) % period, half - gap)]
        text = f"vd d 0 {volts!r}\n"
        for n, (delay, width) in enumerate(pulses):
            high, low = (("d", "ab"[n // 2]), ("ab"[n // 2], "0"))[n % 2]
            text += f"a{n} {high} {low} g{n} 0 gt\nd{n} {low} {high}\n"
            text += card_pulse(f"vg{n}", f"g{n} 0", delay, width, period, -1, 1)
        text += f"l1 a x {coil!r}\nc1 x y {store!r} ic=0\nr1 y b {ohms!r}\n.model gt gto\n"
        gates = Gates(period, pulses)
        yield Case(f"gto_inverter_{k}", text, GtoInverter(volts, hertz, coil, store, ohms, gates), [0.0, 0.0],
                   (0, gates.start()), periods * period,
                   {"i(l1)": lambda x: x[0]} | ({"v(x,y)": lambda x: x[1]} if store < 1 else {}))
