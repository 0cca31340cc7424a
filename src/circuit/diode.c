/* diode.c - D elements and their models.
 *
 * A model is piecewise linear, with the lines of LTspice's idealised diode: slope 1/Roff up to Vfwd,
 * then 1/Ron, and 1/Rrev below -Vrev. What is left out is ideal: Ron = 0, Roff infinite, Vfwd = 0, no
 * breakdown. The parameters of the exponential diode are refused rather than guessed at. */
#include "builder.h"

#include <math.h>
#include <string.h>

static const char USAGE[] = "a diode is: Dname anode cathode [model]";
static const char MODEL_USAGE[] =
    "a diode model is: .model name D [(Ron=ohms Roff=ohms Vfwd=volts Vrev=volts Rrev=ohms)]";

static int ideal_model(struct dalcs_builder *builder) {
    if (builder->ideal_diode < 0) {
        struct dalcs_circuit *circuit = builder->circuit;
        builder->ideal_diode = circuit->n_diode_models++;
        circuit->diode_model[builder->ideal_diode] = (struct dalcs_diode_model){
            .name = "ideal", .roff = (double)INFINITY, .vrev = (double)INFINITY};
    }
    return builder->ideal_diode;
}

/* What may follow the model's name. */
static void read_rest(struct dalcs_reader *reader) {
    struct dalcs_builder *builder = reader->builder;
    double ignored;
    while (!dalcs_reader_at_end(reader)) {
        const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
        const struct dalcs_token *name = dalcs_reader_take_parameter(reader);
        if (name == NULL && dalcs_reader_take_word(reader, "off")) {
            dalcs_builder_note(builder, token, NULL, "'off' has no meaning here and is ignored");
        } else if (name == NULL && dalcs_reader_is_number(token)) {
            if (!dalcs_reader_number(reader, DALCS_PLAIN, "an area", &ignored)) {
                return;
            }
            dalcs_builder_warn(builder, token, NULL,
                               "the area of a piecewise linear diode is ignored");
        } else if (name != NULL &&
                   (strcmp(name->text, "ic") == 0 || strcmp(name->text, "temp") == 0 ||
                    strcmp(name->text, "dtemp") == 0)) {
            if (!dalcs_reader_number(reader, DALCS_PLAIN, "a number", &ignored)) {
                return;
            }
            dalcs_builder_note(builder, name, NULL, "'%s' of a diode is ignored", name->text);
        } else if (name != NULL && (strcmp(name->text, "m") == 0 || strcmp(name->text, "n") == 0 ||
                                    strcmp(name->text, "area") == 0)) {
            dalcs_builder_error(builder, name, "write a model for it",
                                "'%s' of a diode is not supported yet", name->text);
            return;
        } else {
            reader->at -= name != NULL ? 2 : 0;
            dalcs_reader_unexpected(reader);
            return;
        }
    }
}

void dalcs_diode_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_device *device = dalcs_builder_add_device(builder, DALCS_DIODE, card->token);
    if (device == NULL || !dalcs_reader_nodes(&reader, 2, device->node)) {
        return;
    }
    if (dalcs_reader_at_end(&reader)) {
        device->model = ideal_model(builder);
        return;
    }
    const struct dalcs_token *model;
    if (!dalcs_reader_name(&reader, "the name of a model", &model)) {
        return;
    }
    device->model = dalcs_model_find(builder, model, DALCS_MODEL_DIODE);
    read_rest(&reader);
}

/* ---- Models -------------------------------------------------------------------------------- */

