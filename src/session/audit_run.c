/* audit_run.c - reads the engine's answers for the auditor, and tells what it found. */
#include "audit_run.h"

#include "cycle.h"
#include "quantity.h"
#include "sliding.h"

#include <math.h>
#include <string.h>

/* Who belongs to a part, and where its columns are. */
struct audit_members {
    int n_nodes, n_devices, n_lambdas;
    int *node, *node_column;
    int *device; /* [n_devices] with currents of their own; others are the auditor's matter */
    int *lambda, *lambda_pair;
    bool was_left; /* its segment ended at the present time */
};

/* ---- Reading ------------------------------------------------------------------------------------- */

/* Do pairs of a device stand on both sides in turn? */
static bool is_mean(const struct dalcs_audit_run *a, const struct dalcs_component *c, int device) {
    const struct dalcs_circuit *circuit = &a->run->s->circuit;
    const struct dalcs_device *d = &circuit->device[device];
    const int first = a->run->s->network.readout->first_pair[device];
    if (!c->positions.joined || first < 0) {
        return false;
    }
    const int n = d->behaviour != NULL ? d->behaviour->n_pairs
                  : d->kind == DALCS_DIODE && isfinite(circuit->diode_model[d->model].vrev) ? 2
                                                                                            : 1;
    bool is = false;
    for (int k = 0; k < n && !is; k++) {
        is = dalcs_sliding_turns(&c->positions, first + k);
    }
    return is;
}

static void copy_answer(const struct dalcs_audit_run *a, int index, const double *y,
                        struct dalcs_audit_state *s) {
    const struct audit_members *m = &a->part[index];
    const struct dalcs_readout *readout = a->run->s->network.readout;
    const struct dalcs_component *c = &a->euler->component[index];
    for (int k = 0; k < m->n_nodes; k++) {
        s->v[m->node[k]] = y[m->node_column[k]];
    }
    for (int k = 0; k < m->n_devices; k++) {
        const int d = m->device[k];
        double current = 0.0;
        for (int j = readout->start[d]; j < readout->start[d + 1]; j++) {
            current += readout->term[j].coefficient * y[readout->term[j].column];
        }
        s->i[d] = current;
        s->is_mean[d] = is_mean(a, c, d);
        if (a->run->s->circuit.device[d].kind == DALCS_SWITCH) {
            s->is_closed[d] = dalcs_osnsp_is_on(&c->osnsp, readout->first_pair[d]);
        }
    }
    const int n_equations = dalcs_system_n_equations(c->system);
    for (int k = 0; k < m->n_lambdas; k++) {
        s->lambda[m->lambda[k]] = y[n_equations + m->lambda_pair[k]];
    }
}

static void read_state(void *user, int part, struct dalcs_audit_state *s) {
    const struct dalcs_audit_run *a = user;
    const struct dalcs_component *c = &a->euler->component[part];
    if (a->radau->part[part].kind == DALCS_PART_STEPPED) {
        dalcs_radau_read(a->radau, part, s->t, s->side);
    }
    copy_answer(a, part, c->y, s);
}

static void raise(double *largest, double value) {
    *largest = value > *largest ? value : *largest;
}

/* The engine's scales are of whole segments, the auditor has seen instants. */
static void raise_scales(void *user, int part, double *v, double *i, double *lambda) {
    const struct dalcs_audit_run *a = user;
    if (a->radau->part[part].kind != DALCS_PART_STEPPED) {
        return;
    }
    const struct audit_members *m = &a->part[part];
    const struct dalcs_readout *readout = a->run->s->network.readout;
    const double *scale = a->radau->part[part].scales.column;
    for (int k = 0; k < m->n_nodes; k++) {
        raise(&v[m->node[k]], scale[m->node_column[k]]);
    }
    for (int k = 0; k < m->n_devices; k++) {
        const int d = m->device[k];
        if (readout->start[d + 1] == readout->start[d] + 1) {
            const struct dalcs_readout_term *term = &readout->term[readout->start[d]];
            raise(&i[d], fabs(term->coefficient) * scale[term->column]);
        }
    }
    const int n_equations = dalcs_system_n_equations(a->euler->component[part].system);
    for (int k = 0; k < m->n_lambdas; k++) {
        raise(&lambda[m->lambda[k]], scale[n_equations + m->lambda_pair[k]]);
    }
}

/* ---- Who belongs to which part ------------------------------------------------------------------- */

