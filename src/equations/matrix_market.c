/* matrix_market.c - reading a matrix from a Matrix Market file (Boisvert, Pozo and Remington, NISTIR
 * 5935, 1996): coordinate or array, real or integer, general, symmetric or skew-symmetric. */
#include "reading.h"

#include "lower_case.h"
#include "number.h"
#include "text_file.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct market {
    struct dalcs_builder *builder;
    const struct dalcs_token *token;
    const char *path;
    const char *at;
    int line;
    bool is_array, is_symmetric, is_skew;
};

/* The name beside the file that names it. */
static const char *find_path(struct dalcs_builder *builder, const struct dalcs_token *token) {
    const char *base = token->line->source->name;
    const char *slash = strrchr(base, '/');
    if (token->text[0] == '/' || slash == NULL) {
        return token->text;
    }
    const char *path =
        dalcs_arena_printf(&builder->scratch, "%.*s%s", (int)(slash + 1 - base), base, token->text);
    builder->out_of_memory = builder->out_of_memory || path == NULL;
    return path;
}

static bool refuse(struct market *m, const char *expected) {
    dalcs_builder_error(m->builder, m->token, NULL, "%s:%d: expected %s", m->path, m->line,
                        expected);
    return false;
}

/* The next word over any number of lines; of length 0 at the end. */
static size_t next_word(struct market *m, const char **word) {
    const char *s = m->at;
    for (;;) {
        s += strspn(s, " \t\r");
        if (*s == '\n') {
            m->line++;
            s++;
        } else if (*s == '%') {
            s += strcspn(s, "\n");
        } else {
            break;
        }
    }
    *word = s;
    m->at = s + strcspn(s, " \t\r\n");
    return (size_t)(m->at - s);
}

static bool next_number(struct market *m, double *value) {
    const char *word;
    char text[64];
    struct dalcs_number number;
    size_t length = next_word(m, &word);
    if (length == 0 || length >= sizeof text) {
        return refuse(m, "a number");
    }
    memcpy(text, word, length);
    text[length] = '\0';
    if (dalcs_number_parse(text, &number) != DALCS_NUMBER_OK || (size_t)number.digits != length) {
        return refuse(m, "a number");
    }
    *value = number.value;
    return true;
}

static bool next_index(struct market *m, int most, int *index) {
    double value;
    if (!next_number(m, &value)) {
        return false;
    }
    if (!(value >= 0.0 && value <= most) || value != floor(value)) {
        return refuse(m, "a whole number in its range");
    }
    *index = (int)value;
    return true;
}

/* Is the first line's next word this one, in any case? */
static bool take(const char **at, const char *word) {
    size_t n = strlen(word);
    const char *s = *at + strspn(*at, " \t");
    for (size_t k = 0; k < n; k++) {
        if (dalcs_lower(s[k]) != word[k]) {
            return false;
        }
    }
    if (strchr(" \t\r\n", s[n]) == NULL) { /* also the end of the text */
        return false;
    }
    *at = s + n;
    return true;
}

static bool read_banner(struct market *m) {
    const char *s = m->at;
    bool ok = take(&s, "%%matrixmarket") && take(&s, "matrix");
    m->is_array = ok && take(&s, "array");
    ok = ok && (m->is_array || take(&s, "coordinate"));
    ok = ok && (take(&s, "real") || take(&s, "integer") || take(&s, "double"));
    m->is_skew = ok && take(&s, "skew-symmetric");
    m->is_symmetric = ok && !m->is_skew && take(&s, "symmetric");
    ok = ok && (m->is_skew || m->is_symmetric || take(&s, "general"));
    if (!ok) {
        return refuse(m, "'%%MatrixMarket matrix coordinate|array real|integer "
                         "general|symmetric|skew-symmetric'");
    }
    m->at = s;
    return true;
}

static bool add(struct market *m, struct dalcs_triplets *entries, int i, int j, double value) {
    bool mirrored = (m->is_symmetric || m->is_skew) && i != j;
    if (value == 0.0) {
        return true;
    }
    if (dalcs_triplets_add(entries, i, j, value) != DALCS_OK ||
        (mirrored && dalcs_triplets_add(entries, j, i, m->is_skew ? -value : value) != DALCS_OK)) {
        m->builder->out_of_memory = true;
        return false;
    }
    return true;
}

static bool read_array(struct market *m, int n_rows, int n_columns,
                       struct dalcs_triplets *entries) {
    bool half = m->is_symmetric || m->is_skew;
    for (int j = 0; j < n_columns; j++) {
        for (int i = half ? j + m->is_skew : 0; i < n_rows; i++) {
            double value;
            if (!next_number(m, &value) || !add(m, entries, i, j, value)) {
                return false;
            }
        }
    }
    return true;
}

static bool read_coordinates(struct market *m, int n_rows, int n_columns, int n,
                             struct dalcs_triplets *entries) {
    for (int k = 0; k < n; k++) {
        int i;
        int j;
        double value;
        if (!next_index(m, n_rows, &i) || !next_index(m, n_columns, &j) ||
            !next_number(m, &value)) {
            return false;
        }
        if (i == 0 || j == 0) {
            return refuse(m, "indices that count from 1");
        }
        if (!add(m, entries, i - 1, j - 1, value)) {
            return false;
        }
    }
    return true;
}

static bool read_text(struct market *m, int n_rows, int n_columns, struct dalcs_triplets *entries) {
    int rows;
    int columns;
    int n = 0;
    if (!read_banner(m) || !next_index(m, INT_MAX / 2, &rows) ||
        !next_index(m, INT_MAX / 2, &columns) ||
        (!m->is_array && !next_index(m, INT_MAX / 2, &n))) {
        return false;
    }
    if (rows != n_rows || columns != n_columns) {
        dalcs_builder_error(m->builder, m->token, NULL,
                            "the matrix is %d by %d, that of the file %d by %d", n_rows, n_columns,
                            rows, columns);
        return false;
    }
    bool ok = m->is_array ? read_array(m, rows, columns, entries)
                          : read_coordinates(m, rows, columns, n, entries);
    const char *word;
    if (ok && next_word(m, &word) > 0) {
        return refuse(m, "the end of the file");
    }
    return ok;
}

bool dalcs_matrix_market_read(struct dalcs_builder *builder, const struct dalcs_token *token,
                              int n_rows, int n_columns, struct dalcs_triplets *entries) {
    const char *path = find_path(builder, token);
    if (path == NULL) {
        return false;
    }
    struct dalcs_diag said = {0};
    char *text = NULL;
    size_t length;
    bool ok = false;
    enum dalcs_status status = dalcs_text_file_read(path, INT_MAX, &text, &length, NULL, &said);
    if (status == DALCS_E_IO) {
        dalcs_builder_error(builder, token, NULL, "cannot read the matrix in %s", path);
    } else if (status != DALCS_OK) {
        builder->out_of_memory = true;
    } else {
        struct market m = {.builder = builder, .token = token, .path = path, .at = text, .line = 1};
        ok = read_text(&m, n_rows, n_columns, entries);
    }
    dalcs_diag_finish(&said);
    free(text);
    return ok;
}
