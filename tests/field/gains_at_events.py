#!/usr/bin/env python3
"""Amplifiers of large gain that leave and meet their rails, beside diodes that open and close.

usage: gains_at_events.py PROGRAM

Up to an event an output is where a loop holds it; the polynomial of the step that finds the event goes on beyond it, where
the output runs away at its gain. What a state may be off by is decided by what it is held to up to the event: an output
that is a million times a state shows a millionth of a tolerance. The whole waveform is audited, and the output of an
amplifier is compared with a run at a smaller tolerance. It may be off by 1e-6 of its range, and by what it moves in
1e-13 of the run, which is as well as an event is known.
"""

import bisect
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

# v: rails, f: of the source, g: gain, z: of the resistors
LOOPS = {
    "shunt clamp": "r1 in x {z}\nb1 u 0 V={{limit({g}*(v(ref)-v(x)),-{v},{v})}}\nd1 x u di\nr2 x 0 {z10}\nc1 x 0 {c}\n",
    "shunt clamp of two": "r1 in x {z}\nb1 u 0 V={{limit({g}*(v(ref)-v(x)),-{v},{v})}}\nd1 x u di\n"
                          "b2 w 0 V={{limit({g}*(-v(ref)-v(x)),-{v},{v})}}\nd2 w x di\nr2 x 0 {z10}\nc1 x 0 {c}\n",
    "peak detector": "b1 u 0 V={{limit({g}*(v(in)-v(x)),-{v},{v})}}\nd1 u y di\nr1 y x {z}\nc1 x 0 {c}\nr2 x 0 {z10}\n",
    "rectifier with a coil": "l1 in y {l}\nr1 y x {z}\nb1 u 0 V={{limit({g}*(v(ref)-v(x)),-{v},{v})}}\nd1 x u di\n"
                             "r2 x 0 {z10}\nc1 x 0 {c}\n",
    "integrator": "r1 in x {z}\nb1 u 0 V={{limit(-{g}*v(x),-{v},{v})}}\nc1 x u {c}\nr2 x u {z10}\nd1 u r di\nr3 r ref {z}\n",
}
SIZES = ((15.0, 300.0, 1e6, 1.5), (15.0, 5e4, 1e6, 1e3), (0.3, 1e3, 1e5, 1e4), (600.0, 50.0, 1e5, 10.0),
         (5.0, 2e6, 1e4, 50.0), (12.0, 60.0, 3e6, 300.0), (2e3, 400.0, 1e3, 1e5))


def netlist(loop, size):
    volts, hertz, gain, ohms = size
    body = LOOPS[loop].format(v=volts, g=gain, z=ohms, z10=10.0 * ohms, c=0.1 / (2 * math.pi * hertz * ohms),
                              l=0.02 * ohms / (2 * math.pi * hertz))
    return (f"{loop}\nv1 in 0 sin(0 {0.8 * volts!r} {hertz!r})\nv2 ref 0 {0.33 * volts!r}\n{body}"
            f".model di d(vfwd=0.7 ron={ohms / 150!r})\n.tran {0.01 / hertz!r} {3.2 / hertz!r} uic\n.end\n")


def rest(gains, volts, hertz, gain, ohms):
    """A loop with a limit on both sides rests up to a late step: what its two rails leave of nothing is no signal."""
    period = 1.0 / hertz
    text = (f"at rest\nvr r 0 pulse(0 {0.2 * volts!r} {period!r} 0 0 {5 * period!r} {10 * period!r})\n"
            f"e1 u 0 value={{limit({gain!r}*v(0,n),{-volts!r},{volts!r})}}\nr1 e n {ohms!r}\nc1 e n {0.3 * period / ohms!r}\n"
            f"r2 n x {2 * ohms!r}\nc2 x u {3 * period / ohms!r}\nb1 e 0 v=v(y)-2*v(r)\nr3 u y {0.1 * ohms!r}\n"
            f"c3 y 0 {3 * period / ohms!r}\nr4 y 0 {ohms!r}\n.tran {0.01 * period!r} {1.5 * period!r} uic\n.end\n")
    done = run(sys.argv[1], text, method=None, options=("--audit", "full", "--fill", "none"))
    title = f"at rest, {(volts, hertz, gain, ohms)}"
    if gains.check(done.status == 0, f"{title}: {done.stderr}"):
        n_steps = done.report["work"]["steps"]
        gains.check(n_steps <= 500, f"{title}: {n_steps} steps")


def main():
    gains = Checker("gains_at_events")
    for loop, size in some_of([(one, size) for one in LOOPS for size in SIZES]):
        text, title = netlist(loop, size), f"{loop}, {size}"
        done = run(sys.argv[1], text, method=None, options=("--audit", "full"))
        if not gains.check(done.status == 0, f"{title}: {done.stderr}"):
            continue
        events = [event["time"] for event in done.report["events"]]
        stop = 3.2 / size[1]
        times = sorted({time + share * stop for time in events[:40] for share in (1e-9, 1e-6, 1e-4)
                       if time + share * stop < stop})
        ours, exact = (run(sys.argv[1], text, method=None, at=times, tolerance=tolerance, options=("--audit", "off"))
                       for tolerance in (1e-6, 1e-12))
        if not gains.check(ours.status == exact.status == 0, f"{title}: {ours.stderr} {exact.stderr}"):
            continue
        others = sorted(event["time"] for event in exact.report["events"])
        column, right = ours.column("v(u)"), exact.column("v(u)")
        worst = 0.0
        for k, time in enumerate(times):
            near = min((abs(time - others[j]) for j in (bisect.bisect(others, time) - 1, bisect.bisect(others, time))
                        if 0 <= j < len(others)), default=stop)
            if near > 1e-10 * stop:
                worst = max(worst, abs(column[k] - right[k]) / (2.0 * size[0]))
        gains.check(worst <= 1e-6 + 1e-13 * size[2] * 2 * math.pi * 3.2, f"{title}: the output is off by {worst:.1e} of its range")
        gains.check(done.report["work"]["euler_steps"] == 0, f"{title}: steps of implicit Euler")
    for size in some_of(SIZES):
        rest(gains, *size)
    return gains.finish()


if __name__ == "__main__":
    sys.exit(main())
