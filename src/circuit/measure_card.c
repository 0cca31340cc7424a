/* measure_card.c - .meas: what is measured, where, between which times.
 *
 * Formulas end where the next word is a keyword: AVG v(a)*i(r1) FROM=1m. Their text is taken as it
 * stands, so that tokens are only looked at to find the keywords. */

#include "reader.h"
#include "result_cards.h"

#include <math.h>
#include <string.h>

static const char USAGE[] =
    ".meas tran name AVG|RMS|MIN|MAX|PP|INTEG|MIN_AT|MAX_AT formula [FROM= TO=], "
    "FIND|DERIV formula AT=|WHEN ..., WHEN a=b, TRIG ... TARG ..., PARAM='formula'";
static const char CONDITION[] =
    "a condition is: formula=formula or formula VAL=value [RISE=|FALL=|CROSS=n or LAST] [TD=time]";

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

/* A .meas card being read. */
struct reading {
    struct dalcs_builder *builder;
    const struct dalcs_card *card;
    struct dalcs_reader reader;
    struct dalcs_measure_card *measure;
    struct dalcs_signal_formula_rules rules;
};

static bool is_word(const struct dalcs_token *token, const char *word) {
    return token->kind == DALCS_TOKEN_WORD && strcmp(token->text, word) == 0;
}

static bool is_one_of(const struct dalcs_token *token, const char *const *list, size_t n) {
    return token->kind == DALCS_TOKEN_WORD && dalcs_builder_is_one_of(token->text, list, n);
}

/* "from 1m to 2m", "at t0" and "fall 1", as LTspice also has it. */
static bool is_bound(const struct dalcs_card *card, int k) {
    static const char *const bounds[] = {"from", "to", "at"};
    static const char *const counts[] = {"rise", "fall", "cross"};
    const struct dalcs_token *next = k + 1 < card->n ? &card->token[k + 1] : NULL;
    if (next == NULL || next->kind == DALCS_TOKEN_EQUAL) {
        return false;
    }
    const bool is_last = is_one_of(&card->token[k], bounds, 3) && k + 2 == card->n &&
                         (next->kind == DALCS_TOKEN_WORD || next->kind == DALCS_TOKEN_EXPRESSION);
    return is_last || (is_one_of(&card->token[k], bounds, 3) && dalcs_reader_is_number(next)) ||
           (is_one_of(&card->token[k], counts, 3) &&
            (dalcs_reader_is_number(next) || is_word(next, "last")));
}

/* Does a keyword stand at token k, which ends a formula before it? */
static bool is_keyword(const struct dalcs_card *card, int k) {
    static const char *const alone[] = {"when", "trig", "targ"};
    static const char *const with_value[] = {
        "from", "to",     "td",     "rise",  "fall",      "cross",       "at",       "val",
        "goal", "minval", "weight", "print", "failvalue", "default_val", "precision"};
    if (is_one_of(&card->token[k], alone, sizeof alone / sizeof alone[0])) {
        return true;
    }
    if (is_bound(card, k)) {
        return true;
    }
    return k + 1 < card->n && card->token[k + 1].kind == DALCS_TOKEN_EQUAL &&
           is_one_of(&card->token[k], with_value, sizeof with_value / sizeof with_value[0]);
}

/* The end of the formula that starts at token k: a keyword, or, if asked for, an equal sign. */
static int formula_end(const struct dalcs_card *card, int k, bool at_equal) {
    int depth = 0;
    for (int first = k; k < card->n; k++) {
        const enum dalcs_token_kind kind = card->token[k].kind;
        depth += (kind == DALCS_TOKEN_OPEN) - (kind == DALCS_TOKEN_CLOSE);
        const bool ends =
            (at_equal && kind == DALCS_TOKEN_EQUAL) || (k > first && is_keyword(card, k));
        if (depth <= 0 && ends) {
            break;
        }
    }
    return k;
}

