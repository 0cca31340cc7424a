/* convergence_text.c - errors and orders as a table for a terminal and as CSV. */
#include "convergence.h"

#include "decimal.h"
#include "quantity.h"

#include <math.h>

void dalcs_convergence_write_method(FILE *stream, const struct dalcs_convergence *c,
                                    const char *before, const char *after) {
    const struct dalcs_reference *r = &c->reference;
    char text[DALCS_QUANTITY_SIZE];
    fprintf(
        stream,
        "%sErrors are the largest of %zu signals at %zu common ends of steps, over the signal's "
        "largest value; no time is within %s of the %zu times where a diode or switch changes "
        "or a source has an edge.%s",
        before, r->n_signals, r->times.n_measured,
        dalcs_quantity_write(text, r->times.window, "s", 3), r->breaks.n, after);
    fprintf(
        stream,
        "%sReference: radau with %d stages and tolerance %g; with %d stages and tolerance %g it "
        "differs by at most %.1e (%s). Where an error is not well above that, no order is "
        "given.%s",
        before, r->stages, r->tolerance, r->second_stages, r->second_tolerance,
        r->doubt[r->most_doubt], r->samples.plot->name[r->most_doubt], after);
}

static void write_row(FILE *stream, const struct dalcs_convergence *c,
                      const struct dalcs_convergence_row *row) {
    char text[DALCS_QUANTITY_SIZE];
    fprintf(stream, "    %10s", dalcs_quantity_write(text, row->step, "s", 4));
    if (row->failed) {
        fputs("  failed\n", stream);
        return;
    }
    fprintf(stream, "  %10.3e", row->largest);
    if (isnan(row->order)) {
        fputs("       -", stream);
    } else {
        fprintf(stream, "  %6.2f", row->order);
    }
    fprintf(stream, "  %10ld  %9s  %s\n", row->steps,
            dalcs_quantity_write(text, row->cpu_s, "s", 3),
            c->reference.samples.plot->name[row->worst]);
}

void dalcs_convergence_write_text(FILE *stream, const struct dalcs_convergence *c) {
    fprintf(stream, "%s\n", c->path);
    dalcs_convergence_write_method(stream, c, "  ", "\n");
    for (size_t first = 0; first < c->n_rows;) {
        size_t n = dalcs_convergence_group(c, first);
        double order = dalcs_convergence_order(c, first);
        fputs("\n  ", stream);
        dalcs_stepping_write(stream, &c->row[first].stepping);
        if (!isnan(order)) {
            fprintf(stream, ": order %.2f", order);
        }
        fputs("\n          step       error   order       steps        CPU  worst signal\n",
              stream);
        for (size_t k = 0; k < n; k++) {
            write_row(stream, c, &c->row[first + k]);
        }
        first += n;
    }
}

static void write_number(FILE *stream, const struct dalcs_decimal *decimal, double value) {
    char text[DALCS_DECIMAL_SIZE] = "";
    fputc(',', stream);
    if (!isnan(value)) {
        size_t length = dalcs_decimal_write(decimal, value, text);
        fwrite(text, 1, length, stream);
    }
}

void dalcs_convergence_write_csv(FILE *stream, const struct dalcs_convergence *c) {
    struct dalcs_decimal decimal;
    dalcs_decimal_init(&decimal);
    fputs("method,stages,step,error,rms,order,signal,steps,cpu_s\n", stream);
    for (size_t k = 0; k < c->n_rows; k++) {
        const struct dalcs_convergence_row *row = &c->row[k];
        fprintf(stream, "%s,%d", row->stepping.method,
                row->stepping.stages > 0 ? row->stepping.stages : 1);
        write_number(stream, &decimal, row->step);
        write_number(stream, &decimal, row->failed ? NAN : row->largest);
        write_number(stream, &decimal, row->failed ? NAN : row->rms);
        write_number(stream, &decimal, row->order);
        fprintf(stream, ",\"%s\",%ld", c->reference.samples.plot->name[row->worst], row->steps);
        write_number(stream, &decimal, row->cpu_s);
        fputc('\n', stream);
    }
}
