#!/usr/bin/env python3
"""Rows that fill adds to random converters: the curve through all rows is the waveform there, too.

usage: between_rows.py PROGRAM SEED...

These ring, decay within picoseconds and rest for milliseconds, and steps meet anywhere. In gaps between rows, chosen
at random, the cubic (or line) through the rows is compared with what --at gives there: each signal within 1e-6 of its
largest value, or of 1e-5 of the largest of its unit where that is more. What is not unique is not compared.
"""

import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import converter_netlists  # noqa: E402
from curves import error_at  # noqa: E402
from dalcs_program import Checker, run, some_of  # noqa: E402

ALLOWED = 1e-6
GAPS = 1500
SHORTEST = 1e-9  # of the stop time, of a gap
LEAST_SHARE = 1e-5


def times_between(times, seed):
    draw = random.Random(seed)
    gaps = [k for k in range(len(times) - 1) if times[k + 1] - times[k] > SHORTEST * times[-1]]
    chosen = draw.sample(gaps, min(GAPS, len(gaps)))
    return sorted(times[k] + draw.uniform(0.2, 0.8) * (times[k + 1] - times[k]) for k in chosen)


def check_seed(checker, program, seed):
    netlist = converter_netlists.netlist(seed)
    result = run(program, netlist, method=None)
    if not checker.check(result.status == 0, f"seed {seed}: {result.stderr}"):
        return
    times = result.time
    asked = run(program, netlist, method=None, report=False, at=times_between(times, seed))
    not_unique = {entry["signal"] for entry in result.report["nonunique"]}
    sizes = {name: max(map(abs, result.column(name))) for name in result.names[1:]}
    for name, size in sizes.items():
        unit = max(other for signal, other in sizes.items() if signal[0] == name[0])
        scale = max(size, LEAST_SHARE * unit)
        if name not in not_unique and scale > 0.0:
            values = result.column(name)
            error, where = max((error_at(times, values, t, wanted) / scale, t)
                               for t, wanted in zip(asked.time, asked.column(name)))
            checker.check(error <= ALLOWED, f"seed {seed}: {name} is off by {error:.2e} at {where!r}")


def main():
    checker = Checker("between_rows")
    for seed in some_of(sys.argv[2:]):
        check_seed(checker, sys.argv[1], int(seed))
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
