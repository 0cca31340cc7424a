#!/usr/bin/env python3
"""Which switch interrupts which coil, and circuits in which nothing jumps but rounding.

usage: interruptions.py PROGRAM auto|euler
"""

import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

MODELS = """.model SW SW(Vt=0.5)
.model SR SW(Vt=0.5 Roff=1meg)
.model DI D
.model DL D(Roff=10k)
.end
"""
OPENS = "Vg g 0 PULSE(1 0 1m 0 0 1m 5m)\n.tran 10u 2m uic\n"

# (netlist, {switch: coil}); coils that jump as far as each other are named with |.
INTERRUPTIONS = {
    "in series": ("V1 a 0 10\nS1 a b g 0 SW\nL1 b c 1m\nR1 c 0 10\n", {"s1": "l1"}),
    "of some femtojoules of a kiloohm": ("V1 a 0 1n\nS1 a b g 0 SW\nL1 b c 1n\nR1 c 0 1k\n", {"s1": "l1"}),
    "a diode lets it go on": ("V1 a 0 10\nS1 a b g 0 SW\nD1 0 b DI\nL1 b c 1m\nR1 c 0 10\n", {}),
    "a capacitor does": ("V1 a 0 10\nS1 a b g 0 SW\nC1 b 0 1n\nL1 b c 1m\nR1 c 0 10\n", {}),
    "so does Roff": ("V1 a 0 10\nS1 a b g 0 SR\nL1 b c 1m\nR1 c 0 10\n", {}),
    "two in series": ("V1 a 0 10\nS1 a b g 0 SW\nL1 b c 1m\nS2 c d g 0 SW\nR1 d 0 10\n",
                      {"s1": "l1", "s2": "l1"}),
    "two coils at once, each by its own switch":
        ("V1 a 0 10\nS1 a b g 0 SW\nL1 b c 1m\nR1 c 0 10\nS2 a e g 0 SW\nL2 e f 10m\nR2 f 0 10\n",
         {"s1": "l1", "s2": "l2"}),
    "beside capacitors that jump, whose switches are none":
        ("V1 a 0 10\nS1 a b g 0 SW\nL1 b c 1m\nR1 c 0 10\nS3 a h g 0 SW\nC3 h 0 1u\nS4 h k g4 0 SW\n"
         "C4 k 0 1u\nVg4 g4 0 PULSE(0 1 1m 0 0 1m 5m)\n", {"s1": "l1"}),
    "two coils meet": ("V1 a 0 10\nS1 m 0 g 0 SW\nR1 a d 10\nL1 d m 1m\nL2 m c 3m\nR2 c 0 5\n",
                       {"s1": "l1|l2"}),
    "a controlled source commands": ("V1 a 0 10\nS1 a b u 0 SW\nL1 b c 1m\nR1 c 0 10\nE1 u 0 g 0 2\n",
                                     {"s1": "l1"}),
    "backwards, with a controlled source": ("V1 a 0 -10\nS1 a b g 0 SW\nL1 b c 1m\nR1 c 0 10\n"
                                            "E9 z 0 b 0 -5\nR9 z 0 1k\n", {"s1": "l1"}),
    "below its holding current, behind a diode":
        ("V1 a 0 100\nD1 a m DI\nVs m n 0\nS1 n k u 0 SW\nB1 u 0 V=v(h)+min(1,10*i(Vs))\n"
         "Vh h 0 PULSE(0 1 0.1m 0 0 40u)\nR1 k q 100\nL1 q 0 100m\n", {"s1": "l1"}),
    "through coupled coils": ("V1 a 0 10\nS1 a b g 0 SW\nL1 b 0 1m\nL2 s 0 1m\nK1 L1 L2 0.9\nR2 s 0 10\n",
                              {"s1": "l1"}),
    "an ideal transformer lets it go on": ("V1 a 0 10\nS1 a b g 0 SW\nL1 b 0 1m\nL2 0 s 1m\nK1 L1 L2 1\n"
                                           "R2 s 0 10\n", {}),
    "it does not where its second side is cut as well, by the last to open":
        ("V1 a 0 10\nS1 a p g1 0 SW\nL1 p 0 1m\nL2 0 s 4m\nK1 L1 L2 1\nR1 s q 1\nS4 q 0 g4 0 SW\n"
         "S2 s 0 g2 0 SW\nVg1 g1 0 PULSE(0 1 0 0 0 0.5m)\nVg4 g4 0 PULSE(0 1 0 0 0 0.7m)\n"
         "Vg2 g2 0 PULSE(0 1 0.6m 0 0 0.3m)\n", {"s2": "l2"}),
    "an operating point without current": ("V1 a 0 12\nR1 a m 1k\nR2 m 0 1k\nR3 a n 1k\nR4 n 0 1k\n"
                                           "L1 m k 1m\nS1 k n g 0 SW\n", {}),
}

# A converter whose coil is at 0 A for the rest of each period, sampled then: switches that are nowhere near it.
SAMPLED = """V1 in 0 12
Vg g 0 PULSE(0 1 0 0 0 4u 10u)
S1 in sw g 0 SW
D1 0 sw DI
L1 sw out 22u
C1 out 0 1u
R1 out 0 200
{sampler}
Ch h 0 1p
Vg3 g3 0 PULSE(0 1 9u 0 0 1p 10u)
.tran 1u 1m uic
"""

