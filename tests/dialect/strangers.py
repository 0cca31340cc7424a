#!/usr/bin/env python3
"""What circuits of strangers hold that once stopped them, each kind in ten ways, against closed forms.

usage: strangers.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

EXACT = 1e-8
PROGRAM = sys.argv[1]


class Strangers(Checker):
    def run(self, netlist, status=0):
        lines = [line.strip() for line in netlist.strip().split("\n")]
        done = run(PROGRAM, "\n".join(["a circuit", *lines, ".end", ""]), method=None, tolerance=1e-10)
        ok = self.check(done.status == status, f"ends with {done.status}, not {status}\n{netlist}\n{done.stderr}")
        return done if ok else None

    def ends(self, netlist, wanted, says=(), allowed=EXACT):
        """Values of signals at the end, and what messages say."""
        done = self.run(netlist)
        for signal, value in wanted.items() if done else ():
            found = done.column(signal)[-1]
            self.check(abs(found - value) <= allowed * max(abs(value), 1e-3),
                       f"{signal} = {found!r}, not {value!r}\n{netlist}")
        for words in says if done else ():
            self.check(words in done.stderr, f"without '{words}': {done.stderr}\n{netlist}")
        return done

    def measures(self, netlist, wanted, allowed=EXACT):
        done = self.run(netlist)
        found = {m["name"]: m.get("value") for m in done.report.get("measurements", [])} if done else {}
        for name, value in wanted.items() if done else ():
            got = found.get(name)
            self.check(got is not None and abs(got - value) <= allowed * abs(value),
                       f"{name} = {got}, not {value}\n{netlist}\n{done.stderr}")


# ---- Signals that are not there -----------------------------------------------------------------------

DIVIDER = """
V1 in 0 10
R1 in out 1k
R2 out 0 1k
.tran 10u 1m
"""


def signals(checker):
    left_out = "it is left out"
    for card in (".save v(out) v(outt)", ".print tran v(out) i(R9)", ".probe v(out) v(in,nowhere)", ".plot tran v(out) v(7)",
                 ".save v(out) @r9[i]", ".save v(out) @r1[gd]", ".print tran v(out) iter(0)", ".print tran v(out) hello",
                 ".save v(out) @q1[ic]", ".probe v(out) i(x1.r2)"):
        done = checker.ends(DIVIDER + card, {"v(out)": 5}, [left_out])
        checker.check(done is None or len(done.names) == 2, f"{card}: other columns {done and done.names}")
    # Of signals that are there nothing is said.
    for card, signal in ((".print tran v(nodes)", "v(in)"), (".plot tran v(out) xlog", "v(out)"), (".save @r1[p]", "p(r1)")):
        done = checker.ends(DIVIDER + card, {signal: 25e-3 if signal == "p(r1)" else 10 if signal == "v(in)" else 5})
        checker.check(done is None or left_out not in done.stderr, f"{card}: {done and done.stderr}")
    # Where none is there, all are recorded.
    checker.ends(DIVIDER + ".save v(nosuch)", {"v(out)": 5, "v(in)": 10}, [left_out, "nosuch"])


# ---- Measurements -------------------------------------------------------------------------------------

LOWPASS = """
.param r=1k c=159.154943091895n
V1 in 0 AC 2
R1 in out {r}
C1 out 0 {c}
.ac dec 20 10 100k
"""


def measurements(checker):
    half = 1 / math.sqrt(2)
    cutoff = 1 / (2 * math.pi * 1e3 * 159.154943091895e-9)
    for card, value in (
            (".meas top max mag(v(out))", 2 / math.hypot(1, 10 / cutoff)),
            (".meas ac gain find mag(v(out)/v(in)) at=1k", 1 / math.hypot(1, 1000 / cutoff)),
            (".meas gain find mag(v(out)) at 1k", 2 / math.hypot(1, 1000 / cutoff)),
            (".meas edge when mag(v(out)/v(in))=0.70710678118654752", cutoff),
            (".meas ac edge when mag(v(out)/v(in))=0.70710678118654752 fall=1", cutoff),
            (".measure edge when mag( v(out) )=1.4142135623730951 cross 1", cutoff),
            (".meas half when mag(v(out)/2)=0.70710678118654752 fall 1", cutoff),
            (".meas ac low find freq*2 when mag(v(out)/v(in))=0.70710678118654752", 2 * cutoff),
            (".meas power find mag(v(out)*v(in)) at=1k", 4 / math.hypot(1, 1000 / cutoff)),
            (".meas f0 param 1/(2*pi*r*c)", cutoff)):
        checker.measures(LOWPASS + card, {card.split()[1 + (card.split()[1] == "ac")]: value}, 1e-5)
    checker.measures(LOWPASS + ".param f3={1/(2*pi*r*c)}\n.meas edge find mag(v(out)) at f3", {"edge": 2 * half}, 1e-5)
    wrong = checker.run(LOWPASS + ".meas x find mag(v(out)-v(in)) at=1k", 0)
    checker.check(wrong is None or "sum of complex signals" in wrong.stderr, f"{wrong and wrong.stderr}")
    # Words with a blank for the equal sign, of a .tran.
    rise = "V1 in 0 PULSE(0 1 0 1m 1m 1m 4m)\nR1 in 0 1k\n.tran 10u 8m\n"
    for card, value in ((".meas t when v(in)=0.5 rise 2", 4.5e-3), (".meas t when v(in)=0.5 fall 1", 2.5e-3),
                        (".meas tran t when v(in)=0.5 cross last", 6.5e-3), (".meas t find v(in) at 0.25m", 0.25),
                        (".meas t trig v(in)=0.5 rise 1 targ v(in)=0.5 fall 1", 2e-3)):
        checker.measures(rise + card, {"t": value})


# ---- Parameters, functions, quotes -----------------------------------------------------------------------

def parameters(checker):
    circuit = "V1 a 0 10\nR1 a b 1k\nR2 b 0 {rx}\n.op\n"
    for cards in (".param rx 1k*(1+2)", ".param rx 3k/(4-3)", ".params: rx=3k", ".param n=2\n.param rx table(n, 1, 2k, 2, 3k)",
                  ".param rx max(1k, 3k)", ".param rx 2k+(1k)", ".function f(x) x*3\n.param rx={f(1k)}",
                  ".function g(a,b) if(a>b, a, b)\n.param rx={g(1k,3k)}", ".function h(x,y) (x+y)\n.param rx=h(1k,2k)",
                  ".param rx 6k*sin(asin(0.5))"):
        checker.ends(circuit + cards, {"v(b)": 7.5})
    for formula in ("'k'*v(a)", "'k'*(v(a)+'z')", "v(a)*'k+z'", "{'k'*v(a)}", "{'k'*'v(a)'}", "max('k'*v(a), 'z')",
                    "'2*k'*v(a)/2", "v(a)*('k')", "if(v(a)>'z', 'k'*v(a), 'z')", "'k'*v(a)-'z'*'k'"):
        checker.ends(f".param k=0.25 z=0\nV1 a 0 10\nB1 b 0 V={formula}\nR1 b 0 1k\n.op", {"v(b)": 2.5})
    for card in ("V1 a 0 AC(2 90)", "V1 a 0 AC( 2, 90 )", "V1 a 0 DC 1 AC(2 90)", "V1 a 0 AC(2 90) SIN(0 1 1k)", "V1 a 0 1 AC=(2 90)",
                 "I1 0 a AC(2m 90)"):
        checker.measures(f"{card}\nR1 a 0 1k\n.ac lin 2 1k 2k\n.meas ac m max mag(v(a))", {"m": 2})
    pot = "V1 a 0 10\nX1 a b 0 pot {call}\n.subckt pot p q r {port}\nR1 p q {{rt*k}}\nR2 q r {{rt*(1-k)}}\n.ends\n.op"
    for port, call in (("PARAMS:rt=2k k=0.25", ""), ("params: rt=2k k=0.5", "PARAMS:k=0.25"), ("Params:rt=1k PARAMS:k=1", "PARAMS:k=0.25 rt=3k"),
                       ("rt=2k k=0.5", "PARAMS:rt=4k PARAMS:k=0.25")):
        checker.ends(pot.format(port=port, call=call), {"v(b)": 7.5})
    initial = ".param vout=3\nR1 a 0 1k\nC1 a 0 1u\n.tran 10u 1m uic\n"
    for card in (".ic v(a)=vout", ".ic v(a) = vout", ".ic v(a)={vout}", ".ic V(A)=Vout"):
        checker.ends(initial + card, {"v(a)": 3 / math.e})


# ---- Other cards and devices ------------------------------------------------------------------------------

def others(checker):
    for card in (".list", ".status", ".tran 10u 1m trace all", ".tran 10u 1m 0 trace off", ".tran 10u 1m uic trace rejected"):
        netlist = DIVIDER if not card.startswith(".tran") else DIVIDER.replace(".tran 10u 1m", "")
        checker.ends(netlist + card, {"v(out)": 5})
    checker.ends(DIVIDER + "R3 out 0 1e15 ac=5", {"v(out)": 5}, ["of .ac alone"])
    for card in (".net V1", ".net I(R2) V1", ".net v(out) V1 Rin=50"):
        done = checker.run(LOWPASS + card)
        checker.check(done is None or "not computed" in done.stderr, f"{card}: {done and done.stderr}")
    # In LTspice ^ is exclusive or, but a power in a transfer function.
    for ratio in ("1/(1+(s*1m)^2+s*1m)", "{1/(1+s^2*1u+s*1m)}", "1/(1+s^1*1m+(1m*s)^2)"):
        checker.ends(f".options dialect=ltspice\nV1 a 0 1\nE1 b 0 a 0 Laplace={ratio}\nR1 b 0 1k\n.op", {"v(b)": 1})
    # Pins that mean nothing, and outputs that nothing is wired to.
    clock = "V1 c 0 PULSE(0 1 1m 0 0 1m 2m)\nV2 d 0 1\n.tran 10u 3.5m\n"
    for card in ("A1 d 0 c 0 0 0 q 0 DFLOP", "A1 d d c 0 0 0 q 0 DFLOP", "A1 d c c 0 0 0 q 0 DFLOP Td=1n", "A1 d 0 0 0 0 0 q 0 BUF",
                 "A1 d c 0 0 0 0 q 0 BUF"):
        words = ["does not use pin 2"] if card.split()[2] != "0" else []
        checker.ends(clock + card + "\nRq q 0 1k", {"v(q)": 1}, words)
    checker.ends(clock + "A1 d 0 c 0 0 0 0 0 DFLOP\nRd d 0 1k", {"v(d)": 1}, ["no output of 'a1' is wired"])
    checker.ends("L1 a b 1m Rser=\nV1 a 0 1\nR1 b 0 1k\n.op", {"v(b)": 1}, ["has no value"])
    checker.ends("L1 a b 1m Rser= Cpar=1p\nV1 a 0 1\nR1 b 0 1k\n.op", {"v(b)": 1}, ["has no value"])
    # 0/0 at the operating point.
    for formula in ("v(a)/v(c)", "v(a)*v(a)/v(c)", "1+v(a)/v(c)", "v(a)/(v(c)*2)", "min(v(a)/v(c), 5)"):
        checker.ends(f"V1 a 0 0\nV2 c 0 0\nB1 b 0 V={formula}\nR1 b 0 1k\n.op", {"v(b)": 1 if formula[0] == "1" else 0})
    checker.ends("V1 a 0 PULSE(0 6 1m 0 0 9 10)\nV2 c 0 PULSE(0 2 1m 0 0 9 10)\nB1 b 0 V=v(a)/v(c)\nR1 b 0 1k\n.tran 10u 2m", {"v(b)": 3})


# ---- Random values over time --------------------------------------------------------------------------------

def noise(checker):
    def values(formula, stop="1m", extra=""):
        done = checker.run(f"B1 a 0 V={formula}\nR1 a 0 1k\n{extra}.tran 1u {stop}")
        return (done.column("time"), done.column("v(a)")) if done else ([], [])

    for formula, low, high in some_of([("rand(10k*time)", 0, 1), ("random(10k*time)", 0, 1), ("white(10k*time)", -0.5, 0.5),
                                       ("5*rand(20k*time+7)-2", -2, 3), ("rand(-10k*time)", 0, 1), ("white(3k*(time+1m))*4", -2, 2)]):
        times, found = values(formula, "20m")
        checker.check(len(found) > 0 and low <= min(found) and max(found) <= high, f"{formula}: {min(found)} to {max(found)}")
        mean, spread = sum(found) / len(found), (max(found) - min(found)) / (high - low)
        checker.check(abs(mean - (low + high) / 2) < 0.12 * (high - low) and spread > 0.8, f"{formula}: mean {mean}, spread {spread}")
    # rand holds its value from one whole number to the next, random goes on a straight line between the same.
    times, held = values("rand(10k*time)", "1m")
    between = [(t, v) for t, v in zip(times, held) if 0.1e-6 < t % 100e-6 < 99.9e-6]
    levels = [{v for t, v in between if int(t / 100e-6) == k} for k in range(10)]
    checker.check(all(len(level) == 1 for level in levels) and len(set.union(*levels)) == 10, f"rand: {levels}")
    times, line = values("random(10k*time)", "1m")
    start = [level.pop() for level in levels]
    worst = max(abs(v - (start[int(t / 100e-6)] * (1 - t / 100e-6 % 1) + start[int(t / 100e-6) + 1] * (t / 100e-6 % 1)))
                for t, v in zip(times, line) if t < 899e-6)
    checker.check(worst < 1e-9, f"random is off its lines by {worst}")
    # The same argument has the same values, another one others; also where a formula reads them.
    for one, other in (("rand(1k*time)", "rand(1k*time)+0*time"), ("white(1k*time)+0.5", "random(1k*time)"), ("rand(2k*time)", "rand(2000*time)")):
        checker.check(values(one) == values(other) or max(abs(a - b) for a, b in zip(values(one)[1], values(other)[1])) < 1e-12, f"{one}, {other}")
    checker.check(values("rand(1k*time)")[1] != values("rand(1k*time+100)")[1], "another argument has the same values")
    # Where a number is wanted, rand(x) is what a source has at that x, in every step of .step and run of .mc.
    for x in (0, 1, 7, 7.9, -3, -0.5, 12345, 1e6):
        whole = math.floor(x)
        at = values(f"rand(10k*time+{whole})", "0.05m")[1][-1]
        number = values("{v}", extra=f".param s={x} v=rand(s)\n")[1][-1]
        checker.check(number == at and 0 < at < 1, f"rand({x}) is {number}, {at} over time")
    steps = checker.run("V1 a 0 {rand(k)}\nR1 a 0 1k\n.step param k 1 4 1\n.op")
    checker.check(steps is not None and len(set(steps.column("v(a)"))) == 4, "rand(k) of .step")
    for formula, words in (("rand(v(b))", "straight line in time"), ("white(1e12*time)", "more than a million")):
        done = checker.run(f"V2 b 0 1\nB1 a 0 V={formula}\nR1 a 0 1k\n.tran 1u 1m", 3)
        checker.check(done is None or words in done.stderr, f"{formula}: {done and done.stderr}")


# ---- Capacitors and coils that something else changes ----------------------------------------------------------

def solve(rate, state, stop, steps=4000):
    """state' = rate(t, state) by Runge and Kutta."""
    h = stop / steps
    for k in range(steps):
        t = k * h
        a = rate(t, state)
        b = rate(t + h / 2, state + h / 2 * a)
        c = rate(t + h / 2, state + h / 2 * b)
        state += h / 6 * (a + 2 * b + 2 * c + rate(t + h, state + h * c))
    return state


