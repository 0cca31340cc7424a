#!/usr/bin/env python3
"""XSPICE's oscillators, monostables, latches, hystereses and derivatives against closed forms.

usage: oscillators.py PROGRAM
"""

import bisect
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402
from logic import edges, run_cards, runs, times  # noqa: E402

TABLE = "cntl_array=[{0!r} {1!r} {2!r}] freq_array=[{3!r} {4!r} {5!r}]"


def triangle(phase, duty):
    phase -= math.floor(phase)
    return phase / duty if phase < duty else (1 - phase) / (1 - duty)


def phase_of(kind, f, depth, t):
    """Cycles by t of a frequency f (1 + depth t f), or f (1 + depth sin(2 pi f t / 10)), or f."""
    if kind == "ramp":
        return f * t + 0.5 * depth * (f * t) ** 2
    if kind == "sine":
        return f * t + depth * 10 / (2 * math.pi) * (1 - math.cos(2 * math.pi * f * t / 10))
    return f * t


def voltage_of(kind, f, depth, cycles):
    """The control of those: a volt is the frequency f."""
    if kind == "ramp":
        return f"v1 c 0 pwl(0 1 {cycles / f!r} {1 + depth * cycles!r})"
    return f"v1 c 0 sin(1 {depth!r} {f / 10!r})" if kind == "sine" else "v1 c 0 1"


def oscillators(checker, program):
    """Triangle and sine at all times, the edges of square and d_osc, of constant controls and of such that move, from
    millihertz to megahertz, levels from millivolts to kilovolts, duties from 0.02 to 0.9. At the default tolerance steps are
    on factors: with ten times the rounding that errors are allowed there, 3 MHz leave a phase off by more."""
    cases = (("", 1e3, 0, 0.3, -2, 3), ("", 2e-3, 0, 0.9, 0, 1e3), ("", 7e6, 0, 0.02, -1e-3, 2e-3),
             ("ramp", 1e3, 0.02, 0.3, -2, 3), ("ramp", 5e-3, 0.1, 0.5, 0, 12), ("ramp", 2e5, 0.5, 0.7, -1e3, 1e3),
             ("sine", 1e3, 0.5, 0.25, -1, 1), ("sine", 50, 0.9, 0.6, 0, 5e-3), ("sine", 3e6, 0.2, 0.5, -5, 0),
             ("sine", 0.2, 0.05, 0.1, 3, 4))
    for case, tolerance in [(case, 1e-10) for case in cases] + [(case, 1e-6) for case in cases[-4:]]:
        kind, f, depth, duty, low, high = case
        what = f"{kind or 'constant'} {f} Hz, duty {duty}, {tolerance}"
        cycles = 10.33
        table = TABLE.format(0.0, 1.0, 3.0, 0.0, f, 3 * f)
        levels = f"out_low={low!r} out_high={high!r}"
        cards = [voltage_of(kind, f, depth, cycles), "a1 c t mt", f".model mt triangle({table} {levels} duty_cycle={duty!r})",
                 "a2 c s ms", f".model ms sine({table} {levels})",
                 "a3 c q mq", f".model mq square({table} {levels} duty_cycle={duty!r} rise_time=0 fall_time=0)",
                 "a4 %vd(c 0) d md", f".model md d_osc({table} duty_cycle={duty!r} init_phase=-72 rise_delay=0 fall_delay=0)",
                 "r1 t 0 1k", "r2 s 0 1k", "r3 q 0 1k", f".tran {0.05 / f!r} {cycles / f!r}",
                 ".save v(t) v(s) v(q) v(d)"]
        done = run(program, "\n".join([what, *cards, ".end", ""]), method=None, tolerance=tolerance)
        if not runs(checker, done, what):
            continue
        for t, v, s in zip(done.time, done.column("v(t)"), done.column("v(s)")):
            phase = phase_of(kind, f, depth, t)
            checker.close(v, low + (high - low) * triangle(phase, duty), 1e-7 * (high - low), f"{what}: triangle at {t}")
            checker.close(s, 0.5 * (low + high) + 0.5 * (high - low) * math.sin(2 * math.pi * phase), 2e-7 * (high - low),
                          f"{what}: sine at {t}")
        for name, level, ahead in (("v(q)", 0.5 * (low + high), 0), ("v(d)", 0.5, 0.8)):
            got = [phase_of(kind, f, depth, t) + ahead for t in edges(done, name, level) if t > 0]
            end = phase_of(kind, f, depth, cycles / f) + ahead
            wanted = sorted(x for k in range(40) for x in (k + 1 - duty, k + 1.0) if ahead < x < end)
            if checker.check(len(got) == len(wanted), f"{what}: {name} has {len(got)} edges, not {len(wanted)}"):
                for a, b in zip(got, wanted):
                    checker.close(a, b, 1e-7, f"{what}: an edge of {name}")


