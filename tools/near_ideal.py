"""Rewrites a dalcs netlist into one that ngspice can take: near-ideal instead of ideal devices.

An ideal diode becomes a steep exponential with a small series resistance, an ideal switch a small
and a large resistance, an edge of no width a short ramp, a short a micro-ohm. Diode and switch
currents are measured by sources of 0 V in series, called vxd_<element>.
"""

import dataclasses
import math
import re

SUFFIX = {"t": 1e12, "g": 1e9, "meg": 1e6, "k": 1e3, "mil": 25.4e-6, "m": 1e-3, "u": 1e-6,
          "n": 1e-9, "p": 1e-12, "f": 1e-15, "a": 1e-18}
NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)(meg|mil|[tgkmunpfa])?[a-z]*$", re.I)
SHORT = 1e-6  # ohm, what R=0 becomes
ON_RESISTANCE, OFF_RESISTANCE = 1e-3, 1e9  # ohm, of a switch that has none
EDGE = 1e-9  # s, the longest ramp that an edge of no width becomes


@dataclasses.dataclass(frozen=True)
class Idealisation:
    """How near to ideal, and how hard ngspice tries."""

    emission: float  # the diode's N
    resistance: float  # ohm in series with a diode that has none
    capacitance: float  # F across a diode
    reltol: float
    method: str

    def __str__(self):
        return f"D({self.parameters(self.resistance)}) reltol={self.reltol:g} {self.method}"

    def parameters(self, resistance):
        """Of the diode's model card."""
        junction = f" cjo={self.capacitance:g}" if self.capacitance else ""
        return f"is=1e-14 n={self.emission:g} rs={resistance:g}{junction}"


# From the sharpest to the bluntest: ngspice gives up on the sharp ones now and then. Its trapezoidal
# rule rings in inductive circuits, so that comes late.
IDEALISATIONS = (
    Idealisation(0.01, 1e-3, 0, 1e-5, "gear"),
    Idealisation(0.05, 1e-2, 0, 1e-4, "gear"),
    Idealisation(0.05, 1e-2, 1e-10, 1e-4, "gear"),
    Idealisation(0.1, 2e-2, 0, 1e-3, "gear"),
    Idealisation(0.3, 5e-2, 0, 1e-3, "gear"),
    Idealisation(0.3, 2e-1, 0, 1e-3, "gear"),
    Idealisation(0.05, 1e-2, 1e-9, 1e-3, "trap"),
    Idealisation(1.0, 1e-1, 0, 1e-3, "gear"),
)


def number(text):
    """A SPICE number; None when it is not one."""
    match = NUMBER.match(text)
    if not match:
        return None
    return float(match.group(1)) * SUFFIX.get((match.group(2) or "").lower(), 1.0)


def logical_lines(text):
    """The title, then cards in lower case without comments, continuations joined."""
    title, *rest = text.splitlines() or [""]
    cards = []
    for line in rest:
        line = re.split(r";|\$ |//", line, maxsplit=1)[0].rstrip().lower()
        if not line.strip() or line.lstrip().startswith("*"):
            continue
        if line.lstrip().startswith("+") and cards:
            cards[-1] += " " + line.lstrip()[1:]
        else:
            cards.append(line.strip())
    return title, cards


def words(card):
    """Blank, comma, = and parentheses separate; kept apart here are names and their values."""
    return re.sub(r"[(),=]", " ", card).split()


@dataclasses.dataclass
class Model:
    kind: str
    values: dict

    def get(self, name, default=None):
        return self.values.get(name, default)


def read_models(cards):
    models = {}
    for card in cards:
        if card.startswith(".model"):
            _, name, kind, *pairs = words(card)
            models[name] = Model(kind, {key: number(value) for key, value
                                        in zip(pairs[0::2], pairs[1::2])})
    return models


