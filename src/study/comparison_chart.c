/* comparison_chart.c - gnuplot scripts of a comparison. */
#include "chart.h"
#include "comparison.h"

#include "quantity.h"

#include <math.h>
#include <string.h>

#define LEAST_ERROR 1e-15 /* below, nothing is drawn */

enum { MAX_PANELS = 4 };

/* The device models as the legend calls them; in the order of the search. */
static void write_device(FILE *script, const struct dalcs_ngspice_search *search,
                         const struct dalcs_spice_options *o) {
    char text[DALCS_QUANTITY_SIZE];
    dalcs_quantity_write(text, o->on, "ohm", 3);
    if (!search->has_diodes) {
        fprintf(script, "'ngspice, S Ron %s'", text);
        return;
    }
    switch (o->diode) {
    case DALCS_SPICE_STOCK:
        fputs("'ngspice, D stock'", script);
        break;
    case DALCS_SPICE_EXPONENTIAL:
        fprintf(script, "'ngspice, D N=%g'", o->emission);
        break;
    case DALCS_SPICE_LINES:
        fprintf(script, "'ngspice, sidiode %s'", text);
        break;
    }
}

static bool same_device(const struct dalcs_spice_options *a, const struct dalcs_spice_options *b) {
    return a->diode == b->diode && a->emission == b->emission && a->on == b->on;
}

static void write_point(FILE *script, double cpu_s, const struct dalcs_deviation *deviation) {
    fprintf(script, "%.6g %.6g\n", 1e3 * cpu_s, fmax(deviation->worst_rms, LEAST_ERROR));
}

/* One block of points for each device model, in the order in which they first got to the end. */
static int write_trials(FILE *script, const struct dalcs_ngspice_search *search,
                        int first[DALCS_MAX_TRIALS]) {
    int n = 0;
    for (int k = 0; k < search->n_trials; k++) {
        bool is_new = search->trial[k].reason[0] == '\0';
        for (int i = 0; i < n && is_new; i++) {
            is_new = !same_device(&search->trial[k].options, &search->trial[first[i]].options);
        }
        if (is_new) {
            first[n++] = k;
        }
    }
    for (int i = 0; i < n; i++) {
        fprintf(script, "$trial%d << end_of_data\n", i);
        for (int k = first[i]; k < search->n_trials; k++) {
            const struct dalcs_trial *trial = &search->trial[k];
            if (trial->reason[0] == '\0' &&
                same_device(&trial->options, &search->trial[first[i]].options)) {
                write_point(script, trial->cpu_s, &trial->deviation);
            }
        }
        fputs("end_of_data\n", script);
    }
    return n;
}

/* One block for each method of dalcs, by tolerance or step. */
static int write_rows(FILE *script, const struct dalcs_comparison *c,
                      const char *method[DALCS_MAX_ROWS]) {
    int n = 0;
    for (int k = 0; k < c->n_rows; k++) {
        if (c->row[k].failed) {
            continue;
        }
        if (n == 0 || strcmp(method[n - 1], c->row[k].method) != 0) {
            fputs(n > 0 ? "end_of_data\n" : "", script);
            fprintf(script, "$row%d << end_of_data\n", n);
            method[n++] = c->row[k].method;
        }
        write_point(script, c->row[k].cost.cpu_s, &c->row[k].deviation);
    }
    fputs(n > 0 ? "end_of_data\n" : "", script);
    return n;
}

