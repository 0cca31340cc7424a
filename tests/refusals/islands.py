#!/usr/bin/env python3
"""What sources drive into a part that nothing ties to ground has to come out of it.

usage: islands.py PROGRAM

Each circuit is run twice, at several scales: with a current into the island alone, which grows from 0 so that the start
has a solution, and with its negative beside it. The first has to be refused in words about the island, the second holds.
"""

import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker  # noqa: E402

# The feeding source goes from a to isl1; {back} is the way back.
SOURCES = {
    "ramp": "PWL(0 0 {t} {i})",
    "late": "PWL(0 0 {half} 0 {t} {i})",
    "sine": "SIN(0 {i} {f})",
}
ISLANDS = {
    "node": "",
    "resistor": "Rf isl1 isl2 {r}\n",
    "capacitor": "Cf isl1 isl2 {c}\nRf isl2 isl1 {r}\n",
    "diodes": "D1 isl1 isl2 di\nD2 isl2 isl1 di\n.model di D(Ron=0)\n",
    "coil": "Lf isl1 isl2 {l}\nRf isl2 isl1 {r}\n",
}
MAIN = {"load": "R1 a 0 {r}\nC1 a c {c}\nR2 c 0 {r}\n", "resonant": "R1 a b {r}\nL1 b c {l}\nC1 c 0 {c}\n"}
SCALES = [(1.0, 1e3, 20e-6), (1e-6, 1e6, 1.0), (1e3, 1e-2, 1e-3)]  # A, ohm, s


def netlist(source, island, main, scale, is_balanced):
    i, r, t = scale
    values = {"i": i, "r": r, "t": t, "half": t / 2, "f": 1 / t, "c": t / r / 10, "l": t * r / 10}
    stimulus = SOURCES[source].format(**values)
    back = f"I2 isl1 a {stimulus}\n" if is_balanced else ""
    return (f"an island\nV1 a 0 SIN({r * i} {r * i} {1 / t})\nI1 a isl1 {stimulus}\n{back}"
            + ISLANDS[island].format(**values) + MAIN[main].format(**values) + f".tran {t / 50} {t}\n.end\n")


def run(program, text, folder):
    (folder / "x.cir").write_text(text)
    done = subprocess.run([program, "run", "x.cir", "-o", "none", "--quiet"], cwd=folder, capture_output=True,
                          text=True, check=False, timeout=120)
    return done.returncode, done.stderr


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    checker = Checker("islands")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for source in SOURCES:
            for number, island in enumerate(ISLANDS):
                main_part = list(MAIN)[number % 2]
                for scale in SCALES:
                    case = f"{source} into {island} beside {main_part} at {scale}"
                    status, said = run(program, netlist(source, island, main_part, scale, False), folder)
                    checker.check(status == 1, f"{case}: exit {status}\n{said}")
                    checker.check("isl" in said.split("error:")[-1] and "seems wrong" not in said, f"{case}:\n{said}")
                    status, said = run(program, netlist(source, island, main_part, scale, True), folder)
                    checker.check(status == 0, f"{case}, balanced: exit {status}\n{said}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
