/* enumerate.c - every mode of a small system, where pivoting finds none.
 *
 * A system that is not passive may have a solution that neither pivoting nor the proximal method
 * comes to, several, or none; and no ray proves the last. A passive one has been answered before in
 * its singular modes; its regular ones are tried against widely spread values. */
#include "osnsp_internal.h"

/* Diodes up to which 2^n modes are tried. */
enum { ENUMERATION_LIMIT = 12 };

enum dalcs_status dalcs_enumerate(struct dalcs_osnsp *p, const double *u, double *y) {
    const struct dalcs_system *s = p->system;
    int diode[ENUMERATION_LIMIT];
    int n = 0;
    for (int d = 0; d < s->n_pairs; d++) {
        if (p->is_diode[d]) {
            if (n == ENUMERATION_LIMIT) {
                return DALCS_NOT_CONVERGED;
            }
            diode[n++] = d;
        }
    }
    for (unsigned code = 1; code <= 1u << n; code++) {
        /* Gray code: one flip from mode to mode, and the last flip closes the cycle. */
        int bit = code < 1u << n ? __builtin_ctz(code) : n - 1;
        if (n > 0) {
            dalcs_osnsp_flip(p, diode[bit]);
        }
        bool sources_clash;
        enum dalcs_status status = dalcs_osnsp_try_mode(p, u, y, &sources_clash);
        if (status == DALCS_OK && dalcs_certificate_holds(p, sources_clash)) {
            return DALCS_OK;
        }
        if (status == DALCS_SINGULAR && !s->monotone) {
            status = dalcs_proximal_in_mode(p, u, y);
            if (status == DALCS_OK) {
                p->least_norm = true;
                return DALCS_OK;
            }
        }
        if (status < DALCS_OK) {
            return status;
        }
        p->counters.pivots++;
    }
    return s->monotone ? DALCS_NOT_CONVERGED : DALCS_INFEASIBLE;
}
