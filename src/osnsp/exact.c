/* exact.c - the answer of one mode, singular or not, to all digits that it has, and that of least norm where weights lead. */
#include "osnsp_internal.h"
#include "whole.h"

#include <stdlib.h>
#include <string.h>

/* Changes of the mode that are of all pairs with a wrong sign at once, before they are of one. */
enum { ROUNDS_AT_ONCE = 10 };

enum dalcs_status dalcs_exact_evaluate(struct dalcs_osnsp *p, struct dalcs_whole *whole,
                                       const double *u, double *y, bool *sources_clash) {
    dalcs_whole_solve(whole, u, NULL, y);
    dalcs_certificate_evaluate_either(p, u, y, sources_clash);
    if (p->signs.n_violating > 0 || dalcs_certificate_holds(p, *sources_clash)) {
        return DALCS_OK;
    }
    bool changed;
    DALCS_TRY(dalcs_whole_leave_largest(whole, u, y, &changed));
    if (changed) {
        dalcs_whole_solve(whole, u, NULL, y);
        dalcs_certificate_evaluate_either(p, u, y, sources_clash);
    }
    return DALCS_OK;
}

/* The factors of p->mode with its choices; a singular mode keeps them, for its next problem. */
static enum dalcs_status factor_whole(struct dalcs_osnsp *p, struct dalcs_mode_entry *entry,
                                      struct dalcs_whole **whole) {
    *whole = malloc(sizeof(**whole));
    enum dalcs_status status = *whole == NULL ? DALCS_E_NOMEM : dalcs_whole_factor(*whole, p, NULL);
    if (status != DALCS_OK) {
        entry->is_too_open = status == DALCS_SINGULAR;
        free(*whole);
        return status;
    }
    if (entry->singular) {
        entry->whole = *whole;
        dalcs_modes_grew(p, entry, dalcs_whole_bytes(*whole));
    }
    return DALCS_OK;
}

/* In p->mode. From the first certified answer on, a singular mode is treated as any other. */
static enum dalcs_status try_whole(struct dalcs_osnsp *p, struct dalcs_mode_entry *entry,
                                   const double *u, double *y, bool *sources_clash) {
    if (entry->is_too_open) {
        return DALCS_SINGULAR;
    }
    struct dalcs_whole *whole = entry->whole;
    if (whole == NULL) {
        DALCS_TRY(factor_whole(p, entry, &whole));
    }
    enum dalcs_status status = dalcs_exact_evaluate(p, whole, u, y, sources_clash);
    p->least_norm = whole->n_choices > 0;
    if (entry->singular) {
        entry->answers = status == DALCS_OK && dalcs_certificate_holds(p, *sources_clash);
    } else {
        dalcs_whole_finish(whole);
        free(whole);
    }
    return status;
}

enum dalcs_status dalcs_exact_try_mode(struct dalcs_osnsp *p, const double *u, double *y,
                                       bool *sources_clash) {
    struct dalcs_mode_entry *entry;
    DALCS_TRY(dalcs_modes_get(p, DALCS_PLAIN, &entry));
    enum dalcs_status status = dalcs_osnsp_try_mode(p, u, y, sources_clash);
    bool is_settled = status == DALCS_OK && (dalcs_certificate_holds(p, *sources_clash) ||
                                             (p->signs.n_violating > 0 && !entry->singular));
    if (status < DALCS_OK || is_settled || entry->answers) {
        return status;
    }
    return try_whole(p, entry, u, y, sources_clash);
}

enum dalcs_status dalcs_exact_keep_states(struct dalcs_osnsp *p, const double *u, double *y,
                                          bool *sources_clash) {
    struct dalcs_mode_entry *entry;
    DALCS_TRY(dalcs_modes_get(p, DALCS_PLAIN, &entry));
    if (entry->singular) {
        return try_whole(p, entry, u, y, sources_clash);
    }
    struct dalcs_whole *whole;
    DALCS_TRY(factor_whole(p, entry, &whole));
    dalcs_whole_solve(whole, u, NULL, y);
    dalcs_certificate_evaluate_with_states(p, u, y, sources_clash);
    dalcs_whole_finish(whole);
    free(whole);
    return DALCS_OK;
}

