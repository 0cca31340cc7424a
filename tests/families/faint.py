#!/usr/bin/env python3
"""Events that are faint beside what the circuit works with, against closed forms.

usage: faint.py PROGRAM leak|large_leak|flank|difference|large_difference|stray|opposed|overtaken|cut_off|late|
                        beside|spiked|dip

leak: a switch connects a sine to a diode that clamps it, 1000 A; open, it leaks 10 uA, which the diode
carries as long as the source is positive, and blocks after that: at the zero of the sine, and no volt is
off by what 1000 A may be off by. v = sin: 0 while the diode conducts, else v_s R / (R + R_off). Large: the
same with a line of 100 sections that listens to it, so that steps are solved on sparse factors.

flank: a capacitor is charged through a resistor and a diode, and after w the source falls, so fast that it
takes down what current is left within pico- and femtoseconds. With k the slope and i the current left,
i(u) = C k (exp(-u/RC) - 1) + i exp(-u/RC), which is 0 at u = RC log(1 + i / (C k)); from then on the capacitor
keeps its voltage. Micro-steps see the diode open at once; that it conducts first takes shorter ones.

difference: 400 V feed 100 uF through 1 mohm, beside which a switch loads 10 ohm. A millivolt of the capacitor
is an ampere of the source, and what is well within 1e-6 of 400 V is not so of 40 A. The current goes to
V / (R + r), or 0, at the rate (1/r + 1/R) / C, or 1/(r C). Rounding ends at 1e-9. Large: on sparse factors.

stray: a boost converter at the zero of its source rings with 4 pF through a diode of 72.5 mohm onto 0.1753 F. What
rounding makes of 0.1753 F is a current of 40 uA in the steps of this ringing, what it makes of the resistance
is none: a diode that could carry 40 uA backwards leaves the 4 pF at another voltage.

opposed: two diodes point at a node where nothing is stored, one from a coil, one from 1 mF that rings with 20 ps.
No current can pass them. When the coil's end comes by the voltage of the capacitor, its diode closes and the
other one opens; what rounding makes of 1 mF in 10 ps is microamperes, but what enters a node leaves it.

overtaken: a switch charges 1 pF within femtoseconds, past the voltage of 600 pF beside a coil of 3 mH, and a diode
joins them. What rounding of the currents makes of 3 mH in so short a step is volts, but the coil's end is a
capacitor, which is known. The time is that of the two charges, RC log((V - v0) / (V - v)) and an LC's cosine.

cut_off: a Vienna rectifier (seed 63 of converters.py) whose switch leaves the current of a coil to a diode. In
a first step of 1e-14 s the mode in which it has nowhere to go makes 1e11 V of 6 A, beside which nothing is an
error: 3.9 A were lost. At 1e-6 the coils have the currents that they have at 1e-8.

late: a diode that closes picoseconds after its voltage has turned has had the wrong sign. Whether a run has such
a thing or not, what the report says of it is said to the user.

beside: a Vienna rectifier (seed 243 of converters.py) in which two diodes leave a node that nothing else reaches.
The end of a coil of 0.4 H without current comes by the other one's voltage: then that one closes, and this one
opens in the same moment, though what tells, 1e-16 A, is nothing beside the 250 A of a capacitor. And a diode at the
other end of 0.4 H closes in time, which rounding of these 250 A says nothing about. Else currents of 10 nA are
passed from diode to diode, a thousand times in a microsecond. Where a switch opens, a diode is tied, and what
micro-steps of 1e-18 s say of the others is rounding of 61 uF: the state stays as it is. Where another one closes,
3 pF are discharged through 2 mohm, in steps in which a node behind a coil of 0.4 H hangs on 1e-15 of what joins it
to the next node, and is no island. Where other diodes leave something open besides, that is so as well, and one that
carries nothing can open: in a run of 1.2 ms it had 83 V across 0.4 H until it was seen.

spiked: a Vienna rectifier (seed 171 of converters.py) with 6 pF behind a diode, which opens when what charges
them, nanoamperes, ends. That they once took a spike does not make that current less known: it says what voltage they
keep. Up to 1.6 ms, against 1e-8.

dip: a twelve-pulse rectifier (seed 307 of converters.py) that starts from rest. In a step of a picosecond a diode
is wrong on either side, by an error of the polynomial. The step of implicit Euler that decides was 4000 times as long,
and what it missed of the ringing was 3e-5 of a current a millisecond later.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import converter_netlists  # noqa: E402
from dalcs_program import Checker, run, some_of  # noqa: E402

TOLERANCES = 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10
EVENT = 1e-11  # of the stop time, or the tolerance: times are as exact as what crosses


def start(program, checker, case, netlist, at, tolerance):
    result = run(program, netlist, at=at, method=None, tolerance=tolerance)
    if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
        return None
    checker.check(result.report["work"]["euler_steps"] == 0, f"{case}: fell back")
    return result


def events(result, element):
    return [(e["time"], e["state"]) for e in result.report["events"] if e["element"] == element]


def check_times(checker, case, found, wanted, stop, tolerance):
    if checker.check([s for _, s in found] == [s for _, s in wanted],
                     f"{case}: events {found} instead of {wanted}"):
        off = max((abs(a - b) for (a, _), (b, _) in zip(found, wanted)), default=0.0)
        checker.check(off <= max(EVENT, tolerance) * stop, f"{case}: an event is {off:.1e} s off")


def check_signal(checker, case, result, signal, exact, tolerance):
    off = max(abs(a - b) for a, b in zip(result.column(signal), exact)) / max(map(abs, exact))
    print(f"{case}: {signal} {off:.1e}")
    checker.check(off <= tolerance, f"{case}: {signal} is off by {off:.1e}")


def leak(program, checker, more=""):
    netlist = f"""a leak beside 1000 A
