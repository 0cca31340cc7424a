"""Cuts a netlist whose transformed self differs down to the elements that it takes, and leaves both in files."""

import pathlib
import random
import re

from agreement import Reference
from circuits import write
from values import Unsupported


def without(circuit, chosen):
    """The circuit without some elements and what speaks of them; None if a control would be gone."""
    after = circuit.copy()
    gone = set(chosen)
    after.elements = [e for e in after.elements if e.name not in gone and not gone & set(e.coils or ())]
    names = {e.name for e in after.elements}
    if not after.elements or any(e.control and e.control not in names for e in after.elements):
        return None
    nodes = {"0", *after.nodes()}
    after.initial = [(s, x) for s, x in after.initial if set(s[1:]) <= nodes | names]
    after.measures = []
    after.default_signals()
    return after if after.signals else None


def difference(program, name, circuit, change_name, function):
    """What differs, None where nothing does or the circuit itself does not run."""
    try:
        reference = Reference(program, circuit, random.Random(name))
        change = function(circuit, random.Random(f"{name} {change_name}"))
        if reference.answer.status != 0 or change is None:
            return None
        return reference.compare(program, change)
    except AssertionError as crash:
        return str(crash).splitlines()[0]
    except (Unsupported, ValueError, KeyError):
        return None


def kind(found):
    """Two differences are of one kind if they begin alike: the same exit and law, or waveforms or events."""
    words = found.split()
    if words[0] == "exit":
        law = re.search(r"the audit finds (.*) broken", found)
        return words[:2] + [law and law[1]]
    signs = ("implicit Euler", "measurement", " off from ", " on from ", "times what is allowed")
    return [sign for sign in signs if sign in found][:1]


def shrunk(program, name, circuit, change_name, function, found):
    """The smallest circuit found by leaving elements out."""
    size = max(1, len(circuit.elements) // 2)
    while size:
        k = 0
        while k < len(circuit.elements):
            candidate = without(circuit, [e.name for e in circuit.elements[k:k + size]])
            other = candidate and difference(program, name, candidate, change_name, function)
            if other and kind(other) == kind(found):
                circuit, found = candidate, other
            else:
                k += size
        size //= 2
    return circuit, found


def keep(arguments, name, circuit, change_name, function, found):
    """Writes NAME.CHANGE.before.cir and .after.cir, with one line of what differs."""
    folder = pathlib.Path(arguments.keep)
    folder.mkdir(parents=True, exist_ok=True)
    small, words = shrunk(arguments.program, name, circuit, change_name, function, found)
    change = function(small, random.Random(f"{name} {change_name}"))
    stem = f"{name}.{change_name}".replace("*", "x")
    options = {key: x for key, x in change.arguments.items() if key != "lines"}
    for suffix, one in (("before", small), ("after", change.circuit)):
        one.title = f"{name} {change_name}: {words} {options or ''} ({suffix})"
        (folder / f"{stem}.{suffix}.cir").write_text(write(one, change.arguments.get("lines", [])
                                                           if suffix == "after" else []))
