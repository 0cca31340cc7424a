/* text_plot.c - lines of dots in a grid, eight dots a character in Braille, two in ASCII. */
#include "text_plot.h"

#include "memory.h"
#include "quantity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 6, LABEL = 12, MIN_WIDTH = 40, MAX_WIDTH = 400, DIGITS = 4 };

static const char *const color_code[DALCS_FIGURE_MAX_CURVES] = {"34", "31", "32", "35",
                                                                "33", "36", "94", "37"};

struct canvas {
    const struct dalcs_text_plot_options *options;
    int width, height; /* in dots */
    int cell_width, cell_height;
    bool *dot; /* [width * height], from the top */
};

static void set_dot(struct canvas *canvas, double x, double y) {
    int column = (int)fmin(fmax(x, 0.0), canvas->width - 1);
    int row = (int)fmin(fmax(y, 0.0), canvas->height - 1);
    canvas->dot[row * canvas->width + column] = true;
}

static void draw_line(struct canvas *canvas, double x0, double y0, double x1, double y1) {
    int n = 1 + (int)fmax(fabs(x1 - x0), fabs(y1 - y0));
    for (int i = 0; i <= n; i++) {
        double part = (double)i / n;
        set_dot(canvas, x0 + part * (x1 - x0), y0 + part * (y1 - y0));
    }
}

static double place_of(const struct dalcs_curve *curve, double time) {
    return curve->logarithmic ? log(time / curve->start) / log(curve->stop / curve->start)
                              : (time - curve->start) / (curve->stop - curve->start);
}

static void draw_curve(struct canvas *canvas, const struct dalcs_curve *curve, double low,
                       double high) {
    double x0 = -1.0, y0 = 0.0;
    memset(canvas->dot, 0, (size_t)canvas->width * (size_t)canvas->height * sizeof *canvas->dot);
    for (int column = 0; column < DALCS_CURVE_COLUMNS; column++) {
        struct dalcs_curve_point point[4];
        int n = dalcs_curve_column_points(&curve->column[column], point);
        for (int k = 0; k < n; k++) {
            double x = place_of(curve, point[k].time) * (canvas->width - 1) + 0.5;
            double y = (high - point[k].value) / (high - low) * (canvas->height - 1) + 0.5;
            draw_line(canvas, x0 < 0.0 ? x : x0, x0 < 0.0 ? y : y0, x, y);
            x0 = x;
            y0 = y;
        }
    }
}

