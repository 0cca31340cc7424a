#!/usr/bin/env python3
"""LAPLACE on E and G: step responses against the sum of residues, in 11 unlike sets of poles; loops, responses over
frequency, forms of writing, and what is refused.

usage: transfer.py PROGRAM
"""

import cmath
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402
from logic import run_cards, runs  # noqa: E402


def from_roots(roots, leading=1.0):
    c = [complex(leading)]
    for root in roots:
        c = [a - root * b for a, b in zip([0, *c], [*c, 0])]
    return [x.real for x in c]


def value(c, s):
    total = 0
    for x in reversed(c):
        total = total * s + x
    return total


def text(c):
    return " + ".join(f"{x!r}*s^{k}" if k else repr(x) for k, x in enumerate(c) if x != 0)


def butterworth(n, w):
    return [w * cmath.exp(1j * math.pi * (2 * k + n + 1) / (2 * n)) for k in range(n)]


POLES = (
    # poles, zeros, gain at 0 (of a pole at 0: of what is left)
    ([-1e3], [], 1), ([-5], [3], -2), ([-1e6, -1], [], 7), ([-3 + 4j, -3 - 4j], [-1], 0.5),
    (butterworth(4, 2e4), [], 1), (butterworth(7, 1.0), [], 1), (butterworth(10, 6e5), [], 3),
    ([-1e-3, -1e3, -1e5], [-10, -20, -3e4], 1), ([-1e9, -2e9 + 5e9j, -2e9 - 5e9j], [1e9j, -1e9j], 1),
    ([-2, -3, -5, -7, -11, -13], [1, 2, 4, 6, 8, 10], 1e-3), ([2, -10], [], 1))


def steps(checker, program):
    for poles, zeros, gain in POLES:
        below, above = from_roots(poles), from_roots(zeros)
        unit = gain * below[0] / above[0]
        above = [unit * x for x in above]
        slow = 1 / min(abs(p) for p in poles)
        stop = (3 if max(p.real for p in map(complex, poles)) > 0 else 6) * slow
        what = f"poles {[complex(round(p.real, 3), round(p.imag, 3)) for p in map(complex, poles)][:4]}"
        cards = [f"v1 in 0 pulse(0 2 {stop / 10!r} 0 0 {10 * stop!r} {20 * stop!r})",
                 f"e1 a 0 in 0 Laplace=({text(above)})/({text(below)})", "r1 a 0 1k",
                 f"g1 b 0 LAPLACE {{v(in)*3}} = {{({text(above)})/({text(below)})}}", "r2 b 0 10",
                 f".tran {stop / 50!r} {stop!r} uic"]
        done = run_cards(program, what, cards)
        if not runs(checker, done, what):
            continue
        derivative = [k * x for k, x in enumerate(below)][1:]
        residues = [value(above, p) / value(derivative, p) for p in poles]
        direct = above[-1] / below[-1] if len(above) == len(below) else 0.0

        def step(t, poles=poles, residues=residues, direct=direct):
            return direct + sum(r / p * (cmath.exp(p * t) - 1) for r, p in zip(residues, poles)).real if t >= 0 else 0.0
        size = max(abs(v) for v in done.column("v(a)")) or 1.0
        later = [k for k, t in enumerate(done.time) if abs(t - stop / 10) > 1e-9 * stop and t > 0]
        worst = max(abs(done.column("v(a)")[k] - 2 * step(done.time[k] - stop / 10)) for k in later)
        checker.check(worst <= 3e-8 * size, f"{what}: e is off by {worst / size:.1e}")
        size = max(abs(v) for v in done.column("v(b)")) or 1.0
        worst = max(abs(done.column("v(b)")[k] + 60 * step(done.time[k] - stop / 10))
                    for k in later)
        checker.check(worst <= 3e-8 * size, f"{what}: g is off by {worst / size:.1e}")


