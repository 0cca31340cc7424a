#!/usr/bin/env python3
"""Gates and flip-flops: oscillators, dividers, modulators and a latched converter, each against a closed form.

usage: logic.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402


def run_cards(program, what, cards):
    return run(program, "\n".join([what, *cards, ".end", ""]), method=None, tolerance=1e-10)


def edges(done, name, level):
    """Times at which a signal jumps through a level."""
    t, v = done.time, done.column(name)
    return [t[k] for k in range(1, len(t)) if t[k] == t[k - 1] and (v[k - 1] < level) != (v[k] < level)]


def times(checker, got, wanted, what, digits=1e-9):
    if checker.check(len(got) == len(wanted), f"{what}: {len(got)} edges, not {len(wanted)}: {got[:8]}"):
        for a, b in zip(got, wanted):
            checker.close(a, b, digits * abs(wanted[-1]), f"{what}: an edge")


def runs(checker, done, what):
    return checker.check(done.status == 0, f"{what}: {done.stderr}")


def ring(checker, program):
    """An odd number of inverters: a half period of all their delays."""
    for n, td in ((3, 1e-8), (5, 1e-3), (7, 3.0), (201, 2e-9)):
        what = f"a ring of {n}"
        cards = [f"a{k} n{k} 0 0 0 0 n{(k + 1) % n} 0 0 BUF Td={td!r}" for k in range(n)]
        done = run_cards(program, what, [*cards, "r1 n1 0 1k", f".tran {td!r} {4.5 * n * td!r}", ".save v(n1)"])
        if runs(checker, done, what):
            got = edges(done, "v(n1)", 0.5)
            half = [b - a for a, b in zip(got, got[1:])]
            checker.check(len(half) >= 3, f"{what}: {len(half)} half periods")
            for span in half:
                checker.close(span, n * td, 1e-9 * n * td, f"{what}: half a period")
            checker.check("connection" not in done.stderr, f"{what}: {done.stderr}")
            solved = done.report["work"]["osnsp"]
            checker.check(solved <= 10 * n, f"{what}: {solved} problems, where 4.5 {n} edges move one gate each")


def relaxation(checker, program):
    """R and C behind a Schmitt inverter: between the two thresholds by ln((E - Vl)/(E - Vh)), up and down."""
    for high, vt, vh, r, c in ((1, 0.5, 0.2, 1e3, 1e-6), (5, 2, 1, 1e5, 1e-12), (1e3, 400, 50, 0.1, 1)):
        what = f"a relaxation oscillator of {high} V"
        tau = r * c
        up = tau * math.log((high - vt + vh) / (high - vt - vh))
        down = tau * math.log((vt + vh) / (vt - vh))
        first = tau * math.log(high / (high - vt - vh))
        cards = [f"a1 c 0 0 0 0 o 0 0 SCHMITT Vhigh={high} Vt={vt} Vh={vh}", f"r1 o c {r!r}", f"c1 c 0 {c!r} ic=0",
                 f".tran {tau / 10!r} {first + 3.5 * (up + down)!r} uic"]
        done = run_cards(program, what, cards)
        if runs(checker, done, what):
            wanted = [first]
            for k in range(7):
                wanted.append(wanted[-1] + (down if k % 2 == 0 else up))
            times(checker, [t for t in edges(done, "v(o)", high / 2) if t > 0], wanted[:7], what)


def divider(checker, program):
    """Toggling flip-flops, the second clocked by the first; and a shift register on one clock, which takes what was."""
    for period, high in ((1e-6, 1), (2.0, 12)):
        cards = [f"v1 clk 0 pulse(0 {high} {period / 2!r} 0 0 {period / 2!r} {period!r})"]
        more = f"Vhigh={high}"
        cards += [f"a1 b1 0 clk 0 0 b1 q1 0 DFLOP {more}", f"a2 b2 0 q1 0 0 b2 q2 0 DFLOP {more}",
                  f"a3 q2 0 clk 0 0 0 s1 0 DFLOP {more}", f"a4 s1 0 clk 0 0 0 s2 0 DFLOP {more}",
                  "r1 q1 0 1k", "r2 s2 0 1k", f".tran {period / 10!r} {12 * period!r}"]
        what = f"a divider at {period} s"
        done = run_cards(program, what, cards)
        if runs(checker, done, what):
            times(checker, edges(done, "v(q1)", high / 2), [(k + 0.5) * period for k in range(12)], f"{what}: by two")
            by_four = [(2 * k + 0.5) * period for k in range(6)]
            times(checker, edges(done, "v(q2)", high / 2), by_four, f"{what}: by four")
            times(checker, edges(done, "v(s2)", high / 2), [t + 2 * period for t in by_four if t < 9.9 * period],
                  f"{what}: two clocks later")


def many_inputs(checker, program):
    """All values of five inputs, those of a binary counter: LTspice's XOR is 1 while one input is and no other."""
    functions = {"AND": all, "OR": any, "XOR": lambda bits: sum(bits) == 1}
    for n in range(2, 6):
        names = [f"i{k}" for k in range(n)] + ["0"] * (5 - n)
        cards = [f"v{k} i{k} 0 pulse(0 1 {2 ** k!r} 0 0 {2 ** k!r} {2 ** (k + 1)!r})" for k in range(n)]
        cards += [f"a{name} {' '.join(names)} 0 o{name} 0 {name}\nr{name} o{name} 0 1" for name in functions]
        done = run_cards(program, f"{n} inputs", [*cards, f".tran 0.25 {2 ** n}"])
        if runs(checker, done, f"{n} inputs"):
            for name, value in functions.items():
                for k in range(2 ** n):
                    wanted = value([k >> bit & 1 for bit in range(n)])
                    found = [v for t, v in zip(done.time, done.column(f"v(o{name})".lower())) if k < t < k + 1]
                    checker.check(all(v == wanted for v in found), f"{name} of {k:0{n}b}: {found}")


