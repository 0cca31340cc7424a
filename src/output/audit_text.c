/* audit_text.c - the audit of a file on a screen: the laws that are broken, then those that hold. */
#include "audit_text.h"

#include "quantity.h"

#include <string.h>

enum { MOST_HELD = 12, DIGITS = 4, TIME_DIGITS = 6, SPAN_SIZE = 2 * DALCS_QUANTITY_SIZE + 8 };

/* "3.2 ms", "3.2 ms .. 4 ms" */
static const char *write_span(char text[SPAN_SIZE], const struct dalcs_table_law *law) {
    char from[DALCS_QUANTITY_SIZE], to[DALCS_QUANTITY_SIZE];
    dalcs_quantity_write(from, law->from, "s", TIME_DIGITS);
    dalcs_quantity_write(to, law->to, "s", TIME_DIGITS);
    if (law->from == law->to) {
        snprintf(text, SPAN_SIZE, "%s", to);
    } else {
        snprintf(text, SPAN_SIZE, "%s .. %s", from, to);
    }
    return text;
}

static void write_law(FILE *stream, const struct dalcs_table_law *law, int width) {
    char defect[DALCS_QUANTITY_SIZE], allowed[DALCS_QUANTITY_SIZE], span[SPAN_SIZE];
    fprintf(stream, "  %-9s %-*s %11s %11s  %-26s ", law->law, width, law->where,
            dalcs_quantity_write(defect, law->defect, law->unit, DIGITS),
            dalcs_quantity_write(allowed, law->allowed, law->unit, 3), write_span(span, law));
    if (law->n_broken > 0) {
        char since[DALCS_QUANTITY_SIZE];
        fprintf(stream, "broken since %s, %zu of %zu times\n",
                dalcs_quantity_write(since, law->since, "s", TIME_DIGITS), law->n_broken,
                law->n_checked);
    } else if (law->sees > 1.0) {
        fputs("holds, but hardly anything moved\n", stream);
    } else if (law->sees > 0.0) {
        fprintf(stream, "holds, to %.2g %%\n", 100.0 * law->sees);
    } else {
        fputs("holds\n", stream);
    }
}

static int widest(const struct dalcs_table_audit *audit, size_t n) {
    size_t width = strlen("element");
    for (size_t i = 0; i < n; i++) {
        const size_t length = strlen(audit->law[i].where);
        width = length > width ? length : width;
    }
    return (int)width;
}

static void write_laws(FILE *stream, const struct dalcs_table_audit *audit, bool all) {
    size_t n = audit->n_laws;
    if (!all && n > audit->n_broken + MOST_HELD) {
        n = audit->n_broken + MOST_HELD;
    }
    const int width = widest(audit, n);
    fprintf(stream, "\n  %-9s %-*s %11s %11s  %-26s verdict\n", "law", width, "element", "defect",
            "allowed", "at");
    for (size_t i = 0; i < n; i++) {
        write_law(stream, &audit->law[i], width);
    }
    if (n < audit->n_laws) {
        fprintf(stream, "  and %zu more that hold; --all shows them\n", audit->n_laws - n);
    }
}

static void write_foreign(FILE *stream, const struct dalcs_table_audit *audit, bool all) {
    for (size_t i = 0; i < audit->n_foreign; i++) {
        if (i == MOST_HELD && !all) {
            fprintf(stream, " and %zu more", audit->n_foreign - i);
            break;
        }
        fprintf(stream, "%s%s", i == 0 ? "\n  not of this circuit: " : ", ", audit->foreign[i]);
    }
    fputs(audit->n_foreign > 0 ? "\n" : "", stream);
}

static void write_gaps(FILE *stream, const struct dalcs_table_audit *audit, bool all) {
    fputs(audit->n_gaps > 0 ? "\n  not asked:\n" : "", stream);
    for (size_t i = 0; i < audit->n_gaps; i++) {
        if (i == MOST_HELD && !all) {
            fprintf(stream, "  and %zu more; --all shows them\n", audit->n_gaps - i);
            break;
        }
        fprintf(stream, "  %-9s %s: %s\n", audit->gap[i].law, audit->gap[i].where,
                audit->gap[i].because);
    }
}

static void write_verdict(FILE *stream, const struct dalcs_table_audit *audit) {
    if (audit->n_laws == 0) {
        fputs("\n  no law could be checked\n", stream);
    } else if (audit->n_broken == 0) {
        fprintf(stream,
                audit->n_laws == 1 ? "\n  the one law that could be checked holds\n"
                                   : "\n  all %zu laws that could be checked hold\n",
                audit->n_laws);
    } else {
        const struct dalcs_table_law *worst = &audit->law[0];
        char span[SPAN_SIZE], defect[DALCS_QUANTITY_SIZE];
        const bool is_one = audit->n_broken == 1;
        fprintf(stream, "\n  %zu of %zu law%s %s broken, %s%s of %s: by %s at %s\n",
                audit->n_broken, audit->n_laws, audit->n_laws == 1 ? "" : "s",
                is_one ? "is" : "are", is_one ? "" : "most ", worst->law, worst->where,
                dalcs_quantity_write(defect, worst->defect, worst->unit, DIGITS),
                write_span(span, worst));
    }
}

void dalcs_audit_write_text(FILE *stream, const struct dalcs_table_audit *audit, const char *file,
                            bool all) {
    char from[DALCS_QUANTITY_SIZE], to[DALCS_QUANTITY_SIZE];
    fprintf(stream, "%s\n", audit->title != NULL ? audit->title : audit->netlist);
    fprintf(stream, "  file      %s: %zu row%s from %s to %s, %zu signal%s of the circuit\n", file,
            audit->n_rows, audit->n_rows == 1 ? "" : "s",
            dalcs_quantity_write(from, audit->from, "s", TIME_DIGITS),
            dalcs_quantity_write(to, audit->to, "s", TIME_DIGITS), audit->n_used,
            audit->n_used == 1 ? "" : "s");
    fprintf(stream,
            "  allowed   %g of each signal's largest value, and what digits and lines between rows "
            "leave open\n",
            audit->tolerance);
    if (audit->n_laws > 0) {
        write_laws(stream, audit, all);
    }
    write_foreign(stream, audit, all);
    write_gaps(stream, audit, all);
    write_verdict(stream, audit);
}
