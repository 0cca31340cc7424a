#!/usr/bin/env python3
"""As a teacher uses it: twelve circuits as ngspice solves them raise no alarm, and each with a fault put into its file does;
the table names the law, the place and the amount.

usage: doctored.py PROGRAM NGSPICE"""

import pathlib
import re
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from dalcs_program import Checker  # noqa: E402


class Raw:
    """A binary raw file of ngspice: its header, names and rows."""

    def __init__(self, content):
        header, data = content.split(b"Binary:\n", 1)
        self.header = header.decode()
        n = int(re.search(r"No. Variables:\s*(\d+)", self.header)[1])
        lines = self.header.split("Variables:\n")[1].splitlines()[:n]
        self.names = [line.split()[1] for line in lines]
        self.rows = [list(row) for row in struct.iter_unpack(f"<{n}d", data)]

    def content(self):
        form = f"<{len(self.names)}d"
        return self.header.encode() + b"Binary:\n" + b"".join(struct.pack(form, *row) for row in self.rows)

    def change(self, name, what, since=0.0, until=float("inf")):
        k = self.names.index(name)
        for row in self.rows:
            if since <= row[0] < until:
                row[k] = what(row[k])

    def swap(self, one, other):
        j, k = self.names.index(one), self.names.index(other)
        for row in self.rows:
            row[j], row[k] = row[k], row[j]

    def delay(self, name, rows):
        k = self.names.index(name)
        old = [row[k] for row in self.rows]
        for i in range(rows, len(old)):
            self.rows[i][k] = old[i - rows]


