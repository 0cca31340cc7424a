/* audit.c - parts, what is looked at and when, and the worst that was found. */
#include "audit_internal.h"

#include "union_find.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Parts --------------------------------------------------------------------------------------- */

static void count_members(struct dalcs_audit *audit, int *part_of_node) {
    const struct dalcs_circuit *c = audit->circuit;
    for (int i = 0; i < c->n_devices; i++) {
        const int k = audit->options.device_part[i];
        if (k < 0 || dalcs_device_is_short(&c->device[i])) {
            continue;
        }
        audit->part[k].n_devices++;
        for (int e = 0; e < 2; e++) {
            const int node = audit->node_of[c->device[i].node[e]];
            if (node != 0 && part_of_node[node] < 0) {
                part_of_node[node] = k;
                audit->part[k].n_nodes++;
            }
        }
    }
    for (int i = 0; i < c->n_couplings; i++) {
        const int k = audit->options.device_part[c->coupling[i].inductor[0]];
        if (k >= 0) {
            audit->part[k].n_couplings++;
        }
    }
}

static void see_conductance(struct audit_part *part, double g) {
    if (g > 0.0 && isfinite(g)) {
        part->most = fmax(part->most, g);
        part->least = part->least > 0.0 ? fmin(part->least, g) : g;
    }
}

static void list_members(struct dalcs_audit *audit, const int *part_of_node) {
    const struct dalcs_circuit *c = audit->circuit;
    for (int k = 0; k < audit->options.n_parts; k++) {
        audit->part[k].n_devices = audit->part[k].n_nodes = audit->part[k].n_couplings = 0;
    }
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        const int k = audit->options.device_part[i];
        if (k < 0 || dalcs_device_is_short(d)) {
            continue;
        }
        struct audit_part *part = &audit->part[k];
        part->device[part->n_devices++] = i;
        for (int e = 0; e < 2; e++) {
            const bool is_charged = d->kind == DALCS_CAPACITOR;
            audit->has_charge[audit->node_of[d->node[e]]] |= is_charged;
        }
        part->has_formula |= d->behaviour != NULL && d->behaviour->n_pairs > 0;
        if (d->kind == DALCS_RESISTOR) {
            see_conductance(part, fabs(1.0 / d->value));
        } else if (d->kind == DALCS_VCCS && d->behaviour == NULL) {
            see_conductance(part, fabs(d->value));
        } else if (d->kind == DALCS_SWITCH) {
            see_conductance(part, 1.0 / c->switch_model[d->model].ron);
            see_conductance(part, 1.0 / c->switch_model[d->model].roff);
        } else if (d->kind == DALCS_DIODE) {
            see_conductance(part, 1.0 / c->diode_model[d->model].ron);
            see_conductance(part, 1.0 / c->diode_model[d->model].roff);
        }
    }
    for (int node = 1; node < c->n_nodes; node++) {
        if (part_of_node[node] >= 0) {
            struct audit_part *part = &audit->part[part_of_node[node]];
            part->node[part->n_nodes++] = node;
        }
    }
    for (int i = 0; i < c->n_couplings; i++) {
        const int k = audit->options.device_part[c->coupling[i].inductor[0]];
        if (k >= 0) {
            audit->part[k].coupling[audit->part[k].n_couplings++] = i;
        }
    }
}

static enum dalcs_status make_parts(struct dalcs_audit *audit) {
    struct dalcs_arena *arena = &audit->arena;
    const struct dalcs_circuit *c = audit->circuit;
    int *part_of_node = dalcs_arena_alloc(arena, (size_t)c->n_nodes, sizeof(int));
    audit->part = dalcs_arena_alloc(arena, (size_t)audit->options.n_parts, sizeof(*audit->part));
    if (part_of_node == NULL || audit->part == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int n = 0; n < c->n_nodes; n++) {
        part_of_node[n] = -1;
    }
    count_members(audit, part_of_node);
    for (int k = 0; k < audit->options.n_parts; k++) {
        struct audit_part *part = &audit->part[k];
        part->device = dalcs_arena_alloc(arena, (size_t)part->n_devices, sizeof(int));
        part->node = dalcs_arena_alloc(arena, (size_t)part->n_nodes, sizeof(int));
        part->coupling = dalcs_arena_alloc(arena, (size_t)part->n_couplings, sizeof(int));
        if (part->device == NULL || part->node == NULL || part->coupling == NULL) {
            return DALCS_E_NOMEM;
        }
        part->tolerance = audit->options.tolerance[k];
    }
    list_members(audit, part_of_node);
    return DALCS_OK;
}

