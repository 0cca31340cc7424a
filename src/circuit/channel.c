/* channel.c - the channel of a MOSFET whose bulk is not on its source, or that is a follower: both of its ends are alike.
 *
 * An end lets through what is below the gate by Vto, so the other one follows the gate:
 *     Ron i = min(v(drain), v(gate) - Vto) - min(v(source), v(gate) - Vto)
 * Where both ends are below that it is a resistor, where both are above it is a cut. A switch that v(gate, source) commands
 * would be neither where the source follows the gate, nor where the card's source is at the supply. Of a p channel the
 * largest counts. */
#include "behavioural.h"
#include "formula_writer.h"
#include "transistor.h"

#include <math.h>

static const struct dalcs_formula *voltage(struct dalcs_formula_writer *w, int node) {
    const struct dalcs_token *name = dalcs_formula_name(
        w->builder, w->element, node == 0 ? "0" : w->builder->elements.node_name[node]);
    return name != NULL ? dalcs_formula_signal(w, DALCS_FORMULA_VOLTAGE, name, NULL) : NULL;
}

/* What an end lets through. */
static const struct dalcs_formula *passed(struct dalcs_formula_writer *w,
                                          const struct dalcs_transistor_use *use, int end) {
    const struct dalcs_formula *side[2] = {
        voltage(w, end), dalcs_formula_operation(w, DALCS_SUBTRACT, voltage(w, use->gate),
                                                 dalcs_formula_number(w, use->of->threshold))};
    return dalcs_formula_call(w, use->of->is_p ? "max" : "min", 2, side);
}

void dalcs_transistor_make_channel(struct dalcs_builder *builder,
                                   const struct dalcs_transistor_use *use, double ron,
                                   double roff) {
    struct dalcs_formula_writer w;
    if (!dalcs_formula_writer_start(&w, builder, use->name)) {
        return;
    }
    const struct dalcs_formula *drop = dalcs_formula_operation(
        &w, DALCS_SUBTRACT, passed(&w, use, use->drain), passed(&w, use, use->source));
    const struct dalcs_formula *current =
        dalcs_formula_operation(&w, DALCS_DIVIDE, drop, dalcs_formula_number(&w, ron));
    if (isfinite(roff)) {
        const struct dalcs_formula *leak = dalcs_formula_operation(
            &w, DALCS_SUBTRACT, voltage(&w, use->drain), voltage(&w, use->source));
        leak = dalcs_formula_operation(&w, DALCS_DIVIDE, leak, dalcs_formula_number(&w, roff));
        current = dalcs_formula_operation(&w, DALCS_ADD, current, leak);
    }
    const struct dalcs_token *formula = current != NULL ? dalcs_formula_token(&w, current) : NULL;
    struct dalcs_device *device = &builder->circuit->device[use->device];
    device->kind = DALCS_VCCS;
    device->value = 1;
    device->model = -1;
    device->is_limit = true;
    dalcs_behavioural_add_formula(builder, device, formula);
}
