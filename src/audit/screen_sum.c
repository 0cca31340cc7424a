/* screen_sum.c - what the rows of a screen give for a stretch. */
#include "image_sum.h"

#include "wide_vectors.h"

#include <string.h>

/* ---- Polynomials --------------------------------------------------------------------------------- */

/* w[n] such that a polynomial's value at theta is the sum of its values at the nodes times these (J.-P. Berrut and L. N.
 * Trefethen, SIAM Review 46 (2004)). */
static void weights_at(const struct dalcs_audit_polynomials *p, const double *barycentric,
                       double theta, double *w) {
    double sum = 0.0;
    for (int k = p->n_nodes - 1; k >= 0; k--) { /* most end at the last one */
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

/* ---- Places -------------------------------------------------------------------------------------- */

/* Of a time in the stretch and its end, which most have at a node. Beside them a node. */
struct weights {
    const double *now, *flow, *end;
    int node, last; /* < 0: it ends at none */
};

static struct weights weights_of(const double *now, const double *flow, const double *end, int n,
                                 int node) {
    struct weights w = {now, flow, end, node, -1};
    for (int k = 0; k < n; k++) {
        w.last = end[k] == 1.0 ? k : w.last;
    }
    return w;
}

/* Sums of a quad of columns over the nodes: at the time, over the time before it, and at the end. */
struct audit_quads {
    dalcs_quad now, flow, end;
};

static inline __attribute__((always_inline)) struct audit_quads
combine(const struct dalcs_audit_polynomials *p, const struct weights *w, const double *value) {
    struct audit_quads sum = {{0.0}, {0.0}, {0.0}};
    const double *now = w->now;
    const double *flow = w->flow;
    const double *end = w->end;
    if (w->last >= 0) {
        dalcs_quad_load(&sum.end, value + w->last * p->stride);
        for (int k = 0; k < p->n_nodes; k++, value += p->stride) {
            dalcs_quad of;
            dalcs_quad_load(&of, value);
            sum.now += of * now[k];
            sum.flow += of * flow[k];
        }
        return sum;
    }
    for (int k = 0; k < p->n_nodes; k++, value += p->stride) {
        dalcs_quad of;
        dalcs_quad_load(&of, value);
        sum.now += of * now[k];
        sum.flow += of * flow[k];
        sum.end += of * end[k];
    }
    return sum;
}

static inline __attribute__((always_inline)) double total(const dalcs_quad *q) {
    return ((*q)[0] + (*q)[1]) + ((*q)[2] + (*q)[3]);
}

/* Adds what the rows make of these values; *now and *last: those at the time and at the end. */
DALCS_TWICE(void, add_rows,
            (const struct audit_screen *screen, const struct dalcs_audit_polynomials *p,
             const struct weights *w, const double *value, double *now, double *last,
             double *place),
            (screen, p, w, value, now, last, place)) {
    const int n = dalcs_quads_of(p->n_columns);
    const double *row = screen->row;
    dalcs_quad laws = {0.0};
    dalcs_quad start = {0.0};
    dalcs_quad end = {0.0};
    dalcs_quad node = {0.0};
    for (int c = 0; c < n; c += DALCS_QUAD, row += DALCS_QUAD, value += DALCS_QUAD) {
        const struct audit_quads sum = combine(p, w, value);
        dalcs_quad first;
        dalcs_quad of_node;
        dalcs_quad by;
        dalcs_quad_load(&first, value);
        dalcs_quad_load(&of_node, value + w->node * p->stride);
        dalcs_quad_load(&by, row + AUDIT_ROW_NOW * n);
        laws += by * sum.now;
        node += by * of_node;
        dalcs_quad_load(&by, row + AUDIT_ROW_FLOW * n);
        laws += by * (sum.flow * p->step);
        dalcs_quad_load(&by, row + AUDIT_ROW_START * n);
        laws -= by * first;
        dalcs_quad_load(&by, row + AUDIT_ROW_STATES * n);
        start += by * first;
        end += by * sum.end;
        dalcs_quad_store(now + c, &sum.now);
        dalcs_quad_store(last + c, &sum.end);
    }
    place[AUDIT_PLACE_LAWS] += total(&laws);
    place[AUDIT_PLACE_START] += total(&start);
    place[AUDIT_PLACE_END] += total(&end);
    place[AUDIT_PLACE_NODE] += total(&node);
}

static void add_places(const struct audit_watch *watch, const struct audit_screen *screen,
                       const struct dalcs_audit_polynomials *p, const struct weights *w,
                       const double *value, double *place) {
    double *now = watch->column;
    double *last = watch->column + dalcs_quads_of(p->n_columns);
    add_rows(screen, p, w, value, now, last, place);
    const struct audit_term *term = screen->term[AUDIT_TERM_COLUMN];
    for (int k = 0; k < screen->n_terms[AUDIT_TERM_COLUMN]; k++, term++) {
        double *of = place + term->place;
        of[0] += term->factor * now[term->index];
        of[1] += term->factor * value[term->index];
        of[2] += term->factor * last[term->index];
    }
}

void audit_screen_weigh(struct audit_watch *watch, const struct dalcs_audit_polynomials *p, int m) {
    weights_at(p, watch->times.barycentric, watch->times.theta[m], watch->times.now[m]);
    flow_weights(p, watch->times.barycentric, watch->times.theta[m], watch->times.flow[m]);
    watch->times.is_weighed[m] = true;
}

void audit_screen_place(const struct audit_watch *watch, const struct audit_screen *screen,
                        const struct dalcs_audit_polynomials *p, int m, const double *value,
                        double *place) {
    double end[AUDIT_MOST_NODES];
    weights_at(p, watch->times.barycentric, p->end, end);
    const struct weights w = weights_of(watch->times.now[m], watch->times.flow[m], end, p->n_nodes,
                                        audit_node_at(p->n_nodes, m));
    add_places(watch, screen, p, &w, value, place);
}

DALCS_TWICE(double, least_sign, (int n_places, const double *place), (n_places, place)) {
    return audit_least_sign(n_places, place);
}

void audit_screen_weights(const struct audit_watch *watch, const struct dalcs_audit_polynomials *p,
                          double theta, double *w) {
    weights_at(p, watch->times.barycentric, theta, w);
}

void audit_screen_ends(const struct audit_screen *screen, const struct dalcs_audit_polynomials *p,
                       const double *value, int n_ends, double *at_node) {
    const int n = dalcs_quads_of(p->n_columns);
    for (int k = 0; k < p->n_nodes; k++, value += p->stride, at_node += n_ends) {
        at_node[0] = audit_product(n, screen->row + AUDIT_ROW_STATES * n, value);
        const struct audit_term *term = screen->term[AUDIT_TERM_COLUMN];
        for (int i = 0; i < screen->n_terms[AUDIT_TERM_COLUMN]; i++, term++) {
            at_node[1 + (term->place - AUDIT_PLACE_SIGNS) / AUDIT_SIGN_TIMES] +=
                term->factor * value[term->index];
        }
    }
}

/* What is at the end, where that of the image is another one. */
static inline __attribute__((always_inline)) void
add_ends(const struct audit_watch *watch, const struct audit_screen *screen,
         const struct dalcs_audit_polynomials *p, const struct audit_image *image, double *place) {
    double w[AUDIT_MOST_NODES];
    weights_at(p, watch->times.barycentric, p->end, w);
    const double *from = image->at_node;
    const int n_signs = (screen->n_places - AUDIT_PLACE_SIGNS) / AUDIT_SIGN_TIMES;
    for (int first = 0; first < image->n_ends; first += DALCS_QUAD) {
        dalcs_quad sum = {0.0};
        const double *at = from + first;
        for (int j = 0; j < p->n_inputs; j++, at += p->n_nodes * image->n_ends) {
            dalcs_quad of_input = {0.0};
            for (int k = 0; k < p->n_nodes && p->input[j] != 0.0; k++) {
                dalcs_quad of;
                dalcs_quad_load(&of, at + k * image->n_ends);
                of_input += of * w[k];
            }
            sum += of_input * p->input[j];
        }
        for (int e = first; e < first + DALCS_QUAD && e <= n_signs; e++) {
            const int to = e == 0 ? AUDIT_PLACE_END : AUDIT_PLACE_SIGNS + AUDIT_SIGN_TIMES * e - 1;
            place[to] = screen->constant[to] + sum[e - first];
        }
    }
}

/* Laws and states, and the least of the signs, or less, where the input is near one at which they were asked. Where there
 * are values, those at a node are held to the image, *off. */
DALCS_TWICE(double, multiply,
            (const struct audit_screen *screen, const struct dalcs_audit_polynomials *p, int m,
             struct audit_image_at *at, double *place, double *off),
            (screen, p, m, at, place, off)) {
    dalcs_quad sum;
    double far;
    audit_image_laws(screen->constant, screen->n_places, p->input, p->n_inputs, at, &sum, &far);
    dalcs_quad_store(place, &sum);
    *off = audit_image_off(screen, p, m, place);
    return far <= at->slack ? at->slack - far - 1.0 : audit_image_signs(screen, p, at, place);
}

/* The signs at the end are others. */
DALCS_TWICE(double, multiply_to_end,
            (const struct audit_watch *watch, const struct audit_screen *screen,
             const struct dalcs_audit_polynomials *p, int m, const struct audit_image *image,
             double *place, double *off),
            (watch, screen, p, m, image, place, off)) {
    const struct audit_image_at *at = &image->at[m];
    dalcs_quad sum;
    double far;
    audit_image_laws(screen->constant, screen->n_places, p->input, p->n_inputs, at, &sum, &far);
    dalcs_quad_store(place, &sum);
    *off = audit_image_off(screen, p, m, place);
    audit_image_places(screen, p, at, place);
    add_ends(watch, screen, p, image, place);
    return audit_least_sign(screen->n_places, place);
}

double audit_screen_by_image(const struct audit_watch *watch, const struct audit_screen *screen,
                             const struct dalcs_audit_polynomials *p, int m,
                             struct audit_image *image, double *off) {
    struct audit_image_at *at = &image->at[m];
    return audit_is_same_end(at->end, p->end)
               ? multiply(screen, p, m, at, watch->place, off)
               : multiply_to_end(watch, screen, p, m, image, watch->place, off);
}

/* ---- Stimuli ------------------------------------------------------------------------------------- */

/* In the signs that read them, at their three times. */
static void add_to_signs(struct dalcs_audit *audit, const struct audit_screen *screen,
                         const struct audit_question *q, double t, double *place) {
    for (int k = 0; k < screen->n_terms[AUDIT_TERM_SIGN]; k++) {
        const struct audit_term *term = &screen->term[AUDIT_TERM_SIGN][k];
        double *of = place + term->place;
        of[0] += term->factor * audit_stimulus_at(audit, term->index, t);
        of[1] += term->factor * audit_stimulus_at(audit, term->index, q->stretch->from + q->near);
        of[2] += term->factor * audit_stimulus_at(audit, term->index, q->stretch->to - q->near);
    }
}

static double flows(struct dalcs_audit *audit, const struct audit_screen *screen, double from,
                    double past) {
    double sum = 0.0;
    for (int k = 0; k < screen->n_terms[AUDIT_TERM_FLOW]; k++) {
        const struct audit_term *term = &screen->term[AUDIT_TERM_FLOW][k];
        for (int g = 0; g < AUDIT_GAUSS; g++) {
            sum += term->factor * audit_gauss_weight[g] * past *
                   audit_stimulus_at(audit, term->index, from + audit_gauss_node[g] * past);
        }
    }
    return sum;
}

/* ---- What is beyond ------------------------------------------------------------------------------ */

/* At one of the times that the watch has weights for, or at any where the stretch ends before these. */
static double ask_values(struct dalcs_audit *audit, const struct audit_watch *watch,
                         const struct audit_screen *screen, int m,
                         const struct dalcs_audit_polynomials *p) {
    double now[AUDIT_MOST_NODES];
    double flow[AUDIT_MOST_NODES];
    double end[AUDIT_MOST_NODES];
    memcpy(watch->place, screen->constant, (size_t)screen->n_places * sizeof(double));
    if (watch->times.theta[m] <= p->end) {
        audit_screen_place(watch, screen, p, m, p->value, watch->place);
        return watch->times.theta[m];
    }
    const double theta = audit_draw(audit) * p->end;
    weights_at(p, watch->times.barycentric, theta, now);
    flow_weights(p, watch->times.barycentric, theta, flow);
    weights_at(p, watch->times.barycentric, p->end, end);
    const struct weights w = weights_of(now, flow, end, p->n_nodes, 0);
    add_places(watch, screen, p, &w, p->value, watch->place);
    return theta;
}

void audit_screen_ask(struct dalcs_audit *audit, const struct audit_watch *watch,
                      struct audit_screen *screen, const struct audit_question *q,
                      struct audit_answer *answer) {
    const struct dalcs_audit_stretch *stretch = q->stretch;
    const struct dalcs_audit_polynomials *p = stretch->stored;
    double *place = watch->place;
    double theta = watch->times.theta[q->m];
    double laws = 0.0;
    double sign;
    if (q->image != NULL) {
        sign = audit_screen_by_image(watch, screen, p, q->m, q->image, &laws);
    } else {
        theta = ask_values(audit, watch, screen, q->m, p);
        sign = least_sign(screen->n_places, place);
    }
    const double t = stretch->from + theta * p->step;
    if (screen->n_terms[AUDIT_TERM_SIGN] > 0) {
        add_to_signs(audit, screen, q, t, place);
        sign = least_sign(screen->n_places, place);
    }
    double sum = place[AUDIT_PLACE_LAWS] + screen->rate * (t - stretch->from);
    if (audit_laws_have_stimuli(screen)) {
        sum += audit_laws_stimuli(audit, screen, t);
    }
    if (screen->n_terms[AUDIT_TERM_FLOW] > 0) {
        sum += flows(audit, screen, stretch->from, t - stretch->from);
    }
    laws += fabs(sum);
    if (screen->n_guards > 0) {
        laws += audit_worst_guard(audit, screen, q, t);
    }
    answer->worst = laws != laws || sign != sign ? INFINITY : laws > -sign ? laws : -sign;
    answer->t = t;
    answer->start = place[AUDIT_PLACE_START];
    answer->end = place[AUDIT_PLACE_END];
}
