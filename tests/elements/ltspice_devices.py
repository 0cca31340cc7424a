#!/usr/bin/env python3
"""LTspice's A devices: what their outputs are behind, VARISTOR and MODULATE, against closed forms; every parameter that
its documentation has is obeyed, or refused by name.

usage: ltspice_devices.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402
from logic import run_cards, runs  # noqa: E402


def outputs(checker, program):
    """Time constants of outputs, alike and different for both levels, with a load and without; of both outputs, and with uic."""
    cases = (("Tau={0}", 1, 1), ("Tau={0} Rout=50", 1, 1), ("Rout=2k Cout={1}", 2, 2), ("Rhigh=1k Rlow=3k Cout={1}", 1, 3),
             ("Rhigh=4k Rlow=1k Cout={1}", 4, 1), ("Cout={2}", 1, 1), ("Rout=1k Rlow=2k Cout={1}", 1, 2))
    for scale, low, high in ((1e-3, 1, 5), (2e-9, 0, 1), (3.0, -12, 12), (1e-6, 0, 3.3)):
        for text, up, down in cases:
            words = text.format(repr(scale), repr(scale / 1e3), repr(scale))
            what = f"{words} at {scale} s"
            cards = [f"v1 a 0 pulse(0 1 {scale!r} 0 0 {2 * scale!r} {10 * scale!r})",
                     f"a1 a 0 0 0 0 n q 0 BUF Vlow={low!r} Vhigh={high!r} Ref=0.5 {words}", "r1 q 0 1e15", "r2 n 0 1e15",
                     f".tran {scale / 10!r} {5 * scale!r}"]
            done = run_cards(program, what, cards)
            if not runs(checker, done, what):
                continue

            def level(t, first, other, towards, back):
                if t < scale:
                    return first
                top = other + (first - other) * math.exp(-(min(t, 3 * scale) / scale - 1) / towards)
                return top if t <= 3 * scale else first + (top - first) * math.exp(-(t / scale - 3) / back)
            for t, q, n in zip(done.time, done.column("v(q)"), done.column("v(n)")):
                checker.close(q, level(t, low, high, up, down), 1e-7 * (high - low), f"{what}: q at {t}")
                checker.close(n, level(t, high, low, down, up), 1e-7 * (high - low), f"{what}: its complement at {t}")
    for words, on, off in (("Rhigh=1k Rlow=0", 2, 0), ("Rhigh=0 Rlow=1k", 4, 0.5), ("Rout=3k Rhigh=1k", 2, 0.25), ("Rout=1k", 2, 0.5)):
        cards = ["v1 a 0 pulse(0 1 1m 0 0 1m 10m)", f"a1 a 0 0 0 0 0 q 0 BUF Vhigh=4 Ref=0.5 {words}", "r1 q x 1k", "v2 x 0 pulse(1 0 1m 0 0 1m 10m)",
                 ".tran 0.1m 3m"]
        done = run_cards(program, words, cards)
        if runs(checker, done, words):
            off = 0 if "Rlow=0" in words else 0.75 if "3k" in words else 0.5
            checker.close(done.at("v(q)", 1.5e-3), on, 1e-9, f"{words}, high")
            checker.close(done.at("v(q)", 2.5e-3), off, 1e-9, f"{words}, low")
    cards = ["v1 a 0 0", "a1 a 0 0 0 0 0 q 0 SRFLOP Tau=1m IC=5 Vhigh=5 Ref=0.5", "r1 q 0 1e12",
             "a2 s 0 c 0 0 0 h 0 SAMPLEHOLD Rout=1k Cout=1u IC=2", "v2 s 0 7", "v3 c 0 pulse(0 1 1m 0 0 1m 10m)", "r2 h 0 1e12", ".tran 0.1m 5m uic"]
    done = run_cards(program, "from its first level", cards)
    if runs(checker, done, "from its first level"):
        checker.close(done.at("v(q)", 4e-3), 5, 1e-6, "a latch that begins high")
        checker.close(done.at("v(h)", 3e-3), 7 - 5 * math.exp(-2), 1e-6, "a sample behind a resistor")


def varistors(checker, program):
    """Clamps between volts and kilovolts, a control that moves and falls below 0, a difference of nodes, without resistance."""
    for scale, f, ohms in ((1, 400, 10), (325, 50, 0.5), (1e-3, 1e6, 1e3), (20, 0.1, 100), (5, 7e3, 0)):
        what = f"a varistor at {scale} V"
        cards = [f"v1 s 0 sin(0 {5 * scale!r} {f!r})", "r1 s v 1k", f"v2 c 0 pwl(0 {2 * scale!r} {2 / f!r} {-scale!r})", "v3 d 0 0",
                 f"a1 c d 0 0 0 0 v 0 VARISTOR Rclamp={ohms!r}", f".tran {0.01 / f!r} {2 / f!r}", ".save v(v) i(a1)"]
        done = run_cards(program, what, cards)
        if not runs(checker, done, what):
            continue
        for t, v, i in zip(done.time, done.column("v(v)"), done.column("i(a1)")):
            limit = max(0, scale * (2 - 1.5 * t * f))
            s = 5 * scale * math.sin(2 * math.pi * f * t)
            over = max(0, abs(s) - limit) / (1e3 + ohms)
            checker.close(i, math.copysign(over, s), 1e-8 * scale / 1e3 * 5, f"{what}: its current at {t}")
            checker.close(v, s - 1e3 * math.copysign(over, s), 1e-8 * 5 * scale, f"{what}: its voltage at {t}")


def modulators(checker, program):
    """Frequencies that stand, and that a signal moves, with an amplitude that is a signal and without."""
    for space, mark in ((1e3, 2e3), (2e6, 1e6), (0.01, 0.05), (5e4, 5e4), (0, 300)):
        f = max(space, mark)
        end = 6 / f
        what = f"a modulator from {space} to {mark} Hz"
        word = f"MODULATE mark={mark!r} space={space!r}"
        cards = [f"v1 f 0 pwl(0 0 {end!r} 1)", f"v2 m 0 sin(2 1 {0.3 * f!r})", f"a1 f m 0 0 0 0 a 0 {word}", f"a2 f 0 0 0 0 0 b 0 {word}",
                 "v3 h 0 0.5", f"a3 h m 0 0 0 0 c 0 {word}", f"a4 0 0 0 0 0 0 d 0 {word.replace('MODULATE', 'MODULATOR')}",
                 *(f"r{x} {x} 0 1k" for x in "abcd"), f".tran {end / 200!r} {end!r}"]
        done = run_cards(program, what, cards)
        if not runs(checker, done, what):
            continue
        for t, a, b, c, d in zip(done.time, *(done.column(f"v({x})") for x in "abcd")):
            ramp = math.sin(2 * math.pi * (space * t + (mark - space) * t * t / (2 * end)))
            m = 2 + math.sin(2 * math.pi * 0.3 * f * t)
            checker.close(a, m * ramp, 3e-7, f"{what}: both at {t}")
            checker.close(b, ramp, 1e-7, f"{what}: its frequency at {t}")
            checker.close(c, m * math.sin(math.pi * (space + mark) * t), 1e-7, f"{what}: its amplitude at {t}")
            checker.close(d, math.sin(2 * math.pi * space * t), 1e-9, f"{what}: neither at {t}")


def quadratures(checker, program):
    """Both outputs of a modulator, one of them alone, and levels, of a frequency that stands and of one that a signal moves."""
    for space, mark, levels in ((1e3, 2e3, ""), (2e6, 1e6, " Vhigh=3 Vlow=-1"), (0.01, 0.05, " Vlow=0"), (0, 300, " Vhigh=2")):
        f = max(space, mark)
        end = 6 / f
        what = f"a modulator of two outputs from {space} to {mark} Hz{levels}"
        word = f"MODULATE mark={mark!r} space={space!r}"
        cards = [f"v1 f 0 pwl(0 0 {end!r} 1)", f"v2 m 0 sin(2 1 {0.3 * f!r})", f"a1 f m 0 0 0 c s 0 {word}", f"a2 f 0 0 0 0 d 0 0 {word}{levels}",
                 "v3 h 0 0.5", f"a3 h 0 0 0 0 e t 0 {word}{levels}", *(f"r{x} {x} 0 1k" for x in "csdet"), f".tran {end / 200!r} {end!r}"]
        done = run_cards(program, what, cards)
        if not runs(checker, done, what):
            continue
        high = 3 if "h=3" in levels else 2 if "h=2" in levels else 1
        low = 0 if "w=0" in levels else -1
        middle, half = 0.5 * (high + low), 0.5 * (high - low)
        for t, c, s, d, e, x in zip(done.time, *(done.column(f"v({x})") for x in "csdet")):
            angle = 2 * math.pi * (space * t + (mark - space) * t * t / (2 * end))
            still = math.pi * (space + mark) * t
            m = 2 + math.sin(2 * math.pi * 0.3 * f * t)
            for found, wanted, name in ((c, m * math.cos(angle), "cosine"), (s, m * math.sin(angle), "sine"), (d, middle + half * math.cos(angle), "alone"),
                                        (e, middle + half * math.cos(still), "still cosine"), (x, middle + half * math.sin(still), "still sine")):
                checker.close(found, wanted, 5e-7, f"{what}: {name} at {t}")


def many(checker, program):
    """Oscillators need more room than their cards show: beside sources that read currents, gates and formulas."""
    cards = ["v1 f 0 pwl(0 0 1m 1)"]
    for k in range(9):
        cards += [f"a{k} f 0 0 0 0 c{k} s{k} 0 MODULATE mark={k + 2}k space=1k", f"r{k} c{k} 0 1k", f"vm{k} s{k} t{k} 0", f"rt{k} t{k} 0 1k",
                  f"f{k} 0 i{k} vm{k} 2", f"ri{k} i{k} 0 1k", f"a{k}g s{k} 0 0 0 0 0 g{k} 0 BUF Ref=0.5", f"rg{k} g{k} 0 1k", f"b{k} p{k} 0 v=v(c{k})*v(s{k})",
                  f"rp{k} p{k} 0 1k"]
    done = run_cards(program, "many", [*cards, ".tran 10u 1m"])
    if not runs(checker, done, "many modulators"):
        return
    for k in range(9):
        for t, s, i, p in zip(done.time, done.column(f"v(s{k})"), done.column(f"v(i{k})"), done.column(f"v(p{k})")):
            angle = 2 * math.pi * (1e3 * t + (k + 1) * 1e3 * t * t / 2e-3)
            checker.close(s, math.sin(angle), 1e-6, f"of many: {k} at {t}")
            checker.close(i, 2 * math.sin(angle), 2e-6, f"its current: {k} at {t}")
            checker.close(p, math.sin(2 * angle) / 2, 1e-6, f"its product: {k} at {t}")


def transconductors(checker, program):
    """OTAs against their law: soft and linear, unlike limits, a product, an offset, clamps on either side of 0, a capacitor, a loop."""
    for scale, f in ((1, 1e3), (1e-3, 2e6), (100, 0.5)):
        what = f"OTAs at {scale} V"
        i, r = 1e-3, 1e3 * scale
        cards = [f"v1 p 0 sin(0 {scale!r} {f!r})", f"v2 q 0 sin(0 2 {0.3 * f!r})",
                 f"a1 0 p 0 0 0 0 a 0 OTA G={2 * i / scale!r} Iout={i!r} Vhigh=1e308 Vlow=-1e308 Rout={r!r}",
                 f"a2 0 p 0 0 0 0 b 0 OTA G={i / scale!r} linear Rout={r!r} Vhigh={0.4 * scale!r} Vlow={-0.7 * scale!r}",
                 f"a3 0 p q 0 0 0 c 0 OTA G={i / scale!r} linear=1 Rout={r!r} Vhigh=1e308 Vlow=-1e308",
                 f"a4 p 0 0 0 0 0 d 0 OTA G={i / scale!r} asym Isource={3 * i!r} Isink={-i!r} Rout={r!r} Vhigh=1e308 Vlow=-1e308",
                 f"a5 0 p 0 0 0 0 e 0 OTA G={i / scale!r} linear Ref={0.5 * scale!r} Rout={r!r} Vhigh={-0.2 * scale!r} Vlow={-1.2 * scale!r}",
                 f"a6 g p 0 0 0 0 g 0 OTA G={i / scale!r} linear Rout={1e6 * r!r} Vhigh=1e308 Vlow=-1e308 en=1n incm=1f incmk=10",
                 "a7 0 p 0 0 0 0 0 0 OTA g=0 in=3p", f".tran {0.01 / f!r} {2 / f!r}"]
        done = run_cards(program, what, cards)
        if not runs(checker, done, what):
            continue
        for t, *v in zip(done.time, *(done.column(f"v({x})") for x in "abcdeg")):
            s = math.sin(2 * math.pi * f * t)
            q = 2 * math.sin(2 * math.pi * 0.3 * f * t)
            down = -3 * math.tanh(max(-s, 0) / -3) - math.tanh(max(s, 0))
            wanted = (math.tanh(2 * s), min(0.4, max(-0.7, s)), s * q, down, min(-0.2, max(-1.2, s - 0.5)), s / (1 + 1e-6))
            for k, (found, should) in enumerate(zip(v, wanted)):
                checker.close(found, scale * should, 2e-7 * scale, f"{what}: a{k + 1} at {t}")
    done = run_cards(program, "an integrator", ["v1 p 0 0.1", "a1 0 p 0 0 0 0 o 0 OTA G=1m Iout=1 Cout=1u Vhigh=5 Vlow=-5", "r1 o 0 1e12", ".ic v(o)=0",
                                                ".tran 1m 100m"])
    if runs(checker, done, "an OTA and its capacitor"):
        checker.close(done.at("v(o)", 20e-3), 2, 1e-6, "what it charges")
        checker.close(done.at("v(o)", 90e-3), 5, 1e-6, "its limit")
    for card, part in (("a1 p 0 0 0 p 0 o 0 OTA G=1", "pin 5 of 'a1'"), ("a1 p 0 0 0 0 0 o 0 OTA Vhigh=-1 Vlow=1", "Vhigh must be above Vlow"),
                       ("a1 p 0 0 0 0 0 o 0 OTA Iout=0", "not 0"), ("a1 p 0 0 0 0 0 o 0 OTA Rout=-1", "negative")):
        done = run_cards(program, card, ["v1 p 0 1", "r1 o 0 1", card, ".tran 1 1"])
        checker.check(done.status == 3 and part in done.stderr and "1:1" not in done.stderr, f"{card}: {done.stderr}")


def limited_samples(checker, program):
    """Vhigh and Vlow of a sample: both, one, those that are as good as none; held, tracked, at the start; the clock's level is what it is."""
    for scale, period in ((1.0, 1e-3), (1e-3, 2e-6), (400.0, 0.05)):
        what = f"samples between limits at {scale} V"
        inf = math.inf
        cases = {"a": ("Vhigh={h} Vlow={l}", -1, 2), "b": ("Vhigh={h}", -inf, 2), "c": ("Vlow={l}", -1, inf), "d": ("Vhigh=1e308 Vlow=-1e308", -inf, inf),
                 "e": ("Vhigh=1e6 Vlow=-1e6", -inf, inf), "f": ("Vhigh={n} Vlow={l}", -1, -0.5)}
        cards = [f"v1 s 0 sin(0 {3 * scale!r} {1 / period!r})", f"v2 c 0 pulse(0 1 {period / 80!r} 0 0 {period / 40!r} {period / 20!r})"]
        for x, (words, _, _) in cases.items():
            words = words.format(h=2 * scale, l=-scale, n=-0.5 * scale)
            cards += [f"a1{x} s 0 c 0 0 0 h{x} 0 SAMPLEHOLD IC={scale!r} {words}", f"a2{x} s 0 0 c 0 0 t{x} 0 SAMPLEHOLD {words}", f"r1{x} h{x} 0 1k",
                      f"r2{x} t{x} 0 1k"]
        done = run_cards(program, what, [*cards, f".tran {period / 300!r} {2 * period!r}"])
        if not runs(checker, done, what):
            continue
        for x, (words, low, high) in cases.items():
            for t, held, tracked in zip(done.time, done.column(f"v(h{x})"), done.column(f"v(t{x})")):
                clock = math.floor((t - period / 80) / (period / 20) + 1e-9)
                since = t - period / 80 - clock * period / 20
                if min(since, abs(since - period / 40), period / 20 - since) < 1e-6 * period:
                    continue
                at = period / 80 + clock * period / 20

                def taken(time, x=x, low=low, high=high):
                    return scale * min(high, max(low, 3 * math.sin(2 * math.pi * time / period)))
                wanted = taken(at) if clock >= 0 else scale * min(high, max(low, 1))
                checker.close(held, wanted, 1e-8 * scale, f"{what}: {words} holds at {t}")
                wanted = taken(t) if clock >= 0 and since < period / 40 else taken(at + period / 40) if clock >= 0 else taken(0)
                checker.close(tracked, wanted, 1e-8 * scale, f"{what}: {words} tracks at {t}")
    done = run_cards(program, "crossed", ["v1 s 0 1", "v2 c 0 1", "a1 s 0 c 0 0 0 o 0 SAMPLEHOLD Vhigh=-1 Vlow=1", "r1 o 0 1", ".tran 1 1"])
    checker.check(done.status == 3 and "Vhigh must be above Vlow" in done.stderr, f"crossed: {done.stderr}")


