/* rows_join.c - values on the right of an event that are those on its left. */
#include "rows.h"

#include "extremes.h"
#include "magnitudes.h"
#include "step_error.h"

#include <math.h>

/* Of a pair: what a step that recurs leaves in scales.magnitude may be the voltage of one in which it was open. */
static double size_of_pair(const struct dalcs_radau_part *part, int column) {
    const struct dalcs_collocation *m = part->stages.method;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const int pair = column - dalcs_system_n_equations(part->component->system);
    double size = dalcs_larger(dalcs_slight * part->scales.unit[1], part->scales.column[column]);
    for (int k = 0; k <= m->s && m->node[k] <= part->segment.end; k++) {
        size = dalcs_larger(size, fabs(part->segment.out[k * l->stride + column]));
    }
    return dalcs_osnsp_is_on(&part->component->osnsp, pair) ? size : 0.0;
}

/* The largest that an output has been, as far as is known without a look at all rows. */
static double size_of(const struct dalcs_rows *rows, const struct dalcs_radau_part *part,
                      const struct dalcs_row_signal *signal) {
    double size = rows->largest[signal->output];
    if (!signal->is_column) {
        return size;
    }
    const struct dalcs_probe_term *term = signal->probe->term;
    const bool is_pair = term->index >= dalcs_system_n_equations(part->component->system);
    double of_column = is_pair ? size_of_pair(part, term->index)
                               : dalcs_step_scale(part, term->index, part->scales.unit);
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
