#!/usr/bin/env python3
"""Measurements against closed forms, to 1e-10 with the default method.

usage: closed_forms.py PROGRAM

Tolerance 1e-13 where a circuit has states, so that what is left is the measurement's own.
"""

import math
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

CLOSE = 1e-10
PI = math.pi


class Results:
    """The measurements of one netlist."""

    def __init__(self, program, checker, netlist, options=(), method=None, tolerance=1e-13,
                 step=None):
        self.checker = checker
        self.title = netlist.split("\n", 1)[0]
        self.run = dalcs_program.run(program, netlist, options=options, method=method,
                                     tolerance=tolerance, step=step)
        checker.check(self.run.status == 0, f"{self.title}: {self.run.stderr}")
        found = self.run.report["measurements"] if self.run.status == 0 else []
        self.of = {entry["name"]: entry for entry in found}

    def close(self, name, wanted, key="value", scale=None, tolerance=CLOSE):
        entry = self.of.get(name)
        if not self.checker.check(entry is not None and entry.get(key) is not None,
                                  f"{self.title}: no {key} of {name}: {entry}"):
            return
        allowed = tolerance * (abs(wanted) if scale is None else scale)
        self.checker.close(entry[key], wanted, allowed, f"{self.title}: {name} {key}")


def sines(program, checker):
    """No memory, and a period that no row falls on."""
    r = Results(program, checker, """sines
V1 a 0 SIN(1 10 1k)
R1 a 0 50
V2 b 0 SIN(0 3 1k 0 0 30)
R2 b 0 1
.tran 77u 5m
.meas tran mean AVG v(a)
.meas tran rms RMS v(a)
.meas tran over3 INTEG v(a) from=0.25m to=1.75m
.meas tran top MAX v(a) from=1m
.meas tran low MIN v(a)
.meas tran pp PP v(a,b)
.meas tran topat MAX_AT v(a) from=2m
.meas tran lowat MIN_AT v(a) from=2m
.meas tran power AVG v(a)*i(r1)
.meas tran powers AVG {v(a)*i(r1)} from=1m to=4m
.meas tran mixed AVG v(a)*v(b)
.meas tran rectified AVG abs(v(b))
.meas tran half AVG max(v(b),0)
.meas tran root RMS sqrt(abs(v(b)))
.meas tran conducts AVG v(b)>1.5
.meas tran when WHEN v(a)=6 RISE=3
.meas tran last WHEN v(a)=6 FALL=LAST
.meas tran any WHEN v(a)=6 CROSS=4
.meas tran late WHEN v(a)=6 RISE=1 TD=2.2m
.meas tran between WHEN v(a)=6 RISE=1 from=1.5m
.meas tran equal WHEN v(a)=v(b) RISE=2
.meas tran find FIND v(b)+time*1k WHEN v(a)=6 FALL=2
.meas tran at FIND v(a)**2 AT=1.3m
.meas tran slope DERIV v(a) AT=1.3m
.meas tran slopew DERIV v(a)*v(a) WHEN v(a)=6 RISE=1
.meas tran delay TRIG v(a) VAL=1 RISE=2 TARG v(b) VAL=0 RISE=2
.meas tran delay2 TRIG AT=1u TARG v(a)=6 CROSS=1
.meas tran inside AVG v(a) TRIG v(a)=6 RISE=1 TARG v(a)=6 FALL=1
.meas tran ratio PARAM='power/mean + 2*rms'
.end
""")
    a = lambda t: 1 + 10 * math.sin(2 * PI * 1e3 * t)
    b = lambda t: 3 * math.sin(2 * PI * 1e3 * t + PI / 6)
    first = math.asin(0.5) / (2 * PI * 1e3)  # v(a) = 6
    second = 0.5e-3 - first
    r.close("mean", 1.0)
    r.close("rms", math.sqrt(1 + 50))
    r.close("over3", 1.5e-3 + 0.0, scale=1e-2)
    r.close("top", 11.0)
    r.close("top", 1.25e-3, "at", tolerance=1e-7)
    r.close("low", -9.0)
    r.close("pp", 2 * math.hypot(10 - 3 * math.cos(PI / 6), 1.5))
    r.close("topat", 2.25e-3, tolerance=1e-7)  # flat there: the square root of rounding
    r.close("topat", 11.0, "with")
    r.close("lowat", 2.75e-3, tolerance=1e-7)
    r.close("power", 51 / 50)
    r.close("powers", 51 / 50)
    r.close("powers", 1e-3, "from")
    r.close("powers", 4e-3, "to")
    r.close("mixed", 15 * math.cos(PI / 6))
    r.close("rectified", 3 * 2 / PI)
    r.close("half", 3 / PI)
    r.close("root", math.sqrt(3 * 2 / PI))
    r.close("conducts", 1 / 3)
    r.close("when", 2e-3 + first)
    r.close("last", 4e-3 + second)
    r.close("any", 1e-3 + second)
    r.close("late", 3e-3 + first)
    r.close("between", 2e-3 + first)
    # v(a) - v(b) = 1 + k sin(x - phi) with k, phi of the difference of the sines
    k = math.hypot(10 - 3 * math.cos(PI / 6), 1.5)
    phi = math.atan2(1.5, 10 - 3 * math.cos(PI / 6))
    r.close("equal", (phi - math.asin(1 / k)) / (2 * PI * 1e3) + 1e-3 * (
        2 if phi < math.asin(1 / k) else 1))
    t = 1e-3 + second
    r.close("find", b(t) + t * 1e3)
    r.close("at", a(1.3e-3) ** 2)
    r.close("slope", 2e4 * PI * math.cos(2 * PI * 1.3), scale=2e4 * PI)
    r.close("slopew", 2 * 6 * 2e4 * PI * math.cos(2 * PI * 1e3 * first))
    r.close("delay", -1e-3 / 12, scale=1e-3)
    r.close("delay2", first - 1e-6)
    r.close("inside", 1 + 10 * (2 * math.cos(2 * PI * 1e3 * first)) /
            (2 * PI * 1e3 * (second - first)))
    r.close("ratio", 51 / 50 + 2 * math.sqrt(51))