def rest(checker, program):
    """At the operating point a transfer function is its gain at s = 0; around it a loop that settles; a PI with its pole
    at 0; parameters in a subcircuit; sums and powers; over frequency."""
    cards = ["v1 in 0 3", ".subckt lag a b tau=1 k=1", "e1 b 0 a 0 Laplace={k}/(1+s*{tau})**2", ".ends",
             "x1 in p lag tau=1m k=-4", "r1 p 0 1k", ".tran 1m 20m"]
    done = run_cards(program, "at rest", cards)
    if runs(checker, done, "at rest"):
        for v in done.column("v(p)"):
            checker.close(v, -12, 1e-9, "at rest")
    for kp, ki, tau in ((2, 100, 0.01), (0.5, 3e5, 1e-5), (10, 1, 5)):
        what = f"a PI of {kp}, {ki}"
        zeta, w = (1 + kp) / (2 * math.sqrt(ki * tau)), math.sqrt(ki / tau)
        root = cmath.sqrt(zeta * zeta - 1)
        p = [w * (-zeta + root), w * (-zeta - root)]
        cards = ["v1 r 0 1", f".param kp={kp} ki={ki!r}", "e1 u 0 LAPLACE {v(r)-v(y)} = {kp + ki/s}",
                 f"r1 u y 1", f"c1 y 0 {tau!r}", f".tran {tau / 10!r} {5 / min(abs(x) for x in p)!r} uic"]
        done = run_cards(program, what, cards)
        if runs(checker, done, what):
            above = [ki / tau, kp / tau]
            for t, y in zip(done.time[1:], done.column("v(y)")[1:]):
                wanted = sum(value(above, x) / x / (x - q) * (cmath.exp(x * t) - 1) for x, q in (p, p[::-1])).real
                checker.close(y, wanted, 1e-8, f"{what} at {t}")
    cards = ["v1 in 0 ac 1", "e1 a 0 LAPLACE {v(in)} = {1/(1+s/(2*pi*1k)) + (s/100k)^2/(1+s/100k)^2}", "r1 a 0 1",
             ".ac dec 5 10 1meg"]
    done = run_cards(program, "over frequency", cards)
    if runs(checker, done, "over frequency"):
        names = [n for n in done.names if n != "frequency"]
        for k, f in enumerate(done.column("frequency")):
            s = 2j * math.pi * f
            wanted = 1 / (1 + f * 1j / 1e3) + (s / 1e5) ** 2 / (1 + s / 1e5) ** 2
            row = dict(zip(done.names, done.rows[k]))
            got = [row[n] for n in names if "v(a)" in n]
            checker.check(any(abs(g - wanted.real) < 1e-9 for g in got) or any(abs(g - abs(wanted)) < 1e-9 for g in got),
                          f"over frequency: {f}: {got}, not {wanted}")


# A pulse from 0 to 2 V is answered by gain (1 - exp(-t/tau)) of it, so long after its edges; tau 0: at once.
DELAYS = (
    ("e1 o 0 LAPLACE {v(a)} = {exp(-s*0.5)}", 1, 0, 0.5), ("e1 o 0 a 0 Laplace=exp(-s*td)/(1+s*0.2)", 1, 0.2, 0.7),
    ("e1 o 0 a 0 Laplace=3*exp(-s/4)**2/(1+s/10)", 3, 0.1, 0.5), ("e1 o 0 LAPLACE {v(a)/2} {1/(exp(s*td)*(1+s))}", 0.5, 1, 0.7),
    ("b1 o 0 V=v(a) laplace=exp(-s*0.1)*exp(-s*0.2)/(2+s)", 0.5, 0.5, 0.3),
    ("g1 0 o a 0 Laplace=1m*exp(1-s*0.25)", math.e, 0, 0.25), ("e1 o 0 0 a Laplace=-exp(-s*td)*(1/(1+s)+0*s/(1+s))", 1, 1, 0.7),
    ("e1 o 0 a 0 Laplace=exp(-s*td)/(1+s)+exp(-s*td)*s/(1+s)", 1, 0, 0.7),
    ("xs a o lag td={td}\n.subckt lag i o td=1\ne1 o 0 i 0 Laplace=exp(-s*td)/(1+s*td)\n.ends", 1, 0.7, 0.7),
    ("e1 o 0 LAPLACE {2*v(a)-v(c)} = {exp(-s*0.6)/(1+s*0.3)}\ne2 c 0 a 0 1", 1, 0.3, 0.6),
    ("e1 o 0 a 0 Laplace=pow(exp(-s*0.2), 3)", 1, 0, 0.6), ("e1 o 0 a 0 Laplace=0*exp(s*1u)+exp(-s*0.4)", 1, 0, 0.4),
)


