/* comparison_text.c - a comparison in words: what was measured, tables for a terminal, and what it comes
 * to. Where ngspice is better, that comes first. */
#include "comparison.h"

#include "quantity.h"

#include <math.h>
#include <string.h>

#define ROUNDING 1e-13 /* over the scale; smaller differences are rounding */

enum { MAX_GIVEN_UP = 3, MAX_NAMED = 6, SETTING_SIZE = 128 };

static const char *trial_text(const struct dalcs_comparison *c, int k, char text[SETTING_SIZE]) {
    FILE *stream = fmemopen(text, SETTING_SIZE, "w");
    text[0] = '\0';
    if (stream) {
        dalcs_trial_write(stream, &c->search, &c->search.trial[k].options);
        fclose(stream);
    }
    text[SETTING_SIZE - 1] = '\0';
    return text;
}

static const char *row_text(const struct dalcs_comparison *c, int k, char text[SETTING_SIZE]) {
    FILE *stream = fmemopen(text, SETTING_SIZE, "w");
    text[0] = '\0';
    if (stream) {
        dalcs_comparison_row_write(stream, &c->row[k]);
        fclose(stream);
    }
    text[SETTING_SIZE - 1] = '\0';
    return text;
}

void dalcs_comparison_write_method(FILE *stream, const struct dalcs_comparison *c,
                                   const char *before, const char *after) {
    const struct dalcs_reference *r = &c->reference;
    char a[DALCS_QUANTITY_SIZE], b[DALCS_QUANTITY_SIZE];
    fprintf(stream, "%sdalcs %s and %s on the same circuit, from %s to %s, %zu signals.%s", before,
            dalcs_version(), c->ngspice.version, dalcs_quantity_write(a, r->start, "s", 4),
            dalcs_quantity_write(b, r->stop, "s", 4), r->n_signals, after);
    fprintf(
        stream,
        "%sReference: dalcs, radau with %d stages and tolerance %g; with %d stages and tolerance "
        "%g it differs by at most %.1e (%s).%s",
        before, r->stages, r->tolerance, r->second_stages, r->second_tolerance,
        r->doubt[r->most_doubt], r->samples.plot->name[r->most_doubt], after);
    fprintf(
        stream,
        "%sErrors are rms over time over the signal's scale, its largest value in the reference "
        "but not less than 1 %% of the largest of its unit: at %zu times, none within %s of the "
        "%zu times where a diode or switch changes or a source has an edge",
        before, r->times.n_measured, dalcs_quantity_write(a, r->times.window, "s", 3), r->breaks.n);
    if (r->jumps.n > 0) {
        fprintf(stream, ", nor within %s of the %zu where states jump",
                dalcs_quantity_write(a, r->jumps.window, "s", 3), r->jumps.n);
    }
    fprintf(stream, ".%s", after);
    fprintf(
        stream,
        "%sThe reference is the circuit with ideal devices; what ngspice's near-ideal ones leak "
        "or drop is part of its error. Between its points the better of straight line and cubic "
        "counts.%s",
        before, after);
    fprintf(stream,
            "%sTimes are CPU times of the transient on this machine, results written to a file: of "
            "ngspice that of its process less %.0f ms for one that reads the netlist and stops.%s",
            before, 1e3 * c->ngspice.start_cpu_s, after);
}

/* ---- What it comes to ------------------------------------------------------------------------ */

/* Levels that the same two settings serve best share a sentence. */
static void write_faster(FILE *stream, const struct dalcs_comparison *c, bool ngspice_wins,
                         const char *before, const char *after) {
    for (int i = 0, next; i < DALCS_N_LEVELS; i = next) {
        int ours = dalcs_comparison_fastest(c, dalcs_error_level[i]);
        int theirs = dalcs_ngspice_search_fastest(&c->search, dalcs_error_level[i]);
        for (next = i + 1;
             next < DALCS_N_LEVELS &&
             dalcs_comparison_fastest(c, dalcs_error_level[next]) == ours &&
             dalcs_ngspice_search_fastest(&c->search, dalcs_error_level[next]) == theirs;) {
            next++;
        }
        if (ours < 0 || theirs < 0) {
            continue;
        }
        double dalcs_s = c->row[ours].cost.cpu_s, ngspice_s = c->search.trial[theirs].cpu_s;
        if ((ngspice_s < dalcs_s) == ngspice_wins) {
            char a[DALCS_QUANTITY_SIZE], b[DALCS_QUANTITY_SIZE];
            fprintf(stream, "%s%s is faster for an error of %g", before,
                    ngspice_wins ? "ngspice" : "dalcs", dalcs_error_level[i]);
            if (next > i + 1) {
                fprintf(stream, " down to %g", dalcs_error_level[next - 1]);
            }
            fprintf(stream, ": %s against %s, a factor of %.3g.%s",
                    dalcs_quantity_write(a, fmin(dalcs_s, ngspice_s), "s", 3),
                    dalcs_quantity_write(b, fmax(dalcs_s, ngspice_s), "s", 3),
                    fmax(dalcs_s, ngspice_s) / fmin(dalcs_s, ngspice_s), after);
        }
    }
}

