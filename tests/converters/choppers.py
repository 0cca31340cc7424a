"""Choppers with their control: their netlists and, by hand, their equations."""

import math

from cases import Case, card_pulse
from control import PI
from events import Circuit, Clock


# ---- Buck converter in peak current mode -----------------------------------------------------------------

class PeakCurrentBuck(Circuit):
    """States: coil, capacitor. Mode: latch, clock, whether the coil carries. The clock sets the latch, and a current that
    has risen to `peak` less a ramp resets it; the ramp begins anew with the clock."""

    def __init__(self, volts, coil, store, ohms, period, peak, ramp):
        self.volts, self.coil, self.store, self.ohms = volts, coil, store, ohms
        self.period, self.peak, self.ramp, self.step = period, peak, ramp, period / 6
        self.clock, self.begun = Clock(period, [0.0, period / 50]), 0.0

    def derivative(self, t, x, mode):
        latch, _, carries = mode
        return [((self.volts if latch else 0.0) - x[1]) / self.coil if carries else 0.0,
                (x[0] - x[1] / self.ohms) / self.store]

    def guards(self, t, x, mode):
        latch, _, carries = mode
        if latch:
            return [x[0] - self.peak + self.ramp * (t - self.begun) / self.period]
        return [-x[0]] if carries else []

    def ends(self, t, x, mode, which):
        latch, clock, carries = mode
        if latch:
            assert not clock, "it would be set again"
            return (False, clock, carries), x
        return (False, clock, False), [0.0, x[1]]

    def next_edge(self, t, mode):
        return self.clock.after(t)

    def edge(self, t, x, mode):
        if 0 in self.clock.at(t):
            self.begun = t
            return (True, True, True), x
        return (mode[0], False, mode[2]), x


def peak_current(rows=None):
    """Duty cycles below and above a half, with ramps and without. In the fourth each deviation of the current has the
    other sign after a period and is larger by a twelfth: the subharmonic of the clock grows from a start beside it."""
    for k, (volts, hertz, duty, ripple, ohms, ramp, periods) in enumerate(rows or [
            (12, 1e5, 0.3, 0.3, 2, 0, 60), (48, 5e4, 0.6, 0.2, 1.5, 0.15, 60), (400, 2e4, 0.45, 0.4, 50, 0, 60),
            (12, 2e5, 0.52, 0.3, 3, 0, 50), (5, 1e6, 0.35, 3, 10, 0, 60), (24, 1e3, 0.7, 0.5, 8, 0.4, 60)]):
        period = 1 / hertz
        out = duty * volts
        load = out / ohms
        coil = out * (1 - duty) * period / (ripple * load)
        store, peak = 30 * period / ohms, load * (1 + ripple / 2 + ramp * duty)
        start, valley = (out, load * (1 - ripple / 2 * 0.99)) if k == 3 and not rows else (0.9 * out, 0.0)
        text = f"vin in 0 {volts!r}\ns1 in sw q 0 sm\nd1 0 sw\nvs sw x 0\nl1 x out {coil!r} ic={valley!r}\n" \
               f"c1 out 0 {store!r} ic={start!r}\nr1 out 0 {ohms!r}\n.model sm sw(vt=0.5)\n"
        text += card_pulse("vclk", "clk 0", 0.0, period / 50, period)
        text += f"vramp ramp 0 pulse({peak!r} {peak - ramp * load!r} 0 {period!r} 0 0 {period!r})\n"
        text += "hs sense 0 vs 1\na1 sense ramp 0 0 0 0 r 0 SCHMITT\na2 clk r 0 0 0 0 q 0 SRFLOP\n"
        yield Case(f"peak_current_{k}", text, PeakCurrentBuck(volts, coil, store, ohms, period, peak, ramp * load),
                   [valley, start], (True, True, True), periods * period,
                   {"i(l1)": lambda x: x[0], "v(out)": lambda x: x[1]})


# ---- Boost converter that corrects the power factor ------------------------------------------------------

