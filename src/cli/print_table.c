/* print_table.c - one table for each .print, in ngspice's layout, not cut into pages.
 *
 * Rows come once for all tables: those of the second and later ones wait in memory. */
#include "print_table.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char rule[] =
    "--------------------------------------------------------------------------------\n";

enum { WIDTH = 80, COLUMN = 16 };

/* ---- Which columns -------------------------------------------------------------------------- */

static enum dalcs_status add_column(struct dalcs_print_card_table *table, size_t *capacity,
                                    struct dalcs_print_table_column column) {
    DALCS_TRY(dalcs_grow(&table->column, capacity, table->n_columns + 1, sizeof *table->column));
    table->column[table->n_columns++] = column;
    return DALCS_OK;
}

static enum dalcs_status add_card(struct dalcs_print_card_table *table,
                                  const struct dalcs_session *session, size_t card,
                                  const struct dalcs_plot *plot) {
    struct dalcs_print print;
    size_t capacity = 0;
    for (size_t k = 0; dalcs_session_print(session, card, (int)plot->analysis, k, &print); k++) {
        size_t i = 0;
        while (i < plot->n_signals && strcmp(plot->name[i], print.signal) != 0) {
            i++;
        }
        if (i < plot->n_signals) {
            const struct dalcs_print_table_column column = {i, print.title, print.part};
            DALCS_TRY(add_column(table, &capacity, column));
        }
    }
    return DALCS_OK;
}

static enum dalcs_status add_all(struct dalcs_print_card_table *table,
                                 const struct dalcs_plot *plot) {
    size_t capacity = 0;
    for (size_t i = 0; i < plot->n_signals; i++) {
        const struct dalcs_print_table_column column = {i, plot->name[i], DALCS_PRINT_PLAIN};
        DALCS_TRY(add_column(table, &capacity, column));
    }
    return DALCS_OK;
}

static void forget_tables(struct dalcs_print_table *print) {
    for (size_t k = 0; k < print->n_tables; k++) {
        free(print->table[k].column);
        free(print->table[k].kept);
    }
    free(print->table);
    print->table = NULL;
    print->n_tables = 0;
}

static enum dalcs_status choose_tables(struct dalcs_print_table *print,
                                       const struct dalcs_session *session) {
    const struct dalcs_plot *plot = print->plot;
    const size_t n_cards = dalcs_session_request(session).n_prints;
    print->table = dalcs_alloc(n_cards + 1, sizeof *print->table);
    if (print->table == NULL) {
        return DALCS_E_NOMEM;
    }
    if ((n_cards == 0 && plot->analysis != DALCS_OPERATING_POINT) ||
        plot->analysis == DALCS_TRANSFER) {
        return add_all(&print->table[print->n_tables++], plot);
    }
    for (size_t k = 0; k < n_cards; k++) {
        struct dalcs_print_card_table *table = &print->table[print->n_tables++];
        DALCS_TRY(add_card(table, session, k, plot));
        print->n_tables -= table->n_columns == 0;
    }
    return DALCS_OK;
}

/* ---- Printing --------------------------------------------------------------------------------- */

static bool has_scale(const struct dalcs_plot *plot) {
    return !dalcs_analysis_is_point(plot->analysis);
}

static bool is_pair(const struct dalcs_plot *plot, const struct dalcs_print_table_column *column) {
    return plot->is_complex && column->part == DALCS_PRINT_PLAIN;
}

static void print_heading(const struct dalcs_print_table *print,
                          const struct dalcs_print_card_table *table) {
    static const char *const analysis[] = {[DALCS_OPERATING_POINT] = "Operating Point",
                                           [DALCS_TRANSIENT] = "Transient Analysis",
                                           [DALCS_PERIODIC] = "Periodic Steady State",
                                           [DALCS_DC_SWEEP] = "DC transfer characteristic",
                                           [DALCS_AC] = "AC Analysis",
                                           [DALCS_TRANSFER] = "Transfer Function"};
    const struct dalcs_plot *plot = print->plot;
    FILE *out = print->out;
    const size_t length = strlen(plot->title);
    const int indent = length < WIDTH ? (int)(WIDTH - length) / 2 : 0;
    fprintf(out, "%*s%s\n%*s%s", indent, "", plot->title, indent, "", analysis[plot->analysis]);
    for (size_t k = 0; k < plot->n_parameters; k++) {
        fprintf(out, "  %s=%g", plot->parameter[k], plot->parameter_value[k]);
    }
    fprintf(out, "\n%sIndex   ", rule);
    if (has_scale(plot)) {
        fprintf(out, "%-*s", COLUMN, plot->scale);
    }
    for (size_t k = 0; k < table->n_columns; k++) {
        const int columns = is_pair(plot, &table->column[k]) ? 2 : 1;
        fprintf(out, "%-*s", columns * COLUMN, table->column[k].title);
    }
    fprintf(out, "\n%s", rule);
}

