#!/usr/bin/env python3
"""Circuits that have no solution or are ill-posed: what the program says of them, word by word.

usage: refused.py PROGRAM GROUP [--update]

Runs every GROUP_*.cir of this folder. NAME.err holds what stderr must be; the exit status must be 3
where that is an error of the netlist, 1 where no solution exists or none was found, 0 where it has no
error. Where none was found the report blames nothing. A netlist that has no solution says in a comment what the report must hold,

    * refused: KIND ELEMENTS... from TIME        or        ... at the operating point

in this order. One that is not refused says what its last row must hold, "* gives: v(1) = 0 i(v2) = 0".
An output file of an earlier run stays as it is, and nothing is left that the messages do
not name. Where it fails in .tran, implicit Euler must refuse it too, within a step and for the same
reason. With --update, NAME.err is written instead: read it before you keep it.
"""

import difflib
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parent
OLD = "of an earlier run\n"
OK, FAILED, BAD_NETLIST = 0, 1, 3


def run(program, netlist, folder, *options):
    """One run in an empty folder with an older output; exit status, stderr, report."""
    for path in folder.iterdir():
        path.unlink()
    shutil.copy(netlist, folder)
    (folder / "out.csv").write_text(OLD)
    done = subprocess.run([program, "run", netlist.name, "-o", "out.csv", "--report", "r.json",
                           *options], cwd=folder, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, check=False, timeout=60)
    report = folder / "r.json"
    return done.returncode, done.stderr, json.loads(report.read_text()) if report.exists() else {}


def expected_status(messages):
    if ": error: " not in messages:
        return OK
    is_refused = "no solution exists" in messages or "none was found" in messages
    return FAILED if is_refused else BAD_NETLIST


def refusal_of(netlist):
    """(kind, elements, time or None at the operating point) as the netlist says; None without."""
    found = re.search(r"^\* refused: (\S+) (.*) (?:from (\S+)|at the operating point)$",
                      netlist.read_text(), re.MULTILINE)
    if found is None:
        return None
    time = found.group(3)
    return found.group(1), found.group(2).split(), None if time is None else float(time)


def check_files(checker, name, folder, status, said):
    left = {path.name for path in folder.iterdir()} - {f"{name}.cir"}
    if status == OK:
        checker.check(left == {"out.csv", "r.json"}, f"{name}: left {sorted(left)}")
        return
    checker.check((folder / "out.csv").read_text() == OLD, f"{name}: out.csv was touched")
    named = set(re.findall(r"'(out\.(?:failed\.dalcs|partial\.csv))'", said))
    checker.check(left - {"r.json"} == {"out.csv"} | named, f"{name}: left {sorted(left)}")
    checker.check(status != BAD_NETLIST or left == {"out.csv"}, f"{name}: left {sorted(left)}")


def check_report(checker, name, report, refusal, said):
    kind, elements, time = refusal
    found = report.get("infeasible", {})
    checker.check(found.get("kind") == kind and found.get("elements") == elements,
                  f"{name}: not {kind} {elements} but {found}")
    checker.check(found.get("because") and f"no solution exists: {found['because']}\n" in said,
                  f"{name}: its report has another reason: {found}")
    checker.close(found.get("time", -1.0), time or 0.0, 1e-8 * (time or 0.0), f"{name}: time")


def check_partial(checker, name, folder, time):
    """No row is from a time at which there is no solution."""
    partial = folder / "out.partial.csv"
    if partial.exists():
        last = float(partial.read_text().splitlines()[-1].split(",")[0])
        checker.check(last <= time * (1 + 1e-8), f"{name}: has a row at {last}")


def check_values(checker, netlist, folder):
    """What is not determined has its conventional value, and all else is right."""
    names, *rows = (line.split(",") for line in (folder / "out.csv").read_text().splitlines())
    last = dict(zip(names, map(float, rows[-1])))
    found = re.search(r"^\* gives: (.*)$", netlist.read_text(), re.MULTILINE)
    for signal, value in re.findall(r"(\S+) = (\S+)", found.group(1) if found else ""):
        checker.close(last[signal], float(value), 1e-7 * max(abs(float(value)), 1.0),
                      f"{netlist.stem}: {signal}")


def check_with_euler(checker, program, netlist, folder, refusal):
    kind, elements, time = refusal
    step = 1e-6
    name = f"{netlist.stem} with euler"
    status, said, report = run(program, netlist, folder, "--method", "euler", "--step", str(step))
    found = report.get("infeasible", {})
    checker.check(status == FAILED, f"{name}: exit {status}: {said}")
    checker.check(found.get("kind") == kind and sorted(found["elements"]) == sorted(elements),
                  f"{name}: not {kind} {elements} but {found}")
    late = found.get("time", -1.0) - time
    checker.check(-1e-8 * time <= late <= 1.01 * step, f"{name}: {late} s late")
    check_files(checker, netlist.stem, folder, status, said)


def check(checker, program, netlist, folder):
    name = netlist.stem
    status, said, report = run(program, netlist, folder)
    wanted = netlist.with_suffix(".err").read_text()
    refusal = refusal_of(netlist)
    checker.check(said == wanted, f"{name}:\n" + "".join(
        difflib.unified_diff(wanted.splitlines(True), said.splitlines(True), "expected", "said")))
    checker.check(status == expected_status(wanted), f"{name}: exit {status}")
    is_certain = "no solution exists" in wanted
    checker.check((refusal is not None) == is_certain, f"{name}: exit {status}, {refusal}")
    checker.check(is_certain or "infeasible" not in report, f"{name}: the report blames something")
    check_files(checker, name, folder, status, said)
    if status == OK:
        check_values(checker, netlist, folder)
    if refusal is None:
        return
    check_report(checker, name, report, refusal, said)
    if refusal[2] is not None:
        check_partial(checker, name, folder, refusal[2])
        if "method=" not in netlist.read_text():
            check_with_euler(checker, program, netlist, folder, refusal)


def main():
    program, group = str(pathlib.Path(sys.argv[1]).resolve()), sys.argv[2]
    checker = Checker(f"refused_{group}")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for netlist in sorted(FOLDER.glob(f"{group}_*.cir")):
            if sys.argv[3:] == ["--update"]:
                netlist.with_suffix(".err").write_text(run(program, netlist, folder)[1])
            else:
                check(checker, program, netlist, folder)
    return 0 if sys.argv[3:] == ["--update"] else checker.finish()


if __name__ == "__main__":
    sys.exit(main())
