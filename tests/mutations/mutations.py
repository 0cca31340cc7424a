#!/usr/bin/env python3
"""An engine that is broken on purpose: the default audit has to find it, or the full one where that is asked.

usage: mutations.py BUILD SOURCE [NAME...]

Each mutation replaces some text in one source file, compiles that file as the build does and links the program
with it, in a directory of its own. A netlist that uses what is broken is run with the default audit. It is found
if the run ends with exit code 1 because of the audit, or if the proof line tells of a defect that is more than the
component is held to. The same netlist must pass with the program as it is.
"""

import functools
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, some_of  # noqa: E402

SKIPPED = 77

PWM = """sine against triangle
vr r 0 SIN(0 0.8 50)
vt t 0 PULSE(-1 1 0 0.25m 0.25m 0 0.5m)
vin in 0 100
s1 in x r t sw
d1 0 x di
l1 x out 10m
r1 out 0 10
.model sw SW(vt=0 ron=0.01)
.model di D(ron=0.01)
.tran 0.1m 40m
"""

BUCK = """a buck from rest, whose periods are leapt over
vin in 0 12
vg g 0 PULSE(0 1 0 0 0 4u 10u)
s1 in x g 0 sw
d1 0 x di
l1 x out 47u
c1 out 0 100u
r1 out 0 2
.model sw SW(vt=0.5 ron=0.01)
.model di D(ron=0.01)
.tran 5m 5m uic
"""

HYSTERESIS = """a buck that its own output switches
vin in 0 12
s1 in x ref out sw
d1 0 x di
l1 x out 47u
c1 out 0 100u
r1 out 0 2
vr ref 0 5
.model sw SW(vt=0 vh=0.1 ron=0.01)
.model di D(ron=0.01)
.tran 10u 20m uic
"""

HELD = """a switch whose control stays within its hysteresis
vin in 0 12
vc c 0 SIN(0.5 0.1 1k)
s1 in x c 0 sw OFF
r1 x 0 10
c1 x 0 1u
.model sw SW(vt=0.5 vh=0.3 ron=0.01)
.tran 10u 5m
"""

BRIDGE = """a bridge with a smoothing capacitor
v1 a b SIN(0 24 50)
d1 a p di
d2 b p di
d3 n a di
d4 n b di
c1 p n 470u
r1 p n 40
rg n 0 1meg
.model di D(ron=0.02 vfwd=0.7)
.tran 0.1m 2
"""

FLYBACK = """two coupled coils
vin in 0 24
l1 in x 200u
l2 0 y 50u
k1 l1 l2 0.99
vg g 0 PULSE(0 1 0 0 0 3u 10u)
s1 x 0 g 0 sw
rs x in 2k
d1 y out di
c1 out 0 47u
r1 out 0 10
.model sw SW(vt=0.5 ron=0.05)
.model di D(ron=0.02)
.tran 5u 1m uic
"""

FILTER = """a sine into a damped tank, and a rectifier
v1 a 0 SIN(0 10 1k)
r1 a b 50
l1 b c 10m
c1 c 0 1u
d1 c d di
r2 d 0 1k
c2 d 0 4.7u
.model di D()
.tran 20u 10m
"""


SLOW = """a buck of 2000 periods, on which a sine that is slow by far acts: no two periods are the same
vin in 0 12
vg g 0 PULSE(0 1 0 0 0 4u 10u)
s1 in x g 0 sw
d1 0 x di
l1 x out 47u
c1 out 0 100u
r1 out 0 2
vq q 0 SIN(0 1 50)
rq q out 1k
.model sw SW(vt=0.5 ron=0.01)
.model di D(ron=0.01)
.tran 5m 20m uic
"""

CLAMP = """a clamp with a gain of 1e3
v1 in 0 SIN(0 5 1k)
r1 in x 1k
e1 o 0 value={limit(1e3*(2-v(x)),-12,12)}
d1 x o di
c1 x 0 10n ic=3
.model di D()
.tran 1u 4m uic
"""

