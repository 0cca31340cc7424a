#!/usr/bin/env python3
"""Switches whose control reads the circuit: where they stand at one instant, against closed forms.

usage: switch_positions.py PROGRAM

Where one opens as another closes, where each moves the next, where one holds itself: positions on the way may have no
answer (a current without a way to go), and agree with nothing. Every circuit is there in several sizes, and the audit
looks at all of it.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

LN, EXP = math.log, math.exp


class Positions(Checker):
    def measured(self, name, cards, tran, wanted, allowed=1e-5, silent=True):
        """wanted: what to measure -> value, or (value, how much it may be off)."""
        lines = [name, *cards, f".tran {tran}", *(f".meas tran m{k} {what}" for k, what in enumerate(wanted)), ".end", ""]
        outcome = run(sys.argv[1], "\n".join(lines), method=None, options=("--audit", "full"))
        if not self.check(outcome.status == 0, f"{name}: {outcome.stderr}"):
            return
        found = [m.get("value") for m in outcome.report["measurements"]]
        for got, (what, value) in zip(found, wanted.items()):
            value, most = value if isinstance(value, tuple) else (value, allowed * abs(value))
            self.check(got is not None and abs(got - value) <= most, f"{name}: {what} is {got}, not {value}")
        if silent:
            self.check(outcome.report["work"]["euler_steps"] == 0, f"{name}: falls back to implicit Euler")
            self.check(all(part not in outcome.stderr for part in ("did not agree", "do not agree", "slides", "coarse")),
                       f"{name}: {outcome.stderr}")


def gate(volts, seconds):
    """At `g`, a pulse from one time to three times `seconds` behind a twentieth of that."""
    tau = seconds / 20
    return [f"vp p 0 pulse(0 {volts!r} {seconds!r} 0 0 {2 * seconds!r} {4 * seconds!r})", "rg p g 1k",
            f"cg g 0 {tau / 1e3!r}"], tau


def fed_pair(c, size, volts, amperes, seconds):
    """A current that goes one way or the other: neither pair of positions in between is one."""
    r, top = 0.5 * volts / amperes, 0.5 * volts
    cards, tau = gate(volts, seconds)
    on, off = seconds + tau * LN(2), 3 * seconds + tau * LN(2)
    top *= 1 - EXP(-(off - on) / seconds)
    cards += [f"i1 0 a {amperes!r}", f"c2 b 0 {seconds / r!r}", f"r2 b 0 {r!r}", "s2 a b g 0 high"]
    low, high = 0.45 * volts, 0.55 * volts
    kinds = {
        "closed by less": ["s4 a 0 g 0 low", f".model high vswitch(von={high!r} voff={low!r})",
                           f".model low vswitch(von={low!r} voff={high!r})"],
        "turned around": ["s4 a 0 0 g low", f".model high sw(vt={volts / 2!r} ron=1m)", f".model low sw(vt={-volts / 2!r} ron=1m)"],
        "without a resistance": ["s4 a 0 0 g low", f".model high sw(vt={volts / 2!r} ron=0)",
                                 f".model low sw(vt={-volts / 2!r} ron=0)"]}
    for kind, more in kinds.items():
        for uic in "", " uic":
            c.measured(f"fed pair, {size}, {kind}{uic}", cards + more, f"{seconds / 50!r} {3.9 * seconds!r}{uic}",
                       {"MAX v(b)": top, f"FIND v(b) AT={3.5 * seconds!r}": top * EXP(-(3.5 * seconds - off) / seconds)})


def half_bridge(c, size, volts, seconds, ron):
    """The dual: both closed would short the source."""
    cards, tau = gate(volts, seconds)
    off = 3 * seconds + tau * LN(2)
    top = volts * (1 - EXP(-2.0))
    c.measured(f"half bridge, {size}, {ron} ohm", cards + [
        f"v1 a 0 {volts!r}", "s1 a x g 0 high", "s2 x 0 0 g low", f"l1 x y {seconds!r}", "r1 y 0 1",
        f".model high sw(vt={volts / 2!r} ron={ron!r})", f".model low sw(vt={-volts / 2!r} ron={ron!r})"],
        f"{seconds / 50!r} {3.9 * seconds!r}",
        {"MAX i(l1)": top, f"FIND i(l1) AT={3.5 * seconds!r}": top * EXP(-(3.5 * seconds - off) / seconds)})


def three_ways(c, size, volts, amperes, seconds):
    """A current goes into three capacitors in turn; the second has two switches in series."""
    lag = seconds / 1000
    first, second = seconds / 3 + lag, 2 * seconds / 3 + lag
    farad = seconds * amperes / volts
    cards = [f"i1 0 a {amperes!r}", "s1 a p 0 g lo1", "s2 a q g 0 hi1", "s3 q r 0 g lo2", "s4 a s g 0 hi2",
             *(f"c{k} {k} 0 {farad!r}" for k in "prs"), f"vr u 0 pwl(0 0 {seconds!r} {volts!r})", "rg u g 1k",
             f"cg g 0 {lag / 1e3!r}", *(f".model {name}{k} sw(vt={sign * k * volts / 3!r} ron=1u)"
                                        for name, sign in (("hi", 1), ("lo", -1)) for k in (1, 2))]
    c.measured(f"three ways, {size}", cards, f"{seconds / 100!r} {seconds!r} uic", {
        f"FIND v({node}) AT={seconds!r}": amperes * time / farad
        for node, time in (("p", first), ("r", second - first), ("s", seconds - second))})


def chain(c, size, volts, seconds, links, backwards):
    """Each switch is closed by what the one before lets through: all at one instant."""
    tau, lag = seconds / 10, seconds / 20
    on, off = tau * LN(2), seconds / 2 + tau * LN(1 - EXP(-5)) + tau * LN(2)
    top = volts * 1000 / 1001 * (1 - EXP(-(off - on) / (lag * (1 + 1 / 1001))))
    links_cards = [card for k in range(links) for card in (f"s{k} a g{k + 1} g{k} 0 sw", f"r{k} g{k + 1} 0 1k")]
    cards = [f"v1 a 0 {volts!r}", f"vp p 0 pulse(0 {volts!r} 0 0 0 {seconds / 2!r})", "rg p g0 1k",
             f"cg g0 0 {tau / 1e3!r}", *(links_cards[::-1] if backwards else links_cards),
             f".model sw sw(vt={volts / 2!r} ron=1)", f"rl g{links} z 1k", f"cz z 0 {lag / 1e3!r}"]
    c.measured(f"chain of {links}, {size}{', backwards' if backwards else ''}", cards, f"{seconds / 100!r} {seconds!r} uic",
               {"MAX v(z)": top, f"FIND v(z) AT={seconds!r}": top * EXP(-(seconds - off) / (2 * lag))})


def latch(c, size, volts, seconds, more, state):
    """Two switches, each of which holds the other one open: neither both nor none are closed."""
    low, high = volts / 1001, volts * (1e6 / (1e6 + 1e3) if more else 1.0)
    cards = [f"v1 a 0 {volts!r}", "r1 a q 1k", "r2 a n 1k", f"s1 q 0 n 0 sw{state}", "s2 n 0 q 0 sw", "ss q 0 s 0 sw",
             "sr n 0 r 0 sw", f".model sw sw(vt={volts / 2!r} ron=1)", "rm q m 1meg", f"cm m 0 {seconds * 1e-7!r}",
             f"vs s 0 pulse(0 {volts!r} {seconds!r} 0 0 {seconds / 10!r})",
             f"vr r 0 pulse(0 {volts!r} {3 * seconds!r} 0 0 {seconds / 10!r})", *more]
    c.measured(f"latch, {size}{state}{', loaded' if more else ''}", cards, f"{seconds / 50!r} {5 * seconds!r}", {
        f"FIND v(q) AT={2 * seconds!r}": (low, 1e-2 * low), f"FIND v(n) AT={2 * seconds!r}": (volts, 2e-3 * high),
        f"FIND v(n) AT={4 * seconds!r}": (low, 1e-2 * low), f"FIND v(q) AT={4 * seconds!r}": (volts, 2e-3 * high)})


def comparator(c, size, volts, amperes, seconds, uic):
    """A triangle: a comparator with a gain of 1000 and positive feedback behind an RC steers a current."""
    r, tau = 0.5 * volts / amperes, seconds
    period = tau * (LN((0.5 - 0.225) / (0.5 - 0.474)) + LN(0.474 / 0.225))
    cards = [f"i1 0 a {amperes!r}", "s2 a b d 0 high", "s4 a 0 d 0 low", f"c2 b 0 {tau / r!r}", f"r2 b 0 {r!r}",
             f"e7 c 0 table {{1k*({0.225 * volts!r} + 0.25*v(d) - v(b))}} = (0,0) ({volts!r},{volts!r})", "r7 c d 100",
             f"c4 d 0 {tau * 1e-9!r}", f".model high vswitch(von={0.65 * volts!r} voff={0.625 * volts!r} ron={r * 1e-6!r})",
             f".model low vswitch(von={0.625 * volts!r} voff={0.65 * volts!r} ron={r * 1e-6!r})",
             f".ic v(b)={0.225 * volts!r} v(d)={volts!r}"]
    level = 0.35 * volts
    c.measured(f"comparator, {size}{uic}", cards, f"{tau / 100!r} {20 * tau!r}{uic}", {
        f"TRIG v(b) VAL={level!r} RISE=2 TARG v(b) VAL={level!r} RISE=5": (3 * period, 1e-4 * period),
        "MAX v(b)": (0.474 * volts, 1e-5 * volts), f"MIN v(b) FROM={5 * tau!r}": (0.225 * volts, 1e-5 * volts)})


def own_drain(c, size, volts, hertz):
    """A switch that its own voltage closes is a diode with its resistance."""
    period = 1 / hertz
    peak = volts * 10 / 10.01
    cards = [f"v1 a 0 sin(0 {volts!r} {hertz!r})", "r1 k 0 10"]
    for roff in "", " roff=1g":
        c.measured(f"own drain, {size}{roff}", [*cards, "s1 a k a k sw", f".model sw sw(vt=0 ron=10m{roff})"],
                   f"{period / 100!r} {period!r}", {"MAX v(k)": peak, f"AVG v(k) FROM=0 TO={period!r}": peak / math.pi})
    smoothed = [*cards, f"c1 k 0 {period / 3!r}"]
    what = [f"AVG v(k) FROM={2 * period!r} TO={3 * period!r}", "MAX v(k)", f"MIN v(k) FROM={period!r}"]
    lines = ["as a diode", *smoothed, "d1 a k d", ".model d d(ron=10m)", f".tran {period / 100!r} {3 * period!r}",
             *(f".meas tran m{k} {w}" for k, w in enumerate(what)), ".end", ""]
    diode = [m["value"] for m in run(sys.argv[1], "\n".join(lines), method=None).report["measurements"]]
    c.measured(f"own drain, smoothed, {size}", [*smoothed, "s1 a k a k sw", ".model sw sw(vt=0 ron=10m)"],
               f"{period / 100!r} {3 * period!r}", dict(zip(what, diode)))


def dead_time(c, size, volts, seconds):
    """The thresholds of two switches are apart: diodes carry the coil's current in between."""
    cards, tau = gate(volts, seconds)
    on, off = seconds + tau * LN(4), 3 * seconds + tau * LN(4 / 3)
    top = volts * (1 - EXP(-(off - on) / seconds))
    c.measured(f"dead time, {size}", cards + [
        f"v1 a 0 {volts!r}", "s1 a x g 0 high", "s2 x 0 0 g low", "d1 0 x d", "d2 x a d", f"l1 x y {seconds!r}", "r1 y 0 1",
        f".model high sw(vt={0.75 * volts!r} ron=0)", f".model low sw(vt={-0.25 * volts!r} ron=0)", ".model d d"],
        f"{seconds / 50!r} {3.9 * seconds!r}",
        {"MAX i(l1)": top, f"FIND i(l1) AT={3.8 * seconds!r}": top * EXP(-(3.8 * seconds - off) / seconds)})


