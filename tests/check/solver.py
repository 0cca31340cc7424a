#!/usr/bin/env python3
"""`dalcs check` and the program sdpa: not there, crashing, silent, lying. It says what was not checked, and
believes nothing.

usage: solver.py PROGRAM SOURCE_ROOT"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

ANSWER = """
import sys
if sys.argv[1:]:
    size = [int(word) for word in open(sys.argv[sys.argv.index("-ds") + 1]).read().split()[2:5]]
    n = int(open(sys.argv[sys.argv.index("-ds") + 1]).read().split()[0])
    numbers = ",".join(["{number}"] * (n + sum(k * k for k in size)))
    with open(sys.argv[sys.argv.index("-o") + 1], "w") as answer:
        answer.write("xVec = \\n{{" + ",".join(["{number}"] * n) + "}}\\nyMat = \\n{{" + numbers + "}}\\n")
"""

LIARS = {  # name: its source, what the report must say
    "ones": (ANSWER.format(number="+1.0e+00"), "did not verify"),
    "minus": (ANSWER.format(number="-1.0e+06"), "did not verify"),
    "nan": (ANSWER.format(number="nan"), "gave no answer"),
    "huge": (ANSWER.format(number="1e300"), "did not verify"),
    "silent": ("", "gave no answer"),
    "crash": ("import os\nos.kill(os.getpid(), 11)\n", "gave no answer"),
    "short": ("import sys\nopen(sys.argv[sys.argv.index('-o') + 1], 'w').write('xVec = {1')\n",
              "gave no answer"),
    None: (None, "is not there"),
}


def passive(program, netlist, path, folder):
    environment = {**os.environ, "PATH": path, "TMPDIR": str(folder)}
    done = subprocess.run([program, "check", str(netlist), "--json"], capture_output=True, text=True,
                          env=environment, check=True)
    part = json.loads(done.stdout)["parts"][0]
    return part["verdicts"]["passive"], [c["because"] for c in part["conditions"] if c["id"] == "K10"]


def main(program, root):
    netlist = pathlib.Path(root) / "netlists" / "papers" / "b22_6_1.dalcs"
    failures = 0
    for name, (source, wanted) in LIARS.items():
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "bin").mkdir()
            (folder / "scratch").mkdir()
            if source is not None:
                liar = folder / "bin" / "sdpa"
                liar.write_text(f"#!{sys.executable}\n{source}")
                liar.chmod(0o755)
            verdict, because = passive(program, netlist, str(folder / "bin"), folder / "scratch")
            if verdict["answer"] != "undecided" or wanted not in verdict["sentence"]:
                failures += 1
                print(f"FAILED {name}: {verdict['answer']}: {verdict['sentence']}, {because}")
            left = list((folder / "scratch").iterdir())
            if left:
                failures += 1
                print(f"FAILED {name}: leaves {left}")
    verdict, _ = passive(program, netlist, os.environ["PATH"], "/nonexistent")
    if verdict["answer"] != "undecided" or "no folder" not in verdict["sentence"]:
        failures += 1
        print(f"FAILED no folder: {verdict['sentence']}")
    print(f"{len(LIARS) + 1} solvers, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
