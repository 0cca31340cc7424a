#!/usr/bin/env python3
"""The gain of a loop and its margins, by a source in the closed loop; impedances.

usage: loop.py PROGRAM
"""

import cmath
import json
import math
import pathlib
import sys
import tempfile

from cases import response
import circuits

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

NETLISTS = pathlib.Path(__file__).resolve().parents[1] / "steady" / "cases"


def report_of(folder):
    return json.loads((folder / "c.json").read_text())["response"]


def margins(checker, program, folder):
    """Of the reference circuit; another program says 9865.13 Hz and 28.005 deg, the averaged model 10071 Hz."""
    text = (NETLISTS / "buck_vm.cir").read_text().replace(" AC 1", "")
    for verb, card, options in (("bode", "", ["--loop", "VINJ", "--from", "100", "--to", "45k"]),
                                ("run", ".ac dec 3 100 45k loop=vinj\n", []),
                                ("run", ".ac loop=vinj list 3k 30k\n", [])):
        netlist = text.replace("\n.end", "\n" + card)
        done, _, _ = response(program, folder, netlist, verb, [*options, "--report", "c.json"])
        if not checker.check(done.returncode == 0, f"{verb} {card}: {done.stderr}"):
            continue
        found = report_of(folder)
        checker.check(found["loop"] == "vinj" and len(found["crossovers"]) == 1, f"{found}")
        cross = found["crossovers"][0]
        checker.check(abs(cross["frequency"] - 9865.13) < 0.01, f"crossover at {cross}")
        checker.check(abs(cross["phase_margin"] - 28.005) < 1e-3, f"margin: {cross}")


def rows_of_gain(checker, program, folder):
    """The signal loop(v) is minus one side over the other; it does not depend on other sources with AC values."""
    text = (NETLISTS / "buck_vm.cir").read_text().replace("\n.end", "\n.ac dec 5 100 45k loop=vinj\n")
    text = text.replace("Vref ref 0 5", "Vref ref 0 5 AC 3")
    (folder / "c.csv").unlink(missing_ok=True)
    done, _, _ = response(program, folder, text)
    checker.check(done.returncode == 0, f"gain: {done.stderr}")
    lines = (folder / "c.csv").read_text().splitlines()
    names = lines[0].split(",")
    at = names.index("re(loop(vinj))")
    out, back = names.index("re(v(out))"), names.index("re(v(fb))")
    for line in lines[1:]:
        values = [float(v) for v in line.split(",")]
        gain = complex(*values[at:at + 2])
        own = -complex(*values[out:out + 2]) / complex(*values[back:back + 2])
        checker.check(abs(gain - own) <= 1e-12 * abs(own), f"gain {gain} for {own}")


def commands_beside(checker, program, folder):
    """Commands along ramps of sources with AC values of their own have no part in the gain of a loop."""
    gains = []
    for small in ("", " AC 3"):
        text = ("A loop behind an open one\nVin in 0 12\nVc c 0 0.4" + small + "\nVtri t 0 PULSE(0 1 0 10u 0 0 10u)\n"
                "E1 cmp 0 c t 1\nS1 in sw cmp 0 sm\nD1 0 sw\nL1 sw out 50u\nC1 out 0 20u\nR1 out 0 2\n"
                "Vl out fb 0\nG1 out 0 fb 0 0.5\n.model sm SW(Ron=0 Vt=0)\n.pss uic\n.ac list 2k 30k loop=vl\n")
        text = text.replace("list 2k 30k loop=vl", "loop=vl list 2k 30k")
        (folder / "c.csv").unlink(missing_ok=True)
        done, _, _ = response(program, folder, text)
        if not checker.check(done.returncode == 0, f"a loop behind an open one: {done.stderr}"):
            return
        lines = (folder / "c.csv").read_text().splitlines()
        at = lines[0].split(",").index("re(loop(vl))")
        gains.append([complex(*map(float, line.split(",")[at:at + 2])) for line in lines[1:]])
    checker.check(gains[0] == gains[1], f"gains {gains}")


