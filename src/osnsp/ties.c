/* ties.c - diodes with lambda = 0 = w, and the answers they may leave a choice between.
 *
 * The answers of a monotone problem are one convex set, on which complementarity keeps every pair but
 * the tied ones where it is (Cottle, Pang and Stone 1992, thm 3.1.7). In a regular mode two answers
 * therefore differ in a tied pair, where they can only grow: an answer as near as possible to this one
 * pushed up in all tied pairs is another one if there is any. What follows from a mode and its ties
 * holds for every right-hand side, so it is asked once. */
#include "osnsp_internal.h"

#include "magnitudes.h"

#include <math.h>
#include <string.h>

static enum dalcs_status is_singular(struct dalcs_osnsp *p, int byte, bool *singular) {
    struct dalcs_mode_entry *e;
    memset(p->mode, byte, (size_t)p->n_words * sizeof(*p->mode));
    if (p->system->n_pairs % 64 != 0) {
        p->mode[p->n_words - 1] &= ((uint64_t)1 << p->system->n_pairs % 64) - 1;
    }
    DALCS_TRY(dalcs_modes_get(p, DALCS_PLAIN, &e));
    *singular = e->singular;
    return DALCS_OK;
}

/* Two answers of a passive circuit differ by something that dissipates nothing: voltages that float
 * with all pairs open, or currents that circulate with all pairs closed. Most circuits have neither,
 * and pay for ties no more than this one look. */
static enum dalcs_status count_answers(struct dalcs_osnsp *p) {
    bool floats;
    bool circulates = true;
    size_t bytes = (size_t)p->n_words * sizeof(*p->mode);
    memcpy(p->work.tied_mode, p->mode, bytes);
    enum dalcs_status status = is_singular(p, 0, &floats);
    if (status == DALCS_OK && !floats) {
        status = is_singular(p, 0xff, &circulates);
    }
    memcpy(p->mode, p->work.tied_mode, bytes);
    if (status == DALCS_OK) {
        p->cache.form[0]->answers = floats || circulates ? DALCS_MANY : DALCS_UNIQUE;
    }
    return status;
}

/* What dissipates nothing does so in steps of any length. Where small problems are factored without a look at
 * their conditions, that of another step tells it. */
static bool is_unique_in_other_steps(const struct dalcs_osnsp *p) {
    bool is_unique = false;
    for (int k = 1; k < p->cache.n_forms && p->asks.is_passing && p->cache.form[0]->sigma > 0.0;
         k++) {
        const struct dalcs_step_form *f = p->cache.form[k];
        is_unique = is_unique || (f->sigma > 0.0 && f->answers == DALCS_UNIQUE);
    }
    return is_unique;
}

/* Names the set of tied pairs: FNV-1a, never 0. */
uint64_t dalcs_ties_name(const struct dalcs_osnsp *p) {
    uint64_t name = 14695981039346656037u;
    for (int d = 0; d < p->system->n_pairs; d++) {
        if (p->signs.tied[d]) {
            name = (name ^ (uint64_t)d) * 1099511628211u;
        }
    }
    return name != 0 ? name : 1;
}

/* Tied pairs are pushed by a small part of the largest current or voltage of a pair, for a choice may end soon; and where
 * all are 0, nothing is smaller. But currents are small beside voltages, and a sign would not tell that one has been
 * pushed: in micro-steps it is by as much as that takes. One moves by a part of the push when there is a choice; of rounding
 * and of the regularisation, less. */