def parameters(checker, program):
    """Each function with each parameter of LTspice: accepted, or refused with its name; never passed over in silence.
    Those without effect are the accuracies of its own time steps."""
    gates = "AND OR XOR BUF INV SCHMITT SCHMTBUF SCHMTINV DIFFSCHMITT DIFFSCHMTBUF DIFFSCHMTINV SRFLOP DFLOP".split()
    levels = ["Vhigh=2", "Vlow=-1", "Ref=0.3", "Td=1u", "Trise=1u", "Tfall=2u", "Rout=10", "Rhigh=5", "Rlow=7", "Cout=1n", "Tau=1u", "IC=1",
              "tripdt=1n", "ttol=1n", "temp=50"]
    known = {name: set(levels) | {"Vt=0.4", "Vh=0.1"} for name in gates}
    known["COUNTER"] = set(levels) | {"cycles=3", "duty=0.4"}
    known["SAMPLEHOLD"] = {"Vhigh=2", "Vlow=-1", "Ref=0.3", "Rout=10", "Cout=1n", "Tau=1u", "IC=1", "tripdt=1n", "ttol=1n", "temp=50"}
    accuracies = {"tripdt=1n", "ttol=1n", "temp=50"}
    known["VARISTOR"] = {"Rclamp=2"} | accuracies
    known["MODULATE"] = {"mark=2k space=1k", "Vhigh=2", "Vlow=-1"} | accuracies
    known["OTA"] = {"Vhigh=2", "Vlow=-1", "Ref=0.3", "Rout=10", "Cout=1n", "Rclamp=2", "G=1m", "Iout=1m", "Isink=1m", "linear=1", "asym=1",
                    "en=1n", "enk=10", "powerup=1"} | accuracies
    words = set(levels) | {"Vt=0.4", "Vh=0.1", "cycles=3", "duty=0.4", "Rclamp=2", "mark=2k space=1k", "G=1m", "Iout=1m", "Isink=1m", "linear=1",
                           "asym=1", "en=1n", "enk=10", "powerup=1"}
    for name, accepted in known.items():
        inverts = "INV" in name
        pins = "a c f 0 0" if name == "SAMPLEHOLD" else "a 0 f 0 0" if name == "DFLOP" else "a c 0 0 0" if name in ("AND", "OR", "XOR", "SRFLOP", "VARISTOR") else "a 0 0 0 0"
        for word in sorted(words):
            more = word if name != "MODULATE" or "mark" in word else f"mark=2k space=1k {word}"
            card = f"a1 {pins} {'o 0' if inverts else '0 o'} 0 {name} {more}"
            done = run_cards(program, card, ["v1 a 0 1", "v2 c 0 1", "v3 f 0 1", card, "r1 o 0 1k", ".tran 1u 10u"])
            if word in accepted:
                checker.check(done.status == 0, f"{card}: {done.stderr}")
            else:
                checker.check(done.status != 0 and f"parameter '{word.split('=')[0].lower()}'" in done.stderr, f"{card}: {done.stderr}")


