/* audit_columns.c - units in headers, rows out of order, values that are no numbers. */
#include "audit_columns.h"

#include "quantity.h"

#include <math.h>
#include <string.h>

/* ---- Units --------------------------------------------------------------------------------------- */

/* What a unit is in s, V or A: "ms", "uA", "V"; 0: it is none of these. */
static double factor_of(const char *unit, size_t length) {
    static const struct {
        const char *prefix;
        double factor;
    } known[] = {{"", 1.0},          {"f", 1e-15}, {"p", 1e-12}, {"n", 1e-9}, {"u", 1e-6},
                 {"\302\265", 1e-6}, {"m", 1e-3},  {"k", 1e3},   {"M", 1e6}};

    for (size_t k = 0; k < sizeof known / sizeof known[0] && length > 0; k++) {
        const size_t n = strlen(known[k].prefix);
        if (n + 1 == length && strncmp(unit, known[k].prefix, n) == 0 &&
            strchr("sVA", unit[n]) != NULL) {
            return known[k].factor;
        }
    }
    return 0.0;
}

/* The name in front of a unit in brackets; *factor: of that. */
static size_t name_length(const char *name, double *factor) {
    const size_t length = strlen(name);
    const char close = length > 0 ? name[length - 1] : '\0';
    const char open = close == ')' ? '(' : '[';
    const char *bracket = close == ')' || close == ']' ? strrchr(name, open) : NULL;
    *factor = 1.0;
    if (bracket == NULL || bracket == name || (close == ')' && bracket[-1] != ' ')) {
        return length; /* v(in) is a name */
    }
    const double is = factor_of(bracket + 1, (size_t)(name + length - 1 - (bracket + 1)));
    if (is == 0.0) {
        return length;
    }
    *factor = is;
    while (bracket > name && bracket[-1] == ' ') {
        bracket--;
    }
    return (size_t)(bracket - name);
}

enum dalcs_status dalcs_audit_take_units(struct dalcs_waveforms *w) {
    for (size_t c = 0; c < w->n_columns; c++) {
        double factor;
        const size_t length = name_length(w->name[c], &factor);
        if (w->name[c][length] == '\0') {
            continue;
        }
        const char *name = dalcs_arena_copy(&w->arena, w->name[c], length);
        if (name == NULL) {
            return DALCS_E_NOMEM;
        }
        w->name[c] = name;
        w->dimension[c] = dalcs_dimension_of_name(name);
        w->precision[c].absolute *= factor;
        for (size_t k = 0; k < w->n_rows; k++) {
            w->value[k * w->n_columns + c] *= factor;
        }
    }
    return DALCS_OK;
}

/* ---- Rows ---------------------------------------------------------------------------------------- */

/* Where a run begins again the time is at most this part of the one before, from its start on. */
static const double early = 0.5;

enum dalcs_status dalcs_audit_check_order(const struct dalcs_waveforms *w, const char *path,
                                          size_t first, size_t end, struct dalcs_diag *diag) {
    const size_t n = w->n_columns;
    if (end >= w->n_rows || end == first) {
        return DALCS_OK;
    }
    const double start = w->value[first * n];
    const double last = w->value[(end - 1) * n];
    const double next = w->value[end * n];
    if ((next - start) / (last - start) <= early) {
        return DALCS_OK;
    }
    char text[2][DALCS_QUANTITY_SIZE];
    dalcs_diag_add(
        diag, DALCS_ERROR, NULL, "put the rows in order; --run N would take a part of them",
        "'%s': the time goes back from %s to %s at row %zu, and a run would begin at %s", path,
        dalcs_quantity_write(text[0], last, "s", 6), dalcs_quantity_write(text[1], next, "s", 6),
        end + 1, start == 0.0 ? "0 s" : "its start");
    return DALCS_E_OPTION;
}

void dalcs_audit_note_gaps(const struct dalcs_waveforms *w, struct dalcs_diag *diag) {
    const size_t n = w->n_columns;
    size_t n_gaps = 0;
    size_t place = 0;
    for (size_t k = 0; k < w->n_rows * n; k++) {
        if (!isfinite(w->value[k]) && k % n > 0) {
            place = n_gaps == 0 ? k : place;
            n_gaps++;
        }
    }
    if (n_gaps > 0) {
        char time[DALCS_QUANTITY_SIZE];
        dalcs_diag_add(
            diag, DALCS_NOTE, NULL, NULL,
            "%zu value%s %s no number, the first one that of '%s' at %s: laws that read it "
            "are not checked there",
            n_gaps, n_gaps == 1 ? "" : "s", n_gaps == 1 ? "is" : "are", w->name[place % n],
            dalcs_quantity_write(time, w->value[place / n * n], "s", 6));
    }
}
