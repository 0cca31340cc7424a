/* power.c - the powers of all devices, family by family. */
#include "power.h"

#include "assemble.h"
#include "stamp.h"

#include <math.h>

enum { MOST_TERMS = 5 }; /* of one device: a diode with both branches, Ron, Rrev and Roff */

struct terms {
    int n;
    struct dalcs_power_term term[MOST_TERMS];
};

static struct dalcs_power_term *put(struct terms *t, enum dalcs_power_account account,
                                    enum dalcs_power_factor factor, double coefficient) {
    struct dalcs_power_term *term = &t->term[t->n];
    *term = (struct dalcs_power_term){.account = account,
                                      .factor = factor,
                                      .coefficient = coefficient,
                                      .first = {-1, -1},
                                      .second = {-1, -1},
                                      .pair = -1};
    t->n += coefficient != 0.0 ? 1 : 0;
    return term;
}

static void set_voltage(const struct dalcs_layout *l, int *column, int plus, int minus) {
    column[0] = dalcs_stamp_node_column(l, plus);
    column[1] = dalcs_stamp_node_column(l, minus);
}

static void put_resistance(const struct dalcs_layout *l, struct terms *t,
                           const struct dalcs_device *d, double ohm) {
    if (isfinite(ohm)) {
        struct dalcs_power_term *term =
            put(t, DALCS_POWER_RESISTORS, DALCS_POWER_SQUARE, 1.0 / ohm);
        set_voltage(l, term->first, d->node[0], d->node[1]);
    }
}

/* One branch of a diode, or a switch. */
static void put_pair(struct terms *t, const struct dalcs_system *s, int pair,
                     enum dalcs_power_account account, double threshold, double ohm) {
    struct dalcs_power_term *constant = put(t, account, DALCS_POWER_CONSTANT, threshold);
    constant->first[0] = dalcs_system_n_equations(s) + pair;
    constant->pair = pair;
    struct dalcs_power_term *square = put(t, account, DALCS_POWER_SQUARE, ohm);
    square->first[0] = dalcs_system_n_equations(s) + pair;
    square->pair = pair;
}

/* What V delivers: the current flows through it from plus to minus. */
static void put_voltage_source(const struct dalcs_layout *l, struct terms *t, int device) {
    const struct dalcs_device *d = &l->circuit->device[device];
    const struct dalcs_stimulus *stimulus = &l->circuit->stimulus[d->stimulus];
    bool is_dc = stimulus->kind == DALCS_STIMULUS_DC;
    struct dalcs_power_term *term =
        put(t, DALCS_POWER_SOURCES, is_dc ? DALCS_POWER_CONSTANT : DALCS_POWER_PRODUCT,
            is_dc ? -stimulus->dc : -1.0);
    term->first[0] = l->current_column[device];
    if (!is_dc) {
        set_voltage(l, term->second, d->node[0], d->node[1]);
    }
}

/* I delivers at each end by itself: no equation ties the voltages of the two. */
static void put_current_source(const struct dalcs_layout *l, struct terms *t, int device) {
    const struct dalcs_device *d = &l->circuit->device[device];
    const struct dalcs_stimulus *stimulus = &l->circuit->stimulus[d->stimulus];
    bool is_dc = stimulus->kind == DALCS_STIMULUS_DC;
    enum dalcs_power_account account = d->is_limit ? DALCS_POWER_DIODES : DALCS_POWER_SOURCES;
    for (int end = 0; end < 2; end++) {
        double sign = end == 0 ? -1.0 : 1.0;
        double side = d->is_limit ? -sign : sign; /* taken, or given */
        int column = dalcs_stamp_node_column(l, d->node[end]);
        if (column >= 0) {
            struct dalcs_power_term *term =
                put(t, account, is_dc ? DALCS_POWER_CONSTANT : DALCS_POWER_INPUT,
                    is_dc ? side * stimulus->dc : side);
            term->first[0] = column;
            term->input = l->input[device];
        }
    }
}

/* The power of a controlled V or I. */
static void put_controlled_source(const struct dalcs_layout *l, struct terms *t, int device) {
    const struct dalcs_device *d = &l->circuit->device[device];
    const bool is_voltage = d->kind == DALCS_VCVS || d->kind == DALCS_CCVS;
    struct dalcs_power_term *term =
        put(t, DALCS_POWER_SOURCES, DALCS_POWER_PRODUCT, is_voltage ? -1.0 : -d->value);
    set_voltage(l, term->first, d->node[0], d->node[1]);
    if (is_voltage) {
        term->second[0] = l->current_column[device];
    } else if (d->kind == DALCS_VCCS) {
        set_voltage(l, term->second, d->node[2], d->node[3]);
    } else {
        term->second[0] = l->current_column[d->control];
    }
}

