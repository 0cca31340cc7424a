/* measure_card.c - .meas: what is measured, where, between which times. */
#include "measure_reading.h"

#include <math.h>
#include <string.h>

static const char USAGE[] =
    ".meas tran name AVG|RMS|MIN|MAX|PP|INTEG|MIN_AT|MAX_AT formula [FROM= TO=], "
    "FIND|DERIV formula AT=|WHEN ..., WHEN a=b, TRIG ... TARG ..., PARAM='formula'";

static const struct {
    const char *name;
    enum dalcs_measure_kind kind;
} KINDS[] = {{"avg", DALCS_MEASURE_AVERAGE},
             {"rms", DALCS_MEASURE_RMS},
             {"integ", DALCS_MEASURE_INTEGRAL},
             {"integral", DALCS_MEASURE_INTEGRAL},
             {"min", DALCS_MEASURE_MIN},
             {"max", DALCS_MEASURE_MAX},
             {"pp", DALCS_MEASURE_PEAK_TO_PEAK},
             {"min_at", DALCS_MEASURE_MIN_AT},
             {"max_at", DALCS_MEASURE_MAX_AT},
             {"deriv", DALCS_MEASURE_DERIVATIVE},
             {"derivative", DALCS_MEASURE_DERIVATIVE},
             {"find", DALCS_MEASURE_FIND},
             {"when", DALCS_MEASURE_WHEN},
             {"trig", DALCS_MEASURE_DELAY},
             {"param", DALCS_MEASURE_PARAM},
             {"eqn", DALCS_MEASURE_PARAM}};

enum { N_KINDS = sizeof KINDS / sizeof KINDS[0] };

/* ---- Kinds ----------------------------------------------------------------------------------- */

/* TRIG ... TARG ..., after the word TRIG. */
static bool read_interval(struct dalcs_measure_reading *r) {
    struct dalcs_measure_instant *instant = r->measure->instant;
    if (!dalcs_measure_read_instant(r, &instant[0])) {
        return false;
    }
    if (!dalcs_reader_take_word(&r->reader, "targ")) {
        dalcs_reader_missing(&r->reader, "TARG");
        return false;
    }
    return dalcs_measure_read_instant(r, &instant[1]);
}

/* Parameters for optimizers, and for the printing of Xyce. */
static bool take_ignored(struct dalcs_measure_reading *r) {
    static const char *const names[] = {"goal",      "minval",      "weight",
                                        "failvalue", "default_val", "precision"};
    bool taken = false;
    for (size_t k = 0; k < sizeof names / sizeof names[0] && !taken; k++) {
        taken = dalcs_measure_take(r, names[k]);
    }
    return taken;
}

/* FROM=, TO= and, for statistics, TRIG ... TARG; then nothing more. */
static bool read_bounds(struct dalcs_measure_reading *r) {
    struct dalcs_measure_card *m = r->measure;
    const bool is_statistic = m->kind <= DALCS_MEASURE_MAX_AT;
    while (!dalcs_reader_at_end(&r->reader)) {
        const struct dalcs_token *token = dalcs_reader_peek(&r->reader, 0);
        if (dalcs_measure_take(r, "from") || (is_statistic && dalcs_measure_take(r, "td"))) {
            if (!dalcs_measure_read_time(r, &m->from, &m->from_formula)) {
                return false;
            }
        } else if (dalcs_measure_take(r, "to")) {
            if (!dalcs_measure_read_time(r, &m->to, &m->to_formula)) {
                return false;
            }
        } else if (take_ignored(r)) {
            double unused;
            dalcs_builder_note(r->builder, token, NULL,
                               "%s= of a measurement has no meaning here and is ignored",
                               token->text);
            if (!dalcs_measure_read_constant(r, "a value", &unused)) {
                return false;
            }
        } else if (is_statistic && m->instant[0].kind == DALCS_INSTANT_NONE &&
                   dalcs_reader_take_word(&r->reader, "trig")) {
            if (!read_interval(r)) {
                return false;
            }
            for (int k = 0; k < 2; k++) {
                if (m->instant[k].kind == DALCS_INSTANT_CROSSING && m->instant[k].count == 0) {
                    dalcs_builder_error(r->builder, token, "measure TRIG and TARG by themselves",
                                        "LAST cannot bound this: it is not known before the end");
                    return false;
                }
            }
        } else {
            dalcs_reader_unexpected(&r->reader);
            return false;
        }
    }
    if (m->from >= m->to) {
        dalcs_builder_error(r->builder, dalcs_reader_previous(&r->reader), NULL,
                            "FROM=%g does not come before TO=%g", m->from, m->to);
        return false;
    }
    return true;
}