def rests(checker, program):
    """Before t = 0 an oscillator is at its first phase, in .op, .dc and .ac; a frequency of 0 stands; a table that would
    go below 0 does not."""
    table = TABLE.format(0.0, 1.0, 2.0, 0.0, 1e3, 1.5e3)
    cards = ["v1 c 0 dc 1 ac 1 sin(-1 0.2 100)", "a1 c t mt", f".model mt triangle({table} out_low=-2 out_high=3)", "r1 t 0 1k",
             "a2 c s ms", f".model ms sine({table} out_low=-2 out_high=3)", "r2 s 0 1k", "v2 k 0 0", "a3 k z ms", "r3 z 0 1k"]
    for card, columns in ((".op", ("v(t)", "v(s)")), (".dc v1 0 2 0.5", ("v(t)", "v(s)")), (".tran 1u 20m", ("v(t)", "v(s)", "v(z)"))):
        done = run_cards(program, card, [*cards, card])
        if runs(checker, done, card):
            for name in columns:
                wanted = -2 if name == "v(t)" else 0.5
                worst = max(abs(v - wanted) for v in done.column(name))
                checker.check(worst < 1e-9, f"{card}: {name} moves by {worst}")
    done = run_cards(program, "small signals", [*cards, ".ac dec 1 1 1k"])
    checker.check(done.status == 0, f"small signals: {done.stderr}")
    for word in ("", " uic"):
        done = run_cards(program, "from the start" + word,
                         ["v1 c 0 pwl(0 1 1m 1 2m 2)", "a1 c t mt", f".model mt triangle({table} out_low=-2 out_high=3)", "r1 t 0 1k",
                          f".tran 10u 1m{word}", ".save v(t)"])
        if runs(checker, done, word):
            checker.close(done.at("v(t)", 0.3e-3), -2 + 5 * 0.6, 1e-9, f"at 0.3 ms{word}")


def loop(checker, program):
    """A phase-locked loop: a square and a reference into a flip-flop pair's charge pump keep in step; a steady state of an
    oscillator behind a filter has the multiplier of that filter."""
    cards = ["v1 i 0 2", "ra i c 1k", "rb c 0 1k", "a1 c t mt", "r1 t o 1k", "c1 o 0 1u", ".pss auto osc uic",
             ".model mt triangle(cntl_array=[0 1 3] freq_array=[100 1k 3k] out_low=-2 out_high=3 duty_cycle=0.3)"]
    done = run(program, "\n".join(["a steady oscillator", *cards, ".end", ""]), method=None)
    checker.check(done.status == 0, f"a steady oscillator: {done.stderr}")
    if done.status == 0:
        found = done.report["steady"]["multipliers"]
        checker.check(len(found) == 1 and abs(found[0]["re"] - math.exp(-1)) < 1e-8, f"multipliers {found}")
    cards = ["vr r 0 pulse(0 1 0 0 0 50u 100u)", "vk one 0 1",
             "a1 one 0 r 0 both 0 up 0 DFLOP", "a2 one 0 q 0 both 0 dn 0 DFLOP", "a3 up dn 0 0 0 0 both 0 AND Td=1n",
             "b1 0 c I=1m*v(up)-1m*v(dn)", "r1 c x 2k", "c1 x 0 0.1u ic=0.5",
             "a4 c q mq", ".model mq square(cntl_array=[0 2] freq_array=[5k 25k] out_low=0 out_high=1 rise_time=0 fall_time=0)",
             ".tran 10u 20m uic", ".save v(q) v(x)"]
    done = run(program, "\n".join(["a phase-locked loop", *cards, ".end", ""]), method=None)
    if runs(checker, done, "a phase-locked loop"):
        late = [t for t in edges(done, "v(q)", 0.5) if t > 18e-3]
        checker.check(len(late) >= 38, f"a phase-locked loop has {len(late)} edges")
        ups = [t for t in late if abs(t / 1e-4 - round(t / 1e-4)) < 0.02]
        checker.check(len(ups) >= 19, f"a phase-locked loop is not in step: {[t / 1e-4 for t in late][:6]}")
        checker.close(done.at("v(x)", 20e-3), 0.5, 5e-3, "a phase-locked loop's control")


