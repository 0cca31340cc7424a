"""Reads a netlist into a flat Circuit: .param, .subckt, parasitics and tangents of diodes worked out."""

import itertools
import math
import re

from circuits import Circuit
from values import Scope, Unsupported

IGNORED = {".save", ".print", ".probe", ".plot", ".four", ".meas", ".measure", ".end", ".backanno",
           ".preprocess", ".op", ".title", ".nodeset"}
DIODE = {"ron", "roff", "vfwd", "vrev", "rrev", "ilimit", "revilimit", "epsilon", "revepsilon"}
VT = 1.380649e-23 * 300.15 / 1.602176634e-19  # V at 27 degrees


def cards_of(text):
    """The cards after the title: lower case, comments gone, continued lines joined."""
    cards = []
    for line in text.splitlines()[1:]:
        line = re.sub(r"(^\*.*)|(;.*)|((?<=\s)(\$|//).*)", "", line).rstrip().lower()
        if line.startswith("+") and cards:
            cards[-1] += " " + line[1:]
        elif line.strip():
            cards.append(line.strip())
        if cards and cards[-1] == ".end":
            break
    return cards


def words_of(text):
    """Words, where braces and quotes hold together, and = stands by itself."""
    return re.findall(r"\{[^}]*\}|'[^']*'|=|[^\s,()={}']+", text)


def pairs_of(words):
    """name = value ... among words: what is no pair, and the pairs."""
    rest, pairs, k = [], {}, 0
    while k < len(words):
        if k + 2 < len(words) and words[k + 1] == "=":
            pairs[words[k]] = words[k + 2]
            k += 3
        else:
            rest.append(words[k])
            k += 1
    return rest, pairs


class Reader:
    def __init__(self, text):
        self.circuit = Circuit(text.splitlines()[0] if text else "")
        self.bodies = {}
        self.global_scope = Scope()
        self.transient = None
        self.place(self.divide(cards_of(text)), self.global_scope, "", {}, 0)
        if self.transient is None:  # an operating point that stays
            self.circuit.step, self.circuit.stop = 1e-4, 1e-3

    def divide(self, cards):
        """Takes the subcircuits out."""
        outer, inner = [], None
        for text in cards:
            first = text.split()[0]
            if first == ".subckt":
                if inner is not None:
                    raise Unsupported("subcircuits inside each other")
                rest, pairs = pairs_of(words_of(text.replace("params:", "")))
                inner = (rest[2:], pairs, [])
                self.bodies[rest[1]] = inner
            elif first == ".ends":
                inner = None
            elif inner is not None:
                inner[2].append(text)
            elif first in (".control", ".if", ".include", ".inc", ".lib", ".func", ".step", ".dc", ".ac",
                           ".global"):
                raise Unsupported(first)
            else:
                outer.append(text)
        return outer

    def place(self, cards, scope, prefix, ports, depth):
        """The cards of the netlist or of one instance."""
        if depth > 10:
            raise Unsupported("deep calls")
        for text in cards:
            if text.split()[0] in (".param", ".params", ".global_param", ".csparam"):
                scope.texts.update(pairs_of(words_of(text)[1:])[1])
        # Sources first names: a control may stand before its source, nothing depends on the order.
        for text in cards:
            head = text.split()[0]
            if head[0] != ".":
                Card(self, text, scope, prefix, ports, depth)
            elif head == ".model":
                self.model(text, scope, prefix)
            elif head == ".tran":
                self.tran(words_of(text)[1:], scope)
            elif head == ".ic":
                self.initial(text, scope)
            elif head in (".options", ".option", ".opt"):
                _, pairs = pairs_of(words_of(text)[1:])
                self.circuit.options.update({k: scope.value(v) for k, v in pairs.items() if k == "reltol"})
            elif head not in IGNORED and "param" not in head:
                raise Unsupported(head)

    def tran(self, words, scope):
        self.transient = True
        c = self.circuit
        c.uic = bool({"uic", "noop"} & set(words))
        numbers = [scope.value(w) for w in words if w not in ("uic", "noop")]
        c.step, c.stop = (0.0, numbers[0]) if len(numbers) == 1 else numbers[:2]
        c.step = c.step or c.stop / 1000

    def initial(self, text, scope):
        for kind, names, x in re.findall(r"([vi])\(([^()]*)\)\s*=\s*(\{[^}]*\}|\S+)", text):
            names = [n.strip() for n in names.split(",")]
            signal = ("i", names[0]) if kind == "i" else ("v", names[0], (names + ["0"])[1])
            self.circuit.initial.append((signal, scope.value(x)))

    def model(self, text, scope, prefix):
        words, pairs = pairs_of(words_of(text))
        name, kind = prefix + words[1], words[2]
        values = {key: scope.value(x) for key, x in pairs.items()}
        if kind in ("d", "sidiode"):
            self.circuit.models[name] = ("D", diode_of(values, words))
        elif kind in ("sw", "csw", "vswitch", "iswitch"):
            self.circuit.models[name] = ("CSW" if kind in ("csw", "iswitch") else "SW", switch_of(kind, values))
        elif kind not in ("r", "l", "c"):
            raise Unsupported(f"model {kind}")


