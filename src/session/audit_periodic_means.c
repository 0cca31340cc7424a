/* audit_periodic_means.c - what is written of a frequency, as integrals over the pieces of a period. */
#include "audit_periodic.h"

#include "magnitudes.h"
#include "pi.h"

#include <math.h>

/* Of an integral over a step: of exp(-j kappa theta) times a polynomial by its values at the nodes. Gauss' rule on parts in which
 * the turning frame goes by no more than a radian is exact to rounding for polynomials of degree s. */
static void find_weights(const struct dalcs_collocation *method, double kappa,
                         double complex *weight) {
    const int n_parts = 1 + (int)fabs(kappa);
    for (int i = 0; i <= method->s; i++) {
        weight[i] = 0.0;
    }
    for (int k = 0; k < n_parts * method->s; k++) {
        const int q = k % method->s;
        const double theta = (k / method->s + method->quadrature.node[q]) / n_parts;
        const double complex share =
            method->quadrature.weight[q] / n_parts * cexp(-I * kappa * theta);
        double of[DALCS_MAX_NODES];
        dalcs_collocation_weights(method, theta, of);
        for (int i = 0; i <= method->s; i++) {
            weight[i] += share * of[i];
        }
    }
}

static struct dalcs_mean *new_mean(struct dalcs_audit_periodic *a,
                                   const struct dalcs_flow_map *map) {
    const size_t n = (size_t)a->look.response->flow->n_columns + 1;
    struct dalcs_mean *mean = dalcs_arena_alloc(&a->arena, 1, sizeof *mean);
    double complex *value = dalcs_arena_alloc(&a->arena, n, sizeof *value);
    if (mean == NULL || value == NULL) {
        return NULL;
    }
    *mean = (struct dalcs_mean){.map = map, .value = value};
    HASH_ADD_PTR(a->means, map, mean);
    return mean->hh.tbl != NULL ? mean : NULL;
}

static struct dalcs_mean *mean_of(struct dalcs_audit_periodic *a,
                                  const struct dalcs_flow_map *map) {
    const struct dalcs_periodic_response *r = a->look.response;
    const struct dalcs_periodic_flow *flow = r->flow;
    const size_t size = dalcs_periodic_flow_size(flow);
    struct dalcs_mean *mean;
    HASH_FIND_PTR(a->means, &map, mean);
    mean = mean != NULL ? mean : new_mean(a, map);
    if (mean == NULL || mean->look == a->look.number) {
        return mean;
    }
    double complex weight[DALCS_MAX_NODES];
    find_weights(flow->stages.method, a->look.other * map->h, weight);
    for (int k = 0; k <= flow->n_columns; k++) {
        mean->value[k] = 0.0;
        for (int i = 0; i <= flow->stages.method->s; i++) {
            double complex sum = 0.0;
            for (int m = 0; m < r->n_read; m++) {
                const size_t at = dalcs_periodic_flow_at(flow, i, r->read[m]);
                const bool is_open = dalcs_periodic_values_is_open(flow, map, r->read[m]);
                sum += is_open ? 0.0
                       : k == flow->n_columns
                           ? a->work.weight[r->read[m]] * map->driven[at]
                           : a->work.weight[r->read[m]] * map->state[(size_t)k * size + at];
            }
            mean->value[k] += map->h * weight[i] * sum;
        }
    }
    mean->look = a->look.number;
    return mean;
}

enum dalcs_status dalcs_periodic_means_add_piece(struct dalcs_audit_periodic *a,
                                                 const struct dalcs_piece_passed *passed) {
    const struct dalcs_flow_piece *piece = passed->piece;
    const struct dalcs_mean *mean = mean_of(a, piece->map);
    const int n_columns = a->look.response->flow->n_columns;
    if (mean == NULL) {
        return DALCS_E_NOMEM;
    }
    const double complex turn = cexp(-I * fmod(a->look.other * piece->t, dalcs_two_pi));
    for (int k = 0; k <= n_columns; k++) {
        const double complex term =
            mean->value[k] * (k < n_columns ? passed->start[k] : passed->phase);
        a->look.mean += turn * term;
        a->look.size += cabs(term);
    }
    return DALCS_OK;
}

/* The weighted sum of what jumps there. */
void dalcs_periodic_means_note_jump(struct dalcs_audit_periodic *a,
                                    const struct dalcs_periodic_side *behind) {
    const struct dalcs_periodic_response *r = a->look.response;
    struct dalcs_periodic_jump *jump = &a->seen[a->look.part].jump[a->look.event];
    *jump = (struct dalcs_periodic_jump){0};
    for (int m = 0; m < r->n_read; m++) {
        const int column = r->read[m];
        jump->value += a->work.weight[column] * (a->end.y[column] - behind->y[column]);
        jump->size += a->work.weight[column] * (fabs(a->end.y[column]) + fabs(behind->y[column]));
    }
}

/* What jumps at an event that is late has an impulse. */
void dalcs_periodic_means_add_impulse(struct dalcs_audit_periodic *a, int event,
                                      double complex late, double t) {
    const struct dalcs_periodic_jump *jump = &a->seen[a->look.part].jump[event];
    a->look.mean += jump->value * late * cexp(-I * fmod(a->look.other * t, dalcs_two_pi));
    a->look.size += fabs(jump->value) * cabs(late);
    a->look.doubt += a->laws.orbit.tolerance * jump->size * cabs(late);
}

/* The weighted sum of what is written against the integral. */
enum dalcs_status dalcs_periodic_means_check(struct dalcs_audit_periodic *a, double frequency) {
    const struct dalcs_periodic_response *r = a->look.response;
    double complex sum = 0.0;
    double size = a->look.size;
    const struct dalcs_response_columns *of = &a->rows.of[a->look.part];
    for (int m = 0; m < r->n_read; m++) {
        const int column = r->read[m];
        const double complex y = of->part[0][column] + of->part[1][column] * I;
        const double complex term = r->flow->period * a->work.weight[column] * y;
        sum += term;
        size += cabs(term);
    }
    const double off = cabs(sum - a->look.mean);
    return off <= dalcs_alike * size + a->look.doubt
               ? DALCS_OK
               : dalcs_audit_response_refute(a->run, frequency, "the mean over a period",
                                             off / size, "of its terms");
}
