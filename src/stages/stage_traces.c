/* stage_traces.c - of what a singular mode leaves open, which pairs see it, and the choice of least norm (least_norm.h): of the
 * diodes, then the switches, then all unknowns. In each, those count that are open first: what later blocks read of them
 * (partition.h) follows. */
#include "stage_search.h"

#include "magnitudes.h"
#include "partition.h"
#include "rounding.h"
#include "stages_internal.h"

#include <limits.h>
#include <math.h>

int dalcs_stage_search_place(const struct dalcs_stage_search *s, int c, int first) {
    int pair = c - dalcs_system_n_equations(s->system);
    if (c < first || (pair >= 0 && !dalcs_stage_is_on(s->entry, pair))) {
        return -1;
    }
    return pair < 0 ? c - first : c - pair - first + s->closed[pair];
}

/* w of an open pair, or lambda of a closed one, in a solution without states. */
static double other_side(const struct dalcs_stage_search *s, int pair, const double *vector) {
    const struct dalcs_csr *C = &s->system->C;
    int n_x = s->system->n_x;
    if (dalcs_stage_is_on(s->entry, pair)) {
        return vector[dalcs_stage_search_place(s, dalcs_system_n_equations(s->system) + pair, n_x)];
    }
    double sum = 0.0;
    double error = 0.0;
    for (int k = C->p[pair]; k < C->p[pair + 1]; k++) {
        int at = dalcs_stage_search_place(s, C->j[k], n_x);
        double term = at >= 0 ? C->x[k] * vector[at] : 0.0;
        sum += term;
        error += dalcs_sum_rounded * fabs(term) + (at >= 0 ? fabs(C->x[k]) * s->error[at] : 0.0);
    }
    return fabs(sum) > error ? sum : 0.0;
}

static enum dalcs_status keep_trace(struct dalcs_stage_search *s, struct dalcs_stage_trace *trace) {
    int n_pairs = s->system->n_pairs;
    int n = 0;
    for (int d = 0; d < n_pairs; d++) {
        n += s->of_pair[d] != 0.0;
    }
    trace->pair = dalcs_arena_alloc(&s->arena, (size_t)n, sizeof(int));
    trace->value = dalcs_arena_alloc(&s->arena, (size_t)n, sizeof(double));
    if (trace->pair == NULL || trace->value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int d = 0; d < n_pairs; d++) {
        if (s->of_pair[d] != 0.0) {
            trace->pair[trace->n] = d;
            trace->value[trace->n++] = s->of_pair[d];
        }
    }
    return DALCS_OK;
}

static double norm_of(const double *v, int n) {
    double sum = 0.0;
    for (int k = 0; k < n; k++) {
        sum += v[k] * v[k];
    }
    return sqrt(sum);
}

static double product(const struct dalcs_stage_trace *trace, const double *of_pair) {
    double sum = 0.0;
    for (int k = 0; k < trace->n; k++) {
        sum += trace->value[k] * of_pair[trace->pair[k]];
    }
    return sum;
}

/* The block of a column that has no memory. */
static int block_of(const struct dalcs_stage_search *s, int column) {
    const int *block = s->plan->stages->block_of;
    int n_z = s->system->n_z;
    if (block == NULL) {
        return 0;
    }
    int n_equations = dalcs_system_n_equations(s->system);
    return block[column < n_z ? s->system->n_x + column : n_equations + s->entry->on[column - n_z]];
}

/* Of solution k, what pairs of one kind have; orthogonal to what those before have (Gram and Schmidt, twice). Empty where
 * it vanishes. */