static bool is_new(bool *seen, int node) {
    const bool was = seen[node];
    seen[node] = true;
    return !was;
}

/* Counts, or lists where there is room, the nodes and currents of all parts. */
static void list_members(const struct dalcs_audit_run *a, bool *seen, bool lists) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    const struct dalcs_readout *r = a->run->s->network.readout;
    int next_lambda = 0;
    memset(seen, 0, (size_t)c->n_nodes * sizeof *seen);
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        const int n_lambdas = d->behaviour != NULL ? d->behaviour->n_pairs : 0;
        if (r->device_system[i] < 0) {
            next_lambda += n_lambdas;
            continue;
        }
        struct audit_members *m = &a->part[r->device_system[i]];
        for (int e = 0; e < 4; e++) {
            const int node = d->node[e];
            if (node > 0 && r->node_column[node] >= 0 && is_new(seen, node)) {
                if (lists) {
                    m->node[m->n_nodes] = node;
                    m->node_column[m->n_nodes] = r->node_column[node];
                }
                m->n_nodes++;
            }
        }
        if (r->start[i + 1] > r->start[i] || d->kind == DALCS_SWITCH) {
            if (lists) {
                m->device[m->n_devices] = i;
            }
            m->n_devices++;
        }
        for (int k = 0; k < n_lambdas; k++) {
            if (lists) {
                m->lambda[m->n_lambdas] = next_lambda + k;
                m->lambda_pair[m->n_lambdas] = r->first_pair[i] + k;
            }
            m->n_lambdas++;
        }
        next_lambda += n_lambdas;
    }
}

static enum dalcs_status make_members(struct dalcs_audit_run *a) {
    const int n = a->run->s->network.n_systems;
    bool *seen = dalcs_arena_alloc(&a->arena, (size_t)a->run->s->circuit.n_nodes, sizeof(*seen));
    a->part = dalcs_arena_alloc(&a->arena, (size_t)n, sizeof(*a->part));
    if (seen == NULL || a->part == NULL) {
        return DALCS_E_NOMEM;
    }
    list_members(a, seen, false);
    for (int k = 0; k < n; k++) {
        struct audit_members *m = &a->part[k];
        m->node = dalcs_arena_alloc(&a->arena, (size_t)m->n_nodes, sizeof(int));
        m->node_column = dalcs_arena_alloc(&a->arena, (size_t)m->n_nodes, sizeof(int));
        m->device = dalcs_arena_alloc(&a->arena, (size_t)m->n_devices, sizeof(int));
        m->lambda = dalcs_arena_alloc(&a->arena, (size_t)m->n_lambdas, sizeof(int));
        m->lambda_pair = dalcs_arena_alloc(&a->arena, (size_t)m->n_lambdas, sizeof(int));
        if (m->node == NULL || m->node_column == NULL || m->device == NULL || m->lambda == NULL ||
            m->lambda_pair == NULL) {
            return DALCS_E_NOMEM;
        }
        m->n_nodes = m->n_devices = m->n_lambdas = 0;
    }
    list_members(a, seen, true);
    return DALCS_OK;
}

/* ---- Start and end ------------------------------------------------------------------------------- */

/* Instructions, at least, as callgrind counts them (doc/testing.md): a value of a polynomial, of a source; a value of a
 * row; an element of a map. */
static const double value_work = 15.0, source_work = 1000.0, row_work = 30.0, element_work = 0.6;

/* Likewise of segments beside their maps: one that recurs and that nobody reads, one with rows; and what a search for
 * its length and its events takes for each value of its polynomials. */
static const double segment_work = 2500.0, read_segment_work = 6000.0, search_work = 100.0;

/* Charges and fluxes are compared with currents and voltages, which are their derivatives: between the nodes of a step
 * these have half the digits, the square root of a rounding, however small the tolerance. The proof line tells what is
 * left. */
static const double least_failure = 0x1p-26;

/* The largest defect that ends no run. */
static double most_allowed(const struct dalcs_audit_run *a) {
    return fmax(a->run->tolerance, least_failure);
}

/* What a sample may cost of a run: with the counts above the netlists of the repository stay below 5 %. */
static const double share = 0.03;

