"""Circuits drawn at random, each of a kind that is hard for the engine. A seed always gives the same one."""

import math
import random as randoms

from circuits import Circuit


class Draft(Circuit):
    """A circuit with the random numbers that it is made of."""

    def __init__(self, kind, seed):
        super().__init__(f"{kind} {seed}")
        self.random = randoms.Random(f"{kind} {seed}")
        self.uic = True
        self.count = {}

    def spread(self, low, high):
        """A number whose logarithm is equally likely anywhere."""
        return math.exp(self.random.uniform(math.log(low), math.log(high)))

    def put(self, kind, nodes, value=None, **more):
        self.count[kind] = self.count.get(kind, 0) + 1
        return self.add(f"{kind}{self.count[kind]}", nodes.split(), value, **more).name

    def sine(self, nodes, volts, hertz, phase=0.0):
        return self.put("v", nodes, function=("sin", [0.0, volts, hertz, 0.0, 0.0, phase]))

    def pulse(self, nodes, high, period, duty, delay=0.0, edge=0.0):
        return self.put("v", nodes, function=("pulse", [0.0, high, delay, edge, edge, duty * period - edge, period]))

    def switch(self, nodes, ron=1e-3, roff=1e6, vt=0.5, vh=0.0):
        model = f"m{len(self.models)}"
        self.models[model] = ("SW", {"ron": ron, "roff": roff, "vt": vt, "vh": vh})
        return self.put("s", nodes, model=model)

    def diode(self, nodes, **model):
        name = None
        if model:
            name = f"m{len(self.models)}"
            self.models[name] = ("D", model)
        return self.put("d", nodes, model=name)

    def lasts(self, stop):
        self.stop, self.step = stop, stop / 200


def clocks(c):
    """Many commanded switches with clocks that have no common period, into one load."""
    c.put("v", "in 0", dc=c.spread(5, 600))
    period = c.spread(2e-6, 2e-3)
    n = c.random.randint(3, 9)
    for k in range(n):
        c.pulse(f"g{k} 0", c.random.choice((1.0, 5.0, 12.0)), period * c.random.uniform(0.5, 3), c.random.uniform(0.2, 0.8),
                delay=period * c.random.random(), edge=c.random.choice((0.0, 0.01)) * period)
        c.switch(f"in s{k} g{k} 0", ron=c.spread(1e-3, 1.0), roff=c.spread(1e5, 1e8))
        c.put("r", f"s{k} out", c.spread(1, 100))
        if c.random.random() < 0.4:
            c.put("l", f"s{k} out", period * c.spread(1, 100))
        if c.random.random() < 0.4:
            c.diode(f"0 s{k}")
    c.put("r", "out 0", c.spread(3, 300))
    c.put("c", "out 0", period / c.spread(1, 50))
    c.lasts(period * c.random.uniform(12, 25))


def sine_triangle(c):
    """A leg or a bridge commanded by a sine against a triangle, straight from both sources."""
    volts, period = c.spread(20, 800), c.spread(1e-5, 1e-3)
    modulation = period * c.random.choice((11.0, 21.0, 17.3))
    size = c.random.choice((1.0, 5.0))
    c.sine("ref 0", size * c.random.uniform(0.4, 0.95), 1 / modulation, c.random.choice((0.0, 37.0)))
    c.put("v", "tri 0", function=("pulse", [-size, size, 0.0, period / 2, period / 2, 0.0, period]))
    c.put("v", "p 0", dc=volts / 2)
    c.put("v", "0 m", dc=volts / 2)
    for k, (first, second) in enumerate((("ref", "tri"), ("tri", "ref"))):
        ends = ("p a", "a m")[k]
        c.switch(f"{ends} {first} {second}", ron=c.spread(1e-3, 0.1), roff=c.spread(1e5, 1e7), vt=0.0)
        c.diode(" ".join(reversed(ends.split())))
    c.put("l", "a out", period * c.spread(3, 30))
    c.put("r", "out 0", c.spread(2, 20))
    if c.random.random() < 0.5:
        c.put("c", "out 0", period / c.spread(1, 10))
    c.lasts(modulation * 1.1)


