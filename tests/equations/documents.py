#!/usr/bin/env python3
"""The example of doc/system-file.md runs; files with mistakes are refused with their line; the text names
elements.

usage: documents.py DALCS"""

import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))

import dalcs_program  # noqa: E402

GOOD = "dalcs-system 2 t\nstate x 1\npair d\nmatrix A\n+ -1\nmatrix B\n+ 1\nmatrix C\n+ 1\n.tran 1m 1\n"
MISTAKES = [
    ("matrix A\n+ -1\n", "matrix A\n+ -1 2\n", ":4:8: error: the matrix is 1 by 1"),
    ("matrix A\n", "matrix Q\n", "no matrix is called 'q'"),
    ("state x 1\n", "stat x 1\n", "did you mean 'state'"),
    ("pair d\n", "interval d 1 -1\n", "the upper bound must be greater"),
    (".tran 1m 1\n", "", "has no analysis"),
    ("matrix A\n+ -1\n", "matrix P\n+ 0\n", "is singular"),
    ("matrix A\n+ -1\n", "matrix E\n+ 1\n", "the system has no inputs"),
    ("matrix A\n+ -1\n", 'matrix A "missing.mtx"\n', "cannot read the matrix"),
    ("pair d\n", "contact d\n", "belongs to a system of coordinates"),
    ("state x 1\npair d\n", "pair d\n", "of which the system has no states"),
]
# 2 t - t rises above 0.5 at 0.5 s: the state alone would at 0.25 s, the input never.
COMMANDED = """dalcs-system 2 a switch commanded by a state and an input
input u PWL(0 0 1 -1)
input one 1
state x 0
switch s on=0.5 off=0.4
matrix E
+ 0 2
matrix D
+ 1
matrix control
+ 1 0
matrix direct_control
+ 1 0
.tran 0.1 1
"""


def call(program, *arguments):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False)


def main():
    program = sys.argv[1]
    checker = dalcs_program.Checker("documents")
    example = (dalcs_program.ROOT / "doc" / "system-file.md").read_text().split("```\n")[1]
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "s.dalcs"
        output = pathlib.Path(folder) / "o.csv"
        path.write_text(example)
        done = call(program, "run", path, "-o", output, "--quiet")
        if checker.check(done.returncode == 0, f"the example: {done.stderr}"):
            last = output.read_text().splitlines()[-1].split(",")
            checker.close(float(last[1]), 4.72092260618, 1e-6, "the example's z(20 ms)")
        path.write_text(COMMANDED)
        events = dalcs_program.run(program, path, method=None).report["events"]
        if checker.check([event["element"] for event in events] == ["s"], f"events {events}"):
            checker.close(events[0]["time"], 0.5, 1e-11, "the switch closes at")
        path.write_text(GOOD)
        done = call(program, "run", path, "-o", output, "--quiet")
        checker.check(done.returncode == 0, f"without a mistake: {done.stderr}")
        for right, wrong, message in MISTAKES:
            checker.check(right in GOOD, right)
            path.write_text(GOOD.replace(right, wrong))
            done = call(program, "run", path, "-o", output)
            checker.check(done.returncode == 3 and message in done.stderr,
                          f"{wrong!r}: status {done.returncode}, {done.stderr}")
    buck = dalcs_program.NETLISTS / "converters" / "buck.cir"
    text = call(program, "equations", buck).stdout
    for line in ("C1 dv(c1)/dt = i(l1) - v(out)/R1", "L1 di(l1)/dt = v(sw) - v(out)",
                 "0 <= i(d1) _|_ v(sw) >= 0", "i(s1) = 0 or 0 = v(sw) - v(in)",
                 "[closed while vg(t) > 0.5]", "R1 = 2 Ohm"):
        checker.check(line in text, f"{line} is not in\n{text}")
    peak = dalcs_program.NETLISTS / "papers" / "bt10_fig_2_1.cir"
    step = call(program, "equations", peak, "--form", "osnsp", "--step", "1m", "--format", "json")
    if checker.check(step.returncode == 0, step.stderr):
        one = json.loads(step.stdout)["parts"][0]
        # the diode sees R and h/C in series: 1 kOhm + 1 ms / 1 uF, as a conductance
        checker.check(one.get("singular") or len(one["M"]) == 1, f"{one}")
    system = dalcs_program.NETLISTS / "papers" / "bt10_fig_2_1.dalcs"
    step = call(program, "equations", system, "--form", "osnsp", "--step", "1m", "--format", "json")
    # z in mA and uC: M = D + C (sigma P - A)^-1 B = 1 - 1 / (1 + 1)
    checker.close(json.loads(step.stdout)["parts"][0]["M"][0][0], 0.5, 1e-15, "M")
    for wrong in (["--format", "txt"], ["--form", "osnsp"], ["--step", "1"], ["--format", "matrix-market"]):
        checker.check(call(program, "equations", buck, *wrong).returncode == 2, f"{wrong} is usage")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
