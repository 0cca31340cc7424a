/* gnuplot_page.c - the measures of a page: panels over each other, bars below, legends to the right,
 * the end of a dense run as a second column. */
#include "gnuplot_page.h"

#include "quantity.h"
#include "utf8.h"

#include <math.h>
#include <string.h>
#include <strings.h>

/* In pixels. */
enum {
    TOP = 58,
    MARKS = 20,
    BOTTOM = 64,
    GAP = 36,
    BAR = 22,
    BARS_GAP = 30,
    MARGIN = 78,
    LABEL = 16, /* of the margin, to the middle of the text */
    CHARACTER = 10,
    NUMBER_CHARACTER = 9,
    LEGEND = 66,
    LEGEND_ROW = 28,
    LEAST_PANEL = 130
};

static const double LEGEND_CHARACTER = 9.84, VIEWS_GAP = 30.0;

enum { MAX_BARS = 16, TICS = 5, MOST_NUMBERS = 8 /* that gnuplot writes by itself */ };

/* In proportion to the width, with room for the numbers of the axis and for the legend. */
static int panel_height(const struct dalcs_figure *figure, int n_panels) {
    const int height = n_panels == 1 ? 598 : n_panels == 2 ? 281 : 220;
    int least = LEAST_PANEL;
    for (int p = 0; p < figure->n_panels; p++) {
        const int legend = LEGEND_ROW * figure->panel[p].n;
        least = legend > least ? legend : least;
    }
    const int wanted = height * figure->width / DALCS_FIGURE_WIDTH;
    return wanted > least ? wanted : least;
}

static bool has_extension(const char *path, const char *extension) {
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, extension) == 0;
}

static int limited_length(const char *text) {
    size_t length = strlen(text);
    return length < DALCS_GNUPLOT_MAX_NAME ? (int)length : DALCS_GNUPLOT_MAX_NAME;
}

static int longest_name(const struct dalcs_figure *figure) {
    int longest = 0;
    for (int p = 0; p < figure->n_panels; p++) {
        for (int i = 0; i < figure->panel[p].n; i++) {
            int length = limited_length(figure->name[figure->panel[p].signal[i]]);
            longest = length > longest ? length : longest;
        }
    }
    return longest;
}

/* Decimals with which the numbers of an axis differ. */
static int count_decimals(double range) {
    return (int)fmax(0.0, -floor(log10(range / TICS)));
}

static int count_whole_digits(double largest) {
    return (int)fmax(1.0, floor(log10(fmax(largest, 1.0))) + 1.0);
}

int dalcs_gnuplot_count_digits(double low, double high) {
    double largest = fmax(fabs(low), fabs(high));
    int n = count_whole_digits(largest) + count_decimals(high - low);
    return n < 6 ? 6 : n > 15 ? 15 : n;
}

/* Of the numbers on the axis of a panel, in characters. */
static int number_length(const struct dalcs_figure_view *view, int p, double scale) {
    double low = view->low[p] / scale, high = view->high[p] / scale;
    double largest = fmax(fabs(low), fabs(high));
    if (largest < 1e-4 || largest >= 1e6) {
        return 9; /* -1.5e-23 */
    }
    int decimals = count_decimals(high - low);
    return count_whole_digits(largest) + (decimals > 0 ? decimals + 1 : 0) + (low < 0.0 ? 1 : 0);
}

double dalcs_gnuplot_panel_scale(const struct dalcs_figure *figure, int v, int p) {
    const char *unit = figure->panel[p].unit;
    bool plain = unit[0] == '\0' || strpbrk(unit, "^ ") || strcmp(unit, "\302\260") == 0 ||
                 strcmp(unit, "dB") == 0;
    return plain ? 1.0 : dalcs_quantity_scale(figure->view[v].largest[p]);
}

/* What the numbers of the axes and their labels need, in pixels. */
static int axis_margin(const struct dalcs_figure *figure) {
    int margin = MARGIN;
    for (int v = 0; v < figure->n_views; v++) {
        for (int p = 0; p < figure->n_panels; p++) {
            double scale = dalcs_gnuplot_panel_scale(figure, v, p);
            int needed =
                figure->panel[p].n == 0 ? 0 : 42 + 9 * number_length(&figure->view[v], p, scale);
            margin = needed > margin ? needed : margin;
        }
    }
    return margin;
}

/* The names of bars stand there as well. */
static int left_margin(const struct dalcs_figure *figure, size_t n_bars) {
    int margin = axis_margin(figure);
    for (size_t i = 0; i < n_bars; i++) {
        int needed = 16 + CHARACTER * limited_length(figure->conduction->element[i].name);
        margin = needed > margin ? needed : margin;
    }
    return margin;
}

static void lay_out_columns(struct dalcs_gnuplot_page *page, const struct dalcs_figure *figure) {
    double left = (double)left_margin(figure, page->n_bars) / page->width;
    double right = 1.0 - (LEGEND + LEGEND_CHARACTER * longest_name(figure)) / page->width;
    double middle = 0.5 * (left + right);
    double gap = left + VIEWS_GAP / page->width;
    bool two = figure->n_views > 1;
    double label = (double)(LABEL - axis_margin(figure)) / page->width;
    page->place[0] = (struct dalcs_gnuplot_place){.left = left,
                                                  .right = two ? middle - 0.5 * gap : right,
                                                  .label = left + label,
                                                  .legend = !two};
    page->place[1] = (struct dalcs_gnuplot_place){.left = middle + 0.5 * gap,
                                                  .right = right,
                                                  .label = middle + 0.5 * gap + label,
                                                  .legend = true};
}

