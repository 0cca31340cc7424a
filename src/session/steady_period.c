/* steady_period.c - the common period of the sources.
 *
 * Each source repeats after a time of its own, stays what it is, or comes to something that it stays: then
 * that is what it is in a steady state. The ratio of two periods is a fraction p/q with small numbers, by
 * continued fractions, or the two have nothing in common. Delays are passed: a steady state has no start. */
#include "steady.h"

#include "quantity.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Two periods were typed with DBL_DIG digits each, or more: their ratio is off by twice half a unit in the
 * last of these. Fractions with denominators up to 1e6 are 1e-12 apart, so that no other is meant. */
static const double same_ratio = 1e-14;
static const double most_denominator = 1e6;

/* Periods of the fastest source in a common one: beyond, a run up to the steady state is no longer. */
static const double most_periods = 1e5;

/* Where a straight line of time that never ends is said to: as in wave.c. */
static const double never = 0x1p40;

/* One source that repeats. */
struct clock {
    struct dalcs_stimulus *stimulus;
    const char *name;
    double period; /* s */
};

struct clocks {
    struct dalcs_run *run;
    bool at_start;
    int n;
    struct clock *clock;
};

const char *dalcs_steady_source_name(const struct dalcs_circuit *c, int stimulus) {
    const char *name = "a formula";
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_behaviour *b = c->device[i].behaviour;
        name = c->device[i].stimulus == stimulus ? c->device[i].name : name;
        for (int k = 0; b != NULL && k < b->output.n; k++) {
            const struct dalcs_affine_term *term = &b->output.term[k];
            bool is = term->kind == DALCS_QUANTITY_STIMULUS && term->index == stimulus;
            name = is ? c->device[i].name : name;
        }
    }
    return name;
}

static bool is_level(const struct dalcs_stimulus *s) {
    bool is = s->kind == DALCS_STIMULUS_DC;
    if (s->kind == DALCS_STIMULUS_SIN) {
        is = s->u.sine.amplitude == 0.0;
    } else if (s->kind == DALCS_STIMULUS_PULSE) {
        is = s->u.pulse.low == s->u.pulse.high;
    } else if (s->kind == DALCS_STIMULUS_PWL) {
        is = true;
        for (int i = 1; i < s->u.pwl.n; i++) {
            is = is && s->u.pwl.v[i] == s->u.pwl.v[0];
        }
    }
    return is;
}

/* After so many seconds it is what it was; 0: it is not. */
static double own_period(const struct dalcs_stimulus *s) {
    switch (s->kind) {
    case DALCS_STIMULUS_SIN:
        return s->u.sine.damping == 0.0 && s->u.sine.n_cycles == 0.0 && s->u.sine.frequency > 0.0
                   ? 1.0 / s->u.sine.frequency
                   : 0.0;
    case DALCS_STIMULUS_PULSE:
        return isfinite(s->u.pulse.period) && s->u.pulse.n_periods == 0.0 ? s->u.pulse.period : 0.0;
    case DALCS_STIMULUS_PWL:
        return s->u.pwl.repeats ? s->u.pwl.t[s->u.pwl.n - 1] - s->u.pwl.repeat_from : 0.0;
    default:
        return 0.0;
    }
}

bool dalcs_steady_repeats(const struct dalcs_stimulus *s) {
    bool repeats = s->kind == DALCS_STIMULUS_TONES || (!is_level(s) && own_period(s) > 0.0);
    for (int k = 0; s->kind == DALCS_STIMULUS_FORMULA && k < s->u.formula.argument.n; k++) {
        repeats = repeats || dalcs_steady_repeats(s->u.formula.argument.part[k].of);
    }
    return repeats;
}

/* A formula that rises with time for ever. */
static bool is_endless(const struct dalcs_stimulus *s) {
    const int n = s->kind == DALCS_STIMULUS_PWL ? s->u.pwl.n : 0;
    return n > 1 && s->u.pwl.t[n - 1] >= never && s->u.pwl.v[n - 1] != s->u.pwl.v[n - 2];
}

/* It comes to this in the end. */
static double last_level(const struct dalcs_stimulus *s) {
    if (s->kind == DALCS_STIMULUS_EXP) {
        const bool falls = isfinite(s->u.exponential.fall_delay);
        const bool rises = isfinite(s->u.exponential.rise_delay);
        return rises && !falls ? s->u.exponential.high : s->u.exponential.low;
    }
    if (s->kind == DALCS_STIMULUS_SIN && s->u.sine.damping > 0.0) {
        return s->u.sine.offset;
    }
    return dalcs_stimulus_value(s, DBL_MAX, DALCS_LEFT);
}

static enum dalcs_status refuse(struct dalcs_run *r, const struct dalcs_location *where,
                                const char *hint, const char *sentence) {
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, where, hint, "%s", sentence);
    return DALCS_E_OPTION;
}

static enum dalcs_status add_clock(struct clocks *c, struct dalcs_stimulus *s, const char *name,
                                   double period) {
    c->clock[c->n++] = (struct clock){s, name, period};
    return DALCS_OK;
}