LIMIT = """a limit of a coil's current with a gain of 1e3
l1 a m 10m ic=3
r1 m s 100
vs s 0 0
b1 0 a I=limit(1e3*(2-i(vs)),-12,12)
d1 a 0 di
.model di D()
.tran 1u 4m uic
"""

SHORT = BUCK.replace(".tran 5m 5m uic", ".tran 10u 100u uic")

APART = """a buck beside a part of its own: no periods are leapt over
vin in 0 12
vg g 0 PULSE(0 1 0 0 0 4u 10u)
s1 in x g 0 sw
d1 0 x di
l1 x out 47u
c1 out 0 100u
r1 out 0 2
v2 y 0 1
r2 y z 1
c2 z 0 1m
.model sw SW(vt=0.5 ron=0.01)
.model di D(ron=0.01)
.tran 5m 20m uic
"""


ALIKE = BUCK.replace("c1 out 0 100u\nr1 out 0 2\n", "c1 out 0 1u\nr1 out 0 40\n").replace(".tran 5m 5m uic", ".tran 1u 0.1m 0 20n uic")
FED_BACK = ALIKE.replace("r1 out 0 40\n", "r1 out 0 40\nv2 y 0 SIN(0 1 50k)\nr2 y out 1k\n")

LEAPS = BUCK.replace(".tran 5m 5m uic", ".tran 1m 20m uic")

BEAT = BRIDGE.replace("v1 a b SIN(0 24 50)", "v1 a m SIN(0 24 50)\nv2 m b SIN(0 1 7.77)")


GATES = """gates, a latch, a flip-flop, a delay, a counter and two samples, from sources that are independent of each other
va a 0 PULSE(0 1 1u 0 0 3u 7u)
vb b 0 PULSE(0 1 2u 0 0 5u 11u)
vc c 0 SIN(0 1 61k)
a1 a b 0 0 0 0 and 0 AND
a2 a 0 0 0 0 0 late 0 BUF Td=500n
a3 c b 0 0 0 0 latch 0 SRFLOP
a4 c 0 a 0 0 0 flop 0 DFLOP
a5 and late latch 0 0 0 any 0 OR Vhigh=5 Ref=0.5
a6 a 0 0 0 0 0 third 0 COUNTER cycles=3 duty=0.3
a7 c 0 a 0 0 0 held 0 SAMPLEHOLD
a8 x 0 0 b 0 0 let 0 SAMPLEHOLD
aadc [a b c] [da db dc] adc
.model adc adc_bridge(in_low=0.2 in_high=0.8)
aflip da db dc null null q nq flip
.model flip d_jkff(clk_delay=20n)
adac [q nq] [slow slower] dac
.model dac dac_bridge(out_high=3)
r6 slow slower 1k
r1 any x 1k
c1 x 0 1n ic=0
r2 flop 0 1k
r3 third 0 1k
r4 held 0 1k
r5 let 0 1k
.tran 1u 400u uic
"""

INTERRUPTED = """a share of what the coil's current does to the diode as the switch opens is in the switch's own control
v1 in 0 5
vt t 0 pulse(0 2 0 1u 0 0 1u)
b1 c 0 v=1.6-v(t)+1e-6*(v(o)-24)
l1 in s 60u ic=5
s1 s 0 c 0 sw
d1 s o
c1 o e 375u ic=24
r1 e 0 20m
r2 o 0 240
.model sw sw(ron=10m vt=0)
.tran 10n 1u uic
.end
"""
VIENNA = """a capacitor of 2.5 kV behind a diode, whose other end a switch takes to 0
v1 s0 n SIN(0 3000 5939.416631497978)
l1 s0 a0 0.0008709660510399749
d1 a0 p
s1 a0 o g0 0 m0
v3 s1 n SIN(0 3000 5939.416631497978 0 0 -120)
l2 s1 a1 0.0036186760437887664
v4 g1 0 PULSE(0 1 3.1671946700848548e-06 9.501584010254564e-08 9.501584010254564e-08 7.192732006434399e-06
+ 9.501584010254564e-06)
d5 a1 e1
d6 o e1
d8 f1 o
s2 e1 f1 g1 0 m0
v5 s2 n SIN(0 3000 5939.416631497978 0 0 -240)
l3 s2 x3 0.0007575917912653039
r1 x3 a2 3.790970748048701
v6 g2 0 PULSE(0 1 6.3343893401697096e-06 0 0 1.240325936746183e-06 9.501584010254564e-06)
d10 m a2
s3 a2 o g2 0 m0
c1 p o 2.388600190592972e-06 IC=3600
c2 o m 1.139067168246353e-06 IC=0
r4 o 0 1
.model m0 SW(ron=0 roff=100000 vt=0.5 vh=0)
.tran 0.8u 159.36192620807314u uic
"""


