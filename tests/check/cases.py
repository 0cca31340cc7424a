#!/usr/bin/env python3
"""`dalcs check` of every netlist of the tree, held to doc/check.schema.json, and what it must say of some.

usage: cases.py PROGRAM SOURCE_ROOT glpk|no_glpk"""

import json
import pathlib
import subprocess
import sys
import tempfile

import jsonschema

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import some_of  # noqa: E402

DI = ".model di D(Ron=0 Vfwd=0)\n"

# netlist of netlists/: what each question is answered, or the elements that are named. With GLPK.
KNOWN = {
    "hard/hc01a": {"exists": "yes", "unique": "yes", "passive": "yes", "step": "yes"},
    "hard/hc06": {"exists": "yes", "multipliers": "depends"},
    "hard/hc07": {"multipliers": "depends"},
    "hard/hc11a": {"exists": "depends", "passive": "yes"},
    "hard/hc11b": {"exists": "depends"},
    "hard/hc11c": {"exists": "depends"},
    "hard/hc28b": {"unique": "no", "passive": "no"},
    "hard/hc30": {"unique": "no", "passive": "no", "step": "no"},
    "hard/hc36": {"unique": "yes", "passive": "no", "step": "depends"},
    "rectifiers/half_wave_rc": {"exists": "yes", "contracting": "yes", "periodic": "yes"},
    "multipliers/greinacher": {"periodic": "undecided"},
    "rectifiers/full_bridge": {"passive": "yes", "step": "yes"},
}

MADE = {
    # a step of v1 drags c1 along; the one of v2 goes through r2 only
    "jump": ("steps\nV1 a 0 PWL(0 0 1m 0 1m 5 2m 5)\nC1 b 0 1u\nD1 a b di\nV2 c 0 PWL(0 0 1m 0 1m 5)\n"
             "R2 c b 1k\n" + DI + ".tran 10u 2m\n.end\n",
             {"jumps": ("depends", ["v1"])}),
    # the same source without its step
    "ramp": ("ramp\nV1 a 0 PWL(0 0 1m 0 1.1m 5 2m 5)\nC1 b 0 1u\nD1 a b di\nR1 b 0 1k\n" + DI +
             ".tran 10u 2m\n.end\n", {"jumps": ("yes", [])}),
    # who gives: the amplifier, not the resistors
    "amplifier": ("gain\nD1 0 a di\nR1 a 0 1\nD2 0 b di\nR2 b 0 1\nG1 b 0 a 0 10\n" + DI +
                  ".op\n.end\n", {"passive": ("no", ["g1"])}),
    # of 1 ohm and 1 F: rate 1/2 of eps = 2/(RC)
    "rate": ("rate\nV1 a 0 SIN(0 1 1)\nD1 a b di\nR1 b 0 2\nC1 b 0 3\n" + DI + ".tran 1 9\n.end\n",
             {"contracting": ("yes", [])}),
    # no state with losses of its own, and all the same all trajectories meet
    "filter": ("filter\nV1 a 0 SIN(0 1 1)\nD1 a b di\nL1 b c 1\nC1 c 0 1\nR1 c 0 1\nD2 0 b di\n" + DI +
               ".tran 1 9\n.end\n", {"periodic": ("yes", []), "contracting": ("undecided", [])}),
    # c1 may keep any charge while both diodes block: nothing flows, nothing is lost
    "rest": ("rest\nV1 a 0 SIN(0 1 1)\nR0 a b 0.37\nC1 b c 1.3u\nD1 0 c di\nD2 c d di\nC2 d 0 0.7u\n"
             "R1 d 0 1.1k\n" + DI + ".tran 1 9\n.end\n", {"periodic": ("undecided", [])}),
    "tank": ("tank\nV1 a 0 SIN(0 1 1)\nD1 a b di\nL1 b 0 1\nC1 b 0 1\n" + DI + ".tran 1 9\n.end\n",
             {"periodic": ("undecided", [])}),
    "linear": ("linear\nV1 a 0 SIN(0 1 1)\nR1 a b 1\nC1 b 0 0.25\n.tran 1 9\n.end\n",
               {"contracting": ("yes", []), "jumps": ("yes", []), "stable": ("yes", [])}),
    # an open switch and a source's current, a closed one and its voltage: what no diode has a part in
    "cut_off": ("cut off\nI1 0 a 2\nS1 a b 0 0 si\nR1 b 0 1k\nD1 0 b di\nC1 b 0 1u\n.model si SW(vt=1)\n" + DI +
                ".tran 1m 1 uic\n.end\n", {"exists": ("depends", []), "unique": ("yes", [])}),
    "cut_off_alone": ("cut off\nI1 0 a 2\nS1 a b 0 0 si\nR1 b 0 1k\n.model si SW(vt=1)\n.tran 1m 1 uic\n.end\n",
                      {"exists": ("depends", [])}),
    "shorted": ("shorted\nV1 a 0 2\nS1 a 0 0 0 si\nR1 a b 1k\nD1 b 0 di\n.model si SW(vt=-1)\n" + DI +
                ".tran 1m 1 uic\n.end\n", {"exists": ("depends", [])}),
    "let_out": ("let out\nI1 0 a 2\nS1 a b 0 0 si\nR1 b 0 1k\nD1 0 b di\nC1 b 0 1u\nD2 a b di\n.model si SW(vt=1)\n" + DI +
                ".tran 1m 1 uic\n.end\n", {"exists": ("depends", [])}),
    "leaking": ("leaking\nI1 0 a 2\nS1 a b 0 0 si\nR1 b 0 1k\nD1 0 b di\nR2 a 0 1meg\n.model si SW(vt=1)\n" + DI +
                ".tran 1m 1 uic\n.end\n", {"exists": ("yes", [])}),
    # of matrices: no element is named, and the second system grows
    "two_systems": ("dalcs-system 2 two\nstate x 1\npair d\nmatrix A\n+ -1\nmatrix B\n+ 1\n"
                    "matrix C\n+ 1\nsystem\nstate y 2\npair e\nmatrix A\n+ 3\nmatrix B\n+ 1\n"
                    "matrix C\n+ 2\n.tran 10m 1\n.end\n", {"passive": ("yes", []),
                                                            "stable": ("yes", [])}),
}

