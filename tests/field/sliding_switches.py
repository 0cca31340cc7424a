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
import runge_kutta  # noqa: E402
from dalcs_program import Checker, kinds_of, run, some_of  # noqa: E402

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
        "MAX i(l1)": (ampere, 1e-8 * ampere), f"MIN i(l1) FROM={1.1 * reach!r}": (ampere, 1e-8 * ampere),
        f"AVG v(x) FROM={2 * reach!r} TO={stop!r}": (out, 1e-8 * volts),
        f"AVG i(s1) FROM={2 * reach!r} TO={stop!r}": (0.4 * ampere, 1e-8 * ampere),
        f"AVG i(d1) FROM={2 * reach!r} TO={stop!r}": (0.6 * ampere, 1e-8 * ampere)})
    for part in 0.1, 0.01:
        width = part * ampere
        fifth = (ampere + width) * rise + 2 * width * (5 * fall + 4 * rise)
        c.measured(f"current limit, {name}, hysteresis {part}", [
            *cards, f".model sw sw(vt={-ampere!r} vh={width!r} ron=0)"],
            f"{fifth / 100!r} {fifth * (1 + 1e-6) + width * rise!r} uic", {
                "MAX i(l1)": (ampere + width, 1e-8 * ampere),
                f"WHEN i(l1)={ampere!r} FALL=5": (fifth - width * fall, 1e-9 * fifth)}, slides=False)


def complementary(c, name, ampere, volts, henry):
    """The same with a second switch in the diode's place, which closes as the first one opens."""
    out = 0.4 * volts
    reach = ampere * henry / (volts - out)
    stop = 3 * reach
    c.measured(f"complementary, {name}", [
        f"v1 a 0 {volts!r}", "s1 a x 0 m high", "s2 x 0 m 0 low", f"l1 x y {henry!r}", "vs y o 0", f"vo o 0 {out!r}",
        "h1 m 0 vs 1", f".model high sw(vt={-ampere!r} ron=0)", f".model low sw(vt={ampere!r} ron=0)"],
        f"{stop / 100!r} {stop!r} uic", {
            "MAX i(l1)": (ampere, 1e-8 * ampere), f"AVG i(s2) FROM={2 * reach!r} TO={stop!r}": (-0.6 * ampere, 1e-8 * ampere),
            f"AVG v(x) FROM={2 * reach!r} TO={stop!r}": (out, 1e-8 * volts)})


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
        "MAX v(b)": (volts / 4, 1e-8 * volts), f"FIND v(y) AT={at!r}": (wanted, 1e-8 * volts),
        f"AVG i(r1) FROM={seconds!r} TO={3 * seconds!r}": (volts / 4e3, 1e-8 * volts / 1e3)})


def moving_threshold(c, name, ampere, volts, henry):
    """A bridge leg makes a coil's current follow a sine: v(x) is the mean that this takes."""
    seconds = 20 * ampere * henry / volts
    omega = 2 * math.pi / seconds
    r = 0.3 * volts / ampere
    c.measured(f"moving threshold, {name}", [
        f"v1 a 0 {volts!r}", f"v2 b 0 {-volts!r}", "s1 a x e 0 high", "s2 x b 0 e low", f"l1 x y {henry!r}", "vs y o 0",
        f"r1 o 0 {r!r}", "h1 m 0 vs 1", f"vr r 0 sin(0 {ampere!r} {1 / seconds!r})", "e1 e 0 r m 1",
        ".model high sw(vt=0 ron=0)", ".model low sw(vt=0 ron=0)"], f"{seconds / 200!r} {seconds!r} uic", {
            f"FIND i(l1) AT={0.25 * seconds!r}": (ampere, 1e-8 * ampere),
            f"FIND i(l1) AT={0.6 * seconds!r}": (ampere * math.sin(0.6 * 2 * math.pi), 1e-8 * ampere),
            f"FIND v(x) AT={0.25 * seconds!r}": (r * ampere, 1e-7 * volts),
            f"FIND v(x) AT={0.5 * seconds!r}": (-omega * henry * ampere, 1e-7 * volts)})


