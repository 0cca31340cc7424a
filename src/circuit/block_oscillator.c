/* block_oscillator.c - XSPICE's oscillators whose control voltage is their frequency: triangle, square, sine, d_osc.
 *
 * Of a constant control they are sources of time. Else a number between 0 and 1 goes up and down as a triangle does: a
 * capacitor that a source charges, whose direction a switch with a hysteresis turns where it arrives. So the phase has
 * no end that it could grow to, its error stays one of a single number below 1, and each turn is an event. A square is
 * its direction, a sine of the phase is the cosine of half a turn times that number, which is smooth where it turns.
 * Until t = 0 a switch holds it at its first phase: the operating point, and small signals around it, see no oscillation. */
#include "block_parts.h"
#include "logic_parts.h"

#include <math.h>
#include <string.h>

struct dalcs_oscillator {
    const struct dalcs_oscillator *before;
    struct dalcs_block_card card;
};

enum shape { TRIANGLE, SQUARE, SINE, DIGITAL };

struct oscillator {
    const struct dalcs_block_card *c;
    enum shape shape;
    double low, high;
    double duty;                   /* of the period: that a triangle rises, that a square is high */
    double phase;                  /* of the period, at the start */
    struct dalcs_piecewise hertz;  /* of the control, never below 0 */
    double rise, fall;             /* s */
    double rise_delay, fall_delay; /* s */
};

static const double pi = 3.14159265358979323846;

/* ---- The model -------------------------------------------------------------------------------------------------- */

/* The table goes on beyond its ends, down to 0. */
static bool read_hertz(struct oscillator *o) {
    const struct dalcs_block_card *c = o->c;
    struct dalcs_piecewise given;
    if (!dalcs_block_read_table(c, "cntl_array", "freq_array", &given)) {
        return false;
    }
    struct dalcs_piecewise *f = &o->hertz;
    *f = dalcs_block_make_table(c, given.n + 2);
    if (f->knot == NULL) {
        return false;
    }
    f->n = 0;
    for (int k = 0; k < given.n; k++) {
        if (given.knot[k].value < 0) {
            dalcs_builder_error(c->builder, dalcs_block_find(c->block, "freq_array")->name, NULL,
                                "a frequency cannot be negative");
            return false;
        }
    }
    const struct dalcs_knot *first = &given.knot[0];
    const struct dalcs_knot *last = &given.knot[given.n - 1];
    f->before = given.before > 0 ? 0 : given.before;
    f->after = given.after < 0 ? 0 : given.after;
    if (given.before > 0 && first->value > 0) {
        dalcs_block_set_knot(f, f->n++, first->at - first->value / given.before, 0);
    }
    for (int k = 0; k < given.n; k++) {
        f->knot[f->n++] = given.knot[k];
    }
    if (given.after < 0 && last->value > 0) {
        dalcs_block_set_knot(f, f->n++, last->at - last->value / given.after, 0);
    }
    return true;
}

static bool read_model(struct oscillator *o) {
    static const char *const names[] = {"cntl_array", "freq_array", "out_low",  "out_high",
                                        "duty_cycle", "rise_time",  "fall_time"};
    static const char *const digital[] = {"cntl_array", "freq_array", "duty_cycle",
                                          "init_phase", "rise_delay", "fall_delay"};
    static const int n_names[] = {5, 7, 4};
    static const char usage[] = "an oscillator is: Aname control out model";
    const struct dalcs_block *block = o->c->block;
    const bool is_digital = o->shape == DIGITAL;
    if (!dalcs_block_check(o->c, is_digital ? digital : names,
                           is_digital ? 6 : (size_t)n_names[o->shape], 2, usage) ||
        !read_hertz(o)) {
        return false;
    }
    o->low = dalcs_block_number(block, "out_low", is_digital ? 0 : -1);
    o->high = dalcs_block_number(block, "out_high", 1);
    o->duty = dalcs_block_number(block, "duty_cycle", 0.5);
    o->rise = is_digital ? 0 : dalcs_block_number(block, "rise_time", 1e-9);
    o->fall = is_digital ? 0 : dalcs_block_number(block, "fall_time", 1e-9);
    o->rise_delay = is_digital ? dalcs_block_number(block, "rise_delay", 1e-9) : 0;
    o->fall_delay = is_digital ? dalcs_block_number(block, "fall_delay", 1e-9) : 0;
    const double turns = dalcs_block_number(block, "init_phase", 0) / 360;
    o->phase = turns - floor(turns);
    const char *wrong = !(o->low < o->high)             ? "out_low must be below out_high"
                        : !(o->duty > 0 && o->duty < 1) ? "duty_cycle is above 0 and below 1"
                        : o->rise < 0 || o->fall < 0 || o->rise_delay < 0 || o->fall_delay < 0
                            ? "times and delays cannot be negative"
                            : NULL;
    if (wrong != NULL) {
        dalcs_builder_error(o->c->builder, block->type, NULL, "%s", wrong);
    }
    return wrong == NULL;
}

/* ---- A constant control ------------------------------------------------------------------------------------------ */

