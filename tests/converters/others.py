"""Converters of other kinds: a half-controlled bridge, a series machine with products, a constant power, a flyback whose core
saturates, a leg with dead time."""

import math

from cases import Case, card_pulse
from events import Circuit, Clock
from thyristors import Gates


class HalfControlled(Circuit):
    """Two thyristors above, two diodes below, a coil and a resistor. The mode: which thyristor carries (0, 1 from the source,
    2 from ground), and both gates. With one the load has the half wave of its sign, else 0 through a diode of its own leg."""

    def __init__(self, volts, hertz, coil, ohms, gates):
        self.volts, self.omega, self.coil, self.ohms, self.gates = volts, 2 * math.pi * hertz, coil, ohms, gates
        self.halves = Clock(0.5 / hertz, [0.0])
        self.step = min(1 / hertz / 24, coil / ohms)

    def source(self, t):
        return self.volts * math.sin(self.omega * t)

    def load(self, t, which):
        return max(self.source(t), 0.0) if which == 1 else max(-self.source(t), 0.0)

    def derivative(self, t, x, mode):
        return [(self.load(t, mode[0]) - self.ohms * x[0]) / self.coil if mode[0] else 0.0]

    def guards(self, t, x, mode):
        which, first, second = mode
        e = self.source(t)
        return [-x[0] if which else -1.0, e if first and which != 1 else -1.0, -e if second and which != 2 else -1.0]

    def ends(self, t, x, mode, which):
        return ((which,) + mode[1:], x) if which else ((0,) + mode[1:], [0.0])

    def next_edge(self, t, mode):
        return min(self.gates.clock.after(t), self.halves.after(t))

    def edge(self, t, x, mode):
        return (mode[0],) + self.gates.after(t, mode[1:]), x


def half_controlled(rows=None):
    for k, (volts, hertz, alpha, coil, ohms, width, periods) in enumerate(rows or [
            (325, 50, 60, 50e-3, 10, 30, 4), (325, 50, 120, 2e-3, 10, 20, 4), (12, 400, 30, 1e-3, 0.5, 100, 6), (9e3, 16.7, 150, 2, 50, 10, 3)]):
        period = 1 / hertz
        pulses = [(alpha / 360 * period, width / 360 * period), ((alpha + 180) / 360 * period, width / 360 * period)]
        text = f"v1 in 0 sin(0 {volts!r} {hertz!r})\n" + card_pulse("vg1", "g1 0", *pulses[0], period) + card_pulse("vg2", "g2 0", *pulses[1], period) + \
            f"a1 in p g1 0 sc\na2 0 p g2 0 sc\nd1 n in\nd2 n 0\nl1 p y {coil!r}\nr1 y n {ohms!r}\n.model sc thyristor\n"
        yield Case(f"half_controlled_{k}", text, HalfControlled(volts, hertz, coil, ohms, Gates(period, pulses)), [0.0], (0, False, False),
                   periods * period, {"i(l1)": lambda x: x[0]})


class SeriesMachine(Circuit):
    """A chopper at a series machine: m i w is its voltage, m i^2 its torque; a fan loads it with c w |w|. States: current, speed."""

    def __init__(self, volts, ohms, coil, m, inertia, fan, period, duty):
        self.volts, self.ohms, self.coil, self.m, self.inertia, self.fan = volts, ohms, coil, m, inertia, fan
        self.clock, self.step = Clock(period, [0.0, duty * period]), period / 4

    def derivative(self, t, x, mode):
        switch, carries = mode
        i, w = x
        rate = ((self.volts if switch else 0.0) - (self.ohms + self.m * w) * i) / self.coil
        return [rate if carries else 0.0, (self.m * i * i - self.fan * w * abs(w)) / self.inertia]

    def guards(self, t, x, mode):
        return [-x[0] if mode[1] and not mode[0] else -1.0]

    def ends(self, t, x, mode, which):
        return (mode[0], False), [0.0, x[1]]

    def next_edge(self, t, mode):
        return self.clock.after(t)

    def edge(self, t, x, mode):
        switch = 0 in self.clock.at(t)
        return (switch, switch or x[0] > 0.0), x


