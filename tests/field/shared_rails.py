#!/usr/bin/env python3
"""Switches that act on one voltage or current at once, each with a threshold of its own for that.

usage: shared_rails.py PROGRAM

All of them alternate in a step, and one slides: a rail has the one voltage at which what loads it is what feeds it. A load
that closes above U draws anything from nothing to all at U, so that is an equation of one unknown with monotone sides, and
its solution is found here by looking at each threshold and between them. The dual, resistors in series that switches short
below a current, is the same with a current.

Two choppers on a rail have coils besides: L i' = theta v - R i, where v is that of the rail while the switch is closed, and
the mean over both positions has the only solution at each instant. That is integrated with steps so short that their error is
below what is asked.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error


def level(drive, least, steps):
    """x with x (least + sum of what is on) = drive, where (a, u) in steps is on above u, and anything between at u."""
    places = sorted({u for _, u in steps})
    for low, high in zip([-1.0, *places], [*places, float("inf")]):
        x = drive / (least + sum(a for a, u in steps if u <= low))
        if x <= high:
            return max(x, low)
    return None


def rail(rs, loads, stop, volts):
    """Loads R behind a resistor Rs, which close above U."""
    lines = ["loads on one rail", f"v1 s 0 pwl(0 0 {stop!r} {volts!r})", f"rs s a {rs!r}"]
    for k, (r, u) in enumerate(loads):
        lines += [f"s{k} a x{k} a 0 m{k}", f"r{k} x{k} 0 {r!r}", f".model m{k} sw(vt={u!r} ron=0)"]
    return lines, "v(a)", lambda t: level(volts * t / stop / rs, 1.0 / rs, [(1.0 / r, u) for r, u in loads])


def shunts(amps, r, switches, stop):
    """Switches of Ron that close above U, beside a resistor that a triangle of current flows into."""
    lines = ["shunts beside each other", f"i1 0 a pwl(0 0 {stop / 2!r} {amps!r} {stop!r} 0)", f"ra a 0 {r!r}"]
    for k, (ron, u) in enumerate(switches):
        lines += [f"s{k} a 0 a 0 m{k}", f".model m{k} sw(vt={u!r} ron={ron!r})"]
    return lines, "v(a)", lambda t: level(amps * 2.0 * min(t, stop - t) / stop, 1.0 / r, [(1.0 / ron, u) for ron, u in switches])


def limiters(volts, r0, limits, stop):
    """Resistors R in series, which are shorted below a current I."""
    lines = ["limiters in series", f"v1 s 0 pwl(0 0 {stop!r} {volts!r})", f"r0 s n0 {r0!r}"]
    for k, (r, i) in enumerate(limits):
        lines += [f"r{k}s n{k} n{k + 1} {r!r}", f"s{k} n{k} n{k + 1} m 0 m{k}", f".model m{k} sw(vt={-i!r} ron=0)"]
    lines += ["h1 m 0 vm -1", f"vm n{len(limits)} 0 0"]
    return lines, "i(vm)", lambda t: level(volts * t / stop, r0, limits)


CASES = [
    rail(2.0, [(3.0, 18.0), (5.0, 17.0)], 1e-3, 24.0),
    rail(2.0, [(3.0, 18.0), (5.0, 18.0), (1.0, 12.0)], 1e-3, 24.0),
    rail(1e3, [(500.0 + 100.0 * k, 5e-3 + 1e-4 * k) for k in range(8)], 1e-6, 1e-2),
    rail(10.0, [(10.0 + 3.0 * k, 200.0 - 7.0 * k) for k in range(6)], 20.0, 400.0),
    shunts(5.0, 10.0, [(3.0, 4.0), (3.0, 4.2), (3.0, 4.4)], 2e-3),
    shunts(50.0, 10.0, [(3.0, 4.0), (3.0, 4.2), (2.0, 4.4), (1.0, 4.3), (1.0, 4.6)], 2e-3),
    limiters(10.0, 1.0, [(5.0, 1.0), (5.0, 1.2)], 1e-3),
    limiters(10.0, 1.0, [(5.0, 1.0), (5.0, 1.2), (3.0, 1.1), (4.0, 1.3)], 1e-3),
    limiters(1e3, 100.0, [(500.0, 1.0), (500.0, 1.2), (300.0, 1.1), (400.0, 1.3), (200.0, 1.05)], 10.0),
]


def check_level(checker, program, lines, signal, wanted):
    stop = float(lines[1].split()[-2])  # of the source
    name = f"{lines[0]}: {lines[1]}, {len(lines)} lines"
    result = dalcs_program.run(program, "\n".join([*lines, f".tran {stop / 50!r} {stop!r} uic", ".end", ""]), method=None)
    if not checker.check(result.status == 0, f"{name}: {result.stderr}"):
        return
    most = max(wanted(t) for t in result.time)
    for t, value in zip(result.time, result.column(signal)):  # the last of a slide is a step on one side
        if not checker.check(abs(value - wanted(t)) <= 3e-5 * most, f"{name}: {signal} = {value!r}, not {wanted(t)!r}, at {t!r}"):
            return


CHOPPERS = """two choppers on one rail, each blocked by undervoltage
v1 s 0 {v}
rs s a {rs}
.model d d(ron=0)
d0 0 x0 d
l0 x0 y0 {l[0]}
r0 y0 0 {r[0]}
d1 0 x1 d
l1 x1 y1 {l[1]}
r1 y1 0 {r[1]}
b0 c0 0 v={{v(a)-{u[0]}}}
b1 c1 0 v={{v(a)-{u[1]}}}
s0 a x0 c0 0 sw
s1 a x1 c1 0 sw
.model sw sw(vt=0 ron=0)
.tran {row} {stop} uic
.end
"""


def integrate(of, n):
    """Both currents at the end: the rail is drawn by theta_k i_k, with theta_k of 0 to 1 where its mean is U_k."""
    now = [0.0, 0.0]
    h = of["stop"] / n

    def rates(i):
        draw = 0.0
        theta = [0.0, 0.0]
        for k in sorted((0, 1), key=lambda k: of["u"][k]):  # the one that closes first as the rail rises, first
            most = (of["v"] - of["u"][k]) / of["rs"] - draw
            theta[k] = min(1.0, max(0.0, most / i[k])) if i[k] > 0.0 else float(most > 0.0)
            draw += theta[k] * i[k]
        closed = [of["v"] - of["rs"] * (draw + (1.0 - theta[k]) * i[k]) for k in (0, 1)]
        return [(theta[k] * closed[k] - of["r"][k] * i[k]) / of["l"][k] for k in (0, 1)]

    for _ in range(n):
        first = rates(now)
        second = rates([now[k] + h * first[k] for k in (0, 1)])
        now = [now[k] + 0.5 * h * (first[k] + second[k]) for k in (0, 1)]
    return now


def check_choppers(checker, program, of):
    """In the end the one with the lower threshold takes what the rail gives."""
    result = dalcs_program.run(program, CHOPPERS.format(row=of["stop"] / 50, **of), method=None)
    name = f"choppers on one rail of {of['v']} V"
    if not checker.check(result.status == 0, f"{name}: {result.stderr}"):
        return
    wanted = integrate(of, 4000)
    for k in (0, 1):
        got = result.column(f"i(l{k})")[-1]
        checker.check(abs(got - wanted[k]) <= 1e-3 * max(wanted), f"{name}: i(l{k}) ends at {got!r}, not {wanted[k]!r}")


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    checker = dalcs_program.Checker("shared rails")
    for lines, signal, wanted in CASES:
        check_level(checker, program, lines, signal, wanted)
    check_choppers(checker, program, {"v": 24.0, "rs": 2.0, "r": (3.0, 5.0), "l": (1e-3, 2e-3), "u": (18.0, 17.0), "stop": 3e-3})
    check_choppers(checker, program, {"v": 0.4, "rs": 0.5e3, "r": (700.0, 900.0), "l": (2.0, 1.0), "u": (0.25, 0.3), "stop": 4e-3})
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