def monostables(checker, program):
    """Pulses of constant length and of one that a signal says at the clock, ramps, a clock that falls, one that comes too
    early, one that begins the pulse anew, a clear."""
    for scale in (1e-6, 1e-3, 10.0, 2e-9):
        for anew in (False, True):
            what = f"pulses in {scale} s{', anew' if anew else ''}"
            word = "true" if anew else "false"
            cards = [f"v1 c 0 pulse(0 1 {10 * scale!r} 0 0 {5 * scale!r} {30 * scale!r})",
                     f"v2 k 0 pwl(0 0 {300 * scale!r} 3)",
                     f"v3 r 0 pulse(0 1 {105 * scale!r} 0 0 {2 * scale!r} 1e3)",
                     "a1 c k null o m", "a2 c null r p n", "r1 o 0 1k", "r2 p 0 1k"]
            cards += [f".model m oneshot(cntl_array=[0 1] pw_array=[{10 * scale!r} {20 * scale!r}] rise_time=0 fall_time=0 "
                      f"rise_delay={scale!r} fall_delay={2 * scale!r} retrig={word})",
                      f".model n oneshot(cntl_array=[0 1] pw_array=[{34 * scale!r} 1] rise_time={2 * scale!r} fall_time={scale!r} "
                      f"rise_delay=0 fall_delay=0 pos_edge_trig=false retrig={word})",
                      f".tran {scale!r} {200 * scale!r}", ".save v(o) v(p)"]
            done = run_cards(program, what, cards)
            if not runs(checker, done, what):
                continue
            wanted, free, end = [], 0, -1
            for k in range(7):
                t = 10 + 30 * k
                length = 1 + 10 + 10 * t / 100
                if anew and t < end:
                    wanted[-1] = t + length + 2
                    end = t + length
                elif t >= free:
                    wanted += [t + 1, t + length + 2]
                    end = t + length
                    free = t + length + 2 if not anew else 0
            times(checker, edges(done, "v(o)", 0.5), [t * scale for t in wanted if t < 200], what)
            ramps = [(t, v) for t, v in zip(done.time, done.column("v(p)"))]
            falls = [15 + 30 * k for k in range(6)]
            high = []
            if anew:
                high = [(15, 105), (135, 1e9)]
            else:
                high = [(15, 51), (75, 105), (135, 171)] if False else [(15, 51), (75, 105), (135, 171), (195, 1e9)]
            for t, v in ramps:
                t /= scale
                x = 0.0
                for a, b in high:
                    if a <= t:
                        x = min((t - a) / 2, 1) if t <= b else max(0, 1 - (t - b))
                if all(abs(t - e) > 1e-6 for pair in high for e in pair) and not (105 <= t <= 107):
                    checker.close(v, x, 1e-9, f"{what}: a ramp at {t}")


