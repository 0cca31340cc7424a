/* smooth_inner.c - which functions only functions read, and by how much. */
#include "smooth_inner.h"

#include "memory.h"

#include <stdlib.h>
#include <string.h>

static double entry_of(const struct dalcs_csr *a, int row, int column) {
    double sum = 0.0;
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        sum += a->j[k] == column ? a->x[k] : 0.0;
    }
    return sum;
}

/* The column that a function puts out: the one in its equation that it does not read; -1: there are several. */
static int own_column(const struct dalcs_system *s, const struct dalcs_smooth_input *of) {
    int own = -1;
    int n = 0;
    for (int k = s->A.p[of->row]; k < s->A.p[of->row + 1]; k++) {
        const int column = s->A.j[k];
        const bool is_read = column == of->column[0] || (of->n > 1 && column == of->column[1]);
        own = is_read ? own : column;
        n += is_read ? 0 : 1;
    }
    return n == 1 ? own : -1;
}

/* What the rows of a matrix read is no function's alone, but where row_is_ours says that the row is a function's or its
 * argument's. */
static void drop_read(int *column_of, const struct dalcs_csr *a, int n_rows,
                      const bool *row_is_ours) {
    for (int row = 0; row < n_rows && a->p != NULL; row++) {
        for (int k = a->p[row]; k < a->p[row + 1] && !(row_is_ours != NULL && row_is_ours[row]);
             k++) {
            column_of[a->j[k]] = -1;
        }
    }
}

/* The link from function k to argument j of a later one; false: there is none. */
static bool find_link(const struct dalcs_system *s, int k, int column, int of, int j,
                      struct dalcs_smooth_link *link) {
    const struct dalcs_smooth_input *reader = &s->smooth[of];
    double factor = 0.0;
    if (j < reader->n && reader->column[j] == column) {
        factor = 1.0;
    } else if (j < reader->n && reader->column[j] >= 0 && reader->row_of[j] >= 0) {
        const double own = entry_of(&s->A, reader->row_of[j], reader->column[j]);
        factor = own != 0.0 ? -entry_of(&s->A, reader->row_of[j], column) / own : 0.0;
    }
    *link = (struct dalcs_smooth_link){k, of, j, factor};
    return factor != 0.0;
}

/* The links of all, or their number where inner->link is NULL. A function that one before it reads is none of these. */
static int list_links(struct dalcs_smooth_inner *inner, const struct dalcs_system *s) {
    int n = 0;
    for (int q = 0; q < 2 * s->n_smooth * s->n_smooth; q++) {
        const int k = q / 2 / s->n_smooth;
        const int of = q / 2 % s->n_smooth;
        struct dalcs_smooth_link link;
        if (inner->column[k] >= 0 && find_link(s, k, inner->column[k], of, q % 2, &link)) {
            inner->column[k] = of > k ? inner->column[k] : -1;
            if (inner->link != NULL) {
                inner->link[n] = link;
            }
            n++;
        }
    }
    return n;
}

static bool find_columns(struct dalcs_smooth_inner *inner, const struct dalcs_system *s) {
    const int n_columns = dalcs_system_n_columns(s);
    int *function = dalcs_alloc((size_t)n_columns, sizeof *function);
    bool *is_ours = dalcs_alloc((size_t)dalcs_system_n_equations(s), sizeof *is_ours);
    const bool complete = function != NULL && is_ours != NULL;
    for (int c = 0; c < n_columns && complete; c++) {
        function[c] = -1;
    }
    for (int k = 0; k < s->n_smooth && complete; k++) {
        const int own = own_column(s, &s->smooth[k]);
        inner->column[k] = own;
        function[own >= 0 ? own : 0] = own >= 0 ? k : function[0];
        is_ours[s->smooth[k].row] = true;
        for (int j = 0; j < s->smooth[k].n; j++) {
            is_ours[s->smooth[k].row_of[j] >= 0 ? s->smooth[k].row_of[j] : s->smooth[k].row] = true;
        }
    }
    if (complete) {
        drop_read(function, &s->A, dalcs_system_n_equations(s), is_ours);
        drop_read(function, &s->C, s->n_pairs, NULL);
        drop_read(function, &s->control, s->n_pairs, NULL);
    }
    for (int k = 0; k < s->n_smooth && complete; k++) {
        const int own = inner->column[k];
        inner->column[k] = own >= 0 && function[own] == k ? own : -1;
    }
    free(function);
    free(is_ours);
    return complete;
}

enum dalcs_status dalcs_smooth_inner_setup(struct dalcs_smooth_inner *inner,
                                           const struct dalcs_system *system, int n,
                                           struct dalcs_arena *arena) {
    inner->column = dalcs_arena_alloc(arena, (size_t)system->n_smooth, sizeof(int));
    if (inner->column == NULL || !find_columns(inner, system)) {
        return DALCS_E_NOMEM;
    }
    (void)list_links(inner, system); /* drops those that one before reads */
    inner->n_links = list_links(inner, system);
    inner->link = dalcs_arena_alloc(arena, (size_t)inner->n_links + 1, sizeof(*inner->link));
    inner->next = dalcs_arena_alloc(arena, (size_t)n, sizeof(double));
    if (inner->link == NULL || inner->next == NULL) {
        return DALCS_E_NOMEM;
    }
    (void)list_links(inner, system);
    return DALCS_OK;
}
