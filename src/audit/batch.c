/* batch.c - stretches that repeat the one before: the same mode, step, end and map. Nearly all do where a largest step cuts
 * them, and what the engine takes for one is two to six thousand instructions. They are gathered, and all laws and signs of
 * a batch are asked at once: of their inputs as columns of one matrix, and of the least and the most that each input is. */
#include "image_sum.h"

#include "wide_vectors.h"

/* The one that was asked by itself before the batch is in its first slot. */
enum { FIRST = 1 };

/* ---- What is gathered ---------------------------------------------------------------------------- */

struct dalcs_audit_batch *dalcs_audit_batch_of(const struct dalcs_audit *audit, int part) {
    return &audit->part[part].watch->batch.gathered;
}

static double *input_of(const struct audit_batch *b, int j) {
    return b->gathered.input + (size_t)j * DALCS_AUDIT_BATCH;
}

/* Sources in signs and in integrals are asked elsewhere. */
static bool can_gather(const struct audit_watch *watch, const struct dalcs_audit_stretch *stretch) {
    const struct audit_screen *screen = watch->screens.latest;
    return !stretch->is_cut && screen->n_terms[AUDIT_TERM_SIGN] == 0 &&
           screen->n_terms[AUDIT_TERM_FLOW] == 0;
}

/* One of the times before the end, the same for all of a batch; nothing is gathered where its image is not made yet. */
static void draw_time(struct dalcs_audit *audit, const struct audit_watch *watch,
                      struct audit_batch *b) {
    const int m = b->n_times > 0 ? (int)(b->n_times * audit_draw(audit)) : 0;
    b->past = watch->theta[m] * b->image->step;
    b->place = b->n_times > 0 && audit_is_same_end(b->image->at[m].end, b->image->end)
                   ? b->image->at[m].place
                   : NULL;
    b->node = audit_node_at(b->n_nodes, m) * b->stride;
    b->gathered.is_on = b->place != NULL;
}

void audit_batch_from(struct dalcs_audit *audit, struct audit_part *part,
                      const struct dalcs_audit_stretch *stretch) {
    struct audit_watch *watch = part->watch;
    struct audit_batch *b = &watch->batch;
    struct audit_image *image = watch->image;
    const bool is_second =
        image != NULL && image == b->image && audit_is_same_end(image->end, b->end);
    b->image = image;
    b->end = image != NULL ? image->end : 0.0;
    if (!is_second || b->is_busy || !can_gather(watch, stretch)) {
        return;
    }
    const struct dalcs_audit_polynomials *p = stretch->stored;
    struct audit_screen *screen = watch->screens.latest;
    const struct audit_window *window = &screen->window[screen->window_at];
    const double length = stretch->to - stretch->from;
    b->near = part->tolerance * length + 4.0 * audit->options.resolution;
    const double past = screen->n_guards > 0 ? audit_window_past(window, stretch->from + b->near,
                                                                 stretch->to - b->near)
                                             : 0.0;
    if (isnan(past) ||
        dalcs_grow(&b->gathered.input, &b->room, (size_t)p->n_inputs * (DALCS_AUDIT_BATCH + 2),
                   sizeof(double)) != DALCS_OK) {
        return;
    }
    b->screen = screen;
    b->length = p->end * p->step;
    b->n_columns = dalcs_quads_of(p->n_columns);
    b->n_nodes = p->n_nodes;
    b->stride = p->stride;
    b->n_times = audit_n_times_before(watch, p->end);
    b->gathered.last = fmin(screen->n_guards > 0 ? window->to + past + b->near : INFINITY,
                            audit_told_until(part, b->length));
    b->gathered.n_inputs = p->n_inputs;
    b->gathered.n = 0;
    b->gathered.work = 0.0;
    dalcs_audit_put(&b->gathered, stretch->from, stretch->to, p->input, 0.0);
    draw_time(audit, watch, b);
}

/* ---- Rows times inputs --------------------------------------------------------------------------- */

