/* page.c - fills page.html: data as JSON, numbers in it as base64 of their bytes, lowest first. */
#include "page.h"

#include "page_json.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#ifdef DALCS_WITH_DYGRAPHS
#include "embedded.h"

/* A browser holds a string of half a gigabyte; that many values take a quarter of it. */
enum { MAX_VALUES = 24000000, MAX_EXACT = 1000000 };

/* The table, column after column: the axis, then the signals. */
struct columns {
    size_t n_signals, n_rows, room;
    double *value; /* [(1 + n_signals) * room] */
};

/* The panel of signal i; those that no panel shows belong to the one of their unit. */
static int panel_of(const struct dalcs_selection *selection, size_t i, bool *shown) {
    *shown = false;
    for (int p = 0; p < selection->n_panels; p++) {
        for (int k = 0; k < selection->panel[p].n; k++) {
            if (selection->panel[p].signal[k] == i) {
                *shown = true;
                return p;
            }
        }
    }
    char text[DALCS_DIMENSION_TEXT];
    const char *unit = dalcs_dimension_unit(text, selection->signal[i].dimension);
    for (int p = 0; p < selection->n_panels; p++) {
        if (strcmp(selection->panel[p].unit, unit) == 0) {
            return p;
        }
    }
    return -1;
}

static void write_signals(FILE *stream, const struct dalcs_selection *selection,
                          const struct columns *columns, bool exact) {
    bool first = true;
    fputs(",\n\"signals\": [", stream);
    for (size_t i = 0; i < selection->n; i++) {
        bool shown = false;
        int panel = panel_of(selection, i, &shown);
        if (panel < 0) {
            continue;
        }
        fputs(first ? "\n{\"name\": " : ",\n{\"name\": ", stream);
        dalcs_page_json_string(stream, selection->name[i]);
        fprintf(stream, ", \"panel\": %d, \"shown\": %s, \"values\": \"", panel,
                shown ? "true" : "false");
        dalcs_page_json_column(stream, columns->value + (1 + i) * columns->room, columns->n_rows,
                               exact);
        fputs("\"}", stream);
        first = false;
    }
    fputs("]", stream);
}

static void write_panels(FILE *stream, const struct dalcs_selection *selection) {
    fputs(",\n\"panels\": [", stream);
    for (int p = 0; p < selection->n_panels; p++) {
        fputs(p > 0 ? ", {\"quantity\": " : "{\"quantity\": ", stream);
        dalcs_page_json_string(stream, selection->panel[p].quantity);
        fputs(", \"unit\": ", stream);
        dalcs_page_json_string(stream, selection->panel[p].unit);
        fputs("}", stream);
    }
    fputs("]", stream);
}

static void write_conduction(FILE *stream, const struct dalcs_conduction *conduction) {
    fputs(",\n\"bars\": [", stream);
    for (size_t k = 0; k < conduction->n; k++) {
        const struct dalcs_conduction_element *element = &conduction->element[k];
        fputs(k > 0 ? ",\n{\"name\": " : "\n{\"name\": ", stream);
        dalcs_page_json_string(stream, element->name);
        fprintf(stream, ", \"on\": %s, \"times\": [", element->on_before ? "true" : "false");
        for (size_t i = 0; i < element->n; i++) {
            fputs(i > 0 ? "," : "", stream);
            dalcs_page_json_number(stream, element->change[i].time);
        }
        fputs("]}", stream);
    }
    fputs("],\n\"jumps\": [", stream);
    for (size_t i = 0; i < conduction->n_jumps; i++) {
        fputs(i > 0 ? "," : "", stream);
        dalcs_page_json_number(stream, conduction->jump[i]);
    }
    fputs("]", stream);
}

static void write_lines(FILE *stream, const struct dalcs_margin_lines *lines) {
    fputs(",\n\"lines\": [", stream);
    for (int k = 0; k < lines->n; k++) {
        const struct dalcs_figure_line *line = &lines->line[k];
        fprintf(stream, "%s{\"panel\": %d, \"level\": %s, \"at\": ", k > 0 ? ", " : "", line->panel,
                line->is_level ? "true" : "false");
        dalcs_page_json_number(stream, line->at);
        fputs(", \"text\": ", stream);
        dalcs_page_json_string(stream, line->text ? line->text : "");
        fputs("}", stream);
    }
    fputs("]", stream);
}

/* A page with all digits of its values, or not. */
struct pages {
    const struct dalcs_page *page;
    bool exact;
};

static enum dalcs_status add_row(void *user, double at, const double *value) {
    struct columns *columns = user;
    if (columns->n_rows == columns->room) {
        return DALCS_E_INTERNAL;
    }
    size_t row = columns->n_rows++;
    columns->value[row] = at;
    for (size_t i = 0; i < columns->n_signals; i++) {
        columns->value[(1 + i) * columns->room + row] = value[i];
    }
    return DALCS_OK;
}

/* columns->value is the caller's to free, whatever the status. */
static enum dalcs_status take_columns(struct columns *columns,
                                      const struct dalcs_selection *selection) {
    *columns = (struct columns){.n_signals = selection->n,
                                .room = dalcs_selection_count_rows(selection) + 2};
    columns->value = dalcs_alloc((1 + columns->n_signals) * columns->room, sizeof *columns->value);
    return columns->value != NULL ? dalcs_selection_each_row(selection, add_row, columns)
                                  : DALCS_E_NOMEM;
}