/* The pair with the wrong sign, if it is one alone. */
static int wrong_alone(const struct dalcs_osnsp *p) {
    return p->signs.n_violating == 1 ? p->signs.violating[0] : -1;
}

/* Where a pair that was turned alone has the wrong sign on its other side, too, it has neither current nor voltage, as a
 * diode has that alone leads to an island: closed, its current is what rounding leaves of the island's. Open, it leaves the
 * island's potential to choose, within its sign. */
enum dalcs_status dalcs_exact_pivot(struct dalcs_osnsp *p, const double *u, double *y, int limit) {
    int turned = -1;
    for (int round = 0; round <= limit; round++) {
        bool sources_clash;
        DALCS_TRY(dalcs_exact_try_mode(p, u, y, &sources_clash));
        if (dalcs_certificate_holds(p, sources_clash)) {
            return DALCS_OK;
        }
        if (p->signs.n_violating == 0) {
            break;
        }
        if (p->least_norm && turned >= 0 && wrong_alone(p) == turned) {
            enum dalcs_status status = dalcs_open_mode_solve(p, u, y);
            if (status <= DALCS_OK) {
                return status;
            }
            DALCS_TRY(dalcs_exact_try_mode(p, u, y, &sources_clash)); /* its signs again */
        }
        if (round == limit) {
            break;
        }
        turned = wrong_alone(p);
        dalcs_osnsp_flip_violating(p, round < ROUNDS_AT_ONCE);
        p->counters.pivots++;
    }
    return DALCS_NOT_CONVERGED;
}

/* In a singular mode. */
static enum dalcs_status try_singular(struct dalcs_osnsp *p, const double *u, double *y) {
    const enum dalcs_status status = dalcs_exact_pivot(p, u, y, 0);
    return status == DALCS_NOT_CONVERGED ? dalcs_open_mode_solve(p, u, y) : status;
}

/* Opens the closed pairs of the answer that have neither current nor voltage; false: there are none. */
static bool open_tied_pairs(struct dalcs_osnsp *p) {
    bool any = false;
    for (int d = 0; d < p->system->n_pairs; d++) {
        if (p->signs.tied[d] && dalcs_osnsp_is_on(p, d)) {
            dalcs_osnsp_flip(p, d);
            any = true;
        }
    }
    return any;
}

/* With its tied pairs open the mode has the answer y, too, and the one of least norm is among its answers: the reverse
 * voltage of a diode counts from 0 V, and at its knee it is not least. */
static enum dalcs_status open_ties(struct dalcs_osnsp *p, const double *u, double *y) {
    size_t bytes = (size_t)p->n_words * sizeof(*p->mode);
    memcpy(p->work.regularised_mode, p->mode, bytes);
    if (!open_tied_pairs(p)) {
        return DALCS_OK;
    }
    struct dalcs_mode_entry *entry;
    enum dalcs_status status = dalcs_modes_get(p, DALCS_PLAIN, &entry);
    if (status == DALCS_OK) {
        status = entry->singular ? try_singular(p, u, y) : DALCS_NOT_CONVERGED;
    }
    if (status > DALCS_OK) {
        memcpy(p->mode, p->work.regularised_mode, bytes);
        status = try_singular(p, u, y);
    }
    return status;
}

enum dalcs_status dalcs_exact_least_norm(struct dalcs_osnsp *p, const double *u, double *y,
                                         int limit) {
    size_t bytes = (size_t)p->n_words * sizeof(*p->mode);
    memcpy(p->work.regularised_mode, p->mode, bytes);
    const enum dalcs_status status =
        limit == 0 ? try_singular(p, u, y) : dalcs_exact_pivot(p, u, y, limit);
    if (status != DALCS_OK) {
        memcpy(p->mode, p->work.regularised_mode, bytes);
        return status;
    }
    /* In a step the mode is also what the next one begins in: there an island that only a tied pair holds stays held. */
    const bool at_rest = p->cache.form[0]->sigma == 0.0;
    return at_rest && p->signs.n_tied > 0 && dalcs_osnsp_is_monotone(p) ? open_ties(p, u, y)
                                                                        : DALCS_OK;
}
