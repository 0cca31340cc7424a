"""Converters drawn at random for the search of steady states: power stages with their loads and control, rectifiers.

drawn(seed) is a Drawn: a netlist without an analysis and what must come of it. Kind k is drawn by the seeds that are k
modulo their number. A seed gives the same netlist for ever, so that it can be cited.
"""

import collections
import math
import random

# expect: "orbit" (found, or not for a reason that a run shows), "no_common" (refused: two clocks), "drift" (refused: a
# quantity that grows), "kept" (found, with a multiplier of 1)
Drawn = collections.namedtuple("Drawn", "name netlist expect")


class Draw:
    def __init__(self, seed):
        self.random = random.Random(f"steady {seed}")

    def spread(self, low, high):
        return float(f"{math.exp(self.random.uniform(math.log(low), math.log(high))):.4g}")

    def uniform(self, low, high):
        return float(f"{self.random.uniform(low, high):.4g}")

    def chance(self, p):
        return self.random.random() < p

    def one_of(self, *choices):
        return self.random.choice(choices)


def pulse(delay, width, period, edge=0.0):
    """A command that repeats from t = 0 on, as what is before a delay does not: what is high there begins so."""
    if delay + width <= period:
        return f"pulse(0 1 {delay!r} {edge!r} {edge!r} {width!r} {period!r})"
    return f"pulse(1 0 {delay + width - period!r} {edge!r} {edge!r} {period - width!r} {period!r})"


def diode_model(d):
    return ".model dm D(" + d.one_of("", "", "Ron=1m", f"Ron={d.spread(1e-3, 0.1)!r} Vfwd={d.uniform(0.2, 1)!r}") + ")\n"


# ---- Power stages ----------------------------------------------------------------------------------------

SHAPES = {  # cards between fin and out, the ratio of the output, the border of conduction over R T / 2
    "buck": ("s1 fin sw {on} sm\nd1 0 sw dm\nl1 sw out {coil!r}\n", lambda a: a, lambda a: 1 - a),
    "boost": ("l1 fin sw {coil!r}\ns1 sw 0 {on} sm\nd1 sw out dm\n", lambda a: 1 / (1 - a), lambda a: a * (1 - a) ** 2),
    "buckboost": ("s1 fin sw {on} sm\nl1 sw 0 {coil!r}\nd1 out sw dm\n", lambda a: -a / (1 - a), lambda a: (1 - a) ** 2),
    "sepic": ("l1 fin a {coil!r}\ns1 a 0 {on} sm\nc9 a b {small!r}\nl2 b 0 {coil!r}\nr9 b b9 {damp!r}\n"
    "c8 b9 a {small3!r}\nd1 b out dm\n",
              lambda a: a / (1 - a), lambda a: 2 * (1 - a) ** 2),
    "cuk": ("l1 fin a {coil!r}\ns1 a 0 {on} sm\nc9 a b {small!r}\nd1 b 0 dm\nl2 b out {coil!r}\nr9 b b9 {damp!r}\n"
    "c8 b9 a {small3!r}\n",
            lambda a: -a / (1 - a), lambda a: 2 * (1 - a) ** 2),
    "zeta": ("s1 fin a {on} sm\nl1 a 0 {coil!r}\nc9 a b {small!r}\nd1 0 b dm\nl2 b out {coil!r}\nr9 b b9 {damp!r}\n"
    "c8 b9 a {small3!r}\n",
             lambda a: a / (1 - a), lambda a: 2 * (1 - a) ** 2),
    "flyback": ("l1 fin sw {coil!r}\nl2 0 s {second!r}\nk1 l1 l2 {coupling!r}\ns1 sw 0 {on} sm\nd1 s out dm\n{clamp}",
                lambda a: 1.0 * a / (1 - a), lambda a: (1 - a) ** 2),
    "forward": ("l1 fin sw {magnet!r}\nl2 s 0 {magnet!r}\nl3 0 r {magnet!r}\nk1 l1 l2 l3 1\ns1 sw 0 {on} sm\nd3 r fin dm\n"
                "d1 s f dm\nd2 0 f dm\nlo f out {coil!r}\n", lambda a: a, lambda a: 1 - a),
}


