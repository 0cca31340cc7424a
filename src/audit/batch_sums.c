/* batch_sums.c - laws and signs of all stretches of a batch. */
#include "batch.h"

#include "image_sum.h"
#include "wide_vectors.h"

#include <string.h>

DALCS_TWICE(bool, agrees,
            (const struct audit_batch *b, const double *input, const double *value, double limit),
            (b, input, value, limit)) {
    const int n_places = b->screen->n_places;
    const double *factor = b->place + AUDIT_PLACE_NODE;
    double sum = b->screen->constant[AUDIT_PLACE_NODE];
    for (int j = 0; j < b->gathered.n_inputs; j++, factor += n_places) {
        sum += *factor * input[j];
    }
    sum -=
        audit_product(b->n_columns, b->screen->row + AUDIT_ROW_NOW * b->n_columns, value + b->node);
    return fabs(sum) <= 0.25 * limit;
}

bool dalcs_audit_is_image(const struct dalcs_audit *audit, int part, const double *input,
                          const double *value) {
    const struct audit_batch *b = &audit->part[part].watch->batch;
    return agrees(b, input, value, b->screen->limit);
}

static inline int n_in_quads(const struct audit_batch *b) {
    return dalcs_quads_of(b->gathered.n);
}

static inline __attribute__((always_inline)) void fill(dalcs_quad *q, double with) {
    *q = (dalcs_quad){with, with, with, with};
}

DALCS_TWICE(void, multiply, (const struct audit_batch *b, struct audit_batch_sums *sums),
            (b, sums)) {
    const double *constant = b->screen->constant;
    const int n_places = b->screen->n_places;
    for (int k = 0; k < n_in_quads(b); k += DALCS_QUAD) {
        dalcs_quad law;
        dalcs_quad start;
        dalcs_quad end;
        fill(&law, constant[AUDIT_PLACE_LAWS] + b->screen->rate * b->past);
        fill(&start, constant[AUDIT_PLACE_START]);
        fill(&end, constant[AUDIT_PLACE_END]);
        const double *factor = b->place;
        const double *from = b->gathered.input + k;
        for (int j = 0; j < b->gathered.n_inputs;
             j++, factor += n_places, from += DALCS_AUDIT_BATCH) {
            dalcs_quad input;
            dalcs_quad_load(&input, from);
            law += input * factor[AUDIT_PLACE_LAWS];
            start += input * factor[AUDIT_PLACE_START];
            end += input * factor[AUDIT_PLACE_END];
        }
        dalcs_quad_store(sums->law + k, &law);
        dalcs_quad_store(sums->start + k, &start);
        dalcs_quad_store(sums->end + 1 + k, &end);
    }
}

/* Between which values each input is, into the room for that. */
DALCS_TWICE(void, enclose, (const struct audit_batch *b), (b)) {
    const int n_inputs = b->gathered.n_inputs;
    double *low = audit_batch_input(b, n_inputs);
    for (int j = 0; j < n_inputs; j++) {
        dalcs_quad least;
        dalcs_quad_load(&least, audit_batch_input(b, j));
        dalcs_quad most = least;
        for (int k = DALCS_QUAD; k < n_in_quads(b); k += DALCS_QUAD) {
            dalcs_quad of;
            dalcs_quad_load(&of, audit_batch_input(b, j) + k);
            dalcs_quad_lower(&least, &of);
            dalcs_quad_raise(&most, &of);
        }
        least = -least;
        low[j] = -dalcs_quad_largest(&least);
        low[n_inputs + j] = dalcs_quad_largest(&most);
    }
}

/* Four signs of each slot. */
static inline __attribute__((always_inline)) void lower_each(const struct audit_batch *b, int first,
                                                             double *below) {
    const int n_places = b->screen->n_places;
    for (int k = 0; k < b->gathered.n; k++) {
        dalcs_quad sum;
        dalcs_quad_load(&sum, b->screen->constant + first);
        const double *factor = b->place + first;
        const double *input = b->gathered.input + k;
        for (int j = 0; j < b->gathered.n_inputs;
             j++, factor += n_places, input += DALCS_AUDIT_BATCH) {
            dalcs_quad of;
            dalcs_quad_load(&of, factor);
            sum += of * *input;
        }
        for (int i = 0; i < DALCS_QUAD; i++) {
            below[k] = sum[i] >= -below[k] ? below[k] : -sum[i];
        }
    }
}

