/* enumerate.c - every mode of a small system that is not passive, where pivoting finds none.
 *
 * It may have a solution that neither pivoting nor the proximal method comes to, several, or none; and no ray
 * proves the last. */
#include "osnsp_internal.h"

#include "magnitudes.h"

#include <math.h>
#include <string.h>

/* Diodes up to which 2^n modes are tried. */
enum { ENUMERATION_LIMIT = 12 };

/* Lists the diodes; false when there are too many. */
static bool list_diodes(const struct dalcs_osnsp *p, int *diode, int *n) {
    *n = 0;
    for (int d = 0; d < p->system->n_pairs; d++) {
        if (p->lists.is_diode[d]) {
            if (*n == ENUMERATION_LIMIT) {
                return false;
            }
            diode[(*n)++] = d;
        }
    }
    return true;
}

/* All modes of n diodes. */
static bool may_try_all(const struct dalcs_osnsp *p, int n) {
    const long work = (long)dalcs_system_n_columns(p->system) << n;
    return p->asks.most_enumerated == 0 || work <= p->asks.most_enumerated;
}

enum dalcs_status dalcs_enumerate(struct dalcs_osnsp *p, const double *u, double *y) {
    int diode[ENUMERATION_LIMIT];
    int n;
    if (!list_diodes(p, diode, &n) || !may_try_all(p, n)) {
        return DALCS_NOT_CONVERGED;
    }
    for (unsigned code = 1; code <= 1u << n; code++) {
        /* Gray code: one flip from mode to mode, and the last flip closes the cycle. */
        int bit = code < 1u << n ? __builtin_ctz(code) : n - 1;
        if (dalcs_osnsp_is_cancelled(p)) {
            return DALCS_E_CANCELLED;
        }
        if (n > 0) {
            dalcs_osnsp_flip(p, diode[bit]);
        }
        bool sources_clash;
        p->counters.enumerated += dalcs_system_n_columns(p->system);
        enum dalcs_status status = dalcs_exact_try_mode(p, u, y, &sources_clash);
        if (status == DALCS_OK && !dalcs_certificate_holds(p, sources_clash)) {
            status = dalcs_open_mode_solve(p, u, y);
        }
        if (status <= DALCS_OK) {
            return status;
        }
        p->counters.pivots++;
    }
    return DALCS_INFEASIBLE;
}

/* Answers are one, too, where they are no farther apart than the certificate lets each be off: beside amperes 1e-17 V is
 * no other answer than 0 V. */
static bool are_same(const struct dalcs_osnsp *p, const double *a, const double *b) {
    const struct dalcs_system *s = p->system;
    double tolerance = p->options.certificate_tolerance;
    double apart[2] = {0.0, 0.0};
    double largest[2] = {0.0, 0.0};
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        int of = s->column_is_current[c] ? 1 : 0;
        apart[of] = fmax(apart[of], fabs(a[c] - b[c]));
        largest[of] = fmax(largest[of], fmax(fabs(a[c]), fabs(b[c])));
    }
    double off[2] = {tolerance * p->certificate.volt, tolerance * p->certificate.ampere};
    return apart[0] <= fmax(dalcs_alike * largest[0], off[0]) &&
           apart[1] <= fmax(dalcs_alike * largest[1], off[1]);
}

static enum dalcs_status list_answers(struct dalcs_osnsp *p, const double *u, int most,
                                      double *answer, int *n) {
    size_t n_columns = (size_t)dalcs_system_n_columns(p->system);
    int diode[ENUMERATION_LIMIT];
    int n_diodes;
    *n = 0;
    if (!list_diodes(p, diode, &n_diodes)) {
        return DALCS_OK;
    }
    for (unsigned code = 1; code <= 1u << n_diodes && *n < most; code++) {
        int bit = code < 1u << n_diodes ? __builtin_ctz(code) : n_diodes - 1;
        if (n_diodes > 0) {
            dalcs_osnsp_flip(p, diode[bit]);
        }
        double *y = answer + (size_t)*n * n_columns;
        bool sources_clash;
        enum dalcs_status status = dalcs_osnsp_try_mode(p, u, y, &sources_clash);
        if (status < DALCS_OK) {
            return status;
        }
        bool is_new = status == DALCS_OK && dalcs_certificate_holds(p, sources_clash) &&
                      dalcs_certificate_signs_hold(p, u, y);
        for (int k = 0; k < *n && is_new; k++) {
            is_new = !are_same(p, answer + (size_t)k * n_columns, y);
        }
        *n += is_new ? 1 : 0;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_osnsp_list_answers(struct dalcs_osnsp *p, double sigma, const double *u,
                                           int most, double *answer, int *n) {
    size_t bytes = (size_t)p->n_words * sizeof(*p->mode);
    if (p->cache.n_forms == 0 || p->cache.form[0]->sigma != sigma) {
        DALCS_TRY(dalcs_forms_get(p, sigma));
    }
    memcpy(p->work.tied_mode, p->mode, bytes);
    enum dalcs_status status = list_answers(p, u, most, answer, n);
    memcpy(p->mode, p->work.tied_mode, bytes);
    return status;
}
