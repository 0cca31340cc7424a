/* rows.c - what outputs read, listed once; then their values, by fours. */
#include "rows.h"
#include "dense_map.h"
#include "radau.h"
#include "recurrence.h"
#include "wide_vectors.h"

#include <stdlib.h>
#include <string.h>

/* ---- Polynomials ------------------------------------------------------------------------------- */

/* dalcs_radau_theta of each time. */
DALCS_TWICE(void, find_thetas,
            (const struct dalcs_radau_part *part, const union dalcs_row_values *time, int n_groups,
             union dalcs_row_values *theta),
            (part, time, n_groups, theta)) {
    for (int g = 0; g < n_groups; g++) {
        const dalcs_quad raw = (time->group[g] - part->segment.t) / part->segment.h;
        dalcs_quad until = {part->segment.end, part->segment.end, part->segment.end,
                            part->segment.end};
        dalcs_quad_lower(&until, &raw);
        theta->group[g] = until;
    }
}

/* coefficient[s + 1], in whole quads, from value[s + 1] at the nodes in their order; s is known to the compiler where
 * it matters. */
static inline __attribute__((always_inline)) void expand(int s, const struct dalcs_collocation *c,
                                                         const double *value, double *coefficient) {
    dalcs_quad sum[DALCS_MAX_NODES / DALCS_QUAD] = {{value[0]}};
#pragma GCC unroll 9
    for (int k = 1; k <= s; k++) {
        const double difference = value[k] - value[0];
#pragma GCC unroll 3
        for (int q = k / DALCS_QUAD; q <= s / DALCS_QUAD; q++) {
            dalcs_quad factor;
            dalcs_quad_load(&factor, c->differences.coefficient[k] + q * DALCS_QUAD);
            sum[q] += factor * difference;
        }
    }
    memcpy(coefficient, sum, sizeof(sum));
}

DALCS_TWICE(void, find_coefficients,
            (const struct dalcs_collocation *c, const double *value, double *coefficient),
            (c, value, coefficient)) {
    if (c->s == 9) {
        expand(9, c, value, coefficient);
    } else if (c->s == 7) {
        expand(7, c, value, coefficient);
    } else {
        expand(c->s, c, value, coefficient);
    }
}

DALCS_TWICE(void, add_polynomial,
            (const struct dalcs_collocation *c, const double *coefficient,
             const union dalcs_row_values *theta, int n_groups, union dalcs_row_values *sum),
            (c, coefficient, theta, n_groups, sum)) {
    for (int g = 0; g < n_groups; g++) {
        dalcs_four value = {0.0};
        value += coefficient[c->s];
        for (int k = c->s - 1; k >= 0; k--) {
            value = value * (theta->group[g] - c->differences.node[k]) + coefficient[k];
        }
        sum->group[g] += value;
    }
}

/* ---- Values ------------------------------------------------------------------------------------ */

static void add(const union dalcs_row_values *value, double coefficient, int n_groups,
                union dalcs_row_values *sum) {
    for (int g = 0; g < n_groups; g++) {
        sum->group[g] += coefficient * value->group[g];
    }
}

static void add_constant(double constant, int n_groups, union dalcs_row_values *sum) {
    for (int g = 0; g < n_groups; g++) {
        sum->group[g] += constant;
    }
}

/* Adds coefficient times a column, whose values at the nodes are y[offset]; s as above. */
static inline __attribute__((always_inline)) void
add_nodes(int s, const int *offset, const double *y, double coefficient, double *node) {
#pragma GCC unroll 10
    for (int k = 0; k <= s; k++) {
        node[k] += coefficient * y[offset[k]];
    }
}

/* What steps of a probe, at the nodes of an answer: added to node[s + 1]; whether there is anything. */
static inline __attribute__((always_inline)) bool
collect(const struct dalcs_rows_part *p, const struct dalcs_radau_part *part, const double *out,
        const struct dalcs_probe *probe, double sign, double *node) {
    const struct dalcs_component *c = part->component;
    const int s = part->stages.method->s;
    const int n_equations = dalcs_system_n_equations(c->system);
    bool found = false;
    for (int i = 0; i < probe->n_terms; i++) {
        int column = probe->term[i].index;
        double coefficient = sign * probe->term[i].coefficient;
        bool steps = p->place[column] < 0;
        if (!steps ||
            !(column < n_equations || dalcs_osnsp_is_on(&c->osnsp, column - n_equations))) {
            continue;
        }
        found = true;
        if (s == 9) {
            add_nodes(9, p->offset, out + column, coefficient, node);
        } else if (s == 7) {
            add_nodes(7, p->offset, out + column, coefficient, node);
        } else {
            add_nodes(s, p->offset, out + column, coefficient, node);
        }
    }
    return found;
}

