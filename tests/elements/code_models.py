#!/usr/bin/env python3
"""XSPICE's code models: gates, flip-flops and bridges with their delays, and blocks of straight lines, against closed
forms.

usage: code_models.py PROGRAM
"""

import itertools
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402
from logic import edges, run_cards, runs, times  # noqa: E402


def truth(checker, program):
    """All gates of two and three inputs, one of them inverted, against their tables; each period of the inputs one row."""
    table = {"d_and": all, "d_nand": lambda b: not all(b), "d_or": any, "d_nor": lambda b: not any(b),
             "d_xor": lambda b: sum(b) % 2 == 1, "d_xnor": lambda b: sum(b) % 2 == 0}
    for n in (2, 3, 4):
        names = "abcd"[:n]
        cards = [f"v{k} {x} 0 pulse(0 1 {2 ** k}u 0 0 {2 ** k}u {2 ** (k + 1)}u)" for k, x in enumerate(names)]
        cards += [f"abridge [{' '.join(names)}] [{' '.join('d' + x for x in names)}] adc",
                  ".model adc adc_bridge(rise_delay=0 fall_delay=0 in_low=0.5 in_high=0.5)"]
        for kind in table:
            inputs = " ".join(f"d{x}" for x in names[1:])
            cards += [f"a{kind} [~da {inputs}] o{kind} m{kind}", f".model m{kind} {kind}(rise_delay=0 fall_delay=0)"]
        done = run_cards(program, f"truth of {n}", [*cards, f".tran 0.25u {2 ** n}u"])
        if runs(checker, done, f"truth of {n}"):
            for row in range(2 ** n):
                bits = [row >> k & 1 == 1 for k in range(n)]
                bits[0] = not bits[0]
                for kind, law in table.items():
                    got = done.at(f"v(o{kind})", (row + 0.5) * 1e-6)
                    checker.check(got == (1 if law(bits) else 0), f"{kind} of {bits}: {got}")


def ring(checker, program):
    """Inverters and a buffer in a ring: up and down take different times, and each turn has as many of both."""
    for n, rise, fall in ((3, 1e-9, 2e-9), (5, 3e-3, 1e-3), (11, 2e-6, 2e-6)):
        what = f"a ring of {n} d_inverter"
        cards = [f"a{k} n{k} n{k + 1} m" for k in range(n)] + [f"ab n{n} n0 b"]
        cards += [f".model m d_inverter(rise_delay={rise!r} fall_delay={fall!r})", f".model b d_buffer(rise_delay={fall!r} fall_delay={rise!r})",
                  f".tran {rise!r} {6 * (n + 1) * (rise + fall)!r}"]
        done = run_cards(program, what, cards)
        if runs(checker, done, what):
            got = edges(done, "v(n1)", 0.5)
            for a, b in zip(got, got[2:]):
                checker.close(b - a, (n + 1) * (rise + fall), 1e-9 * n * (rise + fall), f"{what}: a turn")
            checker.check(len(got) >= 6, f"{what}: {got}")