static double read_work(const struct dalcs_audit_run *a, int part) {
    const struct dalcs_component *c = &a->euler->component[part];
    return value_work * dalcs_system_n_columns(c->system) + source_work * c->n_varying;
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
        work[k] = read_work(a, k);
    }
    const struct dalcs_audit_options options = {.mode = run->options->audit,
                                                .share = share,
                                                .resolution = a->radau->resolution,
                                                .vntol = run->vntol,
                                                .is_start = run->s->network.held == NULL,
                                                .abstol = run->abstol,
                                                .device_part =
                                                    run->s->network.readout->device_system,
                                                .n_parts = n,
                                                .tolerance = tolerance,
                                                .failure = most_allowed(a),
                                                .read_work = work};
    const struct dalcs_audit_reader reader = {a, read_state, raise_scales};
    return dalcs_audit_create(&a->audit, &run->s->circuit, &options, &reader);
}

enum dalcs_status dalcs_audit_run_start(struct dalcs_audit_run *a, struct dalcs_run *run,
                                        struct dalcs_euler *euler, struct dalcs_radau *radau) {
    *a = (struct dalcs_audit_run){
        .run = run, .euler = euler, .radau = radau, .tried_time = INFINITY};
    if (run->options->audit == DALCS_AUDIT_OFF || run->s->network.readout == NULL ||
        run->fixed_step > 0.0 /* whose error nobody controls */) {
        return DALCS_OK;
    }
    enum dalcs_status status = make_members(a);
    if (status == DALCS_OK && radau->cycling != NULL) {
        const int n_x = radau->cycling->component->system->n_x;
        a->tried = dalcs_arena_alloc(&a->arena, 2 * (size_t)n_x, sizeof(double));
        status = a->tried != NULL ? DALCS_OK : DALCS_E_NOMEM;
    }
    status = status == DALCS_OK ? create(a) : status;
    if (status != DALCS_OK) {
        dalcs_audit_run_finish(a);
    }
    return status;
}

void dalcs_audit_run_finish(struct dalcs_audit_run *a) {
    dalcs_audit_destroy(a->audit);
    dalcs_arena_finish(&a->arena);
    *a = (struct dalcs_audit_run){0};
}

/* ---- On the way ---------------------------------------------------------------------------------- */

static struct dalcs_audit_stretch stretch_of(const struct dalcs_audit_run *a, int k, double to) {
    const struct dalcs_radau_part *part = &a->radau->part[k];
    return (struct dalcs_audit_stretch){.part = k,
                                        .from = part->segment.t,
                                        .to = to,
                                        .step = part->segment.h,
                                        .degree = part->stages.method->s,
                                        .rule = part->segment.by_euler ? DALCS_AUDIT_COARSE
                                                                       : DALCS_AUDIT_SMOOTH};
}

static void enter(struct dalcs_audit_run *a, int k) {
    if (!dalcs_audit_was_left(a->audit, k)) {
        return;
    }
    const struct dalcs_audit_stretch stretch = stretch_of(a, k, a->radau->part[k].segment.t_end);
    dalcs_audit_enter(a->audit, &stretch);
}

void dalcs_audit_run_begin(struct dalcs_audit_run *a) {
    for (int k = 0; a->audit != NULL && k < a->radau->n_parts; k++) {
        if (a->radau->part[k].kind == DALCS_PART_STEPPED) {
            enter(a, k);
        }
    }
}

static void leave(struct dalcs_audit_run *a, int k, double to) {
    const struct dalcs_radau_part *part = &a->radau->part[k];
    const struct dalcs_stages *stages = &part->stages;
    const double elements = element_work * stages->n_in * stages->layout.n_fixed;
    const bool is_brief =
        part->segment.late != NULL; /* of which only what tells that it is one was computed */
    const bool is_last = to >= a->radau->options.stop;
    const double work =
        (a->has_rows ? read_segment_work : segment_work) +
        (is_brief ? 0.1 * elements : elements + search_work * stages->layout.n_fixed);
    if (dalcs_audit_passes_over(a->audit, k, work) && !is_last) {
        return;
    }
    struct dalcs_audit_stretch stretch = stretch_of(a, k, to);
    stretch.is_last = is_last;
    stretch.first_look = is_brief ? elements : 0.0;
    dalcs_audit_leave(a->audit, &stretch);
}

