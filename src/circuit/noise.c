/* noise.c - LTspice's rand(x), random(x) and white(x) of a straight line in time.
 *
 * Each whole x has a random value of its own, the same whenever it is asked for: rand holds it, random and white go on
 * straight lines from one to the next. So each is a PWL up to the end of the run, and its corners are met exactly. */
#include "behaviour.h"

#include "draws.h"

#include <math.h>
#include <string.h>

/* A netlist with more is taken for a slip: a PWL of this length takes 16 MB. */
static const double MOST_VALUES = 1e6;

static double value_at(enum dalcs_wave_shape shape, double x) {
    const double whole = floor(x);
    const double first = dalcs_draw_at(whole);
    return shape == DALCS_HELD_NOISE ? first
                                     : first + (x - whole) * (dalcs_draw_at(whole + 1) - first);
}

static double end_of_run(const struct dalcs_compiler *c) {
    return c->builder->analyses.tran != NULL ? c->builder->circuit->analyses.transient.stop : 0;
}

/* rate t + offset */
static bool find_line(struct dalcs_compiler *c, const struct dalcs_formula *f, double *rate,
                      double *offset) {
    const struct dalcs_form *form = dalcs_compile(c, f);
    const bool is_number = form != NULL && dalcs_form_is_number(form);
    if (form == NULL || form->n > 0 || (!is_number && !dalcs_affine_is_time(&form->affine))) {
        return false;
    }
    *rate = is_number ? 0 : form->affine.term[0].coefficient;
    *offset = form->affine.constant;
    return true;
}

static const struct dalcs_form *refuse(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                       const char *hint, const char *format) {
    if (!c->failed && !c->is_silent) {
        dalcs_builder_error_at(c->builder, &f->where, hint, format, f->function);
    }
    c->failed = true;
    return NULL;
}

const struct dalcs_form *dalcs_noise_form(struct dalcs_compiler *c, const struct dalcs_formula *f) {
    double rate;
    double offset;
    if (!find_line(c, f->argument[0], &rate, &offset)) {
        return refuse(c, f, "rand(10k*time + 3) has a value every 100 us",
                      "the argument of %s(...) is a straight line in time");
    }
    if (fabs(rate) * end_of_run(c) > MOST_VALUES) {
        return refuse(c, f, "a lower rate, or a shorter .tran",
                      "%s(...) has more than a million values in this run");
    }
    const struct dalcs_wave wave = {.shape = strcmp(f->function, "rand") == 0 ? DALCS_HELD_NOISE
                                                                              : DALCS_LINEAR_NOISE,
                                    .frequency = rate,
                                    .phase = offset};
    const struct dalcs_form *noise =
        rate == 0 ? dalcs_form_number(c, value_at(wave.shape, offset)) : dalcs_wave_value(c, &wave);
    const double shift = strcmp(f->function, "white") == 0 ? -0.5 : 0;
    return shift == 0 ? noise : dalcs_form_add(c, dalcs_form_number(c, shift), 1, noise);
}

int dalcs_noise_stimulus(struct dalcs_compiler *c, const struct dalcs_wave *wave) {
    const bool holds = wave->shape == DALCS_HELD_NOISE;
    const bool rises = wave->frequency > 0;
    const int n_values = (int)(fabs(wave->frequency) * end_of_run(c)) + 2;
    const int n = 1 + (holds ? 2 : 1) * n_values;
    double *t = dalcs_arena_alloc(&c->builder->circuit->arena, (size_t)n, sizeof *t);
    double *v = dalcs_arena_alloc(&c->builder->circuit->arena, (size_t)n, sizeof *v);
    if (t == NULL || v == NULL) {
        c->builder->out_of_memory = c->failed = true;
        return -1;
    }
    double whole = rises ? floor(wave->phase) : ceil(wave->phase); /* passed last */
    int k = 0;
    t[k] = 0;
    v[k++] = value_at(wave->shape, rises ? wave->phase : nextafter(wave->phase, -(double)INFINITY));
    for (int i = 0; i < n_values; i++) {
        whole += rises ? 1 : -1;
        const double at = (whole - wave->phase) / wave->frequency;
        if (holds) {
            t[k] = at;
            v[k] = v[k - 1];
            k++;
        }
        t[k] = at;
        v[k++] = dalcs_draw_at(rises || !holds ? whole : whole - 1);
    }
    const struct dalcs_stimulus s = {.kind = DALCS_STIMULUS_PWL, .u.pwl = {.n = k, .t = t, .v = v}};
    return dalcs_compiler_add_stimulus(c, &s);
}