def changing(checker):
    stop, ohms, w = 0.9e-3, 1e3, 2 * math.pi * 1e3

    def source(t):
        return math.sin(w * t)

    drive = "V1 in 0 SIN(0 1 1k)\nR1 in a 1k\nVk k 0 PULSE(1 2 0 1m 1m 0 2m)\n.tran 10u 0.9m\n"
    factor = {"v(k)": lambda t: 1 + t / 1e-3, "(1+time/1m)": lambda t: 1 + t / 1e-3, "(2+sin(2k*pi*time))": lambda t: 2 + math.sin(w * t),
              "(v(k)*v(k))": lambda t: (1 + t / 1e-3) ** 2, "(1+0.5*v(in))": lambda t: 1 + 0.5 * source(t)}
    for text, k in some_of(list(factor.items())):
        charge = solve(lambda t, q: (source(t) - q / (100e-9 * k(t))) / ohms, 0.0, stop)
        volts = charge / (100e-9 * k(stop))
        for card in (f"C1 a 0 Q=x*100n*{text}", f"C1 a 0 Q={{100n*{text}*x}}", f"C1 a 0 Q=v(a)*{text}*100n", f"C1 0 a Q=x*{text}*50n m=2"):
            checker.ends(drive + card, {"v(a)": volts}, allowed=1e-6)
        flux = solve(lambda t, p: source(t) - ohms * p / (0.1 * k(t)), 0.0, stop)
        amperes = flux / (0.1 * k(stop))
        for card in (f"L1 a 0 Flux=x*100m*{text}", f"L1 a 0 Flux={{i(L1)*{text}*0.1}}", f"L1 a 0 Flux=0.1*{text}*x Rser=0"):
            checker.ends(drive + card, {"v(a)": source(stop) - ohms * amperes, "i(l1)": amperes}, allowed=1e-6)
    # A charge that is no straight line of its own voltage either.
    charge = solve(lambda t, v: (source(t) - v) / ohms / (100e-9 * (1 + 3 * v * v) * (1 + t / 1e-3))
                   - (v + v ** 3) / (1 + 3 * v * v) / (1e-3 + t), 0.0, stop)
    checker.ends(drive + "C1 a 0 Q=100n*(x+x**3)*v(k)", {"v(a)": charge}, allowed=1e-6)
    done = checker.run(drive + "C1 a 0 Q=x*100n*v(k) ic=1", 3)
    checker.check(done is None or "begins at 0" in done.stderr, f"{done and done.stderr}")