def latches(checker, program):
    """Both latches through all their inputs, transparent and closed, with their delays."""
    rows = [(k >> 2 & 1, k >> 1 & 1, k & 1) for k in range(8)] + [(1, 1, 0), (0, 1, 0), (1, 0, 1), (1, 1, 0), (1, 0, 0), (1, 1, 0), (0, 0, 1)]
    volts = [", ".join(f"{k}u {row[i]} {k + 1}u {row[i]}" for k, row in enumerate(rows)) for i in range(3)]
    cards = [f"v{i + 1} {'edr'[i]} 0 pwl({volts[i]})" for i in range(3)]
    cards += ["ab [e d r] [de dd dr] adc", ".model adc adc_bridge(rise_delay=0 fall_delay=0)", "a1 dd de null null q nq ml",
              "a2 dd dr de null null p np ms", ".model ml d_dlatch(data_delay=30n enable_delay=30n rise_delay=3n fall_delay=5n)",
              ".model ms d_srlatch(sr_delay=30n rise_delay=3n fall_delay=5n ic=1)", f".tran 0.1u {len(rows)}u"]
    done = run_cards(program, "latches", cards)
    if not runs(checker, done, "latches"):
        return
    q, p, of_q, of_p = False, True, [], []
    for k, (e, d, r) in enumerate(rows):
        to_q = bool(d) if e else q
        to_p = (bool(d) or p) and not r if e else p
        of_q += [k * 1e-6 + (33e-9 if to_q else 35e-9)] if to_q != q else []
        of_p += [k * 1e-6 + (33e-9 if to_p else 35e-9)] if to_p != p else []
        q, p = to_q, to_p
    times(checker, edges(done, "v(q)", 0.5), of_q, "d_dlatch")
    times(checker, edges(done, "v(p)", 0.5), of_p, "d_srlatch")


def hysteresis(v, low, high, hyst, bottom, top):
    """The output of each input of a fine course."""
    falls, out = False, []
    for x in v:
        falls = (x > high + hyst) or (falls and not x < low - hyst)
        y = x + hyst if falls else x - hyst
        out.append(bottom + (top - bottom) * min(max((y - low) / (high - low), 0), 1))
    return out


def hystereses(checker, program):
    """Wide and narrow ones, one that turns in the middle of a branch, one without hysteresis, one that falls."""
    for scale, f in ((1, 50), (1e-3, 2e4), (400, 0.1), (30, 1e6)):
        what = f"hystereses at {scale} V"
        cases = {"a": (-0.5, 0.7, 0.4, -1, 3), "b": (0, 1, 0, 2, -1), "d": (-0.01, 0.01, 0.9, 0, 5), "e": (-1.5, 1.5, 0.2, -1, 1)}
        cards = [f"v1 in 0 sin(0 {2 * scale!r} {f!r})", f"v2 x in sin(0 {0.3 * scale!r} {7 * f!r})"]
        for name, (low, high, hyst, bottom, top) in cases.items():
            cards += [f"a{name} x {name} m{name}", f"r{name} {name} 0 1k",
                      f".model m{name} hyst(in_low={low * scale!r} in_high={high * scale!r} hyst={hyst * scale!r} "
                      f"out_lower_limit={bottom!r} out_upper_limit={top!r} input_domain=1n fraction=false)"]
        done = run_cards(program, what, [*cards, f".tran {1e-3 / f!r} {2.2 / f!r}"])
        if not runs(checker, done, what):
            continue
        v = [x / scale for x in done.column("v(x)")]
        for name, case in cases.items():
            wanted = hysteresis(v, *case)
            worst = max(abs(a - b) for a, b in zip(done.column(f"v({name})"), wanted))
            checker.check(worst <= 5e-8, f"{what}: {name} is off by {worst}")


