/* loss_table.c - energies between the entries of a table. */
#include "losses.h"

/* The interval of x[n] that holds `value`, and how far in it, 0 to 1. */
static int place_in(const double *x, int n, double value, double *part, bool *clamped) {
    int low = 0;
    int high = n - 1;
    *part = 0.0;
    if (value < x[0] || value > x[n - 1]) {
        *clamped = true;
    }
    if (value <= x[0]) {
        return 0;
    }
    if (value >= x[n - 1]) {
        return n - 1;
    }
    while (high - low > 1) {
        int middle = (low + high) / 2;
        *(x[middle] <= value ? &low : &high) = middle;
    }
    *part = (value - x[low]) / (x[high] - x[low]);
    return low;
}

double dalcs_loss_table_at(const struct dalcs_loss_table *table, double volt, double ampere,
                           bool *clamped) {
    double s;
    double t;
    int v = place_in(table->v, table->n_v, volt, &s, clamped);
    int i = place_in(table->i, table->n_i, ampere, &t, clamped);
    double sum = 0.0;
    for (int corner = 0; corner < 4; corner++) {
        double weight = (corner / 2 ? s : 1.0 - s) * (corner % 2 ? t : 1.0 - t);
        if (weight > 0.0) { /* an edge has no neighbour behind it */
            sum += weight * table->e[(v + corner / 2) * table->n_i + i + corner % 2];
        }
    }
    return sum;
}