INDEX_ONE = """dalcs-system 2 index one, strongly
.tran 10m 1
input u {source}
state x 1
unknown z
pair d
matrix A_I
+ -5
matrix B_I
+ 0.5
matrix A_II
+ 0.1
matrix B_II
+ -4
matrix Bbar_II
+ 1
matrix E_II
+ 1
matrix C_II
+ 1
.end
"""

# x' = x + lambda, -lambda in Sgn(x): not passive, M(s) no P-matrix, G(s) = 1/(s - 1) one for s > 1
UNSTABLE_RELAY = """dalcs-system 2 a relay on what runs away
.tran 10m 1
state x 0.5
interval r -1 1
matrix A
+ {a}
matrix B
+ 1
matrix C
+ {c}
matrix D
+ {d}
.end
"""

# two relays on one state: lambda is open, x is not ([BG13] 6.2; G(s) has a minor that is 0)
TWO_RELAYS = """dalcs-system 2 two relays on one state
.tran 10m 1
state x 0.5
interval r1 -1 1
interval r2 -1 1
matrix A
+ 1
matrix B
+ 1 1
matrix C
+ 1
+ 1
.end
"""

# system files: verdicts, conditions
SYSTEMS = {
    # beta = 0.1/4, k15 = 0.5 beta
    "p59": (INDEX_ONE.replace("{source}", "SIN(0 1 1)"),
            {"convergence": "yes"}, {"A12": "yes", "L5.4": "yes", "A13": "yes", "P5.9": "yes",
                                     "P5.2": "no", "L4.1.2": "yes", "L4.1.3": "no"}),
    "p59_jump": (INDEX_ONE.replace("{source}", "PULSE(0 1 0.1 0 0 0.1 0.2)"),
                 {"convergence": "depends"}, {"A13": "yes", "P5.9": "depends"}),
    "p59_ramp": (INDEX_ONE.replace("{source}", "PULSE(0 1 0.1 0.01 0.01 0.1 0.2)"),
                 {"convergence": "yes"}, {"P5.9": "yes"}),
    "relay": (UNSTABLE_RELAY.format(a=1, c=1, d=0),
              {"passive": "no", "exists": "yes", "unique": "yes", "multipliers": "yes", "jumps": "yes",
               "step": "depends"}, {"relay-P": "yes", "relay-K1": "yes", "P": "no"}),
    "relay_fed_forward": (UNSTABLE_RELAY.format(a=1, c=1, d=0.5),
                          {"exists": "yes", "unique": "yes"}, {"relay-P": "yes"}),
    "relay_backwards": (UNSTABLE_RELAY.format(a=1, c=-1, d=0),
                        {"unique": "no"}, {"relay-P": "no", "relay-K1": "no"}),
    "two_relays": (TWO_RELAYS,
                   {"exists": "yes", "unique": "yes", "multipliers": "depends", "jumps": "yes"},
                   {"relay-P": "no", "relay-K1": "yes"}),
}


def ladder(n):
    """n diodes and n capacitors."""
    lines = ["a ladder", "V1 n0 0 SIN(0 1 1k)"]
    for k in range(1, n + 1):
        lines += [f"R{k} n{k - 1} m{k} 1", f"D{k} m{k} n{k} di", f"C{k} n{k} 0 1u"]
    return "\n".join(lines + [f"Rl n{n} 0 1k", DI, ".tran 1u 1m", ".end", ""])


def check(program, netlist, *options):
    return subprocess.run([program, "check", str(netlist), *options], capture_output=True, text=True,
                          timeout=600)


