#!/usr/bin/env python3
"""`dalcs check` on every system of netlists/papers: what the papers say of it, and its witnesses, in rational
numbers.

usage: papers.py PROGRAM SOURCE_ROOT glpk|no_glpk sdpa|no_sdpa

Sources: [B22] Brogliato 2022, [BT10] Brogliato and Thibault 2010, [BG09] and [BG13] Brogliato and Goeleven,
[HSW99] Heemels, Schumacher and Weiland. [ours]: worked out here, the argument beside it; doc/check.md has
what the papers say otherwise. Answers that need linear programs are marked L, semidefinite ones S."""

import json
import pathlib
import subprocess
import sys
from fractions import Fraction

from system_file import System, added, is_positive, product, solved, transposed

L, S = "L", "S"

# (verdict or condition, answer, where it is said[, what it needs])
EXPECTED = {
    "b22_6_1": [
        ("A8", "yes", "[B22] 6.1: assumption 8 holds with D11 = 1/R"),
        ("A9", "yes", "[B22] 6.1: X2 = 2/3 and assumption 9 is verified"),
        ("A3", "yes", "[B22] 6.1: the same X2; Bbar_II1 = C_II1 = 0"),
        ("A5", "yes", "[B22] 6.1: passive with X = 2/3, not strictly"),
        ("A2", "no", "[B22] 6.1: assumptions 2 and 6 do not hold"),
        ("A6", "no", "[B22] 6.1: assumptions 2 and 6 do not hold"),
        ("P4.8.1", "yes", "[B22] 6.1: item 1 applies since Im(C_II2) = R"),
        ("P4.8.3", "yes", "[B22] 6.1: item 3 applies, G2 is 0"),
        ("L4.1", "no", "[B22] 6.1: not strictly passive since D > 0 fails"),
        # with K = [2 -1; -1 2] and u = B^-1 x' + K x: u'y = x''B^-1 x' + (x'Kx)'/2 + u2^2 >= (x'Kx)'/2
        ("passive", "yes", "[ours] by K", S),
        ("exists", "yes", "[BT10] A.4: D + .. = diag(1, 3/2) > 0 after elimination"),
        ("unique", "yes", "[BT10] A.4"),
        ("jumps", "yes", "[BT10] A.4: an ordinary differential equation"),
        ("step", "yes", "[HSW99] 6.14 or 3.12: no mode has a positive real eigenvalue"),
        # u2 = 0, u1 constant: x = -A^-1 B u rests, y1 = 0
        ("periodic", "undecided", "[ours] a difference may rest and lose nothing"),
    ],
    "b22_6_2": [
        ("A1", "yes", "[B22] 6.2: P_I^h > 0 for all h"),
        ("A2", "yes", "[B22] 6.2: with X = R3"),
        ("P4.3.2", "yes", "[B22] 6.2: Dt > 0 for all h > 0"),
        ("A4", "yes", "[B22] 6.2: for h small enough such that At < 0"),
        ("C4.6.3", "yes", "[B22] 6.2: strictly passive, items 1 and 3 of corollary 4.6 apply"),
        ("A10", "no", "[B22] 6.2: assumption 10 does not hold, Dt -> 0"),
        ("A5", "yes", "[B22] 6.2: (B_II, 0, 0, 0) is passive, not strictly"),
        ("A3", "yes", "[B22] 6.2: trivially"),
        ("A9", "yes", "[B22] 6.2: trivially"),
        ("P4.7.1", "yes", "[B22] 6.2: item 1 applies, provided x1 >= 0"),
        ("P4.8.1", "depends", "[B22] 6.2: {0} in R+ - x1 only while x1 >= 0"),
        ("P4.8.3", "yes", "[B22] 6.2: applies, provided item 1"),
        ("P4.3.3", "no", "[ours] it requires Dt = 0, and Dt = h/(L + h R1); 6.2 uses it all the same"),
        ("passive", "yes", "[ours] P = I: A + A' = [-1 1; 1 -1] <= 0, B = C'"),
        ("exists", "yes", "[BT10] 3.5: K1 and K2"),
        ("unique", "yes", "[BT10] 3.5"),
        ("step", "yes", "[B22] 6.2 for small h; passive, so [HSW99] 6.14 for all"),
    ],
    "b22_6_2_not_passive": [
        ("A1", "yes", "[B22] 6.2: P_I^h > 0 for h < 1/a"),
        ("A2", "yes", "[B22] 6.2: A_I intervenes only in assumption 1"),
        ("A4", "yes", "[B22] 6.2: for h small enough such that At < 0"),
        ("C4.6.3", "yes", "[B22] 6.2"),
        ("P4.8.1", "depends", "[B22] 6.2"),
        ("passive", "no", "[B22] 6.2: the reduced LCS is not passive with this feedback"),
        ("exists", "yes", "[BT10] 3.5: any A"),
        ("unique", "yes", "[BT10] 3.5: any A"),
        # M(1/h) = (1/h + 1/2)/(1/h^2 - 1/h - 1) changes its sign at 1/h = (1 + sqrt 5)/2, as At does
        ("step", "depends", "[ours] h < (sqrt 5 - 1)/2; h < 1/a of 6.2 is assumption 1 alone"),
    ],
    "b22_6_3_absolute": [
        ("A5", "yes", "[B22] 6.3: (6.6) > 0 for c large enough"),
        ("L4.1", "yes", "[B22] 6.3: item 1 in lemma 4.1 holds"),
        ("P4.3.2", "yes", "[B22] 6.3: item 2 in proposition 4.3 holds"),
        ("A10", "yes", "[B22] 6.3: assumption 10 holds for small h"),
        ("P5.2", "yes", "[B22] 6.3: the arguments of section 5.2 hold"),
        ("convergence", "yes", "[B22] 6.3"),
        ("exists", "yes", "[BT10] A.4"),
        ("unique", "yes", "[BT10] A.4"),
        ("jumps", "yes", "[BT10] A.4"),
    ],
    "b22_6_3_switching": [
        ("A4", "no", "[B22] 6.3 asks for c3 < 0; here c3 = 1, At > 0"),
        ("A5", "no", "[B22] 6.3: the same"),
        ("A10", "no", "[B22] 6.3: the same"),
        ("P4.3.2", "yes", "[B22] 6.3: Dt = D = I"),
        ("exists", "yes", "[B22] figures 2 and 3; [BT10] A.4: D = I and C_II = 0"),
        ("unique", "yes", "[BT10] A.4"),
        ("step", "depends", "[ours] 1/h above the eigenvalue sqrt 91 - 9 of [1 -9; 1 -19]"),
    ],
    "b22_6_3_two_branches": [
        ("A4", "no", "[B22] 6.3: c3 = 1"),
        ("exists", "yes", "[BT10] A.4"),
        ("unique", "yes", "[BT10] A.4"),
    ],
    "b22_6_4": [
        ("A4", "yes", "[B22] 6.4: strictly passive for small h"),
        ("P4.3.1", "yes", "[B22] 6.4: items 1 and 2 in proposition 4.3 hold"),
        ("P4.3.2", "yes", "[B22] 6.4"),
        ("C4.6.3", "yes", "[B22] 6.4: items 1, 2 and 3 in corollary 4.6"),
        ("A5", "yes", "[B22] 6.4: (-1/m, 0, 0, I) is strictly passive"),
        ("L4.1", "yes", "[B22] 6.4: item 1 in lemma 4.1 holds"),
        ("A10", "yes", "[B22] 6.4: verified for small h, uniformly"),
        ("A11", "no", "[B22] 6.4: may not be verified"),
        # H(s) = I + 20/s^2 e e', e = (1, -1): 1 - 40/omega^2 on the axis
        ("passive", "no", "[ours] H(j omega) < 0 for omega^2 < 40"),
        ("exists", "yes", "[BT10] A.4: D = I"),
        ("unique", "yes", "[BT10] A.4"),
        ("jumps", "yes", "[BT10] A.4"),
    ],
    "b22_6_5": [
        ("A3", "yes", "[B22] 6.5: assumptions 3 and 5 hold"),
        ("A5", "yes", "[B22] 6.5: assumptions 3 and 5 hold"),
        ("A2", "yes", "[B22] 6.5: assumptions 2 and 4 hold for small h"),
        ("A4", "yes", "[B22] 6.5: assumptions 2 and 4 hold for small h"),
        ("A8", "yes", "[B22] 6.5: with no D11"),
        ("P4.3.3", "yes", "[B22] 6.5: S is {0}, item 3 (a) applies"),
        ("P4.7.1", "yes", "[B22] 6.5: S of (4.16) is {0}"),
        ("P4.8.1", "yes", "[B22] 6.5: verified always"),
        ("P4.8.3", "yes", "[B22] 6.5: items 1, 2, 3 apply"),
        ("A12", "yes", "[B22] 6.5: with X = Bt^-1"),
        ("L5.4", "no", "[B22] 6.5: a large enough; a = 1/2 is not"),
        ("passive", "yes", "[B22] figure 5: an RLCD circuit"),
        ("contracting", "yes", "[ours] 1/2 1/s: s^2 + s + 1 of the mode off", S),
    ],
    "bg09_33": [
        ("K1", "no", "[BG09] example 1: CB = diag(1/C, -2/(R^2 C))"),
        ("K7", "yes", "[BG09] example 1: assumptions 1 to 4, D_II = 1/R"),
        ("passive", "yes", "[ours] the energy P = [2 -1 0; -1 2 0; 0 0 1]"),
        ("exists", "yes", "[BG09] example 1: theorem 1"),
        ("unique", "yes", "[BG09] example 1: theorem 1"),
        ("contracting", "undecided", "[ours] an eigenvalue is 0: charge is kept"),
    ],
    "bg09_33_printed": [
        # row 3 of A is 0: P e3 = e3/C, then (3, 3) of A'P + PA is 0 beside what is not
        ("passive", "no", "[ours] for no P, so the row is a misprint"),
        ("K7", "yes", "[BG09] example 1: theorem 1 does not ask for passivity"),
        ("unique", "yes", "[BG09] theorem 1"),
    ],
    "bg09_36": [
        ("PSD-D", "yes", "[BG09] example 2: D is positive semidefinite"),
        ("K6", "no", "[BG09] example 2: no P-matrix"),
        ("K1", "yes", "[BG09] example 2: P = diag(C, p22)"),
        ("Prop3", "no", "[BG09] example 2: (21) fails", L),
        ("K8", "yes", "[BG09] example 2: theorem 2 applies", L),
        ("exists", "yes", "[BG09] example 2: theorem 2", L),
        ("unique", "yes", "[BG09] example 2: theorem 2"),
        ("jumps", "yes", "[BG09] example 2: Dom = R^2", L),
        ("passive", "yes", "[BG09] example 2: p22 = L"),
    ],
    "bg09_38": [
        ("PSD-D", "yes", "[BG09] example 3: D is skew"),
        ("K1", "yes", "[BG09] example 3: P = C"),
        ("unique", "yes", "[BG09] example 3: theorem 2"),
        ("multipliers", "depends", "[ours] v(df2) is anything in [0, x]"),
        ("K12", "yes", "[BG13] (40): omega = -1/(RC)"),
        ("contracting", "yes", "[BG13] (40): exactly 1/(RC)"),
    ],
    "bg13_friction": [
        ("relay-K1", "yes", "[BG13] example 6.2: P = diag(p1, 1/(g mu1), p3, 1/(g mu2))"),
        ("exists", "yes", "[BG13] section 6.2: relays are always well-posed"),
        ("unique", "yes", "[BG13] section 6.2"),
        ("jumps", "yes", "[BG13] section 6.2: no constraint on the state"),
    ],
    "bt10_fig_2_1": [
        ("K6", "yes", "[BT10] (7): D = 1/R > 0"),
        ("jumps", "yes", "[BT10] (9): an ordinary differential equation"),
        ("exists", "yes", "[BT10] A.4"),
        ("unique", "yes", "[BT10] A.4"),
    ],
    "bt10_fig_2_2": [
        ("K1", "yes", "[BT10] (8): B = C = 1, P = 1"),
        ("exists", "yes", "[BT10] theorem 3.5, example 3.1"),
        ("unique", "yes", "[BT10] theorem 3.5, example 3.1"),
        ("jumps", "depends", "[BT10] (24)-(26): where i steps up", L),
    ],
    "bt10_two_coils": [
        ("K1", "yes", "[BT10] assumption 1.1: P = diag(L1, L2)"),
        ("exists", "yes", "[BT10] theorem 3.5"),
        ("unique", "yes", "[BT10] theorem 3.5"),
    ],
    "hsw99_4_11": [
        ("exists", "yes", "[HSW99] example 4.11: M is a P-matrix for every s > 0", L),
        ("unique", "yes", "[HSW99] example 4.11"),
        ("multipliers", "yes", "[HSW99] example 4.11"),
        ("K6", "no", "[HSW99] example 4.11: at s = infinity many solutions"),
    ],
    "hsw99_4_2a": [("exists", "depends", "[HSW99] example 4.2: unsolvable for v(1) > 0", L)],
    "hsw99_4_2b": [
        ("exists", "yes", "[HSW99] example 4.2: a P-matrix for every s > 0", L),
        ("unique", "yes", "[HSW99] example 4.2"),
        ("impulse", "yes", "[HSW99] example 4.2: lambda = s ..., an impulse"),
    ],
    "hsw99_5_11": [
        ("K1", "no", "[ours] B has rank 1, C has rank 2"),
        # u = (-1, 1) leaves x = (1, 0) where it is and takes 1 W for ever
        ("passive", "no", "[ours] its state is not minimal, as [HSW99] 6.14 would want", S),
        ("exists", "yes", "[HSW99] example 5.11: the RCP is solvable", L),
        ("unique", "yes", "[HSW99] example 5.11: one germ"),
        ("multipliers", "depends", "[HSW99] example 5.11: B is singular"),
        ("step", "yes", "[ours] M(s) = B/s >= 0 for every s"),
    ],
    "hsw99_5_18": [
        ("unique", "no", "[HSW99] example 5.18: none from (1, -1), many from 0"),
        ("step", "no", "[HSW99] example 5.18"),
        ("passive", "no", "[ours] B/s + its transpose has a negative eigenvalue"),
    ],
    "hsw99_relay": [
        ("relay-P", "yes", "[HSW99] section 6.2: G = 1/(s + 1)"),
        ("P", "no", "[HSW99] (43): the two pairs of a relay never are"),
        ("exists", "yes", "[HSW99] theorems 6.7 to 6.9"),
        ("unique", "yes", "[HSW99] theorems 6.7 to 6.9"),
        ("multipliers", "yes", "[HSW99] theorem 6.7"),
        ("jumps", "yes", "[HSW99] theorem 6.9: x is continuous"),
        ("contracting", "yes", "[BG13] proposition 7.3: omega = -1"),
    ],
    "hsw99_unilateral": [
        ("exists", "yes", "[HSW99] theorems 6.4 to 6.6"),
        ("unique", "yes", "[HSW99] theorems 6.4 to 6.6: F of full row rank"),
        ("impulse", "no", "[HSW99] section 6.1: of relative degree two"),
    ],
}