def spike(raw):
    raw.rows[len(raw.rows) // 2][raw.names.index("v(a)")] += 1.0


# name: (netlist, what is done to the file, [(law, element)] that the table must have as broken)
CIRCUITS = {
    "a low pass whose output is 1 % too large": (
        "v1 a 0 pulse(0 5 1m 1u 1u 4m 10m)\nr1 a b 1k\nc1 b 0 1u\n.tran 20u 20m\n",
        lambda raw: raw.change("v(b)", lambda v: 1.01 * v), [("KCL", "a"), ("BRANCH", "c1")]),
    "a tank whose current flows the other way": (
        "v1 a 0 sin(0 10 500)\nr1 a b 20\nl1 b c 10m\nc1 c 0 10u\nr2 c 0 1k\n.tran 20u 20m\n",
        lambda raw: raw.change("i(l1)", lambda i: -i), [("KCL", "b"), ("BRANCH", "c1"), ("BRANCH", "l1")]),
    "a transformer whose secondary lost a few turns": (
        "v1 a 0 sin(0 100 50)\nr1 a b 1\nl1 b 0 100m\nl2 c 0 25m\nk1 l1 l2 0.98\nr2 c 0 50\n.tran 50u 60m\n",
        lambda raw: raw.change("v(c)", lambda v: 0.97 * v), [("KCL", "c"), ("BRANCH", "l2")]),
    "two columns that changed places": (
        "v1 a 0 sin(0 5 1k)\nr1 a b 1k\nr2 b 0 2k\nc1 a c 100n\nc2 c 0 47n\nr3 b c 5k\nr4 c 0 10k\n.tran 5u 5m\n",
        lambda raw: raw.swap("v(b)", "v(c)"), [("KCL", "b"), ("BRANCH", "c2")]),
    "a switch that opens 5 us late": (
        "v1 in 0 12\nvg g 0 pulse(0 1 0 1u 1u 40u 100u)\ns1 in a g 0 sm off\nr1 a 0 10\nc1 a 0 1u\n"
        ".model sm sw(vt=0.5 vh=0.1 ron=0.1 roff=1meg)\n.tran 0.5u 1m\n",
        lambda raw: raw.change("v(a)", lambda v: 120 / 10.1, 41e-6, 46e-6), [("BRANCH", "c1")]),
    "a source that is clipped": (
        "v1 a 0 pwl(0 0 1m 5 2m 5 3m -5 4m 0)\nr1 a b 100\nl1 b c 10m\nr2 c 0 100\nc1 c 0 1u\n.tran 5u 5m\n",
        lambda raw: raw.change("v(a)", lambda v: min(v, 4.0)), [("BRANCH", "v1"), ("KCL", "a")]),
    "a discharge from less than it begins with": (
        "c1 a 0 10u ic=10\nr1 a b 10\nl1 b 0 1m ic=0.5\n.tran 2u 2m uic\n",
        lambda raw: raw.change("v(a)", lambda v: 0.9 * v), [("KCL", "b"), ("BRANCH", "c1")]),
    "one number that is off by a volt": (
        "i1 0 a sin(0 1 1k)\nr1 a 0 10\nc1 a 0 10u\nl1 a b 1m\nr2 b 0 2\n.tran 5u 5m\n", spike, [("BRANCH", "c1")]),
    "a formula with another gain": (
        "v1 a 0 sin(0 3 1k)\nb1 b 0 v=2*v(a)+1\nr1 b c 100\nc1 c 0 1u\nr3 a 0 100\n.tran 5u 5m\n",
        lambda raw: raw.change("v(b)", lambda v: 1.01 * v), [("BRANCH", "b1"), ("KCL", "b")]),
    "a product whose output is 3 % too large": (
        "v1 a 0 sin(0 3 1k)\nb1 b 0 v=v(a)*v(a)-v(a)\nr1 b c 100\nc1 c 0 1u\nr3 a 0 100\n.tran 5u 5m\n",
        lambda raw: raw.change("v(b)", lambda v: 1.03 * v), [("BRANCH", "b1"), ("KCL", "b")]),
    "a function whose argument hears late": (
        "v1 a 0 sin(0 1 1k)\nr1 a b 1k\nc1 b 0 100n\nb1 0 d i=1m*tanh(3*v(b))\nr2 d 0 1k\n.tran 5u 5m\n",
        lambda raw: raw.delay("v(b)", 10), [("KCL", "d"), ("KCL", "a")]),
    "a controlled source that hears late": (
        "v1 a 0 sin(0 1 1k)\nr1 a b 1k\nc1 b 0 100n\ne1 c 0 b 0 10\nr2 c d 100\nl1 d 0 5m\ng1 0 f b 0 2m\nr3 f 0 500\n"
        ".tran 5u 5m\n", lambda raw: raw.delay("v(b)", 3), [("BRANCH", "e1"), ("KCL", "f"), ("KCL", "a")]),
}


def audit(program, folder, content):
    (folder / "waves.raw").write_bytes(content)
    return subprocess.run([program, "audit", folder / "circuit.cir", folder / "waves.raw"], capture_output=True,
                          text=True, check=False)


def main(program, ngspice):
    checker = Checker("doctored")
    for name, (netlist, fault, broken) in CIRCUITS.items():
        with tempfile.TemporaryDirectory() as directory:
            folder = pathlib.Path(directory)
            (folder / "circuit.cir").write_text(f"{name}\n{netlist}.options reltol=1e-5\n.end\n")
            subprocess.run([ngspice, "-b", "-r", "right.raw", "circuit.cir"], cwd=folder, capture_output=True, check=True)
            raw = Raw((folder / "right.raw").read_bytes())
            done = audit(program, folder, raw.content())
            checker.check(done.returncode == 0 and "all " in done.stdout, f"{name}: as it is: {done.stdout}{done.stderr}")
            fault(raw)
            done = audit(program, folder, raw.content())
            lines = done.stdout.splitlines()
            checker.check(done.returncode == 1 and " broken, " in lines[-1], f"{name}: {done.stdout}{done.stderr}")
            checker.check(not re.search(r"\de[+-]?\d", "".join(lines[4:])), f"{name}: a number without a prefix: {done.stdout}")
            for law, where in broken:
                found = any(re.match(rf"  {law} +{where} .*[VAC] .*broken since", line) for line in lines)
                checker.check(found or any(re.match(rf"  {law} +{where} .*Wb.*broken since", line) for line in lines),
                              f"{name}: {law} of {where} is not told: {done.stdout}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
