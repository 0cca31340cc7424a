#!/usr/bin/env python3
""".sens: derivatives of measurements of the steady state, against closed forms and against differences of whole runs.

usage: sensitivity.py PROGRAM
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

# Of four runs at distances of h and 2h: the fourth order of h.
H = 2e-3


def run(program, folder, text, options=()):
    (folder / "c.cir").write_text(text)
    (folder / "c.json").unlink(missing_ok=True)
    done = subprocess.run([program, "steady", "c.cir", "-q", "--report", "c.json", "-o", "c.csv", "--tol", "1e-11",
                           *options], cwd=folder, capture_output=True, text=True, check=False)
    report = json.loads((folder / "c.json").read_text()) if (folder / "c.json").exists() else None
    return done, report


def derivatives(report):
    """{(kind, name, harmonic): (value, {parameter: derivative})}"""
    return {(r["kind"], r["name"], r.get("harmonic")): (r["value"], r["derivatives"])
            for r in report["sensitivity"]["results"]}


# ---- Closed forms: (name, netlist, {parameter: value}, {measurement: function of these}) ---------------

def chopper(p):
    """The largest current of L and R that a switch feeds for 4 of 10 us, and a diode else."""
    a = math.exp(-6e-6 * p["r1"] / p["l1"])
    b = math.exp(-4e-6 * p["r1"] / p["l1"])
    return p["vin"] / p["r1"] * (1 - b) / (1 - a * b)


def emptied(p):
    """The mean current into a battery by a coil that runs empty: the diode opens when it does."""
    peak = (p["vin"] - p["vout"]) / p["l1"] * p["ton"]
    falls = peak * p["l1"] / p["vout"]
    return 0.5 * peak * (p["ton"] + falls) / 10e-6


def filtered(p):
    """The amplitude of the fundamental of a square wave behind R and C."""
    return 2 * p["high"] / math.pi / math.hypot(1, 2e5 * math.pi * p["r1"] * p["c1"])


def relaxation(p):
    """The period of a capacitor that is charged and discharged between two thresholds."""
    low, high, v = p["vt"] - p["vh"], p["vt"] + p["vh"], p["vcc"]
    up = p["r1"] * p["c1"] * math.log((v - low) / (v - high))
    r = p["r1"] * p["r2"] / (p["r1"] + p["r2"])
    end = v * p["r2"] / (p["r1"] + p["r2"])
    return up + r * p["c1"] * math.log((high - end) / (low - end))


def rectified(p):
    """The mean of a half-wave rectifier with a battery: the diode closes where the sine passes it."""
    angle = math.asin(p["vb"] / 10)
    return (20 * math.cos(angle) - p["vb"] * (math.pi - 2 * angle)) / (2 * math.pi * p["r1"])


def boost(p):
    """A boost converter in discontinuous conduction into a battery, its efficiency with a resistor at the input: the
    mean input current without it."""
    peak = p["vin"] * 3e-6 / p["l1"]
    return 0.5 * peak * 3e-6 / 10e-6 * p["vout"] / (p["vout"] - p["vin"])


CLOSED = [
    ("chopper", """Chopper
Vin in 0 12
Vg g 0 PULSE(0 1 0 0 0 4u 10u)
S1 in sw g 0 sm
D1 0 sw
L1 sw x 20u
R1 x 0 3
.model sm SW(Ron=0 Vt=0.5)
.pss uic
.sens vin l1 r1
.meas pss y max i(l1)
""", {"vin": 12, "l1": 20e-6, "r1": 3}, ("measurement", "y"), chopper),
    ("emptied", """A coil that runs empty
.param ton=3u
Vin in 0 12
Vg g 0 PULSE(0 1 0 0 0 {ton} 10u)
S1 in sw g 0 sm
D1 0 sw
L1 sw out 10u
Vout out 0 5
.model sm SW(Ron=0 Vt=0.5)
.pss uic
.sens vin l1 vout param ton
.meas pss y avg i(l1)
""", {"vin": 12, "l1": 10e-6, "vout": 5, "ton": 3e-6}, ("measurement", "y"), emptied),
    ("filtered", """A square wave behind a filter
.param high=5
Vin in 0 PULSE(0 {high} 0 0 0 5u 10u)
R1 in out 100
C1 out 0 30n
.pss uic
.four 100k 3 v(out)
.sens r1 c1 param high
""", {"r1": 100, "c1": 30e-9, "high": 5}, ("magnitude", "v(out)", 1), filtered),
    ("relaxation", """A relaxation oscillator
