/* euler_step.c - a step of implicit Euler as a segment, where events crowd or no mode is found. */
#include "micro_steps.h"
#include "present.h"
#include "restart.h"
#include "slide.h"
#include "smooth_step.h"

#include <math.h>
#include <string.h>

/* States go straight, and all else is what it is at the end. */
static void fill_out(struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    int n_columns = dalcs_system_n_columns(p->system);
    int n_equations = dalcs_system_n_equations(p->system);
    double *end = part->segment.out + (l->n_nodes - 1) * l->stride;
    memcpy(end, part->work.y1, (size_t)n_columns * sizeof(double));
    for (int d = 0; d < p->system->n_pairs; d++) {
        end[n_equations + d] += dalcs_osnsp_is_on(p, d) ? 0.0 : p->w[d];
    }
    for (int k = 0; k < l->n_nodes; k++) {
        double *out = part->segment.out + k * l->stride;
        double at = part->stages.method->node[k];
        for (int c = 0; c < n_columns; c++) {
            double start = c < p->system->n_x ? part->x[c] : end[c];
            out[c] = k + 1 < l->n_nodes ? start + at * (end[c] - start) : end[c];
        }
        for (int i = 0; i < part->stages.n_watched; i++) {
            out[n_columns + i] = 0.0;
        }
    }
}

void dalcs_radau_accept_euler(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                              double h) {
    double limit = dalcs_radau_limit(r, part);
    part->segment.by_euler = true;
    part->segment.is_coarse = true;
    part->segment.h = h;
    part->segment.end = 1.0;
    part->segment.t_end = fmin(part->segment.t + h, limit);
    part->segment.why = part->segment.t_end >= limit ? DALCS_END_AT_EDGE : DALCS_END_OF_STEP;
    part->guards.n_crossed = 0;
    part->guards.fresh = true;
}

void dalcs_radau_accept_implicit(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                                 double h) {
    const struct dalcs_component *c = part->component;
    const struct dalcs_observer *observer = r->base->listener.observer;
    if (observer != NULL) {
        observer->scale(observer->user, part->index, &c->osnsp.certificate);
        observer->step(observer->user, part->index, part->x, part->work.y1,
                       part->work.u + c->system->n_x, h);
    }
    fill_out(part);
    if (part->smooth != NULL) {
        dalcs_smooth_euler_note(part);
    }
    dalcs_radau_accept_euler(r, part, h);
}

enum dalcs_status dalcs_radau_euler_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                         double h) {
    struct dalcs_component *c = part->component;
    bool slides = part->guards.slides;
    part->guards.slides = false;
    if (!slides) {
        dalcs_micro_positions(part, true);
        DALCS_TRY(dalcs_radau_implicit_step(r, part, h, h, part->x, part->work.y1));
        slides = c->positions.alternates;
    }
    if (slides) {
        DALCS_TRY(dalcs_slide_step(r, part, dalcs_radau_limit(r, part), true, &slides));
        if (slides) {
            return DALCS_OK;
        }
        dalcs_micro_positions(part, true);
        DALCS_TRY(dalcs_radau_implicit_step(r, part, h, h, part->x, part->work.y1));
    }
    if (dalcs_smooth_euler_meets_pole(part)) {
        return dalcs_micro_fail(r, part, 1.0 / h, part->work.u, DALCS_NOT_CONVERGED);
    }
    c->commands.n_delayed += c->positions.settled ? 0 : 1; /* the present command stands */
    dalcs_radau_accept_implicit(r, part, h);
    r->euler_steps++;
    return DALCS_OK;
}