def compare_designs(checker, program, folder):
    """Loops of ten converters cross where |T| = 1, and their gain is what the closed loop's response says: with T
    from one injection, v(fb) = 1 / (1 + T)."""
    for case in circuits.KINDS["closed_loop"]():
        case = case._replace(ac="vinj")
        low, high = 1e-3 / case.period, 0.49 / case.period
        card = f".ac dec 40 {low!r} {high!r} loop=vinj\n.pss uic\n.save v(out) v(fb)\n"
        done, _, _ = response(program, folder, circuits.netlist(case) + card, "run", ["--report", "c.json"])
        if not checker.check(done.returncode == 0, f"{case.name}: {done.stderr}"):
            continue
        found = report_of(folder)
        rows = [[float(v) for v in line.split(",")]
                for line in (folder / "c.csv").read_text().splitlines()[1:]]
        gains = [(row[0], complex(row[5], row[6]), complex(row[3], row[4])) for row in rows]
        for frequency, gain, back in gains:
            off = abs(back * (1 + gain) - (-1)) if abs(back * (1 + gain) + 1) < 1 else abs(back * (1 + gain) - 1)
            checker.check(off <= 1e-9 * (1 + abs(gain)), f"{case.name}: {off:.2g} at {frequency}")
        crossings = [(a, b) for a, b in zip(gains, gains[1:]) if (abs(a[1]) > 1) != (abs(b[1]) > 1)]
        checker.check(len(crossings) == len(found["crossovers"]) > 0, f"{case.name}: {found['crossovers']}")
        for (a, b), cross in zip(crossings, found["crossovers"]):
            checker.check(a[0] <= cross["frequency"] <= b[0], f"{case.name}: {cross} not in {a[0]}..{b[0]}")
            own = math.degrees(cmath.phase(-a[1])), math.degrees(cmath.phase(-b[1]))
            inside = min(own) - 0.1 <= cross["phase_margin"] <= max(own) + 0.1  # it may turn between
            checker.check(inside or abs(own[0] - own[1]) > 180, f"{case.name}: {cross} not in {own}")
        for cross in found["reversals"]:
            near = min(gains, key=lambda g: abs(g[0] - cross["frequency"]))
            off = abs(cross["gain_margin"] + 20 * math.log10(abs(near[1])))
            checker.check(off < 1.5 and near[1].real < 0, f"{case.name}: {cross} beside {near}")


def impedances(checker, program, folder):
    """An open-loop buck converter at a low frequency: R/D^2 at its input; at its output what L, C and R are."""
    text = """Impedances
Vin in 0 12%s
Vg g 0 PULSE(0 1 0 0 0 4u 10u)
S1 in sw g 0 sm
S2 sw 0 0 g sn
L1 sw out 50u
C1 out 0 20u
R1 out 0 2
Iac out 0 0%s
.model sm SW(Ron=0 Vt=0.5)
.model sn SW(Ron=0 Vt=-0.5)
.save v(out) i(vin)
.pss uic
.ac list 1m 1k 7.3k 49k 130k
"""
    done, _, rows = response(program, folder, text % (" AC 1", ""))
    checker.check(done.returncode == 0, done.stderr)
    checker.check(abs(-1 / rows[0][1]["i(vin)"] - 2 / 0.4 ** 2) < 1e-2, f"input: {-1 / rows[0][1]['i(vin)']}")
    done, _, rows = response(program, folder, text % ("", " AC 1"))
    checker.check(done.returncode == 0, done.stderr)
    largest = max(abs(values["v(out)"]) for _, values in rows)
    for frequency, values in rows:
        s = 2j * math.pi * frequency
        own = -1 / (1 / (50e-6 * s) + 20e-6 * s + 1 / 2)
        off = abs(values["v(out)"] - own)
        checker.check(off <= 1e-9 * abs(own) + 1e-13 * largest, f"output at {frequency}: {values} for {own}")


def parts(checker, program, folder):
    """A part that no small signal reaches is 0, though a floating charge of its own has a multiplier of 1, which at the
    clock's frequency would have no answer."""
    text = """Two parts
V1 a 0 PULSE(0 1 0 0 0 4u 10u)
R1 a b 1k
C1 b m 1n
C2 m 0 1n
Vin in 0 12 AC 2 90
R2 in out 1k
C3 out 0 1n
.save v(b) v(out) v(in)
.ac list 100k 159154.943091895
.pss uic
"""
    done, _, rows = response(program, folder, text)
    checker.check(done.returncode == 0 and "unstable" not in done.stderr, done.stderr)
    for frequency, values in rows:
        own = 2j / (1 + 2j * math.pi * frequency * 1e-6)
        checker.check(abs(values["v(out)"] - own) < 1e-12 and values["v(b)"] == 0, f"parts: {values} for {own}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("loop")
    with tempfile.TemporaryDirectory() as name:
        for look in (margins, rows_of_gain, commands_beside, compare_designs, impedances, parts):
            look(checker, program, pathlib.Path(name))
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
