/* convergence_page.c - errors and orders as one page with a figure. */
#include "chart.h"
#include "convergence.h"
#include "study_page.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#define LEAST_ERROR 1e-16 /* what is drawn for an error of 0 */

static void write_blocks(FILE *script, const struct dalcs_convergence *c) {
    for (size_t first = 0; first < c->n_rows;) {
        size_t n = dalcs_convergence_group(c, first);
        fprintf(script, "$rows%zu << end_of_data\n", first);
        for (size_t k = first; k < first + n; k++) {
            if (!c->row[k].failed) {
                fprintf(script, "%.9g %.6g\n", c->row[k].step,
                        fmax(c->row[k].largest, LEAST_ERROR));
            }
        }
        fputs("end_of_data\n", script);
        first += n;
    }
}

static void write_script(FILE *script, const struct dalcs_convergence *c) {
    static const int mark[] = {7, 5, 9, 11, 13, 2};
    const struct dalcs_reference *r = &c->reference;
    write_blocks(script, c);
    fputs("set logscale xy\nset format xy '1e%T'\n"
          "set xlabel 'step (s)' textcolor rgb '#3c4043'\n"
          "set ylabel 'largest error over the scale' textcolor rgb '#3c4043'\n",
          script);
    int i = 0;
    for (size_t first = 0; first < c->n_rows; i++) {
        double order = dalcs_convergence_order(c, first);
        fprintf(script, "%s $rows%zu with linespoints pt %d ps 0.9 lw 1.8 lc rgb '%s' title '",
                i == 0 ? "plot" : ",", first, mark[i % 6],
                dalcs_chart_colour[i % DALCS_CHART_COLOURS]);
        dalcs_stepping_write(script, &c->row[first].stepping);
        if (!isnan(order)) {
            fprintf(script, ": order %.1f", order);
        }
        fputc('\'', script);
        first += dalcs_convergence_group(c, first);
    }
    fprintf(script, ", %.3g with lines dt 3 lw 1.5 lc rgb '#5f6368' title 'reference known to'\n",
            fmax(r->doubt[r->most_doubt], LEAST_ERROR));
}

static enum dalcs_status write_figure(FILE *page, const struct dalcs_convergence *c,
                                      char message[256]) {
    FILE *script = dalcs_chart_begin("convergence", 900, 520);
    if (!script) {
        snprintf(message, 256, "cannot write a temporary file: %s", strerror(errno));
        return DALCS_E_IO;
    }
    write_script(script, c);
    return dalcs_chart_end(script, page, message);
}

static void write_rows(FILE *page, const struct dalcs_convergence *c, size_t first, size_t n) {
    for (size_t k = first; k < first + n; k++) {
        const struct dalcs_convergence_row *row = &c->row[k];
        fputs("<tr><td class=\"t\">", page);
        if (k == first) {
            dalcs_stepping_write(page, &row->stepping);
        }
        fputs("</td>", page);
        dalcs_page_quantity_cell(page, row->step, "s");
        if (row->failed) {
            fputs("<td class=\"t no\" colspan=\"6\">failed</td></tr>\n", page);
            continue;
        }
        dalcs_page_error_cell(page, row->largest);
        dalcs_page_error_cell(page, row->rms);
        if (isnan(row->order)) {
            fputs("<td class=\"no\">-</td>", page);
        } else {
            fprintf(page, "<td>%.2f</td>", row->order);
        }
        fprintf(page, "<td>%ld</td>", row->steps);
        dalcs_page_quantity_cell(page, row->cpu_s, "s");
        fputs("<td class=\"t\">", page);
        dalcs_page_text(page, c->reference.samples.plot->name[row->worst]);
        fputs("</td></tr>\n", page);
    }
}

enum dalcs_status dalcs_convergence_write_page(FILE *page, const struct dalcs_convergence *c,
                                               char message[256]) {
    const char *title = c->reference.samples.plot->title;
    char heading[200];
    snprintf(heading, sizeof heading, "Convergence: %s", title + strspn(title, "* "));
    dalcs_page_begin(page, heading);
    enum dalcs_status status = write_figure(page, c, message);
    if (status != DALCS_OK) {
        fputs("<p>No figure: ", page);
        dalcs_page_text(page, message);
        fputs("</p>\n", page);
    }
    fputs("<table>\n<tr><th class=\"t\">method</th><th>step</th><th>largest error</th><th>rms</th>"
          "<th>order</th><th>steps</th><th>CPU</th><th class=\"t\">worst signal</th></tr>\n",
          page);
    for (size_t first = 0; first < c->n_rows;) {
        size_t n = dalcs_convergence_group(c, first);
        write_rows(page, c, first, n);
        first += n;
    }
    fputs("</table>\n", page);
    dalcs_convergence_write_method(page, c, "<p>", "</p>\n");
    dalcs_page_file(page, "The netlist", c->path);
    dalcs_page_end(page);
    return status;
}
