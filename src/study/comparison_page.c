/* comparison_page.c - a comparison as one page: verdict, figures, tables, both netlists. */
#include "chart.h"
#include "comparison.h"
#include "study_page.h"

#include <errno.h>
#include <string.h>

/* All settings of both programs. */
static void write_settings(FILE *page, const struct dalcs_comparison *c) {
    fputs("<h2>All settings</h2>\n<table>\n<tr><th class=\"t\">program</th><th class=\"t\">setting"
          "</th><th>rms error</th><th>largest</th><th class=\"t\">worst signal</th><th>points</th>"
          "<th>CPU</th></tr>\n",
          page);
    for (int k = 0; k < c->n_rows; k++) {
        const struct dalcs_comparison_row *row = &c->row[k];
        if (row->failed) {
            continue;
        }
        fprintf(page, "<tr%s><td class=\"t\">dalcs</td><td class=\"t\">",
                k == 0 ? " class=\"best\"" : "");
        dalcs_comparison_row_write(page, row);
        fputs("</td>", page);
        dalcs_page_error_cell(page, row->deviation.worst_rms);
        dalcs_page_error_cell(page, row->deviation.worst_largest);
        fputs("<td class=\"t\">", page);
        dalcs_page_text(page, c->reference.samples.plot->name[row->deviation.worst]);
        fprintf(page, "</td><td>%zu</td>", row->cost.points);
        dalcs_page_quantity_cell(page, row->cost.cpu_s, "s");
        fputs("</tr>\n", page);
    }
    for (int k = 0; k < c->search.n_trials; k++) {
        const struct dalcs_trial *trial = &c->search.trial[k];
        fprintf(page, "<tr%s><td class=\"t\">ngspice</td><td class=\"t\">",
                k == c->search.best || k == c->search.stock ? " class=\"best\"" : "");
        dalcs_trial_write(page, &c->search, &trial->options);
        if (trial->reason[0] != '\0') {
            fputs("</td><td class=\"t no\" colspan=\"5\">gave up at ", page);
            fprintf(page, "%.4g s: ", trial->reached);
            dalcs_page_text(page, trial->reason);
            fputs("</td></tr>\n", page);
            continue;
        }
        fputs("</td>", page);
        dalcs_page_error_cell(page, trial->deviation.worst_rms);
        dalcs_page_error_cell(page, trial->deviation.worst_largest);
        fputs("<td class=\"t\">", page);
        dalcs_page_text(page, c->reference.samples.plot->name[trial->deviation.worst]);
        fprintf(page, "</td><td>%zu</td>", trial->points);
        dalcs_page_quantity_cell(page, trial->cpu_s, "s");
        fputs("</tr>\n", page);
    }
    fputs("</table>\n<p>In bold: dalcs by default; ngspice with stock devices at their best, and "
          "its "
          "most exact setting.</p>\n",
          page);
}

/* The time of the faster one is bold. */
static void write_levels(FILE *page, const struct dalcs_comparison *c) {
    fputs("<h2>Fastest for a given error</h2>\n<table>\n<tr><th>rms error<br>at most</th>"
          "<th>dalcs</th><th class=\"t\">setting</th><th>ngspice</th><th class=\"t\">setting</th>"
          "</tr>\n",
          page);
    for (int i = 0; i < DALCS_N_LEVELS; i++) {
        int ours = dalcs_comparison_fastest(c, dalcs_error_level[i]);
        int theirs = dalcs_ngspice_search_fastest(&c->search, dalcs_error_level[i]);
        fprintf(page, "<tr><td>%g</td>", dalcs_error_level[i]);
        if (ours >= 0) {
            dalcs_page_quantity_cell(page, c->row[ours].cost.cpu_s, "s");
            fputs("<td class=\"t\">", page);
            dalcs_comparison_row_write(page, &c->row[ours]);
            fputs("</td>", page);
        } else {
            fputs("<td class=\"no\">none</td><td></td>", page);
        }
        if (theirs >= 0) {
            dalcs_page_quantity_cell(page, c->search.trial[theirs].cpu_s, "s");
            fputs("<td class=\"t\">", page);
            dalcs_trial_write(page, &c->search, &c->search.trial[theirs].options);
            fputs("</td></tr>\n", page);
        } else {
            fputs("<td class=\"no\">none</td><td></td></tr>\n", page);
        }
    }
    fputs("</table>\n", page);
}