def without_signs(checker, program):
    """Parameters with nothing between name and value are what they are with an equal sign."""
    for function, words in (("AND", "vhigh 5V trise 1e-6 tfall 1e-6"), ("AND", "Vhigh=5 td 2u"), ("OR", "vlow -1 vhigh 3"), ("XOR", "ref 0.3 vhigh 2"),
                            ("BUF", "td 1u vhigh {2*p}"), ("INV", "trise 3u"), ("SCHMITT", "vt 0.4 vh 0.1 vhigh 12"), ("SRFLOP", "td 1u vhigh 4"),
                            ("COUNTER", "cycles 2 duty 0.5"), ("BUF", "tau 2u rout 5"), ("SAMPLEHOLD", "vhigh 0.6 vlow 0.1"), ("BUF", "tripdt 1n vhigh 2")):
        found = []
        for text in (words, " ".join(f"{n}={v}" for n, v in zip(words.replace("=", " ").split()[::2], words.replace("=", " ").split()[1::2]))):
            card = f"a1 a 0 0 c 0 {'o 0' if function == 'INV' else '0 o'} 0 {function} {text}"
            done = run_cards(program, card, [".param p=3", "v1 a 0 pulse(0 9 3u 5u 5u 8u 30u)", "v2 c 0 pulse(0 9 5u 1n 1n 7u 20u)", card, "r1 o 0 1k",
                                             ".tran 1u 100u", ".save v(o)"])
            found += [done.column("v(o)")] if checker.check(done.status == 0, f"{card}: {done.stderr}") else []
        checker.check(len(found) == 2 and list(found[0]) == list(found[1]) and len(set(found[0])) > 1, f"{function} {words}")


