/* analog_function.c - LTspice's A devices of voltages: VARISTOR and MODULATE.
 *
 *     Aname control control 0 0 0 0 a b VARISTOR [Rclamp=1]      a and b are pins 7 and 8
 *     Aname frequency amplitude 0 0 0 cos sin com MODULATE mark=hertz space=hertz [Vhigh=1 Vlow=-1]
 *
 * A varistor is two ideal diodes, each before a source of the voltage that it breaks down at. */
#include "element_cards.h"
#include "logic_parts.h"
#include "model_cards.h"
#include "oscillator.h"
#include "output_resistance.h"
#include "reader.h"

#include <math.h>
#include <string.h>

enum { N_PINS = 8, PIN_QUADRATURE = 5, PIN_OUTPUT, PIN_COMMON };

static bool is_modulator(const struct dalcs_card *card) {
    const char *function = card->token[DALCS_LOGIC_MODEL].text;
    return strcmp(function, "modulate") == 0 || strcmp(function, "modulator") == 0;
}

/* Its eight nodes, without those that mean nothing: a modulator has two outputs, of which one may do. */
static bool read_pins(struct dalcs_reader *reader, int *node) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *name = reader->card->token;
    if (!dalcs_reader_nodes(reader, N_PINS, node)) {
        return false;
    }
    const bool has_two = is_modulator(reader->card);
    for (int pin = 2; pin <= PIN_OUTPUT; pin++) {
        const bool is_wired = node[pin] != node[PIN_COMMON];
        const bool is_other = has_two && pin >= PIN_QUADRATURE &&
                              node[PIN_QUADRATURE + PIN_OUTPUT - pin] != node[PIN_COMMON];
        const bool is_optional = has_two && (pin == PIN_QUADRATURE || is_other);
        if (is_wired && pin != PIN_OUTPUT && !is_optional) {
            dalcs_builder_warn(builder, &name[1 + pin], "tie it to pin 8",
                               "this function does not use pin %d of '%s': it is ignored", pin + 1,
                               name->text);
        } else if (!is_wired && pin == PIN_OUTPUT && !is_optional) {
            dalcs_builder_warn(builder, &name[1 + pin], NULL,
                               "no output of '%s' is wired: the element is left out", name->text);
            return false;
        }
    }
    reader->at++; /* the function */
    return true;
}

