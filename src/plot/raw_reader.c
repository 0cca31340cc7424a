/* raw_reader.c - SPICE's raw files: a text header, then numbers, as text or as bytes; plot after
 * plot. Written from what ngspice writes (its manual, section 11.4) and what spicelib reads.
 *
 * A count in a header is what a writer meant; how many points there are is what the file has room
 * for. An interrupted writer leaves 0 there and a last point cut short. */
#include "raw_header.h"
#include "waveforms.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static enum dalcs_status refuse(struct dalcs_diag *diag, const char *path, const char *hint,
                                const char *what) {
    dalcs_diag_add(diag, DALCS_ERROR, NULL, hint, "'%s': %s", path, what);
    return DALCS_E_OPTION;
}

/* ---- One plot ------------------------------------------------------------------------------- */

static const struct {
    const char *word;
    struct dalcs_dimension dimension;
} of_type[] = {{"voltage", {.volt = 1}},          {"current", {.ampere = 1}},
               {"time", {.second = 1}},           {"frequency", {.second = -1}},
               {"device_current", {.ampere = 1}}, {"subckt_current", {.ampere = 1}}};

static struct dalcs_dimension find_dimension(const char *type, size_t length, const char *name) {
    for (size_t i = 0; i < sizeof of_type / sizeof of_type[0]; i++) {
        if (strlen(of_type[i].word) == length && strncasecmp(type, of_type[i].word, length) == 0) {
            return of_type[i].dimension;
        }
    }
    return dalcs_dimension_of_name(name);
}

/* The next word of a line; NULL when there is none. */
static const char *next_word(const char **at, const char *end, size_t *length) {
    while (*at < end && (**at == ' ' || **at == '\t')) {
        ++*at;
    }
    const char *word = *at;
    while (*at < end && **at != ' ' && **at != '\t') {
        ++*at;
    }
    *length = (size_t)(*at - word);
    return *length > 0 ? word : NULL;
}

static bool is_printable(const char *text, size_t length) {
    for (size_t i = 0; i < length; i++) {
        if ((unsigned char)text[i] < 0x20 || text[i] == 0x7f) {
            return false;
        }
    }
    return true;
}

