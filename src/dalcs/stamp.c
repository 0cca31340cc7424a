/* stamp.c - rows and columns for currents, voltages and states. */
#include "stamp.h"

int dalcs_stamp_node_column(const struct dalcs_layout *l, int node) {
    int n = l->topology.node_of[node];
    return n == 0 ? -1 : l->node_column[n];
}

enum dalcs_status dalcs_stamp_add(struct dalcs_triplets *t, int row, int column, double value) {
    if (column < 0 || value == 0.0) {
        return DALCS_OK;
    }
    return dalcs_triplets_add(t, row, column, value);
}

enum dalcs_status dalcs_stamp_leave(struct stamps *b, struct dalcs_triplets *t, int node,
                                    int column, double value) {
    const struct dalcs_layout *l = b->layout;
    int n = l->topology.node_of[node];
    if (n == 0) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_stamp_add(t, l->kcl_row[n], column, -value));
    int root = l->topology.forest_root[n];
    if (root != n && root != 0) {
        DALCS_TRY(dalcs_stamp_add(t, l->kcl_row[root], column, -value));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_stamp_branch_current(struct stamps *b, const struct dalcs_device *d,
                                             int column, double value) {
    DALCS_TRY(dalcs_stamp_leave(b, &b->A, d->node[0], column, value));
    return dalcs_stamp_leave(b, &b->A, d->node[1], column, -value);
}

enum dalcs_status dalcs_stamp_add_voltage(struct stamps *b, struct dalcs_triplets *t, int row,
                                          int first, int second, double value) {
    DALCS_TRY(dalcs_stamp_add(t, row, dalcs_stamp_node_column(b->layout, first), value));
    return dalcs_stamp_add(t, row, dalcs_stamp_node_column(b->layout, second), -value);
}

enum dalcs_status dalcs_stamp_transconductance(struct stamps *b, int first, int second, int plus,
                                               int minus, double gain) {
    int c = dalcs_stamp_node_column(b->layout, plus);
    int d = dalcs_stamp_node_column(b->layout, minus);
    DALCS_TRY(dalcs_stamp_leave(b, &b->A, first, c, gain));
    DALCS_TRY(dalcs_stamp_leave(b, &b->A, first, d, -gain));
    DALCS_TRY(dalcs_stamp_leave(b, &b->A, second, c, -gain));
    return dalcs_stamp_leave(b, &b->A, second, d, gain);
}

enum dalcs_status dalcs_stamp_reads(struct stamps *b, int device, int row, int column) {
    return dalcs_stamp_add(&b->reads, row, column, device + 1.0);
}

enum dalcs_status dalcs_stamp_reads_column(struct stamps *b, int device, int column) {
    const struct dalcs_device *d = &b->layout->circuit->device[device];
    for (int e = 0; e < 2; e++) {
        DALCS_TRY(dalcs_stamp_leave(b, &b->reads, d->node[e], column, -(device + 1.0)));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_stamp_reads_voltage(struct stamps *b, int device, int plus, int minus) {
    DALCS_TRY(dalcs_stamp_reads_column(b, device, dalcs_stamp_node_column(b->layout, plus)));
    return dalcs_stamp_reads_column(b, device, dalcs_stamp_node_column(b->layout, minus));
}

enum dalcs_status dalcs_stamp_conductance(struct stamps *b, const struct dalcs_device *d,
                                          double g) {
    return dalcs_stamp_transconductance(b, d->node[0], d->node[1], d->node[0], d->node[1], g);
}

double dalcs_stamp_series_part(double r, double roff) {
    return r / (1.0 - r / roff);
}

int dalcs_stamp_new_input(struct stamps *b, int device) {
    struct dalcs_system *s = b->s;
    const struct dalcs_circuit *c = b->layout->circuit;
    int input = b->next_input++;
    s->stimulus[input] = c->device[device].stimulus;
    s->input_element[input] = c->device[device].name;
    b->layout->input[device] = input;
    return input;
}

void dalcs_stamp_new_branch(struct stamps *b, int device, int *column, int *row) {
    struct dalcs_system *s = b->s;
    *column = s->n_x + b->next_z++;
    *row = s->n_x + b->next_row++;
    s->dual[*row] = *column;
    s->column_is_current[*column] = true;
    s->row_is_current[*row] = false;
    const char *name = b->layout->circuit->device[device].name;
    s->column[*column] = (struct dalcs_label){name, DALCS_LABEL_BRANCH};
    s->row[*row] = (struct dalcs_label){name, DALCS_LABEL_BRANCH};
    b->layout->current_column[device] = *column;
    b->layout->branch_row[device] = *row;
}

int dalcs_stamp_new_state(struct stamps *b, const char *name, bool is_current) {
    struct dalcs_system *s = b->s;
    int x = b->next_x++;
    s->column_is_current[x] = is_current;
    s->row_is_current[x] = !is_current;
    s->column[x] = (struct dalcs_label){name, DALCS_LABEL_STATE};
    s->row[x] = (struct dalcs_label){name, DALCS_LABEL_STATE};
    s->dual[x] = x;
    return x;
}
