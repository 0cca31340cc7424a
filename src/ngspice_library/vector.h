/* vector.h - a column of numbers that grows while others read it. */
#ifndef DALCS_NG_VECTOR_H
#define DALCS_NG_VECTOR_H

#include "dalcs.h"
#include "memory.h"

/* Numbers, and those before them that were too few. */
struct ng_block {
    struct ng_block *older;
    double value[];
};

struct ng_vector {
    char *name;   /* "out", "v1#branch", "time" */
    char *signal; /* "v(out)", "i(v1)", "time" */
    enum dalcs_unit unit;
    bool is_complex; /* two numbers each */
    bool is_own;     /* made by let or meas: no signal of the run */
    struct ng_block *block;
    size_t n, capacity;
};

void ng_vector_destroy(struct ng_vector *vector);

/* Room for so many values in all. `keeps`: the present values stay valid for their readers. */
enum dalcs_status ng_vector_reserve(struct ng_vector *vector, size_t need,
                                    bool keeps) DALCS_MUST_CHECK;

/* Values 0, stride, 2 stride, ... of an array become its next ones, for which there is room; of a complex vector
 * each with the number behind it. */
void ng_vector_append(struct ng_vector *vector, size_t n, const double *value, size_t stride);
void ng_vector_append_scale(struct ng_vector *vector, size_t n, const double *scale);

/* On the heap; NULL: no memory. */
char *ng_copy_of(const char *text);

#endif
