/* stages.c - the cost of a Radau step on sparse factors over that of the bare KLU solves of the
 * same matrices, and of a new mode over that of KLU's own parts of it; one process, medians of
 * interleaved repeats.
 *
 * The bare solves of a step: one klu_solve and (s-1)/2 klu_z_solve for the stages, one klu_solve
 * for the drift and, with curved sources, one more for the ripple. */
#include "bench.h"
#include "circuits.h"
#include "stage_factors.h"
#include "text_network.h"

#include <math.h>

enum { REPEATS = 9, STAGES = 5 };

/* KLU's own objects of the systems of a mode. */
struct bare {
    int n, n_systems;
    klu_common common[2];
    klu_symbolic *symbolic;
    klu_numeric *numeric[DALCS_STAGE_SYSTEMS];
    double *values[DALCS_STAGE_SYSTEMS];
    double *b;
};

static void bare_setup(struct bare *k, struct dalcs_stages *st, struct dalcs_stage_matrix *m,
                       double h) {
    *k = (struct bare){.n = m->n, .n_systems = 1 + st->method->n_pairs};
    klu_defaults(&k->common[0]);
    klu_defaults(&k->common[1]);
    k->symbolic = klu_analyze(m->n, m->p, m->i, &k->common[0]);
    k->b = calloc((size_t)m->n, 2 * sizeof(double));
    for (int q = 0; q < k->n_systems; q++) {
        double re;
        double im;
        dalcs_stage_factors_eigenvalue(st, h, q, &re, &im);
        dalcs_stage_matrix_at(m, re, im, q > 0);
        size_t bytes = (size_t)m->p[m->n] * 2 * sizeof(double);
        k->values[q] = malloc(bytes);
        if (k->values[q] == NULL || k->b == NULL || k->symbolic == NULL) {
            abort();
        }
        memcpy(k->values[q], m->values, bytes);
        k->numeric[q] = q > 0 ? klu_z_factor(m->p, m->i, m->values, k->symbolic, &k->common[1])
                              : klu_factor(m->p, m->i, m->values, k->symbolic, &k->common[0]);
    }
}

static void bare_finish(struct bare *k) {
    for (int q = 0; q < k->n_systems; q++) {
        (q > 0 ? klu_z_free_numeric : klu_free_numeric)(&k->numeric[q], &k->common[q > 0]);
        free(k->values[q]);
    }
    klu_free_symbolic(&k->symbolic, &k->common[0]);
    free(k->b);
}

/* Seconds of a klu_solve of one system. */
static double time_solve(struct bare *k, int system, int rounds) {
    double begin = bench_now();
    for (int r = 0; r < rounds; r++) {
        k->b[r % k->n] = 1.0; /* or else they become denormal */
        if (system > 0) {
            klu_z_solve(k->symbolic, k->numeric[system], k->n, 1, k->b, &k->common[1]);
        } else {
            klu_solve(k->symbolic, k->numeric[0], k->n, 1, k->b, &k->common[0]);
        }
        for (int i = 0; i < 2 * k->n; i++) {
            k->b[i] = 0.5;
        }
    }
    double end = bench_now();
    for (int r = 0; r < rounds; r++) { /* what filling b costs is not the solve's */
        for (int i = 0; i < 2 * k->n; i++) {
            k->b[i] = 0.5;
        }
        __asm__ volatile("" : : "r"(k->b) : "memory");
    }
    return (2.0 * end - begin - bench_now()) / rounds;
}

static double time_ours(const struct dalcs_stage_factors *f, int system, int rounds) {
    const struct dalcs_lu *lu = &f->lu[system];
    double begin = bench_now();
    for (int r = 0; r < rounds; r++) {
        for (int i = 0; i < f->n * (system > 0 ? 2 : 1); i++) {
            lu->work[i] = 0.5;
        }
        (system > 0 ? dalcs_lu_solve_ordered_complex : dalcs_lu_solve_ordered)(lu);
    }
    double end = bench_now();
    for (int r = 0; r < rounds; r++) {
        for (int i = 0; i < f->n * (system > 0 ? 2 : 1); i++) {
            lu->work[i] = 0.5;
        }
        __asm__ volatile("" : : "r"(lu->work) : "memory");
    }
    return (2.0 * end - begin - bench_now()) / rounds;
}

static double time_step(struct dalcs_stages *st, struct dalcs_stage_entry *e, const double *in,
                        double *out, int rounds) {
    double begin = bench_now();
    for (int r = 0; r < rounds; r++) {
        bench_must(dalcs_stages_apply(st, e, in, out), "apply");
    }
    return (bench_now() - begin) / rounds;
}

/* KLU's parts of a new mode. */
static void time_parts(struct bare *k, struct dalcs_stage_matrix *m, double *analyze,
                       double *factor, double *refactor) {
    double begin = bench_now();
    klu_symbolic *symbolic = klu_analyze(m->n, m->p, m->i, &k->common[0]);
    *analyze = bench_now() - begin;
    klu_free_symbolic(&symbolic, &k->common[0]);
    *factor = 0.0;
    *refactor = 0.0;
    for (int q = 0; q < k->n_systems; q++) {
        begin = bench_now();
        klu_numeric *numeric =
            q > 0 ? klu_z_factor(m->p, m->i, k->values[q], k->symbolic, &k->common[1])
                  : klu_factor(m->p, m->i, k->values[q], k->symbolic, &k->common[0]);
        *factor += bench_now() - begin;
        begin = bench_now();
        if (q > 0) {
            klu_z_refactor(m->p, m->i, k->values[q], k->symbolic, numeric, &k->common[1]);
        } else {
            klu_refactor(m->p, m->i, k->values[q], k->symbolic, numeric, &k->common[0]);
        }
        *refactor += bench_now() - begin;
        (q > 0 ? klu_z_free_numeric : klu_free_numeric)(&numeric, &k->common[q > 0]);
    }
}

