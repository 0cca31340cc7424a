#!/usr/bin/env python3
"""Latches and flip-flops whose inputs change at one instant, through different numbers of gates.

usage: simultaneous_inputs.py PROGRAM

A gate without delay takes no time, so what a latch makes of two edges does not depend on how many gates each has passed.
A counter behind each output shows pulses of no width.
"""

import itertools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

BRIDGES = [".model adc adc_bridge(in_low=0.5 in_high=0.5)", ".model inv d_inverter(rise_delay=0 fall_delay=0)"]
NO_DELAY = "clk_delay=0 set_delay=0 reset_delay=0 rise_delay=0 fall_delay=0"


def pulse(node, delay, width, period=10, high=1):
    return f"V{node} {node} 0 PULSE(0 {high} {delay}u 0 0 {width}u {period}u)"


def chain(node, n, name):
    """(cards, node behind n gates, of kinds that pass their input on)"""
    kinds = itertools.cycle(["{0} 0 0 0 0 0 {1} 0 OR", "{0} {0} 0 0 0 0 {1} 0 AND", "{0} 0 0 0 0 0 {1} 0 BUF"])
    cards = []
    for k in range(n):
        cards.append(f"A{name}{k} " + next(kinds).format(node, f"{name}{k}"))
        node = f"{name}{k}"
    return cards, node


def at(done, name, time):
    """In the row nearest to a time at which nothing happens."""
    k = min(range(len(done.time)), key=lambda i: abs(done.time[i] - time))
    return done.column(name)[k]


def check(checker, program, what, cards, wanted, stop=36, method=None):
    """wanted: {microseconds: level of q}, and under "rises" how often q rises."""
    netlist = [what, *cards, "Ak q 0 0 0 0 0 k 0 COUNTER cycles=2", "Rq q 0 1k", "Rk k 0 1k", ".save v(q) v(k)",
               f".tran 0.1u {stop}u uic", ".end", ""]
    done = run(program, "\n".join(netlist), method=method, step=2e-8 if method else None, report=False)
    if not checker.check(done.status == 0, f"{what}: exit {done.status}\n{done.stderr}"):
        return
    shown = done.column("v(k)")
    rises = sum((a > 0.5) != (b > 0.5) for a, b in zip(shown, shown[1:]))
    checker.check(rises == wanted["rises"], f"{what}: q rises {rises} times, not {wanted['rises']}")
    for t, level in wanted.items():
        if t != "rises":
            checker.close(at(done, "v(q)", t * 1e-6), level, 1e-9, f"{what}: q at {t} us")


def latches(checker, program):
    """Set from 1 us on for `on`, reset from `late` on for `clear`, with edges that coincide."""
    never = {"rises": 0, 1.5: 0, 2.5: 0, 9.5: 0, 35.5: 0}
    edges = {  # of set and reset: what q does
        "both fall together": (pulse("s", 1, 1), pulse("r", 1, 1), never),
        "both rise together, set falls first": (pulse("s", 1, 1), pulse("r", 1, 2), never),
        "set rises where reset falls": (pulse("s", 2, 1), pulse("r", 1, 1), {"rises": 4, 1.5: 0, 2.5: 1, 9.5: 1, 11.5: 0}),
        "set falls where reset rises": (pulse("s", 1, 1), pulse("r", 2, 1), {"rises": 4, 1.5: 1, 2.5: 0, 9.5: 0, 11.5: 1}),
    }
    for (what, (s, r, wanted)), n, m in some_of(list(itertools.product(edges.items(), range(4), range(4)))):
        for method in (None, "euler"):
            on_s, set_node = chain("s", n, "x")
            on_r, reset_node = chain("r", m, "y")
            check(checker, program, f"{what}, behind {n} and {m} gates, {method or 'auto'}",
                  [s, r, *on_s, *on_r, f"A1 {set_node} {reset_node} 0 0 0 0 q 0 SRFLOP"], wanted, method=method)
    behind = [pulse("s", 1, 1), pulse("r", 1, 1), "A2 s 0 0 0 0 0 l 0 SRFLOP", "A1 s l 0 0 0 0 q 0 SRFLOP"]
    check(checker, program, "reset by a latch that the same edge sets", behind, never)
    with_enable = [pulse("s", 1, 1), "Vd d 0 1", "Ax [s d] [sd dd] adc", "Ay dd sd null sd qd null lat", "Az [qd] [q] dac",
                   *BRIDGES, ".model lat d_dlatch(data_delay=0 enable_delay=0 set_delay=0 reset_delay=0 rise_delay=0 "
                   "fall_delay=0)", ".model dac dac_bridge(out_low=0 out_high=1)"]
    check(checker, program, "a d_dlatch enabled and reset at once", with_enable, never)


