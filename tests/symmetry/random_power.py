"""Power circuits drawn at random, of kinds that have many switches in one part, latches, loops or floating stars.

A seed gives the same one for ever. Values spread over scales, parasitics come and go, clocks need not agree."""

from random_netlists import Draft


class Power(Draft):
    """A circuit with what these kinds have in common."""

    def __init__(self, kind, seed):
        super().__init__(kind, seed)
        chance = self.random
        self.period = self.spread(1e-6, 1e-2)
        self.volts = chance.choice((12.0, 48.0, 400.0, 600.0, 3000.0))
        self.ohms = self.spread(0.5, 500)
        self.ron = chance.choice((0.0, 1e-3, 1e-2, 0.1))
        self.roff = chance.choice((None, 1e5, 1e6, 1e8))
        self.diodes = chance.choice(({}, {}, {"ron": 1e-3}, {"ron": 1e-3, "roff": 1e6}, {"vfwd": 0.7, "ron": 1e-2}))
        self.gate = chance.choice((1.0, 5.0, 15.0))
        self.parasitics = chance.choice((0.0, 0.0, 0.3))

    def maybe(self, probability):
        return self.random.random() < probability

    def one_model(self, kind, values):
        """The name of a model with these values; made once."""
        for name, known in self.models.items():
            if known == (kind, values):
                return name
        name = f"m{len(self.models)}"
        self.models[name] = (kind, values)
        return name

    def valve(self, nodes, vt=None, vh=0.0, state=None):
        """A switch of this circuit's kind; by default half of a gate closes it."""
        values = {"ron": self.ron, "vt": self.gate / 2 if vt is None else vt, "vh": vh}
        if self.roff is not None:
            values["roff"] = self.roff
        return self.put("s", nodes, model=self.one_model("SW", values), state=state)

    def rectifier(self, nodes):
        return self.put("d", nodes, model=self.one_model("D", self.diodes) if self.diodes else None)

    def transistor(self, drain, source, gate):
        """A switch with an antiparallel diode, and at times what they have in parallel."""
        self.valve(f"{drain} {source} {gate} 0")
        self.rectifier(f"{source} {drain}")
        if self.maybe(self.parasitics):
            inner = f"q{self.count['s']}"
            self.put("c", f"{drain} {inner}", self.period / self.ohms * self.spread(1e-4, 1e-2))
            self.put("r", f"{inner} {source}", self.ohms * self.spread(0.1, 3))

    def half(self, ends, control):
        """A switch that compares two waves, with its antiparallel diode."""
        self.valve(f"{ends} {control}", vt=0.0)
        self.rectifier(" ".join(reversed(ends.split())))

    def wire(self, node):
        """The node, or one behind a stray coil or resistance."""
        if not self.maybe(self.parasitics):
            return node
        end = f"w{sum(self.count.values())}"
        if self.maybe(0.5):
            self.put("l", f"{node} {end}", self.ohms * self.period * self.spread(1e-4, 1e-2))
            self.put("r", f"{node} {end}", self.ohms * self.spread(1, 100))
        else:
            self.put("r", f"{node} {end}", self.ohms * self.spread(1e-5, 1e-2))
        return end

    def pair_of_gates(self, name, duty, delay, period=None, dead=0.0):
        """Commands of an upper and a lower switch, high one after the other."""
        period = period or self.period
        edge = self.random.choice((0.0, 1e-3, 1e-2)) * period if dead == 0 else 0.0
        self.put("v", f"{name}u 0", function=("pulse", [0.0, self.gate, delay, edge, edge,
                                                        (duty - dead) * period - edge, period]))
        if dead == 0 and edge > 0:
            self.put("b", f"{name}l 0", formula=("v", f"{self.gate!r}-v({name}u)"))
        else:
            self.put("v", f"{name}l 0", function=("pulse", [0.0, self.gate, delay + duty * period, edge, edge,
                                                            (1 - duty - dead) * period, period]))
        return f"{name}u", f"{name}l"

    def carrier(self, node, shift=0.0, low=-1.0, high=1.0, period=None):
        """A triangle, `shift` periods late."""
        period = period or self.period
        self.put("v", f"{node} 0", function=("pulse", [low, high, (shift - 1) * period if shift else 0.0, period / 2,
                                                       period / 2, 0.0, period]))
        return node

    def thyristor(self, anode, cathode, gate):
        """Diode, switch and a latch that the gate sets and the current holds."""
        k = self.count.get("s", 0) + 1
        volts, ohms = self.volts, self.ohms
        meter = self.put("v", f"{anode} t{k}a", dc=0.0)
        self.rectifier(f"t{k}a t{k}b")
        self.valve(f"t{k}b {cathode} t{k}g 0", vt=0.5, vh=self.random.choice((0.1, 0.3)))
        gain = self.random.choice((30.0, 1e3)) * ohms / volts
        self.put("b", f"t{k}g 0", formula=("v", f"v({gate})/{self.gate!r}+min(1,max(0,{gain!r}*i({meter})))"))

    def firing(self, node, start, period, width=0.03):
        self.put("v", f"{node} 0", function=("pulse", [0.0, self.gate, start, 1e-4 * period, 1e-4 * period,
                                                       width * period, period]))
        return node

    def coil(self, a, b, henries):
        """With its resistance at times."""
        if self.maybe(0.5):
            inner = f"x{self.count.get('l', 0) + 1}"
            self.put("l", f"{a} {inner}", henries)
            self.put("r", f"{inner} {b}", self.ohms * self.spread(1e-4, 1e-1))
        else:
            self.put("l", f"{a} {b}", henries)


