/* periodic_loop.c - the gain of a loop by what is injected into it, which leaves it closed.
 *
 * A voltage V (Middlebrook, Int. J. Electronics 38, 1975) lies between what drives the loop on, a, and where it goes on, b.
 * If b takes no current, the gain is -v(a)/v(b).
 *
 * Else the circuit has admittances between both sides, i = Y v, and the loop passes y12 forward and y21 back. Its gain
 * is T = (y12 + y21) / (y11 + y22), and 1 + T is the factor by which closing it changes its determinant (Tian, Visvanathan,
 * Hantgan and Kundert, IEEE Circuits & Devices 17, 2001). With v(a) = v1 and i(a) = i1 by a voltage of 1 V, v2 and i2 by
 * a current of 1 A into the node of both sides, 1 + T = 1 / (v1 + i2 - 2 (v1 i2 - v2 i1)). */
#include "periodic_ac.h"

#include "lower_case.h"

#include <math.h>
#include <string.h>

static enum dalcs_status refuse(struct dalcs_periodic_ac *ac, const char *hint, const char *text,
                                const char *name) {
    dalcs_diag_add(&ac->run->s->diag, DALCS_ERROR, &ac->run->s->circuit.analyses.ac.where, hint,
                   text, name);
    return DALCS_E_OPTION;
}

static bool is_name(const char *name, const char *asked) {
    for (; *asked != '\0' && dalcs_lower(*asked) == *name; asked++) {
        name++;
    }
    return *asked == '\0' && *name == '\0';
}

static int find_device(const struct dalcs_circuit *c, const char *name) {
    int device = 0;
    while (device < c->n_devices && !is_name(c->device[device].name, name)) {
        device++;
    }
    return device < c->n_devices ? device : -1;
}

/* ---- The current source that the netlist does not have ------------------------------------------- */

/* No card can have this name. */
static const char probe_name[] = "loop probe";

static bool is_probe(const struct dalcs_device *d) {
    return strcmp(d->name, probe_name) == 0;
}

