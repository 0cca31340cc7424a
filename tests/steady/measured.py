#!/usr/bin/env python3
""".meas pss and .four behind .pss: ten square waves of a clock and ten of an oscillator against closed forms.

usage: measured.py PROGRAM
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
from kinds import between, part, pulse  # pylint: disable=wrong-import-position

NEAR = 1e-9
HARMONICS = 12


class Run:
    """Of one netlist after the other in one folder."""

    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        self.checker = dalcs_program.Checker("measured")

    def report(self, label, netlist, verb="steady"):
        (self.folder / "c.cir").write_text(f"* {label}\n{netlist}.end\n")
        done = subprocess.run([self.program, verb, "c.cir", "-o", "c.csv", "--report", "c.json",
                               "-q"], cwd=self.folder, capture_output=True, text=True, check=False)
        if not self.checker.check(done.returncode == 0, f"{label}: {done.stderr}"):
            return None, ""
        return json.loads((self.folder / "c.json").read_text()), done.stderr

    def near(self, label, got, due, scale=None):
        scale = abs(due) if scale is None else scale
        self.checker.check(abs(got - due) <= NEAR * scale, f"{label}: {got!r}, not {due!r}")

    def harmonics(self, label, fourier, frequency, sizes):
        self.near(f"{label}, frequency", fourier["frequency"], frequency)
        for k, size in enumerate(sizes):
            self.near(f"{label}, harmonic {k}", fourier["magnitude"][k], size, sizes[1])
        thd = math.sqrt(sum(size * size for size in sizes[2:])) / sizes[1]
        self.near(f"{label}, THD", fourier["thd"], thd, 1.0)


def square(volts, duty):
    return [volts * duty] + [2 * volts / (k * math.pi) * abs(math.sin(k * math.pi * duty))
                             for k in range(1, HARMONICS + 1)]


def clocked(run):
    """The switched node of a synchronous buck converter, and its coil's current into a large capacitor."""
    for k in range(10):
        period, duty, volts = between(1e-7, 1e-3, k, 1), 0.1 + 0.8 * part(k, 2), between(1, 800, k, 3)
        ohms = between(0.1, 100, k, 4)
        coil = ohms * period * between(0.5, 5, k, 5)
        label = f"clocked_{k}"
        report, _ = run.report(
            label, f"Vin in 0 {volts!r}\n" + pulse("1", period, duty) +
            "S1 in sw g1 0 sm\nS2 sw 0 0 g1 sn\n.model sn SW(Ron=0 Vt=-0.5)\n"
            f".model sm SW(Ron=0 Vt=0.5)\nL1 sw out {coil!r}\nR1 out 0 {ohms!r}\n.pss uic\n"
            f".four {1 / period!r} {HARMONICS} v(sw)\n"
            ".meas pss mean avg v(sw)\n.meas pss size rms v(sw)\n.meas top max i(l1)\n"
            ".meas pss bottom min i(l1)\n.meas pss swing pp i(l1)\n.meas pss charge integ i(l1)\n"
            f".meas pss fell when v(sw)={volts / 2!r} fall=1\n.meas pss at_it find i(l1) "
            f"at={duty * period!r}\n.meas pss form param='size/mean'\n")
        if report is None:
            continue
        value = {m["name"]: m["value"] for m in report["measurements"]}
        run.harmonics(label, report["fourier"][0], 1 / period, square(volts, duty))
        on, off = (math.exp(-ohms * period * part_ / coil) for part_ in (duty, 1 - duty))
        top = volts / ohms * (1 - on) / (1 - on * off)
        for name, due in (("mean", volts * duty), ("size", volts * math.sqrt(duty)),
                          ("form", 1 / math.sqrt(duty)), ("top", top), ("bottom", top * off),
                          ("swing", top * (1 - off)), ("charge", volts * duty / ohms * period),
                          ("fell", duty * period), ("at_it", top)):
            run.near(f"{label}, {name}", value[name], due)


def free(run):
    """The output of a Schmitt inverter whose thresholds are in the middle; .four has a guess of its frequency."""
    for k in range(10):
        volts, ohms, store = between(1, 50, k, 1), between(100, 1e6, k, 2), between(1e-11, 1e-5, k, 3)
        half = (0.02 + 0.3 * part(k, 4)) * volts
        low, high = volts / 2 - half, volts / 2 + half
        period = 2 * ohms * store * math.log(high / low)
        label = f"free_{k}"
        report, _ = run.report(
            label, f"Vcc p 0 {volts!r}\nSp p y 0 c below\nSn y 0 c 0 above\nR1 y c {ohms!r}\n"
            f"C1 c 0 {store!r}\n.model above SW(Ron=0 Vt={volts / 2!r} Vh={half!r})\n"
            f".model below SW(Ron=0 Vt={-volts / 2!r} Vh={half!r})\n.pss uic\n"
            f".four {(0.7 + 0.6 * part(k, 5)) / period!r} {HARMONICS} v(y)\n"
            ".meas pss low min v(c)\n.meas pss high max v(c)\n.meas pss mean avg v(c)\n")
        if report is None:
            continue
        value = {m["name"]: m["value"] for m in report["measurements"]}
        run.harmonics(label, report["fourier"][0], 1 / period, square(volts, 0.5))
        for name, due in (("low", low), ("high", high), ("mean", volts / 2)):
            run.near(f"{label}, {name}", value[name], due)


def both(run):
    """.pss and .tran in one netlist: each has its own; a frequency that the orbit does not have is told."""
    body = ("Vin in 0 10\n" + pulse("1", 1e-5, 0.5) + "S1 in sw g1 0 sm\nR1 sw 0 1\n"
            ".model sm SW(Ron=0 Vt=0.5)\n.pss\n.tran 1u 30u\n.four 100k 3 v(sw)\n"
            ".meas tran all integ v(sw)\n.meas pss one integ v(sw)\n")
    report, said = run.report("both", body, "run")
    if report is not None:
        value = {m["name"]: m["value"] for m in report["measurements"]}
        run.near("integral of the run", value["all"], 150e-6)
        run.near("integral of the period", value["one"], 50e-6)
        run.checker.check(len(report["fourier"]) == 2, "two of .four")
        run.near("of the period, to", report["fourier"][0]["to"], 10e-6)
        run.near("of the run, from", report["fourier"][1]["from"], 20e-6)
        for one in report["fourier"]:
            run.harmonics("both", one, 1e5, square(10, 0.5)[:4])
        run.checker.check("no component at" not in said, said)
    _, said = run.report("elsewhere", body.replace(".four 100k", ".four 130k"))
    run.checker.check("no component at 130 kHz" in said, f"130 kHz: {said}")
    # a frequency and a period that were typed with nine digits may differ by 1e-8
    _, said = run.report("nine digits", body.replace(".four 100k", ".four 100.0000004k"))
    run.checker.check("no component at" not in said, f"4e-9 off: {said}")
    _, said = run.report("more", body.replace(".four 100k", ".four 100.000003k"))
    run.checker.check("no component at" in said, f"3e-8 off: {said}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        run = Run(pathlib.Path(sys.argv[1]).resolve(), folder)
        clocked(run)
        free(run)
        both(run)
    return run.checker.finish()


if __name__ == "__main__":
    sys.exit(main())
