"""A netlist of a power converter, put together from parts with values and parasitics drawn at random."""

import collections
import math
import random


class Circuit:
    """Cards of a netlist, stray coils and capacitors strewn in at random, and the values that parts share.

    All that is drawn comes from one generator: another order of the calls gives another netlist.
    """

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.cards = []
        self.initial_conditions = []
        self.count = collections.Counter()  # of the names given, by letter
        self.gates = {}  # (duty, phase, period): node
        self.parasitics = self.random.choice([0, 0.12, 0.35])  # how likely one is
        self.from_initial_conditions = self.chance(0.6)
        self.frequency = self.spread(1e4, 1e6)
        self.period = 1 / self.frequency
        self.voltage = self.spread(5, 400)
        self.current = self.spread(0.1, 20)
        self.duty = self.random.uniform(0.1, 0.85)
        self.resistance = self.voltage / self.current  # of the load
        self.inductance = self.voltage / (self.frequency * self.current) * self.spread(0.05, 3)
        self.capacitance = self.current / (self.frequency * self.voltage) * self.spread(3, 300)
        self.edge = self.random.choice([0, 0, self.period * self.spread(1e-4, 1e-2)])
        self.stop = self.period * self.random.randint(20, 45)
        self.diode_model = self.random.choice([
            "",
            "",
            "",
            f"Ron={self.spread(1e-3, 0.1):.3g}",
            f"Ron={self.spread(1e-3, 0.1):.3g} Vfwd={self.random.uniform(0.2, 1):.3g}",
            f"Ron={self.spread(1e-3, 0.1):.3g} Roff={self.spread(1e5, 1e8):.3g}"])
        self.switch_model = "Vt=0.5" + self.random.choice([
            "",
            f" Ron={self.spread(1e-3, 0.1):.3g}",
            f" Ron={self.spread(1e-3, 0.1):.3g}",
            f" Ron={self.spread(1e-3, 0.1):.3g} Roff={self.spread(1e5, 1e8):.3g}"])

    def spread(self, low, high):
        """A number between the two whose logarithm is equally distributed."""
        return math.exp(self.random.uniform(math.log(low), math.log(high)))

    def chance(self, probability):
        return self.random.random() < probability

    def stray(self, factor=1):
        return self.chance(factor * self.parasitics)

    def new_name(self, letter):
        self.count[letter] += 1
        return f"{letter}{self.count[letter]}"

    def node(self):
        return self.new_name("n")

    def card(self, letter, *fields):
        """One element; of its fields, numbers are written with four digits and None is left out."""
        name = self.new_name(letter)
        words = [field if isinstance(field, str) else f"{field:.4g}" for field in fields if field is not None]
        self.cards.append(" ".join([name] + words))
        return name

    def initial(self, value):
        """The field that sets an initial value, where the netlist has any."""
        return None if value is None or not self.from_initial_conditions else f"ic={value:.4g}"

    def resistor(self, a, b, value):
        return self.card("R", a, b, value)

    def capacitor(self, a, b, value, initial=None):
        """At times in series with a resistance and a stray inductance."""
        if self.chance(0.5):
            inner = self.node()
            self.resistor(a, inner, self.spread(1e-4, 1))
            a = inner
        if self.stray(0.5):
            inner = self.node()
            self.card("L", a, inner, self.spread(1e-9, 5e-8))
            a = inner
        return self.card("C", a, b, value, self.initial(initial))

    def coil(self, a, b, value, initial=None):
        """At times beside a stray capacitor and in series with a resistance."""
        self.stray_capacitor(a, b, 0.4)
        if self.chance(0.6):
            inner = self.node()
            self.resistor(a, inner, self.spread(1e-4, 1) * min(1, self.resistance))
            a = inner
        return self.card("L", a, b, value, self.initial(initial))

    def wire(self, a):
        """A node behind a stray inductance, or a itself."""
        if not self.stray():
            return a
        b = self.node()
        self.card("L", a, b, self.spread(1e-9, 1e-6))
        if self.chance(0.9):
            self.resistor(a, b, self.spread(0.3, 100))
        return b

    def stray_capacitor(self, a, b, factor=1):
        """At times, and then at times behind a resistor."""
        if self.stray(factor):
            if self.chance(0.6):
                inner = self.node()
                self.resistor(a, inner, self.spread(0.3, 300))
                a = inner
            self.card("C", a, b, self.spread(1e-12, 1e-8))

    def diode(self, anode, cathode):
        self.stray_capacitor(anode, cathode)
        return self.card("D", self.wire(anode), cathode, "DI")

    def switch(self, a, b, gate, body_diode=False):
        if body_diode:
            self.diode(b, a)
        self.stray_capacitor(a, b)
        return self.card("S", a, b, gate, "0", "SW")

    def source(self, a, b, text):
        return self.card("V", a, b, text)

    def supply(self, node="in", resistance=None):
        """A constant source; at times, or with a resistance given, behind a resistor and a capacitor."""
        if resistance is None and not self.stray(2):
            self.source(node, "0", f"{self.voltage:.4g}")
            return
        inner = self.node()
        self.source(inner, "0", f"{self.voltage:.4g}")
        self.resistor(self.wire(inner), node, resistance or self.spread(1e-4, 1))
        self.capacitor(node, "0", self.capacitance * self.spread(0.1, 10), self.voltage)

    def gate(self, duty, phase=0.0, period=None):
        """The node of a clock; phase is in periods. Equal clocks are one."""
        period = period or self.period
        key = round(duty, 9), round(phase % 1, 9), period
        if key not in self.gates:
            node = self.gates[key] = self.new_name("g")
            width = max(duty * period - self.edge, 0.01 * period)
            self.source(node, "0", f"PULSE(0 1 {phase % 1 * period:.6g} {self.edge:.4g} {self.edge:.4g} "
                                   f"{width:.6g} {period:.8g})")
        return self.gates[key]

    def leg(self, high, low, out, duty, phase=0.0, period=None):
        """Two switches with body diodes, and a dead time between them."""
        dead = self.random.choice([0.005, 0.02, 0.05])
        self.switch(high, out, self.gate(duty - dead, phase, period), True)
        self.switch(out, low, self.gate(1 - duty - dead, phase + duty, period), True)

    def transformer(self, *coils):
        """Coupled coils, each (node, node, inductance)."""
        coupling = self.random.choice([1, 0.9999, 0.999, 0.99, 0.95])
        names = [self.card("L", a, b, value) for a, b, value in coils]
        self.cards.append(f"K{len(self.cards)} {' '.join(names)} {coupling:.5g}")

    def load(self, a="out", b="0", ratio=1.0):
        """A resistor beside a capacitor that starts, at times, at the ratio of the supply's voltage."""
        value = self.voltage * ratio
        self.capacitor(a, b, self.capacitance, value)
        if self.chance(0.3) and not self.from_initial_conditions:
            pair = a if b == "0" else f"{a},{b}"
            self.initial_conditions.append(f"v({pair})={value:.4g}")
        self.resistor(a, b, self.resistance)

    def use_mains(self):
        """From here on the period is one of the mains, and the values suit it."""
        self.period = 1 / self.random.choice([50, 60, 400, 1000])
        self.frequency = 1 / self.period
        self.stop = self.period * self.random.choice([2, 2.5, 3])
        self.capacitance = self.current / (self.frequency * self.voltage) * self.spread(0.3, 30)
        self.inductance = self.voltage / (self.frequency * self.current) * self.spread(1e-3, 0.3)
        self.edge = self.random.choice([0, 0, self.period * 1e-4])

    def sine(self, a, b, phase=0):
        """A sine behind a coil or a resistor; the phase is in degrees."""
        inner = self.node()
        self.source(inner, b, f"SIN(0 {self.voltage:.4g} {self.frequency:.6g} 0 0 {phase:g})")
        if self.chance(0.7):
            self.card("L", inner, a, self.inductance * self.spread(1e-3, 0.1))
        else:
            self.resistor(inner, a, self.spread(1e-3, 1))

    def bridge(self, inputs, plus, minus):
        for node in inputs:
            self.diode(node, plus)
            self.diode(minus, node)

    def text(self, title):
        save = self.random.choice([[], [".save v(*) i(*)"], []])
        lines = [title] + self.cards
        if self.count["D"]:
            lines.append(f".model DI D({self.diode_model})")
        if self.count["S"]:
            lines.append(f".model SW SW({self.switch_model})")
        if self.initial_conditions:
            lines.append(f".ic {' '.join(self.initial_conditions)}")
        lines += save
        start = " uic" if self.from_initial_conditions else ""
        lines += [f".tran {self.stop / 1000:.4g} {self.stop:.8g}{start}", ".end"]
        return "\n".join(lines) + "\n"
