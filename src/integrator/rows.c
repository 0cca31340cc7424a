/* rows.c - what outputs read, listed once; then their values, by fours. */
#include "rows.h"

#include "radau_internal.h"
#include "recurrence.h"
#include "wide_vectors.h"

#include <stdlib.h>
#include <string.h>

/* ---- What is read ------------------------------------------------------------------------------ */

static void count_probe(const struct dalcs_rows *rows, const struct dalcs_probe *probe) {
    if (probe->system >= 0) {
        rows->part[probe->system].n_signals++;
    }
}

static void list_probe(const struct dalcs_rows *rows, const struct dalcs_probe *probe, int output,
                       double sign) {
    if (probe->system >= 0) {
        struct dalcs_rows_part *p = &rows->part[probe->system];
        p->signal[p->n_signals++] = (struct dalcs_row_signal){probe, output, sign};
    }
}

/* Which signals make up which output, part by part. */
static enum dalcs_status list_signals(struct dalcs_rows *rows, const int *output) {
    const struct dalcs_output *all = rows->radau->base->network->output;
    for (int i = 0; i < rows->n_outputs; i++) {
        const struct dalcs_output *out = &all[output != NULL ? output[i] : i];
        count_probe(rows, &out->plus);
        count_probe(rows, &out->minus);
    }
    for (int k = 0; k < rows->radau->n_parts; k++) {
        struct dalcs_rows_part *p = &rows->part[k];
        p->signal = dalcs_alloc((size_t)p->n_signals, sizeof(*p->signal));
        if (p->signal == NULL) {
            return DALCS_E_NOMEM;
        }
        p->n_signals = 0;
    }
    for (int i = 0; i < rows->n_outputs; i++) {
        const struct dalcs_output *out = &all[output != NULL ? output[i] : i];
        list_probe(rows, &out->plus, i, 1.0);
        list_probe(rows, &out->minus, i, -1.0);
    }
    return DALCS_OK;
}

static bool varies(const struct dalcs_component *c, int input) {
    const struct dalcs_system *s = c->system;
    return input > 0 && c->circuit->stimulus[s->stimulus[input]].kind != DALCS_STIMULUS_DC;
}

/* Gives the source its place, unless it has one. */
static void read_source(struct dalcs_rows_part *p, int place, bool is_bystander, int index) {
    if (p->place[place] < 0) {
        p->source[p->n_sources] = (struct dalcs_row_source){is_bystander, index, {{0.0}}};
        p->place[place] = p->n_sources++;
    }
}

static void list_sources(struct dalcs_rows_part *p, const struct dalcs_radau_part *part) {
    int n_columns = dalcs_system_n_columns(part->component->system);
    for (int i = 0; i < p->n_signals; i++) {
        const struct dalcs_probe *probe = p->signal[i].probe;
        for (int k = 0; k < probe->n_terms; k++) {
            int column = probe->term[k].index;
            if (p->place[column] < -1) {
                read_source(p, column, true, -2 - p->place[column]);
            }
        }
        for (int k = 0; k < probe->n_inputs; k++) {
            int input = probe->term[probe->n_terms + k].index;
            if (varies(part->component, input)) {
                read_source(p, n_columns + input, false, input);
            }
        }
    }
}

static enum dalcs_status part_setup(struct dalcs_rows_part *p,
                                    const struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_bystanders *b = &part->excitation.bystanders;
    int n_places = dalcs_system_n_columns(s) + s->n_inputs;
    p->place = dalcs_alloc((size_t)n_places, sizeof(int));
    p->source = dalcs_alloc((size_t)(b->n + s->n_inputs), sizeof(*p->source));
    if (p->place == NULL || p->source == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < n_places; k++) {
        p->place[k] = -1;
    }
    for (int i = 0; i < b->n; i++) {
        p->place[b->column[i]] = -2 - i;
    }
    list_sources(p, part);
    return DALCS_OK;
}

