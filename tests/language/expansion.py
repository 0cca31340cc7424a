#!/usr/bin/env python3
"""A netlist of parameters and subcircuits gives the same bits as the flat one written by hand.

usage: expansion.py PROGRAM

Each case is a netlist in the language, with its files, and what it means without it. Only the names
in the first line of the output differ.
"""

import itertools
import math
import pathlib
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

RC = """rc
V1 in 0 SIN(0 9 {f})
X1 in out rc r=2k
X2 out last rc r={2*2k} params: c=c0
.subckt rc a b params: r=1k c=1u
R1 a m {r/2}
R2 m b r
C1 b 0 {c}
D1 b 0 clamp
.model clamp d(vfwd={4/r*1k} ron=10)
.ends rc
.param c0=470n f={1/(2*pi*tau)} tau='4k*c0'
.tran 10u 20m
.end
"""
RC_FLAT = """rc
V1 in 0 SIN(0 9 84.65688462334859)
R11 in m1 1k
R12 m1 out 2k
C11 out 0 1u
D11 out 0 clamp1
R21 out m2 2k
R22 m2 last 4k
C21 last 0 470n
D21 last 0 clamp2
.model clamp1 d(vfwd=2 ron=10)
.model clamp2 d(vfwd=1 ron=10)
.tran 10u 20m
.end
"""

NESTED = """nested
.global vdd
V1 vdd 0 PULSE(0 5 0 1u 1u 40u 100u)
Xa out pair k=3
.subckt pair p k=1
.subckt half x y k=1
L1 x s {k*1m} ic=0.5
R1 s y {k*10}
.ends half
X1 vdd m half k={k}
X2 m p half
C1 p gnd 1u
D1 0 p
S1 p 0 vdd 0 sw
.model sw sw(vt=2.5 ron=100)
K1 X1.L1 X2.L1 0.5
F1 p 0 Vs 2
Vs p q 0
Rq q 0 50
.ends
.tran 1u 300u uic
.end
"""
NESTED_FLAT = """nested
V1 vdd 0 PULSE(0 5 0 1u 1u 40u 100u)
L11 vdd s1 3m ic=0.5
R11 s1 m 30
L21 m s2 1m ic=0.5
R21 s2 out 10
C1 out 0 1u
D1 0 out
S1 out 0 vdd 0 sw
.model sw sw(vt=2.5 ron=100)
K1 L11 L21 0.5
F1 out 0 Vs 2
Vs out q 0
Rq q 0 50
.tran 1u 300u uic
.end
"""

CHOICE = """choice
.param mode=2 big={mode > 1}
.if (mode == 1)
.param r=1k
.tran 5u 1m
.model dx d(vfwd=1)
.elseif (big && mode < 3)
.param r={mode*1k}
.tran 5u 2m
.model dx d(vfwd=0.5 ron=1)
.if (r == 2k)
R9 b 0 9k
.else
R9 b 0 8k
.endif
.else
.param r=3k
.endif
V1 a 0 SIN(0 5 1k)
R1 a b {r}
D1 b 0 dx
.end
"""
CHOICE_FLAT = """choice
.model dx d(vfwd=0.5 ron=1)
R9 b 0 9k
V1 a 0 SIN(0 5 1k)
R1 a b 2k
D1 b 0 dx
.tran 5u 2m
.end
"""

FILES = {
    "main.cir": """files
.include "parts/source.inc"
.lib 'parts/models.lib' fast
X1 a b load
R1 b 0 1k
.param amplitude=3
.tran 5u 2m
.end
""",
    "parts/source.inc": """* no title here
V1 a 0 SIN(0 {amplitude} 1k)
.include sub/load.inc
""",
    "parts/sub/load.inc": """.subckt load p q
D1 p q dm
.ends
""",
    "parts/models.lib": """.lib slow
.model dm d(vfwd=0.9)
.endl slow
.LIB Fast
.model dm d(vfwd=0.3)
.endl
Rstray outside of all sections
.lib slow2
.model dm d(vfwd=0.8
.endl
""",
}
FILES_FLAT = """files
V1 a 0 SIN(0 3 1k)
D1 a b dm
.model dm d(vfwd=0.3)
R1 b 0 1k
.tran 5u 2m
.end
"""

FUNCTIONS = """functions
.func par(a,b) {a*b/(a+b)}
.func twice(x) = 2*par(x,x)*k
.param sq(x)={x*x} k=2
.subckt s n
.param k=3
R1 n 0 {twice(1k)}
.ends
V1 a 0 5
R0 a n {twice(1k)}
X1 n s
R3 n 0 {sq(30)}
C1 n 0 {if(k > 1, 1u, 1/0)}
.tran 10u 10m uic
.end
"""
FUNCTIONS_FLAT = """functions
V1 a 0 5
R0 a n 2k
R1 n 0 3k
R3 n 0 900
C1 n 0 1u
.tran 10u 10m uic
.end
"""