static enum dalcs_status look_for_choice(struct dalcs_osnsp *p, const double *u, const double *y,
                                         bool *has_choice) {
    const struct dalcs_step_form *f = p->cache.form[0];
    double push = 0.0;
    double push_w = 0.0;
    dalcs_osnsp_scale(p, y);
    dalcs_csr_multiply(&f->R, u, p->work.right);
    memcpy(p->work.centre, p->work.scaled, (size_t)(f->n + f->n_pairs) * sizeof(double));
    for (int d = 0; d < f->n_pairs; d++) {
        p->work.centre_w[d] = f->row_scale[f->n + d] * p->w[d];
        push = fmax(push, dalcs_small * fabs(p->work.scaled[f->n + d]));
        double v = p->work.centre_w[d] - f->row_scale[f->n + d] * dalcs_system_knee(p->system, d);
        push_w = fmax(push_w, dalcs_small * fmax(fabs(p->work.centre_w[d]), fabs(v)));
    }
    if (p->asks.is_passing && push > 0.0) {
        push = fmax(push, dalcs_proximal_least_push(p));
    }
    for (int d = 0; d < f->n_pairs; d++) {
        p->work.centre[f->n + d] += p->signs.tied[d] ? push : 0.0;
        p->work.centre_w[d] += p->signs.tied[d] ? push_w : 0.0;
    }
    bool mode_changed;
    enum dalcs_status status = dalcs_proximal_pivot(p, u, &mode_changed);
    *has_choice = false;
    for (int d = 0; status == DALCS_OK && d < f->n_pairs && !*has_choice; d++) {
        bool moves = (push > 0.0 && p->work.scaled[f->n + d] > dalcs_slight * push) ||
                     (push_w > 0.0 && dalcs_proximal_scaled_w(p, d) > dalcs_slight * push_w);
        *has_choice = p->signs.tied[d] && moves;
    }
    return status;
}

/* Did the push make another pair change sides? Then there is a choice, now as small as that pair's
 * distance from doing so: as where a diode has just begun to block. */
static bool was_stopped(const struct dalcs_osnsp *p) {
    bool stopped = false;
    for (int d = 0; d < p->system->n_pairs && !stopped; d++) {
        uint64_t changed = p->mode[d / 64] ^ p->work.tied_mode[d / 64];
        stopped = !p->signs.tied[d] && (changed >> (d % 64) & 1) != 0;
    }
    return stopped;
}

enum dalcs_status dalcs_ties_settle(struct dalcs_osnsp *p, const double *u, double *y) {
    if (p->cache.form[0]->answers == DALCS_UNKNOWN && is_unique_in_other_steps(p)) {
        p->cache.form[0]->answers = DALCS_UNIQUE;
    } else if (p->cache.form[0]->answers == DALCS_UNKNOWN) {
        DALCS_TRY(count_answers(p));
    }
    if (p->cache.form[0]->answers == DALCS_UNIQUE) {
        return DALCS_OK;
    }
    size_t mode_bytes = (size_t)p->n_words * sizeof(*p->mode);
    size_t answer_bytes = (size_t)dalcs_system_n_columns(p->system) * sizeof(*y);
    uint64_t tie = dalcs_ties_name(p);
    struct dalcs_mode_entry *e;
    DALCS_TRY(dalcs_modes_get(p, DALCS_PLAIN, &e));
    if (e->tie == tie && !e->tie_has_choice) {
        return DALCS_OK;
    }
    memcpy(p->work.tied_mode, p->mode, mode_bytes);
    memcpy(p->work.tied_answer, y, answer_bytes);
    bool has_choice = true;
    enum dalcs_status status = DALCS_OK;
    if (e->tie != tie) {
        status = look_for_choice(p, u, y, &has_choice);
        bool stopped = !has_choice && was_stopped(p);
        has_choice = has_choice || stopped;
        memcpy(p->mode, p->work.tied_mode, mode_bytes);
        DALCS_TRY(dalcs_modes_get(p, DALCS_PLAIN, &e));
        e->tie = stopped ? 0 : tie; /* to be asked again */
        e->tie_has_choice = has_choice;
    }
    if (status == DALCS_OK && has_choice) {
        status = dalcs_proximal_solve(p, u, y);
    }
    if (status < DALCS_OK || (status == DALCS_OK && has_choice)) {
        p->least_norm = status == DALCS_OK;
        return status;
    }
    /* No choice, or none that could be certified: the answer that was. */
    memcpy(p->mode, p->work.tied_mode, mode_bytes);
    memcpy(y, p->work.tied_answer, answer_bytes);
    bool sources_clash;
    dalcs_certificate_evaluate_either(p, u, y, &sources_clash);
    return DALCS_OK;
}
