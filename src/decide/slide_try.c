/* slide_try.c - a segment of some length along a threshold, and how far it is off.
 *
 * Filippov's mean of both sides (sliding.h) by implicit Euler, extrapolated (Hairer and Wanner, Solving ODEs II, sec.
 * IV.9): between each two nodes of the method go 1, 2, ..., ORDER steps, and where their errors in powers of the step
 * cancel is the polynomial's value there. */
#include "slide_try.h"

#include "micro_steps.h"
#include "restart.h"
#include "rounding.h"
#include "sliding.h"

#include <math.h>
#include <string.h>

enum { ORDER = DALCS_SLIDE_ORDER };

/* All step sizes of a segment come again in the next one, as long or half as long. */
_Static_assert(2 * ORDER * DALCS_MAX_STAGES < DALCS_MOST_FORMS, "their forms and factors stay");

/* weight[j - 1] of the sequence with j steps, in the value at step 0 of the polynomial through those from `first` on
 * (Aitken and Neville). */
static void find_weights(int first, double *weight) {
    for (int j = 1; j <= ORDER; j++) {
        weight[j - 1] = j < first ? 0.0 : 1.0;
        for (int i = first; i <= ORDER; i++) {
            weight[j - 1] *= i != j ? (double)j / (j - i) : 1.0;
        }
    }
}

/* Lagrange's polynomial through the nodes behind the start. */
static void find_start(const struct dalcs_collocation *method, double *start) {
    for (int i = 1; i <= method->s; i++) {
        start[i] = 1.0;
        for (int k = 1; k <= method->s; k++) {
            start[i] *= k != i ? method->node[k] / (method->node[k] - method->node[i]) : 1.0;
        }
    }
}

/* What rounding makes of a column at a node that the sequences add up, over its unit's largest: the sum of the sizes of
 * their weights, 92, times that of an answer. */
static double rounding_of_sum(const double *weight) {
    double sum = 0.0;
    for (int j = 0; j < ORDER; j++) {
        sum += fabs(weight[j]);
    }
    return sum * dalcs_sum_rounded;
}

struct dalcs_slide_try dalcs_slide_try_of(const struct dalcs_collocation *method, double h) {
    struct dalcs_slide_try of = {.h = h};
    find_weights(1, of.weight);
    find_weights(2, of.estimate);
    find_start(method, of.start);
    of.rounding = rounding_of_sum(of.weight);
    return of;
}

/* A step of length h from state[n_x] to part->segment.t + tau, on the way to a node, into y, which counts so many times. */
struct counted_step {
    int node;
    bool ends_at_node;
    double h, tau, times;
    const double *state;
    double *y;
};

static enum dalcs_status mean_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                   const struct counted_step *step, struct dalcs_slide_try *of) {
    struct dalcs_component *c = part->component;
    const struct dalcs_euler_listener *listener = &r->base->listener;
    const struct dalcs_observer *observer = listener->observer;
    of->slides = false;
    enum dalcs_status status =
        dalcs_radau_implicit_step(r, part, step->h, step->tau, step->state, step->y);
    c->positions.goes_on = false;
    if (status != DALCS_OK || !c->positions.alternates) {
        return status < DALCS_OK ? status : DALCS_OK; /* without an answer it does not slide */
    }
    struct dalcs_observed_sides sides;
    double noise = 0.0;
    DALCS_TRY(
        dalcs_sliding_mean(&c->positions, 1.0 / step->h, part->work.u, step->y, &sides, &noise));
    of->slides = sides.n > 0 && (of->begins || of->may_change || !c->positions.sides.have_changed);
    of->begins = false;
    c->positions.goes_on = of->slides && sides.n == 2;
    if (!of->slides) {
        return DALCS_OK;
    }
    of->noise = fmax(of->noise, noise);
    for (int k = 0; k < sides.n && c->system->n_x == 0; k++) {
        dalcs_micro_raise(c->system, sides.y[k], dalcs_system_n_equations(c->system), of->largest);
    }
    for (int k = 0; k < c->osnsp.n_words; k++) {
        part->work.mode_first[k] |= c->positions.sides.conducted[k];
    }
    sides.h = step->h;
    sides.time = part->segment.t + step->tau;
    sides.times = step->times;
    sides.node = step->node;
    if (step->ends_at_node && listener->on_slide_node != NULL) {
        listener->on_slide_node(listener->sides_user, part->index, &sides,
                                part->work.u + c->system->n_x);
    }
    if (observer != NULL) {
        observer->scale(observer->user, part->index, &c->osnsp.certificate);
        observer->step_by_euler(observer->user, part->index, step->state, step->y, &sides,
                                part->work.u + c->system->n_x);
    }
    return DALCS_OK;
}