# Names are looked up where they are used and then in the callers, as in ngspice.
SCOPES = """scopes
.param r=1k
.subckt inner a
R1 a 0 {r}
.ends
.subckt outer a
.param r=7k
X1 a inner
X2 a inner r={r*2}
.ends
V1 n 0 SIN(0 1 50)
X1 n inner
X2 n outer
X3 n outer r=5k
.tran 1m 20m
.end
"""
SCOPES_FLAT = """scopes
V1 n 0 SIN(0 1 50)
R1 n 0 1k
R2 n 0 7k
R3 n 0 14k
R4 n 0 5k
R5 n 0 10k
.tran 1m 20m
.end
"""

CASES = [("rc", {"main.cir": RC}, RC_FLAT), ("nested", {"main.cir": NESTED}, NESTED_FLAT),
         ("choice", {"main.cir": CHOICE}, CHOICE_FLAT), ("files", FILES, FILES_FLAT),
         ("functions", {"main.cir": FUNCTIONS}, FUNCTIONS_FLAT),
         ("scopes", {"main.cir": SCOPES}, SCOPES_FLAT)]

NAMES = """names
V1 /in 0 10
X1 /in Net-(D1-K) divider
X2 /in Net-_D1-A_ divider
R9 Net-_D1-A_ 0 1k
.subckt divider top mid
R1 top mid 1k
R2 mid tail 1k
V9 tail gnd 0
D1 0 mid
.ends
Fx 0 f1 X2:V9 2
Rf f1 0 1
.save v(x1.tail) v(X1:TAIL) v(x2.mid) i(D:X1:D1) i(d.x1.d1) i(x2.r1) v(f1)
.op
.end
""".replace("Net-(D1-K)", "Net-D1-K")


def write(folder, files, encode=lambda text: text.encode("utf-8")):
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(encode(text))
    return folder / "main.cir"


def rows(run):
    """The output but for its names."""
    return run.output.split(b"\n", 1)[1]


def same_bits(program, checker):
    for name, files, flat in CASES:
        plain = dalcs_program.run(program, flat, method=None)
        checker.check(plain.status == 0, f"{name}, flat: {plain.stderr}")
        with tempfile.TemporaryDirectory() as folder:
            main = write(pathlib.Path(folder), files)
            run = dalcs_program.run(program, main, method=None)
        if checker.check(run.status == 0, f"{name}: {run.stderr}"):
            checker.check(len(run.rows) > 15, f"{name}: {len(run.rows)} rows")
            checker.check(rows(run) == rows(plain), f"{name}: differs from the flat netlist")