def derivatives(checker, program):
    """d_dt of sines, of ramps with limits, of what a circuit makes; its small signals are s; climit between signals."""
    for scale, f in ((1, 50), (1e-3, 1e6), (500, 0.3), (12, 2e4)):
        what = f"derivatives at {scale} V, {f} Hz"
        w = 2 * math.pi * f
        cards = [f"v1 in 0 dc 0 ac 1 sin(0 {scale!r} {f!r})", "a1 in d md", f".model md d_dt(gain={1 / w!r} out_offset={0.1 * scale!r})", "r1 d 0 1k",
                 "a2 in e me", f".model me d_dt(gain={-2 / w!r} out_lower_limit={-scale!r} out_upper_limit={0.5 * scale!r} limit_range=1n)",
                 "r2 e 0 1k", f"v2 up 0 {0.4 * scale!r}", f"v3 dn 0 sin({-0.5 * scale!r} {0.2 * scale!r} {3 * f!r})",
                 "a3 in up dn l ml", f".model ml climit(in_offset={0.05 * scale!r} gain=1.5 upper_delta={0.1 * scale!r} "
                 f"lower_delta={0.05 * scale!r})", "r3 l 0 1k"]
        done = run_cards(program, what, [*cards, f".tran {0.01 / f!r} {2 / f!r}", f".save v(in) v(d) v(e) v(l)"])
        if not runs(checker, done, what):
            continue
        for t, d, e, l in zip(done.time, done.column("v(d)"), done.column("v(e)"), done.column("v(l)")):
            cosine = scale * math.cos(w * t)
            low = -0.5 * scale + 0.2 * scale * math.sin(3 * w * t) + 0.05 * scale
            checker.close(d, cosine + 0.1 * scale, 1e-8 * scale, f"{what}: d_dt at {t}")
            checker.close(e, min(max(-2 * cosine, -scale), 0.5 * scale), 1e-7 * scale, f"{what}: d_dt in limits at {t}")
            checker.close(l, min(max(1.5 * (scale * math.sin(w * t) + 0.05 * scale), low), 0.3 * scale), 1e-8 * scale,
                          f"{what}: climit at {t}")
        done = run(program, "\n".join(["x", *cards, f".ac lin 1 {f!r} {f!r}", ".end", ""]), method=None)
        checker.check(done.status == 0, f"{what}, .ac: {done.stderr}")
    cards = ["i1 0 o pwl(0 0 1m 1m)", "r1 o 0 2k", "c1 o 0 0.1u", "a1 o d m", ".model m d_dt(gain=1m)", "r2 d 0 1k", ".tran 20u 1m", ".save v(o) v(d)"]
    done = run_cards(program, "the rate of a voltage", cards)
    if runs(checker, done, "the rate of a voltage"):
        for t, d in zip(done.time, done.column("v(d)")):
            checker.close(d, 2 * (1 - math.exp(-t / 0.2e-3)), 1e-7, f"the rate of a voltage at {t}")


def refused(checker, program):
    table = "cntl_array=[0 1] freq_array=[1 2]"
    cases = (("a1 a o m", f".model m triangle({table} duty_cycle=1)", "duty_cycle is above 0 and below 1"),
             ("a1 a o m", ".model m sine(cntl_array=[0 1] freq_array=[1])", "have as many numbers, two at least"),
             ("a1 a o m", ".model m sine(cntl_array=[1 0] freq_array=[1 2])", "those of cntl_array ascend"),
             ("a1 a o m", ".model m square(cntl_array=[0 1] freq_array=[-1 2])", "a frequency cannot be negative"),
             ("a1 a o m", f".model m square({table} out_low=1 out_high=0)", "out_low must be below out_high"),
             ("a1 a o m", f".model m sine({table} rise_time=1)", "sine has no parameter 'rise_time'"),
             ("a1 a o m", f".model m square({table} rise_time=1)", "rise_time is longer than a pulse"),
             ("a1 a b o m", f".model m sine({table})", "'a1' has 3 ports, sine has 2"),
             ("a1 null o m", f".model m sine({table})", "a port of 'a1' must be a node"),
             ("a1 a o m", ".model m hyst(in_low=1 in_high=1)", "in_low must be below in_high"),
             ("a1 a o m", ".model m hyst(hyst=-1)", "hyst cannot be negative"),
             ("a1 a null null o m", ".model m oneshot(cntl_array=[0 1] pw_array=[1])", "have as many numbers"),
             ("a1 null a null o m", ".model m oneshot(cntl_array=[0 1] pw_array=[1 2])", "the clock and the output must be nodes"),
             ("a1 a null null o m", ".model m oneshot(cntl_array=[0 1] pw_array=[1 2] rise_time=-1)", "'rise_time' cannot be negative"),
             ("a1 a o m", ".model m d_dt(out_lower_limit=2 out_upper_limit=1)", "out_lower_limit must be below"),
             ("a1 a b o m", ".model m climit", "'a1' has 3 ports, climit has 4"))
    for card, model, text in cases:
        done = run_cards(program, card, ["v1 a 0 1", "v2 b 0 1", card, model, "r1 o 0 1", ".tran 1 2"])
        checker.check(done.status != 0 and text in done.stderr, f"{card} {model}: {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("oscillators")
    for part in (oscillators, rests, loop, monostables, latches, hystereses, derivatives, refused):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
