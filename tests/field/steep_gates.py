#!/usr/bin/env python3
"""Gates with edges of up to 1e14 V/s on floating nodes that carry no current.

usage: steep_gates.py PROGRAM

What a source puts out is known at a time, and what follows it is a polynomial of the time since a step began: on such an
edge both differ by the rounding of that time, and a resistor between them carries it where nothing else flows. No audit
may take that for a broken law.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

WAVES = {
    "delayed": "a1 t0 0 0 0 0 0 t 0 BUF td={delay} trise={rise} tfall={rise} rout=1\n",
    "of two clocks": "vt1 t1 0 pulse(0 1 {later} {rise} {rise} {third} {other})\n"
                     "a1 t0 0 t1 0 0 0 t 0 AND trise={rise} tfall={rise} rout=1\n",
    "of a sine": "vs t2 0 sin(0.5 0.5 {frequency})\na1 t2 0 0 0 0 0 t 0 SCHMITT vt=0.5 vh=0.1 trise={rise} tfall={rise} "
                 "rout=1\n",
}
GATES = {
    "a resistor": "eg x w t 0 {volts}\nrg g x {ohms}\n",
    "two sources": "eg y w t 0 {half}\nrm y z {ohms}\neh x z t 0 {half}\nrg g x {ohms}\n",
    "a coil": "eg x w t 0 {volts}\nlg g q 1n\nrg q x {ohms}\n",
    "a diode": "eg x w t 0 {volts}\nrg g x {ohms}\ndg g x dg\n.model dg d(ron=1)\n",
}
SIZES = ((1e-5, 1e-11, 1e3), (1e-5, 1e-9, 10.0), (1e-3, 1e-9, 1e3), (0.1, 1e-6, 10.0))
VOLTS = 1500.0


def netlist(wave, gate, size):
    period, rise, ohms = size
    values = {"delay": 0.01 * period, "rise": rise, "later": 0.481 * period, "third": 0.3 * period,
              "other": 1.37 * period, "frequency": 1.0 / period, "volts": VOLTS, "half": 0.5 * VOLTS, "ohms": ohms}
    clock = f"vt0 t0 0 pulse(0 1 {0.37 * period!r} {rise!r} {rise!r} {0.4 * period!r} {period!r})\n"
    return (f"gate\n{clock}{WAVES[wave].format(**values)}{GATES[gate].format(**values)}"
            f".model sm sw(ron=0.2 roff=20meg vt=750)\ns1 w 0 g w sm\nr1 w 0 4.5\n"
            f".tran {5.0 * period!r} {5.3 * period!r}\n.end\n")


def main():
    gates = Checker("steep_gates")
    for wave, gate, size in some_of([(w, g, s) for w in WAVES for g in GATES for s in SIZES]):
        done = run(sys.argv[1], netlist(wave, gate, size), method=None, report=False,
                   options=("--audit", "full", "--dialect", "ltspice"))
        gates.check(done.status == 0, f"{wave}, {gate}, {size}: {done.stderr}")
    return gates.finish()


if __name__ == "__main__":
    sys.exit(main())