class Stage:
    """Values of a power stage and its cards but for what commands the switch."""

    def __init__(self, d, shapes):
        self.shape = d.one_of(*shapes)
        cards, ratio, border = SHAPES[self.shape]
        self.hertz, self.volts, self.ohms = d.spread(2e3, 1e6), d.spread(3, 600), d.spread(0.5, 500)
        self.duty = d.uniform(0.15, 0.46 if self.shape == "forward" else 0.7)
        self.period = 1 / self.hertz
        self.out = self.volts * ratio(self.duty)
        self.coil = d.one_of(d.spread(0.05, 0.7), d.spread(1.4, 12)) * border(self.duty) * self.ohms * self.period / 2
        self.store = d.spread(5, 60) * self.period / self.ohms
        self.cards, self.d = cards, d
        self.small = d.spread(1, 8) * self.period / self.ohms
        self.esr = d.one_of(0, 0, d.spread(1e-3, 0.05) * self.ohms)

    def text(self, on):
        d, r = self.d, self.ohms
        ring = self.coil * d.spread(0.003, 0.03)
        coupling = d.one_of(1, 1, 0.995, 0.97)
        clamp = "" if coupling == 1 else f"dc sw cl dm\nrc cl fin {10 * r!r}\ncc cl fin {5 * self.period / r!r}\n"
        values = {"on": on, "coil": self.coil, "small": self.small, "small3": 4 * self.small,
                  "damp": math.sqrt(self.coil / self.small), "second": self.coil, "coupling": coupling, "clamp": clamp,
                  "magnet": 20 * self.coil}
        text = f"vin in 0 {self.volts!r}\n"
        if d.chance(0.25):
            text += f"lf in fin {ring!r}\nrf in fin {math.sqrt(self.coil / self.store)!r}\ncf fin 0 {2 * self.store!r}\n"
        else:
            text += f"rf in fin {d.one_of(0, r * d.spread(1e-4, 1e-2))!r}\n"
        text += self.cards.format(**values)
        text += f"c1 out esr {self.store!r}\nre esr 0 {self.esr!r}\n" + self.load()
        return text + f".model sm sw(vt={0.5 if on == 'g 0' else 0})\n" + diode_model(d)

    def load(self):
        d, r, sign = self.d, self.ohms, 1 if self.out > 0 else -1
        current = abs(self.out) / r
        return d.one_of(
            f"r1 out 0 {r!r}\n", f"r1 out 0 {r!r}\n",
            f"r1 out 0 {2 * r!r}\ni1 out 0 {0.4 * sign * current!r}\n",
            f"r1 out m {r!r}\nl9 m 0 {d.spread(0.3, 30) * r * self.period!r}\nr2 out 0 {5 * r!r}\n",
            f"r1 out m {0.2 * r!r}\nv1 m 0 {0.7 * self.out!r}\nr2 out 0 {5 * r!r}\n",
            f"bl out 0 I={0.3 * abs(self.out) * current!r}/max({sign}*v(out),{0.6 * abs(self.out)!r})*{sign}\n"
            f"r1 out 0 {1.5 * r!r}\n")


def open_loop(d):
    stage = Stage(d, SHAPES)
    t, edge = stage.period, d.one_of(0, 0, 0.01)
    width = max(stage.duty - edge, 0.05)
    return (f"{stage.shape}, open", stage.text("g 0") +
            f"vg g 0 pulse(0 1 {d.one_of(0, 0, 0.3, 2.7) * t!r} {edge * t!r} {edge * t!r} {width * t!r} {t!r})\n", "orbit")


def voltage_mode(d):
    """Proportional and integral, or of a transfer function, against a saw; gains from tame to such that double."""
    stage = Stage(d, ("buck", "buck", "boost", "buckboost", "flyback"))
    t = stage.period
    text = stage.text("u saw")
    text += f"vsaw saw 0 {d.one_of(f'pulse(0 1 0 {t!r} 0 0 {t!r})', f'pulse(0 1 0 {t / 2!r} {t / 2!r} 0 {t!r})')}\n"
    sense = 1 / abs(stage.out)
    text += f"be e 0 V=1-{sense if stage.out > 0 else -sense!r}*v(out)\n"
    gain = d.spread(0.02, 1 if stage.shape == "buck" else 0.15)
    if d.chance(0.3):
        gain *= 8
    slow = stage.store * stage.ohms * d.spread(1, 8)
    control = d.one_of("p", "pi", "pi", "limited", "laplace")
    if control == "p":
        text += f"bu u 0 V={stage.duty!r}+{2 * gain!r}*v(e)\n"
    elif control == "pi":
        text += f"bx 0 x I={gain / slow!r}*v(e)\ncx x 0 1 ic={stage.duty!r}\nbu u 0 V=v(x)+{gain!r}*v(e)\n"
    elif control == "limited":
        text += f"ax e x integral\n.model integral int(gain={gain / slow!r} out_lower_limit=0.02 out_upper_limit=0.9 " \
                f"out_ic={stage.duty!r})\nbu u 0 V=limit(v(x)+{gain!r}*v(e),0.02,0.9)\n"
    else:
        text += f"eu u 0 LAPLACE {{v(e)}} = {{{gain / slow!r}*(1+s*{slow!r})/(s*(1+s*{t / 4!r}))}}\n"
    return f"{stage.shape}, {control} of the voltage", text, "orbit"