static void merge_shorts(struct dalcs_audit *audit) {
    const struct dalcs_circuit *c = audit->circuit;
    dalcs_union_reset(audit->node_of, c->n_nodes);
    for (int i = 0; i < c->n_devices; i++) {
        if (dalcs_device_is_short(&c->device[i])) {
            dalcs_union_join(audit->node_of, c->device[i].node[0], c->device[i].node[1]);
        }
    }
    for (int n = 0; n < c->n_nodes; n++) {
        audit->node_of[n] = dalcs_union_find(audit->node_of, n);
    }
}

/* ---- Room ---------------------------------------------------------------------------------------- */

static enum dalcs_status make_state(struct dalcs_audit *audit, struct dalcs_audit_state *s) {
    const struct dalcs_circuit *c = audit->circuit;
    s->v = dalcs_arena_alloc(&audit->arena, (size_t)c->n_nodes, sizeof(double));
    s->i = dalcs_arena_alloc(&audit->arena, (size_t)c->n_devices, sizeof(double));
    s->lambda = dalcs_arena_alloc(&audit->arena, (size_t)audit->n_lambdas, sizeof(double));
    s->is_closed = dalcs_arena_alloc(&audit->arena, (size_t)c->n_devices, sizeof(bool));
    s->is_mean = dalcs_arena_alloc(&audit->arena, (size_t)c->n_devices, sizeof(bool));
    bool complete = s->v != NULL && s->i != NULL && s->lambda != NULL && s->is_closed != NULL &&
                    s->is_mean != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

int dalcs_audit_n_of(const struct dalcs_audit *audit, enum dalcs_audit_law law) {
    return law == DALCS_AUDIT_KCL      ? audit->circuit->n_nodes
           : law >= DALCS_AUDIT_ENERGY ? audit->options.n_parts
                                       : audit->circuit->n_devices;
}

static enum dalcs_status make_sums(struct dalcs_audit *audit) {
    const size_t n_nodes = (size_t)audit->circuit->n_nodes;
    const size_t n_devices = (size_t)audit->circuit->n_devices;
    double **per_node[] = {&audit->sums.current, &audit->sums.scale, &audit->sums.rounding,
                           &audit->v_scale, &audit->offset};
    double **per_device[] = {&audit->sums.flux, &audit->i_scale};
    bool complete = true;
    for (size_t k = 0; k < sizeof per_node / sizeof *per_node; k++) {
        *per_node[k] = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(double));
        complete = complete && *per_node[k] != NULL;
    }
    for (size_t k = 0; k < sizeof per_device / sizeof *per_device; k++) {
        *per_device[k] = dalcs_arena_alloc(&audit->arena, n_devices, sizeof(double));
        complete = complete && *per_device[k] != NULL;
    }
    for (int law = 0; law < DALCS_AUDIT_N_LAWS; law++) {
        audit->worst_of[law] = dalcs_arena_alloc(
            &audit->arena, (size_t)dalcs_audit_n_of(audit, law), sizeof(*audit->worst_of[law]));
        complete = complete && audit->worst_of[law] != NULL;
    }
    audit->lambda_scale =
        dalcs_arena_alloc(&audit->arena, (size_t)audit->n_lambdas, sizeof(double));
    audit->cluster = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(int));
    return complete && audit->lambda_scale != NULL && audit->cluster != NULL ? DALCS_OK
                                                                             : DALCS_E_NOMEM;
}

static enum dalcs_status number_lambdas(struct dalcs_audit *audit) {
    const struct dalcs_circuit *c = audit->circuit;
    audit->first_lambda = dalcs_arena_alloc(&audit->arena, (size_t)c->n_devices, sizeof(int));
    if (audit->first_lambda == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < c->n_devices; i++) {
        audit->first_lambda[i] = audit->n_lambdas;
        audit->n_lambdas += c->device[i].behaviour != NULL ? c->device[i].behaviour->n_pairs : 0;
    }
    return DALCS_OK;
}

static void find_fed(const struct dalcs_audit *audit) {
    const struct dalcs_circuit *c = audit->circuit;
    audit->is_fed[0] = true;
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (d->kind == DALCS_VSOURCE && (d->node[0] == 0 || d->node[1] == 0)) {
            const struct dalcs_stimulus *s = &c->stimulus[d->stimulus];
            audit->is_fed[d->node[d->node[0] == 0]] = dalcs_stimulus_value(s, 0.0, DALCS_LEFT) ==
                                                      dalcs_stimulus_value(s, 0.0, DALCS_RIGHT);
        }
    }
}

