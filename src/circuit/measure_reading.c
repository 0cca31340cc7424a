/* measure_reading.c - the parts of a .meas card: formulas, constants, times, counts.
 *
 * Formulas end where the next word is a keyword: AVG v(a)*i(r1) FROM=1m. Their text is taken as it
 * stands, so that tokens are only looked at to find the keywords. */
#include "measure_reading.h"

#include <math.h>

static const char CONDITION[] =
    "a condition is: formula=formula or formula VAL=value [RISE=|FALL=|CROSS=n or LAST] [TD=time]";

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
            (dalcs_reader_is_number(next) || dalcs_token_is_word(next, "last")));
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

int dalcs_measure_formula_end(const struct dalcs_card *card, int k, bool at_equal) {
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

bool dalcs_measure_read_formula(struct dalcs_measure_reading *r, bool at_equal, const char *what,
                                const struct dalcs_signal_formula_rules *rules,
                                struct dalcs_signal_formula *formula) {
    const int begin = r->reader.at;
    const int end = dalcs_measure_formula_end(r->card, begin, at_equal);
    const struct dalcs_token *token = &r->card->token[begin];
    if (end == begin || is_keyword(r->card, begin)) {
        dalcs_reader_missing(&r->reader, what);
        return false;
    }
    r->reader.at = end;
    /* par('...') is how ngspice marks a formula. */
    const bool is_par = end - begin == 4 && dalcs_token_is_word(token, "par") &&
                        token[2].kind == DALCS_TOKEN_EXPRESSION;
    return is_par ? dalcs_signal_formula_compile(r->builder, token + 2, 1, rules, formula)
                  : dalcs_signal_formula_compile(r->builder, token, end - begin, rules, formula);
}

bool dalcs_measure_read_constant(struct dalcs_measure_reading *r, const char *what, double *value) {
    const struct dalcs_signal_formula_rules rules = {
        .variable = "", .no_signals = "this must be known before the run"};
    struct dalcs_signal_formula formula;
    if (!dalcs_measure_read_formula(r, false, what, &rules, &formula)) {
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

bool dalcs_measure_read_time(struct dalcs_measure_reading *r, double *time,
                             struct dalcs_signal_formula *later) {
    const struct dalcs_signal_formula_rules rules = {
        .variable = "",
        .no_signals = "a time is made of numbers, parameters and earlier measurements",
        .results = &r->builder->results.measure_names};
    struct dalcs_signal_formula formula;
    if (!dalcs_measure_read_formula(r, false, "a time", &rules, &formula)) {
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
static bool read_count(struct dalcs_measure_reading *r, int *count) {
    const struct dalcs_token *token = dalcs_reader_peek(&r->reader, 0);
    if (token != NULL && dalcs_token_is_word(token, "last")) {
        r->reader.at++;
        *count = 0;
        return true;
    }
    double value;
    if (!dalcs_measure_read_constant(r, "a count or LAST", &value)) {
        return false;
    }
    if (!(value >= 1.0 && value <= 1e9) || value != floor(value)) {
        dalcs_builder_error(r->builder, token, NULL, "a count is 1, 2, 3, ... or LAST");
        return false;
    }
    *count = (int)value;
    return true;
}

bool dalcs_measure_take(struct dalcs_measure_reading *r, const char *word) {
    const struct dalcs_token *next = dalcs_reader_peek(&r->reader, 1);
    const bool has_equal = next != NULL && next->kind == DALCS_TOKEN_EQUAL;
    if (!has_equal && !is_bound(r->card, r->reader.at)) {
        return false;
    }
    const bool taken = dalcs_reader_take_word(&r->reader, word);
    r->reader.at += taken && has_equal;
    return taken;
}

static bool check_crossing(struct dalcs_measure_reading *r, struct dalcs_measure_instant *instant) {
    if (instant->left.is_constant && instant->difference.is_constant) {
        dalcs_builder_error(r->builder, dalcs_reader_previous(&r->reader), CONDITION,
                            "neither side of this depends on the run");
        return false;
    }
    return true;
}

/* Is RISE, FALL or CROSS next? It is read, and may stand there once; *ok: it could be. */
static bool read_edge(struct dalcs_measure_reading *r, struct dalcs_measure_instant *instant,
                      bool *has_edge, bool *ok) {
    static const char *const edges[] = {
        [DALCS_EDGE_ANY] = "cross", [DALCS_EDGE_RISE] = "rise", [DALCS_EDGE_FALL] = "fall"};
    const struct dalcs_token *token = dalcs_reader_peek(&r->reader, 0);
    int edge = 0;
    while (edge <= DALCS_EDGE_FALL && !dalcs_measure_take(r, edges[edge])) {
        edge++;
    }
    if (edge > DALCS_EDGE_FALL) {
        return false;
    }
    if (*has_edge) {
        dalcs_builder_error(r->builder, token, CONDITION, "one of RISE, FALL and CROSS, and once");
        *ok = false;
        return true;
    }
    *has_edge = true;
    instant->edge = (enum dalcs_measure_edge)edge;
    *ok = read_count(r, &instant->count);
    return true;
}

bool dalcs_measure_read_condition(struct dalcs_measure_reading *r,
                                  struct dalcs_measure_instant *instant) {
    struct dalcs_signal_formula right = {0};
    instant->kind = DALCS_INSTANT_CROSSING;
    if (!dalcs_measure_read_formula(r, true, "a condition", &r->rules, &instant->left)) {
        return false;
    }
    bool has_value = dalcs_reader_take(&r->reader, DALCS_TOKEN_EQUAL);
    bool has_edge = false;
    if (has_value && !dalcs_measure_read_formula(r, false, "a value", &r->rules, &right)) {
        return false;
    }
    while (!dalcs_reader_at_end(&r->reader)) {
        if (!has_value && dalcs_measure_take(r, "val")) {
            has_value = true;
            if (!dalcs_measure_read_formula(r, false, "a value", &r->rules, &right)) {
                return false;
            }
            continue;
        }
        if (dalcs_measure_take(r, "td")) {
            if (!dalcs_measure_read_time(r, &instant->delay, &instant->delay_formula)) {
                return false;
            }
            continue;
        }
        bool ok;
        if (!read_edge(r, instant, &has_edge, &ok)) {
            break;
        }
        if (!ok) {
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

bool dalcs_measure_read_instant(struct dalcs_measure_reading *r,
                                struct dalcs_measure_instant *instant) {
    if (dalcs_measure_take(r, "at")) {
        instant->kind = DALCS_INSTANT_AT;
        return dalcs_measure_read_time(r, &instant->at, &instant->at_formula);
    }
    return dalcs_measure_read_condition(r, instant);
}

/* The first error behind the mark, for the report; of one that was told of another card its kind. */
static const char *mistake_of(struct dalcs_builder *builder, const struct dalcs_diag_mark *mark) {
    const struct dalcs_diag *diag = builder->diag;
    size_t k = mark->n;
    while (k < diag->n && diag->item[k].severity != DALCS_ERROR) {
        k++;
    }
    size_t length;
    const char *sentence = dalcs_diag_sentence(
        k < diag->n ? diag->item[k].text : "its card has a mistake that is told elsewhere",
        &length);
    const char *copy = dalcs_arena_copy(&builder->circuit->arena, sentence, length);
    dalcs_builder_note_memory(builder, copy != NULL);
    return copy;
}

void dalcs_measure_give_up(struct dalcs_measure_reading *r, const struct dalcs_diag_mark *mark) {
    struct dalcs_builder *builder = r->builder;
    struct dalcs_measure_card *measure = r->measure;
    const char *name = measure->name;
    const char *mistake = mistake_of(builder, mark);
    const char *consequence = name != NULL
                                  ? dalcs_builder_hint(builder, "the measurement '%s' fails", name)
                                  : "this measurement is left out";
    if (mistake != NULL && consequence != NULL &&
        dalcs_diag_soften(builder->diag, mark, consequence) == 0) {
        dalcs_builder_warn(builder, r->card->token, NULL, "%s: %s", mistake, consequence);
    }
    *measure = (struct dalcs_measure_card){.name = name,
                                           .analysis = measure->analysis,
                                           .kind = DALCS_MEASURE_PARAM,
                                           .mistake = mistake,
                                           .where = measure->where};
}
