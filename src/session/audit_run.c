/* audit_run.c - which segments are handed to the auditor, and when. */
#include "audit_reader.h"

#include "congruential.h"
#include "transient.h"

#include <math.h>
#include <string.h>

/* ---- Start and end ------------------------------------------------------------------------------- */

/* Instructions, at least, as callgrind counts them (doc/testing.md): a value of a polynomial, of a source; a value of a
 * row; an element of a map. */
static const double value_work = 15.0, source_work = 1000.0, row_work = 30.0, element_work = 0.6;

/* Likewise of a segment that does not recur, with what the search for its length and its events takes for each of its
 * values; of rows in it; of an event that ends it. */
static const double search_work = 3000.0, search_value_work = 15.0, read_work = 2500.0,
                    event_work = 10000.0;

/* Charges and fluxes are compared with currents and voltages, which are their derivatives: between the nodes of a step
 * these have half the digits, the square root of a rounding, however small the tolerance. The proof line tells what is
 * left. */
static const double least_failure = 0x1p-26;

double dalcs_audit_most_allowed(const struct dalcs_audit_run *a) {
    return fmax(a->run->tolerance, least_failure);
}

double dalcs_audit_state_work(const struct dalcs_audit_run *a, int part) {
    const struct dalcs_component *c = &a->euler->component[part];
    return value_work * dalcs_system_n_columns(c->system) + source_work * c->varying.n;
}

/* Of gates, and of sources and switches that jump at 0, the operating point is not what the run begins with. */
static enum dalcs_audit_origin origin_of(const struct dalcs_run *run, struct dalcs_radau *radau) {
    const struct dalcs_circuit *c = &run->s->circuit;
    if (run->orbit != NULL || run->s->network.held != NULL || c->n_initial_conditions > 0) {
        return DALCS_AUDIT_FROM_ANYWHERE;
    }
    if (c->analyses.transient.use_initial_conditions) {
        return DALCS_AUDIT_FROM_INITIAL;
    }
    return c->control.n_gates > 0 || dalcs_transient_begins_with_a_jump(c, radau)
               ? DALCS_AUDIT_FROM_ANYWHERE
               : DALCS_AUDIT_FROM_REST;
}

static enum dalcs_status create(struct dalcs_audit_run *a) {
    const struct dalcs_run *run = a->run;
    const int n = run->s->network.n_systems;
    double *tolerance = dalcs_arena_alloc(&a->arena, (size_t)n, sizeof(double));
    double *work = dalcs_arena_alloc(&a->arena, (size_t)n, sizeof(double));
    if (tolerance == NULL || work == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < n; k++) {
        tolerance[k] = a->radau->part[k].tolerance;
        work[k] = dalcs_audit_state_work(a, k);
    }
    const struct dalcs_audit_options options = {.mode = run->options->audit,
                                                .share = dalcs_audit_share,
                                                .resolution = a->radau->resolution,
                                                .vntol = run->radau.vntol,
                                                .is_start = run->s->network.held == NULL,
                                                .origin = origin_of(run, a->radau),
                                                .abstol = run->radau.abstol,
                                                .device_part =
                                                    run->s->network.readout->device_system,
                                                .n_parts = n,
                                                .tolerance = tolerance,
                                                .failure = dalcs_audit_most_allowed(a),
                                                .read_work = work};
    const struct dalcs_audit_reader reader = dalcs_audit_reader_of(a);
    return dalcs_audit_create(&a->audit, &run->s->circuit, &options, &reader);
}

static void start_part(struct audit_members *m, const struct dalcs_radau_part *part) {
    const struct dalcs_stages *stages = &part->stages;
    m->work.elements = element_work * stages->n_in * stages->layout.n_fixed;
    m->work.brief = dalcs_audit_segment_work;
    m->work.segment = search_work + search_value_work * stages->layout.n_fixed + m->work.elements;
    m->stored = (struct dalcs_audit_polynomials){
        .n_columns = dalcs_system_n_columns(part->component->system),
        .n_nodes = stages->layout.n_nodes,
        .n_inputs = stages->n_in,
        .stride = stages->layout.stride,
        .node = stages->method->node};
    m->has_maps = dalcs_stages_have_maps(stages);
    m->stretch = (struct dalcs_audit_stretch){.part = part->index, .degree = stages->method->s};
}

static enum dalcs_status list_bystanders(struct dalcs_audit_run *a, int part) {
    const struct dalcs_bystanders *b = &a->radau->part[part].excitation.bystanders;
    const int n = a->part[part].stored.n_columns;
    int *of_column = a->part[part].bystander = dalcs_arena_alloc(&a->arena, (size_t)n, sizeof(int));
    if (of_column == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int c = 0; c < n; c++) {
        of_column[c] = -1;
    }
    for (int i = 0; i < b->n; i++) {
        of_column[b->column[i]] = i;
    }
    return DALCS_OK;
}