def root(f, low, high):
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if (f(middle) > 0) == (f(low) > 0) else (low, middle)
    return low


def modulator(checker, program):
    """Sine and triangle: each ramp is crossed once. Dead time: AND and NOR with what was a delay ago."""
    for f, carrier, depth, dead in ((1e3, 10e3, 0.8, 1e-6), (50, 450, 0.95, 2e-5)):
        half = 0.5 / carrier
        what = f"a modulator at {carrier} Hz"
        cards = [f"vs m 0 sin(0 {depth} {f})",
                 f"vt t 0 pulse(-1 1 0 {half!r} {half!r} {1e-9 * half!r} {2 * half * (1 + 5e-10)!r})",
                 "a1 m t 0 0 0 0 cmp 0 SCHMITT", f"a2 cmp 0 0 0 0 0 d 0 BUF Td={dead!r}",
                 "a3 cmp d 0 0 0 0 hi 0 AND", "a4 cmp d 0 0 0 lo 0 0 OR",
                 "v2 p 0 100", "s1 p x hi 0 sw", "s2 x 0 lo 0 sw", "d1 0 x", "d2 x p", "l1 x o 1m", "r1 o 0 10",
                 ".model sw sw(Ron=1m)", f".tran {half / 5!r} {1 / f!r}"]
        done = run_cards(program, what, cards)
        if runs(checker, done, what):
            period = 2 * half * (1 + 5e-10)
            wanted = []
            for k in range(round(carrier / f)):
                def rising(t, k=k):
                    return depth * math.sin(2 * math.pi * f * t) - (-1 + 2 * (t - k * period) / half)

                def falling(t, k=k):
                    top = k * period + half * (1 + 1e-9)
                    return depth * math.sin(2 * math.pi * f * t) - (1 - 2 * (t - top) / half)
                wanted += [root(rising, k * period, k * period + half),
                           root(falling, k * period + half * (1 + 1e-9), (k + 1) * period)]
            times(checker, edges(done, "v(cmp)", 0.5), wanted, what)
            times(checker, edges(done, "v(hi)", 0.5), [t + (dead if k % 2 else 0) for k, t in enumerate(wanted)],
                  f"{what}, the upper switch")
            times(checker, edges(done, "v(lo)", 0.5), [t + (0 if k % 2 else dead) for k, t in enumerate(wanted)],
                  f"{what}, the lower switch")


