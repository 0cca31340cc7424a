/* write_stimulus.c - what a source does over time, as on its card. */
#include "equations.h"

#include <float.h>
#include <math.h>

/* name(a b c ...), without what at the end is infinite, or 0 after the first `least`: left out it is so,
 * too. */
static void write_function(FILE *f, const char *name, const double *value, int n, int least) {
    while (n > 0 && (!isfinite(value[n - 1]) || (n > least && value[n - 1] == 0.0))) {
        n--;
    }
    fprintf(f, "%s(", name);
    for (int k = 0; k < n; k++) {
        fputs(k > 0 ? " " : "", f);
        dalcs_write_number(f, isfinite(value[k]) ? value[k] : DBL_MAX);
    }
    fputc(')', f);
}

static void write_points(FILE *f, const struct dalcs_stimulus *s) {
    int n = s->u.pwl.n;
    fputs("PWL(", f);
    for (int k = 0; k < n; k++) {
        fputs(k > 0 ? " " : "", f);
        dalcs_write_number(f, s->u.pwl.t[k]);
        fputc(' ', f);
        dalcs_write_number(f, s->u.pwl.v[k]);
    }
    fputc(')', f);
    if (s->u.pwl.repeats) {
        int nearest = 0; /* what is repeated starts at a point, up to rounding */
        for (int k = 1; k < n; k++) {
            double distance = fabs(s->u.pwl.t[k] - s->u.pwl.repeat_from);
            nearest = distance < fabs(s->u.pwl.t[nearest] - s->u.pwl.repeat_from) ? k : nearest;
        }
        fputs(" r=", f);
        dalcs_write_number(f, s->u.pwl.t[nearest]);
    }
}

static void write_tones(FILE *f, const struct dalcs_stimulus *s) {
    fputs("TONES(", f);
    dalcs_write_number(f, s->u.tones.offset);
    fputc(' ', f);
    dalcs_write_number(f, s->u.tones.delay);
    for (int k = 0; k < s->u.tones.n; k++) {
        const struct dalcs_tone *t = &s->u.tones.tone[k];
        const double value[] = {t->amplitude, t->frequency, t->phase};
        for (int i = 0; i < 3; i++) {
            fputc(' ', f);
            dalcs_write_number(f, value[i]);
        }
    }
    fputc(')', f);
}

static void write_numbers(FILE *f, const double *value, int n) {
    for (int k = 0; k < n; k++) {
        dalcs_write_number(f, value[k]);
        fputc(' ', f);
    }
}

/* FORMULA(before after knots, at left value right of each, constant, factor (stimulus) ...) */
static void write_formula(FILE *f, const struct dalcs_stimulus *s) {
    const struct dalcs_piecewise *of = &s->u.formula.function;
    const struct dalcs_stimulus_sum *sum = &s->u.formula.argument;
    fputs("FORMULA(", f);
    write_numbers(f, (const double[]){of->before, of->after, of->n}, 3);
    for (int k = 0; k < of->n; k++) {
        const struct dalcs_knot *knot = &of->knot[k];
        write_numbers(f, (const double[]){knot->at, knot->left, knot->value, knot->right}, 4);
    }
    dalcs_write_number(f, sum->constant);
    for (int k = 0; k < sum->n; k++) {
        fputc(' ', f);
        dalcs_write_number(f, sum->part[k].factor);
        fputs(" (", f);
        dalcs_write_stimulus(f, sum->part[k].of);
        fputc(')', f);
    }
    fputc(')', f);
}

void dalcs_write_stimulus(FILE *f, const struct dalcs_stimulus *s) {
    if (s->has_dc || s->kind == DALCS_STIMULUS_DC) {
        fputs("dc ", f);
        dalcs_write_number(f, s->dc);
        fputs(s->kind == DALCS_STIMULUS_DC ? "" : " ", f);
    }
    switch (s->kind) {
    case DALCS_STIMULUS_DC:
        break;
    case DALCS_STIMULUS_SIN:
        write_function(f, "SIN",
                       (const double[]){s->u.sine.offset, s->u.sine.amplitude, s->u.sine.frequency,
                                        s->u.sine.delay, s->u.sine.damping, s->u.sine.phase,
                                        s->u.sine.n_cycles},
                       7, 3);
        break;
    case DALCS_STIMULUS_PULSE: {
        bool ends = isfinite(s->u.pulse.period); /* only then does a count mean anything */
        write_function(f, "PULSE",
                       (const double[]){s->u.pulse.low, s->u.pulse.high, s->u.pulse.delay,
                                        s->u.pulse.rise, s->u.pulse.fall, s->u.pulse.width,
                                        s->u.pulse.period, s->u.pulse.n_periods},
                       ends ? 8 : 7, 7);
        break;
    }
    case DALCS_STIMULUS_EXP: {
        bool falls = isfinite(s->u.exponential.fall_delay);
        write_function(f, "EXP",
                       (const double[]){s->u.exponential.low, s->u.exponential.high,
                                        s->u.exponential.rise_delay, s->u.exponential.rise_tau,
                                        s->u.exponential.fall_delay, s->u.exponential.fall_tau},
                       falls ? 6 : 4, 6);
        break;
    }
    case DALCS_STIMULUS_PWL:
        write_points(f, s);
        break;
    case DALCS_STIMULUS_TONES:
        write_tones(f, s);
        break;
    case DALCS_STIMULUS_FORMULA:
        write_formula(f, s);
        break;
    case DALCS_STIMULUS_DELAYED: /* refused before */
        break;
    }
}