class PowerFactorBoost(Circuit):
    """States: coil, capacitor, integrals of the voltage's and of the current's controller. Mode: switch, whether the coil
    carries, the two integrators' limits. The current wanted is a product: output of the voltage's controller times the
    rectified voltage."""

    def __init__(self, volts, hertz, coil, store, ohms, period, wanted, gain, outer, inner):
        self.volts, self.omega, self.coil, self.store, self.ohms = volts, 2 * math.pi * hertz, coil, store, ohms
        self.period, self.wanted, self.gain, self.outer, self.inner = period, wanted, gain, outer, inner
        self.step, self.begun = period / 6, 0.0
        self.clock, self.zeros = Clock(period, [0.0]), Clock(0.5 / hertz, [0.0])

    def errors(self, t, x):
        e = self.wanted - x[1]
        return e, self.gain * self.outer.output(e, x[2]) * self.rectified(t) - x[0]

    def rectified(self, t):
        return abs(self.volts * math.sin(self.omega * t))

    def derivative(self, t, x, mode):
        switch, carries, held_v, held_i = mode
        e, d = self.errors(t, x)
        v = self.rectified(t)
        coil = v / self.coil if switch else (v - x[1]) / self.coil if carries else 0.0
        given = x[0] if carries and not switch else 0.0
        return [coil, (given - x[1] / self.ohms) / self.store, self.outer.rate(e, held_v), self.inner.rate(d, held_i)]

    def guards(self, t, x, mode):
        switch, carries, held_v, held_i = mode
        e, d = self.errors(t, x)
        duty, ramp = self.inner.output(d, x[3]), (t - self.begun) / self.period
        own = [ramp - duty, -1.0, -1.0] if switch else \
            [duty - ramp, -x[0] if carries else -1.0, -1.0 if carries else self.rectified(t) - x[1]]
        return own + self.outer.guards(e, x[2], held_v) + self.inner.guards(d, x[3], held_i)

    def ends(self, t, x, mode, which):
        switch, carries, held_v, held_i = mode
        if which == 0:
            return (not switch, carries or not switch, held_v, held_i), x
        if which < 3:
            return (switch, not carries, held_v, held_i), [0.0] + x[1:]
        if which < 5:
            held_v, x = self.outer.ends(x, 2, held_v, which - 3)
        else:
            held_i, x = self.inner.ends(x, 3, held_i, which - 5)
        return (switch, carries, held_v, held_i), x

    def next_edge(self, t, mode):
        return min(self.clock.after(t), self.zeros.after(t))

    def edge(self, t, x, mode):
        if self.clock.at(t):
            self.begun = t
        return mode, x


def power_factor(rows=None):
    for k, (volts, hertz, wanted, power, switching, half_waves) in enumerate(rows or [
            (325, 50, 400, 500, 20e3, 2), (170, 60, 380, 250, 30e3, 1.7), (20, 400, 36, 40, 50e3, 4),
            (600, 16.7, 900, 3e3, 4e3, 1.5)]):
        period, ohms = 1 / switching, wanted ** 2 / power
        peak = 2 * power / volts
        coil, store = volts * period / (1.0 * peak), 1.0 * power / (hertz * wanted ** 2)
        outer = PI(0.2 / wanted * 4, hertz / wanted * 2, 0.0, 2.0, 0.9)
        inner = PI(coil * switching / 4 / wanted, coil * switching ** 2 / 30 / wanted, 0.0, 0.96, 0.5)
        gain = peak / volts
        start = 0.95 * wanted
        text = f"v1 a b sin(0 {volts!r} {hertz!r})\nd1 a r\nd2 b r\nd3 0 a\nd4 0 b\nrd r 0 {ohms * 1e3!r}\n" \
               f"l1 r sw {coil!r}\ns1 sw 0 duty saw sm\nd5 sw out\nc1 out 0 {store!r} ic={start!r}\nr1 out 0 {ohms!r}\n" \
               f".model sm sw\nvsaw saw 0 pulse(0 1 0 {period!r} 0 0 {period!r})\n" \
               f"be err 0 V={wanted!r}-v(out)\n{outer.card('v', 'err vc')}" \
               f"bi ierr 0 V={gain!r}*v(vc)*v(r)-i(l1)\n{inner.card('i', 'ierr duty')}.lib control.lib\n"
        yield Case(f"power_factor_{k}", text, PowerFactorBoost(volts, hertz, coil, store, ohms, period, wanted, gain, outer,
                                                               inner),
                   [0.0, start, outer.ic, inner.ic], (True, True, 0, 0), half_waves / hertz / 2,
                   {"i(l1)": lambda x: x[0], "v(out)": lambda x: x[1], "v(xv.x)": lambda x: x[2], "v(xi.x)": lambda x: x[3]})


# ---- Battery charger -------------------------------------------------------------------------------------