/* What sources decide of a probe. */
static inline __attribute__((always_inline)) void add_sources(const struct dalcs_rows_part *p,
                                                              const struct dalcs_radau_part *part,
                                                              const struct dalcs_probe *probe,
                                                              double sign, int n_groups,
                                                              union dalcs_row_values *sum) {
    const struct dalcs_component *c = part->component;
    int n_columns = dalcs_system_n_columns(c->system);
    const struct dalcs_probe_term *term = probe->term;
    for (const struct dalcs_probe_term *end = term + probe->n_terms; term < end; term++) {
        if (p->place[term->index] >= 0) {
            add(&p->source[p->place[term->index]].value, sign * term->coefficient, n_groups, sum);
        }
    }
    for (const struct dalcs_probe_term *end = term + probe->n_inputs; term < end; term++) {
        int place = p->place[n_columns + term->index];
        double coefficient = sign * term->coefficient;
        if (place >= 0) {
            add(&p->source[place].value, coefficient, n_groups, sum);
        } else {
            add_constant(coefficient * c->u[c->system->n_x + term->index], n_groups, sum);
        }
    }
}

/* A bystander as in dalcs_radau_bystander, from the inputs before it, each of which is asked once. */
static void add_inputs(const struct dalcs_rows_part *p, const struct dalcs_radau_part *part,
                       int n_groups, struct dalcs_row_source *bystander) {
    const struct dalcs_system *s = part->component->system;
    const double *gain = part->excitation.bystanders.gain + bystander->index * s->n_inputs;
    const int *place = p->place + dalcs_system_n_columns(s);
    memset(bystander->value.group, 0, (size_t)n_groups * sizeof(dalcs_four));
    add_constant(gain[0], n_groups, &bystander->value);
    for (int k = 1; k < s->n_inputs; k++) {
        if (gain[k] != 0.0) {
            add(&p->source[place[k]].value, gain[k], n_groups, &bystander->value);
        }
    }
}

static void ask_sources(struct dalcs_rows_part *p, const struct dalcs_radau_part *part,
                        const union dalcs_row_values *time, int n, enum dalcs_side side) {
    const struct dalcs_component *c = part->component;
    for (int k = 0; k < p->n_sources; k++) {
        struct dalcs_row_source *source = &p->source[k];
        if (source->is_bystander) {
            add_inputs(p, part, (n + 3) / 4, source);
            continue;
        }
        const struct dalcs_stimulus *stimulus =
            &c->circuit->stimulus[c->system->stimulus[source->index]];
        for (int i = 0; i < n; i++) {
            source->value.at[i] = dalcs_stimulus_value(stimulus, time->at[i], side);
        }
    }
}

/* ---- Steps that recur -------------------------------------------------------------------------- */

/* The polynomials of outputs as functions of the inputs of a step: a column of its map is an answer, too. */
static enum dalcs_status make_map(const struct dalcs_rows_part *p,
                                  const struct dalcs_radau_part *part, struct dalcs_row_map *to) {
    const struct dalcs_stage_entry *entry = part->segment.brief->entry;
    int n_columns = dalcs_stage_brief_columns(&part->stages);
    to->map = dalcs_dense_map_alloc(p->map_rows, n_columns);
    if (to->map == NULL) {
        return DALCS_E_NOMEM;
    }
    memset(to->map, 0, (size_t)p->map_rows * (size_t)n_columns * sizeof(double));
    for (int column = 0; column < n_columns; column++) {
        double *coefficient = to->map + column * p->map_rows;
        for (int i = 0; i < p->n_signals; coefficient += DALCS_MAX_NODES) {
            int output = p->signal[i].output;
            double node[DALCS_MAX_NODES] = {0.0};
            for (; i < p->n_signals && p->signal[i].output == output; i++) {
                const struct dalcs_row_signal *signal = &p->signal[i];
                (void)collect(p, part, dalcs_stage_brief_column(entry, column), signal->probe,
                              signal->sign, node);
            }
            find_coefficients(part->stages.method, node, coefficient);
        }
    }
    return DALCS_OK;
}

/* *map: of the present segment, which recurred; NULL: it has had no rows before. */
static enum dalcs_status find_map(struct dalcs_rows_part *p, const struct dalcs_radau_part *part,
                                  const double **map) {
    struct dalcs_row_map *its = &p->map[part->segment.brief->number % DALCS_ROW_MAPS];
    bool is_known = its->number == part->segment.brief->number;
    if (!is_known) {
        free(its->map);
        *its = (struct dalcs_row_map){.number = part->segment.brief->number};
    } else if (its->map == NULL) {
        DALCS_TRY(make_map(p, part, its));
    }
    *map = its->map;
    return DALCS_OK;
}

/* ---- Parts that step --------------------------------------------------------------------------- */

