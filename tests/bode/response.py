#!/usr/bin/env python3
"""Ten circuits of a kind: their response around the orbit against one by matrix exponentials.

usage: response.py PROGRAM KIND

The reference (exact.py) takes the times of events and the states at the start from the program, and is itself right
where the orbit comes back and guards are 0 at their events.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import exact
import circuits

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

TOLERANCE = 1e-7
N_FREQUENCIES = 20
# All others are 0 in a circuit whose halves, or sixths, of a period are alike.
SIDEBANDS = {"llc": (-2, 2, 4), "six_pulse": (-6, 6, 12)}


def frequencies(case):
    """From 10 Hz, or a thousandth of the orbit's, to nearly twice the orbit's frequency."""
    top = 1.97 / case.period
    low = min(10.0, top / 2000)
    return [low * (top / low) ** (k / (N_FREQUENCIES - 1)) for k in range(N_FREQUENCIES)]


def run(program, folder, case, sideband):
    asked = frequencies(case)
    name = {e[0] for e in case.elements if e[1] == "L"}
    signals = " ".join(f"i({o})" if o in name else f"v({o})" for o in case.outputs)
    text = (circuits.netlist(case) + f".save {signals}\n.ac sideband={sideband} list "
            + " ".join(map(repr, asked)) + "\n.pss uic\n")
    (folder / "c.cir").write_text(text)
    for ending in ("json", "csv"):
        (folder / f"c.{ending}").unlink(missing_ok=True)
    done = subprocess.run([program, "run", "c.cir", "-q", "-o", "c.csv", "--report", "c.json", "--tol", "1e-9"],
                          cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return done, None, None
    lines = (folder / "c.csv").read_text().splitlines()
    rows = [[float(v) for v in line.split(",")] for line in lines[1:]]
    values = [(row[0], [complex(row[1 + 2 * k], row[2 + 2 * k]) for k in range(len(case.outputs))])
              for row in rows]
    return done, values, json.loads((folder / "c.json").read_text())


def groups(report, period):
    """Events within the period, those of one time together."""
    found = []
    for event in report["events"]:
        if not 0.0 < event["time"] < period * (1 - 1e-12):
            continue
        if found and event["time"] - found[-1][0] <= 1e-12 * period:
            found[-1][1].append((event["element"], event["state"]))
        else:
            found.append((event["time"], [(event["element"], event["state"])]))
    return found


def make_orbit(checker, case, circuit, report):
    pairs = {e[0] for e in case.elements if e[1] in "DS"}
    found = groups(report, case.period)
    first = {}
    for _, members in found:
        for element, state in members:
            first.setdefault(element, state == "off")
    on = frozenset(p for p in pairs if first.get(p, False))
    start, events = on, []
    for time, members in found:
        before = on
        for element, state in members:
            on = on | {element} if state == "on" else on - {element}
        events.append([time, on, None, before, members])
    states = [report["steady"]["states"][name] for name in circuit.states]
    plain = exact.Orbit(circuit, case.period, states, start, [tuple(e[:3]) for e in events])
    off = plain.misses(states)
    checker.check(off <= 1e-8, f"{case.name}: the orbit misses its beginning by {off:.2g}")
    for event, span in zip(events, plain.spans):
        event[2] = cause(checker, case, event, span)
    return exact.Orbit(circuit, case.period, states, start, [tuple(e[:3]) for e in events])


def cause(checker, case, event, span):
    """What ends a mode: the switch, as the case says, else the diode whose current or voltage is 0."""
    members = event[4]
    for member in members:
        if member[0].startswith("s"):
            return case.ends.get(member)
    mode, end, x = span[0], span[2], span[4]
    size = max(abs(mode.value(n, x, end)) for n in case.outputs) + 1e-300
    least = min(members, key=lambda m: abs(mode.value(m[0], x, end)))
    rest = abs(mode.value(least[0], x, end))
    checker.check(rest <= 1e-6 * max(size, 1.0), f"{case.name}: {least} has {rest:.2g} at {end}")
    return ("guard", least[0], 0.0, 0.0)


def look_at(checker, program, folder, case, sideband):
    done, values, report = run(program, folder, case, sideband)
    if not checker.check(done.returncode == 0, f"{case.name}: {done.stderr}"):
        return 0.0
    checker.check(report["response"]["exact"], f"{case.name}: not exact")
    circuit = exact.Circuit([(n, k, nodes, v) for n, k, nodes, v in case.elements], case.ac, case.omega,
                            case.couplings)
    orbit = make_orbit(checker, case, circuit, report)
    mine = [orbit.response(f, case.outputs, sideband) for f, _ in values]
    worst = 0.0
    for k, name in enumerate(case.outputs):
        largest = max(abs(m[name]) for m in mine)
        for (frequency, value), m in zip(values, mine):
            off = abs(value[k] - m[name]) / max(abs(m[name]), 1e-3 * largest)
            worst = max(worst, off)
            checker.check(off <= TOLERANCE, f"{case.name} {sideband}: {name} is off by {off:.2g} at "
                                            f"{frequency:.6g} Hz, {value[k]:.9g} for {m[name]:.9g}")
    return worst


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    kind = sys.argv[2]
    checker = dalcs_program.Checker(kind)
    with tempfile.TemporaryDirectory() as name:
        for k, case in enumerate(circuits.KINDS[kind]()):
            for sideband in (0, SIDEBANDS.get(kind, (-1, 1, 3))[k % 3]) if k < 6 else (0,):
                worst = look_at(checker, program, pathlib.Path(name), case, sideband)
                print(f"{case.name}, sideband {sideband}: off by {worst:.2g}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