class Charger(Circuit):
    """A buck converter at a battery, a capacitor behind a resistor. States: coil, output, battery, integrals of the
    current's and of the voltage's controller, of which the lower decides. Mode: switch, carries, their limits."""

    def __init__(self, volts, coil, store, battery, inner_ohms, period, wanted, by_current, by_voltage):
        self.volts, self.coil, self.store, self.battery, self.inner_ohms = volts, coil, store, battery, inner_ohms
        self.period, self.wanted, self.by_current, self.by_voltage = period, wanted, by_current, by_voltage
        self.step, self.begun, self.clock = period / 6, 0.0, Clock(period, [0.0])

    def errors(self, x):
        return self.wanted[0] - x[0], self.wanted[1] - x[1]

    def derivative(self, t, x, mode):
        switch, carries, held_i, held_v = mode
        e, d = self.errors(x)
        current = (x[1] - x[2]) / self.inner_ohms
        return [((self.volts if switch else 0.0) - x[1]) / self.coil if carries else 0.0, (x[0] - current) / self.store,
                current / self.battery, self.by_current.rate(e, held_i), self.by_voltage.rate(d, held_v)]

    def guards(self, t, x, mode):
        switch, carries, held_i, held_v = mode
        e, d = self.errors(x)
        duty = min(self.by_current.output(e, x[3]), self.by_voltage.output(d, x[4]))
        ramp = (t - self.begun) / self.period
        return [ramp - duty if switch else duty - ramp, -x[0] if carries and not switch else -1.0] + \
            self.by_current.guards(e, x[3], held_i) + self.by_voltage.guards(d, x[4], held_v)

    def ends(self, t, x, mode, which):
        switch, carries, held_i, held_v = mode
        if which == 0:
            return (not switch, carries or not switch, held_i, held_v), x
        if which == 1:
            return (switch, False, held_i, held_v), [0.0] + x[1:]
        if which < 4:
            held_i, x = self.by_current.ends(x, 3, held_i, which - 2)
        else:
            held_v, x = self.by_voltage.ends(x, 4, held_v, which - 4)
        return (switch, carries, held_i, held_v), x

    def next_edge(self, t, mode):
        return self.clock.after(t)

    def edge(self, t, x, mode):
        self.begun = t
        return mode, x


def charger(rows=None):
    """From constant current to constant voltage: the battery is small enough to be full within the run."""
    for k, (volts, full, amperes, switching, periods) in enumerate(rows or [
            (24, 14.4, 5, 50e3, 250), (400, 56, 20, 20e3, 250), (5, 4.2, 0.5, 1e6, 300), (800, 450, 100, 8e3, 250)]):
        period = 1 / switching
        ohms = full / amperes
        coil = full * (1 - full / volts) * period / (0.4 * amperes)
        store, inner_ohms = 4 * period / ohms, ohms / 20
        battery = amperes * periods * period * 0.55 / (0.1 * full)
        by_current = PI(coil * switching / volts / 5, coil * switching ** 2 / volts / 60, 0.0, 0.95)
        by_voltage = PI(2 / volts, 2 / volts * switching / 30, 0.0, 0.95, 0.95)
        start = 0.9 * full
        text = f"vin in 0 {volts!r}\ns1 in sw duty saw sm\nd1 0 sw\nl1 sw out {coil!r}\nc1 out 0 {store!r} ic={start!r}\n" \
               f"rb out bat {inner_ohms!r}\ncb bat 0 {battery!r} ic={start!r}\n.model sm sw\n" \
               f"vsaw saw 0 pulse(0 1 0 {period!r} 0 0 {period!r})\n" \
               f"bi ierr 0 V={amperes!r}-i(l1)\n{by_current.card('i', 'ierr ui')}" \
               f"bv verr 0 V={full!r}-v(out)\n{by_voltage.card('v', 'verr uv')}" \
               f"bd duty 0 V=min(v(ui),v(uv))\n.lib control.lib\n"
        circuit = Charger(volts, coil, store, battery, inner_ohms, period, (amperes, full), by_current, by_voltage)
        yield Case(f"charger_{k}", text, circuit,
                   [0.0, start, start, by_current.ic, by_voltage.ic], (True, True, 0, 0), periods * period,
                   {"i(l1)": lambda x: x[0], "v(out)": lambda x: x[1], "v(bat)": lambda x: x[2], "v(xi.x)": lambda x: x[3],
                    "v(xv.x)": lambda x: x[4]})


# ---- Forward converter with a core that saturates --------------------------------------------------------