def refused(checker, program):
    cases = (("a1 a 0 0 0 0 0 o 0 BUF Tau=1u Trise=1u", "'tau' and 'trise' of one output"),
             ("a1 a 0 0 0 0 0 o 0 BUF Tau=1u Cout=1u", "'tau' and 'cout' of one output"),
             ("a1 a 0 0 0 0 0 o 0 BUF Tau=-1u", "'tau' cannot be negative"),
             ("a1 a b 0 0 0 0 o 0 VARISTOR Rclamp=-1", "'rclamp' cannot be negative"),
             ("a1 a b 0 0 0 0 o 0 MODULATE mark=1k", "space="),
             ("a1 a 0 0 0 0 0 o 0 MODULATE mark=1k space=1k Vlow=2", "Vhigh must be above Vlow"))
    for card, text in cases:
        done = run_cards(program, card, ["v1 a 0 1", "v2 b 0 1", card, "r1 o 0 1", ".tran 1 2"])
        checker.check(done.status != 0 and text in done.stderr, f"{card}: {done.stderr}")
    for card, text in (("a1 a b a 0 0 0 o 0 VARISTOR", "this function does not use pin 3 of 'a1': it is ignored"),
                       ("a1 a b 0 0 a 0 o 0 MODULATE mark=1k space=1k", "this function does not use pin 5 of 'a1'"),
                       *((f"a1 {pins} 0 0 0 {function}", "no output of 'a1' is wired: the element is left out")
                         for pins in ("a b 0 0 0", "0 0 0 0 0") for function in (
                             "VARISTOR", "MODULATE mark=1k space=1k", "AND", "OR vhigh=5", "XOR", "BUF", "INV", "DFLOP", "SRFLOP", "COUNTER cycles=3",
                             "SCHMITT vt=1 vh=0.1", "SAMPLEHOLD"))):
        done = run_cards(program, card, ["v1 a 0 1", "v2 b 0 1", card, "r1 o 0 1", ".tran 1u 2u"])
        checker.check(done.status == 0 and text in done.stderr, f"{card}: {done.stderr}")
    done = run(program, "\n".join(["x", "v1 a 0 1", ".subckt s i o", "a1 i 0 0 0 0 0 o 0 BUF Tau={t}", ".ends", ".param t=1u", "x1 a o s",
                                   "r1 o 0 1k", ".tran 1u 10u", ".end", ""]), method=None)
    checker.check(done.status == 0, f"in a subcircuit: {done.stderr}")


