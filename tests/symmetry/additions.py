"""Changes of a circuit that no waveform may notice: other names, meters, cables, other ways to write it.

Each takes a circuit and a generator of random numbers and returns a Change, or None where it has nothing to
change."""

from circuits import formula_signals, map_formula


class Change:
    """A circuit and how its answer belongs to that of the one before."""

    def __init__(self, circuit):
        self.circuit = circuit
        self.names = {}  # signal before: signal after, where they differ
        self.factor = None  # signal before: factor; None for 1
        self.seconds = 1.0
        self.without = set()  # signals that need not agree
        self.lag = 0.0  # s by which events may be later
        self.arguments = {}  # of the run: tolerance, stages, options
        self.tolerance = None  # what the run was asked for, if it differs

    def name(self, signal):
        return self.names.get(signal, signal)


def fresh(circuit):
    """A word with which no name of the circuit begins."""
    taken = set(circuit.nodes()) | {e.name[1:] for e in circuit.elements} | set(circuit.models)
    word = "zz"
    while any(name.startswith(word) for name in taken):
        word += "z"
    return word


def used_currents(circuit):
    """Elements whose current something reads."""
    used = {e.control for e in circuit.elements if e.control}
    for e in circuit.elements:
        if e.formula:
            used |= {s[1] for s in formula_signals(e.formula[1]) if s[0] == "i"}
    return used | {s[1] for s, _ in circuit.initial if s[0] == "i"}


def renamed(circuit, random):
    """All names are others, and all cards stand in another order."""
    after = circuit.copy()
    nodes = circuit.nodes()
    numbers = random.sample(range(1, 10 * len(nodes) + 10), len(nodes))
    node = {"0": "0", **{n: random.choice(("n", "a.", "z_")) + str(k) for n, k in zip(nodes, numbers)}}
    numbers = random.sample(range(10 * len(after.elements)), len(after.elements))
    element = {e.name: f"{e.kind}{random.choice(('', 'x', '_'))}{k}" for e, k in zip(after.elements, numbers)}

    def signal(s):
        return ("i", element[s[1]]) if s[0] == "i" else ("v", node[s[1]], node[s[2]])

    def in_formula(s):
        s = signal(s)
        return f"i({s[1]})" if s[0] == "i" else f"v({s[1]},{s[2]})" if s[2] != "0" else f"v({s[1]})"

    for e in after.elements:
        e.name, e.nodes = element[e.name], [node[n] for n in e.nodes]
        e.control = e.control and element[e.control]
        e.coils = e.coils and [element[n] for n in e.coils]
        e.formula = e.formula and (e.formula[0], map_formula(e.formula[1], in_formula))
    random.shuffle(after.elements)
    after.initial = [(signal(s), x) for s, x in after.initial]
    change = Change(after)
    change.names = {s: signal(s) for s in circuit.signals}
    after.signals = [signal(s) for s in circuit.signals]
    random.shuffle(after.signals)
    after.measures = []
    return change


def beside(circuit, random):
    """A part that touches nothing but ground, or not even that."""
    after, w = circuit.copy(), fresh(circuit)
    t, ground = circuit.stop, random.choice(("0", w + "0"))
    kind = random.choice(("rectifier", "chopper", "tank"))
    volts = 10.0 ** random.randint(-2, 3)
    if kind == "rectifier":
        after.add("v" + w, [w + "a", ground], function=("sin", [0.0, volts, random.uniform(3, 40) / t]))
        after.add("d" + w, [w + "a", w + "b"])
        after.add("r" + w, [w + "b", ground], 100.0)
        after.add("c" + w, [w + "b", ground], t / 700)
    elif kind == "chopper":
        after.add("v" + w, [w + "a", ground], dc=volts)
        period = t / random.uniform(10, 60)
        after.add("vg" + w, [w + "g", "0"],
                  function=("pulse", [0.0, 1.0, 0.0, 0.0, 0.0, 0.37 * period, period]))
        after.models[w + "m"] = ("SW", {"ron": 0.01, "roff": 1e6, "vt": 0.5, "vh": 0.0})
        after.add("s" + w, [w + "a", w + "b", w + "g", "0"], model=w + "m")
        after.add("d" + w, [ground, w + "b"])
        after.add("l" + w, [w + "b", w + "c"], t / 30)
        after.add("r" + w, [w + "c", ground], 1.0)
    else:
        after.add("l" + w, [w + "a", ground], 1e-3 * t, initial=0.3 if circuit.uic else None)
        after.add("c" + w, [w + "a", ground], 1e-2 * t, initial=volts if circuit.uic else None)
        after.add("r" + w, [w + "a", ground], 1e3)
    return Change(after)


def voltmeters(circuit, random):
    """E and G into resistors, H and F of what can be read, B of what is read."""
    after, w = circuit.copy(), fresh(circuit)
    nodes = circuit.nodes() + ["0"]
    readable = [e.name for e in circuit.of("veh")]
    for k in range(random.randint(1, 4)):
        a, b = random.sample(nodes, 2) if len(nodes) > 1 else (nodes[0], nodes[0])
        out, kind = f"{w}{k}", random.choice("egbhf")
        if kind in "hf" and not readable:
            kind = "e"
        name = f"{kind}{w}{k}"
        if kind in "eg":
            after.add(name, [out, "0", a, b], 10.0 ** random.randint(-3, 2))
        elif kind == "b":
            formula = f"2*v({a},0)-v({b},0)" if "0" not in (a, b) else f"v({a if b == '0' else b})"
            after.add(name, [out, "0"], formula=("v", formula.replace(",0)", ")")))
        else:
            after.add(name, [out, "0"], random.choice((1.0, 0.01, 50.0)), control=random.choice(readable))
        after.add(f"r{w}{k}", [out, "0"], 10.0 ** random.randint(-1, 5))
    return Change(after)