def hysteretic(c):
    """A switch that the regulated quantity commands: a voltage or a current, within a band."""
    volts = c.spread(5, 500)
    target = volts * c.random.uniform(0.2, 0.8)
    tau = c.spread(1e-5, 1e-2)
    r = c.spread(0.5, 50)
    c.put("v", "in 0", dc=volts)
    c.put("v", "ref 0", dc=target)
    band = target * c.spread(0.003, 0.1)
    if c.random.random() < 0.5:
        c.switch("in sw ref out", roff=c.spread(1e5, 1e8), vt=0.0, vh=band)
        c.put("r", "sw out", r / c.spread(3, 30))
        c.put("c", "out 0", tau / r)
        c.put("r", "out 0", r)
    else:
        c.put("b", "e 0", formula=("v", f"v(ref)-{r!r}*i(l1)"))
        c.switch("in sw e 0", roff=c.spread(1e5, 1e8), vt=0.0, vh=band)
        c.diode("0 sw")
        c.put("l", "sw out", tau * r)
        c.put("c", "out 0", tau * 3 / r)
        c.put("r", "out 0", r)
    c.lasts(tau * c.random.uniform(2, 6))


def coupled(c):
    """Coils with k = 1 or nearly so, between sources, diodes and chopped voltages."""
    volts, period = c.spread(10, 400), c.spread(1e-5, 2e-2)
    k = c.random.choice((1.0, 0.9999, 0.99, -1.0))
    magnetising = period * c.spread(3, 100)
    n = c.spread(0.05, 5)
    if c.random.random() < 0.5:
        c.sine("in 0", volts, 1 / period)
        c.put("r", "in p", c.spread(0.01, 1))
    else:
        c.put("v", "p 0", function=("pulse", [-volts, volts, 0.0, 0.0, 0.0, period / 2, period]))
    first = c.put("l", "p 0", magnetising)
    ground = c.random.choice(("0", "f"))
    second = c.put("l", f"s {ground}", magnetising * n * n)
    c.add("k1", [], k, coils=[first, second])
    c.diode(f"s out", **c.random.choice(({}, {"ron": 0.01, "vfwd": 0.7}, {"ron": 0.01, "roff": 1e6})))
    c.put("r", f"out {ground}", c.spread(5, 500))
    if c.random.random() < 0.7:
        c.put("c", f"out {ground}", period / c.spread(1, 50))
    if ground == "f" and c.random.random() < 0.5:
        c.put("r", "f 0", 1e6)
    c.lasts(period * c.random.uniform(4, 9))


def three_phases(c):
    """Star or delta without a neutral on a bridge or resistors."""
    volts, hertz = c.spread(20, 600), c.spread(16, 400)
    star = c.random.random() < 0.5
    for k, phase in enumerate("abc"):
        c.sine(f"{phase} " + ("n" if star else "abc"[(k + 1) % 3] + "x"), volts, hertz, 120.0 * k)
        if not star:
            c.put("r", f"{'abc'[(k + 1) % 3]}x {'abc'[(k + 1) % 3]}", c.spread(0.01, 0.1))
        c.put("l", f"{phase} {phase}l", c.spread(1e-4, 3e-3) / hertz * 50)
        c.put("r", f"{phase}l {phase}i", c.spread(0.01, 0.5))
    if c.random.random() < 0.6:
        for phase in "abc":
            c.diode(f"{phase}i p")
            c.diode(f"m {phase}i")
        c.put("r", "p m", c.spread(5, 100))
        if c.random.random() < 0.5:
            c.put("c", "p m", c.spread(1e-5, 1e-3))
    else:
        for phase in "abc":
            c.put("r", f"{phase}i y", c.spread(5, 100))
        c.diode("ai ci")
    if c.random.random() < 0.6:
        c.put("r", c.random.choice(("p 0", "ai 0", "a 0")) if c.element("d1").nodes[0] == "ai" else "a 0", 1e5)
    c.lasts(c.random.uniform(1.5, 3) / hertz)


