/* stage_miss.c - what the rows of a step on factors miss, as they are solved: with those that are added to them. */
#include "stage_update.h"

#include <math.h>

/* Columns y at a node of a step that begins with `in`. */
struct columns_at {
    const struct dalcs_system *system;
    const struct dalcs_stage_entry *entry;
    const double *in, *y;
};

/* Adds factor times what row `from` of A, or of C, has there. */
static void add_row(const struct columns_at *at, const struct dalcs_csr *a, int from, double factor,
                    struct dalcs_row_miss *miss) {
    const int n_equations = dalcs_system_n_equations(at->system);
    for (int k = a->p[from]; k < a->p[from + 1]; k++) {
        if (a->j[k] >= n_equations && !dalcs_stage_is_on(at->entry, a->j[k] - n_equations)) {
            continue; /* y has its w there */
        }
        const double term = factor * a->x[k] * at->y[a->j[k]];
        miss->missed += term;
        miss->terms += fabs(term);
        if (a->j[k] < at->system->n_x) { /* solved for as an increment over this */
            miss->terms += fabs(a->x[k] * at->in[a->j[k]]);
        }
    }
}

/* Of a row with those that are added to it (stage_join.h), as its sources are. */
struct dalcs_row_miss dalcs_stage_factors_miss_of_row(const struct dalcs_stages *stages,
                                                      const struct dalcs_stage_entry *entry, int r,
                                                      int node, const double *in, const double *y) {
    const struct dalcs_stage_plan *plan = stages->plan;
    const struct dalcs_system *s = stages->system;
    const int n_equations = dalcs_system_n_equations(s);
    const struct columns_at at = {s, entry, in, y};
    const double constant = in[s->n_x] * plan->constant[r];
    struct dalcs_row_miss miss = {constant, fabs(constant)};
    if (r >= n_equations) {
        add_row(&at, &s->C, r - n_equations, -1.0, &miss);
    }
    for (int f = r < n_equations ? r : -1; f >= 0; f = dalcs_stage_join_after(&plan->join, r, f)) {
        add_row(&at, &s->A, f, 1.0, &miss);
    }
    for (int k = plan->waves.wave_begin[r]; k < plan->waves.wave_begin[r + 1]; k++) {
        double term = plan->waves.wave_x[k] *
                      plan->work.share[plan->waves.wave_of[k] * DALCS_N_SHARES + node];
        miss.missed += term;
        miss.terms += fabs(term);
    }
    return miss;
}

double dalcs_stage_clash_size(const struct dalcs_stages *stages,
                              const struct dalcs_stage_entry *entry, int k, int node,
                              const double *in, const double *size) {
    const struct dalcs_stage_singular *g = &entry->factors->singular;
    return g->scale[k] *
           dalcs_stage_factors_miss_of_row(stages, entry, g->row[k], node, in, size).terms;
}

double dalcs_stage_factors_miss(const struct dalcs_stages *stages,
                                const struct dalcs_stage_entry *entry, const double *in,
                                const double *out) {
    const struct dalcs_stage_factors *f = entry->factors;
    const double *y = out + stages->method->s * stages->layout.stride;
    const struct dalcs_stage_order *o = &f->order[0];
    int n_x = stages->system->n_x;
    int n_equations = dalcs_system_n_equations(stages->system);
    int n_closed = f->update != NULL ? f->update->n_closed : 0;
    double worst = 0.0;
    double size = 0.0;
    for (int i = 0; i < o->n + n_closed; i++) {
        const struct dalcs_stage_change *c = i < o->n ? NULL : f->update->change[i - o->n];
        int r = c == NULL ? o->row_of[i] : n_equations + c->pair;
        double scale = c == NULL ? o->scale[i] : c->row_scale;
        if (r < n_x || r >= stages->plan->n_rows ||
            (r >= n_equations && !dalcs_stage_is_on(entry, r - n_equations))) {
            continue;
        }
        struct dalcs_row_miss miss =
            dalcs_stage_factors_miss_of_row(stages, entry, r, stages->method->s, in, y);
        worst = miss.missed != miss.missed ? INFINITY : fmax(worst, scale * fabs(miss.missed));
        size = fmax(size, scale * miss.terms);
    }
    return size > 0.0 ? worst / size : 0.0;
}
