#!/usr/bin/env python3
"""Switches without hysteresis that open what closes them, against the flow along their threshold (Filippov 1988, ch. 2).

usage: sliding_switches.py PROGRAM

What the circuit does on either side leads to the other one. It goes on by the mean of both that keeps the control at
its threshold (the equivalent control), with which every measured mean has a closed form. With a hysteresis the same
circuits oscillate, at times that have one, too.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SIZES = (("a regulator", 0.5, 5.0, 10e-6), ("kiloamperes", 5e3, 5e3, 1e-3), ("microamperes", 5e-6, 5.0, 1.0),
         ("hours", 5.0, 10.0, 36000.0))


class Sliding(Checker):
    def measured(self, name, cards, tran, wanted, slides=True):
        """wanted: what to measure -> (value, how much it may be off)."""
        lines = [name, *cards, f".tran {tran}", *(f".meas tran m{k} {what}" for k, what in enumerate(wanted)), ".end", ""]
        outcome = run(sys.argv[1], "\n".join(lines), method=None, options=("--audit", "full"))
        if not self.check(outcome.status == 0, f"{name}: {outcome.stderr}"):
            return
        for m, (what, (value, most)) in zip(outcome.report["measurements"], wanted.items()):
            got = m.get("value")
            self.check(got is not None and abs(got - value) <= most, f"{name}: {what} is {got}, not {value}")
        self.check(("slides" in outcome.stderr) == slides, f"{name}: {outcome.stderr}")
        if not slides:
            self.check(outcome.report["work"]["euler_steps"] == 0, f"{name}: implicit Euler")


def current_limit(c, name, ampere, volts, henry):
    """A coil between a switch, which opens at a current, with a diode behind it, and an output."""
    out = 0.4 * volts
    cards = [f"v1 a 0 {volts!r}", "s1 a x 0 m sw", "d1 0 x d", ".model d d(ron=0)", f"l1 x y {henry!r}", "vs y o 0",
             f"vo o 0 {out!r}", "h1 m 0 vs 1"]
    rise, fall = henry / (volts - out), henry / out
    reach = ampere * rise
    stop = 3 * reach
    c.measured(f"current limit, {name}", [*cards, f".model sw sw(vt={-ampere!r} ron=0)"], f"{stop / 100!r} {stop!r} uic", {
        "MAX i(l1)": (ampere, 1e-4 * ampere), f"MIN i(l1) FROM={1.1 * reach!r}": (ampere, 1e-4 * ampere),
        f"AVG v(x) FROM={2 * reach!r} TO={stop!r}": (out, 1e-4 * volts),
        f"AVG i(s1) FROM={2 * reach!r} TO={stop!r}": (0.4 * ampere, 1e-4 * ampere),
        f"AVG i(d1) FROM={2 * reach!r} TO={stop!r}": (0.6 * ampere, 1e-4 * ampere)})
    for part in 0.1, 0.01:
        width = part * ampere
        fifth = (ampere + width) * rise + 2 * width * (5 * fall + 4 * rise)
        c.measured(f"current limit, {name}, hysteresis {part}", [
            *cards, f".model sw sw(vt={-ampere!r} vh={width!r} ron=0)"],
            f"{fifth / 100!r} {fifth * (1 + 1e-6) + width * rise!r} uic", {
                "MAX i(l1)": (ampere + width, 1e-5 * ampere),
                f"WHEN i(l1)={ampere!r} FALL=5": (fifth - width * fall, 1e-5 * fifth)}, slides=False)


def complementary(c, name, ampere, volts, henry):
    """The same with a second switch in the diode's place, which closes as the first one opens."""
    out = 0.4 * volts
    reach = ampere * henry / (volts - out)
    stop = 3 * reach
    c.measured(f"complementary, {name}", [
        f"v1 a 0 {volts!r}", "s1 a x 0 m high", "s2 x 0 m 0 low", f"l1 x y {henry!r}", "vs y o 0", f"vo o 0 {out!r}",
        "h1 m 0 vs 1", f".model high sw(vt={-ampere!r} ron=0)", f".model low sw(vt={ampere!r} ron=0)"],
        f"{stop / 100!r} {stop!r} uic", {
            "MAX i(l1)": (ampere, 1e-4 * ampere), f"AVG i(s2) FROM={2 * reach!r} TO={stop!r}": (-0.6 * ampere, 1e-4 * ampere),
            f"AVG v(x) FROM={2 * reach!r} TO={stop!r}": (out, 1e-4 * volts)})


