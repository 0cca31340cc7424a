#!/usr/bin/env python3
"""Runs one circuit of this folder with the default method and compares it with its exact solution.

usage: reference_case.py PROGRAM CASE [between|lobatto]

between: with seven stages, asked for by number, and tolerances between 1e-6 and 1e-9, each of which
must be kept: whoever asks for a number of stages gets no smaller errors than asked for.

lobatto: with that method, at the default tolerance and at 1e-9, audited in full; events to what 1e-9 of a sine moves its crossing by.

NAME.json holds, of the circuit NAME.cir:
  signals, scale  what is compared, and its largest value
  noise           error of the exact values over the scale, where that is above 1e-11
  events          [time, element, state] of each change of a diode or switch; those at time 0 are
                  changes against all elements off. A fourth number is the latest time: from the
                  first on the diode has neither current nor voltage, so it may count as either
  either          [element, from, to]: as before, but the same state before and after
  rows            time, then the value of each signal; null where the circuit does not determine it

A tolerance promises the largest error of a waveform over its scale, and parts as small as these are
held to 1e-9 where more is allowed. So at each tolerance rows must be right to that. None of them is
nearer to an event than 1e-6 of the stop time: an event that comes late by less does not hide in a row,
nor does it spoil one.

Events must be the exact ones, in number and order, at each tolerance from 1e-3 to 1e-10. Their
times are exact to 1e-11 of the stop time: a waveform error of 1e-9 moves a crossing of a
sine by 1e-9/(2 pi) of its period, of which most runs here have several. With seven stages by number
they are to ten times the tolerance, for a current may come down to zero slowly. Two whose exact times
differ by less may come in either order. One at the very end may come or not.
"""

import json
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

DEFAULT = 1e-6
FINE = 1e-9          # what is kept at any tolerance
EVENT_TIME = 1e-11   # of the stop time
SLOW = 10
SINE = 1 / (2 * math.pi)  # of a period, for each of its amplitude; a run is no shorter
CERTIFIED = 2e-13
TOLERANCES = [10.0 ** -k for k in range(3, 11)]
# step lengths depend on the tolerance: these meet transients and events in other ways
BETWEEN = [10.0 ** -(6.0 + k / 6.0) for k in range(1, 18)]


def compare_rows(checker, case, result, allowed, label):
    """Each compared value within `allowed` of its scale; returns the worst error."""
    if not checker.check([row[0] for row in result.rows] == [row[0] for row in case["rows"]],
                         f"{label}: the rows are not at the times asked for"):
        return math.inf
    worst = 0.0
    for place, (signal, scale) in enumerate(zip(case["signals"], case["scale"]), start=1):
        found, limit = result.column(signal), max(allowed, case["noise"].get(signal, 0.0))
        errors = [(abs(value - row[place]) / scale, row[0])
                  for value, row in zip(found, case["rows"]) if row[place] is not None]
        # A NaN is larger than any number here.
        error, time = max(errors, key=lambda e: math.inf if math.isnan(e[0]) else e[0])
        checker.check(error <= limit, f"{label}: {signal} is off by {error:.2e} of its scale "
                      f"at {time!r}, allowed {limit:.1e}")
        worst = max(worst, error)
    return worst


def found_events(case, result):
    """The events of a run without those that set the start, and without pairs in a tie."""
    slack = EVENT_TIME * case["stop"]
    found = [(e["time"], e["element"], e["state"]) for e in result.report["events"]
             if e["time"] > slack]
    for element, first, last in case["either"]:
        idle = [e for e in found if e[1] == element and first - slack <= e[0] <= last + slack]
        if len(idle) == 2:
            found = [e for e in found if e not in idle]
    return found


def compare_events(checker, case, result, allowed, label):
    """Number, order and times of events; returns the worst error in time over the stop time."""
    stop, found = case["stop"], found_events(case, result)
    slack = allowed * stop
    wanted = [event for event in case["events"] if event[0] > 0]
    while len(found) > len(wanted) and found[-1][0] >= stop - slack:
        found.pop()
    checker.check(len(found) == len(wanted),
                  f"{label}: {len(found)} events, not {len(wanted)}")
    # The k-th event of an element is the k-th one of the exact solution. When each comes at its
    # time and they ascend, they are in order.
    queue, worst, before = {}, 0.0, 0.0
    for time, element, state, *latest in wanted:
        queue.setdefault(element, []).append((state, time, latest[0] if latest else time))
    for time, element, state in found:
        wanted_state, first, last = (queue[element].pop(0) if queue.get(element)
                                     else ("none", math.nan, math.nan))
        error = max(first - time, time - last, 0.0) if state == wanted_state else math.inf
        worst = max(worst, error / stop)
        if not checker.check(error <= slack and time >= before,
                             f"{label}: {element} {state} at {time!r}, exactly {wanted_state} at "
                             f"{first!r}: off by {error / stop:.2e} of the stop time, allowed "
                             f"{slack / stop:.1e}"):
            break  # the next ones would only repeat it
        before = time
    return worst


def main():
    program, name = sys.argv[1:3]
    between, lobatto = sys.argv[3:] == ["between"], sys.argv[3:] == ["lobatto"]
    case, checker = json.loads((HERE / f"{name}.json").read_text()), Checker(name)
    times = [row[0] for row in case["rows"]]
    for tolerance in BETWEEN if between else [DEFAULT, FINE] if lobatto else TOLERANCES:
        label = f"tolerance {tolerance:.1e}" if between else f"tolerance {tolerance:.0e}"
        if between:
            result = run(program, HERE / f"{name}.cir", at=times, method="radau", stages=7,
                         tolerance=tolerance)
        else:
            result = run(program, HERE / f"{name}.cir", at=times, method="lobatto" if lobatto else None,
                         options=["--audit", "full"] if lobatto else [],
                         tolerance=None if tolerance == DEFAULT else tolerance)
        if not checker.check(result.status == 0, f"{label}: exit {result.status}: {result.stderr}"):
            continue
        certificate = result.report["certificate"]["worst"]
        checker.check(certificate <= CERTIFIED, f"{label}: certificate {certificate:.2e}")
        error, delay = ((tolerance, SLOW * tolerance) if between
                        else (FINE, SINE * FINE if lobatto else EVENT_TIME))
        worst = compare_rows(checker, case, result, error, label)
        late = compare_events(checker, case, result, delay, label)
        print(f"{label}: error {worst:.1e}, events {len(case['events'])} within {late:.1e}, "
              f"{result.report['work']['steps']} steps")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