Vcc vcc 0 9
R1 vcc x 10k
C1 x 0 10n
S1 x y x 0 sm
R2 y 0 1k
.model sm SW(Ron=0 Vt=4.5 Vh=1.5)
.pss uic
.sens vcc r1 r2 c1 sm(vt) sm(vh)
""", {"vcc": 9, "r1": 1e4, "r2": 1e3, "c1": 1e-8, "sm(vt)": 4.5, "sm(vh)": 1.5}, ("period", "period"),
     lambda p: relaxation({k.replace("sm(", "").replace(")", ""): v for k, v in p.items()})),
    ("rectified", """A battery charger
Vac in 0 SIN(0 10 50)
D1 in x
R1 x b 2
Vb b 0 4
.pss uic
.sens vb r1
""", {"vb": 4, "r1": 2}, ("average", "i(d1)"), rectified),
    ("boost", """A boost converter into a battery
Vin in 0 5
L1 in sw 5u
Vg g 0 PULSE(0 1 0 0 0 3u 10u)
S1 sw 0 g 0 sm
D1 sw out
Vout out 0 20
.model sm SW(Ron=0 Vt=0.5)
.pss uic
.sens
""", {"vin": 5, "l1": 5e-6, "vout": 20}, ("average", "i(l1)"), boost),
]


def differentiate(function, values, name):
    """By Richardson's extrapolation, to about 1e-10."""
    def at(x):
        return function({**values, name: values[name] * (1 + x)})

    d = [(at(h) - at(-h)) / (2 * h) for h in (1e-2, 5e-3, 2.5e-3)]
    e = [(4 * b - a) / 3 for a, b in zip(d, d[1:])]
    return (16 * e[1] - e[0]) / 15 / values[name]


def check_closed(checker, program, folder):
    for name, text, values, (kind, of, *harmonic), function in dalcs_program.kinds_of(CLOSED):
        done, report = run(program, folder, text)
        if not checker.check(done.returncode == 0, f"{name}: {done.stderr}"):
            continue
        value, found = derivatives(report)[kind, of, harmonic[0] if harmonic else None]
        checker.check(abs(value / function(values) - 1) < 1e-9, f"{name}: {value} for {function(values)}")
        checker.check(report["sensitivity"]["parameters"] == values, f"{name}: {report['sensitivity']['parameters']}")
        for parameter in values:
            own = differentiate(function, values, parameter)
            off = abs(found.get(parameter, math.inf) - own) * values[parameter] / abs(value)
            checker.check(off < 1e-7, f"{name}: d/d {parameter} is {found.get(parameter)}, not {own}")


# ---- Differences of whole runs ---------------------------------------------------------------------

