#!/usr/bin/env python3
"""Subcircuits that are installed with dalcs: control.lib, UniversalOpamps2.sub and NE555.sub, against closed forms.

usage: libraries.py PROGRAM

The program finds them where it was built.
"""

import math
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # noqa: E402
from dalcs_program import Checker  # noqa: E402
from logic import edges, root, runs, times  # noqa: E402


def run(program, what, cards, environment=None):
    return dalcs_program.run(program, "\n".join([what, *cards, ".end", ""]), method=None, tolerance=1e-10,
                             environment=environment)


def modulators(checker, program):
    """Both edges of each period, and the dead time of each gate."""
    for f, carrier, depth, dead, high in ((50, 450, 0.9, 2e-5, 15), (1e3, 2e4, 0.5, 0, 1), (1, 10, 0.99, 1e-3, 5)):
        what = f"pwm at {carrier} Hz"
        cards = [".lib control.lib", f"v1 m 0 sin(0 {depth} {f})", f"x1 m hi lo pwm f={carrier} dead={dead!r} vhigh={high}",
                 "r1 hi 0 1k", "r2 lo 0 1k", f".tran {0.3 / carrier!r} {1 / f!r}"]
        done = run(program, what, cards)
        if not runs(checker, done, what):
            continue
        wanted = []
        for k in range(round(carrier / f)):
            def up(t, k=k):
                return depth * math.sin(2 * math.pi * f * t) - (4 * (t * carrier - k) - 1)

            def down(t, k=k):
                return depth * math.sin(2 * math.pi * f * t) - (3 - 4 * (t * carrier - k))
            wanted += [root(up, k / carrier, (k + 0.5) / carrier), root(down, (k + 0.5) / carrier, (k + 1) / carrier)]
        upper = [t for a, b in zip(wanted[1::2], wanted[2::2] + [1 / f]) if b - a > dead for t in (a + dead, b)]
        lower = [t for a, b in zip(wanted[::2], wanted[1::2]) if b - a > dead for t in (a + dead, b)]
        times(checker, edges(done, "v(hi)", high / 2), [wanted[0], *upper][:len(upper)], f"{what}, upper", 1e-8)
        times(checker, edges(done, "v(lo)", high / 2), lower, f"{what}, lower", 1e-8)


def controllers(checker, program):
    """PI: no windup, so it leaves its limit when its error turns. PID of a jump. An integrator that is reset."""
    for kp, ki, limit, unit in ((0.5, 1e3, 1, 1e-3), (2, 0.1, 24, 100), (0, 1e6, 0.5, 1e-6)):
        what = f"a PI of {kp}, {ki}"
        # the error is +1 for 5 units, then -0.5: the integral is at its limit by then
        cards = [".include control.lib", f"v1 e 0 pulse({limit} {-limit / 2} {5 * unit!r} 0 0 1 2)" if unit < 0.1 else
                 f"v1 e 0 pulse({limit} {-limit / 2} {5 * unit!r} 0 0 10000 20000)",
                 f"x1 e u pi kp={kp} ki={ki} low={-limit} high={limit}", "r1 u 0 1k", f".tran {unit / 7!r} {9 * unit!r}"]
        done = run(program, what, cards)
        if not runs(checker, done, what):
            continue
        for t, u in zip(done.time, done.column("v(u)")):
            if abs(t - 5 * unit) < 1e-6 * unit:
                continue
            e = limit if t < 5 * unit else -limit / 2
            x = min(limit, ki * limit * t) if t < 5 * unit else max(-limit, min(limit, 5 * ki * limit * unit) - ki * limit / 2 * (t - 5 * unit))
            checker.close(u, min(max(kp * e + x, -limit), limit), 1e-8 * limit, f"{what} at {t}")
    what = "a PID"
    cards = [".lib control.lib", "v1 e 0 pulse(0 0.1 1m 0 0 1 2)", "x1 e u pid kp=2 ki=50 kd=1m tf=0.5m low=-10 high=10",
             "r1 u 0 1k", ".tran 0.1m 6m"]
    done = run(program, what, cards)
    if runs(checker, done, what):
        for t, u in zip(done.time, done.column("v(u)")):
            if abs(t - 1e-3) > 1e-9:
                after = t - 1e-3
                checker.close(u, 0 if after < 0 else 0.1 * (2 + 50 * after + 2 * math.exp(-after / 0.5e-3)), 1e-8, f"{what} at {t}")
    for k in (1e3, -2e3):
        what = f"an integrator of {k}"
        cards = [".lib control.lib", "v1 a 0 2", "v2 r 0 pulse(1 0 1m 0 0 2m 3m)", f"x1 a r o integrator k={k}", "r1 o 0 1k",
                 ".tran 0.1m 8m uic"]
        done = run(program, what, cards)
        if runs(checker, done, what):
            for t, o in zip(done.time, done.column("v(o)")):
                phase = math.fmod(t, 3e-3)
                if min(abs(phase - 1e-3), abs(phase), abs(phase - 3e-3)) > 1e-9:
                    checker.close(o, 2 * k * max(0, phase - 1e-3), 1e-7, f"{what} at {t}")
    what = "a comparator"
    cards = [".lib control.lib", "v1 a 0 sin(0 1 1k)", "x1 a 0 o comparator vhigh=5 vlow=-5 vh=0.5", "r1 o 0 1k", ".tran 10u 2m"]
    done = run(program, what, cards)
    if runs(checker, done, what):
        times(checker, edges(done, "v(o)", 0), [x * 1e-3 / 12 for x in (1, 7, 13, 19)], what)


