/* image_sum.h - what the rows of a screen give for a stretch that is the image of a few numbers. */
#ifndef DALCS_AUDIT_IMAGE_SUM_H
#define DALCS_AUDIT_IMAGE_SUM_H

#include "screen.h"

#include "quads.h"

#include <string.h>

static inline __attribute__((always_inline)) double audit_product(int n, const double *row,
                                                                  const double *value) {
    dalcs_quad sum = {0.0};
    for (int c = 0; c < n; c += DALCS_QUAD) {
        dalcs_quad of;
        dalcs_quad by;
        dalcs_quad_load(&of, value + c);
        dalcs_quad_load(&by, row + c);
        sum += of * by;
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* The least of the signs; no number where one of them is none. */
static inline __attribute__((always_inline)) double audit_least_sign(int n_places,
                                                                     const double *place) {
    dalcs_quad least = {INFINITY, INFINITY, INFINITY, INFINITY};
    dalcs_quad sum = {0.0};
    for (int k = AUDIT_PLACE_SIGNS; k < n_places; k += DALCS_QUAD) {
        dalcs_quad of;
        dalcs_quad_load(&of, place + k);
        dalcs_quad_lower(&least, &of);
        sum += of;
    }
    const double all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
    dalcs_quad most = -least;
    return all == all ? -dalcs_quad_largest(&most) : all;
}

/* The sums of laws and states; *far: how far the input is from that at which signs were asked. */
static inline __attribute__((always_inline)) void
audit_image_laws(const double *constant, int n_places, const double *input, int n_inputs,
                 const struct audit_image_at *at, dalcs_quad *sum, double *far) {
    const double *from = at->place;
    const double *reach = at->reach;
    const double *asked = at->input;
    dalcs_quad_load(sum, constant);
    *far = 0.0;
    for (int j = 0; j < n_inputs; j++, from += n_places) {
        dalcs_quad of;
        dalcs_quad_load(&of, from);
        *sum += of * input[j];
        *far += reach[j] * fabs(input[j] - asked[j]);
    }
}

/* All signs. */
static inline __attribute__((always_inline)) void
audit_image_places(const struct audit_screen *screen, const struct dalcs_audit_polynomials *p,
                   const struct audit_image_at *at, double *place) {
    const int n_places = screen->n_places;
    for (int first = AUDIT_PLACE_SIGNS; first < n_places; first += DALCS_QUAD) {
        const double *from = at->place + first;
        dalcs_quad sum;
        dalcs_quad_load(&sum, screen->constant + first);
        for (int j = 0; j < p->n_inputs; j++, from += n_places) {
            dalcs_quad of;
            dalcs_quad_load(&of, from);
            sum += of * p->input[j];
        }
        dalcs_quad_store(place + first, &sum);
    }
}

/* The least of the signs, of which this input is the one at which they were asked. */
static inline __attribute__((always_inline)) double
audit_image_signs(const struct audit_screen *screen, const struct dalcs_audit_polynomials *p,
                  struct audit_image_at *at, double *place) {
    audit_image_places(screen, p, at, place);
    memcpy(at->input, p->input, (size_t)p->n_inputs * sizeof(double));
    const double least = audit_least_sign(screen->n_places, place);
    at->slack = screen->n_terms[AUDIT_TERM_SIGN] == 0 ? least + 1.0 : -1.0;
    return least;
}

/* How far values at a node are from the image there, place[AUDIT_PLACE_NODE]. */
static inline __attribute__((always_inline)) double
audit_image_off(const struct audit_screen *screen, const struct dalcs_audit_polynomials *p, int m,
                const double *place) {
    const int n = dalcs_quads_of(p->n_columns);
    return p->value != NULL
               ? fabs(place[AUDIT_PLACE_NODE] -
                      audit_product(n, screen->row + AUDIT_ROW_NOW * n,
                                    p->value + audit_node_at(p->n_nodes, m) * p->stride))
               : 0.0;
}

#endif