static void put_diode(const struct dalcs_layout *l, struct terms *t, const struct dalcs_system *s,
                      int device) {
    const struct dalcs_device *d = &l->circuit->device[device];
    const struct dalcs_diode_model *m = &l->circuit->models.of_diode[d->model];
    put_pair(t, s, l->pair[device], DALCS_POWER_DIODES, m->vfwd, m->ron);
    if (isfinite(m->vrev)) {
        put_pair(t, s, l->pair[device] + 1, DALCS_POWER_DIODES, m->vrev, m->rrev);
    }
    put_resistance(l, t, d, m->roff);
}

static void put_switch(const struct dalcs_layout *l, struct terms *t, const struct dalcs_system *s,
                       int device) {
    const struct dalcs_device *d = &l->circuit->device[device];
    const struct dalcs_switch_model *m = &l->circuit->models.of_switch[d->model];
    put_pair(t, s, l->pair[device], DALCS_POWER_RESISTORS, 0.0,
             dalcs_stamp_series_part(m->ron, m->roff));
    put_resistance(l, t, d, m->roff);
}

static void put_device(const struct dalcs_layout *l, const struct dalcs_system *s, int device,
                       struct terms *t) {
    const struct dalcs_device *d = &l->circuit->device[device];
    if (d->behaviour != NULL) {
        const bool is_taken = d->is_storage || d->is_limit;
        struct dalcs_power_term *term = put(t,
                                            d->is_storage ? DALCS_POWER_STORED
                                            : d->is_limit ? DALCS_POWER_RESISTORS
                                                          : DALCS_POWER_SOURCES,
                                            DALCS_POWER_PRODUCT, is_taken ? 1.0 : -1.0);
        set_voltage(l, term->first, d->node[0], d->node[1]);
        term->second[0] = l->current_column[device];
        return;
    }
    switch (d->kind) {
    case DALCS_RESISTOR:
        if (l->current_column[device] >= 0) {
            put(t, DALCS_POWER_RESISTORS, DALCS_POWER_SQUARE, d->value)->first[0] =
                l->current_column[device];
        } else {
            put_resistance(l, t, d, d->value == 0.0 ? INFINITY : d->value);
        }
        return;
    case DALCS_INDUCTOR:
    case DALCS_CAPACITOR:
        return;
    case DALCS_VSOURCE:
        put_voltage_source(l, t, device);
        return;
    case DALCS_ISOURCE:
        put_current_source(l, t, device);
        return;
    case DALCS_VCVS:
    case DALCS_CCVS:
    case DALCS_VCCS:
    case DALCS_CCCS:
        put_controlled_source(l, t, device);
        return;
    case DALCS_DIODE:
        put_diode(l, t, s, device);
        return;
    case DALCS_SWITCH:
        put_switch(l, t, s, device);
        return;
    }
}

enum dalcs_status dalcs_power_build(struct dalcs_network *network, const struct dalcs_layout *l) {
    const struct dalcs_circuit *c = l->circuit;
    size_t n_systems = (size_t)network->n_systems;
    network->power = dalcs_arena_alloc(&network->arena, n_systems, sizeof(*network->power));
    if (network->power == NULL) {
        return DALCS_E_NOMEM;
    }
    /* counted, then written */
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < c->n_devices; i++) {
            int k = l->topology.device_component[i];
            if (k < 0) {
                continue;
            }
            struct terms t;
            t.n = 0;
            struct dalcs_power *power = &network->power[k];
            put_device(l, &network->system[k], i, &t);
            for (int n = 0; n < t.n && round == 1; n++) {
                power->term[power->n + n] = t.term[n];
                power->term[power->n + n].element = c->device[i].name;
            }
            power->n += t.n;
        }
        for (size_t k = 0; k < n_systems && round == 0; k++) {
            struct dalcs_power *power = &network->power[k];
            power->term =
                dalcs_arena_alloc(&network->arena, (size_t)power->n, sizeof(*power->term));
            if (power->term == NULL) {
                return DALCS_E_NOMEM;
            }
            power->n = 0;
        }
    }
    return DALCS_OK;
}
