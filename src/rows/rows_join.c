/* rows_join.c - values on the right of an event that are those on its left. */
#include "rows.h"

#include "extremes.h"
#include "magnitudes.h"
#include "step_error.h"

#include <math.h>

/* The largest that an output has been, as far as is known without a look at all rows. */
static double size_of(const struct dalcs_rows *rows, const struct dalcs_radau_part *part,
                      const struct dalcs_row_signal *signal) {
    double size = rows->largest[signal->output];
    if (!signal->is_column) {
        return size;
    }
    const struct dalcs_probe_term *term = signal->probe->term;
    double of_column = dalcs_step_scale(part, term->index, part->scales.unit);
    return dalcs_larger(size, fabs(term->coefficient) * of_column);
}

static void join(struct dalcs_rows *rows, const struct dalcs_radau_part *part,
                 const struct dalcs_row_signal *signal, double before) {
    double *now = &rows->value[signal->output].at[0];
    double *largest = &rows->largest[signal->output];
    *largest = dalcs_larger(*largest, dalcs_larger(fabs(before), fabs(*now)));
    /* What does not jump is this close to where it was. */
    double known = dalcs_slight * rows->radau->options.tolerance * size_of(rows, part, signal);
    if (*now != 0.0 && fabs(*now - before) <= known) {
        *now = before;
    }
}

void dalcs_rows_join(struct dalcs_rows *rows, const double *before) {
    for (int k = 0; k < rows->n_asked; k++) {
        const struct dalcs_radau_part *part = &rows->radau->part[rows->asked[k]];
        const struct dalcs_rows_part *p = &rows->part[rows->asked[k]];
        for (int i = 0; i < p->n_signals && part->kind == DALCS_PART_STEPPED; i++) {
            join(rows, part, &p->signal[i], before[p->signal[i].output]);
        }
    }
}