# ---- Delays -------------------------------------------------------------------------------------------------------

def delays(checker):
    # Of a source: as the source is later, between its edges and on them.
    for words, value in (("PULSE(1 3 0.2m 0.2m 0.2m 1 2)", lambda t: 1 + min(max(t - 0.2e-3, 0) * 1e4, 2)),
                         ("SIN(1 2 1k)", lambda t: 1 + (2 * math.sin(2 * math.pi * 1e3 * t) if t > 0 else 0)),
                         ("PWL(0 1 0.5m 3 0.7m 0)", lambda t: 1 + max(t, 0) * 4e3 if t < 0.5e-3 else 3 - (t - 0.5e-3) * 1.5e4),
                         ("EXP(0 2 0.1m 0.2m)", lambda t: 2 * (1 - math.exp(-(t - 0.1e-3) / 0.2e-3)) if t > 0.1e-3 else 0), ("2", lambda t: 2)):
        for seconds in (0, 50e-6, 0.3e-3, 2e-3):
            checker.ends(f"V1 a 0 {words}\nR1 a 0 1k\nB1 b 0 V=delay(v(a), {seconds!r})*2-1\nR2 b 0 1k\n.tran 10u 0.65m",
                         {"v(b)": 2 * value(0.65e-3 - seconds) - 1})
    # Of a signal of two values: a gate, a comparison, a formula, beside others.
    wave = "V1 a 0 SIN(0 1 1k)\nR1 a 0 1k\n"
    def bits(expression, name, extra=""):
        return f"{wave}{extra}B1 b 0 V={expression}\nR2 b 0 1k\n.tran 10u 2.2m\n.meas tran up when v(b)=2.5 rise=2\n" \
               f".meas tran down when v(b)=2.5 fall=1\n", {"up": 1e-3 + name, "down": 0.5e-3 + name}
    for expression, extra in (("delay(v(q), 70u)", "Bq q 0 V=v(a)>0 ? 5 : 0\nRq q 0 1k\n"), ("delay(v(a)>0 ? 5 : 0, 70u)", ""),
                              ("5*delay(u(v(a)), 70u)", ""), ("delay(v(q), 70u, 80u)", "A1 a 0 0 0 0 0 q 0 BUF Vhigh=5 Ref=0\nRq q 0 1k\n"),
                              ("absdelay(v(q), 70u)", "Bq q 0 V=if(v(a)>0, 5, 0)\nRq q 0 1k\n"),
                              ("delay(v(q), d)", ".param d=70u\nBq q 0 V=5*(v(a)>0)\nRq q 0 1k\n"),
                              ("delay(5*v(q), 70u)", "Bq q 0 V=v(a)>0\nRq q 0 1k\n"), ("delay(delay(v(q), 30u), 40u)", "Bq q 0 V=5*(v(a)>0)\nRq q 0 1k\n")):
        netlist, wanted = bits(expression, 70e-6, extra)
        checker.measures(netlist, wanted, 1e-7)
    # A dead time: high where the comparison and the same 100 us earlier both are.
    checker.measures(f"{wave}Bq q 0 V=v(a)>0\nRq q 0 1k\nBh h 0 V=v(q)>0.5 & delay(v(q),100u)>0.5 ? 10 : 0\nRh h 0 1k\n"
                     "Bl l 0 V=v(q)>0.5 | delay(v(q),100u)>0.5 ? 0 : 10\nRl l 0 1k\n.tran 10u 4m\n"
                     ".meas tran high avg v(h) from=1m to=4m\n.meas tran low avg v(l) from=1m to=4m", {"high": 4, "low": 4}, 1e-7)
    for formula, words in (("delay(v(a), -1)", "0 or more"), ("delay(v(a), v(c))", "0 or more")):
        done = checker.run(f"V1 a 0 SIN(0 1 1k)\nR1 a c 1k\nC1 c 0 1u\nB1 b 0 V={formula}\nR2 b 0 1k\n.tran 10u 1m", 3)
        checker.check(done is None or words in done.stderr, f"{formula}: {done and done.stderr}")


