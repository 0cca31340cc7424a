#!/usr/bin/env python3
"""Compares several hundred expressions with ngspice.

usage: expressions.py PROGRAM

Random formulas (the same ones on each run) of all operators and functions that both have, with
parameters and functions of the netlist, each the voltage of a source; those that a parameter cannot
have in ngspice are values of B sources there. Nothing is compared near a step of floor(), a
comparison and the like, where a last bit decides. Exit status 77 without ngspice.
"""

import math
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

PARAMETERS = {"a": 1.5, "b2": -0.25, "rload": 4700.0, "t_on": 3.2e-6, "n": 7.0, "zero": 0.0}
NUMBERS = [("3", 3.0), ("0.5", 0.5), (".25", 0.25), ("2.", 2.0), ("1e-3", 1e-3), ("4.7k", 4700.0),
           ("10u", 10e-6), ("1meg", 1e6), ("2.5e2", 250.0), ("100n", 100e-9), ("1k", 1000.0),
           ("7", 7.0), ("12", 12.0), ("1.5m", 1.5e-3), ("3p", 3e-12), ("2g", 2e9), ("5E-1", 0.5)]
TOLERANCE = 1e-12


def apart(x, y):
    return abs(x - y) > 1e-6 * max(abs(x), abs(y), 1e-3)


def from_integer(x):
    return abs(x) < 1e6 and abs(x - round(x)) > 1e-6


def c_round(x):
    return float(round(x))  # to even, as nint


FUNCTIONS = [
    ("sin", math.sin, lambda x: abs(x) < 20), ("cos", math.cos, lambda x: abs(x) < 20),
    ("tan", math.tan, lambda x: abs(x) < 1.4), ("asin", math.asin, lambda x: abs(x) < 1),
    ("acos", math.acos, lambda x: abs(x) < 0.99), ("atan", math.atan, lambda x: True),
    ("arctan", math.atan, lambda x: True), ("sinh", math.sinh, lambda x: abs(x) < 20),
    ("cosh", math.cosh, lambda x: abs(x) < 20), ("tanh", math.tanh, lambda x: True),
    ("asinh", math.asinh, lambda x: True), ("acosh", math.acosh, lambda x: x > 1.1),
    ("atanh", math.atanh, lambda x: abs(x) < 0.9), ("sqrt", math.sqrt, lambda x: x >= 0),
    ("sqr", lambda x: x * x, lambda x: abs(x) < 1e5), ("exp", math.exp, lambda x: abs(x) < 20),
    ("ln", math.log, lambda x: x > 0 and apart(x, 1)),
    ("log", math.log, lambda x: x > 0 and apart(x, 1)),
    ("log10", math.log10, lambda x: x > 0 and apart(x, 1)), ("abs", abs, lambda x: True),
    ("sgn", lambda x: float((x > 0) - (x < 0)), lambda x: abs(x) > 1e-9),
    ("int", lambda x: float(math.trunc(x)), from_integer),
    ("floor", lambda x: float(math.floor(x)), from_integer),
    ("ceil", lambda x: float(math.ceil(x)), from_integer),
    ("nint", c_round, lambda x: abs(x) < 1e6 and apart(x % 1, 0.5)),
    ("twice", lambda x: 2 * x + 1.5, lambda x: True),
]

COMPARISONS = [("<", lambda x, y: x < y), (">", lambda x, y: x > y), ("<=", lambda x, y: x <= y),
               (">=", lambda x, y: x >= y), ("==", lambda x, y: x == y),
               ("!=", lambda x, y: x != y), ("<>", lambda x, y: x != y)]


