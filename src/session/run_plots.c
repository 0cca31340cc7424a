/* run_plots.c - the plots that a run announces: their names and units, and whose they are. */
#include "pipeline.h"

#include <string.h>

/* All of them: a warning may be about one that is only measured. */
enum dalcs_status dalcs_run_name_signals(struct dalcs_run *r, bool copies) {
    const struct dalcs_network *n = &r->s->network;
    const size_t n_outputs = (size_t)n->n_outputs;
    r->signals.name = dalcs_arena_alloc(&r->s->arena, n_outputs, sizeof(*r->signals.name));
    r->signals.unit = dalcs_arena_alloc(&r->s->arena, n_outputs, sizeof(*r->signals.unit));
    if (r->signals.name == NULL || r->signals.unit == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < n_outputs; i++) {
        const char *name = n->output[i].name;
        r->signals.name[i] = copies ? dalcs_arena_copy(&r->s->arena, name, strlen(name)) : name;
        if (r->signals.name[i] == NULL) {
            return DALCS_E_NOMEM;
        }
        r->signals.unit[i] = n->is_without_units       ? DALCS_UNIT_NONE
                             : n->output[i].is_current ? DALCS_AMPERE
                                                       : DALCS_VOLT;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_run_begin_plot(struct dalcs_run *r, enum dalcs_analysis analysis) {
    return dalcs_run_announce(
        r, &(struct dalcs_plot){.analysis = analysis,
                                .scale = "time",
                                .scale_unit = DALCS_UNIT_SECOND,
                                .n_signals = (size_t)r->s->circuit.results.n_shown,
                                .name = r->signals.name,
                                .unit = r->signals.unit});
}

enum dalcs_status dalcs_run_announce(struct dalcs_run *r, const struct dalcs_plot *about) {
    struct dalcs_arena *arena = &r->s->arena;
    const char *title = r->s->circuit.title;
    struct dalcs_plot *plot = dalcs_arena_alloc(arena, 1, sizeof(*plot));
    if (plot == NULL) {
        return DALCS_E_NOMEM;
    }
    *plot = *about;
    plot->title = r->s->source.has_netlist ? dalcs_arena_copy(arena, title, strlen(title)) : title;
    plot->n_steps = 1;
    if (plot->title == NULL) {
        return DALCS_E_NOMEM;
    }
    if (r->step != NULL) {
        plot->step = r->step->step;
        plot->n_steps = r->step->n_steps;
        plot->n_parameters = r->step->n_parameters;
        plot->parameter = r->step->parameter;
        plot->parameter_value = r->step->parameter_value;
    }
    return r->sink->begin(r->sink->user, plot);
}
