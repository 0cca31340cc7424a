#!/usr/bin/env python3
"""A front runs through diodes at rest: small signals ahead of it keep the tolerance, too.

usage: fronts.py PROGRAM

Chains and trees of diodes that are at rest when a source reaches them. Exactly, each diode on the way
carries something from then on, the farther the less. With the default method and tolerance each node
is within 1e-6 of its scale (the documented one, at least 1e-5 of the largest voltage) of 7 stages at
1e-10, which follow a front 1e4 times closer; and the whole front passes in a few events, for it is
not found out diode by diode.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

STOP, ROWS, TOLERANCE, SMALLEST_SCALE = 1e-3, 52, 1e-6, 1e-5


def section(k, before):
    """A diode, something in series, a capacitor and a load; some with a coil or a clamp to ground."""
    lines = [f"d{k} n{before} m{k} di", f"c{k} n{k} 0 {('1u', '100n', '20n')[k % 3]}",
             f"rl{k} n{k} 0 {('10k', '1k', '50')[k * k % 7 % 3]}"]
    if k % 5 == 1:
        return lines + [f"l{k} m{k} n{k} 5u", f"rd{k} m{k} 0 100k"]
    if k % 5 == 3:
        return lines + [f"r{k} m{k} n{k} 0.1", f"dx{k} 0 n{k} di"]
    return lines + [f"r{k} m{k} n{k} {(5, 100)[k % 2]}"]


def network(title, source, sections, branches):
    lines = [title, f"v1 in 0 {source}", "rs in n0 10"]
    for k in range(1, sections + 1):
        lines += section(k, max(0, k - 4) if branches and k % 6 == 5 else k - 1)
    shown = " ".join(f"v(n{k})" for k in (1, 2, 5, 10, 20, 40))
    return "\n".join(lines + [".model di d", f".tran 1u {STOP} uic", f".save {shown}", ""])


def check(checker, program, name, netlist, largest):
    at = [(k + 0.382) / ROWS * STOP for k in range(ROWS)]
    exact = run(program, netlist, at=at, method="radau", stages=7, tolerance=1e-10)
    result = run(program, netlist, at=at, method=None)
    if not (checker.check(exact.status == 0, f"{name}: exit {exact.status}: {exact.stderr}")
            and checker.check(result.status == 0, f"{name}: exit {result.status}: {result.stderr}")):
        return
    for signal in result.names[1:]:
        scale = max(SMALLEST_SCALE * largest, max(map(abs, exact.column(signal))))
        error = max(abs(a - b) for a, b in zip(result.column(signal), exact.column(signal)))
        print(f"{name}: {signal} is off by {error / scale:.1e}")
        checker.check(error <= TOLERANCE * scale, f"{name}: {signal} is off by {error / scale:.1e}")


def check_events(checker, program):
    """Times at which diodes of a long ladder close, by its whole length from rest."""
    lines = ["ladder", "v1 in 0 sin(0 10 1k)", "rs in n0 10"]
    for k in range(1, 301):
        lines += [f"d{k} n{k - 1} m{k} di", f"r{k} m{k} n{k} 1", f"c{k} n{k} 0 1u",
                  f"rl{k} n{k} 0 10k"]
    netlist = "\n".join(lines + [".model di d", f".tran 1u {STOP} uic", ".save v(n1)", ""])
    result = run(program, netlist, method=None)
    if checker.check(result.status == 0, f"ladder: exit {result.status}: {result.stderr}"):
        events = [event for event in result.report["events"] if event["state"] == "on"]
        times = len({event["time"] for event in events})
        print(f"ladder: {len(events)} of 300 diodes close, at {times} times")
        checker.check(len(events) > 200 and times <= 40, f"ladder: {len(events)} at {times} times")


def main():
    checker, program = Checker("fronts"), sys.argv[1]
    check(checker, program, "chain", network("chain", "pwl(0 0 100u 0 101u 8 1m 8)", 90, False), 8.0)
    check(checker, program, "sine", network("sine", "sin(0 10 1k)", 60, False), 10.0)
    check(checker, program, "tree", network("tree", "pulse(0 10 20u 1u 1u 200u 500u)", 90, True), 10.0)
    check_events(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
