#!/usr/bin/env python3
"""Diodes that open less than a picosecond behind the corner of a ramp, sooner than any micro-step can see.

usage: behind_edges.py PROGRAM

A source bends, and nothing jumps: a diode that carries a current carries it just behind the corner, too. It opens when
the ramp over its resistance (or its current over the ramp) has taken it down, at corner + i R / slope (or i / slope).
Alone, and with a cable that reads it and crosses the sizes from which steps are made by factors; at all tolerances and
stages. The time is known as the source is: to the tolerance of its fall."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

CORNER, STOP = 5e-6, 10e-6


def cable(sections, node):
    cards = [f"ez z0 0 {node} 0 1"]
    for k in range(sections):
        cards += [f"rz{k} z{k} z{k + 1} 100", f"cz{k} z{k + 1} 0 13n"]
    return "\n".join(cards) if sections else ""


def peak(volts, ohms, farads, load, fall):
    """A rectifier whose capacitor is charged: cards, node, seconds that the source falls and that the diode goes on."""
    current = volts / (ohms + load)
    return (f"v1 a 0 pwl(0 {volts} {CORNER} {volts} {CORNER + fall!r} 0)\nd1 a o d\nc1 o 0 {farads} ic={current * load!r}\n"
            f"r1 o 0 {load!r}\n.model d d(ron={ohms!r})", "o", fall, current * ohms / (volts / fall))


def bridge(volts, ohms, farads, load, fall):
    current = volts / (2 * ohms + load)
    return (f"v1 a b pwl(0 {volts} {CORNER} {volts} {CORNER + fall!r} 0)\nrb b 0 1meg\nd1 a p d\nd2 n b d\nd3 b p d\n"
            f"d4 n a d\nc1 p n {farads} ic={current * load!r}\nr1 p n {load!r}\n.model d d(ron={ohms!r})", "p", fall,
            current * 2 * ohms / (volts / fall))


def pump(volts, ohms, farads, load, fall):
    """The flying capacitor between two diodes, its foot on the source."""
    current = volts / (ohms + load)
    return (f"v1 g 0 pwl(0 {volts} {CORNER} {volts} {CORNER + fall!r} 0)\nvb in 0 {volts / 8}\nd0 in f d\n"
            f"cf f g 1 ic=0\nd1 f o d\nc1 o 0 {farads} ic={current * load!r}\nr1 o 0 {load!r}\n"
            f".model d d(ron={ohms!r})", "o", fall, current * ohms / (volts / fall))


def coil(amperes, ohms, henries, part, fall):
    """The dual: a diode takes what a coil does not, and the source is turned down."""
    own = amperes * part
    drop = (amperes - own) * ohms
    return (f"i1 0 a pwl(0 {amperes} {CORNER} {amperes} {CORNER + fall!r} 0)\nd1 a 0 d\nl1 a b {henries} ic={own!r}\n"
            f"r1 b 0 {drop / own!r}\n.model d d(ron={ohms!r})", "a", fall, (amperes - own) / (amperes / fall))


CIRCUITS = {
    "small": peak(5, 10e-3, 10e-6, 99.0, 10e-9),
    "mains": peak(600, 1e-3, 1e-3, 200.0, 20e-9),
    "faint": peak(2, 0.1, 1e-6, 1e5, 50e-9),
    "amperes": peak(12, 1e-4, 1e-2, 2.0, 1e-9),
    "steep": peak(400, 5e-3, 1e-4, 1e3, 1e-10),
    "bridge": bridge(10, 10e-3, 100e-6, 50.0, 10e-9),
    "bridge of 325 V": bridge(325, 2e-3, 470e-6, 400.0, 30e-9),
    "pump": pump(5, 10e-3, 10e-6, 99.0, 10e-9),
    "pump of 1 kV": pump(1000, 10e-3, 10e-6, 1e5, 10e-9),
    "coil": coil(1.0, 1e-3, 1e-3, 0.999, 1e-9),
    "coil of 100 A": coil(100.0, 1e-4, 1e-4, 0.9999, 2e-9),
}
ARGUMENTS = [(tolerance, stages) for tolerance in ("1e-4", "1e-6", "1e-9") for stages in (None, 3, 5, 7, 9)]


def first_opening(result):
    return min((e["time"] for e in result.report["events"] if e["element"] == "d1" and e["state"] == "off"), default=None)


def main():
    program = sys.argv[1]
    checker = Checker("behind edges")
    cases = [(name, sections, *a) for name in CIRCUITS for sections in (0, 20, 45) for a in ARGUMENTS]
    for name, sections, tolerance, stages in some_of(cases):
        cards, node, fall, later = CIRCUITS[name]
        case = f"{name}, {sections} sections, tolerance {tolerance}, {stages} stages"
        netlist = f"{name}\n{cards}\n{cable(sections, node)}\n.tran 10n {STOP!r} uic\n.end\n"
        result = run(program, netlist, method="radau" if stages else None, tolerance=tolerance, stages=stages,
                     options=["--audit", "full"])
        if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
            continue
        opens = first_opening(result)
        if checker.check(opens is not None, f"{case}: d1 never opens"):
            off = abs(opens - CORNER - later)
            allowed = max(1e-3 * later, float(tolerance) * fall, 1e-11 * STOP)
            checker.check(off <= allowed, f"{case}: d1 opens {opens - CORNER:.3e} s behind the corner, not {later:.3e}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
