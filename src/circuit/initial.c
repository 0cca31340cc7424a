/* initial.c - .ic v(node)=value v(a,b)=value i(inductor)=value.
 *
 * i(l1)=value is the inductor's IC=. Saying two values for one thing is an error, for there is no
 * telling which was meant. */
#include "analysis_cards.h"
#include "reader.h"
#include "storage.h"

#include <string.h>

static const char USAGE[] = ".ic v(node)=volts i(inductor)=amperes ...";

static void add_voltage(struct dalcs_builder *builder, const struct dalcs_token *place,
                        const int *node, double value) {
    if (node[0] == node[1]) {
        if (value != 0) {
            dalcs_builder_error(builder, place, NULL, "this voltage is 0 always");
        }
        return;
    }
    /* v(a,b) and v(b,a) are one voltage. */
    const char *key = node[0] < node[1] ? dalcs_builder_hint(builder, "%d %d", node[0], node[1])
                                        : dalcs_builder_hint(builder, "%d %d", node[1], node[0]);
    const int place_of_new = (int)builder->analyses.n_initial_conditions;
    if (key == NULL) {
        return;
    }
    const int first = dalcs_names_find(&builder->analyses.initial_pairs, key);
    if (first >= 0) {
        const struct dalcs_initial_condition *known = &builder->analyses.initial_condition[first];
        const bool same = known->value == (known->node[0] == node[0] ? value : -value);
        if (!same) {
            dalcs_builder_error(builder, place, NULL,
                                "this voltage has another initial value at line %d",
                                known->where.line);
        }
        return;
    }
    if (dalcs_grow(&builder->analyses.initial_condition,
                   &builder->analyses.initial_condition_capacity,
                   builder->analyses.n_initial_conditions + 1,
                   sizeof *builder->analyses.initial_condition) != DALCS_OK ||
        dalcs_names_add(&builder->analyses.initial_pairs, key, place_of_new) != DALCS_OK) {
        builder->out_of_memory = true;
        return;
    }
    builder->analyses.initial_condition[builder->analyses.n_initial_conditions++] =
        (struct dalcs_initial_condition){
            {node[0], node[1]}, value, dalcs_builder_keep_location(builder, place)};
}

void dalcs_initial_hold(struct dalcs_builder *builder, const struct dalcs_token *place,
                        const int *node, double value) {
    add_voltage(builder, place, node, value);
}

static bool read_value(struct dalcs_reader *reader, enum dalcs_quantity quantity, double *value) {
    dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    return dalcs_reader_number(reader, quantity, "an initial value", value);
}

static bool read_voltage(struct dalcs_reader *reader, const struct dalcs_token *place) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *name[2] = {NULL, NULL};
    if (!dalcs_reader_name(reader, "a node", &name[0])) {
        return false;
    }
    const bool is_pair = !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE);
    if (is_pair && !dalcs_reader_name(reader, "a node", &name[1])) {
        return false;
    }
    if (is_pair && !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        dalcs_reader_missing(reader, "')'");
        return false;
    }
    double value;
    static const char LOST[] = "this initial value is left out";
    int node[2] = {dalcs_builder_find_node_or_warn(builder, name[0], LOST), 0};
    if (is_pair) {
        node[1] = dalcs_builder_find_node_or_warn(builder, name[1], LOST);
    }
    if (!read_value(reader, DALCS_VOLTAGE, &value)) {
        return false;
    }
    if (node[0] >= 0 && node[1] >= 0) {
        add_voltage(builder, place, node, value);
    }
    return true;
}

static bool read_current(struct dalcs_reader *reader, const struct dalcs_token *place) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *name;
    double value;
    if (!dalcs_reader_name(reader, "the name of an inductor", &name)) {
        return false;
    }
    if (!dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        dalcs_reader_missing(reader, "')'");
        return false;
    }
    const int index = dalcs_builder_find_device(builder, name);
    if (!read_value(reader, DALCS_CURRENT, &value)) {
        return false;
    }
    if (index < 0) {
        return true;
    }
    struct dalcs_device *device = &builder->circuit->device[index];
    const bool is_coil = device->kind == DALCS_INDUCTOR ||
                         (dalcs_storage_is(builder, index) && device->letter == 'l');
    if (!is_coil) {
        dalcs_builder_error(builder, name, USAGE, "'%s' is %s: only an inductor keeps a current",
                            name->text, dalcs_builder_kind_text(device->kind));
    } else if (device->has_initial && device->initial != value) {
        dalcs_builder_error(builder, name, NULL, "'%s' has another initial current, %g A",
                            name->text, device->initial);
    }
    device->has_initial = true;
    device->initial = value;
    builder->analyses.initial_state =
        builder->analyses.initial_state != NULL ? builder->analyses.initial_state : place;
    return true;
}