/* Are they too many values for a page, or for their exact ones? */
static enum dalcs_status measure(struct pages *pages, struct dalcs_diag *diag) {
    const size_t n_signals = pages->page->selection->n;
    size_t n_rows = dalcs_selection_count_rows(pages->page->selection) + 2;
    for (size_t k = 0; k + 1 < pages->page->runs->n; k++) {
        n_rows += dalcs_selection_count_rows(&pages->page->runs->run[k].selection) + 2;
    }
    pages->exact = n_signals * n_rows <= MAX_EXACT;
    if (n_rows > MAX_VALUES / (n_signals + 1)) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL,
                       "choose signals with -s, a range, or a run with --run",
                       "%zu rows of %zu signals are too much for a page", n_rows, n_signals);
        return DALCS_E_LIMIT;
    }
    return DALCS_OK;
}

/* Another run, with the same signals. */
static enum dalcs_status write_other(FILE *stream, const struct dalcs_page_run *run, bool exact) {
    struct columns columns;
    const enum dalcs_status status = take_columns(&columns, &run->selection);
    if (status == DALCS_OK) {
        fputs("{\"at\": \"", stream);
        dalcs_page_json_column(stream, columns.value, columns.n_rows, true);
        fputs("\"", stream);
        write_signals(stream, &run->selection, &columns, exact);
        write_conduction(stream, &run->conduction);
        fputs("}", stream);
    }
    free(columns.value);
    return status;
}

static enum dalcs_status write_others(FILE *stream, const struct pages *pages) {
    const struct dalcs_page_runs *runs = pages->page->runs;
    fputs(",\n\"labels\": [", stream);
    for (size_t k = 0; k < runs->n; k++) {
        fputs(k > 0 ? ", " : "", stream);
        dalcs_page_json_string(stream, runs->label[k]);
    }
    fputs("],\n\"others\": [", stream);
    for (size_t k = 0; k + 1 < runs->n; k++) {
        fputs(k > 0 ? ",\n" : "\n", stream);
        DALCS_TRY(write_other(stream, &runs->run[k], pages->exact));
    }
    fputs("]", stream);
    return DALCS_OK;
}

static enum dalcs_status write_run(FILE *stream, const struct pages *pages,
                                   const struct columns *columns) {
    const struct dalcs_selection *selection = pages->page->selection;
    fputs("{\"axis\": {\"name\": ", stream);
    dalcs_page_json_string(stream, selection->axis.quantity);
    fputs(", \"unit\": ", stream);
    dalcs_page_json_string(stream, selection->axis.unit);
    fprintf(stream, ", \"log\": %s},\n\"marks\": %s, \"bits\": %d,\n\"at\": \"",
            selection->axis.logarithmic ? "true" : "false", pages->page->marks ? "true" : "false",
            pages->exact ? 64 : 32);
    dalcs_page_json_column(stream, columns->value, columns->n_rows, true);
    fputs("\"", stream);
    write_panels(stream, selection);
    write_signals(stream, selection, columns, pages->exact);
    write_conduction(stream, pages->page->conduction);
    write_lines(stream, pages->page->lines);
    const enum dalcs_status status = write_others(stream, pages);
    fputs("}", stream);
    return status;
}

/* ---- The page ------------------------------------------------------------------------------- */

static void write_text(FILE *stream, const char *text) {
    for (const char *c = text; *c; c++) {
        if (*c == '<' || *c == '&' || *c == '>' || *c == '"') {
            fprintf(stream, "&#%d;", *c);
        } else {
            fputc((unsigned char)*c < 0x20 ? ' ' : *c, stream);
        }
    }
}

bool dalcs_page_is_available(void) {
    return true;
}

enum dalcs_status dalcs_page_write(FILE *stream, const struct dalcs_page *page,
                                   struct dalcs_diag *diag) {
    struct pages pages = {.page = page};
    struct columns columns;
    DALCS_TRY(measure(&pages, diag));
    enum dalcs_status status = take_columns(&columns, page->selection);
    for (const char *c = dalcs_embedded_page_html; status == DALCS_OK && *c;) {
        const char *mark = strchr(c, '@');
        fwrite(c, 1, mark ? (size_t)(mark - c) : strlen(c), stream);
        if (!mark) {
            break;
        }
        const char *name = mark + 1, *end = strchr(name, '@');
        size_t length = (size_t)(end - name);
        if (strncmp(name, "theme", length) == 0) {
            fputs(page->theme->name, stream);
        } else if (strncmp(name, "title", length) == 0) {
            write_text(stream, page->title);
        } else if (strncmp(name, "run", length) == 0) {
            status = write_run(stream, &pages, &columns);
        } else if (strncmp(name, "page.css", length) == 0) {
            fputs(dalcs_embedded_page_css, stream);
        } else if (strncmp(name, "page.js", length) == 0) {
            fputs(dalcs_embedded_page_js, stream);
        } else if (strncmp(name, "library.css", length) == 0) {
            fputs(dalcs_embedded_library_css, stream);
        } else {
            fputs(dalcs_embedded_library_js, stream);
        }
        c = end + 1;
    }
    free(columns.value);
    return status;
}

#else

bool dalcs_page_is_available(void) {
    return false;
}

enum dalcs_status dalcs_page_write(FILE *stream, const struct dalcs_page *page,
                                   struct dalcs_diag *diag) {
    (void)stream;
    (void)page;
    dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "this dalcs was built without dygraphs");
    return DALCS_E_OPTION;
}

#endif
