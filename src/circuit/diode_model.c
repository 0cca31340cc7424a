/* diode_model.c - .model cards of diodes, and the idealised ones.
 *
 * An idealised diode (LTspice) is three lines, anchored at Vfwd and -Vrev: slope 1/Roff between them,
 * 1/Ron above, 1/Rrev below. What is left out is ideal: Ron = 0, Roff infinite, Vfwd = 0, no
 * breakdown. LTspice's rounded knees and limits become sharp ones. */
#include "diode_model.h"

#include <math.h>
#include <string.h>

static const char MODEL_USAGE[] =
    "a diode model is: .model name D [(Ron=ohms Roff=ohms Vfwd=volts Vrev=volts Rrev=ohms)]";

/* Reports a parameter that a diode does not have; false for one that means nothing. */
static bool report_parameter(struct dalcs_reader *reader, const struct dalcs_token *name) {
    static const char *const ours[] = {"ron",  "roff",   "vfwd",      "vrev",
                                       "rrev", "ilimit", "revilimit", "epsilon"};
    if (dalcs_builder_is_label(name->text) || dalcs_diode_is_ignored(name->text)) {
        return false;
    }
    dalcs_builder_error(reader->builder, name,
                        dalcs_builder_suggest_of(reader->builder, ours,
                                                 sizeof ours / sizeof ours[0], name->text,
                                                 MODEL_USAGE),
                        "a diode model has no parameter '%s'", name->text);
    return true;
}

/* ---- The idealised diode ------------------------------------------------------------------- */

/* Conducts both ways alike from 0 V on, as macromodels of LTspice have it to limit a current: a resistor. */
static bool is_resistor(const struct dalcs_parameter *p) {
    return p[DALCS_DIODE_VREV].value == 0 && p[DALCS_DIODE_VFWD].value == 0 &&
           p[DALCS_DIODE_RON].value == p[DALCS_DIODE_RREV].value &&
           p[DALCS_DIODE_EPSILON].value == 0 && p[DALCS_DIODE_REVEPSILON].value == 0;
}

static bool check_ideal(struct dalcs_builder *builder, const struct dalcs_parameter *p) {
    if (p[DALCS_DIODE_RON].value < 0) {
        dalcs_builder_error(builder, p[DALCS_DIODE_RON].place, NULL, "Ron cannot be negative");
        return false;
    }
    if (p[DALCS_DIODE_ROFF].value <= 0) {
        dalcs_builder_error(builder, p[DALCS_DIODE_ROFF].place,
                            "leave Roff out for a diode without leakage", "Roff must be positive");
        return false;
    }
    const double forward = p[DALCS_DIODE_VFWD].value;
    const double back = p[DALCS_DIODE_VREV].value;
    if ((back == 0 || (back < 0 && forward <= -back)) && !is_resistor(p)) {
        dalcs_builder_error(builder, p[DALCS_DIODE_VREV].place,
                            "Vrev is the magnitude of the breakdown voltage; leave it out for none",
                            "Vrev must be positive");
        return false;
    }
    if (forward <= -back && !is_resistor(p)) {
        dalcs_builder_error(builder, p[DALCS_DIODE_VFWD].place, NULL,
                            "Vfwd is not above the breakdown at -Vrev");
        return false;
    }
    if (p[DALCS_DIODE_RREV].value < 0) {
        dalcs_builder_error(builder, p[DALCS_DIODE_RREV].place, NULL, "Rrev cannot be negative");
        return false;
    }
    double largest =
        fmax(p[DALCS_DIODE_RON].value, p[DALCS_DIODE_VREV].place ? p[DALCS_DIODE_RREV].value : 0.0);
    if (p[DALCS_DIODE_ROFF].value <= largest) {
        dalcs_builder_error(builder, p[DALCS_DIODE_ROFF].place,
                            "leave Roff out for a diode without leakage",
                            "Roff must be above Ron and Rrev: what conducts more when off is no "
                            "diode");
        return false;
    }
    for (int k = DALCS_DIODE_ILIMIT; k <= DALCS_DIODE_REVEPSILON; k++) {
        const bool may_be_zero = k == DALCS_DIODE_EPSILON || k == DALCS_DIODE_REVEPSILON;
        if (p[k].value < 0 || (p[k].value == 0 && !may_be_zero)) {
            dalcs_builder_error(builder, p[k].place, "leave it out for none",
                                may_be_zero ? "'%s' cannot be negative" : "'%s' must be positive",
                                p[k].name);
            return false;
        }
    }
    return true;
}

