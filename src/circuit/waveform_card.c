/* waveform_card.c - SIN, PULSE, PWL and EXP as they stand on a source's card.
 *
 * Parentheses and commas are optional, as in SPICE. Values that are left out: PULSE edges are of
 * zero width, its width and period infinite; an EXP time constant is 0 (a jump), its fall never
 * comes. SPICE would put print steps there; here nothing depends on those. */
#include "builder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ARGUMENTS = 7 };

/* What one argument may be. */
enum range { ANY, NOT_NEGATIVE };

struct argument {
    const char *what;
    enum dalcs_quantity quantity; /* DALCS_PLAIN with is_value: the source's own */
    bool is_value;
    enum range range;
    double missing; /* its value when it is left out */
};

struct form {
    const char *name;
    const char *usage;
    int n_least;
    int n;
    struct argument argument[MOST_ARGUMENTS];
};

static const struct form *form_of(const char *name) {
    static const struct form forms[] = {
        {"sin",
         "SIN(offset amplitude frequency delay damping phase)",
         2,
         6,
         {{"an offset", DALCS_PLAIN, true, ANY, 0},
          {"an amplitude", DALCS_PLAIN, true, ANY, 0},
          {"a frequency", DALCS_HERTZ, false, NOT_NEGATIVE, 0},
          {"a delay", DALCS_SECOND, false, ANY, 0},
          {"a damping", DALCS_HERTZ, false, ANY, 0},
          {"a phase in degrees", DALCS_PLAIN, false, ANY, 0}}},
        {"pulse",
         "PULSE(low high delay rise fall width period)",
         2,
         7,
         {{"a low value", DALCS_PLAIN, true, ANY, 0},
          {"a high value", DALCS_PLAIN, true, ANY, 0},
          {"a delay", DALCS_SECOND, false, ANY, 0},
          {"a rise time", DALCS_SECOND, false, NOT_NEGATIVE, 0},
          {"a fall time", DALCS_SECOND, false, NOT_NEGATIVE, 0},
          {"a width", DALCS_SECOND, false, NOT_NEGATIVE, (double)INFINITY},
          {"a period", DALCS_SECOND, false, NOT_NEGATIVE, (double)INFINITY}}},
        {"exp",
         "EXP(low high rise_delay rise_tau fall_delay fall_tau)",
         2,
         6,
         {{"a low value", DALCS_PLAIN, true, ANY, 0},
          {"a high value", DALCS_PLAIN, true, ANY, 0},
          {"a delay", DALCS_SECOND, false, NOT_NEGATIVE, 0},
          {"a time constant", DALCS_SECOND, false, NOT_NEGATIVE, 0},
          {"a delay", DALCS_SECOND, false, NOT_NEGATIVE, (double)INFINITY},
          {"a time constant", DALCS_SECOND, false, NOT_NEGATIVE, 0}}},
        {"pwl", "PWL(time value time value ...)", 2, 0, {{0}}},
    };
    name = strcmp(name, "sine") == 0 ? "sin" : name;
    for (size_t k = 0; k < sizeof forms / sizeof forms[0]; k++) {
        if (strcmp(name, forms[k].name) == 0) {
            return &forms[k];
        }
    }
    return NULL;
}

bool dalcs_waveform_card_is_name(const char *word) {
    return form_of(word) != NULL;
}

/* Does another argument follow? */
static bool more(const struct dalcs_reader *reader) {
    const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
    return next != NULL && dalcs_reader_is_number(next);
}

/* The arguments of a form with a fixed number of them. */
static bool read_arguments(struct dalcs_reader *reader, const struct form *form,
                           enum dalcs_quantity quantity, double *value) {
    for (int k = 0; k < form->n; k++) {
        const struct argument *argument = &form->argument[k];
        value[k] = argument->missing;
        if (k >= form->n_least && !more(reader)) {
            continue;
        }
        if (!dalcs_reader_list_number(reader, argument->is_value ? quantity : argument->quantity,
                                      argument->what, &value[k])) {
            return false;
        }
        if (argument->range == NOT_NEGATIVE && value[k] < 0) {
            dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                                "%s cannot be negative", argument->what);
            return false;
        }
    }
    if (more(reader)) {
        const bool counts = strcmp(form->name, "exp") != 0;
        dalcs_builder_error(reader->builder, dalcs_reader_peek(reader, 0), form->usage,
                            counts ? "a number of cycles is not supported yet"
                                   : "EXP has six values at most");
        return false;
    }
    return true;
}

/* ---- PWL ----------------------------------------------------------------------------------- */