/* Of each slot. */
struct sums {
    double law[DALCS_AUDIT_BATCH], start[DALCS_AUDIT_BATCH];
    double end[DALCS_AUDIT_BATCH +
               1]; /* that of the slot before; so a jump is two numbers side by side */
    double below[DALCS_AUDIT_BATCH]; /* how far the least sign is below 0 */
};

DALCS_TWICE(bool, agrees,
            (const struct audit_batch *b, const double *input, const double *value, double limit),
            (b, input, value, limit)) {
    const int n_places = b->screen->n_places;
    const double *factor = b->place + AUDIT_PLACE_NODE;
    double sum = b->screen->constant[AUDIT_PLACE_NODE];
    for (int j = 0; j < b->gathered.n_inputs; j++, factor += n_places) {
        sum += *factor * input[j];
    }
    sum -=
        audit_product(b->n_columns, b->screen->row + AUDIT_ROW_NOW * b->n_columns, value + b->node);
    return fabs(sum) <= 0.25 * limit;
}

bool dalcs_audit_is_image(const struct dalcs_audit *audit, int part, const double *input,
                          const double *value) {
    const struct audit_batch *b = &audit->part[part].watch->batch;
    return agrees(b, input, value, b->screen->limit);
}

static inline int n_in_quads(const struct audit_batch *b) {
    return dalcs_quads_of(b->gathered.n);
}

static inline __attribute__((always_inline)) void fill(dalcs_quad *q, double with) {
    *q = (dalcs_quad){with, with, with, with};
}

DALCS_TWICE(void, multiply, (const struct audit_batch *b, struct sums *sums), (b, sums)) {
    const double *constant = b->screen->constant;
    const int n_places = b->screen->n_places;
    for (int k = 0; k < n_in_quads(b); k += DALCS_QUAD) {
        dalcs_quad law;
        dalcs_quad start;
        dalcs_quad end;
        fill(&law, constant[AUDIT_PLACE_LAWS] + b->screen->rate * b->past);
        fill(&start, constant[AUDIT_PLACE_START]);
        fill(&end, constant[AUDIT_PLACE_END]);
        const double *factor = b->place;
        const double *from = b->gathered.input + k;
        for (int j = 0; j < b->gathered.n_inputs;
             j++, factor += n_places, from += DALCS_AUDIT_BATCH) {
            dalcs_quad input;
            dalcs_quad_load(&input, from);
            law += input * factor[AUDIT_PLACE_LAWS];
            start += input * factor[AUDIT_PLACE_START];
            end += input * factor[AUDIT_PLACE_END];
        }
        dalcs_quad_store(sums->law + k, &law);
        dalcs_quad_store(sums->start + k, &start);
        dalcs_quad_store(sums->end + 1 + k, &end);
    }
}

/* Between which values each input is, into the room for that. */
DALCS_TWICE(void, enclose, (const struct audit_batch *b), (b)) {
    const int n_inputs = b->gathered.n_inputs;
    double *low = input_of(b, n_inputs);
    for (int j = 0; j < n_inputs; j++) {
        dalcs_quad least;
        dalcs_quad_load(&least, input_of(b, j));
        dalcs_quad most = least;
        for (int k = DALCS_QUAD; k < n_in_quads(b); k += DALCS_QUAD) {
            dalcs_quad of;
            dalcs_quad_load(&of, input_of(b, j) + k);
            dalcs_quad_lower(&least, &of);
            dalcs_quad_raise(&most, &of);
        }
        least = -least;
        low[j] = -dalcs_quad_largest(&least);
        low[n_inputs + j] = dalcs_quad_largest(&most);
    }
}

/* Four signs of each slot. */
static inline __attribute__((always_inline)) void lower_each(const struct audit_batch *b, int first,
                                                             double *below) {
    const int n_places = b->screen->n_places;
    for (int k = 0; k < b->gathered.n; k++) {
        dalcs_quad sum;
        dalcs_quad_load(&sum, b->screen->constant + first);
        const double *factor = b->place + first;
        const double *input = b->gathered.input + k;
        for (int j = 0; j < b->gathered.n_inputs;
             j++, factor += n_places, input += DALCS_AUDIT_BATCH) {
            dalcs_quad of;
            dalcs_quad_load(&of, factor);
            sum += of * *input;
        }
        for (int i = 0; i < DALCS_QUAD; i++) {
            below[k] = sum[i] >= -below[k] ? below[k] : -sum[i];
        }
    }
}