def without_integral(checker, program):
    """A controller of gain 2 whose integral has the gain 0, from its operating point on."""
    what = "a controller without its integral"
    done = run(program, what, [".lib control.lib", "v1 e 0 sin(0 2 1k)", "x1 e u pi kp=2 ki=0 high=3 low=-1", "r1 u 0 1k",
                               "x2 e d pid kp=1 ki=0 kd=0 ic=0.5 high=5", "r2 d 0 1k", ".tran 10u 1m"])
    if runs(checker, done, what):
        for e, u, d in zip(done.column("v(e)"), done.column("v(u)"), done.column("v(d)")):
            checker.close(u, min(max(2 * e, -1), 3), 1e-9, what)
            checker.close(d, max(e + 0.5, -1), 1e-9, what)


def amplifiers(checker, program):
    """A follower's pole; rails; slew, up and down; a short of the output; offset; level 1 has no limits."""
    for gbw, level in ((1e6, "level.1"), (10e6, "level.2"), (1e4, "level.3a"), (1e5, "level.3b"),
                       (2e6, "level1"), (3e6, "level2"), (4e5, "level3a"), (5e7, "level3b")):
        what = f"a follower of {gbw} Hz, {level}"
        library = "UniversalOpamps2.sub" if "." in level else "UniversalOpAmp2.lib"
        w = 2 * math.pi * gbw
        cards = [f".lib {library}", "vp p 0 15", "vn n 0 -15", f"v1 in 0 pulse(0 1m {1 / w!r} 0 0 1 2)",
                 f"x1 in o p n o {level} Avol=1Meg GBW={gbw} Slew=1T Vos=0", "r1 o 0 1k", f".tran {0.2 / w!r} {9 / w!r}"]
        done = run(program, what, cards)
        if runs(checker, done, what):
            pole = w * (1 + 1e-6)
            for t, o in zip(done.time, done.column("v(o)")):
                if abs(t - 1 / w) > 1e-6 / w:
                    checker.close(o, 0 if t < 1 / w else 1e-3 / (1 + 1e-6) * (1 - math.exp(-pole * (t - 1 / w))), 5e-9, f"{what} at {t}")
    what = "an inverting amplifier at its rails"
    cards = [".lib UniversalOpamps2.sub", "vp p 0 12", "vn n 0 -5", "v1 in 0 sin(0 2 10)", "r1 in m 1k", "r2 m o 10k",
             "x1 0 m p n o level.2 Avol=1G GBW=1G Slew=1T Rail=1 Rin=1T", "r3 o 0 10k", ".tran 1m 0.1"]
    done = run(program, what, cards)
    if runs(checker, done, what):
        for v, o in zip(done.column("v(in)"), done.column("v(o)")):
            checker.close(o, min(max(-10 * v, -4), 11), 1e-4, what)
    what = "a slewing follower"
    cards = [".lib UniversalOpamps2.sub", "vp p 0 15", "vn n 0 -15", "v1 in 0 pulse(-5 5 1u 0 0 20u 40u)",
             "x1 in o p n o level.2 GBW=1G Slew=1Meg", "r1 o 0 1k", ".tran 1u 40u"]
    done = run(program, what, cards)
    if runs(checker, done, what):
        for t, o in zip(done.time, done.column("v(o)")):
            wanted = -5 if t < 1e-6 else min(5, -5 + 1e6 * (t - 1e-6)) if t < 21e-6 else max(-5, 5 - 1e6 * (t - 21e-6))
            checker.close(o, wanted, 2e-3, f"{what} at {t}")
    what = "a shorted output"
    cards = [".lib UniversalOpamps2.sub", "vp p 0 15", "vn n 0 -15", "v1 in 0 sin(0 5 1k)",
             "x1 in f p n o level.2 GBW=10G Slew=1T ilimit=20m", "ef f 0 o 0 1", "r1 o 0 100", ".tran 10u 1m"]
    done = run(program, what, cards)
    if runs(checker, done, what):
        for v, o in zip(done.column("v(in)"), done.column("v(o)")):
            checker.close(o, min(max(v, -2), 2), 5e-3, what)  # what is inside winds up to the rails


