#!/usr/bin/env python3
"""The reference circuits: their response against that of another program, from 1e-4 of the orbit's frequency to 0.95.

usage: cases.py PROGRAM

cases/NAME.json is what a prototype has found, and verified with a sine in the source; netlists are those of ../steady.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

CASES = pathlib.Path(__file__).resolve().parent / "cases"
NETLISTS = pathlib.Path(__file__).resolve().parents[1] / "steady" / "cases"
# How well the references are known (of the LLC: 1e-9), over the larger of the value and 1/100 of the output's largest.
TOLERANCE = 1e-8


def response(program, folder, netlist, verb="run", options=()):
    (folder / "c.cir").write_text(netlist)
    (folder / "c.csv").unlink(missing_ok=True)
    done = subprocess.run([program, verb, "c.cir", "-q", "-o", "c.csv", *options], cwd=folder,
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return done, [], []
    lines = (folder / "c.csv").read_text().splitlines()
    names = re.findall(r"re\(([vi]\([^()]*\))\)", lines[0])
    rows = [[float(v) for v in line.split(",")] for line in lines[1:]]
    return done, names, [(r[0], {n: complex(r[1 + 2 * k], r[2 + 2 * k]) for k, n in enumerate(names)})
                         for r in rows]


def look_at(checker, program, folder, name):
    expected = json.loads((CASES / f"{name}.json").read_text())["rows"]
    outputs = [k for k in expected[0] if k not in ("f", "ratio")]
    sweep = ".ac list " + " ".join(repr(row["f"]) for row in expected)
    text = re.sub(r"\.pss.*", "", (NETLISTS / f"{name}.cir").read_text())
    text = re.sub(r"\.save.*", "", text).replace("\n.end", "\n")
    text += f"\n.save {' '.join(outputs)}\n{sweep}\n.pss uic\n"
    found = []
    for verb, options in (("run", ()), ("bode", ()), ("bode", ("--tol", "1e-3"))):
        done, _, rows = response(program, folder, text, verb, options)
        if not checker.check(done.returncode == 0, f"{name} {verb} {options}: {done.stderr}"):
            return
        found.append(rows)
        for output in outputs:
            largest = max(abs(complex(*row[output])) for row in expected)
            for row, (frequency, values) in zip(expected, rows):
                value = complex(*row[output])
                off = abs(values[output] - value) / max(abs(value), 0.01 * largest)
                checker.check(off <= TOLERANCE, f"{name} {verb} {options}: {output} is off by {off:.2g} at "
                                                f"{frequency} Hz")
    checker.check(found[0] == found[1], f"{name}: 'dalcs bode' is not what .pss and .ac are")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("cases")
    with tempfile.TemporaryDirectory() as name:
        for case in dalcs_program.kinds_of(("bridge", "buck_ccm", "buck_dcm", "buck_pcm", "buck_vm", "llc")):
            look_at(checker, program, pathlib.Path(name), case)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
