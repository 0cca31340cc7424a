/* analog_function.c - LTspice's A devices of voltages: VARISTOR and MODULATE.
 *
 *     Aname control control 0 0 0 0 a b VARISTOR [Rclamp=1]      a and b are pins 7 and 8
 *     Aname frequency amplitude 0 0 0 0 out com MODULATE [mark=hertz space=hertz]
 *
 * A varistor is two ideal diodes, each before a source of the voltage that it breaks down at. */
#include "oscillator.h"

#include <math.h>
#include <string.h>

enum { N_PINS = 8, PIN_OUTPUT = 6, PIN_COMMON };

/* Its eight nodes, without those that mean nothing, and its parameters; false: an error was reported. */
static bool read_card(struct dalcs_reader *reader, int *node, struct dalcs_parameter *p, int n) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *name = reader->card->token;
    if (!dalcs_reader_nodes(reader, N_PINS, node)) {
        return false;
    }
    for (int pin = 2; pin <= PIN_OUTPUT; pin++) {
        const bool is_wired = node[pin] != node[PIN_COMMON];
        if (is_wired != (pin == PIN_OUTPUT)) {
            dalcs_builder_error(builder, &name[1 + pin], is_wired ? "tie it to pin 8" : NULL,
                                is_wired ? "pin %d of '%s' means nothing for this function"
                                         : "pin %d of '%s' is not wired",
                                pin + 1, name->text);
            return false;
        }
    }
    reader->at++; /* the function */
    while (!dalcs_reader_at_end(reader)) {
        const struct dalcs_token *parameter = dalcs_reader_take_parameter(reader);
        if (parameter == NULL) {
            dalcs_reader_unexpected(reader);
            return false;
        }
        int k = 0;
        while (k < n && strcmp(parameter->text, p[k].name) != 0) {
            k++;
        }
        if (k == n) {
            dalcs_builder_error(builder, parameter, reader->usage,
                                "there is no parameter '%s' here", parameter->text);
            return false;
        }
        p[k].place = parameter;
        if (!dalcs_reader_number(reader, p[k].quantity, "a value", &p[k].value)) {
            return false;
        }
        if (!(p[k].value >= 0)) {
            dalcs_builder_error(builder, parameter, NULL, "'%s' cannot be negative", p[k].name);
            return false;
        }
    }
    return true;
}

/* ---- VARISTOR --------------------------------------------------------------------------------------------------- */

/* One direction: a diode into a source of the control, which counts where it is above 0. */
static bool add_side(const struct dalcs_block_card *c, const int *node, int model, bool is_back) {
    const int inside =
        dalcs_builder_inner_node(c->builder, is_back ? "lower" : "upper", c->card->token);
    struct dalcs_device *d =
        dalcs_block_add(c, DALCS_DIODE, is_back ? "lower" : "upper", is_back ? inside : node[0],
                        is_back ? node[0] : inside);
    struct dalcs_device *e =
        dalcs_block_add(c, DALCS_VCVS, is_back ? "at_lower" : "at_upper", inside, node[1]);
    struct dalcs_piecewise table = dalcs_block_make_table(c, 1);
    if (inside < 0 || d == NULL || e == NULL || table.knot == NULL) {
        return false;
    }
    dalcs_block_set_knot(&table, 0, 0, 0);
    table.after = is_back ? -1 : 1;
    d->model = model;
    dalcs_block_control(e, &c->port[0].end[0], 1);
    dalcs_behavioural_add_table(c->builder, e, &table);
    return true;
}

