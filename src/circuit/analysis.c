/* analysis.c - .tran and .op: what is to be computed. */

#include "analysis_cards.h"
#include "reader.h"

#include <math.h>

static const char PSS_USAGE[] = ".pss [period | auto] [periods=n] [step=tstep] [osc] [uic]";
static const char ENV_USAGE[] = ".env tstop [at=t,...] [tol=x] [step=tstep] [uic]";
static const char TRAN_USAGE[] = ".tran tstep tstop [tstart [tmax]] [uic]";

enum { TSTEP, TSTOP, TSTART, TMAX, N_TIMES };

bool dalcs_analysis_is_first(struct dalcs_builder *builder, const struct dalcs_card *card,
                             const struct dalcs_token **first) {
    if (*first == NULL) {
        *first = card->token;
        return true;
    }
    dalcs_builder_error(builder, card->token, NULL, "a second %s, the first at %s",
                        card->token->text, dalcs_builder_place(builder, *first));
    return false;
}

static bool check_times(struct dalcs_builder *builder, const struct dalcs_transient *transient,
                        const struct dalcs_token *const *place) {
    if (transient->stop <= 0) {
        dalcs_builder_error(builder, place[TSTOP], TRAN_USAGE, "the stop time must be positive");
        return false;
    }
    if (transient->step < 0) {
        dalcs_builder_error(builder, place[TSTEP], TRAN_USAGE, "the step cannot be negative");
        return false;
    }
    if (transient->step > transient->stop) {
        dalcs_builder_warn(
            builder, place[TSTEP], dalcs_builder_hint(builder, "the order is: %s", TRAN_USAGE),
            "the step of %g s is longer than the run of %g s", transient->step, transient->stop);
    }
    if (place[TSTART] != NULL && (transient->start < 0 || transient->start >= transient->stop)) {
        dalcs_builder_error(builder, place[TSTART], TRAN_USAGE,
                            "the start time must lie between 0 and the stop time");
        return false;
    }
    if (place[TMAX] != NULL && transient->max_step <= 0) {
        dalcs_builder_error(builder, place[TMAX], TRAN_USAGE, "the largest step must be positive");
        return false;
    }
    return true;
}

/* A word on the .tran card that is no time; false ends the card. */
static bool read_word(struct dalcs_reader *reader, struct dalcs_transient *transient) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    struct dalcs_builder *builder = reader->builder;
    /* noop is Xyce's word for it, skipbp PSpice's */
    if (dalcs_reader_take_word(reader, "uic") || dalcs_reader_take_word(reader, "noop") ||
        dalcs_reader_take_word(reader, "skipbp")) {
        transient->use_initial_conditions = true;
        if (dalcs_reader_take(reader, DALCS_TOKEN_EQUAL)) {
            transient->starts_steady = dalcs_reader_take_word(reader, "steady");
            const struct dalcs_token *other = dalcs_reader_peek(reader, 0);
            if (!transient->starts_steady && other != NULL) {
                dalcs_builder_error(builder, other,
                                    "uic=steady starts from the periodic steady state",
                                    "did not expect '%s' here", other->text);
            } else if (!transient->starts_steady) {
                dalcs_reader_missing(reader, "'steady'");
            }
            return transient->starts_steady;
        }
        return true;
    }
    if (dalcs_reader_take_word(reader, "nodiscard")) {
        dalcs_builder_note(builder, token, NULL, "'%s' has no meaning here and is ignored",
                           token->text);
        return true;
    }
    if (dalcs_reader_take_word(reader, "trace")) { /* gnucap's: how much it prints */
        dalcs_builder_note(builder, token, NULL, "'%s' has no meaning here and is ignored",
                           token->text);
        const struct dalcs_token *what = dalcs_reader_peek(reader, 0);
        reader->at +=
            what != NULL && what->kind == DALCS_TOKEN_WORD && !dalcs_reader_is_number(what);
        return true;
    }
    if (dalcs_reader_take_word(reader, "startup")) {
        builder->analyses.startup = token;
        return true;
    }
    if (dalcs_reader_take_word(reader, "steady")) {
        dalcs_builder_warn(builder, token, "'dalcs steady' finds the periodic steady state",
                           "the run goes on to the end of .tran, also when all is steady before");
        return true;
    }
    if (dalcs_reader_take_word(reader, "step")) {
        dalcs_builder_error(builder, token, TRAN_USAGE, "'%s' is not supported yet", token->text);
        return false;
    }
    dalcs_reader_unexpected(reader);
    return false;
}

