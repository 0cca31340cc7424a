/* read_matrices.c - the cards `matrix NAME ...`: rows of numbers, entries, or a Matrix Market file. */
#include "reader.h"
#include "reading.h"

#include <math.h>
#include <string.h>

/* What a block's rows or columns are. */
enum extent {
    STATES,
    COORDINATES,
    UNKNOWNS,
    MULTIPLIERS,
    COLUMNS, /* states, unknowns and multipliers, side by side */
    INPUTS,
    ONE
};

static const struct {
    const char *name, *alias; /* as the lexer has them: lower case */
    enum extent rows, columns;
} BLOCKS[DALCS_N_BLOCKS] = {
    [DALCS_BLOCK_P] = {"p", "p_i", STATES, STATES},
    [DALCS_BLOCK_A_I] = {"a_i", "a", STATES, STATES},
    [DALCS_BLOCK_B_I] = {"b_i", NULL, STATES, UNKNOWNS},
    [DALCS_BLOCK_BBAR_I] = {"bbar_i", "b", STATES, MULTIPLIERS},
    [DALCS_BLOCK_E_I] = {"e_i", "e", STATES, INPUTS},
    [DALCS_BLOCK_CONSTANT_I] = {"constant_i", NULL, STATES, ONE},
    [DALCS_BLOCK_A_II] = {"a_ii", NULL, UNKNOWNS, STATES},
    [DALCS_BLOCK_B_II] = {"b_ii", NULL, UNKNOWNS, UNKNOWNS},
    [DALCS_BLOCK_BBAR_II] = {"bbar_ii", NULL, UNKNOWNS, MULTIPLIERS},
    [DALCS_BLOCK_E_II] = {"e_ii", NULL, UNKNOWNS, INPUTS},
    [DALCS_BLOCK_CONSTANT_II] = {"constant_ii", NULL, UNKNOWNS, ONE},
    [DALCS_BLOCK_C_I] = {"c_i", "c", MULTIPLIERS, STATES},
    [DALCS_BLOCK_C_II] = {"c_ii", NULL, MULTIPLIERS, UNKNOWNS},
    [DALCS_BLOCK_D] = {"d", NULL, MULTIPLIERS, MULTIPLIERS},
    [DALCS_BLOCK_F] = {"f", NULL, MULTIPLIERS, INPUTS},
    [DALCS_BLOCK_CONSTANT_F] = {"constant_f", NULL, MULTIPLIERS, ONE},
    [DALCS_BLOCK_STORAGE] = {"storage", NULL, STATES, STATES},
    [DALCS_BLOCK_CONTROL] = {"control", NULL, MULTIPLIERS, COLUMNS},
    [DALCS_BLOCK_DIRECT_CONTROL] = {"direct_control", NULL, MULTIPLIERS, INPUTS},
    [DALCS_BLOCK_MASS] = {"mass", NULL, COORDINATES, COORDINATES},
    [DALCS_BLOCK_DAMPING] = {"damping", NULL, COORDINATES, COORDINATES},
    [DALCS_BLOCK_STIFFNESS] = {"stiffness", NULL, COORDINATES, COORDINATES},
    [DALCS_BLOCK_FORCE] = {"force", NULL, COORDINATES, INPUTS},
    [DALCS_BLOCK_CONSTANT_FORCE] = {"constant_force", NULL, COORDINATES, ONE},
    [DALCS_BLOCK_G] = {"g", NULL, MULTIPLIERS, COORDINATES},
    [DALCS_BLOCK_CONSTANT_G] = {"constant_g", NULL, MULTIPLIERS, ONE},
};

static const char USAGE[] = "matrix name, then rows of numbers on lines that start with +";

bool dalcs_reading_is_matrix(const char *name) {
    bool found = false;
    for (size_t k = 0; k < DALCS_N_BLOCKS; k++) {
        found = found || strcmp(BLOCKS[k].name, name) == 0 ||
                (BLOCKS[k].alias != NULL && strcmp(BLOCKS[k].alias, name) == 0);
    }
    return found;
}