static void collect_polynomials(const struct dalcs_rows_part *p,
                                const struct dalcs_radau_part *part) {
    double *coefficient = p->coefficient;
    for (int i = 0; i < p->n_signals; coefficient += DALCS_MAX_NODES) {
        int output = p->signal[i].output;
        double node[DALCS_MAX_NODES] = {0.0};
        bool steps = false;
        for (; i < p->n_signals && p->signal[i].output == output; i++) {
            const struct dalcs_row_signal *signal = &p->signal[i];
            steps = collect(p, part, part->segment.out, signal->probe, signal->sign, node) || steps;
        }
        if (steps) {
            find_coefficients(part->stages.method, node, coefficient);
        } else {
            memset(coefficient, 0, DALCS_MAX_NODES * sizeof(*coefficient));
        }
    }
}

enum dalcs_status dalcs_rows_find_polynomials(struct dalcs_rows *rows,
                                              struct dalcs_radau_part *part) {
    struct dalcs_rows_part *p = &rows->part[part->index];
    const double *map = NULL;
    if (p->number == part->segment.number) {
        return DALCS_OK;
    }
    p->number = part->segment.number;
    if (part->segment.brief != NULL) {
        DALCS_TRY(find_map(p, part, &map));
    }
    if (map != NULL) {
        dalcs_dense_map_apply(p->map_rows, dalcs_stage_brief_columns(&part->stages), map,
                              dalcs_stage_brief_input(&part->stages, part->segment.in),
                              p->coefficient);
    } else {
        dalcs_recurrence_complete(part);
        collect_polynomials(p, part);
    }
    return DALCS_OK;
}

/* A blocking diode's current, for one. */
static bool vanishes(const struct dalcs_collocation *c, const double *coefficient) {
    int k = 0;
    while (k <= c->s && coefficient[k] == 0.0) {
        k++;
    }
    return k > c->s;
}

static enum dalcs_status fill_stepped(struct dalcs_rows *rows, struct dalcs_radau_part *part, int n,
                                      enum dalcs_side side) {
    struct dalcs_rows_part *p = &rows->part[part->index];
    const struct dalcs_collocation *m = part->stages.method;
    int n_groups = (n + 3) / 4;
    DALCS_TRY(dalcs_rows_find_polynomials(rows, part));
    find_thetas(part, &rows->time, n_groups, &rows->theta);
    ask_sources(p, part, &rows->time, n, side);
    const double *coefficient = p->coefficient;
    for (int i = 0; i < p->n_signals; coefficient += DALCS_MAX_NODES) {
        int output = p->signal[i].output;
        for (; i < p->n_signals && p->signal[i].output == output; i++) {
            const struct dalcs_row_signal *signal = &p->signal[i];
            add_sources(p, part, signal->probe, signal->sign, n_groups, &rows->value[output]);
        }
        if (!vanishes(m, coefficient)) {
            add_polynomial(m, coefficient, &rows->theta, n_groups, &rows->value[output]);
        }
    }
    return DALCS_OK;
}

/* ---- All parts --------------------------------------------------------------------------------- */

/* One without memory: at a single time, unless it is constant. */
static enum dalcs_status solve(struct dalcs_rows *rows, struct dalcs_radau_part *part, int n,
                               enum dalcs_side side) {
    const struct dalcs_rows_part *p = &rows->part[part->index];
    const struct dalcs_component *c = part->component;
    DALCS_TRY(dalcs_radau_solve(rows->radau, part, rows->time.at[0], side));
    for (int i = 0; i < p->n_signals; i++) {
        double value = dalcs_probe_value(p->signal[i].probe, c->y, c->u + c->system->n_x);
        add_constant(p->signal[i].sign * value, (n + 3) / 4, &rows->value[p->signal[i].output]);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_rows_fill(struct dalcs_rows *rows, const double *time, int n,
                                  enum dalcs_side side, int *n_done) {
    n = rows->one_by_one ? 1 : n;
    int n_groups = (n + 3) / 4;
    memcpy(rows->time.at, time, (size_t)n * sizeof(double));
    for (int i = n; i < 4 * n_groups; i++) {
        rows->time.at[i] = time[n - 1];
    }
    for (int i = 0; i < rows->n_outputs; i++) {
        memset(rows->value[i].group, 0, (size_t)n_groups * sizeof(dalcs_four));
    }
    for (int i = 0; i < rows->n_asked; i++) {
        struct dalcs_radau_part *part = &rows->radau->part[rows->asked[i]];
        if (part->kind == DALCS_PART_ALGEBRAIC) {
            DALCS_TRY(solve(rows, part, n, side));
        } else {
            DALCS_TRY(fill_stepped(rows, part, n, side));
        }
    }
    *n_done = n;
    return DALCS_OK;
}