/* The times of a .tran, and where they stand; how many: 0 is an error. */
static int read_times(struct dalcs_reader *reader, struct dalcs_transient *transient,
                      double time[N_TIMES], const struct dalcs_token *place[N_TIMES]) {
    int n = 0;
    while (!dalcs_reader_at_end(reader)) {
        const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
        if (dalcs_reader_is_number(token) && n < N_TIMES) {
            if (!dalcs_reader_list_number(reader, DALCS_SECOND, "a time", &time[n])) {
                return 0;
            }
            place[n++] = token;
        } else if (!read_word(reader, transient)) {
            return 0;
        }
    }
    if (n == 0) {
        dalcs_reader_missing(reader, "a stop time");
        return 0;
    }
    return n;
}

void dalcs_analysis_parse_tran(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_transient *transient = &builder->circuit->analyses.transient;
    struct dalcs_reader reader = dalcs_reader_start(builder, card, TRAN_USAGE);
    if (!dalcs_analysis_is_first(builder, card, &builder->analyses.tran)) {
        return;
    }
    transient->where = dalcs_builder_keep_location(builder, card->token);

    double time[N_TIMES] = {0};
    const struct dalcs_token *place[N_TIMES] = {NULL};
    const int n = read_times(&reader, transient, time, place);
    if (n == 0) {
        return;
    }
    const struct dalcs_dialect dialect = builder->netlist->dialect;
    if (n == 1) {
        if (!dalcs_dialect_is_told(dialect, DALCS_DIALECT_LTSPICE)) {
            dalcs_builder_note(builder, place[0], TRAN_USAGE,
                               "the only time on .tran is the stop time");
        }
        time[TSTOP] = time[TSTEP];
        place[TSTOP] = place[TSTEP];
        time[TSTEP] = 0;
    }
    transient->step = time[TSTEP];
    transient->stop = time[TSTOP];
    transient->start = time[TSTART];
    transient->max_step = time[TMAX];
    transient->present = check_times(builder, transient, place);
    if (dialect.name == DALCS_DIALECT_XYCE && transient->step > 0) {
        if (!dialect.is_told) {
            dalcs_builder_note(builder, place[TSTEP],
                               ".options output initial_interval=seconds gives others",
                               "the first time on Xyce's .tran is its first step, which is chosen "
                               "here: there are rows every %g s",
                               transient->stop / 1000);
        }
        transient->first_step = transient->step;
        transient->step = 0;
    }
}

static bool read_pss_word(struct dalcs_reader *reader, struct dalcs_periodic_card *card) {
    if (dalcs_reader_take_word(reader, "uic")) {
        card->use_initial_conditions = true;
        return true;
    }
    if (dalcs_reader_take_word(reader, "osc")) {
        card->oscillates = true;
        return true;
    }
    if (dalcs_reader_take_word(reader, "auto")) {
        card->period = 0.0;
        return true;
    }
    const bool is_period = dalcs_reader_take_word(reader, "period");
    double *value = is_period                                   ? &card->period
                    : dalcs_reader_take_word(reader, "periods") ? &card->n_periods
                    : dalcs_reader_take_word(reader, "step")    ? &card->step
                                                                : NULL;
    if (value == NULL) {
        dalcs_reader_unexpected(reader);
        return false;
    }
    if (!dalcs_reader_take(reader, DALCS_TOKEN_EQUAL)) {
        dalcs_reader_missing(reader, "'='");
        return false;
    }
    if (is_period && dalcs_reader_take_word(reader, "auto")) {
        card->period = 0.0;
        return true;
    }
    return dalcs_reader_list_number(reader, value == &card->n_periods ? DALCS_PLAIN : DALCS_SECOND,
                                    value == &card->n_periods ? "a number" : "a time", value);
}

void dalcs_analysis_parse_pss(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_periodic_card *periodic = &builder->circuit->analyses.periodic;
    struct dalcs_reader reader = dalcs_reader_start(builder, card, PSS_USAGE);
    if (!dalcs_analysis_is_first(builder, card, &builder->analyses.pss)) {
        return;
    }
    bool ok = true;
    if (!dalcs_reader_at_end(&reader) && dalcs_reader_is_number(dalcs_reader_peek(&reader, 0))) {
        ok = dalcs_reader_list_number(&reader, DALCS_SECOND, "a period", &periodic->period);
        if (ok && !dalcs_reader_at_end(&reader) &&
            dalcs_reader_is_number(dalcs_reader_peek(&reader, 0))) {
            dalcs_builder_error(builder, dalcs_reader_peek(&reader, 0), PSS_USAGE,
                                "this is ngspice's .pss, which begins with a frequency; here the "
                                "period of an oscillator need not be known: .pss osc");
            return;
        }
    }
    while (ok && !dalcs_reader_at_end(&reader)) {
        ok = read_pss_word(&reader, periodic);
    }
    if (ok && (periodic->period < 0.0 || periodic->step < 0.0)) {
        dalcs_builder_error(builder, card->token, PSS_USAGE, "times must be positive");
        ok = false;
    }
    if (ok && periodic->n_periods != 0.0 &&
        (!(periodic->n_periods >= 1.0) || periodic->n_periods != floor(periodic->n_periods))) {
        dalcs_builder_error(builder, card->token, PSS_USAGE, "periods= is a whole number");
        ok = false;
    }
    periodic->present = ok;
}

