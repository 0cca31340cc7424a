/* partition.c - strongly connected parts of a system, and which of them are monotone. */
#include "partition.h"

#include <math.h>

/* Tarjan's search without recursion: a line of a thousand sections is a path as deep. */
struct search {
    const struct dalcs_system *s;
    int *row_of;       /* [n_columns] the row that a column is paired with; equations, then pairs */
    int n_seen;        /* columns numbered so far */
    int *number, *low; /* [n_columns] 0: not seen; the lowest number that can be reached */
    int *stack, n_stack; /* [n_columns] columns whose part is not known yet */
    int *path, *next,
        depth; /* [n_columns] the way to where the search stands, and its next entries */
    int n_parts;
    int *part_of; /* [n_columns] -1: not known yet */
    int *order;   /* [n_columns] part by part */
    int n_ordered;
};

/* The entries of A and P, or of C, that a column's row holds; number k of them, -1 behind the last. */
static int entry_of(const struct search *t, int column, int k) {
    const struct dalcs_system *s = t->s;
    int row = t->row_of[column];
    int n_equations = dalcs_system_n_equations(s);
    const struct dalcs_csr *a = row < n_equations ? &s->A : &s->C;
    int i = row < n_equations ? row : row - n_equations;
    int length = a->p[i + 1] - a->p[i];
    if (k < length) {
        return a->j[a->p[i] + k];
    }
    k -= length;
    bool has_rate = row < s->n_x && k < s->P.p[row + 1] - s->P.p[row];
    return has_rate ? s->P.j[s->P.p[row] + k] : -1;
}

static void enter(struct search *t, int column) {
    t->number[column] = t->low[column] = ++t->n_seen;
    t->stack[t->n_stack++] = column;
    t->path[t->depth] = column;
    t->next[t->depth++] = 0;
}

/* Nothing else can be reached from the end of the path. */
static void leave(struct search *t) {
    int column = t->path[--t->depth];
    if (t->low[column] == t->number[column]) {
        int last;
        do {
            last = t->stack[--t->n_stack];
            t->part_of[last] = t->n_parts;
            t->order[t->n_ordered++] = last;
        } while (last != column);
        t->n_parts++;
    }
    if (t->depth > 0) {
        int above = t->path[t->depth - 1];
        t->low[above] = t->low[column] < t->low[above] ? t->low[column] : t->low[above];
    }
}

static void search_from(struct search *t, int start) {
    enter(t, start);
    while (t->depth > 0) {
        int column = t->path[t->depth - 1];
        int to = entry_of(t, column, t->next[t->depth - 1]++);
        if (to < 0) {
            leave(t);
        } else if (t->number[to] == 0) {
            enter(t, to);
        } else if (t->part_of[to] < 0 && t->number[to] < t->low[column]) {
            t->low[column] = t->number[to];
        }
    }
}

