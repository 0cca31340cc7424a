/* cones.c - from a described system to the one that the engine runs, whose multipliers are pairs.
 *
 * A free multiplier is an unknown and its w = 0 an equation. So is one in a box [low, high], with two pairs:
 *     w = up - down,      0 <= up _|_ lambda - low >= 0,      0 <= down _|_ high - lambda >= 0,
 * as two antiparallel diodes with thresholds carry a current. Their coupling is skew: where the multiplier
 * was monotone, all are. A box with one bound is one pair.
 *
 * The engine takes w to be made of columns, of which it knows how far they are to be trusted. An input that
 * varies in time and enters w becomes one: as a voltage source does in a circuit, with
 *     0 = i + F' lambda,      0 = s(t) - u,      w = ... + F u.
 * So does each input that commands a switch together with columns. */
#include "cone_assembly.h"

#include <math.h>
#include <stdlib.h>

bool dalcs_multiplier_is_unknown(const struct dalcs_multiplier *m) {
    return m->cone == DALCS_CONE_FREE ||
           (m->cone == DALCS_CONE_BOX && isfinite(m->low) && isfinite(m->high));
}

static void lift(struct dalcs_assembly *a, int input, int *next) {
    if (a->lifted[input] < 0) {
        a->lifted[input] = *next;
        *next += 2;
        a->s->n_z += 2;
        a->n_lifted++;
    }
}

/* Is this switch commanded by columns, its inputs being a part of the sum? */
static bool follows_columns(const struct dalcs_multiplier *m) {
    return m->pair.kind == DALCS_PAIR_SWITCH && !m->pair.is_direct;
}

static void count_columns(const struct dalcs_reading *r, struct dalcs_assembly *a) {
    const struct dalcs_described_system *from = a->from;
    struct dalcs_system *s = a->s;
    s->n_x = (int)from->n_states;
    s->n_z = (int)from->n_unknowns;
    s->n_inputs = (int)from->n_inputs + 1;
    for (size_t j = 0; j < from->n_multipliers; j++) {
        s->n_z += dalcs_multiplier_is_unknown(&from->multiplier[j]) ? 1 : 0;
    }
    int next_z = s->n_x + (int)from->n_unknowns;
    int next_lifted = s->n_x + s->n_z;
    for (size_t k = 0; k < from->n_inputs; k++) {
        a->lifted[k] = -1;
    }
    const struct dalcs_triplets *F = &from->block[DALCS_BLOCK_F].entries;
    for (size_t k = 0; k < F->n; k++) {
        const struct dalcs_triplet *e = &F->entry[k];
        bool varies = r->input[from->input[e->column]].kind != DALCS_STIMULUS_DC;
        bool is_free = dalcs_multiplier_is_unknown(&from->multiplier[e->row]);
        if (varies && !is_free && e->value != 0.0) {
            lift(a, e->column, &next_lifted);
        }
    }
    const struct dalcs_triplets *direct = &from->block[DALCS_BLOCK_DIRECT_CONTROL].entries;
    for (size_t k = 0; k < direct->n; k++) {
        if (follows_columns(&from->multiplier[direct->entry[k].row])) {
            lift(a, direct->entry[k].column, &next_lifted);
        }
    }
    for (size_t j = 0; j < from->n_multipliers; j++) {
        const struct dalcs_multiplier *m = &from->multiplier[j];
        struct dalcs_multiplier_place *p = &a->place[j];
        *p = (struct dalcs_multiplier_place){.sign = 1.0, .bound = -1};
        if (dalcs_multiplier_is_unknown(m)) {
            p->is_free = true;
            p->column = p->row = next_z++;
            p->sign = -1.0; /* of the row: 0 = -w, dual to lambda */
            p->bound = m->cone == DALCS_CONE_BOX ? s->n_pairs : -1;
            s->n_pairs += m->cone == DALCS_CONE_BOX ? 2 : 0;
            continue;
        }
        if (m->cone == DALCS_CONE_BOX) {
            p->sign = isfinite(m->low) ? 1.0 : -1.0;
            p->offset = isfinite(m->low) ? m->low : m->high;
        }
        p->row = s->n_pairs++;
        p->column = dalcs_system_n_equations(s) + p->row;
    }
}

/* ---- Entries ------------------------------------------------------------------------------- */

/* The blocks of one kind of rows: of x, z, multipliers, inputs and the constant. */
struct row_blocks {
    enum dalcs_block_name x, z, multipliers, inputs, constant;
};