def phase_controlled(c):
    """A bridge of two, four or six thyristors with latches on a coil and a resistance."""
    c.period = c.spread(1e-3, 1e-1)
    phases = c.random.choice((1, 2, 3))
    delay = c.random.uniform(0.02, 0.3)
    names = "abc"[:phases]
    for k, name in enumerate(names):
        c.sine(f"{name}s n", c.volts, 1 / c.period, 360.0 * k / max(phases, 2))
        if c.maybe(0.6):
            c.put("l", f"{name}s {name}", c.ohms * c.period * c.spread(1e-4, 1e-2))
        else:
            c.put("r", f"{name}s {name}", c.ohms * c.spread(1e-4, 1e-2))
    if phases == 1:
        c.put("r", "n 0", c.spread(1e-3, 1e-1))
        c.put("r", "m 0", 1e-3 * c.ohms)
    for k, name in enumerate(names):
        first = (-k / max(phases, 2) + delay) % 1.0
        for high in (True, False):
            if not high and phases == 1:
                continue
            start = (first + (0.0 if high else 0.5)) % 1.0 * c.period
            gate = c.firing(f"{name}{'u' if high else 'd'}", start, c.period, c.random.choice((0.03, 0.3)))
            c.thyristor(*((name, "p") if high else ("m", name)), gate)
    c.coil("p", "o", c.ohms * c.period * c.spread(1e-2, 3))
    c.put("r", "o m", c.ohms)
    if c.maybe(0.4):
        c.rectifier("m p")
    if phases > 1 and c.maybe(0.5):
        c.put("r", c.random.choice(("n 0", "m 0", "o 0")), c.random.choice((1e-3, 1.0, 1e6)))
    c.lasts(c.period * c.random.uniform(1.5, 3))


def triacs(c):
    """One or three pairs of antiparallel thyristors before a load, a star or a delta."""
    c.period = c.spread(1e-3, 1e-1)
    three = c.maybe(0.6)
    delay = c.random.uniform(0.05, 0.35)
    delta = c.maybe(0.4)
    for k, name in enumerate("abc" if three else "a"):
        c.sine(f"{name}s 0", c.volts, 1 / c.period, -120.0 * k)
        width = c.random.choice((0.02, 0.2))
        up = c.firing(f"{name}u", (k / 3 + delay) % 1.0 * c.period, c.period, width)
        down = c.firing(f"{name}d", (k / 3 + delay + 0.5) % 1.0 * c.period, c.period, width)
        c.thyristor(f"{name}s", name, up)
        c.thyristor(name, f"{name}s", down)
        end = ("y" if not delta else "abc"[(k + 1) % 3]) if three else "0"
        if c.maybe(0.6):
            c.put("l", f"{name} {name}i", c.ohms * c.period * c.spread(1e-3, 0.5))
            c.put("r", f"{name}i {end}", c.ohms)
        else:
            c.put("r", f"{name} {end}", c.ohms)
        if c.maybe(0.3):
            c.put("r", f"{name}s {name}k", c.ohms * 10)
            c.put("c", f"{name}k {name}", c.period / c.ohms * 1e-4)
    c.lasts(c.period * c.random.uniform(1.5, 2.5))


