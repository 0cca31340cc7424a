#!/usr/bin/env python3
"""Right operating points and responses: the audit finds nothing in them. Each netlist with .op in the place of its
analyses, with a sweep of its first source, and with .ac of that.

usage: sound_points.py PROGRAM SOURCE
"""

import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker  # noqa: E402

ANALYSES = re.compile(r"\.(tran|pss|env|ac|dc|op|four|meas|measure|losses|step|save|print|plot|wcase|mc|options|end)\b", re.I)
AT_LEAST = 70  # netlists with an operating point
LEAST_RESPONSES = 30

BALANCED = """a part into which sources bring nothing, and only capacitors tie it to the rest
i0 0 a {current}
i1 b 0 {current}
r1 a b {ohms}
c1 b 0 1u
c2 a d 1n
v1 d 0 5
r2 d 0 1k
i2 0 p {current}
i3 0 q {current}
i4 p 0 2*{current}
r3 p q {ohms}
c3 p 0 1
g1 0 s d 0 {ohms}
g2 s t d 0 {ohms}
f1 t 0 v1 0.3
f2 0 t v1 0.3
b1 t 0 I={{v(d)*{ohms}}}
c4 s 0 1u
d1 s t di
.model di D(vfwd=0.7)
.op
""".replace("2*{current}", "{{2*{current}}}")
BALANCES = (("2", "0.1m"), ("1m", "1k"), ("1n", "1g"), ("33k", "1"), ("0.1", "1u"), ("-7", "3meg"))


def at_rest(text, card):
    """The netlist without its analyses, and with `card`; a continued card goes with its first line."""
    kept, keeps, is_script = [], True, False
    for line in text.splitlines():
        is_script = is_script or line.strip().lower().startswith(".control")
        if not line.startswith("+"):
            keeps = not is_script and not ANALYSES.match(line.strip())
        is_script = is_script and not line.strip().lower().startswith(".endc")
        if keeps:
            kept.append(line)
    return "\n".join([*kept, card, ".end", ""])


def run(program, path, text, directory):
    """Runs beside the netlist, whose includes are named from there."""
    netlist = directory / path.name
    netlist.write_text(text)
    return subprocess.run([program, "run", netlist, "-o", directory / "out.csv", "--audit", "full"], cwd=path.parent,
                          capture_output=True, text=True, timeout=100)


def main():
    program, source = (pathlib.Path(a).resolve() for a in sys.argv[1:3])
    checker = Checker("sound_points")
    n, n_responses = 0, 0
    with tempfile.TemporaryDirectory() as name:
        for path in sorted(source.glob("netlists/**/*.cir")):
            text = path.read_text()
            cards = [".op"]
            first = re.search(r"^(v\w+)\s", text, re.I | re.M)
            cards += [f".dc {first.group(1)} -10 10 1"] if first else []
            cards += [".ac dec 3 0.1 10meg"] if first else []
            for card in cards:
                netlist = at_rest(text, card)
                if card.startswith(".ac"):
                    netlist = re.sub(rf"^({first.group(1)}\s.*)$", r"\1 AC 1", netlist, count=1, flags=re.M)
                ran = run(program, path, netlist, pathlib.Path(name))
                n += card == ".op" and ran.returncode == 0
                n_responses += card.startswith(".ac") and ran.returncode == 0
                if ran.returncode == 1:
                    checker.check("the audit finds" not in ran.stderr, f"{path.name} {card}: {ran.stderr}")
                elif ran.returncode == 0:
                    checker.check("audited at" in ran.stdout, f"{path.name} {card}: {ran.stdout}")
        for current, ohms in BALANCES:
            text = BALANCED.format(current=current, ohms=ohms)
            ran = run(program, pathlib.Path(name) / "balanced.cir", text, pathlib.Path(name))
            checker.check(ran.returncode == 0 and "audited at" in ran.stdout, f"{current} A: {ran.stdout}{ran.stderr}")
    checker.check(n >= AT_LEAST, f"only {n} netlists have an operating point")
    checker.check(n_responses >= LEAST_RESPONSES, f"only {n_responses} netlists have a response around it")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