static int size_of(const struct dalcs_described_system *s, enum extent extent) {
    size_t size = 1;
    switch (extent) {
    case STATES:
        size = s->n_states;
        break;
    case COORDINATES:
        size = s->n_coordinates;
        break;
    case UNKNOWNS:
        size = s->n_unknowns;
        break;
    case MULTIPLIERS:
        size = s->n_multipliers;
        break;
    case COLUMNS:
        size = s->n_states + s->n_unknowns + s->n_multipliers;
        break;
    case INPUTS:
        size = s->n_inputs;
        break;
    case ONE:
        break;
    }
    return (int)size;
}

static const char *what_of(enum extent extent) {
    static const char *const what[] = {[STATES] = "states",     [COORDINATES] = "coordinates",
                                       [UNKNOWNS] = "unknowns", [MULTIPLIERS] = "multipliers",
                                       [COLUMNS] = "columns",   [INPUTS] = "inputs",
                                       [ONE] = "column"};
    return what[extent];
}

void dalcs_reading_take_matrix(struct dalcs_reading *r, struct dalcs_described_system *s,
                               const struct dalcs_card *card) {
    const char *names[DALCS_N_BLOCKS];
    if (card->n < 2) {
        struct dalcs_reader reader = dalcs_reader_start(&r->builder, card, USAGE);
        dalcs_reader_missing(&reader, "the name of a matrix");
        return;
    }
    const struct dalcs_token *name = &card->token[1];
    for (int k = 0; k < DALCS_N_BLOCKS; k++) {
        names[k] = BLOCKS[k].name;
        bool is_it = strcmp(name->text, BLOCKS[k].name) == 0 ||
                     (BLOCKS[k].alias != NULL && strcmp(name->text, BLOCKS[k].alias) == 0);
        if (is_it && s->block[k].card != NULL) {
            dalcs_builder_error(&r->builder, name, NULL, "a second matrix '%s', the first at %s",
                                name->text,
                                dalcs_builder_place(&r->builder, s->block[k].card->token));
            return;
        }
        if (is_it) {
            s->block[k].card = card;
            return;
        }
    }
    dalcs_builder_error(&r->builder, name,
                        dalcs_builder_suggest_of(&r->builder, names, DALCS_N_BLOCKS, name->text,
                                                 "doc/system-file.md lists the matrices"),
                        "no matrix is called '%s'", name->text);
}

/* ---- Entries ------------------------------------------------------------------------------- */

/* Where the lines are more than one, each is a row: a number too many in one and too few in the next
 * is a mistake. */
static bool check_lines(struct dalcs_reader *reader, int n_columns) {
    const struct dalcs_card *card = reader->card;
    int on_line = 0;
    for (int k = reader->at; k < card->n; k++) {
        bool starts = k == reader->at || card->token[k].line != card->token[k - 1].line;
        on_line = starts ? 1 : on_line + 1;
        bool ends = k + 1 == card->n || card->token[k + 1].line != card->token[k].line;
        if (ends && on_line % (n_columns > 0 ? n_columns : 1) != 0) {
            dalcs_builder_error(reader->builder, &card->token[k], NULL,
                                "this row has %d numbers, the matrix %d columns", on_line,
                                n_columns);
            return false;
        }
    }
    return true;
}

