#!/usr/bin/env python3
"""Bridges of six thyristors on a mains without a neutral, with coils in it: the same in any unit of impedance.

usage: thyristor_bridges.py PROGRAM

A thyristor is a diode with a switch, which a formula keeps closed while its current is above the holding current. As the
last one of a commutation opens, the current of a coil falls to what the off-resistances let pass: the modes of one step
then have conductances over 15 decades, and the side of one diode decides. All ohms times k, the voltages are the same.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

ORDER = [("a", "p"), ("m", "c"), ("b", "p"), ("m", "a"), ("c", "p"), ("m", "b")]


def thyristor(k, anode, cathode, holding):
    return [f"vx{k} {anode} t{k} 0", f"d{k} t{k} u{k} d", f"s{k} u{k} {cathode} g{k} 0 sw",
            f"b{k} g{k} 0 v={{(v(q{k})>0.5 | i(vx{k})>{holding!r}) ? 1 : 0}}"]


def gates(k, angle):
    """Two pulses 60 degrees apart, the second with the next thyristor's first."""
    times = [(30 + angle + 60 * (k + n)) / 360 * 0.02 for n in range(2)]
    return [f"v{k}{n} q{k}{n} 0 pulse(0 1 {t!r} 1u 1u 500u 20m)" for n, t in enumerate(times)] + \
        [f"bq{k} q{k} 0 v={{v(q{k}0)+v(q{k}1)}}"]


def bridge(factor, angle, load):
    cards = []
    for k, phase in enumerate("abc"):
        cards += [f"v{phase} s{phase} n sin(0 325 50 0 0 {-120 * k})", f"l{phase} s{phase} {phase} {0.5e-3 * factor!r}"]
    for k, (anode, cathode) in enumerate(ORDER):
        cards += gates(k, angle) + thyristor(k, anode, cathode, 0.05 / factor)
    cards += [f"l1 p o {10e-3 * factor!r}", f"r9 m 0 {1e4 * factor!r}"]
    cards += [f"r1 o m {5 * factor!r}"] if load == "resistor" else [f"r1 o e {0.2 * factor!r}", "ve e m 300"]
    return "\n".join(["thyristors", *cards, f".model sw sw(ron={1e-3 * factor!r} roff={1e6 * factor!r} vt=0.5 vh=0.1)",
                      f".model d d(ron={1e-3 * factor!r} vfwd=0.8)", ".tran 20u 60m",
                      ".meas tran m avg v(o,m) from=20m to=60m", ".end", ""])


def main():
    checker = Checker("thyristor_bridges")
    for angle, load in ((40, "resistor"), (70, "resistor"), (40, "emf")):
        means = {}
        for factor in (1.0, 1e-3, 1e3, 3e3):
            what = f"{angle} degrees, {load}, ohms times {factor:g}"
            outcome = run(sys.argv[1], bridge(factor, angle, load), method=None, options=["--audit", "full"])
            if checker.check(outcome.status == 0, f"{what}: {outcome.stderr}"):
                means[factor] = outcome.report["measurements"][0]["value"]
                checker.close(means[factor], means[1.0], 1e-6 * 325, f"{what}: the mean voltage of the load")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
