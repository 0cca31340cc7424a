#!/usr/bin/env python3
"""Long ladders of diodes and capacitors, where Newton's method from rest leads astray: leaps have to find the orbit.

usage: ladders.py PROGRAM

How many steps and periods that takes is bounded, also where leaps lead astray instead, and what is found agrees with a
formula or with a long run. Without leaps (steady_continuation.c) the ideal ladders take 500 to 950 periods.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
from settled import off  # pylint: disable=import-error

MOST_STEPS = 25
MOST_PERIODS = 350
LONGEST_RUN = 6000


def cockcroft_walton(stages, source="V1 ac 0 SIN(0 100 1k)\n", store=lambda k: 10e-6, diode="", load="10meg"):
    text, up, down = source, "ac", "0"
    for k in range(1, stages + 1):
        text += (f"Ca{k} {up} a{k} {store(k)!r}\nDa{k} {down} a{k} {diode}\nCb{k} {down} b{k} {store(k)!r}\n"
                 f"Db{k} a{k} b{k} {diode}\n")
        up, down = f"a{k}", f"b{k}"
    return text + f"Ro {down} 0 {load}\n"


def dickson(stages, period):
    text = (f"Vin in 0 3.3\nVa ck0 0 PULSE(0 3.3 0 0 0 {period / 2!r} {period!r})\n"
            f"Vb ck1 0 PULSE(3.3 0 0 0 0 {period / 2!r} {period!r})\nD0 in n0 dm\n.model dm D(Vfwd=0.4)\n")
    for k in range(stages):
        text += f"R{k} ck{k % 2} c{k} 5k\nC{k} c{k} n{k} 10p\nD{k + 1} n{k} n{k + 1} dm\n"
    return text + f"Co n{stages} 0 50p\nRo n{stages} 0 20meg\n"


def two_sided(stages):
    """Two columns that two sources pump in opposite phase, and one between them that smooths."""
    text, a, b, c = "V1 p 0 SIN(0 1k 20k)\nV2 q 0 SIN(0 1k 20k 0 0 180)\n", "p", "q", "0"
    for k in range(stages):
        text += (f"Ca{k} {a} a{k} 2n\nCb{k} {b} b{k} 2n\nDa{k} {c} a{k}\nDb{k} {c} b{k}\n"
                 f"Dc{k} a{k} c{k}\nDd{k} b{k} c{k}\nCc{k} {c} c{k} 1n\n")
        a, b, c = f"a{k}", f"b{k}", f"c{k}"
    return text + f"Ro {c} 0 200meg\n"


# name, netlist; mean: of a signal and what a formula makes of it, to a part of it
CASES = [(f"{n} stages", cockcroft_walton(n),
          (f"v(b{n})", 200.0 * n, (2 / 3 * n ** 3 + n ** 2 / 2 - n / 6) / (1e7 * 1e3 * 10e-6), n)) for n in (10, 20, 30, 40)] + [
    ("unequal capacitors", cockcroft_walton(15, store=lambda k: 10e-6 / k), None),
    ("resistance in each diode", cockcroft_walton(12, diode="dr") +
     ".model dr D(Ron=5)\n", None),
    ("a source with a resistance", cockcroft_walton(16, source="V1 v 0 SIN(0 5 50)\nR1 v ac 1\n", store=lambda k: 1e-3), None),
    ("Dickson, 12 stages", dickson(12, 1e-6), None),
    ("Dickson, 30 stages", dickson(30, 2e-7), None),
    ("two sides", two_sided(10), None),
]


def boost(siemens, farads):
    """Its integral takes thousands of periods: from far away leaps lead to where the switch stays closed."""
    return ("Vin in 0 12\nL1 in sw 47u\nS1 sw 0 g 0 sm\nD1 sw out\nC1 out 0 47u\nR1 out 0 20\n"
            f"Gi 0 int VALUE={{{siemens!r}*(5-v(out)*5/24)}}\nCi int 0 {farads!r}\nVtri tri 0 PULSE(0 1 0 9.98u 0.01u 0.01u 10u)\n"
            "E2 g 0 VALUE={v(int)-v(tri)}\n.model sm SW(Ron=10m Vt=0)\n")


# Leaps that lead away are few at first: with all of them these take 122 and 63 steps, 375 and 237 periods.
MISLED = [("a boost converter with a slow integral", boost(1e-7, 1e-7), (60, 220)),
          ("the same, less slow", boost(1e-6, 1e-7), (50, 220))]


def run(program, folder, netlist, verb, *options):
    (folder / "c.cir").write_text(netlist)
    done = subprocess.run([program, verb, "c.cir", "-q", "-o", "none", "--report", "c.json", *options], cwd=folder,
                          capture_output=True, text=True, check=False)
    return done, json.loads((folder / "c.json").read_text())


def look_at(checker, program, folder, name, body, formula, most=(MOST_STEPS, MOST_PERIODS)):
    done, report = run(program, folder, f"{name}\n{body}.pss uic\n.end\n", "steady")
    if not checker.check(done.returncode == 0, f"{name}: {done.stderr}"):
        return
    steady = report["steady"]
    largest = max(math.hypot(m["re"], m["im"]) for m in steady["multipliers"])
    checker.check(steady["stable"] and steady["exact"], f"{name}: {steady['verdict']}")
    checker.check(steady["newton"] <= most[0] and steady["periods"] <= most[1],
                  f"{name}: {steady['newton']} steps, {steady['periods']} periods")
    if formula is not None:
        signal, ideal, drop, stages = formula
        # I/(f C) (2 n^3/3 + n^2/2 - n/6) below the peak, for a small current I = ideal / R; the ripple is I/(f C) n (n + 1)/2
        mean = ideal / (1 + drop)
        within = mean * stages * (stages + 1) / 2 / (1e7 * 1e3 * 10e-6)
        value = steady["signals"][signal]["average"]
        checker.check(abs(value - mean) <= within, f"{name}: {value} instead of {mean} +- {within}")
    periods = math.ceil(1.3 * math.log(1e-12) / math.log(largest)) + 20
    if periods <= LONGEST_RUN:
        stop = periods * steady["period"]
        card = f".tran {stop!r} {stop!r} {stop * (1 - 1e-9)!r} uic\n.end\n"
        done, settled = run(program, folder, f"{name}\n{body}{card}", "run", "--tol", "1e-11", "--fill", "none")
        worst = off(steady, settled["final"]) if checker.check(done.returncode == 0, f"{name}: {done.stderr}") else 0
        checker.check(worst <= 1e-9, f"{name}: off by {worst:.2g} after {periods} periods")
        print(name, "off by", worst)
    print(name, steady["newton"], "steps", steady["periods"], "periods", largest)


# Beside a gate the columns of M go through segments one by one, without variation_rank.c.
IDLE_GATE = "Vidle idle 0 0\nAidle idle 0 0 0 0 off 0 0 SCHMITT Vt=1 Vh=0 Td=1p\nRidle off 0 1\n"
COMPARED = ("a source with a resistance", "two sides")


def compare_ways(checker, program, folder, name, body):
    """The same multipliers, whichever way M takes, to what large parts promise at this tolerance."""
    sizes = []
    for gate in ("", IDLE_GATE):
        done, report = run(program, folder, f"{name}\n{body}{gate}.pss uic\n.end\n", "steady", "--tol", "1e-9")
        if not checker.check(done.returncode == 0, f"{name}: {done.stderr}"):
            return
        sizes.append(sorted((math.hypot(m["re"], m["im"]) for m in report["steady"]["multipliers"]), reverse=True))
    worst = max(abs(a - b) for a, b in zip(*sizes))
    checker.check(worst <= 2e-8, f"{name}: multipliers differ by {worst:.2g} beside an idle gate")
    print(name, "multipliers differ by", worst)


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("ladders")
    with tempfile.TemporaryDirectory() as folder:
        for name, body, formula in dalcs_program.some_of(CASES):
            look_at(checker, program, pathlib.Path(folder), name, body, formula)
            if name in COMPARED:
                compare_ways(checker, program, pathlib.Path(folder), name, body)
        for name, body, most in MISLED:
            look_at(checker, program, pathlib.Path(folder), name, body, None, most)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
