/* losses_text.c - elements line by line, then the balance, efficiency and figures of sources. */
#include "losses_text.h"

#include "quantity.h"

#include <math.h>
#include <string.h>

enum { DIGITS = 5 };

/* Below this part of the largest a number is rounding beside it, and shown as 0. */
static const double invisible = 1e-12;

static void write_cell(FILE *out, double value, double largest, const char *unit) {
    char text[DALCS_QUANTITY_SIZE];
    if (isnan(value)) {
        fprintf(out, " %8s   ", "none"); /* where the others have their digits */
        return;
    }
    value = fabs(value) <= invisible * largest ? 0.0 : value;
    fprintf(out, " %11s", dalcs_quantity_write_column(text, value, unit, DIGITS));
}

static void write_elements(FILE *out, const struct dalcs_losses *l) {
    double largest[3] = {0.0, 0.0, 0.0}; /* V, A, W */
    int width = 9;
    for (size_t k = 0; k < l->n_elements; k++) {
        const struct dalcs_element_losses *e = &l->element[k];
        largest[0] = fmax(largest[0], e->v_rms);
        largest[1] = fmax(largest[1], e->i_rms);
        largest[2] = fmax(largest[2], fabs(e->power));
        width = (int)strlen(e->element) > width ? (int)strlen(e->element) : width;
    }
    fprintf(out, "  %-*s %-9s %11s %11s %11s %11s %11s\n", width, "element", "is a", "v average",
            "v rms", "i average", "i rms", "power");
    for (size_t k = 0; k < l->n_elements; k++) {
        const struct dalcs_element_losses *e = &l->element[k];
        fprintf(out, "  %-*s %-9s", width, e->element, e->kind);
        write_cell(out, e->v_average, largest[0], "V");
        write_cell(out, e->v_rms, largest[0], "V");
        write_cell(out, e->i_average, largest[1], "A");
        write_cell(out, e->i_rms, largest[1], "A");
        write_cell(out, e->power, largest[2], "W");
        fputc('\n', out);
    }
}

static void write_sum(FILE *out, const char *name, double joule, const struct dalcs_losses *l) {
    char text[2][DALCS_QUANTITY_SIZE];
    if (fabs(joule) > invisible * l->turnover) {
        fprintf(out, "  %-22s %11s %11s\n", name,
                dalcs_quantity_write_column(text[0], joule / (l->to - l->from), "W", DIGITS),
                dalcs_quantity_write_column(text[1], joule, "J", DIGITS));
    }
}

static void write_sums(FILE *out, const struct dalcs_losses *l) {
    fputc('\n', out);
    write_sum(out, "from sources", l->sources, l);
    write_sum(out, "in resistors", l->resistors, l);
    write_sum(out, "in windings", l->windings, l);
    write_sum(out, "in diodes", l->diodes, l);
    write_sum(out, "in switches", l->switches, l);
    write_sum(out, "in jumps of no element", l->jumps, l);
    write_sum(out, "change stored", l->stored_change, l);
    write_sum(out, "unexplained", l->balance, l);
    write_sum(out, "switching, by tables", l->switching, l);
}

static void write_switching(FILE *out, const struct dalcs_losses *l) {
    char text[DALCS_QUANTITY_SIZE];
    for (size_t k = 0; k < l->n_elements; k++) {
        const struct dalcs_element_losses *e = &l->element[k];
        if (e->switching > 0.0) {
            fprintf(out, "  %s turns on %ld and off %ld times: %s by its tables\n", e->element,
                    e->n_on, e->n_off,
                    dalcs_quantity_write(text, e->switching / (l->to - l->from), "W", DIGITS));
        }
    }
}

static void write_sources(FILE *out, const struct dalcs_losses *l) {
    for (size_t k = 0; k < l->n_elements; k++) {
        const struct dalcs_element_losses *e = &l->element[k];
        if (isfinite(e->power_factor)) {
            fprintf(out, "  %s: power factor %.6g", e->element, e->power_factor);
            if (isfinite(e->thd)) {
                fprintf(out, ", displacement %.6g, THD of its current %.4g %%", e->displacement,
                        100.0 * e->thd);
            }
            fputc('\n', out);
        }
    }
}

void dalcs_losses_text_write(FILE *out, const struct dalcs_losses *l) {
    char text[2][DALCS_QUANTITY_SIZE];
    if (l->of_orbit) {
        fprintf(out, "\n  losses of the orbit, %s", dalcs_quantity_write(text[0], l->to, "s", 9));
    } else {
        fprintf(out, "\n  losses from %s to %s",
                l->from == 0.0 ? "0" : dalcs_quantity_write(text[0], l->from, "s", 9),
                dalcs_quantity_write(text[1], l->to, "s", 9));
    }
    fprintf(out, "%s%s\n", l->step != NULL ? ", " : "", l->step != NULL ? l->step : "");
    write_elements(out, l);
    write_sums(out, l);
    write_switching(out, l);
    write_sources(out, l);
    if (isfinite(l->efficiency) && l->outputs[0] != '\0') {
        fprintf(out, "  efficiency %.6g %%: %s in %s of %s from %s%s\n", 100.0 * l->efficiency,
                dalcs_quantity_write(text[0], l->output, "W", DIGITS), l->outputs,
                dalcs_quantity_write(text[1], l->input, "W", DIGITS), l->inputs,
                l->switching > 0.0 ? " and what switching takes" : "");
        if (l->efficiency > 1.0 && l->stored_change < 0.0) {
            fprintf(out, "  the rest was stored before: take whole periods of the steady state, or "
                         "the orbit of .pss\n");
        }
    }
}
