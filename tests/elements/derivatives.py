#!/usr/bin/env python3
"""ddt(), idt(), sdt() and idtmod() in formulas, currents by a table of their own voltage, and gt0() and its like: against closed
forms, in circuits of unlike scales and topologies; what is refused, with its place.

usage: derivatives.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402
from logic import run_cards, runs  # noqa: E402


def compare(checker, program, what, cards, wanted, digits=1e-7):
    """wanted: by signal, a function of time and its largest value."""
    done = run_cards(program, what, cards)
    if not runs(checker, done, what):
        return
    for name, (f, scale) in wanted.items():
        for t, found in zip(done.time, done.column(name)):
            checker.close(found, f(t), digits * scale, f"{what}: {name} at {t}")


def of_sources(checker, program):
    """Of a sine, a ramp and numbers, from nanoseconds to hours; nested, in products and with the sign turned."""
    for f, v in ((50, 325), (1e8, 1e-3), (1e-4, 12), (2e3, 5)):
        w = 2 * math.pi * f
        end = 2 / f
        compare(checker, program, f"a sine of {v} V at {f} Hz", [
            f"v1 a 0 sin(0 {v!r} {f!r})", f"b1 d 0 v={1 / w!r}*ddt(v(a))", f"b2 i 0 v={w!r}*idt(v(a))", f"b3 j 0 v=-{w!r}*idt(2*v(a), {v / w!r})",
            f"b4 k 0 v={w * w!r}*sdt(idt(v(a)))", f"b5 m 0 v=ddt(v(a)*v(a))*{1 / (w * v)!r}", f"b6 n 0 v={f!r}*idt(1)*v(a)",
            *(f"r{x} {x} 0 1k" for x in "dijkmn"), f".tran {end / 100!r} {end!r}"], {
                "v(d)": (lambda t: v * math.cos(w * t), v), "v(i)": (lambda t: v * (1 - math.cos(w * t)), v),
                "v(j)": (lambda t: -v - 2 * v * (1 - math.cos(w * t)), 5 * v), "v(k)": (lambda t: v * (w * t - math.sin(w * t)), 13 * v),
                "v(m)": (lambda t: v * math.sin(2 * w * t), v), "v(n)": (lambda t: f * t * v * math.sin(w * t), 2 * v)}, 1e-6)


def tight(checker, program):
    """At tolerances near what steps on factors are rounded to, states are off by so much that derivatives show it, the more
    the shorter the step. They are put where they belong, and steps are long again, where they once became steps of Euler."""
    for f, v in ((61, 325), (2e3, 5), (1e-3, 3)):
        w = 2 * math.pi * f
        for tolerance in (3e-11, 5e-11, 1e-10):
            cards = [f"v1 a 0 sin(0 {v!r} {f!r})", f"b1 d 0 v={1 / w!r}*ddt(v(a))", f"b2 i 0 v={w!r}*idt(v(a))",
                     f"b3 j 0 v=-{w!r}*idt(2*v(a), {v / w!r})", f"b4 k 0 v={w * w!r}*sdt(idt(v(a)))", f"b5 m 0 v=ddt(v(a)*v(a))*{1 / (w * v)!r}",
                     f"b6 n 0 v={f!r}*idt(1)*v(a)", *(f"r{x} {x} 0 1k" for x in "dijkmn"), f".tran {0.02 / f!r} {2 / f!r}"]
            what = f"a sine of {v} V at {f} Hz, {tolerance}"
            done = run(program, "\n".join([what, *cards, ".end", ""]), method=None, tolerance=tolerance)
            if runs(checker, done, what):
                checker.check(done.report["work"]["euler_steps"] == 0, f"{what}: {done.report['work']['euler_steps']} steps of Euler")
                for t, found in zip(done.time, done.column("v(d)")):
                    checker.close(found, v * math.cos(w * t), 1e-9 * v, f"{what}: the derivative at {t}")


def of_circuits(checker, program):
    """A capacitor and a coil written as formulas beside true ones; a controller; a motor's inertia; what a diode passes."""
    for c, r, v in ((1e-6, 1e3, 10), (1e-12, 50, 1e-3), (0.1, 1e-2, 400)):
        tau = r * c
        compare(checker, program, f"a capacitor of {c} F by its law", [
            f"v1 a 0 {v!r}", f"r1 a b {r!r}", f"b1 b 0 i={c!r}*ddt(v(b))", ".ic v(b)=0", f".tran {tau / 20!r} {5 * tau!r} uic"],
                {"v(b)": (lambda t: v * (1 - math.exp(-t / tau)), v)}, 1e-6)
        compare(checker, program, f"its voltage from its current, {c} F", [
            f"v1 a 0 {v!r}", f"r1 a b {r!r}", f"b1 b 0 v={1 / c!r}*idt(i(b1))", f".tran {tau / 20!r} {5 * tau!r}"],
                {"v(b)": (lambda t: v * (1 - math.exp(-t / tau)), v)}, 1e-6)
        ell = r * tau
        compare(checker, program, f"a coil of {ell} H by its law", [
            f"v1 a 0 pulse(0 {v!r} 0 0 0 1e9 2e9)", f"r1 a b {r!r}", f"b1 b 0 i=idt(v(b))/{ell!r}", f".tran {tau / 20!r} {5 * tau!r}"],
                {"i(v1)": (lambda t: -v / r * (1 - math.exp(-t / tau)) if t > 0 else 0, v / r)}, 1e-5)
    # speed' = (torque - load)/J with a PI controller: w'' + kp w' + ki w = ki, from rest; critically damped
    compare(checker, program, "a speed under a PI controller", [
        "b1 w 0 v=idt(v(u))", "b2 u 0 v=2*(1-v(w)) + idt(1-v(w)) - 0", "r1 u 0 1", "r2 w 0 1", ".tran 0.1 10"],
            {"v(w)": (lambda t: 1 - math.exp(-t) * (1 - t), 1.2)}, 1e-6)
    compare(checker, program, "charge through a diode", [
        "v1 a 0 sin(0 10 50)", "d1 a b", "r1 b 0 10", "b1 q 0 v=idt(i(d1))", "r2 q 0 1", ".tran 0.1m 40m"],
            {"v(q)": (lambda t: (int(t * 50) * 2 + (1 - math.cos(2 * math.pi * min(t * 50 % 1, 0.5)))) / (100 * math.pi)
                      if abs(t * 50 - round(t * 50)) > 1e-9 else round(t * 50) / (50 * math.pi), 2e-2)}, 1e-6)