def flip_flops(checker, program):
    """Each kind for all its inputs, with the delays of the clock, of rises and falls, and of set and reset."""
    laws = {"d_dff": (1, lambda q, d, _: d), "d_tff": (1, lambda q, t, _: q != t),
            "d_jkff": (2, lambda q, j, k: (not k) if q else j), "d_srff": (2, lambda q, s, r: (s or q) and not r)}
    for kind, (n, law) in laws.items():
        rows = [r for r in itertools.product((False, True), repeat=2) if kind != "d_srff" or r != (True, True)] * 2
        rows += rows[::-1]
        volts = [", ".join(f"{k}u {int(row[i])} {k + 0.999}u {int(row[i])}" for k, row in enumerate(rows)) for i in (0, 1)]
        data = "da" if n == 1 else "da db"
        cards = [f"v1 a 0 pwl({volts[0]})", f"v2 b 0 pwl({volts[1]})", "v3 c 0 pulse(0 1 0.5u 0 0 0.25u 1u)",
                 "ab [a b c] [da db dc] adc", ".model adc adc_bridge(rise_delay=0 fall_delay=0)",
                 f"af {data} dc null null q nq ff",
                 f".model ff {kind}(clk_delay=20n rise_delay=3n fall_delay=5n)", f".tran 0.1u {len(rows)}u"]
        done = run_cards(program, kind, cards)
        if not runs(checker, done, kind):
            continue
        q, plain, complement = False, [], []
        for k, (a, b) in enumerate(rows):
            after = bool(law(q, a, b))
            if after != q:
                plain.append((k + 0.5) * 1e-6 + (23e-9 if after else 25e-9))
                complement.append((k + 0.5) * 1e-6 + (25e-9 if after else 23e-9))
            q = after
        times(checker, edges(done, "v(q)", 0.5), plain, kind)
        times(checker, [t for t in edges(done, "v(nq)", 0.5) if t > 0], complement, f"{kind}, complement")
    cards = ["v1 c 0 pulse(0 1 1u 0 0 0.5u 1u)", "v2 s 0 pulse(0 1 2.6u 0 0 0.2u 100u)",
             "v3 r 0 pulse(0 1 4.6u 0 0 0.2u 100u)", "ab [c s r] [dc ds dr] adc",
             ".model adc adc_bridge(rise_delay=0 fall_delay=0)", "aone one up", ".model up d_pullup",
             "azero zero down", ".model down d_pulldown", "a1 zero dc ds dr q nq ff",
             ".model ff d_dff(clk_delay=10n set_delay=25n reset_delay=27n rise_delay=1n fall_delay=2n ic=1)",
             "a2 one dc null dr p ff2", ".model ff2 d_dff(clk_delay=1n)", ".tran 0.1u 6u"]
    done = run_cards(program, "set and reset", cards)
    if runs(checker, done, "set and reset"):
        times(checker, edges(done, "v(q)", 0.5), [1e-6 + 12e-9, 2.6e-6 + 26e-9, 3e-6 + 12e-9], "set and reset")
        times(checker, edges(done, "v(nq)", 0.5), [1e-6 + 11e-9, 2.6e-6 + 27e-9, 3e-6 + 11e-9], "set, complement")
        times(checker, edges(done, "v(p)", 0.5), [1e-6 + 2e-9, 4.6e-6 + 2e-9, 5e-6 + 2e-9], "no set")


def bridges(checker, program):
    """Thresholds in both directions, delays, glitches shorter than the difference of delays, levels and ramps; a divider,
    a subcircuit; a gate that is one in each dialect."""
    cards = ["v1 a 0 pulse(-1 4 0 10u 20u 5u 100u)", "aad [a] [d] adc",
             ".model adc adc_bridge(in_low=0.5 in_high=3 rise_delay=100n fall_delay=200n)",
             "ada d o dac", ".model dac dac_bridge(out_low=-2 out_high=7 t_rise=1u t_fall=3u)", "r1 o 0 1k",
             "a3 d 0 0 0 0 0 x 0 BUF Td=1u", "r2 x 0 1k", ".tran 0.1u 40u"]
    done = run_cards(program, "a bridge there and back", cards)
    if runs(checker, done, "a bridge there and back"):
        up, down = 8e-6 + 1e-7, 15e-6 + 20e-6 * 3.5 / 5 + 2e-7
        times(checker, edges(done, "v(d)", 0.5), [up, down], "a bridge, its bit")
        times(checker, edges(done, "v(x)", 0.5), [up + 1e-6, down + 1e-6], "a gate of LTspice behind it")
        for t, value in ((up, -2), (up + 1e-6, 7), (down, 7), (down + 3e-6, -2)):
            checker.close(done.at("v(o)", t), value, 1e-6, f"a ramp at {t}")
    cards = ["v1 a 0 pulse(0 1 1u 0 0 3n 1u)", "aad a d adc", ".model adc adc_bridge(rise_delay=5n fall_delay=2n)",
             "a2 a e adc2", ".model adc2 adc_bridge(rise_delay=5n fall_delay=2.5n)", ".tran 0.1u 5.5u"]
    done = run_cards(program, "glitches", cards)
    if runs(checker, done, "glitches"):
        times(checker, edges(done, "v(d)", 0.5), [], "a pulse that its delays swallow")
        wanted = [k * 1e-6 + dt for k in range(1, 6) for dt in (5e-9, 5.5e-9)]
        times(checker, edges(done, "v(e)", 0.5), wanted, "a pulse that they leave half a nanosecond of", 1e-8)
    cards = ["v1 a 0 pulse(0 5 0.5m 0 0 0.5m 1m)", ".subckt by5 in out n=5", "aad [%v in] [%d di] adc",
             ".model adc adc_bridge(in_low=1 in_high=4 rise_delay=0 fall_delay=0)", "adiv di do div",
             ".model div d_fdiv(div_factor={n} high_cycles=2 rise_delay=0 fall_delay=0)",
             "ainv [~do] out dac", ".model dac dac_bridge(out_low=0 out_high=5 t_rise=0 t_fall=0)", ".ends",
             "x1 a o by5", "x2 o p by5 n=3", "r1 o 0 1k", "r2 p 0 1k", ".tran 0.1m 40m"]
    done = run_cards(program, "dividers", cards)
    if runs(checker, done, "dividers"):
        ticks = [(k + 0.5) * 1e-3 for k in range(40)]
        first = [t for k, t in enumerate(ticks) if k % 5 in (0, 2)]
        times(checker, edges(done, "v(o)", 2.5), first, "divided by 5")
        rises = [t for k, t in enumerate(ticks) if k % 5 == 2]
        times(checker, edges(done, "v(p)", 2.5), [t for k, t in enumerate(rises) if k % 3 in (0, 2)], "and by 3")


