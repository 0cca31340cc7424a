/* diode.c - D elements, and A elements whose model is a sidiode.
 *
 * m= diodes in parallel and n= in series are LTspice's, of exponential ones too (the cells of a solar
 * panel); the area is that of SPICE's exponential diode. A diode with one of these has a model of its own. What limits its current: current_limit.c. */

#include "element_cards.h"
#include "model_cards.h"
#include "reader.h"

#include <math.h>
#include <string.h>

static const char USAGE[] =
    "a diode is: Dname anode cathode [model] [area] [m=parallel] [n=series]";

/* The parameters that may follow the model's name. */
struct scale {
    double area, parallel, series;
    const struct dalcs_token *place; /* of the last one, NULL: none */
};

static bool read_positive(struct dalcs_reader *reader, const char *what, double *value) {
    if (!dalcs_reader_number(reader, DALCS_PLAIN, what, value)) {
        return false;
    }
    if (*value <= 0) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                            "%s must be positive", what);
        return false;
    }
    return true;
}

static bool read_scale(struct dalcs_reader *reader, const struct dalcs_token *name,
                       struct scale *scale) {
    scale->place = name;
    return read_positive(reader, strcmp(name->text, "area") == 0 ? "an area" : "a number of diodes",
                         strcmp(name->text, "area") == 0 ? &scale->area
                         : strcmp(name->text, "m") == 0  ? &scale->parallel
                                                         : &scale->series);
}

static bool read_rest(struct dalcs_reader *reader, struct scale *scale) {
    static const char *const scales[] = {"m", "n", "area"};
    static const char *const ignored[] = {"ic", "temp", "dtemp", "pj", "w", "l", "lm", "wm"};
    static const char *const flags[] = {"off", "thermal"};
    struct dalcs_builder *builder = reader->builder;
    double value;
    while (!dalcs_reader_at_end(reader)) {
        const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
        const struct dalcs_token *name = dalcs_reader_take_parameter(reader);
        if (name == NULL &&
            dalcs_builder_is_one_of(token->text, flags, sizeof flags / sizeof flags[0])) {
            reader->at++;
            dalcs_builder_note(builder, token, NULL, "'%s' has no meaning here and is ignored",
                               token->text);
        } else if (name == NULL && dalcs_reader_is_number(token)) {
            scale->place = token;
            if (!read_positive(reader, "an area", &scale->area)) {
                return false;
            }
        } else if (name != NULL && dalcs_builder_is_one_of(name->text, ignored,
                                                           sizeof ignored / sizeof ignored[0])) {
            if (!dalcs_reader_number(reader, DALCS_PLAIN, "a number", &value)) {
                return false;
            }
            dalcs_builder_note(builder, name, NULL, "'%s' of a diode is ignored", name->text);
        } else if (name != NULL &&
                   dalcs_builder_is_one_of(name->text, scales, sizeof scales / sizeof scales[0])) {
            if (!read_scale(reader, name, scale)) {
                return false;
            }
        } else {
            reader->at -= name != NULL ? 2 : 0;
            dalcs_reader_unexpected(reader);
            return false;
        }
    }
    return true;
}

/* A model for a diode that is not as large as its model. */
static void scale_model(struct dalcs_builder *builder, const struct dalcs_diode_card *card,
                        struct dalcs_device *device, const struct scale *scale) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_diode_model *model = &circuit->models.of_diode[circuit->models.n_diodes];
    *model = circuit->models.of_diode[device->model];
    if (card->is_berkeley) {
        struct dalcs_diode_card cells = *card;
        dalcs_diode_cells(&cells, scale->series);
        dalcs_diode_model_map(&cells, builder->models.diode_current, scale->area * scale->parallel,
                              model);
    } else if (scale->area != 1) {
        dalcs_builder_warn(builder, scale->place, NULL,
                           "the area of a piecewise linear diode is ignored");
    }
    if (!card->is_berkeley) {
        const double factor = scale->series / scale->parallel;
        model->ron *= factor;
        model->roff *= factor;
        model->rrev *= factor;
        model->vfwd *= scale->series;
        model->vrev *= scale->series;
    }
    device->model = circuit->models.n_diodes++;
}

