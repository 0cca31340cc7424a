#!/usr/bin/env python3
"""The ledger of energies against closed forms, and what a person sees of it.

usage: energy.py PROGRAM
"""

import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import NETLISTS, Checker, run, some_of  # noqa: E402

ENTRIES = ["sources", "resistors", "diodes", "jumps", "stored_change", "method"]

# name, netlist, what the ledger must hold (0 where nothing is said), the largest error over the sum of
# all magnitudes: with the default method, and with a hundred thousand steps of euler
CHARGE = 0.7 * 4.3e-6
CASES = [
    ("a capacitor charged through a resistor",
     "V1 in 0 5\nR1 in out 1k\nC1 out 0 1u\n.tran 1m 50m uic",
     {"sources": 25e-6, "resistors": 12.5e-6, "stored_change": 12.5e-6}, 1e-8, 1e-3),
    ("the same from another's charge",
     "C1 a 0 1u ic=10\nR1 a b 1k\nC2 b 0 3u ic=2\n.tran 1m 50m uic",
     {"resistors": 24e-6, "stored_change": -24e-6}, 1e-8, 1e-3),
    ("two capacitors share their charge", (NETLISTS / "hard" / "hc01a.cir").read_text(),
     {"jumps": 24e-6, "stored_change": -24e-6}, 1e-9, 1e-9),
    ("a source jumps across a capacitor",
     "V1 a 0 PULSE(0 5 1m 0 0 5m)\nC1 a 0 1u\nR1 a 0 1meg\n.tran 1m 3m",
     {"sources": 25e-6 + 5e-8, "resistors": 5e-8, "jumps": 12.5e-6, "stored_change": 12.5e-6},
     1e-9, 1e-4),
    ("the same through a diode with a threshold",
     "V1 a 0 PULSE(0 5 1m 0 0 5m)\nD1 a b DF\nC1 b 0 1u\n"
     ".model DF D(Vfwd=0.7)\n.tran 1m 3m uic",
     {"sources": 5 * 4.3e-6, "diodes": CHARGE, "jumps": 0.5e-6 * 4.3**2,
      "stored_change": 0.5e-6 * 4.3**2}, 1e-9, 1e-9),
    ("a resistor across a sine, over a period", "V1 a 0 SIN(0 10 50)\nR1 a 0 100\n.tran 1m 20m",
     {"sources": 10e-3, "resistors": 10e-3}, 1e-14, 1e-4),
    ("two sines and a constant, over an eighth",
     "V1 a 0 SIN(1 2 125)\nR1 a b 2\nI1 0 b SIN(0 1 125 0 0 90)\nR2 b 0 2\n.tran 0.1m 1m",
     # v(b) = v1 / 2 + i1; 1 + 2 sin x and cos x, x = 2 pi 125 t
     None, 1e-14, 1e-4),
    ("a source that commands a switch drives a resistor as well",
     "V1 a 0 3\nR1 a b 10\nS1 b 0 g 0 SW\nC1 b 0 1n\nVg g 0 PULSE(0 2 0 0 0 1m 2m)\nRg g 0 100\n"
     ".model SW SW(Ron=0 Vt=1)\n.tran 0.1m 1m",
     # C1 is at 3 V before the switch closes at t = 0
     {"sources": 0.9e-3 + 40e-6, "resistors": 0.9e-3 + 40e-6, "jumps": 4.5e-9,
      "stored_change": -4.5e-9}, 1e-9, 1e-4),
    ("a diode with a threshold and a resistance",
     "I1 0 a 2\nD1 a 0 DF\n.model DF D(Vfwd=0.7 Ron=0.1)\n.tran 0.1m 1m",
     {"sources": 1.8e-3, "diodes": 1.8e-3}, 1e-12, 1e-12),
    ("breakdown", "I1 0 a 10m\nD1 0 a DZ\n.model DZ D(Vrev=5 Rrev=10)\n.tran 0.1m 1m",
     {"sources": 51e-6, "diodes": 51e-6}, 1e-12, 1e-12),
    ("a tank for three periods", "C1 a 0 1u ic=10\nL1 a 0 1m\n.tran 1u 596.0746u uic", {}, 0.0, 0.0),
    ("a tank for a quarter of a period, and a resistor",
     "I1 0 a SIN(0 1 1k)\nL1 a 0 1m\nR1 a 0 1k\n.tran 1u 0.25m uic",
     None, 1e-6, 1e-3),
    ("two equal sines in parallel", "V1 a 0 SIN(0 1 1k)\nV2 a 0 SIN(0 1 1k)\nR1 a 0 1k\n.tran 20u 1m",
     {"sources": 0.5e-6, "resistors": 0.5e-6}, 1e-12, 1e-4),
    ("two equal sines in series, of current",
     "I1 0 a SIN(0 1m 1k)\nR1 a b 1k\nI2 b 0 SIN(0 1m 1k)\nR2 a 0 1k\n.tran 20u 1m",
     {"sources": 0.5e-6, "resistors": 0.5e-6}, 1e-12, 1e-4),
    ("a sum of two sources beside a third one",
     "V1 a 0 SIN(0 1 1k)\nV2 b a 1\nV3 b 0 SIN(1 1 1k)\nR1 b 0 1k\n.tran 20u 1m",
     {"sources": 1.5e-6, "resistors": 1.5e-6}, 1e-12, 1e-4),
    ("a source beside a controlled one",
     "V1 a 0 SIN(0 1 1k)\nV2 b 0 SIN(0 2 1k)\nE1 b 0 a 0 2\nR1 b 0 1k\n.tran 20u 1m",
     {"sources": 2e-6, "resistors": 2e-6}, 1e-12, 1e-4),
    ("a source beside a pulse that is as high up to the end",
     "V1 a 0 1\nV2 a 0 PULSE(1 2 100u 0 0 40u 100u)\nR1 a 0 1k\n.tran 20u 99.9u",
     {"sources": 99.9e-9, "resistors": 99.9e-9}, 1e-12, 1e-4),
    ("a controlled source", "V1 a 0 2\nR1 a 0 4\nE1 b 0 a 0 3\nR2 b 0 9\n.tran 0.1m 1m",
     {"sources": 5e-3, "resistors": 5e-3}, 1e-13, 1e-12),
    ("a negative resistor", "C1 a 0 1u ic=1\nR1 a 0 -1k\n.tran 0.1m 1m uic",
     {"resistors": -0.5e-6 * (math.e**2 - 1), "stored_change": 0.5e-6 * (math.e**2 - 1)}, 1e-6,
     1e-3),
]


