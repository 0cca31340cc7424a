/* csv_reader.c - comma-separated values with a header line, as RFC 4180 has them; also separated by
 * semicolons, tabs or blanks. The first column is the axis. */
#include "waveforms.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct reader {
    const char *at, *end;
    char separator;
    long line;
};

/* The separator of a header: the first that stands outside of quotes and parentheses, a blank where there is no other. */
static char find_separator(const char *text, const char *end) {
    int depth = 0;
    bool quoted = false;
    char separator = '\0';
    for (const char *c = text; c < end && *c != '\n'; c++) {
        quoted = *c == '"' ? !quoted : quoted;
        depth += *c == '(' ? 1 : *c == ')' ? -1 : 0;
        if (!quoted && depth <= 0 && strchr(",;\t", *c) && *c != '\0') {
            return *c;
        }
        separator = !quoted && depth <= 0 && *c == ' ' ? ' ' : separator;
    }
    return separator != '\0' ? separator : ',';
}

static bool at_line_end(const struct reader *reader) {
    return reader->at >= reader->end || *reader->at == '\n' || *reader->at == '\r';
}

static void skip_blanks(struct reader *reader) {
    while (!at_line_end(reader) && (*reader->at == ' ' || *reader->at == '\t') &&
           (reader->separator == ' ' || *reader->at != reader->separator)) {
        reader->at++;
    }
}

static void end_line(struct reader *reader) {
    while (reader->at < reader->end && *reader->at != '\n') {
        reader->at++;
    }
    reader->at += reader->at < reader->end ? 1 : 0;
    reader->line++;
}

/* Takes the separator behind a field; false at the end of the line. */
static bool take_separator(struct reader *reader) {
    bool blank = reader->separator == ' ' && !at_line_end(reader) && *reader->at == ' ';
    skip_blanks(reader);
    if (at_line_end(reader)) {
        return false;
    }
    if (blank) {
        return true;
    }
    if (*reader->at == reader->separator) {
        reader->at++;
        return true;
    }
    return false;
}

/* The next field of the header into name[]; returns its length. A comma in v(a,b) belongs to it,
 * quoted or not. */
static size_t read_name(struct reader *reader, char *name) {
    size_t n = 0;
    int depth = 0;
    skip_blanks(reader);
    bool quoted = !at_line_end(reader) && *reader->at == '"';
    reader->at += quoted ? 1 : 0;
    for (; !at_line_end(reader); reader->at++) {
        char c = *reader->at;
        if (quoted && c == '"') {
            bool twice = reader->at + 1 < reader->end && reader->at[1] == '"';
            reader->at++;
            if (!twice) {
                break;
            }
        } else if (!quoted && depth <= 0 && c == reader->separator) {
            break;
        }
        depth += c == '(' ? 1 : c == ')' ? -1 : 0;
        name[n++] = c;
    }
    while (n > 0 && (name[n - 1] == ' ' || name[n - 1] == '\t')) {
        n--;
    }
    return n;
}

static bool is_netlist_name(const char *path) {
    static const char *const endings[] = {".cir", ".net", ".sp", ".ckt", ".spice"};
    const char *dot = strrchr(path, '.');
    bool found = false;
    for (size_t k = 0; dot != NULL && k < sizeof endings / sizeof endings[0]; k++) {
        found = found || strcasecmp(dot, endings[k]) == 0;
    }
    return found;
}

static enum dalcs_status refuse(const struct reader *reader, const char *path,
                                struct dalcs_diag *diag) {
    dalcs_diag_add(
        diag, DALCS_ERROR, NULL,
        is_netlist_name(path)
            ? "this is a netlist: 'dalcs run' writes its waveforms, and draws them with --plot"
            : "waveforms are read from .raw files of SPICE and .csv files whose first line has "
              "names",
        "'%s' holds no waveforms: line %ld is neither of a raw file nor of a table", path,
        reader->line);
    return DALCS_E_OPTION;
}

/* An empty field is no number. */
static bool read_number(struct reader *reader, double *value) {
    skip_blanks(reader);
    if (at_line_end(reader) || *reader->at == reader->separator) {
        *value = NAN;
        return true;
    }
    char *rest = NULL;
    *value = strtod(reader->at, &rest);
    bool found = rest != reader->at && rest <= reader->end;
    reader->at = found ? rest : reader->at;
    return found;
}

static bool begins_with_number(struct reader reader, const char *line) {
    double value;
    reader.at = line;
    return read_number(&reader, &value);
}

