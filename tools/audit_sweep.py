#!/usr/bin/env python3
"""The audit of every netlist in some folders, drawn and full: none may find anything.

usage: audit_sweep.py DALCS [-j N] [--timeout S] [FOLDER | FILE ...]

Without folders those of the repository: netlists and tests. Each .cir, .net and .sp runs with the default audit and with
--audit full. Told are runs that the audit ends or in which it finds more than a component is held to, and runs that one
of the two finds and the other does not; a netlist that fails for another reason, or takes longer, is counted.
"""

import argparse
import concurrent.futures
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
KINDS = (".cir", ".net", ".sp")


def audited(program, netlist, how, timeout):
    """("holds" | "alarm" | "fails" | "takes long", what was said)."""
    with tempfile.TemporaryDirectory() as directory:
        command = [program, "run", str(netlist), "-o", f"{directory}/out.raw", "--audit", how]
        try:
            ran = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=timeout)
        except subprocess.TimeoutExpired:
            return "takes long", ""
    told = [line.strip() for line in (ran.stdout + ran.stderr).splitlines()
            if "the audit finds" in line or (line.startswith("  proof") and "more than" in line)]
    if told and any("error" in line or "more than" in line for line in told):
        return "alarm", told[0]
    return ("holds" if ran.returncode == 0 else "fails"), ""


def both(program, netlist, timeout):
    return [audited(program, netlist, how, timeout) for how in ("sample", "full")]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dalcs")
    parser.add_argument("places", nargs="*", type=pathlib.Path, default=[ROOT / "netlists", ROOT / "tests"])
    parser.add_argument("-j", type=int, default=2)
    parser.add_argument("--timeout", type=float, default=25.0)
    given = parser.parse_intermixed_args()
    netlists = sorted(p for place in given.places
                      for p in ([place] if place.is_file() else place.rglob("*")) if p.suffix in KINDS)
    counts = {}
    with concurrent.futures.ThreadPoolExecutor(given.j) as pool:
        outcomes = pool.map(lambda n: both(given.dalcs, n, given.timeout), netlists)
        for netlist, (sample, full) in zip(netlists, outcomes):
            for how, (verdict, said) in (("sample", sample), ("full", full)):
                counts[how, verdict] = counts.get((how, verdict), 0) + 1
                if verdict == "alarm":
                    print(f"{netlist}: {how}: {said}", flush=True)
    for (how, verdict), n in sorted(counts.items()):
        print(f"{how}: {n} {verdict}")
    return 1 if any(verdict == "alarm" for _, verdict in counts) else 0


if __name__ == "__main__":
    sys.exit(main())
