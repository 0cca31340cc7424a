#!/usr/bin/env python3
"""Operating points of islands that capacitors alone tie to ground, with conductances over twelve decades.

usage: islands_at_rest.py DALCS COUNT [FIRST]

What sources bring into such an island they must take out of it, whatever its diodes do. Where they do not, the current has
no way out, and the run must say so. Where they do, the island's potential is open: it is near 0, the least norm, and no
two nodes are farther apart than all currents make of all resistances.
"""

import json
import pathlib
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import some_of  # noqa: E402

NONE_EXISTS = "no solution exists", "its current has no way out", "they do not balance"
FAINT = 1e-5  # a current beside another one that goes round: weights of equations far apart do not always tell it


class Island:
    def __init__(self, seed):
        self.chance = random.Random(seed)
        self.n = self.chance.randint(3, 9)
        self.lines, self.ohms, self.amperes = [], 0.0, []
        for k in range(2, self.n + 1):
            self.join(k, self.chance.randint(1, k - 1))
        for k in range(self.chance.randint(0, 4)):
            self.resistor(f"ra{k}", *self.two_nodes())
        for k in range(self.chance.randint(0, 2)):
            self.lines.append("da{} n{} n{} ideal".format(k, *self.two_nodes()))
        for k in range(self.chance.randint(1, 2)):
            self.lines.append(f"c{k} n{self.node()} 0 {self.chance.choice(['1n', '1u', '1', '100k'])}")
        self.clash = self.drive()

    def node(self):
        return self.chance.randint(1, self.n)

    def two_nodes(self):
        return self.chance.sample(range(1, self.n + 1), 2)

    def resistor(self, name, a, b):
        ohms = 10 ** self.chance.uniform(-5, 7)
        self.ohms += ohms
        self.lines.append(f"{name} n{a} n{b} {ohms:.3g}")

    def join(self, k, j):
        if self.chance.random() < 0.7:
            self.resistor(f"r{k}", j, k)
        else:
            self.lines += [f"d{k} n{j} n{k} ideal", f"db{k} n{k} n{j} ideal"]

    def source(self, name, a, b, amperes):
        self.amperes.append(abs(amperes))
        self.lines.append(f"{name} {a} {b} {amperes:.6g}")

    def drive(self):
        """Returns what comes in and does not go out, in amperes."""
        amperes = float(f"{10 ** self.chance.uniform(-6, 3):.4g}")
        self.source("i0", 0, f"n{self.node()}", amperes)
        if self.chance.random() < 0.5:
            self.source("i1", *(f"n{k}" for k in self.two_nodes()), 10 ** self.chance.uniform(-6, 3))
        back = self.chance.choice([1.0, 1.0, 1.0, None, 0.5, 2.0, -1.0])
        if back is None:
            return amperes
        self.source("i2", f"n{self.node()}", 0, back * amperes)
        return amperes * (1.0 - back)

    def netlist(self):
        return "\n".join(["an island at rest", *self.lines, ".model ideal D(Ron=0 Vfwd=0)", ".op", ".end", ""])


def wrong(dalcs, seed, folder):
    """What is wrong with this one, or None."""
    island = Island(seed)
    netlist = folder / "island.cir"
    netlist.write_text(island.netlist())
    report = folder / "report.json"
    done = subprocess.run([dalcs, netlist, "--quiet", "--report", report, "-o", folder / "o.raw"],
                          capture_output=True, text=True, timeout=60)
    if island.clash != 0.0:
        is_refused = done.returncode != 0 and any(words in done.stderr for words in NONE_EXISTS)
        is_faint = done.returncode == 1 and abs(island.clash) <= FAINT * max(island.amperes)
        return None if is_refused or is_faint else f"{island.clash:.3g} A clash: exit {done.returncode}, {done.stderr}"
    if done.returncode != 0:
        return f"balanced: exit {done.returncode}, {done.stderr}"
    volts = max(abs(of_capacitor) for of_capacitor in json.loads(report.read_text())["final"].values())
    most = island.ohms * sum(island.amperes)
    return None if volts <= most else f"balanced: {volts:.3g} V, at most {most:.3g} V"


def main():
    dalcs, count = sys.argv[1], int(sys.argv[2])
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        left_1e_43_volts = 5  # where 0 is the answer, beside 438 A
        for seed in sorted({left_1e_43_volts, *some_of(range(first, first + count))}):
            what = wrong(dalcs, seed, pathlib.Path(folder))
            if what:
                failures += 1
                print(f"FAILED island {seed}: {what}")
    print(f"islands at rest: {count} circuits, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
