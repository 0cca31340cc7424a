/* gate_instants.c - how late instants of gates are, and what that makes of outputs. */
#include "gate_variation.h"

#include "magnitudes.h"

#include <math.h>
#include <string.h>

/* Of what has a number, into row: 0 of what is not late. */
static void find_late(const struct dalcs_gate_variation *g, long number, double *row) {
    memset(row, 0, (size_t)g->n_columns * sizeof(double));
    if (number < 0) {
        row[g->n_x - 1 - number] = 1.0;
    } else if ((size_t)number < g->capacity && g->late[number] != NULL) {
        memcpy(row, g->late[number], (size_t)g->n_columns * sizeof(double));
    }
}

static enum dalcs_status keep_late(struct dalcs_gate_variation *g, long number, const double *row) {
    const size_t n = (size_t)g->n_columns;
    bool any = false;
    for (size_t c = 0; c < n; c++) {
        any = any || row[c] != 0.0;
    }
    if (!any) {
        return DALCS_OK;
    }
    if ((size_t)number >= g->capacity) {
        const size_t more = 2 * (size_t)number + 16;
        double **late = dalcs_arena_alloc(g->arena, more, sizeof *late);
        if (late == NULL) {
            return DALCS_E_NOMEM;
        }
        if (g->capacity > 0) {
            memcpy(late, g->late, g->capacity * sizeof *late);
        }
        g->late = late;
        g->capacity = more;
    }
    g->late[number] = dalcs_arena_alloc(g->arena, n, sizeof(double));
    if (g->late[number] == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(g->late[number], row, n * sizeof(double));
    return DALCS_OK;
}

/* Two that bring about one instant: are they late by the same? */
static bool differ(const struct dalcs_gate_variation *g, const double *a, const double *b) {
    double off = 0.0;
    double size = 0.0;
    for (int c = 0; c < g->n_columns; c++) {
        const double unit = c < g->n_x ? g->event.rates->unit[c] : 1.0;
        off = hypot(off, (a[c] - b[c]) / unit);
        size = hypot(size, hypot(a[c], b[c]) / unit);
    }
    return off > dalcs_nothing * size;
}

/* g->due: how late the instant is. Where an event of the circuit and one of gates coincide, there is no
 * derivative. */
static void find_instant(struct dalcs_gate_variation *g, const struct dalcs_logic_instant *instant,
                         double *work) {
    const bool is_own = *g->event.pending && g->ended == instant->t;
    const size_t bytes = (size_t)g->n_columns * sizeof(double);
    memset(g->due, 0, bytes);
    if (is_own) {
        memcpy(g->due, g->event.dt, bytes);
    }
    for (size_t k = 0; k < instant->n_causes; k++) {
        find_late(g, instant->cause[k], work);
        if (k == 0 && !is_own) {
            memcpy(g->due, work, bytes);
        } else {
            *g->event.is_exact = *g->event.is_exact && !differ(g, g->due, work);
        }
    }
}

static void change_pin(struct dalcs_gate_variation *g, int k, const struct dalcs_pin_change *change,
                       const double *late) {
    const struct dalcs_logic_memory *m = g->memory;
    double *row = dalcs_gate_row(g->pin, g, k);
    int taken = 0;
    while (change->takes && m->taken[taken] != m->pin[k].gate) {
        taken++;
    }
    for (int c = 0; c < g->n_columns; c++) {
        if (change->takes) {
            row[c] = dalcs_gate_row(g->taken, g, taken)[c] + g->rate[taken] * late[c];
        } else if (change->jumps) {
            row[c] = 0.0;
        } else if (!m->pin[k].holds) {
            row[c] =
                (change->left == 0.0 ? 0.0 : row[c]) + (change->left - change->right) * late[c];
        }
    }
}

static enum dalcs_status note_pulse(struct dalcs_gate_variation *g,
                                    const struct dalcs_logic_pulse_begun *pulse, const double *late,
                                    double *work) {
    const struct dalcs_logic_memory *m = g->memory;
    int taken = 0;
    memcpy(work, late, (size_t)g->n_columns * sizeof(double));
    while (taken < m->n_taken && m->taken[taken] != pulse->gate) {
        taken++;
    }
    for (int c = 0; c < g->n_columns && taken < m->n_taken && g->logic->taken[pulse->gate] > 0.0;
         c++) {
        work[c] += dalcs_gate_row(g->taken, g, taken)[c] + g->rate[taken] * late[c];
    }
    return keep_late(g, pulse->number, work);
}

enum dalcs_status dalcs_gate_variation_seen(void *user, const struct dalcs_logic_instant *instant) {
    struct dalcs_gate_variation *g = user;
    bool acts = false;
    find_instant(g, instant, g->work);
    DALCS_TRY(keep_late(g, instant->number, g->due));
    for (int k = 0; k < g->memory->n_pins; k++) {
        const struct dalcs_pin_change *change = &instant->pin[k];
        acts = acts || change->leap != 0.0 || change->left != change->right;
        change_pin(g, k, change, g->due);
    }
    for (size_t k = 0; k < instant->n_pulses; k++) {
        DALCS_TRY(note_pulse(g, &instant->pulse[k], g->due, g->work));
    }
    if (acts && g->ended == instant->t && !*g->event.pending) {
        memcpy(g->event.dt, g->due, (size_t)g->n_columns * sizeof(double));
        *g->event.pending = true;
    }
    return DALCS_OK;
}

/* ---- The end ------------------------------------------------------------------------------------------------- */

static void put_row(const struct dalcs_gate_variation *g, int number, const double *row,
                    double *M) {
    for (int c = 0; c < g->n_columns; c++) {
        M[(size_t)c * (size_t)g->n_columns + (size_t)(g->n_x + number)] = row[c];
    }
}

static void put_time(const struct dalcs_gate_variation *g, int number, long since, double *M,
                     double *first, double *last) {
    find_late(g, since, g->due);
    put_row(g, number, g->due, M);
    first[g->n_x + number] = last[g->n_x + number] = -1.0;
}

void dalcs_gate_variation_put(const struct dalcs_gate_variation *g, double *M, double *first,
                              double *last) {
    const struct dalcs_logic_memory *m = g->memory;
    int n = 0;
    for (int k = 0; k < m->n_numbers; k++) {
        first[g->n_x + k] = last[g->n_x + k] = 0.0;
        memset(g->due, 0, (size_t)g->n_columns * sizeof(double));
        put_row(g, k, g->due, M);
    }
    for (int k = 0; k < m->n_pins; k++, n++) {
        if (g->ends.last[k] != 0.0 || m->pin[k].holds) {
            put_row(g, n, dalcs_gate_row(g->pin, g, k), M);
        }
        first[g->n_x + n] = g->ends.first[k];
        last[g->n_x + n] = g->ends.last[k];
    }
    for (int k = 0; k < m->n_taken; k++, n++) {
        put_row(g, n, dalcs_gate_row(g->taken, g, k), M);
        first[g->n_x + n] = g->ends.rate[k];
        last[g->n_x + n] = g->rate[k];
    }
    for (int k = 0; k < m->n_pulses; k++, n++) {
        if (isfinite(g->logic->output[m->pulse[k]].ends)) {
            put_time(g, n, g->logic->output[m->pulse[k]].ends_since, M, first, last);
        }
    }
    for (int k = 0; k < g->logic->network.n; k++) {
        const struct dalcs_logic_output *o = &g->logic->output[k];
        for (size_t i = 0; i < o->n_due && n < m->n_numbers; i++, n++) {
            put_time(g, n, o->due[o->first_due + i].since, M, first, last);
        }
    }
}