def charging(program, checker):
    tau = 1e-3
    r = Results(program, checker, """RC and RL
V1 in 0 PULSE(0 5 1m 0 0 10m 20m)
R1 in c 1k
C1 c 0 1u
L1 in l 2m
R2 l 0 2
.tran 1m 40m
.meas tran t1 WHEN v(c)=2 RISE=1
.meas tran t2 TRIG v(c)=0.5 RISE=1 TARG v(c) VAL=4.5 RISE=1
.meas tran edge WHEN v(in)=2.5 RISE=1
.meas tran edge2 WHEN v(in)=2.5 FALL=2
.meas tran before FIND v(c) WHEN v(in)=2.5 FALL=1
.meas tran after FIND v(in) WHEN v(in)=2.5 FALL=1
.meas tran i1 WHEN i(l1)=1 CROSS=1
.meas tran slope DERIV v(c) AT=3m
.meas tran jump DERIV i(l1) AT=1m
.meas tran charge INTEG i(r1) from=0 to=11m
.meas tran top MAX v(in)
.meas tran duty AVG v(in)/5 from=0 to=20m
.end
""")
    r.close("t1", 1e-3 - tau * math.log(1 - 2 / 5))
    r.close("t2", tau * math.log(0.9 / 0.1))
    r.close("edge", 1e-3)
    r.close("edge2", 31e-3)
    r.close("before", 5 * (1 - math.exp(-10)))
    r.close("after", 0.0, scale=1.0)
    r.close("i1", 1e-3 - 1e-3 * math.log(1 - 1 / 2.5))
    r.close("slope", 5 / tau * math.exp(-2))
    r.close("jump", 5 / 2e-3)
    r.close("charge", 5e-6 * (1 - math.exp(-10)))
    r.close("top", 5.0)
    r.close("duty", 0.5)


def rectifier(program, checker):
    r = Results(program, checker, """half wave
V1 in 0 SIN(0 10 50)
D1 in out
R1 out 0 100
.tran 1m 100m
.meas tran mean AVG v(out)
.meas tran rms RMS v(out)
.meas tran heat AVG v(out)*i(r1)
.meas tran width TRIG i(d1) VAL=0.05 RISE=2 TARG i(d1) VAL=0.05 FALL=2
.meas tran peak MAX v(in,out)
.end
""")
    r.close("mean", 10 / PI)
    r.close("rms", 5.0)
    r.close("heat", 0.25)
    r.close("width", 0.01 - 2 * math.asin(0.5) / (2 * PI * 50))
    r.close("peak", 0.0, scale=10.0)


def pulses(program, checker):
    r = Results(program, checker, """pulses
V1 a 0 PULSE(0 10 0 0 0 3.7u 10u)
V2 b 0 PULSE(-2 2 1u 1u 2u 3u 10u)
R1 a b 10
.tran 1u 100u
.meas tran mean AVG v(a)
.meas tran rms RMS v(b)
.meas tran width TRIG v(a) VAL=5 RISE=3 TARG v(a) VAL=5 FALL=3
.meas tran on TRIG v(b)=1 RISE=3 TARG v(b)=1 FALL=3
.meas tran ten WHEN v(a)=5 FALL=10
.meas tran p AVG i(r1)*v(a,b)
.end
""")
    r.close("mean", 3.7)
    r.close("rms", math.sqrt((3 * 4 + 1 * 4 / 3 + 2 * 4 / 3 + 4 * 4) / 10))
    r.close("width", 3.7e-6)
    r.close("on", 0.25e-6 + 3e-6 + 0.5e-6)
    r.close("ten", 93.7e-6)
    # exact: (v_a - v_b)^2 / 10 over the pieces of a period
    total = 0.0
    for t0, t1, va, v0, v1 in ((0, 1, 10, -2, -2), (1, 2, 10, -2, 2), (2, 3.7, 10, 2, 2),
                               (3.7, 5, 0, 2, 2), (5, 7, 0, 2, -2), (7, 10, 0, -2, -2)):
        p, q = va - v0, va - v1
        total += (t1 - t0) * (p * p + p * q + q * q) / 3
    r.close("p", total / 100)


