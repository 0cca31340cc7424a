/* carrier.c - periodic functions of time of straight lines: what people write for a carrier.
 *
 *     x - floor(x), x % 1                   a sawtooth, with x = rate t + offset
 *     asin(sin(x)), acos(cos(x)), ...       a triangle
 *
 * Each is a PULSE with a phase, whose edges are met exactly; as functions of functions a triangle would have infinite
 * slopes within, and floor steps without end. */
#include "behaviour.h"
#include "pi.h"

#include <math.h>
#include <string.h>

/* rate t + offset */
struct line {
    double rate, offset;
};

/* Is it a straight line in time? Its parts are compiled, and kept as those of any formula. */
static bool find_line(struct dalcs_compiler *c, const struct dalcs_formula *f, struct line *x) {
    const struct dalcs_form *form = dalcs_compile(c, f);
    if (form == NULL || form->n > 0 || !dalcs_affine_is_time(&form->affine)) {
        return false;
    }
    *x = (struct line){form->affine.term[0].coefficient, form->affine.constant};
    return x->rate != 0;
}

/* x - floor(x), in [0, 1) */
static const struct dalcs_form *fraction(struct dalcs_compiler *c, struct line x) {
    const bool falls = x.rate < 0; /* 1 - the fraction of -x */
    const double sign = falls ? -1 : 1;
    const struct dalcs_wave saw = {
        .shape = DALCS_SAWTOOTH, .frequency = sign * x.rate, .phase = sign * x.offset};
    const struct dalcs_form *rising = dalcs_wave_value(c, &saw);
    return falls ? dalcs_form_add(c, dalcs_form_number(c, 1), -1, rising) : rising;
}

const struct dalcs_form *dalcs_carrier_ramp(struct dalcs_compiler *c, const struct dalcs_wave *saw,
                                            double height, double offset) {
    const struct line x = {saw->frequency, saw->phase};
    const struct dalcs_form *share =
        x.rate != 0 ? fraction(c, x) : dalcs_form_number(c, x.offset - floor(x.offset));
    return dalcs_form_add(c, dalcs_form_number(c, offset), height, share);
}

static const struct dalcs_form *line_form(struct dalcs_compiler *c, struct line x) {
    const struct dalcs_affine time = dalcs_affine_of(c, DALCS_QUANTITY_TIME, 0);
    return dalcs_form_add(c, dalcs_form_number(c, x.offset), x.rate, dalcs_form_affine(c, &time));
}

static const struct dalcs_form *floor_of(struct dalcs_compiler *c, struct line x) {
    return dalcs_form_add(c, line_form(c, x), -1, fraction(c, x));
}

static const struct dalcs_form *ceil_of(struct dalcs_compiler *c, struct line x) {
    return dalcs_form_scale(c, -1, floor_of(c, (struct line){-x.rate, -x.offset}));
}

/* A triangle between 0 and pi, 0 at x = 0, with a period of 2 pi: acos(cos(x)). */
static const struct dalcs_form *triangle(struct dalcs_compiler *c, struct line x) {
    const double sign = x.rate < 0 ? -1 : 1;
    const struct dalcs_wave wave = {.shape = DALCS_TRIANGLE,
                                    .frequency = sign * x.rate / (2 * dalcs_pi),
                                    .phase = sign * x.offset / (2 * dalcs_pi)};
    return dalcs_form_scale(c, dalcs_pi, dalcs_wave_value(c, &wave));
}

static const struct dalcs_form *arc_of(struct dalcs_compiler *c, const struct dalcs_formula *f) {
    static const char *const arcs[] = {"asin", "arcsin", "acos", "arccos", "atan", "arctan", NULL};
    static const char *const waves[] = {"sin", "cos", "tan", NULL};
    struct line x;
    if (!dalcs_formula_is_call_of(f, arcs) || f->n != 1) {
        return NULL;
    }
    const struct dalcs_formula *of = f->argument[0];
    const bool is_negative = of->kind == DALCS_FORMULA_OPERATION && of->code == DALCS_NEGATE;
    of = is_negative ? of->argument[0] : of;
    if (!dalcs_formula_is_call_of(of, waves) || !find_line(c, of->argument[0], &x)) {
        return NULL;
    }
    const char *arc = f->function + (strncmp(f->function, "arc", 3) == 0 ? 3 : 1);
    const char wave = of->function[0];
    if (is_negative &&
        wave == 't') { /* -tan(x) = tan(-x), -sin(x) and -cos(x) are half a turn later */
        x = (struct line){-x.rate, -x.offset};
    } else if (is_negative) {
        x.offset += dalcs_pi;
    }
    if (*arc == 't' || wave == 't') {
        if (*arc != 't' || wave != 't') {
            return NULL;
        }
        const struct line turns = {x.rate / dalcs_pi, x.offset / dalcs_pi + 0.5};
        const struct dalcs_form *saw = dalcs_form_scale(c, dalcs_pi, fraction(c, turns));
        return dalcs_form_add(c, dalcs_form_number(c, -dalcs_pi / 2), 1, saw);
    }
    if (wave == 's') { /* sin(x) = cos(x - pi/2) */
        x.offset -= dalcs_pi / 2;
    }
    const struct dalcs_form *arc_cosine = triangle(c, x);
    return *arc == 'c' ? arc_cosine
                       : dalcs_form_add(c, dalcs_form_number(c, dalcs_pi / 2), -1, arc_cosine);
}

/* x % y and fmod(x, y) of a line that is never negative. */
static const struct dalcs_form *remainder_of(struct dalcs_compiler *c,
                                             const struct dalcs_formula *f) {
    struct line x;
    const struct dalcs_form *y = dalcs_compile(c, f->argument[1]);
    if (y == NULL || !dalcs_form_is_number(y) || !(y->affine.constant > 0) ||
        !find_line(c, f->argument[0], &x) || x.rate < 0 || x.offset < 0) {
        return NULL;
    }
    const double period = y->affine.constant;
    return dalcs_form_scale(c, period,
                            fraction(c, (struct line){x.rate / period, x.offset / period}));
}

static const struct dalcs_form *steps_of(struct dalcs_compiler *c, const struct dalcs_formula *f) {
    struct line x;
    const char *name = f->function;
    if (f->n != 1 || !find_line(c, f->argument[0], &x)) {
        return NULL;
    }
    if (strcmp(name, "ceil") == 0) {
        return ceil_of(c, x);
    }
    if (strcmp(name, "int") == 0 && (x.rate < 0 || x.offset < 0)) { /* floor above 0, ceil below */
        const struct dalcs_form *zero = dalcs_form_number(c, 0);
        return dalcs_form_add(c, dalcs_form_max(c, floor_of(c, x), zero), 1,
                              dalcs_form_min(c, ceil_of(c, x), zero));
    }
    if (strcmp(name, "round") == 0 || strcmp(name, "nint") == 0) {
        x.offset += 0.5;
    }
    return floor_of(c, x);
}

const struct dalcs_form *dalcs_carrier(struct dalcs_compiler *c, const struct dalcs_formula *f) {
    static const char *const steps[] = {"int", "floor", "ceil", "nint", "round", NULL};
    static const char *const remainder[] = {"fmod", "mod", NULL};
    const bool is_remainder = (f->kind == DALCS_FORMULA_OPERATION && f->code == DALCS_REMAINDER) ||
                              dalcs_formula_is_call_of(f, remainder);
    return is_remainder && f->n == 2            ? remainder_of(c, f)
           : dalcs_formula_is_call_of(f, steps) ? steps_of(c, f)
                                                : arc_of(c, f);
}
