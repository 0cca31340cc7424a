/* transient_report.c - what a transient reports: methods, work, rows that are too few, steps that were cut short,
 * the ledger of energies. */
#include "transient.h"

#include "energy.h"

#include <math.h>

/* Where more are cut short by a longest step than this, a note says so. */
enum { MANY_STEPS = 1000 };

/* Rows further apart than half a period do not show a sine, nor do averages over them. `since` when there are no
 * others; INFINITY: never. */
void dalcs_transient_warn_of_coarse_rows(struct dalcs_run *r, const struct dalcs_schedule *schedule,
                                         double since) {
    const struct dalcs_circuit *c = &r->s->circuit;
    bool may_be_coarse = schedule->kind == DALCS_ON_GRID && isfinite(since);
    for (int i = 0; i < c->n_devices && may_be_coarse; i++) {
        const struct dalcs_device *d = &c->device[i];
        const struct dalcs_stimulus *s = d->stimulus >= 0 ? &c->stimulus[d->stimulus] : NULL;
        if (s != NULL && s->kind == DALCS_STIMULUS_SIN && s->u.sine.amplitude != 0.0 &&
            schedule->step * s->u.sine.frequency > 0.5) {
            dalcs_diag_add(&r->s->diag, DALCS_WARNING, &d->where, "a smaller tstep in .tran",
                           "rows are %g s apart%s and a period of '%s' is %g s: they do not show "
                           "it, nor what is computed from them",
                           schedule->step, since > schedule->start ? " there" : "", d->name,
                           1.0 / s->u.sine.frequency);
            return;
        }
    }
}

/* Which method each component goes with, and why. */
enum dalcs_status dalcs_transient_report_methods(struct dalcs_run *r,
                                                 const struct dalcs_radau *radau) {
    const size_t n = (size_t)r->s->network.n_systems;
    struct dalcs_component_method *component =
        dalcs_arena_alloc(&r->s->arena, n, sizeof(*component));
    if (component == NULL) {
        return DALCS_E_NOMEM;
    }
    const char *family_name =
        dalcs_method_name(r->method == DALCS_METHOD_AUTO ? DALCS_METHOD_RADAU : r->method);
    for (size_t k = 0; k < n; k++) {
        component[k] = (struct dalcs_component_method){.method = "euler", .stages = 1};
        if (radau != NULL) {
            const struct dalcs_radau_part *part = &radau->part[k];
            bool steps = part->kind == DALCS_PART_STEPPED;
            component[k].method = steps ? family_name : "algebraic";
            component[k].stages = steps ? part->stages.method->n_stages : 1;
            component[k].because = part->because;
        }
    }
    r->s->results.report.component = component;
    r->s->results.report.n_components = n;
    return DALCS_OK;
}

/* SPICE needs a tmax to be accurate, and people write one. */
static void note_held_back(struct dalcs_run *r, const struct dalcs_radau *radau) {
    long held_back = 0;
    for (int k = 0; k < radau->n_parts; k++) {
        held_back += radau->part[k].length.held_back;
    }
    if (r->radau.max_step > 0.0 && r->radau.fixed_step == 0.0 && held_back > MANY_STEPS &&
        2 * held_back > radau->steps) {
        dalcs_diag_add(&r->s->diag, DALCS_NOTE, NULL, "leave tmax out of .tran",
                       "the longest step that is allowed, %g s, cut %ld of %ld steps short: the "
                       "tolerance does not need it",
                       r->radau.max_step, held_back, radau->steps);
    }
}

/* A wrong sign below this, or below so many tolerances, is accepted without a warning. */
static const double noted_sign = 1e-4;
static const double noted_sign_over_tolerance = 100.0;

static void warn_of_wrong_sign(struct dalcs_run *r, const struct dalcs_radau *radau) {
    if (radau->wrong_sign > noted_sign &&
        radau->wrong_sign > noted_sign_over_tolerance * radau->options.tolerance) {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, NULL, "compare with another --tol",
                       "a diode has had the wrong sign, up to %.2g of the largest current or "
                       "voltage, at t = %.9g s: what follows may be wrong",
                       radau->wrong_sign, radau->wrong_time);
    }
}

void dalcs_transient_add_radau_work(struct dalcs_run *r, const struct dalcs_radau *radau) {
    struct dalcs_report *report = &r->s->results.report;
    report->work.steps += radau->steps;
    report->work.rejected += radau->rejected;
    report->work.restarts += radau->restarts;
    report->work.euler_steps += radau->euler_steps;
    report->work.periodic_steps += radau->periodic_steps;
    report->work.leapt_steps += radau->leapt_steps;
    for (int k = 0; k < radau->n_parts; k++) {
        report->work.factorizations += radau->part[k].stages.cache.factorizations;
        report->work.cache_hits += radau->part[k].stages.cache.cache_hits;
    }
    note_held_back(r, radau);
    report->certificate.wrong_sign = radau->wrong_sign;
    warn_of_wrong_sign(r, radau);
    if (radau->worst_residual > report->certificate.worst) {
        report->certificate.worst = radau->worst_residual;
        report->certificate.time = radau->worst_time;
        report->certificate.where = "stages";
    }
    if (radau->euler_steps > 0) {
        dalcs_diag_add(&r->s->diag, DALCS_NOTE, NULL, NULL,
                       "where events crowded, radau fell back to implicit Euler for %ld step%s",
                       radau->euler_steps, radau->euler_steps == 1 ? "" : "s");
    }
}

/* The ledger into the report. Where it does not add up, an equation was not what its devices are, or a
 * step went where it should not. */
enum dalcs_status dalcs_transient_close_ledger(struct dalcs_run *r, struct dalcs_energy *energy,
                                               struct dalcs_euler *e, struct dalcs_radau *radau) {
    enum dalcs_status status = dalcs_energy_close(energy, e, radau);
    if (status > DALCS_OK) {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, NULL, NULL,
                       "the energies are not known: a part of the circuit without states has no "
                       "answer to one of its sources alone");
        return DALCS_OK;
    }
    DALCS_TRY(status);
    struct dalcs_report *report = &r->s->results.report;
    if (!isfinite(energy->sum.turnover)) { /* an unstable circuit, beyond what doubles hold */
        return DALCS_OK;
    }
    report->energy.present = true;
    report->energy.sources = energy->sum.account[DALCS_POWER_SOURCES];
    report->energy.resistors = energy->sum.account[DALCS_POWER_RESISTORS];
    report->energy.diodes = energy->sum.account[DALCS_POWER_DIODES];
    report->energy.jumps = energy->sum.jumps;
    report->energy.stored_change = energy->sum.stored_change;
    report->energy.method = energy->sum.method;
    report->energy.balance = dalcs_energy_balance(energy);
    double unexplained = dalcs_energy_unexplained(energy, radau);
    if (unexplained == 0.0) {
        return DALCS_OK;
    }
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, NULL, NULL,
                   "internal error: the energy balance is off by %.3g J of %.3g J; please report "
                   "this netlist",
                   unexplained, energy->sum.turnover);
    return DALCS_E_INTERNAL;
}
