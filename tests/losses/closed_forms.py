#!/usr/bin/env python3
"""Losses of elements against closed forms.

usage: closed_forms.py PROGRAM
"""

import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

CLOSE = 1e-9
PI = math.pi
NOTHING = 1e-7  # the root of a difference of squares that is 0


class Losses:
    def __init__(self, program, checker, netlist, options=(), method=None, tolerance=1e-12, step=None,
                 balanced=True, quiet=True):
        self.checker = checker
        self.title = netlist.split("\n", 1)[0]
        self.run = dalcs_program.run(program, netlist, options=options, method=method,
                                     tolerance=tolerance, step=step, quiet=quiet)
        checker.check(self.run.status == 0, f"{self.title}: {self.run.stderr}")
        all_losses = self.run.report.get("losses", []) if self.run.status == 0 else []
        checker.check(len(all_losses) >= 1, f"{self.title}: no losses")
        self.all = all_losses
        self.sum = all_losses[0] if all_losses else {}
        self.of = {e["element"]: e for e in self.sum.get("elements", [])}
        if self.sum and balanced:
            moved = sum(abs(e["power"]) for e in self.of.values()) * self.length
            checker.close(self.sum["balance"], 0.0, 1e-9 * moved, f"{self.title}: balance")

    @property
    def length(self):
        return self.sum["to"] - self.sum["from"]

    def close(self, element, key, wanted, allowed=None):
        entry = self.of.get(element) if element else self.sum
        if self.checker.check(entry is not None and entry.get(key) is not None,
                              f"{self.title}: no {key} of {element}"):
            self.checker.close(entry[key], wanted, CLOSE * abs(wanted) if allowed is None else allowed,
                               f"{self.title}: {element} {key}")

    def same(self, element, key, wanted):
        entry = self.of.get(element, {}) if element else self.sum
        self.checker.check(entry.get(key) == wanted,
                           f"{self.title}: {element} {key} is {entry.get(key)}, not {wanted}")


def divider(program, checker):
    for scale in (1e-4, 1.0, 1e4):
        r = Losses(program, checker, f"""divider
V1 a 0 {10 * scale}
R1 a b 3
R2 b 0 7
.tran 1u 1m
.losses out=r2
.end
""")
        r.close("v1", "power", -10 * scale**2)
        r.close("r1", "power", 3 * scale**2)
        r.close("r2", "v_rms", 7 * scale)
        r.close("r2", "i_average", scale)
        r.close(None, "efficiency", 0.7)
        r.close(None, "resistors", 10 * scale**2 * 1e-3)


def sine_on_resistor(program, checker):
    r = Losses(program, checker, """sine on R
V1 a 0 SIN(0 325 50)
R1 a 0 10
.tran 1m 100m
.losses from=20m
.end
""")
    r.close("r1", "power", 325**2 / 20)
    r.close("v1", "power_factor", 1.0)
    r.close("v1", "displacement", 1.0)
    r.close("v1", "thd", 0.0, NOTHING)
    r.close("v1", "v_rms", 325 / math.sqrt(2))


def sine_on_coil(program, checker):
    """After the phase from which a coil has no constant current: half the power factor is phase."""
    r = Losses(program, checker, """sine on R and L
V1 a 0 SIN(0 100 50)
R1 a b 3
L1 b 0 {4/(2*pi*50)}
.tran 1m 400m
.losses from=300m to=400m
.end
""")
    r.close("v1", "power_factor", 0.6, 1e-8)
    r.close("v1", "displacement", 0.6, 1e-8)
    r.close("r1", "power", 3 * 200, 1e-5)


def no_fundamental(program, checker):
    """A current, or a voltage, without a component at the frequency of its source: a power factor, and no THD."""
    r = Losses(program, checker, """no fundamental
V1 a 0 PULSE(0 1 0 0 0 5m 20m)
I1 a 0 1
I2 0 b SIN(0 1 50)
V2 b 0 3
.tran 1m 40m
.losses
.end
""")
    r.close("v1", "power_factor", 0.5)
    for name in "v1", "i2":
        element = next(e for e in r.run.report["losses"][0]["elements"] if e["element"] == name)
        checker.check(element.get("thd") is None and element.get("displacement") is None, f"{element}")