/* After the nodes. */
static void read_model(struct dalcs_reader *reader, struct dalcs_device *device) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *name;
    struct scale scale = {1, 1, 1, NULL};
    if (!dalcs_reader_name(reader, "the name of a model", &name)) {
        return;
    }
    device->model = dalcs_model_find(builder, name, DALCS_MODEL_DIODE);
    if (!read_rest(reader, &scale) || device->model < 0) {
        return;
    }
    if (reader->card->parallel > 0) {
        scale.parallel *= reader->card->parallel;
        scale.place = scale.place != NULL ? scale.place : name;
    }
    const struct dalcs_diode_card *card =
        &builder->models.model[dalcs_names_find(&builder->models.names, name->text)].diode;
    if (scale.place != NULL) {
        scale_model(builder, card, device, &scale);
    }
    const struct dalcs_diode_model *model = &builder->circuit->models.of_diode[device->model];
    if (model->vrev == 0) { /* and Vfwd = 0, and one resistance both ways (diode_model.c) */
        device->kind = DALCS_RESISTOR;
        device->value = isfinite(model->roff)
                            ? model->ron * (model->roff / (model->ron + model->roff))
                            : model->ron;
        device->model = -1;
    }
    const struct dalcs_current_limits limits = {.forward = card->ilimit * scale.parallel,
                                                .reverse = card->revilimit * scale.parallel};
    dalcs_current_limit_expand(builder, reader->card->token, device, &limits);
}

void dalcs_diode_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_device *device = dalcs_builder_add_device(builder, DALCS_DIODE, card->token);
    if (device == NULL || !dalcs_reader_nodes(&reader, 2, device->node)) {
        return;
    }
    if (dalcs_reader_at_end(&reader)) {
        device->model = dalcs_diode_ideal_model(builder);
        return;
    }
    read_model(&reader, device);
}

/* The function or model of an A element: the last word before parameters, whose values are words, too. */
static const struct dalcs_token *function_of(const struct dalcs_card *card) {
    int k = 1;
    while (k + 1 < card->n && card->token[k + 1].kind != DALCS_TOKEN_EQUAL) {
        k++;
    }
    const bool is_parameter = k + 1 < card->n && k > 1;
    return card->n < 2 ? card->token : &card->token[is_parameter ? k - 1 : k];
}

/* An A element that is neither logic nor a block nor a diode. */
static void refuse_block(struct dalcs_builder *builder, const struct dalcs_card *card,
                         const struct dalcs_token *type) {
    static const char *const functions[] = {"and",        "or",      "xor",     "buf",
                                            "inv",        "schmitt", "dflop",   "srflop",
                                            "samplehold", "counter", "modulate"};
    const size_t n = sizeof functions / sizeof functions[0];
    const char *name = card->token->text;
    const struct dalcs_token *last = function_of(card);
    builder->hidden |= DALCS_HIDDEN_ELEMENTS;
    const bool is_switch = type != NULL && strstr(type->text, "sw") != NULL;
    if (type != NULL) {
        dalcs_builder_error(
            builder, card->token,
            is_switch ? "a switch is: Sname node node control control model"
                      : "write it with B sources, switches, gates or other code models",
            "'%s' is an A element with a model of type %s, which dalcs does not have", name,
            type->text);
    } else if (dalcs_builder_is_one_of(last->text, functions, n)) {
        dalcs_builder_error(builder, card->token,
                            "Aname in1 in2 in3 in4 in5 inverse out common function",
                            "'%s' has not the eight nodes of a function of LTspice", name);
    } else {
        dalcs_builder_error(
            builder, card->token,
            dalcs_builder_suggest_of(
                builder, functions, n, last->text,
                "functions are and, or, xor, buf, inv, schmitt, dflop, "
                "srflop, samplehold, counter, modulate, ota, varistor and phasedet"),
            "'%s' has the function or model '%s', which neither dalcs nor the netlist has", name,
            last->text);
    }
}

void dalcs_diode_parse_block(struct dalcs_builder *builder, const struct dalcs_card *card) {
    const struct dalcs_token *last = &card->token[card->n - 1];
    const int index = dalcs_names_find(&builder->models.names, last->text);
    if (index < 0 || builder->models.model[index].type == NULL ||
        strcmp(builder->models.model[index].type->text, "sidiode") != 0) {
        refuse_block(builder, card, index >= 0 ? builder->models.model[index].type : NULL);
        return;
    }
    struct dalcs_reader reader =
        dalcs_reader_start(builder, card, "an XSPICE diode is: Aname %gd(anode cathode) model");
    struct dalcs_device *device = dalcs_builder_add_device(builder, DALCS_DIODE, card->token);
    const struct dalcs_token *port = dalcs_reader_peek(&reader, 0);
    reader.at += port != NULL && port->text[0] == '%';
    if (device != NULL && dalcs_reader_nodes(&reader, 2, device->node)) {
        read_model(&reader, device);
    }
}