def thermostat(c, name, volts, seconds):
    """A capacitor is charged below a voltage, and discharged always; what follows it has memory, too."""
    cards = [f"v1 a 0 {volts!r}", "s1 a x 0 b sw", "r1 x b 1k", f"c1 b 0 {seconds / 1e3!r}", "r2 b 0 1k",
             "e1 f 0 b 0 1", "r3 f y 1k", f"c3 y 0 {seconds / 1e3!r}", f".model sw sw(vt={-volts / 4!r})"]
    first = 0.5 * seconds * math.log(2.0)  # to volts/4, of volts/2
    # y' = (b - y)/seconds behind that
    at = first + seconds

    def rise(t):  # y while b = volts/2 (1 - exp(-2t/seconds))
        return volts / 2 * (1 - 2 * math.exp(-t / seconds) + math.exp(-2 * t / seconds))
    wanted = volts / 4 + (rise(first) - volts / 4) * math.exp(-(at - first) / seconds)
    c.measured(f"thermostat, {name}", cards, f"{seconds / 100!r} {3 * seconds!r} uic", {
        "MAX v(b)": (volts / 4, 1e-5 * volts), f"FIND v(y) AT={at!r}": (wanted, 1e-4 * volts),
        f"AVG i(r1) FROM={seconds!r} TO={3 * seconds!r}": (volts / 4e3, 1e-5 * volts / 1e3)})


def moving_threshold(c, name, ampere, volts, henry):
    """A bridge leg makes a coil's current follow a sine: v(x) is the mean that this takes."""
    seconds = 20 * ampere * henry / volts
    omega = 2 * math.pi / seconds
    r = 0.3 * volts / ampere
    c.measured(f"moving threshold, {name}", [
        f"v1 a 0 {volts!r}", f"v2 b 0 {-volts!r}", "s1 a x e 0 high", "s2 x b 0 e low", f"l1 x y {henry!r}", "vs y o 0",
        f"r1 o 0 {r!r}", "h1 m 0 vs 1", f"vr r 0 sin(0 {ampere!r} {1 / seconds!r})", "e1 e 0 r m 1",
        ".model high sw(vt=0 ron=0)", ".model low sw(vt=0 ron=0)"], f"{seconds / 200!r} {seconds!r} uic", {
            f"FIND i(l1) AT={0.25 * seconds!r}": (ampere, 1e-3 * ampere),
            f"FIND i(l1) AT={0.6 * seconds!r}": (ampere * math.sin(0.6 * 2 * math.pi), 1e-3 * ampere),
            f"FIND v(x) AT={0.25 * seconds!r}": (r * ampere, 3e-3 * volts),
            f"FIND v(x) AT={0.5 * seconds!r}": (-omega * henry * ampere, 3e-3 * volts)})


def inverter(c, name, volts, seconds):
    """A switch that shorts what closes it, without memory, and with some."""
    for place, cards in (("beside", [f"c3 z 0 {seconds / 1e3!r}", "r3 g z 1k"]), ("at", [f"c3 g 0 {seconds / 1e3!r}"])):
        c.measured(f"inverter, memory {place} its input, {name}", [
            f"v1 a 0 {volts!r}", "r1 a g 1k", "s1 g 0 g 0 sw", *cards, f".model sw sw(vt={0.4 * volts!r} ron=1)"],
            f"{seconds / 100!r} {5 * seconds!r} uic", {f"FIND v(g) AT={4.9 * seconds!r}": (0.4 * volts, 1e-4 * volts)})


def leaves(c, name, volts, seconds):
    """The source falls until it cannot hold the threshold any more: sliding ends in time."""
    cards = [f"v1 a 0 pwl(0 {volts!r} {seconds!r} {volts!r} {3 * seconds!r} 0)", "s1 a x 0 b sw", "r1 x b 1k",
             f"c1 b 0 {seconds / 1e5!r}", "r2 b 0 1k", f".model sw sw(vt={-volts / 4!r} ron=1m)"]
    tau = seconds / 1e5 * 1e3 / 2  # closed for good: follows half the source by tau
    slope = -volts / (2 * seconds)
    at = 2.5 * seconds  # the source is at volts/4: b = a/2 - slope/2 tau behind the transient
    source = volts + slope * (at - seconds)
    c.measured(f"leaves, {name}", cards, f"{seconds / 100!r} {3 * seconds!r} uic", {
        f"FIND v(b) AT={1.9 * seconds!r}": (volts / 4, 1e-4 * volts),
        f"FIND v(b) AT={at!r}": (source / 2 - slope / 2 * tau, 1e-4 * volts)})


def main():
    c = Sliding("sliding_switches")
    for size in some_of(SIZES):
        current_limit(c, *size)
        complementary(c, *size)
        moving_threshold(c, *size)
    for name, volts, seconds in (("volts", 5.0, 1e-3), ("kilovolts", 5e3, 1e3), ("microvolts", 5e-6, 1e-9)):
        thermostat(c, name, volts, seconds)
        inverter(c, name, volts, seconds)
        leaves(c, name, volts, seconds)
    return c.finish()


if __name__ == "__main__":
    sys.exit(main())