static void write_signals(FILE *page, const struct dalcs_comparison *c) {
    const struct dalcs_plot *plot = c->reference.samples.plot;
    const struct dalcs_deviation *theirs[] = {
        c->search.best >= 0 ? &c->search.trial[c->search.best].deviation : NULL,
        c->search.stock >= 0 ? &c->search.trial[c->search.stock].deviation : NULL};
    fputs(
        "<h2>Error of each signal</h2>\n<table>\n<tr><th class=\"t\" rowspan=\"2\">signal</th>"
        "<th rowspan=\"2\">scale</th><th colspan=\"2\">dalcs by default</th><th colspan=\"2\">"
        "ngspice, most exact</th><th colspan=\"2\">ngspice, stock</th><th rowspan=\"2\">reference "
        "known to</th></tr>\n<tr><th>rms</th><th>largest</th><th>rms</th><th>largest</th>"
        "<th>rms</th><th>largest</th></tr>\n",
        page);
    for (size_t s = 0; s < c->reference.n_signals; s++) {
        fputs("<tr><td class=\"t\">", page);
        dalcs_page_text(page, plot->name[s]);
        fputs("</td>", page);
        dalcs_page_quantity_cell(page, c->reference.scale[s],
                                 plot->unit[s] == DALCS_VOLT ? "V" : "A");
        if (c->reference.is_open[s]) {
            fputs("<td class=\"t no\" colspan=\"7\">not determined by the circuit</td></tr>\n",
                  page);
            continue;
        }
        dalcs_page_error_cell(page, c->row[0].deviation.rms[s]);
        dalcs_page_error_cell(page, c->row[0].deviation.largest[s]);
        for (int i = 0; i < 2; i++) {
            if (theirs[i]) {
                dalcs_page_error_cell(page, theirs[i]->rms[s]);
                dalcs_page_error_cell(page, theirs[i]->largest[s]);
            } else {
                fputs("<td class=\"no\" colspan=\"2\">none</td>", page);
            }
        }
        dalcs_page_error_cell(page, c->reference.doubt[s]);
        fputs("</tr>\n", page);
    }
    fputs("</table>\n", page);
}

static enum dalcs_status add_figure(FILE *page, const struct dalcs_comparison *c, const char *name,
                                    int height,
                                    void (*draw)(FILE *, const struct dalcs_comparison *),
                                    const char *caption, char message[256]) {
    FILE *script = dalcs_chart_begin(name, 900, height);
    if (!script) {
        snprintf(message, 256, "cannot write a temporary file: %s", strerror(errno));
        return DALCS_E_IO;
    }
    draw(script, c);
    enum dalcs_status status = dalcs_chart_end(script, page, message);
    if (status == DALCS_OK) {
        fprintf(page, "<p>%s</p>\n", caption);
    }
    return status;
}

static enum dalcs_status write_figures(FILE *page, const struct dalcs_comparison *c,
                                       char message[256]) {
    fputs("<h2>Figures</h2>\n", page);
    enum dalcs_status status = add_figure(
        page, c, "work", 420, dalcs_comparison_draw_work,
        "Error against CPU time, each mark one setting. Down and left is better.", message);
    if (status == DALCS_OK) {
        status = add_figure(page, c, "waveforms", 720, dalcs_comparison_draw_waveforms,
                            "The signals in which ngspice's most exact setting errs most, at the "
                            "same times.",
                            message);
    }
    if (status == DALCS_OK) {
        status =
            add_figure(page, c, "errors", 360, dalcs_comparison_draw_errors,
                       "Error of the signal in which ngspice's most exact setting errs most, over "
                       "the signal's scale, at the times that were measured.",
                       message);
    }
    if (status != DALCS_OK) {
        fputs("<p>No figures: ", page);
        dalcs_page_text(page, message);
        fputs("</p>\n", page);
    }
    return status;
}

enum dalcs_status dalcs_comparison_write_page(FILE *page, const struct dalcs_comparison *c,
                                              char message[256]) {
    const char *title = c->reference.samples.plot->title;
    dalcs_page_begin(page, title + strspn(title, "* "));
    fputs("<ul>\n", page);
    dalcs_comparison_write_verdict(page, c, "<li>", "</li>\n");
    fputs("</ul>\n", page);
    enum dalcs_status status = write_figures(page, c, message);
    write_signals(page, c);
    write_levels(page, c);
    write_settings(page, c);
    fputs("<h2>How it was measured</h2>\n", page);
    dalcs_comparison_write_method(page, c, "<p>", "</p>\n");
    dalcs_page_file(page, "The netlist", c->path);
    if (c->search.best_netlist) {
        fputs("<h2>The netlist of ngspice's most exact setting</h2>\n<pre>", page);
        dalcs_page_text(page, c->search.best_netlist);
        fputs("</pre>\n", page);
    }
    dalcs_page_end(page);
    return status;
}
