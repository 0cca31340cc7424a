#!/usr/bin/env python3
"""A large circuit keeps loose tolerances, too, where it is solved on factors, with 7 stages, or with 5.

usage: large_loose.py PROGRAM

A Cockcroft-Walton multiplier of 100 stages with the default method at 1e-3 and 1e-4, against 5 stages
at 1e-7: each signal within the tolerance of its scale, at times that are no edges of anything. With a
pulse in it, which moves nothing here, it is stepped with 5 stages at all tolerances.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

STAGES, STOP, ROWS = 100, 4e-4, 100


def multiplier():
    lines, a, b = ["Cockcroft-Walton multiplier", "V1 ac 0 SIN(0 100 50k)"], "ac", "0"
    for k in range(1, STAGES + 1):
        lines += [f"Ca{k} {a} a{k} 1u", f"Da{k} {b} a{k}", f"Cb{k} {b} b{k} 1u", f"Db{k} a{k} b{k}"]
        a, b = f"a{k}", f"b{k}"
    lines.append(f"Rl {b} 0 10Meg")
    return "\n".join(lines + [f".tran 100n {STOP} uic", ".save v(a1) v(b1) v(b2) v(b5) v(b10)", ""])


def main():
    program = sys.argv[1]
    checker, netlist = Checker("large_loose"), multiplier()
    at = [(k + 0.382) / ROWS * STOP for k in range(ROWS)]
    exact = run(program, netlist, at=at, method="radau", stages=5, tolerance=1e-7)
    checker.check(exact.status == 0, f"exit {exact.status}: {exact.stderr}")
    pulsed = netlist.replace(".tran", "Vp ac p PULSE(0 1 1 1u 1u 1m 2m)\nRp p 0 1g\n.tran")
    for text, tolerance, stages in ((netlist, 1e-3, 7), (pulsed, 1e-3, 5), (pulsed, 1e-4, 5), (pulsed, 1e-5, 5)):
        result = run(program, text, at=at, method=None, tolerance=tolerance)
        if not checker.check(result.status == 0, f"exit {result.status}: {result.stderr}"):
            continue
        method = result.report["method"]["component 1"]
        checker.check(method == f"radau, {stages} stages", f"tolerance {tolerance:g}: {method}")
        for signal in result.names[1:]:
            scale = max(map(abs, exact.column(signal)))
            error = max(abs(a - b) for a, b in zip(result.column(signal), exact.column(signal)))
            print(f"{tolerance:g}: {signal} is off by {error / scale:.1e}")
            checker.check(error <= tolerance * scale,
                          f"{signal} is off by {error / scale:.1e}, tolerance {tolerance:g}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