/* Only signs that may be below what is allowed, with inputs between the least and the most, are asked one by one. */
DALCS_TWICE(void, ask_signs, (const struct audit_batch *b, double *below), (b, below)) {
    const int n_places = b->screen->n_places;
    const double limit = b->screen->limit;
    const double *low = input_of(b, b->gathered.n_inputs);
    const double *high = low + b->gathered.n_inputs;
    for (int first = AUDIT_PLACE_SIGNS; first < n_places; first += DALCS_QUAD) {
        dalcs_quad bound;
        dalcs_quad_load(&bound, b->screen->constant + first);
        const double *factor = b->place + first;
        for (int j = 0; j < b->gathered.n_inputs; j++, factor += n_places) {
            dalcs_quad of;
            dalcs_quad_load(&of, factor);
            dalcs_quad least = of * low[j];
            const dalcs_quad other = of * high[j];
            dalcs_quad_lower(&least, &other);
            bound += least;
        }
        bool holds = true;
        for (int i = 0; i < DALCS_QUAD; i++) {
            holds &= bound[i] >= -limit;
        }
        if (!holds) {
            lower_each(b, first, below);
        }
    }
}

/* ---- What is beyond ------------------------------------------------------------------------------ */

/* A quarter of what is allowed of laws is left to the values at a node. */
static bool holds(const struct audit_batch *b, const struct sums *s, int k) {
    const double limit = b->screen->limit;
    return fabs(s->law[k]) <= 0.75 * limit && fabs(s->start[k] - s->end[k]) <= limit &&
           s->below[k] <= limit &&
           fabs(b->gathered.to[k] - b->gathered.from[k] - b->length) <= b->near;
}

/* Four at once: the comparisons of holds(). */
DALCS_TWICE(bool, all_hold, (const struct audit_batch *b, const struct sums *s), (b, s)) {
    dalcs_quad limit;
    dalcs_quad near;
    fill(&limit, b->screen->limit);
    fill(&near, b->near);
    dalcs_quad_bits all = {-1, -1, -1, -1};
    for (int k = 0; k < n_in_quads(b); k += DALCS_QUAD) {
        dalcs_quad law;
        dalcs_quad jump;
        dalcs_quad below;
        dalcs_quad to;
        dalcs_quad other;
        dalcs_quad_load(&law, s->law + k);
        dalcs_quad_load(&jump, s->start + k);
        dalcs_quad_load(&other, s->end + k);
        dalcs_quad_load(&below, s->below + k);
        jump -= other;
        dalcs_quad_load(&to, b->gathered.to + k);
        dalcs_quad_load(&other, b->gathered.from + k);
        to = to - other - b->length;
        dalcs_quad_unsign(&law);
        dalcs_quad_unsign(&jump);
        dalcs_quad_unsign(&to);
        all &= (dalcs_quad_bits)(law <= 0.75 * limit) & (dalcs_quad_bits)(jump <= limit) &
               (dalcs_quad_bits)(below <= limit) & (dalcs_quad_bits)(to <= near);
    }
    return (all[0] & all[1] & all[2] & all[3]) != 0;
}

/* The last quad is full: of the last one. */
static void repeat_last(struct audit_batch *b, struct sums *s) {
    const int last = b->gathered.n - 1;
    for (int k = b->gathered.n; k < n_in_quads(b); k++) {
        b->gathered.from[k] = b->gathered.from[last];
        b->gathered.to[k] = b->gathered.to[last];
        s->law[k] = s->below[k] = 0.0;
        s->start[k] = s->end[k];
    }
}

