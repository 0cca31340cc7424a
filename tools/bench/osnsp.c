/* osnsp.c - the cost of a certified implicit Euler step over that of one bare klu_solve of the same
 * matrix, in one process, medians of interleaved repeats.
 *
 * "Same matrix": the plain mode matrix (equations, closed pairs) that was last factored; for a
 * component in a singular mode, its proximal matrix. A step includes sampling the sources, the
 * solve, pivoting and factoring where modes change, and the certificate. */
#include "bench.h"
#include "circuit.h"
#include "circuits.h"
#include "euler.h"
#include "netlist.h"
#include "osnsp_internal.h"

#include <string.h>

enum { REPEATS = 9 };

/* Seconds of one klu_solve, KLU's own settings, of the first component's newest plain mode. */
static double time_klu_solve(struct dalcs_euler *e, int *order) {
    struct dalcs_osnsp *p = &e->component[0].osnsp;
    const struct dalcs_mode_entry *entry = p->newest;
    while (entry != NULL && (entry->singular || (entry->key[p->n_words] & 255) != DALCS_PLAIN)) {
        entry = entry->older;
    }
    if (entry == NULL) {
        return 0.0;
    }
    struct dalcs_columns a;
    bench_must(dalcs_modes_matrix(p, entry, &a), "matrix");
    klu_common common;
    klu_defaults(&common);
    klu_symbolic *symbolic = klu_analyze(a.n, a.p, a.i, &common);
    klu_numeric *numeric = klu_factor(a.p, a.i, a.x, symbolic, &common);
    *order = a.n;
    double *b = calloc((size_t)a.n, sizeof(*b));
    if (numeric == NULL || b == NULL) {
        abort();
    }
    int rounds = 1 + 2000000 / (a.n * 10 + 100);
    double begin = bench_now();
    for (int k = 0; k < rounds; k++) {
        for (int i = 0; i < a.n; i++) {
            b[i] = 1.0 / (i + 1.0);
        }
        klu_solve(symbolic, numeric, a.n, 1, b, &common);
    }
    double filled = bench_now();
    for (int k = 0; k < rounds; k++) { /* what filling b costs is not the solve's */
        for (int i = 0; i < a.n; i++) {
            b[i] = 1.0 / (i + 1.0);
        }
        __asm__ volatile("" : : "r"(b) : "memory");
    }
    double seconds = (2.0 * filled - begin - bench_now()) / rounds;
    free(b);
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
    dalcs_columns_finish(&a);
    return seconds;
}

/* Seconds of one OSNSP of every component, at the state and inputs where the run stands: the same
 * mode again and again, nothing but the solve and its certificate. */
static double time_osnsp(struct dalcs_euler *e, int rounds) {
    double sigma = 1.0 / e->grid.h;
    double begin = bench_now();
    for (int r = 0; r < rounds; r++) {
        for (int k = 0; k < e->n_components; k++) {
            struct dalcs_component *c = &e->component[k];
            bench_must(dalcs_osnsp_solve(&c->osnsp, sigma, c->u, c->scratch), "osnsp");
        }
    }
    return (bench_now() - begin) / rounds;
}