def delays(checker, program):
    """A factor exp(-s T), at scales of seconds and nanoseconds; and fed back, where the answer is a polynomial in pieces."""
    for unit in (1.0, 1e-9):
        for card, gain, tau, delay in DELAYS:
            scaled = card.replace("s*", f"{unit!r}*s*").replace("*s}", f"*{unit!r}*s}}").replace("s/", f"{unit!r}*s/")
            scaled = scaled.replace("+s)", f"+{unit!r}*s)")
            cards = ["v1 a 0 pulse(0 2 {} 0 0 {} {})".format(0.3 * unit, 1.1 * unit, 9 * unit), ".param td=0.7",
                     *scaled.split("\n"), "r1 o 0 1k", f".tran {0.01 * unit!r} {4 * unit!r}"]
            done = run_cards(program, "a delay", cards)
            if not runs(checker, done, f"{scaled} at {unit}"):
                continue
            worst = 0
            for t, v in zip(done.time, done.column("v(o)")):
                def answer(x):
                    return 0 if x < 0 else 1 if tau == 0 else 1 - math.exp(-x / tau)
                since = t / unit - 0.3 - delay
                near = min(abs(since), abs(since - 1.1)) < 1e-9
                worst = worst if near else max(worst, abs(v - 2 * gain * (answer(since) - answer(since - 1.1))))
            checker.check(worst <= 1e-8 * gain, f"{scaled} at {unit}: off by {worst}")
    done = run_cards(program, "fed back", ["c1 x 0 1m ic=1", "g1 x 0 LAPLACE {v(x)} = {1m*exp(-s*0.5)}", ".tran 0.01 3 uic"])
    if runs(checker, done, "fed back"):
        for t, v in zip(done.time, done.column("v(x)")):
            wanted = sum((-1) ** k * (t - 0.5 * k) ** k / math.factorial(k) for k in range(7) if t >= 0.5 * k)
            checker.close(v, wanted, 1e-9, f"fed back at {t}")


def behind(checker, program):
    """The same behind a formula of B, V and I, of a product too, against E and G; in a subcircuit, and what LTspice adds."""
    ratios = ("1/(1+s*0.5m)", "s/(1+s*2m)", "5/(s^2/1e7+s*0.4/3162+1)", "(1+s/3k)/((1+s/1k)*(1+s/30k))", "-3", "1/(1+s*1u)^3",
              "(s^2+1e6)/(s+1e3)^2", "100/(s+100)", "1/s", "(1+s*t1)/(1+s*10*t1)")
    for ratio in ratios:
        word = " uic" if ratio == "1/s" else ""
        cards = ["v1 a 0 pulse(-1 2 0.1m 0.2m 0.1m 1m 3m)", ".param t1=0.1m", f"b1 o 0 V=2*v(a) laplace={ratio}", f"b2 0 p I=1m*v(a) LAPLACE={{{ratio}}}",
                 "r2 p 0 2k", f"b3 q 0 V=v(a)*v(a) Laplace={ratio} window=1m nfft=64 mtol=1", f"e1 e 0 LAPLACE {{2*v(a)}} = {{{ratio}}}", "b4 z 0 V=v(a)*v(a)",
                 f"e2 f 0 z 0 Laplace={ratio}", "xs a s filter", ".subckt filter i o t2={t1}", f"b1 o 0 V=v(i)*2 laplace={ratio.replace('t1', 't2')}", ".ends",
                 f"e3 b 0 LAPLACE v(a)*2 = {ratio}", f".tran 10u 5m{word}", ".save v(o) v(p) v(q) v(e) v(f) v(s) v(b)"]
        done = run_cards(program, ratio, cards)
        if runs(checker, done, ratio):
            size = max(map(abs, done.column("v(e)")))
            for name, other in (("v(o)", "v(e)"), ("v(p)", "v(e)"), ("v(s)", "v(e)"), ("v(b)", "v(e)"), ("v(q)", "v(f)")):
                worst = max(abs(x - y) for x, y in zip(done.column(name), done.column(other)))
                checker.check(worst <= 1e-8 * max(size, 1), f"{ratio}: {name} differs from {other} by {worst}")
    cards = ["v1 a 0 pulse(0 1 0 0 0 1 2)", "b1 0 q I=1m*v(a) m=2 rpar={r} cpar=0.5u", ".param r=2k", "b2 x 0 V=v(a) tripdv=1 tripdt=1n", ".tran 0.1m 3m"]
    done = run_cards(program, "what LTspice adds", cards)
    if runs(checker, done, "what LTspice adds"):
        checker.close(done.at("v(q)", 3e-3), 2 * (1 - math.exp(-3)), 1e-8, "across a source of a current")