def thyristor(c, size, volts, hertz, degrees):
    """A gate closes it, its own current holds it."""
    period = 1 / hertz
    mean = volts / (2 * math.pi) * (1 + math.cos(math.radians(degrees)))
    cards = [f"v1 a 0 sin(0 {volts!r} {hertz!r})", "vs a m 0", "s1 m k u 0 scr", ".model scr sw(vt=.5 ron=1u)", "r1 k 0 10",
             f"b1 u 0 v=v(g)+min(1,max(0,{1e5 / volts!r}*i(vs)))",
             f"vg g 0 pulse(0 1 {degrees / 360 * period!r} 0 0 {period / 50!r} {period!r})"]
    c.measured(f"thyristor, {size}, {degrees} degrees", cards, f"{period / 100!r} {2 * period!r}", {
        f"AVG v(k) FROM=0 TO={period!r}": (mean, 1e-3 * volts),
        f"AVG v(k) FROM={period!r} TO={2 * period!r}": (mean, 1e-3 * volts)})


def at_threshold(c, size, volts):
    """A switch without hysteresis is on above its threshold alone, also where its control comes up to it and stays."""
    load = ["v2 w 0 5", "s1 w o g 0 sw", "r3 o 0 1k", "c3 o 0 1n"]
    fall = 5 * EXP(-0.4)
    c.measured(f"rests at {volts} V, {size}", [f"v1 a 0 sin(0 {2 * volts!r} 1meg)", f"b1 g 0 v=min({volts!r},v(a))", *load,
                                              f".model sw sw(vt={volts!r} ron=1m)"], "10n 3u", {"MAX v(o)": (0.0, 1e-9)})
    for stored in [], ["c2 g 0 1p"]:
        c.measured(f"clamped at {volts} V, {size}, {len(stored)} capacitors", [
            f"v1 a 0 sin(0 {2 * volts!r} 1meg)", "r1 a g 1k", "d1 g k d", f"v3 k 0 {volts!r}", ".model d d", *stored, *load,
            f".model sw sw(vt={volts!r} ron=1m)"], "10n 3u", {"MAX v(o)": (0.0, 1e-9)})
    c.measured(f"rests at 0 V, {size}", [f"v1 a 0 sin(0 {volts!r} 1meg)", "b1 g 0 v=max(0,v(a))", *load,
                                        ".model sw sw(vt=0 ron=1m)"], "10n 3u", {
        "FIND v(o) AT=.25u": 5.0, "FIND v(o) AT=.9u": fall, "FIND v(o) AT=2.9u": fall}, allowed=1e-4)
    for low, high, end in ((0.0, volts, 0.0), (2 * volts, volts, 5.0)):
        c.measured(f"comes near {volts} V from {low} V, {size}", [
            f"v1 a 0 pulse({low!r} {high!r} 1u 0 0 100u)", "r1 a g 1k", "c1 g 0 10p", *load,
            f".model sw sw(vt={volts!r} ron=1m)"], "10n 20u", {"FIND v(o) AT=1.1u": (end, 1e-4)})


