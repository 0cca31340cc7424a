#!/usr/bin/env python3
"""Runs .control blocks of the kinds that people publish, and compares them with ngspice and closed forms.

usage: control_blocks.py PROGRAM [NGSPICE]

The circuit of all is a divider with a capacitor, which both simulate exactly at an operating point, in a sweep
and at a frequency: there ngspice has to print the same numbers and write the same files. Of transients and
spectra the answers are closed forms.
"""

import cmath
import math
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker  # noqa: E402

CIRCUIT = """a divider and a capacitor
.param rload=1k vin=2
V1 in 0 DC {vin} AC 1 SIN(0 1 1k)
R1 in out 1k
R2 out 0 {rload}
C1 out 0 100n
"""

# What is printed, echoed and written is ngspice's: name: the block.
AS_NGSPICE = {
    "imaginary parts, of a voltage, a current and what let made": """
ac lin 1 1k 1k
print im(v(out))
print im(out) im(i(v1))
let z = 2 + j(3)
print im(z) imag(z)
print im(v(in)/i(v1))
""",
    "phases in radians and in degrees": """
ac dec 1 100 10k
let phase = 180/pi*vp(out)
let angle = ph(v(out))
meas ac p1 find vp(out) at=1k
meas ac p2 find phase at=1k
meas ac p3 find angle at=1k
print p1
print p2
print p3
print ph(v(out)) vp(out)
set units = degrees
print ph(v(out)) cph(v(out))
print group_delay(v(out))
print sin(30) cos(60) tan(45) atan(1) sin(pi/2)
meas ac q1 find vp(out) at=1k
print q1
set units = radians
print vp(out)
set units=Degrees
unset units
meas ac q2 find vp(out) at=1k
print q2 sin(1)
""",
    "values of elements, which alter reads": """
print @r1[resistance] @c1[capacitance] @v1[acmag] @v1[dc]
alter r1 = @r1[resistance]*3
print @r1[resistance]
op
print v(out)
alter @v1[acmag] = 3
alter v1 = 7
alter @r2[resistance] = @r1[resistance]/2
print @v1[acmag] @v1[dc] @r2[resistance]
op
print v(out) @r1[resistance]
reset
print @r1[resistance]
""",
    "AC values of sources, which change one by one": """
ac lin 1 1k 1k
print v(out)
alter @v1[acmag] = 3
ac lin 1 1k 1k
print v(out)
alter v1 acphase = 90
ac lin 1 1k 1k
print v(out)
alter v1 acmag = 0.5
ac lin 1 1k 1k
print v(out)
alter @v1[ac] = [ 2 -30 ]
ac lin 1 1k 1k
print v(out)
reset
ac lin 1 1k 1k
print v(out)
""",
    "plots by name": """
op
ac lin 3 1k 3k
op
setplot op1
print v(out)
setplot ac1
print mag(v(out)[1])
setplot ac
print real(v(out)[2])
let a = op1.v(out)
let b = ac1.v(out)[0]
print a b
echo $curplot $curplotname
""",
    "results of runs side by side": """
foreach r 500 1k 2k
  alter r2 = $r
  dc V1 0 2 1
end
print dc1.v(out) dc2.v(out) dc3.v(out)
wrdata three dc1.v(out) dc2.v(out) dc3.v(out)
""",
    "a scratch plot for a series": """
let runs = 3
let run = 0
set curplot = new
set scratch = $curplot
setplot $scratch
let current = unitvec(runs)
dowhile run < runs
  op
  set run = $&run
  set here = $curplot
  setplot $scratch
  let out{$run} = {$here}.v(out)
  let current[run] = -{$here}.i(V1)
  setplot $here
  alter r2 = {1k/(2+run)}
  let run = run + 1
end
print {$scratch}.current[0] {$scratch}.current[1] {$scratch}.current[2]
print {$scratch}.out0 {$scratch}.out2
""",
    "constants in the plot const": """
let vin = 1
let count = 0
let chart = unitvec(3)*0
while const.vin <= 3
  alter V1 = const.vin
  op
  let const.chart[count] = v(out)
  let const.vin = const.vin + 1
  let const.count = const.count + 1
end
setplot new
let result = const.chart
print result[0] result[1] result[2]
""",
    "plots are destroyed": """
op
dc V1 0 1 1
destroy dc1
echo $curplot
print v(out)
ac lin 2 1k 2k
destroy
echo $curplot
destroy all
echo $curplot
op
echo $curplot
""",
    "loop gain of two runs": """
ac dec 3 100 10k
alterparam rload = 3k
reset
ac dec 3 100 10k
setplot new
let frequency = ac1.frequency
let t = (ac1.v(out) + ac2.v(out)) / (ac1.v(in) - ac2.v(out)/4)
let tmag = db(t)
let tphase = 180*cph(t)/pi
print tmag[0] tmag[3] tphase[2]
set wr_singlescale
set wr_vecnames
wrdata gain tmag tphase
""",
    "functions of the script": """
define power(u,k) (u*k)
define worse(x) max(x, 2*x)
define par(a,b) a*b/(a+b)
op
print power(v(out), 3)
print par(1k, 3k)
undefine power
""",
    "functions along a vector": """
ac dec 4 100 100k
let h = v(out)/v(in)
print cph(h)[12] vecmin(db(h)) mean(mag(h)) length(h)
print norm(mag(h))[3] avg(mag(h))[5]
dc V1 0 4 0.5
let square = v(out)*v(out)
print deriv(square)[3] deriv(square)[5] integ(v(out))[8]
print pos(v(out)-1)[2] pos(v(out)-1)[8]
print unwrap(vector(4))[3]
""",
    "complex numbers": """
ac lin 2 1k 2k
let w = 3 + j(4)
print mag(w) conj(w)
let h = v(out)/v(in)
let z = h*h + 1
print vecmax(mag(h)) vecmax(real(z))
""",
    "ranges and choices": """
dc V1 0 4 1
print mean(v(out)[1,3]) length(v(in)[2,4])
let x = 3
let y = (x gt 2) ? 10 : 20
let z = (x gt 5) ? 10 : 20
print y z
""",
    "texts and lists": """
set list = ( a b c )
echo $list[2] $#list
set n = 2
echo $list[$n]
strcmp same abc abc
echo $same
strcmp same abc abd
if $same = 0
  echo equal
else
  echo other
end
if $?nothing
  echo set
else
  echo unset
end
set nothing = 3
if $?nothing eq 1
  echo set
end
""",
    "echo and print into files": """
op
echo first line > notes.txt
echo "second: $&v(out)" >> notes.txt
let five = 5
print v(out) five > numbers
print v(in) >> numbers
dc V1 0 1 0.5
print v(out) v(in) > table
""",
    "lists of values": """
compose r values 500 1k 2k
compose v start=1 stop=2 step=0.25
compose n start=0 stop=1 lin=5
print r[2] v[4] length(v) n[3] length(n)
foreach x $&r
  alter r2 = $x
  op
  print v(out)
end
""",
    "numbers of a table": """
dc V1 0 2 1
cross second 1 v(in) v(out)
print second[0] second[1] length(second)
let a = v(out)
unlet a
print length(v(out))
""",
    "labels": """
let k = 0
label again
let k = k + 1
if k < 4
  goto again
end
print k
repeat 5
  let k = k + 10
  if k > 20
    goto out
  end
end
label out
print k
""",
    "all of a kind": """
op
dc V1 0 1 1
print line v(out)
print v(in) v(out) out
""",
    "digits": """
set numdgt = 10
op
print v(out) -v(out)/3
dc V1 0 1 0.5
print v(out)/3 > digits
""",
    "over another vector": """
dc V1 0 2 0.5
wrdata xy v(in) vs v(out)
setscale v(out)
wrdata scaled v(in)
""",
    "complex tables": """
ac lin 3 1k 3k
print v(out) > pairs
print db(v(out)) ph(v(out)) > parts
wrdata pairs.txt v(out) mag(v(out))
""",
    "other values": """
alter @r1[resistance] = 3k
alter v1 dc = 4
op
print v(out)
alter r1 1k
alter V1 = 2
op
print v(out)
alterparam rload = 500
reset
op
print v(out)
""",
}


