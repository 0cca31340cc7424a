#!/usr/bin/env python3
"""Small signals around an operating point or a periodic orbit, broken on purpose: the default audit of .ac has to find it.

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

CONTROLLED = """a buck whose comparator follows its output, in discontinuous conduction
vin in 0 12 AC 1
e1 cmp 0 ctl tri 1
s1 in sw cmp 0 sm
d1 0 sw
l1 sw out 10u
c1 out esr 20u
resr esr 0 0.05
r1 out 0 30
vref ref 0 5 AC 0.3 40
g1 0 ctl ref out 0.2m
rz ctl 0 2k
cz ctl 0 10n
vtri tri 0 PULSE(0 4 0 10u 0 0 10u)
.model sm SW(Ron=10m Vt=0)
.pss uic
.ac dec 4 100 100k
"""

RAMP = """a command on a ramp of a source that has a small signal, and a current that jumps
vin in 0 12
vctl ctl 0 0.4 AC 1
vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
e1 cmp 0 ctl tri 1
s1 in sw cmp 0 sm
d1 0 sw
l1 sw out 50u
c1 out 0 20u
r1 out 0 2
.model sm SW(Ron=0 Vt=0)
.pss uic
.ac dec 4 100 100k sideband=1
"""

BRIDGE = """a bridge that a sine of phase 0 turns over
v1 in 0 SIN(0 12 50) AC 1
d1 in p d
d2 0 p d
d3 m in d
d4 m 0 d
l1 p q 0.1
r1 q m 5
.model d D(ron=0 vfwd=0)
.pss uic
.ac dec 4 1 1k
"""

ENGINE = "session/small_signal_part.c"
AROUND = "orbit/periodic_response.c"

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
        "session/small_signal.c", "probe(a, &out->plus, which) - probe(a, &out->minus, which);",
        "probe(a, &out->plus, 1) - probe(a, &out->minus, which);", CIRCUIT),
    # around an orbit
    "events move the wrong way": (AROUND, "? -at_end(r, piece->map, phase, end->row)", "? at_end(r, piece->map, phase, end->row)", CONTROLLED),
    "events are 1e-4 too late": (
        AROUND, "? -at_end(r, piece->map, phase, end->row)", "? -1.0001 * at_end(r, piece->map, phase, end->row)", CONTROLLED),
    "events do not move states": (AROUND, "(end != NULL ? dt * end->df[x] : 0.0)", "(end != NULL ? 0.0 * end->df[x] : 0.0)", CONTROLLED),
    "states move the wrong way at events": (
        AROUND, "(end != NULL ? dt * end->df[x] : 0.0)", "(end != NULL ? -dt * end->df[x] : 0.0)", CONTROLLED),
    "what jumps has no impulse": (
        AROUND, "dt * end->dy[r->read[m]] * conj", "0.0 * dt * end->dy[r->read[m]] * conj", RAMP),
    "commands do not move": (AROUND, ": r->drive * dalcs_periodic_flow_moved(r->flow, end)", ": 0.0 * dalcs_periodic_flow_moved(r->flow, end)", RAMP),
    "rows are of another sideband": (
        AROUND, "add_means(r, map, phase, conj(turn(other, piece->t)));", "add_means(r, map, phase, conj(turn(w, piece->t)));", RAMP),
    "maps are those of the frequency before": (AROUND, "if (map->stamp != r->stamp) {", "if (map->stamp == 0 || r->stamp % 2 == 0) {", CONTROLLED),
    "a period does not end where it began": (AROUND, "turned : 0.0) - r->M[k]", "1.001 * turned : 0.0) - r->M[k]", CONTROLLED),
    "the second source is left out": ("orbit/periodic_flow.c", "if (flow->drive.source[k] != 0.0) {", "if (flow->drive.source[k] != 0.0 && e->n_waves < 1) {", CONTROLLED),
    "drives of sources are 1e-4 too large": (
        AROUND, "map->driven[i] += coefficient[k] * drive[i];", "map->driven[i] += 1.0001 * coefficient[k] * drive[i];", CONTROLLED),
    "sources are left out where the audit does not look": (
        AROUND, "flow->kept.n : flow->kept.n_asked", "flow->kept.n : 0", CONTROLLED),
    "the event at t = 0 is lost": ("orbit/orbit_commands.c", "last->rate < 0.0 ? row : -1;", "-1;", BRIDGE),
    "a piece has the map of another mode": (
        "orbit/periodic_map.c", "DALCS_TRY(dalcs_stages_get(&flow->stages, span->mode, h, &entry));",
        "DALCS_TRY(dalcs_stages_get(&flow->stages, flow->orbit->span[0].mode, h, &entry));", CONTROLLED),
}

if __name__ == "__main__":
    sys.exit(run_all(MUTATIONS, "responses"))
