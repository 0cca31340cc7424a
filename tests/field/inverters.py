#!/usr/bin/env python3
"""Inverters of 1 to 6 legs, sine against triangle by formulas, into a star without a neutral.

usage: inverters.py PROGRAM

Without dead time each leg is a source of plus or minus 300 V: the currents are those of the same star on formulas that
say so, with on-resistances but for what these take. With dead time, and coils that megohms discharge within a
nanosecond, a run has to come to its end. Where E sources that only read make the gates' signals the circuit is passive
part by part, and no problem of one step is asked in every one of its 2^12 modes.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

OHMS = ("ron=1m roff=1meg", "ron=1m roff=1meg")
IDEAL = ("", "ron=0")


def gates(k, n, dead):
    return [f"vr{k} r{k} 0 sin(0 0.8 50 0 0 {-360 * k / n})", f"b{k} g{k} 0 v=u(v(r{k})-v(t)-{dead})",
            f"bn{k} k{k} 0 v=u(v(t)-v(r{k})-{dead})"]


def leg(k):
    return [f"s{k}a p h{k} g{k} 0 s", f"s{k}b h{k} n k{k} 0 s", f"d{k}a h{k} p d", f"d{k}b n h{k} d"]


def load(k, n):
    return [f"l{k} h{k} x{k} 1m ic=0", f"r{k} x{k} {'y' if n > 1 else '0'} {5 + k}"]


def netlist(n, resistances, dead, stop, replaced=False):
    cards = ["vt t 0 pulse(-1 1 0 250u 250u 1p 500.000001u)"]
    cards += [] if replaced else ["vp p 0 300", "vn 0 n 300"]
    for k in range(n):
        cards += gates(k, n, dead) + load(k, n)
        cards += [f"bh{k} h{k} 0 v=600*v(g{k})-300"] if replaced else leg(k)
    return "\n".join(["inverter", *cards, f".model s sw(vt=0.5 {resistances[0]})", f".model d d({resistances[1]})",
                      f".tran {stop / 400!r} {stop!r} uic", ".end", ""])


def with_rectifier():
    """Ideal parts, with a filter of coils and capacitors, which feeds a bridge of six diodes."""
    cards = ["vt t 0 pulse(-1 1 0 50u 50u 0 100u)", "vd p n 600", "rg n 0 1meg", "co o m 100u", "ro o m 50"]
    for k in range(3):
        cards += [f"vr{k} r{k} 0 sin(0 0.8 50 0 0 {-120 * k})", f"e{k} g{k} 0 r{k} t 1", f"s{k}a p h{k} g{k} 0 s",
                  f"s{k}b h{k} n 0 g{k} s", f"d{k}a h{k} p d", f"d{k}b n h{k} d", f"l{k}a h{k} f{k} 1m",
                  f"c{k} f{k} s 10u", f"l{k}b f{k} q{k} 0.2m", f"d{k}c q{k} o d", f"d{k}d m q{k} d"]
    return "\n".join(["inverter and rectifier", *cards, ".model s sw(roff=1meg vt=0 vh=0)", ".model d d",
                      ".tran 20u 40m uic", ".end", ""])


def values(outcome, name, stop):
    """At 400 times; of two rows at one time the later one."""
    row = {}
    for k, t in enumerate(outcome.time):
        place = t / stop * 400
        if abs(place - round(place)) < 1e-9:
            row[round(place)] = k
    column = outcome.column(name)
    return [column[row[k]] for k in sorted(row)]


def main():
    checker = Checker("inverters")
    stop = 5e-3
    for n in (1, 2, 3, 6):
        reference = run(sys.argv[1], netlist(n, IDEAL, 0, stop, replaced=True), method=None)
        if not checker.check(reference.status == 0, f"{n} legs, replaced: {reference.stderr}"):
            continue
        for resistances, part in ((IDEAL, 1e-8), (OHMS, 1e-3)):
            what = f"{n} legs, {resistances[1]}"
            outcome = run(sys.argv[1], netlist(n, resistances, 0, stop), method=None)
            if not checker.check(outcome.status == 0, f"{what}: {outcome.stderr}"):
                continue
            for k in range(n):
                wanted, got = values(reference, f"i(l{k})", stop), values(outcome, f"i(l{k})", stop)
                off = max(abs(a - b) for a, b in zip(wanted, got))
                checker.check(off <= part * max(map(abs, wanted)), f"{what}: i(l{k}) is {off:.3g} A off")
    for n, resistances in ((2, IDEAL), (3, IDEAL), (3, OHMS), (5, IDEAL)):
        outcome = run(sys.argv[1], netlist(n, resistances, 0.02, stop), method=None)
        checker.check(outcome.status == 0, f"{n} legs, {resistances[1]}, dead time: {outcome.stderr}")
    # steps as short as the last digit of time have to give way to what goes on; a millionth of v(t) may be missed
    outcome = run(sys.argv[1], netlist(6, OHMS, 0.02, 8e-3), method=None)
    checker.check(outcome.status in (0, 1) and outcome.report is not None, f"6 legs, dead time: {outcome.stderr}")
    outcome = run(sys.argv[1], with_rectifier(), method=None)
    checker.check(outcome.status == 0, f"with a rectifier: {outcome.stderr}")
    checker.check(outcome.report["work"]["pivots"] < 2 ** 12, "with a rectifier: every mode of a problem was tried")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
