#!/usr/bin/env python3
"""Slow starts by .env against runs of all periods: within the tolerance, and far fewer periods.

usage: envelope.py PROGRAM
"""

import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
import kinds  # pylint: disable=import-error

BUCK = """Vin in 0 12
E1 cmp 0 ctl tri 1
S1 in sw cmp 0 sm
D1 0 sw
L1 sw out 47u
C1 out esr 100u
Resr esr 0 0.1
R1 out 0 2.5
G1 0 ctl ref out 1m
Rz ctl z 1.3k
Cz z 0 82n
Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
.model sm SW(Ron=0 Vt=0)
"""
THERMAL = """Vin in 0 12
Vg g 0 PULSE(0 1 0 0 0 4u 10u)
S1 in sw g 0 sm
D1 0 sw
L1 sw out 50u
C1 out 0 20u
R1 out 0 2
.model sm SW(Ron=50m Vt=0.5)
Bp 0 j I=5*abs(v(in,sw))
Ct1 j 0 1m
Rt1 j k 1
Ct2 k 0 50m
Rt2 k l 2
Ct3 l 0 500m
Rt3 l 0 3
"""
BOOST = """Vin in 0 12
Vg g 0 PULSE(0 1 0 0 0 4u 10u)
L1 in sw 50u
S1 sw 0 g 0 sm
D1 sw out
C1 out 0 10m
R1 out 0 100
.model sm SW(Ron=10m Vt=0.5)
"""
LATCH = """Vin in 0 12
Vclk clk 0 PULSE(0 1 0 0 0 100n 10u)
S1 in sw q 0 sm
D1 0 sw
L1 sw x 22u
Rs x out 10m
C1 out 0 5m
R1 out 0 2
Vramp ramp 0 PULSE(0 0.4 0 10u 0 0 10u)
B1 lim 0 V=v(ref)-v(ramp)-0.3*i(L1)
A1 lim 0 0 0 0 over 0 0 SCHMITT Vt=0 Vh=0
A2 clk over 0 0 0 0 q 0 SRFLOP Td=50n
.model sm SW(Ron=10m Vt=0.5)
"""
HOLD = BUCK.replace("E1 cmp 0 ctl tri 1", "Vclk clk 0 PULSE(0 1 0 0 0 1u 10u)\nA1 ctl 0 clk 0 0 0 held 0 SAMPLEHOLD\n"
                    "A2 clk 0 0 0 0 0 third 0 COUNTER cycles=3\nR9 third 0 1k\nE1 cmp 0 held tri 1")
# at 16 periods G does not go on along a line, and what M changes by hides that from F at the end of a leap over 2 periods
CONSTANT_POWER = """Vin in 0 24
Vg g 0 PULSE(0 1 0 0 0 5u 10u)
S1 in sw g 0 sm
D1 0 sw
L1 sw out 47u
C1 out 0 100u
R1 out 0 5
B1 out 0 I=4/max(v(out),3)
.model sm SW(Ron=10m Vt=0.5)
"""
RECTIFIER = "V1 a 0 SIN(0 17 50)\nR1 a b 1\nD1 b out\nC1 out 0 1\nR2 out 0 100\n"


