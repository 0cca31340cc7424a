#!/usr/bin/env python3
"""What reading.py counts: syllables, sentences, and each kind of finding.

usage: reading_cases.py
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker  # noqa: E402  pylint: disable=wrong-import-position,import-error
import reading  # noqa: E402  pylint: disable=wrong-import-position,import-error

SYLLABLES = {"the": 1, "diode": 2, "voltage": 2, "capacitor": 4, "times": 1, "noted": 2, "solved": 1,
             "edges": 2, "table": 2, "rhythm": 1, "complementarity": 6, "source": 1, "sources": 2,
             "energy": 3, "simulate": 3, "condition": 3, "period": 3}
LONG = " ".join(["word"] * 36) + "."


def main():
    checker = Checker("reading_cases")
    for word, count in SYLLABLES.items():
        checker.check(reading.syllables(word) == count, f"{word}: {reading.syllables(word)}, not {count}")
    short = " ".join(["word"] * 35) + "."
    checker.check(not reading.measure(short)[0], "35 words are allowed")
    checker.check(len(reading.measure(LONG)[0]) == 1, "36 words are not")
    four = "\n".join(["One two three four five six seven eight nine ten."] * 13)
    checker.check(len(reading.measure(four)[0]) == 1, "a paragraph of 130 words is too long")
    checker.check(not reading.measure(four.replace("\n", "\n\n"))[0], "13 paragraphs are not")
    for left_out in (f"```\n{LONG}\n```", f"| {LONG} |", f"# {LONG}", f"    {LONG}", f"<!-- {LONG} -->"):
        checker.check(not reading.measure(left_out)[0], left_out[:20])
    for one in ("The authors R. W. Cottle and J.-S. Pang, e.g. here", "See p. 3 and fig. 4", "It is 1.5 V"):
        checker.check(len(reading.SENTENCE_END.split(reading.plain(one))) == 1, one)
    checker.check(len(reading.SENTENCE_END.split(reading.plain("It is 10 V. The end"))) == 2, "a unit")
    checker.check(reading.measure("The diode wants a current.")[0] and not
                  reading.measure("Circuits like this one conduct.")[0], "personified")
    easy, hard = "The cat sat on the mat.", "Complementarity presupposes dissipativity of interconnections."
    checker.check(reading.measure(easy)[1] > 100 and reading.measure(hard)[1] < 0, "reading ease")
    # 206.835 - 1.015 * 6 - 84.6 * 6/6
    checker.close(reading.measure(easy)[1], 116.145, 1e-9, "the formula")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
