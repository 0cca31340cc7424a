#!/usr/bin/env python3
"""Gates and flip-flops in .op, .dc and .ac, and where .ic hold the start of a .tran.

usage: logic_at_rest.py PROGRAM
"""

import itertools
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402
from logic import run_cards, runs  # noqa: E402


def points(checker, program):
    """Networks of gates at the operating point, whatever their order in the netlist: all inputs of an adder of n bits, each
    level its own voltage, some through dividers; the same rows by .op, by .dc over the last input, and at the start of
    a .tran."""
    for n, high in ((1, 1), (2, 5), (3, 3.3), (4, 1e3)):
        for bits in itertools.islice(itertools.product((0, 1), repeat=2 * n), 0, None, 1 if n < 3 else 7):
            a, b = bits[:n], bits[n:]
            wanted = sum(x << k for k, x in enumerate(a)) + sum(x << k for k, x in enumerate(b))
            cards = [f"va{k} a{k} 0 {high * x!r}" for k, x in enumerate(a)] + [f"vb{k} b{k} 0 {high * x!r}" for k, x in enumerate(b)]
            more = f"Vhigh={high!r}"
            gates = ["vc c0 0 0"]
            for k in range(n):
                gates += [f"ax{k} a{k} b{k} 0 0 0 0 x{k} 0 XOR {more}", f"as{k} x{k} c{k} 0 0 0 0 s{k} 0 XOR {more}",
                          f"an{k} a{k} b{k} 0 0 0 0 n{k} 0 AND {more}", f"am{k} x{k} m{k} 0 0 0 0 y{k} 0 AND {more} Ref={high / 4!r}",
                          f"rm{k} c{k} m{k} 1k", f"rn{k} m{k} 0 1k", f"ao{k} n{k} y{k} 0 0 0 0 c{k + 1} 0 OR {more} Td=1u"]
            cards += gates[::-1] + ["rc c%d 0 1k" % n]
            for card in (".op", f".dc vb{n - 1} 0 {high * b[-1]!r} {high!r}" if b[-1] else f".dc vb{n - 1} {high!r} 0 {-high!r}", ".tran 1u 1m"):
                what = f"{a} + {b}, {card}"
                done = run_cards(program, what, [*cards, card])
                if runs(checker, done, what):
                    got = sum((done.column(f"v({'s%d' % k if k < n else 'c%d' % n})")[-1] > high / 2) << k for k in range(n + 1))
                    checker.check(got == wanted, f"{what}: {got}")


def sweeps(checker, program):
    """A Schmitt trigger's loop up and down in both spellings, a latch that a sweep sets and resets; a hysteresis between
    analog and digital; a threshold that a divider makes."""
    for vt, vh, step in ((0.5, 0.2, 0.05), (2, 1, 0.25), (40, 10, 1), (-1e-3, 5e-4, 1e-4)):
        top, bottom = vt + 3 * vh, vt - 3 * vh
        what = f"a loop about {vt}"
        n = round((top - bottom) / step)
        done = {}
        for way, card in (("up", f".dc v1 {bottom!r} {top!r} {step!r}"), ("down", f".dc v1 {top!r} {bottom!r} {-step!r}")):
            cards = ["v1 a 0 0", f"a1 a 0 0 0 0 0 q 0 SCHMITT Vt={vt!r} Vh={vh!r} Vhigh=5", "a2 [a] [d] m", "a3 ~d o n", "r1 q 0 1k",
                     f".model m adc_bridge(in_low={vt - vh!r} in_high={vt + vh!r})", ".model n dac_bridge(out_high=7)", "r2 o 0 1k",
                     card]
            cards[3] = "a3 [~d] [o] n"
            done[way] = run_cards(program, what, cards)
            if runs(checker, done[way], what):
                for k, (q, o) in enumerate(zip(done[way].column("v(q)"), done[way].column("v(o)"))):
                    x = bottom + k * step if way == "up" else top - k * step
                    limit = vt + vh if way == "up" else vt - vh
                    if abs(x - limit) > 1e-9 * abs(vt):
                        checker.check((q == 5) == (x > limit), f"{what}, {way}: {q} at {x}")
                        checker.check((o == 0) == (x > limit), f"{what}, {way}: {o} at {x}")
                checker.check(len(done[way].column("v(q)")) == n + 1, what)
    cards = ["v1 a 0 0", "b1 s 0 V=v(a) > 1.2 ? 1 : 0", "b2 r 0 V=v(a) > 3.2 ? 1 : 0", "a1 s r 0 0 0 nq q 0 SRFLOP", "r1 q 0 1k",
             "a2 a 0 clk 0 0 0 h 0 SAMPLEHOLD IC=0.7", "vc clk 0 1", "a3 q 0 clk 0 0 0 f 0 DFLOP", "r2 h 0 1k", "r3 f 0 1k",
             ".dc v1 0 5 0.5 "]
    done = run_cards(program, "memories in a sweep", cards)
    if runs(checker, done, "memories in a sweep"):
        for k, (q, h, f) in enumerate(zip(*(done.column(f"v({x})") for x in "qhf"))):
            checker.check((q == 1) == (1.2 < 0.5 * k < 3.2), f"a latch at {0.5 * k}: {q}")
            checker.check(h == 0.7 and f == 0, f"no clock rises in a sweep: {h}, {f}")