/* A knee that LTspice rounds over epsilon volts: half way, the line beyond it begins. Within, the
 * parabola v^2 / (2 epsilon R) is above a current of 0 and that line by epsilon / (8 R) at most. */
static void sharpen(struct dalcs_builder *builder, const struct dalcs_parameter *epsilon,
                    const char *knee, double resistance, double *volts) {
    if (epsilon->value == 0) {
        return;
    }
    *volts += epsilon->value / 2;
    if (resistance > 0) {
        dalcs_builder_note(builder, epsilon->place, NULL,
                           "a knee rounded over %g V is a sharp one here, with %s = %g V: within "
                           "these volts the current is lower by up to %.3g A",
                           epsilon->value, knee, *volts, epsilon->value / (8 * resistance));
    } else {
        dalcs_builder_note(builder, epsilon->place, NULL,
                           "a knee rounded over %g V is a sharp one here, with %s = %g V",
                           epsilon->value, knee, *volts);
    }
}

static void note_limit(struct dalcs_builder *builder, const struct dalcs_parameter *limit) {
    if (isfinite(limit->value)) {
        dalcs_builder_note(builder, limit->place, NULL,
                           "the current is cut off at %g A where LTspice rounds with a tanh: it is "
                           "higher here by up to %.3g A, 24 %% of the limit",
                           limit->value, (1 - tanh(1)) * limit->value);
    }
}

/* LTspice's idealised diode has Vrev; a BV beside it is read by nobody. */
static void warn_of_breakdown(struct dalcs_builder *builder, const struct dalcs_parameter *bv,
                              const struct dalcs_parameter *vrev) {
    if (bv->place != NULL && isfinite(bv->value) && vrev->place == NULL) {
        dalcs_builder_warn(builder, bv->place,
                           dalcs_builder_hint(builder, "write Vrev=%g in place of it", bv->value),
                           "an idealised diode (LTspice) breaks down at Vrev, not at '%s'",
                           bv->name);
    }
}

static bool set_ideal(struct dalcs_builder *builder, struct dalcs_parameter *p,
                      struct dalcs_diode_card *card, struct dalcs_diode_model *model) {
    if (p[DALCS_DIODE_RREV].place == NULL) {
        p[DALCS_DIODE_RREV].value = p[DALCS_DIODE_RON].value;
    }
    if (!check_ideal(builder, p)) {
        return false;
    }
    model->ron = p[DALCS_DIODE_RON].value;
    model->roff = p[DALCS_DIODE_ROFF].value;
    model->vfwd = p[DALCS_DIODE_VFWD].value;
    model->vrev = p[DALCS_DIODE_VREV].value;
    model->rrev = p[DALCS_DIODE_RREV].value;
    card->ilimit = p[DALCS_DIODE_ILIMIT].value;
    card->revilimit = p[DALCS_DIODE_REVILIMIT].value;
    sharpen(builder, &p[DALCS_DIODE_EPSILON], "Vfwd", model->ron, &model->vfwd);
    if (model->vrev < 0) {
        dalcs_builder_warn(builder, p[DALCS_DIODE_VREV].place,
                           "Vrev is the magnitude of the breakdown voltage",
                           "a diode that breaks down at %g V conducts backwards below that, and "
                           "delivers power from 0 V on",
                           -model->vrev);
    }
    if (isfinite(model->vrev)) {
        sharpen(builder, &p[DALCS_DIODE_REVEPSILON], "Vrev", model->rrev, &model->vrev);
    }
    note_limit(builder, &p[DALCS_DIODE_ILIMIT]);
    note_limit(builder, &p[DALCS_DIODE_REVILIMIT]);
    return true;
}

/* ---- The card ------------------------------------------------------------------------------ */

/* Does the card have one of parameter[first..last]? */
static bool has(const struct dalcs_parameter *p, int first, int last) {
    bool found = false;
    for (int k = first; k <= last; k++) {
        found = found || p[k].place != NULL;
    }
    return found;
}

/* .model name D, .model name D() */
static bool is_bare(const struct dalcs_card *card, const struct dalcs_token *type) {
    bool is_bare = true;
    for (const struct dalcs_token *t = type + 1; t < card->token + card->n; t++) {
        is_bare = is_bare && (t->kind == DALCS_TOKEN_OPEN || t->kind == DALCS_TOKEN_CLOSE);
    }
    return is_bare;
}