/* A formula up to the next keyword. */
static bool read_formula(struct reading *r, bool at_equal, const char *what,
                         const struct dalcs_signal_formula_rules *rules,
                         struct dalcs_signal_formula *formula) {
    const int begin = r->reader.at;
    const int end = formula_end(r->card, begin, at_equal);
    const struct dalcs_token *token = &r->card->token[begin];
    if (end == begin || is_keyword(r->card, begin)) {
        dalcs_reader_missing(&r->reader, what);
        return false;
    }
    r->reader.at = end;
    /* par('...') is how ngspice marks a formula. */
    const bool is_par =
        end - begin == 4 && is_word(token, "par") && token[2].kind == DALCS_TOKEN_EXPRESSION;
    return is_par ? dalcs_signal_formula_compile(r->builder, token + 2, 1, rules, formula)
                  : dalcs_signal_formula_compile(r->builder, token, end - begin, rules, formula);
}

/* A value that is known before the run. */
static bool read_constant(struct reading *r, const char *what, double *value) {
    const struct dalcs_signal_formula_rules rules = {
        .variable = "", .no_signals = "this must be known before the run"};
    struct dalcs_signal_formula formula;
    if (!read_formula(r, false, what, &rules, &formula)) {
        return false;
    }
    *value = dalcs_signal_formula_value(&formula, &(struct dalcs_signal_formula_point){0});
    if (!isfinite(*value)) {
        dalcs_builder_error(r->builder, dalcs_reader_previous(&r->reader), NULL,
                            "%s has no value here", what);
        return false;
    }
    return true;
}

/* A time that is known before the run, or else computed from earlier measurements. */
static bool read_time(struct reading *r, double *time, struct dalcs_signal_formula *later) {
    const struct dalcs_signal_formula_rules rules = {
        .variable = "",
        .no_signals = "a time is made of numbers, parameters and earlier measurements",
        .results = &r->builder->results.measure_names};
    struct dalcs_signal_formula formula;
    if (!read_formula(r, false, "a time", &rules, &formula)) {
        return false;
    }
    if (formula.has_results) {
        *later = formula;
        return true;
    }
    *time = dalcs_signal_formula_value(&formula, &(struct dalcs_signal_formula_point){0});
    if (!isfinite(*time)) {
        dalcs_builder_error(r->builder, dalcs_reader_previous(&r->reader), NULL,
                            "a time has no value here");
        return false;
    }
    return true;
}

/* RISE=2, FALL=LAST */
static bool read_count(struct reading *r, int *count) {
    const struct dalcs_token *token = dalcs_reader_peek(&r->reader, 0);
    if (token != NULL && is_word(token, "last")) {
        r->reader.at++;
        *count = 0;
        return true;
    }
    double value;
    if (!read_constant(r, "a count or LAST", &value)) {
        return false;
    }
    if (!(value >= 1.0 && value <= 1e9) || value != floor(value)) {
        dalcs_builder_error(r->builder, token, NULL, "a count is 1, 2, 3, ... or LAST");
        return false;
    }
    *count = (int)value;
    return true;
}

/* Takes a keyword and its equal sign, if this one comes next. */
static bool take(struct reading *r, const char *word) {
    const struct dalcs_token *next = dalcs_reader_peek(&r->reader, 1);
    const bool has_equal = next != NULL && next->kind == DALCS_TOKEN_EQUAL;
    if (!has_equal && !is_bound(r->card, r->reader.at)) {
        return false;
    }
    const bool taken = dalcs_reader_take_word(&r->reader, word);
    r->reader.at += taken && has_equal;
    return taken;
}

/* ---- Instants -------------------------------------------------------------------------------- */

static bool check_crossing(struct reading *r, struct dalcs_measure_instant *instant) {
    if (instant->left.is_constant && instant->difference.is_constant) {
        dalcs_builder_error(r->builder, dalcs_reader_previous(&r->reader), CONDITION,
                            "neither side of this depends on the run");
        return false;
    }
    return true;
}

