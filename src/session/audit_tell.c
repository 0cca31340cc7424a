/* audit_tell.c - what the audit found, for the report and in words. */
#include "audit_points.h"
#include "audit_reader.h"

#include "quantity.h"

#include <string.h>

enum { NAME_SIZE = 512 };

/* Each value that a law adds up is promised to the tolerance times its scale, so is their sum to that times the sum of
 * scales, by which a defect is divided. */
bool dalcs_audit_run_fails(const struct dalcs_audit_run *a) {
    return a->audit != NULL && !a->ends_at_pole && dalcs_audit_summarise(a->audit).is_broken;
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
    struct dalcs_report *report = &a->run->s->results.report;
    size_t n;
    DALCS_TRY(list_laws(a, NULL, &n));
    struct dalcs_audited *list = dalcs_arena_alloc(&a->run->s->arena, n, sizeof *list);
    if (list == NULL) {
        return DALCS_E_NOMEM;
    }
    report->audit.law = list;
    return list_laws(a, list, &report->audit.n_laws);
}

/* The card of the netlist whose result is wrong; NULL: it is a law of the waveform. */
static const struct dalcs_location *place_of(const struct dalcs_audit_run *a,
                                             const struct dalcs_audit_summary *found) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    switch (found->law) {
    case DALCS_AUDIT_MEASURE:
        return &c->results.measure[found->index].where;
    case DALCS_AUDIT_FOURIER:
        return &c->results.fourier[found->index].where;
    case DALCS_AUDIT_LOSSES:
        return &c->results.losses->where;
    default:
        return NULL;
    }
}

/* Is the voltage of a node 0 by convention, as nothing ties it to ground? */
static bool is_reference(const struct dalcs_audit_run *a, int node) {
    const struct dalcs_network *network = &a->run->s->network;
    const char *name = a->run->s->circuit.node_name[node];
    bool is = false;
    for (int k = 0; k < network->n_systems && !is; k++) {
        const struct dalcs_system *s = &network->system[k];
        for (int c = 0; c < dalcs_system_n_equations(s) && !is; c++) {
            is = s->column[c].kind == DALCS_LABEL_REFERENCE &&
                 strcmp(s->column[c].element, name) == 0;
        }
    }
    return is;
}

/* All laws hold but Kirchhoff's at such a node: there it is what those at the other nodes of the island leave over, which is
 * what sources drive into the island. Then no waveform can fulfil it. */
static bool is_driven_island(const struct dalcs_audit_run *a,
                             const struct dalcs_audit_summary *found) {
    bool is = found->law == DALCS_AUDIT_KCL && is_reference(a, found->index);
    for (int law = 0; law < DALCS_AUDIT_N_LAWS && is; law++) {
        for (int i = 0; i < dalcs_audit_n_of(a->audit, law) && is; i++) {
            is = (law == DALCS_AUDIT_KCL && i == found->index) ||
                 dalcs_audit_finding_of(a->audit, law, i).defect <= dalcs_audit_most_allowed(a);
        }
    }
    return is;
}

static enum dalcs_status tell_broken(const struct dalcs_audit_run *a,
                                     const struct dalcs_audit_summary *found, const char *name) {
    char time[DALCS_QUANTITY_SIZE];
    const struct dalcs_location *where = place_of(a, found);
    dalcs_quantity_write(time, found->time, "s", 9);
    if (where != NULL) {
        dalcs_diag_add(&a->run->s->diag, DALCS_ERROR, where,
                       "the waveform itself is not in doubt; please report this netlist",
                       "a result seems wrong: the audit finds %s off by %.2g of its scale at t = "
                       "%s, and %.2g is allowed",
                       name, found->defect, time, dalcs_audit_most_allowed(a));
    } else if (is_driven_island(a, found)) {
        const char *node = a->run->s->circuit.node_name[found->index];
        dalcs_diag_add(&a->run->s->diag, DALCS_ERROR, NULL,
                       "tie it to ground, by a large resistor for instance, or look for the source "
                       "whose current has no way back",
                       "Kirchhoff's current law cannot hold at t = %s: nothing connects node '%s' "
                       "and the part around it to ground, and what sources drive into it does not "
                       "come out",
                       time, node);
    } else if (found->stays) {
        dalcs_diag_add(&a->run->s->diag, DALCS_ERROR, NULL,
                       "what it does acts on its control at once: a capacitor, a coil or a delay "
                       "between them decides, and without a hysteresis it may slide",
                       "'%s' stands against its control at t = %s, by %.2g of the scale of that, "
                       "over whole steps: no position was found that agrees with it",
                       a->run->s->circuit.device[found->index].name, time, found->defect);
    } else {
        dalcs_diag_add(&a->run->s->diag, DALCS_ERROR, NULL,
                       "the report lists the laws that are broken; please report this netlist",
                       "the waveform seems wrong: the audit finds %s broken by %.2g of its scale "
                       "at t = %s, and %.2g is allowed",
                       name, found->defect, time, dalcs_audit_most_allowed(a));
    }
    return DALCS_REFUTED;
}

/* Where the run fell back to implicit Euler the error is not controlled: a note says so. */
static void tell_coarse(const struct dalcs_audit_run *a) {
    const struct dalcs_audit_summary coarse = dalcs_audit_summarise_coarse(a->audit);
    if (coarse.index < 0 || coarse.defect <= dalcs_audit_most_allowed(a)) {
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
    s->results.report.audit.mode = a->run->options->audit == DALCS_AUDIT_FULL ? "full" : "sample";
    s->results.report.audit.instants = found.instants;
    s->results.report.audit.segments = found.stretches;
    s->results.report.audit.audited = found.audited;
    s->results.report.audit.screened = found.screened;
    s->results.report.audit.positions = found.positions;
    s->results.report.unjudged = found.unjudged;
    s->results.report.audit.worst = found.defect;
    s->results.report.audit.allowed = found.allowed;
    s->results.report.audit.time = found.time;
    s->results.report.audit.where = dalcs_arena_copy(&s->arena, name, strlen(name));
    if (s->results.report.audit.where == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_audit_add_points(a->run);
    DALCS_TRY(report_laws(a));
    tell_coarse(a);
    return found.is_broken && !a->ends_at_pole ? tell_broken(a, &found, name) : DALCS_OK;
}