def milliohms(c):
    """Milliohms beside megohms at 600 V, and gates of 1 V that see none of it."""
    period = c.spread(1e-5, 1e-3)
    c.put("v", "in 0", dc=c.spread(300, 3000))
    c.put("r", "in a", c.spread(1e-3, 1e-2))
    c.put("c", "a 0", period * c.spread(0.1, 10), initial=c.random.choice((0.0, 500.0)))
    n = c.random.randint(1, 4)
    for k in range(n):
        c.pulse(f"g{k} 0", 1.0, period, c.random.uniform(0.2, 0.45), delay=period * k / n, edge=1e-3 * period)
        c.put("r", f"g{k} h{k}", 10.0)
        c.put("c", f"h{k} 0", period * 1e-4)
        c.switch(f"a b{k} h{k} 0", ron=c.spread(1e-3, 1e-2), roff=c.spread(1e6, 1e9), vh=c.random.choice((0.0, 0.1)))
        c.put("r", f"b{k} 0", c.spread(10, 1e6))
        c.put("l", f"b{k} d{k}", period * c.spread(1, 100))
        c.put("r", f"d{k} 0", c.spread(1, 100))
        c.diode(f"0 b{k}", ron=1e-3, roff=1e7)
    c.lasts(period * c.random.uniform(5, 15))


def tanks(c):
    """High-Q tanks that ring or are driven near their resonance, clamped or rectified."""
    hertz, impedance, q = c.spread(1e2, 1e6), c.spread(1, 1e4), c.spread(30, 1e4)
    l, cap = impedance / (2 * math.pi * hertz), 1 / (impedance * 2 * math.pi * hertz)
    c.put("l", "a b", l)
    c.put("r", "b c", impedance / q)
    c.put("c", "c 0", cap, initial=c.random.choice((0.0, 10.0)))
    volts = c.spread(0.1, 10)
    if c.random.random() < 0.5:
        c.sine("a 0", volts, hertz * c.random.uniform(0.9, 1.1))
    else:
        c.pulse("a 0", volts, c.random.uniform(0.9, 1.1) / hertz, 0.5)
    c.diode("c k", **c.random.choice(({}, {"vfwd": 0.7, "ron": impedance / 1000})))
    c.put("v", "k 0", dc=volts * c.spread(1, 30))
    if c.random.random() < 0.5:
        c.diode("c o")
        c.put("c", "o 0", cap * c.spread(0.5, 5))
        c.put("r", "o 0", impedance * c.spread(3, 100))
    c.lasts(c.random.uniform(20, 60) / hertz)


def latches(c):
    """A switch that holds itself, set by one pulse, let go when its current ends or by another."""
    period, volts = c.spread(1e-4, 1e-1), c.spread(10, 600)
    r = c.spread(1, 1e3)
    c.sine("in 0", volts, 1 / period)
    c.put("v", "gate 0", function=("pulse", [0.0, 1.0, period * c.random.uniform(0.05, 0.4), 1e-4 * period,
                                             1e-4 * period, period * 0.02, period]))
    c.put("v", "in a", dc=0.0)
    c.diode("a b", ron=r * 1e-4, roff=r * 1e5)
    c.switch("b out latch 0", ron=r * 1e-4, roff=r * 1e5, vt=0.5, vh=0.1)
    c.put("b", "latch 0", formula=("v", f"v(gate)+min(1,max(0,{30 * r / volts!r}*i(v3)))"))
    c.put("r", "out 0", r)
    if c.random.random() < 0.5:
        c.elements[-1].nodes[0] = "out2"
        c.put("l", "out out2", r * period * c.spread(0.01, 0.5))
    c.lasts(period * c.random.uniform(2, 6))


