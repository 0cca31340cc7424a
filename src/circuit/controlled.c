/* controlled.c - linear controlled sources: E and G by a voltage, F and H by the current of a V. */

#include "element_cards.h"
#include "reader.h"

#include <string.h>

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

/* A response stands where the control should be. */
static bool is_refused(struct dalcs_reader *reader) {
    static const char *const forms[] = {"freq", "chebyshev"};
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    if (token == NULL ||
        !dalcs_builder_is_one_of(token->text, forms, sizeof forms / sizeof forms[0])) {
        return false;
    }
    dalcs_builder_error(reader->builder, token,
                        "write LAPLACE with the ratio that the table was made of, or R, L and C",
                        "a response over frequency (%s) has no equations in time", token->text);
    return true;
}

/* LTspice's G devices that conduct one way, above a threshold; how they begin to is not documented. */
static bool is_one_sided(struct dalcs_reader *reader) {
    const struct dalcs_token *name = dalcs_reader_peek(reader, 0);
    if (name == NULL || (strcmp(name->text, "vto") != 0 && strcmp(name->text, "dir") != 0)) {
        return false;
    }
    dalcs_builder_error(reader->builder, name,
                        "of straight lines: Bname node node "
                        "I=siemens*max(0, v(control,control)-vto)",
                        "a source that conducts one way (%s) is not supported", name->text);
    return true;
}

static bool is_transfer(const struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    return token != NULL && token->kind == DALCS_TOKEN_WORD && strcmp(token->text, "laplace") == 0;
}

void dalcs_controlled_parse(struct dalcs_builder *builder, const struct dalcs_card *card,
                            enum dalcs_device_kind kind) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, usage_of(kind));
    struct dalcs_device *device = dalcs_builder_add_device(builder, kind, card->token);
    if (device == NULL || !dalcs_reader_nodes(&reader, 2, device->node) || is_refused(&reader)) {
        return;
    }
    if (dalcs_reader_take_word(&reader, "poly")) {
        dalcs_poly_parse(&reader, device);
        return;
    }
    if (is_voltage_controlled(kind) && dalcs_behavioural_is_form(dalcs_reader_peek(&reader, 0))) {
        dalcs_behavioural_parse_form(&reader, device);
        return;
    }
    if (is_voltage_controlled(kind) && is_transfer(&reader)) {
        dalcs_transfer_parse(&reader, device, false);
        return;
    }
    if (is_voltage_controlled(kind)) {
        if (!dalcs_reader_nodes(&reader, 2, device->node + 2) || is_refused(&reader)) {
            return;
        }
        if (is_transfer(&reader)) {
            dalcs_transfer_parse(&reader, device, true);
            return;
        }
        if (dalcs_behavioural_is_form(dalcs_reader_peek(&reader, 0))) {
            dalcs_behavioural_parse_form(&reader, device);
            return;
        }
    } else {
        const struct dalcs_token *source;
        if (!dalcs_reader_name(&reader, "the name of a voltage source", &source)) {
            return;
        }
        builder->elements.control_token[device - builder->circuit->device] = source;
    }
    if (dalcs_reader_number(&reader, DALCS_PLAIN, "a gain", &device->value)) {
        if (is_one_sided(&reader)) {
            return;
        }
        device->value *= kind == DALCS_VCCS ? dalcs_parallel_of(card) : 1;
        dalcs_reader_end(&reader);
    }
}

/* A source of 0 V before a coil, whose current LTspice reads, too; -1: out of memory. */
static int add_ammeter(struct dalcs_builder *builder, int coil, const struct dalcs_token *reader) {
    const int inside = dalcs_builder_inner_node(builder, "ammeter", reader);
    struct dalcs_device *ammeter =
        inside >= 0 && dalcs_builder_reserve_devices(builder, 1)
            ? dalcs_builder_add_inner_device(builder, DALCS_VCVS, "ammeter", reader)
            : NULL;
    if (ammeter == NULL) {
        return -1;
    }
    struct dalcs_device *device = &builder->circuit->device[coil];
    ammeter->node[0] = device->node[0];
    ammeter->node[1] = device->node[0] = inside;
    return (int)(ammeter - builder->circuit->device);
}

static void resolve(struct dalcs_builder *builder, int k, const struct dalcs_token *name) {
    int control = dalcs_builder_find_device(builder, name);
    if (control < 0) {
        return;
    }
    const enum dalcs_device_kind kind = builder->circuit->device[control].kind;
    const bool is_coil = kind == DALCS_INDUCTOR && builder->elements.current_of[control] == control;
    if (kind != DALCS_VSOURCE && kind != DALCS_VCVS && kind != DALCS_CCVS && !is_coil) {
        dalcs_builder_error(builder, name, "put a source of 0 V in series and name that",
                            "'%s' is %s: a control current is that of a voltage source", name->text,
                            dalcs_builder_kind_text(kind));
        return;
    }
    control = is_coil ? add_ammeter(builder, control, builder->elements.device_token[k]) : control;
    builder->circuit->device[k].control = control;
}

void dalcs_controlled_resolve(struct dalcs_builder *builder) {
    for (int k = 0; k < builder->circuit->n_devices; k++) {
        if (builder->elements.control_token[k] != NULL) {
            resolve(builder, k, builder->elements.control_token[k]);
        }
    }
}
