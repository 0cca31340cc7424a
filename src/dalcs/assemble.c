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

#include "stamp_behaviour.h"
#include "stamp_device.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

static enum dalcs_status stamp_formulas(struct stamps *b, int n_devices, const int *device) {
    for (int i = 0; i < n_devices; i++) {
        if (b->layout->circuit->device[device[i]].behaviour != NULL) {
            DALCS_TRY(dalcs_stamp_behaviour(b, device[i]));
        }
    }
    return DALCS_OK;
}

/* Adds a factor times the voltage of a node that sources fix: from source to source to ground, and for an E source from
 * the nodes that control it on. */
static enum dalcs_status add_potential(struct stamps *b, int pair, int node, double factor) {
    const struct dalcs_layout *l = b->layout;
    const struct dalcs_topology *t = &l->topology;
    for (int n = t->node_of[node]; n != 0;) {
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
static enum dalcs_status stamp_direct_controls(struct stamps *b, int n_devices, const int *device) {
    const struct dalcs_layout *l = b->layout;
    for (int i = 0; i < n_devices; i++) {
        const struct dalcs_device *d = &l->circuit->device[device[i]];
        if (d->kind != DALCS_SWITCH || !b->s->pair[l->pair[device[i]]].is_direct) {
            continue;
        }
        double sign = dalcs_stamp_control_sign(&l->circuit->switch_model[d->model]);
        DALCS_TRY(add_potential(b, l->pair[device[i]], d->node[2], sign));
        DALCS_TRY(add_potential(b, l->pair[device[i]], d->node[3], -sign));
    }
    return DALCS_OK;
}

/* F, H and W wait until every current column is known. */
static enum dalcs_status stamp_current_controls(struct stamps *b, int n_devices,
                                                const int *device) {
    struct dalcs_layout *l = b->layout;
    for (int i = 0; i < n_devices; i++) {
        const struct dalcs_device *d = &l->circuit->device[device[i]];
        if (d->kind == DALCS_CCCS) {
            DALCS_TRY(dalcs_stamp_reads_column(b, device[i], l->current_column[d->control]));
            DALCS_TRY(dalcs_stamp_branch_current(b, d, l->current_column[d->control], d->value));
        } else if (d->kind == DALCS_CCVS) {
            DALCS_TRY(dalcs_stamp_reads(b, device[i], l->branch_row[device[i]],
                                        l->current_column[d->control]));
            DALCS_TRY(dalcs_stamp_add(&b->A, l->branch_row[device[i]],
                                      l->current_column[d->control], -d->value));
        } else if (d->kind == DALCS_SWITCH && d->control >= 0) {
            DALCS_TRY(
                dalcs_stamp_add(&b->control, l->pair[device[i]], l->current_column[d->control],
                                dalcs_stamp_control_sign(&l->circuit->switch_model[d->model])));
        }
    }
    return DALCS_OK;
}

/* v(node) = 0 and a current into the reference that must come out as zero. */
static enum dalcs_status stamp_references(struct stamps *b, int n_nodes, const int *node) {
    struct dalcs_system *s = b->s;
    for (int i = 0; i < n_nodes; i++) {
        if (!b->layout->topology.is_reference[node[i]]) {
            continue;
        }
        int column = s->n_x + b->next_z++;
        int row = s->n_x + b->next_row++;
        const char *name = b->layout->circuit->node_name[node[i]];
        s->dual[row] = column;
        s->column_is_current[column] = true;
        s->row_is_current[row] = false;
        s->column[column] = (struct dalcs_label){name, DALCS_LABEL_REFERENCE};
        s->row[row] = (struct dalcs_label){name, DALCS_LABEL_REFERENCE};
        DALCS_TRY(dalcs_stamp_leave(b, &b->A, node[i], column, 1.0));
        DALCS_TRY(dalcs_stamp_add_voltage(b, &b->A, row, node[i], 0, 1.0));
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

/* The sum of the conductances at a node is rounded: in KCL that is a conductance to ground of eps/2 of the sum, which no
 * element has. Beside the least conductance of the part it must be less than the error that the default tolerance leaves to a
 * step, 3e-8. What conducts better has its current as an unknown, and KCL has a 1 for it. */
static const double most_conductances_apart = 3e-8 / (0.5 * DBL_EPSILON);

/* Of resistors and of what leaks. */
static double conductance_of(const struct dalcs_circuit *c, const struct dalcs_device *d) {
    switch (d->behaviour != NULL ? DALCS_VSOURCE : d->kind) {
    case DALCS_RESISTOR:
        return d->value == 0.0 ? 0.0 : 1.0 / fabs(d->value);
    case DALCS_DIODE:
        return 1.0 / c->diode_model[d->model].roff;
    case DALCS_SWITCH:
        return 1.0 / c->switch_model[d->model].roff;
    default:
        return 0.0;
    }
}

static void find_best_conductor(struct dalcs_layout *l, int n_devices, const int *device) {
    double least = INFINITY;
    for (int i = 0; i < n_devices; i++) {
        double g = conductance_of(l->circuit, &l->circuit->device[device[i]]);
        least = g > 0.0 && g < least ? g : least;
    }
    l->most_conductance = most_conductances_apart * least;
}

bool dalcs_layout_is_branch(const struct dalcs_layout *l, int device) {
    const struct dalcs_device *d = &l->circuit->device[device];
    return d->kind == DALCS_RESISTOR && d->behaviour == NULL && d->value != 0.0 &&
           conductance_of(l->circuit, d) > l->most_conductance;
}

/* How many unknowns of each sort the component needs: everything else follows from the counts. */
static void count(struct stamps *b, int n_devices, const int *device, int n_nodes, const int *node,
                  int component) {
    const struct dalcs_layout *l = b->layout;
    const struct dalcs_circuit *c = l->circuit;
    struct dalcs_system *s = b->s;
    s->n_z = n_nodes;
    s->n_inputs = 1;
    for (int i = 0; i < n_nodes; i++) {
        s->n_z += l->topology.is_reference[node[i]] ? 1 : 0;
    }
    for (int i = 0; i < n_devices; i++) {
        const struct dalcs_device *d = &c->device[device[i]];
        if (d->behaviour != NULL) {
            s->n_z++;
            s->n_pairs += d->behaviour->n_pairs;
            s->n_inputs += dalcs_behaviour_n_inputs(d->behaviour);
            b->n_smooth += d->behaviour->smooth != NULL ? 1 : 0;
            continue;
        }
        switch (d->kind) {
        case DALCS_RESISTOR:
            s->n_z += d->value == 0.0 || dalcs_layout_is_branch(l, device[i]) ? 1 : 0;
            break;
        case DALCS_CAPACITOR:
            s->n_x++;
            b->n_tree += l->topology.in_forest[device[i]] ? 1 : 0;
            s->n_z += l->topology.in_forest[device[i]] ? 0 : 1;
            break;
        case DALCS_INDUCTOR:
            if (l->group_of[device[i]] < 0) {
                s->n_x++;
            } else if (l->group[l->group_of[device[i]]].device[0] == device[i]) {
                const struct coil_group *g = &l->group[l->group_of[device[i]]];
                s->n_x += g->split.rank;
                s->n_z += g->n - g->split.rank;
            }
            break;
        case DALCS_VSOURCE:
            s->n_inputs++;
            s->n_z++;
            break;
        case DALCS_ISOURCE:
            s->n_inputs++;
            break;
        case DALCS_VCVS:
        case DALCS_CCVS:
            s->n_z++;
            break;
        case DALCS_DIODE:
            s->n_pairs += isfinite(c->diode_model[d->model].vrev) ? 2 : 1;
            break;
        case DALCS_SWITCH:
            s->n_pairs++;
            break;
        case DALCS_CCCS:
        case DALCS_VCCS:
            break;
        }
    }
    if (l->held_start != NULL) {
        s->n_z += l->held_start[component + 1] - l->held_start[component];
    }
}

static enum dalcs_status allocate(struct stamps *b) {
    struct dalcs_system *s = b->s;
    size_t n_equations = (size_t)dalcs_system_n_equations(s);
    s->dual = dalcs_alloc(n_equations, sizeof(*s->dual));
    s->forest_root = dalcs_alloc(n_equations, sizeof(*s->forest_root));
    s->column_is_current = dalcs_alloc((size_t)dalcs_system_n_columns(s), sizeof(bool));
    s->row_is_current = dalcs_alloc(n_equations, sizeof(bool));
    s->row = dalcs_alloc(n_equations, sizeof(*s->row));
    s->column = dalcs_alloc(n_equations, sizeof(*s->column));
    s->pair = dalcs_alloc((size_t)s->n_pairs, sizeof(*s->pair));
    s->stimulus = dalcs_alloc((size_t)s->n_inputs, sizeof(*s->stimulus));
    s->input_element = dalcs_alloc((size_t)s->n_inputs, sizeof(*s->input_element));
    if (b->n_smooth > 0) {
        s->smooth = dalcs_alloc((size_t)b->n_smooth, sizeof(*s->smooth));
        s->is_part = dalcs_alloc((size_t)dalcs_system_n_columns(s), sizeof(*s->is_part));
    }
    b->initial = dalcs_alloc((size_t)s->n_x, sizeof(*b->initial));
    if (s->dual == NULL || s->forest_root == NULL || s->column_is_current == NULL ||
        s->row_is_current == NULL || s->row == NULL || s->column == NULL || s->pair == NULL ||
        s->stimulus == NULL || s->input_element == NULL || b->initial == NULL ||
        (b->n_smooth > 0 && (s->smooth == NULL || s->is_part == NULL))) {
        return DALCS_E_NOMEM;
    }
    for (size_t c = 0; c < n_equations; c++) {
        s->forest_root[c] = (int)c;
    }
    s->stimulus[0] = -1;
    b->next_input = 1;
    return DALCS_OK;
}

/* Node voltages are the first z; KCL rows: forest nodes in I, the others first in II. */
static void number_nodes(struct stamps *b, int n_nodes, const int *node) {
    struct dalcs_layout *l = b->layout;
    struct dalcs_system *s = b->s;
    int next_tree = 0;
    for (int i = 0; i < n_nodes; i++) {
        int column = s->n_x + i;
        bool differential = l->topology.forest_root[node[i]] != node[i];
        int row = differential ? next_tree++ : s->n_x + b->next_row++;
        l->node_column[node[i]] = column;
        l->kcl_row[node[i]] = row;
        s->dual[row] = column;
        s->column_is_current[column] = false;
        s->row_is_current[row] = true;
        const char *name = l->circuit->node_name[node[i]];
        s->column[column] = (struct dalcs_label){name, DALCS_LABEL_NODE};
        s->row[row] = (struct dalcs_label){name, DALCS_LABEL_NODE};
    }
    for (int i = 0; i < n_nodes; i++) {
        int root = l->topology.forest_root[node[i]];
        s->forest_root[s->n_x + i] = root == 0 ? s->n_x + i : l->node_column[root];
    }
    b->next_z = n_nodes;
    b->next_x = b->n_tree;
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

/* Sums less what they were rounded to. `sums` grows by the latter. */
static enum dalcs_status find_rest(struct dalcs_csr *rest, const struct dalcs_csr *rounded,
                                   struct dalcs_triplets *sums) {
    for (int r = 0; r < rounded->n_rows; r++) {
        for (int k = rounded->p[r]; k < rounded->p[r + 1]; k++) {
            DALCS_TRY(dalcs_triplets_add(sums, r, rounded->j[k], -rounded->x[k]));
        }
    }
    return dalcs_csr_compress(rest, rounded->n_rows, rounded->n_columns, sums);
}

enum dalcs_status dalcs_assemble_component(struct dalcs_layout *layout, int n_devices,
                                           const int *device, int n_nodes, const int *node,
                                           struct dalcs_system *system, double **initial) {
    *system = (struct dalcs_system){.monotone = true};
    struct stamps b = {.layout = layout, .s = system};
    int component = layout->topology.device_component[device[0]];
    enum dalcs_status status = DALCS_OK;
    find_best_conductor(layout, n_devices, device);
    count(&b, n_devices, device, n_nodes, node, component);
    status = allocate(&b);
    if (status != DALCS_OK) {
        goto done;
    }
    number_nodes(&b, n_nodes, node);
    int next_forest = 0;
    for (int i = 0; i < n_devices && status == DALCS_OK; i++) {
        status = dalcs_stamp_device(&b, device[i], &next_forest);
    }
    if (status == DALCS_OK) {
        status = stamp_current_controls(&b, n_devices, device);
    }
    if (status == DALCS_OK) {
        status = stamp_formulas(&b, n_devices, device);
    }
    if (status == DALCS_OK) {
        status = stamp_direct_controls(&b, n_devices, device);
    }
    if (status == DALCS_OK) {
        status = stamp_references(&b, n_nodes, node);
    }
    if (status == DALCS_OK && layout->held_start != NULL) {
        status = stamp_clamps(&b, component);
    }
    int n_equations = dalcs_system_n_equations(system);
    int n_columns = dalcs_system_n_columns(system);

    const struct {
        struct dalcs_csr *matrix;
        int n_rows, n_columns;
        const struct dalcs_triplets *entries;
    } part[] = {
        {&system->P, system->n_x, system->n_x, &b.P},
        {&system->A, n_equations, n_columns, &b.A},
        {&system->E, n_equations, system->n_inputs, &b.E},
        {&system->C, system->n_pairs, n_columns, &b.C},
        {&system->F, system->n_pairs, system->n_inputs, &b.F},
        {&system->storage, system->n_x, system->n_x, &b.storage},
        {&system->control, system->n_pairs, n_columns, &b.control},
        {&system->direct_control, system->n_pairs, system->n_inputs, &b.direct_control},
        {&system->reads, n_equations + system->n_pairs, n_columns, &b.reads},
    };

    for (size_t k = 0; k < sizeof(part) / sizeof(part[0]) && status == DALCS_OK; k++) {
        status =
            dalcs_csr_compress(part[k].matrix, part[k].n_rows, part[k].n_columns, part[k].entries);
    }
    if (status == DALCS_OK) {
        status = find_rest(&system->A_rest, &system->A, &b.A);
    }
    if (status == DALCS_OK) {
        find_tangents(system);
        status = name_readers(&b);
    }
done:
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