/* Every fifth diode conducts. */
static void set_mode(uint64_t *mode, int n_pairs, int flipped) {
    for (int d = 0; d < n_pairs; d++) {
        bool on = (d % 5 == 2) != (d == flipped);
        mode[d / 64] |= (uint64_t)on << (d % 64);
    }
}

static void bench(const char *name, char *text, double h) {
    struct text_network t;
    bench_must(text_network_build(&t, text), name);
    const struct dalcs_system *s = &t.network.system[0];
    struct dalcs_excitation excitation;
    struct dalcs_stages st;
    struct dalcs_stages dense;
    bench_must(dalcs_excitation_setup(&excitation, &t.circuit, s), name);
    bench_must(dalcs_stages_setup(&st, s, &excitation, STAGES, 0, 1e-14, SIZE_MAX), name);
    bench_must(dalcs_stages_setup(&dense, s, &excitation, STAGES, 1000000, 1e-14, SIZE_MAX), name);
    uint64_t *mode = calloc((size_t)st.n_words + 1, sizeof(*mode));
    double *in = calloc((size_t)st.n_in, sizeof(double));
    double *out = calloc((size_t)st.layout.n_fixed + 64, sizeof(double));
    if (mode == NULL || in == NULL || out == NULL) {
        abort();
    }
    set_mode(mode, s->n_pairs, -1);
    for (int k = 0; k < st.n_in; k++) {
        in[k] = cos(k);
    }
    struct dalcs_stage_entry *entry;
    bench_must(dalcs_stages_get(&st, mode, h, &entry), name);
    if (dalcs_stage_n_clashes(entry) > 0) {
        fprintf(stderr, "bench: %s: singular\n", name);
        exit(1);
    }
    struct dalcs_stage_matrix m;
    bench_must(
        dalcs_stage_matrix_build(&m, st.plan, entry->n_on, entry->on, &entry->factors->singular, h),
        name);
    struct bare bare;
    bare_setup(&bare, &st, &m, h);
    double v[10][REPEATS];
    int rounds = 1 + 200000 / m.n;
    for (int r = 0; r < REPEATS; r++) {
        v[0][r] = time_step(&st, entry, in, out, rounds);
        v[1][r] = time_solve(&bare, 0, rounds);
        v[2][r] = time_solve(&bare, 1, rounds);
        v[3][r] = time_ours(entry->factors, 0, rounds);
        v[4][r] = time_ours(entry->factors, 1, rounds);
        time_parts(&bare, &m, &v[5][r], &v[6][r], &v[7][r]);
        struct dalcs_stage_entry *new;
        memset(mode, 0, (size_t)st.n_words * sizeof(*mode));
        set_mode(mode, s->n_pairs, r);
        double begin = bench_now();
        bench_must(dalcs_stages_get(&st, mode, h, &new), name);
        v[8][r] = bench_now() - begin;
        begin = bench_now();
        bench_must(dalcs_stages_get(&st, mode, h / (r + 2), &new), name);
        v[9][r] = bench_now() - begin;
    }
    double us[10];
    for (int k = 0; k < 10; k++) {
        us[k] = 1e6 * bench_median(v[k], REPEATS);
    }
    double solves = (excitation.is_curved ? 3.0 : 2.0) * us[1] + bare.n_systems * us[2] - us[2];
    printf("%-20s n %5d  klu_solve %7.2f us (here %4.2f)  klu_z_solve %7.2f us (here %4.2f)  "
           "step %8.2f us = %4.2f bare solves\n",
           name, m.n, us[1], us[3] / us[1], us[2], us[4] / us[2], us[0], us[0] / solves);
    printf(
        "%-20s in klu_solves: analyze %.1f, factor all %.1f, refactor all %.1f; a new mode %.1f, "
        "a new length of step %.1f",
        "", us[5] / us[1], us[6] / us[1], us[7] / us[1], us[8] / us[1], us[9] / us[1]);
    if (m.n < 300) {
        struct dalcs_stage_entry *map;
        double begin = bench_now();
        bench_must(dalcs_stages_get(&dense, mode, h, &map), name);
        double built = bench_now() - begin;
        double step = time_step(&dense, map, in, out, rounds);
        printf("; dense: step %.2f, new mode %.1f of here", 1e6 * step / us[0],
               1e6 * built / us[8]);
    }
    printf("\n");
    bare_finish(&bare);
    dalcs_stage_matrix_finish(&m);
    dalcs_stages_finish(&st);
    dalcs_stages_finish(&dense);
    dalcs_excitation_finish(&excitation);
    text_network_finish(&t);
    free(mode);
    free(in);
    free(out);
    free(text);
}

int main(void) {
    printf("A step of %d stages on sparse factors; target 1.5 bare solves.\n", STAGES);
    const int stages[] = {2, 3, 4, 6, 8, 12, 16, 24, 32, 100, 1000};
    for (size_t k = 0; k < sizeof(stages) / sizeof(stages[0]); k++) {
        char name[64];
        snprintf(name, sizeof(name), "Cockcroft-Walton %d", stages[k]);
        bench(name, bench_cockcroft_walton(stages[k]), 1e-4);
    }
    bench("peak detectors 10", bench_peak_detectors(10), 1e-5);
    bench("peak detectors 1000", bench_peak_detectors(1000), 1e-5);
    bench("ladder 256", bench_ladder(256), 1e-5);
    return 0;
}