static void write_better_signals(FILE *stream, const struct dalcs_comparison *c, const char *before,
                                 const char *after) {
    const struct dalcs_deviation *ours = &c->row[0].deviation;
    const struct dalcs_deviation *theirs = &c->search.trial[c->search.best].deviation;
    int n = 0;
    for (size_t s = 0; s < c->reference.n_signals; s++) {
        double known = fmax(c->reference.doubt[s], ROUNDING);
        if (!c->reference.is_open[s] && theirs->rms[s] < ours->rms[s] && ours->rms[s] > known) {
            if (n == 0) {
                fprintf(stream,
                        "%sngspice's most exact setting is nearer to the reference than "
                        "dalcs's default in ",
                        before);
            }
            if (n < MAX_NAMED) {
                fprintf(stream, "%s%s", n > 0 ? ", " : "", c->reference.samples.plot->name[s]);
            }
            n++;
        }
    }
    if (n > MAX_NAMED) {
        fprintf(stream, " and %d more", n - MAX_NAMED);
    }
    fputs(n > 0 ? "." : "", stream);
    fputs(n > 0 ? after : "", stream);
}

static void write_accuracy(FILE *stream, const struct dalcs_comparison *c, const char *before,
                           const char *after) {
    double ours = c->row[0].deviation.worst_rms;
    if (c->search.best < 0) {
        fprintf(stream, "%sngspice got to the end with none of %d settings.%s", before,
                c->search.n_trials, after);
        return;
    }
    double theirs = c->search.trial[c->search.best].deviation.worst_rms;
    fprintf(stream, "%s%s is more exact: %.1e in the worst signal against %.1e%s%s", before,
            theirs < ours ? "ngspice's most exact setting" : "dalcs by default", fmin(ours, theirs),
            fmax(ours, theirs),
            theirs < ours ? " of dalcs by default." : " of ngspice's most exact setting.", after);
    if (c->reference.doubt[c->reference.most_doubt] > 0.1 * fmin(ours, theirs)) {
        fprintf(stream, "%sThe reference itself is not known much better than that.%s", before,
                after);
    }
}

void dalcs_comparison_write_verdict(FILE *stream, const struct dalcs_comparison *c,
                                    const char *before, const char *after) {
    if (c->search.best >= 0) {
        write_faster(stream, c, true, before, after);
        write_better_signals(stream, c, before, after);
    }
    write_accuracy(stream, c, before, after);
    if (c->search.best >= 0) {
        write_faster(stream, c, false, before, after);
    }
    if (c->search.n_gave_up > 0 && c->search.best >= 0) {
        fprintf(stream, "%sngspice gave up with %d of %d settings.%s", before, c->search.n_gave_up,
                c->search.n_trials, after);
    }
    for (size_t s = 0; s < c->reference.n_signals; s++) {
        if (c->reference.is_open[s]) {
            fprintf(stream, "%sThe circuit does not determine %s: it is not compared.%s", before,
                    c->reference.samples.plot->name[s], after);
        }
    }
}

/* ---- For a terminal -------------------------------------------------------------------------- */

static void write_line(FILE *stream, const char *program, const struct dalcs_deviation *deviation,
                       size_t points, double cpu_s, const char *setting) {
    char text[DALCS_QUANTITY_SIZE];
    fprintf(stream, "  %-7s  %9.1e  %9.1e  %8zu  %8s  %s\n", program, deviation->worst_rms,
            deviation->worst_largest, points, dalcs_quantity_write(text, cpu_s, "s", 3), setting);
}