def rows(path):
    return [[float(x) for x in re.findall(r"[-+]?\d\S*?(?=[,\s]|$)", line)]
            for line in path.read_text().splitlines() if re.match(r"\s*[-+\d]", line)]


def lines(text):
    """What is printed, without blanks, prompts and the notes of ngspice."""
    wanted = re.compile(r"^\s*\S.*? = [-(]? ?[\d.]|^\d+\t")
    return [re.sub(r"\s+", " ", line).strip() for line in text.splitlines() if wanted.match(line)
            and not line.startswith("Doing")]


def compare(checker, program, ngspice, what, block):
    text = CIRCUIT + ".control\n" + block + "echo done\n.endc\n.end\n"
    with tempfile.TemporaryDirectory() as folder:
        out = {}
        for name, command in (("ours", [program, "run", "c.cir", "-q"]), ("theirs", [ngspice, "-b", "c.cir"])):
            if command[0] is None:
                return
            at = pathlib.Path(folder) / name
            at.mkdir()
            (at / "c.cir").write_text(text)
            done = subprocess.run(command, cwd=at, capture_output=True, text=True, check=False, timeout=60)
            out[name] = done
        ours, theirs = out["ours"], out["theirs"]
        checker.check(ours.returncode == 0 and "warning" not in ours.stderr, f"{what}: {ours.stderr}")
        checker.check("done" in theirs.stdout, f"{what}: ngspice: {theirs.stdout}{theirs.stderr}")
        own, other = lines(ours.stdout), lines(theirs.stdout)
        checker.check(len(own) > 0 or not other, f"{what}: nothing is printed")
        checker.check(own == other, f"{what}: printed\n{own}\n, not\n{other}")
        said = [[x for x in block_echo(text, o.stdout)] for o in (ours, theirs)]
        checker.check(said[0] == said[1], f"{what}: said {said[0]}, not {said[1]}")
        written = sorted(p.name for p in (pathlib.Path(folder) / "theirs").iterdir())
        for name in written:
            a, b = (pathlib.Path(folder) / side / name for side in ("ours", "theirs"))
            if name != "c.cir" and checker.check(a.exists(), f"{what}: no {name}"):
                compare_files(checker, f"{what}: {name}", a, b)