def refused(checker, program):
    cases = (("e1 o 0 a 0 Laplace=s", "improper: of degree 1 over 0, it differentiates"),
             ("e1 o 0 a 0 Laplace=s^3/(1+s)^2", "improper: of degree 3 over 2"),
             ("e1 o 0 a 0 Laplace=exp(s*1u)", "exp(s T) with T > 0, which comes before its cause"),
             ("e1 o 0 a 0 Laplace=1/exp(-s*1u)", "exp(s T) with T > 0, which comes before its cause"),
             ("e1 o 0 a 0 Laplace=(1-exp(-s*1u))/(1+s)", "a sum of terms that are delayed by different times"),
             ("e1 o 0 a 0 Laplace=exp(-s*s)", "exp() of anything but a number times s"),
             ("e1 o 0 a 0 Laplace=exp(-1/(1+s))", "exp() of anything but a number times s"),
             ("e1 o 0 a 0 Laplace=s*exp(-s)", "improper: of degree 1 over 0"),
             ("e1 o 0 a 0 Laplace=1/sqrt(1+s)", "a function of s is not supported"),
             ("e1 o 0 a 0 Laplace=1/(1+s)^0.5", "no small whole number"),
             ("e1 o 0 a 0 Laplace=1/(1+s)^21", "a power that is no small whole number"),
             ("e1 o 0 a 0 Laplace=1/(1+s)^11/(1+2*s)^10", "a degree above 20"),
             ("e1 o 0 LAPLACE {v(a)} = {1/(1+s*v(a))}", "a voltage or a current is not supported"),
             ("e1 o 0 LAPLACE {v(a)}", "an expression of s is missing"),
             ("b1 o 0 V=v(a) laplace=s", "improper: of degree 1 over 0"),
             ("b1 o 0 V=v(a) laplace=", "an expression of s is missing"),
             ("b1 o 0 V=v(a) laplace=1/(1+s) wrong=1", "did not expect 'wrong'"),
             ("b1 o 0 R=v(a) laplace=1/(1+s)", "did not expect 'laplace'"),
             ("b1 o 0 V=v(a) rpar=1", "did not expect 'rpar'"),
             ("e1 o 0 FREQ {v(a)} = (1,0,0) (1k,-3,-45)", "LAPLACE with the ratio that the table was made of"),
             ("e1 o 0 a 0 Laplace=1/(1+s*tau)", "tau"))
    for card, words in cases:
        done = run_cards(program, card, ["v1 a 0 1", card, "r1 o 0 1", ".tran 1 2"])
        checker.check(done.status != 0 and words in done.stderr, f"{card}: {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("transfer")
    for part in (steps, rest, delays, behind, refused):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
