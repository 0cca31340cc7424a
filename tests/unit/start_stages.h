/* start_stages.h - a circuit whose stages are solved. */
#ifndef START_STAGES_H
#define START_STAGES_H

#include "build_network.h"
#include "extended.h"
#include "stages.h"

static struct text_network t;
static const struct dalcs_system *s;
static struct dalcs_excitation x;
static struct dalcs_stages stages;

static inline void start_with(const char *text, int n_stages, size_t most_bytes) {
    build_good_network(&t, text);
    ck_assert_int_eq(t.network.n_systems, 1);
    s = &t.network.system[0];
    ck_assert_int_eq(dalcs_excitation_setup(&x, &t.circuit, s, NULL), DALCS_OK);
    ck_assert_int_eq(dalcs_stages_setup(&stages, s, &x,
                                        dalcs_collocation_of(DALCS_RADAU_IIA, n_stages),
                                        &(struct dalcs_stage_limits){64, 1e-14, most_bytes}),
                     DALCS_OK);
}

static inline void start(const char *text, int n_stages) {
    start_with(text, n_stages, (size_t)1 << 24);
}

static inline void finish(void) {
    dalcs_stages_finish(&stages);
    dalcs_excitation_finish(&x);
    text_network_finish(&t);
}

static inline struct dalcs_stage_entry *get(uint64_t mode, double h) {
    struct dalcs_stage_entry *entry;
    ck_assert_int_eq(dalcs_stages_get(&stages, &mode, h, &entry), DALCS_OK);
    return entry;
}

enum { MOST_OUT = 1000 };

static double out[MOST_OUT];

/* A step from `at` and state[n_x] to out; the number of clashes. */
static inline int step(uint64_t mode, double at, double h, const double *state) {
    double in[40];
    struct dalcs_stage_entry *entry = get(mode, h);
    int n_clashes = dalcs_stage_n_clashes(entry);
    ck_assert_int_le(stages.layout.n_fixed + n_clashes + 8, MOST_OUT);
    for (int k = 0; k < s->n_x; k++) {
        in[k] = state[k];
    }
    in[s->n_x] = 1.0;
    dalcs_excitation_enter(&x, at);
    dalcs_excitation_coefficients(&x, at, h, in + s->n_x + 1);
    ck_assert_int_eq(dalcs_stages_apply(&stages, entry, in, out), DALCS_OK);
    ck_assert(dalcs_stage_residual(entry) < 1e-12);
    return n_clashes;
}

static inline double column_at(int node, enum dalcs_label_kind kind, const char *name) {
    return out[node * stages.layout.stride + find_column(s, kind, name)];
}

#endif
