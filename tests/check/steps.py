#!/usr/bin/env python3
"""The bound on the step that `dalcs check` gives, against hand-computed eigenvalues and against what
implicit Euler does: solvable just below, not any more just above.

usage: steps.py PROGRAM"""

import cmath
import json
import pathlib
import subprocess
import sys
import tempfile

END = ".model di D(Ron=0 Vfwd=0)\n.tran {step!r} {stop!r} uic\n.end\n"


def one(r, c):
    """hc36: C beside a negative resistor: C v' = v / r while the diode is off."""
    return (f"negative resistor\nC1 1 0 {c!r} ic=1\nR1 1 0 {-r!r}\nD1 0 1 di\n", r * c)


def two(r, g, c1, c2):
    """The same with a second capacitor behind g; controlled source for the negative resistor."""
    text = (f"two capacitors\nC1 1 0 {c1!r} ic=1\nG1 1 0 1 0 {-1 / r!r}\nR2 1 2 {1 / g!r}\n"
            f"C2 2 0 {c2!r} ic=0.9\nD1 0 1 di\nD2 0 2 di\n")
    a, d = (1 / r - g) / c1, -g / c2
    half = cmath.sqrt((a - d) ** 2 / 4 + g * g / (c1 * c2))
    modes = [(a + d) / 2 + half, (a + d) / 2 - half, complex(a), complex(d)]  # both off; one at 0
    return text, 1.0 / max(m.real for m in modes if m.imag == 0 and m.real > 0)


def rings(r):
    """A negative resistor in a tank that rings: its eigenvalues are complex, no step is too large."""
    return (f"ringing\nC1 1 0 1 ic=1\nL1 1 0 1\nG1 1 0 1 0 {-1 / r!r}\nD1 2 1 di\nR2 2 0 1000\n", None)


CASES = [one(1.0, 1.0), one(1e3, 1e-6), one(50.0, 3e-9), two(1.0, 0.5, 1.0, 1.0),
         two(1e3, 1e-4, 1e-6, 1e-7), two(10.0, 1.0, 1e-6, 1e-6), rings(3.0), rings(10.0)]


def solvable(program, folder, text, h):
    netlist = pathlib.Path(folder) / "step.cir"
    netlist.write_text(text + END.format(step=h, stop=3 * h))
    done = subprocess.run([program, "run", str(netlist), "--method", "euler", "--step", repr(h), "-o",
                           str(netlist.with_suffix(".csv")), "-q"], capture_output=True, text=True)
    return done.returncode


def main(program):
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        for text, expected in CASES:
            netlist = pathlib.Path(folder) / "check.cir"
            netlist.write_text(text + END.format(step=1.0, stop=10.0))
            done = subprocess.run([program, "check", str(netlist), "--json"], capture_output=True,
                                  text=True, check=True)
            parts = json.loads(done.stdout)["parts"]
            found = parts[0]["verdicts"]["step"].get("value")
            why = ""
            if expected is None:
                statuses = [solvable(program, folder, text, h) for h in (0.1, 1.0, 10.0)]
                if found is not None or parts[0]["verdicts"]["step"]["answer"] != "yes":
                    why = f"a bound of {found}"
                elif any(statuses):
                    why = f"statuses {statuses}"
            elif found is None or abs(found - expected) > 1e-9 * expected:
                why = f"{found}, not {expected}"
            else:
                below = [solvable(program, folder, text, k * found) for k in (0.3, 0.9, 0.99)]
                above = solvable(program, folder, text, 1.01 * found)
                if any(below) or above != 1:
                    why = f"solvable below: {below}, above: {above}"
            if why:
                failures += 1
                print(f"FAILED {text.splitlines()[0]}: {why}")
    print(f"{len(CASES)} circuits, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
