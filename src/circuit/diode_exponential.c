/* diode_exponential.c - Berkeley's diode and the idealised one that stands for it.
 *
 * An exponential diode becomes one of three lines, its tangent at one current: with
 * V = N Vt ln(1 + I/IS) + RS I, Ron is dV/dI and Vfwd what is left of V there. What changes by this is
 * said in a note, in numbers. */
#include "diode_model.h"

#include <math.h>

enum { MOST_IGNORED = 16 /* that a note names */ };

/* k T / q at SPICE's 27 degrees. */
static const double THERMAL_VOLTAGE = 300.15 * 1.380649e-23 / 1.602176634e-19;

/* An N up to this means an ideal diode: no junction has one. */
static const double IDEAL_EMISSION = 0.05;

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

bool dalcs_diode_is_ignored(const char *name) {
    return dalcs_builder_is_one_of(name, IGNORED, sizeof IGNORED / sizeof IGNORED[0]);
}

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

void dalcs_diode_note_bare(struct dalcs_builder *builder, const struct dalcs_token *place) {
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
    dalcs_diode_note_bare(builder, name);
    return true;
}

static bool check_berkeley(struct dalcs_builder *builder, struct dalcs_parameter *p) {
    static const int positive[] = {DALCS_DIODE_IS, DALCS_DIODE_JS, DALCS_DIODE_N, DALCS_DIODE_IBV,
                                   DALCS_DIODE_NBV};
    for (size_t k = 0; k < sizeof positive / sizeof positive[0]; k++) {
        const struct dalcs_parameter *parameter = &p[positive[k]];
        if (parameter->value <= 0) {
            dalcs_builder_error(builder, parameter->place, NULL, "'%s' must be positive",
                                parameter->name);
            return false;
        }
    }
    if (p[DALCS_DIODE_RS].value < 0 || p[DALCS_DIODE_BV].value < 0) {
        const struct dalcs_parameter *parameter =
            &p[p[DALCS_DIODE_RS].value < 0 ? DALCS_DIODE_RS : DALCS_DIODE_BV];
        dalcs_builder_error(builder, parameter->place, NULL, "'%s' cannot be negative",
                            parameter->name);
        return false;
    }
    if (p[DALCS_DIODE_BV].value == 0) {
        dalcs_builder_warn(builder, p[DALCS_DIODE_BV].place, NULL,
                           "a breakdown voltage of 0 V counts as no breakdown");
        p[DALCS_DIODE_BV].value = INFINITY;
    }
    return true;
}

const char *dalcs_diode_ignored_text(struct dalcs_builder *builder, const struct dalcs_card *card,
                                     const struct dalcs_parameter *p, bool with_berkeley) {
    const char *list = NULL;
    int n = 0;
    /* behind .model, its name and its type */
    for (int k = 3; k + 1 < card->n && n < MOST_IGNORED; k++) {
        const char *name = card->token[k].text;
        bool is_ignored = dalcs_diode_is_ignored(name);
        for (int j = DALCS_DIODE_FIRST_BERKELEY; with_berkeley && j < DALCS_DIODE_N_PARAMETERS;
             j++) {
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

bool dalcs_diode_set_berkeley(struct dalcs_reader *reader, const struct dalcs_token *place,
                              struct dalcs_parameter *p, struct dalcs_diode_card *card,
                              struct dalcs_diode_model *model) {
    struct dalcs_builder *builder = reader->builder;
    take_synonym(p, DALCS_DIODE_BV, DALCS_DIODE_VB);
    take_synonym(p, DALCS_DIODE_BV, DALCS_DIODE_VRB);
    take_synonym(p, DALCS_DIODE_IBV, DALCS_DIODE_IB);
    take_synonym(p, DALCS_DIODE_IS, DALCS_DIODE_JS);
    if (!check_berkeley(builder, p)) {
        return false;
    }
    card->is_berkeley = true;
    card->saturation = p[DALCS_DIODE_IS].value;
    card->emission = p[DALCS_DIODE_N].value;
    card->resistance = p[DALCS_DIODE_RS].value;
    card->breakdown = p[DALCS_DIODE_BV].value;
    card->breakdown_current = p[DALCS_DIODE_IBV].value;
    card->back_emission =
        p[DALCS_DIODE_NBV].place != NULL ? p[DALCS_DIODE_NBV].value : p[DALCS_DIODE_N].value;
    dalcs_diode_model_map(card, builder->models.diode_current, 1, model);
    note_mapping(reader, place, card, model,
                 dalcs_diode_ignored_text(builder, reader->card, p, false));
    return true;
}