/* Of a row: which of its fields is no number, or how many it has. */
static enum dalcs_status refuse_row(const struct dalcs_waveforms *waveforms, struct reader reader,
                                    const char *line, const char *path, struct dalcs_diag *diag) {
    size_t n = 0;
    double value;
    bool more = true;
    reader.at = line;
    while (more && read_number(&reader, &value)) {
        n++;
        more = take_separator(&reader);
    }
    const size_t wanted = waveforms->n_columns;
    if (at_line_end(&reader) && n != wanted) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL,
                       "'%s': line %ld has %zu value%s, and the first line has %zu names", path,
                       reader.line, n, n == 1 ? "" : "s", wanted);
    } else if (at_line_end(&reader)) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "'%s': line %ld has no value of '%s'", path,
                       reader.line, waveforms->name[0]);
    } else {
        const size_t column = n < wanted ? n : wanted - 1;
        size_t length = strcspn(reader.at, ",;\t\r\n");
        length = length < 20 ? length : 20;
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL,
                       "'%s': line %ld: '%.*s' is no number for '%s'", path, reader.line,
                       (int)length, reader.at, waveforms->name[column]);
    }
    return DALCS_E_OPTION;
}

static bool is_text(const char *name, size_t length) {
    for (size_t i = 0; i < length; i++) {
        if ((unsigned char)name[i] < 0x20 || name[i] == 0x7f) {
            return false;
        }
    }
    return length > 0;
}

static enum dalcs_status read_header(struct dalcs_waveforms *waveforms, struct reader *reader,
                                     const char *path, struct dalcs_diag *diag) {
    const char *line_end = memchr(reader->at, '\n', (size_t)(reader->end - reader->at));
    size_t length = (size_t)((line_end ? line_end : reader->end) - reader->at);
    struct dalcs_arena *arena = &waveforms->arena;
    char *name = dalcs_arena_alloc(arena, length + 1, 1);
    size_t n = 0, capacity = length / 2 + 2; /* no more fields than that */
    if (!name) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_waveforms_set_columns(waveforms, capacity));
    bool more = true;
    while (more && n < capacity) {
        size_t n_name = read_name(reader, name);
        char *rest = NULL;
        char *copy = dalcs_arena_copy(arena, name, n_name);
        if (!copy) {
            return DALCS_E_NOMEM;
        }
        (void)strtod(copy, &rest);
        if (!is_text(copy, n_name) || *rest == '\0') { /* a number is no name */
            return refuse(reader, path, diag);
        }
        waveforms->name[n] = copy;
        waveforms->dimension[n++] = dalcs_dimension_of_name(copy);
        more = take_separator(reader);
    }
    waveforms->n_columns = n;
    bool whole = at_line_end(reader);
    if (whole) {
        end_line(reader);
    }
    return whole ? DALCS_OK : refuse(reader, path, diag);
}

/* A table of many runs says in its last column why one failed. */
static bool has_reasons(const struct dalcs_waveforms *waveforms) {
    return strcmp(waveforms->name[waveforms->n_columns - 1], "error") == 0;
}

static bool read_row(struct reader *reader, double *cell, const struct dalcs_waveforms *waveforms) {
    const size_t n = waveforms->n_columns;
    struct dalcs_digits *digits = waveforms->digits;
    for (size_t i = 0; i < n; i++) {
        const char *from = reader->at;
        if (i > 0 && i + 1 == n && has_reasons(waveforms)) {
            cell[i] = NAN;
            while (!at_line_end(reader)) {
                reader->at++;
            }
            break;
        }
        if (!read_number(reader, &cell[i])) {
            return false;
        }
        dalcs_digits_note(&digits[i], from, reader->at);
        if (take_separator(reader) != (i + 1 < n)) {
            return false;
        }
    }
    return at_line_end(reader) && isfinite(cell[0]);
}

enum dalcs_status dalcs_waveforms_read_csv(struct dalcs_waveforms *waveforms, const char *path,
                                           const char *text, size_t length,
                                           struct dalcs_diag *diag) {
    struct reader reader = {text, text + length, find_separator(text, text + length), 1};
    static const char byte_order_mark[] = "\357\273\277";
    size_t capacity = 0;
    if (length >= 3 && memcmp(text, byte_order_mark, 3) == 0) {
        reader.at += 3;
    }
    waveforms->n_plots = waveforms->plot = 1;
    DALCS_TRY(read_header(waveforms, &reader, path, diag));
    size_t n = waveforms->n_columns;
    while (reader.at < reader.end) {
        bool unended = !memchr(reader.at, '\n', (size_t)(reader.end - reader.at));
        skip_blanks(&reader);
        if (at_line_end(&reader)) {
            end_line(&reader);
            continue;
        }
        const char *line = reader.at;
        DALCS_TRY(dalcs_grow(&waveforms->value, &capacity, (waveforms->n_rows + 1) * n,
                             sizeof *waveforms->value));
        if (read_row(&reader, waveforms->value + waveforms->n_rows * n, waveforms)) {
            waveforms->n_rows++;
        } else if (!unended) { /* a last line without its end may be cut short */
            return waveforms->n_rows > 0 || begins_with_number(reader, line)
                       ? refuse_row(waveforms, reader, line, path, diag)
                       : refuse(&reader, path, diag); /* it is no table */
        }
        end_line(&reader);
    }
    return DALCS_OK;
}