/* And its parameters; false: an error was reported. */
static bool read_card(struct dalcs_reader *reader, int *node,
                      const struct dalcs_logic_parameters *parameters) {
    return read_pins(reader, node) && dalcs_logic_read_parameters(reader, parameters) &&
           dalcs_logic_check_signs(reader, parameters);
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
    if (!read_card(&reader, node, &(struct dalcs_logic_parameters){"a varistor", &p, 1, false})) {
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
    const int model = circuit->models.n_diodes++;
    circuit->models.of_diode[model] = (struct dalcs_diode_model){
        .name = "varistor", .ron = p.value, .roff = (double)INFINITY, .vrev = (double)INFINITY};
    const int both[2] = {inside, node[PIN_COMMON]};
    if (add_side(&c, both, model, false)) {
        (void)add_side(&c, both, model, true);
    }
}

/* ---- MODULATE --------------------------------------------------------------------------------------------------- */

/* The carrier, times the second input. */
static void put_product(struct dalcs_block_card *c, const int *node, const char *what, int carrier,
                        int output) {
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
        product >= 0 ? dalcs_block_add(c, DALCS_VCVS, what, output, node[PIN_COMMON]) : NULL;
    if (out != NULL) {
        out->node[2] = product;
        out->value = 1;
        dalcs_output_add(c->builder, c->card->token, out);
    }
}

/* One output, `what` NULL: that which has the element's current. The cosine is a quarter of a period ahead: both have
 * a phase of their own, of the same frequency. */
static void put_output(struct dalcs_oscillator *o, const int *node, const char *what, int pin) {
    o->what = what;
    o->phase = pin == PIN_QUADRATURE ? 0.25 : 0;
    o->out = (struct dalcs_block_end){.node = node[pin], .reference = node[PIN_COMMON]};
    o->may_resist = node[1] == node[PIN_COMMON];
    if (!o->may_resist) {
        const int carrier = dalcs_builder_inner_node(o->card.builder, "carrier", o->place);
        o->what = "carrier";
        o->out = (struct dalcs_block_end){.node = carrier};
        put_product(&o->card, node, what, carrier, node[pin]);
    }
    dalcs_oscillator_add(o);
}

enum { MARK, SPACE, HIGH, LOW, N_OF_MODULATOR };

/* The frequency and the levels; false: an error was reported. */
static bool set_levels(struct dalcs_oscillator *o, const int *node,
                       const struct dalcs_parameter *p) {
    const bool has_levels = p[HIGH].place != NULL || p[LOW].place != NULL;
    const bool has_amplitude = node[1] != node[PIN_COMMON];
    if (!has_amplitude && !(p[HIGH].value > p[LOW].value)) {
        dalcs_builder_error(o->card.builder, o->place, NULL, "Vhigh must be above Vlow");
        return false;
    }
    if (has_amplitude && has_levels) {
        dalcs_builder_warn(o->card.builder, o->place, NULL,
                           "the amplitude of '%s' is the voltage of pin 2: Vhigh and Vlow are "
                           "ignored",
                           o->place->text);
    }
    o->low = has_amplitude ? -1 : p[LOW].value;
    o->high = has_amplitude ? 1 : p[HIGH].value;
    struct dalcs_piecewise table = dalcs_block_make_table(&o->card, 2);
    if (table.knot == NULL) {
        return false;
    }
    dalcs_block_set_knot(&table, 0, 0, p[SPACE].value);
    dalcs_block_set_knot(&table, 1, 1, p[MARK].value);
    table.before = table.after = p[MARK].value - p[SPACE].value;
    return dalcs_oscillator_set_hertz(o, &table);
}

static void parse_modulator(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader =
        dalcs_reader_start(builder, card,
                           "a modulator is: Aname frequency amplitude 0 0 0 cos sin com MODULATE "
                           "mark=hertz space=hertz, pins 3 to 5 tied to pin 8");
    struct dalcs_parameter p[N_OF_MODULATOR] = {[MARK] = {"mark", DALCS_HERTZ, false, 0, NULL},
                                                [SPACE] = {"space", DALCS_HERTZ, false, 0, NULL},
                                                [HIGH] = {"vhigh", DALCS_VOLTAGE, false, 1, NULL},
                                                [LOW] = {"vlow", DALCS_VOLTAGE, false, -1, NULL}};
    int node[N_PINS];
    if (!read_card(&reader, node,
                   &(struct dalcs_logic_parameters){"a modulator", p, N_OF_MODULATOR, false})) {
        return;
    }
    if (p[MARK].place == NULL || p[SPACE].place == NULL) {
        dalcs_reader_missing(&reader, p[MARK].place == NULL ? "mark=" : "space=");
        return;
    }
    struct dalcs_oscillator o = {.card = {.builder = builder, .card = card},
                                 .place = card->token,
                                 .shape = DALCS_OSCILLATOR_SINE,
                                 .control = {.node = node[0], .reference = node[PIN_COMMON]},
                                 .duty = 0.5};
    const bool has_sine = node[PIN_OUTPUT] != node[PIN_COMMON];
    if (!set_levels(&o, node, p)) {
        return;
    }
    if (has_sine) {
        put_output(&o, node, NULL, PIN_OUTPUT);
    }
    if (node[PIN_QUADRATURE] != node[PIN_COMMON]) {
        put_output(&o, node, has_sine ? "cosine" : NULL, PIN_QUADRATURE);
    }
}

bool dalcs_analog_function_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    const char *function = card->token[DALCS_LOGIC_MODEL].text;
    if (strcmp(function, "varistor") == 0) {
        parse_varistor(builder, card);
    } else if (strcmp(function, "ota") == 0) {
        dalcs_transconductor_parse(builder, card);
    } else if (strcmp(function, "phasedet") == 0) {
        dalcs_phase_detector_parse(builder, card);
    } else if (is_modulator(card)) {
        parse_modulator(builder, card);
    } else {
        return false;
    }
    return true;
}
