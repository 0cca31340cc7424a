/* print_table.c - one table of all signals that are recorded, not cut into pages. */
#include "print_table.h"

static const char rule[] =
    "--------------------------------------------------------------------------------\n";

void dalcs_print_table_begin(struct dalcs_print_table *table, const struct dalcs_plot *plot) {
    table->plot = plot;
    table->n_rows = 0;
    if (!table->out || plot->analysis != DALCS_TRANSIENT) {
        return;
    }
    fprintf(table->out, "%38s%s\n%38s%s\n%s", "", plot->title, "", "Transient Analysis", rule);
    fprintf(table->out, "%-8s%-16s", "Index", "time");
    for (size_t i = 0; i < plot->n_signals; i++) {
        fprintf(table->out, "%-16s", plot->name[i]);
    }
    fprintf(table->out, "\n%s", rule);
}

static void write_operating_point(const struct dalcs_print_table *table, const double *value) {
    const struct dalcs_plot *plot = table->plot;
    for (int unit = DALCS_VOLT; unit <= DALCS_AMPERE; unit++) {
        bool is_voltage = unit == DALCS_VOLT;
        fprintf(table->out, "\n\t%-32s %s\n\t%-32s -------\n", is_voltage ? "Node" : "Source",
                is_voltage ? "Voltage" : "Current", is_voltage ? "----" : "------");
        for (size_t i = 0; i < plot->n_signals; i++) {
            if ((int)plot->unit[i] == unit || (is_voltage && plot->unit[i] == DALCS_UNIT_NONE)) {
                fprintf(table->out, "\t%-32s %.6e\n", plot->name[i], value[i]);
            }
        }
    }
}

void dalcs_print_table_row(struct dalcs_print_table *table, double time, const double *value) {
    if (!table->out) {
        return;
    }
    if (table->plot->analysis != DALCS_TRANSIENT) {
        write_operating_point(table, value);
        return;
    }
    fprintf(table->out, "%zu\t%.6e\t", table->n_rows++, time);
    for (size_t i = 0; i < table->plot->n_signals; i++) {
        fprintf(table->out, "%.6e\t", value[i]);
    }
    fputc('\n', table->out);
}