def inverter(c, name, volts, seconds):
    """A switch that shorts what closes it, without memory, and with some."""
    for place, cards in (("beside", [f"c3 z 0 {seconds / 1e3!r}", "r3 g z 1k"]), ("at", [f"c3 g 0 {seconds / 1e3!r}"])):
        c.measured(f"inverter, memory {place} its input, {name}", [
            f"v1 a 0 {volts!r}", "r1 a g 1k", "s1 g 0 g 0 sw", *cards, f".model sw sw(vt={0.4 * volts!r} ron=1)"],
            f"{seconds / 100!r} {5 * seconds!r} uic", {f"FIND v(g) AT={4.9 * seconds!r}": (0.4 * volts, 1e-8 * volts)})


def leaves(c, name, volts, seconds):
    """The source falls until it cannot hold the threshold any more: sliding ends in time."""
    cards = [f"v1 a 0 pwl(0 {volts!r} {seconds!r} {volts!r} {3 * seconds!r} 0)", "s1 a x 0 b sw", "r1 x b 1k",
             f"c1 b 0 {seconds / 1e5!r}", "r2 b 0 1k", f".model sw sw(vt={-volts / 4!r} ron=1m)"]
    tau = seconds / 1e5 * 1e3 / 2  # closed for good: follows half the source by tau
    slope = -volts / (2 * seconds)
    at = 2.5 * seconds  # the source is at volts/4: b = a/2 - slope/2 tau behind the transient
    source = (volts + slope * (at - seconds)) * 2e3 / (2e3 + 1e-3)  # the switch has a milliohm
    c.measured(f"leaves, {name}", cards, f"{seconds / 100!r} {3 * seconds!r} uic", {
        f"FIND v(b) AT={1.9 * seconds!r}": (volts / 4, 1e-8 * volts),
        f"FIND v(b) AT={at!r}": (source / 2 - slope / 2 * tau, 1e-8 * volts)})


class Regulator:
    """A buck converter whose carrier meets its own ripple, by event-driven integration of Filippov's equations."""

    HENRY, FARAD, ESR, LOAD, SOURCE = 185e-6, 2.288e-6, 3.08, 130.0, 17.25
    OFFSET, GAIN, RISE, WIDTH = 0.3185 + 2.376, -2.376 * 0.11754, 35e-6, 1e-9
    G = 1 / ESR + 1 / LOAD

    def __init__(self, current, volts):
        self.x = [current, volts]
        self.t = 0.0
        self.mode = "on" if self.control(0.0, self.x) > 0 else "off"

    def carrier(self, t):
        """The value, and the slope behind t."""
        if t < self.RISE:
            return t / self.RISE, 1 / self.RISE
        if t < self.RISE + self.WIDTH:
            return 1.0, 0.0
        return 1 - (t - self.RISE - self.WIDTH) / self.RISE, -1 / self.RISE

    def out(self, x):
        return (x[0] + x[1] / self.ESR) / self.G

    def control(self, t, x):
        return self.OFFSET + self.GAIN * self.out(x) - self.carrier(t)[0]

    def charging(self, x):
        return (x[0] - self.out(x) / self.LOAD) / self.FARAD

    def rates(self, x):
        """di/dt with the switch closed, and open."""
        falls = -self.out(x) / self.HENRY if x[0] > 0 else 0.0
        return (self.SOURCE - self.out(x)) / self.HENRY, falls

    def along(self, t, x):
        """di/dt that keeps the control at its threshold."""
        return self.G * self.carrier(t)[1] / self.GAIN - self.charging(x) / self.ESR

    def flow(self, t, x):
        closed, opened = self.rates(x)
        rate = {"on": closed, "off": opened, "none": 0.0}.get(self.mode)
        return [self.along(t, x) if rate is None else rate, self.charging(x)]

    def clearance(self, t, x):
        """Above 0 while the mode holds."""
        if self.mode == "slide":
            closed, opened = self.rates(x)
            return min(closed - self.along(t, x), self.along(t, x) - opened)
        if self.mode == "on":
            return self.control(t, x)
        return min(-self.control(t, x), x[0] if self.mode == "off" else math.inf)

    def turn(self):
        if self.mode == "off" and self.x[0] < 1e-9 and self.control(self.t, self.x) < -1e-9:
            self.mode, self.x[0] = "none", 0.0
            return
        closed, opened = self.rates(self.x)
        along = self.along(self.t, self.x)
        if opened < along < closed and self.mode != "slide":
            self.mode = "slide"
        else:
            self.mode = "on" if self.mode != "on" and along > 0.5 * (opened + closed) else "off"

    def step(self, h):
        return runge_kutta.step(self.flow, self.t, self.x, h)

    def advance(self, until, steps):
        h = (until - self.t) / steps
        while self.t < until - 1e-6 * h:
            size = min(h, until - self.t)
            x = self.step(size)
            if self.clearance(self.t + size * (1 - 1e-12), x) < 0:
                low, high = 0.0, size
                for _ in range(80):
                    middle = 0.5 * (low + high)
                    if self.clearance(self.t + middle, self.step(middle)) < 0:
                        high = middle
                    else:
                        low = middle
                self.x, self.t = self.step(high), self.t + high
                self.turn()
            else:
                self.x, self.t = x, self.t + size


