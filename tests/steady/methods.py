#!/usr/bin/env python3
"""What a small difference does in a period does not depend on how steps are made: multipliers and responses by each method.

usage: methods.py PROGRAM

Circuits whose events change what states are allowed: a coil that comes to 0, capacitors that an ideal diode connects, a
ladder on sparse factors, gates, a switch whose diode takes over. The multiplier of a circuit without events has a closed form.
"""

import cmath
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

MOST_PERIODS = 50
SAME = 1e-6
METHODS = [["--method", "lobatto", "--stages", "5"], ["--method", "lobatto", "--stages", "9"], ["--method", "radau"]]


def ladder(stages):
    text, up, down = "V1 ac 0 SIN(0 100 1k) AC 1\nRs ac in 1\n", "in", "0"
    for k in range(stages):
        text += f"Ca{k} {up} a{k} 10u\nDa{k} {down} a{k}\nCb{k} {down} b{k} 10u\nDb{k} a{k} b{k}\n"
        up, down = f"a{k}", f"b{k}"
    return text + f"Ro {down} 0 2k\n"


CASES = {
    "discontinuous conduction": """Vin in 0 DC 12 AC 1
Vg g 0 PULSE(0 1 0 0 0 3u 10u)
S1 in sw g 0 sm
D1 0 sw
L1 sw out 10u
C1 out 0 10u
R1 out 0 50
.model sm SW(Ron=0 Vt=0.5)
""",
    "charge is shared": """V1 a 0 DC 1 AC 1
V2 g 0 PULSE(0 1 0 0 0 4u 10u)
V3 h 0 PULSE(0 1 5u 0 0 4u 10u)
R1 a p 1m
S1 p b g 0 sm
S2 b c h 0 sm
C1 b 0 1u
C2 c 0 3u
R2 c 0 1k
.model sm SW(Ron=0 Vt=0.5)
""",
    "a switch whose diode takes over": """V1 p 0 DC 100 AC 1
V2 g 0 PULSE(0 1 0 10n 10n 9.8u 20u)
V3 h 0 PULSE(0 1 10u 10n 10n 9.8u 20u)
S1 p a g 0 sm
S2 a 0 h 0 sm
D1 a p di
D2 0 a di
L1 a out 20u
C1 out 0 10u
R1 out 0 8
.model sm SW(Ron=10m Roff=10Meg Vt=0.5)
.model di D(Ron=10m Roff=10Meg)
""",
    "a latch that ends the pulse": """Vin in 0 DC 12 AC 1
Vclk clk 0 PULSE(0 1 0 0 0 100n 10u)
B1 below 0 V=1.2-0.3*i(L1)
A1 below 0 0 0 0 over 0 0 BUF Ref=0
A2 clk over 0 0 0 0 q 0 SRFLOP Td=50n
S1 in sw q 0 sm
D1 0 sw
L1 sw out 22u
C1 out 0 100u
R1 out 0 2
.model sm SW(Ron=10m Vt=0.5)
""",
    "sparse factors": ladder(14),
}

CLOSED = {"no event": math.exp(-10e-6 / 20e-6)}
CASES["no event"] = "V1 a 0 SIN(0 1 100k) AC 1\nR1 a b 20\nC1 b 0 1u\n"


def look(program, folder, netlist, options):
    """Periods, multipliers by size, and the response of the last state at two frequencies; or what it says."""
    (folder / "c.cir").write_text("* a period\n" + netlist + ".pss uic\n.ac lin 2 3k 41k\n.end\n")
    done = subprocess.run([program, "run", "c.cir", "-q", "-o", "c.csv", "--report", "c.json", *options], cwd=folder,
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return None, None, done.stderr
    steady = json.loads((folder / "c.json").read_text())["steady"]
    factors = sorted((complex(m["re"], m["im"]) for m in steady["multipliers"] if math.hypot(m["re"], m["im"]) > 1e-6),
                     key=lambda m: (-round(abs(m), 6), m.imag))
    with (folder / "c.csv").open(encoding="utf-8") as file:
        rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")][1:]
    return steady["periods"], factors, [[float(value) for value in row] for row in rows]


def far(a, b):
    """The largest difference of rows, of decibels and degrees or of parts, over the largest of them."""
    most = max(abs(value) for row in a for value in row[1:])
    return max((abs(x - y) / most for one, other in zip(a, b) for x, y in zip(one[1:], other[1:])
                if not math.isnan(x)), default=0.0)


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("methods")
    with tempfile.TemporaryDirectory() as folder:
        for name, netlist in CASES.items():
            _, factors, rows = look(program, pathlib.Path(folder), netlist, [])
            if not checker.check(factors is not None, f"{name}: {rows}"):
                continue
            if name in CLOSED:
                checker.check(len(factors) > 0 and abs(factors[0] - CLOSED[name]) < SAME, f"{name}: {factors}")
            for options in METHODS:
                said = f"{name} {' '.join(options)}"
                periods, others, answer = look(program, pathlib.Path(folder), netlist, options)
                if not checker.check(others is not None, f"{said}: {answer}"):
                    continue
                checker.check(periods <= MOST_PERIODS, f"{said}: {periods} periods")
                checker.check(len(others) == len(factors)
                              and all(cmath.isclose(a, b, abs_tol=SAME) for a, b in zip(factors, others)),
                              f"{said}: {others}, not {factors}")
                checker.check(len(answer) == len(rows) and far(rows, answer) < SAME, f"{said}: {answer}, not {rows}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