class SaturatingForward(Circuit):
    """States: flux, coil, capacitor. Mode: switch, whether the reset winding carries, whether the coil does, and the
    line of the core. Turns 1 : ratio : reset, with the supply behind a resistor."""

    def __init__(self, volts, source, ratio, reset, knee, slopes, coil, store, ohms, period, duty):
        self.volts, self.source, self.ratio, self.reset, self.knee, self.slopes = volts, source, ratio, reset, knee, slopes
        self.coil, self.store, self.ohms = coil, store, ohms
        self.clock, self.step = Clock(period, [0.0, duty * period]), period / 8

    def current(self, flux, saturated):
        """Of the core, from the first winding's side."""
        first, second = self.slopes
        return self.knee / first + (flux - self.knee) / second if saturated else flux / first

    def primary(self, x, mode):
        """The voltage of the first winding."""
        switch, resets, carries, saturated = mode
        current = self.current(x[0], saturated)
        if switch:
            return self.volts - self.source * (current + (self.ratio * x[1] if carries else 0.0))
        return -(self.volts + self.source * current / self.reset) / self.reset if resets else 0.0

    def derivative(self, t, x, mode):
        switch, _, carries, _ = mode
        v = self.primary(x, mode)
        return [v, ((self.ratio * v if switch else 0.0) - x[2]) / self.coil if carries else 0.0,
                (x[1] - x[2] / self.ohms) / self.store]

    def guards(self, t, x, mode):
        switch, resets, carries, saturated = mode
        forward = self.ratio * self.primary(x, mode) if switch else 0.0
        return [-x[0] if resets else -1.0, -x[1] if carries else forward - x[2],
                self.knee - x[0] if saturated else x[0] - self.knee]

    def ends(self, t, x, mode, which):
        switch, resets, carries, saturated = mode
        if which == 0:
            return (switch, False, carries, saturated), [0.0] + x[1:]
        if which == 1:
            return (switch, resets, not carries, saturated), [x[0], 0.0, x[2]]
        return (switch, resets, carries, not saturated), x

    def next_edge(self, t, mode):
        return self.clock.after(t)

    def edge(self, t, x, mode):
        switch = 0 in self.clock.at(t)
        return (switch, not switch and x[0] > 0.0, mode[2], mode[3]), x


def forward(rows=None):
    """Duty cycles that let the flux come back to 0, and such that do not: then it walks into saturation."""
    for k, (volts, hertz, ratio, reset, duty, ohms, light, periods) in enumerate(rows or [
            (48, 1e5, 0.5, 1, 0.4, 2, 1, 40), (48, 1e5, 0.5, 1, 0.56, 2, 1, 60), (310, 5e4, 0.1, 1, 0.45, 0.5, 8, 40),
            (310, 2e4, 0.2, 1.5, 0.5, 1, 1, 60), (12, 3e5, 2, 0.8, 0.6, 20, 30, 60), (600, 1e4, 1, 1, 0.53, 20, 1, 60)]):
        period = 1 / hertz
        out = duty * volts * ratio
        load = out / ohms
        knee = 1.3 * volts * duty * period
        first = knee / (0.05 * load * ratio)
        slopes = (first, first / 400)
        source = 0.02 * volts / (load * ratio)
        coil, store = (1 - duty) * ohms * period * 2, 20 * period / ohms
        ohms *= light
        start = 0.5 * out
        i = knee / first
        core = f"pwl(x, {-9 * i!r},{-knee - 8 * i * slopes[1]!r}, {-i!r},{-knee!r}, {i!r},{knee!r}, " \
               f"{9 * i!r},{knee + 8 * i * slopes[1]!r})"
        text = f"vin in0 0 {volts!r}\nrin in0 in {source!r}\na1 in sw s 0 0 r windings\n" \
               f".model windings transformer(turns=[1 {ratio!r} {reset!r}])\nlc in sw Flux={core}\ns1 sw 0 g 0 sm\n" \
               f"d3 r in\n" \
               f"d1 s f\nd2 0 f\nlo f out {coil!r}\nc1 out 0 {store!r} ic={start!r}\nr1 out 0 {ohms!r}\n" \
               f".model sm sw(vt=0.5)\n" \
               + card_pulse("vg", "g 0", 0.0, duty * period, period)
        circuit = SaturatingForward(volts, source, ratio, reset, knee, slopes, coil, store, ohms, period, duty)
        yield Case(f"forward_{k}", text, circuit, [0.0, 0.0, start], (True, False, True, False), periods * period,
                   {"i(lo)": lambda x: x[1], "v(out)": lambda x: x[2],
                    "i(lc)": lambda x, c=circuit: c.current(x[0], x[0] > c.knee)})