static enum dalcs_status set_up(struct dalcs_audit *audit) {
    const size_t n_nodes = (size_t)audit->circuit->n_nodes;
    audit->node_of = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(int));
    audit->has_charge = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(bool));
    audit->is_fed = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(bool));
    if (audit->node_of == NULL || audit->has_charge == NULL || audit->is_fed == NULL) {
        return DALCS_E_NOMEM;
    }
    find_fed(audit);
    merge_shorts(audit);
    DALCS_TRY(number_lambdas(audit));
    DALCS_TRY(make_parts(audit));
    DALCS_TRY(make_sums(audit));
    DALCS_TRY(make_state(audit, &audit->now));
    DALCS_TRY(make_state(audit, &audit->later));
    DALCS_TRY(make_state(audit, &audit->shifted));
    DALCS_TRY(make_state(audit, &audit->before));
    return DALCS_OK;
}

/* What a start of the program costs, and how much an instant does for a device, in instructions: measured with
 * callgrind on the netlists of the repository (doc/testing.md). */
static const double start_work = 5e5;
static const double device_work = 500.0, node_work = 200.0;

/* Of switches, whose controls are read, and sources, whose edges are looked for. */
static const double moving_work = 3000.0;

/* Of a coupling, for all coils of which fluxes are added up. */
static const double coupling_work = 2000.0;

/* Instants of a look: one inside, and both sides of its end. */
enum { LOOK_INSTANTS = 3 };

static double instant_work(const struct dalcs_circuit *c, const struct audit_part *part) {
    double work = node_work * part->n_nodes + coupling_work * part->n_couplings;
    for (int k = 0; k < part->n_devices; k++) {
        const struct dalcs_device *d = &c->device[part->device[k]];
        const bool moves =
            d->kind == DALCS_SWITCH ||
            (d->kind == DALCS_VSOURCE && c->stimulus[d->stimulus].kind != DALCS_STIMULUS_DC);
        work += moves ? moving_work : device_work;
    }
    return work;
}

static const uint64_t first_seed = 0x9e3779b97f4a7c15u;

enum dalcs_status dalcs_audit_create(struct dalcs_audit **audit,
                                     const struct dalcs_circuit *circuit,
                                     const struct dalcs_audit_options *options,
                                     const struct dalcs_audit_reader *reader) {
    struct dalcs_audit *a = *audit = dalcs_alloc(1, sizeof(*a));
    if (a == NULL) {
        return DALCS_E_NOMEM;
    }
    *a = (struct dalcs_audit){.circuit = circuit,
                              .options = *options,
                              .reader = *reader,
                              .seed = first_seed,
                              .credit = options->share * start_work};
    enum dalcs_status status = options->n_parts > 0 ? set_up(a) : DALCS_OK;
    for (int k = 0; k < options->n_parts && status == DALCS_OK; k++) {
        a->part[k].cost = instant_work(circuit, &a->part[k]) + options->read_work[k];
        a->credit -=
            LOOK_INSTANTS * a->part[k].cost; /* of its end, which is looked at in any case */
    }
    if (status != DALCS_OK) {
        dalcs_audit_destroy(a);
        *audit = NULL;
    }
    return status;
}

void dalcs_audit_destroy(struct dalcs_audit *audit) {
    if (audit != NULL) {
        dalcs_arena_finish(&audit->arena);
        free(audit);
    }
}

/* ---- What is found ------------------------------------------------------------------------------- */

static void find_coarse(struct dalcs_audit *audit, enum dalcs_audit_law law, int index,
                        double defect, double time) {
    if (!(defect <= audit->coarse.defect)) {
        audit->coarse.defect = isnan(defect) ? INFINITY : defect;
        audit->coarse.time = time;
        audit->coarse_law = law;
        audit->coarse_index = index;
    }
}

void audit_find(struct dalcs_audit *audit, const struct audit_part *part, enum dalcs_audit_law law,
                int index, double defect, double scale, double time) {
    struct audit_worst *worst = &audit->worst_of[law][index];
    if (part->is_coarse) {
        find_coarse(audit, law, index, audit_ratio(defect, scale), time);
        return;
    }
    worst->part = (int)(part - audit->part);
    worst->scale = fmax(worst->scale, scale);
    if (!(defect <= worst->defect)) { /* not a number is as wrong as can be */
        worst->defect = isnan(defect) ? INFINITY : defect;
        worst->time = time;
    }
}

struct dalcs_audit_finding dalcs_audit_finding_of(const struct dalcs_audit *audit,
                                                  enum dalcs_audit_law law, int index) {
    const struct audit_worst *worst = &audit->worst_of[law][index];
    return (struct dalcs_audit_finding){audit_ratio(worst->defect, worst->scale), worst->time};
}

