/* worst_case_choice.c - from runs with single tolerances to the worst of all, and what the corners say of it. */
#include "worst_case.h"

#include <math.h>

/* What two runs may differ by from their own errors. */
static double margin(const struct dalcs_worst_case *w, double value) {
    return dalcs_run_tolerance(w->options, &w->session->circuit) * fabs(value);
}

void dalcs_worst_case_choose(const struct dalcs_worst_case *w, size_t result, bool largest,
                             signed char *place) {
    const double sign = largest ? 1 : -1;
    const double nominal = w->run[0].value[result];
    for (size_t p = 0; p < w->n; p++) {
        const double low =
            sign * (w->run[dalcs_worst_case_alone(p, false)].value[result] - nominal);
        const double high =
            sign * (w->run[dalcs_worst_case_alone(p, true)].value[result] - nominal);
        const double best = fmax(low, high); /* a run that failed has none */
        const int end = best == high ? 1 : -1;
        place[p] = (signed char)(best > margin(w, nominal) ? end : 0);
    }
}

/* The first one of the best runs. */
static size_t find_best(const struct dalcs_worst_case *w, size_t result, bool largest) {
    const double sign = largest ? 1 : -1;
    size_t best = 0;
    for (size_t k = 1; k < w->n_runs; k++) {
        const double value = w->run[k].value[result];
        const double than = w->run[best].value[result];
        const bool is_better = sign * (value - than) > margin(w, than);
        best = is_better || (isnan(than) && !isnan(value)) ? k : best;
    }
    return best;
}

/* A corner that is worse than the single tolerances predict. */
static void tell_corner(const struct dalcs_worst_case *w, size_t result, bool largest) {
    const size_t told = dalcs_worst_case_told(w, result, largest);
    const size_t found = largest ? w->result[result].largest : w->result[result].smallest;
    if (found > dalcs_worst_case_told(w, w->n_results - 1, true)) {
        dalcs_diag_add(&w->session->diag, DALCS_NOTE, NULL, NULL,
                       ".wcase: '%s' is %s, %.6g, in a corner that the single tolerances do not "
                       "predict; they give %.6g",
                       w->result[result].name, largest ? "largest" : "smallest",
                       w->run[found].value[result], w->run[told].value[result]);
    }
}

void dalcs_worst_case_judge(struct dalcs_worst_case *w) {
    for (size_t k = 0; k < w->n_results; k++) {
        w->result[k].smallest = find_best(w, k, false);
        w->result[k].largest = find_best(w, k, true);
        tell_corner(w, k, false);
        tell_corner(w, k, true);
    }
}