/* FIND formula AT=time or WHEN condition; at an operating point there is no need of them. */
static bool read_place(struct dalcs_measure_reading *r) {
    struct dalcs_measure_card *m = r->measure;
    if (dalcs_reader_take_word(&r->reader, "when")) {
        return dalcs_measure_read_condition(r, &m->instant[0]);
    }
    if (dalcs_measure_take(r, "at")) {
        m->instant[0].kind = DALCS_INSTANT_AT;
        return dalcs_measure_read_time(r, &m->instant[0].at, &m->instant[0].at_formula);
    }
    if (m->analysis == DALCS_MEASURED_OP && m->kind == DALCS_MEASURE_FIND) {
        return true;
    }
    dalcs_reader_missing(&r->reader, "WHEN or AT=");
    return false;
}

/* `time WHEN v(out)=1` and `v(out)*2 AT=1m`, without FIND, as LTspice has them: no kind, and a place behind it. */
static bool is_found(const struct dalcs_measure_reading *r) {
    const struct dalcs_token *token = dalcs_reader_peek(&r->reader, 0);
    const struct dalcs_token *next = dalcs_reader_peek(&r->reader, 1);
    const int end = dalcs_measure_formula_end(r->card, r->reader.at, false);
    const bool starts_formula = token->kind == DALCS_TOKEN_EXPRESSION ||
                                (next != NULL && next->kind == DALCS_TOKEN_OPEN) ||
                                end == r->reader.at + 1;
    return starts_formula && end < r->card->n &&
           (dalcs_token_is_word(&r->card->token[end], "when") ||
            dalcs_token_is_word(&r->card->token[end], "at"));
}

static bool read_kind(struct dalcs_measure_reading *r) {
    struct dalcs_measure_card *m = r->measure;
    const struct dalcs_token *token = dalcs_reader_peek(&r->reader, 0);
    int k = 0;
    while (token != NULL && k < N_KINDS && !dalcs_reader_take_word(&r->reader, KINDS[k].name)) {
        k++;
    }
    if (token == NULL) {
        dalcs_reader_missing(&r->reader, "what to measure");
        return false;
    }
    if (k == N_KINDS && is_found(r)) {
        m->kind = DALCS_MEASURE_FIND;
        return true;
    }
    if (k == N_KINDS && strncmp(token->text, "err", 3) == 0) {
        dalcs_builder_error(r->builder, token, "write RMS of a difference, or run `dalcs compare`",
                            "an error against data ('%s') is not measured", token->text);
        return false;
    }
    if (k == N_KINDS) {
        const char *name[N_KINDS];
        for (int i = 0; i < N_KINDS; i++) {
            name[i] = KINDS[i].name;
        }
        dalcs_builder_error(r->builder, token,
                            dalcs_builder_suggest_of(r->builder, name, N_KINDS, token->text, USAGE),
                            "'%s' cannot be measured", token->text);
        return false;
    }
    m->kind = KINDS[k].kind;
    return true;
}

static bool read_measurement(struct dalcs_measure_reading *r) {
    struct dalcs_measure_card *m = r->measure;
    if (!read_kind(r)) {
        return false;
    }
    switch (m->kind) {
    case DALCS_MEASURE_WHEN:
        return dalcs_measure_read_condition(r, &m->instant[0]) && read_bounds(r);
    case DALCS_MEASURE_DELAY:
        return read_interval(r) && read_bounds(r);
    case DALCS_MEASURE_PARAM: {
        const struct dalcs_signal_formula_rules rules = {
            .variable = "",
            .no_signals = "PARAM is computed from measurements; FIND takes signals",
            .results = &r->builder->results.measure_names};
        dalcs_reader_take(&r->reader, DALCS_TOKEN_EQUAL);
        return dalcs_measure_read_formula(r, false, "a formula", &rules, &m->formula) &&
               read_bounds(r);
    }
    default:
        if (!dalcs_measure_read_formula(r, false, "a formula", &r->rules, &m->formula)) {
            return false;
        }
        return (m->kind < DALCS_MEASURE_DERIVATIVE || read_place(r)) && read_bounds(r);
    }
}

static bool needs_results(const struct dalcs_measure_card *m) {
    bool needs = m->formula.has_results || m->from_formula.has_results || m->to_formula.has_results;
    for (int k = 0; k < 2; k++) {
        const struct dalcs_measure_instant *i = &m->instant[k];
        needs = needs || i->at_formula.has_results || i->delay_formula.has_results ||
                i->difference.has_results;
    }
    return needs;
}

/* ---- The card -------------------------------------------------------------------------------- */

