/* diode_model.c - .model cards of diodes.
 *
 * An idealised diode (LTspice) is three lines, anchored at Vfwd and -Vrev: slope 1/Roff between them,
 * 1/Ron above, 1/Rrev below. What is left out is ideal: Ron = 0, Roff infinite, Vfwd = 0, no
 * breakdown. LTspice's rounded knees and limits become sharp ones.
 *
 * An exponential diode (Berkeley) becomes one of these, its tangent at one current: with
 * V = N Vt ln(1 + I/IS) + RS I, Ron is dV/dI and Vfwd what is left of V there. What changes by any of
 * this is said in a note, in numbers. */
#include "diode_parts.h"
#include "model_cards.h"
#include "reader.h"

#include <math.h>
#include <string.h>

static const char MODEL_USAGE[] =
    "a diode model is: .model name D [(Ron=ohms Roff=ohms Vfwd=volts Vrev=volts Rrev=ohms)]";

/* k T / q at SPICE's 27 degrees. */
static const double THERMAL_VOLTAGE = 300.15 * 1.380649e-23 / 1.602176634e-19;

/* An N up to this means an ideal diode: no junction has one. */
static const double IDEAL_EMISSION = 0.05;

enum {
    RON,
    ROFF,
    VFWD,
    VREV,
    RREV,
    ILIMIT,
    REVILIMIT,
    EPSILON,
    REVEPSILON,
    IS,
    JS,
    N,
    RS,
    BV,
    IBV,
    NBV,
    VB,  /* other names: of BV in PSpice and Xyce, */
    VRB, /* in HSPICE, */
    IB,  /* and of IBV there */
    N_PARAMETERS
};

enum { FIRST_BERKELEY = IS, MOST_IGNORED = 16 /* that a note names */ };

/* Of the exponential diode, without a counterpart here. */
static const char *const IGNORED[] = {
    "jsw",   "ns",     "ibvl",   "nbvl",   "cjo",    "cj0",    "cj",     "cjp",   "vj",
    "pb",    "m",      "mj",     "fc",     "fcs",    "tt",     "eg",     "xti",   "kf",
    "af",    "ik",     "ikf",    "ikr",    "isr",    "nr",     "tbv",    "tbv1",  "tbv2",
    "trs",   "trs1",   "trs2",   "tikf",   "tnom",   "tref",   "vp",     "level", "area",
    "rsw",   "tcv",    "cta",    "vjsw",   "php",    "mjsw",   "cjsw",   "ctp",   "tlev",
    "tlevc", "tm1",    "tm2",    "ttt1",   "ttt2",   "w",      "l",      "pj",    "rth0",
    "cth0",  "fv_max", "bv_max", "id_max", "te_max", "pd_max", "expli",  "dcap",  "shrink",
    "tc1",   "tc2",    "tpb",    "tphp",   "tvj",    "jtun",   "jtunsw", "ntun",  "xtitun",
    "keg",   "lm",     "lp",     "wm",     "wp",     "xom",    "xoi",    "xm",    "xp"};