def resets(checker, program):
    """A saw from a reset, by a source, by itself, and from another start."""
    done = run_cards(program, "a reset by a source", [
        "v1 r 0 pulse(0 1 0.7m 0 0 0.1m 1m)", "b1 s 0 v=sdt(1000, 0.25, v(r) > 0.5)", "r1 s 0 1", ".tran 10u 3.65m"])
    if runs(checker, done, "a reset by a source"):
        for t, found in zip(done.time, done.column("v(s)")):
            since = (t - 0.7e-3) % 1e-3
            if min(since, abs(since - 0.1e-3), 1e-3 - since) > 1e-9:  # at the edges it has both values
                checker.close(found, 0.25 + (1000 * t if t < 0.7e-3 else 0 if since < 0.1e-3 else 1000 * (since - 0.1e-3)), 1e-7, f"a saw at {t}")
    done = run_cards(program, "nested in a subcircuit", [
        "v1 a 0 2", ".subckt ramp i o k=1", "b1 o 0 v=k*idt(v(i))", "r1 o 0 1", ".ends", "x1 a p ramp k=3", "x2 a q ramp k=-1", ".tran 1 4"])
    if runs(checker, done, "in subcircuits"):
        checker.close(done.at("v(p)", 4), 24, 1e-7, "three times")
        checker.close(done.at("v(q)", 4), -8, 1e-7, "backwards")
    done = run_cards(program, "at rest", ["v1 a 0 2", "r1 a b 1k", "c1 b 0 1u", "b1 d 0 v=ddt(v(b))", "b2 i 0 v=idt(v(b)-2, 3)", "r2 d 0 1", "r3 i 0 1",
                                          ".tran 1m 10m"])
    if runs(checker, done, "an operating point"):
        checker.close(max(map(abs, done.column("v(d)"))), 0, 1e-9, "nothing moves")
        checker.close(min(done.column("v(i)")), 3, 1e-9, "nothing is integrated")


def samples(checker, program):
    """What an integral begins at varies: a signal that a condition samples and that is held, with a drift or none, and a first value."""
    for volts, hertz in ((2, 1e3), (5e3, 1), (1e-3, 1e6)):
        t0, w = 1 / hertz, 2 * math.pi * hertz
        done = run_cards(program, "samples", [
            f"v1 x 0 sin({0.5 * volts!r} {volts!r} {hertz!r})", f"vc c 0 pulse(0 1 {0.1 * t0!r} 0 0 {0.02 * t0!r} {0.25 * t0!r})", "b1 h 0 v=idt(0,v(x),v(c)>0.5)",
            f"b2 k 0 v=idt({volts * hertz!r},v(x)+{volts!r},v(c)>0.5)", f"b3 m 0 v={hertz!r}*sdt(v(x),2*v(x)/{hertz!r})", *(f"r{n} {n} 0 1k" for n in "hkm"),
            f".tran {t0 / 200!r} {t0!r}"])
        if not runs(checker, done, "samples"):
            continue

        def of(t, volts=volts, w=w):
            return volts * (0.5 + math.sin(w * t))
        for t, h, k, m in zip(done.time, *(done.column(f"v({n})") for n in "hkm")):
            turns = (t / t0 - 0.1) / 0.25
            since = (turns - math.floor(turns)) * 0.25
            if min(since, abs(since - 0.02), 0.25 - since) < 1e-6:
                continue
            last = 0.0 if turns < 0 else min(t, (0.1 + 0.25 * math.floor(turns) + 0.02) * t0)
            checker.close(h, of(last), 1e-7 * volts, f"samples at {t}")
            checker.close(k, of(last) + volts + volts * (t - last) / t0, 1e-7 * volts, f"samples that drift at {t}")
            checker.close(m, 2 * of(0) + volts * hertz * (0.5 * t + (1 - math.cos(w * t)) / w), 1e-7 * volts, f"a first value at {t}")