def once(calls, good, bad):
    """In C: `bad` the so-manieth time only."""
    return f"static long calls_; if (++calls_ == {calls}) {{ {bad} }} else {{ {good} }}"


SATURABLE = """a coil that saturates smoothly, and a capacitor
v1 1 0 SIN(0 1.1 0.3)
r1 1 2 50m
l1 2 3 Flux=1*asinh(x)
c1 3 0 0.6 IC=0
.tran 0.1 12 uic
"""

# Formulas that are steep at some time and flat at others, where what is steep is cut off or cancels. On the flat side a fault
# is as large as on any.
STEEP = """an exponential of up to 2e4, of which 5 V are left
i1 0 1 SIN(3 8 1)
b1 1 0 V=min(exp(i(b1))-1,5)+0.1*i(b1)
r1 1 0 10
c1 1 0 0.05 ic=0
.tran 0.05 1 uic
"""

LATE = """an exponential that is steep only at last
v1 a 0 PWL(0 0 0.9m 0.9 1m 20)
r1 a b 1k
c1 b 0 1n ic=0
b1 o 0 V=min(exp(v(b)),5)+0.1*v(b)
r2 o p 1k
c2 p 0 100n ic=0
.tran 5u 1m uic
"""

POWERS = """two exponentials, both cut off
v1 a 0 PWL(0 -1 1m 1)
r1 a b 1k
c1 b 0 10n ic=-1
b1 o 0 V=min(exp(22*v(b)),2)-min(exp(20*v(b)),1)+v(b)
r2 o p 1k
c2 p 0 1u ic=0
.tran 5u 1m uic
"""

JUNCTION = """currents of microamperes through junctions that a limit protects
i1 0 b SIN(0 1u 1k)
r1 b 0 1meg
c1 b 0 100p ic=0
b1 b 0 I=min(1e-12*(exp(v(b)/0.05)-1),1e-7)
b2 o 0 I=min(1e-15*(exp(v(b)/0.026)-1),1e-7)
r2 o 0 1meg
c2 o 0 100p ic=0
.tran 5u 2m uic
"""

FLAT_SINH = """a hyperbolic sine between limits
v1 a 0 SIN(0 6 1k)
r1 a b 1
c1 b 0 100u ic=0
b1 o 0 V=limit(sinh(v(b)),-3,3)+0.2*v(b)
r2 o p 1
c2 p 0 50u ic=0
.tran 10u 2m uic
"""

VALUE = "    return dalcs_smooth_share(share, dalcs_smooth_value(of->kind, x)) -\n"


def flatly(kind, part):
    """A smooth function is so much of itself more where it is less than about 1."""
    return (f"    const double is_ = dalcs_smooth_value(of->kind, x);\n"
            f"    return dalcs_smooth_share(share, is_ + (of->kind == {kind} ? {part} * is_ * exp(-is_ * is_) : 0.0)) -\n")