v1 s 0 sin(0 10 1k)
rs s a 10m
s1 a n g 0 sm
d1 n 0 di
r1 n 0 1k
vg g 0 pulse(0 1 50u 0.1u 0.1u 30u 100u)
{more}.model sm sw(vt=0.5 roff=1meg)
.model di d
.tran 1u 1m uic
.end
"""
    stop = 1e-3
    share = 1e3 / (1e3 + 1e-2 + 1e6), 1e3 / (1e3 + 1e-2)
    # not while the switch moves: it does where the gate passes 0.5 V
    at = [(k + 0.37) * 1e-6 for k in range(1000) if k % 100 not in (50, 80)]
    exact = [min(0.0, 10.0 * math.sin(2e3 * math.pi * t)) * share[50.05e-6 < t % 1e-4 < 80.15e-6] for t in at]
    for tolerance in some_of(TOLERANCES):
        case = f"leak{' in a large part' if more else ''}, {tolerance}"
        result = start(program, checker, case, netlist, at, tolerance)
        if result is not None:
            check_signal(checker, case, result, "v(n)", exact, tolerance)
            check_times(checker, case, events(result, "d1"), [(0.5e-3, "off")], stop,
                        tolerance)


def large_leak(program, checker):
    line = "".join(f"rm{k} m{k} m{k + 1} 1k\ncm{k} m{k + 1} 0 1n\n" for k in range(100))
    leak(program, checker, "em m0 0 a 0 1\n" + line)


def flank(program, checker):
    resistance, capacitance, slope = 0.1, 20e-6, 15.0 / 20e-9
    rc = resistance * capacitance
    stop = 160e-6
    for width in some_of((4e-6, 8e-6, 12e-6, 16e-6, 20e-6, 24e-6)):
        left = 10.0 * math.exp(-width / rc)  # V, across the resistor
        u = rc * math.log1p(left / (slope * rc))
        held = 10.0 - slope * u
        netlist = f"""a flank takes down {left / resistance:.1e} A
v1 s 0 pwl(0 10 {width!r} 10 {width + 20e-9!r} -5)
r1 s a {resistance}
d1 a c di
c1 c 0 {capacitance} ic=0
.model di d
.tran 1u {stop} uic
.end
"""
        at = [stop * (k + 0.37) / 200 for k in range(200)]
        exact = [10.0 * -math.expm1(-t / rc) if t < width else held for t in at]
        for tolerance in some_of(TOLERANCES):
            case = f"{left / resistance:.1e} A for {u:.1e} s, {tolerance}"
            result = start(program, checker, case, netlist, at, tolerance)
            if result is not None:
                check_signal(checker, case, result, "v(c)", exact, tolerance)
                check_times(checker, case, events(result, "d1"), [(width + u, "off")], stop,
                            tolerance)


def difference(program, checker, more=""):
    volts, small, large, capacitance = 400.0, 1e-3, 10.0, 100e-6
    netlist = f"""a current that is a small difference of voltages