void dalcs_initial_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    const bool is_in_brackets = dalcs_reader_take(&reader, DALCS_TOKEN_OPEN); /* .ic(v(a)=1) */
    while (!dalcs_reader_at_end(&reader)) {
        const struct dalcs_token *next = dalcs_reader_peek(&reader, 1);
        if (is_in_brackets && next == NULL && dalcs_reader_take(&reader, DALCS_TOKEN_CLOSE)) {
            return;
        }
        const struct dalcs_token *place = dalcs_reader_peek(&reader, 0);
        const bool is_voltage = dalcs_reader_take_word(&reader, "v");
        if (!is_voltage && !dalcs_reader_take_word(&reader, "i")) {
            dalcs_reader_missing(&reader, "v(node)");
            return;
        }
        if (!dalcs_reader_take(&reader, DALCS_TOKEN_OPEN)) {
            dalcs_reader_missing(&reader, "'('");
            return;
        }
        if (!(is_voltage ? read_voltage(&reader, place) : read_current(&reader, place))) {
            return;
        }
    }
}

void dalcs_initial_parse_nodeset(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader =
        dalcs_reader_start(builder, card, ".nodeset v(node)=volts v(node)=volts ...");
    double value;
    while (!dalcs_reader_at_end(&reader)) {
        const struct dalcs_token *node;
        if (!dalcs_reader_take_word(&reader, "v")) {
            dalcs_reader_missing(&reader, "v(node)");
            return;
        }
        if (!dalcs_reader_take(&reader, DALCS_TOKEN_OPEN)) {
            dalcs_reader_missing(&reader, "'('");
            return;
        }
        if (!dalcs_reader_name(&reader, "a node", &node)) {
            return;
        }
        if (!dalcs_reader_take(&reader, DALCS_TOKEN_CLOSE)) {
            dalcs_reader_missing(&reader, "')'");
            return;
        }
        (void)dalcs_builder_find_node_or_warn(builder, node, "this value is left out");
        if (!read_value(&reader, DALCS_VOLTAGE, &value)) {
            return;
        }
    }
    dalcs_builder_note(builder, card->token, NULL,
                       ".nodeset has no effect: an operating point is computed without a guess");
}

/* Voltages that .ic names, and integrals, which a .tran begins at their first values. */
static void tell_not_held(struct dalcs_builder *builder) {
    bool told[2] = {false, false};
    for (size_t k = 0; k < builder->analyses.n_initial_conditions; k++) {
        const struct dalcs_initial_condition *ic = &builder->analyses.initial_condition[k];
        const bool is_integral = dalcs_names_is_inner(builder->elements.node_name[ic->node[0]]);
        if (!told[is_integral]) {
            dalcs_diag_add(builder->diag, DALCS_NOTE, &ic->where,
                           is_integral ? "with a .tran it begins at its first value" : NULL, "%s",
                           is_integral ? "without a .tran an integral is at rest: what is "
                                         "integrated is 0, and the circuit decides its value"
                                       : ".ic v(...) counts only for .tran; .op does not hold it");
        }
        told[is_integral] = true;
    }
}

void dalcs_initial_check(struct dalcs_builder *builder) {
    const struct dalcs_transient *transient = &builder->circuit->analyses.transient;
    if ((transient->present && transient->use_initial_conditions) ||
        builder->circuit->analyses.periodic.use_initial_conditions) {
        return;
    }
    if (builder->analyses.initial_state != NULL) {
        dalcs_builder_note(builder, builder->analyses.initial_state,
                           transient->present ? "write 'uic' on .tran to start from it" : NULL,
                           "IC= and .ic i(...) count only with 'uic' on .tran; the states here are "
                           "those of the operating point");
    }
    if (!transient->present) {
        tell_not_held(builder);
    }
}