# Each value that is varied is a word of its own in the text.
RUNS = {
    "buck": ("""Buck converter in continuous conduction
Vin in 0 {vin}
Vg g 0 PULSE(0 1 0 0 0 4u 10u)
S1 in sw g 0 sm
D1 0 sw
L1 sw x {l1}
Rl x out 0.05
C1 out 0 20u
R1 out 0 {r1}
.model sm SW(Ron=10m Vt=0.5)
.pss uic
.sens vin l1 r1
.four 100k 3 v(sw)
.meas pss ripple pp i(l1)
.meas pss pin avg -v(in)*i(vin)
.meas pss pout avg v(out)*i(r1)
.meas pss eta param='pout/pin'
.meas pss cross when i(l1)=1.95 rise=1
""", {"vin": 12, "l1": 50e-6, "r1": 2.5}),
    "dcm": ("""Flyback converter in discontinuous conduction
Vin in 0 {vin}
L1 in sw {l1}
L2 0 a 40u
K1 L1 L2 0.995
Vg g 0 PULSE(0 1 0 0 0 3u 20u)
S1 sw 0 g 0 sm
Rs sw c 200
Cs c 0 1n
D1 a out
C1 out 0 47u
R1 out 0 {r1}
.model sm SW(Ron=10m Vt=0.5)
.pss uic
.sens vin l1 r1
.meas pss vmax max v(sw)
.meas pss irms rms i(d1)
""", {"vin": 24, "l1": 40e-6, "r1": 100}),
    "closed": ("""A regulated buck converter
Vin in 0 {vin}
E1 cmp 0 ctl tri 1
S1 in sw cmp 0 sm
D1 0 sw
L1 sw out 47u
C1 out esr {c1}
Resr esr 0 0.1
R1 out 0 2.5
Vref ref 0 5
G1 0 ctl ref out 1m
Rz ctl z {rz}
Cz z 0 82n
Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
.model sm SW(Ron=0 Vt=0)
.pss uic
.sens vin c1 rz
.meas pss ripple pp v(out)
.meas pss duty avg v(sw)
""", {"vin": 12, "c1": 100e-6, "rz": 1300}),
    "llc": ("""A resonant converter
Vs s 0 PULSE(-200 200 0 0 0 4.5u 9u)
C1 s a {c1}
L1 a b {l1}
Lm b 0 200u
L2 c 0 200u
L3 0 d 200u
K1 Lm L2 L3 0.99
D1 c o
D2 d o
C2 o 0 10u
R1 o 0 {r1}
.pss uic
.sens c1 l1 r1
.meas pss imax max i(l1)
.meas pss vo avg v(o)
""", {"c1": 47e-9, "l1": 40e-6, "r1": 60}),
    "six_pulse": ("""A six-pulse rectifier
Va a 0 SIN(0 325 50 0 0 0)
Vb b 0 SIN(0 325 50 0 0 -120)
Vc c 0 SIN(0 325 50 0 0 120)
La a a1 {la}
Lb b b1 2m
Lc c c1 2m
D1 a1 p
D2 b1 p
D3 c1 p
D4 n a1
D5 n b1
D6 n c1
C1 p n {c1}
R1 p n {r1}
Rg n 0 1meg
.pss uic
.sens la c1 r1
.four 50 7 i(la)
.meas pss vdc avg v(p,n)
""", {"la": 2.2e-3, "c1": 500e-6, "r1": 30}),
    "hysteretic": ("""A hysteretic converter
Vin in 0 {vin}
Vref ref 0 5
S1 in sw ref fb mos
D1 0 sw
L1 sw out {l1}
C1 out esr 100u
Resr esr 0 {resr}
R1 out 0 5
Rf out fb 1k
Cf fb 0 1n
.model mos SW(Ron=5m Vt=0 Vh=20m)
.pss uic
.sens vin l1 resr
.meas pss ripple pp v(out)
""", {"vin": 12, "l1": 22e-6, "resr": 0.1}),
    "multiplier": ("""A doubler
Vac in 0 SIN(0 10 1k)
C1 in x {c1}
D1 0 x
D2 x out
C2 out 0 10u
R1 out 0 {r1}
.pss uic
.sens c1 r1
.meas pss ripple pp v(out)
""", {"c1": 10e-6, "r1": 1e3}),
    "peak": ("""Peak current control, the ramp in series
Vin in 0 {vin}
Vclk clk 0 PULSE(0 1 0 1n 1n 50n 10u)
Vramp ramp 0 PULSE(0 1 0 10u 0 0 10u)
S1 in sw ctl 0 sm
D1 0 sw
L1 sw out {l1}
C1 out 0 100u
R1 out 0 2
B1 ctl 0 V={ic}-0.5*v(ramp)-i(L1)+100*v(clk)
.model sm SW(Ron=0 Vt=0 Vh=0.05)
.pss uic
.sens vin l1 param ic
.param ic={ic_value}
.meas pss ripple pp i(l1)
""", {"vin": 12, "l1": 20e-6, "ic": 3.0}),
    "smooth": ("""A product on the orbit
Vin in 0 SIN(0 10 1k)
R1 in x {r1}
C1 x 0 {c1}
B1 x 0 I=1e-4*v(x)*v(x)*v(x)
.pss uic
.sens r1 c1
.four 1k 3 v(x)
""", {"r1": 1e3, "c1": 100e-9}),
    "losses": ("""A boost converter with losses
Vin in 0 {vin}
L1 in x 50u
Rl x sw {rl}
Vg g 0 PULSE(0 1 0 0 0 4u 10u)
S1 sw 0 g 0 sm
D1 sw out dm
C1 out e 22u
Re e 0 {re}
R1 out 0 20
.model sm SW(Ron=20m Vt=0.5)
.model dm D(Vfwd={dm(vfwd)} Ron=15m)
.pss uic
.sens vin rl re dm(vfwd)
.meas pss pin avg -v(in)*i(vin)
.meas pss pout avg v(out)*i(r1)
.meas pss eta param='pout/pin'
""", {"vin": 12, "rl": 0.05, "re": 0.08, "dm(vfwd)": 0.6}),
    "half_wave": ("""A half-wave rectifier behind a source of 2 Ohm
Vac in 0 SIN(0 20 50)
Rs in a {rs}
D1 a out dm
C1 out 0 {c1}
R1 out 0 {r1}
.model dm D(Vfwd=0.7)
.pss uic
.sens rs c1 r1
.four 50 5 i(d1)
.meas pss ripple pp v(out)
.meas pss opens when i(d1)=0.2 rise=1
""", {"rs": 2, "c1": 1e-3, "r1": 200}),
    "conducts": ("""Peak rectifier whose diode conducts at t = 0: its state there, with a smaller amplitude, blocks the diode
V1 in 0 SIN(0 {amp} 1k 0 0 90)
D1 in out
C1 out 0 {c1}
R1 out 0 1k
.param amp={amp_value}
.pss uic
.sens param amp c1
.meas pss v avg v(out)
.meas pss low min v(out)
""", {"amp": 10, "c1": 1e-5}),
    "exchange": ("""A switched capacitor that jumps
Vin in 0 {vin}
Va a 0 PULSE(0 1 0 0 0 4u 10u)
Vb b 0 PULSE(0 1 5u 0 0 4u 10u)
S1 in x a 0 sm
S2 x out b 0 sm
C1 x 0 {c1}
C2 out 0 {c2}
R1 out 0 100
.model sm SW(Ron=1 Vt=0.5)
.pss uic
.sens vin c1 c2
.meas pss ripple pp v(out)
""", {"vin": 5, "c1": 1e-6, "c2": 4.7e-6}),
}