def series_machine(rows=None):
    for k, (volts, ohms, coil, m, inertia, fan, hertz, duty, periods) in enumerate(rows or [
            (48, 0.2, 1e-3, 5e-3, 1e-3, 1e-5, 5e3, 0.6, 300), (600, 0.5, 5e-3, 0.02, 0.5, 1e-4, 1e3, 0.4, 200), (12, 1, 2e-4, 1e-3, 1e-6, 1e-8, 2e4, 0.8, 400)]):
        period = 1 / hertz
        text = f"v1 in 0 {volts!r}\ns1 in a g 0 sm\nd1 0 a\n.model sm sw(vt=0.5)\nl1 a b {coil!r}\nr1 b c {ohms!r}\nb1 c 0 v={m!r}*i(l1)*v(w)\n" \
               f"c1 w 0 {inertia!r} ic=0\nb2 0 w i={m!r}*i(l1)*i(l1)\nb3 w 0 i={fan!r}*v(w)*abs(v(w))\n" + card_pulse("vg", "g 0", 0.0, duty * period, period)
        yield Case(f"series_machine_{k}", text, SeriesMachine(volts, ohms, coil, m, inertia, fan, period, duty), [0.0, 0.0], (True, True),
                   periods * period, {"i(l1)": lambda x: x[0], "v(w)": lambda x: x[1]})


class ConstantPower(Circuit):
    """A chopper with a filter at a load that takes a constant power above a voltage, a constant resistance below. The mode: switch,
    whether the coil carries, whether the load is above. States: coil, capacitor."""

    def __init__(self, volts, coil, store, watts, least, period, duty):
        self.volts, self.coil, self.store, self.watts, self.least = volts, coil, store, watts, least
        self.clock, self.step = Clock(period, [0.0, duty * period]), period / 8

    def derivative(self, t, x, mode):
        switch, carries, above = mode
        load = self.watts / x[1] if above else self.watts * x[1] / self.least ** 2
        return [((self.volts if switch else 0.0) - x[1]) / self.coil if carries else 0.0, (x[0] - load) / self.store]

    def guards(self, t, x, mode):
        switch, carries, above = mode
        return [-x[0] if carries and not (switch and self.volts > x[1]) else -1.0, self.least - x[1] if above else x[1] - self.least,
                self.volts - x[1] if switch and not carries else -1.0]

    def ends(self, t, x, mode, which):
        switch, carries, above = mode
        if which == 1:
            return (switch, carries, not above), x
        return (switch, which == 2, above), [0.0, x[1]]

    def next_edge(self, t, mode):
        return self.clock.after(t)

    def edge(self, t, x, mode):
        switch = 0 in self.clock.at(t)
        return (switch, x[0] > 0.0 or (switch and self.volts > x[1]), mode[2]), x


def constant_power(rows=None):
    for k, (volts, coil, store, watts, least, hertz, duty, periods) in enumerate(rows or [
            (48, 20e-6, 220e-6, 100, 8, 1e5, 0.5, 120), (400, 1e-3, 47e-6, 500, 100, 2e4, 0.6, 80), (5, 1e-6, 10e-6, 2, 1, 1e6, 0.4, 100)]):
        period = 1 / hertz
        text = f"v1 in 0 {volts!r}\ns1 in k g 0 sm\nd1 0 a\nd2 k a\n.model sm sw(vt=0.5)\nl1 a out {coil!r}\nc1 out 0 {store!r} ic=0\n" \
               f"b1 out 0 i=if(v(out) > {least!r}, {watts!r}/v(out), {watts / least ** 2!r}*v(out))\n" + card_pulse("vg", "g 0", 0.0, duty * period, period)
        yield Case(f"constant_power_{k}", text, ConstantPower(volts, coil, store, watts, least, period, duty), [0.0, 0.0], (True, True, False),
                   periods * period, {"i(l1)": lambda x: x[0], "v(out)": lambda x: x[1]})


class SaturatingFlyback(Circuit):
    """States: flux, capacitor. The mode: switch, whether the second winding carries, the line of the core. The supply is behind a
    resistor; the second winding has n turns for one of the first."""

    def __init__(self, volts, source, n, knee, slopes, store, ohms, period, duty):
        self.volts, self.source, self.n, self.knee, self.slopes, self.store, self.ohms = volts, source, n, knee, slopes, store, ohms
        self.clock, self.step = Clock(period, [0.0, duty * period]), period / 8

    def current(self, flux):
        return self.knee / self.slopes[0] + (flux - self.knee) / self.slopes[1] if flux > self.knee else flux / self.slopes[0]

    def line(self, flux, saturated):
        return self.knee / self.slopes[0] + (flux - self.knee) / self.slopes[1] if saturated else flux / self.slopes[0]

    def derivative(self, t, x, mode):
        switch, carries, saturated = mode
        i = self.line(x[0], saturated)
        flux = self.volts - self.source * i if switch else -x[1] / self.n if carries else 0.0
        return [flux, ((i / self.n if carries else 0.0) - x[1] / self.ohms) / self.store]

    def guards(self, t, x, mode):
        switch, carries, saturated = mode
        return [-x[0] if carries else -1.0, self.knee - x[0] if saturated else x[0] - self.knee]

    def ends(self, t, x, mode, which):
        switch, carries, saturated = mode
        return ((switch, carries, not saturated), x) if which else ((switch, False, saturated), [0.0, x[1]])

    def next_edge(self, t, mode):
        return self.clock.after(t)

    def edge(self, t, x, mode):
        switch = 0 in self.clock.at(t)
        return (switch, not switch and x[0] > 0.0, mode[2]), x


