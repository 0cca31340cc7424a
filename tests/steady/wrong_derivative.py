#!/usr/bin/env python3
"""A derivative of the period map that is wrong on purpose costs steps, and no answer becomes wrong by it. Nor by bounds of what
a search may take that are ten times as large, or a tenth.

usage: wrong_derivative.py BUILD SOURCE
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve()
sys.path.insert(0, str(HERE.parents[1] / "support"))
sys.path.insert(0, str(HERE.parents[1] / "mutations"))
import attractors  # pylint: disable=wrong-import-position,import-error
import crowded  # pylint: disable=wrong-import-position,import-error
import dalcs_program  # pylint: disable=wrong-import-position,import-error
import kinds  # pylint: disable=import-error
import mutations  # pylint: disable=wrong-import-position,import-error

SKIPPED = 77
NEAR = 1e-9

MUTATIONS = {
    "events move nothing": ("orbit/variation.c", "    v->pending = true;\n",
                            "    v->pending = false;\n"),
    "events move states the other way": ("orbit/variation.c", "v->guard[k] *= -1.0 / rate;",
                                         "v->guard[k] *= 1.0 / rate;"),
    "the derivative is too large by 1 %": ("session/steady_derivative.c", "    st->pass.is_exact = true;\n",
                                           "    st->pass.is_exact = true;\n    double wrong = 1.01;\n"
                                           "    for (int k = 0; k < variation->n_parts; k++) {\n"
                                           "        int n = variation->part[k].n_x;\n"
                                           "        for (int i = 0; i < n * n; i++) {\n"
                                           "            variation->part[k].v[i] *= wrong;\n"
                                           "        }\n    }\n"),
    "half of each step is taken": ("session/steady_newton.c", "st->step[first + x] = w.d[x]",
                                   "st->step[first + x] = 0.5 * w.d[x]"),
}

PAIRS = ("session/steady_crowd.c", "= 2.0 * 8192.0 * 4.0;")
FOLLOWED = ("session/steady_attractor.c", "most_work = 1e7;")


def steady(program, where, netlist):
    """(exit status, the report's steady)"""
    (where / "c.cir").write_text(netlist)
    done = subprocess.run([str(program), "steady", "c.cir", "-q", "-o", "c.csv", "--report",
                           "c.json"], cwd=where, capture_output=True, text=True, check=False,
                          timeout=60)
    return done.returncode, json.loads((where / "c.json").read_text()).get("steady")


def circuits():
    for kind in ("buck_dcm", "slow_rectifier", "llc"):
        for name, body in list(kinds.KINDS[kind]())[:3]:
            yield name, f"* {name}\n{body}.pss uic\n.end\n"


# The threshold of the switch is the mean of a ripple, and its load makes the voltage fall.
CROWDED = """A load that a switch connects where it disconnects it
Vin in 0 12
Vg g 0 PULSE(0 1 0 0 0 4u 10u)
S1 in sw g 0 sm
D1 0 sw
L1 sw out 50u
C1 out 0 20u
R1 out 0 2
S2 out z out ref sm
R2 z 0 5
Vref ref 0 4.3
.model sm SW(Ron=0 Vt=0.5)
.pss uic
"""


def bounds(checker, build, source, where):
    """Where a switch slides the state is found as ever, where there is no end the search ends; and nothing false is told."""
    held = [crowded.HELD.format(volts=volts, held=level, ohms=ohms, store=store, clock=clock)
            for volts, level, ohms, store, clock in ((5, 2, 1e3, 1e-6, 1e-3), (40, 11, 20.0, 1e-6, 1e-4))]
    sound = [steady(build / "dalcs", where, netlist)[1] for netlist in held]
    for factor in ("0.1", "10.0"):
        other = mutations.mutant(build, source, *PAIRS, PAIRS[1].replace("=", f"= {factor} *"), where)
        for netlist, right in zip(held, sound):
            status, answer = steady(other, where, netlist)
            checker.check(status == 0 and answer["states"] == right["states"], f"{factor} of the problems: {status}, {answer}")
        checker.check(steady(other, where, CROWDED)[0] == 1, f"{factor} of the problems: an end")
    other = mutations.mutant(build, source, *FOLLOWED, FOLLOWED[1].replace("1e7", "1e6"), where)
    for name, netlist, expected in attractors.BESIDE[2:6]:
        status, answer = steady(other, where, f"* {name}\n{netlist}.pss uic\n")
        found = answer.get("attractor", {}).get("kind") if status == 0 else "none"
        checker.check(found in (None, expected), f"{name}, followed for a tenth: {found}, not {expected}")


def main():
    build, source = (pathlib.Path(a).resolve() for a in sys.argv[1:3])
    if shutil.which("ninja") is None:
        return SKIPPED
    checker = dalcs_program.Checker("wrong_derivative")
    with tempfile.TemporaryDirectory() as folder:
        where = pathlib.Path(folder)
        sound = {name: steady(build / "dalcs", where, netlist)[1] for name, netlist in circuits()}
        for title, (file, old, new) in MUTATIONS.items():
            broken = mutations.mutant(build, source, file, old, new, where)
            more = 0
            for name, netlist in circuits():
                status, answer = steady(broken, where, netlist)
                if status == 1:  # an answer that it could not confirm is none
                    more += 1
                    continue
                right = sound[name]
                if not checker.check(status == 0 and answer, f"{title}, {name}: status {status}"):
                    continue
                more += answer["periods"] > right["periods"]
                scale = max(abs(x) for x in right["states"].values())
                off = max(abs(answer["states"][c] - x) for c, x in right["states"].items()) / scale
                checker.check(off <= NEAR, f"{title}, {name}: off by {off:.2g}")
            checker.check(more > 0, f"{title}: it costs nothing")
        bounds(checker, build, source, where)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
