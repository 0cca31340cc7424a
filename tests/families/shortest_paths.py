#!/usr/bin/env python3
"""A graph of arcs that are diodes in series with sources finds shortest paths: exact node voltages.

usage: shortest_paths.py PROGRAM ARCS...

An arc of length l from node u to node w is a diode from w to a node of its own, and a source of l
volts from there to u: v(w) <= v(u) + l. At each node 1 A comes in, which leaves through the root,
at ground. So all voltages are as high as the arcs let them be: the distances from the root (the
dual of the linear program of shortest paths; Dennis, Mathematical Programming and Electrical
Networks, 1959), and the currents run down a tree of shortest paths. Where there are several such
trees the currents are not unique, the voltages are. Dijkstra's algorithm finds the same distances.
"""

import heapq
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import IS_LONG, Checker, run, some_of  # noqa: E402

CERTIFIED = 2e-13
VOLTAGE = 1e-12  # of the largest distance
CURRENT = 1e-9   # of all that is drawn
LARGE = 1000     # arcs, above which one grid has to do: a random graph fills its factors


def tree_and_more(n_arcs, length):
    """A random graph with about a sixth as many nodes as arcs, each of them reached."""
    chance = random.Random(f"graph {n_arcs}")
    n = max(3, n_arcs // 6)
    arcs = [(chance.randrange(w), w, length(chance)) for w in range(1, n)]
    while len(arcs) < n_arcs:
        u, w = chance.randrange(n), chance.randrange(n)
        if u != w:
            arcs.append((u, w, length(chance)))
    return n, arcs


def grid(n_arcs, length):
    """A square of nodes, arcs both ways between neighbours."""
    chance = random.Random(f"grid {n_arcs}")
    side = max(2, round((n_arcs / 4.0) ** 0.5))
    pairs = [(side * i + j, side * i + j + step) for i in range(side) for j in range(side)
             for step in (1, side) if (j + 1 < side if step == 1 else i + 1 < side)]
    return side * side, [(*ends, length(chance)) for u, w in pairs for ends in ((u, w), (w, u))]


GRAPHS = {"graph": tree_and_more, "grid": grid}
LENGTHS = {
    "decimal": lambda chance: chance.uniform(0.1, 10.0),
    "ties": lambda chance: float(chance.randrange(1, 4)),
    "zeros": lambda chance: float(chance.randrange(3)),
    "wide": lambda chance: 10.0 ** chance.uniform(-3.0, 3.0),
}


def distances(n, arcs):
    outgoing = [[] for _ in range(n)]
    for u, w, length in arcs:
        outgoing[u].append((w, length))
    found = [float("inf")] * n
    found[0] = 0.0
    queue = [(0.0, 0)]
    while queue:
        far, u = heapq.heappop(queue)
        if far > found[u]:
            continue
        for w, length in outgoing[u]:
            if far + length < found[w]:
                found[w] = far + length
                heapq.heappush(queue, (found[w], w))
    return found


def netlist(n, arcs):
    lines = ["shortest paths"]
    for k, (u, w, length) in enumerate(arcs):
        lines += [f"D{k} {w} m{k}", f"V{k} m{k} {u} {length!r}"]
    lines += [f"I{w} 0 {w} 1" for w in range(1, n)]
    return "\n".join(lines + [".op", ".end", ""])


def check_graph(checker, program, n_arcs, shape, kind):
    n, arcs = GRAPHS[shape](n_arcs, LENGTHS[kind])
    label = f"{shape} of {len(arcs)} arcs, {kind}"
    result = run(program, netlist(n, arcs), method=None)
    if not checker.check(result.status == 0, f"{label}: exit {result.status}: {result.stderr}"):
        return
    row = dict(zip(result.names, result.rows[-1]))
    wanted = distances(n, arcs)
    largest = max(wanted)
    worst = max(range(1, n), key=lambda w: abs(row[f"v({w})"] - wanted[w]))
    checker.close(row[f"v({worst})"], wanted[worst], VOLTAGE * largest, f"{label}: v({worst})")
    # What flows, flows along shortest paths and carries what every node draws.
    for k, (u, w, length) in enumerate(arcs):
        slack = wanted[u] + length - wanted[w]
        current = row[f"i(d{k})"]
        if not checker.check(current >= -CURRENT * n and (current <= CURRENT * n or
                                                          slack <= VOLTAGE * largest),
                             f"{label}: i(d{k}) = {current} A where a detour is {slack} long"):
            break
    drawn = sum(row[f"i(d{k})"] for k, (u, w, _) in enumerate(arcs) if u == 0)
    fed = sum(row[f"i(d{k})"] for k, (u, w, _) in enumerate(arcs) if w == 0)
    checker.close(drawn - fed, n - 1.0, CURRENT * n, f"{label}: current into the root")
    checker.check(result.report["certificate"]["worst"] <= CERTIFIED,
                  f"{label}: certificate {result.report['certificate']['worst']:.2e}")


def main():
    checker = Checker("shortest paths")
    for n_arcs in (int(n) for n in sys.argv[2:] if IS_LONG or int(n) < 10000):
        for shape in GRAPHS if n_arcs <= LARGE else ["grid"]:
            for kind in some_of(LENGTHS) if n_arcs <= LARGE else ["decimal"]:
                check_graph(checker, sys.argv[1], n_arcs, shape, kind)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
