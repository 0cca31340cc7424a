#!/usr/bin/env python3
"""Relaxation oscillators whose switch, with hysteresis, opens on what its closing did, against closed forms.

usage: relaxation_oscillators.py PROGRAM

With a resistance the states fall fast, up to 1e-12 of the run, and the switch opens where its control passes the other
threshold on the way. Without one they jump as far as the closed switch lets them, and it opens behind that. So does one
that gates command: its gate is low before and behind.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

CLOSE = 1e-6  # relative, for what the default tolerance gives


def model(on, off, ron):
    return f".model sw sw(vt={(on + off) / 2!r} vh={(on - off) / 2!r} ron={ron!r})"


def measured(checker, name, cards, stop, wanted):
    """wanted: measurement -> (what to measure, value)."""
    lines = [name, *cards, f".tran {stop / 1000!r} {stop!r} uic"]
    lines += [f".meas tran {m} {what}" for m, (what, _) in wanted.items()] + [".end", ""]
    outcome = run(program(), "\n".join(lines), method=None)
    if not outcome.report:
        checker.check(False, f"{name}: no report: {outcome.stderr}")
        return None
    found = {m["name"]: m.get("value") for m in outcome.report["measurements"]}
    for m, (_, value) in wanted.items():
        ok = found[m] is not None and abs(found[m] - value) <= CLOSE * abs(value)
        checker.check(ok, f"{name}: {m} is {found[m]}, not {value}")
    work = outcome.report["work"]
    checker.check(work["euler_steps"] == 0, f"{name}: {work['euler_steps']} steps of implicit Euler")
    checker.check("did not agree" not in outcome.stderr and "slides" not in outcome.stderr, f"{name}: it slides")
    return outcome


def program():
    return sys.argv[1]


def flash(checker, name, source, r, c, on, off, ron, rounds=9, gate="b 0", more=()):
    """C charged through R; the switch across it strikes at `on` and quenches at `off`."""
    tau, final = r * c, source * ron / (r + ron)
    low, fall = (off, r * ron / (r + ron) * c * math.log((on - final) / (off - final))) if ron > 0 else (0.0, 0.0)
    first = tau * math.log(source / (source - on))
    period = tau * math.log((source - low) / (source - on)) + fall
    level = (on + off) / 2

    def rise(k):
        return tau * math.log(source / (source - level)) if k == 1 else (
            first + (k - 2) * period + fall + tau * math.log((source - low) / (source - level)))
    cards = [f"v1 a 0 {source!r}", f"r1 a b {r!r}", f"c1 b 0 {c!r}", f"s1 b 0 {gate} sw", model(on, off, ron), *more]
    outcome = measured(checker, name, cards, first + (rounds - 0.5) * period, {
        "second": (f"WHEN v(b)={level!r} RISE=2", rise(2)),
        "last": (f"WHEN v(b)={level!r} RISE={rounds}", rise(rounds)),
        "most": ("MAX v(b)", on)})
    if outcome is not None and ron > 0:
        opens = [e["time"] for e in outcome.report["events"] if e["state"] == "off"]
        checker.check(len(opens) == rounds and abs(opens[0] - first - fall) <= 1e-12 * outcome.report["stop"],
                      f"{name}: quenches at {opens[:1]}, not at {first + fall}")
    elif outcome is not None:
        jumps = outcome.report["jumps"]
        charge = [j["impulses"]["s1"]["charge"] for j in jumps]
        checker.check(len(jumps) == rounds and all(abs(q - c * on) <= CLOSE * c * on for q in charge),
                      f"{name}: {len(jumps)} jumps of {charge[:2]}, not of {c * on}")


def flashes(checker):
    for ron in (1.0, 1e-2, 1e-3, 0.0):
        flash(checker, f"300 V, {ron} ohm", 300.0, 1e5, 1e-5, 250.0, 50.0, ron)
        flash(checker, f"5 V, {ron} ohm", 5.0, 1e3, 1e-9, 3.3, 1.7, ron)
        flash(checker, f"20 kV, {ron} ohm", 2e4, 1e6, 1e-6, 1.5e4, 1e3, ron)
    flash(checker, "400 times", 5.0, 1e3, 1e-9, 3.3, 1.7, 0.0, rounds=400)
    flash(checker, "400 times, 1 mohm", 5.0, 1e3, 1e-9, 3.3, 1.7, 1e-3, rounds=400)
    flash(checker, "gate through E", 5.0, 1e3, 1e-9, 3.3, 1.7, 0.0, gate="g 0", more=["e1 g 0 b 0 1"])
    flash(checker, "beside a filter", 5.0, 1e3, 1e-9, 3.3, 1.7, 0.0,
          more=["v9 q 0 sin(0 1 1meg)", "r8 q p 10", "c9 p 0 1u", "r9 p 0 1k"])


def share(checker, name, source, r1, c1, c2, r2, on, off, rounds):
    """The switch joins c1, which is charged, with c2, which is loaded."""
    t = first = second = 0.0
    for _ in range(rounds):
        wait = r1 * c1 * math.log((source - first) / (source - on))
        t += wait
        second *= math.exp(-wait / (r2 * c2))
        first = second = (c1 * on + c2 * second) / (c1 + c2)
    cards = [f"v1 s 0 {source!r}", f"r1 s x {r1!r}", f"c1 x 0 {c1!r}", "s1 x z x 0 sw", f"c2 z 0 {c2!r}",
             f"r2 z 0 {r2!r}", model(on, off, 0.0)]
    level = (on + off) / 2
    measured(checker, name, cards, t * (1 + 1e-9), {
        "last": (f"WHEN v(x)={level!r} FALL={rounds}", t), "left": (f"FIND v(z) AT={t * (1 + 1e-9)!r}", second)})


def others(checker):
    share(checker, "5 V shared", 5.0, 1e3, 5e-9, 10e-9, 200.0, 2.5, 2.0, 6)
    share(checker, "400 V shared", 400.0, 1e4, 1e-6, 100e-6, 50.0, 350.0, 100.0, 9)
    # 4.92 nF on x fall from 2.567 to 1.253 V through the switch into 10 nF: the more like that, the less Ron
    moved = 4.92e-9 / 10e-9 * (2.567 - 1.253)
    for ron, allowed in ((1e-1, 1e-3), (1e-3, 1e-4)):
        outcome = run(program(), "\n".join([
            "shared through a diode", "v1 s 0 5", "r2 s x1 1k", "c7 x1 0 4.92n", "s8 x1 y1 x1 0 sw", "d10 y1 z1 di",
            "c11 z1 0 10n", "r12 z1 0 10k", f".model sw sw(ron={ron!r} vh=0.657 vt=1.91)", ".model di d(ron=0)",
            ".tran 1u 10u uic", ".meas tran most MAX v(z1) FROM=0 TO=4.5u", ".end", ""]), method=None)
        most = outcome.report["measurements"][0]["value"]
        checker.close(most, moved, allowed, f"shared through a diode and {ron} ohm")
    # the gap of a capacitor that stands on -3 V
    tau = 2e3 * 1e-7
    measured(checker, "a gap", ["v1 a 0 12", "v2 q 0 -3", "r1 a b 2k", "c1 b q 100n", "s1 b q b q sw", model(8.0, 1.0, 0.0)],
             8.5 * tau * math.log(15 / 7), {"last": ("WHEN v(b,q)=4 RISE=8", tau * (7 * math.log(15 / 7) + math.log(15 / 11))),
                                            "most": ("MAX v(b,q)", 8.0)})
    # the dual: a coil whose current opens the switch that feeds it
    period = 1e-3 * math.log(1 / 0.4)
    measured(checker, "an interrupter", ["v1 a 0 10", "r1 a b 10", "l1 b c 10m", "vs c d 0", "s1 d 0 g 0 sw on", "h1 g 0 vs -1",
                                         model(-0.2, -0.6, 0.0)],
             8.5 * period, {"last": ("WHEN i(l1)=0.3 RISE=8", 7 * period + 1e-3 * math.log(1 / 0.7)),
                            "most": ("MAX i(l1)", 0.6)})
    # by a current, and two in one part
    measured(checker, "by a current", ["v1 a 0 300", "r1 a b 100k", "c1 b 0 10u", "g1 0 e b 0 1", "vs e 0 0", "w1 b 0 vs sw",
                                       ".model sw csw(it=150 ih=100 ron=0)"],
             16.0, {"last": ("WHEN v(b)=200 RISE=9", 8 * math.log(6) + math.log(3))})
    measured(checker, "two", ["v1 a 0 300", "r1 a b 100k", "c1 b 0 10u", "s1 b 0 b 0 sw", "r2 a d 47k", "c2 d 0 10u",
                              "s2 d 0 d 0 sw", "rc b d 1t", model(250.0, 50.0, 0.0)],
             16.0, {"last": ("WHEN v(b)=200 RISE=9", 8 * math.log(6) + math.log(3)),
                    "second": ("WHEN v(d)=200 RISE=9", 0.47 * (8 * math.log(6) + math.log(3)))})


def saw(checker, name, current, c, on, control, node="b 0", base="0", rounds=9):
    """C fed by a current; gates discharge it at `on` and are back before time goes on: high for no time."""
    period = c * on / current
    cards = [f"i1 {base} b {current!r}", f"c1 b {base} {c!r}", *control]
    high, low = node.split()
    level = f"v({high})" if low == "0" else f"v({high},{low})"
    outcome = measured(checker, name, cards, (rounds - 0.5) * period, {
        "second": (f"WHEN {level}={on / 2!r} RISE=2", 1.5 * period),
        "last": (f"WHEN {level}={on / 2!r} RISE={rounds - 1}", (rounds - 1.5) * period),
        "most": (f"MAX {level}", on)})
    jumps = outcome.report["jumps"] if outcome is not None else []
    checker.check(len(jumps) == rounds - 1, f"{name}: {len(jumps)} jumps, not {rounds - 1}")


def gated(checker):
    schmitt = "SCHMITT vt={!r} vh={!r}"
    switch = ".model sw sw(vt=0.5)"
    for current, c, on in ((1e-3, 10e-9, 1.0), (2.0, 1e-3, 300.0), (1e-7, 1e-12, 0.02)):
        law = schmitt.format(0.55 * on, 0.45 * on)
        saw(checker, f"a Schmitt gate at {on} V", current, c, on, ["s1 b 0 q 0 sw", f"a1 b 0 0 0 0 0 q 0 {law}", switch])
        saw(checker, f"a latch that is set all the time, at {on} V", current, c, on, [
            "s1 b 0 nq 0 sw", f"a1 b 0 0 0 0 0 t 0 {schmitt.format(0.8 * on, 0.2 * on)}", "vz z 0 1",
            "a2 z t 0 0 0 nq q 0 SRFLOP", "r9 q 0 1k", switch])
        saw(checker, f"a formula, at {on} V", current, c, on, [
            "s1 b 0 q 0 sw", f"b1 q 0 v=v(b) > {on!r} ? 1 : 0", ".model sw sw(vt=0.5 vh=0.2)"])
        saw(checker, f"a latch behind a formula, at {on} V", current, c, on, [
            "s1 b 0 nq 0 sw", f"b1 t 0 v=v(b) > {on!r} ? 1 : 0", "vz z 0 1", "a2 z t 0 0 0 nq q 0 SRFLOP", "r9 q 0 1k", switch])
    saw(checker, "on a floating stage, through E", 1e-3, 10e-9, 1.0, [
        "vf f 0 SIN(0 5 10k)", "s1 b f g f sw", f"a1 b f 0 0 0 0 q 0 {schmitt.format(0.55, 0.45)}", "e1 g f q 0 10",
        ".model sw sw(vt=5)"], node="b f", base="f")
    saw(checker, "a flip-flop that clears itself", 1e-3, 10e-9, 1.0, [
        "s1 b 0 q 0 sw", f"a1 b 0 0 0 0 0 k 0 {schmitt.format(0.55, 0.45)}", "a2 k 0 0 0 0 nk x 0 BUF", "r9 x 0 1k", "vz z 0 1",
        "a3 z 0 k 0 nk 0 q 0 DFLOP", switch])
    # a timer with two comparators and no resistance in its discharge
    measured(checker, "a timer", ["v1 a 0 5", "r1 a b 10k", "c1 b 0 10n", "vh h 0 3", "vl l 0 1", "a1 b h 0 0 0 0 x 0 SCHMITT",
                                  "a2 l b 0 0 0 0 y 0 SCHMITT", "a3 x y 0 0 0 0 q 0 SRFLOP", "s1 b 0 q 0 sw", switch],
             8.5e-4 * math.log(2.5), {
                 "last": ("WHEN v(b)=2 RISE=8", 1e-4 * (7 * math.log(2.5) + math.log(5 / 3))), "most": ("MAX v(b)", 3.0)})
    # the dual: a gate cuts a coil off, and is back with the current
    measured(checker, "a gated interrupter", ["v1 a 0 10", "l1 a b 1m", "s1 b 0 nq 0 sw", "h1 h 0 v1 -1",
                                              f"a1 h 0 0 0 0 nq q 0 {schmitt.format(0.55, 0.45)}", "r9 q 0 1k", switch],
             8.5e-4, {"last": ("WHEN i(l1)=0.5 RISE=8", 7.5e-4), "most": ("MAX i(l1)", 1.0)})


def at_rest(checker):
    """An integrator and a comparator, from where neither has a reason to leave: all is 0 but for rounding."""
    for volts in (1e-2, 10.0, 1e3):
        outcome = run(program(), "\n".join([
            "a triangle that does not begin", f"b1 sq 0 v=limit(1e5*v(p),{-volts!r},{volts!r})", "r1 sq p 20k", "r2 tri p 10k",
            "r3 sq x 10k", "c1 x tri 10n ic=0", f"b3 tri 0 v=limit(-1e6*v(x),{-1.2 * volts!r},{1.2 * volts!r})",
            ".tran 1u 4m uic", ".end", ""]), method=None, options=["--audit", "full", "--energy"])
        checker.check(outcome.status == 0, f"at rest between {volts} V: {outcome.stderr[:300]}")


def main():
    checker = Checker("relaxation_oscillators")
    at_rest(checker)
    flashes(checker)
    others(checker)
    gated(checker)
    return checker.finish()


sys.exit(main())