/* Is the control ground, or a V source of a number to ground? LTspice's `startup` lets that rise. */
static bool is_constant(const struct oscillator *o, double *value) {
    const struct dalcs_builder *builder = o->c->builder;
    const struct dalcs_circuit *circuit = builder->circuit;
    const struct dalcs_block_end *control = &o->c->port[0].end[0];
    *value = 0;
    if (control->node == control->reference) {
        return true;
    }
    for (int k = 0; k < circuit->n_devices && builder->startup == NULL; k++) {
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
static void set_pulse(const struct oscillator *o, double hertz, struct dalcs_stimulus *s) {
    const double high = o->duty / hertz;
    const double low = (1 - o->duty) / hertz;
    const bool is_turned = o->phase >= 1 - o->duty;
    s->kind = DALCS_STIMULUS_PULSE;
    s->u.pulse.low = is_turned ? o->high : o->low;
    s->u.pulse.high = is_turned ? o->low : o->high;
    s->u.pulse.period = 1 / hertz;
    if (o->shape == TRIANGLE) {
        s->u.pulse.rise = high;
        s->u.pulse.fall = low;
    } else if (o->shape == SQUARE) {
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

static bool add_source(const struct oscillator *o, double hertz) {
    const struct dalcs_block_card *c = o->c;
    const struct dalcs_block_end *out = &c->port[1].end[0];
    struct dalcs_stimulus s = {.kind = DALCS_STIMULUS_DC,
                               .has_dc = true,
                               .dc = o->shape == SINE          ? 0.5 * (o->low + o->high)
                                     : o->phase >= 1 - o->duty ? o->high
                                                               : o->low};
    if (hertz > 0 && o->shape == SINE) {
        s = (struct dalcs_stimulus){.kind = DALCS_STIMULUS_SIN};
        s.u.sine.offset = 0.5 * (o->low + o->high);
        s.u.sine.amplitude = 0.5 * (o->high - o->low);
        s.u.sine.frequency = hertz;
    } else if (hertz > 0) {
        s = (struct dalcs_stimulus){0};
        set_pulse(o, hertz, &s);
        if (s.u.pulse.width < 0) {
            dalcs_builder_error(
                c->builder, c->block->type, NULL, "%s is longer than a pulse at %g Hz",
                o->shape == SQUARE ? "rise_time" : "the difference of delays", hertz);
            return false;
        }
    }
    struct dalcs_device *v = dalcs_block_add(c, DALCS_VSOURCE, NULL, out->node, out->reference);
    if (v != NULL) {
        dalcs_block_add_stimulus(c, v, &s);
    }
    return v != NULL;
}

/* ---- A control that varies --------------------------------------------------------------------------------------- */

static int add_node(const struct oscillator *o, const char *what) {
    return dalcs_builder_inner_node(o->c->builder, what, o->c->card->token);
}

/* From a node to another one, which a resistor holds at 0 V while it is open. */
static struct dalcs_device *add_gate(const struct oscillator *o, const char *what, int from, int to,
                                     const int *control, const struct dalcs_switch_model *model) {
    struct dalcs_device *s = dalcs_block_add(o->c, DALCS_SWITCH, what, from, to);
    const int index = dalcs_switch_add_model(o->c->builder, model);
    if (s == NULL || index < 0) {
        return NULL;
    }
    s->node[2] = control[0];
    s->node[3] = control[1];
    s->model = index;
    return s;
}

static bool add_load(const struct oscillator *o, const char *what, int node) {
    struct dalcs_device *r = dalcs_block_add(o->c, DALCS_RESISTOR, what, node, 0);
    if (r != NULL) {
        r->value = 1;
    }
    return r != NULL;
}

static bool add_charge(const struct oscillator *o, const char *what, int state, int by,
                       double rate) {
    struct dalcs_device *g = dalcs_block_add(o->c, DALCS_VCCS, what, 0, state);
    if (g != NULL) {
        g->node[2] = by;
        g->value = dalcs_charging * rate;
    }
    return g != NULL;
}

/* Until t = 0 at `first`. */
static bool add_hold(const struct oscillator *o, int state, double first) {
    const int level = add_node(o, "first");
    const int hold = add_node(o, "hold");
    const struct dalcs_switch_model model = {.name = "hold", .roff = (double)INFINITY, .vt = 0.5};
    struct dalcs_stimulus s = {.kind = DALCS_STIMULUS_PULSE};
    s.u.pulse.low = 1;
    s.u.pulse.width = s.u.pulse.period = (double)INFINITY;
    struct dalcs_device *v = dalcs_block_add(o->c, DALCS_VSOURCE, "hold", hold, 0);
    struct dalcs_device *c = dalcs_block_add(o->c, DALCS_CAPACITOR, "state", state, 0);
    if (level < 0 || hold < 0 || v == NULL || c == NULL ||
        !dalcs_block_add_constant(o->c, DALCS_VSOURCE, "first", (int[]){level, 0}, first) ||
        add_gate(o, "hold", state, level, (int[]){hold, 0}, &model) == NULL) {
        return false;
    }
    dalcs_block_add_stimulus(o->c, v, &s);
    c->value = dalcs_charging;
    c->initial = first;
    c->has_initial = true;
    return true;
}

/* The number that goes up for `up` of each period, and down, at node[0], and at node[1] 1 while it goes down. */
static bool add_swing(const struct oscillator *o, double up, double phase, int *node) {
    static const char *const names[] = {"state", "falls", "hertz", "back", "one"};
    int at[5];
    bool ok = true;
    for (int k = 0; k < 5; k++) {
        at[k] = add_node(o, names[k]);
        ok = ok && at[k] >= 0;
    }
    struct dalcs_device *f = dalcs_block_add(o->c, DALCS_VCVS, "hertz", at[2], 0);
    if (!ok || f == NULL) {
        return false;
    }
    dalcs_block_control(f, &o->c->port[0].end[0], 1);
    dalcs_behavioural_add_table(o->c->builder, f, &o->hertz);
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
         dalcs_block_add_constant(o->c, DALCS_VSOURCE, "one", (int[]){at[4], 0}, 1) &&
         add_charge(o, "up", at[0], at[2], 1 / up) &&
         add_charge(o, "down", at[0], at[3], -1 / up - 1 / (1 - up)) && add_hold(o, at[0], first);
    if (ok) {
        falls->initially_on = falls->has_initial_state = is_down;
    }
    return ok;
}

/* offset + gain v(by) */
static void put_line(const struct oscillator *o, double offset, double gain, int by) {
    const struct dalcs_block_end *out = &o->c->port[1].end[0];
    const int lift = offset != 0 ? add_node(o, "lift") : out->reference;
    struct dalcs_device *e = dalcs_block_add(o->c, DALCS_VCVS, NULL, out->node, lift);
    if (e != NULL && lift >= 0) {
        e->node[2] = by;
        e->value = gain;
        if (offset != 0) {
            (void)dalcs_block_add_constant(o->c, DALCS_VSOURCE, "lift",
                                           (int[]){lift, out->reference}, offset);
        }
    }
}

/* The cosine of half a turn times the swing's number. */
static void put_sine(const struct oscillator *o, int swing) {
    const int angle = add_node(o, "angle");
    struct dalcs_device *e = dalcs_block_add(o->c, DALCS_VCVS, "angle", angle, 0);
    if (angle < 0 || e == NULL) {
        return;
    }
    e->node[2] = swing;
    e->value = pi;
    const int cosine =
        dalcs_smooth_add(o->c->builder, o->c->card->token, "cosine", DALCS_SMOOTH_COS, 1, &angle);
    if (cosine >= 0) {
        put_line(o, 0.5 * (o->low + o->high), 0.5 * (o->high - o->low), cosine);
    }
}

/* A gate that shows a direction. */
static void put_gate(const struct oscillator *o, int node) {
    const struct dalcs_block_end *out = &o->c->port[1].end[0];
    struct dalcs_logic_card *of = dalcs_logic_start(o->c->builder, o->c->card->token, 1);
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
    dalcs_logic_add(o->c->builder, of);
}

static void expand(const struct oscillator *o) {
    const double up = o->shape == TRIANGLE ? o->duty : o->shape == SINE ? 0.5 : 1 - o->duty;
    int node[2];
    /* sin(2 pi phase) is the cosine of an angle that is three quarters of a turn ahead */
    if (!add_swing(o, up, o->shape == SINE ? 0.75 : o->phase, node)) {
        return;
    }
    if (o->shape == TRIANGLE) {
        put_line(o, o->low, o->high - o->low, node[0]);
    } else if (o->shape == SINE) {
        put_sine(o, node[0]);
    } else {
        put_gate(o, node[1]);
    }
}

/* ---- Cards --------------------------------------------------------------------------------------------------------- */

bool dalcs_block_parse_oscillator(const struct dalcs_block_card *c) {
    static const char *const types[] = {"triangle", "square", "sine", "d_osc"};
    if (!dalcs_builder_is_one_of(c->block->type->text, types, 4)) {
        return false;
    }
    struct dalcs_oscillator *waits = dalcs_arena_alloc(&c->builder->scratch, 1, sizeof *waits);
    if (waits == NULL) {
        c->builder->out_of_memory = true;
        return true;
    }
    *waits = (struct dalcs_oscillator){.before = c->builder->oscillator, .card = *c};
    c->builder->oscillator = waits;
    return true;
}

static void read(const struct dalcs_block_card *c) {
    static const char *const types[] = {"triangle", "square", "sine", "d_osc"};
    struct oscillator o = {.c = c};
    while (strcmp(c->block->type->text, types[o.shape]) != 0) {
        o.shape++;
    }
    double control;
    if (!read_model(&o)) {
        c->builder->hidden |= DALCS_HIDDEN_ELEMENTS;
    } else if (is_constant(&o, &control)) {
        (void)add_source(&o, dalcs_piecewise_at(&o.hertz, control, 0));
    } else {
        expand(&o);
    }
}

void dalcs_block_read_oscillators(struct dalcs_builder *builder) {
    for (const struct dalcs_oscillator *o = builder->oscillator; o != NULL; o = o->before) {
        read(&o->card);
    }
}
