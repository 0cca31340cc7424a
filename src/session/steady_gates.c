/* steady_gates.c - after how many periods of the sources gates are where they were: a counter that divides by n makes the
 * period n times as long.
 *
 * A run shows it: what gates remember, without numbers, is compared from period to period, over spans each twice as long. */
#include "steady.h"

#include "quantity.h"

#include <stdlib.h>

/* Periods of the sources that a run is given; half of them is the longest answer. */
enum { MOST_PERIODS = 4096 };

static uint64_t bits_of(const struct dalcs_steady *st) {
    uint64_t sum = 0xcbf29ce484222325u;
    for (int k = st->layout.n_switches; k < st->layout.n_pairs; k++) {
        sum = (sum ^ (st->at.closed[k] ? 1u : 0u)) * 0x100000001b3u;
    }
    return sum;
}

/* The smallest n after which the last half of what was seen, and at least n of it, repeats; 0: none. */
static int find_repeats(const uint64_t *seen, int n_seen) {
    for (int n = 1; n <= n_seen / 2; n++) {
        const int from = n_seen / 2 < n_seen - 2 * n ? n_seen / 2 : n_seen - 2 * n;
        bool same = true;
        for (int i = from + n; i < n_seen && same; i++) {
            same = seen[i] == seen[i - n];
        }
        if (same) {
            return n;
        }
    }
    return 0;
}

enum dalcs_status dalcs_steady_find_repeats(struct dalcs_steady *st, int *n) {
    uint64_t *seen = dalcs_alloc(MOST_PERIODS, sizeof *seen);
    enum dalcs_status status = seen != NULL ? DALCS_OK : DALCS_E_NOMEM;
    int past = 0;
    *n = 0;
    for (int k = 0; k < MOST_PERIODS && *n == 0 && status == DALCS_OK; k++) {
        status = dalcs_steady_pass(st, 1, DALCS_STEADY_PLAIN);
        if (status == DALCS_OK) {
            dalcs_steady_take(st);
            seen[k] = bits_of(st);
            *n = k >= 3 && ((k + 1) & k) == 0 ? find_repeats(seen, k + 1) : 0;
            past = *n > 0 ? (k + 1) % *n : 0;
        }
    }
    if (past > 0 && status == DALCS_OK) { /* to a multiple of the period behind t = 0 */
        status = dalcs_steady_pass(st, *n - past, DALCS_STEADY_PLAIN);
        dalcs_steady_take(st);
    }
    free(seen);
    return status;
}

void dalcs_steady_note_repeats(struct dalcs_steady *st, int n) {
    char one[DALCS_QUANTITY_SIZE];
    char all[DALCS_QUANTITY_SIZE];
    if (n > 1) {
        dalcs_diag_add(&st->run->s->diag, DALCS_NOTE, NULL, NULL,
                       "gates and flip-flops are where they were after %d periods of the sources: "
                       "the period is %s, not %s",
                       n, dalcs_quantity_write(all, n * st->period, "s", 9),
                       dalcs_quantity_write(one, st->period, "s", 9));
    }
}