/* v(out)=2.5, v(a)=v(b), or v(out) VAL=2.5, and which of the crossings. */
static bool read_condition(struct reading *r, struct dalcs_measure_instant *instant) {
    struct dalcs_signal_formula right = {0};
    instant->kind = DALCS_INSTANT_CROSSING;
    if (!read_formula(r, true, "a condition", &r->rules, &instant->left)) {
        return false;
    }
    bool has_value = dalcs_reader_take(&r->reader, DALCS_TOKEN_EQUAL);
    bool has_edge = false;
    if (has_value && !read_formula(r, false, "a value", &r->rules, &right)) {
        return false;
    }
    while (!dalcs_reader_at_end(&r->reader)) {
        static const char *const edges[] = {
            [DALCS_EDGE_ANY] = "cross", [DALCS_EDGE_RISE] = "rise", [DALCS_EDGE_FALL] = "fall"};
        const struct dalcs_token *token = dalcs_reader_peek(&r->reader, 0);
        if (!has_value && take(r, "val")) {
            has_value = true;
            if (!read_formula(r, false, "a value", &r->rules, &right)) {
                return false;
            }
            continue;
        }
        if (take(r, "td")) {
            if (!read_time(r, &instant->delay, &instant->delay_formula)) {
                return false;
            }
            continue;
        }
        int edge = 0;
        while (edge <= DALCS_EDGE_FALL && !take(r, edges[edge])) {
            edge++;
        }
        if (edge > DALCS_EDGE_FALL) {
            break;
        }
        if (has_edge) {
            dalcs_builder_error(r->builder, token, CONDITION,
                                "one of RISE, FALL and CROSS, and once");
            return false;
        }
        has_edge = true;
        instant->edge = (enum dalcs_measure_edge)edge;
        if (!read_count(r, &instant->count)) {
            return false;
        }
    }
    if (!has_value) {
        dalcs_reader_missing(&r->reader, "'=' or VAL=");
        return false;
    }
    if (!dalcs_signal_formula_difference(r->builder, &instant->left, &right,
                                         &instant->difference)) {
        return false;
    }
    instant->difference.is_constant = right.is_constant;
    instant->text = right.text;
    return check_crossing(r, instant);
}

/* AT=time, or a condition. */
static bool read_instant(struct reading *r, struct dalcs_measure_instant *instant) {
    if (take(r, "at")) {
        instant->kind = DALCS_INSTANT_AT;
        return read_time(r, &instant->at, &instant->at_formula);
    }
    return read_condition(r, instant);
}

/* ---- Kinds ----------------------------------------------------------------------------------- */

/* TRIG ... TARG ..., after the word TRIG. */
static bool read_interval(struct reading *r) {
    struct dalcs_measure_instant *instant = r->measure->instant;
    if (!read_instant(r, &instant[0])) {
        return false;
    }
    if (!dalcs_reader_take_word(&r->reader, "targ")) {
        dalcs_reader_missing(&r->reader, "TARG");
        return false;
    }
    return read_instant(r, &instant[1]);
}

/* Parameters for optimizers, and for the printing of Xyce. */
static bool take_ignored(struct reading *r) {
    static const char *const names[] = {"goal",      "minval",      "weight",
                                        "failvalue", "default_val", "precision"};
    bool taken = false;
    for (size_t k = 0; k < sizeof names / sizeof names[0] && !taken; k++) {
        taken = take(r, names[k]);
    }
    return taken;
}