def block_echo(text, out):
    """Lines that are neither numbers nor of ngspice: those of echo."""
    words = set(re.findall(r"^\s*echo (.*)$", text, re.MULTILINE))
    return [line for line in out.splitlines() if line in words or re.fullmatch(r"[a-z]+\d?( [A-Za-z ]+| \d)?", line)
            and "=" not in line and not line.startswith("Note")]


def compare_files(checker, what, ours, theirs):
    texts = [[line for line in p.read_text().splitlines() if not re.search(r"\d\d:\d\d:\d\d", line)]
             for p in (ours, theirs)]
    heads = [[re.sub(r"\s+", " ", line).strip() for line in t if re.match(r"\s*[A-Za-z-]{2}", line)] for t in texts]
    kept = [[line for line in h if not re.fullmatch(r"(Operating Point|AC Analysis|DC transfer characteristic)", line)]
            for h in heads]
    checker.check(kept[0] == kept[1], f"{what}: heads {kept[0]}, not {kept[1]}")
    a, b = rows(ours), rows(theirs)
    if checker.check(len(a) == len(b) and all(len(x) == len(y) for x, y in zip(a, b)), f"{what}: shape"):
        for x, y in zip(a, b):
            for p, q in zip(x, y):
                checker.close(p, q, 2e-8 * max(1.0, abs(q)), what)


def run(program, text):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "c.cir"
        path.write_text(text)
        done = subprocess.run([program, "run", path, "-q"], cwd=folder, capture_output=True, text=True,
                              check=False, timeout=60)
        files = {p.name: p.read_text(errors="replace") for p in pathlib.Path(folder).iterdir() if p.suffix != ".raw"}
    return done, files


def printed(text):
    return {name: [float(x) for x in value.split(",")]
            for name, value in re.findall(r"^(\S.*?) = (-?\d\S*)$", text, re.MULTILINE)}


SINES = """three sines and a constant
V1 a 0 {circuit}
V2 a2 a SIN(0 3 1k 0 0 30)
V3 a3 a2 SIN(0 0.5 3k)
R1 a3 0 1k
"""


def close_all(checker, what, found, wanted, tolerance=1e-9):
    for name, value in wanted.items():
        got = found.get(name, [math.nan])
        parts = [value.real, value.imag] if isinstance(value, complex) else [value]
        checker.check(len(got) >= len(parts), f"{what}: {name}: {got}")
        for p, q in zip(got, parts):
            checker.close(p, q, tolerance, f"{what}: {name}")


