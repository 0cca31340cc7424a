/* system_file_format.c - the words of system files, and how they are read. */
#include "system_file_format.h"

#include "number.h"

#include <string.h>

const char *const dalcs_system_label_kind[DALCS_N_LABEL_KINDS] = {[DALCS_LABEL_STATE] = "state",
                                                                  [DALCS_LABEL_NODE] = "node",
                                                                  [DALCS_LABEL_BRANCH] = "branch",
                                                                  [DALCS_LABEL_REFERENCE] =
                                                                      "reference"};

const char *const dalcs_system_pair_kind[DALCS_N_PAIR_KINDS] = {[DALCS_FILE_DIODE] = "diode",
                                                                [DALCS_FILE_BREAKDOWN] =
                                                                    "breakdown",
                                                                [DALCS_FILE_SWITCH] = "switch"};

void dalcs_system_list_sections(const struct dalcs_system *s,
                                struct dalcs_system_section *section) {
    int n_equations = dalcs_system_n_equations(s);
    int n_columns = dalcs_system_n_columns(s);
#define MATRIX(name) #name, offsetof(struct dalcs_system, name)
    const struct dalcs_system_section all[DALCS_N_SYSTEM_SECTIONS] = {
        {MATRIX(P), s->n_x, s->n_x},
        {MATRIX(A), n_equations, n_columns},
        {MATRIX(E), n_equations, s->n_inputs},
        {MATRIX(C), s->n_pairs, n_columns},
        {MATRIX(F), s->n_pairs, s->n_inputs},
        {MATRIX(storage), s->n_x, s->n_x},
        {MATRIX(control), s->n_pairs, n_columns},
        {MATRIX(direct_control), s->n_pairs, s->n_inputs},
    };
#undef MATRIX
    memcpy(section, all, sizeof(all));
}

bool dalcs_system_is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

enum dalcs_status dalcs_system_refuse(struct dalcs_system_reader *r, const char *expected) {
    const struct dalcs_location where = {.file = r->name, .line = r->line};
    size_t shown = r->length < 40 ? r->length : 40;
    dalcs_diag_add(r->diag, DALCS_ERROR, &where, NULL, "expected %s%s%.*s%s", expected,
                   shown > 0 ? ", not '" : "; the line ends too early", (int)shown, r->word,
                   shown > 0 ? "'" : "");
    return DALCS_E_NETLIST;
}

void dalcs_system_read_word(struct dalcs_system_reader *r) {
    while (r->at < r->end && dalcs_system_is_blank(*r->at)) {
        r->at++;
    }
    r->word = r->at;
    while (r->at < r->end && !dalcs_system_is_blank(*r->at) && *r->at != '\n') {
        r->at++;
    }
    r->length = (size_t)(r->at - r->word);
}

bool dalcs_system_word_is(const struct dalcs_system_reader *r, const char *text) {
    return r->length == strlen(text) && memcmp(r->word, text, r->length) == 0;
}

enum dalcs_status dalcs_system_read_keyword(struct dalcs_system_reader *r, const char *keyword) {
    r->line++;
    dalcs_system_read_word(r);
    return dalcs_system_word_is(r, keyword) ? DALCS_OK : dalcs_system_refuse(r, keyword);
}

enum dalcs_status dalcs_system_end_line(struct dalcs_system_reader *r) {
    dalcs_system_read_word(r);
    if (r->length > 0) {
        return dalcs_system_refuse(r, "the end of the line");
    }
    if (r->at < r->end) {
        r->at++;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_system_read_int(struct dalcs_system_reader *r, int first, int last,
                                        int *value) {
    dalcs_system_read_word(r);
    long long sum = 0;
    bool valid = r->length > 0 && r->length < 10;
    for (size_t k = 0; valid && k < r->length; k++) {
        valid = r->word[k] >= '0' && r->word[k] <= '9';
        sum = 10 * sum + (r->word[k] - '0');
    }
    if (!valid || sum < first || sum > last) {
        return dalcs_system_refuse(r,
                                   last < first ? "no such entry" : "a whole number in its range");
    }
    *value = (int)sum;
    return DALCS_OK;
}

enum dalcs_status dalcs_system_read_number(struct dalcs_system_reader *r, double *value) {
    dalcs_system_read_word(r);
    char text[64];
    struct dalcs_number number;
    if (r->length >= sizeof(text)) {
        return dalcs_system_refuse(r, "a number");
    }
    memcpy(text, r->word, r->length);
    text[r->length] = '\0';
    /* Suffixes are for netlists: a letter here is damage. */
    if (dalcs_number_parse(text, &number) != DALCS_NUMBER_OK ||
        (size_t)number.digits != r->length) {
        return dalcs_system_refuse(r, "a number");
    }
    *value = number.value;
    return DALCS_OK;
}

enum dalcs_status dalcs_system_read_choice(struct dalcs_system_reader *r, const char *const *choice,
                                           int n, const char *expected, int *index) {
    dalcs_system_read_word(r);
    for (*index = 0; *index < n && !dalcs_system_word_is(r, choice[*index]);) {
        ++*index;
    }
    return *index < n ? DALCS_OK : dalcs_system_refuse(r, expected);
}

enum dalcs_status dalcs_system_read_unit(struct dalcs_system_reader *r, bool *is_current) {
    static const char *const unit[] = {"V", "A"};
    int index;
    DALCS_TRY(dalcs_system_read_choice(r, unit, 2, "V or A", &index));
    *is_current = index == 1;
    return DALCS_OK;
}

enum dalcs_status dalcs_system_read_name(struct dalcs_system_reader *r, const char **name) {
    dalcs_system_read_word(r);
    if (r->length == 0 || memchr(r->word, '\0', r->length) != NULL) {
        return dalcs_system_refuse(r, "a name");
    }
    *name = dalcs_arena_copy(&r->file->arena, r->word, r->length);
    return *name == NULL ? DALCS_E_NOMEM : dalcs_system_end_line(r);
}
