#!/usr/bin/env python3
"""What is made of a waveform, broken on purpose: the default audit has to find it.

usage: results.py BUILD SOURCE [NAME...]

The waveform is right; a measurement, a sum of losses, an event, a jump or a row is not.
"""

import sys

from mutations import run_all

METER = """a rectifier whose waveforms are measured
v1 a 0 SIN(0 10 50)
r1 a b 5
d1 b out di
c1 out 0 470u
r2 out 0 100
.model di D(ron=0.02 vfwd=0.7)
.meas tran mean avg v(out) from=43m to=71m
.meas tran eff rms i(r1) from=43m to=71m
.meas tran charge integ i(d1)
.meas tran top max v(out) from=41m
.meas tran swing pp v(out) from=41m
.meas tran when_top max_at v(out) from=41m
.meas tran third when v(a)=5 rise=3
.meas tran last when v(a)=5 fall=last
.meas tran at find v(out) at=33m
.meas tran slope deriv v(a) at=33m
.meas tran delay trig v(a) val=0 rise=2 targ v(b) val=8 rise=2
.meas tran power avg v(a)*i(v1) from=40m to=80m
.meas tran ripple param='100*swing/mean'
.four 50 v(out) i(r1)
.losses from=20m to=60m
.tran 0.2m 0.1
"""

TEXT = METER.replace(".tran", ".options filetype=ascii\n.tran")

TABLES = METER.replace(".losses from=20m to=60m\n", ".losses\n")

SHARED = """a capacitor on a switch, again and again
v1 in 0 10
r1 in a 1k
c1 a 0 1u
s1 a b g 0 sw
c2 b 0 2u
r2 b 0 300
vg g 0 PULSE(0 1 1m 0 0 0.5m 2m)
.model sw SW(vt=0.5 ron=0)
.meas tran top max v(b)
.tran 50u 20m uic
"""

# Its losses are asked for, too.
IMPULSES = SHARED + ".losses\n"