def ledger(program, checker):
    """Powers against the ledger of energies, and a converter in its steady state."""
    r = Results(program, checker, """buck
V1 in 0 12
S1 in sw g 0 sw
V2 g 0 PULSE(0 1 0 0 0 4u 10u)
D1 0 sw
L1 sw out 100u IC=1
C1 out 0 47u IC=4.8
R1 out 0 4.8
.model sw SW(Vt=0.5 Ron=10m)
.tran 10u 2m uic
.meas tran given INTEG -v(in)*i(v1)
.meas tran taken INTEG v(out)*i(r1)
.meas tran lost INTEG v(in,sw)*i(s1)
.meas tran vout AVG v(out) from=1.9m to=2m
.meas tran ripple PP i(l1) from=1.99m to=2m
.meas tran vl AVG v(sw,out) from=1.99m to=2m
.meas tran on TRIG v(sw)=6 RISE=10 TARG v(sw)=6 FALL=11
.end
""", tolerance=1e-12)
    e = r.run.report["energy"]
    r.close("given", e["sources"])
    taken, lost = r.of["taken"]["value"], r.of["lost"]["value"]
    checker.close(taken + lost, e["resistors"], CLOSE * e["resistors"], "buck: dissipation")
    r.close("on", 4e-6, tolerance=1e-8)
    checker.close(r.of["vout"]["value"], 0.4 * 12, 0.05, "buck: output")
    run = dalcs_program.run(program, "\n".join([
        "buck, rows", "V1 in 0 12", "S1 in sw g 0 sw", "V2 g 0 PULSE(0 1 0 0 0 4u 10u)", "D1 0 sw",
        "L1 sw out 100u IC=1", "C1 out 0 47u IC=4.8", "R1 out 0 4.8",
        ".model sw SW(Vt=0.5 Ron=10m)", ".save i(l1)", ".tran 1m 2m uic",
        ".meas tran given INTEG -v(in)*i(v1)", ".meas tran other AVG i(c1)", ".end", ""]),
        method=None, tolerance=1e-12)
    checker.check(run.names == ["time", "i(l1)"], f"measured signals in the output: {run.names}")
    found = {m["name"]: m["value"] for m in run.report["measurements"]}
    checker.close(found["given"], e["sources"], CLOSE * e["sources"], "buck: another grid")


def euler(program, checker):
    """The straight lines between the steps of implicit Euler."""
    r = Results(program, checker, """steps
V1 in 0 1
R1 in c 1
C1 c 0 1 IC=0
.tran 1 3 uic
.meas tran mean AVG v(c)
.meas tran rms RMS v(c)
.meas tran t WHEN v(c)=0.6
.end
""", method="euler", tolerance=None, step=1.0)
    v = [0.0, 0.5, 0.75, 0.875]
    r.close("mean", sum((p + q) / 2 for p, q in zip(v, v[1:])) / 3, tolerance=1e-9)
    r.close("rms", math.sqrt(sum((p * p + p * q + q * q) / 3 for p, q in zip(v, v[1:])) / 3),
            tolerance=1e-9)
    r.close("t", 1 + 0.1 / 0.25, tolerance=1e-9)


def others(program, checker):
    """Failures, operating points, parameters, subcircuits, several parts."""
    r = Results(program, checker, """others
.param level=2 t0=1m
.subckt part a b
R1 a m 1k
R2 m b 1k
.ends
V1 in 0 SIN(0 5 1k)
X1 in 0 part
V2 free 0 3
R3 free 0 1
.op
.tran 1u 2m
.meas op o1 FIND v(free)
.meas op o2 MAX v(free)*2
.meas op o3 PARAM='o1+o2'
.meas tran a1 WHEN v(x1.m)=level RISE=1
.meas tran a2 FIND v(x1:m) AT={t0/4}
.meas a3 AVG v(x1.m,free)
.meas tran never WHEN v(in)=6
.meas tran few WHEN v(in)=2 RISE=5
.meas tran outside FIND v(in) AT=5m
.meas tran empty AVG v(in) from=3m to=4m
.meas tran ratio AVG v(in)/v(in,in)
.meas tran follows PARAM='a1*never'
.meas tran order AVG v(in) TRIG v(in)=2 RISE=2 TARG v(in)=2 RISE=1
.meas dc none MAX v(in)
.end
""")
    r.close("o1", 3.0)
    r.close("o2", 6.0)
    r.close("o3", 9.0)
    r.close("a1", math.asin(0.8) / (2 * PI * 1e3))
    r.close("a2", 2.5)
    r.close("a3", -3.0)
    wanted = {
        "never": "'v(in)' never crosses 6 between 0 s and 2 ms",
        "few": "'v(in)' rises through 2 only 2 times between 0 s and 2 ms, not 5",
        "outside": "AT=5 ms does not lie between 0 s and 2 ms",
        "empty": "there is nothing to measure: the run goes from 0 s to 2 ms",
        "ratio": "'v(in)/v(in,in)' is undefined at some of its times",
        "follows": "it needs 'never', which could not be measured",
        "order": "TARG at 65.4949 us does not come after TRIG at 1.06549 ms",
    }
    for name, why in wanted.items():
        entry = r.of.get(name, {})
        checker.check(entry.get("value", 0) is None and entry.get("failure") == why,
                      f"others: {name}: {entry}")
        checker.check(f"warning: {name}: {why}\n.meas" in r.run.stderr,
                      f"others: no warning of {name} in {r.run.stderr}")
    checker.check("none" not in r.of, "others: a measurement of an analysis that is not there")