def wraps(checker, program):
    """idtmod() of numbers, ramps and sines that turn back, over scales; what it wraps to is never beyond its ends."""
    for rate, first, modulus, offset in ((500, 0.25, 1, 0), (-3e6, 0.1, 360, -180), (0.02, 5, 2, 7), (0, 1.5, 1, 0)):
        end = 7.3 * modulus / max(abs(rate), 1)
        wrapped_is(checker, program, f"a number, {rate}", [f"b1 o 0 v=idtmod({rate!r}, {first!r}, {modulus!r}, {offset!r})"],
                   lambda t: first + rate * t, (modulus, offset), end)  # noqa: B023
    for volts, hertz, first, modulus in ((1000, 100, 0.2, 0.7), (-1000, 100, 0.2, 0.7), (5, 0.01, 0, 3), (-2e9, 1e6, 1.5, 2), (300, 50, 0.9, 1)):
        w = 2 * math.pi * hertz
        wrapped_is(checker, program, f"a sine of {volts} at {hertz} Hz", [
            f"v1 x 0 sin(0 {volts!r} {hertz!r})", f"b1 o 0 v=idtmod(v(x), {first!r}, {modulus!r})"],
                   lambda t: first + volts / w * (1 - math.cos(w * t)), (modulus, 0), 2.2 / hertz)  # noqa: B023
    wrapped_is(checker, program, "a frequency that rises, inside of a product", [
        "v1 f 0 pwl(0 0 1m 1k)", "b1 p 0 v=2*idtmod(v(f)*100, 0, 1) - 0.5*0", "r2 p 0 1", "b2 o 0 v=v(p)/2"],
               lambda t: 100 * 1e6 * t * t / 2, (1, 0), 1e-3)
    for arguments, wanted in (("v(x)", lambda t: 4 * t), ("v(x), 3", lambda t: 3 + 4 * t)):
        compare(checker, program, f"idtmod({arguments}) is idt", ["v1 x 0 4", f"b1 o 0 v=idtmod({arguments})", "r1 o 0 1", ".tran 0.1 1"],
                {"v(o)": (wanted, 4)})
    done = run_cards(program, "at an operating point", ["v1 x 0 1", "b1 o 0 v=idtmod(v(x), 5.25, 2, 1)", "r1 o 0 1", ".op"])
    if runs(checker, done, "at an operating point"):
        checker.close(done.column("v(o)")[-1], 2.25, 1e-12, "at an operating point it is where it begins")
    for arguments, text in (("v(x),0,0", "the modulus of 'idtmod' must be above 0"), ("v(x),0,v(x)", "the modulus of 'idtmod' must be a number"),
                            ("v(x),0,1,v(x)", "the offset of 'idtmod' must be a number"), ("v(x),0,1,0,0", "another number of arguments")):
        done = run_cards(program, arguments, ["v1 x 0 1", f"b1 o 0 v=idtmod({arguments})", "r1 o 0 1", ".tran 1 2"])
        checker.check(done.status == 3 and text in done.stderr, f"{arguments}: {done.stderr}")


def wrapped_is(checker, program, what, cards, integral, wrap, end):
    """At 200 rows and at both sides of each jump; where it wraps either side is right."""
    modulus, offset = wrap
    done = run_cards(program, what, [*cards, "r1 o 0 1", f".tran {end / 200!r} {end!r}", ".save v(o)"])
    if runs(checker, done, what):
        for t, found in zip(done.time, done.column("v(o)")):
            apart = (found - offset - integral(t) + modulus / 2) % modulus - modulus / 2
            checker.close(apart, 0, 1e-8 * modulus, f"{what}: at {t}")
            checker.check(-1e-8 * modulus <= found - offset <= modulus * (1 + 1e-8), f"{what}: {found} at {t} is beyond its ends")