def ammeters(circuit, random):
    """A V source of 0 V in series with some elements."""
    after, w = circuit.copy(), fresh(circuit)
    chosen = [e for e in after.of("rlcvidsw")]
    for k, e in enumerate(random.sample(chosen, min(len(chosen), random.randint(1, 4)))):
        between = f"{w}{k}"
        after.add(f"v{w}{k}", [e.nodes[0], between], dc=0.0)
        e.nodes[0] = between
    return Change(after)


def conductances(circuit, random):
    """Each R written as a G that is controlled by its own voltage."""
    after, used = circuit.copy(), used_currents(circuit)
    w = fresh(circuit)
    chosen = [e for e in after.of("r") if e.value != 0 and e.name not in used]
    for k, e in enumerate(chosen):
        e.name, e.kind, e.value = f"g{w}{k}", "g", 1 / e.value
        e.nodes = e.nodes * 2
    return Change(after) if chosen else None


def through(how):
    """Switches read their control through something else."""
    def gates(circuit, random):
        after, w = circuit.copy(), fresh(circuit)
        change = Change(after)
        for k, e in enumerate(after.of("s")):
            c, d = e.nodes[2:]
            out = f"{w}{k}"
            if how == "e":
                after.add(f"e{w}{k}", [out, "0", c, d], 1.0)
            elif how == "b":
                formula = f"v({c},{d})" if "0" not in (c, d) else f"v({c})" if d == "0" else f"-v({d})"
                after.add(f"b{w}{k}", [out, "0"], formula=("v", formula))
            elif how == "subcircuit":
                after.add(f"x{w}{k}", [c, d, out], model=w + "driver")
            else:
                after.add(f"e{w}{k}", [out + "e", "0", c, d], 1.0)
                after.add(f"r{w}{k}", [out + "e", out], 1.0)
                after.add(f"c{w}{k}", [out, "0"], 1e-9 * circuit.stop)
                change.lag = 30e-9 * circuit.stop
            e.nodes[2:] = [out, "0"]
        if how == "subcircuit":
            change.arguments["lines"] = [f".subckt {w}driver p m out", "E1 mid m p m 1", "R1 mid m 1k",
                                         "E2 out 0 mid m 1", f".ends {w}driver"]
        return change if circuit.of("s") and separable(circuit, how) else None
    return gates


def fed_by_sources(circuit, node):
    return node == "0" or any(set(e.nodes) == {node, "0"} for e in circuit.of("v"))


def separable(circuit, how):
    """Whether a control that the circuit makes commands as one that sources make: one without hysteresis that comes
    to rest at its threshold need not. Behind an RC there must be no second switch that moves at the same time, and
    no loop, in which the delay adds up."""
    if how == "rc" and (len(circuit.of("s")) > 1 or not all(fed_by_sources(circuit, n) for e in circuit.of("s")
                                                            for n in e.nodes[2:])):
        return False
    levels = [0.0] + [x for e in circuit.of("v") for x in [e.dc] + (list(e.function[1])[:2] if e.function and
              e.function[0] == "pulse" else [])]
    return all(circuit.models[e.model][1]["vh"] > 0 or circuit.models[e.model][1]["vt"] not in levels
               for e in circuit.of("s"))


def cable(sections, where, what):
    """A line of sections hung on a source's node, or on a meter of any voltage."""
    def hung(circuit, random):
        after, w = circuit.copy(), fresh(circuit)
        change = Change(after)
        if where == "source":
            used = used_currents(circuit)
            fed = [e for e in circuit.of("v") if "0" in e.nodes and e.name not in used]
            if not fed:
                return None
            source = random.choice(fed)
            node = next((n for n in source.nodes if n != "0"), "0")
            change.without.add(("i", source.name))
        else:
            after.add("e" + w, [w, "0", random.choice(circuit.nodes()), "0"], 1.0)
            node = w
        for k in range(sections):
            end = f"{w}{k}"
            if what == "rc":
                after.add(f"r{w}{k}", [node, end], 100.0)
                after.add(f"c{w}{k}", [end, "0"], circuit.stop / 300 / 100)
            elif what == "lc":
                after.add(f"l{w}{k}", [node, end], circuit.stop / 300 * 10)
                after.add(f"c{w}{k}", [end, "0"], circuit.stop / 300 / 10)
                after.add(f"r{w}{k}", [end, "0"], 50.0 * (1 + k))
            else:
                after.add(f"d{w}{k}", [node, end])
                after.add(f"r{w}{k}", [node, end], 1000.0)
                after.add(f"c{w}{k}", [end, "0"], circuit.stop / 100 / 1000)
            node = end
        after.add("r" + w, [node, "0"], 30.0)
        return change
    return hung
