#!/usr/bin/env python3
"""Branches of a formula that have no value where they are not chosen: constant powers, roots and logarithms behind a
condition, against closed forms, ngspice's habit of evaluating what is chosen alone. Roots that begin at 0, where they are steep
without bound, and operating points that Newton's method does not find from nothing.

usage: guarded.py PROGRAM
"""

import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402
from logic import run_cards, runs  # noqa: E402


def functions(checker, program):
    """Of a ramp through 0, at scales from microvolts to kilovolts; both directions, nested, in user functions and subcircuits."""
    for s in (1, 1e-3, 600):
        cases = (
            (f"if(v(x) < {0.5 * s!r}, 0, sqrt(v(x)))", lambda x: 0 if x < 0.5 * s else math.sqrt(x)),
            (f"v(x) > {0.1 * s!r} && v(x) < {10 * s!r} ? ln(v(x)) : -1", lambda x: math.log(x) if 0.1 * s < x < 10 * s else -1),
            (f"v(x) < {-0.5 * s!r} ? 1/v(x) : 3", lambda x: 1 / x if x < -0.5 * s else 3),
            (f"!(v(x) <= {0.25 * s!r}) ? v(x)**0.5 : (v(x) > {-s!r} ? 7 : 2/v(x))", lambda x: math.sqrt(x) if x > 0.25 * s else 7 if x > -s else 2 / x),
            (f"{0.3 * s!r} <= v(x) ? pow(v(x), 1.5) : v(x)", lambda x: x ** 1.5 if x >= 0.3 * s else x),
            (f"{-0.2 * s!r} > v(x) ? {-5 * s * s!r}/v(x) : !({0.4 * s!r} >= v(x) || v(x) < 0) ? log10(v(x)) : 0",
             lambda x: -5 * s * s / x if x < -0.2 * s else math.log10(x) if x > 0.4 * s else 0),
            (f"inverse(v(x), {0.2 * s!r})", lambda x: 1 / x if x > 0.2 * s else 5 / s),
            (f"if(v(x) >= {0.5 * s!r}, 1/v(x) + sqrt(v(x))*v(x), 1/(v(x) - {3 * s!r}))",
             lambda x: 1 / x + x ** 1.5 if x >= 0.5 * s else 1 / (x - 3 * s)))
        for form, wanted in cases:
            done = run_cards(program, form, [
                f"v1 x 0 pwl(0 {-2 * s!r} 1 {2 * s!r})", ".func inverse(a,b) {if(a > b, 1/a, 1/b)}", ".subckt part x o", f"b1 o 0 v={form}", "r1 o 0 1", ".ends",
                f"b1 o 0 v={form}", "r1 o 0 1", "x1 x p part", ".tran 0.013 1"])
            if not runs(checker, done, form):
                continue
            largest = max(abs(wanted(x)) for x in done.column("v(x)"))
            for x, o, p in zip(*(done.column(f"v({n})") for n in "xop")):
                if min(abs(x - c * s) for c in (-1, -0.5, -0.2, 0, 0.1, 0.2, 0.25, 0.3, 0.4, 0.5)) > 1e-6 * s:
                    checker.close(o, wanted(x), 1e-6 * largest, f"{form} at {x} V")
                    checker.close(p, wanted(x), 1e-6 * largest, f"{form} in a subcircuit at {x} V")


def loads(checker, program):
    """Constant powers that begin at 0 V, where p/v would be without end: their operating points and what they charge."""
    for volts, watts, ohms, least in ((24, 60, 0.1, 6), (400, 3000, 1, 50), (3.3, 1, 0.2, 1)):
        root = 0.5 * (volts + math.sqrt(volts * volts - 4 * watts * ohms))
        for form in (f"b1 o 0 i=if(v(o) > {least}, {watts}/v(o), 0)", f"g1 o 0 value={{v(o) < {least} ? v(o)*{watts / least ** 2!r} : {watts}/v(o)}}"):
            done = run_cards(program, form, [f"v1 i 0 pulse(0 {volts} 1u 0 0 1 2)", f"rs i o {ohms}", "c1 o 0 100u", form, ".tran 10u 10m"])
            if runs(checker, done, form):
                checker.close(done.column("v(o)")[-1], root, 1e-6 * volts, f"{form}: it ends at")
                checker.close(done.column("v(o)")[0], 0, 1e-9, f"{form}: it begins at")
    # C v v' = (volts - v)/ohms v - watts from `least` on
    done = run_cards(program, "its course", ["i1 0 o 1", "c1 o 0 1m", "b1 o 0 i=if(v(o) > 2, 1/v(o), 0)", ".ic v(o)=0", ".tran 10u 10m uic"])
    if runs(checker, done, "a course"):
        for t, v in zip(done.time, done.column("v(o)")):
            if t > 2.1e-3:  # v - 2 + ln(v - 1) = (t - 2 ms)/1 ms
                checker.close(v - 2 + math.log(v - 1), (t - 2e-3) / 1e-3, 1e-5, f"a course at {t}")
            elif t < 2e-3:
                checker.close(v, t / 1e-3, 1e-6, f"before at {t}")


