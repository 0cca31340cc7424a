/* diode.c - D elements and their models.
 *
 * A model is piecewise linear: Ron, Vfwd in series with the ideal diode, Roff in parallel, Vrev and
 * Rrev for breakdown. What is left out is ideal: Ron = 0, Roff infinite, Vfwd = 0, no breakdown. The
 * parameters of the exponential diode are refused rather than guessed at. */
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
        } else if (name != NULL && (strcmp(name->text, "ic") == 0 ||
                                    strcmp(name->text, "temp") == 0 ||
                                    strcmp(name->text, "dtemp") == 0)) {
            if (!dalcs_reader_number(reader, DALCS_PLAIN, "a number", &ignored)) {
                return;
            }
            dalcs_builder_note(builder, name, NULL, "'%s' of a diode is ignored", name->text);
        } else if (name != NULL && (strcmp(name->text, "m") == 0 ||
                                    strcmp(name->text, "n") == 0 ||
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

static bool is_one_of(const char *name, const char *const *list) {
    for (; *list != NULL; list++) {
        if (strcmp(name, *list) == 0) {
            return true;
        }
    }
    return false;
}

/* Parameters of diodes that this is not. True when the name was reported. */
static bool report_foreign(struct dalcs_builder *builder, const struct dalcs_token *name) {
    static const char *const berkeley[] = {
        "is",  "js",  "jsw",  "n",    "ns",   "rs",   "bv",   "ibv",  "nbv",  "cjo",
        "cj0", "cj",  "cjp",  "vj",   "pb",   "m",    "mj",   "fc",   "fcs",  "tt",
        "eg",  "xti", "kf",   "af",   "ik",   "ikf",  "ikr",  "isr",  "nr",   "ibvl",
        "nbvl", "tbv", "tbv1", "tbv2", "trs", "trs1", "trs2", "tikf", "tnom", "tref",
        "level", "area", "vp", "rsw", "tcv", "cta", "vjsw", "php", "mjsw", NULL};
    static const char *const later[] = {"ilimit", "revilimit", "epsilon", "revepsilon", NULL};
    if (is_one_of(name->text, berkeley)) {
        dalcs_builder_error(builder, name,
                            "write a piecewise linear diode, such as D(Ron=10m Vfwd=0.7), or D "
                            "for an ideal one",
                            "'%s' belongs to the exponential diode, which is not supported yet",
                            name->text);
        return true;
    }
    if (is_one_of(name->text, later)) {
        dalcs_builder_error(builder, name, MODEL_USAGE, "'%s' is not supported yet", name->text);
        return true;
    }
    return false;
}

/* Data that some libraries keep in a model, of no effect in any simulator. */
static bool skip_label(struct dalcs_reader *reader, const struct dalcs_token *name) {
    static const char *const labels[] = {"mfg",  "type", "vpk",  "ipk",    "iave",
                                         "irms", "diss", "vceo", "icrating", NULL};
    if (!is_one_of(name->text, labels)) {
        return false;
    }
    const struct dalcs_token *value = dalcs_reader_peek(reader, 0);
    if (value != NULL && value->kind != DALCS_TOKEN_CLOSE) {
        reader->at++;
    }
    return true;
}

static bool check_model(struct dalcs_reader *reader, const struct dalcs_token *const *place,
                        const struct dalcs_diode_model *model) {
    struct dalcs_builder *builder = reader->builder;
    /* In the order of place[]: ron roff vfwd vrev rrev. */
    if (model->ron < 0) {
        dalcs_builder_error(builder, place[0], NULL, "Ron cannot be negative");
        return false;
    }
    if (model->roff <= 0) {
        dalcs_builder_error(builder, place[1], "leave Roff out for a diode without leakage",
                            "Roff must be positive");
        return false;
    }
    if (model->vrev <= 0) {
        dalcs_builder_error(builder, place[3],
                            "Vrev is the magnitude of the breakdown voltage; leave it out for none",
                            "Vrev must be positive");
        return false;
    }
    if (model->vfwd <= -model->vrev) {
        dalcs_builder_error(builder, place[2], NULL, "Vfwd is below the breakdown at -Vrev");
        return false;
    }
    if (model->rrev < 0) {
        dalcs_builder_error(builder, place[4], NULL, "Rrev cannot be negative");
        return false;
    }
    if (model->roff <= model->ron) {
        dalcs_builder_warn(builder, place[1], NULL, "Roff is not above Ron");
    }
    return true;
}

bool dalcs_diode_parse_model(struct dalcs_reader *reader, struct dalcs_diode_model *model) {
    static const struct {
        const char *name;
        enum dalcs_quantity quantity;
    } known[5] = {{"ron", DALCS_OHM},
                  {"roff", DALCS_OHM},
                  {"vfwd", DALCS_VOLTAGE},
                  {"vrev", DALCS_VOLTAGE},
                  {"rrev", DALCS_OHM}};
    static const char *const names[5] = {"ron", "roff", "vfwd", "vrev", "rrev"};
    struct dalcs_builder *builder = reader->builder;
    double value[5] = {0, (double)INFINITY, 0, (double)INFINITY, 0};
    const struct dalcs_token *place[5] = {NULL};
    bool foreign = false;
    const struct dalcs_token *name;

    reader->usage = MODEL_USAGE;
    while ((name = dalcs_reader_take_parameter(reader)) != NULL) {
        int k = 0;
        while (k < 5 && strcmp(known[k].name, name->text) != 0) {
            k++;
        }
        if (k == 5 && skip_label(reader, name)) {
            continue;
        }
        if (k == 5) {
            /* A library's card has a dozen of these: one message is enough. */
            const char *nearest = dalcs_names_nearest_of(names, 5, name->text);
            if (!foreign && !report_foreign(builder, name)) {
                dalcs_builder_error(
                    builder, name,
                    nearest != NULL ? dalcs_builder_hint(builder, "did you mean '%s'?", nearest)
                                    : MODEL_USAGE,
                    "a diode model has no parameter '%s'", name->text);
            }
            foreign = true;
            double ignored;
            const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
            if (next != NULL && next->kind == DALCS_TOKEN_WORD && !dalcs_reader_is_number(next)) {
                reader->at++;
            } else if (!dalcs_reader_number(reader, DALCS_PLAIN, "a value", &ignored)) {
                return false;
            }
            continue;
        }
        if (place[k] != NULL) {
            dalcs_builder_error(builder, name, NULL, "'%s' is given twice", name->text);
            return false;
        }
        const bool may_be_infinite = k == 1 || k == 3;
        const bool ok =
            may_be_infinite
                ? dalcs_reader_number_or_infinity(reader, known[k].quantity, "a value", &value[k])
                : dalcs_reader_number(reader, known[k].quantity, "a value", &value[k]);
        if (!ok) {
            return false;
        }
        place[k] = name;
    }
    if (foreign) {
        return false;
    }
    model->ron = value[0];
    model->roff = value[1];
    model->vfwd = value[2];
    model->vrev = value[3];
    model->rrev = place[4] != NULL ? value[4] : model->ron;
    return check_model(reader, place, model);
}
