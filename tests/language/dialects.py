#!/usr/bin/env python3
"""What dialect= and --dialect change: the same bits as the netlist written without a dialect.

usage: dialects.py PROGRAM

Each case is a netlist, the options of its run, what it means without a dialect, and how often it
warns. Messages word by word are in tests/errors/dialect_*.
"""

import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

NUMBERS = """numbers
.param c=1u5 scale={log(1000)}
V1 in 0 SIN(0 {scale} 1k)
R1 in a 4k7
R2 a 0 2R2
R3 a b 1meg2
R4 b 0 -3V3Ohm
C1 b 0 {c}
.tran 10u 1m
.end
"""
NUMBERS_FLAT = """numbers
V1 in 0 SIN(0 6.907755278982137 1k)
R1 in a 4.7k
R2 a 0 2.2
R3 a b 1.2meg
R4 b 0 -3.3
C1 b 0 1.5u
.tran 10u 1m
.end
"""

# One coil has its Rser, one has none of it, two are coupled: LTspice adds 1 mohm to L1 and L6 only.
COILS = """coils
V1 in 0 PULSE(0 1 0 1u 1u 3u 7u)
L1 in a 1m
L2 a b 1m Rser=0
L3 b c 1m
L4 d 0 1m
K1 L3 L4 0.5
L5 c e 1m Rser=0.2
L6 e 0 1m m=4 Rpar=50 IC=1
Rd d 0 1
.save i(l1) i(l6) v(a) v(e) v(d)
.tran 1u 50u uic
.end
"""
COILS_FLAT = """coils
V1 in 0 PULSE(0 1 0 1u 1u 3u 7u)
L1 in a 1m Rser=1m
L2 a b 1m Rser=0
L3 b c 1m Rser=0
L4 d 0 1m Rser=0
K1 L3 L4 0.5
L5 c e 1m Rser=0.2
L6 e 0 1m m=4 Rpar=50 Rser=1m IC=1
Rd d 0 1
.save i(l1) i(l6) v(a) v(e) v(d)
.tran 1u 50u uic
.options dialect=ngspice
.end
"""

XYCE = """xyce
.param r={1x/1k}
V1 in 0 SIN(0 {log(1000)} 1k)
R1 in a 2Xohm
R2 a 0 {r}
C1 a 0 10n
.tran 1n 1m
.meas tran level PARAM='log(100)'
.end
"""
XYCE_FLAT = """xyce
V1 in 0 SIN(0 3 1k)
R1 in a 2meg
R2 a 0 1k
C1 a 0 10n
.tran 0 1m
.end
"""

# A function of the netlist's own is not that of the dialect.
OWN_LOG = """own log
.func log(x) {2*x}
V1 a 0 {log(5)}
R1 a 0 1k
.tran 10u 1m
.end
"""
OWN_LOG_FLAT = """own log
V1 a 0 10
R1 a 0 1k
.tran 0 1m
.end
"""

POWER = """power
.param x={2^3}
V1 a 0 {x + log(1)}
R1 a 0 1x
.tran 10u 1m
.end
"""
POWER_FLAT = """power
V1 a 0 8
R1 a 0 1
.tran 10u 1m
.end
"""


def told(text, name):
    title, rest = text.split("\n", 1)
    return f"{title}\n.options dialect={name}\n{rest}"


def shown(text, card):
    title, rest = text.split("\n", 1)
    return f"{title}\n{card}\n{rest}"


RSER = "V9 in x 0 Rser=1\nR9 x 0 1k"

# A power of a negative voltage: ngspice alone gives pwr its sign.
PWR = """pwr
V1 in 0 SIN(0 2 1k)
B1 a 0 V=pwr(v(in),3)
R1 a 0 1k
B2 0 b I=1m*pwr(2*v(in)+v(b),{y})
R2 b 0 100
C2 b 0 1u
B3 c 0 V=pwr(8,1/3)
R3 c 0 1k
.param y=1.5
.tran 10u 1m
.end
"""
# Other powers of it, which are those of the magnitude in ngspice. Even ones are the same, and so are those of numbers.
POWERS = """powers
V1 in 0 SIN(0 2 1k)
B1 a 0 V=v(in)**3
R1 a 0 1k
B2 b 0 V=pow(2*v(in)+1,{y})
R2 b 0 100
B3 c 0 V=pow(2,3)+2**3+v(in)**2+pow(v(in),4)
R3 c 0 1k
.param y=3
.tran 10u 1m
.end
"""
POWERS_OF_MAGNITUDE = POWERS.replace("v(in)**3", "pwr(v(in),3)").replace("pow(2", "pwr(2")

PWR_SIGNED = PWR.replace("pwr(v", "pwrs(v").replace("pwr(2", "pwrs(2")