void dalcs_comparison_draw_work(FILE *script, const struct dalcs_comparison *c) {
    static const int mark[] = {7, 5, 9, 11};
    const char *method[DALCS_MAX_ROWS];
    int first[DALCS_MAX_TRIALS];
    int n_methods = write_rows(script, c, method);
    int n_devices = write_trials(script, &c->search, first);
    fputs("set logscale xy\nset format y '1e%T'\n"
          "set format x '%g'\nset xlabel 'CPU time (ms)' textcolor rgb '#3c4043'\n"
          "set ylabel 'rms error of the worst signal' textcolor rgb '#3c4043'\n",
          script);
    for (int i = 0; i < n_methods; i++) {
        fprintf(script,
                "%s $row%d smooth unique with linespoints pt %d ps 1 lw 1.5 lc rgb '%s' "
                "title 'dalcs, %s'",
                i == 0 ? "plot" : ",", i, mark[i % 4],
                dalcs_chart_colour[i == 0 ? 0 : DALCS_CHART_COLOURS - i % 2 - 1], method[i]);
    }
    for (int i = 0; i < n_devices; i++) {
        static const int hollow[] = {6, 4, 8, 10, 12, 1, 2, 3};
        fprintf(script, ", $trial%d with points pt %d ps 0.9 lw 1.5 lc rgb '%s' title ", i,
                hollow[i % 8], dalcs_chart_colour[1 + i % (DALCS_CHART_COLOURS - 3)]);
        write_device(script, &c->search, &c->search.trial[first[i]].options);
    }
    fputc('\n', script);
}

/* How many signals have larger errors; of equal ones the first counts as the larger. */
static int rank_of(const struct dalcs_comparison *c, const double *rms, size_t signal) {
    int rank = 0;
    for (size_t s = 0; s < c->reference.n_signals; s++) {
        bool is_larger = rms[s] > rms[signal] || (s < signal && rms[s] == rms[signal]);
        rank += !c->reference.is_open[s] && is_larger ? 1 : 0;
    }
    return rank;
}

/* The signals with the largest errors of ngspice's most exact setting, else of dalcs; in the netlist's
 * order. */
static int choose_signals(const struct dalcs_comparison *c, size_t chosen[MAX_PANELS]) {
    const double *rms = c->search.best >= 0 ? c->search.trial[c->search.best].deviation.rms
                                            : c->row[0].deviation.rms;
    int n = 0;
    for (size_t s = 0; s < c->reference.n_signals; s++) {
        if (!c->reference.is_open[s] && n < MAX_PANELS && rank_of(c, rms, s) < MAX_PANELS) {
            chosen[n++] = s;
        }
    }
    return n;
}

static void write_curve(FILE *script, const struct dalcs_comparison *c, const char *block,
                        const double *value, size_t s, double time_scale, double scale) {
    const struct dalcs_reference *r = &c->reference;
    fprintf(script, "$%s << end_of_data\n", block);
    for (size_t i = 0; i < r->times.n && value; i++) {
        if (r->times.at[i] >= c->view) {
            fprintf(script, "%.9g %.6g\n", r->times.at[i] / time_scale,
                    value[i * r->n_signals + s] / scale);
        }
    }
    fputs("end_of_data\n", script);
}

static void draw_panel(FILE *script, const struct dalcs_comparison *c, size_t s, int place,
                       int n_panels) {
    const struct dalcs_plot *plot = c->reference.samples.plot;
    double time_scale = dalcs_quantity_scale(c->reference.stop);
    double scale = dalcs_quantity_scale(c->reference.scale[s]);
    const char *prefix = dalcs_quantity_prefix(scale);
    double top = 0.97 - 0.88 * place / n_panels,
           bottom = 0.97 - 0.88 * (place + 1) / n_panels + 0.02;
    write_curve(script, c, "dalcs", c->value, s, time_scale, scale);
    write_curve(script, c, "best", c->search.best >= 0 ? c->search.best_value : NULL, s, time_scale,
                scale);
    write_curve(script, c, "stock", c->search.stock >= 0 ? c->search.stock_value : NULL, s,
                time_scale, scale);
    fprintf(script,
            "set lmargin at screen 0.1\nset rmargin at screen 0.75\n"
            "set tmargin at screen %.4f\nset bmargin at screen %.4f\n",
            top, bottom);
    fputs("set ylabel ", script);
    char label[128];
    snprintf(label, sizeof label, "%.90s (%s%s)", plot->name[s],
             strcmp(prefix, "u") == 0 ? "\302\265" : prefix,
             plot->unit[s] == DALCS_VOLT ? "V" : "A");
    dalcs_chart_write_quoted(script, label);
    fputs(" textcolor rgb '#3c4043'\n", script);
    if (place == n_panels - 1) {
        const char *time_prefix = dalcs_quantity_prefix(time_scale);
        fprintf(script, "set format x '%%g'\nset xlabel 'time (%ss)' textcolor rgb '#3c4043'\n",
                strcmp(time_prefix, "u") == 0 ? "\302\265" : time_prefix);
    }
    fprintf(script, "plot $dalcs with lines lw 3.5 lc rgb '%s' title 'dalcs by default'",
            dalcs_chart_colour[5]);
    if (c->search.stock >= 0) {
        fprintf(script, ", $stock with lines lw 1.3 lc rgb '%s' title 'ngspice, stock'",
                dalcs_chart_colour[4]);
    }
    if (c->search.best >= 0) {
        fprintf(script, ", $best with lines lw 1.3 dt 2 lc rgb '%s' title 'ngspice, most exact'",
                "#202124");
    }
    fputs("\nset key off\n", script);
}