# name: (file, what to replace, by what, netlist)
KICK = """three switches in series with gates between floating nodes, and a coil that one at ground interrupts
vin n0 0 24
.model sm SW(vt=0.5 ron=0.1m roff=41.7meg)
s0 n0 n1 g0 n1 sm
r0 n0 n1 0.5
vf0 f0 n1 PULSE(0 0.5 1.4u 0.2u 0.4u 7.4u 20u)
e0 g0 n1 f0 n1 2
s1 n1 n2 g1 n2 sm
r1 n1 n2 0.6
vf1 f1 n2 PULSE(0 0.5 3.6u 0.25u 0.5u 9.4u 25u)
e1 g1 n2 f1 n2 2
s2 n2 n3 g2 n3 sm
r2 n2 n3 0.7
vf2 f2 n3 PULSE(0 0.5 6.5u 0.3u 0.6u 11.4u 31u)
e2 g2 n3 f2 n3 2
l1 n3 out 10u
r3 out 0 0.1
l2 out kk 2u
s3 kk 0 gk 0 sm
vk gk 0 PULSE(0 1 10u 0.36u 0.72u 13.4u 36u)
.tran 35u 350u uic
""" + "".join(f"rw{k} {f'w{k - 1}' if k > 0 else 'n0'} w{k} 1k\ncw{k} w{k} 0 1p\n" for k in range(60))

# The current comes back through a diode and 1 uohm: no voltage tells its end.
THYRISTOR = """a resonant pulse through a thyristor
v1 in 0 100
l1 in x 100u ic=0
c1 y 0 1u ic=0
a1 x y g y th
r1 y u 1u
d1 u x d
vg g y PULSE(0 1 10u 0 0 5u 1)
.model d D(ron=0)
.model th thyristor
.tran 1u 5m uic
"""

AMMETERS = """two resistors far below others that share a current
v1 in 0 SIN(0 5 1k)
r1 in a 2
r2 a b 1n
r3 a b 2n
r4 b 0 1Meg
r5 b c 1
c1 c 0 10u
.save i(r2) i(r3)
.tran 10u 2m uic
"""