def circuits():
    """(name, netlist, period, how many, periods of the full run for each that is run at least)."""
    yield "boost, slow output", BOOST, 1e-5, 100000, 430
    yield "rectifier, 1 F", RECTIFIER, 0.02, 5000, 13
    yield "soft start", BUCK + "Vref ref 0 PWL(0 0 50m 5)\n", 1e-5, 10000, 10
    yield "thermal ladder", THERMAL, 1e-5, 100000, 1500
    yield "delayed clock", BOOST.replace("PULSE(0 1 0 ", "PULSE(0 1 33u "), 1e-5, 20000, 20
    yield "latch, a pulse", LATCH + "Vref ref 0 PULSE(0.3 0.7 1m 2m 0 1 10)\n", 1e-5, 6000, 3
    yield "latch, EXP", LATCH + "Vref ref 0 EXP(0.2 0.7 0 0.2m)\n", 1e-5, 6000, 3
    yield "boost, two pulses", BOOST.replace("10m", "1m", 1) + "Iload out 0 PULSE(0 0.1 20m 0 0 30m 60m 2)\n", 1e-5, 15000, 3
    yield "boost, a sine that dies away", BOOST.replace("10m", "1m", 1) + "Iload out 0 SIN(0 0.1 500 0 10k)\n", 1e-5, 6000, 2
    yield "hold, a third of its clock", HOLD + "Vref ref 0 PWL(0 0 50m 5)\n", 3e-5, 3000, 3
    yield "constant power", CONSTANT_POWER, 1e-5, 1500, 3
    load = "Iload out 0 PWL(0 0 50m 0 50m 0.1 80m 0.1 90m 0.02)\n"
    yield "corners", BOOST.replace("10m", "1m", 1) + load, 1e-5, 15000, 3
    for kind in ("buck_ccm", "buck_dcm", "boost_dcm", "slow_rectifier", "six_pulse", "coupled", "llc", "multiplier",
                 "hard_edges"):
        name, body = list(kinds.KINDS[kind]())[3]
        yield name, body, None, 300, 0