def inverters(c):
    """Two to eighteen legs on one supply, their loads in a star or a ring, by clocks, dead times or triangles."""
    legs = c.random.choice((1, 2, 3, 3, 5, 6, 9, 12, 18))
    c.put("v", "in 0", dc=c.volts)
    c.put("r", "in p0", c.ohms * c.spread(1e-4, 1e-2))
    top = c.wire("p0")
    if c.maybe(0.5):
        c.put("c", "p0 0", c.period / c.ohms * c.spread(1, 100), initial=c.volts)
    how = c.random.choice(("clocks", "dead", "triangle", "phases"))
    turn = c.period * c.random.choice((9.0, 15.0, 17.3))
    ring = legs > 1 and c.maybe(0.3)
    if how == "triangle":
        c.carrier("tri")
    for k in range(legs):
        duty = c.random.uniform(0.2, 0.8)
        if how == "triangle":
            c.sine(f"ref{k} 0", c.random.uniform(0.5, 0.95), 1 / turn, 360.0 * k / legs)
            c.half(f"{top} a{k}", f"ref{k} tri")
            c.half(f"a{k} 0", f"tri ref{k}")
        else:
            period = c.period * (c.random.uniform(0.6, 1.7) if how == "clocks" else 1.0)
            delay = c.period * k / legs if how == "phases" else c.period * c.random.random()
            dead = c.random.choice((0.02, 0.1)) if how == "dead" else 0.0
            up, down = c.pair_of_gates(f"g{k}", duty, delay, period, dead)
            c.transistor(top, f"a{k}", up)
            c.transistor(f"a{k}", "0", down)
        c.coil(f"a{k}", f"b{k}", c.ohms * c.period * c.spread(0.3, 30))
        end = f"a{(k + 1) % legs}" if ring else "y" if legs > 1 else "0"
        c.put("r", f"b{k} {end}", c.ohms * c.random.uniform(0.5, 2))
    if legs > 1 and not ring and c.maybe(0.3):
        c.put("c", "y 0", c.period / c.ohms * c.spread(1e-3, 1))
    c.lasts(turn * 1.1 if how == "triangle" else c.period * c.random.uniform(4, 10))


def matrix_converters(c):
    """Two or three inputs to one to three outputs by switches that conduct both ways, in turn."""
    ins, outs = c.random.choice((2, 3, 3)), c.random.choice((1, 2, 3, 3))
    for k in range(ins):
        c.sine(f"s{k} 0", c.volts, 1 / (c.period * c.random.uniform(18, 22)), 360.0 * k / ins)
        if c.maybe(0.5):
            c.put("l", f"s{k} i{k}", c.ohms * c.period * c.spread(1e-3, 1e-1))
        else:
            c.put("r", f"s{k} i{k}", c.ohms * c.spread(1e-4, 1e-2))
        c.put("c", f"i{k} {'0' if k == 0 else f'i{k - 1}'}", c.period / c.ohms * c.spread(0.03, 3))
    for j in range(outs):
        cuts = sorted(c.random.uniform(0.1, 0.9) for _ in range(ins - 1))
        cuts = [0.0] + cuts + [1.0]
        period = c.period * (c.random.uniform(0.8, 1.25) if c.maybe(0.3) else 1.0)
        for k in range(ins):
            width = (cuts[k + 1] - cuts[k]) * period
            delay = cuts[k] * period - period
            c.put("v", f"g{k}{j} 0", function=("pulse", [0.0, c.gate, delay, 0.0, 0.0, width, period]))
            c.valve(f"i{k} o{j} g{k}{j} 0")
        c.coil(f"o{j}", f"l{j}", c.ohms * c.period * c.spread(0.3, 30))
        c.put("r", f"l{j} {'y' if outs > 1 else '0'}", c.ohms)
        # While an edge of a command lasts, or two are not at one instant, the current has a way.
        c.put("r", f"o{j} u{j}", c.ohms * 3)
        c.put("c", f"u{j} 0", c.period / c.ohms * c.spread(1e-4, 1e-2))
    c.lasts(c.period * c.random.uniform(6, 20))