/* "index name type": the name and dimension of column c, and of its phase behind it. */
static enum dalcs_status read_variable(struct dalcs_waveforms *waveforms, const char *line,
                                       size_t length, size_t c, bool with_phase) {
    const char *at = line, *end = line + length;
    size_t n = 0, n_type = 0;
    const char *name = next_word(&at, end, &n) ? next_word(&at, end, &n) : NULL;
    if (!name || !is_printable(name, n)) {
        return DALCS_E_OPTION;
    }
    const char *type = next_word(&at, end, &n_type);
    char *copy = dalcs_arena_copy(&waveforms->arena, name, n);
    if (!copy) {
        return DALCS_E_NOMEM;
    }
    waveforms->name[c] = copy;
    waveforms->dimension[c] = find_dimension(type ? type : "", n_type, copy);
    if (with_phase) {
        waveforms->name[c + 1] = dalcs_arena_printf(&waveforms->arena, "phase(%s)", copy);
        waveforms->dimension[c + 1] = (struct dalcs_dimension){.degree = true};
        return waveforms->name[c + 1] ? DALCS_OK : DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

static enum dalcs_status read_variables(struct dalcs_waveforms *waveforms,
                                        const struct dalcs_raw_plot *plot,
                                        const struct dalcs_raw_text *all) {
    struct dalcs_raw_text text = {plot->variables, all->end};
    size_t n = plot->n_variables, c = 0;
    DALCS_TRY(dalcs_waveforms_set_columns(waveforms, plot->complex_values ? 2 * n - 1 : n));
    for (size_t i = 0; i < n; i++) {
        const char *line = NULL;
        size_t length = 0;
        bool with_phase = plot->complex_values && i > 0;
        if (!dalcs_raw_next_line(&text, &line, &length)) {
            return DALCS_E_OPTION;
        }
        DALCS_TRY(read_variable(waveforms, line, length, c, with_phase));
        c += with_phase ? 2 : 1;
    }
    return DALCS_OK;
}

/* A number of the file becomes one column, a complex one magnitude and phase in degrees. */
static double *put(double *cell, bool axis, bool complex_values, double re, double im) {
    if (axis || !complex_values) {
        *cell++ = re;
        return cell;
    }
    *cell++ = hypot(re, im);
    *cell++ = atan2(im, re) * (180.0 / acos(-1.0));
    return cell;
}

/* Where value i of a point is in a file that goes signal by signal. */
static size_t place_by_signal(const struct dalcs_raw_plot *plot, size_t row, size_t i,
                              size_t width) {
    const size_t axis = (plot->complex_values ? 2 : 1) * sizeof(double) * plot->n_points;
    return i == 0 ? row * (axis / plot->n_points) : axis + ((i - 1) * plot->n_points + row) * width;
}

static void read_binary(struct dalcs_waveforms *waveforms, const struct dalcs_raw_plot *plot) {
    const size_t wide = (plot->complex_values ? 2 : 1) * sizeof(double);
    const size_t width = dalcs_raw_is_single(plot) ? sizeof(float) : wide;
    double *cell = waveforms->value;
    const char *at = plot->data;
    for (size_t k = 0; k < plot->n_points * plot->n_variables; k++) {
        const size_t i = k % plot->n_variables;
        const size_t size = i == 0 ? wide : width;
        const char *from = plot->by_signal
                               ? plot->data + place_by_signal(plot, k / plot->n_variables, i, width)
                               : at;
        double part[2] = {0.0, 0.0};
        float single;
        if (size == sizeof single) {
            memcpy(&single, from, size);
            part[0] = single;
        } else {
            memcpy(part, from, size);
        }
        at += size;
        cell = put(cell, i == 0, plot->complex_values, part[0], part[1]);
    }
    waveforms->n_rows = plot->n_points;
    for (size_t c = 0; c < waveforms->n_columns; c++) {
        waveforms->precision[c].relative = dalcs_raw_is_single(plot) && c > 0 ? 0x1p-24 : 0x1p-53;
    }
}

/* Times of LTspice. */
static void shift_axis(struct dalcs_waveforms *waveforms, const struct dalcs_raw_plot *plot) {
    for (size_t k = 0; k < waveforms->n_rows && plot->is_ltspice; k++) {
        double *time = &waveforms->value[k * waveforms->n_columns];
        *time = (waveforms->dimension[0].second == 1 ? fabs(*time) : *time) + plot->offset;
    }
}

static bool next_number(const char **at, const char *end, double *value) {
    char *rest = NULL;
    *value = strtod(*at, &rest);
    bool found = rest != *at && rest <= end;
    *at = found ? rest : *at;
    return found;
}

/* Each point is its number, then its values. What is not whole at the end is left out. */
static void read_ascii(struct dalcs_waveforms *waveforms, const struct dalcs_raw_plot *plot,
                       const struct dalcs_raw_text *all) {
    const char *at = plot->data;
    for (size_t row = 0; row < plot->n_points; row++) {
        double *cell = waveforms->value + row * waveforms->n_columns;
        double number = 0.0;
        if (!next_number(&at, all->end, &number)) {
            return;
        }
        for (size_t i = 0; i < plot->n_variables; i++) {
            double re = 0.0, im = 0.0;
            const char *from = at;
            if (!next_number(&at, all->end, &re)) {
                return;
            }
            if (!plot->complex_values) {
                dalcs_digits_note(&waveforms->digits[i], from, at);
            }
            if (plot->complex_values && at < all->end && *at == ',') {
                at++;
                if (!next_number(&at, all->end, &im)) {
                    return;
                }
            }
            cell = put(cell, i == 0, plot->complex_values, re, im);
        }
        waveforms->n_rows = row + 1;
    }
}

static const char *copy_line(struct dalcs_arena *arena, const char *at, const char *end) {
    struct dalcs_raw_text text = {at, end};
    const char *line = "";
    size_t length = 0;
    if (at) {
        (void)dalcs_raw_next_line(&text, &line, &length);
    }
    return dalcs_arena_copy(arena, line, length);
}

static enum dalcs_status read_plot(struct dalcs_waveforms *waveforms,
                                   const struct dalcs_raw_plot *plot,
                                   const struct dalcs_raw_text *all) {
    waveforms->title = copy_line(&waveforms->arena, plot->title, all->end);
    waveforms->plot_name = copy_line(&waveforms->arena, plot->name, all->end);
    waveforms->complex_values = plot->complex_values;
    if (!waveforms->title || !waveforms->plot_name) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(read_variables(waveforms, plot, all));
    waveforms->value = dalcs_alloc(plot->n_points, waveforms->n_columns * sizeof(double));
    if (!waveforms->value) {
        return DALCS_E_NOMEM;
    }
    if (plot->ascii) {
        read_ascii(waveforms, plot, all);
    } else {
        read_binary(waveforms, plot);
    }
    shift_axis(waveforms, plot);
    return DALCS_OK;
}

/* The header of the next plot, good or bad; false behind the last one. */
static enum dalcs_status next_plot(struct dalcs_raw_plot *plot, struct dalcs_raw_text *text,
                                   const char *path, struct dalcs_diag *diag) {
    dalcs_raw_read_header(plot, text);
    if (!plot->data) {
        return refuse(diag, path, NULL, "the header of the raw file has no 'Binary:' or 'Values:'");
    }
    /* A line of a variable has 4 bytes at least: "0 a\n". */
    size_t most = (size_t)(plot->data - (plot->variables ? plot->variables : plot->data)) / 4;
    if (plot->n_variables == 0 || plot->n_variables > most) {
        return refuse(diag, path, NULL, "the raw file does not list its variables");
    }
    dalcs_raw_skip_points(plot, text);
    return DALCS_OK;
}

static bool is_blank(const struct dalcs_raw_text *text) {
    for (const char *c = text->at; c < text->end; c++) {
        if (*c != '\n' && *c != '\r' && *c != ' ' && *c != '\0') {
            return false;
        }
    }
    return true;
}

enum dalcs_status dalcs_waveforms_read_raw(struct dalcs_waveforms *waveforms, const char *path,
                                           const char *text, size_t length, size_t plot,
                                           struct dalcs_diag *diag) {
    const struct dalcs_raw_text all = {text, text + length};
    struct dalcs_raw_text rest = all;
    struct dalcs_raw_plot chosen = {0};
    size_t n = 0;
    while (!is_blank(&rest)) {
        struct dalcs_raw_plot next;
        if (n > 0 && !dalcs_waveforms_is_raw(rest.at, (size_t)(rest.end - rest.at))) {
            break; /* the last point of an interrupted writer */
        }
        DALCS_TRY(next_plot(&next, &rest, path, diag));
        n++;
        if (plot == n || (plot == 0 && (n == 1 || next.n_points > 1 || chosen.n_points < 2))) {
            chosen = next;
            waveforms->plot = n;
        }
    }
    waveforms->n_plots = n;
    if (!chosen.data) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "'%s' has %zu plot%s: there is no plot %zu",
                       path, n, n == 1 ? "" : "s", plot);
        return DALCS_E_OPTION;
    }
    enum dalcs_status status = read_plot(waveforms, &chosen, &all);
    return status == DALCS_E_OPTION
               ? refuse(diag, path, NULL, "the raw file does not list its variables")
               : status;
}