/* AM and SFFM: the tones are clocks of their own. */
static enum dalcs_status add_tones(struct clocks *c, struct dalcs_stimulus *s, const char *name) {
    for (int k = 0; k < s->u.tones.n; k++) {
        double frequency = fabs(s->u.tones.tone[k].frequency);
        if (frequency > 0.0 && s->u.tones.tone[k].amplitude != 0.0) {
            DALCS_TRY(add_clock(c, s, name, 1.0 / frequency));
        }
    }
    return DALCS_OK;
}

static int count_clocks(const struct dalcs_stimulus *s) {
    int n = 1;
    if (s->kind == DALCS_STIMULUS_TONES) {
        n = s->u.tones.n;
    } else if (s->kind == DALCS_STIMULUS_FORMULA) {
        for (int k = 0; k < s->u.formula.argument.n; k++) {
            n += count_clocks(s->u.formula.argument.part[k].of);
        }
    }
    return n;
}

static enum dalcs_status look_at(struct clocks *c, struct dalcs_stimulus *s, const char *name,
                                 bool is_part);

/* A formula of sources has copies of these. They are copied once more, for what is changed here is put back behind
 * the search. */
static enum dalcs_status look_into(struct clocks *c, struct dalcs_stimulus *s, const char *name) {
    struct dalcs_arena *arena = &c->run->s->arena;
    struct dalcs_stimulus_sum *sum = &s->u.formula.argument;
    struct dalcs_stimulus_summand *part = dalcs_arena_alloc(arena, (size_t)sum->n, sizeof *part);
    struct dalcs_stimulus *of = dalcs_arena_alloc(arena, (size_t)sum->n, sizeof *of);
    if (part == NULL || of == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < sum->n; k++) {
        if (sum->part[k].of->is_written) {
            part[k] = sum->part[k];
            continue;
        }
        of[k] = *sum->part[k].of;
        part[k] = (struct dalcs_stimulus_summand){sum->part[k].factor, &of[k]};
        DALCS_TRY(look_at(c, &of[k], name, true));
    }
    sum->part = part;
    return DALCS_OK;
}

static enum dalcs_status look_at(struct clocks *c, struct dalcs_stimulus *s, const char *name,
                                 bool is_part) {
    if (is_level(s) || s->is_written) {
        return DALCS_OK; /* the run evaluates the outputs of gates */
    }
    if (s->kind == DALCS_STIMULUS_FORMULA) {
        return look_into(c, s, name);
    }
    if (s->kind == DALCS_STIMULUS_TONES) {
        return add_tones(c, s, name);
    }
    double period = own_period(s);
    if (period > 0.0) {
        return add_clock(c, s, name, period);
    }
    if (s->kind == DALCS_STIMULUS_SIN && s->u.sine.damping < 0.0 && !c->at_start) {
        return refuse(c->run, NULL, NULL, "a sine that grows without end has no steady state");
    }
    if (is_endless(s) && !c->at_start) {
        char sentence[256];
        snprintf(sentence, sizeof sentence, "'%s' follows time without end: nothing repeats", name);
        return refuse(c->run, NULL,
                      "a function of time that repeats, as sin, or that ends, as table(time, ...)",
                      sentence);
    }
    if (is_part && c->at_start) { /* it would stay what it is at the start */
        char sentence[256];
        snprintf(sentence, sizeof sentence, "'%s' is a formula of a source that does not repeat",
                 name);
        return refuse(c->run, NULL, "make that source repeat", sentence);
    }
    double level = c->at_start ? dalcs_stimulus_value(s, 0.0, DALCS_LEFT) : last_level(s);
    if (strchr(name, '(') == NULL) { /* not a part of an element */
        dalcs_diag_add(&c->run->s->diag, DALCS_NOTE, NULL, NULL,
                       "%s'%s' does not repeat: the steady state is that with its value %s, %.9g",
                       is_part ? "a source in the formula of " : "", name,
                       c->at_start ? "at t = 0" : "in the end", level);
    }
    *s = (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC, .dc = level, .has_dc = true};
    return DALCS_OK;
}

/* p/q near to the ratio, q small; false: there is none. */
static bool find_fraction(double ratio, double *p, double *q) {
    double before[2] = {0.0, 1.0}; /* p, q */
    double now[2] = {1.0, 0.0};
    double rest = ratio;
    for (int k = 0; k < 64 && now[1] <= most_denominator; k++) {
        double whole = floor(rest);
        double next[2] = {whole * now[0] + before[0], whole * now[1] + before[1]};
        before[0] = now[0];
        before[1] = now[1];
        now[0] = next[0];
        now[1] = next[1];
        if (now[1] <= most_denominator && fabs(now[0] / now[1] - ratio) <= same_ratio * ratio) {
            *p = now[0];
            *q = now[1];
            return true;
        }
        if (rest == whole) {
            return false;
        }
        rest = 1.0 / (rest - whole);
    }
    return false;
}

static double divisor(double a, double b) {
    while (b > 0.0) {
        double rest = fmod(a, b);
        a = b;
        b = rest;
    }
    return a;
}