# A parallel tank at rest whose diode carries what the source gives: v(n1) = 0 = i(l3) for good.
NOTHING = {
    "pulses": "I1 n1 0 PULSE(0 0.26 0 0 11u 33u 110u)\nC2 n1 0 2.4u\nL3 n1 0 0.13m\nD4 0 n1 DL\n.tran 10u 1m uic\n",
    "a sine": "I1 n1 0 SIN(0.26 0.26 10k)\nC2 n1 0 2.4u\nL3 n1 0 0.13m\nD4 0 n1 DL\n.tran 10u 1m uic\n",
    "kiloamperes": "I1 n1 0 PULSE(0 2600 0 0 11u 33u 110u)\nC2 n1 0 2.4m\nL3 n1 0 0.13u\nD4 0 n1 DL\n.tran 10u 1m uic\n",
    "microamperes": "I1 n1 0 PULSE(0 0.26u 0 0 11u 33u 110u)\nC2 n1 0 2.4p\nL3 n1 0 130\nD4 0 n1 DL\n.tran 10u 1m uic\n",
    "a resistor in series": "I1 n1 0 PULSE(0 0.26 0 1u 11u 33u 110u)\nC2 n1 0 2.4u\nL3 n1 n2 0.13m\nR3 n2 0 1\n"
                            "D4 0 n1 DI\n.tran 10u 1m uic\n",
    "two diodes": "I1 n1 0 PULSE(0 0.26 0 0 11u 33u 110u)\nC2 n1 0 2.4u\nL3 n1 0 0.13m\nD4 0 n1 DL\nD5 n1 0 DL\n"
                  ".tran 10u 1m uic\n",
    "no coil": "I1 n1 0 PULSE(0 0.26 0 0 11u 33u 110u)\nC2 n1 0 2.4u\nD4 0 n1 DI\n.tran 10u 1m uic\n",
    "hundreds of volts elsewhere": "I1 n1 0 PULSE(0 0.26 0 0 11u 33u 110u)\nC2 n1 0 2.4u\nL3 n1 0 0.13m\nD4 0 n1 DL\n"
                                   "V9 q 0 325\nR9 q 0 1k\n.tran 10u 1m uic\n",
    "a source of voltage": "V1 n1 0 PULSE(0 12 0 0 11u 33u 110u)\nD4 n2 n1 DI\nL3 n2 0 0.13m\nC2 n2 0 2.4u\n"
                           ".tran 10u 1m uic\n",
}


def check_interruptions(checker, program, method):
    for name, (netlist, wanted) in INTERRUPTIONS.items():
        result = run(program, f"{name}\n{netlist}{OPENS}{MODELS}", method=method)
        if not checker.check(result.status == 0, f"{name}: exit {result.status}: {result.stderr}"):
            continue
        found = dict(re.findall(r"'(\w+)' interrupts the current of '(\w+)'", result.stderr))
        fits = set(found) == set(wanted) and all(found[s] in wanted[s].split("|") for s in wanted)
        checker.check(fits, f"{name}: {found}, not {wanted}")
        losses = [float(loss) for loss in re.findall(r"([0-9.e+-]+) J are lost", result.stderr)]
        jumps = result.report["jumps"]
        checker.check(all(any(abs(loss - j["energy_lost"]) <= 1e-5 * loss for j in jumps)
                          for loss in losses) or "C4" in netlist, f"{name}: {losses} J, {jumps}")


def check_sampled(checker, program, method, sampler):
    netlist = SAMPLED.format(sampler=sampler)
    result = run(program, f"sampled\n{netlist}{MODELS}", method=method)
    checker.check(result.status == 0, f"sampled: exit {result.status}: {result.stderr}")
    checker.check("interrupts" not in result.stderr, f"sampled: {result.stderr}")
    for jump in result.report["jumps"]:
        flux = [name for name, impulse in jump["impulses"].items() if "flux" in impulse]
        checker.check(set(jump["states"]) <= {"ch", "c1"} and not flux, f"sampled: {jump}")


def check_nothing(checker, program, method):
    for name, netlist in NOTHING.items():
        result = run(program, f"{name}\n{netlist}{MODELS}", method=method, options=["--energy"])
        what = f"nothing, {name}"
        if checker.check(result.status == 0, f"{what}: exit {result.status}: {result.stderr}"):
            checker.check(result.report["jumps"] == [], f"{what}: {result.report['jumps'][:2]}")
            top = max(abs(v) for v in result.column("v(n2)" if "V1" in netlist else "v(n1)"))
            checker.check(top < 1e-12, f"{what}: {top} V")


def main():
    program, method = sys.argv[1:]
    checker = Checker(f"interruptions {method}")
    check_interruptions(checker, program, method)
    check_sampled(checker, program, method, "S3 out h g3 0 SW")
    if method != "euler":
        check_sampled(checker, program, method, "Eh e 0 out 0 1\nS3 e h g3 0 SW")
    check_nothing(checker, program, method)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
