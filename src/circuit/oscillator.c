/* oscillator.c - sources whose control voltage is their frequency.
 *
 * Of a constant control they are sources of time. Else a number between 0 and 1 goes up and down as a triangle does: a
 * capacitor that a source charges, whose direction a switch with a hysteresis turns where it arrives. So the phase has
 * no end that it could grow to, its error stays one of a single number below 1, and each turn is an event. A square is
 * its direction, a sine of the phase is the cosine of half a turn times that number, which is smooth where it turns.
 * Until t = 0 a switch holds it at its first phase: the operating point, and small signals around it, see no oscillation. */
#include "oscillator.h"

#include "output_resistance.h"
#include "pi.h"

#include "element_cards.h"
#include "logic_parts.h"
#include "model_cards.h"

#include <math.h>

enum { MOST_DEVICES = 20 }; /* that one consists of */

bool dalcs_oscillator_set_hertz(struct dalcs_oscillator *o, const struct dalcs_piecewise *table) {
    struct dalcs_piecewise *f = &o->hertz;
    const struct dalcs_knot *first = &table->knot[0];
    const struct dalcs_knot *last = &table->knot[table->n - 1];
    *f = dalcs_block_make_table(&o->card, table->n + 2);
    if (f->knot == NULL) {
        return false;
    }
    f->n = 0;
    f->before = table->before > 0 ? 0 : table->before;
    f->after = table->after < 0 ? 0 : table->after;
    if (table->before > 0 && first->value > 0) {
        dalcs_block_set_knot(f, f->n++, first->at - first->value / table->before, 0);
    }
    for (int k = 0; k < table->n; k++) {
        f->knot[f->n++] = table->knot[k];
    }
    if (table->after < 0 && last->value > 0) {
        dalcs_block_set_knot(f, f->n++, last->at - last->value / table->after, 0);
    }
    return true;
}

/* ---- A constant control ------------------------------------------------------------------------------------------ */

/* Is the control ground, or a V source of a number to ground? LTspice's `startup` lets that rise. */
static bool is_constant(const struct dalcs_oscillator *o, double *value) {
    const struct dalcs_builder *builder = o->card.builder;
    const struct dalcs_circuit *circuit = builder->circuit;
    const struct dalcs_block_end *control = &o->control;
    *value = 0;
    if (control->node == control->reference) {
        return true;
    }
    for (int k = 0; k < circuit->n_devices && builder->analyses.startup == NULL; k++) {
        const struct dalcs_device *d = &circuit->device[k];
        if (d->kind == DALCS_VSOURCE && d->node[0] == control->node &&
            d->node[1] == control->reference &&
            circuit->stimulus[d->stimulus].kind == DALCS_STIMULUS_DC) {
            *value = circuit->stimulus[d->stimulus].dc;
            return true;
        }
    }
    return false;
}

/* A pulse that begins anew each period. A digital one whose first phase is high is a pulse of its low level. */
static void set_pulse(const struct dalcs_oscillator *o, double hertz, struct dalcs_stimulus *s) {
    const double high = o->duty / hertz;
    const double low = (1 - o->duty) / hertz;
    const bool is_turned = o->phase >= 1 - o->duty;
    s->kind = DALCS_STIMULUS_PULSE;
    s->u.pulse.low = is_turned ? o->high : o->low;
    s->u.pulse.high = is_turned ? o->low : o->high;
    s->u.pulse.period = 1 / hertz;
    if (o->shape == DALCS_OSCILLATOR_TRIANGLE) {
        s->u.pulse.rise = high;
        s->u.pulse.fall = low;
    } else if (o->shape == DALCS_OSCILLATOR_SQUARE) {
        s->u.pulse.delay = low;
        s->u.pulse.rise = o->rise;
        s->u.pulse.fall = o->fall;
        s->u.pulse.width = high - o->rise;
    } else {
        const double later = o->fall_delay - o->rise_delay;
        s->u.pulse.delay = is_turned ? (1 - o->phase) / hertz + o->fall_delay
                                     : low - o->phase / hertz + o->rise_delay;
        s->u.pulse.width = is_turned ? low - later : high + later;
    }
}

static void add_output(const struct dalcs_oscillator *o, const struct dalcs_device *source) {
    if (o->may_resist) {
        dalcs_output_add(o->card.builder, o->place, source);
    }
}

