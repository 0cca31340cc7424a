/* cone_labels.c - names and units of the columns and rows of a described system. */
#include "cone_assembly.h"

#include <stdlib.h>

void dalcs_label_inputs(const struct dalcs_reading *r, struct dalcs_assembly *a) {
    struct dalcs_system *s = a->s;
    s->stimulus[0] = -1;
    for (int k = 1; k < s->n_inputs; k++) {
        s->stimulus[k] = a->from->input[k - 1];
        s->input_element[k] = r->input_name[s->stimulus[k]];
    }
}

void dalcs_label_column(struct dalcs_system *s, int c, const struct dalcs_described_column *d) {
    s->column[c] = (struct dalcs_label){d->name, d->kind};
    s->column_is_current[c] = d->is_current;
    s->forest_root[c] = d->root < 0 ? c : d->root;
}

void dalcs_label_pairs(struct dalcs_assembly *a) {
    struct dalcs_system *s = a->s;
    int n_equations = dalcs_system_n_equations(s);
    for (size_t j = 0; j < a->from->n_multipliers; j++) {
        const struct dalcs_multiplier *m = &a->from->multiplier[j];
        const struct dalcs_multiplier_place *p = &a->place[j];
        if (p->is_free) {
            s->column[p->column] = (struct dalcs_label){m->pair.element, DALCS_LABEL_BRANCH};
            s->column_is_current[p->column] = p->bound < 0;
            s->forest_root[p->column] = p->column;
            for (int d = p->bound; p->bound >= 0 && d < p->bound + 2; d++) {
                s->pair[d] = m->pair;
            }
            continue;
        }
        s->pair[p->row] = m->pair;
        if (m->pair.has_valve) {
            const bool is_there = (size_t)m->pair.valve < a->from->n_multipliers;
            s->pair[p->row].valve = is_there && !a->place[m->pair.valve].is_free
                                        ? a->place[m->pair.valve].row
                                        : s->n_pairs;
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        s->column_is_current[n_equations + d] = true;
    }
}

enum dalcs_status dalcs_label_lifted(struct dalcs_reading *r, struct dalcs_assembly *a) {
    struct dalcs_system *s = a->s;
    for (size_t k = 0; k < a->from->n_inputs; k++) {
        int u = a->lifted[k];
        if (u < 0) {
            continue;
        }
        const char *name = r->input_name[a->from->input[k]];
        const char *dual = dalcs_arena_printf(&r->builder.circuit->arena, "i(%s)", name);
        if (dual == NULL) {
            return DALCS_E_NOMEM;
        }
        s->column[u] = (struct dalcs_label){name, DALCS_LABEL_BRANCH};
        s->column[u + 1] = (struct dalcs_label){dual, DALCS_LABEL_BRANCH};
        s->column_is_current[u + 1] = true;
        s->forest_root[u] = u;
        s->forest_root[u + 1] = u + 1;
    }
    return DALCS_OK;
}

void dalcs_label_rows(struct dalcs_assembly *a) {
    struct dalcs_system *s = a->s;
    for (int i = 0; i < dalcs_system_n_equations(s); i++) {
        s->dual[i] = i;
        s->row[i] = s->column[i];
        s->row_is_current[i] = !s->column_is_current[i];
        if ((size_t)i < a->from->n_rows) {
            const struct dalcs_described_column *d = &a->from->row[i];
            s->dual[i] = d->dual < 0 ? i : d->dual;
            s->row[i] = (struct dalcs_label){d->name, d->kind};
            s->row_is_current[i] = d->is_current;
        }
    }
}

static bool valves_fit(const struct dalcs_system *s) {
    bool fit = true;
    for (int d = 0; d < s->n_pairs; d++) {
        const struct dalcs_pair *p = &s->pair[d];
        fit = fit && (!p->has_valve ||
                      (p->valve < s->n_pairs && s->pair[p->valve].kind == DALCS_PAIR_DIODE));
    }
    return fit;
}

bool dalcs_labels_fit(struct dalcs_reading *r, const struct dalcs_assembly *a) {
    const struct dalcs_system *s = a->s;
    int n = dalcs_system_n_equations(s);
    bool ok = a->from->n_rows == 0 || (int)a->from->n_rows == n - 2 * a->n_lifted;
    bool *taken = dalcs_alloc((size_t)n, sizeof *taken);
    if (taken == NULL) {
        r->builder.out_of_memory = true;
        return false;
    }
    for (int i = 0; i < n && ok; i++) {
        ok = s->dual[i] < n && !taken[s->dual[i]] && s->forest_root[i] < n;
        if (ok) {
            taken[s->dual[i]] = true;
            ok = (s->row[i].kind == DALCS_LABEL_REFERENCE) ==
                     (s->column[s->dual[i]].kind == DALCS_LABEL_REFERENCE) &&
                 (s->forest_root[i] == i || (i >= s->n_x && s->forest_root[i] >= s->n_x));
        }
    }
    free(taken);
    if (!ok) {
        dalcs_builder_error(&r->builder, a->from->token, NULL,
                            "rows and columns do not fit: there must be a row for each state and "
                            "unknown, each paired (dual=) with a column of its own, references "
                            "with references");
    }
    if (ok && !valves_fit(s)) {
        ok = false;
        dalcs_builder_error(&r->builder, a->from->token, NULL,
                            "the valve of a switch is the number of a pair of its system");
    }
    return ok;
}
