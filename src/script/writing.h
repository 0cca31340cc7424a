/* writing.h - vectors as text and files: print, wrdata, write. */
#ifndef DALCS_WRITING_H
#define DALCS_WRITING_H

#include "vectors.h"

#include <stdio.h>

/* How they are written. */
struct dalcs_writing {
    int digits;        /* of print; 0: 6, as ngspice */
    bool as_lines;     /* of print: vectors too one a line */
    bool as_columns;   /* of print: numbers too in a table */
    bool single_scale; /* of wrdata: the scale once, not for each vector */
    bool with_names;   /* of wrdata: a line of names first */
    bool appends;      /* of wrdata and write: behind what the file has */
    bool ascii;        /* raw files as text */
};

/* Numbers one a line, vectors as tables beside their scales, in ngspice's layout but for pages and dates. */
void dalcs_writing_print(FILE *out, const struct dalcs_writing *how,
                         const struct dalcs_plot_vectors *plot,
                         const struct dalcs_vector *const *vector, size_t n);

/* In the layout of ngspice's wrdata; `scale` is that of vectors without one. DALCS_E_IO: *error is an errno. */
enum dalcs_status dalcs_writing_data(const char *path, const struct dalcs_writing *how,
                                     const struct dalcs_vector *scale,
                                     const struct dalcs_vector *const *vector, size_t n,
                                     int *error) DALCS_MUST_CHECK;

/* A raw file, or a plot more in it, of the vectors beside the scale. DALCS_E_IO: *error is an errno. */
enum dalcs_status dalcs_writing_raw(const char *path, const struct dalcs_writing *how,
                                    const struct dalcs_plot_vectors *plot,
                                    const struct dalcs_vector *scale,
                                    const struct dalcs_vector *const *vector, size_t n,
                                    int *error) DALCS_MUST_CHECK;

#endif
