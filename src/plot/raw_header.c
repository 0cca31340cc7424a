/* raw_header.c - the lines of a raw file's header, and how many points its numbers are.
 *
 * LTspice's binary files have times of 8 bytes and, of real signals, values of 4, unless a flag says "double";
 * with the flag "fastaccess" signal after signal. The sign of a time marks a point that was kept when others
 * were left out, and all times are counted from the header's offset. */
#include "raw_header.h"

#include "waveforms.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

bool dalcs_raw_next_line(struct dalcs_raw_text *text, const char **line, size_t *length) {
    if (text->at >= text->end) {
        return false;
    }
    const char *newline = memchr(text->at, '\n', (size_t)(text->end - text->at));
    const char *end = newline ? newline : text->end;
    *line = text->at;
    *length = (size_t)(end - text->at);
    if (*length > 0 && end[-1] == '\r') {
        --*length;
    }
    text->at = newline ? newline + 1 : text->end;
    return true;
}

/* What follows "key:" on a line; NULL when it is another line. */
static const char *value_of(const char *line, size_t length, const char *key) {
    size_t n = strlen(key);
    if (length < n + 1 || strncasecmp(line, key, n) != 0 || line[n] != ':') {
        return NULL;
    }
    const char *value = line + n + 1;
    return value + (value < line + length && *value == ' ' ? 1 : 0);
}

bool dalcs_waveforms_is_raw(const char *text, size_t length) {
    return value_of(text, length, "Title") || value_of(text, length, "Plotname");
}

static bool has_word(const char *text, size_t length, const char *word) {
    const size_t n = strlen(word);
    for (size_t k = 0; k + n <= length; k++) {
        if (strncasecmp(text + k, word, n) == 0) {
            return true;
        }
    }
    return false;
}

/* The number format, from the header. */
static void read_flags(struct dalcs_raw_plot *plot, const char *value, const char *end) {
    const size_t length = (size_t)(end - value);
    plot->complex_values = strncasecmp(value, "complex", 7) == 0;
    plot->says_double = has_word(value, length, "double");
    plot->by_signal = has_word(value, length, "fastaccess");
}

void dalcs_raw_read_header(struct dalcs_raw_plot *plot, struct dalcs_raw_text *text) {
    const char *line = NULL, *value;
    size_t length = 0;
    *plot = (struct dalcs_raw_plot){0};
    while (!plot->data && dalcs_raw_next_line(text, &line, &length)) {
        if ((value = value_of(line, length, "Title"))) {
            plot->title = value;
        } else if ((value = value_of(line, length, "Plotname"))) {
            plot->name = value;
        } else if ((value = value_of(line, length, "Flags"))) {
            read_flags(plot, value, line + length);
        } else if ((value = value_of(line, length, "Offset"))) {
            plot->offset = strtod(value, NULL);
        } else if ((value = value_of(line, length, "Command"))) {
            plot->is_ltspice = has_word(value, (size_t)(line + length - value), "LTspice");
        } else if ((value = value_of(line, length, "No. Variables"))) {
            plot->n_variables = strtoul(value, NULL, 10);
        } else if ((value = value_of(line, length, "No. Points"))) {
            plot->n_points = strtoul(value, NULL, 10);
        } else if (value_of(line, length, "Variables")) {
            plot->variables = text->at;
            for (size_t i = 0; i < plot->n_variables && dalcs_raw_next_line(text, &line, &length);
                 i++) {
            }
        } else if (value_of(line, length, "Binary") || value_of(line, length, "Values")) {
            plot->ascii = value_of(line, length, "Values") != NULL;
            plot->data = text->at;
        }
    }
}

bool dalcs_raw_is_single(const struct dalcs_raw_plot *plot) {
    return plot->is_ltspice && !plot->ascii && !plot->complex_values && !plot->says_double;
}

/* Bytes that a point takes, at least. */
static size_t point_size(const struct dalcs_raw_plot *plot) {
    size_t parts = plot->complex_values ? 2 : 1;
    size_t others = plot->n_variables - 1;
    return dalcs_raw_is_single(plot)
               ? sizeof(double) + others * sizeof(float)
               : plot->n_variables * parts * (plot->ascii ? 2 : sizeof(double));
}

/* A plot that another one follows has the points that it says; where it says 0 all that is left
 * belongs to it. */
static size_t count_points(const struct dalcs_raw_plot *plot, const struct dalcs_raw_text *text) {
    size_t room = (size_t)(text->end - plot->data) / point_size(plot);
    return plot->n_points == 0 || plot->n_points > room ? room : plot->n_points;
}

void dalcs_raw_skip_points(struct dalcs_raw_plot *plot, struct dalcs_raw_text *text) {
    plot->n_points = count_points(plot, text);
    if (!plot->ascii) {
        text->at = plot->data + plot->n_points * point_size(plot);
        return;
    }
    const char *line = NULL;
    size_t length = 0;
    struct dalcs_raw_text before = *text;
    while (dalcs_raw_next_line(text, &line, &length)) {
        if (value_of(line, length, "Title") || value_of(line, length, "Plotname")) {
            *text = before;
            return;
        }
        before = *text;
    }
}
