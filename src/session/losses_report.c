/* losses_report.c - sums of losses as mean powers, energies and figures of merit, in the report. */
#include "losses_run.h"

#include "quantity.h"

#include <math.h>
#include <string.h>

/* The losses of a run, while they are written into the report. */
struct account {
    struct dalcs_run *r;
    const struct dalcs_losses_sum *sum;
    struct dalcs_losses *losses;
    struct dalcs_element_losses *element;
    double length; /* s */
};

static const char *kind_of(const struct dalcs_device *d) {
    switch (d->kind) {
    case DALCS_RESISTOR:
        return strncmp(d->name, "rser(l", 6) == 0 ? "winding" : "resistor";
    case DALCS_INDUCTOR:
        return "coil";
    case DALCS_CAPACITOR:
        return "capacitor";
    case DALCS_DIODE:
        return "diode";
    case DALCS_SWITCH:
        return "switch";
    default:
        return d->letter == 'm'    ? "switch"
               : d->is_limit       ? "diode"
               : d->is_transformer ? "transformer"
               : !d->is_storage    ? "source"
               : d->letter == 'l'  ? "coil"
                                   : "capacitor";
    }
}

/* J in a coil, half of what it shares with others, or in a capacitor. at: 0 begin, 1 end. */
static double stored(const struct account *a, int k, bool at_end) {
    const struct dalcs_circuit *c = a->sum->circuit;
    const struct dalcs_device *d = &c->device[k];
    const struct dalcs_loss *l = &a->sum->device[k];
    const double *own = at_end ? l->end : l->begin;
    if (d->kind == DALCS_CAPACITOR) {
        return 0.5 * d->value * own[0] * own[0];
    }
    double flux = d->value * own[1];
    for (int j = 0; j < c->n_couplings; j++) {
        const struct dalcs_coupling *m = &c->coupling[j];
        if (m->inductor[0] == k || m->inductor[1] == k) {
            int other = m->inductor[m->inductor[0] == k ? 1 : 0];
            const struct dalcs_loss *o = &a->sum->device[other];
            flux +=
                m->k * sqrt(d->value * c->device[other].value) * (at_end ? o->end : o->begin)[1];
        }
    }
    return 0.5 * flux * own[1];
}

/* Means over a part of a period more than these miss are off by such a part of the waveform: the tolerance
 * to which that is known is what may be missed. */
static bool has_whole_periods(const struct account *a, double frequency) {
    double n = a->length * frequency;
    double tolerance = a->r->tolerance;
    return rint(n) >= 1.0 && fabs(n - rint(n)) <= tolerance;
}

/* One below the tolerance of the run is what the run is off by. */
static bool has_fundamental(const struct account *a, double amplitude, double rms) {
    return sqrt(0.5) * amplitude > a->r->tolerance * rms;
}

/* Power factor and THD against the fundamental of the source. */
static void judge_source(const struct account *a, const struct dalcs_loss *l,
                         struct dalcs_element_losses *e) {
    e->frequency = l->frequency;
    const bool has_impulses = isnan(e->v_rms) || isnan(e->i_rms);
    if (!(l->frequency > 0.0) || !has_whole_periods(a, l->frequency) || has_impulses) {
        return;
    }
    double volt = hypot(l->c[0], l->s[0]) * 2.0 / a->length;
    double ampere = hypot(l->c[1], l->s[1]) * 2.0 / a->length;
    double along = -(l->c[0] * l->c[1] + l->s[0] * l->s[1]) * 4.0 / (a->length * a->length);
    double rest = e->i_rms * e->i_rms - e->i_average * e->i_average - 0.5 * ampere * ampere;
    e->power_factor = -e->power / (e->v_rms * e->i_rms);
    if (has_fundamental(a, volt, e->v_rms) && has_fundamental(a, ampere, e->i_rms)) {
        e->displacement = along / (volt * ampere);
        e->thd = sqrt(fmax(rest, 0.0)) / (sqrt(0.5) * ampere);
    }
}

/* The square of an impulse has no integral. */
static double rms_of(const struct account *a, double square, int n_impulses) {
    return n_impulses > 0 ? (double)NAN : sqrt(square / a->length);
}