/* The columns and voltages of pairs at a node take so much of y, and those to estimate errors by. */
static void add_to_node(struct dalcs_radau_part *part, int node, const double *y, double weight,
                        double estimate) {
    const struct dalcs_component *c = part->component;
    const struct dalcs_system *s = c->system;
    const int stride = part->stages.layout.stride;
    double *out = part->segment.out + (ptrdiff_t)node * stride;
    for (int k = 0; k < dalcs_system_n_columns(s); k++) {
        out[k] += weight * y[k];
    }
    double *tried = part->work.out_tried + (ptrdiff_t)node * stride;
    for (int k = 0; k < dalcs_system_n_columns(s); k++) {
        tried[k] += estimate * y[k];
    }
    double *w = part->work.node_w + (ptrdiff_t)node * s->n_pairs;
    for (int d = 0; d < s->n_pairs; d++) {
        w[d] += weight * c->osnsp.w[d];
    }
}

/* The sequence with j steps from node to node. */
static enum dalcs_status run_sequence(struct dalcs_radau *r, struct dalcs_radau_part *part, int j,
                                      struct dalcs_slide_try *of) {
    const struct dalcs_collocation *method = part->stages.method;
    const double *state = part->x;
    double *y = part->work.y1;
    for (int node = 1; node <= method->s; node++) {
        const double from = method->node[node - 1];
        const double width = method->node[node] - from;
        for (int k = 1; k <= j; k++) {
            const struct counted_step step = {.node = node,
                                              .ends_at_node = k == j,
                                              .h = of->h * width / j,
                                              .tau = of->h * (from + width * k / j),
                                              .times = of->weight[j - 1],
                                              .state = state,
                                              .y = y};
            DALCS_TRY(mean_step(r, part, &step, of));
            if (!of->slides) {
                of->held = step.tau - step.h;
                of->fails = step.tau;
                return DALCS_OK;
            }
            if (node == 1 && k == 1 && part->component->system->n_x > 0) {
                add_to_node(part, 0, y, of->weight[j - 1], of->estimate[j - 1]);
            }
            state = y;
            y = y == part->work.y1 ? part->work.y2 : part->work.y1;
        }
        add_to_node(part, node, state, of->weight[j - 1], of->estimate[j - 1]);
    }
    return DALCS_OK;
}

/* Without states: the answer where the segment begins. Where that is an end of what slides, there may be no mean. */
static enum dalcs_status find_start_of_sources(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                               struct dalcs_slide_try *of) {
    const struct dalcs_system *s = part->component->system;
    const struct counted_step at_start = {
        .ends_at_node = true, .h = of->h, .state = part->x, .y = part->work.y1};
    DALCS_TRY(mean_step(r, part, &at_start, of));
    of->knows_start = of->slides || part->component->positions.settled;
    if (of->knows_start) {
        const size_t bytes = (size_t)dalcs_system_n_columns(s) * sizeof(double);
        memcpy(part->segment.out, part->work.y1, bytes);
        memcpy(part->work.node_w, part->component->osnsp.w, (size_t)s->n_pairs * sizeof(double));
    }
    return DALCS_OK;
}

/* In place of the current of a pair that is open all the time stands its voltage. */
static void put_voltages(struct dalcs_radau_part *part, const struct dalcs_slide_try *of) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    for (int node = of->knows_start ? 0 : 1; node < l->n_nodes; node++) {
        const int first = node * l->stride + dalcs_system_n_equations(s);
        for (int d = 0; d < s->n_pairs; d++) {
            bool is_on = dalcs_mode_has(part->work.mode_first, d);
            part->segment.out[first + d] += is_on ? 0.0 : part->work.node_w[node * s->n_pairs + d];
        }
    }
}

