#!/usr/bin/env python3
"""Switches whose gate is at its threshold at t = 0 and leaves it there: a ramp from 0 V, a sine, and Vt = 0.

usage: gates_at_thresholds.py PROGRAM

At 0 the switch stands as in the operating point, just after it as its gate says: there are two rows at 0, as where a
source jumps. Closed forms; the audit looks at all of it. Every circuit is there in several sizes.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

EXP = math.exp
ALLOWED = 1e-7


class Gates(Checker):
    def goes(self, name, cards, stop, signal, before, after, end):
        """The two rows at 0 and the last one of a signal."""
        lines = [name, *cards, f".tran {stop / 50!r} {stop!r}", ".end", ""]
        outcome = run(sys.argv[1], "\n".join(lines), method=None, options=("--audit", "full"))
        if not self.check(outcome.status == 0, f"{name}: {outcome.stderr}"):
            return
        rows = [v for t, v in zip(outcome.column("time"), outcome.column(signal)) if t == 0]
        wanted = [before] if after is None else [before, after]
        size = max(abs(v) for v in (before, end, after or 0))
        self.check(len(rows) == len(wanted), f"{name}: {len(rows)} rows at 0")
        for found, value in zip([*rows, outcome.column(signal)[-1]], [*wanted, end]):
            self.check(abs(found - value) <= ALLOWED * size, f"{name}: {signal} is {found}, not {value}")


GATES = {
    "a ramp": "pulse(0 {0!r} 0 {1!r} {1!r} {2!r} {3!r})",
    "a ramp of points": "pwl(0 0 {1!r} {0!r} {2!r} {0!r})",
    "a sine": "sin(0 {0!r} {4!r})",
    "a rise of an exponential": "exp(0 {0!r} 0 {1!r} {3!r} {1!r})",
}


def gates(seconds, volts):
    """Gates that leave 0 V at 0 and come back after `seconds`."""
    for name, words in GATES.items():
        yield name, "vg g 0 " + words.format(volts, seconds / 20, 10 * seconds, 40 * seconds, 0.1 / seconds)


def circuits(v, ohms, seconds):
    """Name, cards without the gate, signal, its value before 0 and behind it, and after `seconds`."""
    henries, farads = ohms * seconds, seconds / ohms
    amperes = v / ohms
    closed = ".model sm sw(vt=0)"
    low = f".model sm sw(vt=0 ron={ohms / 4!r} roff={ohms * 4!r})"
    yield ("a coil that a switch shorts", [f"v1 in 0 {v!r}", f"l1 in n {henries!r}", f"r1 n 0 {ohms!r}",
                                           "s1 n 0 g 0 sm", closed], "v(n)", v, 0.0, 0.0)
    yield ("its current", [f"v1 in 0 {v!r}", f"l1 in n {henries!r}", f"r1 n 0 {ohms!r}", "s1 n 0 g 0 sm", closed],
           "i(l1)", amperes, amperes, 2 * amperes)
    yield ("a boost converter", [f"v1 in 0 {v!r}", f"l1 in n {henries!r}", "d1 n o di", f"c1 o 0 {farads!r}",
                                 f"r1 o 0 {ohms!r}", "s1 n 0 g 0 sm", closed, ".model di d"], "v(o)", v, v, v / EXP(1))
    yield ("a capacitor that a switch empties", [f"v1 in 0 {v!r}", f"r1 in n {ohms!r}", f"c1 n 0 {farads!r}",
                                                 "s1 n 0 g 0 sm", closed], "v(n)", v, 0.0, 0.0)
    both = ohms / 5 + ohms * 0.0
    tau = farads * both
    rest = v * 4 / 5
    yield ("a capacitor that a switch discharges", [f"v1 in 0 {v!r}", f"r1 in n {ohms!r}", f"c1 n 0 {farads!r}",
                                                    "s1 n 0 g 0 sm", low], "v(n)", rest, rest,
           v / 5 + (rest - v / 5) * EXP(-seconds / tau))
    yield ("a load that a switch connects", [f"v1 in 0 {v!r}", "s1 in n g 0 sm", f"r1 n 0 {ohms!r}",
                                             f"c1 n 0 {farads!r}", low], "i(s1)", amperes / 5, (v - v / 5) / (ohms / 4),
           (v - v * 4 / 5 - (v / 5 - v * 4 / 5) * EXP(-5 * seconds / (farads * ohms))) / (ohms / 4))
    yield ("one that opens: its gate is turned around",
           [f"i1 0 n {amperes!r}", f"r1 n 0 {ohms!r}", f"c1 n 0 {farads!r}", "s1 n 0 0 g sm on",
            f".model sm sw(vt={-v * 1e-3!r} ron=0)"], "v(n)", 0.0, None, None)


def main():
    checker = Gates("gates at their thresholds")
    sizes = [(5.0, 1e3, 1e-3), (400.0, 10.0, 20e-6), (1e-3, 1e6, 1.0)]
    for v, ohms, seconds in sizes:
        for what, gate in some_of(list(gates(seconds, 10.0))):
            for name, cards, signal, before, after, end in circuits(v, ohms, seconds):
                if end is not None:
                    checker.goes(f"{name}, {what}, {v:g} V", [gate, *cards], seconds, signal, before, after, end)
    # Through an E, and by a current.
    for v, ohms, seconds in sizes:
        gate = f"vp p 0 pulse(0 5 0 {seconds / 9!r} 0 {5 * seconds!r} {9 * seconds!r})"
        coil = [f"v1 in 0 {v!r}", f"l1 in n {ohms * seconds!r}", f"r1 n 0 {ohms!r}", ".model sm sw(vt=0)"]
        checker.goes("through an E", [gate, "e1 g 0 p 0 3", *coil, "s1 n 0 g 0 sm"], seconds, "v(n)", v, 0.0, 0.0)
        checker.goes("two in series", [gate, *coil, "s1 n m p 0 sm", "s2 m 0 p 0 sm"], seconds, "v(n)", v, 0.0, 0.0)
        checker.goes("with a threshold above", [gate, *coil[:3], "s1 n 0 p 0 sm", ".model sm sw(vt=6)"], seconds, "v(n)", v,
                     None, v)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
