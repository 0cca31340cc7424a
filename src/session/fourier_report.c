/* fourier_report.c - what .four has measured, into the report; what could not be, in words. */
#include "measures.h"

#include "quantity.h"

#include <math.h>
#include <string.h>

/* A period and a frequency that were written with nine digits: each is off by up to 5e-9 of itself. */
static const double same_frequency = 1e-8;

/* The measurement that a formula needs and that failed; NULL: none. */
static const struct dalcs_measure_card *failed_in(const struct dalcs_circuit *c,
                                                  const struct dalcs_signal_formula *formula,
                                                  const double *results) {
    for (int k = 0; k < formula->n; k++) {
        const struct dalcs_signal_formula_step *step = &formula->step[k];
        if (step->push == DALCS_PUT_RESULT && isnan(results[step->index])) {
            return &c->results.measure[step->index];
        }
    }
    return NULL;
}

const struct dalcs_measure_card *dalcs_measures_failed_source(const struct dalcs_circuit *c,
                                                              const struct dalcs_measure_card *card,
                                                              const double *results) {
    const struct dalcs_signal_formula *const formula[] = {
        &card->formula,
        &card->from_formula,
        &card->to_formula,
        &card->instant[0].difference,
        &card->instant[0].at_formula,
        &card->instant[0].delay_formula,
        &card->instant[1].difference,
        &card->instant[1].at_formula,
        &card->instant[1].delay_formula,
    };
    const struct dalcs_measure_card *failed = NULL;
    for (size_t k = 0; k < sizeof formula / sizeof formula[0] && failed == NULL; k++) {
        failed = failed_in(c, formula[k], results);
    }
    return failed;
}

/* An orbit has components at multiples of its own frequency alone. One without a clock is known only afterwards. */
static void warn_of_frequency(struct dalcs_run *r, const struct dalcs_measuring *m,
                              const struct dalcs_harmonics *h) {
    const double asked = h->card->frequency;
    char text[2][DALCS_QUANTITY_SIZE];
    if (m->analysis == DALCS_MEASURED_PSS && !r->s->results.report.steady.self_oscillating &&
        fabs(h->frequency / asked - 1.0) > same_frequency) {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, &h->card->where, NULL,
                       "the orbit has no component at %s: these are multiples of %s",
                       dalcs_quantity_write(text[0], asked, "Hz", 9),
                       dalcs_quantity_write(text[1], h->frequency, "Hz", 9));
    }
}

/* Magnitudes and phases (degrees) of [n] harmonics. */
static void list_lines(const struct dalcs_harmonics *h, size_t n, double *magnitude,
                       double *phase) {
    for (size_t i = 0; i < n; i++) {
        double factor = i == 0 ? 1.0 : 2.0;
        magnitude[i] = i == 0 ? h->cosine[0] : factor * hypot(h->cosine[i], h->sine[i]);
        phase[i] = i == 0 ? 0.0 : 57.295779513082320877 * atan2(h->cosine[i], h->sine[i]);
    }
}

/* Against a fundamental. One below the tolerance of the run is what the run is off by: there is none then. */
static double distortion_of(const struct dalcs_run *r, const struct dalcs_harmonics *h, size_t n,
                            const double *magnitude) {
    const double resolved = r->tolerance * h->scale;
    if (!(magnitude[1] > resolved)) {
        char text[DALCS_QUANTITY_SIZE];
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, &h->card->where,
                       "a THD needs the frequency of the signal; reltol and --tol resolve more",
                       "'%s' has no fundamental and no THD: its component at %s, %.3g, is below "
                       "%.3g, which the run resolves",
                       h->card->formula.text, dalcs_quantity_write(text, h->frequency, "Hz", 9),
                       magnitude[1], resolved);
        return NAN;
    }
    double square = 0.0;
    for (size_t i = 2; i < n; i++) {
        square += magnitude[i] * magnitude[i];
    }
    return sqrt(square) / magnitude[1];
}

enum dalcs_status dalcs_measures_tell_harmonics(struct dalcs_measures *measures,
                                                struct dalcs_run *r) {
    const struct dalcs_measuring *m = &measures->measuring;
    size_t n = (size_t)m->n_harmonics;
    const size_t n_before = r->s->results.report.n_fourier; /* of .pss before a .tran */
    struct dalcs_fourier *fourier = dalcs_arena_alloc(&r->s->arena, n_before + n, sizeof(*fourier));
    for (size_t k = 0; fourier != NULL && k < n_before; k++) {
        fourier[k] = r->s->results.report.fourier[k];
    }
    r->s->results.report.fourier = fourier;
    for (size_t k = 0; fourier != NULL && k < n; k++) {
        const struct dalcs_harmonics *h = &m->harmonics[k];
        size_t n_lines = (size_t)h->card->n_harmonics + 1;
        double *magnitude = dalcs_arena_alloc(&r->s->arena, n_lines, sizeof(double));
        double *phase = dalcs_arena_alloc(&r->s->arena, n_lines, sizeof(double));
        if (magnitude == NULL || phase == NULL) {
            return DALCS_E_NOMEM;
        }
        if (h->from < m->start - 1e-9 * m->stop || h->has_no_value || h->is_means) {
            dalcs_diag_add(
                &r->s->diag, DALCS_WARNING, &h->card->where, NULL,
                h->is_means ? "'%s': a switch slides along its threshold meanwhile, where "
                              "signals are means over its positions, and this is not linear in "
                              "them: no Fourier analysis"
                : h->has_no_value && h->n_impulses > 0
                    ? "'%s' has an impulse, whose area the circuit or the formula does not tell: "
                      "no Fourier analysis"
                : h->has_no_value ? "'%s' is undefined at some of its times: no Fourier analysis"
                                  : "'%s': the run is shorter than the periods that are to "
                                    "be analysed",
                h->card->formula.text);
            continue;
        }
        warn_of_frequency(r, m, h);
        list_lines(h, n_lines, magnitude, phase);
        const double thd = distortion_of(r, h, n_lines, magnitude);
        const char *text = h->card->formula.text;
        const char *signal = dalcs_arena_copy(&r->s->arena, text, strlen(text));
        if (signal == NULL) {
            return DALCS_E_NOMEM;
        }
        fourier[r->s->results.report.n_fourier++] =
            (struct dalcs_fourier){.signal = signal,
                                   .frequency = h->frequency,
                                   .from = h->from,
                                   .to = h->to,
                                   .thd = thd,
                                   .n_harmonics = n_lines,
                                   .magnitude = magnitude,
                                   .phase = phase};
        dalcs_audit_fourier_told(&measures->audit, m, (int)k,
                                 &fourier[r->s->results.report.n_fourier - 1]);
    }
    return fourier == NULL ? DALCS_E_NOMEM : DALCS_OK;
}