struct dalcs_audit_summary dalcs_audit_summarise(const struct dalcs_audit *audit) {
    struct dalcs_audit_summary sum = audit->count;
    sum.index = -1;
    for (int law = 0; law < DALCS_AUDIT_N_LAWS && audit->options.n_parts > 0; law++) {
        for (int i = 0; i < dalcs_audit_n_of(audit, law); i++) {
            const struct dalcs_audit_finding f = dalcs_audit_finding_of(audit, law, i);
            const double allowed = audit->part[audit->worst_of[law][i].part].tolerance;
            const bool is_broken = f.defect > audit->options.failure;
            const bool is_worse = f.defect * sum.allowed > sum.defect * allowed;
            if (sum.index < 0 || is_broken > sum.is_broken ||
                (is_broken == sum.is_broken && is_worse)) {
                sum.is_broken = is_broken;
                sum.defect = f.defect;
                sum.allowed = allowed;
                sum.time = f.time;
                sum.law = law;
                sum.index = i;
            }
        }
    }
    return sum;
}

struct dalcs_audit_summary dalcs_audit_summarise_coarse(const struct dalcs_audit *audit) {
    struct dalcs_audit_summary sum = audit->count;
    sum.index = audit->coarse.defect > 0.0 ? audit->coarse_index : -1;
    sum.defect = audit->coarse.defect;
    sum.time = audit->coarse.time;
    sum.law = audit->coarse_law;
    return sum;
}

void dalcs_audit_law_name(const struct dalcs_audit *audit, enum dalcs_audit_law law, int index,
                          char *text, size_t size) {
    const struct dalcs_circuit *c = audit->circuit;
    switch (law) {
    case DALCS_AUDIT_KCL:
        snprintf(text, size, "KCL at %s", c->node_name[index]);
        break;
    case DALCS_AUDIT_BRANCH:
        snprintf(text, size, "%s", c->device[index].name);
        break;
    case DALCS_AUDIT_CURRENT:
        snprintf(text, size, "i(%s)", c->device[index].name);
        break;
    case DALCS_AUDIT_POSITION:
        snprintf(text, size, "position of %s", c->device[index].name);
        break;
    case DALCS_AUDIT_ENERGY:
        snprintf(text, size, "Tellegen");
        break;
    default:
        snprintf(text, size, "periods leapt over");
        break;
    }
}

/* ---- What is looked at --------------------------------------------------------------------------- */

/* What the largest values so far are, at the beginning of each look at a stretch. */
static void raise_scales(struct dalcs_audit *audit, int index) {
    audit->reader.raise(audit->reader.user, index, audit->v_scale, audit->i_scale,
                        audit->lambda_scale);
}

static void look(struct dalcs_audit *audit, int index, struct dalcs_audit_state *s) {
    struct audit_part *part = &audit->part[index];
    audit->reader.read(audit->reader.user, index, s);
    audit_note_scales(audit, part, s);
    audit_check_instant(audit, part, s);
    audit->credit -= part->cost;
}

/* Is it this stretch's turn? Which ones are is drawn, so that no period of the circuit hides any. */
static bool is_drawn(struct dalcs_audit *audit, double cost) {
    if (audit->options.mode == DALCS_AUDIT_FULL) {
        return true;
    }
    if (audit->credit < audit->threshold) {
        return false;
    }
    audit->threshold = 2.0 * cost * audit_draw(audit);
    return true;
}

bool dalcs_audit_may(struct dalcs_audit *audit, double work) {
    const bool may = is_drawn(audit, work);
    audit->credit -= may ? work : 0.0;
    return may;
}

void dalcs_audit_add(struct dalcs_audit *audit, enum dalcs_audit_law law, int index, double defect,
                     double time) {
    audit->part[index].is_coarse = false; /* what the last look was at is no matter here */
    audit_find(audit, &audit->part[index], law, index, defect, 1.0, time);
}

void dalcs_audit_earn(struct dalcs_audit *audit, double work) {
    audit->credit += audit->options.share * work;
}

/* Instants in a stretch with --audit full, beside its ends, and pieces that integrals are taken over. */
enum { FULL_INSTANTS = 3, FULL_PIECES = 2, INTERVAL_INSTANTS = 7 };

/* Of the looks of a sample, those with an interval, which costs more than twice as much as all else. */
static const double with_interval = 0.25;

/* Times in a stretch are known to a rounding of t, over its length that is what a value in it may be off by where it
 * changes by its whole scale: it has to be less than the tolerance. */