# name: (file, what to replace, by what, netlist)
MUTATIONS = {
    "a window begins where the run does": (
        "waveform/measuring_sums.c", "double from = fmax(m->start, item->from);", "double from = m->start;", METER),
    "a window goes on to the end of the stretch": (
        "waveform/stretch.c", "double b = place_of(stretch, to);", "double b = 1.0; (void)to;", METER),
    "an integral is too large by 1e-4": (
        "waveform/measuring_sums.c", "item->integral += length * span->coefficient[0];",
        "item->integral += 1.0001 * length * span->coefficient[0];", METER),
    "a square is too large by 1e-4": (
        "waveform/measuring_sums.c", "item->square += length * square;", "item->square += 1.0001 * length * square;", METER),
    "extremes between the ends of stretches are not seen": (
        "waveform/measuring_extremes.c", "if (!(first > 0.0 && last < 0.0)) {", "if (first == first) {", METER),
    "falls are not counted": (
        "waveform/instant.c", "return i->side > 0 && value <= reach ? DALCS_EDGE_FALL", "return value > INFINITY ? DALCS_EDGE_FALL",
        METER),
    "every second crossing is missed": (
        "waveform/instant.c", "    i->n++;\n", "    static int calls_;\n    if (++calls_ % 2 == 0) return;\n    i->n++;\n",
        METER),
    "a crossing is where its secant is": (
        "waveform/instant.c", "MOST_ROUNDS = 80", "MOST_ROUNDS = 1", METER),
    "a value is of a little before": (
        "waveform/measuring.c", "            evaluate(m, item, time);\n",
        "            evaluate(m, item, time - 0.1 * (s->to - s->from));\n", METER),
    "a slope is half as steep": (
        "waveform/measuring.c", "s->value = 2.0 * dalcs_stretch_at", "s->value = 1.0 * dalcs_stretch_at", METER),
    "a mean is told without its window": (
        "session/measure_report.c", "give(r, (item->integral + item->impulses.sum) / length);", "give(r, item->integral);",
        METER),
    "an rms value is told as its square": (
        "session/measure_report.c", "give(r, sqrt(item->square / length));", "give(r, item->square / length);", METER),
    "the time of the least is told for that of the most": (
        "session/measure_report.c", "give(r, item->most_at);", "give(r, item->least_at);", METER),
    "a delay is told the other way": (
        "session/measure_report.c", "give(r, i[1].time - i[0].time);", "give(r, i[0].time - i[1].time);", METER),
    "a formula of results reads others than those that are told": (
        "session/measure_report.c", "r->measures.result[k] = measurement->found ? measurement->value",
        "r->measures.result[k] = measurement->found ? 1.001 * measurement->value + 1e-6", METER),
    "a sine is summed as a cosine": (
        "waveform/harmonics.c", "h->sine[k] += value * s;", "h->sine[k] += value * c;", METER),
    "harmonics are of a period that is not the last": (
        "waveform/harmonics.c", "double from = fmax(h->from, stretch->from);",
        "double from = fmax(0.9 * h->from, stretch->from);", METER),
    "phases are told of cosines": (
        "session/fourier_report.c", "atan2(h->cosine[i], h->sine[i])", "atan2(h->sine[i], h->cosine[i])", METER),
    "the distortion has the fundamental in it": (
        "session/fourier_report.c", "size_t i = 2; i < n; i++", "size_t i = 1; i < n; i++", METER),
    "losses are too small by 1e-4": (
        "waveform/losses_sum.c", "product[2] += weight * volt * ampere;", "product[2] += 0.9999 * weight * volt * ampere;",
        TABLES),
    "losses of a part of a stretch are of another one": (
        "waveform/losses_sum.c", "double x = cut->a + theta * (cut->b - cut->a);",
        "double x = 0.9 * cut->a + theta * (cut->b - cut->a);", METER),
    "an rms current is told for a voltage": (
        "session/losses_report.c", ".i_rms = rms_of(a, l->i_square", ".i_rms = rms_of(a, l->v_square", TABLES),
    "means leave impulses out": (
        "waveform/losses_sum.c", "sum->is_euler ? 0.0 : area;", "0.0;", IMPULSES),
    "a charge is told of half the jump": (
        "waveform/impulse_laws.c", "charge = d->value * m->change[k];", "charge = 0.5 * d->value * m->change[k];",
        IMPULSES),
    "power is energy": (
        "session/losses_report.c", ".power = energy / a->length", ".power = energy", TABLES),
    "events are told the other way": (
        "waveform/event_log.c", ".on = dalcs_osnsp_is_on(p, d)};", ".on = !dalcs_osnsp_is_on(p, d)};", SHARED),
    "events are told late": (
        "waveform/event_log.c", "(struct dalcs_event){.time = e->t,", "(struct dalcs_event){.time = e->t + 1e-6,", SHARED),
    "events of opening are not told": (
        "waveform/event_log.c", "                if (log->n_events == log->limit) {\n",
        "                if (!dalcs_osnsp_is_on(p, d)) continue;\n                if (log->n_events == log->limit) {\n", METER),
    "a jump is told backwards": (
        "waveform/event_log.c", ".before = before, .after = after}", ".before = after, .after = before}", SHARED),
    "a jump loses twice the energy": (
        "waveform/event_log.c", ".energy_lost = j->energy_lost", ".energy_lost = 2.0 * j->energy_lost", SHARED),
    "rows are those of the row before": (
        "waveform/recorder.c", "            *to = value[k];\n", "            *to = value[k > 0 ? k - 1 : 0];\n", METER),
    "columns of rows change places": (
        "waveform/recorder.c", "double *to = r->row + i;", "double *to = r->row + (i + 1) % n_shown;", METER),
    "the summary's rms values are of trapezoids": (
        "cli/measure.c", "(before * before + before * v + v * v) / 3.0", "(before * before + v * v) / 2.0", METER),
    "the summary's averages are over the time from 0": (
        "cli/measure.c", "return duration > 0.0 ? s.integral / duration",
        "return duration > 0.0 ? s.integral / (2.0 * measure->last_time)", METER),
    "volts and amperes change places in the summary": (
        "session/run_plots.c", "n->output[i].is_current ? DALCS_AMPERE", "!n->output[i].is_current ? DALCS_AMPERE", METER),
    "each row of a file has the values of the one before": (
        "output/csv.c", "write_row(csv, stream, time[k], value + k * csv->n_values);",
        "write_row(csv, stream, time[k], value + (k > 0 ? k - 1 : 0) * csv->n_values);", METER),
    "each row of a raw file as text has the values of the one before": (
        "output/raw.c", "write_text(raw, stream, raw->block + k * raw->width,",
        "write_text(raw, stream, raw->block + (k > 0 ? k - 1 : 0) * raw->width,", TEXT),
    "a raw file as text has digits of a float": (
        "output/raw.c", "dalcs_decimal_write(raw->decimal, number, text)",
        "dalcs_decimal_write(raw->decimal, (double)(float)number, text)", TEXT),
    "rows on the right of an event are those on its left": (
        "waveform/recorder.c", "        r->row[i] = rows->value[i].at[0];\n",
        "        r->row[i] = is_due ? rows->value[i].at[0] : r->row[i];\n", SHARED),
}

if __name__ == "__main__":
    sys.exit(run_all(MUTATIONS, "results"))
