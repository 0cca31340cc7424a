#!/usr/bin/env python3
"""Coils that ideal switches put in series one after the other: the response against sampled-data formulas.

The dual of shared_charge.py: the orbit is at rest, all coils have one current, and nothing jumps. A small signal leaves them
at currents that differ, and at each instant at which a switch opens flux passes. The first coil follows the source while its
switch is open; the last one holds what it has until its own switch opens again.

usage: shared_flux.py PROGRAM
"""

import sys

from shared_charge import FRACTIONS, Chain, check_chains

# store: H, of each coil; begin: parts of the period at which the switches open; wide: how long they stay open
CHAINS = [
    Chain("one to three", 1.0, 10e-6, 0.4, (1e-6, 3e-6), (0.0, 0.5), ""),
    Chain("nanohenries", 3.3, 100e-9, 0.3, (1e-9, 0.4e-9), (0.1, 0.55), ""),
    Chain("a large one behind", 400.0, 1e-3, 0.45, (1e-6, 100e-6), (0.02, 0.5), ""),
    Chain("at once behind each other", 5.0, 20e-6, 0.5, (10e-6, 22e-6), (0.0, 0.5), ""),
    Chain("three, forward", 12.0, 5e-6, 0.2, (1e-6, 2e-6, 3e-6), (0.05, 0.35, 0.65), ""),
    Chain("three, backward", 12.0, 5e-6, 0.2, (1e-6, 2e-6, 3e-6), (0.65, 0.35, 0.05), ""),
    Chain("four", -2.0, 40e-6, 0.15, (1e-3, 0.5e-3, 2e-3, 0.1e-3), (0.0, 0.25, 0.5, 0.75), ""),
    Chain("behind a current mirror", 1.0, 10e-6, 0.3, (1e-6, 4e-6), (0.1, 0.6), "mirror"),
    Chain("windings on a core", 1.0, 10e-6, 0.3, (1e-6, 4e-6), (0.1, 0.6), "windings"),
    Chain("two side by side", 7.0, 10e-6, 0.3, (3e-6, 2e-6), (0.1, 0.6), "parallel"),
    Chain("capacitors in the loops", 2.0, 10e-6, 0.3, (3e-6, 2e-6), (0.1, 0.6), "C9 0 s 1u\nR9 s 0 1\n"),
    Chain("no load but a gigaohm", 2.0, 10e-6, 0.3, (3e-6, 2e-6, 1e-6), (0.1, 0.5, 0.9), "R9 n0 0 1g\n"),
]


def coil(chain, k, at, to):
    """Of the inductance store[k], however it is made."""
    henry = chain.store[k]
    if chain.extra == "windings":  # L + L + 2 k L, with k = 0.5
        part = henry / 3.0
        return f"L{k} {at} m{k} {part!r}\nLb{k} m{k} {to} {part!r}\nK{k} L{k} Lb{k} 0.5\n"
    if chain.extra == "parallel":
        return f"L{k} {at} m{k} {0.5 * henry!r}\nLb{k} m{k} {to} {henry!r}\nLc{k} m{k} {to} {henry!r}\n"
    return f"L{k} {at} {to} {henry!r}\n"


def netlist(chain):
    text = f"* {chain.name}\n"
    if chain.extra == "mirror":
        text += f"I1 0 p DC {chain.level} AC 1\nVp p 0 0\nF1 0 n0 Vp 1\n"
    else:
        text += f"I1 0 n0 DC {chain.level} AC 1\n"
    if chain.extra.count("\n"):
        text += chain.extra
    n = len(chain.store)
    for k, begin in enumerate(chain.begin):
        text += (f"Vg{k} g{k} 0 PULSE(1 0 {begin * chain.period!r} 0 0 {chain.wide * chain.period!r} {chain.period!r})\n"
                 f"S{k} n{k} 0 g{k} 0 sm\n" + coil(chain, k, f"n{k}", f"n{k + 1}" if k + 1 < n else "0"))
    asked = " ".join(repr(part / chain.period) for part in FRACTIONS)
    return text + f".model sm SW(Ron=0 Vt=0.5)\n.save i(L{n - 1})\n.pss uic\n.ac list {asked}\n.end\n"


if __name__ == "__main__":
    sys.exit(check_chains("shared_flux", CHAINS, netlist))