/* The character of a cell; Braille patterns start at U+2800, a bit for each dot. */
static void write_cell(FILE *stream, const struct canvas *canvas, int row, int column) {
    static const int bit[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    const bool *dot =
        canvas->dot + row * canvas->cell_height * canvas->width + column * canvas->cell_width;
    if (!canvas->options->dots) {
        bool upper = dot[0], lower = dot[canvas->width];
        fputc(upper && lower ? ':' : upper ? '\'' : lower ? '.' : ' ', stream);
        return;
    }
    int pattern = 0;
    for (int y = 0; y < 4; y++) {
        for (int x = 0; x < 2; x++) {
            pattern |= dot[y * canvas->width + x] ? bit[y][x] : 0;
        }
    }
    fputc(0xe2, stream);
    fputc(0xa0 | pattern >> 6, stream);
    fputc(0x80 | (pattern & 0x3f), stream);
}

static void set_color(FILE *stream, const struct canvas *canvas, const char *code) {
    if (canvas->options->colors) {
        fprintf(stream, "\033[%sm", code);
    }
}

/* A name out of a file must not command the terminal. */
static void write_text(FILE *stream, const char *text) {
    for (const char *c = text; *c; c++) {
        fputc((unsigned char)*c < 0x20 || *c == 0x7f ? '?' : *c, stream);
    }
}

static void write_strip(FILE *stream, const struct dalcs_figure *figure, struct canvas *canvas,
                        int p, int i) {
    const struct dalcs_curve *curve = &figure->view[0].curve[p][i];
    const char *unit = figure->panel[p].unit;
    char text[DALCS_QUANTITY_SIZE];
    double low = curve->lowest, high = curve->highest;
    set_color(stream, canvas, "1");
    fprintf(stream, "%*s", LABEL, "");
    write_text(stream, figure->name[figure->panel[p].signal[i]]);
    fputc('\n', stream);
    set_color(stream, canvas, "0");
    if (low > high) {
        fprintf(stream, "%*s  no values\n", LABEL - 2, "");
        return;
    }
    double largest = fmax(fabs(low), fabs(high));
    bool constant = high - low <= 1e-9 * largest || high == low;
    double margin = constant ? (largest > 0.0 ? 0.1 * largest : 1.0) : 0.0;
    draw_curve(canvas, curve, low - margin, high + margin);
    const int label_of_high = constant ? ROWS / 2 : 0, label_of_low = constant ? -1 : ROWS - 1;
    for (int row = 0; row < ROWS; row++) {
        double value = row == label_of_high ? high : low;
        /* What is rounding beside the largest value is shown as 0. */
        value = fabs(value) < 1e-9 * largest ? 0.0 : value;
        bool labelled = row == label_of_high || row == label_of_low;
        fprintf(stream, "%*s ", LABEL - 1,
                labelled ? dalcs_quantity_write(text, value, unit, DIGITS) : "");
        set_color(stream, canvas, color_code[i]);
        for (int column = 0; column < canvas->width / canvas->cell_width; column++) {
            write_cell(stream, canvas, row, column);
        }
        set_color(stream, canvas, "0");
        fputc('\n', stream);
    }
}

/* Which part of its width a character of a bar conducts: all, some, none. */
static void write_bars(FILE *stream, const struct dalcs_figure *figure,
                       const struct canvas *canvas) {
    static const char *const plain[] = {" ", "-", "#"};
    static const char *const block[] = {" ", "\342\226\222", "\342\226\210"};
    const struct dalcs_figure_view *view = &figure->view[0];
    const int n = canvas->width / canvas->cell_width;
    double fraction[MAX_WIDTH];
    for (size_t k = 0; k < figure->conduction->n; k++) {
        const struct dalcs_conduction_element *element = &figure->conduction->element[k];
        dalcs_conduction_fractions(element, view->start, view->stop, n, fraction);
        fprintf(stream, "%*.*s ", LABEL - 1, LABEL - 1, element->name);
        for (int i = 0; i < n; i++) {
            int level = fraction[i] > 0.95 ? 2 : fraction[i] > 0.0 ? 1 : 0;
            fputs(canvas->options->dots ? block[level] : plain[level], stream);
        }
        fputc('\n', stream);
    }
}

static void write_axis(FILE *stream, const struct dalcs_figure *figure,
                       const struct canvas *canvas) {
    char from[DALCS_QUANTITY_SIZE], to[DALCS_QUANTITY_SIZE];
    const struct dalcs_figure_view *view = &figure->view[0];
    dalcs_quantity_write(from, view->start, figure->axis.unit, DIGITS);
    dalcs_quantity_write(to, view->stop, figure->axis.unit, DIGITS);
    int n = canvas->width / canvas->cell_width, gap = n - (int)strlen(from) - (int)strlen(to);
    const char *name = figure->axis.quantity;
    int before = (gap - (int)strlen(name)) / 2;
    before = before > 0 ? before : 1;
    int after = gap - before - (int)strlen(name);
    fprintf(stream, "%*s%s%*s%s%*s%s\n", LABEL, "", from, before, "", name, after > 0 ? after : 1,
            "", to);
}

enum dalcs_status dalcs_text_plot_write(FILE *stream, const struct dalcs_figure *figure,
                                        const struct dalcs_text_plot_options *options) {
    int width = options->width < MIN_WIDTH   ? MIN_WIDTH
                : options->width > MAX_WIDTH ? MAX_WIDTH
                                             : options->width;
    struct canvas canvas = {.options = options,
                            .cell_width = options->dots ? 2 : 1,
                            .cell_height = options->dots ? 4 : 2};
    canvas.width = (width - LABEL - 1) * canvas.cell_width;
    canvas.height = ROWS * canvas.cell_height;
    canvas.dot = dalcs_alloc((size_t)canvas.width * (size_t)canvas.height, sizeof *canvas.dot);
    if (!canvas.dot) {
        return DALCS_E_NOMEM;
    }
    write_text(stream, figure->title + strspn(figure->title, "* "));
    fputs("\n\n", stream);
    size_t n_left_out = 0;
    for (int p = 0; p < figure->n_panels; p++) {
        n_left_out += figure->panel[p].n_left_out;
        for (int i = 0; i < figure->panel[p].n; i++) {
            write_strip(stream, figure, &canvas, p, i);
        }
    }
    if (figure->bars && figure->conduction && figure->conduction->n > 0) {
        write_bars(stream, figure, &canvas);
    }
    write_axis(stream, figure, &canvas);
    if (n_left_out > 0) {
        fprintf(stream, "%*s%zu more signal%s not drawn: -s\n", LABEL, "", n_left_out,
                n_left_out == 1 ? "" : "s");
    }
    free(canvas.dot);
    return DALCS_OK;
}