static enum dalcs_status add_element(struct account *a, int k) {
    const struct dalcs_device *d = &a->sum->circuit->device[k];
    const struct dalcs_loss *l = &a->sum->device[k];
    struct dalcs_losses *sum = a->losses;
    struct dalcs_element_losses *e = &a->element[sum->n_elements++];
    const double energy = l->energy + l->jump;
    const bool is_curved =
        d->is_storage || d->is_transformer; /* all windings together take nothing */
    const bool stores = d->kind == DALCS_INDUCTOR || d->kind == DALCS_CAPACITOR || is_curved;
    *e = (struct dalcs_element_losses){
        .element = dalcs_arena_copy(&a->r->s->arena, d->name, strlen(d->name)),
        .kind = kind_of(d),
        .v_average = (l->v + l->area[0].sum) / a->length,
        .v_rms = rms_of(a, l->v_square, l->area[0].n),
        .i_average = (l->i + l->area[1].sum) / a->length,
        .i_rms = rms_of(a, l->i_square, l->area[1].n),
        .power = energy / a->length,
        .jumps = l->jump,
        .stored_change = is_curved ? energy
                         : stores  ? stored(a, k, true) - stored(a, k, false)
                                   : 0.0,
        .switching = l->switching,
        .n_on = l->n_on,
        .n_off = l->n_off,
        .n_clamped = l->n_clamped,
        .power_factor = NAN,
        .displacement = NAN,
        .thd = NAN};
    if (stores) {
        e->power = e->stored_change / a->length;
        sum->stored_change += e->stored_change;
        sum->turnover += fabs(e->stored_change);
        return e->element == NULL ? DALCS_E_NOMEM : DALCS_OK;
    }
    double *account = strcmp(e->kind, "source") == 0     ? &sum->sources
                      : strcmp(e->kind, "resistor") == 0 ? &sum->resistors
                      : strcmp(e->kind, "winding") == 0  ? &sum->windings
                      : strcmp(e->kind, "diode") == 0    ? &sum->diodes
                                                         : &sum->switches;
    *account += account == &sum->sources ? -energy : energy;
    sum->turnover += fabs(energy);
    sum->switching += l->switching;
    if (account == &sum->sources) {
        judge_source(a, l, e);
    }
    return e->element == NULL ? DALCS_E_NOMEM : DALCS_OK;
}

/* ---- Efficiency -------------------------------------------------------------------------------- */

static bool is_named(const int *list, int n, int device) {
    bool found = false;
    for (int k = 0; k < n && !found; k++) {
        found = list[k] == device;
    }
    return found;
}

/* No part of another element, such as rpar(l1). */
static bool is_resistor_card(const struct dalcs_device *d) {
    return d->kind == DALCS_RESISTOR && strchr(d->name, '(') == NULL;
}

/* W of what is named, or else of what gives (in) or, resistors and sources, takes (out). */
static enum dalcs_status add_side(struct account *a, bool is_out, double *power,
                                  const char **names) {
    const struct dalcs_losses_card *card = a->sum->circuit->results.losses;
    const int *list = is_out ? card->out : card->in;
    const int n = is_out ? card->n_out : card->n_in;
    const double sign = is_out ? 1.0 : -1.0;
    size_t e = 0;
    *names = "";
    for (int k = 0; k < a->sum->circuit->n_devices; k++) {
        if (card->device[k].voltage < 0) {
            continue;
        }
        const struct dalcs_element_losses *element = &a->element[e++];
        const bool is_source = strcmp(element->kind, "source") == 0;
        const bool may =
            n > 0 ? is_named(list, n, k)
                  : (is_source || (is_out && is_resistor_card(&a->sum->circuit->device[k]))) &&
                        sign * element->power > 0.0;
        if (may) {
            *power += sign * element->power;
            *names = dalcs_arena_printf(&a->r->s->arena, "%s%s%s", *names,
                                        **names != '\0' ? ", " : "", element->element);
            if (*names == NULL) {
                return DALCS_E_NOMEM;
            }
        }
    }
    return DALCS_OK;
}

static enum dalcs_status judge_efficiency(struct account *a) {
    struct dalcs_losses *l = a->losses;
    DALCS_TRY(add_side(a, false, &l->input, &l->inputs));
    DALCS_TRY(add_side(a, true, &l->output, &l->outputs));
    const double all = l->input + l->switching / a->length;
    l->efficiency = all > 0.0 && l->output >= 0.0 ? l->output / all : (double)NAN;
    return DALCS_OK;
}

/* ---- Messages ---------------------------------------------------------------------------------- */

static void note_periods(const struct account *a, const struct dalcs_element_losses *e) {
    char text[2][DALCS_QUANTITY_SIZE];
    const double n = a->length * e->frequency;
    if (!(e->frequency > 0.0) || !isnan(e->thd) || isnan(e->v_rms) || isnan(e->i_rms)) {
        return;
    }
    if (has_whole_periods(a, e->frequency) && e->i_rms > 0.0) {
        dalcs_diag_add(&a->r->s->diag, DALCS_NOTE, NULL, NULL,
                       "losses: voltage or current of '%s' has no component at its frequency, %s: "
                       "no displacement or THD",
                       e->element, dalcs_quantity_write(text[0], e->frequency, "Hz", 6));
    } else if (!has_whole_periods(a, e->frequency)) {
        dalcs_diag_add(&a->r->s->diag, DALCS_NOTE, NULL, NULL,
                       "losses: the window of %s is %.6g periods of '%s' (%s), not a whole number: "
                       "no power factor or THD",
                       dalcs_quantity_write(text[0], a->length, "s", 6), n, e->element,
                       dalcs_quantity_write(text[1], 1.0 / e->frequency, "s", 6));
    }
}