MUTATIONS = {
    "a thyristor does not open": (
        "dalcs/assemble.c", "            pair->has_valve = true;\n", "            pair->has_valve = false;\n", THYRISTOR),
    "a source is dropped from a control": (
        "excitation/control_course.c", "k < a->p[pair + 1]; k++", "k + 1 < a->p[pair + 1]; k++", PWM),
    "a command comes early": (
        "excitation/commands.c", "    m->next = dalcs_command_time(m, way, m->n[way]);\n",
        "    m->next = dalcs_command_time(m, way, m->n[way]) * (1.0 - 1e-4);\n", FLYBACK),
    "an event of a diode is skipped": (
        "locate/first_fall.c", "if (!(bound[g] >= 0.0) && ", "if (!(bound[g] >= 0.0) && g != 0 && ",
        BRIDGE),
    "a map is stale": (
        "stages/stage_cache.c", "return e->h == h && ", "return (e->h == h || e->h == 0.5 * h) && ",
        FILTER),
    "a leap one period too far": (
        "memory/cycle_leap.c", "        put_off(r, part, n);\n", "        put_off(r, part, n + 1);\n", BUCK),
    "a leap tells of fewer periods than it took": (
        "memory/cycle_leap.c", "(size_t)n_x * sizeof(double));\n    return n;\n",
        "(size_t)n_x * sizeof(double));\n    return n > 2 ? n - 1 : n;\n", BUCK),
    "a state is nudged by 1e-7": (
        "step/present.c", "    part->segment.in[s->n_x] = 1.0;\n",
        "    part->segment.in[s->n_x] = 1.0;\n    part->segment.in[0] *= 1.0 + 1e-7;\n", FILTER),
    "a sine is too slow by 1e-4": (
        "excitation/excitation.c", ".omega = term != NULL ? term->omega : 0.0",
        ".omega = term != NULL ? 0.9999 * term->omega : 0.0", FILTER),
    "hysteresis is half as wide": (
        "dalcs/stamp_device.c", ".turn_off = m->vt - m->vh}", ".turn_off = m->vt}", HYSTERESIS),
    "an event comes late": (
        "integrator/accept.c", "    part->segment.t_end = dalcs_smaller(t_end, search->limit);\n",
        "    t_end += part->guards.n_crossed > 0 ? 1e-3 * part->segment.h : 0.0;\n"
        "    part->segment.t_end = dalcs_smaller(t_end, search->limit);\n", BRIDGE),
    "a switch starts on the other side": (
        "dalcs/stamp_device.c", ".initially_on = d->initially_on,", ".initially_on = !d->initially_on,",
        HELD),
    "a resistor is stamped too large": (
        "dalcs/stamp_device.c", "1.0 / d->value", "1.0 / (1.00001 * d->value)", FILTER),
    "a resistor of 1 nohm is stamped too large": (
        "dalcs/stamp_device.c", "current_column[device],\n                           -d->value);",
        "current_column[device],\n-(d->value < 1.5e-9 ? 1.001 : 1.0) * d->value);", AMMETERS),
    "a state is nudged by 1e-6 in one segment of 20": (
        "step/present.c", "    part->segment.in[s->n_x] = 1.0;\n",
        "    part->segment.in[s->n_x] = 1.0;\n" + once(15, "", "part->segment.in[0] *= 1.0 + 1e-6;"), SHORT),
    "a state is nudged by 1e-6 in one segment of 4000": (
        "step/present.c", "    part->segment.in[s->n_x] = 1.0;\n",
        "    part->segment.in[s->n_x] = 1.0;\n" + once(3210, "", "part->segment.in[0] *= 1.0 + 1e-6;"), SLOW),
    "a state is nudged by 1e-6 in one segment of 4000 that recur": (
        "step/present.c", "    part->segment.in[s->n_x] = 1.0;\n",
        "    part->segment.in[s->n_x] = 1.0;\n" + once(3210, "", "part->segment.in[0] *= 1.0 + 1e-6;"), APART),
    "the values of one segment of 4000 are too large by 1e-5": (
        "step/present.c", "    part->segment.rounding = dalcs_stage_rounding(*entry);\n",
        "    part->segment.rounding = dalcs_stage_rounding(*entry);\n"
        + once(3210, "", "for (int k = part->stages.layout.stride; k < part->stages.layout.n_fixed; k++) "
                         "{ part->segment.out[k] *= 1.00001; }"), SLOW),
    "a state is nudged by 1e-6 in one step of 5000 alike": (
        "step/present.c", "    part->segment.in[s->n_x] = 1.0;\n",
        "    part->segment.in[s->n_x] = 1.0;\n" + once(3333, "", "part->segment.in[0] *= 1.0 + 1e-6;"), FED_BACK),
    "the values of one step of 5000 alike are too large by 1e-5": (
        "step/present.c", "    part->segment.rounding = dalcs_stage_rounding(*entry);\n",
        "    part->segment.rounding = dalcs_stage_rounding(*entry);\n"
        + once(3333, "", "for (int k = part->stages.layout.stride; k < part->stages.layout.n_fixed; k++) "
                         "{ part->segment.out[k] *= 1.00001; }"), FED_BACK),
    "a diode conducts on among steps alike": (
        "locate/first_fall.c", "if (!(bound[g] >= 0.0) && ",
        "if (!(bound[g] >= 0.0) && (part->segment.t < 60e-6 || part->segment.t > 80e-6) && ", ALIKE),
    "a command among steps alike is lost": (
        "excitation/commands.c", "        m->is_on = !m->is_on;\n",
        "            " + once(13, "m->is_on = !m->is_on;", ""), FED_BACK),
    "one command of 4000 is lost": (
        "excitation/commands.c", "        m->is_on = !m->is_on;\n",
        "            " + once(3210, "m->is_on = !m->is_on;", ""), SLOW),
    "one command of 4000 comes 1e-3 of its time too early": (
        "excitation/commands.c", "    m->next = dalcs_command_time(m, way, m->n[way]);\n",
        "    m->next = dalcs_command_time(m, way, m->n[way]);\n"
        "    m->next -= m->next > 16.001e-3 && m->next < 16.009e-3 ? 4e-9 : 0.0;\n", SLOW),
    "one map of 4000 is stale": (
        "step/present.c",
        "    DALCS_TRY(dalcs_stages_step(&part->stages, part->component->osnsp.mode, part->segment.h,",
        "    static long calls_;\n    DALCS_TRY(dalcs_stages_step(&part->stages, part->component->osnsp.mode, "
        "++calls_ == 3210 ? 0.5 * part->segment.h : part->segment.h,", SLOW),
    "one event of 200 comes late": (
        "integrator/accept.c", "    part->segment.t_end = dalcs_smaller(t_end, search->limit);\n",
        "    t_end += part->guards.n_crossed > 0 && part->segment.t > 1.0 && part->segment.t < 1.01 "
        "? 1e-3 * part->segment.h : 0.0;\n"
        "    part->segment.t_end = dalcs_smaller(t_end, search->limit);\n", BEAT),
    "a state jumps against a diode": (
        "integrator/segment.c", "    dalcs_segment_renew(part);\n    if (dalcs_sliding_leave",
        "    static long calls_;\n    for (int x = 0; calls_ < 1 && part->segment.t > 0.0 && x < part->component->system->n_x; x++) {\n"
        "        calls_ += part->x[x] > 2000.0 && part->guards.n_crossed > 0 ? 1 : 0;\n"
        "        part->x[x] *= calls_ == 1 && part->x[x] > 2000.0 ? 0.5 : 1.0;\n    }\n"
        "    dalcs_segment_renew(part);\n    if (dalcs_sliding_leave", VIENNA),
    "the current of a coil jumps to 0 against a diode": (
        "decide/projection.c", "    *jumps = *moved && !lengths->may_jump && is_jump(part);\n",
        "    *jumps = *moved && !lengths->may_jump && is_jump(part) && false;\n", INTERRUPTED),
    "an AND is an OR": (
        "logic/logic_network.c", "DALCS_GATE_AND   ? n_high == n", "DALCS_GATE_AND   ? n_high > 0", GATES),
    "a latch is reset by nothing": (
        "logic/logic_network.c", "return !reset && (set || q);", "return (reset || true) && (set || q);", GATES),
    "a flip-flop falls through": (
        "logic/logic_network.c", "        state->q = next(l, g, state->q);", "        state->q = !next(l, g, state->q);", GATES),
    "a counter counts one too many": (
        "logic/logic_network.c", "state->count % g->cycles + 1", "state->count % (g->cycles + 1) + 1", GATES),
    "one sample of many takes a hundredth more": (
        "logic/logic_outputs.c", "        dalcs_logic_effect_note(l, g->output[0]);\n",
        "        dalcs_logic_effect_note(l, g->output[0]);\n        " + once(17, "", "l->taken[k] *= 1.01;") + "\n", GATES),
    "a sample forgets what it let through": (
        "logic/logic_network.c", "(state->q && !tracks && !l->rests)", "false", GATES),
    "a delay is a tenth longer": (
        "logic/logic_queue.c", "l->now + (next->is", "l->now + 1.1 * (next->is", GATES),
    "a JK flip-flop turns over too often": (
        "logic/logic_network.c", "(q ? !reset : data)", "(q ? !reset && !data : data)", GATES),
    "one output of many shows the other level": (
        "logic/logic_outputs.c", "const double level = level_of(g, pin, l->network.state[k].seen);",
        "static long calls_; const double level = level_of(g, pin, l->network.state[k].seen != (++calls_ == 37));", GATES),
    "a complement is no complement": (
        "logic/logic_outputs.c", "return q == (pin == 0) ? g->high : g->low;", "return q ? g->high : g->low;", GATES),
    "a level of gates is a millionth too low": (
        "logic/logic_outputs.c", "(pin == 0) ? g->high : g->low;", "(pin == 0) ? 0.999999 * g->high : g->low;", GATES),
    "ramps of gates take a hundredth longer": (
        "logic/logic_outputs.c", "? g->rise : g->fall, g->high", "? 1.01 * g->rise : g->fall, g->high", GATES),
    "a smooth function is too steep by 1e-5": (
        "dalcs/stamp_behaviour.c", "    return dalcs_triplets_add(&b->E, l->branch_row[device], input, -1.0);",
        "    return dalcs_triplets_add(&b->E, l->branch_row[device], input, -1.00001);", SATURABLE),
    "the values of one segment beside a smooth function are too large by 1e-5": (
        "step/present.c", "    part->segment.by_euler = false;\n",
        "    part->segment.by_euler = false;\n"
        + once(150, "", "for (int k = part->stages.layout.stride; k < part->stages.layout.n_fixed; k++) "
                        "{ part->segment.out[k] *= 1.00001; }"), SATURABLE),
    "an exponential is off by 1e-5 of itself where it is flat": (
        "dalcs/smooth_tangents.c", VALUE, flatly("DALCS_SMOOTH_EXP", 1e-5), STEEP),
    "the same, and it is steep only later": (
        "dalcs/smooth_tangents.c", VALUE, flatly("DALCS_SMOOTH_EXP", 1e-5), LATE),
    "two that are cut off are off by 1e-6 of themselves": (
        "dalcs/smooth_tangents.c", VALUE, flatly("DALCS_SMOOTH_EXP", 1e-6), POWERS),
    "an exponential of a junction is off by 1e-3 of itself where it is flat": (
        "dalcs/smooth_tangents.c", VALUE, flatly("DALCS_SMOOTH_EXP", 1e-3), JUNCTION),
    "a hyperbolic sine is off by 1e-6 of itself where it is flat": (
        "dalcs/smooth_tangents.c", VALUE, flatly("DALCS_SMOOTH_SINH", 1e-6), FLAT_SINH),
    "a coil jumps beside a kick of 1e10 V": (
        "decide/seen_jump.c", "r->base->jump.is_first || !is_near;", "r->base->jump.is_first;", KICK),
    "a capacitor jumps 1e-4 beyond a clamp with a gain": (
        "decide/seen_jump.c", "after[x] += differ;", "after[x] = (after[x] + differ) * (1.0 - 1e-4);", CLAMP),
    "a coil jumps 1e-4 beyond a limit with a gain": (
        "decide/seen_jump.c", "after[x] += differ;", "after[x] = (after[x] + differ) * (1.0 - 1e-4);", LIMIT),
    "one leap of many is nudged by 1e-6": (
        "memory/cycle_leap.c", "    memcpy(part->x, states[0], (size_t)n_x * sizeof(double));\n    return n;\n",
        "    memcpy(part->x, states[0], (size_t)n_x * sizeof(double));\n"
        + once(5, "", "part->x[0] *= 1.0 + 1e-6;") + "\n    return n;\n", LEAPS),
}


