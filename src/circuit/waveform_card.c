/* waveform_card.c - SIN, PULSE, EXP, AM and SFFM as they stand on a source's card.
 *
 * Parentheses and commas are optional, as in SPICE. Values that are left out: PULSE edges are of
 * zero width, its width and period infinite; an EXP time constant is 0 (a jump), its fall never
 * comes. SPICE would put print steps there; here nothing depends on those. */

#include "element_cards.h"
#include "reader.h"

#include <math.h>
#include <string.h>

enum { MOST_ARGUMENTS = 8 };

/* What one argument may be. */
enum range { ANY, NOT_NEGATIVE, POSITIVE };

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

static const struct form forms[] = {
    {"sin",
     "SIN(offset amplitude frequency delay damping phase cycles)",
     2,
     7,
     {{"an offset", DALCS_PLAIN, true, ANY, 0},
      {"an amplitude", DALCS_PLAIN, true, ANY, 0},
      {"a frequency", DALCS_HERTZ, false, NOT_NEGATIVE, 0},
      {"a delay", DALCS_SECOND, false, ANY, 0},
      {"a damping", DALCS_HERTZ, false, ANY, 0},
      {"a phase in degrees", DALCS_PLAIN, false, ANY, 0},
      {"a number of cycles", DALCS_PLAIN, false, NOT_NEGATIVE, 0}}},
    {"pulse",
     "PULSE(low high delay rise fall width period periods)",
     2,
     8,
     {{"a low value", DALCS_PLAIN, true, ANY, 0},
      {"a high value", DALCS_PLAIN, true, ANY, 0},
      {"a delay", DALCS_SECOND, false, ANY, 0},
      {"a rise time", DALCS_SECOND, false, NOT_NEGATIVE, 0},
      {"a fall time", DALCS_SECOND, false, NOT_NEGATIVE, 0},
      {"a width", DALCS_SECOND, false, NOT_NEGATIVE, (double)INFINITY},
      {"a period", DALCS_SECOND, false, NOT_NEGATIVE, (double)INFINITY},
      {"a number of periods", DALCS_PLAIN, false, NOT_NEGATIVE, 0}}},
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
    {"am",
     "AM(amplitude offset modulating_frequency carrier_frequency delay modulating_phase "
     "carrier_phase)",
     4,
     7,
     {{"an amplitude", DALCS_PLAIN, true, ANY, 0},
      {"an offset", DALCS_PLAIN, false, ANY, 0},
      {"a modulating frequency", DALCS_HERTZ, false, POSITIVE, 0},
      {"a carrier frequency", DALCS_HERTZ, false, POSITIVE, 0},
      {"a delay", DALCS_SECOND, false, ANY, 0},
      {"a phase in degrees", DALCS_PLAIN, false, ANY, 0},
      {"a phase in degrees", DALCS_PLAIN, false, ANY, 0}}},
    {"sffm",
     "SFFM(offset amplitude carrier_frequency index signal_frequency carrier_phase "
     "signal_phase)",
     5,
     7,
     {{"an offset", DALCS_PLAIN, true, ANY, 0},
      {"an amplitude", DALCS_PLAIN, true, ANY, 0},
      {"a carrier frequency", DALCS_HERTZ, false, POSITIVE, 0},
      {"a modulation index", DALCS_PLAIN, false, ANY, 0},
      {"a signal frequency", DALCS_HERTZ, false, POSITIVE, 0},
      {"a phase in degrees", DALCS_PLAIN, false, ANY, 0},
      {"a phase in degrees", DALCS_PLAIN, false, ANY, 0}}},
    {"pwl", NULL, 0, 0, {{0}}},
};

static const struct form *form_of(const char *name) {
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
        if ((argument->range == NOT_NEGATIVE && value[k] < 0) ||
            (argument->range == POSITIVE && value[k] <= 0)) {
            dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                                argument->range == POSITIVE ? "%s must be positive"
                                                            : "%s cannot be negative",
                                argument->what);
            return false;
        }
    }
    if (more(reader)) {
        dalcs_builder_error(reader->builder, dalcs_reader_peek(reader, 0), form->usage,
                            "%.*s has %d values at most", (int)strcspn(form->usage, "("),
                            form->usage, form->n);
        return false;
    }
    return true;
}