def diode_of(values, words):
    """The straight lines of a diode; of an exponential one its tangent at 1 A."""
    if set(values) <= DIODE:
        return values
    saturation, n = values.get("is", 1e-14), values.get("n", 1.0)
    resistance = values.get("rs", 0.0)
    if n <= 0.05:
        found = {"ron": resistance}
    else:
        found = {"ron": resistance + n * VT / (1 + saturation),
                 "vfwd": n * VT * math.log(1 + 1 / saturation) - n * VT / (1 + saturation)}
    if values.get("bv"):
        found["vrev"] = values["bv"]
        found["rrev"] = max(found["ron"], 1e-3)
    return found


def switch_of(kind, values):
    """Ron, Roff, Vt and Vh of any of the four kinds."""
    if set(values) & {"lser", "vser", "ilimit", "level", "oneway", "epsilon", "vhon", "vhoff", "ihon", "ihoff"}:
        raise Unsupported("switch parameters")
    current = kind in ("csw", "iswitch")
    t, h = ("it", "ih") if current else ("vt", "vh")
    found = {key: values[key] for key in ("ron", "roff") if key in values}
    if kind in ("vswitch", "iswitch") and t not in values:
        on = values.get("ion" if current else "von", 1e-3 if current else 1.0)
        off = values.get("ioff" if current else "voff", 0.0)
        if on < off:
            raise Unsupported("a switch that closes below its threshold")
        found.update({t: (on + off) / 2, h: 0.0})
    else:
        found.update({t: values.get(t, 0.0), h: max(values.get(h, 0.0), 0.0)})
    return found