def peak_current(checker, program):
    """A clock closes, a comparator of the current opens; a stiff output makes straight lines of the current."""
    for e, o, coil, period, limit in ((10, 4, 1e-5, 1e-5, 4), (400, 100, 1e-3, 2e-5, 5), (1, 0.3, 1e-3, 1e-2, 3)):
        what = f"a peak-current buck of {e} V"
        cards = [f"v1 in 0 {e}", "s1 in x g 0 sw", "d1 0 x", f"l1 x o {coil!r} ic=0", f"v2 o 0 {o}",
                 f"vclk clk 0 pulse(0 1 {period!r} 0 0 {period / 100!r} {period!r})", "b1 cs 0 v=i(l1)",
                 f"vref ref 0 {limit}", "a1 cs ref 0 0 0 0 trip 0 SCHMITT", "a2 clk trip 0 0 0 0 g 0 SRFLOP",
                 ".model sw sw(Vt=0.5)", f".tran {period / 5!r} {8.9 * period!r} uic"]
        wanted, i = [], 0.0
        for k in range(1, 9):
            opened = k * period + (limit - i) * coil / (e - o)
            checker.check(opened < (k + 1) * period, f"{what}: the test is of times below a period")
            wanted += [k * period, opened]
            i = max(0.0, limit - o / coil * ((k + 1) * period - opened))
        done = run_cards(program, what, cards)
        if runs(checker, done, what):
            times(checker, edges(done, "v(g)", 0.5), [w for w in wanted if w < 8.9 * period], what)


def small(checker, program):
    """A glitch as long as a delay, outputs that ramp, a subcircuit, and a loop that has no delay."""
    glitch = ["v1 a 0 pulse(0 1 1u 0 0 3u 8u)", "a1 a 0 0 0 0 n 0 0 BUF Td=10n", "a2 a n 0 0 0 0 g 0 AND",
              "r1 g 0 1k", ".tran 1u 8u"]
    done = run_cards(program, "a glitch", glitch)
    if runs(checker, done, "a glitch"):
        times(checker, edges(done, "v(g)", 0.5), [1e-6, 1.01e-6], "a glitch")
    ramp = ["v1 a 0 pulse(0 5 1u 0 0 3u 8u)", "a1 a 0 0 0 0 0 r 0 BUF Vhigh=5 Trise=200n Tfall=400n Td=100n",
            "a2 r 0 0 0 0 0 o 0 BUF Ref=1", "r1 r 0 1k", "r2 o 0 1k", ".tran 0.1u 8u"]
    done = run_cards(program, "a ramp", ramp)
    if runs(checker, done, "a ramp"):
        times(checker, edges(done, "v(o)", 0.5), [1.1e-6 + 0.2e-6 / 5, 4.1e-6 + 0.4e-6 * 4 / 5], "a ramp")
    sub = [".subckt inv in out td=1n", "a1 in 0 0 0 0 out 0 0 BUF Td={td}", ".ends", "x1 c a inv td=2n",
           "x2 a b inv", "x3 b c inv td=3n", "r1 a 0 1k", ".tran 1n 50n"]
    done = run_cards(program, "a subcircuit", sub)
    if runs(checker, done, "a subcircuit"):
        got = edges(done, "v(a)", 0.5)
        for span in [b - a for a, b in zip(got, got[1:])]:
            checker.close(span, 6e-9, 1e-17, "a ring of subcircuits")
    loop = ["a1 c 0 0 0 0 a 0 0 BUF", "a2 a 0 0 0 0 b 0 0 BUF", "a3 b 0 0 0 0 c 0 0 BUF", "r1 a 0 1k", ".tran 1n 50n"]
    done = run_cards(program, "a loop", loop)
    checker.check(done.status != 0 and "a loop without delay does not settle: a1, a2, a3" in done.stderr,
                  f"a loop: {done.stderr}")
    for buffers in 0, 2:  # without a hysteresis: its output brings the capacitor back to the threshold at once
        passed = [f"b{k} b{k} 0 v=v({f'b{k - 1}' if k else 'q'})" for k in range(buffers)]
        back = f"b{buffers - 1}" if buffers else "q"
        held = ["v1 t 0 0.6", "a1 t x 0 0 0 0 q 0 SCHMITT vt=0 vh=0", *passed, f"r1 {back} x 1k", "c1 x 0 1n", ".tran 10n 5u uic"]
        done = run_cards(program, "a capacitor held at a threshold", held)
        checker.check(done.status != 0 and "does not settle: a1" in done.stderr,
                      f"a capacitor held at a threshold: {done.stderr}")
    latch = ["v1 s 0 1", "v2 i 0 pwl(0 0 10n 1)", "b1 r 0 v=u(v(q)*v(i)-0.5)", "a1 s r 0 0 0 0 q 0 SRFLOP", "r1 q 0 1k", ".tran 1n 50n"]
    done = run_cards(program, "a flip-flop that resets itself", latch)
    checker.check(done.status != 0 and "settle: a1" in done.stderr and "let the pulse at S end earlier" in done.stderr,
                  f"a flip-flop that resets itself: {done.stderr}")