def lines(checker, program):
    """gain, summer, limit of both signs, pwl with ends and without, in 5 scales; a difference as a port."""
    for scale, f in ((1, 1e3), (1e-3, 50), (400, 1e5), (7, 0.1), (1e4, 1e7)):
        what = f"lines at {scale} V"
        cards = [f"v1 in 0 sin(0 {2 * scale} {f!r})", f"v2 b 0 {0.3 * scale}",
                 "a1 in g mg", f".model mg gain(in_offset={0.1 * scale} gain=-3 out_offset={0.5 * scale})",
                 "a2 [in b %vd(in b)] s ms",
                 f".model ms summer(in_offset=[{0.1 * scale} {-0.2 * scale}] in_gain=[2 -1 0.5] out_gain=3 out_offset=-1)",
                 "a3 in l ml", f".model ml limit(in_offset={0.1 * scale} gain=-2.5 out_lower_limit={-scale} "
                 f"out_upper_limit={2 * scale} limit_range=1n fraction=false)",
                 "a4 %vd(in b) h mh", f".model mh limit(gain=2 out_upper_limit={scale})",
                 "a5 in p mp", f".model mp pwl(x_array=[{-scale} 0 {scale}] y_array=[-2 0 1])",
                 "a6 in t mt", f".model mt pwl(x_array=[{-scale} 0 {scale}] y_array=[-2 0 1] limit=true)",
                 *(f"r{k} {n} 0 1k" for k, n in enumerate("gslhpt")), f".tran {0.03 / f!r} {1.5 / f!r}"]
        done = run_cards(program, what, cards)
        if not runs(checker, done, what):
            continue
        v, b = [x / scale for x in done.column("v(in)")], 0.3

        def table(x, limits):
            x = min(max(x, -1), 1) if limits else x
            return 2 * x if x < 0 else x
        wanted = {"v(g)": [scale * (0.5 - 3 * (x + 0.1)) for x in v],
                  "v(s)": [3 * scale * (2 * (x + 0.1) - (b - 0.2) + 0.5 * (x - b)) - 1 for x in v],
                  "v(l)": [scale * min(max(-2.5 * (x + 0.1), -1), 2) for x in v],
                  "v(h)": [scale * min(2 * (x - b), 1) for x in v],
                  "v(p)": [table(x, False) for x in v], "v(t)": [table(x, True) for x in v]}
        for name, values in wanted.items():
            size = max(map(abs, values))
            worst = max(abs(x - y) for x, y in zip(values, done.column(name)))
            checker.check(worst <= 1e-9 * size, f"{what}: {name} is off by {worst}")