def three_levels(c):
    """NPC legs or a Vienna rectifier, with ideal parts or not."""
    legs = c.random.choice((1, 2, 3))
    if c.maybe(0.5):
        c.title = c.title.replace("three_levels", "npc")
        c.put("v", "in m", dc=c.volts)
        c.put("r", "in p", c.ohms * c.spread(1e-4, 1e-1))
        for ends in ("p o", "o m"):
            c.put("c", ends, c.period / c.ohms * c.spread(1, 100), initial=c.volts / 2)
        c.put("r", "o 0", c.random.choice((1e-3, 1.0, 1e6)))
        for k in range(legs):
            up, down = c.pair_of_gates(f"g{k}", c.random.uniform(0.2, 0.8), c.period * k / 3,
                                       c.period * c.random.choice((1.0, 1.0, 0.83)))
            if c.maybe(0.5):
                other, another = c.pair_of_gates(f"h{k}", c.random.uniform(0.2, 0.8), c.period * (k + 0.5) / 3)
            else:
                other, another = up, down
            c.transistor("p", f"x{k}u", up)
            c.transistor(f"x{k}u", f"a{k}", other)
            c.transistor(f"a{k}", f"x{k}d", down)
            c.transistor(f"x{k}d", "m", another)
            c.rectifier(f"o x{k}u")
            c.rectifier(f"x{k}d o")
            c.coil(f"a{k}", f"b{k}", c.ohms * c.period * c.spread(0.3, 10))
            c.put("r", f"b{k} {'o' if legs == 1 else 'y'}", c.ohms)
    else:
        c.title = c.title.replace("three_levels", "vienna")
        turn = c.period * c.random.uniform(15, 25)
        for k in range(legs):
            c.sine(f"s{k} n", c.volts, 1 / turn, -360.0 * k / max(legs, 2))
            c.coil(f"s{k}", f"a{k}", c.ohms * c.period * c.spread(0.3, 10))
            c.pulse(f"g{k} 0", c.gate, c.period, c.random.uniform(0.1, 0.8), delay=c.period * k / 3,
                    edge=c.random.choice((0.0, 0.01)) * c.period)
            c.rectifier(f"a{k} p")
            c.rectifier(f"m a{k}")
            if c.maybe(0.5):
                c.valve(f"a{k} o g{k} 0")
            else:
                for ends in (f"a{k} e{k}", f"o e{k}", f"f{k} a{k}", f"f{k} o"):
                    c.rectifier(ends)
                c.valve(f"e{k} f{k} g{k} 0")
        if legs == 1:
            c.put("r", "n o", c.spread(1e-3, 1e-1))
        for ends in ("p o", "o m"):
            c.put("c", ends, c.period / c.ohms * c.spread(3, 100), initial=c.volts * c.random.choice((0.0, 1.2)))
            c.put("r", ends, c.ohms * c.random.uniform(1, 5))
        c.put("r", "o 0", c.random.choice((1e-3, 1.0, 1e6)))
    c.lasts(c.period * c.random.uniform(5, 18))


