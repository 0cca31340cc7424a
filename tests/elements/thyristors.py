#!/usr/bin/env python3
"""Thyristors, GTOs and triacs as elements: converters against closed forms, and each of their limits.

The means are those of Mohan, Undeland and Robbins, Power Electronics, chapter 6.

usage: thyristors.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

EXACT = 1e-7


def gate(name, angle, width, f, high=1):
    return f"v{name} {name} 0 pulse(0 {high} {angle / 360 / f!r} 0 0 {width / 360 / f!r} {1 / f!r})"


def half_wave(v, f, alpha, r):
    cards = [f"v1 a 0 sin(0 {v} {f})", gate("g", alpha, 20, f), "a1 a o g 0 th", f"r1 o 0 {r}"]
    return cards, "v(o)", v / (2 * math.pi) * (1 + math.cos(math.radians(alpha)))


def half_wave_inductive(v, f, alpha, r):
    """To the angle of extinction, where v/z (sin(t - phi) - sin(alpha - phi) exp(...)) is 0 again."""
    w, x = 2 * math.pi * f, r
    phi, a = math.atan2(x, r), math.radians(alpha)
    low, high = math.pi, 2 * math.pi
    for _ in range(200):
        b = (low + high) / 2
        i = math.sin(b - phi) - math.sin(a - phi) * math.exp(-(b - a) * r / x)
        low, high = (b, high) if i > 0 else (low, b)
    cards = [f"v1 a 0 sin(0 {v} {f})", gate("g", alpha, 20, f), "a1 a p g 0 th", f"l1 p o {x / w!r} ic=0",
             f"r1 o 0 {r}"]
    return cards, "v(o)", v / (2 * math.pi) * (math.cos(a) - math.cos(b))


def regulator(v, f, alpha, r):
    """Two of them, the one against the other; the mean is of the magnitude."""
    a = math.radians(alpha)
    cards = [f"v1 a 0 sin(0 {v} {f})", gate("g1", alpha, 20, f), gate("g2", alpha + 180, 20, f), "a1 a o g1 0 th",
             "a2 o a g2 0 th", f"r1 o 0 {r}"]
    return cards, "abs(v(o))", v / math.pi * (1 + math.cos(a))


def triac_regulator(v, f, alpha, r):
    """The same with one triac, which pulses of either sign turn on."""
    a = math.radians(alpha)
    cards = [f"v1 a 0 sin(0 {v} {f})", gate("g1", alpha, 20, f), gate("g2", alpha + 180, 20, f, -1),
             "e1 g 0 value={v(g1)+v(g2)}", "a1 a o g 0 tr", f"r1 o 0 {r}"]
    return cards, "abs(v(o))", v / math.pi * (1 + math.cos(a))


def triac_inductive(v, f, alpha, r):
    """With a coil each half wave ends behind the zero of the voltage."""
    cards, _, mean = half_wave_inductive(v, f, alpha, r)
    w = 2 * math.pi * f
    cards = [f"v1 a 0 sin(0 {v} {f})", gate("g1", alpha, 20, f), gate("g2", alpha + 180, 20, f),
             "e1 g 0 value={v(g1)+v(g2)}", "a1 a p g 0 tr", f"l1 p o {r / w!r} ic=0", f"r1 o 0 {r}"]
    return cards, "abs(v(o))", 2 * mean


def bridge(v, f, alpha, r):
    """With a current that never ends: 2 v/pi cos(alpha)."""
    cards = [f"v1 a b sin(0 {v} {f})", "r9 b 0 1", gate("g1", alpha, 120, f), gate("g2", alpha + 180, 120, f),
             "a1 a p g1 0 th", "a2 n b g1 0 th", "a3 b p g2 0 th", "a4 n a g2 0 th",
             f"l1 p o {20 * r / (2 * math.pi * f)!r} ic=0", f"r1 o n {r}"]
    return cards, "v(p,n)", 2 * v / math.pi * math.cos(math.radians(alpha))


def half_controlled(v, f, alpha, r):
    cards = [f"v1 a b sin(0 {v} {f})", gate("g1", alpha, 20, f), gate("g2", alpha + 180, 20, f), "a1 a p g1 0 th",
             "a2 b p g2 0 th", "d1 0 a di", "d2 0 b di", f"r1 p 0 {r}", ".model di d(ron=0)"]
    return cards, "v(p)", v / math.pi * (1 + math.cos(math.radians(alpha)))


def three_pulse(v, f, alpha, r):
    cards = [f"v{k} {n} 0 sin(0 {v} {f} 0 0 {-120 * k})" for k, n in enumerate("abc")]
    cards += [gate(f"g{k}", 30 + alpha + 120 * k, 100, f) for k in range(3)]
    cards += [f"a{k} {n} p g{k} 0 th" for k, n in enumerate("abc")]
    cards += [f"l1 p o {20 * r / (2 * math.pi * f)!r} ic=0", f"r1 o 0 {r}"]
    return cards, "v(p)", 3 * math.sqrt(3) * v / (2 * math.pi) * math.cos(math.radians(alpha))


def six_pulse(v, f, alpha, r):
    cards = [f"v{k} {n} 0 sin(0 {v} {f} 0 0 {-120 * k})" for k, n in enumerate("abc")]
    cards += [gate(f"g{k}", 30 + alpha + 120 * k, 100, f) for k in range(3)]
    cards += [gate(f"h{k}", (210 + alpha + 120 * k) % 360, 100, f) for k in range(3)]
    cards += [f"a{k} {n} p g{k} 0 th" for k, n in enumerate("abc")]
    cards += [f"a{k + 3} n {n} h{k} 0 th" for k, n in enumerate("abc")]
    cards += [f"l1 p o {20 * r / (2 * math.pi * f)!r} ic=0", f"r1 o n {r}"]
    return cards, "v(p,n)", 3 * math.sqrt(3) * v / math.pi * math.cos(math.radians(alpha))


def bridges(shift, alpha, f, width):
    """Two bridges in series, of nodes ya ... and da ..., the second one behind by `shift` degrees."""
    cards = []
    for s, (high, low, behind) in {"y": ("p", "m", 0), "d": ("m", "n", shift)}.items():
        cards += [gate(f"g{s}{k}", (30 + behind + alpha + 120 * k) % 360, width, f) for k in range(3)]
        cards += [gate(f"h{s}{k}", (210 + behind + alpha + 120 * k) % 360, width, f) for k in range(3)]
        cards += [f"a{s}{k} {s}{n} {high} g{s}{k} 0 th" for k, n in enumerate("abc")]
        cards += [f"a{s}{k + 3} {low} {s}{n} h{s}{k} 0 th" for k, n in enumerate("abc")]
    return cards


def twelve_pulse(v, f, alpha, r):
    """In series, on a star and a delta of ideal transformers: where a phase is at its zero, what the delta's voltages add up to
    is rounding of the two others."""
    cards = [f"v{k} {n} 0 sin(0 {v} {f} 0 0 {-120 * k})" for k, n in enumerate("abc")]
    for k, (n, next_one) in enumerate(zip("abc", "bca")):
        cards += [f"l{k} {n} 0 {v / f!r}", f"ly{k} y{n} 0 {v / f!r}", f"ld{k} d{n} d{next_one} {3 * v / f!r}",
                  f"k{k} l{k} ly{k} ld{k} 1"]
    cards += [*bridges(30, alpha, f, 90), f"l9 p o {20 * r / (2 * math.pi * f)!r} ic=0", f"r1 o n {r}", "r9 n 0 1meg"]
    return cards, "v(p,n)", 6 * math.sqrt(3) * v / math.pi * math.cos(math.radians(alpha))


# converter, volts, hertz, degrees, ohms, periods until the coil has its current
CONVERTERS = (
    (half_wave, 325, 50, 60, 10, 2), (half_wave, 0.5, 1e6, 100, 1e3, 2), (half_wave, 2e4, 0.01, 30, 0.5, 2),
    (half_wave_inductive, 170, 60, 45, 5, 3), (half_wave_inductive, 1e3, 400, 100, 100, 3),
    (regulator, 325, 50, 90, 10, 2), (regulator, 10, 1e3, 40, 1e4, 2),
    (triac_regulator, 325, 50, 90, 10, 2), (triac_regulator, 10, 1e3, 40, 1e4, 2),
    (triac_inductive, 325, 50, 100, 10, 3), (triac_inductive, 24, 400, 120, 1, 3),
    (bridge, 325, 50, 40, 10, 40), (half_controlled, 325, 50, 75, 8, 2),
    (three_pulse, 100, 50, 20, 5, 40), (six_pulse, 325, 50, 30, 10, 40), (six_pulse, 5e3, 16.7, 55, 2, 40),
    (twelve_pulse, 326.6, 50, 30, 10, 5), (twelve_pulse, 10, 400, 60, 1, 5),
)
MODELS = ".model th thyristor(Vgt=0.5{more})\n.model tr triac(Vgt=0.5{more})"


def converters(checker, program):
    for converter, v, f, alpha, r, periods in some_of(CONVERTERS):
        cards, output, mean = converter(v, f, alpha, r)
        stop, period = periods / f, 1 / f
        # both halves of a triac read a sine that is right to 1e-9: less than a hundred times that is in its rounding
        least = 1e-7 if converter.__name__.startswith("triac") else 1e-9
        for more in ("", f" Voff={least * v!r}", f" Vfwd={1e-6 * v!r}"):
            what = f"{converter.__name__} at {v} V and {f} Hz{more}"
            done = run(program, "\n".join([what, MODELS.format(more=more), *cards,
                                           f".tran {period / 200!r} {stop!r} uic",
                                           f".meas tran m avg {output} from={stop - period!r} to={stop!r}", ".end", ""]),
                       method=None)
            if checker.check(done.status == 0, f"{what}: {done.stderr}"):
                got = done.report["measurements"][0]["value"]
                checker.close(got, mean, (1e-6 if not more.startswith(" Vfwd") else 4e-6) * v + 2e-3 * 1e-3,
                              f"{what}: the mean")
                checker.check("connection" not in done.stderr, f"{what}: {done.stderr}")


def run_at(program, text):
    return run(program, text, method=None, tolerance=1e-10)


def limits(checker, program):
    """The gate's voltage that closes, the current and the voltages that open: each at its time."""
    ramp = "a ramp at the gate\nv1 a 0 {v}\nvg g 0 PWL(0 0 1m 1)\na1 a o g 0 th\nr1 o 0 10\n.tran 10u 1m\n" \
           ".meas tran t when v(o)=1 rise=1\n.model th {model}\n.end\n"
    for model, vgt in (("thyristor", 0.5), ("thyristor(Vgt=0.2)", 0.2), ("scr(Vgt=0.8 Ih=10m)", 0.8),
                       ("gto(Vgt=0.3)", 0.3), ("thyristor(Vgt=0.7 Ih=0.1)", 0.7)):
        done = run_at(program, ramp.format(v=10, model=model))
        checker.check(done.status == 0, done.stderr)
        checker.close(done.report["measurements"][0]["value"], vgt * 1e-3, 1e-12, f"{model} closes")
    for v, model in ((-10, "thyristor"), (-10, "gto(Ih=1m)")):
        done = run_at(program, ramp.format(v=v, model=model).replace(".meas tran t when v(o)=1 rise=1",
                                                                     ".meas tran t max abs(i(a1))"))
        checker.close(done.report["measurements"][0]["value"], 0.0, 0.0, f"{model} blocks backwards")
    fade = "a current that fades\ni1 0 a PWL(0 2 1m 0)\nr9 a 0 1k\nvg g 0 PULSE(1 0 0.1m)\na1 a o g 0 th\nr1 o 0 {r}\n" \
           ".tran 1u 1m\n.meas tran t when i(a1)=1u fall=last\n.model th {model}\n.end\n"
    for model, r, holding in (("thyristor(Ih=0.5)", 0, 0.5), ("thyristor(Ih=50m)", 0, 0.05), ("gto(Ih=1)", 0, 1),
                              ("triac(Ih=0.25)", 0, 0.25), ("thyristor(Ih=0.5)", 10, 0.5)):
        share = 1000 / (1000 + r)
        done = run_at(program, fade.format(model=model, r=r))
        checker.check(done.status == 0, done.stderr)
        checker.close(done.report["measurements"][0]["value"], (1 - holding / share / 2) * 1e-3, 1e-9,
                      f"{model} into {r} ohm opens")
    off = "a gate that turns off\nv1 a 0 10\nvg g 0 PWL(0 1 1m -1)\na1 a o g 0 th\nr1 o 0 10\n.tran 1u 1m\n" \
          ".meas tran t when v(o)=1 fall=1\n.model th {model}\n.end\n"
    for model, volts in (("gto(Vgoff=0.5)", 0.5), ("gto(Vgoff=0.25 Ih=1m)", 0.25), ("gto", 0.5)):
        done = run_at(program, off.format(model=model))
        checker.check(done.status == 0, done.stderr)
        checker.close(done.report["measurements"][0]["value"], (1 + volts) / 2 * 1e-3, 1e-9, f"{model} opens")
    done = run_at(program, off.format(model="thyristor").replace("when v(o)=1 fall=1", "min v(o)"))
    checker.close(done.report["measurements"][0]["value"], 10.0, 1e-9, "no gate turns a thyristor off")