/* Reports a parameter that a diode does not have; false for one that means nothing. */
static bool report_parameter(struct dalcs_reader *reader, const struct dalcs_token *name) {
    static const char *const ours[] = {"ron",  "roff",   "vfwd",      "vrev",
                                       "rrev", "ilimit", "revilimit", "epsilon"};
    if (dalcs_builder_is_label(name->text) ||
        dalcs_builder_is_one_of(name->text, IGNORED, sizeof IGNORED / sizeof IGNORED[0])) {
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
    return p[VREV].value == 0 && p[VFWD].value == 0 && p[RON].value == p[RREV].value &&
           p[EPSILON].value == 0 && p[REVEPSILON].value == 0;
}

static bool check_ideal(struct dalcs_builder *builder, const struct dalcs_parameter *p) {
    if (p[RON].value < 0) {
        dalcs_builder_error(builder, p[RON].place, NULL, "Ron cannot be negative");
        return false;
    }
    if (p[ROFF].value <= 0) {
        dalcs_builder_error(builder, p[ROFF].place, "leave Roff out for a diode without leakage",
                            "Roff must be positive");
        return false;
    }
    if (p[VREV].value <= 0 && !is_resistor(p)) {
        dalcs_builder_error(builder, p[VREV].place,
                            "Vrev is the magnitude of the breakdown voltage; leave it out for none",
                            "Vrev must be positive");
        return false;
    }
    if (p[VFWD].value <= -p[VREV].value && !is_resistor(p)) {
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
    for (int k = ILIMIT; k <= REVEPSILON; k++) {
        const bool may_be_zero = k == EPSILON || k == REVEPSILON;
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

static bool set_ideal(struct dalcs_builder *builder, struct dalcs_parameter *p,
                      struct dalcs_diode_card *card, struct dalcs_diode_model *model) {
    if (p[RREV].place == NULL) {
        p[RREV].value = p[RON].value;
    }
    if (!check_ideal(builder, p)) {
        return false;
    }
    model->ron = p[RON].value;
    model->roff = p[ROFF].value;
    model->vfwd = p[VFWD].value;
    model->vrev = p[VREV].value;
    model->rrev = p[RREV].value;
    card->ilimit = p[ILIMIT].value;
    card->revilimit = p[REVILIMIT].value;
    sharpen(builder, &p[EPSILON], "Vfwd", model->ron, &model->vfwd);
    if (isfinite(model->vrev)) {
        sharpen(builder, &p[REVEPSILON], "Vrev", model->rrev, &model->vrev);
    }
    note_limit(builder, &p[ILIMIT]);
    note_limit(builder, &p[REVILIMIT]);
    return true;
}

/* ---- The exponential diode ----------------------------------------------------------------- */

void dalcs_diode_cells(struct dalcs_diode_card *card, double cells) {
    card->emission *= cells;
    card->resistance *= cells;
    card->breakdown *= cells;
    card->back_emission *= cells;
}

double dalcs_exponential_voltage(const struct dalcs_exponential *diode, double current) {
    return diode->voltage * log1p(current / diode->saturation) + diode->series * current;
}

void dalcs_exponential_take(struct dalcs_diode_model *model, double at, double back_at) {
    struct dalcs_exponential *e = &model->exponential;
    e->at = at;
    e->back_at = back_at;
    if (e->voltage > 0) {
        const double slope = e->voltage / (at + e->saturation);
        model->ron = e->series + slope;
        model->vfwd = e->voltage * log1p(at / e->saturation) - slope * at;
    }
    if (e->back_voltage > 0) {
        const double knee =
            e->breakdown + e->back_voltage * (log(back_at / e->breakdown_current) - 1);
        model->vrev = knee > 0 ? knee : e->breakdown;
        model->rrev = e->series + e->back_voltage / back_at;
    }
}

void dalcs_diode_model_map(const struct dalcs_diode_card *card, double current, double area,
                           struct dalcs_diode_model *model) {
    const double series = card->resistance / area;
    const bool is_ideal = card->emission <= IDEAL_EMISSION;
    const bool breaks = isfinite(card->breakdown) && card->back_emission > IDEAL_EMISSION;
    model->roff = INFINITY;
    model->ron = series;
    model->vfwd = 0;
    model->vrev = card->breakdown;
    model->rrev = series;
    model->exponential = (struct dalcs_exponential){
        .saturation = card->saturation * area,
        .voltage = is_ideal ? 0 : card->emission * THERMAL_VOLTAGE,
        .series = series,
        .breakdown = card->breakdown,
        .back_voltage = breaks ? card->back_emission * THERMAL_VOLTAGE : 0,
        .breakdown_current = card->breakdown_current * area};
    dalcs_exponential_take(model, current, current);
}

bool dalcs_diode_take_part(struct dalcs_builder *builder, const struct dalcs_token *name,
                           struct dalcs_diode_card *card, struct dalcs_diode_model *model) {
    struct dalcs_diode_part part;
    if (!dalcs_diode_part_find(name->text, &part)) {
        return false;
    }
    const double *i = part.i;
    const double *v = part.v;
    const double nvt = dalcs_junction_emission(part.junction) * THERMAL_VOLTAGE;
    const double series = (v[1] - v[0] - nvt * log(i[1] / i[0])) / (i[1] - i[0]);
    *card = (struct dalcs_diode_card){.ilimit = (double)INFINITY,
                                      .revilimit = (double)INFINITY,
                                      .is_berkeley = true,
                                      .saturation = i[0] / expm1((v[0] - series * i[0]) / nvt),
                                      .emission = nvt / THERMAL_VOLTAGE,
                                      .resistance = series,
                                      .breakdown = part.breakdown,
                                      .breakdown_current = part.at,
                                      .back_emission = 1};
    dalcs_diode_model_map(card, builder->models.diode_current, 1, model);
    const bool is_zener = part.junction == DALCS_JUNCTION_ZENER;
    dalcs_builder_warn(
        builder, name, dalcs_builder_hint(builder, "add a line: .model %s D(...)", name->text),
        "model '%s' is not in the netlist: typical datasheet values of %s are used, %g V at %g A "
        "and %g V at %g A, %s %g V%s",
        name->text, dalcs_junction_text(part.junction), v[0], i[0], v[1], i[1],
        is_zener ? "Zener voltage" : "up to", part.breakdown,
        is_zener ? dalcs_builder_hint(builder, " at %.3g A", part.at) : " in reverse");
    return true;
}

static void note_bare(struct dalcs_builder *builder, const struct dalcs_token *place) {
    const struct dalcs_exponential spice = {.saturation = 1e-14, .voltage = THERMAL_VOLTAGE};
    dalcs_builder_note(builder, place, "D(IS=1e-14) is SPICE's, D(Ron=0) this one",
                       "a model without parameters is exactly ideal here; SPICE's default diode "
                       "would drop %.4g V at %g A",
                       dalcs_exponential_voltage(&spice, builder->models.diode_current),
                       builder->models.diode_current);
}

bool dalcs_diode_take_default(struct dalcs_builder *builder, const struct dalcs_token *name,
                              struct dalcs_diode_card *card, struct dalcs_diode_model *model) {
    *card = (struct dalcs_diode_card){.ilimit = (double)INFINITY, .revilimit = (double)INFINITY};
    *model = (struct dalcs_diode_model){.roff = (double)INFINITY, .vrev = (double)INFINITY};
    note_bare(builder, name);
    return true;
}

static bool check_berkeley(struct dalcs_builder *builder, struct dalcs_parameter *p) {
    static const int positive[] = {IS, JS, N, IBV, NBV};
    for (size_t k = 0; k < sizeof positive / sizeof positive[0]; k++) {
        const struct dalcs_parameter *parameter = &p[positive[k]];
        if (parameter->value <= 0) {
            dalcs_builder_error(builder, parameter->place, NULL, "'%s' must be positive",
                                parameter->name);
            return false;
        }
    }
    if (p[RS].value < 0 || p[BV].value < 0) {
        const struct dalcs_parameter *parameter = &p[p[RS].value < 0 ? RS : BV];
        dalcs_builder_error(builder, parameter->place, NULL, "'%s' cannot be negative",
                            parameter->name);
        return false;
    }
    if (p[BV].value == 0) {
        dalcs_builder_warn(builder, p[BV].place, NULL,
                           "a breakdown voltage of 0 V counts as no breakdown");
        p[BV].value = INFINITY;
    }
    return true;
}

/* "; cjo, tt are ignored" */
static const char *ignored_text(struct dalcs_builder *builder, const struct dalcs_card *card,
                                const struct dalcs_parameter *p, bool with_berkeley) {
    const char *list = NULL;
    int n = 0;
    /* behind .model, its name and its type */
    for (int k = 3; k + 1 < card->n && n < MOST_IGNORED; k++) {
        const char *name = card->token[k].text;
        bool is_ignored =
            dalcs_builder_is_one_of(name, IGNORED, sizeof IGNORED / sizeof IGNORED[0]);
        for (int j = FIRST_BERKELEY; with_berkeley && j < N_PARAMETERS; j++) {
            is_ignored = is_ignored || p[j].place == &card->token[k];
        }
        if (is_ignored && card->token[k - 1].kind != DALCS_TOKEN_EQUAL) {
            n++;
            list = list == NULL ? dalcs_builder_hint(builder, "%s", name)
                                : dalcs_builder_hint(builder, "%s, %s", list, name);
            if (list == NULL) {
                return "";
            }
        }
    }
    const char *text = list == NULL ? "" : dalcs_builder_hint(builder, "; ignored: %s", list);
    return text != NULL ? text : "";
}

static void note_mapping(struct dalcs_reader *reader, const struct dalcs_token *place,
                         const struct dalcs_diode_card *card, const struct dalcs_diode_model *model,
                         const char *ignored) {
    struct dalcs_builder *builder = reader->builder;
    const double at = builder->models.diode_current;
    const struct dalcs_exponential diode = {.saturation = card->saturation,
                                            .voltage = card->emission * THERMAL_VOLTAGE,
                                            .series = card->resistance};
    double above[3];
    for (int k = 0; k < 3; k++) {
        const double current = at * (k == 0 ? 0.1 : k == 1 ? 1 : 10);
        above[k] = model->vfwd + model->ron * current - dalcs_exponential_voltage(&diode, current);
    }
    if (card->emission <= IDEAL_EMISSION) {
        dalcs_builder_note(builder, place, NULL,
                           "an exponential diode with N = %g is taken for an ideal one with Ron = "
                           "%.4g ohm: at %g A its voltage is %.3g mV lower%s",
                           card->emission, model->ron, at, -1e3 * above[1], ignored);
        return;
    }
    const char *back = isfinite(model->vrev)
                           ? dalcs_builder_hint(builder, ", Vrev = %.4g V and Rrev = %.4g ohm",
                                                model->vrev, model->rrev)
                           : "";
    if (!builder->circuit->options.has_diode_current) {
        dalcs_builder_note(
            builder, place,
            ".options diodecurrent=amperes chooses the current, D(Ron=ohms Vfwd=volts) gives the "
            "line itself",
            "the exponential diode is replaced by its tangent at the current that it carries; "
            "at %g A that is Vfwd = %.4g V and Ron = %.4g ohm%s%s",
            at, model->vfwd, model->ron, back != NULL ? back : "", ignored);
        return;
    }
    dalcs_builder_note(
        builder, place,
        ".options diodecurrent=amperes chooses another point, D(Ron=ohms Vfwd=volts) "
        "another line",
        "the exponential diode is replaced by its tangent at %g A here, Vfwd = %.4g V and Ron = "
        "%.4g ohm%s: at %g A its voltage is %.3g mV higher, at %g A %.3g mV%s",
        at, model->vfwd, model->ron, back != NULL ? back : "", 0.1 * at, 1e3 * above[0], 10 * at,
        1e3 * above[2], ignored);
}

/* Other names of parameters. */
static void take_synonym(struct dalcs_parameter *p, int ours, int other) {
    if (p[ours].place == NULL && p[other].place != NULL) {
        p[ours].value = p[other].value;
        p[ours].place = p[other].place;
    }
}

static bool set_berkeley(struct dalcs_reader *reader, const struct dalcs_token *place,
                         struct dalcs_parameter *p, struct dalcs_diode_card *card,
                         struct dalcs_diode_model *model) {
    struct dalcs_builder *builder = reader->builder;
    take_synonym(p, BV, VB);
    take_synonym(p, BV, VRB);
    take_synonym(p, IBV, IB);
    take_synonym(p, IS, JS);
    if (!check_berkeley(builder, p)) {
        return false;
    }
    card->is_berkeley = true;
    card->saturation = p[IS].value;
    card->emission = p[N].value;
    card->resistance = p[RS].value;
    card->breakdown = p[BV].value;
    card->breakdown_current = p[IBV].value;
    card->back_emission = p[NBV].place != NULL ? p[NBV].value : p[N].value;
    dalcs_diode_model_map(card, builder->models.diode_current, 1, model);
    note_mapping(reader, place, card, model, ignored_text(builder, reader->card, p, false));
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

bool dalcs_diode_parse_model(struct dalcs_reader *reader, const struct dalcs_token *type,
                             struct dalcs_diode_card *card, struct dalcs_diode_model *model) {
    const double infinite = (double)INFINITY;
    struct dalcs_builder *builder = reader->builder;
    struct dalcs_parameter parameter[N_PARAMETERS] = {
        [RON] = {"ron", DALCS_OHM, false, 0, NULL},
        [ROFF] = {"roff", DALCS_OHM, true, infinite, NULL},
        [VFWD] = {"vfwd", DALCS_VOLTAGE, false, 0, NULL},
        [VREV] = {"vrev", DALCS_VOLTAGE, true, infinite, NULL},
        [RREV] = {"rrev", DALCS_OHM, false, 0, NULL},
        [ILIMIT] = {"ilimit", DALCS_CURRENT, true, infinite, NULL},
        [REVILIMIT] = {"revilimit", DALCS_CURRENT, true, infinite, NULL},
        [EPSILON] = {"epsilon", DALCS_VOLTAGE, false, 0, NULL},
        [REVEPSILON] = {"revepsilon", DALCS_VOLTAGE, false, 0, NULL},
        [IS] = {"is", DALCS_CURRENT, false, 1e-14, NULL},
        [JS] = {"js", DALCS_CURRENT, false, 1e-14, NULL},
        [N] = {"n", DALCS_PLAIN, false, 1, NULL},
        [RS] = {"rs", DALCS_OHM, false, 0, NULL},
        [BV] = {"bv", DALCS_VOLTAGE, true, infinite, NULL},
        [IBV] = {"ibv", DALCS_CURRENT, false, 1e-3, NULL},
        [NBV] = {"nbv", DALCS_PLAIN, false, 1, NULL},
        [VB] = {"vb", DALCS_VOLTAGE, true, infinite, NULL},
        [VRB] = {"vrb", DALCS_VOLTAGE, true, infinite, NULL},
        [IB] = {"ib", DALCS_CURRENT, false, 1e-3, NULL},
    };
    reader->usage = MODEL_USAGE;
    card->ilimit = card->revilimit = infinite;
    if (!dalcs_model_read_parameters(reader, parameter, N_PARAMETERS, report_parameter)) {
        return false;
    }
    const bool is_block = strcmp(type->text, "sidiode") == 0;
    const bool is_ideal = is_block || has(parameter, RON, REVEPSILON);
    const char *ignored = ignored_text(builder, reader->card, parameter, is_ideal);
    if (!is_ideal && (has(parameter, FIRST_BERKELEY, IB) || ignored[0] != '\0')) {
        return set_berkeley(reader, type, parameter, card, model);
    }
    if (!is_block && is_bare(reader->card, type)) {
        note_bare(builder, type);
    }
    if (ignored[0] != '\0') {
        dalcs_builder_note(builder, type, NULL, "an idealised diode (LTspice)%s", ignored);
    }
    if (is_block && parameter[ROFF].place == NULL) {
        dalcs_builder_note(builder, type, NULL,
                           "a sidiode follows LTspice's idealised diode here: without Roff it does "
                           "not leak (in ngspice it is 1 ohm)");
    }
    return set_ideal(builder, parameter, card, model);
}