def encodings(program, checker):
    """UTF-16 of both orders, with and without a mark, and Latin-1; the micro sign in it. Lines end as on three systems."""
    text = RC.replace("470n", "0.47\u00b5")
    wanted = dalcs_program.run(program, text, method=None)
    for codec in ("utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "latin-1"):
        for mark, end in itertools.product(("", "\ufeff"), ("\n", "\r\n", "\r")):
            if codec in ("utf-8-sig", "utf-16", "latin-1") and mark:
                continue
            with tempfile.TemporaryDirectory() as folder:
                main = write(pathlib.Path(folder), {"main.cir": text},
                             lambda t, c=codec, m=mark, e=end: (m + t).replace("\n", e).encode(c))
                run = dalcs_program.run(program, main, method=None)
            checker.check(run.status == 0, f"{codec}, {end!r}: {run.stderr}")
            checker.check(run.output == wanted.output, f"{codec}, {end!r}: differs from UTF-8")


def mixed_encodings(program, checker):
    """Lines of Latin-1, Windows-1252 and UTF-8 in one file, as programs paste them."""
    micro = RC.replace("470n", "0.47\u00b5")
    wanted = dalcs_program.run(program, micro, method=None).output
    lines = micro.split("\n")
    windows = ("* 5 \u2013 \u201cr\u201d", "; \u20ac 3", "* \u00fc\u00df \u2019 \u2026")
    latin = ("* \u00b5", "; \u00fc\u00df", "* \u00b1 5 %")
    for codecs, comments in ((("latin-1", "utf-8"), latin), (("utf-8", "latin-1"), latin),
                             (("cp1252", "cp1252"), windows), (("cp1252", "utf-8"), windows),
                             (("utf-8", "cp1252"), windows)):
        for comment in comments:
            data = b"\n".join(line.encode(codecs[k % 2]) for k, line in
                              enumerate([lines[0]] + [comment] + lines[1:]))
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "main.cir"
                path.write_bytes(data)
                run = dalcs_program.run(program, path, method=None)
            checker.check(run.status == 0 and run.output == wanted,
                          f"{codecs}, {comment!r}: {run.status}\n{run.stderr}")


def names(program, checker):
    run = dalcs_program.run(program, NAMES, method=None)
    checker.check(run.status == 0, run.stderr)
    checker.check(run.names == ["time", "v(x1.tail)", "v(net-_d1-a_)", "i(x1.d1)", "i(x2.r1)",
                                "v(f1)"], f"names: {run.names}")
    checker.close(run.column("v(net-_d1-a_)")[0], 10 / 3, 1e-14, "the voltage of a port")
    checker.close(run.column("v(f1)")[0], 2 * 10 / 3 / 1e3, 1e-14, "F by x2.v9")


def closed_form(program, checker):
    """A chain of RC sections as one subcircuit that holds itself n times is 1 - exp at no load."""
    text = ("charge\nV1 a 0 1\n.param tau=3m r=2k\n.subckt rc a b r=1 c=1\n"
            "R1 a b {r}\nC1 b 0 {c} ic=0\n.ends\nX1 a b rc r={r} c={tau/r}\n"
            ".tran {tau/10} {5*tau} uic\n.end\n")
    run = dalcs_program.run(program, text, method=None, tolerance=1e-9)
    checker.check(run.status == 0, run.stderr)
    for k, t in enumerate(run.time):
        checker.close(run.column("v(b)")[k], 1 - math.exp(-t / 3e-3), 1e-8, f"v(b) at {t}")


def untouched(program, checker):
    """A netlist with errors, in a file that it includes, leaves the output file alone."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        main = write(folder, {"main.cir": "t\n.include a.inc\nR1 a 0 1\n.op\n",
                              "a.inc": "V1 a 0 {nobody}\n"})
        (folder / "keep.csv").write_text("old")
        run = dalcs_program.run(program, main, method=None,
                                options=["-o", str(folder / "keep.csv")])
        checker.check(run.status == 3, f"errors in an included file: status {run.status}")
        checker.check((folder / "keep.csv").read_text() == "old", "the output was touched")
        checker.check("a.inc:1:9: error: there is no parameter 'nobody'" in run.stderr and
                      "included from" in run.stderr, run.stderr)


def joined(program, checker):
    """Braces over many lines: comments between them do not count, and the time is that of reading."""
    run = dalcs_program.run(program, "t\n.param s={1 + ; one, it's {said\n+ 2*max(3, $ three\n"
                            "; nothing\n// and\n* nothing\n+ 4) // four }\n+ - 6} ; all of it\n"
                            "I1 0 a {s}\nR1 a 0 1\n.op\n.end\n", method=None)
    checker.check(run.status == 0, run.stderr)
    checker.close(run.column("v(a)")[0], 3.0, 1e-12, "comments in an expression of many lines")
    n = 60000
    begin = time.monotonic()
    run = dalcs_program.run(program, "t\nV1 a 0 1\nR1 a 0 {max(0\n" +
                            "+ , 1    , 2    , 3    , 4    , 5\n" * n + "+ )}\n.op\n.end\n",
                            method=None)
    checker.check("'max' takes at most 1000 arguments, not 300001" in run.stderr, run.stderr[-300:])
    checker.check(time.monotonic() - begin < 20, f"{n} lines in one brace take too long")


def large(program, checker):
    """Ten thousand instances, a chain of parameters in reverse, a deep tower of calls."""
    text = ["large", ".param r=1k", ".subckt s a b r=1", "R1 a m {r}", "R2 m b {r}", ".ends"]
    text += [f"X{k} n{k} n{k + 1} s r={{r*2}}" for k in range(10000)]
    text += ["V1 n0 0 1", "Rl n10000 0 1k"]
    text += [f".param p{k}={{p{k + 1}+1}}" for k in range(5000)] + [".param p5000=0"]
    text += ["R9 q 0 {p0}", "I9 0 q 1"]
    text += [f".subckt t{k} a\nX1 a t{k + 1}\n.ends" for k in range(150)]
    text += [".subckt t150 a\nR1 a 0 2\n.ends", "X_t q2 t0", "I2 0 q2 1"]
    text += [".save v(q) v(q2) v(n10000)", ".op", ".end"]
    run = dalcs_program.run(program, "\n".join(text) + "\n", method=None)
    checker.check(run.status == 0, run.stderr[-500:])
    checker.close(run.column("v(q)")[0], 5000.0, 1e-9, "a chain of parameters")
    checker.close(run.column("v(q2)")[0], 2.0, 1e-12, "a tower of subcircuits")
    checker.close(run.column("v(n10000)")[0], 1 / 40001, 1e-9, "a chain of subcircuits")


def main():
    checker = dalcs_program.Checker("expansion")
    for test in (same_bits, encodings, mixed_encodings, names, closed_form, untouched, joined, large):
        test(sys.argv[1], checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
