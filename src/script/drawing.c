/* drawing.c - hands vectors to the figures that --plot and `dalcs plot` draw. */
#include "drawing.h"

#include "figure.h"
#include "text_plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { N_PANELS = 3, TEXT_WIDTH = 80 };

bool dalcs_drawing_can_write(const char *path) {
    return dalcs_figure_can_write(path);
}

static const char *quantity_of(enum dalcs_unit unit) {
    return unit == DALCS_UNIT_SECOND  ? "time"
           : unit == DALCS_UNIT_HERTZ ? "frequency"
           : unit == DALCS_VOLT       ? "voltage"
           : unit == DALCS_AMPERE     ? "current"
                                      : "value";
}

static const char *unit_of(enum dalcs_unit unit) {
    return unit == DALCS_UNIT_SECOND  ? "s"
           : unit == DALCS_UNIT_HERTZ ? "Hz"
           : unit == DALCS_VOLT       ? "V"
           : unit == DALCS_AMPERE     ? "A"
           : unit == DALCS_UNIT_OHM   ? "ohm"
                                      : "";
}

/* Complex numbers are drawn by their magnitude; one's name says so. */
static double shown(const struct dalcs_vector *v, size_t k) {
    return v->is_complex ? cabs(v->value[k]) : creal(v->value[k]);
}

static enum dalcs_status begin(struct dalcs_figure *figure, const struct dalcs_drawing *d,
                               const char **name, int *group) {
    struct dalcs_figure_panel panel[N_PANELS] = {{.quantity = "voltage", .unit = "V"},
                                                 {.quantity = "current", .unit = "A"},
                                                 {.quantity = "value", .unit = ""}};
    for (size_t i = 0; i < d->n; i++) {
        const struct dalcs_vector *v = d->vector[i];
        name[i] = v->name;
        group[i] = v->n != d->scale->n       ? N_PANELS /* none */
                   : v->unit == DALCS_VOLT   ? 0
                   : v->unit == DALCS_AMPERE ? 1
                                             : 2;
    }
    for (int p = 0; p < N_PANELS; p++) {
        dalcs_figure_choose(&panel[p], name, group, d->n, p);
    }
    return dalcs_figure_begin_panels(figure, d->title, name, panel, N_PANELS);
}

/* A scale that goes back, as that of a nested sweep, is drawn up to there. */
static void add_rows(struct dalcs_figure *figure, const struct dalcs_drawing *d, double *row) {
    double last = -INFINITY;
    for (size_t k = 0; k < d->scale->n; k++) {
        const double at = creal(d->scale->value[k]);
        if (at < last) {
            return;
        }
        last = at;
        for (size_t i = 0; i < d->n; i++) {
            row[i] = d->vector[i]->n == d->scale->n ? shown(d->vector[i], k) : 0.0;
        }
        dalcs_figure_row(figure, at, row);
    }
}

static enum dalcs_status show(struct dalcs_figure *figure, FILE *out) {
    const struct dalcs_text_plot_options options = {.width = TEXT_WIDTH};
    enum dalcs_status status = dalcs_figure_compose(figure, NULL);
    return status == DALCS_OK ? dalcs_text_plot_write(out, figure, &options) : status;
}

enum dalcs_status dalcs_drawing_draw(const struct dalcs_drawing *d, const char *path, FILE *out,
                                     char message[DALCS_DRAWING_MESSAGE]) {
    struct dalcs_figure figure;
    const char **name = dalcs_alloc(d->n, sizeof *name);
    int *group = dalcs_alloc(d->n, sizeof *group);
    double *row = dalcs_alloc(d->n, sizeof *row);
    enum dalcs_status status = DALCS_E_NOMEM;
    dalcs_figure_init(&figure, path, creal(d->scale->value[0]),
                      creal(d->scale->value[d->scale->n - 1]));
    figure.axis = (struct dalcs_figure_axis){quantity_of(d->scale->unit), unit_of(d->scale->unit),
                                             d->is_logarithmic};
    message[0] = '\0';
    if (name != NULL && group != NULL && row != NULL) {
        status = begin(&figure, d, name, group);
    }
    if (status == DALCS_OK) {
        add_rows(&figure, d, row);
        status = path != NULL ? dalcs_figure_draw(&figure, NULL, NULL) : show(&figure, out);
    }
    if (status == DALCS_E_IO) {
        snprintf(message, DALCS_DRAWING_MESSAGE, "%s",
                 figure.message[0] != '\0' ? figure.message : strerror(figure.file.error));
    }
    dalcs_figure_finish(&figure);
    free(name);
    free(group);
    free(row);
    return status;
}