def latching(checker, program):
    """A gate that ends before a coil has the latching current, and one that ends behind it; then down to the holding current;
    in both directions of a triac; a second pulse."""
    text = "a coil and a battery\nv1 a 0 {v!r}\nvg g k pulse(0 {high!r} {start!r} 0 0 {width!r} {period!r})\na1 a k g k th\n" \
           "l1 k x {henry!r}\nr1 x 0 {ohm!r}\nd1 {d} di\n.model di d(ron=0)\n.model th {model}\n.tran {step!r} {stop!r}\n" \
           ".meas tran after find i(a1) at={at!r}\n.meas tran last find i(a1) at={stop!r}\n.save i(a1)\n.end\n"
    cases = ((100, 0.1, 100, 50e-3, "thyristor(Vgt=0.5 Il=50m Ih=20m)"), (12, 1e-6, 0.5, 2, "scr(Il=2)"), (1e3, 10, 1e3, 0.3, "gto(Il=0.3 Ih=0.3)"),
             (-24, 1e-3, 10, 0.4, "triac(Il=0.4 Ih=0.1)"), (24, 1e-3, 10, 0.4, "triac(Il=0.4 Ih=0.1)"), (325, 5e-3, 20, 5, "thyristor(Il=5 Vfwd=1.5 Ron=0.1)"),
             (1e-2, 1e-3, 1, 1e-3, "thyristor(Il=1m Ih=1u)"))
    for v, henry, ohm, il, model in cases:
        drop, ron = (1.5, 0.1) if "Vfwd" in model else (0, 0)
        tau, end = henry / (ohm + ron), (abs(v) - drop) / (ohm + ron)
        t = -tau * math.log(1 - il / end)
        for part in (0.3, 0.999, 1.001, 3):
            start, stop = 0.5 * tau, 8 * tau
            done = run_at(program, text.format(v=v, high=1 if v > 0 else -1, start=start, width=part * t, period=100 * tau, henry=henry, ohm=ohm,
                                               d="0 k" if v > 0 else "k 0", model=model, step=tau / 50, stop=stop, at=start + part * t + 0.01 * tau))
            what = f"{model} at {v} V for {part} of its time"
            if checker.check(done.status == 0, f"{what}: {done.stderr}"):
                after, last = (m["value"] for m in done.report["measurements"])
                wanted = math.copysign(end * (1 - math.exp(-(stop - start) / tau)), v) if part > 1 else 0
                checker.close(last, wanted, 1e-6 * end, f"{what}: its last current")
                checker.check((after != 0) == (part > 1), f"{what}: {after} behind the gate")
    fade = "a current that fades\ni1 0 a PWL(0 2 1m 0)\nr9 a 0 1k\nvg g 0 PULSE(1 0 0.1m)\na1 a o g 0 th\nr1 o 0 0\n" \
           ".tran 1u 1m\n.meas tran t when i(a1)=1u fall=last\n.model th {model}\n.end\n"
    for model, holding in (("thyristor(Il=1 Ih=0.5)", 0.5), ("thyristor(Il=1.7)", 0.85), ("gto(Il=1.5 Ih=50m)", 0.05), ("triac(Il=1 Ih=0.25)", 0.25)):
        done = run_at(program, fade.format(model=model))
        checker.check(done.status == 0, done.stderr)
        checker.close(done.report["measurements"][0]["value"], (1 - holding / 2) * 1e-3, 1e-9, f"{model} opens")
    done = run_at(program, fade.format(model="thyristor(Il=1.9)"))
    checker.close(done.report["measurements"][0]["value"], (1 - 0.95 / 2) * 1e-3, 1e-9, "a gate that ended at 1.8 A, after 2 A")
    done = run_at(program, fade.format(model="thyristor(Il=2.5 Ih=0.1)"))
    checker.close(done.report["measurements"][0]["value"], 0.1e-3, 1e-9, "never latched")