v1 s 0 {volts}
r1 s c {small}
c1 c 0 {capacitance} ic={volts}
s1 c n g 0 sm
r2 n 0 {large}
vg g 0 pulse(0 1 5u 0 0 4u 10u)
{more}.model sm sw(vt=0.5)
.tran 1u 200u uic
.end
"""
    at = [(k + 0.37) * 1e-7 for k in range(2000)]
    settled = {True: volts / (small + large), False: 0.0}
    rate = {True: (1 / small + 1 / large) / capacitance, False: 1 / (small * capacitance)}
    exact = []
    current, on, since = 0.0, False, 0.0  # at the last edge, at `since`
    for t in at:
        edge = since + (4e-6 if on else 6e-6 if since > 0.0 else 5e-6)
        if edge < t:
            current = settled[on] + (current - settled[on]) * math.exp(-rate[on] * (edge - since))
            on, since = not on, edge
        exact.append(-(settled[on] + (current - settled[on]) * math.exp(-rate[on] * (t - since))))
    for tolerance in some_of(TOLERANCES):
        case = f"difference{' in a large part' if more else ''}, {tolerance}"
        result = start(program, checker, case, netlist, at, tolerance)
        if result is not None:
            check_signal(checker, case, result, "i(v1)", exact, max(tolerance, 1e-9))


def large_difference(program, checker):
    line = "".join(f"rm{k} m{k} m{k + 1} 1k\ncm{k} m{k + 1} 0 1n\n" for k in range(100))
    difference(program, checker, "em m0 0 c 0 1\n" + line)


def stray(program, checker):
    netlist = """a boost converter with a stray capacitor
v1 n1 b sin(0 9.972 50)
d2 0 n1 di
c1 b 0 49u
l1 b sw 120.3u
c2 sw 0 4.193p
v2 g1 0 pulse(0 1 0 0 0 57.1683u 100u)
s1 sw 0 g1 0 sm
d5 sw out di
c3 out 0 0.1753 ic=12.96
.model di d(ron=0.0725)
.model sm sw(vt=0.5 ron=0.0527)
.tran 60u 19.2m uic
.end
"""
    for tolerance in some_of(TOLERANCES[1:-1]):
        case = f"stray, {tolerance}"
        result = start(program, checker, case, netlist, [19e-3], tolerance)
        if result is not None:
            wrong = result.report["certificate"]["wrong_sign"]
            print(f"{case}: {len(result.report['events'])} events, wrong sign {wrong:.1e}")
            checker.check(wrong <= tolerance, f"{case}: a wrong sign of {wrong:.1e}")


def opposed(program, checker):
    netlist = """two diodes that point at each other, a large capacitor and a ring
v1 a 0 pwl(0 0 200n 10)
l1 a xa 1m
d1 xa x
d2 o x
c1 o 0 1m ic=5
r1 o 0 1k
l2 o q 1n
c2 q 0 0.01p ic=4
.tran 1n 200n uic
.end
"""
    times = [10e-9 * k for k in range(1, 20)]
    for tolerance in some_of(TOLERANCES[1:4]):
        case = f"opposed, {tolerance}"
        result = start(program, checker, case, netlist, times, tolerance)
        if result is not None:
            check_signal(checker, case, result, "v(xa)", [5e7 * t for t in times], tolerance)
            largest = max(map(abs, result.column("i(l1)")))
            checker.check(largest <= 1e-12, f"{case}: {largest:.1e} A pass the diodes")


def overtaken(program, checker):
    volts, ohms, farads, henries, other_farads, at = 10.0, 0.035, 1e-12, 3e-3, 600e-12, 1e-6
    netlist = f"""a capacitor of 1 pF passes another one, at a coil
v1 p 0 {volts}
v2 g 0 pulse(0 1 {at})
s1 p n g 0 sm
c1 n 0 {farads} ic={-volts}
d1 n x di
c2 x 0 {other_farads} ic=5
l1 x 0 {henries} ic=0
.model di d(ron=0.03)
.model sm sw(vt=0.5 ron={ohms})
.tran 10n 2u uic
.end
"""
    before = 5.0 * math.cos(at / math.sqrt(henries * other_farads))
    exact = ohms * farads * math.log(2.0 * volts / (volts - before))
    for stages, tolerance in some_of(((3, 1e-9), (3, 1e-11), (5, 1e-11), (7, 1e-9))):
        case = f"overtaken, {stages} stages, {tolerance}"
        result = run(program, netlist, at=[1.5e-6], method="radau", stages=stages, tolerance=tolerance)
        if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
            continue
        wrong = result.report["certificate"]["wrong_sign"]
        times = [time - at for time, state in events(result, "d1") if state == "on" and time >= at]
        print(f"{case}: {len(times)} events, the first after {times[:1]} s, wrong sign {wrong:.1e}")
        checker.check(wrong <= tolerance, f"{case}: a wrong sign of {wrong:.1e}")
        checker.check(times != [] and abs(times[0] - exact) <= 1e-4 * exact,
                      f"{case}: closes after {times[:1]} instead of {exact:.6e} s")


def cut_off(program, checker):
    netlist = converter_netlists.netlist(63).replace(".tran 5e-05 0.05", ".tran 5e-05 8m")
    times = [8e-3 * k / 200 for k in range(1, 200)]
    coarse, fine = (run(program, netlist, at=times, method=None, tolerance=tolerance)
                    for tolerance in (1e-6, 1e-8))
    if not checker.check(coarse.status == 0 == fine.status, f"cut_off: {coarse.stderr}{fine.stderr}"):
        return
    for name in ("i(l2)", "i(l5)", "i(l8)"):
        largest = max(map(abs, fine.column(name)))
        error = max(abs(a - b) for a, b in zip(coarse.column(name), fine.column(name))) / largest
        print(f"cut_off: {name} is off by {error:.1e}")
        checker.check(largest > 5.0 and error <= 1e-6, f"cut_off: {name}, {largest} A, is off by {error:.1e}")


def late(program, checker):
    netlist = """a boost converter with a stray capacitor, at rest