def modulator(checker, program):
    """A carrier that falls at the clock that sets the latch; its comparator resets it, through gates or not."""
    for n in range(3):
        gates, node = chain("cmp", n, "x")
        cards = [pulse("c", 10, 1), "Vr r 0 PULSE(0 1 0 10u 0 0 10u)", "Vd d 0 0.25", "B1 cmp 0 V=if(v(r)>v(d),1,0)",
                 *gates, f"A1 c {node} 0 0 0 0 q 0 SRFLOP"]
        check(checker, program, f"a ramp that its clock resets, behind {n} gates", cards,
              {"rises": 3, 10.5: 1, 12.4: 1, 12.6: 0, 32.4: 1, 32.6: 0})
    deck = ["Vc c 0 PULSE(0 4 0 9.9u 0.1u 0 10u)", "Vd d 0 1.6", "B1 n2 0 V=if(v(c)-v(d)>0,1,0)",
            "A1 n2 n4 0 0 0 0 n5 0 OR", "Vo n4 0 PULSE(0 5 9.5u 1n 1n 0.5u 10u)", "Vf n6 0 PULSE(0 5 0 1n 1n 0 10u)",
            "A2 n5 n6 0 0 0 q 0 0 SRFLOP"]
    off = 1.6 / 4.0 * 9.9
    check(checker, program, "a least and a longest time on, whose clocks fall together", deck,
          {"rises": 3, 0.5: 1, off - 0.1: 1, off + 0.1: 0, 9.9: 0, 10.5: 1, 30 + off - 0.1: 1, 30 + off + 0.1: 0})


def flip_flops(checker, program):
    never, taken = {"rises": 0, 1.5: 0, 9.5: 0, 35.5: 0}, {"rises": 1, 0.5: 0, 1.5: 1, 9.5: 1, 35.5: 1}
    for n, m in ((0, 0), (0, 2), (2, 0), (1, 3)):
        clocked, clock = chain("s", n, "x")
        other, node = chain("o", m, "y")
        what = f"behind {n} and {m} gates"
        check(checker, program, f"clear and clock together, {what}",
              [pulse("s", 1, 1), pulse("o", 1, 2), "Vd d 0 1", *clocked, *other, f"A1 d 0 {clock} 0 {node} 0 q 0 DFLOP"], never)
        check(checker, program, f"data that rise with the clock, {what}",
              [pulse("s", 1, 1), pulse("o", 1, 3), *clocked, *other, f"A1 {node} 0 {clock} 0 0 0 q 0 DFLOP"], taken)
        check(checker, program, f"data that fall with the clock, {what}",
              [pulse("s", 3, 1), pulse("o", 1, 2), *clocked, *other, f"A1 {node} 0 {clock} 0 0 0 q 0 DFLOP"], never)
        others, second = chain("s", m, "y")
        check(checker, program, f"two stages of a shift register, {what}",
              [pulse("s", 1, 1), pulse("d", 5, 100, 200), *clocked, *others, f"A1 d 0 {clock} 0 0 0 h 0 DFLOP",
               f"A2 h 0 {second} 0 0 0 q 0 DFLOP"], {"rises": 1, 10.9: 0, 11.1: 0, 20.9: 0, 21.1: 1})
    for way, cards in ({"straight": []} | WAYS).items():  # a clear that a flip-flop of the same clock takes away has been there
        let_go = [pulse("s", 1, 1), "A2 one 0 s 0 0 n o 0 DFLOP", "Ro o 0 1k", "Rn n 0 1k", *MODELS,
                  *[card.format(s="n", n="p") for card in cards]]
        clear = "p" if cards else "n"
        check(checker, program, f"a counter let go by its own clock, {way}", [*let_go, f"A1 s {clear} 0 0 0 0 q 0 COUNTER cycles=2"],
              {"rises": 2, 1.5: 0, 9.5: 0, 11.5: 1, 21.5: 0, 31.5: 1})
        check(checker, program, f"a flip-flop let go by its own clock, {way}", [*let_go, f"A1 one 0 s 0 {clear} 0 q 0 DFLOP"],
              {"rises": 1, 1.5: 0, 9.5: 0, 11.5: 1, 21.5: 1, 31.5: 1})
    jk = [pulse("s", 1, 1), pulse("j", 1, 3), "Ax [s j] [sd jd] adc", "Ay jd kd inv", "Az jd kd sd null null qd null jk",
          "Aw [qd] [q] dac", *BRIDGES, f".model jk d_jkff({NO_DELAY})", ".model dac dac_bridge(out_low=0 out_high=1)"]
    check(checker, program, "J and K that change places with the clock", jk, taken)


