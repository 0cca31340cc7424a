#!/usr/bin/env python3
"""Products and smooth functions in formulas: equations whose solutions are known, each at several scales of voltage,
impedance and time, audited in full.

usage: smooth.py PROGRAM auto|lobatto [N]
"""

import math
import pathlib
import random
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, kinds_of, run, some_of  # noqa: E402

EXACT = 2e-8


def states(rates, starts, volts=1.0, farads=1.0, seconds=1.0, extra=""):
    """Capacitors whose voltage x volts obeys dx/dt = rate(x) / seconds. In a rate {x} is state x, {t} is time, both
    without a unit."""
    lines = []
    for name, start in starts.items():
        lines.append(f"c{name} {name} 0 {farads!r} ic={start * volts!r}")
    for name, rate in rates.items():
        read = {other: f"(v({other})/{volts!r})" for other in starts}
        text = rate.format(t=f"(time/{seconds!r})", **read)
        lines.append(f"b{name} 0 {name} i={farads * volts / seconds!r}*({text})")
    return "\n".join(lines) + extra


# rates, starts, stop, the solution
EQUATIONS = {
    "logistic": ({"x": "{x}*(1-{x})"}, {"x": 0.1}, 12, lambda t: {"x": 1 / (1 + 9 * math.exp(-t))}),
    "a cube": ({"x": "-{x}**3"}, {"x": 2.0}, 20, lambda t: {"x": 2 / math.sqrt(1 + 8 * t)}),
    "a tangent": ({"x": "1+{x}*{x}"}, {"x": 0.0}, 1.5, lambda t: {"x": math.tan(t)}),
    "a logarithm": ({"x": "exp(-{x})"}, {"x": 0.0}, 50, lambda t: {"x": math.log1p(t)}),
    "a bell": ({"x": "-2*{t}*{x}"}, {"x": 1.0}, 3, lambda t: {"x": math.exp(-t * t)}),
    "a quotient": ({"x": "{x}/(1+{t})"}, {"x": 1.0}, 9, lambda t: {"x": 1 + t}),
    "a root": ({"x": "2*sqrt({x})"}, {"x": 1.0}, 9, lambda t: {"x": (1 + t) ** 2}),
    "Gudermann": ({"x": "cos({x})"}, {"x": 0.0}, 8, lambda t: {"x": 2 * math.atan(math.tanh(t / 2))}),
    "an overturned pendulum": ({"x": "{y}", "y": "-sin({x})"}, {"x": 0.0, "y": 2.0}, 6,
                               lambda t: {"x": 2 * math.atan(math.sinh(t)), "y": 2 / math.cosh(t)}),
    "a circle about a sun": ({"x": "{p}", "y": "{q}", "p": "-{x}/pow({x}*{x}+{y}*{y},1.5)",
                              "q": "-{y}/pow({x}*{x}+{y}*{y},1.5)"}, {"x": 1.0, "y": 0.0, "p": 0.0, "q": 1.0}, 13,
                             lambda t: {"x": math.cos(t), "y": math.sin(t)}),
    "a limit cycle": ({"x": "{x}-{y}-{x}*({x}**2+{y}**2)", "y": "{x}+{y}-{y}*({x}**2+{y}**2)"},
                      {"x": 0.1, "y": 0.0}, 15,
                      lambda t: {"x": math.cos(t) / math.sqrt(1 + 99 * math.exp(-2 * t)),
                                 "y": math.sin(t) / math.sqrt(1 + 99 * math.exp(-2 * t))}),
    "a function of a function": ({"x": "exp(-log(1+{x}*{x})/2)"}, {"x": 0.0}, 7, None),
    "a hyperbola": ({"x": "-1/{x}"}, {"x": 3.0}, 4, lambda t: {"x": math.sqrt(9 - 2 * t)}),
    "a stiff one": ({"x": "-1000*({x}**3-cos({t})**3)-sin({t})"}, {"x": 1.0}, 7, lambda t: {"x": math.cos(t)}),
    "friction in air": ({"x": "1-{x}*abs({x})"}, {"x": -1.0}, 5,
                        lambda t: {"x": math.tan(t - math.pi / 4) if t < math.pi / 4 else math.tanh(t - math.pi / 4)}),
}


def of_function_of_function(x):
    """t where sqrt(1 + x^2) has been integrated up to x."""
    return 0.5 * (x * math.sqrt(1 + x * x) + math.asinh(x))