def saturating_flyback(rows=None):
    for k, (volts, hertz, n, duty, ohms, over, periods) in enumerate(rows or [
            (12, 1e5, 2, 0.4, 50, 0.8, 60), (325, 6.5e4, 0.05, 0.3, 2, 0.6, 50), (48, 2e4, 1, 0.5, 20, 0.9, 60), (5, 1e6, 10, 0.6, 2e3, 1.2, 80)]):
        period = 1 / hertz
        knee = over * volts * duty * period
        out = volts * n * duty / (1 - duty)
        peak = out * out / ohms / volts / duty
        slopes = (knee / peak, knee / peak / 30)
        i = peak
        core = f"pwl(x, {-9 * i!r},{-knee - 8 * i * slopes[1]!r}, {-i!r},{-knee!r}, {i!r},{knee!r}, {9 * i!r},{knee + 8 * i * slopes[1]!r})"
        source, store = 0.02 * volts / peak, 10 * period / ohms
        text = f"vin in0 0 {volts!r}\nrin in0 in {source!r}\na1 in sw 0 s windings\n.model windings transformer(turns=[1 {n!r}])\nlc in sw Flux={core}\n" \
               f"s1 sw 0 g 0 sm\n.model sm sw(vt=0.5)\nd1 s out\nc1 out 0 {store!r} ic={0.5 * out!r}\nr1 out 0 {ohms!r}\n" + card_pulse("vg", "g 0", 0.0, duty * period, period)
        circuit = SaturatingFlyback(volts, source, n, knee, slopes, store, ohms, period, duty)
        yield Case(f"saturating_flyback_{k}", text, circuit, [0.0, 0.5 * out], (True, False, False), periods * period,
                   {"v(out)": lambda x: x[1], "i(lc)": lambda x, c=circuit: c.current(x[0])})


class DeadTime(Circuit):
    """A leg of two switches with diodes and dead time at a coil, a resistor and the middle of its supply. The mode: the command (1, 0, -1) and the sign
    of the current, by which a diode carries while there is none."""

    def __init__(self, volts, ohms, coil, period, duty, dead):
        self.volts, self.ohms, self.coil = volts, ohms, coil
        self.clock, self.step = Clock(period, [0.0, duty * period, duty * period + dead, period - dead]), period / 8

    def derivative(self, t, x, mode):
        command, sign = mode
        v = self.volts * (command or -sign)
        return [(v - self.ohms * x[0]) / self.coil if command or sign else 0.0]

    def guards(self, t, x, mode):
        command, sign = mode
        return [-sign * x[0]] if sign and not command else [-1.0]

    def ends(self, t, x, mode, which):
        return (mode[0], 0), [0.0]

    def next_edge(self, t, mode):
        return self.clock.after(t)

    def edge(self, t, x, mode):
        places = self.clock.at(t)
        command = 1 if 0 in places else -1 if 2 in places else 0
        return (command, (x[0] > 0) - (x[0] < 0)), x


def dead_time(rows=None):
    for k, (volts, ohms, coil, hertz, duty, dead, periods) in enumerate(rows or [
            (200, 10, 100e-6, 1e5, 0.45, 0.04, 30), (12, 0.5, 2e-6, 1e6, 0.6, 0.05, 40), (400, 50, 1e-4, 2e4, 0.3, 0.1, 20)]):
        period = 1 / hertz
        text = f"vp p 0 {volts!r}\nvn n 0 {-volts!r}\ns1 p x g1 x sm\nd1 x p\ns2 x n g2 n sm\nd2 n x\n.model sm sw(vt=5)\nl1 x y {coil!r} ic=0\nr1 y 0 {ohms!r}\n" \
            + card_pulse("vg1", "g1 x", 0.0, duty * period, period, 0, 10) \
            + card_pulse("vg2", "g2 n", (duty + dead) * period, (1 - duty - 2 * dead) * period, period, 0, 10)
        yield Case(f"dead_time_{k}", text, DeadTime(volts, ohms, coil, period, duty, dead * period), [0.0], (1, 0), periods * period, {"i(l1)": lambda x: x[0]})
