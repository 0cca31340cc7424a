#!/usr/bin/env python3
"""Controlled sources that are resistors, in place of resistors.

usage: own_resistances.py PROGRAM

A current source of g siemens by its own voltage is a resistor, and so is a voltage source of r ohms by the current
through itself. Circuits with one resistor are run with that in all its forms: what happens, when, and every waveform
must be the same, and where a closed form is known, right. A jump is the test of it: among passive elements alone its
answer is that of two problems without time, and without them some are refused. Of negative ones nothing is said.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SAME = 1e-9  # of the largest voltage or current


def forms(a, b, ohms):
    """The cards of a resistor from a to b in each form; numbers have all their digits."""
    g = 1 / ohms
    return {
        "R": [f"rx {a} {b} {ohms!r}"],
        "G": [f"gx {a} {b} {a} {b} {g!r}"],
        "G, its terminals reversed": [f"gx {b} {a} {b} {a} {g!r}"],
        "G, its controls reversed": [f"gx {a} {b} {b} {a} {-g!r}"],
        "G behind a short": [f"rs {a} qx 0", f"gx qx {b} {a} {b} {g!r}"],
        "two G in parallel": [f"gx {a} {b} {a} {b} {g / 4!r}", f"gy {b} {a} {b} {a} {0.75 * g!r}"],
        "two G in series": [f"gx {a} qx {a} qx {3 * g!r}", f"gy qx {b} qx {b} {1.5 * g!r}"],
        "G POLY": [f"gx {a} {b} poly(1) {a} {b} 0 {g!r}"],
        "G VALUE": [f"gx {a} {b} value={{v({a},{b})/{ohms!r}}}"],
        "B I": [f"bx {a} {b} i=v({a},{b})*{g!r}"],
        "B I of the reversed voltage": [f"bx {a} {b} i=-v({b},{a})/{ohms!r}"],
        "B V of its own current": [f"bx {a} {b} v=i(bx)*{ohms!r}"],
        "H of its own current": [f"hx {a} {b} hx {ohms!r}"],
        "H behind its V": [f"vx {a} qx 0", f"hx qx {b} vx {ohms!r}"],
        "H before its V, which is reversed": [f"hx {a} qx vx {-ohms!r}", f"vx {b} qx 0"],
        "H and its V with a resistor between": [f"vx {a} qx 0", f"rq qx qy {ohms / 2!r}", f"hx {b} qy vx {-ohms / 2!r}"],
        "H in two parts": [f"vx {a} qx 0", f"hx qx qy vx {ohms / 4!r}", f"hy qy {b} vx {0.75 * ohms!r}"],
    }


IDEAL = ".model dd d\n.model sw sw(ron=0 vt=0.5)"

# what is about it, the nodes of the resistor and its ohms, the signals, values that are known at the end
CIRCUITS = {
    # the first that was seen: the open switch takes l5's current, and r15 c11 are at rest
    "a coil that is cut off": (
        ["s4 n2 0 g0 0 sw", "v0 g0 0 0", "l5 n3 n1 0.1 ic=-10m", "c11 n5 n2 5n ic=0", "r15 n3 n5 20", IDEAL,
         ".tran 0.1u 1m uic"], ("n1", "0", 1 / 4.6e-3), ["i(l5)", "v(n1)"], {"i(l5)": 0.0}),
    "charge shared by a diode": (
        ["c1 a 0 1u ic=10", "d1 a b dd", "c2 b 0 3u ic=0", IDEAL, ".tran 10u 4m uic"],
        ("b", "0", 1e3), ["v(a)", "v(b)"], {"v(b)": 2.5 * math.exp(-1.0)}),
    "charge shared by a switch": (
        ["v1 g 0 pulse(0 1 1m 0 0 5m 10m)", "c1 a 0 1u ic=6", "s1 a b g 0 sw", "c2 b c 1u ic=0", "r9 c 0 0", IDEAL,
         ".tran 10u 5m uic"], ("b", "0", 2e3), ["v(b)"], {"v(b)": 3.0 * math.exp(-1.0)}),
    "a coil freewheels": (
        ["v1 a 0 12", "vg g 0 pulse(1 0 1m 0 0 5m 10m)", "s1 a b g 0 sw", "l1 b c 10m ic=1", "d1 0 b dd", IDEAL,
         ".tran 10u 2m uic"], ("c", "0", 10.0), ["i(l1)"], {"i(l1)": (1.2 - 0.2 * math.exp(-1.0)) * math.exp(-1.0)}),
    "a coil cut off beside a load": (
        ["v1 a 0 5", "vg g 0 pulse(1 0 1m 0 0 5m 10m)", "s1 a b g 0 sw", "r9 b e 5", "l1 e 0 1m", IDEAL,
         ".tran 1u 1.1m"], ("e", "0", 50.0), ["v(e)"], {}),
    "two coils in series meet": (
        ["l1 0 a 1m ic=1", "l2 b 0 3m ic=0", "r1 a 0 1meg", "vg g 0 pulse(0 1 1u 0 0 1 2)", "s1 a b g 0 sw", "r2 b 0 1",
         IDEAL, ".tran 10n 2u uic"], ("a", "b", 1e4), ["i(l1)", "i(l2)"], {}),
    "a clamp": (
        ["v1 a 0 sin(0 10 1k)", "r1 a b 100", "d1 b c dd", "vz c 0 3", "c1 b 0 10n", IDEAL, ".tran 1u 1m"],
        ("b", "0", 1e3), ["v(b)", "i(d1)"], {}),
    "a current source into a diode": (
        ["i1 0 a pulse(0 1 10u 0 0 20u 50u)", "d1 a b dd", "c1 b 0 1u", "l1 a 0 1m", IDEAL, ".tran 1u 100u"],
        ("a", "0", 33.0), ["v(b)", "i(l1)"], {}),
    "microohms": (
        ["v1 a 0 5", "vg g 0 pulse(0 1 1u 0 0 1 2)", "s1 a b g 0 sw", "c1 c 0 1m ic=0", "d1 c 0 dd", "r3 c 0 1",
         IDEAL, ".tran 10n 5u uic"], ("b", "c", 1e-3), ["i(v1)", "v(c)"], {}),
    "between two floating capacitors": (
        ["c1 a b 2u ic=4", "c2 c d 2u ic=0", "r1 b d 1k", "rg b 0 1meg", ".tran 10u 3m uic"],
        ("a", "c", 500.0), ["v(a,b)", "v(c,d)"], {"v(a,b)": 2.0 + 2.0 * math.exp(-2.0)}),
    "a perfect transformer": (
        ["v1 a 0 pulse(0 10 1u 0 0 1 2)", "l1 a 0 1m", "l2 b 0 4m", "k1 l1 l2 1", "d1 b c dd", "c1 c 0 1n", IDEAL,
         ".tran 10n 4u"], ("c", "0", 1e3), ["v(c)", "i(v1)"], {}),
}


def netlist(name, cards, own, signals):
    return "\n".join([name, *own, *cards[:-1], ".save " + " ".join(signals), cards[-1], ".end", ""])


def compare(checker, name, cards, place, signals, known):
    plain = None
    for form, own in forms(*place).items():
        text = netlist(name, cards, own, signals)
        outcome = run(sys.argv[1], text, method=None, options=["--fill", "none", "--energy"])
        what = f"{name}, {form}"
        if not checker.check(outcome.status == 0, f"{what}: {outcome.stderr[:300]}"):
            continue
        plain = plain or outcome
        for signal, value in known.items():
            checker.close(outcome.column(signal)[-1], value, 1e-8 * max(abs(value), 1e-3), f"{what}: {signal}")
        for signal in signals:
            scale = max(max(map(abs, plain.column(signal))), 1e-12)
            found, wanted = outcome.column(signal), plain.column(signal)
            if checker.check(len(found) == len(wanted), f"{what}: {len(found)} rows, not {len(wanted)}"):
                worst = max(abs(a - b) for a, b in zip(found, wanted))
                checker.check(worst <= SAME * scale, f"{what}: {signal} is off by {worst / scale:.2e} of itself")
        for key in ("events", "jumps"):
            a, b = (len(o.report.get(key, [])) for o in (outcome, plain))
            checker.check(a == b, f"{what}: {a} {key}, not {b}")


def negative(checker):
    """They stay sources: the same waveforms as of the formula, which an exponential that grows shows."""
    for form, own in {"G": "gx a 0 0 a 1m", "B I": "bx a 0 i=-v(a)/1k", "H": "hx a 0 hx -1k"}.items():
        outcome = run(sys.argv[1], netlist("grows", ["c1 a 0 1u ic=1", ".tran 10u 1m uic"], [own], ["v(a)"]), method=None)
        if checker.check(outcome.status == 0, f"negative {form}: {outcome.stderr[:300]}"):
            checker.close(outcome.column("v(a)")[-1], math.e, 1e-8, f"negative {form}")


def main():
    checker = Checker("own_resistances")
    for name, (cards, place, signals, known) in some_of(CIRCUITS.items()):
        compare(checker, name, cards, place, signals, known)
    negative(checker)
    return checker.finish()


sys.exit(main())