class Rewriter:
    """Turns cards into lines for ngspice."""

    def __init__(self, cards, idealisation, sensed):
        self.cards = cards
        self.ideal = idealisation
        self.sensed = sensed  # elements whose current is wanted and ngspice does not give
        self.models = read_models(cards)
        self.lines = []

    def sense(self, name, node):
        """The node behind a 0 V source that measures what flows into the element."""
        self.lines.append(f"vxd_{name} {node} xd_{name} 0")
        return f"xd_{name}"

    def diode(self, name, anode, cathode, model):
        inside = self.sense(name, anode)
        model = self.models.get(model, Model("d", {}))
        on = model.get("ron") or self.ideal.resistance
        forward = model.get("vfwd") or 0.0
        start = inside
        if forward:
            start = f"xf_{name}"
            self.lines.append(f"vxf_{name} {inside} {start} {forward!r}")
        self.lines.append(f"d{name} {start} {cathode} xm_{name}")
        self.lines.append(f".model xm_{name} d({self.ideal.parameters(on)})")
        if model.get("roff"):
            self.lines.append(f"rxd_{name} {inside} {cathode} {model.get('roff')!r}")
        if model.get("vrev"):
            back = model.get("rrev") or on
            self.lines.append(f"vxr_{name} {cathode} xr_{name} {model.get('vrev')!r}")
            self.lines.append(f"dxr_{name} xr_{name} {inside} xn_{name}")
            self.lines.append(f".model xn_{name} d({self.ideal.parameters(back)})")

    def switch(self, name, plus, minus, control_plus, control_minus, model, *rest):
        inside = self.sense(name, plus)
        model = self.models[model]
        on = model.get("ron") if model.get("ron") is not None else 1.0
        off = model.get("roff") or OFF_RESISTANCE
        self.lines.append(f"{name} {inside} {minus} {control_plus} {control_minus} xm_{name} "
                          + " ".join(rest))
        self.lines.append(f".model xm_{name} sw(ron={max(on, ON_RESISTANCE)!r} roff={off!r} "
                          f"vt={model.get('vt') or 0.0!r} vh={model.get('vh') or 0.0!r})")

    def source(self, card):
        """Gives edges without width a width that nothing else notices."""
        name, plus, minus, *rest = words(card)
        for place, word in enumerate(rest):
            if word in ("pulse", "pwl"):
                values = [number(text) for text in rest[place + 1:]]
                values = self.pulse(values) if word == "pulse" else self.pwl(values)
                shape = " ".join(repr(value) for value in values)
                return f"{name} {plus} {minus} {' '.join(rest[:place])} {word}({shape})"
        return card

    @staticmethod
    def pulse(values):
        values = values + [0.0] * (5 - len(values))
        period = values[6] if len(values) > 6 and values[6] else math.inf
        edge = min(EDGE, period / 1000, values[5] / 100 if len(values) > 5 else math.inf)
        values[3] = values[3] or edge
        values[4] = values[4] or edge
        return values

    @staticmethod
    def pwl(values):
        times, levels = values[0::2], values[1::2]
        for k in range(1, len(times)):
            if times[k] <= times[k - 1]:
                times[k] = times[k - 1] + EDGE
        return [value for pair in zip(times, levels) for value in pair]

    def card(self, card):
        name, *rest = words(card)
        kind = name[0]
        if kind == "d":
            self.diode(name, rest[0], rest[1], rest[2] if len(rest) > 2 else None)
        elif kind == "s":
            self.switch(name, *rest)
        elif kind in "vi":
            self.lines.append(self.source(card))
        elif kind == "r" and number(rest[2]) == 0.0:
            node = self.sense(name, rest[0]) if name in self.sensed else rest[0]
            self.lines.append(f"{name} {node} {rest[1]} {SHORT!r}")
        elif name in self.sensed:
            node = self.sense(name, rest[0])
            self.lines.append(re.sub(r"^(\S+\s+)\S+", rf"\g<1>{node}", card))
        else:
            self.lines.append(card)

    def rewrite(self):
        for card in self.cards:
            if not card.startswith("."):
                self.card(card)
            elif card.startswith((".ic", ".nodeset")):
                self.lines.append(card)
            elif card.startswith(".end"):
                break
        return self.lines


def analyses(cards):
    """(.op asked for, the .tran card's numbers or None, uic)"""
    tran, uic, op = None, False, False
    for card in cards:
        parts = words(card)
        op = op or parts[0] == ".op"
        if parts[0] == ".tran":
            uic = "uic" in parts
            tran = [number(part) for part in parts[1:] if part != "uic"]
    return op, tran, uic


def rewrite(text, idealisation, signals):
    """The netlist for ngspice. `signals` are the names to compare, "i(r1)" among them."""
    title, cards = logical_lines(text)
    currents = {signal[2:-1] for signal in signals if signal.startswith("i(")}
    sensed = {name for name in currents if name[0] in "rcifg"}
    lines = [f"* {title}"] + Rewriter(cards, idealisation, sensed).rewrite()
    _, tran, uic = analyses(cards)
    if tran:
        step, stop = tran[0], tran[1]
        start = tran[2] if len(tran) > 2 else 0.0
        largest = tran[3] if len(tran) > 3 and tran[3] else step
        lines.append(f".tran {step!r} {stop!r} {start!r} {largest!r}{' uic' if uic else ''}")
    else:
        lines.append(".op")
    # Equal conductances across all diodes, far above the one to ground, settle floating nodes the
    # way dalcs does.
    lines.append(f".options reltol={idealisation.reltol!r} method={idealisation.method} gmin=1e-9 "
                 "rshunt=1e13 itl1=1000 itl4=200")
    return "\n".join(lines + [".end", ""])


def ngspice_name(signal):
    """Where a dalcs signal is in ngspice's raw file."""
    if signal.startswith("i(") and signal[2] not in "vleh":
        return f"i(vxd_{signal[2:]}"
    return signal