def half_wave(program, checker):
    r = Losses(program, checker, """half wave
V1 a 0 SIN(0 10 50)
D1 a b dm
R1 b 0 5
.model dm d(ron=0)
.tran 1m 60m
.losses
.end
""")
    r.close("d1", "i_average", 2 / PI)
    r.close("r1", "power", 5.0)
    r.close("v1", "power_factor", math.sqrt(0.5))
    r.close("v1", "thd", math.sqrt((1 - (2 / PI)**2 - 0.5) / 0.5), 1e-8)
    r.close("d1", "v_rms", 5.0)
    r.close("d1", "power", 0.0, 1e-9)


SIX_PULSE = """six-pulse
Va a 0 SIN(0 325 50)
Vb b 0 SIN(0 325 50 0 0 -120)
Vc c 0 SIN(0 325 50 0 0 120)
D1 a p dm
D3 b p dm
D5 c p dm
D4 n a dm
D6 n b dm
D2 n c dm
I1 p n 20
.model dm d(ron=0 vfwd={vf})
.param vf={VF}
.tran 1m 60m
.losses from=20m out=i1
.end
"""


def six_pulse(program, checker):
    r = Losses(program, checker, SIX_PULSE.replace("{VF}", "0"))
    r.close("va", "thd", math.sqrt(PI**2 / 9 - 1), 1e-8)  # 31.08 %
    r.close("va", "power_factor", 3 / PI)
    r.close("va", "displacement", 1.0)
    r.close("va", "i_rms", 20 * math.sqrt(2 / 3))
    r.close("i1", "power", 20 * 3 * math.sqrt(3) * 325 / PI)
    r.close(None, "efficiency", 1.0)
    r.same("d1", "turned_on", 2)
    r = Losses(program, checker, SIX_PULSE.replace("{VF}", "1.25"))
    r.close("d1", "power", 1.25 * 20 / 3)
    r.close(None, "diodes", 2 * 1.25 * 20 * 0.04)


def square_wave(program, checker):
    r = Losses(program, checker, """square wave
V1 a 0 PULSE(-1 1 0 0 0 5m 10m)
R1 a 0 2
.tran 1m 50m
.losses
.end
""")
    r.close("v1", "thd", math.sqrt(PI**2 / 8 - 1), 1e-8)  # 48.34 %
    r.close("v1", "power_factor", 1.0)
    r.close("r1", "power", 0.5)
    square = Losses(program, checker, """a square current, against a sine
V1 a 0 SIN(0 1 50)
I1 0 a PULSE(-1 1 0 0 0 10m 20m)
.tran 1m 40m
.losses
.end
""")
    square.close("v1", "thd", math.sqrt(PI**2 / 8 - 1), 1e-8)
    square.close("v1", "power_factor", -2 * math.sqrt(2) / PI)


BUCK = """buck
V1 in 0 100
S1 in x g 0 sm
D1 0 x dm
I1 x 0 5
Vg g 0 PULSE(0 1 0 0 0 4u 10u)
.model sm sw(vt=0.5 ron=0.1)
.model dm d(ron=0.05 vfwd=0.7)
.tran 1u 100u
.losses from={FROM} to={TO} in=v1 out=i1
.switchloss sm eon v=(0 200) i=(0 10) e=(0 0 0 2m)
.switchloss s1 eoff v=(0 50) i=(0 10) e=(0 0 0 1m)
.switchloss d1 err v=(0 200) i=(0 10) e=(0 0 0 1m)
.end
"""


