#!/usr/bin/env python3
"""Operating points and .dc sweeps, broken on purpose: the default audit has to find it.

usage: points.py BUILD SOURCE [NAME...]
"""

import sys

from mutations import run_all

CIRCUIT = """elements of all kinds at rest
v1 a 0 10
i1 0 b 1m
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
b1 k 0 V={limit(3*v(d),-4,4)}
r7 k 0 1k
l2 m 0 1m
l3 n 0 4m
k1 l2 l3 1
r8 a m 1k
r9 n 0 1k
s2 a q p 0 sw
r10 q 0 100
v2 p 0 PULSE(0 5 1u 1n 1n 5u 10u)
.model di D(vfwd=0.7 ron=0.1 roff=1meg)
.model dz D(vfwd=0.7 ron=0.1 vrev=5.1)
.model sw SW(vt=2 vh=0.5 ron=0.1 roff=1meg)
"""

POINT = CIRCUIT + ".op\n"
SWEEP = CIRCUIT + ".dc v1 -10 10 0.1\n"

GATES = """gates and latches at rest
v1 a 0 5
v2 b 0 0
v3 c 0 3.3
a1 a b 0 0 0 0 o1 0 AND vhigh=5 ref=2.5
a2 a b 0 0 0 n2 o2 0 OR vhigh=5 ref=2.5
a3 o2 c 0 0 0 0 o3 0 XOR vhigh=5 ref=2.5 td=1u
a4 o1 0 0 0 0 n4 0 0 INV vhigh=5 ref=2.5
a5 a b 0 0 0 0 q 0 SRFLOP vhigh=5 ref=2.5
a6 a 0 b a 0 m6 q6 0 DFLOP vhigh=5 ref=2.5
a7 q6 m6 0 0 0 0 o7 0 AND vhigh=5 ref=2.5
r1 o1 0 1k
r2 o2 0 1k
r3 o3 0 1k
r4 n4 0 1k
r5 q 0 1k
r6 q6 0 1k
r7 o7 0 1k
r8 n2 0 1k
r9 m6 0 1k
.op
"""

ISLAND = """a part that a source feeds and only capacitors tie to the rest
i0 0 a {current}
r1 a b {ohms}
r2 a b 10
c1 b 0 {farads}
v1 d 0 5
r3 d 0 1k
.op
"""

# Potentials whose rounding hides the current in KCL at each node: 2^-52 of them over r1 is more.
ISLANDS = {"1e12": ISLAND.format(current=2, ohms="0.1m", farads="100k"),
           "1e17": ISLAND.format(current="1m", ohms=1, farads="1u"),
           "1e5": ISLAND.format(current="1n", ohms="1m", farads="1p"),
           "-1e20": ISLAND.format(current="-1k", ohms=1, farads=1)}


# The same where the sources oppose each other, a pair blocks, and inner currents are much larger than what enters.
PARTS = {"1e17": """two sources that oppose each other
i0 0 a 2
i1 b 0 1.9
r1 a b 0.1m
c1 b 0 1u
.op
""", "-1e20": """a diode that blocks is the only way to ground
i0 a 0 2
r1 a b 1
r2 a b 1
d1 b 0 di
.model di D(ron=1m)
.op
""", "2e17": """a coil and an amplifier in it
i0 0 a 2m
e1 b a a c 3
r1 b c 10
l1 c d 1m
r2 d a 1m
c1 d 0 1u
.op
"""}


def runs_away(potential, netlist):
    """Where there is no solution the part is at a potential that nothing determines."""
    given = "    return p->smooth.newton == NULL ? dalcs_latches_solve(p, sigma, u, y)\n"
    return ("osnsp/osnsp.c", given, f"""    if (p->smooth.newton == NULL && sigma == 0.0) {{
        const enum dalcs_status status = dalcs_latches_solve(p, sigma, u, y);
        for (int c = 0; status == DALCS_INFEASIBLE && c < dalcs_system_n_columns(p->system); c++) {{
            y[c] = p->system->column_is_current[c] ? 0.0 : {potential};
        }}
        return status == DALCS_INFEASIBLE ? DALCS_OK : status;
    }}
{given}""", netlist)