REGULATOR = """a buck converter whose carrier meets its own ripple
vin in 0 17.25
s1 in sw u saw sm
d1 0 sw
l1 sw out 185u ic=0.2878
c1 out esr 2.288u ic=8.99
re esr 0 3.08
r1 out 0 130
vsaw saw 0 pulse(0 1 0 35u 35u 1n 70.001u)
bu u 0 V=0.3185+2.376*(1-0.11754*v(out))
.model sm sw(vt=0)
.tran 70.001u {stop!r} uic
"""


def ripple(c):
    """It slides from where its coil has current, and from where it has none, and stops where the ripple is steep enough;
    how far the run goes is no matter."""
    reference = Regulator(0.2878, 8.99)
    wanted = []
    corners = [reference.RISE, reference.RISE + reference.WIDTH]
    for at in 5e-6, 20e-6, *corners, 50e-6, 52e-6, 60e-6, 70e-6:
        reference.advance(at, 2 if at == corners[1] else 4000)
        if at not in corners:
            wanted.append((at, reference.x[0], reference.out(reference.x)))
    runs = [(1, []), (2, []), (10, []), (40, []), (2, ["--stages", "3"]), (2, ["--stages", "5"]), (2, ["--stages", "9"]),
            (2, ["--method", "lobatto"]), (2, ["--tol", "1e-10"])]
    for periods, options in some_of(runs):
        cards = [f".meas tran {what}{k} find {signal} at={at!r}" for k, (at, *_) in enumerate(wanted)
                 for what, signal in (("i", "i(l1)"), ("v", "v(out)"))]
        outcome = run(sys.argv[1], REGULATOR.format(stop=periods * 70.001e-6) + "\n".join(cards) + "\n.end\n",
                      method=None, options=("--audit", "full", *options))
        name = f"ripple, {periods} periods, {options}"
        if not c.check(outcome.status == 0, f"{name}: {outcome.stderr}"):
            continue
        c.check(outcome.report["work"]["euler_steps"] == 0, f"{name}: implicit Euler")
        got = {m["name"]: m["value"] for m in outcome.report["measurements"]}
        for k, (at, current, volts) in enumerate(wanted):
            c.check(abs(got[f"i{k}"] - current) <= 1e-9, f"{name}: i(l1) at {at} is {got[f'i{k}']}, not {current}")
            c.check(abs(got[f"v{k}"] - volts) <= 2e-8, f"{name}: v(out) at {at} is {got[f'v{k}']}, not {volts}")