def terminals(checker, program):
    """The current of a triac is that of both halves; gates that last through the zeros of it, at any height."""
    text = "a triac\nv1 in 0 sin(0 {v} {f})\nvg g b pulse(0 {high} {start!r} {edge!r} {edge!r} {width!r} {period!r})\n" \
           "a1 in b g b tm\nr1 b 0 {r}\n.model tm triac{model}\n.tran {step!r} {stop!r}\n.save i(a1) i(r1)\n" \
           ".meas tran both max abs(i(a1)-i(r1))\n.meas tran m avg i(r1)\n.meas tran rms rms i(r1)\n.end\n"
    for v, f, r in some_of(((10, 50, 10), (325, 60, 1e3), (0.1, 1e5, 50), (1e4, 16.7, 2))):
        period = 1 / f
        for high, width, model in ((1, 0.85, ""), (0.6, 0.85, ""), (2, 0.95, ""), (-1, 0.95, ""), (0.51, 0.9, ""),
                                   (1, 0.85, f"(Ih={1e-2 * v / r!r})"), (1, 0.3, "")):
            done = run_at(program, text.format(v=v, f=f, r=r, high=high, start=0.1 * period, edge=1e-7 * period,
                                               width=width * period, period=period, step=period / 100,
                                               stop=2 * period, model=model))
            what = f"{v} V {f} Hz, gate {high} V for {width} periods{model}"
            if not checker.check(done.status == 0, f"{what}: {done.stderr}"):
                continue
            got = {m["name"]: m["value"] for m in done.report["measurements"]}
            checker.close(got["both"], 0, 1e-9 * v / r, f"{what}: i(a1) is i(r1)")
            # to the zero behind the gate's end; from 0.9 periods on that is in the next one, which goes on from there
            end = 0.5 if width < 0.4 else 1.0
            two = [(0.1, 2.0)] if width >= 0.9 else [(0.1, end), (1.1, 1 + end)]
            peak, tau = v / r, 2 * math.pi
            mean = sum(peak * (math.cos(tau * a) - math.cos(tau * b)) / tau for a, b in two) / 2
            if "Ih" not in model:
                checker.close(got["m"], mean, 3e-6 * peak, f"{what}: the mean")