static bool read_rows(struct dalcs_reader *reader, int n_rows, int n_columns,
                      struct dalcs_triplets *entries) {
    long n = reader->card->n - reader->at;
    if (n != (long)n_rows * n_columns) {
        dalcs_builder_error(reader->builder, &reader->card->token[1], USAGE,
                            "the matrix is %d by %d, but %ld number%s follow%s", n_rows, n_columns,
                            n, n == 1 ? "" : "s", n == 1 ? "s" : "");
        return false;
    }
    if (!check_lines(reader, n_columns)) {
        return false;
    }
    for (int i = 0; i < n_rows; i++) {
        for (int j = 0; j < n_columns; j++) {
            double value;
            if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "a number", &value)) {
                return false;
            }
            if (value != 0.0 && dalcs_triplets_add(entries, i, j, value) != DALCS_OK) {
                reader->builder->out_of_memory = true;
                return false;
            }
        }
    }
    return true;
}

static bool read_index(struct dalcs_reader *reader, int n, const char *what, int *index) {
    double value;
    if (!dalcs_reader_list_number(reader, DALCS_PLAIN, what, &value)) {
        return false;
    }
    if (!(value >= 1.0 && value <= n) || value != floor(value)) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                            "%s lies between 1 and %d", what, n);
        return false;
    }
    *index = (int)value - 1;
    return true;
}

static bool read_entries(struct dalcs_reader *reader, int n_rows, int n_columns,
                         struct dalcs_triplets *entries) {
    reader->usage = "matrix name sparse, then row, column and value of each entry";
    while (!dalcs_reader_at_end(reader)) {
        int i;
        int j;
        double value;
        if (!read_index(reader, n_rows, "a row", &i) ||
            !read_index(reader, n_columns, "a column", &j) ||
            !dalcs_reader_list_number(reader, DALCS_PLAIN, "a value", &value)) {
            return false;
        }
        if (dalcs_triplets_add(entries, i, j, value) != DALCS_OK) {
            reader->builder->out_of_memory = true;
            return false;
        }
    }
    return true;
}

static void fill_block(struct dalcs_reading *r, struct dalcs_described_system *s, int k) {
    struct dalcs_block *block = &s->block[k];
    struct dalcs_reader reader = dalcs_reader_start(&r->builder, block->card, USAGE);
    int n_rows = size_of(s, BLOCKS[k].rows);
    int n_columns = size_of(s, BLOCKS[k].columns);
    reader.at = 2;
    const struct dalcs_token *next = dalcs_reader_peek(&reader, 0);
    if (n_rows == 0 || n_columns == 0) {
        dalcs_builder_error(&r->builder, &block->card->token[1], NULL,
                            "'%s' is a matrix of %s by %s, of which the system has no %s",
                            block->card->token[1].text, what_of(BLOCKS[k].rows),
                            what_of(BLOCKS[k].columns),
                            what_of(n_rows == 0 ? BLOCKS[k].rows : BLOCKS[k].columns));
    } else if (next != NULL && next->kind == DALCS_TOKEN_STRING) {
        reader.at++;
        if (dalcs_reader_end(&reader)) {
            (void)dalcs_matrix_market_read(&r->builder, next, n_rows, n_columns, &block->entries);
        }
    } else if (dalcs_reader_take_word(&reader, "sparse")) {
        (void)read_entries(&reader, n_rows, n_columns, &block->entries);
    } else {
        (void)read_rows(&reader, n_rows, n_columns, &block->entries);
    }
}

static bool is_mechanical(int block) {
    return block >= DALCS_BLOCK_MASS;
}

enum dalcs_status dalcs_reading_fill_blocks(struct dalcs_reading *r,
                                            struct dalcs_described_system *s) {
    for (int k = 0; k < DALCS_N_BLOCKS && !r->builder.out_of_memory; k++) {
        const struct dalcs_card *card = s->block[k].card;
        if (card == NULL) {
            continue;
        }
        if (is_mechanical(k) != (s->n_coordinates > 0)) {
            dalcs_builder_error(&r->builder, &card->token[1], NULL,
                                s->n_coordinates > 0 ? "a system of coordinates has no matrix '%s'"
                                                     : "'%s' is a matrix of systems of coordinates",
                                card->token[1].text);
            continue;
        }
        fill_block(r, s, k);
    }
    return r->builder.out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
}