def late(program, checker):
    """Of earlier results: times, levels, formulas; functions of the netlist."""
    r = Results(program, checker, """late
.param tau=1m
.func half(x) {x/2}
.func power(r) {v(out)*v(out)/r}
.func nest(a,b) {half(a) + half(b)*if(a > 0, 1, 2) + (b > 0 ? 0 : a)}
.func nothing() {3}
V1 in 0 1
R1 in out 1k
C1 out 0 1u
.dc V1 0 2 0.5
.ac lin 3 1k 3k
V2 aside 0 AC 1
R2 aside 0 1
.op
.tran 0.1m 5m uic
.meas op o1 FIND v(in)
.meas op o2 FIND v(in)*o1+nothing()
.meas dc d1 WHEN v(in)=o1/4
.meas dc d2 AVG v(in) FROM=d1
.meas ac a1 FIND v(aside)*o1 AT=2k
.meas ac a2 FIND vi(aside) AT={a1*1k+500}
.meas tran t1 WHEN v(out)=0.5
.meas tran vmax MAX v(out)
.meas tran t9 WHEN v(out)=0.9*vmax
.meas tran mean AVG v(out) FROM=t1 TO={t1+tau}
.meas tran early FIND v(out) AT='t1/2'
.meas tran middle WHEN v(out)='half(vmax)' TD='t1/2'
.meas tran much FIND v(out) WHEN v(out)=0.5 TD=t1+tau
.meas tran over MAX v(out)/vmax
.meas tran energy INTEG power(1k)
.meas tran nested FIND nest(v(out), 1-v(out)) AT=tau
.meas tran both WHEN half(v(out))=half(0.5)
.meas tran rise TRIG AT=t1 TARG v(out) VAL='0.9*vmax'
.meas tran edge AVG v(out) TRIG AT=t1 TARG AT=t9
.meas tran slope DERIV v(out) AT=t1
.meas tran wrong AVG v(out) FROM=t9 TO=t1
.meas tran follows FIND v(out) AT=wrong
.meas tran infinite FIND v(out) AT='1/(t1-t1)'
.end
""")
    tau, stop = 1e-3, 5e-3
    v = lambda t: 1 - math.exp(-t / tau)
    when = lambda level: -tau * math.log(1 - level)
    integral = lambda t: t + tau * math.exp(-t / tau)
    t1, vmax = when(0.5), v(stop)
    t9 = when(0.9 * vmax)
    r.close("o2", 4.0)
    r.close("d1", 0.25)
    r.close("d2", 1.125)
    r.close("a1", 1.0)
    r.close("a2", 0.0, scale=1.0)
    r.close("t9", t9)
    r.close("mean", (integral(t1 + tau) - integral(t1)) / tau)
    r.close("mean", t1, "from")
    r.close("mean", t1 + tau, "to")
    r.close("early", v(t1 / 2))
    r.close("middle", when(vmax / 2))
    r.close("over", 1.0)
    r.close("energy", 1e-3 * (stop - 2 * tau * v(stop) + tau / 2 * (1 - math.exp(-2 * stop / tau))))
    r.close("nested", 0.5)
    r.close("both", t1)
    r.close("rise", t9 - t1)
    r.close("edge", (integral(t9) - integral(t1)) / (t9 - t1))
    r.close("slope", 0.5 / tau)
    wanted = {
        "much": "'v(out)' never crosses 0.5 between 1.69315 ms and 5 ms",
        "wrong": "FROM=2.24371 ms does not come before TO=693.147 us",
        "follows": "it needs 'wrong', which could not be measured",
        "infinite": "a time that earlier measurements give has no value",
    }
    for name, why in wanted.items():
        checker.check(r.of.get(name, {}).get("failure") == why, f"late: {name}: {r.of.get(name)}")
    stepped = Results(program, checker, """late, with implicit Euler and steps
.param r=1
.step param r list 1 2
V1 a 0 PWL(0 0 10 10)
R1 a 0 {r}
.tran 1 10
.meas tran t WHEN i(r1)=2
.meas tran mean AVG v(a) FROM=t
.end
""", method="euler", tolerance=None, step=1.0)
    stepped.close("t", 4.0, tolerance=1e-9)  # of the last step
    stepped.close("mean", 7.0, tolerance=1e-9)


