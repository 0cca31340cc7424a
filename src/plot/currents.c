/* currents.c - when diodes and switches conduct, told by their currents. */
#include "selection.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include <strings.h>

#define CONDUCTS 1e-6 /* of the largest current */

/* "d1" of "i(d1)" and "@d1[id]"; false for other signals and for elements that do not switch. An
 * element within subcircuits is x1.d1, in ngspice d.x1.d1. */
static bool find_element(const char *signal, char *name, size_t size) {
    size_t n = strlen(signal), skip = 0;
    if (n > 3 && strncasecmp(signal, "i(", 2) == 0 && signal[n - 1] == ')') {
        skip = 2;
        n -= 3;
    } else if (n > 4 && signal[0] == '@' && strchr(signal, '[')) {
        skip = 1;
        n = (size_t)(strchr(signal, '[') - signal) - 1;
    } else {
        return false;
    }
    if (n == 0 || n >= size) {
        return false;
    }
    for (size_t i = 0; i < n; i++) {
        name[i] = (char)tolower((unsigned char)signal[skip + i]);
    }
    name[n] = '\0';
    const char *last = strrchr(name, '.');
    return strchr("dsw", last ? last[1] : name[0]) && (last ? last[1] : name[0]) != '\0';
}

/* Rows stand on both sides of events: a current that starts did so in the row before. */
static enum dalcs_status follow(const struct dalcs_waveforms *waveforms, size_t column,
                                const char *name, struct dalcs_conduction *conduction) {
    const size_t n = waveforms->n_columns;
    const double *value = waveforms->value;
    double largest = 0.0;
    for (size_t k = 0; k < waveforms->n_rows; k++) {
        largest = fmax(largest, fabs(value[k * n + column]));
    }
    bool on = fabs(value[column]) > CONDUCTS * largest;
    DALCS_TRY(dalcs_conduction_add_element(conduction, name, on));
    for (size_t k = 1; k < waveforms->n_rows; k++) {
        bool now = fabs(value[k * n + column]) > CONDUCTS * largest;
        if (now != on) {
            DALCS_TRY(dalcs_conduction_add(conduction, name, value[(now ? k - 1 : k) * n], now));
        }
        on = now;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_selection_add_conduction(const struct dalcs_selection *selection,
                                                 struct dalcs_conduction *conduction) {
    const struct dalcs_waveforms *waveforms = selection->waveforms;
    if (waveforms->dimension[0].second != 1 || waveforms->complex_values) {
        return DALCS_OK;
    }
    for (size_t c = 1; c < waveforms->n_columns; c++) {
        char name[128];
        if (find_element(waveforms->name[c], name, sizeof name) &&
            dalcs_names_find(&conduction->names, name) < 0) {
            DALCS_TRY(follow(waveforms, c, name, conduction));
        }
    }
    dalcs_conduction_sort(conduction);
    return DALCS_OK;
}
