#!/usr/bin/env python3
"""Model cards as schematics and libraries bring them: unused ones of a library, those that LTspice adds, MOSFETs without a body
diode or with the bulk at the drain; each against a closed form.

usage: model_cards.py PROGRAM
"""

import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, Run  # noqa: E402

PROGRAM = pathlib.Path(sys.argv[1]).resolve()


def run(cards, files=()):
    """A netlist among files, as (name, text)."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files:
            (pathlib.Path(folder) / name).write_text(text)
        (pathlib.Path(folder) / "main.cir").write_text(f"a circuit\n{cards}\n.end\n")
        done = subprocess.run([PROGRAM, "run", "main.cir", "-o", "x.csv", "--audit", "full"], cwd=folder, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, check=False)
        output = pathlib.Path(folder) / "x.csv"
        return Run(done.returncode, done.stderr, output.read_bytes() if output.exists() else None, None)


def ends(checker, what, done, wanted, tolerance=1e-8):
    checker.check(done.status == 0, f"{what}: {done.status} {done.stderr}")
    for signal, value in wanted.items() if done.status == 0 else ():
        checker.close(done.column(signal)[-1], value, tolerance * max(1, abs(value)), f"{what}: {signal}")


GOOD = ".model good D(Ron=1 Vfwd=1)\n.model part SW(Ron=1 Vt=0.5)\n.model ohms R(tc1=1m)\n"
BROKEN = (
    ".model bad D(Ron=-1)", ".model bad VDMOS(Vto=2 Kp=1 Is=0 BV=80)", ".model bad SW(Ron=1 Roff=1)", ".model bad D(Is=0)",
    ".model bad NMOS(level=54 vth0=0.3)", ".model bad SW(Td=1m)", ".model bad XYZ(a=1)", ".model bad PMOS(Kp=-3)",
    ".model bad D(Is=1n N=)", ".model bad SW(Ron=1 nonsense=3)", ".model bad NPN(bf=100)", ".model bad D(Vfwd=1 Vfwd=2)",
)


def libraries(checker):
    """A model that nothing names stops nothing and says nothing; the same in the netlist, and one that is used, does."""
    circuit = "V1 a 0 3\nD1 a b good\nR1 b 0 9\n.op"
    inner = "V1 a 0 3\nX1 a b rect\nR1 b 0 9\n.op"
    for bad in BROKEN:
        library = f"{GOOD}{bad}\n"
        ends(checker, f"a library with {bad}", run(f"{circuit}\n.lib x.lib", [("x.lib", library)]), {"v(b)": 1.8})
        ends(checker, f"included, {bad}", run(f".include x.inc\n{circuit}", [("x.inc", library)]), {"v(b)": 1.8})
        part = f".subckt rect p q\nD1 p q good\n{library}.ends\n"
        ends(checker, f"in a subcircuit, {bad}", run(f".lib x.lib\n{inner}", [("x.lib", part)]), {"v(b)": 1.8})
        quiet = run(f"{circuit}\n.lib x.lib", [("x.lib", library)]).stderr
        checker.check("bad" not in quiet, f"{bad}: {quiet}")
        if "NPN" not in bad:
            checker.check(run(f"{circuit}\n{library}").status != 0 or "level" in bad, f"{bad} in the netlist itself")
    used = (("D2 a c bad\nR2 c 0 1", 0), ("S1 a c a 0 bad\nR2 c 0 1", 2), ("M1 a a 0 0 bad", 1))
    for cards, which in used:
        done = run(f"{circuit}\n{cards}\n.lib x.lib", [("x.lib", f"{GOOD}{BROKEN[which]}\n")])
        checker.check(done.status == 3, f"{cards}: {done.status}")
    for card, volts in (("D1 a b good", 1.8), ("S1 a b a 0 part", 2.7), ("R2 a b 1 ohms", 2.7), ("R2 a b ohms 1", 2.7)):
        done = run(f"V1 a 0 3\n{card}\nR1 b 0 9\n.op\n.lib x.lib", [("x.lib", GOOD)])
        ends(checker, f"{card} of a library", done, {"v(b)": volts})


def symbols(checker):
    """The card that LTspice writes for a symbol's kind yields to the author's, wherever both stand."""
    diode = "V1 a 0 3\nD1 a b D\nR1 b 0 9"
    switch = "V1 a 0 3\nS1 a b a 0 SW\nR1 b 0 9"
    fet = "V1 a 0 3\nM1 a g b b NMOS\nR1 b 0 9\nVg g b 10"
    for circuit, own, wanted in ((diode, ".model D D(Ron=1 Vfwd=1)", 1.8), (diode, ".model d d ron=1 vfwd=0", 2.7),
                                 (diode, ".MODEL D D(Ron=0.5 Roff=1G Vfwd=0.15)", 2.7), (switch, ".model SW SW(Ron=1 Vt=0.5)", 2.7),
                                 (fet, ".model NMOS NMOS(Vto=2 Ron=1)", 2.7)):
        bare = own.split("(")[0].split(" ron")[0] + "\n"
        for order in ((bare, own + "\n"), (own + "\n", bare), (bare, bare, own + "\n"), (bare, own + "\n", own + "\n")):
            done = run(circuit + "\n" + "".join(order) + ".op")
            ends(checker, f"{own}, {len(order)} cards", done, {"v(b)": wanted}, 1e-6)
            checker.check("the one with parameters counts" in done.stderr, done.stderr)
    for first, second in ((".model x D(Ron=1)", ".model x D(Ron=2)"), (".model x D", ".model x D(Ron=2)"), (".model D D(Ron=1)", ".model D D(Ron=2)")):
        checker.check(run(f"{diode}\n{first}\n{second}\n.op").status == 3, f"{first}, {second}")


def ignored(checker):
    """What has no influence here: a method in quotes, a corner that is rounded, noise that is a formula of the frequency."""
    circuit = "V1 a 0 3\nR1 a b 1\nR2 b 0 2\n.op\n"
    for word in ('"gear"', '"Gear"', '"TRAP"', '"trapezoidal"', "gear", '"bdf"', '"auto"', '"radau"'):
        ends(checker, f"method={word}", run(f"{circuit}.options method={word}"), {"v(b)": 2})
    checker.check("'Heun'" in run(f'{circuit}.options method="Heun"').stderr.replace('"', "'"), "another method")
    for words in ("epsilon=0.1", "level=2 epsilon=10m", "ilimit=1k level=2 epsilon=1", "epsilon={1/10} noiseless"):
        done = run(f"V1 a 0 3\nS1 a b a 0 s\nR1 b 0 2\n.model s SW(Ron=1 Roff=1g Vt=1 Vh=-0.1 {words})\n.op")
        ends(checker, words, done, {"v(b)": 2}, 1e-6)
    for words in ("en=.85n+freq*36u/(8k*freq+(freq-400k)**2)", "in=1f incm=3.5e-18*freq/(1+1e-12*freq**2)", "en=1n", "en={1n*2}",
                  "enk=(1+2)*3 en=4n", "in=1p*sqrt(1+100/freq)", "en=1n*(2+(3+freq)*(4+freq)) ink=3", "en=2n*(freq)"):
        done = run(f"V1 a 0 1m\nA1 0 a 0 0 0 0 q 0 OTA g=1m {words} Rout=2k linear Iout=1\n.op")
        ends(checker, words, done, {"v(q)": 2e-3}, 1e-6)


def sources(checker):
    """Rpar and Cpar before I=, brackets around all of .ic, and pins that no wire reaches."""
    for words, value in (("Rpar=3 I=v(a)", 6), ("rpar=1 I=( v(a)>1 ) tripdv=1 tripdt=1", 1), ("Cpar=1u Rpar=3 I=v(a)*2", 12),
                         ("cpar=1n I=v(a)**2 rpar=2", 8), ("RPAR={1+1} I={v(a)}", 4), ("Rpar=1k I=2m", 2), ("Rpar=2 I=3", 6),
                         ("Rpar=1 I=if(v(a)>1, 5, 6)", 5), ("Rpar=1meg I=time*0+1u", 1), ("Rpar=0.5 I=v(a) m=2", 1)):
        ends(checker, words, run(f"V1 a 0 2\nB1 0 out {words}\n.op"), {"v(out)": value}, 1e-7)
    checker.check(run("V1 a 0 2\nB1 0 out Rpar=1 V=v(a)\n.op").status == 3, "Rpar of a voltage")
    circuit = "C1 a 0 1u\nR1 a 0 1k\nC2 b 0 1u\nL1 b c 1m\nR2 c 0 1k\n.tran 1u 2u"
    for card, volts in ((".ic(V(a)=12)", 12), (".ic (v(a)=3)", 3), (".ic(V(a)=5 v(b)=1)", 5), (".IC(v(a)={2*2} i(L1)=0)", 4),
                        (".ic v(a)=7", 7), (".ic( v(a) = 2 )", 2)):
        done = run(f"{circuit}\n{card}")
        checker.check(done.status == 0, f"{card}: {done.stderr}")
        if done.status == 0:
            checker.close(done.column("v(a)")[0], volts, 1e-9, card)
    for pin in ("nc_01", "NC_12", "nc_123", "unconnected-(U1-Pad3)"):
        part = ".subckt choice x y z q\nB1 q 0 V=if(v(x)>0.5, v(y), v(z))\n.ends\n"
        done = run(f"V1 x 0 1\nV2 y 0 3\nX1 x y {pin} q choice\nX2 {pin} y x r choice\nR1 q 0 1\nR2 r 0 1\n{part}.op")
        ends(checker, f"a pin {pin}", done, {"v(q)": 3, "v(r)": 1})
        checker.check("without a wire" in done.stderr, done.stderr)
    for pin in ("nc_1x", "nc_", "mid"):
        checker.check(run(f"V1 x 0 1\nB1 q 0 V=v({pin})\nR1 q 0 1\n.op").status == 3, f"v({pin})")


def transistors(checker):
    """IS=0: no body diode. The bulk at the drain: the other end is the drain."""
    for kind, sign in (("VDMOS(", 1), ("NMOS(", 1), ("PMOS(", -1), ("VDMOS(pchan ", -1)):
        for is_off in (True, False):
            cards = f"V1 a 0 {-3 * sign}\nR1 a d 1\nM1 d g 0 0 x\nVg g 0 0\n.model x {kind}Vto={2 * sign} Ron=1{' Is=0' if is_off else ' Is=1n'})\n.op"
            done = run(cards)
            checker.check(done.status == 0, f"{cards}\n{done.stderr}")
            if done.status == 0:
                found = done.column("v(d)")[-1] * sign
                checker.check(abs(found + 3) < 1e-9 if is_off else -0.8 < found < -0.4, f"{cards}: {found}")
    for sign, name in ((1, "NMOS"), (-1, "PMOS")):
        for gate, volts in ((5, 1), (0, 2)):
            for drain, source in (("d", "s"), ("s", "d")):
                cards = (f"V1 a 0 {2 * sign}\nR1 a d 1\nVs s 0 0\nM1 {drain} g {source} s x\nVg g 0 {gate * sign}\n"
                         f".model x {name}(Vto={sign} Ron=1)\n.op")
                i = sign * (2 - volts) * (1 if drain == "d" else -1)
                ends(checker, cards, run(cards), {"v(d)": sign * volts, "i(m1)": i}, 1e-7)
        for drain, source in (("d", "s"), ("s", "d")):  # its body diode, with 1 A through it
            cards = f"I1 d 0 {sign}\nVs s 0 0\nM1 {drain} g {source} s x\nVg g 0 0\n.model x {name}(Vto={sign} Ron=1 Is=1n)\n.op"
            done = run(cards)
            ends(checker, cards, done, {"i(m1)": -sign if drain == "d" else sign}, 1e-7)
            if done.status == 0:
                checker.check(-0.7 < sign * done.column("v(d)")[-1] < -0.4, f"{cards}: {done.column('v(d)')}")


def main():
    checker = Checker("model cards")
    for kind in (libraries, symbols, ignored, sources, transistors):
        kind(checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
