/* transistor_drive.c - what drives each transistor's gate: the resistance that it is on with, and whether it is a
 * switch at all.
 *
 * In its linear region at small voltages a channel has the conductance gain W/L (v - Vto). The gate's high level v is, in
 * this order,
 *     Vgon= of the model;
 *     the largest value of a V source between gate and source, or to ground where V sources or nothing but resistors
 *     hold the source, gate resistors passed over;
 *     10 V, or 5 V above the threshold where that is more.
 * An amplifier is refused where sources alone show that the gate moves without turning it off, that the closed switch
 * would open itself (a follower), or that gate and drain are one node. */
#include "transistor.h"

#include <math.h>

/* V between two nodes. */
struct range {
    bool is_known;
    double low, high;
};

/* Resistors and V sources by their nodes. */
struct links {
    int *first;     /* [n_nodes] 2 device + end + 1, 0: none */
    int (*next)[2]; /* [n_devices] */
};

static const double usual_high = 10, least_overdrive = 5; /* V */

enum { MOST_HOPS = 16 }; /* nodes that resistors lead to */

static bool list_links(struct dalcs_builder *builder, struct links *links) {
    const struct dalcs_circuit *c = builder->circuit;
    links->first = dalcs_arena_alloc(&builder->scratch, (size_t)c->n_nodes, sizeof *links->first);
    links->next = dalcs_arena_alloc(&builder->scratch, (size_t)c->n_devices, sizeof *links->next);
    if (links->first == NULL || links->next == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    for (int i = c->n_devices - 1; i >= 0; i--) {
        const struct dalcs_device *d = &c->device[i];
        for (int e = 0; e < 2 && (d->kind == DALCS_VSOURCE || d->kind == DALCS_RESISTOR); e++) {
            links->next[i][e] = links->first[d->node[e]];
            links->first[d->node[e]] = 2 * i + e + 1;
        }
    }
    return true;
}

/* ---- Voltages that sources decide -------------------------------------------------------------------- */

static struct range between(double a, double b) {
    return (struct range){true, fmin(a, b), fmax(a, b)};
}

static struct range range_of(const struct dalcs_stimulus *s) {
    struct range r = {0};
    switch (s->kind) {
    case DALCS_STIMULUS_DC:
        return between(s->dc, s->dc);
    case DALCS_STIMULUS_PULSE:
        return between(s->u.pulse.low, s->u.pulse.high);
    case DALCS_STIMULUS_SIN:
        return between(s->u.sine.offset - s->u.sine.amplitude,
                       s->u.sine.offset + s->u.sine.amplitude);
    case DALCS_STIMULUS_EXP:
        return between(s->u.exponential.low, s->u.exponential.high);
    case DALCS_STIMULUS_PWL:
        r = between(s->u.pwl.v[0], s->u.pwl.v[0]);
        for (int k = 1; k < s->u.pwl.n; k++) {
            r.low = fmin(r.low, s->u.pwl.v[k]);
            r.high = fmax(r.high, s->u.pwl.v[k]);
        }
        return r;
    default:
        return r;
    }
}

static struct range minus(const struct range *a, const struct range *b) {
    return (struct range){a->is_known && b->is_known, a->low - b->high, a->high - b->low};
}

/* Of the V source that an end of a device is; from there to its other end. */
static struct range across(const struct dalcs_circuit *c, const struct dalcs_device *d, int end) {
    const struct range r = range_of(&c->stimulus[d->stimulus]);
    return end == 0 ? r : (struct range){r.is_known, -r.high, -r.low};
}

/* v(node) against `reference` where a V source joins them; with_resistors: or one behind resistors. */
static struct range voltage(const struct dalcs_circuit *c, const struct links *links, int node,
                            int reference, bool with_resistors) {
    int seen[MOST_HOPS] = {node};
    int n = 1;
    for (int k = 0; k < n; k++) {
        if (seen[k] == reference) {
            return between(0, 0);
        }
        for (int at = links->first[seen[k]]; at != 0;
             at = links->next[(at - 1) / 2][(at - 1) % 2]) {
            const struct dalcs_device *d = &c->device[(at - 1) / 2];
            const int end = (at - 1) % 2;
            if (d->kind == DALCS_VSOURCE && d->node[1 - end] == reference) {
                return across(c, d, end);
            }
        }
        for (int at = links->first[seen[k]]; at != 0 && with_resistors;
             at = links->next[(at - 1) / 2][(at - 1) % 2]) {
            const struct dalcs_device *d = &c->device[(at - 1) / 2];
            const int other = d->node[1 - (at - 1) % 2];
            bool is_new = d->kind == DALCS_RESISTOR && other != reference && n < MOST_HOPS;
            for (int i = 0; i < n; i++) {
                is_new = is_new && seen[i] != other;
            }
            if (is_new) {
                seen[n++] = other;
            }
        }
    }
    return (struct range){0};
}

/* Do resistors alone lead to ground? */
static bool is_grounded(const struct dalcs_circuit *c, const struct links *links, int node) {
    for (int at = links->first[node]; at != 0; at = links->next[(at - 1) / 2][(at - 1) % 2]) {
        const struct dalcs_device *d = &c->device[(at - 1) / 2];
        if (d->kind == DALCS_RESISTOR && d->node[1 - (at - 1) % 2] == 0) {
            return true;
        }
    }
    return false;
}

/* ---- Drives ------------------------------------------------------------------------------------------------ */

struct drive {
    struct range gate; /* v(gate, source), its sign turned for a p channel */
    bool is_follower;  /* `gate` is against the drain, where the source is when it is on */
    bool is_decided;   /* sources alone say what it is at all times */
};

static struct range turned(const struct range *r, bool is_p) {
    return is_p ? (struct range){r->is_known, -r->high, -r->low} : *r;
}

static struct drive drive_of(const struct dalcs_circuit *c, const struct links *links,
                             const struct dalcs_transistor_use *use) {
    const bool is_p = use->of->is_p;
    struct range gate = voltage(c, links, use->gate, use->source, true);
    if (gate.is_known) {
        return (struct drive){.gate = turned(&gate, is_p), .is_decided = true};
    }
    gate = voltage(c, links, use->gate, 0, true);
    const struct range source = voltage(c, links, use->source, 0, false);
    if (source.is_known) {
        gate = minus(&gate, &source);
        return (struct drive){.gate = turned(&gate, is_p), .is_decided = gate.is_known};
    }
    const struct range drain = voltage(c, links, use->drain, 0, false);
    if (gate.is_known && drain.is_known) {
        gate = minus(&gate, &drain);
        return (struct drive){.gate = turned(&gate, is_p), .is_follower = true};
    }
    gate.is_known = gate.is_known && is_grounded(c, links, use->source);
    return (struct drive){.gate = turned(&gate, is_p)};
}

/* False when an error was reported. */
static bool is_switch(struct dalcs_builder *builder, const struct dalcs_transistor_use *use,
                      const struct drive *drive, double threshold) {
    static const char hint[] =
        "dalcs has transistors as switches: give the gate a drive that turns it on and off";
    const bool is_mosfet = use->of->kind == DALCS_MOSFET;
    const char *name = use->name->text;
    if (use->gate == use->drain && is_mosfet) {
        dalcs_builder_error(builder, use->name, "write a diode D, or a voltage source",
                            "the gate of '%s' is connected to its drain: it works in its linear "
                            "region, not as a switch",
                            name);
        return false;
    }
    const struct range *gate = &drive->gate;
    if (!gate->is_known || use->of->kind == DALCS_BIPOLAR) {
        return true;
    }
    if (drive->is_decided && gate->low > threshold && gate->high > gate->low) {
        dalcs_builder_error(builder, use->name, hint,
                            "the gate of '%s' moves from %g to %g V and never turns it off, below "
                            "%g V: it is an amplifier, not a switch",
                            name, gate->low, gate->high, threshold);
        return false;
    }
    if (drive->is_follower && gate->high <= threshold) {
        dalcs_builder_error(
            builder, use->name, "drive the gate against the source, or higher than the supply",
            "'%s' is a follower, not a switch: if it were on, its gate would be at %g V "
            "at most against its source, and it is off below %g V",
            name, gate->high, threshold);
        return false;
    }
    return true;
}

/* ---- Resistances ------------------------------------------------------------------------------------------- */

static const char *ohms(struct dalcs_builder *builder, double value) {
    const char *text = value >= 1 || value == 0
                           ? dalcs_builder_hint(builder, "%.4g ohm", value)
                           : dalcs_builder_hint(builder, "%.4g mohm", 1e3 * value);
    return text != NULL ? text : "";
}

/* What the card means here, once for each resistance that it has. */
static void note(struct dalcs_builder *builder, const struct dalcs_transistor_use *use, double ron,
                 const char *at) {
    struct dalcs_transistor *t = use->of;
    if (t->was_noted && t->noted_ohms == ron) {
        return;
    }
    t->was_noted = true;
    t->noted_ohms = ron;
    const struct dalcs_circuit *c = builder->circuit;
    const struct dalcs_device *d = &c->device[use->device];
    const char *diode = ", no diode across it";
    if (use->diode >= 0) {
        const struct dalcs_diode_model *m = &c->diode_model[use->diode];
        diode = dalcs_builder_hint(builder, ", %s %.3g V + %s",
                                   t->kind == DALCS_BIPOLAR ? "base to emitter"
                                   : t->kind == DALCS_IGBT  ? "diode"
                                                            : "body diode",
                                   m->vfwd, ohms(builder, m->ron));
    }
    const char *knee =
        t->kind == DALCS_IGBT ? dalcs_builder_hint(builder, "%.3g V + ", t->knee) : "";
    dalcs_builder_note(builder, use->name, NULL,
                       "%s: %s is a switch, on %s v(%s) = %.4g V with %s%s%s%s; its capacitances "
                       "and charges are ignored",
                       use->name->text, t->name, t->is_p ? "below" : "above",
                       t->kind == DALCS_BIPOLAR ? "be"
                       : t->kind == DALCS_IGBT  ? "ge"
                                                : "gs",
                       (t->is_p ? -1 : 1) * c->switch_model[d->model].vt, knee != NULL ? knee : "",
                       ohms(builder, ron), at, diode != NULL ? diode : "");
}

/* The gate's level that it is on with, above 0 also of a p channel, and in words. */
static double high_level(struct dalcs_builder *builder, const struct dalcs_transistor_use *use,
                         const struct drive *drive, double threshold, const char **at) {
    const struct dalcs_transistor *t = use->of;
    const double sign = t->is_p ? -1 : 1;
    if (t->high != 0) {
        *at = dalcs_builder_hint(builder, " at %g V", t->high);
        return sign * t->high;
    }
    if (drive->gate.is_known && drive->gate.high > threshold) {
        *at = dalcs_builder_hint(builder, " at %g V", sign * drive->gate.high);
        return drive->gate.high;
    }
    const double high = fmax(usual_high, threshold + least_overdrive);
    *at = dalcs_builder_hint(
        builder,
        " at %g V, since no source gives the voltage that turns it on (Vgon= of the model does)",
        sign * high);
    return high;
}

/* Not where nobody says what its gate is at. */
static void note_saturation(struct dalcs_builder *builder, const struct dalcs_transistor_use *use,
                            double over) {
    struct dalcs_circuit *c = builder->circuit;
    const struct dalcs_transistor *t = use->of;
    const double sign = t->is_p ? -1 : 1;
    c->saturation[c->n_saturations++] =
        (struct dalcs_saturation){.name = c->device[use->device].name,
                                  .device = builder->current_of[use->device],
                                  .current = sign * 0.5 * t->saturating * use->width / use->length *
                                             over * over * use->parallel,
                                  .level = sign * over + t->threshold,
                                  .where = c->device[use->device].where};
}

static void settle(struct dalcs_builder *builder, const struct links *links,
                   const struct dalcs_transistor_use *use) {
    struct dalcs_circuit *c = builder->circuit;
    const struct dalcs_transistor *t = use->of;
    struct dalcs_switch_model *model = &c->switch_model[c->device[use->device].model];
    const bool is_bipolar = t->kind == DALCS_BIPOLAR;
    model->vt = is_bipolar ? 0.5 * c->diode_model[use->diode].vfwd
                : t->is_p  ? -t->threshold
                           : t->threshold;
    const struct drive drive = drive_of(c, links, use);
    if (!is_switch(builder, use, &drive, model->vt)) {
        return;
    }
    const char *at = "";
    double channel = t->ron;
    if (t->gain > 0 && !is_bipolar) {
        const double high = high_level(builder, use, &drive, model->vt, &at);
        if (!(high > model->vt)) {
            dalcs_builder_error(builder, use->name, "Vgon= is the gate's voltage when it is on",
                                "%s of '%s' does not turn it on", "Vgon=", t->name);
            return;
        }
        channel = 1 / (t->gain * use->width / use->length * (high - model->vt));
        const bool is_known = t->high != 0 || (drive.gate.is_known && drive.gate.high > model->vt);
        if (t->saturating > 0 && is_known) {
            note_saturation(builder, use, high - model->vt);
        }
    } else if (t->high != 0) {
        at = dalcs_builder_hint(builder, " at %g V", t->high);
    }
    if (drive.is_decided && drive.gate.low < drive.gate.high && drive.gate.high <= model->vt &&
        !is_bipolar) { /* one that rests is meant to be off */
        dalcs_builder_warn(builder, use->name, NULL,
                           "the gate of '%s' is never above %g V, and it is off below %g V",
                           use->name->text, drive.gate.high, model->vt);
    }
    model->ron = (channel + t->series) / use->parallel;
    model->roff = t->leakage / use->parallel;
    note(builder, use, model->ron, at != NULL ? at : "");
}

/* From the last one to the first. */
static struct dalcs_transistor_use *in_order(struct dalcs_transistor_use *last) {
    struct dalcs_transistor_use *behind = NULL;
    while (last != NULL) {
        struct dalcs_transistor_use *before = last->before;
        last->before = behind;
        behind = last;
        last = before;
    }
    return behind;
}

void dalcs_transistor_resolve(struct dalcs_builder *builder) {
    struct links links;
    if (builder->transistor == NULL || builder->out_of_memory || !list_links(builder, &links)) {
        return;
    }
    struct dalcs_transistor_use *first = in_order(builder->transistor);
    size_t n = 0;
    for (const struct dalcs_transistor_use *use = first; use != NULL; use = use->before) {
        n++;
    }
    struct dalcs_circuit *c = builder->circuit;
    c->saturation = dalcs_arena_alloc(&c->arena, n, sizeof *c->saturation);
    if (c->saturation == NULL) {
        builder->out_of_memory = true;
        return;
    }
    for (const struct dalcs_transistor_use *use = first; use != NULL; use = use->before) {
        settle(builder, &links, use);
    }
}
