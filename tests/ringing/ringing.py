#!/usr/bin/env python3
"""No ringing: what a method with poles at -1 adds to a waveform after each event.

usage: ringing.py PROGRAM half_wave_rl|six_pulse|buck_dcm

On the grid of .tran, with the default method: three increments in a row, each larger than rounding,
whose signs alternate, must be less than 1 % of all in each signal. A waveform that turns once, or
jumps, has no such triple; the trapezoidal rule has one at almost every row after a diode opens.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import NETLISTS, Checker, run  # noqa: E402

HALF_WAVE_RL = """A half-wave rectifier on R-L
V1 in 0 SIN(0 10 50)
D1 in a
R1 a b 10
L1 b 0 50m
.tran 20u 100m uic
.end
"""
CIRCUITS = {"half_wave_rl": HALF_WAVE_RL,
            "six_pulse": NETLISTS / "rectifiers" / "six_pulse.cir",
            "buck_dcm": NETLISTS / "converters" / "buck_dcm.cir"}
ROUNDING = 1e-11  # of the largest value of a signal, a hundred times what a step may leave
MOST = 0.01


def alternating(values):
    """The fraction of triples of increments that go up, down, up or down, up, down."""
    floor = ROUNDING * max(abs(value) for value in values)
    increments = [b - a for a, b in zip(values, values[1:])]
    signs = [(d > floor) - (d < -floor) for d in increments]
    triples = list(zip(signs, signs[1:], signs[2:]))
    return sum(1 for a, b, c in triples if a * b < 0 and b * c < 0) / len(triples)


def trapezoidal_freewheel():
    """What the measure must see: the voltage of an inductor cut off at a step of the trapezoidal
    rule, on whose current 0 the voltage alternates for ever."""
    return [1.0] * 100 + [(-1.0) ** k for k in range(400)]


def main():
    program, name = sys.argv[1:]
    checker = Checker(name)
    checker.check(alternating(trapezoidal_freewheel()) > 0.5, "the measure is blind")
    result = run(program, CIRCUITS[name], method=None)
    if checker.check(result.status == 0 and len(result.rows) > 1000,
                     f"exit {result.status}, {len(result.rows)} rows: {result.stderr}"):
        for signal in result.names[1:]:
            part = alternating(result.column(signal))
            print(f"{signal}: {100 * part:.3f} % of the increments alternate")
            checker.check(part < MOST, f"{100 * part:.2f} % of {signal}'s increments alternate")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
