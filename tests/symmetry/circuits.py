"""A circuit as data: read from a netlist (flattened, parasitics written out), and written as one.

What is not in the subset raises Unsupported. Signals are tuples: ("v", node, node) and ("i", element)."""

import copy
import math
import re

from values import Unsupported


class Element:
    """One card. `kind` is its letter; what it has beside nodes depends on that."""

    def __init__(self, name, nodes, value=None, **more):
        self.name = name
        self.kind = name[0]
        self.nodes = list(nodes)
        self.value = value  # ohms, farads, henries, a gain, the coefficient of K
        self.initial = more.pop("initial", None)
        self.dc = more.pop("dc", None)
        self.function = more.pop("function", None)  # ("pulse", [numbers])
        self.control = more.pop("control", None)  # V source of F, H and W
        self.model = more.pop("model", None)
        self.state = more.pop("state", None)  # ON or OFF of a switch
        self.formula = more.pop("formula", None)  # ("v" or "i", text)
        self.coils = more.pop("coils", None)
        if more:
            raise TypeError(f"no fields {', '.join(more)}")

    def output(self):
        """The nodes that carry current."""
        return self.nodes[:2] if self.kind in "egs" else self.nodes


class Circuit:
    def __init__(self, title=""):
        self.title = title
        self.elements = []
        self.models = {}  # name: (kind, {parameter: number})
        self.initial = []  # (signal, number)
        self.options = {}
        self.step = self.stop = 0.0
        self.uic = False
        self.measures = []  # (name, words of the card with times as numbers)
        self.signals = []

    def copy(self):
        return copy.deepcopy(self)

    def element(self, name):
        return next(e for e in self.elements if e.name == name)

    def of(self, kinds):
        return [e for e in self.elements if e.kind in kinds]

    def nodes(self):
        """All nodes but ground, in their order."""
        return list(dict.fromkeys(n for e in self.elements for n in e.nodes if n != "0"))

    def add(self, name, nodes, value=None, **more):
        if any(e.name == name for e in self.elements):
            raise ValueError(f"{name} is there")
        self.elements.append(Element(name, nodes, value, **more))
        return self.elements[-1]

    def islands(self):
        """For each node the first node of what it hangs together with; "0" if that is ground."""
        parent = {n: n for n in ["0"] + self.nodes()}

        def root(n):
            while parent[n] != n:
                n = parent[n]
            return n

        for e in self.elements:
            nodes = e.output()
            for other in nodes[1:]:
                a, b = root(nodes[0]), root(other)
                if a != b:
                    parent[max(a, b)] = min(a, b)
        return {n: root(n) for n in parent}

    def default_signals(self):
        """Node voltages, of a floating part against one of its nodes, and currents."""
        island = self.islands()
        self.signals = [("v", n, island[n]) for n in self.nodes() if island[n] != n]
        self.signals += [("i", e.name) for e in self.of("vldsweh")]


def text_of(number):
    return "inf" if math.isinf(number) else repr(float(number))


def function_text(function):
    kind, numbers = function
    if kind == "pwl":
        points, repeat = numbers
        words = " ".join(text_of(x) for x in points)
        return f"PWL({words})" + ("" if repeat is None else f" r={text_of(repeat)}")
    return f"{kind.upper()}({' '.join(text_of(x) for x in numbers)})"


def card(e):
    """The line of an element."""
    words = [e.name] + e.nodes
    if e.kind in "vi":
        words += [] if e.dc is None else ["DC", text_of(e.dc)]
        words += [] if e.function is None else [function_text(e.function)]
    elif e.kind == "k":
        words = [e.name] + e.coils + [text_of(e.value)]
    elif e.kind in "fh":
        words += [e.control, text_of(e.value)]
    elif e.kind == "b":
        words += [f"{e.formula[0].upper()}={{{e.formula[1]}}}"]
    elif e.kind == "d":
        words += [e.model] if e.model else []
    elif e.kind in "sw":
        words += ([e.control] if e.kind == "w" else []) + [e.model] + ([e.state] if e.state else [])
    elif e.kind == "x":
        words += [e.model]
    else:
        words += [text_of(e.value)]
    if e.initial is not None:
        words.append(f"IC={text_of(e.initial)}")
    return " ".join(words)


def signal_text(signal):
    if signal[0] == "i":
        return f"i({signal[1]})"
    return f"v({signal[1]})" if signal[2] == "0" else f"v({signal[1]},{signal[2]})"


def write(circuit, extra=()):
    """The netlist. `extra` are lines to go with it."""
    lines = [circuit.title or "a circuit"]
    lines += [card(e) for e in circuit.elements]
    for name, (kind, values) in circuit.models.items():
        words = " ".join(f"{key}={text_of(x)}" for key, x in values.items())
        lines.append(f".model {name} {kind}({words})")
    for signal, x in circuit.initial:
        lines.append(f".ic {signal_text(signal)}={text_of(x)}")
    for name, x in circuit.options.items():
        lines.append(f".options {name}={text_of(x)}")
    lines += extra
    # Long cards are continued.
    names = [signal_text(s) for s in circuit.signals]
    lines += [".save " + " ".join(names[k:k + 8]) for k in range(0, len(names), 8)]
    lines += [f".meas tran {name} " + " ".join(w if isinstance(w, str) else text_of(w) for w in words)
              for name, words in circuit.measures]
    lines.append(f".tran {text_of(circuit.step)} {text_of(circuit.stop)}" + (" uic" if circuit.uic else ""))
    return "\n".join(lines + [".end", ""])


def formula_parts(formula):
    """A formula cut at its voltages and currents: every other piece is one."""
    return re.split(r"((?<!\w)[vi]\([^()]*\))", formula)


def map_formula(formula, of_signal, of_rest=lambda text: text):
    """The formula with each v(..) and i(..) replaced, and what is between them."""
    pieces = formula_parts(formula)
    for k, piece in enumerate(pieces):
        if k % 2:
            names = tuple(piece[2:-1].split(","))
            signal = (piece[0],) + names + (("0",) if piece[0] == "v" and len(names) == 1 else ())
            pieces[k] = of_signal(signal)
        else:
            pieces[k] = of_rest(piece)
    return "".join(pieces)


def formula_signals(formula):
    found = []
    map_formula(formula, lambda signal: found.append(signal) or "")
    return found


__all__ = ["Circuit", "Element", "Unsupported", "card", "formula_signals", "map_formula", "signal_text",
           "text_of", "write"]