class Case:
    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        self.checker = dalcs_program.Checker("envelope")

    def run(self, netlist, *options):
        (self.folder / "c.cir").write_text(netlist)
        return subprocess.run([self.program, "run", "c.cir", "-q", "-o", "c.csv", "--report", "c.json", *options],
                              cwd=self.folder, capture_output=True, text=True, check=False)

    def rows(self):
        with open(self.folder / "c.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def report(self):
        return json.loads((self.folder / "c.json").read_text())

    def period_of(self, netlist):
        self.run(f"* period\n{netlist}.pss uic\n")
        return self.report()["steady"]["period"]

    def look_at(self, name, netlist, period, n, ratio, tolerance):
        period = period or self.period_of(netlist)
        stop = n * period
        head = f"* {name}\n{netlist}"
        done = self.run(f"{head}.env {stop!r} uic tol={tolerance}\n")
        if not self.checker.check(done.returncode == 0, f"{name}: {done.stderr}"):
            return
        rows, envelope = self.rows(), self.report()["envelope"]
        times = [float(row["time"]) for row in rows]
        self.checker.check(times == sorted(times) and abs(times[-1] - stop) <= 1e-9 * stop, f"{name}: times {times[-3:]}")
        self.checker.check(envelope["periods"] == n, f"{name}: {envelope}")
        self.checker.check(envelope["run"] * ratio <= n, f"{name}: {envelope['run']} periods of {n} were run")
        self.checker.check(envelope["worst"] <= tolerance and envelope["allowed"] == tolerance, f"{name}: {envelope}")
        # at beginnings of periods, but for those where a source jumps just then
        first = {}
        for row, time in zip(rows, times):
            if abs(time / period - round(time / period)) < 1e-7 and time < stop:
                first.setdefault(round(time / period), row)
        (self.folder / "at.txt").write_text("".join(f"{k * period!r}\n" for k in sorted(first)))
        states = [s for s in rows[0] if re.match(r"v\((out|j|k|l|ctl|z|esr|cl)\)|i\(l", s)]
        done = self.run(f"{head}.tran {period!r} {stop!r} uic\n", "--at", "at.txt", "--tol", "1e-10")
        self.checker.check(done.returncode == 0, f"{name}: {done.stderr}")
        full = {round(float(row["time"]) / period): row for row in self.rows()}
        for signal in states:
            scale = max(abs(float(row[s])) for row in full.values() for s in states if s[0] == signal[0])
            for k, row in first.items():
                if not self.checker.check(abs(float(row[signal]) - float(full[k][signal])) <= tolerance * scale,
                                          f"{name}, tol {tolerance}: {signal} = {row[signal]} at period {k}, "
                                          f"not {full[k][signal]}; scale {scale}"):
                    break

    def refuses(self, netlist, status, *words):
        done = self.run(netlist)
        self.checker.check(done.returncode == status, f"{netlist}: status {done.returncode}, {done.stderr}")
        for word in words:
            self.checker.check(word in done.stderr, f"{netlist}: nothing of {word!r} in {done.stderr!r}")


def written(case):
    """Periods that are asked for have all their rows, those of a .tran."""
    done = case.run(f"* at\n{BOOST}.env 0.1 uic at=1.234m,50m\n")
    case.checker.check(done.returncode == 0, done.stderr)
    times = [float(row["time"]) for row in case.rows()]
    for at in (1.23e-3, 50e-3):
        n = sum(1 for time in times if at - 1e-9 <= time < at + 1e-5 - 1e-9)
        case.checker.check(n >= 100, f"{n} rows from {at}")


def beside(case):
    """An orbit beside it has its losses; each step of .step is a run of its own."""
    done = case.run(f"* beside\n{BOOST}.env 0.01 uic\n.pss uic\n.losses\n.step r1 list 50 100\n")
    case.checker.check(done.returncode == 0, done.stderr)
    losses = case.report().get("losses", [])
    case.checker.check([loss["analysis"] for loss in losses] == ["pss", "pss"], f"losses: {losses}")
    starts = [float(row["time"]) for row in case.rows()].count(0.0)
    case.checker.check(starts >= 2, f"{starts} runs")


def verb(case):
    """`dalcs envelope` runs the .env of a netlist, or its .tran, or for as long as it is told; .meas and others are left out."""
    check = case.checker.check

    def envelope(netlist, *options):
        (case.folder / "v.cir").write_text(netlist)
        (case.folder / "v.json").unlink(missing_ok=True)
        done = subprocess.run([case.program, "envelope", "v.cir", "-o", "v.csv", "--report", "v.json", *options],
                              cwd=case.folder, capture_output=True, text=True, check=False)
        rows = (case.folder / "v.csv").read_text() if done.returncode == 0 else ""
        path = case.folder / "v.json"
        return done, rows, json.loads(path.read_text()) if path.exists() else {}

    done, of_card, report = envelope(f"* v\n{BOOST}.env 0.3 uic at=0.1\n.pss uic\n.meas pss x avg v(out)\n")
    check(done.returncode == 0 and "envelope  30000 periods of 10 us" in done.stdout, f"card: {done.stdout} {done.stderr}")
    check(list(report) and "steady" not in report and report["envelope"]["periods"] == 30000, f"card: {report.keys()}")
    final = re.search(r"signal +final\n(?:.*\n)*?  v\(out\) +(\S+)  V\n", done.stdout)
    last = of_card.splitlines()[-1].split(",")[of_card.splitlines()[0].split(",").index("v(out)")]
    check(final and abs(float(final[1]) / float(last) - 1) < 1e-3, f"final: {done.stdout}")
    tran = f"* v\n{BOOST}.tran 1u 0.3 0.2 uic\n.meas tran m max v(out)\n.four 100k v(out)\n"
    done, of_tran, _ = envelope(tran, "--show", "0.1")
    check(of_tran == of_card and "note: .meas: left out" in done.stderr, f".tran: {done.stderr}")
    done, of_none, _ = envelope(f"* v\n{BOOST}.pss uic\n", "--stop", "0.3", "--show", "100m")
    check(of_none == of_card, f"neither: {done.stderr}")
    done, other, report = envelope(tran, "--stop", "0.1", "--show", "0,50m", "--set", "r1=50", "--plot", "v.html")
    check(done.returncode == 0 and report["envelope"]["periods"] == 10000 and "wrote     v.html" in done.stdout,
          f"--stop: {done.stdout} {done.stderr}")
    check((case.folder / "v.html").exists() and other != of_card, "a page")
    done, _, _ = envelope(tran + ".step r1 list 50 100\n")
    check(done.returncode == 0 and done.stderr.count("left out") == 1, f".step: {done.stderr}")
    for options, netlist, status, words in (
            ((), f"* v\n{BOOST}", 2, "the netlist has neither .env nor .tran"),
            ((), f"* v\n{BOOST}.tran 1u 1m uic=steady\n", 2, "leave uic=steady out"),
            (("--stop", "1m", "--show", "2m"), f"* v\n{BOOST}", 2, "there is no period at 0.002 s: the run ends at 0.001 s"),
            (("--show", "1m,x"), tran, 2, "--show: 'x' is no time"),
            (("--stop", "-1"), tran, 2, "--stop: '-1' is not a number greater than 0"),
            (("--losses",), tran, 2, "--losses is an option of"),
            (("-o", "none", "--measures", "m.csv"), tran, 2, "--measures is a table of .meas"),
            (("--stop", "1m"), "* v\nV1 a 0 1\nR1 a b 1\nC1 b 0 1u\n", 3, "no source repeats"),
            (("--period", "1m"), tran, 2, "--period is an option of")):
        done, _, _ = envelope(netlist, *options)
        check(done.returncode == status and words in done.stderr, f"{options}: {done.returncode}, {done.stderr}")
    done = subprocess.run([case.program, "run", "v.cir", "--stop", "1m"], cwd=case.folder, capture_output=True, text=True,
                          check=False)
    check(done.returncode == 2 and "--stop is an option of 'dalcs envelope'" in done.stderr, done.stderr)
    (case.folder / "v.cir").write_text(f"* v\n{BOOST}.env 0.01 uic\n")
    done = subprocess.run([case.program, "run", "v.cir", "-q", "-o", "none"], cwd=case.folder, capture_output=True,
                          text=True, check=False)
    check(done.returncode == 0, f"-o none: {done.stderr}")


def refused(case):
    case.refuses(f"* r\n{BOOST}.env 0.1 uic\n.meas tran m max v(out)\n", 3, "measurements, losses and --at", "c.cir:10:1")
    case.refuses(f"* r\n{BOOST}.env 0.1\n.tran 1u 1m\n", 3, "a second .tran, the first at")
    case.refuses(f"* r\n{BOOST}.env\n", 3, "a stop time is missing")
    case.refuses(f"* r\n{BOOST}.env -1\n", 3, "the stop time must be positive")
    case.refuses(f"* r\n{BOOST}.env 0.1 tol=0\n", 3, "tol is a positive number")
    case.refuses(f"* r\n{BOOST}.env 0.1 at=0.2\n", 3, "lies outside of the run")
    case.refuses(f"* r\n{BOOST}V2 x 0 SIN(0 1 50 0 -10)\nR9 x 0 1\n.env 0.1 uic\n", 2, "'v2' neither repeats nor comes to an end")
    case.refuses("* r\nV1 a 0 1\nR1 a b 1\nC1 b 0 1u\n.env 0.1 uic\n", 3, "no source repeats")
    case.refuses(f"* r\n{BOOST}.env 0.1 uic\n.options method=euler\n", 3, ".env needs steps whose error is controlled")


def main():
    with tempfile.TemporaryDirectory() as folder:
        case = Case(pathlib.Path(sys.argv[1]).resolve(), folder)
        for of in dalcs_program.some_of(circuits()):
            case.look_at(*of, 1e-6)
        case.look_at("coarse", BOOST, 1e-5, 50000, 100, 1e-3)
        case.look_at("fine", BOOST, 1e-5, 50000, 150, 1e-8)
        written(case)
        beside(case)
        verb(case)
        refused(case)
        return case.checker.finish()


if __name__ == "__main__":
    sys.exit(main())
