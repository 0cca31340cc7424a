/* component_size.c - the number of unknowns of each sort in a component, and the places of its nodes among them. */
#include "component_size.h"

#include "stamp_behaviour.h"

#include <float.h>
#include <math.h>

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
        return 1.0 / c->models.of_diode[d->model].roff;
    case DALCS_SWITCH:
        return 1.0 / c->models.of_switch[d->model].roff;
    default:
        return 0.0;
    }
}

void dalcs_find_best_conductor(struct dalcs_layout *l, const struct dalcs_members *m) {
    double least = INFINITY;
    for (int i = 0; i < m->n_devices; i++) {
        double g = conductance_of(l->circuit, &l->circuit->device[m->device[i]]);
        least = g > 0.0 && g < least ? g : least;
    }
    l->most_conductance = most_conductances_apart * least;
}

bool dalcs_layout_is_branch(const struct dalcs_layout *l, int device) {
    const struct dalcs_device *d = &l->circuit->device[device];
    return d->kind == DALCS_RESISTOR && d->behaviour == NULL && d->value != 0.0 &&
           conductance_of(l->circuit, d) > l->most_conductance;
}

/* Counts the unknowns of a device without a formula. */
static void count_device(struct stamps *b, int device) {
    const struct dalcs_layout *l = b->layout;
    const struct dalcs_device *d = &l->circuit->device[device];
    struct dalcs_system *s = b->s;
    switch (d->kind) {
    case DALCS_RESISTOR:
        s->n_z += d->value == 0.0 || dalcs_layout_is_branch(l, device) ? 1 : 0;
        break;
    case DALCS_CAPACITOR:
        s->n_x++;
        b->n_tree += l->topology.in_forest[device] ? 1 : 0;
        s->n_z += l->topology.in_forest[device] ? 0 : 1;
        break;
    case DALCS_INDUCTOR:
        if (l->group_of[device] < 0) {
            s->n_x++;
        } else if (l->group[l->group_of[device]].device[0] == device) {
            const struct coil_group *g = &l->group[l->group_of[device]];
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
        s->n_pairs += isfinite(l->circuit->models.of_diode[d->model].vrev) ? 2 : 1;
        break;
    case DALCS_SWITCH:
        s->n_pairs++;
        break;
    case DALCS_CCCS:
    case DALCS_VCCS:
        break;
    }
}

void dalcs_count_unknowns(struct stamps *b, const struct dalcs_members *m, int component) {
    const struct dalcs_layout *l = b->layout;
    const struct dalcs_circuit *c = l->circuit;
    struct dalcs_system *s = b->s;
    s->n_z = m->n_nodes;
    s->n_inputs = 1;
    for (int i = 0; i < m->n_nodes; i++) {
        s->n_z += l->topology.is_reference[m->node[i]] ? 1 : 0;
    }
    for (int i = 0; i < m->n_devices; i++) {
        const struct dalcs_device *d = &c->device[m->device[i]];
        if (d->behaviour != NULL) {
            s->n_z++;
            s->n_pairs += d->behaviour->n_pairs;
            s->n_inputs += dalcs_behaviour_n_inputs(d->behaviour);
            b->n_smooth += d->behaviour->smooth != NULL ? 1 : 0;
            continue;
        }
        count_device(b, m->device[i]);
    }
    if (l->held_start != NULL) {
        s->n_z += l->held_start[component + 1] - l->held_start[component];
    }
}

enum dalcs_status dalcs_allocate_system(struct stamps *b) {
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

void dalcs_number_nodes(struct stamps *b, const struct dalcs_members *m) {
    struct dalcs_layout *l = b->layout;
    struct dalcs_system *s = b->s;
    int next_tree = 0;
    for (int i = 0; i < m->n_nodes; i++) {
        int column = s->n_x + i;
        bool differential = l->topology.forest_root[m->node[i]] != m->node[i];
        int row = differential ? next_tree++ : s->n_x + b->next_row++;
        l->node_column[m->node[i]] = column;
        l->kcl_row[m->node[i]] = row;
        s->dual[row] = column;
        s->column_is_current[column] = false;
        s->row_is_current[row] = true;
        const char *name = l->circuit->node_name[m->node[i]];
        s->column[column] = (struct dalcs_label){name, DALCS_LABEL_NODE};
        s->row[row] = (struct dalcs_label){name, DALCS_LABEL_NODE};
    }
    for (int i = 0; i < m->n_nodes; i++) {
        int root = l->topology.forest_root[m->node[i]];
        s->forest_root[s->n_x + i] = root == 0 ? s->n_x + i : l->node_column[root];
    }
    b->next_z = m->n_nodes;
    b->next_x = b->n_tree;
}
