#!/usr/bin/env python3
"""Bifurcation diagrams: a buck converter whose period doubles at 24.516 V (Fossas and Olivar, IEEE Trans. CAS-I 43, 1996),
a map whose multiplier is known, what is refused.

usage: bifurcation.py PROGRAM
"""

import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

BUCK = """Voltage-mode buck converter of Hamill and Deane
Vin in 0 20
E1 cmp 0 VALUE={v(ramp)-8.4*(v(out)-11.3)}
Vramp ramp 0 PULSE(3.8 8.2 0 400u 0 0 400u)
S1 in sw cmp 0 sm
D1 0 sw
L1 sw out 20m
C1 out 0 47u
R1 out 0 22
.model sm SW(Ron=0 Vt=0)
.options dialect=ltspice
"""


def run(program, folder, text, *options):
    (folder / "c.cir").write_text(text)
    (folder / "c.csv").unlink(missing_ok=True)
    return subprocess.run([program, "steady", "c.cir", *options], cwd=folder, capture_output=True, text=True,
                          check=False)


def read(folder):
    """{parameter: [rows]}, a row as {name: value}."""
    found = {}
    with (folder / "c.csv").open() as file:
        for row in csv.DictReader(file):
            values = {name: float(value) for name, value in row.items()}
            found.setdefault(next(iter(values.values())), []).append(values)
    return found


def count_places(values, scale):
    places = []
    for value in values:
        if all(abs(value - p) > 1e-5 * scale for p in places):
            places.append(value)
    return len(places)


def check_buck(checker, program, folder):
    done = run(program, folder, BUCK + ".step Vin list 24 24.5 24.53 28 32 33.5\n.pss uic\n", "-q", "-o", "c.csv",
               "--samples", "40", "--settle", "1000", "--bifurcation", "c.svg")
    if not checker.check(done.returncode == 0, f"buck: {done.stderr}"):
        return
    found = read(folder)
    checker.check(all(len(rows) == 40 for rows in found.values()), "rows of each value")
    places = {vin: count_places([row["v(c1)"] for row in rows], 12) for vin, rows in found.items()}
    checker.check((places[24], places[24.5], places[28], places[32]) == (1, 1, 2, 4) and places[33.5] > 30, f"{places}")
    size = {vin: rows[0]["multiplier"] for vin, rows in found.items()}
    doubles = 24.5 + 0.03 * (1 - size[24.5]) / (size[24.53] - size[24.5])
    checker.check(abs(doubles - 24.516) < 2e-3, f"the period doubles at {doubles} V: {size}")
    text = (folder / "c.svg").read_text()
    checker.check(all(word in text for word in ("i(l1)", "v(c1)", "largest multiplier", "unstable orbit")), "c.svg")
    for vin in (24, 28, 33.5):
        done = run(program, folder, BUCK.replace("Vin in 0 20", f"Vin in 0 {vin}") + ".pss uic\n", "-q",
                   "--report", "c.json", "-o", "d.csv")
        steady = json.loads((folder / "c.json").read_text())["steady"]
        row = found[vin][0]
        off = max(abs(row["orbit(v(c1))"] / steady["states"]["c1"] - 1),
                  abs(row["orbit(i(l1))"] / steady["states"]["l1"] - 1))
        own = math.hypot(*(steady["multipliers"][0][part] for part in ("re", "im")))
        checker.check(off < 1e-9 and abs(row["multiplier"] / own - 1) < 1e-7, f"{vin} V: off by {off}, {own}, {row}")


def check_known(checker, program, folder):
    """A capacitor behind a resistor: exp(-T / R C), and its only state."""
    text = """Known
V1 in 0 PULSE(0 10 0 0 0 5u 10u)
R1 in out 1k
C1 out 0 10n
.options dialect=ltspice
.step dec R1 100 10k 5
.pss
"""
    done = run(program, folder, text, "-q", "-o", "c.csv", "--bifurcation", "c.html", "--settle", "3000")
    checker.check(done.returncode == 0, f"known: {done.stderr}")
    found = read(folder)
    checker.check(len(found) == 11 and "<svg" in (folder / "c.html").read_text(), f"{len(found)} values")
    for r, rows in found.items():
        own = math.exp(-1e-5 / (r * 1e-8))
        half = math.exp(-5e-6 / (r * 1e-8))
        state = 10 * (1 - half) * half / (1 - own)
        checker.check(len(rows) == 64 and abs(rows[0]["multiplier"] - own) < 1e-9, f"{r}: {rows[0]} for {own}")
        off = max(abs(row[name] - state) for row in rows for name in ("v(c1)", "orbit(v(c1))"))
        checker.check(off < 1e-8, f"{r}: off by {off}")


def check_words(checker, program, folder):
    step = BUCK + ".step Vin 20 21 1\n.pss uic\n"
    clockless = "No clock\nV1 a 0 10\nR1 a b 1k\nC1 b 0 1u\n.step R1 1k 2k 1k\n.pss\n"
    for text, options, code, words in (
            (BUCK + ".pss uic\n", ["--bifurcation", "c.svg"], 2, "the netlist has no .step"),
            (clockless, ["--samples", "5"], 2, "no source repeats"),
            (step, ["--bifurcation", "c.txt"], 2, "name it .svg, .png, .pdf or .html"),
            (step, ["--samples", "0"], 2, "--samples"), (step, ["--samples", "2e9"], 2, "--samples"),
            (step, ["--samples", "9999999"], 2, "--samples: more than 1000000 periods"),
            (step, ["--samples", "5", "--plot", "c.svg"], 2, "leave out --plot"),
            (step, ["--bifurcation", "d.svg", "--multipliers-plot", "c.svg"], 2, "leave out --plot")):
        done = run(program, folder, text, "-q", "-o", "c.csv", *options)
        checker.check(done.returncode == code and words in done.stderr, f"{options}: {done.returncode} {done.stderr}")
    done = subprocess.run([program, "run", "c.cir", "--samples", "5"], cwd=folder, capture_output=True, text=True,
                          check=False)
    checker.check(done.returncode == 2 and "are options of 'dalcs steady'" in done.stderr, f"run: {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("bifurcation")
    with tempfile.TemporaryDirectory() as name:
        for look in (check_buck, check_known, check_words):
            look(checker, program, pathlib.Path(name))
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