static const struct row_blocks ROWS_I = {DALCS_BLOCK_A_I, DALCS_BLOCK_B_I, DALCS_BLOCK_BBAR_I,
                                         DALCS_BLOCK_E_I, DALCS_BLOCK_CONSTANT_I};
static const struct row_blocks ROWS_II = {DALCS_BLOCK_A_II, DALCS_BLOCK_B_II, DALCS_BLOCK_BBAR_II,
                                          DALCS_BLOCK_E_II, DALCS_BLOCK_CONSTANT_II};
static const struct row_blocks ROWS_W = {DALCS_BLOCK_C_I, DALCS_BLOCK_C_II, DALCS_BLOCK_D,
                                         DALCS_BLOCK_F, DALCS_BLOCK_CONSTANT_F};

/* The place of row i of these blocks. */
struct target {
    struct dalcs_triplets *columns, *inputs;
    int row;
    double factor;
};

static struct target target_of(struct dalcs_assembly *a, const struct row_blocks *blocks, int i) {
    if (blocks == &ROWS_I) {
        return (struct target){&a->A, &a->E, i, 1.0};
    }
    if (blocks == &ROWS_II) {
        return (struct target){&a->A, &a->E, a->s->n_x + i, 1.0};
    }
    const struct dalcs_multiplier_place *p = &a->place[i];
    return (struct target){p->is_free ? &a->A : &a->C, p->is_free ? &a->E : &a->F, p->row, p->sign};
}

static enum dalcs_status add_rows(struct dalcs_assembly *a, const struct row_blocks *blocks) {
    const enum dalcs_block_name name[] = {blocks->x, blocks->z, blocks->multipliers, blocks->inputs,
                                          blocks->constant};

    for (int b = 0; b < 5; b++) {
        const struct dalcs_triplets *t = &a->from->block[name[b]].entries;
        for (size_t k = 0; k < t->n; k++) {
            const struct dalcs_triplet *e = &t->entry[k];
            const struct target to = target_of(a, blocks, e->row);
            double value = to.factor * e->value;
            if (b < 2) {
                int column = b == 0 ? e->column : a->s->n_x + e->column;
                DALCS_TRY(dalcs_triplets_add(to.columns, to.row, column, value));
            } else if (b == 3 && to.inputs == &a->F && a->lifted[e->column] >= 0) {
                int u = a->lifted[e->column];
                DALCS_TRY(dalcs_triplets_add(&a->C, to.row, u, value));
                DALCS_TRY(dalcs_triplets_add(&a->A, u, a->place[e->row].column, value));
            } else if (b > 2) {
                int input = b == 3 ? e->column + 1 : 0;
                DALCS_TRY(dalcs_triplets_add(to.inputs, to.row, input, value));
            } else {
                const struct dalcs_multiplier_place *p = &a->place[e->column];
                double sign = p->is_free ? 1.0 : p->sign;
                DALCS_TRY(dalcs_triplets_add(to.columns, to.row, p->column, sign * value));
                if (p->offset != 0.0) {
                    DALCS_TRY(dalcs_triplets_add(to.inputs, to.row, 0, p->offset * value));
                }
            }
        }
    }
    return DALCS_OK;
}

static enum dalcs_status add_lifted(struct dalcs_assembly *a) {
    for (size_t k = 0; k < a->from->n_inputs; k++) {
        int u = a->lifted[k];
        if (u >= 0) {
            DALCS_TRY(dalcs_triplets_add(&a->A, u, u + 1, 1.0));
            DALCS_TRY(dalcs_triplets_add(&a->A, u + 1, u, -1.0));
            DALCS_TRY(dalcs_triplets_add(&a->E, u + 1, (int)k + 1, 1.0));
        }
    }
    return DALCS_OK;
}

static enum dalcs_status add_boxes(struct dalcs_assembly *a) {
    for (size_t j = 0; j < a->from->n_multipliers; j++) {
        const struct dalcs_multiplier_place *p = &a->place[j];
        const struct dalcs_multiplier *m = &a->from->multiplier[j];
        if (p->bound >= 0) {
            int up = dalcs_system_n_equations(a->s) + p->bound;
            DALCS_TRY(dalcs_triplets_add(&a->A, p->row, up, 1.0));
            DALCS_TRY(dalcs_triplets_add(&a->A, p->row, up + 1, -1.0));
            DALCS_TRY(dalcs_triplets_add(&a->C, p->bound, p->column, 1.0));
            DALCS_TRY(dalcs_triplets_add(&a->F, p->bound, 0, -m->low));
            DALCS_TRY(dalcs_triplets_add(&a->C, p->bound + 1, p->column, -1.0));
            DALCS_TRY(dalcs_triplets_add(&a->F, p->bound + 1, 0, m->high));
        }
    }
    return DALCS_OK;
}

