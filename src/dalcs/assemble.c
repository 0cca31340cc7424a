/* assemble.c - modified nodal analysis written as a DALCS.
 *
 *   x   voltages of capacitors, (magnetising) currents of coils
 *   z   node voltages; currents of V, E, H; of capacitors that close a loop of capacitors or are
 *       asked for; of coils that perfect coupling makes dependent; of resistors far below others
 *   lambda   currents of diodes and switches
 *
 * KCL, currents leaving. At a node of the capacitor forest (its root apart) KCL is the differential
 * equation of a capacitor, C x' = -(the other currents), so that no capacitor current is an unknown;
 * the KCL of a root is summed over its tree, where the capacitor currents cancel.
 *
 * Signs are chosen for passivity: with rows in the order of `dual`, -A is skew but for conductances
 * and resistances on its diagonal blocks. */
#include "assemble.h"

#include "component_size.h"
#include "stamp_behaviour.h"
#include "stamp_device.h"

#include <stdlib.h>

static enum dalcs_status stamp_formulas(struct stamps *b, const struct dalcs_members *m) {
    for (int i = 0; i < m->n_devices; i++) {
        if (b->layout->circuit->device[m->device[i]].behaviour != NULL) {
            DALCS_TRY(dalcs_stamp_behaviour(b, m->device[i]));
        }
    }
    return DALCS_OK;
}

/* Adds a factor times the voltage of a node to the root of its tree of sources: from source to source, and for an E
 * source from the nodes that control it on. */
static enum dalcs_status add_potential(struct stamps *b, int pair, int node, double factor) {
    const struct dalcs_layout *l = b->layout;
    const struct dalcs_topology *t = &l->topology;
    for (int n = t->node_of[node]; t->potential_source[n] >= 0;) {
        int source = t->potential_source[n];
        const struct dalcs_device *d = &l->circuit->device[source];
        bool upward = t->node_of[d->node[0]] == n;
        double of_source = upward ? factor : -factor;
        if (d->kind == DALCS_VCVS && d->behaviour == NULL) {
            DALCS_TRY(add_potential(b, pair, d->node[2], of_source * d->value));
            DALCS_TRY(add_potential(b, pair, d->node[3], -of_source * d->value));
        } else { /* one stimulus */
            DALCS_TRY(dalcs_triplets_add(&b->direct_control, pair, l->input[source], of_source));
        }
        n = t->node_of[d->node[upward ? 1 : 0]];
    }
    return DALCS_OK;
}

/* The controlling voltages that sources fix, once every source has its input. */
static enum dalcs_status stamp_direct_controls(struct stamps *b, const struct dalcs_members *m) {
    const struct dalcs_layout *l = b->layout;
    for (int i = 0; i < m->n_devices; i++) {
        const struct dalcs_device *d = &l->circuit->device[m->device[i]];
        if (d->kind != DALCS_SWITCH || !b->s->pair[l->pair[m->device[i]]].is_direct) {
            continue;
        }
        double sign = dalcs_stamp_control_sign(&l->circuit->models.of_switch[d->model]);
        DALCS_TRY(add_potential(b, l->pair[m->device[i]], d->node[2], sign));
        DALCS_TRY(add_potential(b, l->pair[m->device[i]], d->node[3], -sign));
    }
    return DALCS_OK;
}

/* F, H and W wait until every current column is known. */
static enum dalcs_status stamp_current_controls(struct stamps *b, const struct dalcs_members *m) {
    struct dalcs_layout *l = b->layout;
    for (int i = 0; i < m->n_devices; i++) {
        const struct dalcs_device *d = &l->circuit->device[m->device[i]];
        if (d->kind == DALCS_CCCS) {
            DALCS_TRY(dalcs_stamp_reads_column(b, m->device[i], l->current_column[d->control]));
            DALCS_TRY(dalcs_stamp_branch_current(b, d, l->current_column[d->control], d->value));
        } else if (d->kind == DALCS_CCVS) {
            DALCS_TRY(dalcs_stamp_reads(b, m->device[i], l->branch_row[m->device[i]],
                                        l->current_column[d->control]));
            DALCS_TRY(dalcs_stamp_add(&b->A, l->branch_row[m->device[i]],
                                      l->current_column[d->control], -d->value));
        } else if (d->kind == DALCS_SWITCH && d->control >= 0) {
            DALCS_TRY(
                dalcs_stamp_add(&b->control, l->pair[m->device[i]], l->current_column[d->control],
                                dalcs_stamp_control_sign(&l->circuit->models.of_switch[d->model])));
        }
    }
    return DALCS_OK;
}

