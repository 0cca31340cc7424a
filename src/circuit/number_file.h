/* number_file.h - numbers in a text file that a card names: points of a PWL, values of a .step.
 *
 * Blanks, commas and line ends are between them; *, # or ; start a comment. */
#ifndef DALCS_NUMBER_FILE_H
#define DALCS_NUMBER_FILE_H

#include "builder.h"

struct dalcs_number_file {
    const char *path; /* in the builder's scratch */
    char *text;       /* heap */
    const char *at;
    int line;
    const char *wrong; /* what is no number; NULL: nothing so far */
};

/* The file that a token names, relative to the folder of the netlist. False when an error was reported;
 * it says that the `what` of the file cannot be read. */
bool dalcs_number_file_open(struct dalcs_builder *builder, const struct dalcs_token *name,
                            const char *what, struct dalcs_number_file *file);
void dalcs_number_file_close(struct dalcs_number_file *file);

/* The next number; false at the end of the file or at what is none. */
bool dalcs_number_file_next(struct dalcs_number_file *file, double *value);

/* Was the end reached? Else an error is reported at the place of the file's name. */
bool dalcs_number_file_is_read(struct dalcs_builder *builder, const struct dalcs_token *name,
                               const struct dalcs_number_file *file, const char *hint);

#endif
