/* stages.c - what all entries of a system have in common, and a step on any of them. */
#include "stage_update.h"

#include "magnitudes.h"

#include <stdlib.h>
#include <string.h>

/* Is it KCL of a node without capacitors at which a resistor ends? */
static bool has_conductance(const struct dalcs_system *s, int row) {
    bool has = false;
    for (int k = s->A.p[row]; s->row_is_current[row] && k < s->A.p[row + 1]; k++) {
        int c = s->A.j[k];
        has = has || (c < dalcs_system_n_equations(s) && !s->column_is_current[c]);
    }
    return has;
}

/* The voltages of nodes: a controlled source may have any gain. */
static void list_voltages(struct dalcs_stages *stages) {
    const struct dalcs_system *s = stages->system;
    for (int c = s->n_x; c < dalcs_system_n_equations(s); c++) {
        if (!s->column_is_current[c] && (s->is_part == NULL || !s->is_part[c])) {
            stages->levered[stages->n_levered++] = c;
        }
    }
}

/* Branch currents without memory, and voltages that resistors make of what currents of coils differ by. */
static void list_levered(struct dalcs_stages *stages) {
    const struct dalcs_system *s = stages->system;
    bool has_coil = false;
    for (int x = 0; x < s->n_x; x++) {
        has_coil = has_coil || s->column_is_current[x];
    }
    for (int c = s->n_x; c < dalcs_system_n_equations(s); c++) {
        if (s->column_is_current[c]) {
            stages->levered[stages->n_currents++] = c;
        }
    }
    stages->n_levered = stages->n_currents;
    if (!s->monotone) {
        list_voltages(stages);
        return;
    }
    for (int r = s->n_x; has_coil && r < dalcs_system_n_equations(s); r++) {
        int c = s->dual[r];
        if (c >= s->n_x && !s->column_is_current[c] && has_conductance(s, r)) {
            stages->levered[stages->n_levered++] = c;
        }
    }
}

enum dalcs_status dalcs_stages_setup(struct dalcs_stages *stages, const struct dalcs_system *system,
                                     const struct dalcs_excitation *excitation,
                                     const struct dalcs_collocation *method,
                                     const struct dalcs_stage_limits *limits) {
    *stages = (struct dalcs_stages){.system = system,
                                    .excitation = excitation,
                                    .method = method,
                                    .n_in = system->n_x + 1 + excitation->n_functions,
                                    .n_words = (system->n_pairs + 63) / 64,
                                    .dense_limit = limits->dense_limit,
                                    .rcond_min = limits->rcond_min,
                                    .cache.most_bytes = limits->most_bytes,
                                    .cache.update_trust = DALCS_STAGE_FIRST_TRUST};
    dalcs_lu_common_init(&stages->cache.klu);
    dalcs_lu_common_init(&stages->cache.klu_complex);
    /* A capacitor across a conducting diode turns what digits cost, times C/h, into a current of it. */
    dalcs_lu_pivot_carefully(&stages->cache.klu);
    dalcs_lu_pivot_carefully(&stages->cache.klu_complex);
    stages->watched = dalcs_alloc((size_t)system->n_pairs, sizeof(int));
    stages->cache.key = dalcs_alloc((size_t)stages->n_words + 1, sizeof(*stages->cache.key));
    int n_z = dalcs_system_n_equations(system) - system->n_x;
    stages->levered = dalcs_alloc((size_t)n_z, sizeof(int));
    if (stages->watched == NULL || stages->cache.key == NULL || stages->levered == NULL) {
        dalcs_stages_finish(stages);
        return DALCS_E_NOMEM;
    }
    list_levered(stages);
    for (int d = 0; d < system->n_pairs; d++) {
        const struct dalcs_pair *p = &system->pair[d];
        if (p->kind == DALCS_PAIR_SWITCH && !p->is_direct) {
            stages->watched[stages->n_watched++] = d;
        }
    }
    int n_columns = dalcs_system_n_columns(system);
    struct dalcs_stage_layout *l = &stages->layout;
    l->stride = n_columns + stages->n_watched;
    l->n_nodes = method->s + 1;
    l->drift = (method->n_stages + 1) * l->stride;
    l->ripple = l->drift + system->n_x;
    l->n_fixed = l->ripple + (excitation->is_curved ? n_columns : 0);
    return DALCS_OK;
}