void dalcs_comparison_draw_waveforms(FILE *script, const struct dalcs_comparison *c) {
    size_t chosen[MAX_PANELS];
    int n = choose_signals(c, chosen);
    double time_scale = dalcs_quantity_scale(c->reference.stop);
    fprintf(script, "set multiplot\nset format x ''\nset xrange [%.9g:%.9g]\n",
            c->view / time_scale, c->reference.stop / time_scale);
    for (int i = 0; i < n; i++) {
        draw_panel(script, c, chosen[i], i, n);
    }
    fputs("unset multiplot\n", script);
}

static void write_errors(FILE *script, const struct dalcs_comparison *c, const char *block,
                         const double *value, size_t s) {
    const struct dalcs_reference *r = &c->reference;
    double time_scale = dalcs_quantity_scale(r->stop);
    fprintf(script, "$%s << end_of_data\n", block);
    for (size_t i = 0; i < r->times.n && value; i++) {
        if (r->times.is_measured[i]) {
            size_t k = i * r->n_signals + s;
            double error = fabs(value[k] - r->samples.value[k]) / r->scale[s];
            fprintf(script, "%.6g %.3g\n", r->times.at[i] / time_scale, fmax(error, LEAST_ERROR));
        }
    }
    fputs("end_of_data\n", script);
}

void dalcs_comparison_draw_errors(FILE *script, const struct dalcs_comparison *c) {
    size_t s = c->search.best >= 0 ? c->search.trial[c->search.best].deviation.worst
                                   : c->row[0].deviation.worst;
    double time_scale = dalcs_quantity_scale(c->reference.stop);
    const char *time_prefix = dalcs_quantity_prefix(time_scale);
    write_errors(script, c, "dalcs", c->value, s);
    write_errors(script, c, "best", c->search.best >= 0 ? c->search.best_value : NULL, s);
    write_errors(script, c, "stock", c->search.stock >= 0 ? c->search.stock_value : NULL, s);
    fputs("set logscale y\nset format y '1e%T'\n", script);
    fprintf(script, "set xlabel 'time (%ss)' textcolor rgb '#3c4043'\nset ylabel ",
            strcmp(time_prefix, "u") == 0 ? "\302\265" : time_prefix);
    char label[128];
    snprintf(label, sizeof label, "error of %.90s", c->reference.samples.plot->name[s]);
    dalcs_chart_write_quoted(script, label);
    fputs(" textcolor rgb '#3c4043'\n", script);
    fprintf(script, "plot $dalcs with lines lw 1.2 lc rgb '%s' title 'dalcs by default'",
            dalcs_chart_colour[0]);
    if (c->search.best >= 0) {
        fprintf(script, ", $best with lines lw 1.2 lc rgb '%s' title 'ngspice, most exact'",
                dalcs_chart_colour[1]);
    }
    if (c->search.stock >= 0) {
        fprintf(script, ", $stock with lines lw 1.2 lc rgb '%s' title 'ngspice, stock'",
                dalcs_chart_colour[4]);
    }
    fputc('\n', script);
}
