#!/usr/bin/env python3
"""Small signals around an operating point, broken on purpose: the default audit of .ac has to find it.

usage: responses.py BUILD SOURCE [NAME...]
"""

import sys

from mutations import run_all

CIRCUIT = """elements of all kinds for small signals
v1 a 0 DC 10 AC 2 30
i1 0 b DC 1m AC 0.3m -40
r1 a b 1k
d1 b c di
l1 c d 1m
r2 d 0 470
c1 d 0 1u
s1 a e b 0 sw
r3 e 0 220
e1 f 0 d 0 2.5
r4 f g 1k
g1 g 0 e 0 1m
r5 g 0 330
h1 h 0 v1 50
r6 h 0 1k
d2 0 h dz
f1 0 r v1 2
r13 r 0 10
b1 k 0 V={limit(3*v(d),-4,400)}
r7 k 0 1k
l2 m 0 1m
l3 n 0 4m
k1 l2 l3 0.8
r8 a m 1k
r9 n 0 1k
s2 a q p 0 sw
r10 q 0 100
v2 p 0 1
b2 u 0 I={1m*v(d)*v(d)}
r11 u 0 1k
b3 w 0 V={exp(v(d)/5)+2*v(a)}
c2 w y 1n
r12 y 0 1k
.model di D(vfwd=0.7 ron=0.1 roff=1meg)
.model dz D(vfwd=0.7 ron=0.1 vrev=5.1)
.model sw SW(vt=2 vh=0.5 ron=0.1 roff=1meg)
.ac dec 10 10 1meg
"""

ENGINE = "session/small_signal.c"

# name: (file, what to replace, by what, netlist)
MUTATIONS = {
    "sources have no phase": (
        ENGINE, "        part->s[1][k] = source->ac_imaginary;", "        part->s[1][k] = 0.0 * source->ac_imaginary;", CIRCUIT),
    "sources are 1e-5 too large": (
        ENGINE, "        part->s[0][k] = source->ac_real;", "        part->s[0][k] = 1.00001 * source->ac_real;", CIRCUIT),
    "the frequency is in radians": (
        ENGINE, "const double omega = dalcs_two_pi * frequency;", "const double omega = frequency;", CIRCUIT),
    "time runs backwards": (
        ENGINE, "const double omega = dalcs_two_pi * frequency;", "const double omega = -dalcs_two_pi * frequency;", CIRCUIT),
    "a frequency has the answer of the one before": (
        ENGINE, "    balance(part, omega);\n",
        "    static int n_; if (n_++ % 2 == 1) return DALCS_OK;\n    balance(part, omega);\n", CIRCUIT),
    "what conducts blocks": (
        ENGINE, "        if (!dalcs_osnsp_is_on(&c->osnsp, d)) {", "        if (d >= 0) {", CIRCUIT),
    "what conducts has its voltage as well": (
        ENGINE, "-dalcs_csr_row_dot(&s->F, d, part->s[0]);", "1e-3 - dalcs_csr_row_dot(&s->F, d, part->s[0]);", CIRCUIT),
    "smooth functions pass nothing": (
        ENGINE, "gradient[j] - line, 0.0};", "0.0 * gradient[j] - line, 0.0};", CIRCUIT),
    "slopes of smooth functions are 1e-4 too large": (
        ENGINE, "gradient[j] - line, 0.0};", "1.0001 * gradient[j] - line, 0.0};", CIRCUIT),
    "answers are 1e-5 too large, the more the later a column is": (
        ENGINE, "        part->y[1][to] += lu->work[2 * i + 1] * part->column_scale[to];",
        "        part->y[1][to] += (1.0 + 1e-5 * i) * lu->work[2 * i + 1] * part->column_scale[to];", CIRCUIT),
    "a coupling has the other sign": (
        "dalcs/coil_groups.c", "double mutual = m->k * sqrt(", "double mutual = -m->k * sqrt(", CIRCUIT),
    "capacitances are 1e-5 too large": (
        ENGINE, "entry[n++] = (struct entry){i, s->P.j[k], 0.0, s->P.x[k]};",
        "entry[n++] = (struct entry){i, s->P.j[k], 0.0, 1.00001 * s->P.x[k]};", CIRCUIT),
    "a row has its imaginary part twice": (
        ENGINE, "probe(a, &out->plus, which) - probe(a, &out->minus, which);",
        "probe(a, &out->plus, 1) - probe(a, &out->minus, which);", CIRCUIT),
}

if __name__ == "__main__":
    sys.exit(run_all(MUTATIONS, "responses"))