/* An impulse has an area, but no height. */
static void tell_impulses(const struct account *a) {
    const char *first = NULL;
    const char *unknown = NULL;
    int n = 0;
    for (size_t k = 0; k < a->losses->n_elements; k++) {
        const struct dalcs_element_losses *e = &a->element[k];
        if (isnan(e->v_rms) || isnan(e->i_rms)) {
            first = n++ == 0 ? e->element : first;
        }
        if (unknown == NULL && (isnan(e->v_average) || isnan(e->i_average))) {
            unknown = e->element;
        }
    }
    if (n > 0) {
        dalcs_diag_add(
            &a->r->s->diag, DALCS_NOTE, NULL, NULL,
            "losses: '%s' has an impulse of its voltage or current where states jump, one "
            "of %d element%s: its area counts in the average, and there is no rms, power "
            "factor or THD",
            first, n, n == 1 ? "" : "s");
    }
    if (unknown != NULL) {
        dalcs_diag_add(&a->r->s->diag, DALCS_WARNING, NULL,
                       "a resistance in the loop of the impulse has it pass in a time",
                       "losses: the circuit does not tell an impulse of '%s': it has no average",
                       unknown);
    }
}

/* A slide is the limit of infinitely many switchings, which tables do not count. */
static void tell_slides(const struct account *a, const struct dalcs_losses_run *losses) {
    const struct dalcs_circuit *c = a->sum->circuit;
    const char *first = NULL;
    int n = 0;
    for (int k = 0; k < c->n_devices; k++) {
        const int *table = c->results.losses->device[k].table;
        if (losses->slid[k] && (table[0] >= 0 || table[1] >= 0)) {
            first = n == 0 ? c->device[k].name : first;
            n++;
        }
    }
    if (n > 0) {
        dalcs_diag_add(&a->r->s->diag, DALCS_WARNING, NULL,
                       "a hysteresis, Vh=, keeps a switch from sliding",
                       "losses: '%s' turns where a switch slides along its threshold, one of %d "
                       "elements with a table: it switches without end there, and no energy of its "
                       "table is counted",
                       first, n);
    }
}

static void tell(const struct account *a) {
    for (size_t k = 0; k < a->losses->n_elements; k++) {
        const struct dalcs_element_losses *e = &a->element[k];
        note_periods(a, e);
        if (e->n_clamped > 0) {
            dalcs_diag_add(&a->r->s->diag, DALCS_WARNING, NULL,
                           "make the table of .switchloss larger",
                           "'%s' switched %ld time%s outside its table: the energy at its edge was "
                           "taken",
                           e->element, e->n_clamped, e->n_clamped == 1 ? "" : "s");
        }
    }
}

enum dalcs_status dalcs_losses_run_report(struct dalcs_losses_run *losses, struct dalcs_run *r) {
    const struct dalcs_losses_sum *sum = &losses->sum;
    const struct dalcs_circuit *c = sum->circuit;
    struct dalcs_report *report = &r->s->results.report;
    struct dalcs_losses *all = dalcs_arena_alloc(&r->s->arena, report->n_losses + 1, sizeof(*all));
    if (all == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < report->n_losses; k++) { /* of .pss before a .tran */
        all[k] = report->losses[k];
    }
    struct dalcs_losses *l = &all[report->n_losses];
    struct account a = {.r = r, .sum = sum, .losses = l, .length = sum->to - sum->from};
    a.element = dalcs_arena_alloc(&r->s->arena, (size_t)c->n_devices, sizeof(*a.element));
    if (a.element == NULL) {
        return DALCS_E_NOMEM;
    }
    *l = (struct dalcs_losses){.of_orbit = r->orbit != NULL && !r->leaves_orbit,
                               .from = sum->from,
                               .to = sum->to,
                               .element = a.element};
    for (int k = 0; k < c->n_devices; k++) {
        if (c->results.losses->device[k].voltage >= 0) {
            DALCS_TRY(add_element(&a, k));
            dalcs_audit_losses_told(&losses->audit, sum, k, &a.element[l->n_elements - 1]);
        }
    }
    double *work = dalcs_arena_alloc(&r->s->arena, 2 * (size_t)c->n_nodes, sizeof(double));
    if (work == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_audit_losses_laws(&losses->audit, sum, a.element, work);
    l->jumps = sum->loops;
    l->turnover += fabs(sum->loops);
    l->balance = l->sources - l->resistors - l->windings - l->diodes - l->switches - l->jumps -
                 l->stored_change;
    DALCS_TRY(judge_efficiency(&a));
    tell(&a);
    tell_impulses(&a);
    tell_slides(&a, losses);
    report->losses = all;
    report->n_losses++;
    return DALCS_OK;
}
