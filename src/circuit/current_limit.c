/* current_limit.c - Ilimit= and revIlimit= of a V, and what a diode's model limits.
 *
 * A current source with an ideal diode across it, in series, carries at most its current:
 *     0 <= limit - i  _|_  v >= 0
 * with v the voltage that it takes. One for each direction, on nodes that no card can name, and an element
 * without a voltage of its own carries any current between the limits without a voltage, and at a limit any
 * voltage of its sign. That is a multiplier i in the box [-reverse, forward] with the voltage in the box's normal
 * cone (V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems, 2008, sec. 2.5: relays,
 * Coulomb's friction), written as two complementarity pairs, whose mode is the answer's: were one diode to block
 * with the other, the current would have both limits, so one conducts at all times. */

#include "element_cards.h"
#include "model_cards.h"
#include "reader.h"

#include <math.h>
#include <string.h>

int dalcs_diode_ideal_model(struct dalcs_builder *builder) {
    if (builder->models.ideal_diode < 0) {
        struct dalcs_circuit *circuit = builder->circuit;
        builder->models.ideal_diode = circuit->models.n_diodes++;
        circuit->models.of_diode[builder->models.ideal_diode] = (struct dalcs_diode_model){
            .name = "ideal", .roff = (double)INFINITY, .vrev = (double)INFINITY};
    }
    return builder->models.ideal_diode;
}

/* Limits the current from `from` to `to` to `limit`. */
static void add_limit(struct dalcs_builder *builder, const struct dalcs_token *name,
                      const char *const *what, double limit, int from, int to) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_device *source =
        dalcs_builder_add_inner_device(builder, DALCS_ISOURCE, what[0], name);
    struct dalcs_device *bypass =
        dalcs_builder_add_inner_device(builder, DALCS_DIODE, what[1], name);
    if (source == NULL || bypass == NULL) {
        return;
    }
    source->node[0] = bypass->node[1] = from;
    source->node[1] = bypass->node[0] = to;
    source->is_limit = true;
    source->stimulus = circuit->n_stimuli++;
    circuit->stimulus[source->stimulus] =
        (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC, .has_dc = true, .dc = limit};
    bypass->model = dalcs_diode_ideal_model(builder);
}

void dalcs_current_limit_expand(struct dalcs_builder *builder, const struct dalcs_token *name,
                                struct dalcs_device *device,
                                const struct dalcs_current_limits *limits) {
    static const char *const forward[2] = {"ilimit", "below_ilimit"};
    static const char *const reverse[2] = {"revilimit", "below_revilimit"};
    if (isfinite(limits->forward)) {
        const int node = dalcs_builder_inner_node(builder, "before_ilimit", name);
        if (node < 0) {
            return;
        }
        add_limit(builder, name, forward, limits->forward, node, device->node[1]);
        device->node[1] = node;
    }
    if (isfinite(limits->reverse)) {
        const int node = dalcs_builder_inner_node(builder, "before_revilimit", name);
        if (node < 0) {
            return;
        }
        add_limit(builder, name, reverse, limits->reverse, device->node[1], node);
        device->node[1] = node;
    }
}

void dalcs_current_limit_make_load(struct dalcs_builder *builder, const struct dalcs_token *name,
                                   struct dalcs_device *device) {
    const int node = dalcs_builder_inner_node(builder, "inside", name);
    struct dalcs_device *valve = dalcs_builder_add_inner_device(builder, DALCS_DIODE, "load", name);
    struct dalcs_device *bypass =
        dalcs_builder_add_inner_device(builder, DALCS_DIODE, "bypass", name);
    if (node < 0 || valve == NULL || bypass == NULL) {
        return;
    }
    valve->node[0] = device->node[0];
    valve->node[1] = bypass->node[1] = node;
    bypass->node[0] = device->node[1];
    valve->model = bypass->model = dalcs_diode_ideal_model(builder);
    device->node[0] = node;
    builder->elements.current_of[device - builder->circuit->device] =
        (int)(valve - builder->circuit->device);
}

static double *limit_of(struct dalcs_current_limits *limits, const char *name) {
    return strcmp(name, "ilimit") == 0      ? &limits->forward
           : strcmp(name, "revilimit") == 0 ? &limits->reverse
                                            : NULL;
}

bool dalcs_current_limit_is_name(const char *name) {
    struct dalcs_current_limits limits;
    return limit_of(&limits, name) != NULL;
}

bool dalcs_current_limit_read(struct dalcs_reader *reader, const struct dalcs_token *name,
                              struct dalcs_current_limits *limits) {
    double *limit = limit_of(limits, name->text);
    if (isfinite(*limit)) {
        dalcs_builder_error(reader->builder, name, NULL, "'%s' is given twice", name->text);
        return false;
    }
    if (!dalcs_reader_number(reader, DALCS_CURRENT, "a current", limit)) {
        return false;
    }
    if (*limit <= 0) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader),
                            "leave it out for none, and the source for no current",
                            "'%s' must be positive", name->text);
        return false;
    }
    return true;
}

int dalcs_current_limit_count(const struct dalcs_card *card) {
    int n = 0;
    for (int k = 2; k < card->n; k++) {
        n += card->token[k].kind == DALCS_TOKEN_EQUAL &&
             dalcs_current_limit_is_name(card->token[k - 1].text);
    }
    return n > 0 ? 2 : 0;
}