def buck(program, checker):
    blocked, drop = 100 + 0.7 + 0.25, 0.95
    for first, last in ((1, 10), (0, 10), (3, 7)):
        n = last - first
        r = Losses(program, checker,
                   BUCK.replace("{FROM}", f"{first}0u").replace("{TO}", f"{last}0u"))
        r.close("s1", "power", 0.1 * 25 * 0.4)
        r.close("d1", "power", drop * 5 * 0.6)
        r.same("s1", "turned_on", n)
        r.same("s1", "turned_off", n)
        r.same("d1", "turned_off", n)
        r.same("s1", "clamped", n)  # 100.45 V at turning off: the table ends at 50 V
        r.close("s1", "switching", n * 2e-3 * (blocked / 200) * 0.5 + n * 1e-3 * 0.5)
        r.close("d1", "switching", n * 1e-3 * ((100 - 0.5) / 200) * 0.5)
        losses = (r.of["s1"]["switching"] + r.of["d1"]["switching"]) / r.length
        load = 5 * ((100 - 0.5) * 0.4 - drop * 0.6)
        r.close("i1", "power", load)
        r.close(None, "efficiency", load / (200 + losses))
    checker.check("outside its table" in r.run.stderr, f"clamping is not told: {r.run.stderr}")


def windows(program, checker):
    """Windows side by side add up, wherever their ends are."""
    ends = [0, 10, 14, 37.3, 60, 64, 99.99, 100]
    parts = [Losses(program, checker, BUCK.replace("{FROM}", f"{a}u").replace("{TO}", f"{b}u"))
             for a, b in zip(ends, ends[1:])]
    whole = Losses(program, checker, BUCK.replace("{FROM}", "0").replace("{TO}", "100u"))
    for key in ("sources", "switches", "diodes", "switching"):
        whole.close(None, key, sum(p.sum[key] for p in parts), 1e-9 * abs(whole.sum["sources"]))
    for key in ("turned_on", "turned_off"):
        for element in ("s1", "d1"):
            whole.same(element, key, sum(p.of[element][key] for p in parts))


def rc_part(program, checker):
    """A window that is no period of anything."""
    r = Losses(program, checker, """RC
C1 a 0 1u IC=10
R1 a 0 1k
.tran 10u 5m uic
.losses from=0.3m to=1.7m
.end
""")
    a, b = math.exp(-0.6), math.exp(-3.4)
    r.close("r1", "power", 0.5e-6 * 100 * (a - b) / 1.4e-3)
    r.close("c1", "stored_change", -0.5e-6 * 100 * (a - b))
    r.close("c1", "i_average", -1e-6 * 10 * (math.sqrt(a) - math.sqrt(b)) / 1.4e-3)


def not_whole(program, checker):
    r = Losses(program, checker, """not whole
V1 a 0 SIN(0 1 50)
R1 a 0 1
.tran 1m 50m
.losses
.end
""", quiet=False)
    r.same("v1", "power_factor", None)
    r.same("v1", "thd", None)
    checker.check("2.5 periods of 'v1'" in r.run.stderr, f"not told: {r.run.stderr}")
    # An end that is off by less than the tolerance of a period is whole, by ten times more is not.
    for off, known in ((1e-7, True), (1e-5, False)):
        r = Losses(program, checker, f"""nearly whole
V1 a 0 SIN(0 1 50)
R1 a 0 1
.tran 1m 50m
.losses to={{40m*(1+{off}/2)}}
.end
""", tolerance=1e-6, balanced=False)
        checker.check((r.of["v1"]["thd"] is not None) == known, f"periods off by {off}: {r.of['v1']}")


def coupled(program, checker):
    """Two coils that share their flux: energies of each add up to what the pair holds."""
    r = Losses(program, checker, """coupled
V1 a 0 1
L1 a 0 1m Rser=0 IC=0
L2 b 0 4m IC=0
K1 L1 L2 0.5
R2 b 0 1meg
.tran 1u 1m uic
.losses
.end
""", tolerance=1e-12)
    total = r.of["l1"]["stored_change"] + r.of["l2"]["stored_change"]
    r.close(None, "stored_change", total)
    checker.close(total, 0.5e-3, 1e-8, "coupled: half a millijoule")  # the open winding carries microamperes
    r.close("l1", "i_average", 0.5, 1e-5)