SCALES = [(1.0, 1.0, 1.0), (1e3, 1e-6, 1e-3), (1e-3, 1e-12, 1e-6), (325.0, 1e3, 1.37)]


def check_equation(checker, program, method, name, scale):
    rates, starts, stop, exact = EQUATIONS[name]
    volts, farads, seconds = scale
    at = [stop * seconds * k / 40 for k in range(1, 40)]
    netlist = f"{name}\n{states(rates, starts, *scale)}\n.tran {stop * seconds / 100!r} {stop * seconds!r} uic\n"
    title = f"{name} at {volts:g} V, {farads:g} F, {seconds:g} s"
    result = run(program, netlist, method=method, at=at, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        return
    for signal in (exact(at[0]) if exact else "x"):
        found = [v / volts for v in result.column(f"v({signal})")]
        if exact:
            wanted = [exact(t / seconds)[signal] for t in at]
        else:
            found, wanted = [of_function_of_function(x) for x in found], [t / seconds for t in at]
        largest = max(1.0, max(map(abs, wanted)))
        worst, time = max((abs(f - w), t) for f, w, t in zip(found, wanted, at))
        checker.check(worst <= EXACT * largest, f"{title}: {signal} at {time:g} off by {worst / largest:.1e}")
    checker.check(not result.report.get("fell_back"), f"{title}: fell back")


# A formula of v(a) = a and v(b) = b, and what it is.
FUNCTIONS = {
    "v(a)*v(b)": lambda a, b: a * b, "v(a)/v(b)": lambda a, b: a / b, "1/v(b)": lambda a, b: 1 / b,
    "v(a)**2": lambda a, b: a * a, "v(b)**v(a)": lambda a, b: b ** a, "2**v(a)": lambda a, b: 2 ** a,
    "pow(v(b),1.5)": lambda a, b: b ** 1.5, "pwr(v(a),1.5)": lambda a, b: abs(a) ** 1.5,
    "pwrs(v(a),1.5)": lambda a, b: math.copysign(abs(a) ** 1.5, a), "hypot(v(a),v(b))": math.hypot,
    "atan2(v(a),v(b))": math.atan2, "exp(v(a))": lambda a, b: math.exp(a), "ln(v(b))": lambda a, b: math.log(b),
    "log10(v(b))": lambda a, b: math.log10(b), "sqrt(v(b))": lambda a, b: math.sqrt(b),
    "cbrt(v(b))": lambda a, b: b ** (1 / 3), "sqr(v(a))": lambda a, b: a * a, "sin(v(a))": lambda a, b: math.sin(a),
    "cos(v(a))": lambda a, b: math.cos(a), "tan(v(a)/3)": lambda a, b: math.tan(a / 3),
    "asin(v(a)/5)": lambda a, b: math.asin(a / 5), "acos(v(a)/5)": lambda a, b: math.acos(a / 5),
    "atan(v(a))": lambda a, b: math.atan(a), "sinh(v(a))": lambda a, b: math.sinh(a),
    "cosh(v(a))": lambda a, b: math.cosh(a), "tanh(v(a))": lambda a, b: math.tanh(a),
    "asinh(v(a))": lambda a, b: math.asinh(a), "acosh(v(b)+1)": lambda a, b: math.acosh(b + 1),
    "atanh(v(a)/5)": lambda a, b: math.atanh(a / 5),
    "abs(v(a))*v(b)-max(v(a),0)*sin(v(a)*v(b))": lambda a, b: abs(a) * b - max(a, 0) * math.sin(a * b),
    "limit(v(a)*v(b),-1,1)": lambda a, b: min(max(a * b, -1), 1),
    "v(a)*v(b) > 2 ? 5 : 3": lambda a, b: 5 if a * b > 2 else 3,
    "time*v(a)+sin(2*pi*time*v(b))": None,
}


def check_functions(checker, program, method):
    """Each of two voltages that move, with a capacitor behind it that follows and without any memory."""
    lines = ["functions", "va a 0 sin(0 4 1)", "vb b 0 pwl(0 0.5 1 4.5)"]
    for k, text in enumerate(FUNCTIONS):
        lines.append(f"b{k} x{k} 0 v={text}")
        lines.append(f"r{k} x{k} 0 1k")
    at = [0.0313 * k for k in range(1, 32)]
    for memory in ("", "cm x0 m 1u\nrm m 0 1k\n"):
        result = run(program, "\n".join(lines) + f"\n{memory}.tran 1m 1\n", method=method, at=at,
                     options=["--audit", "full"])
        if not checker.check(result.status == 0, f"functions: exit {result.status}: {result.stderr}"):
            continue
        for k, (text, f) in enumerate(FUNCTIONS.items()):
            found = result.column(f"v(x{k})")
            ab = [(4 * math.sin(2 * math.pi * t), 0.5 + 4 * t) for t in at]
            wanted = [f(a, b) if f else t * a + math.sin(2 * math.pi * t * b) for (a, b), t in zip(ab, at)]
            largest = max(map(abs, wanted))
            for v, w, t in zip(found, wanted, at):
                checker.close(v, w, 1e-7 * largest, f"{text} at {t:g}")


def check_loops(checker, program, method):
    """Algebraic loops: what a function reads depends on it."""
    at = [1e-3 * k + 0.37e-3 for k in range(18)]
    v = [12 + 3 * math.sin(2 * math.pi * 50 * t) for t in at]
    cases = {
        "a constant power": ("b1 a 0 i=20/v(a)", lambda u: u / 2 + math.sqrt(u * u / 4 - 20)),
        "a square law": ("b1 a 0 i=0.1*v(a)*v(a)", lambda u: (math.sqrt(1 + 0.4 * u) - 1) / 0.2),
        "a diode": ("b1 a 0 i=1e-14*(exp(v(a)/0.02585)-1)", None),
        "a diode of two": ("b1 a 0 i=1p*sinh(v(a)/0.05)\nd1 a c dz\nvc c 0 1\n.model dz d(ron=0)", None),
        "two in series": ("b1 a c i=1e-12*(exp(v(a,c)/0.03)-1)\nb2 c 0 i=0.1*v(c)**3\nrc c 0 1k", None),
    }
    laws = {"a diode": lambda r, k, u: 1e-14 * math.expm1(r.column("v(a)")[k] / 0.02585),
            "a diode of two": lambda r, k, u: 1e-12 * math.sinh(r.column("v(a)")[k] / 0.05) + r.column("i(d1)")[k],
            "two in series": lambda r, k, u: 0.1 * r.column("v(c)")[k] ** 3 + r.column("v(c)")[k] / 1e3}
    for name, (text, exact) in cases.items():
        for ohms, memory in ((1, ""), (1, "l1 in i 1n ic=0\nri i 0 1k\n")):
            netlist = f"{name}\nv1 in 0 sin(12 3 50)\nr1 in a {ohms}\n{text}\n{memory}.tran 1m 20m\n"
            result = run(program, netlist, method=method, at=at, options=["--audit", "full"])
            if not checker.check(result.status == 0, f"{name}: exit {result.status}: {result.stderr}"):
                continue
            for k, u in enumerate(v):
                found = result.column("v(a)")[k]
                if exact:
                    checker.close(found, exact(u), 1e-8 * u, f"{name}: v(a) at {at[k]:g}")
                else:
                    checker.close(laws[name](result, k, u), (u - found) / ohms, 1e-7 * u, f"{name} at {at[k]:g}")


def check_many(checker, program, method):
    """A hundred of one equation side by side, coupled by what has no current: on factors as on maps."""
    for n in (1, 5, 30, 100):
        lines = ["many", *(f"c{k} x{k} 0 1 ic=0.1\nb{k} 0 x{k} i=v(x{k})*(1-v(x{k}))" for k in range(n)),
                 *(f"r{k} x{k} x{k + 1} 10" for k in range(n - 1)), ".tran 10m 8 uic"]
        at = [0.5 * k for k in range(1, 16)]
        result = run(program, "\n".join(lines) + "\n", method=method, at=at, options=["--audit", "full"])
        if checker.check(result.status == 0, f"{n} coupled: exit {result.status}: {result.stderr}"):
            for signal in ("v(x0)", f"v(x{n - 1})"):
                for t, found in zip(at, result.column(signal)):
                    checker.close(found, 1 / (1 + 9 * math.exp(-t)), 1e-7, f"{n} coupled: {signal} at {t:g}")


def check_switched(checker, program, method):
    """Beside ideal diodes and switches: events at corners of functions, and loads of constant power."""
    netlist = ("rectified square\nv1 a 0 sin(0 3 1)\nb1 s 0 v=v(a)*abs(v(a))\nd1 s m di\ncm m 0 1m ic=0\n"
               "b2 t 0 v=v(a)*v(a)\nd2 t n di\ncn n 0 1m ic=0\nrn n 0 1g\n.model di d(ron=0)\n.tran 1m 2 uic\n")
    result = run(program, netlist, method=method, at=[0.1, 0.2, 0.5, 1.5], options=["--audit", "full"])
    if checker.check(result.status == 0, f"rectified square: {result.stderr}"):
        for t, found, two in zip((0.1, 0.2, 0.5, 1.5), result.column("v(m)"), result.column("v(n)")):
            wanted = 9 * math.sin(2 * math.pi * min(t, 0.25)) ** 2
            checker.close(found, wanted, 1e-7, f"rectified square at {t}")
            checker.check(two >= wanted * (1 - 1e-5), f"squared and held at {t}: {two}")
    times = [e["time"] for e in (result.report or {}).get("events", []) if e["element"] == "d1" and e["state"] == "off"]
    checker.check(any(abs(t - 0.25) < 1e-7 for t in times), f"rectified square: d1 opens at {times}")
    netlist = ("a relay on a product\nv1 a 0 pwl(0 0 2 2)\nb1 p 0 v=v(a)*v(a)*v(a)\nrp p 0 1\n"
               "s1 b 0 p 0 sm\nr1 in b 1\nv2 in 0 1\nc1 b 0 1n\n.model sm sw(ron=1 vt=1)\n.tran 10m 2\n")
    result = run(program, netlist, method=method, options=["--audit", "full"])
    times = [e["time"] for e in (result.report or {}).get("events", []) if e["element"] == "s1"]
    checker.check(len(times) == 1 and abs(times[0] - 1) < 1e-8, f"a relay on a product: {times} {result.stderr}")


def polynomial(controls, coefficients):
    """In SPICE2's order: words over the controls, the shorter ones first."""
    words, values, at = [()], [1.0], 0
    while len(words) < len(coefficients):
        for k in range(words[at][-1] if words[at] else 0, len(controls)):
            words.append(words[at] + (k,))
            values.append(values[at] * controls[k])
        at += 1
    return sum(c * v for c, v in zip(coefficients, values))


def check_polynomials(checker, program, method):
    """POLY of one to three controls and up to the fourth order, on E, F, G and H; one control is a difference."""
    chance = random.Random(17)
    lines = ["polynomials", "va a 0 sin(1 2 1)", "vb b 0 pwl(0 -1 1 2)", "vc c 0 0.7", "ra a 0 1", "rb b 0 1", "rc c 0 1"]
    wanted = {}
    for k in range(60):
        letter, n = "efgh"[k % 4], 1 + k % 3
        names = ["va", "vb", "vc"][:n]
        nodes = ["a 0", "b c", "c 0"][:n]
        coefficients = [chance.choice([0, 1, -2, 0.5]) for _ in range(chance.randint(n + 2, 12))]
        ends = f"0 x{k}" if letter in "fg" else f"x{k} 0"
        controls = " ".join(nodes if letter in "eg" else names)
        lines.append(f"{letter}{k} {ends} poly({n}) {controls} " + " ".join(map(repr, coefficients)))
        lines.append(f"r{k} x{k} 0 1")
        wanted[f"v(x{k})"] = (letter, n, coefficients)
    at = [0.0717 * k for k in range(1, 14)]
    result = run(program, "\n".join(lines) + "\n.tran 1m 1\n", method=method, at=at, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"polynomials: exit {result.status}: {result.stderr}"):
        return
    for signal, (letter, n, coefficients) in wanted.items():
        found = result.column(signal)
        for t, v in zip(at, found):
            a, b, c = 1 + 2 * math.sin(2 * math.pi * t), -1 + 3 * t, 0.7
            controls = [a, b - c, c] if letter in "eg" else [-a, -b, -c]
            checker.close(v, polynomial(controls[:n], coefficients), 1e-7 * max(1.0, max(map(abs, found))),
                          f"{letter}, {n} controls, {coefficients} at {t:g}")


def check_energy(checker, program, method):
    """Of a part without states: i + i^3 = sin + sin^3, a root of a line, a product of two currents."""
    joule = 0.5 * 0.04
    cube = ["v1 m 0 sin(0 1.75 50)", "v2 in m sin(0 -0.25 150)", "r1 in a 1", "b1 a 0 v=i(b1)**3"]
    root = ["v1 in 0 pwl(0 0 40m 2)", "b1 in a v=v(in)-sqrt(v(in))", "r1 a 0 1"]
    gated = ["v1 in 0 pulse(0 1 5m 0 0 10m 20m)", "r1 in a 1", "b1 a 0 v=i(b1)*i(b1)"]
    share = (math.sqrt(5) - 1) / 2
    for name, lines, wanted in (("a cube", cube, joule), ("a root", root, 0.04), ("a square", gated, share ** 2 * 0.02)):
        done = run(program, f"energy of {name}\n" + "\n".join(lines) + "\n.tran 1m 40m\n", method=method)
        if checker.check(done.status == 0, f"energy of {name}: {done.stderr}"):
            checker.close(done.report["energy"]["resistors"], wanted, 1e-9 * wanted, f"energy of {name}")


def check_refusals(checker, program, method):
    cases = {
        "sqrt(": ("v1 a 0 -1\nb1 x 0 v=sqrt(v(a))\nrx x 0 1\n.op", 1),
        "40 / v(a)": ("v1 in 0 10\nr1 in a 1\nb1 a 0 i=40/v(a)\n.op", 1),
        "the circuit around d1": ("v1 in 0 5\nd1 in 0 di\nr1 in a 10\nb1 a 0 i=1m*v(a)*v(a)\n.model di d(ron=0)\n.op", 1),
        "not a smooth function": ("v1 a 0 1\nb1 x 0 v=floor(i(v1))+fmod(i(v1),2)\nrx x 0 1\n.op", 3),
    }
    for words, (cards, status) in cases.items():
        result = run(program, f"refused\n{cards}\n", method=method)
        says = words if words != "not a smooth function" else "steps without end"
        checker.check(result.status == status and says in result.stderr and "1 " in result.stderr,
                      f"{words}: exit {result.status}: {result.stderr}")
    netlist = "an initial voltage that a formula holds\nv1 a 0 5\nb1 x 0 v=1.25-1.25*tanh(1e4*v(a))\nc1 x 0 1u\n.ic v(x)=0\n.tran 1u 1m\n"
    result = run(program, netlist, method=method)
    checker.check(result.status == 1 and "give .ic another voltage there, or none" in result.stderr, f"held: {result.stderr}")
    netlist = "it ends\nc1 x 0 1 ic=1\nb1 0 x i=v(x)*v(x)\n.tran 10m 2 uic\n"
    result = run(program, netlist, method=method, at=[0.5, 0.9])
    checker.check(result.status == 1, f"x' = x^2 beyond t = 1: exit {result.status}: {result.stderr}")


def check_places(checker, program):
    """Where a function ends: at its place in the formula, from that time on, with what would help."""
    outside, power = "it has no value there", "the divisor may pass 0"
    ramp = "v1 a 0 pwl(0 1 1m -1)"
    cases = (  # cards; the formula, and what of it is pointed at; what is said; the time, None: the operating point; the hint
        (ramp, "ln(v(a))", "ln", "ln(v(a))", 0.5e-3, outside), (ramp, "1+2*sqrt(v(a)+0.5)", "sqrt", "sqrt(...)", 0.75e-3, outside),
        (ramp, "3+1/v(a)", "1/", "1 / v(a)", 0.5e-3, power), ("v1 a 0 pwl(0 0 1m 2)", "asin(v(a))", "asin", "asin(v(a))", 0.5e-3, outside),
        ("v1 a 0 pwl(0 3 2 -1)", "pow(v(a),1.5)", "pow", "pow(v(a), 1.5)", 1.5, outside),
        ("v1 a 0 sin(0 2u 50)", "acos(v(a)*1meg)", "acos", "acos(...)", 1e-2 / 6, outside),
        ("v1 a 0 -5", "sqrt(v(a)-10)", "sqrt", "sqrt(...)", None, outside),
        ("v1 a 0 1000", "exp(v(a))", "exp", "exp(v(a))", None, "limit(x, low, high) bounds"),
        ("v1 a 0 1", "v(a)+v(x)**2", "v(x)", "pow(v(x), 2)", None, "limit(x, low, high) bounds"))
    for cards, formula, there, said, time, hint in cases:
        end = 2 if time is not None and time > 1 else 20e-3
        result = run(program, f"ends\n{cards}\nb1 x 0 v={formula}\nrx x 0 1\n.tran {end / 200!r} {end!r}\n", method=None)
        place = f"circuit.cir:3:{len('b1 x 0 v=') + 1 + formula.index(there)}: error:"
        checker.check(result.status == 1 and f"no value of {said} in 'b1'" in result.stderr and hint in result.stderr and place in result.stderr,
                      f"{formula}: exit {result.status}, not {place} {said}: {result.stderr}")
        found = re.search(r"from t = (\S+)(?: s)? on no solution", result.stderr)
        if time is None:
            checker.check("at the operating point no solution" in result.stderr, f"{formula}: {result.stderr}")
        elif checker.check(found is not None, f"{formula}: {result.stderr}"):
            checker.close(float(found.group(1)), time, 1e-7 * end, f"{formula}: its end")


def check_powers(checker, program, method):
    """What begins as a broken power of the time since an event, with a steep or a flat start: its integral in a capacitor, and
    itself; an rms value from its start on; a root of a ramp down to 0 and up again."""
    for k, p in enumerate((0.25, 0.5, 0.75, 1.2, 1.5, 2.5, 3.5)):
        delay, rate, farads = ((0.3e-3, 1e3, 1e-6), (0, 1, 1), (1e-9, 1e9, 1e-12))[k % 3]
        end = delay + 2 / rate
        done = run(program, f"a power\nv1 a 0 pwl(0 0 {delay!r} 0 {end!r} 2)\nb1 0 z i=v(a)**{p}\nc1 z 0 {farads!r} ic=0\n"
                   f"b2 y 0 v=v(a)**{p}\nr2 y 0 1k\n.tran {2 / rate / 50!r} {end!r} uic\n", method=method)
        if checker.check(done.status == 0, f"t^{p}: {done.stderr}"):
            largest = 2 ** (p + 1) / (p + 1) / rate / farads
            for t, y, z in zip(done.time, done.column("v(y)"), done.column("v(z)")):
                x = max(t - delay, 0) * rate
                checker.close(z, x ** (p + 1) / (p + 1) / rate / farads, 1e-8 * largest, f"integral of t^{p} at {t}")
                # by its first step, 1e-10 of the run and less
                checker.close(y, x ** p, max(1e-8, 1.5e-10 ** p) * 2 ** p, f"t^{p} at {t}")
    for volts, hertz in ((1, 1e3), (325, 50)):
        w = 2 * math.pi * hertz
        done = run(program, f"an rms value\nv1 a 0 sin(0 {volts} {hertz})\nb1 x 0 v=idt(v(a)**2)\nr1 x 0 1k\n"
                   f"b2 y 0 v=sqrt(v(x))\nr2 y 0 1k\n.tran {0.02 / hertz!r} {2 / hertz!r}\n", method=method)
        if checker.check(done.status == 0, f"an rms value: {done.stderr}"):
            for t, y in zip(done.time, done.column("v(y)")):
                exact = volts * math.sqrt(max(t / 2 - math.sin(2 * w * t) / (4 * w), 0))
                checker.close(y, exact, 1e-7 * volts / math.sqrt(hertz), f"an rms value at {t}")
    for top in (1, 5e-3):
        done = run(program, f"a root\nv1 a 0 pulse(0 {top} 0.1m 0.2m 0.2m 0.4m 1m)\nb1 0 z i=sqrt(v(a))\nc1 z 0 1u ic=0\n"
                   ".tran 10u 2.1m uic\n", method=method)
        if checker.check(done.status == 0, f"a root of a trapezium: {done.stderr}"):
            one = math.sqrt(top) * (0.4e-3 + 2 * 2 / 3 * 0.2e-3) / 1e-6
            checker.close(done.at("v(z)", 1.05e-3), one, 1e-6 * one, "a root of a trapezium")
            checker.close(done.column("v(z)")[-1], 2 * one, 1e-6 * one, "a root of two")


def main():
    program, method = sys.argv[1:3]
    step = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    checker = Checker("smooth")
    for name, scale in some_of([(name, scale) for name in list(EQUATIONS)[::step] for scale in SCALES]):
        check_equation(checker, program, method, name, scale)
    for check in kinds_of((check_functions, check_loops, check_many, check_switched, check_polynomials, check_powers, check_energy,
                           check_refusals)):
        check(checker, program, method)
    check_places(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
