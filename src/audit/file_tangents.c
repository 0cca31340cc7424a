/* file_tangents.c - the lines that stand for exponential diodes in a table.
 *
 * A run takes the tangent of each at I0 = (integral of i^2) / (integral of i), the current that it carries, and a table
 * does not say where that was. Its column of the current does, by the same rule and over the same part of the time
 * (session/operating_currents.c). Without such a column, and where nothing flows, the line stays that of the netlist. */
#include "file_internal.h"

#include <string.h>

/* Forward and backward. */
struct carried {
    double charge[2], square[2]; /* C, A^2 s */
};

static const struct dalcs_exponential *exponential_of(const struct dalcs_circuit *c, int device) {
    const struct dalcs_device *d = &c->device[device];
    const struct dalcs_exponential *e =
        d->kind == DALCS_DIODE ? &c->models.of_diode[d->model].exponential : NULL;
    return e != NULL && e->voltage > 0.0 ? e : NULL;
}

/* A line of its own for each, so that the circuit's models are as they were. */
static enum dalcs_status part_models(struct file_audit *a, int n) {
    struct dalcs_circuit *own = dalcs_arena_alloc(&a->arena, 1, sizeof *own);
    const size_t n_devices = (size_t)a->circuit->n_devices;
    const size_t n_models = (size_t)a->circuit->models.n_diodes;
    struct dalcs_device *device = dalcs_arena_alloc(&a->arena, n_devices, sizeof *device);
    struct dalcs_diode_model *model =
        dalcs_arena_alloc(&a->arena, n_models + (size_t)n, sizeof *model);
    if (own == NULL || device == NULL || model == NULL) {
        return DALCS_E_NOMEM;
    }
    *own = *a->circuit;
    memcpy(device, own->device, n_devices * sizeof *device);
    memcpy(model, own->models.of_diode, n_models * sizeof *model);
    for (int d = 0; d < own->n_devices; d++) {
        if (exponential_of(a->circuit, d) != NULL) {
            model[own->models.n_diodes] = model[device[d].model];
            device[d].model = own->models.n_diodes++;
        }
    }
    own->device = device;
    own->models.of_diode = model;
    a->circuit = own;
    return DALCS_OK;
}

static void add(struct carried *c, double current, double time) {
    const int side = current > 0.0 ? 0 : 1;
    c->charge[side] += time * fabs(current);
    c->square[side] += time * current * current;
}

/* By trapezoids; of an operating point its current. */
static struct carried carried_from(const struct file_audit *a, size_t column, double from) {
    struct carried c = {0};
    const struct dalcs_wave_table *t = a->table;
    for (size_t k = 0; k < t->n_rows; k++) {
        const double now = t->value[k * t->n_columns];
        const double before = k > 0 ? fmax(t->value[(k - 1) * t->n_columns], from) : now;
        const double next = k + 1 < t->n_rows ? t->value[(k + 1) * t->n_columns] : now;
        const double time =
            t->n_rows == 1 ? 1.0
                           : 0.5 * (fmax(now - before, 0.0) + fmax(next - fmax(now, from), 0.0));
        const struct file_number i = file_cell(a, k, column);
        if (i.known) {
            add(&c, i.value, time);
        }
    }
    return c;
}

/* A; `usual` where nothing passes but errors of the rest. */
static double mean_of(const struct file_audit *a, const struct carried *part,
                      const struct carried *all, int side, double usual) {
    const double least = a->promise.tolerance * (all->charge[0] + all->charge[1]);
    const struct carried *of = part->charge[side] > least ? part : all;
    return of->charge[side] > least ? of->square[side] / of->charge[side] : usual;
}

enum dalcs_status file_take_tangents(struct file_audit *a) {
    int n = 0;
    for (int d = 0; d < a->circuit->n_devices; d++) {
        n += exponential_of(a->circuit, d) != NULL && a->columns.current[d] >= 0 ? 1 : 0;
    }
    if (n == 0 || a->promise.has_own_lines || a->circuit->options.has_diode_current) {
        return DALCS_OK;
    }
    DALCS_TRY(part_models(a, a->circuit->n_devices));
    const struct dalcs_transient *run = &a->circuit->analyses.transient;
    const double half = 0.5 * a->table->value[(a->table->n_rows - 1) * a->table->n_columns];
    const double from = run->start > 0.0 ? run->start : half;
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const struct dalcs_exponential *e = exponential_of(a->circuit, d);
        if (e != NULL && a->columns.current[d] >= 0) {
            const size_t column = (size_t)a->columns.current[d];
            const struct carried all = carried_from(a, column, 0.0);
            const struct carried part = carried_from(a, column, from);
            const double at = mean_of(a, &part, &all, 0, e->at);
            const double back_at = mean_of(a, &part, &all, 1, e->back_at);
            dalcs_exponential_take(&a->circuit->models.of_diode[a->circuit->device[d].model], at,
                                   back_at);
        }
    }
    return DALCS_OK;
}