def measured(checker, program):
    """Averages over whole periods of what an output is, what a coil behind it carries and what its switch lets pass."""
    for high, period, duty, delay in ((1, 1e-5, 0.4, 1e-6), (5, 1e-3, 0.25, 3e-4), (15, 2e-7, 0.7, 1e-8), (1e3, 10, 0.5, 4)):
        what = f"measured, {high} V"
        cards = [f"v1 a 0 pulse(0 1 0 0 0 {duty * period!r} {period!r})",
                 f"a1 a 0 0 0 0 nq q 0 BUF Vhigh={high} Ref=0.5 Td={delay!r}", "r1 q 0 1", "r2 nq 0 1k",
                 "vs p 0 24", "s1 p l q 0 sw", "r3 l 0 2", f".model sw sw(vt={high / 2} ron=0)",
                 f"s2 p m q 0 sw", f"l4 m n {period!r} ic=0", "r4 n 0 1", "d4 0 m d", ".model d d(ron=0)",
                 f".tran {period / 10!r} {40 * period!r} uic"]
        window = f"from={30 * period!r} to={40 * period!r}"
        cards += [f".meas tran {name} {how} {signal} {window}" for name, how, signal in (
            ("mean", "avg", "v(q)"), ("other", "avg", "v(nq)"), ("rms", "rms", "v(q)"), ("whole", "integ", "v(q)"),
            ("load", "avg", "v(l)"), ("coil", "avg", "i(l4)"))]
        done = run_cards(program, what, [*cards, f".losses {window} in=vs out=r3"])
        if runs(checker, done, what):
            got = {m["name"]: m["value"] for m in done.report["measurements"]}
            for name, wanted in (("mean", high * duty), ("other", high * (1 - duty)), ("rms", high * math.sqrt(duty)),
                                 ("whole", high * duty * 10 * period), ("load", 24 * duty), ("coil", 24 * duty)):
                checker.close(got[name], wanted, 1e-9 * wanted, f"{what}: {name}")
            power = {e["element"]: e["power"] for e in done.report["losses"][0]["elements"]}
            checker.close(power["r3"], 24 * 24 / 2 * duty, 1e-9 * 288, f"{what}: the power of a load")


def held(times, values, level, t):
    """Of what is taken at certain times: the value at t."""
    for at, value in zip(times, values):
        level = value if t >= at else level
    return level