def cascaded_bridges(c):
    """H-bridges in a chain, each on a source or a capacitor of its own."""
    cells = c.random.choice((1, 2, 3, 5, 8))
    turn = c.period * c.random.choice((7.0, 11.3))
    shifted = c.maybe(0.5)
    c.sine("ref 0", c.random.uniform(0.5, 0.95), 1 / turn)
    c.put("e", "neg 0 0 ref", 1.0)
    node = "0"
    for k in range(cells):
        p, m, a, b = f"p{k}", f"m{k}", node, f"n{k}"
        if c.maybe(0.6):
            c.put("v", f"{p}s {m}", dc=c.volts / cells)
            c.put("r", f"{p}s {p}", c.ohms * c.spread(1e-4, 1e-2))
        else:
            c.put("c", f"{p} {m}", c.period / c.ohms * c.spread(3, 300), initial=c.volts / cells)
            c.put("r", f"{p} {m}", c.ohms * c.spread(10, 1000))
        tri = c.carrier(f"tri{k}", k / (2 * cells) if shifted else 0.0)
        for leg, wave in ((a, "ref"), (b, "neg")):
            c.half(f"{p} {leg}", f"{wave} {tri}")
            c.half(f"{leg} {m}", f"{tri} {wave}")
        node = b
    c.coil(node, "l", c.ohms * c.period * c.spread(0.3, 10))
    c.put("r", "l 0", c.ohms)
    c.lasts(turn * 1.05)


def modular_leg(c):
    """Two arms of half bridges with capacitors, up to twenty cells an arm, between two halves of a supply."""
    cells = c.random.choice((1, 2, 4, 7, 20))
    turn = c.period * c.random.choice((8.0, 12.7))
    c.put("v", "p 0", dc=c.volts / 2)
    c.put("v", "0 m", dc=c.volts / 2)
    c.sine("refu 0", -0.5 * c.random.uniform(0.5, 0.9), 1 / turn)
    c.put("e", "refd 0 0 refu", 1.0)
    for arm, (node, end) in enumerate((("p", "out"), ("out", "m"))):
        for k in range(cells):
            name = f"{'ud'[arm]}{k}"
            c.carrier(f"t{name}", (k + 0.5 * arm) / cells, -0.5, 0.5)
            below = f"{name}x"
            wave = f"ref{'ud'[arm]}"
            if c.maybe(0.2):
                c.put("b", f"g{name} 0", formula=("v", f"v({wave})>v(t{name}) ? 1 : -1"))
                first, second = f"g{name} 0", f"0 g{name}"
            else:
                first, second = f"{wave} t{name}", f"t{name} {wave}"
            c.half(f"{name}c {node}", first)
            c.half(f"{node} {below}", second)
            c.put("c", f"{name}c {below}", c.period / c.ohms * c.spread(3, 30) * cells, initial=c.volts / cells)
            node = below
        c.coil(node, end, c.ohms * c.period * c.spread(0.3, 3))
    c.coil("out", "l", c.ohms * c.period * c.spread(0.3, 3))
    c.put("r", "l 0", c.ohms)
    c.lasts(turn * 0.7)


def synchronous(c):
    """Rectifiers whose switches read their own voltage, beside their body diodes."""
    turn = c.period * c.random.choice((1.0, 10.0))
    c.ron = c.random.choice((1e-3, 1e-2, 0.1))
    values = {"ron": c.ron, "vt": c.random.choice((0.0, 1e-3, 0.2)), "vh": 0.0}
    values["vh"] = c.random.choice((0.0, 0.5)) * values["vt"]
    if c.maybe(0.7):
        values["roff"] = 1e6
    bridge = c.maybe(0.5)

    def valve(a, k):
        c.put("s", f"{a} {k} {a} {k}", model=c.one_model("SW", values))
        c.rectifier(f"{a} {k}")

    if c.maybe(0.5):
        c.sine("in x", c.volts, 1 / turn)
    else:
        c.put("v", "in x", function=("pulse", [-c.volts, c.volts, 0.0, 0.0, 0.0, turn / 2, turn]))
    c.put("r", "in a", c.ohms * c.spread(1e-3, 1e-1))
    if c.maybe(0.4):
        c.put("l", "in a", c.ohms * turn * c.spread(1e-3, 1e-1))
    if bridge:
        valve("a", "p")
        valve("x", "p")
        valve("0", "a")
        valve("0", "x")
    else:
        c.put("r", "x 0", c.ohms * 1e-3)
        valve("a", "p")
    if c.maybe(0.5):
        c.coil("p", "o", c.ohms * turn * c.spread(0.01, 3))
        if not bridge or c.maybe(0.5):
            valve("0", "p")
    else:
        c.put("r", "p o", c.ohms * c.spread(1e-4, 1e-2))
    c.put("c", "o 0", turn / c.ohms * c.spread(0.1, 30), initial=c.random.choice((0.0, 0.5 * c.volts)))
    c.put("r", "o 0", c.ohms)
    c.lasts(turn * c.random.uniform(3, 6))