static void bench(const char *name, char *text, double h, int warm_up, int n_steps, double target,
                  bool per_component, const char *unit) {
    struct dalcs_diag diag = {0};
    struct dalcs_netlist netlist = {0};
    struct dalcs_circuit circuit;
    struct dalcs_network network;
    bench_must(dalcs_netlist_read_text(&netlist, name, text, strlen(text), &diag), name);
    bench_must(dalcs_circuit_build(&circuit, &netlist, &diag), name);
    dalcs_netlist_finish(&netlist);
    bench_must(dalcs_network_build(&network, &circuit, &(struct dalcs_network_options){0}, &diag),
               name);
    struct dalcs_run_options o = dalcs_run_options_default();
    struct dalcs_osnsp_options options = dalcs_osnsp_options_of(&o);
    struct dalcs_euler e;
    bench_must(dalcs_euler_setup(&e, &circuit, &network, &options, h, 1e9 * h), name);
    bench_must(dalcs_euler_start(&e, network.initial), name);
    for (int k = 0; k < warm_up; k++) {
        bench_must(dalcs_euler_step(&e), name);
    }
    double step[REPEATS];
    double solve[REPEATS];
    double osnsp[REPEATS];
    int order = 0;
    struct dalcs_osnsp_counters before = {0};
    for (int k = 0; k < e.n_components; k++) {
        before.factorizations += e.component[k].osnsp.counters.factorizations;
        before.pivots += e.component[k].osnsp.counters.pivots;
    }
    for (int r = 0; r < REPEATS; r++) {
        double begin = bench_now();
        for (int k = 0; k < n_steps; k++) {
            bench_must(dalcs_euler_step(&e), name);
        }
        step[r] = (bench_now() - begin) / n_steps;
        osnsp[r] = time_osnsp(&e, n_steps);
        solve[r] = time_klu_solve(&e, &order);
    }
    long factorizations = -before.factorizations;
    long pivots = -before.pivots;
    for (int k = 0; k < e.n_components; k++) {
        factorizations += e.component[k].osnsp.counters.factorizations;
        pivots += e.component[k].osnsp.counters.pivots;
    }
    int parts = per_component ? e.n_components : 1;
    double us = 1e6 * bench_median(step, REPEATS) / parts;
    double us_solve = 1e6 * bench_median(solve, REPEATS);
    double steps = (double)REPEATS * n_steps * parts;
    double us_osnsp = 1e6 * bench_median(osnsp, REPEATS) / parts;
    printf("%-22s n %5d  klu_solve %7.3f us  osnsp %8.3f us = %5.2f  step %8.3f us = %5.2f  "
           "(pivots %.3f, factors %.4f a step)  worst %.0e  target %g %s\n",
           name, order, us_solve, us_osnsp, us_osnsp / us_solve, us, us / us_solve,
           (double)pivots / steps, (double)factorizations / steps, e.worst.worst, target, unit);
    dalcs_euler_finish(&e);
    dalcs_network_finish(&network);
    dalcs_circuit_finish(&circuit);
    dalcs_diag_finish(&diag);
    free(text);
}

int main(int argc, char **argv) {
    if (argc > 1) { /* one circuit, for a profiler */
        int n = atoi(argv[1]);
        bench("one", n > 0 ? bench_cockcroft_walton(n) : bench_six_pulse(), n > 0 ? 2e-6 : 2e-5,
              20000, n > 30 ? 2000 : 20000, 1.5, false, "klu_solve");
        return 0;
    }
    printf("osnsp: solve, signs and certificate in a recurring mode; step: the sources and the "
           "time loop "
           "too.\nTargets in klu_solve are the OSNSP's, those in us the step's.\n");
    bench("bridge", bench_bridge(1), 2e-5, 5000, 20000, 0.3, false, "us");
    bench("250 bridges", bench_bridge(250), 2e-5, 5000, 200, 0.4, true, "us a bridge");
    bench("six-pulse", bench_six_pulse(), 2e-5, 20000, 20000, 1.5, false, "klu_solve");
    bench("Cockcroft-Walton 10", bench_cockcroft_walton(10), 2e-6, 20000, 20000, 1.5, false,
          "klu_solve");
    bench("Cockcroft-Walton 100", bench_cockcroft_walton(100), 2e-6, 4000, 2000, 1.5, false,
          "klu_solve");
    bench("Cockcroft-Walton 1000", bench_cockcroft_walton(1000), 2e-6, 2000, 200, 1.5, false,
          "klu_solve");
    bench("ladder 64", bench_ladder(64), 1e-6, 1000, 1000, 0, false, "");
    bench("ladder 256", bench_ladder(256), 1e-6, 1000, 1000, 15, false, "us");
    bench("ladder 1024", bench_ladder(1024), 1e-6, 1000, 200, 0, false, "");
    bench("ladder 10000", bench_ladder(10000), 1e-6, 1000, 50, 0, false, "");
    return 0;
}
