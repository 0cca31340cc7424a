/* plot_vectors.c - a vector by the names that programs have for it. */
#include "plots.h"

#include "signal_name.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

/* By its name; what let made comes before a node of that name. */
static struct ng_vector *by_name(const struct ng_plot *plot, const char *name) {
    struct ng_vector *found = NULL;
    for (size_t k = 0; k < plot->n && (found == NULL || !found->is_own); k++) {
        struct ng_vector *v = plot->vector[k];
        found = strcasecmp(v->name, name) == 0 && (found == NULL || v->is_own) ? v : found;
    }
    return found;
}

struct ng_vector *ng_plot_vector(const struct ng_plot *plot, const char *name) {
    char signal[NG_NAME_SIZE];
    struct ng_vector *found = by_name(plot, name);
    ng_signal_of(name, signal);
    for (size_t k = 0; k < plot->n && found == NULL; k++) {
        struct ng_vector *v = plot->vector[k];
        found = !v->is_own && strcmp(v->signal, signal) == 0 ? v : NULL;
    }
    return found;
}

struct ng_vector *ng_plots_vector(const struct ng_plots *plots, const char *name) {
    char type[NG_NAME_SIZE];
    const size_t n = strcspn(name, ".");
    struct ng_vector *found = NULL;
    if (n < sizeof type && name[n] == '.') {
        snprintf(type, sizeof type, "%.*s", (int)n, name);
        const struct ng_plot *plot = ng_plots_find(plots, type);
        found = plot != NULL ? ng_plot_vector(plot, name + n + 1) : NULL;
    }
    found = found != NULL ? found : ng_plot_vector(ng_plots_current(plots), name);
    return found != NULL ? found : ng_plot_vector(plots->plot[0], name);
}
