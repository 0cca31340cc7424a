/* rows_setup.c - what rows read of each part. */
#include "dense_map.h"
#include "rows.h"

#include <stdlib.h>

static void count_probe(const struct dalcs_rows *rows, const struct dalcs_probe *probe) {
    if (probe->system >= 0) {
        rows->part[probe->system].n_signals++;
    }
}

static void list_probe(const struct dalcs_rows *rows, const struct dalcs_probe *probe, bool is_all,
                       int output, double sign) {
    if (probe->system >= 0) {
        struct dalcs_rows_part *p = &rows->part[probe->system];
        bool is_column = is_all && probe->n_terms == 1 && probe->n_inputs == 0;
        p->signal[p->n_signals++] = (struct dalcs_row_signal){probe, is_column, output, sign};
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
        p->signal = dalcs_arena_alloc(&rows->arena, (size_t)p->n_signals, sizeof(*p->signal));
        if (p->signal == NULL) {
            return DALCS_E_NOMEM;
        }
        p->n_signals = 0;
    }
    for (int i = 0; i < rows->n_outputs; i++) {
        const struct dalcs_output *out = &all[output != NULL ? output[i] : i];
        list_probe(rows, &out->plus, out->minus.system < 0, i, 1.0);
        list_probe(rows, &out->minus, out->plus.system < 0, i, -1.0);
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

/* The inputs that make up a bystander. */
static void read_inputs(struct dalcs_rows_part *p, const struct dalcs_radau_part *part,
                        int bystander) {
    const struct dalcs_system *s = part->component->system;
    const double *gain = part->excitation.bystanders.gain + bystander * s->n_inputs;
    for (int k = 1; k < s->n_inputs; k++) {
        if (gain[k] != 0.0) {
            read_source(p, dalcs_system_n_columns(s) + k, false, k);
        }
    }
}

/* All inputs have their places before bystanders get one. */
static void list_inputs(struct dalcs_rows_part *p, const struct dalcs_radau_part *part,
                        const struct dalcs_probe *probe) {
    const int n_columns = dalcs_system_n_columns(part->component->system);
    for (int k = 0; k < probe->n_terms; k++) {
        const int column = probe->term[k].index;
        if (p->place[column] < -1) {
            read_inputs(p, part, -2 - p->place[column]);
        }
    }
    for (int k = 0; k < probe->n_inputs; k++) {
        const int input = probe->term[probe->n_terms + k].index;
        if (varies(part->component, input)) {
            read_source(p, n_columns + input, false, input);
        }
    }
}

static void list_sources(struct dalcs_rows_part *p, const struct dalcs_radau_part *part) {
    for (int i = 0; i < p->n_signals; i++) {
        list_inputs(p, part, p->signal[i].probe);
    }
    for (int i = 0; i < p->n_signals; i++) {
        const struct dalcs_probe *probe = p->signal[i].probe;
        for (int k = 0; k < probe->n_terms; k++) {
            const int column = probe->term[k].index;
            if (p->place[column] < -1) {
                read_source(p, column, true, -2 - p->place[column]);
            }
        }
    }
}

static enum dalcs_status part_setup(struct dalcs_rows_part *p, const struct dalcs_radau_part *part,
                                    struct dalcs_arena *arena) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_bystanders *b = &part->excitation.bystanders;
    int n_places = dalcs_system_n_columns(s) + s->n_inputs;
    p->place = dalcs_arena_alloc(arena, (size_t)n_places, sizeof(int));
    p->source = dalcs_arena_alloc(arena, (size_t)(b->n + s->n_inputs), sizeof(*p->source));
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
    for (int i = 0; i < p->n_signals; i++) {
        bool is_next = i > 0 && p->signal[i].output == p->signal[i - 1].output;
        p->n_read += is_next ? 0 : 1;
    }
    p->map_rows = dalcs_dense_map_rows(p->n_read * DALCS_MAX_NODES);
    p->coefficient = dalcs_arena_alloc(arena, (size_t)p->map_rows, sizeof(double));
    if (p->coefficient == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k <= part->stages.method->s; k++) {
        p->offset[k] = part->stages.method->differences.order[k] * part->stages.layout.stride;
    }
    return DALCS_OK;
}

static enum dalcs_status set_up_parts(struct dalcs_rows *rows, const int *output) {
    DALCS_TRY(list_signals(rows, output));
    for (int k = 0; k < rows->radau->n_parts; k++) {
        const struct dalcs_radau_part *part = &rows->radau->part[k];
        bool is_solved = part->kind == DALCS_PART_ALGEBRAIC && part->component->varying.n > 0;
        if (rows->part[k].n_signals > 0 || (is_solved && output == NULL)) {
            rows->asked[rows->n_asked++] = k;
            rows->one_by_one = rows->one_by_one || is_solved;
        }
        if (rows->part[k].n_signals > 0 && part->kind == DALCS_PART_STEPPED) {
            DALCS_TRY(part_setup(&rows->part[k], part, &rows->arena));
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_rows_setup(struct dalcs_rows *rows, struct dalcs_radau *radau,
                                   const int *output, int n_outputs) {
    *rows = (struct dalcs_rows){.radau = radau, .n_outputs = n_outputs};
    rows->value = dalcs_arena_alloc(&rows->arena, (size_t)n_outputs, sizeof(*rows->value));
    rows->largest = dalcs_arena_alloc(&rows->arena, (size_t)n_outputs, sizeof(double));
    rows->part = dalcs_arena_alloc(&rows->arena, (size_t)radau->n_parts, sizeof(*rows->part));
    rows->asked = dalcs_arena_alloc(&rows->arena, (size_t)radau->n_parts, sizeof(int));
    bool complete =
        rows->value != NULL && rows->largest != NULL && rows->part != NULL && rows->asked != NULL;
    enum dalcs_status status = complete ? set_up_parts(rows, output) : DALCS_E_NOMEM;
    if (status != DALCS_OK) {
        dalcs_rows_finish(rows);
    }
    return status;
}

void dalcs_rows_finish(struct dalcs_rows *rows) {
    for (int k = 0; rows->part != NULL && k < rows->radau->n_parts; k++) {
        for (int i = 0; i < DALCS_ROW_MAPS; i++) {
            free(rows->part[k].map[i].map);
        }
    }
    dalcs_arena_finish(&rows->arena);
    *rows = (struct dalcs_rows){0};
}