def timers(checker, program):
    """A 555 that runs free, that makes one pulse for each trigger, as a Schmitt trigger, and held by its reset."""
    own = 10  # ohms of its switches
    for volts, ra, rb, farad in ((9, 1e4, 47e3, 1e-8), (5, 1e3, 1e6, 1e-6), (15, 1e5, 1e5, 1e-10)):
        what = f"a timer of {ra} and {rb} ohm"
        up = math.log(2) * (ra + rb) * farad
        low, r = volts * own / (ra + own), rb + ra * own / (ra + own)
        down = r * farad * math.log((2 * volts / 3 - low) / (volts / 3 - low))
        first = math.log(3) * (ra + rb) * farad
        done = run(program, what, [".lib NE555.sub", f"v1 p 0 {volts}", "x1 0 c o p k c d p NE555", f"ra p d {ra!r}", f"rb d c {rb!r}",
                                   f"c1 c 0 {farad!r} ic=0", "rl o 0 1k", f".tran {up / 10!r} {first + 3.5 * (up + down)!r} uic"])
        if runs(checker, done, what):
            falls = [first + k * (up + down) for k in range(4)]
            wanted = sorted(falls + [t + down for t in falls])
            found = [t for t in edges(done, "v(o)", volts / 2) if t > 0]
            times(checker, found, wanted[:len(found)], what)
            checker.check(len(found) >= 6, f"{what}: {len(found)} edges")
            checker.close(max(done.column("v(o)")), volts * 1000 / 1010, 1e-9, f"{what}: its output")
    for volts, r, farad in ((5, 1e5, 1e-8), (12, 1e4, 1e-6)):
        what = f"a pulse of {r} ohm"
        low = volts * own / (r + own)
        width = r * farad * math.log((volts - low) / (volts / 3))
        done = run(program, what, [".lib NE555.sub", f"v1 p 0 {volts}", f"vt t 0 pulse({volts} 0 {width!r} 0 0 {width / 20!r} {3 * width!r})",
                                   "x1 0 t o p k c c p NE555", f"r1 p c {r!r}", f"c1 c 0 {farad!r}", "rl o 0 1k",
                                   f".tran {width / 10!r} {6.5 * width!r}"])
        if runs(checker, done, what):
            times(checker, edges(done, "v(o)", volts / 2), [width, 2 * width, 4 * width, 5 * width], what, 1e-8)
    cards = [".lib NE555.sub", "v1 p 0 9", "v2 i 0 sin(4.5 4.5 50)", "v3 r 0 pulse(9 0 15m 0 0 1 2)", "x1 0 i o r k i d p NE555", "rl o 0 1k",
             ".tran 1m 60m"]
    done = run(program, "a Schmitt trigger", cards)
    if runs(checker, done, "a Schmitt trigger"):
        third = math.asin(1 / 3) / (2 * math.pi * 50)
        found = [t for t in edges(done, "v(o)", 4.5) if t > 0]
        times(checker, found, [10e-3 + third, 15e-3], "a Schmitt trigger that a reset ends", 1e-9)


def places(checker, program):
    """A file that is nowhere is an error where it is needed. The folder that DALCS_LIBRARIES names comes before those of dalcs, which have
    what it has not."""
    cards = ["v1 a 0 2", "x1 a b twice", "r1 b 0 1k", ".tran 1 2"]
    for library in ("nowhere.lib", "control.lib"):
        done = run(program, library, [f".lib {library}", *cards])
        expected = "it may be in 'nowhere.lib'" if library == "nowhere.lib" else "twice"
        checker.check(done.status != 0 and expected in done.stderr, f"{library}: {done.stderr}")
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "control.lib").write_text(".subckt twice a b\ne1 b 0 a 0 2\n.ends\n")
        done = run(program, "a folder that is named",
                   [".lib control.lib", ".lib UniversalOpamps2.sub", *cards], {"DALCS_LIBRARIES": folder})
        if runs(checker, done, "a folder that is named"):
            checker.close(done.column("v(b)")[-1], 4, 1e-9, "from a folder that is named")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("libraries")
    for part in (modulators, controllers, without_integral, amplifiers, timers, places):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
