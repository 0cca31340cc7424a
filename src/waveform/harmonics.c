/* harmonics.c - integrals of spans times cosines and sines by Gauss' rule, cut until the fastest of
 * them turns little. */
#include "harmonics.h"
#include "pi.h"
#include "side_span.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>

/* Radians of the fastest sine over one rule: with 36 - 17 degrees to spare the rest is below 1e-16. */
static const double most_turn = 4.0;

enum dalcs_status dalcs_harmonics_setup(struct dalcs_harmonics *h,
                                        const struct dalcs_fourier_card *card, double stop,
                                        bool is_orbit) {
    size_t n = (size_t)card->n_harmonics + 1;
    *h = (struct dalcs_harmonics){.card = card,
                                  .frequency = card->frequency,
                                  .mean = -1,
                                  .from = stop - card->n_periods / card->frequency,
                                  .to = stop};
    if (is_orbit) {
        h->frequency = fmax(1.0, rint(card->frequency * stop)) / stop;
        h->from = 0.0;
    }
    h->cosine = dalcs_alloc(n, sizeof(double));
    h->sine = dalcs_alloc(n, sizeof(double));
    if (h->cosine == NULL || h->sine == NULL) {
        dalcs_harmonics_finish(h);
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

void dalcs_harmonics_finish(struct dalcs_harmonics *h) {
    free(h->cosine);
    free(h->sine);
    *h = (struct dalcs_harmonics){0};
}

struct addition {
    struct dalcs_harmonics *h;
    const struct dalcs_stretch *stretch;
};

/* `value` at `time`, with its weight. */
static void add_value(struct dalcs_harmonics *h, double time, double value) {
    double angle = dalcs_two_pi * fmod(h->frequency * (time - h->from), 1.0);
    double c1 = cos(angle);
    double s1 = sin(angle);
    double c = 1.0;
    double s = 0.0;
    for (int k = 0; k <= h->card->n_harmonics; k++) {
        h->cosine[k] += value * c;
        h->sine[k] += value * s;
        double next = c * c1 - s * s1;
        s = s * c1 + c * s1;
        c = next;
    }
}

static bool add_span(void *user, const struct dalcs_span *span) {
    const struct addition *a = user;
    const struct dalcs_stretch_rule *rule = a->stretch->rule;
    struct dalcs_harmonics *h = a->h;
    double length = span->to - span->from;
    double turn = dalcs_two_pi * h->frequency * h->card->n_harmonics * length;
    int n = 1 + (int)(turn / most_turn);
    double weight = length / (n * (h->to - h->from));
    for (int part = 0; part < n; part++) {
        for (int i = 0; i < DALCS_STRETCH_NODES; i++) {
            double theta = (part + 0.5 * (1.0 + rule->node[i])) / n;
            double value = dalcs_stretch_at(span->coefficient, 2.0 * theta - 1.0);
            add_value(h, span->from + theta * length, weight * rule->weight[i] * value);
        }
    }
    return true;
}

void dalcs_harmonics_add(struct dalcs_harmonics *h, const struct dalcs_stretch *stretch,
                         const struct dalcs_side_means *sides) {
    double from = fmax(h->from, stretch->from);
    double to = fmin(h->to, stretch->to);
    struct addition a = {h, stretch};
    if (from < to && sides != NULL) {
        struct dalcs_span span;
        dalcs_side_means_span(sides, h->mean, stretch->rule, from, to, &span);
        h->has_no_value = h->has_no_value || isnan(span.coefficient[0]);
        h->scale = fmax(h->scale, fabs(span.coefficient[0]));
        add_span(&a, &span);
    } else if (from < to && !dalcs_stretch_visit(stretch, &h->card->formula, from, to, &h->scale,
                                                 &a, add_span)) {
        h->has_no_value = true;
    }
}

void dalcs_harmonics_add_impulses(struct dalcs_harmonics *h, const struct dalcs_stretch *stretch,
                                  double near) {
    const double at = stretch->from;
    if (stretch->impulse == NULL || at < h->from - near || at >= h->to - near) {
        return;
    }
    const double area = dalcs_stretch_impulse(stretch, &h->card->formula);
    if (area != 0.0) {
        const double mean = area / (h->to - h->from);
        add_value(h, at, mean);
        h->scale = isnan(mean) ? h->scale : fmax(h->scale, fabs(mean));
        h->n_impulses++;
    }
    h->has_no_value = h->has_no_value || isnan(area);
}