# Netlist, options, the same without a dialect, and how often it warns.
CASES = [
    ("numbers, told", told(NUMBERS, "ltspice"), [], NUMBERS_FLAT, 0),
    ("numbers, by the command line", NUMBERS, ["--dialect", "ltspice"], NUMBERS_FLAT, 0),
    ("numbers, shown", shown(NUMBERS, RSER), [], shown(NUMBERS_FLAT, RSER), 6),
    ("coils, told", told(COILS, "ltspice"), [], COILS_FLAT, 0),
    ("coils, shown", COILS, [], COILS_FLAT.replace("Rser=1m", ""), 0),
    ("coils, the command line comes first", told(COILS, "xyce"), ["--dialect", "ltspice"],
     COILS_FLAT, 0),
    ("xyce, told", told(XYCE, "xyce"), [], XYCE_FLAT, 0),
    ("xyce, shown", shown(XYCE, ".global_param zz=1"), [], XYCE_FLAT, 4),
    ("xyce, own log", told(OWN_LOG, "xyce"), [], OWN_LOG_FLAT, 0),
    ("power, nothing said", POWER, [], POWER_FLAT, 3),
    ("power, ngspice", told(POWER, "ngspice"), [], POWER_FLAT, 0),
    ("power, ngspice by the command line", told(POWER, "ltspice"), ["--dialect", "ngspice"],
     POWER_FLAT, 0),
    ("pwr, nothing said", PWR, [], PWR, 1),
    ("pwr, ltspice", PWR, ["--dialect", "ltspice"], PWR, 0),
    ("pwr, ltspice shown", shown(PWR, RSER), [], shown(PWR, RSER), 0),
    ("pwr, ngspice", told(PWR, "ngspice"), [], PWR_SIGNED, 0),
    ("powers, nothing said", POWERS, [], POWERS, 1),
    ("powers, ltspice", POWERS, ["--dialect", "ltspice"], POWERS, 0),
    ("powers, ngspice", told(POWERS, "ngspice"), [], POWERS_OF_MAGNITUDE, 0),
    ("pwr, ngspice by the command line", PWR, ["--dialect", "ngspice"], PWR_SIGNED, 0),
]


def same_bits(program, checker):
    for what, text, options, flat, n_warnings in CASES:
        run = dalcs_program.run(program, text, method=None, options=options)
        plain = dalcs_program.run(program, flat, method=None)
        checker.check(run.status == 0 and plain.status == 0 and run.output == plain.output,
                      f"{what}: {run.stderr}")
        checker.check(run.stderr.count(": warning: ") == n_warnings, f"{what}: {run.stderr}")


def exclusive_or(program, checker):
    """No number is safe where LTspice has an exclusive or and most people mean a power."""
    run = dalcs_program.run(program, POWER, method=None, options=["--dialect", "ltspice"])
    checker.check(run.status == 3 and "exclusive or" in run.stderr, f"power: {run.stderr}")


def measured(program, checker):
    run = dalcs_program.run(program, XYCE, method=None, options=["--dialect", "xyce"])
    found = [m["value"] for m in run.report["measurements"]]
    checker.check(found == [2], f"log10 in .meas: {found}")


def command(program, folder, verb, name, *options):
    return subprocess.run([program, verb, name, *options], cwd=folder, capture_output=True,
                          text=True, check=False)


def verbs(program, checker):
    """Each verb that reads a netlist takes --dialect; a wrong name is a wrong command line."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "d.cir").write_text(NUMBERS, encoding="utf-8")
        for verb, *options in (["run"], ["-b"], ["check"], ["equations"],
                               ["converge", "--steps", "100u,50u"]):
            plain = command(program, folder, verb, "d.cir", *options)
            done = command(program, folder, verb, "d.cir", *options, "--dialect", "ltspice")
            checker.check(plain.returncode == 3 and "'4k7' is not a number" in plain.stderr,
                          f"{verb}: {plain.stderr}")
            checker.check(done.returncode == 0, f"{verb} --dialect: {done.stderr}")
            wrong = command(program, folder, verb, "d.cir", *options, "--dialect", "hspice")
            checker.check(wrong.returncode == 2 and "the dialects are: ngspice ltspice xyce" in
                          wrong.stderr, f"{verb} --dialect hspice: {wrong.stderr}")
        wrong = command(program, folder, "compare", "d.cir", "--dialect", "hspice")
        checker.check(wrong.returncode == 2 and "unknown dialect" in wrong.stderr,
                      f"compare: {wrong.stderr}")


def said_once(program, checker):
    """What a netlist shows is one note, though .step builds the circuit three times."""
    steps = POWER.replace("2^3", "2**3").replace(".end", ".step param x 1 3 1\n.end")
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "s.cir").write_text(steps, encoding="utf-8")
        done = command(program, folder, "run", "s.cir")
        checker.check(done.stderr.count("s.cir:6:1: note: '.step' is not ngspice's: the netlist is "
                                        "taken for one of LTspice") == 1, f"steps: {done.stderr}")


def main():
    checker = dalcs_program.Checker("dialects")
    for test in (same_bits, exclusive_or, measured, verbs, said_once):
        test(pathlib.Path(sys.argv[1]).absolute(), checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
