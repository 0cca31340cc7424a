/* side_means.c - products and formulas on each side of a slide, put together as its columns are. */
#include "side_means.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- What is read ---------------------------------------------------------------------------------- */

/* The part of one more probe, where `part` is that of those before: -1: none so far, -2: several. */
static int join(int part, const struct dalcs_probe *probe) {
    const bool reads = probe->system >= 0 && probe->n_terms + probe->n_inputs > 0;
    return !reads || part == probe->system ? part : part == -1 ? probe->system : -2;
}

/* The same with a signal. */
static int join_signal(const struct dalcs_side_means *means, int part, int signal) {
    const struct dalcs_output *out = &means->radau->base->network->output[means->measured[signal]];
    return join(join(part, &out->plus), &out->minus);
}

/* The part that all signals read; below 0: none, or more than one. */
static int part_of(const struct dalcs_side_means *means, const struct dalcs_side_mean *mean) {
    int part = -1;
    if (mean->formula == NULL) {
        return join_signal(means, join_signal(means, part, mean->signal[0]), mean->signal[1]);
    }
    for (int k = 0; k < mean->formula->n; k++) {
        if (mean->formula->step[k].push == DALCS_PUT_SIGNAL) {
            part = join_signal(means, part, mean->formula->step[k].index);
        }
    }
    return mean->formula->has_results ? -1 : part;
}

enum dalcs_status dalcs_side_means_add(struct dalcs_side_means *means,
                                       const struct dalcs_side_mean *mean, int *index) {
    const int part = part_of(means, mean);
    *index = -1;
    if (part < 0) {
        return DALCS_OK;
    }
    if (means->n == means->capacity) {
        const int capacity = 2 * means->capacity + 16;
        struct dalcs_side_mean *more = realloc(means->mean, (size_t)capacity * sizeof(*more));
        if (more == NULL) {
            return DALCS_E_NOMEM;
        }
        means->mean = more;
        means->capacity = capacity;
    }
    *index = means->n++;
    means->mean[*index] = *mean;
    means->mean[*index].part = part;
    means->mean[*index].next = means->part[part].first;
    means->part[part].first = *index;
    return DALCS_OK;
}

/* ---- During a try ---------------------------------------------------------------------------------- */

/* An answer on one side. */
struct side {
    const struct dalcs_side_means *means;
    const double *y, *inputs;
};

static double signal_on(const struct side *side, int signal) {
    const struct dalcs_output *out =
        &side->means->radau->base->network->output[side->means->measured[signal]];
    return dalcs_probe_value(&out->plus, side->y, side->inputs) -
           dalcs_probe_value(&out->minus, side->y, side->inputs);
}

static double signal_of_point(const struct dalcs_signal_formula_point *point, int signal,
                              enum dalcs_signal_part part) {
    const double value = signal_on(point->user, signal);
    return part == DALCS_PART_MAGNITUDE ? fabs(value) : part == DALCS_PART_IMAGINARY ? 0.0 : value;
}

static double value_on(const struct side *side, const struct dalcs_side_mean *mean, double time) {
    if (mean->formula == NULL) {
        return signal_on(side, mean->signal[0]) * signal_on(side, mean->signal[1]);
    }
    const double value = dalcs_signal_formula_value(
        mean->formula, &(struct dalcs_signal_formula_point){
                           .time = time, .user = side, .signal = signal_of_point});
    return mean->is_square ? value * value : value;
}

static void begin_try(void *user, int k) {
    struct dalcs_side_means *means = user;
    means->part[k].knows_start = false;
    for (int i = means->part[k].first; i >= 0; i = means->mean[i].next) {
        memset(means->mean[i].node, 0, sizeof(means->mean[i].node));
    }
}

static void note_node(void *user, int k, const struct dalcs_observed_sides *sides,
                      const double *inputs) {
    struct dalcs_side_means *means = user;
    const double times = sides->node == 0 ? 1.0 : sides->times;
    means->part[k].knows_start = means->part[k].knows_start || sides->node == 0;
    for (int i = means->part[k].first; i >= 0; i = means->mean[i].next) {
        double sum = 0.0;
        for (int n = 0; n < sides->n; n++) {
            const struct side side = {means, sides->y[n], inputs};
            sum += sides->weight[n] * value_on(&side, &means->mean[i], sides->time);
        }
        means->mean[i].node[sides->node] += times * sum;
    }
}

/* ---- Start and end --------------------------------------------------------------------------------- */

enum dalcs_status dalcs_side_means_setup(struct dalcs_side_means *means, struct dalcs_radau *radau,
                                         const int *measured) {
    *means = (struct dalcs_side_means){.radau = radau, .measured = measured};
    means->part = dalcs_alloc((size_t)radau->n_parts, sizeof(*means->part));
    if (means->part == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < radau->n_parts; k++) {
        means->part[k].first = -1;
    }
    radau->base->listener.sides_user = means;
    radau->base->listener.on_slide_begun = begin_try;
    radau->base->listener.on_slide_node = note_node;
    return DALCS_OK;
}

void dalcs_side_means_finish(struct dalcs_side_means *means) {
    free(means->mean);
    free(means->part);
    *means = (struct dalcs_side_means){0};
}

/* ---- During a segment ------------------------------------------------------------------------------ */

static bool part_slides(const struct dalcs_side_means *means, int part) {
    const struct dalcs_radau_part *p = &means->radau->part[part];
    return p->kind == DALCS_PART_STEPPED && p->segment.by_euler && p->component->positions.joined;
}

bool dalcs_side_means_slides(const struct dalcs_side_means *means, int index) {
    return index >= 0 && part_slides(means, means->mean[index].part);
}

bool dalcs_side_means_formula_slides(const struct dalcs_side_means *means,
                                     const struct dalcs_signal_formula *formula) {
    bool slides = false;
    for (int k = 0; k < formula->n && !slides; k++) {
        if (formula->step[k].push == DALCS_PUT_SIGNAL) {
            const struct dalcs_output *out =
                &means->radau->base->network->output[means->measured[formula->step[k].index]];
            slides = (out->plus.system >= 0 && part_slides(means, out->plus.system)) ||
                     (out->minus.system >= 0 && part_slides(means, out->minus.system));
        }
    }
    return slides;
}

bool dalcs_side_means_any_slides(const struct dalcs_side_means *means) {
    bool slides = false;
    for (int k = 0; k < means->radau->n_parts && !slides; k++) {
        slides = part_slides(means, k);
    }
    return slides;
}

/* By the polynomial through the nodes; that at the start counts where it is known, as for columns without states. */
double dalcs_side_mean_at(const struct dalcs_side_means *means, int index, double time) {
    const struct dalcs_side_mean *mean = &means->mean[index];
    const struct dalcs_radau_part *part = &means->radau->part[mean->part];
    const struct dalcs_collocation *method = part->stages.method;
    const double theta = fmin((time - part->segment.t) / part->segment.h, part->segment.end);
    const int first = means->part[mean->part].knows_start ? 0 : 1;
    double weight[DALCS_MAX_NODES];
    double sum = 0.0;
    dalcs_collocation_weights_from(method, first, theta, weight);
    for (int i = first; i <= method->s; i++) {
        sum += weight[i] * mean->node[i];
    }
    return sum;
}