def states(checker, program):
    """int between its limits, of both signs and from where it starts, with uic and without; slew behind a jump and on a
    ramp; aswitch."""
    for gain, period, high, word in ((1000, 1e-3, 1, ""), (-2e6, 1e-6, 0.5, "uic"), (0.01, 100, 12, ""), (5e8, 1e-9, 2, "uic")):
        what = f"an integrator of {gain}"
        swing = abs(gain) * high * period / 4
        first = 0.3 * swing if gain > 0 else -0.3 * swing
        cards = [f"v1 in 0 pulse({-high} {high} 0 0 0 {period / 2!r} {period!r})", "a1 in o mi",
                 f".model mi int(gain={gain} out_lower_limit={-swing!r} out_upper_limit={0.8 * swing!r} out_ic={first!r})",
                 "a2 in f mf", f".model mf int(gain={gain} in_offset={high})",
                 "r1 o 0 1k", "r2 f 0 1k", f".tran {period / 20!r} {3 * period!r} {word}"]
        done = run_cards(program, what, cards)
        if not runs(checker, done, what):
            continue
        x, low, top = first, -swing, 0.8 * swing
        slope = gain * high
        for k in range(6):
            for part in (0.11, 0.37, 0.5):
                t = (k / 2 + part) * period
                value = min(max(x + slope * part * period, low), top)
                row = min(done.time, key=lambda s, t=t: abs(s - t))
                value = min(max(x + slope * (row - k / 2 * period), low), top)
                checker.close(done.at("v(o)", row), value, 1e-8 * swing, f"{what} at {row}")
            x = min(max(x + slope * period / 2, low), top)
            slope = -slope
        checker.close(done.at("v(f)", 3 * period), 3 * gain * high * period, 1e-7 * abs(gain * high * period), f"{what}, free")
    for up, down, height, period in ((1e4, 2e4, 1, 1e-3), (1e9, 1e8, 5, 2e-7), (0.5, 0.25, 2, 40)):
        what = f"a slew of {up} V/s"
        cards = [f"v1 in 0 pulse(0 {height} {period / 10!r} 0 0 {period / 2!r} {period!r})", "a1 in o m",
                 f".model m slew(rise_slope={up!r} fall_slope={down!r})", "r1 o 0 1k", f".tran {period / 50!r} {period!r}"]
        done = run_cards(program, what, cards)
        if runs(checker, done, what):
            for t, v in zip(done.time, done.column("v(o)")):
                wanted = min(max(0, up * (t - period / 10)), height)
                wanted = wanted if t < 0.6 * period else max(0, height - down * (t - 0.6 * period))
                checker.close(v, wanted, 1e-7 * height, f"{what} at {t}")
    cards = ["v1 c 0 sin(0 1 50)", "v2 p 0 10", "a1 c %gd(p o) m", "a2 c (p q) n", "r1 o 0 1k", "r2 q 0 1k",
             ".model m aswitch(cntl_off=0.2 cntl_on=0.6 r_on=1k r_off=1e12 log=true)",
             ".model n pswitch(cntl_off=0.6 cntl_on=0.2 r_on=3k)", ".tran 1m 20m"]
    done = run_cards(program, "a switch", cards)
    if runs(checker, done, "a switch"):
        on = math.asin(0.4) / (2 * math.pi * 50)
        checker.check("changes over at once" in run(program, "\n".join(["x", *cards, ".end", ""]), method=None, quiet=False).stderr,
                      "a switch says that it is none of the smooth ones")
        got = edges(done, "v(o)", 2.5)
        times(checker, got, [on, 0.01 - on], "a switch")
        checker.close(done.at("v(q)", 15e-3), 2.5, 1e-6, "a switch the other way round")


