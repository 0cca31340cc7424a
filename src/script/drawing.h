/* drawing.h - vectors as pictures: plot on the terminal, hardcopy into a file. */
#ifndef DALCS_DRAWING_H
#define DALCS_DRAWING_H

#include "vectors.h"

#include <stdio.h>

enum { DALCS_DRAWING_MESSAGE = 300 };

/* What is drawn over what. */
struct dalcs_drawing {
    const char *title;
    bool is_logarithmic; /* the scale */
    const struct dalcs_vector *scale;
    const struct dalcs_vector *const *vector; /* [n], those as long as the scale are drawn */
    size_t n;
};

/* True for .svg, .png and .pdf. */
bool dalcs_drawing_can_write(const char *path);

/* Into the file or, where path is NULL, as text on out. DALCS_E_IO: message says why. */
enum dalcs_status dalcs_drawing_draw(const struct dalcs_drawing *drawing, const char *path,
                                     FILE *out,
                                     char message[DALCS_DRAWING_MESSAGE]) DALCS_MUST_CHECK;

#endif