struct dalcs_gnuplot_page dalcs_gnuplot_lay_out(const struct dalcs_figure *figure) {
    struct dalcs_gnuplot_page page = {.width = figure->width,
                                      .font = has_extension(figure->path, ".svg") ? 14 : 11};
    for (int p = 0; p < figure->n_panels; p++) {
        if (figure->panel[p].n > 0) {
            page.panel[page.n_panels++] = p;
        }
    }
    if (figure->bars && figure->conduction) {
        size_t n = figure->conduction->n;
        page.n_bars = n < MAX_BARS ? n : MAX_BARS;
    }
    const int each = panel_height(figure, page.n_panels);
    const int top = TOP + (figure->marks ? MARKS : 0);
    const int bars = page.n_bars > 0 ? BARS_GAP + BAR * (int)page.n_bars : 0;
    page.height = top + page.n_panels * each + (page.n_panels - 1) * GAP + bars + BOTTOM;
    const double height = page.height;
    for (int k = 0; k < page.n_panels; k++) {
        page.top[k] = 1.0 - (top + k * (each + GAP)) / height;
        page.bottom[k] = page.top[k] - each / height;
    }
    page.bars_bottom = BOTTOM / height;
    page.bars_top = page.bars_bottom + BAR * (double)page.n_bars / height;
    page.title_at = 1.0 - 29.0 / height;
    page.marks_at = 1.0 - (TOP + 6.0) / height;
    page.time_scale = 1.0;
    if (!figure->axis.logarithmic && figure->axis.unit[0]) {
        page.time_scale =
            dalcs_quantity_scale(fmax(fabs(figure->view[0].start), fabs(figure->view[0].stop)));
    }
    lay_out_columns(&page, figure);
    return page;
}

void dalcs_gnuplot_write_quoted(FILE *stream, const char *text, int max_length) {
    fputc('\'', stream);
    const char *c = text;
    while (*c && max_length-- > 0) {
        size_t length = dalcs_utf8_length(c);
        if (length == 0 || (unsigned char)*c < 0x20 || *c == 0x7f) {
            fputc('?', stream);
            c++;
            continue;
        }
        if (*c == '\'') {
            fputc('\'', stream);
        }
        fwrite(c, 1, length, stream);
        c += length;
    }
    fputs(*c ? "\342\200\246'" : "'", stream);
}

void dalcs_gnuplot_write_margins(FILE *stream, const struct dalcs_gnuplot_page *page, int v,
                                 double bottom, double top) {
    fprintf(stream, "set lmargin at screen %.4f\nset rmargin at screen %.4f\n", page->place[v].left,
            page->place[v].right);
    fprintf(stream, "set bmargin at screen %.4f\nset tmargin at screen %.4f\n", bottom, top);
}

/* gnuplot lets the numbers of a narrow axis overlap. */
static void write_distance(FILE *stream, const struct dalcs_gnuplot_page *page, int v, double start,
                           double stop) {
    const double room = (page->place[v].right - page->place[v].left) * page->width;
    const double range = stop - start;
    const int length =
        count_whole_digits(fmax(fabs(start), fabs(stop))) + count_decimals(range) + 2;
    const double least = range * NUMBER_CHARACTER * length / room;
    const double power = pow(10.0, floor(log10(least)));
    const double step = least <= power         ? power
                        : least <= 2.0 * power ? 2.0 * power
                        : least <= 5.0 * power ? 5.0 * power
                                               : 10.0 * power;
    if (range > 0.0 && step > range / MOST_NUMBERS) {
        fprintf(stream, "set xtics %.12g\n", step);
    } else {
        fputs("set xtics autofreq\n", stream);
    }
}

void dalcs_gnuplot_write_axis(FILE *stream, const struct dalcs_figure *figure,
                              const struct dalcs_gnuplot_page *page, int v) {
    const char *prefix = dalcs_quantity_prefix(page->time_scale);
    fputs("set xlabel ", stream);
    char text[128], unit[64] = "";
    if (figure->axis.unit[0]) {
        snprintf(unit, sizeof unit, " (%s%s)", strcmp(prefix, "u") == 0 ? "\302\265" : prefix,
                 figure->axis.unit);
    }
    snprintf(text, sizeof text, "%.40s%s%s", figure->axis.quantity, unit,
             v == 1 ? ", the end of the run" : "");
    dalcs_gnuplot_write_quoted(stream, text, (int)sizeof text);
    fprintf(stream, " offset 0,0.2 textcolor rgb '%s'\n", figure->theme->text);
    if (figure->axis.logarithmic) {
        fputs("set format x '%.0s%c'\n", stream);
    } else {
        const double start = figure->view[v].start / page->time_scale;
        const double stop = figure->view[v].stop / page->time_scale;
        fprintf(stream, "set format x '%%.%dg'\n", dalcs_gnuplot_count_digits(start, stop));
        write_distance(stream, page, v, start, stop);
    }
}
