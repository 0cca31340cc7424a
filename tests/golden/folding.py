#!/usr/bin/env python3
"""Warnings and notes that repeat for many elements: three are printed, the others counted in one line.

usage: folding.py PROGRAM

Circuits with N elements that call for the same message but for names between quotes, with two such kinds between each
other, with messages that differ in more, and with errors, which are all printed.
"""

import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

REST = re.compile(r"^dalcs: (warning|note): and (\d+) more of this kind: (.*)$", re.M)
V = "v1 n 0 1"
OP = ".op"


def many(n, pattern):
    return [pattern.replace("K", str(k)) for k in range(n)]


# cards, (part of a message, how many of them are printed, how many counted), ...
CASES = {
    "40 loose ends": ([V, *many(40, "rK n mK 1k"), OP], ("has one connection only", 3, 37)),
    "4 loose ends": ([V, *many(4, "rK n mK 1k"), OP], ("has one connection only", 3, 1)),
    "3 loose ends": ([V, *many(3, "rK n mK 1k"), OP], ("has one connection only", 3, 0)),
    "1 loose end": ([V, *many(1, "rK n mK 1k"), OP], ("has one connection only", 1, 0)),
    "loops of one element": ([V, "r n 0 1", *many(12, "rK n n 1k"), OP], ("both ends of", 3, 9)),
    "two kinds by turns": ([V, *many(10, "rK n mK 1k\nraK n n 1k"), OP],
                           ("has one connection only", 3, 7), ("both ends of", 3, 7)),
    "nodes that only control": ([V, *many(7, "eK oK 0 cK 0 2\nrK oK 0 1"), OP], ("only controls", 3, 4)),
    "floating parts": (["v1 n 0 1", "rn n 0 1", *many(9, "laK n mK 1m\nkK laK lbK 0.9\nlbK pK qK 1m\nrK pK qK 1\nrmK mK 0 1"), OP],
                       ("to ground: its voltage is 0 by convention", 3, 6)),
    "capacitors alone": ([V, *many(30, "caK n mK 1u\ncbK mK 0 1u"), OP], ("only capacitors connect", 3, 27)),
    "two values of one kind": ([V, *many(5, "daK n mK dK\nrK mK 0 1\n.model dK d(is=1e-1K)"), OP],
                               ("the exponential diode is replaced by its tangent", 5, 0)),
    "in two files of messages": ([V, *many(5, "rK n mK 1k"), *many(6, "caK n qK 1u\ncbK qK 0 1u"), OP],
                                 ("has one connection only", 3, 2), ("only capacitors connect", 3, 3)),
}


def judge(checker, name, cards, kinds):
    for quiet in (False, True):
        outcome = run(sys.argv[1], "\n".join([name, *cards, ".end", ""]), method=None, quiet=quiet)
        if not checker.check(outcome.status == 0, f"{name}: {outcome.stderr[:300]}"):
            return
        counted = {sentence: int(n) for _, n, sentence in REST.findall(outcome.stderr)}
        plain = REST.sub("", outcome.stderr)
        for part, printed, left in kinds:
            is_note = f"note: {part}" in plain or part in ("the exponential diode is replaced by its tangent", "only capacitors connect",
                                                           "to ground: its voltage is 0 by convention")
            expected = (0, 0) if quiet and is_note else (printed, left)
            found = (plain.count(part), sum(n for sentence, n in counted.items() if part in sentence))
            checker.check(found == expected, f"{name}, quiet {quiet}: {part}: {found}, not {expected}")


def errors(checker):
    outcome = run(sys.argv[1], "\n".join(["errors", V, *many(9, "rK n 0 abcK"), OP, ".end", ""]), method=None)
    checker.check(outcome.status == 3 and outcome.stderr.count("error:") == 9, f"errors: {outcome.stderr}")
    checker.check(not REST.search(outcome.stderr), "errors are counted")


def main():
    checker = Checker("folding")
    for name, (cards, *kinds) in CASES.items():
        judge(checker, name, cards, kinds)
    errors(checker)
    return checker.finish()


sys.exit(main())