/* What commands the switches; a constant part of it moves their thresholds. */
static enum dalcs_status add_controls(struct dalcs_assembly *a) {
    const struct dalcs_triplets *t = &a->from->block[DALCS_BLOCK_CONTROL].entries;
    int n_equations = a->s->n_x + (int)a->from->n_unknowns;
    for (size_t k = 0; k < t->n; k++) {
        const struct dalcs_triplet *e = &t->entry[k];
        const struct dalcs_multiplier_place *row = &a->place[e->row];
        if (a->from->multiplier[e->row].pair.kind != DALCS_PAIR_SWITCH) {
            continue;
        }
        if (e->column < n_equations) {
            DALCS_TRY(dalcs_triplets_add(&a->control, row->row, e->column, e->value));
        } else {
            const struct dalcs_multiplier_place *p = &a->place[e->column - n_equations];
            double sign = p->is_free ? 1.0 : p->sign;
            DALCS_TRY(dalcs_triplets_add(&a->control, row->row, p->column, sign * e->value));
            a->s->pair[row->row].turn_on -= p->offset * e->value;
            a->s->pair[row->row].turn_off -= p->offset * e->value;
        }
    }
    t = &a->from->block[DALCS_BLOCK_DIRECT_CONTROL].entries;
    for (size_t k = 0; k < t->n; k++) {
        const struct dalcs_triplet *e = &t->entry[k];
        int row = a->place[e->row].row;
        if (a->from->multiplier[e->row].pair.kind != DALCS_PAIR_SWITCH) {
            continue;
        }
        DALCS_TRY(follows_columns(&a->from->multiplier[e->row])
                      ? dalcs_triplets_add(&a->control, row, a->lifted[e->column], e->value)
                      : dalcs_triplets_add(&a->direct_control, row, e->column + 1, e->value));
    }
    return DALCS_OK;
}

static enum dalcs_status copy_entries(struct dalcs_triplets *to,
                                      const struct dalcs_triplets *from) {
    for (size_t k = 0; k < from->n; k++) {
        DALCS_TRY(dalcs_triplets_add(to, from->entry[k].row, from->entry[k].column,
                                     from->entry[k].value));
    }
    return DALCS_OK;
}

/* P, the identity where it is not given; the storage, P where it is symmetric, else the identity. */
static enum dalcs_status add_states(struct dalcs_assembly *a) {
    const struct dalcs_block *block = a->from->block;
    bool has_P = block[DALCS_BLOCK_P].card != NULL || a->from->n_coordinates > 0;
    bool has_storage = block[DALCS_BLOCK_STORAGE].card != NULL || a->from->n_coordinates > 0;
    DALCS_TRY(copy_entries(&a->P, &block[DALCS_BLOCK_P].entries));
    DALCS_TRY(copy_entries(&a->storage, &block[DALCS_BLOCK_STORAGE].entries));
    for (int x = 0; x < a->s->n_x && !has_P; x++) {
        DALCS_TRY(dalcs_triplets_add(&a->P, x, x, 1.0));
    }
    if (has_storage) {
        return DALCS_OK;
    }
    bool symmetric = true;
    for (size_t k = 0; k < a->P.n && symmetric; k++) {
        bool found = a->P.entry[k].row == a->P.entry[k].column;
        for (size_t i = 0; i < a->P.n && !found; i++) {
            found = a->P.entry[i].row == a->P.entry[k].column &&
                    a->P.entry[i].column == a->P.entry[k].row &&
                    a->P.entry[i].value == a->P.entry[k].value;
        }
        symmetric = found;
    }
    if (symmetric) {
        return copy_entries(&a->storage, &a->P);
    }
    for (int x = 0; x < a->s->n_x; x++) {
        DALCS_TRY(dalcs_triplets_add(&a->storage, x, x, 1.0));
    }
    return DALCS_OK;
}

/* ---- Labels -------------------------------------------------------------------------------- */