def marx(c):
    """Capacitors that are charged side by side and discharged in a row, more than once."""
    stages = c.random.choice((2, 3, 5, 8, 12))
    by_diodes = c.maybe(0.5)
    cap = c.period / c.ohms
    c.volts = c.random.choice((1e3, 1e4, 3e4))
    c.put("v", "in 0", dc=c.volts)
    c.put("r", "in a0", c.ohms * c.spread(0.01, 0.1))
    c.pulse("g 0", c.gate, c.period * c.random.choice((1.0, 1.37)), c.random.uniform(0.05, 0.3), delay=c.period * 0.7)
    for k in range(stages):
        c.put("c", f"a{k} b{k}", cap, initial=c.random.choice((0.0, c.volts)))
        if k:
            if by_diodes:
                c.rectifier(f"a{k - 1} a{k}")
                if c.maybe(0.5):
                    c.rectifier(f"b{k} b{k - 1}")
                else:
                    c.put("r", f"b{k} b{k - 1}", c.ohms * c.spread(1, 10))
            else:
                c.put("r", f"a{k - 1} a{k}", c.ohms * c.spread(1, 10))
                c.put("r", f"b{k} b{k - 1}", c.ohms * c.spread(1, 10))
            c.valve(f"a{k - 1} b{k} g 0")
    c.put("r", "b0 0", c.ohms * c.spread(1e-3, 1e-2))
    c.put("r", f"a{stages - 1} load", c.ohms * c.spread(1e-2, 1))
    if c.maybe(0.5):
        c.valve("load z g 0")
        c.put("r", "z 0", c.ohms)
    else:
        c.put("r", "load 0", c.ohms * 10)
    c.lasts(c.period * c.random.uniform(2.5, 5))


def astable(c):
    """A capacitor between two thresholds, by a switch, a comparator, or two of them in a ring."""
    tau = c.period
    kind = c.random.choice(("switch", "comparator", "pair", "negative"))
    if kind == "switch":
        c.put("v", "in 0", dc=c.volts)
        c.put("r", "in a", c.ohms * 100)
        c.put("c", "a 0", tau / c.ohms / 100)
        c.ron = c.random.choice((0.0, 1e-4, 1e-2, 1.0)) * c.ohms
        high, low = c.volts * c.random.uniform(0.4, 0.8), c.volts * c.random.uniform(0.0, 0.3)
        c.valve("a b a 0", (high + low) / 2, (high - low) / 2)
        c.put("r", "b 0", c.ohms * c.spread(1e-3, 1.0))
        if c.maybe(0.4):
            c.elements[-1].nodes[1] = "b2"
            c.put("l", "b2 0", c.ohms * tau * c.spread(1e-6, 1e-3))
    elif kind == "comparator":
        share, gain = c.random.uniform(0.2, 0.7), c.random.choice((1e3, 1e6))
        c.put("b", "out 0", formula=("v", f"limit({gain!r}*(v(p)-v(a)),{-c.volts!r},{c.volts!r})"))
        c.put("r", "out p", c.ohms)
        c.put("r", "p 0", c.ohms * share / (1 - share))
        if c.maybe(0.5):
            c.put("c", "p 0", tau / c.ohms * c.spread(1e-6, 1e-2))
        c.put("r", "out a", c.ohms)
        c.put("c", "a 0", tau / c.ohms, initial=0.1)
    elif kind == "pair":
        c.put("v", "in 0", dc=c.volts)
        for a, b in (("x", "y"), ("y", "x")):
            c.put("r", f"in {a}", c.ohms * c.random.uniform(0.8, 1.2))
            c.put("r", f"in g{a}", c.ohms * 20)
            c.put("c", f"{b} g{a}", tau / c.ohms * c.random.uniform(0.04, 0.06),
                  initial=0.0 if a == "x" else -0.5 * c.volts)
            c.rectifier(f"g{a} k{a}")
            c.put("v", f"k{a} 0", dc=c.volts * 0.06)
            c.ron = c.ron or 1e-2
            c.valve(f"{a} 0 g{a} 0", c.volts * 0.05, c.volts * 0.005)
    else:
        c.put("i", "0 a", dc=c.volts / c.ohms)
        c.put("c", "a 0", tau / c.ohms, initial=0.2 * c.volts)
        c.roff = c.roff or 1e6
        c.valve("a q a 0", c.volts * 0.5, c.volts * 0.3)
        c.put("v", "q 0", dc=c.volts * c.random.uniform(-0.5, 0.1))
        c.ron = 0.0
        c.put("r", "a 0", c.ohms * c.spread(30, 1e4))
        if c.maybe(0.5):
            model = c.models[c.element("s1").model][1]
            model["ron"] = c.ohms * c.spread(1e-4, 1e-1)
    c.lasts(tau * c.random.uniform(3, 8))


