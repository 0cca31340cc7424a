#!/usr/bin/env python3
"""Two methods that share no formula agree on a circuit whose exact solution nobody has.

usage: second_method.py PROGRAM CASE

The first is the default method with a tolerance of 1e-9. The second is implicit Euler with a fixed
step h, h/2 and h/4, its errors of first order taken out by Richardson: E(h) = 2 x(h/2) - x(h).
Where diodes change inside a step the rest of E is of second order with a factor that depends on
where they do, so a further extrapolation would gain nothing; but the spread |E(h) - E(h/2)| shows
that rest: it is about three times the error of E(h/2), a few times less where the factors happen
to be alike. Hence two waveforms may differ by ten times the largest spread of the signal. That
spread must be below 1e-5 of the signal, so what passes agrees to 1e-4 at least, and a wrong mode
is worse by far.

No circuit here has a switch that is commanded by anything but edges of width 0: Euler closes
others at the end of a step, an error of first order that three steps may share and no spread
shows.

Rows nearer to an event than six steps are left out: there one solution may be behind the event and
the other before it.

Besides, 3, 5 and 7 stages at the same tolerance must agree with each other to 1e-8.
"""

import bisect
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

STEPS = 50000        # of the first ladder rung
ROWS = 60
NEAR = 6             # steps of the first rung
FINE = 1e-9
SPREADS = 10
USEFUL = 1e-5        # of the scale: the largest spread that proves anything
AGREEMENT = 1e-8
FLOOR = 1e-6         # of the largest signal of its kind, a scale for what is zero
SUFFIX = {"": 1.0, "m": 1e-3, "u": 1e-6, "n": 1e-9}


def largest_difference(one, other):
    return max(abs(a - b) for a, b in zip(one, other))


def main():
    program, name = sys.argv[1:]
    netlist, checker = HERE / f"{name}.cir", Checker(name)
    number, suffix = re.search(r"^\.tran\s+\S+\s+([0-9.]+)([mun]?)\b", netlist.read_text(),
                               re.M).groups()
    stop = float(number) * SUFFIX[suffix]
    step = stop / STEPS
    # On the grid of all three runs of Euler, which so need no interpolation.
    at = [round((k + 0.382) / ROWS * STEPS) * step for k in range(ROWS)]

    def solve(label, **options):
        result = run(program, netlist, **options)
        if not checker.check(result.status == 0, f"{label}: exit {result.status}: {result.stderr}"):
            raise SystemExit(checker.finish())
        return result

    euler = [solve(f"euler, step {step / part:g}", step=step / part, at=at) for part in (1, 2, 4)]
    events = sorted(event["time"] for result in euler for event in result.report["events"])
    kept = [t for t in at if bisect.bisect(events, t - NEAR * step)
            == bisect.bisect(events, t + NEAR * step)]
    checker.check(len(kept) >= ROWS // 2, f"only {len(kept)} rows are away from events")
    rows = [at.index(t) for t in kept]
    signals = euler[0].names[1:]

    def waveform(result, signal):
        column = result.column(signal)
        return [column[row] for row in rows]

    scale = {signal: max(max(map(abs, waveform(euler[2], signal))), FLOOR * euler[2].scale(signal))
             for signal in signals}
    default = solve("default method", at=at, method=None, tolerance=FINE)
    worst = (0.0, "nothing", 0.0)
    for signal in signals:
        x = [waveform(result, signal) for result in euler]
        first, second = ([2 * b - a for a, b in zip(x[k], x[k + 1])] for k in range(2))
        spread = largest_difference(first, second) / scale[signal]
        checker.check(spread <= USEFUL, f"{signal}: Euler does not converge, spread {spread:.1e}")
        error = largest_difference(second, waveform(default, signal)) / scale[signal]
        checker.check(error <= SPREADS * spread + 2 * FINE,
                      f"{signal}: the methods differ by {error:.2e} of {scale[signal]:g}, the "
                      f"spread of Euler is {spread:.1e}")
        worst = max(worst, (error, signal, spread))
    print(f"{len(rows)} rows, worst difference {worst[0]:.1e} in {worst[1]}, spread {worst[2]:.1e}")

    stages = {s: solve(f"{s} stages", at=at, method="radau", stages=s, tolerance=FINE)
              for s in (3, 5, 7)}
    for one, other in ((3, 5), (5, 7), (3, 7)):
        for signal in signals:
            error = largest_difference(waveform(stages[one], signal),
                                       waveform(stages[other], signal)) / scale[signal]
            checker.check(error <= AGREEMENT,
                          f"{signal}: {one} and {other} stages differ by {error:.2e}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
