#!/usr/bin/env python3
"""What `dalcs steady` refuses, and why it says so; periods, delays and sources that do not repeat.

usage: refusals.py PROGRAM
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

CASES = pathlib.Path(__file__).resolve().parent / "cases"

BUCK = """Vin in 0 12
S1 in sw g 0 sm
D1 0 sw
L1 sw out 50u
C1 out 0 20u
R1 out 0 2
.model sm SW(Ron=0 Vt=0.5)
"""
CLOCK = "Vg g 0 PULSE(0 1 0 0 0 4u 10u)\n"
MEAN = 4.8  # V, D Vin


class Case:
    """One netlist after the other in one folder."""

    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        self.checker = dalcs_program.Checker("refusals")

    def run(self, netlist, *options, verb="steady"):
        (self.folder / "c.cir").write_text(netlist)
        (self.folder / "c.json").unlink(missing_ok=True)
        done = subprocess.run([self.program, verb, "c.cir", "-o", "c.csv", "--report", "c.json",
                               *options], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        path = self.folder / "c.json"
        return done, json.loads(path.read_text()) if path.exists() else {}

    def refuses(self, netlist, status, *words, options=(), verb="steady"):
        done, report = self.run(netlist, *options, verb=verb)
        said = done.stderr
        self.checker.check(done.returncode == status, f"{netlist}: status {done.returncode}, {said}")
        self.checker.check("steady" not in report, f"{netlist}: it has an answer")
        for word in words:
            self.checker.check(word in said, f"{netlist}: nothing of {word!r} in {said!r}")

    def finds(self, netlist, period, *words, options=(), mean=None, near=1e-13):
        done, report = self.run(netlist, *options)
        said = done.stderr + done.stdout
        if not self.checker.check(done.returncode == 0, f"{netlist}: {said}"):
            return None
        found = report["steady"]["period"]
        self.checker.check(abs(found - period) <= near * period, f"{netlist}: period {found!r}")
        for word in words:
            self.checker.check(word in said, f"{netlist}: nothing of {word!r} in {said!r}")
        if mean is not None:
            off = abs(report["steady"]["signals"]["v(out)"]["average"] - mean)
            self.checker.check(off < 1e-9, f"{netlist}: the mean of v(out) is off by {off:.2g}")
        return report


# A resonant converter whose loop sticks: Newton's method comes to that state, not to an orbit.
STICKS = ("Vin in 0 180\nS1 in h q 0 sq\nS2 h 0 qn 0 sq\nEqn qn 0 value={1-v(q)}\nCr h a 39n\n"
          "Lr a p 94u\nLp p 0 470u\nLs s 0 27u\nLt 0 t 27u\nK1 Lp Ls Lt 1\nD1 s out dd\nD2 t out dd\n"
          "C1 out 0 330u IC=12.5\nR1 out 0 1.08\nBq 0 tr I={(1-2*v(q))*v(ctl)*0.1m}\n"
          "Ct tr 0 1.2n IC=0.1\nRt tr 0 100meg\nVone one 0 1\nSq one q tr 0 sch\nRq q 0 1k\n"
          "G1 0 ctl out ref 80u\nRz ctl z 3k\nCz z 0 1.2u IC=1.5\nRo ctl 0 1meg\nVref ref 0 12.5\n"
          ".model sq SW(Ron=0.5 Vt=0.5 Roff=10meg)\n.model sch SW(Ron=1u Vt=0.5 Vh=0.5 Roff=1g)\n"
          ".model dd D(Ron=1m)\n.pss uic\n")


def refused(case):
    case.refuses((CASES / "two_clocks.cir").read_text(), 2, "'v1' (10 us)", "'v2' (31.8",
                 "no common period")
    case.refuses((CASES / "drift.cir").read_text(), 1, "no periodic steady state",
                 "v(c1) falls by 3.33333 mV", "v(c2) rises by 3.33333 mV")
    case.refuses("* rests\nV1 a 0 10\nR1 a b 1k\nC1 b 0 1u\n.pss\n", 1, "no oscillation",
                 "comes to rest", "v(c1) = 10 V")
    case.refuses("* dies away\nV1 a 0 10\nL1 a b 1m\nR1 b c 1\nC1 c 0 1u\n.pss 200u uic\n", 1,
                 "comes to rest", "v(c1) = 10 V")
    case.refuses("* sticks\n" + STICKS, 1, "comes to rest", "v(cz) = -1 kV")
    case.refuses("* rings\nC1 x 0 1u IC=1\nL1 x 0 1m\n.pss uic\n", 1, "nothing switches")
    # energies that have died away below the least number, and a circuit of seconds, which is nudged before it rests again
    case.refuses("* rings for a while\nC1 a 0 1m IC=4000\nL1 a b 1000\nR1 b 0 200\n.pss osc uic\n", 1, "comes to rest")
    case.refuses("* in picoseconds\nC1 a 0 21p IC=1\nL1 a b 47n\nR1 b 0 9.4\n.pss osc uic\n", 1, "comes to rest")
    case.refuses("* loses it all\nC1 a 0 1u IC=5\nR1 a 0 1k\n.pss osc uic\n", 1, "comes to rest")
    case.refuses("* in seconds\nV1 in 0 10\nR1 in a 1.2k\nL1 a b 26\nC1 b 0 2.2u\nR2 b 0 34k\n.pss osc uic\n", 1, "comes to rest")
    case.refuses("* no end\nI1 0 x 1m\nC1 x 0 1u\n.pss uic\n", 1, "nothing switches")
    case.refuses("* no memory\nV1 a 0 10\nR1 a 0 1k\n.pss\n", 2, "has a memory")
    case.refuses("* a clock\n" + CLOCK + BUCK + ".pss 10u osc uic\n", 2, "leave osc out")
    case.refuses("* half of one\n" + CLOCK + BUCK + ".pss periods=1.5 uic\n", 3, "whole number")
    case.refuses("* 100001 of the faster\nV1 a 0 SIN(0 1 1k)\nV2 b 0 SIN(0 1 1000.01)\nR1 a c 1k\n"
                 "R2 b c 1k\nC1 c 0 1u\n.pss uic\n", 2, "no common period of less than 100000")
    case.refuses("* no multiple\n" + CLOCK + BUCK + ".pss 15u uic\n", 2,
                 "15 us is no multiple of that of 'vg', which is 10 us")
    case.refuses("* a frequency\n" + CLOCK + BUCK + ".pss 100k uic\n", 2,
                 "100 ks is more than 100000 times that of 'vg'", "100 kHz has a period of 10 us")
    case.refuses("* as for ngspice\n" + CLOCK + BUCK + ".pss 100k 1m out 1024 10 50 5e-3 uic\n", 3,
                 "begins with a frequency", ".pss osc")
    case.finds("* its own frequency\nVg g 0 PULSE(0 1 0 0 0 8m 20m)\n" + BUCK + ".pss 50 uic\n", 50.0,
               "50 Hz has a period of 20 ms", options=("--fill", "none"))
    case.refuses("* no multiple\n" + CLOCK + BUCK + ".pss uic\n", 2, "no multiple of that of 'vg'",
                 options=("--period", "5u"))
    case.refuses("* euler\n" + CLOCK + BUCK + ".options method=euler\n.pss uic\n", 2,
                 "error is controlled")
    case.refuses("* fixed\n" + CLOCK + BUCK + ".pss uic\n", 2, "error is controlled",
                 options=("--method", "radau", "--step", "10n"))
    case.refuses("* a word\n" + CLOCK + BUCK + ".pss 10u sometimes\n", 3, "sometimes")
    case.refuses("* ngspice's\n" + CLOCK + BUCK + ".pss 100k 1m out 128 8 50\n", 3, ".pss [period")
    case.refuses("* a second\n" + CLOCK + BUCK + ".pss\n.pss\n", 3, "a second .pss")
    # i1 fills c1 by 1 mA * 10 us / 1 uF each period, and nothing empties it
    case.refuses("* fills\nV1 a 0 PULSE(0 1 0 0 0 4u 10u)\nR1 a b 1k\nC2 b 0 1n\nI1 0 c 1m\nC1 c 0 1u\n"
                 "Rb b 0 1k\n.pss uic\n", 1, "v(c1) rises by 10 mV")


def across_a_coil(case):
    """Switches that put a source across a coil leave no operating point: a current takes its time to grow. From rest there is
    an orbit, and a note says so. Where no switch is in the loop the current grows without end."""
    clock = "Vg g 0 PULSE(1 0 2u 0 0 5u 10u)\nVone one 0 1\nEn n 0 one g 1\n.model sm SW(Ron=0 Vt=0.5)\n"
    for name, body, begins in (
            ("a winding", "V1 p 0 100\nS1 p a g 0 sm\nL1 a b 1m\nS2 b 0 g 0 sm\nD1 0 a\nD2 b p\n", True),
            ("a bridge", "V1 p 0 400\nS1 p a g 0 sm\nS2 a 0 n 0 sm\nS3 p b n 0 sm\nS4 b 0 g 0 sm\nL1 a b 2m\nL2 c d 8m\n"
             "K1 L1 L2 0.99\nR1 c d 50\nR2 c 0 1k\n", True),
            ("a boost converter", "V1 p 0 5\nL1 p a 10u\nS1 a 0 g 0 sm\nD1 a out\nC1 out 0 10u\nR1 out 0 20\n", True),
            ("no switch", "V1 p 0 5\nL1 p 0 10u\nS1 p a g 0 sm\nR1 a 0 1\n", False)):
        if begins:
            starts = [case.run(f"* {name}\n{body}{clock}{card}\n") for card in (".pss", ".pss uic")]
            for done, _ in starts:
                case.checker.check(done.returncode == 0, f"{name}: {done.stderr}")
            case.checker.check("this one was found from IC= and 0" in starts[0][0].stderr, f"{name}: {starts[0][0].stderr}")
            case.checker.check(starts[0][1]["steady"]["states"] == starts[1][1]["steady"]["states"], f"{name}: another orbit")
        else:
            case.refuses(f"* {name}\n{body}{clock}.pss\n", 1, "at the operating point no solution exists: v1")


def integral(of, to, store="1n"):
    return f"G{to} 0 {to} {of} 0 1u\nC{to} {to} 0 {store}\n"


RECTIFIER = "V1 s 0 SIN(0 20 50)\nD1 s a\nC1 a 0 1m\nR1 a 0 50\n"
SAMPLE = "A1 out 0 g 0 0 0 h 0 SAMPLEHOLD\n"
ACCUMULATOR = "A1 nx 0 g 0 0 0 acc 0 SAMPLEHOLD\nB1 nx 0 V=v(acc)+0.01*{}\n"

SAW = "Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)\n.model sz SW(Ron=10m Vt=0)\n"


def out_of_reach(fb, ref, most=0.95):
    """A PI control at its limit, whose output never comes to the reference."""
    return (f"Vref ref 0 {ref}\nG1 0 ctl ref {fb} 1m\nRz ctl z 1k\nCz z 0 100n\nBl lim 0 V=limit(v(ctl),0.02,{most})\n"
            "E2 cmp 0 lim tri 1\n")


# name, netlist, what rises by how much each period without end: what it integrates decides that, and not it alone. Those
# of a control out of reach are what runs of up to 60000 periods rise by in the last one; other states take thousands.
DRIFTS = [
    ("out of reach, a snubber", SAW + "Vin in 0 48\nL1 in sw 200u\nL2 0 s 20u\nK1 L1 L2 0.98\nS1 sw 0 cmp 0 sz\nDc sw c\nCc c in 1u\n"
     "Rc c in 47k\nD1 s out\nC1 out 0 1m\nR1 out 0 5\n" + out_of_reach("out", 100, 0.5), "v(cz) rises by 8.57522 V"),
    ("out of reach, flux of a transformer", SAW + "Vin in 0 48\nL1 in sw 2m\nL2 s 0 0.5m\nL3 0 r 2m\nK1 L1 L2 L3 0.9999\n"
     "S1 sw 0 cmp 0 sz\nDc sw cl\nRc cl in 10k\nCc cl in 1n\nD3 r in\nD1 s f\nD2 0 f\nLo f out 40u\nC1 out 0 100u\nR1 out 0 2\n" +
     out_of_reach("out", 30, 0.45), "v(cz) rises by 1.92683 V"),
    ("out of reach, behind an LLC converter", SAW + "Vin d 0 100\nVg g 0 PULSE(1 -1 0 0 0 5u 10u)\nE9 gn 0 0 g 1\nS1 d sw g 0 sz\n"
     "S2 sw 0 gn 0 sz\nLr sw r 20u\nCr r p 126n\nLm p 0 100u\nLs s1 0 4u\nLt 0 s2 4u\nK1 Lm Ls Lt 0.999\nD1 s1 f\nD2 s2 f\n"
     "Rq s1 s2 1k\nCf f 0 47u\nS5 f out cmp 0 sz\nL5 out o2 10u\nD5 0 out\nC5 o2 0 100u\nR5 o2 0 2\n" +
     out_of_reach("o2", 30), "v(cz) rises by 2.05427 V"),
    ("integral of a converter's output", CLOCK + BUCK + integral("out", "i"), "v(ci) rises by 48 mV"),
    ("of a sample of it", CLOCK + BUCK + SAMPLE + integral("h", "i"), "v(ci) rises by 47.9447 mV"),
    ("of the one before", CLOCK + BUCK + SAMPLE + "A2 h 0 g 0 0 0 h2 0 SAMPLEHOLD\n" + integral("h2", "i"),
     "v(ci) rises by 47.9447 mV"),
    ("samples that add up", CLOCK + BUCK + ACCUMULATOR.format("(v(out)-4)"), "sample(a1) rises by 7.94472 mV"),
    ("a coil across the output", CLOCK + BUCK + "E1 m 0 out 0 1\nL9 m 0 1\n", "i(l9) rises by 48 uA"),
    ("a rectifier", RECTIFIER + integral("a", "i", "1u"), "v(ci) rises by 340.924 mV"),
    ("two of one converter", CLOCK + BUCK + integral("out", "i") + integral("sw", "j", "2n"), "v(ci) rises by 48 mV"),
]

# One that drifts drives another one: a Jordan block of M. Nothing goes on alike, and at 1e15 V all would seem to repeat.
DRIVEN = [
    ("two", CLOCK + BUCK + integral("out", "i") + integral("i", "j")),
    ("three", CLOCK + BUCK + integral("out", "i") + integral("i", "j") + integral("j", "k")),
    ("of a rectifier", RECTIFIER + integral("a", "i", "1u") + integral("i", "j", "1u")),
    ("slow ones", RECTIFIER + integral("a", "i", "1m") + integral("i", "j", "1m")),
    ("behind a filter", RECTIFIER + "R2 a f 1k\nC2 f 0 10u\n" + integral("f", "i", "1u") + integral("i", "j", "100u")),
    ("of unlike sizes", CLOCK + BUCK + integral("out", "i", "1u") + integral("i", "j", "1p")),
    ("a coil", CLOCK + BUCK + integral("out", "i") + "E1 m 0 i 0 1\nL9 m 0 1\n"),
    ("samples", CLOCK + BUCK + ACCUMULATOR.format("v(out)") + "A2 ny 0 g 0 0 0 b 0 SAMPLEHOLD\nB2 ny 0 V=v(b)+0.01*v(acc)\n"),
    ("beside a charge that is conserved", CLOCK + BUCK + integral("out", "i") + integral("i", "j") + "C7 out p 1u\nC6 p 0 2u\n"),
    # what the first one keeps from the start, -50 mV/A times i(l1), has no mean of 0
    ("the first one is conserved", CLOCK + BUCK + "Vr r 0 4.8\nE1 q 0 out r 1\n" + integral("q", "i") + integral("i", "j")),
]


def integrals(case):
    for name, netlist, rises in DRIFTS:
        case.refuses(f"* {name}\n{netlist}.pss uic\n", 1, "there is no periodic steady state from this start: without end", rises)
    for name, netlist in DRIVEN:
        case.refuses(f"* {name}\n{netlist}.pss uic\n", 1, "no periodic steady state was found", "in the last one")
    done, report = case.run("* controlled\n" + CLOCK + BUCK + "Vr r 0 1\nB1 u 0 V=v(r)-v(j)-0.5*v(i)+0*v(out)\n" +
                            integral("u", "i") + integral("i", "j") + ".pss uic\n")
    case.checker.check(done.returncode == 0 and abs(report["steady"]["states"]["cj"] - 1) < 1e-9, f"controlled: {done.stderr}")
    case.refuses("* a counter\n" + CLOCK + BUCK + "A1 g 0 0 0 0 0 q 0 COUNTER cycles=5000 duty=0.5\nR9 q out 100\n.pss uic\n", 1,
                 "not what gates and switches remember")


def of_time(case):
    """Formulas of time that come to no end, and such as do."""
    for formula in ("0.1*time", "time*time*1k", "0.1*sin(time*1k*time)", "0.1*sqrt(time)", "v(out)*time", "pwl(time,0,0,1m,0.1)"):
        case.refuses(f"* rises\n{CLOCK}{BUCK}B2 out 0 I={formula}\n.pss uic\n", 2, "b2", "follows time without end")
    for formula in ("table(time,0,0,1m,0.1)", "0.1*min(time*10k,1)", "limit(time*100,0,0.1)", "0.1*exp(-1k*time)"):
        case.finds(f"* ends\n{CLOCK}{BUCK}B2 out 0 I={formula}\n.pss uic\n", 10e-6, "value in the end", mean=MEAN)


def periods(case):
    case.finds("* plain\n" + CLOCK + BUCK + ".pss\n", 10e-6, "stable", mean=MEAN)
    case.finds("* .tran alone\n" + CLOCK + BUCK + ".tran 1u 1m uic\n", 10e-6, mean=MEAN)
    case.finds("* nothing\n" + CLOCK + BUCK, 10e-6, mean=MEAN)
    case.finds("* .op alone\n" + CLOCK + BUCK + ".op\n", 10e-6, "audited", mean=MEAN)
    case.finds("* delayed\nVg g 0 PULSE(0 1 33u 0 0 4u 10u)\n" + BUCK + ".pss uic\n", 10e-6,
               mean=MEAN)
    case.finds("* PWL\nVg g 0 PWL(0 1 4u 1 4u 0 10u 0) R=0\n" + BUCK + ".pss uic\n", 10e-6,
               mean=MEAN)
    case.finds("* PWL later\nVg g 0 PWL(0 0 3u 0 3u 1 7u 1 7u 0 13u 0) R=3u\n" + BUCK +
               ".pss uic\n", 10e-6, mean=MEAN)
    case.finds("* twice\n" + CLOCK + BUCK + ".pss 20u uic\n", 20e-6, mean=MEAN)
    case.finds("* 3 : 10\n" + CLOCK + BUCK + "Il out 0 SIN(0 0.1 30k)\n.pss uic\n", 100e-6)
    case.finds("* 15 digits\n" + CLOCK + BUCK + "Il out 0 SIN(0 0.1 33.3333333333333k)\n"
               ".pss uic\n", 30e-6)
    case.finds("* AM\n" + CLOCK + BUCK + "Il out 0 AM(0.1 0.5 1k 20k)\n.pss uic\n", 1e-3)
    case.finds("* once\n" + CLOCK + BUCK + "Il out 0 PWL(0 0 100u 0 100u 1)\n.pss uic\n", 10e-6,
               "'il' does not repeat", mean=MEAN)
    # the command is what a formula makes of a source
    formula = "Bg g 0 V=v(p) > 0.5 ? 1 : 0\n" + BUCK + ".pss uic\n"
    case.finds("* of a delayed one\nVp p 0 PULSE(0 1 33u 0 0 4u 10u)\n" + formula, 10e-6, mean=MEAN)
    case.finds("* of two\nVp p q PULSE(0 1 7u 0 0 4u 10u)\nVq q 0 SIN(0 0.1 50k 8u)\n" + formula, 20e-6, mean=MEAN)
    case.finds("* and of one that comes to something\n" + CLOCK + BUCK + "Vl l 0 PWL(0 0 100u 0 100u 1)\n"
               "Bl out 0 I=v(l) > 0.5 ? 0.1 : 0\n.pss uic\n", 10e-6, "formula of 'bl' does not repeat",
               "with its value in the end, 1", mean=MEAN)
    done, report = case.run("* quiet\nV1 a 0 PULSE(0 1 0 0 0 4u 10u)\nR1 a 0 1k\n.pss\n")
    case.checker.check(done.returncode == 0 and report["steady"]["multipliers"] == [],
                       f"without states: {done.stderr}")


def own_period(case):
    """A circuit without a clock: however it is asked for, its reference, and small signals around it."""
    netlist = (CASES / "buck_hyst.cir").read_text()
    for asked in (".pss uic", ".pss auto uic", ".pss 7u osc uic", ".pss period=auto osc uic",
                  ".pss 1m uic", ".pss 1p uic"):
        done, report = case.run(netlist.replace(".pss uic", asked))
        if not case.checker.check(done.returncode == 0, f"{asked}: {done.stderr}"):
            continue
        found = report["steady"]
        off = abs(found["period"] / 7.2489946675430275e-06 - 1)
        case.checker.check(off < 1e-9, f"{asked}: the period is off by {off:.2g}")
        for got, due in zip(found["multipliers"], (0.45289384359, 0.00149824935)):
            case.checker.check(abs(got["re"] - due) < 1e-7, f"{asked}: multiplier {got}")
        mean = found["signals"]["v(out)"]["average"]
        case.checker.check(abs(mean - 5.004077806596458) < 1e-9, f"{asked}: mean {mean!r}")
    # van der Pol's equation, mu = 1: the multiplier is the exponential of an integral along the orbit
    report = case.finds("* van der Pol\nC1 x 0 1 IC=0.1\nL1 x 0 1\n"
                        "B1 x 0 I=v(x)*v(x)*v(x)/3-v(x)\n.pss uic\n", 6.6632868593231, near=1e-9)
    case.checker.check(abs(report["steady"]["multipliers"][0]["re"] - 8.59695e-4) < 1e-8,
                       "van der Pol's multiplier")
    done, _ = case.run(netlist.replace(".pss uic", ".pss uic\n.ac list 13795.016355542994"),
                       verb="run")
    if case.checker.check(done.returncode == 0, f".ac: {done.stderr}"):
        with open(case.folder / "c.csv", encoding="ascii") as file:
            row = next(csv.DictReader(file))
        got = complex(float(row["re(v(out))"]), float(row["im(v(out))"]))
        off = abs(got - (1.0426449844619279 + 0.05653497720781723j))
        case.checker.check(off < 1e-9, f".ac is off by {off:.2g}")
    done, report = case.run(netlist.replace(".pss uic", ".tran 1u 72.489946675430275u uic=steady"),
                            verb="run")
    if case.checker.check(done.returncode == 0, f"uic=steady: {done.stderr}"):
        off = max(abs(report["final"][k] - report["start"][k]) for k in ("c1", "cf", "l1"))
        case.checker.check(off < 1e-8, f"after ten periods it is off by {off:.2g}")


def one_period(case):
    """The waveforms: from 0 to T, as those of a .tran from there."""
    report = case.finds("* rows\n" + CLOCK + BUCK + ".pss uic\n", 10e-6)
    with open(case.folder / "c.csv", encoding="ascii") as file:
        rows = list(csv.DictReader(file))
    times = [float(row["time"]) for row in rows]
    case.checker.check(times[0] == 0.0 and abs(times[-1] - 10e-6) < 1e-20, "rows of one period")
    off = abs(float(rows[0]["v(out)"]) - float(rows[-1]["v(out)"]))
    case.checker.check(off < 1e-12, f"v(out) comes back but for {off:.2g}")
    case.checker.check(report["steady"]["exact"] is True, "the derivative is exact")


def leaving(case):
    """.tran uic=steady: nothing moves from period to period until a load is stepped."""
    netlist = ("* leave\n" + CLOCK + BUCK + "Il out 0 PWL(0 0 100u 0 100u 1)\n"
               ".meas tran before avg v(out) from=0 to=100u\n"
               ".meas tran after min v(out) from=100u to=300u\n.tran 1u 300u uic=steady\n")
    done, report = case.run(netlist, verb="run")
    if not case.checker.check(done.returncode == 0, f"uic=steady: {done.stderr}"):
        return
    value = {m["name"]: m["value"] for m in report["measurements"]}
    case.checker.check(abs(value["before"] - MEAN) < 1e-9, f"before the step {value['before']}")
    case.checker.check(value["after"] < 4.5, f"after the step {value['after']}")
    case.checker.check("ltspice" not in done.stderr.lower(), "it is nobody's dialect")
    case.refuses("* its load\n" + CLOCK + BUCK + "Vl l 0 PWL(0 0 100u 0 100u 1)\nBl out 0 I=v(l) > 0.5 ? 1 : 0\n"
                 ".tran 1u 300u uic=steady\n", 2, "'bl' is a formula of a source that does not repeat", verb="run")
    done, report = case.run("* both\n" + CLOCK + BUCK + ".pss uic\n.tran 1u 100u uic\n", verb="run")
    case.checker.check(done.returncode == 0 and "steady" in report and report["stop"] == 100e-6,
                       f".pss and .tran: {done.stderr}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        case = Case(pathlib.Path(sys.argv[1]).resolve(), folder)
        refused(case)
        across_a_coil(case)
        integrals(case)
        of_time(case)
        periods(case)
        own_period(case)
        one_period(case)
        leaving(case)
    return case.checker.finish()


if __name__ == "__main__":
    sys.exit(main())