def fill(text, values):
    """{name} and, where the netlist has a parameter of that name, {name_value}."""
    for name, value in values.items():
        target = "{" + name + "_value}"
        text = text.replace(target, repr(value)) if target in text else text.replace("{" + name + "}", repr(value))
    return text


def results(report):
    """What the runs without .sens have, by the same keys."""
    found = {("average", n, None): s["average"] for n, s in report["steady"]["signals"].items()}
    found.update({("rms", n, None): s["rms"] for n, s in report["steady"]["signals"].items()})
    found.update({("measurement", m["name"], None): m["value"] for m in report.get("measurements", [])})
    found["period", "period", None] = report["steady"]["period"]
    for f in report.get("fourier", []):
        found["thd", f["signal"], None] = f["thd"]
        for kind in ("magnitude", "phase"):
            found.update({(kind, f["signal"], k): value for k, value in enumerate(f[kind])})
    return found


def scale_of(found, key, size):
    """What is 0 but for rounding is measured by what it is a part of."""
    kind, name, harmonic = key
    largest = max([v for (k, n, _), (v, _) in found.items() if (k, n) == ("magnitude", name)], default=0)
    if kind == "average":
        return found["rms", name, None][0]
    if kind == "magnitude":
        return largest
    return math.degrees(largest / found["magnitude", name, harmonic][0]) if kind == "phase" else abs(size)


def check_runs(checker, program, folder, name):
    text, values = RUNS[name]
    done, report = run(program, folder, fill(text, values))
    if not checker.check(done.returncode == 0, f"{name}: {done.stderr}"):
        return
    found = derivatives(report)
    plain = "\n".join(line for line in text.splitlines() if not line.startswith(".sens")) + "\n"
    n_compared = 0
    for parameter, value in values.items():
        at = {}
        for k in (-2, -1, 1, 2):
            done, other = run(program, folder, fill(plain, {**values, parameter: value * (1 + k * H)}))
            checker.check(done.returncode == 0, f"{name} {parameter}: {done.stderr}")
            at[k] = results(other)
        for key, (size, by) in found.items():
            near = at[1][key] - at[-1][key], at[2][key] - at[-2][key]
            if key[0] == "phase":
                near = [math.remainder(d, 360) for d in near]
            own = (8 * near[0] - near[1]) / (12 * H)
            got = by.get(parameter, math.nan) * value
            scale = scale_of(found, key, size)
            off = abs(got - own)
            checker.check(off <= 2e-6 * abs(own) + 1e-7 * scale,
                          f"{name}: {key} by {parameter}: {got} for {own}, value {size}")
            n_compared += 1
    checker.check(n_compared >= 3 * len(values), f"{name}: {n_compared} derivatives are no test")


# ---- What is refused, and where there is none ------------------------------------------------------

