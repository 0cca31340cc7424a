/* periodic_margins.c - crossings between two frequencies of a sweep, on the response itself, not on its rows. */
#include "periodic_margins.h"
#include "pi.h"

#include "dalcs.h"

#include <math.h>
#include <stdlib.h>

/* Halves of an interval of frequencies until they are the same. */
enum { MOST_HALVINGS = 60 };

/* What changes its sign where the gain is 1, and where it is real. */
static double excess(double complex gain, bool of_phase) {
    return of_phase ? cimag(gain) : cabs(gain) - 1.0;
}

/* The crossing between the last frequency and b, by bisection. */
static enum dalcs_status find(struct dalcs_margins *m, bool of_phase, double b, double *frequency,
                              double complex *gain) {
    const bool begins_above = excess(m->last_gain, of_phase) > 0.0;
    double a = m->last;
    for (int k = 0; k < MOST_HALVINGS && b > a; k++) {
        const double middle = 0.5 * (a + b);
        if (!(middle > a && middle < b)) {
            break;
        }
        DALCS_TRY(m->at(m->user, middle, gain));
        *frequency = middle;
        if ((excess(*gain, of_phase) > 0.0) == begins_above) {
            a = middle;
        } else {
            b = middle;
        }
    }
    return DALCS_OK;
}

static enum dalcs_status look(struct dalcs_margins *m, bool of_phase, double frequency,
                              double complex gain) {
    const bool began_above = excess(m->last_gain, of_phase) > 0.0;
    if (began_above == (excess(gain, of_phase) > 0.0)) {
        return DALCS_OK;
    }
    double at = frequency;
    double complex there = gain;
    DALCS_TRY(find(m, of_phase, frequency, &at, &there));
    if (of_phase && creal(there) < 0.0) {
        DALCS_TRY(dalcs_grow(&m->reversal, &m->reversal_capacity, m->n_reversals + 1,
                             sizeof *m->reversal));
        m->reversal[m->n_reversals++] = (struct dalcs_margin){at, -20.0 * log10(cabs(there))};
    }
    if (!of_phase) {
        DALCS_TRY(dalcs_grow(&m->crossover, &m->crossover_capacity, m->n_crossovers + 1,
                             sizeof *m->crossover));
        m->crossover[m->n_crossovers++] =
            (struct dalcs_margin){at, carg(-there) * 180.0 / dalcs_pi};
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_margins_reach(struct dalcs_margins *m, double frequency,
                                      double complex gain) {
    if (m->has_last && frequency > m->last) {
        DALCS_TRY(look(m, false, frequency, gain));
        DALCS_TRY(look(m, true, frequency, gain));
    }
    m->has_last = true;
    m->last = frequency;
    m->last_gain = gain;
    return DALCS_OK;
}

void dalcs_margins_finish(struct dalcs_margins *m) {
    free(m->crossover);
    free(m->reversal);
    *m = (struct dalcs_margins){0};
}