def stars(c):
    """Three to six phases without a neutral on diodes, switches and resistors in a star, a delta or both."""
    phases = c.random.choice((3, 3, 5, 6))
    c.period = c.spread(1e-4, 1e-1)
    delta = c.maybe(0.4)
    for k in range(phases):
        if delta:
            c.sine(f"s{k} d{(k + 1) % phases}", c.volts, 1 / c.period, 360.0 * k / phases)
            c.put("r", f"d{k} s{k}", c.ohms * c.spread(1e-4, 1e-2))
        else:
            c.sine(f"s{k} n", c.volts, 1 / c.period, 360.0 * k / phases)
        c.put("l", f"s{k} a{k}", c.ohms * c.period * c.spread(1e-4, 1e-1))
    kinds = []
    for k in range(phases):
        kind = c.random.choice(("diode", "resistor", "coil", "switch", "pair"))
        kinds.append(kind)
        node = f"a{k}"
        if kind == "diode":
            c.rectifier(f"{node} y")
        elif kind == "coil":
            c.put("l", f"{node} z{k}", c.ohms * c.period * c.spread(0.01, 1))
            c.put("r", f"z{k} y", c.ohms)
        elif kind == "switch":
            c.pulse(f"g{k} 0", c.gate, c.period * c.random.uniform(0.05, 0.4), c.random.uniform(0.3, 0.7))
            c.put("r", f"{node} z{k}", c.ohms)
            c.valve(f"z{k} y g{k} 0")
            c.put("r", f"{node} zz{k}", c.ohms * 2)
            c.put("c", f"zz{k} y", c.period / c.ohms * 1e-2)
        elif kind == "pair":
            c.put("r", f"{node} z{k}", c.ohms * c.random.uniform(0.5, 2))
            c.rectifier(f"z{k} y")
            c.rectifier(f"y zx{k}")
            c.put("r", f"zx{k} {node}", c.ohms * c.random.uniform(0.5, 2))
        else:
            c.put("r", f"{node} y", c.ohms * c.random.uniform(0.5, 2))
    if c.maybe(0.5):
        for k in range(phases):
            c.rectifier(f"a{k} p")
            c.rectifier(f"m a{k}")
        c.put("c", "p m", c.period / c.ohms * c.spread(0.01, 3))
        c.put("r", "p m", c.ohms)
    if c.maybe(0.4):
        c.put("r", f"y {c.random.choice(('0', 's0'))}", c.random.choice((1e6, c.ohms)))
    c.lasts(c.period * c.random.uniform(2, 4))