BUCK = CLOSED[1][1]


def check_words(checker, program, folder):
    for card, words in ((".sens r9", "r9"), (".sens vg", "'vg' is a function of time"),
                        (".sens l1 vin l1", ".sens names 'l1' twice"), (".sens param toff", "no parameter 'toff'"),
                        (".sens sm(roff)", "'sm(roff)' has no value to vary"), (".sens d1", "d1"),
                        (".sens temp", "'temp' has no value to vary")):
        done, _ = run(program, folder, BUCK.replace(".sens vin l1 vout param ton", card))
        said = done.stderr
        checker.check(done.returncode == 3 and words in said and "c.cir:11:" in said, f"{card}: {done.returncode} {said}")
    done, _ = run(program, folder, BUCK + ".step l1 5u 10u 5u\n")
    checker.check(done.returncode == 3 and ".step makes several" in done.stderr, f"step: {done.stderr}")
    text = BUCK.replace(".pss uic", ".tran 1u 1m")
    (folder / "c.cir").write_text(text)
    done = subprocess.run([program, "run", "c.cir"], cwd=folder, capture_output=True, text=True, check=False)
    checker.check(done.returncode == 0 and "there is no .pss: the card is left out" in done.stderr, f"without .pss: {done.stderr}")
    done = subprocess.run([program, "run", "c.cir", "--sensitivity"], cwd=folder, capture_output=True, text=True,
                          check=False)
    checker.check(done.returncode == 2 and "an option of 'dalcs steady'" in done.stderr, f"run: {done.stderr}")


def check_corner_beside(checker, program, folder):
    """The lowest of two dips, of which another value makes the other one the lowest: the corner is beside this one."""
    for beside in (3e-3, 1.7e-3, 1.2e-3, 8e-4, 3e-4, 1.1e-4, 2e-5, -1.5e-3, -2e-4):
        other = 1 + beside
        done, report = run(program, folder, f"""Two dips
.param dip=1
V1 a 0 PULSE(0 {{-dip}} 0 0 0 2u 10u)
V2 b a PULSE(0 {-other!r} 5u 0 0 2u 10u)
R1 b c 1k
C1 c 0 1n
.pss uic
.meas pss low min v(b)
.sens param dip
""")
        by = derivatives(report)["measurement", "low", None][1] if report else {}
        wanted = 0 if beside > 0 else -1
        checker.check(done.returncode == 0 and abs(by.get("dip", math.nan) - wanted) < 1e-6,
                      f"a corner {beside} beside: {by} {done.stderr}")


def check_tied(checker, program, folder):
    """A ladder of equal capacitors: its diodes share their events, and do not where one capacitor differs."""
    text = """Cockcroft and Walton
V1 a 0 SIN(0 100 10k)
C1 a b 100n
C2 b c {c2!r}
C3 0 f 100n
C4 f o 100n
D1 0 b
D2 b f
D3 f c
D4 c o
R1 o 0 1Meg
.pss uic
.meas pss mean avg v(o)
"""
    done, report = run(program, folder, text.format(c2=100e-9) + ".sens c2\n")
    by = derivatives(report)["measurement", "mean", None][1] if report else {}
    mean = [results(run(program, folder, text.format(c2=100e-9 * (1 + d)))[1])["measurement", "mean", None]
            for d in (-1e-3, 1e-3)]
    own = (mean[1] - mean[0]) / 2e-10
    checker.check(done.returncode == 0 and abs(by.get("c2", math.nan) - own) < 1e-4 * own,
                  f"tied: {by} for {own} {done.stderr}")


def check_corner(checker, program, folder):
    """A half-wave rectifier whose battery is just as high as the sine: above, nothing flows."""
    text = CLOSED[4][1].replace("Vb b 0 4", "Vb b 0 10").replace(".sens vb r1", ".sens vb")
    done, report = run(program, folder, text)
    by = derivatives(report)["average", "i(d1)", None][1] if report else {}
    checker.check(done.returncode == 0 and "vb" not in by and "no derivative by 'vb'" in done.stderr,
                  f"corner: {by} {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("sensitivity")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check_closed(checker, program, folder)
        for case in sys.argv[2:] or dalcs_program.kinds_of(RUNS):
            check_runs(checker, program, folder, case)
        check_words(checker, program, folder)
        check_corner(checker, program, folder)
        check_corner_beside(checker, program, folder)
        check_tied(checker, program, folder)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
