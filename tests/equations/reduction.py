#!/usr/bin/env python3
"""`dalcs equations --form lcs` against the same elimination in rational numbers.

usage: reduction.py DALCS [NETLIST...]

The JSON of the DALCS is read as exact numbers; z = -B_II^-1 (A_II x + Bbar_II lambda + E_II s) is solved without
rounding, and every entry of the LCS, of its controls and of its outputs is compared with what that gives. What B_II
leaves open is singular there too, or would be but for rounding."""

import json
import pathlib
import subprocess
import sys
from fractions import Fraction

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))

import dalcs_program  # noqa: E402

TOLERANCE = Fraction(1, 10**12)


def equations(program, netlist, form):
    done = subprocess.run([program, "equations", str(netlist), "--form", form, "--format", "json"],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return None, done.stderr
    return json.loads(done.stdout), done.stderr


class System:
    """One of a file's systems. Columns are counted from 0 over x, z, lambda, the constant 1 and the inputs."""

    def __init__(self, system):
        self.cards, self.matrices = system["cards"], system["matrices"]
        words = [card[0] for card in self.cards]
        self.n_x, self.n_z = words.count("state"), words.count("unknown")
        self.n_pairs = sum(words.count(word) for word in ("pair", "switch", "reverse", "corner"))
        self.n = self.n_x + self.n_z + self.n_pairs

    def rows(self, n_rows, **names):
        """[{column: value}], of matrices side by side; each named after the part where it begins."""
        begin = {"x": 0, "z": self.n_x, "l": self.n_x + self.n_z, "one": self.n, "s": self.n + 1}
        rows = [{} for _ in range(n_rows)]
        for part, name in names.items():
            m = self.matrices.get(name, {"row": [], "column": [], "value": []})
            for i, j, value in zip(m["row"], m["column"], m["value"]):
                row, column = rows[int(i) - 1], int(j) - 1 + begin[part]
                row[column] = Fraction(float(row.get(column, 0)) + value)  # what is repeated adds up, as doubles do
        return rows

    def first(self):
        return self.rows(self.n_x, x="A_I", z="B_I", l="Bbar_I", s="E_I", one="constant_I")

    def second(self):
        return self.rows(self.n_z, x="A_II", z="B_II", l="Bbar_II", s="E_II", one="constant_II")

    def w(self):
        return self.rows(self.n_pairs, x="C_I", z="C_II", l="D", s="F", one="constant_F")

    def controls(self):
        """Empty for switches that sources alone move."""
        rows = self.rows(self.n_pairs, x="control")
        pairs = [card for card in self.cards if card[0] in ("pair", "switch", "reverse", "corner")]
        return [{} if "direct" in card else row for card, row in zip(pairs, rows)]

    def is_z(self, column):
        return self.n_x <= column < self.n_x + self.n_z


def eliminate(row, column, pivot):
    factor = row.pop(column, 0)
    for c, v in pivot.items() if factor != 0 else ():
        row[c] = row.get(c, 0) + factor * v


def solve(system):
    """{column of z: {column: factor}} by Gauss and Jordan in rational numbers; None where B_II is singular."""
    pivots = {}
    for row in system.second():
        for column, pivot in pivots.items():
            eliminate(row, column, pivot)
        candidates = [c for c, v in row.items() if system.is_z(c) and v != 0]
        if not candidates:
            return None
        column = candidates[0]
        scale = -1 / row.pop(column)
        new = {c: v * scale for c, v in row.items() if v != 0}
        for pivot in pivots.values():
            eliminate(pivot, column, new)
        pivots[column] = new
    return pivots


def without(row, solved):
    """The row without z, and of each column the largest of what was summed there."""
    total, largest = {}, {}
    for c, v in row.items():
        for to, factor in solved[c].items() if c in solved else ((c, 1),):
            total[to] = total.get(to, 0) + v * factor
            largest[to] = max(largest.get(to, 0), abs(v * factor))
    return total, largest


def by_names(system, row):
    """Columns of z are what is left of it, so that others have the same key in both systems."""
    first, last = system.n_x, system.n_x + system.n_z
    return {c if c < first else c - system.n_z if c >= last else f"z{c}": v for c, v in row.items()}


class Comparison:
    """A DALCS, exactly solved for z, beside the LCS that the program made of it."""

    def __init__(self, checker, what, before, after):
        self.checker, self.what, self.before, self.after = checker, what, before, after
        self.exact = solve(before)
        self.left = solve(after)  # what moves a switch may have stayed as an unknown
        # rounding of an entry of B_II moves z by this part of it
        largest = [max((abs(v) for row in rows for v in row.values()), default=1)
                   for rows in (before.second(), (self.exact or {}).values())]
        self.tolerance = TOLERANCE + Fraction(1, 10**16) * max(1, largest[0]) * max(1, largest[1])
        self.kept = after.n_z == before.n_z > 0 and after.second() == before.second()

    def is_singular(self):
        """In double precision: 0.1 + 0.1 + 0.1 - 0.3 is not 0 there, but makes numbers of 1e16."""
        return self.exact is None or max(abs(v) for row in self.exact.values() for v in row.values()) > 1e13

    def row(self, what, found, wanted):
        found, _ = without(found, self.left)
        wanted, size = without(wanted, self.exact)
        found, wanted, size = by_names(self.after, found), by_names(self.before, wanted), by_names(self.before, size)
        largest = max(size.values(), default=0)
        for column in set(found) | set(wanted):
            error = abs(found.get(column, 0) - wanted.get(column, 0))
            self.checker.check(error <= self.tolerance * size.get(column, 0) or error <= 1e-15 * largest,
                               f"{self.what}, {what}: column {column} is {float(found.get(column, 0))!r}, "
                               f"not {float(wanted.get(column, 0))!r}")

    def all_rows(self):
        for what in "first", "w", "controls":
            before, after = getattr(self.before, what)(), getattr(self.after, what)()
            for k, (found, wanted) in enumerate(zip(after, before)):
                self.row(f"{what} {k + 1}", found, wanted)


def probes(network, systems):
    """{(what, name, sign): (index of a system, {column: factor})}"""
    found = {}
    for card in network["cards"]:
        if card[0] not in ("output", "element"):
            continue
        words, sign = card[3:], "plus"
        while words:
            if words[0] == "minus":
                words, sign = words[1:], "minus"
            end = words.index("minus") if "minus" in words else len(words)
            index, row = int(words[1]) - 1, {}
            for name, factor in zip(words[2:end:2], words[3:end:2]):
                offset = -1 if name[0] == "#" else systems[index].n
                row[int(name[1:]) + offset] = Fraction(factor)
            found[card[0], card[1], sign] = index, row
            words = words[end:]
    return found


def check_netlist(checker, program, netlist):
    """(systems that lost z, systems that kept it)"""
    full, stderr = equations(program, netlist, "dalcs")
    reduced, words = equations(program, netlist, "lcs")
    if full is None:  # refused when it is read
        checker.check(reduced is None, f"{netlist.name}: {stderr}")
        return 0, 0
    if not checker.check(reduced is not None, f"{netlist.name}: {words}"):
        return 0, 0
    before, after = ([System(s) for s in data["networks"][0]["systems"]] for data in (full, reduced))
    parts = [Comparison(checker, f"{netlist.name}, part {k + 1}", *pair)
             for k, pair in enumerate(zip(before, after))]
    for part in parts:
        if part.kept:
            checker.check("cannot be eliminated" in words, f"{part.what}: z is there without a word")
            checker.check(part.is_singular(), f"{part.what}: z is there, yet B_II is regular")
        elif checker.check(part.exact is not None, f"{part.what}: reduced, yet B_II is singular"):
            part.all_rows()
    wanted, found = (probes(data["networks"][0], systems)
                     for data, systems in ((full, before), (reduced, after)))
    for key, (index, row) in wanted.items():
        if not parts[index].kept:
            parts[index].row(" ".join(key), found.get(key, (index, {}))[1], row)
    kept = sum(part.kept for part in parts)
    return sum(system.n_z > 0 for system in before) - kept, kept


def main():
    program = sys.argv[1]
    checker = dalcs_program.Checker("reduction")
    given = [pathlib.Path(name) for name in sys.argv[2:]]
    reduced = kept = 0
    every = sorted(p for p in dalcs_program.NETLISTS.rglob("*") if p.suffix in (".cir", ".dalcs"))
    every += sorted(pathlib.Path(__file__).parent.glob("*.cir"))
    chosen = given or dalcs_program.kinds_of(every)
    for netlist in chosen:
        done = check_netlist(checker, program, netlist)
        reduced, kept = reduced + done[0], kept + done[1]
    checker.check(bool(given) or (min(reduced, kept) > (20 if chosen == every else 3)), f"{reduced} reduced, {kept} kept")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