/* The sign takes the place of a digit. */
static void print_number(FILE *out, double value) {
    fprintf(out, "%.*e", signbit(value) ? 5 : 6, value);
}

static double part_of(enum dalcs_print_part part, double re, double im) {
    switch (part) {
    case DALCS_PRINT_MAGNITUDE:
        return hypot(re, im);
    case DALCS_PRINT_DECIBEL:
        return 20.0 * log10(hypot(re, im));
    case DALCS_PRINT_PHASE:
        return atan2(im, re);
    case DALCS_PRINT_IMAGINARY:
        return im;
    default:
        return re;
    }
}

/* value[2 n_columns]: real and imaginary parts. */
static void print_row(const struct dalcs_print_table *print, struct dalcs_print_card_table *table,
                      double scale, const double *value) {
    FILE *out = print->out;
    if (table->n_rows == 0) {
        print_heading(print, table);
    }
    fprintf(out, "%zu\t", table->n_rows++);
    if (has_scale(print->plot)) {
        print_number(out, scale);
        fputc('\t', out);
    }
    for (size_t k = 0; k < table->n_columns; k++) {
        const double re = value[2 * k];
        const double im = value[2 * k + 1];
        print_number(out, part_of(table->column[k].part, re, im));
        if (is_pair(print->plot, &table->column[k])) {
            fputs(",\t", out);
            print_number(out, im);
        }
        fputc('\t', out);
    }
    fputc('\n', out);
}

static void print_operating_point(const struct dalcs_print_table *print, const double *value) {
    const struct dalcs_plot *plot = print->plot;
    for (int unit = DALCS_VOLT; unit <= DALCS_AMPERE; unit++) {
        const bool is_voltage = unit == DALCS_VOLT;
        fprintf(print->out, "\n\t%-32s %s\n\t%-32s -------\n", is_voltage ? "Node" : "Source",
                is_voltage ? "Voltage" : "Current", is_voltage ? "----" : "------");
        for (size_t i = 0; i < plot->n_signals; i++) {
            if ((int)plot->unit[i] == unit || (is_voltage && plot->unit[i] == DALCS_UNIT_NONE)) {
                fprintf(print->out, "\t%-32s %.6e\n", plot->name[i], value[i]);
            }
        }
    }
    fputc('\n', print->out);
}

/* ---- The run ---------------------------------------------------------------------------------- */

enum dalcs_status dalcs_print_table_begin(struct dalcs_print_table *print,
                                          const struct dalcs_session *session,
                                          const struct dalcs_plot *plot) {
    if (print->out == NULL) {
        return DALCS_OK;
    }
    forget_tables(print);
    print->plot = plot;
    return choose_tables(print, session);
}

enum dalcs_status dalcs_print_table_row(struct dalcs_print_table *print, double scale,
                                        const double *value) {
    if (print->out == NULL) {
        return DALCS_OK;
    }
    if (print->plot->analysis == DALCS_OPERATING_POINT) {
        print_operating_point(print, value);
    }
    const bool is_complex = print->plot->is_complex;
    for (size_t k = 0; k < print->n_tables; k++) {
        struct dalcs_print_card_table *table = &print->table[k];
        const size_t size = 1 + 2 * table->n_columns;
        DALCS_TRY(
            dalcs_grow(&table->kept, &table->capacity, (table->n_kept + 1) * size, sizeof(double)));
        double *row = table->kept + table->n_kept * size;
        row[0] = scale;
        for (size_t i = 0; i < table->n_columns; i++) {
            const size_t signal = table->column[i].signal;
            row[1 + 2 * i] = value[is_complex ? 2 * signal : signal];
            row[2 + 2 * i] = is_complex ? value[2 * signal + 1] : 0.0;
        }
        if (k == 0) {
            print_row(print, table, scale, row + 1);
        } else {
            table->n_kept++;
        }
    }
    return DALCS_OK;
}

void dalcs_print_table_end(struct dalcs_print_table *print) {
    for (size_t k = 0; k < print->n_tables; k++) {
        struct dalcs_print_card_table *table = &print->table[k];
        const size_t size = 1 + 2 * table->n_columns;
        for (size_t i = 0; i < table->n_kept; i++) {
            print_row(print, table, table->kept[i * size], table->kept + i * size + 1);
        }
        if (table->n_rows > 0) {
            fputc('\n', print->out);
        }
    }
    forget_tables(print);
}

void dalcs_print_table_finish(struct dalcs_print_table *print) {
    dalcs_print_table_end(print);
}