/* ngspice 39 takes a width of 0 for one that is left out. LTspice and Xyce do not. */
static void warn_of_no_width(struct dalcs_builder *builder, const struct dalcs_token *place,
                             const struct dalcs_stimulus *s) {
    const double period = s->u.pulse.period;
    const double rise = s->u.pulse.rise;
    const double height = s->u.pulse.high - s->u.pulse.low;
    if (s->u.pulse.width != 0 || height == 0 || rise >= period) {
        return;
    }
    if (builder->netlist->dialect.name > DALCS_DIALECT_NGSPICE) {
        if (rise == 0 && s->u.pulse.fall == 0) {
            dalcs_builder_warn(builder, place, "write the width, or leave it out for a step",
                               "this pulse stays at %g: its rise, fall and width are 0",
                               s->u.pulse.low);
        }
        return;
    }
    static const char hint[] = "write a width of 1f, or .options dialect=ltspice";
    if (isinf(period)) {
        dalcs_builder_warn(builder, place, hint,
                           "a width of 0 is none: this pulse falls from %g at once; ngspice 39 "
                           "takes it for the stop time and stays there",
                           s->u.pulse.high);
        return;
    }
    const double here = s->u.pulse.low + 0.5 * height * fmin(1, (rise + s->u.pulse.fall) / period);
    const double there = s->u.pulse.low + height * (1 - 0.5 * rise / period);
    dalcs_builder_warn(builder, place, hint,
                       "a width of 0 is none: the mean of this pulse is %.4g; ngspice 39 takes it "
                       "for the stop time, which makes %.4g",
                       here, there);
}

/* ngspice 44 has given both another order; SPICE3, ngspice 39, LTspice and Xyce have this one. */
static void note_other_order(struct dalcs_builder *builder, const struct dalcs_token *place,
                             const struct form *form, const double *value) {
    if (builder->netlist->dialect.name > DALCS_DIALECT_NGSPICE) {
        return;
    }
    if (strcmp(form->name, "am") == 0) {
        dalcs_builder_note(builder, place,
                           "its AM(a b c f g) is here AM(c b/c f g) with a source of a in series",
                           "AM is read as in ngspice 39: amplitude, offset, modulating and carrier "
                           "frequency; ngspice 44 takes a value that is added for the first");
    } else if (strcmp(form->name, "sffm") == 0) {
        dalcs_builder_note(builder, place,
                           "a netlist for ngspice 44 has the two exchanged, and an index of at "
                           "most carrier / signal",
                           "the carrier of this SFFM has %g Hz and its signal %g Hz, as in ngspice "
                           "39 and LTspice; ngspice 44 takes the third value for the signal",
                           value[2], value[4]);
    }
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
        s->u.sine.n_cycles = value[6];
    } else if (strcmp(form->name, "pulse") == 0) {
        s->kind = DALCS_STIMULUS_PULSE;
        s->u.pulse.low = value[0];
        s->u.pulse.high = value[1];
        s->u.pulse.delay = value[2];
        s->u.pulse.rise = value[3];
        s->u.pulse.fall = value[4];
        s->u.pulse.width = value[5];
        s->u.pulse.period = value[6] == 0 ? (double)INFINITY : value[6];
        s->u.pulse.n_periods = isfinite(s->u.pulse.period) ? value[7] : 0;
    } else if (strcmp(form->name, "am") == 0) {
        return dalcs_modulation_set_am(reader->builder, value, s);
    } else if (strcmp(form->name, "sffm") == 0) {
        return dalcs_modulation_set_fm(reader->builder, dalcs_reader_previous(reader), value, s);
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
    reader->at++;
    if (form->n == 0) {
        return dalcs_pwl_card_parse(reader, quantity, stimulus);
    }
    reader->usage = form->usage;
    const struct dalcs_token *open = dalcs_reader_peek(reader, 0);
    const bool opened = dalcs_reader_take(reader, DALCS_TOKEN_OPEN);

    double value[MOST_ARGUMENTS];
    if (!read_arguments(reader, form, quantity, value) ||
        !set_stimulus(reader, form, value, stimulus)) {
        return false;
    }
    if (stimulus->kind == DALCS_STIMULUS_PULSE) {
        warn_of_no_width(reader->builder, name, stimulus);
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
    note_other_order(reader->builder, name, form, value);
    reader->usage = usage;
    return true;
}
