/* screen_sum.c - what the rows of a screen give for a stretch. */
#include "screen.h"

#include "quads.h"
#include "wide_vectors.h"

#include <string.h>

/* ---- Polynomials --------------------------------------------------------------------------------- */

/* w[n] such that a polynomial's value at theta is the sum of its values at the nodes times these (J.-P. Berrut and L. N.
 * Trefethen, SIAM Review 46 (2004)). */
static void weights_at(const struct dalcs_audit_polynomials *p, const double *barycentric,
                       double theta, double *w) {
    double sum = 0.0;
    for (int k = 0; k < p->n_nodes; k++) {
        if (theta == p->node[k]) {
            memset(w, 0, (size_t)p->n_nodes * sizeof(double));
            w[k] = 1.0;
            return;
        }
        w[k] = barycentric[k] / (theta - p->node[k]);
        sum += w[k];
    }
    for (int k = 0; k < p->n_nodes; k++) {
        w[k] /= sum;
    }
}

/* Likewise its integral from 0 to theta, in steps. */
static void flow_weights(const struct dalcs_audit_polynomials *p, const double *barycentric,
                         double theta, double *w) {
    double at[AUDIT_MOST_NODES];
    memset(w, 0, (size_t)p->n_nodes * sizeof(double));
    for (int g = 0; g < AUDIT_GAUSS; g++) {
        weights_at(p, barycentric, theta * audit_gauss_node[g], at);
        for (int k = 0; k < p->n_nodes; k++) {
            w[k] += theta * audit_gauss_weight[g] * at[k];
        }
    }
}

/* Sums over the nodes of values times weights; n in whole quads. */
DALCS_TWICE(void, combine,
            (int n, int stride, int n_nodes, const double *value, const double *w, double *sum),
            (n, stride, n_nodes, value, w, sum)) {
    for (int c = 0; c < n; c += DALCS_QUAD) {
        dalcs_quad all = {0.0};
        for (int k = 0; k < n_nodes; k++) {
            dalcs_quad of;
            dalcs_quad_load(&of, value + k * stride + c);
            all += of * w[k];
        }
        dalcs_quad_store(sum + c, &all);
    }
}

/* Two at once. */
DALCS_TWICE(void, combine_both,
            (int n, int stride, int n_nodes, const double *value, const double *const *w,
             double *const *sum),
            (n, stride, n_nodes, value, w, sum)) {
    for (int c = 0; c < n; c += DALCS_QUAD) {
        dalcs_quad all[2] = {{0.0}, {0.0}};
        for (int k = 0; k < n_nodes; k++) {
            dalcs_quad of;
            dalcs_quad_load(&of, value + k * stride + c);
            all[0] += of * w[0][k];
            all[1] += of * w[1][k];
        }
        dalcs_quad_store(sum[0] + c, &all[0]);
        dalcs_quad_store(sum[1] + c, &all[1]);
    }
}