void dalcs_audit_run_leave(struct dalcs_audit_run *a, double t) {
    if (a->audit == NULL) {
        return;
    }
    const double stop = a->radau->options.stop;
    for (int k = 0; k < a->radau->n_parts; k++) {
        const struct dalcs_radau_part *part = &a->radau->part[k];
        const bool ends = part->segment.t_end <= t || t >= stop;
        a->part[k].was_left = part->kind == DALCS_PART_STEPPED && ends && part->segment.t < stop;
        if (a->part[k].was_left) {
            leave(a, k, part->segment.t_end < stop ? part->segment.t_end : stop);
        }
    }
    a->has_rows = false;
}

enum { TRIED_PERIODS = 3 };

enum dalcs_status dalcs_audit_run_leap(struct dalcs_audit_run *a, double until, bool *may) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    *may = a->tried_time == INFINITY;
    if (a->audit == NULL || !*may || a->was_tried) {
        a->was_tried = false;
        return DALCS_OK;
    }
    const double work = TRIED_PERIODS * dalcs_cycle_n_segments(part->memory.cycle) * segment_work;
    if (!dalcs_audit_may(a->audit, work) && a->has_tried) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_cycle_try(a->radau, until, TRIED_PERIODS, a->tried, &a->tried_time));
    *may = a->tried_time == INFINITY;
    a->has_tried |= !*may;
    return DALCS_OK;
}

/* How far the states of the cycling part are from x, over their scales. */
static double distance(const struct dalcs_radau_part *part, const double *x) {
    double worst = 0.0;
    for (int k = 0; k < part->component->system->n_x; k++) {
        const double off = fabs(x[k] - part->x[k]);
        worst = off > worst * part->scales.column[k] ? off / part->scales.column[k] : worst;
    }
    return worst;
}

void dalcs_audit_run_start_leap(struct dalcs_audit_run *a) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    if (a->audit != NULL) {
        memcpy(a->tried, part->x, (size_t)part->component->system->n_x * sizeof(double));
        a->leap_time = part->segment.t;
    }
}

void dalcs_audit_run_end_leap(struct dalcs_audit_run *a) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    const int n_x = part->component->system->n_x;
    const double periods =
        rint((part->segment.t - a->leap_time) / dalcs_cycle_period(part->memory.cycle));
    const double work = 3.0 * n_x * (n_x + 1) * periods;
    if (a->audit != NULL && (dalcs_audit_may(a->audit, work) || !a->has_passed)) {
        a->has_passed = true;
        dalcs_cycle_pass(part, (long)periods, a->tried, a->tried + n_x);
        dalcs_audit_add(a->audit, DALCS_AUDIT_PERIOD, part->index, distance(part, a->tried),
                        part->segment.t);
    }
}

/* The segment that a leap was tried to has begun, or another one has instead. */
static void compare_tried(struct dalcs_audit_run *a) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    const double near = 4.0 * a->radau->resolution;
    if (part == NULL || part->segment.t < a->tried_time - near) {
        return;
    }
    const bool is_other = part->segment.t > a->tried_time + near;
    const double worst = is_other ? 1.0 : distance(part, a->tried);
    dalcs_audit_add(a->audit, DALCS_AUDIT_PERIOD, part->index, worst, part->segment.t);
    a->tried_time = INFINITY;
    a->was_tried = true;
}

void dalcs_audit_run_enter(struct dalcs_audit_run *a) {
    if (a->audit != NULL) {
        compare_tried(a);
    }
    for (int k = 0; a->audit != NULL && k < a->radau->n_parts; k++) {
        if (a->part[k].was_left && a->radau->part[k].segment.t < a->radau->options.stop) {
            enter(a, k);
        }
    }
}

void dalcs_audit_run_rows(struct dalcs_audit_run *a, double t, enum dalcs_side side, long n) {
    if (a->audit == NULL) {
        return;
    }
    const double work = row_work * (double)n * a->run->s->network.n_outputs;
    dalcs_audit_earn(a->audit, work);
    a->has_rows = true;
    for (int k = 0; k < a->radau->n_parts; k++) {
        if (a->radau->part[k].kind == DALCS_PART_ALGEBRAIC) {
            dalcs_audit_instant(a->audit, k, t, side, segment_work);
        }
    }
}

/* ---- What was found ------------------------------------------------------------------------------ */

enum { NAME_SIZE = 512 };

/* Each value that a law adds up is promised to the tolerance times its scale, so is their sum to that times the sum of
 * scales, by which a defect is divided. */
bool dalcs_audit_run_fails(const struct dalcs_audit_run *a) {
    return a->audit != NULL && dalcs_audit_summarise(a->audit).is_broken;
}