class Generator:
    """Formulas with their values; a formula that is not in order is thrown away and made anew."""

    def __init__(self, seed):
        self.random = random.Random(seed)

    def leaf(self):
        if self.random.random() < 0.4:
            return self.random.choice(sorted(PARAMETERS.items()))
        return self.random.choice(NUMBERS)

    def formula(self, depth):
        """(text, value), safe to be an operand: in parentheses unless it is a leaf or a call."""
        while True:
            found = self.leaf() if depth == 0 else self.compound(depth)
            if found is not None and math.isfinite(found[1]) and abs(found[1]) < 1e12:
                return found

    def compound(self, depth):
        kind = self.random.choice(["call", "call", "sum", "product", "power", "logic", "choice",
                                   "many", "minus", "mixed", "integer"])
        return getattr(self, kind)(depth - 1)

    def call(self, depth):
        name, function, allowed = self.random.choice(FUNCTIONS)
        text, value = self.formula(depth)
        call = f"{name}({text})"
        # ngspice does not find a function of the netlist behind "?" and "&&".
        call = f"(1*{call})" if name == "twice" else call
        return (call, function(value)) if allowed(value) else None

    def many(self, depth):
        """min, max, pow, pwr and the function of two arguments."""
        (x, vx), (y, vy) = self.formula(depth), self.formula(depth)
        name = self.random.choice(["min", "max", "pow", "pwr", "pair"])
        if name in ("min", "max"):  # of three arguments ngspice 39 takes the last two
            return f"{name}({x}, {y})", {"min": min, "max": max}[name](vx, vy)
        if name == "pair":
            return f"(1*pair({x},{y}))", vx - 3 * vy
        if abs(vx) < 1e-9 or abs(vy) > 6 or abs(vx) > 1e4:
            return None
        if name == "pow" and vx < 0:
            return None
        return f"{name}({x},{y})", abs(vx) ** vy

    def sum(self, depth):
        (x, vx), (y, vy) = self.formula(depth), self.formula(depth)
        sign = self.random.choice(["+", "-"])
        value = vx + vy if sign == "+" else vx - vy
        # What cancels keeps no digits to compare.
        small = abs(value) < 1e-2 * max(abs(vx), abs(vy))
        return None if small else (f"({x} {sign} {y})", value)

    def product(self, depth):
        (x, vx), (y, vy) = self.formula(depth), self.formula(depth)
        sign = self.random.choice(["*", "/"])
        if sign == "/" and abs(vy) < 1e-12:
            return None
        return f"({x}{sign}{y})", vx * vy if sign == "*" else vx / vy

    def power(self, depth):
        (x, vx), (y, vy) = self.formula(depth), self.formula(depth)
        if vx <= 1e-9 or vx > 1e4 or abs(vy) > 6:
            return None
        sign = self.random.choice(["**", "^"])
        return f"({x}{sign}{y})", vx ** vy

    def integer(self, depth):
        r"""% and \, which step."""
        (x, vx), (y, vy) = self.formula(depth), self.formula(depth)
        if abs(vy) < 1e-9 or not from_integer(vx / vy) or abs(vx / vy) > 100:
            return None
        if self.random.random() < 0.5:
            value = math.fmod(vx, vy)
            return None if abs(value) < 1e-2 * abs(vx) else (f"({x} % {y})", value)
        # ngspice drops the sign, dalcs refuses.
        return (f"({x} \\ {y})", float(math.trunc(vx / vy))) if vx / vy > 0 else None

    def logic(self, depth):
        (x, vx), (y, vy) = self.formula(depth), self.formula(depth)
        if not apart(vx, vy):
            return None
        sign, holds = self.random.choice(COMPARISONS)
        text, value = f"({x} {sign} {y})", float(holds(vx, vy))
        if self.random.random() < 0.4:
            other, other_value = self.formula(depth)
            if self.random.random() < 0.5:
                return f"({text} && {other})", float(value != 0 and other_value != 0)
            return f"({text} || {other})", float(value != 0 or other_value != 0)
        return (f"(!{text})", float(not value)) if self.random.random() < 0.3 else (text, value)

    def choice(self, depth):
        condition, chosen = self.formula(depth)
        (x, vx), (y, vy) = self.formula(depth), self.formula(depth)
        if self.random.random() < 0.5:
            return f"({condition} ? {x} : {y})", vx if chosen != 0 else vy
        return f"ternary_fcn({condition},{x},{y})", vx if chosen != 0 else vy

    def minus(self, depth):
        text, value = self.formula(depth)
        return f"(-{text})", -value

    def mixed(self, _depth):
        """Precedence without parentheses."""
        (x, vx), (y, vy), (z, vz) = self.leaf(), self.leaf(), self.leaf()
        if vz == 0:
            return None
        forms = [(f"({x}+{y}*{z})", vx + vy * vz), (f"({x}-{y}/{z})", vx - vy / vz),
                 (f"({x}*{y}+{z})", vx * vy + vz), (f"(-{x}*{y}-{z})", -vx * vy - vz),
                 (f"({x}/{y}/{z})", vx / vy / vz if vy else math.nan),
                 (f"({x}-{y}-{z})", vx - vy - vz), (f"({x}*-{vy!r})" if vy > 0 else "e-", -vx * vy),
                 (f"(1+{x} > {y}*2)", float(1 + vx > vy * 2)),
                 (f"({x}>{y} && {z}>0 || {y}==0)", float((vx > vy and vz > 0) or vy == 0)),
                 (f"(3*{abs(vz)}^2-1)", 3 * vz * vz - 1), (f"(-{abs(vz)}**2)", -vz * vz)]
        text, value = self.random.choice(forms)
        if "e-" in text or abs(value) < 1e-2 * max(abs(vx), abs(vy), abs(vz), abs(vx * vy), 1e-9):
            return None
        return text, value


