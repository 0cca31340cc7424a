/* vector.c - a column of numbers that grows while others read it. */
#include "vector.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_ROWS = 256 };

char *ng_copy_of(const char *text) {
    char *copy = dalcs_alloc(strlen(text) + 1, 1);
    return copy != NULL ? strcpy(copy, text) : NULL;
}

void ng_vector_destroy(struct ng_vector *v) {
    for (struct ng_block *block = v->block, *older; block != NULL; block = older) {
        older = block->older;
        free(block);
    }
    free(v->name);
    free(v->signal);
    free(v);
}

enum dalcs_status ng_vector_reserve(struct ng_vector *v, size_t need, bool keeps) {
    if (v->block != NULL && need <= v->capacity) {
        return DALCS_OK;
    }
    const size_t each = v->is_complex ? 2 : 1;
    const size_t wanted = need + need / 2 + (v->is_own ? 0 : FIRST_ROWS);
    if (wanted > INT32_MAX) { /* a vector's length is an int there */
        return DALCS_E_LIMIT;
    }
    struct ng_block *block = malloc(sizeof *block + wanted * each * sizeof(double));
    if (block == NULL) {
        return DALCS_E_NOMEM;
    }
    if (v->n > 0) {
        memcpy(block->value, v->block->value, v->n * each * sizeof(double));
    }
    block->older = v->block;
    if (!keeps && v->block != NULL) {
        block->older = v->block->older;
        free(v->block);
    }
    v->block = block;
    v->capacity = wanted;
    return DALCS_OK;
}

void ng_vector_append(struct ng_vector *v, size_t n, const double *value, size_t stride) {
    const size_t each = v->is_complex ? 2 : 1;
    double *at = v->block->value + v->n * each;
    for (size_t k = 0; k < n; k++) {
        for (size_t part = 0; part < each; part++) {
            at[k * each + part] = value[k * stride + part];
        }
    }
    v->n += n;
}

void ng_vector_append_scale(struct ng_vector *v, size_t n, const double *scale) {
    const size_t each = v->is_complex ? 2 : 1;
    for (size_t k = 0; k < n; k++, v->n++) {
        v->block->value[v->n * each] = scale[k];
        if (v->is_complex) {
            v->block->value[v->n * each + 1] = 0.0;
        }
    }
}