def hysteretic(d):
    """Without a clock: the period is the circuit's own."""
    stage = Stage(d, ("buck",))
    stage.esr = d.spread(0.02, 0.2) * stage.ohms
    band = d.spread(0.002, 0.02) * stage.out
    text = stage.text("ref out").replace(".model sm sw(vt=0)", f".model sm sw(vt=0 vh={band!r})")
    return "hysteretic buck", text + f"vref ref 0 {stage.out!r}\n", "orbit"


def interleaved(d):
    stage = Stage(d, ("buck",))
    t, n = stage.period, d.one_of(2, 3, 4)
    text = f"vin in 0 {stage.volts!r}\nc1 out 0 {stage.store!r}\n{stage.load()}.model sm sw(vt=0.5)\n{diode_model(d)}"
    for k in range(n):
        text += f"vg{k} g{k} 0 {pulse(k * t / n, stage.duty * t, t)}\ns{k} in w{k} g{k} 0 sm\n" \
                f"d{k} 0 w{k} dm\nl{k} w{k} x{k} {n * stage.coil * d.uniform(0.9, 1.1)!r}\n" \
                f"r{k}0 x{k} out {stage.ohms * d.spread(1e-3, 1e-2)!r}\n"
    if n == 2 and d.chance(0.5):
        text += f"k1 l0 l1 {d.one_of(-0.9, -0.5, 0.5)!r}\n"
    return f"{n} phases", text, "orbit"


def two_clocks(d):
    """A load that steps at a clock of its own: with a common period or without one."""
    stage = Stage(d, ("buck", "boost"))
    t = stage.period
    p, q = d.one_of((2, 1), (3, 2), (5, 3), (7, 4), (10, 1), (1, 3))
    common = d.chance(0.6)
    other = t * p / q if common else t * d.one_of(math.sqrt(2), math.pi, (1 + math.sqrt(5)) / 2)
    if common:  # as fractions of the digits that the netlist has
        t = float(f"{t:.3g}")
        other = float(f"{t * p / q:.15g}")
    wave = d.one_of(f"sin(0 {0.2 * abs(stage.out) / stage.ohms!r} {1 / other!r})",
                    f"pulse(0 {0.3 * abs(stage.out) / stage.ohms!r} 0 0 0 {0.4 * other!r} {other!r})")
    return f"{stage.shape}, two clocks", stage.text("g 0") + \
        f"vg g 0 pulse(0 1 0 0 0 {stage.duty * t!r} {t!r})\nil out 0 {wave}\n", "orbit" if common else "no_common"


# ---- Rectifiers ------------------------------------------------------------------------------------------

def filtered(d, plus, minus, ohms, hertz):
    """A capacitor, a coil, or both at the output of a rectifier."""
    store, coil = d.spread(0.3, 30) / hertz / ohms, d.spread(0.02, 3) * ohms / hertz
    return d.one_of(
        f"c1 {plus} {minus} {store!r}\nr1 {plus} {minus} {ohms!r}\n",
        f"l1 {plus} out {coil!r}\nr1 out {minus} {ohms!r}\n",
        f"l1 {plus} out {coil!r}\nc1 out {minus} {store!r}\nr1 out {minus} {ohms!r}\n")


def diode_rectifier(d):
    volts, hertz, ohms = d.spread(1, 1e3), d.spread(16, 2e4), d.spread(1, 1e3)
    source = ohms * d.spread(1e-3, 0.1)
    kind = d.one_of("half", "bridge", "three", "six", "doubler")
    text = diode_model(d)
    if kind in ("half", "bridge"):
        ends = ("0", "0") if kind == "half" else ("w", "q")
        text += f"v1 s {ends[0]} sin(0 {volts!r} {hertz!r})\nr9 s a {source!r}\nd1 a p dm\n"
        text += f"d9 0 p dm\nr8 p 0 {100 * ohms!r}\n" if kind == "half" else "d2 w p dm\nd3 q a dm\nd4 q w dm\nv9 q 0 0\n"
        text += filtered(d, "p", ends[1], ohms, hertz)
    elif kind in ("three", "six"):
        for k in range(3):
            text += f"v{k} n{k} 0 sin(0 {volts!r} {hertz!r} 0 0 {-120 * k})\n"
            text += d.one_of(f"r{k}9 n{k} a{k} {source!r}\n", f"l{k}9 n{k} a{k} {source / hertz / 10!r}\n")
            text += f"d{k} a{k} p dm\n" + (f"d{k}9 q a{k} dm\n" if kind == "six" else "")
        text += f"r8 p {'q' if kind == 'six' else '0'} {50 * ohms!r}\n"
        text += filtered(d, "p", "q" if kind == "six" else "0", ohms, hertz)
    else:
        store = d.spread(0.5, 10) / hertz / ohms
        text += f"v1 s 0 sin(0 {volts!r} {hertz!r})\nr9 s a {source!r}\nc8 a b {store!r}\nd1 0 b dm\nd2 b out dm\n" \
                f"c1 out 0 {store!r}\nr1 out 0 {ohms!r}\n"
    return f"{kind} rectifier", text, "orbit"