def samples(checker, program):
    """What a clock takes of a sine, of itself one clock before, of a difference; and what a gate lets through."""
    for f, period, high, offset in ((1e3, 1.3e-4, 1, 0), (50, 7e-3, 5, 3), (2e6, 1e-7, 12, -400), (0.01, 11, 0.5, 1e-3)):
        what = f"samples of {f} Hz"
        amplitude = 2 * high
        more = f"ref={high / 2}"
        cards = [f"v1 in 0 sin({offset} {amplitude} {f!r})", f"v2 clk 0 pulse(0 {high} {period / 2!r} 0 0 {period / 3!r} {period!r})",
                 f"a1 in 0 clk 0 0 0 s1 0 SAMPLEHOLD {more} ic=-1", f"a2 s1 0 clk 0 0 0 s2 0 SAMPLEHOLD {more}",
                 f"a3 in s1 clk 0 0 0 s3 0 SAMPLEHOLD {more} rout=1k", f"a4 in 0 0 clk 0 0 s4 0 SAMPLEHOLD {more}",
                 "r1 s1 0 1k", "r2 s2 0 2k", "r3 s3 0 3k", "r4 s4 0 1k", f".tran {period / 7!r} {9.8 * period!r}"]
        done = run_cards(program, what, cards)
        if not runs(checker, done, what):
            continue

        def sine(t, f=f, offset=offset, amplitude=amplitude):
            return offset + amplitude * math.sin(2 * math.pi * f * t)
        clocks = [(k + 0.5) * period for k in range(10)]
        taken = [sine(t) for t in clocks]
        first = [-1, *taken]
        scale = abs(offset) + amplitude
        for t in [k * period / 7 for k in range(1, 68) if k % 7 not in (3, 4, 5, 6)] + [period * 5.58, period * 4.78]:
            row = min(done.time, key=lambda x, t=t: abs(x - t))
            before = [k for k in range(10) if clocks[k] <= row]
            wanted = {"v(s1)": held(clocks, taken, -1, row), "v(s2)": held(clocks, first, 0, row),
                      "v(s3)": 0.75 * held(clocks, [a - b for a, b in zip(taken, first)], 0, row)}
            last = clocks[before[-1]] if before else 0.0
            wanted["v(s4)"] = 0.0 if not before else sine(min(row, last + period / 3))
            for name, value in wanted.items():
                checker.close(done.at(name, row), value, 3e-9 * scale, f"{what}: {name} at {row!r}")


def sampled_control(checker, program):
    """A sampled PI loop on R and C: its values at the clocks are those of the difference equation. The sampling of an
    integrator by itself: 1 + T/C of growth each clock. Exponential diodes elsewhere change nothing: the runs that find
    their currents sample as well."""
    diodes = ["d1 ref x real", "r2 x 0 1k", "d2 clk z 1n4148", "r3 z 0 10k", ".model real d(is=1e-14 rs=10m)"]
    for r, c, period, kp, beside in ((1e3, 1e-6, 1e-4, 0.5, []), (10, 1e-3, 1e-2, 0.9, []), (1e6, 1e-12, 5e-7, 0.2, []),
                                     (1e3, 1e-6, 1e-4, 0.5, diodes), (20, 1e-3, 1e-2, 0.9, diodes[:2] + diodes[4:]),
                                     (1e6, 1e-12, 5e-7, 0.2, diodes + [".losses", ".meas tran m avg v(x)*i(d1)"])):
        what = f"a sampled loop of {period} s beside {len(beside)} cards"
        tau = r * c
        cards = [f"v1 clk 0 pulse(0 1 {period!r} 0 0 {period / 2!r} {period!r})", "vr ref 0 2",
                 f"b1 u 0 v={kp}*(v(ref)-v(y))", "a1 u 0 clk 0 0 0 h 0 SAMPLEHOLD", f"r1 h y {r!r}", f"c1 y 0 {c!r} ic=0",
                 *beside, f".tran {period / 3!r} {12.5 * period!r} uic"]
        done = run_cards(program, what, cards)
        if runs(checker, done, what):
            y, h, decay = 0.0, 0.0, math.exp(-period / tau)
            for k in range(1, 13):
                y = h + (y - h) * decay
                h = kp * (2 - y)
                checker.close(done.at("v(h)", k * period), h, 1e-8, f"{what}: clock {k}")
    what = "an integrator that samples itself"
    cards = ["v1 clk 0 pulse(0 1 1 0 0 0.5 1)", "a1 x 0 clk 0 0 0 h 0 SAMPLEHOLD ic=1", "g1 0 x h 0 0.25", "c1 x 0 1 ic=1",
             ".tran 0.3 20.5 uic"]
    done = run_cards(program, what, cards)
    if runs(checker, done, what):
        x, h = 1.0, 1.0
        for k in range(1, 21):
            x += 0.25 * h
            h = x
            checker.close(done.at("v(h)", k), h, 1e-8 * h, f"{what}: clock {k}")


