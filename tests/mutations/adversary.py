#!/usr/bin/env python3
"""More of an engine that is broken on purpose, as one would who wants to get past the audit: once in many, small beside
large, or in what is looked at last.

usage: adversary.py BUILD SOURCE [NAME...]
"""

import pathlib
import sys

from mutations import BUCK, FEW, FLYBACK, GATES, HYSTERESIS, run_all

SMALL = """a signal of volts beside one of hundreds
v1 a 0 SIN(0 600 50)
d1 a p di
c1 p 0 100u
r1 p 0 200
r2 p q 1meg
c2 q 0 100n
r3 q 0 8k
.model di D(ron=0.02)
.tran 1m 80m
"""

STRINGS = """twelve legs, each with a diode, behind twelve phases
""" + "".join(f"v{k} a{k} 0 SIN(0 100 50 0 0 {30 * k})\nl{k} a{k} b{k} 1m\nd{k} b{k} p di\n"
              for k in range(1, 13)) + """c1 p 0 100u
r1 p 0 20
.model di D(ron=0.01)
.tran 0.1m 60m
"""

SHARED = """a switch opens and puts two coils in series
v1 in 0 10
r1 in a 10
l1 a m 1m
s1 m 0 g 0 sw
l2 m b 3m
r2 b 0 5
vg g 0 PULSE(1 0 1m 0 0 0.5m 1m)
.model sw SW(vt=0.5)
.tran 20u 5m
"""

TIED = """a switch opens and puts two coils in series, and E reads a capacitor on the node between them
v1 in 0 10
r1 in a 10
l1 a m 1m
s1 m 0 g 0 sw
l2 m b 3m
r2 b 0 5
vg g 0 PULSE(1 0 1m 0 0 0.5m 1m)
cm m x 1u
rx x y 1k
ly y m 2m
e1 e 0 m x 2
re e f 1k
cf f 0 1u
.model sw SW(vt=0.5)
.tran 20u 5m
"""

CONTROLLER = """a thyristor with a holding current on a coil, beside a latch that its current turns
v1 a 0 SIN(0 325 50)
vg g 0 PULSE(0 2 3m 0 0 0.2m 20m)
a1 a b g 0 scr
l1 b c 30m
r1 c 0 20
.model scr thyristor(vgt=1 ih=0.5)
.tran 0.1m 0.2
"""

FORMULA = """a source with limits and a table in a loop with a tank
v1 a 0 SIN(0 5 1k)
b1 b 0 V=limit(v(a),-2,2)+table(v(c),-3,-1,0,0,3,2)
r1 b d 100
l1 d c 10m
c1 c 0 1u
r2 c 0 1k
.tran 20u 10m
"""

CORNERS = """a row of corners
v1 a 0 PWL(0 0 1m 5 2m 4.99 3m 1 4m 1 5m -2 6m 0)
r1 a b 100
c1 b 0 1u
d1 b c di
r2 c 0 1k
.model di D
.tran 20u 8m
"""

CONTROLLED = """controlled sources of each kind around a filter
v1 a 0 SIN(0 10 1k)
r1 a b 50
c1 b 0 1u
e1 e 0 b 0 2
r2 e f 100
l1 f h 10m
vm h 0 0
f1 0 k vm 3
r3 k 0 10
c3 k 0 1u
g1 0 m k 0 1m
r4 m 0 2k
h1 n 0 vm 5
r5 n o 10
l2 o 0 1m
.tran 20u 5m
"""

CHARGED = """what is there at the start
c1 a 0 1u ic=5
r1 a b 100
l1 b 0 10m ic=20m
d1 a c di
c2 c 0 2u ic=1
r2 c 0 1k
.model di D(ron=1 vfwd=0.7)
.tran 20u 5m uic
"""

RESTING = """from an operating point
v1 in 0 PULSE(5 10 1m 10u 10u 1m 2m)
r1 in a 100
l1 a b 10m
c1 b 0 1u
r2 b 0 400
d1 b c di
c2 c 0 2u
r3 c 0 1k
.model di D(ron=1 vfwd=0.7)
.tran 20u 5m
"""

RELAY = """an oscillator on the threshold of its own switch
v1 in 0 10
r1 in a 10k
c1 a 0 100n
s1 a b a 0 sw
r2 b 0 100
.model sw SW(vt=4 vh=2 ron=1)
.tran 20u 20m uic
"""

SAW = """a saw whose gate joins two capacitors for no time, and a clock that loads it
i1 0 b 1m
c1 b 0 10n
s1 b y q 0 sw
a1 b 0 0 0 0 0 q 0 SCHMITT vt=0.55 vh=0.35
c2 y 0 100n
r2 y 0 10
vck ck 0 PULSE(0 1 4u 0 0 1u 10u)
s2 b z ck 0 sw
r3 z 0 1k
.model sw SW(vt=0.5)
.tran 0.2u 200u uic
"""