static enum dalcs_status find_parts(struct search *t, struct dalcs_arena *work) {
    const struct dalcs_system *s = t->s;
    size_t n = (size_t)dalcs_system_n_columns(s);
    int n_equations = dalcs_system_n_equations(s);
    int **list[] = {&t->row_of, &t->number, &t->low,     &t->stack,
                    &t->path,   &t->next,   &t->part_of, &t->order};
    for (size_t k = 0; k < sizeof(list) / sizeof(*list); k++) {
        *list[k] = dalcs_arena_alloc(work, n, sizeof(int));
        if (*list[k] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    for (int r = 0; r < n_equations; r++) {
        t->row_of[s->dual[r]] = r;
    }
    for (int c = 0; c < (int)n; c++) {
        t->row_of[c] = c < n_equations ? t->row_of[c] : c;
        t->part_of[c] = -1;
    }
    for (int c = 0; c < (int)n; c++) {
        if (t->number[c] == 0) {
            search_from(t, c);
        }
    }
    return DALCS_OK;
}

/* What of one part is looked at. */
struct part {
    int n_equations;
    int last_read;     /* the last part that it reads, -1: none */
    bool reads_itself; /* something in it reads something in it */
    bool is_driven;    /* a row of it reads, or holds a column of such a part */
    bool has_state;
    bool is_dominant; /* of pairs alone: they dominate the symmetric part of D */
    int block;
};

static void look_at_column(const struct search *t, int column, struct part *part) {
    const struct dalcs_system *s = t->s;
    int n_equations = dalcs_system_n_equations(s);
    int number = t->part_of[column];
    struct part *of = &part[number];
    int row = t->row_of[column];
    bool is_pair = column >= n_equations;
    of->n_equations += is_pair ? 0 : 1;
    of->has_state = of->has_state || column < s->n_x;
    for (int k = s->reads.p[row]; k < s->reads.p[row + 1]; k++) {
        int read = t->part_of[s->reads.j[k]];
        of->is_driven = true;
        of->reads_itself = of->reads_itself || read == number;
        of->last_read = read != number && read > of->last_read ? read : of->last_read;
    }
    int held;
    for (int k = 0; (held = entry_of(t, column, k)) >= 0; k++) {
        of->is_driven = of->is_driven || part[t->part_of[held]].is_driven;
    }
}

static double coefficient_of(const struct dalcs_csr *a, int row, int column) {
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        if (a->j[k] == column) {
            return a->x[k];
        }
    }
    return 0.0;
}

/* Which parts have (D + D')/2 with diagonals no less than the sum of what else is in their rows: such a matrix is
 * positive semidefinite (Gershgorin). The kinks and steps of min, max, limit and u() are. margin[n_pairs] is 0. */
static void find_dominant(const struct search *t, double *margin, struct part *part) {
    const struct dalcs_system *s = t->s;
    int n_equations = dalcs_system_n_equations(s);
    for (int d = 0; d < s->n_pairs; d++) {
        for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
            int other = s->C.j[k] - n_equations;
            if (other == d) {
                margin[d] += s->C.x[k];
            } else if (other >= 0 &&
                       t->part_of[n_equations + other] == t->part_of[n_equations + d]) {
                double back = coefficient_of(&s->C, other, n_equations + d);
                double half = 0.5 * fabs(s->C.x[k] + back);
                margin[d] -= half;
                margin[other] -= back == 0.0 ? half : 0.0;
            }
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        struct part *of = &part[t->part_of[n_equations + d]];
        of->is_dominant = of->is_dominant && margin[d] >= 0.0;
    }
}

/* What is left of a circuit without its readers is passive; so are formulas of their own that dominate. */
static bool is_monotone(const struct part *part) {
    return !part->reads_itself || (part->n_equations == 0 && part->is_dominant);
}

/* Parts that follow each other are one block where none of them reads what is in the block. */
static void join_parts(struct dalcs_partition *p, int n_parts, struct part *part) {
    int first = 0;
    for (int k = 0; k < n_parts; k++) {
        bool begins = k == 0 || part[k].reads_itself || part[k - 1].reads_itself ||
                      part[k].last_read >= first;
        if (begins) {
            first = k;
            p->is_monotone[p->n_blocks++] = is_monotone(&part[k]);
        }
        part[k].block = p->n_blocks - 1;
        p->all_monotone = p->all_monotone && p->is_monotone[part[k].block];
        p->jumps_as_usual = p->jumps_as_usual && !(part[k].is_driven && part[k].has_state);
    }
}

static enum dalcs_status partition(struct dalcs_partition *p, struct search *t,
                                   struct dalcs_arena *work) {
    const struct dalcs_system *s = t->s;
    int n_columns = dalcs_system_n_columns(s);
    DALCS_TRY(find_parts(t, work));
    struct part *part = dalcs_arena_alloc(work, (size_t)t->n_parts, sizeof(*part));
    p->block_of = dalcs_arena_alloc(&p->arena, (size_t)n_columns, sizeof(*p->block_of));
    p->is_monotone = dalcs_arena_alloc(&p->arena, (size_t)t->n_parts, sizeof(bool));
    p->is_driven = dalcs_arena_alloc(&p->arena, (size_t)n_columns, sizeof(bool));
    double *margin = dalcs_arena_alloc(work, (size_t)s->n_pairs, sizeof(*margin));
    if (part == NULL || margin == NULL || p->block_of == NULL || p->is_monotone == NULL ||
        p->is_driven == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < t->n_parts; k++) {
        part[k] = (struct part){.last_read = -1, .is_dominant = true};
    }
    for (int k = 0; k < n_columns; k++) {
        look_at_column(t, t->order[k], part);
    }
    find_dominant(t, margin, part);
    join_parts(p, t->n_parts, part);
    for (int c = 0; c < n_columns; c++) {
        p->block_of[c] = part[t->part_of[c]].block;
        p->is_driven[c] = part[t->part_of[c]].is_driven;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_partition_find(struct dalcs_partition *p, const struct dalcs_system *s) {
    *p = (struct dalcs_partition){.all_monotone = true, .jumps_as_usual = true};
    if (s->monotone || s->reads.p == NULL || dalcs_system_n_columns(s) == 0) {
        p->n_blocks = 1;
        p->all_monotone = p->jumps_as_usual = s->monotone;
        return DALCS_OK;
    }
    struct dalcs_arena work = {0};
    struct search t = {.s = s};
    enum dalcs_status status = partition(p, &t, &work);
    dalcs_arena_finish(&work);
    if (status != DALCS_OK) {
        dalcs_partition_finish(p);
    }
    return status;
}

void dalcs_partition_keep_first(const int *block_of, const struct dalcs_system *s,
                                enum dalcs_pair_kind kind, double *value) {
    const int *of = block_of != NULL ? block_of + dalcs_system_n_equations(s) : NULL;
    int first = -1;
    for (int d = 0; of != NULL && d < s->n_pairs; d++) {
        bool is_first = value[d] != 0.0 && (first < 0 || of[d] < first);
        first = is_first ? of[d] : first;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        bool counts = s->pair[d].kind == kind && (of == NULL || of[d] == first);
        value[d] = counts ? value[d] : 0.0;
    }
}

void dalcs_partition_finish(struct dalcs_partition *p) {
    dalcs_arena_finish(&p->arena);
    *p = (struct dalcs_partition){0};
}
