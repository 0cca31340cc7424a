#!/usr/bin/env python3
"""Jumps whose impulses a source reads: the state jumps as it does without the source, whatever that reads.

usage: read_impulses.py PROGRAM

In a vanishing step an impulse is a charge or a flux over the step: what H, F, E, G or B reads of it has no limit, and no
jump is small beside that. Each circuit runs as it is and with a source that reads; the jumps and the energy lost in them
have closed forms, and the ledger of energies must close.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

SW = ".model sw sw(ron=0 vt=0.5)"
DD = ".model dd d"

# the circuit, what reads it, the time of the jump, the signal, before and behind it, the joules lost
CASES = {
    "H at the start": (["v1 a 0 1", "c1 a b 47u", "v2 b 0 0", ".tran 50n 1u uic"],
                       ["h1 c 0 v2 -1", "r1 c 0 1"], 0.0, "v(a,b)", None, 1.0, 23.5e-6),
    "F at the start": (["v1 a 0 -3", "c1 a b 1n", "v2 b 0 0", ".tran 50n 1u uic"],
                       ["f1 c 0 v2 1k", "r1 c 0 1k"], 0.0, "v(a,b)", None, -3.0, 4.5e-9),
    "B at the start": (["v1 a 0 20", "c1 a b 2m", "v2 b 0 0", ".tran 50n 1u uic"],
                       ["b1 c 0 v=50*i(v2)", "r1 c 0 1"], 0.0, "v(a,b)", None, 20.0, 0.4),
    "H, a pulse": (["v1 a 0 pulse(1 3 1u 0 0 1 2)", "c1 a b 10p", "v2 b 0 0", ".tran 50n 2u"],
                   ["h1 c 0 v2 1meg", "r1 c 0 1"], 1e-6, "v(a,b)", 1.0, 3.0, 20e-12),
    "H, charge shared by a switch": (
        ["vg g 0 pulse(0 1 1u 0 0 1 2)", "c1 a 0 1u ic=4", "s1 a b g 0 sw", "v2 b d 0", "c2 d 0 3u ic=0", SW,
         ".tran 50n 2u uic"], ["h1 c 0 v2 7", "r1 c 0 1"], 1e-6, "v(d)", 0.0, 1.0, 6e-6),
    "H, charge shared by a diode": (
        ["v1 p 0 pulse(0 2 1u 0 0 1 2)", "c1 p b 1u ic=0", "d1 b e dd", "v2 e d 0", "c2 d 0 1u ic=0", DD,
         ".tran 50n 2u uic"], ["h1 c 0 v2 -100", "r1 c 0 1"], 1e-6, "v(d)", 0.0, 1.0, 1e-6),
    "E, a coil is cut off": (
        ["v1 a 0 5", "vg g 0 pulse(1 0 1m 0 0 1 2)", "r1 a b 5", "l1 b d 1m", "s1 d 0 g 0 sw", SW,
         ".tran 10u 1.1m"], ["e1 c 0 b d 1k", "r9 c 0 1"], 1e-3, "i(l1)", 1.0, 0.0, None),
    "G, a coil is cut off": (
        ["i1 0 a 2", "vg g 0 pulse(0 1 1u 0 0 1 2)", "l1 a 0 1u ic=2", "r1 a 0 1meg", "l2 a d 3u ic=0", "s1 d 0 g 0 sw",
         "l3 a 0 1m ic=0", ".tran 10n 2u uic", SW], ["g1 0 c a d 1", "r9 c 0 10"], 1e-6, "i(l2)", 0.0, 0.0, None),
    "E, two coils meet": (
        ["vg g 0 pulse(1 0 1u 0 0 1 2)", "l1 0 a 2m ic=3", "s1 a 0 g 0 sw on", "l2 a d 1m ic=0", "vz d 0 0", SW,
         ".tran 10n 2u uic"], ["e1 c 0 a d 1e4", "r9 c 0 1"], 1e-6, "i(l2)", 0.0, 2.0, 3e-3),
    "B, two coils meet": (
        ["vg g 0 pulse(1 0 1u 0 0 1 2)", "l1 0 a 2m ic=3m", "s1 a 0 g 0 sw on", "l2 a d 1m ic=0", "vz d 0 0", SW,
         ".tran 10n 2u uic"], ["b1 c 0 v={v(a)*1e3+v(d)}", "r9 c 0 1"], 1e-6, "i(l2)", 0.0, 2e-3, 3e-9),
    "nothing reads, but a small coil is cut off beside a large charge": (
        ["v1 a 0 pulse(0 100 1u 0 0 1 2)", "c1 a 0 1m", "r1 a 0 1", "vg g 0 pulse(1 0 1u 0 0 1 2)", "l1 b a 1m ic=1u",
         "s1 b 0 g 0 sw on", SW, ".tran 10n 2u uic"], [], 1e-6, "i(l1)", 1e-6, 0.0, None),
}


def netlist(name, cards, more, signal):
    nodes = f".save {signal}"
    return "\n".join([name, *more, *cards, nodes, ".end", ""])


def jump(checker, name, text, time, signal, before, behind, lost):
    outcome = run(sys.argv[1], text, method=None, options=["--energy"])
    if not checker.check(outcome.status == 0, f"{name}: {outcome.stderr[:300]}"):
        return
    rows = [k for k, t in enumerate(outcome.time) if abs(t - time) <= 1e-12 * max(time, 1e-6)]
    allowed = 1e-8 * max(abs(before or 0.0), abs(behind), 1e-6)
    if before is not None:
        checker.check(len(rows) == 2, f"{name}: {len(rows)} rows at {time}, not 2")
        checker.close(outcome.column(signal)[rows[0]], before, allowed, f"{name}: {signal} before")
    checker.close(outcome.column(signal)[rows[-1]], behind, allowed, f"{name}: {signal} behind")
    if lost is not None:
        checker.close(outcome.loss(outcome.time[rows[-1]]), lost, 1e-6 * lost, f"{name}: energy lost")
    energy = outcome.report["energy"]
    checker.check(energy is not None, f"{name}: no ledger")


def main():
    checker = Checker("read_impulses")
    for name, (cards, more, *rest) in CASES.items():
        for what, own in (("", more), (", nothing reads", [])):
            if own or not more or what:
                time, signal, *values = rest
                jump(checker, name + what, netlist(name, cards, own, signal), time, signal, *values)
    return checker.finish()


sys.exit(main())
