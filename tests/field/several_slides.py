#!/usr/bin/env python3
"""Switches that slide along their thresholds at the same time, each with its own part of the time.

usage: several_slides.py PROGRAM

Where two switches alternate without a clock between them, both sides of one go with both sides of the other, for the
product of their parts of the time (Alexander and Seidman 1998, blending). Then all means have closed forms:

    currents I1, I2 of two choppers at one source V with resistance Rs:
        d1 (V - (Rs + Ron) I1 - Rs d2 I2) = R1 I1, d2 the other way round; i(s1) is d1 I1 on average;
    a current i through a synchronous rectifier of Ron beside a diode of Rd, which closes above the voltage U:
        v = Rd i, then U, then (Rd || Ron) i; and while it is U, the switch has (Rd i - U) / (Rd - (Rd || Ron)) of the time.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error


def run(checker, program, name, netlist, most=0, most_problems=math.inf):
    result = dalcs_program.run(program, netlist, method=None, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{name}: {result.stderr}"):
        return None
    steps = result.report["work"]["euler_steps"]
    checker.check(steps <= most, f"{name}: {steps} steps of implicit Euler")
    problems = result.report["work"]["osnsp"]
    checker.check(problems <= most_problems, f"{name}: {problems} one-step problems, and {most_problems} are enough")
    return [dict(zip(result.names, row)) for row in result.rows]


def near(checker, name, at, signal, wanted, most):
    return checker.check(abs(at[signal] - wanted) <= most,
                         f"{name}: {signal} = {at[signal]!r}, not {wanted!r}, at {at['time']}")


# ---- Choppers that hold their currents --------------------------------------------------------------------

COMMANDS = {  # what commands the k-th switch, from its current and {I}
    "switches": "h{k} m{k} 0 vs{k} 1\ns{k} a x{k} 0 m{k} sw{k}\n.model sw{k} sw(vt=-{I} ron={ron})\n",
    "comparators": "b{k} g{k} 0 v={{i(l{k})<{I} ? 1 : 0}}\ns{k} a x{k} g{k} 0 sw{k}\n.model sw{k} sw(vt=0.5 ron={ron})\n",
}
CHOPPERS = [  # V, Rs, Ron, then R, L, I of each
    (24.0, 0.1, 1e-2, (3.0, 1e-3, 2.0), (5.0, 2e-3, 1.5)),
    (400.0, 0.0, 0.1, (10.0, 5e-3, 9.0), (4.0, 0.5e-3, 30.0)),
    (5.0, 20.0, 0.0, (1e3, 0.1, 1e-3), (300.0, 0.02, 2e-3), (470.0, 0.04, 1.5e-3)),
]


def parts(volts, rs, ron, of):
    """Of the time that each switch is closed."""
    part = [0.0] * len(of)
    for _ in range(200):
        for k, (r, _, current) in enumerate(of):
            others = sum(part[j] * of[j][2] for j in range(len(of)) if j != k)
            part[k] = r * current / (volts - (rs + ron) * current - rs * others)
    return part


def check_choppers(checker, program, command, values):
    volts, rs, ron, *of = values
    name = f"choppers by {command}, {values}"
    reached = max(-l / r * math.log(1.0 - r * i / (volts - rs * sum(c[2] for c in of))) for r, l, i in of)
    lines = [name, f"v1 s 0 {volts!r}", f"rs s a {rs!r}" if rs > 0.0 else "vrs s a 0", ".model d d(ron=0)"]
    for k, (r, l, current) in enumerate(of):
        lines += [f"d{k} 0 x{k} d", f"l{k} x{k} y{k} {l!r}", f"vs{k} y{k} o{k} 0", f"ro{k} o{k} 0 {r!r}",
                  COMMANDS[command].format(k=k, I=current, ron=ron)]
    rows = run(checker, program, name, "\n".join([*lines, f".tran {reached / 5!r} {2 * reached!r} uic", ".end", ""]))
    if rows is None:
        return
    part = parts(volts, rs, ron, of)
    for at in rows:
        if at["time"] > 1.5 * reached:
            for k, (r, _, current) in enumerate(of):
                if not (near(checker, name, at, f"i(l{k})", current, 1e-9 * current) and
                        near(checker, name, at, f"i(s{k})", part[k] * current, 1e-8 * current) and
                        near(checker, name, at, f"v(x{k})", r * current, 1e-8 * volts)):
                    return


def check_clamped(checker, program, first, volts, clamp, rs, of):
    """A diode holds the rail where any of them draws current: it is off on one side of both, and on on the others."""
    name = f"clamped choppers, {volts} V, the second from {first} A"
    lines = [name, f"v1 s 0 {volts!r}", f"rs s a {rs!r}", f"v2 b 0 {clamp!r}", "dc b a d", ".model d d(ron=0)"]
    reached = 0.0
    for k, (r, l, current) in enumerate(of):
        reached = max(reached, -l / r * math.log(1.0 - r * current / clamp))
        lines += [f"d{k} 0 x{k} d", f"l{k} x{k} y{k} {l!r} ic={k * first!r}", f"vs{k} y{k} o{k} 0", f"ro{k} o{k} 0 {r!r}",
                  COMMANDS["switches"].format(k=k, I=current, ron=0.0)]
    netlist = "\n".join([*lines, f".tran {reached / 5!r} {2 * reached!r} uic", ".end", ""])
    rows = run(checker, program, name, netlist, most=1)  # where the second one begins to slide
    part = [r * current / clamp for r, _, current in of]
    none = (1.0 - part[0]) * (1.0 - part[1])
    drawn = sum(p * current for p, (_, _, current) in zip(part, of))
    for at in rows or []:
        if at["time"] > 1.5 * reached and not (
                near(checker, name, at, "i(s0)", part[0] * of[0][2], 1e-8 * of[0][2]) and
                near(checker, name, at, "i(dc)", drawn - (1.0 - none) * (volts - clamp) / rs, 1e-7 * drawn)):
            return


def check_clamped_many(checker, program, volts, clamp, rs, of):
    """The same with more of them, each next to its own current: the diode is off where none draws any."""
    name = f"{len(of)} clamped choppers, {volts} V"
    lines = [name, f"v1 s 0 {volts!r}", f"rs s a {rs!r}", f"v2 b 0 {clamp!r}", "dc b a d", ".model d d(ron=0)"]
    for k, (r, l, current) in enumerate(of):
        lines += [f"d{k} 0 x{k} d", f"l{k} x{k} y{k} {l!r} ic={0.99 * current!r}", f"vs{k} y{k} o{k} 0", f"ro{k} o{k} 0 {r!r}",
                  COMMANDS["switches"].format(k=k, I=current, ron=0.0)]
    reached = max(0.01 * current * l / (clamp - r * current) for r, l, current in of)
    rows = run(checker, program, name, "\n".join([*lines, f".tran {reached / 2!r} {2 * reached!r} uic", ".end", ""]))
    none = math.prod(1.0 - r * current / clamp for r, _, current in of)
    drawn = sum(r * current / clamp * current for r, _, current in of)
    for at in rows or []:
        if at["time"] > 1.5 * reached:
            for k, (r, _, current) in enumerate(of):
                near(checker, name, at, f"i(l{k})", current, 1e-9 * current)
                near(checker, name, at, f"i(s{k})", r * current / clamp * current, 1e-8 * drawn)
            near(checker, name, at, "i(dc)", drawn - (1.0 - none) * (volts - clamp) / rs, 1e-7 * drawn)


# ---- Synchronous rectifiers that read their own voltage ---------------------------------------------------

RECTIFIERS = {  # the k-th from n{k} to n{j}, which closes above {U}
    "switches": "s{k} n{k} n{j} n{k} n{j} sw{k}\n.model sw{k} sw(vt={U} ron={ron})\n",
    "comparators": "b{k} g{k} 0 v={{v(n{k})-v(n{j})>{U} ? 5 : 0}}\ns{k} n{k} n{j} g{k} 0 sw{k}\n"
                   ".model sw{k} sw(vt=2 ron={ron})\n",
    "drivers": "b{k} c{k} 0 v={{v(n{k})-v(n{j})>{U} ? 1 : 0}}\nb{k}g g{k} 0 v={{v(c{k})>0.3 ? 12 : -3}}\n"
               "rg{k} g{k} 0 10k\ns{k} n{k} n{j} g{k} 0 sw{k}\n.model sw{k} sw(vt=2 ron={ron})\n",
}
SERIES = [  # the largest current, its period, then Rd, Ron, U of each
    (4.0, 1e-3, (10e-3, 2e-3, 12e-3)),
    (4.0, 1e-3, (10e-3, 2e-3, 12e-3), (20e-3, 5e-3, 15e-3)),
    (7.0, 0.1, (0.1, 0.01, 0.05), (0.2, 0.1, 0.08)),
    (30e-3, 20.0, (7.0, 1.0, 0.05), (5.0, 2.0, 0.06), (9.0, 0.5, 0.04)),
    (200.0, 20e-3, (1e-3, 1e-3, 60e-3), (1e-3, 1e-3, 60e-3)),
]


def check_rectifiers(checker, program, kind, values):
    """A triangle of current through them in series, and a capacitor beside the last one that is charged."""
    most, period, *of = values
    name = f"rectifiers, {kind}, {values}"
    last = len(of)
    lines = [name, f"i1 0 n0 pwl(0 0 {period / 2!r} {most!r} {period!r} 0)",
             f"c1 n{last} 0 {most * period!r}"]
    for k, (rd, ron, volts) in enumerate(of):
        lines += [f"d{k} n{k} n{k + 1} d{k}", f".model d{k} d(ron={rd!r})",
                  RECTIFIERS[kind].format(k=k, j=k + 1, U=volts, ron=ron)]
    netlist = "\n".join([*lines, f".tran {period / 40!r} {period!r} uic", ".end", ""])
    rows = run(checker, program, name, netlist, most=len(of) - 1)  # where another one begins to slide
    if rows is None:
        return
    ends = [end for rd, ron, volts in of for end in (volts / rd, volts * (rd + ron) / (rd * ron))]
    for at in rows:
        t = at["time"] / period
        current = most * 2.0 * min(t, 1.0 - t)
        if min(abs(current - end) / end for end in ends) < 1e-3:
            continue  # the last of a slide is a step on one side
        for k, (rd, ron, volts) in enumerate(of):
            both = rd * ron / (rd + ron)
            v = rd * current if rd * current < volts else max(volts, both * current)
            part = 0.0 if rd * current < volts else min(1.0, (rd * current - volts) / ((rd - both) * current))
            at["v"] = at[f"v(n{k})"] - at[f"v(n{k + 1})"]
            if not (near(checker, name, at, "v", v, 1e-8 * max(volts, both * most)) and
                    near(checker, name, at, f"i(s{k})", part * both * current / ron, 1e-7 * most)):
                return


# ---- Phases of a motor ------------------------------------------------------------------------------------

def check_phases(checker, program, volts, limit, henry, period):
    """Each phase is on for 0.4 periods, held to its limit; what the others leak is far below it."""
    name = f"phases, {volts} V, {limit} A"
    ohm = 0.1 * volts / limit
    lines = [name, f"v1 p 0 {volts!r}", f".model sw sw(vt=0.5 ron={1e-4 * ohm!r} roff={1e6 * ohm!r})", ".model d d(ron=0)"]
    for k in range(3):
        lines += [f"vg{k} g{k} 0 pulse(0 1 {k / 3 * period!r} {1e-4 * period!r} {1e-4 * period!r} {0.4 * period!r} {period!r})",
                  f"b{k} c{k} 0 v={{v(g{k})>0.5 & i(l{k})<{limit!r} ? 1 : 0}}",
                  f"sa{k} p a{k} c{k} 0 sw", f"sb{k} b{k} 0 g{k} 0 sw", f"da{k} 0 a{k} d", f"db{k} b{k} p d",
                  f"l{k} a{k} m{k} {henry!r}", f"r{k} m{k} b{k} {ohm!r}"]
    rows = run(checker, program, name, "\n".join([*lines, f".tran {period / 50!r} {0.45 * period!r} uic", ".end", ""]), 0, 80000)
    if rows is None:
        return
    rise = henry / ohm * math.log(1.0 / 0.9)
    held = 0
    for at in rows:
        t = at["time"] / period
        for k in range(3):
            if (k / 3 + rise / period + 0.01 < t < k / 3 + 0.4):
                held += 1
                if not near(checker, name, at, f"i(l{k})", limit, 1e-8 * limit):
                    return
    checker.check(held > 20, f"{name}: no current is held")


# ---- Switches with hysteresis beside two slides -----------------------------------------------------------

MEMORIES = {  # of what the voltage at x{k} never reaches, in volts of the source; they stand as at the beginning
    "open": "s{k}m a b{k} 0 x{k} m{k}\n.model m{k} sw(vt=0 vh={far} ron=1 roff=1e6)\nr{k}m b{k} 0 1\n",
    "closed": "s{k}m a b{k} x{k} 0 m{k} on\n.model m{k} sw(vt=0 vh={far} ron=1 roff=1e6)\nr{k}m b{k} 0 1\n",
    "of a Schmitt trigger": "a{k} 0 x{k} 0 0 0 0 b{k} 0 schmitt vt=0 vh={far} vhigh=0.5\nr{k}m b{k} 0 1\n",
}


def check_memories(checker, program, kind, volts, ohm, second):
    """Currents that two switches hold with no hysteresis; others look at the voltages behind them."""
    name = f"memories, {kind}, {volts} V, {ohm} ohm, {second} s"
    amps = 0.1 * volts / ohm
    lines = [name, f"v1 in 0 {volts!r}", f"rs in s {1e-3 * ohm!r}", "va a 0 1", f".model d d(ron={1e-3 * ohm!r} roff={1e5 * ohm!r})"]
    for k, limit, start in ((1, amps, 0.5), (2, 1.2 * amps, 0.4)):
        lines += [f"s{k} s x{k} 0 c{k} sw{k}", f"d{k} 0 x{k} d", f"l{k} x{k} y{k} {k * ohm * second!r}", f"vs{k} y{k} o{k} 0",
                  f"h{k} c{k} 0 vs{k} 1", f"c{k} o{k} 0 {0.01 * k * second / ohm!r} ic={start * volts!r}",
                  f"r{k} o{k} 0 {start * volts / limit!r}",
                  f".model sw{k} sw(vt={-limit!r} ron={1e-3 * ohm!r} roff={1e5 * ohm!r})",
                  MEMORIES[kind].format(k=k, far=100 * volts)]
    rows = run(checker, program, name, "\n".join([*lines, f".tran {0.01 * second!r} {0.5 * second!r} uic", ".end", ""]), 20)
    if rows is None:
        return
    for k, limit in ((1, amps), (2, 1.2 * amps)):
        wanted = 1e0 / (1e6 + 1.0) if kind == "open" else 0.5 if kind == "closed" else 0.0
        for at in rows:
            if not near(checker, name, at, f"v(b{k})", wanted, 1e-9):
                break
        near(checker, name, rows[-1], f"i(l{k})", limit, 1e-6 * limit)


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    checker = dalcs_program.Checker("several slides")
    for values in dalcs_program.some_of(CHOPPERS):
        for command in dalcs_program.some_of(list(COMMANDS)):
            if command == "switches" or len(values) == 5:  # three comparators take 8 sides, each by several answers
                check_choppers(checker, program, command, values)
    for first in 0.0, 2.0:
        check_clamped(checker, program, first, 24.0, 20.0, 10.0, [(3.0, 1e-3, 2.0), (5.0, 2e-3, 1.5)])
    check_clamped_many(checker, program, 24.0, 20.0, 10.0, [(3.0, 1e-3, 2.0), (5.0, 2e-3, 1.5), (4.0, 1e-3, 1.0), (8.0, 1.5e-3, 0.7)])
    for values in dalcs_program.some_of(SERIES):
        for kind in dalcs_program.some_of(list(RECTIFIERS)):
            if kind != "drivers" or len(values) == 3:
                check_rectifiers(checker, program, kind, values)
    for values in dalcs_program.some_of([(300.0, 8.0, 10e-3, 3e-3), (5.0, 1e-3, 2.0, 1e-2)]):
        check_phases(checker, program, *values)
    for kind in dalcs_program.some_of(list(MEMORIES)):
        for values in dalcs_program.some_of([(10.0, 10.0, 1e-4), (600.0, 2.0, 1e-3), (1.0, 1e3, 1e-6)]):
            check_memories(checker, program, kind, *values)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
