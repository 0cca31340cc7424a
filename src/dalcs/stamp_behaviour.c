/* stamp_behaviour.c - sources with a formula.
 *
 *     0 = v(a) - v(b) - f   (V=)      0 = i - f   (I=),     f affine in columns, inputs and lambdas
 *     0 <= lambda_k _|_ w_k >= 0, w_k affine in the same
 *
 * The current is an unknown in both. Lambdas are counted as currents and w as voltages, as those of
 * diodes are: for scales, a formula in volts and one in amperes are the same. */
#include "stamp_behaviour.h"

#include "current.h"

#include <math.h>

static bool is_input(const struct dalcs_behaviour *behaviour, int row, int term) {
    const struct dalcs_affine *a = row < 0 ? &behaviour->output : &behaviour->w[row];
    return a->term[term].kind == DALCS_QUANTITY_STIMULUS;
}

int dalcs_behaviour_n_inputs(const struct dalcs_behaviour *behaviour) {
    int n = behaviour->smooth != NULL ? 1 : 0;
    for (int row = -1; row < behaviour->n_pairs; row++) {
        const struct dalcs_affine *a = row < 0 ? &behaviour->output : &behaviour->w[row];
        for (int k = 0; k < a->n; k++) {
            n += is_input(behaviour, row, k) ? 1 : 0;
        }
    }
    return n;
}

/* A voltage that is a function of time alone is a source as any other. A current is an unknown here, and no source's is. */
static bool is_source(const struct dalcs_device *d) {
    const struct dalcs_behaviour *behaviour = d->behaviour;
    bool is = d->kind == DALCS_VCVS && behaviour->n_pairs == 0 && behaviour->smooth == NULL;
    for (int k = 0; is && k < behaviour->output.n; k++) {
        is = is_input(behaviour, -1, k);
    }
    return is;
}

enum dalcs_status dalcs_stamp_behaviour_branch(struct stamps *b, int device) {
    struct dalcs_layout *l = b->layout;
    struct dalcs_system *s = b->s;
    const struct dalcs_device *d = &l->circuit->device[device];
    int column;
    int row;
    s->monotone = s->monotone && is_source(d);
    dalcs_stamp_new_branch(b, device, &column, &row);
    DALCS_TRY(dalcs_stamp_branch_current(b, d, column, 1.0));
    l->pair[device] = b->next_pair;
    const double *rest = d->behaviour->rest;
    for (int k = 0; k < d->behaviour->n_pairs; k++) {
        int pair = b->next_pair++;
        s->pair[pair] =
            (struct dalcs_pair){.kind = DALCS_PAIR_DIODE, .element = d->name, .is_formula = true};
        s->pair[pair].is_jump = rest != NULL && !isnan(rest[k]);
        s->pair[pair].is_left_out[0] = rest != NULL && k > 0 && rest[k - 1] == 0.0;
        s->pair[pair].is_left_out[1] = rest != NULL && rest[k] == 1.0;
        s->column_is_current[s->n_x + s->n_z + pair] = true;
    }
    if (d->kind == DALCS_VCVS) {
        return dalcs_stamp_add_voltage(b, &b->A, row, d->node[0], d->node[1], 1.0);
    }
    s->row_is_current[row] = true;
    return dalcs_stamp_add(&b->A, row, column, 1.0);
}

/* Where one affine function goes: a row of A and E, or of C and F. */
struct target {
    struct dalcs_triplets *columns, *inputs;
    int row;
    int device, reader; /* its device, and the same row in the system's `reads` */
    double factor;
};

static enum dalcs_status stamp_column(struct stamps *b, const struct target *t, int column,
                                      double coefficient) {
    DALCS_TRY(dalcs_stamp_reads(b, t->device, t->reader, column));
    return dalcs_stamp_add(t->columns, t->row, column, coefficient);
}

static enum dalcs_status stamp_current(struct stamps *b, const struct target *t, int device,
                                       double coefficient) {
    struct dalcs_arena arena = {0};
    struct dalcs_current current;
    enum dalcs_status status = dalcs_layout_current(b->layout, b->s, device, &arena, &current);
    for (int k = 0; status == DALCS_OK && k < current.n_terms + current.n_inputs; k++) {
        const struct dalcs_probe_term *term = &current.term[k];
        double value = coefficient * term->coefficient;
        status = k < current.n_terms ? stamp_column(b, t, term->index, value)
                                     : dalcs_stamp_add(t->inputs, t->row, term->index, value);
    }
    dalcs_arena_finish(&arena);
    return status;
}