# volts, hertz, ohms of the load, reactance of each line and ohms of the resistor over those, degrees
OVERLAPS = ((261, 50, 20, 0.067, 1e3, 64), (261, 50, 20, 0.067, 1e3, 65), (325, 60, 5, 0.02, 3e3, 66), (40, 400, 2, 0.1, 500, 65),
            (3000, 16.7, 50, 0.05, 1e3, 70))


def overlapping(checker, program):
    """Coils in the lines: behind each gate the output goes to another voltage, within microseconds as a resistor leads on what the
    coils carry. Where that passes 0, three blocked thyristors do so at once but for the drops of those that conduct."""
    for v, f, r, reactance, leak, alpha in OVERLAPS:
        w = 2 * math.pi * f
        cards = [f"v{k} n{k} 0 sin(0 {v} {f} 0 0 {-120 * k})\nl{k} n{k} x{k} {reactance * r / w!r}" for k in range(3)]
        for k in range(3):
            for name, a, b, behind in (("g", f"x{k}", "p", 30), ("h", "n", f"x{k}", 210)):
                angle = (behind + alpha + 120 * k) % 360
                late = angle + 90 > 360
                first = angle - 270 if late else angle
                cards += [f"v{name}{k} {name}{k} 0 pulse({5 if late else 0} {0 if late else 5} {first / 360 / f!r} 0 0 "
                          f"{(270 if late else 90) / 360 / f!r} {1 / f!r})", f"a{name}{k} {a} {b} {name}{k} 0 th"]
        cards += [f"ld p o {20 * r / w!r}", f"r1 o n {r}", f"r9 n 0 {leak * r!r}", ".model th thyristor(Ron=1m)", ".save i(ld)", ".pss uic"]
        what = f"a bridge of {v} V at {f} Hz and {alpha} degrees"
        done = run(program, "\n".join([what, *cards, ".end", ""]), method=None)
        if checker.check(done.status == 0, f"{what}: {done.stderr}"):
            mean = 3 * math.sqrt(3) * v / math.pi * math.cos(math.radians(alpha)) / (1 + 3 * reactance / math.pi) / r
            i = done.column("i(ld)")
            got = math.fsum(0.5 * (a + b) * (t1 - t0) for a, b, t0, t1 in zip(i, i[1:], done.time, done.time[1:])) * f
            checker.close(got, mean, 0.01 * mean, f"{what}: the mean current")
            checker.check("wrong sign" not in done.stderr, f"{what}: {done.stderr}")
            checker.check(done.report["work"]["restarts"] < 1000, f"{what}: {done.report['work']['restarts']} restarts a period")