class Card:
    """One element; parasitics become elements of their own."""

    def __init__(self, reader, text, scope, prefix, ports, depth):
        self.reader, self.scope, self.prefix, self.ports = reader, scope, prefix, ports
        self.circuit = reader.circuit
        self.name = self.local(text.split()[0])
        self.words, self.text = words_of(text), text
        kind = text[0]
        if kind == "x":
            self.call(depth)
        elif kind in "rlc":
            self.passive(kind)
        elif kind in "vi":
            self.source()
        elif kind in "eg" and ("value" in self.words or "table" in self.words or "poly" in self.words):
            self.formula_of_value(kind)
        elif kind in "egs":
            self.voltage_controlled(kind)
        elif kind in "fhw":
            self.current_controlled(kind)
        elif kind == "b":
            key, formula = re.fullmatch(r"\S+\s+\S+\s+\S+\s+([vi])\s*=\s*(.*)", text).groups()
            self.formula(key, formula)
        elif kind == "d":
            self.diode()
        elif kind == "k":
            coils = [self.local(w) for w in self.words[1:-1]]
            factor = self.scope.value(self.words[-1])
            for n, pair in enumerate(itertools.combinations(coils, 2)):
                self.circuit.add(self.name + (f"_{n}" if n else ""), [], factor, coils=list(pair))
        else:
            raise Unsupported(f"element {kind}")

    def local(self, name):
        """Names of instances keep their letter: r1 in x1 is r_x1_r1."""
        return f"{name[0]}_{self.prefix}{name}" if self.prefix else name

    def node(self, name):
        name = "0" if name == "gnd" else name
        return name if name == "0" else self.ports.get(name, self.prefix + name)

    def nodes(self, n):
        return [self.node(w) for w in self.words[1:1 + n]]

    def model_name(self, name):
        models = self.prefix + name
        inside = any(re.match(rf"\.model\s+{re.escape(name)}\s", c) for c in self.body_cards())
        return models if self.prefix and inside else name

    def body_cards(self):
        return [c for body in self.reader.bodies.values() for c in body[2]]

    def call(self, depth):
        words, pairs = pairs_of([w for w in self.words if w != "params:"])
        ports, defaults, cards = self.reader.bodies[words[-1]]
        texts = {**defaults, **{k: self.scope.value(v) for k, v in pairs.items()}}
        inner = {port: self.node(n) for port, n in zip(ports, words[1:-1])}
        prefix = self.prefix + words[0] + "_"
        self.reader.place(cards, Scope(self.scope, texts), prefix, inner, depth + 1)

    def passive(self, kind):
        words, pairs = pairs_of(self.words[1:])
        if set(pairs) - {"ic", "rser", kind}:
            raise Unsupported(f"{', '.join(pairs)} on {kind}")
        a, b = (self.node(w) for w in words[:2])
        value = self.scope.value(pairs[kind] if kind in pairs else words[-1])
        initial = self.scope.value(pairs["ic"]) if "ic" in pairs else None
        series = self.scope.value(pairs["rser"]) if "rser" in pairs else 0.0
        if series:
            self.circuit.add(f"rser_{self.name}", [a, f"{self.name}_in"], series)
            a = f"{self.name}_in"
        if value == 0 and kind != "r":
            raise Unsupported(f"{kind} of 0")
        self.circuit.add(self.name, [a, b], value, initial=initial)

    def source(self):
        words, dc, function, k = self.words[3:], None, None, 0
        while k < len(words):
            word = words[k]
            if word == "dc":
                dc, k = self.scope.value(words[k + 1]), k + 2
            elif word == "ac":
                k = len(words)
            elif word in ("sin", "sine", "pulse", "exp", "pwl", "am", "sffm"):
                function = self.function("sin" if word == "sine" else word, words[k + 1:])
                k = len(words)
            else:
                dc, k = self.scope.value(word), k + 1
        self.circuit.add(self.name, self.nodes(2), dc=0.0 if dc is None and function is None else dc,
                         function=function)

    def function(self, kind, words):
        rest, pairs = pairs_of(words)
        if set(pairs) - {"r"} or (pairs and kind != "pwl"):
            raise Unsupported(f"{', '.join(pairs)} of a source")
        numbers = [self.scope.value(w) for w in rest]
        if kind == "pwl":
            return kind, (numbers, self.scope.value(pairs["r"]) if "r" in pairs else None)
        if kind == "sin" and len(numbers) < 3:
            raise Unsupported("SIN without a frequency")
        return kind, numbers

    def formula_of_value(self, kind):
        match = re.fullmatch(r"\S+\s+\S+\s+\S+\s+value\s*=?\s*(.*)", self.text)
        if not match:
            raise Unsupported("TABLE and POLY")
        self.formula("v" if kind == "e" else "i", match[1])

    def formula(self, key, formula):
        def named(m):
            names = [n.strip() for n in m[2].split(",")]
            change = self.node if m[1] == "v" else self.local
            return f"{m[1]}({','.join(change(n) for n in names)})"
        formula = re.sub(r"(?<!\w)([vi])\(([^()]*)\)", named, self.scope.formula(formula))
        name = self.name if self.name[0] == "b" else "b_" + self.name
        self.circuit.add(name, self.nodes(2), formula=(key, formula))

    def voltage_controlled(self, kind):
        if "control" in self.words:
            raise Unsupported("CONTROL=")
        more = self.words[5:]
        if kind == "s":
            state = more[1] if len(more) > 1 else None
            self.circuit.add(self.name, self.nodes(4), model=self.model_name(more[0]), state=state)
        else:
            self.circuit.add(self.name, self.nodes(4), self.scope.value(more[0]))

    def current_controlled(self, kind):
        if "poly" in self.words:
            raise Unsupported("POLY")
        control, more = self.local(self.words[3]), self.words[4:]
        if kind == "w":
            state = more[1] if len(more) > 1 else None
            self.circuit.add(self.name, self.nodes(2), control=control, model=self.model_name(more[0]),
                             state=state)
        else:
            self.circuit.add(self.name, self.nodes(2), self.scope.value(more[0]), control=control)

    def diode(self):
        words, pairs = pairs_of(self.words)
        if pairs or len(words) > 4:
            raise Unsupported("m=, n= or area on a diode")
        self.circuit.add(self.name, self.nodes(2), model=self.model_name(words[3]) if len(words) > 3 else None)


def read(text):
    """The flat circuit of a netlist, with all its signals."""
    try:
        circuit = Reader(text).circuit
    except (KeyError, IndexError, AttributeError, ValueError) as problem:
        raise Unsupported(f"cannot read it: {problem!r}") from None
    if not circuit.elements or len({e.name for e in circuit.elements}) < len(circuit.elements):
        raise Unsupported("names that are not unique")
    circuit.default_signals()
    return circuit
