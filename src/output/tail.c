/* tail.c - a ring of rows. */
#include "tail.h"

#include "memory.h"

#include <stdlib.h>
#include <string.h>

enum dalcs_status dalcs_tail_init(struct dalcs_tail *tail, size_t n_values) {
    *tail = (struct dalcs_tail){.n_values = n_values};
    tail->cell = dalcs_alloc(DALCS_TAIL_ROWS * (1 + n_values), sizeof *tail->cell);
    return tail->cell ? DALCS_OK : DALCS_E_NOMEM;
}

static double *find_row(const struct dalcs_tail *tail, size_t number) {
    return tail->cell + number % DALCS_TAIL_ROWS * (1 + tail->n_values);
}

void dalcs_tail_add(struct dalcs_tail *tail, double time, const double *value) {
    double *row = find_row(tail, tail->n_added++);
    row[0] = time;
    memcpy(row + 1, value, tail->n_values * sizeof *value);
}

size_t dalcs_tail_n_rows(const struct dalcs_tail *tail) {
    return tail->n_added < DALCS_TAIL_ROWS ? tail->n_added : DALCS_TAIL_ROWS;
}

const double *dalcs_tail_row(const struct dalcs_tail *tail, size_t i) {
    return find_row(tail, tail->n_added - dalcs_tail_n_rows(tail) + i);
}

void dalcs_tail_finish(struct dalcs_tail *tail) {
    free(tail->cell);
    *tail = (struct dalcs_tail){0};
}