def tables(checker, program):
    """A current by a table of its own voltage, in both spellings, with units and m= around it; what gt0 and its like compare."""
    for scale, f in ((1, 50), (1e-3, 1e6), (1e3, 2)):
        def line(x):
            return -0.5 if x < -1 else 0.5 * x if x < 0 else 2 * x if x < 1 else 2 + 3 * (x - 1) if x < 2 else 5
        points = ", ".join(f"{x * scale!r},{y!r}" for x, y in ((-1, -0.5), (0, 0), (1, 2), (2, 5)))
        compare(checker, program, f"tables at {scale} V", [
            f"v1 a 0 sin(0 {3 * scale!r} {f!r})", f"i1 a 0 TBL=({points})", f"i2 a 0 table({points})", ".subckt two x y", f"i1 x y tbl {points}", ".ends",
            "x1 a 0 two m=2", "v2 a b 0", "r1 b 0 1e9", f"b1 c 0 v=tbl(v(a), {points})", "r2 c 0 1",
            f".save i(i1) i(i2) i(x1.i1) v(c) v(a)", f".tran {0.01 / f!r} {1 / f!r}"], {
                "i(i1)": (lambda t: line(3 * math.sin(2 * math.pi * f * t)), 5), "i(i2)": (lambda t: line(3 * math.sin(2 * math.pi * f * t)), 5),
                "i(x1.i1)": (lambda t: 2 * line(3 * math.sin(2 * math.pi * f * t)), 10), "v(c)": (lambda t: line(3 * math.sin(2 * math.pi * f * t)), 5)})
    done = run_cards(program, "comparisons", [
        "v1 a 0 pwl(0 -1 1 1)", "b1 g 0 v=gt0(v(a))", "b2 l 0 v=lt0(v(a))", "b3 h 0 v=ge0(v(a))", "b4 k 0 v=le0(v(a))", "b5 z 0 v=ge0(v(0))+le0(0)+eq0(0)+ne0(0)",
        *(f"r{x} {x} 0 1" for x in "glhkz"), ".tran 0.25 1"])
    if runs(checker, done, "comparisons"):
        for name, before, after in (("g", 0, 1), ("l", 1, 0), ("h", 0, 1), ("k", 1, 0), ("z", 3, 3)):
            checker.close(done.at(f"v({name})", 0.25), before, 1e-12, f"{name} below 0")
            checker.close(done.at(f"v({name})", 0.75), after, 1e-12, f"{name} above 0")


def refused(checker, program):
    for card, text in (("b1 o 0 v=ddt(v(a),1)", "number of arguments"), ("b1 o 0 v=idt()", "number of arguments"),
                       ("b1 o 0 v=idtmod(v(a),v(b))", "the initial value of"),
                       ("c1 o 0 q=ddt(x)", "B, E and G"), ("b1 o 0 v=eq0(v(a))", "single points"), ("i1 o 0 tbl=(1,1,0,2)", "must ascend"),
                       ("i1 o 0 tbl=(1,1,2)", "the y of a point"), (".param p={ddt(3)}", "is not a number"),
                       ("b1 o 0 v=v(a) laplace(exp(s))", "before its cause"), ("b1 o 0 v=v(a) laplace=sqrt(s)", "transfer function")):
        done = run_cards(program, card, ["v1 a 0 1", "v2 b 0 1", card, "r1 o 0 1", ".tran 1 2"])
        checker.check(done.status == 3 and text in done.stderr and ":4:" in done.stderr, f"{card}: {done.stderr}")
    done = run_cards(program, "no equal sign", ["v1 a 0 1", "b1 o 0 v=v(a)  LAPLACE(1/(1+s*1m))", "b2 p 0 v=2*v(a) laplace 1/(1+s*1m)", "r1 o 0 1", "r2 p 0 1",
                                               ".tran 1m 5m uic"])
    if runs(checker, done, "LAPLACE without an equal sign"):
        checker.close(done.at("v(o)", 1e-3), 1 - math.exp(-1), 1e-6, "a low pass")
        checker.close(done.at("v(p)", 1e-3), 2 - 2 * math.exp(-1), 1e-6, "a low pass of twice as much")
    # parts of formulas take no room that was counted for the comparators of gates
    done = run_cards(program, "gates beside formulas", [
        "v1 a 0 pwl(0 -6 1 6 2 -6)", "a1 a 0 0 0 0 0 o 0 SCHMITT vt=0 vh=5", "b1 n 0 v=if(v(a)>4,3,if(v(a)<-4,2,v(m)))", "r1 n m 1", "c1 m 0 1n",
        "b2 0 p i=if(v(a)>2,5,if(v(a)<-2,4,v(p)))", "c2 p 0 1n Rpar=1", "r2 o 0 1", ".tran 2"])
    if runs(checker, done, "gates beside formulas"):
        checker.close(done.at("v(o)", 1), 1, 1e-12, "the gate")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("derivatives")
    for part in (of_sources, tight, of_circuits, resets, samples, wraps, tables, refused):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