def shorts(checker, program):
    """The current of a short that a formula reads: of one that measures, of a terminal."""
    for card, read in (("r0 a b 0", "i(r0)"), ("c0 a b 1u rpar=1k ic=0", "i(c0)"), ("r0 b a 0", "-i(r0)")):
        for formula, value in (("{i}", 1), ("limit(1e5*{i},-1,1)", None), ("abs(2*{i})", 2), ("1e3*{i}", 1e3)):
            text = f"a short\nv1 a 0 sin(0 10 50)\n{card}\nr1 b 0 10\nb1 c 0 V={formula.format(i=read)}\nr2 c 0 1\n" \
                   ".tran 1m 40m uic\n.save v(c) i(r1)\n.meas tran m max v(c)\n.meas tran i max i(r1)\n.end\n"
            done = run_at(program, text)
            if checker.check(done.status == 0, f"{card} {formula}: {done.stderr}"):
                got = {m["name"]: m["value"] for m in done.report["measurements"]}
                wanted = 1 if value is None else value * got["i"]
                checker.close(got["m"], wanted, 1e-6 * wanted, f"{card} {formula}")


def at_rest(checker, program):
    """Bridges that wait for both to be fired, in front of a battery: no current, and controls of 1 V beside hundreds."""
    for v, f, alpha, volts in ((326.6, 50, 50, 100), (5e3, 60, 50, 400), (30, 400, 40, 3)):
        cards = [f"v{k} {n} 0 sin(0 {v} {f} 0 0 {-120 * k})" for k, n in enumerate("abc")]
        cards += [f"ax{k} {n} 0 y{n} ny d{n} d{next_one} tr" for k, (n, next_one) in enumerate(zip("abc", "bca"))]
        cards += [*bridges(30, alpha, f, 119), "r1 p q 10", "l1 q w 20m", f"vb w n {volts}", "r9 n 0 1meg"]
        done = run(program, "\n".join(["bridges that wait", ".model tr transformer(turns=[1 1 1.73205080757])",
                                       ".model th thyristor(Vfwd=1)", *cards, f".tran {0.0025 / f!r} {0.25 / f!r} uic",
                                       ".meas tran m max abs(i(r1))", ".end", ""]), method=None)
        what = f"bridges at rest, {v} V"
        if checker.check(done.status == 0, f"{what}: {done.stderr}"):
            checker.close(done.report["measurements"][0]["value"], 0.0, 1e-9 * v, f"{what}: no current")
            checker.check("wrong sign" not in done.stderr, f"{what}: {done.stderr}")


