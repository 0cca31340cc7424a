/* envelope_lines.c - an envelope in a line. */
#include "envelope_lines.h"

#include "quantity.h"
#include "run_help.h"

enum { DIGITS = 10 };

const char dalcs_envelope_help[] =
    "usage: dalcs envelope FILE [options]\n"
    "\n"
    "Runs a slow start of a fast converter, a soft start or a large capacitor that fills: a few "
    "of\n"
    "its periods are run, and leaps over all others follow from their maps, with controlled "
    "error.\n"
    "Writes the rows at the beginnings of these periods. What it runs is the .env of the netlist,\n"
    "else its .tran. Other analyses and .meas are left out.\n"
    "\n"
    "      --stop T        when it ends, s (default: that of .env or .tran)\n"
    "      --show T,T,...  times in s whose periods are written with all rows, as the first and "
    "the\n"
    "                      last one are (default: at= of .env)\n" DALCS_RUN_OPTIONS
        DALCS_LAST_OPTIONS "\n"
    "examples:\n"
    "  dalcs envelope boost.cir\n"
    "  dalcs envelope boost.cir --stop 10 --show 0.1,3 -o start.csv --plot start.html\n"
    "  dalcs envelope boost.cir --tol 1e-3 -q --report start.json\n"
    "\n"
    "exit status: 0 ok, 1 the run failed, 2 usage, 3 error in the netlist, 4 input/output\n";

void dalcs_envelope_lines_write(FILE *out, const struct dalcs_report *report) {
    char period[DALCS_QUANTITY_SIZE];
    if (!report->envelope.present) {
        return;
    }
    fprintf(out,
            "  envelope  %ld periods of %s: %ld run, %ld leaps over the others, each off by %.2g "
            "at most\n",
            report->envelope.periods,
            dalcs_quantity_write(period, report->envelope.period, "s", DIGITS),
            report->envelope.run, report->envelope.leaps, report->envelope.worst);
}