def roots(checker, program):
    """Of what begins at 0 and grows as t^2 and t^3."""
    for name, cards, wanted in (
            ("of a charge", ["i1 0 x pwl(0 0 1n 1m)", "c1 x 0 1u", "b1 y 0 v=2*sqrt(v(x))"], lambda t: 2 * math.sqrt(1e3 * (t - 5e-10)) if t > 1e-9 else None),
            ("of a filtered square", ["v1 s 0 pwl(0 0 1m 1)", "b1 a 0 v=v(s)**2", "r1 a x 1meg", "c1 x 0 1u", "v2 one 0 1", "b2 y 0 v=100*sqrt(v(x)/v(one))"],
             lambda t: 1e5 * math.sqrt(t ** 3 * (1 / 3 - t / 12 + t * t / 60)))):
        done = run_cards(program, name, [*cards, "rl y 0 1k", ".tran 10u 1m"])
        if runs(checker, done, name):
            largest = max(abs(y) for y in done.column("v(y)"))
            for t, y in zip(done.time, done.column("v(y)")):
                if wanted(t) is not None:
                    checker.close(y, wanted(t), 1e-6 * largest, f"{name} at {t} s")


def averaged_buck(vin, ohms, gain, coil, volts):
    """v(out) of a buck with Vorperian's averaged switch and a regulator, by two nested bisections."""
    def bisect(f, low, high):
        for _ in range(200):
            low, high = (0.5 * (low + high), high) if f(0.5 * (low + high)) < 0 else (low, 0.5 * (low + high))
        return 0.5 * (low + high)

    def out(duty):
        def of(m):
            current = m * vin / (ohms + 0.011)
            return current, min(max(2 * coil * 1e5 * current / (duty * vin * (1 - m) + 1e-6) - duty, 0.05), 1 - duty)
        return of(bisect(lambda m: m * (duty + of(m)[1]) - duty, 0, 1))[0] * ohms
    return out(bisect(lambda d: d - min(max(gain * (2.5 - 2.5 / volts * out(d)), 0.05), 0.95), 0.05, 0.95))


def averaged(checker, program):
    """Operating points of averaged converters at all loads, where steps of Newton's method go around in a circle: functions that
    count more and more lead there."""
    draw = random.Random(5)
    for k in range(40):
        vin, ohms = draw.choice((5, 12, 48, 400)), draw.choice((0.5, 5, 50, 500, 5000))
        volts, gain, coil = vin * draw.uniform(0.15, 0.85), 10 ** draw.uniform(1, 4.5), 10 ** draw.uniform(-6, -3)
        name = f"averaged {k}: {vin} V, {ohms} ohm, {gain}, {coil} H, {volts} V"
        done = run_cards(program, name, [
            f"v1 in 0 {vin}", "xs in sw 0 d pwm", f"l1 sw out {coil!r} rser=10m", "c1 out 0 220u", f"r1 out 0 {ohms}", f"e4 fb 0 out 0 {2.5 / volts!r}",
            f"g1 0 amp ref fb {gain * 1e-4!r}", "v2 ref 0 2.5", "r4 amp 0 10k", "c2 amp 0 1u", "e5 d 0 value={limit(v(amp),0.04,4.9)}", ".subckt pwm a c p d",
            "ga a p value={v(dc)/(v(dc)+v(dpc))*i(vs)}", "ec cx p value={v(dc)/(v(dc)+v(dpc))*v(a,p)}", "ra a p 1g", "rd d 0 1g", "ro c cz 1m", "vs cx cz 0",
            f"e1 dp 0 value={{2*{coil!r}*100k*i(vs)/(v(dc)*v(a,cx)+1u)-v(dc)}}", "e2 dc 0 value={limit(v(d),0.05,0.95)}",
            "e3 dpc 0 value={limit(v(dp),0.05,1-v(dc))}", ".ends", ".tran 1u 1u"])
        if runs(checker, done, name):
            checker.close(done.column("v(out)")[0], averaged_buck(vin, ohms, gain, coil, volts), 1e-9 * vin, name)


