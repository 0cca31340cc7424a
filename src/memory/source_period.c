/* source_period.c - the common period of all sources that a part sees. */
#include "source_period.h"

#include "pi.h"
#include "rounding.h"

#include <math.h>
#include <stdlib.h>

/* Periods of the slowest source that may be one of all sources. */
enum { MOST_PERIODS = 64 };

/* omega[*n], in 1/s, of all that oscillates: sources as the part sees them, and those that command its switches.
 * false: there is something else, which has no such period. */
static bool list_oscillations(const struct dalcs_radau_part *part, double *omega, int *n) {
    const struct dalcs_excitation *e = &part->excitation;
    const struct dalcs_control *control = &part->commands.control;
    const struct dalcs_csr *a = &part->component->system->direct_control;
    bool all = true;
    *n = 0;
    for (int k = 0; k < e->n_functions && all; k++) {
        omega[*n] = fabs(e->function[k].omega);
        *n += omega[*n] != 0.0 ? 1 : 0;
        all = e->function[k].decay == 0.0;
    }
    for (int k = 0; k < a->p[a->n_rows] && all; k++) {
        const struct dalcs_stimulus *s = dalcs_control_stimulus(control, a->j[k]);
        if (s == NULL || s->kind == DALCS_STIMULUS_DC) {
            continue;
        }
        struct dalcs_stimulus_piece piece = {.term = control->term};
        dalcs_stimulus_piece_at(s, 0.0, &piece);
        all = piece.n_terms > 0;
        for (int i = 0; i < piece.n_terms && all; i++) {
            omega[*n] = fabs(piece.term[i].omega);
            *n += omega[*n] != 0.0 ? 1 : 0;
            all = piece.term[i].decay == 0.0;
        }
    }
    return all;
}

/* Of oscillations; 0: they have none. */
static double common_period(const double *omega, int n_omegas) {
    double slowest = INFINITY;
    for (int k = 0; k < n_omegas; k++) {
        slowest = fmin(slowest, omega[k]);
    }
    for (int n = 1; n <= MOST_PERIODS && isfinite(slowest); n++) {
        bool is_common = true;
        for (int k = 0; k < n_omegas && is_common; k++) {
            double periods = n * omega[k] / slowest;
            is_common = fabs(periods - rint(periods)) <= dalcs_rounded * periods;
        }
        if (is_common) {
            return n * dalcs_two_pi / slowest;
        }
    }
    return 0.0;
}

enum dalcs_status dalcs_source_period(const struct dalcs_radau_part *part, double *period) {
    const struct dalcs_csr *a = &part->component->system->direct_control;
    size_t most =
        (size_t)part->excitation.n_functions +
        (size_t)a->p[a->n_rows] * (size_t)dalcs_control_most_terms(&part->commands.control);
    double *omega = dalcs_alloc(most + 1, sizeof(*omega));
    if (omega == NULL) {
        return DALCS_E_NOMEM;
    }
    int n;
    *period = list_oscillations(part, omega, &n) ? common_period(omega, n) : 0.0;
    free(omega);
    return DALCS_OK;
}
