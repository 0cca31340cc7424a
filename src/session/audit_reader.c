/* audit_reader.c - the engine's answers, for the auditor. */
#include "audit_reader.h"

#include "radau.h"
#include "recurrence.h"
#include "sliding.h"
#include "step_error.h"

#include <math.h>
#include <string.h>

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
                  : d->kind == DALCS_DIODE && isfinite(circuit->models.of_diode[d->model].vrev) ? 2
                                                                                                : 1;
    bool is = false;
    for (int k = 0; k < n && !is; k++) {
        is = dalcs_sliding_turns(&c->positions, first + k);
    }
    return is;
}

/* mode[]: of the pairs, where y has the lambdas. */
static void copy_answer(const struct dalcs_audit_run *a, int index, const double *y,
                        const uint64_t *mode, struct dalcs_audit_state *s) {
    const struct audit_members *m = &a->part[index];
    const struct dalcs_readout *readout = a->run->s->network.readout;
    const struct dalcs_component *c = &a->euler->component[index];
    for (int k = 0; k < m->n_nodes; k++) {
        s->v[m->node[k]] = y[m->node_column[k]];
    }
    for (int k = 0; k < m->n_devices; k++) {
        const int d = m->device[k];
        s->i[d] = dalcs_readout_current(readout, d, y);
        s->is_mean[d] = is_mean(a, c, d);
        if (a->run->s->circuit.device[d].kind == DALCS_SWITCH) {
            s->is_closed[d] = dalcs_mode_has(mode, readout->first_pair[d]);
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
    copy_answer(a, part, c->y, c->osnsp.mode, s);
}

static bool is_on(void *user, int part, int device, int k) {
    const struct dalcs_audit_run *a = user;
    return dalcs_osnsp_is_on(&a->radau->part[part].component->osnsp,
                             a->run->s->network.readout->first_pair[device] + k);
}

/* In the place of the lambda of an open pair is another number. */
static void read_columns(void *user, int part, double *is_read) {
    const struct dalcs_audit_run *a = user;
    const struct dalcs_component *c = a->radau->part[part].component;
    const int n_equations = dalcs_system_n_equations(c->system);
    for (int k = 0; k < n_equations; k++) {
        is_read[k] = 1.0;
    }
    for (int k = 0; k < c->system->n_pairs; k++) {
        is_read[n_equations + k] = dalcs_osnsp_is_on(&c->osnsp, k) ? 1.0 : 0.0;
    }
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

/* ---- Where the segment before ended -------------------------------------------------------------- */

void dalcs_audit_reader_keep(const struct dalcs_audit_run *a, int index) {
    const struct dalcs_radau_part *part = &a->radau->part[index];
    const struct dalcs_component *c = part->component;
    struct audit_members *m = &a->part[index];
    m->last.out = part->segment.out;
    m->last.end = part->segment.end;
    m->last.step = part->segment.h;
    m->last.time = part->segment.t_end;
    for (int k = 0; k < c->osnsp.n_words; k++) {
        m->last.mode[k] = c->osnsp.mode[k];
    }
}

/* The numbers of that segment are where they were until the next one has ended. */
static void read_before(void *user, int index, double earlier, struct dalcs_audit_state *s) {
    const struct dalcs_audit_run *a = user;
    struct dalcs_radau_part *part = &a->radau->part[index];
    const struct dalcs_component *c = part->component;
    const struct audit_members *m = &a->part[index];
    const int n_equations = dalcs_system_n_equations(c->system);
    if (m->last.out == NULL) { /* the first one begins there */
        read_state(user, index, s);
        return;
    }
    dalcs_recurrence_complete_before(part);
    double *present = part->segment.out;
    part->segment.out = m->last.out;
    dalcs_step_values(part, m->last.end - earlier / m->last.step, part->work.y1);
    part->segment.out = present;
    for (int d = 0; d < c->system->n_pairs; d++) {
        part->work.y1[n_equations + d] *= dalcs_mode_has(m->last.mode, d) ? 1.0 : 0.0;
    }
    for (int i = 0; i < part->excitation.bystanders.n; i++) {
        part->work.y1[part->excitation.bystanders.column[i]] =
            dalcs_radau_bystander(part, i, m->last.time - earlier, DALCS_LEFT);
    }
    s->t = m->last.time - earlier;
    s->side = DALCS_LEFT;
    copy_answer(a, index, part->work.y1, m->last.mode, s);
}

/* ---- As it is stored ----------------------------------------------------------------------------- */

/* FNV-1a over words (G. Fowler, L. C. Noll and K.-P. Vo, IETF draft-eastlake-fnv). */
static uint64_t mix(uint64_t hash, uint64_t word) {
    return (hash ^ word) * 0x100000001b3u;
}

static uint64_t key_of(const struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *osnsp = &part->component->osnsp;
    uint64_t hash = 0xcbf29ce484222325u;
    for (int k = 0; k < osnsp->n_words; k++) {
        hash = mix(hash, osnsp->mode[k]);
    }
    return hash;
}

/* The map whose image of part->in the segment is; NULL: none. */
static struct dalcs_stage_entry *map_of(const struct dalcs_radau_part *part) {
    struct dalcs_stage_entry *entry = dalcs_audit_entry_of(&part->segment);
    const bool has_map =
        entry != NULL && dalcs_stages_have_maps(&part->stages) && dalcs_stage_has_map(entry);
    return part->segment.late != NULL || (has_map && dalcs_audit_begins_with_input(part)) ? entry
                                                                                          : NULL;
}

static const struct dalcs_audit_polynomials *store(struct audit_members *m,
                                                   const struct dalcs_radau_part *part) {
    struct dalcs_audit_polynomials *p = &m->stored;
    m->map = NULL;
    if (part->segment.by_euler || part->component->positions.joined) {
        return NULL;
    }
    p->key = key_of(part);
    p->step = part->segment.h;
    p->end = part->segment.end;
    p->value = part->segment.late != NULL ? NULL : part->segment.out;
    m->map = m->has_maps ? map_of(part) : NULL;
    p->input = m->map != NULL ? part->segment.in : NULL;
    return p;
}

struct dalcs_audit_stretch *dalcs_audit_reader_stretch(struct dalcs_audit_run *a, int index,
                                                       double to) {
    const struct dalcs_radau_part *part = &a->radau->part[index];
    struct audit_members *m = &a->part[index];
    struct dalcs_audit_stretch *stretch = &m->stretch;
    stretch->from = part->segment.t;
    stretch->to = to;
    stretch->is_cut = to < part->segment.t_end;
    stretch->step = part->segment.h;
    stretch->rule = dalcs_segment_is_coarse(part) ? DALCS_AUDIT_COARSE : DALCS_AUDIT_SMOOTH;
    stretch->is_undecided = dalcs_segment_is_coarse(part) && part->guards.undecided;
    stretch->stored = store(m, part);
    return stretch;
}

static void complete(void *user, int index) {
    const struct dalcs_audit_run *a = user;
    struct dalcs_radau_part *part = &a->radau->part[index];
    dalcs_recurrence_complete(part);
    a->part[index].stored.value = part->segment.out;
}

static const double *column(void *user, int index, int j) {
    const struct dalcs_audit_run *a = user;
    const struct dalcs_radau_part *part = &a->radau->part[index];
    const int n_x = part->component->system->n_x;
    const int missing = part->stages.n_in - dalcs_stage_brief_columns(&part->stages);
    return j == n_x && missing > 0
               ? NULL
               : dalcs_stage_brief_column(map_of(part), j < n_x ? j : j - missing);
}

/* Sources alone decide bystanders. */
static void add_column(const struct dalcs_audit_run *a, int index, int column, double factor,
                       struct dalcs_audit_row *row) {
    const struct dalcs_radau_part *part = &a->radau->part[index];
    const struct dalcs_system *s = part->component->system;
    const int bystander = a->part[index].bystander[column];
    if (bystander < 0) {
        dalcs_audit_row_add_column(row, column, factor);
        return;
    }
    const double *gain = part->excitation.bystanders.gain + bystander * s->n_inputs;
    row->constant += factor * gain[0];
    for (int k = 1; k < s->n_inputs; k++) {
        if (gain[k] != 0.0) {
            dalcs_audit_row_add_stimulus(row, s->stimulus[k], factor * gain[k]);
        }
    }
}

static void add_voltage(void *user, int index, int node, double factor,
                        struct dalcs_audit_row *row) {
    const struct dalcs_audit_run *a = user;
    const int node_column = a->run->s->network.readout->node_column[node];
    if (node_column >= 0) {
        add_column(a, index, node_column, factor, row);
    }
}

static void add_current(void *user, int index, int device, double factor,
                        struct dalcs_audit_row *row) {
    const struct dalcs_audit_run *a = user;
    const struct dalcs_readout *readout = a->run->s->network.readout;
    for (int j = readout->start[device]; j < readout->start[device + 1]; j++) {
        add_column(a, index, readout->term[j].column, factor * readout->term[j].coefficient, row);
    }
}

static void add_lambda(void *user, int index, int lambda, double factor,
                       struct dalcs_audit_row *row) {
    const struct dalcs_audit_run *a = user;
    const struct dalcs_radau_part *part = &a->radau->part[index];
    add_column(a, index,
               dalcs_system_n_equations(part->component->system) + a->pair_of_lambda[lambda],
               factor, row);
}

struct dalcs_audit_reader dalcs_audit_reader_of(struct dalcs_audit_run *a) {
    return (struct dalcs_audit_reader){.user = a,
                                       .complete = complete,
                                       .column = column,
                                       .add_voltage = add_voltage,
                                       .add_current = add_current,
                                       .add_lambda = add_lambda,
                                       .read_columns = read_columns,
                                       .is_on = is_on,
                                       .read_before = read_before,
                                       .revisit = dalcs_audit_revisit,
                                       .go_back = dalcs_audit_go_back,
                                       .read = read_state,
                                       .raise = raise_scales};
}
