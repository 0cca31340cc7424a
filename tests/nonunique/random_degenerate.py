#!/usr/bin/env python3
"""Random networks with parallel diodes, rings, stacks, ladders and bridges whose equal values tie:
what the report says is not determined, against the answers of every mode in rational numbers.

usage: random_degenerate.py PROGRAM [COUNT [SEED]]

COUNT networks that are not unique, and those that come up between them and are. All signals are compared:
what is unique must not be reported, and every interval must be exact to 1e-9. The diodes' currents and
voltages must be those of least norm. Networks share a netlist, in groups: they are independent
parts."""

import pathlib
import random
import sys
from fractions import Fraction

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402
from every_mode import INFINITY, Network  # noqa: E402

TOGETHER = 20         # networks in a netlist
INTERVAL = 1e-9       # of the scale
LEAST_NORM = 1e-6     # of the scale
MOST_DIODES = 6

IDEAL = (Fraction(0), Fraction(0))


def diode(random_, a, b):
    kind = random_.random()
    model = IDEAL if kind < 0.85 else (Fraction(1), Fraction(0)) if kind < 0.95 else (Fraction(0),
                                                                                      Fraction(1))
    return ("d", a, b, model)


def source(random_):
    return Fraction(random_.choice((0, 0, 1, 1, 2, -1, -2, 3)))


def pattern(random_, nodes):
    """Diodes (and shorts) as people connect them."""
    kind = random_.choice(("parallel", "antiparallel", "ring", "stack", "bridge", "ladder", "star",
                           "shorted"))
    a, b, c, d = (random_.sample(nodes, 4) + [0, 0, 0, 0])[:4] if len(nodes) >= 4 else \
        [random_.choice(nodes) for _ in range(4)]
    pairs = {"parallel": [(a, b), (a, b)], "antiparallel": [(a, b), (b, a)],
             "ring": [(a, b), (b, c), (c, a)], "stack": [(a, b), (b, c)],
             "bridge": [(a, b), (c, b), (d, a), (d, c)], "ladder": [(a, b), (b, c), (c, d)],
             "star": [(a, b), (a, c), (a, d)], "shorted": [(a, b)]}[kind]
    elements = [diode(random_, p, q) for p, q in pairs if p != q]
    if kind == "shorted":
        elements.append(("l", a, b, Fraction(0)))
    return elements


def sketch(random_):
    """A network, tied to ground by more than current sources, with at most MOST_DIODES diodes."""
    n_nodes = random_.randint(2, 6)
    nodes = list(range(n_nodes))
    elements = []
    for _ in range(random_.randint(1, 3)):
        elements += pattern(random_, nodes)
    for _ in range(random_.randint(1, 4)):
        a, b = random_.sample(nodes, 2)
        kind = random_.choice("rrrviilc")
        value = Fraction(random_.choice((1, 1, 2))) if kind == "r" else source(random_)
        elements.append((kind, a, b, value))
    random_.shuffle(elements)
    diodes = sum(e[0] == "d" for e in elements)
    tied = {0}
    for _ in nodes:
        for kind, a, b, _ in elements:
            if kind != "i" and (a in tied or b in tied):
                tied |= {a, b}
    return Network(n_nodes, elements) if len(tied) == n_nodes and 0 < diodes <= MOST_DIODES else None


class Case:
    """A network with its signals and their intervals."""

    def __init__(self, network):
        self.network = network
        self.signals = []  # (name without prefix, quantity)
        for node in range(1, network.n_nodes):
            self.signals.append((f"v({{}}n{node})", network.voltage(node, 0)[:-1]))
        if network.n_nodes > 3:
            self.signals.append(("v({0}n2,{0}n3)", network.voltage(2, 3)[:-1]))
        for k, column in network.current.items():
            row = [Fraction(0)] * network.n
            row[column] = Fraction(1)
            self.signals.append((f"i({network.elements[k][0]}{{}}e{k})", row))
        found = network.answers([quantity for _, quantity in self.signals])
        self.is_feasible = found is not None
        if self.is_feasible:
            self.intervals, self.currents, self.voltages = found

    def is_open(self):
        return any(low != high for low, high in self.intervals)

    def cards(self, prefix):
        def node(n):
            return "0" if n == 0 else f"{prefix}n{n}"

        for k, (kind, a, b, value) in enumerate(self.network.elements):
            name = f"{kind}{prefix}e{k} {node(a)} {node(b)}"
            if kind == "d":
                yield f"{name} d{int(value[0])}{int(value[1])}"
            elif kind == "v" or kind == "i":
                yield f"{name} dc {float(value)!r}"
            else:
                yield f"{name} {float(value) if kind == 'r' else 1.0!r}"
        yield ".save " + " ".join(name.format(prefix) for name, _ in self.signals)


