#!/usr/bin/env python3
"""The rows of .tran with those that fill adds give the exact waveform, between them as well.

usage: between_rows.py PROGRAM CASE...

Each circuit of this folder runs on the grid of its own .tran, which none of them was given for this, and its rows
are joined to curves: at a time between two rows by the cubic through the two rows before and the two behind; by the
straight line where something happens between these, that is where two rows have the same time, and in the first gap
and the last. At a corner of a source, which has one row, the straight line may be the better one. At the times of the
exact rows such a curve is within 1e-6 of each signal's scale, and so it is of what --at gives in the middle of the
gaps beside events; with a tolerance of 1e-3 it is within that. What is ten times as near to an event, over the stop
time, may lie on its other side.

Prints the numbers of rows and the largest errors. With --curve lines the straight line is good enough everywhere. With --fill none there are the rows of the grid and of
events alone, each with the bits that it has among the others; in most circuits 1e-6 does not hold for them.
"""

import json
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from curves import error_at  # noqa: E402
from dalcs_program import Checker, run, some_of  # noqa: E402

SIDE = 10
SHORTEST = 1e-8  # of the stop time, of a gap: in a shorter one rounding of times may show

def worst_of(case, result, curves, rows):
    """The largest error of all signals over their scales, with its signal and time."""
    times = result.time
    worst = (0.0, "", 0.0)
    for place, (signal, scale) in enumerate(zip(case["signals"], case["scale"]), start=1):
        values = result.column(signal)
        for row in rows:
            if row[place] is not None:
                error = error_at(times, values, row[0], row[place], curves == "lines") / scale
                worst = max(worst, (error, signal, row[0]))
    return worst


def exact_rows(case, allowed):
    near = SIDE * allowed * case["stop"]
    return [row for row in case["rows"] if all(abs(row[0] - event[0]) > near for event in case["events"])]


def rows_beside_events(program, netlist, case, result):
    """What --at gives in the middle of the gaps around two rows of the same time, the first and the last."""
    times = result.time
    beside = {k for k in range(len(times) - 1) for i in range(max(k - 2, 0), min(k + 3, len(times) - 1))
              if times[i] == times[i + 1]} | {0, 1, len(times) - 3, len(times) - 2}
    middle = [0.5 * (times[k] + times[k + 1]) for k in sorted(beside)
              if times[k + 1] - times[k] > SHORTEST * case["stop"]]
    asked = run(program, netlist, method=None, report=False, at=middle)
    columns = [asked.column(signal) for signal in case["signals"]]
    return [[t, *(column[k] for column in columns)] for k, t in enumerate(middle)]


def check_case(checker, program, name):
    case = json.loads((HERE / f"{name}.json").read_text())
    netlist = HERE / f"{name}.cir"
    filled = run(program, netlist, method=None, report=False)
    lined = run(program, netlist, method=None, report=False, options=["--curve", "lines"])
    loose = run(program, netlist, method=None, report=False, tolerance=1e-3)
    plain = run(program, netlist, method=None, report=False, options=["--fill", "none"])
    beside = rows_beside_events(program, netlist, case, filled)
    errors = []
    for result, curves, allowed, rows in ((filled, "cubics", 1e-6, exact_rows(case, 1e-6)),
                                          (filled, "cubics", 1e-6, beside),
                                          (lined, "lines", 1e-6, exact_rows(case, 1e-6)),
                                          (loose, "cubics", 1e-3, exact_rows(case, 1e-3))):
        checker.check(result.status == 0, f"{name}: {result.stderr}")
        error, signal, time = worst_of(case, result, curves, rows)
        checker.check(error <= allowed, f"{name} by {curves}: {signal} is off by {error:.2e} of its scale at "
                      f"{time!r}, allowed {allowed:.0e}")
        errors.append(error)
    plain_error = worst_of(case, plain, "cubics", exact_rows(case, 1e-6))[0]
    print(f"{name}: {len(filled.rows)} rows, {max(errors[:2]):.1e} by cubics; {len(lined.rows)} rows, {errors[2]:.1e} "
          f"by lines; none added: {len(plain.rows)} rows, {plain_error:.1e} by cubics")
    rows = {tuple(row) for row in filled.rows}
    lost = [row[0] for row in plain.rows if tuple(row) not in rows]
    checker.check(not lost, f"{name}: the rows at {lost[:3]} are others with those that are added")
    return plain_error > 1e-6


def main():
    checker = Checker("between_rows")
    program, names = sys.argv[1], some_of(sys.argv[2:])
    coarse = sum(check_case(checker, program, name) for name in names)
    if len(names) > 10:  # or nothing would be tested
        checker.check(coarse >= len(names) / 2, f"the grids of all but {coarse} of {len(names)} are fine enough")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
