#!/usr/bin/env python3
"""The same answer whatever the units, the names, the company: netlists against their transformed selves.

usage: symmetry.py PROGRAM [--long] [--of tree|power] [--seeds N[-M]] [--power N[-M]] [--only WORD]
                   [--change WORD] [--keep FOLDER] [FILE ...]

Without more: a few transformations of each netlist of the tree, cut to forty periods, and of some random ones; what
known.txt lists must fail, all else must hold; --of: the tree's and those of random_netlists.py alone, or those of
random_power.py. --long: every transformation of each, whole. --seeds: random circuits of these numbers, --power: those
of random_power.py; with FILE: these netlists; --only and --change: those whose name holds WORD. --keep: leaves each
pair that differs in a folder, cut down to the elements that it takes."""

import argparse
import pathlib
import random
import sys
import zlib

import random_netlists
import random_power
import shrinking
from agreement import Reference
from dalcs_program import NETLISTS, some_of
from reading import read
from transformations import all_of_them
from values import Unsupported

HERE = pathlib.Path(__file__).resolve().parent
PERIODS = 40
SHORT_SEEDS = range(33)
SHORT_POWER = range(36)
OF_EACH = 3  # transformations of one netlist in a short run


def shortened(circuit):
    """Forty periods of its fastest source, and no more."""
    periods = [e.function[1][6] for e in circuit.of("vi")
               if e.function and e.function[0] == "pulse" and len(e.function[1]) > 6]
    periods += [1 / e.function[1][2] for e in circuit.of("vi") if e.function and e.function[0] == "sin"]
    if periods and circuit.stop > PERIODS * min(periods):
        circuit.stop = PERIODS * min(periods)
        circuit.step = min(circuit.step, circuit.stop / 100)
    return circuit


def netlists(arguments):
    """Name and circuit of all that is to be transformed; a word instead of what cannot be."""
    if not arguments.files and arguments.seeds is None and arguments.power is None:
        paths = some_of(sorted(NETLISTS.rglob("*.cir")))
        seeds = some_of(SHORT_SEEDS, 2) if not arguments.long else range(10 * len(random_netlists.KINDS))
        power = some_of(SHORT_POWER, 2) if not arguments.long else range(10 * len(random_power.KINDS))
        paths, seeds = ([], ()) if arguments.of == "power" else (paths, seeds)
        power = () if arguments.of == "tree" else power
    else:
        paths = [pathlib.Path(name) for name in arguments.files]
        seeds, power = arguments.seeds or (), arguments.power or ()
    for path in paths:
        if arguments.only in path.stem:
            try:
                yield path.stem, read(path.read_text(encoding="utf-8", errors="replace"))
            except Unsupported as reason:
                yield path.stem, str(reason)
    for circuit in [random_netlists.draw(seed) for seed in seeds] + [random_power.draw(seed) for seed in power]:
        if arguments.only in circuit.title:
            yield circuit.title.replace(" ", "_"), circuit


def known_failures():
    """{(netlist, transformation): reason} of known.txt."""
    lines = [line.split(None, 2) for line in (HERE / "known.txt").read_text().splitlines()
             if line.strip() and not line.startswith("#")]
    return {(netlist, change): reason for netlist, change, reason in lines}


class Session:
    """Counts the comparisons and prints them."""

    def __init__(self, arguments):
        self.arguments = arguments
        self.changes = {name: f for name, f in all_of_them().items() if arguments.change in name}
        self.count = {"compared": 0, "differ": 0, "known": 0, "skipped": 0}
        self.known = known_failures() if self.short() else {}
        self.seen = set()
        self.bad = 0

    def short(self):
        a = self.arguments
        return not (a.long or a.files or a.seeds is not None or a.power is not None or a.only or a.change)

    def chosen(self, name):
        """Those that are the turn of the netlist of this name, whatever other netlists there are."""
        if not self.short():
            return list(self.changes)
        names = list(self.changes)
        first = zlib.crc32(name.encode())
        return [names[(first + k) % len(names)] for k in range(OF_EACH)]

    def compare(self, name, circuit, reference, change_name):
        change = self.changes[change_name](circuit, random.Random(f"{name} {change_name}"))
        if change is None:
            self.count["skipped"] += 1
            return
        self.count["compared"] += 1
        try:
            found = reference.compare(self.arguments.program, change)
        except AssertionError as crash:
            found = str(crash).splitlines()[0]
        reason = self.known.pop((name, change_name), None)
        if found and reason:
            self.count["known"] += 1
        elif found:
            self.count["differ"] += 1
            print(f"FAIL {name} {change_name}: {found}", flush=True)
            if self.arguments.keep:
                shrinking.keep(self.arguments, name, circuit, change_name, self.changes[change_name], found)
        elif reason:
            self.bad += 1
            print(f"FAIL {name} {change_name}: passes, take it out of known.txt", flush=True)

    def netlist(self, name, circuit):
        self.seen.add(name)
        if isinstance(circuit, str):
            self.count["skipped"] += 1
            print(f"skip {name}: {circuit}")
            return
        if self.short():
            circuit = shortened(circuit)
        try:
            reference = Reference(self.arguments.program, circuit, random.Random(name))
        except AssertionError as crash:
            self.bad += 1
            print(f"FAIL {name}: {crash}")
            return
        for change_name in self.chosen(name):
            self.compare(name, circuit, reference, change_name)

    def finish(self):
        for name, change in [key for key in self.known if key[0] in self.seen or not self.arguments.of]:
            self.bad += 1
            print(f"FAIL known.txt: {name} {change} was not compared")
        print(", ".join(f"{n} {what}" for what, n in self.count.items()))
        return 0 if self.count["compared"] and not self.bad + self.count["differ"] else 1


def seeds_of(text):
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--long", action="store_true")
    parser.add_argument("--of", choices=("tree", "power"))
    parser.add_argument("--seeds", type=seeds_of)
    parser.add_argument("--power", type=seeds_of)
    parser.add_argument("--only", default="")
    parser.add_argument("--change", default="")
    parser.add_argument("--keep")
    parser.add_argument("files", nargs="*")
    session = Session(parser.parse_args())
    for name, circuit in netlists(session.arguments):
        session.netlist(name, circuit)
    return session.finish()


if __name__ == "__main__":
    sys.exit(main())
