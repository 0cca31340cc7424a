#!/usr/bin/env python3
"""Random systems under `dalcs check`: P of what is passive by construction, no P of what is not, each witness
put into the inequality in rational numbers.

usage: random_storage.py PROGRAM [COUNT [SEED]]

With K > 0, J skew and W = [R S; S' T] >= 0 the system K x' = (J - R) x + G u, y = (G' + 2S')x + (T + N)u is
passive with K. W has a random rank: 0 is lossless, and then nothing about the inequality is strict. The
equations are multiplied by a regular matrix, so that the program is not told K. Every other system is spoilt
by a negative resistance; it may be passive all the same, and nothing is asked but that what is said is proved."""

import json
import pathlib
import random
import subprocess
import sys
import tempfile
from fractions import Fraction

from papers import exact, is_storage, refutes
from system_file import System, product, transposed

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import some_of  # noqa: E402


def gram(r, n, rank):
    """A sum of `rank` squares."""
    rows = [[r.randint(-2, 2) for _ in range(n)] for _ in range(rank)]
    return product(transposed(rows), rows) if rows else [[0] * n for _ in range(n)]


def skew(r, n):
    a = [[0] * n for _ in range(n)]
    for i in range(n):
        for j in range(i):
            a[i][j] = r.randint(-2, 2)
            a[j][i] = -a[i][j]
    return a


def system(r, spoilt):
    n, m = r.randint(1, 4), r.randint(1, 2)
    W = gram(r, n + m, r.choice((0, 1, n, n + m, n + m + 2)))
    K = gram(r, n, n + 1)
    for i in range(n):
        K[i][i] += 1
    J, N = skew(r, n), skew(r, m)
    G = [[r.randint(-2, 2) for _ in range(m)] for _ in range(n)]
    A = [[J[i][j] - W[i][j] for j in range(n)] for i in range(n)]
    C = [[G[i][k] + 2 * W[i][n + k] for i in range(n)] for k in range(m)]
    D = [[W[n + i][n + j] + N[i][j] for j in range(m)] for i in range(m)]
    if spoilt:
        k = r.randrange(n + m)
        (A if k < n else D)[k % n if k < n else k - n][k % n if k < n else k - n] += \
            r.choice((1, 3)) if k < n else -r.choice((1, 3))
    T = [[int(i == j) if j >= i else r.randint(-1, 1) for j in range(n)] for i in range(n)]
    T = product(T, transposed([[int(i == j) if j >= i else r.randint(-1, 1) for j in range(n)]
                               for i in range(n)]))
    lines = ["dalcs-system 2 random"] + [f"state x{i} 0" for i in range(n)]
    lines += [f"pair d{k}" for k in range(m)]
    for name, matrix in (("P", product(T, K)), ("A", product(T, A)), ("B", product(T, G)), ("C", C),
                         ("D", D)):
        lines += [f"matrix {name}"] + ["+ " + " ".join(map(str, row)) for row in matrix]
    return "\n".join(lines + [".tran 1m 1", ".end", ""])


FEWEST = 40  # among so many is a witness of each kind


def main(program, count, seed):
    tally = {"passive": 0, "found": 0, "spoilt": 0, "P": 0, "Z": 0, "motion": 0, "rates": 0}
    failures = n = 0
    count = max(len(some_of(range(count))), min(count, FEWEST))
    while n < count:
        n += 1
        r = random.Random(f"{seed}.{n}")
        spoilt = n % 2 == 0
        text = system(r, spoilt)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "random.dalcs"
            path.write_text(text)
            done = subprocess.run([program, "check", str(path), "--json"], capture_output=True, text=True)
        if done.returncode != 0:
            if "singular" not in done.stderr:
                failures += 1
                print(f"FAILED {seed}.{n}: {done.stderr}{text}")
            continue
        part = json.loads(done.stdout)["parts"]
        if len(part) != 1:
            continue
        verdict = part[0]["verdicts"]["passive"]
        quadruple = System(text).quadruple()
        tally["spoilt" if spoilt else "passive"] += 1
        tally["found"] += not spoilt and verdict["answer"] == "yes"
        why = "false alarm" if not spoilt and verdict["answer"] == "no" else ""
        proofs = [w for c in part[0]["conditions"] if c["id"] == "K10" for w in c["witnesses"]]
        for witness in verdict["witnesses"] + proofs:
            kind = witness["kind"]
            if kind == "P":
                tally["P"] += 1
                why = why or ("" if is_storage(quadruple, exact(witness)) else "P does not prove it")
            elif kind == "Z":
                tally["Z"] += 1
                why = why or ("" if refutes(quadruple, exact(witness)) else "Z does not prove it")
            tally["motion"] += kind in ("motion", "eigenvector")
        rate = part[0]["verdicts"]["contracting"]
        if "value" in rate:
            tally["rates"] += 1
            P = exact(rate["witnesses"][0])
            if not is_storage(quadruple, P, Fraction(2 * rate["value"])):
                why = why or f"the rate {rate['value']} is not proved"
        if why:
            failures += 1
            print(f"FAILED {seed}.{n}: {why}: {verdict['sentence']}\n{text}")
    if tally["found"] < 0.9 * tally["passive"] or min(tally.values()) == 0:
        failures += 1
        print("FAILED: too few are found")
    print(", ".join(f"{value} {name}" for name, value in tally.items()))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 200,
                  sys.argv[3] if len(sys.argv) > 3 else "1"))
