#!/usr/bin/env python3
"""Random circuits under `dalcs check`: passive ones must never raise an alarm, and where an element that
gives energy is planted the alarm must come, name it, and prove itself.

usage: random_circuits.py PROGRAM [COUNT [SEED]]

Of the passive circuits half are R, L, C, K, sources and diodes. The others have resistors, gyrators and
transformers in them that are made of controlled sources, which the program cannot know to be passive from
its elements. A witness is a motion y exp(s t): this test knows the circuit's elements and not its equations,
so it checks Ohm's law, s C v, s L i and KCL of the numbers it is given, that every diode gets nothing or
gives, and that the planted elements are who pays."""

import json
import pathlib
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import some_of  # noqa: E402

NEAR = 1e-6  # residuals over the largest current or voltage


class Circuit:
    def __init__(self, random_):
        self.random = random_
        self.elements = []  # (name, nodes, value)
        self.count = {}
        self.n_nodes = random_.randint(2, 5)

    def add(self, letter, nodes, value):
        self.count[letter] = self.count.get(letter, 0) + 1
        name = f"{letter}{self.count[letter]}"
        self.elements.append((name, tuple(str(node) for node in nodes), value))
        return name

    def two_nodes(self):
        return self.random.sample(range(self.n_nodes), 2)

    def size(self, low, high):
        return float(f"{10 ** self.random.uniform(low, high):.3g}")

    def conductance(self):
        return 10 ** self.random.uniform(-4, 0)

    def passive(self, disguised):
        r = self.random
        for node in range(1, self.n_nodes):  # everything hangs together
            self.add("r", (node, r.randrange(node)), self.size(0, 4))
        for _ in range(r.randint(1, 3)):
            self.add("c", self.two_nodes(), self.size(-9, -5))
        for _ in range(r.randint(0, 2)):
            self.add("l", self.two_nodes(), self.size(-6, -2))
        if self.count.get("l") == 2 and r.random() < 0.5:
            self.coupling = float(f"{r.uniform(-0.99, 0.99):.3g}")
        for _ in range(r.randint(1, 3)):
            self.add("d", self.two_nodes(), None)
        if r.random() < 0.7:
            a = r.randint(1, self.n_nodes - 1)
            self.add("i", (0, a), 1.0)
        if disguised:
            self.disguise()
        return self

    coupling = 0.0

    def disguise(self):
        for _ in range(self.random.randint(1, 3)):
            kind = self.random.choice(("resistor", "gyrator", "gyrator"))
            a, b = self.two_nodes()
            g = float(f"{self.conductance():.3g}")
            if kind == "resistor":
                self.add("g", (a, b, a, b), g)
            else:
                c, d = self.two_nodes()
                self.add("g", (a, b, c, d), g)
                self.add("g", (c, d, a, b), -g)

    def plant(self):
        """Adds something that gives energy; returns the names of who may pay."""
        r = self.random
        near = r.randrange(self.n_nodes)
        kind = r.choice(("capacitor", "inductor", "static", "amplifier"))
        g = float(f"{self.conductance():.3g}")
        if kind == "capacitor":
            self.add("d", (near, "p"), None)
            self.add("c", ("p", 0), self.size(-9, -5))
            return [self.add("g", ("p", 0, "p", 0), -g)]
        if kind == "inductor":  # and a resistor that keeps what is between them from floating
            self.add("d", (0, "p"), None)
            self.add("l", ("p", "q"), self.size(-6, -2))
            self.add("r", ("p", near), 100.0 / g)
            return [self.add("g", ("q", 0, "q", 0), -g)]
        if kind == "static":
            self.add("d", (0, "p"), None)
            self.add("r", ("p", near), 100.0 / g)
            return [self.add("g", ("p", 0, "p", 0), -g)]
        self.add("d", (0, "p"), None)
        self.add("d", (0, "q"), None)
        self.add("r", ("p", 0), 1.0 / g)
        self.add("r", ("q", 0), 1.0 / g)
        self.add("r", ("q", near), 100.0 / g)
        return [self.add("g", ("q", 0, "p", 0), 10.0 * g)]

    def text(self):
        lines = ["a random circuit"]
        for name, nodes, value in self.elements:
            lines.append(f"{name} {' '.join(nodes)} {'di' if value is None else repr(value)}")
        if self.coupling:
            lines.append(f"k1 l1 l2 {self.coupling!r}")
        return "\n".join(lines + [".model di D(Ron=0 Vfwd=0)", ".op", ".end", ""])


