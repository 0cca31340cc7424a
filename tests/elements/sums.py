#!/usr/bin/env python3
"""Formulas of several sources of any kind, which act on a circuit, against the same sum as sources in series.

usage: sums.py PROGRAM METHOD

A formula of sources alone is one function of time: sines with levels and slopes, which change at edges. It acts on RC,
on a rectifier, and on so many other parts that the circuit crosses what small ones are.
"""

import itertools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

# Each of a unit of time T and an amplitude A.
KINDS = {
    "sine": "SIN({a} {b} {f} 0 0 30)",
    "late sine": "SIN(0 {a} {f} {t3})",
    "fading sine": "SIN({a} {b} {f} {t1} {f})",
    "triangle": "PULSE({-a} {b} 0 {t4} {t3} 1e-30 {t9})",
    "late triangle": "PULSE(0 {a} {t1} {t2} {t2} {t1} {t7})",
    "rectangle": "PULSE({-a} {a} 0 0 0 {t3} {t7})",
    "lines": "PWL(0 0 {t1} {a} {t3} {-b} {t3} {b} {t8} 0)",
    "exponential": "EXP(0 {a} {t1} {t2} {t5} {t3})",
    "amplitude modulation": "AM({a} 1 {f} {f5} 0)",
    "frequency modulation": "SFFM(0 {a} {f5} 2 {f})",
    "constant": "{a}",
}
HOSTS = {
    "RC": ["R1 o x {r}", "C1 x 0 {c} ic=0", "R2 x 0 {r}"],
    "a rectifier": ["D1 o y ideal", "R1 y x {r}", "C1 x 0 {c} ic=0", "R2 x 0 {r}"],
}


def stimulus(kind, unit, amplitude):
    values = {"a": amplitude, "b": 0.7 * amplitude, "-a": -amplitude, "-b": -0.7 * amplitude, "f": 0.31 / unit, "f5": 1.7 / unit}
    values.update({f"t{k}": k * unit for k in range(1, 10)})
    text = KINDS[kind]
    for name, value in values.items():
        text = text.replace("{" + name + "}", repr(value))
    return text


def many(n):
    """Other parts of one circuit with the host, of n formulas that nothing but a comparator feels."""
    return [line for k in range(n) for line in (f"Vt{k} t{k} 0 PULSE(-1 1 0 {5 + k} {5 + k} 1e-30 {11 + 2 * k})",
                                                 f"Bm{k} m{k} 0 V=v(p)*0.01-v(t{k})", f"S{k} x n{k} m{k} 0 sm",
                                                 f"Rm{k} n{k} 0 1e12")]


def run_cards(program, what, method, cards):
    return run(program, "\n".join([what, *cards, ".model ideal D(Ron=0)", ".model sm SW(Vt=0 Roff=1e15 Ron=1)", ".end", ""]),
               method=method, tolerance=1e-9)


def agree(checker, program, method, what, cards, formula, series, scale):
    """The host by the formula and by sources in series: what it does is the same."""
    done = [run_cards(program, what, method, [*cards, *drive]) for drive in (formula, series)]
    if not checker.check(all(d.status == 0 for d in done), f"{what}: {done[0].stderr} {done[1].stderr}"):
        return
    for name in ("v(o)", "v(x)"):
        for k in range(1, 41):
            t = k * float(cards[-1].split()[1])
            checker.close(done[0].at(name, t), done[1].at(name, t), 2e-8 * scale, f"{what}: {name} at {t:g}")


def sums(checker, program, method):
    pairs = list(itertools.combinations(KINDS, 2))
    for k, (first, second) in enumerate(some_of(pairs)):
        unit, amplitude = (1e-3, 1.0) if k % 3 == 0 else (1e-6, 325.0) if k % 3 == 1 else (2.0, 1e-3)
        host = list(HOSTS)[k % 2]
        parts = [card.replace("{r}", "1e3").replace("{c}", repr(unit / 1e3)) for card in HOSTS[host]]
        parts += [f"V1 p 0 {stimulus(first, unit, amplitude)}", f"V2 q 0 {stimulus(second, unit, amplitude)}",
                  f".tran {unit / 4!r} {10 * unit!r} uic"]
        agree(checker, program, method, f"{first} and {second} on {host}", parts, ["B1 o 0 V=0.8*v(p)-1.5*v(q)"],
              ["E1 o w p 0 0.8", "E2 w 0 q 0 -1.5"], 2.5 * amplitude)
        if k % 4 == 0:
            limits = f"{-0.3 * amplitude!r},{0.5 * amplitude!r}"
            agree(checker, program, method, f"{first} and {second}, limited", parts, [f"B1 o 0 V=limit(v(p)-v(q),{limits})"],
                  ["E1 s w p 0 1", "E2 w 0 q 0 -1", "R8 s u 1", "R9 u 0 1e12", f"B1 o 0 V=limit(v(u),{limits})"], amplitude)
        if k % 5 == 0:
            agree(checker, program, method, f"{first} and {second} as a current", parts, ["B1 0 o I=0.001*(v(p)+v(q))", "R9 o 0 1e3"],
                  ["G1 0 o p 0 0.001", "G2 0 o q 0 0.001", "R9 o 0 1e3"], 2 * amplitude)


def sizes(checker, program, method):
    """From few to many formulas that only drive switches: 64 of them and more take part in each step."""
    for n in (0, 5, 15, 16, 17, 31, 33, 50):
        parts = ["R1 o x 1", "C1 x 0 1 ic=0", "R2 x 0 1", *many(n), "V1 p 0 SIN(0 1 0.13)",
                 "V2 q 0 PULSE(0 1 0 3 4 1e-30 8)", ".tran 0.25 10 uic"]
        agree(checker, program, method, f"{n} comparators", parts, ["B1 o 0 V=v(p)-v(q)"], ["E1 o w p 0 1", "E2 w 0 q 0 -1"], 2)


def main():
    program, method = pathlib.Path(sys.argv[1]).resolve(), None if sys.argv[2] == "auto" else sys.argv[2]
    checker = Checker("sums")
    sums(checker, program, method)
    sizes(checker, program, method)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