static enum dalcs_status allocate(struct dalcs_system *s) {
    size_t n_equations = (size_t)dalcs_system_n_equations(s);
    size_t n_pairs = (size_t)s->n_pairs;
    size_t n_inputs = (size_t)s->n_inputs;
    s->dual = dalcs_alloc(n_equations, sizeof *s->dual);
    s->forest_root = dalcs_alloc(n_equations, sizeof *s->forest_root);
    s->column_is_current = dalcs_alloc(n_equations + n_pairs, sizeof *s->column_is_current);
    s->row_is_current = dalcs_alloc(n_equations, sizeof *s->row_is_current);
    s->row = dalcs_alloc(n_equations, sizeof *s->row);
    s->column = dalcs_alloc(n_equations, sizeof *s->column);
    s->pair = dalcs_alloc(n_pairs, sizeof *s->pair);
    s->stimulus = dalcs_alloc(n_inputs, sizeof *s->stimulus);
    s->input_element = dalcs_alloc(n_inputs, sizeof *s->input_element);
    bool complete = s->dual != NULL && s->forest_root != NULL && s->column_is_current != NULL &&
                    s->row_is_current != NULL && s->row != NULL && s->column != NULL &&
                    s->pair != NULL && s->stimulus != NULL && s->input_element != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

static enum dalcs_status compress(struct dalcs_assembly *a) {
    struct dalcs_system *s = a->s;
    int n_equations = dalcs_system_n_equations(s);
    int n_columns = dalcs_system_n_columns(s);
    DALCS_TRY(dalcs_csr_compress(&s->P, s->n_x, s->n_x, &a->P));
    DALCS_TRY(dalcs_csr_compress(&s->A, n_equations, n_columns, &a->A));
    DALCS_TRY(dalcs_system_find_rest(s, &a->A));
    DALCS_TRY(dalcs_csr_compress(&s->E, n_equations, s->n_inputs, &a->E));
    DALCS_TRY(dalcs_csr_compress(&s->C, s->n_pairs, n_columns, &a->C));
    DALCS_TRY(dalcs_csr_compress(&s->F, s->n_pairs, s->n_inputs, &a->F));
    DALCS_TRY(dalcs_csr_compress(&s->storage, s->n_x, s->n_x, &a->storage));
    DALCS_TRY(dalcs_csr_compress(&s->control, s->n_pairs, n_columns, &a->control));
    return dalcs_csr_compress(&s->direct_control, s->n_pairs, s->n_inputs, &a->direct_control);
}

static enum dalcs_status build(struct dalcs_reading *r, struct dalcs_assembly *a) {
    count_columns(r, a);
    DALCS_TRY(allocate(a->s));
    dalcs_label_inputs(r, a);
    for (int x = 0; x < a->s->n_x; x++) {
        dalcs_label_column(a->s, x, &a->from->state[x]);
    }
    for (int z = 0; z < (int)a->from->n_unknowns; z++) {
        dalcs_label_column(a->s, a->s->n_x + z, &a->from->unknown[z]);
    }
    dalcs_label_pairs(a);
    DALCS_TRY(dalcs_label_lifted(r, a));
    dalcs_label_rows(a);
    DALCS_TRY(add_states(a));
    DALCS_TRY(add_rows(a, &ROWS_I));
    DALCS_TRY(add_rows(a, &ROWS_II));
    DALCS_TRY(add_rows(a, &ROWS_W));
    DALCS_TRY(add_boxes(a));
    DALCS_TRY(add_lifted(a));
    DALCS_TRY(add_controls(a));
    DALCS_TRY(compress(a));
    if (!dalcs_labels_fit(r, a) || !dalcs_storage_is_regular(r, a)) {
        return r->builder.out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
    }
    DALCS_TRY(dalcs_scale_by_storage(a));
    if (!dalcs_storage_is_regular(r, a)) {
        return r->builder.out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
    }
    return dalcs_system_prove_monotone(a->s, a->from->monotone);
}

enum dalcs_status dalcs_system_of_description(struct dalcs_reading *r,
                                              struct dalcs_described_system *from,
                                              struct dalcs_system *system, double **initial) {
    *system = (struct dalcs_system){0};
    struct dalcs_assembly a = {.from = from, .s = system};
    enum dalcs_status status = DALCS_E_NOMEM;
    a.place = dalcs_alloc(from->n_multipliers, sizeof *a.place);
    a.lifted = dalcs_alloc(from->n_inputs, sizeof *a.lifted);
    *initial = dalcs_alloc(from->n_states, sizeof **initial);
    if (a.place != NULL && a.lifted != NULL && *initial != NULL) {
        for (size_t x = 0; x < from->n_states; x++) {
            (*initial)[x] = from->state[x].initial;
        }
        status = build(r, &a);
    }
    struct dalcs_triplets *all[] = {&a.P, &a.A,       &a.E,       &a.C,
                                    &a.F, &a.storage, &a.control, &a.direct_control};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
        dalcs_triplets_finish(all[k]);
    }
    free(a.place);
    free(a.lifted);
    if (status != DALCS_OK) {
        dalcs_system_finish(system);
        free(*initial);
        *initial = NULL;
    }
    return status;
}