def products(checker, program):
    """mult and divide with all their parameters, of sines and of a ramp, against the numbers."""
    for scale, rate in ((1, 50), (1e-3, 1e3), (1e4, 0.2), (20, 1e6), (0.3, 7)):
        what = f"products of {scale} V at {rate} Hz"
        cards = [f"v1 a 0 sin(0 {scale!r} {rate!r})", f"v2 b 0 sin({3 * scale!r} {scale!r} {2 * rate!r})", f"v3 g 0 {0.5 * scale!r}",
                 "a1 [a b] m mm", ".model mm mult", "a2 [a b g] n nm",
                 f".model nm mult(in_offset=[{0.1 * scale!r} 0 {scale!r}] in_gain=[2 -1 0.5] out_gain=3 out_offset={scale!r})",
                 "a3 a b d dm", ".model dm divide", "a4 %vd(a g) %vd(b 0) q qm",
                 f".model qm divide(num_offset={scale!r} num_gain=2 den_offset={scale!r} den_gain=-4 out_gain=0.5 out_offset=1 "
                 "den_lower_limit=1u den_domain=1u fraction=false)",
                 "r1 m 0 1k", "r2 n 0 1k", "r3 d 0 1k", "r4 q 0 1k", f".tran {0.01 / rate!r} {1 / rate!r}"]
        done = run_cards(program, what, cards)
        if not runs(checker, done, what):
            continue
        for t, m, n, d, q in zip(done.time, *(done.column(f"v({x})") for x in "mndq")):
            a = scale * math.sin(2 * math.pi * rate * t)
            b = 3 * scale + scale * math.sin(4 * math.pi * rate * t)
            g = 0.5 * scale
            checker.close(m, a * b, 1e-8 * scale ** 2, f"{what}: a b at {t}")
            checker.close(n, 3 * 2 * (a + 0.1 * scale) * -b * 0.5 * (g + scale) + scale, 1e-7 * (scale ** 3 + scale),
                          f"{what}: three at {t}")
            checker.close(d, a / b, 1e-8, f"{what}: a/b at {t}")
            checker.close(q, 0.5 * 2 * (a - g + scale) / (-4 * (b + scale)) + 1, 1e-8, f"{what}: a quotient at {t}")


def held_divisors(checker, program):
    """divide with a limit of what is below, which passes 0 and jumps over it, against the numbers."""
    for scale, rate, limit, sign in ((1, 50, 0.2, 1), (1e-3, 1e3, 0.01, -1), (1e4, 0.2, 0.5, 1), (20, 1e6, 2, -1), (0.3, 7, 0.9, 1)):
        what = f"a divisor of {scale} V at {rate} Hz from {limit} on"
        for below in (f"sin(0 {scale!r} {rate!r})", f"pulse({-scale!r} {scale!r} 0 0 0 {0.5 / rate!r} {1 / rate!r})"):
            done = run_cards(program, what, [
                f"v1 a 0 {below}", f"v2 b 0 sin({3 * scale!r} {scale!r} {2 * rate!r})", "a5 b a l lm",
                f".model lm divide(den_lower_limit={limit * scale!r} den_gain={sign} out_gain=-3 out_offset=2 den_domain=1n)",
                "r5 l 0 1k", f".tran {0.01 / rate!r} {1 / rate!r}"])
            if not runs(checker, done, what):
                continue
            for t, a, b, l in zip(done.time, *(done.column(f"v({x})") for x in "abl")):
                if abs(a) > 1e-9 * scale:  # at 0 it jumps
                    held = math.copysign(max(abs(a), limit * scale), sign * a)
                    checker.close(l, 2 - 3 * b / held, 1e-7 * (1 + 9 / limit), f"{what}: b/a at {t}")