static enum dalcs_status add_probe(struct dalcs_circuit *c, int node) {
    struct dalcs_device *device =
        dalcs_arena_alloc(&c->arena, (size_t)c->n_devices + 1, sizeof *device);
    struct dalcs_stimulus *stimulus =
        dalcs_arena_alloc(&c->arena, (size_t)c->n_stimuli + 1, sizeof *stimulus);
    if (device == NULL || stimulus == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(device, c->device, (size_t)c->n_devices * sizeof *device);
    memcpy(stimulus, c->stimulus, (size_t)c->n_stimuli * sizeof *stimulus);
    device[c->n_devices] = (struct dalcs_device){.kind = DALCS_ISOURCE,
                                                 .name = probe_name,
                                                 .letter = 'i',
                                                 .node = {0, node},
                                                 .stimulus = c->n_stimuli,
                                                 .control = -1,
                                                 .valve = -1,
                                                 .model = -1};
    stimulus[c->n_stimuli] = (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC};
    c->device = device;
    c->stimulus = stimulus;
    c->n_devices++;
    c->n_stimuli++;
    return DALCS_OK;
}

static const char *asked_loop(const struct dalcs_session *s,
                              const struct dalcs_run_options *options) {
    return options->loop != NULL ? options->loop : s->circuit.analyses.orbit_ac.loop;
}

enum dalcs_status dalcs_periodic_loop_prepare(struct dalcs_session *s,
                                              const struct dalcs_run_options *options) {
    struct dalcs_circuit *c = &s->circuit;
    const char *asked = asked_loop(s, options);
    const bool is_loaded = options->loop_is_loaded || c->analyses.orbit_ac.is_loaded;
    const bool is_asked =
        is_loaded && (options->bode || (c->analyses.periodic.present && c->analyses.ac.n > 0)) &&
        c->n_devices > 0;
    const int device = is_asked && asked != NULL ? find_device(c, asked) : -1;
    if (device < 0 || c->device[device].kind != DALCS_VSOURCE ||
        is_probe(&c->device[c->n_devices - 1])) {
        return DALCS_OK; /* what is wrong is said where the loop is looked for */
    }
    DALCS_TRY(add_probe(c, c->device[device].node[1]));
    const struct dalcs_network_options again = {.silent = true, .with_readout = true};
    dalcs_network_finish(&s->network);
    const enum dalcs_status status = dalcs_network_build(&s->network, c, &again, &s->diag);
    s->has_network = status == DALCS_OK;
    return status;
}

/* ---- The loop ------------------------------------------------------------------------------------ */

/* Does something but the source take a current at its second node? */
static const struct dalcs_device *find_load(const struct dalcs_circuit *c, int loop) {
    for (int k = 0; k < c->n_devices; k++) {
        const struct dalcs_device *d = &c->device[k];
        for (int side = 0; side < 2 && k != loop; side++) {
            if (d->node[side] == c->device[loop].node[1]) {
                return d;
            }
        }
    }
    return NULL;
}

static void tell_load(struct dalcs_periodic_ac *ac) {
    const struct dalcs_circuit *c = &ac->run->s->circuit;
    const struct dalcs_device *loop = &c->device[ac->loop.device];
    const struct dalcs_device *load = ac->loop.is_loaded ? NULL : find_load(c, ac->loop.device);
    if (load != NULL) {
        dalcs_diag_add(
            &ac->run->s->diag, DALCS_NOTE, &c->analyses.ac.where,
            "injection=both, or --injection both, accounts for that current",
            "loop: '%s' may draw a current behind '%s', and the gain is that of the loop "
            "only if this current is small",
            load->name, loop->name);
    }
}

static enum dalcs_status find_loop(struct dalcs_periodic_ac *ac, const char *asked) {
    const struct dalcs_circuit *c = &ac->run->s->circuit;
    const struct dalcs_readout *readout = ac->run->s->network.readout;
    const int device = find_device(c, asked);
    if (device < 0 || c->device[device].kind != DALCS_VSOURCE) {
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
    ac->loop.probe = c->n_devices - 1;
    ac->loop.is_loaded = is_probe(&c->device[ac->loop.probe]);
    tell_load(ac);
    return ac->loop.system >= 0 ? DALCS_OK
                                : refuse(ac, NULL, "loop: nothing depends on '%s'", asked);
}

enum dalcs_status dalcs_periodic_loop_find(struct dalcs_periodic_ac *ac) {
    const struct dalcs_circuit *c = &ac->run->s->circuit;
    const char *asked = asked_loop(ac->run->s, ac->run->options);
    ac->loop.device = -1;
    if (asked != NULL) {
        return find_loop(ac, asked);
    }
    if (ac->run->options->loop_is_loaded || c->analyses.orbit_ac.is_loaded) {
        return refuse(ac, "name the voltage source in it: loop=vloop, or --loop vloop",
                      "%s: injection needs the gain of a loop", "no loop is asked for");
    }
    for (int k = 0; k < c->n_stimuli; k++) {
        if (c->stimulus[k].ac_real != 0.0 || c->stimulus[k].ac_imaginary != 0.0) {
            return DALCS_OK;
        }
    }
    return refuse(ac, "write AC 1 on the source that drives it, such as: Vctl ctl 0 0.4 AC 1",
                  "%s: everything would be 0", "no source has an AC value");
}

double complex dalcs_periodic_loop_source(const struct dalcs_periodic_ac *ac, int of,
                                          int stimulus) {
    const struct dalcs_circuit *c = &ac->run->s->circuit;
    if (of >= 0) {
        return c->device[of].stimulus == stimulus ? 1.0 : 0.0;
    }
    return c->stimulus[stimulus].ac_real + I * c->stimulus[stimulus].ac_imaginary;
}

void dalcs_periodic_loop_mark(const struct dalcs_periodic_ac *ac, bool *is_read) {
    const struct dalcs_readout *readout = ac->run->s->network.readout;
    const int device = ac->loop.device;
    for (int k = 0; k < 2; k++) {
        if (ac->loop.column[k] >= 0) {
            is_read[ac->loop.column[k]] = true;
        }
    }
    for (int j = readout->start[device]; j < readout->start[device + 1]; j++) {
        is_read[readout->term[j].column] = true;
    }
}

static double complex voltage(const struct dalcs_periodic_ac *ac,
                              const struct dalcs_periodic_ac_part *part, int side) {
    const int column = ac->loop.column[side];
    return part->rests || column < 0 ? 0.0 : part->response.y[column];
}

/* Out of the first node into what lies there, besides the source. */
static double complex current(const struct dalcs_periodic_ac *ac,
                              const struct dalcs_periodic_ac_part *part) {
    const struct dalcs_readout *readout = ac->run->s->network.readout;
    const int device = ac->loop.device;
    double complex sum = 0.0;
    for (int j = readout->start[device]; j < readout->start[device + 1] && !part->rests; j++) {
        sum -= readout->term[j].coefficient * part->response.y[readout->term[j].column];
    }
    return sum;
}

double complex dalcs_periodic_loop_gain(const struct dalcs_periodic_ac *ac) {
    const struct dalcs_periodic_ac_part *by_voltage = &ac->part[ac->loop.system];
    const double complex v1 = voltage(ac, by_voltage, 0);
    if (!ac->loop.is_loaded) {
        return -v1 / voltage(ac, by_voltage, 1);
    }
    const double complex v2 = voltage(ac, &ac->by_current, 0);
    const double complex i1 = current(ac, by_voltage);
    const double complex i2 = current(ac, &ac->by_current);
    return 1.0 / (v1 + i2 - 2.0 * (v1 * i2 - v2 * i1)) - 1.0;
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
    s->results.report.response.loop = dalcs_arena_copy(&s->arena, name, strlen(name));
    s->results.report.response.loop_is_loaded = ac->loop.is_loaded;
    s->results.report.response.n_crossovers = m->n_crossovers;
    s->results.report.response.n_reversals = m->n_reversals;
    DALCS_TRY(
        copy(&s->arena, m->crossover, m->n_crossovers, &s->results.report.response.crossover));
    DALCS_TRY(copy(&s->arena, m->reversal, m->n_reversals, &s->results.report.response.reversal));
    return s->results.report.response.loop != NULL ? DALCS_OK : DALCS_E_NOMEM;
}