def check(program, text):
    with tempfile.TemporaryDirectory() as folder:
        netlist = pathlib.Path(folder) / "random.cir"
        netlist.write_text(text)
        done = subprocess.run([program, "check", str(netlist), "--json"], capture_output=True,
                              text=True, timeout=300)
    if done.returncode == 3:
        return None  # sources that contradict each other, or a node too few
    if done.returncode != 0:
        raise AssertionError(f"status {done.returncode}: {done.stderr}")
    return json.loads(done.stdout)


def number(value):
    return float(value)


class Motion:
    """The columns of an eigenvector or motion, by name."""

    def __init__(self, verdict):
        self.value = {"v(0)": 0.0}
        self.s = None
        self.on = None
        for witness in verdict["witnesses"]:
            for entry in witness.get("entries", []):
                number_ = complex(number(entry["re"]), number(entry["im"]))
                if entry["name"] == "s":
                    self.s = number_
                elif witness["kind"] == "mode":
                    self.on = (self.on or set()) | {entry["name"]}
                elif witness["kind"] in ("eigenvector", "motion"):
                    self.value[entry["name"]] = number_
        if any(witness["kind"] == "mode" for witness in verdict["witnesses"]):
            self.on = self.on or set()

    def voltage(self, nodes):
        return self.value[f"v({nodes[0]})"] - self.value[f"v({nodes[1]})"]


def currents(circuit, part, motion):
    """Each element's current from its law; None where the motion at s = infinity does not determine it. Also
    what the numbers break: pairs (residual, scale)."""
    s = motion.s
    at_once = s.real == float("inf")
    found, broken = {}, []
    inductance = {name: value for name, _, value in circuit.elements if name[0] == "l"}
    for name, nodes, value in part:
        kind = name[0]
        v = motion.voltage(nodes)
        if kind == "r":
            found[name] = v / value
        elif kind == "c":
            found[name] = None if at_once else s * value * v
            if at_once:
                broken.append(abs(v))
        elif kind == "l":
            i = motion.value[f"i({name})"]
            found[name] = i
            flux = value * i
            if circuit.coupling:
                other = "l2" if name == "l1" else "l1"
                if name in ("l1", "l2"):
                    mutual = circuit.coupling * (inductance["l1"] * inductance["l2"]) ** 0.5
                    flux += mutual * motion.value[f"i({other})"]
            broken.append(abs(i) if at_once else abs(s * flux - v) / max(1.0, abs(s * flux)))
        elif kind == "i":
            found[name] = 0.0
        elif kind == "g":
            found[name] = value * motion.voltage(nodes[2:])
        elif kind == "d":
            found[name] = motion.value[f"i({name})"]
    return found, broken


