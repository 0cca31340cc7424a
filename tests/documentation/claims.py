#!/usr/bin/env python3
"""The figures on the README's first screen are those of the tables in doc/accuracy.md and of the tests.

usage: claims.py SOURCE_FOLDER

The tables are measured: the suite `reference` repeats the first, tools/bench/work_precision the second.
"""

import pathlib
import re
import sys

TESTS = pathlib.Path(__file__).resolve().parents[1]
sys.path += [str(TESTS / "support"), str(TESTS / "mutations")]
import adversary  # noqa: E402  pylint: disable=wrong-import-position,import-error
import mutations  # noqa: E402  pylint: disable=wrong-import-position,import-error
from dalcs_program import Checker  # noqa: E402  pylint: disable=wrong-import-position,import-error


def rows_below(text, header):
    """The cells of the table with this header, without its two first lines."""
    table = text[text.index(header):].split("\n\n")[0].split("\n")[2:]
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in table]


def claimed(readme, pattern):
    found = re.search(pattern, readme)
    if not found:
        sys.exit(f"the README does not say {pattern}")
    return [float(number) for number in found.groups()]


def main():
    source = pathlib.Path(sys.argv[1])
    readme = (source / "README.md").read_text(encoding="utf-8")
    accuracy = (source / "doc/accuracy.md").read_text(encoding="utf-8")
    checker = Checker("claims")

    number, error, event = claimed(readme, r"In (\d+) circuits with exact solutions, every waveform is "
                                           r"right to (\S+) and every diode event to (\S+) of")
    exact = rows_below(accuracy, "| case | events | steps, default |")
    checker.check(len(exact) == number, f"{len(exact)} circuits, not {number:g}")
    checker.check(max(float(row[3]) for row in exact) <= error, f"an error above {error:g}")
    checker.check(max(float(row[4]) for row in exact) <= event, f"an event off by more than {event:g}")

    least, most = claimed(readme, r"needs (\S+) to (\S+) times less CPU time than ngspice")
    speed = rows_below(accuracy, "| circuit | dalcs' error | its CPU ms |")
    ratios = [float(row[5]) for row in speed]
    checker.check(len(speed) == 10, f"{len(speed)} circuits, not ten")
    checker.check(least <= min(ratios) < 1.05 * least, f"at least {min(ratios)}, not {least}")
    checker.check(most <= max(ratios) < 1.05 * most, f"at most {max(ratios)}, not {most}")
    checker.check(all(float(row[1]) < float(row[3]) for row in speed), "ngspice is more accurate somewhere")

    faults, = claimed(readme, r"finds all (\d+) faults that the tests build into the solver")
    planted = len(mutations.MUTATIONS) + len(adversary.MUTATIONS)
    checker.check(faults == planted, f"{planted} faults, not {faults:g}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
