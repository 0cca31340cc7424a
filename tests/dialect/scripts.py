#!/usr/bin/env python3
"""Analyses, measurements and .control blocks as ngspice and LTspice have them: each way of writing one against its value.

usage: scripts.py PROGRAM
"""

import csv
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, kinds_of  # noqa: E402


def run(program, text, suffix="csv"):
    """The exit status, stdout, stderr, and the output file."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "circuit.cir"
        path.write_text(text)
        out = path.with_suffix("." + suffix)
        done = subprocess.run([str(program), "run", str(path), "-o", str(out)], capture_output=True,
                              text=True, check=False, timeout=30)
        return done.returncode, done.stdout, done.stderr, out.read_bytes() if out.exists() else b""


def measured(text, name):
    """All values of a measurement of this name, as they are printed."""
    return [float(value) for value in re.findall(rf"(?m)^\s*{name}\s*=\s*(\S+)", text)]


class Checks(Checker):
    def __init__(self, program):
        super().__init__("scripts")
        self.program = program

    def prints(self, kind, text, wanted):
        """Does stdout hold these numbers, one a line of the form name = number?"""
        status, out, err, _ = run(self.program, f"{kind}\n{text}.end\n")
        found = [float(v) for v in re.findall(r"(?m)=\s*([-+0-9.e]+)\s*$", out)]
        self.check(status == 0, f"{kind}: ends with {status}\n{text}{err}")
        good = len(found) == len(wanted) and all(
            abs(f - w) <= 1e-6 * max(abs(w), 1e-6) for f, w in zip(found, wanted))
        self.check(good, f"{kind}: prints {found}, not {wanted}\n{text}{out}{err}")
        return err

    def measures(self, kind, text, name, wanted):
        status, out, err, _ = run(self.program, f"{kind}\n{text}.end\n")
        found = measured(out, name)
        self.check(status == 0, f"{kind}: ends with {status}\n{text}{err}")
        good = len(found) == len(wanted) and all(
            abs(f - w) <= 1e-6 * max(abs(w), 1e-9) for f, w in zip(found, wanted))
        self.check(good, f"{kind}: {name} is {found}, not {wanted}\n{text}{out}{err}")


DIVIDER = ".param k=1 f=50\nV1 a 0 1\nR1 a b {k*1k}\nR2 b 0 d 1k\n.model d R\n" \
          "D9 z 0 m\nI9 0 z 1\n.model m D(Ron=3)\n"


def alters(c):
    """Another value, with the equal sign and without."""
    for line, wanted in (
            ("alter r1 2k", 1 / 3), ("alter r1 = 2k", 1 / 3), ("alter R1 2k", 1 / 3),
            ("alter r1  2000", 1 / 3), ("alter r1 1k+1k", 1 / 3), ("alter r1 2*1k", 1 / 3),
            ("alter @r1[resistance] 2k", 1 / 3), ("alter @r1[resistance] = 2k", 1 / 3),
            ("alter r1 resistance 2k", 1 / 3), ("alter r1 resistance = 2k", 1 / 3),
            ("alter v1 dc 2", 1.0), ("alter v1 dc = 2", 1.0), ("alter v1 2", 1.0),
            ("set x=2k\nalter r1 $x", 1 / 3), ("let x=2k\nalter r1 $&x", 1 / 3),
            ("alterparam k 2\nreset", 1 / 3), ("alterparam k = 2\nreset", 1 / 3)):
        c.prints("alter", DIVIDER + f".control\n{line}\nop\nprint v(b)\n.endc\n", [wanted])
    for line in ("altermod m ron 5", "altermod m ron = 5", "altermod @m[ron] = 5", "altermod m RON 5",
                 "altermod m ron 2+3"):
        c.prints("altermod", DIVIDER + f".control\n{line}\nop\nprint v(z)\n.endc\n", [5.0])
    # A card that has its values behind blanks is altered as well.
    c.prints("altermod", DIVIDER.replace("D(Ron=3)", "D(Ron 3)") +
             ".control\naltermod m ron = 5\nop\nprint v(z)\n.endc\n", [5.0])
    for line in ("alter", "alter r1", "alter r1 =", "altermod m ron", "alterparam k"):
        status, _, err, _ = run(c.program, f"x\n{DIVIDER}.control\n{line}\nop\n.endc\n.end\n")
        c.check(status == 3 and "missing" in err, f"'{line}' ends with {status}: {err}")


def loops(c):
    """A list that is a vector, and other scripts."""
    for line, wanted in (
            ("let t = vector(3)\nforeach n $&t\nlet y = $n\nprint y\nend", [0, 1, 2]),
            ("let t = vector(3)+1\nforeach n $&t\nlet y = $n\nprint y\nend", [1, 2, 3]),
            ("let t = 7\nforeach n $&t\nlet y = $n\nprint y\nend", [7]),
            ("let t = vector(2)\nforeach n 5 $&t 9\nlet y = $n\nprint y\nend", [5, 0, 1, 9]),
            ("let t = vector(2)\nlet u = vector(2)*10\nforeach n $&t $&u\nlet y = $n\nprint y\nend",
             [0, 1, 0, 10]),
            ("let t = unitvec(2)\nforeach n $&t\nlet y = $n\nprint y\nend", [1, 1]),
            ("let t = -vector(2)/4\nforeach n $&t\nlet y = $n\nprint y\nend", [0, -0.25]),
            ("let t = vector(2)*1e-9\nforeach n $&t\nlet y = $n\nprint y\nend", [0, 1e-9]),
            ("let t = vector(2)\nforeach n ( $&t )\nlet y = $n\nprint y\nend", [0, 1]),
            ("let t = vector(2)\nforeach m $&t\nforeach n $&t\nlet y = $n+10*$m\nprint y\nend\nend",
             [0, 1, 10, 11])):
        c.prints("foreach", DIVIDER + f".control\nop\n{line}\n.endc\n", wanted)
    err = c.prints("a card in a script", DIVIDER + ".control\nop\n.print op v(a)\n.print op v(b)\n"
                   "print v(b)\n.endc\n", [0.5])
    c.check(err.count("is a card, not a command") == 1, err)
    for line in (".op", ".tran 1u 1m", ".save v(a)", ".ic v(a)=1", ".foo"):
        c.prints("a card in a script", DIVIDER + f".control\nop\n{line}\nprint v(b)\n.endc\n", [0.5])
    for line in ("set", "set\nset x=1\nset", "set \nset y", "set filetype=ascii\nset"):
        c.prints("set alone", DIVIDER + f".control\nop\n{line}\nprint v(b)\n.endc\n", [0.5])
    status, out, _, _ = run(c.program, f"x\n{DIVIDER}.control\nop\nset myvar=12\nset\n.endc\n.end\n")
    c.check(status == 0 and re.search(r"(?m)^myvar\s+12$", out), f"set lists {out}")
    for card, wanted in ((".csparam f={f}", 50), (".csparam f={2*f}", 100), (".csparam f='f/2'", 25),
                         (".csparam g={f+1} f={f}", 50), (".csparam f {f}", 50), (".csparam f=f", 50)):
        name = "f"
        c.prints("csparam", DIVIDER + f"{card}\n.control\nop\nlet y = $&{name}\nprint y\n.endc\n", [wanted])
    c.prints("csparam", DIVIDER + ".csparam g={f+1}\n.control\nop\nlet y = $&g\nprint y\n.endc\n", [51])
    # What the script is given does not change the netlist.
    c.prints("csparam", DIVIDER + ".csparam k={3*k}\n.control\nop\nprint v(b)\n.endc\n", [0.5])


SINE = "V1 a 0 SIN(0 1 50)\nR1 a b 1k\nC1 b 0 1p\n"


def measurements(c):
    """Of one name, without FIND, of complex signals."""
    first, second = math.asin(0.5) / (100 * math.pi), 0.02 + math.asin(0.5) / (100 * math.pi)
    c.measures("two of one name", SINE + ".tran 1m 50m\n.meas tran t1 WHEN v(a)=0.5 RISE=1\n"
               ".meas tran t1 WHEN v(a)=0.5 RISE=2\n", "t1", [first, second])
    c.measures("two of one name", SINE + ".tran 1m 50m\n.meas t1 WHEN v(a)=0.5 RISE=1\n"
               ".meas t1 WHEN v(a)=0.5 RISE=2\n.meas d PARAM='2*t1'\n", "d", [2 * second])
    c.measures("two of one name", SINE + ".tran 1m 50m\n.meas m MAX v(a)\n.meas m MIN v(a)\n"
               ".meas m PP v(a)\n", "m", [1, -1, 2])
    for line, wanted in (
            ("t1 time when v(a)=0.5 rise=1", first), ("t1 time WHEN v(a)=0.5 RISE=2", second),
            ("t1 time when v(a)=0 rise=last", 0.04), ("t1 FIND time WHEN v(a)=0.5 RISE=1", first),
            ("t1 v(a) at=5m", 1.0), ("t1 v(a)*2 at=5m", 2.0), ("t1 {v(a)*2} at=5m", 2.0),
            ("t1 'v(a)+1' at=5m", 2.0), ("t1 v(a)+1 when time=5m", 2.0),
            ("t1 i(r1) at 5m", 0.0), ("t1 2*time when v(a)=0.5 cross=1", 2 * first)):
        c.measures("without FIND", SINE.replace("1p", "0") + f".tran 1m 50m\n.meas tran {line}\n", "t1",
                   [wanted])
    w = 2 * math.pi * 1e3 * 1e-3
    filter_ = "V1 a 0 AC 1\nR1 a b 1k\nC1 b 0 1u\n"
    low, at = 1 / complex(1, 2 * math.pi * 1e-3), 1 / complex(1, w)
    for line, wanted in (
            ("max mag(v(b))", abs(low)), ("min mag(v(b))", abs(at)), ("min vm(b)", abs(at)),
            ("find mag(v(b)) at=1k", abs(at)), ("find MAG(V(b)) at=1k", abs(at)),
            ("find mag( v(b) ) at=1k", abs(at)), ("find re(v(b)) at=1k", at.real),
            ("find im(v(b)) at=1k", at.imag), ("find imag(v(b))*2 at=1k", 2 * at.imag),
            ("find db(v(b)) at=1k", 20 * math.log10(abs(at))), ("find abs(v(b)) at=1k", abs(at)),
            ("find ph(v(b)) at=1k", math.degrees(math.atan2(at.imag, at.real))),
            ("find mag(v(a,b)) at=1k", abs(1 - at)), ("find mag(i(r1))*1k at=1k", abs(1 - at))):
        c.measures("of complex signals", filter_ + f".ac dec 10 1 1k\n.meas ac p {line}\n", "p", [wanted])
    for line, words in (("max mag(v(a)-v(b))", "sum of complex signals"), ("max mog(v(b))", "no function")):
        status, said, err, _ = run(c.program, f"x\n{filter_}.ac dec 10 1 1k\n.meas ac p {line}\n.end\n")
        c.check(status == 0 and words in err and "the measurement 'p' fails" in err and "=  failed" in said, f"'{line}' ends with {status}: {err}")


def frequencies(c):
    """A list of them, in any order."""
    for card, wanted in ((".ac list 100 1k 10k", [100, 1e3, 1e4]), (".ac LIST 1k", [1e3]),
                         (".ac list 10k 100", [1e4, 100]), (".ac list 1,2,3", [1, 2, 3]),
                         (".ac list {f} {2*f}", [50, 100]), (".ac list 0 1", [0, 1]),
                         (".ac list 1Meg 2meg", [1e6, 2e6]), (".ac list '3*f'", [150]),
                         (".ac list=1 2", [1, 2]), (".ac list 7 7", [7, 7])):
        status, _, err, out = run(c.program, f"x\n.param f=50\nV1 a 0 AC 1\nR1 a b 1k\nC1 b 0 1u\n"
                                  f"{card}\n.save v(b)\n.end\n")
        rows = [[float(v) for v in line.split(",")] for line in out.decode().splitlines()[1:]]
        good = [r[0] for r in rows] == wanted and all(
            abs(complex(r[1], r[2]) - 1 / complex(1, 2e-3 * math.pi * r[0])) < 1e-12 for r in rows)
        c.check(status == 0 and good, f"'{card}' ends with {status}: {rows}\n{err}")
    for card, words in ((".ac list", "missing"), (".ac list -1", "negative"), (".ac lis 1", "dec, oct")):
        status, _, err, _ = run(c.program, f"x\nV1 a 0 AC 1\nR1 a 0 1k\n{card}\n.end\n")
        c.check(status == 3 and words in err, f"'{card}' ends with {status}: {err}")


def second_analyses(c):
    """Each runs; a raw file holds all."""
    rc = "V1 a 0 DC 1 AC 1 SIN(0 1 50)\nR1 a b 1k\nC1 b 0 1u\n.param t=10m\n"
    for cards, wanted in (
            (".tran 1m 10m\n.tran 1m 40m\n", ["Transient"] * 2),
            (".tran 1m 10m\n.tran 1m 20m\n.tran 1m 40m\n", ["Transient"] * 3),
            (".op\n.tran 1m 10m\n.tran 1m 40m\n", ["Operating", "Transient", "Transient"]),
            (".tran 1m 10m\n.op\n.op\n", ["Operating", "Transient", "Operating"]),
            (".ac dec 10 1 1k\n.ac dec 10 1k 1meg\n", ["AC"] * 2),
            (".dc V1 0 1 0.5\n.dc V1 0 2 1\n", ["DC"] * 2),
            (".tran 1m {t}\n.tran 1m {2*t}\n", ["Transient"] * 2),
            (".tran 1m 10m uic\n.tran 1m 40m 20m\n", ["Transient"] * 2),
            (".tran 1m 10m\n.tran 1m\n+ 40m\n", ["Transient"] * 2),
            (".tran 1m 10m\n.ac list 1 2\n.TRAN 1m 40m\n", ["AC", "Transient", "Transient"])):
        status, _, err, out = run(c.program, f"x\n{rc}{cards}.end\n", "raw")
        found = [name.decode() for name in re.findall(rb"Plotname: (\w+)", out)]
        c.check(status == 0 and found == wanted, f"'{cards}' ends with {status}: {found}\n{err}")


def printed_formulas(c):
    """Columns of formulas: sums of signals with constant factors; others are left out."""
    body = ".param k=2\nV1 a 0 3\nR1 a b 1k\nR2 b 0 2k\nX1 b s\n.subckt s p\nR1 p q 1k\nR2 q 0 1k\n{inner}.ends\n"
    for word, wanted in (
            ("{v(a)-v(b)}", 1.5), ("{v(b)*2+1}", 4.0), ("{2*v(b)+1}", 4.0), ("{v(b)/3}", 0.5),
            ("{-v(b)}", -1.5), ("{v(a,b)*k}", 3.0), ("{i(r1)*1k}", 1.5), ("par('v(a)-v(b)')", 1.5),
            ("x=par('v(a)-v(b)')", 1.5), ("{ V(A) - v(b) }", 1.5), ("{v(x1.q)*2}", 1.5), ("{k*3}", 6.0),
            ("{(v(a)+v(b))/(1+2)}", 1.5), ("{v(a)-(v(b)-1)}", 2.5)):
        for card in (".print op", ".plot op", ".save", ".probe"):
            status, _, err, out = run(c.program, f"x\n{body.format(inner='')}.op\n{card} v(a) {word}\n.end\n")
            lines = out.decode().splitlines()
            good = len(lines) > 1 and abs(float(lines[1].split(",")[-1]) - wanted) < 1e-9
            c.check(status == 0 and good and "one connection" not in err, f"'{card} {word}' ends with {status}: {lines}\n{err}")
    for word, wanted in (
            ("{v(a)*v(b)}", 4.5), ("{v(a)**2}", 9.0), ("{abs(v(b)-v(a))}", 1.5), ("{sin(v(a))}", math.sin(3)),
            ("{v(a)*i(v1)}", -4.5e-3), ("{1/v(a)}", 1 / 3), ("par('k*v(a)*v(b)')", 9.0),
            ("{v(a) > v(b) ? 1 : 2}", 1.0), ("{v(a) < v(b) ? 1 : 2}", 2.0), ("{max(v(a), v(b), 5)}", 5.0),
            ("{v(b) > 1 && v(a) > 5}", 0.0), ("{v(b) > 1 || v(a) > 5}", 1.0), ("{-v(x1.q)**2}", -0.5625),
            ("w(r1)", 2.25e-3), ("p(r2)", 1.125e-3), ("w(x1.r1)", 0.5625e-3), ("w(v1)", -4.5e-3)):
        for card in (".print op", ".plot op", ".save", ".probe"):
            status, _, err, out = run(c.program, f"x\n{body.format(inner='')}.op\n{card} v(a) {word} v(b)\n.end\n")
            lines = [line.split(",v(a),")[-1] for line in out.decode().splitlines()]
            found = next(csv.reader([out.decode().splitlines()[1]])) if len(lines) > 1 else []
            good = len(found) == 4 and abs(float(found[2]) - wanted) < 1e-12 + 1e-9 * abs(wanted)
            c.check(status == 0 and good and "left out" not in err, f"'{card} {word}' ends with {status}: {found}\n{err}")
    for word in ("{sdt(v(a))}", "{delay(v(a),1m)}"):
        status, _, err, out = run(c.program, f"x\n{body.format(inner='')}.op\n.print op v(a) {word} v(b)\n.end\n")
        c.check("left out" in err or status == 3, f"{word}: {status} {err}")
    status, _, err, out = run(c.program, f"x\n{body.format(inner='.print op {v(p)-v(q)} v(q)' + chr(10))}.op\n.end\n")
    lines = out.decode().splitlines()
    c.check(status == 0 and len(lines) == 2 and abs(float(lines[1].split(",")[-2]) - 0.75) < 1e-9, f"{lines} {err}")
    # Each analysis has them, in the order of the cards; .ac of magnitudes, as .meas ac.
    wave = "V1 a 0 DC 1 AC 2 SIN(0 3 50)\nR1 a 0 2\nR2 a b 1\nR3 b 0 1\n.save {v(a)*v(b)} v(b) w(r1)\n"
    for card, columns, wanted in (
            (".tran 1m 5m", ["{v(a)*v(b)}", "v(b)", "w(r1)"], [5, 4.5, 1.5, 4.5]),
            (".ac lin 1 50 50", ["re({v(a)*v(b)})", "im({v(a)*v(b)})", "re(v(b))", "im(v(b))", "re(w(r1))", "im(w(r1))"],
             [50, 2, 0, 1, 0, 2, 0]),
            (".dc V1 0 2 1 R1 1 4 3", ["r1", "{v(a)*v(b)}", "v(b)", "w(r1)"], [2, 4, 2, 1, 1]),
            (".tran 1m 5m\n.step V1 list 1 2", ["{v(a)*v(b)}", "v(b)", "w(r1)"], [5, 4.5, 1.5, 4.5]),
            (".pss 50", ["{v(a)*v(b)}", "v(b)", "w(r1)"], None)):
        status, _, err, out = run(c.program, f"x\n{wave}{card}\n.end\n")
        lines = list(csv.reader(out.decode().splitlines()))
        names = lines[0] if lines else []
        c.check(status == 0 and [n.replace(" ", "") for n in names[-len(columns):]] == columns, f"{card}: {names} {err}")
        values = [[float(x) for x in line] for line in lines[1:]]
        at = [v for v in values if wanted and abs(v[0 if ".step" not in card else 1] - wanted[0] * (1e-3 if wanted[0] == 5 else 1)) < 1e-9]
        got = at[-1][-len(columns):] if at else []
        c.check(wanted is None or (len(got) == len(columns) and all(abs(x - y) < 1e-9 for x, y in zip(got, wanted[1:]))),
                f"{card}: {got}, not {wanted}")
    # A formula that is recorded changes nothing else.
    plain = run(c.program, f"x\n{body.format(inner='')}.op\n.end\n")[3].decode().splitlines()
    more = run(c.program, f"x\n{body.format(inner='')}.op\n.save all {{v(a)-v(b)}}\n.end\n")[3].decode().splitlines()
    c.check(more[0].startswith(plain[0]) and more[1].startswith(plain[1]), f"{plain} {more}")


def dowhiles(c):
    for line, wanted in [
            ("let k = 0\ndowhile k < 3\nlet k = k+1\nend\nprint k", [3]),
            ("let k = 9\ndowhile k < 3\nlet k = k+1\nend\nprint k", [10]),  # once in any case
            ("let k = 9\nwhile k < 3\nlet k = k+1\nend\nprint k", [9]),
            ("let k = 0\ndowhile k < 5\nlet k = k+1\nif k = 2\nbreak\nend\nend\nprint k", [2]),
            ("let k = 0\nlet n = 0\ndowhile k < 5\nlet k = k+1\nif k = 2\ncontinue\nend\n"
             "let n = n+k\nend\nprint n", [13]),
            ("let k = 0\nlet n = 0\ndowhile k < 2\nlet k = k+1\nlet j = 0\ndowhile j < 3\n"
             "let j = j+1\nlet n = n+1\nend\nend\nprint n", [6]),
            ("let k = 1e-9\ndowhile k < 5e-9\nlet k = 2*k\nend\nprint k", [8e-9]),
            ("let k = 0\ndowhile 0\nlet k = k+1\nend\nprint k", [1]),
            ("let k = 0\ndowhile 0\nquit\nend\nprint k", []),
            ("set n = 1\ndowhile v(b) > 0.3\nlet j = $n+1\nset n = $&j\nalterparam k = $n\nop\nend\n"
             "print v(b)", [0.25])]:
        c.prints("dowhile", DIVIDER + f".control\nop\n{line}\n.endc\n", wanted)


def elements(c):
    for line, wanted in [
            ("let x = vector(3)\nlet x[1] = 7\nprint x[0] x[1] x[2]", [0, 7, 2]),
            ("let x = unitvec(2)\nlet x[0] = x[1]+4\nprint x[0]", [5]),
            ("let x = vector(4)\nlet k = 3\nlet x[k] = 1e-9\nprint x[3]", [1e-9]),
            ("let x = vector(4)\nlet k = 1\nlet x[2*k+1] = -k\nprint x[3]", [-1]),
            ("let x = vector(4)\nlet x[ 2 ] = 5\nprint x[2]", [5]),
            ("let x = 3\nlet x[0] = 8\nprint x", [8]),
            ("let x = vector(3)\nlet k = 0\nwhile k < 3\nlet x[k] = k*k\nlet k = k+1\nend\n"
             "print mean(x)", [5 / 3]),
            ("let x = vector(2)\nforeach r 1k 3k\nalterparam k = $r\nop\nlet x[($r-1k)/2k] = $r\nend\n"
             "print x[0] x[1]", [1000, 3000]),
            ("let x = vector(3)\nlet x[x[2]] = 6\nprint x[2]", [6]),
            ("let x = vector(3)\nlet y = x\nlet x[0] = 6\nprint y[0]", [0])]:
        # before the first run, so that all later ones can see it
        c.prints("element", DIVIDER + f".control\n{line}\n.endc\n", wanted)
    for line, message in [
            ("let x = vector(3)\nlet x[3] = 1", "index 3 of a vector of length 3"),
            ("let x = vector(3)\nlet x[-1] = 1", "index -1 of a vector"),
            ("let y[0] = 1", "there is no vector 'y'"),
            ("let x = vector(3)\nlet x[1 = 1", "an index, ']' and '=' are missing"),
            ("let x = vector(3)\nlet x[1]", "an index, ']' and '=' are missing"),
            ("let x = vector(3)\nlet x[] = 1", "formula is missing")]:
        err = c.prints("no element", DIVIDER + f".control\n{line}\n.endc\n", [])
        c.check(message in err, f"{line}: {err}")


def drawings(c):
    """plot on the terminal, hardcopy into files; what cannot be drawn is a warning."""
    circuit = "V1 a 0 SIN(0 5 50) AC 1\nR1 a b 1k\nC1 b 0 1u\n"
    for analysis, line, names in [
            ("tran 1m 40m", "plot v(a) v(b)", ["v(a)", "v(b)"]),
            ("tran 1m 40m", "plot v(a)-v(b)", ["v(a)-v(b)"]),
            ("tran 1m 40m", "plot i(v1) title current", ["i(v1)"]),
            ("tran 1m 40m", "let p = v(a)*i(v1)\nplot p v(a) xlimit 0 20m", ["p", "v(a)"]),
            ("tran 1m 40m", "plot all", ["v(a)", "v(b)", "i(v1)"]),
            ("ac dec 3 1 1k", "plot v(b)", ["v(b)", "Hz"]),
            ("ac dec 3 1 1k", "plot db(v(b)) ph(v(b))", ["db(v(b))", "ph(v(b))"]),
            ("ac lin 9 1 1k", "plot vdb(b)", ["vdb(b)"]),
            ("dc v1 0 5 1", "plot v(b)", ["v(b)"]),
            ("dc r1 1k 5k 1k", "plot v(b) i(v1)", ["v(b)", "i(v1)"])]:
        text = f"plot\n{circuit}.control\n{analysis}\n{line}\n.endc\n.end\n"
        status, out, err, _ = run(c.program, text)
        c.check(status == 0 and "warning" not in err and all(n in out for n in names),
                f"{analysis}: {line}: {status}\n{out}{err}")
    if shutil.which("gnuplot") is not None:
        with tempfile.TemporaryDirectory() as folder:
            for ending, begins in ((".svg", b"<?xml"), (".png", b"\x89PNG"), (".pdf", b"%PDF")):
                picture = pathlib.Path(folder) / ("Of_Case" + ending)
                text = (f"hardcopy\n{circuit}.control\ntran 1m 40m\nhardcopy {picture} v(a) i(v1)\n"
                        ".endc\n.end\n")
                status, _, err, _ = run(c.program, text)
                c.check(status == 0 and picture.exists() and picture.read_bytes().startswith(begins),
                        f"hardcopy {ending}: {status} {err}")
    for line, message in [("hardcopy x.ps v(a)", "named .svg, .png or .pdf"),
                          ("hardcopy", "named .svg, .png or .pdf"),
                          ("plot nothing", "there is no vector 'nothing'"),
                          ("op\nplot v(a)", "there is nothing to draw"),
                          ("hardcopy /nowhere/at/all.svg v(a)", "cannot draw")]:
        text = f"bad plot\n{circuit}.control\ntran 1m 40m\n{line}\n.endc\n.end\n"
        status, _, err, _ = run(c.program, text)
        c.check(status == 0 and message in err, f"{line}: {status} {err}")


def main():
    checks = Checks(pathlib.Path(sys.argv[1]).resolve())
    for part in kinds_of((alters, loops, dowhiles, elements, drawings, measurements, frequencies, second_analyses,
                          printed_formulas)):
        part(checks)
    return checks.finish()


if __name__ == "__main__":
    sys.exit(main())