static enum dalcs_status find_trace(struct dalcs_stage_search *s, enum dalcs_pair_kind kind,
                                    int k) {
    int n_pairs = s->system->n_pairs;
    double *vector = s->vector + k * s->n_columns;
    for (int d = 0; d < n_pairs; d++) {
        bool counts = !s->system->pair[d].is_left_out[dalcs_stage_is_on(s->entry, d)];
        s->of_pair[d] = counts ? other_side(s, d, vector) : 0.0;
    }
    dalcs_partition_keep_first(s->plan->stages->block_of, s->system, kind, s->of_pair);
    double before = norm_of(s->of_pair, n_pairs);
    for (int i = 0; i < 2 * k; i++) {
        const struct dalcs_stage_trace *other = &s->trace[i % k];
        double share = product(other, s->of_pair);
        for (int e = 0; share != 0.0 && e < other->n; e++) {
            s->of_pair[other->pair[e]] -= share * other->value[e];
        }
        for (int c = 0; share != 0.0 && c < s->n_columns; c++) {
            vector[c] -= share * s->vector[i % k * s->n_columns + c];
        }
    }
    double norm = norm_of(s->of_pair, n_pairs);
    if (!(norm > dalcs_alike * before)) {
        return DALCS_OK; /* what rounding left of it */
    }
    for (int d = 0; d < n_pairs; d++) {
        s->of_pair[d] = fabs(s->of_pair[d]) > dalcs_alike * norm ? s->of_pair[d] / norm : 0.0;
    }
    for (int c = 0; c < s->n_columns; c++) {
        vector[c] /= norm;
    }
    return keep_trace(s, &s->trace[k]);
}

/* What no diode sees of the solutions comes after what diodes see: a trace of one kind is 0 in the other, so that those of
 * both are orthogonal. */
enum dalcs_status dalcs_stage_traces_find(struct dalcs_stage_search *s) {
    for (int k = 0; k < s->n_open; k++) {
        DALCS_TRY(find_trace(s, DALCS_PAIR_DIODE, k));
        if (s->trace[k].n == 0) {
            DALCS_TRY(find_trace(s, DALCS_PAIR_SWITCH, k));
        }
    }
    return DALCS_OK;
}

static enum dalcs_status put(struct dalcs_stage_search *s, int k, int column, double value) {
    DALCS_TRY(dalcs_triplets_add(&s->choice, k, column, value));
    return dalcs_triplets_add(&s->of_column, column, k, value);
}

/* The choice that is orthogonal to solution k in its pairs. */
static enum dalcs_status choose_in_pairs(struct dalcs_stage_search *s, int k) {
    const struct dalcs_csr *C = &s->system->C;
    const struct dalcs_stage_trace *trace = &s->trace[k];
    int n_equations = dalcs_system_n_equations(s->system);
    for (int e = 0; e < trace->n; e++) {
        int d = trace->pair[e];
        if (dalcs_stage_is_on(s->entry, d)) {
            DALCS_TRY(put(s, k, n_equations + d, trace->value[e]));
            continue;
        }
        DALCS_TRY(dalcs_triplets_add(&s->shore, k, d, trace->value[e]));
        for (int i = C->p[d]; i < C->p[d + 1]; i++) {
            int c = C->j[i];
            if (c < n_equations || dalcs_stage_is_on(s->entry, c - n_equations)) {
                DALCS_TRY(put(s, k, c, trace->value[e] * C->x[i]));
            }
        }
    }
    return DALCS_OK;
}

static enum dalcs_status choose_in_all(struct dalcs_stage_search *s, int k) {
    int n_z = s->system->n_z;
    int n_equations = dalcs_system_n_equations(s->system);
    const double *vector = s->vector + k * s->n_columns;
    int first = INT_MAX;
    for (int c = 0; c < s->n_columns; c++) {
        first = vector[c] != 0.0 && block_of(s, c) < first ? block_of(s, c) : first;
    }
    for (int c = 0; c < s->n_columns; c++) {
        int column = c < n_z ? s->system->n_x + c : n_equations + s->entry->on[c - n_z];
        double value = vector[c];
        if (value != 0.0 && block_of(s, c) == first) {
            DALCS_TRY(put(s, k, column, value));
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_stage_traces_choose(struct dalcs_stage_search *s, int k) {
    return s->trace[k].n > 0 ? choose_in_pairs(s, k) : choose_in_all(s, k);
}
