#!/usr/bin/env python3
"""Thyristors whose current something takes over at 0 V or next to it: a diode or a thyristor against them, or a switch.

usage: thyristor_takeovers.py PROGRAM

There no voltage backwards shows the end of a current, nor does any size of it. Bursts of an AC controller end with the half wave in which both gates
do. A resonant pulse through a thyristor and back through its diode is one period of the ring, and no more. Both have closed
forms.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

EXACT = 1e-7
# what a thyristor stands beside, from x to y: its anode is x, and the current comes back from y to x
BACK = {
    "a diode": "d1 y x d\n",
    "two diodes": "d1 y u d\nd2 u x d\n",
    "a diode with a meter": "vm y u 0\nd1 u x d\n",
    "a diode with a meter of a parameter": "vm y u dc {none} ac 1\nd1 u x d\n",
    "a diode with a meter in volts": "vm y u 0V\nd1 u x d\n",
    "a diode with a wire": "r3 y u 0.0\nd1 u x d\n",
    "a diode with a wire of a parameter": "r3 y u {none}\nd1 u x d\n",
    "a diode with a coil of 0 H": "l3 y u 0\nd1 u x d\n",
    "a diode that is a code model": "a3 y x sd\n",
    "a diode in a subcircuit": "x3 Y X outer\n.subckt outer p q\nx4 p q inner\n.ends\n.subckt inner A K\nd1 a k d\n.ends\n",
    "a diode behind 1 nohm": "r3 y u 1n\nd1 u x d\n",
    "a diode behind 1 fH": "l3 y u 1f\nd1 u x d\n",
    "a diode behind a winding": "l3 y u 1m\nl4 q 0 2m\nk3 l3 l4 1\nr4 q 0 0\nd1 u x d\n",
    "a diode behind an amplifier of nothing": "e3 y u q 0 3\nv3 q 0 0\nr4 q 0 1\nd1 u x d\n",
    "a diode behind a formula of nothing": "v3 q 0 0\nr4 q 0 1\nb3 y u V={2*v(q)}\nd1 u x d\n",
    "a diode behind what reads no current": "v3 q 0 0\nh3 y u v3 5\nd1 u x d\n",
    "a diode behind a sine of 0 V": "v3 y u sin(0 0 1k)\nd1 u x d\n",
    "a thyristor": "a2 y x g x th\n",
    "a triac": "a2 y x g x tr\n",
}
MODELS = ".param none=0\n.model sd sidiode(ron=0)\n.model d D(ron=0)\n.model tr triac\n"


def look_at(checker, program, name, text, times, column, exact):
    done = run(program, name + "\n" + text, at=times, method=None)
    if not checker.check(done.status == 0, f"{name}: {done.stderr}"):
        return
    largest = max(map(abs, exact))
    off, when = max((abs(a - b), t) for a, b, t in zip(done.column(column), exact, times))
    checker.check(off <= EXACT * largest, f"{name}: {column} is off by {off / largest:.2g} of its largest value at {when:g} s")


def resonant(checker, program, back, volts, ohms, drop):
    """0 V to 2 (volts - drop) by half a period of the ring, and back to 2 drop by another."""
    w = 1e5
    name = f"a pulse of {volts:g} V and {ohms:g} ohm back through {back}, {drop:g} V"
    gated = "thyristor" in back or "triac" in back
    text = (f"v1 in 0 {volts!r}\nl1 in x {ohms / w!r} ic=0\nc1 y 0 {1 / (ohms * w)!r} ic=0\na1 x y g y th\n{BACK[back]}"
            f"vg g {'y' if not gated else 'x'} pulse(0 1 {1 / w!r} 0 0 {(0.5 if not gated else 4) / w!r} 1)\n{MODELS}"
            f".model th thyristor(vfwd={drop!r})\n.tran {1 / w!r} {12 / w!r} uic\n.end\n")
    if gated:  # the gate is that of both, and ends on the way back
        text = text.replace("a1 x y g y th", "a1 x y g x th")
    times = [(k + 0.3) / 8 / w for k in range(95)]

    def exact(t):
        p = w * t - 1
        if p <= 0:
            return 0.0
        if p <= math.pi:
            return (volts - drop) * (1 - math.cos(p))
        if p <= 2 * math.pi:
            return volts + (volts - 2 * drop) * -math.cos(p)
        return 2 * drop

    look_at(checker, program, name, text, times, "v(y)", [exact(t) for t in times])


def two_names_of_ground(checker, program, cathode, back):
    """The pulse ends in a capacitor on the other side of the source, as the cathode is ground."""
    w, volts, ohms = 1e5, 100.0, 10.0
    text = (f"v1 in y {volts!r}\nl1 in x {ohms / w!r} ic=0\nc1 y 0 {1 / (ohms * w)!r} ic=0\na1 x {cathode} g {cathode} th\n"
            f"d1 {back} x d\nvg g 0 pulse(0 1 {1 / w!r} 0 0 {0.5 / w!r} 1)\n{MODELS}.model th thyristor\n"
            f".tran {1 / w!r} {12 / w!r} uic\n.end\n")
    times = [(k + 0.3) / 8 / w for k in range(95)]
    look_at(checker, program, f"a cathode at {cathode}, a diode at {back}", text, times, "v(y)",
            [-volts * (1 - math.cos(min(max(w * t - 1, 0), 2 * math.pi))) for t in times])


def burst(checker, program, back, volts, ratio, periods):
    """R and w L = ratio R, from a zero of the voltage on; both gates end together."""
    w = 100 * math.pi
    name = f"a burst of {periods} periods of {volts:g} V into R and w L = {ratio} R, against {back}"
    start, end = 0.01, 0.01 + 0.02 * periods
    text = (f"v1 in 0 sin(0 {volts!r} 50)\nl1 in z {ratio * 2 / w!r} ic=0\nr1 z x 2\na1 x y g x th\n{BACK[back]}r2 y 0 0\n"
            f"vg g x pulse(0 1 {start} 0 0 {end - start!r} 1)\n{MODELS}.model th thyristor\n.tran 1m {end + 0.05!r} uic\n.end\n")
    angle, size = math.atan(ratio), volts / 2 / math.hypot(1, ratio)

    def forced(t):
        p = w * (t - start)
        return -size * (math.sin(p - angle) + math.sin(angle) * math.exp(-p / ratio))

    low = end
    while forced(low) * forced(low + 1e-4) > 0:
        low += 1e-4
    high = low + 1e-4
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if forced(low) * forced(middle) > 0 else (low, middle)
    times = [0.001 * (k + 0.31) for k in range(int((end + 0.05) * 1000) - 1)]
    look_at(checker, program, name, text, times, "i(l1)", [forced(t) if start < t < high else 0.0 for t in times])


def bypass(checker, program, volts):
    """A soft starter whose contactor takes the current over, and ends it when the gates are long off."""
    name = f"a contactor across two thyristors, {volts:g} V"
    text = (f"v1 in 0 sin(0 {volts!r} 50)\nr1 in x 5\na1 x y g x th\na2 y x g x th\ns1 x y b 0 sw\nvm y 0 0\n"
            "vg g x pulse(0 1 10m 0 0 43m 1)\nvb b 0 pulse(0 1 32m 0 0 41m 1)\n.model sw SW(ron=0 vt=0.5)\n"
            ".model th thyristor\n.tran 1m 110m\n.end\n")
    times = [0.001 * (k + 0.31) for k in range(109)]
    look_at(checker, program, name, text, times, "i(vm)",
            [volts / 5 * math.sin(100 * math.pi * t) if 0.01 < t < 0.073 else 0.0 for t in times])


def charge(checker, program, way):
    """1 uF at 10 V and 1 uF at 0 through what some formula reads the current of, at 10 us: 5 uC."""
    text = (f"c1 a 0 1u ic=10\nc2 b 0 1u ic=0\n{way}\nvg g b pulse(0 1 10u 0 0 10u 1)\n.model tr triac\n.model ti triac(ih=1m)\n"
            ".model sw SW(ron=0 vt=0.5)\n.tran 1u 50u uic\n.end\n")
    times = [1e-6 * (k + 0.31) for k in range(45)]
    look_at(checker, program, way.replace("\n", ", "), text, times, "v(b)", [0.0 if t < 1e-5 else 5.0 for t in times])


CHARGES = ("a1 a b g b tr", "a1 b a g b tr", "a1 a b g b ti", "r1 a u 0\ns1 u b g b sw\nb1 q 0 V=i(r1)",
           "l1 a u 0\ns1 u b g b sw\nb1 q 0 V={limit(i(l1),-1,1)}", "r1 a u 0\na1 u b g b tr\nb1 q 0 V=i(r1)")


def main():
    program = sys.argv[1]
    checker = Checker("thyristor_takeovers")
    for cathode, back in ("gnd", "0"), ("0", "GND"), ("gnd", "gnd"):
        two_names_of_ground(checker, program, cathode, back)
    for back in BACK:
        for volts, ohms, drop in some_of([(100.0, 10.0, 0.0), (1e4, 1.0, 0.0), (3.0, 10.0, 0.0), (50.0, 2.0, 0.7), (1e5, 1.0, 0.0), (1e-3, 1e3, 0.0)]):
            if drop == 0 or "diode" in back:
                resonant(checker, program, back, volts, ohms, drop)
    for back in ("a thyristor", "a triac"):
        for volts, ratio, periods in some_of([(325.0, 1.0, 2.3), (4e5, 5.0, 1.1), (2.0, 0.01, 0.7), (2e-6, 0.5, 0.7), (325.0, 0.2, 1.5)]):
            burst(checker, program, back, volts, ratio, periods)
    for way in CHARGES:
        charge(checker, program, way)
    for volts in (325.0, 1.0, 1e-7):
        bypass(checker, program, volts)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