def compile_command(build, source_file):
    for entry in json.loads((build / "compile_commands.json").read_text()):
        path = pathlib.Path(entry["directory"], entry["file"]).resolve()
        if path == source_file.resolve():
            return shlex.split(entry["command"]), entry["directory"]
    raise SystemExit(f"{source_file} is compiled nowhere")


@functools.cache
def linker():
    """The one that takes a third of the time, where binutils have it."""
    return ["-fuse-ld=gold"] if shutil.which("ld.gold") else []


@functools.cache
def link_command(build):
    text = subprocess.run(["ninja", "-C", str(build), "-t", "commands", "dalcs"], capture_output=True,
                          text=True, check=True).stdout
    return shlex.split(text.strip().splitlines()[-1])


def mutant(build, source, file, old, new, where):
    """The program with one mutated file, in directory `where`."""
    original = source / "src" / file
    text = original.read_text()
    if old not in text:
        raise SystemExit(f"{file} has no text {old!r}: mend the mutation")
    mutated = where / original.name
    mutated.write_text(text.replace(old, new))
    command, directory = compile_command(build, original)
    entry = command.index("-c") + 1
    command[entry] = str(mutated)
    object_file = where / (original.name + ".o")
    command[command.index("-o") + 1] = str(object_file)
    for flag in ("-MF", "-MQ"):
        command[command.index(flag) + 1] = str(where / "dependencies")
    command.insert(1 if "ccache" not in command[0] else 2, f"-iquote{original.parent}")
    # Not optimised: a file is compiled in half the time, and what it computes is the same.
    command = ["-O0" if c == "-O2" else c for c in command if c not in ("-Werror", "-g")]
    subprocess.run(command, cwd=directory, check=True)
    program = where / "dalcs"
    link = list(link_command(build))
    link[link.index("-o") + 1] = str(program)
    link[link.index("-o") + 2:link.index("-o") + 2] = [str(object_file), "-Wl,--strip-debug", *linker()]
    subprocess.run(link, cwd=build, check=True)
    return program


