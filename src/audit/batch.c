/* batch.c - stretches that repeat the one before: the same mode, step, end and map. Nearly all do where a largest step cuts
 * them, and what the engine takes for one is two to six thousand instructions. They are gathered, and all laws and signs of
 * a batch are asked at once: of their inputs as columns of one matrix, and of the least and the most that each input is. */
#include "batch.h"

#include "quads.h"

/* ---- What is gathered ---------------------------------------------------------------------------- */

struct dalcs_audit_batch *dalcs_audit_batch_of(const struct dalcs_audit *audit, int part) {
    return &audit->part[part].watch->batch.gathered;
}

/* Sources in signs and in integrals are asked elsewhere, and so are smooth functions. */
static bool can_gather(const struct audit_part *part, const struct dalcs_audit_stretch *stretch) {
    const struct audit_screen *screen = part->watch->screens.latest;
    return !part->has.smooth && !stretch->is_cut && screen->n_terms[AUDIT_TERM_SIGN] == 0 &&
           screen->n_terms[AUDIT_TERM_FLOW] == 0;
}

/* One of the times before the end, the same for all of a batch; nothing is gathered where its image is not made yet. */
static void draw_time(struct dalcs_audit *audit, const struct audit_watch *watch,
                      struct audit_batch *b) {
    const int m = b->n_times > 0 ? (int)(b->n_times * audit_draw(audit)) : 0;
    b->past = watch->times.theta[m] * b->image->step;
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
    if (!is_second || b->is_busy || !can_gather(part, stretch)) {
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

/* ---- Once more ----------------------------------------------------------------------------------- */

/* input[]: room for it. */
static struct dalcs_audit_kept kept(const struct audit_batch *b, int k, double *input) {
    for (int j = 0; j < b->gathered.n_inputs; j++) {
        input[j] = audit_batch_input(b, j)[k];
    }
    return (struct dalcs_audit_kept){b->gathered.from[k], b->gathered.to[k], input};
}

/* As if it had not been gathered. */
static void revisit(struct dalcs_audit *audit, int index, int k) {
    struct audit_part *part = &audit->part[index];
    const struct audit_batch *b = &part->watch->batch;
    const struct dalcs_audit_reader *r = &audit->reader;
    double *room = audit_batch_input(b, b->gathered.n_inputs);
    const struct dalcs_audit_kept before = kept(b, k - 1, room);
    const struct dalcs_audit_kept present = kept(b, k, room + b->gathered.n_inputs);
    part->at.length = before.to - before.from;
    audit_look_again(audit, r->revisit(r->user, index, &before, &present));
    r->go_back(r->user, index);
}

/* Of those gathered so far. */
static void ask(struct dalcs_audit *audit, int index) {
    struct audit_part *part = &audit->part[index];
    struct audit_batch *b = &part->watch->batch;
    struct dalcs_audit_batch *g = &b->gathered;
    struct audit_batch_sums sums;
    const int first = audit_batch_first(audit, b, &sums);
    const int last = g->n - 1;
    audit->count.stretches += first - AUDIT_BATCH_FIRST;
    audit->count.screened += first - AUDIT_BATCH_FIRST;
    audit->budget.spent += AUDIT_SCREEN_WORK * (first - AUDIT_BATCH_FIRST);
    dalcs_audit_earn(audit, g->work);
    g->work = 0.0;
    part->at.past =
        last > AUDIT_BATCH_FIRST ? g->to[last - 1] - g->from[last - 1] : part->at.length;
    part->at.length = g->to[last] - g->from[last];
    part->at.past_coarse = false;
    part->watch->before.states = sums.end[last + 1];
    if (first <= last) {
        b->is_busy = true;
        part->watch->before.states = sums.end[first];
        for (int k = first; k <= last; k++) {
            revisit(audit, index, k);
        }
        b->is_busy = false;
        g->is_on = false;
        b->image = NULL;
    }
}

void dalcs_audit_settle(struct dalcs_audit *audit, int part) {
    struct dalcs_audit_batch *g = dalcs_audit_batch_of(audit, part);
    if (g->n > AUDIT_BATCH_FIRST) {
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
        audit_batch_input(b, j)[0] = audit_batch_input(b, j)[last];
    }
    g->from[0] = g->from[last];
    g->to[0] = g->to[last];
    g->n = AUDIT_BATCH_FIRST;
    draw_time(audit, watch, b);
}