static enum dalcs_status list_stepped(struct dalcs_audit_run *a) {
    a->stepped = dalcs_arena_alloc(&a->arena, (size_t)a->radau->n_parts, sizeof(int));
    for (int k = 0; k < a->radau->n_parts && a->stepped != NULL; k++) {
        if (a->radau->part[k].kind == DALCS_PART_STEPPED) {
            a->stepped[a->n_stepped++] = k;
            start_part(&a->part[k], &a->radau->part[k]);
            DALCS_TRY(list_bystanders(a, k));
            DALCS_TRY(dalcs_audit_present_make(a, k));
        }
    }
    a->has_algebraic = a->n_stepped < a->radau->n_parts;
    return a->stepped != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_audit_run_start(struct dalcs_audit_run *a, struct dalcs_run *run,
                                        struct dalcs_euler *euler, struct dalcs_radau *radau) {
    *a = (struct dalcs_audit_run){.run = run,
                                  .euler = euler,
                                  .radau = radau,
                                  .leaps.tried_time = INFINITY,
                                  .leaps.landed = INFINITY};
    if (run->options->audit == DALCS_AUDIT_OFF || run->s->network.readout == NULL ||
        run->radau.fixed_step > 0.0 /* whose error nobody controls */) {
        return DALCS_OK;
    }
    a->rows.work = row_work * run->s->network.n_outputs;
    a->rows.share = dalcs_audit_share * a->rows.work;
    enum dalcs_status status = dalcs_audit_members_make(a);
    status = status == DALCS_OK ? list_stepped(a) : status;
    if (status == DALCS_OK && radau->cycling != NULL) {
        const int n_x = radau->cycling->component->system->n_x;
        const int n_elements = n_x * (n_x + 1);
        a->leaps.tried =
            dalcs_arena_alloc(&a->arena, (size_t)(2 * n_x + 2 * n_elements), sizeof(double));
        a->leaps.passed = dalcs_arena_alloc(&a->arena, (size_t)n_x, sizeof(double));
        status = a->leaps.tried != NULL && a->leaps.passed != NULL ? DALCS_OK : DALCS_E_NOMEM;
    }
    if (status == DALCS_OK) {
        status =
            dalcs_audit_gates_start(&a->gates, &run->s->circuit, radau, run->s->network.readout);
    }
    if (status == DALCS_OK) {
        status =
            dalcs_audit_delays_start(&a->delays, &run->s->circuit, radau, run->s->network.readout);
    }
    status = status == DALCS_OK ? create(a) : status;
    for (int i = 0; i < a->n_stepped && status == DALCS_OK; i++) {
        a->part[a->stepped[i]].batch = dalcs_audit_batch_of(a->audit, a->stepped[i]);
    }
    if (status != DALCS_OK) {
        dalcs_audit_run_finish(a);
    }
    return status;
}

double dalcs_audit_run_chance(struct dalcs_audit_run *a) {
    return dalcs_congruential_chance(&a->seed);
}

void dalcs_audit_run_settle(struct dalcs_audit_run *a, int k) {
    struct audit_members *m = &a->part[k];
    if (m->held != NULL) {
        dalcs_audit_settle(a->audit, k);
        dalcs_stages_release(&a->radau->part[k].stages, m->held);
        m->held = NULL;
    }
}

void dalcs_audit_run_finish(struct dalcs_audit_run *a) {
    for (int i = 0; a->audit != NULL && i < a->n_stepped; i++) {
        dalcs_audit_run_settle(a, a->stepped[i]);
    }
    dalcs_audit_destroy(a->audit);
    dalcs_audit_gates_finish(&a->gates);
    dalcs_audit_delays_finish(&a->delays);
    dalcs_arena_finish(&a->arena);
    *a = (struct dalcs_audit_run){0};
}

/* ---- On the way ---------------------------------------------------------------------------------- */

static void enter(struct dalcs_audit_run *a, int k) {
    if (!dalcs_audit_begins(a->audit, k)) {
        return;
    }
    dalcs_audit_enter(a->audit, dalcs_audit_reader_stretch(a, k, a->radau->part[k].segment.t_end));
}

void dalcs_audit_run_begin(struct dalcs_audit_run *a) {
    for (int i = 0; a->audit != NULL && i < a->n_stepped; i++) {
        if (a->euler->component[a->stepped[i]].commands.restless != NULL) {
            dalcs_audit_has_no_rest(a->audit, a->stepped[i]);
        }
        enter(a, a->stepped[i]);
    }
}

static double work_of(const struct dalcs_audit_run *a, const struct audit_members *m,
                      const struct dalcs_part_segment *segment) {
    double work = segment->late != NULL ? m->work.brief : m->work.segment;
    if (segment->why == DALCS_END_AT_EVENT) {
        work += event_work;
    }
    if (a->rows.has_any) {
        work += read_work;
    }
    return work;
}

/* It repeats the one before, and is asked together with others. The map that gave them stays. */
static inline bool gathers(struct dalcs_audit_run *a, int k) {
    const struct dalcs_radau_part *part = &a->radau->part[k];
    const struct dalcs_part_segment *s = &part->segment;
    struct audit_members *m = &a->part[k];
    struct dalcs_audit_batch *batch = m->batch;
    if (a->delays.delay != NULL /* what sources put out is not kept for so long (history.h) */ ||
        !batch->is_on || s->t_end > batch->last || !dalcs_audit_reader_repeats(part, m) ||
        (s->late == NULL && !dalcs_audit_is_image(a->audit, k, s->in, s->out))) {
        return false;
    }
    if (m->held == NULL) {
        m->held = m->map;
        dalcs_stages_hold(m->held);
    }
    dalcs_audit_put(batch, s->t, s->t_end, s->in, work_of(a, m, s));
    m->last.out = s->out;
    m->last.time = s->t_end;
    if (batch->n == DALCS_AUDIT_BATCH) {
        dalcs_audit_ask_batch(a->audit, k);
    }
    return true;
}

/* One sample of each segment, as far as the budget goes. Without memory for it what is left is not asked. */
static void look_at_delays(struct dalcs_audit_run *a, int k, double to) {
    if (a->delays.delay == NULL) {
        return;
    }
    const double work = 2.0 * a->run->s->circuit.control.n_delayed * dalcs_audit_state_work(a, k);
    const bool samples =
        a->run->options->audit == DALCS_AUDIT_FULL || dalcs_audit_may(a->audit, work);
    if (dalcs_audit_delays_leave(&a->delays, a->audit, k, to, samples, dalcs_audit_run_chance(a)) !=
        DALCS_OK) {
        dalcs_audit_delays_finish(&a->delays);
    }
}

static void leave(struct dalcs_audit_run *a, int k, double to) {
    look_at_delays(a, k, to);
    const struct dalcs_part_segment *segment = &a->radau->part[k].segment;
    const struct audit_members *m = &a->part[k];
    const bool is_last = to >= a->radau->options.stop;
    if (to == segment->t_end && !is_last && gathers(a, k)) {
        return;
    }
    dalcs_audit_run_settle(a, k);
    const double work = work_of(a, m, segment);
    struct dalcs_audit_stretch *stretch = dalcs_audit_reader_stretch(a, k, to);
    if (!dalcs_audit_passes_over(a->audit, stretch, work) || is_last) {
        stretch->is_last = is_last;
        /* of a late one only what tells that it is a segment was computed */
        stretch->first_look = segment->late != NULL ? m->work.elements : 0.0;
        dalcs_audit_leave(a->audit, stretch);
        a->was_left = true;
    }
    dalcs_audit_reader_keep(a, k);
}

void dalcs_audit_run_leave(struct dalcs_audit_run *a, double t) {
    if (a->audit == NULL) {
        return;
    }
    const double stop = a->radau->options.stop;
    for (int i = 0; i < a->n_stepped; i++) {
        const int k = a->stepped[i];
        const struct dalcs_radau_part *part = &a->radau->part[k];
        const bool ends = part->segment.t_end <= t || t >= stop;
        a->part[k].was_left = ends && part->segment.t < stop;
        if (a->part[k].was_left) {
            leave(a, k, part->segment.t_end < stop ? part->segment.t_end : stop);
        }
    }
    dalcs_audit_earn_rows(a);
    a->rows.has_any = false;
}

void dalcs_audit_run_cut(struct dalcs_audit_run *a, int part, double t) {
    if (a->audit != NULL && a->radau->part[part].kind == DALCS_PART_STEPPED &&
        !a->part[part].was_left) {
        a->part[part].was_left = true;
        leave(a, part, t);
    }
}

void dalcs_audit_run_enter_now(struct dalcs_audit_run *a) {
    if (a->leaps.tried_time < INFINITY) {
        dalcs_audit_leaps_compare(a);
    }
    a->was_left = false;
    for (int i = 0; i < a->n_stepped; i++) {
        const int k = a->stepped[i];
        if (a->part[k].was_left && a->radau->part[k].segment.t < a->radau->options.stop) {
            enter(a, k);
        }
    }
}

enum dalcs_status dalcs_audit_run_gates(struct dalcs_audit_run *a,
                                        const struct dalcs_logic_run *logic, double t) {
    return a->audit != NULL ? dalcs_audit_gates_look(&a->gates, a->audit, logic, t) : DALCS_OK;
}

enum dalcs_status dalcs_audit_run_sample(struct dalcs_audit_run *a, double t) {
    return a->audit != NULL ? dalcs_audit_gates_sample(&a->gates, t) : DALCS_OK;
}