/* Behind states the other columns begin where the polynomial through the other nodes does. */
static void begin_columns(struct dalcs_radau_part *part, const struct dalcs_slide_try *of) {
    const struct dalcs_collocation *method = part->stages.method;
    const int stride = part->stages.layout.stride;
    const int n_x = part->component->system->n_x;
    const bool is_known = n_x == 0 && of->knows_start;
    double *out = part->segment.out;
    for (int k = n_x; k < stride && !is_known; k++) {
        double start = 0.0;
        for (int node = 1; node <= method->s; node++) {
            start += of->start[node] * out[node * stride + k];
        }
        out[k] = start;
    }
}

enum dalcs_status dalcs_slide_attempt(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                      struct dalcs_slide_try *of) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const size_t bytes = (size_t)l->n_nodes * (size_t)l->stride * sizeof(double);
    const struct dalcs_euler_listener *listener = &r->base->listener;
    memset(part->segment.out, 0, bytes);
    memset(part->work.out_tried, 0, bytes);
    memset(part->work.node_w, 0,
           (size_t)l->n_nodes * (size_t)part->component->system->n_pairs * sizeof(double));
    memset(part->work.mode_first, 0, (size_t)part->component->osnsp.n_words * sizeof(uint64_t));
    if (listener->observer != NULL) {
        listener->observer->try_by_euler(listener->observer->user, part->index);
    }
    if (listener->on_slide_begun != NULL) {
        listener->on_slide_begun(listener->sides_user, part->index);
    }
    of->noise = of->largest[0] = of->largest[1] = 0.0;
    of->begins = true;
    of->knows_start = part->component->system->n_x > 0;
    if (!of->knows_start) {
        DALCS_TRY(find_start_of_sources(r, part, of));
    }
    of->slides = of->begins = true;
    for (int j = ORDER; j > 0 && of->slides; j--) {
        DALCS_TRY(run_sequence(r, part, j, of));
    }
    part->guards.slides = part->component->positions.goes_on = false;
    of->states = of->pairs = of->bare = INFINITY;
    if (of->slides) {
        put_voltages(part, of);
        memcpy(part->segment.out, part->x, (size_t)part->component->system->n_x * sizeof(double));
        dalcs_slide_find_errors(r, part, of);
        begin_columns(part, of);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_slide_find_leading(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                           double h) {
    struct dalcs_positions *p = &part->component->positions;
    dalcs_sliding_begin(p);
    for (int k = 1; k <= 2 && p->n_jumps > 0; k++) {
        const double length = 0.5 * k * h;
        enum dalcs_status status =
            dalcs_radau_implicit_step(r, part, length, length, part->x, part->work.y1);
        if (status != DALCS_OK || !p->alternates) {
            return status < DALCS_OK ? status : DALCS_OK;
        }
        if (k == 1) {
            dalcs_sliding_note_gaps(p, part->work.y1);
        } else {
            dalcs_sliding_compare_gaps(p, part->work.y1);
        }
    }
    return p->n_jumps > 0 ? dalcs_sliding_find_commanding(p, part->work.u, part->work.y1)
                          : DALCS_OK;
}

enum dalcs_status dalcs_slide_micro_steps(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                          double h, bool *slides) {
    struct dalcs_slide_try of = {.h = h, .begins = true};
    const struct counted_step first = {
        .h = h, .tau = h, .times = 0.0, .state = part->x, .y = part->work.y1};
    const struct counted_step second = {
        .h = h, .tau = 2.0 * h, .times = 0.0, .state = part->work.y1, .y = part->work.y2};
    DALCS_TRY(mean_step(r, part, &first, &of));
    if (of.slides) {
        DALCS_TRY(mean_step(r, part, &second, &of));
    }
    *slides = of.slides;
    part->guards.slides = part->component->positions.goes_on = false;
    return DALCS_OK;
}