def winding(program, checker):
    r = Losses(program, checker, """winding
V1 a 0 10
L1 a b 1m Rser=0.5
R1 b 0 4.5
.tran 10u 1m
.losses out=r1
.end
""")
    r.same("rser(l1)", "kind", "winding")
    r.close(None, "windings", 4 * 0.5e-3)
    r.close(None, "efficiency", 0.9)


def discharge(program, checker):
    """A load that a capacitor feeds: an efficiency above 1 is told with its reason, one below is not."""
    for start, wanted in ((9.0, True), (1.0, False)):
        netlist = f"""capacitor behind a source
V1 a 0 10
R1 a b 1k
C1 b 0 1u IC={start}
R2 b 0 1k
.losses in=V1 out=R2
.tran 10u 0.3m uic
.end
"""
        r = Losses(program, checker, netlist)
        checker.check((r.sum["efficiency"] > 1.0) == wanted, f"discharge: {r.sum['efficiency']}")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "discharge.cir"
            path.write_text(netlist)
            said = subprocess.run([program, "run", str(path), "-o", "none"], capture_output=True, text=True,
                                  check=False).stdout
        checker.check(("was stored before" in said) == wanted, f"discharge: {said}")


def charge_jump(program, checker):
    """A capacitor onto another: what is lost is lost in the switch."""
    for scale in (1e-3, 1.0, 1e3):
        r = Losses(program, checker, f"""capacitor onto capacitor
C1 a 0 1u IC={10 * scale}
C2 b 0 3u IC={2 * scale}
Vg g 0 PULSE(0 1 1m 0 0 1 2)
S1 a b g 0 sm
.model sm sw(vt=0.5 ron=0)
.tran 100u 2m uic
.losses
.end
""")
        r.close("s1", "jumps", 0.5 * 0.75e-6 * 64 * scale**2)
        r.close(None, "switches", 24e-6 * scale**2)
        r.close(None, "stored_change", -24e-6 * scale**2)


def source_jump(program, checker):
    """A capacitor onto a battery through an ideal switch, and through a diode with a threshold."""
    r = Losses(program, checker, """capacitor onto battery
V1 a 0 10
S1 a b g 0 sm
C1 b 0 2u IC=4
Vg g 0 PULSE(0 1 1m 0 0 1 2)
.model sm sw(vt=0.5 ron=0)
.tran 100u 2m uic
.losses
.end
""")
    r.close("v1", "power", -2e-6 * 6 * 10 / 2e-3)
    r.close("s1", "jumps", 0.5 * 2e-6 * 36)
    r = Losses(program, checker, """through a diode
V1 a 0 PULSE(0 10 1m 0 0 1 2)
V2 a b 1
D1 b c dm
C1 c 0 2u IC=1
.model dm d(ron=0 vfwd=0.5)
.tran 100u 2m uic
.losses from=0.5m to=1.5m
.end
""")
    charge = 2e-6 * 7.5
    r.close("v1", "power", -charge * 10 / 1e-3)
    r.close("v2", "power", charge * 1 / 1e-3)
    r.close("d1", "jumps", 0.5 * charge + 0.5 * 2e-6 * 7.5**2)


def flux_jump(program, checker):
    """A switch that opens on a coil: flux through it is charge through the other kind."""
    r = Losses(program, checker, """current into a coil
I1 0 a 3
S1 a 0 g 0 sm
L1 a 0 1m IC=0
Vg g 0 PULSE(1 0 1m 0 0 1 2)
.model sm sw(vt=0.5 ron=0)
.tran 100u 2m uic
.losses
.end
""")
    r.close("s1", "jumps", 0.5e-3 * 9)
    r.close("i1", "jumps", -1e-3 * 9)
    r.close("l1", "stored_change", 0.5e-3 * 9)
    r = Losses(program, checker, """interrupted
L1 a 0 1m IC=3
S1 a b g 0 sm
L2 b 0 2m IC=-3
Vg g 0 PULSE(1 0 1m 0 0 1 2)
.model sm sw(vt=0.5 ron=0)
.tran 100u 2m uic
.losses
.end
""")
    r.close("s1", "jumps", 0.5 * 3e-3 * 9)
    r.close(None, "stored_change", -0.5 * 3e-3 * 9)