def small_signals(checker, program):
    """Gates put out no small signal, and choose by their levels what a small signal sees."""
    for level, r, c in ((0, 1e3, 1e-6), (1, 1e3, 1e-6), (1, 50, 1e-9), (0, 1e5, 1e-12), (1, 3, 0.1)):
        f = 1 / (2 * math.pi * r * c)
        cards = [f"v1 g 0 {5 * level}", "a1 g 0 0 0 0 n y 0 BUF Vhigh=5", "s1 x o y 0 sw", "s2 z o n 0 sw", ".model sw sw(vt=2.5)",
                 f"rx in x {r!r}", f"rz in z {4 * r!r}", f"c1 o 0 {c!r}", "v2 in 0 dc 0 ac 1", f"ra y a {r!r}", f"ca a 0 {c!r}",
                 f".ac dec 5 {f / 10!r} {f * 10!r}", ".save v(o) v(a)"]
        what = f"{level}, {r} ohm"
        done = run_cards(program, what, cards)
        if runs(checker, done, what):
            real = next(k for k, name in enumerate(done.names) if "v(o)" in name)
            for row in done.rows:
                h = 1 / complex(1, row[0] / f * (1 if level else 4))
                got = complex(row[real], row[real + 1])
                checker.check(abs(got - h) < 1e-9, f"{what} at {row[0]}: {got}, not {h}")
                checker.check(abs(row[real + 2]) < 1e-12, f"{what}: a gate has a small signal")


def starts(checker, program):
    """With .ic gates are at rest with the voltages that are held, at once."""
    for hold, q in ((0.2, 0), (0.7, 1), (3, 1)):
        cards = ["v1 a 0 2", f".ic v(o)={hold!r}", "a1 o 0 0 0 0 nq q 0 BUF Vhigh=4 Ref=0.5", "a2 q 0 0 0 0 0 p 0 BUF Ref=2", "r1 a o 1k",
                 "c1 o 0 1u", "a3 p 0 0 0 0 0 s 0 SRFLOP", "r2 q 0 1k", "r3 s 0 1k", ".tran 10u 0.1m"]
        done = run_cards(program, f"held at {hold}", cards)
        if runs(checker, done, f"held at {hold}"):
            first = {name: done.column(f"v({name})")[0] for name in "opqs"}
            checker.close(first["o"], hold, 1e-12, "held")
            checker.check((first["q"], first["p"], first["s"]) == (4 * q, q, q), f"held at {hold}: {first}")
            checker.check(done.time.count(0.0) == 1, f"held at {hold}: an edge at 0")


def words(checker, program):
    cards = ["v1 a 0 1", "a1 a 0 0 0 0 0 o 0 BUF", "r1 o x 1k", "c1 x 0 1u"]
    loop = ["a1 a 0 0 0 0 o 0 0 BUF", "r1 o a 1k", "c1 a 0 1u"]
    done = run(program, "\n".join(["x", *loop, ".op", ".end", ""]), method=None, quiet=False)
    checker.check("gates do not settle at the operating point: a1" in done.stderr, done.stderr)
    done = run(program, "\n".join(["x", *cards, ".op", ".end", ""]), method=None, quiet=False)
    checker.check("no rest" not in done.stderr, done.stderr)


def held(checker, program):
    """A latch, a flip-flop and a counter keep what IC= says where nothing sets or clears them, though an inverter before
    them would while its own input is not there yet; in both orders of the cards, and through 1 to 3 inverters."""
    memories = (("{x} 0 0 0 0 0 q 0 SRFLOP", 0), ("0 {x} 0 0 0 0 q 0 SRFLOP IC=1", 1), ("0 0 0 {x} 0 0 q 0 DFLOP", 0),
                ("0 0 0 0 {x} 0 q 0 DFLOP IC=1", 1), ("0 {x} 0 0 0 0 q 0 COUNTER IC=1", 1))
    for (memory, wanted), n, is_first, card in itertools.product(memories, (1, 2, 3), (False, True), (".op", ".tran 1u 1m")):
        cards = [f"v1 a 0 {n % 2}", "r1 a x0 1k", "r2 x0 0 9k"]
        for k in range(n):
            cards += [f"ai{k} x{k} 0 0 0 0 y{k + 1} 0 0 INV", f"rx{k} y{k + 1} x{k + 1} 1k", f"ry{k} x{k + 1} 0 9k"]
        latch = ["am " + memory.format(x=f"x{n}"), "rq q 0 1k"]
        what = f"{memory}, {n} inverters, {'first' if is_first else 'last'}, {card}"
        done = run_cards(program, what, [*(latch + cards if is_first else cards + latch), card])
        if runs(checker, done, what):
            checker.close(done.column("v(q)")[-1], wanted, 1e-9, what)


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("logic_at_rest")
    for part in (points, sweeps, small_signals, starts, words, held):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