FED = """a part that another one drives, through gates on an RC
vr r 0 PULSE(0 1 0 0 0 50u 100u)
rr r g 1k
cr g 0 10n
vin in 0 24
s1 in x g 0 sw
d1 0 x di
l1 x out 1m
c1 out 0 10u
r1 out 0 10
e1 p 0 out 0 2
r2 p q 1k
c2 q 0 100n
.model sw SW(vt=0.5 vh=0.1 ron=0.01)
.model di D(ron=0.01)
.tran 20u 10m uic
"""

LIGHT = BUCK.replace("r1 out 0 2\n", "r1 out 0 40\n").replace(".tran 5m 5m", ".tran 1m 20m")
FEW.add(LIGHT)

NONE = "(fabs(part->segment.t - 10.05e-3) < 0.05e-3)"

# name: (file, what to replace, by what, netlist)
MUTATIONS = {
    "a state of volts beside hundreds is nudged by 1e-6": (
        "step/present.c", "    part->segment.in[s->n_x] = 1.0;\n",
        "    part->segment.in[s->n_x] = 1.0;\n    part->segment.in[1] *= 1.0 + 1e-6;\n", SMALL),
    "a diode is kept open in one leg of twelve": (
        "locate/first_fall.c", "if (!(bound[g] >= 0.0) && ", "if (!(bound[g] >= 0.0) && g != 7 && ", STRINGS),
    "a capacitor jumps behind what reads a finite voltage between nodes with impulses": (
        "decide/take_jump.c", "    memcpy(part->x, e->jump.after, ",
        "    e->jump.after[1] += 0.3;\n    memcpy(part->x, e->jump.after, ", TIED),
    "a jump is shared out wrongly among coils": (
        "decide/take_jump.c", "    memcpy(part->x, e->jump.after, ",
        "    e->jump.after[0] *= 1.01;\n    e->jump.after[1] *= 1.01;\n    memcpy(part->x, e->jump.after, ", SHARED),
    "a coil's current jumps where a switch with hysteresis closes": (
        "step/present.c", "    part->segment.in[s->n_x] = 1.0;\n",
        "    part->segment.in[s->n_x] = 1.0;\n"
        f"    if ({NONE} && part->guards.fresh && dalcs_osnsp_is_on(&part->component->osnsp, 0)) "
        "part->segment.in[0] *= 1.0 + 1e-4;\n", HYSTERESIS),
    "a coil's current jumps where a switch with hysteresis opens": (
        "step/present.c", "    part->segment.in[s->n_x] = 1.0;\n",
        "    part->segment.in[s->n_x] = 1.0;\n"
        f"    if ({NONE} && part->guards.fresh && !dalcs_osnsp_is_on(&part->component->osnsp, 0)) "
        "part->segment.in[0] *= 1.0 + 1e-4;\n", HYSTERESIS),
    "a coil's current jumps where a gate behind an RC closes a switch": (
        "step/present.c", "    part->segment.in[s->n_x] = 1.0;\n",
        "    part->segment.in[s->n_x] = 1.0;\n"
        "    for (int k = 0; k < s->n_x && part->segment.t > 5.1e-3 && part->segment.t < 5.2e-3 && part->guards.fresh && "
        "dalcs_osnsp_is_on(&part->component->osnsp, 0); k++) if (s->column_is_current[k]) part->segment.in[k] *= 1.0001;\n",
        FED),
    "charge is lost where a gate is high for no time": (
        "decide/take_jump.c", "    memcpy(part->x, e->jump.after, ",
        "    e->jump.after[1] *= 1.0001;\n    memcpy(part->x, e->jump.after, ", SAW),
    "a capacitor jumps where its gate stands and a clock turns another switch": (
        "step/present.c", "    part->segment.in[s->n_x] = 1.0;\n",
        "    part->segment.in[s->n_x] = 1.0;\n"
        "    if (part->segment.t > 13.9e-6 && part->segment.t < 14.1e-6 && part->guards.fresh) part->segment.in[0] *= 1.0001;\n",
        SAW),
    "coupled coils help where they should oppose": (
        "dalcs/coil_groups.c", "double mutual = m->k * sqrt", "double mutual = -m->k * sqrt", FLYBACK),
    "a thyristor turns off above its holding current": (
        "dalcs/stamp_device.c", ".turn_off = m->vt - m->vh}", ".turn_off = m->vt - 0.9 * m->vh}", CONTROLLER),
    "a latch is set where both inputs are high": (
        "logic/logic_network.c", "return !reset && (set || q);", "return set || (!reset && q);", GATES),
    "an edge comes 1 ns after its delay": (
        "logic/logic_queue.c", "l->now + (next->is", "l->now + 1e-9 + (next->is", GATES),
    "a corner of many is left out": (
        "circuit/stimulus_terms.c", "    *piece = (struct dalcs_stimulus_piece){.to = is_pulse ? 0.0 : dalcs_stimulus_next_edge(s, t),",
        "    double to_ = is_pulse ? 0.0 : dalcs_stimulus_next_edge(s, t);\n"
        "    to_ = s->kind == DALCS_STIMULUS_PWL && fabs(to_ - 2e-3) < 1e-9 ? dalcs_stimulus_next_edge(s, to_) : to_;\n"
        "    *piece = (struct dalcs_stimulus_piece){.to = to_,", CORNERS),
    "a piece of a formula is too steep by 1e-5": (
        "dalcs/stamp_behaviour.c", "stamp_column(b, t, s->n_x + s->n_z + l->pair[device] + term->index, coefficient)",
        "stamp_column(b, t, s->n_x + s->n_z + l->pair[device] + term->index, coefficient * (1.0 + 1e-5 * (term->index == 1)))",
        FORMULA),
    "a constant source is too large by 1e-5": (
        "excitation/excitation.c", "excitation->constant[k] = stimulus->dc;",
        "excitation->constant[k] = 1.00001 * stimulus->dc;", HYSTERESIS),
    "the gain of an E is too large by 1e-5": (
        "dalcs/stamp_device.c", "at_rest ? -1.0 : -d->value)", "at_rest ? -1.0 : -1.00001 * d->value)",
        CONTROLLED),
    "a capacitor is too large by 1e-5": (
        "dalcs/stamp_device.c", "e == 0 ? d->value : -d->value)", "(e == 0 ? d->value : -d->value) * 1.00001)", CONTROLLED),
    "a coil is too large by 1e-5": (
        "dalcs/stamp_device.c",
        "DALCS_TRY(dalcs_stamp_add(&b->P, x, x, d->value));\n    DALCS_TRY(dalcs_stamp_add(&b->storage",
        "DALCS_TRY(dalcs_stamp_add(&b->P, x, x, 1.00001 * d->value));\n    DALCS_TRY(dalcs_stamp_add(&b->storage",
        CONTROLLED),
    "the forward voltage of a diode is too small by 1e-5": (
        "dalcs/stamp_device.c", "m->vfwd, m->ron, pair", "0.99999 * m->vfwd, m->ron, pair", CHARGED),
    "a capacitor starts beside its IC= by 1e-5": (
        "dalcs/stamp_device.c", "? d->initial\n", "? 1.00001 * d->initial\n", CHARGED),
    "a coil starts beside its IC= by 1e-5": (
        "dalcs/stamp_device.c", "    b->initial[x] = d->initial;\n", "    b->initial[x] = 1.00001 * d->initial;\n", CHARGED),
    "a run starts beside its operating point by 1e-5": (
        "step/present.c", "    part->segment.in[s->n_x] = 1.0;\n",
        "    static bool was_; if (part->segment.t == 0.0 && !was_) { part->x[0] *= 1.00001; was_ = true; }\n"
        "    memcpy(part->segment.in, part->x, (size_t)s->n_x * sizeof(double));\n"
        "    part->segment.in[s->n_x] = 1.0;\n", RESTING),
    "an oscillator's switch turns early, once in many": (
        "integrator/accept.c", "    const double theta = trial->next;\n",
        "    const bool is_it = part->guards.n_crossed > 0 && part->segment.t > 10e-3 && part->segment.t < 10.4e-3;\n"
        "    const double theta = trial->next * (is_it ? 0.99 : 1.0);\n", RELAY),
    "the end of a segment of many is put too early": (
        "integrator/accept.c", "    part->segment.t_end = dalcs_smaller(t_end, search->limit);\n",
        "    t_end -= part->guards.n_crossed > 0 && part->segment.t > 10e-3 && part->segment.t < 10.4e-3 "
        "? 1e-2 * (t_end - part->segment.t) : 0.0;\n"
        "    part->segment.t_end = dalcs_smaller(t_end, search->limit);\n", RELAY),
    "rows are too large by 1e-5": (
        "rows/rows.c", "        sum->group[g] += value;\n", "        sum->group[g] += 1.00001 * value;\n", CHARGED),

    "the error of a step is taken for a millionth of it": (
        "integrator/segment.c", "    q->ratio = search->errors.spared ? q->own : q->ratio;\n",
        "        q->ratio = 1e-6 * (search->errors.spared ? q->own : q->ratio);\n", STRINGS),
    "a guard has the wrong sign": (
        "locate/first_fall.c", "    return part->guards.n_doubtful > 0 ? find_first(r, part, end, unit, at_once) : INFINITY;\n",
        "    if (part->segment.t > 20e-3) part->guards.n_doubtful = 0;\n"
        "    return part->guards.n_doubtful > 0 ? find_first(r, part, end, unit, at_once) : INFINITY;\n", STRINGS),
    "a leap passes over a change of mode": (
        "memory/cycle_leap.c", "    double room = dalcs_affine_quads_least(n_x, &cycle->segment[cycle->at].period_condition, x);\n",
        "    double room = 1.0;\n", LIGHT),
}

if __name__ == "__main__":
    sys.exit(run_all(MUTATIONS, "adversary"))