v1 n1 0 sin(0 281 60)
d1 n1 r di
l1 r sw 57.04m
c1 sw 0 0.1664n
v2 g1 0 pulse(0 1 0 0 0 201.263u 333.33333u)
s1 sw 0 g1 0 sm
.model di d(ron=0.044 vfwd=0.465)
.model sm sw(vt=0.5 ron=0.00379)
.tran 33.33u 416.665u uic
.end
"""
    for tolerance in some_of(TOLERANCES[1:]):
        case = f"late, {tolerance}"
        result = start(program, checker, case, netlist, [0.4e-3], tolerance)
        if result is not None:
            wrong = result.report["certificate"]["wrong_sign"]
            print(f"{case}: wrong sign {wrong:.1e}")
            checker.check(("has had the wrong sign" in result.stderr) == (wrong > max(1e-4, 100 * tolerance)),
                          f"{case}: a wrong sign of {wrong:.1e}, and: {result.stderr}")


def beside(program, checker):
    netlist = converter_netlists.netlist(243).replace(".tran 6e-05 0.06", ".tran 6e-05 1m")
    coarse, fine = (run(program, netlist, at=[0.9e-3], method=None, tolerance=tolerance)
                    for tolerance in (1e-6, 1e-8))
    if not checker.check(coarse.status == 0 == fine.status, f"beside: {coarse.stderr}{fine.stderr}"):
        return
    found, enough = len(coarse.report["events"]), len(fine.report["events"])
    wrong = coarse.report["certificate"]["wrong_sign"]
    print(f"beside: {found} events, {enough} at 1e-8, wrong sign {wrong:.1e}")
    checker.check(found < 4 * enough, f"beside: {found} events, {enough} at 1e-8")
    checker.check(wrong <= 1e-6, f"beside: a diode has had the wrong sign, {wrong:.1e}")
    euler_steps = coarse.report["work"]["euler_steps"]
    checker.check(euler_steps == 0, f"beside: {euler_steps} steps of implicit Euler")
    netlist = netlist.replace(".tran 6e-05 1m", ".tran 6e-05 1.2m")
    times = [0.6e-3 + 3e-6 * k for k in range(100)]
    coarse, fine = (run(program, netlist, at=times, method=None, tolerance=tolerance)
                    for tolerance in (1e-6, 1e-8))
    if checker.check(coarse.status == 0 == fine.status, f"beside: {coarse.stderr}{fine.stderr}"):
        check_signal(checker, "beside, to 1.2 ms", coarse, "v(o)", fine.column("v(o)"), 1e-6)


def spiked(program, checker):
    netlist = converter_netlists.netlist(171).replace(".tran 5e-06 0.005", ".tran 5e-06 1.6m")
    times = [1.6e-3 * k / 400 for k in range(1, 400)]
    coarse, fine = (run(program, netlist, at=times, method=None, tolerance=tolerance)
                    for tolerance in (1e-6, 1e-8))
    if checker.check(coarse.status == 0 == fine.status, f"spiked: {coarse.stderr}{fine.stderr}"):
        check_signal(checker, "spiked", coarse, "v(n14p)", fine.column("v(n14p)"), 1e-6)


def dip(program, checker):
    netlist = converter_netlists.netlist(307).replace(".tran 4.167e-05 0.041666667", ".tran 4.167e-05 1m")
    times = [1e-3 * (k + 0.37) / 200 for k in range(200)]
    result = run(program, netlist, at=times, method=None, tolerance=1e-8)
    fine = run(program, netlist, at=times, method="radau", stages=5, tolerance=1e-11)
    if checker.check(result.status == 0 == fine.status, f"dip: {result.stderr}{fine.stderr}"):
        for name in ("v(w)", "i(r7)"):
            check_signal(checker, "dip", result, name, fine.column(name), 1e-7)


def main():
    program, which = sys.argv[1:]
    checker = Checker(f"faint {which}")
    {"leak": leak, "large_leak": large_leak, "flank": flank, "difference": difference,
     "large_difference": large_difference, "stray": stray,
     "opposed": opposed, "overtaken": overtaken,
     "cut_off": cut_off, "late": late, "beside": beside, "spiked": spiked, "dip": dip}[which](program, checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