void dalcs_stages_finish(struct dalcs_stages *stages) {
    dalcs_stages_forget(stages);
    free(stages->watched);
    free(stages->levered);
    free(stages->cache.key);
    *stages = (struct dalcs_stages){0};
}

enum dalcs_status dalcs_stages_apply(struct dalcs_stages *stages, struct dalcs_stage_entry *entry,
                                     const double *in, double *out) {
    if (entry->map != NULL) {
        dalcs_stage_map_apply(stages, entry, in, out);
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_stage_factors_apply(stages, entry, in, out));
    if (dalcs_stage_is_update(entry)) {
        dalcs_stage_update_check(stages, entry, in, out);
    }
    return DALCS_OK;
}

void dalcs_stages_settle(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                         double *out) {
    if (entry->map == NULL && stages->system->n_x > 0) {
        dalcs_stage_factors_settle(stages, entry, out);
    }
}

void dalcs_stages_drift_of_currents(struct dalcs_stages *stages,
                                    const struct dalcs_stage_entry *entry, const double *in,
                                    double *drift) {
    if (entry->map != NULL) {
        dalcs_stage_map_currents(stages, entry, in, drift);
    } else {
        dalcs_stage_factors_currents(stages, entry, drift);
    }
}

int *dalcs_stage_note(struct dalcs_stage_entry *entry) {
    return &entry->note;
}

enum dalcs_status dalcs_stages_step(struct dalcs_stages *stages, const uint64_t *mode, double h,
                                    const double *in, double *out,
                                    struct dalcs_stage_entry **entry) {
    DALCS_TRY(dalcs_stages_get(stages, mode, h, entry));
    DALCS_TRY(dalcs_stages_apply(stages, *entry, in, out));
    if (!dalcs_stage_update_is_doubtful(stages, *entry)) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_stages_get(stages, mode, h, entry)); /* with factors of its own */
    return dalcs_stages_apply(stages, *entry, in, out);
}

void dalcs_stages_stay_near(struct dalcs_stages *stages, const uint64_t *mode, const double *y) {
    struct dalcs_stage_plan *plan = stages->plan;
    if (plan == NULL) {
        return;
    }
    int n_equations = dalcs_stage_plan_n_equations(plan);
    memcpy(plan->work.near, y, (size_t)plan->n_rows * sizeof(double));
    for (int d = 0; d < stages->system->n_pairs; d++) {
        if (!dalcs_mode_has(mode, d)) { /* that is its w */
            plan->work.near[n_equations + d] = 0.0;
        }
    }
}

int dalcs_stage_n_clashes(const struct dalcs_stage_entry *entry) {
    return entry->n_clashes;
}

bool dalcs_stage_gives_rows_up(const struct dalcs_stage_entry *entry) {
    return entry->gives_rows_up;
}

double dalcs_stage_residual(const struct dalcs_stage_entry *entry) {
    return entry->residual;
}

bool dalcs_stage_frees_states(const struct dalcs_stage_entry *entry) {
    return entry->frees_states;
}

const double *dalcs_stage_natural_units(const struct dalcs_stage_entry *entry) {
    return entry->natural;
}

/* Stages in double precision cancel, and so do states against sources in currents of capacitors: two digits of those that
 * a map has, which is solved for in extended precision. */
double dalcs_stage_rounding(const struct dalcs_stage_entry *entry) {
    return entry->map != NULL ? 1.0 : 1.0 / dalcs_slight;
}
