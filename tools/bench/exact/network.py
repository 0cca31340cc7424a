"""A netlist as E x' = A x for each mode of its diodes and switches.

x holds the node voltages, the currents of sources, inductors, diodes and switches, and the sources
themselves: 1 for what is constant, and a sine and a cosine for each frequency, which obey their own
differential equation. So every mode is a linear system without inputs."""

import math
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2]))
import near_ideal  # noqa: E402

from matrices import D, ONE, ZERO, zeros  # noqa: E402

# Where a part floats, or conducting diodes form a ring, the micro-step that selects the mode has no
# unique answer. Equal leaks across blocking diodes put what floats in the middle. They must be far below
# what happens in a micro-step, which is of second order in its length.
LEAK = D("1e-50")
PI = D("3.1415926535897932384626433832795028841971693993751058209749445923078164062862089986280"
       "348253421170679")


def decimal_number(text):
    return D(repr(near_ideal.number(text)))


class Gate:
    """A PULSE source with edges of no width: a level that changes at known times."""

    def __init__(self, values):
        values = values + [0.0] * (7 - len(values))
        self.low, self.high = D(repr(values[0])), D(repr(values[1]))
        delay, rise, fall, width, period = (D(repr(value)) for value in values[2:7])
        if rise or fall:
            raise ValueError("the reference knows edges of no width only")
        self.delay, self.width, self.period = delay, width, period

    def level(self, time):
        """Just behind `time`."""
        if time < self.delay:
            return self.low
        return self.high if (time - self.delay) % self.period < self.width else self.low

    def changes(self, stop):
        k = 0
        while self.delay + k * self.period < stop:
            yield self.delay + k * self.period
            yield self.delay + k * self.period + self.width
            k += 1