WAYS = {  # of a signal of 0 and 1 V to another node, in no time; some hold it below 1 V
    "a divider": ["Ra{n} {s} {n} 1k", "Rb{n} {n} 0 100k"],
    "E": ["E{n} {n} 0 {s} 0 1"],
    "E behind a resistor": ["E{n} {n}x 0 {s} 0 1", "Ra{n} {n}x {n} 1", "Rb{n} {n} 0 1k"],
    "G on a resistor": ["G{n} 0 {n} {s} 0 1m", "R{n} {n} 0 1k"],
    "a formula": ["B{n} {n} 0 V=0.9*v({s})"],
    "a clipped formula": ["B{n} {n} 0 V=min(2*v({s}),0.9)"],
    "a diode": ["D{n} {s} {n} ideal", "R{n} {n} 0 1k"],
    "a closed switch": ["S{n} {s} {n} one 0 sw", "R{n} {n} 0 1k"],
    "a resistor and a capacitor behind another": ["Ra{n} {s} {n} 1k", "Rb{n} {n} {n}x 100k", "C{n} {n}x 0 1u"],
    "a hold that tracks": ["A{n} {s} 0 0 one 0 0 {n} 0 SAMPLEHOLD", "R{n} {n} 0 1k"],
    "a buffer and a resistor": ["A{n} {s} 0 0 0 0 0 {n}x 0 BUF", "Ra{n} {n}x {n} 1k", "Rb{n} {n} 0 100k"],
}
MODELS = ["Vone one 0 1", ".model ideal D(Ron=0)", ".model sw sw(vt=0.5 ron=0 roff=1g)"]


def ways(checker, program):
    """Both inputs are the signal s. It comes to one of them straight, to the other one through the circuit."""
    never = {"rises": 0, 1.5: 0, 2.5: 0, 9.5: 0, 35.5: 0}
    behind = {
        "set and reset": ["A1 {a} {b} 0 0 0 0 q 0 SRFLOP"],
        "a counter and its reset": ["A1 {a} {b} 0 0 0 0 q 0 COUNTER cycles=2"],
        "a counter of what an AND has of a signal and its inverse": [
            "A2 {b} 0 0 0 0 nb 0 0 INV", "Rn nb 0 1k", "A3 {a} nb 0 0 0 0 g 0 AND", "Rg g 0 1k", "A1 g 0 0 0 0 0 q 0 COUNTER cycles=2"],
        "data and a clock that is their inverse": ["A2 {b} 0 0 0 0 nb 0 0 INV", "A1 {a} 0 nb 0 0 0 q 0 DFLOP"],
        "a clock and its clear": ["A1 one 0 {a} 0 {b} 0 q 0 DFLOP"],
        "a difference, read behind a resistor": [
            "A2 {a} {b} 0 0 0 0 x 0 XOR", "Rx x y 1k", "Ry y 0 9k", "A1 y 0 0 0 0 0 q 0 COUNTER cycles=2"],
    }
    sources = {"in the run": "PULSE(0 1 1u 0 0 1u 10u)", "at its start": "PULSE(1 0 1u 0 0 9u 10u)"}
    cases = itertools.product(behind.items(), WAYS.items(), sources.items(), (False, True))
    for (what, cards), (way, path), (when, source), is_first in some_of(list(cases)):
        if "tracks" in way and when != "in the run":
            continue  # it begins to track at 0, and that is a change of what has memory
        a, b = ("p", "s") if is_first else ("s", "p")
        deck = [f"Vs s 0 {source}", *[card.format(s="s", n="p") for card in path], *[card.format(a=a, b=b) for card in cards], *MODELS]
        check(checker, program, f"{what}, {'the first' if is_first else 'the second'} through {way}, {when}", deck, never)
    for way, path in WAYS.items():
        stages = ["Vs s 0 PULSE(0 1 1u 0 0 1u 10u)", "Vd d 0 PULSE(0 1 5u 0 0 100u 200u)", *MODELS,
                  *[card.format(s="s", n="p") for card in path], "A1 d 0 s 0 0 0 h 0 DFLOP", "Rh h hx 1k", "Ri hx 0 9k"]
        check(checker, program, f"two stages of a shift register, the second clock through {way}",
              [*stages, "A2 hx 0 p 0 0 0 q 0 DFLOP"], {"rises": 1, 10.9: 0, 11.1: 0, 20.9: 0, 21.1: 1})