def amplifiers(c):
    """Op-amps with rails in loops: integrators with comparators, precise rectifiers, a regulated converter."""
    tau, rail = c.period, c.random.choice((5.0, 15.0))
    gain = c.random.choice((1e3, 1e5, 1e6))
    kind = c.random.choice(("generator", "rectifier", "regulator", "clamp"))

    def amplifier(out, plus, minus, pole=False):
        difference = f"-v({minus})" if plus == "0" else f"v({plus})" if minus == "0" else f"v({plus})-v({minus})"
        if pole:
            c.put("b", f"{out}i 0", formula=("v", f"limit({gain!r}*({difference}),{-rail!r},{rail!r})"))
            c.put("r", f"{out}i {out}j", 1e3)
            c.put("c", f"{out}j 0", tau * 1e-6)
            c.put("e", f"{out} 0 {out}j 0", 1.0)
        else:
            c.put("b", f"{out} 0", formula=("v", f"limit({gain!r}*({difference}),{-rail!r},{rail!r})"))

    if kind == "generator":
        amplifier("sq", "p", "0")
        c.put("r", "sq p", c.ohms * c.random.uniform(1.2, 4))
        c.put("r", "tri p", c.ohms)
        c.put("r", "sq n", c.ohms)
        amplifier("tri", "0", "n", c.maybe(0.3))
        c.put("c", "n tri", tau / c.ohms, initial=0.1)
    elif kind == "rectifier":
        c.sine("in 0", rail * c.random.uniform(0.1, 1.5), 1 / tau)
        c.put("r", "in n", c.ohms)
        amplifier("o", "0", "n", c.maybe(0.3))
        c.rectifier("o a")
        c.put("r", "a n", c.ohms)
        c.rectifier("n o")
        amplifier("s", "0", "m", c.maybe(0.3))
        c.put("r", "a m", c.ohms / 2)
        c.put("r", "in m", c.ohms)
        c.put("r", "m s", c.ohms)
        if c.maybe(0.5):
            c.put("c", "m s", tau / c.ohms * c.spread(1e-3, 1))
    elif kind == "regulator":
        c.put("v", "in 0", dc=c.volts)
        c.put("v", "ref 0", dc=0.4 * rail)
        c.put("v", "saw 0", function=("pulse", [0.0, rail, 0.0, 0.99 * tau, 0.005 * tau, 0.0, tau]))
        c.put("r", "fb n", c.ohms)
        c.put("r", "n z", c.ohms * c.spread(0.3, 10))
        c.put("c", "z u", tau / c.ohms * c.spread(1, 30))
        amplifier("u", "ref", "n", c.maybe(0.3))
        c.valve("in sw u saw", 0.0, c.random.choice((0.0, 1e-2)))
        c.rectifier("0 sw")
        c.put("l", "sw out", c.ohms * tau * c.spread(1, 10))
        c.put("c", "out 0", tau / c.ohms * c.spread(1, 30))
        c.put("r", "out 0", c.ohms)
        c.put("e", "fb 0 out 0", 0.8 * rail / c.volts)
    else:
        c.sine("in 0", rail * c.random.uniform(0.5, 3), 1 / tau)
        c.put("r", "in x", c.ohms)
        amplifier("u", "ref", "x")
        c.put("v", "ref 0", dc=rail * c.random.uniform(0.1, 0.7))
        c.rectifier("x u" if c.maybe(0.5) else "u x")
        c.put("r", "x 0", c.ohms * 10)
        if c.maybe(0.5):
            c.put("c", "x 0", tau / c.ohms * c.spread(1e-3, 0.3))
    c.lasts(tau * c.random.uniform(4, 12))


KINDS = (phase_controlled, triacs, inverters, matrix_converters, three_levels, cascaded_bridges, modular_leg,
         synchronous, marx, astable, stars, amplifiers)


def draw(seed):
    """The circuit of a seed: kinds in turn."""
    kind = KINDS[seed % len(KINDS)]
    circuit = Power(kind.__name__, seed)
    kind(circuit)
    circuit.default_signals()
    return circuit
