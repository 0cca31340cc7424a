#!/usr/bin/env python3
"""Comparators of a coil's current, beside kicks of 1e8 V where switches interrupt that coil.

usage: clashes_beside_kicks.py PROGRAM

One output of a matrix converter with four-step commutation, whose steps depend on the sign of the output current. Where
this current passes 0 within a commutation, all its ways open, and it falls through the resistances of open switches. Then
the comparator reads a small part of what flowed, while voltages beside it are as large as never again. Its threshold is 0:
so the circuit is linear in its voltages, and a run with other sources has the same waveforms in other units.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

LEG = """X1{n} a o{n} a1{n} a2{n} bis
X2{n} b o{n} b1{n} b2{n} bis
Lo{n} o{n} x{n} {coil}
Ro{n} x{n} 0 {load}
Vc{n} c{n} 0 PULSE(0 1 {late} 0 0 {half} {period})
Bsg{n} sg{n} 0 V=i(Lo{n})>0
Bq0{n} q0{n} 0 V=v(c{n})>0.5
Bq1{n} q1{n} 0 V=delay(v(q0{n}),{step})>0.5
Bq2{n} q2{n} 0 V=delay(v(q0{n}),{two})>0.5
Bq3{n} q3{n} 0 V=delay(v(q0{n}),{three})>0.5
Ba1{n} a1{n} 0 V=v(sg{n})>0.5 ? v(q1{n})>0.5 : (v(q3{n})>0.5 & v(q0{n})>0.5)
Ba2{n} a2{n} 0 V=v(sg{n})>0.5 ? (v(q3{n})>0.5 & v(q0{n})>0.5) : (v(q1{n})>0.5)
Bb1{n} b1{n} 0 V=v(sg{n})>0.5 ? (v(q2{n})<0.5) : (v(q0{n})<0.5 & v(q3{n})<0.5)
Bb2{n} b2{n} 0 V=v(sg{n})>0.5 ? (v(q0{n})<0.5 & v(q3{n})<0.5) : (v(q2{n})<0.5)
"""
SWITCH = """.subckt bis i o gf gr
Sf i x gf 0 s
Df x o d
Sr o y gr 0 s
Dr y i d
.model s sw(vt=.5 ron=1m roff=1e7)
.model d d(ron=1m roff=1e8)
.ends
"""
# coil, load, length of a commutation step, period, legs, stop
CONVERTERS = {
    "a leg": ("10m", 10, 1e-6, 200e-6, 1, 0.02),
    "two legs": ("10m", 10, 1e-6, 200e-6, 2, 0.015),
    "a coil of 50 mH": ("50m", 2, 1e-6, 200e-6, 1, 0.035),
    "25 kHz": ("10m", 10, 3e-7, 40e-6, 1, 0.015),
}
SOURCES = (3e-3, 311.0)


def netlist(name, volts):
    coil, load, step, period, n_legs, stop = CONVERTERS[name]
    legs = "".join(LEG.format(n=k, coil=coil, load=load, step=step, two=2 * step, three=3 * step, late=k * period / 3,
                              half=period / 2, period=period) for k in range(n_legs))
    return (f"{name}\nVa a 0 SIN(0 {volts!r} 50)\nVb b 0 SIN(0 {volts!r} 50 0 0 -120)\n{SWITCH}{legs}"
            f".tran {stop / 100!r} {stop!r}\n.end\n"), stop


class Clashes(Checker):
    def look_at(self, name):
        found = {}
        for volts in SOURCES:
            text, stop = netlist(name, volts)
            times = [stop * (k + 0.37) / 40 for k in range(40)]
            done = run(sys.argv[1], text, at=times, method=None)
            if not self.check(done.status == 0, f"{name}, {volts} V: {done.stderr}"):
                continue
            found[volts] = [i / volts for i in done.column("i(lo0)")]
        first = found.get(SOURCES[0])
        for volts, currents in found.items():
            off = max(abs(a - b) for a, b in zip(currents, first or currents)) / max(map(abs, currents))
            self.check(off <= 1e-6, f"{name}, {volts} V: i(lo0) is off by {off:.2g} of its largest value")


def main():
    clashes = Clashes("clashes_beside_kicks")
    for name in some_of(list(CONVERTERS)):
        clashes.look_at(name)
    return clashes.finish()


if __name__ == "__main__":
    sys.exit(main())
