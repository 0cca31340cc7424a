/* system_file_format.h - the words of system files, and how they are read. Private to src/dalcs. */
#ifndef DALCS_SYSTEM_FILE_FORMAT_H
#define DALCS_SYSTEM_FILE_FORMAT_H

#include "system_file.h"

enum {
    DALCS_SYSTEM_FILE_VERSION = 1,
    DALCS_N_SYSTEM_SECTIONS = 8,
    DALCS_N_LABEL_KINDS = 4,
    DALCS_N_PAIR_KINDS = 3
};

enum { DALCS_FILE_DIODE, DALCS_FILE_BREAKDOWN, DALCS_FILE_SWITCH };

struct dalcs_system_section {
    const char *name;
    size_t offset; /* of the matrix in struct dalcs_system */
    int n_rows, n_columns;
};

struct dalcs_system_reader {
    struct dalcs_system_file *file;
    const char *name;
    struct dalcs_diag *diag;
    const char *at, *end;
    int line;
    const char *word; /* [length] the last one read */
    size_t length;
};

extern const char *const dalcs_system_label_kind[DALCS_N_LABEL_KINDS];
extern const char *const dalcs_system_pair_kind[DALCS_N_PAIR_KINDS];

void dalcs_system_list_sections(const struct dalcs_system *s, struct dalcs_system_section *section);

enum dalcs_status dalcs_system_refuse(struct dalcs_system_reader *r,
                                      const char *expected) DALCS_MUST_CHECK;

/* The next word of the line; of length 0 at its end. */
void dalcs_system_read_word(struct dalcs_system_reader *r);

bool dalcs_system_word_is(const struct dalcs_system_reader *r, const char *text);

enum dalcs_status dalcs_system_read_keyword(struct dalcs_system_reader *r,
                                            const char *keyword) DALCS_MUST_CHECK;

enum dalcs_status dalcs_system_end_line(struct dalcs_system_reader *r) DALCS_MUST_CHECK;

enum dalcs_status dalcs_system_read_int(struct dalcs_system_reader *r, int first, int last,
                                        int *value) DALCS_MUST_CHECK;

enum dalcs_status dalcs_system_read_number(struct dalcs_system_reader *r,
                                           double *value) DALCS_MUST_CHECK;

enum dalcs_status dalcs_system_read_choice(struct dalcs_system_reader *r, const char *const *choice,
                                           int n, const char *expected,
                                           int *index) DALCS_MUST_CHECK;

enum dalcs_status dalcs_system_read_unit(struct dalcs_system_reader *r,
                                         bool *is_current) DALCS_MUST_CHECK;

/* A name and the end of its line. */
enum dalcs_status dalcs_system_read_name(struct dalcs_system_reader *r,
                                         const char **name) DALCS_MUST_CHECK;

bool dalcs_system_is_blank(char c);

#endif