def names(checker, program):
    """One element in results and events; in subcircuits; with a line of its own; wrong cards."""
    cards = "{0}\nv1 a 0 SIN(0 10 50)\nvg g 0 PULSE(0 1 5m 0 0 1m 20m)\n{1}\nr1 o 0 10\n.tran 0.1m 20m\n.end\n"
    for line, current in (
            ("a1 a o g 0 th\n.model th thyristor", "i(a1)"),
            ("a1 a o g o th\nrg g 0 1g\n.model th triac", "i(a1)"),
            ("x1 a o g s\n.subckt s p q c\na1 p q c 0 th\n.model th thyristor\n.ends", "i(x1.a1)"),
            ("x1 a o g s v=0.3\n.subckt s p q c v=1\na1 p q c 0 th\n.model th thyristor(Vgt={v})\n.ends", "i(x1.a1)")):
        done = run_at(program, cards.format(line.replace("\n", "; "), line))
        checker.check(done.status == 0 and current in done.names, f"{line}: {done.names} {done.stderr}")
        if line.startswith("a1 a o g 0"):
            events = [(e["element"], e["state"]) for e in done.report["events"]]
            checker.check(("a1", "on") in events, f"{events}")
            checker.check([n for n in done.names if "(" in n[2:]] == [], f"{done.names}")
    done = run_at(program, "a line\nv1 a 0 10\na1 a o a 0 th\nr1 o 0 1\n.op\n.model th thyristor(Ron=0.25 Vfwd=1.25)\n.end\n")
    checker.close(done.column("i(a1)")[0], 8.75 / 1.25, 1e-9, "Ron and Vfwd")
    for line, words in (("a1 a o th\n.model th thyristor", "3 or 4 nodes"), ("a1 a o g 0 th\n.model th thyristor(Igt=1m)", "no meaning"),
                        ("a1 a o g 0 th\n.model th thyristor(Il=1 Ih=2)", "cannot be below the holding"),
                        ("a1 a o g 0 th\n.model th thyristor(Il=1 Ih=0)", "a holding current above 0"),
                        ("a1 a o g 0 th\n.model th thyristor(Vgt=0)", "must be positive"),
                        ("a1 a o g 0 th\n.model th thyristor(Ih=-1)", "cannot be negative"),
                        ("a1 a o g 0 th\n.model th triac(Vgoff=1)", "make it a gto"),
                        ("a1 a o g 0 th\n.model th thyristor(Vgtt=1)", "did you mean 'vgt'"),
                        ("d1 a o th\n.model th thyristor", "here D is wanted"), ("a1 a o g 0 th", "neither dalcs nor the netlist has")):
        done = run_at(program, cards.format("wrong", line))
        checker.check(done.status == 3 and words in done.stderr, f"{line}: {done.status} {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("thyristors")
    for part in (converters, limits, latching, terminals, overlapping, shorts, at_rest, names):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
