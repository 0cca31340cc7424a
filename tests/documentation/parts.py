#!/usr/bin/env python3
"""doc/parts.md lists every part that the program reads; each has a page, an example, and the tests that it names.

usage: parts.py SOURCE_FOLDER

What the program reads is taken from its source: letters of elements, types of models, code models, functions of
LTspice's A elements, and subcircuits of the installed libraries.
"""

import pathlib
import re
import sys

TESTS = pathlib.Path(__file__).resolve().parents[1]
sys.path += [str(TESTS / "support")]
from dalcs_program import Checker  # noqa: E402  pylint: disable=wrong-import-position,import-error

BLOCK = re.compile(r"^```spice.*\n((?:.*\n)*?)```$", re.MULTILINE)
# Passive parts by a model have the values of their elements.
NOT_PARTS = {"r", "res", "c", "cap", "l", "ind"}


def known(source):
    """What each group of the table has to have."""
    def find(pattern, *names):
        text = "".join((source / name).read_text(encoding="utf-8") for name in names)
        return set(re.findall(pattern, text))

    letters, = find(r'strchr\("(\w+)", letter\)', "src/circuit/card_table.c")
    models = find(r'\{"(\w+)", DALCS_MODEL_(?!OTHER)\w+, "', "src/circuit/model.c") - NOT_PARTS
    blocks = find(r'\{"(\w+)", NULL, NULL\}', "src/circuit/block.c")
    roles = (source / "src/language/roles.c").read_text(encoding="utf-8")
    functions = re.findall(r'"(\w+)"', next(part for part in roles.split("{") if '"srflop"' in part).split("}")[0])
    libraries = find(r"(?im)^\.subckt (\S+)", *(f"libraries/{path.name}" for path in (source / "libraries").iterdir()))
    return {"Elements": set(letters.replace("a", "")) | {"k", "x"}, "Models": models | {"transformer"},
            "Functions of LTspice": set(functions), "Code models of XSPICE": blocks - {"transformer"},
            "Installed libraries": {name.lower() for name in libraries}}


def use_of(group, part):
    """The pattern of a netlist's line that has this part."""
    part = re.escape(part)
    return re.compile({
        "Elements": rf"(?im)(?:^|[\"'{{(\\]|\\n){part}[\d{{]\S* +\S+ +\S+",
        "Models": rf"(?im)\.model\s+\S+\s+(?:ako:)?{part}\b|(?:[\"'] *|[\"']\w+ +){part} *(?:\(|[\"'])",
        "Code models of XSPICE": rf"(?im)\b{part} *[(\"']|\.model\s+\S+\s+{part}\b",
        "Installed libraries": rf"(?im)[\s\"']{part}(?=[\s\"',]|$)"}.get(group, rf"(?i)\b{part}\b"))


def anchors(text):
    heads = re.findall(r"(?m)^#+ (.*)$", text)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


def rows_of(page):
    """Group, names of parts, and the other cells."""
    group = None
    for line in re.findall(r"(?m)^\| (.*) \|$", page)[1:]:
        cells = [cell.strip() for cell in re.split(r" ?\| ?", line)]
        if cells[0].startswith("**"):
            group = cells[0].strip("*")
        elif group:
            yield group, re.findall(r"`([^`]+)`", cells[0]), cells


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("parts")
    pages = {path.name: path.read_text(encoding="utf-8") for path in (source / "doc").glob("*.md")}
    examples = "\n".join(block for text in pages.values() for block in BLOCK.findall(text))
    listed, runs = {}, 0
    for group, parts, cells in rows_of(pages["parts.md"]):
        listed.setdefault(group, set()).update(part.lower() for part in parts)
        law = re.fullmatch(r"\[.+\]\((\S+)#(\S+)\)", cells[1])
        if checker.check(law is not None, f"{cells[0]}: its law has no link to a page"):
            checker.check(law.group(2) in anchors(pages[law.group(1)]), f"{cells[0]}: no heading {law.group(2)}")
            for part in parts:
                checker.check(part.lower() in pages[law.group(1)].lower(), f"{law.group(1)} does not name {part}")
        tests = [cells[2]] + [cell for cell in cells[3:] if cell not in ("none", "differs")]
        for name in tests:
            path = source / "tests" / name.strip("`")
            if not checker.check(path.is_file(), f"{cells[0]}: there is no test {name}"):
                continue
            text = path.read_text(encoding="utf-8")
            for part in parts:
                runs += 1
                checker.check(use_of(group, part).search(text) is not None, f"tests/{name} does not use {part}")
        # What warns has no example in doc/, where none may: those of its test; nor has what a program gives.
        if "warning" not in cells[1] and parts != ["EXTERNAL"]:
            for part in parts:
                checker.check(use_of(group, part).search(examples) is not None, f"{part} has no example in doc/")
    for group, parts in known(source).items():
        checker.check(parts <= listed.get(group, set()), f"not in doc/parts.md: {sorted(parts - listed.get(group, set()))}")
        checker.check(listed.get(group, set()) <= parts | {"d", "sw"}, f"not read: {sorted(listed.get(group, set()) - parts)}")
    print(f"{sum(map(len, listed.values()))} parts, {runs} places in tests")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
