"""A resonant converter whose frequency is controlled: its netlist and, by hand, its equations."""

import math

from cases import Case
from control import PI
from events import Circuit

TURN = 2 * math.pi


class Llc(Circuit):
    """States: resonant current and capacitor, magnetising current, output, turns of the oscillator, integral. Modes: half
    of the turn, which diode conducts (1, -1, 0), whether the integral is at a limit."""

    def __init__(self, volts, coil, store, magnet, ratio, out, ohms, wanted, frequencies, pi):
        self.volts, self.coil, self.store, self.magnet, self.ratio = volts, coil, store, magnet, ratio
        self.out, self.ohms, self.wanted, self.frequencies, self.pi = out, ohms, wanted, frequencies, pi
        self.step = 1 / frequencies[1] / 12

    def frequency(self, x):
        low, high = self.frequencies
        return high - (high - low) * (x[5] + self.pi.kp * (self.wanted - x[3]))

    def primary(self, x, mode):
        """The voltage of the magnetising coil."""
        half, diode, _ = mode
        if diode:
            return diode * self.ratio * x[3]
        return ((self.volts if half > 0 else 0.0) - x[1]) * self.magnet / (self.magnet + self.coil)

    def derivative(self, t, x, mode):
        half, diode, held = mode
        v, drive = self.primary(x, mode), self.volts if half > 0 else 0.0
        secondary = diode * self.ratio * (x[0] - x[2])
        return [(drive - x[1] - v) / self.coil, x[0] / self.store, v / self.magnet,
                (secondary - x[3] / self.ohms) / self.out, self.frequency(x), self.pi.rate(self.wanted - x[3], held)]

    def guards(self, t, x, mode):
        half, diode, held = mode
        own = [-half * math.sin(TURN * x[4])]
        v = self.primary(x, mode)
        own += [-diode * (x[0] - x[2]), -1.0] if diode else [v - self.ratio * x[3], -v - self.ratio * x[3]]
        return own + self.pi.guards(self.wanted - x[3], x[5], held)

    def ends(self, t, x, mode, which):
        half, diode, held = mode
        if which == 0:
            return (-half, diode, held), x
        if which < 3 and diode:
            return (half, 0, held), [x[0], x[1], x[0]] + x[3:]
        if which < 3:
            return (half, 1 if which == 1 else -1, held), x
        held, x = self.pi.ends(x, 5, held, which - 3)
        return (half, diode, held), x


def llc(rows=None):
    for k, (volts, resonance, wanted, power, quality, periods) in enumerate(rows or [
            (400, 1e5, 12, 200, 0.35, 60), (48, 5e5, 5, 20, 0.6, 80), (800, 4e4, 400, 6e3, 0.25, 60),
            (24, 1e6, 24, 10, 0.45, 80)]):
        ohms = wanted ** 2 / power
        ratio = volts / 2 / wanted
        reflected = 8 / math.pi ** 2 * ratio ** 2 * ohms
        coil = quality * reflected / (TURN * resonance)
        store = 1 / (coil * (TURN * resonance) ** 2)
        magnet, out = 5 * coil, 8 / (resonance * ohms)
        frequencies = (0.6 * resonance, 1.8 * resonance)
        pi = PI(0.15 / wanted, 0.03 * resonance / wanted, 0.0, 1.0, 0.3)
        circuit = Llc(volts, coil, store, magnet, ratio, out, ohms, wanted, frequencies, pi)
        start = 0.8 * wanted
        low, high = frequencies
        text = f"vdc d 0 {volts!r}\ns1 d sw q 0 sm\ns2 sw 0 0 q sm\n.model sm sw\nlr sw r {coil!r}\n" \
            f"cr r p {store!r} ic={volts / 2!r}\n" \
               f"lm p 0 {magnet!r}\na1 p 0 s 0 0 t windings\n.model windings transformer(turns=[{ratio!r} 1 1])\n" \
               f"d1 s out\nd2 t out\nco out 0 {out!r} ic={start!r}\nro out 0 {ohms!r}\n* the oscillator: th counts turns\n" \
               f"be err 0 V={wanted!r}-v(out)\nai err x integral\n" \
               f".model integral int(gain={pi.ki!r} out_lower_limit=0 out_upper_limit=1 out_ic={pi.ic!r})\n" \
               f"bf 0 th I={high!r}-{high - low!r}*(v(x)+{pi.kp!r}*v(err))\ncth th 0 1 ic=0\nbq q 0 V=sin({TURN!r}*v(th))\n"
        yield Case(f"llc_{k}", text, circuit, [0.0, volts / 2, 0.0, start, 0.0, pi.ic], (1, 0, 0), periods / resonance,
                   {"i(lr)": lambda x: x[0], "v(r,p)": lambda x: x[1], "i(lm)": lambda x: x[2], "v(out)": lambda x: x[3],
                    "v(th)": lambda x: x[4], "v(x)": lambda x: x[5]})
