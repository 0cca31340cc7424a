/* restless.c - switches that no position suits. */
#include "restless.h"

#include "power_of_step.h"
#include "sliding_internal.h"

#include <math.h>
#include <string.h>

/* What the control of one switch is where it is about to move. */
struct turns {
    int i; /* of p->pair; -1: the first that is found */
    bool may_slide;
    bool has_opened, has_closed;
    double closed, open;
};

/* A switch with hysteresis has no place between its positions. */
static bool counts(const struct dalcs_positions *p, int i, const struct turns *of) {
    return !of->may_slide || dalcs_pair_remembers(&p->osnsp->system->pair[p->pair[i]]);
}

static void note(const struct dalcs_positions *p, const double *y, struct turns *of) {
    for (int i = 0; i < p->n && of->i < 0; i++) {
        of->i = counts(p, i, of) && dalcs_positions_moves(p, i, y) ? i : -1;
    }
    if (of->i < 0 || !dalcs_positions_moves(p, of->i, y)) {
        return;
    }
    const int pair = p->pair[of->i];
    const double control = dalcs_csr_row_dot(&p->osnsp->system->control, pair, y);
    if (dalcs_osnsp_is_on(p->osnsp, pair)) {
        of->has_opened = true;
        of->closed = control;
    } else {
        of->has_closed = true;
        of->open = control;
    }
}

/* From y, the answer where the switches stand: all that want to move do, as often as it takes to come round. A chain of n
 * takes n rounds to where it comes round, and twice as many to do so. Each round is a step from where the one before ends:
 * a capacitor that a switch has discharged at once is empty where it opens. */
static enum dalcs_status go_round(struct dalcs_positions *p, double sigma, double *u, double *y,
                                  struct turns *of) {
    const int n_before = p->n + 1;
    const size_t n_states = (size_t)p->osnsp->system->n_x * sizeof(*u);
    enum dalcs_status status = DALCS_OK;
    for (int k = 0; k < 4 * n_before && status == DALCS_OK; k++) {
        if (k >= n_before) {
            note(p, y, of);
        }
        if ((of->has_opened && of->has_closed) || !dalcs_positions_move_all_once(p, y)) {
            break;
        }
        memcpy(u, y, n_states);
        status = dalcs_osnsp_solve(p->osnsp, sigma, u, y);
    }
    return status < DALCS_OK ? status : DALCS_OK;
}

/* Of those that go to and fro between two positions, some follow others: what these do decides. */
static bool slides(const struct dalcs_positions *p, const struct turns *of) {
    bool any = false;
    for (int i = 0; i < p->n && p->alternates && !any; i++) {
        any = counts(p, i, of) && dalcs_turning_leads(p, i);
    }
    return p->alternates && !any;
}

static enum dalcs_status turn_at(struct dalcs_positions *p, double sigma,
                                 const struct dalcs_restless_step *at, double *y,
                                 struct turns *of) {
    const struct dalcs_system *s = p->osnsp->system;
    enum dalcs_status status = dalcs_positions_solve(p, sigma, at->u, y);
    if (status != DALCS_OK || p->settled || slides(p, of)) {
        return status < DALCS_OK ? status : DALCS_OK; /* an answer, or none that says anything */
    }
    memcpy(at->moving, at->u, (size_t)(s->n_x + s->n_inputs) * sizeof(*at->u));
    return go_round(p, sigma, at->moving, y, of);
}

/* What a switch does to its control, V or A; 0: it comes to rest. */
static double gap_of(const struct turns *of) {
    return of->has_opened && of->has_closed ? fabs(of->open - of->closed) : 0.0;
}

enum dalcs_status dalcs_restless_find(struct dalcs_positions *p, bool may_slide,
                                      const struct dalcs_restless_step *at, double *y,
                                      struct dalcs_restless *found) {
    struct turns whole = {.i = -1, .may_slide = may_slide};
    struct turns half;
    found->pair = -1;
    DALCS_TRY(turn_at(p, at->sigma, at, y, &whole));
    half = (struct turns){.i = whole.i, .may_slide = may_slide};
    if (gap_of(&whole) == 0.0) {
        return DALCS_OK;
    }
    DALCS_TRY(turn_at(p, 2.0 * at->sigma, at, y, &half));
    if (gap_of(&half) > 0.0 && dalcs_power_of_step(gap_of(&whole), gap_of(&half)) <= 0.0) {
        *found = (struct dalcs_restless){
            .pair = p->pair[half.i], .closed = half.closed, .open = half.open};
    }
    return DALCS_OK;
}
