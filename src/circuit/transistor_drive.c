/* transistor_drive.c - what drives each transistor's gate: the resistance that it is on with, and whether it is a
 * switch at all.
 *
 * In its linear region at small voltages a channel has the conductance gain W/L (v - Vto). The gate's high level v is, in
 * this order,
 *     Vgon= of the model;
 *     the largest value of a V source between gate and source, or to ground where V sources or nothing but resistors
 *     hold the source, gate resistors passed over;
 *     10 V, or 5 V above the threshold where that is more.
 * An amplifier is refused where sources alone show that the gate moves without turning it off, or that gate and drain are
 * one node. Where they show that the closed switch would open itself, the channel is the one of channel.c: a follower. */
#include "element_cards.h"
#include "transistor.h"

#include <math.h>

static const double usual_high = 10, least_overdrive = 5; /* V */

/* False when an error was reported. */
static bool is_switch(struct dalcs_builder *builder, const struct dalcs_transistor_use *use,
                      const struct dalcs_gate_drive *drive, double threshold) {
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
    const struct dalcs_gate_range *gate = &drive->gate;
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
    return true;
}

/* ---- Resistances ------------------------------------------------------------------------------------------- */

static const char *ohms(struct dalcs_builder *builder, double value) {
    const char *text = value >= 1 || value == 0
                           ? dalcs_builder_hint(builder, "%.4g ohm", value)
                           : dalcs_builder_hint(builder, "%.4g mohm", 1e3 * value);
    return text != NULL ? text : "";
}

/* A note on how the card is read, once for each resistance that it has. */
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
        const struct dalcs_diode_model *m = &c->models.of_diode[use->diode];
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
                       (t->is_p ? -1 : 1) * c->models.of_switch[d->model].vt,
                       knee != NULL ? knee : "", ohms(builder, ron), at,
                       diode != NULL ? diode : "");
}

/* The gate's level that it is on with, above 0 also of a p channel, and in words. */
static double high_level(struct dalcs_builder *builder, const struct dalcs_transistor_use *use,
                         const struct dalcs_gate_drive *drive, double threshold, const char **at) {
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

/* Not where the voltage of its gate is unknown. */
static void note_saturation(struct dalcs_builder *builder, const struct dalcs_transistor_use *use,
                            double over) {
    struct dalcs_circuit *c = builder->circuit;
    const struct dalcs_transistor *t = use->of;
    const double sign = t->is_p ? -1 : 1;
    c->models.saturation[c->models.n_saturations++] =
        (struct dalcs_saturation){.name = c->device[use->device].name,
                                  .device = builder->elements.current_of[use->device],
                                  .current = sign * 0.5 * t->saturating * use->width / use->length *
                                             over * over * use->parallel,
                                  .level = sign * over + t->threshold,
                                  .where = c->device[use->device].where};
}

static const char follower_hint[] = "drive the gate against the source, or higher than the supply";

/* A switch that would open itself; the source of a MOSFET with a resistance follows its gate. False when an error was
 * reported. */
static bool may_follow(struct dalcs_builder *builder, const struct dalcs_transistor_use *use,
                       const struct dalcs_switch_model *model, double high) {
    const char *name = use->name->text;
    if (use->of->kind != DALCS_MOSFET || !(model->ron > 0)) {
        dalcs_builder_error(builder, use->name, follower_hint,
                            "'%s' is a follower, not a switch: if it were on, its gate would be at "
                            "%g V at most against its source, and it is off below %g V",
                            name, high, model->vt);
        return false;
    }
    const double sign = use->of->is_p ? -1 : 1;
    dalcs_builder_warn(
        builder, use->name, follower_hint,
        "'%s' is a follower, not a switch: its gate is at %g V %s against its drain, "
        "so its source stays %g V %s its gate, besides its resistance",
        name, sign * high, use->of->is_p ? "at least" : "at most", model->vt,
        use->of->is_p ? "above" : "below");
    return true;
}

/* Where both ends of a MOSFET count, a switch that v(gate, source) commands would be wrong. */
static void settle_channel(struct dalcs_builder *builder, const struct dalcs_transistor_use *use,
                           const struct dalcs_switch_model *model,
                           const struct dalcs_gate_drive *drive) {
    const bool follows = drive->is_follower && drive->gate.is_known &&
                         drive->gate.high <= model->vt && use->of->kind != DALCS_BIPOLAR;
    const bool has_bulk = use->bulk != use->source;
    if (has_bulk && !(model->ron > 0)) {
        dalcs_builder_error(builder, use->name, "Ron= of the model is above 0",
                            "the bulk of '%s' is not on its source: its channel needs a resistance",
                            use->name->text);
        return;
    }
    if (has_bulk || (follows && may_follow(builder, use, model, drive->gate.high))) {
        dalcs_transistor_make_channel(builder, use, model->ron, model->roff);
    }
}

static void settle(struct dalcs_builder *builder, const struct dalcs_gate_links *links,
                   const struct dalcs_transistor_use *use) {
    struct dalcs_circuit *c = builder->circuit;
    const struct dalcs_transistor *t = use->of;
    struct dalcs_switch_model *model = &c->models.of_switch[c->device[use->device].model];
    const bool is_bipolar = t->kind == DALCS_BIPOLAR;
    model->vt = is_bipolar ? 0.5 * c->models.of_diode[use->diode].vfwd
                : t->is_p  ? -t->threshold
                           : t->threshold;
    const struct dalcs_gate_drive drive = dalcs_gate_drive_of(c, links, use);
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
    settle_channel(builder, use, model, &drive);
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
    struct dalcs_gate_links links;
    if (builder->models.last_transistor == NULL || builder->out_of_memory ||
        !dalcs_gate_list_links(builder, &links)) {
        return;
    }
    struct dalcs_transistor_use *first = in_order(builder->models.last_transistor);
    size_t n = 0;
    for (const struct dalcs_transistor_use *use = first; use != NULL; use = use->before) {
        n++;
    }
    struct dalcs_circuit *c = builder->circuit;
    dalcs_transistor_settle_typical(builder, &links, first);
    c->models.saturation = dalcs_arena_alloc(&c->arena, n, sizeof *c->models.saturation);
    if (c->models.saturation == NULL) {
        builder->out_of_memory = true;
        return;
    }
    for (const struct dalcs_transistor_use *use = first; use != NULL; use = use->before) {
        settle(builder, &links, use);
    }
}