# ---- Cards of others ----------------------------------------------------------------------------------------------

def left_out(checker):
    """What is an output of others beside a run, and how they compute it."""
    for card in (".result {v(out)}", ".result v(out)", ".result {(v(out)+2)**2*1k}", ".RESULT {abs(v(in))-10}", ".sens objfunc={v(out)} param=R1:R",
                 ".sens param=r1:r,r2:r objvars=out", ".sens v(out)"):
        checker.ends(DIVIDER + card, {"v(out)": 5}, ["the card is left out"])
    for words in ("cache=2", "mtol=10 cache=2", "window=1 nfft=1024 cache=8", "cache=1e3 mtol=1"):
        checker.ends(f"V1 a 0 1\nE1 out 0 a 0 Laplace=1./(1+.0005*s)**3 {words}\nR1 out 0 1k\n.tran 10u 1m", {"v(out)": 1})
    # Xyce's thresholds with hysteresis, of a control that rises to `top` and falls again.
    for on, off, top, value in ((0.55, 0.25, 0.5, 0), (0.55, 0.25, 0.6, 10), (-0.1, -0.4, 0.05, 10), (3, 1, 2.9, 0)):
        checker.ends(f"V1 a 0 10\nV2 c 0 PWL(0 -1 1m {top!r} 2m {0.5 * (off + min(top, on))!r})\nR2 c 0 1\nS1 a out sm control={{v(c)}}\nR1 out 0 1k\n"
                     f".model sm switch(on={on + 1!r} onh={on!r} off={off - 1!r} offh={off!r} ron=0 roff=inf)\n.tran 10u 2m", {"v(out)": value})


    # An S with a model of amperes compares volts with them.
    for words, top, value in (("ion=10m ioff=0", 6e-3, 10), ("ion=10m ioff=0", 4e-3, 0), ("ion=2 ioff=1", 1.6, 10), ("ion=2 ioff=1", 1.4, 0),
                              ("ion=0 ioff=10m", 4e-3, 10), ("ion=0 ioff=10m", 6e-3, 0), ("ihon=3 ihoff=1", 2.9, 0), ("ihon=3 ihoff=1", 3.1, 10)):
        checker.ends(f"V1 a 0 10\nV2 c 0 PWL(0 0 1m {top!r})\nR2 c 0 1\nS1 a out c 0 sm\nR1 out 0 1k\n.model sm iswitch({words} ron=0 roff=inf)\n.tran 10u 1m",
                     {"v(out)": value}, ["in volts, as Xyce's does"])
    # How LTspice computes a source of a current, on either side of what lies across it.
    for words in ("tripdt=1n", "Rpar=1k tripdt=1n", "tripdv=1 Rpar=1k", "Rpar=1k tripdv=1 tripdt=1n", "Rpar=1k Cpar=1p tripdt=1n"):
        checker.ends(f"V1 a 0 1\nR1 a 0 1\nB1 0 out I=2m*v(a) {words}\nR2 out 0 1k\n.tran 10u 1m", {"v(out)": 1 if "Rpar" in words else 2})