static enum dalcs_status no_common(const struct clocks *c, const struct clock *a,
                                   const struct clock *b, const char *why) {
    char first[DALCS_QUANTITY_SIZE];
    char second[DALCS_QUANTITY_SIZE];
    char text[512];
    snprintf(text, sizeof text, "'%s' (%s) and '%s' (%s) have no common period%s", a->name,
             dalcs_quantity_write(first, a->period, "s", 7), b->name,
             dalcs_quantity_write(second, b->period, "s", 7), why);
    return refuse(
        c->run, NULL,
        "make their ratio one of small whole numbers, or run .tran for as long as it takes", text);
}

/* The least common one, s; 0: no source repeats. */
static enum dalcs_status find_common(const struct clocks *c, double *period) {
    double multiple = 1.0; /* of the first clock */
    double divided = 1.0;
    *period = 0.0;
    for (int k = 1; k < c->n; k++) {
        double p;
        double q;
        if (!find_fraction(c->clock[k].period / c->clock[0].period, &p, &q)) {
            return no_common(c, &c->clock[0], &c->clock[k], "");
        }
        /* lcm(a/b, p/q) = lcm(a q, p b) / (b q), in lowest terms lcm(a, p) / gcd(b, q) */
        multiple = multiple / divisor(multiple, p) * p;
        divided = divisor(divided, q);
        double common = multiple / divided * c->clock[0].period;
        for (int j = 0; j <= k; j++) {
            if (common / c->clock[j].period > most_periods) {
                return no_common(c, &c->clock[0], &c->clock[k],
                                 " of less than 100000 of the faster one");
            }
        }
    }
    if (c->n > 0) {
        *period = multiple / divided * c->clock[0].period;
    }
    return DALCS_OK;
}

/* What is asked for is no period of the clock. Where it is far too long it may have been meant as a frequency, as ngspice's
 * .pss has one: `inverse` says so. */
static enum dalcs_status refuse_asked(const struct clocks *c, double asked,
                                      const struct clock *clock, const char *inverse) {
    char text[256];
    char own[DALCS_QUANTITY_SIZE];
    char wanted[DALCS_QUANTITY_SIZE];
    const bool is_long = asked / clock->period > most_periods;
    snprintf(text, sizeof text, "a period of %s is %s that of '%s', which is %s",
             dalcs_quantity_write(wanted, asked, "s", 9),
             is_long ? "more than 100000 times" : "no multiple of", clock->name,
             dalcs_quantity_write(own, clock->period, "s", 9));
    return refuse(c->run, NULL,
                  is_long ? inverse : "leave the period out: it follows from the sources", text);
}

/* Beyond 1 s a number is larger than its inverse. */
static enum dalcs_status take_asked(const struct clocks *c, double asked, double *period) {
    bool is_frequency = asked > 1.0 && c->n == 0;
    char text[256];
    char as[2][DALCS_QUANTITY_SIZE];
    snprintf(text, sizeof text, "a time is asked for, no frequency: %s has a period of %s",
             dalcs_quantity_write(as[0], asked, "Hz", 9),
             dalcs_quantity_write(as[1], 1.0 / asked, "s", 9));
    for (int k = 0; k < c->n && asked > 0.0; k++) {
        double n = asked / c->clock[k].period;
        if (!(rint(n) >= 1.0) || n > most_periods || fabs(n - rint(n)) > same_ratio * n) {
            return refuse_asked(c, asked, &c->clock[k], text);
        }
        double inverse = asked > 1.0 ? asked * c->clock[k].period : 0.0;
        is_frequency = is_frequency || fabs(inverse - 1.0) <= same_ratio;
    }
    if (is_frequency) {
        dalcs_diag_add(&c->run->s->diag, DALCS_NOTE, NULL, NULL, "%s", text);
    }
    *period = asked > 0.0 ? asked : *period;
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_find_period(struct dalcs_run *r, double asked, bool at_start,
                                           double *period, bool *is_free) {
    const struct dalcs_circuit *circuit = &r->s->circuit;
    struct clocks c = {.run = r, .at_start = at_start};
    size_t most = 0;
    for (int i = 0; i < circuit->n_stimuli; i++) {
        most += (size_t)count_clocks(&circuit->stimulus[i]);
    }
    c.clock = dalcs_alloc(most, sizeof(*c.clock));
    enum dalcs_status status = c.clock != NULL ? DALCS_OK : DALCS_E_NOMEM;
    for (int i = 0; i < circuit->n_stimuli && status == DALCS_OK; i++) {
        status =
            look_at(&c, &r->s->circuit.stimulus[i], dalcs_steady_source_name(circuit, i), false);
    }
    status = status == DALCS_OK ? find_common(&c, period) : status;
    status = status == DALCS_OK ? take_asked(&c, asked, period) : status;
    *is_free = c.n == 0;
    for (int k = 0; k < c.n && status == DALCS_OK; k++) {
        status = dalcs_steady_settle(r, c.clock[k].stimulus, c.clock[k].name, *period);
    }
    free(c.clock);
    return status;
}
