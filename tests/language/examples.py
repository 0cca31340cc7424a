#!/usr/bin/env python3
"""Runs each example of the documentation.

usage: examples.py PROGRAM PAGE.md

An example is a block that starts with ```spice. It runs without an error or a warning, and where a
comment says `* v(out) ends at 2.5`, it does, to the digits that are written; where it says
`* measured mean = 2.5m`, to 1e-10. A block may be several
files: a line `* ---- file NAME` starts the next one; the first is the netlist.
"""

import pathlib
import re
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error


def write(folder, block):
    """The files of a block; the path of the first."""
    parts = re.split(r"^\* ---- file (\S+)\n", block, flags=re.MULTILINE)
    names = ["example.cir"] + parts[1::2]
    for name, text in zip(names, parts[0::2]):
        (folder / name).write_text(text, encoding="utf-8")
    return folder / names[0]


def check_claims(checker, run, block, where):
    for signal, written in re.findall(r"^\* (\S+) ends at (\S+)$", block, re.MULTILINE):
        digits = len(written.partition(".")[2])
        checker.close(run.column(signal)[-1], float(written), 0.5 * 10.0 ** -digits,
                      f"{where}: {signal}")


def check_measurements(checker, run, block, where):
    found = {entry["name"]: entry["value"] for entry in run.report["measurements"]}
    for name, written, milli in re.findall(r"^\* measured (\S+) = ([-+.\de]+)(m?)$", block,
                                           re.MULTILINE):
        wanted = float(written) * (1e-3 if milli else 1.0)
        checker.close(found[name], wanted, 1e-10 * abs(wanted), f"{where}: {name}")


def main():
    program, page = sys.argv[1:]
    text = pathlib.Path(page).read_text(encoding="utf-8")
    checker = dalcs_program.Checker(pathlib.Path(page).name)
    for match in re.finditer(r"^```spice\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        where = f"line {text.count(chr(10), 0, match.start()) + 1}"
        with tempfile.TemporaryDirectory() as folder:
            run = dalcs_program.run(program, write(pathlib.Path(folder), match.group(1)),
                                    method=None)
        checker.check(run.status == 0 and "warning" not in run.stderr, f"{where}: {run.stderr}")
        if run.status == 0:
            check_claims(checker, run, match.group(1), where)
            check_measurements(checker, run, match.group(1), where)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