def phase_controlled(d):
    volts, hertz, ohms = d.spread(10, 1e3), d.spread(16, 1e3), d.spread(1, 100)
    alpha, kind = d.uniform(20, 110), d.one_of("half", "bridge", "three", "six", "triac")
    period, coil = 1 / hertz, ohms / hertz * d.spread(0.02, 1)
    text, gates = "", []

    def gate(degrees, width=100, period=period):
        gates.append(f"vg{len(gates)} g{len(gates)} 0 {pulse(degrees % 360 / 360 / hertz, width / 360 / hertz, period)}\n")
        return f"g{len(gates) - 1} 0 "
    if kind == "half":
        text += f"v1 a 0 sin(0 {volts!r} {hertz!r})\na1 a p {gate(alpha)}th\nd1 0 p\nl1 p o {coil!r}\nr1 o 0 {ohms!r}\n"
    elif kind == "triac":
        text += f"v1 a 0 sin(0 {volts!r} {hertz!r})\na1 a p {gate(max(60, alpha), 20, period / 2)}tr\n" \
            f"l1 p o {coil / 10!r}\n" \
                f"r1 o 0 {ohms!r}\n"
    elif kind == "bridge":
        text += f"v1 a b sin(0 {volts!r} {hertz!r})\nv9 b 0 0\na1 a p {gate(alpha)}th\na2 b p {gate(180 + alpha)}th\n" \
                f"d3 q a\nd4 q b\nl1 p o {coil!r}\nr1 o q {ohms!r}\n"
    else:
        alpha = min(alpha, 75)
        for k in range(3):
            text += f"v{k} n{k} 0 sin(0 {volts!r} {hertz!r} 0 0 {-120 * k})\nl{k} n{k} a{k} {coil / 100!r}\n" \
                    f"a{k} a{k} p {gate(30 + alpha + 120 * k)}th\n"
            text += f"a{k + 3} q a{k} {gate(210 + alpha + 120 * k)}th\n" if kind == "six" else ""
        text += f"l9 p o {coil!r}\nr1 o {'q' if kind == 'six' else '0'} {ohms!r}\n"
    # a run at 1e-11 is not sure of the 1 uA of Ioff beside so many amperes
    models = f".model th thyristor\n.model tr triac(Ioff={1e-4 * volts / ohms!r})\n"
    return f"{kind}, phase controlled", text + "".join(gates) + models, "orbit"


# ---- What has no steady state, or many -------------------------------------------------------------------

def drifting(d):
    """A current that nothing takes away fills a capacitor, period after period."""
    stage = Stage(d, ("buck", "boost"))
    t, store = stage.period, d.spread(1e-9, 1e-3)
    text = stage.text("g 0") + f"vg g 0 pulse(0 1 0 0 0 {stage.duty * t!r} {t!r})\n" \
        f"i9 0 y {d.one_of(1, -1) * 0.01 * store * stage.volts / t!r}\nc9y y 0 {store!r}\n"
    return "drifting", text, "drift"


def conserved(d):
    """The charge of a node between capacitors."""
    stage = Stage(d, ("buck", "boost", "buckboost"))
    t, store = stage.period, d.spread(0.5, 5) * stage.period / stage.ohms
    return "conserved", stage.text("g 0") + f"vg g 0 pulse(0 1 0 0 0 {stage.duty * t!r} {t!r})\n" \
        f"c7 out y {store!r} ic={d.uniform(-1, 1) * stage.volts!r}\nc8y y 0 {d.spread(0.3, 3) * store!r}\n", "kept"


KINDS = (open_loop, open_loop, open_loop, voltage_mode, voltage_mode, voltage_mode, hysteretic, interleaved, two_clocks,
         diode_rectifier, diode_rectifier, phase_controlled, phase_controlled, drifting, conserved)


def drawn(seed):
    name, netlist, expect = KINDS[seed % len(KINDS)](Draw(seed))
    return Drawn(f"seed {seed}, {name}", netlist, expect)