/* Times behind at=, with commas between. */
static bool read_at(struct dalcs_reader *reader, struct dalcs_envelope_card *card) {
    struct dalcs_builder *builder = reader->builder;
    card->at = dalcs_arena_alloc(&builder->circuit->arena, (size_t)reader->card->n, sizeof(double));
    builder->out_of_memory = builder->out_of_memory || card->at == NULL;
    while (card->at != NULL && !dalcs_reader_at_end(reader) &&
           dalcs_reader_is_number(dalcs_reader_peek(reader, 0))) {
        if (!dalcs_reader_list_number(reader, DALCS_SECOND, "a time", &card->at[card->n_at++])) {
            return false;
        }
    }
    if (card->n_at == 0) {
        dalcs_reader_missing(reader, "a time");
    }
    return card->n_at > 0;
}

static bool read_env_word(struct dalcs_reader *reader, struct dalcs_builder *builder) {
    struct dalcs_envelope_card *card = &builder->circuit->analyses.envelope;
    if (dalcs_reader_take_word(reader, "uic")) {
        builder->circuit->analyses.transient.use_initial_conditions = true;
        return true;
    }
    const bool is_at = dalcs_reader_take_word(reader, "at");
    double *value = is_at                                    ? NULL
                    : dalcs_reader_take_word(reader, "step") ? &card->step
                    : dalcs_reader_take_word(reader, "tol")  ? &card->tolerance
                                                             : NULL;
    if (!is_at && value == NULL) {
        dalcs_reader_unexpected(reader);
        return false;
    }
    if (!dalcs_reader_take(reader, DALCS_TOKEN_EQUAL)) {
        dalcs_reader_missing(reader, "'='");
        return false;
    }
    if (is_at) {
        return read_at(reader, card);
    }
    const struct dalcs_token *place = dalcs_reader_peek(reader, 0);
    if (!dalcs_reader_list_number(reader, value == &card->step ? DALCS_SECOND : DALCS_PLAIN,
                                  "a number", value)) {
        return false;
    }
    if (!(*value > 0.0) || (value == &card->tolerance && *value > 0.1)) {
        dalcs_builder_error(builder, place, ENV_USAGE, "%s is a positive number%s",
                            value == &card->step ? "step" : "tol",
                            value == &card->step ? "" : ", at most 0.1");
        return false;
    }
    return true;
}

void dalcs_analysis_parse_env(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_transient *transient = &builder->circuit->analyses.transient;
    struct dalcs_envelope_card *envelope = &builder->circuit->analyses.envelope;
    struct dalcs_reader reader = dalcs_reader_start(builder, card, ENV_USAGE);
    if (!dalcs_analysis_is_first(builder, card, &builder->analyses.tran)) {
        return;
    }
    transient->where = dalcs_builder_keep_location(builder, card->token);
    const struct dalcs_token *place = dalcs_reader_peek(&reader, 0);
    bool ok = dalcs_reader_number(&reader, DALCS_SECOND, "a stop time", &transient->stop);
    if (ok && !(transient->stop > 0.0)) {
        dalcs_builder_error(builder, place, ENV_USAGE, "the stop time must be positive");
        return;
    }
    while (ok && !dalcs_reader_at_end(&reader)) {
        ok = read_env_word(&reader, builder);
    }
    for (int k = 0; k < envelope->n_at && ok; k++) {
        if (!(envelope->at[k] >= 0.0 && envelope->at[k] < transient->stop)) {
            dalcs_builder_error(builder, card->token, ENV_USAGE,
                                "at=%g lies outside of the run, which ends at %g s",
                                envelope->at[k], transient->stop);
            ok = false;
        }
    }
    envelope->present = transient->present = ok;
}

void dalcs_analysis_parse_op(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, ".op takes no values");
    if (dalcs_analysis_is_first(builder, card, &builder->analyses.op)) {
        builder->circuit->analyses.operating_point = dalcs_reader_end(&reader);
    }
}
