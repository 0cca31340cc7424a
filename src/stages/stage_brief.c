/* stage_brief.c - rows of a map, and combinations of them. */
#include "stage_brief.h"

#include "dense_map.h"
#include "quads.h"
#include "stage_workshop.h"
#include "wide_vectors.h"

#include <stdlib.h>
#include <string.h>

/* The polynomial of element `place` of each node, from a column of the whole map. */
static double *fill_guard(const struct dalcs_stages *stages, const double *column, int place,
                          double *coefficient) {
    const struct dalcs_stage_layout *l = &stages->layout;
    for (int k = 0; k < l->n_nodes; k++) {
        double value = column[k * l->stride + place];
        for (int i = 0; i < l->n_nodes; i++) {
            coefficient[i] += value * stages->method->bernstein.from_nodes[k][i];
        }
    }
    return coefficient + l->n_nodes;
}

static void fill_column(const struct dalcs_stages *stages, const double *column, bool with_nodes,
                        double *brief) {
    const struct dalcs_system *s = stages->system;
    const struct dalcs_stage_layout *l = &stages->layout;
    size_t state_bytes = (size_t)s->n_x * sizeof(double);
    memcpy(brief, column + (l->n_nodes - 1) * l->stride, state_bytes);
    memcpy(brief + s->n_x, column + l->drift, state_bytes);
    double *guard = brief + 2 * s->n_x;
    for (int d = 0; d < s->n_pairs; d++) {
        if (s->pair[d].kind == DALCS_PAIR_DIODE) {
            guard = fill_guard(stages, column, dalcs_system_n_equations(s) + d, guard);
        }
    }
    for (int i = 0; i < stages->n_watched; i++) {
        guard = fill_guard(stages, column, dalcs_system_n_columns(s) + i, guard);
    }
    for (int x = 0; x < s->n_x && with_nodes; x++, guard += dalcs_quads_of(l->n_nodes)) {
        for (int k = 0; k < l->n_nodes; k++) {
            guard[k] = column[k * l->stride + x];
        }
    }
}

enum dalcs_status dalcs_stage_brief_create(struct dalcs_stages *stages,
                                           struct dalcs_stage_entry *entry, bool with_nodes,
                                           struct dalcs_stage_brief **brief) {
    const struct dalcs_system *s = stages->system;
    const int n_nodes = stages->layout.n_nodes;
    int n_guards = stages->n_watched;
    for (int d = 0; d < s->n_pairs; d++) {
        n_guards += s->pair[d].kind == DALCS_PAIR_DIODE ? 1 : 0;
    }
    int n_states = 2 * s->n_x + (with_nodes ? s->n_x * dalcs_quads_of(n_nodes) : 0);
    int rows = dalcs_dense_map_rows(n_states + n_guards * n_nodes);
    int columns = dalcs_stage_map_columns(stages);
    struct dalcs_stage_brief *b = dalcs_alloc(1, sizeof(*b));
    *brief = b;
    if (b == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_stages_hold(entry);
    b->entry = entry;
    b->number = ++stages->n_briefs;
    b->rows = rows;
    b->map = dalcs_dense_map_alloc(rows, columns);
    b->answer = dalcs_alloc((size_t)rows, sizeof(double));
    if (b->map == NULL || b->answer == NULL) {
        dalcs_stage_brief_destroy(stages, b);
        *brief = NULL;
        return DALCS_E_NOMEM;
    }
    b->last = b->answer;
    b->drift = b->answer + s->n_x;
    b->guard = b->answer + 2 * s->n_x;
    b->node = with_nodes ? b->guard + n_guards * n_nodes : NULL;
    memset(b->map, 0, (size_t)rows * (size_t)columns * sizeof(double));
    for (int k = 0; k < columns; k++) {
        fill_column(stages, entry->map + k * entry->rows, with_nodes, b->map + k * rows);
    }
    return DALCS_OK;
}

void dalcs_stage_brief_destroy(struct dalcs_stages *stages, struct dalcs_stage_brief *brief) {
    if (brief != NULL) {
        dalcs_stages_release(stages, brief->entry);
        free(brief->map);
        free(brief->answer);
        free(brief);
    }
}

void dalcs_stage_brief_apply(const struct dalcs_stages *stages, struct dalcs_stage_brief *brief,
                             const double *in) {
    dalcs_dense_map_apply(brief->rows, dalcs_stage_map_columns(stages), brief->map,
                          dalcs_stage_map_input(stages, in), brief->answer);
}

/* value[n]: sums of n_nodes weighted nodes each. */
DALCS_TWICE(void, weigh_nodes,
            (int n, int n_nodes, const double *weight, const double *node, double *value),
            (n, n_nodes, weight, node, value)) {
    for (int i = 0; i < n; i++) {
        dalcs_quad sum = {0.0};
        for (int k = 0; k < n_nodes; k += DALCS_QUAD, node += DALCS_QUAD) {
            dalcs_quad of;
            dalcs_quad factor;
            dalcs_quad_load(&of, node);
            dalcs_quad_load(&factor, weight + k);
            sum += factor * of;
        }
        value[i] = (sum[0] + sum[1]) + (sum[2] + sum[3]);
    }
}

void dalcs_stage_brief_stop(const struct dalcs_stages *stages, struct dalcs_stage_brief *brief,
                            double theta) {
    double weight[DALCS_MAX_NODES];
    dalcs_collocation_weights(stages->method, theta, weight);
    for (int k = stages->layout.n_nodes; k < DALCS_MAX_NODES; k++) {
        weight[k] = 0.0;
    }
    weigh_nodes(stages->system->n_x, stages->layout.n_nodes, weight, brief->node, brief->last);
}

double dalcs_stage_brief_row(const struct dalcs_stages *stages,
                             const struct dalcs_stage_brief *brief, int which, const double *in,
                             double *factor) {
    int n_columns = dalcs_stage_map_columns(stages);
    const double *input = dalcs_stage_map_input(stages, in);
    const double *element = brief->map + which;
    double rest = 0.0;
    for (int k = 0; k < n_columns; k++, element += brief->rows) {
        if (k < stages->system->n_x) {
            factor[k] = *element;
        } else {
            rest += *element * input[k];
        }
    }
    return rest;
}

int dalcs_stage_brief_columns(const struct dalcs_stages *stages) {
    return dalcs_stage_map_columns(stages);
}

const double *dalcs_stage_brief_column(const struct dalcs_stage_entry *entry, int column) {
    return entry->map + column * entry->rows;
}

const double *dalcs_stage_brief_input(const struct dalcs_stages *stages, const double *in) {
    return dalcs_stage_map_input(stages, in);
}

void dalcs_stage_brief_expand(const struct dalcs_stages *stages,
                              const struct dalcs_stage_entry *entry, const double *in,
                              double *out) {
    dalcs_stage_map_apply(stages, entry, in, out);
}