def held_outputs(checker, program):
    """An output that something without a resistance holds has LTspice's 1 ohm; others are ideal."""
    for high, low in ((1, 0), (5, -5), (400, 1e-3), (1e-3, 0)):
        gate = f"Vhigh={high} Vlow={low} Ref=0.5"
        on = "v1 a 0 1"
        # Cards, a signal and its value: outputs on one node, against a source, through an ideal diode, in a ring through com.
        cases = (
            ([on, f"a1 a 0 0 0 0 0 b 0 BUF {gate}", f"a2 a 0 0 0 0 b 0 0 BUF {gate}"], "v(b)", 0.5 * (high + low)),
            ([on, *(f"a{k} a 0 0 0 0 0 b 0 BUF {gate}" for k in range(4)), f"a4 a 0 0 0 0 b 0 0 INV {gate}"], "v(b)",
             (4 * high + low) / 5),
            ([on, f"a1 a 0 0 0 0 0 b 0 BUF {gate}", f"v2 b 0 {3 * high}"], "i(v2)", -2 * high),
            ([on, f"a1 a 0 0 0 0 b c 0 BUF {gate}", f"v2 c 0 {3 * high}", "r1 b 0 1k"], "v(b)", low),
            ([on, f"a1 a 0 0 0 0 0 b 0 BUF {gate}", "d1 b c dd", f"v2 c 0 {0.25 * high}"], "i(d1)", 0.75 * high),
            ([on, f"a1 a c c c c c b c BUF {gate}", f"e1 b 0 a 0 {2 * high}", "v2 c 0 0"], "i(v2)", high),
            ([on, f"a1 a 0 k 0 0 0 b 0 SAMPLEHOLD IC={high}", "v3 k 0 0", f"v2 b 0 {-high}"], "i(v2)", 2 * high))
        for cards, name, wanted in cases:
            cards = [*cards, ".model dd D(Ron=0)", ".tran 1u 1m", f".save {name}"]
            done = run_cards(program, "held outputs", cards)
            if runs(checker, done, f"{cards}"):
                for value in done.column(name):
                    checker.close(value, wanted, 1e-9 * abs(high), f"{cards}: {name}")
            ideal = [c + " Rout=0" if c[0] == "a" else c for c in cards]
            done = run_cards(program, "held ideal outputs", ideal)
            checker.check(done.status != 0, f"{ideal}: an ideal output that is held: {done.status}")
        for control, top in ((0, high), (0.5, 0.5)):  # the cosine on a source, alone and of an amplitude, and the sine as it is
            cards = ["v1 a 0 1", f"v3 m 0 {control}", f"a1 a {'m' if control else 0} 0 0 0 b c 0 MODULATE mark=2k space=0 Vhigh={high} Vlow={-high}",
                     f"v2 b 0 {high}", ".tran 20u 1m", ".save i(v2) v(c)"]
            done = run_cards(program, "a held modulator", cards)
            if runs(checker, done, "a held modulator"):
                for t, i, v in zip(done.time, done.column("i(v2)"), done.column("v(c)")):
                    checker.close(i, top * math.cos(4e3 * math.pi * t) - high, 1e-7 * max(top, high), f"{control}: its cosine at {t}")
                    checker.close(v, top * math.sin(4e3 * math.pi * t), 1e-7 * max(top, high), f"{control}: its sine at {t}")
        # .ic holds an output until the run begins.
        r, c, first = 99.0, 1e-6, low - 0.25 * (high - low)
        cards = [on, f"a1 a 0 0 0 0 0 b 0 BUF {gate}", f"r1 b c {r}", f"c1 c 0 {c}", f".ic v(b)={first!r}", ".tran 10u 400u", ".save v(c)"]
        done = run_cards(program, "held by .ic", cards)
        if runs(checker, done, "held by .ic"):
            for t, v in zip(done.time, done.column("v(c)")):
                checker.close(v, high + (first - high) * math.exp(-t / ((r + 1) * c)), 1e-8 * high, f".ic: {t}")
        # Nothing holds these: beside a resistor, a capacitor behind one, a current, and an input.
        cards = [on, f"a1 a 0 0 0 0 x b 0 BUF {gate}", "r1 b 0 1", "a2 b 0 0 0 0 0 c 0 BUF", "i1 c 0 1m", "r2 x y 1", "c1 y 0 1u",
                 ".tran 1u 1m", ".save v(b)"]
        done = run_cards(program, "free outputs", cards)
        if runs(checker, done, "free outputs"):
            checker.check(set(done.column("v(b)")) == {float(high)}, f"free: {set(done.column('v(b)'))}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("ltspice_devices")
    for part in (outputs, varistors, modulators, quadratures, many, transconductors, limited_samples, parameters, without_signs, held_outputs, refused):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
