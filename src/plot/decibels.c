/* decibels.c - the default signals of a Bode plot. */
#include "decibels.h"

#include "figure.h"

#include <math.h>
#include <string.h>

/* Of the largest of all, what some hundred roundings of it come to: a node that a source without a small signal holds. */
static const double is_rounding = 1e-13;

static double largest(const struct dalcs_waveforms *w, size_t column) {
    double most = 0.0;
    for (size_t k = 0; k < w->n_rows; k++) {
        most = fmax(most, fabs(w->value[k * w->n_columns + column]));
    }
    return most;
}

enum dalcs_status dalcs_decibels_choose(const struct dalcs_waveforms *waveforms, const char *loop,
                                        struct dalcs_arena *arena, const char *group[2]) {
    int n = 0;
    double most = 0.0;
    group[0] = group[1] = NULL;
    const char *gain = loop != NULL ? dalcs_arena_printf(arena, "loop(%s)", loop) : NULL;
    for (size_t c = 1; c < waveforms->n_columns && gain == NULL; c += 2) {
        gain = strncmp(waveforms->name[c], "loop(", 5) == 0 ? waveforms->name[c] : NULL;
    }
    if (gain != NULL) {
        group[0] = dalcs_arena_printf(arena, "db(%s)", gain);
        group[1] = dalcs_arena_printf(arena, "phase(%s)", gain);
        return group[0] != NULL && group[1] != NULL ? DALCS_OK : DALCS_E_NOMEM;
    }
    for (size_t c = 1; c + 1 < waveforms->n_columns; c += 2) {
        most = fmax(most, largest(waveforms, c));
    }
    for (size_t c = 1; c + 1 < waveforms->n_columns && n < DALCS_FIGURE_MAX_CURVES; c += 2) {
        if (!(largest(waveforms, c) > is_rounding * most)) {
            continue;
        }
        const char *comma = n++ > 0 ? "," : "";
        const char *const before[2] = {n > 1 ? group[0] : "", n > 1 ? group[1] : ""};
        group[0] = dalcs_arena_printf(arena, "%s%sdb(%s)", before[0], comma, waveforms->name[c]);
        group[1] = dalcs_arena_printf(arena, "%s%s%s", before[1], comma, waveforms->name[c + 1]);
        if (group[0] == NULL || group[1] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    return DALCS_OK;
}
