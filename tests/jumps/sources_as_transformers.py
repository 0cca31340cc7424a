#!/usr/bin/env python3
"""Means beside impulses where a transformer is drawn with controlled sources.

usage: sources_as_transformers.py PROGRAM

E makes the secondary's voltage and F takes its current from the primary. A switch opens without end into coils that do
not agree, so that fluxes jump and no charge does. Over a run from rest the mean voltage of each coil is L i(end)/T, the
mean current of each capacitor C v(end)/T, and both windings have their ratio, impulses included."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

SPAN = 200e-6
# each but for the transformer, which is from b to 0 and from c to 0: cards, coils and capacitors between their nodes
TOPOLOGIES = {
    "Cuk": ("l1 in a {a}\ns1 a 0 g 0 sw\nds 0 a\nc1 a b 20u\nlm b 0 {b}\nc2 c d 20u\nd1 d 0\nl2 d o {c}\nc3 o 0 10u\nr1 o 0 30",
            {"l1": "in,a", "lm": "b", "l2": "d,o"}, {"c1": "a,b", "c2": "c,d", "c3": "o"}),
    "SEPIC": ("l1 in a {a}\ns1 a 0 g 0 sw\nds 0 a\nc1 a b 20u\nlm b 0 {b}\nl2 c d {c}\nd1 d o\nc3 o 0 10u\nr1 o 0 30",
              {"l1": "in,a", "lm": "b", "l2": "c,d"}, {"c1": "a,b", "c3": "o"}),
    "forward with a choke and no free wheel": ("s1 in b g 0 sw\nlm b 0 {b}\nd1 c d\nl2 d o {c}\nc3 o 0 10u\nr1 o 0 30",
                                               {"lm": "b", "l2": "d,o"}, {"c3": "o"}),
}
VALUES = [(200e-6, 500e-6, 400e-6, 2.0), (10e-6, 100e-6, 1e-3, 0.5), (1e-6, 50e-6, 20e-6, 10.0), (5e-3, 2e-3, 2e-3, 3.0)]
SIGNS = [1.0, -1.0]


def check(checker, what, topology, values, sign):
    cards, coils, capacitors = TOPOLOGIES[topology]
    a, b, c, ratio = values
    ratio *= sign
    size = {**dict(zip(("l1", "lm", "l2"), (a, b, c))), **dict.fromkeys(("c1", "c2"), 20e-6), "c3": 10e-6}
    lines = ["t", "v1 in 0 24", cards.format(a=a, b=b, c=c), f"e1 c 0 b 0 {ratio}", f"f1 b 0 e1 {-ratio}",
             "vg g 0 pulse(0 1 0 0 0 8u 20u)", ".model sw sw(vt=0.5 ron=20m)", f".tran 2u {SPAN} uic"]
    for name, nodes in coils.items():
        lines += [f".meas tran mean_{name} avg v({nodes})", f".meas tran end_{name} find i({name}) at={SPAN}"]
    for name, nodes in capacitors.items():
        lines += [f".meas tran mean_{name} avg i({name})", f".meas tran end_{name} find v({nodes}) at={SPAN}",
                  f".meas tran volts_{name} avg v({nodes})"]
    lines += [".meas tran primary avg v(b)", ".meas tran secondary avg v(c)", ".end", ""]
    outcome = run(sys.argv[1], "\n".join(lines), method="auto")
    if not checker.check(outcome.status == 0, f"{what}: {outcome.stderr}"):
        return
    found = {m["name"]: m["value"] for m in outcome.report["measurements"]}
    missing = [name for name, value in found.items() if value is None]
    if not checker.check(not missing, f"{what}: {missing} are not told"):
        return
    for name in (*coils, *capacitors):
        mean = size[name] * found[f"end_{name}"] / SPAN
        scale = 24.0 if name in coils else 24.0 * size[name] / SPAN
        checker.close(found[f"mean_{name}"], mean, 1e-6 * max(abs(mean), scale), f"{what}: {name}")
    wanted = ratio * found["primary"]
    checker.close(found["secondary"], wanted, 1e-7 * max(abs(wanted), 24.0), f"{what}: windings")


def main():
    checker = Checker("sources_as_transformers")
    for topology in TOPOLOGIES:
        for values in VALUES:
            for sign in SIGNS:
                check(checker, f"{topology}, {values}, sign {sign:+.0f}", topology, values, sign)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