static bool add_source(const struct dalcs_oscillator *o, double hertz) {
    const struct dalcs_block_card *c = &o->card;
    const struct dalcs_block_end *out = &o->out;
    struct dalcs_stimulus s = {.kind = DALCS_STIMULUS_DC,
                               .has_dc = true,
                               .dc = o->shape == DALCS_OSCILLATOR_SINE ? 0.5 * (o->low + o->high)
                                     : o->phase >= 1 - o->duty         ? o->high
                                                                       : o->low};
    if (hertz > 0 && o->shape == DALCS_OSCILLATOR_SINE) {
        s = (struct dalcs_stimulus){.kind = DALCS_STIMULUS_SIN};
        s.u.sine.offset = 0.5 * (o->low + o->high);
        s.u.sine.amplitude = 0.5 * (o->high - o->low);
        s.u.sine.frequency = hertz;
        s.u.sine.phase = 360 * o->phase;
    } else if (hertz > 0) {
        s = (struct dalcs_stimulus){0};
        set_pulse(o, hertz, &s);
        if (s.u.pulse.width < 0) {
            dalcs_builder_error(c->builder, o->place, NULL, "%s is longer than a pulse at %g Hz",
                                o->shape == DALCS_OSCILLATOR_SQUARE ? "rise_time"
                                                                    : "the difference of delays",
                                hertz);
            return false;
        }
    }
    struct dalcs_device *v = dalcs_block_add(c, DALCS_VSOURCE, o->what, out->node, out->reference);
    if (v != NULL) {
        dalcs_block_add_stimulus(c, v, &s);
        add_output(o, v);
    }
    return v != NULL;
}

/* ---- A control that varies --------------------------------------------------------------------------------------- */

static int add_node(const struct dalcs_oscillator *o, const char *what) {
    return dalcs_builder_inner_node(o->card.builder, what, o->card.card->token);
}

/* From a node to another one, which a resistor holds at 0 V while it is open. */
static struct dalcs_device *add_gate(const struct dalcs_oscillator *o, const char *what, int from,
                                     int to, const int *control,
                                     const struct dalcs_switch_model *model) {
    struct dalcs_device *s = dalcs_block_add(&o->card, DALCS_SWITCH, what, from, to);
    const int index = dalcs_switch_add_model(o->card.builder, model);
    if (s == NULL || index < 0) {
        return NULL;
    }
    s->node[2] = control[0];
    s->node[3] = control[1];
    s->model = index;
    return s;
}

static bool add_load(const struct dalcs_oscillator *o, const char *what, int node) {
    struct dalcs_device *r = dalcs_block_add(&o->card, DALCS_RESISTOR, what, node, 0);
    if (r != NULL) {
        r->value = 1;
    }
    return r != NULL;
}

static bool add_charge(const struct dalcs_oscillator *o, const char *what, int state, int by,
                       double rate) {
    struct dalcs_device *g = dalcs_block_add(&o->card, DALCS_VCCS, what, 0, state);
    if (g != NULL) {
        g->node[2] = by;
        g->value = dalcs_charging * rate;
    }
    return g != NULL;
}

/* Until t = 0 at `first`. */
static bool add_hold(const struct dalcs_oscillator *o, int state, double first) {
    const int level = add_node(o, "first");
    const int hold = add_node(o, "hold");
    const struct dalcs_switch_model model = {.name = "hold", .roff = (double)INFINITY, .vt = 0.5};
    struct dalcs_stimulus s = {.kind = DALCS_STIMULUS_PULSE};
    s.u.pulse.low = 1;
    s.u.pulse.width = s.u.pulse.period = (double)INFINITY;
    struct dalcs_device *v = dalcs_block_add(&o->card, DALCS_VSOURCE, "hold", hold, 0);
    struct dalcs_device *c = dalcs_block_add(&o->card, DALCS_CAPACITOR, "state", state, 0);
    if (level < 0 || hold < 0 || v == NULL || c == NULL ||
        !dalcs_block_add_constant(&o->card, DALCS_VSOURCE, "first", (int[]){level, 0}, first) ||
        add_gate(o, "hold", state, level, (int[]){hold, 0}, &model) == NULL) {
        return false;
    }
    dalcs_block_add_stimulus(&o->card, v, &s);
    c->value = dalcs_charging;
    c->initial = first;
    c->has_initial = true;
    return true;
}

/* The number that goes up for `up` of each period, and down, at node[0], and at node[1] 1 while it goes down. */
static bool add_swing(const struct dalcs_oscillator *o, double up, double phase, int *node) {
    static const char *const names[] = {"state", "falls", "hertz", "back", "one"};
    int at[5];
    bool ok = true;
    for (int k = 0; k < 5; k++) {
        at[k] = add_node(o, names[k]);
        ok = ok && at[k] >= 0;
    }
    struct dalcs_device *f = dalcs_block_add(&o->card, DALCS_VCVS, "hertz", at[2], 0);
    if (!ok || f == NULL) {
        return false;
    }
    dalcs_block_control(f, &o->control, 1);
    dalcs_behavioural_add_table(o->card.builder, f, &o->hertz);
    const struct dalcs_switch_model turns = {
        .name = "turns", .roff = (double)INFINITY, .vt = 0.5, .vh = 0.5};
    const struct dalcs_switch_model follows = {
        .name = "follows", .roff = (double)INFINITY, .vt = 0.5};
    struct dalcs_device *falls = add_gate(o, "falls", at[4], at[1], (int[]){at[0], 0}, &turns);
    const bool is_down = phase >= up;
    const double first = is_down ? (1 - phase) / (1 - up) : phase / up;
    node[0] = at[0];
    node[1] = at[1];
    ok = falls != NULL && add_gate(o, "back", at[2], at[3], (int[]){at[1], 0}, &follows) != NULL &&
         add_load(o, "falls", at[1]) && add_load(o, "back", at[3]) &&
         dalcs_block_add_constant(&o->card, DALCS_VSOURCE, "one", (int[]){at[4], 0}, 1) &&
         add_charge(o, "up", at[0], at[2], 1 / up) &&
         add_charge(o, "down", at[0], at[3], -1 / up - 1 / (1 - up)) && add_hold(o, at[0], first);
    if (ok) {
        falls->initially_on = falls->has_initial_state = is_down;
    }
    return ok;
}

