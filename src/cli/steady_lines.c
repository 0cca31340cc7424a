/* steady_lines.c - an orbit in a few lines. */
#include "steady_lines.h"

#include "quantity.h"
#include "run_help.h"

#include <math.h>

enum { MOST_MULTIPLIERS = 6, DIGITS = 10 };

const char dalcs_steady_help[] =
    "usage: dalcs steady FILE [options]\n"
    "\n"
    "Finds the periodic steady state of a netlist, by Newton's method on the map of one period,\n"
    "and writes one period as waveforms, without a run of the transient before it. Says whether "
    "it\n"
    "is stable, with its Floquet multipliers. Other analyses of the netlist are left out.\n"
    "\n"
    "      --period T      the period in s, a multiple of that of each source (default: the\n"
    "                      smallest common one)\n"
    "      --sensitivity   how much each measurement changes with the value of each element: as\n"
    "                      .sens, which may name the values\n"
    "      --bifurcation FILE   draw a bifurcation diagram over .step: where a run is at the\n"
    "                      multiples of the period, and the orbit of one period: .svg, .png,\n"
    "                      .pdf or .html\n"
    "      --samples N     how many of these multiples for each value (default: 64); then files\n"
    "                      have them as rows\n"
    "      --settle N      periods before the first of them (default: 256)\n"
    "      --multipliers-plot FILE   draw the multipliers and the unit circle: .svg, .png, .pdf "
    "or\n"
    "                      .html\n"
    "      --losses        print what each element takes on average over the orbit, the "
    "efficiency,\n"
    "                      power factors and THD\n"
    "      --losses-plot FILE\n"
    "                      draw what each element loses as bars, .svg, .png or "
    ".pdf\n" DALCS_RUN_OPTIONS DALCS_LAST_OPTIONS "\n"
    "examples:\n"
    "  dalcs steady buck.cir\n"
    "  dalcs steady buck.cir -o period.csv --report buck.json\n"
    "  dalcs steady buck.cir --period 20u\n"
    "\n"
    "exit status: 0 ok, 1 the run failed, 2 usage, 3 error in the netlist, 4 input/output\n";

static void write_counts(FILE *out, const struct dalcs_report *report) {
    char period[DALCS_QUANTITY_SIZE];
    fprintf(out, "  steady    %s %s, %d Newton step%s, %ld period%s",
            report->steady.self_oscillating ? "period of its own" : "period",
            dalcs_quantity_write(period, report->steady.period, "s", DIGITS), report->steady.newton,
            report->steady.newton == 1 ? "" : "s", report->steady.periods,
            report->steady.periods == 1 ? "" : "s");
    if (report->steady.leaps > 0) {
        fprintf(out, ", %d leap%s", report->steady.leaps, report->steady.leaps == 1 ? "" : "s");
    }
    fprintf(out, "; after one more off by %.2g, within %.2g of it\n", report->steady.defect,
            report->steady.distance);
}

static void write_multipliers(FILE *out, const struct dalcs_report *report) {
    const size_t n = report->steady.n_multipliers;
    fprintf(out, "  factors   ");
    for (size_t k = 0; k < n && k < MOST_MULTIPLIERS; k++) {
        const struct dalcs_floquet *m = &report->steady.multiplier[k];
        if (m->im < 0.0) { /* with its conjugate */
            continue;
        }
        fprintf(out, "%s%.9g", k > 0 ? ", " : "", m->re);
        if (m->im > 0.0) {
            fprintf(out, " +- %.9gj", m->im);
        }
    }
    fputs(n == 0                 ? "0: nothing is remembered for a period"
          : n > MOST_MULTIPLIERS ? ", ..."
                                 : "",
          out);
    if (report->steady.self_oscillating) {
        fprintf(out, "; along the orbit %.9g", report->steady.flow);
    }
    fputs(report->steady.exact ? "\n" : " (nearly: the mode is not known all the time)\n", out);
}

void dalcs_steady_lines_write(FILE *out, const struct dalcs_report *report, bool is_last_step) {
    if (!report->steady.present) {
        return;
    }
    write_counts(out, report);
    fprintf(out, "  verdict   %s%s\n", is_last_step ? "of the last step: " : "",
            report->steady.verdict);
    write_multipliers(out, report);
}