# What only a B source has: value there, expression here.
ONLY_B = [("u(0.3)", "u(0.3)"), ("u(-2)", "u(-2)"), ("uramp(1.7)", "uramp(1.7)"),
          ("uramp(-1.7)", "uramp(-1.7)"), ("log(10)", "log(10)"), ("log10(20)", "log10(20)"),
          ("ln(3)", "ln(3)"), ("3>2 ? 5 : 6", "if(3>2, 5, 6)"), ("2>3 ? 5 : 6", "if(2>3, 5, 6)"),
          ("atan(1)", "atan2(1,1)"), ("nint(2.5)", "nint(2.5)"), ("nint(3.5)", "nint(3.5)"),
          ("floor(-1.5)", "floor(-1.5)"), ("ceil(-1.5)", "ceil(-1.5)"),
          ("pow(2,0.5)", "pow(2,0.5)"), ("4*atan(1)", "pi"), ("exp(1)", "e"),
          ("min(max(5,1),3)", "limit(5,1,3)"), ("min(max(5,1),3)", "limit(5,3,1)"),
          ("min(max(-5,1),3)", "limit(-5,1,3)"), ("sqrt(25)", "hypot(3,4)"),
          ("-27^(1/3)*-1", "cbrt(27)"), ("7/2-0.5", "round(2.5)"), ("1.5", "table(0.75,0,0,2,4)")]


def deck(sources):
    lines = ["expressions"]
    lines += [f".param {name}={value!r}" for name, value in PARAMETERS.items()]
    lines += [".func twice(x) {2*x + a}", ".func pair(x,y) {x - 3*y}"]
    return lines + sources


def ngspice_values(count, sources, folder):
    wanted = "\n".join(f"print v(n{k})" for k in range(count))
    text = deck(sources) + [".control", "set numdgt=17", "op", wanted, ".endc", ".end"]
    (folder / "ng.cir").write_text("\n".join(text) + "\n")
    done = subprocess.run(["ngspice", "-n", "-b", "ng.cir"], cwd=folder, capture_output=True,
                          text=True, check=False)
    values = dict(re.findall(r"^v\(n(\d+)\) = (\S+)", done.stdout, re.MULTILINE))
    if len(values) != count:
        raise AssertionError(f"ngspice gave {len(values)} of {count} values\n{done.stdout[-2000:]}"
                             f"{done.stderr[-2000:]}")
    return [float(values[str(k)]) for k in range(count)]


def main():
    program = sys.argv[1]
    if shutil.which("ngspice") is None:
        print("ngspice is not installed")
        return 77
    generator = Generator(20260101)
    cases = []
    while len(cases) < 600:
        found = generator.formula(generator.random.choice([1, 1, 2, 2, 3, 4]))
        # A source of 1e-20 V tells nothing, one of 0 V is a value all the same.
        if found[1] == 0 or abs(found[1]) > 1e-9:
            cases.append(found)
    checker = dalcs_program.Checker("expressions")
    ours = [f"V{k} n{k} 0 {{{text}}}" for k, (text, _) in enumerate(cases)]
    ours += [f"V{k} n{k} 0 {{{text}}}" for k, (_, text) in enumerate(ONLY_B, len(cases))]
    theirs = ours[:len(cases)]
    theirs += [f"B{k} n{k} 0 V={text}" for k, (text, _) in enumerate(ONLY_B, len(cases))]
    count = len(ours)
    with tempfile.TemporaryDirectory() as folder:
        reference = ngspice_values(count, theirs, pathlib.Path(folder))
    loads = [f"R{k} n{k} 0 1" for k in range(count)]
    run = dalcs_program.run(program, "\n".join(deck(ours + loads) + [".op", ".end"]) + "\n",
                            method=None)
    if not checker.check(run.status == 0, f"dalcs ended with {run.status}\n{run.stderr}"):
        return checker.finish()
    for k, line in enumerate(ours):
        found = run.column(f"v(n{k})")[0]
        checker.close(found, reference[k], TOLERANCE * max(abs(reference[k]), 1e-12), line)
        if k < len(cases):
            checker.close(found, cases[k][1], TOLERANCE * max(abs(cases[k][1]), 1e-12),
                          f"{line} (Python)")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