/* Only signs that may be below what is allowed, with inputs between the least and the most, are asked one by one. */
DALCS_TWICE(void, ask_signs, (const struct audit_batch *b, double *below), (b, below)) {
    const int n_places = b->screen->n_places;
    const double limit = b->screen->limit;
    const double *low = audit_batch_input(b, b->gathered.n_inputs);
    const double *high = low + b->gathered.n_inputs;
    for (int first = AUDIT_PLACE_SIGNS; first < n_places; first += DALCS_QUAD) {
        dalcs_quad bound;
        dalcs_quad_load(&bound, b->screen->constant + first);
        const double *factor = b->place + first;
        for (int j = 0; j < b->gathered.n_inputs; j++, factor += n_places) {
            dalcs_quad of;
            dalcs_quad_load(&of, factor);
            dalcs_quad least = of * low[j];
            const dalcs_quad other = of * high[j];
            dalcs_quad_lower(&least, &other);
            bound += least;
        }
        bool holds = true;
        for (int i = 0; i < DALCS_QUAD; i++) {
            holds &= bound[i] >= -limit;
        }
        if (!holds) {
            lower_each(b, first, below);
        }
    }
}

/* ---- What is beyond ------------------------------------------------------------------------------ */

/* A quarter of what is allowed of laws is left to the values at a node. */
static bool holds(const struct audit_batch *b, const struct audit_batch_sums *s, int k) {
    const double limit = b->screen->limit;
    return fabs(s->law[k]) <= 0.75 * limit && fabs(s->start[k] - s->end[k]) <= limit &&
           s->below[k] <= limit &&
           fabs(b->gathered.to[k] - b->gathered.from[k] - b->length) <= b->near;
}

/* Four at once: the comparisons of holds(). */
DALCS_TWICE(bool, all_hold, (const struct audit_batch *b, const struct audit_batch_sums *s),
            (b, s)) {
    dalcs_quad limit;
    dalcs_quad near;
    fill(&limit, b->screen->limit);
    fill(&near, b->near);
    dalcs_quad_bits all = {-1, -1, -1, -1};
    for (int k = 0; k < n_in_quads(b); k += DALCS_QUAD) {
        dalcs_quad law;
        dalcs_quad jump;
        dalcs_quad below;
        dalcs_quad to;
        dalcs_quad other;
        dalcs_quad_load(&law, s->law + k);
        dalcs_quad_load(&jump, s->start + k);
        dalcs_quad_load(&other, s->end + k);
        dalcs_quad_load(&below, s->below + k);
        jump -= other;
        dalcs_quad_load(&to, b->gathered.to + k);
        dalcs_quad_load(&other, b->gathered.from + k);
        to = to - other - b->length;
        dalcs_quad_unsign(&law);
        dalcs_quad_unsign(&jump);
        dalcs_quad_unsign(&to);
        all &= (dalcs_quad_bits)(law <= 0.75 * limit) & (dalcs_quad_bits)(jump <= limit) &
               (dalcs_quad_bits)(below <= limit) & (dalcs_quad_bits)(to <= near);
    }
    return (all[0] & all[1] & all[2] & all[3]) != 0;
}

/* The last quad is full: of the last one. */
static void repeat_last(struct audit_batch *b, struct audit_batch_sums *s) {
    const int last = b->gathered.n - 1;
    for (int k = b->gathered.n; k < n_in_quads(b); k++) {
        b->gathered.from[k] = b->gathered.from[last];
        b->gathered.to[k] = b->gathered.to[last];
        s->law[k] = s->below[k] = 0.0;
        s->start[k] = s->end[k];
    }
}

int audit_batch_first(struct dalcs_audit *audit, struct audit_batch *b,
                      struct audit_batch_sums *s) {
    const int n = b->gathered.n;
    for (int j = 0; j < b->gathered.n_inputs; j++) {
        double *input = audit_batch_input(b, j);
        for (int k = n; k < n_in_quads(b); k++) {
            input[k] = input[n - 1];
        }
    }
    multiply(b, s);
    memset(s->below, 0, sizeof s->below);
    if (b->screen->n_places > AUDIT_PLACE_SIGNS) {
        enclose(b);
        ask_signs(b, s->below);
    }
    for (int k = AUDIT_BATCH_FIRST; k < n && audit_laws_have_stimuli(b->screen); k++) {
        s->law[k] += audit_laws_stimuli(audit, b->screen, b->gathered.from[k] + b->past);
    }
    s->law[0] = s->below[0] = 0.0; /* of what was asked before */
    s->end[0] = s->start[0];
    repeat_last(b, s);
    if (all_hold(b, s)) {
        return n;
    }
    int k = AUDIT_BATCH_FIRST;
    while (k < n && holds(b, s, k)) {
        k++;
    }
    return k;
}