def main():
    c = Positions("switch_positions")
    for size, volts, amperes, seconds in (("volts", 4.0, 1e-3, 1e-6), ("microvolts", 4e-6, 1e-9, 1e-3),
                                          ("kilovolts in hours", 4e3, 10.0, 3600.0), ("in nanoseconds", 1.0, 1e-3, 1e-9)):
        fed_pair(c, size, volts, amperes, seconds)
        three_ways(c, size, volts, amperes, seconds)
        for links in (5, 40):
            chain(c, size, volts, seconds, links, False)
            chain(c, size, volts, seconds, links, True)
        for state in "", " on":
            for more in [], [f"cq q 0 {seconds * 1e-6!r}", f"cn n 0 {seconds * 1e-6!r}"]:
                latch(c, size, volts, seconds, more, state)
        for uic in "", " uic":
            comparator(c, size, volts, amperes, seconds, uic)
        own_drain(c, size, volts, 1 / seconds)
        dead_time(c, size, volts, seconds)
        for ron in 0.0, 1e-6:
            half_bridge(c, size, volts, seconds, ron)
        for degrees in 60, 120:
            thyristor(c, size, volts, 1 / seconds, degrees)
        at_threshold(c, size, volts)
    return c.finish()


if __name__ == "__main__":
    sys.exit(main())