static void parse_varistor(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(
        builder, card,
        "a varistor is: Aname control control 0 0 0 0 a b VARISTOR [Rclamp=ohms], "
        "pins 3 to 6 tied to pin 8");
    struct dalcs_parameter p = {"rclamp", DALCS_OHM, false, 1, NULL};
    int node[N_PINS];
    if (!read_card(&reader, node, &p, 1)) {
        return;
    }
    struct dalcs_block_end control = {.node = node[0], .reference = node[1]};
    struct dalcs_block_card c = {.builder = builder, .card = card, .port = {{.end = &control}}};
    struct dalcs_device *all = dalcs_block_add(&c, DALCS_RESISTOR, NULL, node[PIN_OUTPUT], -1);
    const int inside = dalcs_builder_inner_node(builder, "clamp", card->token);
    if (all == NULL || inside < 0) {
        return;
    }
    all->node[1] = inside; /* a short, whose current is the element's */
    struct dalcs_circuit *circuit = builder->circuit;
    const int model = circuit->n_diode_models++;
    circuit->diode_model[model] = (struct dalcs_diode_model){
        .name = "varistor", .ron = p.value, .roff = (double)INFINITY, .vrev = (double)INFINITY};
    const int both[2] = {inside, node[PIN_COMMON]};
    if (add_side(&c, both, model, false)) {
        (void)add_side(&c, both, model, true);
    }
}

/* ---- MODULATE --------------------------------------------------------------------------------------------------- */

/* The carrier, times the second input where that is wired. */
static void put_product(struct dalcs_block_card *c, const int *node, int carrier) {
    const int amplitude = dalcs_builder_inner_node(c->builder, "amplitude", c->card->token);
    struct dalcs_device *e = dalcs_block_add(c, DALCS_VCVS, "amplitude", amplitude, 0);
    if (amplitude < 0 || e == NULL) {
        return;
    }
    e->node[2] = node[1];
    e->node[3] = node[PIN_COMMON];
    e->value = 1;
    const int product = dalcs_smooth_add(c->builder, c->card->token, "product",
                                         DALCS_SMOOTH_PRODUCT, 2, (int[]){carrier, amplitude});
    struct dalcs_device *out =
        product >= 0 ? dalcs_block_add(c, DALCS_VCVS, NULL, node[PIN_OUTPUT], node[PIN_COMMON])
                     : NULL;
    if (out != NULL) {
        out->node[2] = product;
        out->value = 1;
    }
}

static void parse_modulator(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader =
        dalcs_reader_start(builder, card,
                           "a modulator is: Aname frequency amplitude 0 0 0 0 out com MODULATE "
                           "mark=hertz space=hertz, pins 3 to 6 tied to pin 8");
    struct dalcs_parameter p[] = {{"mark", DALCS_HERTZ, false, 0, NULL},
                                  {"space", DALCS_HERTZ, false, 0, NULL}};
    int node[N_PINS];
    if (!read_card(&reader, node, p, 2)) {
        return;
    }
    if (p[0].place == NULL || p[1].place == NULL) {
        dalcs_reader_missing(&reader, p[0].place == NULL ? "mark=" : "space=");
        return;
    }
    struct dalcs_oscillator o = {.card = {.builder = builder, .card = card},
                                 .place = card->token,
                                 .shape = DALCS_OSCILLATOR_SINE,
                                 .control = {.node = node[0], .reference = node[PIN_COMMON]},
                                 .out = {.node = node[PIN_OUTPUT], .reference = node[PIN_COMMON]},
                                 .low = -1,
                                 .high = 1,
                                 .duty = 0.5};
    struct dalcs_piecewise table = dalcs_block_make_table(&o.card, 2);
    if (table.knot == NULL) {
        return;
    }
    dalcs_block_set_knot(&table, 0, 0, p[1].value);
    dalcs_block_set_knot(&table, 1, 1, p[0].value);
    table.before = table.after = p[0].value - p[1].value;
    if (node[1] != node[PIN_COMMON]) {
        const int carrier = dalcs_builder_inner_node(builder, "carrier", card->token);
        o.what = "carrier";
        o.out = (struct dalcs_block_end){.node = carrier};
        put_product(&o.card, node, carrier);
    }
    if (dalcs_oscillator_set_hertz(&o, &table)) {
        dalcs_oscillator_add(&o);
    }
}

bool dalcs_analog_function_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    const char *function = card->token[DALCS_LOGIC_MODEL].text;
    if (strcmp(function, "varistor") == 0) {
        parse_varistor(builder, card);
    } else if (strcmp(function, "modulate") == 0 || strcmp(function, "modulator") == 0) {
        parse_modulator(builder, card);
    } else {
        return false;
    }
    return true;
}
