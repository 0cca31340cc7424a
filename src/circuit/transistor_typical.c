/* transistor_typical.c - MOSFETs by names that no card and no table has.
 *
 * LTspice's own library has a thousand; netlists that it exports name them and the library, which stays on the machine
 * of the author. What the waveforms of a converter need of such a part is the channel, n or p, and that its gate closes
 * it: the way its gate is driven says both. The resistance is a usual one; a warning says all of it. */
#include "transistor.h"

#include <math.h>

static const double usual_threshold = 3, usual_ron = 50e-3; /* V, ohm */

void dalcs_transistor_make_typical(struct dalcs_transistor *transistor,
                                   const struct dalcs_token *name) {
    transistor->typical = name;
    transistor->threshold = usual_threshold;
    transistor->ron = usual_ron;
}

/* Volts between gate and source that close it, below 0 if that is what a p channel needs; 0: no source says. */
static double closing(const struct dalcs_gate_drive *drive) {
    const struct dalcs_gate_range *gate = &drive->gate;
    if (!drive->is_decided) {
        return 0;
    }
    return gate->high >= -gate->low ? gate->high : gate->low;
}

/* `on` and `off` are the two levels of the gate, with the signs of an n channel. A gate that is turned off at 0 V and on
 * below the usual threshold belongs to a part for such levels; one that never falls below it, to an amplifier. */
static double threshold_of(double on, double off) {
    return on <= usual_threshold && off <= 0 ? 0.5 * on : usual_threshold;
}

/* The other channel, before anything has asked for it. */
static void turn(struct dalcs_circuit *c, const struct dalcs_transistor_use *use) {
    int *node = c->device[use->diode_device].node;
    const int from = node[0];
    node[0] = node[1];
    node[1] = from;
    c->models.of_switch[c->device[use->device].model].is_inverted = true;
}

static void tell(struct dalcs_builder *builder, struct dalcs_transistor *t) {
    const char *name = t->typical->text;
    dalcs_builder_warn(
        builder, t->typical,
        dalcs_builder_hint(builder, "add a line: .model %s %s", name,
                           t->is_p ? "PMOS(Vto=-3 Ron=50m)" : "NMOS(Vto=3 Ron=50m)"),
        "model '%s' is not in the netlist, and '%s' is not here: in its place is %s channel of "
        "%g mohm, on %s v(gs) = %.4g V",
        name, builder->netlist->missing_library, t->is_p ? "a p" : "an n", 1e3 * t->ron,
        t->is_p ? "below" : "above", t->threshold);
}

/* All elements of one model; `first` is the first of them. */
static void settle(struct dalcs_builder *builder, const struct dalcs_gate_links *links,
                   struct dalcs_transistor_use *first) {
    struct dalcs_transistor *t = first->of;
    double on = 0, off = 0; /* of the drive that is known first */
    for (const struct dalcs_transistor_use *use = first; use != NULL && on == 0;
         use = use->before) {
        if (use->of == t) {
            const struct dalcs_gate_drive drive = dalcs_gate_drive_of(builder->circuit, links, use);
            on = closing(&drive);
            off = on > 0 ? drive.gate.low : drive.gate.high;
        }
    }
    t->is_p = on < 0;
    if (on != 0) {
        t->threshold = t->is_p ? -threshold_of(-on, -off) : threshold_of(on, off);
    }
    for (const struct dalcs_transistor_use *use = first; use != NULL && t->is_p;
         use = use->before) {
        if (use->of == t) {
            turn(builder->circuit, use);
        }
    }
    tell(builder, t);
}

void dalcs_transistor_settle_typical(struct dalcs_builder *builder,
                                     const struct dalcs_gate_links *links,
                                     struct dalcs_transistor_use *first) {
    for (struct dalcs_transistor_use *use = first; use != NULL; use = use->before) {
        struct dalcs_transistor *t = use->of;
        if (t->typical != NULL && !t->was_noted) {
            settle(builder, links, use);
            t->was_noted = true; /* the warning says what the note would */
            t->noted_ohms = t->ron;
        }
    }
}