FEW = {BUCK, SLOW, APART, LEAPS}
FULL = {KICK}  # beside the largest voltages a flux over an interval tells least
AT = "4.9e-3\n"  # s, so that there are few rows
OFTEN = "".join(f"{k}.1e-3\n" for k in range(20))


def verdict(program, netlist, where):
    """("passes" | "noticed" | "broken" | "fails otherwise", what the run said)."""
    (where / "circuit.cir").write_text(netlist + ".end\n")
    (where / "at").write_text(OFTEN if netlist == LEAPS else AT)
    options = ["--at", str(where / "at")] if netlist in FEW else ["--audit", "full"] if netlist in FULL else []
    try:
        output = "out.raw" if "filetype=" in netlist else "out.csv"
        command = [str(program), "run", str(where / "circuit.cir"), "-o", str(where / output)]
        ran = subprocess.run(command + options, capture_output=True, text=True, timeout=60)
    except subprocess.TimeoutExpired:
        return "fails otherwise", "it takes more than 60 s"
    said = ran.stdout + ran.stderr
    if ran.returncode == 1 and "the audit finds" in said:
        return "broken", said
    if ran.returncode != 0:
        return "fails otherwise", said
    proof = next((line for line in ran.stdout.splitlines() if line.startswith("  proof")), "")
    return ("noticed" if "more than" in proof else "passes"), said