def two_sines():
    """Resistors take (v1 - v(b))^2 / 2 + v(b)^2 / 2, by Simpson's rule."""
    total, n = 0.0, 20000
    for k in range(n + 1):
        x = 0.25 * math.pi * k / n
        v1, vb = 1 + 2 * math.sin(x), (1 + 2 * math.sin(x)) / 2 + math.cos(x)
        weight = 1 if k in (0, n) else 4 if k % 2 else 2
        total += weight * ((v1 - vb)**2 + vb**2) / 2
    total *= 1e-3 / n / 3
    return {"sources": total, "resistors": total}


def check_case(program, checker, case):
    name, netlist, wanted, tolerance, euler_tolerance = case
    if name.startswith("two sines"):
        wanted = two_sines()
    text = netlist if netlist.startswith("hc") else f"{name}\n{netlist}\n.end\n"
    for method in [None, "radau", "euler"]:
        options = {"step": None, "tolerance": None}
        if method == "euler":
            words = next(line for line in text.splitlines() if line.startswith(".tran")).split()
            scale = {"m": 1e-3, "u": 1e-6}[words[2][-1]]
            options["step"] = float(words[2][:-1]) * scale / 100000
        done = run(program, text, method=method, **options)
        if not checker.check(done.status == 0, f"{name}: exit {done.status}: {done.stderr}"):
            continue
        ledger = done.report["energy"]
        size = sum(abs(ledger[entry]) for entry in ENTRIES)
        balance = ledger["sources"] - sum(ledger[entry] for entry in ENTRIES[1:])
        what = f"{name}, {method}: "
        checker.close(ledger["balance"], balance, 1e-14 * size + 1e-21, what + "balance")
        checker.close(balance, 0.0, 1e-10 * size + 1e-15, what + "balance")
        lost = sum(jump["energy_lost"] for jump in done.report["jumps"])
        checker.close(ledger["jumps"], lost, 1e-9 * size, what + "jumps of the ledger")
        if name.startswith("a tank for three"):
            damped = -ledger["stored_change"]  # all of it by the method
            checker.close(damped, ledger["method"], 1e-12, what + "what the method took")
            checker.check(abs(damped) < (0.03 if method == "euler" else 1e-7) * 50e-6,
                          f"{what}the method took {damped} J of 50 uJ")
            continue
        if wanted is None:
            checker.close(ledger["sources"], ledger["resistors"] + ledger["stored_change"],
                          (euler_tolerance if method == "euler" else tolerance) * size,
                          what + "sources")
            checker.check(ledger["sources"] > 1e-6, f"{what}sources gave {ledger['sources']} J")
            continue
        allowed = (euler_tolerance if method == "euler" else tolerance) * size
        for entry in ENTRIES:
            checker.close(ledger[entry], wanted.get(entry, 0.0), allowed + 1e-20, what + entry)