static void write_settings(FILE *stream, const struct dalcs_comparison *c) {
    char text[SETTING_SIZE];
    fputs("\n  program  rms error    largest    points       CPU  setting\n", stream);
    for (int k = 0; k < c->n_rows; k++) {
        if (!c->row[k].failed) {
            write_line(stream, "dalcs", &c->row[k].deviation, c->row[k].cost.points,
                       c->row[k].cost.cpu_s, row_text(c, k, text));
        }
    }
    const int chosen[] = {c->search.stock, c->search.best};
    for (int i = 0; i < 2; i++) {
        int k = chosen[i];
        if (k >= 0 && (i == 0 || k != chosen[0])) {
            const struct dalcs_trial *trial = &c->search.trial[k];
            write_line(stream, "ngspice", &trial->deviation, trial->points, trial->cpu_s,
                       trial_text(c, k, text));
        }
    }
    fprintf(stream, "  (ngspice: stock devices at their best, and the most exact of %d settings)\n",
            c->search.n_trials);
}

static void write_levels(FILE *stream, const struct dalcs_comparison *c) {
    fputs("\n  fastest for an error of at most\n", stream);
    for (int i = 0; i < DALCS_N_LEVELS; i++) {
        char time[DALCS_QUANTITY_SIZE], text[SETTING_SIZE];
        int ours = dalcs_comparison_fastest(c, dalcs_error_level[i]);
        int theirs = dalcs_ngspice_search_fastest(&c->search, dalcs_error_level[i]);
        fprintf(stream, "    %-6g  dalcs    ", dalcs_error_level[i]);
        if (ours >= 0) {
            fprintf(stream, "%8s  %s\n",
                    dalcs_quantity_write(time, c->row[ours].cost.cpu_s, "s", 3),
                    row_text(c, ours, text));
        } else {
            fputs("  none\n", stream);
        }
        fputs("            ngspice  ", stream);
        if (theirs >= 0) {
            fprintf(stream, "%8s  %s\n",
                    dalcs_quantity_write(time, c->search.trial[theirs].cpu_s, "s", 3),
                    trial_text(c, theirs, text));
        } else {
            fputs("  none\n", stream);
        }
    }
}

static int longest_name(const struct dalcs_plot *plot) {
    size_t longest = strlen("signal");
    for (size_t s = 0; s < plot->n_signals; s++) {
        longest = strlen(plot->name[s]) > longest ? strlen(plot->name[s]) : longest;
    }
    return (int)longest;
}

static void write_signals(FILE *stream, const struct dalcs_comparison *c) {
    const struct dalcs_plot *plot = c->reference.samples.plot;
    int width = longest_name(plot);
    const int chosen[] = {c->search.best, c->search.stock};
    fprintf(stream, "\n  %-*s      scale      dalcs    ngspice      stock   (rms errors)\n", width,
            "signal");
    for (size_t s = 0; s < c->reference.n_signals; s++) {
        char text[DALCS_QUANTITY_SIZE];
        const char *unit = plot->unit[s] == DALCS_VOLT ? "V" : "A";
        fprintf(stream, "  %-*s  %9s", width, plot->name[s],
                dalcs_quantity_write(text, c->reference.scale[s], unit, 3));
        if (c->reference.is_open[s]) {
            fputs("  not determined by the circuit\n", stream);
            continue;
        }
        fprintf(stream, "  %9.1e", c->row[0].deviation.rms[s]);
        for (int i = 0; i < 2; i++) {
            if (chosen[i] >= 0) {
                fprintf(stream, "  %9.1e", c->search.trial[chosen[i]].deviation.rms[s]);
            } else {
                fputs("          -", stream);
            }
        }
        fputc('\n', stream);
    }
}

static void write_given_up(FILE *stream, const struct dalcs_comparison *c) {
    int n = 0;
    for (int k = 0; k < c->search.n_trials && n < MAX_GIVEN_UP; k++) {
        const struct dalcs_trial *trial = &c->search.trial[k];
        if (trial->reason[0] != '\0') {
            char text[SETTING_SIZE], time[DALCS_QUANTITY_SIZE];
            fputs(n++ == 0 ? "\n  ngspice gave up, for instance\n" : "", stream);
            fprintf(stream, "    at %s with %s: %s\n",
                    dalcs_quantity_write(time, trial->reached, "s", 4), trial_text(c, k, text),
                    trial->reason);
        }
    }
}

void dalcs_comparison_write_text(FILE *stream, const struct dalcs_comparison *c) {
    fprintf(stream, "%s\n", c->path);
    dalcs_comparison_write_method(stream, c, "  ", "\n");
    write_settings(stream, c);
    write_levels(stream, c);
    write_signals(stream, c);
    write_given_up(stream, c);
    fputc('\n', stream);
    dalcs_comparison_write_verdict(stream, c, "  ", "\n");
}