/* v(node) = 0 and a current into the reference that must come out as zero. */
static enum dalcs_status stamp_references(struct stamps *b, const struct dalcs_members *m) {
    struct dalcs_system *s = b->s;
    for (int i = 0; i < m->n_nodes; i++) {
        if (!b->layout->topology.is_reference[m->node[i]]) {
            continue;
        }
        int column = s->n_x + b->next_z++;
        int row = s->n_x + b->next_row++;
        const char *name = b->layout->circuit->node_name[m->node[i]];
        s->dual[row] = column;
        s->column_is_current[column] = true;
        s->row_is_current[row] = false;
        s->column[column] = (struct dalcs_label){name, DALCS_LABEL_REFERENCE};
        s->row[row] = (struct dalcs_label){name, DALCS_LABEL_REFERENCE};
        DALCS_TRY(dalcs_stamp_leave(b, &b->A, m->node[i], column, 1.0));
        DALCS_TRY(dalcs_stamp_add_voltage(b, &b->A, row, m->node[i], 0, 1.0));
    }
    return DALCS_OK;
}

/* .ic voltages held by sources while the operating point is sought, as SPICE does. In an island that
 * floats, the voltage of a node is that against the island's reference. */
static enum dalcs_status stamp_clamps(struct stamps *b, int component) {
    struct dalcs_layout *l = b->layout;
    struct dalcs_system *s = b->s;
    const struct dalcs_circuit *c = l->circuit;
    for (int k = l->held_start[component]; k < l->held_start[component + 1]; k++) {
        const struct dalcs_initial_condition *ic = &c->initial_condition[l->held[k]];
        int column = s->n_x + b->next_z++;
        int row = s->n_x + b->next_row++;
        int first = ic->node[0];
        int second =
            ic->node[1] != 0 ? ic->node[1] : l->topology.reference_of[l->topology.node_of[first]];
        s->dual[row] = column;
        s->column_is_current[column] = true;
        s->row_is_current[row] = false;
        s->column[column] = (struct dalcs_label){".ic", DALCS_LABEL_BRANCH};
        s->row[row] = (struct dalcs_label){".ic", DALCS_LABEL_BRANCH};
        DALCS_TRY(dalcs_stamp_leave(b, &b->A, first, column, 1.0));
        DALCS_TRY(dalcs_stamp_leave(b, &b->A, second, column, -1.0));
        DALCS_TRY(dalcs_stamp_add_voltage(b, &b->A, row, first, second, 1.0));
        if (ic->value != 0.0) {
            DALCS_TRY(dalcs_triplets_add(&b->E, row, 0, -ic->value));
        }
    }
    return DALCS_OK;
}

/* Where the lines of smooth sources are. Two arguments of one column have one between them. */
static void find_tangents(struct dalcs_system *s) {
    for (int q = 0; q < s->n_smooth; q++) {
        struct dalcs_smooth_input *of = &s->smooth[q];
        for (int j = 0; j < of->n; j++) {
            bool is_new = of->column[j] >= 0 && !(j > 0 && of->column[0] == of->column[1]);
            for (int k = s->A.p[of->row]; k < s->A.p[of->row + 1] && is_new; k++) {
                of->entry[j] = s->A.j[k] == of->column[j] ? &s->A.x[k] : of->entry[j];
            }
            if (of->entry[j] != NULL) {
                *of->entry[j] = 0.0;
            }
        }
    }
}

/* Which element each entry of `reads` is of: one of them, where several read the same. */
static enum dalcs_status name_readers(struct stamps *b) {
    const struct dalcs_csr *reads = &b->s->reads;
    b->s->reader = dalcs_alloc((size_t)reads->p[reads->n_rows], sizeof(*b->s->reader));
    if (b->s->reader == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < b->reads.n; i++) {
        const struct dalcs_triplet *t = &b->reads.entry[i];
        for (int k = reads->p[t->row]; k < reads->p[t->row + 1]; k++) {
            if (reads->j[k] == t->column) {
                b->s->reader[k] = b->layout->circuit->device[(int)t->value - 1].name;
            }
        }
    }
    return DALCS_OK;
}

