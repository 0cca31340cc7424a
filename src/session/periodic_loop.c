/* periodic_loop.c - the gain of a loop by a voltage that is injected into it (Middlebrook, Int. J. Electronics 38, 1975).
 *
 * A source between what drives the loop on and where it goes on leaves the loop closed. Where it goes on takes no
 * current, the gain is minus the voltage before the source over that behind it. */
#include "periodic_ac.h"

#include "lower_case.h"

#include <math.h>
#include <string.h>

static enum dalcs_status refuse(struct dalcs_periodic_ac *ac, const char *hint, const char *text,
                                const char *name) {
    dalcs_diag_add(&ac->run->s->diag, DALCS_ERROR, &ac->run->s->circuit.ac.where, hint, text, name);
    return DALCS_E_OPTION;
}

static bool is_name(const char *name, const char *asked) {
    for (; *asked != '\0' && dalcs_lower(*asked) == *name; asked++) {
        name++;
    }
    return *asked == '\0' && *name == '\0';
}

static enum dalcs_status find_loop(struct dalcs_periodic_ac *ac, const char *asked) {
    const struct dalcs_circuit *c = &ac->run->s->circuit;
    const struct dalcs_readout *readout = ac->run->s->network.readout;
    int device = 0;
    while (device < c->n_devices && !is_name(c->device[device].name, asked)) {
        device++;
    }
    if (device == c->n_devices || c->device[device].kind != DALCS_VSOURCE) {
        return refuse(ac, "put one into the loop, such as: Vloop out fb 0",
                      "loop: there is no voltage source '%s'", asked);
    }
    const struct dalcs_device *d = &c->device[device];
    if (d->node[0] == 0 || d->node[1] == 0) {
        return refuse(ac, "its first node is where the signal comes from, its second where it goes",
                      "loop: '%s' ends at ground and lies in no loop", asked);
    }
    ac->loop.device = device;
    ac->loop.system = readout != NULL ? readout->device_system[device] : -1;
    for (int k = 0; k < 2 && ac->loop.system >= 0; k++) {
        ac->loop.column[k] = readout->node_column[d->node[k]];
    }
    return ac->loop.system >= 0 ? DALCS_OK
                                : refuse(ac, NULL, "loop: nothing depends on '%s'", asked);
}

enum dalcs_status dalcs_periodic_loop_find(struct dalcs_periodic_ac *ac) {
    const struct dalcs_circuit *c = &ac->run->s->circuit;
    const char *asked = ac->run->options->loop != NULL ? ac->run->options->loop : c->orbit_ac.loop;
    ac->loop.device = -1;
    if (asked != NULL) {
        return find_loop(ac, asked);
    }
    for (int k = 0; k < c->n_stimuli; k++) {
        if (c->stimulus[k].ac_real != 0.0 || c->stimulus[k].ac_imaginary != 0.0) {
            return DALCS_OK;
        }
    }
    return refuse(ac, "write AC 1 on the source that drives it, such as: Vctl ctl 0 0.4 AC 1",
                  "%s: everything would be 0", "no source has an AC value");
}

double complex dalcs_periodic_loop_source(const struct dalcs_periodic_ac *ac, int stimulus) {
    const struct dalcs_circuit *c = &ac->run->s->circuit;
    if (ac->loop.device >= 0) {
        return c->device[ac->loop.device].stimulus == stimulus ? 1.0 : 0.0;
    }
    return c->stimulus[stimulus].ac_real + I * c->stimulus[stimulus].ac_imaginary;
}

double complex dalcs_periodic_loop_gain(const struct dalcs_periodic_ac *ac) {
    const double complex *y = ac->part[ac->loop.system].response.y;
    double complex v[2] = {0.0, 0.0};
    for (int k = 0; k < 2; k++) {
        v[k] = y != NULL && ac->loop.column[k] >= 0 ? y[ac->loop.column[k]] : 0.0;
    }
    return -v[0] / v[1];
}

static enum dalcs_status copy(struct dalcs_arena *arena, const struct dalcs_margin *from, size_t n,
                              const struct dalcs_margin **to) {
    struct dalcs_margin *margin = dalcs_arena_alloc(arena, n + 1, sizeof *margin);
    if (margin == NULL) {
        return DALCS_E_NOMEM;
    }
    if (n > 0) {
        memcpy(margin, from, n * sizeof *margin);
    }
    *to = margin;
    return DALCS_OK;
}

enum dalcs_status dalcs_periodic_loop_report(struct dalcs_periodic_ac *ac) {
    struct dalcs_session *s = ac->run->s;
    const struct dalcs_margins *m = &ac->margins;
    if (ac->loop.device < 0) {
        return DALCS_OK;
    }
    const char *name = s->circuit.device[ac->loop.device].name;
    s->report.response.loop = dalcs_arena_copy(&s->arena, name, strlen(name));
    s->report.response.n_crossovers = m->n_crossovers;
    s->report.response.n_reversals = m->n_reversals;
    DALCS_TRY(copy(&s->arena, m->crossover, m->n_crossovers, &s->report.response.crossover));
    DALCS_TRY(copy(&s->arena, m->reversal, m->n_reversals, &s->report.response.reversal));
    return s->report.response.loop != NULL ? DALCS_OK : DALCS_E_NOMEM;
}