def transfers(checker, program):
    """s_xfer against LAPLACE with the same ratio, in steps and with offset and frequency, and against a closed form."""
    cases = (("num_coeff=[1] den_coeff=[1m 1]", "1/(1 + s*1m)"),
             ("num_coeff=[1 0] den_coeff=[1u 2m 1]", "s/(1u*s*s + 2m*s + 1)"),
             ("num_coeff=[2 3] den_coeff=[1 4] denormalized_freq=1k", "(2*s/1k + 3)/(s/1k + 4)"),
             ("num_coeff=[1] den_coeff=[1 0.5 1] denormalized_freq=6283.2 gain=5", "5/(s*s/6283.2**2 + 0.5*s/6283.2 + 1)"),
             ("num_coeff=[1 2 1] den_coeff=[1 3 3 1] denormalized_freq=500", "(s*s/250k + 2*s/500 + 1)/(s**3/500**3 + 3*s*s/250k + 3*s/500 + 1)"),
             ("num_coeff=[-1] den_coeff=[-1u -1]", "1/(1 + s*1u)"),
             ("num_coeff=[0 0 7] den_coeff=[1m 2] int_ic=[0]", "7/(2 + s*1m)"),
             ("num_coeff=[3] den_coeff=[2]", "1.5"),
             ("gain=-2 num_coeff=[1m 1] den_coeff=[4m 1] int_ic=[0 0]", "-2*(1m*s + 1)/(4m*s + 1)"),
             ("num_coeff=[1 100] den_coeff=[1 10 0] denormalized_freq=100", "(s/100 + 100)/(s*(s/100 + 10)/100)"))
    for model, ratio in cases:
        word = " uic" if "10 0]" in model else ""
        cards = ["v1 in 0 pulse(0 1 0.1m 0 0 3m 10m)", "a1 in o m", f".model m s_xfer({model})",
                 f"e1 p 0 laplace {{v(in)}} = {{{ratio}}}" if "s" in ratio else f"e1 p 0 in 0 {ratio}",
                 "a2 in q n", f".model n s_xfer({model} in_offset=0.25)", "v2 shifted in 0.25",
                 f"e2 u 0 laplace {{v(shifted)}} = {{{ratio}}}" if "s" in ratio else f"e2 u 0 shifted 0 {ratio}",
                 "r1 o 0 1k", "r2 p 0 1k", "r3 q 0 1k", "r4 u 0 1k", f".tran 50u 5m{word}"]
        done = run_cards(program, model, cards)
        if runs(checker, done, model):
            for mine, plain in (("v(o)", "v(p)"), ("v(q)", "v(u)")):
                size = max(map(abs, done.column(plain)))
                worst = max(abs(x - y) for x, y in zip(done.column(mine), done.column(plain)))
                checker.check(size > 0 and worst <= 1e-9 * size, f"{model}: {mine} is off by {worst} of {size}")
    done = run_cards(program, "a low pass", ["v1 in 0 pulse(0 2 1m 0 0 1 2)", "a1 in o m",
                                             ".model m s_xfer(num_coeff=[1] den_coeff=[0.5m 1])", "r1 o 0 1k", ".tran 0.1m 3m"])
    if runs(checker, done, "a low pass"):
        checker.close(done.at("v(o)", 3e-3), 2 * (1 - math.exp(-4)), 1e-8, "a low pass")


def refused(checker, program):
    cases = (("a1 a o m", ".model m d_tristate", "d_tristate is not supported: an output in high impedance has no logic value"),
             ("a1 a o m", ".model m s_xfer(num_coeff=[1 0 0] den_coeff=[1 1])", "improper: of degree 2 over 1"),
             ("a1 a o m", ".model m s_xfer(num_coeff=[1])", "den_coeff has from 1 to 11 numbers"),
             ("a1 a o m", ".model m s_xfer(num_coeff=[1] den_coeff=[1 1] int_ic=[2])", "begin at rest"),
             ("a1 a o m", ".model m divide(num_gain=2)", "'a1' has 2 ports, divide has 3"),
             ("a1 %i(a) o m", ".model m gain(gain=2)", "ports of type '%i' are not supported"),
             ("a1 a o m", ".model m gain(gian=2)", "gain has no parameter 'gian'"),
             ("a1 a o m", ".model m limit(out_lower_limit=2 out_upper_limit=1)", "out_lower_limit must be below"),
             ("a1 [a b] [o] m", ".model m adc_bridge", "'a1' has 2 inputs and 1 outputs"),
             ("a1 a o m", ".model m d_and(rise_delay=-1)", "'rise_delay' cannot be negative"),
             ("a1 a b o m", ".model m d_dff", "'a1' has 3 ports, d_dff has 6"),
             ("a1 a o m", ".model m d_fdiv(div_factor=1)", "0 < high_cycles < div_factor"),
             ("a1 a o m", ".model m pwl(x_array=[0 0] y_array=[1 2])", "those of x_array ascend"))
    for card, model, text in cases:
        done = run_cards(program, card, ["v1 a 0 1", "v2 b 0 1", card, model, "r1 o 0 1", ".tran 1 2"])
        checker.check(done.status != 0 and text in done.stderr, f"{card} {model}: {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("code_models")
    for part in (truth, ring, flip_flops, bridges, lines, states, products, held_divisors, transfers, refused):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