/* Reports a parameter that a diode here does not have; false for one that means nothing. */
static bool report_parameter(struct dalcs_reader *reader, const struct dalcs_token *name) {
    static const char *const ours[] = {"ron", "roff", "vfwd", "vrev", "rrev"};
    static const char *const berkeley[] = {
        "is",   "js",    "jsw",  "n",    "ns",  "rs",   "bv",   "ibv",  "nbv",  "ibvl",
        "nbvl", "cjo",   "cj0",  "cj",   "cjp", "vj",   "pb",   "m",    "mj",   "fc",
        "fcs",  "tt",    "eg",   "xti",  "kf",  "af",   "ik",   "ikf",  "ikr",  "isr",
        "nr",   "tbv",   "tbv1", "tbv2", "trs", "trs1", "trs2", "tikf", "tnom", "tref",
        "vp",   "level", "area", "rsw",  "tcv", "cta",  "vjsw", "php",  "mjsw"};
    static const char *const later[] = {"ilimit", "revilimit", "epsilon", "revepsilon"};
    /* Data that libraries keep in a model, of no effect in any simulator. */
    static const char *const labels[] = {"mfg",  "type", "vpk",  "ipk",     "iave",
                                         "irms", "diss", "vceo", "icrating"};
    struct dalcs_builder *builder = reader->builder;
    if (dalcs_builder_is_one_of(name->text, labels, sizeof labels / sizeof labels[0])) {
        return false;
    }
    if (dalcs_builder_is_one_of(name->text, berkeley, sizeof berkeley / sizeof berkeley[0])) {
        dalcs_builder_error(builder, name,
                            "write a piecewise linear diode, such as D(Ron=10m Vfwd=0.7), or D "
                            "for an ideal one",
                            "'%s' belongs to the exponential diode, which is not supported yet",
                            name->text);
    } else if (dalcs_builder_is_one_of(name->text, later, sizeof later / sizeof later[0])) {
        dalcs_builder_error(builder, name, MODEL_USAGE, "'%s' is not supported yet", name->text);
    } else {
        dalcs_builder_error(builder, name,
                            dalcs_builder_suggest_of(builder, ours, sizeof ours / sizeof ours[0],
                                                     name->text, MODEL_USAGE),
                            "a diode model has no parameter '%s'", name->text);
    }
    return true;
}

enum { RON, ROFF, VFWD, VREV, RREV, N_PARAMETERS };

static bool check_model(struct dalcs_builder *builder, const struct dalcs_parameter *p) {
    if (p[RON].value < 0) {
        dalcs_builder_error(builder, p[RON].place, NULL, "Ron cannot be negative");
        return false;
    }
    if (p[ROFF].value <= 0) {
        dalcs_builder_error(builder, p[ROFF].place, "leave Roff out for a diode without leakage",
                            "Roff must be positive");
        return false;
    }
    if (p[VREV].value <= 0) {
        dalcs_builder_error(builder, p[VREV].place,
                            "Vrev is the magnitude of the breakdown voltage; leave it out for none",
                            "Vrev must be positive");
        return false;
    }
    if (p[VFWD].value <= -p[VREV].value) {
        dalcs_builder_error(builder, p[VFWD].place, NULL,
                            "Vfwd is not above the breakdown at -Vrev");
        return false;
    }
    if (p[RREV].value < 0) {
        dalcs_builder_error(builder, p[RREV].place, NULL, "Rrev cannot be negative");
        return false;
    }
    double largest = fmax(p[RON].value, p[VREV].place ? p[RREV].value : 0.0);
    if (p[ROFF].value <= largest) {
        dalcs_builder_error(builder, p[ROFF].place, "leave Roff out for a diode without leakage",
                            "Roff must be above Ron and Rrev: what conducts more when off is no "
                            "diode");
        return false;
    }
    return true;
}

bool dalcs_diode_parse_model(struct dalcs_reader *reader, struct dalcs_diode_model *model) {
    const double infinite = (double)INFINITY;
    struct dalcs_parameter parameter[N_PARAMETERS] = {
        [RON] = {"ron", DALCS_OHM, false, 0, NULL},
        [ROFF] = {"roff", DALCS_OHM, true, infinite, NULL},
        [VFWD] = {"vfwd", DALCS_VOLTAGE, false, 0, NULL},
        [VREV] = {"vrev", DALCS_VOLTAGE, true, infinite, NULL},
        [RREV] = {"rrev", DALCS_OHM, false, 0, NULL},
    };
    reader->usage = MODEL_USAGE;
    if (!dalcs_model_read_parameters(reader, parameter, N_PARAMETERS, report_parameter)) {
        return false;
    }
    if (parameter[RREV].place == NULL) {
        parameter[RREV].value = parameter[RON].value;
    }
    model->ron = parameter[RON].value;
    model->roff = parameter[ROFF].value;
    model->vfwd = parameter[VFWD].value;
    model->vrev = parameter[VREV].value;
    model->rrev = parameter[RREV].value;
    return check_model(reader->builder, parameter);
}