def check_circuits(program, checker):
    """Rectifiers and converters: what goes in comes out, and the resistor's part is its waveform's."""
    text = ("half-wave\nV1 in 0 SIN(0 10 50)\nD1 in out\nC1 out 0 100u\nR1 out 0 1k\n"
            ".tran 10u 100m\n.end\n")
    done = run(program, text, method=None)
    time, out = done.time, done.column("v(out)")
    heat = sum((time[k + 1] - time[k]) * (out[k]**2 + out[k + 1]**2) / 2
               for k in range(len(time) - 1)) / 1e3
    ledger = done.report["energy"]
    checker.close(ledger["resistors"], heat, 1e-6 * heat, "half-wave: resistor")
    checker.close(ledger["stored_change"], 0.5 * 100e-6 * (out[-1]**2 - out[0]**2), 1e-9 * heat,
                  "half-wave: stored")
    for name in ["rectifiers/half_wave_rc", "converters/buck", "converters/boost"]:
        for method in [None, "euler"]:
            done = run(program, NETLISTS / f"{name}.cir", method=method)
            ledger = done.report["energy"]
            given, taken = ledger["sources"], sum(ledger[e] for e in ENTRIES[1:5])
            checker.check(given > 1e-3, f"{name}: sources gave {given} J")
            checker.close(given, taken, (0.05 if method else 1e-6) * given, f"{name}, {method}")


def check_texts(program, checker):
    def printed(netlist, *options):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "a.cir").write_text(netlist)
            return subprocess.run([program, "run", "a.cir", "-o", "a.csv", *options], cwd=folder,
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                  check=False)

    charged = f"RC\n{CASES[0][1]}\n.end\n"
    wanted = ("\n\n  energy\n  from sources          25.00 uJ\n  in resistors          12.50 uJ\n"
              "  change stored         12.50 uJ\n\n")
    done = printed(charged, "--energy")
    checker.check(wanted in done.stdout, f"not the ledger: {done.stdout}")
    checker.check("energy" not in printed(charged).stdout, "a ledger that nobody asked for")
    done = printed(charged.replace("V1 in 0 5", "V1 in 0 0"), "--energy")
    checker.check("\n  energy              0  J\n\n" in done.stdout, f"not 0: {done.stdout}")
    unstable = charged.replace("1k", "-1").replace(".tran 1m 50m", ".tran 1u 500u")
    done = printed(unstable, "--energy", "--method", "euler", "--step", "0.1u")
    checker.check(done.returncode == 0 and "energy" not in done.stdout,
                  f"energies beyond all numbers: {done.stdout} {done.stderr}")
    done = printed("V1 a 0 1\nV2 b 0 1\nR1 b 0 1\n.op\n.end\n", "--energy")
    checker.check("the netlist has no .tran: --energy has no effect" in done.stderr, done.stderr)
    checker.check("energy" not in done.stdout, f"an energy of an operating point: {done.stdout}")


def main():
    program, checker = str(pathlib.Path(sys.argv[1]).resolve()), Checker("energy")
    for case in some_of(CASES):
        check_case(program, checker, case)
    check_circuits(program, checker)
    check_texts(program, checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