static bool can_look_inside(const struct dalcs_audit *audit,
                            const struct dalcs_audit_stretch *stretch) {
    const double tolerance = audit->part[stretch->part].tolerance;
    return stretch->rule == DALCS_AUDIT_SMOOTH &&
           (stretch->to - stretch->from) * tolerance > 4.0 * 0x1p-52 * stretch->to;
}

static void look_inside(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    const int n = audit->options.mode == DALCS_AUDIT_FULL ? FULL_INSTANTS : 1;
    for (int k = 0; k < n; k++) {
        audit->now.side = DALCS_RIGHT;
        audit->now.t = stretch->from + audit_draw(audit) * (stretch->to - stretch->from);
        look(audit, stretch->part, &audit->now);
    }
}

static void integrate(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    struct audit_part *part = &audit->part[stretch->part];
    const double length = stretch->to - stretch->from;
    if (audit->options.mode == DALCS_AUDIT_FULL) {
        for (int k = 0; k < FULL_PIECES; k++) {
            audit_check_interval(audit, part, stretch->from + k * length / FULL_PIECES,
                                 stretch->from + (k + 1) * length / FULL_PIECES);
        }
        return;
    }
    if (!(audit_draw(audit) < with_interval || stretch->is_last)) {
        return;
    }
    const double from = stretch->from + 0.5 * audit_draw(audit) * length;
    const double to = stretch->to - 0.5 * audit_draw(audit) * length;
    if (from < to) {
        audit_check_interval(audit, part, from, to);
        audit->credit -= INTERVAL_INSTANTS * part->cost;
    }
}

/* The derivative of a polynomial of degree s on an interval of length h is at most 2 s^2/h times its largest value
 * (A. and V. Markov): what rounding of charges makes of currents, and of fluxes of voltages. */
static void take_up(struct audit_part *part, const struct dalcs_audit_stretch *stretch) {
    const double s = stretch->degree;
    part->is_coarse = stretch->rule == DALCS_AUDIT_COARSE;
    part->step = stretch->step;
    part->slope = stretch->step > 0.0 ? 2.0 * s * s / stretch->step : 0.0;
}

bool dalcs_audit_passes_over(struct dalcs_audit *audit, int index, double work) {
    audit->count.stretches++;
    audit->credit += audit->options.share * work;
    const bool passes =
        audit->options.mode == DALCS_AUDIT_SAMPLE && audit->credit < audit->threshold;
    if (passes) {
        audit->part[index].is_open = false;
    }
    return passes;
}

bool dalcs_audit_was_left(const struct dalcs_audit *audit, int index) {
    return audit->part[index].is_open || !audit->part[index].has_entered;
}

void dalcs_audit_leave(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    struct audit_part *part = &audit->part[stretch->part];
    take_up(part, stretch);
    part->past = stretch->to - stretch->from;
    audit->threshold = 2.0 * (LOOK_INSTANTS * part->cost + stretch->first_look) * audit_draw(audit);
    audit->count.audited++;
    audit->credit -= stretch->first_look;
    raise_scales(audit, stretch->part);
    if (can_look_inside(audit, stretch)) {
        look_inside(audit, stretch);
    }
    struct dalcs_audit_state *end = &audit->before;
    end->t = stretch->to;
    end->side = DALCS_LEFT;
    look(audit, stretch->part, end);
    part->is_open = true;
    if (can_look_inside(audit, stretch)) {
        integrate(audit, stretch);
    }
}

void dalcs_audit_enter(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    const int index = stretch->part;
    struct audit_part *part = &audit->part[index];
    if (stretch->rule == DALCS_AUDIT_COARSE) {
        part->is_open = false;
        return;
    }
    take_up(part, stretch);
    raise_scales(audit, index);
    audit->now.t = stretch->from;
    audit->now.side = DALCS_RIGHT;
    /* An event is early or late by what changes no value by more than the tolerance: that share of the stretch that it
     * ended, over which values change by their scales at most. A diode may have its signs that much later. */
    part->lateness = fmin(part->tolerance * part->past, stretch->to - stretch->from);
    look(audit, index, &audit->now);
    part->lateness = 0.0;
    if (part->is_open) {
        audit_check_crossing(audit, part, &audit->before, &audit->now);
        audit->credit -= part->cost;
    }
    part->has_entered = true;
    part->is_open = false;
}

void dalcs_audit_instant(struct dalcs_audit *audit, int part, double t, enum dalcs_side side,
                         double work) {
    dalcs_audit_earn(audit, work);
    if (is_drawn(audit, audit->part[part].cost)) {
        audit->now.t = t;
        audit->now.side = side;
        look(audit, part, &audit->now);
    }
}