def at_start(program, checker):
    """A jump at the start belongs to a window from the start."""
    r = Losses(program, checker, """at the start
V1 a 0 10
D1 a b dm
C1 b 0 1u IC=2
R1 b 0 1meg
.model dm d(ron=0)
.tran 100u 1m uic
.losses
.end
""")
    r.close("d1", "jumps", 0.5e-6 * 64)
    r.close("c1", "stored_change", 0.5e-6 * (100 - 4))
    r.close("v1", "power", -(8e-6 * 10 + 1e-4 * 1e-3) / 1e-3)


def euler(program, checker):
    """Implicit Euler: energies are those of its ledger, what the method dissipates is left over."""
    r = Losses(program, checker, """euler
V1 a 0 10
R1 a b 1k
C1 b 0 1u IC=0
.tran 1u 1m uic
.losses
.end
""", method="euler", step=1e-6, tolerance=None, balanced=False)
    energy = r.run.report["energy"]
    r.close(None, "sources", energy["sources"])
    r.close(None, "resistors", energy["resistors"])
    r.close(None, "stored_change", energy["stored_change"])
    r.close(None, "balance", energy["method"] + energy["balance"], 1e-9 * energy["sources"])


def asked_outside(program, checker):
    """--losses with and without a window, and .step."""
    netlist = """steps
V1 a 0 SIN(0 {v} 50)
R1 a 0 2
.param v=1
.step param v list 1 2 3
.tran 1m 40m
.end
"""
    r = Losses(program, checker, netlist, options=("--losses",))
    checker.check(len(r.all) == 3, f"steps: {len(r.all)} losses")
    for k, one in enumerate(r.all):
        checker.close(one["resistors"], (k + 1)**2 / 4 * 0.04, 1e-9, "steps: energy")
        checker.check(one["step"] == f"v = {k + 1}", f"steps: {one['step']}")
    r = Losses(program, checker, netlist, options=("--losses=20m:",))
    checker.check((r.sum["from"], r.sum["to"]) == (0.02, 0.04), f"window: {r.sum['from']}")


def chart(program, checker):
    """Bars, the largest loss on top; loads are none. A name that says no format is refused."""
    if shutil.which("gnuplot") is None:
        return
    netlist = BUCK.replace("{FROM}", "10u").replace("{TO}", "100u")
    with tempfile.TemporaryDirectory() as folder:
        picture = pathlib.Path(folder) / "losses.svg"
        r = Losses(program, checker, netlist, options=("--losses-plot", str(picture)))
        text = picture.read_text() if picture.exists() else ""
        checker.check("<svg" in text and ">s1<" in text and ">d1<" in text and ">i1<" not in text,
                      f"chart: {r.run.stderr} {text[:200]}")
        ideal = pathlib.Path(folder) / "ideal.svg"
        run = dalcs_program.run(program, re.sub(r"\.switchloss.*\n|ron=\S*\b|vfwd=\S*\b", "", netlist),
                                options=("--losses-plot", str(ideal)))
        checker.check(run.status == 4 and "take 0 W" in run.stderr and not ideal.exists(), f"chart: {run.stderr}")
    run = dalcs_program.run(program, netlist, options=("--losses-plot", "losses.txt"))
    checker.check(run.status == 2 and ".svg, .png or .pdf" in run.stderr, f"chart: {run.stderr}")


def main():
    checker = dalcs_program.Checker("losses")
    for case in (divider, sine_on_resistor, sine_on_coil, no_fundamental, half_wave, six_pulse, square_wave, buck,
                 windows, rc_part, not_whole, coupled, winding, discharge, charge_jump, source_jump, flux_jump,
                 at_start, euler, asked_outside, chart):
        case(sys.argv[1], checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