def counters(checker, program):
    """Cycles and duty, a reset that holds, a chain, and a clock that is a gate's."""
    for cycles, duty, high, period in ((2, 0.5, 1, 1e-6), (3, 0.34, 5, 1e-3), (10, 0.3, 12, 2.0), (7, 0.01, 1, 1e-9),
                                       (5, 0.99, 3, 1e-5)):
        what = f"a counter of {cycles}"
        n_high = min(max(round(duty * cycles), 1), cycles - 1)
        cards = [f"v1 clk 0 pulse(0 {high} {period / 2!r} 0 0 {period / 2!r} {period!r})",
                 f"v2 rst 0 pulse(0 {high} {20.25 * period!r} 0 0 {3 * period!r} {100 * period!r})",
                 f"a1 clk 0 0 0 0 qb q 0 COUNTER cycles={cycles} duty={duty} Vhigh={high}",
                 f"a2 clk rst 0 0 0 0 r 0 COUNTER cycles={cycles} duty={duty} Vhigh={high} td={period / 10!r}",
                 f"a3 q 0 0 0 0 0 c 0 COUNTER Vhigh={high}", "r1 q 0 1k", "r2 qb 0 1k", "r3 r 0 1k", "r4 c 0 1k",
                 f".tran {period / 3!r} {40 * period!r}"]
        done = run_cards(program, what, cards)
        if runs(checker, done, what):
            clocks = [(k + 0.5) * period for k in range(40)]
            wanted = [t for k, t in enumerate(clocks) if k % cycles in (0, n_high)]
            times(checker, edges(done, "v(q)", high / 2), wanted, what)
            times(checker, edges(done, "v(qb)", high / 2), wanted, f"{what}, its complement")
            times(checker, edges(done, "v(c)", high / 2), clocks[::cycles], f"{what}, chained")
            delayed = [t for k, t in enumerate(clocks) if t < 20.25 * period and k % cycles in (0, n_high)]
            if len(delayed) % 2 == 1:
                delayed.append(20.25 * period)
            again = [t for t in clocks if t > 23.25 * period]
            delayed += [t for k, t in enumerate(again) if k % cycles in (0, n_high)]
            delayed = [t + period / 10 for t in delayed]
            times(checker, edges(done, "v(r)", high / 2), [t for t in delayed if t < 40 * period], f"{what}, reset")


def refused(checker, program):
    """Words for what is not there."""
    cases = (("a1 a 0 b 0 0 0 o 0 SAMPLEHOLD td=1n", "samplehold has no parameter 'td'"),
             ("a1 a 0 0 0 0 0 o 0 COUNTER cycles=2.5", "a whole number of clocks"),
             ("a1 a 0 0 0 0 0 o 0 COUNTER duty=1", "duty= of a counter is above 0 and below 1"),
             ("a1 a 0 0 0 0 0 o 0 COUNTER vt=1", "counter has no parameter 'vt'"),
             ("a1 a 0 0 0 0 0 o 0 AND cycles=3", "a gate has no parameter 'cycles'"))
    for card, text in cases:
        done = run_cards(program, card, ["v1 a 0 1", "v2 b 0 1", card, "r1 o 0 1", ".tran 1 2"])
        checker.check(done.status != 0 and text in done.stderr, f"{card}: {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("logic")
    for part in (ring, relaxation, divider, many_inputs, modulator, peak_current, small, measured, samples, sampled_control, counters,
                 refused):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