/* `tran` and the like, which LTspice lets people leave out. */
static enum dalcs_measured_analysis read_analysis(struct dalcs_measure_reading *r) {
    static const char *const names[] = {[DALCS_MEASURED_TRAN] = "tran",
                                        [DALCS_MEASURED_OP] = "op",
                                        [DALCS_MEASURED_DC] = "dc",
                                        [DALCS_MEASURED_AC] = "ac",
                                        [DALCS_MEASURED_PSS] = "pss"};
    const struct dalcs_token *next = dalcs_reader_peek(&r->reader, 1);
    for (int k = 0; next != NULL && k <= DALCS_MEASURED_PSS; k++) {
        if (dalcs_reader_take_word(&r->reader, names[k])) {
            return (enum dalcs_measured_analysis)k;
        }
    }
    return r->builder->analyses.tran != NULL  ? DALCS_MEASURED_TRAN
           : r->builder->analyses.op != NULL  ? DALCS_MEASURED_OP
           : r->builder->analyses.pss != NULL ? DALCS_MEASURED_PSS
           : r->builder->analyses.ac != NULL  ? DALCS_MEASURED_AC
           : r->builder->analyses.dc != NULL  ? DALCS_MEASURED_DC
                                              : DALCS_MEASURED_TRAN;
}

static bool is_run(const struct dalcs_builder *builder, enum dalcs_measured_analysis analysis) {
    switch (analysis) {
    case DALCS_MEASURED_TRAN:
        return builder->analyses.tran != NULL;
    case DALCS_MEASURED_OP:
        return builder->analyses.op != NULL;
    case DALCS_MEASURED_DC:
        return builder->analyses.dc != NULL;
    case DALCS_MEASURED_PSS:
        return builder->analyses.pss != NULL || builder->netlist->asks.steady;
    default:
        return builder->analyses.ac != NULL;
    }
}

/* `.meas noise x INTEG ...`: of an analysis that is not here, and not a measurement that is called noise. */
static bool is_of_other_analysis(const struct dalcs_card *card) {
    static const char *const analyses[] = {"noise", "sp",   "four", "pz",
                                           "disto", "sens", "tf",   "hb"};
    bool is = card->n > 3 && dalcs_builder_is_one_of(card->token[1].text, analyses,
                                                     sizeof analyses / sizeof analyses[0]);
    for (int k = 0; k < N_KINDS && is; k++) {
        is = strcmp(card->token[2].text, KINDS[k].name) != 0;
    }
    return is;
}

/* The card, whose name is first; false: it has none, or its analysis is not run. */
static bool read_card(struct dalcs_measure_reading *r) {
    struct dalcs_builder *builder = r->builder;
    struct dalcs_measure_card *measure = r->measure;
    const struct dalcs_diag_mark mark = dalcs_diag_mark(builder->diag);
    const bool failed = builder->failed;
    const bool had_errors = builder->deck->has_errors;
    const struct dalcs_token *name;
    measure->analysis = read_analysis(r);
    r->rules.variable = measure->analysis == DALCS_MEASURED_AC ? "frequency" : "time";
    r->rules.results = &builder->results.measure_names;
    bool is_read = dalcs_reader_name(&r->reader, "a name", &name);
    if (is_read) {
        measure->where = dalcs_builder_keep_location(builder, name);
        measure->name = dalcs_arena_copy(&builder->circuit->arena, name->text, strlen(name->text));
        if (!dalcs_builder_note_memory(builder, measure->name != NULL)) {
            return false;
        }
        is_read = read_measurement(r);
    }
    if (builder->deck->has_errors != had_errors) { /* of a .func */
        return false;
    }
    builder->failed = failed;
    if (measure->name != NULL && !is_run(builder, measure->analysis)) {
        dalcs_diag_forget(builder->diag, &mark);
        dalcs_builder_note(builder, r->card->token, NULL,
                           "there is no such analysis: this measurement is left out");
        return false;
    }
    measure->is_late = is_read && measure->kind != DALCS_MEASURE_PARAM && needs_results(measure);
    if (!is_read) {
        dalcs_measure_give_up(r, &mark);
    }
    return measure->name != NULL;
}

void dalcs_measure_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_measure_card measure = {
        .from = -INFINITY,
        .to = INFINITY,
        .instant = {{.count = 1, .delay = -INFINITY}, {.count = 1, .delay = -INFINITY}}};
    struct dalcs_measure_reading r = {.builder = builder,
                                      .card = card,
                                      .reader = dalcs_reader_start(builder, card, USAGE),
                                      .measure = &measure};
    if (is_of_other_analysis(card)) {
        dalcs_builder_note(builder, &card->token[1], NULL,
                           "dalcs has no such analysis: this measurement is left out");
        return;
    }
    if (!read_card(&r)) {
        return;
    }
    /* Of two with one name both are printed, and the second counts for those after it, as in ngspice. */
    if (dalcs_names_set(&builder->results.measure_names, measure.name,
                        (int)builder->results.n_measures) != DALCS_OK ||
        dalcs_grow(&builder->results.measure, &builder->results.measure_capacity,
                   builder->results.n_measures + 1, sizeof *builder->results.measure) != DALCS_OK) {
        builder->out_of_memory = true;
        return;
    }
    builder->results.measure[builder->results.n_measures++] = measure;
}