class Network:
    """Elements with their nodes; E, A(mode), the guards and the signals."""

    def __init__(self, text):
        _, cards = near_ideal.logical_lines(text)
        self.models = near_ideal.read_models(cards)
        _, tran, _ = near_ideal.analyses(cards)
        self.stop = D(repr(tran[1]))
        self.saved = next((near_ideal.re.findall(r"[vi]\([^)]*\)", card) for card in cards
                           if card.startswith(".save")), [])
        self.elements = [near_ideal.words(card) for card in cards if not card.startswith(".")]
        self.diodes = [e[0] for e in self.elements if e[0][0] == "d"]
        self.switches = {e[0]: e for e in self.elements if e[0][0] == "s"}
        self.gates = {}
        self.frequencies = []
        self._index()
        self._inductances()

    def _index(self):
        self.index = {}
        for name, *rest in self.elements:
            for node in rest[:0 if name[0] == "k" else 2]:
                if node != "0":
                    self.index.setdefault(f"v({node})", len(self.index))
        for name, *rest in self.elements:
            if name[0] in "vlds":
                self.index[f"i({name})"] = len(self.index)
            if name[0] == "v" and "sin" in rest:
                frequency = decimal_number(rest[rest.index("sin") + 3])
                if frequency not in self.frequencies:
                    self.frequencies.append(frequency)
            if name[0] == "v" and "pulse" in rest:
                self.gates[rest[0]] = Gate([near_ideal.number(word)
                                            for word in rest[rest.index("pulse") + 1:]])
        self.n_physical = len(self.index)
        self.index["one"] = len(self.index)
        for frequency in self.frequencies:
            self.index[f"sin {frequency}"] = len(self.index)
            self.index[f"cos {frequency}"] = len(self.index)
        self.n = len(self.index)

    def _inductances(self):
        value = {e[0]: decimal_number(e[3]) for e in self.elements if e[0][0] == "l"}
        self.inductance = {(name, name): size for name, size in value.items()}
        for name, *rest in self.elements:
            if name[0] == "k":
                first, second, factor = rest
                mutual = decimal_number(factor) * (value[first] * value[second]).sqrt()
                self.inductance[first, second] = self.inductance[second, first] = mutual

    def node(self, name):
        return None if name == "0" else self.index[f"v({name})"]

    def _across(self, row, plus, minus, factor=ONE):
        for node, sign in ((plus, factor), (minus, -factor)):
            if node != "0":
                row[self.node(node)] += sign

    def _through(self, a, plus, minus, column):
        for node, sign in ((plus, -ONE), (minus, ONE)):
            if node != "0":
                a[self.node(node)][column] += sign

    def _two_pole(self, matrix, plus, minus, value):
        for node, sign in ((plus, value), (minus, -value)):
            if node != "0":
                self._across(matrix[self.node(node)], plus, minus, sign)

    def storage(self):
        """E, and E x at t = 0 with the initial conditions of the netlist."""
        e, start = zeros(self.n, self.n), [ZERO] * self.n
        initial = {}
        for name, *rest in self.elements:
            initial[name] = decimal_number(rest[rest.index("ic") + 1]) if "ic" in rest else ZERO
            if name[0] == "c":
                plus, minus, size = rest[0], rest[1], decimal_number(rest[2])
                self._two_pole(e, plus, minus, size)
                for node, sign in ((plus, 1), (minus, -1)):
                    if node != "0":
                        start[self.node(node)] += sign * size * initial[name]
        for (first, second), size in self.inductance.items():
            row = self.index[f"i({first})"]
            e[row][self.index[f"i({second})"]] += size
            start[row] += size * initial[second]
        for k in range(self.n_physical, self.n):
            e[k][k] = ONE
        start[self.index["one"]] = ONE
        for frequency in self.frequencies:
            start[self.index[f"cos {frequency}"]] = ONE
        return e, start

    def dynamics(self, on, time, leak=False):
        """A; `on` holds the names of conducting diodes and closed switches."""
        a = zeros(self.n, self.n)
        for name, *rest in self.elements:
            plus, minus = rest[0], rest[1]
            if name[0] == "r":
                self._two_pole(a, plus, minus, -1 / decimal_number(rest[2]))
            if name[0] not in "vlds":
                continue
            column = self.index[f"i({name})"]
            self._through(a, plus, minus, column)
            row = a[column]
            if name in on:
                self._across(row, plus, minus)
                if name[0] == "s":
                    model = self.models[rest[4]]
                    row[column] -= D(repr(model.get("ron", 1.0)))
                elif leak:
                    row[column] -= LEAK
            elif name[0] in "ds":
                row[column] = ONE
                if leak:
                    self._across(row, plus, minus, -LEAK)
            else:
                self._across(row, plus, minus)
                if name[0] == "v":
                    self._source(row, rest[2:], rest[0], time)
        for frequency in self.frequencies:
            omega = 2 * PI * frequency
            sine, cosine = self.index[f"sin {frequency}"], self.index[f"cos {frequency}"]
            a[sine][cosine], a[cosine][sine] = omega, -omega
        return a

    def _source(self, row, description, node, time):
        one = self.index["one"]
        if "sin" in description:
            values = [decimal_number(word) for word in description[description.index("sin") + 1:]]
            offset, amplitude, frequency = values[:3]
            phase = values[5] if len(values) > 5 else ZERO
            row[one] -= offset
            cosine, sine = cos_sin(phase)
            row[self.index[f"sin {frequency}"]] -= amplitude * cosine
            row[self.index[f"cos {frequency}"]] -= amplitude * sine
        elif "pulse" in description:
            row[one] -= self.gates[node].level(time)
        else:
            row[one] -= decimal_number(description[-1])

    def closed_switches(self, time):
        """Which switches are closed just behind `time`: their controls must be gates."""
        closed = set()
        for name, words in self.switches.items():
            gate, threshold = self.gates[words[3]], self.models[words[5]].get("vt", 0.0)
            if gate.level(time) > threshold:
                closed.add(name)
        return closed

    def edges(self):
        times = {time for gate in self.gates.values() for time in gate.changes(self.stop)}
        return sorted(time for time in times if 0 < time < self.stop)

    def guard(self, diode, on):
        """The row of x that must not be negative: the current, or the reverse voltage."""
        row = [ZERO] * self.n
        if diode in on:
            row[self.index[f"i({diode})"]] = ONE
        else:
            words = next(e for e in self.elements if e[0] == diode)
            self._across(row, words[2], words[1])
        return row

    def signal(self, name):
        row = [ZERO] * self.n
        if name[0] == "i":
            row[self.index[name]] = ONE
        else:
            nodes = name[2:-1].split(",") + ["0"]
            self._across(row, nodes[0], nodes[1])
        return row


def cos_sin(degrees):
    """Of a phase; those of three-phase sources exactly."""
    half_root = D(3).sqrt() / 2
    table = {0: (ONE, ZERO), 90: (ZERO, ONE), 180: (-ONE, ZERO), 120: (-ONE / 2, half_root),
             -120: (-ONE / 2, -half_root)}
    if degrees in table:
        return table[degrees]
    angle = math.radians(float(degrees))
    return D(repr(math.cos(angle))), D(repr(math.sin(angle)))