DALCS_TWICE(double, product, (int n, const double *row, const double *value), (n, row, value)) {
    dalcs_quad sum = {0.0};
    for (int c = 0; c < n; c += DALCS_QUAD) {
        dalcs_quad of;
        dalcs_quad by;
        dalcs_quad_load(&of, value + c);
        dalcs_quad_load(&by, row + c);
        sum += of * by;
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* ---- Places -------------------------------------------------------------------------------------- */

/* Of a time in the stretch and its end; end == NULL: that of the step. Beside them a node. */
struct weights {
    const double *now, *flow, *end;
    int node;
};

/* One for each time, as they are drawn at the same chance. */
static int node_of(const struct dalcs_audit_polynomials *p, int m) {
    return 1 + m * (p->n_nodes - 1) / AUDIT_SCREEN_TIMES;
}

static void fill_signs(const struct audit_screen *screen, const double *const *time,
                       double *place) {
    for (int s = 0; s < screen->n_signs; s++) {
        const struct audit_term *term = screen->term + screen->sign[s].first;
        double of[AUDIT_SIGN_TIMES] = {0.0, 0.0, 0.0};
        for (int k = 0; k < screen->sign[s].n; k++) {
            of[0] += term[k].factor * time[0][term[k].index];
            of[1] += term[k].factor * time[1][term[k].index];
            of[2] += term[k].factor * time[2][term[k].index];
        }
        memcpy(place + AUDIT_SIGN_TIMES * s, of, sizeof of);
    }
}

/* place[], without constants and stimuli, of these values. */
static void fill_places(const struct audit_watch *watch, const struct audit_screen *screen,
                        const struct dalcs_audit_polynomials *p, const struct weights *w,
                        const double *value, double *place) {
    const int n = dalcs_quads_of(p->n_columns);
    const double *const by[2] = {w->now, w->flow};
    double *const sum[2] = {watch->column, watch->column + n};
    combine_both(n, p->stride, p->n_nodes, value, by, sum);
    const double *last = value + (p->n_nodes - 1) * p->stride;
    if (w->end != NULL) {
        combine(n, p->stride, p->n_nodes, value, w->end, watch->column + 2 * n);
        last = watch->column + 2 * n;
    }
    const double *row = screen->row;
    const double *states = row + AUDIT_ROW_STATES * n;
    place[AUDIT_PLACE_NODE] = product(n, row + AUDIT_ROW_NOW * n, value + w->node * p->stride);
    place[AUDIT_PLACE_LAWS] = product(n, row + AUDIT_ROW_NOW * n, sum[0]) +
                              p->step * product(n, row + AUDIT_ROW_FLOW * n, sum[1]) -
                              product(n, row + AUDIT_ROW_START * n, value);
    place[AUDIT_PLACE_START] = product(n, states, value);
    place[AUDIT_PLACE_END] = product(n, states, last);
    const double *const time[AUDIT_SIGN_TIMES] = {sum[0], value, last};
    fill_signs(screen, time, place + AUDIT_PLACE_SIGNS);
}

void audit_screen_draw_times(struct dalcs_audit *audit, struct audit_watch *watch,
                             const struct dalcs_audit_polynomials *p) {
    for (int m = 0; m < AUDIT_SCREEN_TIMES; m++) {
        watch->theta[m] = (m + audit_draw(audit)) / AUDIT_SCREEN_TIMES;
        weights_at(p, watch->barycentric, watch->theta[m], watch->now[m]);
        flow_weights(p, watch->barycentric, watch->theta[m], watch->flow[m]);
    }
}

/* Of the times, those before the end. */
static int n_times_of(const struct audit_watch *watch, double end) {
    int n = 0;
    while (n < AUDIT_SCREEN_TIMES && watch->theta[n] <= end) {
        n++;
    }
    return n;
}

void audit_screen_compose(const struct dalcs_audit *audit, const struct audit_part *part,
                          struct audit_screen *screen, const struct dalcs_audit_polynomials *p) {
    const struct audit_watch *watch = part->watch;
    double end[AUDIT_MOST_NODES];
    weights_at(p, watch->barycentric, p->end, end);
    screen->n_times = n_times_of(watch, p->end);
    for (int m = 0; m < screen->n_times; m++) {
        const struct weights w = {watch->now[m], watch->flow[m], p->end == 1.0 ? NULL : end,
                                  node_of(p, m)};
        for (int j = 0; j < p->n_inputs; j++) {
            const double *value =
                audit->reader.column(audit->reader.user, (int)(part - audit->part), j);
            double *image = screen->image + (m * p->n_inputs + j) * screen->n_places;
            fill_places(watch, screen, p, &w, value, image);
        }
    }
}

DALCS_TWICE(void, multiply,
            (int n_places, int n_inputs, const double *image, const double *input, double *place),
            (n_places, n_inputs, image, input, place)) {
    for (int first = 0; first < n_places; first += DALCS_QUAD) {
        dalcs_quad sum = {0.0};
        for (int j = 0; j < n_inputs; j++) {
            dalcs_quad of;
            dalcs_quad_load(&of, image + j * n_places + first);
            sum += of * input[j];
        }
        dalcs_quad_store(place + first, &sum);
    }
}

/* ---- Stimuli ------------------------------------------------------------------------------------- */

/* A pulse far from its edges, where rounding of t decides nothing; false: near one, or another function. */
static bool is_between_edges(const struct dalcs_stimulus *s, double t, double *value) {
    if (s->kind != DALCS_STIMULUS_PULSE || !(s->u.pulse.period < INFINITY) ||
        s->u.pulse.n_periods > 0.0) {
        return false;
    }
    const double near = 16.0 * 0x1p-52 * (t + s->u.pulse.delay);
    const double from = t - s->u.pulse.delay;
    const double since = from - floor(from / s->u.pulse.period) * s->u.pulse.period;
    const double top = s->u.pulse.rise + s->u.pulse.width;
    const double foot = top + s->u.pulse.fall;
    const double high = s->u.pulse.high - s->u.pulse.low;
    const bool is_near = since < near || fabs(since - s->u.pulse.rise) < near ||
                         fabs(since - top) < near || fabs(since - foot) < near ||
                         since > s->u.pulse.period - near;
    const double part = since < s->u.pulse.rise ? since / s->u.pulse.rise
                        : since < top           ? 1.0
                        : since < foot          ? (foot - since) / s->u.pulse.fall
                                                : 0.0;
    *value = s->u.pulse.low + high * part;
    return from > near && !is_near && foot <= s->u.pulse.period;
}

static double value_at(const struct dalcs_audit *audit, int stimulus, double t,
                       enum dalcs_side side) {
    const struct dalcs_stimulus *s = &audit->circuit->stimulus[stimulus];
    double value;
    return is_between_edges(s, t, &value) ? value : dalcs_stimulus_value(s, t, side);
}

static double stimuli_at(const struct dalcs_audit *audit, const struct audit_term *term, int n,
                         double t, enum dalcs_side side) {
    double sum = 0.0;
    for (int k = 0; k < n; k++) {
        sum += term[k].factor * value_at(audit, term[k].index, t, side);
    }
    return sum;
}

static double stimuli_over(const struct dalcs_audit *audit, const struct audit_term *term, int n,
                           double from, double to) {
    double sum = 0.0;
    for (int g = 0; g < AUDIT_GAUSS && n > 0; g++) {
        sum += audit_gauss_weight[g] * (to - from) *
               stimuli_at(audit, term, n, from + audit_gauss_node[g] * (to - from), DALCS_RIGHT);
    }
    return sum;
}

/* ---- What is beyond ------------------------------------------------------------------------------ */

/* Sources are asked this part of a stretch from its ends, where they have no edge: a command that comes so much too early
 * or too late is seen. */
static const double beside = 1e-6;

/* How far below 0 a sign is at its worst. */
static double worst_sign(const struct dalcs_audit *audit, const struct audit_screen *screen,
                         const struct dalcs_audit_stretch *stretch, double t, const double *place) {
    const double near = beside * (stretch->to - stretch->from);
    const double time[AUDIT_SIGN_TIMES] = {t, stretch->from + near, stretch->to - near};
    double worst = 0.0;
    for (int s = 0; s < screen->n_signs; s++) {
        const struct audit_sign *sign = &screen->sign[s];
        const struct audit_term *term = screen->term + sign->first + sign->n;
        for (int at = 0; at < AUDIT_SIGN_TIMES; at++) {
            double value = sign->constant + place[AUDIT_SIGN_TIMES * s + at];
            if (sign->n_stimuli > 0) {
                value += stimuli_at(audit, term, sign->n_stimuli, time[at], DALCS_RIGHT);
            }
            worst = -value > worst || value != value ? -value : worst;
        }
    }
    return worst;
}

/* One of the times that the watch has weights for, or any where the stretch ends before these. */
static double ask_values(struct dalcs_audit *audit, const struct audit_watch *watch,
                         const struct audit_screen *screen,
                         const struct dalcs_audit_polynomials *p) {
    double now[AUDIT_MOST_NODES];
    double flow[AUDIT_MOST_NODES];
    double end[AUDIT_MOST_NODES];
    const int m = (int)(n_times_of(watch, p->end) * audit_draw(audit));
    struct weights w = {watch->now[m], watch->flow[m], NULL, 0};
    double theta = watch->theta[m];
    if (theta > p->end) {
        theta = audit_draw(audit) * p->end;
        weights_at(p, watch->barycentric, theta, now);
        flow_weights(p, watch->barycentric, theta, flow);
        w = (struct weights){now, flow, NULL, 0};
    }
    if (p->end != 1.0) {
        weights_at(p, watch->barycentric, p->end, end);
        w.end = end;
    }
    fill_places(watch, screen, p, &w, p->value, watch->place);
    return theta;
}

/* By its image; where values are there, those at a node are held to it. */
static double ask_image(struct dalcs_audit *audit, const struct audit_watch *watch,
                        const struct audit_screen *screen, const struct dalcs_audit_polynomials *p,
                        double *off) {
    const int m = (int)(screen->n_times * audit_draw(audit));
    multiply(screen->n_places, p->n_inputs, screen->image + m * p->n_inputs * screen->n_places,
             p->input, watch->place);
    *off = 0.0;
    if (p->value != NULL) {
        const int n = dalcs_quads_of(p->n_columns);
        *off = fabs(watch->place[AUDIT_PLACE_NODE] - product(n, screen->row + AUDIT_ROW_NOW * n,
                                                             p->value + node_of(p, m) * p->stride));
    }
    return watch->theta[m];
}

void audit_screen_ask(struct dalcs_audit *audit, const struct audit_part *part,
                      const struct audit_screen *screen, const struct dalcs_audit_polynomials *p,
                      const struct dalcs_audit_stretch *stretch, struct audit_answer *answer) {
    const struct audit_watch *watch = part->watch;
    const double *place = watch->place;
    double off = 0.0;
    const double theta = audit_screen_has_image(screen, p)
                             ? ask_image(audit, watch, screen, p, &off)
                             : ask_values(audit, watch, screen, p);
    const double t = stretch->from + theta * p->step;
    const struct audit_term *term = screen->term + screen->first;
    double sum = place[AUDIT_PLACE_LAWS] + screen->constant + screen->rate * (t - stretch->from);
    if (screen->n_stimuli > 0) {
        sum += stimuli_at(audit, term, screen->n_stimuli, t, DALCS_RIGHT);
    }
    if (screen->n_flows > 0) {
        sum += stimuli_over(audit, term + screen->n_stimuli, screen->n_flows, stretch->from, t);
    }
    const double sign = worst_sign(audit, screen, stretch, t, place + AUDIT_PLACE_SIGNS);
    const double worst = fabs(sum) + off;
    answer->worst = worst != worst || sign != sign ? INFINITY : worst > sign ? worst : sign;
    answer->t = t;
    answer->start = place[AUDIT_PLACE_START];
    answer->end = place[AUDIT_PLACE_END];
}