def oscillators(c):
    """A capacitor that a switch with hysteresis discharges when it is full."""
    volts, tau, r = c.spread(5, 500), c.spread(1e-6, 1e-1), c.spread(100, 1e6)
    c.put("v", "in 0", dc=volts)
    c.put("r", "in a", r)
    c.put("c", "a 0", tau / r)
    high = c.random.uniform(0.3, 0.8)
    low = high * c.random.uniform(0.05, 0.6)
    ron = c.random.choice((0.1, 1e-2, 1e-4)) * r
    c.switch("a b a 0", ron=ron * 0.3, roff=c.random.choice((1e3, 1e6)) * r, vt=volts * (high + low) / 2,
             vh=volts * (high - low) / 2)
    c.put("r", "b 0", ron * 0.7)
    c.lasts(tau * c.random.uniform(3, 8))


def multipliers(c):
    """Ladders of diodes and capacitors on a sine."""
    volts, hertz, n = c.spread(5, 5000), c.spread(50, 1e5), c.random.randint(2, 8)
    cap = c.spread(1e-9, 1e-5)
    c.sine("n0 0", volts, hertz)
    models = {} if c.random.random() < 0.5 else {"vfwd": 0.7, "ron": 0.1 / (cap * hertz) * 0.01}
    before = ["0", "n0"]
    for k in range(n):
        node = f"n{k + 1}"
        c.put("c", f"{before[1]} {node}" if k else "n0 n1", cap * c.random.uniform(0.5, 2))
        c.diode(f"{before[0]} {node}", **models)
        before = [node, before[0] if k else "0"]
    c.put("r", f"n{n} 0", c.spread(3, 3000) / (cap * hertz))
    c.lasts(c.random.uniform(3, 8) / hertz)


def ladders(c):
    """A ladder of sections with switches or diodes in some of them."""
    n, tau = c.random.randint(5, 40), c.spread(1e-6, 1e-2)
    period = tau * c.spread(1, 20)
    c.put("v", "n0 0", function=c.random.choice((("sin", [0.0, 10.0, 1 / period]),
                                                 ("pulse", [0.0, 10.0, 0.0, 0.0, 0.0, period / 3, period]))))
    kind = c.random.choice("rl")
    for k in range(n):
        end = f"n{k + 1}"
        c.put(kind, f"n{k} {end}", tau / 10 * 50 if kind == "l" else 50.0)
        c.put("c", f"{end} 0", tau / 10 / 50 * c.random.uniform(0.5, 2))
        if c.random.random() < 0.2:
            c.diode(f"{end} c{k}")
            c.put("r", f"c{k} 0", c.spread(20, 2000))
        if c.random.random() < 0.1:
            c.pulse(f"g{k} 0", 1.0, period * c.random.uniform(0.3, 2), 0.4)
            c.switch(f"{end} t{k} g{k} 0", ron=1.0, roff=1e6)
            c.put("r", f"t{k} 0", c.spread(20, 2000))
    c.put("r", f"n{n} 0", 50.0)
    c.lasts(tau * c.random.uniform(5, 30))


KINDS = (clocks, sine_triangle, hysteretic, coupled, three_phases, milliohms, tanks, latches, oscillators,
         multipliers, ladders)


def draw(seed):
    """The circuit of a seed: kinds in turn."""
    kind = KINDS[seed % len(KINDS)]
    circuit = Draft(kind.__name__, seed)
    kind(circuit)
    circuit.default_signals()
    measured = circuit.random.choice([s for s in circuit.signals if s[0] == "v"])
    name = f"v({measured[1]})" if measured[2] == "0" else f"v({measured[1]},{measured[2]})"
    circuit.measures = [("mean", ["avg", name, "from=", 0.3 * circuit.stop, "to=", 0.9 * circuit.stop]),
                        ("top", ["max", name]), ("there", ["find", name, "at=", 0.4321 * circuit.stop])]
    return circuit