def compare(checker, program, cases, worst):
    prefixes = [f"x{k}" for k in range(len(cases))]
    lines = ["random networks", ".model d00 d(ron=0 vfwd=0)", ".model d10 d(ron=0 vfwd=1)",
             ".model d01 d(ron=1 vfwd=0)", ".op"]
    for prefix, case in zip(prefixes, cases):
        lines += case.cards(prefix)
    text = "\n".join(lines) + "\n.end\n"
    result = run(program, text, method=None)
    if not checker.check(result.status == 0, f"exit {result.status}: {result.stderr}\n{text}"):
        return
    listed = {entry["signal"]: entry for entry in result.report["nonunique"]}
    for prefix, case in zip(prefixes, cases):
        cards = "\n".join(case.cards(prefix))
        for (name, _), interval in zip(case.signals, case.intervals):
            compare_interval(checker, result, listed, name.format(prefix), interval, cards, worst)
        compare_pick(checker, result, case, prefix, cards, worst)


def compare_interval(checker, result, listed, name, interval, cards, worst):
    value = result.column(name)[-1]
    if interval[0] == interval[1]:
        checker.check(name not in listed, f"{name} is unique, but reported\n{cards}")
        checker.close(value, float(interval[0]), INTERVAL * max(1, abs(interval[0])),
                      f"{name}, unique\n{cards}\n")
        return
    if not checker.check(name in listed, f"{name} in {interval} is not reported\n{cards}"):
        return
    for key, bound in zip(("lower", "upper"), interval):
        found = float(listed[name][key])
        if abs(bound) == INFINITY:
            checker.check(found == bound, f"{key} of {name}: {found!r}, not {bound}\n{cards}")
        else:
            error = abs(found - float(bound)) / max(1, abs(float(bound)))
            worst["interval"] = max(worst["interval"], error)
            checker.check(error <= INTERVAL, f"{key} of {name}: {found!r}, not {bound}\n{cards}")
    checker.check(listed[name]["value"] == value, f"{name}: {listed[name]} is not {value!r}")


def compare_pick(checker, result, case, prefix, cards, worst):
    found, wanted = [], []
    for k, current, voltage in zip(case.network.diodes, case.currents, case.voltages):
        _, a, b, (vfwd, ron) = case.network.elements[k]
        i = result.column(f"i(d{prefix}e{k})")[-1]
        v = [result.column(f"v({prefix}n{n})")[-1] if n > 0 else 0.0 for n in (a, b)]
        found += [i, v[1] - v[0] + float(vfwd) + float(ron) * i]
        wanted += [float(current), float(voltage)]
    scale = max(1.0, *(abs(x) for x in wanted))
    error = max(abs(x - y) for x, y in zip(found, wanted)) / scale
    worst["pick"] = max(worst["pick"], error)
    checker.check(error <= LEAST_NORM,
                  f"the least-norm (i, w) are {wanted}, not {found}: off by {error:.2e}\n{cards}")


def main():
    program = sys.argv[1]
    count = len(some_of(range(int(sys.argv[2]) if len(sys.argv) > 2 else 1000)))
    random_ = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    checker = Checker("random_degenerate")
    worst = {"interval": 0.0, "pick": 0.0}
    n_open, n_unique, waiting = 0, 0, []
    while n_open < count:
        network = sketch(random_)
        case = Case(network) if network is not None else None
        if case is None or not case.is_feasible:
            continue
        n_open += case.is_open()
        n_unique += not case.is_open()
        waiting.append(case)
        if len(waiting) == TOGETHER or n_open == count:
            compare(checker, program, waiting, worst)
            waiting = []
    print(f"{n_open} networks that are not unique, {n_unique} that are; worst interval "
          f"{worst['interval']:.2e}, worst least-norm pick {worst['pick']:.2e}, of the scale")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
