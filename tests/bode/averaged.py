#!/usr/bin/env python3
"""Six converters against the formulas of averaged models (Erickson and Maksimovic, Fundamentals of Power Electronics,
chapters 2, 5, 8 and 11), and the table of doc/averaged.md against both.

usage: averaged.py PROGRAM PAGE
       averaged.py PROGRAM: prints the table
"""

import cmath
import csv
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

VIN, DUTY, L, C, T = 12.0, 0.4, 50e-6, 20e-6, 10e-6
LOADS = {"CCM": 5.0, "DCM": 500.0}
FREQUENCIES = (1e3, 1e4, 49e3)

POWER = {
    "buck": "S1 in sw cmp 0 sm\nD1 0 sw\nL1 sw out 50u\nC1 out 0 20u\nR1 out 0 {r}\n",
    "boost": "L1 in sw 50u\nS1 sw 0 cmp 0 sm\nD1 sw out\nC1 out 0 20u\nR1 out 0 {r}\n",
    "buck-boost": "S1 in sw cmp 0 sm\nL1 sw 0 50u\nD1 out sw\nC1 out 0 20u\nR1 out 0 {r}\n",
}

NETLIST = """{title}
Vin in 0 12
Vctl ctl 0 DC 0.4 AC 1
Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
E1 cmp 0 ctl tri 1
{power}.model sm SW(Ron=0 Vt=0)
.save v(out) i(l1)
.pss uic
.meas pss vavg avg v(out)
.meas pss di pp i(l1)
.meas pss dv pp v(out)
.ac list {frequencies}
"""


def ratio(kind, mode, r):
    """M(D), or M(D, K)."""
    k = 2 * L / (r * T)
    if mode == "CCM":
        return {"buck": DUTY, "boost": 1 / (1 - DUTY), "buck-boost": -DUTY / (1 - DUTY)}[kind]
    return {"buck": 2 / (1 + math.sqrt(1 + 4 * k / DUTY ** 2)), "boost": (1 + math.sqrt(1 + 4 * DUTY ** 2 / k)) / 2,
            "buck-boost": -DUTY / math.sqrt(k)}[kind]


def critical(kind):
    """K below which conduction is discontinuous."""
    return {"buck": 1 - DUTY, "boost": DUTY * (1 - DUTY) ** 2, "buck-boost": (1 - DUTY) ** 2}[kind]


def ripple(kind, mode, v):
    """From peak to peak of the coil's current: what it gains while the switch is closed."""
    del mode
    return (VIN - (v if kind == "buck" else 0.0)) * DUTY * T / L


def response(kind, mode, r, s):
    """Of v(out) to the duty cycle."""
    m = ratio(kind, mode, r)
    v = m * VIN
    if mode == "CCM":
        rest = 1.0 if kind == "buck" else 1 - DUTY
        zero = {"buck": 0.0, "boost": L / (rest ** 2 * r), "buck-boost": DUTY * L / (rest ** 2 * r)}[kind]
        gain = {"buck": v / DUTY, "boost": v / rest, "buck-boost": v / (DUTY * rest)}[kind]
        w0, q = rest / math.sqrt(L * C), rest * r * math.sqrt(C / L)
        return gain * (1 - s * zero) / (1 + s / (q * w0) + (s / w0) ** 2)
    gain, pole = {"buck": (2 * v / DUTY * (1 - m) / (2 - m), (2 - m) / ((1 - m) * r * C)),
                  "boost": (2 * v / DUTY * (m - 1) / (2 * m - 1), (2 * m - 1) / ((m - 1) * r * C)),
                  "buck-boost": (v / DUTY, 2 / (r * C))}[kind]
    return gain / (1 + s / pole)


def measure(program, folder, kind, r):
    text = NETLIST.format(title=kind, power=POWER[kind].format(r=repr(r)),
                          frequencies=" ".join(map(repr, FREQUENCIES)))
    (folder / "c.cir").write_text(text)
    done = subprocess.run([program, "run", "c.cir", "-q", "-o", "c.csv", "--report", "c.json"], cwd=folder,
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return None, done.stderr
    report = json.loads((folder / "c.json").read_text())
    found = {m["name"]: m["value"] for m in report["measurements"]}
    with (folder / "c.csv").open() as file:
        rows = [list(map(float, row)) for row in list(csv.reader(file))[1:]]
    found["response"] = [complex(row[1], row[2]) for row in rows]
    return found, ""


def lines_of(program, folder):
    """The table, and what it is made of: (kind, mode, {quantity: (formula, exact)})."""
    lines, cases = [], []
    for mode, r in LOADS.items():
        for kind in POWER:
            found, why = measure(program, folder, kind, r)
            if found is None:
                return [why], []
            m = ratio(kind, mode, r)
            of = {"M": (m, found["vavg"] / VIN), "di": (ripple(kind, mode, m * VIN), found["di"])}
            cells = [f"{kind}, {mode}", f"{m:.4f}", f"{of['M'][1]:.4f}", f"{of['di'][0]:.3f}", f"{of['di'][1]:.3f}"]
            for frequency, exact in zip(FREQUENCIES, found["response"]):
                model = response(kind, mode, r, 2j * math.pi * frequency)
                of[frequency] = (model, exact)
                off = exact / model
                level = round(20 * math.log10(abs(off)), 2) + 0.0  # no -0.00
                turn = round(math.degrees(cmath.phase(off)), 1) + 0.0
                cells.append(f"{level:+.2f} dB, {turn:+.1f} deg")
            lines.append("| " + " | ".join(cells) + " |")
            cases.append((kind, mode, of))
    return lines, cases


# What the page states: parts of M and of the ripple, then dB and degrees at a hundredth, a tenth and nearly a half of
# the switching frequency.
STATED = {"CCM": (2e-3, 3e-3, ((0.02, 0.1), (0.02, 0.2), (0.4, 2.5))),
          "DCM": (2e-3, 5e-3, ((0.05, 1.2), (0.1, 11), (1.8, 46)))}


def check_differences(checker, cases):
    for kind, mode, of in cases:
        k = 2 * L / (LOADS[mode] * T)
        checker.check((k > critical(kind)) == (mode == "CCM"), f"{kind} {mode}: K = {k}")
        most_m, most_ripple, most = STATED[mode]
        for quantity, limit in (("M", most_m), ("di", most_ripple)):
            model, exact = of[quantity]
            checker.check(abs(exact / model - 1) <= limit, f"{kind} {mode}: {quantity} {exact} for {model}")
        for frequency, (level, turn) in zip(FREQUENCIES, most):
            off = of[frequency][1] / of[frequency][0]
            own = 20 * math.log10(abs(off)), math.degrees(cmath.phase(off))
            checker.check(abs(own[0]) <= level and abs(own[1]) <= turn, f"{kind} {mode} at {frequency}: {own}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("averaged")
    with tempfile.TemporaryDirectory() as name:
        lines, cases = lines_of(program, pathlib.Path(name))
    if len(sys.argv) < 3:
        print("\n".join(lines))
        return 0
    checker.check(len(cases) == 6, lines[0])
    check_differences(checker, cases)
    page = pathlib.Path(sys.argv[2]).read_text()
    for line in lines:
        checker.check(line in page, f"the page does not have {line}")
    checker.check(len(re.findall(r"^\| buck|^\| boost", page, re.M)) == len(lines), "rows of the table")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
