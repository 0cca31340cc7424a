#!/usr/bin/env python3
"""`dalcs check` and `dalcs run` of the same netlist: what one says of it, the other must not contradict.

usage: contradictions.py PROGRAM [--random COUNT [FIRST]] [NETLIST or FOLDER...]

Where `check` shows that a solution exists, the run must not refuse for want of one; where it shows that implicit
Euler is solvable for every step, nor may that. Where it shows that states do not jump after the start, none may be reported;
where current, voltage and states are the only ones, none may be reported as open. Verdicts hold for the
switches where they start, so of circuits with switches the last three are not asked. What the run stops for with other words
(values that no number holds, a netlist that is not one) is not looked at. Random circuits are those of tests/symmetry,
of tests/osnsp and of random_circuits.py in turn.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

TESTS = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS / folder) for folder in ("support", "symmetry", "osnsp")]
import degenerate  # noqa: E402
import random_circuits  # noqa: E402
import random_netlists  # noqa: E402
from circuits import write  # noqa: E402
from dalcs_program import Checker, some_of  # noqa: E402

STEPS_OF_EULER = 1000
NOT_SOLVED = "no solution exists", "none was found", "could be certified"
LIMIT = 120  # s


def random_text(seed):
    kind, seed = seed % 3, seed // 3
    if kind == 0:
        return write(random_netlists.draw(seed))
    if kind == 1:
        return degenerate.draw(seed)
    chance = random_circuits.random.Random(f"contradictions {seed}")
    circuit = random_circuits.Circuit(chance).passive(disguised=chance.random() < 0.5)
    if chance.random() < 0.3:
        circuit.plant()
    return circuit.text().replace(".op", ".tran 1u 1m uic")


def output_of(command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False,
                          stdin=subprocess.DEVNULL, timeout=LIMIT)
    return done.returncode, done.stderr


def json_of(program, *words):
    done = subprocess.run([program, "check", *map(str, words), "--json"], capture_output=True, text=True,
                          check=False, stdin=subprocess.DEVNULL, timeout=LIMIT)
    return json.loads(done.stdout) if done.returncode == 0 else None


def look(program, checker, case, path, folder):
    checked = json_of(program, path)
    if checked is None:
        return
    parts = checked["parts"]
    said = {key: {part["verdicts"][key]["answer"] for part in parts}
            for key in ("exists", "unique", "multipliers", "jumps", "step")}
    has_switches = any(part["size"]["switches"] for part in parts)
    report_path = folder / "report.json"
    report_path.unlink(missing_ok=True)
    command = [program, "run", path, "--quiet", "-o", folder / "out.csv", "--report", report_path]
    status, message = output_of(command)
    refused = status != 0 and any(words in message for words in NOT_SOLVED)
    if said["exists"] == {"yes"}:
        checker.check(not refused, f"{case}: a solution exists, but the run says: {message.strip()}")
    checker.check("no" not in said["exists"] or status != 0, f"{case}: no solution exists, but the run has one")
    if has_switches or not report_path.exists():
        return
    report = json.loads(report_path.read_text())
    jumps = [jump["time"] for jump in report["jumps"] if jump["time"] > 0.0]
    checker.check(said["jumps"] != {"yes"} or not jumps, f"{case}: states do not jump, but they do at {jumps[:3]}")
    open_ = report["nonunique"] if report["stop"] > 0.0 else []  # of an operating point nothing is said
    is_sole = said["unique"] == {"yes"} == said["multipliers"]
    checker.check(not (is_sole and open_), f"{case}: all is unique, but the run says {str(open_[:1])[:200]}")
    if said["step"] == {"yes"} == said["exists"] and status == 0 and report["stop"] > 0.0:
        step = report["stop"] / STEPS_OF_EULER
        status, message = output_of([*command, "--method", "euler", "--step", step])
        refused = status != 0 and any(words in message for words in NOT_SOLVED)
        checker.check(not refused, f"{case}: euler is solvable, but says: {message.strip()}")


def main():
    program, words = sys.argv[1], sys.argv[2:]
    checker = Checker("contradictions")
    count, first = 0, 0
    if words and words[0] == "--random":
        count = int(words[1])
        first = int(words[2]) if len(words) > 2 and words[2].isdigit() else 0
        words = words[3 if len(words) > 2 and words[2].isdigit() else 2:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        paths = [path for word in map(pathlib.Path, words)
                 for path in (sorted(word.rglob("*.cir")) if word.is_dir() else [word])]
        for path in some_of(paths):
            try:
                look(program, checker, path, path.resolve(), folder)
            except subprocess.TimeoutExpired:
                print(f"{path}: takes too long, not asked")
        for seed in some_of(range(first, first + count)):
            path = folder / "random.cir"
            path.write_text(random_text(seed))
            try:
                look(program, checker, f"seed {seed}", path, folder)
            except subprocess.TimeoutExpired:
                print(f"seed {seed}: takes too long, not asked")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