FLYBACK = """a flyback converter whose rectifier closes by its own voltage, and rings with its leakage
V1 in 0 48
Lp in d {{50u*z*w}}
Ls 0 s {{2u*z*w}}
K1 Lp Ls 0.99
Coss d 0 {{200p/z*w}}
S1 d 0 g 0 sm
Vg g 0 PULSE(0 5 0 {{10n*w}} {{10n*w}} {{3u*w}} {{10u*w}})
S2 s o s o srm
D2 s o dm
C1 o 0 {{100u/z*w}}
R1 o 0 {{0.5*z}}
.model sm SW(Ron={{50m*z}} Roff={{1Meg*z}} Vt=2.5)
.model srm SW(Ron={{5m*z}} Roff={{1Meg*z}} Vt=0.02)
.model dm D(Ron={{5m*z}} Vfwd=0.5)
.param w={w} z={z}
.tran {{50n*w}} {{4.5u*w}} uic
.meas tran v FIND v(o) AT={{4.5u*w}}
.meas tran i FIND i(Ls) AT={{4.5u*w}}
.end
"""


def false_starts(c, w, z):
    """Micro-steps slide and no longer step does: it goes on by a step of implicit Euler, not by the shortest there is."""
    got = []
    for options in ((), ("--method", "lobatto", "--tol", "1e-8")):
        outcome = run(sys.argv[1], FLYBACK.format(w=w, z=z), method=None, options=options)
        if not c.check(outcome.status == 0, f"a flyback, {w}, {z}, {options}: {outcome.stderr}"):
            return
        problems = outcome.report["work"]["osnsp"]
        c.check(problems < 1e6, f"a flyback, {w}, {z}, {options}: {problems} one-step problems")
        got.append({m["name"]: m["value"] for m in outcome.report["measurements"]})
    for name, scale in (("v", 1.0), ("i", z)):
        a, b = (of[name] * scale for of in got)
        c.check(abs(a - b) <= 1e-3 * abs(b), f"a flyback, {w}, {z}: {name} is {a} and {b}")


SUPPLIES = """two supplies, each behind a switch that closes by its own voltage
V1 a 0 SIN(12 1 {{1k/w}})
V2 b 0 SIN(12 1 {{1k/w}} 0 0 90)
R1 a x {{10m*z}}
R2 b y {{10m*z}}
S1 x o x o srm
S2 y o y o srm
D1 x o dm
D2 y o dm
C1 o 0 {{100u*w/z}}
R3 o 0 {{10*z}}
.model srm SW(Ron={{5m*z}} Roff={{1Meg*z}} Vt=0.02)
.model dm D(Ron={{5m*z}} Vfwd=0.5)
.param w={w} z={z}
.tran {{10u*w}} {{1.2m*w}}
.end
"""


def rounded_errors(c, w, z):
    """The estimate of a segment's error is rounding, which says nothing of longer ones: they are tried all the same."""
    outcome = run(sys.argv[1], SUPPLIES.format(w=w, z=z), method=None, options=[])
    if c.check(outcome.status == 0, f"two supplies, {w}, {z}: {outcome.stderr}"):
        steps = outcome.report["work"]["steps"]
        c.check(steps < 3700, f"two supplies, {w}, {z}: {steps} steps")


def main():
    c = Sliding("sliding_switches")
    units = (("volts", 5.0, 1e-3), ("kilovolts", 5e3, 1e3), ("microvolts", 5e-6, 1e-9))
    looks = [(look, size) for size in some_of(SIZES) for look in (current_limit, complementary, moving_threshold)]
    looks += [(look, unit) for unit in some_of(units) for look in (thermostat, inverter, leaves)]
    looks += [(rounded_errors, of) for of in some_of([(1, 1), (1e-3, 1e3), (1e3, 1e-2)])]
    for look, of in kinds_of([*looks, (ripple, ()), (false_starts, (1, 1))]):
        look(c, *of)
    return c.finish()


if __name__ == "__main__":
    sys.exit(main())
