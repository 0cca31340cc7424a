#!/usr/bin/env python3
""".ic of the terminals of capacitors that have parasitics: with uic the same as IC= on the card.

usage: initial_terminals.py PROGRAM

The node behind Rser and Lser has no name. Before a run nothing flows through them, so the capacitor has what .ic says of
the card's two nodes.
"""

import itertools
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

PARASITICS = ("Rser=20m", "Lser=1n", "Rser=0.5 Lser=1n RLshunt=1", "Rser=1 Rpar=10k", "Rpar=10k", "Lser=10n Rpar=1Meg")
VALUES = ("100n", "Q=100n*x", "Q=pwl(x, -1,-0.1u, 0,0, 1,0.2u)", "100n m=3")
# nodes of the capacitor, what .ic says, the volts across it, the rest of the circuit
PLACES = (("b 0", "v(b)=12", 12, ""), ("0 b", "v(b)=12", -12, ""), ("b d", "v(b)=5 v(d)=2", 3, "R4 d 0 100\n"),
          ("b d", "v(d,b)=4", -4, "R4 d 0 100\n"), ("c 0", "v(b)=7", 7, "R4 b c 0\n"))


def netlist(parasitics, value, nodes, initial, card, rest):
    return (f"terminals\nX1 b c d part\nR1 b 0 10\nL1 e b 10u\nR2 e 0 1\nR3 c 0 1Meg\nR5 d 0 1Meg\n{rest}"
            f".subckt part b c d\nC1 {nodes} {value} {parasitics}{card}\n.ends\n"
            f"{initial}.tran 10n 5u uic\n.meas tran first find v(b) at=10n\n.meas tran mean avg v(b)\n"
            f".meas tran heat integ v(b)*i(r1)\n.end\n")


def main():
    terminals = Checker("initial_terminals")
    for parasitics, value, place in some_of(list(itertools.product(PARASITICS, VALUES, PLACES))):
        nodes, said, volts, rest = place
        found = [run(sys.argv[1], netlist(parasitics, value, nodes, initial, card, rest), method=None)
                 for initial, card in ((f".ic {said}\n", ""), ("", f" IC={volts}"))]
        name = f"{value} {parasitics} at {nodes} with {said}"
        if not terminals.check(all(f.status == 0 for f in found), f"{name}: {found[0].stderr}{found[1].stderr}"):
            continue
        by_nodes, by_card = ([m["value"] for m in f.report["measurements"]] for f in found)
        for own, wanted in zip(by_nodes, by_card):
            terminals.check(abs(own - wanted) <= 1e-8 * abs(wanted) and abs(wanted) > 1e-9, f"{name}: {own}, not {wanted}")
    return terminals.finish()


if __name__ == "__main__":
    sys.exit(main())