static enum dalcs_status tell_law(const struct dalcs_audit_run *a, enum dalcs_audit_law law,
                                  int index, const struct dalcs_audit_finding *f,
                                  struct dalcs_audited *to) {
    char name[NAME_SIZE];
    dalcs_audit_law_name(a->audit, law, index, name, sizeof name);
    const char *copy = dalcs_arena_copy(&a->run->s->arena, name, strlen(name));
    *to = (struct dalcs_audited){copy, f->defect, f->time};
    return copy != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* Laws with a defect: how many, and into list[] where that is not NULL. */
static enum dalcs_status list_laws(const struct dalcs_audit_run *a, struct dalcs_audited *list,
                                   size_t *n) {
    *n = 0;
    for (int law = 0; law < DALCS_AUDIT_N_LAWS; law++) {
        for (int i = 0; i < dalcs_audit_n_of(a->audit, law); i++) {
            const struct dalcs_audit_finding f = dalcs_audit_finding_of(a->audit, law, i);
            if (f.defect > 0.0 && list != NULL) {
                DALCS_TRY(tell_law(a, law, i, &f, &list[*n]));
            }
            *n += f.defect > 0.0 ? 1 : 0;
        }
    }
    return DALCS_OK;
}

static enum dalcs_status report_laws(const struct dalcs_audit_run *a) {
    struct dalcs_report *report = &a->run->s->report;
    size_t n;
    DALCS_TRY(list_laws(a, NULL, &n));
    struct dalcs_audited *list = dalcs_arena_alloc(&a->run->s->arena, n, sizeof *list);
    if (list == NULL) {
        return DALCS_E_NOMEM;
    }
    report->audit.law = list;
    return list_laws(a, list, &report->audit.n_laws);
}

static enum dalcs_status tell_broken(const struct dalcs_audit_run *a,
                                     const struct dalcs_audit_summary *found, const char *name) {
    char time[DALCS_QUANTITY_SIZE];
    dalcs_diag_add(
        &a->run->s->diag, DALCS_ERROR, NULL,
        "the report lists the laws that are broken; please report this netlist",
        "the waveform seems wrong: the audit finds %s broken by %.2g of its scale at t = "
        "%s, and %.2g is allowed",
        name, found->defect, dalcs_quantity_write(time, found->time, "s", 9), most_allowed(a));
    return DALCS_NOT_CONVERGED;
}

/* Where the run fell back to implicit Euler, nobody controls the error: it is told. */
static void tell_coarse(const struct dalcs_audit_run *a) {
    const struct dalcs_audit_summary coarse = dalcs_audit_summarise_coarse(a->audit);
    if (coarse.index < 0 || coarse.defect <= most_allowed(a)) {
        return;
    }
    char name[NAME_SIZE];
    char time[DALCS_QUANTITY_SIZE];
    dalcs_audit_law_name(a->audit, coarse.law, coarse.index, name, sizeof name);
    dalcs_diag_add(&a->run->s->diag, DALCS_WARNING, NULL, NULL,
                   "the waveform is coarse where the run fell back to implicit Euler: the audit "
                   "finds %s broken by %.2g of its scale at t = %s",
                   name, coarse.defect, dalcs_quantity_write(time, coarse.time, "s", 9));
}

enum dalcs_status dalcs_audit_run_report(struct dalcs_audit_run *a) {
    if (a->audit == NULL) {
        return DALCS_OK;
    }
    struct dalcs_session *s = a->run->s;
    const struct dalcs_audit_summary found = dalcs_audit_summarise(a->audit);
    char name[NAME_SIZE] = "";
    if (found.index >= 0) {
        dalcs_audit_law_name(a->audit, found.law, found.index, name, sizeof name);
    }
    s->report.audit.mode = a->run->options->audit == DALCS_AUDIT_FULL ? "full" : "sample";
    s->report.audit.instants = found.instants;
    s->report.audit.segments = found.stretches;
    s->report.audit.audited = found.audited;
    s->report.audit.positions = found.positions;
    s->report.audit.worst = found.defect;
    s->report.audit.allowed = found.allowed;
    s->report.audit.time = found.time;
    s->report.audit.where = dalcs_arena_copy(&s->arena, name, strlen(name));
    if (s->report.audit.where == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(report_laws(a));
    tell_coarse(a);
    return found.is_broken ? tell_broken(a, &found, name) : DALCS_OK;
}