def limited_switches(checker):
    """Ilimit of a switch: Ron up to it, either way, and any larger voltage at it."""
    def circuit(source, behind, model, after="", switch="S1 a out g 0 sm"):
        return f"V1 a 0 {source}\nVg g 0 1\nRg g 0 1\n{switch}\n{behind}\n.model sm {model}\n{after}.save v(out) i(S1)\n.tran 10u 1m"
    for volts, ohms, limit, ron in ((10, 1, 2, 1), (10, 9, 2, 1), (-10, 1, 2, 1), (400, 0.1, 60, 1e-3), (1e-3, 1, 1e-4, 0), (1e4, 1e3, 3, 0.5), (-5, 4, 1, 1)):
        amperes = math.copysign(min(abs(volts) / (ohms + ron), limit), volts)
        checker.ends(circuit(volts, f"R1 out 0 {ohms!r}", f"sw(ron={ron!r} roff=1g vt=0.5 iLimit={limit!r}A)"), {"v(out)": amperes * ohms, "i(s1)": amperes})
    for limit, volts in (("5m", 5), ("7m", 7), ("50m", 10)):  # a ramp
        checker.ends(circuit(10, "C1 out 0 1u", f"sw(ron=1 vt=0.5 ilimit={limit})") + " uic", {"v(out)": volts})
    checker.ends(circuit("SIN(0 10 250)", "L1 out b 1m\nR1 b 0 1u", "sw(ron=0 vt=0.5 ilimit=0.5)"), {"i(s1)": 0.5})
    checker.ends(circuit(10, "R1 out 0 1", "sw(ron=0 vt=0.5 ilimit=2)", ".subckt s p q g\nS1 p q g 0 sm\n.ends\n", "X1 a out g s m=3")
                 .replace(" i(S1)", ""), {"v(out)": 6})
    checker.ends(circuit(10, "R1 out 0 1", "sw(ron=0 vt=0.5 ilimit=2 vser=1 lser=1n)"), {"v(out)": 2})
    checker.ends(circuit(10, "R1 out 0 1", "csw(ron=0 it=0.5 ilimit=2)", switch="W1 a out Vg sm", after="").replace("i(S1)", "i(W1)").replace("Rg g 0 1", "Rg g 0 -1"),
                 {"v(out)": 2})
    checker.ends(circuit(10, "R1 out 0 1k", "sw(ron=0 roff=1meg vt=2 ilimit=2)"), {"v(out)": 10 / 1001})  # an open one
    checker.measures(circuit("SIN(0 10 1k)", "R1 out 0 1", "sw(ron=0 vt=0.5 ilimit=5)", ".meas tran m avg abs(v(out))\n"),
                     {"m": (10 * (1 - math.cos(math.pi / 6)) * 2 + 5 * (math.pi - math.pi / 3)) / math.pi}, 1e-6)
    for limit in ("0", "-1"):
        done = checker.run(circuit(10, "R1 out 0 1", f"sw(ron=0 vt=0.5 ilimit={limit})"), 3)
        checker.check(done is None or "Ilimit must be positive" in done.stderr, f"{done and done.stderr}")


def currents(checker):
    """F and H with value=, which are G and E."""
    circuit = "V1 a 0 10\nR1 a c 1k\nV2 c 0 0\nRb b 0 1k\n.op\n"
    for card, value in (("F1 0 b value={2*i(V2)}", 20), ("F1 0 b VALUE = {i(V2)*v(a)/5}", 20), ("H1 b 0 value={2k*i(V2)}", 20), ("H1 b 0 value={v(a)*2}", 20),
                        ("F1 b 0 value {-2*i(R1)}", 20), ("H1 b 0 VALUE={i(V2)>1m ? 20 : 0}", 20), ("F1 0 b V2 2", 20), ("H1 b 0 V2 2k", 20)):
        checker.ends(circuit + card, {"v(b)": value})


def main():
    checker = Strangers("strangers")
    for kind in (signals, measurements, parameters, others, noise, changing, delays, left_out, limited_switches, currents):
        kind(checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