/* FROM=, TO= and, for statistics, TRIG ... TARG; then nothing more. */
static bool read_bounds(struct reading *r) {
    struct dalcs_measure_card *m = r->measure;
    const bool is_statistic = m->kind <= DALCS_MEASURE_MAX_AT;
    while (!dalcs_reader_at_end(&r->reader)) {
        const struct dalcs_token *token = dalcs_reader_peek(&r->reader, 0);
        if (take(r, "from") || (is_statistic && take(r, "td"))) {
            if (!read_time(r, &m->from, &m->from_formula)) {
                return false;
            }
        } else if (take(r, "to")) {
            if (!read_time(r, &m->to, &m->to_formula)) {
                return false;
            }
        } else if (take_ignored(r)) {
            double unused;
            dalcs_builder_note(r->builder, token, NULL,
                               "%s= of a measurement has no meaning here and is ignored",
                               token->text);
            if (!read_constant(r, "a value", &unused)) {
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
static bool read_place(struct reading *r) {
    struct dalcs_measure_card *m = r->measure;
    if (dalcs_reader_take_word(&r->reader, "when")) {
        return read_condition(r, &m->instant[0]);
    }
    if (take(r, "at")) {
        m->instant[0].kind = DALCS_INSTANT_AT;
        return read_time(r, &m->instant[0].at, &m->instant[0].at_formula);
    }
    if (m->analysis == DALCS_MEASURED_OP && m->kind == DALCS_MEASURE_FIND) {
        return true;
    }
    dalcs_reader_missing(&r->reader, "WHEN or AT=");
    return false;
}

/* `time WHEN v(out)=1` and `v(out)*2 AT=1m`, without FIND, as LTspice has them: no kind, and a place behind it. */
static bool is_found(const struct reading *r) {
    const struct dalcs_token *token = dalcs_reader_peek(&r->reader, 0);
    const struct dalcs_token *next = dalcs_reader_peek(&r->reader, 1);
    const int end = formula_end(r->card, r->reader.at, false);
    const bool starts_formula = token->kind == DALCS_TOKEN_EXPRESSION ||
                                (next != NULL && next->kind == DALCS_TOKEN_OPEN) ||
                                end == r->reader.at + 1;
    return starts_formula && end < r->card->n &&
           (is_word(&r->card->token[end], "when") || is_word(&r->card->token[end], "at"));
}

static bool read_kind(struct reading *r) {
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

static bool read_measurement(struct reading *r) {
    struct dalcs_measure_card *m = r->measure;
    if (!read_kind(r)) {
        return false;
    }
    switch (m->kind) {
    case DALCS_MEASURE_WHEN:
        return read_condition(r, &m->instant[0]) && read_bounds(r);
    case DALCS_MEASURE_DELAY:
        return read_interval(r) && read_bounds(r);
    case DALCS_MEASURE_PARAM: {
        const struct dalcs_signal_formula_rules rules = {
            .variable = "",
            .no_signals = "PARAM is computed from measurements; FIND takes signals",
            .results = &r->builder->results.measure_names};
        dalcs_reader_take(&r->reader, DALCS_TOKEN_EQUAL);
        return read_formula(r, false, "a formula", &rules, &m->formula) && read_bounds(r);
    }
    default:
        if (!read_formula(r, false, "a formula", &r->rules, &m->formula)) {
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
static enum dalcs_measured_analysis read_analysis(struct reading *r) {
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
        return builder->analyses.pss != NULL || builder->netlist->asks_steady;
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

void dalcs_measure_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct reading r = {
        .builder = builder, .card = card, .reader = dalcs_reader_start(builder, card, USAGE)};
    if (is_of_other_analysis(card)) {
        dalcs_builder_note(builder, &card->token[1], NULL,
                           "dalcs has no such analysis: this measurement is left out");
        return;
    }
    const enum dalcs_measured_analysis analysis = read_analysis(&r);
    const struct dalcs_token *name;
    if (!dalcs_reader_name(&r.reader, "a name", &name)) {
        return;
    }
    struct dalcs_measure_card measure = {
        .name = dalcs_arena_copy(&builder->circuit->arena, name->text, strlen(name->text)),
        .analysis = analysis,
        .from = -INFINITY,
        .to = INFINITY,
        .instant = {{.count = 1, .delay = -INFINITY}, {.count = 1, .delay = -INFINITY}},
        .where = dalcs_builder_keep_location(builder, name)};
    r.measure = &measure;
    r.rules.variable = analysis == DALCS_MEASURED_AC ? "frequency" : "time";
    r.rules.results = &builder->results.measure_names;
    if (measure.name == NULL || !read_measurement(&r)) {
        builder->out_of_memory = builder->out_of_memory || measure.name == NULL;
        return;
    }
    measure.is_late = measure.kind != DALCS_MEASURE_PARAM && needs_results(&measure);
    if (!is_run(builder, analysis)) {
        dalcs_builder_note(builder, card->token, NULL,
                           "there is no such analysis: this measurement is left out");
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
