#!/usr/bin/env python3
"""Passive one-step problems of degenerate graphs over twelve decades, against rational numbers.

usage: degenerate.py SOLVE_NETLISTS COUNT [FIRST]

Stars and islands that nothing ties to ground, rings of diodes, cutsets of diodes and current sources, ladders,
bridges, with values of 1e-6 to 1e6 that are often
equal and always powers of 2: their sums are what is solved, not a rounding away. Solvable ones (a linear programme decides it in rational
numbers) must be answered, whether or not controlled sources look on, with each equation, each sign and complementarity right
to rounding; of the others weights of their own equations prove, in rational numbers, that they have none, and they must
be refused.
"""

import pathlib
import random
import subprocess
import sys
import tempfile

from rational import Problem

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import some_of  # noqa: E402

ROUNDING = 2e-13  # of a row, see residual.c
REFUSED = 2, 3    # nothing is certified, nothing is there


class Circuit:
    def __init__(self, chance):
        self.chance = chance
        self.lines, self.n, self.pairs, self.nodes = [], 0, 0, set()
        self.values = [2.0 ** chance.randrange(-20, 21) for _ in range(chance.choice([1, 2, 6]))]

    def add(self, kind, *words):
        self.n += 1
        self.nodes.update(str(word) for word in words[:2])
        self.lines.append(f"{kind}{self.n} " + " ".join(str(word) for word in words))

    def value(self):
        return f"{self.chance.choice(self.values):.17g}"

    def diode(self, a, b):
        if self.pairs < 10:
            self.pairs += 1
            model = self.chance.choice(["di", "di", "di", "dr", "dv"])
            self.add("d", a, b, model)

    def switch(self, a, b):
        if self.pairs < 10:
            self.pairs += 1
            self.add(self.chance.choice(["so", "sc"]), a, b, "0 0", self.chance.choice(["si", "sr"]))

    def passive(self, a, b):
        kind = self.chance.choice("rrrlc")
        start = f" ic={self.chance.randrange(-2, 3)}" if kind != "r" else ""
        self.add(kind, a, b, self.value() + start)

    def anything(self, a, b):
        kind = self.chance.choice("ddddrrlcs")
        if kind == "d":
            self.diode(*self.chance.choice([(a, b), (b, a)]))
        elif kind == "s":
            self.switch(a, b)
        else:
            self.passive(a, b)

    def source(self, a, b):
        if self.chance.random() < 0.5:
            self.add("v", a, b, self.chance.randrange(-3, 4))
        else:
            self.add("i", a, b, self.chance.randrange(-2, 3))

    def observe(self):
        """An observer hides from the engine that the circuit is passive, but changes nothing of the rest."""
        nodes = sorted(self.nodes)
        for k in range(self.chance.randrange(1, 4)):
            self.add("e", f"o{k}", 0, *self.chance.sample(nodes, 2), self.chance.randrange(1, 4))
            self.add("r", f"o{k}", 0, self.value())

    def text(self):
        leaks = f"ron={2.0 ** -10} roff={2.0 ** 20}"
        return "\n".join(["degenerate", *self.lines, ".model di d", f".model dr d({leaks})",
                          ".model dv d(vfwd=0.7)", ".model si sw(vt=1)",
                          f".model sr sw(vt=1 {leaks})", ".tran 1m 1 uic", ".end", ""])


def star(c):
    """Arms of two elements around a centre; nothing else but, at times, a tie of the ends."""
    n = c.chance.randrange(2, 6)
    for k in range(n):
        c.passive("s", f"m{k}")
        c.anything(f"m{k}", f"e{k}")
    for k in range(n - 1):
        c.source(f"e{k}", f"e{k + 1}" if c.chance.random() < 0.5 else 0)
    if c.chance.random() < 0.5:
        c.passive(f"e{n - 1}", 0)


def ring(c):
    n = c.chance.randrange(2, 6)
    for k in range(n):
        c.diode(f"n{k}", f"n{(k + 1) % n}")
        if c.chance.random() < 0.4:
            c.anything(f"n{k}", f"n{c.chance.randrange(n)}x" if c.chance.random() < 0.2 else 0)
    c.source("n0", c.chance.choice([0, "n1"]))


def cutset(c):
    """An island that current sources fill and diodes drain."""
    for k in range(c.chance.randrange(1, 4)):
        c.add("i", 0, f"a{k}", c.chance.randrange(-1, 3))
        c.anything(f"a{k}", f"a{k + 1}")
        c.diode(f"a{k}", f"b{k % 2}")
    for k in range(2):
        c.add("v", f"b{k}", 0, c.chance.randrange(-2, 3))
        c.diode("a1", f"b{k}")


def ladder(c):
    n = c.chance.randrange(2, 6)
    c.source("n0", 0)
    for k in range(n):
        c.anything(f"n{k}", f"n{k + 1}")
        c.anything(f"n{k + 1}", c.chance.choice([0, 0, f"n{max(0, k - 1)}"]))


def bridge(c):
    n = c.chance.randrange(2, 5)
    for k in range(n):
        c.diode(f"a{k}", "p")
        c.diode("m", f"a{k}")
        c.passive(f"a{k}", f"s{k}")
        c.add("v", f"s{k}", "s", c.chance.randrange(-3, 4))
    c.passive("p", "m")
    if c.chance.random() < 0.5:
        c.source("p", "m")


def tangle(c):
    nodes = [0, *[f"n{k}" for k in range(c.chance.randrange(2, 6))]]
    for _ in range(c.chance.randrange(4, 14)):
        a, b = c.chance.sample(nodes, 2)
        c.anything(a, b)
    for _ in range(c.chance.randrange(1, 3)):
        c.source(*c.chance.sample(nodes, 2))


KINDS = [star, ring, cutset, ladder, bridge, tangle]


def draw(seed):
    chance = random.Random(f"degenerate {seed}")
    circuit = Circuit(chance)
    chance.choice(KINDS)(circuit)
    if chance.random() < 0.3:
        circuit.observe()
    return circuit.text()


def judge(problem, words):
    status, residual = int(words[3]), float(words[4])
    witness = problem.witness()
    if witness is not None:
        if not problem.is_refuted_by(witness):
            return "the witness is none"
        return None if status in REFUSED else f"it has no solution, but the status is {status}"
    if status != 0:
        return f"it has a solution, but the status is {status}"
    return f"the residual is {residual}" if residual > ROUNDING else None


def main():
    solver, count = sys.argv[1], int(sys.argv[2])
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    failed, problems = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in some_of(range(first, first + count)):
            text = draw(seed)
            done = subprocess.run([solver, folder], input=text, capture_output=True, text=True,
                                  check=False)
            if done.returncode != 0:
                print(f"FAILED {seed}: {done.stderr.strip()}")
                failed += 1
            for line in done.stdout.splitlines():
                words = line.split()
                problem = Problem(pathlib.Path(folder) / f"{words[0]}.dalcs")
                problems += 1
                wrong = judge(problem, words)
                if wrong:
                    failed += 1
                    print(f"FAILED {seed}: system {words[1]}, sigma {words[2]}: {wrong}")
    print(f"degenerate.py: {problems} problems of {count} circuits, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
