/* controlled.c - linear controlled sources: E and G by a voltage, F and H by the current of a V. */
#include "builder.h"

static bool is_voltage_controlled(enum dalcs_device_kind kind) {
    return kind == DALCS_VCVS || kind == DALCS_VCCS;
}

static const char *usage_of(enum dalcs_device_kind kind) {
    switch (kind) {
    case DALCS_VCVS:
        return "a voltage controlled voltage source is: Ename node node control control gain";
    case DALCS_VCCS:
        return "a voltage controlled current source is: Gname node node control control siemens";
    case DALCS_CCCS:
        return "a current controlled current source is: Fname node node Vsource gain";
    default:
        return "a current controlled voltage source is: Hname node node Vsource ohms";
    }
}

/* POLY, VALUE=, TABLE and their like stand where the control should be. */
static bool is_nonlinear(struct dalcs_reader *reader) {
    static const char *const forms[] = {"poly", "value", "table", "laplace",
                                        "freq", "vol",   "cur",   "chebyshev"};
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    if (token == NULL ||
        !dalcs_builder_is_one_of(token->text, forms, sizeof forms / sizeof forms[0])) {
        return false;
    }
    dalcs_builder_error(reader->builder, token, reader->usage,
                        "a source of the form %s is not supported yet", token->text);
    return true;
}

void dalcs_controlled_parse(struct dalcs_builder *builder, const struct dalcs_card *card,
                            enum dalcs_device_kind kind) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, usage_of(kind));
    struct dalcs_device *device = dalcs_builder_add_device(builder, kind, card->token);
    const struct dalcs_token *source;
    if (device == NULL || !dalcs_reader_nodes(&reader, 2, device->node) || is_nonlinear(&reader)) {
        return;
    }
    if (is_voltage_controlled(kind)) {
        if (!dalcs_reader_nodes(&reader, 2, device->node + 2)) {
            return;
        }
    } else if (!dalcs_reader_name(&reader, "the name of a voltage source", &source)) {
        return;
    }
    if (dalcs_reader_number(&reader, DALCS_PLAIN, "a gain", &device->value)) {
        dalcs_reader_end(&reader);
    }
}

void dalcs_controlled_resolve(struct dalcs_builder *builder, const struct dalcs_card *card) {
    const int index = dalcs_names_find(&builder->devices, card->token->text);
    int ignored[2];
    struct dalcs_reader reader = dalcs_reader_start(builder, card, NULL);
    const struct dalcs_token *name;
    /* A card that cannot be read so far was reported when it was parsed. */
    const bool was_failed = builder->failed;
    if (index < 0 || index >= builder->n_device_cards || card->n < 5 ||
        !dalcs_reader_nodes(&reader, 2, ignored) || !dalcs_reader_name(&reader, "", &name)) {
        builder->failed = builder->failed || was_failed;
        return;
    }
    struct dalcs_device *device = &builder->circuit->device[index];
    const int control = dalcs_builder_find_device(builder, name);
    if (control < 0) {
        return;
    }
    if (builder->circuit->device[control].kind != DALCS_VSOURCE) {
        dalcs_builder_error(builder, name, "put a source of 0 V in series and name that",
                            "'%s' is %s: a control current is that of a voltage source", name->text,
                            dalcs_builder_kind_text(builder->circuit->device[control].kind));
        return;
    }
    device->control = control;
}