class Cases:
    def __init__(self, program, schema):
        jsonschema.Draft202012Validator.check_schema(schema)
        self.program, self.validator = program, jsonschema.Draft202012Validator(schema)
        self.n = self.failures = 0

    def fail(self, name, why):
        self.failures += 1
        print(f"FAILED {name}: {why}")

    def read(self, name, netlist):
        self.n += 1
        done = check(self.program, netlist, "--json")
        if done.returncode != 0:
            self.fail(name, f"status {done.returncode}: {done.stderr}")
            return None
        result = json.loads(done.stdout)
        try:
            self.validator.validate(result)
        except jsonschema.ValidationError as error:
            self.fail(name, error.message[:300])
        text = check(self.program, netlist)
        if text.returncode != 0 or result["parts"] and "passive" not in text.stdout:
            self.fail(name, "no text")
        return result

    def answers(self, name, result, expected):
        for question, wanted in expected.items():
            verdict = result["parts"][0]["verdicts"][question]
            answer, elements = wanted if isinstance(wanted, tuple) else (wanted, None)
            if verdict["answer"] != answer:
                self.fail(name, f"{question}: {verdict['answer']}, not {answer}: {verdict['sentence']}")
            if elements is not None and verdict["elements"] != elements:
                self.fail(name, f"{question} names {verdict['elements']}, not {elements}")


def main(program, root, has_glpk):
    root = pathlib.Path(root)
    cases = Cases(program, json.loads((root / "doc" / "check.schema.json").read_text()))
    for netlist in some_of(sorted(root.glob("netlists/*/*.cir"))):
        name = str(netlist.relative_to(root / "netlists").with_suffix(""))
        result = cases.read(name, netlist)
        if result is not None and has_glpk:
            cases.answers(name, result, KNOWN.get(name, {}))
    with tempfile.TemporaryDirectory() as folder:
        for name, (text, expected) in MADE.items():
            netlist = pathlib.Path(folder) / f"{name}.cir"
            netlist.write_text(text)
            result = cases.read(name, netlist)
            if result is not None and has_glpk:
                cases.answers(name, result, expected)
            if result is not None and name == "rate":
                rate = result["parts"][0]["verdicts"]["contracting"]["value"]
                if abs(rate - 1.0 / 6.0) > 1e-3 / 6.0:
                    cases.fail(name, f"rate {rate}")
        for name, (text, expected, conditions) in SYSTEMS.items():
            netlist = pathlib.Path(folder) / f"{name}.dalcs"
            netlist.write_text(text)
            result = cases.read(name, netlist)
            if result is None or not has_glpk:
                continue
            cases.answers(name, result, expected)
            told = {c["id"]: c for c in result["parts"][0]["conditions"]}
            for id_, holds in conditions.items():
                if told[id_]["holds"] != holds:
                    cases.fail(name, f"{id_}: {told[id_]['holds']}, not {holds}: {told[id_]['because']}")
            if name == "p59" and "k15 = 0.0125 1/s" not in told["A13"]["because"]:
                cases.fail(name, told["A13"]["because"])
        many = pathlib.Path(folder) / "many.cir"
        many.write_text("equal parts\n" + "".join(
            f"V{k} a{k} 0 SIN(0 1 1)\nD{k} a{k} b{k} di\nR{k} b{k} 0 1\nC{k} b{k} 0 1\n"
            for k in range(20)) + DI + ".tran 1 9\n.end\n")
        result = cases.read("many", many)
        if result is not None and [part["equal"] for part in result["parts"]] != [20]:
            cases.fail("many", "equal parts are not told once")
        for n in (60, 3000):  # small, and beyond all matrices
            netlist = pathlib.Path(folder) / f"ladder{n}.cir"
            netlist.write_text(ladder(n))
            result = cases.read(f"ladder of {n}", netlist)
            if result is not None:
                cases.answers(f"ladder of {n}", result, {"passive": "yes", "step": "yes", "unique": "yes"})
                skipped = [c["because"] for c in result["parts"][0]["conditions"]
                           if c["holds"] == "not checked"]
                if n > 1000 and not any("too large" in (because or "") for because in skipped):
                    cases.fail(f"ladder of {n}", "does not say what was not checked")
        broken = pathlib.Path(folder) / "broken.cir"
        broken.write_text("broken\nR1 a\n.end\n")
        for arguments, status in (([str(broken)], 3), ([], 2), ([str(many), "--stop", "1"], 2),
                                  ([str(many), "--step", "-1"], 2), (["none.cir"], 4),
                                  (["--help"], 0)):
            cases.n += 1
            found = check(program, *arguments) if arguments else subprocess.run(
                [program, "check"], capture_output=True, text=True)
            if found.returncode != status or (status and not found.stderr):
                cases.fail(f"check {arguments}", f"status {found.returncode}, {found.stderr!r}")
    print(f"{cases.n} checks, {cases.failures} failed")
    return 1 if cases.failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3] == "glpk"))