def fourier(program, checker):
    run = dalcs_program.run(program, """fourier
V1 sq 0 PULSE(-1 1 0 0 0 0.5m 1m)
R1 sq 0 1
V2 in 0 SIN(0 10 1k)
D1 in out
R2 out 0 10
V3 tri 0 PWL(0 0 0.25m 1 0.75m -1 1m 0) r=0
R3 tri 0 1
.tran 10u 7.3m
.four 1k v(sq)
.four 1k 15 3 v(out) v(tri)
.four 1k 5 -1 v(sq)
.end
""", method=None, tolerance=1e-13)
    checker.check(run.status == 0, run.stderr)
    square, half, triangle, whole = run.report["fourier"]

    def check(entry, k, wanted, what):
        """wanted: the coefficient of exp(2 pi i k f t), of sines."""
        found = entry["magnitude"][k]
        checker.close(found, abs(wanted), CLOSE, f"{what}: magnitude {k}")
        if abs(wanted) > 0.0:  # phases count from the start of the window
            phase = entry["phase"][k] - 360.0 * k * 1e3 * entry["from"]
            error = (phase - math.degrees(math.atan2(wanted.imag, wanted.real)) + 180) % 360 - 180
            checker.close(error, 0.0, 1e-7, f"{what}: phase {k}")

    for k in range(1, 10):
        check(square, k, complex(4 / PI / k if k % 2 else 0.0), "square")
    for k in range(1, 16):
        if k == 1:
            wanted = complex(5.0)
        else:  # -20/pi/(k^2-1) cos(k x), even k
            wanted = complex(0.0, -20 / PI / (k * k - 1)) if k % 2 == 0 else 0j
        check(half, k, complex(wanted), "half wave")
        check(triangle, k,
              complex(8 / PI**2 / k**2 * (-1) ** ((k - 1) // 2) if k % 2 else 0.0), "triangle")
    checker.close(half["magnitude"][0], 10 / PI, CLOSE, "half wave: mean")
    checker.close(square["thd"], math.sqrt(sum(1 / k**2 for k in (3, 5, 7, 9))), CLOSE, "thd")
    checker.close(half["from"], 4.3e-3, 1e-15, "half wave: window")
    checker.close(whole["from"], 0.3e-3, 1e-15, "all whole periods: window")
    checker.close(whole["magnitude"][3], 4 / PI / 3, CLOSE, "all whole periods")


def no_fundamental(program, checker):
    """What is left of a component that is 0 is rounding: there is no THD. One above what the run resolves has one."""
    run = dalcs_program.run(program, """no fundamental
Va a 0 SIN(0 325 50)
Vb b 0 SIN(0 325 50 0 0 -120)
Vc c 0 SIN(0 325 50 0 0 120)
D1 a p
D2 b p
D3 c p
D4 n a
D5 n b
D6 n c
R1 p n 10
V2 x 0 SIN(1k 1m 50)
V3 w x SIN(0 2m 150)
R2 w 0 1
R3 z 0 1
V4 u 0 SIN(1 1e-8 50)
R4 u 0 1
.tran 20u 60m
.four 50 v(p,n) v(p) v(w) v(z) v(a)
.four 300 v(p,n)
.four 50 3 v(u)
.end
""", method=None, tolerance=1e-7)
    checker.check(run.status == 0, run.stderr)
    told = run.report["fourier"]
    for k in 0, 1, 3, 6:
        checker.check(told[k]["thd"] is None, f"{told[k]['signal']}: THD {told[k]['thd']}")
    checker.check(run.stderr.count("has no fundamental and no THD") == 4, run.stderr)
    checker.close(told[2]["thd"], 2.0, 1e-5, "a fundamental of 1e-6 of the mean")
    checker.close(told[4]["thd"], 0.0, 1e-12, "a sine")
    # 2/(k^2 - 1) of the mean at k times 50 Hz, k = 6, 12, ...
    ripple = [2.0 / ((6 * k)**2 - 1) for k in range(1, 10)]
    checker.close(told[5]["thd"], math.hypot(*ripple[1:]) / ripple[0], CLOSE, "the ripple of a bridge")
    checker.check("THD: none, no fundamental" in run.output if isinstance(run.output, str) else True, "as text")


def decibels(program, checker):
    """Close to 0 dB all that is left of a logarithm is rounding: it is no reason to look closer."""
    r = Results(program, checker, "decibels\nV1 in 0 AC 1\nR1 in out 1k\nC1 out 0 1u\n"
                ".ac dec 20 1 10k\n.meas ac top max vdb(out)\n.end\n")
    checker.close(r.of["top"]["value"], -10 * math.log10(1 + (2e-3 * math.pi) ** 2), 1e-9,
                  "the largest of vdb")


def between_frequencies(program, checker):
    """Powers of the frequency are exact between two rows, however far apart; a resonance is near its value."""
    circuit = ("powers\nI1 0 a AC 1\nC1 a 0 {farad!r}\nI2 0 b AC 1\nL1 b 0 {henry!r}\nG1 0 c a 0 1m\nC2 c 0 {farad!r}\n"
               "{card}\n")
    for card, at in ((".ac dec 2 1 100k", 777.0), (".ac list 10 1meg", 31.4), (".ac lin 3 1 1001", 600.0), (".ac dec 30 1 10k", 5.0)):
        farad, henry = 1e-3 / (2 * PI), 1e-3 / (2 * PI)  # 1000/f ohm and f/1000 ohm
        r = Results(program, checker, circuit.format(farad=farad, henry=henry, card=card) +
                    f".meas ac fall FIND vm(a) AT={at}\n.meas ac turn FIND vp(a) AT={at}\n.meas ac grow FIND vm(b) AT={at}\n"
                    f".meas ac twice FIND vdb(c) AT={at}\n.meas ac cross WHEN vdb(a)={-20 * math.log10(at / 1e3)!r}\n.end\n")
        for name, wanted in (("fall", 1e3 / at), ("turn", -90), ("grow", at / 1e3), ("twice", 20 * math.log10(1e3 / at**2)), ("cross", at)):
            checker.close(r.of[name]["value"], wanted, 1e-9, f"{card}: {name}")
    r = Results(program, checker, "resonance\nV1 in 0 AC 1\nL1 in x 1m\nR1 x out 10\nC1 out 0 1u\nR2 out 0 100\n"
                ".ac dec 20 100 100k\n.meas ac edge WHEN vdb(out)=-3\n.end\n")
    checker.close(r.of["edge"]["value"], 7402.05, 2.0, "the edge behind a resonance")


def one_point(program, checker):
    """Sweeps of one value have what is there."""
    half = 1 / math.hypot(1, 2 * PI * 0.1)
    for analysis, card, at, signal, wanted in (("ac", ".ac list 100", 100, "mag(v(b))", half),
                                               ("ac", ".ac lin 1 100 100", 100, "mag(v(b))", half),
                                               ("ac", ".ac dec 10 100 100", 100, "mag(v(b))", half),
                                               ("dc", ".dc v1 -5 -5 1", -5, "v(b)", -5),
                                               ("dc", ".dc v1 list -5", -5, "v(b)", -5)):
        kinds = "MAX", "MIN", "AVG", "RMS", "PP", "INTEG", "MAX_AT"
        text = (f"one point: {card}\nV1 a 0 AC 1\nR1 a b 1k\nC1 b 0 1u\n{card}\n"
                + "".join(f".meas {analysis} {kind.lower()} {kind} {signal}\n" for kind in kinds)
                + f".meas {analysis} there FIND {signal} AT={at}\n.meas {analysis} twice PARAM='2*there'\n"
                + f".meas {analysis} beside FIND {signal} AT={at + 1}\n.meas {analysis} out AVG {signal} from={at + 1}\n.end\n")
        r = Results(program, checker, text)
        for name, value in (("max", wanted), ("min", wanted), ("avg", wanted), ("rms", abs(wanted)), ("there", wanted),
                            ("twice", 2 * wanted), ("max_at", at)):
            r.close(name, value)
        for name in ("pp", "integ"):
            r.close(name, 0, scale=1)
        for name in ("beside", "out"):
            checker.check(r.of.get(name, {}).get("value") is None, f"{card}: {name} is {r.of.get(name)}")


def powers(program, checker):
    """w(x) and p(x): a resistor, a coil, a source, a diode and a switch; of a subcircuit's element; in a function, and
    where the netlist has a function of that name."""
    for volts, ohms, henry, f in ((10, 10, 10e-3, 50), (1e-3, 1e6, 1, 1e6), (400, 0.02, 1e-6, 1e4)):
        z = math.hypot(ohms, 2 * PI * f * henry)
        mean = ohms * (volts / z) ** 2 / 2
        r = Results(program, checker, f"""powers at {volts} V
V1 in 0 SIN(0 {volts} {f!r} 0 0 {math.degrees(math.atan2(2 * PI * f * henry, ohms))!r})
R1 in a {ohms!r}
L1 a 0 {henry!r} ic=0
.tran {0.1 / f!r} {4 / f!r} uic
.func twice(x) {{2*x}}
.meas tran pr avg w(r1) from={1 / f!r}
.meas tran pv avg P( v1 ) from={1 / f!r}
.meas tran pl avg p(l1) from={1 / f!r}
.meas tran both avg twice(w(r1)+p(l1)) from={1 / f!r}
.meas tran half EQN='pr/2'
.meas tran top max w(r1) from={1 / f!r}
.meas tran as_product max v(in,a)*i(r1) from={1 / f!r}
.end
""")
        r.close("pr", mean)
        r.close("pv", -mean)
        r.close("pl", 0, scale=mean)
        r.close("both", 2 * mean)
        r.close("half", mean / 2)
        r.close("top", 2 * mean)
        r.close("as_product", r.of["top"]["value"], tolerance=0)
    r = Results(program, checker, """powers of what conducts
V1 p 0 12
I1 0 q PULSE(0 2 0 0 0 1 2)
D1 q p half
.model half D(Vfwd=0.5 Ron=0.25)
S1 p s 0 0 on
.model on SW(Ron=2 Vt=-1)
X1 s load
.subckt load a
R1 a 0 4
.ends
.tran 0.1 4
.meas tran d avg w(d1)
.meas tran s avg w(s1)
.meas tran x avg w(x1.r1)
.end
""")
    r.close("d", 1.0)
    r.close("s", 8.0)
    r.close("x", 16.0)
    r = Results(program, checker, "a function p\nV1 a 0 3\nR1 a 0 1\n.func p(x) {x+1}\n.param r1=5\n.tran 1 2\n"
                ".meas tran m avg p(r1)\n.meas tran w avg w(r1)\n.end\n")
    r.close("m", 6)
    r.close("w", 9)


def windows(program, checker):
    """What lies before the first row and the first measurement is leapt over, if no ledger is kept."""
    duty, tau, period, mean = 0.4, 2e-3, 1e-4, 0.4 * 24 - 5
    on, off = math.exp(-duty * period / tau), math.exp(-(1 - duty) * period / tau)
    most = ((1 - on) * 19 - on * (1 - off) * 5) / (1 - on * off)
    least = off * (most + 5) - 5
    with tempfile.TemporaryDirectory() as folder:
        netlist = pathlib.Path(folder) / "chopper.cir"
        netlist.write_text("""chopper
V1 in 0 24
Vg g 0 PULSE(0 1 0 0 0 40u 100u)
S1 in a g 0 sm
D1 0 a
L1 a b 2m
R1 b c 1
Ve c 0 5
.model sm SW(Vt=0.5)
.tran 10u 1 0.999 uic
.meas tran mean AVG i(l1) from=0.999
.meas tran most MAX i(l1) from=0.9995
.meas tran least FIND i(l1) AT=0.9998
.meas tran on TRIG v(a) VAL=12 RISE=1 TARG v(a) VAL=12 FALL=2
.four 10k i(l1)
.end
""")
        done = subprocess.run([program, "run", netlist, "--tol", "1e-12", "-o",
                               netlist.with_suffix(".csv")], capture_output=True, text=True,
                              check=False)
    checker.check(done.returncode == 0, done.stderr)
    leapt = re.search(r"20000 steps.* (\d+) in whole periods", done.stdout)
    checker.check(leapt is not None and int(leapt.group(1)) > 19000, f"leaps: {done.stdout}")
    found = dict(re.findall(r"^(\w+) += +(\S+)", done.stdout, re.MULTILINE))
    for name, wanted in (("mean", mean), ("most", most), ("least", least), ("on", 40e-6)):
        checker.close(float(found.get(name, "nan")), wanted, 2e-9 * wanted, f"windows: {name}")
    constant = re.search(r"^ 0 +0 +(\S+)", done.stdout, re.MULTILINE)
    checker.close(float(constant.group(1)), mean, 2e-9, "windows: constant of .four")


def degrees(program, checker):
    """LTspice's measurements have angles in degrees, those of others in radians; its sources have radians. The gain of an RC
    filter between two nodes, as LTspice's users measure it."""
    netlist = """degrees
V1 a 0 SIN(0 1 1k)
R1 a b 1k
C1 b 0 {1/(2*pi*1k*1k)}
B1 s 0 V=sin(2*pi*1k*time)
.param Freq=1k
.func turned(x) {cos(x)}
.tran 0 20m 12m
.options dialect=DIALECT
.measure Are avg v(a)*turned(360*time*Freq)
.measure Aim avg -v(a)*sin(360*time*Freq)
.measure Bre avg v(b)*cos(360*time*Freq)
.measure Bim avg -v(b)*sin(360*time*Freq)
.measure gain param 20*log10(hypot(Are,Aim)/hypot(Bre,Bim))
.measure phase param mod(atan2(Aim,Are)-atan2(Bim,Bre)+180,360)-180
.meas sum param sin(30)+cos(60)+tan(45)
.meas back param asin(1)+arccos(0)+atan(1)+arctan(-1)+acos(1)
.meas chosen param if(1>2, sin(90), cos(90)+3)
.meas tran most max v(s)
.end
"""
    r = Results(program, checker, netlist.replace("DIALECT", "ltspice"))
    for name, wanted in (("gain", 10 * math.log10(2)), ("phase", 45), ("sum", 2), ("back", 180), ("chosen", 3), ("most", 1)):
        r.close(name, wanted, tolerance=1e-8)
    r = Results(program, checker, netlist.replace("DIALECT", "ngspice"))
    for name, wanted in (("sum", math.sin(30) + math.cos(60) + math.tan(45)), ("back", PI), ("chosen", math.cos(90) + 3),
                         ("most", 1)):
        r.close(name, wanted, tolerance=1e-8)


def rounding(program, checker):
    """What cancels in a formula leaves noise, which no halving resolves: each stretch has to be let go soon."""
    r = Results(program, checker, """rounding
V1 a 0 SIN(0 1 1k)
R1 a b 1k
C1 b 0 1p
.tran 1u 20m
.meas tran table AVG table(1e-9*v(a),-1,3,0,0,2,0)
.meas tran offset RMS 1e3+1e-9*abs(v(a))-1e3
.meas tran power AVG v(a)*v(a)*1e-9+1e3-1e3
.end
""")
    r.close("table", 3e-9 / PI, tolerance=1e-6)
    r.close("offset", 1e-9 * math.sqrt(0.5), tolerance=1e-4)
    r.close("power", 0.5e-9, tolerance=1e-4)


def thresholds(program, checker):
    """Extremes of formulas with jumps and kinks: a polynomial through a jump, or past a kink that no node sees, goes beyond
    every value."""
    levels = [-8.3 + 0.77 * k for k in range(24)]
    cards = "".join(f".meas tran step{k} max '(v(a)>{x:.4f}?1:0)'\n.meas tran swing{k} pp '(v(b)>{0.3 * x:.5f}?2:1)'\n"
                    f".meas tran least{k} min max(v(b),{0.3 * x:.5f})\n" for k, x in enumerate(levels))
    r = Results(program, checker, "thresholds\nV1 a 0 SIN(1 10 1k)\nR1 a b 1k\nC1 b 0 100n\n.tran 10u 5m\n" + cards
                + ".end\n")
    for k, x in enumerate(levels):
        r.close(f"step{k}", 1.0)
        r.close(f"swing{k}", 1.0)
        r.close(f"least{k}", round(0.3 * x, 5), scale=1.0)


def mistakes(program, checker):
    """A card with a mistake costs its own result alone, and what needs it; all others are what they are without it."""
    wrong = {
        "node": ("avg v(q)", "no element is connected to a node 'q'"),
        "element": ("max i(r9)", "there is no element 'r9'"),
        "kind": ("averge v(a)", "'averge' cannot be measured"),
        "word": ("avg v(a) form=1m", "did not expect 'form' in the expression"),
        "ahead": ("param='later*2'", "there is no parameter and no earlier measurement 'later'"),
        "window": ("avg v(a) from=2m to=1m", "FROM=0.002 does not come before TO=0.001"),
        "place": ("find v(a)", "WHEN or AT= is missing"),
        "target": ("trig v(a)=0 rise=1", "TARG is missing"),
    }
    good = (".meas {0} mean avg v(a)\n", ".meas {0} later max v(a)\n", ".meas {0} twice param='2*later'\n")
    parts = ("mistakes\nV1 a 0 SIN(1 3 1k)\nR1 a 0 1k\n", "mistakes\nV1 a 0 SIN(1 3 1k)\nR1 a b 1\nL1 b 0 1m ic=0\nR2 b 0 7\n")
    for analysis, cards, circuit in (("tran", ".tran 1u 4m\n", parts[0]), ("tran", ".tran 1u 4m\n", parts[1]),
                                     ("pss", ".pss 1m\n", parts[1])):
        lines = [f".meas {analysis} {name} {what}\n" for name, (what, _) in wrong.items()]
        text = circuit + cards + "".join(lines) + "".join(g.format(analysis) for g in good)
        text += f".meas {analysis} needs param='node+mean'\n.end\n"
        r = Results(program, checker, text)
        for name, value in (("mean", 1), ("later", 4), ("twice", 8)):
            r.close(name, value, tolerance=1e-9)
        failures = {name: why for name, (_, why) in wrong.items()}
        for name, why in {**failures, "needs": "it needs 'node', which could not be measured"}.items():
            entry = r.of.get(name, {})
            checker.check(entry.get("value", 0) is None and entry.get("failure", "").startswith(why), f"{name}: {entry}")
        for name, why in failures.items():
            checker.check(re.search(rf"warning: {re.escape(why)}.*: the measurement '{name}' fails\n\.meas", r.run.stderr)
                          and "error" not in r.run.stderr,
                          f"no warning of {name}: {r.run.stderr}")
        with tempfile.TemporaryDirectory() as folder:
            netlist = pathlib.Path(folder) / "mistakes.cir"
            netlist.write_text(text, encoding="utf-8")
            done = subprocess.run([program, "run", netlist, "-o", netlist.with_suffix(".csv")], capture_output=True, text=True,
                                  check=False)
        checker.check(re.findall(r"(?m)^(\w+) +=  failed$", done.stdout) == [*wrong, "needs"], f"shown: {done.stdout}")
    done = dalcs_program.run(program, parts[0] + ".tran 1u 4m\n.func f(x) {(x}\n.meas tran bad avg f(v(a))\n.end\n")
    checker.check(done.status == 3 and "error: this parenthesis is never closed" in done.stderr,
                  f"a mistake in .func: {done.status} {done.stderr}")


def main():
    program = sys.argv[1]
    checker = dalcs_program.Checker("measurements")
    for test in (sines, charging, rectifier, pulses, ledger, euler, others, late, fourier, no_fundamental, decibels,
                 between_frequencies, one_point, powers, windows, degrees, rounding, thresholds, mistakes):
        test(program, checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