def proves(circuit, verdict, planted):
    """Why the witness does not prove that the circuit gives energy; '' when it does."""
    motion = Motion(verdict)
    if motion.s is None or motion.s.real < 0.0:
        return f"no motion with Re s >= 0: {motion.s}"
    part = [e for e in circuit.elements if all(f"v({node})" in motion.value for node in e[1])]
    current, broken = currents(circuit, part, motion)
    largest = max(abs(i) for i in current.values() if i is not None)
    if max(broken, default=0.0) > NEAR:
        return f"a law is broken by {max(broken)}"
    into, unknown = {}, set()
    for name, nodes, _ in part:
        for node, sign in ((nodes[0], -1.0), (nodes[1], 1.0)):
            if current[name] is None:
                unknown.add(node)
            else:
                into[node] = into.get(node, 0.0) + sign * current[name]
    for node, sum_ in into.items():
        if node != "0" and node not in unknown and abs(sum_) > NEAR * largest:
            return f"KCL at {node} is broken by {abs(sum_)} of {largest}"
    supplied, scale = 0.0, 0.0
    for name, nodes, _ in part:
        if name[0] == "d":
            w = -motion.voltage(nodes)
            supplied += (w.conjugate() * current[name]).real
            scale += abs(w) * abs(current[name])
            if motion.on is not None:
                wrong = abs(w) if name in motion.on else abs(current[name]) / max(largest, 1e-300)
                if wrong > NEAR:
                    return f"{name} is not as its mode says: {wrong}"
    if motion.on is None and not supplied < -1e-9 * scale:
        return f"the diodes get {supplied} of {scale}"
    if motion.on is not None and not motion.s.real > 0.0:
        return "the mode does not grow"
    given = {name: -(motion.voltage(nodes).conjugate() * current[name]).real
             for name, nodes, _ in part if name[0] == "g"}
    if not any(given.get(name, 0.0) > 0.0 and name in verdict["elements"] for name in planted):
        return f"{planted} give {[given.get(name) for name in planted]}, named are {verdict['elements']}"
    powers = {entry["name"]: number(entry["re"]) for witness in verdict["witnesses"]
              if witness["kind"] == "powers" for entry in witness["entries"]}
    most = max(map(abs, given.values()))
    if sorted(powers) != sorted(verdict["elements"]) or \
            any(abs(given.get(name, 0.0) - power) > NEAR * most for name, power in powers.items()):
        return f"powers {powers}, not {given}"
    return ""


def main(program, count, seed):
    tally = {"passive": 0, "disguised": 0, "certified": 0, "planted": 0, "by mode": 0, "skipped": 0}
    failures = 0
    n = 0
    count = len(some_of(range(count)))
    while n < count and tally["skipped"] < 10 * count:
        random_ = random.Random(f"{seed}.{n}.{tally['skipped']}")
        kind = ("passive", "disguised", "planted")[n % 3]
        circuit = Circuit(random_).passive(kind != "passive" and random_.random() < 0.8)
        planted = circuit.plant() if kind == "planted" else None
        result = check(program, circuit.text())
        if result is None:
            tally["skipped"] += 1
            continue
        n += 1
        tally[kind] += 1
        answers = [part["verdicts"]["passive"] for part in result["parts"]]
        alarms = [verdict for verdict in answers if verdict["answer"] == "no"]
        why = ""
        if kind != "planted":
            why = f"false alarm: {alarms[0]['sentence']}" if alarms else ""
            tally["certified"] += all(verdict["answer"] == "yes" for verdict in answers)
            steps = [part["verdicts"]["step"]["answer"] for part in result["parts"]]
            if not why and kind == "passive" and steps != ["yes"] * len(steps):
                why = f"steps: {steps}"
        elif not alarms:
            why = f"no alarm: {answers}"
        else:
            why = proves(circuit, alarms[0], planted)
            tally["by mode"] += any(w["kind"] == "mode" for w in alarms[0]["witnesses"])
        if why:
            failures += 1
            print(f"FAILED {kind} {seed}.{n}: {why}\n{circuit.text()}")
    if tally["certified"] < 0.98 * (tally["passive"] + tally["disguised"]):
        failures += 1
        print("FAILED: the stored energy should prove nearly all of them passive")
    if not 0 < tally["by mode"] < tally["planted"] or n < count:
        failures += 1
        print("FAILED: not all kinds of witnesses came up")
    print(", ".join(f"{value} {name}" for name, value in tally.items()))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 300,
                  sys.argv[3] if len(sys.argv) > 3 else "1"))
