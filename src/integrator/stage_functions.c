/* stage_functions.c - functions of sources at the stages of a step, as each eigenvalue's solution has them. */
#include "stage_functions.h"

#include <complex.h>
#include <stdlib.h>
#include <string.h>

/* Parts that few stages do without. */
static void clear_rest(const struct dalcs_collocation *m, dalcs_stage_factors_of_parts factor) {
    int n_parts = 1 + 2 * m->n_pairs;
    for (int i = 0; i < m->s && n_parts < DALCS_SOLUTION_PARTS; i++) {
        memset(factor[i] + n_parts, 0,
               (size_t)(DALCS_SOLUTION_PARTS - n_parts) * sizeof(*factor[i]));
    }
}

/* Each coordinate sees the constant 1 as 1. */
void dalcs_stage_functions_setup(struct dalcs_stage_functions *functions,
                                 const struct dalcs_collocation *m,
                                 dalcs_stage_factors_of_parts *constant_factor) {
    *functions = (struct dalcs_stage_functions){.constant_factor = constant_factor};
    for (int i = 0; i < m->s; i++) {
        long double *factor = (*constant_factor)[i];
        factor[0] = m->exact_to[i];
        for (int p = 0; p < m->n_pairs; p++) {
            factor[1 + 2 * p] = 2.0L * creall(m->exact_to_pair[i][p]);
            factor[2 + 2 * p] = -2.0L * cimagl(m->exact_to_pair[i][p]);
        }
    }
    clear_rest(m, *constant_factor);
}

void dalcs_stage_functions_finish(struct dalcs_stage_functions *functions) {
    for (int k = 0; k < functions->n; k++) {
        free(functions->length[k].function);
    }
}

static void find_factors(const struct dalcs_stage_functions *functions,
                         const struct dalcs_collocation *m, struct dalcs_stage_function *of) {
    long double weight = 0.0L;
    for (int q = 0; q < m->s; q++) {
        weight += m->exact_from[q] * of->share[q + 1];
    }
    for (int i = 0; i < m->s; i++) {
        of->factor[i][0] = m->exact_to[i] * weight;
    }
    for (int p = 0; p < m->n_pairs; p++) {
        long double re = 0.0L;
        long double im = 0.0L;
        for (int q = 0; q < m->s; q++) {
            re += creall(m->exact_from_pair[p][q]) * of->share[q + 1];
            im += cimagl(m->exact_from_pair[p][q]) * of->share[q + 1];
        }
        for (int i = 0; i < m->s; i++) {
            const long double *of_pair = (*functions->constant_factor)[i] + 1 + 2 * p;
            of->factor[i][1 + 2 * p] = of_pair[0] * re + of_pair[1] * im;
            of->factor[i][2 + 2 * p] = of_pair[1] * re - of_pair[0] * im;
        }
    }
    clear_rest(m, of->factor);
}

static void fill(const struct dalcs_stage_functions *functions, const struct dalcs_stages *stages,
                 const struct dalcs_stage_length *length) {
    const struct dalcs_excitation *e = stages->excitation;
    const struct dalcs_collocation *m = stages->method;
    for (int f = 0; f < e->n_functions; f++) {
        struct dalcs_stage_function *of = &length->function[f];
        memset(of->share, 0, sizeof(of->share));
        for (int k = 0; k <= m->s; k++) {
            of->share[k] = dalcs_excitation_function_at(&e->function[f], length->h, m->node[k]);
        }
        of->share[DALCS_RIPPLE_LANE] =
            dalcs_excitation_missed(&e->function[f], m, length->h, of->share);
        find_factors(functions, m, of);
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
    fill(functions, stages, length);
    functions->next = (functions->next + 1) % DALCS_STAGE_LENGTHS;
    return length->function;
}