def spectra(checker, program):
    """v = 2 + 3 sin(w t + 30 deg) + 0.5 sin(3 w t), over whole periods: each line stands alone."""
    body = SINES.format(circuit="DC 2")
    phase = cmath.exp(1j * (math.pi / 6 - math.pi / 2))
    for n in (64, 100, 97):  # a power of 2, another even number, a prime
        stop = 1e-3 * (n - 1) / n * 4
        done, _ = run(program, f"{body}.control\nset numdgt=14\nset specwindow=none\n"
                               f"tran {4e-3 / n!r} {stop!r}\nlinearize v(a3)\nfft v(a3)\n"
                               "print length(frequency) v(a3)[0] v(a3)[4] v(a3)[12] mag(v(a3)[7]) frequency[4]\n"
                               ".endc\n.end\n")
        close_all(checker, f"fft of {n}", printed(done.stdout), {
            "length(frequency)": float(n // 2 + 1), "v(a3)[0]": 2.0 + 0j, "v(a3)[4]": 3.0 * phase,
            "v(a3)[12]": -0.5j, "mag(v(a3)[7])": 0.0, "frequency[4]": 1000.0}, 2e-8)
        checker.check(done.returncode == 0 and "warning" not in done.stderr, f"fft of {n}: {done.stderr}")
    # A window that is a sum of cosines moves a line to its neighbours, by the window's coefficients.
    for window, beside in (("hanning", -0.5), ("hamming", -0.46 / 0.54 / 2), ("blackman", -0.5 / 0.42 / 2)):
        done, _ = run(program, f"{body}.control\nset numdgt=14\nset specwindow={window}\ntran 40u 3.96m\n"
                               "fft v(a3)\nprint mag(v(a3)[4]) mag(v(a3)[5])\n.endc\n.end\n")
        close_all(checker, window, printed(done.stdout), {"mag(v(a3)[5])": abs(3 * beside)}, 2e-8)
    # Rows of events between do not matter; psd has half the square of an amplitude over the width of a row.
    done, _ = run(program, SINES.format(circuit="PULSE(0 1 0.3u 0 0 0.1u 10)") +
                  ".control\nset numdgt=14\nset specwindow=none\ntran 40u 3.96m\npsd 1 v(a3)\n"
                  "print real(v(a3)[4])\nsetplot tran1\nspec 0 5k 500 v(a3)\n"
                  "print mag(v(a3)[2]) mag(v(a3)[3]) frequency[6]\n.endc\n.end\n")
    close_all(checker, "psd and spec", printed(done.stdout), {
        "real(v(a3)[4])": 4.5 / 250, "mag(v(a3)[2])": 3.0, "mag(v(a3)[3])": 0.0, "frequency[6]": 3000.0}, 2e-8)
    done, _ = run(program, f"{body}.control\nset nfreqs=4\ntran 10u 4m\nfourier 1k v(a3)\n"
                           "print fourier11[5] fourier11[9] thd11\n.endc\n.end\n")
    checker.check("No. Harmonics: 4" in done.stdout, done.stdout + done.stderr)
    close_all(checker, "fourier", printed(done.stdout), {"fourier11[5]": 3.0, "fourier11[9]": 30.0,
                                                          "thd11": 100 / 6}, 1e-5)


def equal_distances(checker, program):
    """linearize: the rows of the grid and no others, also of vectors that let has made."""
    body = SINES.format(circuit="PULSE(0 1 0.33m 0 0 1 2)")
    done, _ = run(program, f"{body}.control\nset numdgt=14\ntran 0.1m 2m 0.5m\nlet twice = 2*v(a)\nlinearize\n"
                           "print length(time) time[3] v(a2)[7] twice[0] v(a)[0]\necho $curplot $curplotname\n"
                           "setplot tran1\nlet lin-tstart = 1m\nlet lin-tstep = 0.25m\nlinearize v(a3)\n"
                           "print time[1] length(v(a3))\n.endc\n.end\n")
    found = printed(done.stdout)
    close_all(checker, "linearize", found, {
        "length(time)": 16.0, "time[3]": 0.8e-3, "twice[0]": 2.0, "v(a)[0]": 1.0,
        "v(a2)[7]": 1 + 3 * math.sin(2.4 * math.pi + math.pi / 6), "time[1]": 1.25e-3,
        "length(v(a3))": 5.0}, 1e-9)
    checker.check("tran2 Transient Analysis (linearized)" in done.stdout, done.stdout + done.stderr)


def waveforms(checker, program):
    """alter of the function of a source: its values at one instant."""
    for source, line, wanted in (
            ("SIN(0 1 1k)", "alter @v1[pulse] = [ 1 3 0 0 0 1 2 ]", 3.0),
            ("PULSE(0 1 0 1u 1u 1m 2m) AC 1", "alter v1 sin = ( 2 3 1k 0 0 30 )", 2 + 3 * math.sin(math.pi / 3)),
            ("DC 1", "let t = 1m\nalter @V1[PWL] = [ 0 0 $&t 8 ]", 8 / 12),
            ("1", "alter @v1[exp] = [ 1 2 0 1m 5 1 ]", 2 - math.exp(-1 / 12)),
            ("PWL(0 0 1 1) DC 2", "alter @v1[sin] = [ 0 1 1k ]\nalter @v1[sin] = [ 5 0 1k ]", 5.0),
            ("SIN 0 1 1k AC 1", "alter @v1[sin] = [ 4 0 1k ]", 4.0)):
        done, _ = run(program, f"x\nV1 a 0 {source}\nR1 a 0 1\n.control\n{line}\nset numdgt=14\ntran 1m 1m\n"
                               f"meas tran m FIND v(a) AT={1e-3 / 12!r}\nprint m\n.endc\n.end\n")
        checker.check(done.returncode == 0 and "warning" not in done.stderr, f"{line}: {done.stderr}")
        close_all(checker, line, printed(done.stdout), {"m": wanted}, 1e-9)
    done, _ = run(program, "x\nV1 a 0 1\nR1 a 0 1\n.control\nalter @v1[sin] = [ 1 0 1k ]\n"
                           "alter @v1[pulse] = [ 2 2 0 0 0 1 2 ]\nalter @v1[sin] = [ 3 0 1k ]\n"
                           "tran 1m 1m\nprint v(a)[1]\n.endc\n.end\n")
    close_all(checker, "the last function of three", printed(done.stdout), {"v(a)[1]": 3.0})
    done, _ = run(program, "x\nX1 a s\n.subckt s p\nV1 p 0 1\n.ends\nR1 a 0 1\n.control\n"
                           "alter @x1.v1[pulse] = [ 0 2 0 0 0 1 2 ]\ntran 1m 1m\nprint v(a)[length(time)-1]\n"
                           "reset\nop\nprint v(a)\n.endc\n.end\n")
    close_all(checker, "in a subcircuit", printed(done.stdout), {"v(a)[length(time)-1]": 2.0, "v(a)": 1.0})


def random_values(checker, program):
    """Moments of 40 000 values, each within 6 of its deviations, and what a seed repeats."""
    n = 40000
    moments = {"sgauss(vector(n))": (0, 1, math.sqrt(2)), "sunif(vector(n))": (0, 1 / math.sqrt(3), 0.3),
               "exponential(3*unitvec(n))": (3, 3, 6.0), "rnd(6*unitvec(n))": (2.5, math.sqrt(35 / 12), 1.4)}
    for text, (mean, deviation, spread) in moments.items():
        done, _ = run(program, f"x\nV1 a 0 1\nR1 a 0 1\n.control\nset numdgt=14\nlet n = {n}\nlet x = {text}\n"
                               "print mean(x) stddev(x) vecmin(x) vecmax(x)\nop\n.endc\n.end\n")
        found = {name: value[0] for name, value in printed(done.stdout).items()}
        checker.check(abs(found["mean(x)"] - mean) < 6 * deviation / math.sqrt(n), f"{text}: {found}")
        checker.check(abs(found["stddev(x)"] - deviation) < 6 * spread / math.sqrt(n), f"{text}: {found}")
        if "rnd" in text:
            checker.check((found["vecmin(x)"], found["vecmax(x)"]) == (0, 5), f"{text}: {found}")
    block = ("define agauss(nom, by) (nom + by*sgauss(0))\nsetseed 4\nlet a = agauss(2, 0.1)\nset rndseed = 5\n"
             "let b = agauss(2, 0.1)\nsetseed 4\nlet c = agauss(2, 0.1)\nlet d = agauss(2, 0.1)\nprint a b c d\nop\n")
    done, _ = run(program, f"x\nV1 a 0 1\nR1 a 0 1\n.control\n{block}.endc\n.end\n")
    found = {name: value[0] for name, value in printed(done.stdout).items()}
    checker.check(found["a"] == found["c"] and len({found["a"], found["b"], found["d"]}) == 3, f"seeds: {found}")
    first = [run(program, f"x\n.options seed={seed}\nV1 a 0 1\nR1 a 0 1\n.control\nprint sgauss(0)\nop\n.endc\n.end\n"
                 )[0].stdout.splitlines()[0] for seed in (1, 2, 1)]
    checker.check(first[0] == first[2] != first[1], f"the netlist's seed: {first}")


def messages(checker, program):
    for block, words in (
            ("op\nsetplot tran1", "there is no plot 'tran1'"), ("op\nlinearize", "takes the rows of a transient"),
            ("ac lin 2 1 2\nfft v(out)", "takes the rows of a transient"),
            ("tran 1m 10m\nset specwindow=hanniing\nfft v(out)", "there is no window 'hanniing'"),
            ("tran 1m 10m\nspec 0 1k 100 v(out)", "contain nothing above 500 Hz"),
            ("tran 1m 100m\nspec 0 100 10 v(out)\nspec 0 100 10 v(out)", "takes the rows of a transient"),
            ("tran 1m 10m\nspec 0 100 1 v(out)", "shorter than a period of 1 Hz"),
            ("tran 1m 10m\nlet lin-tstep = 1\nlinearize", "no rows lie every 1 s"),
            ("op\nunlet x", "there is no vector 'x'"), ("op\nprint op2.v(out)", "there is no plot 'op2'"),
            ("op\nprint op1.v(nowhere)", "there is no vector 'v(nowhere)'"),
            ("op\nac lin 2 1 2\nprint op1.v(nowhere)", "there is no vector 'v(nowhere)' in op1"),
            ("define f", "a function with at most"), ("define f(a) a+b\nop\nprint f(1)", "in f(): there is no vector 'b'"),
            ("define f(a) f(a)\nprint f(1)", "in f()"), ("compose x", "a name and values are missing"),
            ("compose x start=1 stop=0 step=1", "no values lie between"), ("cross x 5 v(out)\nop", "there is no vector"),
            ("goto nowhere", "there is no label 'nowhere'"), ("label a\ngoto a", "goto was done 1000000 times"),
            ("resume", "a run cannot be stopped and continued here"), ("source other.cir", "a netlist is one file"),
            ("alter @v2[pulse] = [ 0 1 ]\nop", "there is no V or I 'v2'"), ("alter @v1[pulse] = [ ]\nop", "the values of pulse are"),
            ("alter @r1[pulse] = [ 0 1 ]\nop", "there is no V or I 'r1'"),
            ("setseed 1.5\nop", "a whole number from 0 to"), ("op\nshell ls", "starts no other programs"), ("set l = ( a b )\necho $l[3]", "has no word number 3"),
            ("op\nprint max(v(out), 1, 2)", "of so many arguments"), ("settype", "a type and vectors are missing"),
            ("op\nsetscale nothing", "has no vector 'nothing'"), ("strcmp a b", "a name and two texts"),
            ("dc V1 0 1 1\nprint (v(out) > 0) ? 1 : 0", "a vector of length 2"),
            ("op\nprint v(out) > /nowhere/at/all", "cannot write '/nowhere/at/all'")):
        done, _ = run(program, CIRCUIT + f".control\n{block}\n.endc\n.end\n")
        checker.check(words in done.stderr and re.search(r"c\.cir:\d+:1: ", done.stderr), f"{block}: {done.stderr}")


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    checker = Checker("control blocks")
    for what, block in AS_NGSPICE.items():
        compare(checker, program, sys.argv[2] if len(sys.argv) > 2 else None, what, block)
    spectra(checker, program)
    equal_distances(checker, program)
    waveforms(checker, program)
    random_values(checker, program)
    messages(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