/* What a model has where it says nothing. */
static void set_defaults(struct dalcs_parameter parameter[DALCS_DIODE_N_PARAMETERS]) {
    const double infinite = (double)INFINITY;
    const struct dalcs_parameter own[DALCS_DIODE_N_PARAMETERS] = {
        [DALCS_DIODE_RON] = {"ron", DALCS_OHM, false, 0, NULL},
        [DALCS_DIODE_ROFF] = {"roff", DALCS_OHM, true, infinite, NULL},
        [DALCS_DIODE_VFWD] = {"vfwd", DALCS_VOLTAGE, false, 0, NULL},
        [DALCS_DIODE_VREV] = {"vrev", DALCS_VOLTAGE, true, infinite, NULL},
        [DALCS_DIODE_RREV] = {"rrev", DALCS_OHM, false, 0, NULL},
        [DALCS_DIODE_ILIMIT] = {"ilimit", DALCS_CURRENT, true, infinite, NULL},
        [DALCS_DIODE_REVILIMIT] = {"revilimit", DALCS_CURRENT, true, infinite, NULL},
        [DALCS_DIODE_EPSILON] = {"epsilon", DALCS_VOLTAGE, false, 0, NULL},
        [DALCS_DIODE_REVEPSILON] = {"revepsilon", DALCS_VOLTAGE, false, 0, NULL},
        [DALCS_DIODE_IS] = {"is", DALCS_CURRENT, false, 1e-14, NULL},
        [DALCS_DIODE_JS] = {"js", DALCS_CURRENT, false, 1e-14, NULL},
        [DALCS_DIODE_N] = {"n", DALCS_PLAIN, false, 1, NULL},
        [DALCS_DIODE_RS] = {"rs", DALCS_OHM, false, 0, NULL},
        [DALCS_DIODE_BV] = {"bv", DALCS_VOLTAGE, true, infinite, NULL},
        [DALCS_DIODE_IBV] = {"ibv", DALCS_CURRENT, false, 1e-3, NULL},
        [DALCS_DIODE_NBV] = {"nbv", DALCS_PLAIN, false, 1, NULL},
        [DALCS_DIODE_VB] = {"vb", DALCS_VOLTAGE, true, infinite, NULL},
        [DALCS_DIODE_VRB] = {"vrb", DALCS_VOLTAGE, true, infinite, NULL},
        [DALCS_DIODE_IB] = {"ib", DALCS_CURRENT, false, 1e-3, NULL},
    };
    memcpy(parameter, own, sizeof own);
}

bool dalcs_diode_parse_model(struct dalcs_reader *reader, const struct dalcs_token *type,
                             struct dalcs_diode_card *card, struct dalcs_diode_model *model) {
    struct dalcs_builder *builder = reader->builder;
    struct dalcs_parameter parameter[DALCS_DIODE_N_PARAMETERS];
    set_defaults(parameter);
    reader->usage = MODEL_USAGE;
    card->ilimit = card->revilimit = (double)INFINITY;
    if (!dalcs_model_read_parameters(reader, parameter, DALCS_DIODE_N_PARAMETERS,
                                     report_parameter)) {
        return false;
    }
    const bool is_block = strcmp(type->text, "sidiode") == 0;
    const bool is_ideal = is_block || has(parameter, DALCS_DIODE_RON, DALCS_DIODE_REVEPSILON);
    const char *ignored = dalcs_diode_ignored_text(builder, reader->card, parameter, is_ideal);
    if (!is_ideal &&
        (has(parameter, DALCS_DIODE_FIRST_BERKELEY, DALCS_DIODE_IB) || ignored[0] != '\0')) {
        return dalcs_diode_set_berkeley(reader, type, parameter, card, model);
    }
    if (!is_block && is_bare(reader->card, type)) {
        dalcs_diode_note_bare(builder, type);
    }
    if (ignored[0] != '\0') {
        dalcs_builder_note(builder, type, NULL, "an idealised diode (LTspice)%s", ignored);
    }
    warn_of_breakdown(builder, &parameter[DALCS_DIODE_BV], &parameter[DALCS_DIODE_VREV]);
    if (is_block && parameter[DALCS_DIODE_ROFF].place == NULL) {
        dalcs_builder_note(builder, type, NULL,
                           "a sidiode follows LTspice's idealised diode here: without Roff it does "
                           "not leak (in ngspice it is 1 ohm)");
    }
    return set_ideal(builder, parameter, card, model);
}