static enum dalcs_status stamp_affine(struct stamps *b, int device, const struct target *t,
                                      const struct dalcs_affine *a) {
    struct dalcs_layout *l = b->layout;
    struct dalcs_system *s = b->s;
    if (a->constant != 0.0) {
        DALCS_TRY(dalcs_triplets_add(t->inputs, t->row, 0, t->factor * a->constant));
    }
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        double coefficient = t->factor * term->coefficient;
        int input;
        switch (term->kind) {
        case DALCS_QUANTITY_VOLTAGE:
            DALCS_TRY(stamp_column(b, t, dalcs_stamp_node_column(l, term->index), coefficient));
            break;
        case DALCS_QUANTITY_CURRENT:
            DALCS_TRY(stamp_current(b, t, term->index, coefficient));
            break;
        case DALCS_QUANTITY_PAIR:
            DALCS_TRY(
                stamp_column(b, t, s->n_x + s->n_z + l->pair[device] + term->index, coefficient));
            break;
        default:
            input = b->next_input++;
            s->stimulus[input] = term->index;
            l->input[device] = input; /* of a device that is a source only */
            s->input_element[input] = l->circuit->device[device].name;
            DALCS_TRY(dalcs_triplets_add(t->inputs, t->row, input, coefficient));
            break;
        }
    }
    return DALCS_OK;
}

/* 0 = v(a) - v(b) - its input */
static enum dalcs_status stamp_smooth(struct stamps *b, int device) {
    struct dalcs_layout *l = b->layout;
    struct dalcs_system *s = b->s;
    const struct dalcs_smooth *smooth = l->circuit->device[device].behaviour->smooth;
    const int input = b->next_input++;
    const char *name = l->circuit->device[device].name;
    l->input[device] = input;
    s->stimulus[input] = l->circuit->control.smooth_stimulus;
    s->input_element[input] = name;
    struct dalcs_smooth_input *of = &s->smooth[s->n_smooth++];
    *of = (struct dalcs_smooth_input){.input = input,
                                      .row = l->branch_row[device],
                                      .kind = smooth->kind,
                                      .n = smooth->n,
                                      .starts_on_line = smooth->is_of_storage,
                                      .start = {smooth->start[0], smooth->start[1]},
                                      .element = name};
    for (int k = 0; k < smooth->n; k++) {
        of->column[k] = smooth->node[k] > 0 ? dalcs_stamp_node_column(l, smooth->node[k]) : -1;
        of->number[k] = smooth->number[k];
        of->row_of[k] = smooth->source[k] >= 0 ? l->branch_row[smooth->source[k]] : -1;
        if (of->column[k] >= 0) { /* any value but 0 holds the place */
            DALCS_TRY(dalcs_stamp_reads(b, device, of->row, of->column[k]));
            DALCS_TRY(dalcs_triplets_add(&b->A, of->row, of->column[k], 1.0));
        }
    }
    return dalcs_triplets_add(&b->E, l->branch_row[device], input, -1.0);
}

enum dalcs_status dalcs_stamp_behaviour(struct stamps *b, int device) {
    const struct dalcs_behaviour *behaviour = b->layout->circuit->device[device].behaviour;
    int row = b->layout->branch_row[device];
    if (behaviour->is_part) {
        const int node = b->layout->circuit->device[device].node[0];
        b->s->is_part[dalcs_stamp_node_column(b->layout, node)] = true;
    }
    if (behaviour->smooth != NULL) {
        return stamp_smooth(b, device);
    }
    struct target t = {&b->A, &b->E, row, device, row, -1.0};
    DALCS_TRY(stamp_affine(b, device, &t, &behaviour->output));
    for (int k = 0; k < behaviour->n_pairs; k++) {
        int pair = b->layout->pair[device] + k;
        t = (struct target){&b->C, &b->F, pair, device, dalcs_system_n_equations(b->s) + pair, 1.0};
        DALCS_TRY(stamp_affine(b, device, &t, &behaviour->w[k]));
    }
    return DALCS_OK;
}