static bool check_time(struct dalcs_reader *reader, const struct dalcs_token *token, double time,
                       const double *before) {
    struct dalcs_builder *builder = reader->builder;
    if (token->text[0] == '+') {
        dalcs_builder_error(builder, token, "write the time from 0",
                            "times relative to the point before are not supported yet");
        return false;
    }
    if (before != NULL && time < *before) {
        dalcs_builder_error(builder, token, "times must ascend; two equal times are a jump",
                            "PWL time %g s is before the one ahead of it, %g s", time, *before);
        return false;
    }
    return true;
}

static bool read_points(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                        struct dalcs_stimulus *stimulus) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *first = dalcs_reader_peek(reader, 0);
    if (first != NULL && first->kind == DALCS_TOKEN_WORD && !dalcs_reader_is_number(first)) {
        dalcs_builder_error(builder, first, reader->usage, "PWL with '%s' is not supported yet",
                            first->text);
        return false;
    }
    int n_numbers = 0;
    for (int k = 0; dalcs_reader_peek(reader, k) != NULL; k++) {
        const struct dalcs_token *token = dalcs_reader_peek(reader, k);
        if (!dalcs_reader_is_number(token) && token->kind != DALCS_TOKEN_OPEN &&
            token->kind != DALCS_TOKEN_CLOSE) {
            break;
        }
        n_numbers++;
    }
    const size_t most = (size_t)n_numbers / 2 + 1;
    double *t = dalcs_arena_alloc(&builder->circuit->arena, most, sizeof *t);
    double *v = dalcs_arena_alloc(&builder->circuit->arena, most, sizeof *v);
    if (t == NULL || v == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    int n = 0;
    do {
        const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
        if (!dalcs_reader_list_number(reader, DALCS_SECOND, "a time", &t[n]) ||
            !check_time(reader, token, t[n], n > 0 ? &t[n - 1] : NULL)) {
            return false;
        }
        if (!more(reader)) {
            dalcs_builder_error(builder, token, "PWL(time value time value ...)",
                                "this PWL time has no value");
            return false;
        }
        if (!dalcs_reader_list_number(reader, quantity, "a value", &v[n])) {
            return false;
        }
        n++;
    } while (more(reader));
    stimulus->kind = DALCS_STIMULUS_PWL;
    stimulus->u.pwl.n = n;
    stimulus->u.pwl.t = t;
    stimulus->u.pwl.v = v;
    return true;
}

/* ---- All forms ----------------------------------------------------------------------------- */

static bool set_stimulus(struct dalcs_reader *reader, const struct form *form, const double *value,
                         struct dalcs_stimulus *s) {
    if (strcmp(form->name, "sin") == 0) {
        s->kind = DALCS_STIMULUS_SIN;
        s->u.sine.offset = value[0];
        s->u.sine.amplitude = value[1];
        s->u.sine.frequency = value[2];
        s->u.sine.delay = value[3];
        s->u.sine.damping = value[4];
        s->u.sine.phase = value[5];
    } else if (strcmp(form->name, "pulse") == 0) {
        s->kind = DALCS_STIMULUS_PULSE;
        s->u.pulse.low = value[0];
        s->u.pulse.high = value[1];
        s->u.pulse.delay = value[2];
        s->u.pulse.rise = value[3];
        s->u.pulse.fall = value[4];
        s->u.pulse.width = value[5];
        s->u.pulse.period = value[6] == 0 ? (double)INFINITY : value[6];
    } else {
        s->kind = DALCS_STIMULUS_EXP;
        s->u.exponential.low = value[0];
        s->u.exponential.high = value[1];
        s->u.exponential.rise_delay = value[2];
        s->u.exponential.rise_tau = value[3];
        s->u.exponential.fall_delay = value[4];
        s->u.exponential.fall_tau = value[5];
        if (value[4] < value[2]) {
            dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), form->usage,
                                "EXP falls (at %g s) before it rises (at %g s)", value[4],
                                value[2]);
            return false;
        }
    }
    return true;
}

bool dalcs_waveform_card_parse(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                               struct dalcs_stimulus *stimulus) {
    const struct dalcs_token *name = dalcs_reader_peek(reader, 0);
    const struct form *form = form_of(name->text);
    const char *usage = reader->usage;
    reader->usage = form->usage;
    reader->at++;
    const struct dalcs_token *open = dalcs_reader_peek(reader, 0);
    const bool opened = dalcs_reader_take(reader, DALCS_TOKEN_OPEN);

    double value[MOST_ARGUMENTS];
    if (form->n == 0) {
        if (!read_points(reader, quantity, stimulus)) {
            return false;
        }
    } else if (!read_arguments(reader, form, quantity, value) ||
               !set_stimulus(reader, form, value, stimulus)) {
        return false;
    }
    if (opened && !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        if (dalcs_reader_at_end(reader)) {
            dalcs_builder_error(reader->builder, open, form->usage,
                                "this parenthesis is never closed");
        } else {
            dalcs_reader_unexpected(reader);
        }
        return false;
    }
    reader->usage = usage;
    return true;
}
