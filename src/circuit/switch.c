/* switch.c - S elements (voltage controlled switches) and their models.
 *
 * A switch is a wire or a cut (Ron = 0, Roff infinite) unless its model says otherwise. It closes
 * when the control rises through Vt + Vh and opens when it falls through Vt - Vh. */
#include "builder.h"

#include <math.h>
#include <string.h>

static const char USAGE[] = "a switch is: Sname node node control control model [ON|OFF]";
static const char MODEL_USAGE[] =
    "a switch model is: .model name SW [(Ron=ohms Roff=ohms Vt=volts Vh=volts)]";

void dalcs_switch_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_device *device = dalcs_builder_add_device(builder, DALCS_SWITCH, card->token);
    const struct dalcs_token *model;
    if (device == NULL || !dalcs_reader_nodes(&reader, 4, device->node) ||
        !dalcs_reader_name(&reader, "the name of a model", &model)) {
        return;
    }
    device->model = dalcs_model_find(builder, model, DALCS_MODEL_SWITCH);
    device->initially_on = dalcs_reader_take_word(&reader, "on");
    device->has_initial_state =
        device->initially_on || dalcs_reader_take_word(&reader, "off");
    dalcs_reader_end(&reader);
}

static void report_parameter(struct dalcs_builder *builder, const struct dalcs_token *name) {
    static const char *const known[] = {"ron", "roff", "vt", "vh"};
    static const char *const later[] = {"von",    "voff", "vton", "vtoff", "vhon", "vhoff",
                                        "ilimit", "lser", "vser", "level", "td",   "oneway",
                                        "epsilon"};
    for (size_t k = 0; k < sizeof later / sizeof later[0]; k++) {
        if (strcmp(name->text, later[k]) == 0) {
            dalcs_builder_error(builder, name, MODEL_USAGE,
                                "'%s' of a switch is not supported yet", name->text);
            return;
        }
    }
    const char *nearest = dalcs_names_nearest_of(known, 4, name->text);
    dalcs_builder_error(builder, name,
                        nearest != NULL
                            ? dalcs_builder_hint(builder, "did you mean '%s'?", nearest)
                            : MODEL_USAGE,
                        "a switch model has no parameter '%s'", name->text);
}

static bool check_model(struct dalcs_reader *reader, const struct dalcs_token *const *place,
                        const double *value) {
    struct dalcs_builder *builder = reader->builder;
    if (value[0] < 0) {
        dalcs_builder_error(builder, place[0], NULL, "Ron cannot be negative");
        return false;
    }
    if (value[1] <= 0) {
        dalcs_builder_error(builder, place[1], "leave Roff out for a switch that is open when off",
                            "Roff must be positive");
        return false;
    }
    if (value[3] < 0) {
        dalcs_builder_error(builder, place[3],
                            "write Vh=0 for a hard switch at Vt, or a positive hysteresis",
                            "a negative Vh asks for a smooth transition (LTspice) or a delayed one "
                            "(ngspice); this switch is on or off");
        return false;
    }
    if (value[1] <= value[0]) {
        dalcs_builder_warn(builder, place[1] != NULL ? place[1] : place[0], NULL,
                           "Roff is not above Ron");
    }
    return true;
}

bool dalcs_switch_parse_model(struct dalcs_reader *reader, struct dalcs_switch_model *model) {
    static const struct {
        const char *name;
        enum dalcs_quantity quantity;
    } known[4] = {
        {"ron", DALCS_OHM}, {"roff", DALCS_OHM}, {"vt", DALCS_VOLTAGE}, {"vh", DALCS_VOLTAGE}};
    struct dalcs_builder *builder = reader->builder;
    double value[4] = {0, (double)INFINITY, 0, 0};
    const struct dalcs_token *place[4] = {NULL};
    const struct dalcs_token *name;

    reader->usage = MODEL_USAGE;
    while ((name = dalcs_reader_take_parameter(reader)) != NULL) {
        int k = 0;
        while (k < 4 && strcmp(known[k].name, name->text) != 0) {
            k++;
        }
        if (k == 4) {
            report_parameter(builder, name);
            return false;
        }
        if (place[k] != NULL) {
            dalcs_builder_error(builder, name, NULL, "'%s' is given twice", name->text);
            return false;
        }
        const bool ok =
            k == 1
                ? dalcs_reader_number_or_infinity(reader, known[k].quantity, "a value", &value[k])
                : dalcs_reader_number(reader, known[k].quantity, "a value", &value[k]);
        if (!ok) {
            return false;
        }
        place[k] = name;
    }
    model->ron = value[0];
    model->roff = value[1];
    model->vt = value[2];
    model->vh = value[3];
    return check_model(reader, place, value);
}
