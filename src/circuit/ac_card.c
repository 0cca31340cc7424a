/* ac_card.c - .ac: its frequencies, and what it says of a response around a steady state. */
#include "sweep_card.h"

static const char AC_USAGE[] = ".ac dec|oct|lin points fstart fstop, or .ac list frequency ...";

/* .ac list f1 f2 ..., as in LTspice, in any order. */
static void read_frequencies(struct dalcs_reader *reader, struct dalcs_sweep *f) {
    dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    const int first = reader->at;
    if (dalcs_reader_at_end(reader)) {
        dalcs_reader_missing(reader, "a frequency");
        return;
    }
    if (!dalcs_sweep_read_list(reader, f)) {
        f->n = 0;
        return;
    }
    for (int k = 0; k < f->n; k++) {
        if (!(f->list[k] >= 0.0)) {
            dalcs_builder_error(reader->builder, &reader->card->token[first + k], AC_USAGE,
                                "a frequency cannot be negative");
            f->n = 0;
            return;
        }
    }
    f->start = f->list[0];
    f->stop = f->list[f->n - 1];
}

static bool read_loop(struct dalcs_reader *reader) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *name;
    if (!dalcs_reader_name(reader, "a voltage source", &name)) {
        return false;
    }
    builder->circuit->analyses.orbit_ac.loop = dalcs_sweep_keep_text(builder, name->text);
    return true;
}

/* voltage or both */
static bool read_injection(struct dalcs_reader *reader) {
    bool *is_loaded = &reader->builder->circuit->analyses.orbit_ac.is_loaded;
    *is_loaded = dalcs_reader_take_word(reader, "both");
    if (*is_loaded || dalcs_reader_take_word(reader, "voltage")) {
        return true;
    }
    dalcs_reader_missing(reader, "'voltage' or 'both'");
    return false;
}

static bool read_sideband(struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    double value;
    if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "a number", &value)) {
        return false;
    }
    if (!(value >= -DALCS_MOST_SIDEBAND && value <= DALCS_MOST_SIDEBAND) ||
        value != (double)(int)value) {
        dalcs_builder_error(reader->builder, token, AC_USAGE,
                            "a sideband is a whole number, at most %d of them away",
                            (int)DALCS_MOST_SIDEBAND);
        return false;
    }
    reader->builder->circuit->analyses.orbit_ac.sideband = (int)value;
    return true;
}

/* loop=NAME, injection=voltage|both, sideband=K, or nothing more. False after a message. */
static bool read_orbit_words(struct dalcs_reader *reader) {
    for (bool ok = true; ok;) {
        const bool is_loop = dalcs_reader_take_word(reader, "loop");
        const bool is_injection = !is_loop && dalcs_reader_take_word(reader, "injection");
        if (!is_loop && !is_injection && !dalcs_reader_take_word(reader, "sideband")) {
            return true;
        }
        if (!dalcs_reader_take(reader, DALCS_TOKEN_EQUAL)) {
            dalcs_reader_missing(reader, "'='");
            return false;
        }
        ok = is_loop        ? read_loop(reader)
             : is_injection ? read_injection(reader)
                            : read_sideband(reader);
    }
    return false;
}

/* DEC, OCT or LIN, and three numbers: token[] has where the first and the last frequency stand, and their number. */
static bool read_spaced(struct dalcs_reader *reader, struct dalcs_sweep *f, double *n,
                        const struct dalcs_token *token[3]) {
    if (!dalcs_sweep_take_spacing(reader, &f->spacing)) {
        dalcs_reader_missing(reader, "dec, oct, lin or list");
        return false;
    }
    token[2] = dalcs_reader_peek(reader, 0);
    if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "a number of points", n)) {
        return false;
    }
    token[0] = dalcs_reader_peek(reader, 0);
    if (!dalcs_reader_list_number(reader, DALCS_HERTZ, "a frequency", &f->start)) {
        return false;
    }
    token[1] = dalcs_reader_peek(reader, 0);
    if (!dalcs_reader_list_number(reader, DALCS_HERTZ, "a frequency", &f->stop) ||
        !read_orbit_words(reader) || !dalcs_reader_end(reader)) {
        return false;
    }
    return true;
}

static bool check_spaced(struct dalcs_builder *builder, const struct dalcs_sweep *f, double n,
                         const struct dalcs_token *const token[3]) {
    if (!(n >= 1.0) || n != (double)(long)n || n > DALCS_SWEEP_MOST) {
        dalcs_builder_error(builder, token[2], AC_USAGE,
                            "the number of points must be a whole number, at least 1");
        return false;
    }
    const bool is_linear = f->spacing == DALCS_LINEAR;
    if (!(f->start > 0.0) && !(is_linear && f->start == 0.0)) {
        dalcs_builder_error(builder, token[0], AC_USAGE, "the first frequency must be positive");
        return false;
    }
    if (!(f->stop >= f->start)) {
        dalcs_builder_error(builder, token[1], AC_USAGE,
                            "the last frequency must not be below the first");
        return false;
    }
    return true;
}

void dalcs_sweep_parse_ac(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_sweep *f = &builder->circuit->analyses.ac;
    struct dalcs_reader reader = dalcs_reader_start(builder, card, AC_USAGE);
    if (!dalcs_analysis_is_first(builder, card, &builder->analyses.ac)) {
        return;
    }
    f->where = dalcs_builder_keep_location(builder, card->token);
    f->name = f->label = "frequency";
    f->device = -1;
    if (!read_orbit_words(&reader)) {
        return;
    }
    if (dalcs_reader_take_word(&reader, "list")) {
        read_frequencies(&reader, f);
        return;
    }
    double n;
    const struct dalcs_token *token[3];
    if (!read_spaced(&reader, f, &n, token) || !check_spaced(builder, f, n, token)) {
        return;
    }
    if (f->spacing == DALCS_LINEAR) {
        f->n = f->start == f->stop ? 1 : (int)n;
        f->step = f->n > 1 ? (f->stop - f->start) / (f->n - 1) : 0.0;
        return;
    }
    f->step = n;
    if (dalcs_sweep_count_values(builder, token, AC_USAGE, f)) {
        return;
    }
    f->n = 0;
}