VALUE = {  # verdict: its value, and how near
    "b22_6_2_not_passive": ("step", (5 ** 0.5 - 1) / 2, 1e-9),
    "b22_6_3_switching": ("step", 1 / (91 ** 0.5 - 9), 1e-9),
    "b22_6_5": ("contracting", 0.5, 1e-3),
    "bg09_38": ("contracting", 1000.0, 1e-3),
    "hsw99_relay": ("contracting", 1.0, 1e-3),
}
NEEDS_LP = ("exists", "jumps", "K8", "Prop3")
NEAR = Fraction(1, 10 ** 8)


def exact(witness):
    return [[Fraction(x) for x in row] for row in witness["matrix"]]


def size_of(*parts):
    """What each row of a sum is made of, on its diagonal's scale."""
    n = len(parts[0])
    return [NEAR * max(max(abs(part[i][j]) for part in parts for j in range(n)), Fraction(1, 10 ** 30))
            for i in range(n)]


def is_storage(quadruple, P, eps=0):
    """P > 0 and [A'P + PA + eps P, PB - C'; ., -(D + D')] <= 0, in rational numbers up to NEAR."""
    A, B, C, D = quadruple
    n, m = len(A), len(D)
    pa, pb = product(P, A), product(P, B)
    Q = [[Fraction(0)] * (n + m) for _ in range(n + m)]
    size = [[Fraction(0)] * (n + m) for _ in range(n + m)]
    for i in range(n):
        for j in range(n):
            Q[i][j] = -pa[i][j] - pa[j][i] - Fraction(eps) * P[i][j]
            size[i][j] = abs(pa[i][j]) + abs(pa[j][i])
        for k in range(m):
            Q[i][n + k] = Q[n + k][i] = C[k][i] - pb[i][k]
            size[i][n + k] = size[n + k][i] = abs(C[k][i]) + abs(pb[i][k])
    for i in range(m):
        for j in range(m):
            Q[n + i][n + j] = D[i][j] + D[j][i]
            size[n + i][n + j] = abs(D[i][j]) + abs(D[j][i])
    return is_positive(P, [Fraction(0)] * n) and is_positive(Q, size_of(size))