/* Is this pair's device in the same component as these? */
static bool is_in(const struct dalcs_layout *l, int device, const struct dalcs_members *m) {
    const int *component = l->topology.device_component;
    return component[device] == component[m->device[0]] && l->pair[device] >= 0;
}

/* When all pairs have numbers. */
static void find_valves(struct stamps *b, const struct dalcs_members *m) {
    const struct dalcs_layout *l = b->layout;
    for (int i = 0; i < m->n_devices; i++) {
        const struct dalcs_device *d = &l->circuit->device[m->device[i]];
        if (d->kind == DALCS_SWITCH && d->valve >= 0 && is_in(l, d->valve, m)) {
            struct dalcs_pair *pair = &b->s->pair[l->pair[m->device[i]]];
            pair->has_valve = true;
            pair->valve = l->pair[d->valve];
        }
    }
}

/* Everything that the devices say. */
static enum dalcs_status stamp_all(struct stamps *b, const struct dalcs_members *m) {
    const struct dalcs_layout *l = b->layout;
    int next_forest = 0;
    dalcs_number_nodes(b, m);
    for (int i = 0; i < m->n_devices; i++) {
        DALCS_TRY(dalcs_stamp_device(b, m->device[i], &next_forest));
    }
    find_valves(b, m);
    DALCS_TRY(stamp_current_controls(b, m));
    DALCS_TRY(stamp_formulas(b, m));
    DALCS_TRY(stamp_direct_controls(b, m));
    DALCS_TRY(stamp_references(b, m));
    return l->held_start != NULL ? stamp_clamps(b, l->topology.device_component[m->device[0]])
                                 : DALCS_OK;
}

/* Makes matrices of the collected entries. */
static enum dalcs_status compress(struct stamps *b) {
    struct dalcs_system *system = b->s;
    int n_equations = dalcs_system_n_equations(system);
    int n_columns = dalcs_system_n_columns(system);

    const struct {
        struct dalcs_csr *matrix;
        int n_rows, n_columns;
        const struct dalcs_triplets *entries;
    } part[] = {
        {&system->P, system->n_x, system->n_x, &b->P},
        {&system->A, n_equations, n_columns, &b->A},
        {&system->E, n_equations, system->n_inputs, &b->E},
        {&system->C, system->n_pairs, n_columns, &b->C},
        {&system->F, system->n_pairs, system->n_inputs, &b->F},
        {&system->storage, system->n_x, system->n_x, &b->storage},
        {&system->control, system->n_pairs, n_columns, &b->control},
        {&system->direct_control, system->n_pairs, system->n_inputs, &b->direct_control},
        {&system->reads, n_equations + system->n_pairs, n_columns, &b->reads},
    };

    for (size_t k = 0; k < sizeof(part) / sizeof(part[0]); k++) {
        DALCS_TRY(dalcs_csr_compress_rounded(part[k].matrix, part[k].n_rows, part[k].n_columns,
                                             part[k].entries));
    }
    DALCS_TRY(dalcs_system_find_rest(system, &b->A));
    find_tangents(system);
    return name_readers(b);
}

enum dalcs_status dalcs_assemble_component(struct dalcs_layout *layout,
                                           const struct dalcs_members *m,
                                           struct dalcs_system *system, double **initial) {
    *system = (struct dalcs_system){.monotone = true};
    struct stamps b = {.layout = layout, .s = system};
    dalcs_find_best_conductor(layout, m);
    dalcs_count_unknowns(&b, m, layout->topology.device_component[m->device[0]]);
    enum dalcs_status status = dalcs_allocate_system(&b);
    if (status == DALCS_OK) {
        status = stamp_all(&b, m);
    }
    if (status == DALCS_OK) {
        status = compress(&b);
    }
    dalcs_triplets_finish(&b.P);
    dalcs_triplets_finish(&b.A);
    dalcs_triplets_finish(&b.E);
    dalcs_triplets_finish(&b.C);
    dalcs_triplets_finish(&b.F);
    dalcs_triplets_finish(&b.storage);
    dalcs_triplets_finish(&b.control);
    dalcs_triplets_finish(&b.direct_control);
    dalcs_triplets_finish(&b.reads);
    if (status != DALCS_OK) {
        free(b.initial);
        b.initial = NULL;
        dalcs_system_finish(system);
    }
    *initial = b.initial;
    return status;
}
