/* bode_lines.c - a response in a few lines. */
#include "bode_lines.h"

#include "quantity.h"
#include "run_help.h"

#include <math.h>

enum { MOST_MARGINS = 4, DIGITS = 9 };

const char dalcs_bode_help[] =
    "usage: dalcs bode FILE [options]\n"
    "\n"
    "The small-signal response of a circuit around its periodic steady state, switching included,\n"
    "exact at every frequency: what .ac is behind .pss. Writes complex rows over frequency, of "
    "the\n"
    "sources that the netlist marks with AC, or the gain of a loop and its margins. Other\n"
    "analyses of the netlist are left out.\n"
    "\n"
    "      --loop V        the gain of the loop in which the voltage source V lies, with its "
    "first\n"
    "                      node where the signal comes from, and no other source\n"
    "      --injection I   how that is found: voltage (default), where the loop goes on from V "
    "into\n"
    "                      what takes no current; both, a current besides, anywhere in a loop\n"
    "      --from F        the first frequency, Hz (default: that of .ac, else 1e-4 of the "
    "orbit's)\n"
    "      --to F          the last one (default: that of .ac, else 1/2 of the orbit's)\n"
    "      --points N      how many in a decade (default: those of .ac, else 20)\n"
    "      --sideband N    rows are of the components N frequencies of the orbit higher (default: "
    "0)\n"
    "      --period T      the period in s, a multiple of that of each source (default: the\n"
    "                      smallest common one)\n" DALCS_RUN_OPTIONS DALCS_LAST_OPTIONS "\n"
    "examples:\n"
    "  dalcs bode buck.cir -o response.raw\n"
    "  dalcs bode buck.cir --loop vloop --report margins.json\n"
    "  dalcs bode buck.cir --from 10 --to 200k --points 50\n"
    "\n"
    "exit status: 0 ok, 1 the run failed, 2 usage, 3 error in the netlist, 4 input/output\n";

static void write_margins(FILE *out, const struct dalcs_margin *margin, size_t n, const char *what,
                          const char *unit) {
    for (size_t k = 0; k < n && k < MOST_MARGINS; k++) {
        char frequency[DALCS_QUANTITY_SIZE];
        fprintf(out, "  %s at %s: margin %.6g %s\n", what,
                dalcs_quantity_write(frequency, margin[k].frequency, "Hz", DIGITS),
                margin[k].margin, unit);
    }
    if (n > MOST_MARGINS) {
        fprintf(out, "            and %zu more\n", n - MOST_MARGINS);
    }
}

void dalcs_bode_lines_write(FILE *out, const struct dalcs_report *report) {
    char frequency[DALCS_QUANTITY_SIZE];
    if (!report->response.present) {
        return;
    }
    fprintf(out, "  response  around the orbit of %s",
            dalcs_quantity_write(frequency, 1.0 / report->response.period, "Hz", DIGITS));
    if (report->response.sideband != 0) {
        fprintf(out, ", sideband %+d", report->response.sideband);
    }
    fputs(report->response.exact ? "\n" : " (nearly)\n", out);
    if (report->response.loop == NULL) {
        return;
    }
    write_margins(out, report->response.crossover, report->response.n_crossovers, "gain 1   ",
                  "deg");
    write_margins(out, report->response.reversal, report->response.n_reversals, "phase 180", "dB");
    if (report->response.n_crossovers == 0) {
        fprintf(out, "  loop      the gain of %s is nowhere 1\n", report->response.loop);
    }
}