SIGNED = ("sgn(v(a))*{k}*abs(v(a))**{p}", "{k}*sgn(2*v(a))*pow(abs(v(a)),{p})", "if(v(a)>0,{k}*pow(v(a),{p}),-{k}*pow(-v(a),{p}))",
          "v(a)<0 ? -{k}*(-v(a))**{p} : {k}*v(a)**{p}", "{k}*pwrs(v(a),{p})", "0 <= v(a) ? {k}*abs(v(a))**{p} : -({k}*abs(v(a))**{p})", "pwr({k}**(1/{p})*v(a),{p})*sgn(v(a))")
ROOTS = ("{k}*sgn(v(a))*sqrt(abs(v(a)))", "-sgn(-v(a))*sqrt({k}*{k}*abs(v(a)))", "if(v(a)>=0,{k}*sqrt(v(a)),-{k}*sqrt(-v(a)))")
ABOVE = ("v(a)*{k}*sqrt(abs(v(a)))", "-{k}*abs(-v(a))**0.5*v(a)*(-1)")


def signed_powers(checker, program):
    """Roots and powers with the sign of what they are of, as flow through an orifice is written: behind a resistance, and
    from a current."""
    for volts, k, ohms, power in ((10, 0.05, 10, 0.5), (1e3, 2e-3, 470, 0.5), (5, 0.3, 1, 1.5), (0.1, 4, 0.02, 0.7)):
        for form in SIGNED + (ROOTS if power == 0.5 else ABOVE if power == 1.5 else ()):
            law = form.format(k=k, p=power)
            done = run_cards(program, law, [f"v1 in 0 sin(0 {volts} 50)", f"r1 in a {ohms}", f"b1 a 0 i={law}", f"i2 0 b sin(0 {volts / ohms!r} 50)",
                                            f"b2 b 0 i={law.replace('v(a)', 'v(b)')}", ".tran 0.37m 19m"])
            if runs(checker, done, law):
                for v, out, b in zip(*(done.column(n) for n in ("v(in)", "v(a)", "v(b)"))):
                    checker.close(out + ohms * k * math.copysign(abs(out) ** power, out), v, 1e-8 * volts, f"{law} at {v} V")
                    checker.close(ohms * k * math.copysign(abs(b) ** power, b), v, 1e-8 * volts, f"{law} of a current, at {v} V")


def odd(x, power):
    return math.copysign(abs(x) ** power, x)


def through_zero(checker, program):
    """Roots whose argument passes 0, where they are steep without bound: of a voltage, of their own current, in series, and
    beside a smooth function; in volts and amperes from 1e-6 to 1e4. What is read has to make the currents agree."""
    for volts, ohms, power in ((1, 10, 0.3), (5, 1e3, 0.5), (1e4, 0.1, 0.2), (1e-6, 1e5, 0.7), (20, 3, 1 / 3)):
        k = 0.3 * volts / ohms / volts ** power  # of 1 A in proportion
        of_amps = 0.2 * volts / (volts / ohms) ** power
        root = "cbrt({x})" if power == 1 / 3 else f"pwrs({{x}},{power})"
        cases = (
            ("of a voltage", [f"b1 a 0 i={k!r}*{root.format(x='v(a)')}"], lambda v, a, b: (v - a) / ohms - k * odd(a, power)),
            ("of its current", [f"b1 a 0 v={of_amps!r}*{root.format(x='i(b1)')}"], lambda v, a, b: (a - of_amps * odd((v - a) / ohms, power)) / ohms),
            ("in series", [f"b1 a b i={k!r}*{root.format(x='v(a,b)')}", f"b2 b 0 i={k!r}*pwrs(v(b),0.4)"],
             lambda v, a, b: max(abs((v - a) / ohms - k * odd(a - b, power)), abs((v - a) / ohms - k * odd(b, 0.4)))),
            ("beside a smooth one", [f"b1 a 0 i={k!r}*{root.format(x='v(a)')} + {k!r}*tanh(v(a)/{volts})"],
             lambda v, a, b: (v - a) / ohms - k * odd(a, power) - k * math.tanh(a / volts)))
        for name, cards, off in cases:
            name = f"{name}, of {volts} V to the {power}"
            netlist = "\n".join([name, f"v1 in 0 sin(0 {volts} 50)", f"r1 in a {ohms}", *cards, ".tran 0.37m 39m", ".end", ""])
            done = run(program, netlist, method=None, tolerance=1e-10, report=False)
            if runs(checker, done, name):
                b_of = done.column("v(b)" if name.startswith("in series") else "v(a)")
                for t, v, a, b in zip(done.time, done.column("v(in)"), done.column("v(a)"), b_of):
                    checker.close(off(v, a, b), 0, 1e-7 * volts / ohms, f"{name}, at {t} s")