def refutes(quadruple, Z):
    """Z >= 0, A Z11 + Z11 A' + B Z21 + Z12 B' >= 0 and more comes out than goes in."""
    A, B, C, D = quadruple
    n = len(A)
    motion = product([a + b for a, b in zip(A, B)], Z)
    R = [[motion[i][j] + motion[j][i] for j in range(n)] for i in range(n)]
    scale = [sum(abs(x) for x in a + b) * max(abs(x) for row in Z for x in row) * NEAR
             for a, b in zip(A, B)]
    output = product([c + d for c, d in zip(C, D)], Z)
    power = sum(output[i][n + i] for i in range(len(D)))
    return is_positive(Z, size_of(Z)) and is_positive(R, [s + NEAR for s in scale]) and power < 0


class Test:
    def __init__(self):
        self.n = self.failures = self.proved = 0

    def expect(self, holds, what):
        self.n += 1
        if not holds:
            self.failures += 1
            print(f"FAILED {what}")

    def witnesses(self, name, system, verdicts, conditions):
        """Every P of K10, K11, K1 and the verdicts, every X of A3, A5 and every Z."""
        quadruple = system.quadruple()
        found = [("passive", 0, w) for w in verdicts["passive"]["witnesses"]]
        found += [("contracting", 2 * verdicts["contracting"].get("value", 0), w)
                  for w in verdicts["contracting"]["witnesses"]]
        found += [(c["id"], 0, w) for c in conditions for w in c["witnesses"]]
        for where, eps, witness in found:
            if witness["kind"] == "Z" and quadruple is not None:
                self.expect(refutes(quadruple, exact(witness)), f"{name}: Z at {where}")
            elif where in ("passive", "contracting", "K10") and witness["kind"] == "P" and quadruple:
                self.expect(is_storage(quadruple, exact(witness), eps), f"{name}: P at {where}")
            elif where == "A5":
                self.expect(is_storage(system.model(), exact(witness)), f"{name}: X at A5")
            elif where in ("K1", "A3") and (where == "A3" or quadruple):
                _, B, C, _ = system.model() if where == "A3" else quadruple
                left, right = product(exact(witness), B), transposed(C)
                largest = max([abs(x) for row in right for x in row] + [Fraction(0)])
                self.expect(all(abs(a - b) <= NEAR * largest for p, q in zip(left, right)
                                for a, b in zip(p, q)), f"{name}: {where}")
            else:
                continue
            self.proved += 1


