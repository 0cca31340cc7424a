/* stage_functions.c - functions of sources at the stages of a step, as each eigenvalue's solution has them. */
#include "stage_functions.h"

#include <stdlib.h>
#include <string.h>

void dalcs_stage_functions_finish(struct dalcs_stage_functions *functions) {
    for (int k = 0; k < functions->n; k++) {
        free(functions->length[k].function);
    }
}

/* In each coordinate the constant 1 is 1, and a function of time is the combination of its values at the stages. */
static void find_factors(const struct dalcs_collocation *m, struct dalcs_stage_function *of) {
    int n_parts = 1 + 2 * m->n_pairs;
    struct dalcs_extended_row weight;
    long double start = 0.0L;
    for (int i = 0; i < m->n_stages; i++) {
        start += m->exact.back[i] * of->share[i + 1];
    }
    memset(&of->stages, 0, sizeof(of->stages));
    memcpy(of->stages.high, of->share + 1, (size_t)m->s * sizeof(double));
    dalcs_extended_put(&of->stages, m->s, start);
    dalcs_collocation_parts(m, of->share + 1, &weight);
    struct dalcs_extended real = {weight.high[0], weight.low[0]};
    dalcs_extended_combine(m->s + 1, 1, &real, m->exact.to, NULL, &of->of_part[0]);
    for (int part = 1; part < n_parts; part += 2) {
        struct dalcs_extended re = {weight.high[part], weight.low[part]};
        struct dalcs_extended im = {weight.high[part + 1], weight.low[part + 1]};
        struct dalcs_extended of_re[2] = {re, im};
        struct dalcs_extended of_im[2] = {{-im.high, -im.low}, re};
        const struct dalcs_extended_row *to = m->exact.to + part;
        dalcs_extended_combine(m->s + 1, 2, of_re, to, NULL, &of->of_part[part]);
        dalcs_extended_combine(m->s + 1, 2, of_im, to, NULL, &of->of_part[part + 1]);
    }
}

static void fill(const struct dalcs_stages *stages, const struct dalcs_stage_length *length) {
    const struct dalcs_excitation *e = stages->excitation;
    const struct dalcs_collocation *m = stages->method;
    for (int f = 0; f < e->n_functions; f++) {
        struct dalcs_stage_function *of = &length->function[f];
        memset(of->share, 0, sizeof(of->share));
        for (int k = 0; k <= m->s; k++) {
            of->share[k] = dalcs_excitation_function_at(&e->function[f], length->h, m->node[k]);
        }
        of->share[m->s + 1] = of->share[0]; /* of a stage at the start, if any */
        of->share[DALCS_RIPPLE_LANE] =
            dalcs_excitation_missed(&e->function[f], m, length->h, of->share);
        find_factors(m, of);
    }
}

const struct dalcs_stage_function *
dalcs_stage_functions_get(struct dalcs_stage_functions *functions,
                          const struct dalcs_stages *stages, double h) {
    for (int k = 0; k < functions->n; k++) {
        if (functions->length[k].h == h) {
            return functions->length[k].function;
        }
    }
    struct dalcs_stage_length *length = &functions->length[functions->next];
    if (length->function == NULL) {
        size_t n = (size_t)stages->excitation->n_functions;
        length->function = malloc((n > 0 ? n : 1) * sizeof(*length->function));
        if (length->function == NULL) {
            return NULL;
        }
        functions->n++;
    }
    length->h = h;
    fill(stages, length);
    functions->next = (functions->next + 1) % DALCS_STAGE_LENGTHS;
    return length->function;
}
