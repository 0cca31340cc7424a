#!/usr/bin/env python3
"""Formulas of what sources alone decide: gates with dead time from comparisons of references with carriers, in many forms.

usage: decided_formulas.py PROGRAM

Each circuit is run with its formulas, and once more with PWL sources instead, whose edges are computed here from the
carriers and references alone: zeros of differences between two corners of a carrier, to the last bit.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

STOP = 4e-3
HALF = 250e-6  # of a carrier


def sine(amplitude, frequency, phase=0.0, offset=0.0):
    return lambda t: offset + amplitude * math.sin(2 * math.pi * frequency * t + math.radians(phase))


def triangle(low, high, delay=0.0):
    """From `low` at the delay on; before it `low`."""
    def value(t):
        place = math.fmod(t - delay, 2 * HALF) / HALF if t > delay else 0.0
        return low + (high - low) * (place if place < 1 else 2 - place)
    return value


def pulse(name, low, high, delay=0.0):
    return f"v{name} {name} 0 pulse({low} {high} {delay!r} {HALF!r} {HALF!r} 0 {2 * HALF!r})"


def edges(function, corners):
    """Where a step function of time moves: [(time, before, after)]."""
    found = []
    grid = sorted(set(corners) | {STOP * k / 20000 for k in range(20001)})
    for left, right in zip(grid, grid[1:]):
        a, b = left + 1e-13 * STOP, right - 1e-13 * STOP
        before, after = function(a), function(b)
        if found and found[-1][2] != before:  # at the point of the grid itself
            found.append((left, found[-1][2], before))
        elif not found:
            found.append((0.0, before, before))
        if before != after:
            while True:
                middle = 0.5 * (a + b)
                if middle in (a, b):
                    break
                a, b = (middle, b) if function(middle) == before else (a, middle)
            found.append((b, before, after))
    return found


def pwl(name, function, corners):
    points = []
    for time, before, after in edges(function, corners):
        points += [(time, after)] if time == 0 else [(time, before), (time, after)]
    text = " ".join(f"{t!r} {v!r}" for t, v in points)
    return f"v{name} {name} 0 pwl({text})" if len(points) > 1 else f"v{name} {name} 0 {points[0][1]!r}"


def corners_of(delays):
    return [d + k * HALF for d in delays for k in range(int(STOP / HALF) + 1) if d + k * HALF <= STOP]


def leg(k, resistances=""):
    """From p to n, gates g and k."""
    return [f"s{k}a p h{k} g{k} 0 s", f"s{k}b h{k} n k{k} 0 s", f"d{k}a h{k} p d", f"d{k}b n h{k} d"]


def star(n):
    cards = []
    for k in range(n):
        cards += [f"l{k} h{k} x{k} 1m ic=0", f"r{k} x{k} {'y' if n > 1 else '0'} {5 + k}"]
    return cards


def legs(n, ohms=("", "")):
    cards = ["vp p 0 300", "vn 0 n 300"]
    for k in range(n):
        cards += leg(k)
    return cards + star(n) + [f".model s sw(vt=0.5 {ohms[0]})", f".model d d({ohms[1]})"]


MILLIOHMS = ("ron=1m roff=1meg", "ron=1m roff=1meg")
LOAD = ["l0 h0 x0 1m ic=0", "r0 x0 0 5"]


def references(n, amplitude=0.8):
    return [f"vr{k} r{k} 0 sin(0 {amplitude} 50 0 0 {-360 * k / n!r})" for k in range(n)], \
           [sine(amplitude, 50, -360 * k / n) for k in range(n)]


def step(x):
    return 1.0 if x > 0 else 0.0


def inverter(n, dead, upper, lower, ohms=("", "")):
    """Legs whose gates are formulas of r (the reference), t (the triangle) and the dead time."""
    cards, r = references(n)
    t = triangle(-1, 1)
    gates = {}
    for k in range(n):
        gates[f"g{k}"] = (upper.format(r=f"v(r{k})", t="v(t)", dead=dead), lambda s, k=k: step(r[k](s) - t(s) - dead))
        gates[f"k{k}"] = (lower.format(r=f"v(r{k})", t="v(t)", dead=dead), lambda s, k=k: step(t(s) - r[k](s) - dead))
    return cards + [pulse("t", -1, 1)], gates, legs(n, ohms), [0.0]


def limited():
    """A reference that clips, as a formula of its own, before the comparison."""
    r, t = sine(1.3, 50), triangle(-1, 1)
    clip = lambda s: min(max(r(s), -0.9), 0.9)  # noqa: E731
    gates = {"g0": ("u(v(c)-v(t)-0.02)", lambda s: step(clip(s) - t(s) - 0.02)),
             "k0": ("u(v(t)-v(c)-0.02)", lambda s: step(t(s) - clip(s) - 0.02))}
    return ["vr r 0 sin(0 1.3 50)", "bc c 0 v=limit(v(r),-0.9,0.9)", pulse("t", -1, 1)], gates, legs(1), [0.0]


def zero_sequence():
    """Half of the largest and the smallest reference is taken off all three."""
    cards, r = references(3, 1.1)
    t = triangle(-1, 1)
    mean = lambda s: 0.5 * (max(f(s) for f in r) + min(f(s) for f in r))  # noqa: E731
    gates = {}
    for k in range(3):
        gates[f"g{k}"] = (f"v(r{k})-v(m)>v(t)+0.02?1:0", lambda s, k=k: step(r[k](s) - mean(s) - t(s) - 0.02))
        gates[f"k{k}"] = (f"v(r{k})-v(m)<v(t)-0.02?1:0", lambda s, k=k: step(t(s) - r[k](s) + mean(s) - 0.02))
    return cards + ["bm m 0 v=0.5*(max(v(r0),max(v(r1),v(r2)))+min(v(r0),min(v(r1),v(r2))))", pulse("t", -1, 1)], \
        gates, legs(3), [0.0]


def three_levels():
    """A source of three levels by carriers one above the other."""
    r, up, down = sine(0.9, 50, 17), triangle(0, 1), triangle(-1, 0)
    gates = {"h0": ("100*(u(v(r)-v(a))+u(v(r)-v(b)))-100", lambda s: 100 * (step(r(s) - up(s)) + step(r(s) - down(s))) - 100)}
    return ["vr r 0 sin(0 0.9 50 0 0 17)", pulse("a", 0, 1), pulse("b", -1, 0)], gates, LOAD, [0.0]


def shifted(n):
    """A source of many levels by carriers one after the other."""
    r = sine(0.85, 50)
    delays = [2 * HALF * k / n for k in range(n)]
    carrier = [triangle(-1, 1, d) for d in delays]
    text = "+".join(f"u(v(r)-v(t{k}))" for k in range(n))
    gates = {"h0": (f"20*({text})-{10 * n}", lambda s: 20 * sum(step(r(s) - c(s)) for c in carrier) - 10.0 * n)}
    return ["vr r 0 sin(0 0.85 50)"] + [pulse(f"t{k}", -1, 1, d) for k, d in enumerate(delays)], gates, LOAD, delays


def of_time():
    r, t = sine(0.7, 50), triangle(-1, 1)
    gates = {"g0": ("u(0.7*sin(2*pi*50*time)-v(t)-0.01)", lambda s: step(r(s) - t(s) - 0.01)),
             "k0": ("u(v(t)-0.7*sin(2*pi*50*time)-0.01)", lambda s: step(t(s) - r(s) - 0.01))}
    return [pulse("t", -1, 1)], gates, legs(1), [0.0]


def both():
    """An and of two comparisons, and its negation, behind sources that only hand on."""
    r, t, e = sine(0.8, 50, 30), triangle(-1, 1), sine(1, 333)
    on = lambda s: step(r(s) - t(s)) * step(e(s) + 0.5)  # noqa: E731
    gates = {"g0": ("v(on)>0.5?1:0", on), "k0": ("inv(v(on))", lambda s: 1 - on(s))}
    return ["vr r 0 sin(0 0.8 50 0 0 30)", "ve e 0 sin(0 1 333)", pulse("t", -1, 1), "bon on 0 v=(v(r)>v(t) & v(e)>-0.5)?1:0"], \
        gates, legs(1), [0.0]


def soft_start():
    """A duty that an exponential brings up, a buck converter with a diode."""
    d, t = (lambda s: 0.6 * (1 - math.exp(-s / 1e-3))), triangle(0, 1)
    gates = {"g0": ("v(d)>v(t)", lambda s: step(d(s) - t(s)))}
    return ["vd d 0 exp(0 0.6 0 1m 1)", pulse("t", 0, 1)], gates, \
        ["vp p 0 48", "s0 p h0 g0 0 s", "d0 0 h0 d", *LOAD, "c0 x0 0 10u ic=0", ".model s sw(vt=0.5)", ".model d d()"], [0.0]


def current():
    """A current that a formula of sources switches, into a diode and a capacitor."""
    r, t = sine(0.5, 100), triangle(-1, 1)
    gates = {"i:h0": ("3*u(v(r)-v(t))", lambda s: 3 * step(r(s) - t(s)))}
    return ["vr r 0 sin(0 0.5 100)", pulse("t", -1, 1)], gates, \
        ["d0 h0 x0 d", "c0 x0 0 1m ic=0", "r1 x0 0 2", "r2 h0 0 1k", ".model d d()"], [0.0]


CASES = {
    "one leg, u()": inverter(1, 0.02, "u({r}-{t}-{dead})", "u({t}-{r}-{dead})"),
    "three legs, if()": inverter(3, 0.02, "if({r}-{t}>{dead},1,0)", "if({r}-{t}<-{dead},1,0)"),
    "three legs, milliohms": inverter(3, 0.02, "({r}>{t}+{dead})?1:0", "({r}<{t}-{dead})?1:0", MILLIOHMS),
    "five legs, limit()": inverter(5, 0.02, "limit(1e9*({r}-{t}-{dead}),0,1)", "u({t}-{r}-{dead})", MILLIOHMS),
    "nine legs": inverter(9, 0.02, "u({r}-{t}-{dead})", "u({t}-{r}-{dead})", MILLIOHMS),
    "eighteen legs": inverter(18, 0.02, "u({r}-{t}-{dead})", "u({t}-{r}-{dead})"),
    "a clipped reference": limited(),
    "a zero sequence": zero_sequence(),
    "three levels": three_levels(),
    "twelve shifted carriers": shifted(12),
    "formulas of time": of_time(),
    "two conditions": both(),
    "a soft start": soft_start(),
    "a current": current(),
}


def cards_of(gates, corners, with_formulas):
    for name, (formula, function) in gates.items():
        is_current, node = name.startswith("i:"), name.split(":")[-1]
        if with_formulas:
            yield f"b{node} 0 {node} i={formula}" if is_current else f"b{node} {node} 0 v={formula}"
        else:
            card = pwl(node, function, corners)
            yield card.replace(f"v{node} {node} 0", f"i{node} 0 {node}") if is_current else card


def main():
    checker = Checker("decided formulas")
    for title, (sources, gates, circuit, delays) in some_of(CASES.items()):
        corners = corners_of(delays)
        end = [f".tran {STOP / 200!r} {STOP!r} uic", ".options reltol=1e-9", ".end", ""]
        outcome = []
        for with_formulas in (True, False):
            cards = [title, *sources, *cards_of(gates, corners, with_formulas), *circuit, *end]
            outcome.append(run(sys.argv[1], "\n".join(cards), method=None))
            checker.check(outcome[-1].status == 0, f"{title}, formulas {with_formulas}: {outcome[-1].stderr[-300:]}")
        if any(o.status != 0 for o in outcome):
            continue
        names = [c.split()[0] for c in circuit if c[0] == "l"]
        signals = [f"i({name})" for name in names] or ["v(x0)"]
        rows = [{round(t / STOP * 200): k for k, t in enumerate(o.time) if abs(t / STOP * 200 % 1 - 0.5) > 0.5 - 1e-9}
                for o in outcome]
        checker.check(all(len(r) == 201 for r in rows), f"{title}: rows")
        for name in signals:
            a, b = ([o.column(name)[r[k]] for k in sorted(r)] for o, r in zip(outcome, rows))
            scale = max(map(abs, b))
            worst = max(abs(x - y) for x, y in zip(a, b))
            checker.check(worst <= 1e-7 * scale, f"{title}: {name} differs by {worst / scale:.2g} of its largest")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
