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
    device->has_initial_state = device->initially_on || dalcs_reader_take_word(&reader, "off");
    dalcs_reader_end(&reader);
}

static bool report_parameter(struct dalcs_builder *builder, const struct dalcs_token *name) {
    static const char *const ours[] = {"ron", "roff", "vt", "vh"};
    static const char *const later[] = {"von",   "voff",   "vton",   "vtoff", "vhon",
                                        "vhoff", "ilimit", "lser",   "vser",  "level",
                                        "td",    "oneway", "epsilon"};
    if (dalcs_builder_is_one_of(name->text, later, sizeof later / sizeof later[0])) {
        dalcs_builder_error(builder, name, MODEL_USAGE, "'%s' of a switch is not supported yet",
                            name->text);
    } else {
        dalcs_builder_error(builder, name,
                            dalcs_builder_suggest_of(builder, ours, sizeof ours / sizeof ours[0],
                                                     name->text, MODEL_USAGE),
                            "a switch model has no parameter '%s'", name->text);
    }
    return true;
}

enum { RON, ROFF, VT, VH, N_PARAMETERS };

static bool check_model(struct dalcs_builder *builder, const struct dalcs_parameter *p) {
    if (p[RON].value < 0) {
        dalcs_builder_error(builder, p[RON].place, NULL, "Ron cannot be negative");
        return false;
    }
    if (p[ROFF].value <= 0) {
        dalcs_builder_error(builder, p[ROFF].place,
                            "leave Roff out for a switch that is open when off",
                            "Roff must be positive");
        return false;
    }
    if (p[VH].value < 0) {
        dalcs_builder_error(builder, p[VH].place,
                            "write Vh=0 for a hard switch at Vt, or a positive hysteresis",
                            "a negative Vh asks for a smooth transition (LTspice) or a delayed one "
                            "(ngspice); this switch is on or off");
        return false;
    }
    if (p[ROFF].value <= p[RON].value) {
        dalcs_builder_error(
            builder, p[ROFF].place,
            "for a switch that is closed when off exchange Ron and Roff and the two "
            "control nodes, and change the sign of Vt",
            "Roff must be above Ron");
        return false;
    }
    return true;
}

bool dalcs_switch_parse_model(struct dalcs_reader *reader, struct dalcs_switch_model *model) {
    struct dalcs_parameter parameter[N_PARAMETERS] = {
        [RON] = {"ron", DALCS_OHM, false, 0, NULL},
        [ROFF] = {"roff", DALCS_OHM, true, (double)INFINITY, NULL},
        [VT] = {"vt", DALCS_VOLTAGE, false, 0, NULL},
        [VH] = {"vh", DALCS_VOLTAGE, false, 0, NULL},
    };
    reader->usage = MODEL_USAGE;
    if (!dalcs_model_read_parameters(reader, parameter, N_PARAMETERS, report_parameter)) {
        return false;
    }
    model->ron = parameter[RON].value;
    model->roff = parameter[ROFF].value;
    model->vt = parameter[VT].value;
    model->vh = parameter[VH].value;
    return check_model(reader->builder, parameter);
}