/* The first slot that is beyond what is allowed; as many as there are: none is. */
static int find_first(struct dalcs_audit *audit, struct audit_batch *b, struct sums *s) {
    const int n = b->gathered.n;
    for (int j = 0; j < b->gathered.n_inputs; j++) {
        double *input = input_of(b, j);
        for (int k = n; k < n_in_quads(b); k++) {
            input[k] = input[n - 1];
        }
    }
    multiply(b, s);
    memset(s->below, 0, sizeof s->below);
    if (b->screen->n_places > AUDIT_PLACE_SIGNS) {
        enclose(b);
        ask_signs(b, s->below);
    }
    for (int k = FIRST; k < n && b->screen->n_terms[AUDIT_TERM_LAW] > 0; k++) {
        s->law[k] += audit_laws_stimuli(audit, b->screen, b->gathered.from[k] + b->past);
    }
    s->law[0] = s->below[0] = 0.0; /* of what was asked before */
    s->end[0] = s->start[0];
    repeat_last(b, s);
    if (all_hold(b, s)) {
        return n;
    }
    int k = FIRST;
    while (k < n && holds(b, s, k)) {
        k++;
    }
    return k;
}

/* ---- Once more ----------------------------------------------------------------------------------- */

/* input[]: room for it. */
static struct dalcs_audit_kept kept(const struct audit_batch *b, int k, double *input) {
    for (int j = 0; j < b->gathered.n_inputs; j++) {
        input[j] = input_of(b, j)[k];
    }
    return (struct dalcs_audit_kept){b->gathered.from[k], b->gathered.to[k], input};
}

/* As if it had not been gathered. */
static void revisit(struct dalcs_audit *audit, int index, int k, double states) {
    struct audit_part *part = &audit->part[index];
    const struct audit_batch *b = &part->watch->batch;
    const struct dalcs_audit_reader *r = &audit->reader;
    double *room = input_of(b, b->gathered.n_inputs);
    const struct dalcs_audit_kept before = kept(b, k - 1, room);
    const struct dalcs_audit_kept present = kept(b, k, room + b->gathered.n_inputs);
    part->at.length = before.to - before.from;
    part->watch->states = states;
    audit_look_again(audit, r->revisit(r->user, index, &before, &present));
    r->go_back(r->user, index);
}

/* Of those gathered so far. */
static void ask(struct dalcs_audit *audit, int index) {
    struct audit_part *part = &audit->part[index];
    struct audit_batch *b = &part->watch->batch;
    struct dalcs_audit_batch *g = &b->gathered;
    struct sums sums;
    const int first = find_first(audit, b, &sums);
    const int last = g->n - 1;
    audit->count.stretches += first - FIRST;
    audit->count.screened += first - FIRST;
    audit->budget.spent += 0.5 * AUDIT_SCREEN_WORK * (first - FIRST);
    dalcs_audit_earn(audit, g->work);
    g->work = 0.0;
    part->at.past = last > FIRST ? g->to[last - 1] - g->from[last - 1] : part->at.length;
    part->at.length = g->to[last] - g->from[last];
    part->at.past_coarse = false;
    part->watch->states = sums.end[last + 1];
    if (first <= last) {
        b->is_busy = true;
        for (int k = first; k <= last; k++) {
            revisit(audit, index, k, sums.end[k]);
        }
        b->is_busy = false;
        g->is_on = false;
        b->image = NULL;
    }
}

void dalcs_audit_settle(struct dalcs_audit *audit, int part) {
    struct dalcs_audit_batch *g = dalcs_audit_batch_of(audit, part);
    if (g->n > FIRST) {
        ask(audit, part);
    }
    g->is_on = false;
    g->n = 0;
}

void dalcs_audit_ask_batch(struct dalcs_audit *audit, int part) {
    struct audit_watch *watch = audit->part[part].watch;
    struct audit_batch *b = &watch->batch;
    struct dalcs_audit_batch *g = &b->gathered;
    ask(audit, part);
    if (!g->is_on || audit->budget.credit >= audit->budget.threshold) {
        g->is_on = false;
        g->n = 0;
        return;
    }
    const int last = g->n - 1;
    for (int j = 0; j < g->n_inputs; j++) {
        input_of(b, j)[0] = input_of(b, j)[last];
    }
    g->from[0] = g->from[last];
    g->to[0] = g->to[last];
    g->n = FIRST;
    draw_time(audit, watch, b);
}