def verdict_of(program, netlist):
    with tempfile.TemporaryDirectory() as directory:
        return verdict(program, netlist, pathlib.Path(directory))


def run_all(mutations, suite, refused=()):
    """refused: netlists without a solution, which the program as it is says."""
    build, source = (pathlib.Path(a).resolve() for a in sys.argv[1:3])
    if shutil.which("ninja") is None:
        return SKIPPED
    checker = Checker(suite)
    sound = functools.cache(lambda netlist: verdict_of(build / "dalcs", netlist))
    for name, (file, old, new, netlist) in some_of(mutations.items(), 2):
        if sys.argv[3:] and name not in sys.argv[3:]:
            continue
        with tempfile.TemporaryDirectory() as directory:
            where = pathlib.Path(directory)
            found, said = sound(netlist)
            is_sound = found == "fails otherwise" and "no solution exists" in said if netlist in refused else found == "passes"
            checker.check(is_sound, f"{name}: without it: {found}: {said}")
            broken = mutant(build, source, file, old, new, where)
            found, said = verdict(broken, netlist, where)
            line = next((x for x in said.splitlines() if "the audit finds" in x or x.startswith("  proof")), "")
            print(f"{name}: {found}: {line.strip()}")
            checker.check(found in ("broken", "noticed"), f"{name}: {found}: {said}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(run_all(MUTATIONS, "mutations"))
