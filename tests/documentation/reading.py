#!/usr/bin/env python3
"""Measures how hard pages are to read, and fails where one is too hard.

usage: reading.py [--list] SOURCE_FOLDER [PAGE...]

A page in USER_PAGES or DEVELOPER_PAGES has no sentence above 35 words, no paragraph above 120 words and a Flesch
reading ease above 45:

    206.835 - 1.015 words/sentences - 84.6 syllables/words        (R. Flesch, J. Appl. Psych. 32, 1948)

No thing of a circuit acts as a person either (PERSONIFIED): a circuit asks, likes or wants nothing.

What counts: paragraphs and items of lists. Blocks of code, tables, headings and the addresses of
links do not. A name in `code` and a number are one word of a sentence, but not of the syllables,
for nobody reads them letter by letter. A sentence ends with . ? or ! before a space or the end;
the dots of "e.g.", "p.", "fig." and initials end none. The syllables of a word are its groups of vowels:
a final e, es or ed that is silent is none, "io" of diode (not of "tion") is two, and each word has one
at least.
"""

import argparse
import pathlib
import re
import sys

USER_PAGES = [
    "README.md", "doc/accuracy.md", "doc/audit.md", "doc/bode.md", "doc/check.md", "doc/compare.md",
    "doc/README.md", "doc/averaged.md", "doc/figures.md", "doc/first-circuit.md", "doc/gallery.md", "doc/install.md",
    "doc/library.md", "doc/lessons/*.md", "doc/magnetics.md", "doc/methods.md", "doc/netlist.md",
    "doc/ngspice-library.md", "doc/output.md", "doc/plots.md", "doc/python.md", "doc/steady.md", "doc/sweeps.md",
    "doc/system-file.md", "doc/words.md",
]
DEVELOPER_PAGES = ["doc/adding-a-*.md", "doc/architecture.md", "doc/auditor.md", "doc/integrator.md",
                   "doc/observers.md", "doc/one-step.md", "doc/testing.md", "doc/theory.md", "tools/wasm/README.md"]
SENTENCE_LIMIT, PARAGRAPH_LIMIT, EASE_LIMIT = 35, 120, 45.0

FENCE = re.compile(r"^ *```.*?^ *```$", re.MULTILINE | re.DOTALL)
SENTENCE_END = re.compile(r"(?<!\be\.g)(?<!\bi\.e)(?<!\bp)(?<!\bpp)(?<!\bch)(?<!\bfig)(?<!\beq)"
                          r"(?<!\bthm)(?<!\bvs)[.?!]+[\"')*\]]*(?=\s|$)")
INITIAL = re.compile(r"(?<!\d )(?:(?<=[\s(.-])|^)([A-Z])\.(?=[ -]?[A-Z])")  # "R. W. Cottle", not "10 V. The"
PERSONIFIED = re.compile(
    r"\b(?:circuit|diode|switch|coil|capacitor|inductor|source|relay|netlist|file|line|card|law|mode|matrix|"
    r"equation|rule|step|error|tolerance|report|summary|message)(?:s|es)? "
    r"(?:asks?|likes|tells?|wants?|knows?|thinks?|believes?|speaks?|cares?|minds|wishes|vouch\w*)\b")
WORD = re.compile(r"[^\s]*[^\W_][^\s]*")


def paragraphs(text):
    """Each paragraph or item of a page with its line."""
    text = FENCE.sub(lambda block: "\n" * block.group().count("\n"), text)
    text = re.sub(r"<!--.*?-->", lambda found: "\n" * found.group().count("\n"), text, flags=re.DOTALL)
    pieces, start = [], 0
    for number, line in enumerate(text.split("\n") + [""], 1):
        bare = line.strip()
        left_out = line.startswith("    ") and not pieces or bare.startswith("|")
        begins = re.match(r"([-*+]|\d+\.) |#+ ", bare)
        if (not bare or left_out or begins) and pieces:
            yield start, " ".join(pieces)
            pieces = []
        if bare and not left_out:
            start = start if pieces else number
            pieces.append(re.sub(r"^([-*+]|\d+\.|#+) ", "", bare))
            if bare.startswith("#"):
                pieces = []


def plain(paragraph):
    """Links and pictures as their text; each `code` as a word with no syllables."""
    paragraph = INITIAL.sub(r"\1", re.sub(r"`[^`]+`", "0", paragraph))
    return re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", paragraph)


def syllables(word):
    word = re.sub(r"[^a-z]", "", word.lower())
    word = re.sub(r"(?<=[^aeiouy])(es|ed)$", lambda end: end.group()
                  if re.search(r"(?:[dt]ed|[sxz]es|[cg]es|ches|shes)$", word) else "s", word)
    word = re.sub(r"(?<=[^aeiouyl])e$|(?<=[aeiouy]l)e$", "", word)
    word = re.sub(r"(?<![tscgx])i(?=[aou])", "i-", word)
    return max(1, len(re.findall(r"[aeiouy]+", word)))


def spoken(sentence):
    """The words whose syllables count: no code, no numbers."""
    pieces = re.split(r"[\s/-]+", sentence)
    return [piece for piece in pieces if re.search(r"[A-Za-z]", piece) and not re.search(r"\d", piece)]


def measure(text):
    """The findings of a page, as (line, words), and its reading ease."""
    findings, counts = [], [0, 0, 0, 0]
    for line, paragraph in paragraphs(text):
        prose = plain(paragraph)
        if len(WORD.findall(prose)) > PARAGRAPH_LIMIT:
            findings.append((line, f"a paragraph of {len(WORD.findall(prose))} words: {prose[:60]}..."))
        findings += [(line, f"personified: {found}") for found in PERSONIFIED.findall(prose)]
        for sentence in SENTENCE_END.split(prose):
            words = WORD.findall(sentence)
            if not words:
                continue
            if len(words) > SENTENCE_LIMIT:
                findings.append((line, f"a sentence of {len(words)} words: {sentence.strip()[:90]}..."))
            counts[0] += 1
            counts[1] += len(words)
            counts[2] += len(spoken(sentence))
            counts[3] += sum(syllables(word) for word in spoken(sentence))
    sentences, words, said, sounds = (max(1, count) for count in counts)
    return findings, 206.835 - 1.015 * words / sentences - 84.6 * sounds / said


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--list", action="store_true", help="print the ease of each page")
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("pages", nargs="*")
    options = parser.parse_args()
    failed = 0
    for pattern in options.pages or USER_PAGES + DEVELOPER_PAGES:
        for page in sorted(options.source.glob(pattern)) or sys.exit(f"there is no {pattern}"):
            name = page.relative_to(options.source)
            findings, ease = measure(page.read_text(encoding="utf-8"))
            if ease <= EASE_LIMIT:
                findings.append((1, f"reading ease {ease:.1f}, not above {EASE_LIMIT:g}"))
            if options.list:
                print(f"{ease:5.1f}  {name}: {len(findings)} findings")
            for line, finding in findings:
                print(f"{name}:{line}: {finding}")
            failed += len(findings)
    print(f"reading: {failed} findings")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