def main(program, root, has_glpk, has_sdpa):
    test = Test()
    files = sorted((pathlib.Path(root) / "netlists" / "papers").glob("*.*"))
    for path in files:
        done = subprocess.run([program, "check", str(path), "--json"], capture_output=True, text=True)
        test.expect(done.returncode == 0 and path.stem in EXPECTED, f"{path.name}: {done.stderr}")
        part = json.loads(done.stdout)["parts"][0]
        verdicts, conditions = part["verdicts"], part["conditions"]
        told = [row for row in EXPECTED[path.stem] if path.suffix == ".dalcs" or row[0] in verdicts]
        for question, answer, source, *needs in told:
            needs = needs[0] if needs else L if question in NEEDS_LP else None
            if needs == L and not has_glpk or needs == S and not has_sdpa:
                continue
            given = ([verdicts[question]["answer"]] if question in verdicts else
                     [c["holds"] for c in conditions if c["id"] == question])
            if path.suffix == ".cir" and question in ("contracting", "jumps"):
                continue  # another form of the same system, or another source
            test.expect(answer in given, f"{path.name}: {question} {given}, not {answer}: {source}")
        if path.stem in VALUE and path.suffix == ".dalcs":
            question, value, near = VALUE[path.stem]
            given = verdicts[question].get("value", 0.0)
            if has_sdpa or question == "step":
                test.expect(abs(given - value) <= near * value, f"{path.name}: {question} {given}")
        if path.suffix == ".dalcs":
            system = System(path.read_text())
            if system.ordinary:
                test.witnesses(path.name, system, verdicts, conditions)
    test.expect(test.proved > (30 if has_sdpa else 25), f"only {test.proved} witnesses")
    print(f"{test.n} checks, {test.proved} witnesses, {test.failures} failed")
    return 1 if test.failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3] == "glpk", sys.argv[4] == "sdpa"))
