#!/usr/bin/env python3
"""Impulses that pass ideal transformers, coils without leakage and sources: charges and energies in closed form.

usage: impulses_through_transformers.py PROGRAM

A charge from a capacitor C1 of V volts on a load that looks like n C1 from its side is V C1 n/(1 + n), and the switch takes
half of V times that charge.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

CLOSE = 1e-7
STEP = "V1 i 0 pulse(0 {volts!r} 1m 0 0 1 2)\n"
CLOSES = "C1 a 0 {farad!r} ic={volts!r}\nS1 a b g 0 s\n"
LOADS = {  # what stands behind b, times C1
    "a transformer": ("A1 b 0 c 0 tr\n.model tr transformer(turns=[1 2])\nC2 c 0 {farad!r}\n", 4),
    "a winding that floats": ("A1 b 0 c d tr\n.model tr transformer(turns=[2 1])\nC2 c d {farad!r}\nR2 d 0 1\n", 0.25),
    "three windings": ("A1 b 0 c 0 e 0 tr\n.model tr transformer(turns=[1 2 1])\nC2 c 0 {farad!r}\nC3 e 0 {farad!r}\n", 5),
    "coupled coils": ("L1 b 0 1e9\nL2 c 0 4e9\nK1 L1 L2 1\nC2 c 0 {farad!r}\n", 4),
    "coupled coils in reverse": ("L1 b 0 1e9\nL2 0 c 1e9\nK1 L1 L2 1\nC2 c 0 {farad!r}\n", 1),
    "coils coupled by -1": ("L1 b 0 1e9\nL2 c 0 1e9\nK1 L1 L2 -1\nC2 c 0 {farad!r}\n", 1),
    "coils that float": ("L1 b 0 1e9\nL2 c d 1e9\nK1 L1 L2 1\nC2 c d {farad!r}\nR2 d 0 1k\n", 1),
    "three coils": ("L1 b 0 1e9\nL2 c 0 1e9\nL3 e 0 4e9\nK1 L1 L2 1\nK2 L1 L3 1\nK3 L2 L3 1\nC2 c 0 {farad!r}\nC3 e 0 {farad!r}\n", 5),
    "coils of one winding": ("L1 b c 1e9\nL2 c 0 1e9\nK1 L1 L2 1\nC2 c 0 {farad!r}\n", 0.25),
    "coils beside a capacitor": ("C4 b 0 {farad!r}\nL1 b 0 1e9\nL2 c 0 1e9\nK1 L1 L2 1\nC2 c 0 {farad!r}\n", 2),
    "a source that follows": ("C2 b 0 {farad!r}\nE1 o 0 b 0 3\nC3 o 0 {farad!r}\n", 1),
}
OTHERS = {  # joules in units of C V^2, of jumps
    "a step on a transformer": (STEP + "A1 i 0 o 0 tr\n.model tr transformer(turns=[1 2])\nC3 o 0 {farad!r}\n",
                                {"v1": -4, "a1": 4, "winding2(a1)": -4}),
    "a step behind a capacitor": (STEP + "C1 i b {farad!r}\nA1 b 0 o 0 tr\n.model tr transformer(turns=[1 1])\nC3 o 0 {farad!r}\n",
                                  {"v1": -0.5, "a1": 0.125, "winding2(a1)": -0.125}),
    "a step that a source follows": (STEP + "E1 o 0 i 0 1\nC3 o 0 {farad!r}\n", {"v1": 0, "e1": -1}),
}


def run(program, checker, title, text):
    done = dalcs_program.run(program, f"{title}\n{text}Vg g 0 pulse(0 1 1m 0 0 2m 4m)\nVq q 0 pulse(1 0 1m 0 0 2m 4m)\n"
                             ".model s sw(vt=0.5 ron=0)\n.tran 10u 2m uic\n.losses\n", method="auto", quiet=True)
    if not checker.check(done.status == 0, f"{title}: {done.stderr}"):
        return {}, {}
    losses = done.report["losses"][0]
    return losses, {e["element"]: e for e in losses["elements"]}


def near(checker, title, found, wanted, size):
    if checker.check(found is not None, f"{title}: none"):
        checker.close(found, wanted, CLOSE * size, title)


def jumps(checker, title, losses, of, wanted, unit):
    for element, joules in wanted.items():
        near(checker, f"{title}: jumps of {element}", of.get(element, {}).get("jumps", 0.0), joules * unit, unit)
    near(checker, f"{title}: balance", losses.get("balance"), 0.0, unit)


def main():
    program = sys.argv[1]
    checker = dalcs_program.Checker("impulses_through_transformers")
    for volts, farad in (10.0, 1e-6), (1e4, 1e-3), (-1e-3, 1e-6):
        unit = farad * volts * volts
        for what, (load, times) in LOADS.items():
            title = f"{volts:g} V of {farad:g} F on {what}"
            share = times / (1 + times)
            losses, of = run(program, checker, title, (CLOSES + load).format(volts=volts, farad=farad))
            near(checker, f"{title}: charge", of.get("c1", {}).get("i_average"), -share * farad * volts / 2e-3, farad * abs(volts) / 2e-3)
            jumps(checker, title, losses, of, {"s1": share / 2}, unit)
        for what, (text, wanted) in OTHERS.items():
            title = f"{volts:g} V, {farad:g} F: {what}"
            losses, of = run(program, checker, title, text.format(volts=volts, farad=farad))
            jumps(checker, title, losses, of, wanted, unit)
    for henry, ratio in (1e-3, 2), (1.0, 0.5):  # 1 A of a coil that a switch behind a transformer cuts
        title = f"{henry:g} H cut behind {ratio}:1"
        losses, of = run(program, checker, title, f"V1 i 0 10\nR1 i b 10\nL1 b c {henry} ic=1\nA1 c 0 e 0 tr\n"
                         f".model tr transformer(turns=[{ratio} 1])\nS1 e 0 q 0 s\n")
        jumps(checker, title, losses, of, {"s1": 0.5, "a1": 0.5, "winding2(a1)": -0.5}, henry)
    for volts, henry in (10, 1e-3), (1e4, 1.0), (1e-3, 1e-6):  # a gate against what the cut coil drives reads no impulse
        for model in "thyristor", "thyristor(ih=1n)", "thyristor(il=2n)", "gto":
            title = f"{henry:g} H of {volts:g} V cut beside a {model}"
            _, of = run(program, checker, title, f"V1 i 0 {volts}\nR1 p b {volts}\nL1 b 0 {henry} ic=1\nS1 i p q 0 s\nA1 i p h p th\n"
                        f"Vh h p 0\n.model th {model}\n")
            near(checker, f"{title}: mean voltage", of.get("l1", {}).get("v_average"), -henry / 2e-3, henry / 2e-3)
    formulas = {"limit(v(b),-1,1)": lambda f: 0, "max(v(b),-1)": lambda f: max(f, 0), "abs(v(b))": abs, "abs(v(b)-3)+1": abs,
                "v(b)+2*max(v(b),5)": lambda f: f + 2 * max(f, 0),
                "max(0,2*v(b)-abs(v(b)-1))": lambda f: max(0, 2 * f - abs(f)), "table(v(b),-1,2,0,0,1,3)": lambda f: 0}
    at_0 = {"abs(v(b)-3)+1": 4, "v(b)+2*max(v(b),5)": 10}
    for formula, area in formulas.items():  # of what a cut coil drives: far from its bends
        for ampere in 1, -1:
            title = f"{formula} of {ampere} A that is cut"
            _, of = run(program, checker, title, f"V1 i 0 {ampere}\nR1 p b 1\nL1 b 0 1m ic={ampere}\nS1 i p q 0 s\nB1 o 0 V={formula}\nR2 o 0 1\n")
            near(checker, f"{title}: mean", of.get("r2", {}).get("v_average"), area(-0.001 * ampere) / 2e-3 + at_0.get(formula, 0), 1)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