# name: (file, what to replace, by what, netlist)
MUTATIONS = {
    "a constant is 1e-4 too large": (
        "euler/component.c", "    inputs[0] = 1.0;\n    for (int k = 1; k < s->n_inputs; k++) {\n"
        "        inputs[k] = dalcs_stimulus_operating_value(",
        "    inputs[0] = 1.0001;\n    for (int k = 1; k < s->n_inputs; k++) {\n"
        "        inputs[k] = dalcs_stimulus_operating_value(", POINT),
    "sources have the values of their waveforms at a later time": (
        "euler/component.c", "        inputs[k] = dalcs_stimulus_operating_value(&c->circuit->stimulus[s->stimulus[k]],\n"
        "                                                   transient_follows);\n",
        "        inputs[k] = dalcs_stimulus_value(&c->circuit->stimulus[s->stimulus[k]], 2e-6 + 0.0 * transient_follows,\n"
        "                                         DALCS_RIGHT);\n", POINT),
    "every second point of a sweep has the sources of the one before": (
        "euler/euler.c", "        dalcs_component_sample_operating(c, transient_follows, c->u);\n",
        "        static int n_; if (n_++ % 2 == 0) dalcs_component_sample_operating(c, transient_follows, c->u);\n", SWEEP),
    "switches do not obey sources": (
        "euler/component.c", "        if (wants != is_on) {\n            dalcs_osnsp_command(&c->osnsp, d, wants);\n",
        "        if (wants != is_on && d < 0) {\n            dalcs_osnsp_command(&c->osnsp, d, wants);\n",
        POINT.replace("PULSE(0 5", "PULSE(5 0")),
    "a threshold is half a volt too high": (
        "dalcs/stamp_device.c", ".turn_on = m->vt + m->vh,", ".turn_on = m->vt + m->vh + 0.5,",
        CIRCUIT + ".dc v2 2.4 3.2 0.2\n"),
    "resistances are 1e-5 too large": (
        "dalcs/stamp_device.c", "dalcs_stamp_conductance(b, d, 1.0 / d->value)",
        "dalcs_stamp_conductance(b, d, 1.0 / (1.00001 * d->value))", POINT),
    "no leakage of switches": (
        "dalcs/stamp_device.c", "        stamp_pair(b, d->node[0], d->node[1], 0.0, dalcs_stamp_series_part(m->ron, m->roff), pair));\n"
        "    return isfinite(m->roff)", "        stamp_pair(b, d->node[0], d->node[1], 0.0, dalcs_stamp_series_part(m->ron, m->roff), pair));\n"
        "    return m->roff < 1.0", POINT),
    "diodes conduct 0.1 mV later": (
        "dalcs/stamp_device.c", "m->vfwd, m->ron, pair)", "m->vfwd + 1e-4, m->ron, pair)", POINT),
    "no breakdown": (
        "dalcs/stamp_device.c", "    if (isfinite(m->vrev)) {", "    if (m->vrev < 0.0) {", SWEEP),
    "a gain is 1e-5 too large": (
        "dalcs/stamp_device.c", "d->is_delay && l->options->at_rest ? -1.0 : -d->value)",
        "d->is_delay && l->options->at_rest ? -1.0 : -1.00001 * d->value)", POINT),
    "a transconductance has the other sign": (
        "dalcs/stamp_device.c", "d->node[2], d->node[3],\n                                            d->value);",
        "d->node[2], d->node[3],\n                                            -d->value);", POINT),
    "an exclusive gate is one of any": (
        "logic/logic_network.c", "g->kind == DALCS_GATE_ONE ? n_high == 1", "g->kind == DALCS_GATE_ONE ? n_high > 0", GATES),
    "a gate of all asks for one": (
        "logic/logic_network.c", "g->kind == DALCS_GATE_AND   ? n_high == n", "g->kind == DALCS_GATE_AND   ? n_high > 0 * n",
        GATES),
    "inverters do not invert": (
        "logic/logic_network.c", "    return bit != input->is_inverted;", "    return bit || (input->is_inverted && bit);", GATES),
    "a latch keeps what it had": (
        "logic/logic_network.c", "    return !reset && (set || q);", "    return !reset && (q || (set && q));", GATES),
    "a flip-flop does not heed its preset": (
        "logic/logic_network.c", "        state->q = !clears;", "        state->q = state->q && !clears;", GATES),
    "complements are not": (
        "logic/logic_outputs.c", "level_of(g, pin, l->network.state[k].seen), changed",
        "level_of(g, 0 * pin, l->network.state[k].seen), changed", GATES.replace("m6 0 0 0 0 o7", "a 0 0 0 0 o7")),
    "a row has the other sign": (
        "waveform/recorder.c", "value[i] = dalcs_recorder_signal(network, e, i);",
        "value[i] = -dalcs_recorder_signal(network, e, i);", POINT),
    **{f"a part that a source feeds is at {potential} V": runs_away(potential, netlist)
       for potential, netlist in ISLANDS.items()},
    **{f"a part with several branches is at {potential} V": runs_away(potential, netlist)
       for potential, netlist in PARTS.items()},
}

if __name__ == "__main__":
    sys.exit(run_all(MUTATIONS, "points", [*ISLANDS.values(), *PARTS.values()]))