/* offset + gain v(by) */
static void put_line(const struct dalcs_oscillator *o, double offset, double gain, int by) {
    const struct dalcs_block_end *out = &o->out;
    const int lift = offset != 0 ? add_node(o, "lift") : out->reference;
    struct dalcs_device *e = dalcs_block_add(&o->card, DALCS_VCVS, o->what, out->node, lift);
    if (e != NULL && lift >= 0) {
        e->node[2] = by;
        e->value = gain;
        add_output(o, e);
        if (offset != 0) {
            (void)dalcs_block_add_constant(&o->card, DALCS_VSOURCE, "lift",
                                           (int[]){lift, out->reference}, offset);
        }
    }
}

/* The cosine of half a turn times the swing's number. */
static void put_sine(const struct dalcs_oscillator *o, int swing) {
    const int angle = add_node(o, "angle");
    struct dalcs_device *e = dalcs_block_add(&o->card, DALCS_VCVS, "angle", angle, 0);
    if (angle < 0 || e == NULL) {
        return;
    }
    e->node[2] = swing;
    e->value = dalcs_pi;
    const int cosine = dalcs_smooth_add(o->card.builder, o->card.card->token, "cosine",
                                        DALCS_SMOOTH_COS, 1, &angle);
    if (cosine >= 0) {
        put_line(o, 0.5 * (o->low + o->high), 0.5 * (o->high - o->low), cosine);
    }
}

/* A gate that shows a direction. */
static void put_gate(const struct dalcs_oscillator *o, int node) {
    const struct dalcs_block_end *out = &o->out;
    struct dalcs_logic_card *of = dalcs_logic_start(o->card.builder, o->card.card->token, 1);
    if (of == NULL) {
        return;
    }
    of->on = of->off = 0.5;
    of->pin[0] = (struct dalcs_logic_pin){.is_wired = true, .node = node};
    of->node[0] = out->node;
    of->common = out->reference;
    struct dalcs_logic_gate *g = of->gate;
    g->kind = DALCS_GATE_BUFFER;
    g->low = o->low;
    g->high = o->high;
    g->rise = o->rise;
    g->fall = o->fall;
    g->delay[1] = o->rise_delay;
    g->delay[0] = o->fall_delay;
    dalcs_logic_add(o->card.builder, of);
}

static void expand(const struct dalcs_oscillator *o) {
    const double up = o->shape == DALCS_OSCILLATOR_TRIANGLE ? o->duty
                      : o->shape == DALCS_OSCILLATOR_SINE   ? 0.5
                                                            : 1 - o->duty;
    int node[2];
    /* sin(2 pi phase) is the cosine of an angle that is three quarters of a turn ahead */
    const double ahead = o->shape == DALCS_OSCILLATOR_SINE ? 0.75 : 0;
    if (!add_swing(o, up, fmod(o->phase + ahead, 1), node)) {
        return;
    }
    if (o->shape == DALCS_OSCILLATOR_TRIANGLE) {
        put_line(o, o->low, o->high - o->low, node[0]);
    } else if (o->shape == DALCS_OSCILLATOR_SINE) {
        put_sine(o, node[0]);
    } else {
        put_gate(o, node[1]);
    }
}

/* ---- All of them ----------------------------------------------------------------------------------------------------- */

void dalcs_oscillator_add(const struct dalcs_oscillator *o) {
    struct dalcs_builder *builder = o->card.builder;
    struct dalcs_oscillator *waits = dalcs_arena_alloc(&builder->scratch, 1, sizeof *waits);
    if (waits == NULL) {
        builder->out_of_memory = true;
        return;
    }
    *waits = *o;
    waits->before = builder->formulas.oscillator;
    builder->formulas.oscillator = waits;
}

void dalcs_oscillator_put_all(struct dalcs_builder *builder) {
    for (const struct dalcs_oscillator *o = builder->formulas.oscillator; o != NULL;
         o = o->before) {
        double control;
        if (!dalcs_builder_reserve_devices(builder, MOST_DEVICES)) {
            return;
        }
        if (is_constant(o, &control)) {
            (void)add_source(o, dalcs_piecewise_at(&o->hertz, control, 0));
        } else {
            expand(o);
        }
    }
}