static enum dalcs_status set_up_parts(struct dalcs_rows *rows, const int *output) {
    DALCS_TRY(list_signals(rows, output));
    for (int k = 0; k < rows->radau->n_parts; k++) {
        const struct dalcs_radau_part *part = &rows->radau->part[k];
        bool is_solved = part->kind == DALCS_PART_ALGEBRAIC && part->component->n_varying > 0;
        if (rows->part[k].n_signals > 0 || (is_solved && output == NULL)) {
            rows->asked[rows->n_asked++] = k;
            rows->one_by_one = rows->one_by_one || is_solved;
        }
        if (rows->part[k].n_signals > 0 && part->kind == DALCS_PART_STEPPED) {
            DALCS_TRY(part_setup(&rows->part[k], part));
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_rows_setup(struct dalcs_rows *rows, struct dalcs_radau *radau,
                                   const int *output, int n_outputs) {
    *rows = (struct dalcs_rows){.radau = radau, .n_outputs = n_outputs};
    rows->value = dalcs_alloc((size_t)n_outputs, sizeof(*rows->value));
    rows->part = dalcs_alloc((size_t)radau->n_parts, sizeof(*rows->part));
    rows->asked = dalcs_alloc((size_t)radau->n_parts, sizeof(int));
    bool complete = rows->value != NULL && rows->part != NULL && rows->asked != NULL;
    enum dalcs_status status = complete ? set_up_parts(rows, output) : DALCS_E_NOMEM;
    if (status != DALCS_OK) {
        dalcs_rows_finish(rows);
    }
    return status;
}

void dalcs_rows_finish(struct dalcs_rows *rows) {
    for (int k = 0; rows->part != NULL && k < rows->radau->n_parts; k++) {
        free(rows->part[k].signal);
        free(rows->part[k].place);
        free(rows->part[k].source);
    }
    free(rows->value);
    free(rows->part);
    free(rows->asked);
    *rows = (struct dalcs_rows){0};
}

/* ---- The nodes' weights ------------------------------------------------------------------------ */

/* dalcs_radau_theta of each time. */
static inline void find_thetas(const struct dalcs_radau_part *part, const dalcs_four *time,
                               dalcs_quad *theta) {
    const dalcs_quad raw = (*time - part->t) / part->h;
    *theta = (dalcs_quad){part->end, part->end, part->end, part->end};
    dalcs_quad_lower(theta, &raw);
}

/* Products of the distances to all other nodes over the same at the node: no quotients, which take five
 * times as long and mean nothing at a node. */
DALCS_TWICE(void, weigh,
            (const struct dalcs_radau_part *part, const union dalcs_row_values *time, int n_groups,
             union dalcs_row_values *weight),
            (part, time, n_groups, weight)) {
    const struct dalcs_collocation *c = part->stages.method;
    for (int g = 0; g < n_groups; g++) {
        dalcs_quad theta;
        find_thetas(part, &time->group[g], &theta);
        dalcs_four before = {1.0, 1.0, 1.0, 1.0};
        for (int k = 0; k <= c->s; k++) {
            weight[k].group[g] = c->barycentric[k] * before;
            before *= theta - c->node[k];
        }
        dalcs_four behind = {1.0, 1.0, 1.0, 1.0};
        for (int k = c->s; k >= 0; k--) {
            weight[k].group[g] *= behind;
            behind *= theta - c->node[k];
        }
    }
}

/* ---- Values ------------------------------------------------------------------------------------ */

/* sum += coefficient * column, whose values at the nodes are y[stride * node]. */
DALCS_TWICE(void, add_column,
            (const struct dalcs_stage_layout *l, const union dalcs_row_values *weight,
             const double *y, double coefficient, int n_groups, union dalcs_row_values *sum),
            (l, weight, y, coefficient, n_groups, sum)) {
    for (int g = 0; g < n_groups; g++) {
        dalcs_four column = {0.0};
        for (int k = 0; k < l->n_nodes; k++) {
            column += weight[k].group[g] * y[k * l->stride];
        }
        sum->group[g] += coefficient * column;
    }
}

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

/* As dalcs_probe_value does, in the same order. */
static void sum_probe(const struct dalcs_rows *rows, const struct dalcs_radau_part *part,
                      const struct dalcs_probe *probe, int n_groups, union dalcs_row_values *sum) {
    const struct dalcs_rows_part *p = &rows->part[part->index];
    const struct dalcs_component *c = part->component;
    int n_equations = dalcs_system_n_equations(c->system);
    int n_columns = dalcs_system_n_columns(c->system);
    const struct dalcs_probe_term *term = probe->term;
    for (const struct dalcs_probe_term *end = term + probe->n_terms; term < end; term++) {
        int column = term->index;
        if (p->place[column] >= 0) {
            add(&p->source[p->place[column]].value, term->coefficient, n_groups, sum);
        } else if (column < n_equations || dalcs_osnsp_is_on(&c->osnsp, column - n_equations)) {
            add_column(&part->stages.layout, rows->weight, part->out + column, term->coefficient,
                       n_groups, sum);
        }
    }
    for (const struct dalcs_probe_term *end = term + probe->n_inputs; term < end; term++) {
        int place = p->place[n_columns + term->index];
        if (place >= 0) {
            add(&p->source[place].value, term->coefficient, n_groups, sum);
        } else {
            add_constant(term->coefficient * c->u[c->system->n_x + term->index], n_groups, sum);
        }
    }
}

static void ask_sources(struct dalcs_rows_part *p, const struct dalcs_radau_part *part,
                        const union dalcs_row_values *time, int n, enum dalcs_side side) {
    const struct dalcs_component *c = part->component;
    for (int k = 0; k < p->n_sources; k++) {
        struct dalcs_row_source *source = &p->source[k];
        for (int i = 0; i < n; i++) {
            source->value.at[i] =
                source->is_bystander
                    ? dalcs_radau_bystander(part, source->index, time->at[i], side)
                    : dalcs_stimulus_value(
                          &c->circuit->stimulus[c->system->stimulus[source->index]], time->at[i],
                          side);
        }
    }
}

/* A part that steps. */
static void interpolate(struct dalcs_rows *rows, const struct dalcs_radau_part *part, int n,
                        enum dalcs_side side) {
    struct dalcs_rows_part *p = &rows->part[part->index];
    int n_groups = (n + 3) / 4;
    weigh(part, &rows->time, n_groups, rows->weight);
    ask_sources(p, part, &rows->time, n, side);
    for (int i = 0; i < p->n_signals; i++) {
        union dalcs_row_values sum;
        memset(sum.group, 0, (size_t)n_groups * sizeof(*sum.group));
        sum_probe(rows, part, p->signal[i].probe, n_groups, &sum);
        add(&sum, p->signal[i].sign, n_groups, &rows->value[p->signal[i].output]);
    }
}

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
            dalcs_recurrence_complete(part);
            interpolate(rows, part, n, side);
        }
    }
    *n_done = n;
    return DALCS_OK;
}