def coming_to_rest(checker, program):
    """x' = -k x^p is at rest after a finite time, and stays there: y = x^(1 - p) falls as a straight line."""
    for start, k, store, power in ((4, 0.5, 1e-3, 0.5), (1e3, 0.02, 1e-6, 0.3), (1e-3, 1, 0.1, 0.8), (-12, 3, 2e-5, 1 / 3)):
        rest = abs(start) ** (1 - power) * store / (k * (1 - power))
        for name, cards, column in (("of a capacitor", [f"c1 a 0 {store} ic={start}", f"b1 a 0 i={k}*pwrs(v(a),{power!r})"], "v(a)"),
                                    ("of a coil", [f"l1 a 0 {store} ic={start}", f"b1 0 a v={k}*pwrs(i(l1),{power!r})"], "i(l1)")):
            name = f"rest {name} from {start}, power {power}"
            done = run_cards(program, name, [*cards, f".tran {rest / 37!r} {1.5 * rest!r} uic"])
            if runs(checker, done, name):
                for t, x in zip(done.time, done.column(column)):
                    left = max(1 - t / rest, 0) ** (1 / (1 - power))
                    checker.close(x, start * left, 1e-5 * abs(start), f"{name}, at {t} s")


def growing(checker, program):
    """An exponential that grows without end where it is not chosen is no part of what is."""
    for s in (1, 1e-3, 40):
        for form, wanted in ((f"if(v(x)>0,1-exp(-v(x)/{s}),exp(v(x)/{s})-1)", lambda x: math.copysign(-math.expm1(-abs(x)), x)),
                             (f"v(x)-{s} < 0 ? exp((v(x)+{s})/{s}) : 7", lambda x: math.exp(x + 1) if x < 1 else 7),
                             (f"if(v(x)<{0.5 * s},sinh(v(x)/{s}/8),2)", lambda x: math.sinh(x / 8) if x < 0.5 else 2)):
            done = run_cards(program, form, [f"v1 x 0 pwl(0 {-80 * s} 1 {80 * s})", f"b1 o 0 v={form}", "r1 o 0 1", ".tran 0.0131 1"])
            if runs(checker, done, form):
                largest = max(abs(wanted(x / s)) for x in done.column("v(x)"))
                for x, o in zip(done.column("v(x)"), done.column("v(o)")):
                    if min(abs(x / s - c) for c in (0, 0.5, 1)) > 1e-6:
                        checker.close(o, wanted(x / s), 1e-9 * largest, f"{form} at {x} V")


def still_wrong(checker, program):
    """What a condition does not exclude is said as before."""
    for form in ("1/v(x)", "if(v(x) > -1, 1/v(x), 0)", "if(v(y) > 1, 1/v(x), 0)", "if(v(x) > 0, 0, sqrt(v(x)))"):
        done = run_cards(program, form, ["v1 x 0 pwl(0 0 1 -2)", "v2 y 0 2", f"b1 o 0 v={form}", "r1 o 0 1", ".tran 0.1 1"])
        checker.check(done.status == 1 and "finds no value" in done.stderr, f"{form}: {done.status} {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("guarded")
    for part in (functions, loads, roots, averaged, signed_powers, through_zero, coming_to_rest, growing, still_wrong):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
