/* three_stages.c - one network with stages by the dense map, on factors, and on updated factors. */
#include "stage_comparison.h"

/* Every row of F gets all inputs and C a few lambdas, which no netlist does. */
static void generalise(struct dalcs_system *s) {
    uint64_t random = 29;
    struct dalcs_triplets f = {0};
    struct dalcs_triplets c = {0};
    for (int d = 0; d < s->n_pairs; d++) {
        for (int k = 0; k < s->n_inputs; k++) {
            ck_assert_int_eq(dalcs_triplets_add(&f, d, k, next_random(&random)), DALCS_OK);
        }
        for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
            ck_assert_int_eq(dalcs_triplets_add(&c, d, s->C.j[k], s->C.x[k]), DALCS_OK);
        }
        for (int k = 0; k <= d; k++) {
            int column = dalcs_system_n_equations(s) + k;
            ck_assert_int_eq(dalcs_triplets_add(&c, d, column, 3.0 + next_random(&random)),
                             DALCS_OK);
        }
    }
    dalcs_csr_finish(&s->F);
    dalcs_csr_finish(&s->C);
    ck_assert_int_eq(dalcs_csr_compress(&s->F, s->n_pairs, s->n_inputs, &f), DALCS_OK);
    ck_assert_int_eq(dalcs_csr_compress(&s->C, s->n_pairs, dalcs_system_n_columns(s), &c),
                     DALCS_OK);
    dalcs_triplets_finish(&f);
    dalcs_triplets_finish(&c);
}

void setup_stages(struct three_stages *b, const char *netlist, int s, bool general) {
    b->near = 0.0;
    build_good_network(&b->text, netlist);
    if (general) {
        generalise(&b->text.network.system[0]);
    }
    ck_assert_int_eq(b->text.network.n_systems, 1);
    b->system = &b->text.network.system[0];
    ck_assert_int_eq(dalcs_excitation_setup(&b->excitation, &b->text.circuit, b->system, NULL),
                     DALCS_OK);
    ck_assert_int_eq(dalcs_stages_setup(&b->dense, b->system, &b->excitation,
                                        dalcs_collocation_of(DALCS_RADAU_IIA, s),
                                        &(struct dalcs_stage_limits){1000000, 1e-14, SIZE_MAX}),
                     DALCS_OK);
    ck_assert_int_eq(dalcs_stages_setup(&b->sparse, b->system, &b->excitation,
                                        dalcs_collocation_of(DALCS_RADAU_IIA, s),
                                        &(struct dalcs_stage_limits){0, 1e-14, SIZE_MAX}),
                     DALCS_OK);
    ck_assert_int_eq(dalcs_stages_setup(&b->updated, b->system, &b->excitation,
                                        dalcs_collocation_of(DALCS_RADAU_IIA, s),
                                        &(struct dalcs_stage_limits){0, 1e-14, SIZE_MAX}),
                     DALCS_OK);
    b->sparse.cache.update_trust = 0;
}

void finish_stages(struct three_stages *b) {
    dalcs_stages_finish(&b->dense);
    dalcs_stages_finish(&b->sparse);
    dalcs_stages_finish(&b->updated);
    dalcs_excitation_finish(&b->excitation);
    text_network_finish(&b->text);
}