def legs(checker, program):
    """Both switches of a leg move at one instant, whichever way they are told to: its fuse, a latch of the current, stays."""
    leg = ["Vin in 0 24", "Rsh in a 10m", "S1 a sw {high} 0 swm", "S2 sw 0 {low} 0 swm", "R1 sw m 10", "C1 m 0 100u ic=12",
           "E1 c 0 in a 100", "A9 c 0 0 0 0 0 q 0 SRFLOP ref=20", ".model swm sw(vt=0.5 ron=10m)"]
    source, divider = "Vp p 0 PULSE(0 1 1u 0 0 5u 10u)", ["Ra p pa 1k", "Rb pa 0 9k"]
    inverter, toggle = "A1 {node} 0 0 0 0 n 0 0 INV", ["Vt t 0 PULSE(0 1 1u 0 0 2u 5u)", "A1 n 0 t 0 0 n x 0 DFLOP", "Rx x 0 1k"]
    for what, drive, high, low in (
            ("an inverter", [inverter.format(node="p")], "p", "n"),
            ("an inverter behind a divider", [*divider, inverter.format(node="pa")], "pa", "n"),
            ("a formula", ["B1 n 0 V={1-v(p)}"], "p", "n"),
            ("a flip-flop", toggle, "p", "n"),
            ("a flip-flop, and a divider", [*divider, *toggle], "pa", "n"),
            ("both outputs of a flip-flop", ["A1 n 0 p 0 0 n x 0 DFLOP", "Rx x 0 1k"], "x", "n")):
        check(checker, program, f"a leg of {what}", [source, *drive, *[card.format(high=high, low=low) for card in leg], "Rn n 0 1k"],
              {"rises": 0, 0.5: 0, 1.5: 0, 6.5: 0, 35.5: 0})


def loops(checker, program):
    """A reset that its own output takes away, of counters of 3 and of 5 states by flip-flops that toggle; NORs that race."""
    ripple = [pulse("s", 1, 1), "A1 ab 0 s 0 c ab a 0 DFLOP", "A2 qb 0 ab 0 c qb q 0 DFLOP", "A3 a q 0 0 0 0 c 0 AND"]
    check(checker, program, "two toggles, cleared at 3", ripple, {"rises": 2, 5: 0, 15: 1, 25: 0, 35: 0}, stop=48)
    five = [pulse("s", 1, 1), "A1 ab 0 s 0 c ab a 0 DFLOP", "A2 bb 0 ab 0 c bb b 0 DFLOP", "A3 qb 0 bb 0 c qb q 0 DFLOP",
            "A4 a q 0 0 0 0 c 0 AND", "R4 b 0 1k"]
    check(checker, program, "three toggles, cleared at 5", five,
          {"rises": 2, 25: 0, 35: 1, 45: 0, 75: 0, 85: 1, 95: 0}, stop=98)
    cross = ["a latch of NORs, let go at once", pulse("s", 1, 1), pulse("r", 1, 1), "A1 r p 0 0 0 q 0 0 OR", "A2 s q 0 0 0 p 0 0 OR",
             "R1 q 0 1k", ".tran 1u 5u uic", ".end", ""]
    done = run(program, "\n".join(cross), report=False)
    checker.check(done.status == 3 and "a1, a2" in done.stderr and "2e-06" in done.stderr,
                  f"a latch of NORs: exit {done.status}\n{done.stderr}")


def main():
    checker = Checker("simultaneous_inputs")
    for part in (latches, modulator, flip_flops, ways, legs, loops):
        part(checker, sys.argv[1])
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
